//! Residuals against the angle of view: of the sliders or of the shown fit, over the stated
//! standard deviations where all are stated.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::MUTED;
use crate::app::plots::{AutoRange, FigurePlot, PanelStyle, Range, nice_ceiling};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::views::companions::{Companion, Residual};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::{MarkSet, drawn, figure_title, is_fitted};
use crate::app::views::pointing::mark;
use crate::app::views::residuals::ResidualQuantity;
use crate::app::views::series_choice::series_choice_ui;
use crate::app::work::open_measurement::{IncidenceSeries, OpenMeasurement};
use crate::figure::{Axis, Figure, Panel, Series};
use egui::Ui;
use pbrdf::fit::FitRange;
use pbrdf::model::{Model, Parameters, Pbrdf};
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Residuals against angle",
    tooltip: "Model less measurement against the angle of view, in units of the stated standard deviations where all are stated; one colour for each angle of incidence",
    shortcut: None,
    has_options: true,
    has_figure: true,
    new: || Box::new(ResidualsAgainstAngleView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct ResidualsAgainstAngleView {
    /// Whether the residuals are those of the shown fit rather than of the sliders.
    of_fit: bool,
    residuals: Memo<(Parameters, Model, u64, Option<FitRange>), Vec<QuantityResiduals>>,
    ranges: [AutoRange; 2],
    plot: FigurePlot<PlotKey>,
}

/// Of the residuals and the companions by their stamps; whether the backscatter side is drawn; the axes; the
/// picked angle of view; the language.
type PlotKey = ([u64; 2], bool, [Option<Range>; 2], Option<f64>, Language);

/// Residuals of one measured quantity.
struct QuantityResiduals {
    quantity: ResidualQuantity,
    /// Those of each series, without masked points.
    of_series: Vec<Vec<Residual>>,
}

impl ResidualQuantity {
    /// The axis of its residuals.
    fn axis(self, in_sigma: bool) -> Axis {
        match self {
            Self::Dolp if in_sigma => Axis::linear(tr!("DoLP: model − measurement"), tr!("s.d.")),
            Self::Dolp => Axis::linear(tr!("DoLP: model − measurement"), ""),
            Self::Brdf if in_sigma => Axis::linear(tr!("BRDF: model − measurement"), tr!("s.d.")),
            Self::Brdf => Axis::linear(tr!("BRDF: model − measurement"), "sr⁻¹"),
        }
    }
}

impl QuantityResiduals {
    /// None where the quantity was not measured.
    fn new(quantity: ResidualQuantity, surface: &Pbrdf, document: &OpenMeasurement, fitted: Option<FitRange>) -> Option<Self> {
        let has_used = |series: &IncidenceSeries| quantity.points(series).iter().any(|mark| is_fitted(fitted, series, mark));
        drawn(document).find(|series| has_used(series))?;
        let of_series = quantity.residuals(surface, document, fitted);
        Some(Self { quantity, of_series })
    }

    /// All that are drawn in its panel.
    fn all<'a>(&'a self, companions: &'a [Companion<'a>]) -> impl Iterator<Item = &'a Residual> {
        let others = companions.iter().flat_map(|companion| self.quantity.of_companion(companion));
        self.of_series.iter().flatten().chain(others)
    }

    /// Whether all are over their standard deviations.
    fn in_sigma(&self, companions: &[Companion<'_>]) -> bool {
        self.all(companions).all(|residual| residual.sigma.is_some())
    }

    fn panel(&self, marks: &MarkSet, companions: &[Companion<'_>], x: &Axis, range: &AutoRange, legend: bool) -> Panel {
        let in_sigma = self.in_sigma(companions);
        let mut series = vec![Series::level("", 0.0).colored(MUTED)];
        if in_sigma {
            series.extend([-1.0, 1.0].map(|sigma| Series::level("", sigma).colored(MUTED).faded(0.5)));
        }
        let of_companion =
            |companion: &Companion<'_>| companion.residuals(self.quantity.of_companion(companion), |residual| residual.place(in_sigma));
        series.extend(companions.iter().filter_map(of_companion));
        let all = self.of_series.iter().zip(&marks.series).filter(|(residuals, _)| !residuals.is_empty());
        series.extend(all.map(|(residuals, marks)| {
            Series::points(&marks.name, residuals.iter().map(|residual| residual.place(in_sigma))).colored(marks.ink)
        }));
        Panel { x: x.clone(), y: range.on(self.quantity.axis(in_sigma)), series, legend, ..Panel::default() }
    }
}

impl View for ResidualsAgainstAngleView {
    fn needs_curves(&self) -> bool {
        true
    }

    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (surface, document) = (cx.work.surface(), cx.work.active());
        let (Some(marks), Some(curves)) = (cx.derived.marks.get(), cx.derived.curves.key()) else { return };
        let companions: Vec<Companion<'_>> = cx.derived.companions.iter().collect();
        let fit = cx.work.shown_fit().filter(|fit| self.of_fit && fit.number == document.number);
        let (parameters, model) = fit.map_or((surface.parameters, surface.model), |fit| (fit.report.parameters, fit.report.model));
        let fitted = cx.work.settings().fit_options.range;
        self.residuals.refresh((parameters, model, document.plotted, fitted), |_| match Pbrdf::new(model, parameters) {
            Ok(surface) => [ResidualQuantity::Dolp, ResidualQuantity::Brdf]
                .into_iter()
                .filter_map(|quantity| QuantityResiduals::new(quantity, &surface, document, fitted))
                .collect(),
            Err(_) => Vec::new(),
        });
        let residuals = self.residuals.get().map_or(&[][..], Vec::as_slice);
        for (residuals, range) in residuals.iter().zip(&mut self.ranges) {
            let in_sigma = residuals.in_sigma(&companions);
            let heights = residuals.all(&companions).map(|residual| residual.place(in_sigma)[1].abs());
            let largest = heights.filter(|y| y.is_finite()).fold(0.0, f64::max);
            let end = nice_ceiling(largest);
            range.follow(Range { low: -end, high: end }, cx.interacting);
        }
        let ranges = &self.ranges;
        let stamps = [self.residuals.stamp(), cx.derived.companions.stamp()];
        let picked = cx.derived.picked_theta_r(cx.work);
        let key = (stamps, curves.backscatter, [ranges[0].get(), ranges[1].get()], picked, i18n::current());
        self.plot.refresh(key, |_| {
            let x = curves.x().on(Axis::linear("θr", "°"));
            let panels = residuals.iter().zip(ranges).enumerate();
            let panel = |(i, (residuals, range)): (usize, (&QuantityResiduals, &AutoRange))| {
                let mut panel = residuals.panel(marks, &companions, &x, range, i == 0);
                panel.series.extend(picked.zip(range.get()).map(|(theta_r, range)| mark(theta_r, range.low, range.high)));
                panel
            };
            let panels: Vec<Panel> = panels.map(panel).collect();
            (!panels.is_empty()).then(|| Figure { title: figure_title(cx.work), panels, ..Figure::default() })
        });
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.selectable_value(&mut self.of_fit, false, tr!("of the sliders"));
            let has_fit = cx.work.shown_fit().is_some_and(|fit| fit.number == cx.work.active().number);
            ui.add_enabled_ui(has_fit, |ui| ui.selectable_value(&mut self.of_fit, true, tr!("of the shown fit")));
        });
        let count = self.plot.panels().len();
        if count == 0 {
            ui.label(tr!("Nothing was measured, or there is no surface: there are no residuals."));
            return;
        }
        if let Some(panel) = self.plot.panel(0) {
            panel.key_line_ui(ui);
        }
        #[expect(clippy::cast_precision_loss, reason = "one or two panels")]
        let height = ui.available_height() / count as f32 - ui.spacing().item_spacing.y;
        for (panel, id) in self.plot.panels().iter_mut().zip(["first_residuals", "second_residuals"]) {
            let hover = |name: &str, x: f64, y: f64| tr!("{0}\nθr = {1}°\nresidual = {2}", name, format!("{x:.2}"), format!("{y:.3e}"));
            panel.ui(&PanelStyle::new(id, height.max(60.0), &hover), ui);
        }
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        series_choice_ui(cx.work.active(), cx.edits, ui);
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}

