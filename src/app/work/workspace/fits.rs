//! Fits arrive, and are looked at again.

use super::Workspace;
use super::results::Results;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::open_measurement::OpenMeasurement;
use pbrdf::fit::FitResult;
use pbrdf::model::{Model, Parameters};
use std::sync::Arc;

impl Workspace {
    pub(super) fn active_results(&mut self) -> &mut Results {
        let number = self.active().number;
        self.results.of_mut(number)
    }

    /// Shows a fit of its measurement; profile and bootstrap of another one are dropped.
    pub(super) fn show_fit(&mut self, fit: Arc<FitEntry>) {
        let results = self.results.of_mut(fit.number);
        results.shown_fit = Some(fit);
        results.diagnostics.forget();
    }

    /// Shows no fit of the active measurement, and no comparison of models.
    pub(in crate::app::work) fn forget_fits(&mut self) {
        let number = self.active().number;
        self.results.forget(number);
    }

    /// A fit reaches its measurement, which may not be the active one any more.
    pub(super) fn add_fit(&mut self, fit: FitEntry) {
        let (number, parameters) = (fit.number, fit.report.parameters);
        let fit = self.fit_history.push(fit);
        self.show_fit(fit);
        if number == self.active().number {
            self.moved_at = 0;
        }
        self.measurements.set_parameters_of(number, parameters);
        if let Some(open) = self.measurements.get_mut(number) {
            open.is_placeholder = false;
        }
    }

    /// Brings back a fit with its values and its data, closed ones too.
    pub(super) fn return_to_fit(&mut self, index: usize) {
        let Some(fit) = self.fit_history.get(index) else { return };
        if self.measurements.get(fit.number).is_none() {
            self.record_step();
            self.measurements.reopen(fit.number, || fit.measurement());
        }
        self.activate(fit.number);
        self.take_values(fit.report.parameters, fit.report.model);
        self.show_fit(fit);
    }

    pub(super) fn set_fit_report(&mut self, id: usize, report: FitResult) {
        let Some(before) = self.fit_history.iter().find(|fit| fit.id == id).map(|fit| fit.report.parameters) else { return };
        let (after, model) = (report.parameters, report.model);
        let Some(fit) = self.fit_history.replace_report(id, report) else { return };
        let stands_there = |open: &OpenMeasurement| (open.surface.parameters, open.surface.model) == (before, model);
        if after != before && self.measurements.get(fit.number).is_some_and(stands_there) {
            self.record_step();
            self.take_values_of(fit.number, after, model);
            // Undo goes from the better minimum to what was before the fit.
            self.replace_step();
        }
        for results in self.results.showing(id) {
            results.shown_fit = Some(fit.clone());
            if after != before {
                results.diagnostics.forget();
            }
        }
    }

    fn take_values_of(&mut self, number: u64, parameters: Parameters, model: Model) {
        if number == self.active().number {
            self.take_values(parameters, model);
        } else {
            self.measurements.set_parameters_of(number, parameters);
        }
    }
}
