//! The strip under DoLP: model less measurement, so that a misfit too small for the curves shows.

use super::axis::{self, axis, decimal};
use super::{Range, plot};
use crate::app::theme;
use crate::app::window::Explorer;
use egui::Ui;
use egui_plot::{AxisHints, HLine, HoverPosition, PlotPoints, Points};

pub fn residuals_ui(explorer: &mut Explorer, ui: &mut Ui, height: f32) {
    let Explorer { derived, view, .. } = explorer;
    let dark = ui.visuals().dark_mode;
    let axes = &mut view.residuals;
    let derived = &*derived;
    let Some(range) = derived.residual_range else { return };
    let air = Range { low: 1.08 * range.low, high: 1.08 * range.high };
    let x = axis(AxisHints::new_x(), ui, "", decimal);
    let y = axis(AxisHints::new_y(), ui, "model − meas.", decimal);
    let response = plot("residuals", ui, height, x, y)
        .y_grid_spacer(|input| axis::marks(&input, 3.0, 0.0))
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                Some(format!("{plot_name}\nθr = {:.2}°\nresidual = {:.2e}", position.x, position.y))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            axes.apply(plot, derived.x, Some(air));
            plot.hline(HLine::new("", 0.0).color(theme::muted(dark)).width(1.0));
            for (i, (residuals, marks)) in derived.residuals.iter().zip(&derived.marks).enumerate() {
                if !residuals.is_empty() {
                    plot.points(Points::new(marks.name.clone(), PlotPoints::Borrowed(residuals)).color(theme::series(i, dark)).radius(2.5));
                }
            }
        });
    axes.listen(&response, ui);
}
