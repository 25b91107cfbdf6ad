//! How a user corrects the guess of a foreign table.

use crate::measurement::{BrdfMeaning, Field, Mapping};

/// What a foreign table is told; what is absent is guessed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TableOptions {
    /// The columns that are used; besides them the angles alone are guessed.
    pub columns: Option<Mapping>,
    /// The sheet of a workbook; the first without.
    pub sheet: Option<String>,
    /// What separates thousands.
    pub thousands: Option<char>,
    /// Whether a negative θr is the forward side.
    pub flip: bool,
    /// What the columns of a wide table hold: DoLP or BRDF.
    pub wide: Option<Field>,
    /// Whether all but the first channel are divided by the first.
    pub normalised: bool,
    /// What a BRDF is.
    pub brdf_is: Option<BrdfMeaning>,
    /// Angle of incidence in degrees where the table has none.
    pub theta_i: Option<f64>,
    /// Relative azimuth in degrees where the table has none; 180 without.
    pub dphi: Option<f64>,
    /// The wavelength in nm to take of several; all without.
    pub wavelength_nm: Option<f64>,
}
