//! The polar lobe diagram for print. Rings are marked along both axes with the BRDF that they stand for.

use crate::app::plots::print::{FOREGROUND, MUTED, points};
use crate::app::shell::app::App;
use crate::app::views::polar::{RIM, direction};
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Dash, Drawn, Figure, Panel, SERIES, Series};
use tr::tr;

pub fn polar_figure(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { document, .. }, views, .. } = explorer;
    let view = &views.polar;
    let (lobes, ((_, _, theta_i, plane, _), _)) = (view.lobes.get()?, view.lobes.key()?);
    let mut series = Vec::new();
    let still = |points: Vec<[f64; 2]>| Series {
        name: String::new(),
        color: Some(MUTED),
        drawn: Drawn::Line { points, width: 0.4, dash: Dash::Solid },
    };
    for (radius, _) in &lobes.rings {
        series.push(still((-90..=90).step_by(3).map(|degrees| at(f64::from(degrees), *radius)).collect()));
    }
    // Along the surface stands the axis.
    let directions = || (-60_i32..=60).step_by(30);
    series.extend(directions().map(|degrees| still(vec![[0.0, 0.0], at(f64::from(degrees), 1.0)])));
    series.push(Series::labels(directions().map(|degrees| (at(f64::from(degrees), 1.0), format!("{}°", degrees.abs()))).collect()));
    if *plane == 180.0 {
        series.push(Series::line("incident ray", vec![at(-theta_i, 1.0), [0.0, 0.0]]).colored(MUTED));
        series.push(Series::dashed("mirror direction", vec![[0.0, 0.0], at(*theta_i, 1.0)], Dash::Dashed).colored(MUTED));
    }
    let terms = [("specular", &lobes.specular, 3), ("diffuse", &lobes.diffuse, 4), ("volume", &lobes.volume, 5)];
    for (name, pieces, color) in terms.into_iter().filter(|(_, pieces, _)| !pieces.is_empty()) {
        series.push(Series::line(name, points(pieces, |y| y)).colored(SERIES[color]));
    }
    series.push(Series::line("total", points(&lobes.total, |y| y)).colored(FOREGROUND));
    let marks = |sides: &[f64]| -> Vec<(f64, String)> {
        let rings = lobes.rings.iter().flat_map(|(radius, brdf)| sides.iter().map(move |side| (side * radius, brdf.clone())));
        rings.collect()
    };
    let axis = |sides: &[f64]| Axis { ticks: Some(marks(sides)), ..Axis::linear("BRDF", "sr⁻¹") };
    let panel = Panel {
        title: tr!("θi = {0}°, Δφ = {1}°; angles are θr, forward to the right", theta_i, plane),
        x: axis(&[-1.0, 1.0]).between(-RIM, RIM),
        y: axis(&[1.0]).between(0.0, RIM),
        series,
        equal_aspect: true,
        ..Panel::default()
    };
    Some(Figure { title: document.name.clone(), panels: vec![panel], ..Figure::default() })
}

fn at(theta_r: f64, radius: f64) -> [f64; 2] {
    let point = direction(theta_r, radius);
    [point.x, point.y]
}
