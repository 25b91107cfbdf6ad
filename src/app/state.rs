//! What survives a restart.

use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};
use pbrdf::optics::{Geometry, SlopeDistribution};
use serde::{Deserialize, Serialize};

/// Light or dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Theme {
    /// As the desktop has it.
    System,
    Light,
    Dark,
}

impl Theme {
    pub const ALL: [Self; 3] = [Self::System, Self::Light, Self::Dark];

    pub fn name(self) -> &'static str {
        match self {
            Self::System => "As the desktop",
            Self::Light => "Light",
            Self::Dark => "Dark",
        }
    }
}

/// The settings of the last session: sliders, switches, window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    pub parameters: Parameters,
    pub model: Model,
    /// Parameters that a fit leaves alone.
    pub locked: ParameterSet,
    /// Angle of incidence of the lobes, degrees.
    pub theta_i: f64,
    /// Relative azimuth of the lobes, degrees; 180 is the plane of incidence.
    pub dphi: f64,
    /// Whether BRDF is plotted as its logarithm.
    pub log_brdf: bool,
    /// Whether the Fresnel limit is plotted.
    pub show_limit: bool,
    /// Whether the backscatter side is plotted though nothing was measured there.
    pub show_backscatter: bool,
    /// Whether what is free is fitted again whenever a slider moves.
    pub refit_live: bool,
    /// Whether the status line tells how long frames take.
    pub show_frame_times: bool,
    pub theme: Theme,
    /// Inner size of the window in points.
    pub window_size: [f32; 2],
    pub maximized: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            parameters: Parameters::default(),
            model: Model::full(SlopeDistribution::Cauchy),
            locked: ParameterSet::EMPTY.with(Parameter::Ks),
            theta_i: 40.0,
            dphi: 180.0,
            log_brdf: false,
            show_limit: true,
            show_backscatter: false,
            refit_live: false,
            show_frame_times: false,
            theme: Theme::System,
            window_size: [1280.0, 800.0],
            maximized: false,
        }
    }
}

impl Settings {
    /// Whether the values mean something: a file can be well-formed and still hold nonsense.
    pub fn are_sound(&self) -> bool {
        self.parameters.validate(ParameterSet::ALL).is_ok()
            && Geometry::new(self.theta_i, 0.0, self.dphi).is_ok()
            && self.window_size.iter().all(|side| (100.0..=20_000.0).contains(side))
    }
}
