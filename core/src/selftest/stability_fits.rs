//! The fits of the stability gallery: simulated data whose truth is known, and what has to come out.

use crate::fit::{Bounds, Edge, FitOptions, FitResult, Loss, Observer, Problem, Starts, StopReason, fit, free_by_default};
use crate::measurement::{Columns, Measurement, Simulation};
use crate::model::{Parameter, ParameterSet, Parameters, Pbrdf, Preset};
use crate::selftest::stability_case::{Setting, Stability, StabilityCase, StabilityOutcome};

/// What a fit has to do.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Bar {
    /// Reach the noise-free minimum: ΔE ≤ 1e-20.
    Exact,
    /// Reach it, and with it the truth, to 1e-6 in each parameter.
    Truth,
    /// Say that these are open, and give them no standard error.
    Open(&'static [Parameter]),
    /// Reach the minimum with this parameter on this bound.
    AtBound(Parameter, Edge),
    /// Be no worse than the truth, which lies within four standard errors in every determined parameter.
    Covers,
    /// Bring n within a twentieth of the truth.
    SparesOutliers,
    /// End so, without a number that is none.
    Ends(StopReason),
}

/// A fit of the gallery.
pub(crate) struct StiffFit {
    pub(crate) case: &'static str,
    preset: &'static str,
    truth: Parameters,
    start: Parameters,
    starts: Starts,
    measurement: Measurement,
    free: Option<ParameterSet>,
    loss: Loss,
    bar: Bar,
}

/// The 45# steel of the paper's Fig. 6 under its own angles: 27 points.
const STEEL_THETA_I: [f64; 3] = [30.0, 40.0, 50.0];
const STEEL_THETA_R: [f64; 9] = [20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0];
/// Angles that determine all eight parameters of a fit to DoLP.
const DENSE_THETA_I: [f64; 8] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];

/// Seed of all noise.
const SEED: u64 = 20_211_129;
/// Objective of a fit that agrees with noise-free data to the last digits.
const EXACT: f64 = 1e-20;

fn dense_theta_r() -> Vec<f64> {
    (0..18).map(|i| 5.0 * f64::from(i)).collect()
}

fn steel() -> Parameters {
    Parameters { n: 2.07, k: 2.9, sigma: 0.25, ks: 1.0, kd: 0.12, kv: 0.15, q: 1.8, c: -0.4, sigma_v: 0.6 }
}

/// DoLP of that surface with Gaussian noise; empty where the preset or the angles are none.
fn simulate(preset: &str, truth: Parameters, theta_i: &[f64], theta_r: &[f64], columns: Columns, noise: f64) -> Measurement {
    let surface = Preset::from_key(preset).and_then(|preset| Pbrdf::new(preset.model, truth).ok());
    let simulation = surface.map(|surface| Simulation {
        model_name: preset.to_owned(),
        surface,
        theta_i: theta_i.to_vec(),
        theta_r: theta_r.to_vec(),
        dphi: 180.0,
        columns,
        noise,
        brdf_noise: noise,
        seed: SEED,
    });
    simulation.and_then(|simulation| simulation.run().ok()).unwrap_or_default()
}

fn dolp(truth: Parameters, noise: f64) -> Measurement {
    simulate("cauchy", truth, &DENSE_THETA_I, &dense_theta_r(), Columns::Dolp, noise)
}

fn steel_dolp(noise: f64) -> Measurement {
    simulate("cauchy", steel(), &STEEL_THETA_I, &STEEL_THETA_R, Columns::Dolp, noise)
}

impl StiffFit {
    fn new(case: &'static str, truth: Parameters, measurement: Measurement, bar: Bar) -> Self {
        let start = Parameters::default();
        Self { case, preset: "cauchy", truth, start, starts: Starts::Automatic, measurement, free: None, loss: Loss::Squared, bar }
    }

    /// All of them.
    pub(crate) fn all() -> Vec<Self> {
        let mut fits = Self::of_rank();
        fits.extend(Self::of_shape());
        fits.extend(Self::of_data());
        fits
    }

