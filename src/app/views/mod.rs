//! What the panes show: a file for each, with what it keeps, what it makes anew before a frame, and
//! how it is drawn.
//!
//! A new pane is a file with a `SPEC` and a [`View`], its name in the list of
//! [`crate::app::work::pane_id`], and its `mod` here.

pub mod action;
mod audit;
pub mod benchmarks;
mod companions;
pub mod confidence_band;
pub mod context;
mod convergence;
mod cost;
pub mod curves;
mod data;
pub mod derived;
mod dolp;
mod error_vs_time;
mod facets;
mod focus_stops;
mod hemisphere;
mod landscape;
mod lobes;
mod metals;
mod models;
mod mueller;
pub mod picking;
mod picture;
mod planner;
mod pointing;
mod polar_lobes;
mod posterior;
mod posterior_band;
mod report;
mod residuals;
mod residuals_against_angle;
mod results;
mod series_choice;
mod stability;

pub use context::{Cx, PaneSpec, View};
pub use data::table_text;
pub use focus_stops::{follow_f6, note_stop};
pub use metals::values;
pub use models::running_model_ui;
#[cfg(test)]
pub use pointing::PickedDirection;
pub use pointing::pointed_theta_r;
pub use series_choice::choice_menu_ui;

#[cfg(test)]
pub use {
    audit::AuditView, data::DataView, dolp::DolpView, hemisphere::HemisphereView, landscape::LandscapeView, lobes::LobesView,
    picture::PictureView, planner::PlannerView,
};

use crate::app::work::pane_id::{PaneId, with_panes};

macro_rules! specs {
    ($($variant:ident $key:ident $area:ident,)*) => {
        /// What there is to know of a pane.
        pub fn spec(pane: PaneId) -> &'static PaneSpec {
            match pane {
                $(PaneId::$variant => &$key::SPEC,)*
            }
        }
    };
}
with_panes!(specs);

/// The views of all panes.
pub struct Views {
    all: Vec<Box<dyn View>>,
}

impl Default for Views {
    fn default() -> Self {
        Self { all: PaneId::ALL.iter().map(|pane| (spec(*pane).new)()).collect() }
    }
}

impl Views {
    /// The view of a pane.
    pub fn of(&mut self, pane: PaneId) -> &mut dyn View {
        &mut *self.all[pane as usize]
    }

    /// The figure of a pane, for files and the clipboard.
    pub fn figure(&self, pane: PaneId, cx: &Cx<'_>) -> Option<crate::figure::Figure> {
        self.all[pane as usize].figure(cx)
    }

    /// The table of a pane, for files and the clipboard.
    pub fn table(&self, pane: PaneId, cx: &Cx<'_>) -> Option<crate::report::ResultTable> {
        self.all[pane as usize].table(cx)
    }

    /// Whether a pane on screen shows the curves and points that panes share.
    pub fn need_curves(&self, on_screen: &[PaneId]) -> bool {
        on_screen.iter().any(|pane| self.all[*pane as usize].needs_curves())
    }

    /// Makes anew what the panes on screen show, and stops what is being made for the others.
    pub fn refresh(&mut self, on_screen: &[PaneId], cx: &mut Cx<'_>) {
        for (pane, view) in PaneId::ALL.iter().zip(&mut self.all) {
            if on_screen.contains(pane) {
                view.refresh(cx);
            } else {
                view.suspend();
            }
        }
    }

    /// How many frames the last of the panes on screen is behind the sliders.
    pub fn lag(&self, on_screen: &[PaneId]) -> u64 {
        on_screen.iter().map(|pane| self.all[*pane as usize].lag()).max().unwrap_or(0)
    }

    /// The view of that type.
    #[cfg(test)]
    pub fn get<V: View>(&self) -> &V {
        let view = self.all.iter().find_map(|view| (&**view as &dyn std::any::Any).downcast_ref());
        view.expect("there is a view of each type")
    }
}
