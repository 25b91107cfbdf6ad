//! The panes in the middle: one table of them, and the tiles that they lie in.
//!
//! A pane that is not on screen is not refreshed: what is not seen is not computed. To add one: a variant, a row in [`PANES`], a
//! file in `views/` with its functions, and a field in [`crate::app::views::Views`] for what it keeps.

use crate::app::shell::app::App;
use crate::app::shell::commands::Command;
use crate::app::text::i18n::translated;
use crate::app::views;
use crate::app::work::layout::Layout;
use egui::{Key, Ui, WidgetText};
use egui_tiles::{Behavior, Container, SimplificationOptions, Tile, TileId, Tiles, Tree, UiResponse};
use serde::{Deserialize, Serialize};
use tr::tr;

/// Which pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "&'static str")]
pub enum PaneId {
    Dolp,
    Lobes,
    PolarLobes,
    Facets,
    Convergence,
    Data,
    Planner,
    Models,
    Metals,
    Hemisphere,
    Mueller,
    Landscape,
    Audit,
    ErrorVsTime,
    Stability,
    Cost,
}

/// Where a pane lies until the user moves it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    Upper,
    Lower,
}

/// What there is to know of a pane.
pub struct PaneSpec {
    pub pane: PaneId,
    /// Name in files.
    pub key: &'static str,
    pub title: &'static str,
    pub tooltip: &'static str,
    /// Shows it, together with Ctrl.
    pub shortcut: Option<Key>,
    pub place: Place,
    /// Makes anew what it draws, where inputs are others; called before each frame that has it on screen, and at no other time.
    pub refresh: fn(&mut App),
    /// Draws it; evaluates nothing.
    pub ui: fn(&mut App, &mut Ui),
    /// What its *Show* menu holds, if it has one.
    pub options: Option<fn(&mut App, &mut Ui)>,
}

/// All panes, in the order of the enumeration and of menus.
pub static PANES: [PaneSpec; 16] = [
    PaneSpec {
        pane: PaneId::Dolp,
        key: "dolp",
        title: "DoLP",
        tooltip: "Degree of linear polarisation against the angle of view, Eq. (17), with the measured points and what the model misses; Ctrl+click masks a point",
        shortcut: Some(Key::Num1),
        place: Place::Upper,
        refresh: views::dolp_refresh,
        ui: views::dolp_ui,
        options: Some(views::dolp_options_ui),
    },
    PaneSpec {
        pane: PaneId::Lobes,
        key: "lobes",
        title: "Lobes",
        tooltip: "BRDF against the angle of view: specular, diffuse and volume lobe and their sum, Eq. (14)",
        shortcut: Some(Key::Num2),
        place: Place::Lower,
        refresh: views::lobes_refresh,
        ui: views::lobes_ui,
        options: Some(views::lobes_options_ui),
    },
    PaneSpec {
        pane: PaneId::PolarLobes,
        key: "polar_lobes",
        title: "Polar lobes",
        tooltip: "The lobes around the point of incidence, with surface, incident ray and mirror direction",
        shortcut: Some(Key::Num3),
        place: Place::Lower,
        refresh: views::polar_refresh,
        ui: views::polar_ui,
        options: Some(views::polar_options_ui),
    },
    PaneSpec {
        pane: PaneId::Facets,
        key: "facets",
        title: "Facets",
        tooltip: "Densities of facet tilts for both distributions, Eqs. (5, 7), and masking–shadowing, Eq. (6)",
        shortcut: Some(Key::Num4),
        place: Place::Lower,
        refresh: views::facets_refresh,
        ui: views::facets_ui,
        options: Some(views::facets_options_ui),
    },
    PaneSpec {
        pane: PaneId::Convergence,
        key: "convergence",
        title: "Convergence",
        tooltip: "The way of the last fit: ΔE, Eq. (18), against evaluations or time",
        shortcut: None,
        place: Place::Upper,
        refresh: views::convergence_refresh,
        ui: views::convergence_ui,
        options: Some(views::convergence_options_ui),
    },
    PaneSpec {
        pane: PaneId::Data,
        key: "data",
        title: "Data table",
        tooltip: "The measurement row by row with the model's values; masks by row and by series; metadata",
        shortcut: Some(Key::Num9),
        place: Place::Lower,
        refresh: views::table_refresh,
        ui: views::table_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::Planner,
        key: "planner",
        title: "Angle planner",
        tooltip: "What a measurement at these angles would determine, before it is made",
        shortcut: None,
        place: Place::Lower,
        refresh: views::planner_refresh,
        ui: views::planner_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::Models,
        key: "models",
        title: "Models",
        tooltip: "The ladder of models side by side on the open measurement",
        shortcut: None,
        place: Place::Lower,
        refresh: |_| (),
        ui: views::comparison_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::Metals,
        key: "metals",
        title: "Metals",
        tooltip: "Tabulated n and k of metals against wavelength, all sources side by side, and surface finishes",
        shortcut: None,
        place: Place::Lower,
        refresh: views::metals_refresh,
        ui: views::metals_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::Hemisphere,
        key: "hemisphere",
        title: "Hemisphere",
        tooltip: "DoLP, angle of polarisation, BRDF or specular share over all directions of view, also outside the plane of incidence",
        shortcut: Some(Key::Num5),
        place: Place::Upper,
        refresh: views::hemisphere_refresh,
        ui: views::hemisphere_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::Mueller,
        key: "mueller",
        title: "Mueller matrix",
        tooltip: "All sixteen elements over m00 against θr, Eqs. (8, 9, 14), and as numbers at one direction",
        shortcut: Some(Key::Num6),
        place: Place::Upper,
        refresh: views::mueller_refresh,
        ui: views::mueller_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::Landscape,
        key: "landscape",
        title: "Landscape",
        tooltip: "The objective over any two parameters: valleys, ways of the last fits, minima; a click sets the sliders",
        shortcut: None,
        place: Place::Lower,
        refresh: views::landscape_refresh,
        ui: views::landscape_ui,
        options: Some(views::landscape_options_ui),
    },
    PaneSpec {
        pane: PaneId::Audit,
        key: "audit",
        title: "Audit",
        tooltip: "What the physics says of the sliders: reciprocity, reflectance, DoLP against its limit, admissible Mueller matrices",
        shortcut: Some(Key::Num7),
        place: Place::Lower,
        refresh: views::audit_refresh,
        ui: views::audit_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::ErrorVsTime,
        key: "error_vs_time",
        title: "Error against time",
        tooltip: "Error against run time of evaluations and of fits, measured on this machine",
        shortcut: None,
        place: Place::Upper,
        refresh: |_| (),
        ui: views::error_vs_time_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::Stability,
        key: "stability",
        title: "Stability",
        tooltip: "Stiff and extreme cases against 60 digits, beside the textbook form; a click on a case loads it",
        shortcut: None,
        place: Place::Upper,
        refresh: |_| (),
        ui: views::stability_ui,
        options: None,
    },
    PaneSpec {
        pane: PaneId::Cost,
        key: "cost",
        title: "Cost",
        tooltip: "What a scene costs, and what is left out because it does not need it, measured on this machine",
        shortcut: None,
        place: Place::Upper,
        refresh: |_| (),
        ui: views::cost_ui,
        options: None,
    },
];

