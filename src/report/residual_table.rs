//! A fitted model beside the measured values: columns for a table.

use crate::report::fit_comments::{insert_comments, with_fit};
use pbrdf::measurement::{Measurement, append_columns, write_measurements};
use pbrdf::model::Pbrdf;
use pbrdf::optics::{Facet, shortest};
use std::io::{self, Write};

/// Names of the columns that a fit adds to a measurement.
pub const FITTED_COLUMNS: [&str; 4] = ["dolp_model", "dolp_residual", "brdf_model", "brdf_residual"];

/// Model and residual (model less measured) of both quantities for each row; a quantity that was not
/// measured, or that a model of DoLP alone does not predict, has empty cells.
#[must_use]
pub fn fitted_cells(measurement: &Measurement, surface: &Pbrdf, dolp_only: bool) -> Vec<Vec<String>> {
    let pair =
        |model: f64, measured: Option<f64>| [shortest(model), measured.map_or_else(String::new, |measured| shortest(model - measured))];
    let cells = measurement.rows.iter().map(|row| {
        let reflection = surface.reflection(&Facet::new(row.geometry));
        let dolp = pair(reflection.dolp, row.dolp.map(|dolp| dolp.value));
        let brdf = if dolp_only { [String::new(), String::new()] } else { pair(reflection.brdf, row.brdf.map(|brdf| brdf.value)) };
        dolp.into_iter().chain(brdf).collect()
    });
    cells.collect()
}

/// Writes a measurement with the fitted columns beside it, and the comment lines of the fit above.
///
/// # Errors
///
/// Those of `out`.
pub fn write_fitted(
    measurement: &Measurement,
    surface: &Pbrdf,
    dolp_only: bool,
    comments: &[(String, String)],
    out: impl Write,
) -> io::Result<()> {
    let mut table = Vec::new();
    Measurement { metadata: with_fit(measurement, comments), ..measurement.clone() }.write(&mut table)?;
    let lines = Measurement::read(&table[..]).map_err(io::Error::other)?.lines;
    append_columns(&table, &FITTED_COLUMNS, &lines, &fitted_cells(measurement, surface, dolp_only), out)
}

/// Writes several measurements as one table with a column `set`, the fitted columns beside each on its own surface, and the comment lines
/// of the fit above.
///
/// # Errors
///
/// Those of `out`.
pub fn write_fitted_sets(
    sets: &[(&Measurement, Pbrdf)],
    dolp_only: bool,
    comments: &[(String, String)],
    mut out: impl Write,
) -> io::Result<()> {
    let named = |(measurement, _): &(&Measurement, Pbrdf)| Measurement { metadata: with_fit(measurement, &[]), ..(*measurement).clone() };
    let measurements: Vec<Measurement> = sets.iter().map(named).collect();
    let mut table = Vec::new();
    write_measurements(&measurements, &mut table)?;
    let lines = Measurement::read(&table[..]).map_err(io::Error::other)?.lines;
    let cells: Vec<Vec<String>> = sets.iter().flat_map(|(measurement, surface)| fitted_cells(measurement, surface, dolp_only)).collect();
    let mut whole = Vec::new();
    append_columns(&table, &FITTED_COLUMNS, &lines, &cells, &mut whole)?;
    out.write_all(&insert_comments(&whole, &measurements[0], comments))
}

/// Writes a table as it was read, with the fitted cells beside its rows and the comment lines of the fit above its header.
///
/// # Errors
///
/// Those of `out`.
pub fn write_beside(
    table: &[u8],
    (lines, cells): (&[u64], &[Vec<String>]),
    measurement: &Measurement,
    comments: &[(String, String)],
    mut out: impl Write,
) -> io::Result<()> {
    let mut whole = Vec::new();
    append_columns(table, &FITTED_COLUMNS, lines, cells, &mut whole)?;
    out.write_all(&insert_comments(&whole, measurement, comments))
}
