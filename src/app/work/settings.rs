//! What survives a restart: what the user set, all of which can be undone, and how the window
//! stands.

use crate::app::text::i18n::Language;
use crate::app::work::design::DesignSettings;
use crate::app::work::import_memory::ImportMemory;
use crate::app::work::open_measurement::{IncidenceSeries, OpenMeasurement};
use crate::app::work::picture_options::PictureOptions;
use crate::app::work::posterior::PosteriorOptions;
use crate::app::work::results_options::ResultsOptions;
use crate::app::work::settings_error::SettingsError;
use crate::app::work::talk::{Talk, is_zoom};
use pbrdf::fit::{FitOptions, Starts};
use pbrdf::model::Parameter;
use pbrdf::optics::{Geometry, Metal};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::path::{Path, PathBuf};

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

/// The other distribution beside the model's own, in the plot of DoLP.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Overlay {
    #[default]
    Absent,
    /// With the same σ, which is not the same width.
    EqualSigma,
    /// With half of the facets below the same slope.
    EqualMedian,
}

/// What the hemisphere map shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HemisphereQuantity {
    #[default]
    Dolp,
    /// Of polarisation.
    Angle,
    Brdf,
    /// Of the radiance.
    SpecularShare,
}

impl HemisphereQuantity {
    pub const ALL: [Self; 4] = [Self::Dolp, Self::Angle, Self::Brdf, Self::SpecularShare];
}

/// What a map is compared to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Compared {
    LastFit,
    /// The pinned surface at that place.
    Pin(usize),
}

impl Compared {
    /// Where it is after the pinned surface at that place is removed.
    pub fn without(self, removed: usize) -> Option<Self> {
        match self {
            Self::Pin(place) if place == removed => None,
            Self::Pin(place) if place > removed => Some(Self::Pin(place - 1)),
            other => Some(other),
        }
    }
}

/// What panes show beyond what they always show.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct ViewOptions {
    /// The specular share of the radiance beside DoLP.
    pub share: bool,
    pub overlay: Overlay,
    /// Whether lobes are filled.
    pub filled: bool,
    /// Whether lobes are multiplied by cos θr.
    pub times_cosine: bool,
    /// Whether the radius of the polar diagram is logarithmic.
    pub polar_log: bool,
    /// Whether facet densities are drawn as their logarithm.
    pub facets_log: bool,
    /// Whether the two facet distributions have the same median slope rather than the same σ.
    pub facets_equal_median: bool,
    /// Whether the way of a fit is drawn against time rather than evaluations.
    pub convergence_by_time: bool,
    pub hemisphere: HemisphereQuantity,
    /// The surface whose map is taken off that of the sliders.
    pub hemisphere_less: Option<Compared>,
}

/// Which two parameters the landscape is drawn over, and what lies on it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LandscapeAxes {
    pub across: Parameter,
    pub up: Parameter,
    pub contours: bool,
    /// The ways of the last fits.
    pub paths: bool,
    /// Where the starts of the shown fit ended.
    pub minima: bool,
    /// Tabulated metals, where the axes are n and k.
    pub metals: bool,
    /// Draws from the posterior.
    pub cloud: bool,
}

impl Default for LandscapeAxes {
    fn default() -> Self {
        Self { across: Parameter::N, up: Parameter::K, contours: true, paths: true, minima: true, metals: true, cloud: true }
    }
}

/// What panes show beyond the view options, each under a key of its own among the settings.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct PaneSettings {
    pub landscape: LandscapeAxes,
    pub picture: PictureOptions,
    pub posterior: PosteriorOptions,
    #[serde(skip_serializing_if = "is_default")]
    pub results: ResultsOptions,
}

fn is_default(results: &ResultsOptions) -> bool {
    *results == ResultsOptions::default()
}

/// Which tabulated metal is looked at, and at which wavelength.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MetalSelection {
    /// Key of the metal.
    pub metal: String,
    /// Vacuum wavelength in nm.
    pub wavelength_nm: f64,
    /// Key of the source whose n and k were set last.
    pub source: Option<String>,
    /// Whether n and k go along with the wavelength.
    pub follow: bool,
}

impl Default for MetalSelection {
    fn default() -> Self {
        Self { metal: "Fe".to_owned(), wavelength_nm: 650.0, source: None, follow: true }
    }
}

impl MetalSelection {
    /// Turns to a metal, if there is one.
    pub fn look_at(&mut self, metal: Option<&Metal>) {
        if let Some(metal) = metal.filter(|metal| metal.key != self.metal) {
            self.metal.clone_from(&metal.key);
            self.source = None;
        }
    }

    /// Ends of the slider in nm: what the tables hold.
    pub const SHORTEST_NM: f64 = 200.0;
    pub const LONGEST_NM: f64 = 2500.0;
}

