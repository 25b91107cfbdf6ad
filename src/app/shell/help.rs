//! What the menu Help tells: first steps, the words of the window, and about the program.

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
    "Open: drop a CSV file on the window, or choose File › Open measurement…; it needs the columns theta_i and theta_r in degrees and dolp or brdf.",
    "Bring the curves near the points by eye with the sliders on the left; ΔE at the lower left says how near they are.",
    "Fix: tick “fixed” beside every value that you know.",
    "Fit: press Fit on the right, or F5, and read there the values with their standard errors and what the data leave open.",
    "Export: File › Export writes plots, curves and a report; File › Save session keeps everything in one file.",
    "The window speaks Chinese too: View › Language.",
];

/// Words and signs of the window with their meaning.
pub const WORDS: [(&str, &str); 13] = [
    (
        "DoLP",
        "Degree of linear polarisation of what is reflected when the light that falls in is not polarised: 0 is none, 1 is all, Eq. (17).",
    ),
    (
        "ΔE",
        "How far the model is from the measurement: the sum of squared differences over the sum of squared measured values, Eq. (18); 0 is no difference.",
    ),
    (
        "θi, θr, Δφ",
        "Angles of incidence and of view, from the surface normal, and the azimuth between them; Δφ = 180° is the side of the mirror direction, a negative θr the side that the light comes from.",
    ),
    (
        "open, undetermined",
        "A value that the data do not determine, alone or together with others: it can change much and the misfit hardly grows. Then no error is printed for it.",
    ),
    ("at bound", "The fit ended at the edge of what it may choose: the best value may lie beyond, and no error can be stated."),
    ("limit", "What a number of a report or of the audit has to keep in order to pass."),
    ("mask", "Takes a measured point out of the fit and of every statistic; it stays in the table and can be taken back."),
    ("ghost", "The faint dotted curve of the last fit, which stays in view while the sliders move on."),
    ("cases", "The stiff and extreme cases on which the program tests its own values and fits."),
    ("Fresnel limit", "DoLP of the bare mirror facets with this n and k: the dashed curve. The other lobes can only lower DoLP below it."),
    (
        "lobes",
        "The parts that the reflected light is made of: the specular lobe around the mirror direction, which polarises, and the diffuse and the volume lobe, which do not.",
    ),
    ("facets", "The small mirrors that the rough surface is thought to be made of; σ is the scale of their slopes."),
    ("landscape", "ΔE, or whatever else is minimised, over two parameters: a fit looks for its lowest place."),
];

/// Name of the program in the title of its window.
pub const TITLE: &str = "pBRDF explorer";

/// The paper of the model, and where it is found.
pub const PAPER: &str = "F. Wang et al., Polarization bidirectional reflection distribution function of metal surfaces based on diffuse reflection optimization, Acta Optica Sinica 41(11), 1129002 (2021)";
pub const DOI: &str = "10.3788/AOS202141.1129002";
