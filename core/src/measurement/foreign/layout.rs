//! Stage 3 of a foreign table: rows to regions.
//!
//! A row is data if most of its cells are numbers, in the columns that hold numbers in most such
//! rows. What stands before a run of data is its preamble: titles, a header, a row of units.

use super::dialect::Separator;
use super::grid::{CellGrid, split};
use super::heading::ColumnHeading;
use super::heading_meaning::Meaning;
use super::number::ReadCell;
use super::title::{Title, strip_mark};
use super::vocabulary::measure;
use crate::measurement::{Progress, ReadError, ReadErrorKind, is_not_measured};
use std::ops::Range;

/// What a row is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// Nothing in any cell.
    Blank,
    /// A remark, of which metadata are made.
    Remark,
    /// Says where the rows below were measured.
    Title,
    /// Names of columns.
    Header,
    /// Units of columns.
    Units,
    /// Numbers.
    Data,
    /// A line that is neither, such as a mean: left out with a notice.
    Skipped,
}

/// Rows of data under one header.
#[derive(Debug, Clone, Default)]
pub(crate) struct Section {
    /// Names of the columns; empty without a header.
    pub(crate) header: Vec<String>,
    /// Line of the header, from 1.
    pub(crate) header_line: Option<u64>,
    /// Units of the columns; empty without such a row.
    pub(crate) units: Vec<String>,
    /// What its titles say, this section's or, where it has none, that of the one before.
    pub(crate) title: Title,
    pub(crate) rows: Range<usize>,
}

/// The regions of a table.
#[derive(Debug, Clone, Default)]
pub(crate) struct TableLayout {
    pub(crate) kinds: Vec<RowKind>,
    pub(crate) sections: Vec<Section>,
    /// Number of columns of most rows of data.
    pub(crate) width: usize,
    /// Whether the first column of numbers is filled in the first row of each group alone.
    pub(crate) fills_down: bool,
}

/// Rows between two reports of progress.
pub(crate) const ROWS_PER_REPORT: usize = 4096;
/// Rows above data that are looked at for a header.
const HEADER_REACH: usize = 60;

/// Counts of a column over rows that look like data.
#[derive(Clone, Copy, Default)]
struct ColumnCount {
    numbers: usize,
    texts: usize,
    missing: usize,
}

impl TableLayout {
    /// The regions of a grid.
    ///
    /// # Errors
    /// No row looks like data, or `progress` stops the reading.
    pub(crate) fn new(grid: &CellGrid, progress: Progress<'_>) -> Result<Self, ReadError> {
        let mut layout = Self { kinds: vec![RowKind::Blank; grid.len()], ..Self::default() };
        let mut lengths: Vec<usize> = Vec::new();
        let mut columns: Vec<ColumnCount> = Vec::new();
        let mut cells = Vec::new();
        for row in 0..grid.len() {
            if row % ROWS_PER_REPORT == 0 {
                report(progress, 0.4, row, grid.len())?;
            }
            grid.cells(row, &mut cells);
            layout.kinds[row] = first_kind(grid, row, &cells, &mut columns);
            if layout.kinds[row] == RowKind::Data {
                let length = filled(&cells);
                lengths.resize(lengths.len().max(length + 1), 0);
                lengths[length] += 1;
            }
        }
        layout.width = (0..lengths.len()).max_by_key(|&length| lengths[length]).ok_or_else(|| ReadErrorKind::NoNumbers.anywhere())?;
        layout.sort_out(grid, &columns);
        layout.find_sections(grid);
        if layout.sections.is_empty() { Err(ReadErrorKind::NoNumbers.anywhere()) } else { Ok(layout) }
    }

