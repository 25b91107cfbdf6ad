//! The job around a posterior as a text, and its draws as numbers: tens of thousands of them, which JSON would write three times as
//! long and not at all where they are not finite.

use crate::app::platform::Instant;
use crate::app::storage::saved_entry::SavedEntry;
use crate::app::storage::saved_fit::SavedFit;
use crate::app::storage::saved_joint_fit::SavedJointFit;
use crate::app::storage::session::Session;
use crate::app::tasks::fit_work::{Watch, Work as _};
use crate::app::tasks::messages::{Answer, Message, WorkOrder, request, saved};
use crate::app::tasks::posterior_work::{DrawPosterior, Drawing, PosteriorOf};
use crate::app::tasks::wire::Wire;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::posterior::{DrawnFrom, DrawnPosterior, Draws};
use crate::files::packed::{numbers_of, text_of};
use pbrdf::fit::JointUnknown;
use pbrdf::fit::posterior::{
    Convergence, DerivedQuantity, LogEvidence, MarginalSummary, NoiseQuantiles, Posterior, PosteriorDraw, PosteriorError, PosteriorProblem,
    PosteriorSettings,
};
use pbrdf::model::{Model, Parameter, Parameters};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// What draws are of, which both sides know.
#[derive(Clone)]
struct Frame {
    from: DrawnFrom,
    model: Model,
    unknowns: Vec<JointUnknown>,
}

impl Frame {
    fn new(job: &DrawPosterior) -> Self {
        fn of<P: PosteriorProblem>(posterior: &Posterior<P>, from: &DrawnFrom) -> Frame {
            let problem = posterior.problem();
            Frame { from: from.clone(), model: problem.model(), unknowns: problem.names().iter().map(JointUnknown::of).collect() }
        }
        match &job.of {
            PosteriorOf::One(posterior) => of(posterior, &job.from),
            PosteriorOf::Joint(posterior) => of(posterior, &job.from),
        }
    }

    /// Draws out of their numbers; none where these are no draws.
    fn drawn(&self, text: &str) -> Option<Arc<DrawnPosterior>> {
        let mut numbers = numbers_of(text)?.into_iter();
        let mut next = || numbers.next();
        let [is_complete, chains, length] = [next()?, next()?, next()?];
        let (chains, length) = (count(chains)?, count(length)?);
        let draw = |next: &mut dyn FnMut() -> Option<f64>| {
            let unknowns = self.unknowns.iter().map(|_| next()).collect::<Option<_>>()?;
            let of_set = |_| parameters(next);
            let parameters = (0..self.from.numbers.len()).map(of_set).collect::<Option<_>>()?;
            Some(PosteriorDraw { unknowns, parameters, log_posterior: next()? })
        };
        let chain = |_| (0..length).map(|_| draw(&mut next)).collect::<Option<Vec<_>>>();
        let chains = (0..chains).map(chain).collect::<Option<Vec<_>>>()?;
        let mut draws = Draws::of_chains(self.model, self.unknowns.clone(), chains);
        draws.evaluations = count(next()?)?;
        draws.divergences = count(next()?)?;
        draws.cut = count(next()?)?;
        draws.transitions = count(next()?)?;
        draws.accepted = next()?;
        draws.elapsed_ms = next()?;
        for noise in &mut draws.noise {
            *noise = optional(&mut next, |next| Some(NoiseQuantiles { q16: next()?, q50: next()?, q84: next()? }))?;
        }
        draws.log_evidence = optional(&mut next, |next| Some(LogEvidence { value: next()?, std_error: next()? }))?;
        let summaries = self.unknowns.iter().map(|_| summary(&mut next)).collect::<Option<_>>()?;
        let derived = (0..count(next()?)?).map(|_| {
            let quantity = *DerivedQuantity::ALL.get(count(next()?)?)?;
            Some((quantity, self.from.numbers.iter().map(|_| summary(&mut next)).collect::<Option<_>>()?))
        });
        let derived = derived.collect::<Option<_>>()?;
        Some(Arc::new(DrawnPosterior::of_parts(self.from.clone(), draws, summaries, derived, is_complete != 0.0)))
    }
}

