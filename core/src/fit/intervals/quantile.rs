//! Quantiles that a rise of the objective is compared with: of χ² with one degree of freedom, and of F with one and ν.
//!
//! `F_{1,ν}(level)` is the square of Student's t quantile at (1 + level)/2. Student's distribution function is a finite sum for whole
//! ν (Abramowitz and Stegun, *Handbook of Mathematical Functions*, 26.7.3 and 26.7.4); for many degrees of freedom the quantile follows
//! from the normal one (26.7.5).

use libm::{atan, cos, erfc, exp, sin, sqrt};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_PI, PI};

/// Degrees of freedom beyond which the expansion in 1/ν, whose first neglected term is of the order of 10/ν⁴, is exact to 1e-9.
const MANY: usize = 400;
/// Steps of Newton's method: they converge quadratically from the normal quantile.
const STEPS: usize = 40;

/// The level-quantile of F with 1 and `dof` degrees of freedom; infinite without any.
pub(crate) fn f_quantile(level: f64, dof: usize) -> f64 {
    let normal = normal_quantile(level);
    let t = match dof {
        0 => return f64::INFINITY,
        _ if dof > MANY => expanded(normal, dof),
        // From below, where the distribution function is concave, Newton's steps do not overshoot.
        _ => (0..STEPS).fold(normal, |t, _| t + (level - student(t, dof)) / (2.0 * student_density(t, dof))),
    };
    t * t
}

/// The level-quantile of χ² with one degree of freedom.
pub(crate) fn chi_squared_quantile(level: f64) -> f64 {
    let normal = normal_quantile(level);
    normal * normal
}

/// x with P(|X| < x) = level for a standard normal X.
fn normal_quantile(level: f64) -> f64 {
    let density = |x: f64| 2.0 * exp(-0.5 * x * x) / sqrt(2.0 * PI);
    (0..STEPS).fold(0.0, |x, _| x + (level - (1.0 - erfc(x * FRAC_1_SQRT_2))) / density(x))
}

/// P(|T| < t) for Student's T.
#[expect(clippy::cast_precision_loss, reason = "at most MANY degrees of freedom")]
fn student(t: f64, dof: usize) -> f64 {
    let theta = atan(t / sqrt(dof as f64));
    let (sine, cosine) = (sin(theta), cos(theta));
    let is_odd = dof % 2 == 1;
    // Terms of the series: cos θ, (2/3) cos³ θ … for odd ν, 1, (1/2) cos² θ … for even ν.
    let mut term = if is_odd { cosine } else { 1.0 };
    let mut sum = if dof == 1 { 0.0 } else { term };
    let mut i = if is_odd { 3 } else { 2 };
    while i < dof {
        term *= (i - 1) as f64 / i as f64 * cosine * cosine;
        sum += term;
        i += 2;
    }
    if is_odd { FRAC_2_PI * (theta + sine * sum) } else { sine * sum }
}

/// Density of Student's T, `Γ((ν+1)/2) / (√(νπ) Γ(ν/2)) (1 + t²/ν)^(−(ν+1)/2)`.
#[expect(clippy::cast_precision_loss, reason = "at most MANY degrees of freedom")]
fn student_density(t: f64, dof: usize) -> f64 {
    let v = dof as f64;
    let ln = libm::lgamma(0.5 * (v + 1.0)) - libm::lgamma(0.5 * v) - 0.5 * libm::log(v * PI) - 0.5 * (v + 1.0) * libm::log1p(t * t / v);
    exp(ln)
}

/// Student's quantile from the normal one, in powers of 1/ν.
#[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
fn expanded(x: f64, dof: usize) -> f64 {
    let (v, x2) = (dof as f64, x * x);
    let g1 = x * (x2 + 1.0) / 4.0;
    let g2 = x * ((5.0 * x2 + 16.0) * x2 + 3.0) / 96.0;
    let g3 = x * (((3.0 * x2 + 19.0) * x2 + 17.0) * x2 - 15.0) / 384.0;
    x + (g1 + (g2 + g3 / v) / v) / v
}

#[cfg(test)]
mod tests {
    use super::{MANY, chi_squared_quantile, expanded, f_quantile, normal_quantile};

    /// Quantiles from SciPy, `scipy.stats.f.ppf(level, 1, dof)`, to twelve digits.
    const SCIPY: [(f64, usize, f64); 8] = [
        (0.95, 1, 161.447638797588),
        (0.95, 2, 18.5128205128205),
        (0.95, 7, 5.59144785122074),
        (0.95, 19, 4.38074969233179),
        (0.6827, 19, 1.05481178327944),
        (0.6827, 1, 3.37607341158077),
        (0.95, 136, 3.91074662498438),
        (0.95, 20_000, 3.8419238190435),
    ];

    #[test]
    fn f_quantiles_are_scipys() {
        for (level, dof, expected) in SCIPY {
            let found = f_quantile(level, dof);
            assert!((found / expected - 1.0).abs() < 1e-9, "{level} {dof}: {found} instead of {expected}");
        }
    }

    #[test]
    fn the_expansion_meets_the_sum() {
        for level in [0.6827, 0.95] {
            let t = expanded(normal_quantile(level), MANY);
            assert!((t * t / f_quantile(level, MANY) - 1.0).abs() < 1e-8);
        }
    }

    #[test]
    fn one_degree_of_freedom_of_chi_squared() {
        assert!((chi_squared_quantile(0.95) - 3.841458820694124).abs() < 1e-12);
        assert!(f_quantile(0.95, 0).is_infinite());
    }
}
