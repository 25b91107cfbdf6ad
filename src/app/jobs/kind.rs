//! What is done off the window's thread, and what is said where it comes to nothing.

use tr::tr;

/// A kind of job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobKind {
    Dialog,
    Read,
    ReadSession,
    ImportDialog,
    Save,
    Export,
    Autosave,
    Fit,
    Refit,
    Compare,
    Profile,
    Bootstrap,
    Report,
}

impl JobKind {
    /// The name of its thread.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dialog => "dialog",
            Self::Read => "read measurement",
            Self::ReadSession => "read session",
            Self::ImportDialog => "import measurement",
            Self::Save => "save measurement",
            Self::Export => "export",
            Self::Autosave => "autosave",
            Self::Fit => "fit",
            Self::Refit => "refit",
            Self::Compare => "compare models",
            Self::Profile => "profile",
            Self::Bootstrap => "bootstrap",
            Self::Report => "report",
        }
    }

    /// That it panicked, in a sentence.
    pub fn broken(self) -> String {
        match self {
            Self::Dialog => tr!("The file dialog ended unexpectedly; nothing was lost."),
            Self::Read | Self::ReadSession | Self::ImportDialog => tr!("Reading the file ended unexpectedly; what is open stays."),
            Self::Save | Self::Export => tr!("Writing the file ended unexpectedly; a file that was there is as it was."),
            Self::Autosave => tr!("Saving the working state ended unexpectedly; it is saved again after the next change."),
            Self::Fit | Self::Refit => tr!("The fit ended unexpectedly; nothing was lost."),
            Self::Compare => tr!("The comparison of the models ended unexpectedly; nothing was lost."),
            Self::Profile => tr!("The profile ended unexpectedly; nothing was lost."),
            Self::Bootstrap => tr!("The bootstrap ended unexpectedly; nothing was lost."),
            Self::Report => tr!("The report ended unexpectedly; the one before it stays."),
        }
    }
}
