//! What more than one part of the window shows and none computes while it draws: curves, points,
//! ΔE, what the data determine.

use crate::app::jobs::memo::Memo;
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::localized::Localized;
use crate::app::text::numbers::short;
use crate::app::views::companions::Companions;
use crate::app::views::curves::{CurveKey, CurveSet, MarkSet};
use crate::app::views::pointing::PickedDirection;
use crate::app::work::fit_setup::{fit_problem, is_joint, joint_problem};
use crate::app::work::lesson_stage::ReadoutPlace;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::surface::Surface;
use crate::app::work::workspace::Workspace;
use pbrdf::fit::{
    FitOptions, FitRange, JointUnknown, Loss, Problem, Tie, Uncertainty, UndeterminedDirection, UnknownName, Weights, is_determined,
};
use pbrdf::model::{Model, Parameter, ParameterError, ParameterSet, Parameters, Pbrdf};
use pbrdf::optics::{Facet, Geometry};
use std::collections::BTreeMap;
use tr::tr;

/// Everything derived that has more than one reader; a pane keeps what it alone shows.
#[derive(Default)]
pub struct Derived {
    /// Measured points, by the state of the document, whether a BRDF is multiplied by cos θr, and the angles that are fitted.
    pub marks: Memo<(u64, bool, Option<FitRange>), MarkSet>,
    /// The model along θr.
    pub curves: Memo<CurveKey, CurveSet>,
    /// What is drawn beside the active measurement and its surface.
    pub companions: Companions,
    /// How far the surface of each open measurement is from its data, by the number of the
    /// measurement.
    misfits: BTreeMap<u64, Misfit>,
    active: u64,
    /// Whether every value that counts comes with its standard deviation, by generation of the
    /// document.
    states_sigmas: Memo<u64, bool>,
    fault: Memo<(Parameters, Model), Option<ParameterError>>,
    /// Whether the panel of fits shows what the data determine.
    pub is_outlook_shown: bool,
    outlook: Memo<OutlookKey, Option<Identifiability>>,
    readout: Memo<ReadoutKey, Option<String>>,
    /// What was picked in the picture last.
    pub picked: Option<PickedDirection>,
}

/// What the read-out depends on; angles in degrees.
#[derive(Clone, PartialEq)]
struct ReadoutKey {
    surface: (Model, Parameters),
    direction: [f64; 2],
    readings: Vec<ReadoutPlace>,
    pointer: Option<f64>,
    language: Language,
}

/// DoLP and BRDF at each place, and where the pointer is.
fn readout(key: &ReadoutKey) -> Option<String> {
    let surface = Pbrdf::new(key.surface.0, key.surface.1).ok()?;
    let [theta_i, dphi] = key.direction;
    let at = |theta_r: f64, dphi: f64| {
        let reflection = surface.reflection(&Facet::new(Geometry::new(theta_i, theta_r.abs(), dphi).ok()?));
        Some(tr!("DoLP = {0}, BRDF = {1} sr⁻¹", format!("{:.4}", reflection.dolp), short(reflection.brdf)))
    };
    let side = |theta_r: f64| if theta_r < 0.0 { dphi - 180.0 } else { dphi };
    let of_reading = |reading: &ReadoutPlace| match *reading {
        ReadoutPlace::Mirror => at(theta_i, 180.0).map(|said| tr!("Mirror direction θr = θi = {0}°: {1}", theta_i, said)),
        ReadoutPlace::ThetaR(theta_r) => at(theta_r, side(theta_r)).map(|said| format!("θr = {}°: {said}", decimal(theta_r))),
    };
    let readings = key.readings.iter().filter_map(of_reading);
    let pointed = key.pointer.and_then(|theta_r| {
        let said = at(theta_r, side(theta_r))?;
        Some(tr!("Pointer θr = {0}°: {1}", decimal((theta_r * 10.0).round() / 10.0), said))
    });
    Some(readings.chain(pointed).collect::<Vec<_>>().join("   ")).filter(|text| !text.is_empty())
}

/// An angle with the sign that stands in texts.
fn decimal(degrees: f64) -> String {
    format!("{}", degrees + 0.0).replace('-', "−")
}

/// What the problem of a surface depends on: the generation of the data, model, ties and range.
type ProblemKey = (u64, Model, Vec<Tie>, Option<FitRange>);

