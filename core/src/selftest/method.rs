//! The methods that the accuracy report compares.

use std::fmt;

/// How the model is evaluated or fitted in a row of the accuracy report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BenchmarkMethod {
    /// The formulas as they are printed, in f32.
    TextbookF32,
    /// The formulas as they are printed, in f64.
    TextbookF64,
    /// The scalar form without cancellation, from angles.
    FromAngles,
    /// The scalar form without cancellation, with prepared geometries.
    Prepared,
    /// The batch kernels, with prepared geometries.
    Batch,
    /// The reference solver.
    LevenbergMarquardt {
        /// Whether derivatives are analytic, else finite differences.
        analytic: bool,
        /// Whether parameters are scaled.
        scaled: bool,
        /// How many starts are taken one after the other.
        starts: u32,
    },
    /// The fit of this program from one start.
    OneStart,
    /// The fit of this program from the starts of its own choice.
    ManyStarts,
    /// The fit of the preset with this key.
    Model(&'static str),
}

impl BenchmarkMethod {
    /// A name for a legend.
    #[must_use]
    pub fn short_name(&self) -> String {
        match self {
            Self::LevenbergMarquardt { analytic, scaled, starts } => {
                let jacobian = if *analytic { "analytic" } else { "differences" };
                format!("LM, {jacobian}, {}, {}", scaling(*scaled), Count(*starts))
            }
            other => other.to_string(),
        }
    }
}

impl fmt::Display for BenchmarkMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TextbookF32 => f.write_str("textbook, f32"),
            Self::TextbookF64 => f.write_str("textbook, f64"),
            Self::FromAngles => f.write_str("cancellation-free, from angles"),
            Self::Prepared => f.write_str("cancellation-free, prepared scene"),
            Self::Batch => f.write_str("batch kernel, prepared scene"),
            Self::LevenbergMarquardt { analytic, scaled, starts } => {
                let jacobian = if *analytic { "analytic" } else { "finite-difference" };
                write!(f, "Levenberg–Marquardt, {jacobian} Jacobian, {}, {}", scaling(*scaled), Count(*starts))
            }
            Self::OneStart => f.write_str("this program, one start"),
            Self::ManyStarts => f.write_str("this program, many starts"),
            Self::Model(key) => write!(f, "model {key}"),
        }
    }
}

fn scaling(scaled: bool) -> &'static str {
    if scaled { "scaled" } else { "unscaled" }
}

/// A number of starts.
struct Count(u32);

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 1 { f.write_str("one start") } else { write!(f, "{} starts", self.0) }
    }
}
