//! Jobs around fits as texts: what a page sends to its worker, and what comes back.
//!
//! Inputs and results go as a session has them, so that both sides read and check them as they do
//! with files; numbers that sessions do not have go as their bits.

use crate::app::storage::saved_entry::{RestoredEntry, SavedEntry};
use crate::app::storage::saved_fit::{SavedFit, SavedMeasurement};
use crate::app::storage::saved_joint_fit::SavedJointFit;
use crate::app::storage::session::Session;
use crate::app::tasks::fit_work::{
    BootstrapOne, CompareModels, CompareTogether, ComparedModels, FindIntervals, FinishedIntervals, FitOneByOne, FitTogether, Fitted,
    ProfileOne, Search, Watch, WithIntervals, Work, compared,
};
use crate::app::work::fit_history::{FitEntry, JointEntry};
use crate::app::work::model_fit::{ComparedModel, NotFitted};
use crate::app::work::open_measurement::OpenMeasurement;
use pbrdf::fit::{Bootstrap, BootstrapEstimate, Interval, JointProblem, Problem, Profile, ProfilePoint, TracePoint};
use pbrdf::measurement::Measurement;
use pbrdf::model::{PRESETS, Parameter, Preset};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use std::sync::Arc;

/// A job that can be sent.
pub trait Message: Work {
    /// The job as a text; none where its data cannot be written.
    fn request(&self) -> Option<String>;

    /// The result out of the worker's answer; none where it is none.
    fn receive(self, answer: &str) -> Option<Self::Output>;

    /// A report of progress.
    fn progress(text: &str) -> Option<Self::Progress>;
}

#[derive(Serialize, Deserialize)]
struct Request {
    order: Order,
    session: Box<RawValue>,
}

/// What is to be done with the fits of the session.
#[derive(Serialize, Deserialize)]
enum Order {
    OneByOne {
        search: Search,
        intervals: bool,
    },
    Together {
        search: Search,
    },
    Intervals,
    /// Of models by the keys of their presets.
    Compare {
        search: Search,
        models: Vec<String>,
    },
    /// The same of all measurements together.
    CompareTogether {
        search: Search,
        models: Vec<String>,
    },
    /// Of a parameter of the measurement of that place in the fit.
    Profile {
        parameter: Parameter,
        set: usize,
    },
    Bootstrap {
        replicates: usize,
        seed: u64,
        set: usize,
    },
}

#[derive(Serialize, Deserialize)]
enum Answer {
    /// As sessions have them.
    Fits(Vec<serde_json::Value>),
    /// The same by the keys of their models.
    Compared(Vec<(String, serde_json::Value)>),
    Profile(ProfileBits),
    Bootstrap {
        asked: usize,
        replicates: usize,
        estimates: Vec<(Parameter, [u64; 3])>,
    },
}

#[derive(Serialize, Deserialize)]
struct ProfileBits {
    parameter: Parameter,
    points: Vec<[u64; 3]>,
    intervals: [Interval; 2],
    limits: [u64; 2],
    is_complete: bool,
}

fn request(order: Order, session: &Session) -> Option<String> {
    let session = RawValue::from_string(session.to_json().ok()?).ok()?;
    serde_json::to_string(&Request { order, session }).ok()
}

fn saved(about: &OpenMeasurement) -> SavedMeasurement {
    SavedMeasurement::of(about.measurement.clone())
}

/// The fits of an answer, as those of these measurements.
fn restored(answer: &str, measurements: &[SavedMeasurement]) -> Option<Vec<RestoredEntry>> {
    let Answer::Fits(fits) = serde_json::from_str(answer).ok()? else { return None };
    fits.into_iter().map(|fit| SavedEntry::read(fit, measurements).ok()?.restore(measurements)).collect()
}

/// How a point of a trace goes.
fn trace_point(text: &str) -> Option<TracePoint> {
    let (elapsed_ms, evaluations, objective) = serde_json::from_str(text).ok()?;
    Some(TracePoint { elapsed_ms: f64::from_bits(elapsed_ms), evaluations, objective: f64::from_bits(objective) })
}

