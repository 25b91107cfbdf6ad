//! The strip under DoLP or BRDF: model less measurement, of BRDF over the measurement, so that a misfit too small for the curves
//! shows.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::MUTED;
use crate::app::plots::{AutoRange, FigurePlot, PanelPlace, PanelStyle, Range, nice_ceiling};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::views::companions::{Companion, CompanionId, Residual, residuals};
use crate::app::views::context::Cx;
use crate::app::views::curves::{MOST_POINTS, MarkSet, drawn, is_fitted};
use crate::app::work::open_measurement::{DataPoint, IncidenceSeries, OpenMeasurement};
use crate::figure::{Axis, Figure, Panel, Series};
use egui::Ui;
use pbrdf::fit::FitRange;
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Facet;
use tr::tr;

/// What the strip keeps.
#[derive(Default)]
pub struct ResidualStrip {
    quantity: ResidualQuantity,
    /// Of each series.
    pub of_series: Memo<SurfaceKey, Vec<Vec<Residual>>>,
    range: AutoRange,
    plot: FigurePlot<PlotKey>,
    is_there: bool,
}

/// The sliders' surface, the state of the measurement, the angles that are fitted.
type SurfaceKey = (Parameters, Model, u64, Option<FitRange>);

/// Stamp of the residuals, which series are hidden, stamp of the companions and which of them are
/// drawn, the axis of θr, that of the residuals, what stands at the former, the language.
type PlotKey = (u64, Vec<bool>, (u64, Vec<CompanionId>), Range, Option<Range>, String, Language);

/// Half the axis where a fit has been exact from the first.
const EXACT: f64 = 0.01;

impl ResidualStrip {
    pub fn new(quantity: ResidualQuantity) -> Self {
        Self { quantity, ..Self::default() }
    }

    /// Along the part of θr that the plot above shows; `title` stands at its axis.
    pub fn refresh(&mut self, (x, title): (Range, String), marks: &MarkSet, hidden: Vec<bool>, companions: &[Companion<'_>], cx: &Cx<'_>) {
        let (surface, document, quantity) = (cx.work.surface(), cx.work.active(), self.quantity);
        let range = cx.work.settings().fit_options.range;
        let key = (surface.parameters, surface.model, document.plotted, range);
        self.of_series.refresh(key, |_| match Pbrdf::new(surface.model, surface.parameters) {
            Ok(surface) => quantity.residuals(&surface, document, range),
            Err(_) => Vec::new(),
        });
        self.is_there = document.series.iter().any(|series| !quantity.points(series).is_empty());
        let Some(residuals) = self.of_series.get() else { return };
        let others = companions.iter().flat_map(|companion| quantity.of_companion(companion));
        let largest = residuals.iter().flatten().chain(others).map(|residual| quantity.place(residual)[1].abs());
        let largest = largest.filter(|value| value.is_finite()).fold(0.0, f64::max);
        if largest > 0.0 {
            let end = 1.08 * nice_ceiling(largest);
            self.range.follow(Range { low: -end, high: end }, cx.interacting);
        } else if self.range.get().is_none() {
            // Nothing is missed, or there is no surface: the axis waits where it is.
            self.range.follow(Range { low: -EXACT, high: EXACT }, cx.interacting);
        }
        let range = &self.range;
        let beside = (cx.derived.companions.stamp(), companions.iter().map(|companion| companion.id).collect());
        let key = (self.of_series.stamp(), hidden, beside, x, range.get(), title, i18n::current());
        self.plot.refresh(key, |(_, hidden, _, x, _, title, _)| {
            let mut series = vec![Series::level("", 0.0).colored(MUTED)];
            let of_companion = |companion: &Companion<'_>| companion.residuals(quantity.of_companion(companion), |at| quantity.place(at));
            series.extend(companions.iter().filter_map(of_companion));
            let all = residuals.iter().zip(&marks.series).zip(hidden);
            for ((residuals, marks), _) in all.filter(|((residuals, _), hidden)| !residuals.is_empty() && !**hidden) {
                series.push(Series::points(&marks.name, residuals.iter().map(|at| quantity.place(at))).colored(marks.ink));
            }
            let (x, y) = (x.on(Axis::linear("θr", "°")), range.on(quantity.strip_axis()));
            Some(Figure { panels: vec![Panel { title: title.clone(), x, y, series, ..Panel::default() }], ..Figure::default() })
        });
    }

    /// Whether any of it was measured. A strip that came and went would move the plot above it.
    fn is_there(&self) -> bool {
        self.is_there && self.range.get().is_some()
    }

    /// What it takes of the height that there is, or that there is no strip.
    pub fn height(&self, ui: &Ui) -> Option<f32> {
        let room = ui.available_height();
        (self.is_there() && room > LEAST_ROOM).then(|| (SHARE * room).max(LEAST))
    }

    #[cfg(test)]
    pub fn seen_x(&self) -> Option<Range> {
        self.plot.seen_x()
    }

    /// Draws it, if there is one, that high.
    pub fn ui(&mut self, ui: &mut Ui, height: Option<f32>) {
        let Some(height) = height else { return };
        ui.add_space(BETWEEN - ui.spacing().item_spacing.y);
        let hover = |name: &str, x: f64, y: f64| tr!("{0}\nθr = {1}°\nresidual = {2}", name, format!("{x:.2}"), format!("{y:.2e}"));
        let spread = if height < LOW { 2.2 } else { 3.5 };
        let id = if self.quantity == ResidualQuantity::Dolp { "residuals" } else { "residuals of BRDF" };
        let style = PanelStyle { spread, place: PanelPlace::Strip, ..PanelStyle::new(id, height, &hover) };
        let style = style.named(match self.quantity {
            ResidualQuantity::Dolp => tr!("Plot: residuals of DoLP against θr"),
            ResidualQuantity::Brdf => tr!("Plot: relative residuals of BRDF against θr"),
        });
        if let Some(panel) = self.plot.panel(0) {
            panel.ui(&style, ui);
        }
    }
}

/// Height of a pane, in points, from which there is a strip.
const LEAST_ROOM: f32 = 220.0;
/// Share of the height that the strip has, and points that it has at least, with the axis of θr.
const SHARE: f32 = 0.25;
const LEAST: f32 = 92.0;
/// Between plot and strip, in points: what the strip shows is written there, and numbers at their ends are not to meet.
const BETWEEN: f32 = 16.0;

/// Below this height marks stand closer, so that there is more than that at 0.
const LOW: f32 = 100.0;

/// Height and place of a plot above a strip of that height, or above none.
pub fn above_strip(ui: &Ui, strip: Option<f32>) -> (f32, PanelPlace) {
    let room = ui.available_height();
    strip.map_or((room, PanelPlace::Alone), |strip| (room - strip - BETWEEN, PanelPlace::OverStrip))
}

/// What was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ResidualQuantity {
    #[default]
    Dolp,
    Brdf,
}

