//! What the window shows and does not compute while it draws: curves, points, ranges, ΔE.
//!
//! Each part is kept with the inputs that it was made from, and made anew only when they differ.

use super::document::{Document, Mark, Series};
use super::problem::{dolp_gain, problem};
use super::state::Settings;
use egui_plot::PlotPoint;
use pbrdf::fit::{Choices, Eq17, Loss, OpenDirection, Problem, Uncertainty, Weights};
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters, Pbrdf, Reflection};
use pbrdf::optics::Facet;

/// Curves that are drawn at most, and points: more cannot be told apart, and would make the window slow.
pub const MOST_SERIES: usize = 12;
pub const MOST_POINTS: usize = 20_000;

/// A curve in pieces: a value that is not finite ends one.
pub type Pieces = Vec<Vec<PlotPoint>>;

/// A measured value with the ends of its error bar, in plot coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    pub x: f64,
    pub low: f64,
    pub high: f64,
}

/// Measured points of one series and quantity.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Marks {
    pub used: Vec<PlotPoint>,
    pub masked: Vec<PlotPoint>,
    pub bars: Vec<Bar>,
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
    pub dolp: Pieces,
    pub limit: Pieces,
    pub total: Pieces,
    pub specular: Pieces,
    pub diffuse: Pieces,
    pub volume: Pieces,
}

/// Ends of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
}

#[derive(Debug, Clone, PartialEq)]
struct CurveKey {
    parameters: Parameters,
    model: Model,
    theta_i: f64,
    dphi: f64,
    log_brdf: bool,
    backscatter: bool,
    eq17: Eq17,
    generation: u64,
}

/// Everything derived.
#[derive(Default)]
pub struct Derived {
    marks_key: Option<(u64, bool)>,
    curve_key: Option<CurveKey>,
    problem_key: Option<(u64, Model, Eq17)>,
    problem: Option<Problem>,
    /// Points of each series.
    pub marks: Vec<SeriesMarks>,
    /// Model along each series.
    pub series: Vec<Curves>,
    /// Model at the sliders' own θi and Δφ, unless a series is there already.
    pub own: Curves,
    /// DoLP of the last fit along each series, where the sliders have left it.
    pub ghost: Vec<Pieces>,
    ghost_key: Option<(Parameters, Model, Eq17, u64, bool)>,
    /// DoLP of the model less the measured one, of each series; masked points left out.
    pub residuals: Vec<Vec<PlotPoint>>,
    /// The series that has the sliders' own θi and Δφ.
    pub own_is_series: Option<usize>,
    pub x: Option<Range>,
    pub dolp_range: Option<Range>,
    pub brdf_range: Option<Range>,
    /// None where no DoLP was measured.
    pub residual_range: Option<Range>,
    /// ΔE of the sliders.
    pub delta_e: Option<f64>,
    /// What the open data determine at the sliders, while that is on screen.
    pub outlook: Option<Outlook>,
    outlook_key: Option<(Parameters, Model, ParameterSet, u64, Choices)>,
    /// Series and points that are not drawn.
    pub left_out: Option<String>,
    /// Why there is no curve.
    pub fault: Option<String>,
}

/// Decades below its top that a logarithmic axis shows at most.
const DECADES: f64 = 8.0;

/// Up to this θr, in degrees, curves take part in choosing the axes.
const SETS_AXES: f64 = 80.0;

impl Derived {
    /// Makes anew what has other inputs than before. While `dragging`, axes grow but do not shrink.
    pub fn refresh(&mut self, settings: &Settings, document: &Document, dragging: bool) {
        let marks_key = (document.generation, settings.log_brdf);
        let marks_changed = self.marks_key != Some(marks_key);
        if marks_changed {
            self.marks_key = Some(marks_key);
            self.refresh_marks(settings, document);
        }
        let key = CurveKey {
            parameters: settings.parameters,
            model: settings.model,
            theta_i: settings.theta_i,
            dphi: settings.dphi,
            log_brdf: settings.log_brdf,
            backscatter: settings.show_backscatter || document.has_backscatter(),
            eq17: settings.choices.eq17,
            generation: document.generation,
        };
        if self.curve_key.as_ref() != Some(&key) {
            self.refresh_curves(settings, document, key.backscatter);
            self.refresh_delta_e(settings, document);
            self.refresh_residuals(settings, document);
            self.curve_key = Some(key);
            self.refresh_ranges(settings, dragging && !marks_changed);
        } else if !dragging {
            self.refresh_ranges(settings, false);
        }
    }

