//! Error against run time: of evaluations against the 60-digit table, and along fits.

use super::figure::{Axis, Figure, Panel, Series};
use super::fit_race::{Extent, Race, Step};
use super::ladder_race::LADDER;
use super::reference::{Reference, golden, relative_error};
use super::textbook::{textbook_f32, textbook_f64};
use super::{Cell, Machine, Report, Row, Surroundings, Timing, quantile};
use crate::model::{Batch, Model, Parameters, Pbrdf, Radiances, Scene};
use crate::optics::{Facet, Geometry, SlopeDistribution};
use serde_json::{Map, Value, json};
use std::cell::RefCell;
use std::hint::black_box;

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TaskKind {
    /// Values of BRDF and DoLP.
    Evaluate,
    /// Parameters from data.
    Fit,
}

impl TaskKind {
    /// Its name in the table.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Evaluate => "evaluate",
            Self::Fit => "fit",
        }
    }
}

/// A method: how long it takes and how far off it is.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorVsTime {
    /// What was done.
    pub task: TaskKind,
    /// By which method.
    pub method: String,
    /// Median time: nanoseconds of an evaluated point, milliseconds of a fit.
    pub time: f64,
    /// Half the distance between the quartiles of the time over its median; NaN where there is one time alone.
    pub spread: f64,
    /// Largest relative error.
    pub worst_relative_error: f64,
    /// Its median.
    pub median_relative_error: f64,
    /// Share of fits that reached the best objective known.
    pub success_rate: Option<f64>,
}

impl Row for ErrorVsTime {
    const COLUMNS: &'static [&'static str] =
        &["task", "method", "ns_per_point", "elapsed_ms", "worst_relative_error", "median_relative_error", "success_rate"];

    fn cells(&self) -> Vec<Cell> {
        let time_of = |task: TaskKind| if self.task == task { Cell::Number(self.time) } else { Cell::Absent };
        vec![
            Cell::Text(self.task.key().to_owned()),
            Cell::Text(self.method.clone()),
            time_of(TaskKind::Evaluate),
            time_of(TaskKind::Fit),
            Cell::Number(self.worst_relative_error),
            Cell::Number(self.median_relative_error),
            Cell::maybe(self.success_rate),
        ]
    }
}

impl ErrorVsTime {
    /// Makes the report.
    #[must_use]
    pub fn run(machine: Machine, date: String, surroundings: Surroundings<'_>) -> Report<Self> {
        Self::to_extent(Extent::WHOLE, machine, date, surroundings)
    }

    fn to_extent(extent: Extent, machine: Machine, date: String, surroundings: Surroundings<'_>) -> Report<Self> {
        let golden = golden();
        let mut rows = evaluations(&golden, surroundings);
        (surroundings.progress)(0.05);
        let mut race = if (surroundings.cancelled)() { Race::default() } else { Race::run(extent, surroundings) };
        rows.append(&mut race.rows);
        let figures = vec![
            ("evaluate", work_precision(&rows, Compared::Evaluations)),
            ("fit", along_fits(&race.curves)),
            ("profile", performance_profile(&race.profiles)),
            ("models", work_precision(&rows, Compared::Models)),
            ("ladder", along_the_ladder(&race.ladder)),
        ];
        let notes = notes(golden.len(), extent, &rows);
        let further = curves(&rows, &race);
        Report { figures, further, ..Report::new("Error against run time", machine, date, rows, notes) }
    }
}

fn notes(golden: usize, extent: Extent, rows: &[ErrorVsTime]) -> Vec<String> {
    let Extent { starts, repetitions, repetitions_of_many } = extent;
    let spreads = rows.iter().filter(|row| row.spread.is_finite());
    let spreads: Vec<String> = spreads.map(|row| format!("{} {:.1} %", row.method, 100.0 * row.spread)).collect();
    vec![
        format!(
            "Evaluation: BRDF and DoLP of the nine-parameter model on the {golden} rows of the 60-digit table; times with one Cauchy surface under all \
             its geometries, on one thread: median of 11 repetitions after a warm-up. An error of 1 means not a single digit."
        ),
        format!(
            "Fits: eight simulated DoLP data sets of steel (Gauss and Cauchy; 144 dense angles or the paper's 27; noise 0 or 0.005) from {starts} \
             starts each, which \"{starts} starts\" takes one after the other. Times are medians of {repetitions} repetitions after a warm-up, of \
             {repetitions_of_many} for many starts (all threads); elapsed_ms is the median over the fits; success is the best objective known \
             within a factor 1 + 1e-6, or 1e-20; the errors are the largest relative distance of a parameter from the truth where dense angles \
             without noise tell it."
        ),
        "Models: each of the ladder fitted with many starts to the dense Cauchy data with noise 0.005; the errors are those of its DoLP against the \
         noise-free one where that is above 0.001."
            .to_owned(),
        format!("Spread of the repetitions, half the distance between the quartiles over the median: {}.", spreads.join("; ")),
    ]
}

