//! Measurements: from arrays, and from files.

use crate::error::refused;
use crate::surface::geometry;
use numpy::{PyArray1, PyReadonlyArray1};
use pbrdf::measurement::foreign::{LabTable, TableOptions};
use pbrdf::measurement::formats::{ImportError, ImportNote, ImportOptions, Opened, open};
use pbrdf::measurement::{Expected, Mapping, Quantity, Row, choose_wavelength, unwatched, write_measurements};
use pbrdf::optics::shortest;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// Rows of angles and what was measured there.
#[pyclass(frozen, module = "pbrdf._pbrdf")]
pub struct Measurement {
    pub measurement: pbrdf::Measurement,
}

/// A column of numbers and where they were measured.
type Column<'py> = (PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, bool>);

/// The columns of a measurement, all of one length; angles in degrees, DoLP from 0 to 1, BRDF in sr⁻¹.
#[derive(FromPyObject)]
pub struct Columns<'py> {
    theta_i: PyReadonlyArray1<'py, f64>,
    theta_r: PyReadonlyArray1<'py, f64>,
    dphi: PyReadonlyArray1<'py, f64>,
    dolp: Option<Column<'py>>,
    dolp_sigma: Option<Column<'py>>,
    brdf: Option<Column<'py>>,
    brdf_sigma: Option<Column<'py>>,
    masked: PyReadonlyArray1<'py, bool>,
    name: String,
    metadata: Vec<(String, String)>,
}

/// The number of a column in a row; none where it was not measured.
fn cell(column: Option<&Column<'_>>, row: usize) -> Option<f64> {
    let (values, measured) = column?;
    let is_measured = measured.as_array().get(row).copied().unwrap_or(false);
    if is_measured { values.as_array().get(row).copied() } else { None }
}

/// The quantity of a row, if it was measured; in a masked row a value outside its range is none, as in files.
fn quantity(
    name: &str,
    (values, sigmas): (Option<&Column<'_>>, Option<&Column<'_>>),
    row: usize,
    (expected, maximum): (Expected, f64),
    masked: bool,
) -> PyResult<Option<Quantity>> {
    let Some(value) = cell(values, row) else { return Ok(None) };
    if value.is_nan() {
        return Err(refused(format_args!(
            "{name}[{row}] is NaN; what was not measured is None or masked (numpy.ma.masked_invalid masks every NaN)"
        )));
    }
    if !(0.0..=maximum).contains(&value) {
        let may_be_percent = matches!(expected, Expected::Dolp) && (1.0..=100.0).contains(&value);
        let hint = match value {
            _ if !may_be_percent => "leave the row out, or mask it",
            // Not far above 1 it may be noise as well.
            ..2.0 => "divide percent by 100; if it is noise, leave the row out, or mask it",
            _ => "divide percent by 100",
        };
        return if masked {
            Ok(None)
        } else {
            Err(refused(format_args!("{name}[{row}] = {}, expected {expected}; {hint}", shortest(value))))
        };
    }
    let sigma = cell(sigmas, row);
    match sigma.filter(|&sigma| !(sigma > 0.0 && sigma.is_finite())) {
        Some(sigma) => Err(refused(format_args!("{name}_sigma[{row}] = {}, expected {}", shortest(sigma), Expected::Sigma))),
        None => Ok(Some(Quantity { value, sigma })),
    }
}

