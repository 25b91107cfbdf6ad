//! What the draws say of each parameter, in numbers.

use crate::app::plots::theme;
use crate::app::text::explained::Explained as _;
use crate::app::text::i18n::translated;
use crate::app::work::posterior::DrawnPosterior;
use crate::figure::with_unit;
use crate::report::FittedMark;
use egui::{Grid, RichText, ScrollArea, Ui};
use pbrdf::fit::UnknownName as _;
use pbrdf::fit::posterior::{DerivedQuantity, MarginalSummary};
use pbrdf::rounding::significant;
use tr::tr;

/// R̂ above which chains have not mixed.
const LARGEST_RHAT: f64 = 1.01;

/// One line a parameter.
pub fn summary_ui(drawn: &DrawnPosterior, fitted: &[Option<FittedMark>], place: usize, ui: &mut Ui) {
    ui.add_space(4.0);
    ScrollArea::horizontal().id_salt("summaries").show(ui, |ui| {
        Grid::new("posterior").striped(true).spacing([12.0, 4.0]).show(ui, |ui| {
            headings_ui(ui);
            for ((name, summary), fit) in drawn.draws.parameters.iter().zip(&drawn.summaries).zip(fitted) {
                ui.label(name.symbol()).on_hover_text(translated(name.parameter().name()));
                summary_cells_ui(summary, ui);
                ui.monospace(fit.map_or_else(|| "-".to_owned(), |fit| significant(fit.value, 4)));
                ui.end_row();
            }
            for (quantity, of_sets) in &drawn.derived {
                let Some(summary) = of_sets.get(place) else { continue };
                ui.label(with_unit(&translated(quantity.symbol()), quantity.unit())).explained(translated(derived_help(*quantity)));
                summary_cells_ui(summary, ui);
                ui.scope(|_| ());
                ui.end_row();
            }
        });
    });
    for (name, noise) in ["DoLP", "BRDF"].into_iter().zip(drawn.draws.noise) {
        if let Some(noise) = noise {
            let [low, middle, high] = [noise.q16, noise.q50, noise.q84].map(|value| format!("{value:.2e}"));
            ui.label(tr!("Noise of {0}: {1} (68 %: {2} … {3})", name, middle, low, high));
        }
    }
    if let Some(evidence) = drawn.draws.log_evidence {
        let [value, error] = [evidence.value, evidence.std_error].map(|value| format!("{value:.2}"));
        ui.label(tr!("Logarithm of the evidence: {0} ± {1}", value, error)).on_hover_text(tr!(
            "The likelihood averaged over the priors; differences between models on the same data are logarithms of odds"
        ));
    }
}

fn derived_help(quantity: DerivedQuantity) -> &'static str {
    match quantity {
        DerivedQuantity::IndexRatio => "What DoLP at moderate angles determines of n and k",
        DerivedQuantity::LobeHalfWidth => "The tilt at which the facet density has fallen to half; 90° where it does not fall so far",
        DerivedQuantity::NormalReflectance => "Of a smooth surface at normal incidence",
    }
}

fn headings_ui(ui: &mut Ui) {
    for (heading, help) in [
        ("", ""),
        ("median", "As many draws lie above as below"),
        ("68 %", "The central 68 % of the draws"),
        ("90 %", "The central 90 % of the draws"),
        ("R-hat", "How far the chains disagree: 1 is not at all, above 1.01 is too much"),
        ("size", "How many independent draws they are worth, in the bulk or the tails, whichever is less"),
        ("fit", "The value of the fit that is shown"),
    ] {
        if heading.is_empty() {
            ui.scope(|_| ());
        } else {
            ui.strong(translated(heading)).explained(translated(help));
        }
    }
    ui.end_row();
}

/// Median, intervals and how far they are to be trusted.
pub fn summary_cells_ui(summary: &MarginalSummary, ui: &mut Ui) {
    let [q05, q16, q50, q84, q95] = summary.quantiles.map(|value| significant(value, 4));
    ui.monospace(q50);
    ui.monospace(format!("{q16} … {q84}"));
    ui.monospace(format!("{q05} … {q95}"));
    match summary.convergence {
        Some(of) => {
            let text = RichText::new(format!("{:.3}", of.rhat)).monospace();
            let is_bad = of.rhat.is_nan() || of.rhat > LARGEST_RHAT;
            ui.label(if is_bad { text.color(theme::warning(ui.visuals().dark_mode)) } else { text });
            ui.monospace(format!("{:.0}", of.ess_bulk.min(of.ess_tail)));
        }
        None => {
            ui.monospace("-");
            ui.monospace("-");
        }
    }
}
