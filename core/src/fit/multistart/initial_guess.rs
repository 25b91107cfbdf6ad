//! First guesses by variable projection (Golub and Pereyra, SIAM J. Numer. Anal. 10, 413 (1973)) on a grid: k_d and k_v from linear
//! least squares at each point of a grid of the other parameters.
//!
//! For fixed shapes (n, k, σ, q, c, σ_v), `1/X = (1 + g)/L` with the Fresnel limit L and `g = (k_d F^d + k_v F^v)/(k_s F^s)` is linear in k_d
//! and k_v. Linearised about X₀, `X − Xm = X₀ − Xm − (X₀²/L)(g − g₀)`: a least squares problem in the box of k_d and k_v, solved once
//! about the measured DoLP and once more about what came of it.
//!
//! A point of the grid that is lower than its neighbours along each axis is a grid minimum: a minimum of the objective is near.

use crate::fit::objective::Problem;
use crate::model::{Diffuse, Model, Parameter, ParameterSet, Parameters, Pbrdf, Reflection};

/// The axes of the grid. Volume lobes of different widths reach different rows, hence the many σ_v.
const AXES: [(Parameter, &[f64]); 6] = [
    (Parameter::N, &[0.06, 0.2, 0.5, 0.9, 1.4, 2.2, 3.5, 6.0]),
    (Parameter::K, &[0.05, 0.4, 1.0, 2.0, 3.2, 4.5, 7.0, 11.0]),
    (Parameter::Sigma, &[0.03, 0.07, 0.13, 0.22, 0.35, 0.6, 1.1, 2.5]),
    (Parameter::Q, &[1.002, 1.15, 1.5, 2.2, 5.0]),
    (Parameter::C, &[-1.0, -0.7, -0.35, 0.0]),
    (Parameter::SigmaV, &[0.02, 0.06, 0.1, 0.16, 0.25, 0.4, 0.65, 1.1, 2.2]),
];
/// The axes of the lobe grid, n and k being held: it finds minima where σ and q make up for k_d or k_v at their bounds.
const LOBES: [(Parameter, &[f64]); 4] = [
    (Parameter::Sigma, &[0.01, 0.03, 0.07, 0.13, 0.22, 0.35, 0.6, 1.1, 2.5]),
    (Parameter::Q, &[1.002, 1.15, 1.5, 2.2, 5.0]),
    (Parameter::C, &[-1.0, -0.8, -0.6, -0.4, -0.2, 0.0]),
    (Parameter::SigmaV, &[0.015, 0.03, 0.06, 0.08, 0.1, 0.13, 0.16, 0.2, 0.25, 0.32, 0.4, 0.55, 0.8, 1.2, 2.2]),
];
/// Rows of data on which the grid is judged, at most: the time of the grid is proportional to their number.
const ROWS: usize = 32;

/// A guess, and its sum of squared differences of DoLP over the rows of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Guess {
    pub misfit: f64,
    pub parameters: Parameters,
}

/// The lowest points of the whole grid, the lowest first; none where the data have a BRDF or no DoLP but 0, the model has no specular lobe, or k_d
/// and k_v are both fixed.
pub(crate) fn grid_minima(problem: &Problem) -> Vec<Guess> {
    let Some(grid) = Grid::new(problem, problem.start(), &AXES) else { return Vec::new() };
    grid.grid_minima()
}

/// The lowest points over σ, q, c and σ_v with n and k as they are there, the lowest first.
pub(crate) fn lobe_grid_minima(problem: &Problem, at: &Parameters) -> Vec<Guess> {
    let Some(grid) = Grid::new(problem, at, &LOBES) else { return Vec::new() };
    grid.grid_minima()
}

/// A grid of shapes and the rows that it is judged by.
struct Grid<'a> {
    problem: &'a Problem,
    /// Places in the problem's scene with the measured DoLP.
    rows: Vec<(usize, f64)>,
    /// Values of n, k, σ, q, c, σ_v: one alone where the parameter is fixed.
    axes: [Vec<f64>; 6],
    base: Parameters,
    fit_d: bool,
    fit_v: bool,
}

