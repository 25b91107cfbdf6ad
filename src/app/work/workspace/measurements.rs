//! Measurements are opened, closed, named and chosen; surfaces are pinned.

use super::Workspace;
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::open_measurement::{MeasurementStyle, OpenMeasurement};
use crate::app::work::sharing::Sharing;
use crate::app::work::surface::PinnedSurface;
use pbrdf::model::{Model, Parameters};

impl Workspace {
    /// Adds a measurement to those that are open, and makes it the active one. Its sliders begin
    /// where those of the active one stand.
    pub(super) fn open(&mut self, mut opened: OpenMeasurement) {
        opened.surface = self.surface().clone();
        opened.surface.adapt_to(&opened.measurement);
        if self.measurements.is_placeholder() {
            self.settings.adapt_to(&opened);
        } else {
            self.settings.adapt_beside_others(&opened);
        }
        let before = Sharing::stated(self.measurements.measured());
        let was_single = self.measurements.measured().count() == 1;
        self.measurements.add(opened);
        self.share_as_stated(was_single, before);
        let Self { measurements, fit_history, .. } = self;
        if let Some(fit) = fit_history.reattach(measurements.active(), |number| measurements.get(number).is_some()) {
            self.show_fit(fit);
        }
        self.moved_at = 0;
    }

    /// A second measurement is a different sample, or shares all but n and k with the first where their files say one sample at several
    /// wavelengths. What is no longer one sample by its files shares nothing.
    fn share_as_stated(&mut self, was_single: bool, before: Sharing) {
        let (shared, stated) = (self.measurements.shared(), Sharing::stated(self.measurements.measured()));
        let is_another = before == Sharing::Wavelengths && shared == before.shared() && stated != before;
        self.measurements.share(if was_single || is_another { stated.shared() } else { shared });
    }

    /// Puts a measurement in the place of all that are open; no step of undo of its own. The sliders
    /// stay.
    pub(in crate::app::work) fn open_alone(&mut self, mut opened: OpenMeasurement) {
        opened.surface = self.surface().clone();
        opened.surface.adapt_to(&opened.measurement);
        self.settings.adapt_to(&opened);
        self.measurements = MeasurementList::single(opened);
        self.replace_step();
    }

    /// Takes a measurement off the list; undo brings it back with its results.
    pub(super) fn close(&mut self, number: u64) {
        self.record_step();
        self.measurements.close(number);
        self.moved_at = 0;
    }

    /// Shows another measurement. That is no step of undo; a step leads back to the measurement that
    /// it was made on.
    pub(super) fn activate(&mut self, number: u64) {
        if number == self.active().number || self.measurements.get(number).is_none() {
            return;
        }
        self.undo.record(self.setup());
        self.measurements.activate(number);
        self.moved_at = 0;
        self.replace_step();
    }

    pub(super) fn rename(&mut self, number: u64, name: String) {
        if let Some(open) = self.measurements.get_mut(number) {
            self.settings.panes.results.rename(&open.name, &name);
            open.name = name;
            open.is_placeholder = false;
        }
    }

    pub(super) fn set_style(&mut self, number: u64, style: MeasurementStyle) {
        if let Some(open) = self.measurements.get_mut(number) {
            open.style = style;
        }
    }

    pub(super) fn pin(&mut self, name: &str, model: Model, parameters: Parameters) {
        let colors: Vec<usize> = self.measurements.iter().map(|open| open.style.color).collect();
        self.pinned.push(PinnedSurface::new(name, model, parameters, &self.pinned, &colors));
    }

    /// These surfaces pinned, and no others.
    pub(in crate::app::work) fn pin_alone(&mut self, surfaces: Vec<(String, Model, Parameters)>) {
        self.pinned.clear();
        surfaces.into_iter().for_each(|(name, model, parameters)| self.pin(&name, model, parameters));
    }

    pub(super) fn set_pin(&mut self, place: usize, pin: PinnedSurface) {
        if let Some(pinned) = self.pinned.get_mut(place) {
            *pinned = pin;
        }
    }

    pub(super) fn unpin(&mut self, place: usize) {
        if place < self.pinned.len() {
            self.pinned.remove(place);
            let options = &mut self.settings.view_options;
            options.hemisphere_less = options.hemisphere_less.and_then(|reference| reference.without(place));
        }
    }

    pub(super) fn use_pin(&mut self, place: usize) {
        if let Some(&PinnedSurface { model, parameters, .. }) = self.pinned.get(place) {
            self.measurements.set_model(model);
            self.move_to(parameters);
        }
    }
}
