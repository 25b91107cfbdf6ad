//! The dialog that asks the questions of a foreign file, with the first rows of the measurement.

use crate::app::plots::theme;
use crate::app::shell::app::App;
use crate::app::shell::dialogs::Dialogs;
use crate::app::shell::import_dialog::{ImportDialog, Slices};
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::text::messages::advised;
use crate::app::text::numbers::{short, significant};
use crate::app::views::action::Action;
use crate::app::work::design::AngleRange;
use egui::{ComboBox, DragValue, Grid, Label, RichText, Role, ScrollArea, Slider, SliderClamping, Ui, WidgetInfo};
use pbrdf::measurement::formats::{ImportOptions, Imported, Question, TableSample};
use pbrdf::measurement::{ColumnChoice, Field, MappedColumn, Mapping, Unit};
use tr::tr;

/// Width of the dialog, and heights of its scroll areas: place and size of the dialog don't depend
/// on the options.
const WIDTH: f32 = 640.0;
const COLUMNS_HEIGHT: f32 = 220.0;
const ANSWER_HEIGHT: f32 = 176.0;
/// Rows of the measurement that are shown.
const SHOWN: usize = 5;
/// With more wavelengths there is a slider in place of a list.
const LISTED: usize = 12;

pub fn import_ui(app: &mut App, ui: &mut Ui) {
    let App { dialogs: Dialogs { import: Some(import), .. }, jobs, actions, .. } = app else { return };
    let response = egui::Modal::new(egui::Id::unique("import")).show(ui.ctx(), |ui| {
        ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 40.0));
        ui.heading(tr!("Import {}", import.origin.name));
        questions_ui(import, ui);
        ui.separator();
        let answer = ScrollArea::vertical().id_salt("answer").min_scrolled_height(ANSWER_HEIGHT).max_height(ANSWER_HEIGHT);
        let is_sound = answer.auto_shrink([false; 2]).show(ui, |ui| answer_ui(import, ui)).inner;
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            if let Some(done) = jobs.files.reading_fraction() {
                #[expect(clippy::cast_possible_truncation, reason = "a fraction for a progress bar")]
                ui.add(egui::ProgressBar::new(done as f32).desired_width(160.0).text(tr!("Reading…")));
            } else {
                let open = ui.add_enabled(is_sound, egui::Button::new(tr!("Open")));
                if open.clicked() {
                    actions.push(Action::Import);
                }
                // Enter opens.
                if is_sound && ui.memory(|memory| memory.focused().is_none()) {
                    open.request_focus();
                }
            }
            if ui.button(tr!("Cancel")).on_hover_text(tr!("What is open stays")).clicked() {
                actions.push(Action::CancelImport);
            }
        });
    });
    // A click beside the dialog would lose the options.
    if response.should_close() && !response.backdrop_response.clicked() {
        actions.push(Action::CancelImport);
    }
}

/// The questions of the file, each in its widgets.
fn questions_ui(import: &mut ImportDialog, ui: &mut Ui) {
    let ImportDialog { file, questions, options, slices, .. } = import;
    if !file.summary().is_empty() {
        ui.label(translated(file.summary()));
    }
    for question in &*questions {
        match question {
            Question::Wavelength { available_nm } => wavelength_ui(options, available_nm, ui),
            Question::ThetaI => theta_i_ui(options, ui),
            Question::Directions => slices_ui(slices, options, ui),
            Question::Columns(sample) => columns_ui(&mut options.columns, sample, ui),
        }
    }
}

