//! `plan`: predicted standard errors for a choice of angles, and which angles to choose.

use crate::cli::arguments::{PlanArguments, SurfaceArguments};
use crate::cli::failure::Failure;
use crate::cli::output::{self, Progress};
use crate::cli::simulate::surface;
use crate::cli::values::Criterion;
use crate::cli::watched::Watched;
use crate::cli::{draws, input, interrupt};
use crate::report::write_plan;
use pbrdf::fit::{
    AngleChoice, AngleChoiceError, CandidateGrid, ChosenAngles, Design, DesignCriterion, DesignPrediction, NoiseModel, choose,
};
use pbrdf::measurement::{Columns, Row};
use pbrdf::model::{Parameter, ParameterSet, Parameters, Preset};
use pbrdf::optics::Geometry;
use serde_json::{Map, Value, json};
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Mutex;

/// Sums of squares, in units of the noise's variance, from which a rival is told: three standard deviations; and hardly, one.
const TOLD: f64 = 9.0;
const HARDLY_TOLD: f64 = 1.0;

pub fn run(arguments: &PlanArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let model = told(arguments).map_or(arguments.surface.model, |(model, _)| model);
    let supposed = SurfaceArguments { model, set: arguments.surface.set.clone() };
    let parameters = *surface(&supposed, arguments.columns)?.parameters();
    let noise = NoiseModel {
        dolp: (!matches!(arguments.columns, Columns::Brdf)).then_some(arguments.noise),
        brdf: (!matches!(arguments.columns, Columns::Dolp)).then_some(arguments.brdf_noise),
    };
    let grid = CandidateGrid::new(&arguments.theta_i.0, &arguments.theta_r.0, &arguments.dphi.0)
        .map_err(|error| Failure::usage(format!("{error}.")))?;
    let given = match &arguments.given {
        Some(path) => input::measurement(path, &input::bytes(path)?)?.rows,
        None => Vec::new(),
    };
    let mut design = Design::new(model.model, parameters, Vec::new(), noise);
    design.free = free(arguments, model, &design, &grid)?;
    design.given = given;
    let chosen = match arguments.choose {
        Some(count) => Some(chosen(arguments, count, &design, grid.clone())?),
        None => None,
    };
    design.geometries = match &chosen {
        Some(chosen) => {
            let repeated = chosen.angles.iter().flat_map(|&(angles, times)| std::iter::repeat_n(angles, times));
            repeated.map(geometry).collect::<Result<_, _>>()
        }
        None => (0..grid.len()).map(|candidate| grid.geometry(candidate)).collect(),
    }
    .map_err(|error| Failure::usage(format!("{error}.")))?;
    let prediction = output::while_waiting("predicting", || design.predict()).map_err(|error| Failure::usage(format!("{error}.")))?;
    if let (Some(path), Some(chosen)) = (&arguments.output, &chosen) {
        output::write(Some(path), |out| write_table(out, arguments.columns, chosen))?;
    }
    if arguments.json {
        output::write_json(&document(arguments, &prediction, chosen.as_ref()))?;
    } else {
        output::write(None, |out| {
            if let Some(chosen) = &chosen {
                print_chosen(out, arguments, chosen)?;
            }
            print(out, &design, &prediction)
        })?;
    }
    Ok(output::exit_code())
}

/// The two models that are to be told apart, if they are.
fn told(arguments: &PlanArguments) -> Option<(&'static Preset, &'static Preset)> {
    match arguments.criterion {
        Criterion::Tell(model, rival) => Some((model, rival)),
        _ => None,
    }
}

/// The free parameters of a fit of such readings.
fn free(arguments: &PlanArguments, preset: &Preset, design: &Design, grid: &CandidateGrid) -> Result<ParameterSet, Failure> {
    let model = preset.model;
    if let Some(parameter) = arguments.fix.iter().find(|parameter| arguments.free.contains(parameter)) {
        return Err(Failure::usage(format!("--fix and --free both name {}.", parameter.key())));
    }
    for &parameter in arguments.fix.iter().chain(&arguments.free) {
        if !model.parameters().contains(parameter) {
            output::notice(format_args!("The model {} has no parameter {}: what is said of it is ignored.", preset.key, parameter.key()));
        }
    }
    // What is free by default depends on what is measured, not on where.
    let one = grid.geometry(0).map_err(|error| Failure::usage(format!("{error}.")))?;
    let default = Design::new(model, design.parameters, vec![one], design.noise).free;
    let freed: ParameterSet = arguments.free.iter().copied().collect();
    Ok(default.without_all(arguments.fix.iter().copied().collect()).union(freed.intersection(model.parameters())))
}

