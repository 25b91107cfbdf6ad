//! From the box of the free parameters to all of ℝᵈ, in coordinates in which the valleys of the objective are straight.
//!
//! A parameter p in a … b has the coordinate `ln(p − a) − ln(1 − (p − a)/(b − a))`: its logarithm, with soft walls. Two pairs enter by
//! combinations ([`crate::fit::posterior::valley`]). DoLP knows k_d and k_v relative to the light of the specular lobe alone:
//! `ln(σ²/(h k_s R))` is added to their coordinates (h = 1 for Gauss, q − 1 for Cauchy; R the reflectance at normal incidence), and what
//! the shapes of their lobes do at a mean point. A measured BRDF determines that peak: `ln(h/σ²)` is added to the coordinate of k_s.
//! Depolarised light lowers DoLP as a larger D = n + k²/n does: what it does to the mean of ln DoLP is added to the coordinate of D
//! ([`crate::fit::posterior::depolarised_light`]).
//!
//! Of several measurements each has its transform. A shared coordinate is one of several transforms, and gives the same value in each: what
//! is added to it depends on shared parameters alone.

use crate::fit::objective::Problem;
use crate::fit::posterior::depolarised_light::{DepolarisedLight, LIGHT_PARAMETERS, MeanPoint};
use crate::fit::posterior::valley::Valley;
use crate::fit::posterior::walls::{Walled, Walls};
use crate::model::{Model, Parameter, ParameterSet, Parameters};
use crate::optics::SlopeDistribution;

/// Share of a range that a start keeps away from either wall.
const START_MARGIN: f64 = 1e-3;

/// Added to (n − 1)² + k², so that a surface that reflects nothing has a finite coordinate.
const FAINTEST: f64 = 1e-3;

/// The part that a measurement's parameters play among those of all.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TransformRole {
    /// The parameters that each measurement has for itself.
    pub own: ParameterSet,
    /// Of each free parameter, whether its volume counts here: that of a shared one counts in one measurement.
    pub counted: Vec<bool>,
    /// Whether k_s, k_d and k_v enter by their ratios alone, where they are shared and where they are own.
    pub shared_ratios: bool,
    pub own_ratios: bool,
}

impl TransformRole {
    /// Of a measurement by itself.
    pub(crate) fn alone(problem: &Problem) -> Self {
        let ratios = problem.knows_only_ratios();
        let counted = vec![true; problem.free().len()];
        Self { own: ParameterSet::EMPTY, counted, shared_ratios: ratios, own_ratios: ratios }
    }

    fn knows_only_ratios(&self, parameter: Parameter) -> bool {
        if self.own.contains(parameter) { self.own_ratios } else { self.shared_ratios }
    }

    /// Whether the coordinate of one parameter may depend on another: a shared one's on shared ones.
    fn may_follow(&self, parameter: Parameter, other: Parameter) -> bool {
        self.own.contains(parameter) || !self.own.contains(other)
    }
}

/// The transform of a box.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Transform {
    model: Model,
    role: TransformRole,
    free: Vec<Parameter>,
    held: Parameters,
    low: Parameters,
    high: Parameters,
    /// Pairs, and the places of both parameters among the free ones.
    valleys: Vec<(Valley, [usize; 2])>,
    /// Places of the other free ones, those before whose parameters the coordinates of others depend on.
    single: Vec<usize>,
    /// What is added to the coordinate of D; nothing where n and k are no pair.
    light: DepolarisedLight,
    mean_point: MeanPoint,
    /// Stands for parameters that the coordinate of D may not follow.
    reference: Parameters,
}

/// The parameters at a point of ℝᵈ.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Transformed {
    pub parameters: Parameters,
    /// ln of the volume that a unit volume of ℝᵈ has in the box.
    pub log_jacobian: f64,
    walled: Vec<Walled>,
    /// Derivatives of what is added to the coordinate of D.
    light_slopes: [f64; 4],
}

