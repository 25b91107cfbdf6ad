//! How a step of a lesson is set up: data and settings as the lesson's beginning and all steps up to this one set them, whatever the user
//! moved meanwhile.

use crate::app::work::document::{Document, EXAMPLES, Mask};
use crate::app::work::lesson::{Data, Step};
use crate::app::work::settings::Settings;
use crate::app::work::workspace::Workspace;

impl Workspace {
    /// Sets up the last of these steps of a lesson, which `begins` if no step of it was shown before. Undo leads to the step before it, so
    /// that the two can be compared.
    pub fn set_up_lesson(&mut self, steps: &[Step], begins: bool) {
        self.touch();
        self.show_fit(None);
        self.model_comparison.clear();
        let mut fresh = begins;
        for length in steps.len().saturating_sub(1).max(1)..=steps.len() {
            self.set_up_step(&steps[..length], fresh);
            let setup = self.setup();
            if fresh {
                self.undo.replace(setup);
            } else {
                self.undo.rest(setup);
            }
            fresh = false;
        }
        self.last_refit_at = Some(self.settings.parameters);
    }

    /// Data and settings of the last of these steps. Where a lesson begins, open data of the same name may be the user's own.
    fn set_up_step(&mut self, steps: &[Step], begins: bool) {
        let (name, text) = match steps.iter().rev().find_map(|step| step.data.as_ref()) {
            Some(Data::Nothing) => ("", None),
            Some(Data::Example(name)) => {
                let example = EXAMPLES.iter().find(|example| example.name == name).unwrap_or(&EXAMPLES[0]);
                (example.name, Some(example.text))
            }
            None => (EXAMPLES[0].name, Some(EXAMPLES[0].text)),
        };
        if begins || self.document.name != name {
            let read = |text: &str| pbrdf::measurement::Measurement::read(text.as_bytes());
            // A test reads every bundled example.
            let measurement = text.and_then(|text| read(text).ok()).unwrap_or_default();
            self.open(Document::new(name.to_owned(), measurement));
        }
        // No file of an example masks a row.
        self.document.restore_mask(&Mask::default());
        let mut settings = Settings::default();
        settings.suit(&self.document);
        steps.iter().for_each(|step| apply(step, &mut settings));
        self.settings = settings;
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
