//! Error against run time: of evaluations against the 60-digit table.

use super::reference::{Reference, golden, relative_error};
use super::textbook::{textbook_f32, textbook_f64};
use super::{Cell, Machine, Report, Row, Surroundings, Timing, quantile};
use crate::model::{Model, Parameters, Pbrdf, Scene};
use crate::optics::{Facet, Geometry, SlopeDistribution};
use std::hint::black_box;

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TaskKind {
    /// Values of BRDF and DoLP.
    Evaluate,
}

/// A method: how long it takes and how far off it is.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorVsTime {
    /// What was done.
    pub task: TaskKind,
    /// By which method.
    pub method: String,
    /// Time of a point.
    pub time: Timing,
    /// Largest relative error in BRDF or DoLP.
    pub worst_relative_error: f64,
    /// Median of the larger of both.
    pub median_relative_error: f64,
}

impl Row for ErrorVsTime {
    const COLUMNS: &'static [&'static str] =
        &["task", "method", "ns_per_point", "worst_relative_error", "median_relative_error", "success_rate"];

    fn cells(&self) -> Vec<Cell> {
        let task = match self.task {
            TaskKind::Evaluate => "evaluate",
        };
        vec![
            Cell::Text(task.to_owned()),
            Cell::Text(self.method.clone()),
            Cell::Number(self.time.median_ns),
            Cell::Number(self.worst_relative_error),
            Cell::Number(self.median_relative_error),
            Cell::Absent,
        ]
    }
}

impl ErrorVsTime {
    /// Makes the report.
    #[must_use]
    pub fn run(machine: Machine, date: String, surroundings: Surroundings<'_>) -> Report<Self> {
        let golden = golden();
        let rows = evaluations(&golden, surroundings);
        let notes = vec![format!(
            "Evaluation: BRDF and DoLP of the nine-parameter model on the {} rows of the 60-digit table; times with one Cauchy surface \
             under all its geometries. An error of 1 means not a single digit.",
            golden.len()
        )];
        Report::new("Error against run time", machine, date, rows, notes)
    }
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
    let methods = [
        Method { name: "textbook, f32", values: &single, all: &single_all },
        Method { name: "textbook, f64", values: &double, all: &double_all },
        Method { name: "cancellation-free, from angles", values: &scalar, all: &scalar_all },
        Method { name: "cancellation-free, prepared scene", values: &scalar, all: &prepared_all },
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
            time: Timing { median_ns: time.median_ns / points, ..time },
            worst_relative_error: quantile(&errors, 1.0),
            median_relative_error: quantile(&errors, 0.5),
        });
    }
    rows
}

fn error_of((brdf, dolp): Values, row: &Reference) -> f64 {
    relative_error(brdf, row.brdf).max(relative_error(dolp, row.dolp))
}