impl Message for FitOneByOne {
    fn request(&self) -> Option<String> {
        let measurements = self.about.iter().map(|(_, about)| saved(about)).collect();
        let fit = |(place, (problem, about)): (usize, &(Problem, OpenMeasurement))| {
            SavedEntry::One(Box::new(SavedFit::to_be_made(problem, place, about.mask())))
        };
        let fits = self.about.iter().enumerate().map(fit).collect();
        let order = Order::OneByOne { search: self.search, intervals: self.intervals };
        request(order, &Session::of_fits(measurements, fits))
    }

    fn receive(self, answer: &str) -> Option<Vec<FitEntry>> {
        let measurements: Vec<SavedMeasurement> = self.about.iter().map(|(_, about)| saved(about)).collect();
        let fits = restored(answer, &measurements)?.into_iter().zip(self.about);
        let entry = |(fit, (problem, about)): (RestoredEntry, (Problem, OpenMeasurement))| match fit {
            RestoredEntry::One(fit) => Some(FitEntry::new(about, Arc::new(problem), fit.report)),
            RestoredEntry::Joint(_) => None,
        };
        fits.map(entry).collect()
    }

    fn progress(text: &str) -> Option<TracePoint> {
        trace_point(text)
    }
}

impl Message for FitTogether {
    fn request(&self) -> Option<String> {
        let measurements = self.about.iter().map(saved).collect();
        let sets = self.about.iter().enumerate().map(|(place, about)| (place, about.surface.parameters, &**about.mask()));
        let fit = SavedJointFit::to_be_made(&self.problem, self.shared, sets);
        request(Order::Together { search: self.search }, &Session::of_fits(measurements, vec![SavedEntry::Joint(Box::new(fit))]))
    }

    fn receive(self, answer: &str) -> Option<Vec<FitEntry>> {
        let measurements: Vec<SavedMeasurement> = self.about.iter().map(saved).collect();
        match restored(answer, &measurements)?.pop()? {
            RestoredEntry::Joint(fit) => Some(FitEntry::of_joint(self.about, fit.joint)),
            RestoredEntry::One(_) => None,
        }
    }

    fn progress(text: &str) -> Option<TracePoint> {
        trace_point(text)
    }
}

/// A finished fit as a session has it, with its measurements, and the place of this one among them.
fn of_fitted(Fitted { fit, parts }: &Fitted) -> Option<(Session, usize)> {
    let parts: Vec<&FitEntry> = if parts.is_empty() { vec![fit] } else { parts.iter().collect() };
    let measurements = parts.iter().map(|part| SavedMeasurement::of(part.data.clone())).collect();
    let placed: Vec<(&FitEntry, usize)> = parts.iter().enumerate().map(|(place, part)| (*part, place)).collect();
    let set = fit.joint.as_ref().map_or(0, |part| part.set);
    Some((Session::of_fits(measurements, vec![SavedEntry::new(&placed)?]), set))
}

impl Message for FindIntervals {
    fn request(&self) -> Option<String> {
        request(Order::Intervals, &of_fitted(&self.0)?.0)
    }

    fn receive(self, answer: &str) -> Option<FinishedIntervals> {
        let (session, _) = of_fitted(&self.0)?;
        let result = restored(answer, &session.measurements)?.pop().map(|fit| match fit {
            RestoredEntry::One(fit) => WithIntervals::One(Box::new(fit.report)),
            RestoredEntry::Joint(fit) => WithIntervals::Joint(Box::new(fit.joint.result)),
        });
        Some(FinishedIntervals { id: self.0.fit.id, result })
    }

    fn progress(_: &str) -> Option<()> {
        None
    }
}