impl Transform {
    /// For the box of a problem; the ratios of depolarised to specular light are those at a reference, such as a fit.
    pub(crate) fn new(problem: &Problem, reference: &Parameters, role: TransformRole) -> Self {
        let free = problem.free().to_vec();
        let (mut low, mut high) = (*problem.start(), *problem.start());
        for &parameter in &free {
            (low[parameter], high[parameter]) = problem.bounds().of(parameter);
        }
        let place = |parameter: Parameter| free.iter().position(|&other| other == parameter);
        let is_cauchy = problem.model().distribution == SlopeDistribution::Cauchy;
        let valleys: Vec<(Valley, [usize; 2])> = [Valley::Index, Valley::Slope]
            .into_iter()
            .filter(|&valley| valley == Valley::Index || is_cauchy)
            .filter(|valley| {
                let [first, second] = valley.parameters();
                role.own.contains(first) == role.own.contains(second)
            })
            .filter_map(|valley| {
                let [first, second] = valley.parameters().map(place);
                Some((valley, [first?, second?]))
            })
            .collect();
        let mut single: Vec<usize> = (0..free.len()).filter(|place| !valleys.iter().any(|(_, pair)| pair.contains(place))).collect();
        single.sort_by_key(|&place| match free[place] {
            Parameter::Kd | Parameter::Kv => 2,
            Parameter::Ks => 1,
            _ => 0,
        });
        let held = *problem.start();
        let (light, mean_point) = (DepolarisedLight::default(), MeanPoint::default());
        let mut transform =
            Self { model: problem.model(), role, free, held, low, high, valleys, single, light, mean_point, reference: *reference };
        let light = transform.depolarised_light(problem);
        transform.mean_point = light.mean_point();
        // Where D has no coordinate, or nothing is added to it, nothing is evaluated.
        if transform.valleys.first().is_some_and(|(valley, _)| *valley == Valley::Index) && !light.is_dark() {
            transform.light = light;
        }
        transform
    }

    /// With what is added to shared coordinates as a first measurement has it: they give the same values in both.
    pub(crate) fn with_shared_functions_of(mut self, first: &Self) -> Self {
        self.mean_point = first.mean_point;
        if !self.role.own.contains(Parameter::N) {
            (self.light, self.reference) = (first.light.clone(), first.reference);
        }
        self
    }

    /// The depolarised light that lowers DoLP, as far as D may follow it.
    fn depolarised_light(&self, problem: &Problem) -> DepolarisedLight {
        let added = [Parameter::Kd, Parameter::Kv].map(|weight| {
            let follows = self.role.knows_only_ratios(weight) && self.role.may_follow(Parameter::N, weight);
            (follows && self.free.contains(&weight)).then(|| self.peak_shear(weight, &self.reference)).flatten()
        });
        DepolarisedLight::new(problem, &self.reference, added.map(|added| added.map(|(shear, _)| shear)))
    }

    /// What is added to the coordinate of D, and its derivatives by [`LIGHT_PARAMETERS`]: by the coordinates of the weights.
    fn shear_of_d(&self, u: &[f64], p: &Parameters) -> (f64, [f64; 4]) {
        let mut at = self.reference;
        for shape in [Parameter::C, Parameter::SigmaV].into_iter().filter(|&shape| self.role.may_follow(Parameter::N, shape)) {
            at[shape] = p[shape];
        }
        let of = |weight: Parameter| {
            self.place(weight).map_or((0.0, 0.0), |place| {
                let (shape, slope) = self.shape_shear(weight, p);
                (u[place] - shape, slope)
            })
        };
        let ((u_kd, by_c), (u_kv, by_sigma_v)) = (of(Parameter::Kd), of(Parameter::Kv));
        let (mean, mut slopes) = self.light.mean([u_kd, u_kv], at.c, at.sigma_v);
        slopes[2] -= slopes[0] * by_c;
        slopes[3] -= slopes[1] * by_sigma_v;
        for (slope, shape) in slopes[2..].iter_mut().zip([Parameter::C, Parameter::SigmaV]) {
            if !self.role.may_follow(Parameter::N, shape) {
                *slope = 0.0;
            }
        }
        (mean, slopes)
    }

    fn place(&self, parameter: Parameter) -> Option<usize> {
        self.free.iter().position(|&free| free == parameter)
    }

    /// Whether the shape of a depolarising lobe stands there: no other parameter moves its coordinate.
    fn is_shape(&self, place: usize) -> bool {
        matches!(self.free[place], Parameter::C | Parameter::SigmaV)
    }

    /// Lower end of a parameter's range, and its walls counted from there.
    fn walls(&self, parameter: Parameter) -> (f64, Walls) {
        let low = self.low[parameter];
        (low, Walls::between(0.0, self.high[parameter] - low))
    }

    /// The part of what is added to the coordinate of k_d or k_v that depends on the shape of its lobe, and its derivative.
    fn shape_shear(&self, weight: Parameter, p: &Parameters) -> (f64, f64) {
        match weight {
            Parameter::Kd if self.role.may_follow(weight, Parameter::C) => self.mean_point.ln_diffuse(p.c),
            Parameter::Kv if self.role.may_follow(weight, Parameter::SigmaV) => self.mean_point.ln_volume(p.sigma_v),
            _ => (0.0, 0.0),
        }
    }

