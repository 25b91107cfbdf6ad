//! The part of the import dialog that shows a table: its first rows with what each is, the meanings of
//! the columns above them, and what is open.

use crate::app::plots::theme;
use egui::{Color32, ComboBox, DragValue, Grid, Label, RichText, Role, ScrollArea, TextWrapMode, Ui, WidgetInfo};
use pbrdf::measurement::foreign::{Doubt, PlannedColumn, RowKind, ShownRow, TableOptions};
use pbrdf::measurement::formats::{ImportOptions, TableSample};
use pbrdf::measurement::{BrdfMeaning, ColumnChoice, Field, MappedColumn, Mapping, Unit, is_not_measured};
use tr::tr;

/// Height of the rows that are shown, at most and at least, and what the rest of the dialog takes.
const TABLE_HEIGHT: f32 = 250.0;
const LEAST_HEIGHT: f32 = 170.0;
const REST_HEIGHT: f32 = 460.0;
/// Columns that are shown; a wider table is read whole all the same.
const SHOWN_COLUMNS: usize = 40;

/// What each field is called.
fn field_text(field: Option<Field>) -> String {
    match field {
        None => tr!("not used"),
        Some(Field::ThetaI) => tr!("θi, angle of incidence"),
        Some(Field::ThetaR) => tr!("θr, angle of view"),
        Some(Field::Dphi) => tr!("Δφ, relative azimuth"),
        Some(Field::Dolp) => "DoLP".to_owned(),
        Some(Field::DolpSigma) => tr!("standard deviation of DoLP"),
        Some(Field::Brdf) => "BRDF".to_owned(),
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
        (Unit::Native, Field::Brdf | Field::BrdfSigma) => "sr⁻¹".to_owned(),
        (Unit::Native, _) => String::new(),
    }
}

/// What a column is taken for: the user's choice, or what the guess says of a wide table.
fn meaning_text(chosen: Option<Field>, planned: &PlannedColumn) -> String {
    let place = [planned.theta_i.map(|angle| format!("θi = {angle}°")), planned.theta_r.map(|angle| format!("θr = {angle}°"))];
    let place = place.into_iter().flatten().chain(planned.wavelength_nm.map(|nm| format!("{nm} nm"))).next();
    match (chosen, planned.field, place) {
        (None, Some(field), Some(place)) => format!("{}, {place}", field_text(Some(field))),
        _ => field_text(chosen),
    }
}

/// The rows of the file with what each is, and the meaning of each column above it.
pub(super) fn columns_ui(options: &mut ImportOptions, table: &TableSample, is_read: bool, ui: &mut Ui) {
    let is_clear = table.table.doubts.is_empty();
    let text = if is_clear {
        tr!("The columns are taken as follows: change what is not so.")
    } else {
        tr!("Which column is what? Not all that is needed was found in the header.")
    };
    let dark = ui.visuals().dark_mode;
    let text = RichText::new(text);
    ui.add(Label::new(if is_clear { text } else { text.color(theme::warning(dark)) }).wrap());
    cells_ui(&mut options.table, table, ui);
    // Until the cells are read as they are asked for, what is shown are others.
    ui.add_enabled_ui(is_read, |ui| rows_and_answers_ui(options, table, ui));
}

fn rows_and_answers_ui(options: &mut ImportOptions, table: &TableSample, ui: &mut Ui) {
    let dark = ui.visuals().dark_mode;
    let Some(columns) = table.table.columns.first() else { return };
    let columns = &columns[..columns.len().min(SHOWN_COLUMNS)];
    // As high whatever is chosen: nothing jumps.
    let height = (ui.ctx().content_rect().height() - REST_HEIGHT).clamp(LEAST_HEIGHT, TABLE_HEIGHT);
    ScrollArea::both().id_salt("columns").max_height(height).auto_shrink([false; 2]).show(ui, |ui| {
        Grid::new("columns").num_columns(columns.len() + 1).spacing([12.0, 2.0]).show(ui, |ui| {
            ui.label("");
            for (index, planned) in columns.iter().enumerate() {
                ui.vertical(|ui| column_ui(&mut options.columns, planned, index, ui));
            }
            ui.end_row();
            for row in &table.shown {
                row_ui(row, columns.len(), dark, ui);
                ui.end_row();
            }
        });
    });
    legend_ui(dark, ui);
    answers_ui(&mut options.table, table, ui);
    constants_ui(&mut options.columns, ui);
}

