//! Reports and figures of fits as files.

use crate::cli::arguments::FitArguments;
use crate::cli::failure::{Failure, input_name, is_standard_input};
use crate::figure::Figure;
use crate::files::export;
use crate::report::{DataSource, ReportDocument};
use std::path::Path;

/// A file as the source of a report.
pub fn data_source(path: &Path, bytes: &[u8]) -> DataSource {
    let file_name = path.file_name().filter(|_| !is_standard_input(path));
    let name = file_name.map_or_else(|| input_name(path), |name| name.to_string_lossy().into_owned());
    DataSource { name, sha256: Some(export::sha256(bytes)) }
}

/// The report, if one was asked for.
pub fn write_report(arguments: &FitArguments, document: impl FnOnce() -> ReportDocument) -> Result<(), Failure> {
    let Some(path) = &arguments.report else { return Ok(()) };
    let kind = export::report_kind(path).map_err(|error| Failure::usage(error.to_string()))?;
    export::write_report(path, kind, &document()).map_err(|error| Failure::output(path.display(), &error))
}

/// The figure, if one was asked for.
pub fn write_figure(path: Option<&Path>, figure: impl FnOnce() -> Option<Figure>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    let kind = export::picture_kind(path).map_err(|error| Failure::usage(error.to_string()))?;
    let figure = figure().ok_or_else(|| Failure::usage("There is nothing to draw: no row has a value."))?;
    export::write_picture(path, kind, &figure).map_err(|error| Failure::output(path.display(), &error))
}
