//! The job that chooses angles.

use crate::app::jobs::job::JobContext;
#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::tasks::start_error::start_error;
use crate::app::work::predicted_errors::PlannedAngles;
use pbrdf::fit::{AngleChoice, AngleChoiceError, DesignCriterion, Observer, choose};
use pbrdf::model::Parameter;

/// Slot of the job.
pub struct PlanJobs {
    spawner: Spawner,
    /// The progress is a share, 0 to 1.
    pub choose: Slot<Result<PlannedAngles, AngleChoiceError>, f64>,
}

/// Share of the time that the choice itself takes; what cannot be reached takes the rest.
const OF_CHOICE: f64 = 0.6;

impl PlanJobs {
    pub fn new(spawner: Spawner) -> Self {
        Self { spawner, choose: Slot::default() }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        vec![&mut self.choose]
    }

    /// Chooses angles, and looks how small the error of each of those parameters can be made that the choice leaves open.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn choose(&mut self, choice: AngleChoice, loose: impl Fn(&[[f64; 3]]) -> Vec<Parameter> + Send + 'static) -> Result<(), String> {
        let job = move |context: &JobContext<f64>| {
            let cancelled = || context.is_cancelled();
            let observer = Observer { cancelled: &cancelled, ..Observer::NONE };
            let chosen = choose(&choice, observer, &|share| context.report(OF_CHOICE * share))?;
            let angles: Vec<[f64; 3]> = chosen.angles.iter().flat_map(|&(angles, times)| std::iter::repeat_n(angles, times)).collect();
            let open = loose(&angles);
            let mut limits = Vec::new();
            for (i, &parameter) in open.iter().enumerate() {
                let alone = AngleChoice { criterion: DesignCriterion::Variances(vec![parameter]), ..choice.clone() };
                #[expect(clippy::cast_precision_loss, reason = "a handful of parameters")]
                let report = |share: f64| context.report(OF_CHOICE + (1.0 - OF_CHOICE) * (i as f64 + share) / open.len() as f64);
                // The sum of one relative variance, over max(|value|, 0.1)².
                if let Ok(best) = choose(&alone, observer, &report) {
                    let size = choice.surfaces.first().map_or(1.0, |surface| surface[parameter].abs().max(0.1));
                    limits.push((parameter, best.value.sqrt() * size));
                }
            }
            Ok(PlannedAngles { angles, value: chosen.value, efficiency: chosen.efficiency, limits })
        };
        self.choose.start(&self.spawner, "choose angles", job).map_err(start_error)
    }

    /// Stops what is about other work than what is shown next.
    pub fn abandon(&mut self) {
        self.choose.abandon();
    }
}
