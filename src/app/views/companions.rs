//! What is drawn beside the active measurement and its surface: the other measurements that are
//! shown, each with its own surface, and pinned surfaces, of which the last fit is one.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::FOREGROUND;
use crate::app::plots::{KeyEntry, Polyline, theme};
use crate::app::views::curves::{CurveKey, MOST_POINTS, drawn, drawn_brdf, is_fitted};
use crate::app::work::open_measurement::{DataPoint, IncidenceSeries, OpenMeasurement};
use crate::app::work::surface::PinnedSurface;
use crate::app::work::workspace::Workspace;
use crate::figure::{Dash, Point, Rgb, SERIES, Series, Symbol};
use egui_plot::LineStyle;
use pbrdf::fit::FitRange;
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Facet;
use std::collections::BTreeMap;
use tr::tr;

pub use crate::report::directions;

/// What is drawn beside the active measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CompanionId {
    /// An open measurement, by its number.
    Measurement(u64),
    /// The shown fit, where the sliders have left it.
    LastFit,
    /// A pinned surface, by its place.
    Pin(usize),
}

/// How it looks and what it is called.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    pub name: String,
    pub ink: Rgb,
    pub opacity: f64,
    /// Width of curves in points of paper.
    width: f64,
    dash: Dash,
    /// Of points and residuals.
    pub marker: Symbol,
}

/// A surface that is drawn beside that of the sliders.
#[derive(Debug, Clone, PartialEq)]
pub struct Pinned {
    pub id: CompanionId,
    pub look: Look,
    pub model: Model,
    pub parameters: Parameters,
}

/// The pinned surfaces that are shown, and before them the last fit where the sliders have left it.
pub fn pinned(work: &Workspace) -> Vec<Pinned> {
    let sliders = (work.surface().model, work.surface().parameters);
    let fit = work.shown_fit().map(|fit| (fit.report.model, fit.report.parameters)).filter(|fit| *fit != sliders);
    let last = fit.map(|(model, parameters)| Pinned { id: CompanionId::LastFit, look: Look::last_fit(), model, parameters });
    let pins = work.pinned().iter().enumerate().filter(|(_, pin)| pin.shown).map(|(place, pin)| Pinned {
        id: CompanionId::Pin(place),
        look: Look::of_pin(pin),
        model: pin.model,
        parameters: pin.parameters,
    });
    last.into_iter().chain(pins).collect()
}

impl Look {
    fn of_measurement(open: &OpenMeasurement) -> Self {
        let ink = SERIES[open.style.color % SERIES.len()];
        Self { name: open.title(), ink, opacity: QUIET, width: 0.7, dash: Dash::Solid, marker: open.style.marker }
    }

    /// The look of the last fit, also where nothing is drawn of it.
    pub fn last_fit() -> Self {
        Self { name: tr!("last fit"), ink: FOREGROUND, opacity: GHOST, width: 0.9, dash: Dash::Dotted, marker: Symbol::Circle }
    }

    fn of_pin(pin: &PinnedSurface) -> Self {
        let (name, ink) = (pin.name.clone(), SERIES[pin.color % SERIES.len()]);
        Self { name, ink, opacity: 1.0, width: 1.0, dash: Dash::Dashed, marker: Symbol::Circle }
    }

    /// A curve that looks so.
    pub fn stroke(&self, curve: Polyline) -> Series {
        Series::stroke(&self.name, curve, self.width, self.dash).colored(self.ink).faded(self.opacity)
    }

    /// The name of its curves over a plot.
    pub fn key_entry(&self, dark: bool) -> KeyEntry {
        #[expect(clippy::cast_possible_truncation, reason = "an opacity")]
        let color = theme::on_screen(self.ink, dark).gamma_multiply(self.opacity as f32);
        let style = match self.dash {
            Dash::Dashed => LineStyle::dashed_dense(),
            Dash::Dotted => LineStyle::dotted_dense(),
            Dash::Solid | Dash::Sparse => LineStyle::Solid,
        };
        KeyEntry { name: self.name.clone(), color, style, width: 1.5, symbol: None, on_map: false }
    }
}

/// What its curves and points depend on.
#[derive(Debug, Clone, PartialEq)]
struct Key {
    parameters: Parameters,
    model: Model,
    /// The state of the measurement.
    plotted: u64,
    times_cosine: bool,
    backscatter: bool,
    /// The angles that are fitted.
    range: Option<FitRange>,
    /// θi and plane of the sliders, of a surface.
    own: Option<(f64, f64)>,
}

