//! How a step of a lesson is set up: data and settings as the lesson's beginning and all steps up
//! to this one set them, whatever the user moved meanwhile.

use crate::app::work::lesson::{Data, Step};
use crate::app::work::open_measurement::{EXAMPLES, Mask, OpenMeasurement};
use crate::app::work::settings::Settings;
use crate::app::work::surface::Surface;
use crate::app::work::workspace::Workspace;
use pbrdf::measurement::Measurement;

impl Workspace {
    /// Sets up the last of these steps of a lesson, which `begins` if no step of it was shown
    /// before. Undo leads to the step before it, so that the two can be compared.
    pub fn set_up_lesson(&mut self, steps: &[Step], begins: bool) {
        self.forget_fits();
        let mut fresh = begins;
        for length in steps.len().saturating_sub(1).max(1)..=steps.len() {
            self.set_up_step(&steps[..length], fresh);
            if fresh {
                self.replace_step();
            } else {
                self.record_step();
            }
            fresh = false;
        }
    }

    /// Data and settings of the last of these steps. Where a lesson begins, open data of the same
    /// name may be the user's own.
    fn set_up_step(&mut self, steps: &[Step], begins: bool) {
        let simulated = |name: String, measurement: Option<Measurement>| (name, measurement.unwrap_or_default());
        let read = |text: &str| Measurement::read(text.as_bytes()).ok();
        let (name, measurement): (String, Measurement) = match steps.iter().rev().find_map(|step| step.data.as_ref()) {
            Some(Data::Nothing) => (String::new(), Measurement::default()),
            Some(Data::Simulated(simulation)) => simulated(simulation.name(), simulation.measurement()),
            Some(Data::Example(name)) => {
                let example = EXAMPLES.iter().find(|example| example.name == name).unwrap_or(&EXAMPLES[0]);
                // A test reads every bundled example.
                simulated(example.name.to_owned(), read(example.text))
            }
            None => simulated(EXAMPLES[0].name.to_owned(), read(EXAMPLES[0].text)),
        };
        if begins || self.active().name != name {
            self.open_alone(OpenMeasurement::new(name, measurement));
        }
        let mut settings = Settings::default();
        settings.adapt_to(self.active());
        let mut surface = Surface::for_measurement(&self.active().measurement);
        steps.iter().for_each(|step| apply(step, &mut settings, &mut surface));
        // No file of an example masks a row.
        self.set_up(settings, surface, &Mask::default());
        let pins = steps.iter().rev().find_map(|step| step.staging.pins.as_ref());
        self.pin_alone(pins.into_iter().flatten().map(|pin| pin.of(self.surface())).collect());
    }
}

/// What a step sets; what it does not name stays.
fn apply(step: &Step, settings: &mut Settings, surface: &mut Surface) {
    let current = surface.model;
    surface.model = step.preset.map_or(current, |preset| preset.model.with_dolp_formula(current.dolp_formula));
    for &(parameter, value) in &step.set {
        surface.parameters[parameter] = value;
    }
    surface.model = surface.model.with_dolp_formula(step.staging.formula.unwrap_or(surface.model.dolp_formula));
    step.staging.picture.iter().for_each(|setting| setting.apply(&mut settings.panes.picture));
    settings.theta_i = step.theta_i.unwrap_or(settings.theta_i);
    settings.dphi = step.dphi.unwrap_or(settings.dphi);
    settings.log_brdf = step.log.unwrap_or(settings.log_brdf);
    settings.metal_selection.look_at(step.metal);
    settings.metal_selection.wavelength_nm = step.wavelength_nm.unwrap_or(settings.metal_selection.wavelength_nm);
}
