//! How to read a report.

use crate::selftest::method::BenchmarkMethod;
use crate::selftest::reference::{DARK_BAR, GRADIENT_BAR, VALUE_BAR};
use std::fmt;

/// A paragraph under the table of a report.
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// How many cases of the stability report pass, and where the formulas as printed lack digits.
    StabilityTotals {
        /// Cases that pass.
        passed: usize,
        /// All cases.
        cases: usize,
        /// Evaluations that the formulas as printed, in f64, get wrong by more than the limit.
        textbook_misses: usize,
        /// All evaluations.
        evaluations: usize,
    },
    /// Errors and bars of the evaluation cases of the stability report.
    StabilityEvaluations,
    /// Condition and bars of the fits of the stability report.
    StabilityFits,
    /// What the cost report times, and what it compares with.
    CostReference,
    /// Where the instructions of a point are counted.
    CostInstructions,
    /// How evaluations of the accuracy report are timed.
    AccuracyEvaluations {
        /// Rows of the 60-digit table.
        rows: usize,
    },
    /// How fits of the accuracy report are timed and judged.
    AccuracyFits {
        /// Starts of each problem.
        starts: u32,
        /// Repetitions of a fit from one start.
        repetitions: usize,
        /// Repetitions of a fit from many starts.
        repetitions_of_many: usize,
    },
    /// How the models of the accuracy report are compared.
    AccuracyModels,
    /// Half the distance between the quartiles of the times over their median, by method.
    Spreads(Vec<(BenchmarkMethod, f64)>),
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StabilityTotals { passed, cases, textbook_misses, evaluations } => write!(
                f,
                "{passed} of {cases} cases pass; the formulas as they are printed miss {VALUE_BAR:.0e} in {textbook_misses} of {evaluations} evaluations."
            ),
            Self::StabilityEvaluations => write!(
                f,
                "Evaluations: relative errors of BRDF and DoLP against 60 digits, limit {VALUE_BAR:.0e}; error of the nine derivatives by the \
                 smaller of |e|/|∂| and |e| w/max(|∂| w), w = max(|p|, 1e-3), limit {GRADIENT_BAR:.0e}; both limits times sin²β/|N² − sin²β| where that is \
                 above 1, near the critical angle, and {DARK_BAR:.0e} for DoLP of lobes that are all darker than e^−120. An error of 1 means not a single digit. textbook_error: the same by the formulas as they are printed, in f64. \
                 condition: the largest |∂ln f/∂ln p| of BRDF and DoLP."
            ),
            Self::StabilityFits => f.write_str(
                "Fits: condition is the largest over the smallest singular value of the Jacobian scaled by max(|p|, 1e-3); a fit passes if it does what its name \
                 asks for: reach the exact minimum, name what the data leave open, mark a bound, keep the truth within four standard errors, or \
                 end with a typed reason.",
            ),
            Self::CostReference => f.write_str(
                "Geometries are prepared once and not part of the time, but for the Mueller matrix, which starts from the angles. Differences are to the \
                 full scalar evaluation, over a dozen surfaces: in units of the last place where terms or derivatives are only left out, relative \
                 for the batch kernel, whose exponential and logarithm are its own (gradients: an error relative to the largest component counts too).",
            ),
            Self::CostInstructions => f.write_str(
                "Instructions per point are counted by valgrind's callgrind; the commands are at the top of core/benches/cost.rs.",
            ),
            Self::AccuracyEvaluations { rows } => write!(
                f,
                "Evaluation: BRDF and DoLP of the nine-parameter model on the {rows} rows of the 60-digit table; times with one Cauchy surface under all \
                 its geometries, on one thread: median of 11 repetitions after a warm-up. An error of 1 means not a single digit."
            ),
            Self::AccuracyFits { starts, repetitions, repetitions_of_many } => write!(
                f,
                "Fits: eight simulated DoLP data sets of steel (Gauss and Cauchy; 144 dense angles or the paper's 27; noise 0 or 0.005) from {starts} \
                 starts each, which \"{starts} starts\" takes one after the other. Times are medians of {repetitions} repetitions after a warm-up, of \
                 {repetitions_of_many} for many starts (all threads); elapsed_ms is the median over the fits; success is the best objective known \
                 within a factor 1 + 1e-6, or 1e-20; the errors are the largest relative distance of a parameter from the truth where dense angles \
                 without noise tell it."
            ),
            Self::AccuracyModels => f.write_str(
                "Models: each of the ladder fitted with many starts to the dense Cauchy data with noise 0.005; the errors are those of its DoLP against the \
                 noise-free one where that is above 0.001.",
            ),
            Self::Spreads(spreads) => {
                let spreads: Vec<String> = spreads.iter().map(|(method, spread)| format!("{method} {:.1} %", 100.0 * spread)).collect();
                write!(f, "Spread of the repetitions, half the distance between the quartiles over the median: {}.", spreads.join("; "))
            }
        }
    }
}
