//! Units of the wavelength in files of ellipsometers.

/// nm times eV: h c/e in the SI since 2019.
const NM_EV: f64 = 1_239.841_984_332_002_6;

/// The unit of the wavelengths of a file.
#[derive(Debug, Clone, Copy)]
pub(super) enum WavelengthUnit {
    Nm(f64),
    Ev,
    PerCm,
}

impl WavelengthUnit {
    pub(super) fn from_word(word: &str) -> Option<Self> {
        match word.to_lowercase().as_str() {
            "nm" | "nanometers" => Some(Self::Nm(1.0)),
            "angstroms" | "angstrom" | "å" => Some(Self::Nm(0.1)),
            "um" | "µm" | "μm" | "microns" | "micrometers" => Some(Self::Nm(1000.0)),
            "ev" => Some(Self::Ev),
            "1/cm" | "cm-1" => Some(Self::PerCm),
            _ => None,
        }
    }

    pub(super) fn nm(self, value: f64) -> f64 {
        match self {
            Self::Nm(factor) => value * factor,
            Self::Ev => NM_EV / value,
            Self::PerCm => 1e7 / value,
        }
    }
}