    /// What is added to the coordinate of a weight, and the derivatives of that by other parameters.
    fn shear(&self, parameter: Parameter, p: &Parameters) -> Option<(f64, [(Parameter, f64); 6])> {
        let (log, [sigma, q, ks, n, k]) = self.peak_shear(parameter, p)?;
        let shape = if parameter == Parameter::Kv { Parameter::SigmaV } else { Parameter::C };
        let (of_shape, slope) = self.shape_shear(parameter, p);
        Some((log + of_shape, [sigma, q, ks, n, k, (shape, slope)]))
    }

    /// The part of it that depends on the specular lobe.
    fn peak_shear(&self, parameter: Parameter, p: &Parameters) -> Option<(f64, [(Parameter, f64); 5])> {
        let knows_only_ratios = self.role.knows_only_ratios(parameter);
        let has_one_peak = [Parameter::Sigma, Parameter::Q].iter().all(|&shape| self.role.may_follow(parameter, shape));
        let sign = match parameter {
            _ if !self.model.specular || !has_one_peak => return None,
            Parameter::Kd | Parameter::Kv if knows_only_ratios => 1.0,
            Parameter::Ks if !knows_only_ratios => -1.0,
            _ => return None,
        };
        let by_ks = knows_only_ratios && self.free.contains(&Parameter::Ks) && self.role.may_follow(parameter, Parameter::Ks);
        let (ks_log, ks_slope) = if by_ks { (libm::log(p.ks), 1.0 / p.ks) } else { (0.0, 0.0) };
        let by_index = knows_only_ratios && [Parameter::N, Parameter::K].iter().all(|&index| self.role.may_follow(parameter, index));
        let (reflectance_log, [by_n, by_k]) = if by_index { ln_normal_reflectance(p) } else { (0.0, [0.0; 2]) };
        let height = self.model.distribution.height(p.q);
        let q_slope = if self.model.distribution == SlopeDistribution::Cauchy { 1.0 / height } else { 0.0 };
        let log = libm::log(p.sigma * p.sigma / height) - ks_log - reflectance_log;
        let by_peak = [(Parameter::Sigma, 2.0 / p.sigma), (Parameter::Q, -q_slope), (Parameter::Ks, -ks_slope)];
        let ([sigma, q, ks], n, k) = (by_peak, (Parameter::N, -by_n), (Parameter::K, -by_k));
        Some((sign * log, [sigma, q, ks, n, k].map(|(by, slope)| (by, sign * slope))))
    }

    /// The parameters at a point of ℝᵈ; reuses the memory of another.
    pub(crate) fn transform(&self, u: &[f64], to: &mut Transformed) {
        to.walled.resize(u.len(), Walled::default());
        to.parameters = self.held;
        // A product of slopes: each lies well within f64 wherever a chain may go, but not all together.
        to.log_jacobian = 0.0;
        for &place in self.single.iter().filter(|&&place| self.is_shape(place)) {
            (to.walled[place], to.parameters[self.free[place]]) = self.single_value(place, u[place]);
        }
        let (shear_of_d, light_slopes) = self.shear_of_d(u, &to.parameters);
        to.light_slopes = light_slopes;
        for &(valley, [first, second]) in &self.valleys {
            let shear = if valley == Valley::Index { shear_of_d } else { 0.0 };
            let one = valley.first_walls(&self.low, &self.high).value(u[first] - shear);
            let moving = valley.second_walls(one.value, &self.low, &self.high);
            let other = moving.walls.value(u[second]);
            let (values, log_volume) = valley.values([one.value, moving.with_gap(other.value)[0]]);
            for (parameter, value) in valley.parameters().into_iter().zip(values) {
                // Rounding may pass an end by an ulp.
                to.parameters[parameter] = value.max(self.low[parameter]).min(self.high[parameter]);
            }
            if self.role.counted[first] {
                to.log_jacobian += log_volume + libm::log(one.slope * other.slope);
            }
            (to.walled[first], to.walled[second]) = (one, other);
        }
        for &place in &self.single {
            let parameter = self.free[place];
            if !self.is_shape(place) {
                let shear = self.shear(parameter, &to.parameters).map_or(0.0, |(shear, _)| shear);
                (to.walled[place], to.parameters[parameter]) = self.single_value(place, u[place] - shear);
            }
            if self.role.counted[place] {
                to.log_jacobian += libm::log(to.walled[place].slope);
            }
        }
    }

