//! The strip under DoLP: model less measurement, so that a misfit too small for the curves shows.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::MUTED;
use crate::app::plots::{AutoRange, FigurePlot, PanelPlace, PanelStyle, Range, nice_ceiling};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::views::companions::{Companion, CompanionId};
use crate::app::views::context::Cx;
use crate::app::views::curves::{MOST_POINTS, MarkSet, drawn, is_fitted};
use crate::app::work::open_measurement::{DataPoint, IncidenceSeries, OpenMeasurement};
use crate::app::work::surface::Surface;
use crate::figure::{Axis, Figure, Panel, Series};
use egui::Ui;
use pbrdf::fit::FitRange;
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Facet;
use tr::tr;

/// What the strip keeps.
#[derive(Default)]
pub struct ResidualStrip {
    /// DoLP of the model less the measured one, of each series; masked points left out.
    pub of_series: Memo<(Parameters, Model, u64, Option<FitRange>), Vec<Curve>>,
    range: AutoRange,
    plot: FigurePlot<PlotKey>,
    is_there: bool,
}

/// θr in degrees and the residual of DoLP, point by point.
type Curve = Vec<[f64; 2]>;

/// Stamp of the residuals, which series are hidden, stamp of the companions and which of them are
/// drawn, the axis of θr, that of the residuals, the language.
type PlotKey = (u64, Vec<bool>, (u64, Vec<CompanionId>), Range, Option<Range>, Language);

/// Half the axis where a fit has been exact from the first.
const EXACT: f64 = 0.01;

impl ResidualStrip {
    /// Along the part of θr that the plot above shows.
    pub fn refresh(&mut self, x: Range, marks: &MarkSet, hidden: Vec<bool>, companions: &[Companion<'_>], cx: &Cx<'_>) {
        let (surface, document) = (cx.work.surface(), cx.work.active());
        let range = cx.work.settings().fit_options.range;
        let key = (surface.parameters, surface.model, document.plotted, range);
        self.of_series.refresh(key, |_| of_all(surface, document, range));
        self.is_there = document.series.iter().any(|series| !series.dolp.is_empty());
        let Some(residuals) = self.of_series.get() else { return };
        let others = companions.iter().flat_map(|companion| &companion.drawn.dolp_residuals);
        let others = others.map(|residual| residual.value.abs());
        let largest = residuals.iter().flatten().map(|point| point[1].abs()).chain(others).fold(0.0, f64::max);
        if largest > 0.0 {
            let end = 1.08 * nice_ceiling(largest);
            self.range.follow(Range { low: -end, high: end }, cx.interacting);
        } else if self.range.get().is_none() {
            // Nothing is missed, or there is no surface: the axis waits where it is.
            self.range.follow(Range { low: -EXACT, high: EXACT }, cx.interacting);
        }
        let range = &self.range;
        let beside = (cx.derived.companions.stamp(), companions.iter().map(|companion| companion.id).collect());
        let key = (self.of_series.stamp(), hidden, beside, x, range.get(), i18n::current());
        self.plot.refresh(key, |(_, hidden, _, x, ..)| {
            let mut series = vec![Series::level("", 0.0).colored(MUTED)];
            series.extend(companions.iter().filter_map(|companion| companion.residuals(&companion.drawn.dolp_residuals, false)));
            let all = residuals.iter().zip(&marks.series).zip(hidden);
            for ((residuals, marks), _) in all.filter(|((residuals, _), hidden)| !residuals.is_empty() && !**hidden) {
                series.push(Series::points(&marks.name, residuals.iter().copied()).colored(marks.ink));
            }
            let (x, y) = (x.on(Axis::linear("θr", "°")), range.on(Axis::linear(tr!("model − meas."), "")));
            Some(Figure { panels: vec![Panel { x, y, series, ..Panel::default() }], ..Figure::default() })
        });
    }

    /// Whether any DoLP was measured. A strip that came and went would move the plot above it.
    pub fn is_there(&self) -> bool {
        self.is_there && self.range.get().is_some()
    }

    #[cfg(test)]
    pub fn seen_x(&self) -> Option<Range> {
        self.plot.seen_x()
    }

    pub fn ui(&mut self, ui: &mut Ui, height: f32) {
        let hover = |name: &str, x: f64, y: f64| tr!("{0}\nθr = {1}°\nresidual = {2}", name, format!("{x:.2}"), format!("{y:.2e}"));
        let spread = if height < LOW { 2.2 } else { 3.5 };
        let style = PanelStyle { spread, place: PanelPlace::Strip, ..PanelStyle::new("residuals", height, &hover) };
        let style = style.named(tr!("Plot: residuals of DoLP against θr"));
        if let Some(panel) = self.plot.panel(0) {
            panel.ui(&style, ui);
        }
    }
}

/// Below this height marks stand closer, so that there is more than that at 0.
const LOW: f32 = 100.0;

fn of_all(surface: &Surface, document: &OpenMeasurement, range: Option<FitRange>) -> Vec<Vec<[f64; 2]>> {
    let Ok(surface) = Pbrdf::new(surface.model, surface.parameters) else { return Vec::new() };
    let of_one = |series: &IncidenceSeries| {
        let step = series.dolp.len().div_ceil(MOST_POINTS / document.drawn().len().max(1)).max(1);
        let used = series.dolp.iter().step_by(step).filter(|mark| is_fitted(range, series, mark));
        let residual = |mark: &DataPoint| {
            let facet = Facet::new(series.geometry(mark.theta_r)?);
            Some([mark.theta_r, surface.dolp(&facet) - mark.quantity.value])
        };
        used.filter_map(residual).collect()
    };
    drawn(document).map(of_one).collect()
}
