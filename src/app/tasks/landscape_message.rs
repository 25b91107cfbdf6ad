//! A landscape as texts: what a page asks its worker for, and the heights that come back, to the bit.

use crate::app::storage::saved_entry::SavedEntry;
use crate::app::storage::saved_fit::SavedFit;
use crate::app::storage::session::Session;
use crate::app::tasks::messages::{Answer, AxisBits, WorkOrder, request, saved};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::files::packed::{numbers_of, text_of};
use pbrdf::fit::{Landscape, LandscapeAxis, Problem};
use pbrdf::model::Parameters;

/// The request for the heights of a problem, whose scale of a robust loss is that of the residuals there; none where its data cannot be
/// written.
pub fn ask(problem: &Problem, scale_at: Option<Parameters>, axes: [LandscapeAxis; 2], about: &OpenMeasurement) -> Option<String> {
    let fit = SavedEntry::One(Box::new(SavedFit::to_be_made(problem, 0, about.mask())));
    let [across, up] = axes.map(AxisBits::of);
    request(WorkOrder::Landscape { across, up, scale_at }, &Session::of_fits(vec![saved(about)], vec![fit]))
}

/// The landscape out of the answer; none where it was stopped, and none of what is no answer.
pub fn told(answer: &str, [across, up]: [LandscapeAxis; 2]) -> Option<Option<Landscape>> {
    let Answer::Heights(heights) = serde_json::from_str(answer).ok()? else { return None };
    let Some(heights) = heights else { return Some(None) };
    let objective = numbers_of(&heights)?;
    (objective.len() == across.count * up.count).then_some(Some(Landscape { across, up, objective }))
}

/// Does what a request asks for.
pub fn heights(
    problem: &Problem,
    scale_at: Option<Parameters>,
    [across, up]: [AxisBits; 2],
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> Answer {
    let problem = scale_at.map_or_else(|| problem.clone(), |at| problem.with_loss_scale_of(&at));
    let landscape = Landscape::minimised(&problem, across.axis(), up.axis(), is_cancelled);
    Answer::Heights(landscape.map(|landscape| text_of(&landscape.objective)))
}

impl AxisBits {
    fn of(LandscapeAxis { parameter, low, high, count, logarithmic }: LandscapeAxis) -> Self {
        Self { parameter, ends: [low, high].map(f64::to_bits), count, logarithmic }
    }

    fn axis(self) -> LandscapeAxis {
        let Self { parameter, ends, count, logarithmic } = self;
        let [low, high] = ends.map(f64::from_bits);
        LandscapeAxis { parameter, low, high, count, logarithmic }
    }
}