fn chosen(arguments: &PlanArguments, count: usize, design: &Design, grid: CandidateGrid) -> Result<ChosenAngles, Failure> {
    let surfaces: Vec<Parameters> = match &arguments.over {
        Some(path) => draws::parameter_sets(path, design.parameters)?,
        None => vec![design.parameters],
    };
    let criterion = match &arguments.criterion {
        Criterion::Determinant => DesignCriterion::Determinant,
        Criterion::Variances(asked) => DesignCriterion::Variances(asked.clone()),
        Criterion::Tell(_, rival) => {
            if rival.dolp_only && arguments.columns != Columns::Dolp {
                return Err(Failure::usage(format!("The model {} predicts DoLP only, not a BRDF.", rival.key)));
            }
            let fixed = arguments.fix.iter().copied().collect();
            DesignCriterion::Discrimination { rival: rival.model, fixed }
        }
    };
    let choice = AngleChoice {
        model: design.model,
        surfaces,
        noise: design.noise,
        free: design.free,
        grid,
        given: design.given.clone(),
        count,
        repeats: arguments.repeats,
        criterion,
    };
    let watched = Watched::new("fitting");
    let watch = watched.watch();
    let observer = pbrdf::fit::Observer { progress: &|_| {}, ..watch.as_watch() };
    let progress = Mutex::new(Progress::new("choosing"));
    let tell = |done: f64| {
        if let Ok(mut progress) = progress.lock() {
            progress.tell_fraction(done);
        }
    };
    let chosen = choose(&choice, observer, &tell).map_err(|error| match error {
        AngleChoiceError::Cancelled => Failure::interrupted(),
        error => Failure::usage(format!("{error}.")),
    })?;
    if chosen.left_out > 0 {
        output::notice(format_args!(
            "Parameter sets that the average leaves out, since no choice determines all parameters there: {}.",
            chosen.left_out
        ));
    }
    Ok(chosen)
}

fn geometry([theta_i, theta_r, dphi]: [f64; 3]) -> Result<Geometry, pbrdf::optics::GeometryError> {
    if theta_r < 0.0 { Geometry::in_plane(theta_i, theta_r) } else { Geometry::new(theta_i, theta_r, dphi) }
}

/// An empty measurement table of the chosen angles.
fn write_table(out: &mut dyn Write, columns: Columns, chosen: &ChosenAngles) -> io::Result<()> {
    write_plan(out, columns, chosen.angles.iter().flat_map(|&(angles, times)| std::iter::repeat_n(angles, times)))
}

fn document(arguments: &PlanArguments, prediction: &DesignPrediction, chosen: Option<&ChosenAngles>) -> Value {
    let errors: Map<String, Value> =
        prediction.errors.iter().map(|(parameter, error)| (parameter.key().to_owned(), json!(error))).collect();
    let is_determined = |parameter: &Parameter| json!(prediction.determined.contains(*parameter));
    let determined: Map<String, Value> =
        prediction.errors.iter().map(|(parameter, _)| (parameter.key().to_owned(), is_determined(parameter))).collect();
    let mut json = json!({ "std_error": errors, "determined": determined, "undetermined": prediction.undetermined });
    if let (Some(object), Some(chosen)) = (json.as_object_mut(), chosen) {
        let angles = chosen
            .angles
            .iter()
            .map(|([theta_i, theta_r, dphi], repeats)| json!({ "theta_i": theta_i, "theta_r": theta_r, "dphi": dphi, "repeats": repeats }));
        object.insert("chosen".to_owned(), angles.collect());
        let criterion = json!({
            "name": name(&arguments.criterion),
            "value": chosen.value,
            "of_all_candidates": chosen.of_all_candidates,
            "efficiency": chosen.efficiency,
        });
        object.insert("criterion".to_owned(), criterion);
        if let Some((model, rival)) = told(arguments) {
            object.insert("verdict".to_owned(), json!(verdict(model, rival, arguments.choose, chosen.value)));
        }
    }
    json
}

