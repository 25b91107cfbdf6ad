//! Fits that the window starts, and what it does with their results.

use crate::app::shell::app::App;
use crate::app::tasks::fit_work::RefitSliders;
use crate::app::tasks::fit_work::{FinishedIntervals, Fitted, WithIntervals};
use crate::app::text::localized::Localized as _;
use crate::app::work::diagnostics::ProfileCurve;
use crate::app::work::edit::Edit;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::fit_setup::{explain, fit_problem, free, is_joint, joint_problem, joint_problem_of};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::settings::Settings;
use crate::app::work::surface::Surface;
use crate::app::work::workspace::Workspace;
use pbrdf::fit::{Bootstrap, FitOptions, Problem, Profile, free_by_default};
use pbrdf::model::{PRESETS, Parameter, ParameterSet};
use tr::tr;

pub fn start_fit(app: &mut App) -> Result<(), String> {
    let Settings { fit_options, starts, seed, .. } = *app.work.settings();
    let list = app.work.measurements();
    if !is_joint(list) {
        let problem = problem_of(app, app.work.active())?;
        return app.jobs.fits.fit(problem, app.work.active(), starts, seed);
    }
    list.measured().try_for_each(validate)?;
    let problem = joint_problem(list, ParameterSet::EMPTY, fit_options).map_err(|error| cannot_begin(&error.localized()))?;
    app.jobs.fits.fit_jointly(problem, list, starts, seed)
}

/// Fits every measurement by itself.
pub fn fit_each(app: &mut App) -> Result<(), String> {
    let Settings { starts, seed, .. } = *app.work.settings();
    let problem = |open: &OpenMeasurement| -> Result<_, String> {
        let problem = problem_of(app, open).map_err(|sentence| format!("{}: {sentence}", open.title()))?;
        Ok((problem, open.clone()))
    };
    let problems = app.work.measurements().measured().map(problem).collect::<Result<_, _>>()?;
    app.jobs.fits.fit_each(problems, starts, seed)
}

/// The problem of fitting a measurement by itself.
pub fn problem_of(app: &App, open: &OpenMeasurement) -> Result<Problem, String> {
    validate(open)?;
    let (surface, measurement) = (&open.surface, &open.measurement);
    let free = free(surface, measurement.has_brdf());
    let problem = fit_problem(surface, measurement, surface.model, free, app.work.settings().fit_options);
    problem.map_err(|error| cannot_begin(&explain(&error, measurement)))
}

fn validate(open: &OpenMeasurement) -> Result<(), String> {
    let Surface { parameters, model, .. } = open.surface;
    parameters.validate(model.parameters()).map_err(|error| cannot_begin(&error.localized()))
}

fn cannot_begin(reason: &str) -> String {
    tr!("The fit cannot begin: {}.", reason)
}

pub fn fitted(app: &mut App, mut fits: Vec<FitEntry>) {
    for fit in &mut fits {
        if let Some(open) = app.work.measurements().get(fit.number) {
            fit.before = open.surface.parameters;
            fit.document.clone_from(&open.name);
        }
    }
    let numbers: Vec<u64> = fits.iter().map(|fit| fit.number).collect();
    app.work.apply(Edit::AddFits(fits));
    let active = app.work.active().number;
    if numbers.contains(&active) {
        app.jobs.fits.abandon_scan();
    }
    // Those of one joint fit are found at once.
    if let Some(&number) = numbers.first()
        && let Err(sentence) = find_intervals_of(app, number)
    {
        app.toasts.error(sentence);
    }
}

/// Finds the intervals of the shown fit where it has none yet.
pub fn find_intervals(app: &mut App) -> Result<(), String> {
    find_intervals_of(app, app.work.active().number)
}

/// The same of the fit that is shown of a measurement.
fn find_intervals_of(app: &mut App, number: u64) -> Result<(), String> {
    let fit = app.work.shown_fit_of(number).filter(|fit| fit.report.course.intervals_complete.is_none());
    match fit.map(|fit| (fit, fit.counts())) {
        Some((fit, (values, free))) if values > 0 && free > 0 => app.jobs.fits.intervals(whole(&app.work, fit)),
        _ => Ok(()),
    }
}

/// A fit of the history with all its parts.
pub fn whole(work: &Workspace, fit: &FitEntry) -> Fitted {
    let mut parts = Vec::new();
    if fit.joint.is_some() {
        parts.extend(work.fit_history().parts(fit.id).map(|part| FitEntry::clone(part)));
        parts.sort_by_key(|part| part.joint.as_ref().map(|part| part.set));
    }
    Fitted { fit: fit.clone(), parts }
}

