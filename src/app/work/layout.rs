//! How the panes are arranged, as a value.

use crate::app::work::pane_id::{DockArea, PaneId};
use serde::{Deserialize, Deserializer, Serialize};

/// An arrangement of panes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    Pane(PaneId),
    /// One of several at a time, by its place in the list.
    Tabs {
        active: usize,
        parts: Vec<Layout>,
    },
    /// Side by side, with shares of the width.
    Columns(Vec<(f32, Layout)>),
    /// One above the other, with shares of the height.
    Rows(Vec<(f32, Layout)>),
}

impl Default for Layout {
    /// Two groups of tabs, one above the other, with the panes that most want; the menu has the others.
    fn default() -> Self {
        let tabs = |area| {
            let parts = PaneId::ALL.iter().filter(|pane| pane.opens_first() && pane.area() == area).map(|pane| Self::Pane(*pane));
            Self::Tabs { active: 0, parts: parts.collect() }
        };
        Self::Rows(vec![(1.2, tabs(DockArea::Upper)), (1.0, tabs(DockArea::Lower))])
    }
}

impl Layout {
    /// The arrangement in a file, or the default where that is damaged or names panes that do not
    /// exist: a session is not lost for its layout.
    pub fn lenient<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        serde_json::Value::deserialize(deserializer).map(Self::from_value)
    }

    /// The same of a value.
    pub fn from_value(value: serde_json::Value) -> Self {
        serde_json::from_value(value).ok().filter(Self::is_sound).unwrap_or_default()
    }

    /// Whether no pane is there twice and shares are sizes.
    pub fn is_sound(&self) -> bool {
        let mut panes = Vec::new();
        self.collect(&mut panes) && !panes.is_empty()
    }

    /// The panes in their order.
    pub fn panes(&self) -> Vec<PaneId> {
        let mut panes = Vec::new();
        self.collect(&mut panes);
        panes
    }

    /// Whether any lie one above the other.
    pub fn is_stacked(&self) -> bool {
        match self {
            Self::Pane(_) => false,
            Self::Tabs { active, parts } => parts.get(*active).is_some_and(Self::is_stacked),
            Self::Columns(parts) => parts.iter().any(|(_, part)| part.is_stacked()),
            Self::Rows(parts) => parts.len() > 1 || parts.iter().any(|(_, part)| part.is_stacked()),
        }
    }

    fn collect(&self, panes: &mut Vec<PaneId>) -> bool {
        match self {
            Self::Pane(pane) => {
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
    fn a_layout_survives_files() {
        let tabs = Layout::Tabs { active: 0, parts: vec![Layout::Pane(PaneId::Lobes)] };
        let layout = Layout::Columns(vec![(0.7, Layout::Rows(vec![(2.0, tabs)])), (1.3, Layout::Pane(PaneId::Dolp))]);
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
