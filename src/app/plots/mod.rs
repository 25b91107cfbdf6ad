//! What plots have in common: axes, ranges, curves in pieces, measured points with error bars.

pub mod axis;
mod color_scale;
pub mod contours;
mod drawing;
mod error_bars;
mod key_line;
mod marks;
mod picking;
pub mod print;
mod range;
mod ribbon;

pub use color_scale::{BAR_ROOM, BarLabels, BarMarks, ColorScale, color_bar, ink_on};
pub use drawing::Drawing;
pub use error_bars::ErrorBars;
pub use key_line::{KeyEntry, key_line_ui, switching_key_line_ui};
pub use marks::marks_in;
pub use picking::{MASK_HINT, clicked_mask};
pub use range::{Following, Range, round_up};
pub use ribbon::{Ribbon, ribbons_in};

use crate::app::shell::theme;
use crate::app::views::curves::Polyline;
use egui::{Role, Ui, WidgetInfo};
use egui_plot::{AxisHints, Corner, Legend, Line, LineStyle, Plot, PlotBounds, PlotPoint, PlotPoints, PlotResponse, PlotUi};

/// How the axes of a plot are looked at: as the contents want, until the user pans or zooms; a double click gives them back.
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

    /// Notices panning and zooming, and tells screen readers what is drawn; call it with what the plot answered.
    pub fn listen<R>(&mut self, response: &PlotResponse<R>, name: &str, ui: &Ui) {
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
        .custom_y_axes(vec![y.min_thickness(72.0)])
        .x_grid_spacer(|input| axis::marks(&input, 7.0, 0.0))
        .grid_color(theme::grid(ui.visuals().dark_mode))
        .grid_fade(0.0)
        .auto_bounds([false, false])
        .allow_double_click_reset(false)
        // The wheel is for the page; with Ctrl it zooms.
        .allow_scroll(false)
}

/// Where the names of curves stand: in the corner that lobes and DoLP seldom reach.
pub fn legend() -> Legend {
    Legend::default().position(Corner::LeftTop).follow_insertion_order(true).background_alpha(0.85)
}

/// A line that is as wide where it is steep: `egui_plot` draws points that are less than a pixel apart as a band, which is as high
/// everywhere as the line is wide.
pub fn line<'a>(name: &str, points: &'a [PlotPoint]) -> Line<'a> {
    Line::new(name, PlotPoints::Borrowed(points)).allow_band(false)
}

/// A curve in its pieces, under one name.
pub fn curve<'a>(plot: &mut PlotUi<'a>, pieces: &'a Polyline, name: &str, color: egui::Color32, style: Option<LineStyle>, width: f32) {
    for piece in pieces {
        let line = line(name, piece).color(color).width(width);
        plot.line(if let Some(style) = style { line.style(style) } else { line });
    }
}

/// The same, filled down to that height.
pub fn filled<'a>(plot: &mut PlotUi<'a>, pieces: &'a Polyline, name: &str, color: egui::Color32, floor: f64) {
    #[expect(clippy::cast_possible_truncation, reason = "egui_plot takes a height as f32")]
    let floor = floor as f32;
    for piece in pieces {
        plot.line(line(name, piece).color(color).width(1.5).fill(floor).fill_alpha(0.25));
    }
}

#[cfg(test)]
mod tests {
    use super::{Axes, AxisHints, Plot, PlotBounds, Range, curve, plot};
    use egui::{Color32, Shape};
    use egui_kittest::Harness;
    use egui_plot::PlotPoint;

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
            axes.listen(&response, "plot", ui);
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

    #[test]
    fn a_steep_curve_is_as_wide_as_a_flat_one() {
        // Some points to the pixel, and steeper and steeper to the right.
        let point = |i: i32| PlotPoint::new(f64::from(i), 1.0 / f64::from(2001 - i));
        let pieces = vec![(0..=2000).map(point).collect::<Vec<_>>()];
        let harness = Harness::new_ui(|ui| {
            Plot::new("plot").show(ui, |plot| curve(plot, &pieces, "curve", Color32::RED, None, 1.5));
        });
        let path = |shape: &Shape| matches!(shape, Shape::Path(path) if path.points.len() > 2000 && path.stroke.width == 1.5);
        assert!(harness.output().shapes.iter().any(|clipped| path(&clipped.shape)));
    }
}
