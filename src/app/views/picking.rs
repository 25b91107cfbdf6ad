//! Clicks on measured points.

use crate::app::platform;
use crate::app::text::i18n::translated;
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::{DataPoint, IncidenceSeries, OpenMeasurement};
use egui::Ui;
use egui_plot::{PlotPoint, PlotResponse};

/// Largest distance from a point, in points of the screen, at which a click still means it.
const NEAR: f32 = 12.0;

/// What hovering a point says of it.
const MASK_HINT: &str = "Ctrl+click: mask or unmask · with Shift: the whole series";

/// The same in the language of the window; nothing where nothing is measured, nor for fingers, which have no keys beside them.
pub fn mask_hint(document: &OpenMeasurement) -> String {
    if document.measurement.rows.is_empty() || platform::has_fingers() { String::new() } else { format!("\n{}", translated(MASK_HINT)) }
}

/// Ctrl+click on a measured point masks it or takes it back; with Shift its whole series. `marks`
/// gives the points that are drawn of a series, by its place in the measurement, and `coordinate` their height in the
/// plot.
pub fn clicked_mask(
    response: &PlotResponse<()>,
    ui: &Ui,
    document: &OpenMeasurement,
    marks: impl Fn(usize, &IncidenceSeries) -> &[DataPoint],
    coordinate: impl Fn(&DataPoint) -> Option<f64>,
) -> Option<Edit> {
    let modifiers = ui.input(|input| input.modifiers);
    let at = response.response.interact_pointer_pos().filter(|_| response.response.clicked() && modifiers.command)?;
    let distance = |mark: &DataPoint| {
        let point = PlotPoint::new(mark.theta_r, coordinate(mark)?);
        Some(response.transform.position_from_point(&point).distance(at))
    };
    let series = document.drawn().iter().map(|&index| (index, &document.series[index]));
    let near = series.flat_map(|(index, series)| marks(index, series).iter().map(move |mark| (series, mark)));
    let near = near.filter_map(|(series, mark)| Some((series, mark, distance(mark)?))).filter(|(.., distance)| *distance < NEAR);
    let (series, mark, _) = near.min_by(|a, b| a.2.total_cmp(&b.2))?;
    let rows = if modifiers.shift { series.rows.clone() } else { vec![mark.row] };
    Some(Edit::Mask { rows, masked: !mark.masked })
}
