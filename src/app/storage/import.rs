//! What a file holds: a measurement of the program's own form, or something else that needs a choice before it is one.
//!
//! Woollam ellipsometry has to be told the wavelength, a tensor of Mueller matrices the band and the angles, a foreign table which
//! column is what. Nothing is guessed silently: where there is only one answer it is taken, else it is asked for.

use crate::app::text::i18n::phrase;
use crate::app::work::design::Span;
use crate::export;
use pbrdf::measurement;
use pbrdf::measurement::{
    Ellipsometry, Field, Mapping, Measurement, Progress, ReadError, ReadErrorKind, Table, Tensor, grid_geometries, is_tensor, is_woollam,
    read_mapped, read_woollam, tensor_from_bytes,
};
use sha2::{Digest as _, Sha256};
use std::io::Read;
use std::ops::ControlFlow;
use std::sync::Arc;
use tr::tr;

/// A measurement with what is to be said about how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportResult {
    pub measurement: Measurement,
    pub notices: Vec<String>,
}

/// What came out of a file.
pub enum Loaded {
    Measurement(Box<ImportResult>),
    /// Something that needs a choice.
    ImportSource(ImportSource),
}

/// A file of another form; shared with jobs.
#[derive(Clone)]
pub enum ImportSource {
    Ellipsometry(Arc<Ellipsometry>),
    Tensor(Arc<Tensor>),
    Table(Arc<ForeignTable>),
}

/// A table whose columns have names of their own.
pub struct ForeignTable {
    bytes: Vec<u8>,
    /// Names of the columns; empty where it has no header.
    pub header: Vec<String>,
    /// The first rows, cell by cell.
    pub rows: Vec<Vec<String>>,
    /// Why it is none of the program's own, as a phrase in English.
    pub reason: String,
    metadata: Vec<(String, String)>,
}

/// Slices through a tensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Slices {
    pub wavelength_nm: f64,
    pub theta_i: Span,
    pub theta_r: Span,
    pub dphi: f64,
}

/// What the user chose.
#[derive(Debug, Clone, PartialEq)]
pub enum ImportOptions {
    /// Vacuum wavelength in nm.
    Ellipsometry(f64),
    Tensor(Slices),
    Table(Mapping),
}

/// Rows of a foreign table that are shown.
const SHOWN: usize = 5;
/// Bytes of a table that are looked at before all of it is read.
const HEAD: usize = 1 << 16;
/// The wavelength in nm that is offered first, or its nearest neighbour: red, as of most lasers and of the examples.
const OFFERED: f64 = 650.0;
/// Bytes between two reports of progress.
const CHUNK: usize = 1 << 20;

/// A reader that takes the hash of what goes through it.
pub struct Hashing<R> {
    source: R,
    hash: Sha256,
}

impl<R> Hashing<R> {
    pub fn new(source: R) -> Self {
        Self { source, hash: Sha256::new() }
    }

    /// SHA-256 of what went through, hexadecimal.
    pub fn finish(self) -> String {
        export::hexadecimal(&self.hash.finalize())
    }
}

impl<R: Read> Read for Hashing<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let read = self.source.read(buffer)?;
        self.hash.update(&buffer[..read]);
        Ok(read)
    }
}

/// All bytes of a source of that length; `progress` may stop it.
pub fn bytes_of(mut source: impl Read, length: Option<u64>, progress: Progress<'_>) -> Result<Vec<u8>, ReadError> {
    let anywhere = |kind| ReadError { line: None, column: None, kind };
    let mut bytes = Vec::new();
    loop {
        let read = source.by_ref().take(CHUNK as u64).read_to_end(&mut bytes).map_err(|error| anywhere(ReadErrorKind::Io(error)))?;
        #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress bar")]
        let done = length.map_or(0.0, |length| (bytes.len() as f64 / length.max(1) as f64).min(1.0));
        if progress(done).is_break() {
            return Err(anywhere(ReadErrorKind::Cancelled));
        }
        if read < CHUNK {
            return Ok(bytes);
        }
    }
}

