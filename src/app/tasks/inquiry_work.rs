//! What the jobs beyond a fit do, wherever they run: evidence of models, the weakest direction, angles for a plan.

use crate::app::tasks::fit_work::{Fitted, Watch, Work, observer};
use crate::app::text::i18n::Language;
use crate::app::text::localized::Localized as _;
use crate::app::work::design::DesignSettings;
use crate::app::work::fit_history::{FitEntry, JointPart};
use crate::app::work::fit_setup::free_in_design;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::posterior::PosteriorOptions;
use crate::app::work::predicted_errors::{PlannedAngles, PredictedErrors, angle_choice, measured};
use crate::app::work::surface::Surface;
use crate::app::work::weakest_walk::WeakestWalk;
use pbrdf::fit::posterior::{LogEvidence, Posterior, PosteriorProblem};
use pbrdf::fit::{AngleChoice, AngleChoiceError, DesignCriterion, GeodesicWay, JointUnknown, Observer, choose, weakest_geodesic};
use pbrdf::model::{Parameter, Parameters};
use std::sync::Arc;
use tr::tr;

/// The evidence of a row of the comparison of models; none where the model has no posterior or too few draws came.
pub type FoundEvidence = (usize, Option<LogEvidence>);

/// A fitted model of the comparison: its row, the key of its model, its fit.
pub struct EvidenceRow {
    pub row: usize,
    pub model: &'static str,
    pub fit: Fitted,
}

/// Draws from the posterior of each of these rows, for its evidence.
pub struct FindEvidence {
    /// The number of the measurement that the comparison is about.
    pub number: u64,
    pub rows: Vec<EvidenceRow>,
    pub options: PosteriorOptions,
    pub seed: u64,
}

impl Work for FindEvidence {
    type Output = (u64, Vec<FoundEvidence>);
    /// The key of the model.
    type Progress = &'static str;

    fn run(self, watch: &impl Watch<&'static str>) -> Self::Output {
        let Self { number, rows, options, seed } = self;
        let cancelled = || watch.is_cancelled();
        let mut found = Vec::new();
        for EvidenceRow { row, model, fit: Fitted { fit, .. } } in rows {
            watch.report(model);
            let evidence = match &fit.joint {
                None => {
                    let minima: Vec<Parameters> = fit.report.course.minima.iter().map(|minimum| minimum.parameters).collect();
                    evidence_of(&*fit.problem, &minima, &options, seed, observer(&cancelled))
                }
                Some(part) => {
                    let course = &part.of.result.course;
                    let minima: Vec<Vec<Parameters>> = course.minima.iter().map(|minimum| minimum.parameters.clone()).collect();
                    evidence_of(&*part.of.problem, &minima, &options, seed, observer(&cancelled))
                }
            };
            if cancelled() {
                break;
            }
            found.push((row, evidence));
        }
        (number, found)
    }
}

/// The evidence of a problem, from chains that begin at those minima.
fn evidence_of<P: PosteriorProblem>(
    problem: &P,
    minima: &[P::Point],
    options: &PosteriorOptions,
    seed: u64,
    observer: Observer<'_>,
) -> Option<LogEvidence> {
    let free: Vec<JointUnknown> = problem.names().iter().map(JointUnknown::of).collect();
    let posterior = Posterior::new(problem, &options.priors_of(&free), options.settings(seed)).ok()?;
    posterior.run(minima, observer, &mut |_, _| {}).ok()?.log_evidence
}

/// Follows the direction that the data of a finished fit determine least.
pub struct FollowWeakest {
    pub fit: Fitted,
    /// The measurements by their numbers, in the order of the parameter sets.
    pub numbers: Vec<u64>,
    pub way: GeodesicWay,
}

impl Work for FollowWeakest {
    type Output = Arc<WeakestWalk>;
    type Progress = ();

