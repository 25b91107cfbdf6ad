//! The ladder of models to compare: one core, different terms switched on.

use crate::model::{Diffuse, DolpFormula, Model};
use crate::optics::Masking::VGroove;
use crate::optics::SlopeDistribution::{Cauchy, Gauss};
use crate::optics::{Masking, SlopeDistribution};

/// A model with a name and a source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preset {
    /// Name in options and JSON.
    pub key: &'static str,
    /// Name for people.
    pub name: &'static str,
    /// Where it comes from.
    pub citation: &'static str,
    /// Its terms.
    pub model: Model,
    /// It speaks of DoLP alone.
    pub dolp_only: bool,
}

const fn model(distribution: SlopeDistribution, masking: Masking, diffuse: Diffuse, volume: bool) -> Model {
    Model { distribution, masking, specular: true, diffuse, volume, dolp_formula: DolpFormula::Consistent }
}

/// All presets, from the fewest terms to the most.
pub const PRESETS: [Preset; 10] = [
    Preset {
        key: "fresnel",
        name: "Fresnel reflection alone (Thilak)",
        citation: "Thilak, Voelz, Creusere, Appl. Opt. 46(30), 7527 (2007)",
        model: model(Gauss, VGroove, Diffuse::Absent, false),
        dolp_only: true,
    },
    Preset {
        key: "priest-germer",
        name: "Gauss facets without masking (Priest–Germer)",
        citation: "Priest, Germer, Proc. MSS (2000)",
        model: model(Gauss, Masking::None, Diffuse::Absent, false),
        dolp_only: false,
    },
    Preset {
        key: "specular",
        name: "Cauchy facets with masking",
        citation: "the specular part of Wang et al. 2021",
        model: model(Cauchy, VGroove, Diffuse::Absent, false),
        dolp_only: false,
    },
    Preset {
        key: "specular-gauss",
        name: "Gauss facets with masking",
        citation: "the specular part of Wang et al. 2021",
        model: model(Gauss, VGroove, Diffuse::Absent, false),
        dolp_only: false,
    },
    Preset {
        key: "hyde",
        name: "Gauss facets, and what they lose as depolarised light (Hyde)",
        citation: "Hyde, Schmidt, Havrilla, Opt. Express 17(24), 22138 (2009)",
        model: model(Gauss, VGroove, Diffuse::Hyde, false),
        dolp_only: false,
    },
    Preset {
        key: "lambert",
        name: "two components, Lambertian diffuse",
        citation: "Torrance–Sparrow with a Lambertian term",
        model: model(Gauss, VGroove, Diffuse::Lambert, false),
        dolp_only: false,
    },
    Preset {
        key: "minnaert",
        name: "two components, Minnaert diffuse (Zhu)",
        citation: "Zhu et al., Laser Optoelectron. Prog. 57(9), 092901 (2020)",
        model: model(Gauss, VGroove, Diffuse::Minnaert, false),
        dolp_only: false,
    },
    Preset {
        key: "three-component",
        name: "three components, Lambertian diffuse (Wang 2017)",
        citation: "Wang, Zhu, Liu, Chin. Phys. B 26(2), 024210 (2017)",
        model: model(Gauss, VGroove, Diffuse::Lambert, true),
        dolp_only: false,
    },
    Preset {
        key: "gauss",
        name: "the nine-parameter model, Gauss facets",
        citation: "Wang et al., Acta Opt. Sin. 41(11), 1129002 (2021)",
        model: Model::full(Gauss),
        dolp_only: false,
    },
    Preset {
        key: "cauchy",
        name: "the nine-parameter model, Cauchy facets",
        citation: "Wang et al., Acta Opt. Sin. 41(11), 1129002 (2021)",
        model: Model::full(Cauchy),
        dolp_only: false,
    },
];

impl Preset {
    /// The preset of that name.
    #[must_use]
    pub fn from_key(key: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.key == key)
    }

    /// The last preset with exactly these terms, whatever the formula of DoLP.
    #[must_use]
    pub fn of(model: Model) -> Option<&'static Self> {
        PRESETS.iter().rev().find(|preset| preset.has_terms_of(model))
    }

    /// The same of a fit, which tells whether the model spoke of DoLP alone.
    #[must_use]
    pub fn of_fit(model: Model, dolp_only: bool) -> Option<&'static Self> {
        let exact = PRESETS.iter().rev().find(|preset| preset.has_terms_of(model) && preset.dolp_only == dolp_only);
        exact.or_else(|| Self::of(model))
    }

    /// Whether a model has exactly these terms, whatever its formula of DoLP.
    #[must_use]
    pub fn has_terms_of(&self, model: Model) -> bool {
        self.model.with_dolp_formula(model.dolp_formula) == model
    }
}
