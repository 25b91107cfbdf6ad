//! The corner plot of draws: every parameter by itself with its prior behind, and every pair.

use crate::figure::{Axis, ColorMap, Dash, Figure, HeatMap, Heights, Panel, Point, Rgb, SERIES, Series, Symbol};
use pbrdf::fit::posterior::{BoundedPrior, PosteriorSample, quantile};
use pbrdf::fit::{Estimate, UnknownName};

/// What the fit says of a parameter, to be drawn in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedMark {
    /// In the parameter's unit.
    pub value: f64,
    /// Ends of the interval at 68.3 %; none where it is open.
    pub interval: [Option<f64>; 2],
}

impl FittedMark {
    /// Of an estimate of a fit.
    #[must_use]
    pub fn new(estimate: &Estimate) -> Self {
        let interval = estimate.interval68.map_or([None; 2], |interval| [interval.low, interval.high]);
        Self { value: estimate.value, interval }
    }
}

/// A corner plot: its figure, and which parameter each of its rows and columns is.
#[derive(Debug, Clone, PartialEq)]
pub struct CornerFigure {
    /// The parameters in both directions, row by row; the places above the diagonal are blank.
    pub figure: Figure,
    /// Places of the parameters among the free ones.
    pub shown: Vec<usize>,
    /// Ends of their axes.
    pub ranges: Vec<[f64; 2]>,
}

/// Share of the draws that an axis leaves out at either end.
const TAIL: f64 = 0.002;
/// Air beside what is drawn, as a fraction of it.
const AIR: f64 = 0.06;
/// Inks: of what the fit says, of lines on a map, of priors, of frames.
const MARK: Rgb = Rgb(235, 50, 60);
const WHITE: Rgb = Rgb(255, 255, 255);
const MUTED: Rgb = Rgb(150, 150, 150);
const FOREGROUND: Rgb = Rgb(20, 20, 20);
/// Cells of a histogram, and of a map along a side.
const BINS: usize = 40;
const CELLS: usize = 36;
/// Shares of the draws inside the lines on a map.
const INSIDE: [f64; 2] = [0.683, 0.95];
/// What a map leaves blank: cells with less than this share of the highest one.
const BLANK: f64 = 0.004;
/// Where the interval of the fit is drawn, as a fraction of the height.
const FOOT: f64 = 0.04;
/// Room above the highest bar.
const TOP: f64 = 1.12;
/// Side of a panel in a file, in millimetres, and room for the outer axes.
const SIDE_MM: f64 = 27.0;
const RIM_MM: f64 = 16.0;

impl CornerFigure {
    /// Of the free parameters at those places; `fitted` are what a fit says of each free parameter.
    #[must_use]
    pub fn new<N: UnknownName, P>(
        draws: &PosteriorSample<N, P>,
        priors: &[BoundedPrior],
        shown: Vec<usize>,
        fitted: &[Option<FittedMark>],
        title: String,
    ) -> Self {
        let values_of = |unknown: usize| draws.draws().map(|draw| draw.unknowns[unknown]).collect();
        let values: Vec<Vec<f64>> = shown.iter().map(|&unknown| values_of(unknown)).collect();
        let ranges: Vec<[f64; 2]> = shown.iter().zip(&values).map(|(&unknown, of)| range(of, priors[unknown])).collect();
        let unknowns: Vec<&N> = shown.iter().map(|&unknown| &draws.parameters[unknown]).collect();
        let count = shown.len();
        let panel = |row: usize, column: usize| {
            let (x, y) = (&ranges[column], &ranges[row]);
            let fits = [fitted[shown[column]], fitted[shown[row]]];
            let rim = |is_outer: bool, of: usize| is_outer.then(|| unknowns[of]);
            match row.cmp(&column) {
                std::cmp::Ordering::Less => Panel::default(),
                std::cmp::Ordering::Equal => {
                    let series = marginal(&values[row], *x, priors[shown[row]], fits[0]);
                    let y = Axis { ticks: Some(Vec::new()), ..Axis::linear(if row == 0 { unknowns[0].symbol() } else { "".into() }, "") };
                    Panel { x: axis(rim(row + 1 == count, column), *x), y: y.between(0.0, TOP), series, legend: false, ..Panel::default() }
                }
                std::cmp::Ordering::Greater => {
                    let series = pair([&values[column], &values[row]], [*x, *y], fits);
                    let x = axis(rim(row + 1 == count, column), *x);
                    Panel { x, y: axis(rim(column == 0, row), *y), series, legend: false, ..Panel::default() }
                }
            }
        };
        let panels = (0..count * count).map(|i| panel(i / count, i % count)).collect();
        #[expect(clippy::cast_precision_loss, reason = "a handful of panels")]
        let side = RIM_MM + SIDE_MM * count.max(2) as f64;
        Self {
            figure: Figure { title, panels, columns: count.max(1), width_mm: side, height_mm: side, ..Figure::default() },
            shown,
            ranges,
        }
    }
}