impl PaneId {
    /// Its row in the table.
    pub fn entry(self) -> &'static PaneSpec {
        &PANES[self as usize]
    }
}

impl From<PaneId> for &'static str {
    fn from(pane: PaneId) -> Self {
        pane.entry().key
    }
}

impl TryFrom<String> for PaneId {
    type Error = String;

    fn try_from(key: String) -> Result<Self, String> {
        PANES.iter().find(|entry| entry.key == key).map(|entry| entry.pane).ok_or_else(|| format!("there is no pane {key:?}"))
    }
}

/// The panes and where they lie.
pub struct Dock {
    tree: Tree<PaneId>,
    /// Those that the frame before drew.
    drawn: Vec<PaneId>,
    /// Those whose tabs are being brought into view, and for how many frames still.
    revealed: Vec<(PaneId, u8)>,
}

/// Frames in which a tab is brought into view: the arrows beside tabs come and go, and take of their room.
const REVEALING: u8 = 4;

impl Dock {
    pub fn new(layout: &Layout) -> Self {
        Self { tree: layout.tree(), drawn: Vec::new(), revealed: Vec::new() }
    }

    /// The arrangement; none where all panes are closed.
    pub fn layout(&self) -> Option<Layout> {
        Layout::of(&self.tree)
    }

    /// Those that the next frame draws.
    pub fn on_screen(&self) -> Vec<PaneId> {
        self.tree.active_tiles().into_iter().filter_map(|tile| self.tree.tiles.get_pane(&tile).copied()).collect()
    }

    /// Sees to it that every group of tabs has one in front, so that [`Dock::on_screen`] knows it before it is drawn.
    pub fn settle(&mut self) {
        self.tree.simplify(&SIMPLIFICATION);
        let ids: Vec<TileId> = self.tree.tiles.tile_ids().filter(|tile| is_tabs(&self.tree.tiles, *tile)).collect();
        for id in ids {
            if let Some(Tile::Container(Container::Tabs(mut tabs))) = self.tree.tiles.remove(id) {
                tabs.ensure_active(&self.tree.tiles);
                self.tree.tiles.insert(id, Tile::Container(Container::Tabs(tabs)));
            }
        }
    }

