//! First guesses by variable projection (Golub and Pereyra, SIAM J. Numer. Anal. 10, 413 (1973)) on a grid: the weights from linear least
//! squares at each point of a grid of the other parameters.
//!
//! For fixed shapes (n, k, σ, q, c, σ_v) the BRDF is linear in k_s, k_d and k_v. DoLP is linearised in k_d and k_v about the measured
//! values ([`DolpRows`]) and, at grid minima, once more about what came of it.
//!
//! A point of the grid that is lower than its neighbours along each axis is a grid minimum: a minimum of the objective is near.

use crate::fit::local::tall_qr::dot;
use crate::fit::multistart::box_least_squares::BoxLeastSquares;
use crate::fit::multistart::dolp_rows::{DolpRows, LobeColumns, LobePairs, Solved};
use crate::fit::objective::Problem;
use crate::fit::observations::Kind;
use crate::model::{Batch, Diffuse, DolpFormula, Model, Parameter, ParameterSet, Parameters, Pbrdf, Radiances};

/// The axes of the grid. Volume lobes of different widths reach different rows, hence the many σ_v.
const AXES: [(Parameter, &[f64]); 6] = [
    (Parameter::N, &[0.1, 0.4, 0.9, 1.4, 2.2, 4.5]),
    (Parameter::K, &[0.1, 0.8, 2.0, 3.2, 5.5, 10.0]),
    (Parameter::Sigma, &[0.04, 0.1, 0.2, 0.35, 0.7, 3.0]),
    (Parameter::Q, &[1.0001, 1.15, 1.5, 2.2, 5.0]),
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
/// Distance of two sines below which their rows have one critical angle.
const APART: f64 = 1e-6;
/// Where the first guess after a kink stands, as a fraction of the way to the next.
const ABOVE_KINK: f64 = 0.005;
/// Misfit of a guess of total reflection, at most, over that of the minimum it is held against: guesses are rough.
const NEAR_MINIMUM: f64 = 4.0;
/// The weights, in the order of the unknowns of the least squares.
const WEIGHTS: [Parameter; 3] = [Parameter::Ks, Parameter::Kd, Parameter::Kv];

/// A guess, and its sum of squared differences over the rows of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Guess {
    pub misfit: f64,
    pub parameters: Parameters,
}

/// The lowest points of the whole grid, the lowest first: of the grid of DoLP, or that of the BRDF, or of both in turns. None where the model has no
/// specular lobe or no weight is free.
pub(crate) fn grid_minima(problem: &Problem) -> Vec<Guess> {
    minima_over(problem, problem.start(), &AXES)
}

/// The lowest points over σ, q, c and σ_v with n and k as they are there, the lowest first.
pub(crate) fn lobe_grid_minima(problem: &Problem, at: &Parameters) -> Vec<Guess> {
    minima_over(problem, at, &LOBES)
}

/// The specular lobes that guesses of total reflection are looked for with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpecularLobes {
    /// That of the surface where the search stands.
    AsThere,
    /// Those of the lobe grid.
    Any,
}

