//! DoLP under one specular lobe, linearised in k_d and k_v, for many pairs of a diffuse and a volume lobe at once.
//!
//! `1/X = (1 + g)/L` with the Fresnel limit L and `g = (k_d F^d + k_v F^v)/(k_s F^s)` is linear in k_d and k_v; linearised about X₀,
//! `X − Xm = X₀ − Xm − (X₀²/L)(g − g₀)`. Pairs lie in the lanes of a vector; [`BoxLeastSquares`] is the scalar form of the same.

use crate::fit::multistart::box_least_squares::{BoxLeastSquares, SINGULAR};
use crate::model::Radiances;
use crate::model::batch::lanes::{Instructions, Vectorised, dispatch};
use crate::model::batch::prepared::LANES;
use fearless_simd::Simd;

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
    /// Loops over lanes become vectors of the instructions that this is compiled for.
    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) {
        self.run_blocks();
    }

    fn run_scalar(self) {
        self.run_blocks();
    }
}

impl PairSearch<'_> {
    #[inline(always)]
    fn run_blocks(self) {
        if self.rows.is_empty() {
            return;
        }
        for lobes in self.pairs.rows.chunks_exact(self.rows.len()) {
            let [kd, kv] = self.weights(lobes);
            let misfits = self.misfits(lobes, &kd, &kv);
            self.out.extend((0..LANES).map(|lane| Solved { kd: kd[lane], kv: kv[lane], misfit: misfits[lane] }));
        }
    }

    /// The least squares of two weights in their box, in each lane. See [`BoxLeastSquares`]: the minimum without the box where it
    /// is inside, else the lowest minimum of an edge.
    #[inline(always)]
    fn weights(&self, lobes: &[[Lanes; 2]]) -> [Lanes; 2] {
        let (mut dd, mut dv, mut vv, mut dy, mut vy) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for (row, [diffuse, volume]) in self.rows.iter().zip(lobes) {
            for lane in 0..LANES {
                let (d, v) = (row.slope * diffuse[lane], row.slope * volume[lane]);
                dd[lane] += d * d;
                dv[lane] += d * v;
                vv[lane] += v * v;
                dy[lane] += d * row.right;
                vy[lane] += v * row.right;
            }
        }
        let [d_range, v_range] = self.ranges;
        let (mut kd, mut kv) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let (dd, dv, vv, dy, vy) = (dd[lane], dv[lane], vv[lane], dy[lane], vy[lane]);
            // An unknown without a column stays at the lower end of its range.
            let over_dd = if dd > 0.0 { 1.0 / dd } else { 0.0 };
            let over_vv = if vv > 0.0 { 1.0 / vv } else { 0.0 };
            let value = |d: f64, v: f64| d * (dd * d + 2.0 * (dv * v - dy)) + v * (vv * v - 2.0 * vy);
            let on_d = |d: f64| (d, clamp((vy - dv * d) * over_vv, v_range));
            let on_v = |v: f64| (clamp((dy - dv * v) * over_dd, d_range), v);
            let mut lowest = on_d(d_range.0);
            for (d, v) in [on_d(d_range.1), on_v(v_range.0), on_v(v_range.1)] {
                let is_lower = value(d, v) < value(lowest.0, lowest.1);
                lowest = (if is_lower { d } else { lowest.0 }, if is_lower { v } else { lowest.1 });
            }
            let determinant = dd * vv - dv * dv;
            let (d, v) = ((dy * vv - vy * dv) / determinant, (vy * dd - dy * dv) / determinant);
            let is_inside = (determinant > SINGULAR * dd * vv) & (d >= d_range.0) & (d <= d_range.1) & (v >= v_range.0) & (v <= v_range.1);
            kd[lane] = if is_inside { d } else { lowest.0 };
            kv[lane] = if is_inside { v } else { lowest.1 };
        }
        [kd, kv]
    }

    /// [`DolpRows::misfit`] in each lane.
    #[inline(always)]
    fn misfits(&self, lobes: &[[Lanes; 2]], kd: &Lanes, kv: &Lanes) -> Lanes {
        let DolpRows { measured, specular, light, .. } = self.dolp;
        let mut sums = [0.0; LANES];
        for (((measured, specular), light), [diffuse, volume]) in measured.iter().zip(specular).zip(light).zip(lobes) {
            for lane in 0..LANES {
                let difference = light / (specular + (kd[lane] * diffuse[lane] + kv[lane] * volume[lane])) - measured;
                sums[lane] += difference * difference;
            }
        }
        sums
    }
}

/// The nearest value of a range.
#[inline(always)]
fn clamp(value: f64, (low, high): (f64, f64)) -> f64 {
    value.max(low).min(high)
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
        let mut alone = Radiances::default();
        alone.dolp = numbers(2.0_f64.sqrt(), rows);
        alone.specular = numbers(3.0_f64.sqrt(), rows);
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