#[pymethods]
impl Measurement {
    #[new]
    fn new(columns: Columns<'_>) -> PyResult<Self> {
        let Columns { theta_i, theta_r, dphi, masked, .. } = &columns;
        let (theta_i, theta_r, dphi, masked) = (theta_i.as_array(), theta_r.as_array(), dphi.as_array(), masked.as_array());
        let mut rows = Vec::with_capacity(theta_i.len());
        for row in 0..theta_i.len() {
            let geometry = geometry(theta_i[row], theta_r[row], dphi[row]);
            let geometry = geometry.map_err(|reason| refused(format_args!("{reason} (in row {row})")))?;
            let dolp = (columns.dolp.as_ref(), columns.dolp_sigma.as_ref());
            let brdf = (columns.brdf.as_ref(), columns.brdf_sigma.as_ref());
            let dolp = quantity("dolp", dolp, row, (Expected::Dolp, 1.0), masked[row])?;
            let brdf = quantity("brdf", brdf, row, (Expected::Brdf, f64::MAX), masked[row])?;
            rows.push(Row { geometry, dolp, brdf, masked: masked[row] || (dolp.is_none() && brdf.is_none()) });
        }
        let (name, metadata) = (columns.name, columns.metadata);
        Ok(Self { measurement: pbrdf::Measurement { name, metadata, rows, ..pbrdf::Measurement::default() } })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.measurement.name
    }

    #[getter]
    fn metadata(&self) -> Vec<(String, String)> {
        self.measurement.metadata.clone()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.measurement.notes.iter().map(ToString::to_string).collect()
    }

    /// The column of that name: NaN where nothing was measured; `masked` has 1 in a masked row.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let value = |quantity: Option<Quantity>| quantity.map_or(f64::NAN, |quantity| quantity.value);
        let sigma = |quantity: Option<Quantity>| quantity.and_then(|quantity| quantity.sigma).unwrap_or(f64::NAN);
        let of: &dyn Fn(&Row) -> f64 = match name {
            "theta_i" => &|row| row.geometry.theta_i().0,
            "theta_r" => &|row| row.geometry.theta_r().0,
            "dphi" => &|row| row.geometry.dphi().0,
            "dolp" => &|row| value(row.dolp),
            "dolp_sigma" => &|row| sigma(row.dolp),
            "brdf" => &|row| value(row.brdf),
            "brdf_sigma" => &|row| sigma(row.brdf),
            "masked" => &|row| f64::from(u8::from(row.masked)),
            _ => return Err(refused(format_args!("{name:?} is no column"))),
        };
        Ok(PyArray1::from_iter(py, self.measurement.rows.iter().map(of)))
    }

    fn __len__(&self) -> usize {
        self.measurement.rows.len()
    }

    /// The measurement under another name.
    fn renamed(&self, name: String) -> Self {
        Self { measurement: pbrdf::Measurement { name, ..self.measurement.clone() } }
    }

    /// The measurement as a table that `read` and the command line read.
    fn to_csv(&self) -> PyResult<Vec<u8>> {
        let mut bytes = Vec::new();
        write_measurements(std::slice::from_ref(&self.measurement), &mut bytes).map_err(refused)?;
        Ok(bytes)
    }
}

/// What a foreign file is told: which columns mean what, a wavelength in nm, angles in degrees.
#[derive(FromPyObject)]
pub struct Answers {
    columns: Option<String>,
    wavelength_nm: Option<f64>,
    theta_i: Vec<f64>,
    theta_r: Vec<f64>,
    dphi: Option<f64>,
}

/// The measurements of a file. One without a name has that of the file.
#[pyfunction]
pub fn read(py: Python<'_>, path: PathBuf, answers: Answers) -> PyResult<Vec<Measurement>> {
    let found = py.detach(|| read_file(&path, answers)).map_err(|reason| refused(format_args!("{}: {reason}", path.display())))?;
    let file = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let is_split = found.len() > 1;
    let named = |mut measurement: pbrdf::Measurement| {
        let set = Some(measurement.name.clone()).filter(|name| !name.is_empty());
        let is_named = |wavelength: &String| set.as_ref().is_some_and(|set| set.ends_with(wavelength));
        let wavelength = measurement.wavelength_nm().filter(|_| is_split).map(|nm| format!("{nm} nm")).filter(|nm| !is_named(nm));
        let parts: Vec<String> = [set, wavelength].into_iter().flatten().collect();
        measurement.name = if parts.is_empty() { file.clone() } else { parts.join(" ") };
        Measurement { measurement }
    };
    Ok(found.into_iter().map(named).collect())
}

