//! Undo and redo: one step for a drag, a typed value, a switch, a fit.

/// Steps back and forth between values of whatever the user sets.
#[derive(Debug)]
pub struct History<S> {
    past: Vec<S>,
    current: Option<S>,
    future: Vec<S>,
}

/// Steps that are kept.
const LONGEST: usize = 200;

impl<S> Default for History<S> {
    fn default() -> Self {
        Self { past: Vec::new(), current: None, future: Vec::new() }
    }
}

impl<S: PartialEq + Clone> History<S> {
    /// Records a step if the state differs from the last one.
    pub fn record(&mut self, at: S) {
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

    /// Goes on from here as if it had always been so: nothing to undo.
    pub fn replace(&mut self, at: S) {
        self.current = Some(at);
    }

    /// One step back, if there is one.
    pub fn undo(&mut self) -> Option<S> {
        let before = self.past.pop()?;
        self.future.extend(self.current.replace(before.clone()));
        Some(before)
    }

    /// One step forth, if there is one.
    pub fn redo(&mut self) -> Option<S> {
        let after = self.future.pop()?;
        self.past.extend(self.current.replace(after.clone()));
        Some(after)
    }

    /// All that undo and redo lead to, and where they stand.
    pub fn steps(&self) -> impl Iterator<Item = &S> {
        self.past.iter().chain(&self.current).chain(&self.future)
    }

    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    pub fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }
}
