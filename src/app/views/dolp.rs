//! DoLP against θr: the model at every measured θi in its own colour, the points, the Fresnel limit, the last fit, and under it what
//! the model misses.

use super::facets::{another, sigma_of_equal_median};
use super::residuals::{self, Residuals};
use crate::app::band::{BandKey, Ribbons, band_key, dolp_bands};
use crate::app::curves::{BrdfScale, Curves, Pieces, axis_values, drawn};
use crate::app::document::Document;
use crate::app::language::translated;
use crate::app::memo::Memo;
use crate::app::plots::axis::{self, axis, decimal};
use crate::app::plots::{Axes, Following, MASK_HINT, Range, clicked_mask, curve, legend, marks_in, plot, ribbons_in, round_up};
use crate::app::state::{Overlay, Settings};
use crate::app::theme;
use crate::app::window::Explorer;
use egui::Ui;
use egui_plot::{AxisHints, HoverPosition, LineStyle};
use pbrdf::fit::Eq17;
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution;
use tr::tr;

/// What the pane keeps.
#[derive(Default)]
pub struct DolpView {
    axes: Axes,
    range: Following,
    /// DoLP of the last fit along each series, where the sliders have left it.
    ghost: Memo<Option<SurfaceKey>, Vec<Pieces>>,
    /// DoLP with the other distribution.
    overlay: Memo<Option<SurfaceKey>, Vec<Pieces>>,
    /// One standard error around the last fit along each series.
    pub band: Memo<BandKey, Vec<Ribbons>>,
    pub residuals: Residuals,
}

/// Another surface than the sliders', the reading of Eq. (17), the generation of the document, whether the backscatter side is drawn.
type SurfaceKey = (Parameters, Model, Eq17, u64, bool);
impl DolpView {
    /// Ends of the axis of DoLP.
    pub fn range(&self) -> Option<Range> {
        self.range.get()
    }

    /// Along how many series the last fit is drawn beside the sliders' curves.
    #[cfg(test)]
    pub fn ghosts(&self) -> usize {
        self.ghost.get().map_or(0, Vec::len)
    }
}

pub fn dolp_refresh(explorer: &mut Explorer) {
    let Explorer { derived, settings, document, views, last_fit, dragging, .. } = explorer;
    derived.refresh_curves(settings, document);
    let (Some(curves), Some(key), Some(marks)) = (derived.curves.get(), derived.curves.key(), derived.marks.get()) else { return };
    let view = &mut views.dolp;

    let eq17 = settings.choices.eq17;
    let key_of = |parameters, model, eq17| (parameters, model, eq17, document.generation, key.backscatter);
    let of_sliders = key_of(settings.parameters, settings.model, eq17);
    let fitted = last_fit.as_ref().map(|fit| key_of(fit.report.parameters, fit.report.model, fit.problem.choices().eq17));
    let ghost = fitted.filter(|key| *key != of_sliders);
    view.ghost.refresh(ghost, |key| along_series(key.as_ref(), document));
    let other = other_distribution(settings).map(|(parameters, model)| key_of(parameters, model, eq17));
    view.overlay.refresh(other, |key| along_series(key.as_ref(), document));
    let fit = last_fit.as_deref();
    let band_key = band_key(fit, document, key.backscatter, BrdfScale::default(), settings.show_band);
    view.band.refresh(band_key, |key| match (key, fit) {
        (Some((_, _, backscatter, _)), Some(fit)) => dolp_bands(&fit.report, document, *backscatter),
        _ => Vec::new(),
    });
    view.residuals.refresh(settings, document, *dragging);

    let limit = settings.show_limit;
    let values = curves.all().flat_map(|curves| axis_values(&curves.dolp).chain(axis_values(&curves.limit).filter(move |_| limit)));
    let bars = marks.series.iter().flat_map(|marks| marks.dolp.bars.iter().map(|bar| bar.high));
    let points = marks.series.iter().flat_map(|marks| marks.dolp.used.iter().map(|point| point.y));
    let ghost = view.ghost.get().into_iter().flatten().flat_map(axis_values);
    let top = values.chain(ghost).chain(bars).chain(points).fold(0.0, f64::max);
    let high = if settings.shown.share { 1.05 } else { round_up(top).min(1.05) };
    view.range.follow(Range { low: 0.0, high }, *dragging);
}

/// DoLP of a surface along each series.
fn along_series(key: Option<&SurfaceKey>, document: &Document) -> Vec<Pieces> {
    let Some(&(parameters, model, eq17, _, backscatter)) = key else { return Vec::new() };
    let Ok(surface) = Pbrdf::new(model, parameters) else { return Vec::new() };
    drawn(document).map(|series| Curves::new(&surface, eq17, series, backscatter, BrdfScale::default()).dolp).collect()
}

/// The sliders' surface with Gauss in the place of Cauchy or the other way round, if that is asked for.
fn other_distribution(settings: &Settings) -> Option<(Parameters, Model)> {
    let Settings { model, mut parameters, shown, .. } = *settings;
    let other = another(model.distribution);
    match shown.overlay {
        _ if !model.specular => return None,
        Overlay::Absent => return None,
        Overlay::EqualSigma => {}
        Overlay::EqualMedian => parameters.sigma = sigma_of_equal_median(model.distribution, parameters.sigma, parameters.q),
    }
    Some((parameters, Model { distribution: other, ..model }))
}

/// Share of the height that the residuals have.
const STRIP: f32 = 0.25;

