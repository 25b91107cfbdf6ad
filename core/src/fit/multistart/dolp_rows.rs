//! DoLP under one specular lobe, linearised in k_d and k_v, for many pairs of a diffuse and a volume lobe at once.
//!
//! `1/X = (1 + g)/L` with the Fresnel limit L and `g = (k_d F^d + k_v F^v)/(k_s F^s)` is linear in k_d and k_v; linearised about X₀,
//! `X − Xm = X₀ − Xm − (X₀²/L)(g − g₀)`. Pairs lie in the lanes of a vector; [`BoxLeastSquares`] is the scalar form of the same.

use crate::fit::multistart::box_least_squares::{BoxLeastSquares, SINGULAR};
use crate::model::Radiances;
use crate::model::batch::lanes::{Instructions, V, Vectorised, choose, dispatch, number};
use crate::model::batch::prepared::LANES;
use fearless_simd::prelude::*;

/// A lobe of unit weight, or of its weight where that is not fitted: for each shape its value on each row, relative to the measured value
/// where that is a BRDF.
pub(crate) type LobeColumns = Vec<Vec<f64>>;
/// A number for each pair of a block.
type Lanes = [f64; LANES];
/// Above this, squares of a row's coefficients come near the end of f64.
const FAINT: f64 = 1e100;

/// The weights in the box that bring the linearised rows nearest to what is measured, and Σ (X − Xm)² there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Solved {
    pub kd: f64,
    pub kv: f64,
    pub misfit: f64,
}

/// Each diffuse lobe with each volume lobe, the volume lobes running fastest: blocks of pairs, row after row.
pub(crate) struct LobePairs {
    count: usize,
    /// Of each row of each block the diffuse and the volume lobe.
    rows: Vec<[Lanes; 2]>,
}

impl LobePairs {
    /// Places of the last block that are left over repeat the last pair.
    pub(crate) fn new(diffuse: &LobeColumns, volume: &LobeColumns) -> Self {
        let pairs: Vec<(&Vec<f64>, &Vec<f64>)> = diffuse.iter().flat_map(|d| volume.iter().map(move |v| (d, v))).collect();
        let mut rows = Vec::new();
        for block in pairs.chunks(LANES) {
            let pair = |lane: usize| block[lane.min(block.len() - 1)];
            let height = block[0].0.len();
            rows.extend((0..height).map(|i| [std::array::from_fn(|lane| pair(lane).0[i]), std::array::from_fn(|lane| pair(lane).1[i])]));
        }
        Self { count: pairs.len(), rows }
    }
}

/// The rows of DoLP under one specular lobe.
pub(crate) struct DolpRows<'a> {
    measured: &'a [f64],
    /// k_s F^s, above 0.
    specular: Vec<f64>,
    /// DoLP_s k_s F^s.
    light: Vec<f64>,
    /// 1/(L k_s F^s); 0 where that is beyond f64, and the row has nothing to say of k_d and k_v.
    scale: Vec<f64>,
}

impl<'a> DolpRows<'a> {
    /// Of measured DoLP and the specular lobe alone.
    pub(crate) fn new(measured: &'a [f64], alone: &Radiances) -> Self {
        let scale = alone.dolp.iter().zip(&alone.specular).map(|(limit, specular)| 1.0 / (limit * specular));
        let specular: Vec<f64> = alone.specular.iter().map(|specular| specular.max(f64::MIN_POSITIVE)).collect();
        Self {
            measured,
            light: alone.dolp.iter().zip(&specular).map(|(limit, specular)| limit * specular).collect(),
            specular,
            scale: scale.map(|scale| if scale < FAINT { scale } else { 0.0 }).collect(),
        }
    }

    /// DoLP, given what is added to the specular lobe.
    fn dolp(&self, i: usize, added: f64) -> f64 {
        self.light[i] / (self.specular[i] + added)
    }

    /// Σ (X − Xm)².
    pub(crate) fn misfit(&self, [kd, kv]: [f64; 2], diffuse: &[f64], volume: &[f64]) -> f64 {
        let difference = |i: usize| self.dolp(i, kd * diffuse[i] + kv * volume[i]) - self.measured[i];
        (0..self.measured.len()).map(|i| difference(i) * difference(i)).sum()
    }

    /// The normal equations for one pair of lobes, linearised where the weights are as given.
    pub(crate) fn normal_about(&self, [kd, kv]: [f64; 2], ranges: [(f64, f64); 3], diffuse: &[f64], volume: &[f64]) -> BoxLeastSquares {
        let added = |i: usize| kd * diffuse[i] + kv * volume[i];
        let rows = (0..self.measured.len()).map(|i| {
            let x = self.dolp(i, added(i));
            let slope = x * x * self.scale[i];
            Row { slope, right: if slope > 0.0 { x - self.measured[i] + slope * added(i) } else { 0.0 } }
        });
        normal(rows, ranges, diffuse, volume)
    }

