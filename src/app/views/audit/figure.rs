//! The reflectance of the audit for print.

use crate::app::plots::print::{FOREGROUND, MUTED, over, points};
use crate::app::shell::app::App;
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Figure, Panel, Rgb, SERIES, Series};

const WARNING: Rgb = Rgb(190, 30, 30);

pub fn audit_figure(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { document, .. }, views, .. } = explorer;
    let view = &views.audit;
    let curves = view.curves.get()?;
    let mut series = vec![Series::level("", 1.0).colored(MUTED)];
    let terms = [("specular", &curves.specular, 3), ("diffuse", &curves.diffuse, 4), ("volume", &curves.volume, 5)];
    for (name, pieces, color) in terms.into_iter().filter(|(_, pieces, _)| !pieces.is_empty()) {
        series.push(Series::line(name, points(pieces, |y| y)).colored(SERIES[color]));
    }
    series.push(Series::line("total", points(&curves.total, |y| y)).colored(FOREGROUND));
    if !curves.above.is_empty() {
        series.push(Series::line("above 1", points(&curves.above, |y| y)).colored(WARNING));
    }
    let x = Axis::linear("θi", "°").between(0.0, 90.0);
    let y = over(Axis::linear("directional-hemispherical reflectance", ""), view.range.get());
    let panel = Panel { x, y, series, ..Panel::default() };
    Some(Figure { title: document.name.clone(), panels: vec![panel], ..Figure::default() })
}
