//! What search, analysis and intervals need to know of a problem beside its sum of squares: what its unknowns are called, where first guesses
//! are, and how its quantities are weighted.

use crate::fit::least_squares::LeastSquares;
use crate::fit::multistart::initial_guess::SpecularLobes;
use crate::fit::observer::Observer;
use crate::fit::options::{FitOptions, Weights};
use crate::model::Parameter;
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;
use std::fmt;

/// What an unknown of a fit is called.
pub trait UnknownName: Clone + PartialEq + Send + Sync + fmt::Debug {
    /// Which parameter it is.
    fn parameter(&self) -> Parameter;

    /// The measurement that has it for itself; none where it is shared, or where there is one measurement.
    fn set(&self) -> Option<&str> {
        None
    }

    /// Its name in files: `n`, or `n@B.csv` where a measurement has its own.
    fn key(&self) -> Cow<'_, str>;

    /// Its symbol in text, the same way.
    fn symbol(&self) -> Cow<'_, str>;
}

impl UnknownName for Parameter {
    fn parameter(&self) -> Parameter {
        *self
    }

    fn key(&self) -> Cow<'_, str> {
        Cow::Borrowed(Self::key(*self))
    }

    fn symbol(&self) -> Cow<'_, str> {
        Cow::Borrowed(Self::symbol(*self))
    }
}

/// A least squares problem of a fit. Its unknowns are free parameters of surfaces; a *point* holds all parameters, the fixed ones too.
pub trait FitProblem: LeastSquares + Clone + Send + Sync {
    /// What an unknown is called.
    type Name: UnknownName;
    /// All parameters: of one surface, or of one for each measurement.
    type Point: Clone + PartialEq + Send + Sync + fmt::Debug;

    /// The unknowns, in their order.
    fn names(&self) -> &[Self::Name];

    /// Where the fit begins.
    fn start_point(&self) -> &Self::Point;

    /// The same problem from another start.
    #[must_use]
    fn starting_at(&self, point: &Self::Point) -> Self;

    /// All parameters, given the unknowns.
    fn point_at(&self, x: &DVector<f64>) -> Self::Point;

    /// The choices of the fit.
    fn options(&self) -> &FitOptions;

    /// Whether k_s, k_d and k_v enter by their ratios alone.
    fn knows_only_ratios(&self) -> bool;

    /// The smaller problems that this one falls apart into, which are searched by themselves; none where it is one.
    fn apart(&self) -> Vec<Self> {
        Vec::new()
    }

    /// The point that points of those problems make.
    fn joined(&self, points: &[Self::Point]) -> Self::Point;

    /// Whether its first guesses come from searches of its parts, so that little is left to be searched for.
    fn is_composed(&self) -> bool {
        false
    }

    /// First guesses of the search, the most promising first, and the residual evaluations that they took.
    fn first_guesses(&self, seed: u64, observer: Observer<'_>) -> (Vec<Self::Point>, usize);

    /// Points that the search begins at too, and ends above none of.
    fn further_starts(&self) -> Vec<Self::Point> {
        Vec::new()
    }

    /// Guesses with other lobes, optical constants as they are there, the most promising first.
    fn lobe_guesses(&self, at: &Self::Point) -> Vec<Self::Point>;

    /// Guesses of total reflection that come near the point there, the most promising first; none where the problem offers none.
    fn total_reflection_guesses(&self, _at: &Self::Point, _lobes: SpecularLobes) -> Vec<Self::Point> {
        Vec::new()
    }

    /// Guesses with an unknown held at its value in x, the most promising first.
    fn guesses_with_held(&self, unknown: usize, x: &DVector<f64>) -> Vec<Self::Point>;

    /// The value of an unknown at a fraction 0 to 1 of its box, by factors or by steps.
    fn spread(&self, unknown: usize, fraction: f64, by_factors: bool) -> f64;

    /// The same problem with about so many of its residuals.
    #[must_use]
    fn thinned(&self, most: usize) -> Self;

    /// The same problem with other data: the values at its start plus residuals drawn from its own by `pick` (an index below its
    /// argument), within each measurement and quantity, times a factor.
    #[must_use]
    fn resampled(&self, widen: f64, pick: &mut dyn FnMut(usize) -> usize) -> Self;

    /// The same problem with every residual counted by its square.
    #[must_use]
    fn with_squared_loss(&self) -> Self;

    /// The same problem with the scale of its loss taken from the residuals at that point.
    #[must_use]
    fn with_loss_scale_of(&self, point: &Self::Point) -> Self;

    /// The same problem with those scales of the loss for DoLP and BRDF.
    #[must_use]
    fn with_loss_scales(&self, loss_scales: [f64; 2]) -> Self;

    /// The same problem with the residuals of DoLP and BRDF multiplied by those numbers.
    #[must_use]
    fn with_block_weights(&self, block_weights: [f64; 2]) -> Self;

    /// What residuals of DoLP and BRDF are multiplied by.
    fn block_weights(&self) -> [f64; 2];

    /// Scale of the loss for DoLP and BRDF.
    fn loss_scales(&self) -> [f64; 2];

    /// What residuals of DoLP and BRDF are multiplied by for Eq. (18).
    fn scales(&self) -> [f64; 2];

    /// Sum of squares and number of the residuals of DoLP and of BRDF, before these are weighted against each other.
    fn block_sums(&self, point: &Self::Point) -> [(f64, usize); 2];

    /// Whether residuals are of DoLP and of BRDF.
    fn has_both_quantities(&self) -> bool;

    /// The scale of the loss of each residual.
    fn loss_scales_of_rows(&self) -> Vec<f64>;

    /// The predicted DoLP or BRDF of each residual; none where the parameters are no surface or a value is not finite.
    fn predictions(&self, point: &Self::Point) -> Option<Vec<f64>>;

    /// ΔE of Eq. (18).
    fn delta_e(&self, point: &Self::Point) -> Option<f64>;

    /// What the sum of squares is multiplied by to give the residual sum of squares in the unit of the data.
    fn rss_scale(&self) -> f64;

    /// Whether the sum of squares is ΔE of Eq. (18).
    fn minimises_delta_e(&self) -> bool;

    /// The unknowns of a point.
    fn unknowns_of(&self, point: &Self::Point) -> DVector<f64> {
        LeastSquares::start(&self.starting_at(point))
    }

    /// Whether DoLP and BRDF are minimised together, each in units of its own unknown standard deviation.
    fn has_two_variances(&self) -> bool {
        self.has_both_quantities() && self.options().weights == Weights::None
    }

    /// Sum of the squares of the residuals; none without data and where it is not finite.
    fn sum_of_squares_at(&self, x: &DVector<f64>) -> Option<f64> {
        let mut residuals = DVector::zeros(self.residual_count());
        (self.residual_count() > 0 && self.residuals_at(x, &mut residuals)).then(|| residuals.norm_squared())
    }

    /// Residuals and Jacobian; none where an element of either is not finite.
    fn linearised_at(&self, x: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let mut residuals = DVector::zeros(self.residual_count());
        let mut jacobian = DMatrix::zeros(self.residual_count(), x.len());
        (self.residuals_at(x, &mut residuals) && self.jacobian_at(x, &mut jacobian)).then_some((residuals, jacobian))
    }
}
