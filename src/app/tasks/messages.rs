//! Jobs around fits as texts: what a page sends to its worker, and what comes back.
//!
//! Inputs and results go as a session has them, so that both sides read and check them as they do
//! with files; numbers that sessions do not have go as their bits.

use crate::app::storage::saved_entry::{RestoredEntry, SavedEntry};
use crate::app::storage::saved_fit::{SavedFit, SavedMeasurement};
use crate::app::storage::saved_joint_fit::SavedJointFit;
use crate::app::storage::session::Session;
use crate::app::tasks::bits::{AuditBits, ChoiceBits, SceneOrder, WalkBits};
use crate::app::tasks::fit_work::{
    BootstrapOne, CompareModels, CompareTogether, ComparedModels, FindIntervals, FinishedIntervals, FitOneByOne, FitTogether, Fitted,
    ProfileOne, RefitSliders, Search, WithIntervals, Work, compared,
};
use crate::app::text::i18n::Language;
use crate::app::work::design::DesignSettings;
use crate::app::work::edit::Refit;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::model_fit::NotFitted;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::posterior::PosteriorOptions;
use crate::app::work::surface::Surface;
use pbrdf::fit::posterior::Prior;
use pbrdf::fit::{Bootstrap, BootstrapEstimate, Interval, JointProblem, Problem, Profile, ProfilePoint, Starts, TracePoint};
use pbrdf::model::{Model, Parameter, Parameters, Preset};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use std::sync::Arc;

/// A job that can be sent.
pub trait Message: Work {
    /// The job as a text; none where its data cannot be written.
    fn request(&self) -> Option<String>;

    /// The result out of the worker's answer; none where it is none.
    fn receive(self, answer: &str) -> Option<Self::Output>;

    /// Reads reports of progress.
    fn progress(&self) -> impl Fn(&str) -> Option<Self::Progress> + 'static;
}

#[derive(Serialize, Deserialize)]
pub struct Request {
    pub order: WorkOrder,
    pub session: Box<RawValue>,
}

/// What is to be done with the fits of the session.
#[derive(Serialize, Deserialize)]
pub enum WorkOrder {
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
    /// From the posterior of the problem of the fit.
    Draw {
        starts: Starts,
        priors: Vec<(Parameter, Prior)>,
        draws: usize,
        chains: usize,
        seed: u64,
    },
    /// Over two parameters of the problem of the fit, its scale of a robust loss that of the residuals there.
    Landscape {
        across: AxisBits,
        up: AxisBits,
        scale_at: Option<Parameters>,
    },
    /// Of the models of the fits.
    Evidence {
        models: Vec<String>,
        options: PosteriorOptions,
        seed: u64,
    },
    /// From the fit, of the measurement of that place in it.
    Walk {
        set: usize,
        is_farther: bool,
    },
    /// For a plan beside the measurement.
    Choose {
        surface: Surface,
        design: DesignSettings,
        language: Language,
    },
    Picture(SceneOrder),
    Audit {
        model: Model,
        parameters: Parameters,
    },
}

/// A side of a landscape.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub struct AxisBits {
    pub parameter: Parameter,
    pub ends: [u64; 2],
    pub count: usize,
    pub logarithmic: bool,
}

#[derive(Serialize, Deserialize)]
pub enum Answer {
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
    /// The numbers of draws; none where the likelihood is not finite.
    Drawn(Option<String>),
    /// The numbers of a landscape; none where it was stopped.
    Heights(Option<String>),
    /// By the places of the fits.
    Evidence(Vec<(usize, Option<[u64; 2]>)>),
    Walk(WalkBits),
    Chosen(ChoiceBits),
    /// The numbers of one picture or two; none where it was stopped.
    Picture(Option<Vec<String>>),
    Audit(AuditBits),
}

#[derive(Serialize, Deserialize)]
pub struct ProfileBits {
    pub parameter: Parameter,
    pub points: Vec<[u64; 3]>,
    pub intervals: [Interval; 2],
    pub limits: [u64; 2],
    pub is_complete: bool,
}

pub fn request(order: WorkOrder, session: &Session) -> Option<String> {
    let session = RawValue::from_string(session.to_json().ok()?).ok()?;
    serde_json::to_string(&Request { order, session }).ok()
}

pub fn saved(about: &OpenMeasurement) -> SavedMeasurement {
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
        let order = WorkOrder::OneByOne { search: self.search, intervals: self.intervals };
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

    fn progress(&self) -> impl Fn(&str) -> Option<TracePoint> + 'static {
        trace_point
    }
}

impl Message for FitTogether {
    fn request(&self) -> Option<String> {
        let measurements = self.about.iter().map(saved).collect();
        let sets = self.about.iter().enumerate().map(|(place, about)| (place, about.surface.parameters, &**about.mask()));
        let fit = SavedJointFit::to_be_made(&self.problem, self.shared, sets);
        request(WorkOrder::Together { search: self.search }, &Session::of_fits(measurements, vec![SavedEntry::Joint(Box::new(fit))]))
    }

