//! DoLP against θr: the model at every measured θi in its own colour, the points, the Fresnel limit, the last fit, and under it what
//! the model misses.

use crate::app::jobs::memo::Memo;
use crate::app::plots::axis;
use crate::app::plots::axis::{axis, decimal};
use crate::app::plots::{
    Axes, Following, KeyEntry, MASK_HINT, Range, clicked_mask, curve, marks_in, plot, ribbons_in, round_up, switching_key_line_ui,
};
use crate::app::shell::app::App;
use crate::app::shell::theme;
use crate::app::text::i18n::translated;
use crate::app::views::confidence_band::{BandKey, Ribbons, band_key, dolp_bands};
use crate::app::views::curves::{BrdfScale, CurveSet, Curves, MarkSet, Polyline, axis_values, drawn};
use crate::app::views::facets::{another, sigma_of_equal_median};
use crate::app::views::residuals;
use crate::app::views::residuals::Residuals;
use crate::app::work::document::Document;
use crate::app::work::settings::{Overlay, Settings};
use crate::app::work::workspace::Workspace;
use egui::{Color32, Ui};
use egui_plot::{AxisHints, HoverPosition, LineStyle};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution;
use std::collections::BTreeSet;
use tr::tr;

/// What the pane keeps.
#[derive(Default)]
pub struct DolpView {
    axes: Axes,
    range: Following,
    /// DoLP of the last fit along each series, where the sliders have left it.
    ghost: Memo<Option<SurfaceKey>, Vec<Polyline>>,
    /// DoLP with the other distribution.
    overlay: Memo<Option<SurfaceKey>, Vec<Polyline>>,
    /// One standard error around the last fit along each series.
    pub band: Memo<BandKey, Vec<Ribbons>>,
    pub residuals: Residuals,
    hidden: BTreeSet<Line>,
}

/// Another surface than the sliders', the generation of the document, whether the backscatter side is drawn.
type SurfaceKey = (Parameters, Model, u64, bool);
impl DolpView {
    /// Ends of the axis of DoLP.
    pub fn range(&self) -> Option<Range> {
        self.range.get()
    }

    /// Whether a measured series is drawn.
    pub fn shows(&self, series: usize) -> bool {
        !self.hidden.contains(&Line::Series(series))
    }

    /// Along how many series the last fit is drawn beside the sliders' curves.
    #[cfg(test)]
    pub fn ghosts(&self) -> usize {
        self.ghost.get().map_or(0, Vec::len)
    }
}

