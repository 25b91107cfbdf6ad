//! The results of fits as a table for a paper: a row for each parameter, a column for each measurement
//! and model, values as `2.049(23)`.

use crate::app::jobs::memo::Memo;
use crate::app::storage::export::ExportKind;
use crate::app::text::i18n::{self, Language, translated};
use crate::app::text::messages::WindowWording;
use crate::app::views::action::Action;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::edit::Edit;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::open_measurement::{OpenMeasurement, title_of};
use crate::app::work::results_options::{ResultColumnId, ResultRow, ResultsOptions};
use crate::app::work::workspace::Workspace;
use crate::report::{ResultCells, ResultColumn, ResultTable, TableFormat};
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Button, Grid, PopupCloseBehavior, RichText, Role, ScrollArea, TextWrapMode, Ui, WidgetInfo};
use pbrdf::model::{PRESETS, Parameter, Preset};
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

/// What the table depends on: each fit by its number and whether its intervals are known, its title; the
/// order; the language.
type Key = (Vec<(usize, Option<bool>, String)>, Option<(ResultRow, bool)>, Language);

/// A fit that becomes a column, with its title.
type TitledFit<'a> = (ResultColumnId, &'a Arc<FitEntry>, String);

/// What the pane keeps.
#[derive(Default)]
pub struct ResultsView {
    table: Memo<Key, Shown>,
    /// All columns that there are, hidden ones too.
    all: Vec<ResultColumnId>,
}

/// The table as it is drawn.
struct Shown {
    table: ResultTable,
    /// Which column is whose.
    ids: Vec<ResultColumnId>,
    /// The numbers of their fits.
    fits: Vec<usize>,
    cells: ResultCells,
    /// What each row of cells is about.
    rows: Vec<ResultRow>,
}

