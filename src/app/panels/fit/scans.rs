//! The honest interval of one parameter, and the bootstrap, on demand.

use crate::app::plots::axis;
use crate::app::plots::axis::{axis, decimal};
use crate::app::plots::line;
use crate::app::plots::theme;
use crate::app::text::estimate::interval_text;
use crate::app::text::numbers::significant;
use crate::app::views::Cx;
use crate::app::views::action::Action;
use crate::app::work::diagnostics::ProfileCurve;
use crate::app::work::edit::Edit;
use crate::app::work::fit_history::FitEntry;
use crate::figure::with_unit;
use egui::{Align2, Button, CollapsingHeader, ComboBox, DragValue, RichText, Role, Ui, WidgetInfo};
use egui_plot::{AxisHints, HLine, HoverPosition, LineStyle, Plot, PlotPoint, PlotPoints, Points, Text, VLine};
use pbrdf::model::Parameter;
use tr::tr;

/// Data sets that a bootstrap deals out at most.
const MOST_REPLICATES: usize = 100_000;

pub fn scans_ui(fit: &FitEntry, cx: &mut Cx<'_>, ui: &mut Ui) {
    let free = fit.problem.free();
    if free.is_empty() || fit.problem.is_empty() {
        return;
    }
    let (running, scans) = (cx.jobs.fits.is_scanning(), cx.work.diagnostics());
    CollapsingHeader::new(tr!("Profile and bootstrap")).id_salt("scans").show(ui, |ui| {
        profile_choice_ui(free, cx, ui);
        if let Some(profile) = &scans.profile {
            profile_ui(profile, ui);
        }
        bootstrap_ui(cx, ui);
        if running {
            ui.horizontal(|ui| {
                ui.spinner();
                if ui.button(tr!("Stop the scan")).on_hover_text(tr!("Stop and keep what is there")).clicked() {
                    cx.actions.push(Action::CancelScan);
                }
            });
        }
    });
}

fn bootstrap_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let (running, scans) = (cx.jobs.fits.is_scanning(), cx.work.diagnostics());
    ui.horizontal(|ui| {
        let help = tr!("Deal the residuals out anew, fit again, and see how the parameters scatter: a column in the table of results");
        if ui.add_enabled(!running, Button::new(tr!("Bootstrap"))).on_hover_text(help).clicked() {
            cx.actions.push(Action::Bootstrap);
        }
        let label = ui.label(tr!("data sets"));
        let mut replicates = scans.replicates;
        if ui.add(DragValue::new(&mut replicates).range(10..=MOST_REPLICATES)).labelled_by(label.id).changed() {
            cx.edits.push(Edit::SetReplicates(replicates));
        }
    });
    if let Some(bootstrap) = &scans.scatter {
        ui.weak(if bootstrap.is_complete() {
            tr!("{0} data sets fitted, each from several starts", bootstrap.replicates)
        } else {
            tr!("{0} of {1} data sets fitted, each from several starts: the bootstrap was stopped", bootstrap.replicates, bootstrap.asked)
        });
    }
}

fn profile_choice_ui(free: &[Parameter], cx: &mut Cx<'_>, ui: &mut Ui) {
    let chosen = cx.work.diagnostics().parameter.filter(|parameter| free.contains(parameter)).unwrap_or(free[0]);
    ui.horizontal(|ui| {
        let label = ui.label(tr!("Profile of"));
        let combo = ComboBox::from_id_salt("profile").width(60.0).selected_text(chosen.symbol()).show_ui(ui, |ui| {
            for parameter in free {
                if ui.selectable_label(*parameter == chosen, parameter.symbol()).clicked() {
                    cx.edits.push(Edit::SetProfiled(*parameter));
                }
            }
        });
        combo.response.labelled_by(label.id);
        let help = tr!("Hold it at values around the fitted one and fit the rest again: the interval that holds where errors are not \
             symmetric, or where the data leave directions open");
        if ui.add_enabled(!cx.jobs.fits.is_scanning(), Button::new(tr!("Scan"))).on_hover_text(help).clicked() {
            cx.actions.push(Action::Profile(chosen));
        }
    });
}

