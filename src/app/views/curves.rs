//! What is drawn against θr: the model along every measured θi and at the sliders' own, and the
//! measured points.

use crate::app::plots::theme::MUTED;
use crate::app::plots::{Polyline, Range, finite};
use crate::app::work::open_measurement::{DataPoint, IncidenceSeries, OpenMeasurement};
use crate::app::work::workspace::Workspace;
use crate::figure;
use crate::figure::{Point, Rgb, SERIES, Symbol};
use pbrdf::fit::FitRange;
use pbrdf::model::{Diffuse, Model, Parameters, Pbrdf, Reflection};
use pbrdf::optics::{Degrees, Facet};
use tr::tr;

pub use crate::report::directions;

/// Points that are drawn at most: more cannot be told apart, and would make the window slow.
pub const MOST_POINTS: usize = 20_000;

/// Anchors of the colours of many series, from the smallest angle of incidence to the largest: they
/// are read on a light and on a dark page.
const MANY: [Rgb; 4] = [Rgb(50, 110, 220), Rgb(150, 80, 210), Rgb(205, 60, 140), Rgb(215, 90, 30)];

/// The colour of a series of so many: one of a kind, or where there are too many for that, one that
/// goes with the order.
pub fn series_ink(index: usize, of: usize) -> Rgb {
    if of <= SERIES.len() {
        return SERIES[index % SERIES.len()];
    }
    #[expect(clippy::cast_precision_loss, reason = "numbers of series")]
    let place = (MANY.len() - 1) as f64 * index as f64 / (of - 1).max(1) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place among anchors")]
    let below = (place as usize).min(MANY.len() - 2);
    #[expect(clippy::cast_precision_loss, reason = "a place among anchors")]
    let share = place - below as f64;
    let (Rgb(r, g, b), Rgb(r2, g2, b2)) = (MANY[below], MANY[below + 1]);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
    let between = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    Rgb(between(r, r2), between(g, g2), between(b, b2))
}

/// Decades below its top that a logarithmic axis shows at most.
pub const DECADES: f64 = 8.0;

/// Up to this θr, in degrees, curves take part in choosing the axes: a Minnaert lobe has no bound
/// at the horizon.
pub const SETS_AXES: f64 = 80.0;

/// Measured points of one series and quantity.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DataPoints {
    /// With their error bars.
    pub used: Vec<Point>,
    /// Without.
    pub masked: Vec<Point>,
    /// Outside the angles that are fitted, without error bars.
    pub outside: Vec<Point>,
}

/// Whether a point of a series is none of those that a fit uses because its angles are outside the range.
pub fn is_outside(range: Option<FitRange>, series: &IncidenceSeries, point: &DataPoint) -> bool {
    range.is_some_and(|range| series.geometry(point.theta_r).is_some_and(|geometry| !range.contains(geometry)))
}

/// Whether a fit uses it.
pub fn is_fitted(range: Option<FitRange>, series: &IncidenceSeries, point: &DataPoint) -> bool {
    !point.masked && !is_outside(range, series, point)
}

/// Opacity of points outside the range.
const OUTSIDE: f64 = 0.4;

impl DataPoints {
    /// The measured values that are drawn.
    fn new(measured: &[DataPoint], step: usize, is_outside: impl Fn(&DataPoint) -> bool, coordinate: impl Fn(f64, f64) -> f64) -> Self {
        let mut points = Self::default();
        for mark in measured.iter().step_by(step) {
            let place = |value| coordinate(mark.theta_r, value);
            let (x, y) = (mark.theta_r, place(mark.quantity.value));
            if mark.masked {
                points.masked.push(Point { x, y, bar: None });
            } else if is_outside(mark) {
                points.outside.push(Point { x, y, bar: None });
            } else {
                let bar = mark.quantity.sigma.map(|sigma| (place(mark.quantity.value - sigma), place(mark.quantity.value + sigma)));
                points.used.push(Point { x, y, bar });
            }
        }
        points
    }

    /// Whether nothing was measured.
    pub fn is_empty(&self) -> bool {
        self.used.is_empty() && self.masked.is_empty() && self.outside.is_empty()
    }

