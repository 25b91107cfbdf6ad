//! What the panes of reports have in common: the line that starts and stops them, the choice
//! between table and figures, and the table.

use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::text::explained::Explained as _;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized;
use crate::app::views::action::Action;
use crate::app::views::benchmarks::BenchmarkView;
use crate::app::views::context::Cx;
use egui::{Align, Layout, ProgressBar, RichText, ScrollArea, Ui};
use egui_extras::{Column, TableBuilder};
use pbrdf::selftest::BenchmarkRow;
use tr::tr;

/// The line with the button and what it does, and what has come out.
pub fn run_ui(cx: &mut Cx<'_>, subject: BenchmarkId, (button, about): (&str, &str), outcome: Option<&str>, ui: &mut Ui) {
    let running = cx.jobs.benchmarks.progress();
    ui.horizontal(|ui| {
        match running {
            Some((own, done)) if own == subject => {
                if ui.button(tr!("Stop measuring")).on_hover_text(tr!("What is done so far is shown")).clicked() {
                    cx.actions.push(Action::CancelBenchmark);
                }
                #[expect(clippy::cast_possible_truncation, reason = "a fraction")]
                let done = done as f32;
                // Nothing that moves by itself: frames would take their time from what is being
                // measured.
                ui.add(ProgressBar::new(done).desired_width(160.0).show_percentage());
            }
            _ if cx.jobs.benchmarks.is_waiting(subject) => {
                if ui.button(tr!("Do not wait")).on_hover_text(tr!("This report is not made after all")).clicked() {
                    cx.actions.push(Action::ForgetBenchmark(subject));
                }
                ui.label(tr!("Comes after the report that is being made: both would be slower side by side."));
            }
            _ => {
                if ui.button(button).on_hover_text(about).clicked() {
                    cx.actions.push(Action::RunBenchmark(subject));
                }
            }
        }
        outcome.map(|outcome| ui.label(outcome));
    });
}

/// Where the report was made and when, and the choice of what is in front; tells whether that is
/// the table.
pub fn pages_ui<R: BenchmarkRow>(shown: &mut BenchmarkView<R>, names: &[&str], ui: &mut Ui) -> bool {
    let report = &shown.report;
    let part = if shown.is_part { tr!("stopped before its end; ") } else { "".into() };
    let text = RichText::new(format!("{part}{}, {}", report.machine.localized(), report.date)).weak();
    ui.add(egui::Label::new(text).wrap()).on_hover_ui(|ui| {
        ui.label(report.notes.iter().map(Localized::localized).collect::<Vec<_>>().join("\n\n"));
    });
    if names.is_empty() {
        return true;
    }
    ui.horizontal_wrapped(|ui| {
        for (page, &name) in (0..=shown.plots.len()).zip(names) {
            ui.selectable_value(&mut shown.page, page, translated(name));
        }
    });
    shown.page == 0
}

/// A column: heading, what it says, width, and whether it holds numbers.
pub struct Heading {
    pub text: &'static str,
    pub help: &'static str,
    pub width: f32,
    pub is_number: bool,
}

/// A table of so many rows; `cell` draws what stands in a row and a column.
pub fn table_ui(name: &str, headings: &[Heading], rows: usize, mut cell: impl FnMut(usize, usize, &mut Ui), ui: &mut Ui) {
    let height = ui.spacing().interact_size.y;
    ScrollArea::horizontal().id_salt(name).auto_shrink([false; 2]).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut builder = TableBuilder::new(ui).id_salt(name).striped(true).auto_shrink([false; 2]);
        for heading in headings {
            builder = builder.column(Column::initial(heading.width).resizable(true).clip(true));
        }
        let layout = |heading: &Heading| {
            if heading.is_number { Layout::right_to_left(Align::Center) } else { Layout::left_to_right(Align::Center) }
        };
        let table = builder.header(height, |mut header| {
            for heading in headings {
                header.col(|ui| {
                    let Heading { text, help, .. } = *heading;
                    ui.with_layout(layout(heading), |ui| {
                        // No text, no translation: an empty one is the head of the catalogue.
                        if !text.is_empty() {
                            ui.strong(translated(text)).explained(translated(help));
                        }
                    });
                });
            }
        });
        table.body(|body| {
            body.rows(height, rows, |mut line| {
                let row = line.index();
                for (column, heading) in headings.iter().enumerate() {
                    line.col(|ui| {
                        ui.with_layout(layout(heading), |ui| cell(row, column, ui));
                    });
                }
            });
        });
    });
}