/// How far a surface is from its data.
#[derive(Default)]
struct Misfit {
    problem: Memo<ProblemKey, Option<Problem>>,
    delta_e: Memo<(Parameters, u64, Model, Option<FitRange>), Option<f64>>,
}

impl Misfit {
    fn refresh(&mut self, open: &OpenMeasurement, range: Option<FitRange>) {
        let Surface { parameters, model, .. } = open.surface;
        // ΔE does not depend on other options of a fit.
        let fit_options = FitOptions { range, ..FitOptions::default() };
        self.problem.refresh((open.generation, model, open.surface.ties.clone(), range), |_| {
            fit_problem(&open.surface, &open.measurement, model, ParameterSet::EMPTY, fit_options).ok()
        });
        let problem = self.problem.get().and_then(Option::as_ref);
        self.delta_e.refresh((parameters, open.generation, model, range), |_| problem?.delta_e(&parameters));
    }
}

/// Surface, free parameters, options of the fit, generation of the measurement; what is shared, and the same of the other measurements
/// where they are fitted together; the language.
type OutlookKey = (Surface, ParameterSet, FitOptions, u64, ParameterSet, Vec<(Surface, u64)>, Language);

impl Derived {
    /// The measured points and the curves, for the panes that draw them.
    pub fn refresh_curves(&mut self, work: &Workspace) {
        let (settings, document) = (work.settings(), work.active());
        let (times_cosine, range) = (settings.view_options.times_cosine, settings.fit_options.range);
        self.marks.refresh((document.plotted, times_cosine, range), |_| MarkSet::new(document, times_cosine, range));
        self.curves.refresh(CurveKey::new(work), |key| CurveSet::new(key, document));
        if let Some(key) = self.curves.key() {
            self.companions.refresh(work, key);
        }
    }

    /// What is on screen whatever the panes are: ΔE, and why there is no curve.
    pub fn refresh_status(&mut self, work: &Workspace) {
        let (surface, document) = (work.surface(), work.active());
        let Surface { parameters, model, .. } = *surface;
        self.fault.refresh((parameters, model), |_| Pbrdf::new(model, parameters).err());
        self.active = document.number;
        self.misfits.retain(|number, _| work.measurements().get(*number).is_some());
        for open in work.measurements().iter() {
            self.misfits.entry(open.number).or_default().refresh(open, work.settings().fit_options.range);
        }
        self.states_sigmas.refresh(document.generation, |_| document.measurement.states_sigmas());
    }

    /// Looks ahead: what would a fit from here determine? Only while somebody looks at it.
    pub fn refresh_outlook(&mut self, work: &Workspace, free: ParameterSet) {
        if self.is_outlook_shown {
            let list = work.measurements();
            let all = list.measured().filter(|_| is_joint(list)).map(|open| (open.surface.clone(), open.generation)).collect();
            let options = work.settings().fit_options;
            let key = (work.surface().clone(), free, options, work.active().generation, list.shared(), all, i18n::current());
            self.outlook.refresh(key, |_| Identifiability::new(work, free));
        } else {
            self.outlook.clear();
        }
    }

    /// What the model says at these places and at the angle of view that the pointer is at in a plot.
    pub fn refresh_readout(&mut self, work: &Workspace, readings: Vec<ReadoutPlace>, pointer: Option<f64>) {
        let (surface, settings) = (work.surface(), work.settings());
        let key = ReadoutKey {
            surface: (surface.model, surface.parameters),
            direction: [settings.theta_i, settings.dphi],
            readings,
            pointer,
            language: i18n::current(),
        };
        self.readout.refresh(key, readout);
    }

    /// The same, in words.
    pub fn readout(&self) -> Option<&str> {
        self.readout.get()?.as_deref()
    }

    /// The angle of view of the picked pixel, while lobes are looked at under its angles.
    pub fn picked_theta_r(&self, work: &Workspace) -> Option<f64> {
        self.picked?.theta_r_at(work.settings())
    }

    /// ΔE of the sliders.
    pub fn delta_e(&self) -> Option<f64> {
        self.delta_e_of(self.active)
    }

