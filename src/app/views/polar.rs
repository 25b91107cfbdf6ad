//! Polar lobe diagram: the BRDF as the length of a ray in each direction of view, with surface, incident ray and mirror direction.
//!
//! The plane is the sliders' own: θr to the right is the forward side, to the left the backscatter side.

mod figure;

pub use figure::polar_figure;

use crate::app::jobs::memo::Memo;
use crate::app::panels::significant;
use crate::app::plots::{Axes, Following, KeyEntry, Range, curve, key_line_ui, round_up};
use crate::app::shell::app::App;
use crate::app::shell::theme;
use crate::app::views::curves::{BrdfScale, Curves, DECADES, Polyline, axis_values};
use crate::app::work::document::IncidenceSeries;
use crate::app::work::workspace::Workspace;
use egui::{Align2, Color32, RichText, Ui, Vec2};
use egui_plot::{Arrows, HoverPosition, Line, LineStyle, Plot, PlotPoint, PlotPoints, PlotUi, Text};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Degrees;
use tr::tr;

/// What the pane keeps.
#[derive(Default)]
pub struct PolarView {
    curves: Memo<CurveKey, Curves>,
    lobes: Memo<(CurveKey, Range), Lobes>,
    range: Following,
    axes: Axes,
}

/// Parameters, model, θi, plane, whether the radius is logarithmic.
type CurveKey = (Parameters, Model, f64, f64, bool);

/// Curves in the plane of the drawing, where the outermost ring has radius 1.
#[derive(Default)]
struct Lobes {
    total: Polyline,
    specular: Polyline,
    diffuse: Polyline,
    volume: Polyline,
    /// Radius and BRDF of each ring.
    rings: Vec<(f64, String)>,
}

pub fn polar_refresh(explorer: &mut App) {
    let App { work: Workspace { settings, .. }, views, dragging, .. } = explorer;
    let view = &mut views.polar;
    let log = settings.shown.polar_log;
    let key = (settings.parameters, settings.model, settings.theta_i, settings.dphi.rem_euclid(360.0), log);
    view.curves.refresh(key, |&(parameters, model, theta_i, plane, log)| {
        let Ok(surface) = Pbrdf::new(model, parameters) else { return Curves::default() };
        let series = IncidenceSeries { theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() };
        Curves::new(&surface, &series, true, BrdfScale { log, times_cosine: false })
    });
    let Some(curves) = view.curves.get() else { return };
    let values = || axis_values(&curves.total);
    let top = values().fold(f64::NEG_INFINITY, f64::max);
    let wanted = if log {
        let high = if top.is_finite() { (top + 0.1).ceil() } else { 1.0 };
        Range { low: values().fold(f64::INFINITY, f64::min).floor().clamp(high - DECADES, high - 2.0), high }
    } else {
        Range { low: 0.0, high: round_up(top) }
    };
    view.range.follow(wanted, *dragging);
    let Some(range) = view.range.get() else { return };
    view.lobes.refresh((key, range), |_| Lobes::new(curves, range, log));
}

impl Lobes {
    fn new(curves: &Curves, range: Range, log: bool) -> Self {
        let bent = |pieces: &Polyline| pieces.iter().flat_map(|piece| bend(piece, range)).collect();
        Self {
            total: bent(&curves.total),
            specular: bent(&curves.specular),
            diffuse: bent(&curves.diffuse),
            volume: bent(&curves.volume),
            rings: rings(range, log),
        }
    }
}

/// Lobes end this far outside the outermost ring: a Minnaert lobe has no bound at the horizon.
const RIM: f64 = 1.15;

/// A curve against θr, bent around the origin; broken where it leaves the drawing.
fn bend(piece: &[PlotPoint], range: Range) -> Polyline {
    let mut bent = vec![Vec::new()];
    for point in piece {
        let radius = ((point.y - range.low) / (range.high - range.low)).max(0.0);
        match bent.last_mut() {
            Some(last) if radius <= RIM => last.push(direction(point.x, radius)),
            Some(last) if !last.is_empty() => bent.push(Vec::new()),
            _ => {}
        }
    }
    bent.retain(|piece| !piece.is_empty());
    bent
}

