//! The direction that the data determine least, followed as a geodesic of the model manifold until a bound is met: Transtrum and Qiu,
//! Phys. Rev. Lett. 113, 098701 (2014).
//!
//! The residuals r(u) of all parameters u form a surface in the space of the data. A geodesic is a line on it that is as straight as
//! the surface allows: `Jᵀ(J ü + r″(u̇, u̇)) = 0`, so that `ü = −J⁺ r″(u̇, u̇)`. It begins along the right singular vector of J with the
//! smallest singular value. Data space is crossed evenly, parameter space faster and faster towards a limit of the model; the same line
//! is followed here evenly in u, by its part of ü that is at right angles to u̇.
//!
//! The coordinate of n, k, σ, q and σ_v is the logarithm of their distance from an origin, as in a fit; that of weights and c is the
//! parameter in units of max(|value|, 0.1) at the beginning.

mod manifold;

use crate::fit::analysis::edge;
use crate::fit::estimate::Edge;
use crate::fit::fit_problem::{FitProblem, UnknownName};
use crate::fit::intervals::profile::rise;
use crate::fit::observer::Observer;
use crate::model::Parameter;
use manifold::{LONGEST_STEP, Manifold};
use nalgebra::DVector;
use std::fmt;

/// Longest path: every logarithm has crossed its range by then.
const LONGEST_PATH: f64 = 40.0;
/// A bound is met within this distance in u.
const NEAR_BOUND: f64 = 1e-7;
/// Level of the sum of squares up to which the data allow a surface.
const LEVEL: f64 = 0.95;

/// Which way along the direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GeodesicWay {
    /// Towards the limit that is nearer by the bend of the surface: parameters move faster and faster.
    #[default]
    Nearer,
    /// The other way.
    Farther,
}

/// A surface on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct GeodesicPoint<P> {
    /// All parameters; of several measurements, those of each.
    pub parameters: P,
    /// Sum of the squares of the residuals.
    pub sum_of_squares: f64,
    /// Length of the way in the coordinates of the module.
    pub length: f64,
}

/// Why a geodesic ends.
#[derive(Debug, Clone, PartialEq)]
pub enum GeodesicEnd<N = Parameter> {
    /// A parameter meets its bound.
    Bound {
        /// Which parameter.
        unknown: N,
        /// Which bound.
        edge: Edge,
        /// Its value there.
        value: f64,
    },
    /// The sum of squares has reached its limit at 95 %: the data hold even this direction.
    Misfit,
    /// No parameter can move: none is free, or all rest on bounds.
    NothingMoves,
    /// A residual or a derivative is not finite, or the line bends too sharply to be followed.
    Lost,
    /// Every range has been crossed.
    Endless,
    /// It was cancelled.
    Cancelled,
}

/// A geodesic along the direction that the data determine least.
#[derive(Debug, Clone, PartialEq)]
pub struct Geodesic<N, P> {
    /// The way, its beginning included.
    pub points: Vec<GeodesicPoint<P>>,
    /// The direction at its beginning in the coordinates of the module, of length 1.
    pub direction: Vec<(N, f64)>,
    /// Sum of squares at the limit of 95 %.
    pub limit: f64,
    /// Why it ends.
    pub end: GeodesicEnd<N>,
}

impl<N, P> Geodesic<N, P> {
    /// The same with other names and points.
    #[must_use]
    pub fn map<M, Q>(self, name: impl Fn(N) -> M, point: impl Fn(P) -> Q) -> Geodesic<M, Q> {
        let moved = |GeodesicPoint { parameters, sum_of_squares, length }: GeodesicPoint<P>| GeodesicPoint {
            parameters: point(parameters),
            sum_of_squares,
            length,
        };
        let end = match self.end {
            GeodesicEnd::Bound { unknown, edge, value } => GeodesicEnd::Bound { unknown: name(unknown), edge, value },
            GeodesicEnd::Misfit => GeodesicEnd::Misfit,
            GeodesicEnd::NothingMoves => GeodesicEnd::NothingMoves,
            GeodesicEnd::Lost => GeodesicEnd::Lost,
            GeodesicEnd::Endless => GeodesicEnd::Endless,
            GeodesicEnd::Cancelled => GeodesicEnd::Cancelled,
        };
        Geodesic {
            points: self.points.into_iter().map(moved).collect(),
            direction: self.direction.into_iter().map(|(unknown, along)| (name(unknown), along)).collect(),
            limit: self.limit,
            end,
        }
    }
}

