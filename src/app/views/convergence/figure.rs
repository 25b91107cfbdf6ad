//! The way of the last fit for print.

use crate::app::shell::app::App;
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Figure, Panel, SERIES, Series};

#[expect(clippy::cast_precision_loss, reason = "a number of evaluations")]
pub fn convergence_figure(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { shown_fit: last_fit, settings, document, .. }, .. } = explorer;
    let trace = &last_fit.as_ref()?.report.trace;
    let by_time = settings.shown.convergence_by_time;
    let points: Vec<[f64; 2]> =
        trace.iter().map(|point| [if by_time { point.elapsed_ms } else { point.evaluations as f64 }, point.objective]).collect();
    let series = vec![Series::steps("ΔE", points.clone()).colored(SERIES[0]), Series::points("ΔE", points).colored(SERIES[0])];
    let x = if by_time { Axis::linear("time", "ms") } else { Axis::linear("residual evaluations", "") };
    let panel = Panel { x, y: Axis::log("ΔE", ""), series, legend: false, ..Panel::default() };
    Some(Figure { title: document.name.clone(), panels: vec![panel], ..Figure::default() })
}
