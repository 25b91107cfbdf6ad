//! Error against run time: of evaluations against the 60-digit table, and along fits, as a table
//! and as diagrams with hover values.

use crate::app::plots::PanelStyle;
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::text::messages::short_method;
use crate::app::text::numbers::short;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::report::{Heading, pages_ui, run_ui, table_ui};
use crate::figure::Figure;
use egui::Ui;
use pbrdf::selftest::TaskKind;
use tr::tr;

/// The table and the figures of the report, in its order.
const PAGES: [&str; 6] = ["Table", "Evaluation", "Along one fit", "Performance profile", "Ladder", "Along the ladder"];

const HEADINGS: [Heading; 7] = [
    Heading { text: "task", help: "Evaluations of the model, or fits", width: 50.0, is_number: false },
    Heading { text: "method", help: "How it is done", width: 235.0, is_number: false },
    Heading { text: "time", help: "Of a point or of a fit, median of the repetitions", width: 62.0, is_number: true },
    Heading { text: "± %", help: "Half the distance between the quartiles over the median", width: 34.0, is_number: true },
    Heading { text: "worst error", help: "Relative; 1 means not a single digit", width: 72.0, is_number: true },
    Heading { text: "median error", help: "Relative", width: 80.0, is_number: true },
    Heading { text: "success", help: "Share of fits that reached the best objective known", width: 48.0, is_number: true },
];

pub static SPEC: PaneSpec = PaneSpec {
    title: "Error against time",
    tooltip: "Error against run time of evaluations and of fits, measured on this machine",
    shortcut: None,
    has_options: false,
    has_figure: true,
    new: || Box::new(ErrorVsTimeView),
};

/// The pane; what it shows are the benchmarks of the window.
struct ErrorVsTimeView;

impl View for ErrorVsTimeView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        cx.benchmarks.refresh_plots(BenchmarkId::ErrorVsTime);
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let about = tr!("Times evaluations and fits on this machine, each several times: up to a minute");
        run_ui(cx, BenchmarkId::ErrorVsTime, (&tr!("Measure error against run time"), &about), None, ui);
        let Some(shown) = &mut cx.benchmarks.error_vs_time else {
            ui.label(tr!("Nothing is measured yet."));
            return;
        };
        if pages_ui(shown, &PAGES, ui) {
            let rows = &shown.report.rows;
            let cell = |row: usize, column: usize, ui: &mut Ui| {
                let (row, cells) = (&rows[row], &shown.cells[row]);
                let task = row.task.key();
                match column {
                    0 => ui.label(translated(task)),
                    1 => ui.label(short_method(row.method)).on_hover_text(row.method.localized()),
                    2 => ui.label(match row.task {
                        TaskKind::Evaluate => format!("{} ns", short(row.time)),
                        TaskKind::Fit => format!("{} ms", short(row.time)),
                    }),
                    3 if row.spread.is_finite() => ui.label(format!("{:.1}", 100.0 * row.spread)),
                    3 => ui.label("–"),
                    _ => ui.label(&cells[column]),
                };
            };
            table_ui("error against time", &HEADINGS, rows.len(), cell, ui);
            return;
        }
        let page = shown.page;
        let Some(plot) = shown.plots.get_mut(page - 1) else { return };
        ui.label(plot.figure().map_or("", |figure| &figure.title));
        plot.panels().iter().for_each(|panel| panel.key_line_ui(ui));
        let height = ui.available_height();
        ui.columns(plot.panels().len().max(1), |columns| {
            for (i, (panel, ui)) in plot.panels().iter_mut().zip(columns).enumerate() {
                let id = format!("error_vs_time {page} {i}");
                let hover = |name: &str, x: f64, y: f64| format!("{name}\n{} · {}", short(x), short(y));
                panel.ui(&PanelStyle { spread: 4.0, ..PanelStyle::new(&id, height, &hover) }, ui);
            }
        });
    }

    fn figure(&self, cx: &Cx<'_>) -> Option<Figure> {
        cx.benchmarks.figure(BenchmarkId::ErrorVsTime).cloned()
    }
}