fn wavelength_ui(options: &mut ImportOptions, available_nm: &[f64], ui: &mut Ui) {
    ui.horizontal(|ui| {
        let label = ui.label(tr!("Wavelength"));
        let (Some(&first), Some(&last)) = (available_nm.first(), available_nm.last()) else { return };
        let wavelength_nm = options.wavelength_nm.get_or_insert(first);
        if available_nm.len() <= LISTED {
            let combo = ComboBox::from_id_salt("wavelength").selected_text(format!("{wavelength_nm} nm")).show_ui(ui, |ui| {
                for &other in available_nm {
                    ui.selectable_value(wavelength_nm, other, format!("{other} nm"));
                }
            });
            combo.response.labelled_by(label.id);
        } else {
            let mut wanted = *wavelength_nm;
            ui.spacing_mut().slider_width = 260.0;
            let slider = Slider::new(&mut wanted, first..=last).show_value(false).clamping(SliderClamping::Never);
            let slid = ui.add(slider).labelled_by(label.id).changed();
            let value = DragValue::new(&mut wanted).range(first..=last).speed(1.0).max_decimals(3).suffix(" nm");
            if ui.add(value).labelled_by(label.id).changed() || slid {
                // The nearest that the file has, as the import takes it.
                let distance = |other: f64| (other - wanted).abs();
                let nearest = available_nm.iter().copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
                *wavelength_nm = nearest.unwrap_or(wanted);
            }
            ui.weak(tr!("{0} of them, {1} to {2} nm", available_nm.len(), short(first), short(last)));
        }
    });
}

/// One angle of incidence for the whole file.
fn theta_i_ui(options: &mut ImportOptions, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let label = ui.label(tr!("Angle of incidence"));
        let mut degrees = options.theta_i.first().copied().unwrap_or(OFFERED_THETA_I);
        if ui.add(DragValue::new(&mut degrees).range(0.0..=89.9).speed(0.5).max_decimals(3).suffix("°")).labelled_by(label.id).changed() {
            options.theta_i = vec![degrees];
        }
    });
}

fn slices_ui(Slices { theta_i, theta_r }: &mut Slices, options: &mut ImportOptions, ui: &mut Ui) {
    let dphi = options.dphi.get_or_insert(180.0);
    Grid::new("slices").num_columns(4).show(ui, |ui| {
        for heading in [String::new(), tr!("from"), tr!("to"), tr!("step")] {
            ui.weak(heading);
        }
        ui.end_row();
        span_ui(theta_i, "θi", 0.0, ui);
        // A negative angle of view is the backscatter side of the plane of incidence; the field
        // holds to its range.
        let least = if *dphi == 180.0 { -89.9 } else { 0.0 };
        span_ui(theta_r, "θr", least, ui);
        let label = ui.label("Δφ").on_hover_text(tr!("180° is the plane of incidence; other values lie outside of it"));
        ui.add(DragValue::new(dphi).range(0.0..=360.0).speed(0.5).max_decimals(3).suffix("°")).labelled_by(label.id);
        ui.end_row();
    });
}

fn span_ui(span: &mut AngleRange, name: &str, least: f64, ui: &mut Ui) {
    ui.label(name);
    let field = |ui: &mut Ui, value: &mut f64, range: std::ops::RangeInclusive<f64>, what: String| {
        let response = ui.add(DragValue::new(value).range(range).speed(0.5).max_decimals(3).suffix("°"));
        response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, format!("{name} {what}")));
    };
    field(ui, &mut span.from, least..=89.9, tr!("from"));
    // The other end follows.
    span.to = span.to.max(span.from);
    field(ui, &mut span.to, span.from..=89.9, tr!("to"));
    field(ui, &mut span.step, 0.5..=90.0, tr!("step"));
    ui.end_row();
}

/// What each field is called.
fn field_text(field: Option<Field>) -> String {
    match field {
        None => tr!("not used"),
        Some(Field::ThetaI) => tr!("θi, angle of incidence"),
        Some(Field::ThetaR) => tr!("θr, angle of view"),
        Some(Field::Dphi) => tr!("Δφ, relative azimuth"),
        Some(Field::Dolp) => "DoLP".to_owned(),
        Some(Field::DolpSigma) => tr!("standard deviation of DoLP"),
        Some(Field::Brdf) => tr!("BRDF in 1/sr"),
        Some(Field::BrdfSigma) => tr!("standard deviation of BRDF"),
        Some(Field::Masked) => tr!("mask, 0 or 1"),
        Some(Field::Set) => tr!("name of the measurement"),
        Some(Field::Wavelength) => tr!("wavelength"),
        Some(Field::PhiI) => tr!("φi, azimuth of incidence"),
        Some(Field::PhiR) => tr!("φr, azimuth of view"),
        Some(Field::Channel(channel)) => Field::Channel(channel).key().to_owned(),
        Some(Field::ChannelSigma(channel)) => tr!("standard deviation of {}", Field::Channel(channel).key()),
    }
}

