//! A layout of panes as tiles, and back.

use crate::app::work::layout::Layout;
use crate::app::work::pane_id::PaneId;
use egui_tiles::{Container, Linear, LinearDir, Tabs, Tile, TileId, Tiles, Tree};

/// The tiles of a layout.
pub fn tree_of(layout: &Layout) -> Tree<PaneId> {
    let mut tiles = Tiles::default();
    let root = insert(layout, &mut tiles);
    Tree::new(egui::Id::unique("panes"), root, tiles)
}

fn insert(layout: &Layout, tiles: &mut Tiles<PaneId>) -> TileId {
    match layout {
        Layout::Pane(pane) => tiles.insert_pane(*pane),
        Layout::Tabs { active, parts } => {
            let children: Vec<TileId> = parts.iter().map(|part| insert(part, tiles)).collect();
            let mut tabs = Tabs::new(children.clone());
            tabs.active = children.get(*active).or(children.first()).copied();
            tiles.insert_container(tabs)
        }
        Layout::Columns(parts) => insert_linear(LinearDir::Horizontal, parts, tiles),
        Layout::Rows(parts) => insert_linear(LinearDir::Vertical, parts, tiles),
    }
}

/// How tiles are arranged; none where there is no pane.
pub fn layout_of(tree: &Tree<PaneId>) -> Option<Layout> {
    layout_of_tile(&tree.tiles, tree.root()?).filter(Layout::is_sound)
}

fn layout_of_tile(tiles: &Tiles<PaneId>, id: TileId) -> Option<Layout> {
    let of_all = |children: &[TileId]| -> Vec<(TileId, Layout)> {
        children.iter().filter_map(|child| Some((*child, layout_of_tile(tiles, *child)?))).collect()
    };
    match tiles.get(id)? {
        Tile::Pane(pane) => Some(Layout::Pane(*pane)),
        Tile::Container(Container::Tabs(tabs)) => {
            let parts = of_all(&tabs.children);
            let active = parts.iter().position(|(child, _)| tabs.active == Some(*child)).unwrap_or(0);
            Some(Layout::Tabs { active, parts: parts.into_iter().map(|(_, part)| part).collect() })
        }
        Tile::Container(Container::Linear(linear)) => {
            let parts = of_all(&linear.children).into_iter().map(|(child, part)| (linear.shares[child], part)).collect();
            Some(if linear.dir == LinearDir::Horizontal { Layout::Columns(parts) } else { Layout::Rows(parts) })
        }
        // Nothing here makes a grid; as columns its panes are at least there.
        Tile::Container(Container::Grid(grid)) => {
            let children: Vec<TileId> = grid.children().copied().collect();
            Some(Layout::Columns(of_all(&children).into_iter().map(|(_, part)| (1.0, part)).collect()))
        }
    }
}

fn insert_linear(dir: LinearDir, parts: &[(f32, Layout)], tiles: &mut Tiles<PaneId>) -> TileId {
    let children: Vec<TileId> = parts.iter().map(|(_, part)| insert(part, tiles)).collect();
    let mut linear = Linear::new(dir, children.clone());
    for (child, (share, _)) in children.into_iter().zip(parts) {
        linear.shares.set_share(child, *share);
    }
    tiles.insert_container(linear)
}

#[cfg(test)]
mod tests {
    use super::{Layout, PaneId, layout_of, tree_of};

    #[test]
    fn a_layout_survives_tiles() {
        let tabs = Layout::Tabs { active: 0, parts: vec![Layout::Pane(PaneId::Lobes)] };
        let layout = Layout::Columns(vec![(0.7, Layout::Rows(vec![(2.0, tabs)])), (1.3, Layout::Pane(PaneId::Dolp))]);
        assert_eq!(layout_of(&tree_of(&layout)), Some(layout));
    }
}
