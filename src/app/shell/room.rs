//! How much of the window there is room for: all of it, one pane with the sliders below on a small
//! screen, or what the address of a page asks for, for a frame in another page.

use crate::app::platform;
use crate::app::work::layout::Layout;
use crate::app::work::pane_id::PaneId;
use egui::Vec2;

/// What is shown where there is no room for everything.
#[derive(Debug)]
pub struct Room {
    /// Whether small screens get less: those of pages.
    pub may_be_small: bool,
    /// Whether the screen is small.
    pub is_small: bool,
    pub below: Below,
    /// Lesson and step that the small screen has shown last.
    pub step: Option<(usize, usize)>,
    /// What a frame in another page shows.
    pub embedded: Option<Embedded>,
}

impl Default for Room {
    fn default() -> Self {
        Self { may_be_small: platform::IS_PAGE, is_small: false, below: Below::default(), step: None, embedded: None }
    }
}

impl Room {
    /// Brings a lesson to the front when it opens and at each step, and the sliders when it closes.
    pub fn follow(&mut self, step: Option<(usize, usize)>) {
        if std::mem::replace(&mut self.step, step) != step {
            self.below = if step.is_some() { Below::Lesson } else { Below::Sliders };
        }
    }
}

/// What stands under the pane of a small screen, or beside it where the screen is wide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Below {
    #[default]
    Sliders,
    Measurements,
    Fit,
    /// The open lesson.
    Lesson,
    Nothing,
}

/// What a frame in another page shows, and nothing else.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Embedded {
    pub panes: Vec<PaneId>,
    pub has_sliders: bool,
}

/// What follows the address of a page after `?`.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Query {
    pub embedded: Option<Embedded>,
    /// The lesson by its place in the list.
    pub lesson: Option<usize>,
    /// Whether the page tells what stands where, for a program that tries it out.
    pub is_probed: bool,
}

impl Query {
    /// Reads `embed=dolp,lobes,sliders&lesson=02&probe`; what means nothing is left out.
    #[cfg_attr(not(target_arch = "wasm32"), allow(dead_code, reason = "windows of a desktop have no address"))]
    pub fn new(text: &str) -> Self {
        let mut query = Self::default();
        for (key, value) in text.trim_start_matches('?').split('&').map(|part| part.split_once('=').unwrap_or((part, ""))) {
            match key {
                "embed" => {
                    let words = || value.split("%2C").flat_map(|part| part.split(','));
                    let mut panes: Vec<PaneId> = Vec::new();
                    for pane in words().filter_map(|word| PaneId::try_from(word.to_owned()).ok()) {
                        if !panes.contains(&pane) {
                            panes.push(pane);
                        }
                    }
                    let has_sliders = words().any(|word| word == "sliders");
                    query.embedded = (!panes.is_empty() || has_sliders).then_some(Embedded { panes, has_sliders });
                }
                "lesson" => query.lesson = value.parse().ok().and_then(|number: usize| number.checked_sub(1)),
                "probe" => query.is_probed = true,
                _ => {}
            }
        }
        query
    }
}

impl Embedded {
    /// Side by side, or one above the other.
    pub fn layout(&self, size: Vec2) -> Layout {
        let parts = self.panes.iter().map(|pane| (1.0, Layout::Pane(*pane))).collect();
        if size.x > size.y { Layout::Columns(parts) } else { Layout::Rows(parts) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Embedded, Query};
    use crate::app::work::pane_id::PaneId;

    #[test]
    fn an_address_says_what_a_frame_shows() {
        let embedded = |panes: &[PaneId], has_sliders| Some(Embedded { panes: panes.to_vec(), has_sliders });
        let both = [PaneId::Dolp, PaneId::Lobes];
        assert_eq!(
            Query::new("?embed=dolp,lobes&lesson=02"),
            Query { embedded: embedded(&both, false), lesson: Some(1), is_probed: false }
        );
        assert!(Query::new("?lesson=02&probe").is_probed);
        assert_eq!(Query::new("?embed=dolp%2Clobes,sliders,dolp,x").embedded, embedded(&both, true));
        for nothing in ["", "?", "?embed=", "?embed=x&lesson=0", "?lesson=two&&=", "?lesson=-1"] {
            assert_eq!(Query::new(nothing), Query::default(), "{nothing}");
        }
    }
}