    /// What the data do not determine, or hardly.
    fn of_rank() -> Vec<Self> {
        use Parameter::{C, K, Kd, Ks, Kv, N, Q, Sigma, SigmaV};
        let everything = ParameterSet::ALL;
        let few = |count: usize| {
            let mut measurement = steel_dolp(0.0);
            measurement.rows.truncate(count);
            measurement
        };
        let duplicates = {
            let mut measurement = few(1);
            measurement.rows = vec![measurement.rows[0]; measurement.rows.len() * 12];
            measurement
        };
        vec![
            Self {
                free: Some(everything),
                ..Self::new("rank-deficient: k_s, k_d and k_v free with DoLP alone", steel(), dolp(steel(), 0.0), Bar::Open(&[Ks, Kd, Kv]))
            },
            Self::new("nearly rank-deficient: 27 steel points, 8 parameters, no noise", steel(), steel_dolp(0.0), Bar::Exact),
            Self::new("nearly rank-deficient: 27 steel points, 8 parameters, noise 0.005", steel(), steel_dolp(0.005), Bar::Covers),
            Self::new("fewer points than parameters: 5 for 8", steel(), few(5), Bar::Ends(StopReason::Underdetermined)),
            Self::new("one point twelve times", steel(), duplicates, Bar::Open(&[N, K, Sigma, Kd, Kv, Q, C, SigmaV])),
        ]
    }

    /// Where the objective is awkward.
    fn of_shape() -> Vec<Self> {
        let far = Parameters { n: 9.0, k: 18.0, sigma: 2.5, kd: 8.0, kv: 9.0, q: 15.0, c: -0.95, sigma_v: 2.8, ..steel() };
        let at_c = Parameters { c: 0.0, ..steel() };
        let at_kv = Parameters { kv: 0.0, ..steel() };
        let heavy = Parameters { sigma: 0.15, q: 1.3, ..steel() };
        vec![
            Self::new("parameter at a bound: c = 0", at_c, dolp(at_c, 0.0), Bar::AtBound(Parameter::C, Edge::Upper)),
            Self::new("parameter at a bound: k_v = 0", at_kv, dolp(at_kv, 0.0), Bar::AtBound(Parameter::Kv, Edge::Lower)),
            Self { start: far, ..Self::new("start far away, many starts", steel(), dolp(steel(), 0.0), Bar::Truth) },
            Self {
                starts: Starts::One, ..Self::new("narrow curved valley σ–q, one start, no noise", heavy, dolp(heavy, 0.0), Bar::Truth)
            },
            Self {
                starts: Starts::One,
                ..Self::new("narrow curved valley σ–q, one start, noise 0.002", heavy, dolp(heavy, 0.002), Bar::Covers)
            },
        ]
    }

    /// Where the data are.
    fn of_data() -> Vec<Self> {
        let mut outliers = dolp(steel(), 0.002);
        for row in outliers.rows.iter_mut().step_by(10) {
            if let Some(dolp) = &mut row.dolp {
                dolp.value = (dolp.value + 0.15).min(1.0);
            }
        }
        let mut dark = steel_dolp(0.0);
        for dolp in dark.rows.iter_mut().filter_map(|row| row.dolp.as_mut()) {
            dolp.value = 0.0;
        }
        let mut masked = steel_dolp(0.0);
        masked.rows.iter_mut().for_each(|row| row.masked = true);
        let both = simulate("cauchy", steel(), &DENSE_THETA_I, &dense_theta_r(), Columns::Both, 0.0);
        vec![
            Self::new("noise-free, dense angles", steel(), dolp(steel(), 0.0), Bar::Truth),
            Self::new("noise-free, DoLP and BRDF, k_s free", steel(), both, Bar::Truth),
            Self::new("noise 0.005, dense angles", steel(), dolp(steel(), 0.005), Bar::Covers),
            Self { loss: Loss::SoftL1, ..Self::new("every tenth point an outlier, soft-L1 loss", steel(), outliers, Bar::SparesOutliers) },
            Self::new("all points masked", steel(), masked, Bar::Ends(StopReason::NoData)),
            Self::new("DoLP 0 everywhere", steel(), dark, Bar::Ends(StopReason::Underdetermined)),
        ]
    }

