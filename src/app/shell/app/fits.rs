//! Fits that the window starts, and what it does with their results.

use crate::app::shell::app::App;
use crate::app::tasks::fits::FinishedIntervals;
use crate::app::text::localized::Localized as _;
use crate::app::work::diagnostics::ProfileCurve;
use crate::app::work::edit::Edit;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::fit_setup::{explain, fit_problem};
use crate::app::work::settings::Settings;
use crate::app::work::surface::Surface;
use pbrdf::fit::{Bootstrap, FitOptions, FitResult, Problem, Profile, free_by_default};
use pbrdf::model::{PRESETS, Parameter};
use tr::tr;

pub fn start_fit(app: &mut App) -> Result<(), String> {
    let Settings { fit_options, starts, seed, .. } = *app.work.settings();
    let (surface, open) = (app.work.surface(), app.work.active());
    let Surface { parameters, model, .. } = *surface;
    parameters.validate(model.parameters()).map_err(|error| tr!("The fit cannot begin: {}.", error.localized()))?;
    match fit_problem(surface, &open.measurement, model, app.free(), fit_options) {
        Ok(problem) => app.jobs.fits.fit(problem, open, starts, seed),
        Err(error) => Err(tr!("The fit cannot begin: {}.", explain(&error, &open.measurement))),
    }
}

pub fn fitted(app: &mut App, mut fit: Box<FitEntry>) {
    let number = fit.number;
    if let Some(open) = app.work.measurements().get(number) {
        fit.before = open.surface.parameters;
        fit.document.clone_from(&open.name);
    }
    app.work.apply(Edit::AddFit(fit));
    if number == app.work.active().number {
        app.jobs.fits.abandon_scan();
    }
    if let Err(sentence) = find_intervals_of(app, number) {
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
    match fit {
        Some(fit) if !fit.problem.is_empty() && !fit.problem.free().is_empty() => app.jobs.fits.intervals(fit),
        _ => Ok(()),
    }
}

/// Stops what is about the sliders and the shown fit where another measurement has become active.
pub fn follow_active(app: &mut App) {
    let number = app.work.active().number;
    if std::mem::replace(&mut app.jobs.fits.active, number) != number {
        app.jobs.fits.refit.abandon();
        app.jobs.fits.abandon_scan();
    }
}

pub fn intervals_found(app: &mut App, FinishedIntervals { id, report }: FinishedIntervals) {
    if let Some(report) = report {
        app.work.apply(Edit::SetFitReport { id, report });
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
    let surface = app.work.surface();
    let Surface { parameters, model, .. } = *surface;
    let free = app.free().without_all(app.work.moved());
    if parameters.validate(model.parameters()).is_err() || free.is_empty() {
        return;
    }
    // Why a fit is not possible is said when one is asked for.
    if let Ok(problem) = fit_problem(surface, &app.work.active().measurement, model, free, app.work.settings().fit_options)
        && let Err(sentence) = app.jobs.fits.refit(problem)
    {
        app.toasts.error(sentence);
    }
}

pub fn compare_models(app: &mut App) -> Result<(), String> {
    let (settings, surface, measurement) = (app.work.settings(), app.work.surface(), &app.work.active().measurement);
    let problems = PRESETS.iter().map(|preset| {
        let fit_options = FitOptions { dolp_only: preset.dolp_only, ..settings.fit_options };
        let model = preset.model.with_dolp_formula(surface.model.dolp_formula);
        let free = free_by_default(model, measurement, &fit_options);
        (preset, fit_problem(surface, measurement, model, free, fit_options))
    });
    let (problems, starts, seed) = (problems.collect(), settings.starts, settings.seed);
    let number = app.work.active().number;
    app.work.apply(Edit::SetModelComparison { number, fits: Vec::new() });
    app.jobs.fits.compare(number, problems, starts, seed)
}

pub fn start_profile(app: &mut App, parameter: Parameter) -> Result<(), String> {
    app.work.apply(Edit::SetProfile(None));
    shown_fit(app).map_or(Ok(()), |(problem, report)| app.jobs.fits.profile(problem, report, parameter))
}

pub fn profiled(app: &mut App, profile: &Profile) {
    let curve = app.work.shown_fit().map(|fit| ProfileCurve::new(profile, &fit.problem, &fit.report));
    app.work.apply(Edit::SetProfile(curve));
}

pub fn start_bootstrap(app: &mut App) -> Result<(), String> {
    app.work.apply(Edit::SetBootstrap(None));
    let (replicates, seed) = (app.work.diagnostics().replicates, app.work.settings().seed);
    shown_fit(app).map_or(Ok(()), |(problem, report)| app.jobs.fits.bootstrap(problem, report, replicates, seed))
}

pub fn bootstrapped(app: &mut App, bootstrap: Bootstrap) {
    app.work.apply(Edit::SetBootstrap(Some(bootstrap)));
}

/// The fit that is shown, with the problem that it solved.
fn shown_fit(app: &App) -> Option<(Problem, FitResult)> {
    let fit = app.work.shown_fit()?;
    Some((Problem::clone(&fit.problem), fit.report.clone()))
}
