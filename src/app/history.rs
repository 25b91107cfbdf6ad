//! Undo and redo of the sliders: one step for a drag, a typed value, a fit.

use super::document::Mask;
use pbrdf::model::{Model, Parameters};

/// What one step brings back.
pub type Step = (Parameters, Model, Mask, u64);

/// Steps back and forth.
#[derive(Debug, Default)]
pub struct History {
    past: Vec<Step>,
    current: Option<Step>,
    future: Vec<Step>,
}

/// Steps that are kept.
const LONGEST: usize = 200;

impl History {
    /// Takes down where the sliders have come to rest, if that is somewhere new.
    pub fn rest(&mut self, at: Step) {
        if self.current.as_ref() == Some(&at) {
            return;
        }
        if let Some(before) = self.current.replace(at) {
            self.past.push(before);
            self.future.clear();
            if self.past.len() > LONGEST {
                self.past.remove(0);
            }
        }
    }

    /// One step back, if there is one.
    pub fn undo(&mut self) -> Option<Step> {
        let before = self.past.pop()?;
        self.future.extend(self.current.replace(before.clone()));
        Some(before)
    }

    /// One step forth, if there is one.
    pub fn redo(&mut self) -> Option<Step> {
        let after = self.future.pop()?;
        self.past.extend(self.current.replace(after.clone()));
        Some(after)
    }

    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    pub fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }
}
