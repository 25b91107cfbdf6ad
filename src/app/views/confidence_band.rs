//! The confidence band of a fit as it is drawn: one standard error of the curve to either side.

use crate::app::views::curves::{directions, drawn, drawn_brdf};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::open_measurement::{IncidenceSeries, OpenMeasurement};
use crate::app::work::workspace::Workspace;
use pbrdf::fit::FitResult;
use pbrdf::model::{DolpFormula, Pbrdf};
use pbrdf::optics::Facet;
use tr::tr;

/// What a band depends on: the fit by its number in the session, the document, whether the
/// backscatter side is drawn, whether the BRDF is multiplied by cos θr. None where there is no
/// band.
pub type BandKey = Option<(usize, u64, bool, bool)>;

/// A curve's band: θr, low and high; not finite where the data leave the curve open.
pub type Band = Vec<[f64; 3]>;

/// The key of the fit's band, if it is of the open measurement and to be shown.
pub fn band_key(fit: Option<&FitEntry>, document: &OpenMeasurement, backscatter: bool, times_cosine: bool, shown: bool) -> BandKey {
    let fit = fit.filter(|fit| shown && fit.number == document.number)?;
    Some((fit.id, document.plotted, backscatter, times_cosine))
}

/// What the band of a series is called in a figure: as its curve, while that is the fitted one.
pub fn band_name(work: &Workspace, series: &str) -> String {
    let surface = work.surface();
    let is_fitted = work.shown_fit().is_some_and(|fit| (fit.report.model, fit.report.parameters) == (surface.model, surface.parameters));
    if is_fitted { series.to_owned() } else { tr!("± 1 standard error of the last fit") }
}

/// Around the fitted DoLP along each series.
pub fn dolp_bands(report: &FitResult, document: &OpenMeasurement, backscatter: bool) -> Vec<Band> {
    // By either formula no DoLP is below 0; as printed it may exceed 1.
    let most = if report.model.dolp_formula == DolpFormula::Consistent { 1.0 } else { f64::MAX };
    along_series(report, document, backscatter, |surface, facets, _| {
        let errors = report.band.dolp(facets);
        let ends = |(facet, error): (&Facet, Option<f64>)| {
            let value = surface.dolp(facet);
            error.map(|error| ((value - error).max(0.0), (value + error).min(most)))
        };
        facets.iter().zip(errors).map(ends).collect()
    })
}

/// Around the fitted BRDF along each series.
pub fn brdf_bands(report: &FitResult, document: &OpenMeasurement, backscatter: bool, times_cosine: bool) -> Vec<Band> {
    along_series(report, document, backscatter, |surface, facets, angles| {
        let errors = report.band.brdf(facets);
        let ends = |((facet, angle), error): ((&Facet, &f64), Option<f64>)| {
            let value = surface.reflection(facet).brdf;
            let place = |brdf| drawn_brdf(*angle, brdf, times_cosine);
            error.map(|error| (place((value - error).max(0.0)), place(value + error)))
        };
        facets.iter().zip(angles).zip(errors).map(ends).collect()
    })
}

/// Ends of the band at each direction; none where it is open.
type Ends = Vec<Option<(f64, f64)>>;

fn along_series(
    report: &FitResult,
    document: &OpenMeasurement,
    backscatter: bool,
    ends: impl Fn(&Pbrdf, &[Facet], &[f64]) -> Ends,
) -> Vec<Band> {
    let Ok(surface) = Pbrdf::new(report.model, report.parameters) else { return Vec::new() };
    let band = |series: &IncidenceSeries| {
        let at = directions(series.theta_i, backscatter).into_iter();
        let (angles, facets): (Vec<f64>, Vec<Facet>) = at.filter_map(|angle| Some((angle, Facet::new(series.geometry(angle)?)))).unzip();
        let ends = ends(&surface, &facets, &angles);
        let open = (f64::NAN, f64::NAN);
        let place = |(angle, ends): (&f64, Option<(f64, f64)>)| {
            let (low, high) = ends.unwrap_or(open);
            [*angle, low, high]
        };
        angles.iter().zip(ends).map(place).collect()
    };
    drawn(document).map(band).collect()
}
