//! The posterior as a density on ℝᵈ: likelihood, priors and the volume of the transform.

use crate::fit::fit_problem::FitProblem;
use crate::fit::options::Weights;
use crate::fit::posterior::likelihood::{Misfit, SquareSums, SumGradients, log_likelihood};
use crate::fit::posterior::log_density::LogDensity;
use crate::fit::posterior::parts::{PosteriorPart, PosteriorProblem};
use crate::fit::posterior::prior::BoundedPrior;
use crate::fit::posterior::transform::{Transform, Transformed};
use crate::model::{Parameter, Parameters};
use nalgebra::DVector;

/// Likelihood × priors in the coordinates of a transform.
#[derive(Debug, Clone)]
pub(crate) struct PosteriorDensity<P> {
    problem: P,
    parts: Vec<DensityPart>,
    /// Of each unknown.
    priors: Vec<BoundedPrior>,
    by_sigma: bool,
}

/// What one measurement adds.
#[derive(Debug, Clone)]
struct DensityPart {
    misfit: Misfit,
    transform: Transform,
    free: Vec<Parameter>,
    held: Parameters,
    /// The unknown of each free parameter, and whether it counts here.
    places: Vec<usize>,
    counted: Vec<bool>,
    coordinates: Vec<f64>,
    at: Transformed,
    by: SumGradients,
    gradient: Vec<f64>,
}

impl DensityPart {
    fn new(part: PosteriorPart, x: &DVector<f64>, first: Option<&Self>) -> Self {
        let free = part.problem.free().to_vec();
        let held = *part.problem.start();
        let counted = part.role.counted.clone();
        let mut transform = Transform::new(&part.problem, &parameters_at(&free, &part.places, held, x), part.role);
        if let Some(first) = first {
            transform = transform.with_shared_functions_of(&first.transform);
        }
        let zeros = || vec![0.0; free.len()];
        Self {
            misfit: Misfit::new(&part.problem),
            transform,
            held,
            places: part.places,
            counted,
            coordinates: zeros(),
            at: Transformed::default(),
            by: [zeros(), zeros()],
            gradient: zeros(),
            free,
        }
    }

    fn parameters_at(&self, x: &DVector<f64>) -> Parameters {
        parameters_at(&self.free, &self.places, self.held, x)
    }

    /// Goes to a point of all coordinates; adds its sums of squares.
    fn go_to(&mut self, at: &[f64], sums: &mut SquareSums) -> Option<()> {
        let Self { misfit, transform, coordinates, at: there, by, .. } = self;
        coordinates.iter_mut().zip(&self.places).for_each(|(slot, &place)| *slot = at[place]);
        transform.transform(coordinates, there);
        let of_part = misfit.sums_and_gradients(&there.parameters, by)?;
        sums.iter_mut().zip(of_part).for_each(|(sum, of_part)| *sum += of_part);
        Some(())
    }

    /// Adds its share of the gradient, given the derivatives of ln L by the sums; returns priors and volume.
    fn add_to(&mut self, slopes: [f64; 2], priors: &[BoundedPrior], gradient: &mut [f64]) -> f64 {
        let mut value = 0.0;
        for (j, slot) in self.gradient.iter_mut().enumerate() {
            *slot = slopes[0] * self.by[0][j] + slopes[1] * self.by[1][j];
            if self.counted[j] {
                let (log, slope) = priors[self.places[j]].log_density(self.at.parameters[self.free[j]]);
                value += log;
                *slot += slope;
            }
        }
        self.transform.pull_back(&self.at, &mut self.gradient);
        self.places.iter().zip(&self.gradient).for_each(|(&place, slope)| gradient[place] += slope);
        value + self.at.log_jacobian
    }
}

/// The parameters of a measurement, given all unknowns.
fn parameters_at(free: &[Parameter], places: &[usize], held: Parameters, x: &DVector<f64>) -> Parameters {
    let mut parameters = held;
    free.iter().zip(places).for_each(|(&parameter, &place)| parameters[parameter] = x[place]);
    parameters
}

impl<P: PosteriorProblem> PosteriorDensity<P> {
    /// Of a problem with a prior for each unknown; light of depolarising lobes is compared at a reference, such as a fit.
    pub(crate) fn new(problem: &P, priors: Vec<BoundedPrior>, reference: &P::Point) -> Self {
        let x = problem.unknowns_of(reference);
        let mut parts: Vec<DensityPart> = Vec::new();
        for part in problem.posterior_parts() {
            parts.push(DensityPart::new(part, &x, parts.first()));
        }
        Self { problem: problem.clone(), parts, priors, by_sigma: problem.options().weights == Weights::Sigma }
    }

    /// Number of residuals of DoLP and of BRDF.
    pub(crate) fn counts(&self) -> [usize; 2] {
        let of = |block: usize| self.parts.iter().map(|part| part.misfit.counts()[block]).sum();
        [of(0), of(1)]
    }

