//! Sets of parameters.

use crate::model::Parameter;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A set of parameters: those a model uses, or those a fit may change.
///
/// A file holds the keys of its parameters; files of earlier releases hold a number whose bits stand for them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct ParameterSet(u16);

impl ParameterSet {
    /// No parameter.
    pub const EMPTY: Self = Self(0);
    /// All parameters.
    pub const ALL: Self = Self((1 << Parameter::COUNT) - 1);

    /// Whether a parameter is in it.
    #[must_use]
    pub fn contains(self, parameter: Parameter) -> bool {
        self.0 & (1 << parameter as u16) != 0
    }

    /// With one parameter more.
    #[must_use]
    pub fn with(self, parameter: Parameter) -> Self {
        Self(self.0 | 1 << parameter as u16)
    }

    /// With one parameter less.
    #[must_use]
    pub fn without(self, parameter: Parameter) -> Self {
        Self(self.0 & !(1 << parameter as u16))
    }

    /// The parameters in both.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The parameters in either.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Without those of another set.
    #[must_use]
    pub fn without_all(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// How many.
    #[must_use]
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Each in the order of [`Parameter::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Parameter> {
        Parameter::ALL.into_iter().filter(move |&parameter| self.contains(parameter))
    }
}

impl FromIterator<Parameter> for ParameterSet {
    fn from_iter<I: IntoIterator<Item = Parameter>>(parameters: I) -> Self {
        parameters.into_iter().fold(Self::EMPTY, Self::with)
    }
}

impl IntoIterator for ParameterSet {
    type Item = Parameter;
    type IntoIter = std::vec::IntoIter<Parameter>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter().collect::<Vec<_>>().into_iter()
    }
}

impl Serialize for ParameterSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de> Deserialize<'de> for ParameterSet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "a list of parameters")]
        enum Form {
            Keys(Vec<Parameter>),
            Bits(u16),
        }
        Ok(match Form::deserialize(deserializer)? {
            Form::Keys(parameters) => parameters.into_iter().collect(),
            Form::Bits(bits) => Self(bits & Self::ALL.0),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::ParameterSet;
    use crate::model::Parameter;

    #[test]
    fn sets_keep_what_was_put_in() {
        let set = ParameterSet::ALL.without(Parameter::Ks);
        assert_eq!(set.len(), Parameter::COUNT - 1);
        assert!(!set.contains(Parameter::Ks) && set.contains(Parameter::SigmaV));
        assert_eq!(set.with(Parameter::Ks), ParameterSet::ALL);
    }

    #[test]
    fn files_hold_keys_and_older_ones_bits() {
        let set: ParameterSet = [Parameter::Ks, Parameter::SigmaV].into_iter().collect();
        let text = serde_json::to_string(&set).expect("a list");
        assert_eq!(text, r#"["ks","sigma_v"]"#);
        for text in [text.as_str(), "264", r#"["SigmaV","Ks"]"#] {
            assert_eq!(serde_json::from_str::<ParameterSet>(text).expect("a set"), set, "{text}");
        }
        assert_eq!(serde_json::from_str::<ParameterSet>("511").expect("a set"), ParameterSet::ALL);
        assert!(serde_json::from_str::<ParameterSet>(r#"["m"]"#).is_err());
    }
}
