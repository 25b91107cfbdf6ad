//! The choices of a fit: what is minimised, and from where.

use crate::app::plots::theme;
use crate::app::text::explained::Explained as _;
use crate::app::text::i18n::translated;
use crate::app::views::Cx;
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::is_joint;
use crate::app::work::settings::Settings;
use crate::app::work::surface::Surface;
use egui::{CollapsingHeader, ComboBox, DragValue, Grid, Label, Role, Ui, WidgetInfo};
use pbrdf::fit::{BrdfResiduals, FitOptions, FitRange, Loss, Starts, StoppingRule, Weights};
use pbrdf::model::{DolpFormula, Parameter};
use tr::tr;

/// Starts that can be asked for at most.
const MOST_STARTS: usize = 100_000;
/// Starts when a number of them is first asked for.
const SOME_STARTS: usize = 100;

/// Copies of what the panel sets; those that change become edits.
struct Draft {
    fit_options: FitOptions,
    starts: Starts,
    seed: u64,
    surface: Surface,
}

pub fn options_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let Settings { fit_options, starts, seed, .. } = *cx.work.settings();
    let surface = cx.work.surface();
    let has_brdf = cx.work.active().measurement.has_brdf();
    let mut draft = Draft { fit_options, starts, seed, surface: surface.clone() };
    let are_defaults =
        fit_options == FitOptions::default() && starts == Starts::Automatic && surface.model.dolp_formula == DolpFormula::default();
    let title = if are_defaults { tr!("Options") } else { tr!("Options (not the defaults)") };
    CollapsingHeader::new(title).id_salt("fit options").show(ui, |ui| {
        Grid::new("fit options").num_columns(2).show(ui, |ui| {
            residuals_ui(&mut draft.fit_options, ui);
            loss_ui(&mut draft.fit_options, ui);
            eq17_ui(&mut draft.surface, has_brdf, ui);
            starts_ui(&mut draft, ui);
            range_ui(&mut draft.fit_options, ui);
        });
        weights_ui(cx, ui);
        if fit_options.weights == Weights::Sigma && !cx.derived.states_sigmas() {
            let text = tr!("This measurement does not state a standard deviation for every value: a fit with these weights cannot begin.");
            ui.colored_label(theme::warning(ui.visuals().dark_mode), text);
        }
        if ui.add_enabled(!are_defaults, egui::Button::new(tr!("Default options"))).clicked() {
            let mut surface = surface.clone();
            surface.model.dolp_formula = DolpFormula::default();
            keep_ks_where_only_ratios_count(&mut surface, has_brdf);
            draft = Draft { fit_options: FitOptions::default(), starts: Starts::Automatic, seed: 1, surface };
        }
    });
    let edits = [
        (draft.fit_options != fit_options).then_some(Edit::SetFitOptions(draft.fit_options)),
        (draft.starts != starts).then_some(Edit::SetStarts(draft.starts)),
        (draft.seed != seed).then_some(Edit::SetSeed(draft.seed)),
        (draft.surface != *surface).then(|| Edit::SetSurface(Box::new(draft.surface))),
    ];
    cx.edits.extend(edits.into_iter().flatten());
}

/// One choice out of a few, with its name in front; true when it changed.
fn choice_ui<T: PartialEq + Copy>(ui: &mut Ui, name: &str, help: &str, value: &mut T, options: &[(T, &str)]) -> bool {
    let before = *value;
    let label = ui.label(translated(name)).explained(translated(help));
    let chosen = options.iter().find(|(option, _)| option == value).map_or_else(String::new, |(_, text)| translated(text));
    let combo = ComboBox::from_id_salt(name).width(150.0).selected_text(chosen).show_ui(ui, |ui| {
        for (option, text) in options {
            ui.selectable_value(value, *option, translated(text));
        }
    });
    combo.response.labelled_by(label.id).on_hover_text(translated(help));
    ui.end_row();
    *value != before
}

fn residuals_ui(fit_options: &mut FitOptions, ui: &mut Ui) {
    choice_ui(
        ui,
        "Weights",
        "None: ΔE of Eq. (18). By standard deviation: every residual over its stated σ, so that the sum of squares is χ².",
        &mut fit_options.weights,
        &[(Weights::None, "none: ΔE, Eq. (18)"), (Weights::Sigma, "1/σ: χ²")],
    );
    choice_ui(
        ui,
        "BRDF residuals",
        "Absolute: X − Xm. Relative: (X − Xm)/Xm. Logarithmic: ln X − ln Xm, for lobes that span decades.",
        &mut fit_options.brdf_residuals,
        &[(BrdfResiduals::Absolute, "absolute"), (BrdfResiduals::Relative, "relative"), (BrdfResiduals::Log, "logarithmic")],
    );
}

fn loss_ui(fit_options: &mut FitOptions, ui: &mut Ui) {
    choice_ui(
        ui,
        "Loss",
        "Linear: least squares. Huber and soft-L1 count residuals beyond the scale by their size, so that an outlier pulls less.",
        &mut fit_options.loss,
        &[(Loss::Squared, "linear"), (Loss::Huber, "Huber"), (Loss::SoftL1, "soft-L1")],
    );
    if fit_options.loss == Loss::Squared {
        return;
    }
    let help = tr!("Where the loss changes from squares to sizes, in units of the residual; automatic: 1.345 × the normalised median \
         absolute deviation of the residuals of a linear fit.");
    let label = ui.label(tr!("Loss scale")).explained(&help);
    ui.horizontal(|ui| {
        let mut automatic = fit_options.loss_scale.is_none();
        if ui.checkbox(&mut automatic, tr!("automatic")).on_hover_text(&help).changed() {
            fit_options.loss_scale = if automatic { None } else { Some(0.01) };
        }
        if let Some(scale) = &mut fit_options.loss_scale {
            let speed = 0.02 * *scale;
            ui.add(DragValue::new(scale).range(1e-12..=1e12).speed(speed).max_decimals(8)).labelled_by(label.id);
        }
    });
    ui.end_row();
}

