//! What a fit came to: values, standard errors, minima, correlations, and what stays open.

use crate::app::panels::delta_e_text;
use crate::app::plots::theme;
use crate::app::tasks::fits::FitJobs;
use crate::app::text::estimate::{bound_text, uncertainty_help, uncertainty_text};
use crate::app::text::explained::Explained as _;
use crate::app::text::glossary;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized;
use crate::app::text::numbers::{short, significant};
use crate::app::views::action::{Action, ListAction};
use crate::app::work::fit_history::{FitEntry, JointPart};
use crate::app::work::workspace::Workspace;
use crate::figure::with_unit;
use egui::{Button, Grid, RichText, Role, TextWrapMode, Ui, WidgetInfo};
use pbrdf::fit::{Bootstrap, BrdfResiduals, Estimate, FitResult, Loss, Statistics, StopReason, Weights};
use pbrdf::rounding;
use tr::tr;

/// Width of what the summary says, in points: longer sentences break.
const SUMMARY: f32 = 200.0;

/// Minima that are listed at most.
const MOST_MINIMA: usize = 8;

pub fn result_ui(fit: &FitEntry, work: &Workspace, jobs: &FitJobs, commands: &mut Vec<Action>, ui: &mut Ui) {
    let (report, surface) = (&fit.report, work.surface());
    ui.horizontal_wrapped(|ui| {
        let are_sliders = surface.parameters == report.parameters && surface.model == report.model;
        let take = ui.add_enabled(!are_sliders, Button::new(tr!("Use as sliders"))).on_hover_text(tr!("The fitted values to the sliders"));
        if take.on_disabled_hover_text(tr!("The sliders are those of the fit.")).clicked() {
            commands.push(Action::UseFit);
        }
        if ui.button(tr!("Back to before the fit")).on_hover_text(tr!("The sliders as they were before the fit")).clicked() {
            commands.push(Action::UseValuesBeforeFit);
        }
        let pin = ui.button(tr!("Pin")).on_hover_text(tr!("Its surface in every plot until it is removed"));
        pin.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Pin this fit")));
        if pin.clicked() {
            commands.push(Action::List(ListAction::PinFit));
        }
    });
    ui.add_space(4.0);
    let text = report.stop_reason.localized();
    let capital: String = text.chars().take(1).flat_map(char::to_uppercase).chain(text.chars().skip(1)).collect();
    if matches!(report.stop_reason, StopReason::Converged | StopReason::ResidualsZero) {
        ui.strong(capital);
    } else {
        ui.colored_label(theme::warning(ui.visuals().dark_mode), capital);
    }
    let (values, unknowns) = fit.counts();
    if let Some(text) = glossary::too_few(values, unknowns) {
        ui.add(egui::Label::new(RichText::new(text).color(theme::warning(ui.visuals().dark_mode))).wrap());
    }
    summary_ui(fit, ui);
    ui.add_space(6.0);
    estimates_ui(fit, work.diagnostics().scatter.as_ref(), ui);
    if unknowns > 0 && values > 0 {
        intervals_ui(report, jobs, commands, ui);
    }
    ui.add_space(6.0);
    minima_ui(report, ui);
    correlations_ui(report, ui);
    open_ui(fit, ui);
}

