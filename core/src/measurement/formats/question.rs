//! What a foreign file has to be told before it is a measurement, and the answers.

use crate::measurement::Mapping;
use crate::measurement::foreign::{ShownRow, TableGuess, TableOptions};
use std::sync::Arc;

/// A question of a foreign file.
#[derive(Debug, Clone)]
pub enum Question {
    /// Which wavelength?
    Wavelength {
        /// The wavelengths of the file in nm, ascending.
        available_nm: Vec<f64>,
    },
    /// At which angle of incidence?
    ThetaI,
    /// At which angles?
    Directions,
    /// Which column holds what?
    Columns(Arc<TableSample>),
}

/// The beginning of a foreign table.
#[derive(Debug)]
pub struct TableSample {
    /// Names of the columns; empty where the table has no header.
    pub header: Vec<String>,
    /// The first rows, cell by cell.
    pub rows: Vec<Vec<String>>,
    /// The first rows of the file, with what each is.
    pub shown: Vec<ShownRow>,
    /// What the names suggest, of columns that hold one thing each.
    pub guess: Mapping,
    /// What the whole table is taken for.
    pub table: TableGuess,
    /// The sheets of a workbook, in their order; none of a text.
    pub sheets: Vec<String>,
    /// Which of them this is.
    pub sheet: Option<String>,
    /// The thousands separator that its numbers were read with.
    pub thousands: Option<char>,
}

/// The answers. What a file does not ask for is not used.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ImportOptions {
    /// The wavelength in nm; the nearest of the file is taken.
    pub wavelength_nm: Option<f64>,
    /// Angles of incidence in degrees.
    pub theta_i: Vec<f64>,
    /// Angles of view in degrees; negative is the backscatter side.
    pub theta_r: Vec<f64>,
    /// Relative azimuth in degrees; 180 without.
    pub dphi: Option<f64>,
    /// The columns of a table; those of the guess are left to it.
    pub columns: Mapping,
    /// What else a table is told.
    pub table: TableOptions,
}

/// The angle of incidence in degrees that is offered first: what many ellipsometers stand at.
const OFFERED_THETA_I: f64 = 65.0;
/// The wavelength in nm that is offered first: red, as of most lasers.
const OFFERED_NM: f64 = 650.0;

impl ImportOptions {
    /// The angles of incidence that are offered first, in degrees.
    #[must_use]
    pub fn offered_theta_i() -> Vec<f64> {
        vec![15.0, 30.0, 45.0, 60.0, 75.0]
    }

    /// The answers to offer first: the wavelength nearest to 650 nm and the guess of the columns.
    #[must_use]
    pub fn offered(questions: &[Question]) -> Self {
        let mut options = Self::default();
        for question in questions {
            match question {
                Question::Wavelength { available_nm } => {
                    let distance = |wavelength: f64| (wavelength - OFFERED_NM).abs();
                    options.wavelength_nm = available_nm.iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
                }
                Question::ThetaI => options.theta_i = vec![OFFERED_THETA_I],
                Question::Directions => options.dphi = Some(180.0),
                Question::Columns(sample) => {
                    options.columns = sample.guess.clone();
                    (options.table.sheet, options.table.thousands) = (sample.sheet.clone(), sample.thousands);
                }
            }
        }
        options
    }
}