    /// The value of a parameter that is no pair's, given its coordinate without what is added to it.
    fn single_value(&self, place: usize, coordinate: f64) -> (Walled, f64) {
        let parameter = self.free[place];
        let (low, walls) = self.walls(parameter);
        let walled = walls.value(coordinate);
        (walled, (low + walled.value).min(self.high[parameter]))
    }

    /// 1 where the volume of a free parameter counts here, else 0.
    fn count(&self, place: usize) -> f64 {
        f64::from(u8::from(self.role.counted[place]))
    }

    /// Adds the derivatives of ln|∂p/∂u| to those of a function by the parameters, in place, and turns all into derivatives by u.
    pub(crate) fn pull_back(&self, at: &Transformed, gradient: &mut [f64]) {
        for &place in self.single.iter().rev() {
            let walled = at.walled[place];
            let slope = gradient[place] * walled.slope + self.count(place) * walled.log_slope_change();
            gradient[place] = slope;
            for (parameter, shear_slope) in self.shear(self.free[place], &at.parameters).into_iter().flat_map(|(_, by)| by) {
                if let Some(other) = self.place(parameter) {
                    gradient[other] -= slope * shear_slope;
                }
            }
        }
        for &(valley, [first, second]) in &self.valleys {
            let (one, other) = (at.walled[first], at.walled[second]);
            let moving = valley.second_walls(one.value, &self.low, &self.high);
            let [combination, jumped] = moving.with_gap(other.value);
            let count = self.count(first);
            let [by_first, by_second] = valley.pull_back([one.value, combination], [gradient[first], gradient[second]], count);
            let [moved, log_slope_moved] = other.moved(moving.walls, moving.slopes);
            gradient[second] = by_second * other.slope + count * other.log_slope_change();
            gradient[first] =
                (by_first + by_second * (moved + jumped) + count * log_slope_moved) * one.slope + count * one.log_slope_change();
            if valley == Valley::Index {
                for (parameter, slope) in LIGHT_PARAMETERS.into_iter().zip(at.light_slopes) {
                    if let Some(place) = self.place(parameter) {
                        let by_coordinate = if self.is_shape(place) { at.walled[place].slope } else { 1.0 };
                        gradient[place] -= gradient[first] * slope * by_coordinate;
                    }
                }
            }
        }
    }

    /// The point of ℝᵈ of parameters in the box; those on its edge are moved a little inside.
    pub(crate) fn coordinates(&self, parameters: &Parameters) -> Vec<f64> {
        let mut p = *parameters;
        for &parameter in &self.free {
            let margin = START_MARGIN * (self.high[parameter] - self.low[parameter]);
            // Small values near a lower bound of 0 are no edge.
            let above = (self.low[parameter] + margin).min(self.low[parameter] + 0.5 * parameter.default_value().abs() * START_MARGIN);
            p[parameter] = p[parameter].clamp(above, self.high[parameter] - margin);
        }
        self.coordinates_inside(&p)
    }

    /// The point of ℝᵈ of parameters inside the box.
    fn coordinates_inside(&self, p: &Parameters) -> Vec<f64> {
        let mut u = vec![0.0; self.free.len()];
        for &place in &self.single {
            let parameter = self.free[place];
            let (low, walls) = self.walls(parameter);
            let shear = self.shear(parameter, p).map_or(0.0, |(shear, _)| shear);
            u[place] = walls.coordinate(p[parameter] - low) + shear;
        }
        for &(valley, [first, second]) in &self.valleys {
            let [one, other] = valley.combinations(p);
            u[first] = valley.first_walls(&self.low, &self.high).coordinate(one);
            let moving = valley.second_walls(one, &self.low, &self.high);
            u[second] = moving.walls.coordinate(moving.without_gap(other));
            if valley == Valley::Index {
                u[first] += self.shear_of_d(&u, p).0;
            }
        }
        u
    }
}

