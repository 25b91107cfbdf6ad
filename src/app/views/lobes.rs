//! BRDF against θr: total and each term at the sliders' θi, and the measured values with the
//! model's total.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::FOREGROUND;
use crate::app::plots::{AutoRange, FigurePlot, KeyEntry, PanelPlace, PanelStyle, Range, nice_ceiling, switching_key_line_ui, theme};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::views::companions::{Companion, CompanionId, Companions};
use crate::app::views::confidence_band::{Band, BandKey, band_key, band_name, brdf_bands};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::{CurveKey, CurveSet, DECADES, MarkSet, Term, axis_values, drawn_brdf};
use crate::app::views::picking::{clicked_mask, mask_hint};
use crate::app::views::pointing::{mark, note_theta_r};
use crate::app::views::posterior_band::{self, BandQuantity, PosteriorBands};
use crate::app::views::residuals::{ResidualQuantity, ResidualStrip, above_strip};
use crate::app::views::series_choice::series_choice_ui;
use crate::app::work::edit::Switch;
use crate::app::work::settings::{Settings, ViewOptions};
use crate::figure::{Axis, Dash, Figure, Panel, Series};
use egui::{Key, Ui};
use egui_plot::LineStyle;
use std::collections::BTreeSet;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Lobes",
    tooltip: "BRDF against the angle of view: specular, diffuse and volume lobe and their sum, Eq. (14)",
    shortcut: Some(Key::Num2),
    has_options: true,
    has_figure: true,
    new: || Box::new(LobesView { residuals: ResidualStrip::new(ResidualQuantity::Brdf), ..LobesView::default() }),
};

/// What the pane keeps.
#[derive(Default)]
pub struct LobesView {
    /// Of the axis of BRDF, in logarithms where that is logarithmic.
    range: AutoRange,
    /// One standard error around the last fit along each series.
    pub band: Memo<BandKey, Vec<Band>>,
    /// Around draws from the posterior.
    draws: PosteriorBands,
    residuals: ResidualStrip,
    plot: FigurePlot<FigureKey>,
    /// The curves that are not drawn.
    hidden: BTreeSet<Line>,
    /// The measurement whose series are hidden.
    hidden_of: u64,
}

/// What the figure depends on: curves, points, bands and companions by their stamps; what is shown and what
/// hidden; the axis; the language.
type FigureKey = ([u64; 5], ViewOptions, bool, BTreeSet<Line>, Option<Range>, Option<f64>, Language);

/// A curve of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Line {
    /// A measured series by its place in the measurement, with its points.
    Series(usize),
    Companion(CompanionId),
    Term(Term),
    Total,
    /// Bands of draws from the posterior.
    Draws,
}

/// Width of the sample of a band.
const BAND: f32 = 8.0;
/// Widths of the lines of terms and of their sum, the latter also under another line, in points of paper.
const TERM: f64 = 0.9;
const TOTAL: f64 = 1.2;
const UNDER: f64 = 3.0;

impl LobesView {
    /// Ends of the axis of BRDF, in the coordinates of the plot.
    #[cfg(test)]
    pub fn range(&self) -> Option<Range> {
        self.range.get()
    }

    fn shows(&self, line: Line) -> bool {
        !self.hidden.contains(&line)
    }

    /// The axis, over curves and points.
    fn follow(&mut self, curves: &CurveSet, marks: &MarkSet, cx: &Cx<'_>) {
        let measured = curves.series.iter().zip(&marks.series).filter(|(_, marks)| !marks.brdf.is_empty()).map(|(curves, _)| curves);
        let of_curves = measured.chain([&curves.own]).flat_map(|curves| axis_values(&curves.total));
        let companions = || cx.derived.companions.iter().map(|companion| companion.drawn);
        let others = companions().flat_map(|drawn| drawn.brdf_points.iter().map(|point| point.y));
        let others = others.chain(companions().flat_map(|drawn| axis_values(&drawn.brdf)));
        let of_marks = marks.series.iter().flat_map(|marks| marks.brdf.used.iter().map(|point| point.y)).chain(others);
        let log = cx.work.settings().log_brdf;
        let (mut bottom, mut top) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in of_curves.chain(of_marks).map(|value| if log { libm::log10(value) } else { value }).filter(|value| value.is_finite()) {
            (bottom, top) = (bottom.min(value), top.max(value));
        }
        let wanted = if log {
            let high = if top.is_finite() { (top + 0.1).ceil() } else { 1.0 };
            Range { low: bottom.floor().clamp(high - DECADES, high - 1.0), high }
        } else {
            Range { low: 0.0, high: nice_ceiling(top) }
        };
        self.range.follow(wanted, cx.interacting);
    }