/// The point at that radius in the direction θr (degrees).
fn direction(theta_r: f64, radius: f64) -> PlotPoint {
    let (sin, cos) = Degrees(theta_r.abs()).sin_cos();
    PlotPoint::new(radius * sin.copysign(theta_r), radius * cos)
}

/// Rings at round values: decades, or quarters of the axis.
fn rings(range: Range, log: bool) -> Vec<(f64, String)> {
    if log {
        let mut rings = Vec::new();
        let mut decade = range.low + 1.0;
        while decade <= range.high {
            rings.push(((decade - range.low) / (range.high - range.low), format!("1e{decade}")));
            decade += 1.0;
        }
        // Labels of many decades would stand on each other.
        let step = rings.len().div_ceil(4).max(1);
        rings.into_iter().rev().step_by(step).collect()
    } else {
        [0.5, 1.0].map(|radius| (radius, short(radius * range.high))).to_vec()
    }
}

fn short(value: f64) -> String {
    if (1e-3..1e4).contains(&value) { significant(value) } else { format!("{value:.2e}") }
}

/// What is drawn in the pane.
pub fn polar_options_ui(explorer: &mut App, ui: &mut Ui) {
    ui.checkbox(&mut explorer.work.settings.shown.polar_log, tr!("Logarithmic radius"))
        .on_hover_text(tr!("Shows weak lobes beside strong ones"));
    ui.checkbox(&mut explorer.work.settings.shown.filled, tr!("Filled lobes")).on_hover_text(tr!("The area under each lobe"));
}

pub fn polar_ui(explorer: &mut App, ui: &mut Ui) {
    let App { work: Workspace { settings, .. }, views, .. } = explorer;
    let view = &mut views.polar;
    let (Some(lobes), Some(range)) = (view.lobes.get(), view.range.get()) else { return };
    let dark = ui.visuals().dark_mode;
    let ink = ui.visuals().text_color();
    let log = settings.shown.polar_log;
    let in_plane = settings.dphi.rem_euclid(360.0) == 180.0;
    key_line_ui(&key_entries(lobes, in_plane, ink, dark), ui);
    let room = ui.available_size();
    let plot = Plot::new("polar lobes")
        .height(room.y)
        .data_aspect(1.0)
        .show_axes(false)
        .show_grid(false)
        .auto_bounds([false, false])
        .allow_double_click_reset(false)
        .allow_scroll(false)
        .cursor_color(Color32::TRANSPARENT)
        .label_formatter(move |hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } if !plot_name.is_empty() => {
                let radius = libm::hypot(position.x, position.y);
                let value = range.low + radius * (range.high - range.low);
                let brdf = if log { libm::exp10(value) } else { value };
                let theta_r = libm::atan2(position.x, position.y).to_degrees();
                Some(format!("{plot_name}\nθr = {theta_r:.1}°\nBRDF = {brdf:.4e} 1/sr"))
            }
            _ => None,
        });
    let response = plot.show(ui, |plot| {
        let [x, y] = ranges(room);
        view.axes.apply(plot, Some(x), Some(y));
        protractor(plot, &lobes.rings, ink, dark);
        for (pieces, name, color, width, is_part) in [
            (&lobes.specular, tr!("specular"), theme::specular(dark), 1.5, true),
            (&lobes.diffuse, tr!("diffuse"), theme::diffuse(dark), 1.5, true),
            (&lobes.volume, tr!("volume"), theme::volume(dark), 1.5, true),
            (&lobes.total, tr!("total"), theme::foreground(dark), 2.5, false),
        ] {
            if settings.shown.filled && is_part {
                for piece in pieces {
                    let shape =
                        egui_plot::Polygon::new(name.as_str(), PlotPoints::Owned(closed(piece))).fill_color(color.gamma_multiply(0.2));
                    plot.polygon(shape.stroke(egui::Stroke::new(width, color)).allow_hover(false));
                }
            }
            curve(plot, pieces, &name, color, None, width);
        }
        if in_plane {
            rays(plot, settings.theta_i, ink);
        }
        let note = if in_plane {
            tr!("θi = {}°, plane of incidence", settings.theta_i)
        } else {
            tr!("θi = {0}°, Δφ = {1}°: the incident ray is outside this plane", settings.theta_i, settings.dphi)
        };
        plot.text(Text::new("", PlotPoint::new(0.0, -0.1), RichText::new(note).color(ink).size(LETTERS)).allow_hover(false));
    });
    view.axes.listen(&response, &tr!("Plot: lobes around the point of incidence"), ui);
}

