//! Bands of draws from the posterior along each series: what the central 68 and 95 % of all surfaces would show.

use crate::app::jobs::async_memo::{AsyncMemo, Stopped};
use crate::app::jobs::memo::Memo;
use crate::app::views::confidence_band::Band;
use crate::app::views::context::Cx;
use crate::app::views::curves::{directions, drawn, drawn_brdf};
use crate::app::work::open_measurement::IncidenceSeries;
use crate::app::work::posterior::DrawnPosterior;
use crate::figure::{Rgb, Series};
use pbrdf::fit::posterior::quantile;
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Facet;
use std::sync::Arc;
use tr::tr;

/// What is along the axis of a plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BandQuantity {
    Dolp,
    /// Multiplied by cos θr or not.
    Brdf {
        times_cosine: bool,
    },
}

/// Which draws, of which state of which measurement, whether the backscatter side is drawn, of which quantity.
type Key = (u64, u64, u64, bool, BandQuantity);

/// Of each series, the bands of 68 and of 95 %.
type Bands = Vec<[Band; 2]>;

/// Bands that a pane keeps; a job makes them.
#[derive(Default)]
pub struct PosteriorBands {
    job: AsyncMemo<Key, Arc<Bands>>,
    shown: Memo<Option<Key>, Arc<Bands>>,
}

/// Draws that bands are made of, evenly picked.
const MOST_DRAWS: usize = 400;
/// Shares of the draws that a band leaves out below it and above it.
const TAILS: [f64; 2] = [0.16, 0.025];
/// Opacity of a band beside that of a confidence band.
const OPACITY: [f64; 2] = [0.9, 0.55];

impl PosteriorBands {
    /// Sees to it that the bands are of the draws of the active measurement, where they are to be drawn.
    pub fn refresh(&mut self, cx: &Cx<'_>, backscatter: bool, quantity: BandQuantity, is_shown: bool) {
        let document = cx.work.active();
        let drawn_posterior = cx.work.posterior().filter(|_| is_shown && cx.work.settings().panes.posterior.bands);
        let place = drawn_posterior.and_then(|posterior| posterior.place_of(document.number));
        let Some((posterior, place)) = drawn_posterior.zip(place) else {
            self.shown.refresh(None, |_| Arc::default());
            return;
        };
        let key = (posterior.stamp, document.number, document.plotted, backscatter, quantity);
        let series: Vec<IncidenceSeries> = drawn(document).cloned().collect();
        let about = posterior.clone();
        self.job.refresh(&cx.jobs.spawner, &key, move |stopped| Arc::new(bands(&about, place, &series, backscatter, quantity, stopped)));
        // Those of before stay until others are there, but not those of another measurement.
        let made = self.job.key().copied().filter(|made| (made.1, made.2) == (key.1, key.2));
        let bands = self.job.get().filter(|_| made.is_some()).cloned().unwrap_or_default();
        self.shown.refresh(made, |_| bands);
    }

    /// Another number for other bands.
    pub fn stamp(&self) -> u64 {
        self.shown.stamp()
    }

    /// Whether there is one.
    pub fn is_there(&self) -> bool {
        self.shown.get().is_some_and(|bands| !bands.is_empty())
    }

    /// The bands of a series, the wider one first.
    pub fn series(&self, index: usize, color: Rgb) -> Vec<Series> {
        let Some(bands) = self.shown.get().and_then(|bands| bands.get(index)) else { return Vec::new() };
        bands
            .iter()
            .zip(OPACITY)
            .rev()
            .map(|(band, opacity)| Series::band(band_name(), band.clone()).colored(color).faded(opacity))
            .collect()
    }
}

/// What they are called.
pub fn band_name() -> String {
    tr!("draws: 68 and 95 %")
}

fn bands(
    posterior: &DrawnPosterior,
    place: usize,
    series: &[IncidenceSeries],
    backscatter: bool,
    quantity: BandQuantity,
    stopped: Stopped<'_>,
) -> Bands {
    let step = posterior.draws.len().div_ceil(MOST_DRAWS).max(1);
    let draws: Vec<Parameters> = posterior.draws.draws().step_by(step).map(|draw| draw.parameters[place]).collect();
    let mut bands = Vec::new();
    for of in series {
        if stopped() {
            break;
        }
        bands.push(along(&draws, posterior.draws.model, of, backscatter, quantity));
    }
    bands
}

/// Around what the draws show along one series.
fn along(draws: &[Parameters], model: Model, series: &IncidenceSeries, backscatter: bool, quantity: BandQuantity) -> [Band; 2] {
    let at = directions(series.theta_i, backscatter).into_iter();
    let (angles, facets): (Vec<f64>, Vec<Facet>) = at.filter_map(|angle| Some((angle, Facet::new(series.geometry(angle)?)))).unzip();
    let mut values: Vec<Vec<f64>> = vec![Vec::with_capacity(draws.len()); facets.len()];
    for surface in draws.iter().filter_map(|parameters| Pbrdf::new(model, *parameters).ok()) {
        for ((of, facet), angle) in values.iter_mut().zip(&facets).zip(&angles) {
            of.push(match quantity {
                BandQuantity::Dolp => surface.dolp(facet),
                BandQuantity::Brdf { times_cosine } => drawn_brdf(*angle, surface.reflection(facet).brdf, times_cosine),
            });
        }
    }
    values.iter_mut().for_each(|of| of.sort_by(f64::total_cmp));
    let ends = |of: &Vec<f64>, tail: f64| if of.is_empty() { [f64::NAN; 2] } else { [quantile(of, tail), quantile(of, 1.0 - tail)] };
    TAILS.map(|tail| {
        let point = |(angle, of): (&f64, &Vec<f64>)| {
            let [low, high] = ends(of, tail);
            [*angle, low, high]
        };
        angles.iter().zip(&values).map(point).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::{BandQuantity, along};
    use pbrdf::measurement::IncidenceSeries;
    use pbrdf::model::{Model, Parameters, Pbrdf};
    use pbrdf::optics::Facet;

    #[test]
    fn a_band_lies_around_its_draws_and_the_wider_one_around_the_narrower() {
        let draws: Vec<Parameters> = (0..50).map(|i| Parameters { n: 1.5 + 0.01 * f64::from(i), ..Parameters::default() }).collect();
        let data = pbrdf::Measurement::read(&b"theta_i,theta_r,dolp\n40,30,0.1\n40,50,0.2\n"[..]).expect("a measurement");
        let series = IncidenceSeries::of(&data.rows).remove(0);
        let [narrow, wide] = along(&draws, Model::CAUCHY, &series, false, BandQuantity::Dolp);
        let middle = Pbrdf::new(Model::CAUCHY, draws[25]).expect("a surface");
        for (inner, outer) in narrow.iter().zip(&wide) {
            let value = middle.dolp(&Facet::new(series.geometry(inner[0]).expect("a direction")));
            assert!(outer[1] <= inner[1] && inner[1] <= value && value <= inner[2] && inner[2] <= outer[2], "{inner:?} {outer:?} {value}");
        }
    }
}
