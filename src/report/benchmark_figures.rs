//! Figures of the benchmarks.

use crate::figure::{Axis, Dash, Figure, Mark, Panel, Series};
use crate::report::language::ReportLanguage;
use pbrdf::selftest::{BenchmarkMethod, Cell, Cost, ErrorVsTime, GRADIENT_BAR, Report, Stability, TaskKind, VALUE_BAR, digits};

/// A report that has figures.
pub trait BenchmarkFigures {
    /// The figures in a language, each with the end of the name of its file.
    fn figures(&self, words: &dyn ReportLanguage) -> Vec<(&'static str, Figure)>;
}

impl BenchmarkFigures for Report<ErrorVsTime> {
    fn figures(&self, words: &dyn ReportLanguage) -> Vec<(&'static str, Figure)> {
        let figures = vec![
            ("evaluate", work_precision(&self.rows, Compared::Evaluations, words)),
            ("fit", along_fits(&self.curves.fits, words)),
            ("profile", performance_profile(&self.curves.profiles, words)),
            ("models", work_precision(&self.rows, Compared::Models, words)),
            ("ladder", along_the_ladder(&self.curves.models, words)),
        ];
        figures.into_iter().map(|(name, figure)| (name, figure.translate(&|text| words.label(text)))).collect()
    }
}

impl BenchmarkFigures for Report<Stability> {
    fn figures(&self, words: &dyn ReportLanguage) -> Vec<(&'static str, Figure)> {
        vec![("digits", digits_held(&self.rows).translate(&|text| words.label(text)))]
    }
}

impl BenchmarkFigures for Report<Cost> {
    fn figures(&self, words: &dyn ReportLanguage) -> Vec<(&'static str, Figure)> {
        vec![("time", bars(&self.rows, words).translate(&|text| words.label(text)))]
    }
}

/// Smallest error drawn, a tenth of a rounding error: a logarithmic axis has no 0.
const DRAWN_AT_LEAST: f64 = 1e-17;

/// What a work–precision diagram compares.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Compared {
    Evaluations,
    Models,
}

