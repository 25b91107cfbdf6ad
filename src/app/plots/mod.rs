//! The plots in the middle.

pub mod axis;
mod dolp;
mod error_bars;
mod lobes;
mod residuals;

use super::derived::{Pieces, Range};
use super::theme;
use super::window::Explorer;
use egui::Ui;
use egui_plot::{AxisHints, Corner, Legend, Line, LineStyle, Plot, PlotPoints, PlotResponse, PlotUi};

/// How the axes are looked at: as the contents want, until the user pans or zooms; a double click gives them back.
#[derive(Debug, Default)]
pub struct View {
    dolp: Axes,
    residuals: Axes,
    lobes: Axes,
}

impl View {
    /// Gives all axes back to the contents.
    pub fn reset(&mut self) {
        *self = Self::default();
    }
}

#[derive(Debug, Default)]
struct Axes {
    by_hand: bool,
    shown: Option<(Range, Range)>,
}

impl Axes {
    /// Moves the plot where the contents want it, if they want it elsewhere than before.
    fn apply(&mut self, plot: &mut PlotUi<'_>, x: Option<Range>, y: Option<Range>) {
        let (Some(x), Some(y)) = (x, y) else { return };
        if !self.by_hand && self.shown != Some((x, y)) {
            plot.set_plot_bounds_x(x.low..=x.high);
            plot.set_plot_bounds_y(y.low..=y.high);
            self.shown = Some((x, y));
        }
    }

    fn listen<R>(&mut self, response: &PlotResponse<R>, ui: &Ui) {
        let scrolled =
            response.response.hovered() && ui.input(|input| input.smooth_scroll_delta != egui::Vec2::ZERO || input.zoom_delta() != 1.0);
        if response.response.double_clicked() {
            *self = Self::default();
            ui.ctx().request_repaint();
        } else if response.response.dragged() || scrolled {
            self.by_hand = true;
        }
    }
}

/// DoLP, what it misses, and the lobes, one above the other.
pub fn plots_ui(explorer: &mut Explorer, ui: &mut Ui) {
    if let Some(fault) = &explorer.derived.fault {
        ui.colored_label(theme::warning(ui.visuals().dark_mode), format!("There is no curve: {fault}"));
    }
    let strip = explorer.derived.residual_range.is_some();
    let room = ui.available_height() - 48.0;
    let (dolp_share, strip_share) = if strip { (0.42, 0.16) } else { (0.5, 0.0) };
    let height = |share: f32| (share * room).max(70.0);
    ui.strong("Degree of linear polarisation");
    ui.add_space(2.0);
    dolp::dolp_ui(explorer, ui, height(dolp_share));
    if strip {
        residuals::residuals_ui(explorer, ui, height(strip_share) - 4.0);
    }
    let title = format!("BRDF lobes at θi = {}°, Δφ = {}°", explorer.settings.theta_i, explorer.settings.dphi);
    let line = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(line, egui::Layout::right_to_left(egui::Align::Center), |ui| {
        ui.checkbox(&mut explorer.settings.log_brdf, "log").on_hover_text("Logarithmic axis");
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.add(egui::Label::new(egui::RichText::new(title).strong()).truncate());
        });
    });
    lobes::lobes_ui(explorer, ui, height(1.0 - dolp_share - strip_share));
}

/// What all plots have in common.
fn plot<'a>(name: &str, ui: &Ui, height: f32, x: AxisHints<'a>, y: AxisHints<'a>) -> Plot<'a> {
    Plot::new(name)
        .height(height)
        .custom_x_axes(vec![x])
        .custom_y_axes(vec![y.min_thickness(72.0)])
        .x_grid_spacer(|input| axis::marks(&input, 7.0, 0.0))
        .grid_color(theme::grid(ui.visuals().dark_mode))
        .grid_fade(0.0)
        .auto_bounds([false, false])
        .allow_double_click_reset(false)
}

/// Where the names of curves stand: in the corner that lobes and DoLP seldom reach.
fn legend() -> Legend {
    Legend::default().position(Corner::LeftTop).follow_insertion_order(true).background_alpha(0.85)
}

/// A curve in its pieces, under one name.
fn curve<'a>(plot: &mut PlotUi<'a>, pieces: &'a Pieces, name: &str, color: egui::Color32, style: Option<LineStyle>, width: f32) {
    for piece in pieces {
        let line = Line::new(name.to_owned(), PlotPoints::Borrowed(piece)).color(color).width(width);
        plot.line(if let Some(style) = style { line.style(style) } else { line });
    }
}
