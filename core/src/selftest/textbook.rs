//! The textbook form of the model: the yardstick of the reports, used nowhere else.
//!
//! Eqs. (2), (4)–(7), (10), (12)–(14) and (17) of the paper as they are printed (k_s inside the numerator of (17), no rotation, which
//! DoLP does not depend on), with Fresnel's coefficients in their usual real form (Priest and Germer, Proc. MSS (2000)):
//!
//! - `2A² = √((n² − k² − sin²β)² + 4n²k²) + n² − k² − sin²β`, `2B² = √(…) − (n² − k² − sin²β)`
//! - `Rs = [(A − cos β)² + B²]/[(A + cos β)² + B²]`
//! - `Rp = Rs [(A − sin β tan β)² + B²]/[(A + sin β tan β)² + B²]`
//!
//! Angles become radians first, differences are taken where they stand, and nothing is done about cancellation, overflow or 0/0, but
//! that square roots of what rounding makes negative are 0.

use crate::model::{Diffuse, Model, Parameters, lost_by_single_reflection};
use crate::optics::{Geometry, Masking, SlopeDistribution};

macro_rules! textbook {
    ($(#[$doc:meta])* $name:ident, $real:ident, $sin:path, $cos:path, $exp:path, $pow:path) => {
        $(#[$doc])*
        #[must_use]
        #[allow(clippy::cast_possible_truncation, reason = "single precision is the point of the f32 variant")]
        pub fn $name(model: Model, parameters: &Parameters, geometry: Geometry) -> ($real, $real) {
            let [n, k, sigma, ks, kd, kv, q, c, sigma_v] = parameters.to_array().map(|value| value as $real);
            let angles = [geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0];
            let pi = std::$real::consts::PI;
            let [theta_i, theta_r, dphi] = angles.map(|degrees| degrees as $real * pi / 180.0);
            let root = |square: $real| square.max(0.0).sqrt();
            let (cos_i, cos_r) = ($cos(theta_i), $cos(theta_r));

            // (2)
            let cos_2beta = cos_i * cos_r + $sin(theta_i) * $sin(theta_r) * $cos(dphi);
            let cos_beta = root((1.0 + cos_2beta) / 2.0);
            let sin_beta = root((1.0 - cos_2beta) / 2.0);
            let cos_alpha = (cos_i + cos_r) / (2.0 * cos_beta);
            let tan_alpha_sq = (1.0 / (cos_alpha * cos_alpha) - 1.0).max(0.0);

            // Fresnel
            let difference = n * n - k * k - sin_beta * sin_beta;
            let modulus = (difference * difference + 4.0 * n * n * k * k).sqrt();
            let (a, b) = (root((modulus + difference) / 2.0), root((modulus - difference) / 2.0));
            let sq = |x: $real| x * x;
            let rs = (sq(a - cos_beta) + b * b) / (sq(a + cos_beta) + b * b);
            let st = sin_beta * sin_beta / cos_beta;
            let rp = rs * (sq(a - st) + b * b) / (sq(a + st) + b * b);

            // (5), (7), (6), (4)
            let cos_alpha_cubed = cos_alpha * cos_alpha * cos_alpha;
            let p = match model.distribution {
                SlopeDistribution::Gauss => {
                    $exp(-tan_alpha_sq / (2.0 * sigma * sigma)) / (2.0 * pi * sigma * sigma * cos_alpha_cubed)
                }
                SlopeDistribution::Cauchy => {
                    let width = std::$real::consts::SQRT_2 * sigma;
                    (q - 1.0) * $pow(width, 2.0 * q - 2.0) / (pi * cos_alpha_cubed * $pow(tan_alpha_sq + width * width, q))
                }
            };
            let g = match model.masking {
                Masking::None => 1.0,
                Masking::VGroove => (1.0 as $real).min(2.0 * cos_alpha * cos_r / cos_beta).min(2.0 * cos_alpha * cos_i / cos_beta),
            };
            let shape = if model.specular { ks * p * g / (4.0 * cos_alpha * cos_i * cos_r) } else { 0.0 };

            // (12), (13), (14), (17)
            let diffuse = match model.diffuse {
                Diffuse::Absent => 0.0,
                Diffuse::Lambert => kd / pi,
                Diffuse::Minnaert => kd * $pow(cos_i * cos_r, c) / pi,
                // An integral has no textbook form: that of the core.
                Diffuse::Hyde if model.specular => ks * lost_by_single_reflection(model, parameters, geometry.theta_i()) as $real / pi,
                Diffuse::Hyde => 0.0,
            };
            let volume = if model.volume {
                kv * $exp(-theta_r * theta_r / (2.0 * sigma_v * sigma_v)) / ((2.0 * pi).sqrt() * sigma_v)
            } else {
                0.0
            };
            let brdf = shape * (rs + rp) / 2.0 + diffuse + volume;
            (brdf, shape * (rs - rp).abs() / 2.0 / brdf)
        }
    };
}

textbook! {
    /// BRDF in sr⁻¹ and DoLP in double precision.
    textbook_f64, f64, libm::sin, libm::cos, libm::exp, libm::pow
}
textbook! {
    /// BRDF in sr⁻¹ and DoLP in single precision.
    textbook_f32, f32, libm::sinf, libm::cosf, libm::expf, libm::powf
}

#[cfg(test)]
mod tests {
    use super::{textbook_f32, textbook_f64};
    use crate::model::{Model, PRESETS, Parameters, Pbrdf};
    use crate::optics::{Facet, Geometry, SlopeDistribution};

    #[test]
    fn the_textbook_agrees_with_the_core_on_ordinary_ground() {
        // (1 − cos 2β)/2 loses two digits at β = 15°; single precision has seven to begin with.
        const DOUBLE: f64 = 1e-13;
        const SINGLE: f64 = 1e-4;
        let geometry = Geometry::new(40.0, 55.0, 150.0).expect("angles in range");
        let parameters = Parameters { ks: 0.7, ..Parameters::default() };
        let models = PRESETS.iter().map(|preset| preset.model).chain([Model { specular: false, ..Model::full(SlopeDistribution::Gauss) }]);
        for model in models {
            let reflection = Pbrdf::new(model, parameters).expect("defaults lie in the domain").reflection(&Facet::new(geometry));
            let (brdf, dolp) = textbook_f64(model, &parameters, geometry);
            let (brdf_32, dolp_32) = textbook_f32(model, &parameters, geometry);
            for (value, single, expected) in [(brdf, brdf_32, reflection.brdf), (dolp, dolp_32, reflection.dolp)] {
                assert!((value - expected).abs() <= DOUBLE * expected, "{model:?}: {value} {expected}");
                assert!((f64::from(single) - expected).abs() <= SINGLE * expected, "{model:?}: {single} {expected}");
            }
        }
    }
}