    /// Sums of squares in units of the measured values: of DoLP, of BRDF.
    pub(crate) fn square_sums(&mut self, x: &DVector<f64>) -> SquareSums {
        let mut sums = [0.0; 2];
        for part in &mut self.parts {
            let parameters = part.parameters_at(x);
            sums.iter_mut().zip(part.misfit.square_sums(&parameters)).for_each(|(sum, of_part)| *sum += of_part);
        }
        sums
    }

    /// ln L of those unknowns, and their place in ℝᵈ; none where it is not finite.
    pub(crate) fn start_at(&mut self, point: &P::Point) -> Option<(f64, Vec<f64>)> {
        let x = self.problem.unknowns_of(point);
        let counts = self.counts();
        let mut sums = [0.0; 2];
        let mut u = vec![0.0; x.len()];
        for part in &mut self.parts {
            let parameters = part.parameters_at(&x);
            let of_part = part.misfit.sums_and_gradients(&parameters, &mut part.by)?;
            sums.iter_mut().zip(of_part).for_each(|(sum, of_part)| *sum += of_part);
            part.places.iter().zip(part.transform.coordinates(&parameters)).for_each(|(&place, slot)| u[place] = slot);
        }
        let value: f64 = [0, 1].map(|block| log_likelihood(sums[block], counts[block], self.by_sigma).0).iter().sum();
        value.is_finite().then_some((value, u))
    }

    /// The unknowns at a point of ℝᵈ, and ln of the volume that a unit volume has there.
    pub(crate) fn unknowns_at(&self, u: &[f64]) -> (DVector<f64>, f64) {
        let mut x = DVector::zeros(u.len());
        let mut at = Transformed::default();
        let mut log_jacobian = 0.0;
        for part in &self.parts {
            let coordinates: Vec<f64> = part.places.iter().map(|&place| u[place]).collect();
            part.transform.transform(&coordinates, &mut at);
            log_jacobian += at.log_jacobian;
            part.free.iter().zip(&part.places).for_each(|(&parameter, &place)| x[place] = at.parameters[parameter]);
        }
        (x, log_jacobian)
    }
}

impl<P: FitProblem> LogDensity for PosteriorDensity<P> {
    fn dimension(&self) -> usize {
        self.priors.len()
    }

    fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(0.0);
        let mut sums = [0.0; 2];
        let mut counts = [0; 2];
        for part in &mut self.parts {
            if part.go_to(at, &mut sums).is_none() {
                return f64::NEG_INFINITY;
            }
            counts.iter_mut().zip(part.misfit.counts()).for_each(|(count, of_part)| *count += of_part);
        }
        let terms = [0, 1].map(|block| log_likelihood(sums[block], counts[block], self.by_sigma));
        let slopes = terms.map(|(_, slope)| slope);
        let rest: f64 = self.parts.iter_mut().map(|part| part.add_to(slopes, &self.priors, gradient)).sum();
        let value = terms[0].0 + terms[1].0 + rest;
        if value.is_finite() && gradient.iter().all(|slope| slope.is_finite()) { value } else { f64::NEG_INFINITY }
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::PosteriorDensity;
    use crate::fit::fit_problem::FitProblem as _;
    use crate::fit::joint::builder::JointFit;
    use crate::fit::joint::problem::JointProblem;
    use crate::fit::options::{FitOptions, Weights};
    use crate::fit::posterior::log_density::LogDensity as _;
    use crate::fit::posterior::prior::{BoundedPrior, Prior};
    use crate::measurement::{Columns, Measurement, Simulation};
    use crate::model::Parameter::{C, K, Kd, Ks, Kv, N, Q, Sigma, SigmaV};
    use crate::model::{Model, ParameterSet, Parameters, Pbrdf};
    use nalgebra::DMatrix;

    fn measurement(name: &str, columns: Columns, n: f64) -> Measurement {
        let surface = Pbrdf::new(Model::CAUCHY, Parameters { n, ..Parameters::default() }).unwrap();
        let (theta_i, theta_r) = (vec![30.0, 60.0], vec![0.0, 20.0, 40.0, 60.0, 70.0]);
        let (noise, brdf_noise, seed) = (0.01, 0.02, 1);
        let simulation = Simulation { model_name: String::new(), surface, theta_i, theta_r, dphi: 180.0, columns, noise, brdf_noise, seed };
        Measurement { name: name.to_owned(), ..simulation.run().unwrap() }
    }