    /// Fits, and judges what comes out.
    pub(crate) fn run(self, watch: Observer<'_>) -> Stability {
        let report = self.problem().map(|problem| (fit(&problem, self.starts, SEED, watch), problem));
        let (condition, outcome, pass) = match &report {
            Some((report, problem)) => (condition(problem, report), outcome(report), self.bar.is_met(problem, report, &self.truth)),
            None => (f64::NAN, StabilityOutcome::NoProblem, false),
        };
        let model = report.as_ref().map(|(_, problem)| problem.model());
        Stability {
            case: StabilityCase::Fit(self.case),
            setting: Setting::Fit {
                model: model.unwrap_or_else(|| crate::model::Model::full(crate::optics::SlopeDistribution::Cauchy)),
                start: self.start,
                measurement: self.measurement,
            },
            brdf_error: None,
            dolp_error: None,
            gradient_error: None,
            textbook_error: None,
            condition,
            outcome,
            pass,
        }
    }

    fn problem(&self) -> Option<Problem> {
        let preset = Preset::from_key(self.preset)?;
        let choices = FitOptions { loss: self.loss, dolp_only: preset.dolp_only, ..FitOptions::default() };
        let free = self.free.unwrap_or_else(|| free_by_default(preset.model, &self.measurement, &choices));
        Problem::new(&self.measurement, preset.model, self.start, free, Bounds::default(), choices).ok()
    }
}

impl Bar {
    fn is_met(self, problem: &Problem, report: &FitResult, truth: &Parameters) -> bool {
        let exact = report.objective.is_some_and(|objective| objective <= EXACT);
        let near = |parameter: Parameter, tolerance: f64| {
            (report.parameters[parameter] - truth[parameter]).abs() <= tolerance * truth[parameter].abs()
        };
        let estimate = |parameter: Parameter| report.estimates.iter().find(|estimate| estimate.parameter == parameter);
        match self {
            Self::Exact => exact,
            Self::Truth => exact && problem.free().iter().all(|&parameter| near(parameter, 1e-6)),
            Self::Open(parameters) => {
                report.stop_reason == StopReason::Underdetermined
                    && parameters.iter().all(|&parameter| {
                        let is_named = report.undetermined.iter().any(|open| open.direction.iter().any(|(other, _)| *other == parameter));
                        let is_silent = estimate(parameter).is_none_or(|estimate| estimate.std_error.is_none());
                        is_named && is_silent
                    })
            }
            Self::AtBound(parameter, edge) => exact && estimate(parameter).is_some_and(|estimate| estimate.at_bound == Some(edge)),
            Self::Covers => {
                let (here, there) = (problem.sum_of_squares(&report.parameters), problem.sum_of_squares(truth));
                let no_worse = here.zip(there).is_some_and(|(here, there)| here <= there);
                no_worse
                    && report.estimates.iter().all(|estimate| {
                        estimate.std_error.is_none_or(|error| (estimate.value - truth[estimate.parameter]).abs() <= 4.0 * error)
                    })
            }
            Self::SparesOutliers => near(Parameter::N, 0.05),
            Self::Ends(reason) => {
                report.stop_reason == reason
                    && report.estimates.iter().all(|estimate| estimate.value.is_finite() && estimate.std_error.is_none_or(f64::is_finite))
            }
        }
    }
}

/// How a fit ended.
fn outcome(report: &FitResult) -> StabilityOutcome {
    let FitResult { stop_reason, objective, ref undetermined, .. } = *report;
    StabilityOutcome::Fit { stop_reason, objective, undetermined: undetermined.len() }
}

/// Largest over smallest singular value of the Jacobian scaled by max(|p|, 1e-3), at the end of a fit.
fn condition(problem: &Problem, report: &FitResult) -> f64 {
    let Some((_, mut jacobian)) = problem.linearised(&report.parameters) else { return f64::NAN };
    if jacobian.is_empty() {
        return f64::NAN;
    }
    for (j, &parameter) in problem.free().iter().enumerate() {
        jacobian.column_mut(j).scale_mut(report.parameters[parameter].abs().max(1e-3));
    }
    let values = jacobian.singular_values();
    // Fewer rows than columns leave directions without any singular value.
    if problem.len() < problem.free().len() { f64::INFINITY } else { values.max() / values.min() }
}
