//! What a plan is to be good for, the choice of its readings, and the readings in the order of a goniometer's least movement.

use crate::app::jobs::job::Job;
use crate::app::storage::export::ExportKind;
use crate::app::text::i18n::translated;
use crate::app::text::numbers::short;
use crate::app::views::action::{Action, InquiryAction};
use crate::app::views::context::Cx;
use crate::app::work::design::{DesignGoal, DesignSettings, READINGS};
use crate::report::{least_movement, movement};
use egui::{Button, CollapsingHeader, ComboBox, DragValue, Label, ProgressBar, Ui};
use tr::tr;

/// What is wanted, how many readings, and the buttons.
pub fn plan_ui(design: &mut DesignSettings, cx: &mut Cx<'_>, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let label = ui.label(tr!("I want to know"));
        let combo = ComboBox::from_id_salt("goal of the plan").width(120.0).selected_text(translated(design.goal.name()));
        let combo = combo.show_ui(ui, |ui| {
            for goal in DesignGoal::ALL {
                ui.selectable_value(&mut design.goal, goal, translated(goal.name()));
            }
        });
        combo.response.labelled_by(label.id).on_hover_text(tr!(
            "All: the determinant of the information on all free parameters. n and k, σ and q: the sum of their relative variances. \
             Gauss or Cauchy: by how much the best fit of the other distribution misses."
        ));
    });
    ui.horizontal(|ui| {
        let label = ui.label(tr!("Readings"));
        ui.add(DragValue::new(&mut design.count).range(READINGS)).labelled_by(label.id);
        let running = cx.jobs.plans.choose.job().map(Job::progress);
        match running {
            Some(share) => {
                if ui.button(tr!("Stop choosing")).clicked() {
                    cx.actions.push(Action::Inquire(InquiryAction::CancelChoice));
                }
                #[expect(clippy::cast_possible_truncation, reason = "a fraction")]
                ui.add(ProgressBar::new(share.unwrap_or(0.0) as f32).desired_width(80.0));
            }
            None => {
                let help = tr!("The best so many of the angles below, each at most once, by exchange from many beginnings");
                if ui.button(tr!("Choose for me")).on_hover_text(help).clicked() {
                    cx.actions.push(Action::Inquire(InquiryAction::ChooseAngles));
                }
            }
        }
        let clear = ui.add_enabled(!design.readings.is_empty(), Button::new(tr!("Clear")));
        if clear.on_hover_text(tr!("Plan no single reading: all pairs of the angles below")).clicked() {
            design.readings.clear();
        }
    });
    ui.checkbox(&mut design.counts_given, tr!("What is measured counts"))
        .on_hover_text(tr!("The planned readings come on top of the open measurement"));
    chosen_ui(design, cx, ui);
}

/// How good the chosen angles are, and what no choice reaches.
fn chosen_ui(design: &DesignSettings, cx: &Cx<'_>, ui: &mut Ui) {
    let Some(planned) = cx.work.plan() else { return };
    let (count, efficiency) = (planned.angles.len(), format!("{:.0}", 100.0 * planned.efficiency));
    let text = if design.goal == DesignGoal::Distribution {
        let value = format!("{:.2}", planned.value);
        let enough = if planned.value >= TOLD {
            tr!("so many readings can tell the two apart")
        } else {
            tr!("so many readings cannot tell the two apart: {} is needed", TOLD)
        };
        tr!("The best fit of the other distribution misses {0} readings by {1} variances of the noise: {2}.", count, value, enough)
    } else {
        tr!("{0} readings tell {1} % of what all {2} candidates together would tell.", count, efficiency, candidates(design))
    };
    ui.add(Label::new(text).wrap());
    for (parameter, error) in &planned.limits {
        let [count, error] = [count.to_string(), short(*error)];
        ui.add(Label::new(tr!("No choice of {0} of these angles brings {1} below ± {2}.", count, parameter.symbol(), error)).wrap());
    }
}

/// Sum of squares in variances of the noise from which models are told apart: three standard deviations.
const TOLD: f64 = 9.0;

fn candidates(design: &DesignSettings) -> usize {
    let (incidences, views) = design.counts();
    incidences * views
}

/// The readings one by one, and a file of them.
pub fn readings_ui(design: &DesignSettings, actions: &mut Vec<Action>, ui: &mut Ui) {
    if design.readings.is_empty() {
        return;
    }
    let ordered = least_movement(&design.readings);
    let [of_i, of_r] = movement(&ordered);
    let title = tr!("{0} readings in order of least movement", ordered.len());
    CollapsingHeader::new(title).id_salt("readings").show(ui, |ui| {
        ui.horizontal(|ui| {
            if ui.button(tr!("Save plan…")).on_hover_text(tr!("An empty table to fill in, in this order")).clicked() {
                actions.push(Action::ChooseExport(ExportKind::Plan));
            }
            ui.weak(tr!("θi moves {0}° in all, θr {1}°", short(of_i), short(of_r)));
        });
        ui.horizontal_wrapped(|ui| {
            for (i, [theta_i, theta_r]) in ordered.iter().enumerate() {
                ui.label(format!("{}: {theta_i}°, {theta_r}°", i + 1));
            }
        });
    });
}
