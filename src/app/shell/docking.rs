//! The tiles that the panes in the middle lie in.

use crate::app::platform;
use crate::app::shell::stage::{LEAST_FOR_TWO, MOST_PRESENTED, Stage, presented_ui, show_menu_ui, single_ui};
use crate::app::shell::theme::ground;
use crate::app::shell::tiles::{layout_of, tree_of};
use crate::app::text::i18n::translated;
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::{Cx, Views, note_stop, spec};
use crate::app::work::layout::Layout;
use crate::app::work::pane_id::PaneId;
use egui::{Color32, Rgba, Ui, Visuals, WidgetText};
use egui_tiles::{Behavior, Container, EditAction, SimplificationOptions, TabState, Tile, TileId, Tiles, Tree, UiResponse};
use tr::tr;

/// The panes and where they lie.
pub struct Dock {
    tree: Tree<PaneId>,
    /// Whether the arrangement is another one than [`Dock::take_edit`] told last.
    is_edited: bool,
    /// Those that the frame before drew.
    drawn: Vec<PaneId>,
    /// Those whose tabs are being brought into view, and for how many frames still.
    scrolling: Vec<(PaneId, u8)>,
    stage: Option<Stage>,
    /// The pane that was brought to the front last: where there is room for one, it has it.
    front: Option<PaneId>,
    /// Whether the frame before had room for panes one above the other.
    is_low: bool,
    /// Whether the work's own arrangement is another one, which stays.
    is_passing: bool,
}

/// Frames in which a tab is brought into view: the arrows beside tabs come and go, and take of
/// their room.
const SCROLLING: u8 = 4;

impl Dock {
    pub fn new(layout: &Layout) -> Self {
        Self {
            tree: tree_of(layout),
            is_edited: false,
            drawn: Vec::new(),
            scrolling: Vec::new(),
            stage: None,
            front: None,
            is_low: false,
            is_passing: false,
        }
    }

    /// Another arrangement in the place of this one; a presentation goes on with what is on screen in
    /// it.
    pub fn rearrange(&mut self, other: Self) {
        let is_presented = self.is_presented();
        let is_low = self.is_low;
        *self = Self { is_low, ..other };
        if is_presented {
            self.activate_tabs();
            self.present_all();
        }
    }

    /// An arrangement that the work does not take over.
    pub fn passing(layout: &Layout) -> Self {
        Self { is_passing: true, ..Self::new(layout) }
    }

    pub fn is_passing(&self) -> bool {
        self.is_passing
    }

    /// The arrangement; none where all panes are closed.
    pub fn layout(&self) -> Option<Layout> {
        layout_of(&self.tree)
    }

    /// The arrangement, once after it has changed; while all panes are closed, that of before is
    /// the one to keep.
    pub fn take_edit(&mut self) -> Option<Layout> {
        (std::mem::take(&mut self.is_edited) && !self.is_passing).then(|| self.layout()).flatten()
    }

    /// Those that the next frame draws.
    pub fn on_screen(&self) -> Vec<PaneId> {
        if let Some(stage) = &self.stage {
            return stage.panes().to_vec();
        }
        let tiled = self.on_tiles();
        match self.front.filter(|front| tiled.contains(front)).or(tiled.first().copied()) {
            Some(front) if self.is_low && self.is_stacked() => vec![front],
            _ => tiled,
        }
    }

    /// Those that the tiles show.
    fn on_tiles(&self) -> Vec<PaneId> {
        self.tree.active_tiles().into_iter().filter_map(|tile| self.tree.tiles.get_pane(&tile).copied()).collect()
    }

    /// All that are open, in their order.
    pub fn open(&self) -> Vec<PaneId> {
        self.layout().map_or_else(Vec::new, |layout| layout.panes())
    }

    /// Whether any lie one above the other.
    fn is_stacked(&self) -> bool {
        self.layout().is_some_and(|layout| layout.is_stacked())
    }

    /// Whether one pane fills the window.
    pub fn is_filled(&self) -> bool {
        matches!(self.stage, Some(Stage::Filled(_)))
    }