/// The fits of the models that have a problem.
fn possible<'a, P, E>(problems: &'a [(&'static Preset, Result<P, E>)]) -> impl Iterator<Item = (&'static Preset, &'a P)> {
    problems.iter().filter_map(|(preset, problem)| Some((*preset, problem.as_ref().ok()?)))
}

fn keys<P, E>(problems: &[(&'static Preset, Result<P, E>)]) -> Vec<String> {
    possible(problems).map(|(preset, _)| preset.key.to_owned()).collect()
}

/// The fits of an answer in the order of the models; none of a model that was not reached.
fn compared_fits<P, E>(
    answer: &str,
    measurements: &[SavedMeasurement],
    problems: &[(&'static Preset, Result<P, E>)],
) -> Option<Vec<Option<RestoredEntry>>> {
    let Answer::Compared(fits) = serde_json::from_str(answer).ok()? else { return None };
    let fit = |preset: &Preset| {
        let (_, fit) = fits.iter().find(|(key, _)| key == preset.key)?;
        SavedEntry::read(fit.clone(), measurements).ok()?.restore(measurements)
    };
    Some(problems.iter().map(|(preset, _)| fit(preset)).collect())
}

/// The name of a model, as progress.
fn model_name(text: &str) -> Option<&'static str> {
    PRESETS.iter().find(|preset| preset.name == text).map(|preset| preset.name)
}

impl Message for CompareModels {
    fn request(&self) -> Option<String> {
        let fit = |(_, problem): (&Preset, &Problem)| SavedEntry::One(Box::new(SavedFit::to_be_made(problem, 0, self.about.mask())));
        let session = Session::of_fits(vec![saved(&self.about)], possible(&self.problems).map(fit).collect());
        request(Order::Compare { search: self.search, models: keys(&self.problems) }, &session)
    }

    fn receive(self, answer: &str) -> Option<ComparedModels> {
        let Self { about, problems, .. } = self;
        let fits = compared_fits(answer, &[saved(&about)], &problems)?.into_iter().map(|fit| match fit {
            Some(RestoredEntry::One(fit)) => Some(fit.report),
            Some(RestoredEntry::Joint(_)) | None => None,
        });
        let fits = fits.collect();
        let entry = |problem: Problem, report| vec![FitEntry::new(about.clone(), Arc::new(problem), report)];
        Some(ComparedModels { numbers: vec![about.number], models: compared(problems, fits, NotFitted::One, entry) })
    }

    fn progress(text: &str) -> Option<&'static str> {
        model_name(text)
    }
}

impl Message for CompareTogether {
    fn request(&self) -> Option<String> {
        let fit = |(_, problem): (&Preset, &JointProblem)| {
            let sets = self.about.iter().enumerate().map(|(place, about)| (place, about.surface.parameters, &**about.mask()));
            SavedEntry::Joint(Box::new(SavedJointFit::to_be_made(problem, self.shared, sets)))
        };
        let session = Session::of_fits(self.about.iter().map(saved).collect(), possible(&self.problems).map(fit).collect());
        request(Order::CompareTogether { search: self.search, models: keys(&self.problems) }, &session)
    }

    fn receive(self, answer: &str) -> Option<ComparedModels> {
        let Self { about, problems, .. } = self;
        let measurements: Vec<SavedMeasurement> = about.iter().map(saved).collect();
        let fits = compared_fits(answer, &measurements, &problems)?.into_iter().map(|fit| match fit {
            Some(RestoredEntry::Joint(fit)) => Some(fit.joint),
            Some(RestoredEntry::One(_)) | None => None,
        });
        let fits = fits.collect();
        let entries = |_: JointProblem, joint| FitEntry::of_joint(about.clone(), joint);
        let numbers = about.iter().map(|open| open.number).collect();
        Some(ComparedModels { numbers, models: compared(problems, fits, NotFitted::Together, entries) })
    }

    fn progress(text: &str) -> Option<&'static str> {
        model_name(text)
    }
}

impl Message for ProfileOne {
    fn request(&self) -> Option<String> {
        let (session, set) = of_fitted(&self.fit)?;
        request(Order::Profile { parameter: self.parameter, set }, &session)
    }

    fn receive(self, answer: &str) -> Option<Profile> {
        let Answer::Profile(ProfileBits { parameter, points, intervals, limits, is_complete }) = serde_json::from_str(answer).ok()? else {
            return None;
        };
        let point = |bits: [u64; 3]| {
            let [value, objective, rss] = bits.map(f64::from_bits);
            ProfilePoint { value, objective, rss }
        };
        let (points, [interval68, interval95]) = (points.into_iter().map(point).collect(), intervals);
        Some(Profile { parameter, points, interval68, interval95, limits: limits.map(f64::from_bits), is_complete })
    }

    fn progress(_: &str) -> Option<()> {
        None
    }
}

impl Message for BootstrapOne {
    fn request(&self) -> Option<String> {
        let (session, set) = of_fitted(&self.fit)?;
        request(Order::Bootstrap { replicates: self.replicates, seed: self.seed, set }, &session)
    }

    fn receive(self, answer: &str) -> Option<Bootstrap> {
        let Answer::Bootstrap { asked, replicates, estimates } = serde_json::from_str(answer).ok()? else { return None };
        let estimate = |(parameter, bits): (Parameter, [u64; 3])| {
            let [std_error, low, high] = bits.map(f64::from_bits);
            BootstrapEstimate { parameter, std_error, low, high }
        };
        Some(Bootstrap { asked, replicates, estimates: estimates.into_iter().map(estimate).collect() })
    }

    fn progress(_: &str) -> Option<()> {
        None
    }
}

/// What a worker asks the page and tells it while it works.
pub struct Wire<'a> {
    pub is_cancelled: &'a (dyn Fn() -> bool + Sync),
    /// Takes what [`Message::progress`] reads.
    pub tell: &'a (dyn Fn(&str) + Sync),
}

impl Watch<TracePoint> for Wire<'_> {
    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }

    fn report(&self, TracePoint { elapsed_ms, evaluations, objective }: TracePoint) {
        (self.tell)(&format!("[{},{evaluations},{}]", elapsed_ms.to_bits(), objective.to_bits()));
    }
}