/// What is seen of the plane in a plot of that size: the whole drawing, with one unit as long on both axes.
fn ranges(room: Vec2) -> [Range; 2] {
    let (half, low, high) = (1.3, -0.2, 1.3);
    let ratio = f64::from(room.x.max(1.0) / room.y.max(1.0));
    let half = f64::max(half, 0.5 * ratio * (high - low));
    [Range { low: -half, high: half }, Range { low, high: f64::max(high, low + 2.0 * half / ratio) }]
}

/// What is drawn, with the looks of the lines.
fn key_entries(lobes: &Lobes, in_plane: bool, ink: Color32, dark: bool) -> Vec<KeyEntry> {
    let solid = LineStyle::Solid;
    let entries = [
        (!lobes.specular.is_empty(), tr!("specular"), theme::specular(dark), solid, 1.5),
        (!lobes.diffuse.is_empty(), tr!("diffuse"), theme::diffuse(dark), solid, 1.5),
        (!lobes.volume.is_empty(), tr!("volume"), theme::volume(dark), solid, 1.5),
        (true, tr!("total"), theme::foreground(dark), solid, 2.5),
        (in_plane, tr!("incident ray"), ink, solid, 1.0),
        (in_plane, tr!("mirror direction"), ink, LineStyle::dashed_dense(), 1.0),
    ];
    let shown = entries.into_iter().filter(|entry| entry.0);
    shown.map(|(_, name, color, style, width)| KeyEntry { name, color, style, width }).collect()
}

/// Size of the letters in the drawing.
const LETTERS: f32 = 12.0;

/// A piece with the origin, as an area.
fn closed(piece: &[PlotPoint]) -> Vec<PlotPoint> {
    piece.iter().copied().chain([PlotPoint::new(0.0, 0.0)]).collect()
}

/// Half the length of the surface, and where its marks stand: lobes end between them.
const SURFACE: f64 = 1.13;
const BESIDE: f64 = 1.22;

/// Surface, rings and directions with their labels.
fn protractor(plot: &mut PlotUi<'_>, rings: &[(f64, String)], ink: Color32, dark: bool) {
    let grid = theme::grid(dark);
    let still = |points: Vec<PlotPoint>, color| Line::new("", PlotPoints::Owned(points)).color(color).allow_hover(false);
    for degrees in (-90_i32..=90).step_by(15) {
        let theta_r = f64::from(degrees);
        plot.line(still(vec![PlotPoint::new(0.0, 0.0), direction(theta_r, 1.0)], grid).width(1.0));
        if degrees % 30 == 0 {
            let label = RichText::new(format!("{}°", degrees.abs())).color(ink).size(LETTERS);
            // Behind the ends of the surface, where no lobe comes.
            let at = direction(theta_r, if degrees.abs() == 90 { BESIDE } else { 1.09 });
            plot.text(Text::new("", at, label).allow_hover(false));
        }
    }
    for (radius, label) in rings {
        let arc = (-90..=90).step_by(3).map(|degrees| direction(f64::from(degrees), *radius)).collect();
        plot.line(still(arc, grid).width(1.0));
        // The unit once, where there is room for it.
        let label = if *radius >= 1.0 { format!("{label} 1/sr") } else { label.clone() };
        let label = RichText::new(label).color(ink).size(LETTERS);
        plot.text(Text::new("", PlotPoint::new(*radius, -0.01), label).anchor(Align2::CENTER_TOP).allow_hover(false));
    }
    plot.line(still(vec![PlotPoint::new(-SURFACE, 0.0), PlotPoint::new(SURFACE, 0.0)], ink).width(2.5));
}

