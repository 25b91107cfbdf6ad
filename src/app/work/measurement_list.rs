//! The open measurements, each with its surface.

use crate::app::work::open_measurement::OpenMeasurement;
use pbrdf::measurement::Measurement;
use pbrdf::model::{ParameterSet, Parameters};

/// The open measurements, one of which is active: panels and panes show it. Without data the list
/// holds one measurement without rows, whose surface the sliders move.
#[derive(Debug, Clone)]
pub struct MeasurementList {
    all: Vec<OpenMeasurement>,
    active: usize,
    /// The parameters that all surfaces share; the others are each surface's own.
    shared: ParameterSet,
}

impl MeasurementList {
    /// One measurement.
    pub fn single(measurement: OpenMeasurement) -> Self {
        Self { all: vec![measurement], active: 0, shared: ParameterSet::EMPTY }
    }

    /// Several measurements, the active one by its place; with the first active where there is none
    /// of that place.
    pub fn several(mut all: Vec<OpenMeasurement>, active: usize, shared: ParameterSet) -> Self {
        if all.is_empty() {
            all.push(OpenMeasurement::new(String::new(), Measurement::default()));
        }
        let active = if active < all.len() { active } else { 0 };
        Self { all, active, shared }
    }

    pub fn active(&self) -> &OpenMeasurement {
        &self.all[self.active]
    }

    pub fn active_mut(&mut self) -> &mut OpenMeasurement {
        &mut self.all[self.active]
    }

    /// The place of the active one.
    pub fn active_index(&self) -> usize {
        self.active
    }

    pub fn shared(&self) -> ParameterSet {
        self.shared
    }

    pub fn share(&mut self, shared: ParameterSet) {
        self.shared = shared;
    }

    pub fn iter(&self) -> std::slice::Iter<'_, OpenMeasurement> {
        self.all.iter()
    }

    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, OpenMeasurement> {
        self.all.iter_mut()
    }

    /// Gives the active surface these values; a shared parameter moves on all surfaces.
    pub fn set_parameters(&mut self, parameters: Parameters) {
        for parameter in self.shared {
            self.all.iter_mut().for_each(|other| other.surface.parameters[parameter] = parameters[parameter]);
        }
        self.active_mut().surface.parameters = parameters;
    }
}

#[cfg(test)]
mod tests {
    use super::{MeasurementList, OpenMeasurement, Parameters};
    use pbrdf::measurement::Measurement;
    use pbrdf::model::{Parameter, ParameterSet};

    #[test]
    fn a_shared_parameter_moves_on_all_surfaces_and_an_own_one_on_its_own() {
        let of = |name: &str| OpenMeasurement::new(name.to_owned(), Measurement::default());
        let mut list = MeasurementList::several(vec![of("a"), of("b")], 1, ParameterSet::EMPTY.with(Parameter::Sigma));
        list.set_parameters(Parameters { n: 1.5, sigma: 0.25, ..Parameters::default() });
        let values: Vec<(f64, f64)> = list.iter().map(|open| (open.surface.parameters.n, open.surface.parameters.sigma)).collect();
        assert_eq!((list.active().name.as_str(), values), ("b", vec![(Parameters::default().n, 0.25), (1.5, 0.25)]));
    }

    #[test]
    fn there_is_always_an_active_measurement() {
        let list = MeasurementList::several(Vec::new(), 7, ParameterSet::EMPTY);
        assert_eq!((list.iter().len(), list.active().measurement.rows.len()), (1, 0));
    }
}