    /// The rows linearised where DoLP is as measured: `(X₀²/L) g₀ = X₀ − X₀²/L`. A dark row has no g₀ and no weight.
    fn about_measured(&self) -> Vec<Row> {
        let row = |i: usize| {
            let x = self.measured[i];
            let slope = x * x * self.scale[i];
            Row { slope, right: if slope > 0.0 { slope * (self.light[i] / x - self.specular[i]) } else { 0.0 } }
        };
        (0..self.measured.len()).map(row).collect()
    }

    /// The weights for each pair of lobes, linearised where DoLP is as measured.
    pub(crate) fn solve(&self, ranges: [(f64, f64); 3], pairs: &LobePairs) -> Vec<Solved> {
        let mut solved = Vec::with_capacity(pairs.count.next_multiple_of(LANES));
        let search = PairSearch { dolp: self, rows: &self.about_measured(), ranges: [ranges[1], ranges[2]], pairs, out: &mut solved };
        dispatch(Instructions::default(), search);
        solved.truncate(pairs.count);
        solved
    }
}

/// A linearised row: `X − Xm = right − slope (k_d F^d + k_v F^v)`.
#[derive(Clone, Copy)]
struct Row {
    slope: f64,
    right: f64,
}

/// The normal equations of a pair of lobes.
fn normal(rows: impl Iterator<Item = Row>, ranges: [(f64, f64); 3], diffuse: &[f64], volume: &[f64]) -> BoxLeastSquares {
    let mut of = BoxLeastSquares { square: [[0.0; 3]; 3], right: [0.0; 3], constant: 0.0, ranges };
    for ((row, diffuse), volume) in rows.zip(diffuse).zip(volume) {
        let (d, v) = (row.slope * diffuse, row.slope * volume);
        of.square[1][1] += d * d;
        of.square[1][2] += d * v;
        of.square[2][2] += v * v;
        of.right[1] += d * row.right;
        of.right[2] += v * row.right;
        of.constant += row.right * row.right;
    }
    of
}

/// The weights of all pairs under way.
struct PairSearch<'a> {
    dolp: &'a DolpRows<'a>,
    rows: &'a [Row],
    /// Of k_d and k_v.
    ranges: [(f64, f64); 2],
    pairs: &'a LobePairs,
    out: &'a mut Vec<Solved>,
}

impl Vectorised for PairSearch<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        for lobes in self.pairs.rows.chunks_exact(self.rows.len().max(1)) {
            let (mut kd, mut kv, mut misfit) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for first in (0..LANES).step_by(V::<S>::LEN) {
                let lanes = PairLanes { simd, lobes, first };
                let weights = self.weights(&lanes);
                self.misfit(&lanes, weights).store_slice(&mut misfit[first..first + V::<S>::LEN]);
                weights[0].store_slice(&mut kd[first..first + V::<S>::LEN]);
                weights[1].store_slice(&mut kv[first..first + V::<S>::LEN]);
            }
            self.out.extend((0..LANES).map(|lane| Solved { kd: kd[lane], kv: kv[lane], misfit: misfit[lane] }));
        }
    }

    fn run_scalar(self) {
        let Self { dolp, rows, ranges, pairs, out } = self;
        let ranges = [(1.0, 1.0), ranges[0], ranges[1]];
        for lobes in pairs.rows.chunks_exact(rows.len().max(1)) {
            for lane in 0..LANES {
                let column = |lobe: usize| lobes.iter().map(|row| row[lobe][lane]).collect::<Vec<f64>>();
                let (diffuse, volume) = (column(0), column(1));
                let [_, kd, kv] = normal(rows.iter().copied(), ranges, &diffuse, &volume).minimum();
                out.push(Solved { kd, kv, misfit: dolp.misfit([kd, kv], &diffuse, &volume) });
            }
        }
    }
}

/// As many pairs as a vector has lanes.
struct PairLanes<'a, S: Simd> {
    simd: S,
    lobes: &'a [[Lanes; 2]],
    first: usize,
}

impl<S: Simd> PairLanes<'_, S> {
    /// The diffuse and the volume lobe on each row.
    #[inline(always)]
    fn rows(&self) -> impl Iterator<Item = [V<S>; 2]> {
        let load = |column: &Lanes| V::<S>::from_slice(self.simd, &column[self.first..self.first + V::<S>::LEN]);
        self.lobes.iter().map(move |[diffuse, volume]| [load(diffuse), load(volume)])
    }
}

