//! What the worker of a page does with a request.

use crate::app::storage::saved_entry::SavedEntry;
use crate::app::storage::saved_fit::SavedMeasurement;
use crate::app::storage::session::Session;
use crate::app::tasks::fit_work::{
    BootstrapOne, CompareModels, CompareTogether, ComparedModels, FindIntervals, FitOneByOne, FitTogether, Fitted, ProfileOne,
    WithIntervals, Work as _,
};
use crate::app::tasks::inquiry_message::{chosen, evidence, walk};
use crate::app::tasks::inquiry_work::{ChooseAngles, EvidenceRow, FindEvidence, FollowWeakest};
use crate::app::tasks::landscape_message::heights;
use crate::app::tasks::messages::{Answer, ProfileBits, Request, WorkOrder};
use crate::app::tasks::posterior_message::draw;
use crate::app::tasks::posterior_work::PosteriorOf;
use crate::app::tasks::view_message::{audit, scene};
use crate::app::tasks::wire::Wire;
use crate::app::work::fit_history::{FitEntry, JointEntry};
use crate::app::work::model_fit::ComparedModel;
use crate::app::work::open_measurement::OpenMeasurement;
use pbrdf::fit::posterior::{Posterior, PosteriorSettings};
use pbrdf::fit::{Bootstrap, BootstrapEstimate, GeodesicWay, Profile};
use pbrdf::measurement::Measurement;
use pbrdf::model::{PRESETS, Preset};

/// The measurements of a session as they stand in a window.
fn opened(measurements: &[SavedMeasurement]) -> Vec<OpenMeasurement> {
    let open = |saved: &SavedMeasurement| OpenMeasurement::new(saved.name.clone(), Measurement::clone(&saved.measurement));
    measurements.iter().map(open).collect()
}

/// The answer to a request; none where it is none.
pub fn answer(text: &str, wire: &Wire<'_>) -> Option<String> {
    let Request { order, session } = serde_json::from_str(text).ok()?;
    let session = Session::read(session.get()).ok()?;
    let (measurements, about) = (&session.measurements, opened(&session.measurements));
    let single = |fit: &SavedEntry| match fit {
        SavedEntry::One(fit) => {
            Some((fit.problem(&measurements.get(fit.measurement)?.measurement).ok()?, about.get(fit.measurement)?.clone()))
        }
        SavedEntry::Joint(_) => None,
    };
    let answer = match order {
        WorkOrder::OneByOne { search, intervals } => {
            let about = session.fits.iter().map(single).collect::<Option<_>>()?;
            Answer::Fits(one_by_one(&FitOneByOne { about, search, intervals }.run(wire))?)
        }
        WorkOrder::Together { search } => {
            let SavedEntry::Joint(fit) = session.fits.first()? else { return None };
            let (problem, shared) = (fit.problem(measurements).ok()?, fit.shared);
            let fits = FitTogether { problem, about: about.clone(), shared, search }.run(wire);
            Answer::Fits(vec![parts_value(&fits)?])
        }
        WorkOrder::Compare { search, models } => {
            let problems = models.iter().zip(&session.fits).map(|(key, fit)| Some((preset(key)?, Ok(single(fit)?.0))));
            let problems = problems.collect::<Option<Vec<_>>>()?;
            told_models(CompareModels { about: about.first()?.clone(), problems, search }.run(wire))
        }
        WorkOrder::CompareTogether { search, models } => {
            let joint = |fit: &SavedEntry| match fit {
                SavedEntry::Joint(fit) => Some((fit.shared, fit.problem(measurements).ok()?)),
                SavedEntry::One(_) => None,
            };
            let shared = joint(session.fits.first()?)?.0;
            let problems = models.iter().zip(&session.fits).map(|(key, fit)| Some((preset(key)?, Ok(joint(fit)?.1))));
            let problems = problems.collect::<Option<Vec<_>>>()?;
            told_models(CompareTogether { about: about.clone(), shared, problems, search }.run(wire))
        }
        WorkOrder::Intervals => with_intervals(fitted(&session, &about, session.fits.first()?, 0)?, wire)?,
        WorkOrder::Profile { parameter, set } => {
            let profile = ProfileOne { fit: fitted(&session, &about, session.fits.first()?, set)?, parameter }.run(wire);
            let Profile { parameter, points, interval68, interval95, limits, is_complete } = profile;
            let points = points.into_iter().map(|point| [point.value, point.objective, point.rss].map(f64::to_bits)).collect();
            let (intervals, limits) = ([interval68, interval95], limits.map(f64::to_bits));
            Answer::Profile(ProfileBits { parameter, points, intervals, limits, is_complete })
        }
        WorkOrder::Bootstrap { replicates, seed, set } => {
            let Bootstrap { asked, replicates, estimates } =
                BootstrapOne { fit: fitted(&session, &about, session.fits.first()?, set)?, replicates, seed }.run(wire);
            let bits = |of: BootstrapEstimate| (of.parameter, [of.std_error, of.low, of.high].map(f64::to_bits));
            Answer::Bootstrap { asked, replicates, estimates: estimates.into_iter().map(bits).collect() }
        }
        WorkOrder::Draw { starts, priors, draws, chains, seed } => {
            let priors: Vec<_> = priors.into_iter().map(|(parameter, prior)| (parameter.into(), prior)).collect();
            let settings = PosteriorSettings { draws, chains, seed };
            let of = match session.fits.first()? {
                one @ SavedEntry::One(_) => PosteriorOf::One(Box::new(Posterior::new(&single(one)?.0, &priors, settings).ok()?)),
                SavedEntry::Joint(fit) => {
                    PosteriorOf::Joint(Box::new(Posterior::new(&fit.problem(measurements).ok()?, &priors, settings).ok()?))
                }
            };
            draw(of, &about, starts, wire)
        }
        WorkOrder::Landscape { across, up, scale_at } => {
            heights(&single(session.fits.first()?)?.0, scale_at, [across, up], wire.is_cancelled)
        }
        WorkOrder::Evidence { models, options, seed } => {
            evidence(FindEvidence { number: 0, rows: rows(&session, &about, &models)?, options, seed }, wire)
        }
        WorkOrder::Walk { set, is_farther } => {
            let way = if is_farther { GeodesicWay::Farther } else { GeodesicWay::Nearer };
            walk(FollowWeakest { fit: fitted(&session, &about, session.fits.first()?, set)?, numbers: Vec::new(), way }, wire)?
        }
        WorkOrder::Choose { surface, design, language } => {
            chosen(ChooseAngles { surface, design, about: about.first()?.clone(), language }, wire)
        }
        WorkOrder::Picture(order) => scene(&order, wire)?,
        WorkOrder::Audit { model, parameters } => audit(model, parameters)?,
    };
    serde_json::to_string(&answer).ok()
}