impl<N: UnknownName> GeodesicEnd<N> {
    /// What it means that a parameter meets this bound; none where that is nothing but the end of its range.
    #[must_use]
    pub fn meaning(&self) -> Option<&'static str> {
        let Self::Bound { unknown, edge, .. } = self else { return None };
        match (unknown.parameter(), edge) {
            (Parameter::Q, Edge::Upper) => Some("q grows without end: the data cannot tell Cauchy from Gauss"),
            (Parameter::Kd, Edge::Lower) => Some("the data can do without diffuse light"),
            (Parameter::Kv, Edge::Lower) => Some("the data can do without volume scattering"),
            (Parameter::K, Edge::Lower) => Some("the data cannot tell the metal from a dielectric"),
            (Parameter::Sigma, Edge::Upper) => Some("the data set no limit to the roughness"),
            _ => None,
        }
    }
}

impl<N: UnknownName> fmt::Display for GeodesicEnd<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bound { unknown, edge, value } => {
                let which = if *edge == Edge::Lower { "lower" } else { "upper" };
                write!(f, "{} meets its {which} bound {value}", unknown.symbol())?;
                self.meaning().map_or(Ok(()), |meaning| write!(f, ": {meaning}"))
            }
            Self::Misfit => f.write_str("the data hold every direction: the misfit has reached the limit of 95 % before any bound"),
            Self::NothingMoves => f.write_str("no parameter can move"),
            Self::Lost => f.write_str("the direction bends too sharply to be followed any further"),
            Self::Endless => f.write_str("no bound is met, however far one goes"),
            Self::Cancelled => f.write_str("cancelled"),
        }
    }
}

/// Follows the direction that the data determine least, from a minimum of the problem.
///
/// Weights of DoLP and BRDF and scales of the loss are those of the problem: take that of [`crate::fit::FitResult::fitted`].
#[must_use]
pub fn weakest_geodesic<P: FitProblem>(
    problem: &P,
    from: &P::Point,
    way: GeodesicWay,
    observer: Observer<'_>,
) -> Geodesic<P::Name, P::Point> {
    let x = problem.unknowns_of(from);
    let sum_of_squares = problem.sum_of_squares_at(&x).unwrap_or(f64::NAN);
    let moving: Vec<usize> = (0..x.len()).filter(|&j| edge(problem, &x, j).is_none()).collect();
    let first = GeodesicPoint { parameters: from.clone(), sum_of_squares, length: 0.0 };
    let nowhere = |end| Geodesic { points: vec![first.clone()], direction: Vec::new(), limit: sum_of_squares, end };
    if moving.is_empty() || problem.residual_count() == 0 {
        return nowhere(GeodesicEnd::NothingMoves);
    }
    let manifold = Manifold::new(problem, x, moving);
    let mut at = manifold.start();
    let Some((direction, rank)) = manifold.weakest(&at) else { return nowhere(GeodesicEnd::Lost) };
    let dof = problem.residual_count().saturating_sub(rank);
    let limit = sum_of_squares + rise(problem.options().weights, sum_of_squares, dof, LEVEL);
    let Some(forward) = manifold.forward(&at, &direction) else { return nowhere(GeodesicEnd::Lost) };
    let mut heading = if (way == GeodesicWay::Nearer) == forward { direction } else { -direction };
    let names = |heading: &DVector<f64>| {
        manifold.moving.iter().zip(heading.iter()).map(|(&j, along)| (problem.names()[j].clone(), *along)).collect()
    };
    let mut geodesic = Geodesic { points: vec![first.clone()], direction: names(&heading), limit, end: GeodesicEnd::Endless };
    let (mut length, mut step) = (0.0, 0.1 * LONGEST_STEP);
    while length < LONGEST_PATH {
        if (observer.cancelled)() {
            geodesic.end = GeodesicEnd::Cancelled;
            break;
        }
        let (to_bound, bound) = manifold.to_bound(&at, &heading);
        if to_bound < NEAR_BOUND {
            geodesic.end = bound_met(problem, &manifold, &mut geodesic.points, &at, bound);
            break;
        }
        let Some(next) = manifold.advance(&at, &heading, &mut step, to_bound) else {
            geodesic.end = GeodesicEnd::Lost;
            break;
        };
        let sum_of_squares = manifold.sum_of_squares(&next.at);
        if sum_of_squares > limit || sum_of_squares.is_nan() {
            geodesic.end = if sum_of_squares.is_nan() { GeodesicEnd::Lost } else { GeodesicEnd::Misfit };
            break;
        }
        length += next.length;
        (at, heading) = (next.at, next.heading);
        geodesic.points.push(GeodesicPoint { parameters: problem.point_at(&manifold.unknowns(&at)), sum_of_squares, length });
    }
    geodesic
}