/// How far the fit came, and what it took; of a joint fit of all measurements, with ΔE of the one that is shown.
fn summary_ui(fit: &FitEntry, ui: &mut Ui) {
    let report = &fit.report;
    let joint = fit.joint.as_ref().map(|part| &part.of.result);
    let statistics = joint.map_or(&report.statistics, |result| &result.statistics);
    let (before, after) = joint.map_or((report.start_objective, report.objective), |result| (result.start_objective, result.objective));
    let together = joint.map_or_else(String::new, |result| tr!("{} measurements", result.sets.len()));
    let this_one = joint.map_or_else(String::new, |_| delta_e_text(report.objective));
    Grid::new("fit summary").num_columns(2).show(ui, |ui| {
        let minimised = tr!("What the fit made small, in place of ΔE");
        let chi2 = tr!("Squared residuals over their stated σ, per degree of freedom: near 1 where model and σ are right");
        let names = joint.map_or_else(String::new, |result| result.sets.iter().map(|set| &*set.name).collect::<Vec<_>>().join(", "));
        for (name, value, help) in [
            (tr!("Together"), together, names),
            (tr!("Before"), delta_e_text(before), glossary::delta_e_help()),
            (tr!("After"), delta_e_text(after), glossary::delta_e_help()),
            (tr!("This one"), this_one, tr!("ΔE of the active measurement alone")),
            (tr!("Minimised"), minimised_text(fit, statistics), minimised),
            (tr!("χ²/dof"), reduced_chi2_text(statistics), chi2),
            (tr!("AICc"), statistics.aicc.map_or_else(String::new, |aicc| format!("{aicc:.2}")), glossary::aicc_help()),
            (tr!("Time"), effort_text(report), tr!("Of all starts together; an evaluation is the model at all rows once")),
        ] {
            if !value.is_empty() {
                ui.label(name).explained(help.as_str());
                let value = |ui: &mut Ui| {
                    ui.set_max_width(SUMMARY);
                    ui.add(egui::Label::new(value).wrap())
                };
                ui.scope(value).inner.on_hover_text(help);
                ui.end_row();
            }
        }
    });
}

/// What stays open, in words, the badly known included.
fn open_ui(fit: &FitEntry, ui: &mut Ui) {
    let in_words = |part: &JointPart| -> Vec<String> { part.of.result.describe_undetermined().iter().map(Localized::localized).collect() };
    let of_one = || fit.report.describe_undetermined().iter().map(Localized::localized).collect();
    let open = fit.joint.as_ref().map_or_else(of_one, in_words);
    if open.is_empty() {
        return;
    }
    ui.add_space(6.0);
    ui.strong(tr!("The data leave open:")).explained(glossary::open_help());
    for what in &open {
        ui.add(egui::Label::new(format!("• {what}")).wrap());
    }
}

/// Values and their errors, one parameter a row; of a joint fit the measurement's own ones first.
fn estimates_ui(fit: &FitEntry, bootstrap: Option<&Bootstrap>, ui: &mut Ui) {
    let report = &fit.report;
    let own = fit.joint.as_ref().map(|part| part.of.problem.own());
    let is_own = |estimate: &&Estimate| own.is_none_or(|own| own.contains(estimate.parameter));
    let is_final = report.course.intervals_complete.is_some();
    // The intervals come first: in a narrow panel the start is told where the pointer rests on the value.
    let with_start = ui.available_width() > WITH_START;
    let row = |estimate: &Estimate, ui: &mut Ui| estimate_ui(estimate, bootstrap, is_final, with_start, ui);
    Grid::new("fit result").num_columns(5).spacing([12.0, 4.0]).striped(true).min_col_width(44.0).show(ui, |ui| {
        ui.label("");
        for (heading, help) in [
            ("start", "The slider before the fit"),
            ("value", "Where the fit ended"),
            (
                "± (68.3 %)",
                "The interval at 68.3 % by profile likelihood, or why there is none; grey: the linear error, until that interval is there",
            ),
        ]
        .into_iter()
        .filter(|(heading, _)| with_start || *heading != "start")
        {
            ui.strong(translated(heading)).explained(translated(help));
        }
        if let Some(bootstrap) = bootstrap {
            ui.strong(tr!("± boot")).explained(bootstrap_help(bootstrap));
        }
        ui.end_row();
        report.estimates.iter().filter(is_own).for_each(|estimate| row(estimate, ui));
        let mut shared = report.estimates.iter().filter(|estimate| !is_own(estimate)).peekable();
        if shared.peek().is_some() {
            ui.weak(tr!("shared")).explained(tr!("One value for all measurements of the fit"));
            ui.end_row();
        }
        shared.for_each(|estimate| row(estimate, ui));
    });
}

/// Width of the panel in points from which a column of starts does not cut the intervals off.
const WITH_START: f32 = 300.0;

