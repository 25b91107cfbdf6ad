//! A row of the report of error against run time.

use crate::selftest::method::BenchmarkMethod;
use crate::selftest::{BenchmarkRow, Cell};

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
    pub method: BenchmarkMethod,
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

impl BenchmarkRow for ErrorVsTime {
    const COLUMNS: &'static [&'static str] =
        &["task", "method", "ns_per_point", "elapsed_ms", "worst_relative_error", "median_relative_error", "success_rate"];

    fn cells(&self) -> Vec<Cell> {
        let time_of = |task: TaskKind| if self.task == task { Cell::Number(self.time) } else { Cell::Absent };
        vec![
            Cell::Text(self.task.key().to_owned()),
            Cell::Text(self.method.to_string()),
            time_of(TaskKind::Evaluate),
            time_of(TaskKind::Fit),
            Cell::Number(self.worst_relative_error),
            Cell::Number(self.median_relative_error),
            Cell::maybe(self.success_rate),
        ]
    }
}

impl ErrorVsTime {
    /// Whether it compares models, not methods.
    #[must_use]
    pub fn is_model(&self) -> bool {
        matches!(self.method, BenchmarkMethod::Model(_))
    }
}