impl ResidualQuantity {
    pub fn points(self, series: &IncidenceSeries) -> &[DataPoint] {
        match self {
            Self::Dolp => &series.dolp,
            Self::Brdf => &series.brdf,
        }
    }

    pub fn of_companion<'a>(self, companion: &Companion<'a>) -> &'a [Residual] {
        match self {
            Self::Dolp => &companion.drawn.dolp_residuals,
            Self::Brdf => &companion.drawn.brdf_residuals,
        }
    }

    fn of_model(self, surface: &Pbrdf, facet: &Facet) -> f64 {
        match self {
            Self::Dolp => surface.dolp(facet),
            Self::Brdf => surface.reflection(facet).brdf,
        }
    }

    /// Where a residual lies in a strip.
    fn place(self, residual: &Residual) -> [f64; 2] {
        let y = if self == Self::Dolp { residual.value } else { residual.relative() };
        [residual.theta_r, y]
    }

    fn strip_axis(self) -> Axis {
        Axis::linear(if self == Self::Dolp { tr!("model − meas.") } else { tr!("model / meas. − 1") }, "")
    }

    /// Model less measurement of each drawn series, without masked points and those outside the fitted angles.
    pub fn residuals(self, surface: &Pbrdf, document: &OpenMeasurement, fitted: Option<FitRange>) -> Vec<Vec<Residual>> {
        let of_one = |series: &IncidenceSeries| {
            let points = self.points(series);
            let step = points.len().div_ceil(MOST_POINTS / document.drawn().len().max(1)).max(1);
            let used: Vec<DataPoint> = points.iter().step_by(step).filter(|mark| is_fitted(fitted, series, mark)).copied().collect();
            residuals(series, &used, |facet| self.of_model(surface, facet)).collect()
        };
        drawn(document).map(of_one).collect()
    }
}
