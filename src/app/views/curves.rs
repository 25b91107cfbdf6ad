//! What is drawn against θr: the model along every measured θi and at the sliders' own, and the measured points.

use crate::app::plots::Range;
use crate::app::work::document::{DataPoint, Document, IncidenceSeries};
use crate::app::work::settings::Settings;
use egui_plot::PlotPoint;
use pbrdf::model::{Diffuse, Model, Parameters, Pbrdf, Reflection};
use pbrdf::optics::{Degrees, Facet};
use tr::tr;

pub use crate::report::directions;

/// Curves that are drawn at most, and points: more cannot be told apart, and would make the window slow.
pub const MOST_SERIES: usize = 12;
pub const MOST_POINTS: usize = 20_000;

/// Decades below its top that a logarithmic axis shows at most.
pub const DECADES: f64 = 8.0;

/// Up to this θr, in degrees, curves take part in choosing the axes: a Minnaert lobe has no bound at the horizon.
pub const SETS_AXES: f64 = 80.0;

/// A curve in pieces: a value that is not finite ends one.
pub type Polyline = Vec<Vec<PlotPoint>>;

/// A measured value with the ends of its error bar, in plot coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorBar {
    pub x: f64,
    pub low: f64,
    pub high: f64,
}

/// Measured points of one series and quantity.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Marks {
    pub used: Vec<PlotPoint>,
    pub masked: Vec<PlotPoint>,
    pub bars: Vec<ErrorBar>,
}

impl Marks {
    /// Whether anything was measured.
    pub fn is_there(&self) -> bool {
        !(self.used.is_empty() && self.masked.is_empty())
    }
}

/// What is drawn of one measured θi.
#[derive(Debug, Clone, PartialEq)]
pub struct SeriesMarks {
    pub name: String,
    pub dolp: Marks,
    pub brdf: Marks,
}

/// The model along one series.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Curves {
    pub dolp: Polyline,
    pub limit: Polyline,
    pub total: Polyline,
    pub specular: Polyline,
    pub diffuse: Polyline,
    pub volume: Polyline,
    /// The specular share of the radiance, 0 to 1.
    pub share: Polyline,
}

/// How a BRDF is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BrdfScale {
    pub log: bool,
    /// Whether it is multiplied by cos θr: what a detector sees of a spot that it looks at as a whole.
    pub times_cosine: bool,
}

impl BrdfScale {
    pub fn new(settings: &Settings) -> Self {
        Self { log: settings.log_brdf, times_cosine: settings.shown.times_cosine }
    }

    /// A value at θr (degrees) as its plot has it; none where a logarithm does not exist.
    pub fn coordinate(self, theta_r: f64, value: f64) -> Option<f64> {
        let value = if self.times_cosine { value * Degrees(theta_r.abs()).sin_cos().1 } else { value };
        let y = if self.log { libm::log10(value) } else { value };
        y.is_finite().then_some(y)
    }
}

/// What the curves depend on.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveKey {
    pub parameters: Parameters,
    pub model: Model,
    pub theta_i: f64,
    pub dphi: f64,
    pub brdf: BrdfScale,
    /// Whether the backscatter side is drawn.
    pub backscatter: bool,
    pub generation: u64,
}

impl CurveKey {
    pub fn new(settings: &Settings, document: &Document) -> Self {
        Self {
            parameters: settings.parameters,
            model: settings.model,
            theta_i: settings.theta_i,
            dphi: settings.dphi,
            brdf: BrdfScale::new(settings),
            backscatter: settings.show_backscatter || document.has_backscatter(),
            generation: document.generation,
        }
    }

    /// The θr that are drawn.
    pub fn x(&self) -> Range {
        Range { low: if self.backscatter { -90.0 } else { 0.0 }, high: 90.0 }
    }
}

/// All curves of the sliders.
#[derive(Debug, Clone, Default)]
pub struct CurveSet {
    /// Along each series.
    pub series: Vec<Curves>,
    /// At the sliders' own θi and Δφ.
    pub own: Curves,
    /// The series that has the sliders' own θi and Δφ.
    pub own_is_series: Option<usize>,
}

impl CurveSet {
    /// Without curves where the values mean no surface.
    pub fn new(key: &CurveKey, document: &Document) -> Self {
        let Ok(surface) = Pbrdf::new(key.model, key.parameters) else {
            return Self { series: drawn(document).map(|_| Curves::default()).collect(), ..Self::default() };
        };
        let plane = key.dphi.rem_euclid(360.0);
        let own = IncidenceSeries { theta_i: key.theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() };
        let curves = |series: &IncidenceSeries| Curves::new(&surface, series, key.backscatter, key.brdf);
        let series: Vec<Curves> = drawn(document).map(curves).collect();
        let own_is_series = drawn(document).position(|series| series.theta_i == own.theta_i && series.plane == own.plane);
        let own = own_is_series.map_or_else(|| curves(&own), |index| series[index].clone());
        Self { series, own, own_is_series }
    }

    /// Those of every series, and the sliders' own.
    pub fn all(&self) -> impl Iterator<Item = &Curves> {
        self.series.iter().chain([&self.own])
    }
}

