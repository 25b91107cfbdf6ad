//! Draws from the posterior of a fit.

use crate::error::refused;
use crate::fitting::{Fitted, Outcome};
use crate::names::parameter;
use crate::watched::{Watch, watched};
use numpy::PyArray1;
use pbrdf::fit::posterior::{MarginalSummary, Posterior, PosteriorError, PosteriorProblem, PosteriorSettings, Prior, SampleOf};
use pbrdf::fit::{Intervals, JointUnknown, Loss, Starts, UnknownName as _, fit, fit_jointly};
use pyo3::prelude::*;
use std::sync::Arc;

/// How draws are asked for.
#[derive(FromPyObject)]
pub struct Request {
    /// Name, kind and two numbers.
    priors: Vec<(String, (String, f64, f64))>,
    draws: usize,
    chains: usize,
    seed: u64,
}

/// A prior by its kind.
fn prior((kind, a, b): &(String, f64, f64)) -> PyResult<Prior> {
    match &kind[..] {
        "normal" => Ok(Prior::Normal { mean: *a, sd: *b }),
        "uniform" => Ok(Prior::Uniform { low: *a, high: *b }),
        "log-uniform" => Ok(Prior::LogUniform { low: *a, high: *b }),
        _ => Err(refused(format_args!("{kind:?} is no prior; expected normal (mean, sd), uniform or log-uniform (low, high)"))),
    }
}

/// An unknown by its name, `n` or `n@B.csv`.
fn unknown(name: &str) -> PyResult<JointUnknown> {
    let (key, set) = name.split_once('@').map_or((name, None), |(key, set)| (key, Some(Arc::from(set))));
    Ok(JointUnknown { parameter: parameter(key)?, set })
}

/// The draws, chain by chain.
#[pyclass(frozen, module = "pbrdf._pbrdf")]
pub struct Drawn {
    names: Vec<String>,
    chains: usize,
    draws: usize,
    /// Of each unknown, then ln(likelihood × priors): chain by chain.
    columns: Vec<Vec<f64>>,
    summaries: Vec<MarginalSummary>,
    #[pyo3(get)]
    verdict: String,
    #[pyo3(get)]
    divergences: usize,
    #[pyo3(get)]
    log_evidence: Option<(f64, f64)>,
}

/// Mean, standard deviation, quantiles at 5, 16, 50, 84 and 95 %, and R̂ with bulk and tail effective sizes.
type SummaryRow = (f64, f64, [f64; 5], Option<[f64; 3]>);

#[pymethods]
impl Drawn {
    #[getter]
    fn names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// Chains, and draws of each.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.chains, self.draws)
    }

    fn columns<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyArray1<f64>>> {
        self.columns.iter().map(|column| PyArray1::from_slice(py, column)).collect()
    }

    fn summaries(&self) -> Vec<SummaryRow> {
        let of = |summary: &MarginalSummary| {
            let convergence = summary.convergence.map(|of| [of.rhat, of.ess_bulk, of.ess_tail]);
            (summary.mean, summary.sd, summary.quantiles, convergence)
        };
        self.summaries.iter().map(of).collect()
    }
}

/// Draws from the posterior of the problem of a fit. `progress` is called with the share that is done, 0 to 1.
#[pyfunction]
pub fn posterior(py: Python<'_>, fitted: Py<Fitted>, request: Request, progress: Option<Py<PyAny>>) -> PyResult<Drawn> {
    let mut priors = Vec::new();
    for (name, kind) in &request.priors {
        priors.push((unknown(name)?, prior(kind)?));
    }
    let settings = PosteriorSettings { draws: request.draws, chains: request.chains, seed: request.seed };
    match &fitted.get().outcome {
        Outcome::Single(fitted) => drawn(py, progress.as_ref(), &fitted.0, &priors, settings, &|problem, watch| {
            let result = watch.fit_quietly(|observer| fit(problem, Starts::Automatic, settings.seed, observer));
            result.course.minima.iter().map(|minimum| minimum.parameters).collect()
        }),
        Outcome::Joint(fitted) => drawn(py, progress.as_ref(), &fitted.0, &priors, settings, &|problem, watch| {
            let result = watch.fit_quietly(|observer| fit_jointly(problem, Starts::Automatic, settings.seed, Intervals::None, observer));
            result.course.minima.into_iter().map(|minimum| minimum.parameters).collect()
        }),
    }
}

/// The draws of a problem, given how its minima are found.
fn drawn<P: PosteriorProblem + Sync>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    problem: &P,
    priors: &[(JointUnknown, Prior)],
    settings: PosteriorSettings,
    minima: &(dyn Fn(&P, &Watch<'_>) -> Vec<P::Point> + Sync),
) -> PyResult<Drawn> {
    if problem.options().loss != Loss::Squared {
        return Err(refused("a posterior takes no robust loss: its likelihood is Gaussian; fit with loss=\"squared\""));
    }
    let posterior = Posterior::new(problem, priors, settings).map_err(refused)?;
    watched(py, progress, |watch| -> Result<Drawn, PosteriorError> {
        let minima = minima(posterior.problem(), watch);
        let sample = watch.fit_quietly(|observer| posterior.run(&minima, observer, &mut |share, _| watch.tell_share(share)))?;
        Ok(columns_of::<P>(&sample))
    })?
    .map_err(refused)
}

fn columns_of<P: PosteriorProblem>(sample: &SampleOf<P>) -> Drawn {
    let draws = || sample.chains.iter().flatten();
    let mut columns: Vec<Vec<f64>> =
        (0..sample.parameters.len()).map(|unknown| draws().map(|draw| draw.unknowns[unknown]).collect()).collect();
    columns.push(draws().map(|draw| draw.log_posterior).collect());
    Drawn {
        names: sample.parameters.iter().map(|name| name.key().into_owned()).collect(),
        chains: sample.chains.len(),
        draws: sample.chains.first().map_or(0, Vec::len),
        columns,
        summaries: sample.parameters.iter().map(|name| sample.summary(name)).collect(),
        verdict: sample.verdict().to_string(),
        divergences: sample.divergences,
        log_evidence: sample.log_evidence.map(|evidence| (evidence.value, evidence.std_error)),
    }
}