    fn problems() -> Vec<JointProblem> {
        let (blue, red) = (measurement("blue", Columns::Dolp, 1.4), measurement("red", Columns::Dolp, 1.7));
        let green = measurement("green", Columns::Both, 1.5);
        let own: [&[_]; 8] = [&[], &[N, K], &[N], &[Sigma, Q], &[Sigma], &[Kd, Kv], &[Kv, N, K, C, Ks], &[Q, Ks]];
        let mut problems = Vec::new();
        for own in own {
            for (measurements, weights) in [([&blue, &red], Weights::None), ([&blue, &green], Weights::Sigma)] {
                let options = FitOptions { weights, ..FitOptions::default() };
                let fit = JointFit::new(measurements, Model::CAUCHY).own(own.iter().copied()).options(options);
                problems.push(fit.problem().unwrap());
            }
        }
        let all: ParameterSet = Model::CAUCHY.parameters();
        problems.push(JointFit::new([&blue, &red, &green], Model::CAUCHY).own(all.iter()).problem().unwrap());
        for (measurements, weights) in [([&blue, &red], Weights::None), ([&blue, &green], Weights::Sigma)] {
            let options = FitOptions { weights, ..FitOptions::default() };
            let fit = || JointFit::new(measurements, Model::CAUCHY).own([N]).options(options);
            problems.push(fit().weights([3.0, 0.5]).problem().unwrap());
            // A shared parameter to a shared one, and one to an own one, so that it is own too.
            problems.push(fit().each(|fit| fit.tie(SigmaV, 1.5, Sigma)).problem().unwrap());
            problems.push(fit().weights([0.2, 1.0]).each(|fit| fit.tie(K, 1.2, N).tie(Kv, 0.7, Kd)).problem().unwrap());
        }
        problems
    }

    fn density(problem: &JointProblem) -> PosteriorDensity<JointProblem> {
        let normal = |name: &crate::fit::JointUnknown| Prior::Normal { mean: problem.start()[0][name.parameter], sd: 0.3 };
        let parts = problem.parts();
        let prior = |name| BoundedPrior::new(normal(name), parts[0].bounds().of(name.parameter));
        PosteriorDensity::new(problem, problem.names().iter().map(prior).collect(), problem.start_point())
    }

    /// Points of ℝᵈ about the start.
    fn points(density: &mut PosteriorDensity<JointProblem>, problem: &JointProblem) -> Vec<Vec<f64>> {
        let (_, start) = density.start_at(problem.start_point()).unwrap();
        let at =
            |i: usize| start.iter().enumerate().map(move |(j, u)| u + 0.8 * libm::sin(1.0 + 7.3 * i as f64 + 3.1 * j as f64)).collect();
        (0..6).map(at).collect()
    }

    #[test]
    fn the_gradient_of_several_measurements_is_that_of_differences() {
        for problem in problems() {
            let mut density = density(&problem);
            for u in points(&mut density, &problem) {
                let mut gradient = vec![0.0; u.len()];
                density.value_and_gradient(&u, &mut gradient);
                for j in 0..u.len() {
                    let mut value = |h: f64| {
                        let mut there = u.clone();
                        there[j] += h;
                        density.value_and_gradient(&there, &mut vec![0.0; u.len()])
                    };
                    // Differences of 1e-4, extrapolated, leave 1e-16 of a fifth derivative, and rounding of values of thousands.
                    let difference = (8.0 * (value(1e-4) - value(-1e-4)) - (value(2e-4) - value(-2e-4))) / 12e-4;
                    let names = problem.names();
                    assert!(
                        (gradient[j] - difference).abs() < 1e-5 * (1.0 + difference.abs()),
                        "{names:?} {j}: {} {difference}",
                        gradient[j]
                    );
                }
            }
        }
    }

    #[test]
    fn the_volume_of_several_measurements_is_the_determinant_and_shared_values_agree() {
        for problem in problems() {
            let mut density = density(&problem);
            for u in points(&mut density, &problem) {
                let column = |j: usize, h: f64| {
                    let mut there = u.clone();
                    there[j] += h;
                    density.unknowns_at(&there).0
                };
                let matrix = DMatrix::from_fn(u.len(), u.len(), |i, j| (column(j, 1e-5)[i] - column(j, -1e-5)[i]) / 2e-5);
                let (x, log_jacobian) = density.unknowns_at(&u);
                let expected = libm::log(matrix.determinant().abs());
                assert!((log_jacobian - expected).abs() < 1e-5, "{:?}: {log_jacobian} instead of {expected}", problem.names());
                for part in &mut density.parts {
                    let coordinates: Vec<f64> = part.places.iter().map(|&place| u[place]).collect();
                    part.transform.transform(&coordinates, &mut part.at);
                    for (&parameter, &place) in part.free.iter().zip(&part.places) {
                        let value = part.at.parameters[parameter];
                        assert!(
                            (value - x[place]).abs() <= 1e-14 * value.abs(),
                            "{:?} {parameter:?}: {value} {}",
                            problem.names(),
                            x[place]
                        );
                    }
                }
            }
        }
    }
}
