//! Choice of a wavelength of a file that has several: the nearest to the one asked for, never a
//! guess.

/// Why no wavelength can be chosen.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WavelengthError {
    /// No wavelength was asked for.
    #[error("the file has {count} wavelengths, {}; one has to be chosen", Offer(.available_nm))]
    NotChosen {
        /// How many.
        count: usize,
        /// The wavelengths of the file, ascending, in nm.
        available_nm: Vec<f64>,
    },
    /// Farther from the ends than half a step, or in a gap.
    #[error("{wanted_nm} nm is outside what the file has: {}", Offer(.available_nm))]
    Outside {
        /// The wavelength asked for, in nm.
        wanted_nm: f64,
        /// The wavelengths of the file, ascending, in nm.
        available_nm: Vec<f64>,
    },
}

/// Up to eight wavelengths one by one, more by their ends.
struct Offer<'a>(&'a [f64]);

impl std::fmt::Display for Offer<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            [] => write!(f, "none"),
            [first, .., last] if self.0.len() > 8 => write!(f, "{first} to {last} nm"),
            few => write!(f, "{} nm", few.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")),
        }
    }
}

/// How far from the only wavelength of a file the one asked for may be, in nm.
const REACH_OF_ONE: f64 = 1.0;

/// The wavelength nearest to the one asked for, which may lie beyond the ends by half a step at
/// most. Without one asked for, the only wavelength there is.
///
/// `available` in nm, in any order, repetitions allowed.
///
/// # Errors
/// The wavelength asked for is too far from all, or there are several and none was asked for.
pub fn choose_wavelength(available: &[f64], wanted_nm: Option<f64>) -> Result<f64, WavelengthError> {
    let mut available_nm = available.to_vec();
    available_nm.sort_by(f64::total_cmp);
    available_nm.dedup();
    let Some(wanted_nm) = wanted_nm else {
        return match available_nm[..] {
            [only] => Ok(only),
            _ => Err(WavelengthError::NotChosen { count: available_nm.len(), available_nm }),
        };
    };
    let distance = |wavelength: f64| (wavelength - wanted_nm).abs();
    let nearest = available_nm.iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
    let reach = match available_nm[..] {
        [first, second, ..] if wanted_nm < first => 0.5 * (second - first),
        [.., before, last] if wanted_nm > last => 0.5 * (last - before),
        [_] => REACH_OF_ONE,
        _ => f64::INFINITY,
    };
    nearest.filter(|&nearest| distance(nearest) <= reach).ok_or(WavelengthError::Outside { wanted_nm, available_nm })
}

#[cfg(test)]
mod tests {
    use super::choose_wavelength;

    #[test]
    fn the_nearest_is_taken_within_half_a_step_of_the_ends() {
        let bands = [500.0, 450.0, 550.0, 450.0];
        for (wanted, expected) in [(450.0, 450.0), (476.0, 500.0), (426.0, 450.0), (574.0, 550.0)] {
            assert_eq!(choose_wavelength(&bands, Some(wanted)), Ok(expected));
        }
        for outside in [424.0, 576.0, f64::NAN] {
            assert!(choose_wavelength(&bands, Some(outside)).is_err(), "{outside}");
        }
        assert_eq!((choose_wavelength(&[632.8], Some(633.0)), choose_wavelength(&[632.8], None)), (Ok(632.8), Ok(632.8)));
        assert!(choose_wavelength(&[632.8], Some(650.0)).is_err() && choose_wavelength(&[], Some(650.0)).is_err());
        let error = choose_wavelength(&bands, None).expect_err("a choice is needed").to_string();
        assert!(error.contains("3 wavelengths, 450, 500, 550 nm"), "{error}");
    }
}
