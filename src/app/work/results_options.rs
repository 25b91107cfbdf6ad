//! How the table of results is arranged: which columns are hidden, and by which row the others are sorted.

use pbrdf::model::Parameter;
use serde::{Deserialize, Serialize};

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ResultRow {
    Parameter(Parameter),
    DeltaE,
    Aicc,
    Rows,
}

/// A column by the name of its measurement and the key of its model; empty for terms without a name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResultColumnId {
    pub measurement: String,
    pub model: String,
}

/// The arrangement.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct ResultsOptions {
    pub hidden: Vec<ResultColumnId>,
    /// The row that columns are sorted by, and whether downwards.
    pub sorted: Option<(ResultRow, bool)>,
}

impl ResultsOptions {
    pub fn is_hidden(&self, column: &ResultColumnId) -> bool {
        self.hidden.contains(column)
    }

    /// Follows a measurement to its new name.
    pub fn rename(&mut self, before: &str, after: &str) {
        for column in self.hidden.iter_mut().filter(|column| column.measurement == before) {
            after.clone_into(&mut column.measurement);
        }
    }
}
