//! Odds between two models from their evidence.

use crate::fit::posterior::evidence::LogEvidence;
use std::fmt;

/// Odds of one model against another on the same data, each model as likely as the other before them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Odds {
    /// Natural logarithm.
    pub log: f64,
    /// Its standard error.
    pub std_error: f64,
}

/// How much odds tell, in the grades of Kass and Raftery, J. Am. Stat. Assoc. 90, 773 (1995).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum OddsGrade {
    /// Up to 3 to 1, or within two standard errors.
    NotWorthMention,
    /// Up to 20 to 1.
    Positive,
    /// Up to 150 to 1.
    Strong,
    /// More than that.
    VeryStrong,
}

impl Odds {
    /// Of the first model against the second.
    #[must_use]
    pub fn new(one: LogEvidence, other: LogEvidence) -> Self {
        Self { log: one.value - other.value, std_error: libm::hypot(one.std_error, other.std_error) }
    }

    /// How much they tell, for whichever model they favour.
    #[must_use]
    pub fn grade(self) -> OddsGrade {
        let odds = libm::exp(self.log.abs());
        match () {
            () if odds <= 3.0 || self.log.abs() < 2.0 * self.std_error => OddsGrade::NotWorthMention,
            () if odds <= 20.0 => OddsGrade::Positive,
            () if odds <= 150.0 => OddsGrade::Strong,
            () => OddsGrade::VeryStrong,
        }
    }

    /// The odds of the model that they favour, as `12 : 1`.
    #[must_use]
    pub fn text(self) -> String {
        let log10 = self.log.abs() / std::f64::consts::LN_10;
        match log10 {
            _ if log10 < 1.0 => format!("{:.1} : 1", libm::exp10(log10)),
            _ if log10 < 4.0 => format!("{:.0} : 1", libm::exp10(log10)),
            _ => format!("10^{log10:.0} : 1"),
        }
    }
}

impl fmt::Display for OddsGrade {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotWorthMention => "not worth more than a bare mention",
            Self::Positive => "positive evidence",
            Self::Strong => "strong evidence",
            Self::VeryStrong => "very strong evidence",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Odds, OddsGrade};
    use crate::fit::posterior::evidence::LogEvidence;

    #[test]
    fn odds_are_said_in_words() {
        let of = |one: f64, other: f64| {
            let evidence = |value| LogEvidence { value, std_error: 0.03 };
            let odds = Odds::new(evidence(one), evidence(other));
            (odds.text(), odds.grade())
        };
        assert_eq!(of(10.0, 9.5), ("1.6 : 1".to_owned(), OddsGrade::NotWorthMention));
        assert_eq!(of(9.0, 10.0 + libm::log(12.0) - 1.0), ("12 : 1".to_owned(), OddsGrade::Positive));
        assert_eq!(of(4.0, 0.0), ("55 : 1".to_owned(), OddsGrade::Strong));
        assert_eq!(of(50.0, 0.0), ("10^22 : 1".to_owned(), OddsGrade::VeryStrong));
        let rough = Odds { log: 3.0, std_error: 2.0 };
        assert_eq!(rough.grade(), OddsGrade::NotWorthMention);
    }
}
