//! The ladder of models on the open measurement: how well each fits, what it says, where its starts
//! led, Gauss against Cauchy.

use crate::app::jobs::job::Job;
use crate::app::plots::theme;
use crate::app::text::estimate::{uncertainty_help, uncertainty_text};
use crate::app::text::explained::Explained as _;
use crate::app::text::glossary;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::views::action::{Action, InquiryAction, ListAction};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::{explain, is_joint};
use crate::app::work::model_fit::{ModelFit, NotFitted};
use crate::app::work::workspace::Workspace;
use crate::report::bracketed;
use egui::{Button, CollapsingHeader, Grid, Response, RichText, Role, ScrollArea, TextWrapMode, Ui, Widget, WidgetInfo};
use pbrdf::fit::posterior::{LogEvidence, Odds};
use pbrdf::fit::{DistributionComparison, Estimate, EstimateStatus, FitResult};
use pbrdf::model::{Parameter, Preset};
use tr::tr;

/// Models that differ in the distribution alone: Cauchy, Gauss, and what they have in common.
const PAIRS: [(&str, &str, &str); 2] = [("cauchy", "gauss", "all terms"), ("specular", "specular-gauss", "specular lobe alone")];

pub static SPEC: PaneSpec = PaneSpec {
    title: "Models",
    tooltip: "The ladder of models side by side on the open measurement",
    shortcut: None,
    has_options: false,
    has_figure: false,
    new: || Box::new(ModelsView),
};

/// The pane; it keeps nothing.
struct ModelsView;

impl View for ModelsView {
    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let running = cx.jobs.fits.compare.job().map(Job::progress);
        ui.horizontal(|ui| {
            let compare = ui.add_enabled(running.is_none(), egui::Button::new(tr!("Fit all models")));
            let help = if is_joint(cx.work.measurements()) {
                tr!("Fit the whole ladder of models to all measurements together, with the options and bounds of a fit")
            } else {
                tr!("Fit the whole ladder of models to this measurement, with the options and bounds of a fit")
            };
            if compare.on_hover_text(help).clicked() {
                cx.actions.push(Action::CompareModels);
            }
            if let Some(at) = running {
                if ui.button(tr!("Stop comparing")).clicked() {
                    cx.actions.push(Action::CancelComparison);
                }
                ui.spinner();
                running_model_ui(at, ui);
            } else {
                evidence_ui(cx, ui);
            }
        });
        let comparison = cx.work.model_comparison();
        if comparison.is_empty() {
            if running.is_none() {
                ui.label(tr!("Nothing is compared yet."));
            }
            return;
        }
        ScrollArea::both().auto_shrink([false; 2]).show(ui, |ui| {
            models_ui(cx.work, cx.edits, cx.actions, ui);
            ui.add_space(6.0);
            for sentence in verdicts(comparison).into_iter().chain(odds_sentence(comparison)) {
                // As wide as the pane, not as the table.
                ui.scope(|ui| {
                    ui.set_max_width(ui.clip_rect().width() - ui.spacing().item_spacing.x);
                    ui.add(egui::Label::new(sentence).wrap());
                });
            }
            CollapsingHeader::new(tr!("Starts and where they led")).show(ui, |ui| starts_ui(comparison, ui));
        });
    }
}

/// The button that finds the evidence of the compared models.
fn evidence_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let running = cx.jobs.posteriors.evidence.job().map(Job::progress);
    if cx.work.model_comparison().is_empty() {
        return;
    }
    match running {
        Some(at) => {
            if ui.button(tr!("Stop drawing")).clicked() {
                cx.actions.push(Action::Inquire(InquiryAction::CancelEvidence));
            }
            ui.spinner();
            running_model_ui(at, ui);
        }
        None => {
            let help = tr!(
                "Draw from the posterior of each model: its likelihood averaged over the priors, which depends on them; bounds twice as \
                 wide cost ln 2 a parameter"
            );
            if ui.button(tr!("Find evidence")).on_hover_text(help).clicked() {
                cx.actions.push(Action::Inquire(InquiryAction::FindEvidence));
            }
        }
    }
}

/// The largest evidence of a comparison.
fn most_evident(comparison: &[ModelFit]) -> Option<(&ModelFit, LogEvidence)> {
    let all = comparison.iter().filter_map(|row| Some((row, row.evidence?)));
    all.max_by(|a, b| a.1.value.total_cmp(&b.1.value))
}