    /// The points in a figure, masked ones as grey circles, those outside the range as faint ones of their own colour.
    pub fn series(&self, name: &str, color: Rgb, marker: Symbol) -> impl Iterator<Item = figure::Series> {
        let used = figure::Series::measured(name, self.used.clone(), marker).colored(color);
        let masked = figure::Series::measured(tr!("masked"), self.masked.clone(), Symbol::Circle).colored(MUTED);
        let outside = figure::Series::measured(tr!("outside the range of the fit"), self.outside.clone(), Symbol::Circle);
        let outside = outside.colored(color).faded(OUTSIDE);
        let all = [used, masked, outside].into_iter().zip([&self.used, &self.masked, &self.outside]);
        all.filter(|(_, points)| !points.is_empty()).map(|(series, _)| series)
    }
}

/// What is drawn of one measured θi.
#[derive(Debug, Clone, PartialEq)]
pub struct SeriesMarks {
    /// Its place among all series of the measurement.
    pub index: usize,
    pub name: String,
    pub ink: Rgb,
    pub dolp: DataPoints,
    pub brdf: DataPoints,
}

/// A term of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Term {
    Specular,
    Diffuse,
    Volume,
}

impl Term {
    /// Its name in plots.
    pub fn name(self) -> String {
        match self {
            Self::Specular => tr!("specular"),
            Self::Diffuse => tr!("diffuse"),
            Self::Volume => tr!("volume"),
        }
    }

    /// The colour of its lobe.
    pub fn ink(self) -> Rgb {
        SERIES[3 + self as usize]
    }
}

/// The model along one series.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelCurves {
    pub dolp: Polyline,
    pub limit: Polyline,
    pub total: Polyline,
    pub specular: Polyline,
    pub diffuse: Polyline,
    pub volume: Polyline,
    /// The specular share of the radiance, 0 to 1.
    pub share: Polyline,
}

/// A BRDF at θr (degrees) as it is drawn: times cos θr on demand, which is what a detector sees of
/// a spot that it looks at as a whole.
pub fn drawn_brdf(theta_r: f64, brdf: f64, times_cosine: bool) -> f64 {
    if times_cosine { brdf * Degrees(theta_r.abs()).sin_cos().1 } else { brdf }
}

/// What the curves depend on.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveKey {
    pub parameters: Parameters,
    pub model: Model,
    pub theta_i: f64,
    pub dphi: f64,
    /// Whether BRDFs are multiplied by cos θr.
    pub times_cosine: bool,
    /// Whether the backscatter side is drawn.
    pub backscatter: bool,
    pub plotted: u64,
}