    fn run(self, watch: &impl Watch<()>) -> Arc<WeakestWalk> {
        let Self { fit: Fitted { fit: FitEntry { id, problem, report, joint, .. }, .. }, numbers, way } = self;
        let cancelled = || watch.is_cancelled();
        let geodesic = match joint {
            None => {
                let alone = weakest_geodesic(&report.fitted(&problem), &report.parameters, way, observer(&cancelled));
                alone.map(JointUnknown::from, |parameters| vec![parameters])
            }
            Some(JointPart { of, .. }) => {
                let statistics = &of.result.statistics;
                let fitted = of.problem.with_loss_scales(statistics.loss_scales).with_block_weights(statistics.block_weights);
                weakest_geodesic(&fitted, &of.result.points(), way, observer(&cancelled))
            }
        };
        Arc::new(WeakestWalk { fit: id, numbers, way, geodesic })
    }
}

/// Why no angles were chosen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NotChosen {
    Cancelled,
    /// A sentence.
    Because(String),
}

impl NotChosen {
    fn of(error: &AngleChoiceError) -> Self {
        if matches!(error, AngleChoiceError::Cancelled) {
            Self::Cancelled
        } else {
            Self::Because(tr!("No angles can be chosen: {}.", error.localized()))
        }
    }
}

/// Chooses angles, and looks how small the error of each parameter can be made that the choice leaves open.
pub struct ChooseAngles {
    pub surface: Surface,
    pub design: DesignSettings,
    pub about: OpenMeasurement,
    /// Of sentences.
    #[cfg_attr(not(any(test, target_arch = "wasm32")), expect(dead_code, reason = "sent to the worker of a page"))]
    pub language: Language,
}

/// Share of the time that the choice itself takes; what cannot be reached takes the rest.
const OF_CHOICE: f64 = 0.6;

impl Work for ChooseAngles {
    type Output = Result<PlannedAngles, NotChosen>;
    /// A share, 0 to 1.
    type Progress = f64;

    fn run(self, watch: &impl Watch<f64>) -> Self::Output {
        let choice = angle_choice(&self.surface, &self.design, &self.about.measurement).map_err(NotChosen::Because)?;
        let cancelled = || watch.is_cancelled();
        let observer = observer(&cancelled);
        let chosen = choose(&choice, observer, &|share| watch.report(OF_CHOICE * share)).map_err(|error| NotChosen::of(&error))?;
        let angles: Vec<[f64; 3]> = chosen.angles.iter().flat_map(|&(angles, times)| std::iter::repeat_n(angles, times)).collect();
        let open = self.left_open(&choice, &angles);
        let mut limits = Vec::new();
        for (i, &parameter) in open.iter().enumerate() {
            let alone = AngleChoice { criterion: DesignCriterion::Variances(vec![parameter]), ..choice.clone() };
            #[expect(clippy::cast_precision_loss, reason = "a handful of parameters")]
            let report = |share: f64| watch.report(OF_CHOICE + (1.0 - OF_CHOICE) * (i as f64 + share) / open.len() as f64);
            // The sum of one relative variance, over max(|value|, 0.1)².
            if let Ok(best) = choose(&alone, observer, &report) {
                let size = choice.surfaces.first().map_or(1.0, |surface| surface[parameter].abs().max(0.1));
                limits.push((parameter, best.value.sqrt() * size));
            }
        }
        Ok(PlannedAngles { angles, value: chosen.value, efficiency: chosen.efficiency, limits })
    }
}

impl ChooseAngles {
    /// The parameters that were asked for and that these angles do not determine.
    fn left_open(&self, choice: &AngleChoice, angles: &[[f64; 3]]) -> Vec<Parameter> {
        let Self { surface, design, about, .. } = self;
        let given = if design.counts_given { measured(&about.measurement) } else { Vec::new() };
        let asked = design.goal.parameters(choice.free);
        let readings = angles.iter().map(|&[theta_i, theta_r, _]| [theta_i, theta_r]).collect();
        let design = DesignSettings { readings, ..design.clone() };
        let predicted = PredictedErrors::of_plan(surface, &design, free_in_design(surface, &design, design.has_brdf()), &given);
        let determined = predicted.map(|predicted| predicted.determined).unwrap_or_default();
        asked.iter().filter(|parameter| !determined.contains(*parameter)).collect()
    }
}
