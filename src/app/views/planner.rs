//! The angle planner: angles that might be measured, and what they would determine beside what the
//! open measurement does.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme;
use crate::app::text::glossary::open_help;
use crate::app::text::i18n;
use crate::app::text::i18n::{Language, translated};
use crate::app::text::localized::Localized as _;
use crate::app::text::numbers::{percent, short, significant};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::design::{AngleRange, DesignSettings, STEEPEST};
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::free_in_design;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::predicted_errors::PredictedErrors;
use crate::app::work::workspace::Workspace;
use egui::{ComboBox, DragValue, Grid, Role, ScrollArea, Ui, WidgetInfo};
use pbrdf::fit::Undetermined;
use pbrdf::measurement::Columns;
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};
use tr::tr;

/// What predictions depend on, the language of their words included.
type Key = (Parameters, Model, ParameterSet, DesignSettings, u64, Language);

pub static SPEC: PaneSpec = PaneSpec {
    title: "Angle planner",
    tooltip: "What a measurement at these angles would determine, before it is made",
    shortcut: None,
    has_options: false,
    has_figure: false,
    new: || Box::new(PlannerView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct PlannerView {
    /// Of the open measurement's angles, and of the planned ones.
    pub predictions: Memo<Key, [Result<PredictedErrors, String>; 2]>,
}

/// Width from which errors stand in percent too.
const WITH_PERCENT: f32 = 400.0;
/// Width that angles and errors need side by side.
const SIDE_BY_SIDE: f32 = 540.0;

impl View for PlannerView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (design, surface, document) = (&cx.work.settings().design, cx.work.surface(), cx.work.active());
        let free = free_in_design(surface, design, document.measurement.has_brdf());
        let key = (surface.parameters, surface.model, free, design.clone(), document.generation, i18n::current());
        self.predictions.refresh(key, |_| {
            let measured = PredictedErrors::of_measurement(surface, design, free, &document.measurement);
            [measured, PredictedErrors::of_design(surface, design, free)]
        });
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let (before, document) = (&cx.work.settings().design, cx.work.active());
        let mut design = before.clone();
        ScrollArea::both().auto_shrink([false; 2]).show(ui, |ui| {
            if ui.available_width() > SIDE_BY_SIDE {
                ui.horizontal_top(|ui| {
                    ui.vertical(|ui| angles_ui(&mut design, document, ui));
                    ui.separator();
                    ui.vertical(|ui| predictions_ui(cx.work, self, ui));
                });
            } else {
                angles_ui(&mut design, document, ui);
                ui.separator();
                predictions_ui(cx.work, self, ui);
            }
        });
        if design != *before {
            cx.edits.push(Edit::SetDesign(design));
        }
    }
}

fn angles_ui(plan: &mut DesignSettings, document: &OpenMeasurement, ui: &mut Ui) {
    ui.horizontal(|ui| {
        ui.strong(tr!("Planned angles"));
        if ui.button(tr!("Dense")).on_hover_text(tr!("θi from 10° to 80°, θr from 0° to 85°")).clicked() {
            let DesignSettings { theta_i, theta_r, .. } = DesignSettings::default();
            *plan = DesignSettings { theta_i, theta_r, ..plan.clone() };
        }
        if ui.button(tr!("As measured")).on_hover_text(tr!("The angles of the open measurement, each for itself")).clicked() {
            as_measured(plan, document);
        }
    });
    Grid::new("planned angles").num_columns(5).min_col_width(0.0).show(ui, |ui| {
        for heading in ["", "from", "to", "step", ""] {
            ui.weak(translated(heading));
        }
        ui.end_row();
        spans_ui(&mut plan.theta_i, "θi", 0.0, ui);
        spans_ui(&mut plan.theta_r, "θr", -STEEPEST, ui);
    });
    Grid::new("planned noise").num_columns(2).min_col_width(0.0).show(ui, |ui| {
        let help = tr!("Relative azimuth φr − φi: 180° is the plane of incidence, with the backscatter side at negative θr");
        number_ui(&mut plan.dphi, "Δφ", &help, "°", 0.0..=360.0, 0.5, ui);
        let label = ui.label(tr!("Measured"));
        let text = |columns| match columns {
            Columns::Dolp => tr!("DoLP"),
            Columns::Brdf => tr!("BRDF"),
            Columns::Both => tr!("DoLP and BRDF"),
        };
        let combo = ComboBox::from_id_salt("planned columns").selected_text(text(plan.columns)).show_ui(ui, |ui| {
            for columns in [Columns::Dolp, Columns::Brdf, Columns::Both] {
                ui.selectable_value(&mut plan.columns, columns, text(columns));
            }
        });
        combo.response.labelled_by(label.id);
        ui.end_row();
        if plan.columns != Columns::Brdf {
            number_ui(&mut plan.noise, &tr!("Noise of DoLP"), &tr!("Standard deviation of one value, absolute"), "", 1e-6..=1.0, 1e-4, ui);
        }
        if plan.has_brdf() {
            number_ui(
                &mut plan.brdf_noise,
                &tr!("Noise of BRDF"),
                &tr!("Standard deviation of one value, relative to it"),
                "",
                1e-6..=10.0,
                1e-3,
                ui,
            );
        }
    });
}

