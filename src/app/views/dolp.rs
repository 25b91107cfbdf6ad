//! DoLP against θr: the model at every measured θi in its own colour, the points, the Fresnel
//! limit, other measurements and pinned surfaces, and under it what the model misses.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::FOREGROUND;
use crate::app::plots::{
    AutoRange, FigurePlot, KeyEntry, PanelPlace, PanelStyle, Polyline, Range, nice_ceiling, switching_key_line_ui, theme,
};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::views::companions::{CompanionId, Look};
use crate::app::views::confidence_band::{Band, BandKey, band_key, band_name, dolp_bands};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::{CurveKey, CurveSet, MarkSet, ModelCurves, axis_values, drawn, figure_title};
use crate::app::views::picking::{clicked_mask, mask_hint};
use crate::app::views::pointing::{mark, note_theta_r};
use crate::app::views::posterior_band::{self, BandQuantity, PosteriorBands};
use crate::app::views::residuals::{ResidualStrip, above_strip};
use crate::app::views::series_choice::series_choice_ui;
use crate::app::work::edit::Switch;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::settings::{Overlay, Settings, ViewOptions};
use crate::app::work::surface::{another, sigma_of_equal_median};
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Dash, Figure, Panel, Rgb, Series};
use egui::{Key, Ui};
use egui_plot::LineStyle;
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution;
use std::collections::BTreeSet;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "DoLP",
    tooltip: "Degree of linear polarisation against the angle of view, Eq. (17), with the measured points and what the model misses; Ctrl+click masks a point",
    shortcut: Some(Key::Num1),
    has_options: true,
    has_figure: true,
    new: || Box::new(DolpView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct DolpView {
    range: AutoRange,
    /// DoLP with the other distribution.
    overlay: Memo<Option<SurfaceKey>, Vec<Polyline>>,
    /// One standard error around the last fit along each series.
    pub band: Memo<BandKey, Vec<Band>>,
    /// Around draws from the posterior.
    draws: PosteriorBands,
    pub residuals: ResidualStrip,
    plot: FigurePlot<FigureKey>,
    hidden: BTreeSet<Line>,
    /// The measurement whose series are hidden.
    hidden_of: u64,
}

/// What the figure depends on: curves, points, other distribution, bands and companions, each
/// by its stamp; what is shown and what hidden; the axis; the picked pixel; the language.
type FigureKey = ([u64; 6], ViewOptions, bool, BTreeSet<Line>, Option<Range>, Option<f64>, Language);

/// Another surface than the sliders', the state of the document, whether the backscatter side
/// is drawn.
type SurfaceKey = (Parameters, Model, u64, bool);

impl DolpView {
    /// Ends of the axis of DoLP.
    #[cfg(test)]
    pub fn range(&self) -> Option<Range> {
        self.range.get()
    }

    /// The parts of θr that the plot and the strip under it show.
    #[cfg(test)]
    pub fn seen(&self) -> [Option<Range>; 2] {
        [self.plot.seen_x(), self.residuals.seen_x()]
    }

    fn shows(&self, line: Line) -> bool {
        !self.hidden.contains(&line)
    }

    /// ModelCurves of other surfaces than the sliders', and the band.
    fn refresh_others(&mut self, cx: &Cx<'_>, backscatter: bool) {
        let (settings, document) = (cx.work.settings(), cx.work.active());
        let key_of = |parameters, model| (parameters, model, document.plotted, backscatter);
        let other = other_distribution(cx.work).map(|(parameters, model)| key_of(parameters, model));
        self.overlay.refresh(other, |key| along_series(key.as_ref(), document));
        let fit = cx.work.shown_fit().map(|fit| &**fit);
        self.band.refresh(band_key(fit, document, backscatter, false, settings.show_band), |key| match (key, fit) {
            (Some((_, _, backscatter, _)), Some(fit)) => dolp_bands(&fit.report, document, *backscatter),
            _ => Vec::new(),
        });
        self.draws.refresh(cx, backscatter, BandQuantity::Dolp, true);
    }

    /// The axis, up to the highest curve or point. The Fresnel limit may run out of it: of metals with
    /// little polarisation it is ten times as high.
    fn follow(&mut self, curves: &CurveSet, marks: &MarkSet, cx: &Cx<'_>) {
        let limit = cx.work.settings().show_limit;
        let values = curves.all().flat_map(|curves| axis_values(&curves.dolp));
        let points = marks.series.iter().flat_map(|marks| &marks.dolp.used).map(|point| point.bar.map_or(point.y, |bar| bar.1));
        let companions = || cx.derived.companions.iter().map(|companion| companion.drawn);
        let others = companions().flat_map(|drawn| &drawn.dolp_points).map(|point| point.bar.map_or(point.y, |bar| bar.1));
        let others = others.chain(companions().flat_map(|drawn| axis_values(&drawn.dolp)));
        let top = values.chain(points).chain(others).fold(0.0, f64::max);
        let limits = curves.all().filter(|_| limit).flat_map(|curves| axis_values(&curves.limit));
        let top = top.max(limits.fold(0.0, f64::max).min(ROOM_FOR_LIMIT * top));
        let high = if cx.work.settings().view_options.share { 1.05 } else { nice_ceiling(top).min(1.05) };
        self.range.follow(Range { low: 0.0, high }, cx.interacting);
    }

    fn describe(&self, curves: &CurveSet, key: &CurveKey, marks: &MarkSet, cx: &Cx<'_>) -> Figure {
        let names = Names::new(cx.work);
        let mut series = Vec::new();
        let marker = cx.work.active().style.marker;
        for companion in cx.derived.companions.iter().filter(|companion| self.shows(Line::Companion(companion.id))) {
            series.extend(companion.dolp());
        }
        for (i, (curves, marks)) in curves.series.iter().zip(&marks.series).enumerate() {
            if !self.shows(Line::Series(marks.index)) {
                continue;
            }
            let color = marks.ink;
            let of_series = |along: &Memo<Option<SurfaceKey>, Vec<Polyline>>| along.get().and_then(|curves| curves.get(i)).cloned();
            self.push_limit(&mut series, curves, &names, color, cx.work.settings());
            if self.shows(Line::Draws) {
                series.extend(self.draws.series(i, color));
            }
            if let Some(band) = self.band.get().and_then(|bands| bands.get(i)).filter(|_| self.shows(Line::Band)) {
                series.push(Series::band(band_name(cx.work, &marks.name), band.clone()).colored(color));
            }
            if let Some(curve) = of_series(&self.overlay).filter(|_| self.shows(Line::Other)) {
                series.push(Series::stroke(&names.other, curve, 1.2, Dash::Sparse).colored(color));
            }
            series.push(Series::line(&marks.name, curves.dolp.clone()).colored(color));
            series.extend(marks.dolp.series(&marks.name, color, marker));
            self.push_share(&mut series, curves, &names, color, cx.work.settings());
        }
        if curves.own_is_series.is_none() && self.shows(Line::Own) {
            self.push_limit(&mut series, &curves.own, &names, FOREGROUND, cx.work.settings());
            self.push_share(&mut series, &curves.own, &names, FOREGROUND, cx.work.settings());
            series.push(Series::line(&names.own, curves.own.dolp.clone()).colored(FOREGROUND));
        }
        let picked = cx.derived.picked_theta_r(cx.work).zip(self.range.get());
        series.extend(picked.map(|(theta_r, range)| mark(theta_r, range.low, range.high)));
        let (x, y) = (key.x().on(Axis::linear("θr", "°")), self.range.on(Axis::linear("DoLP", "")));
        Figure { title: figure_title(cx.work), panels: vec![Panel { x, y, series, ..Panel::default() }], ..Figure::default() }
    }

    fn push_limit(&self, series: &mut Vec<Series>, curves: &ModelCurves, names: &Names, color: Rgb, settings: &Settings) {
        if settings.show_limit && self.shows(Line::Limit) && !curves.limit.is_empty() {
            series.push(Series::dashed(&names.limit, curves.limit.clone(), Dash::Dashed).colored(color));
        }
    }

    fn push_share(&self, series: &mut Vec<Series>, curves: &ModelCurves, names: &Names, color: Rgb, settings: &Settings) {
        if settings.view_options.share && self.shows(Line::Share) && !curves.share.is_empty() {
            series.push(Series::stroke(&names.share, curves.share.clone(), 0.6, Dash::Solid).colored(color).faded(SHARE));
        }
    }
}

/// Opacity of the specular share.
const SHARE: f64 = 0.65;

impl View for DolpView {
    fn needs_curves(&self) -> bool {
        true
    }

    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let derived = cx.derived;
        let (Some(curves), Some(key), Some(marks)) = (derived.curves.get(), derived.curves.key(), derived.marks.get()) else { return };
        let number = cx.work.active().number;
        if std::mem::replace(&mut self.hidden_of, number) != number {
            self.hidden.retain(|line| !matches!(line, Line::Series(_)));
        }
        self.refresh_others(cx, key.backscatter);
        self.follow(curves, marks, cx);
        let [curve_stamp, mark_stamp, companion_stamp] = [derived.curves.stamp(), derived.marks.stamp(), derived.companions.stamp()];
        let stamps = [curve_stamp, mark_stamp, self.overlay.stamp(), self.band.stamp(), self.draws.stamp(), companion_stamp];
        let figure_key = (
            stamps,
            cx.work.settings().view_options,
            cx.work.settings().show_limit,
            self.hidden.clone(),
            self.range.get(),
            derived.picked_theta_r(cx.work),
            i18n::current(),
        );
        let mut plot = std::mem::take(&mut self.plot);
        plot.refresh(figure_key, |_| Some(self.describe(curves, key, marks, cx)));
        self.plot = plot;
        // Where the user has moved the plot, the strip follows.
        let x = self.plot.moved_x().unwrap_or(key.x());
        let hidden: Vec<bool> = marks.series.iter().map(|marks| !self.shows(Line::Series(marks.index))).collect();
        let companions = derived.companions.iter().filter(|companion| self.shows(Line::Companion(companion.id)));
        self.residuals.refresh((x, String::new()), marks, hidden, &companions.collect::<Vec<_>>(), cx);
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let strip = self.residuals.height(ui);
        let (height, place) = above_strip(ui, strip);
        self.curves_ui(cx, ui, height, place);
        self.residuals.ui(ui, strip);
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        series_choice_ui(cx.work.active(), cx.edits, ui);
        cx.view_options_ui(|shown| {
            ui.checkbox(&mut shown.share, tr!("Specular share"))
                .on_hover_text(tr!("Specular part of the radiance, 0 to 1: DoLP is the Fresnel limit times this share"));
            ui.separator();
            ui.label(tr!("The other distribution"));
            for (overlay, name, help) in [
                (Overlay::Absent, tr!("not shown"), tr!("Only the distribution of the model")),
                (
                    Overlay::EqualSigma,
                    tr!("with equal σ"),
                    tr!("The same σ, which is not the same width: compare shapes with equal median slope"),
                ),
                (Overlay::EqualMedian, tr!("with equal median slope"), tr!("σ such that half of the facets stay below the same slope")),
            ] {
                ui.radio_value(&mut shown.overlay, overlay, name).on_hover_text(help);
            }
        });
        ui.separator();
        cx.switch_ui(Switch::Band, tr!("Confidence band"), ui).on_hover_text(tr!("One standard error of the fitted curve to either side"));
        cx.switch_ui(Switch::Limit, tr!("Fresnel limit"), ui)
            .on_hover_text(tr!("DoLP without any depolarising term: no curve of this n and k can lie above it; a point that does says that n and k, or the data, are wrong"));
        cx.switch_ui(Switch::Backscatter, tr!("Backscatter side"), ui).on_hover_text(tr!("Negative θr, also where nothing was measured"));
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}

impl DolpView {
    fn curves_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui, height: f32, place: PanelPlace) {
        let Some(marks) = cx.derived.marks.get() else { return };
        // The curve of a measured series is that of the sliders where both have one θi.
        let series = cx.derived.curves.get().and_then(|curves| marks.series.get(curves.own_is_series?));
        let own_ink = series.map_or(FOREGROUND, |series| series.ink);
        let entries = self.key_entries(marks, own_ink, cx, ui.visuals().dark_mode);
        let top = ui.cursor().top();
        switching_key_line_ui(&entries, &mut self.hidden, ui);
        let height = height - (ui.cursor().top() - top);
        let hint = mask_hint(cx.work.active());
        let hover = |name: &str, x: f64, y: f64| format!("{name}\nθr = {x:.2}°\nDoLP = {y:.5}{hint}");
        let style = PanelStyle { place, ..PanelStyle::new("dolp", height, &hover) }.named(tr!("Plot: DoLP against θr"));
        let Some(response) = self.plot.panel(0).and_then(|panel| panel.ui(&style, ui)) else { return };
        note_theta_r(&response, ui);
        // What is not drawn cannot be meant.
        let mask = clicked_mask(
            &response,
            ui,
            cx.work.active(),
            |i, series| if self.shows(Line::Series(i)) { &series.dolp } else { &[] },
            |mark| Some(mark.quantity.value),
        );
        cx.edits.extend(mask);
    }

    /// What the lines mean. The entries do not depend on where the sliders stand, so that the plot
    /// keeps its height while one moves.
    fn key_entries(&self, marks: &MarkSet, own_ink: Rgb, cx: &Cx<'_>, dark: bool) -> Vec<(Line, KeyEntry)> {
        let (work, companions) = (cx.work, &cx.derived.companions);
        let (names, settings, is_fitted) = (Names::new(work), work.settings(), work.shown_fit().is_some());
        let (own_ink, quiet) = (theme::on_screen(own_ink, dark), theme::muted(dark));
        let curve = (LineStyle::Solid, 2.0);
        let series = marks.series.iter();
        let series = series.map(|marks| (Line::Series(marks.index), marks.name.clone(), theme::on_screen(marks.ink, dark), curve));
        let band = (Line::Band, tr!("± 1 standard error"), quiet.gamma_multiply(0.5), (LineStyle::Solid, BAND));
        let is_overlaid = self.overlay.get().is_some_and(|overlay| !overlay.is_empty());
        let others = [
            (true, (Line::Own, names.own, own_ink, curve)),
            (settings.show_limit, (Line::Limit, names.limit, quiet, (LineStyle::dashed_dense(), 1.0))),
            (is_fitted && settings.show_band, band),
            (self.draws.is_there(), (Line::Draws, posterior_band::band_name(), quiet.gamma_multiply(0.8), (LineStyle::Solid, BAND))),
            (is_overlaid, (Line::Other, names.other, quiet, (LineStyle::dotted_loose(), 2.0))),
            (settings.view_options.share, (Line::Share, names.share, quiet, (LineStyle::Solid, 1.0))),
        ];
        let others = others.into_iter().filter(|(is_shown, _)| *is_shown).map(|(_, entry)| entry);
        let lines = series.chain(others);
        let lines =
            lines.map(|(line, name, color, (style, width))| (line, KeyEntry { name, color, style, width, symbol: None, on_map: false }));
        let ghost = is_fitted.then(|| (Line::Companion(CompanionId::LastFit), Look::last_fit().key_entry(dark)));
        let companions = companions.iter().filter(|companion| companion.id != CompanionId::LastFit);
        let companions = companions.map(|companion| (Line::Companion(companion.id), companion.key_entry(dark)));
        lines.chain(ghost).chain(companions).collect()
    }
}

