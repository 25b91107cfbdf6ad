//! Foreign tables: all stages, from bytes to measurements.

use super::assembly::Assembly;
use super::dialect::{Decimal, Dialect};
use super::dialect_guess::cells_of;
use super::doubt::Doubt;
use super::encoding::decode;
use super::grid::CellGrid;
use super::layout::{ROWS_PER_REPORT, RowKind, TableLayout, report};
use super::number::ReadCell;
use super::options::TableOptions;
use super::other_format::OtherFormat;
use super::plan::Plan;
use super::planned_column::PlannedColumn;
use super::row_reader::ForeignRowReader;
use super::title::{key_and_value, strip_mark};
use crate::measurement::formats::{ImportError, Imported};
use crate::measurement::{Field, ImportNote, LineList, Progress, ReadError, Unit, unwatched};

/// A foreign table in memory, its regions found.
#[derive(Debug, Clone)]
pub struct LabTable {
    grid: CellGrid,
    layout: TableLayout,
    /// The encoding of a text, or the sheet of a workbook.
    source: String,
    /// Of a workbook: the sheet, and all of them.
    sheets: Option<(String, Vec<String>)>,
}

/// What a foreign table is taken for.
#[derive(Debug, Clone)]
pub struct TableGuess {
    /// The encoding of a text, or the sheet of a workbook.
    pub source: String,
    /// How cells are separated and numbers are written.
    pub dialect: Dialect,
    /// The columns under each header: one list, or one for each block.
    pub columns: Vec<Vec<PlannedColumn>>,
    /// Angle of incidence of all rows in degrees, where a text says it.
    pub theta_i: Option<f64>,
    /// What is open.
    pub doubts: Vec<Doubt>,
}

/// A row with its place, for a preview.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownRow {
    /// Line of the file, from 1.
    pub line: u64,
    /// What the row is.
    pub kind: RowKind,
    /// Its cells.
    pub cells: Vec<String>,
}

/// Rows of a section that are looked at for what its values tell.
const SAMPLE: usize = 4000;

impl LabTable {
    /// The table of a text, or of a sheet of a workbook; of the options the sheet and the thousands
    /// separator count.
    ///
    /// # Errors
    /// The file is of another form, or holds no rows of numbers, NUL bytes or an endless cell; there
    /// is no such sheet; or `progress` stops the reading.
    pub fn open(bytes: Vec<u8>, options: &TableOptions, progress: Progress<'_>) -> Result<Self, ImportError> {
        if is_workbook(&bytes) {
            return Self::of_workbook(bytes, options, progress);
        }
        if let Some(other) = OtherFormat::of(&bytes).filter(|_| options.columns.is_none()) {
            return Err(ImportError::OtherFormat(other));
        }
        let decoded = decode(bytes)?;
        Ok(Self::new(cells_of(decoded.text, options.thousands)?, decoded.encoding.to_owned(), progress)?)
    }

    #[cfg(feature = "workbooks")]
    fn of_workbook(bytes: Vec<u8>, options: &TableOptions, progress: Progress<'_>) -> Result<Self, ImportError> {
        let (grid, sheet, names) = super::workbook::sheet_of(bytes, options.sheet.as_deref(), options.thousands, progress)?;
        match Self::new(grid, format!("sheet {sheet}"), progress) {
            Ok(table) => Ok(Self { sheets: Some((sheet, names)), ..table }),
            Err(ReadError { kind: crate::measurement::ReadErrorKind::NoNumbers, .. }) if names.len() > 1 && options.sheet.is_none() => {
                Err(ImportError::NoSheet { wanted: String::new(), names })
            }
            Err(error) => Err(error.into()),
        }
    }

    #[cfg(not(feature = "workbooks"))]
    fn of_workbook(_: Vec<u8>, _: &TableOptions, _: Progress<'_>) -> Result<Self, ImportError> {
        let advice = "save the sheet as CSV";
        Err(ImportError::OtherFormat(OtherFormat { name: "a workbook", advice, options: None }))
    }

    /// Cells, and where they come from.
    ///
    /// # Errors
    /// No row holds numbers, or `progress` stops the reading.
    fn new(grid: CellGrid, source: String, progress: Progress<'_>) -> Result<Self, ReadError> {
        let layout = TableLayout::new(&grid, progress)?;
        Ok(Self { grid, layout, source, sheets: None })
    }

    /// The sheet of a workbook that this is, and all of them in their order; none of a text.
    #[must_use]
    pub fn sheets(&self) -> Option<(&str, &[String])> {
        self.sheets.as_ref().map(|(sheet, all)| (&**sheet, &**all))
    }

    /// Number of rows of data.
    #[must_use]
    pub fn data_rows(&self) -> usize {
        self.layout.kinds.iter().filter(|kind| **kind == RowKind::Data).count()
    }