    /// Whether panes are presented.
    pub fn is_presented(&self) -> bool {
        matches!(self.stage, Some(Stage::Presented(_)))
    }

    /// Lets a pane fill the window; once more, and all lie where they lay.
    pub fn fill(&mut self, pane: PaneId) {
        let is_filled = self.is_filled();
        self.stage = None;
        self.show(pane);
        if !is_filled {
            self.stage = Some(Stage::Filled(pane));
        }
    }

    /// Presents what is on screen; where nothing is, the first pane.
    pub fn present(&mut self) {
        self.present_panes(self.on_screen());
    }

    /// The same with all panes of the tiles, also those that a low window has no room for.
    pub fn present_all(&mut self) {
        self.present_panes(if self.is_filled() { self.on_screen() } else { self.on_tiles() });
    }

    fn present_panes(&mut self, mut panes: Vec<PaneId>) {
        panes.truncate(MOST_PRESENTED);
        if panes.is_empty() {
            panes.push(PaneId::ALL[0]);
        }
        self.stage = Some(Stage::Presented(panes));
    }

    /// Back to the tiles.
    pub fn leave_stage(&mut self) {
        self.stage = None;
    }

    /// Gives every group of tabs an active one, so that [`Dock::on_screen`] knows it before it is
    /// drawn.
    pub fn activate_tabs(&mut self) {
        self.tree.simplify(&SIMPLIFICATION);
        let ids: Vec<TileId> = self.tree.tiles.tile_ids().filter(|tile| is_tabs(&self.tree.tiles, *tile)).collect();
        for id in ids {
            if let Some(Tile::Container(Container::Tabs(mut tabs))) = self.tree.tiles.remove(id) {
                tabs.ensure_active(&self.tree.tiles);
                self.tree.tiles.insert(id, Tile::Container(Container::Tabs(tabs)));
            }
        }
    }

    /// Notes which tabs have come to the front since the last frame: they may lie outside their
    /// bar.
    fn note_fresh_tabs(&mut self) {
        let on_screen = self.on_screen();
        let fresh = on_screen.iter().filter(|pane| !self.drawn.contains(pane)).map(|pane| (*pane, SCROLLING));
        self.scrolling.extend(fresh);
        self.drawn = on_screen;
    }

    #[cfg(test)]
    pub fn is_on_screen(&self, pane: PaneId) -> bool {
        self.on_screen().contains(&pane)
    }

