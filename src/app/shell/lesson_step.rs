//! Shows a step of a lesson: its data and settings, and its panes as they lie at the lesson's beginning.

use crate::app::shell::app::App;
use crate::app::views::Views;
use crate::app::work::lesson::Step;
use crate::app::work::pane_id::PaneId;

impl App {
    /// Sets up a step, whichever way the user came to it.
    pub(crate) fn set_up_step(&mut self, lesson: usize, step: usize, begins: bool) {
        let Some(steps) = self.lessons.all.get(lesson).and_then(|lesson| lesson.steps.get(..=step)).map(<[Step]>::to_vec) else { return };
        self.jobs.fits.abandon();
        let open = self.work.document.number;
        self.work.set_up_lesson(&steps, begins);
        if self.work.document.number != open {
            self.import = None;
            self.views = Views::default();
        }
        let mut panes = self.panes_at_its_beginning();
        for step in &steps {
            let named: Vec<PaneId> = step.panes.iter().filter_map(|name| PaneId::try_from(name.clone()).ok()).collect();
            panes.show_together(&named);
        }
        // An arrangement that is right already keeps what the user has unfolded in it.
        if panes.layout() != self.panes.layout() {
            self.panes = panes;
        }
    }
}
