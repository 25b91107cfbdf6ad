//! An unknown of a joint fit.

use crate::fit::fit_problem::UnknownName;
use crate::model::Parameter;
use serde::{Serialize, Serializer};
use std::borrow::Cow;
use std::sync::Arc;

/// A parameter that all measurements share, or that one has for itself.
///
/// As JSON it is its key, `n` or `n@B.csv`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JointUnknown {
    /// Which parameter.
    pub parameter: Parameter,
    /// The name of the measurement; none where all share it.
    pub set: Option<Arc<str>>,
}

impl UnknownName for JointUnknown {
    fn parameter(&self) -> Parameter {
        self.parameter
    }

    fn set(&self) -> Option<&str> {
        self.set.as_deref()
    }

    fn key(&self) -> Cow<'_, str> {
        self.named(self.parameter.key())
    }

    fn symbol(&self) -> Cow<'_, str> {
        self.named(self.parameter.symbol())
    }
}

impl From<Parameter> for JointUnknown {
    fn from(parameter: Parameter) -> Self {
        Self { parameter, set: None }
    }
}

impl JointUnknown {
    /// The unknown of any problem: of one measurement all are shared.
    #[must_use]
    pub fn of(name: &impl UnknownName) -> Self {
        Self { parameter: name.parameter(), set: name.set().map(Arc::from) }
    }

    fn named(&self, name: &'static str) -> Cow<'_, str> {
        self.set.as_ref().map_or(Cow::Borrowed(name), |set| Cow::Owned(format!("{name}@{set}")))
    }
}

impl Serialize for JointUnknown {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.key())
    }
}