    /// Takes rows for data only where the first column of numbers holds one.
    fn sort_out(&mut self, grid: &CellGrid, columns: &[ColumnCount]) {
        let is_numeric = |count: &&ColumnCount| count.numbers > 0 && count.numbers >= count.texts;
        let Some(first) = columns.iter().position(|count| is_numeric(&count)) else { return };
        // Cells of a spreadsheet that were merged: the angle stands in the first row of its group.
        self.fills_down = columns[first].missing > columns[first].numbers && columns.get(first + 1).is_some_and(|next| is_numeric(&next));
        let (mut cells, mut has_data) = (Vec::new(), false);
        for row in 0..grid.len() {
            if self.kinds[row] == RowKind::Data {
                grid.cells(row, &mut cells);
                let cell = cells.get(first).map_or(ReadCell::Missing, |cell| ReadCell::new(cell, grid.dialect()));
                // A value that was not measured may stand first, a mean alone does not.
                let numbers = || cells.iter().filter(|cell| ReadCell::new(cell, grid.dialect()).is_number()).count();
                // The corner of a wide table is often empty.
                let is_corner = cell == ReadCell::Missing && !has_data;
                let is_data = cell.is_number() || cell == ReadCell::Missing && numbers() >= 2 && !is_corner;
                has_data |= is_data;
                if !is_data && !is_damaged(cell, &cells, self.width) {
                    self.kinds[row] = RowKind::Skipped;
                }
            }
        }
    }

    fn find_sections(&mut self, grid: &CellGrid) {
        let mut row = 0;
        let mut gap = 0..0;
        while row < grid.len() {
            if self.kinds[row] != RowKind::Data {
                row += 1;
                continue;
            }
            gap.end = row;
            let end = (row..grid.len()).find(|&next| self.kinds[next] != RowKind::Data).unwrap_or(grid.len());
            self.add_run(grid, gap.clone(), row..end);
            gap = end..end;
            row = end;
        }
    }

    /// A run of data below a gap: a section of its own where the gap has a header or a title.
    fn add_run(&mut self, grid: &CellGrid, gap: Range<usize>, run: Range<usize>) {
        let mut cells = Vec::new();
        grid.cells(run.start, &mut cells);
        let width = if filled(&cells) > self.width { filled(&cells) } else { self.width };
        let is_first = self.sections.is_empty();
        let header = header_of(grid, gap.clone(), width, &self.kinds);
        let mut section = Section { rows: run.clone(), ..Section::default() };
        if let Some((at, names)) = header {
            self.kinds[at] = RowKind::Header;
            section.header = names;
            section.header_line = Some(grid.line(at));
            if let Some((at, units)) = units_of(grid, at + 1..gap.end, width) {
                self.kinds[at] = RowKind::Units;
                section.units = units;
            }
            section.join_upper_header(grid, at, gap.start, &mut self.kinds);
        }
        let has_header = !section.header.is_empty();
        for row in gap.clone() {
            if matches!(self.kinds[row], RowKind::Skipped | RowKind::Remark) {
                let title = Title::new(strip_mark(grid.text(row)), grid.dialect());
                if title.says_where() {
                    self.kinds[row] = RowKind::Title;
                    section.title.add(title);
                    continue;
                }
                section.title.quantity = title.quantity.or(section.title.quantity);
                if is_first {
                    self.kinds[row] = RowKind::Remark;
                }
            }
        }
        match self.sections.last_mut() {
            Some(last) if !has_header && !section.title.says_where() => last.rows.end = run.end,
            Some(last) => {
                if !has_header {
                    section.header.clone_from(&last.header);
                    section.header_line = last.header_line;
                    section.units.clone_from(&last.units);
                }
                section.title.inherit(&last.title);
                self.sections.push(section);
            }
            None => self.sections.push(section),
        }
    }
}

impl Section {
    /// Joins names such as `AOI 30` that stand above several columns to the names below, where these
    /// alone don't tell the columns apart.
    fn join_upper_header(&mut self, grid: &CellGrid, header: usize, top: usize, kinds: &mut [RowKind]) {
        let mut seen = Vec::new();
        let repeats = self.header.iter().map(|name| ColumnHeading::new(name)).any(|heading| match heading.meaning {
            Meaning::Field(field) if field.is_measured() => {
                let is_seen = seen.contains(&(field, heading.at.bare, heading.at.theta_i, heading.at.wavelength_nm));
                seen.push((field, heading.at.bare, heading.at.theta_i, heading.at.wavelength_nm));
                is_seen
            }
            _ => false,
        });
        let Some(upper) = (top..header).rev().find(|&row| kinds[row] != RowKind::Blank).filter(|_| repeats) else { return };
        let mut cells = Vec::new();
        grid.cells(upper, &mut cells);
        if filled(&cells) < 2 || cells.len() > self.header.len() {
            return;
        }
        let mut above = "";
        for (index, name) in self.header.iter_mut().enumerate() {
            above = cells.get(index).copied().filter(|cell| !cell.is_empty()).unwrap_or(above);
            let is_measured = matches!(ColumnHeading::new(name).meaning, Meaning::Field(field) if field.is_measured())
                || matches!(ColumnHeading::new(name).meaning, Meaning::Sigma | Meaning::Value);
            if is_measured && !above.is_empty() {
                *name = format!("{above} {name}");
            }
        }
        kinds[upper] = RowKind::Header;
    }
}

