//! The strip under DoLP: model less measurement, so that a misfit too small for the curves shows.

use crate::app::jobs::memo::Memo;
use crate::app::plots::axis;
use crate::app::plots::axis::{axis, decimal};
use crate::app::plots::{Axes, Following, Range, plot, round_up};
use crate::app::shell::app::App;
use crate::app::shell::theme;
use crate::app::views::curves::{MOST_POINTS, MOST_SERIES, drawn};
use crate::app::work::document::{DataPoint, Document};
use crate::app::work::settings::Settings;
use egui::Ui;
use egui_plot::{AxisHints, HLine, HoverPosition, PlotPoint, PlotPoints, Points};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Facet;
use tr::tr;

/// What the strip keeps.
#[derive(Default)]
pub struct Residuals {
    axes: Axes,
    /// DoLP of the model less the measured one, of each series; masked points left out.
    pub of_series: Memo<(Parameters, Model, u64), Vec<Vec<PlotPoint>>>,
    range: Following,
    is_there: bool,
}

/// Half the axis where a fit has been exact from the first.
const EXACT: f64 = 0.01;

impl Residuals {
    pub fn refresh(&mut self, settings: &Settings, document: &Document, dragging: bool) {
        let key = (settings.parameters, settings.model, document.generation);
        self.of_series.refresh(key, |_| of_all(settings, document));
        self.is_there = document.series.iter().any(|series| !series.dolp.is_empty());
        let largest = self.of_series.get().into_iter().flatten().flatten().map(|point| point.y.abs()).fold(0.0, f64::max);
        if largest > 0.0 {
            let end = 1.08 * round_up(largest);
            self.range.follow(Range { low: -end, high: end }, dragging);
        } else if self.range.get().is_none() {
            // Nothing is missed, or there is no surface: the axis waits where it is.
            self.range.follow(Range { low: -EXACT, high: EXACT }, dragging);
        }
    }

    /// Ends of its axis; none where no DoLP was measured. A strip that came and went would move the plot above it.
    pub fn range(&self) -> Option<Range> {
        self.range.get().filter(|_| self.is_there)
    }
}

fn of_all(settings: &Settings, document: &Document) -> Vec<Vec<PlotPoint>> {
    let Ok(surface) = Pbrdf::new(settings.model, settings.parameters) else { return Vec::new() };
    let of_one = |series: &crate::app::work::document::IncidenceSeries| {
        let step = series.dolp.len().div_ceil(MOST_POINTS / MOST_SERIES).max(1);
        let used = series.dolp.iter().step_by(step).filter(|mark| !mark.masked);
        let residual = |mark: &DataPoint| {
            let facet = Facet::new(series.geometry(mark.theta_r)?);
            Some(PlotPoint::new(mark.theta_r, surface.dolp(&facet) - mark.quantity.value))
        };
        used.filter_map(residual).collect()
    };
    drawn(document).map(of_one).collect()
}

/// Below this height marks stand closer, so that there is more than that at 0.
const LOW: f32 = 100.0;

pub fn residuals_ui(explorer: &mut App, ui: &mut Ui, height: f32) {
    let App { derived, views, .. } = explorer;
    let shown: Vec<bool> = (0..MOST_SERIES).map(|series| views.dolp.shows(series)).collect();
    let view = &mut views.dolp.residuals;
    let (Some(key), Some(marks), Some(residuals)) = (derived.curves.key(), derived.marks.get(), view.of_series.get()) else { return };
    let Some(range) = view.range.get() else { return };
    let dark = ui.visuals().dark_mode;
    let x = axis(AxisHints::new_x(), ui, "", decimal);
    let y = axis(AxisHints::new_y(), ui, &tr!("model − meas."), decimal);
    let response = plot("residuals", ui, height, x, y)
        .y_grid_spacer(move |input| axis::marks(&input, if height < LOW { 2.2 } else { 3.5 }, 0.0))
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                Some(tr!("{0}\nθr = {1}°\nresidual = {2}", plot_name, format!("{:.2}", position.x), format!("{:.2e}", position.y)))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            view.axes.apply(plot, Some(key.x()), Some(range));
            plot.hline(HLine::new("", 0.0).color(theme::muted(dark)).width(1.0));
            for (i, (residuals, marks)) in residuals.iter().zip(&marks.series).enumerate() {
                if !residuals.is_empty() && shown.get(i) != Some(&false) {
                    plot.points(Points::new(marks.name.clone(), PlotPoints::Borrowed(residuals)).color(theme::series(i, dark)).radius(2.5));
                }
            }
        });
    view.axes.listen(&response, &tr!("Plot: residuals of DoLP against θr"), ui);
}