/// The lowest points of total reflection by the BRDF, k = 0 and n < 1, the lowest first: those that come near the misfit of the surface
/// there, whose diffuse and volume lobe they keep. Where n passes sin β of a row, that row meets its critical angle, and the
/// objective has a kink; a minimum may lie between any two of them, and no descent passes from one to the next.
pub(crate) fn total_reflection_minima(problem: &Problem, at: &Parameters, lobes: SpecularLobes) -> Vec<Guess> {
    let is_open = problem.free().contains(&Parameter::N) && (problem.free().contains(&Parameter::K) || at.k == 0.0);
    if !is_open || !problem.bounds().contain(Parameter::K, 0.0) {
        return Vec::new();
    }
    let mut sines: Vec<f64> = problem.geometries().facets().iter().map(|facet| facet.sin_beta_sq.sqrt()).collect();
    sines.sort_by(f64::total_cmp);
    sines.dedup_by(|a, b| *a - *b <= APART);
    let step = sines.len().div_ceil(ROWS).max(1);
    let kinks: Vec<f64> = std::iter::once(0.0).chain(sines.into_iter().step_by(step)).collect();
    // Just above a kink its row begins to transmit, steeply.
    let places = |pair: &[f64]| [ABOVE_KINK, 0.5].map(|place| pair[0] + place * (pair[1] - pair[0]));
    let between: Vec<f64> = kinks.windows(2).flat_map(places).collect();
    let index: [(Parameter, &[f64]); 2] = [(Parameter::N, &between), (Parameter::K, &[0.0])];
    let axes = match lobes {
        SpecularLobes::AsThere => index.to_vec(),
        SpecularLobes::Any => [index, [LOBES[0], LOBES[1]]].concat(),
    };
    let minima = |axes| Grid::new(problem, at, axes, Kind::Brdf).map_or_else(Vec::new, |grid| grid.grid_minima());
    let highest = minima(&[]).first().map_or(0.0, |here| NEAR_MINIMUM * here.misfit);
    minima(&axes).into_iter().take_while(|guess| guess.misfit <= highest).collect()
}

fn minima_over(problem: &Problem, base: &Parameters, axes: &[(Parameter, &[f64])]) -> Vec<Guess> {
    let minima = |kind| Grid::new(problem, base, axes, kind).map_or_else(Vec::new, |grid| grid.grid_minima());
    let (dolp, brdf) = (minima(Kind::Dolp), minima(Kind::Brdf));
    // In turns: each sees a part of the data, and their misfits are of different kinds.
    let (mut dolp, mut brdf) = (dolp.into_iter(), brdf.into_iter());
    let mut turns = Vec::with_capacity(dolp.len() + brdf.len());
    while dolp.len() + brdf.len() > 0 {
        turns.extend(dolp.next());
        turns.extend(brdf.next());
    }
    turns
}

/// A grid of shapes and the rows of DoLP or BRDF that it is judged by.
struct Grid<'a> {
    problem: &'a Problem,
    kind: Kind,
    batch: Batch,
    measured: Vec<f64>,
    /// Values of n, k, σ, q, c, σ_v: one alone where the parameter is fixed.
    axes: [Vec<f64>; 6],
    base: Parameters,
    /// Whether k_s, k_d and k_v are fitted.
    fitted: [bool; 3],
}

/// Diffuse lobes of each c and volume lobes of each σ_v, as the least squares take them.
enum Lobes {
    /// Of DoLP.
    Pairs(LobePairs),
    /// Of the BRDF.
    Columns { diffuse: LobeColumns, volume: LobeColumns },
}

impl<'a> Grid<'a> {
    fn new(problem: &'a Problem, base: &Parameters, values: &[(Parameter, &[f64])], kind: Kind) -> Option<Self> {
        let free: ParameterSet = problem.free().iter().copied().collect();
        let model = problem.model();
        let fitted = [
            free.contains(Parameter::Ks) && kind != Kind::Dolp,
            free.contains(Parameter::Kd) && model.diffuse != Diffuse::Absent,
            free.contains(Parameter::Kv) && model.volume,
        ];
        let is_linear = kind != Kind::Dolp || model.dolp_formula == DolpFormula::Consistent;
        if !is_linear || !model.specular || fitted == [false; 3] {
            return None;
        }
        let rows = problem.observations().rows(kind.block(), ROWS);
        // Where no measured value is above 0, the weights would only go to their bounds.
        if rows.iter().all(|(_, measured)| *measured <= 0.0) {
            return None;
        }
        let axes = AXES.map(|(parameter, _)| {
            let values = values.iter().find(|axis| axis.0 == parameter).map_or(&[][..], |axis| axis.1);
            let inside: Vec<f64> = values.iter().copied().filter(|&value| problem.bounds().contain(parameter, value)).collect();
            if free.contains(parameter) && !inside.is_empty() { inside } else { vec![base[parameter]] }
        });
        let facets = problem.geometries().facets();
        let batch = Batch::from_facets(rows.iter().map(|&(point, _)| facets[point]).collect()).single_threaded();
        Some(Self { problem, kind, batch, measured: rows.into_iter().map(|row| row.1).collect(), axes, base: *base, fitted })
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
        let volume = self.volume();
        let shared = (self.problem.model().diffuse != Diffuse::Hyde).then(|| self.lobes(&self.base, &volume));
        let all = |point: &Parameters| match &shared {
            Some(lobes) => self.guesses_of(point, lobes),
            None => self.guesses_of(point, &self.lobes(point, &volume)),
        };
        #[cfg(feature = "threads")]
        {
            use rayon::prelude::*;
            optics.par_iter().with_min_len(16).flat_map_iter(all).collect()
        }
        #[cfg(not(feature = "threads"))]
        optics.iter().flat_map(all).collect()
    }

