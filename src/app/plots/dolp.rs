//! DoLP against θr: the model at every measured θi in its own colour, the points, and the Fresnel limit.

use super::axis::{self, axis, decimal};
use super::error_bars::ErrorBars;
use super::{curve, legend, plot};
use crate::app::derived::Marks;
use crate::app::theme;
use crate::app::window::Explorer;
use egui::{Color32, Ui};
use egui_plot::{AxisHints, HoverPosition, LineStyle, MarkerShape, PlotPoints, PlotUi, Points};

pub fn dolp_ui(explorer: &mut Explorer, ui: &mut Ui, height: f32) {
    let Explorer { derived, settings, view, .. } = explorer;
    let dark = ui.visuals().dark_mode;
    let axes = &mut view.dolp;
    let derived = &*derived;
    let own_name = format!("θi = {}° (slider)", settings.theta_i);
    let dashed = Some(LineStyle::dashed_dense());
    let x = axis(AxisHints::new_x(), ui, "θr / °", decimal).min_thickness(40.0);
    let y = axis(AxisHints::new_y(), ui, "DoLP", decimal);
    let response = plot("dolp", ui, height, x, y)
        .y_grid_spacer(|input| axis::marks(&input, 5.0, 0.0))
        .legend(legend())
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                Some(format!("{plot_name}\nθr = {:.2}°\nDoLP = {:.5}", position.x, position.y))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            axes.apply(plot, derived.x, derived.dolp_range);
            if settings.show_limit {
                for (i, curves) in derived.series.iter().enumerate() {
                    curve(plot, &curves.limit, "Fresnel limit", theme::series(i, dark), dashed, 1.0);
                }
                if derived.own_is_series.is_none() {
                    curve(plot, &derived.own.limit, "Fresnel limit", theme::foreground(dark), dashed, 1.0);
                }
            }
            for (i, pieces) in derived.ghost.iter().enumerate() {
                curve(plot, pieces, "last fit", theme::series(i, dark).gamma_multiply(0.4), Some(LineStyle::dotted_dense()), 1.5);
            }
            for (i, (curves, marks)) in derived.series.iter().zip(&derived.marks).enumerate() {
                let color = theme::series(i, dark);
                curve(plot, &curves.dolp, &marks.name, color, None, 2.0);
                marks_in(plot, &marks.dolp, &marks.name, color, dark);
            }
            if derived.own_is_series.is_none() {
                curve(plot, &derived.own.dolp, &own_name, theme::foreground(dark), None, 2.0);
            }
        });
    axes.listen(&response, ui);
}

/// Points with their error bars, masked ones hollow and grey.
pub fn marks_in<'a>(plot: &mut PlotUi<'a>, marks: &'a Marks, name: &str, color: Color32, dark: bool) {
    if !marks.bars.is_empty() {
        plot.add(ErrorBars::new(name.to_owned(), &marks.bars, color));
    }
    if !marks.used.is_empty() {
        plot.points(Points::new(name.to_owned(), PlotPoints::Borrowed(&marks.used)).color(color).radius(3.0));
    }
    if !marks.masked.is_empty() {
        let points = Points::new("masked", PlotPoints::Borrowed(&marks.masked)).color(theme::muted(dark)).radius(3.0);
        plot.points(points.shape(MarkerShape::Circle).filled(false));
    }
}
