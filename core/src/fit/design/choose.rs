//! The choice of angles.

use crate::fit::design::choice::{AngleChoice, AngleChoiceError, ChosenAngles, DesignCriterion, repeated};
use crate::fit::design::discrimination::Discrimination;
use crate::fit::design::exchange::{Chosen, Exchange, Objective, Scenario};
use crate::fit::design::information::{Information, Reading};
use crate::fit::observer::Observer;
use crate::model::{Parameter, Pbrdf};
use crate::optics::GeometryError;

/// Candidates that are exchanged, at most; of more, those that are worth most beside a first choice.
const MOST_EXCHANGED: usize = 20_000;
/// Surfaces that are averaged over, at most: evenly picked from more.
const MOST_SURFACES: usize = 48;

/// Chooses angles; hears of the share that is done, 0 to 1. The same request gives the same angles, whatever the number of threads.
///
/// ```
/// use pbrdf::fit::{AngleChoice, CandidateGrid, DesignCriterion, NoiseModel, Observer, choose};
/// use pbrdf::model::{Model, Parameter, Parameters};
///
/// let grid = CandidateGrid::new(&[20.0, 40.0, 60.0, 75.0], &[0.0, 20.0, 40.0, 60.0, 80.0], &[180.0])?;
/// let choice = AngleChoice {
///     model: Model::CAUCHY,
///     surfaces: vec![Parameters::default()],
///     noise: NoiseModel { dolp: Some(0.005), brdf: None },
///     free: [Parameter::N, Parameter::K, Parameter::Kd].into_iter().collect(),
///     grid,
///     given: Vec::new(),
///     count: 5,
///     repeats: false,
///     criterion: DesignCriterion::Determinant,
/// };
/// let chosen = choose(&choice, Observer::NONE, &|_| {})?;
/// assert_eq!(chosen.angles.len(), 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`AngleChoiceError`] where the candidates, the readings or the surfaces do not allow it, and where it was cancelled.
pub fn choose(choice: &AngleChoice, observer: Observer<'_>, progress: &(dyn Fn(f64) + Sync)) -> Result<ChosenAngles, AngleChoiceError> {
    let goes_on = |share: f64| {
        if share > 0.0 {
            progress(share);
        }
        !(observer.cancelled)()
    };
    let (candidates, count) = (choice.grid.len(), choice.count);
    if choice.surfaces.is_empty() || choice.noise.quantities() == 0 || count == 0 {
        return Err(AngleChoiceError::Nothing);
    }
    if candidates == 0 || (!choice.repeats && candidates < count) {
        return Err(AngleChoiceError::TooFewCandidates { candidates, count });
    }
    let step = choice.surfaces.len().div_ceil(MOST_SURFACES).max(1);
    let surfaces = choice.every(step)?;
    if let Some(discrimination) = Discrimination::of(choice, &surfaces)? {
        return discrimination.run(observer, &goes_on);
    }
    let free: Vec<Parameter> = choice.free.iter().collect();
    Inquiry { choice, surfaces: &surfaces, free: &free }.run(&goes_on)
}

/// A choice by the errors of parameters.
struct Inquiry<'a> {
    choice: &'a AngleChoice,
    surfaces: &'a [Pbrdf],
    free: &'a [Parameter],
}

/// A surface, and what all candidates tell of it.
type Informed<'a> = (Reading<'a>, Information);

impl<'a> Inquiry<'a> {
    fn objective(&self) -> Objective {
        if self.choice.criterion == DesignCriterion::Determinant { Objective::LogDet } else { Objective::LogVariance }
    }

    /// The parameters that are asked for.
    fn asked(&self) -> &[Parameter] {
        match &self.choice.criterion {
            DesignCriterion::Variances(asked) => asked,
            _ => self.free,
        }
    }

    fn run(&self, goes_on: &(dyn Fn(f64) -> bool + Sync)) -> Result<ChosenAngles, AngleChoiceError> {
        let choice = self.choice;
        choice.check_asked()?;
        let (values, parameters) = (choice.count * choice.noise.quantities() + choice.given_values(), self.free.len());
        if values < parameters {
            return Err(AngleChoiceError::TooFewReadings { values, parameters });
        }
        let informed = self.informed(goes_on)?;
        let shortlist = self.shortlist(&informed, goes_on)?;
        let exchange = self.exchange(&informed, &shortlist)?;
        let chosen = exchange.run(goes_on);
        if !goes_on(1.0) {
            return Err(AngleChoiceError::Cancelled);
        }
        self.conclude(&informed, &shortlist, &exchange, &chosen)
    }