    fn lobes(&self, optics: &Parameters, volume: &LobeColumns) -> Lobes {
        let diffuse = self.diffuse(optics);
        match self.kind {
            Kind::Dolp => Lobes::Pairs(LobePairs::new(&diffuse, volume)),
            _ => Lobes::Columns { diffuse, volume: volume.clone() },
        }
    }

    /// The weight of a lobe in the columns of the least squares: 1 where it is fitted.
    fn weight(&self, j: usize) -> f64 {
        if self.fitted[j] { 1.0 } else { self.base[WEIGHTS[j]] }
    }

    /// The diffuse lobe on each row for each c.
    fn diffuse(&self, optics: &Parameters) -> LobeColumns {
        let column =
            |&c: &f64| self.lobe(Parameters { c, kd: self.weight(1), ..*optics }, |surface, facet| surface.reflection(facet).diffuse);
        self.axes[4].iter().map(column).collect()
    }

    /// The volume lobe on each row for each σ_v.
    fn volume(&self) -> LobeColumns {
        let column = |&sigma_v: &f64| {
            self.lobe(Parameters { sigma_v, kv: self.weight(2), ..self.base }, |surface, facet| surface.reflection(facet).volume)
        };
        self.axes[5].iter().map(column).collect()
    }

    fn lobe(&self, parameters: Parameters, value: impl Fn(&Pbrdf, &crate::optics::Facet) -> f64) -> Vec<f64> {
        let Ok(surface) = Pbrdf::new(self.problem.model(), parameters) else { return vec![0.0; self.batch.len()] };
        let values = self.batch.facets().iter().map(|facet| value(&surface, facet));
        if self.kind == Kind::Dolp {
            values.collect()
        } else {
            values.zip(&self.measured).map(|(value, measured)| value / measured).collect()
        }
    }

    /// The guesses for one specular lobe.
    fn guesses_of(&self, optics: &Parameters, lobes: &Lobes) -> Vec<Guess> {
        let shapes = self.axes[4].iter().flat_map(|&c| self.axes[5].iter().map(move |&sigma_v| Parameters { c, sigma_v, ..*optics }));
        let Some(specular) = self.specular(optics) else {
            return shapes.map(|parameters| Guess { misfit: f64::INFINITY, parameters }).collect();
        };
        let ranges = self.ranges();
        match lobes {
            Lobes::Pairs(pairs) => {
                let solved = DolpRows::new(&self.measured, &specular).solve(ranges, pairs);
                let guess = |(parameters, solved): (Parameters, Solved)| Guess {
                    misfit: solved.misfit,
                    parameters: self.with_weights(parameters, [0.0, solved.kd, solved.kv]),
                };
                shapes.zip(solved).map(guess).collect()
            }
            Lobes::Columns { diffuse, volume } => {
                let relative: Vec<f64> = specular.specular.iter().zip(&self.measured).map(|(s, measured)| s / measured).collect();
                let guess = |(parameters, normal): (Parameters, BoxLeastSquares)| {
                    let weights = normal.minimum();
                    Guess { misfit: normal.value(weights), parameters: self.with_weights(parameters, weights) }
                };
                shapes.zip(brdf_normals(ranges, &relative, diffuse, volume)).map(guess).collect()
            }
        }
    }

