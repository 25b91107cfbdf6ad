//! The tensor file as a form of files.

use super::read::is_tensor;
use crate::measurement::formats::error::ImportError;
use crate::measurement::formats::format::{ForeignFile, Format};
use crate::measurement::formats::imported::Imported;
use crate::measurement::formats::question::{ImportOptions, Question};
use crate::measurement::note::ImportNote;
use crate::measurement::{Progress, Tensor, TensorSlice, grid_geometries};

/// The tensor file.
pub(in crate::measurement::formats) struct Pbsdf;

impl Format for Pbsdf {
    fn name(&self) -> &'static str {
        "a tensor file (.pbsdf)"
    }

    fn help(&self) -> &'static str {
        "\
Tensor (.pbsdf, KAIST and Mitsuba 3): BRDF and DoLP for unpolarised light in one band, on the angles of --theta-i, --theta-r and
--dphi, linear between the nodes. Out of plane: --dphi 90 --theta-r 0:80:5."
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["pbsdf"]
    }

    fn sniff(&self, bytes: &[u8]) -> bool {
        is_tensor(bytes)
    }

    fn open(&self, bytes: Vec<u8>, _: Progress<'_>) -> Result<Box<dyn ForeignFile>, ImportError> {
        Ok(Box::new(Tensor::from_bytes(bytes)?))
    }
}

impl ForeignFile for Tensor {
    fn summary(&self) -> &'static str {
        "A tensor of Mueller matrices: slices through it become BRDF and DoLP for unpolarised light."
    }

    fn questions(&self) -> Vec<Question> {
        vec![Question::Wavelength { available_nm: self.wavelengths_nm().to_vec() }, Question::Directions]
    }

    fn notes(&self) -> Vec<ImportNote> {
        let names = self.assumed_grids().to_vec();
        if names.is_empty() { Vec::new() } else { vec![ImportNote::AssumedGrids { names }] }
    }

    fn import(&self, options: &ImportOptions, _: Progress<'_>) -> Result<Imported, ImportError> {
        let geometries = grid_geometries(&options.theta_i, &options.theta_r, options.dphi.unwrap_or(180.0))?;
        let TensorSlice { measurement, wavelength_nm, without_value, beyond_one } = self.slice(&geometries, options.wavelength_nm)?;
        let mut notes = Vec::from_iter(ImportNote::nearest(options.wavelength_nm, &[wavelength_nm]));
        if without_value > 0 {
            notes.push(ImportNote::NoValue { count: without_value });
        }
        if beyond_one > 0 {
            notes.push(ImportNote::DolpAboveOne { count: beyond_one });
        }
        if measurement.rows.is_empty() { Err(ImportError::NoValue { notes }) } else { Ok(Imported::one(measurement, notes)) }
    }
}