/// The newest fit of each measurement and model: measurements in the order of their list, then those that
/// are closed; models from the fewest terms to the most.
fn newest_fits(work: &Workspace) -> Vec<&Arc<FitEntry>> {
    let id = |fit: &FitEntry| (fit.number, fit.preset().map_or("", |preset| preset.key));
    let mut newest: Vec<((u64, &'static str), &Arc<FitEntry>)> = Vec::new();
    for fit in work.fit_history().iter() {
        let id = id(fit);
        if newest.iter().all(|(other, _)| *other != id) {
            newest.push((id, fit));
        }
    }
    let place = |number: u64| work.measurements().iter().position(|open| open.number == number).unwrap_or(usize::MAX);
    let rank = |key: &str| PRESETS.iter().position(|preset| preset.key == key).unwrap_or(PRESETS.len());
    newest.sort_by_key(|((number, key), _)| (place(*number), *number, rank(key)));
    newest.into_iter().map(|(_, fit)| fit).collect()
}

/// Which column a fit is, under the name that its measurement has now.
fn column_of(fit: &FitEntry, work: &Workspace) -> ResultColumnId {
    let measurement = work.measurements().get(fit.number).map_or_else(|| fit.document.clone(), |open| open.name.clone());
    ResultColumnId { measurement, model: fit.preset().map_or_else(String::new, |preset| preset.key.to_owned()) }
}

/// The title of a column: its model, and its measurement where there are several.
fn title(fit: &FitEntry, is_single: bool, work: &Workspace) -> String {
    let model = fit.preset().map_or_else(|| tr!("own terms"), |preset| preset.key.to_owned());
    let name = work.measurements().get(fit.number).map_or_else(|| title_of(&fit.document), OpenMeasurement::title);
    if is_single { model } else { format!("{name}, {model}") }
}

/// What columns are sorted by; none where a fit has no such number.
fn sort_value(column: &ResultColumn, row: ResultRow) -> Option<f64> {
    match row {
        ResultRow::Parameter(parameter) => {
            column.estimates.iter().find(|estimate| estimate.parameter == parameter).map(|estimate| estimate.value)
        }
        ResultRow::DeltaE => column.delta_e,
        ResultRow::Aicc => column.aicc,
        #[expect(clippy::cast_precision_loss, reason = "a number of rows")]
        ResultRow::Rows => Some(column.rows as f64),
    }
}

impl Shown {
    fn new(mut columns: Vec<(ResultColumnId, usize, ResultColumn)>, sorted: Option<(ResultRow, bool)>) -> Self {
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
        let rows = Parameter::ALL.into_iter().filter(has).map(ResultRow::Parameter);
        let rows = rows.chain([ResultRow::DeltaE, ResultRow::Aicc, ResultRow::Rows]).collect();
        let ids = columns.iter().map(|(id, ..)| id.clone()).collect();
        let fits = columns.iter().map(|(_, fit, _)| *fit).collect();
        let table = ResultTable { columns: columns.into_iter().map(|(.., column)| column).collect() };
        let cells = table.cells(&WindowWording);
        Self { table, ids, fits, cells, rows }
    }
}

/// The columns that are shown, and what the table depends on.
fn shown_columns(work: &Workspace) -> (Key, Vec<TitledFit<'_>>) {
    let options = &work.settings().panes.results;
    let fits = newest_fits(work).into_iter().map(|fit| (column_of(fit, work), fit));
    let fits: Vec<_> = fits.filter(|(id, _)| !options.is_hidden(id)).collect();
    let is_single = fits.iter().all(|(_, fit)| fit.number == fits[0].1.number);
    let columns: Vec<_> = fits.into_iter().map(|(id, fit)| (id, fit, title(fit, is_single, work))).collect();
    let key = columns.iter().map(|(_, fit, title)| (fit.id, fit.report.course.intervals_complete, title.clone())).collect();
    ((key, options.sorted, i18n::current()), columns)
}

fn made(columns: Vec<TitledFit<'_>>, sorted: Option<(ResultRow, bool)>) -> Shown {
    let column = |(id, fit, title): TitledFit<'_>| {
        let rows = fit.data.rows.len() - fit.mask.len();
        let column = match &fit.joint {
            Some(part) => ResultColumn::of_set(title, &part.of.result, part.set, rows),
            None => ResultColumn::single(title, &fit.report, rows),
        };
        (id, fit.id, column)
    };
    Shown::new(columns.into_iter().map(column).collect(), sorted)
}

/// Copies, exports, and the ways back to the whole table.
fn bar_ui(is_empty: bool, all: &[ResultColumnId], options: &mut ResultsOptions, cx: &mut Cx<'_>, ui: &mut Ui) {
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
        models_ui(all, options, ui);
        if !options.hidden.is_empty() && ui.button(tr!("Show hidden columns ({})", options.hidden.len())).clicked() {
            options.hidden.clear();
        }
        if options.sorted.is_some() && ui.button(tr!("Original order")).clicked() {
            options.sorted = None;
        }
    });
}

/// Which models have columns, where there are several.
fn models_ui(all: &[ResultColumnId], options: &mut ResultsOptions, ui: &mut Ui) {
    let mut models: Vec<&str> = Vec::new();
    for column in all.iter().filter(|column| !column.model.is_empty()) {
        if !models.contains(&&*column.model) {
            models.push(&column.model);
        }
    }
    if models.len() < 2 {
        return;
    }
    // It stays open while boxes are ticked.
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    MenuButton::new(tr!("Models")).config(config).ui(ui, |ui| {
        for model in models {
            let name = Preset::from_key(model).map_or_else(|| model.to_owned(), |preset| translated(preset.name));
            let of_model = || all.iter().filter(|column| column.model == model);
            let mut is_shown = of_model().any(|column| !options.is_hidden(column));
            if ui.checkbox(&mut is_shown, name).changed() {
                options.hidden.retain(|column| column.model != model);
                options.hidden.extend(of_model().filter(|_| !is_shown).cloned());
            }
        }
    });
}