    /// The specular lobe alone, which has the Fresnel limit for its DoLP; none where it is no surface.
    fn specular(&self, optics: &Parameters) -> Option<Radiances> {
        let alone = Model { diffuse: Diffuse::Absent, volume: false, ..self.problem.model() };
        let ks = if self.kind == Kind::Dolp { self.base.ks } else { self.weight(0) };
        let surface = Pbrdf::new(alone, Parameters { ks, ..*optics }).ok()?;
        let mut specular = Radiances::default();
        self.batch.radiances(&surface, &mut specular);
        Some(specular)
    }

    fn ranges(&self) -> [(f64, f64); 3] {
        // What is not fitted counts once, with the weight that it has.
        [0, 1, 2].map(|j| if self.fitted[j] { self.problem.bounds().of(WEIGHTS[j]) } else { (1.0, 1.0) })
    }

    fn with_weights(&self, mut parameters: Parameters, weights: [f64; 3]) -> Parameters {
        for j in 0..3 {
            if self.fitted[j] {
                parameters[WEIGHTS[j]] = weights[j];
            }
        }
        parameters
    }

    /// A guess of DoLP, linearised once more about what came of it.
    fn improved(&self, guess: Guess) -> Guess {
        let Some(specular) = self.specular(&guess.parameters).filter(|_| self.kind == Kind::Dolp) else { return guess };
        let rows = DolpRows::new(&self.measured, &specular);
        let Parameters { c, sigma_v, .. } = guess.parameters;
        let alone = Grid {
            axes: [vec![], vec![], vec![], vec![], vec![c], vec![sigma_v]],
            batch: self.batch.clone(),
            measured: Vec::new(),
            ..*self
        };
        let (diffuse, volume) = (alone.diffuse(&guess.parameters), alone.volume());
        let weights = WEIGHTS.map(|weight| guess.parameters[weight]);
        let [_, kd, kv] = [0, 1, 2].map(|j| if self.fitted[j] { weights[j] } else { 1.0 });
        let solved = rows.normal_about([kd, kv], self.ranges(), &diffuse[0], &volume[0]).minimum();
        let misfit = rows.misfit([solved[1], solved[2]], &diffuse[0], &volume[0]);
        if misfit < guess.misfit { Guess { misfit, parameters: self.with_weights(guess.parameters, solved) } } else { guess }
    }

