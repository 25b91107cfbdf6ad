//! The angle planner: angles that might be measured, what the next reading would gain at each of them, and what a plan would determine
//! beside what the open measurement does.

mod angles;
mod plan;
mod plane;
mod predictions;

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::jobs::memo::Memo;
use crate::app::plots::FigurePlot;
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::localized::Localized as _;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::design::DesignSettings;
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::free_in_design;
use crate::app::work::predicted_errors::{PredictedErrors, angle_choice, measured as measured_rows};
use crate::figure::Figure;
use egui::{ScrollArea, Ui};
use pbrdf::fit::{AngleChoice, Observer, next_gains};
use pbrdf::measurement::{Quantity, Row};
use pbrdf::model::{Model, ParameterSet, Parameters};
use tr::tr;

/// What predictions depend on, the language of their words included.
type Key = (Parameters, Model, ParameterSet, DesignSettings, u64, Language);

pub static SPEC: PaneSpec = PaneSpec {
    title: "Angle planner",
    tooltip: "Where the next reading tells most, which angles to choose, and what a measurement at these angles would determine, before it is made",
    shortcut: None,
    has_options: false,
    has_figure: true,
    new: || Box::new(PlannerView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct PlannerView {
    /// Of the open measurement's angles, and of the planned ones.
    pub predictions: Memo<Key, [Result<PredictedErrors, String>; 2]>,
    /// What the next reading would gain at each pair of angles, θr by θr; a sentence where that is not defined.
    pub gains: AsyncMemo<Key, Result<Vec<f64>, String>>,
    /// With whether the gains are those of the angles, and the picked θi and θr.
    plane: FigurePlot<(Key, bool, Option<[f64; 2]>)>,
}

/// Width that a plan and what it brings need side by side.
const SIDE_BY_SIDE: f32 = 640.0;
/// Of that, what the plan has.
const PLAN: f32 = 260.0;

impl View for PlannerView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (design, surface, document) = (&cx.work.settings().design, cx.work.surface(), cx.work.active());
        let free = free_in_design(surface, design, document.measurement.has_brdf());
        let key = (surface.parameters, surface.model, free, design.clone(), document.generation, i18n::current());
        self.predictions.refresh(key.clone(), |_| {
            let measured = PredictedErrors::of_measurement(surface, design, free, &document.measurement);
            let given = if design.counts_given { measured_rows(&document.measurement) } else { Vec::new() };
            [measured, PredictedErrors::of_plan(surface, design, free, &given)]
        });
        // A value that is not a number would differ from itself, and a job follow a job for ever.
        if surface.parameters.to_array().iter().all(|value| value.is_finite()) {
            let choice = angle_choice(surface, design, &document.measurement).map(|choice| with_planned(choice, design));
            self.gains.refresh(&cx.jobs.spawner, &key, move |stopped| {
                let observer = Observer { cancelled: &|| stopped(), ..Observer::NONE };
                choice.and_then(|choice| next_gains(&choice, observer).map_err(|error| tr!("{}.", error.localized())))
            });
        }
        if let (Some(key), Some(gains)) = (self.gains.key(), self.gains.get()) {
            let is_current = key.3.lists() == design.lists();
            let gains = gains.as_ref().ok().filter(|_| is_current);
            let theta_i = cx.work.settings().theta_i;
            let picked = cx.derived.picked_theta_r(cx.work).map(|theta_r| [theta_r, theta_i]);
            let figure_key = (key.clone(), is_current, picked);
            self.plane.refresh(figure_key, |_| gains.map(|gains| plane::describe(gains, design, picked, document)));
        }
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let (before, document) = (&cx.work.settings().design, cx.work.active());
        let mut design = before.clone();
        ScrollArea::both().auto_shrink([false; 2]).show(ui, |ui| {
            let width = ui.available_width();
            if width > SIDE_BY_SIDE {
                ui.horizontal_top(|ui| {
                    ui.vertical(|ui| {
                        // Sentences would take all of the width.
                        ui.set_max_width(PLAN.min(0.45 * width));
                        plan::plan_ui(&mut design, cx, ui);
                        ui.separator();
                        angles::angles_ui(&mut design, document, ui);
                    });
                    ui.separator();
                    ui.vertical(|ui| {
                        self.plane_ui(&mut design, ui);
                        predictions::predictions_ui(cx.work, self, ui);
                    });
                });
            } else {
                plan::plan_ui(&mut design, cx, ui);
                self.plane_ui(&mut design, ui);
                predictions::predictions_ui(cx.work, self, ui);
                ui.separator();
                angles::angles_ui(&mut design, document, ui);
            }
            plan::readings_ui(&design, cx.actions, ui);
        });
        if design != *before {
            cx.edits.push(Edit::SetDesign(design));
        }
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plane.figure().cloned()
    }

    fn suspend(&mut self) {
        self.gains.stop_if(|_| true);
    }
}

/// The request with the planned readings as if they were measured.
fn with_planned(mut choice: AngleChoice, design: &DesignSettings) -> AngleChoice {
    // Of a reading without a standard deviation of its own the noise is that of the plan.
    let quantity = |is_measured: bool| is_measured.then_some(Quantity { value: 0.0, sigma: None });
    let (dolp, brdf) = (quantity(choice.noise.dolp.is_some()), quantity(choice.noise.brdf.is_some()));
    let planned = design.readings.iter().filter_map(|reading| design.geometry(*reading));
    choice.given.extend(planned.map(|geometry| Row { geometry, dolp, brdf, masked: false }));
    choice
}

impl PlannerView {
    /// The plane of angles; a click adds a reading, or takes it out.
    fn plane_ui(&mut self, design: &mut DesignSettings, ui: &mut Ui) {
        match self.gains.get() {
            Some(Err(sentence)) => _ = ui.add(egui::Label::new(sentence).wrap()),
            Some(Ok(gains)) => {
                if let Some(reading) = plane::plane_ui(&mut self.plane, gains, design, ui) {
                    design.toggle(reading);
                }
            }
            None => _ = ui.weak("…"),
        }
    }
}