    /// The surfaces with what all candidates tell of them, those left out where a parameter that is asked for stays open.
    fn informed(&self, goes_on: &dyn Fn(f64) -> bool) -> Result<Vec<Informed<'a>>, AngleChoiceError> {
        let mut informed: Vec<Informed<'a>> = Vec::new();
        let mut open = Vec::new();
        #[expect(clippy::cast_precision_loss, reason = "a number of surfaces")]
        let whole = self.surfaces.len() as f64;
        for (i, surface) in self.surfaces.iter().enumerate() {
            let reading = Reading { surface, free: self.free, noise: self.choice.noise };
            #[expect(clippy::cast_precision_loss, reason = "a number of surfaces")]
            let goes_on = |share: f64| goes_on(0.3 * (i as f64 + share) / whole);
            let information = Information::new(&reading, &self.choice.grid, &self.choice.given, &goes_on)?;
            let information = information.ok_or(AngleChoiceError::Cancelled)?;
            let missing: Vec<Parameter> =
                self.asked().iter().copied().filter(|parameter| information.undetermined.contains(parameter)).collect();
            let is_like_others = informed.first().is_none_or(|(_, first)| first.rank() == information.rank());
            if missing.is_empty() && is_like_others {
                informed.push((reading, information));
            } else if open.is_empty() {
                open = missing;
            }
        }
        if informed.is_empty() { Err(AngleChoiceError::Undetermined { parameters: open }) } else { Ok(informed) }
    }

    fn exchange(&self, informed: &[Informed<'_>], candidates: &[usize]) -> Result<Exchange, AngleChoiceError> {
        let scenario = |(reading, information): &Informed<'_>| {
            let contrasts = match self.objective() {
                Objective::LogDet => Vec::new(),
                Objective::LogVariance => self.asked().iter().filter_map(|&parameter| information.contrast(reading, parameter)).collect(),
            };
            let rows = information.rows(reading, &self.choice.grid, candidates)?;
            Ok(Scenario { rows, base: information.given.clone(), contrasts })
        };
        let scenarios: Result<Vec<Scenario>, GeometryError> = informed.iter().map(scenario).collect();
        Ok(Exchange {
            scenarios: scenarios?,
            candidates: candidates.len(),
            rows_each: self.choice.noise.quantities(),
            count: self.choice.count,
            repeats: self.choice.repeats,
            objective: self.objective(),
        })
    }

    /// All candidates; of very many, those that add most to a choice among evenly picked ones.
    fn shortlist(&self, informed: &[Informed<'_>], goes_on: &(dyn Fn(f64) -> bool + Sync)) -> Result<Vec<usize>, AngleChoiceError> {
        let all = self.choice.grid.len();
        if all <= MOST_EXCHANGED {
            return Ok((0..all).collect());
        }
        let even: Vec<usize> = (0..all).step_by(all.div_ceil(MOST_EXCHANGED / 4)).collect();
        let exchange = self.exchange(informed, &even)?;
        let first = exchange.run(&|_| goes_on(0.3));
        let score = exchange.scores(&first.candidates);
        let mut scored: Vec<(f64, usize)> = Vec::with_capacity(all);
        let candidates: Vec<usize> = (0..all).collect();
        for chunk in candidates.chunks(MOST_EXCHANGED) {
            let rows: Result<Vec<Vec<f64>>, GeometryError> =
                informed.iter().map(|(reading, information)| information.rows(reading, &self.choice.grid, chunk)).collect();
            let rows = rows?;
            for (i, &candidate) in chunk.iter().enumerate() {
                let of = |rows: &'_ Vec<f64>| {
                    let length = rows.len() / chunk.len();
                    i * length..(i + 1) * length
                };
                let own: Vec<&[f64]> = rows.iter().map(|rows| &rows[of(rows)]).collect();
                scored.push((score(&own), candidate));
            }
            #[expect(clippy::cast_precision_loss, reason = "a number of candidates")]
            let share = chunk[0] as f64 / all as f64;
            if !goes_on(0.3 + 0.4 * share) {
                return Err(AngleChoiceError::Cancelled);
            }
        }
        scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut kept: Vec<usize> = scored.into_iter().take(MOST_EXCHANGED).map(|(_, candidate)| candidate).collect();
        kept.sort_unstable();
        Ok(kept)
    }

    fn conclude(
        &self,
        informed: &[Informed<'_>],
        shortlist: &[usize],
        exchange: &Exchange,
        chosen: &Chosen,
    ) -> Result<ChosenAngles, AngleChoiceError> {
        if !chosen.value.is_finite() {
            return Err(AngleChoiceError::Undetermined { parameters: self.asked().to_vec() });
        }
        #[expect(clippy::cast_precision_loss, reason = "numbers of surfaces and directions")]
        let (whole, directions) = (informed.len() as f64, informed[0].1.rank() as f64);
        let unit = self.choice.noise.unit();
        let (value, of_all_candidates, efficiency) = match exchange.objective {
            Objective::LogDet => {
                let of_all = informed.iter().map(|(_, information)| information.log_det).sum::<f64>() / whole;
                (of_all + chosen.value, of_all, libm::exp(chosen.value / directions))
            }
            Objective::LogVariance => {
                // All candidates together have the unit matrix as information.
                let log = |scenario: &Scenario| libm::log(scenario.contrasts.iter().map(|v| v.dot(v)).sum::<f64>());
                let of_all = exchange.scenarios.iter().map(log).sum::<f64>() / whole;
                let variance = |log: f64| unit * unit * libm::exp(log);
                (variance(-chosen.value), variance(of_all), libm::exp(of_all + chosen.value))
            }
        };
        Ok(ChosenAngles {
            angles: repeated(chosen.candidates.iter().map(|&place| self.choice.grid.angles(shortlist[place]))),
            value,
            of_all_candidates,
            efficiency,
            left_out: self.surfaces.len() - informed.len(),
        })
    }
}