    /// Puts a pane on screen, where it lies or, if it is closed, beside its neighbours.
    pub fn show(&mut self, pane: PaneId) {
        if self.tree.tiles.find_pane(&pane).is_none() {
            self.insert(pane);
        }
        self.is_edited = true;
        self.front = Some(pane);
        self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(other) if *other == pane));
        match &mut self.stage {
            Some(Stage::Filled(filled)) => *filled = pane,
            Some(Stage::Presented(panes)) if !panes.contains(&pane) => {
                panes.truncate(MOST_PRESENTED - 1);
                panes.push(pane);
            }
            _ => {}
        }
    }

    /// Puts panes on screen side by side: one that lies behind another of them moves to a group of
    /// tabs that shows none of them, if there is one.
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
        self.front = panes.first().copied().or(self.front);
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
        let beside = PaneId::ALL.iter().filter(|other| other.area() == pane.area());
        let parent = beside.filter_map(|other| tiles.parent_of(tiles.find_pane(other)?)).find(|parent| is_tabs(tiles, *parent));
        parent.or_else(|| self.tree.active_tiles().into_iter().find(|tile| is_tabs(tiles, *tile)))
    }

    /// Takes a pane off the screen; of a presentation it stays open behind.
    pub fn close(&mut self, pane: PaneId) {
        match &mut self.stage {
            Some(Stage::Presented(panes)) => {
                if panes.len() > 1 {
                    panes.retain(|other| *other != pane);
                }
                return;
            }
            Some(Stage::Filled(filled)) if *filled == pane => self.stage = None,
            _ => {}
        }
        if let Some(tile) = self.tree.tiles.find_pane(&pane) {
            self.tree.remove_recursively(tile);
            self.is_edited = true;
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

/// The title of a pane, or of a group of panes the titles of those that it shows.
fn title_of(tiles: &Tiles<PaneId>, tile: TileId) -> String {
    match tiles.get(tile) {
        Some(Tile::Pane(pane)) => translated(spec(*pane).title),
        Some(Tile::Container(Container::Tabs(tabs))) => tabs.active.map_or_else(String::new, |active| title_of(tiles, active)),
        Some(Tile::Container(container)) => container.children().map(|child| title_of(tiles, *child)).collect::<Vec<_>>().join(" | "),
        None => String::new(),
    }
}

/// Draws the panes.
pub fn panes_ui(dock: &mut Dock, views: &mut Views, cx: &mut Cx<'_>, ui: &mut Ui) {
    let is_low = ui.available_height() < LEAST_FOR_TWO;
    if std::mem::replace(&mut dock.is_low, is_low) != is_low {
        // What comes to the screen is made before a frame.
        ui.ctx().request_repaint();
    }
    let on_screen = dock.on_screen();
    if let Some(Stage::Presented(panes)) = &dock.stage {
        presented_ui(panes, views, cx, ui);
        return;
    }
    if let [pane] = on_screen[..]
        && (dock.is_filled() || dock.on_tiles().len() > 1)
    {
        single_ui(pane, dock.is_filled(), dock.open(), views, cx, ui);
        return;
    }
    if on_screen.is_empty() {
        ui.centered_and_justified(|ui| ui.label(tr!("All panes are closed. The View menu opens them again.")));
        return;
    }
    dock.note_fresh_tabs();
    let Dock { tree, is_edited, scrolling, is_passing, .. } = dock;
    tree.ui(&mut PaneBehavior { views, cx, is_edited, scrolling, are_closable: !*is_passing, seen: on_screen }, ui);
}

/// How tiles look and behave.
struct PaneBehavior<'a, 'c> {
    views: &'a mut Views,
    cx: &'a mut Cx<'c>,
    is_edited: &'a mut bool,
    scrolling: &'a mut Vec<(PaneId, u8)>,
    /// Whether tabs have a button that closes them: where there is room for one pane, it would be under a finger that chooses another one.
    are_closable: bool,
    /// The panes on screen.
    seen: Vec<PaneId>,
}

impl PaneBehavior<'_, '_> {
    /// Brings the tab of a pane that has come to the front into view, if it is not.
    fn scroll_tab_into_view(&mut self, pane: PaneId, tab: &egui::Response) {
        let Some(place) = self.scrolling.iter().position(|(other, _)| *other == pane) else { return };
        let frames = &mut self.scrolling[place].1;
        *frames -= 1;
        let is_cut = tab.interact_rect.width() < tab.rect.width();
        // Not after the first: then the arrows know nothing of the tabs yet.
        if *frames == 0 || (!is_cut && *frames + 1 < SCROLLING) {
            self.scrolling.remove(place);
        }
        if is_cut {
            tab.scroll_to_me_animation(None, egui::style::ScrollAnimation::none());
            tab.ctx.request_repaint();
        }
    }
}

impl Behavior<PaneId> for PaneBehavior<'_, '_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut PaneId) -> UiResponse {
        egui::Frame::new().inner_margin(egui::Margin { left: 4, right: 10, top: 8, bottom: 2 }).show(ui, |ui| {
            self.views.of(*pane).ui(self.cx, ui);
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &PaneId) -> WidgetText {
        translated(spec(*pane).title).into()
    }

    fn on_tab_button(&mut self, tiles: &mut Tiles<PaneId>, tile: TileId, response: egui::Response) -> egui::Response {
        let Some(pane) = tiles.get_pane(&tile) else { return response };
        self.scroll_tab_into_view(*pane, &response);
        if self.seen.contains(pane) {
            note_stop(&response.ctx, response.id);
        }
        if response.double_clicked() {
            self.cx.actions.push(Action::Window(WindowAction::FillWindow(*pane)));
        }
        response.on_hover_text(translated(spec(*pane).tooltip))
    }

    fn is_tab_closable(&self, _tiles: &Tiles<PaneId>, _tile: TileId) -> bool {
        self.are_closable
    }

    fn close_button_outer_size(&self) -> f32 {
        if platform::has_fingers() { 20.0 } else { 12.0 }
    }

    fn close_button_inner_margin(&self) -> f32 {
        if platform::has_fingers() { 5.0 } else { 2.0 }
    }

    fn tab_bar_height(&self, _style: &egui::Style) -> f32 {
        if platform::has_fingers() { 30.0 } else { 24.0 }
    }

    fn on_tab_close(&mut self, tiles: &mut Tiles<PaneId>, tile: TileId) -> bool {
        // A group of tiles inside tabs is closed as a whole by the tiles themselves.
        let Some(pane) = tiles.get_pane(&tile) else { return true };
        self.cx.actions.push(Action::Window(WindowAction::ClosePane(*pane)));
        false
    }

    fn top_bar_right_ui(&mut self, tiles: &Tiles<PaneId>, ui: &mut Ui, _tile: TileId, tabs: &egui_tiles::Tabs, _scroll: &mut f32) {
        let active = tabs.active.and_then(|tile| tiles.get_pane(&tile)).filter(|pane| spec(**pane).has_options);
        if let Some(pane) = active {
            show_menu_ui(*pane, self.views, self.cx, ui);
        }
    }

    fn tab_title_for_tile(&mut self, tiles: &Tiles<PaneId>, tile: TileId) -> WidgetText {
        title_of(tiles, tile).into()
    }

    fn on_edit(&mut self, _action: EditAction) {
        *self.is_edited = true;
    }

    fn tab_bar_color(&self, visuals: &Visuals) -> Color32 {
        let ground = ground(visuals.dark_mode);
        if visuals.dark_mode { visuals.extreme_bg_color } else { (Rgba::from(ground) * Rgba::from_gray(0.8)).into() }
    }

    fn tab_bg_color(&self, visuals: &Visuals, _tiles: &Tiles<PaneId>, _tile: TileId, state: &TabState) -> Color32 {
        if state.active { ground(visuals.dark_mode) } else { Color32::TRANSPARENT }
    }

    fn dragged_overlay_color(&self, visuals: &Visuals) -> Color32 {
        ground(visuals.dark_mode).gamma_multiply(0.5)
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
    use super::{Dock, spec};
    use crate::app::work::layout::Layout;
    use crate::app::work::pane_id::PaneId;

    #[test]
    fn no_title_is_there_twice() {
        for pane in PaneId::ALL {
            assert_eq!(PaneId::ALL.iter().filter(|other| spec(**other).title == spec(*pane).title).count(), 1);
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
                all.activate_tabs();
                assert!(panes.iter().all(|pane| all.is_on_screen(*pane)), "{panes:?}, {closed}");
                // None is there twice and none is lost.
                let mut wanted = Layout::default().panes();
                wanted.extend(panes);
                let wanted = PaneId::ALL.iter().filter(|pane| wanted.contains(pane)).count();
                let there = PaneId::ALL.iter().filter(|pane| all.tree.tiles.find_pane(pane).is_some()).count();
                assert_eq!((there, all.tree.tiles.tiles().filter(|tile| tile.is_pane()).count()), (wanted, wanted));
            }
        }
    }

    #[test]
    fn panes_are_closed_and_opened_again() {
        let mut panes = Dock::new(&Layout::default());
        for pane in PaneId::ALL {
            panes.close(*pane);
            assert!(!panes.is_on_screen(*pane));
        }
        assert_eq!(panes.layout(), None);
        for pane in PaneId::ALL {
            panes.show(*pane);
            assert!(panes.is_on_screen(*pane), "{pane:?}");
        }
    }
}
