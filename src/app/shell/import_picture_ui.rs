//! What becomes of a table that is no list of rows: a small picture and a sentence.

use crate::app::plots::theme;
use egui::{Color32, Painter, Pos2, Rect, Sense, Ui, vec2};
use pbrdf::measurement::Field;
use pbrdf::measurement::foreign::RowKind;
use pbrdf::measurement::formats::{Imported, TableSample};
use tr::tr;

/// How a table is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TableForm {
    /// A column for each angle or wavelength.
    Wide { columns: usize },
    /// Tables under each other.
    Blocks,
    /// Rows that a column tells apart.
    Long,
}

impl TableForm {
    /// None of a plain list of rows that is one measurement.
    fn of(table: &TableSample, measurements: usize) -> Option<Self> {
        let measured = |columns: &[pbrdf::measurement::foreign::PlannedColumn]| {
            columns.iter().filter(|column| matches!(column.field, Some(Field::Dolp | Field::Brdf))).count()
        };
        let columns = table.table.columns.first().map_or(0, |columns| measured(columns));
        let kinds = || table.shown.iter().map(|row| row.kind);
        let begins_anew = kinds().skip_while(|kind| *kind != RowKind::Data).any(|kind| matches!(kind, RowKind::Title | RowKind::Header));
        match () {
            () if columns > 2 => Some(Self::Wide { columns }),
            () if begins_anew => Some(Self::Blocks),
            () if measurements > 1 => Some(Self::Long),
            () => None,
        }
    }
}

/// Names of measurements that are told.
const NAMED: usize = 6;

/// The picture and the sentence, where there is something to explain.
pub(super) fn becomes_ui(table: &TableSample, imported: &Imported, ui: &mut Ui) {
    let count = imported.measurements.len();
    let Some(form) = TableForm::of(table, count) else { return };
    let mut text = match form {
        TableForm::Wide { columns } => tr!("Each of the {} columns becomes rows.", columns),
        TableForm::Blocks => tr!("The tables under each other become rows of one list."),
        TableForm::Long => String::new(),
    };
    if count > 1 {
        let mut names: Vec<&str> = imported.measurements.iter().take(NAMED).map(|measurement| &*measurement.name).collect();
        names.extend((count > NAMED).then_some("…"));
        let sentence = tr!("It holds {0} measurements: {1}.", count, names.join(", "));
        text = if text.is_empty() { sentence } else { format!("{text} {sentence}") };
    }
    ui.horizontal(|ui| {
        picture_ui(form, count > 1, ui);
        ui.label(text);
    });
}

/// Size of the picture, and of a cell of a table in it, in points.
const SIZE: egui::Vec2 = vec2(92.0, 34.0);
const CELL: egui::Vec2 = vec2(8.0, 3.5);
/// Parts that are told apart by their colours.
const PARTS: usize = 3;

/// The table on the left, what it becomes on the right.
fn picture_ui(form: TableForm, is_several: bool, ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(SIZE, Sense::hover());
    let (painter, dark) = (ui.painter(), ui.visuals().dark_mode);
    let (plain, ink) = (theme::muted(dark), |part: usize| theme::series(part, dark));
    let at = |x: f32, y: f32| rect.min + vec2(x, y);
    let cell = |painter: &Painter, place: Pos2, color: Color32| {
        painter.rect_filled(Rect::from_min_size(place, CELL - vec2(1.0, 1.0)), 0.5, color);
    };
    for part in 0..PARTS {
        #[expect(clippy::cast_precision_loss, reason = "one of three")]
        let i = part as f32;
        match form {
            TableForm::Wide { .. } => {
                for row in [1.0, 2.0, 3.0] {
                    cell(painter, at(0.0, 6.0 + row * CELL.y), plain);
                    cell(painter, at((i + 1.0) * CELL.x, 6.0 + row * CELL.y), ink(part));
                }
                cell(painter, at((i + 1.0) * CELL.x, 6.0), ink(part).gamma_multiply(0.5));
            }
            TableForm::Blocks => {
                cell(painter, at(0.0, i * 11.5), ink(part).gamma_multiply(0.5));
                for row in [1.0, 2.0] {
                    cell(painter, at(0.0, i * 11.5 + row * CELL.y), plain);
                    cell(painter, at(CELL.x, i * 11.5 + row * CELL.y), ink(part));
                }
            }
            TableForm::Long => {
                for row in [0.0, 1.0] {
                    let y = 6.0 + (2.0 * i + row) * CELL.y;
                    cell(painter, at(0.0, y), ink(part).gamma_multiply(0.5));
                    cell(painter, at(CELL.x, y), plain);
                    cell(painter, at(2.0 * CELL.x, y), ink(part));
                }
            }
        }
        // Lists of rows: one of all, or one for each measurement.
        for row in [0.0, 1.0] {
            let (x, y) = if is_several { (56.0 + i * 12.0, 10.0 + row * CELL.y) } else { (64.0, 6.0 + (2.0 * i + row) * CELL.y) };
            let columns: &[f32] = if is_several { &[0.0] } else { &[0.0, CELL.x, 2.0 * CELL.x] };
            for (place, column) in columns.iter().enumerate() {
                cell(painter, at(x + column, y), if place + 1 == columns.len() { ink(part) } else { plain });
            }
        }
    }
    painter.arrow(at(38.0, SIZE.y / 2.0), vec2(12.0, 0.0), egui::Stroke::new(1.5, plain));
}
