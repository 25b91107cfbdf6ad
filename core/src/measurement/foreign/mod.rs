//! Foreign tables, read in stages: bytes → text → cells → regions → columns → rows → measurements.
//!
//! Each stage is a value that keeps the places of its cells, so that every message has a line and a
//! column. Alternatives are scored: a clear winner is taken, a tie is a [`Doubt`].

mod assembly;
#[cfg(feature = "workbooks")]
mod contained;
mod dialect;
mod dialect_guess;
mod doubt;
mod encoding;
mod grid;
mod heading;
mod heading_meaning;
mod layout;
mod number;
#[cfg(feature = "workbooks")]
mod old_workbook;
#[cfg(feature = "workbooks")]
mod open_document;
mod options;
mod other_format;
mod plan;
mod planned_column;
mod row_reader;
mod table;
mod title;
mod vocabulary;
#[cfg(feature = "workbooks")]
mod workbook;

use super::Field;

/// The field that the name of a column means, in any laboratory.
pub(crate) fn field_of(name: &str) -> Option<Field> {
    match heading::ColumnHeading::new(name).meaning {
        heading_meaning::Meaning::Field(field) => Some(field),
        _ => None,
    }
}

pub use dialect::{Decimal, Dialect, Separator};
pub use doubt::Doubt;
pub use layout::RowKind;
pub use options::TableOptions;
pub use other_format::OtherFormat;
pub use planned_column::PlannedColumn;
pub use table::{LabTable, ShownRow, TableGuess, is_workbook};
