//! A fit in text: how it ended, its estimates, what stays open.

use crate::cli::arguments::FitArguments;
use crate::cli::output;
use pbrdf::fit::{
    BrdfResiduals, Course, Edge, Estimate, EstimateStatus, Loss, Statistics, StopReason, Undetermined, UnknownName, Weights, ends_text,
};
use std::io::{self, Write};

/// The notice of measured values that the residuals cannot use.
pub fn notice_left_out(count: usize) {
    if count > 0 {
        output::notice(format_args!(
            "Measured BRDF values of 0, which have no relative or logarithmic residual and are left out: {count}."
        ));
    }
}

/// An objective in text.
pub fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "not defined".to_owned(), |value| format!("{value:.6e}"))
}

/// Why and where a fit ended.
pub fn print_course<T>(
    out: &mut dyn Write,
    arguments: &FitArguments,
    (before, after): (Option<f64>, Option<f64>),
    stop_reason: StopReason,
    course: &Course<T>,
    statistics: &Statistics,
) -> io::Result<()> {
    writeln!(out, "{} ({} evaluations, {:.1} ms)", capitalised(stop_reason.text()), course.evaluations, course.elapsed_ms)?;
    writeln!(out, "ΔE {} -> {}", number(before), number(after))?;
    if !statistics.minimises_delta_e {
        let (before, after) = (number(statistics.start_rss), number(Some(statistics.rss)));
        writeln!(out, "minimised, instead of ΔE: sum of squares of the {} {before} -> {after}", residuals_in_words(arguments))?;
    }
    if let Some(chi2) = statistics.chi2 {
        writeln!(out, "χ² {chi2:.4} with {} degrees of freedom", statistics.dof)?;
    }
    Ok(())
}

/// Width of the names of parameters.
pub const NAME_WIDTH: usize = 8;

/// The head of the table of estimates.
pub fn print_head(out: &mut dyn Write, width: usize) -> io::Result<()> {
    writeln!(out, "\n{:<width$} {:>14} {:>12} {:>12}", "", "value", "± (68 %)", "start")
}

/// A line of the table of estimates.
pub fn print_estimate(out: &mut dyn Write, name: &str, width: usize, estimate: &Estimate) -> io::Result<()> {
    let error = match estimate.status() {
        EstimateStatus::Fixed => "fixed".to_owned(),
        EstimateStatus::AtBound(Edge::Lower) => "at lower".to_owned(),
        EstimateStatus::AtBound(Edge::Upper) => "at upper".to_owned(),
        EstimateStatus::Determined(error) => format!("{error:.3e}"),
        EstimateStatus::UncertaintyUnknown => "unknown".to_owned(),
        EstimateStatus::Within(interval) => ends_text(estimate.value, interval),
        EstimateStatus::Undetermined => "not determined".to_owned(),
    };
    let unit = estimate.parameter.unit();
    writeln!(out, "{name:<width$} {:>14.8} {error:>12} {:>12.6} {unit}", estimate.value, estimate.start)
}

/// What the data leave open.
pub fn print_open<N: UnknownName>(
    out: &mut dyn Write,
    statistics: &Statistics,
    is_any_determined: bool,
    open: &[Undetermined<N>],
) -> io::Result<()> {
    if statistics.dof == 0 && is_any_determined {
        writeln!(out, "\nNo degree of freedom is left: there are no more data than parameters, and nothing to tell standard errors from.")?;
    }
    if !open.is_empty() {
        writeln!(out, "\nThe data leave open:")?;
        open.iter().try_for_each(|what| writeln!(out, "  {what}"))?;
    }
    Ok(())
}

fn residuals_in_words(arguments: &FitArguments) -> String {
    let weights = if matches!(arguments.problem.weights, Weights::Sigma) { "weighted " } else { "" };
    let form = match arguments.problem.brdf_residuals {
        BrdfResiduals::Absolute => "residuals",
        BrdfResiduals::Relative => "residuals, relative for BRDF",
        BrdfResiduals::Log => "residuals, logarithmic for BRDF",
    };
    let loss = if matches!(arguments.problem.loss, Loss::Squared) { "" } else { ", under a robust loss" };
    format!("{weights}{form}{loss}")
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default() + letters.as_str()
}
