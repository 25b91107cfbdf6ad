//! Angles that might be measured.

use pbrdf::fit::NoiseModel;
use pbrdf::measurement::Columns;
use pbrdf::model::{Parameter, ParameterSet};
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

/// What a plan is to be good for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DesignGoal {
    /// All free parameters.
    #[default]
    All,
    /// n and k.
    Index,
    /// σ and q.
    Roughness,
    /// Whether slopes are as Gauss or as Cauchy has them.
    Distribution,
}

impl DesignGoal {
    pub const ALL: [Self; 4] = [Self::All, Self::Index, Self::Roughness, Self::Distribution];

    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all parameters",
            Self::Index => "n and k",
            Self::Roughness => "σ and q",
            Self::Distribution => "Gauss or Cauchy",
        }
    }

    /// The free parameters that are wanted; of models that are to be told apart none.
    pub fn parameters(self, free: ParameterSet) -> ParameterSet {
        let of = |parameters: [Parameter; 2]| free.intersection(parameters.into_iter().collect());
        match self {
            Self::All => free,
            Self::Index => of([Parameter::N, Parameter::K]),
            Self::Roughness => of([Parameter::Sigma, Parameter::Q]),
            Self::Distribution => ParameterSet::EMPTY,
        }
    }
}

/// A measurement that might be made: every θi with every θr, or readings picked from these.
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
    /// What it is to be good for.
    pub goal: DesignGoal,
    /// How many readings are to be chosen.
    pub count: usize,
    /// Whether what is measured already counts.
    pub counts_given: bool,
    /// θi and signed θr of the readings that are planned, one of a repeated reading as often as it is repeated; all pairs where there is
    /// none.
    pub readings: Vec<[f64; 2]>,
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
            goal: DesignGoal::All,
            count: 27,
            counts_given: true,
            readings: Vec::new(),
        }
    }
}

/// Steepest angle that can be planned.
pub const STEEPEST: f64 = 89.9;
/// Points that can be planned with: more would make the sliders wait.
pub const MOST_PLANNED: usize = 4000;

/// Readings that can be chosen, least and most.
pub const READINGS: std::ops::RangeInclusive<usize> = 1..=400;

impl DesignSettings {
    /// Whether its values mean something.
    pub fn is_sound(&self) -> bool {
        self.theta_i.iter().all(|span| span.is_sound(0.0..=STEEPEST))
            && self.theta_r.iter().all(|span| span.is_sound(-STEEPEST..=STEEPEST))
            && self.dphi.is_finite()
            && [self.noise, self.brdf_noise].iter().all(|noise| noise.is_finite() && *noise > 0.0)
            && READINGS.contains(&self.count)
            && self.readings.len() <= MOST_PLANNED
            && self.readings.iter().flatten().all(|angle| angle.abs() <= STEEPEST)
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
        let [theta_i, theta_r] = self.lists();
        let geometry = |i: f64, r: f64| self.geometry([i, r]);
        theta_i.iter().flat_map(|i| theta_r.iter().map(move |r| (*i, *r))).filter_map(|(i, r)| geometry(i, r)).collect()
    }

    /// The geometry of θi and a signed θr; a negative one is the other side of the same plane.
    pub fn geometry(&self, [theta_i, theta_r]: [f64; 2]) -> Option<Geometry> {
        Geometry::new(theta_i, theta_r.abs(), if theta_r < 0.0 { self.dphi - 180.0 } else { self.dphi }).ok()
    }

    /// The angles of incidence, and of view.
    pub fn lists(&self) -> [Vec<f64>; 2] {
        [&self.theta_i, &self.theta_r].map(|spans| spans.iter().flat_map(|span| span.angles()).collect())
    }

    /// Adds a reading to those that are planned, or takes it out.
    pub fn toggle(&mut self, reading: [f64; 2]) {
        let before = self.readings.len();
        self.readings.retain(|other| *other != reading);
        if self.readings.len() == before {
            self.readings.push(reading);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{AngleRange, DesignGoal, DesignSettings};
    use pbrdf::model::{Parameter, ParameterSet};

    #[test]
    fn a_reading_is_added_once_and_taken_out_again() {
        let mut design = DesignSettings::default();
        design.toggle([20.0, -5.0]);
        design.toggle([20.0, 5.0]);
        assert_eq!(design.readings.len(), 2);
        design.toggle([20.0, -5.0]);
        assert_eq!(design.readings, [[20.0, 5.0]]);
        assert!(design.is_sound() && !DesignSettings { readings: vec![[f64::NAN, 0.0]], ..design }.is_sound());
    }

    #[test]
    fn a_goal_wants_what_is_free() {
        let free = ParameterSet::EMPTY.with(Parameter::N).with(Parameter::Sigma).with(Parameter::Kd);
        let wanted = |goal: DesignGoal| goal.parameters(free).iter().collect::<Vec<_>>();
        assert_eq!((wanted(DesignGoal::Index), wanted(DesignGoal::Roughness)), (vec![Parameter::N], vec![Parameter::Sigma]));
        assert_eq!((wanted(DesignGoal::All).len(), wanted(DesignGoal::Distribution).len()), (3, 0));
    }

    #[test]
    fn spans_count_both_ends() {
        assert_eq!(AngleRange::new(20.0, 60.0, 5.0).count(), 9);
        assert_eq!(AngleRange::new(0.0, 0.3, 0.1).angles().count(), 4);
        assert_eq!(AngleRange::new(30.0, 30.0, 5.0).count(), 1);
    }
}
