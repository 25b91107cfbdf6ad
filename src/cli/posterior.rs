//! `posterior`: draws from the posterior of a fit.

use crate::cli::arguments::PosteriorArguments;
use crate::cli::failure::Failure;
use crate::cli::fit_text::NAME_WIDTH;
use crate::cli::output::Progress;
use crate::cli::problem::{check, joint_failure, joint_problem, model, own_parameters, problem};
use crate::cli::sets::MeasurementSets;
use crate::cli::watched::Watched;
use crate::cli::{interrupt, output};
use crate::report::write_draws;
use pbrdf::fit::posterior::{
    DerivedQuantity, MarginalSummary, NoiseQuantiles, Posterior, PosteriorProblem, PosteriorSettings, PosteriorVerdict, SampleOf,
};
use pbrdf::fit::{Intervals, Loss, Observer, Starts, UnknownName, Weights, fit, fit_jointly};
use pbrdf::model::Parameters;
use serde_json::{Map, Value, json};
use std::io::{self, Write};
use std::process::ExitCode;

/// Names of the quantiles of a summary.
const QUANTILES: [&str; 5] = ["q05", "q16", "q50", "q84", "q95"];

pub fn run(arguments: &PosteriorArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let options = &arguments.problem;
    if options.starts.is_some() || options.loss != Loss::Squared || options.loss_scale.is_some() {
        return Err(Failure::usage("A posterior takes no --starts and no --loss: its likelihood is Gaussian."));
    }
    let sets = MeasurementSets::read(&arguments.inputs)?;
    check(options, &sets)?;
    let model = model(arguments.model, options);
    let own = own_parameters(arguments.own.as_ref(), model, &sets)?;
    let seed = options.seed;
    if let [set] = &sets.all[..] {
        let problem =
            problem(arguments.model, options, &set.measurement).map_err(|reason| reason.about(sets.path(set), &set.measurement))?;
        let minima = |problem: &_, observer: Observer<'_>| {
            let result = fit(problem, Starts::Automatic, seed, observer);
            result.course.minima.iter().map(|minimum| minimum.parameters).collect()
        };
        draw(arguments, &sets, &problem, &minima, &|_, point| *point)
    } else {
        let problem = joint_problem(arguments.model, options, own, &sets).map_err(|error| joint_failure(&error, &sets))?;
        let minima = |problem: &_, observer: Observer<'_>| {
            let result = fit_jointly(problem, Starts::Automatic, seed, Intervals::None, observer);
            result.course.minima.into_iter().map(|minimum| minimum.parameters).collect()
        };
        draw(arguments, &sets, &problem, &minima, &|set, point: &Vec<Parameters>| point[set])
    }
}

