//! The language of a report.

use pbrdf::fit::{JointUnknown, StopReason, Undetermined};
use pbrdf::model::Finding;
use pbrdf::selftest::BenchmarkMethod;
use std::fmt::Display;

/// Says the texts and messages of a report in one language.
pub trait ReportLanguage {
    /// Code of the language where it is not English.
    fn language(&self) -> Option<&'static str>;

    /// A text of the report, or a template with the holes `{0}`, `{1}`, …
    fn text(&self, english: &str) -> String;

    /// A text of a figure, which may be data that no language changes.
    fn label(&self, text: &str) -> String;

    /// Why a fit ended.
    fn stop_reason(&self, reason: StopReason) -> String;

    /// What data leave open.
    fn undetermined(&self, what: &Undetermined) -> String;

    /// What the data of several measurements leave open.
    fn undetermined_jointly(&self, what: &Undetermined<JointUnknown>) -> String;

    /// Why a finding of the audit is as it is.
    fn finding(&self, finding: &Finding) -> String;

    /// A method in a legend.
    fn method(&self, method: BenchmarkMethod) -> String;
}

impl dyn ReportLanguage + '_ {
    /// A template with values in its holes.
    pub(crate) fn fill(&self, english: &str, values: &[&dyn Display]) -> String {
        let template = self.text(english);
        let mut parts = template.split('{');
        let mut text = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let (hole, rest) = part.split_once('}').unwrap_or((part, ""));
            text.extend(hole.parse::<usize>().ok().and_then(|hole| values.get(hole)).map(ToString::to_string));
            text.push_str(rest);
        }
        text
    }

    /// Parts with commas between them.
    pub(crate) fn list(&self, parts: &[String]) -> String {
        parts.join(&self.text(", "))
    }
}

/// English: texts as they stand in the program, messages as `Display` says them.
#[derive(Debug, Clone, Copy)]
pub struct English;

impl ReportLanguage for English {
    fn language(&self) -> Option<&'static str> {
        None
    }

    fn text(&self, english: &str) -> String {
        english.to_owned()
    }

    fn label(&self, text: &str) -> String {
        text.to_owned()
    }

    fn stop_reason(&self, reason: StopReason) -> String {
        reason.text().to_owned()
    }

    fn undetermined(&self, what: &Undetermined) -> String {
        what.to_string()
    }

    fn undetermined_jointly(&self, what: &Undetermined<JointUnknown>) -> String {
        what.to_string()
    }

    fn finding(&self, finding: &Finding) -> String {
        finding.why().to_owned()
    }

    fn method(&self, method: BenchmarkMethod) -> String {
        method.short_name()
    }
}