/// Tells progress up to a share of all.
pub(crate) fn report(progress: Progress<'_>, share: f64, done: usize, all: usize) -> Result<(), ReadError> {
    #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress bar")]
    let fraction = share * done as f64 / all.max(1) as f64;
    if progress(fraction).is_break() { Err(ReadErrorKind::Cancelled.anywhere()) } else { Ok(()) }
}

/// Number of cells up to the last that is filled.
fn filled(cells: &[&str]) -> usize {
    cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1)
}

/// Whether a cell looks like a number with a typing error in a row that is complete otherwise: a fault
/// to be told, not a line to be skipped.
fn is_damaged(cell: ReadCell<'_>, cells: &[&str], width: usize) -> bool {
    matches!(cell, ReadCell::Text(text) if text.starts_with(|first: char| first.is_ascii_digit()) && filled(cells) == width && width > 2)
        && measure(cells[0].trim_start_matches(|digit: char| digit.is_ascii_digit())).is_none()
}

/// What a row is at first sight; rows that look like data are counted by column.
fn first_kind(grid: &CellGrid, row: usize, cells: &[&str], columns: &mut Vec<ColumnCount>) -> RowKind {
    if filled(cells) == 0 || cells.iter().all(|cell| cell.chars().all(|letter| "-=_+:*".contains(letter))) {
        return RowKind::Blank;
    }
    let text = grid.text(row);
    let is_marked = strip_mark(text).len() < text.trim().len() && !is_not_measured(cells[0]);
    if is_marked && !(text.trim_start().starts_with(';') && is_semicolon(grid)) {
        return RowKind::Remark;
    }
    let (mut numbers, mut texts) = (0, 0);
    let kinds: Vec<ReadCell<'_>> = cells.iter().map(|cell| ReadCell::new(cell, grid.dialect())).collect();
    for kind in &kinds {
        numbers += usize::from(kind.is_number());
        texts += usize::from(matches!(kind, ReadCell::Text(_)));
    }
    if numbers == 0 || numbers + usize::from(kinds.contains(&ReadCell::Missing)) < 2 || texts > numbers + 1 {
        return RowKind::Skipped;
    }
    if columns.len() < kinds.len() {
        columns.resize(kinds.len(), ColumnCount::default());
    }
    for (count, kind) in columns.iter_mut().zip(&kinds) {
        match kind {
            ReadCell::Number(..) => count.numbers += 1,
            ReadCell::Text(_) => count.texts += 1,
            ReadCell::Missing => count.missing += 1,
        }
    }
    RowKind::Data
}

fn is_semicolon(grid: &CellGrid) -> bool {
    grid.dialect().separator == Separator::Character(';')
}

/// The row of a gap that names columns best, and the names.
fn header_of(grid: &CellGrid, gap: Range<usize>, width: usize, kinds: &[RowKind]) -> Option<(usize, Vec<String>)> {
    let mut best: Option<(usize, usize, Vec<String>)> = None;
    for row in gap.clone().rev().filter(|&row| kinds[row] != RowKind::Blank).take(HEADER_REACH) {
        for names in names_of(grid, row, width) {
            let score = header_score(&names, width, grid.dialect().separator);
            if score > 0 && best.as_ref().is_none_or(|(most, ..)| score > *most) {
                best = Some((score, row, names));
            }
        }
    }
    best.map(|(_, row, names)| (row, names))
}

