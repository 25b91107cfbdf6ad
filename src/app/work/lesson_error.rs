//! What is wrong with the text of a lesson, and where.

use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized;
use crate::app::text::messages::quoted;
use pbrdf::model::AssignmentError;
use tr::tr;

/// Why a text is no lesson, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct LessonError {
    /// Line of the file, from 1.
    pub line: usize,
    /// What is wrong there.
    pub kind: LessonErrorKind,
}

/// What is wrong with a line of a lesson.
#[derive(Debug, Clone, PartialEq)]
pub enum LessonErrorKind {
    /// Neither `key: text` nor an indented line.
    Form(String),
    /// A key that means nothing here.
    Key {
        /// The key.
        found: String,
        /// What may stand there.
        expected: &'static str,
    },
    /// A key given twice in one step.
    Twice(String),
    /// A key without a text.
    Empty(String),
    /// A language where there is nothing to translate.
    Language(String),
    /// No such model.
    Model(String),
    /// No such parameter, or a value that it cannot have.
    Set(AssignmentError),
    /// No `name=low..high`.
    Range(String),
    /// Ends in the wrong order.
    Order {
        /// The lower end.
        low: f64,
        /// The upper end.
        high: f64,
    },
    /// Not an angle in its range.
    Angle {
        /// What stands there.
        found: String,
        /// What is allowed.
        expected: &'static str,
    },
    /// No such metal.
    Metal(String),
    /// Not a wavelength.
    Wavelength(String),
    /// Neither yes nor no.
    YesOrNo(String),
    /// A setting that means nothing.
    Setting {
        /// What stands there.
        found: String,
        /// What may stand there.
        expected: &'static str,
    },
    /// No such bundled measurement; the first one is open in its place.
    Example(String),
    /// No such pane.
    Pane(String),
    /// A lesson needs a title.
    NoTitle,
    /// A lesson needs a step.
    NoStep,
}

impl From<AssignmentError> for LessonErrorKind {
    fn from(error: AssignmentError) -> Self {
        Self::Set(error)
    }
}

impl Localized for LessonError {
    fn localized(&self) -> String {
        tr!("line {0}: {1}", self.line, self.kind.localized())
    }
}

impl Localized for LessonErrorKind {
    fn localized(&self) -> String {
        match self {
            Self::Form(found) => {
                tr!("expected key: text, or an indented line that goes on with the text before, found {}", quoted(found))
            }
            Self::Key { found, expected } => tr!("{0} is not a key; expected one of {1}", quoted(found), expected),
            Self::Twice(found) => tr!("{} is given twice", quoted(found)),
            Self::Empty(found) => tr!("{} has no text", quoted(found)),
            Self::Language(found) => tr!("{} is not in a language of its own", quoted(found)),
            Self::Model(found) => tr!("{} is no model", quoted(found)),
            Self::Set(error) => error.localized(),
            Self::Range(found) => tr!("expected name=low..high, such as k=0..3, found {}", quoted(found)),
            Self::Order { low, high } => tr!("a slider from {0} to {1}: the first must be below the second", low, high),
            Self::Angle { found, expected } => tr!("{0} is no angle: expected {1}", quoted(found), translated(expected)),
            Self::Metal(found) => tr!("{} is no tabulated metal", quoted(found)),
            Self::Wavelength(found) => {
                tr!("{} is no wavelength: expected a positive number of nanometres", quoted(found))
            }
            Self::YesOrNo(found) => tr!("expected yes or no, found {}", quoted(found)),
            Self::Setting { found, expected } => tr!("found {0}, expected {1}", quoted(found), expected),
            Self::Example(found) => tr!("there is no bundled measurement {}", quoted(found)),
            Self::Pane(found) => tr!("there is no pane {}", quoted(found)),
            Self::NoTitle => tr!("the lesson has no title"),
            Self::NoStep => tr!("the lesson has no step"),
        }
    }
}
