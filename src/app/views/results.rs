//! The results of fits as a table for a paper: a row for each parameter, a column for each measurement
//! and model, values as `2.049(23)`.

use crate::app::jobs::memo::Memo;
use crate::app::storage::export::ExportKind;
use crate::app::text::i18n::{self, Language};
use crate::app::text::messages::WindowWording;
use crate::app::views::action::Action;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::open_measurement::{OpenMeasurement, title_of};
use crate::app::work::workspace::Workspace;
use crate::report::{ResultCells, ResultColumn, ResultTable, TableFormat};
use egui::{Button, Grid, RichText, Role, ScrollArea, TextWrapMode, Ui, WidgetInfo};
use pbrdf::model::{PRESETS, Parameter};
use std::collections::BTreeSet;
use std::sync::Arc;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Results",
    tooltip: "Fits side by side as a table for a paper, to copy and export: a column for each measurement and model",
    shortcut: None,
    has_options: false,
    has_figure: false,
    new: || Box::new(ResultsView::default()),
};

/// A column by its measurement's number and its model's key; empty for terms without a name.
type ColumnId = (u64, &'static str);

/// The row by which columns are sorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SortRow {
    Parameter(Parameter),
    DeltaE,
    Aicc,
    Rows,
}

/// What the table depends on: each fit by its number and whether its intervals are known, its title; the
/// order; the language.
type Key = (Vec<(usize, Option<bool>, String)>, Option<(SortRow, bool)>, Language);

/// A fit that becomes a column, with its title.
type TitledFit<'a> = (ColumnId, &'a Arc<FitEntry>, String);

/// What the pane keeps.
#[derive(Default)]
pub struct ResultsView {
    hidden: BTreeSet<ColumnId>,
    /// Upwards or downwards.
    sorted: Option<(SortRow, bool)>,
    table: Memo<Key, Shown>,
}

/// The table as it is drawn.
struct Shown {
    table: ResultTable,
    /// Which column is whose.
    ids: Vec<ColumnId>,
    /// The numbers of their fits.
    fits: Vec<usize>,
    cells: ResultCells,
    /// What each row of cells is about.
    rows: Vec<SortRow>,
}

/// The newest fit of each measurement and model: measurements in the order of their list, then those that
/// are closed; models from the fewest terms to the most.
fn newest_fits(work: &Workspace) -> Vec<(ColumnId, &Arc<FitEntry>)> {
    let id = |fit: &FitEntry| (fit.number, fit.preset().map_or("", |preset| preset.key));
    let mut newest: Vec<(ColumnId, &Arc<FitEntry>)> = Vec::new();
    for fit in work.fit_history().iter() {
        let id = id(fit);
        if newest.iter().all(|(other, _)| *other != id) {
            newest.push((id, fit));
        }
    }
    let place = |number: u64| work.measurements().iter().position(|open| open.number == number).unwrap_or(usize::MAX);
    let rank = |key: &str| PRESETS.iter().position(|preset| preset.key == key).unwrap_or(PRESETS.len());
    newest.sort_by_key(|((number, key), _)| (place(*number), *number, rank(key)));
    newest
}

/// The title of a column: its model, and its measurement where there are several.
fn title(fit: &FitEntry, is_single: bool, work: &Workspace) -> String {
    let model = fit.preset().map_or_else(|| tr!("own terms"), |preset| preset.key.to_owned());
    let name = work.measurements().get(fit.number).map_or_else(|| title_of(&fit.document), OpenMeasurement::title);
    if is_single { model } else { format!("{name}, {model}") }
}

/// What columns are sorted by; none where a fit has no such number.
fn sort_value(column: &ResultColumn, row: SortRow) -> Option<f64> {
    match row {
        SortRow::Parameter(parameter) => {
            column.estimates.iter().find(|estimate| estimate.parameter == parameter).map(|estimate| estimate.value)
        }
        SortRow::DeltaE => column.delta_e,
        SortRow::Aicc => column.aicc,
        #[expect(clippy::cast_precision_loss, reason = "a number of rows")]
        SortRow::Rows => Some(column.rows as f64),
    }
}

impl Shown {
    fn new(mut columns: Vec<(ColumnId, usize, ResultColumn)>, sorted: Option<(SortRow, bool)>) -> Self {
        if let Some((row, is_downwards)) = sorted {
            // Columns without such a number come last either way.
            let value = |column: &ResultColumn| sort_value(column, row).map(|value| if is_downwards { -value } else { value });
            columns.sort_by(|(.., one), (.., other)| {
                let [one, other] = [one, other].map(|column| value(column).unwrap_or(f64::INFINITY));
                one.total_cmp(&other)
            });
        }
        let has = |parameter: &Parameter| {
            columns.iter().any(|(.., column)| column.estimates.iter().any(|estimate| estimate.parameter == *parameter))
        };
        let rows = Parameter::ALL.into_iter().filter(has).map(SortRow::Parameter);
        let rows = rows.chain([SortRow::DeltaE, SortRow::Aicc, SortRow::Rows]).collect();
        let ids = columns.iter().map(|(id, ..)| *id).collect();
        let fits = columns.iter().map(|(_, fit, _)| *fit).collect();
        let table = ResultTable { columns: columns.into_iter().map(|(.., column)| column).collect() };
        let cells = table.cells(&WindowWording);
        Self { table, ids, fits, cells, rows }
    }
}

