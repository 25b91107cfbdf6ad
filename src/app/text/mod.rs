//! Texts: two languages, the glossary, numbers.

pub mod glossary;
pub mod i18n;
pub mod messages;
pub mod phrases;