/// What those bytes hold; the error is a phrase.
pub fn read(bytes: Vec<u8>, progress: Progress<'_>) -> Result<Loaded, String> {
    if is_woollam(&bytes) {
        let ellipsometry = Arc::new(read_woollam(&bytes[..], progress).map_err(|error| phrase(&error))?);
        return match ellipsometry.wavelengths_nm()[..] {
            [only] => ImportSource::Ellipsometry(ellipsometry).import(&ImportOptions::Ellipsometry(only), progress).map(arrived),
            _ => Ok(Loaded::ImportSource(ImportSource::Ellipsometry(ellipsometry))),
        };
    }
    if is_tensor(&bytes) {
        let tensor = tensor_from_bytes(bytes).map_err(|error| phrase(&error))?;
        return Ok(Loaded::ImportSource(ImportSource::Tensor(Arc::new(tensor))));
    }
    match measurement::read(&bytes[..], progress) {
        Ok(measurement) => Ok(arrived(ImportResult { measurement, notices: Vec::new() })),
        Err(error) if is_about_names(&error) => {
            ForeignTable::new(bytes, &error).map(|table| Loaded::ImportSource(ImportSource::Table(Arc::new(table))))
        }
        Err(error) => Err(phrase(&error)),
    }
}

fn arrived(imported: ImportResult) -> Loaded {
    Loaded::Measurement(Box::new(imported))
}

/// Whether a table fails for the names of its columns alone.
fn is_about_names(error: &ReadError) -> bool {
    matches!(error.kind, ReadErrorKind::MissingColumn { .. } | ReadErrorKind::NoQuantity { .. } | ReadErrorKind::NoHeader { .. })
}

impl ForeignTable {
    /// Needs two columns of numbers at least, an angle and something measured, and a column whose name is not the program's own where
    /// nothing measured is named.
    fn new(bytes: Vec<u8>, error: &ReadError) -> Result<Self, String> {
        let table = Table::foreign(head(&bytes)).map_err(|error| phrase(&error))?;
        let header = table.header().to_vec();
        let (mut rows, mut is_numeric) = (Vec::new(), vec![false; header.len()]);
        // What is wrong with a row is said when columns are chosen.
        let _ = table.for_each(&mut |_| ControlFlow::Continue(()), |record| {
            if rows.len() < SHOWN {
                rows.push((0..header.len()).map(|column| record.text(column)).collect());
                is_numeric.iter_mut().enumerate().for_each(|(column, is_numeric)| *is_numeric |= record.number(column, "").is_ok());
            }
            Ok(())
        });
        let is_own = header.iter().all(|name| Field::from_key(name).is_some());
        let lacks_all = is_own && matches!(error.kind, ReadErrorKind::NoQuantity { .. });
        let is_table = header.len() > 2 || is_numeric.iter().filter(|is_numeric| **is_numeric).count() >= 2;
        if lacks_all || !is_table {
            return Err(phrase(error));
        }
        Ok(Self { header, rows, reason: error.to_string(), metadata: table.metadata().to_vec(), bytes })
    }
}

/// The first lines, whole ones.
fn head(bytes: &[u8]) -> &[u8] {
    if bytes.len() <= HEAD {
        return bytes;
    }
    let end = bytes[..HEAD].iter().rposition(|&byte| byte == b'\n' || byte == b'\r').unwrap_or(HEAD);
    &bytes[..end]
}

impl ImportSource {
    /// What is offered first.
    pub fn first_choice(&self) -> ImportOptions {
        match self {
            Self::Ellipsometry(ellipsometry) => ImportOptions::Ellipsometry(nearest(&ellipsometry.wavelengths_nm(), OFFERED)),
            Self::Tensor(tensor) => ImportOptions::Tensor(Slices {
                wavelength_nm: nearest(tensor.wavelengths_nm(), OFFERED),
                theta_i: Span::new(15.0, 75.0, 15.0),
                theta_r: Span::new(-80.0, 80.0, 5.0),
                dphi: 180.0,
            }),
            Self::Table(table) => ImportOptions::Table(Mapping::guess(&table.header, &table.metadata)),
        }
    }

    /// Wavelengths to choose from, in nm.
    pub fn wavelengths_nm(&self) -> Vec<f64> {
        match self {
            Self::Ellipsometry(ellipsometry) => ellipsometry.wavelengths_nm(),
            Self::Tensor(tensor) => tensor.wavelengths_nm().to_vec(),
            Self::Table(_) => Vec::new(),
        }
    }

