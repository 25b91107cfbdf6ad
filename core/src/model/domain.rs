//! The values that a parameter may have.

/// Values that a parameter may have, both ends included.
///
/// The domains end where no surface is, and so far inside the range of f64 that no product of the model leaves it but
/// where a lobe itself does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Domain {
    /// From the first to the second.
    Between(f64, f64),
    /// 0, or from the first to the second.
    ZeroOrBetween(f64, f64),
}

impl Domain {
    /// Whether a value lies in it.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        match self {
            Self::Between(low, high) => (low..=high).contains(&value),
            Self::ZeroOrBetween(low, high) => value == 0.0 || (low..=high).contains(&value),
        }
    }

    /// 0 for a value between 0 and the smallest other one of the domain; any other value unchanged.
    #[must_use]
    pub fn flush_to_zero(self, value: f64) -> f64 {
        match self {
            Self::ZeroOrBetween(low, _) if value > 0.0 && value < low => 0.0,
            _ => value,
        }
    }

    /// The smallest and the largest value beside 0 as text, for messages.
    #[must_use]
    pub fn ends(self) -> (String, String) {
        let (Self::Between(low, high) | Self::ZeroOrBetween(low, high)) = self;
        (short(low), short(high))
    }
}

impl std::fmt::Display for Domain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (low, high) = self.ends();
        match self {
            Self::Between(..) => write!(f, "a number from {low} to {high}"),
            Self::ZeroOrBetween(..) => write!(f, "0 or a number from {low} to {high}"),
        }
    }
}

/// An end of a domain, with an exponent where it is long without.
fn short(end: f64) -> String {
    if end == 0.0 || (1e-3..1e4).contains(&end.abs()) { end.to_string() } else { format!("{end:e}") }
}

#[cfg(test)]
mod tests {
    use super::Domain;

    #[test]
    fn a_domain_contains_its_ends_and_nothing_beyond() {
        for (domain, low, high) in [(Domain::Between(-2.0, 3.0), -2.0, 3.0), (Domain::ZeroOrBetween(1e-100, 1e100), 1e-100, 1e100)] {
            assert!(domain.contains(low) && domain.contains(high));
            assert!(!domain.contains(f64::next_down(low)) && !domain.contains(f64::next_up(high)) && !domain.contains(f64::NAN));
        }
        assert!(Domain::ZeroOrBetween(1e-100, 1e100).contains(0.0));
    }

    #[test]
    fn a_domain_says_its_ends() {
        assert_eq!(Domain::ZeroOrBetween(1e-100, 1e100).to_string(), "0 or a number from 1e-100 to 1e100");
        assert_eq!(Domain::Between(1.000_000_000_001, 1e12).to_string(), "a number from 1.000000000001 to 1e12");
        assert_eq!(Domain::Between(-1e3, 0.0).to_string(), "a number from -1000 to 0");
    }

    #[test]
    fn what_is_smaller_than_the_smallest_weight_is_flushed_to_zero() {
        let domain = Domain::ZeroOrBetween(1e-100, 1e100);
        assert_eq!([0.0, 1e-101, 1e-100, -1.0].map(|weight| domain.flush_to_zero(weight)), [0.0, 0.0, 1e-100, -1.0]);
        assert_eq!(Domain::Between(1e-30, 1e30).flush_to_zero(1e-40), 1e-40);
    }
}
