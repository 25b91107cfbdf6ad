//! The stability gallery: stiff and extreme cases with the digits that are held, beside those of
//! the textbook form. A click on a case, in the table or in the figure, loads it.

use crate::app::plots::{PanelStyle, theme};
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::text::localized::Localized as _;
use crate::app::views::action::Action;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::report::{Heading, pages_ui, run_ui, table_ui};
use crate::figure::Figure;
use egui::Ui;
use egui_plot::PlotResponse;
use pbrdf::selftest::{Setting, Stability, digits};
use tr::tr;

const HEADINGS: [Heading; 7] = [
    Heading {
        text: "",
        help: "Whether the case passes: errors of BRDF and DoLP up to 1e-13, of the derivatives up to 1e-12, more where the condition is bad; a fit finds its truth",
        width: 18.0,
        is_number: false,
    },
    Heading { text: "case", help: "A click puts the sliders there", width: 350.0, is_number: false },
    Heading { text: "digits", help: "Decimal digits of BRDF and DoLP against 60-digit values, 16 at most", width: 48.0, is_number: true },
    Heading { text: "gradient", help: "Digits of the nine derivatives of both", width: 58.0, is_number: true },
    Heading { text: "textbook", help: "Digits of the formulas as they are printed, in the same arithmetic", width: 60.0, is_number: true },
    Heading {
        text: "condition",
        help: "Of an evaluation the largest |∂ln f/∂ln p|, of a fit that of its scaled Jacobian",
        width: 70.0,
        is_number: true,
    },
    Heading { text: "outcome", help: "How a fit ended", width: 360.0, is_number: false },
];

pub static SPEC: PaneSpec = PaneSpec {
    title: "Stability",
    tooltip: "Stiff and extreme cases against 60 digits, beside the textbook form; a click on a case loads it",
    shortcut: None,
    has_options: false,
    has_figure: true,
    new: || Box::new(StabilityView),
};

/// The pane; what it shows are the benchmarks of the window.
struct StabilityView;

impl View for StabilityView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        cx.benchmarks.refresh_plots(BenchmarkId::Stability);
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let about = tr!("Evaluates and fits all stiff and extreme cases: some seconds");
        let outcome = cx.benchmarks.stability.as_ref().map(|shown| {
            let passed = shown.report.rows.iter().filter(|row| row.pass).count();
            tr!("{} of {} cases pass; a click on a case loads it into the sliders", passed, shown.report.rows.len())
        });
        run_ui(cx, BenchmarkId::Stability, (&tr!("Run all cases"), &about), outcome.as_deref(), ui);
        let actions = &mut *cx.actions;
        let Some(shown) = &mut cx.benchmarks.stability else {
            ui.label(tr!("The cases were not run yet."));
            return;
        };
        if pages_ui(shown, &["Table", "Digits held"], ui) {
            let rows = &shown.report.rows;
            let cell = |row: usize, column: usize, ui: &mut Ui| cell_ui(&rows[row], &shown.cells[row], row, column, actions, ui);
            table_ui("stability", &HEADINGS, rows.len(), cell, ui);
            return;
        }
        let (report, page) = (&shown.report, shown.page);
        let Some(panel) = shown.plots.get_mut(page - 1).and_then(|plot| plot.panel(0)) else { return };
        panel.key_line_ui(ui);
        let hover = |name: &str, x: f64, y: f64| {
            let row = case_at(x, &report.rows).and_then(|index| report.rows.get(index));
            format!("{}\n{name}: {y:.1}", row.map_or_else(String::new, |row| row.case.localized()))
        };
        let style = PanelStyle { spread: 4.0, ..PanelStyle::new("digits held", ui.available_height(), &hover) };
        let Some(response) = panel.ui(&style, ui) else { return };
        actions.extend(clicked(&response, &report.rows).map(Action::UseCase));
    }

    fn figure(&self, cx: &Cx<'_>) -> Option<Figure> {
        cx.benchmarks.figure(BenchmarkId::Stability).cloned()
    }
}

fn cell_ui(row: &Stability, cells: &[String], index: usize, column: usize, commands: &mut Vec<Action>, ui: &mut Ui) {
    let number = |error: Option<f64>| error.map_or_else(|| "–".to_owned(), |error| format!("{:.1}", digits(error)));
    let values = row.brdf_error.zip(row.dolp_error).map(|(brdf, dolp)| brdf.max(dolp));
    match column {
        0 if row.pass => ui.label("✓"),
        0 => ui.colored_label(theme::warning(ui.visuals().dark_mode), "✗"),
        1 => {
            let help = match row.setting {
                Setting::Evaluation { .. } => tr!("Parameters, terms and angles of this case to the sliders"),
                Setting::Fit { .. } => tr!("Opens the data of this fit, with the sliders where it begins"),
            };
            let response = ui.link(row.case.localized()).on_hover_text(help);
            if response.clicked() {
                commands.push(Action::UseCase(index));
            }
            response
        }
        2 => ui.label(number(values)),
        3 => ui.label(number(row.gradient_error)),
        4 => {
            let text = number(row.textbook_error);
            let is_worse = row.textbook_error.zip(values).is_some_and(|(textbook, own)| digits(textbook) < digits(own) - LOST);
            if is_worse { ui.colored_label(theme::warning(ui.visuals().dark_mode), text) } else { ui.label(text) }
        }
        5 => ui.label(&cells[column]),
        // The digits of an evaluation stand in columns of their own.
        _ if values.is_some() => ui.label(""),
        _ => ui.label(row.outcome.localized()),
    };
}

/// Digits that the textbook form has lost before it is marked.
const LOST: f64 = 2.0;

/// The case whose column of points was clicked.
fn clicked(response: &PlotResponse<()>, rows: &[Stability]) -> Option<usize> {
    let at = response.response.interact_pointer_pos().filter(|_| response.response.clicked())?;
    case_at(response.transform.value_from_position(at).x, rows)
}

/// The evaluation whose column of points stands there: they stand at whole numbers, in the order of
/// the table.
fn case_at(x: f64, rows: &[Stability]) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in a list of some hundred, saturating")]
    let index = x.round().max(0.0) as usize;
    rows.get(index).filter(|row| row.brdf_error.is_some()).map(|_| index)
}