/// Separators of thousands that are offered, with 1234 written so.
const THOUSANDS: [(Option<char>, &str); 5] =
    [(None, ""), (Some(','), "1,234"), (Some('.'), "1.234"), (Some('\''), "1'234"), (Some(' '), "1 234")];

/// Which sheet of a workbook is read, and how its numbers are written.
fn cells_ui(options: &mut TableOptions, table: &TableSample, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if table.sheets.len() > 1 {
            let label = ui.label(tr!("Sheet"));
            let shown = options.sheet.as_ref().or(table.sheet.as_ref()).cloned().unwrap_or_default();
            let combo = ComboBox::from_id_salt("sheet").selected_text(&shown).height(320.0).show_ui(ui, |ui| {
                for sheet in &table.sheets {
                    if ui.selectable_label(*sheet == shown, sheet).clicked() {
                        options.sheet = Some(sheet.clone());
                    }
                }
            });
            combo.response.labelled_by(label.id);
            ui.add_space(12.0);
        }
        let label = ui.label(tr!("Thousands")).on_hover_text(tr!("What stands between the thousands of a number"));
        let text = |separator: Option<char>, written: &str| if separator.is_none() { tr!("not separated") } else { written.to_owned() };
        let shown = THOUSANDS.iter().find(|(separator, _)| *separator == options.thousands);
        let shown = shown.map_or_else(|| format!("{:?}", options.thousands), |&(separator, written)| text(separator, written));
        let combo = ComboBox::from_id_salt("thousands").selected_text(shown).show_ui(ui, |ui| {
            for (separator, written) in THOUSANDS {
                ui.selectable_value(&mut options.thousands, separator, text(separator, written));
            }
        });
        combo.response.labelled_by(label.id);
    });
}

/// The colour and the name of a kind of rows.
fn kind_style(kind: RowKind, dark: bool) -> (Color32, String) {
    match kind {
        RowKind::Blank => (theme::muted(dark), String::new()),
        RowKind::Remark => (theme::muted(dark), tr!("remark")),
        RowKind::Title => (theme::series(2, dark), tr!("title")),
        RowKind::Header => (theme::series(0, dark), tr!("header")),
        RowKind::Units => (theme::series(1, dark), tr!("units")),
        RowKind::Data => (theme::foreground(dark), tr!("data")),
        RowKind::Skipped => (theme::warning(dark), tr!("skipped")),
    }
}

/// A row of the file in the colour of its kind; cells without a value stand out.
fn row_ui(row: &ShownRow, columns: usize, dark: bool, ui: &mut Ui) {
    let (color, name) = kind_style(row.kind, dark);
    ui.label(RichText::new(row.line.to_string()).weak()).on_hover_text(name);
    for index in 0..columns {
        let cell = row.cells.get(index).map(String::as_str).unwrap_or_default();
        // A line of words may have more cells than the table has columns.
        let rest = if row.kind == RowKind::Title && index + 1 == columns {
            row.cells[index.min(row.cells.len())..].join(" ")
        } else {
            String::new()
        };
        let cell = if rest.is_empty() { cell } else { &rest };
        let is_missing = row.kind == RowKind::Data && is_not_measured(cell);
        let text = if is_missing && cell.is_empty() { "·" } else { cell };
        let text: String = text.chars().take(24).collect();
        let text = RichText::new(text).monospace().color(if is_missing { theme::warning(dark) } else { color });
        ui.label(if row.kind == RowKind::Skipped { text.strikethrough() } else { text });
    }
}

/// What the colours say.
fn legend_ui(dark: bool, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        for kind in [RowKind::Remark, RowKind::Title, RowKind::Header, RowKind::Units, RowKind::Data, RowKind::Skipped] {
            let (color, name) = kind_style(kind, dark);
            ui.label(RichText::new(format!("■ {name}")).color(color).small());
        }
        ui.label(RichText::new(format!("■ {}", tr!("not measured: masked"))).color(theme::warning(dark)).small());
    });
}