#[cfg(test)]
mod tests {
    use super::{OpenMeasurement, Pbrdf, QuantityResiduals, ResidualQuantity};
    use pbrdf::measurement::Measurement;
    use pbrdf::model::{Model, Parameters};
    use pbrdf::optics::SlopeDistribution;

    fn document(text: &str) -> OpenMeasurement {
        OpenMeasurement::new("a".to_owned(), Measurement::read(text.as_bytes()).expect("a table"))
    }

    #[test]
    fn residuals_are_over_sigma_where_every_value_states_one() {
        let surface = Pbrdf::new(Model::full(SlopeDistribution::Cauchy), Parameters::default()).expect("a surface");
        let residuals = |text: &str, quantity| QuantityResiduals::new(quantity, &surface, &document(text), None);
        let stated = "theta_i,theta_r,dphi,dolp,dolp_sigma\n30,20,180,0.1,0.01\n30,40,180,0.2,0.02\n";
        let bare = "theta_i,theta_r,dphi,dolp,dolp_sigma\n30,20,180,0.1,0.01\n30,40,180,0.2,\n";
        let (stated_dolp, bare_dolp) =
            (residuals(stated, ResidualQuantity::Dolp).expect("DoLP"), residuals(bare, ResidualQuantity::Dolp).expect("DoLP"));
        assert!(stated_dolp.in_sigma(&[]) && !bare_dolp.in_sigma(&[]));
        let places = |residuals: &QuantityResiduals| -> Vec<[f64; 2]> {
            residuals.of_series[0].iter().map(|residual| residual.place(residuals.in_sigma(&[]))).collect()
        };
        let (over_sigma, plain) = (places(&stated_dolp), places(&bare_dolp));
        assert_eq!(over_sigma.iter().map(|[x, _]| *x).collect::<Vec<_>>(), [20.0, 40.0]);
        for ((over, plain), sigma) in over_sigma.iter().zip(&plain).zip([0.01, 0.02]) {
            // A quotient.
            assert!((over[1] * sigma / plain[1] - 1.0).abs() < 4.0 * f64::EPSILON, "{over:?} {plain:?}");
        }
        assert!(residuals(stated, ResidualQuantity::Brdf).is_none(), "not measured");
    }
}
