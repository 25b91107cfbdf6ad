//! What the panes show: a file for each, with what it keeps, what it makes anew before a frame, and how it is drawn.

mod audit;
mod comparison;
pub mod confidence_band;
mod convergence;
mod cost;
pub mod curves;
pub mod derived;
mod dolp;
mod error_vs_time;
mod facets;
mod hemisphere;
mod landscape;
mod lobes;
mod metals;
mod mueller;
mod planner;
mod polar;
mod report;
mod residuals;
mod stability;
mod table;

pub use audit::{audit_figure, audit_refresh, audit_ui};
pub use comparison::{comparison_ui, running_model_ui};
pub use convergence::{convergence_figure, convergence_options_ui, convergence_refresh, convergence_ui};
pub use cost::cost_ui;
pub use dolp::{dolp_options_ui, dolp_refresh, dolp_ui};
pub use error_vs_time::error_vs_time_ui;
pub use facets::{facets_figure, facets_options_ui, facets_refresh, facets_ui};
pub use hemisphere::{hemisphere_figure, hemisphere_refresh, hemisphere_ui};
pub use landscape::{landscape_figure, landscape_options_ui, landscape_refresh, landscape_ui};
pub use lobes::{lobes_options_ui, lobes_refresh, lobes_ui};
pub use metals::{metals_figure, metals_refresh, metals_ui, values};
pub use mueller::{mueller_figure, mueller_refresh, mueller_ui};
pub use planner::{planner_refresh, planner_ui};
pub use polar::{polar_figure, polar_options_ui, polar_refresh, polar_ui};
pub use stability::stability_ui;
pub use table::{table_refresh, table_text, table_ui};

use crate::app::shell::docking::PaneId;

/// What the panes keep from frame to frame.
#[derive(Default)]
pub struct Views {
    pub audit: audit::AuditView,
    pub convergence: convergence::ConvergenceView,
    pub dolp: dolp::DolpView,
    pub facets: facets::FacetsView,
    pub hemisphere: hemisphere::HemisphereView,
    pub landscape: landscape::LandscapeView,
    pub lobes: lobes::LobesView,
    pub metals: metals::MetalsView,
    pub mueller: mueller::MuellerView,
    pub planner: planner::PlannerView,
    pub polar: polar::PolarView,
    pub table: table::TableView,
}

impl Views {
    /// Stops what is being made for panes that nobody looks at.
    pub fn rest(&mut self, on_screen: &[PaneId]) {
        if !on_screen.contains(&PaneId::Hemisphere) {
            self.hemisphere.rest();
        }
        if !on_screen.contains(&PaneId::Landscape) {
            self.landscape.rest();
        }
    }

    /// How many frames the older of the maps on screen is behind the sliders.
    pub fn frames_behind(&self, on_screen: &[PaneId]) -> u64 {
        let map = |pane: &PaneId| match pane {
            PaneId::Hemisphere => self.hemisphere.frames_behind(),
            PaneId::Landscape => self.landscape.frames_behind(),
            _ => 0,
        };
        on_screen.iter().map(map).max().unwrap_or(0)
    }
}