fn eq17_ui(surface: &mut Surface, has_brdf: bool, ui: &mut Ui) {
    let changed = choice_ui(
        ui,
        "Eq. (17)",
        "Consistent: k_s in the numerator, as Eqs. (14, 15) have it. As printed: without it, so that k_s is a gain of its own and DoLP \
         may exceed 1.",
        &mut surface.model.dolp_formula,
        &[(DolpFormula::Consistent, "consistent"), (DolpFormula::AsPrinted, "as printed")],
    );
    if changed {
        keep_ks_where_only_ratios_count(surface, has_brdf);
    }
}

/// As printed k_s counts by itself; in the consistent reading DoLP alone knows only ratios to it.
fn keep_ks_where_only_ratios_count(surface: &mut Surface, has_brdf: bool) {
    let only_ratios = surface.model.dolp_formula == DolpFormula::Consistent && !has_brdf;
    surface.locked = if only_ratios { surface.locked.with(Parameter::Ks) } else { surface.locked.without(Parameter::Ks) };
}

/// The part of the angles that is fitted.
fn range_ui(fit_options: &mut FitOptions, ui: &mut Ui) {
    let help = tr!("Rows outside are left out of the fit, as masked ones are; θr is negative on the backscatter side");
    let mut is_part = fit_options.range.is_some();
    ui.label(tr!("Angles")).explained(&help);
    if ui.checkbox(&mut is_part, tr!("only a range")).on_hover_text(&help).changed() {
        fit_options.range = is_part.then(FitRange::default);
    }
    ui.end_row();
    let Some(range) = &mut fit_options.range else { return };
    for (name, ends, least) in [("θi", &mut range.theta_i, 0.0), ("θr", &mut range.theta_r, -90.0)] {
        ui.label(name);
        ui.horizontal(|ui| {
            let [from, to] = *ends;
            for (end, bounds, said) in [(0, least..=to, tr!("{} from", name)), (1, from..=90.0, tr!("{} to", name))] {
                let field = ui.add(DragValue::new(&mut ends[end]).range(bounds).speed(0.5).max_decimals(2).suffix("°"));
                field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, &said));
                if end == 0 {
                    ui.label("–");
                }
            }
        });
        ui.end_row();
    }
}

/// How often each measurement counts, where they are fitted together.
fn weights_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let list = cx.work.measurements();
    if !is_joint(list) {
        return;
    }
    let help = tr!("How often its squared residuals count in a fit of several measurements");
    ui.label(tr!("Weight of each measurement")).explained(&help);
    for open in list.measured() {
        // The number first: the name has the rest of the width.
        ui.horizontal(|ui| {
            let mut weight = open.weight;
            let field = ui.add(DragValue::new(&mut weight).range(0.001..=1000.0).speed(0.01).max_decimals(4)).on_hover_text(&help);
            field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, tr!("Weight of {}", open.title())));
            if field.changed() {
                cx.edits.push(Edit::SetWeight { number: open.number, weight });
            }
            ui.add(Label::new(open.title()).truncate());
        });
    }
}

fn stopping_rule_ui(rule: &mut StoppingRule, ui: &mut Ui) {
    let label = ui.label(tr!("Starts at most"));
    ui.add(DragValue::new(&mut rule.most_starts).range(1..=MOST_STARTS)).labelled_by(label.id);
    ui.end_row();
    let label = ui.label(tr!("Hits of the best")).explained(tr!("So many starts end in the best minimum before the search ends"));
    ui.add(DragValue::new(&mut rule.hits).range(1..=MOST_STARTS)).labelled_by(label.id);
    ui.end_row();
    let label = ui.label(tr!("Unseen share below")).explained(tr!("Expected share of further starts that end in a minimum not seen yet"));
    ui.add(DragValue::new(&mut rule.unseen_share).range(0.0..=1.0).speed(0.001)).labelled_by(label.id);
    ui.end_row();
}

fn starts_ui(draft: &mut Draft, ui: &mut Ui) {
    let several = match draft.starts {
        Starts::Exactly(count) => count,
        Starts::Automatic | Starts::Until(_) | Starts::One => SOME_STARTS,
    };
    let rule = match draft.starts {
        Starts::Until(rule) => rule,
        _ => StoppingRule::default(),
    };
    choice_ui(
        ui,
        "Starts",
        "Automatic: the sliders, a first guess, and spread points until nothing new is found. One: the sliders alone.",
        &mut draft.starts,
        &[
            (Starts::Automatic, "automatic"),
            (Starts::One, "one, from the sliders"),
            (Starts::Exactly(several), "a number of them"),
            (Starts::Until(rule), "until a rule is met"),
        ],
    );
    if let Starts::Until(rule) = &mut draft.starts {
        stopping_rule_ui(rule, ui);
    }
    if let Starts::Exactly(count) = &mut draft.starts {
        let label = ui.label(tr!("Number of starts"));
        ui.add(DragValue::new(count).range(2..=MOST_STARTS)).labelled_by(label.id);
        ui.end_row();
    }
    if draft.starts != Starts::One {
        let label = ui.label(tr!("Seed")).explained(tr!("The same seed gives the same starts, and the same result, on every machine"));
        ui.add(DragValue::new(&mut draft.seed).speed(0.1)).labelled_by(label.id);
        ui.end_row();
    }
}
