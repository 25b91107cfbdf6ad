//! The map: the landscape's image with its axes, and what lies on it.

use crate::app::plots::axis::{axis, decimal};
use crate::app::plots::{BAR_ROOM, line, plot};
use crate::app::views::landscape::axes::{coordinate, grid, logarithmic};
use crate::app::views::landscape::drawn::LandscapeImage;
use crate::app::views::landscape::legend::legend_ui;
use crate::app::views::landscape::marks::{marks_in, sliders_in};
use crate::app::views::landscape::state::LandscapeView;
use crate::app::work::workspace::Workspace;
use egui::{TextureHandle, TextureOptions, Ui, vec2};
use egui_plot::{AxisHints, HoverPosition, PlotBounds, PlotImage, PlotPoint, PlotResponse, PlotUi};
use pbrdf::fit::LandscapeAxis;
use pbrdf::model::Parameter;

/// The map with what lies on it.
pub fn map_ui(view: &mut LandscapeView, work: &Workspace, height: f32, ui: &mut Ui) -> PlotResponse<()> {
    let shown = work.settings().landscape;
    let drawn = view.job.get().and_then(Option::as_ref);
    if let (Some(key), Some(drawn)) = (view.job.key(), drawn) {
        let (texture, ctx) = (&mut view.texture, ui.ctx());
        view.textured.refresh(key.clone(), |_| match texture {
            Some(texture) => texture.set(drawn.image.clone(), TextureOptions::LINEAR),
            None => *texture = Some(ctx.load_texture("landscape", drawn.image.clone(), TextureOptions::LINEAR)),
        });
    }
    let (wanted, seen) = (view.wanted.take(), view.seen.map(|(_, _, seen)| seen));
    let format = |parameter: Parameter| if parameter.is_logarithmic() { logarithmic } else { decimal };
    let marks = view.marks.get();
    let x = axis(AxisHints::new_x(), ui, shown.across.symbol(), format(shown.across)).min_thickness(36.0);
    let y = axis(AxisHints::new_y(), ui, shown.up.symbol(), format(shown.up)).min_thickness(72.0);
    let response = plot("landscape", ui, height, x, y)
        .width((ui.available_width() - BAR_ROOM).max(80.0))
        .x_grid_spacer(move |input| grid(shown.across, &input, 7.0))
        .y_grid_spacer(move |input| grid(shown.up, &input, 5.0))
        .show_grid(false)
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, index, .. } => marks.and_then(|marks| marks.text(plot_name, *index)),
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            // A plot that was closed and opened again has forgotten where it was.
            let forgotten = seen.filter(|[x, y]| plot.plot_bounds() != PlotBounds::from_min_max([x.low, y.low], [x.high, y.high]));
            if let Some([x, y]) = wanted.or(forgotten) {
                plot.set_plot_bounds_x(x.low..=x.high);
                plot.set_plot_bounds_y(y.low..=y.high);
            }
            if let (Some(drawn), Some(texture)) = (drawn, &view.texture) {
                drawn_in(plot, drawn, texture, shown.contours);
            }
            if let Some(marks) = marks {
                marks_in(plot, marks, shown);
            }
            let sliders = [shown.across, shown.up].map(|parameter| coordinate(parameter, work.surface().parameters[parameter]));
            if sliders.iter().all(|place| place.is_finite()) {
                sliders_in(plot, sliders);
            }
        });
    legend_ui(marks, shown, response.response.rect, ui);
    response
}

fn drawn_in<'a>(plot: &mut PlotUi<'a>, drawn: &'a LandscapeImage, texture: &TextureHandle, with_contours: bool) {
    let ends = |axis: LandscapeAxis| [axis.low, axis.high].map(|value| coordinate(axis.parameter, value));
    let ([left, right], [bottom, top]) = (ends(drawn.landscape.across), ends(drawn.landscape.up));
    let center = PlotPoint::new(f64::midpoint(left, right), f64::midpoint(bottom, top));
    #[expect(clippy::cast_possible_truncation, reason = "a size on the screen")]
    let size = vec2((right - left) as f32, (top - bottom) as f32);
    plot.image(PlotImage::new("", texture.id(), center, size).allow_hover(false));
    for (color, pieces) in drawn.contours.iter().filter(|_| with_contours) {
        for piece in pieces {
            plot.line(line("", piece).color(*color).width(1.0).allow_hover(false));
        }
    }
}
