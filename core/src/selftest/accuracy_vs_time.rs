//! Error against run time: of evaluations against the 60-digit table, and along fits.

use crate::model::{Batch, GeometrySet, Model, Parameters, Pbrdf, Radiances};
use crate::optics::{Facet, Geometry, SlopeDistribution};
use crate::selftest::benchmark_run::{BenchmarkSize, TraceStep};
use crate::selftest::error_vs_time::{ErrorVsTime, TaskKind};
use crate::selftest::method::BenchmarkMethod;
use crate::selftest::note::Note;
use crate::selftest::reference::{Reference, golden, relative_error};
use crate::selftest::solver_benchmark::SolverBenchmark;
use crate::selftest::table::BenchmarkCurves;
use crate::selftest::textbook::{textbook_f32, textbook_f64};
use crate::selftest::{Host, Machine, Report, Timing, model_benchmark, quantile};
use serde_json::{Map, Value, json};
use std::cell::RefCell;
use std::hint::black_box;

impl ErrorVsTime {
    /// Makes the report.
    #[must_use]
    pub fn run(machine: Machine, date: String, host: Host<'_>) -> Report<Self> {
        Self::to_extent(BenchmarkSize::WHOLE, machine, date, host)
    }

    fn to_extent(extent: BenchmarkSize, machine: Machine, date: String, host: Host<'_>) -> Report<Self> {
        let golden = golden();
        let mut rows = evaluations(&golden, host);
        (host.progress)(0.05);
        let mut solvers = if (host.cancelled)() { SolverBenchmark::default() } else { SolverBenchmark::run(extent, host) };
        rows.append(&mut solvers.rows);
        let (of_models, models) = if (host.cancelled)() { (Vec::new(), Vec::new()) } else { model_benchmark::run(extent, host) };
        rows.extend(of_models);
        let notes = notes(golden.len(), extent, &rows);
        let curves = BenchmarkCurves { fits: solvers.curves, models, profiles: solvers.profiles };
        Report { further: further(&rows, &curves), curves, ..Report::new("Error against run time", machine, date, rows, notes) }
    }
}

fn notes(golden: usize, extent: BenchmarkSize, rows: &[ErrorVsTime]) -> Vec<Note> {
    let BenchmarkSize { starts, repetitions, repetitions_of_many } = extent;
    let spreads = rows.iter().filter(|row| row.spread.is_finite()).map(|row| (row.method, row.spread));
    vec![
        Note::AccuracyEvaluations { rows: golden },
        Note::AccuracyFits { starts, repetitions, repetitions_of_many },
        Note::AccuracyModels,
        Note::Spreads(spreads.collect()),
    ]
}

/// Times with their spread, curves and profiles, for the file.
fn further(rows: &[ErrorVsTime], curves: &BenchmarkCurves) -> Map<String, Value> {
    let column = |steps: &[TraceStep], i: usize| steps.iter().map(|step| step[i]).collect::<Vec<_>>();
    let timing = |row: &ErrorVsTime| json!({ "task": row.task.key(), "method": row.method.to_string(), "spread": row.spread });
    let curve = |(method, steps): &(BenchmarkMethod, Vec<TraceStep>)| json!({ "method": method.to_string(), "elapsed_ms": column(steps, 0), "objective": column(steps, 1), "distance": column(steps, 2) });
    let profile = |(method, steps): &(BenchmarkMethod, Vec<[f64; 2]>)| {
        let of = |i: usize| steps.iter().map(|step| step[i]).collect::<Vec<_>>();
        json!({ "method": method.to_string(), "time_over_fastest": of(0), "share_solved": of(1) })
    };
    let mut map = Map::new();
    map.insert("spreads".to_owned(), rows.iter().map(timing).collect());
    map.insert("curves".to_owned(), curves.fits.iter().chain(&curves.models).map(curve).collect());
    map.insert("profiles".to_owned(), curves.profiles.iter().map(profile).collect());
    map
}

/// BRDF and DoLP.
type Values = (f64, f64);

/// A way to evaluate the model.
struct Evaluator<'a> {
    method: BenchmarkMethod,
    /// At a row of the table.
    values: &'a dyn Fn(&Reference) -> Values,
    /// Under all geometries, for its time.
    all: &'a dyn Fn(),
}

