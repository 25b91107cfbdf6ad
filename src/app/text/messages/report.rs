//! Reports of fits and benchmarks in the language of the window.

use crate::app::text::i18n::{self, Language, label, translated};
use crate::app::text::localized::Localized;
use crate::app::text::messages::selftest::short_method;
use crate::report::ReportLanguage;
use pbrdf::fit::{JointUnknown, StopReason, Undetermined};
use pbrdf::model::Finding;
use pbrdf::selftest::BenchmarkMethod;

/// The language of the window.
pub struct WindowWording;

impl ReportLanguage for WindowWording {
    fn language(&self) -> Option<&'static str> {
        match i18n::current() {
            Language::English => None,
            Language::Chinese => Some("zh-CN"),
        }
    }

    fn text(&self, english: &str) -> String {
        translated(english)
    }

    fn label(&self, text: &str) -> String {
        label(text)
    }

    fn stop_reason(&self, reason: StopReason) -> String {
        reason.localized()
    }

    fn undetermined(&self, what: &Undetermined) -> String {
        what.localized()
    }

    fn undetermined_jointly(&self, what: &Undetermined<JointUnknown>) -> String {
        what.localized()
    }

    fn finding(&self, finding: &Finding) -> String {
        finding.localized()
    }

    fn method(&self, method: BenchmarkMethod) -> String {
        short_method(method)
    }
}
