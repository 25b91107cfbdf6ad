//! BRDF against θr: total and each term at the sliders' θi, and the measured values with the model's total.

use super::axis::{self, axis, decimal, power_of_ten};
use super::dolp::marks_in;
use super::{curve, legend, plot};
use crate::app::theme;
use crate::app::window::Explorer;
use egui::Ui;
use egui_plot::{AxisHints, HoverPosition};

pub fn lobes_ui(explorer: &mut Explorer, ui: &mut Ui, height: f32) {
    let Explorer { derived, settings, view, .. } = explorer;
    let dark = ui.visuals().dark_mode;
    let axes = &mut view.lobes;
    let derived = &*derived;
    let log = settings.log_brdf;
    let x = axis(AxisHints::new_x(), ui, "θr / °", decimal).min_thickness(40.0);
    let y = axis(AxisHints::new_y(), ui, "BRDF / (1/sr)", if log { power_of_ten } else { decimal });
    let response = plot("lobes", ui, height, x, y)
        .y_grid_spacer(move |input| axis::marks(&input, 5.0, if log { 1.0 } else { 0.0 }))
        .legend(legend())
        .label_formatter(move |hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                let brdf = if log { libm::exp10(position.y) } else { position.y };
                Some(format!("{plot_name}\nθr = {:.2}°\nBRDF = {brdf:.4e} 1/sr", position.x))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            axes.apply(plot, derived.x, derived.brdf_range);
            for (i, (curves, marks)) in derived.series.iter().zip(&derived.marks).enumerate() {
                if marks.brdf.is_there() {
                    let color = theme::series(i, dark);
                    curve(plot, &curves.total, &marks.name, color, None, 1.5);
                    marks_in(plot, &marks.brdf, &marks.name, color, dark);
                }
            }
            curve(plot, &derived.own.specular, "specular", theme::specular(dark), None, 1.5);
            curve(plot, &derived.own.diffuse, "diffuse", theme::diffuse(dark), None, 1.5);
            curve(plot, &derived.own.volume, "volume", theme::volume(dark), None, 1.5);
            curve(plot, &derived.own.total, "total", theme::foreground(dark), None, 2.5);
        });
    axes.listen(&response, ui);
}
