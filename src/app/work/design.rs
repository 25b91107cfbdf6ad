//! Angles that might be measured.

use pbrdf::fit::NoiseModel;
use pbrdf::measurement::Columns;
use pbrdf::optics::Geometry;
use serde::{Deserialize, Serialize};

/// Angles from one to another in steps, in degrees; a single one where both ends are the same.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AngleRange {
    pub from: f64,
    pub to: f64,
    pub step: f64,
}

/// Slack of the last step, as a fraction of it: 0.1 + 0.1 + 0.1 is not 0.3.
const SLACK: f64 = 1e-9;

impl AngleRange {
    pub const fn new(from: f64, to: f64, step: f64) -> Self {
        Self { from, to, step }
    }

    /// How many angles.
    pub fn count(&self) -> usize {
        let steps = ((self.to - self.from) / self.step + SLACK).floor();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of steps, cut to a sane one")]
        let steps = steps.clamp(0.0, 1e5) as usize;
        steps + 1
    }

    /// They.
    pub fn angles(self) -> impl Iterator<Item = f64> {
        #[expect(clippy::cast_precision_loss, reason = "a number of steps")]
        (0..self.count()).map(move |i| self.from + i as f64 * self.step)
    }

    fn is_sound(&self, range: std::ops::RangeInclusive<f64>) -> bool {
        range.contains(&self.from) && range.contains(&self.to) && self.from <= self.to && self.step > 0.0 && self.step.is_finite()
    }
}

/// A measurement that might be made: every θi with every θr.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct DesignSettings {
    pub theta_i: Vec<AngleRange>,
    /// Negative on the backscatter side.
    pub theta_r: Vec<AngleRange>,
    /// Degrees.
    pub dphi: f64,
    pub columns: Columns,
    /// Standard deviation of DoLP.
    pub noise: f64,
    /// Standard deviation of the BRDF, relative to its value.
    pub brdf_noise: f64,
}

impl Default for DesignSettings {
    fn default() -> Self {
        Self {
            theta_i: vec![AngleRange::new(10.0, 80.0, 10.0)],
            theta_r: vec![AngleRange::new(0.0, 85.0, 5.0)],
            dphi: 180.0,
            columns: Columns::Dolp,
            noise: 0.005,
            brdf_noise: 0.02,
        }
    }
}

/// Steepest angle that can be planned.
pub const STEEPEST: f64 = 89.9;
/// Points that can be planned with: more would make the sliders wait.
pub const MOST_PLANNED: usize = 4000;

impl DesignSettings {
    /// Whether its values mean something.
    pub fn is_sound(&self) -> bool {
        self.theta_i.iter().all(|span| span.is_sound(0.0..=STEEPEST))
            && self.theta_r.iter().all(|span| span.is_sound(-STEEPEST..=STEEPEST))
            && self.dphi.is_finite()
            && [self.noise, self.brdf_noise].iter().all(|noise| noise.is_finite() && *noise > 0.0)
    }

    /// How many angles of incidence, and of view.
    pub fn counts(&self) -> (usize, usize) {
        let count = |spans: &[AngleRange]| spans.iter().map(AngleRange::count).sum();
        (count(&self.theta_i), count(&self.theta_r))
    }

    /// Whether a BRDF would be measured.
    pub fn has_brdf(&self) -> bool {
        self.columns != Columns::Dolp
    }

    pub fn noise(&self) -> NoiseModel {
        let if_measured = |noise, other| (self.columns != other).then_some(noise);
        NoiseModel { dolp: if_measured(self.noise, Columns::Brdf), brdf: if_measured(self.brdf_noise, Columns::Dolp) }
    }

    pub fn geometries(&self) -> Vec<Geometry> {
        let theta_i = || self.theta_i.iter().flat_map(|span| span.angles());
        let theta_r = || self.theta_r.iter().flat_map(|span| span.angles());
        // A negative θr is the other side of the same plane.
        let geometry = |i: f64, r: f64| Geometry::new(i, r.abs(), if r < 0.0 { self.dphi - 180.0 } else { self.dphi }).ok();
        theta_i().flat_map(|i| theta_r().map(move |r| (i, r))).filter_map(|(i, r)| geometry(i, r)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::AngleRange;

    #[test]
    fn spans_count_both_ends() {
        assert_eq!(AngleRange::new(20.0, 60.0, 5.0).count(), 9);
        assert_eq!(AngleRange::new(0.0, 0.3, 0.1).angles().count(), 4);
        assert_eq!(AngleRange::new(30.0, 30.0, 5.0).count(), 1);
    }
}