/// What is drawn of it in one colour. Gaps lie between series.
#[derive(Debug, Clone, Default)]
pub struct Drawn {
    /// Along each series.
    pub dolp: Polyline,
    /// Along each series with a measured BRDF.
    pub brdf: Polyline,
    pub dolp_points: Vec<Point>,
    pub brdf_points: Vec<Point>,
    pub dolp_residuals: Vec<Residual>,
    pub brdf_residuals: Vec<Residual>,
}

/// Model less measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Degrees.
    pub theta_r: f64,
    pub value: f64,
    pub measured: f64,
    /// The stated standard deviation of the measured value, if it is above 0.
    pub sigma: Option<f64>,
}

impl Residual {
    /// As it is plotted: over its standard deviation on demand.
    pub fn place(&self, in_sigma: bool) -> [f64; 2] {
        [self.theta_r, self.value / self.sigma.filter(|_| in_sigma).unwrap_or(1.0)]
    }

    /// Over the measured value: of what spans decades.
    pub fn relative(&self) -> f64 {
        self.value / self.measured
    }
}

/// One of the companions.
#[derive(Clone, Copy)]
pub struct Companion<'a> {
    pub id: CompanionId,
    pub look: &'a Look,
    pub drawn: &'a Drawn,
}

/// The companions in the order of the list, each made anew when it is another one.
#[derive(Default)]
pub struct Companions {
    all: BTreeMap<CompanionId, (Look, Memo<Key, Drawn>)>,
    order: Vec<CompanionId>,
    made: Memo<Vec<(CompanionId, Look, u64)>, ()>,
}

/// Other measurements are quieter than the active one, and the last fit than the sliders.
const QUIET: f64 = 0.55;
const GHOST: f64 = 0.5;

impl Companions {
    /// Sees to it that they are those of the work, along θr as the curves of the sliders are.
    pub fn refresh(&mut self, work: &Workspace, curves: &CurveKey) {
        let active = work.active();
        let others = work.measurements().shown().filter(|open| open.number != active.number && !open.series.is_empty());
        let others = others.map(|open| {
            let (id, look) = (CompanionId::Measurement(open.number), Look::of_measurement(open));
            (Pinned { id, look, model: open.surface.model, parameters: open.surface.parameters }, open)
        });
        let all: Vec<(Pinned, &OpenMeasurement)> = others.chain(pinned(work).into_iter().map(|pin| (pin, active))).collect();
        self.order = all.iter().map(|(pin, _)| pin.id).collect();
        self.all.retain(|id, _| self.order.contains(id));
        for (Pinned { id, look, model, parameters }, open) in all {
            let own = (open.number == active.number).then_some((curves.theta_i, curves.dphi.rem_euclid(360.0)));
            let CurveKey { times_cosine, backscatter, .. } = *curves;
            let range = work.settings().fit_options.range;
            let key = Key { parameters, model, plotted: open.plotted, times_cosine, backscatter, range, own };
            let (kept, drawn) = self.all.entry(id).or_insert_with(|| (look.clone(), Memo::default()));
            *kept = look;
            drawn.refresh(key, |key| Drawn::new(key, open));
        }
        let made = self.order.iter().filter_map(|id| self.all.get(id).map(|(look, drawn)| (*id, look.clone(), drawn.stamp())));
        let made = made.collect();
        self.made.refresh(made, |_| ());
    }

    /// Another number whenever anything of them is drawn otherwise.
    pub fn stamp(&self) -> u64 {
        self.made.stamp()
    }

    pub fn iter(&self) -> impl Iterator<Item = Companion<'_>> {
        self.order.iter().filter_map(|id| {
            let (look, drawn) = self.all.get(id)?;
            Some(Companion { id: *id, look, drawn: drawn.get()? })
        })
    }
}

