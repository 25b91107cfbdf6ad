//! A work as a link: everything stands behind the `#` of an address, which no browser sends to a
//! server.
//!
//! The fragment is `pbrdf` with the version of the link, a dot, and packed JSON: the language of the
//! window, the lesson with its step if one is open, and the work as a session. Where that would be
//! too long, fits are left out, then measurements.

use crate::app::storage::session::Session;
use crate::app::storage::session_error::{JsonError, SessionError};
use crate::app::storage::session_file::OpenedSession;
use crate::app::text::i18n::Language;
use crate::app::text::localized::Localized;
use crate::files::packed;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use std::io;
use tr::tr;

/// How the fragment of a link begins.
const MARK: &str = "#pbrdf";
/// Links of a later version are refused: they may mean something else. Earlier ones are read.
const VERSION: u32 = 1;
/// Letters behind the `#` at most. Browsers and the ways by which people send links take this many.
const MOST_LETTERS: usize = 32_000;
/// Bytes that a link is unpacked to at most.
const MOST_BYTES: usize = 16 << 20;

/// What a link holds.
#[derive(Debug)]
pub struct SharedWork {
    pub language: Language,
    /// Title of the lesson that is open, and its step from 0.
    pub lesson: Option<(String, usize)>,
    /// The work that is shown.
    pub work: Session,
}

/// The same with its fits restored.
pub struct OpenedLink {
    pub language: Language,
    pub lesson: Option<(String, usize)>,
    pub work: OpenedSession,
}

/// A fragment, and what was too long for it.
#[derive(Debug, PartialEq, Eq)]
pub struct Fragment {
    /// From the `#` on.
    pub text: String,
    pub left_out: LeftOut,
}

/// What a link leaves out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeftOut {
    Nothing,
    Fits,
    FitsAndMeasurements,
}

/// Why a text is no link to a work.
#[derive(Debug)]
pub enum LinkError {
    /// Nothing in it says that it is one.
    NoLink,
    /// It is of a version that this program does not read.
    Version { found: u32 },
    /// A part is missing or changed.
    Damaged,
    /// What it holds is not what a link holds.
    Json(JsonError),
    /// The work in it means nothing.
    Work(SessionError),
}

impl Localized for LinkError {
    fn localized(&self) -> String {
        match self {
            Self::NoLink => tr!("this is no link to a work"),
            Self::Version { found } => {
                tr!("the link is of version {0}; this program reads version {1}: a newer release opens it", found, VERSION)
            }
            Self::Damaged => tr!("the link is damaged: a part of it is missing or changed; copy all of it"),
            Self::Json(error) => error.localized(),
            Self::Work(error) => error.localized(),
        }
    }
}

#[derive(Serialize, Deserialize)]
struct Contents {
    language: Language,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lesson: Option<(String, usize)>,
    work: Box<RawValue>,
}

/// Whether a text holds a link to a work, of whatever version.
pub fn is_link(text: &str) -> bool {
    version_and_letters(text).is_some()
}

/// The version and what follows it, up to the end of the word.
fn version_and_letters(text: &str) -> Option<(u32, &str)> {
    let (_, fragment) = text.rsplit_once(MARK)?;
    let (version, letters) = fragment.split_once('.')?;
    let letters = letters.split(|letter: char| letter.is_whitespace() || "<>\"'".contains(letter)).next()?;
    Some((version.parse().ok()?, letters))
}

impl SharedWork {
    /// The fragment of the link.
    ///
    /// # Errors
    /// Memory takes no more.
    pub fn fragment(&self) -> io::Result<Fragment> {
        let whole = self.packed(&self.work)?;
        if whole.len() <= MOST_LETTERS {
            return Ok(Fragment { text: whole, left_out: LeftOut::Nothing });
        }
        let measured = self.packed(&self.work.without_fits())?;
        if measured.len() <= MOST_LETTERS {
            return Ok(Fragment { text: measured, left_out: LeftOut::Fits });
        }
        let text = self.packed(&self.work.without_measurements())?;
        Ok(Fragment { text, left_out: LeftOut::FitsAndMeasurements })
    }

    fn packed(&self, work: &Session) -> io::Result<String> {
        let work = RawValue::from_string(work.to_json()?)?;
        let contents = Contents { language: self.language, lesson: self.lesson.clone(), work };
        Ok(format!("{MARK}{VERSION}.{}", packed::pack(&serde_json::to_vec(&contents)?)))
    }

    /// Reads the link in a text.
    ///
    /// # Errors
    /// The text holds none, or it is damaged or too new.
    pub fn read(text: &str) -> Result<Self, LinkError> {
        let (found, letters) = version_and_letters(text).ok_or(LinkError::NoLink)?;
        if !(1..=VERSION).contains(&found) {
            return Err(LinkError::Version { found });
        }
        let bytes = packed::unpack(letters, MOST_BYTES).ok_or(LinkError::Damaged)?;
        let Contents { language, lesson, work } = serde_json::from_slice(&bytes).map_err(|error| LinkError::Json(error.into()))?;
        let work = Session::read(work.get()).map_err(LinkError::Work)?;
        Ok(Self { language, lesson, work })
    }
}

impl OpenedLink {
    /// Reads the link in a text, and restores its fits.
    ///
    /// # Errors
    /// As [`SharedWork::read`] has it; a sentence.
    pub fn read(text: &str) -> Result<Self, String> {
        let SharedWork { language, lesson, work } =
            SharedWork::read(text).map_err(|error| tr!("The link cannot be opened: {}.", error.localized()))?;
        Ok(Self { language, lesson, work: OpenedSession::new(work) })
    }
}