    fn describe(&self, curves: &CurveSet, key: &CurveKey, marks: &MarkSet, cx: &Cx<'_>) -> Option<Figure> {
        let settings = cx.work.settings();
        let range = self.range.get()?;
        let (quantity, unit) = (quantity(settings.view_options.times_cosine), "sr⁻¹");
        let y = if settings.log_brdf {
            Axis::log(quantity, unit).between(libm::exp10(range.low), libm::exp10(range.high))
        } else {
            range.on(Axis::linear(quantity, unit))
        };
        let mut series = Vec::new();
        let marker = cx.work.active().style.marker;
        for companion in cx.derived.companions.iter().filter(|companion| self.shows(Line::Companion(companion.id))) {
            series.extend(companion.brdf());
        }
        for (term, curve) in curves.own.terms().filter(|(term, _)| self.shows(Line::Term(*term))) {
            if settings.view_options.filled {
                let floor = y.range.map_or(0.0, |(low, _)| low);
                series.push(Series::band(term.name(), curve.iter().map(|[x, y]| [*x, floor, *y]).collect()).colored(term.ink()));
            }
            series.push(Series::stroke(term.name(), curve.clone(), TERM, Dash::Solid).colored(term.ink()));
        }
        if self.shows(Line::Total) {
            // Seen at either side of the curve of a series that has the sliders' θi.
            let is_series = curves.own_is_series.and_then(|place| marks.series.get(place));
            let is_under = is_series.is_some_and(|marks| !marks.brdf.is_empty() && self.shows(Line::Series(marks.index)));
            let width = if is_under { UNDER } else { TOTAL };
            series.push(Series::stroke(tr!("total"), curves.own.total.clone(), width, Dash::Solid).colored(FOREGROUND));
        }
        let all = curves.series.iter().zip(&marks.series).enumerate();
        for (i, (curves, marks)) in all.filter(|(_, (_, marks))| !marks.brdf.is_empty() && self.shows(Line::Series(marks.index))) {
            let color = marks.ink;
            if self.shows(Line::Draws) {
                series.extend(self.draws.series(i, color));
            }
            if let Some(band) = self.band.get().and_then(|bands| bands.get(i)) {
                series.push(Series::band(band_name(cx.work, &marks.name), band.clone()).colored(color));
            }
            series.push(Series::line(&marks.name, curves.total.clone()).colored(color));
            series.extend(marks.brdf.series(&marks.name, color, marker));
        }
        let picked = cx.derived.picked_theta_r(cx.work).zip(y.range);
        series.extend(picked.map(|(theta_r, (low, high))| mark(theta_r, low, high)));
        let panel = Panel { title: direction(settings), x: key.x().on(Axis::linear("θr", "°")), y, series, ..Panel::default() };
        Some(Figure { title: cx.work.active().title(), panels: vec![panel], ..Figure::default() })
    }

    /// The measured series, then the terms.
    fn key_entries(&self, curves: &CurveSet, marks: &MarkSet, companions: &Companions, dark: bool) -> Vec<(Line, KeyEntry)> {
        let entry = |line, name: &str, color, width| {
            (line, KeyEntry { name: name.to_owned(), color, style: LineStyle::Solid, width, symbol: None, on_map: false })
        };
        let measured = marks.series.iter().filter(|marks| !marks.brdf.is_empty());
        let measured = measured.map(|marks| entry(Line::Series(marks.index), &marks.name, theme::on_screen(marks.ink, dark), 2.0));
        let companions = companions.iter().filter(Companion::has_brdf);
        let companions = companions.map(|companion| (Line::Companion(companion.id), companion.key_entry(dark)));
        let terms = curves.own.terms().map(|(term, _)| entry(Line::Term(term), &term.name(), theme::on_screen(term.ink(), dark), 1.5));
        let total = entry(Line::Total, &tr!("total"), theme::foreground(dark), 2.0);
        let draws = self.draws.is_there().then(|| entry(Line::Draws, &posterior_band::band_name(), theme::muted(dark), BAND));
        measured.chain(draws).chain(terms).chain([total]).chain(companions).collect()
    }
}

/// What the terms are seen at.
fn direction(settings: &Settings) -> String {
    tr!("θi = {0}°, Δφ = {1}°", settings.theta_i, settings.dphi)
}

/// What is along the vertical axis.
fn quantity(times_cosine: bool) -> &'static str {
    if times_cosine { "BRDF × cos θr" } else { "BRDF" }
}