/// ln of the reflectance at normal incidence, `((n − 1)² + k²)/((n + 1)² + k²)`, and its derivatives by n and k.
fn ln_normal_reflectance(p: &Parameters) -> (f64, [f64; 2]) {
    let k_sq = p.k * p.k;
    let above = (p.n - 1.0) * (p.n - 1.0) + k_sq + FAINTEST;
    let below = (p.n + 1.0) * (p.n + 1.0) + k_sq;
    let by_n = 2.0 * ((p.n - 1.0) / above - (p.n + 1.0) / below);
    (libm::log(above / below), [by_n, 2.0 * p.k * (1.0 / above - 1.0 / below)])
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::{Transform, TransformRole, Transformed};
    use crate::fit::{Bounds, FitOptions, Problem};
    use crate::measurement::{Columns, Simulation};
    use crate::model::{Model, Parameter, ParameterSet, Parameters, Pbrdf};
    use nalgebra::DMatrix;

    fn transform(columns: Columns, free: ParameterSet, bounds: &Bounds) -> Transform {
        let model = Model::CAUCHY;
        let surface = Pbrdf::new(model, Parameters::default()).unwrap();
        let (theta_i, theta_r) = (vec![30.0, 60.0], vec![0.0, 20.0, 40.0, 60.0, 70.0]);
        let simulation =
            Simulation { model_name: String::new(), surface, theta_i, theta_r, dphi: 180.0, columns, noise: 0.0, brdf_noise: 0.0, seed: 1 };
        let start = Parameters { n: 1.5, k: 2.5, ..Parameters::default() };
        let problem = Problem::new(&simulation.run().unwrap(), model, start, free, *bounds, FitOptions::default()).unwrap();
        Transform::new(&problem, &start, TransformRole::alone(&problem))
    }

    fn at(transform: &Transform, u: &[f64]) -> Transformed {
        let mut at = Transformed::default();
        transform.transform(u, &mut at);
        at
    }

    fn cases() -> Vec<Transform> {
        let mut narrow = Bounds::default();
        narrow.set(Parameter::N, 1.0, 3.0).unwrap();
        narrow.set(Parameter::K, 2.0, 4.0).unwrap();
        narrow.set(Parameter::C, -0.7, -0.2).unwrap();
        // Circles of constant D leave this box at the top.
        let mut flat = Bounds::default();
        flat.set(Parameter::K, 1.0, 3.0).unwrap();
        let without_ks = ParameterSet::ALL.without(Parameter::Ks);
        let without_n = without_ks.without(Parameter::N);
        [(Columns::Dolp, ParameterSet::ALL), (Columns::Dolp, without_ks), (Columns::Both, ParameterSet::ALL), (Columns::Dolp, without_n)]
            .into_iter()
            .flat_map(|(columns, free)| [Bounds::default(), narrow, flat].map(|bounds| transform(columns, free, &bounds)))
            .collect()
    }

    /// Points of ℝᵈ near and far from the middle of the box, on both sides of the corners of n and k.
    fn points(dimension: usize) -> impl Iterator<Item = Vec<f64>> {
        (0..40).map(move |i| (0..dimension).map(|j| 2.5 * libm::sin(1.0 + 7.3 * i as f64 + 3.1 * j as f64)).collect())
    }

    #[test]
    fn the_transform_inverts_and_its_jacobian_is_the_volume() {
        for transform in cases() {
            for u in points(transform.free.len()) {
                let at = self::at(&transform, &u);
                let back = transform.coordinates_inside(&at.parameters);
                assert!(u.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-7), "{u:?} {back:?}");
                // Central differences of 1e-5 leave 1e-10 of a third derivative and rounding.
                let column = |j: usize, h: f64| {
                    let mut there = u.clone();
                    there[j] += h;
                    self::at(&transform, &there).parameters
                };
                let matrix = DMatrix::from_fn(u.len(), u.len(), |i, j| {
                    (column(j, 1e-5)[transform.free[i]] - column(j, -1e-5)[transform.free[i]]) / 2e-5
                });
                let expected = libm::log(matrix.determinant().abs());
                assert!((at.log_jacobian - expected).abs() < 1e-5, "{u:?}: {} instead of {expected}", at.log_jacobian);
            }
        }
    }

    #[test]
    fn derivatives_are_pulled_back_with_those_of_the_volume() {
        for transform in cases() {
            let function = |p: &Parameters| transform.free.iter().enumerate().map(|(i, &q)| (i as f64 + 1.0) * p[q] * p[q]).sum::<f64>();
            for u in points(transform.free.len()) {
                let at = self::at(&transform, &u);
                let mut gradient: Vec<f64> =
                    transform.free.iter().enumerate().map(|(i, &q)| 2.0 * (i as f64 + 1.0) * at.parameters[q]).collect();
                transform.pull_back(&at, &mut gradient);
                for j in 0..u.len() {
                    let value = |h: f64| {
                        let mut there = u.clone();
                        there[j] += h;
                        let at = self::at(&transform, &there);
                        function(&at.parameters) + at.log_jacobian
                    };
                    let expected = (value(1e-5) - value(-1e-5)) / 2e-5;
                    assert!((gradient[j] - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{j} {u:?}: {} {expected}", gradient[j]);
                }
            }
        }
    }
}
