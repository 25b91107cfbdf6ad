//! What a dialog for files is told, and what it answers.

use std::path::PathBuf;

/// A dialog that asks for a path.
#[derive(Debug, Clone)]
pub struct FileDialog {
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "browsers word their own dialogs"))]
    pub title: String,
    pub purpose: PathPurpose,
    pub filters: Vec<FileFilter>,
}

/// What the path is for.
#[derive(Debug, Clone)]
pub enum PathPurpose {
    /// The file exists and is read.
    Open,
    /// The same of one file or several.
    OpenSeveral,
    /// The folder exists and is read.
    OpenFolder,
    /// The file is written; the dialog suggests a name and asks before an existing file is
    /// replaced.
    Save { suggested_name: String },
}

/// Files that a dialog offers.
#[derive(Debug, Clone)]
pub struct FileFilter {
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "browsers word their own dialogs"))]
    pub name: String,
    /// Without dots; `*` for any file.
    pub extensions: Vec<&'static str>,
}

/// Neither the desktop's portal nor zenity opened a dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DialogUnavailable;

/// What comes to a page apart from the events of its window.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(target_arch = "wasm32"), expect(dead_code, reason = "nothing comes to a desktop this way"))]
pub enum Arrival {
    /// A file that the user picked or dropped, by its path.
    File(PathBuf),
    /// A link that is to be opened.
    Link(String),
}