    /// Remembers which tabs have come to the front since the last frame: they may lie outside their bar.
    fn reveal(&mut self) {
        let on_screen = self.on_screen();
        let fresh = on_screen.iter().filter(|pane| !self.drawn.contains(pane)).map(|pane| (*pane, REVEALING));
        self.revealed.extend(fresh);
        self.drawn = on_screen;
    }

    pub fn is_on_screen(&self, pane: PaneId) -> bool {
        self.on_screen().contains(&pane)
    }

    /// Puts a pane on screen, where it lies or, if it is closed, beside its neighbours.
    pub fn show(&mut self, pane: PaneId) {
        if self.tree.tiles.find_pane(&pane).is_none() {
            self.insert(pane);
        }
        self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(other) if *other == pane));
    }

    /// Puts panes on screen side by side: one that lies behind another of them moves to a group of tabs that shows none of them,
    /// if there is one.
    pub fn show_together(&mut self, panes: &[PaneId]) {
        let mut taken: Vec<TileId> = Vec::new();
        for pane in panes {
            let group = self.group(*pane).or_else(|| self.tabs_for(*pane));
            let free = group.filter(|group| taken.contains(group)).and_then(|_| {
                let groups = self.tree.active_tiles().into_iter().filter(|tile| is_tabs(&self.tree.tiles, *tile));
                groups.into_iter().find(|group| !taken.contains(group))
            });
            if let Some(free) = free {
                let tile = self.tree.tiles.find_pane(pane).unwrap_or_else(|| self.tree.tiles.insert_pane(*pane));
                self.tree.move_tile_to_container(tile, free, usize::MAX, false);
            }
            self.show(*pane);
            taken.extend(self.group(*pane));
        }
    }

    /// The tabs that a pane is one of.
    fn group(&self, pane: PaneId) -> Option<TileId> {
        let tiles = &self.tree.tiles;
        tiles.parent_of(tiles.find_pane(&pane)?).filter(|parent| is_tabs(tiles, *parent))
    }

    fn insert(&mut self, pane: PaneId) {
        let tile = self.tree.tiles.insert_pane(pane);
        let tabs = self.tabs_for(pane).and_then(|tabs| self.tree.tiles.get_mut(tabs));
        if let Some(Tile::Container(container)) = tabs {
            container.add_child(tile);
            return;
        }
        let children = self.tree.root().into_iter().chain([tile]).collect();
        let root = self.tree.tiles.insert_vertical_tile(children);
        self.tree.root = Some(root);
    }

    /// The tabs that a closed pane opens in: those with a pane of the same place, or else any.
    fn tabs_for(&self, pane: PaneId) -> Option<TileId> {
        let tiles = &self.tree.tiles;
        let beside = PANES.iter().filter(|entry| entry.place == pane.entry().place);
        let parent = beside.filter_map(|entry| tiles.parent_of(tiles.find_pane(&entry.pane)?)).find(|parent| is_tabs(tiles, *parent));
        parent.or_else(|| self.tree.active_tiles().into_iter().find(|tile| is_tabs(tiles, *tile)))
    }

    pub fn close(&mut self, pane: PaneId) {
        if let Some(tile) = self.tree.tiles.find_pane(&pane) {
            self.tree.remove_recursively(tile);
        }
    }
}

/// A pane without a tab could be neither named, moved nor closed.
const SIMPLIFICATION: SimplificationOptions = SimplificationOptions {
    prune_empty_tabs: true,
    prune_empty_containers: true,
    prune_single_child_tabs: true,
    prune_single_child_containers: true,
    all_panes_must_have_tabs: true,
    join_nested_linear_containers: true,
    flatten_tabs_in_tabs: true,
};

fn is_tabs(tiles: &Tiles<PaneId>, tile: TileId) -> bool {
    matches!(tiles.get(tile), Some(Tile::Container(Container::Tabs(_))))
}

/// Draws the panes.
pub fn panes_ui(explorer: &mut App, ui: &mut Ui) {
    if explorer.panes.on_screen().is_empty() {
        ui.centered_and_justified(|ui| ui.label(tr!("All panes are closed. The View menu opens them again.")));
        return;
    }
    // The panes draw from the explorer that holds their tiles.
    explorer.panes.reveal();
    let mut tree = std::mem::replace(&mut explorer.panes.tree, Tree::empty(egui::Id::unique("no panes")));
    tree.ui(&mut PaneBehavior { explorer }, ui);
    explorer.panes.tree = tree;
}

/// How tiles look and behave.
struct PaneBehavior<'a> {
    explorer: &'a mut App,
}

