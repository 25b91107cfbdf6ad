//! The Mueller matrix for print: sixteen plots against θr, and all elements as numbers at the θr of the pane.

use crate::app::panels::significant;
use crate::app::plots::print::{FOREGROUND, MUTED};
use crate::app::shell::app::App;
use crate::app::views::mueller::{REACH, normalised, number};
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Figure, Panel, SERIES, Series};
use tr::tr;

pub fn mueller_figure(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { document, .. }, views, .. } = explorer;
    let view = &views.mueller;
    let (curves, ((_, _, theta_i, plane), backscatter)) = (view.curves.get()?, view.curves.key()?);
    let matrix = view.matrix.get().and_then(Option::as_ref).zip(view.matrix.key().map(|key| key.1));
    let reach = f64::from(REACH);
    let panels = curves.0.iter().enumerate().map(|(element, pieces)| {
        let gap = [[f64::NAN; 2]];
        let points = pieces.iter().flat_map(|piece| piece.iter().copied().chain(gap)).collect();
        let mut series = vec![Series::line("", points).colored(SERIES[0])];
        let mut title = String::new();
        if let Some((matrix, theta_r)) = matrix {
            let value = normalised(matrix, element);
            series.insert(0, Series::upright("", theta_r).colored(MUTED));
            series.push(Series::points("", [[theta_r, value]]).colored(FOREGROUND));
            // On the free side of the curve.
            let beside = if value > 0.0 { value - NUMBER } else { value + NUMBER };
            series.push(Series::labels(vec![([theta_r, beside], number(value))]));
            if element == 0 {
                title = tr!("numbers at θr = {0}°, m00 = {1} sr⁻¹", format!("{theta_r:.1}"), significant(matrix.element(0, 0)));
            }
        }
        Panel {
            title,
            x: Axis::linear("θr", "°").between(if *backscatter { -90.0 } else { 0.0 }, 90.0),
            y: Axis::linear(format!("m{}{} / m00", element / 4, element % 4), "").between(-reach, reach),
            series,
            legend: false,
            ..Panel::default()
        }
    });
    let title = tr!("{0}: Mueller matrix at θi = {1}°, Δφ = {2}°", document.name, theta_i, plane);
    Some(Figure { title, panels: panels.collect(), columns: 4, width_mm: 190.0, height_mm: 180.0 })
}

/// How far from its value a number stands.
const NUMBER: f64 = 0.25;