    /// ΔE of the surface of the open measurement of that number.
    pub fn delta_e_of(&self, number: u64) -> Option<f64> {
        self.misfits.get(&number)?.delta_e.get().copied().flatten()
    }

    /// How many measured values of a measurement a fit has; none where the model predicts nothing of them.
    pub fn values_of(&self, number: u64) -> Option<usize> {
        Some(self.misfits.get(&number)?.problem.get()?.as_ref()?.len())
    }

    /// Whether every value that counts comes with its standard deviation.
    pub fn states_sigmas(&self) -> bool {
        self.states_sigmas.get().is_some_and(|states| *states)
    }

    /// Why there is no curve.
    pub fn fault(&self) -> Option<&ParameterError> {
        self.fault.get()?.as_ref()
    }

    /// What the open data determine at the sliders, while that is on screen.
    pub fn outlook(&self) -> Option<&Identifiability> {
        self.outlook.get()?.as_ref()
    }
}

/// What data would determine, seen from the sliders before any fit.
pub struct Identifiability {
    /// Standard error of each free parameter, a shared one or one of the active measurement; none where it would say nothing of the
    /// value.
    pub errors: Vec<(Parameter, Option<f64>)>,
    /// What stays open, in words.
    pub open: Vec<String>,
    /// Whether the errors come from stated standard deviations rather than from the present misfit.
    pub from_stated: bool,
    /// How many measurements determine it together.
    pub measurements: usize,
}

impl Identifiability {
    fn new(work: &Workspace, free: ParameterSet) -> Option<Self> {
        if is_joint(work.measurements()) {
            return Self::jointly(work);
        }
        let surface = work.surface();
        let parameters = surface.parameters;
        let with = |fit_options| fit_problem(surface, &work.active().measurement, surface.model, free, fit_options).ok();
        let (problem, from_stated) = weighted_if_stated(work, with)?;
        let misfit = problem.sum_of_squares(&parameters)?;
        let uncertainty = Uncertainty::at(&problem, &parameters, misfit, ParameterSet::EMPTY);
        let error_of = |parameter| {
            let error = uncertainty.standard_error(parameter);
            error.filter(|error| is_determined(parameters[parameter], *error, problem.bounds().of(parameter)))
        };
        let errors = free.iter().map(|parameter| (parameter, error_of(parameter))).collect();
        Some(Self { errors, open: in_words(&uncertainty.undetermined), from_stated, measurements: 1 })
    }

    /// By all measurements together.
    fn jointly(work: &Workspace) -> Option<Self> {
        let list = work.measurements();
        let with = |fit_options| joint_problem(list, ParameterSet::EMPTY, fit_options).ok();
        let (problem, from_stated) = weighted_if_stated(work, with)?;
        let point: Vec<Parameters> = list.measured().map(|open| open.surface.parameters).collect();
        let uncertainty = problem.uncertainty_at(&point)?;
        let active = list.measured().position(|open| open.number == list.active().number)?;
        let (name, part) = (&problem.set_names()[active], &problem.parts()[active]);
        let of_active = problem.unknowns().iter().filter(|unknown| unknown.set.as_ref().is_none_or(|set| set == name));
        let error_of = |unknown: &JointUnknown| {
            let parameter = unknown.parameter;
            let error = uncertainty.error_of(unknown);
            error.filter(|error| is_determined(point[active][parameter], *error, part.bounds().of(parameter)))
        };
        let errors = of_active.map(|unknown| (unknown.parameter, error_of(unknown))).collect();
        Some(Self { errors, open: in_words(&uncertainty.undetermined), from_stated, measurements: point.len() })
    }
}

/// The problem that weights by stated standard deviations, or else the one without, and whether they were stated. ΔE and χ² are sums of
/// squares: the loss of a fit does not count.
fn weighted_if_stated<P>(work: &Workspace, with: impl Fn(FitOptions) -> Option<P>) -> Option<(P, bool)> {
    let fit_options = |weights| FitOptions { weights, loss: Loss::Squared, ..work.settings().fit_options };
    let stated = with(fit_options(Weights::Sigma)).map(|problem| (problem, true));
    stated.or_else(|| Some((with(fit_options(Weights::None))?, false)))
}

fn in_words<N: UnknownName>(open: &[UndeterminedDirection<N>]) -> Vec<String> {
    open.iter().map(Localized::localized).collect()
}