/// The lobe of each c, or of each σ_v, on each row.
type LobeColumns = Vec<Vec<f64>>;

impl<'a> Grid<'a> {
    fn new(problem: &'a Problem, base: &Parameters, values: &[(Parameter, &[f64])]) -> Option<Self> {
        let free: ParameterSet = problem.free().iter().copied().collect();
        let model = problem.model();
        let fit_d = free.contains(Parameter::Kd) && model.diffuse != Diffuse::Absent;
        let fit_v = free.contains(Parameter::Kv) && model.volume;
        if !problem.knows_only_ratios() || !model.specular || !(fit_d || fit_v) {
            return None;
        }
        let rows = problem.observations().dolp_rows(ROWS);
        // Where no measured DoLP is above 0, k_d and k_v would only go to their bounds.
        if rows.iter().all(|(_, measured)| *measured <= 0.0) {
            return None;
        }
        let axes = AXES.map(|(parameter, _)| {
            let values = values.iter().find(|axis| axis.0 == parameter).map_or(&[][..], |axis| axis.1);
            let inside: Vec<f64> = values.iter().copied().filter(|&value| problem.bounds().contain(parameter, value)).collect();
            if free.contains(parameter) && !inside.is_empty() { inside } else { vec![base[parameter]] }
        });
        Some(Self { problem, rows, axes, base: *base, fit_d, fit_v })
    }

    /// The guess at each point of the grid, σ_v running fastest; those that make no surface have an infinite misfit.
    fn guesses(&self) -> Vec<Guess> {
        let [n, k, sigma, q, ..] = &self.axes;
        let mut optics = Vec::with_capacity(n.len() * k.len() * sigma.len() * q.len());
        for &n in n {
            for &k in k {
                for &sigma in sigma {
                    optics.extend(q.iter().map(|&q| Parameters { n, k, sigma, q, ..self.base }));
                }
            }
        }
        let shared = (self.problem.model().diffuse != Diffuse::Hyde).then(|| self.diffuse(&self.base));
        let volume = self.volume();
        let all = |point: &Parameters| match &shared {
            Some(diffuse) => self.guesses_of(point, diffuse, &volume),
            None => self.guesses_of(point, &self.diffuse(point), &volume),
        };
        #[cfg(feature = "threads")]
        {
            use rayon::prelude::*;
            optics.par_iter().flat_map_iter(all).collect()
        }
        #[cfg(not(feature = "threads"))]
        optics.iter().flat_map(all).collect()
    }

    /// The diffuse lobe on each row for each c, k_d being 1 where it is fitted.
    fn diffuse(&self, optics: &Parameters) -> LobeColumns {
        let kd = if self.fit_d { 1.0 } else { self.base.kd };
        let column = |&c: &f64| self.column(Parameters { c, kd, ..*optics }, |reflection| reflection.diffuse);
        self.axes[4].iter().map(column).collect()
    }

    /// The volume lobe on each row for each σ_v, k_v being 1 where it is fitted.
    fn volume(&self) -> LobeColumns {
        let kv = if self.fit_v { 1.0 } else { self.base.kv };
        let column = |&sigma_v: &f64| self.column(Parameters { sigma_v, kv, ..self.base }, |reflection| reflection.volume);
        self.axes[5].iter().map(column).collect()
    }

    fn column(&self, parameters: Parameters, value: impl Fn(Reflection) -> f64) -> Vec<f64> {
        let Ok(surface) = Pbrdf::new(self.problem.model(), parameters) else { return vec![0.0; self.rows.len()] };
        self.rows.iter().map(|&(point, _)| value(self.problem.geometries().reflection(&surface, point))).collect()
    }

