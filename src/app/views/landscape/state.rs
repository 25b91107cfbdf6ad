//! What the pane of the landscape keeps from frame to frame.

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::jobs::memo::Memo;
use crate::app::plots::Range;
use crate::app::views::landscape::drawn::LandscapeImage;
use crate::app::views::landscape::key::LandscapeKey;
use crate::app::views::landscape::marks::{Marks, MarksKey};
use egui::TextureHandle;
use pbrdf::model::Parameter;

/// What the pane keeps.
#[derive(Default)]
pub struct LandscapeView {
    pub job: AsyncMemo<LandscapeKey, Option<LandscapeImage>>,
    pub textured: Memo<LandscapeKey, ()>,
    pub texture: Option<TextureHandle>,
    pub marks: Memo<MarksKey, Marks>,
    /// The parameters of the axes and what is seen of them, once the plot was drawn.
    pub seen: Option<(Parameter, Parameter, [Range; 2])>,
    /// What the next frame shows, where that is somewhere else.
    pub wanted: Option<[Range; 2]>,
}
