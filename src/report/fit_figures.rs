//! The figures of a fit: DoLP with its residuals, and the BRDF.

use crate::figure::{Axis, Dash, Figure, Panel, Point, Rgb, SERIES, Series, Symbol};
use crate::report::curves::{CurvePoint, curve};
use pbrdf::measurement::{DataPoint, IncidenceSeries};
use pbrdf::model::Pbrdf;
use pbrdf::optics::Facet;

/// Largest number of series: more cannot be told apart.
pub(super) const MOST_SERIES: usize = SERIES.len();
/// Largest number of points of one series and quantity.
const MOST_POINTS: usize = 2000;
/// Largest θr in degrees at which curves count for the range of an axis: a Minnaert lobe diverges at
/// the horizon.
const SETS_AXES: f64 = 80.0;
/// Largest number of decades of a logarithmic axis.
const DECADES: f64 = 8.0;
/// Ratio of largest to smallest measured BRDF above which its axis is logarithmic.
const SPANS_DECADES: f64 = 1e3;
/// Masked points.
const MUTED: Rgb = Rgb(150, 150, 150);

/// A surface drawn along measured series.
pub struct FitFigures<'a> {
    surface: &'a Pbrdf,
    series: &'a [IncidenceSeries],
    backscatter: bool,
    curves: Vec<Vec<CurvePoint>>,
}