    /// The guesses for one specular lobe.
    fn guesses_of(&self, optics: &Parameters, diffuse: &LobeColumns, volume: &LobeColumns) -> Vec<Guess> {
        // Alone, the specular lobe has the Fresnel limit for its DoLP.
        let alone = Model { diffuse: Diffuse::Absent, volume: false, ..self.problem.model() };
        let specular = Pbrdf::new(alone, *optics).ok().map(|surface| {
            let row = |&(point, measured): &(usize, f64)| Row::new(measured, self.problem.geometries().reflection(&surface, point));
            self.rows.iter().map(row).collect::<Vec<_>>()
        });
        let mut guesses = Vec::with_capacity(self.axes[4].len() * self.axes[5].len());
        for (&c, diffuse) in self.axes[4].iter().zip(diffuse) {
            for (&sigma_v, volume) in self.axes[5].iter().zip(volume) {
                let mut guess = Guess { misfit: f64::INFINITY, parameters: Parameters { c, sigma_v, ..*optics } };
                if let Some(rows) = &specular {
                    self.solve_weights(rows, diffuse, volume, &mut guess);
                }
                guesses.push(guess);
            }
        }
        guesses
    }

    /// Fits k_d and k_v.
    fn solve_weights(&self, rows: &[Row], diffuse: &[f64], volume: &[f64], guess: &mut Guess) {
        // What is not fitted counts once, with the weight that it has.
        let range = |parameter, fitted| if fitted { self.problem.bounds().of(parameter) } else { (1.0, 1.0) };
        let (d_range, v_range) = (range(Parameter::Kd, self.fit_d), range(Parameter::Kv, self.fit_v));
        let mut weights = None;
        for _ in 0..PASSES {
            let mut normal = Normal::default();
            for (row, (&d, &v)) in rows.iter().zip(diffuse.iter().zip(volume)) {
                row.count(weights, d, v, &mut normal);
            }
            let (kd, kv) = normal.minimum(d_range, v_range);
            let difference = |(row, (d, v)): (&Row, (&f64, &f64))| row.dolp(kd * d + kv * v) - row.measured;
            let misfit: f64 = rows.iter().zip(diffuse.iter().zip(volume)).map(difference).map(|x| x * x).sum();
            if misfit < guess.misfit {
                guess.misfit = misfit;
                guess.parameters.kd = if self.fit_d { kd } else { self.base.kd };
                guess.parameters.kv = if self.fit_v { kv } else { self.base.kv };
            }
            weights = Some((kd, kv));
        }
    }

    /// The points that are lower than their neighbours along each axis; of equal neighbours the first counts as lower.
    fn grid_minima(&self) -> Vec<Guess> {
        let guesses = self.guesses();
        let mut grid_minima: Vec<Guess> = (0..guesses.len()).filter(|&i| self.is_minimum(&guesses, i)).map(|i| guesses[i]).collect();
        grid_minima.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
        grid_minima
    }

    fn is_minimum(&self, guesses: &[Guess], i: usize) -> bool {
        let here = guesses[i].misfit;
        let mut stride = 1;
        let low = self.axes.iter().rev().all(|axis| {
            let place = i / stride % axis.len();
            let below = place == 0 || guesses[i - stride].misfit > here;
            let above = place + 1 == axis.len() || guesses[i + stride].misfit >= here;
            stride *= axis.len();
            below && above
        });
        low && here.is_finite()
    }
}

/// Linearisations: about the measured DoLP, and about the DoLP of the first solution.
const PASSES: usize = 2;

/// A row under one specular lobe.
struct Row {
    measured: f64,
    /// DoLP_s.
    limit: f64,
    /// k_s F^s, above 0.
    specular: f64,
    /// 1/(L k_s F^s); 0 where that is beyond f64, and the row has nothing to say of k_d and k_v.
    scale: f64,
}

impl Row {
    fn new(measured: f64, alone: Reflection) -> Self {
        let Reflection { dolp: limit, specular, .. } = alone;
        let scale = 1.0 / (limit * specular);
        let scale = if scale < FAINT { scale } else { 0.0 };
        Self { measured, limit, specular: specular.max(f64::MIN_POSITIVE), scale }
    }

    /// DoLP, given what is added to the specular lobe.
    fn dolp(&self, added: f64) -> f64 {
        self.limit * self.specular / (self.specular + added)
    }

