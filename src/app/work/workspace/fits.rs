//! Fits arrive, and are looked at again.

use super::Workspace;
use super::results::Results;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::model_fit::{ComparedModel, ModelFit, NotFitted};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::posterior::DrawnPosterior;
use crate::app::work::weakest_walk::WeakestWalk;
use pbrdf::fit::posterior::LogEvidence;
use pbrdf::fit::{FitResult, JointResult};
use pbrdf::model::{Model, Parameters, Preset};
use std::sync::Arc;

impl Workspace {
    pub(super) fn active_results(&mut self) -> &mut Results {
        let number = self.active().number;
        self.results.of_mut(number)
    }

    /// The preset that the sliders show: that of the shown fit while they stand at it, since several
    /// presets have the same terms.
    pub fn preset(&self) -> Option<&'static Preset> {
        let surface = self.surface();
        let stands_there = |fit: &&Arc<FitEntry>| (fit.report.model, fit.report.parameters) == (surface.model, surface.parameters);
        self.shown_fit().filter(stands_there).map_or_else(|| Preset::of(surface.model), |fit| fit.preset())
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
        let Some(fit) = self.fit_history.get(index, self.active().number) else { return };
        let mut parts: Vec<Arc<FitEntry>> = self.fit_history.parts(fit.id).cloned().collect();
        parts.sort_by_key(|part| part.joint.as_ref().map(|joint| joint.set));
        if parts.iter().any(|part| self.measurements.get(part.number).is_none()) {
            self.record_step();
        }
        for part in parts.iter().filter(|part| self.measurements.get(part.number).is_none()).collect::<Vec<_>>() {
            self.measurements.reopen(part.number, || part.measurement());
        }
        self.activate(fit.number);
        if let Some(joint) = &fit.joint {
            self.measurements.set_shared(joint.of.shared);
        }
        for part in parts {
            self.measurements.set_values_of(part.number, part.report.model, part.report.parameters);
            self.show_fit(part);
        }
        self.moved_at = 0;
    }

    /// Values of the shown fit to the sliders of its measurements, with its model or without.
    pub(super) fn use_shown_fit(&mut self, values: impl Fn(&FitEntry) -> Parameters, with_model: bool) {
        let Some(shown) = self.shown_fit().cloned() else { return };
        if with_model {
            self.measurements.set_model(shown.report.model);
        }
        self.move_to(values(&shown));
        let others = self.fit_history.parts(shown.id).filter(|part| part.number != shown.number);
        let others: Vec<(u64, Parameters)> = others.map(|part| (part.number, values(part))).collect();
        for (number, parameters) in others {
            self.measurements.set_parameters_of(number, parameters);
        }
        self.measurements.set_parameters(values(&shown));
    }

    /// Puts the result with intervals in the place of that of a joint fit. If its minimum is a better one, sliders that stand at the
    /// minimum before follow.
    pub(super) fn set_joint_result(&mut self, id: usize, result: JointResult) {
        let before: Vec<(u64, Parameters)> = self.fit_history.parts(id).map(|fit| (fit.number, fit.report.parameters)).collect();
        let parts = self.fit_history.replace_joint(id, result);
        let stands_there = |(number, parameters): &(u64, Parameters)| {
            self.measurements.get(*number).is_some_and(|open| open.surface.parameters == *parameters)
        };
        let is_better = parts.iter().zip(&before).any(|(part, (_, before))| part.report.parameters != *before);
        if is_better && before.iter().all(stands_there) {
            self.record_step();
            for part in &parts {
                self.measurements.set_values_of(part.number, part.report.model, part.report.parameters);
            }
            self.moved_at = 0;
            // Undo goes from the better minimum to what was before the fit.
            self.replace_step();
        }
        for part in parts {
            for results in self.results.showing(id, part.number) {
                results.shown_fit = Some(part.clone());
                if is_better {
                    results.diagnostics.forget();
                }
            }
        }
    }

    /// Evidence reaches its rows of the comparison.
    pub(super) fn set_evidence(&mut self, number: u64, found: Vec<(usize, Option<LogEvidence>)>) {
        let comparison = &mut self.results.of_mut(number).model_comparison;
        for (row, evidence) in found {
            comparison.get_mut(row).into_iter().for_each(|row| row.evidence = evidence);
        }
    }

    /// Draws reach the measurements that they are of.
    pub(super) fn set_posterior(&mut self, drawn: &Arc<DrawnPosterior>) {
        for &number in &drawn.from.numbers {
            self.results.of_mut(number).posterior = Some(drawn.clone());
        }
    }

    /// A way from a fit reaches its measurements.
    pub(super) fn set_walk(&mut self, walk: &Arc<WeakestWalk>) {
        for &number in &walk.numbers {
            self.results.of_mut(number).walk = Some((walk.clone(), 0.0));
        }
    }

    /// Sliders go to a place of the way from the shown fit.
    pub(super) fn walk_to(&mut self, share: f64) {
        let Some((walk, _)) = self.walk().cloned() else { return };
        for &number in &walk.numbers {
            if let Some((_, walked)) = &mut self.results.of_mut(number).walk {
                *walked = share;
            }
        }
        self.use_draw(&walk.at(share));
    }

    /// Values of one draw to the sliders of the measurements of those numbers; the live refit does not begin there.
    pub(super) fn use_draw(&mut self, values: &[(u64, Parameters)]) {
        let active = self.active().number;
        for (number, parameters) in values {
            self.measurements.set_parameters_of(*number, *parameters);
        }
        // What is shared is the same in all; the active surface has the last word in rounding.
        if let Some((_, parameters)) = values.iter().find(|(number, _)| *number == active) {
            self.measurements.set_parameters(*parameters);
        }
        self.moved_at = 0;
    }

    /// The fits of a comparison join the history, the first row as the newest; none is shown.
    pub(super) fn set_model_comparison(&mut self, numbers: &[u64], models: Vec<ComparedModel>) {
        let mut comparisons: Vec<Vec<ModelFit>> = numbers.iter().map(|_| Vec::new()).collect();
        for ComparedModel { preset, result } in models.into_iter().rev() {
            let fits = result.map(|fits| fits.into_iter().map(|fit| self.add_to_history(fit)).collect::<Vec<_>>());
            for (number, comparison) in numbers.iter().zip(&mut comparisons) {
                let its = |fits: &Vec<Arc<FitEntry>>| fits.iter().find(|fit| fit.number == *number).cloned();
                let result = fits.as_ref().map(its).map_err(NotFitted::clone);
                comparison.extend(result.transpose().map(|result| ModelFit { preset, result, evidence: None }));
            }
        }
        for (&number, mut comparison) in numbers.iter().zip(comparisons) {
            comparison.reverse();
            self.results.of_mut(number).model_comparison = comparison;
        }
    }

    /// The fit in the history, under the name that its measurement has now.
    fn add_to_history(&mut self, mut fit: FitEntry) -> Arc<FitEntry> {
        if let Some(open) = self.measurements.get(fit.number) {
            fit.document.clone_from(&open.name);
        }
        self.fit_history.push(fit)
    }

    /// Shows the fit of a row of the comparison, and takes its values; of a joint fit those of all its measurements.
    pub(super) fn use_model_fit(&mut self, index: usize) {
        let Some(Ok(fit)) = self.model_comparison().get(index).map(|row| row.result.as_ref()) else { return };
        let fit = fit.clone();
        self.take_values(fit.report.parameters, fit.report.model);
        if fit.joint.is_some() {
            let parts: Vec<Arc<FitEntry>> = self.fit_history.parts(fit.id).filter(|part| part.number != fit.number).cloned().collect();
            for part in parts {
                self.measurements.set_values_of(part.number, part.report.model, part.report.parameters);
                self.show_fit(part);
            }
        }
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
        for results in self.results.showing(id, fit.number) {
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
