//! An interval that a parameter lies in, with open sides.

use serde::{Deserialize, Serialize, Serializer};

/// The values of a parameter that the data allow at a level of confidence, in its own unit.
///
/// As JSON it is `[low, high]`, null on an open side: there the bound of the parameter comes before the limit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(from = "[Option<f64>; 2]")]
pub struct Interval {
    /// Lower end; none where the interval is open below.
    pub low: Option<f64>,
    /// Upper end; none where the interval is open above.
    pub high: Option<f64>,
}

impl Interval {
    /// Open on both sides: the data say nothing.
    pub const OPEN: Self = Self { low: None, high: None };

    /// Whether it is open on both sides.
    #[must_use]
    pub fn is_open(&self) -> bool {
        *self == Self::OPEN
    }

    /// Whether it has both ends.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.low.is_some() && self.high.is_some()
    }

    /// Whether a value lies in it.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        self.low.is_none_or(|low| low <= value) && self.high.is_none_or(|high| value <= high)
    }
}

impl From<[Option<f64>; 2]> for Interval {
    fn from([low, high]: [Option<f64>; 2]) -> Self {
        Self { low, high }
    }
}

impl Serialize for Interval {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        [self.low, self.high].serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    #[test]
    fn an_open_side_holds_everything_beyond() {
        let above = Interval { low: Some(1.2), high: None };
        assert!(above.contains(1.2) && above.contains(1e9) && !above.contains(1.1) && !above.is_open());
        assert_eq!(serde_json::to_string(&above).unwrap(), "[1.2,null]");
        assert_eq!(serde_json::from_str::<Interval>("[null,null]").unwrap(), Interval::OPEN);
    }
}
