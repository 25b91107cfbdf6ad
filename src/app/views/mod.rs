//! What the panes show: a file for each, with what it keeps, what it makes anew before a frame, and how it is drawn.

mod table;

pub use table::{table_refresh, table_ui};

/// What the panes keep from frame to frame.
#[derive(Default)]
pub struct Views {
    pub table: table::TableView,
}