const HEIGHT: f32 = 150.0;
/// How many times the gain at 95 % the plot shows.
const SHOWN: f64 = 1.25;
/// Names of the two levels.
const LEVEL_NAMES: [&str; 2] = ["68.3 %", "95 %"];

fn profile_ui(profile: &ProfileCurve, ui: &mut Ui) {
    let dark = ui.visuals().dark_mode;
    let name = if profile.is_chi2 { "Δχ²" } else { "ΔΣ²" };
    let help = tr!("Where the sum of squares of the best fit with this parameter held rises by as much as the level allows");
    for (name, interval) in LEVEL_NAMES.into_iter().zip(profile.intervals) {
        ui.label(format!("{}, {name}: {}", profile.parameter.symbol(), interval_text(interval))).on_hover_text(help.as_str());
    }
    if !profile.is_complete {
        ui.weak(tr!("The scan did not come to its ends."));
    }
    let points: Vec<PlotPoint> = profile.points.iter().map(|&[value, gain]| PlotPoint::new(value, gain)).collect();
    let highest = points.iter().map(|point| point.y).fold(0.0, f64::max);
    let [_, limit] = profile.limits;
    let top = if limit > 0.0 && limit.is_finite() { SHOWN * limit } else { highest };
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
    if !(first.x < last.x && top > 0.0) {
        return;
    }
    let x_title = with_unit(profile.parameter.symbol(), profile.parameter.unit());
    let x = axis(AxisHints::new_x(), ui, &x_title, decimal).min_thickness(40.0);
    let y = axis(AxisHints::new_y(), ui, name, decimal).min_thickness(58.0);
    let plot = Plot::new("profile")
        .height(HEIGHT)
        // A wide table over it does not make it run out of the panel.
        .width(ui.available_width().min(ui.clip_rect().right() - ui.cursor().left()))
        .custom_x_axes(vec![x])
        .custom_y_axes(vec![y])
        .x_grid_spacer(|input| axis::marks(&input, 6.0, 0.0))
        .y_grid_spacer(|input| axis::marks(&input, 3.0, 0.0))
        .grid_color(theme::grid(dark))
        .grid_fade(0.0)
        .allow_drag([false, false])
        .allow_zoom([false, false])
        .allow_scroll([false, false])
        .allow_boxed_zoom(false)
        .show_x(false)
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { position, .. } => {
                Some(format!("{} = {}\n{name} = {:.3e}", profile.parameter.symbol(), significant(position.x), position.y))
            }
            HoverPosition::Elsewhere { .. } => None,
        });
    let response = plot.show(ui, |plot| {
        plot.set_plot_bounds_x(first.x..=last.x);
        plot.set_plot_bounds_y(-0.05 * top..=1.05 * top);
        let color = theme::series(0, dark);
        let muted = theme::muted(dark);
        for (i, (level, interval)) in
            profile.limits.into_iter().zip(profile.intervals).enumerate().filter(|(_, (level, _))| level.is_finite())
        {
            let name = LEVEL_NAMES[i];
            let color = if i == 0 { theme::warning(dark) } else { muted };
            plot.hline(HLine::new(name, level).color(color).style(LineStyle::dashed_dense()));
            for end in interval.low.into_iter().chain(interval.high) {
                plot.vline(VLine::new(name, end).color(color).style(LineStyle::dotted_dense()));
            }
            let right = PlotPoint::new(last.x, level);
            plot.text(Text::new(name, right, RichText::new(name).small()).color(color).anchor(Align2::RIGHT_BOTTOM));
        }
        plot.vline(VLine::new(tr!("fit"), profile.best).color(muted));
        plot.line(line(&tr!("profile"), &points).color(color).width(1.5).allow_hover(false));
        plot.points(Points::new(tr!("profile"), PlotPoints::Borrowed(&points)).color(color).radius(2.0));
    });
    let said = || WidgetInfo::labeled(Role::Image, true, tr!("Plot: {0} against {1}", name, profile.parameter.symbol()));
    response.response.widget_info(said);
}