/// A row with a name and a number.
fn number_ui(value: &mut f64, name: &str, help: &str, suffix: &str, range: std::ops::RangeInclusive<f64>, speed: f64, ui: &mut Ui) {
    let label = ui.label(name).on_hover_text(help);
    ui.add(DragValue::new(value).range(range).speed(speed).max_decimals(6).suffix(suffix)).labelled_by(label.id).on_hover_text(help);
    ui.end_row();
}

/// Rows of angles of one kind, with buttons to add and to remove.
fn spans_ui(spans: &mut Vec<AngleRange>, name: &str, least: f64, ui: &mut Ui) {
    let mut removed = None;
    for (i, span) in spans.iter_mut().enumerate() {
        ui.label(name);
        let field = |ui: &mut Ui, value: &mut f64, range: std::ops::RangeInclusive<f64>, what: &str| {
            let response = ui.add(DragValue::new(value).range(range).speed(0.5).max_decimals(3).suffix("°"));
            response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, format!("{name} {} {}", i + 1, translated(what))));
        };
        field(ui, &mut span.from, least..=STEEPEST, "from");
        // The other end follows.
        span.to = span.to.max(span.from);
        field(ui, &mut span.to, span.from..=STEEPEST, "to");
        field(ui, &mut span.step, 0.1..=90.0, "step");
        let remove = ui.button("×").on_hover_text(tr!("remove"));
        remove.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Remove {0} {1}", name, i + 1)));
        if remove.clicked() {
            removed = Some(i);
        }
        ui.end_row();
    }
    if let Some(i) = removed {
        spans.remove(i);
    }
    ui.label("");
    if ui.button(tr!("add {}", name)).clicked() {
        let next = spans.last().map_or(45.0, |last| (last.to + last.step).min(STEEPEST));
        spans.push(AngleRange::new(next, next, spans.last().map_or(5.0, |last| last.step)));
    }
    ui.end_row();
}

/// Angles that are listed at most when a measurement's own are taken over.
const MOST_SPANS: usize = 12;

/// The angles of the open measurement, those an equal step apart in one row.
fn as_measured(plan: &mut DesignSettings, document: &OpenMeasurement) {
    let used = || document.measurement.rows.iter().filter(|row| !row.masked).map(|row| row.geometry);
    let spans = |angles: &mut dyn Iterator<Item = f64>| {
        let mut angles: Vec<f64> = angles.collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup();
        let mut spans: Vec<AngleRange> = Vec::new();
        for angle in angles {
            match spans.last_mut() {
                // The second angle sets the step.
                Some(last) if last.from == last.to => (last.to, last.step) = (angle, angle - last.from),
                Some(last) if (last.to + last.step - angle).abs() < 1e-6 * last.step => last.to = angle,
                _ => spans.push(AngleRange::new(angle, angle, 5.0)),
            }
        }
        spans.truncate(MOST_SPANS);
        spans
    };
    plan.theta_i = spans(&mut used().map(|geometry| geometry.theta_i().0));
    let signed = |geometry: pbrdf::optics::Geometry| {
        let forward = (90.0..=270.0).contains(&geometry.dphi().0.rem_euclid(360.0));
        if forward { geometry.theta_r().0 } else { -geometry.theta_r().0 }
    };
    plan.theta_r = spans(&mut used().map(signed));
    plan.dphi = document.series.first().map_or(180.0, |series| series.plane);
}

