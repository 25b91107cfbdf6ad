//! Figures and reports of fits as files; the ending of a file name decides about the format.

use crate::figure::Figure;
use crate::files::disk;
use crate::files::write_file::write_file;
use crate::report::ReportDocument;
#[cfg(any(feature = "gui", test))]
use crate::report::TableFormat;
use pbrdf::selftest::Machine;
use std::io;
use std::path::{Path, PathBuf};

/// Resolution of a PNG for print.
pub const PRINT_DPI: f64 = 300.0;

/// How a figure is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    Svg,
    Png,
}

/// How a report is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportKind {
    Html,
    Markdown,
}

pub fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// The endings that a kind of file has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Endings {
    /// `.svg`, `.png`.
    Picture,
    /// `.html`, `.md`.
    Report,
    /// `.png`, `.exr`, `.csv`.
    Stokes,
    /// `.csv`, `.md`, `.tex`.
    #[cfg(any(feature = "gui", test))]
    Table,
    /// One alone, without its dot.
    #[cfg(any(feature = "gui", test))]
    Only(&'static str),
}

impl std::fmt::Display for Endings {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Picture => f.write_str(".svg or .png"),
            Self::Report => f.write_str(".html or .md"),
            Self::Stokes => f.write_str(".png, .exr or .csv"),
            #[cfg(any(feature = "gui", test))]
            Self::Table => f.write_str(".csv, .md or .tex"),
            #[cfg(any(feature = "gui", test))]
            Self::Only(ending) => write!(f, ".{ending}"),
        }
    }
}

/// A file name that asks for another kind of file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: expected a name that ends in {expected}", .path.display())]
pub struct EndingError {
    /// The name.
    pub path: PathBuf,
    /// What it should end in.
    pub expected: Endings,
}

impl EndingError {
    pub fn new(path: &Path, expected: Endings) -> Self {
        Self { path: path.to_owned(), expected }
    }
}

/// The format of a figure by the ending of its file name.
pub fn picture_kind(path: &Path) -> Result<PictureKind, EndingError> {
    match extension(path).as_str() {
        "svg" => Ok(PictureKind::Svg),
        "png" => Ok(PictureKind::Png),
        _ => Err(EndingError::new(path, Endings::Picture)),
    }
}

/// The format of a report by the ending of its file name.
pub fn report_kind(path: &Path) -> Result<ReportKind, EndingError> {
    match extension(path).as_str() {
        "html" | "htm" => Ok(ReportKind::Html),
        "md" | "markdown" => Ok(ReportKind::Markdown),
        _ => Err(EndingError::new(path, Endings::Report)),
    }
}

/// The form of a table of results by the ending of its file name. The command line has an option for it.
#[cfg(any(feature = "gui", test))]
pub fn table_format(path: &Path) -> Result<TableFormat, EndingError> {
    match extension(path).as_str() {
        "csv" => Ok(TableFormat::Csv),
        "md" | "markdown" => Ok(TableFormat::Markdown),
        "tex" => Ok(TableFormat::Latex),
        _ => Err(EndingError::new(path, Endings::Table)),
    }
}

/// Refuses a file name with another ending. The command line has no use for it.
#[cfg(any(feature = "gui", test))]
pub fn expect_ending(path: &Path, ending: &'static str) -> Result<(), EndingError> {
    if extension(path) == ending { Ok(()) } else { Err(EndingError::new(path, Endings::Only(ending))) }
}

/// Writes a figure.
pub fn write_picture(path: &Path, kind: PictureKind, figure: &Figure) -> io::Result<()> {
    let bytes = match kind {
        PictureKind::Svg => figure.svg().into_bytes(),
        PictureKind::Png => figure.png(PRINT_DPI).map_err(io::Error::other)?,
    };
    write_file(path, |out| out.write_all(&bytes))
}

/// The file of a figure of a Markdown file: the figure `dolp` of `report.md` is `report-dolp.svg`.
fn beside(path: &Path, name: &str) -> PathBuf {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    path.with_file_name(format!("{stem}-{name}.svg"))
}

/// Writes a report: HTML as one file; Markdown with its figures as SVG files in the same folder.
pub fn write_report(path: &Path, kind: ReportKind, document: &ReportDocument) -> io::Result<()> {
    let text = match kind {
        ReportKind::Html => document.html(),
        ReportKind::Markdown => {
            for (name, figure) in document.figures() {
                write_picture(&beside(path, name), PictureKind::Svg, figure)?;
            }
            document.markdown(|name| beside(path, name).file_name().map(|file| file.to_string_lossy().into_owned()).unwrap_or_default())
        }
    };
    write_file(path, |out| out.write_all(text.as_bytes()))
}

/// The program and its version.
pub fn program() -> String {
    format!("pbrdf-explorer {}", env!("CARGO_PKG_VERSION"))
}

/// Day and time, UTC.
pub fn now() -> String {
    humantime::format_rfc3339_seconds(disk::now()).to_string()
}

/// This machine.
pub fn machine() -> Machine {
    // Absent outside Linux: then the architecture has to do.
    let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    Machine::new(&cpuinfo, std::thread::available_parallelism().map_or(1, std::num::NonZero::get))
}

/// SHA-256 in hexadecimal digits; the window computes it while it reads.
#[cfg(any(feature = "cli", test))]
pub fn sha256(bytes: &[u8]) -> String {
    use sha2::Digest as _;
    hexadecimal(&sha2::Sha256::digest(bytes))
}

/// Two digits a byte.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::{PictureKind, ReportKind, expect_ending, picture_kind, report_kind, sha256, table_format};
    use crate::report::TableFormat;
    use std::path::Path;

    #[test]
    fn names_say_what_is_written() {
        assert_eq!(picture_kind(Path::new("a/b.PNG")), Ok(PictureKind::Png));
        assert_eq!(picture_kind(Path::new("b.c.svg")), Ok(PictureKind::Svg));
        assert!(picture_kind(Path::new("svg")).unwrap_err().to_string().contains(".svg or .png"));
        assert_eq!(report_kind(Path::new("b.md")), Ok(ReportKind::Markdown));
        assert!(report_kind(Path::new("b.pdf")).is_err());
        assert_eq!(table_format(Path::new("b.TEX")), Ok(TableFormat::Latex));
        assert!(table_format(Path::new("b.xlsx")).unwrap_err().to_string().contains("ends in .csv, .md or .tex"));
        assert_eq!(expect_ending(Path::new("a/b.CSV"), "csv"), Ok(()));
        assert!(expect_ending(Path::new("b.csv.svg"), "csv").unwrap_err().to_string().contains("ends in .csv"));
    }

    #[test]
    fn hashes_are_those_of_sha256sum() {
        // FIPS 180-2, appendix B.1.
        assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
