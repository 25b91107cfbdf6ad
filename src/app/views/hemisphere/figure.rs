//! The hemisphere map for print: θr from the middle outwards in degrees, so that axes can tell it.

use crate::app::plots::print::{FOREGROUND, MARK, WHITE, edges, over};
use crate::app::shell::app::App;
use crate::app::views::hemisphere::{Made, SIZE, place, values};
use crate::app::work::settings::Quantity;
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Dash, Figure, HeatMap, Panel, Point, Series, Symbol};
use tr::tr;

pub fn hemisphere_figure(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { settings, document, .. }, views, .. } = explorer;
    let view = &views.hemisphere;
    let (key, made) = (view.job.key()?, view.job.get()?.as_ref()?);
    let theta_i = key.2;
    let mut series =
        vec![Series::heat_map(heat_map(made, settings.shown.hemisphere, view.ranges[settings.shown.hemisphere as usize].get()?))];
    for theta_r in [30.0, 60.0] {
        series.push(Series::dashed("", ring(theta_r), Dash::Solid).colored(WHITE));
    }
    series.push(Series::dashed("", ring(90.0), Dash::Solid).colored(FOREGROUND));
    let labels = [30.0, 60.0].map(|theta_r| (at(theta_r, 90.0), format!("θr = {theta_r}°")));
    series.push(Series::labels(labels.to_vec()));
    let mark = |name: &str, places: Vec<[f64; 2]>, symbol| {
        let points = places.into_iter().map(|[x, y]| Point { x, y, bar: None }).collect();
        Series::measured(name, points, symbol).colored(MARK)
    };
    let measured = view.measured.get().into_iter().flatten();
    let measured: Vec<[f64; 2]> = measured.map(|at| [90.0 * f64::from(at.x), 90.0 * f64::from(at.y)]).collect();
    if !measured.is_empty() {
        series.push(mark("measured", measured, Symbol::Circle));
    }
    series.push(mark("incident ray", vec![at(theta_i, 0.0)], Symbol::Disc));
    series.push(mark("mirror direction", vec![at(theta_i, 180.0)], Symbol::Cross));
    let axis = |label| Axis::linear(label, "°").between(-90.0, 90.0);
    let panel = Panel {
        title: tr!("θi = {}°; radius θr, Δφ = 180° to the right, 270° upwards", theta_i),
        x: axis("−θr cos Δφ"),
        y: axis("−θr sin Δφ"),
        series,
        equal_aspect: true,
        ..Panel::default()
    };
    Some(Figure { title: document.name.clone(), panels: vec![panel], width_mm: 130.0, height_mm: 125.0, ..Figure::default() })
}

fn heat_map(made: &Made, quantity: Quantity, range: crate::app::plots::Range) -> HeatMap {
    // The BRDF is kept as its logarithm.
    let is_log = quantity == Quantity::Brdf;
    let value = |value: f64| if is_log { libm::exp10(value) } else { value };
    let axis = match quantity {
        Quantity::Dolp => Axis::linear("DoLP", ""),
        Quantity::Angle => Axis::linear("angle of polarisation", "°"),
        Quantity::Brdf => Axis::log("BRDF", "sr⁻¹"),
        Quantity::SpecularShare => Axis::linear("specular share", ""),
    };
    let range = crate::app::plots::Range { low: value(range.low), high: value(range.high) };
    HeatMap {
        x_edges: edges(-90.0, 90.0, SIZE),
        y_edges: edges(-90.0, 90.0, SIZE),
        values: values(&made.map, quantity).iter().map(|at| value(*at)).collect(),
        color_axis: over(axis, Some(range)),
        colors: quantity.colors(),
    }
}

/// Where a direction lies, in degrees from the middle.
fn at(theta_r: f64, dphi: f64) -> [f64; 2] {
    let at = place(theta_r, dphi);
    [90.0 * f64::from(at.x), 90.0 * f64::from(at.y)]
}

/// All directions of that θr.
fn ring(theta_r: f64) -> Vec<[f64; 2]> {
    (0..=120).map(|i| at(theta_r, 3.0 * f64::from(i))).collect()
}
