//! A fit as a row of a table of many fits: numbers to the last bit, empty cells for what does not exist.

use crate::fit::estimate::{Edge, Estimate};
use crate::fit::intervals::interval::Interval;
use crate::fit::result::FitResult;
use crate::model::{Parameter, ParameterSet};
use crate::optics::shortest;
use serde_json::json;
use std::fmt;

/// A cell of a row; `Display` writes it as tables of text hold it.
#[derive(Debug, Clone, PartialEq)]
pub enum RowCell {
    /// What does not exist or is not finite.
    Empty,
    /// A number, in the unit of its column.
    Number(f64),
    /// How many.
    Count(usize),
    /// A word or a sentence.
    Text(String),
    /// Yes or no.
    Flag(bool),
}

impl RowCell {
    fn number(value: Option<f64>) -> Self {
        value.filter(|value| value.is_finite()).map_or(Self::Empty, Self::Number)
    }

    fn word(text: &str) -> Self {
        if text.is_empty() { Self::Empty } else { Self::Text(text.to_owned()) }
    }
}

impl fmt::Display for RowCell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => Ok(()),
            Self::Number(number) => f.write_str(&shortest(*number)),
            Self::Count(count) => count.fmt(f),
            Self::Text(text) => f.write_str(text),
            Self::Flag(flag) => flag.fmt(f),
        }
    }
}

/// What is said of the fit as a whole.
const GOODNESS: [&str; 7] = ["rows", "stop_reason", "objective", "sum_of_squares", "chi2", "dof", "aicc"];
/// What is said of a parameter beside its value; names go on after its own, `n_std_error`.
const OF_PARAMETER: [&str; 7] = ["std_error", "low68", "high68", "low95", "high95", "at_bound", "determined"];

/// Names of the cells of a fit, for a model with these parameters: `rows`, `stop_reason`, `objective` …, `n`, `n_std_error`, `n_low68` …,
/// `undetermined`.
///
/// ```
/// use pbrdf::fit::row_columns;
/// use pbrdf::model::Parameter;
///
/// let columns = row_columns([Parameter::N, Parameter::K].into_iter().collect());
/// assert_eq!(columns[7..9], ["n", "n_std_error"]);
/// ```
#[must_use]
pub fn row_columns(parameters: ParameterSet) -> Vec<String> {
    let of = |parameter: Parameter| {
        let key = parameter.key();
        std::iter::once(key.to_owned()).chain(OF_PARAMETER.map(|name| format!("{key}_{name}")))
    };
    let goodness = GOODNESS.into_iter().map(str::to_owned);
    goodness.chain(parameters.iter().flat_map(of)).chain(["undetermined".to_owned()]).collect()
}

impl FitResult {
    /// The cells of this fit of so many rows, in the order of [`row_columns`]. A fixed parameter has its value alone.
    #[must_use]
    pub fn row(&self, rows: usize) -> Vec<RowCell> {
        let goodness = [
            RowCell::Count(rows),
            RowCell::word(json!(self.stop_reason).as_str().unwrap_or_default()),
            RowCell::number(self.objective),
            RowCell::number(Some(self.statistics.rss)),
            RowCell::number(self.statistics.chi2),
            RowCell::Count(self.statistics.dof),
            RowCell::number(self.statistics.aicc),
        ];
        let open: Vec<String> = self.describe_undetermined().iter().map(ToString::to_string).collect();
        goodness.into_iter().chain(self.estimates.iter().flat_map(of_estimate)).chain([RowCell::word(&open.join("; "))]).collect()
    }
}

/// Value, error, ends of both intervals, bound, verdict.
fn of_estimate(estimate: &Estimate) -> [RowCell; 8] {
    let ends = |interval: Option<Interval>| {
        [interval.and_then(|interval| interval.low), interval.and_then(|interval| interval.high)].map(RowCell::number)
    };
    let ([low68, high68], [low95, high95]) = (ends(estimate.interval68), ends(estimate.interval95));
    let bound = estimate.at_bound.map_or("", |edge| if edge == Edge::Lower { "lower" } else { "upper" });
    let determined = if estimate.free { RowCell::Flag(estimate.determined) } else { RowCell::Empty };
    [
        RowCell::number(Some(estimate.value)),
        RowCell::number(estimate.std_error),
        low68,
        high68,
        low95,
        high95,
        RowCell::word(bound),
        determined,
    ]
}

#[cfg(test)]
mod tests {
    use super::row_columns;
    use crate::fit::{Fit, Observer, Starts, fit};
    use crate::measurement::Measurement;
    use crate::model::PRESETS;

    #[test]
    fn a_row_has_a_cell_for_each_column() {
        let table = "theta_i,theta_r,dolp\n30,30,0.1\n50,50,0.3\n60,60,0.4\n70,70,0.5\n";
        let measurement = Measurement::read(table.as_bytes()).unwrap();
        for preset in PRESETS {
            let model = preset.model;
            let Ok(problem) = Fit::new(&measurement, model).problem() else { continue };
            let row = fit(&problem, Starts::One, 1, Observer::NONE).row(4);
            assert_eq!(row.len(), row_columns(model.parameters()).len(), "{}", preset.key);
        }
    }
}
