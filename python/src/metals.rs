//! Tabulated refractive indices.

use crate::error::refused;
use numpy::PyArray1;
use pbrdf::optics::{self, Metal, Sample};
use pyo3::prelude::*;

type Column<'py> = Bound<'py, PyArray1<f64>>;
/// Metal and its name in words; source, authors, citation, comment; wavelengths in nm, n, k.
type SourceRow<'py> = ([String; 6], [Column<'py>; 3]);

/// The sources of a metal, or of all.
#[pyfunction]
pub fn metals<'py>(py: Python<'py>, name: Option<&str>) -> PyResult<Vec<SourceRow<'py>>> {
    let damaged = |error| refused(format_args!("the bundled table of metals is damaged: {error}"));
    let all = optics::metals().map_err(damaged)?;
    let chosen: Vec<&Metal> = match name {
        None => all.iter().collect(),
        Some(name) => vec![optics::metal(name).map_err(damaged)?.ok_or_else(|| {
            let keys: Vec<&str> = all.iter().map(|metal| metal.key.as_str()).collect();
            refused(format_args!("{name:?} is not among the tabulated metals; expected one of {}", keys.join(", ")))
        })?],
    };
    let mut rows = Vec::new();
    for metal in chosen {
        for source in &metal.sources {
            let column = |of: fn(&Sample) -> f64| PyArray1::from_iter(py, source.samples().iter().map(of));
            let columns = [column(|sample| sample.wavelength_nm), column(|sample| sample.index.n()), column(|sample| sample.index.k_m())];
            let texts = [&metal.key, &metal.name, &source.key, &source.name, &source.citation, &source.comment];
            rows.push((texts.map(Clone::clone), columns));
        }
    }
    Ok(rows)
}
