//! The pages of the menu Help; the words of the window are in the glossary.

/// A page of help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Help {
    FirstSteps,
    Words,
    About,
}

impl Help {
    pub const fn heading(self) -> &'static str {
        match self {
            Self::FirstSteps => "First steps",
            Self::Words => "Words",
            Self::About => "About pbrdf-explorer",
        }
    }
}

/// From a file to a fit, and where the other language is.
pub const FIRST_STEPS: [&str; 6] = [
    "Open: drop files on the window, or choose File › Open measurements…; a table of another program asks what its columns are. Each comes to the list at the left.",
    "Bring the curves near the points by eye with the sliders on the left; ΔE at the lower left says how near they are.",
    "Fix: tick “fixed” beside every value that you know.",
    "Fit: press Fit on the right, or F5, and read there the values with their standard errors and what the data leave open.",
    "Export: File › Export writes plots, curves and a report; File › Save session keeps everything in one file.",
    "The window speaks Chinese too: View › Language.",
];

/// Name of the program in the title of its window.
pub const TITLE: &str = "pBRDF explorer";

/// The paper of the model, and where it is found.
pub const PAPER: &str = "F. Wang et al., Polarization bidirectional reflection distribution function of metal surfaces based on diffuse reflection optimization, Acta Optica Sinica 41(11), 1129002 (2021)";
pub const DOI: &str = "10.3788/AOS202141.1129002";