type Next<'a> = &'a mut dyn FnMut() -> Option<f64>;

/// A whole number; none of what is none.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "compared with what it was")]
#[expect(clippy::cast_precision_loss, reason = "numbers of draws and evaluations")]
fn count(number: f64) -> Option<usize> {
    let count = number as usize;
    (count as f64 == number).then_some(count)
}

fn parameters(next: Next<'_>) -> Option<Parameters> {
    let mut parameters = Parameters::default();
    for parameter in Parameter::ALL {
        parameters[parameter] = next()?;
    }
    Some(parameters)
}

/// What may be missing, after a 0 or a 1.
fn optional<T>(next: Next<'_>, of: impl Fn(Next<'_>) -> Option<T>) -> Option<Option<T>> {
    if next()? == 0.0 { Some(None) } else { of(next).map(Some) }
}

fn summary(next: Next<'_>) -> Option<MarginalSummary> {
    let (mean, sd) = (next()?, next()?);
    let quantiles = [next()?, next()?, next()?, next()?, next()?];
    let convergence = optional(next, |next| Some(Convergence { rhat: next()?, ess_bulk: next()?, ess_tail: next()? }))?;
    Some(MarginalSummary { mean, sd, quantiles, convergence })
}

fn push_optional<const N: usize>(numbers: &mut Vec<f64>, values: Option<[f64; N]>) {
    numbers.push(if values.is_some() { 1.0 } else { 0.0 });
    numbers.extend(values.iter().flatten());
}

fn push_summary(numbers: &mut Vec<f64>, MarginalSummary { mean, sd, quantiles, convergence }: &MarginalSummary) {
    numbers.extend([*mean, *sd]);
    numbers.extend(quantiles);
    push_optional(numbers, convergence.map(|Convergence { rhat, ess_bulk, ess_tail }| [rhat, ess_bulk, ess_tail]));
}

/// Draws as a text of numbers.
#[expect(clippy::cast_precision_loss, reason = "numbers of draws and evaluations")]
fn text(drawn: &DrawnPosterior) -> String {
    let DrawnPosterior { from: _, draws, summaries, derived, verdict: _, is_complete, stamp: _ } = drawn;
    let length = draws.chains.first().map_or(0, Vec::len);
    let mut numbers = vec![f64::from(u8::from(*is_complete)), draws.chains.len() as f64, length as f64];
    for PosteriorDraw { unknowns, parameters, log_posterior } in draws.draws() {
        numbers.extend(unknowns);
        numbers.extend(parameters.iter().flat_map(Parameters::to_array));
        numbers.push(*log_posterior);
    }
    let counts = [draws.evaluations, draws.divergences, draws.cut, draws.transitions];
    numbers.extend(counts.map(|count| count as f64));
    numbers.extend([draws.accepted, draws.elapsed_ms]);
    for noise in draws.noise {
        push_optional(&mut numbers, noise.map(|NoiseQuantiles { q16, q50, q84 }| [q16, q50, q84]));
    }
    push_optional(&mut numbers, draws.log_evidence.map(|LogEvidence { value, std_error }| [value, std_error]));
    summaries.iter().for_each(|summary| push_summary(&mut numbers, summary));
    numbers.push(derived.len() as f64);
    for (quantity, of_sets) in derived {
        numbers.push(DerivedQuantity::ALL.iter().position(|other| other == quantity).unwrap_or_default() as f64);
        of_sets.iter().for_each(|summary| push_summary(&mut numbers, summary));
    }
    text_of(&numbers)
}