fn unit_text(field: Field, unit: Unit) -> String {
    match (unit, field) {
        (Unit::Radians, _) => tr!("radians"),
        (Unit::Percent, _) => tr!("percent"),
        (Unit::Micrometers, _) => "µm".to_owned(),
        (Unit::Angstroms, _) => "Å".to_owned(),
        (Unit::Native, Field::Wavelength) => "nm".to_owned(),
        (Unit::Native, Field::ThetaI | Field::ThetaR | Field::Dphi | Field::PhiI | Field::PhiR) => tr!("degrees"),
        (Unit::Native, Field::Dolp | Field::DolpSigma) => tr!("fraction, 0 to 1"),
        (Unit::Native, _) => String::new(),
    }
}

/// Every column with its first cells, its meaning and its unit.
fn columns_ui(mapping: &mut Mapping, table: &TableSample, ui: &mut Ui) {
    let angles = [Field::ThetaI, Field::ThetaR].iter().all(|angle| mapping.find(*angle).is_some() || mapping.constant(*angle).is_some());
    let text = if angles && mapping.has_quantity() {
        tr!("The columns are taken as follows: change what is not so.")
    } else {
        tr!("Which column is what? Not all that is needed was found in the header.")
    };
    // Both texts take the same height.
    let lines = 2.0 * ui.text_style_height(&egui::TextStyle::Body) + 4.0;
    let height = ui.add(Label::new(text).wrap()).rect.height();
    ui.add_space((lines - height).max(0.0));
    ScrollArea::both().id_salt("columns").max_height(COLUMNS_HEIGHT).auto_shrink([false, true]).show(ui, |ui| {
        Grid::new("columns").num_columns(4).striped(true).spacing([12.0, 4.0]).show(ui, |ui| {
            for heading in [tr!("Column"), tr!("First rows"), tr!("Meaning"), tr!("Unit")] {
                ui.strong(heading);
            }
            ui.end_row();
            for (index, name) in table.header.iter().enumerate() {
                column_ui(mapping, table, index, name, ui);
                ui.end_row();
            }
        });
    });
    constants_ui(mapping, ui);
}

/// The angle of incidence that is offered where nothing is stated.
const OFFERED_THETA_I: f64 = 45.0;

/// Angles that no column holds.
fn constants_ui(mapping: &mut Mapping, ui: &mut Ui) {
    let is_free = |mapping: &Mapping, field| mapping.find(field).is_none();
    let (theta_i_is_free, dphi_is_free) = (is_free(mapping, Field::ThetaI), is_free(mapping, Field::Dphi));
    ui.horizontal(|ui| {
        ui.label(tr!("The same in every row:")).on_hover_text(tr!("For an angle that no column holds"));
        ui.add_enabled_ui(theta_i_is_free, |ui| {
            let mut is_constant = theta_i_is_free && mapping.theta_i.is_some();
            let tick = ui.checkbox(&mut is_constant, "θi").on_hover_text(tr!("The file was measured at a single angle of incidence"));
            if tick.changed() {
                mapping.theta_i = is_constant.then_some(OFFERED_THETA_I);
            }
            let mut degrees = mapping.theta_i.unwrap_or(OFFERED_THETA_I);
            let value = DragValue::new(&mut degrees).range(0.0..=89.9).speed(0.5).max_decimals(3).suffix("°");
            if ui.add_enabled(is_constant, value).labelled_by(tick.id).changed() {
                mapping.theta_i = Some(degrees);
            }
        });
        ui.add_space(12.0);
        ui.add_enabled_ui(dphi_is_free, |ui| {
            let label = ui.label("Δφ").on_hover_text(tr!("180° is the plane of incidence; other values lie outside of it"));
            let mut degrees = mapping.dphi.unwrap_or(180.0);
            let value = DragValue::new(&mut degrees).range(0.0..=360.0).speed(0.5).max_decimals(3).suffix("°");
            if ui.add(value).labelled_by(label.id).changed() {
                mapping.dphi = Some(degrees);
            }
        });
    });
}

