//! Evidence, the weakest direction and the choice of angles as texts.

use crate::app::storage::saved_entry::SavedEntry;
use crate::app::storage::saved_fit::SavedMeasurement;
use crate::app::storage::session::Session;
use crate::app::tasks::bits::{ChoiceBits, EndBits, WalkBits};
use crate::app::tasks::fit_work::{Fitted, Work as _};
use crate::app::tasks::inquiry_work::{ChooseAngles, FindEvidence, FollowWeakest, NotChosen};
use crate::app::tasks::messages::{Answer, Message, WorkOrder, model_key, of_fitted, request, saved};
use crate::app::tasks::wire::Wire;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::predicted_errors::PlannedAngles;
use crate::app::work::weakest_walk::WeakestWalk;
use crate::files::packed::{numbers_of, text_of};
use pbrdf::fit::posterior::LogEvidence;
use pbrdf::fit::{Edge, FitProblem as _, Geodesic, GeodesicEnd, GeodesicPoint, GeodesicWay, JointUnknown};
use pbrdf::model::{Parameter, Parameters};
use std::sync::Arc;

/// The unknowns of a fit, the same on both sides.
fn names(fit: &FitEntry) -> Vec<JointUnknown> {
    match &fit.joint {
        None => fit.problem.names().iter().map(JointUnknown::of).collect(),
        Some(part) => part.of.problem.names().to_vec(),
    }
}

impl WalkBits {
    fn of(walk: &WeakestWalk, names: &[JointUnknown]) -> Option<Self> {
        let place = |name: &JointUnknown| names.iter().position(|other| other == name);
        let Geodesic { points, direction, limit, end } = &walk.geodesic;
        let mut numbers = Vec::new();
        for GeodesicPoint { parameters, sum_of_squares, length } in points {
            numbers.extend([*sum_of_squares, *length]);
            numbers.extend(parameters.iter().flat_map(Parameters::to_array));
        }
        let end = match end {
            GeodesicEnd::Bound { unknown, edge, value } => {
                EndBits::Bound { unknown: place(unknown)?, is_upper: *edge == Edge::Upper, value: value.to_bits() }
            }
            GeodesicEnd::Misfit => EndBits::Misfit,
            GeodesicEnd::NothingMoves => EndBits::NothingMoves,
            GeodesicEnd::Lost => EndBits::Lost,
            GeodesicEnd::Endless => EndBits::Endless,
            GeodesicEnd::Cancelled => EndBits::Cancelled,
        };
        let direction = direction.iter().map(|(name, part)| Some((place(name)?, part.to_bits()))).collect::<Option<_>>()?;
        Some(Self { points: text_of(&numbers), direction, limit: limit.to_bits(), end })
    }

    fn geodesic(self, names: &[JointUnknown], sets: usize) -> Option<Geodesic<JointUnknown, Vec<Parameters>>> {
        let numbers = numbers_of(&self.points)?;
        let of_point = 2 + sets * Parameter::ALL.len();
        let point = |numbers: &[f64]| GeodesicPoint {
            parameters: numbers[2..].chunks_exact(Parameter::ALL.len()).map(parameters).collect(),
            sum_of_squares: numbers[0],
            length: numbers[1],
        };
        let chunks = numbers.chunks_exact(of_point);
        if !chunks.remainder().is_empty() {
            return None;
        }
        let points = chunks.map(point).collect();
        let named = |(place, part): (usize, u64)| Some((names.get(place)?.clone(), f64::from_bits(part)));
        let end = match self.end {
            EndBits::Bound { unknown, is_upper, value } => GeodesicEnd::Bound {
                unknown: names.get(unknown)?.clone(),
                edge: if is_upper { Edge::Upper } else { Edge::Lower },
                value: f64::from_bits(value),
            },
            EndBits::Misfit => GeodesicEnd::Misfit,
            EndBits::NothingMoves => GeodesicEnd::NothingMoves,
            EndBits::Lost => GeodesicEnd::Lost,
            EndBits::Endless => GeodesicEnd::Endless,
            EndBits::Cancelled => GeodesicEnd::Cancelled,
        };
        let direction = self.direction.into_iter().map(named).collect::<Option<_>>()?;
        Some(Geodesic { points, direction, limit: f64::from_bits(self.limit), end })
    }
}

fn parameters(numbers: &[f64]) -> Parameters {
    let mut parameters = Parameters::default();
    for (parameter, number) in Parameter::ALL.into_iter().zip(numbers) {
        parameters[parameter] = *number;
    }
    parameters
}

impl Message for FollowWeakest {
    fn request(&self) -> Option<String> {
        let (session, set) = of_fitted(&self.fit)?;
        request(WorkOrder::Walk { set, is_farther: self.way == GeodesicWay::Farther }, &session)
    }

