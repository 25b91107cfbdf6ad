//! How the panes are arranged, as a value: kept in the settings, and turned into tiles and back.

use crate::app::work::pane_id::{DockArea, PaneId};
use egui_tiles::{Container, Linear, LinearDir, Tabs, Tile, TileId, Tiles, Tree};
use serde::{Deserialize, Deserializer, Serialize};

/// An arrangement of panes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    #[serde(rename = "pane")]
    PaneId(PaneId),
    /// One of several at a time, by its place in the list.
    Tabs { active: usize, parts: Vec<Layout> },
    /// Side by side, with shares of the width.
    Columns(Vec<(f32, Layout)>),
    /// One above the other, with shares of the height.
    Rows(Vec<(f32, Layout)>),
}

impl Default for Layout {
    /// Two groups of tabs, one above the other.
    fn default() -> Self {
        let tabs = |area| {
            let parts = PaneId::ALL.iter().filter(|pane| pane.area() == area).map(|pane| Self::PaneId(*pane));
            Self::Tabs { active: 0, parts: parts.collect() }
        };
        Self::Rows(vec![(1.2, tabs(DockArea::Upper)), (1.0, tabs(DockArea::Lower))])
    }
}

impl Layout {
    /// The arrangement in a file, or the default where that is damaged or names panes that do not exist: a session is not lost for
    /// its layout.
    pub fn lenient<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_json::Value::deserialize(deserializer)?;
        Ok(serde_json::from_value(value).ok().filter(Self::is_sound).unwrap_or_default())
    }

    /// Whether no pane is there twice and shares are sizes.
    fn is_sound(&self) -> bool {
        let mut panes = Vec::new();
        self.collect(&mut panes) && !panes.is_empty()
    }

    fn collect(&self, panes: &mut Vec<PaneId>) -> bool {
        match self {
            Self::PaneId(pane) => {
                let is_new = !panes.contains(pane);
                panes.push(*pane);
                is_new
            }
            Self::Tabs { parts, .. } => parts.iter().all(|part| part.collect(panes)),
            Self::Columns(parts) | Self::Rows(parts) => {
                parts.iter().all(|(share, part)| (1e-3..1e3).contains(share) && part.collect(panes))
            }
        }
    }

    /// The tiles so arranged.
    pub fn tree(&self) -> Tree<PaneId> {
        let mut tiles = Tiles::default();
        let root = self.insert(&mut tiles);
        Tree::new(egui::Id::unique("panes"), root, tiles)
    }

    fn insert(&self, tiles: &mut Tiles<PaneId>) -> TileId {
        match self {
            Self::PaneId(pane) => tiles.insert_pane(*pane),
            Self::Tabs { active, parts } => {
                let children: Vec<TileId> = parts.iter().map(|part| part.insert(tiles)).collect();
                let mut tabs = Tabs::new(children.clone());
                tabs.active = children.get(*active).or(children.first()).copied();
                tiles.insert_container(tabs)
            }
            Self::Columns(parts) => insert_linear(LinearDir::Horizontal, parts, tiles),
            Self::Rows(parts) => insert_linear(LinearDir::Vertical, parts, tiles),
        }
    }

    /// How the tiles are arranged; none where there is no pane.
    pub fn of(tree: &Tree<PaneId>) -> Option<Self> {
        Self::of_tile(&tree.tiles, tree.root()?).filter(Self::is_sound)
    }

    fn of_tile(tiles: &Tiles<PaneId>, id: TileId) -> Option<Self> {
        let of_all = |children: &[TileId]| -> Vec<(TileId, Self)> {
            children.iter().filter_map(|child| Some((*child, Self::of_tile(tiles, *child)?))).collect()
        };
        match tiles.get(id)? {
            Tile::Pane(pane) => Some(Self::PaneId(*pane)),
            Tile::Container(Container::Tabs(tabs)) => {
                let parts = of_all(&tabs.children);
                let active = parts.iter().position(|(child, _)| tabs.active == Some(*child)).unwrap_or(0);
                Some(Self::Tabs { active, parts: parts.into_iter().map(|(_, part)| part).collect() })
            }
            Tile::Container(Container::Linear(linear)) => {
                let parts = of_all(&linear.children).into_iter().map(|(child, part)| (linear.shares[child], part)).collect();
                Some(if linear.dir == LinearDir::Horizontal { Self::Columns(parts) } else { Self::Rows(parts) })
            }
            // Nothing here makes a grid; as columns its panes are at least there.
            Tile::Container(Container::Grid(grid)) => {
                let children: Vec<TileId> = grid.children().copied().collect();
                Some(Self::Columns(of_all(&children).into_iter().map(|(_, part)| (1.0, part)).collect()))
            }
        }
    }
}

fn insert_linear(dir: LinearDir, parts: &[(f32, Layout)], tiles: &mut Tiles<PaneId>) -> TileId {
    let children: Vec<TileId> = parts.iter().map(|(_, part)| part.insert(tiles)).collect();
    let mut linear = Linear::new(dir, children.clone());
    for (child, (share, _)) in children.into_iter().zip(parts) {
        linear.shares.set_share(child, *share);
    }
    tiles.insert_container(linear)
}

#[cfg(test)]
mod tests {
    use super::Layout;
    use crate::app::work::pane_id::PaneId;

    #[derive(serde::Deserialize)]
    struct Holder {
        #[serde(deserialize_with = "Layout::lenient")]
        layout: Layout,
    }

    fn read(text: &str) -> Layout {
        serde_json::from_str::<Holder>(&format!("{{\"layout\": {text}}}")).expect("a lenient layout is never an error").layout
    }

    #[test]
    fn a_layout_survives_tiles_and_files() {
        let tabs = Layout::Tabs { active: 0, parts: vec![Layout::PaneId(PaneId::Lobes)] };
        let layout = Layout::Columns(vec![(0.7, Layout::Rows(vec![(2.0, tabs)])), (1.3, Layout::PaneId(PaneId::Dolp))]);
        assert_eq!(Layout::of(&layout.tree()), Some(layout.clone()));
        assert_eq!(read(&serde_json::to_string(&layout).expect("a layout is JSON")), layout);
    }

    #[test]
    fn a_damaged_layout_is_the_default() {
        for damage in [
            "3",
            "{\"pane\": \"no such pane\"}",
            "{\"tabs\": {\"active\": 0, \"parts\": []}}",
            "{\"rows\": [[0.0, {\"pane\": \"dolp\"}]]}",
            "{\"rows\": [[1.0, {\"pane\": \"dolp\"}], [1.0, {\"pane\": \"dolp\"}]]}",
        ] {
            assert_eq!(read(damage), Layout::default(), "{damage}");
        }
        assert_ne!(read("{\"pane\": \"dolp\"}"), Layout::default());
    }
}
