//! What a fit is compared with: measured values, their weights, and prepared geometries.
//!
//! Objective (18): `ΔE = Σ (X − Xm)² / Σ Xm²` over all measured rows; with DoLP and BRDF both measured, the sum of both ΔE.
//! Every residual is divided by the root of its own Σ Xm², so that the sum of their squares *is* the objective. BRDF residuals may
//! instead be relative, (X − Xm)/Xm, or logarithmic, ln(X/Xm), divided by the root of their number: lobes span decades.
//! With stated standard deviations the residual is (X − Xm)/σ and the sum of squares is χ².

use crate::fit::options::{BrdfResiduals, FitOptions, Weights};
use crate::measurement::{Measurement, Quantity, Row};
use crate::model::{Batch, Radiances};
use std::sync::Arc;

/// A value whose standard deviation is needed and missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UnstatedSigma {
    /// Index of the row in the measurement.
    pub row: usize,
    /// `dolp` or `brdf`.
    pub quantity: &'static str,
}

/// 1/φ: its multiples are the most even sequence of one dimension.
const GOLDEN_RATIO: f64 = 0.618_033_988_749_894_8;

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Dolp,
    Brdf,
    LogBrdf,
}

impl Kind {
    /// 0 for DoLP, 1 for BRDF.
    pub(crate) fn block(self) -> usize {
        usize::from(self != Self::Dolp)
    }
}

/// One measured value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Datum {
    /// Index into the geometries.
    pub point: usize,
    pub kind: Kind,
    /// The value, or its logarithm.
    pub measured: f64,
    /// The residual is the difference times this.
    pub weight: f64,
}

impl Datum {
    /// The weighted difference of a predicted DoLP or BRDF from the measured value.
    pub(crate) fn residual(&self, predicted: f64) -> f64 {
        let predicted = if self.kind == Kind::LogBrdf { libm::log(predicted) } else { predicted };
        self.weight * (predicted - self.measured)
    }

    /// The derivative of that by the prediction.
    pub(crate) fn slope(&self, predicted: f64) -> f64 {
        if self.kind == Kind::LogBrdf { self.weight / predicted } else { self.weight }
    }

    /// The difference from the measured value, neither weighted nor of logarithms.
    fn difference(&self, predicted: f64) -> f64 {
        predicted - if self.kind == Kind::LogBrdf { libm::exp(self.measured) } else { self.measured }
    }
}

/// The data of a fit. All starts, profiles and subproblems of a fit share one.
#[derive(Debug, Clone)]
pub(crate) struct Observations {
    data: Vec<Datum>,
    batch: Arc<Batch>,
    /// Whether any DoLP and any BRDF is compared.
    has: [bool; 2],
    /// Σ Xm² of DoLP and of BRDF, where there are any.
    square_sums: [Option<f64>; 2],
    /// What the weight of DoLP and of BRDF residuals is multiplied by for Eq. (18); 1 where standard deviations weigh.
    scales: [f64; 2],
    left_out: usize,
}

/// ΔE of Eq. (18), given Σ (X − Xm)² and Σ Xm² of DoLP and of BRDF: of DoLP if measured, else of BRDF; with both, the sum.
pub(crate) fn delta_e(sums: [f64; 2], wholes: [Option<f64>; 2]) -> Option<f64> {
    let present = |block: usize| wholes[block].map(|whole| sums[block] / whole);
    match (present(0), present(1)) {
        (Some(dolp), Some(brdf)) => Some(dolp + brdf),
        (dolp, brdf) => dolp.or(brdf),
    }
}

impl Observations {
    /// Of the rows that are not masked and lie in the range of the options.
    pub(crate) fn new(measurement: &Measurement, options: &FitOptions) -> Result<Self, UnstatedSigma> {
        let is_fitted = |row: &Row| !row.masked && options.range.is_none_or(|range| range.contains(row.geometry));
        let rows = || measurement.rows.iter().enumerate().filter(|(_, row)| is_fitted(row));
        let mut observations = Self {
            data: Vec::new(),
            batch: Arc::new(Batch::new(rows().map(|(_, row)| row.geometry))),
            has: [false; 2],
            square_sums: [None; 2],
            scales: [1.0; 2],
            left_out: 0,
        };
        let brdf_kind = if options.brdf_residuals == BrdfResiduals::Log { Kind::LogBrdf } else { Kind::Brdf };
        for (point, (row, values)) in rows().enumerate() {
            if let Some(dolp) = values.dolp {
                observations.add(point, row, Kind::Dolp, dolp, options)?;
            }
            if let Some(brdf) = values.brdf.filter(|_| !options.dolp_only) {
                observations.add(point, row, brdf_kind, brdf, options)?;
            }
        }
        Self::normalise_together(std::slice::from_mut(&mut observations), options);
        Ok(observations)
    }

