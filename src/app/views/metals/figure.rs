//! n and k of a metal against the wavelength for print.

use crate::app::plots::print::{FOREGROUND, MUTED, over, points};
use crate::app::shell::app::App;
use crate::app::views::metals::{PARTS, chosen};
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Figure, Panel, SERIES, Series};

pub fn metals_figure(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { settings, .. }, views, .. } = explorer;
    let view = &views.metals;
    let metal = chosen(&settings.tabulated)?;
    let lines = view.lines.get()?;
    let panels = PARTS.into_iter().enumerate().map(|(part, (parameter, _))| {
        let sources = metal.sources.iter().zip(lines).zip(SERIES.into_iter().cycle());
        let mut series: Vec<Series> =
            sources.map(|((source, line), color)| Series::line(&source.name, points(&line[part], |y| y)).colored(color)).collect();
        series.push(Series::level("slider", settings.parameters[parameter]).colored(FOREGROUND));
        let wavelength_nm = settings.tabulated.wavelength_nm;
        series.push(Series::upright(format!("{wavelength_nm} nm"), wavelength_nm).colored(MUTED));
        Panel {
            x: over(Axis::linear("wavelength", "nm"), view.wavelengths.get()),
            y: over(Axis::linear(parameter.symbol(), ""), view.ranges[part].get()),
            series,
            // The sources have the same colours in both.
            legend: part == 0,
            ..Panel::default()
        }
    });
    let title = crate::app::views::metals::name_and_symbol(metal);
    Some(Figure { title, panels: panels.collect(), width_mm: 160.0, height_mm: 170.0, ..Figure::default() })
}