impl Drawn {
    fn new(key: &Key, open: &OpenMeasurement) -> Self {
        let surface = Pbrdf::new(key.model, key.parameters).ok();
        let mut all = Self::default();
        let total: usize = drawn(open).map(|series| series.dolp.len() + series.brdf.len()).sum();
        let step = total.div_ceil(MOST_POINTS).max(1);
        for series in drawn(open) {
            let used = |points: &[DataPoint]| points.iter().step_by(step).filter(|mark| !mark.masked).copied().collect::<Vec<_>>();
            let (dolp, brdf) = (used(&series.dolp), used(&series.brdf));
            if key.own.is_none() {
                all.dolp_points.extend(dolp.iter().map(|mark| point(mark, |value| value)));
                all.brdf_points.extend(brdf.iter().map(|mark| point(mark, |value| drawn_brdf(mark.theta_r, value, key.times_cosine))));
            }
            if let Some(surface) = &surface {
                let fitted = |points: Vec<DataPoint>| -> Vec<DataPoint> {
                    points.into_iter().filter(|point| is_fitted(key.range, series, point)).collect()
                };
                all.dolp_residuals.extend(residuals(series, &fitted(dolp), |facet| surface.dolp(facet)));
                all.brdf_residuals.extend(residuals(series, &fitted(brdf), |facet| surface.reflection(facet).brdf));
                let is_own = key.own == Some((series.theta_i, series.plane));
                all.add_curves(surface, series, key, [true, is_own || !series.brdf.is_empty()]);
            }
        }
        let is_there = |(theta_i, plane): &(f64, f64)| drawn(open).any(|series| (series.theta_i, series.plane) == (*theta_i, *plane));
        if let (Some((theta_i, plane)), Some(surface)) = (key.own.filter(|own| !is_there(own)), &surface) {
            let series = IncidenceSeries { theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() };
            all.add_curves(surface, &series, key, [true; 2]);
        }
        all
    }

    fn add_curves(&mut self, surface: &Pbrdf, series: &IncidenceSeries, key: &Key, [dolp, brdf]: [bool; 2]) {
        for theta_r in directions(series.theta_i, key.backscatter) {
            let Some(geometry) = series.geometry(theta_r) else { continue };
            let reflection = surface.reflection(&Facet::new(geometry));
            if dolp {
                self.dolp.push([theta_r, reflection.dolp]);
            }
            if brdf {
                self.brdf.push([theta_r, drawn_brdf(theta_r, reflection.brdf, key.times_cosine)]);
            }
        }
        self.dolp.extend(dolp.then_some([f64::NAN; 2]));
        self.brdf.extend(brdf.then_some([f64::NAN; 2]));
    }
}

fn point(mark: &DataPoint, place: impl Fn(f64) -> f64) -> Point {
    let (value, sigma) = (mark.quantity.value, mark.quantity.sigma);
    Point { x: mark.theta_r, y: place(value), bar: sigma.map(|sigma| (place(value - sigma), place(value + sigma))) }
}

/// Model less measurement at points of a series.
pub fn residuals(series: &IncidenceSeries, points: &[DataPoint], of_model: impl Fn(&Facet) -> f64) -> impl Iterator<Item = Residual> {
    points.iter().filter_map(move |mark| {
        let facet = Facet::new(series.geometry(mark.theta_r)?);
        let sigma = mark.quantity.sigma.filter(|sigma| *sigma > 0.0);
        let measured = mark.quantity.value;
        Some(Residual { theta_r: mark.theta_r, value: of_model(&facet) - measured, measured, sigma })
    })
}

impl Companion<'_> {
    fn series(&self, curve: &Polyline, points: &[Point]) -> Vec<Series> {
        let curve = (!curve.is_empty()).then(|| self.look.stroke(curve.clone()));
        curve.into_iter().chain(self.points(points.to_vec())).collect()
    }

    fn points(&self, points: Vec<Point>) -> Option<Series> {
        let Look { name, ink, opacity, marker, .. } = self.look;
        (!points.is_empty()).then(|| Series::measured(name, points, *marker).colored(*ink).faded(*opacity))
    }

    /// Its DoLP.
    pub fn dolp(&self) -> Vec<Series> {
        self.series(&self.drawn.dolp, &self.drawn.dolp_points)
    }

    /// Its BRDF; nothing of a measurement without one.
    pub fn brdf(&self) -> Vec<Series> {
        self.series(&self.drawn.brdf, &self.drawn.brdf_points)
    }

    /// Whether a BRDF is drawn of it.
    pub fn has_brdf(&self) -> bool {
        !self.drawn.brdf.is_empty()
    }

    /// What it misses of the points, each where `place` has it.
    pub fn residuals(&self, residuals: &[Residual], place: impl Fn(&Residual) -> [f64; 2]) -> Option<Series> {
        let points = residuals.iter().map(place).map(|[x, y]| Point { x, y, bar: None });
        self.points(points.collect())
    }

    /// Its name over a plot, with the marker of a measurement.
    pub fn key_entry(&self, dark: bool) -> KeyEntry {
        let symbol = matches!(self.id, CompanionId::Measurement(_)).then_some(self.look.marker);
        KeyEntry { symbol, ..self.look.key_entry(dark) }
    }
}
