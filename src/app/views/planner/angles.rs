//! Which angles might be measured, and how well.

use crate::app::text::i18n::translated;
use crate::app::work::design::{AngleRange, DesignSettings, STEEPEST};
use crate::app::work::open_measurement::OpenMeasurement;
use egui::{ComboBox, DragValue, Grid, Role, Ui, WidgetInfo};
use pbrdf::measurement::Columns;
use tr::tr;

pub fn angles_ui(plan: &mut DesignSettings, document: &OpenMeasurement, ui: &mut Ui) {
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
            // A label without a word would be a control without a name.
            if heading.is_empty() {
                ui.scope(|_| ());
            } else {
                ui.weak(translated(heading));
            }
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
    ui.scope(|_| ());
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