    /// Keeps the curves of the last fit, as long as the sliders are elsewhere.
    pub fn refresh_ghost(&mut self, settings: &Settings, document: &Document, fitted: Option<(Parameters, Model, Eq17)>) {
        let backscatter = settings.show_backscatter || document.has_backscatter();
        let key = fitted
            .filter(|(parameters, ..)| *parameters != settings.parameters)
            .map(|(parameters, model, eq17)| (parameters, model, eq17, document.generation, backscatter));
        if self.ghost_key != key {
            let surface = key.and_then(|(parameters, model, eq17, ..)| Some((Pbrdf::new(model, parameters).ok()?, eq17)));
            let curves = |(surface, eq17): (Pbrdf, Eq17)| {
                drawn(document).map(|series| Curves::new(&surface, eq17, series, backscatter, false).dolp).collect()
            };
            self.ghost = surface.map_or_else(Vec::new, curves);
            self.ghost_key = key;
        }
    }

    /// Looks ahead: what would a fit from here determine? Only while somebody looks at it.
    pub fn refresh_outlook(&mut self, settings: &Settings, document: &Document, free: ParameterSet, is_shown: bool) {
        let key = is_shown.then_some((settings.parameters, settings.model, free, document.generation, settings.choices));
        if self.outlook_key != key {
            self.outlook_key = key;
            self.outlook = key.and_then(|_| Outlook::new(settings, document, free));
        }
    }

    fn refresh_marks(&mut self, settings: &Settings, document: &Document) {
        let total: usize = document.series.iter().map(|series| series.dolp.len() + series.brdf.len()).sum();
        let step = total.div_ceil(MOST_POINTS).max(1);
        let identity = |value: f64| Some(value);
        let brdf = |value: f64| brdf_coordinate(value, settings.log_brdf);
        self.marks = drawn(document)
            .map(|series| SeriesMarks {
                name: series.name(),
                dolp: marks(&series.dolp, step, identity),
                brdf: marks(&series.brdf, step, brdf),
            })
            .collect();
        let hidden = document.series.len().saturating_sub(MOST_SERIES);
        self.left_out = match (hidden, step) {
            (0, 1) => None,
            (0, _) => Some(format!("every {step}th of {total} points is drawn")),
            _ => Some(format!("{MOST_SERIES} of {} angles of incidence are drawn", document.series.len())),
        };
    }

    fn refresh_curves(&mut self, settings: &Settings, document: &Document, backscatter: bool) {
        self.x = Some(Range { low: if backscatter { -90.0 } else { 0.0 }, high: 90.0 });
        let surface = match Pbrdf::new(settings.model, settings.parameters) {
            Ok(surface) => surface,
            Err(error) => {
                self.fault = Some(format!("{error}."));
                self.series = vec![Curves::default(); self.marks.len()];
                self.own = Curves::default();
                return;
            }
        };
        self.fault = None;
        let plane = settings.dphi.rem_euclid(360.0);
        let own = Series { theta_i: settings.theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() };
        let curves = |series: &Series| Curves::new(&surface, settings.choices.eq17, series, backscatter, settings.log_brdf);
        self.series = drawn(document).map(curves).collect();
        self.own_is_series = drawn(document).position(|series| series.theta_i == own.theta_i && series.plane == own.plane);
        self.own = match self.own_is_series {
            Some(index) => self.series[index].clone(),
            None => curves(&own),
        };
    }

    fn refresh_delta_e(&mut self, settings: &Settings, document: &Document) {
        let key = (document.generation, settings.model, settings.choices.eq17);
        if self.problem_key != Some(key) {
            self.problem_key = Some(key);
            // Of a fit's choices the reading of Eq. (17) alone matters to ΔE.
            let choices = Choices { eq17: settings.choices.eq17, ..Choices::default() };
            self.problem = problem(settings, &document.measurement, settings.model, ParameterSet::EMPTY, choices).ok();
        }
        self.delta_e = self.problem.as_ref().and_then(|problem| problem.delta_e(&settings.parameters));
    }

