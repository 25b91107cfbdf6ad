//! The messages of the core and of the program in the language of the window.
//!
//! Errors, verdicts and notes are values. The file of their module here has a sentence for each by
//! an exhaustive match: a variant without a sentence does not compile. That is why enums of
//! messages are not `#[non_exhaustive]`.

mod files;
mod fit;
mod measurement;
mod model;
mod posterior;
mod report;
mod selftest;
mod system;

pub use measurement::advised;
pub use model::quoted;
pub use report::WindowWording;
pub use selftest::short_method;