    /// Adds the row to the normal equations, linearised where k_d and k_v are as given, or where DoLP is as measured.
    fn count(&self, weights: Option<(f64, f64)>, d: f64, v: f64, normal: &mut Normal) {
        if self.scale == 0.0 {
            return;
        }
        // X − Xm = X₀ − Xm − (X₀²/L)(g − g₀), and at X₀ = Xm, (X₀²/L) g₀ = X₀ − X₀²/L; a dark row has no g₀ and no weight there.
        let (x, added) = match weights {
            Some((kd, kv)) => (self.dolp(kd * d + kv * v), kd * d + kv * v),
            None if self.measured > 0.0 => (self.measured, self.specular * (self.limit / self.measured - 1.0)),
            None => return,
        };
        let slope = x * x * self.scale;
        let (d, v, y) = (slope * d, slope * v, x - self.measured + slope * added);
        normal.dd += d * d;
        normal.dv += d * v;
        normal.vv += v * v;
        normal.dy += d * y;
        normal.vy += v * y;
    }
}

/// The sums of the normal equations of k_d and k_v.
#[derive(Debug, Clone, Copy, Default)]
struct Normal {
    dd: f64,
    dv: f64,
    vv: f64,
    dy: f64,
    vy: f64,
}

/// Above this, squares of a row's coefficients come near the end of f64.
const FAINT: f64 = 1e100;

