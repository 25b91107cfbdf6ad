//! The confidence band of a fit as it is drawn: one standard error of the curve to either side.

use crate::app::plots::Ribbon;
use crate::app::views::curves::{BrdfScale, DECADES, directions, drawn};
use crate::app::work::document::{Document, IncidenceSeries};
use crate::app::work::fit_history::FitEntry;
use pbrdf::fit::FitResult;
use pbrdf::model::{DolpFormula, Pbrdf};
use pbrdf::optics::Facet;

/// What a band depends on: the fit by its number in the session, the document, whether the backscatter side is drawn, how the BRDF is
/// drawn. None where there is no band.
pub type BandKey = Option<(usize, u64, bool, BrdfScale)>;

/// A curve's band in pieces: where the data leave the curve open there is none.
pub type Ribbons = Vec<Ribbon>;

/// The key of the fit's band, if it is of the open measurement and to be shown.
pub fn band_key(fit: Option<&FitEntry>, document: &Document, backscatter: bool, scale: BrdfScale, shown: bool) -> BandKey {
    let fit = fit.filter(|fit| shown && fit.number == document.number)?;
    Some((fit.id, document.generation, backscatter, scale))
}

/// Around the fitted DoLP along each series.
pub fn dolp_bands(report: &FitResult, document: &Document, backscatter: bool) -> Vec<Ribbons> {
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
pub fn brdf_bands(report: &FitResult, document: &Document, backscatter: bool, scale: BrdfScale) -> Vec<Ribbons> {
    along_series(report, document, backscatter, |surface, facets, angles| {
        let errors = report.band.brdf(facets);
        let ends = |((facet, angle), error): ((&Facet, &f64), Option<f64>)| {
            let value = surface.reflection(facet).brdf;
            let high = scale.coordinate(*angle, value + error?)?;
            // A band that reaches 0 ends beneath any logarithmic axis.
            let low = scale.coordinate(*angle, (value - error?).max(0.0)).unwrap_or(high - 2.0 * DECADES);
            Some((low, high))
        };
        facets.iter().zip(angles).zip(errors).map(ends).collect()
    })
}

/// Ends of the band at each direction; none where it is open.
type Ends = Vec<Option<(f64, f64)>>;

fn along_series(
    report: &FitResult,
    document: &Document,
    backscatter: bool,
    ends: impl Fn(&Pbrdf, &[Facet], &[f64]) -> Ends,
) -> Vec<Ribbons> {
    let Ok(surface) = Pbrdf::new(report.model, report.parameters) else { return Vec::new() };
    let ribbons = |series: &IncidenceSeries| {
        let at = directions(series.theta_i, backscatter).into_iter();
        let (angles, facets): (Vec<f64>, Vec<Facet>) = at.filter_map(|angle| Some((angle, Facet::new(series.geometry(angle)?)))).unzip();
        in_pieces(&angles, &ends(&surface, &facets, &angles))
    };
    drawn(document).map(ribbons).collect()
}

/// Splits a band where it is open or not finite.
fn in_pieces(angles: &[f64], ends: &Ends) -> Ribbons {
    let mut pieces = vec![Ribbon::default()];
    for (angle, ends) in angles.iter().zip(ends) {
        match (ends.filter(|(low, high)| low.is_finite() && high.is_finite()), pieces.last_mut()) {
            (Some((low, high)), Some(piece)) => piece.push(*angle, low, high),
            (None, Some(piece)) if !piece.is_empty() => pieces.push(Ribbon::default()),
            _ => {}
        }
    }
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

#[cfg(test)]
mod tests {
    use super::in_pieces;

    #[test]
    fn a_band_is_split_where_it_is_open() {
        let ends = [Some((0.0, 1.0)), Some((0.0, 2.0)), None, Some((f64::NAN, 1.0)), Some((1.0, 3.0))];
        let pieces = in_pieces(&[1.0, 2.0, 3.0, 4.0, 5.0], &ends.to_vec());
        assert_eq!(pieces.iter().map(|piece| piece.x.clone()).collect::<Vec<_>>(), [vec![1.0, 2.0], vec![5.0]]);
        assert_eq!(pieces[1].high, [3.0]);
    }
}