/// The model with the largest evidence against the next one, in words.
fn odds_sentence(comparison: &[ModelFit]) -> Option<String> {
    let (best, evidence) = most_evident(comparison)?;
    let others = comparison.iter().filter(|row| row.preset.key != best.preset.key).filter_map(|row| Some((row, row.evidence?)));
    let (next, other) = others.max_by(|a, b| a.1.value.total_cmp(&b.1.value))?;
    let odds = Odds::new(evidence, other);
    let [best, next] = [best, next].map(|row| translated(row.preset.name));
    Some(tr!("By the evidence, odds of {0} for {1} against {2}: {3}.", odds.text(), best, next, odds.grade().localized()))
}

/// Which model is being fitted.
pub fn running_model_ui(key: Option<&str>, ui: &mut Ui) {
    let preset = key.and_then(Preset::from_key);
    ui.add(egui::Label::new(tr!("Fitting: {}", preset.map_or_else(|| "…".to_owned(), |preset| translated(preset.name)))).truncate());
}

/// Between columns.
const SPACING: [f32; 2] = [9.0, 4.0];

/// The names have what the pane has beside the numbers up to n and k, between these widths in points.
const NAMES: std::ops::RangeInclusive<f32> = 150.0..=400.0;
/// Width of the columns from the pins to k, in points.
const NUMBERS: f32 = 430.0;

fn narrow_ui(ui: &mut Ui, width: f32, name: impl Widget) -> Response {
    ui.scope(|ui| {
        ui.set_max_width(width);
        ui.add(name)
    })
    .inner
}

/// One line a model: how well it fits, its parameters as `2.049(23)`, and what the fit cost.
fn models_ui(work: &Workspace, edits: &mut Vec<Edit>, actions: &mut Vec<Action>, ui: &mut Ui) {
    let (comparison, document) = (work.model_comparison(), work.active());
    let best = comparison.iter().filter_map(|row| row.report()?.statistics.aicc).fold(f64::INFINITY, f64::min);
    let most_evident = most_evident(comparison).map(|(_, evidence)| evidence);
    let current = work.preset().map(|preset| preset.key);
    let width = (ui.clip_rect().width() - NUMBERS).clamp(*NAMES.start(), *NAMES.end());
    let fitted = comparison.iter().find_map(|row| row.result.as_ref().ok());
    if let Some(joint) = fitted.and_then(|fit| fit.joint.as_ref()) {
        let (count, name) = (joint.of.result.sets.len(), document.title());
        ui.label(tr!("{0} measurements fitted together: ΔE and AICc are of all; the parameters are those of {1}.", count, name));
    }
    ui.weak(tr!("A click on a model takes its terms and values to the sliders, and shows its fit."));
    Grid::new("models").striped(true).spacing(SPACING).show(ui, |ui| {
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        headings_ui(ui);
        for (index, row) in comparison.iter().enumerate() {
            let is_current = current == Some(row.preset.key) && row.report().is_some_and(|report| report.model == work.surface().model);
            let is_best = row.report().is_some_and(|report| report.statistics.aicc == Some(best));
            let name = translated(row.preset.name);
            let text = RichText::new(if is_best { format!("★ {name}") } else { name.clone() });
            let text = if is_best { text.strong() } else { text };
            let citation = translated(row.preset.citation);
            let help = if is_best { tr!("{}\n★ The best by AICc", citation) } else { citation };
            let button = Button::selectable(is_current, text).wrap();
            if narrow_ui(ui, width, button).on_hover_text(format!("{name}\n{help}")).clicked() {
                edits.push(Edit::UseModelFit(index));
            }
            match &row.result {
                Ok(fit) => {
                    pin_ui(&name, index, actions, ui);
                    numbers_ui(&fit.report, row.objective(), best, evidence_text(row, most_evident), ui);
                }
                Err(error) => {
                    ui.label("");
                    let reason = match error {
                        NotFitted::One(error) => explain(error, &document.measurement),
                        NotFitted::Together(error) => error.localized(),
                    };
                    ui.colored_label(theme::warning(ui.visuals().dark_mode), tr!("skipped: {}", reason));
                }
            }
            ui.end_row();
        }
    });
}

fn headings_ui(ui: &mut Ui) {
    ui.strong(tr!("model"));
    ui.label("");
    ui.strong("ΔE").explained(glossary::delta_e_help());
    ui.strong(tr!("Δ ln evidence"))
        .explained(tr!("Below that of the model with the largest one; the exponential of the difference is the odds"));
    ui.strong("ΔAICc")
        .explained(tr!("Akaike's corrected criterion above that of the best model: below 2 is hardly worse, above 10 is ruled out"));
    for parameter in Parameter::ALL {
        ui.strong(parameter.symbol()).on_hover_text(translated(parameter.name()));
    }
    for (heading, help) in [
        ("χ²/dof", "Where standard deviations are used as weights"),
        ("starts", "How many reached the best minimum, of how many"),
        ("evaluations", "Of the residuals, all starts together"),
        ("time / ms", "All starts together"),
    ] {
        ui.strong(translated(heading)).explained(translated(help));
    }
    ui.end_row();
}

