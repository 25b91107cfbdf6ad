//! What is believed of each free parameter before the data.

use crate::app::plots::theme;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::views::context::Cx;
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::{free, free_together, is_joint};
use crate::app::work::posterior::{CHAINS, PosteriorOptions, check_prior};
use crate::app::work::settings::MetalSelection;
use egui::{ComboBox, DragValue, Grid, Label, RichText, Ui, WidgetInfo};
use pbrdf::fit::posterior::Prior;
use pbrdf::model::{Parameter, ParameterSet};
use pbrdf::optics;
use tr::tr;

/// Standard deviation of a prior from tables, at least so large a part of the value: sources of one sample agree too well.
const LEAST_SPREAD: f64 = 0.02;

pub fn priors_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let before = &cx.work.settings().panes.posterior;
    let mut options = before.clone();
    ui.horizontal(|ui| {
        let label = ui.label(tr!("Chains"));
        ui.add(DragValue::new(&mut options.chains).range(CHAINS)).labelled_by(label.id);
        metal_ui(&cx.work.settings().metal_selection, &mut options, ui);
    });
    let surface = cx.work.surface();
    let list = cx.work.measurements();
    let free = if is_joint(list) {
        list.measured().map(|open| free_together(list, open)).fold(ParameterSet::EMPTY, ParameterSet::union)
    } else {
        free(surface, list.active().measurement.has_brdf())
    };
    Grid::new("priors").num_columns(5).spacing([8.0, 4.0]).show(ui, |ui| {
        for parameter in free {
            prior_ui(parameter, surface.bounds_of(parameter), &mut options, ui);
            ui.end_row();
        }
    });
    if options != *before {
        cx.edits.push(Edit::SetPosteriorOptions(options));
    }
}

fn kind(prior: Prior) -> &'static str {
    match prior {
        Prior::Flat => "uniform within the bounds",
        Prior::Uniform { .. } => "uniform",
        Prior::Normal { .. } => "normal",
        Prior::LogUniform { .. } => "log-uniform",
    }
}

/// A line: which kind of prior, its two numbers, and what is wrong with it.
fn prior_ui(parameter: Parameter, (low, high): (f64, f64), options: &mut PosteriorOptions, ui: &mut Ui) {
    let before = options.prior_of(parameter);
    let mut prior = before;
    let label = ui.label(parameter.symbol()).on_hover_text(translated(parameter.name()));
    let middle = f64::midpoint(low, high);
    let choices = [
        Prior::Flat,
        Prior::Uniform { low, high },
        Prior::Normal { mean: middle, sd: 0.25 * (high - low) },
        Prior::LogUniform { low: if low > 0.0 { low } else { 1e-3 * high.abs().max(1e-3) }, high },
    ];
    let combo = ComboBox::from_id_salt(("prior", parameter.key())).width(150.0).selected_text(translated(kind(prior)));
    let combo = combo.show_ui(ui, |ui| {
        // c has no logarithm.
        for choice in choices.into_iter().filter(|choice| !matches!(choice, Prior::LogUniform { high, .. } if *high <= 0.0)) {
            if ui.selectable_label(kind(choice) == kind(prior), translated(kind(choice))).clicked() && kind(choice) != kind(prior) {
                prior = choice;
            }
        }
    });
    combo.response.labelled_by(label.id);
    let speed = 1e-3 * (high - low);
    let number_ui = |value: &mut f64, what: &str, ui: &mut Ui| {
        let response = ui.add(DragValue::new(value).speed(speed).max_decimals(6)).on_hover_text(translated(what));
        response.widget_info(|| WidgetInfo::labeled(egui::Role::SpinButton, true, format!("{}: {}", parameter.symbol(), translated(what))));
    };
    match &mut prior {
        Prior::Flat => {}
        Prior::Uniform { low, high } | Prior::LogUniform { low, high } => {
            number_ui(low, "lower end", ui);
            number_ui(high, "upper end", ui);
        }
        Prior::Normal { mean, sd } => {
            number_ui(mean, "mean", ui);
            number_ui(sd, "standard deviation", ui);
        }
    }
    if let Err(error) = check_prior(parameter, prior, (low, high)) {
        ui.add(Label::new(RichText::new(error.localized()).color(theme::warning(ui.visuals().dark_mode))));
    }
    if prior != before {
        options.set_prior(parameter, prior);
    }
}

/// A button: n and k as the sources of the metal of the pane Metals have them.
fn metal_ui(selection: &MetalSelection, options: &mut PosteriorOptions, ui: &mut Ui) {
    let Ok(Some(metal)) = optics::metal(&selection.metal) else { return };
    let text = tr!("n and k of {0} at {1} nm", translated(&metal.name), selection.wavelength_nm);
    if ui.button(text).on_hover_text(tr!("Normal priors: mean and scatter over the tabulated sources of the pane Metals")).clicked() {
        let found: Vec<_> = metal.sources.iter().filter_map(|source| source.index_at(selection.wavelength_nm).ok()).collect();
        let of = |part: &dyn Fn(&optics::RefractiveIndex) -> f64| {
            let values: Vec<f64> = found.iter().map(part).collect();
            normal_of(&values)
        };
        for (parameter, prior) in [(Parameter::N, of(&|index| index.n())), (Parameter::K, of(&|index| index.k_m()))] {
            prior.into_iter().for_each(|prior| options.set_prior(parameter, prior));
        }
    }
}

/// Mean and scatter of values; none of none.
#[expect(clippy::cast_precision_loss, reason = "a handful of sources")]
fn normal_of(values: &[f64]) -> Option<Prior> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0).max(1.0);
    (!values.is_empty()).then(|| Prior::Normal { mean, sd: variance.sqrt().max(LEAST_SPREAD * mean.abs()) })
}

#[cfg(test)]
mod tests {
    use super::{Prior, normal_of};

    #[test]
    fn a_prior_from_tables_has_their_scatter_and_never_none() {
        assert_eq!(normal_of(&[]), None);
        assert_eq!(normal_of(&[2.0]), Some(Prior::Normal { mean: 2.0, sd: 0.04 }));
        assert_eq!(normal_of(&[1.0, 3.0]), Some(Prior::Normal { mean: 2.0, sd: 2.0_f64.sqrt() }));
    }
}
