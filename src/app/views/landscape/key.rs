//! The inputs of a landscape.

use pbrdf::fit::{FitOptions, LandscapeAxis};
use pbrdf::model::{Model, Parameters};

/// What a landscape depends on: everything but where the sliders of its own two parameters stand.
#[derive(Debug, Clone, PartialEq)]
pub struct LandscapeKey {
    pub generation: u64,
    pub others: Parameters,
    pub model: Model,
    pub fit_options: FitOptions,
    /// Where the residuals are looked at that set the scale of a robust loss.
    pub scale_at: Option<Parameters>,
    pub across: LandscapeAxis,
    pub up: LandscapeAxis,
}

impl LandscapeKey {
    /// Whether the landscape of these inputs is worth waiting for while other ones are wanted:
    /// under a moving slider each coarse one is a picture on the way. A fine one, or one of other
    /// data, is not.
    pub fn is_of_use(&self, wanted: &Self, coarse: &Self) -> bool {
        let subject = |key: &Self| (key.generation, key.model, key.fit_options, key.across.parameter, key.up.parameter, key.across.count);
        self == wanted || subject(self) == subject(coarse)
    }
}
