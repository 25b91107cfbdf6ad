//! The table of `fit --batch`: rows are appended as they come, so that a run that was killed goes on where it was; at the end they stand in
//! the order of the files.
//!
//! Above the header, comment lines hold the program and the options: rows of other options are not mixed in. The rows of a file
//! are written at once, and the file counts as done where all of them are there and its content is still the same.

use crate::cli::failure::Failure;
use crate::files::write_file::write_file;
use std::collections::HashMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

/// What every row begins with: the file, how many measurements it holds, which of them this is, and a hash of the file's bytes.
pub const KEYS: [&str; 4] = ["file", "sets", "set", "sha256"];

/// The rows of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileRows {
    /// Cells of each row, those of [`KEYS`] first.
    pub rows: Vec<Vec<String>>,
}

impl FileRows {
    fn key(&self, index: usize) -> &str {
        self.rows.first().and_then(|row| row.get(index)).map_or("", String::as_str)
    }

    /// The file.
    pub fn file(&self) -> &str {
        self.key(0)
    }

    /// The hash of its bytes; empty where it could not be read.
    pub fn hash(&self) -> &str {
        self.key(3)
    }

    /// Whether every measurement of the file has its row.
    fn is_complete(&self) -> bool {
        self.key(1).parse() == Ok(self.rows.len())
    }

    /// Whether the row is a sentence why there is no fit.
    pub fn failures(&self) -> usize {
        self.rows.iter().filter(|row| row.last().is_some_and(|error| !error.is_empty())).count()
    }
}

/// A table that grows.
pub struct BatchTable {
    path: PathBuf,
    /// Comment lines and header.
    head: String,
    file: File,
    /// What is done, in the order in which it was written; the latest rows of a file count.
    done: Vec<FileRows>,
    /// Where each file stands in `done`.
    places: HashMap<String, usize>,
}

impl BatchTable {
    /// Opens the table, with the rows of an earlier run.
    ///
    /// # Errors
    ///
    /// A failure where the file holds something else, rows of other options, or is being written by another process.
    pub fn open(path: &Path, comments: &[(&str, String)], columns: &[String]) -> Result<Self, Failure> {
        let denied = |error: &io::Error| Failure::output(path.display(), error);
        let file = OpenOptions::new().read(true).append(true).create(true).open(path).map_err(|error| denied(&error))?;
        if !file.metadata().is_ok_and(|metadata| metadata.is_file()) {
            let reason = format!("{} is no file; --batch goes on where it was, and needs one.", path.display());
            return Err(Failure::usage(reason));
        }
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(Failure::usage(format!("{} is being written by another run of --batch.", path.display())));
        }
        let head = comments.iter().map(|(key, value)| format!("# {key}: {value}\n")).collect::<String>() + &line(columns);
        let bytes = std::fs::read(path).map_err(|error| denied(&error))?;
        let mut table = Self { path: path.to_owned(), head, file, done: Vec::new(), places: HashMap::new() };
        // A line without an end was being written when the run was killed.
        let complete = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        if table.head.as_bytes().starts_with(&bytes[..complete]) && complete < table.head.len() {
            table.file.set_len(0).and_then(|()| table.append_text(&table.head.clone())).map_err(|error| denied(&error))?;
            return Ok(table);
        }
        let text = std::str::from_utf8(&bytes[..complete]).ok();
        let Some(rows) = text.and_then(|text| text.strip_prefix(&table.head[..])) else {
            return Err(Failure::usage(table.stranger(text.unwrap_or_default())));
        };
        table.take(rows, columns.len());
        table.file.set_len(complete as u64).map_err(|error| denied(&error))?;
        Ok(table)
    }

    /// Why a file cannot be gone on with.
    fn stranger(&self, text: &str) -> String {
        let path = self.path.display();
        let first = |text: &str| text.lines().next().unwrap_or_default().to_owned();
        if first(text) == first(&self.head) {
            format!("{path} holds fits with other options; write to another file, or remove it.")
        } else {
            format!("{path} is no table of this version's fit --batch; write to another file.")
        }
    }

    /// Takes in the rows of an earlier run.
    fn take(&mut self, rows: &str, columns: usize) {
        let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(rows.as_bytes());
        let records = reader.records().filter_map(Result::ok).filter(|record| record.len() == columns);
        let mut group: Vec<Vec<String>> = Vec::new();
        for record in records {
            let row: Vec<String> = record.iter().map(str::to_owned).collect();
            if group.first().is_some_and(|first| (&first[0], &first[3]) != (&row[0], &row[3])) {
                self.keep(FileRows { rows: std::mem::take(&mut group) });
            }
            group.push(row);
        }
        self.keep(FileRows { rows: group });
    }

    /// Keeps the rows of a file, if they are all there.
    fn keep(&mut self, rows: FileRows) {
        if !rows.is_complete() {
            return;
        }
        match self.places.get(rows.file()) {
            Some(&place) => self.done[place] = rows,
            None => {
                self.places.insert(rows.file().to_owned(), self.done.len());
                self.done.push(rows);
            }
        }
    }

    /// What is there already of a file with that hash.
    pub fn found(&self, file: &str, hash: &str) -> Option<&FileRows> {
        self.places.get(file).map(|&place| &self.done[place]).filter(|rows| rows.hash() == hash)
    }

    /// Appends the rows of a file.
    ///
    /// # Errors
    ///
    /// Those of writing.
    pub fn append(&mut self, rows: FileRows) -> io::Result<()> {
        self.append_text(&rows.rows.iter().map(|row| line(row)).collect::<String>())?;
        self.keep(rows);
        Ok(())
    }

    fn append_text(&mut self, text: &str) -> io::Result<()> {
        self.file.write_all(text.as_bytes())
    }

    /// Puts the rows in the order of the files; rows of files that are not among them stand first.
    ///
    /// # Errors
    ///
    /// Those of writing; the rows then stand as they came.
    pub fn finish(self, files: &[String]) -> io::Result<()> {
        let order: HashMap<&str, usize> = files.iter().enumerate().map(|(index, file)| (&file[..], index + 1)).collect();
        let mut done: Vec<&FileRows> = self.done.iter().collect();
        done.sort_by_key(|rows| order.get(rows.file()).copied().unwrap_or(0));
        write_file(&self.path, |out| {
            out.write_all(self.head.as_bytes())?;
            done.iter().flat_map(|rows| &rows.rows).try_for_each(|row| out.write_all(line(row).as_bytes()))
        })
    }
}

/// A row as a line of CSV. Cells hold no line breaks, and `#` is quoted, so that readers with comment lines take it as text.
fn line(cells: &[String]) -> String {
    let quoted = |cell: &String| {
        let cell = cell.replace(['\r', '\n'], " ");
        if cell.contains([',', '"', '#']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
    };
    cells.iter().map(quoted).collect::<Vec<_>>().join(",") + "\n"
}
