//! The way of the last fit: ΔE after each improvement of the winning start, against evaluations or time.

mod figure;

pub use figure::convergence_figure;

use crate::app::jobs::memo::Memo;
use crate::app::plots::axis;
use crate::app::plots::axis::{axis, decimal, logarithmic};
use crate::app::plots::{Axes, Range, curve, plot};
use crate::app::shell::app::App;
use crate::app::shell::theme;
use crate::app::text::messages::Localized as _;
use crate::app::views::curves::{Polyline, pieces};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::workspace::Workspace;
use egui::Ui;
use egui_plot::{AxisHints, HoverPosition, PlotPoints, Points};
use pbrdf::fit::TracePoint;
use std::sync::Arc;
use tr::tr;

/// What the pane keeps.
#[derive(Default)]
pub struct ConvergenceView {
    way: Memo<Key, Way>,
    axes: Axes,
}

/// The fit that is drawn, by identity, and whether it is drawn against time.
#[derive(Default)]
struct Key(Option<Arc<FitEntry>>, bool);

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.1 == other.1
            && match (&self.0, &other.0) {
                (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                (a, b) => a.is_none() && b.is_none(),
            }
    }
}

/// ΔE along the way, as its decimal logarithm.
#[derive(Default)]
struct Way {
    steps: Polyline,
    points: Polyline,
    x: Option<Range>,
    y: Option<Range>,
}

/// Room around the drawing, as a fraction of it.
const AIR: f64 = 0.05;

impl Way {
    #[expect(clippy::cast_precision_loss, reason = "a number of evaluations")]
    fn new(trace: &[TracePoint], by_time: bool) -> Self {
        let x = |point: &TracePoint| if by_time { point.elapsed_ms } else { point.evaluations as f64 };
        let y = |point: &TracePoint| Some(libm::log10(point.objective));
        // ΔE stays as it is until the next improvement: steps, not slopes. Each edge is a piece of its own, since the corners of one
        // long line are drawn as filled wedges.
        let edges = |pair: &[TracePoint]| {
            let ((from, high), (to, low)) = ((x(&pair[0]), y(&pair[0])), (x(&pair[1]), y(&pair[1])));
            [(from, high), (to, high), (to, None), (to, high), (to, low), (to, None)]
        };
        let steps = pieces(trace.windows(2).flat_map(edges));
        let points = pieces(trace.iter().map(|point| (x(point), y(point))));
        let mut heights = points.iter().flatten().map(|point| point.y);
        let first = heights.next();
        let (low, high) = heights.fold((first.unwrap_or(0.0), first.unwrap_or(0.0)), |(low, high), y| (low.min(y), high.max(y)));
        let end = trace.last().map_or(1.0, x);
        let air = if end > 0.0 { AIR * end } else { 1.0 };
        Self {
            steps,
            points,
            x: Some(Range { low: -air, high: end + air }),
            y: Some(Range { low: low - AIR * (high - low) - 0.01, high: high + AIR * (high - low) + 0.01 }),
        }
    }
}

pub fn convergence_refresh(explorer: &mut App) {
    let App { work: Workspace { shown_fit: last_fit, settings, .. }, views, .. } = explorer;
    views.convergence.way.refresh(Key(last_fit.clone(), settings.shown.convergence_by_time), |Key(fit, by_time)| {
        fit.as_ref().map_or_else(Way::default, |fit| Way::new(&fit.report.trace, *by_time))
    });
}

/// What is drawn in the pane.
pub fn convergence_options_ui(explorer: &mut App, ui: &mut Ui) {
    let by_time = &mut explorer.work.settings.shown.convergence_by_time;
    ui.radio_value(by_time, false, tr!("Against evaluations"))
        .on_hover_text(tr!("Evaluations of the residuals, the same on every machine"));
    ui.radio_value(by_time, true, tr!("Against time")).on_hover_text(tr!("Milliseconds since the fit began, all its starts included"));
}

pub fn convergence_ui(explorer: &mut App, ui: &mut Ui) {
    let App { work: Workspace { shown_fit: last_fit, settings, .. }, views, .. } = explorer;
    let view = &mut views.convergence;
    let (Some(fit), Some(way)) = (last_fit, view.way.get()) else {
        ui.label(tr!("There is no fit yet: press Fit, and its way down is drawn here."));
        return;
    };
    if fit.report.minima.is_empty() {
        ui.label(tr!("How this fit came about is not known: its session was saved by an older version."));
        return;
    }
    if way.points.is_empty() {
        ui.label(tr!("The fit made no step: ΔE of its start was the best."));
        return;
    }
    let report = &fit.report;
    ui.weak(tr!(
        "Winning start of {0}; {1}",
        report.minima.iter().map(|minimum| minimum.reached).sum::<usize>(),
        report.stop_reason.localized()
    ));
    let dark = ui.visuals().dark_mode;
    let title = if settings.shown.convergence_by_time { tr!("time / ms") } else { tr!("residual evaluations") };
    let x = axis(AxisHints::new_x(), ui, &title, decimal).min_thickness(40.0);
    let y = axis(AxisHints::new_y(), ui, "ΔE", logarithmic);
    let response = plot("convergence", ui, ui.available_height(), x, y)
        .y_grid_spacer(|input| axis::decades(&input, 5.0))
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { position, .. } => {
                Some(format!("{title}: {}\nΔE = {:.6e}", decimal(position.x, 0.1), libm::exp10(position.y)))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            view.axes.apply(plot, way.x, way.y);
            curve(plot, &way.steps, "", theme::series(0, dark), None, 1.5);
            for piece in &way.points {
                plot.points(Points::new("ΔE", PlotPoints::Borrowed(piece)).color(theme::series(0, dark)).radius(3.0));
            }
        });
    view.axes.listen(&response, &tr!("Plot: ΔE of the last fit against {}", title), ui);
}

#[cfg(test)]
mod tests {
    use super::{TracePoint, Way};

    #[test]
    fn a_fit_that_reaches_zero_ends_where_a_logarithm_still_exists() {
        let point = |evaluations, objective| TracePoint { elapsed_ms: 0.0, evaluations, objective };
        let way = Way::new(&[point(1, 1e-2), point(2, 1e-9), point(3, 0.0)], false);
        assert_eq!(way.points.iter().map(Vec::len).sum::<usize>(), 2);
        let y = way.y.expect("a range");
        assert!(y.low < -9.0 && y.high > -2.0);
    }
}
