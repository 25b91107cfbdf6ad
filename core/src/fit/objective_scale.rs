//! How the sum of squares that is minimised stands to ΔE of Eq. (18), and to the residual sum of squares in the unit of the data.

use crate::fit::objective::Problem;
use crate::fit::options::{BrdfResiduals, Loss, Weights};
use crate::model::Parameters;

impl Problem {
    /// Whether the sum of squares is ΔE of Eq. (18).
    #[must_use]
    pub fn minimises_delta_e(&self) -> bool {
        let absolute = !self.predicts_brdf() || self.options().brdf_residuals == BrdfResiduals::Absolute;
        let is_plain = self.options().weights == Weights::None && self.options().loss == Loss::Squared;
        absolute && is_plain && self.block_weights() == [1.0; 2] && self.emphasis() == 1.0
    }

    /// ΔE of Eq. (18), given the sum of squares: the same number wherever that is what is minimised.
    #[must_use]
    pub fn objective(&self, sum_of_squares: f64, parameters: &Parameters) -> f64 {
        if self.minimises_delta_e() { sum_of_squares } else { self.delta_e(parameters).unwrap_or(sum_of_squares) }
    }

    /// Residual sum of squares in the unit of the data: that of [`Self::sum_of_squares`], not divided by Σ Xm² of Eq. (18) or by the
    /// number of residuals where one quantity alone is fitted without weights. None without data and where it is not finite.
    #[must_use]
    pub fn rss(&self, parameters: &Parameters) -> Option<f64> {
        self.sum_of_squares(parameters).map(|sum| sum * self.rss_scale())
    }

    /// What the sum of squares is multiplied by to give [`Self::rss`].
    pub(crate) fn rss_scale(&self) -> f64 {
        match (self.options().weights, self.observations().has_dolp(), self.observations().has_brdf()) {
            (Weights::None, true, false) => self.observations().square_sum(0).unwrap_or(1.0),
            (Weights::None, false, true) => {
                if self.options().brdf_residuals == BrdfResiduals::Absolute {
                    self.observations().square_sum(1).unwrap_or(1.0)
                } else {
                    #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
                    let count = self.len() as f64;
                    count.max(1.0)
                }
            }
            _ => 1.0,
        }
    }
}