fn estimate_ui(estimate: &Estimate, bootstrap: Option<&Bootstrap>, is_final: bool, with_start: bool, ui: &mut Ui) {
    ui.label(with_unit(estimate.parameter.symbol(), estimate.parameter.unit())).on_hover_text(translated(estimate.parameter.name()));
    if with_start {
        ui.monospace(significant(estimate.start));
    }
    let exact = tr!("{0}; start {1}", significant(estimate.value), significant(estimate.start));
    ui.monospace(estimate.value_text()).on_hover_text(exact);
    uncertainty_ui(estimate, is_final, ui);
    let scatter = bootstrap.and_then(|bootstrap| bootstrap.estimates.iter().find(|scatter| scatter.parameter == estimate.parameter));
    if let Some(scatter) = scatter {
        let (low, high) = (significant(scatter.low), significant(scatter.high));
        ui.label(short(scatter.std_error)).on_hover_text(tr!("16th to 84th percentile: {0} … {1}", low, high));
    }
    ui.end_row();
}

/// Over how many data sets a bootstrap ran.
fn bootstrap_help(bootstrap: &Bootstrap) -> String {
    if bootstrap.is_complete() {
        tr!("Standard deviation over {} data sets of a bootstrap", bootstrap.replicates)
    } else {
        tr!(
            "Standard deviation over {0} data sets of a bootstrap that was stopped; {1} were asked for",
            bootstrap.replicates,
            bootstrap.asked
        )
    }
}

/// What fell, where that was not ΔE, named for what it is.
fn minimised_text(fit: &FitEntry, statistics: &Statistics) -> String {
    let fit_options = fit.problem.options();
    let Some(start) = statistics.start_rss.filter(|_| !statistics.minimises_delta_e) else { return String::new() };
    let knows_only_ratios = |part: &JointPart| part.of.problem.knows_only_ratios();
    let has_brdf = !fit.joint.as_ref().map_or_else(|| fit.problem.knows_only_ratios(), knows_only_ratios) && !fit_options.dolp_only;
    let form = match fit_options.brdf_residuals {
        BrdfResiduals::Relative if has_brdf => tr!("relative residuals"),
        BrdfResiduals::Log if has_brdf => tr!("logarithmic residuals"),
        _ => tr!("residuals"),
    };
    let weights = if fit_options.weights == Weights::Sigma { tr!(" over σ") } else { String::new() };
    let loss = match fit_options.loss {
        Loss::Squared => String::new(),
        Loss::Huber => tr!(", Huber loss"),
        Loss::SoftL1 => tr!(", soft-L1 loss"),
    };
    tr!("{0}, Σ² {1} to {2}", format!("{form}{weights}{loss}"), format!("{start:.3e}"), format!("{:.3e}", statistics.rss))
}

/// What it took; a session of an older version does not tell.
fn effort_text(report: &FitResult) -> String {
    if report.course.minima.is_empty() {
        return tr!("not known: from a session of an older version");
    }
    let elapsed = format!("{:.2}", report.course.elapsed_ms);
    tr!("{0} ms, one evaluation" | "{0} ms, {n} evaluations" % report.course.evaluations, elapsed)
}

/// χ² per degree of freedom where standard deviations were stated and used.
fn reduced_chi2_text(statistics: &Statistics) -> String {
    #[expect(clippy::cast_precision_loss, reason = "degrees of freedom")]
    let dof = statistics.dof as f64;
    match statistics.chi2 {
        Some(chi2) if statistics.dof > 0 => {
            tr!("{0} ({1} of {2})", format!("{:.3}", chi2 / dof), format!("{chi2:.2}"), statistics.dof)
        }
        Some(chi2) => tr!("χ² = {}, no degree of freedom", format!("{chi2:.2}")),
        None => String::new(),
    }
}

/// Where the starts led: distinct minima, best first.
fn minima_ui(report: &FitResult, ui: &mut Ui) {
    if report.course.minima.is_empty() {
        return;
    }
    let (starts, hits) = (report.course.starts(), report.course.hits_of_best());
    let title = tr!("one start" | "{n} starts, {0} in the best basin" % starts, hits);
    egui::CollapsingHeader::new(title).id_salt("starts").show(ui, |ui| {
        if let Some(share) = report.course.unseen_share() {
            let text = tr!(
                "Minima seen: {0}; about {1} % of further starts would end in one not seen.",
                report.course.minima.len(),
                rounding::significant(100.0 * share, 2)
            );
            let help =
                tr!("As Boender and Kan expect it (Math. Program. 37, 59 (1987)): w (w + 1)/(n (n − 1)) for w minima after n starts");
            ui.add(egui::Label::new(text).wrap()).on_hover_text(help);
        }
        Grid::new("minima").num_columns(3).striped(true).show(ui, |ui| {
            glossary::minima_headings_ui(ui);
            ui.end_row();
            for minimum in report.course.minima.iter().take(MOST_MINIMA) {
                ui.monospace(format!("{:.5e}", minimum.objective));
                ui.label(format!("{} ×", minimum.hits));
                ui.add(egui::Label::new(minimum.stop_reason.localized()).truncate());
                ui.end_row();
            }
        });
    });
}