fn column_ui(mapping: &mut Mapping, table: &TableSample, index: usize, name: &str, ui: &mut Ui) {
    let title = if name.is_empty() { tr!("column {}", index + 1) } else { name.to_owned() };
    let label = ui.label(&title);
    let cells: Vec<&str> = table.rows.iter().filter_map(|row| row.get(index)).map(String::as_str).collect();
    let cells: String = cells.join(" · ").chars().take(48).collect();
    ui.label(RichText::new(cells).weak());
    let number = ColumnChoice::Number(index + 1);
    let place = mapping.columns.iter().position(|column| column.column == number);
    let before = place.map(|place| mapping.columns[place].field);
    let mut chosen = before;
    let combo = ComboBox::from_id_salt(("meaning", index)).width(190.0).height(320.0).selected_text(field_text(before)).show_ui(ui, |ui| {
        for field in std::iter::once(None).chain(Field::all().map(Some)) {
            ui.selectable_value(&mut chosen, field, field_text(field));
        }
    });
    combo.response.labelled_by(label.id);
    if chosen != before {
        // A field is in one column, and a column is one field.
        mapping.columns.retain(|column| column.column != number && Some(column.field) != chosen);
        mapping.columns.extend(chosen.map(|field| MappedColumn { field, column: number, unit: Unit::Native }));
        return;
    }
    let Some(column) = place.map(|place| &mut mapping.columns[place]).filter(|column| !column.field.unit_names().is_empty()) else {
        return;
    };
    let field = column.field;
    let combo = ComboBox::from_id_salt(("unit", index)).selected_text(unit_text(field, column.unit)).show_ui(ui, |ui| {
        for &(_, unit) in field.unit_names() {
            ui.selectable_value(&mut column.unit, unit, unit_text(field, unit));
        }
    });
    combo.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, tr!("Unit of {}", title)));
}

/// The first rows of the measurement, or why there is none; returns whether there is one.
fn answer_ui(import: &ImportDialog, ui: &mut Ui) -> bool {
    let warning = theme::warning(ui.visuals().dark_mode);
    match import.preview.get() {
        None => return false,
        Some(Err(reason)) => {
            ui.add(Label::new(RichText::new(tr!("This cannot be opened yet: {}.", advised(reason, reason.hint()))).color(warning)).wrap());
            return false;
        }
        Some(Ok(imported)) => rows_ui(imported, import.file.preview_is_whole(), ui),
    }
    if let Some(reason) = &import.error {
        ui.add(Label::new(RichText::new(tr!("The file cannot be read so: {}.", advised(reason, reason.hint()))).color(warning)).wrap());
    }
    true
}

fn rows_ui(imported: &Imported, is_all: bool, ui: &mut Ui) {
    let rows = imported.measurements.iter().flat_map(|measurement| &measurement.rows);
    ui.weak(if is_all { tr!("The first of {} rows as they will be:", imported.rows()) } else { tr!("The first rows as they will be:") });
    Grid::new("answer").num_columns(5).spacing([18.0, 2.0]).show(ui, |ui| {
        for heading in ["θi", "θr", "Δφ", "DoLP", "BRDF / (1/sr)"] {
            ui.strong(heading);
        }
        ui.end_row();
        for row in rows.take(SHOWN) {
            let geometry = row.geometry;
            for angle in [geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0] {
                ui.monospace(format!("{}°", significant(angle)));
            }
            for quantity in [row.dolp, row.brdf] {
                ui.monospace(quantity.map_or_else(|| "—".to_owned(), |quantity| significant(quantity.value)));
            }
            ui.end_row();
        }
    });
    for note in &imported.notes {
        ui.add(Label::new(RichText::new(note.localized()).weak()).wrap());
    }
}