/// The last point lies on the bound exactly.
fn bound_met<P: FitProblem>(
    problem: &P,
    manifold: &Manifold<'_, P>,
    points: &mut [GeodesicPoint<P::Point>],
    u: &DVector<f64>,
    (i, edge): (usize, Edge),
) -> GeodesicEnd<P::Name> {
    let unknown = manifold.moving[i];
    let (low, high) = problem.bounds_of(unknown);
    let value = if edge == Edge::Lower { low } else { high };
    let mut x = manifold.unknowns(u);
    x[unknown] = value;
    if let Some((last, sum_of_squares)) = points.last_mut().zip(problem.sum_of_squares_at(&x)) {
        last.parameters = problem.point_at(&x);
        last.sum_of_squares = sum_of_squares;
    }
    GeodesicEnd::Bound { unknown: problem.names()[unknown].clone(), edge, value }
}

#[cfg(test)]
mod tests {
    use super::{GeodesicEnd, GeodesicWay, Manifold, weakest_geodesic};
    use crate::fit::builder::Fit;
    use crate::fit::estimate::Edge;
    use crate::fit::fit_problem::FitProblem as _;
    use crate::fit::multistart::search::Starts;
    use crate::fit::objective::Problem;
    use crate::fit::observer::Observer;
    use crate::fit::solve::fit;
    use crate::measurement::{Columns, Measurement, Simulation};
    use crate::model::{Model, Parameter, Parameters, Pbrdf};
    use nalgebra::DVector;