/// What the user sets beside the surfaces: switches, views, options of fits. Each change of it is a
/// step of undo.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Whether the bounds stand under the sliders.
    pub show_bounds: bool,
    /// What a fit minimises.
    #[serde(rename = "choices")]
    pub fit_options: FitOptions,
    /// Where a fit begins.
    pub starts: Starts,
    /// Seed of the starts and of the bootstrap.
    pub seed: u64,
    /// Angles that might be measured.
    #[serde(rename = "plan")]
    pub design: DesignSettings,
    /// Angle of incidence of the lobes, degrees.
    pub theta_i: f64,
    /// Relative azimuth of the lobes, degrees; 180 is the plane of incidence.
    pub dphi: f64,
    /// Whether BRDF is plotted as its logarithm.
    pub log_brdf: bool,
    /// Whether the Fresnel limit is plotted.
    pub show_limit: bool,
    /// Whether the standard error of fitted curves is plotted.
    pub show_band: bool,
    /// Whether the backscatter side is plotted though nothing was measured there.
    pub show_backscatter: bool,
    /// Whether what is free is fitted again whenever a slider moves.
    pub refit_live: bool,
    #[serde(rename = "shown")]
    pub view_options: ViewOptions,
    #[serde(rename = "tabulated")]
    pub metal_selection: MetalSelection,
    #[serde(flatten)]
    pub panes: PaneSettings,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            show_bounds: false,
            fit_options: FitOptions::default(),
            starts: Starts::Automatic,
            seed: 1,
            design: DesignSettings::default(),
            theta_i: 40.0,
            dphi: 180.0,
            log_brdf: false,
            show_limit: true,
            show_band: true,
            show_backscatter: false,
            refit_live: false,
            view_options: ViewOptions::default(),
            metal_selection: MetalSelection::default(),
            panes: PaneSettings::default(),
        }
    }
}

impl Settings {
    /// What the first measurement that is opened decides: where to look, which is where one looks already
    /// or the nearest measured place.
    pub fn adapt_to(&mut self, opened: &OpenMeasurement) {
        let away = |series: &&IncidenceSeries| (series.plane != self.dphi, (series.theta_i - self.theta_i).abs());
        let nearest = opened.series.iter().min_by(|one, other| away(one).partial_cmp(&away(other)).unwrap_or(Ordering::Equal));
        if let Some(nearest) = nearest {
            (self.theta_i, self.dphi) = (nearest.theta_i, nearest.plane);
        }
        self.adapt_beside_others(opened);
    }

    /// What a further measurement decides; the lobes are looked at where they were.
    pub fn adapt_beside_others(&mut self, opened: &OpenMeasurement) {
        if opened.brdf_spans_decades() {
            self.log_brdf = true;
        }
        if let Some(wavelength_nm) = opened.wavelength_nm() {
            self.metal_selection.wavelength_nm = wavelength_nm;
        }
        self.metal_selection.look_at(opened.metal());
    }

    /// Checks that every value means something: a file can be well-formed and still hold nonsense.
    ///
    /// # Errors
    /// The first value that means nothing.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let is_positive = |value: f64| value.is_finite() && value > 0.0;
        Geometry::new(self.theta_i, 0.0, self.dphi).map_err(SettingsError::Angles)?;
        let others = [
            ("plan", self.design.is_sound()),
            ("picture", self.panes.picture.is_sound()),
            ("posterior", self.panes.posterior.is_sound()),
            ("tabulated.wavelength_nm", is_positive(self.metal_selection.wavelength_nm)),
            ("choices.loss_scale", self.fit_options.loss_scale.is_none_or(is_positive)),
        ];
        let wrong = others.into_iter().find(|(_, is_sound)| !is_sound);
        wrong.map_or(Ok(()), |(key, _)| Err(SettingsError::OutOfRange(key)))
    }
}

/// How the window stands; no part of undo.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WindowSettings {
    pub theme: Theme,
    pub language: Language,
    /// Inner size in points.
    pub size: [f32; 2],
    pub maximized: bool,
    /// Whether the status line tells how long frames take.
    pub show_frame_times: bool,
    /// Measurements opened lately, the newest first.
    pub recent: Vec<PathBuf>,
    /// How the last foreign tables were read.
    pub imports: ImportMemory,
    /// Points of the screen for a point of the window.
    pub zoom: f32,
    pub panels: SidePanels,
    #[serde(deserialize_with = "Talk::lenient")]
    pub talk: Talk,
    /// Whether the tour of the first start was shown or skipped.
    pub knows_tour: bool,
}

/// A panel beside the plots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SidePanel {
    #[default]
    Parameters,
    Fit,
}

/// Which panels are beside the plots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct SidePanels {
    pub parameters: bool,
    pub fit: bool,
    /// The one that is seen where there is room for one alone.
    pub front: SidePanel,
}

impl Default for SidePanels {
    fn default() -> Self {
        Self { parameters: true, fit: true, front: SidePanel::Parameters }
    }
}

impl SidePanels {
    /// Hides a panel, or shows it again.
    pub fn toggle(&mut self, panel: SidePanel) {
        let shown = match panel {
            SidePanel::Parameters => &mut self.parameters,
            SidePanel::Fit => &mut self.fit,
        };
        *shown = !*shown;
        if *shown {
            self.front = panel;
        }
    }
}

/// Recent files that are kept.
const MOST_RECENT: usize = 8;

impl Default for WindowSettings {
    fn default() -> Self {
        Self {
            theme: Theme::System,
            language: Language::English,
            size: [1280.0, 800.0],
            maximized: false,
            show_frame_times: false,
            recent: Vec::new(),
            imports: ImportMemory::default(),
            zoom: 1.0,
            panels: SidePanels::default(),
            talk: Talk::default(),
            knows_tour: false,
        }
    }
}

impl WindowSettings {
    /// Whether a window can have this size and zoom.
    pub fn is_sound(&self) -> bool {
        is_zoom(self.zoom) && self.size.iter().all(|side| (100.0..=20_000.0).contains(side))
    }

    /// Puts a file in front of the recent ones.
    pub fn remember(&mut self, path: &Path) {
        self.forget(path);
        self.recent.insert(0, path.to_owned());
        self.recent.truncate(MOST_RECENT);
    }

    /// Takes a file that is gone from the recent ones.
    pub fn forget(&mut self, path: &Path) {
        self.recent.retain(|other| other != path);
    }
}
