//! Messages of the operating system and of JSON.

use crate::app::text::localized::Localized;
use crate::figure::PngError;
use std::io::ErrorKind;
use tr::tr;

/// The usual kinds have a sentence; the text of the others is the system's own, in its language.
impl Localized for std::io::Error {
    fn localized(&self) -> String {
        match self.kind() {
            ErrorKind::NotFound => tr!("there is no such file or folder"),
            ErrorKind::PermissionDenied => tr!("permission is denied"),
            ErrorKind::IsADirectory => tr!("this is a folder"),
            ErrorKind::NotADirectory => tr!("a part of the path is no folder"),
            ErrorKind::ReadOnlyFilesystem => tr!("the file system is read-only"),
            ErrorKind::StorageFull => tr!("the disk is full"),
            ErrorKind::QuotaExceeded => tr!("the quota is exceeded"),
            ErrorKind::InvalidData => tr!("the text is not UTF-8"),
            _ => match self.get_ref().and_then(|inner| inner.downcast_ref::<PngError>()) {
                Some(error) => error.localized(),
                None => self.to_string(),
            },
        }
    }
}

/// What is wrong, with the parser's own words and place in backquotes.
impl Localized for serde_json::Error {
    fn localized(&self) -> String {
        use serde_json::error::Category;
        match self.classify() {
            Category::Io => tr!("reading failed: {}", self),
            Category::Syntax => tr!("this is no JSON: {}", self),
            Category::Data => tr!("a value is not as expected: {}", self),
            Category::Eof => tr!("the file ends early: {}", self),
        }
    }
}
