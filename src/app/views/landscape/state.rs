//! What the pane of the landscape keeps from frame to frame.

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::jobs::memo::Memo;
use crate::app::plots::{FigurePlot, Range};
use crate::app::text::i18n::Language;
use crate::app::views::landscape::drawn::LandscapeImage;
use crate::app::views::landscape::key::LandscapeKey;
use crate::app::views::landscape::marks::{Marks, MarksKey};
use crate::app::work::settings::LandscapeAxes;
use pbrdf::model::Parameter;

/// What the pane keeps.
#[derive(Default)]
pub struct LandscapeView {
    pub job: AsyncMemo<LandscapeKey, Option<LandscapeImage>>,
    pub marks: Memo<MarksKey, Marks>,
    /// The parameters of the axes and what is looked at of them.
    pub look: Option<(Parameter, Parameter, [Range; 2])>,
    pub plot: FigurePlot<FigureKey>,
}

/// The landscape by its inputs, what is shown of it, the marks by their stamp, the bits of the
/// sliders' place, the language.
pub type FigureKey = (LandscapeKey, LandscapeAxes, u64, [u64; 2], Language);