    const STEEL: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6 };

    /// The paper's angles on its steel.
    fn steel(noise: f64) -> Measurement {
        let surface = Pbrdf::new(Model::CAUCHY, STEEL).unwrap();
        let theta_r = (0..9).map(|i| 20.0 + 5.0 * f64::from(i)).collect();
        let (theta_i, dphi, columns) = (vec![30.0, 40.0, 50.0], 180.0, Columns::Dolp);
        let simulation =
            Simulation { model_name: String::new(), surface, theta_i, theta_r, dphi, columns, noise, brdf_noise: 0.0, seed: 1 };
        simulation.run().unwrap()
    }

    fn problem(data: &Measurement) -> (Problem, Parameters) {
        let problem = Fit::new(data, Model::CAUCHY).problem().unwrap();
        let result = fit(&problem, Starts::Automatic, 1, Observer::NONE);
        (problem, result.parameters)
    }

    #[test]
    fn the_acceleration_leaves_no_bend_within_the_surface() {
        let data = steel(0.005);
        let problem = Fit::new(&data, Model::CAUCHY).problem().unwrap();
        let manifold = Manifold::new(&problem, problem.unknowns_of(&STEEL), (0..problem.names().len()).collect());
        let u = manifold.start();
        let heading = DVector::from_iterator(u.len(), (0_u32..).map(|i| libm::sin(1.0 + 3.0 * f64::from(i))).take(u.len())).normalize();
        let acceleration = manifold.acceleration(&u, &heading).unwrap();
        // Second difference of the residuals along a straight line, and what the acceleration adds: the sum is at right angles to the surface.
        let h = 1e-4;
        let residuals = |t: f64| problem.linearised_at(&manifold.unknowns(&(&u + &heading * t))).unwrap().0;
        let straight = (residuals(h) - residuals(0.0) * 2.0 + residuals(-h)) / (h * h);
        let jacobian = manifold.jacobian(&u).unwrap();
        let curved = &straight + &jacobian * &acceleration;
        let within = |bend: &DVector<f64>| jacobian.column_iter().map(|column| column.dot(bend).abs() / column.norm()).fold(0.0, f64::max);
        // Rounding of residuals of order 1 over h² is 1e-8; h² of a fourth derivative is as much.
        assert!(within(&curved) < 1e-4 * straight.norm(), "{} of {}", within(&curved), straight.norm());
        assert!(within(&straight) > 0.1 * straight.norm());
    }

    #[test]
    fn on_few_angles_it_ends_on_a_bound_and_the_data_hardly_notice() {
        let (problem, at) = problem(&steel(0.005));
        for way in [GeodesicWay::Nearer, GeodesicWay::Farther] {
            let geodesic = weakest_geodesic(&problem, &at, way, Observer::NONE);
            assert!(matches!(geodesic.end, GeodesicEnd::Bound { .. } | GeodesicEnd::Misfit), "{way:?}: {:?}", geodesic.end);
            assert!(geodesic.points.iter().all(|point| point.sum_of_squares <= geodesic.limit), "{way:?}");
            assert!(geodesic.points.windows(2).all(|pair| pair[0].length < pair[1].length));
        }
        let geodesic = weakest_geodesic(&problem, &at, GeodesicWay::Nearer, Observer::NONE);
        let GeodesicEnd::Bound { unknown, edge, value } = &geodesic.end else { panic!("no bound: {:?}", geodesic.end) };
        let last = geodesic.points.last().unwrap();
        assert_eq!(last.parameters[*unknown], *value);
        let (low, high) =
            crate::fit::least_squares::LeastSquares::bounds_of(&problem, problem.names().iter().position(|name| name == unknown).unwrap());
        assert_eq!(*value, if *edge == Edge::Lower { low } else { high });
    }

    #[test]
    fn dense_angles_hold_every_direction() {
        let data = Simulation {
            model_name: String::new(),
            surface: Pbrdf::new(Model::SPECULAR, Parameters { n: 2.07, k: 2.9, ..Parameters::default() }).unwrap(),
            theta_i: (1..9).map(|i| 10.0 * f64::from(i)).collect(),
            theta_r: (0..18).map(|i| 5.0 * f64::from(i)).collect(),
            dphi: 180.0,
            columns: Columns::Dolp,
            noise: 0.001,
            brdf_noise: 0.0,
            seed: 1,
        };
        let data = data.run().unwrap();
        let problem = Fit::new(&data, Model::SPECULAR).free(Parameter::N).free(Parameter::K).problem().unwrap();
        let at = fit(&problem, Starts::Automatic, 1, Observer::NONE).parameters;
        let geodesic = weakest_geodesic(&problem, &at, GeodesicWay::Nearer, Observer::NONE);
        assert_eq!(geodesic.end, GeodesicEnd::Misfit);
        assert!((geodesic.points.last().unwrap().parameters.n - at.n).abs() < 0.1);
    }

    #[test]
    fn what_rests_on_a_bound_does_not_move_and_a_cancelled_one_keeps_its_points() {
        let (problem, at) = problem(&steel(0.005));
        let at = Parameters { q: 20.0, ..at };
        let stop = || true;
        let cancelled = weakest_geodesic(&problem, &at, GeodesicWay::Nearer, Observer { cancelled: &stop, ..Observer::NONE });
        assert_eq!((cancelled.end, cancelled.points.len()), (GeodesicEnd::Cancelled, 1));
        let geodesic = weakest_geodesic(&problem, &at, GeodesicWay::Nearer, Observer::NONE);
        assert!(geodesic.points.iter().all(|point| point.parameters.q == 20.0));
        assert!(geodesic.direction.iter().all(|(name, _)| *name != Parameter::Q));
    }
}