impl ResultsView {
    /// The columns that are shown, and what the table depends on.
    fn columns<'a>(&self, work: &'a Workspace) -> (Key, Vec<TitledFit<'a>>) {
        let fits: Vec<_> = newest_fits(work).into_iter().filter(|(id, _)| !self.hidden.contains(id)).collect();
        let is_single = fits.iter().all(|((number, _), _)| *number == fits[0].0.0);
        let columns: Vec<_> = fits.into_iter().map(|(id, fit)| (id, fit, title(fit, is_single, work))).collect();
        let key = columns.iter().map(|(_, fit, title)| (fit.id, fit.report.course.intervals_complete, title.clone())).collect();
        ((key, self.sorted, i18n::current()), columns)
    }

    fn made(&self, columns: Vec<TitledFit<'_>>) -> Shown {
        let column = |(id, fit, title): TitledFit<'_>| {
            let rows = fit.data.rows.len() - fit.mask.len();
            let column = match &fit.joint {
                Some(part) => ResultColumn::of_set(title, &part.of.result, part.set, rows),
                None => ResultColumn::single(title, &fit.report, rows),
            };
            (id, fit.id, column)
        };
        Shown::new(columns.into_iter().map(column).collect(), self.sorted)
    }

    fn bar_ui(&mut self, is_empty: bool, cx: &mut Cx<'_>, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label(tr!("Copy as"));
            for (format, name) in [(TableFormat::Csv, "CSV"), (TableFormat::Markdown, "Markdown"), (TableFormat::Latex, "LaTeX")] {
                let help = tr!("The table as it is shown, to the clipboard");
                if ui.add_enabled(!is_empty, Button::new(name)).on_hover_text(help).clicked() {
                    cx.actions.push(Action::CopyResults(format));
                }
            }
            let help = tr!("The table as it is shown, into a file: .csv, .md or .tex");
            if ui.add_enabled(!is_empty, Button::new(tr!("Export table…"))).on_hover_text(help).clicked() {
                cx.actions.push(Action::ChooseExport(ExportKind::Results));
            }
            if !self.hidden.is_empty() && ui.button(tr!("Show hidden columns ({})", self.hidden.len())).clicked() {
                self.hidden.clear();
            }
            if self.sorted.is_some() && ui.button(tr!("Original order")).clicked() {
                self.sorted = None;
            }
        });
    }

    /// The titles, each with a menu. The answer is a column to hide.
    fn titles_ui(shown: &Shown, cx: &mut Cx<'_>, ui: &mut Ui) -> Option<ColumnId> {
        let mut hidden = None;
        ui.label("");
        for ((title, &id), &fit) in shown.cells.head.iter().skip(1).zip(&shown.ids).zip(&shown.fits) {
            // The model under its measurement: columns are as wide as their values.
            let text = title.rsplit_once(", ").map_or_else(|| title.clone(), |(name, model)| format!("{name}\n{model}"));
            let response = ui.menu_button(RichText::new(text).strong(), |ui| {
                let place = cx.work.fit_history().rows(cx.work.active().number).position(|entry| entry.id == fit);
                if ui.button(tr!("Show this fit")).on_hover_text(tr!("Its measurement, its values and its result")).clicked() {
                    cx.actions.extend(place.map(Action::ReturnToFit));
                    ui.close();
                }
                if ui.button(tr!("Hide this column")).clicked() {
                    hidden = Some(id);
                    ui.close();
                }
            });
            response.response.widget_info(|| WidgetInfo::labeled(Role::Button, true, title));
            response.response.on_hover_text(tr!("Show this fit, or hide the column"));
        }
        ui.end_row();
        hidden
    }

    /// The name of a row; a click sorts by it, a second one the other way round.
    fn row_name_ui(&mut self, row: SortRow, name: &str, ui: &mut Ui) {
        let mark = match self.sorted {
            Some((by, false)) if by == row => " ▲",
            Some((by, true)) if by == row => " ▼",
            _ => "",
        };
        let button = ui.add(Button::new(format!("{name}{mark}")).frame(false)).on_hover_text(tr!("Sort the columns by this row"));
        button.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Sort by {}", name)));
        if button.clicked() {
            self.sorted = match self.sorted {
                Some((by, false)) if by == row => Some((row, true)),
                Some((by, true)) if by == row => None,
                _ => Some((row, false)),
            };
        }
    }

    fn table_ui(&mut self, shown: &Shown, cx: &mut Cx<'_>, ui: &mut Ui) {
        Grid::new("results").striped(true).spacing([14.0, 4.0]).show(ui, |ui| {
            ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
            self.hidden.extend(Self::titles_ui(shown, cx, ui));
            for (&row, cells) in shown.rows.iter().zip(&shown.cells.rows) {
                for (place, cell) in cells.iter().enumerate() {
                    match place {
                        0 => self.row_name_ui(row, cell, ui),
                        _ => _ = ui.label(cell),
                    }
                }
                ui.end_row();
            }
        });
        ui.add_space(4.0);
        for note in &shown.cells.notes {
            ui.weak(note);
        }
    }
}

impl View for ResultsView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (key, columns) = self.columns(cx.work);
        let mut table = std::mem::take(&mut self.table);
        table.refresh(key, |_| self.made(columns));
        self.table = table;
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let table = std::mem::take(&mut self.table);
        let shown = table.get();
        let is_empty = shown.is_none_or(|shown| shown.ids.is_empty());
        self.bar_ui(is_empty, cx, ui);
        if cx.work.fit_history().is_empty() {
            ui.label(tr!("There is no fit yet. Fit (F5), or compare all models: each fit becomes a column."));
        }
        if let Some(shown) = shown.filter(|_| !is_empty) {
            ScrollArea::both().auto_shrink([false; 2]).show(ui, |ui| self.table_ui(shown, cx, ui));
        }
        self.table = table;
    }

    fn table(&self, cx: &Cx<'_>) -> Option<ResultTable> {
        let table = self.made(self.columns(cx.work).1).table;
        (!table.columns.is_empty()).then_some(table)
    }
}