impl Watch<&'static str> for Wire<'_> {
    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }

    fn report(&self, progress: &'static str) {
        (self.tell)(progress);
    }
}

impl Watch<()> for Wire<'_> {
    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }

    fn report(&self, (): ()) {}
}

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
        Order::OneByOne { search, intervals } => {
            let about = session.fits.iter().map(single).collect::<Option<_>>()?;
            Answer::Fits(one_by_one(&FitOneByOne { about, search, intervals }.run(wire))?)
        }
        Order::Together { search } => {
            let SavedEntry::Joint(fit) = session.fits.first()? else { return None };
            let (problem, shared) = (fit.problem(measurements).ok()?, fit.shared);
            let fits = FitTogether { problem, about: about.clone(), shared, search }.run(wire);
            Answer::Fits(vec![parts_value(&fits)?])
        }
        Order::Compare { search, models } => {
            let problems = models.iter().zip(&session.fits).map(|(key, fit)| Some((preset(key)?, Ok(single(fit)?.0))));
            let problems = problems.collect::<Option<Vec<_>>>()?;
            told_models(CompareModels { about: about.first()?.clone(), problems, search }.run(wire))
        }
        Order::CompareTogether { search, models } => {
            let joint = |fit: &SavedEntry| match fit {
                SavedEntry::Joint(fit) => Some((fit.shared, fit.problem(measurements).ok()?)),
                SavedEntry::One(_) => None,
            };
            let shared = joint(session.fits.first()?)?.0;
            let problems = models.iter().zip(&session.fits).map(|(key, fit)| Some((preset(key)?, Ok(joint(fit)?.1))));
            let problems = problems.collect::<Option<Vec<_>>>()?;
            told_models(CompareTogether { about: about.clone(), shared, problems, search }.run(wire))
        }
        Order::Intervals => with_intervals(fitted(&session, &about, 0)?, wire)?,
        Order::Profile { parameter, set } => {
            let profile = ProfileOne { fit: fitted(&session, &about, set)?, parameter }.run(wire);
            let Profile { parameter, points, interval68, interval95, limits, is_complete } = profile;
            let points = points.into_iter().map(|point| [point.value, point.objective, point.rss].map(f64::to_bits)).collect();
            let (intervals, limits) = ([interval68, interval95], limits.map(f64::to_bits));
            Answer::Profile(ProfileBits { parameter, points, intervals, limits, is_complete })
        }
        Order::Bootstrap { replicates, seed, set } => {
            let Bootstrap { asked, replicates, estimates } =
                BootstrapOne { fit: fitted(&session, &about, set)?, replicates, seed }.run(wire);
            let bits = |of: BootstrapEstimate| (of.parameter, [of.std_error, of.low, of.high].map(f64::to_bits));
            Answer::Bootstrap { asked, replicates, estimates: estimates.into_iter().map(bits).collect() }
        }
    };
    serde_json::to_string(&answer).ok()
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

/// The finished fit of a session, as that of the measurement of that place.
fn fitted(session: &Session, about: &[OpenMeasurement], set: usize) -> Option<Fitted> {
    let parts = session.fits.first()?.restore(&session.measurements)?.into_entries(about);
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