impl CurveKey {
    pub fn new(work: &Workspace) -> Self {
        let (settings, surface, document) = (work.settings(), work.surface(), work.active());
        Self {
            parameters: surface.parameters,
            model: surface.model,
            theta_i: settings.theta_i,
            dphi: settings.dphi,
            times_cosine: settings.view_options.times_cosine,
            backscatter: settings.show_backscatter || work.measurements().shown().any(OpenMeasurement::has_backscatter),
            plotted: document.plotted,
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
    pub series: Vec<ModelCurves>,
    /// At the sliders' own θi and Δφ.
    pub own: ModelCurves,
    /// The series that has the sliders' own θi and Δφ.
    pub own_is_series: Option<usize>,
}

impl CurveSet {
    /// Without curves where the values mean no surface.
    pub fn new(key: &CurveKey, document: &OpenMeasurement) -> Self {
        let Ok(surface) = Pbrdf::new(key.model, key.parameters) else {
            return Self { series: drawn(document).map(|_| ModelCurves::default()).collect(), ..Self::default() };
        };
        let plane = key.dphi.rem_euclid(360.0);
        let own = IncidenceSeries { theta_i: key.theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() };
        let curves = |series: &IncidenceSeries| ModelCurves::new(&surface, series, key.backscatter, key.times_cosine);
        let series: Vec<ModelCurves> = drawn(document).map(curves).collect();
        let own_is_series = drawn(document).position(|series| series.theta_i == own.theta_i && series.plane == own.plane);
        let own = own_is_series.map_or_else(|| curves(&own), |index| series[index].clone());
        Self { series, own, own_is_series }
    }

    /// Those of every series, and the sliders' own.
    pub fn all(&self) -> impl Iterator<Item = &ModelCurves> {
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
    /// So many series of so many are drawn.
    Series { drawn: usize, of: usize },
}

impl Decimation {
    pub fn text(self) -> String {
        match self {
            Self::Points { step, of } => tr!("every {0}th of {1} points is drawn", step, of),
            Self::Series { drawn, of } => tr!("{0} of {1} angles of incidence are drawn", drawn, of),
        }
    }
}

impl MarkSet {
    pub fn new(document: &OpenMeasurement, times_cosine: bool, range: Option<FitRange>) -> Self {
        let total: usize = document.series.iter().map(|series| series.dolp.len() + series.brdf.len()).sum();
        let step = total.div_ceil(MOST_POINTS).max(1);
        let of = document.series.len();
        let series = document.drawn().iter().map(|&index| (index, &document.series[index]));
        let series = series.map(|(index, series)| SeriesMarks {
            index,
            name: series.name(),
            ink: series_ink(index, of),
            dolp: DataPoints::new(&series.dolp, step, |point| is_outside(range, series, point), |_, value| value),
            brdf: DataPoints::new(
                &series.brdf,
                step,
                |point| is_outside(range, series, point),
                |theta_r, value| drawn_brdf(theta_r, value, times_cosine),
            ),
        });
        let drawn = document.drawn().len();
        let left_out = match (of - drawn, step) {
            (0, 1) => None,
            (0, _) => Some(Decimation::Points { step, of: total }),
            _ => Some(Decimation::Series { drawn, of }),
        };
        Self { series: series.collect(), left_out }
    }
}

/// The title of a figure against θr: the active measurement, and how it is told from others.
pub fn figure_title(work: &Workspace) -> String {
    let title = work.active().title();
    let has_others = work.measurements().shown().any(|open| open.number != work.active().number && !open.series.is_empty());
    if has_others { tr!("{}: a colour for each θi; other measurements by their markers", title) } else { title }
}

/// Values of a curve that take part in choosing an axis.
pub fn axis_values(curve: &Polyline) -> impl Iterator<Item = f64> {
    finite(curve).filter(|[x, _]| x.abs() <= SETS_AXES).map(|[_, y]| y)
}

/// The series that are drawn.
pub fn drawn(document: &OpenMeasurement) -> impl Iterator<Item = &IncidenceSeries> {
    document.drawn().iter().filter_map(|&index| document.series.get(index))
}

impl ModelCurves {
    pub fn new(surface: &Pbrdf, series: &IncidenceSeries, backscatter: bool, times_cosine: bool) -> Self {
        let angles = directions(series.theta_i, backscatter);
        let at: Vec<(f64, Reflection, f64)> = angles
            .into_iter()
            .filter_map(|angle| {
                let facet = Facet::new(series.geometry(angle)?);
                Some((angle, surface.reflection(&facet), surface.fresnel_limit(&facet)))
            })
            .collect();
        let along = |is_there: bool, value: &dyn Fn(&(f64, Reflection, f64)) -> f64| -> Polyline {
            at.iter().filter(|_| is_there).map(|direction| [direction.0, value(direction)]).collect()
        };
        let brdf = |is_there, term: fn(&Reflection) -> f64| {
            along(is_there, &|(theta_r, reflection, _)| drawn_brdf(*theta_r, term(reflection), times_cosine))
        };
        let model = surface.model();
        Self {
            dolp: along(true, &|(_, reflection, _)| reflection.dolp),
            limit: along(model.specular, &|(.., limit)| *limit),
            total: brdf(true, |reflection| reflection.brdf),
            specular: brdf(model.specular, |reflection| reflection.specular),
            diffuse: brdf(model.diffuse != Diffuse::Absent, |reflection| reflection.diffuse),
            volume: brdf(model.volume, |reflection| reflection.volume),
            share: along(model.specular, &|(_, reflection, _)| reflection.specular / reflection.brdf),
        }
    }

    /// The terms that the model has.
    pub fn terms(&self) -> impl Iterator<Item = (Term, &Polyline)> {
        let terms = [(Term::Specular, &self.specular), (Term::Diffuse, &self.diffuse), (Term::Volume, &self.volume)];
        terms.into_iter().filter(|(_, curve)| !curve.is_empty())
    }
}
