//! BRDF against θr: total and each term at the sliders' θi, and the measured values with the model's total.

use crate::app::jobs::memo::Memo;
use crate::app::plots::axis;
use crate::app::plots::axis::{axis, decimal, power_of_ten};
use crate::app::plots::{
    Axes, Following, KeyEntry, MASK_HINT, Range, clicked_mask, curve, filled, marks_in, plot, ribbons_in, round_up, switching_key_line_ui,
};
use crate::app::shell::app::App;
use crate::app::shell::theme;
use crate::app::text::i18n::translated;
use crate::app::views::confidence_band::{BandKey, Ribbons, band_key, brdf_bands};
use crate::app::views::curves::{BrdfScale, Curves, DECADES, MarkSet, Polyline, axis_values};
use crate::app::work::workspace::Workspace;
use egui::{Color32, Ui};
use egui_plot::{AxisHints, HoverPosition, LineStyle};
use std::collections::BTreeSet;
use tr::tr;

/// What the pane keeps.
#[derive(Default)]
pub struct LobesView {
    axes: Axes,
    range: Following,
    /// One standard error around the last fit along each series.
    pub band: Memo<BandKey, Vec<Ribbons>>,
    /// The curves that are not drawn.
    hidden: BTreeSet<Line>,
}

/// A curve of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Line {
    /// A measured series by its number, with its points.
    Series(usize),
    Specular,
    Diffuse,
    Volume,
    Total,
}

impl LobesView {
    /// Ends of the axis of BRDF, in the coordinates of the plot.
    pub fn range(&self) -> Option<Range> {
        self.range.get()
    }
}

pub fn lobes_refresh(explorer: &mut App) {
    let App { work: Workspace { settings, document, shown_fit: last_fit, .. }, derived, views, dragging, .. } = explorer;
    derived.refresh_curves(settings, document);
    let (Some(curves), Some(key), Some(marks)) = (derived.curves.get(), derived.curves.key(), derived.marks.get()) else { return };
    let measured = curves.series.iter().zip(&marks.series).filter(|(_, marks)| marks.brdf.is_there()).map(|(curves, _)| curves);
    let of_curves = measured.chain([&curves.own]).flat_map(|curves| axis_values(&curves.total));
    let of_marks = marks.series.iter().flat_map(|marks| marks.brdf.used.iter().map(|point| point.y));
    let (mut bottom, mut top) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in of_curves.chain(of_marks) {
        (bottom, top) = (bottom.min(value), top.max(value));
    }
    let wanted = if settings.log_brdf {
        let high = if top.is_finite() { (top + 0.1).ceil() } else { 1.0 };
        Range { low: bottom.floor().clamp(high - DECADES, high - 1.0), high }
    } else {
        Range { low: 0.0, high: round_up(top) }
    };
    views.lobes.range.follow(wanted, *dragging);
    // Where no BRDF was measured there is no fitted lobe.
    let shown = settings.show_band && document.measurement.has_brdf();
    let fit = last_fit.as_deref();
    let band_key = band_key(fit, document, key.backscatter, BrdfScale::new(settings), shown);
    views.lobes.band.refresh(band_key, |key| match (key, fit) {
        (Some((_, _, backscatter, scale)), Some(fit)) => brdf_bands(&fit.report, document, *backscatter, *scale),
        _ => Vec::new(),
    });
}

/// What is drawn in the pane.
pub fn lobes_options_ui(explorer: &mut App, ui: &mut Ui) {
    ui.checkbox(&mut explorer.work.settings.log_brdf, tr!("Logarithmic BRDF"));
    ui.checkbox(&mut explorer.work.settings.shown.filled, tr!("Filled lobes")).on_hover_text(tr!("Each term filled down to the axis"));
    ui.checkbox(&mut explorer.work.settings.shown.times_cosine, tr!("Times cos θr"))
        .on_hover_text(tr!("BRDF × cos θr: its integral over all directions is the reflectance"));
    ui.checkbox(&mut explorer.work.settings.show_band, tr!("Confidence band"))
        .on_hover_text(tr!("One standard error of the fitted curve to either side"));
    ui.checkbox(&mut explorer.work.settings.show_backscatter, tr!("Backscatter side"))
        .on_hover_text(tr!("Negative θr, also where nothing was measured"));
}

/// A curve at the sliders' own θi.
struct Term<'a> {
    line: Line,
    pieces: &'a Polyline,
    name: String,
    color: Color32,
    width: f32,
}