/// The fits of a session as rows of a comparison of these models, by their places.
fn rows(session: &Session, about: &[OpenMeasurement], models: &[String]) -> Option<Vec<EvidenceRow>> {
    let row = |(row, (key, fit)): (usize, (&String, &SavedEntry))| {
        Some(EvidenceRow { row, model: preset(key)?.key, fit: fitted(session, about, fit, 0)? })
    };
    models.iter().zip(&session.fits).enumerate().map(row).collect()
}

fn preset(key: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.key == key)
}

/// The parts of a fit in the order of its measurements, as a session has them.
fn parts_value(fits: &[FitEntry]) -> Option<serde_json::Value> {
    let placed: Vec<(&FitEntry, usize)> = fits.iter().enumerate().map(|(place, fit)| (fit, place)).collect();
    serde_json::to_value(SavedEntry::new(&placed)?).ok()
}

fn told_models(ComparedModels { models, .. }: ComparedModels) -> Answer {
    let told = |model: &ComparedModel| Some((model.preset.key.to_owned(), parts_value(model.result.as_ref().ok()?)?));
    Answer::Compared(models.iter().filter_map(told).collect())
}

fn value(fit: &FitEntry, measurement: usize) -> Option<serde_json::Value> {
    serde_json::to_value(SavedEntry::new(&[(fit, measurement)])?).ok()
}

fn one_by_one(fits: &[FitEntry]) -> Option<Vec<serde_json::Value>> {
    fits.iter().enumerate().map(|(place, fit)| value(fit, place)).collect()
}

/// A finished fit of a session, as that of the measurement of that place in it.
fn fitted(session: &Session, about: &[OpenMeasurement], fit: &SavedEntry, set: usize) -> Option<Fitted> {
    let parts = fit.restore(&session.measurements)?.into_entries(about);
    let parts: Vec<FitEntry> = parts.into_iter().map(|(_, entry)| entry).collect();
    Some(Fitted { fit: parts.get(set)?.clone(), parts })
}

fn with_intervals(fitted: Fitted, wire: &Wire<'_>) -> Option<Answer> {
    let mut parts = fitted.parts.clone();
    let fits = match FindIntervals(fitted).run(wire).result {
        None => Vec::new(),
        Some(WithIntervals::One(report)) => vec![value(&FitEntry { report: *report, ..parts.pop()? }, 0)?],
        Some(WithIntervals::Joint(result)) => {
            let of = parts.first()?.joint.clone()?.of;
            let joint = JointEntry { result: *result, problem: of.problem.clone(), shared: of.shared };
            let fits = FitEntry::of_joint(parts.iter().map(FitEntry::measurement).collect(), joint);
            vec![parts_value(&fits)?]
        }
    };
    Some(Answer::Fits(fits))
}