/// The titles, each with a menu.
fn titles_ui(shown: &Shown, all: &[ResultColumnId], options: &mut ResultsOptions, cx: &mut Cx<'_>, ui: &mut Ui) {
    ui.allocate_space(egui::Vec2::ZERO);
    for ((title, id), &fit) in shown.cells.head.iter().skip(1).zip(&shown.ids).zip(&shown.fits) {
        // The model under its measurement: columns are as wide as their values.
        let text = title.rsplit_once(", ").map_or_else(|| title.clone(), |(name, model)| format!("{name}\n{model}"));
        let response = ui.menu_button(RichText::new(text).strong(), |ui| {
            let place = cx.work.fit_history().rows(cx.work.active().number).position(|entry| entry.id == fit);
            if ui.button(tr!("Show this fit")).on_hover_text(tr!("Its measurement, its values and its result")).clicked() {
                cx.actions.extend(place.map(Action::ReturnToFit));
                ui.close();
            }
            if ui.button(tr!("Hide this column")).clicked() {
                options.hidden.push(id.clone());
                ui.close();
            }
            if all.iter().any(|other| other.model != id.model) && ui.button(tr!("Show this model alone")).clicked() {
                options.hidden = all.iter().filter(|other| other.model != id.model).cloned().collect();
                ui.close();
            }
        });
        response.response.widget_info(|| WidgetInfo::labeled(Role::Button, true, title));
        response.response.on_hover_text(tr!("Show this fit, or hide the column"));
    }
    ui.end_row();
}

/// The name of a row; a click sorts by it, a second one the other way round.
fn row_name_ui(sorted: &mut Option<(ResultRow, bool)>, row: ResultRow, name: &str, ui: &mut Ui) {
    let mark = match *sorted {
        Some((by, false)) if by == row => " ▲",
        Some((by, true)) if by == row => " ▼",
        _ => "",
    };
    let button = ui.add(Button::new(format!("{name}{mark}")).frame(false)).on_hover_text(tr!("Sort the columns by this row"));
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Sort by {}", name)));
    if button.clicked() {
        *sorted = match *sorted {
            Some((by, false)) if by == row => Some((row, true)),
            Some((by, true)) if by == row => None,
            _ => Some((row, false)),
        };
    }
}

fn table_ui(shown: &Shown, all: &[ResultColumnId], options: &mut ResultsOptions, cx: &mut Cx<'_>, ui: &mut Ui) {
    Grid::new("results").striped(true).spacing([14.0, 4.0]).show(ui, |ui| {
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        titles_ui(shown, all, options, cx, ui);
        for (&row, cells) in shown.rows.iter().zip(&shown.cells.rows) {
            for (place, cell) in cells.iter().enumerate() {
                match place {
                    0 => row_name_ui(&mut options.sorted, row, cell, ui),
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

impl View for ResultsView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        self.all = newest_fits(cx.work).into_iter().map(|fit| column_of(fit, cx.work)).collect();
        let (key, columns) = shown_columns(cx.work);
        self.table.refresh(key, |(_, sorted, _)| made(columns, *sorted));
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let shown = self.table.get();
        let is_empty = shown.is_none_or(|shown| shown.ids.is_empty());
        let before = &cx.work.settings().panes.results;
        let mut options = before.clone();
        bar_ui(is_empty, &self.all, &mut options, cx, ui);
        if cx.work.fit_history().is_empty() {
            ui.label(tr!("There is no fit yet. Fit (F5), or compare all models: each fit becomes a column."));
        }
        if let Some(shown) = shown.filter(|_| !is_empty) {
            ScrollArea::both().auto_shrink([false; 2]).show(ui, |ui| table_ui(shown, &self.all, &mut options, cx, ui));
        }
        if options != *before {
            cx.edits.push(Edit::SetResultsOptions(options));
        }
    }

    fn table(&self, cx: &Cx<'_>) -> Option<ResultTable> {
        let ((_, sorted, _), columns) = shown_columns(cx.work);
        let table = made(columns, sorted).table;
        (!table.columns.is_empty()).then_some(table)
    }
}