    fn receive(self, answer: &str) -> Option<Vec<FitEntry>> {
        let measurements: Vec<SavedMeasurement> = self.about.iter().map(saved).collect();
        match restored(answer, &measurements)?.pop()? {
            RestoredEntry::Joint(fit) => Some(FitEntry::of_joint(self.about, fit.joint)),
            RestoredEntry::One(_) => None,
        }
    }

    fn progress(&self) -> impl Fn(&str) -> Option<TracePoint> + 'static {
        trace_point
    }
}

impl Message for RefitSliders {
    fn request(&self) -> Option<String> {
        match self {
            Self::One(alone) => alone.request(),
            Self::Joint(together) => together.request(),
        }
    }

    fn receive(self, answer: &str) -> Option<Refit> {
        let fits = match self {
            Self::One(alone) => alone.receive(answer),
            Self::Joint(together) => together.receive(answer),
        };
        fits.map(Self::found)
    }

    fn progress(&self) -> impl Fn(&str) -> Option<TracePoint> + 'static {
        trace_point
    }
}

/// A finished fit as a session has it, with its measurements, and the place of this one among them.
pub fn of_fitted(Fitted { fit, parts }: &Fitted) -> Option<(Session, usize)> {
    let parts: Vec<&FitEntry> = if parts.is_empty() { vec![fit] } else { parts.iter().collect() };
    let measurements = parts.iter().map(|part| SavedMeasurement::of(part.data.clone())).collect();
    let placed: Vec<(&FitEntry, usize)> = parts.iter().enumerate().map(|(place, part)| (*part, place)).collect();
    let set = fit.joint.as_ref().map_or(0, |part| part.set);
    Some((Session::of_fits(measurements, vec![SavedEntry::new(&placed)?]), set))
}

impl Message for FindIntervals {
    fn request(&self) -> Option<String> {
        request(WorkOrder::Intervals, &of_fitted(&self.0)?.0)
    }

    fn receive(self, answer: &str) -> Option<FinishedIntervals> {
        let (session, _) = of_fitted(&self.0)?;
        let result = restored(answer, &session.measurements)?.pop().map(|fit| match fit {
            RestoredEntry::One(fit) => WithIntervals::One(Box::new(fit.report)),
            RestoredEntry::Joint(fit) => WithIntervals::Joint(Box::new(fit.joint.result)),
        });
        Some(FinishedIntervals { id: self.0.fit.id, result })
    }

    fn progress(&self) -> impl Fn(&str) -> Option<()> + 'static {
        |_| None
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

/// The key of a model, as progress.
pub fn model_key(text: &str) -> Option<&'static str> {
    Preset::from_key(text).map(|preset| preset.key)
}

impl Message for CompareModels {
    fn request(&self) -> Option<String> {
        let fit = |(_, problem): (&Preset, &Problem)| SavedEntry::One(Box::new(SavedFit::to_be_made(problem, 0, self.about.mask())));
        let session = Session::of_fits(vec![saved(&self.about)], possible(&self.problems).map(fit).collect());
        request(WorkOrder::Compare { search: self.search, models: keys(&self.problems) }, &session)
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

    fn progress(&self) -> impl Fn(&str) -> Option<&'static str> + 'static {
        model_key
    }
}

impl Message for CompareTogether {
    fn request(&self) -> Option<String> {
        let fit = |(_, problem): (&Preset, &JointProblem)| {
            let sets = self.about.iter().enumerate().map(|(place, about)| (place, about.surface.parameters, &**about.mask()));
            SavedEntry::Joint(Box::new(SavedJointFit::to_be_made(problem, self.shared, sets)))
        };
        let session = Session::of_fits(self.about.iter().map(saved).collect(), possible(&self.problems).map(fit).collect());
        request(WorkOrder::CompareTogether { search: self.search, models: keys(&self.problems) }, &session)
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

    fn progress(&self) -> impl Fn(&str) -> Option<&'static str> + 'static {
        model_key
    }
}

impl Message for ProfileOne {
    fn request(&self) -> Option<String> {
        let (session, set) = of_fitted(&self.fit)?;
        request(WorkOrder::Profile { parameter: self.parameter, set }, &session)
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

    fn progress(&self) -> impl Fn(&str) -> Option<()> + 'static {
        |_| None
    }
}

impl Message for BootstrapOne {
    fn request(&self) -> Option<String> {
        let (session, set) = of_fitted(&self.fit)?;
        request(WorkOrder::Bootstrap { replicates: self.replicates, seed: self.seed, set }, &session)
    }

    fn receive(self, answer: &str) -> Option<Bootstrap> {
        let Answer::Bootstrap { asked, replicates, estimates } = serde_json::from_str(answer).ok()? else { return None };
        let estimate = |(parameter, bits): (Parameter, [u64; 3])| {
            let [std_error, low, high] = bits.map(f64::from_bits);
            BootstrapEstimate { parameter, std_error, low, high }
        };
        Some(Bootstrap { asked, replicates, estimates: estimates.into_iter().map(estimate).collect() })
    }

    fn progress(&self) -> impl Fn(&str) -> Option<()> + 'static {
        |_| None
    }
}