/// Correlations of the determined parameters as a coloured table: blue where two rise together,
/// orange where one makes up for the other.
fn correlations_ui(report: &FitResult, ui: &mut Ui) {
    if report.correlations.parameters.len() < 2 {
        return;
    }
    ui.collapsing(tr!("Correlations"), |ui| {
        let dark = ui.visuals().dark_mode;
        Grid::new("correlations").spacing([2.0, 2.0]).show(ui, |ui| {
            ui.label("");
            for parameter in &report.correlations.parameters {
                ui.label(parameter.symbol());
            }
            ui.end_row();
            for (i, parameter) in report.correlations.parameters.iter().enumerate() {
                ui.label(parameter.symbol());
                for (j, other) in report.correlations.parameters.iter().enumerate() {
                    let r = report.correlations.matrix[(i, j)];
                    let (rect, response) = ui.allocate_exact_size(egui::vec2(30.0, 20.0), egui::Sense::hover());
                    ui.painter().rect_filled(rect, 2.0, theme::correlation(r, dark));
                    ui.painter().text(
                        rect.center(),
                        egui::Align2::CENTER_CENTER,
                        short_correlation(r),
                        egui::FontId::proportional(11.0),
                        ui.visuals().text_color(),
                    );
                    let said = tr!("{0} and {1}: r = {2}", parameter.symbol(), other.symbol(), format!("{r:.4}"));
                    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &said));
                    response.on_hover_text(said);
                }
                ui.end_row();
            }
        });
    });
}

/// Two decimals without the leading zero.
fn short_correlation(r: f64) -> String {
    if r.is_nan() { "-".to_owned() } else { format!("{r:.2}").replace("0.", ".") }
}

/// How uncertain an estimate is, with the bound that it rests on; grey where it is not the last word.
fn uncertainty_ui(estimate: &Estimate, is_final: bool, ui: &mut Ui) {
    let text = RichText::new(uncertainty_text(estimate));
    let is_final = is_final || !estimate.free;
    let text_ui = |ui: &mut Ui| {
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        ui.label(if is_final { text } else { text.weak() }).on_hover_text(uncertainty_help(estimate));
    };
    match estimate.at_bound.filter(|_| estimate.interval68.is_some()) {
        Some(edge) => {
            ui.vertical(|ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                text_ui(ui);
                ui.label(RichText::new(bound_text(edge)).small().weak());
            });
        }
        // In line with the numbers before it.
        None => _ = ui.scope(text_ui),
    }
}

/// How far the intervals are, and the way to stop them or to have them after all.
fn intervals_ui(report: &FitResult, jobs: &FitJobs, commands: &mut Vec<Action>, ui: &mut Ui) {
    match report.course.intervals_complete {
        Some(true) => {}
        Some(false) => {
            let text = tr!("Not every interval was followed to its end: some may be wider.");
            ui.add(egui::Label::new(RichText::new(text).color(theme::warning(ui.visuals().dark_mode))).wrap());
        }
        None if jobs.intervals.is_running() => {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.weak(tr!("Finding the intervals…"));
                if ui.button(tr!("Stop")).on_hover_text(tr!("Leave it at the linear errors")).clicked() {
                    commands.push(Action::CancelIntervals);
                }
            });
        }
        None => {
            ui.horizontal(|ui| {
                ui.weak(tr!("Linear errors only."));
                let help = tr!("Hold each parameter in turn and fit the others again: what the data really allow");
                if ui.button(tr!("Find the intervals")).on_hover_text(help).clicked() {
                    commands.push(Action::FindIntervals);
                }
            });
        }
    }
}