impl PairSearch<'_> {
    /// The least squares of two weights in their box, in each lane. See [`BoxLeastSquares`]: the minimum without the box where it
    /// is inside, else the lowest minimum of an edge.
    #[inline(always)]
    fn weights<S: Simd>(&self, lanes: &PairLanes<'_, S>) -> [V<S>; 2] {
        let number = |value: f64| number(lanes.simd, value);
        let [mut dd, mut dv, mut vv, mut dy, mut vy] = [number(0.0); 5];
        for (row, [diffuse, volume]) in self.rows.iter().zip(lanes.rows()) {
            let (d, v) = (diffuse * row.slope, volume * row.slope);
            dd = d.mul_add(d, dd);
            dv = d.mul_add(v, dv);
            vv = v.mul_add(v, vv);
            dy = d.mul_add(number(row.right), dy);
            vy = v.mul_add(number(row.right), vy);
        }
        let [d_range, v_range] = self.ranges;
        let clamp = |value: V<S>, (low, high): (f64, f64)| value.max(number(low)).min(number(high));
        // An unknown without a column stays at the lower end of its range.
        let over = |square: V<S>| choose::<S>(square.simd_gt(number(0.0)), number(1.0) / square, number(0.0));
        let (over_dd, over_vv) = (over(dd), over(vv));
        let value = |[d, v]: [V<S>; 2]| d * (dd * d + (dv * v - dy) * 2.0) + v * (vv * v - vy * 2.0);
        let on_d = |d: f64| [number(d), clamp((vy - dv * d) * over_vv, v_range)];
        let on_v = |v: f64| [clamp((dy - dv * v) * over_dd, d_range), number(v)];
        let mut lowest = on_d(d_range.0);
        let mut lowest_value = value(lowest);
        for edge in [on_d(d_range.1), on_v(v_range.0), on_v(v_range.1)] {
            let edge_value = value(edge);
            let is_lower = lowest_value.simd_gt(edge_value);
            lowest = [0, 1].map(|i| choose::<S>(is_lower, edge[i], lowest[i]));
            lowest_value = choose::<S>(is_lower, edge_value, lowest_value);
        }
        let determinant = dd * vv - dv * dv;
        let inside = [(dy * vv - vy * dv) / determinant, (vy * dd - dy * dv) / determinant];
        let is_within = |value: V<S>, (low, high): (f64, f64)| value.simd_ge(number(low)) & value.simd_le(number(high));
        let is_inside = determinant.simd_gt(dd * vv * SINGULAR) & is_within(inside[0], d_range) & is_within(inside[1], v_range);
        [0, 1].map(|i| choose::<S>(is_inside, inside[i], lowest[i]))
    }

    /// [`DolpRows::misfit`] in each lane.
    #[inline(always)]
    fn misfit<S: Simd>(&self, lanes: &PairLanes<'_, S>, [kd, kv]: [V<S>; 2]) -> V<S> {
        let DolpRows { measured, specular, light, .. } = self.dolp;
        let mut sum = number(lanes.simd, 0.0);
        for (((measured, specular), light), [diffuse, volume]) in measured.iter().zip(specular).zip(light).zip(lanes.rows()) {
            let difference = number(lanes.simd, *light) / (kd.mul_add(diffuse, kv * volume) + *specular) - *measured;
            sum = difference.mul_add(difference, sum);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::{DolpRows, LobePairs, normal};
    use crate::model::Radiances;

    /// Roundings of products of normal equations whose condition is some thousands.
    const ROUNDING: f64 = 1e-9;

    /// Numbers without structure, in 0.1 … 1.1.
    fn numbers(ratio: f64, count: u32) -> Vec<f64> {
        (1..=count).map(|i| (ratio * f64::from(i)).fract() + 0.1).collect()
    }

    #[test]
    fn the_lanes_are_the_scalar_least_squares() {
        let rows = 13;
        let alone = Radiances { dolp: numbers(2.0_f64.sqrt(), rows), specular: numbers(3.0_f64.sqrt(), rows), ..Radiances::default() };
        let diffuse = vec![numbers(0.7, rows), numbers(0.31, rows), vec![0.0; 13]];
        let volume = vec![numbers(0.47, rows), numbers(0.11, rows), numbers(0.7, rows)];
        for brightness in [0.3, 0.8, 1.5] {
            let measured: Vec<f64> = numbers(0.59, rows).iter().map(|value| brightness * value).collect();
            for (d_range, v_range) in [((0.0, 10.0), (0.0, 10.0)), ((0.0, 0.2), (0.0, 10.0)), ((1.0, 1.0), (0.0, 0.5))] {
                let ranges = [(1.0, 1.0), d_range, v_range];
                let dolp = DolpRows::new(&measured, &alone);
                let solved = dolp.solve(ranges, &LobePairs::new(&diffuse, &volume));
                assert_eq!(solved.len(), 9);
                for (i, solved) in solved.iter().enumerate() {
                    let (d, v) = (&diffuse[i / 3], &volume[i % 3]);
                    let scalar = normal(dolp.about_measured().into_iter(), ranges, d, v);
                    let minimum = scalar.minimum();
                    let excess = scalar.value([1.0, solved.kd, solved.kv]) - scalar.value(minimum);
                    assert!(excess.abs() < ROUNDING * scalar.constant, "{brightness} {ranges:?} {i}: {solved:?} {minimum:?}");
                    let misfit = dolp.misfit([solved.kd, solved.kv], d, v);
                    assert!((solved.misfit / misfit - 1.0).abs() < ROUNDING, "{i}");
                }
            }
        }
    }
}