pub fn dolp_refresh(explorer: &mut App) {
    let App { work: Workspace { settings, document, shown_fit: last_fit, .. }, derived, views, dragging, .. } = explorer;
    derived.refresh_curves(settings, document);
    let (Some(curves), Some(key), Some(marks)) = (derived.curves.get(), derived.curves.key(), derived.marks.get()) else { return };
    let view = &mut views.dolp;

    let key_of = |parameters, model| (parameters, model, document.generation, key.backscatter);
    let of_sliders = key_of(settings.parameters, settings.model);
    let fitted = last_fit.as_ref().map(|fit| key_of(fit.report.parameters, fit.report.model));
    let ghost = fitted.filter(|key| *key != of_sliders);
    view.ghost.refresh(ghost, |key| along_series(key.as_ref(), document));
    let other = other_distribution(settings).map(|(parameters, model)| key_of(parameters, model));
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
fn along_series(key: Option<&SurfaceKey>, document: &Document) -> Vec<Polyline> {
    let Some(&(parameters, model, _, backscatter)) = key else { return Vec::new() };
    let Ok(surface) = Pbrdf::new(model, parameters) else { return Vec::new() };
    drawn(document).map(|series| Curves::new(&surface, series, backscatter, BrdfScale::default()).dolp).collect()
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

pub fn dolp_ui(explorer: &mut App, ui: &mut Ui) {
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
pub fn dolp_options_ui(explorer: &mut App, ui: &mut Ui) {
    let shown = &mut explorer.work.settings.shown;
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
    ui.checkbox(&mut explorer.work.settings.show_band, tr!("Confidence band"))
        .on_hover_text(tr!("One standard error of the fitted curve to either side"));
    ui.checkbox(&mut explorer.work.settings.show_limit, tr!("Fresnel limit"))
        .on_hover_text(tr!("DoLP without any depolarising term: no point can lie above it"));
    ui.checkbox(&mut explorer.work.settings.show_backscatter, tr!("Backscatter side"))
        .on_hover_text(tr!("Negative θr, also where nothing was measured"));
}

/// What can be hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Line {
    /// All of a measured series, by its number.
    Series(usize),
    /// All at the sliders' own θi.
    Own,
    Limit,
    Band,
    Ghost,
    /// The other distribution.
    Other,
    Share,
}

/// A curve as it is drawn.
struct Drawn<'a> {
    /// What it shows, and of which surface and angle: it is hidden with either.
    lines: [Line; 2],
    pieces: &'a Polyline,
    name: String,
    color: Color32,
    style: LineStyle,
    width: f32,
}

/// Names of what has one for all series.
struct Names {
    limit: String,
    ghost: String,
    other: String,
    share: String,
    own: String,
}

impl Names {
    fn new(settings: &Settings) -> Self {
        let other = match (another(settings.model.distribution), settings.shown.overlay) {
            (SlopeDistribution::Gauss, Overlay::EqualMedian) => tr!("Gauss, equal median slope"),
            (SlopeDistribution::Gauss, _) => tr!("Gauss, equal σ"),
            (SlopeDistribution::Cauchy, Overlay::EqualMedian) => tr!("Cauchy, equal median slope"),
            (SlopeDistribution::Cauchy, _) => tr!("Cauchy, equal σ"),
        };
        let own = tr!("θi = {}° (slider)", settings.theta_i);
        Self { limit: tr!("Fresnel limit"), ghost: tr!("last fit"), other, share: tr!("specular share"), own }
    }
}

/// The looks of a line: style, and width in points.
type Look = (LineStyle, f32);
const CURVE: Look = (LineStyle::Solid, 2.0);
const SHARE: Look = (LineStyle::Solid, 1.0);

fn limit_look() -> Look {
    (LineStyle::dashed_dense(), 1.0)
}

fn ghost_look() -> Look {
    (LineStyle::dotted_dense(), 1.5)
}

fn other_look() -> Look {
    (LineStyle::dotted_loose(), 2.0)
}

/// All curves from the back to the front; the last fit and the other distribution along each series.
fn in_layers<'a>(
    curves: &'a CurveSet,
    [ghost, overlay]: [&'a [Polyline]; 2],
    marks: &MarkSet,
    settings: &Settings,
    dark: bool,
) -> Vec<Drawn<'a>> {
    let names = Names::new(settings);
    let series = curves.series.iter().enumerate().map(|(i, curves)| (Line::Series(i), curves, theme::series(i, dark)));
    let own = curves.own_is_series.is_none().then_some((Line::Own, &curves.own, theme::foreground(dark)));
    let along: Vec<(Line, &Curves, Color32)> = series.chain(own).collect();
    let mut layers = Vec::new();
    let mut add = |lines, pieces, name: &str, color, (style, width): Look| {
        layers.push(Drawn { lines, pieces, name: name.to_owned(), color, style, width });
    };
    for &(of, curves, color) in along.iter().filter(|_| settings.show_limit) {
        add([Line::Limit, of], &curves.limit, &names.limit, color, limit_look());
    }
    for &(of, curves, color) in along.iter().filter(|_| settings.shown.share) {
        add([Line::Share, of], &curves.share, &names.share, color.gamma_multiply(0.65), SHARE);
    }
    for (i, pieces) in overlay.iter().enumerate() {
        add([Line::Other, Line::Series(i)], pieces, &names.other, theme::series(i, dark), other_look());
    }
    for (i, pieces) in ghost.iter().enumerate() {
        add([Line::Ghost, Line::Series(i)], pieces, &names.ghost, theme::series(i, dark).gamma_multiply(0.4), ghost_look());
    }
    for &(of, curves, color) in &along {
        let name = if let Line::Series(i) = of { marks.series.get(i).map_or("", |marks| &marks.name) } else { &names.own };
        add([of, of], &curves.dolp, name, color, CURVE);
    }
    layers
}