    fn receive(self, answer: &str) -> Option<Arc<WeakestWalk>> {
        let Answer::Walk(bits) = serde_json::from_str(answer).ok()? else { return None };
        let Self { fit, numbers, way } = self;
        let sets = if fit.fit.joint.is_some() { numbers.len() } else { 1 };
        let geodesic = bits.geodesic(&names(&fit.fit), sets)?;
        Some(Arc::new(WeakestWalk { fit: fit.fit.id, numbers, way, geodesic }))
    }

    fn progress(&self) -> impl Fn(&str) -> Option<()> + 'static {
        |_| None
    }
}

/// Follows the weakest direction of a fit.
pub fn walk(job: FollowWeakest, wire: &Wire<'_>) -> Option<Answer> {
    let names = names(&job.fit.fit);
    Some(Answer::Walk(WalkBits::of(&job.run(wire), &names)?))
}

impl Message for FindEvidence {
    fn request(&self) -> Option<String> {
        let (mut measurements, mut numbers, mut fits) = (Vec::new(), Vec::new(), Vec::new());
        for row in &self.rows {
            let mut placed = Vec::new();
            let Fitted { fit, parts } = &row.fit;
            for part in if parts.is_empty() { std::slice::from_ref(fit) } else { parts } {
                let known = numbers.iter().position(|number| *number == part.number);
                placed.push((part, known.unwrap_or(numbers.len())));
                if known.is_none() {
                    numbers.push(part.number);
                    measurements.push(SavedMeasurement::of(part.data.clone()));
                }
            }
            fits.push(SavedEntry::new(&placed)?);
        }
        let models = self.rows.iter().map(|row| row.model.to_owned()).collect();
        request(WorkOrder::Evidence { models, options: self.options.clone(), seed: self.seed }, &Session::of_fits(measurements, fits))
    }

    fn receive(self, answer: &str) -> Option<Self::Output> {
        let Answer::Evidence(found) = serde_json::from_str(answer).ok()? else { return None };
        let number = |(place, bits): (usize, Option<[u64; 2]>)| {
            let evidence = bits.map(|bits| bits.map(f64::from_bits)).map(|[value, std_error]| LogEvidence { value, std_error });
            Some((self.rows.get(place)?.row, evidence))
        };
        Some((self.number, found.into_iter().map(number).collect::<Option<_>>()?))
    }

    fn progress(&self) -> impl Fn(&str) -> Option<&'static str> + 'static {
        model_key
    }
}

/// Finds the evidence of models whose rows are their places.
pub fn evidence(job: FindEvidence, wire: &Wire<'_>) -> Answer {
    let (_, found) = job.run(wire);
    let bits = |LogEvidence { value, std_error }: LogEvidence| [value, std_error].map(f64::to_bits);
    Answer::Evidence(found.into_iter().map(|(place, evidence)| (place, evidence.map(bits))).collect())
}

impl Message for ChooseAngles {
    fn request(&self) -> Option<String> {
        let Self { surface, design, about, language } = self;
        let order = WorkOrder::Choose { surface: surface.clone(), design: design.clone(), language: *language };
        request(order, &Session::of_fits(vec![saved(about)], Vec::new()))
    }

    fn receive(self, answer: &str) -> Option<Self::Output> {
        let Answer::Chosen(bits) = serde_json::from_str(answer).ok()? else { return None };
        Some(match bits {
            ChoiceBits::Cancelled => Err(NotChosen::Cancelled),
            ChoiceBits::Because(sentence) => Err(NotChosen::Because(sentence)),
            ChoiceBits::Chosen { angles, value, efficiency, limits } => {
                let numbers = numbers_of(&angles)?;
                let (angles, rest) = numbers.as_chunks::<3>();
                let limits = limits.into_iter().map(|(parameter, limit)| (parameter, f64::from_bits(limit))).collect();
                let [value, efficiency] = [value, efficiency].map(f64::from_bits);
                rest.is_empty().then(|| Ok(PlannedAngles { angles: angles.to_vec(), value, efficiency, limits }))?
            }
        })
    }

    fn progress(&self) -> impl Fn(&str) -> Option<f64> + 'static {
        |text| text.parse().ok().map(f64::from_bits)
    }
}

/// Chooses angles, in sentences of the language of the page.
pub fn chosen(job: ChooseAngles, wire: &Wire<'_>) -> Answer {
    crate::app::text::i18n::set(job.language);
    Answer::Chosen(match job.run(wire) {
        Err(NotChosen::Cancelled) => ChoiceBits::Cancelled,
        Err(NotChosen::Because(sentence)) => ChoiceBits::Because(sentence),
        Ok(PlannedAngles { angles, value, efficiency, limits }) => ChoiceBits::Chosen {
            angles: text_of(angles.as_flattened()),
            value: value.to_bits(),
            efficiency: efficiency.to_bits(),
            limits: limits.into_iter().map(|(parameter, limit)| (parameter, limit.to_bits())).collect(),
        },
    })
}
