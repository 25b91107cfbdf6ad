//! What menus, keys and the palette do with the open measurements.

use crate::app::shell::app::App;
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::{MeasurementStyle, OpenMeasurement};

/// Shows the measurement so many places down the list, around its ends.
pub fn step(app: &mut App, by: isize) {
    let list = app.work.measurements();
    let numbers: Vec<u64> = list.iter().map(|open| open.number).collect();
    let at = list.active_index().cast_signed() + by;
    let number = numbers[at.rem_euclid(numbers.len().cast_signed()).cast_unsigned()];
    app.work.apply(Edit::Activate(number));
}

/// Draws all measurements, or the active one alone.
pub fn show_all(app: &mut App, shown: bool) {
    let style = |open: &OpenMeasurement| Edit::SetMeasurementStyle { number: open.number, style: MeasurementStyle { shown, ..open.style } };
    let edits: Vec<Edit> = app.work.measurements().iter().map(style).collect();
    edits.into_iter().for_each(|edit| app.work.apply(edit));
}

/// Closes a measurement, or the active one.
pub fn close(app: &mut App, number: Option<u64>) {
    let number = number.unwrap_or(app.work.active().number);
    app.work.apply(Edit::Close(number));
}