impl Normal {
    /// Minimises `dd x² + 2dv xy + vv y² − 2 dy x − 2 vy y` over the box of x and y.
    fn minimum(&self, x_range: (f64, f64), y_range: (f64, f64)) -> (f64, f64) {
        let Self { dd, dv, vv, dy, vy } = *self;
        let within = |value: f64, (low, high): (f64, f64)| value >= low && value <= high;
        let determinant = dd * vv - dv * dv;
        if determinant > 1e-12 * dd * vv {
            let (x, y) = ((dy * vv - vy * dv) / determinant, (vy * dd - dy * dv) / determinant);
            if within(x, x_range) && within(y, y_range) {
                return (x, y);
            }
        }
        // The minimum is on an edge; along an edge it is that of a parabola.
        let along = |square: f64, right: f64, (low, high): (f64, f64)| if square > 0.0 { (right / square).clamp(low, high) } else { low };
        let edges = [
            (x_range.0, along(vv, vy - dv * x_range.0, y_range)),
            (x_range.1, along(vv, vy - dv * x_range.1, y_range)),
            (along(dd, dy - dv * y_range.0, x_range), y_range.0),
            (along(dd, dy - dv * y_range.1, x_range), y_range.1),
        ];
        let value = |(x, y): (f64, f64)| x * (dd * x + 2.0 * dv * y - 2.0 * dy) + y * (vv * y - 2.0 * vy);
        edges.into_iter().fold(edges[0], |best, edge| if value(edge) < value(best) { edge } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::{AXES, Grid, Normal, grid_minima, lobe_grid_minima};
    use crate::fit::{Bounds, FitOptions, Problem, free_by_default};
    use crate::measurement::{Columns, Measurement, Simulation};
    use crate::model::{Model, Parameter, Parameters, Pbrdf};
    use crate::optics::SlopeDistribution;

    /// A volume lobe 0.16 rad wide beside a diffuse one.
    const TRUTH: Parameters = Parameters { kv: 0.2, sigma_v: 0.16, c: -0.35, ..DEFAULT };
    const DEFAULT: Parameters = Parameters { n: 2.2, k: 3.2, sigma: 0.35, ks: 1.0, kd: 0.1, kv: 0.0, q: 2.2, c: -0.7, sigma_v: 3.0 };

    fn problem() -> Problem {
        let model = Model::full(SlopeDistribution::Cauchy);
        let measurement: Measurement = Simulation {
            model_name: "cauchy".to_owned(),
            surface: Pbrdf::new(model, TRUTH).unwrap(),
            theta_i: vec![30.0, 50.0],
            theta_r: (0..15).map(|i| f64::from(5 * i)).collect(),
            dphi: 180.0,
            columns: Columns::Dolp,
            noise: 0.0,
            brdf_noise: 0.0,
            seed: 1,
        }
        .run()
        .unwrap();
        let free = free_by_default(model, &measurement, &FitOptions::default());
        Problem::new(&measurement, model, Parameters::default(), free, Bounds::default(), FitOptions::default()).unwrap()
    }

    #[test]
    fn least_squares_stay_in_the_box() {
        let solve = |[dd, dv, vv]: [f64; 3], [dy, vy]: [f64; 2]| Normal { dd, dv, vv, dy, vy }.minimum((0.0, 10.0), (0.0, 10.0));
        assert_eq!(solve([1.0, 0.0, 1.0], [2.0, 3.0]), (2.0, 3.0));
        assert_eq!(solve([1.0, 0.0, 1.0], [2.0, -3.0]), (2.0, 0.0));
        assert_eq!(solve([1.0, 0.0, 1.0], [-2.0, -3.0]), (0.0, 0.0));
        assert_eq!(solve([1.0, 1.0, 1.0], [1.0, 2.0]), (0.0, 2.0));
        // Without edges (14, −4) and (10, 4): the second lies on one edge, the first is moved along it to the corner.
        assert_eq!(solve([1.0, 0.5, 0.5], [12.0, 5.0]), (10.0, 0.0));
        assert_eq!(solve([1.0, 0.5, 0.5], [12.0, 7.0]), (10.0, 4.0));
    }

    #[test]
    fn a_truth_on_the_grid_is_its_lowest_minimum() {
        let lowest = grid_minima(&problem())[0];
        // Rounding of k_d and k_v, which the least squares give to about 1e-12, and of DoLP.
        assert!(lowest.misfit < 1e-20, "{lowest:?}");
        for parameter in [Parameter::N, Parameter::K, Parameter::Sigma, Parameter::Q, Parameter::C, Parameter::SigmaV] {
            assert_eq!(lowest.parameters[parameter], TRUTH[parameter], "{parameter:?}");
        }
        assert!((lowest.parameters.kd - TRUTH.kd).abs() < 1e-9 && (lowest.parameters.kv - TRUTH.kv).abs() < 1e-9);
    }

    #[test]
    fn a_volume_lobe_is_found_again_from_where_there_is_none() {
        let lowest = lobe_grid_minima(&problem(), &DEFAULT)[0];
        assert!((lowest.parameters.sigma_v - TRUTH.sigma_v).abs() < 0.05, "{lowest:?}");
        assert!(lowest.parameters.kv > 0.1, "{lowest:?}");
    }

    #[test]
    fn grid_minima_are_lower_than_all_neighbours_and_in_order() {
        let problem = problem();
        let grid = Grid::new(&problem, problem.start(), &AXES).unwrap();
        let guesses = grid.guesses();
        let grid_minima = grid.grid_minima();
        assert!(grid_minima.windows(2).all(|pair| pair[0].misfit <= pair[1].misfit));
        let lowest = guesses.iter().map(|guess| guess.misfit).fold(f64::INFINITY, f64::min);
        assert_eq!(grid_minima[0].misfit, lowest);
        let lengths: usize = grid.axes.iter().map(Vec::len).product();
        assert_eq!(guesses.len(), lengths);
        for minimum in &grid_minima {
            let at = guesses.iter().position(|guess| guess == minimum).unwrap();
            // σ_v runs fastest, n slowest.
            for (axis, stride) in [(5, 1), (0, lengths / grid.axes[0].len())] {
                let place = at / stride % grid.axes[axis].len();
                assert!(place == 0 || guesses[at - stride].misfit >= minimum.misfit);
                assert!(place + 1 == grid.axes[axis].len() || guesses[at + stride].misfit >= minimum.misfit);
            }
        }
    }

    #[test]
    fn without_weights_to_fit_there_are_no_guesses() {
        let problem = problem();
        assert!(grid_minima(&problem.with_free([Parameter::N, Parameter::K].into_iter().collect())).is_empty());
    }
}