    fn add(&mut self, point: usize, row: usize, kind: Kind, quantity: Quantity, options: &FitOptions) -> Result<(), UnstatedSigma> {
        let value = quantity.value;
        *self.square_sums[kind.block()].get_or_insert(0.0) += value * value;
        let relative = kind == Kind::Brdf && options.brdf_residuals == BrdfResiduals::Relative;
        let by_sigma = options.weights == Weights::Sigma;
        if value == 0.0 && (kind == Kind::LogBrdf || (relative && !by_sigma)) {
            self.left_out += 1;
            return Ok(());
        }
        let quantity_name = if kind == Kind::Dolp { "dolp" } else { "brdf" };
        let sigma = match (by_sigma, quantity.sigma) {
            (false, _) => None,
            (true, Some(sigma)) => Some(sigma),
            (true, None) => return Err(UnstatedSigma { row, quantity: quantity_name }),
        };
        let (measured, weight) = match (kind, sigma) {
            // The standard deviation of ln X is σ/X.
            (Kind::LogBrdf, sigma) => (libm::log(value), sigma.map_or(1.0, |sigma| value / sigma)),
            (_, Some(sigma)) => (value, 1.0 / sigma),
            (_, None) => (value, if relative { 1.0 / value } else { 1.0 }),
        };
        self.data.push(Datum { point, kind, measured, weight });
        self.has[kind.block()] = true;
        Ok(())
    }

    /// Those of several measurements as one.
    pub(crate) fn concatenated(all: &[&Self]) -> Option<Self> {
        let mut whole = (*all.first()?).clone();
        let mut facets = Vec::new();
        whole.data.clear();
        for observations in all {
            let shifted = observations.data.iter().map(|datum| Datum { point: facets.len() + datum.point, ..*datum });
            whole.data.extend(shifted);
            facets.extend_from_slice(observations.batch.facets());
        }
        for other in &all[1..] {
            for block in [0, 1] {
                whole.has[block] |= other.has[block];
                whole.square_sums[block] = match (whole.square_sums[block], other.square_sums[block]) {
                    (Some(one), Some(other)) => Some(one + other),
                    (one, other) => one.or(other),
                };
            }
            whole.left_out += other.left_out;
        }
        Some(Self { batch: Arc::new(Batch::from_facets(facets)), ..whole })
    }

    /// Scales the residuals of each quantity by the root of what makes the sum of squares ΔE, Eq. (18), over the union of the rows.
    pub(crate) fn normalise_together(all: &mut [Self], options: &FitOptions) {
        if options.weights == Weights::Sigma {
            return;
        }
        for block in [0, 1] {
            let members = || all.iter().flat_map(|observations| &observations.data).filter(|datum| datum.kind.block() == block);
            #[expect(clippy::cast_precision_loss, reason = "a number of rows")]
            let count = members().count() as f64;
            let whole = if block == 0 || options.brdf_residuals == BrdfResiduals::Absolute {
                members().map(|datum| datum.measured * datum.measured).sum()
            } else {
                count
            };
            if whole > 0.0 {
                let scale = 1.0 / f64::sqrt(whole);
                all.iter_mut().for_each(|observations| observations.rescale(block, scale));
            }
        }
    }

    /// Scales the residuals of DoLP (0) or BRDF (1) by that number.
    fn rescale(&mut self, block: usize, scale: f64) {
        let change = scale / self.scales[block];
        self.data.iter_mut().filter(|datum| datum.kind.block() == block).for_each(|datum| datum.weight *= change);
        self.scales[block] = scale;
    }

    /// The same with each squared residual multiplied by that number.
    pub(crate) fn emphasised(&self, by: f64) -> Self {
        let mut emphasised = self.clone();
        emphasised.data.iter_mut().for_each(|datum| datum.weight *= by.sqrt());
        emphasised
    }

    /// The measured values, those of one geometry side by side.
    pub(crate) fn data(&self) -> &[Datum] {
        &self.data
    }

    /// The prepared geometries of the rows that are not masked.
    pub(crate) fn batch(&self) -> &Batch {
        &self.batch
    }

