//! What the tests share: the reference tables and the measures of error they are judged by.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![allow(dead_code, reason = "each test file uses its own part of this module")]

use pbrdf::model::{Model, Parameter, Parameters, Pbrdf, PerParameter};
use pbrdf::optics::{Facet, Geometry, SlopeDistribution};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// A row of a reference table.
pub struct Row {
    pub line: u64,
    cells: HashMap<String, String>,
}

/// The reference table of that name.
pub fn table(name: &str) -> Vec<Row> {
    let path = asset(&format!("reference/{name}"));
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(&path).expect("a reference table of the repository");
    let header = reader.headers().expect("a header").clone();
    reader
        .records()
        .map(|record| {
            let record = record.expect("a whole row");
            let line = record.position().map_or(0, csv::Position::line);
            let cells = header.iter().map(str::to_owned).zip(record.iter().map(str::to_owned)).collect();
            Row { line, cells }
        })
        .collect()
}

/// A file in assets/.
pub fn asset(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(name)
}

impl Row {
    pub fn text(&self, column: &str) -> &str {
        &self.cells[column]
    }

    pub fn number(&self, column: &str) -> f64 {
        self.cells[column].parse().unwrap_or_else(|_| panic!("line {}: {column} is a number", self.line))
    }

    pub fn parameters(&self) -> Parameters {
        let mut parameters = Parameters::default();
        for parameter in Parameter::ALL {
            parameters[parameter] = self.number(parameter.key());
        }
        parameters
    }

    pub fn surface(&self) -> Pbrdf {
        let distribution = SlopeDistribution::from_key(self.text("distribution")).expect("gauss or cauchy");
        Pbrdf::new(Model::full(distribution), self.parameters()).expect("parameters inside the domain")
    }

    /// Whether DoLP is a ratio of lobes that are all darker than e^−120; false in a table without the terms.
    pub fn is_dark(&self) -> bool {
        let depolarises = self.number("kd") > 0.0 || self.number("kv") > 0.0;
        let lobes = ["specular", "diffuse", "volume"];
        depolarises && lobes.into_iter().all(|lobe| self.cells.contains_key(lobe) && self.number(lobe) < DARK)
    }

    /// sin²β/|N² − sin²β|, at least 1: how much an index at its critical angle magnifies a rounding of sin²β.
    pub fn critical_angle_factor(&self) -> f64 {
        let s = Facet::new(self.geometry()).sin_beta_sq;
        let (n, k) = (self.number("n"), self.number("k"));
        (s / libm::hypot((n - k) * (n + k) - s, 2.0 * n * k)).max(1.0)
    }

    pub fn geometry(&self) -> Geometry {
        Geometry::new(self.number("theta_i"), self.number("theta_r"), self.number("dphi")).expect("a geometry")
    }
}

/// Bar on DoLP and its derivatives where all lobes are [dark](Row::is_dark): an error of one unit in the last place of an
/// exponent x is one of x units in the lobe.
pub const DARK_VALUE: f64 = 1e-9;
/// e^−120.
const DARK: f64 = 1e-52;

/// References below this are compared by their absolute error.
pub const NEGLIGIBLE: f64 = 1e-30;

/// Relative error; 0 where value and reference agree within [`NEGLIGIBLE`] and the reference is below it.
pub fn relative_error(value: f64, reference: f64) -> f64 {
    let error = (value - reference).abs();
    if reference.abs() < NEGLIGIBLE { if error <= NEGLIGIBLE { 0.0 } else { f64::INFINITY } } else { error / reference.abs() }
}

/// Error of a gradient in the measure of MODEL.md, section 8: per component the smaller of |e|/|∂| and
/// |e| w/max(|∂| w), w = max(|p|, 1e-3); |e| ≤ 1e-30 counts as 0, and references beyond f64 are outside the bar.
pub fn gradient_error(values: &PerParameter<f64>, references: &PerParameter<f64>, parameters: &Parameters) -> f64 {
    let weights = parameters.to_array().map(|p| p.abs().max(1e-3));
    let scale = references.iter().zip(weights).map(|(d, w)| (d * w).abs()).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for ((value, reference), weight) in values.iter().zip(references).zip(weights) {
        if !reference.is_finite() {
            continue;
        }
        let error = (value - reference).abs();
        if error > NEGLIGIBLE || error.is_nan() {
            let own = error / reference.abs();
            let shared = error * weight / scale;
            worst = if error.is_nan() { f64::INFINITY } else { worst.max(own.min(shared)) };
        }
    }
    worst
}
