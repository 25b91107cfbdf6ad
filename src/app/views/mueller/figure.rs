//! The Mueller matrix for print: sixteen plots against θr.

use super::REACH;
use crate::app::window::Explorer;
use pbrdf::report::figure::{Axis, Figure, Panel, SERIES, Series};

pub fn mueller_figure(explorer: &Explorer) -> Option<Figure> {
    let Explorer { views, document, .. } = explorer;
    let view = &views.mueller;
    let (curves, ((_, _, theta_i, plane), backscatter)) = (view.curves.get()?, view.curves.key()?);
    let reach = f64::from(REACH);
    let panels = curves.0.iter().enumerate().map(|(element, pieces)| {
        let gap = [[f64::NAN; 2]];
        let points = pieces.iter().flat_map(|piece| piece.iter().copied().chain(gap)).collect();
        Panel {
            x: Axis::linear("θr", "°").between(if *backscatter { -90.0 } else { 0.0 }, 90.0),
            y: Axis::linear(format!("m{}{} / m00", element / 4, element % 4), "").between(-reach, reach),
            series: vec![Series::line("", points).colored(SERIES[0])],
            legend: false,
            ..Panel::default()
        }
    });
    let title = format!("{}: Mueller matrix at θi = {theta_i}°, Δφ = {plane}°", document.name);
    Some(Figure { title, panels: panels.collect(), columns: 4, width_mm: 190.0, height_mm: 180.0 })
}