    /// What the residuals of DoLP and of BRDF are multiplied by for Eq. (18).
    pub(crate) fn scales(&self) -> [f64; 2] {
        self.scales
    }

    /// Measured values that the chosen residuals cannot use.
    pub(crate) fn left_out(&self) -> usize {
        self.left_out
    }

    /// Whether any DoLP is compared.
    pub(crate) fn has_dolp(&self) -> bool {
        self.has[0]
    }

    /// Whether any BRDF is compared.
    pub(crate) fn has_brdf(&self) -> bool {
        self.has[1]
    }

    /// Σ Xm² of DoLP (0) or BRDF (1), where it is above 0.
    pub(crate) fn square_sum(&self, block: usize) -> Option<f64> {
        self.square_sums[block].filter(|&sum| sum > 0.0)
    }

    /// Σ (X − Xm)² of DoLP and of BRDF, given both at each geometry.
    pub(crate) fn misfit_sums(&self, predicted: &Radiances) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for datum in &self.data {
            let column = if datum.kind == Kind::Dolp { &predicted.dolp } else { &predicted.brdf };
            let difference = datum.difference(column[datum.point]);
            sums[datum.kind.block()] += difference * difference;
        }
        sums
    }

    /// ΔE of Eq. (18), given DoLP and BRDF at each geometry: of DoLP if measured, else of BRDF; with both, the sum.
    pub(crate) fn delta_e(&self, predicted: &Radiances) -> Option<f64> {
        let wholes = [self.square_sum(0), self.square_sum(1).filter(|_| self.has_brdf())];
        delta_e(self.misfit_sums(predicted), wholes)
    }

    /// About so many of the values, one of each of as many equal parts of the list, at a place that a low-discrepancy sequence picks: no
    /// stride that could meet the period of a grid of angles.
    pub(crate) fn thinned(&self, most: usize) -> Self {
        let step = self.data.len().div_ceil(most).max(1);
        #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in a part")]
        let place = |part: usize| part * step + ((part as f64 * GOLDEN_RATIO).fract() * step as f64) as usize;
        let places = (0..self.data.len().div_ceil(step)).map(place).filter(|&i| i < self.data.len());
        let facets = self.batch.facets();
        let mut data: Vec<Datum> = places.map(|i| self.data[i]).collect();
        let batch = Batch::from_facets(data.iter().map(|datum| facets[datum.point]).collect());
        data.iter_mut().enumerate().for_each(|(point, datum)| datum.point = point);
        let has = [0, 1].map(|block| data.iter().any(|datum| datum.kind.block() == block));
        Self { data, batch: Arc::new(batch), has, ..*self }
    }

    /// Indices of geometries with their measured DoLP (0) or BRDF (1), evenly picked where there are more than `most`; zeros of DoLP
    /// too, but not of the BRDF, whose differences are relative.
    pub(crate) fn rows(&self, block: usize, most: usize) -> Vec<(usize, f64)> {
        let value = |datum: &Datum| if datum.kind == Kind::LogBrdf { libm::exp(datum.measured) } else { datum.measured };
        let rows = || self.data.iter().filter(|datum| datum.kind.block() == block && (block == 0 || value(datum) > 0.0));
        let step = rows().count().div_ceil(most).max(1);
        rows().step_by(step).map(|datum| (datum.point, value(datum))).collect()
    }

    /// Those residuals by quantity: of DoLP, of BRDF.
    pub(crate) fn by_block(&self, residuals: &[f64]) -> [Vec<f64>; 2] {
        [0, 1].map(|block| {
            let of_block = residuals.iter().zip(&self.data).filter(|(_, datum)| datum.kind.block() == block);
            of_block.map(|(residual, _)| *residual).collect()
        })
    }

    /// Other data on the same geometries: each value becomes what was predicted less `widen` times a residual drawn from those of its
    /// quantity by `pick` (an index below its argument), given the residuals of the prediction.
    pub(crate) fn resampled(&self, residuals: &[f64], widen: f64, pick: &mut dyn FnMut(usize) -> usize) -> Self {
        let mut data = self.data.clone();
        for block in [0, 1] {
            let members: Vec<usize> = (0..data.len()).filter(|&i| data[i].kind.block() == block).collect();
            for &i in &members {
                let drawn = residuals[members[pick(members.len())]];
                let datum = &mut data[i];
                datum.measured += (residuals[i] + widen * drawn) / datum.weight;
            }
        }
        Self { data, batch: self.batch.clone(), ..*self }
    }
}