/// Draws from the posterior of a problem and writes what came of it, given how its minima are found, and the parameters of a measurement of
/// a point.
fn draw<P: PosteriorProblem>(
    arguments: &PosteriorArguments,
    sets: &MeasurementSets,
    problem: &P,
    minima: &dyn Fn(&P, Observer<'_>) -> Vec<P::Point>,
    of_set: &dyn Fn(usize, &P::Point) -> Parameters,
) -> Result<ExitCode, Failure> {
    let mut priors = Vec::new();
    for option in arguments.prior.iter().flat_map(|priors| &priors.0) {
        priors.push((sets.unknown(option)?, option.value));
    }
    let settings = PosteriorSettings { draws: arguments.draws, chains: arguments.chains, seed: arguments.problem.seed };
    let posterior = Posterior::new(problem, &priors, settings).map_err(|error| Failure::usage(format!("{error}.")))?;
    let watched = Watched::new("fitting");
    let watch = watched.watch();
    let minima = minima(posterior.problem(), watch.as_watch());
    let mut progress = Progress::new("drawing");
    let sample = posterior
        .run(&minima, watch.as_watch(), &mut |done, _| progress.tell_fraction(done))
        .map_err(|error| Failure::usage(format!("{error}.")))?;
    drop(progress);
    drop(watch);
    drop(watched);
    if sample.is_empty() {
        return Err(Failure::interrupted());
    }
    if let Some(path) = &arguments.output {
        output::write(Some(path), |out| write_draws(out, &sample))?;
    }
    let summaries: Vec<MarginalSummary> = sample.parameters.iter().map(|parameter| sample.summary(parameter)).collect();
    let verdict = sample.verdict_of(&summaries);
    let derived = derived::<P>(&sample, sets, of_set);
    if arguments.json {
        output::write_json(&document(arguments, problem, &sample, &summaries, &derived, &verdict))?;
    } else {
        output::write(None, |out| print(out, problem, &sample, &summaries, &derived, &verdict))?;
    }
    Ok(output::exit_code())
}

/// Names of the free parameters in files.
fn keys<P: PosteriorProblem>(sample: &SampleOf<P>) -> Vec<String> {
    sample.parameters.iter().map(|parameter| parameter.key().into_owned()).collect()
}

/// What the draws say of quantities that follow from the parameters: of each measurement where it has such a parameter for itself.
fn derived<P: PosteriorProblem>(
    sample: &SampleOf<P>,
    sets: &MeasurementSets,
    of_set: &dyn Fn(usize, &P::Point) -> Parameters,
) -> Vec<(DerivedQuantity, String, MarginalSummary)> {
    let mut all = Vec::new();
    for quantity in DerivedQuantity::ALL {
        let from = quantity.parameters(sample.model);
        let is_of = |name: &&P::Name| from.contains(name.parameter());
        let mut free = sample.parameters.iter().filter(is_of).peekable();
        if free.peek().is_none() {
            continue;
        }
        let is_own = free.any(|name| name.set().is_some());
        for (set, measurement) in sets.all.iter().enumerate().take(if is_own { sets.all.len() } else { 1 }) {
            let summary = sample.summary_of(|point| quantity.value(sample.model, &of_set(set, point)));
            let name = if is_own { format!("@{}", measurement.name) } else { String::new() };
            all.push((quantity, name, summary));
        }
    }
    all
}

fn document<P: PosteriorProblem>(
    arguments: &PosteriorArguments,
    problem: &P,
    sample: &SampleOf<P>,
    summaries: &[MarginalSummary],
    derived: &[(DerivedQuantity, String, MarginalSummary)],
    verdict: &PosteriorVerdict<P::Name>,
) -> Value {
    let of = |summary: &MarginalSummary| {
        let mut values = Map::new();
        values.insert("mean".to_owned(), json!(summary.mean));
        values.insert("sd".to_owned(), json!(summary.sd));
        values.extend(QUANTILES.iter().zip(summary.quantiles).map(|(&name, quantile)| (name.to_owned(), json!(quantile))));
        let convergence = summary.convergence;
        values.insert("rhat".to_owned(), json!(convergence.map(|of| of.rhat)));
        values.insert("ess_bulk".to_owned(), json!(convergence.map(|of| of.ess_bulk)));
        values.insert("ess_tail".to_owned(), json!(convergence.map(|of| of.ess_tail)));
        Value::Object(values)
    };
    let parameters = sample.parameters.iter().zip(summaries).map(|(parameter, summary)| (parameter.key().into_owned(), of(summary)));
    let derived = derived.iter().map(|(quantity, set, summary)| (format!("{}{set}", quantity.key()), of(summary)));
    let names = keys::<P>(sample);
    let matrix: Vec<Vec<f64>> = sample.correlations().row_iter().map(|row| row.iter().copied().collect()).collect();
    json!({
        "model": arguments.model.key,
        "draws": sample.chains.first().map_or(0, Vec::len),
        "chains": sample.chains.len(),
        "elapsed_ms": sample.elapsed_ms,
        "evaluations": sample.evaluations,
        "divergences": sample.divergences,
        "accepted": sample.accepted,
        "verdict": verdict.to_string(),
        "parameters": parameters.collect::<Map<String, Value>>(),
        "derived": derived.collect::<Map<String, Value>>(),
        "correlations": { "names": names, "matrix": matrix },
        "noise": noise(problem, sample),
        "log_evidence": sample.log_evidence.map(|evidence| json!({ "value": evidence.value, "std_error": evidence.std_error })),
    })
}

/// The noise of DoLP, or of BRDF where that alone is measured; of both, that of BRDF beside it.
fn noise<P: PosteriorProblem>(problem: &P, sample: &SampleOf<P>) -> Value {
    let stated = problem.options().weights == Weights::Sigma;
    let [dolp, brdf] = sample.noise;
    let of = |noise: Option<NoiseQuantiles>| json!({ "stated": stated, "q16": noise.map(|of| of.q16), "q50": noise.map(|of| of.q50), "q84": noise.map(|of| of.q84) });
    let mut json = of(dolp.or(brdf));
    if let (Some(object), Some(_), Some(brdf)) = (json.as_object_mut(), dolp, brdf) {
        object.insert("brdf".to_owned(), of(Some(brdf)));
    }
    json
}

fn print<P: PosteriorProblem>(
    out: &mut dyn Write,
    problem: &P,
    sample: &SampleOf<P>,
    summaries: &[MarginalSummary],
    derived: &[(DerivedQuantity, String, MarginalSummary)],
    verdict: &PosteriorVerdict<P::Name>,
) -> io::Result<()> {
    writeln!(
        out,
        "{} draws of {} chains from the posterior of {} values ({} evaluations, {:.1} s); {verdict}",
        sample.len(),
        sample.chains.len(),
        problem.residual_count(),
        sample.evaluations,
        sample.elapsed_ms / 1e3
    )?;
    let width = sample.parameters.iter().map(|parameter| parameter.key().chars().count()).max().unwrap_or(0).max(NAME_WIDTH);
    writeln!(out, "\n{:<width$} {:>11} {:>11} {:>11} {:>11} {:>11} {:>7} {:>7}", "", "mean", "sd", "16 %", "median", "84 %", "R̂", "size")?;
    for (parameter, summary) in sample.parameters.iter().zip(summaries) {
        let [_, q16, q50, q84, _] = summary.quantiles;
        let (rhat, size) = summary.convergence.map_or((f64::NAN, f64::NAN), |of| (of.rhat, of.ess_bulk.min(of.ess_tail)));
        writeln!(
            out,
            "{:<width$} {:>11.5} {:>11.5} {q16:>11.5} {q50:>11.5} {q84:>11.5} {rhat:>7.3} {size:>7.0}",
            parameter.key(),
            summary.mean,
            summary.sd
        )?;
    }
    for (quantity, set, summary) in derived {
        let [_, q16, q50, q84, _] = summary.quantiles;
        let (symbol, unit) = (quantity.symbol(), quantity.unit());
        writeln!(out, "{}{symbol}{set}: {q50:.5}{unit} ({q16:.5} … {q84:.5})", if quantity == &derived[0].0 { "\n" } else { "" })?;
    }
    for (name, noise) in ["DoLP", "BRDF"].into_iter().zip(sample.noise) {
        if let Some(NoiseQuantiles { q16, q50, q84 }) = noise {
            writeln!(out, "\nnoise of {name}: {q50:.3e} ({q16:.3e} … {q84:.3e})")?;
        }
    }
    if let Some(evidence) = sample.log_evidence {
        writeln!(out, "\nln of the evidence {:.3} ± {:.3}", evidence.value, evidence.std_error)?;
    }
    if sample.cut > 0 {
        writeln!(out, "{} trajectories were cut at their greatest length: draw more.", sample.cut)?;
    }
    Ok(())
}
