//! What a column called BRDF or reflectance holds.

/// What a column of light reflected into a direction holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BrdfMeaning {
    /// BRDF in sr⁻¹.
    Brdf,
    /// BRDF times cos θr, in sr⁻¹.
    BrdfCos,
    /// Reflectance factor, π times the BRDF.
    Factor,
}

impl BrdfMeaning {
    /// All, by their names on the command line.
    pub const ALL: [(&'static str, Self); 3] = [("brdf", Self::Brdf), ("brdf-cos", Self::BrdfCos), ("factor", Self::Factor)];

    /// What a value is divided by to become a BRDF, at an angle of view whose cosine is given.
    #[must_use]
    pub fn divisor(self, cos_theta_r: f64) -> f64 {
        match self {
            Self::Brdf => 1.0,
            Self::BrdfCos => cos_theta_r,
            Self::Factor => std::f64::consts::PI,
        }
    }
}

/// As the metadata of an import record it.
impl std::fmt::Display for BrdfMeaning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Brdf => "BRDF in 1/sr",
            Self::BrdfCos => "BRDF times cos theta_r, divided by it",
            Self::Factor => "reflectance factor, divided by pi",
        })
    }
}
