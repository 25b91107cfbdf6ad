//! How a step of a lesson is set up: data, sliders and panes as the lesson's beginning and all steps up to it set them, whichever way the
//! user came to it and whatever was moved meanwhile.

use crate::app::shell::app::App;
use crate::app::work::document::{EXAMPLES, Mask};
use crate::app::work::lesson::{Data, Step};
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::Settings;

impl App {
    /// Sets up a step. Undo leads to the step before as that is set up, so that the two can be compared.
    pub(crate) fn set_up_step(&mut self, lesson: usize, step: usize, begins: bool) {
        let Some(steps) = self.lessons.all.get(lesson).and_then(|lesson| lesson.steps.get(..=step)).map(<[Step]>::to_vec) else { return };
        self.jobs.fits.abandon();
        self.show_fit(None);
        self.work.model_comparison.clear();
        let mut fresh = begins;
        for length in step.max(1)..=step + 1 {
            self.set_up(&steps[..length], fresh);
            let setup = self.work.setup();
            if fresh {
                self.work.undo.replace(setup);
            } else {
                self.work.undo.rest(setup);
            }
            fresh = false;
        }
        self.work.last_refit_at = Some(self.work.settings.parameters);
        let mut panes = self.panes_at_its_beginning();
        for step in &steps {
            let named: Vec<PaneId> = step.panes.iter().filter_map(|name| PaneId::try_from(name.clone()).ok()).collect();
            panes.show_together(&named);
        }
        // Dock that lie as they should stay, with what is unfolded in them.
        if panes.layout() != self.panes.layout() {
            self.panes = panes;
        }
    }

    /// Data and settings of the last of these steps. Where a lesson begins, data of the same name may be the user's own.
    fn set_up(&mut self, steps: &[Step], begins: bool) {
        let (name, text) = match steps.iter().rev().find_map(|step| step.data.as_ref()) {
            Some(Data::Nothing) => ("", None),
            Some(Data::Example(name)) => {
                let example = EXAMPLES.iter().find(|example| example.name == name).unwrap_or(&EXAMPLES[0]);
                (example.name, Some(example.text))
            }
            None => (EXAMPLES[0].name, Some(EXAMPLES[0].text)),
        };
        if begins || self.work.document.name != name {
            let read = |text: &str| pbrdf::measurement::Measurement::read(text.as_bytes());
            // Tests read all that are bundled.
            self.take(name.to_owned(), text.and_then(|text| read(text).ok()).unwrap_or_default());
        }
        // No row of an example is masked by its file.
        self.work.document.restore_mask(&Mask::default());
        let mut settings = Settings::default();
        settings.suit(&self.work.document);
        steps.iter().for_each(|step| apply(step, &mut settings));
        self.work.settings = settings;
    }
}

/// What a step sets; what it does not name stays.
fn apply(step: &Step, settings: &mut Settings) {
    let current = settings.model;
    settings.model = step.preset.map_or(current, |preset| preset.model.with_dolp_formula(current.dolp_formula));
    for &(parameter, value) in &step.set {
        settings.parameters[parameter] = value;
    }
    settings.theta_i = step.theta_i.unwrap_or(settings.theta_i);
    settings.dphi = step.dphi.unwrap_or(settings.dphi);
    settings.log_brdf = step.log.unwrap_or(settings.log_brdf);
    settings.tabulated.look_at(step.metal);
    settings.tabulated.wavelength_nm = step.wavelength_nm.unwrap_or(settings.tabulated.wavelength_nm);
}
