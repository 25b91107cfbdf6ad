//! Many fits for one call: rows of a table, made without the interpreter's lock on one thread.

use crate::error::refused;
use crate::fitting::{Plan, Settings};
use crate::names::preset;
use pbrdf::fit::{Fit, Observer, RowCell, StopReason, on_one_thread, row_columns};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks fits on other threads to stop.
#[pyclass(frozen, module = "pbrdf._pbrdf")]
pub struct Stop {
    asked: AtomicBool,
}

#[pymethods]
impl Stop {
    #[new]
    fn new() -> Self {
        Self { asked: AtomicBool::new(false) }
    }

    /// From now on every fit ends at its next step.
    fn ask(&self) {
        self.asked.store(true, Ordering::Relaxed);
    }
}

/// A cell that is there.
#[derive(IntoPyObject)]
pub enum Value {
    Number(f64),
    Count(usize),
    Text(String),
    Flag(bool),
}

/// The cells of a fit, or none and the sentence why.
type RowOrError = (Vec<Option<Value>>, String);

fn value(cell: RowCell) -> Option<Value> {
    match cell {
        RowCell::Empty => None,
        RowCell::Number(number) => Some(Value::Number(number)),
        RowCell::Count(count) => Some(Value::Count(count)),
        RowCell::Text(text) => Some(Value::Text(text)),
        RowCell::Flag(flag) => Some(Value::Flag(flag)),
    }
}

/// Names of the cells of a fit of that model.
#[pyfunction]
pub fn fit_row_columns(model: &str) -> PyResult<Vec<String>> {
    Ok(row_columns(preset(model)?.model.parameters()))
}

/// How many threads all work is spread over.
#[pyfunction]
pub fn thread_count() -> usize {
    pbrdf::fit::thread_count()
}

/// The model fitted to each of many measurements, which are tables as `Measurement.to_csv` writes them. Where it was asked to stop, what is
/// done until then.
#[pyfunction]
pub fn fit_rows(py: Python<'_>, tables: Vec<PyBackedBytes>, settings: Settings, stop: Option<Py<Stop>>) -> PyResult<Vec<RowOrError>> {
    let plan = Plan::new(settings)?;
    if let Some(set) = plan.sets().next() {
        return Err(refused(format_args!("all measurements are fitted in the same way; leave @{set} out, or fit it by itself")));
    }
    let cancelled = || stop.as_ref().is_some_and(|stop| stop.get().asked.load(Ordering::Relaxed));
    let observer = Observer { cancelled: &cancelled, ..Observer::NONE };
    let rows = py.detach(|| on_one_thread(|| tables.iter().map_while(|table| row(&plan, table, observer)).collect()));
    Ok(rows)
}

/// The row of a measurement; none where it was asked to stop.
fn row(plan: &Plan, table: &[u8], observer: Observer<'_>) -> Option<RowOrError> {
    if (observer.cancelled)() {
        return None;
    }
    let failed = |sentence: String| Some((Vec::new(), sentence));
    let measurement = match pbrdf::Measurement::read(table) {
        Ok(measurement) => measurement,
        Err(error) => return failed(error.to_string()),
    };
    let problem = match plan.describe(Fit::new(&measurement, plan.preset.model), "").problem() {
        Ok(problem) => problem,
        Err(error) => return failed(error.hint().map_or_else(|| error.to_string(), |hint| format!("{error}; {hint}"))),
    };
    let result = plan.run(&problem, observer);
    if result.stop_reason == StopReason::Cancelled || (observer.cancelled)() {
        return None;
    }
    let used = measurement.used_rows();
    Some((result.row(used).into_iter().map(value).collect(), String::new()))
}
