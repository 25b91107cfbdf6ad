//! A plot with its axes, and how the user looks at it.

use crate::app::plots::axis;
use crate::app::plots::range::Range;
use crate::app::plots::theme;
use egui::{Role, Ui, WidgetInfo};
use egui_plot::{AxisHints, Plot, PlotBounds, PlotResponse, PlotUi};

/// How the axes of a plot are looked at: as the contents want, until the user pans or zooms; a
/// double click gives them back.
#[derive(Debug, Default)]
pub struct Axes {
    by_hand: bool,
    /// Where the plot was when it was drawn last.
    seen: Option<PlotBounds>,
    shown: Option<(Range, Range)>,
}

impl Axes {
    /// Moves the plot where the contents want it, if they want it elsewhere than before.
    pub fn apply(&mut self, plot: &mut PlotUi<'_>, x: Option<Range>, y: Option<Range>) {
        let (Some(x), Some(y)) = (x, y) else { return };
        // One that was closed and opened again has forgotten where it was.
        if self.seen.is_some_and(|seen| seen != plot.plot_bounds()) {
            *self = Self::default();
        }
        if !self.by_hand && self.shown != Some((x, y)) {
            plot.set_plot_bounds_x(x.low..=x.high);
            plot.set_plot_bounds_y(y.low..=y.high);
            self.shown = Some((x, y));
        }
    }

    /// Whether the user has panned or zoomed.
    pub fn is_moved(&self) -> bool {
        self.by_hand
    }

    /// Where the horizontal axis was seen last.
    pub fn seen_x(&self) -> Option<Range> {
        self.seen.map(|seen| Range { low: seen.min()[0], high: seen.max()[0] }).filter(|range| range.low < range.high)
    }

    /// Notices panning and zooming, and tells screen readers what is drawn; call it with what the
    /// plot answered.
    pub fn track_interaction<R>(&mut self, response: &PlotResponse<R>, name: &str, ui: &Ui) {
        response.response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
        self.seen = Some(*response.transform.bounds());
        let zoomed = response.response.hovered() && ui.input(|input| input.zoom_delta() != 1.0);
        if response.response.double_clicked() {
            *self = Self::default();
            ui.ctx().request_repaint();
        } else if response.response.dragged() || zoomed {
            self.by_hand = true;
        }
    }
}

/// A plot that fills that height, with these axes.
pub fn plot<'a>(name: &str, ui: &Ui, height: f32, x: AxisHints<'a>, y: AxisHints<'a>) -> Plot<'a> {
    Plot::new(name)
        .height(height)
        .custom_x_axes(vec![x])
        .custom_y_axes(vec![y])
        .x_grid_spacer(|input| axis::marks(&input, 7.0, 0.0))
        .grid_color(theme::grid(ui.visuals().dark_mode))
        .grid_fade(0.0)
        .auto_bounds([false, false])
        .allow_double_click_reset(false)
        // The wheel is for the page; with Ctrl it zooms.
        .allow_scroll(false)
}

#[cfg(test)]
mod tests {
    use super::{Axes, AxisHints, Plot, PlotBounds, Range, plot};
    use egui_kittest::Harness;

    /// What the axes keep, which plot is drawn, and where it turned out to be.
    #[derive(Default)]
    struct State {
        axes: Axes,
        plot: usize,
        seen: [f64; 2],
    }

    #[test]
    fn a_plot_that_is_opened_anew_is_moved_where_its_contents_are() {
        let frame = |ui: &mut egui::Ui, State { axes, plot, seen }: &mut State| {
            let range = Some(Range { low: 3.0, high: 7.0 });
            let response = Plot::new(*plot).auto_bounds([false, false]).show(ui, |plot| axes.apply(plot, range, range));
            axes.track_interaction(&response, "plot", ui);
            *seen = response.transform.bounds().min();
        };
        let mut harness = Harness::builder().build_ui_state(frame, State::default());
        harness.run();
        assert_eq!(harness.state().seen, [3.0, 3.0]);
        harness.state_mut().plot = 1;
        harness.run();
        assert_eq!(harness.state().seen, [3.0, 3.0]);
        harness.state_mut().axes.by_hand = true;
        harness.state_mut().plot = 2;
        harness.run();
        assert_eq!(harness.state().seen, [3.0, 3.0]);
    }

    #[test]
    fn the_wheel_moves_no_plot_out_of_sight() {
        let frame = |ui: &mut egui::Ui, seen: &mut Option<PlotBounds>| {
            let axes = || [AxisHints::new_x(), AxisHints::new_y()];
            let [x, y] = axes();
            *seen = Some(*plot("plot", ui, 200.0, x, y).show(ui, |_| ()).transform.bounds());
        };
        let mut harness = Harness::builder().with_size(egui::vec2(300.0, 200.0)).build_ui_state(frame, None);
        harness.run();
        let before = *harness.state();
        assert!(before.is_some());
        harness.hover_at(egui::pos2(150.0, 100.0));
        let unit = egui::MouseWheelUnit::Point;
        let phase = egui::TouchPhase::Move;
        let (source, modifiers) = (egui::MouseWheelSource::Unknown, egui::Modifiers::NONE);
        harness.event(egui::Event::MouseWheel { unit, delta: egui::vec2(0.0, -50.0), phase, source, modifiers });
        harness.run();
        assert_eq!(*harness.state(), before);
    }
}
