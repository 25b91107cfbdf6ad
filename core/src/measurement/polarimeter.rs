//! DoLP from what a polarimeter, an ellipsometer or a Mueller matrix gives, for unpolarised light in.
//!
//! - S0, S1, S2: √(S1² + S2²)/S0
//! - I0, I45, I90, I135: S0 = (I0 + I45 + I90 + I135)/2, S1 = I0 − I90, S2 = I45 − I135
//! - Rs, Rp: |Rs − Rp|/(Rs + Rp)
//! - ψ: |cos 2ψ|
//! - Mueller matrix: √(m10² + m20²)/m00
//!
//! Standard deviations are propagated by the first derivatives, of independent errors.

use crate::measurement::{Channel, Quantity};
use crate::optics::Degrees;

/// Quantities that give a DoLP together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Polarimeter {
    /// S0, S1, S2.
    Stokes,
    /// I0, I45, I90, I135.
    Intensities,
    /// m00, m10, m20.
    Mueller,
    /// Rs, Rp.
    Reflectances,
    /// ψ in degrees.
    Psi,
}

impl Polarimeter {
    /// All, those that say most first.
    pub const ALL: [Self; 5] = [Self::Stokes, Self::Intensities, Self::Mueller, Self::Reflectances, Self::Psi];

    /// The channels that it needs, in the order that [`Polarimeter::dolp`] takes them.
    #[must_use]
    pub fn channels(self) -> &'static [Channel] {
        match self {
            Self::Stokes => &[Channel::S0, Channel::S1, Channel::S2],
            Self::Intensities => &[Channel::I0, Channel::I45, Channel::I90, Channel::I135],
            Self::Mueller => &[Channel::M00, Channel::M10, Channel::M20],
            Self::Reflectances => &[Channel::Rs, Channel::Rp],
            Self::Psi => &[Channel::Psi],
        }
    }

    /// Whether it is measured in the direction of mirror reflection, so that one angle is both.
    #[must_use]
    pub fn is_specular(self) -> bool {
        matches!(self, Self::Reflectances | Self::Psi)
    }

    /// DoLP of the values of the channels, with its standard deviation where all of theirs are
    /// known; none where there is no light.
    #[must_use]
    pub fn dolp(self, values: &[Quantity]) -> Option<Quantity> {
        let value = |index: usize| values.get(index).map_or(f64::NAN, |quantity| quantity.value);
        let (dolp, slopes): (f64, Vec<f64>) = match self {
            Self::Stokes | Self::Mueller => {
                let (dolp, [a, b, c]) = stokes(value(0), value(1), value(2));
                (dolp, vec![a, b, c])
            }
            Self::Intensities => {
                let s0 = 0.5 * (value(0) + value(1) + value(2) + value(3));
                let (dolp, [a, b, c]) = stokes(s0, value(0) - value(2), value(1) - value(3));
                (dolp, vec![0.5 * a + b, 0.5 * a + c, 0.5 * a - b, 0.5 * a - c])
            }
            Self::Reflectances => {
                let (s, p) = (value(0), value(1));
                let sum = s + p;
                ((s - p).abs() / sum, vec![2.0 * p / (sum * sum), 2.0 * s / (sum * sum)])
            }
            Self::Psi => {
                let (sin, cos) = Degrees(2.0 * value(0)).sin_cos();
                (cos.abs(), vec![2.0 * sin * 1.0_f64.to_radians()])
            }
        };
        let variance = slopes.iter().zip(values).try_fold(0.0, |sum, (slope, quantity)| Some(sum + (slope * quantity.sigma?).powi(2)));
        let sigma = variance.map(f64::sqrt).filter(|sigma| *sigma > 0.0 && sigma.is_finite());
        dolp.is_finite().then_some(Quantity { value: dolp, sigma })
    }
}

/// √(S1² + S2²)/S0 and its derivatives; where S1 = S2 = 0, their mean size over all directions.
fn stokes(s0: f64, s1: f64, s2: f64) -> (f64, [f64; 3]) {
    let polarised = libm::hypot(s1, s2);
    let dolp = if s0 > 0.0 { polarised / s0 } else { f64::NAN };
    let (cos, sin) = if polarised > 0.0 { (s1 / polarised, s2 / polarised) } else { (0.5_f64.sqrt(), 0.5_f64.sqrt()) };
    (dolp, [-dolp / s0, cos / s0, sin / s0])
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::Polarimeter;
    use crate::measurement::Quantity;

    fn of(polarimeter: Polarimeter, values: &[(f64, f64)]) -> Quantity {
        let values: Vec<Quantity> = values.iter().map(|&(value, sigma)| Quantity { value, sigma: Some(sigma) }).collect();
        polarimeter.dolp(&values).expect("there is light")
    }

    #[test]
    fn dolp_is_that_of_the_definitions() {
        // By hand: √(3² + 4²)/10, |0.6 − 0.4|/1, |cos 60°|.
        for (polarimeter, values, dolp) in [
            (Polarimeter::Stokes, &[10.0, 3.0, -4.0][..], 0.5),
            (Polarimeter::Mueller, &[10.0, -3.0, 4.0], 0.5),
            (Polarimeter::Intensities, &[6.5, 7.0, 3.5, 3.0], 0.5),
            (Polarimeter::Reflectances, &[0.4, 0.6], 0.2),
            (Polarimeter::Psi, &[30.0], 0.5),
        ] {
            let values: Vec<(f64, f64)> = values.iter().map(|&value| (value, 0.01)).collect();
            assert!((of(polarimeter, &values).value - dolp).abs() < 1e-15, "{polarimeter:?}");
        }
        assert_eq!(Polarimeter::Stokes.dolp(&[0.0, 1.0, 1.0].map(|value| Quantity { value, sigma: None })), None);
    }

    #[test]
    fn errors_are_those_of_difference_quotients() {
        for (polarimeter, values) in [
            (Polarimeter::Stokes, &[10.0, 3.0, -4.0][..]),
            (Polarimeter::Intensities, &[6.5, 7.0, 3.5, 3.0]),
            (Polarimeter::Reflectances, &[0.4, 0.6]),
            (Polarimeter::Psi, &[31.0]),
        ] {
            let errors: Vec<f64> = (1..=values.len()).map(|index| 1e-3 * index as f64).collect();
            let exact: Vec<(f64, f64)> = values.iter().copied().zip(errors.iter().copied()).collect();
            let step = 1e-6;
            let square = |index: usize| {
                let mut ends = [exact.clone(), exact.clone()];
                ends[0][index].0 -= step;
                ends[1][index].0 += step;
                let [low, high] = ends.map(|values| of(polarimeter, &values).value);
                ((high - low) / (2.0 * step) * errors[index]).powi(2)
            };
            let expected = (0..values.len()).map(square).sum::<f64>().sqrt();
            let sigma = of(polarimeter, &exact).sigma.expect("all errors are known");
            // The difference quotient has six digits.
            assert!((sigma / expected - 1.0).abs() < 1e-6, "{polarimeter:?}: {sigma} {expected}");
        }
    }
}
