//! The bundled 60-digit tables, and the measures of error against them (MODEL.md of the model's definition, sections 6 and 8).

use crate::model::{Model, Parameter, Parameters, Pbrdf};
use crate::optics::{Facet, Geometry, SlopeDistribution};

/// Values at random settings, ordinary and extreme.
const GOLDEN: &str = include_str!("../../assets/reference/golden.csv");

/// References below this are compared by their absolute error.
const NEGLIGIBLE: f64 = 1e-30;
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
    /// ∂BRDF/∂p and ∂DoLP/∂p, where the table has them.
    pub gradient: Option<[[f64; 9]; 2]>,
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
        let mut all = [0.0; 9];
        for (slot, parameter) in all.iter_mut().zip(Parameter::ALL) {
            *slot = number(&format!("{prefix}{}", parameter.key()))?;
        }
        Some(all)
    };
    Some(Reference {
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

/// Error of nine derivatives, at most 1: the worst component by the smaller of |e|/|∂| and |e| w/max(|∂| w), w = max(|p|, 1e-3), since some
/// derivatives pass through zero. |e| ≤ 1e-30 counts as 0; a reference beyond f64 is outside every bar.
#[must_use]
pub fn gradient_error(values: &[f64; 9], references: &[f64; 9], parameters: &Parameters) -> f64 {
    let weights = parameters.to_array().map(|value| value.abs().max(SMALLEST_WEIGHT));
    let scale = references.iter().zip(weights).map(|(derivative, weight)| (derivative * weight).abs());
    let scale = scale.filter(|size| size.is_finite()).fold(0.0, f64::max);
    let of = |j: usize| {
        let error = (values[j] - references[j]).abs();
        if references[j].is_infinite() || error <= NEGLIGIBLE {
            0.0
        } else if error.is_nan() {
            1.0
        } else {
            (error / references[j].abs()).min(error * weights[j] / scale).min(1.0)
        }
    };
    (0..9).map(of).fold(0.0, f64::max)
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
    use crate::model::Parameters;

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
        let mut references = [0.0; 9];
        references[0] = 1.0;
        references[1] = 1e-12;
        let mut values = references;
        values[1] = 2e-12;
        assert_eq!(gradient_error(&values, &references, &parameters), 1e-12);
        values[0] = f64::NAN;
        assert_eq!(gradient_error(&values, &references, &parameters), 1.0);
    }
}