    fn refresh_residuals(&mut self, settings: &Settings, document: &Document) {
        self.residuals.clear();
        let Ok(surface) = Pbrdf::new(settings.model, settings.parameters) else { return };
        let gain = dolp_gain(settings.choices.eq17, &settings.parameters);
        for series in drawn(document) {
            let step = series.dolp.len().div_ceil(MOST_POINTS / MOST_SERIES).max(1);
            let used = series.dolp.iter().step_by(step).filter(|mark| !mark.masked);
            let residual = |mark: &Mark| {
                let facet = Facet::new(series.geometry(mark.theta_r)?);
                Some(PlotPoint::new(mark.theta_r, gain * surface.dolp(&facet) - mark.quantity.value))
            };
            self.residuals.push(used.filter_map(residual).collect());
        }
        let largest = self.residuals.iter().flatten().map(|point| point.y.abs()).fold(0.0, f64::max);
        self.residual_range = (largest > 0.0).then(|| Range { low: -round_up(largest), high: round_up(largest) });
    }

    fn refresh_ranges(&mut self, settings: &Settings, only_grow: bool) {
        // A Minnaert lobe has no bound at the horizon: what lies beyond does not set an axis.
        let values = |pieces: &Pieces| -> Vec<f64> {
            pieces.iter().flatten().filter(|point| point.x.abs() <= SETS_AXES).map(|point| point.y).collect()
        };
        let all = || self.series.iter().chain([&self.own]);
        let limit = |curves: &Curves| if settings.show_limit { values(&curves.limit) } else { Vec::new() };
        let dolp_top = all().flat_map(|curves| [values(&curves.dolp), limit(curves)]).flatten();
        let dolp_top = dolp_top.chain(self.marks.iter().flat_map(|marks| marks.dolp.bars.iter().map(|bar| bar.high))).fold(0.0, f64::max);
        // Only what the plot of the lobes shows.
        let measured = self.series.iter().zip(&self.marks).filter(|(_, marks)| marks.brdf.is_there()).map(|(curves, _)| curves);
        let brdf = measured.chain([&self.own]).flat_map(|curves| values(&curves.total));
        let brdf: Vec<f64> = brdf.chain(self.marks.iter().flat_map(|marks| marks.brdf.used.iter().map(|point| point.y))).collect();
        let top = brdf.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let brdf_range = if settings.log_brdf {
            let bottom = brdf.iter().copied().fold(f64::INFINITY, f64::min);
            let high = if top.is_finite() { (top + 0.1).ceil() } else { 1.0 };
            Range { low: bottom.floor().clamp(high - DECADES, high - 1.0), high }
        } else {
            Range { low: 0.0, high: round_up(top) }
        };
        let grown = |old: Option<Range>, new: Range| match old.filter(|_| only_grow) {
            Some(old) => Range { low: old.low.min(new.low), high: old.high.max(new.high) },
            None => new,
        };
        self.dolp_range = Some(grown(self.dolp_range, Range { low: 0.0, high: round_up(dolp_top).min(1.05) }));
        self.brdf_range = Some(grown(self.brdf_range, brdf_range));
    }
}

/// What data would determine, seen from the sliders before any fit.
pub struct Outlook {
    /// Standard error of each free parameter; none where it would stay open.
    pub errors: Vec<(Parameter, Option<f64>)>,
    pub open: Vec<OpenDirection>,
    /// Whether the errors come from stated standard deviations rather than from the present misfit.
    pub from_stated: bool,
}

impl Outlook {
    fn new(settings: &Settings, document: &Document, free: ParameterSet) -> Option<Self> {
        let parameters = settings.parameters;
        let with = |weights| {
            let choices = Choices { weights, loss: Loss::Linear, ..settings.choices };
            problem(settings, &document.measurement, settings.model, free, choices).ok()
        };
        let stated = with(Weights::Sigma);
        let from_stated = stated.is_some();
        let problem = stated.or_else(|| with(Weights::None))?;
        let misfit = problem.sum_of_squares(&parameters)?;
        let uncertainty = Uncertainty::at(&problem, &parameters, misfit, ParameterSet::EMPTY);
        let errors = free.iter().map(|parameter| (parameter, uncertainty.standard_error(parameter))).collect();
        Some(Self { errors, open: uncertainty.open, from_stated })
    }
}

