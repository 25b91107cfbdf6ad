//! The dialog that asks the questions of a foreign file, with the first rows of the measurement.

use crate::app::plots::theme;
use crate::app::shell::app::App;
use crate::app::shell::dialogs::Dialogs;
use crate::app::shell::import_dialog::{AlikeFiles, ImportDialog, Slices};
use crate::app::shell::import_picture_ui::becomes_ui;
use crate::app::shell::import_table_ui::{OFFERED_THETA_I, columns_ui};
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::text::messages::advised;
use crate::app::text::numbers::{short, significant};
use crate::app::views::action::Action;
use crate::app::work::design::AngleRange;
use crate::app::work::import_memory::sample_of;
use egui::{ComboBox, DragValue, Grid, Label, RichText, Role, ScrollArea, Slider, SliderClamping, Ui, WidgetInfo};
use pbrdf::measurement::Quantity;
use pbrdf::measurement::formats::{ImportOptions, Imported, Question};
use std::path::PathBuf;
use tr::tr;

/// Width of the dialog, and heights of its scroll areas: place and size of the dialog don't depend
/// on the options.
const WIDTH: f32 = 860.0;
const ANSWER_HEIGHT: f32 = 176.0;
/// In a window lower than this the answer leaves room to the table that the questions are about.
const LOW: f32 = 600.0;
const LOW_ANSWER_HEIGHT: f32 = 112.0;
/// Rows of the measurement that are shown.
const SHOWN: usize = 5;
/// With more wavelengths there is a slider in place of a list.
const LISTED: usize = 12;

pub fn import_ui(app: &mut App, ui: &mut Ui) {
    let App { dialogs: Dialogs { import: Some(import), .. }, jobs, actions, .. } = app else { return };
    let response = egui::Modal::new(egui::Id::unique("import")).show(ui.ctx(), |ui| {
        ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 40.0));
        ui.heading(tr!("Import {}", import.origin.name));
        recalled_ui(import, ui);
        questions_ui(import, ui);
        ui.separator();
        let height = if ui.ctx().content_rect().height() < LOW { LOW_ANSWER_HEIGHT } else { ANSWER_HEIGHT };
        let answer = ScrollArea::vertical().id_salt("answer").min_scrolled_height(height).max_height(height);
        let is_sound = answer.auto_shrink([false; 2]).show(ui, |ui| answer_ui(import, ui)).inner;
        alike_ui(&mut import.alike, ui);
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

/// That the answers are those of an earlier table, and the way back.
fn recalled_ui(import: &mut ImportDialog, ui: &mut Ui) {
    if import.recalled.is_none() {
        return;
    }
    ui.horizontal(|ui| {
        let color = theme::warning(ui.visuals().dark_mode);
        ui.colored_label(color, tr!("Read as you read a table of this shape before."));
        if ui.small_button(tr!("Back to the guess")).clicked() {
            import.forget_recalled();
        }
    });
}

/// Whether other files are opened with the same answers.
fn alike_ui(alike: &mut AlikeFiles, ui: &mut Ui) {
    const NAMED: usize = 12;
    let paths = alike.paths();
    // The line is there in any case: nothing jumps when files are found.
    if paths.is_empty() {
        ui.label("");
        return;
    }
    let text = if alike.opened.is_empty() {
        tr!("also apply to the other file of this folder" | "also apply to the other {n} files of this folder" % paths.len())
    } else {
        tr!("also apply to the other file opened with it" | "also apply to the other {n} files opened with it" % paths.len())
    };
    let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut names: Vec<String> = paths.iter().take(NAMED).map(name).collect();
    names.extend((paths.len() > NAMED).then(|| "…".to_owned()));
    let help = tr!("They have the same columns: {}", names.join(", "));
    ui.checkbox(&mut alike.are_meant, text).on_hover_text(help);
}

/// The questions of the file, each in its widgets.
fn questions_ui(import: &mut ImportDialog, ui: &mut Ui) {
    let is_read = import.is_read();
    let ImportDialog { file, questions, options, slices, .. } = import;
    if !file.summary().is_empty() {
        ui.label(translated(file.summary()));
    }
    for question in &*questions {
        match question {
            Question::Wavelength { available_nm } => wavelength_ui(options, available_nm, ui),
            Question::ThetaI => theta_i_ui(options, ui),
            Question::Directions => slices_ui(slices, options, ui),
            Question::Columns(sample) => columns_ui(options, sample, is_read, ui),
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
        let label =
            ui.label("Δφ").on_hover_text(tr!("180° (forward) and 0° (backward) lie in the plane of incidence; other values outside of it"));
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

/// The first rows of the measurement, or why there is none; returns whether there is one.
fn answer_ui(import: &ImportDialog, ui: &mut Ui) -> bool {
    let warning = theme::warning(ui.visuals().dark_mode);
    if let Some(reason) = import.error.as_ref().filter(|_| !import.is_read()) {
        ui.add(Label::new(RichText::new(tr!("This cannot be opened yet: {}.", advised(reason, reason.hint()))).color(warning)).wrap());
        return false;
    }
    if !import.is_read() {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label(tr!("Reading…"));
        });
        return false;
    }
    match import.preview.get() {
        None => return false,
        Some(Err(reason)) => {
            ui.add(Label::new(RichText::new(tr!("This cannot be opened yet: {}.", advised(reason, reason.hint()))).color(warning)).wrap());
            return false;
        }
        Some(Ok(imported)) => {
            if let Some(table) = sample_of(&import.questions) {
                becomes_ui(table, imported, ui);
            }
            rows_ui(imported, import.file.preview_is_whole(), ui);
        }
    }
    if let Some(reason) = &import.error {
        ui.add(Label::new(RichText::new(tr!("The file cannot be read so: {}.", advised(reason, reason.hint()))).color(warning)).wrap());
    }
    true
}

fn rows_ui(imported: &Imported, is_all: bool, ui: &mut Ui) {
    let rows = imported.measurements.iter().flat_map(|measurement| &measurement.rows);
    ui.weak(if is_all {
        tr!("The one row as it will be:" | "The first of {n} rows as they will be:" % imported.rows())
    } else {
        tr!("The first rows as they will be:")
    });
    Grid::new("answer").num_columns(5).spacing([18.0, 2.0]).show(ui, |ui| {
        for heading in ["θi", "θr", "Δφ", "DoLP", "BRDF / sr⁻¹"] {
            ui.strong(heading);
        }
        ui.end_row();
        for row in rows.take(SHOWN) {
            let geometry = row.geometry;
            for angle in [geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0] {
                ui.monospace(format!("{}°", significant(angle)));
            }
            for quantity in [row.dolp, row.brdf] {
                let sigma = |quantity: Quantity| quantity.sigma.map_or_else(String::new, |sigma| format!(" ± {}", significant(sigma)));
                ui.monospace(quantity.map_or_else(|| "—".to_owned(), |quantity| significant(quantity.value) + &sigma(quantity)));
            }
            ui.end_row();
        }
    });
    for note in &imported.notes {
        ui.add(Label::new(RichText::new(note.localized()).weak()).wrap());
    }
}