/// The criterion as the command line takes it.
fn name(criterion: &Criterion) -> String {
    match criterion {
        Criterion::Determinant => "d".to_owned(),
        Criterion::Variances(asked) => {
            format!("c:{}", asked.iter().map(|parameter| parameter.key()).collect::<Vec<_>>().join(","))
        }
        Criterion::Tell(model, rival) => format!("tell:{},{}", model.key, rival.key),
    }
}

/// Whether so many readings can tell the models apart.
fn verdict(model: &Preset, rival: &Preset, count: Option<usize>, t: f64) -> String {
    let count = count.unwrap_or(0);
    #[expect(clippy::cast_precision_loss, reason = "a number of readings")]
    let needed = (count as f64 * TOLD / t).ceil();
    let left = format!("the best fit of {} is off by {t:.3} times the variance of the noise", rival.key);
    if t >= TOLD {
        format!("{count} readings can tell {} from {}: {left}", model.key, rival.key)
    } else if t >= HARDLY_TOLD && needed < 1e6 {
        format!(
            "{count} readings cannot tell {} from {}: {left}, and {TOLD} is needed; about {needed} readings like these would",
            model.key, rival.key
        )
    } else {
        format!("{count} readings cannot tell {} from {}: {left}, and {TOLD} is needed", model.key, rival.key)
    }
}

fn print_chosen(out: &mut dyn Write, arguments: &PlanArguments, chosen: &ChosenAngles) -> io::Result<()> {
    writeln!(out, "{:>8} {:>8} {:>8}", "theta_i", "theta_r", "dphi")?;
    for &([theta_i, theta_r, dphi], times) in &chosen.angles {
        let times = if times > 1 { format!("  {times} times") } else { String::new() };
        writeln!(out, "{theta_i:>8} {theta_r:>8} {dphi:>8}{times}")?;
    }
    let what = match &arguments.criterion {
        Criterion::Determinant => "ln det of the information",
        Criterion::Variances(_) => "sum of relative variances",
        Criterion::Tell(..) => "sum of squares that the rival leaves, in variances of the noise",
    };
    writeln!(
        out,
        "{what}: {:.6}, of all candidates {:.6}, efficiency {:.1} %",
        chosen.value,
        chosen.of_all_candidates,
        100.0 * chosen.efficiency
    )?;
    if let Some((model, rival)) = told(arguments) {
        let sentence = verdict(model, rival, arguments.choose, chosen.value);
        writeln!(out, "{sentence}.")?;
    }
    writeln!(out)
}

fn print(out: &mut dyn Write, plan: &Design, prediction: &DesignPrediction) -> io::Result<()> {
    let condition = prediction.condition.map_or_else(String::new, |condition| format!(", condition {condition:.1e}"));
    let is_used = |row: &&Row| !row.masked;
    let given = plan.given.iter().filter(is_used).count();
    let given = if given > 0 { format!(" and {given} that are given") } else { String::new() };
    let points = plan.geometries.len();
    let (plural, verb) = if points == 1 && given.is_empty() { ("", "tells") } else { ("s", "tell") };
    let (all, determined) = (prediction.errors.len(), prediction.determined.len());
    let apart = format!("{verb} {} of {all} directions apart{condition}", prediction.rank);
    writeln!(out, "{points} point{plural}{given} {apart}; determined: {determined} of {all} parameters; predicted standard errors:")?;
    for (parameter, error) in &prediction.errors {
        let is_determined = prediction.determined.contains(*parameter);
        let error = error.map_or_else(|| "open".to_owned(), |error| format!("{error:.3e}"));
        let (value, unit) = (plan.parameters[*parameter], Parameter::unit(*parameter));
        let note = if is_determined { "" } else { "  not determined" };
        writeln!(out, "  {:<8} {value:>12.6} ± {error} {unit}{note}", parameter.key())?;
    }
    for direction in &prediction.undetermined {
        writeln!(out, "open: {direction}")?;
    }
    Ok(())
}