/// Times with their spread, curves and profiles, for the file.
fn curves(rows: &[ErrorVsTime], race: &Race) -> Map<String, Value> {
    let column = |steps: &[Step], i: usize| steps.iter().map(|step| step[i]).collect::<Vec<_>>();
    let timing = |row: &ErrorVsTime| json!({ "task": row.task.key(), "method": row.method, "spread": row.spread });
    let curve = |(method, steps): &(String, Vec<Step>)| json!({ "method": method, "elapsed_ms": column(steps, 0), "objective": column(steps, 1), "distance": column(steps, 2) });
    let profile = |(method, steps): &(String, Vec<[f64; 2]>)| {
        let of = |i: usize| steps.iter().map(|step| step[i]).collect::<Vec<_>>();
        json!({ "method": method, "time_over_fastest": of(0), "share_solved": of(1) })
    };
    let mut map = Map::new();
    map.insert("spreads".to_owned(), rows.iter().map(timing).collect());
    map.insert("curves".to_owned(), race.curves.iter().chain(&race.ladder).map(curve).collect());
    map.insert("profiles".to_owned(), race.profiles.iter().map(profile).collect());
    map
}

/// Errors below a tenth of a rounding are drawn there: a logarithmic axis has no 0.
const DRAWN_AT_LEAST: f64 = 1e-17;

/// What a work–precision diagram compares.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Compared {
    Evaluations,
    Models,
}

/// Work–precision diagram: from the median to the worst error at the time of each method.
fn work_precision(rows: &[ErrorVsTime], compared: Compared) -> Figure {
    let belongs = |row: &&ErrorVsTime| match compared {
        Compared::Evaluations => row.task == TaskKind::Evaluate,
        Compared::Models => row.task == TaskKind::Fit && row.method.starts_with(LADDER),
    };
    let rows: Vec<&ErrorVsTime> = rows.iter().filter(belongs).collect();
    let series = rows.iter().flat_map(|row| {
        let ends = [row.median_relative_error, row.worst_relative_error].map(|error| [row.time, error.max(DRAWN_AT_LEAST)]);
        let name = short(&row.method);
        [Series::line(name.clone(), ends.to_vec()), Series::points(name, ends)]
    });
    let (title, label, unit) = match compared {
        Compared::Evaluations => ("Evaluation: error against time", "time of a point", "ns"),
        Compared::Models => ("Models on the same data: error of DoLP against time", "time of a fit with many starts", "ms"),
    };
    let fastest = rows.iter().map(|row| row.time).fold(f64::INFINITY, f64::min);
    let slowest = rows.iter().map(|row| row.time).fold(0.0, f64::max);
    let panel = Panel {
        x: Axis::log(label, unit).between(0.7 * fastest, 1.4 * slowest),
        y: Axis::log("relative error, median to worst", ""),
        series: series.collect(),
        ..Panel::default()
    };
    Figure { title: title.to_owned(), panels: vec![panel], height_mm: 130.0, ..Figure::default() }
}

impl ErrorVsTime {
    /// The method's name where there is little room.
    #[must_use]
    pub fn short_method(&self) -> String {
        short(&self.method)
    }
}

/// A method's name as a legend has room for it.
fn short(method: &str) -> String {
    method.replace("Levenberg–Marquardt", "LM").replace("finite-difference", "differences").replace(" Jacobian", "")
}

/// What is along the vertical axis of a way, by its place in a step.
const OBJECTIVE: (usize, &str) = (1, "objective ΔE");
const DISTANCE: (usize, &str) = (2, "distance to the truth");

/// Ways of fits in one panel; the times of both panels of a figure are those of all steps.
fn ways(ways: &[(String, Vec<Step>)], (place, label): (usize, &str), legend: bool) -> Panel {
    let series = ways.iter().map(|(method, steps)| {
        let points = steps.iter().map(|step| [step[0], step[place]]).filter(|[ms, y]| *ms > 0.0 && *y > 0.0);
        Series::line(short(method), points.collect())
    });
    let times = || ways.iter().flat_map(|(_, steps)| steps).map(|step| step[0]).filter(|ms| *ms > 0.0);
    let (first, last) = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    Panel {
        x: Axis::log("elapsed", "ms").between(first, 1.1 * last),
        y: Axis::log(label, ""),
        series: series.collect(),
        legend,
        ..Panel::default()
    }
}

