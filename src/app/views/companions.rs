//! What is drawn beside the active measurement and its surface: the other measurements that are
//! shown, each with its own surface.

use crate::app::jobs::memo::Memo;
use crate::app::plots::{KeyEntry, Polyline, theme};
use crate::app::views::curves::{CurveKey, MOST_POINTS, drawn, drawn_brdf};
use crate::app::work::open_measurement::{DataPoint, IncidenceSeries, OpenMeasurement};
use crate::app::work::workspace::Workspace;
use crate::figure::{Dash, Point, Rgb, SERIES, Series, Symbol};
use egui_plot::LineStyle;
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Facet;
use std::collections::BTreeMap;

pub use crate::report::directions;

/// What is drawn beside the active measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CompanionId {
    /// An open measurement, by its number.
    Measurement(u64),
}

/// How it looks and what it is called.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    pub name: String,
    pub ink: Rgb,
    pub marker: Symbol,
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
    /// The stated standard deviation of the measured value, if it is above 0.
    pub sigma: Option<f64>,
}

impl Residual {
    /// As it is plotted: over its standard deviation on demand.
    pub fn place(&self, in_sigma: bool) -> [f64; 2] {
        [self.theta_r, self.value / self.sigma.filter(|_| in_sigma).unwrap_or(1.0)]
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

/// Quieter than the active measurement: width of curves in points of paper, and opacity.
const WIDTH: f64 = 0.7;
const QUIET: f64 = 0.55;

impl Companions {
    /// Sees to it that they are those of the work, along θr as the curves of the sliders are.
    pub fn refresh(&mut self, work: &Workspace, curves: &CurveKey) {
        let active = work.active().number;
        let others = work.measurements().iter().filter(|open| open.number != active && open.style.shown);
        let others: Vec<&OpenMeasurement> = others.filter(|open| !open.series.is_empty()).collect();
        self.order = others.iter().map(|open| CompanionId::Measurement(open.number)).collect();
        self.all.retain(|id, _| self.order.contains(id));
        for open in others {
            let look = Look { name: open.title(), ink: SERIES[open.style.color % SERIES.len()], marker: open.style.marker };
            let key = Key {
                parameters: open.surface.parameters,
                model: open.surface.model,
                plotted: open.plotted,
                times_cosine: curves.times_cosine,
                backscatter: curves.backscatter,
            };
            let (kept, drawn) = self.all.entry(CompanionId::Measurement(open.number)).or_insert_with(|| (look.clone(), Memo::default()));
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
            all.dolp_points.extend(dolp.iter().map(|mark| point(mark, |value| value)));
            all.brdf_points.extend(brdf.iter().map(|mark| point(mark, |value| drawn_brdf(mark.theta_r, value, key.times_cosine))));
            if let Some(surface) = &surface {
                all.dolp_residuals.extend(residuals(series, &dolp, |facet| surface.dolp(facet)));
                all.brdf_residuals.extend(residuals(series, &brdf, |facet| surface.reflection(facet).brdf));
                all.add_curves(surface, series, key);
            }
        }
        all
    }

    fn add_curves(&mut self, surface: &Pbrdf, series: &IncidenceSeries, key: &Key) {
        for theta_r in directions(series.theta_i, key.backscatter) {
            let Some(geometry) = series.geometry(theta_r) else { continue };
            let reflection = surface.reflection(&Facet::new(geometry));
            self.dolp.push([theta_r, reflection.dolp]);
            if !series.brdf.is_empty() {
                self.brdf.push([theta_r, drawn_brdf(theta_r, reflection.brdf, key.times_cosine)]);
            }
        }
        self.dolp.push([f64::NAN; 2]);
        self.brdf.push([f64::NAN; 2]);
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
        Some(Residual { theta_r: mark.theta_r, value: of_model(&facet) - mark.quantity.value, sigma })
    })
}

impl Companion<'_> {
    fn series(&self, curve: &Polyline, points: &[Point]) -> Vec<Series> {
        let Look { name, ink, marker } = self.look;
        let curve = Series::stroke(name, curve.clone(), WIDTH, Dash::Solid);
        let points = (!points.is_empty()).then(|| Series::measured(name, points.to_vec(), *marker));
        [curve].into_iter().chain(points).map(|series| series.colored(*ink).faded(QUIET)).collect()
    }

    /// Its DoLP.
    pub fn dolp(&self) -> Vec<Series> {
        self.series(&self.drawn.dolp, &self.drawn.dolp_points)
    }

    /// Its BRDF; nothing where none was measured.
    pub fn brdf(&self) -> Vec<Series> {
        if self.has_brdf() { self.series(&self.drawn.brdf, &self.drawn.brdf_points) } else { Vec::new() }
    }

    /// Whether a BRDF is drawn of it.
    pub fn has_brdf(&self) -> bool {
        !self.drawn.brdf_points.is_empty()
    }

    /// What its points miss.
    pub fn residuals(&self, residuals: &[Residual], in_sigma: bool) -> Option<Series> {
        let points: Vec<Point> =
            residuals.iter().map(|residual| residual.place(in_sigma)).map(|[x, y]| Point { x, y, bar: None }).collect();
        let series = Series::measured(&self.look.name, points, self.look.marker).colored(self.look.ink).faded(QUIET);
        (!residuals.is_empty()).then_some(series)
    }

    /// Its name over a plot.
    pub fn key_entry(&self, dark: bool) -> KeyEntry {
        let color = theme::on_screen(self.look.ink, dark);
        let name = self.look.name.clone();
        KeyEntry { name, color, style: LineStyle::Solid, width: 1.2, symbol: Some(self.look.marker), on_map: false }
    }
}
