//! Gauss against Cauchy, as `compare` says it.

use pbrdf::fit::{DistributionComparison, GaussAtFixedSigma, Verdict};
use pbrdf::optics::SlopeDistribution;

/// Presets that differ by their distribution alone: Gauss, Cauchy.
pub const PAIRS: [(&str, &str); 2] = [("gauss", "cauchy"), ("specular-gauss", "specular")];

/// In the place of verdicts.
pub const INTERRUPTED: &str = "Interrupted: the comparison is not complete.";

/// Why a model has no fit.
pub const NOT_REACHED: &str = "not reached before the interruption";

/// The verdict on a pair; where Cauchy wins, also whether it does by its width alone.
pub fn verdict_text(
    (gauss, cauchy): (&str, &str),
    comparison: &DistributionComparison,
    held: impl FnOnce() -> Option<GaussAtFixedSigma>,
) -> String {
    let wins = comparison.verdict() == Verdict::Closer(SlopeDistribution::Cauchy);
    let held = if wins { held() } else { None };
    let held = held.map_or_else(String::new, |held| format!("\n{}", held.text(comparison)));
    format!("{gauss} and {cauchy}: {comparison}{held}")
}
