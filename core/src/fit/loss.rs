//! Robust losses: how a residual counts in the sum of squares.
//!
//! A loss ρ turns a residual r of scale s into `s √ρ(r²/s²)`, so that the sum of squares stays one. Huber: `ρ(z) = z` up to 1 and
//! `2√z − 1` above. Soft-L1: `ρ(z) = 2(√(1 + z) − 1)`. (Huber, *Robust Statistics*, 1981, sec. 7.6.)

use crate::fit::options::Loss;

/// Huber's constant: 95 % efficient where the noise is Gaussian.
const HUBER_EFFICIENCY: f64 = 1.345;
/// Median absolute deviation of the standard normal distribution.
const NORMAL_MAD: f64 = 0.674_489_750_196_081_7;

impl Loss {
    /// A residual as the loss counts it, and the derivative of that by the residual. Squares where the scale is 0.
    pub(crate) fn apply(self, residual: f64, scale: f64) -> (f64, f64) {
        if self == Self::Squared || scale <= 0.0 {
            return (residual, 1.0);
        }
        let r = residual / scale;
        let z = r * r;
        let (rho, slope) = match self {
            Self::Squared => (z, 1.0),
            Self::Huber if z <= 1.0 => (z, 1.0),
            Self::Huber => (2.0 * r.abs() - 1.0, 1.0 / r.abs()),
            // 2(√(1 + z) − 1) without the difference.
            Self::SoftL1 => (2.0 * z / (1.0 + (1.0 + z).sqrt()), 1.0 / (1.0 + z).sqrt()),
        };
        let root = rho.sqrt();
        if root > 0.0 { (scale * root.copysign(r), slope * r.abs() / root) } else { (residual, 1.0) }
    }
}

impl Loss {
    /// ψ, half of the derivative of the loss `s² ρ(r²/s²)` by the residual: how much a row pulls.
    pub(crate) fn influence(self, residual: f64, scale: f64) -> f64 {
        let r = residual / scale;
        match self {
            _ if scale <= 0.0 => residual,
            Self::Squared => residual,
            Self::Huber => residual.clamp(-scale, scale),
            Self::SoftL1 => residual / (1.0 + r * r).sqrt(),
        }
    }

    /// ψ′.
    pub(crate) fn influence_slope(self, residual: f64, scale: f64) -> f64 {
        let r = residual / scale;
        match self {
            _ if scale <= 0.0 => 1.0,
            Self::Squared => 1.0,
            Self::Huber => f64::from(u8::from(r.abs() <= 1.0)),
            Self::SoftL1 => 1.0 / ((1.0 + r * r) * (1.0 + r * r).sqrt()),
        }
    }
}

/// The scale of a robust loss for those residuals: 1.345 × their median absolute deviation over 0.6745.
pub(crate) fn robust_scale(residuals: Vec<f64>) -> f64 {
    HUBER_EFFICIENCY * median_absolute_deviation(residuals) / NORMAL_MAD
}

/// Median of the distances from the median; 0 without values.
fn median_absolute_deviation(mut values: Vec<f64>) -> f64 {
    let middle = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let half = values.len() / 2;
        match values.len() {
            0 => 0.0,
            n if n % 2 == 1 => values[half],
            _ => f64::midpoint(values[half - 1], values[half]),
        }
    };
    let center = middle(&mut values);
    let mut distances: Vec<f64> = values.into_iter().map(|value| (value - center).abs()).collect();
    middle(&mut distances)
}
