//! Polar lobe diagram: the BRDF as the length of a ray in each direction of view, with surface,
//! incident ray and mirror direction.
//!
//! The plane is the sliders' own: θr to the right is the forward side, to the left the backscatter
//! side.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::{FOREGROUND, MUTED};
use crate::app::plots::{AutoRange, FigurePlot, PanelStyle, Polyline, Range, nice_ceiling};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::numbers::significant;
use crate::app::views::companions::{Pinned, pinned};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::{DECADES, ModelCurves, axis_values};
use crate::app::views::pointing::mark_along;
use crate::app::work::open_measurement::IncidenceSeries;
use crate::figure::{Axis, Dash, Figure, Panel, Series};
use egui::{Key, Ui};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Degrees;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Polar lobes",
    tooltip: "The lobes around the point of incidence, with surface, incident ray and mirror direction",
    shortcut: Some(Key::Num3),
    has_options: true,
    has_figure: true,
    new: || Box::new(PolarLobesView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct PolarLobesView {
    curves: Memo<CurveKey, ModelCurves>,
    /// BRDF of each pinned surface.
    pinned: Memo<PinnedKey, Vec<Polyline>>,
    range: AutoRange,
    plot: FigurePlot<PlotKey>,
}

/// Of the curves and pinned surfaces by their stamps; the radius, whether it is logarithmic and whether lobes are
/// filled; the picked angle of view; the language.
type PlotKey = ([u64; 2], Option<Range>, [bool; 2], Option<f64>, Language);

/// Parameters, model, θi, plane.
type CurveKey = (Parameters, Model, f64, f64);

/// The surfaces, θi, plane.
type PinnedKey = (Vec<Pinned>, f64, f64);

/// How a BRDF becomes a radius: 1 at the outermost ring.
#[derive(Debug, Clone, Copy)]
struct Radius {
    range: Range,
    log: bool,
}

/// Lobes end this far outside the outermost ring: a Minnaert lobe has no bound at the horizon.
const RIM: f64 = 1.15;

impl Radius {
    fn of(self, brdf: f64) -> f64 {
        let value = if self.log { libm::log10(brdf) } else { brdf };
        ((value - self.range.low) / (self.range.high - self.range.low)).max(0.0)
    }

    /// The BRDF at a radius.
    fn brdf(self, radius: f64) -> f64 {
        let value = self.range.low + radius * (self.range.high - self.range.low);
        if self.log { libm::exp10(value) } else { value }
    }

    /// A curve against θr, bent around the origin; broken where it leaves the drawing.
    fn bend(self, curve: &Polyline) -> Polyline {
        let place = |[theta_r, brdf]: &[f64; 2]| {
            // What is dark lies at the origin.
            let radius = if *brdf == 0.0 { 0.0 } else { self.of(*brdf) };
            if radius <= RIM && brdf.is_finite() { direction(*theta_r, radius) } else { [f64::NAN; 2] }
        };
        curve.iter().map(place).collect()
    }

    /// Rings at round values: decades, or halves of the axis.
    fn rings(self) -> Vec<(f64, String)> {
        let Self { range, log } = self;
        if !log {
            return [0.5, 1.0].map(|radius| (radius, short(radius * range.high))).to_vec();
        }
        let mut rings = Vec::new();
        let mut decade = range.low + 1.0;
        while decade <= range.high {
            rings.push(((decade - range.low) / (range.high - range.low), format!("1e{decade}")));
            decade += 1.0;
        }
        // Labels of many decades would stand on each other.
        let step = rings.len().div_ceil(4).max(1);
        rings.into_iter().rev().step_by(step).collect()
    }
}

/// The point at that radius in the direction θr (degrees).
fn direction(theta_r: f64, radius: f64) -> [f64; 2] {
    let (sin, cos) = Degrees(theta_r.abs()).sin_cos();
    [radius * sin.copysign(theta_r), radius * cos]
}

fn short(value: f64) -> String {
    if (1e-3..1e4).contains(&value) { significant(value) } else { format!("{value:.2e}") }
}

/// Rings and directions with their angles.
fn protractor(rings: &[(f64, String)]) -> Vec<Series> {
    let still = |points: Vec<[f64; 2]>| Series::stroke("", points, 0.4, Dash::Solid).colored(MUTED);
    let arc = |radius: f64| (-90..=90).step_by(3).map(|degrees| direction(f64::from(degrees), radius)).collect();
    let mut series: Vec<Series> = rings.iter().map(|(radius, _)| still(arc(*radius))).collect();
    // Along the surface stands the axis.
    let directions = || (-60_i32..=60).step_by(30);
    // Beside the directions, which have words of their own.
    series.push(Series::labels(rings.iter().map(|(radius, brdf)| (direction(RING_LABELS, *radius), brdf.clone())).collect()));
    series.extend(directions().map(|degrees| still(vec![[0.0, 0.0], direction(f64::from(degrees), 1.0)])));
    let labels = directions().map(|degrees| (direction(f64::from(degrees), 1.0), format!("{}°", degrees.abs())));
    series.push(Series::labels(labels.collect()));
    series
}

/// Where the words at rings stand, in degrees of θr.
const RING_LABELS: f64 = -13.0;

/// A ray from the outermost ring to the origin, with its tip; it comes from that θr in degrees.
fn arrow(theta_r: f64) -> Polyline {
    let barb = |turn: f64| direction(theta_r + turn, 0.06);
    vec![direction(theta_r, 1.0), [0.0, 0.0], [f64::NAN; 2], barb(20.0), [0.0, 0.0], barb(-20.0)]
}

/// The figure, of lobes in a plane at that θi.
fn describe(curves: &ModelCurves, pins: Vec<Series>, radius: Radius, (theta_i, plane): (f64, f64), filled: bool, title: String) -> Figure {
    let rings = radius.rings();
    let mut series = protractor(&rings);
    if plane == 180.0 {
        series.push(Series::line(tr!("incident ray"), arrow(-theta_i)).colored(MUTED));
        let mirror = vec![[0.0, 0.0], direction(theta_i, 1.0)];
        series.push(Series::dashed(tr!("mirror direction"), mirror, Dash::Dashed).colored(MUTED));
    }
    for (term, curve) in curves.terms() {
        let lobe = radius.bend(curve);
        if filled {
            series.push(Series::area(term.name(), closed(&lobe)).colored(term.ink()));
        }
        series.push(Series::line(term.name(), lobe).colored(term.ink()));
    }
    series.extend(pins);
    series.push(Series::line(tr!("total"), radius.bend(&curves.total)).colored(FOREGROUND));
    let axis = |sides: &[f64]| {
        let marks = rings.iter().flat_map(|(radius, brdf)| sides.iter().map(move |side| (side * radius, brdf.clone())));
        Axis { ticks: Some(marks.collect()), ..Axis::linear("BRDF", "sr⁻¹") }
    };
    let panel = Panel {
        title: tr!("θi = {0}°, Δφ = {1}°; angles are θr, forward to the right", theta_i, plane),
        x: axis(&[-1.0, 1.0]).between(-RIM, RIM),
        y: axis(&[1.0]).between(0.0, RIM),
        series,
        equal_aspect: true,
        ..Panel::default()
    };
    Figure { title, panels: vec![panel], ..Figure::default() }
}

/// All of a surface in a plane, backscatter side included.
fn curves(model: Model, parameters: Parameters, theta_i: f64, plane: f64) -> ModelCurves {
    let Ok(surface) = Pbrdf::new(model, parameters) else { return ModelCurves::default() };
    let series = IncidenceSeries { theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() };
    ModelCurves::new(&surface, &series, true, false)
}

/// Each piece of a curve with the origin, as an area.
fn closed(curve: &Polyline) -> Vec<[f64; 2]> {
    let pieces = curve.split(|[x, _]| !x.is_finite()).filter(|piece| !piece.is_empty());
    pieces.flat_map(|piece| piece.iter().copied().chain([[0.0, 0.0], [f64::NAN; 2]])).collect()
}

impl PolarLobesView {
    fn radius(&self, log: bool) -> Option<Radius> {
        Some(Radius { range: self.range.get()?, log })
    }
}

impl View for PolarLobesView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (settings, surface) = (cx.work.settings(), cx.work.surface());
        let log = settings.view_options.polar_log;
        let key = (surface.parameters, surface.model, settings.theta_i, settings.dphi.rem_euclid(360.0));
        self.curves.refresh(key, |&(parameters, model, theta_i, plane)| curves(model, parameters, theta_i, plane));
        let pinned_key = (pinned(cx.work), settings.theta_i, settings.dphi.rem_euclid(360.0));
        self.pinned.refresh(pinned_key, |(pins, theta_i, plane)| {
            pins.iter().map(|pin| curves(pin.model, pin.parameters, *theta_i, *plane).total).collect()
        });
        let Some(curves) = self.curves.get() else { return };
        let place = |value: f64| if log { libm::log10(value) } else { value };
        let pinned_curves = self.pinned.get().map_or(&[][..], Vec::as_slice);
        let values =
            || axis_values(&curves.total).chain(pinned_curves.iter().flat_map(axis_values)).map(place).filter(|value| value.is_finite());
        let top = values().fold(f64::NEG_INFINITY, f64::max);
        let wanted = if log {
            let high = if top.is_finite() { (top + 0.1).ceil() } else { 1.0 };
            Range { low: values().fold(f64::INFINITY, f64::min).floor().clamp(high - DECADES, high - 2.0), high }
        } else {
            Range { low: 0.0, high: nice_ceiling(top) }
        };
        self.range.follow(wanted, cx.interacting);
        let Some(radius) = self.radius(log) else { return };
        let title = cx.work.active().title();
        let filled = settings.view_options.filled;
        let picked = cx.derived.picked_theta_r(cx.work);
        let figure_key = ([self.curves.stamp(), self.pinned.stamp()], self.range.get(), [log, filled], picked, i18n::current());
        let pins = self.pinned.key().map_or(&[][..], |(pins, ..)| pins).iter().zip(pinned_curves);
        let mut pins: Vec<Series> = pins.map(|(pin, curve)| pin.look.stroke(radius.bend(curve))).collect();
        pins.extend(picked.map(|theta_r| mark_along(vec![[0.0, 0.0], direction(theta_r, 1.0)])));
        self.plot.refresh(figure_key, |_| Some(describe(curves, pins, radius, (key.2, key.3), filled, title)));
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let Some(radius) = self.radius(cx.work.settings().view_options.polar_log) else { return };
        let Some(panel) = self.plot.panel(0) else { return };
        panel.key_line_ui(ui);
        if cx.work.settings().dphi.rem_euclid(360.0) != 180.0 {
            ui.weak(tr!(
                "θi = {0}°, Δφ = {1}°: the incident ray is outside this plane",
                cx.work.settings().theta_i,
                cx.work.settings().dphi
            ));
        }
        let hover = |name: &str, x: f64, y: f64| {
            let (brdf, theta_r) = (radius.brdf(libm::hypot(x, y)), libm::atan2(x, y).to_degrees());
            format!("{name}\nθr = {theta_r:.1}°\nBRDF = {brdf:.4e} sr⁻¹")
        };
        let style = PanelStyle::new("polar lobes", ui.available_height(), &hover);
        panel.ui(&style.named(tr!("Plot: lobes around the point of incidence")), ui);
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        cx.view_options_ui(|shown| {
            ui.checkbox(&mut shown.polar_log, tr!("Logarithmic radius")).on_hover_text(tr!("Shows weak lobes beside strong ones"));
            ui.checkbox(&mut shown.filled, tr!("Filled lobes")).on_hover_text(tr!("The area under each lobe"));
        });
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}

