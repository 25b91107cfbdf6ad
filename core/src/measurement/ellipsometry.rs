//! Ellipsometry, ψ and Δ at several angles and wavelengths, and the specular DoLP that it gives.
//!
//! A smooth surface under unpolarised light has `DoLP = |Rs − Rp|/(Rs + Rp) = |cos 2ψ|` at θr = θi,
//! with `tan ψ = |rp/rs|`; its standard deviation is `2 |sin 2ψ| σ_ψ`. ψ is that of the polarised
//! part: a depolarisation d (in percent, `100 (1 − P²)`) lowers the DoLP of the light that leaves
//! the sample to `√(1 − d/100) |cos 2ψ|`, which is not applied.

use crate::measurement::{Measurement, Quantity, Row, WavelengthError, choose_wavelength};
use crate::optics::{Degrees, Geometry};
use std::collections::HashMap;

/// One row of ψ and Δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PsiDelta {
    /// Vacuum wavelength in nm.
    pub wavelength_nm: f64,
    /// Angle of incidence in degrees, 0 ≤ θi < 90.
    pub theta_i: f64,
    /// ψ in degrees, 0 to 90.
    pub psi: f64,
    /// Δ in degrees.
    pub delta: f64,
    /// Standard deviation of ψ in degrees, where stated and above 0.
    pub sigma_psi: Option<f64>,
    /// Line of the file.
    pub line: u64,
}

/// One row of depolarisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depolarisation {
    /// Vacuum wavelength in nm.
    pub wavelength_nm: f64,
    /// Angle of incidence in degrees.
    pub theta_i: f64,
    /// In percent; noise may make it negative.
    pub percent: f64,
}

/// The ellipsometry of one file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ellipsometry {
    /// Sample, method and original file, where the file states them.
    pub metadata: Vec<(String, String)>,
    /// ψ and Δ, in the order of the file.
    pub rows: Vec<PsiDelta>,
    /// Depolarisation, in the order of the file.
    pub depolarisation: Vec<Depolarisation>,
    /// Quantities that are not used, and the number of their rows.
    pub ignored: Vec<(String, usize)>,
}

/// Ellipsometry as a measurement of specular DoLP.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpecularDolp {
    /// A row per angle of incidence, at θr = θi.
    pub measurement: Measurement,
    /// The wavelengths of the rows in nm: one, unless the angles were measured at different ones.
    pub wavelengths_nm: Vec<f64>,
    /// Angles of incidence in degrees without a wavelength near the one asked for.
    pub left_out: Vec<f64>,
}

impl Ellipsometry {
    /// The wavelengths of the ψ rows in nm, ascending, each once.
    #[must_use]
    pub fn wavelengths_nm(&self) -> Vec<f64> {
        let mut wavelengths: Vec<f64> = self.rows.iter().map(|row| row.wavelength_nm).collect();
        wavelengths.sort_by(f64::total_cmp);
        wavelengths.dedup();
        wavelengths
    }

    /// The specular DoLP at every angle of incidence, at the wavelength nearest to the one asked
    /// for. Without a wavelength there has to be one only.
    ///
    /// # Errors
    /// No angle has a wavelength near the one asked for, or there are several and none was chosen.
    pub fn specular_dolp(&self, wanted_nm: Option<f64>) -> Result<SpecularDolp, WavelengthError> {
        let wavelength_nm = choose_wavelength(&self.wavelengths_nm(), wanted_nm)?;
        let wanted_nm = wanted_nm.unwrap_or(wavelength_nm);
        let mut order: Vec<f64> = Vec::new();
        let mut by_angle: HashMap<u64, Vec<&PsiDelta>> = HashMap::new();
        for row in &self.rows {
            let own = by_angle.entry(row.theta_i.to_bits()).or_default();
            if own.is_empty() {
                order.push(row.theta_i);
            }
            own.push(row);
        }
        let mut found = SpecularDolp::default();
        for theta_i in order {
            let own = &by_angle[&theta_i.to_bits()];
            let available: Vec<f64> = own.iter().map(|row| row.wavelength_nm).collect();
            let Ok(wavelength_nm) = choose_wavelength(&available, Some(wanted_nm)) else {
                found.left_out.push(theta_i);
                continue;
            };
            found.wavelengths_nm.push(wavelength_nm);
            for row in own.iter().filter(|row| row.wavelength_nm == wavelength_nm) {
                found.measurement.rows.extend(row.specular());
                found.measurement.lines.push(row.line);
            }
        }
        if found.measurement.rows.is_empty() {
            // Within the range of all wavelengths, but near none of any angle.
            return Err(WavelengthError::Outside { wanted_nm, available_nm: self.wavelengths_nm() });
        }
        found.wavelengths_nm.sort_by(f64::total_cmp);
        found.wavelengths_nm.dedup();
        found.measurement.metadata = self.metadata_at(&found.wavelengths_nm);
        Ok(found)
    }

    fn metadata_at(&self, taken_nm: &[f64]) -> Vec<(String, String)> {
        let mut metadata = self.metadata.clone();
        let wavelengths: Vec<String> = taken_nm.iter().map(f64::to_string).collect();
        metadata.push(("wavelength_nm".to_owned(), wavelengths.join(", ")));
        metadata.push(("quantity".to_owned(), "specular DoLP = |cos 2 psi| at theta_r = theta_i, from ellipsometry".to_owned()));
        let here = self.depolarisation.iter().filter(|row| taken_nm.contains(&row.wavelength_nm));
        let here: Vec<String> = here.map(|row| format!("{} % at {} degrees", row.percent, row.theta_i)).collect();
        if !here.is_empty() {
            metadata.push(("depolarisation".to_owned(), format!("{}; not applied", here.join(", "))));
        }
        metadata
    }
}

impl PsiDelta {
    /// The row of a measurement: |cos 2ψ| at θr = θi.
    fn specular(&self) -> Option<Row> {
        let (sin, cos) = Degrees(2.0 * self.psi).sin_cos();
        let sigma = self.sigma_psi.map(|sigma| 2.0 * sin.abs() * Degrees(sigma).radians()).filter(|&sigma| sigma > 0.0);
        // The angle was checked when it was read.
        let geometry = Geometry::in_plane(self.theta_i, self.theta_i).ok()?;
        Some(Row { geometry, dolp: Some(Quantity { value: cos.abs(), sigma }), brdf: None, masked: false })
    }
}
