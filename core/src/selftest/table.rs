//! A report as a value: rows with named columns, which Markdown, JSON and the window show each in their way.

use crate::selftest::Machine;
use crate::selftest::method::BenchmarkMethod;
use crate::selftest::note::Note;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// What stands in one column of one row.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number; null in JSON where it is not finite.
    Number(f64),
    /// A whole number.
    Count(usize),
    /// Yes or no.
    Flag(bool),
    /// There is none.
    Absent,
}

impl Cell {
    /// A number that may not be there.
    #[must_use]
    pub fn maybe(number: Option<f64>) -> Self {
        number.map_or(Self::Absent, Self::Number)
    }

    /// As JSON, numbers with all their digits.
    #[must_use]
    pub fn json(&self) -> Value {
        match self {
            Self::Text(text) => json!(text),
            Self::Number(number) => json!(number),
            Self::Count(count) => json!(count),
            Self::Flag(flag) => json!(flag),
            Self::Absent => Value::Null,
        }
    }
}

/// For a person: three significant digits.
impl std::fmt::Display for Cell {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Text(text) => f.pad(text),
            Self::Number(0.0) => f.pad("0"),
            Self::Number(number) if (1e-3..1e5).contains(&number.abs()) => {
                let digits = [1e2, 1e1, 1.0, 1e-1, 1e-2].iter().filter(|&&power| number.abs() < power).count();
                f.pad(&format!("{number:.digits$}"))
            }
            Self::Number(number) => f.pad(&format!("{number:.2e}")),
            Self::Count(count) => f.pad(&count.to_string()),
            Self::Flag(true) => f.pad("yes"),
            Self::Flag(false) => f.pad("NO"),
            Self::Absent => f.pad("–"),
        }
    }
}

/// A row of a report.
pub trait BenchmarkRow {
    /// Names of the columns: the keys in JSON, the head of the table.
    const COLUMNS: &'static [&'static str];

    /// What stands in them, in the same order.
    fn cells(&self) -> Vec<Cell>;
}

/// Courses of fits, by the name of their method.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BenchmarkCurves {
    /// Elapsed ms, objective ΔE and distance to the truth along one fit.
    pub fits: Vec<(BenchmarkMethod, Vec<[f64; 3]>)>,
    /// The same along one fit of each model.
    pub models: Vec<(BenchmarkMethod, Vec<[f64; 3]>)>,
    /// Dolan and Moré's performance profiles: time over that of the fastest method, share of problems solved.
    pub profiles: Vec<(BenchmarkMethod, Vec<[f64; 2]>)>,
}

/// What was found out, where, and when.
#[derive(Debug, Clone, PartialEq)]
pub struct Report<R> {
    /// What it is about.
    pub title: &'static str,
    /// The machine that the times were taken on.
    pub machine: Machine,
    /// When, as ISO 8601 in UTC.
    pub date: String,
    /// What was found out.
    pub rows: Vec<R>,
    /// How to read it: paragraphs under the table.
    pub notes: Vec<Note>,
    /// Courses of the fits that were compared; empty where none were.
    pub curves: BenchmarkCurves,
    /// What else belongs into the file beside the rows, such as curves.
    pub further: Map<String, Value>,
}

impl<R> Report<R> {
    /// A report without curves.
    #[must_use]
    pub fn new(title: &'static str, machine: Machine, date: String, rows: Vec<R>, notes: Vec<Note>) -> Self {
        Self { title, machine, date, rows, notes, curves: BenchmarkCurves::default(), further: Map::new() }
    }
}

impl<R: BenchmarkRow> Report<R> {
    /// As JSON: `machine`, `date` and `rows`, flat objects with the columns of the table.
    #[must_use]
    pub fn json(&self) -> Value {
        let of = |row: &R| {
            let cells = row.cells();
            Value::Object(R::COLUMNS.iter().zip(&cells).map(|(&column, cell)| (column.to_owned(), cell.json())).collect::<Map<_, _>>())
        };
        json!({ "machine": self.machine.to_string(), "date": self.date, "rows": self.rows.iter().map(of).collect::<Vec<_>>() })
    }

    /// The same with what else belongs into the file.
    #[must_use]
    pub fn json_with_curves(&self) -> Value {
        let mut json = self.json();
        if let Some(object) = json.as_object_mut() {
            object.extend(self.further.clone());
        }
        json
    }

    /// As Markdown: a heading, where and when, the table, the notes.
    #[must_use]
    pub fn markdown(&self) -> String {
        let rows: Vec<Vec<String>> =
            self.rows.iter().map(|row| row.cells().iter().map(|cell| cell.to_string().replace('|', "\\|")).collect()).collect();
        let widths: Vec<usize> = R::COLUMNS
            .iter()
            .enumerate()
            .map(|(j, column)| rows.iter().map(|row| row[j].chars().count()).fold(column.chars().count(), usize::max))
            .collect();
        let mut text = format!("# {}\n\n{}, {}\n\n", self.title, self.machine, self.date);
        let mut line = |cells: &mut dyn Iterator<Item = &str>| {
            for (cell, width) in cells.zip(&widths) {
                // Writing to a String cannot fail.
                let _ = write!(text, "| {cell:<width$} ");
            }
            text.push_str("|\n");
        };
        line(&mut R::COLUMNS.iter().copied());
        let rules: Vec<String> = widths.iter().map(|&width| "-".repeat(width)).collect();
        line(&mut rules.iter().map(String::as_str));
        for row in &rows {
            line(&mut row.iter().map(String::as_str));
        }
        for note in &self.notes {
            text.push('\n');
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{note}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::{BenchmarkRow, Cell, Machine, Note, Report};

    struct Pair(f64, bool);

    impl BenchmarkRow for Pair {
        const COLUMNS: &'static [&'static str] = &["number", "flag"];

        fn cells(&self) -> Vec<Cell> {
            vec![Cell::Number(self.0), Cell::Flag(self.1)]
        }
    }

    fn report(rows: Vec<Pair>) -> Report<Pair> {
        Report::new("Pairs", Machine::new("", 1), "2026-11-25T00:00:00Z".to_owned(), rows, vec![Note::CostInstructions])
    }

    #[test]
    fn json_has_the_columns_of_the_table_as_keys_and_null_for_what_is_not_finite() {
        let json = report(vec![Pair(0.1, true), Pair(f64::INFINITY, false)]).json();
        assert_eq!(json["rows"], serde_json::json!([{ "number": 0.1, "flag": true }, { "number": null, "flag": false }]));
        assert!(json["machine"].is_string() && json["date"].is_string());
    }

    #[test]
    fn markdown_lines_are_as_wide_as_each_other() {
        let text = report(vec![Pair(0.1, true), Pair(1.0 / 3.0e7, false)]).markdown();
        let table: Vec<usize> = text.lines().filter(|line| line.starts_with('|')).map(|line| line.chars().count()).collect();
        assert_eq!(table.len(), 4, "{text}");
        assert!(table.iter().all(|&width| width == table[0]), "{text}");
        assert!(text.ends_with("at the top of core/benches/cost.rs.\n"), "{text}");
    }

    #[test]
    fn numbers_for_people_have_three_digits() {
        let shown = [0.0, 0.001_234_5, 0.5, 12.345, 1234.5, 1.0e-14, f64::INFINITY].map(|number| Cell::Number(number).to_string());
        assert_eq!(shown, ["0", "0.00123", "0.500", "12.3", "1234", "1.00e-14", "inf"]);
    }
}