fn evaluations(golden: &[Reference], host: Host<'_>) -> Vec<ErrorVsTime> {
    let model = Model::full(SlopeDistribution::Cauchy);
    let parameters = Parameters::default();
    let geometries: Vec<Geometry> = golden.iter().map(|row| row.geometry).collect();
    let scene = GeometrySet::new(geometries.iter().copied());
    let Ok(surface) = Pbrdf::new(model, parameters) else { return Vec::new() };
    let double = |row: &Reference| textbook_f64(row.surface.model(), row.surface.parameters(), row.geometry);
    let single = |row: &Reference| {
        let (brdf, dolp) = textbook_f32(row.surface.model(), row.surface.parameters(), row.geometry);
        (f64::from(brdf), f64::from(dolp))
    };
    let scalar = |row: &Reference| {
        let reflection = row.surface.reflection(&Facet::new(row.geometry));
        (reflection.brdf, reflection.dolp)
    };
    let each = |body: &dyn Fn(Geometry)| {
        for &geometry in &geometries {
            body(black_box(geometry));
        }
    };
    let double_all = || each(&|geometry| _ = black_box(textbook_f64(model, &parameters, geometry)));
    let single_all = || each(&|geometry| _ = black_box(textbook_f32(model, &parameters, geometry)));
    let scalar_all = || each(&|geometry| _ = black_box(surface.reflection(&Facet::new(geometry))));
    let prepared_all = || scene.reflections(black_box(&surface)).for_each(|reflection| _ = black_box(reflection));
    let batch = Batch::new(geometries.iter().copied()).single_threaded();
    let radiances = RefCell::new(Radiances::default());
    let batch_all = || {
        batch.radiances(black_box(&surface), &mut radiances.borrow_mut());
        black_box(&radiances);
    };
    let batched = |row: &Reference| {
        let mut one = Radiances::default();
        Batch::new([row.geometry]).radiances(&row.surface, &mut one);
        let first = |of: &[f64]| of.first().copied().unwrap_or(f64::NAN);
        (first(&one.brdf), first(&one.dolp))
    };
    let methods = [
        Evaluator { method: BenchmarkMethod::TextbookF32, values: &single, all: &single_all },
        Evaluator { method: BenchmarkMethod::TextbookF64, values: &double, all: &double_all },
        Evaluator { method: BenchmarkMethod::FromAngles, values: &scalar, all: &scalar_all },
        Evaluator { method: BenchmarkMethod::Prepared, values: &scalar, all: &prepared_all },
        Evaluator { method: BenchmarkMethod::Batch, values: &batched, all: &batch_all },
    ];
    let mut rows = Vec::new();
    for Evaluator { method, values, all } in methods {
        if (host.cancelled)() {
            break;
        }
        let mut errors: Vec<f64> = golden.iter().map(|row| error_of(values(row), row)).collect();
        errors.sort_by(f64::total_cmp);
        #[expect(clippy::cast_precision_loss, reason = "a number of rows")]
        let points = golden.len() as f64;
        let time = Timing::of(host.clock, all);
        rows.push(ErrorVsTime {
            task: TaskKind::Evaluate,
            method,
            time: time.median_ns / points,
            spread: time.spread,
            worst_relative_error: quantile(&errors, 1.0),
            median_relative_error: quantile(&errors, 0.5),
            success_rate: None,
        });
    }
    rows
}

fn error_of((brdf, dolp): Values, row: &Reference) -> f64 {
    relative_error(brdf, row.brdf).max(relative_error(dolp, row.dolp))
}

#[cfg(test)]
mod tests {
    use super::{BenchmarkSize, ErrorVsTime};
    use crate::selftest::{Host, Machine};
    use serde_json::Value;
    use std::sync::atomic::{AtomicU32, Ordering};

    /// One start of each problem, everything once, by a clock that goes on by a long repetition whenever it is looked at.
    fn small() -> Value {
        let looks = AtomicU32::new(0);
        let clock = || 10.0 * f64::from(looks.fetch_add(1, Ordering::Relaxed));
        let host = Host { clock: &clock, cancelled: &|| false, progress: &|_| {} };
        let extent = BenchmarkSize { starts: 1, repetitions: 1, repetitions_of_many: 1 };
        ErrorVsTime::to_extent(extent, Machine::new("", 1), "2026-11-25T00:00:00Z".to_owned(), host).json_with_curves()
    }

    #[test]
    fn every_row_and_every_curve_has_what_the_file_promises() {
        let json = small();
        let rows = json["rows"].as_array().expect("rows");
        for row in rows {
            let is_fit = row["task"] == "fit";
            assert!(is_fit || row["task"] == "evaluate", "{row}");
            assert_eq!((row["ns_per_point"].is_number(), row["elapsed_ms"].is_number()), (!is_fit, is_fit), "{row}");
            assert!(
                row["method"].is_string() && row["worst_relative_error"].is_number() && row["median_relative_error"].is_number(),
                "{row}"
            );
            let is_model = row["method"].as_str().is_some_and(|method| method.starts_with("model "));
            assert_eq!(row["success_rate"].is_number(), is_fit && !is_model, "{row}");
        }
        let named = |part: &str| rows.iter().filter(|row| row["method"].as_str().is_some_and(|method| method.contains(part))).count();
        let counts =
            ["analytic Jacobian", "finite-difference Jacobian", ", unscaled", ", scaled", "this program", "model ", "textbook", "batch"]
                .map(named);
        // One start and all starts of each of the four; ten models.
        assert_eq!(counts, [4, 4, 4, 4, 2, 10, 2, 1]);
        let curves = json["curves"].as_array().expect("curves");
        assert_eq!(curves.len(), 20);
        for curve in curves {
            let [times, objectives, distances] = ["elapsed_ms", "objective", "distance"].map(|key| curve[key].as_array().expect("a list"));
            assert!(!times.is_empty() && times.len() == objectives.len() && times.len() == distances.len(), "{curve}");
        }
        let profiles = json["profiles"].as_array().expect("profiles");
        assert!(
            profiles.len() == 10
                && profiles.iter().any(|profile| profile["share_solved"].as_array().is_some_and(|shares| !shares.is_empty()))
        );
        let shape: Vec<&str> = json.as_object().expect("an object").keys().map(String::as_str).collect();
        assert_eq!(shape, ["curves", "date", "machine", "profiles", "rows", "spreads"]);
    }
}