/// DoLP of a surface along each series.
fn along_series(key: Option<&SurfaceKey>, document: &OpenMeasurement) -> Vec<Polyline> {
    let Some(&(parameters, model, _, backscatter)) = key else { return Vec::new() };
    let Ok(surface) = Pbrdf::new(model, parameters) else { return Vec::new() };
    drawn(document).map(|series| ModelCurves::new(&surface, series, backscatter, false).dolp).collect()
}

/// The sliders' surface with Gauss in the place of Cauchy or the other way round, if that is asked
/// for.
fn other_distribution(work: &Workspace) -> Option<(Parameters, Model)> {
    let (surface, shown) = (work.surface(), work.settings().view_options);
    let (model, mut parameters) = (surface.model, surface.parameters);
    let other = another(model.distribution);
    match shown.overlay {
        _ if !model.specular => return None,
        Overlay::Absent => return None,
        Overlay::EqualSigma => {}
        Overlay::EqualMedian => parameters.sigma = sigma_of_equal_median(model.distribution, parameters.sigma, parameters.q),
    }
    Some((parameters, Model { distribution: other, ..model }))
}

/// How high the Fresnel limit may raise the axis, over the highest of all else.
const ROOM_FOR_LIMIT: f64 = 1.25;

/// What can be hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Line {
    /// All of a measured series, by its place in the measurement.
    Series(usize),
    Companion(CompanionId),
    /// All at the sliders' own θi.
    Own,
    Limit,
    Band,
    /// Bands of draws from the posterior.
    Draws,
    /// The other distribution.
    Other,
    Share,
}

/// Names of what has one for all series.
struct Names {
    limit: String,
    other: String,
    share: String,
    own: String,
}

impl Names {
    fn new(work: &Workspace) -> Self {
        let settings = work.settings();
        let other = match (another(work.surface().model.distribution), settings.view_options.overlay) {
            (SlopeDistribution::Gauss, Overlay::EqualMedian) => tr!("Gauss, equal median slope"),
            (SlopeDistribution::Gauss, _) => tr!("Gauss, equal σ"),
            (SlopeDistribution::Cauchy, Overlay::EqualMedian) => tr!("Cauchy, equal median slope"),
            (SlopeDistribution::Cauchy, _) => tr!("Cauchy, equal σ"),
        };
        let own = tr!("θi = {}° (slider)", settings.theta_i);
        Self { limit: tr!("Fresnel limit"), other, share: tr!("specular share"), own }
    }
}

/// Width of the sample of a band, in points.
const BAND: f32 = 8.0;