/// Work–precision diagram: from the median to the worst error at the time of each method.
fn work_precision(rows: &[ErrorVsTime], compared: Compared, words: &dyn ReportLanguage) -> Figure {
    let belongs = |row: &&ErrorVsTime| match compared {
        Compared::Evaluations => row.task == TaskKind::Evaluate,
        Compared::Models => row.is_model(),
    };
    let rows: Vec<&ErrorVsTime> = rows.iter().filter(belongs).collect();
    let series = rows.iter().flat_map(|row| {
        let ends = [row.median_relative_error, row.worst_relative_error].map(|error| [row.time, error.max(DRAWN_AT_LEAST)]);
        let name = words.method(row.method);
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

/// What is along the vertical axis of a way, by its place in a step.
const OBJECTIVE: (usize, &str) = (1, "objective ΔE");
const DISTANCE: (usize, &str) = (2, "distance to the truth");

/// Ways of fits in one panel; the times of both panels of a figure are those of all steps.
fn ways(ways: &[(BenchmarkMethod, Vec<[f64; 3]>)], (place, label): (usize, &str), legend: bool, words: &dyn ReportLanguage) -> Panel {
    let series = ways.iter().map(|(method, steps)| {
        let points = steps.iter().map(|step| [step[0], step[place]]).filter(|[ms, y]| *ms > 0.0 && *y > 0.0);
        Series::line(words.method(*method), points.collect())
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
fn along_fits(curves: &[(BenchmarkMethod, Vec<[f64; 3]>)], words: &dyn ReportLanguage) -> Figure {
    let panels = vec![ways(curves, OBJECTIVE, true, words), ways(curves, DISTANCE, false, words)];
    let title = "Along one fit: noise-free Gauss data, dense angles, first from the defaults".to_owned();
    Figure { title, panels, height_mm: 200.0, ..Figure::default() }
}

/// Objective along a fit of each model.
fn along_the_ladder(curves: &[(BenchmarkMethod, Vec<[f64; 3]>)], words: &dyn ReportLanguage) -> Figure {
    let title = "Along one fit of each model: the same Cauchy data, noise 0.005, from the defaults".to_owned();
    Figure { title, panels: vec![ways(curves, OBJECTIVE, true, words)], height_mm: 120.0, ..Figure::default() }
}

/// Dolan and Moré's performance profile.
fn performance_profile(profiles: &[(BenchmarkMethod, Vec<[f64; 2]>)], words: &dyn ReportLanguage) -> Figure {
    let last = profiles.iter().flat_map(|(_, steps)| steps).map(|step| step[0]).fold(1.0, f64::max);
    // Each curve continues to the end at its final share.
    let to_the_end = |steps: &[[f64; 2]]| steps.iter().copied().chain(steps.last().map(|step| [2.0 * last, step[1]])).collect();
    let series = profiles.iter().map(|(method, steps)| Series::steps(words.method(*method), to_the_end(steps))).collect();
    let x = Axis::log("time over that of the fastest method", "");
    let y = Axis::linear("share of problems solved", "").between(0.0, 1.05);
    let panel = Panel { x, y, series, ..Panel::default() };
    Figure { title: "Performance profile of the solvers".to_owned(), panels: vec![panel], height_mm: 130.0, ..Figure::default() }
}

/// Thickness of a bar in the figure, in points.
const BAR_POINTS: f64 = 9.0;

/// A bar for each scene, the first on top.
fn bars(rows: &[Cost], words: &dyn ReportLanguage) -> Figure {
    let places = || (0_u32..).map(f64::from).zip(rows.iter().rev());
    let shortest = rows.iter().map(|row| row.time.median_ns).fold(f64::INFINITY, f64::min);
    let longest = rows.iter().map(|row| row.time.median_ns).fold(0.0, f64::max);
    let from = 0.5 * shortest;
    let of = |kernel: &str| {
        let bar = |(y, row): (f64, &Cost)| [[from, y], [row.time.median_ns, y], [f64::NAN; 2]];
        let points: Vec<[f64; 2]> = places().filter(|(_, row)| row.kernel == kernel).flat_map(bar).collect();
        Series { mark: Mark::Line { points, width: BAR_POINTS, dash: Dash::Solid }, ..Series::line(kernel, Vec::new()) }
    };
    let numbers = places().map(|(y, row)| ([row.time.median_ns, y], Cell::Number(row.time.median_ns).to_string())).collect();
    let name = |row: &Cost| match (row.kernel, row.threads) {
        ("scalar", _) => row.scene.to_owned(),
        (kernel, _) => words.fill("{0} ({1})", &[&words.label(row.scene), &words.label(kernel)]),
    };
    let panel = Panel {
        x: Axis::log("time of a point", "ns").between(from, 3.0 * longest),
        y: Axis::categories("", rows.iter().rev().map(name)),
        series: vec![of("scalar"), of("batch"), Series::labels(numbers)],
        ..Panel::default()
    };
    Figure { title: "What a scene costs".to_owned(), panels: vec![panel], width_mm: 210.0, height_mm: 150.0, ..Figure::default() }
}

/// Digits held in each evaluation case, beside those of the textbook form.
fn digits_held(rows: &[Stability]) -> Figure {
    let cases: Vec<&Stability> = rows.iter().filter(|row| row.brdf_error.is_some()).collect();
    let series = |name: &str, error: &dyn Fn(&Stability) -> Option<f64>| {
        let points = (0_u32..).map(f64::from).zip(&cases);
        Series::points(name, points.filter_map(|(x, row)| Some([x, digits(error(row)?)])).collect::<Vec<_>>())
    };
    let panel = Panel {
        x: Axis::linear("evaluation case, in the order of the table", ""),
        y: Axis::linear("decimal digits held", "").between(-0.5, 17.0),
        series: vec![
            series("BRDF and DoLP", &|row| Some(row.brdf_error?.max(row.dolp_error?))),
            series("gradient", &|row| row.gradient_error),
            series("textbook form", &|row| row.textbook_error),
            Series::level("limit on values", digits(VALUE_BAR)),
            Series::level("limit on gradients", digits(GRADIENT_BAR)),
        ],
        ..Panel::default()
    };
    Figure { title: "Digits held in stiff and extreme cases".to_owned(), panels: vec![panel], ..Figure::default() }
}
