//! The choices of a fit: what a residual is, what divides it, how it counts.

use crate::measurement::plane_of;
use crate::optics::Geometry;
use serde::{Deserialize, Serialize};

/// What divides a residual.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// Nothing but the scale of Eq. (18).
    #[default]
    None,
    /// The stated standard deviation of each value.
    Sigma,
}

/// How a BRDF residual is formed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BrdfResiduals {
    /// X − Xm.
    Absolute,
    /// (X − Xm)/Xm.
    #[default]
    Relative,
    /// ln X − ln Xm.
    Log,
}

/// How a residual counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Loss {
    /// By its square.
    #[default]
    #[serde(alias = "linear")]
    Squared,
    /// By its square up to the scale, by its size beyond.
    Huber,
    /// The same with a smooth passage.
    SoftL1,
}

/// How the uncertainty of the parameters is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Intervals {
    /// By profile likelihood; linear standard errors only where they agree.
    #[default]
    Profile,
    /// By the Jacobian at the solution.
    Linear,
    /// Not at all.
    None,
}

/// The angles that are fitted; rows outside are left out, as masked ones are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FitRange {
    /// From and to, degrees, both included.
    pub theta_i: [f64; 2],
    /// From and to, degrees, both included; negative on the backscatter side.
    pub theta_r: [f64; 2],
}

impl Default for FitRange {
    /// All angles.
    fn default() -> Self {
        Self { theta_i: [0.0, 90.0], theta_r: [-90.0, 90.0] }
    }
}

impl FitRange {
    /// Whether a geometry is fitted.
    #[must_use]
    pub fn contains(&self, geometry: Geometry) -> bool {
        let (_, theta_r) = plane_of(geometry);
        let is_within = |[from, to]: [f64; 2], angle: f64| (from..=to).contains(&angle);
        is_within(self.theta_i, geometry.theta_i().0) && is_within(self.theta_r, theta_r)
    }
}

/// The choices of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct FitOptions {
    /// What divides a residual.
    pub weights: Weights,
    /// How a BRDF residual is formed.
    pub brdf_residuals: BrdfResiduals,
    /// How a residual counts.
    pub loss: Loss,
    /// Scale of the loss, in units of X − Xm (or of what else the residual is before Eq. (18) scales it; in standard deviations
    /// where these weigh); without, 1.345 × the normalised median absolute deviation of the residuals of a fit with the squared loss.
    pub loss_scale: Option<f64>,
    /// Leave measured BRDFs aside: the model does not predict them.
    pub dolp_only: bool,
    /// The angles that are fitted; without, all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<FitRange>,
}