/// Objective and distance to the truth along one fit.
fn along_fits(curves: &[(String, Vec<Step>)]) -> Figure {
    let panels = vec![ways(curves, OBJECTIVE, true), ways(curves, DISTANCE, false)];
    let title = "Along one fit: noise-free Gauss data, dense angles, first from the defaults".to_owned();
    Figure { title, panels, height_mm: 200.0, ..Figure::default() }
}

/// Objective along a fit of each model.
fn along_the_ladder(curves: &[(String, Vec<Step>)]) -> Figure {
    let title = "Along one fit of each model: the same Cauchy data, noise 0.005, from the defaults".to_owned();
    Figure { title, panels: vec![ways(curves, OBJECTIVE, true)], height_mm: 120.0, ..Figure::default() }
}

/// Dolan and Moré's performance profile.
fn performance_profile(profiles: &[(String, Vec<[f64; 2]>)]) -> Figure {
    let last = profiles.iter().flat_map(|(_, steps)| steps).map(|step| step[0]).fold(1.0, f64::max);
    // Each goes on to the end at the share it has reached.
    let to_the_end = |steps: &[[f64; 2]]| steps.iter().copied().chain(steps.last().map(|step| [2.0 * last, step[1]])).collect();
    let series = profiles.iter().map(|(method, steps)| Series::steps(short(method), to_the_end(steps))).collect();
    let x = Axis::log("time over that of the fastest method", "");
    let y = Axis::linear("share of problems solved", "").between(0.0, 1.05);
    let panel = Panel { x, y, series, ..Panel::default() };
    Figure { title: "Performance profile of the solvers".to_owned(), panels: vec![panel], height_mm: 130.0, ..Figure::default() }
}

/// BRDF and DoLP.
type Values = (f64, f64);

/// A way to evaluate the model.
struct Method<'a> {
    name: &'static str,
    /// At a row of the table.
    values: &'a dyn Fn(&Reference) -> Values,
    /// Under all geometries, for its time.
    all: &'a dyn Fn(),
}

fn evaluations(golden: &[Reference], surroundings: Surroundings<'_>) -> Vec<ErrorVsTime> {
    let model = Model::full(SlopeDistribution::Cauchy);
    let parameters = Parameters::default();
    let geometries: Vec<Geometry> = golden.iter().map(|row| row.geometry).collect();
    let scene = Scene::new(geometries.iter().copied());
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
        Method { name: "textbook, f32", values: &single, all: &single_all },
        Method { name: "textbook, f64", values: &double, all: &double_all },
        Method { name: "cancellation-free, from angles", values: &scalar, all: &scalar_all },
        Method { name: "cancellation-free, prepared scene", values: &scalar, all: &prepared_all },
        Method { name: "batch kernel, prepared scene", values: &batched, all: &batch_all },
    ];
    let mut rows = Vec::new();
    for Method { name, values, all } in methods {
        if (surroundings.cancelled)() {
            break;
        }
        let mut errors: Vec<f64> = golden.iter().map(|row| error_of(values(row), row)).collect();
        errors.sort_by(f64::total_cmp);
        #[expect(clippy::cast_precision_loss, reason = "a number of rows")]
        let points = golden.len() as f64;
        let time = Timing::of(surroundings.clock, all);
        rows.push(ErrorVsTime {
            task: TaskKind::Evaluate,
            method: name.to_owned(),
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
    use super::{ErrorVsTime, Extent};
    use crate::report::{Machine, Surroundings};
    use serde_json::Value;
    use std::sync::atomic::{AtomicU32, Ordering};

    /// One start of each problem, everything once, by a clock that goes on by a long repetition whenever it is looked at.
    fn small() -> Value {
        let looks = AtomicU32::new(0);
        let clock = || 10.0 * f64::from(looks.fetch_add(1, Ordering::Relaxed));
        let surroundings = Surroundings { clock: &clock, cancelled: &|| false, progress: &|_| {} };
        let extent = Extent { starts: 1, repetitions: 1, repetitions_of_many: 1 };
        ErrorVsTime::to_extent(extent, Machine::new("", 1), "2026-11-25T00:00:00Z".to_owned(), surroundings).json_with_curves()
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
