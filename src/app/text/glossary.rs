//! The words of the window and what they mean, in the help and where the pointer rests.

use crate::app::text::explained::Explained as _;
use crate::app::text::i18n::translated;
use pbrdf::fit::EstimateStatus;
use tr::tr;

/// A word of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    pub word: &'static str,
    /// What it means, in whole sentences.
    pub meaning: &'static str,
}

impl Entry {
    /// The meaning in the language of the window.
    pub fn help(self) -> String {
        translated(self.meaning)
    }
}

pub const DELTA_E: Entry = Entry {
    word: "ΔE",
    meaning: "ΔE = Σ (X − Xm)² / Σ Xm², Eq. (18): the squared distance between model X and measurement Xm over that of the measurement from 0; with DoLP and BRDF measured, the sum of both. 0 is a perfect fit.",
};
pub const OPEN: Entry = Entry {
    word: "open, undetermined, not determined",
    meaning: "The data leave it open: quite other values, together with other parameters, fit as well, so that it has no standard error.",
};
pub const AT_BOUND: Entry = Entry {
    word: "at bound",
    meaning: "It rests on the end of its range: a better value may lie outside. There it has no linear error, and its interval is open on that side; the linear errors of the others hold only with it kept there.",
};
pub const INTERVAL: Entry = Entry {
    word: "interval",
    meaning: "The values of a parameter that the data allow, by profile likelihood: the parameter is held, all others are fitted again, and the misfit stays below what the level, 68.3 or 95 %, allows.",
};
pub const MASK: Entry =
    Entry { word: "mask", meaning: "Masked rows stay in the file and are shown, but count in no fit and no statistic." };
pub const AICC: Entry = Entry {
    word: "AICc",
    meaning: "Akaike's criterion, corrected for few data: the smaller, the better a model is worth its parameters on the same data. A difference below 2 means little, one above 10 decides.",
};

/// All words, in the order of the help.
pub const GLOSSARY: [Entry; 23] = [
    Entry {
        word: "DoLP",
        meaning: "Degree of linear polarisation of what is reflected when the light that falls in is not polarised: 0 is none, 1 is all, Eq. (17).",
    },
    DELTA_E,
    Entry {
        word: "θi, θr, Δφ",
        meaning: "Angles of incidence and of view, from the surface normal, and the azimuth between them; Δφ = 180° is the side of the mirror direction, a negative θr the side that the light comes from.",
    },
    OPEN,
    AT_BOUND,
    INTERVAL,
    Entry { word: "limit", meaning: "What a number of a report or of the audit has to keep in order to pass." },
    MASK,
    Entry { word: "ghost", meaning: "The faint dotted curve of the last fit, which stays in view while the sliders move on." },
    Entry { word: "cases", meaning: "The stiff and extreme cases on which the program tests its own values and fits." },
    Entry {
        word: "Fresnel limit",
        meaning: "DoLP of the bare mirror facets with this n and k: the dashed curve. The other lobes can only lower DoLP below it.",
    },
    Entry {
        word: "lobes",
        meaning: "The parts that the reflected light is made of: the specular lobe around the mirror direction, which polarises, and the diffuse and the volume lobe, which do not.",
    },
    Entry {
        word: "facets", meaning: "The small mirrors that the rough surface is thought to be made of; σ is the scale of their slopes."
    },
    Entry { word: "landscape", meaning: "ΔE, or whatever else is minimised, over two parameters: a fit looks for its lowest place." },
    AICC,
    PROFILE,
    Entry {
        word: "bootstrap",
        meaning: "The fit repeated on many sets of data that are made from it and its residuals: how far the values scatter.",
    },
    Entry {
        word: "loss",
        meaning: "How much a residual counts: squared, or less for large ones, so that a few wrong points do not lead the fit.",
    },
    Entry {
        word: "standard error",
        meaning: "Half of the range that holds the value in about two of three repetitions of the measurement, if the misfit is a parabola around its lowest place.",
    },
    Entry { word: "ladder", meaning: "The models from the simplest to the one with all nine parameters, fitted to the same data." },
    Entry { word: "start", meaning: "A set of values that a fit begins at; several look for several lowest places." },
    Entry { word: "box", meaning: "The bounds of all parameters together: fits stay inside." },
    Entry {
        word: "DoLP_s, half at …°",
        meaning: "DoLP_s is that of the facets alone, the Fresnel limit. Half at: the tilt of facets that half of all stay below.",
    },
];

pub const PROFILE: Entry = Entry {
    word: "profile",
    meaning: "The lowest misfit at each value of one parameter, all others fitted again: the values where it is low enough are the interval.",
};

/// What ΔE is.
pub fn delta_e_help() -> String {
    DELTA_E.help()
}

/// What the status of an estimate means.
pub fn standing_help(standing: EstimateStatus) -> String {
    match standing {
        EstimateStatus::Fixed => tr!("The fit left it as it was."),
        EstimateStatus::AtBound(_) => AT_BOUND.help(),
        EstimateStatus::Determined(_) => tr!("One standard error, linearised at the solution"),
        EstimateStatus::Within(_) => tr!("The interval at 68.3 %, by profile likelihood: this parameter held, all others fitted again"),
        EstimateStatus::UncertaintyUnknown => {
            tr!("As many values as free parameters (no degree of freedom): nothing is left over to tell an error from.")
        }
        EstimateStatus::Undetermined => OPEN.help(),
    }
}

/// What it means that data leave a parameter open.
pub fn open_help() -> String {
    OPEN.help()
}

/// Headings of a list of minima.
pub fn minima_headings_ui(ui: &mut egui::Ui) {
    ui.strong("ΔE").explained(delta_e_help());
    ui.strong(tr!("reached")).explained(tr!("How many of the starts ended there"));
    ui.strong(tr!("stop")).explained(tr!("Why the best of them went no further"));
}

/// What AICc is.
pub fn aicc_help() -> String {
    AICC.help()
}

/// What a mask is.
pub fn mask_help() -> String {
    MASK.help()
}

/// That there are fewer measured values than free parameters, if so.
pub fn too_few(values: usize, free: usize) -> Option<String> {
    (values < free).then(|| {
        tr!(
            "{0} measured values cannot determine {1} free parameters: tick fixed for what you know, or measure at more angles.",
            values,
            free
        )
    })
}