/// The measurements of a file, or why it has none.
fn read_file(path: &Path, answers: Answers) -> Result<Vec<pbrdf::Measurement>, String> {
    let bytes = std::fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::IsADirectory => "this is a directory; expected a file".to_owned(),
        _ => format!("the file cannot be read: {error}"),
    })?;
    let Answers { columns, wavelength_nm, theta_i, theta_r, dphi } = answers;
    let said = |error: ImportError| refused_text(&error);
    if let Some(columns) = columns {
        return read_columns(bytes, &columns, wavelength_nm, dphi);
    }
    let options = ImportOptions { wavelength_nm, theta_i, theta_r, dphi, ..ImportOptions::default() };
    let mut found = match open(bytes, &mut unwatched).map_err(said)? {
        Opened::Measurements(found) => found,
        Opened::Foreign(file) => {
            let imported = file.import(&options, &mut unwatched).map_err(said)?;
            let mut measurements = imported.measurements;
            if let Some(first) = measurements.first_mut() {
                first.notes.extend(file.notes());
                first.notes.extend(imported.notes);
            }
            measurements
        }
    };
    if found.len() > 1 {
        found = at_wavelength(found, wavelength_nm)?;
    }
    if let Some(first) = found.first_mut().filter(|first| !first.ignored_columns.is_empty()) {
        first.notes.push(ImportNote::IgnoredColumns { names: first.ignored_columns.clone() });
    }
    Ok(found)
}

/// The measurements of a table whose columns are named, as in `theta_i=1,theta_r=2,dolp=3:percent`.
fn read_columns(bytes: Vec<u8>, columns: &str, wavelength_nm: Option<f64>, dphi: Option<f64>) -> Result<Vec<pbrdf::Measurement>, String> {
    let said = |error: ImportError| refused_text(&error);
    let mapping = Mapping::from_text(columns).map_err(|error| format!("columns: {error}"))?;
    let options = TableOptions { columns: Some(mapping), wavelength_nm, dphi, ..TableOptions::default() };
    let table = LabTable::open(bytes, &options, &mut unwatched).map_err(said)?;
    let mut imported = table.read(&options, &mut unwatched).map_err(said)?;
    if let Some(first) = imported.measurements.first_mut() {
        first.notes.append(&mut imported.notes);
    }
    Ok(imported.measurements)
}

/// Of measurements at several wavelengths those at the one that is nearest to the one asked for.
fn at_wavelength(mut found: Vec<pbrdf::Measurement>, wanted_nm: Option<f64>) -> Result<Vec<pbrdf::Measurement>, String> {
    let available: Vec<f64> = found.iter().filter_map(pbrdf::Measurement::wavelength_nm).collect();
    let Some(wanted_nm) = wanted_nm.filter(|_| !available.is_empty()) else { return Ok(found) };
    let nearest = choose_wavelength(&available, Some(wanted_nm)).map_err(|error| error.to_string())?;
    found.retain(|measurement| measurement.wavelength_nm().is_none_or(|nm| nm == nearest));
    if let Some(first) = found.first_mut().filter(|_| nearest != wanted_nm) {
        first.notes.push(ImportNote::NearestWavelength { wanted_nm, taken_nm: vec![nearest] });
    }
    Ok(found)
}

/// Options of the command line, and what answers them here.
const ANSWERS: [(&str, &str); 5] = [
    ("as in --columns ", "as in columns="),
    ("--theta-i", "theta_i="),
    ("--theta-r", "theta_r="),
    ("--dphi", "dphi="),
    ("--wavelength", "wavelength_nm="),
];

/// An error of an import with its hint, in the words of Python.
fn refused_text(error: &ImportError) -> String {
    let text = error.hint().map_or_else(|| error.to_string(), |hint| format!("{error}; {hint}"));
    ANSWERS.iter().fold(text, |text, (option, answer)| text.replace(option, answer))
}