/// The incident ray and the mirror direction.
fn rays(plot: &mut PlotUi<'_>, theta_i: f64, ink: Color32) {
    let origin = PlotPoint::new(0.0, 0.0);
    // The tip half way: at the origin all lobes meet.
    let (from, tip) = (direction(-theta_i, 1.04), direction(-theta_i, 0.6));
    let ray = Arrows::new(tr!("incident ray"), PlotPoints::Owned(vec![from]), PlotPoints::Owned(vec![tip]));
    plot.arrows(ray.color(ink).tip_length(12.0).allow_hover(false));
    plot.line(Line::new(tr!("incident ray"), PlotPoints::Owned(vec![tip, origin])).color(ink).width(1.0).allow_hover(false));
    let mirror = Line::new(tr!("mirror direction"), PlotPoints::Owned(vec![origin, direction(theta_i, 1.04)]));
    plot.line(mirror.color(ink).width(1.0).style(LineStyle::dashed_dense()).allow_hover(false));
}

#[cfg(test)]
mod tests {
    use super::{PlotPoint, Range, Vec2, bend, direction, ranges, rings};

    #[test]
    fn the_whole_drawing_is_seen_in_plots_of_every_shape() {
        for (width, height) in [(575.0, 285.0), (300.0, 400.0), (1200.0, 300.0)] {
            let [x, y] = ranges(Vec2::new(width, height));
            assert!(x.low <= -1.3 && x.high >= 1.3 && y.low <= -0.2 && y.high >= 1.3);
            let lengths = [f64::from(width) / (x.high - x.low), f64::from(height) / (y.high - y.low)];
            assert!((lengths[0] / lengths[1] - 1.0).abs() < 1e-6, "{lengths:?}");
        }
    }

    #[test]
    fn forward_is_to_the_right_and_the_normal_is_up() {
        assert_eq!(direction(0.0, 1.0), PlotPoint::new(0.0, 1.0));
        let (forward, back) = (direction(30.0, 1.0), direction(-30.0, 1.0));
        // sin 30° is exact.
        assert_eq!((forward.x, back.x), (0.5, -0.5));
        assert_eq!(forward.y, back.y);
    }

    #[test]
    fn a_lobe_is_broken_where_it_leaves_the_drawing_and_ends_at_the_origin() {
        let range = Range { low: 1.0, high: 3.0 };
        let curve: Vec<PlotPoint> = [2.0, 3.0, 9.0, 2.0, 0.0].into_iter().map(|y| PlotPoint::new(0.0, y)).collect();
        let radii: Vec<Vec<f64>> = bend(&curve, range).iter().map(|piece| piece.iter().map(|point| point.y).collect()).collect();
        assert_eq!(radii, [vec![0.5, 1.0], vec![0.5, 0.0]]);
    }

    #[test]
    fn rings_stand_at_round_values_and_the_outermost_at_the_rim() {
        for (range, log) in [(Range { low: 0.0, high: 7.5 }, false), (Range { low: -6.0, high: 2.0 }, true)] {
            let rings = rings(range, log);
            assert!(rings.len() <= 4 && rings.iter().any(|(radius, _)| *radius == 1.0), "{rings:?}");
        }
    }
}