/// Measured points as they are drawn.
#[derive(Debug, Clone, Default)]
pub struct MarkSet {
    /// Of each series.
    pub series: Vec<SeriesMarks>,
    /// Series and points that are not drawn.
    pub left_out: Option<Decimation>,
}

/// What is not drawn of too much.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decimation {
    /// Of so many points one in `step` is drawn.
    Points { step: usize, of: usize },
    /// Of so many series the first are drawn.
    Series { of: usize },
}

impl Decimation {
    pub fn text(self) -> String {
        match self {
            Self::Points { step, of } => tr!("every {0}th of {1} points is drawn", step, of),
            Self::Series { of } => tr!("{0} of {1} angles of incidence are drawn", MOST_SERIES, of),
        }
    }
}

impl MarkSet {
    pub fn new(document: &Document, scale: BrdfScale) -> Self {
        let total: usize = document.series.iter().map(|series| series.dolp.len() + series.brdf.len()).sum();
        let step = total.div_ceil(MOST_POINTS).max(1);
        let series = drawn(document).map(|series| SeriesMarks {
            name: series.name(),
            dolp: marks(&series.dolp, step, |_, value| Some(value)),
            brdf: marks(&series.brdf, step, |theta_r, value| scale.coordinate(theta_r, value)),
        });
        let hidden = document.series.len().saturating_sub(MOST_SERIES);
        let left_out = match (hidden, step) {
            (0, 1) => None,
            (0, _) => Some(Decimation::Points { step, of: total }),
            _ => Some(Decimation::Series { of: document.series.len() }),
        };
        Self { series: series.collect(), left_out }
    }
}

/// Values of a curve that take part in choosing an axis.
pub fn axis_values(pieces: &Polyline) -> impl Iterator<Item = f64> {
    pieces.iter().flatten().filter(|point| point.x.abs() <= SETS_AXES).map(|point| point.y)
}

/// The series that are drawn.
pub fn drawn(document: &Document) -> impl Iterator<Item = &IncidenceSeries> {
    document.series.iter().take(MOST_SERIES)
}

fn marks(measured: &[DataPoint], step: usize, coordinate: impl Fn(f64, f64) -> Option<f64>) -> Marks {
    let mut marks = Marks::default();
    for mark in measured.iter().step_by(step) {
        let Some(y) = coordinate(mark.theta_r, mark.quantity.value) else { continue };
        let points = if mark.masked { &mut marks.masked } else { &mut marks.used };
        points.push(PlotPoint::new(mark.theta_r, y));
        if let Some(sigma) = mark.quantity.sigma.filter(|_| !mark.masked) {
            let high = coordinate(mark.theta_r, mark.quantity.value + sigma).unwrap_or(y);
            // A bar that reaches 0 or below ends beneath any logarithmic axis.
            let low = coordinate(mark.theta_r, mark.quantity.value - sigma).unwrap_or(y - 2.0 * DECADES);
            marks.bars.push(ErrorBar { x: mark.theta_r, low, high });
        }
    }
    marks
}

impl Curves {
    pub fn new(surface: &Pbrdf, series: &IncidenceSeries, backscatter: bool, scale: BrdfScale) -> Self {
        let angles = directions(series.theta_i, backscatter);
        let at: Vec<(f64, Reflection, f64)> = angles
            .into_iter()
            .filter_map(|angle| {
                let facet = Facet::new(series.geometry(angle)?);
                Some((angle, surface.reflection(&facet), surface.fresnel_limit(&facet)))
            })
            .collect();
        let brdf =
            |value: fn(&Reflection) -> f64| pieces(at.iter().map(|(x, reflection, _)| (*x, scale.coordinate(*x, value(reflection)))));
        let model = surface.model();
        Self {
            dolp: pieces(at.iter().map(|(x, reflection, _)| (*x, Some(reflection.dolp)))),
            limit: if model.specular { pieces(at.iter().map(|(x, _, limit)| (*x, Some(*limit)))) } else { Polyline::new() },
            total: brdf(|reflection| reflection.brdf),
            specular: if model.specular { brdf(|reflection| reflection.specular) } else { Polyline::new() },
            diffuse: if model.diffuse == Diffuse::Absent { Polyline::new() } else { brdf(|reflection| reflection.diffuse) },
            share: if model.specular {
                pieces(at.iter().map(|(x, reflection, _)| (*x, Some(reflection.specular / reflection.brdf))))
            } else {
                Polyline::new()
            },
            volume: if model.volume { brdf(|reflection| reflection.volume) } else { Polyline::new() },
        }
    }
}

pub fn pieces(points: impl Iterator<Item = (f64, Option<f64>)>) -> Polyline {
    let mut pieces = vec![Vec::new()];
    for (x, y) in points {
        match (y.filter(|y| y.is_finite()), pieces.last_mut()) {
            (Some(y), Some(piece)) => piece.push(PlotPoint::new(x, y)),
            (None, Some(piece)) if !piece.is_empty() => pieces.push(Vec::new()),
            _ => {}
        }
    }
    pieces.retain(|piece| !piece.is_empty());
    pieces
}