/// A button that pins the surface of a row.
fn pin_ui(name: &str, index: usize, actions: &mut Vec<Action>, ui: &mut Ui) {
    let pin = ui.small_button(tr!("Pin")).on_hover_text(tr!("Its surface in every plot until it is removed"));
    pin.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Pin {}", name)));
    if pin.clicked() {
        actions.push(Action::List(ListAction::PinModelFit(index)));
    }
}

/// How far the evidence of a row lies below the largest, with its error.
fn evidence_text(row: &ModelFit, most: Option<LogEvidence>) -> String {
    match row.evidence.zip(most) {
        Some((evidence, most)) => format!("{:.1} ± {:.1}", evidence.value - most.value, evidence.std_error),
        None => "-".to_owned(),
    }
}

fn numbers_ui(report: &FitResult, objective: Option<f64>, best_aicc: f64, evidence: String, ui: &mut Ui) {
    let number = |value: Option<f64>, text: fn(f64) -> String| value.map_or_else(|| "-".to_owned(), text);
    #[expect(clippy::cast_precision_loss, reason = "degrees of freedom")]
    let reduced = report.statistics.chi2.filter(|_| report.statistics.dof > 0).map(|chi2| chi2 / report.statistics.dof as f64);
    ui.label(number(objective, |value| format!("{value:.3e}"))).on_hover_text(report.stop_reason.localized());
    ui.label(evidence);
    ui.label(number(report.statistics.aicc.map(|aicc| aicc - best_aicc), |value| format!("{value:.1}")));
    for parameter in Parameter::ALL {
        match report.estimate(parameter) {
            Some(estimate) => estimate_ui(estimate, ui),
            None => _ = ui.label(""),
        }
    }
    ui.label(number(reduced, |value| format!("{value:.3}")));
    ui.label(tr!("{} of {}", report.course.hits_of_best(), report.course.starts()));
    ui.label(report.course.evaluations.to_string());
    ui.label(format!("{:.1}", report.course.elapsed_ms));
}

/// A value with its uncertainty in brackets; faint where the data do not determine it.
fn estimate_ui(estimate: &Estimate, ui: &mut Ui) {
    let text = RichText::new(bracketed(estimate));
    let is_known = matches!(estimate.status(), EstimateStatus::Determined(_) | EstimateStatus::Within(_));
    let text = if is_known { text } else { text.weak() };
    ui.label(text).on_hover_text(format!("{}\n{}", uncertainty_text(estimate), uncertainty_help(estimate)));
}

fn starts_ui(comparison: &[ModelFit], ui: &mut Ui) {
    Grid::new("starts").num_columns(4).striped(true).spacing([12.0, 4.0]).show(ui, |ui| {
        ui.strong(tr!("model"));
        glossary::minima_headings_ui(ui);
        ui.end_row();
        for rung in comparison {
            let minima = rung.report().map_or(&[][..], |report| &report.course.minima);
            for (i, minimum) in minima.iter().take(MOST_MINIMA).enumerate() {
                ui.label(if i == 0 { translated(rung.preset.name) } else { String::new() });
                ui.monospace(format!("{:.6e}", minimum.objective));
                ui.label(format!("{} ×", minimum.hits));
                ui.label(minimum.stop_reason.localized());
                ui.end_row();
            }
        }
    });
}

/// Minima of one model that are listed at most.
const MOST_MINIMA: usize = 6;

/// Gauss against Cauchy, in words.
fn verdicts(comparison: &[ModelFit]) -> Vec<String> {
    let fit = |key: &str| comparison.iter().find(|row| row.preset.key == key)?.result.as_ref().ok();
    let verdict = |(cauchy, gauss, terms): &(&str, &str, &str)| {
        let (gauss, cauchy) = (fit(gauss)?, fit(cauchy)?);
        let contest = match (&gauss.joint, &cauchy.joint) {
            (Some(gauss), Some(cauchy)) => DistributionComparison::jointly(&gauss.of.result, &cauchy.of.result)?,
            _ => DistributionComparison::new(&gauss.report, &cauchy.report)?,
        };
        Some(tr!("Cauchy against Gauss ({0}): {1}", translated(terms), contest.localized()))
    };
    PAIRS.iter().filter_map(verdict).collect()
}
