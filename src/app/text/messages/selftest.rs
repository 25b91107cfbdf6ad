//! Messages of `pbrdf::selftest`.

use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized;
use pbrdf::selftest::{BenchmarkMethod, DARK_BAR, GRADIENT_BAR, Machine, Note, StabilityCase, StabilityOutcome, VALUE_BAR};
use tr::tr;

impl Localized for Machine {
    fn localized(&self) -> String {
        let Self { processor, threads, vectors } = self;
        let threads = tr!("1 thread" | "{n} threads" % *threads);
        let vectors = if vectors.is_empty() { String::new() } else { format!(", {}", vectors.join(" ")) };
        let system = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        let build = if cfg!(debug_assertions) { tr!(", a build with debug assertions: times say little") } else { "".into() };
        format!("{processor}, {threads}{vectors}, {system}, pbrdf-explorer {}{build}", env!("CARGO_PKG_VERSION"))
    }
}

/// A number of starts.
fn starts(count: u32) -> String {
    tr!("one start" | "{n} starts" % count)
}

fn scaling(scaled: bool) -> String {
    if scaled { tr!("scaled") } else { tr!("unscaled") }
}

/// The name of a method for a legend.
pub fn short_method(method: BenchmarkMethod) -> String {
    match method {
        BenchmarkMethod::LevenbergMarquardt { analytic, scaled, starts: count } => {
            let jacobian = if analytic { tr!("analytic") } else { tr!("differences") };
            tr!("LM, {0}, {1}, {2}", jacobian, scaling(scaled), starts(count))
        }
        other => other.localized(),
    }
}

impl Localized for BenchmarkMethod {
    fn localized(&self) -> String {
        match *self {
            Self::TextbookF32 => tr!("textbook, f32"),
            Self::TextbookF64 => tr!("textbook, f64"),
            Self::FromAngles => tr!("cancellation-free, from angles"),
            Self::Prepared => tr!("cancellation-free, prepared scene"),
            Self::Batch => tr!("batch kernel, prepared scene"),
            Self::LevenbergMarquardt { analytic, scaled, starts: count } => {
                let jacobian = if analytic { tr!("analytic") } else { tr!("finite-difference") };
                tr!("Levenberg–Marquardt, {0} Jacobian, {1}, {2}", jacobian, scaling(scaled), starts(count))
            }
            Self::OneStart => tr!("this program, one start"),
            Self::ManyStarts => tr!("this program, many starts"),
            Self::Model(key) => tr!("model {}", key),
        }
    }
}

impl Localized for StabilityCase {
    fn localized(&self) -> String {
        match self {
            Self::Evaluation { name, distribution } => format!("{} ({})", translated(name), distribution.key()),
            Self::Fit(name) => tr!("fit: {}", translated(name)),
        }
    }
}

impl Localized for StabilityOutcome {
    fn localized(&self) -> String {
        match self {
            Self::Digits { values, gradient, textbook } => {
                let [values, gradient, textbook] = [values, gradient, textbook].map(|digits| format!("{digits:.1}"));
                tr!("{0} digits, gradient {1}, textbook {2}", values, gradient, textbook)
            }
            Self::Fit { stop_reason, objective, undetermined } => {
                let mut text = stop_reason.localized();
                if let Some(objective) = objective {
                    text = tr!("{0}, ΔE {1}", text, format!("{objective:.1e}"));
                }
                if *undetermined > 0 {
                    text = tr!("{0}, {1}", text, tr!("1 direction open" | "{n} directions open" % *undetermined));
                }
                text
            }
            Self::NoProblem => tr!("no problem to fit"),
        }
    }
}

impl Localized for Note {
    fn localized(&self) -> String {
        match self {
            Self::StabilityTotals { passed, cases, textbook_misses, evaluations } => tr!(
                "{0} of {1} cases pass; the formulas as they are printed miss {2} in {3} of {4} evaluations.",
                passed,
                cases,
                format!("{VALUE_BAR:.0e}"),
                textbook_misses,
                evaluations
            ),
            Self::StabilityEvaluations => tr!(
                "Evaluations: relative errors of BRDF and DoLP against 60 digits, limit {0}; error of the nine derivatives by the smaller of |e|/|∂| and |e| w/max(|∂| w), w = max(|p|, 1e-3), limit {1}; both limits times sin²β/|N² − sin²β| where that is above 1, near the critical angle, and {2} for DoLP of lobes that are all darker than e^−120. An error of 1 means not a single digit. textbook_error: the same by the formulas as they are printed, in f64. condition: the largest |∂ln f/∂ln p| of BRDF and DoLP.",
                format!("{VALUE_BAR:.0e}"),
                format!("{GRADIENT_BAR:.0e}"),
                format!("{DARK_BAR:.0e}")
            ),
            Self::StabilityFits => tr!(
                "Fits: condition is the largest over the smallest singular value of the Jacobian scaled by max(|p|, 1e-3); a fit passes if it does what its name asks for: reach the exact minimum, name what the data leave open, mark a bound, keep the truth within four standard errors, or end with a typed reason."
            ),
            Self::CostReference => tr!(
                "Geometries are prepared once and not part of the time, but for the Mueller matrix, which starts from the angles. Differences are to the full scalar evaluation, over a dozen surfaces: in units of the last place where terms or derivatives are only left out, relative for the batch kernel, whose exponential and logarithm are its own (gradients: an error relative to the largest component counts too)."
            ),
            Self::CostInstructions => {
                tr!("Instructions per point are counted by valgrind's callgrind; the commands are at the top of core/benches/cost.rs.")
            }
            Self::AccuracyEvaluations { rows } => tr!(
                "Evaluation: BRDF and DoLP of the nine-parameter model on the {} rows of the 60-digit table; times with one Cauchy surface under all its geometries, on one thread: median of 11 repetitions after a warm-up. An error of 1 means not a single digit.",
                rows
            ),
            Self::AccuracyFits { starts, repetitions, repetitions_of_many } => tr!(
                "Fits: eight simulated DoLP data sets of steel (Gauss and Cauchy; 144 dense angles or the paper's 27; noise 0 or 0.005) from {0} starts each, which \"{0} starts\" takes one after the other. Times are medians of {1} repetitions after a warm-up, of {2} for many starts (all threads); elapsed_ms is the median over the fits; success is the best objective known within a factor 1 + 1e-6, or 1e-20; the errors are the largest relative distance of a parameter from the truth where dense angles without noise tell it.",
                starts,
                repetitions,
                repetitions_of_many
            ),
            Self::AccuracyModels => tr!(
                "Models: each of the ladder fitted with many starts to the dense Cauchy data with noise 0.005; the errors are those of its DoLP against the noise-free one where that is above 0.001."
            ),
            Self::Spreads(spreads) => {
                let spread = |(method, spread): &(BenchmarkMethod, f64)| format!("{} {:.1} %", method.localized(), 100.0 * spread);
                let spreads: Vec<String> = spreads.iter().map(spread).collect();
                tr!("Spread of the repetitions, half the distance between the quartiles over the median: {}.", spreads.join(&tr!("; ")))
            }
        }
    }
}