#[cfg(test)]
mod tests {
    use super::{Radius, Range, direction};
    use crate::app::plots::finite;

    #[test]
    fn forward_is_to_the_right_and_the_normal_is_up() {
        assert_eq!(direction(0.0, 1.0), [0.0, 1.0]);
        let (forward, back) = (direction(30.0, 1.0), direction(-30.0, 1.0));
        // sin 30° is exact.
        assert_eq!((forward[0], back[0]), (0.5, -0.5));
        assert_eq!(forward[1], back[1]);
    }

    #[test]
    fn a_lobe_is_broken_where_it_leaves_the_drawing_and_ends_at_the_origin() {
        let radius = Radius { range: Range { low: 1.0, high: 3.0 }, log: false };
        let bent = radius.bend(&[2.0, 3.0, 9.0, 2.0, 0.0].map(|brdf| [0.0, brdf]).to_vec());
        assert_eq!(finite(&bent).map(|[_, y]| y).collect::<Vec<_>>(), [0.5, 1.0, 0.5, 0.0]);
        assert!(bent[2][1].is_nan());
        assert_eq!(radius.brdf(0.5), 2.0);
    }

    #[test]
    fn rings_stand_at_round_values_and_the_outermost_at_the_rim() {
        for (range, log) in [(Range { low: 0.0, high: 7.5 }, false), (Range { low: -6.0, high: 2.0 }, true)] {
            let rings = Radius { range, log }.rings();
            assert!(rings.len() <= 4 && rings.iter().any(|(radius, _)| *radius == 1.0), "{rings:?}");
        }
    }
}