/// An axis, named with numbers if it stands at the rim.
fn axis<N: UnknownName>(of: Option<&N>, [low, high]: [f64; 2]) -> Axis {
    let named = of.map(|unknown| Axis::linear(unknown.symbol(), unknown.parameter().unit()));
    named.unwrap_or_else(|| Axis { ticks: Some(Vec::new()), ..Axis::linear("", "") }).between(low, high)
}

/// Where the draws are, within the ends of the prior.
fn range(values: &[f64], prior: BoundedPrior) -> [f64; 2] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (low, high) = (quantile(&sorted, TAIL), quantile(&sorted, 1.0 - TAIL));
    let air = if high > low { AIR * (high - low) } else { AIR * low.abs().max(1e-6) };
    let (least, most) = prior.ends();
    // A little beyond a bound, so that draws that lie on it are seen.
    [(low - air).max(least - 0.5 * air), (high + air).min(most + 0.5 * air)]
}

/// The cell that a value lies in, of so many between those ends.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "a small number of cells")]
fn cell(value: f64, [low, high]: [f64; 2], count: usize) -> Option<usize> {
    let at = (value - low) / (high - low) * count as f64;
    (at >= 0.0 && at < count as f64).then_some(at as usize)
}

/// Borders of the cells between those ends.
#[expect(clippy::cast_precision_loss, reason = "a small number of cells")]
fn edges([low, high]: [f64; 2], count: usize) -> Vec<f64> {
    (0..=count).map(|i| low + (high - low) * i as f64 / count as f64).collect()
}

/// One parameter: how often each value was drawn, relative to the most frequent, with the prior in the same unit.
#[expect(clippy::cast_precision_loss, reason = "numbers of draws")]
fn marginal(values: &[f64], range: [f64; 2], prior: BoundedPrior, fit: Option<FittedMark>) -> Vec<Series> {
    let mut counts = [0.0; BINS];
    values.iter().filter_map(|value| cell(*value, range, BINS)).for_each(|bin| counts[bin] += 1.0);
    let most = counts.iter().copied().fold(1.0, f64::max);
    let borders = edges(range, BINS);
    let bars = || counts.iter().zip(borders.windows(2)).map(|(count, ends)| (count / most, ends));
    let filled = bars().flat_map(|(height, ends)| [[ends[0], 0.0, height], [ends[1], 0.0, height]]).collect();
    let outline = bars().flat_map(|(height, ends)| [[ends[0], height], [ends[1], height]]).collect();
    // Draws per unit of the parameter at the highest bar.
    let unit = values.len().max(1) as f64 * (borders[1] - borders[0]) / most;
    let before = edges(range, 4 * BINS).into_iter().map(|at| [at, (prior.density(at) * unit).min(2.0 * TOP)]).collect();
    let mut series = vec![
        Series::band("", filled).colored(SERIES[0]),
        Series::dashed("", before, Dash::Dashed).colored(MUTED),
        Series::stroke("", outline, 0.8, Dash::Solid).colored(SERIES[0]),
    ];
    if let Some(FittedMark { value, interval: [low, high] }) = fit {
        let ends = [low.unwrap_or(range[0]), high.unwrap_or(range[1])].map(|end| end.clamp(range[0], range[1]));
        series.push(Series::stroke("", vec![[ends[0], FOOT], [ends[1], FOOT]], 1.6, Dash::Solid).colored(MARK));
        series.push(Series::stroke("", vec![[value, 0.0], [value, TOP]], 0.7, Dash::Solid).colored(MARK));
    }
    series
}