/// What the lines mean. The entries do not depend on where the sliders stand, so that the plot keeps its height while one moves.
fn key_entries(view: &DolpView, marks: &MarkSet, settings: &Settings, is_fitted: bool, dark: bool) -> Vec<(Line, KeyEntry)> {
    let names = Names::new(settings);
    let (ink, quiet) = (theme::foreground(dark), theme::muted(dark));
    let series = marks.series.iter().enumerate();
    let series = series.map(|(i, marks)| (Line::Series(i), marks.name.clone(), theme::series(i, dark), CURVE));
    let band = (Line::Band, tr!("± 1 standard error"), quiet.gamma_multiply(0.5), (LineStyle::Solid, BAND));
    let others = [
        (true, (Line::Own, names.own, ink, CURVE)),
        (settings.show_limit, (Line::Limit, names.limit, quiet, limit_look())),
        (is_fitted && settings.show_band, band),
        (is_fitted, (Line::Ghost, names.ghost, quiet, ghost_look())),
        (view.overlay.get().is_some_and(|overlay| !overlay.is_empty()), (Line::Other, names.other, quiet, other_look())),
        (settings.shown.share, (Line::Share, names.share, quiet, SHARE)),
    ];
    let others = others.into_iter().filter(|(is_shown, _)| *is_shown).map(|(_, entry)| entry);
    series.chain(others).map(|(line, name, color, (style, width))| (line, KeyEntry { name, color, style, width })).collect()
}

/// Width of the sample of a band, in points.
const BAND: f32 = 8.0;

fn curves_ui(explorer: &mut App, ui: &mut Ui, height: f32) {
    let App { work: Workspace { settings, document, shown_fit: last_fit, .. }, derived, views, commands, .. } = explorer;
    let (Some(curves), Some(key), Some(marks)) = (derived.curves.get(), derived.curves.key(), derived.marks.get()) else { return };
    let view = &mut views.dolp;
    let dark = ui.visuals().dark_mode;
    let entries = key_entries(view, marks, settings, last_fit.is_some(), dark);
    let top = ui.cursor().top();
    switching_key_line_ui(&entries, &mut view.hidden, ui);
    let height = height - (ui.cursor().top() - top);
    let others = [&view.ghost, &view.overlay].map(|along| along.get().map_or(&[][..], Vec::as_slice));
    let layers = in_layers(curves, others, marks, settings, dark);
    let x = axis(AxisHints::new_x(), ui, "θr / °", decimal).min_thickness(40.0);
    let y = axis(AxisHints::new_y(), ui, "DoLP", decimal);
    let response = plot("dolp", ui, height, x, y)
        .y_grid_spacer(|input| axis::marks(&input, 5.0, 0.0))
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                Some(format!("{plot_name}\nθr = {:.2}°\nDoLP = {:.5}\n{}", position.x, position.y, translated(MASK_HINT)))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            view.axes.apply(plot, Some(key.x()), view.range.get());
            let is_shown = |line: Line| !view.hidden.contains(&line);
            for (i, ribbons) in view.band.get().into_iter().flatten().enumerate() {
                if is_shown(Line::Band) && is_shown(Line::Series(i)) {
                    ribbons_in(plot, ribbons, theme::series(i, dark));
                }
            }
            for Drawn { lines, pieces, name, color, style, width } in &layers {
                if lines.iter().all(|line| is_shown(*line)) {
                    curve(plot, pieces, name, *color, Some(*style), *width);
                }
                if let Line::Series(i) = lines[0]
                    && let Some(marks) = marks.series.get(i).filter(|_| is_shown(lines[0]))
                {
                    marks_in(plot, &marks.dolp, name, *color, dark);
                }
            }
        });
    view.axes.listen(&response, &tr!("Plot: DoLP against θr"), ui);
    let hidden = &view.hidden;
    // What is not drawn cannot be meant.
    let mask = clicked_mask(
        &response,
        ui,
        document,
        |i, series| if hidden.contains(&Line::Series(i)) { &[] } else { &series.dolp },
        |mark| Some(mark.quantity.value),
    );
    commands.extend(mask);
}
