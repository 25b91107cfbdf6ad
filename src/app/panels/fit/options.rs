//! The choices of a fit: what is minimised, and from where.

use crate::app::plots::theme;
use crate::app::text::i18n::translated;
use crate::app::work::settings::Settings;
use egui::{CollapsingHeader, ComboBox, DragValue, Grid, Ui};
use pbrdf::fit::{BrdfResiduals, FitOptions, Loss, Starts, Weights};
use pbrdf::measurement::Measurement;
use pbrdf::model::{DolpFormula, Parameter};
use tr::tr;

/// Starts that can be asked for at most.
const MOST_STARTS: usize = 100_000;
/// Starts when a number of them is first asked for.
const SOME_STARTS: usize = 100;

pub fn options_ui(settings: &mut Settings, measurement: &Measurement, states_sigmas: bool, ui: &mut Ui) {
    let are_defaults = settings.choices == FitOptions::default()
        && settings.starts == Starts::Automatic
        && settings.model.dolp_formula == DolpFormula::default();
    let title = if are_defaults { tr!("Options") } else { tr!("Options (not the defaults)") };
    CollapsingHeader::new(title).id_salt("fit options").show(ui, |ui| {
        Grid::new("fit options").num_columns(2).show(ui, |ui| {
            residuals_ui(&mut settings.choices, ui);
            loss_ui(&mut settings.choices, ui);
            eq17_ui(settings, measurement.has_brdf(), ui);
            starts_ui(settings, ui);
        });
        if settings.choices.weights == Weights::Sigma && !states_sigmas {
            let text = tr!("This measurement does not state a standard deviation for every value: a fit with these weights cannot begin.");
            ui.colored_label(theme::warning(ui.visuals().dark_mode), text);
        }
        if ui.add_enabled(!are_defaults, egui::Button::new(tr!("Default options"))).clicked() {
            settings.choices = FitOptions::default();
            settings.model.dolp_formula = DolpFormula::default();
            settings.starts = Starts::Automatic;
            settings.seed = 1;
            keep_ks_where_only_ratios_count(settings, measurement.has_brdf());
        }
    });
}

/// One choice out of a few, with its name in front; true when it changed.
fn choice<T: PartialEq + Copy>(ui: &mut Ui, name: &str, help: &str, value: &mut T, options: &[(T, &str)]) -> bool {
    let before = *value;
    let label = ui.label(translated(name)).on_hover_text(translated(help));
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

fn residuals_ui(choices: &mut FitOptions, ui: &mut Ui) {
    choice(
        ui,
        "Weights",
        "None: ΔE of Eq. (18). By standard deviation: every residual over its stated σ, so that the sum of squares is χ².",
        &mut choices.weights,
        &[(Weights::None, "none: ΔE, Eq. (18)"), (Weights::Sigma, "1/σ: χ²")],
    );
    choice(
        ui,
        "BRDF residuals",
        "Absolute: X − Xm. Relative: (X − Xm)/Xm. Logarithmic: ln X − ln Xm, for lobes that span decades.",
        &mut choices.brdf_residuals,
        &[(BrdfResiduals::Absolute, "absolute"), (BrdfResiduals::Relative, "relative"), (BrdfResiduals::Log, "logarithmic")],
    );
}

fn loss_ui(choices: &mut FitOptions, ui: &mut Ui) {
    choice(
        ui,
        "Loss",
        "Linear: least squares. Huber and soft-L1 count residuals beyond the scale by their size, so that an outlier pulls less.",
        &mut choices.loss,
        &[(Loss::Squared, "linear"), (Loss::Huber, "Huber"), (Loss::SoftL1, "soft-L1")],
    );
    if choices.loss == Loss::Squared {
        return;
    }
    let help = tr!("Where the loss changes from squares to sizes, in units of the residual; automatic: 1.345 × the normalised median \
         absolute deviation of the residuals of a linear fit.");
    let label = ui.label(tr!("Loss scale")).on_hover_text(&help);
    ui.horizontal(|ui| {
        let mut automatic = choices.loss_scale.is_none();
        if ui.checkbox(&mut automatic, tr!("automatic")).on_hover_text(&help).changed() {
            choices.loss_scale = if automatic { None } else { Some(0.01) };
        }
        if let Some(scale) = &mut choices.loss_scale {
            let speed = 0.02 * *scale;
            ui.add(DragValue::new(scale).range(1e-12..=1e12).speed(speed).max_decimals(8)).labelled_by(label.id);
        }
    });
    ui.end_row();
}

fn eq17_ui(settings: &mut Settings, has_brdf: bool, ui: &mut Ui) {
    let changed = choice(
        ui,
        "Eq. (17)",
        "Consistent: k_s in the numerator, as Eqs. (14, 15) have it. As printed: without it, so that k_s is a gain of its own and DoLP \
         may exceed 1.",
        &mut settings.model.dolp_formula,
        &[(DolpFormula::Consistent, "consistent"), (DolpFormula::AsPrinted, "as printed")],
    );
    if changed {
        keep_ks_where_only_ratios_count(settings, has_brdf);
    }
}

/// As printed k_s counts by itself; in the consistent reading DoLP alone knows only ratios to it.
fn keep_ks_where_only_ratios_count(settings: &mut Settings, has_brdf: bool) {
    let only_ratios = settings.model.dolp_formula == DolpFormula::Consistent && !has_brdf;
    settings.locked = if only_ratios { settings.locked.with(Parameter::Ks) } else { settings.locked.without(Parameter::Ks) };
}

fn starts_ui(settings: &mut Settings, ui: &mut Ui) {
    let several = match settings.starts {
        Starts::Exactly(count) => count,
        Starts::Automatic | Starts::One => SOME_STARTS,
    };
    choice(
        ui,
        "Starts",
        "Automatic: the sliders, a first guess, and spread points until nothing new is found. One: the sliders alone.",
        &mut settings.starts,
        &[(Starts::Automatic, "automatic"), (Starts::One, "one, from the sliders"), (Starts::Exactly(several), "a number of them")],
    );
    if let Starts::Exactly(count) = &mut settings.starts {
        let label = ui.label(tr!("Number of starts"));
        ui.add(DragValue::new(count).range(2..=MOST_STARTS)).labelled_by(label.id);
        ui.end_row();
    }
    if settings.starts != Starts::One {
        let label = ui.label(tr!("Seed")).on_hover_text(tr!("The same seed gives the same starts, and the same result, on every machine"));
        ui.add(DragValue::new(&mut settings.seed).speed(0.1)).labelled_by(label.id);
        ui.end_row();
    }
}