    /// The points that are lower than their neighbours along each axis; of equal neighbours the first counts as lower.
    fn grid_minima(&self) -> Vec<Guess> {
        let guesses = self.guesses();
        let minima = (0..guesses.len()).filter(|&i| self.is_minimum(&guesses, i));
        let mut grid_minima: Vec<Guess> = minima.map(|i| self.improved(guesses[i])).collect();
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

/// The normal equations of relative differences of the BRDF for each pair of lobes, given the specular lobe relative to what is measured:
/// products of columns, each formed once.
fn brdf_normals(ranges: [(f64, f64); 3], specular: &[f64], diffuse: &LobeColumns, volume: &LobeColumns) -> Vec<BoxLeastSquares> {
    // Each relative difference is one less the sum of the lobes.
    let sum = |column: &[f64]| column.iter().sum::<f64>();
    #[expect(clippy::cast_precision_loss, reason = "a number of rows")]
    let constant = specular.len() as f64;
    let (ss, sy) = (dot(specular, specular), sum(specular));
    let of_volume: Vec<[f64; 3]> = volume.iter().map(|v| [dot(v, v), dot(specular, v), sum(v)]).collect();
    let mut normals = Vec::with_capacity(diffuse.len() * volume.len());
    for d in diffuse {
        let (dd, sd, dy) = (dot(d, d), dot(specular, d), sum(d));
        for (v, &[vv, sv, vy]) in volume.iter().zip(&of_volume) {
            let square = [[ss, sd, sv], [0.0, dd, dot(d, v)], [0.0, 0.0, vv]];
            normals.push(BoxLeastSquares { square, right: [sy, dy, vy], constant, ranges });
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::{AXES, Grid, grid_minima, lobe_grid_minima};
    use crate::fit::observations::Kind;
    use crate::fit::{Bounds, FitOptions, Problem, free_by_default};
    use crate::measurement::{Columns, Measurement, Simulation};
    use crate::model::{Model, Parameter, Parameters, Pbrdf};
    use crate::optics::SlopeDistribution;

    /// A volume lobe 0.16 rad wide beside a diffuse one.
    const TRUTH: Parameters = Parameters { kv: 0.2, sigma_v: 0.16, c: -0.35, ..DEFAULT };
    const DEFAULT: Parameters = Parameters { n: 2.2, k: 3.2, sigma: 0.35, ks: 1.0, kd: 0.1, kv: 0.0, q: 2.2, c: -0.7, sigma_v: 3.0 };

    fn problem() -> Problem {
        problem_of(Columns::Dolp)
    }

    fn problem_of(columns: Columns) -> Problem {
        let model = Model::full(SlopeDistribution::Cauchy);
        let measurement: Measurement = Simulation {
            model_name: "cauchy".to_owned(),
            surface: Pbrdf::new(model, TRUTH).unwrap(),
            theta_i: vec![30.0, 50.0],
            theta_r: (0..15).map(|i| f64::from(5 * i)).collect(),
            dphi: 180.0,
            columns,
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
    fn brdf_has_its_own_guesses() {
        let lowest = grid_minima(&problem_of(Columns::Brdf))[0];
        // Rounding of the normal equations of relative differences.
        assert!(lowest.misfit < 1e-13, "{lowest:?}");
        for parameter in [Parameter::N, Parameter::K, Parameter::Sigma, Parameter::Q, Parameter::C, Parameter::SigmaV] {
            assert_eq!(lowest.parameters[parameter], TRUTH[parameter], "{parameter:?}");
        }
        for parameter in [Parameter::Ks, Parameter::Kd, Parameter::Kv] {
            assert!((lowest.parameters[parameter] - TRUTH[parameter]).abs() < 1e-5, "{parameter:?}");
        }
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
        let grid = Grid::new(&problem, problem.start(), &AXES, Kind::Dolp).unwrap();
        let guesses = grid.guesses();
        let grid_minima = grid.grid_minima();
        assert!(grid_minima.windows(2).all(|pair| pair[0].misfit <= pair[1].misfit));
        let lowest = guesses.iter().map(|guess| guess.misfit).fold(f64::INFINITY, f64::min);
        // Minima are linearised once more.
        assert!(grid_minima[0].misfit <= lowest);
        let lengths: usize = grid.axes.iter().map(Vec::len).product();
        assert_eq!(guesses.len(), lengths);
        for minimum in &grid_minima {
            let shape = |guess: &Parameters| AXES.map(|(parameter, _)| guess[parameter]);
            let at = guesses.iter().position(|guess| shape(&guess.parameters) == shape(&minimum.parameters)).unwrap();
            // σ_v runs fastest, n slowest.
            for (axis, stride) in [(5, 1), (0, lengths / grid.axes[0].len())] {
                let place = at / stride % grid.axes[axis].len();
                assert!(place == 0 || guesses[at - stride].misfit >= guesses[at].misfit);
                assert!(place + 1 == grid.axes[axis].len() || guesses[at + stride].misfit >= guesses[at].misfit);
            }
        }
    }

    #[test]
    fn without_weights_to_fit_there_are_no_guesses() {
        let problem = problem();
        assert!(grid_minima(&problem.with_free([Parameter::N, Parameter::K].into_iter().collect())).is_empty());
    }
}
