//! `posterior`: draws from the posterior of a fit.

use crate::cli::arguments::PosteriorArguments;
use crate::cli::failure::Failure;
use crate::cli::output::Progress;
use crate::cli::problem::{named_set, problem};
use crate::cli::watched::Watched;
use crate::cli::{input, interrupt, output};
use pbrdf::fit::posterior::{
    Convergence, MarginalSummary, NoiseQuantiles, Posterior, PosteriorSample, PosteriorSettings, PosteriorVerdict,
};
use pbrdf::fit::{Loss, Problem, Starts, Weights, fit};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Parameter, Parameters};
use serde_json::{Map, Value, json};
use std::io::{self, Write};
use std::process::ExitCode;

/// Names of the quantiles of a summary.
const QUANTILES: [&str; 5] = ["q05", "q16", "q50", "q84", "q95"];

pub fn run(arguments: &PosteriorArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let problem = posed(arguments)?;
    let priors: Vec<_> = arguments.prior.iter().flat_map(|priors| priors.0.iter().copied()).collect();
    let settings = PosteriorSettings { draws: arguments.draws, chains: arguments.chains, seed: arguments.problem.seed };
    let posterior = Posterior::new(&problem, &priors, settings).map_err(|error| Failure::usage(format!("{error}.")))?;
    let watched = Watched::new("fitting");
    let watch = watched.watch();
    let report = fit(posterior.problem(), Starts::Automatic, settings.seed, watch.as_watch());
    let minima: Vec<Parameters> = report.course.minima.iter().map(|minimum| minimum.parameters).collect();
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
    let summaries: Vec<(Parameter, MarginalSummary)> =
        sample.parameters.iter().map(|&parameter| (parameter, sample.summary(parameter))).collect();
    let verdict = verdict(&sample, &summaries);
    if arguments.json {
        output::write_json(&document(arguments, &problem, &sample, &summaries, verdict))?;
    } else {
        output::write(None, |out| print(out, &problem, &sample, &summaries, verdict))?;
    }
    Ok(output::exit_code())
}

/// The problem of all files together.
fn posed(arguments: &PosteriorArguments) -> Result<Problem, Failure> {
    let options = &arguments.problem;
    if options.starts.is_some() || options.loss != Loss::Squared || options.loss_scale.is_some() {
        return Err(Failure::usage("A posterior takes no --starts and no --loss: its likelihood is Gaussian."));
    }
    if let Some(set) = named_set(options) {
        return Err(Failure::usage(format!("All measurements of a posterior share their parameters; nothing can be said of {set} alone.")));
    }
    let mut all = Measurement::default();
    // Which file each row comes from, for messages.
    let mut ends = Vec::new();
    for path in &arguments.inputs {
        let measurement = input::measurement(path, &input::bytes(path)?)?;
        all.rows.extend(measurement.rows);
        all.lines.extend(measurement.lines);
        ends.push(all.rows.len());
    }
    problem(arguments.model, options, &all).map_err(|reason| {
        let place = reason.row().and_then(|row| ends.iter().position(|&end| row < end)).unwrap_or(0);
        reason.about(&arguments.inputs[place], &all)
    })
}

fn verdict(sample: &PosteriorSample, summaries: &[(Parameter, MarginalSummary)]) -> PosteriorVerdict {
    let all: Option<Vec<(Parameter, Convergence)>> =
        summaries.iter().map(|&(parameter, summary)| Some((parameter, summary.convergence?))).collect();
    all.map_or(PosteriorVerdict::TooFewDraws, |all| sample.verdict_of(&all))
}

/// One row per draw.
fn write_draws(out: &mut dyn Write, sample: &PosteriorSample) -> io::Result<()> {
    let names: Vec<&str> = sample.parameters.iter().map(|parameter| parameter.key()).collect();
    writeln!(out, "{},log_posterior,chain", names.join(","))?;
    for (chain, draws) in sample.chains.iter().enumerate() {
        for draw in draws {
            sample.parameters.iter().try_for_each(|&parameter| write!(out, "{},", draw.parameters[parameter]))?;
            writeln!(out, "{},{chain}", draw.log_posterior)?;
        }
    }
    Ok(())
}

fn document(
    arguments: &PosteriorArguments,
    problem: &Problem,
    sample: &PosteriorSample,
    summaries: &[(Parameter, MarginalSummary)],
    verdict: PosteriorVerdict,
) -> Value {
    let of = |(parameter, summary): &(Parameter, MarginalSummary)| {
        let mut values = Map::new();
        values.insert("mean".to_owned(), json!(summary.mean));
        values.insert("sd".to_owned(), json!(summary.sd));
        values.extend(QUANTILES.iter().zip(summary.quantiles).map(|(&name, quantile)| (name.to_owned(), json!(quantile))));
        let convergence = summary.convergence;
        values.insert("rhat".to_owned(), json!(convergence.map(|of| of.rhat)));
        values.insert("ess_bulk".to_owned(), json!(convergence.map(|of| of.ess_bulk)));
        values.insert("ess_tail".to_owned(), json!(convergence.map(|of| of.ess_tail)));
        (parameter.key().to_owned(), Value::Object(values))
    };
    let names: Vec<&str> = sample.parameters.iter().map(|parameter| parameter.key()).collect();
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
        "parameters": summaries.iter().map(of).collect::<Map<String, Value>>(),
        "correlations": { "names": names, "matrix": matrix },
        "noise": noise(problem, sample),
        "log_evidence": sample.log_evidence.map(|evidence| json!({ "value": evidence.value, "std_error": evidence.std_error })),
    })
}

/// The noise of DoLP, or of BRDF where that alone is measured; of both, that of BRDF beside it.
fn noise(problem: &Problem, sample: &PosteriorSample) -> Value {
    let stated = problem.options().weights == Weights::Sigma;
    let [dolp, brdf] = sample.noise;
    let of = |noise: Option<NoiseQuantiles>| json!({ "stated": stated, "q16": noise.map(|of| of.q16), "q50": noise.map(|of| of.q50), "q84": noise.map(|of| of.q84) });
    let mut json = of(dolp.or(brdf));
    if let (Some(object), Some(_), Some(brdf)) = (json.as_object_mut(), dolp, brdf) {
        object.insert("brdf".to_owned(), of(Some(brdf)));
    }
    json
}

fn print(
    out: &mut dyn Write,
    problem: &Problem,
    sample: &PosteriorSample,
    summaries: &[(Parameter, MarginalSummary)],
    verdict: PosteriorVerdict,
) -> io::Result<()> {
    writeln!(
        out,
        "{} draws of {} chains from the posterior of {} values ({} evaluations, {:.1} s); {verdict}",
        sample.len(),
        sample.chains.len(),
        problem.len(),
        sample.evaluations,
        sample.elapsed_ms / 1e3
    )?;
    writeln!(out, "\n{:<8} {:>11} {:>11} {:>11} {:>11} {:>11} {:>7} {:>7}", "", "mean", "sd", "16 %", "median", "84 %", "R̂", "size")?;
    for (parameter, summary) in summaries {
        let [_, q16, q50, q84, _] = summary.quantiles;
        let (rhat, size) = summary.convergence.map_or((f64::NAN, f64::NAN), |of| (of.rhat, of.ess_bulk.min(of.ess_tail)));
        writeln!(
            out,
            "{:<8} {:>11.5} {:>11.5} {q16:>11.5} {q50:>11.5} {q84:>11.5} {rhat:>7.3} {size:>7.0}",
            parameter.key(),
            summary.mean,
            summary.sd
        )?;
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