/// Stops what is about the sliders and the shown fit where another measurement has become active.
pub fn follow_active(app: &mut App) {
    let number = app.work.active().number;
    if std::mem::replace(&mut app.jobs.fits.active, number) != number {
        app.jobs.fits.refit.abandon();
        app.jobs.fits.abandon_scan();
    }
}

pub fn intervals_found(app: &mut App, FinishedIntervals { id, result }: FinishedIntervals) {
    match result {
        Some(WithIntervals::One(report)) => app.work.apply(Edit::SetFitReport { id, report }),
        Some(WithIntervals::Joint(result)) => app.work.apply(Edit::SetJointResult { id, result }),
        None => {}
    }
}

/// Fits what is free again after the user moved a slider, one fit at a time; what was moved is held.
pub fn refit_if_moved(app: &mut App) {
    let fits = &mut app.jobs.fits;
    let moved_at = app.work.moved_at();
    if !app.work.settings().refit_live || fits.refit.is_running() || fits.fit.is_running() || moved_at <= fits.refitted_at {
        return;
    }
    fits.refitted_at = moved_at;
    // Why a fit is not possible is said when one is asked for.
    if let Some(from_sliders) = from_sliders(app)
        && let Err(sentence) = app.jobs.fits.refit(from_sliders)
    {
        app.toasts.error(sentence);
    }
}

fn from_sliders(app: &App) -> Option<RefitSliders> {
    let (list, moved, fit_options) = (app.work.measurements(), app.work.moved(), app.work.settings().fit_options);
    if is_joint(list) {
        list.measured().try_for_each(validate).ok()?;
        let problem = joint_problem(list, moved, fit_options).ok().filter(|problem| !problem.unknowns().is_empty())?;
        return Some(RefitSliders::joint(problem, list.measured().cloned().collect(), list.shared()));
    }
    let open = list.active();
    let free = app.free().without_all(moved);
    validate(open).ok().filter(|()| !free.is_empty())?;
    let problem = fit_problem(&open.surface, &open.measurement, open.surface.model, free, fit_options).ok()?;
    Some(RefitSliders::one(problem, open.clone()))
}

/// Fits the ladder of models to the active measurement, or to all of them where they share something.
pub fn compare_models(app: &mut App) -> Result<(), String> {
    let (list, settings) = (app.work.measurements(), app.work.settings());
    let (starts, seed, active) = (settings.starts, settings.seed, list.active());
    let ladder = || {
        PRESETS.iter().map(|preset| {
            let fit_options = FitOptions { dolp_only: preset.dolp_only, ..settings.fit_options };
            (preset, preset.model.with_dolp_formula(active.surface.model.dolp_formula), fit_options)
        })
    };
    if is_joint(list) {
        let problem = |(preset, model, fit_options)| (preset, joint_problem_of(list, model, fit_options));
        let problems: Vec<_> = ladder().map(problem).collect();
        let numbers = list.measured().map(|open| open.number).collect();
        app.work.apply(Edit::SetModelComparison { numbers, models: Vec::new() });
        return app.jobs.fits.compare_jointly(app.work.measurements(), problems, starts, seed);
    }
    let problem = |(preset, model, fit_options)| {
        let free = free_by_default(model, &active.measurement, &fit_options);
        (preset, fit_problem(&active.surface, &active.measurement, model, free, fit_options))
    };
    let (problems, numbers) = (ladder().map(problem).collect(), vec![active.number]);
    app.work.apply(Edit::SetModelComparison { numbers, models: Vec::new() });
    app.jobs.fits.compare(app.work.active(), problems, starts, seed)
}

pub fn start_profile(app: &mut App, parameter: Parameter) -> Result<(), String> {
    app.work.apply(Edit::SetProfile(None));
    app.work.shown_fit().map_or(Ok(()), |fit| app.jobs.fits.profile(whole(&app.work, fit), parameter))
}

pub fn profiled(app: &mut App, profile: &Profile) {
    let curve = app.work.shown_fit().map(|fit| ProfileCurve::new(profile, fit));
    app.work.apply(Edit::SetProfile(curve));
}

pub fn start_bootstrap(app: &mut App) -> Result<(), String> {
    app.work.apply(Edit::SetBootstrap(None));
    let (replicates, seed) = (app.work.diagnostics().replicates, app.work.settings().seed);
    app.work.shown_fit().map_or(Ok(()), |fit| app.jobs.fits.bootstrap(whole(&app.work, fit), replicates, seed))
}

pub fn bootstrapped(app: &mut App, bootstrap: Bootstrap) {
    app.work.apply(Edit::SetBootstrap(Some(bootstrap)));
}