/// Two parameters: how often each pair was drawn, and what holds 68 and 95 % of the draws.
fn pair([x, y]: [&[f64]; 2], [across, up]: [[f64; 2]; 2], fits: [Option<FittedMark>; 2]) -> Vec<Series> {
    let mut counts = vec![0.0; CELLS * CELLS];
    for (a, b) in x.iter().zip(y) {
        if let (Some(column), Some(row)) = (cell(*a, across, CELLS), cell(*b, up, CELLS)) {
            counts[row * CELLS + column] += 1.0;
        }
    }
    let density = smoothed(&counts);
    let most = density.iter().copied().fold(0.0, f64::max);
    let shown = density.iter().map(|value| if *value > BLANK * most { value / most } else { f64::NAN }).collect();
    let (x_edges, y_edges) = (edges(across, CELLS), edges(up, CELLS));
    let map = HeatMap {
        x_edges: x_edges.clone(),
        y_edges: y_edges.clone(),
        values: shown,
        color_axis: Axis::default().between(0.0, 1.0),
        colors: ColorMap::Sequential,
    };
    let mut series = vec![Series::heat_map(map)];
    for level in levels(&density) {
        let lines = Heights { values: &density, columns: CELLS }.lines(level);
        let place = |(column, row): (f64, f64)| [between(&x_edges, column), between(&y_edges, row)];
        let points = lines.into_iter().flat_map(|line| line.into_iter().map(place).chain([[f64::NAN; 2]])).collect();
        series.push(Series::stroke("", points, 0.6, Dash::Solid).colored(WHITE));
    }
    if let [Some(one), Some(other)] = fits {
        let at = Point { x: one.value, y: other.value, bar: None };
        let is_inside = |value: f64, [low, high]: [f64; 2]| (low..=high).contains(&value);
        if is_inside(at.x, across) && is_inside(at.y, up) {
            series.push(Series::measured("", vec![at], Symbol::Cross).colored(MARK));
        }
    }
    // A map without a frame of its own would float on the page.
    series.push(Series::stroke("", frame(across, up), 0.4, Dash::Solid).colored(FOREGROUND));
    series
}

fn frame([left, right]: [f64; 2], [bottom, top]: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]]
}

/// The middle of a cell, by its place counted from the middle of the first.
fn between(borders: &[f64], place: f64) -> f64 {
    let step = borders[1] - borders[0];
    borders[0] + (place + 0.5) * step
}

/// Twice the mean with weights 1, 2, 1 along both sides: what is left of the noise of counts is narrower than a contour.
fn smoothed(counts: &[f64]) -> Vec<f64> {
    let pass = |values: &[f64], step: usize, place: &dyn Fn(usize) -> usize| -> Vec<f64> {
        let of = |i: usize| {
            let before = if place(i) > 0 { values[i - step] } else { values[i] };
            let after = if place(i) + 1 < CELLS { values[i + step] } else { values[i] };
            0.25 * before + 0.5 * values[i] + 0.25 * after
        };
        (0..values.len()).map(of).collect()
    };
    (0..2).fold(counts.to_vec(), |values, _| {
        let across = pass(&values, 1, &|i| i % CELLS);
        pass(&across, CELLS, &|i| i / CELLS)
    })
}

/// The densities above which those shares of all draws lie.
fn levels(density: &[f64]) -> Vec<f64> {
    let mut sorted = density.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let all: f64 = sorted.iter().sum();
    let level = |share: f64| {
        let mut inside = 0.0;
        sorted.iter().copied().find(|value| {
            inside += value;
            inside >= share * all
        })
    };
    INSIDE.iter().filter_map(|share| level(*share)).filter(|level| *level > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::{CELLS, INSIDE, cell, levels, smoothed};

    #[test]
    fn smoothing_loses_no_draw_and_lines_hold_their_shares() {
        // Squares of different heights: 4 cells of 100, 60 of 10.
        let mut counts = vec![0.0; CELLS * CELLS];
        (0..64).for_each(|i| counts[(10 + i / 8) * CELLS + 10 + i % 8] = if i < 4 { 100.0 } else { 10.0 });
        let smooth = smoothed(&counts);
        assert!((smooth.iter().sum::<f64>() - counts.iter().sum::<f64>()).abs() < 1e-9);
        for (level, share) in levels(&smooth).into_iter().zip(INSIDE) {
            let inside: f64 = smooth.iter().filter(|value| **value >= level).sum();
            // Up to the one cell that the share ends in, or cells of equal height.
            assert!(inside >= share * 1000.0 && inside < share * 1000.0 + 45.0, "{share}: {inside}");
        }
    }

    #[test]
    fn what_lies_outside_of_an_axis_is_in_no_cell() {
        let ends = [1.0, 3.0];
        assert_eq!([0.99, 1.0, 2.99, 3.0, f64::NAN].map(|value| cell(value, ends, 2)), [None, Some(0), Some(1), None, None]);
    }
}
