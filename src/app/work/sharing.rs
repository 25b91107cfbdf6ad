//! Which parameters the surfaces of several measurements share.

use crate::app::work::open_measurement::OpenMeasurement;
use pbrdf::model::{Parameter, ParameterSet};

/// What the open measurements have in common, in the user's words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sharing {
    /// n and k are each measurement's own.
    Wavelengths,
    /// All parameters are.
    Samples,
    /// None is.
    OneDataSet,
}

impl Sharing {
    pub const ALL: [Self; 3] = [Self::Wavelengths, Self::Samples, Self::OneDataSet];

    pub fn name(self) -> &'static str {
        match self {
            Self::Wavelengths => "one sample at several wavelengths",
            Self::Samples => "different samples",
            Self::OneDataSet => "one data set",
        }
    }

    pub fn help(self) -> &'static str {
        match self {
            Self::Wavelengths => "n and k are each measurement's own; all other parameters are shared",
            Self::Samples => "all parameters are each measurement's own: separate fits",
            Self::OneDataSet => "all parameters are shared: the same as one table with all rows",
        }
    }

    /// The shared parameters.
    pub fn shared(self) -> ParameterSet {
        match self {
            Self::Wavelengths => ParameterSet::ALL.without(Parameter::N).without(Parameter::K),
            Self::Samples => ParameterSet::EMPTY,
            Self::OneDataSet => ParameterSet::ALL,
        }
    }

    /// The one that shares those parameters, if one of them does.
    pub fn of(shared: ParameterSet) -> Option<Self> {
        Self::ALL.into_iter().find(|sharing| sharing.shared() == shared)
    }

    /// What files say of their measurements: one material, or one set of one table, at several wavelengths; else different samples.
    pub fn stated<'a>(mut measurements: impl Iterator<Item = &'a OpenMeasurement> + Clone) -> Self {
        let Some(first) = measurements.next() else { return Self::Samples };
        let material = |open: &OpenMeasurement| open.measurement.metadata("material").map(str::to_lowercase);
        let is_one_set = |open: &OpenMeasurement| {
            open.sha256.is_some() && open.sha256 == first.sha256 && open.measurement.name == first.measurement.name
        };
        let is_one_sample = |open: &OpenMeasurement| {
            material(open) == material(first) && (material(first).is_some() || is_one_set(open)) && open.wavelength_nm().is_some()
        };
        let wavelength = first.wavelength_nm();
        let differ = measurements.clone().any(|open| open.wavelength_nm() != wavelength);
        if wavelength.is_some() && differ && measurements.all(is_one_sample) { Self::Wavelengths } else { Self::Samples }
    }
}

#[cfg(test)]
mod tests {
    use super::{OpenMeasurement, Sharing};
    use pbrdf::measurement::Measurement;

    fn of(metadata: &[(&str, &str)]) -> OpenMeasurement {
        let metadata = metadata.iter().map(|&(key, value)| (key.to_owned(), value.to_owned())).collect();
        OpenMeasurement::new(String::new(), Measurement { metadata, ..Measurement::default() })
    }

    #[test]
    fn one_material_at_several_wavelengths_is_one_sample() {
        let red = of(&[("material", "Copper"), ("wavelength_nm", "650")]);
        let blue = of(&[("material", "copper"), ("wavelength_nm", "450")]);
        let steel = of(&[("material", "steel"), ("wavelength_nm", "450")]);
        let unknown = of(&[("material", "copper")]);
        let nothing = of(&[("wavelength_nm", "650")]);
        for (measurements, expected) in [
            (vec![&red, &blue], Sharing::Wavelengths),
            (vec![&red, &blue, &blue], Sharing::Wavelengths),
            (vec![&red, &red], Sharing::Samples),
            (vec![&red, &steel], Sharing::Samples),
            (vec![&red, &unknown], Sharing::Samples),
            (vec![&nothing, &blue], Sharing::Samples),
        ] {
            assert_eq!(Sharing::stated(measurements.into_iter()), expected);
        }
    }

    #[test]
    fn a_set_of_shared_parameters_is_known_by_its_name() {
        for sharing in Sharing::ALL {
            assert_eq!(Sharing::of(sharing.shared()), Some(sharing));
        }
        assert_eq!(Sharing::of(Sharing::OneDataSet.shared().without(pbrdf::model::Parameter::N)), None);
    }
}