impl Message for DrawPosterior {
    fn request(&self) -> Option<String> {
        let measurements = self.about.iter().map(saved).collect();
        let fit = match &self.of {
            PosteriorOf::One(posterior) => {
                SavedEntry::One(Box::new(SavedFit::to_be_made(posterior.problem(), 0, self.about.first()?.mask())))
            }
            PosteriorOf::Joint(posterior) => {
                let sets = self.about.iter().enumerate().map(|(place, about)| (place, about.surface.parameters, &**about.mask()));
                SavedEntry::Joint(Box::new(SavedJointFit::to_be_made(posterior.problem(), self.shared, sets)))
            }
        };
        let PosteriorSettings { draws, chains, seed } = self.from.settings;
        let priors = self.from.prior_options.iter().map(|(unknown, prior)| (unknown.parameter, *prior)).collect();
        request(WorkOrder::Draw { starts: self.starts, priors, draws, chains, seed }, &Session::of_fits(measurements, vec![fit]))
    }

    fn receive(self, answer: &str) -> Option<Self::Output> {
        match serde_json::from_str(answer).ok()? {
            Answer::Drawn(Some(numbers)) => Frame::new(&self).drawn(&numbers).map(Ok),
            // The only fault that shows while it draws: the others are those of the request.
            Answer::Drawn(None) => Some(Err(PosteriorError::NotFinite)),
            _ => None,
        }
    }

    fn progress(&self) -> impl Fn(&str) -> Option<Drawing> + 'static {
        let frame = Frame::new(self);
        let newest = Mutex::new(None);
        move |text| {
            let (share, draws) = text.split_once(' ')?;
            let mut newest = newest.lock().ok()?;
            if !draws.is_empty() {
                *newest = Some(frame.drawn(draws)?);
            }
            Some(Drawing { share: f64::from_bits(share.parse().ok()?), drawn: newest.clone() })
        }
    }
}

/// Tells how far the drawing is: not more often than it is looked at, and each look at the draws once.
struct DrawingWire<'a, 'b> {
    wire: &'a Wire<'b>,
    told: Mutex<Option<(Instant, u64)>>,
}

/// Time between two reports.
const TELL_AFTER: Duration = Duration::from_millis(50);

impl Watch<Drawing> for DrawingWire<'_, '_> {
    fn is_cancelled(&self) -> bool {
        (self.wire.is_cancelled)()
    }

    fn report(&self, Drawing { share, drawn }: Drawing) {
        let Ok(mut told) = self.told.lock() else { return };
        let stamp = drawn.as_ref().map_or(0, |drawn| drawn.stamp);
        let (is_due, is_new) = told.map_or((true, stamp != 0), |(at, last)| (at.elapsed() >= TELL_AFTER, stamp != last));
        if is_due || is_new {
            let draws = drawn.filter(|_| is_new).map(|drawn| text(&drawn)).unwrap_or_default();
            (self.wire.tell)(&format!("{} {draws}", share.to_bits()));
            *told = Some((Instant::now(), stamp));
        }
    }
}

/// Does what a request to draw asks for.
pub fn draw(of: PosteriorOf, about: &[OpenMeasurement], starts: pbrdf::fit::Starts, wire: &Wire<'_>) -> Answer {
    let (priors, settings) = match &of {
        PosteriorOf::One(posterior) => (posterior.priors().to_vec(), posterior.settings()),
        PosteriorOf::Joint(posterior) => (posterior.priors().to_vec(), posterior.settings()),
    };
    // The page knows the rest.
    let from = DrawnFrom {
        numbers: about.iter().map(|open| open.number).collect(),
        generations: Vec::new(),
        names: Vec::new(),
        priors,
        prior_options: Vec::new(),
        settings,
        values: 0,
    };
    let job = DrawPosterior { of, about: Vec::new(), shared: pbrdf::model::ParameterSet::EMPTY, from, starts };
    let drawn = job.run(&DrawingWire { wire, told: Mutex::new(None) });
    Answer::Drawn(drawn.ok().map(|drawn| text(&drawn)))
}