impl PaneBehavior<'_> {
    /// Brings the tab of a pane that has come to the front into view, if it is not.
    fn reveal(&mut self, pane: PaneId, tab: &egui::Response) {
        let revealed = &mut self.explorer.panes.revealed;
        let Some(place) = revealed.iter().position(|(other, _)| *other == pane) else { return };
        let frames = &mut revealed[place].1;
        *frames -= 1;
        let is_cut = tab.interact_rect.width() < tab.rect.width();
        // Not after the first: then the arrows know nothing of the tabs yet.
        if *frames == 0 || (!is_cut && *frames + 1 < REVEALING) {
            revealed.remove(place);
        }
        if is_cut {
            tab.scroll_to_me_animation(None, egui::style::ScrollAnimation::none());
            tab.ctx.request_repaint();
        }
    }
}

impl Behavior<PaneId> for PaneBehavior<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut PaneId) -> UiResponse {
        egui::Frame::new().inner_margin(egui::Margin { left: 4, right: 10, top: 8, bottom: 2 }).show(ui, |ui| {
            (pane.entry().ui)(self.explorer, ui);
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &PaneId) -> WidgetText {
        translated(pane.entry().title).into()
    }

    fn on_tab_button(&mut self, tiles: &mut Tiles<PaneId>, tile: TileId, response: egui::Response) -> egui::Response {
        let Some(pane) = tiles.get_pane(&tile) else { return response };
        self.reveal(*pane, &response);
        response.on_hover_text(translated(pane.entry().tooltip))
    }

    fn is_tab_closable(&self, _tiles: &Tiles<PaneId>, _tile: TileId) -> bool {
        true
    }

    fn on_tab_close(&mut self, tiles: &mut Tiles<PaneId>, tile: TileId) -> bool {
        // A group of tiles inside tabs is closed as a whole by the tiles themselves.
        let Some(pane) = tiles.get_pane(&tile) else { return true };
        self.explorer.commands.push(Command::ClosePane(*pane));
        false
    }

    fn top_bar_right_ui(&mut self, tiles: &Tiles<PaneId>, ui: &mut Ui, _tile: TileId, tabs: &egui_tiles::Tabs, _scroll: &mut f32) {
        let active = tabs.active.and_then(|tile| tiles.get_pane(&tile));
        if let Some((pane, options)) = active.and_then(|pane| Some((pane, pane.entry().options?))) {
            // A switch is seldom set alone.
            let config = egui::containers::menu::MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
            let (button, _) = egui::containers::menu::MenuButton::new(tr!("Show")).config(config).ui(ui, |ui| options(self.explorer, ui));
            let name = tr!("Show in {}", translated(pane.entry().title));
            button
                .on_hover_text(tr!("Switches for what is drawn in this pane"))
                .on_hover_text(tr!("In the plot: drag to move, Ctrl+wheel to zoom, a double click shows all"))
                .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
        }
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SIMPLIFICATION
    }

    fn gap_width(&self, _style: &egui::Style) -> f32 {
        4.0
    }

    fn min_size(&self) -> f32 {
        90.0
    }
}

#[cfg(test)]
mod tests {
    use super::{Dock, PANES, PaneId};
    use crate::app::work::layout::Layout;

    #[test]
    fn the_table_is_in_the_order_of_the_enumeration_and_names_are_unique() {
        for (i, entry) in PANES.iter().enumerate() {
            assert_eq!(entry.pane as usize, i);
            assert_eq!(PaneId::try_from(entry.key.to_owned()), Ok(entry.pane));
            assert_eq!(PANES.iter().filter(|other| other.title == entry.title || other.key == entry.key).count(), 1);
        }
    }

    #[test]
    fn panes_of_one_group_are_shown_together() {
        for panes in [[PaneId::Dolp, PaneId::Mueller], [PaneId::Lobes, PaneId::PolarLobes], [PaneId::Dolp, PaneId::Lobes]] {
            for closed in [false, true] {
                let mut all = Dock::new(&Layout::default());
                if closed {
                    all.close(panes[1]);
                }
                all.show_together(&panes);
                all.settle();
                assert!(panes.iter().all(|pane| all.is_on_screen(*pane)), "{panes:?}, {closed}");
                // None is there twice and none is lost.
                let there = PANES.iter().filter(|entry| all.tree.tiles.find_pane(&entry.pane).is_some()).count();
                assert_eq!((there, all.tree.tiles.tiles().filter(|tile| tile.is_pane()).count()), (PANES.len(), PANES.len()));
            }
        }
    }

    #[test]
    fn panes_are_closed_and_opened_again() {
        let mut panes = Dock::new(&Layout::default());
        for entry in &PANES {
            panes.close(entry.pane);
            assert!(!panes.is_on_screen(entry.pane));
        }
        assert_eq!(panes.layout(), None);
        for entry in &PANES {
            panes.show(entry.pane);
            assert!(panes.is_on_screen(entry.pane), "{}", entry.title);
        }
    }
}
