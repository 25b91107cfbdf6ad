//! Texts: two languages, the glossary, numbers.

pub mod estimate;
pub mod explained;
pub mod glossary;
pub mod help;
pub mod i18n;
pub mod localized;
pub mod messages;
pub mod numbers;
