//! What scenes cost: a table with bars, and what is left out of each.

use crate::app::plots::theme;
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::text::i18n::{label, translated};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::report::{Heading, pages_ui, run_ui, table_ui};
use crate::figure::Figure;
use egui::{Rect, Sense, Ui, vec2};
use pbrdf::selftest::Cost;
use tr::tr;

const HEADINGS: [Heading; 9] = [
    Heading { text: "scene", help: "What is looked at", width: 400.0, is_number: false },
    Heading { text: "kernel", help: "One point after the other, or many at once", width: 44.0, is_number: false },
    Heading { text: "ns per point", help: "Median of the repetitions", width: 78.0, is_number: true },
    Heading { text: "", help: "The same as a bar, logarithmic", width: 100.0, is_number: false },
    Heading { text: "max ulp", help: "Largest difference to the full evaluation in units of the last place", width: 56.0, is_number: true },
    Heading { text: "max error", help: "The same, relative", width: 70.0, is_number: true },
    Heading { text: "threads", help: "Threads", width: 52.0, is_number: true },
    Heading { text: "points", help: "Points of one evaluation", width: 62.0, is_number: true },
    Heading { text: "left out", help: "What the scene does not need", width: 600.0, is_number: false },
];

/// Columns of the report that stand as they are, by place here.
const PLAIN: [(usize, usize); 6] = [(2, 7), (4, 9), (5, 10), (6, 3), (7, 6), (8, 8)];

pub static SPEC: PaneSpec = PaneSpec {
    title: "Cost",
    tooltip: "What a scene costs, and what is left out because it does not need it, measured on this machine",
    shortcut: None,
    has_options: false,
    has_figure: true,
    new: || Box::new(CostView),
};

/// The pane; what it shows are the benchmarks of the window.
struct CostView;

impl View for CostView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        cx.benchmarks.refresh_plots(BenchmarkId::Cost);
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let about = tr!("Times scenes from the least to everything: some seconds");
        run_ui(cx, BenchmarkId::Cost, (&tr!("Measure costs"), &about), None, ui);
        let Some(shown) = &mut cx.benchmarks.cost else {
            ui.label(tr!("Nothing is measured yet."));
            return;
        };
        // The figure is the same bars on paper: the table alone is shown.
        shown.page = 0;
        pages_ui(shown, &[], ui);
        let rows = &shown.report.rows;
        let times = || rows.iter().map(|row| row.time.median_ns);
        let ends = (0.5 * times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
        let cell = |row: usize, column: usize, ui: &mut Ui| {
            let (row, cells) = (&rows[row], &shown.cells[row]);
            match PLAIN.iter().find(|(here, _)| *here == column) {
                Some((_, there)) => {
                    let text = label(&cells[*there]);
                    _ = ui.label(&text).on_hover_text(text);
                }
                None if column == 0 => {
                    _ = ui.label(translated(row.scene)).on_hover_text(format!("{}, {}", row.distribution.key(), translated(&row.terms)));
                }
                None if column == 3 => bar_ui(row, ends, ui),
                None => {
                    let kernel = row.kernel;
                    _ = ui.label(translated(kernel));
                }
            }
        };
        table_ui("cost", &HEADINGS, rows.len(), cell, ui);
    }

    fn figure(&self, cx: &Cx<'_>) -> Option<Figure> {
        cx.benchmarks.figure(BenchmarkId::Cost).cloned()
    }
}

/// A bar as long as the logarithm of the time.
fn bar_ui(row: &Cost, (low, high): (f64, f64), ui: &mut Ui) {
    let share = libm::log(row.time.median_ns / low) / libm::log(high / low);
    #[expect(clippy::cast_possible_truncation, reason = "a fraction")]
    let share = if share.is_finite() { share.clamp(0.0, 1.0) as f32 } else { 0.0 };
    let (room, response) = ui.allocate_exact_size(vec2(ui.available_width(), 10.0), Sense::hover());
    let bar = Rect::from_min_size(room.min, vec2(share * room.width(), room.height()));
    let color = theme::series(usize::from(row.kernel == "batch"), ui.visuals().dark_mode);
    ui.painter().rect_filled(bar, 2.0, color);
    response.on_hover_text(format!("{:.3} ns ± {:.1} %", row.time.median_ns, 100.0 * row.time.spread));
}