    /// The first rows with their kinds.
    #[must_use]
    pub fn first_rows(&self, count: usize) -> Vec<ShownRow> {
        let mut cells = Vec::new();
        let rows = (0..self.grid.len().min(count)).map(|row| {
            self.grid.cells(row, &mut cells);
            let cells = cells.iter().map(|cell| crate::measurement::quote(cell)).collect();
            ShownRow { line: self.grid.line(row), kind: self.layout.kinds[row], cells }
        });
        rows.collect()
    }

    /// What the columns are taken for, and what is open.
    ///
    /// # Errors
    /// The options name a column that is not there.
    pub fn guess(&self, options: &TableOptions) -> Result<TableGuess, ReadError> {
        let plans = self.plans(options)?;
        let mut columns: Vec<Vec<PlannedColumn>> = Vec::new();
        let mut doubts: Vec<Doubt> = Vec::new();
        for plan in &plans {
            if !columns.contains(&plan.columns) {
                columns.push(plan.columns.clone());
            }
            let new = plan.doubts.iter().filter(|doubt| !doubts.contains(doubt)).cloned().collect::<Vec<_>>();
            doubts.extend(new);
        }
        let theta_i = plans.first().and_then(|plan| plan.theta_i).filter(|_| plans.len() == 1);
        Ok(TableGuess { source: self.source.clone(), dialect: self.grid.dialect(), columns, theta_i, doubts })
    }

    fn plans(&self, options: &TableOptions) -> Result<Vec<Plan>, ReadError> {
        let plans = self.layout.sections.iter().map(|section| {
            let mut plan = Plan::new(section, self.layout.width, options)?;
            self.look_at_values(&mut plan, section.rows.clone());
            Ok(plan)
        });
        plans.collect()
    }

    /// What the values tell where the heading does not: percent, and divided Mueller elements.
    fn look_at_values(&self, plan: &mut Plan, rows: std::ops::Range<usize>) {
        let is_open = |column: &PlannedColumn| column.field == Some(Field::Dolp) && column.unit == Unit::Native && !column.states_unit;
        let open: Vec<usize> = (0..plan.columns.len()).filter(|&index| is_open(&plan.columns[index])).collect();
        if open.is_empty() && plan.is_normalised.is_some() {
            return;
        }
        let (mut above, mut below, mut excess, mut whole) = (0, 0, 0, 0);
        let mut cells = Vec::new();
        let step = (rows.len() / SAMPLE).max(1);
        for row in rows.step_by(step).filter(|&row| self.layout.kinds[row] == RowKind::Data) {
            self.grid.cells(row, &mut cells);
            let number = |index: usize| match cells.get(index).map(|cell| ReadCell::new(cell, self.grid.dialect())) {
                Some(ReadCell::Number(number, None)) => Some(number),
                _ => None,
            };
            for number in open.iter().filter_map(|&index| number(index)) {
                above += usize::from(number > 1.0 && number <= 100.0);
                below += usize::from(number <= 1.0);
            }
            if let Some(first) = plan.mueller.first().and_then(|&first| number(first)) {
                let most = plan.mueller[1..].iter().filter_map(|&index| number(index)).fold(0.0, |most: f64, value| most.max(value.abs()));
                // No element of a Mueller matrix exceeds the first; 1 % for noise.
                excess += usize::from(most > 1.01 * first);
                whole += 1;
            }
        }
        if above > below {
            // A standard deviation without a unit follows its value.
            for column in &mut plan.columns {
                if matches!(column.field, Some(Field::Dolp | Field::DolpSigma)) && !column.states_unit {
                    column.unit = Unit::Percent;
                }
            }
        }
        let seen = plan.is_normalised.unwrap_or(2 * excess > whole);
        plan.is_normalised = Some(seen);
    }

    /// The measurements of the table.
    ///
    /// # Errors
    /// Something is open, a cell does not hold what its column means, or `progress` stops the
    /// reading.
    pub fn read(&self, options: &TableOptions, progress: Progress<'_>) -> Result<Imported, ImportError> {
        self.read_rows(options, usize::MAX, progress)
    }

    /// The measurements of the first rows of data, without delay.
    ///
    /// # Errors
    /// As of [`LabTable::read`].
    pub fn preview(&self, options: &TableOptions, count: usize) -> Result<Imported, ImportError> {
        self.read_rows(options, count, &mut unwatched)
    }