fn predictions_ui(work: &Workspace, view: &PlannerView, ui: &mut Ui) {
    let warning = theme::warning(ui.visuals().dark_mode);
    let Some([now, planned]) = view.predictions.get() else {
        ui.label("…");
        return;
    };
    let parameters = &work.surface().parameters;
    let (incidences, views) = work.settings().design.counts();
    ui.strong(tr!("Predicted standard errors: {0} × {1} planned points", incidences, views));
    ui.weak(tr!("At the sliders as they stand; both columns with the planned noise."));
    for sentence in [now, planned].into_iter().filter_map(|prediction| prediction.as_ref().err()) {
        ui.colored_label(warning, sentence);
    }
    let any = planned.as_ref().or(now.as_ref());
    let Ok(any) = any else { return };
    let with_percent = ui.available_width() > WITH_PERCENT;
    Grid::new("predicted errors").num_columns(5).striped(true).spacing([9.0, 4.0]).min_col_width(0.0).show(ui, |ui| {
        for (heading, help) in [
            ("", ""),
            ("value", "The slider"),
            ("± now", "With the angles of the open measurement"),
            ("± planned", "With the planned angles"),
            ("gain", "How many times smaller the error becomes: now over planned"),
        ] {
            if heading.is_empty() {
                ui.label("");
            } else {
                ui.strong(translated(heading)).on_hover_text(translated(help));
            }
        }
        ui.end_row();
        for (parameter, _) in &any.errors {
            error_row_ui(parameters, *parameter, [now, planned], with_percent, ui);
        }
    });
    for (prediction, angles) in [(planned, "With the planned angles"), (now, "With the measured angles")] {
        if let Ok(prediction) = prediction {
            open_ui(prediction, angles, ui);
        }
    }
}

fn error_row_ui(
    parameters: &Parameters,
    parameter: Parameter,
    [now, planned]: [&Result<PredictedErrors, String>; 2],
    with_percent: bool,
    ui: &mut Ui,
) {
    let value = parameters[parameter];
    let error =
        |prediction: &Result<PredictedErrors, String>| prediction.as_ref().ok().and_then(|prediction| prediction.error_of(parameter));
    ui.label(parameter.symbol()).on_hover_text(translated(parameter.name()));
    ui.monospace(significant(value));
    for prediction in [now, planned] {
        match (prediction, error(prediction)) {
            (Err(_), _) => _ = ui.monospace("-"),
            (Ok(_), None) => _ = ui.monospace(tr!("open")).on_hover_text(open_help()),
            (Ok(prediction), Some(error)) if !prediction.determined.contains(parameter) => {
                ui.monospace(tr!("not determined")).on_hover_text(format!("± {}", short(error)));
            }
            (Ok(_), Some(error)) => {
                let share = percent(parameter, value, error);
                let text = if with_percent { format!("{} ({share})", short(error)) } else { short(error) };
                ui.monospace(text).on_hover_text(share);
            }
        }
    }
    ui.monospace(error(now).zip(error(planned)).map_or_else(String::new, |(now, planned)| short(now / planned)));
    ui.end_row();
}

/// What stays open, in words.
fn open_ui(prediction: &PredictedErrors, angles: &str, ui: &mut Ui) {
    let loose = prediction.errors.iter().filter(|(_, error)| error.is_some()).map(|(parameter, _)| *parameter);
    let loose: Vec<Parameter> = loose.filter(|parameter| !prediction.determined.contains(*parameter)).collect();
    let directions = prediction.open.iter().cloned().map(Undetermined::Direction);
    let loose = (!loose.is_empty()).then_some(Undetermined::Parameters(loose));
    let open: Vec<Undetermined> = directions.chain(loose).collect();
    if open.is_empty() {
        ui.add(egui::Label::new(tr!("{} nothing stays open.", translated(angles))).wrap());
        return;
    }
    ui.add_space(4.0);
    ui.strong(tr!("{} there stays open:", translated(angles)));
    for what in &open {
        ui.add(egui::Label::new(format!("• {}", what.localized())).wrap());
    }
}