pub fn dolp_ui(explorer: &mut Explorer, ui: &mut Ui) {
    let room = ui.available_height();
    if explorer.views.dolp.residuals.range().is_some() && room > 220.0 {
        let strip = (STRIP * room).max(80.0);
        curves_ui(explorer, ui, room - strip - ui.spacing().item_spacing.y);
        residuals::residuals_ui(explorer, ui, strip);
    } else {
        curves_ui(explorer, ui, room);
    }
}

/// What is drawn in the pane.
pub fn dolp_options_ui(explorer: &mut Explorer, ui: &mut Ui) {
    let shown = &mut explorer.settings.shown;
    ui.checkbox(&mut shown.share, tr!("Specular share"))
        .on_hover_text(tr!("Specular part of the radiance, 0 to 1: DoLP is the Fresnel limit times this share"));
    ui.separator();
    ui.label(tr!("The other distribution"));
    for (overlay, name, help) in [
        (Overlay::Absent, tr!("not shown"), tr!("Only the distribution of the model")),
        (Overlay::EqualSigma, tr!("with equal σ"), tr!("The same σ, which is not the same width: compare shapes with equal median slope")),
        (Overlay::EqualMedian, tr!("with equal median slope"), tr!("σ such that half of the facets stay below the same slope")),
    ] {
        ui.radio_value(&mut shown.overlay, overlay, name).on_hover_text(help);
    }
    ui.separator();
    ui.checkbox(&mut explorer.settings.show_band, tr!("Confidence band"))
        .on_hover_text(tr!("One standard error of the fitted curve to either side"));
    ui.checkbox(&mut explorer.settings.show_limit, tr!("Fresnel limit"))
        .on_hover_text(tr!("DoLP without any depolarising term: no point can lie above it"));
    ui.checkbox(&mut explorer.settings.show_backscatter, tr!("Backscatter side"))
        .on_hover_text(tr!("Negative θr, also where nothing was measured"));
}

fn curves_ui(explorer: &mut Explorer, ui: &mut Ui, height: f32) {
    let Explorer { derived, settings, document, views, commands, .. } = explorer;
    let (Some(curves), Some(key), Some(marks)) = (derived.curves.get(), derived.curves.key(), derived.marks.get()) else { return };
    let view = &mut views.dolp;
    let dark = ui.visuals().dark_mode;
    let own_name = tr!("θi = {}° (slider)", settings.theta_i);
    let other_name = match (another(settings.model.distribution), settings.shown.overlay) {
        (SlopeDistribution::Gauss, Overlay::EqualMedian) => tr!("Gauss, equal median slope"),
        (SlopeDistribution::Gauss, _) => tr!("Gauss, equal σ"),
        (SlopeDistribution::Cauchy, Overlay::EqualMedian) => tr!("Cauchy, equal median slope"),
        (SlopeDistribution::Cauchy, _) => tr!("Cauchy, equal σ"),
    };
    // The legend has discs alone, so that words have to say which line is broken.
    let (limit_name, ghost_name) = (tr!("Fresnel limit (dashed)"), tr!("last fit (dotted)"));
    let other_name = tr!("{} (sparse dots)", other_name);
    let dashed = Some(LineStyle::dashed_dense());
    let x = axis(AxisHints::new_x(), ui, "θr / °", decimal).min_thickness(40.0);
    let y = axis(AxisHints::new_y(), ui, "DoLP", decimal);
    let response = plot("dolp", ui, height, x, y)
        .y_grid_spacer(|input| axis::marks(&input, 5.0, 0.0))
        .legend(legend())
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                Some(format!("{plot_name}\nθr = {:.2}°\nDoLP = {:.5}\n{}", position.x, position.y, translated(MASK_HINT)))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            view.axes.apply(plot, Some(key.x()), view.range.get());
            for (i, ribbons) in view.band.get().into_iter().flatten().enumerate() {
                ribbons_in(plot, ribbons, theme::series(i, dark));
            }
            if settings.show_limit {
                for (i, curves) in curves.series.iter().enumerate() {
                    curve(plot, &curves.limit, &limit_name, theme::series(i, dark), dashed, 1.0);
                }
                if curves.own_is_series.is_none() {
                    curve(plot, &curves.own.limit, &limit_name, theme::foreground(dark), dashed, 1.0);
                }
            }
            if settings.shown.share {
                for (i, curves) in curves.series.iter().enumerate() {
                    curve(plot, &curves.share, &tr!("specular share"), theme::series(i, dark).gamma_multiply(0.65), None, 1.0);
                }
                if curves.own_is_series.is_none() {
                    curve(plot, &curves.own.share, &tr!("specular share"), theme::foreground(dark).gamma_multiply(0.65), None, 1.0);
                }
            }
            for (i, pieces) in view.overlay.get().into_iter().flatten().enumerate() {
                curve(plot, pieces, &other_name, theme::series(i, dark), Some(LineStyle::dotted_loose()), 2.0);
            }
            for (i, pieces) in view.ghost.get().into_iter().flatten().enumerate() {
                curve(plot, pieces, &ghost_name, theme::series(i, dark).gamma_multiply(0.4), Some(LineStyle::dotted_dense()), 1.5);
            }
            for (i, (curves, marks)) in curves.series.iter().zip(&marks.series).enumerate() {
                let color = theme::series(i, dark);
                curve(plot, &curves.dolp, &marks.name, color, None, 2.0);
                marks_in(plot, &marks.dolp, &marks.name, color, dark);
            }
            if curves.own_is_series.is_none() {
                curve(plot, &curves.own.dolp, &own_name, theme::foreground(dark), None, 2.0);
            }
        });
    view.axes.listen(&response, &tr!("Plot: DoLP against θr"), ui);
    commands.extend(clicked_mask(&response, ui, document, |_, series| &series.dolp, |mark| Some(mark.quantity.value)));
}