/// Width of the line of a term, and of that of all together.
const PART: f32 = 1.5;
const TOTAL: f32 = 2.5;

/// The terms that the model has, and last their sum.
fn terms(own: &Curves, dark: bool) -> Vec<Term<'_>> {
    let terms = [
        Term { line: Line::Specular, pieces: &own.specular, name: tr!("specular"), color: theme::specular(dark), width: PART },
        Term { line: Line::Diffuse, pieces: &own.diffuse, name: tr!("diffuse"), color: theme::diffuse(dark), width: PART },
        Term { line: Line::Volume, pieces: &own.volume, name: tr!("volume"), color: theme::volume(dark), width: PART },
        Term { line: Line::Total, pieces: &own.total, name: tr!("total"), color: theme::foreground(dark), width: TOTAL },
    ];
    terms.into_iter().filter(|term| !term.pieces.is_empty()).collect()
}

/// The measured series, then the terms.
fn key_entries(marks: &MarkSet, terms: &[Term<'_>], dark: bool) -> Vec<(Line, KeyEntry)> {
    let entry = |line, name: &str, color, width| (line, KeyEntry { name: name.to_owned(), color, style: LineStyle::Solid, width });
    let measured = marks.series.iter().enumerate().filter(|(_, marks)| marks.brdf.is_there());
    let measured = measured.map(|(i, marks)| entry(Line::Series(i), &marks.name, theme::series(i, dark), PART));
    measured.chain(terms.iter().map(|term| entry(term.line, &term.name, term.color, term.width))).collect()
}

pub fn lobes_ui(explorer: &mut App, ui: &mut Ui) {
    let App { work: Workspace { settings, document, .. }, derived, views, commands, .. } = explorer;
    let (Some(curves), Some(key), Some(marks)) = (derived.curves.get(), derived.curves.key(), derived.marks.get()) else { return };
    let view = &mut views.lobes;
    let dark = ui.visuals().dark_mode;
    let log = settings.log_brdf;
    let scale = BrdfScale::new(settings);
    let title = tr!("θr / °  at θi = {0}°, Δφ = {1}°", settings.theta_i, settings.dphi);
    let x = axis(AxisHints::new_x(), ui, &title, decimal).min_thickness(40.0);
    let times_cosine = settings.shown.times_cosine;
    let quantity = if times_cosine { "BRDF × cos θr" } else { "BRDF" };
    let y = axis(AxisHints::new_y(), ui, &format!("{quantity} / (1/sr)"), if log { power_of_ten } else { decimal });
    let terms = terms(&curves.own, dark);
    switching_key_line_ui(&key_entries(marks, &terms, dark), &mut view.hidden, ui);
    let response = plot("lobes", ui, ui.available_height(), x, y)
        .y_grid_spacer(move |input| axis::marks(&input, 5.0, if log { 1.0 } else { 0.0 }))
        .label_formatter(move |hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                let brdf = if log { libm::exp10(position.y) } else { position.y };
                Some(format!("{plot_name}\nθr = {:.2}°\n{quantity} = {brdf:.4e} 1/sr\n{}", position.x, translated(MASK_HINT)))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            view.axes.apply(plot, Some(key.x()), view.range.get());
            for (i, (curves, marks)) in curves.series.iter().zip(&marks.series).enumerate() {
                if marks.brdf.is_there() && !view.hidden.contains(&Line::Series(i)) {
                    let color = theme::series(i, dark);
                    if let Some(ribbons) = view.band.get().and_then(|bands| bands.get(i)) {
                        ribbons_in(plot, ribbons, color);
                    }
                    curve(plot, &curves.total, &marks.name, color, None, 1.5);
                    marks_in(plot, &marks.brdf, &marks.name, color, dark);
                }
            }
            let floor = if log { view.range.get().map_or(0.0, |range| range.low) } else { 0.0 };
            for Term { pieces, name, color, width, .. } in terms.iter().filter(|term| !view.hidden.contains(&term.line)) {
                if settings.shown.filled && *width < TOTAL {
                    filled(plot, pieces, name, *color, floor);
                } else {
                    curve(plot, pieces, name, *color, None, *width);
                }
            }
        });
    view.axes.listen(&response, &tr!("Plot: BRDF against θr"), ui);
    commands.extend(clicked_mask(
        &response,
        ui,
        document,
        // What is not drawn cannot be meant.
        |i, series| if view.hidden.contains(&Line::Series(i)) { &[] } else { &series.brdf },
        |mark| scale.coordinate(mark.theta_r, mark.quantity.value),
    ));
}