/// Name of a term, whether it is there, its value, and the number of its colour.
type Term = (&'static str, bool, fn(&CurvePoint) -> f64, usize);

/// What is taken from a measured series.
type Marks = fn(&IncidenceSeries) -> &[DataPoint];

impl<'a> FitFigures<'a> {
    /// Of a surface along those series.
    #[must_use]
    pub fn new(surface: &'a Pbrdf, series: &'a [IncidenceSeries]) -> Self {
        let series = &series[..series.len().min(MOST_SERIES)];
        let backscatter = series.iter().any(IncidenceSeries::has_backscatter);
        let curves = series.iter().map(|group| curve(surface, group, backscatter)).collect();
        Self { surface, series, backscatter, curves }
    }

    fn theta_r(&self) -> Axis {
        Axis::linear("θr", "°").between(if self.backscatter { -90.0 } else { 0.0 }, 90.0)
    }

    /// Series with their curves and colours.
    fn colored(&self) -> impl Iterator<Item = (&IncidenceSeries, &[CurvePoint], Rgb)> {
        self.series.iter().zip(&self.curves).zip(SERIES).map(|((group, curve), color)| (group, curve.as_slice(), color))
    }

    /// DoLP against θr with the Fresnel limit, and the residuals below; none without a measured DoLP.
    #[must_use]
    pub fn dolp(&self, title: &str) -> Option<Figure> {
        let marks: Marks = |group| &group.dolp;
        let measured: f64 = self.series.iter().flat_map(marks).map(top).fold(0.0, f64::max);
        let has_points = self.series.iter().any(|group| !group.dolp.is_empty());
        let has_limit = self.surface.model().specular;
        let mut series = Vec::new();
        let mut residuals = vec![Series::level("", 0.0).colored(MUTED)];
        let mut highest = measured;
        for (group, curve, color) in self.colored().filter(|(group, ..)| !group.dolp.is_empty()) {
            let dolp = |point: &CurvePoint| point.reflection.dolp;
            if has_limit {
                series.push(Series::dashed("Fresnel limit", points(curve, |point| point.limit), Dash::Dashed).colored(color));
                highest = highest.max(highest_of(curve, |point| point.limit));
            }
            highest = highest.max(highest_of(curve, dolp));
            series.push(Series::line(group.name(), points(curve, dolp)).colored(color));
            series.extend(measured_series(group, marks(group), color));
            residuals.push(Series::measured("", self.residuals(group), Symbol::Disc).colored(color));
        }
        let above = |panel: Panel| Panel { x: self.theta_r(), ..panel };
        let panels = vec![
            above(Panel { y: Axis::linear("DoLP", "").between(0.0, 1.05 * highest), series, height_share: 2.6, ..Panel::default() }),
            above(Panel { y: Axis::linear("model − measured", ""), series: residuals, legend: false, ..Panel::default() }),
        ];
        has_points.then(|| Figure { title: title.to_owned(), panels, height_mm: 130.0, ..Figure::default() })
    }

    fn residuals(&self, group: &IncidenceSeries) -> Vec<Point> {
        let used = thinned(&group.dolp).filter(|mark| !mark.masked);
        let residual = |mark: &DataPoint| {
            let facet = Facet::new(group.geometry(mark.theta_r)?);
            let y = self.surface.reflection(&facet).dolp - mark.quantity.value;
            Some(Point { x: mark.theta_r, y, bar: mark.quantity.sigma.map(|sigma| (y - sigma, y + sigma)) })
        };
        used.filter_map(residual).collect()
    }

    /// BRDF against θr: measured and fitted where it is measured, else the lobes along the first series.
    #[must_use]
    pub fn brdf(&self, title: &str) -> Option<Figure> {
        let values = || self.series.iter().flat_map(|group| &group.brdf).map(|mark| mark.quantity.value).filter(|&value| value > 0.0);
        let is_measured = self.series.iter().any(|group| !group.brdf.is_empty());
        let log = values().fold(0.0, f64::max) > SPANS_DECADES * values().fold(f64::INFINITY, f64::min);
        let mut series = Vec::new();
        let mut highest = values().fold(0.0, f64::max);
        if is_measured {
            for (group, curve, color) in self.colored().filter(|(group, ..)| !group.brdf.is_empty()) {
                series.push(Series::line(group.name(), points(curve, |point| point.reflection.brdf)).colored(color));
                series.extend(measured_series(group, &group.brdf, color));
                highest = highest.max(highest_of(curve, |point| point.reflection.brdf));
            }
        } else {
            let curve = self.curves.first()?;
            highest = highest_of(curve, |point| point.reflection.brdf);
            series = self.lobes(curve);
        }
        let axis = if log { Axis::log("BRDF", "sr⁻¹") } else { Axis::linear("BRDF", "sr⁻¹") };
        let low = if log { (0.5 * values().fold(f64::INFINITY, f64::min)).max(highest * libm::exp10(-DECADES)) } else { 0.0 };
        let y = axis.between(low, if log { 2.0 } else { 1.05 } * highest);
        let panel = Panel { x: self.theta_r(), y, series, ..Panel::default() };
        Some(Figure { title: title.to_owned(), panels: vec![panel], height_mm: 95.0, ..Figure::default() })
    }

    fn lobes(&self, curve: &[CurvePoint]) -> Vec<Series> {
        let model = self.surface.model();
        let mut series = vec![Series::line("total", points(curve, |point| point.reflection.brdf)).colored(Rgb(20, 20, 20))];
        let terms: [Term; 3] = [
            ("specular", model.specular, |point| point.reflection.specular, 3),
            ("diffuse", model.diffuse != pbrdf::model::Diffuse::Absent, |point| point.reflection.diffuse, 4),
            ("volume", model.volume, |point| point.reflection.volume, 5),
        ];
        for (name, _, value, color) in terms.into_iter().filter(|(_, is_there, ..)| *is_there) {
            series.push(Series::dashed(name, points(curve, value), Dash::Solid).colored(SERIES[color]));
        }
        series
    }
}

pub(super) fn points(curve: &[CurvePoint], value: impl Fn(&CurvePoint) -> f64) -> Vec<[f64; 2]> {
    curve.iter().map(|point| [point.theta_r, value(point)]).collect()
}

pub(super) fn highest_of(curve: &[CurvePoint], value: impl Fn(&CurvePoint) -> f64) -> f64 {
    curve.iter().filter(|point| point.theta_r.abs() <= SETS_AXES).map(value).filter(|value| value.is_finite()).fold(0.0, f64::max)
}

/// Upper end of an error bar.
pub(super) fn top(mark: &DataPoint) -> f64 {
    mark.quantity.value + mark.quantity.sigma.unwrap_or(0.0)
}

fn thinned(marks: &[DataPoint]) -> impl Iterator<Item = &DataPoint> {
    marks.iter().step_by(marks.len().div_ceil(MOST_POINTS).max(1))
}

/// Points with error bars, and the masked ones hollow and grey.
pub(super) fn measured_series(group: &IncidenceSeries, marks: &[DataPoint], color: Rgb) -> Vec<Series> {
    let of = |masked: bool| -> Vec<Point> {
        let marks = thinned(marks).filter(|mark| mark.masked == masked);
        let point = |mark: &DataPoint| {
            let y = mark.quantity.value;
            Point { x: mark.theta_r, y, bar: mark.quantity.sigma.map(|sigma| (y - sigma, y + sigma)) }
        };
        marks.map(point).collect()
    };
    let used = Series::measured(group.name(), of(false), Symbol::Disc).colored(color);
    let masked = of(true);
    let masked = (!masked.is_empty()).then(|| Series::measured("masked", masked, Symbol::Circle).colored(MUTED));
    [used].into_iter().chain(masked).collect()
}
