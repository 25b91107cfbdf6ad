//! One value for each parameter.

use crate::model::Parameter;
use serde::{Serialize, Serializer};
use std::ops::{Index, IndexMut};

/// A value of any kind for each parameter, in the order of [`Parameter::ALL`]; a file holds it under the keys of the parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PerParameter<T>(pub [T; Parameter::COUNT]);

impl<T> PerParameter<T> {
    /// From a function of the parameter.
    #[must_use]
    pub fn from_fn(value: impl FnMut(Parameter) -> T) -> Self {
        Self(Parameter::ALL.map(value))
    }

    /// The values, in the order of [`Parameter::ALL`].
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.0.iter()
    }

    /// A function of each value.
    #[must_use]
    pub fn map<U>(self, function: impl FnMut(T) -> U) -> PerParameter<U> {
        PerParameter(self.0.map(function))
    }
}

impl<T> Index<Parameter> for PerParameter<T> {
    type Output = T;

    fn index(&self, parameter: Parameter) -> &T {
        &self.0[parameter as usize]
    }
}

impl<T> IndexMut<Parameter> for PerParameter<T> {
    fn index_mut(&mut self, parameter: Parameter) -> &mut T {
        &mut self.0[parameter as usize]
    }
}

impl<T> IntoIterator for PerParameter<T> {
    type Item = T;
    type IntoIter = std::array::IntoIter<T, { Parameter::COUNT }>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a, T> IntoIterator for &'a PerParameter<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: Serialize> Serialize for PerParameter<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Parameter::ALL.into_iter().zip(self))
    }
}

#[cfg(test)]
mod tests {
    use super::PerParameter;
    use crate::model::Parameter;

    #[test]
    fn values_stand_under_their_parameters() {
        let mut keys = PerParameter::from_fn(Parameter::key);
        assert!(Parameter::ALL.into_iter().all(|parameter| keys[parameter] == parameter.key()));
        keys[Parameter::Ks] = "other";
        assert_eq!(keys.map(str::len)[Parameter::Ks], 5);
        assert_eq!(serde_json::to_value(keys).expect("a map")["ks"], "other");
    }
}