    /// The measurement so chosen; the error is a phrase in English.
    pub fn import(&self, choice: &ImportOptions, progress: Progress<'_>) -> Result<ImportResult, String> {
        match (self, choice) {
            (Self::Ellipsometry(ellipsometry), ImportOptions::Ellipsometry(wavelength_nm)) => specular(ellipsometry, *wavelength_nm),
            (Self::Tensor(tensor), ImportOptions::Tensor(slices)) => sliced(tensor, slices),
            (Self::Table(table), ImportOptions::Table(mapping)) => mapped(&table.bytes, mapping, progress),
            // A choice is made for its own file.
            _ => Err("the choice belongs to another file".to_owned()),
        }
    }

    /// Whether a preview holds every row.
    pub fn is_seen_whole(&self) -> bool {
        if let Self::Table(table) = self { table.bytes.len() <= HEAD } else { true }
    }

    /// The beginning of the same, quickly.
    pub fn preview(&self, choice: &ImportOptions) -> Result<ImportResult, String> {
        match (self, choice) {
            (Self::Table(table), ImportOptions::Table(mapping)) => mapped(head(&table.bytes), mapping, &mut |_| ControlFlow::Continue(())),
            _ => self.import(choice, &mut |_| ControlFlow::Continue(())),
        }
    }
}

fn nearest(available: &[f64], wanted: f64) -> f64 {
    let distance = |wavelength: f64| (wavelength - wanted).abs();
    available.iter().copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(wanted)
}

fn mapped(bytes: &[u8], mapping: &Mapping, progress: Progress<'_>) -> Result<ImportResult, String> {
    let measurement = read_mapped(bytes, mapping, progress).map_err(|error| error.to_string())?;
    Ok(ImportResult { measurement, notices: Vec::new() })
}

fn specular(ellipsometry: &Ellipsometry, wavelength_nm: f64) -> Result<ImportResult, String> {
    let slice = ellipsometry.specular_dolp(Some(wavelength_nm)).map_err(|error| error.to_string())?;
    let mut notices = Vec::new();
    if slice.wavelengths_nm != [wavelength_nm] {
        let taken: Vec<String> = slice.wavelengths_nm.iter().map(f64::to_string).collect();
        notices.push(tr!("There is no {0} nm at every angle; the nearest was taken, {1} nm.", wavelength_nm, taken.join(", ")));
    }
    for theta_i in &slice.left_out {
        notices.push(tr!("Left out θi = {}°, which has no wavelength near the one asked for.", theta_i));
    }
    for (name, count) in &ellipsometry.ignored {
        notices.push(tr!("Ignored {0} rows of {1}.", count, name));
    }
    if !ellipsometry.depolarisation.is_empty() {
        notices.push(tr!("Depolarisation (dpolE) is named in the metadata, not applied to DoLP."));
    }
    Ok(ImportResult { measurement: slice.measurement, notices })
}

fn sliced(tensor: &Tensor, slices: &Slices) -> Result<ImportResult, String> {
    let angles = |span: Span| span.angles().collect::<Vec<f64>>();
    let geometries = grid_geometries(&angles(slices.theta_i), &angles(slices.theta_r), slices.dphi).map_err(|error| error.to_string())?;
    let slice = tensor.slice(&geometries, Some(slices.wavelength_nm)).map_err(|error| error.to_string())?;
    if slice.measurement.rows.is_empty() {
        return Err("none of these directions has a value".to_owned());
    }
    let mut notices = Vec::new();
    if !tensor.assumed_grids().is_empty() {
        let names = tensor.assumed_grids().join(", ");
        notices.push(tr!("The file gives no angles for {}; they are taken to be even over their whole range.", names));
    }
    if slice.without_value > 0 {
        notices.push(tr!("Left out {} directions without a value.", slice.without_value));
    }
    if slice.beyond_one > 0 {
        notices.push(tr!("Left out the DoLP of {} directions where it is above 1.", slice.beyond_one));
    }
    Ok(ImportResult { measurement: slice.measurement, notices })
}