impl View for LobesView {
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
        self.follow(curves, marks, cx);
        // Where no BRDF was measured there is no fitted lobe.
        let shown = cx.work.settings().show_band && cx.work.active().measurement.has_brdf();
        let (fit, document) = (cx.work.shown_fit().map(|fit| &**fit), cx.work.active());
        let band_key = band_key(fit, document, key.backscatter, cx.work.settings().view_options.times_cosine, shown);
        self.band.refresh(band_key, |key| match (key, fit) {
            (Some((_, _, backscatter, times_cosine)), Some(fit)) => brdf_bands(&fit.report, document, *backscatter, *times_cosine),
            _ => Vec::new(),
        });
        let times_cosine = cx.work.settings().view_options.times_cosine;
        self.draws.refresh(cx, key.backscatter, BandQuantity::Brdf { times_cosine }, cx.work.active().measurement.has_brdf());
        let stamps = [derived.curves.stamp(), derived.marks.stamp(), self.band.stamp(), self.draws.stamp(), derived.companions.stamp()];
        let figure_key = (
            stamps,
            cx.work.settings().view_options,
            cx.work.settings().log_brdf,
            self.hidden.clone(),
            self.range.get(),
            derived.picked_theta_r(cx.work),
            i18n::current(),
        );
        let mut plot = std::mem::take(&mut self.plot);
        plot.refresh(figure_key, |_| self.describe(curves, key, marks, cx));
        self.plot = plot;
        // Where the user has moved the plot, the strip follows.
        let x = self.plot.moved_x().unwrap_or(key.x());
        let hidden: Vec<bool> = marks.series.iter().map(|marks| !self.shows(Line::Series(marks.index))).collect();
        let companions = derived.companions.iter().filter(|companion| self.shows(Line::Companion(companion.id)));
        let companions: Vec<Companion<'_>> = companions.collect();
        self.residuals.refresh((x, direction(cx.work.settings())), marks, hidden, &companions, cx);
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let strip = self.residuals.height(ui);
        let (height, place) = above_strip(ui, strip);
        self.curves_ui(cx, ui, height, place);
        self.residuals.ui(ui, strip);
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        series_choice_ui(cx.work.active(), cx.edits, ui);
        cx.switch_ui(Switch::LogBrdf, tr!("Logarithmic BRDF"), ui);
        cx.view_options_ui(|shown| {
            ui.checkbox(&mut shown.filled, tr!("Filled lobes")).on_hover_text(tr!("Each term filled down to the axis"));
            ui.checkbox(&mut shown.times_cosine, tr!("Times cos θr"))
                .on_hover_text(tr!("BRDF × cos θr: its integral over all directions is the reflectance"));
        });
        cx.switch_ui(Switch::Band, tr!("Confidence band"), ui).on_hover_text(tr!("One standard error of the fitted curve to either side"));
        cx.switch_ui(Switch::Backscatter, tr!("Backscatter side"), ui).on_hover_text(tr!("Negative θr, also where nothing was measured"));
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}

impl LobesView {
    fn curves_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui, height: f32, place: PanelPlace) {
        let top = ui.cursor().top();
        let (Some(curves), Some(marks)) = (cx.derived.curves.get(), cx.derived.marks.get()) else { return };
        switching_key_line_ui(&self.key_entries(curves, marks, &cx.derived.companions, ui.visuals().dark_mode), &mut self.hidden, ui);
        let (log, times_cosine) = (cx.work.settings().log_brdf, cx.work.settings().view_options.times_cosine);
        let quantity = quantity(times_cosine);
        let hint = mask_hint(cx.work.active());
        let hover = |name: &str, x: f64, y: f64| format!("{name}\nθr = {x:.2}°\n{quantity} = {y:.4e} sr⁻¹{hint}");
        let height = height - (ui.cursor().top() - top);
        let style = PanelStyle { place, ..PanelStyle::new("lobes", height, &hover) }.named(tr!("Plot: BRDF against θr"));
        let Some(response) = self.plot.panel(0).and_then(|panel| panel.ui(&style, ui)) else { return };
        note_theta_r(&response, ui);
        let at = |theta_r, brdf| {
            let value = drawn_brdf(theta_r, brdf, times_cosine);
            Some(if log { libm::log10(value) } else { value }).filter(|y| y.is_finite())
        };
        cx.edits.extend(clicked_mask(
            &response,
            ui,
            cx.work.active(),
            // What is not drawn cannot be meant.
            |i, series| if self.shows(Line::Series(i)) { &series.brdf } else { &[] },
            |mark| at(mark.theta_r, mark.quantity.value),
        ));
    }
}