/// The series that are drawn.
fn drawn(document: &Document) -> impl Iterator<Item = &Series> {
    document.series.iter().take(MOST_SERIES)
}

/// The next of 1, 1.5, 2, 3, 5, 7.5 times a power of ten with some air above the value.
fn round_up(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let value = 1.04 * value;
    let decade = libm::exp10(libm::log10(value).floor());
    [1.0, 1.5, 2.0, 3.0, 5.0, 7.5, 10.0].into_iter().map(|step| step * decade).find(|&top| top >= value).unwrap_or(value)
}

/// A BRDF as its plot has it; none where a logarithm does not exist.
fn brdf_coordinate(value: f64, log: bool) -> Option<f64> {
    let y = if log { libm::log10(value) } else { value };
    y.is_finite().then_some(y)
}

fn marks(measured: &[Mark], step: usize, coordinate: impl Fn(f64) -> Option<f64>) -> Marks {
    let mut marks = Marks::default();
    for mark in measured.iter().step_by(step) {
        let Some(y) = coordinate(mark.quantity.value) else { continue };
        let points = if mark.masked { &mut marks.masked } else { &mut marks.used };
        points.push(PlotPoint::new(mark.theta_r, y));
        if let Some(sigma) = mark.quantity.sigma {
            let high = coordinate(mark.quantity.value + sigma).unwrap_or(y);
            // A bar that reaches 0 or below ends beneath any logarithmic axis.
            let low = coordinate(mark.quantity.value - sigma).unwrap_or(y - 2.0 * DECADES);
            marks.bars.push(Bar { x: mark.theta_r, low, high });
        }
    }
    marks
}

/// Signed θr of a curve: every half degree, and ever closer around the mirror direction, where lobes are narrow.
fn directions(theta_i: f64, backscatter: bool) -> Vec<f64> {
    let first = if backscatter { -179 } else { 0 };
    let mut angles: Vec<f64> = (first..180).map(|half| 0.5 * f64::from(half)).collect();
    angles.push(89.9);
    if backscatter {
        angles.push(-89.9);
    }
    let near = (0..48).map(|i| 0.002 * libm::pow(1.18, f64::from(i)));
    angles.extend(near.flat_map(|offset| [theta_i - offset, theta_i + offset]).chain([theta_i]));
    angles.retain(|angle| angle.abs() < 90.0 && (backscatter || *angle >= 0.0));
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

impl Curves {
    fn new(surface: &Pbrdf, eq17: Eq17, series: &Series, backscatter: bool, log: bool) -> Self {
        let gain = dolp_gain(eq17, surface.parameters());
        let angles = directions(series.theta_i, backscatter);
        let at: Vec<(f64, Reflection, f64)> = angles
            .into_iter()
            .filter_map(|angle| {
                let facet = Facet::new(series.geometry(angle)?);
                Some((angle, surface.reflection(&facet), surface.fresnel_limit(&facet)))
            })
            .collect();
        let brdf =
            |value: fn(&Reflection) -> f64| pieces(at.iter().map(|(x, reflection, _)| (*x, brdf_coordinate(value(reflection), log))));
        let model = surface.model();
        Self {
            dolp: pieces(at.iter().map(|(x, reflection, _)| (*x, Some(gain * reflection.dolp)))),
            limit: if model.specular { pieces(at.iter().map(|(x, _, limit)| (*x, Some(*limit)))) } else { Pieces::new() },
            total: brdf(|reflection| reflection.brdf),
            specular: if model.specular { brdf(|reflection| reflection.specular) } else { Pieces::new() },
            diffuse: if model.diffuse == pbrdf::model::Diffuse::Absent { Pieces::new() } else { brdf(|reflection| reflection.diffuse) },
            volume: if model.volume { brdf(|reflection| reflection.volume) } else { Pieces::new() },
        }
    }
}

fn pieces(points: impl Iterator<Item = (f64, Option<f64>)>) -> Pieces {
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