    fn read_rows(&self, options: &TableOptions, most: usize, progress: Progress<'_>) -> Result<Imported, ImportError> {
        let plans = self.plans(options)?;
        let mut doubts: Vec<Doubt> = plans.iter().flat_map(|plan| plan.doubts.clone()).collect();
        doubts.dedup();
        if !doubts.is_empty() {
            return Err(ImportError::Undecided { doubts });
        }
        let mut assembly = Assembly::new(options.clone(), self.titled_sets());
        let mut cells = Vec::new();
        let mut done = 0;
        for (index, (section, plan)) in self.layout.sections.iter().zip(&plans).enumerate() {
            assembly.add_plan(plan);
            let titled = assembly.titled_set(index);
            let mut reader = ForeignRowReader::new(&self.grid, plan, plan.is_normalised == Some(true), self.layout.fills_down);
            for row in section.rows.clone().filter(|&row| self.layout.kinds[row] == RowKind::Data) {
                if done == most {
                    break;
                }
                if done % ROWS_PER_REPORT == 0 {
                    report(&mut |share| progress(0.4 + share), 0.6, row, self.grid.len())?;
                }
                done += 1;
                self.grid.cells(row, &mut cells);
                let set = reader.set(&cells).map_or(titled, |name| assembly.set_named(name));
                reader.read(row, &cells, set, &mut assembly.rows)?;
            }
        }
        let mut imported = assembly.finish(&self.metadata())?;
        let used = |index: usize| plans.iter().any(|plan| plan.columns.get(index).is_some_and(|column| column.field.is_some()));
        let unused: Vec<String> =
            plans[0].columns.iter().enumerate().filter(|(index, _)| !used(*index)).map(|(_, column)| column.name.clone()).collect();
        if !unused.is_empty() {
            imported.notes.push(ImportNote::IgnoredColumns { names: unused });
        }
        let mut skipped = LineList::default();
        (0..self.grid.len()).filter(|&row| self.layout.kinds[row] == RowKind::Skipped).for_each(|row| skipped.push(self.grid.line(row)));
        if skipped.count > 0 {
            imported.notes.push(ImportNote::SkippedLines(skipped));
        }
        if self.layout.fills_down {
            imported.notes.push(ImportNote::FilledDown);
        }
        Ok(imported)
    }

    /// The name that the title of each section gives, where the sections differ in it.
    fn titled_sets(&self) -> Vec<Option<String>> {
        let sets: Vec<Option<String>> = self.layout.sections.iter().map(|section| section.title.set.clone()).collect();
        if sets.windows(2).any(|pair| pair[0] != pair[1]) { sets } else { vec![None; sets.len()] }
    }

    /// `key: value` lines above the data and remarks anywhere.
    fn metadata(&self) -> Vec<(String, String)> {
        let first = self.layout.sections.first().map_or(0, |section| section.rows.start);
        let is_told = |row: usize| match self.layout.kinds[row] {
            RowKind::Remark => true,
            RowKind::Title => row < first,
            _ => false,
        };
        let plain = |text: &str| text.trim().replace(char::is_control, " ");
        let mut metadata = Vec::new();
        for row in (0..self.grid.len()).filter(|&row| is_told(row)).take(200) {
            let text = strip_mark(self.grid.text(row)).trim_end_matches([';', ',', '\t']);
            if !text.contains(char::is_alphanumeric) || text.len() > 1000 || text.starts_with("sep=") {
                continue;
            }
            metadata.push(match key_and_value(text) {
                Some((key, value)) if !key.contains(':') => (plain(key), plain(value)),
                _ => ("comment".to_owned(), plain(text)),
            });
        }
        // The wavelength of each measurement is told apart.
        metadata.retain(|(key, _)| key != "wavelength_nm");
        metadata
    }
}

/// Whether bytes are a workbook: packed XML, or the older form of Excel.
#[must_use]
pub fn is_workbook(bytes: &[u8]) -> bool {
    let has = |name: &[u8]| bytes.windows(name.len()).any(|window| window == name);
    bytes.starts_with(&[0xd0, 0xcf, 0x11, 0xe0]) || bytes.starts_with(b"PK\x03\x04") && (has(b"xl/") || has(b"opendocument.spreadsheet"))
}

/// The guess as the command line prints it: one line a column.
impl std::fmt::Display for TableGuess {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.source)?;
        if self.dialect.decimal == Decimal::Comma || !self.dialect.to_string().starts_with("cells") {
            write!(f, ", {}", self.dialect)?;
        }
        for (block, columns) in self.columns.iter().enumerate() {
            if self.columns.len() > 1 {
                write!(f, "\nblock {}:", block + 1)?;
            }
            for (index, column) in columns.iter().enumerate() {
                let is_numbered = column.name == (index + 1).to_string() || column.name.is_empty();
                let name = if is_numbered { String::new() } else { format!(" ({})", crate::measurement::quote(&column.name)) };
                write!(f, "\ncolumn {}{name}: {}", index + 1, column.description())?;
            }
        }
        if let Some(theta_i) = self.theta_i {
            write!(f, "\ntheta_i = {theta_i} degrees in every row")?;
        }
        Ok(())
    }
}