/// The ways in which a row may be cut into names for that many columns.
fn names_of(grid: &CellGrid, row: usize, width: usize) -> Vec<Vec<String>> {
    let text = grid.text(row);
    if text.len() > 1 << 16 {
        return Vec::new();
    }
    let separator = grid.dialect().separator;
    let mut ways = Vec::new();
    let stripped = strip_mark(text);
    let own = |text: &str, separator| {
        let mut cells = Vec::new();
        split(text, separator, &mut cells);
        cells.truncate(filled(&cells).max(1));
        cells.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    for text in [text, stripped] {
        ways.push(own(text, separator));
    }
    // The header of numpy's savetxt may have a separator of its own.
    if ways.iter().all(|names| names.len() != width) {
        let others = [Separator::Character('\t'), Separator::Character(';'), Separator::Character(','), Separator::Blanks { least: 2 }];
        ways.extend(others.iter().map(|&other| own(stripped, other)).filter(|names| names.len() == width));
        if matches!(separator, Separator::Blanks { .. }) {
            ways.extend(joined(&own(stripped, Separator::Blanks { least: 1 }), width));
        }
    }
    ways
}

/// Words of a header joined to that many names: a unit belongs to the word before, and of the ways to
/// join the rest the one with most names that mean something is taken.
fn joined(words: &[String], width: usize) -> Option<Vec<String>> {
    let mut names: Vec<String> = Vec::new();
    for word in words {
        let is_unit = word.starts_with(['(', '[', '/']) || measure(word).is_some_and(|_| !word.chars().all(char::is_alphabetic));
        match names.last_mut() {
            Some(last) if is_unit || word == "=" || last.ends_with('/') => *last = format!("{last} {word}"),
            _ => names.push(word.clone()),
        }
    }
    if names.len() > 24 || width == 0 {
        return None;
    }
    while names.len() > width {
        let worth = |names: &[String]| names.iter().filter(|name| ColumnHeading::new(name).score > 0).count();
        let join = |at: usize| {
            let mut joined = names.clone();
            let next = joined.remove(at + 1);
            joined[at] = format!("{} {next}", joined[at]);
            joined
        };
        names = (0..names.len() - 1).map(join).max_by_key(|names| worth(names))?;
    }
    (names.len() == width).then_some(names)
}

/// How well cells name that many columns; 0 where they do not.
fn header_score(names: &[String], width: usize, separator: Separator) -> usize {
    let headings: Vec<ColumnHeading> = names.iter().map(|name| ColumnHeading::new(name)).collect();
    let known = headings.iter().filter(|heading| heading.meaning != Meaning::Unknown).count();
    let placed = headings.iter().filter(|heading| heading.meaning == Meaning::Unknown && !heading.at.is_anywhere()).count();
    // `AOI; 30` and `Date: 3 May` are a key and a value.
    let is_pair = names.len() == 2 && (placed == 1 && known <= 1 || names[0].ends_with(':'));
    // Words that blanks part are no names where there are more of them than columns.
    let most = if matches!(separator, Separator::Blanks { .. }) { width } else { width + 2 };
    let is_long = names.iter().any(|name| name.len() > 60);
    let are_words = names.len() == width && names.iter().all(|name| name.starts_with(char::is_alphabetic) && name.len() <= 40);
    if known + placed == 0 && are_words && width > 2 {
        // Names that mean nothing here are names.
        return 1;
    }
    if known + placed == 0 || names.len() < 2 || is_pair || is_long || names.len() > most {
        return 0;
    }
    let fits = names.len() == width;
    if fits || known >= 2 && names.len() + 2 >= width { 3 * known + 2 * placed + 4 * usize::from(fits) } else { 0 }
}

/// The row of units among the rows between header and data.
fn units_of(grid: &CellGrid, rows: Range<usize>, width: usize) -> Option<(usize, Vec<String>)> {
    for row in rows {
        for names in names_of(grid, row, width) {
            let filled = names.iter().filter(|name| !name.is_empty()).count();
            if filled > 0 && names.len() <= width && names.iter().all(|name| name.is_empty() || measure(name).is_some()) {
                return Some((row, names));
            }
        }
    }
    None
}