/// Answers to what the guess leaves open, and what turns the table as a whole.
fn answers_ui(options: &mut TableOptions, table: &TableSample, ui: &mut Ui) {
    let doubts = &table.table.doubts;
    ui.horizontal_wrapped(|ui| {
        if doubts.iter().any(|doubt| matches!(doubt, Doubt::WideQuantity { .. })) {
            let label = ui.label(tr!("The columns hold"));
            let text = |wide: Option<Field>| wide.map_or_else(|| tr!("choose"), |field| field_text(Some(field)));
            let combo = ComboBox::from_id_salt("wide").selected_text(text(options.wide)).show_ui(ui, |ui| {
                for field in [Field::Dolp, Field::Brdf] {
                    ui.selectable_value(&mut options.wide, Some(field), text(Some(field)));
                }
            });
            combo.response.labelled_by(label.id);
        }
        let has_brdf =
            table.table.columns.iter().flatten().any(|column| column.field == Some(Field::Brdf)) || options.wide == Some(Field::Brdf);
        if has_brdf || doubts.iter().any(|doubt| matches!(doubt, Doubt::BrdfMeaning { .. })) {
            let label = ui.label(tr!("BRDF is"));
            let combo = ComboBox::from_id_salt("brdf is").selected_text(brdf_text(options.brdf_is)).show_ui(ui, |ui| {
                for meaning in BrdfMeaning::ALL.map(|(_, meaning)| Some(meaning)) {
                    ui.selectable_value(&mut options.brdf_is, meaning, brdf_text(meaning));
                }
            });
            combo.response.labelled_by(label.id);
        }
        ui.checkbox(&mut options.flip, tr!("Turn the sign of θr"))
            .on_hover_text(tr!("For files in which a negative θr is the forward side"));
        if table.table.columns.iter().flatten().any(|column| matches!(column.field, Some(Field::Channel(_)))) {
            ui.checkbox(&mut options.normalised, tr!("Divided by the first"))
                .on_hover_text(tr!("Stokes parameters or Mueller elements relative to the first one"));
        }
    });
}

fn brdf_text(meaning: Option<BrdfMeaning>) -> String {
    match meaning {
        None => tr!("as the header says"),
        Some(BrdfMeaning::Brdf) => tr!("BRDF in sr⁻¹"),
        Some(BrdfMeaning::BrdfCos) => tr!("BRDF times cos θr"),
        Some(BrdfMeaning::Factor) => tr!("reflectance factor, π times the BRDF"),
    }
}

/// The angle of incidence that is offered where nothing is stated.
pub(super) const OFFERED_THETA_I: f64 = 45.0;

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
            let label = ui
                .label("Δφ")
                .on_hover_text(tr!("180° (forward) and 0° (backward) lie in the plane of incidence; other values outside of it"));
            let mut degrees = mapping.dphi.unwrap_or(180.0);
            let value = DragValue::new(&mut degrees).range(0.0..=360.0).speed(0.5).max_decimals(3).suffix("°");
            if ui.add(value).labelled_by(label.id).changed() {
                mapping.dphi = Some(degrees);
            }
        });
    });
}

/// Name, meaning and unit of a column.
fn column_ui(mapping: &mut Mapping, planned: &PlannedColumn, index: usize, ui: &mut Ui) {
    let name = &planned.name;
    let title = if name.is_empty() { tr!("column {}", index + 1) } else { name.to_owned() };
    let label = ui.strong(&title);
    let number = ColumnChoice::Number(index + 1);
    let place = mapping.columns.iter().position(|column| column.column == number);
    let before = place.map(|place| mapping.columns[place].field);
    let mut chosen = before;
    let combo = ComboBox::from_id_salt(("meaning", index))
        .width(120.0)
        .height(320.0)
        .wrap_mode(TextWrapMode::Extend)
        .selected_text(meaning_text(before, planned))
        .show_ui(ui, |ui| {
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
