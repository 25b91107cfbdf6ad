//! The way of the last fit: ΔE after each improvement of the winning start, against evaluations or
//! time.

use crate::app::plots::axis::decimal;
use crate::app::plots::{FigurePlot, PanelStyle};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::localized::Localized as _;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::fit_history::FitEntry;
use crate::figure::{Axis, Figure, Panel, SERIES, Series};
use egui::Ui;
use std::sync::Arc;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Convergence",
    tooltip: "The way of the last fit: ΔE, Eq. (18), against evaluations or time",
    shortcut: None,
    has_options: true,
    has_figure: true,
    new: || Box::new(ConvergenceView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct ConvergenceView {
    plot: FigurePlot<Key>,
}

/// The fit that is drawn, by identity, whether it is drawn against time, and the language.
struct Key(Option<Arc<FitEntry>>, bool, Language);

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        (self.1, self.2) == (other.1, other.2)
            && match (&self.0, &other.0) {
                (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                (a, b) => a.is_none() && b.is_none(),
            }
    }
}

/// ΔE against evaluations or milliseconds: it stays as it is until the next improvement, in steps.
#[expect(clippy::cast_precision_loss, reason = "a number of evaluations")]
fn describe(fit: &FitEntry, by_time: bool, title: String) -> Figure {
    let trace = &fit.report.course.trace;
    let points: Vec<[f64; 2]> =
        trace.iter().map(|point| [if by_time { point.elapsed_ms } else { point.evaluations as f64 }, point.objective]).collect();
    let series = vec![Series::steps("ΔE", points.clone()).colored(SERIES[0]), Series::points("ΔE", points).colored(SERIES[0])];
    let x = if by_time { Axis::linear(tr!("time"), "ms") } else { Axis::linear(tr!("residual evaluations"), "") };
    let panel = Panel { x, y: Axis::log("ΔE", ""), series, legend: false, ..Panel::default() };
    Figure { title, panels: vec![panel], ..Figure::default() }
}

impl View for ConvergenceView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let key = Key(cx.work.shown_fit().cloned(), cx.work.settings().view_options.convergence_by_time, i18n::current());
        self.plot.refresh(key, |Key(fit, by_time, _)| fit.as_ref().map(|fit| describe(fit, *by_time, cx.work.active().title())));
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let Some(fit) = cx.work.shown_fit() else {
            ui.label(tr!("There is no fit yet: press Fit, and its way down is drawn here."));
            return;
        };
        let report = &fit.report;
        if report.course.minima.is_empty() {
            ui.label(tr!("How this fit came about is not known: its session was saved by an older version."));
            return;
        }
        if report.course.trace.is_empty() {
            ui.label(tr!("The fit made no step: ΔE of its start was the best."));
            return;
        }
        let starts = report.course.minima.iter().map(|minimum| minimum.hits).sum::<usize>();
        ui.weak(tr!("Winning start of {0}; {1}. ΔE on a logarithmic axis.", starts, report.stop_reason.localized()));
        let title = if cx.work.settings().view_options.convergence_by_time { tr!("time / ms") } else { tr!("residual evaluations") };
        let hover = |_: &str, x: f64, y: f64| format!("{title}: {}\nΔE = {y:.6e}", decimal(x, 0.1));
        let style = PanelStyle::new("convergence", ui.available_height(), &hover).named(tr!("Plot: ΔE of the last fit against {}", title));
        if let Some(panel) = self.plot.panel(0) {
            panel.ui(&style, ui);
        }
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        cx.view_options_ui(|shown| {
            let by_time = &mut shown.convergence_by_time;
            ui.radio_value(by_time, false, tr!("Against evaluations"))
                .on_hover_text(tr!("Evaluations of the residuals, the same on every machine"));
            ui.radio_value(by_time, true, tr!("Against time"))
                .on_hover_text(tr!("Milliseconds since the fit began, all its starts included"));
        });
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}
