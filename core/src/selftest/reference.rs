//! The bundled 60-digit tables, and the measures of error against them (MODEL.md of the model's definition, sections 6 and 8).

use crate::model::{Model, Parameter, Parameters, Pbrdf, PerParameter};
use crate::optics::{Facet, Geometry, SlopeDistribution};

/// Values at random settings, ordinary and extreme.
const GOLDEN: &str = include_str!("../../assets/reference/golden.csv");

/// Bar on the relative error of BRDF and DoLP.
pub const VALUE_BAR: f64 = 1e-13;
/// Bar on the error of the gradient.
pub const GRADIENT_BAR: f64 = 1e-12;
/// Bar on DoLP and its gradient where all lobes are darker than e^−120.
pub const DARK_BAR: f64 = 1e-9;

/// References below this are compared by their absolute error.
const NEGLIGIBLE: f64 = 1e-30;
/// e^−120.
const DARK: f64 = 1e-52;
/// Weight below which a parameter does not count for less, in the measure of gradients.
const SMALLEST_WEIGHT: f64 = 1e-3;

/// A setting and what 60 digits say of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// What it is an example of.
    pub case: String,
    /// Model and parameters.
    pub surface: Pbrdf,
    /// The directions.
    pub geometry: Geometry,
    /// BRDF in sr⁻¹.
    pub brdf: f64,
    /// DoLP.
    pub dolp: f64,
    /// Whether DoLP is a ratio of lobes that are all darker than e^−120: its exponents then hold fewer digits.
    pub is_dark: bool,
    /// ∂BRDF/∂p and ∂DoLP/∂p, where the table has them.
    pub gradient: Option<[PerParameter<f64>; 2]>,
}

/// The rows of `golden.csv`.
#[must_use]
pub fn golden() -> Vec<Reference> {
    references(GOLDEN)
}

/// The rows of a bundled table; those that are none are left out, and tests see that there is none of them.
pub(crate) fn references(table: &str) -> Vec<Reference> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(table.as_bytes());
    let Ok(header) = reader.headers().cloned() else { return Vec::new() };
    reader.records().filter_map(|record| reference(&header, &record.ok()?)).collect()
}

fn reference(header: &csv::StringRecord, record: &csv::StringRecord) -> Option<Reference> {
    let cell = |name: &str| record.get(header.iter().position(|column| column == name)?);
    let number = |name: &str| cell(name)?.parse::<f64>().ok();
    let mut parameters = Parameters::default();
    for parameter in Parameter::ALL {
        parameters[parameter] = number(parameter.key())?;
    }
    let model = Model::full(SlopeDistribution::from_key(cell("distribution")?)?);
    let derivatives = |prefix: &str| {
        let mut all = PerParameter::default();
        for parameter in Parameter::ALL {
            all[parameter] = number(&format!("{prefix}{}", parameter.key()))?;
        }
        Some(all)
    };
    let depolarises = parameters.kd > 0.0 || parameters.kv > 0.0;
    let lobes = [number("specular")?, number("diffuse")?, number("volume")?];
    Some(Reference {
        is_dark: depolarises && lobes.into_iter().all(|lobe| lobe < DARK),
        case: cell("case")?.to_owned(),
        surface: Pbrdf::new(model, parameters).ok()?,
        geometry: Geometry::new(number("theta_i")?, number("theta_r")?, number("dphi")?).ok()?,
        brdf: number("brdf")?,
        dolp: number("dolp")?,
        gradient: derivatives("dbrdf_d").zip(derivatives("ddolp_d")).map(|(brdf, dolp)| [brdf, dolp]),
    })
}

/// |x − r|/|r|, at most 1: not a single digit. References below 1e-30 are compared by their absolute error.
#[must_use]
pub fn relative_error(value: f64, reference: f64) -> f64 {
    let error = (value - reference).abs();
    if error.is_nan() {
        1.0
    } else if reference.abs() < NEGLIGIBLE {
        if error <= NEGLIGIBLE { 0.0 } else { 1.0 }
    } else {
        (error / reference.abs()).min(1.0)
    }
}

/// Error of a gradient, at most 1: the worst component by the smaller of |e|/|∂| and |e| w/max(|∂| w), w = max(|p|, 1e-3), since some
/// derivatives pass through zero. |e| ≤ 1e-30 counts as 0; a reference beyond f64 is outside every bar.
#[must_use]
pub fn gradient_error(values: &PerParameter<f64>, references: &PerParameter<f64>, parameters: &Parameters) -> f64 {
    let weights = parameters.to_array().map(|value| value.abs().max(SMALLEST_WEIGHT));
    let scale = references.iter().zip(weights).map(|(derivative, weight)| (derivative * weight).abs());
    let scale = scale.filter(|size| size.is_finite()).fold(0.0, f64::max);
    let of = |((value, reference), weight): ((&f64, &f64), f64)| {
        let error = (value - reference).abs();
        if reference.is_infinite() || error <= NEGLIGIBLE {
            0.0
        } else if error.is_nan() {
            1.0
        } else {
            (error / reference.abs()).min(error * weight / scale).min(1.0)
        }
    };
    values.iter().zip(references).zip(weights).map(of).fold(0.0, f64::max)
}

/// sin²β/|N² − sin²β|, at least 1: by how much a transparent index below 1 near its critical angle magnifies a rounding of sin²β.
#[must_use]
pub fn critical_angle_factor(parameters: &Parameters, geometry: Geometry) -> f64 {
    let sin_sq = Facet::new(geometry).sin_beta_sq;
    let (n, k) = (parameters.n, parameters.k);
    (sin_sq / libm::hypot((n - k) * (n + k) - sin_sq, 2.0 * n * k)).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::{GOLDEN, golden, gradient_error, relative_error};
    use crate::model::{Parameter, Parameters, PerParameter};

    #[test]
    fn every_row_of_the_bundled_table_is_read() {
        let lines = GOLDEN.lines().filter(|line| !line.starts_with('#')).count();
        assert_eq!(golden().len(), lines - 1);
    }

    #[test]
    fn errors_are_relative_and_end_at_one() {
        assert_eq!(relative_error(1.5, 1.0), 0.5);
        assert_eq!(relative_error(f64::NAN, 1.0), 1.0);
        assert_eq!(relative_error(f64::INFINITY, 1.0), 1.0);
        assert_eq!((relative_error(1e-31, 0.0), relative_error(1e-20, 0.0)), (0.0, 1.0));
    }

    #[test]
    fn a_small_derivative_is_judged_beside_the_large_ones() {
        let parameters = Parameters { n: 1.0, k: 1.0, ..Parameters::default() };
        let mut references = PerParameter::default();
        references[Parameter::N] = 1.0;
        references[Parameter::K] = 1e-12;
        let mut values = references;
        values[Parameter::K] = 2e-12;
        assert_eq!(gradient_error(&values, &references, &parameters), 1e-12);
        values[Parameter::N] = f64::NAN;
        assert_eq!(gradient_error(&values, &references, &parameters), 1.0);
    }
}
