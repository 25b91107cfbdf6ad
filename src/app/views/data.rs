//! The measurement row by row, with what the model gives there; masks by row and by series.

use crate::app::jobs::memo::Memo;
use crate::app::text::explained::Explained as _;
use crate::app::text::glossary::mask_help;
use crate::app::text::i18n::translated;
use crate::app::text::numbers::{short, significant};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::{IncidenceSeries, OpenMeasurement};
use crate::app::work::workspace::Workspace;
use egui::{Align, Checkbox, CollapsingHeader, Key, Layout, Role, ScrollArea, Ui, WidgetInfo};
use egui_extras::{Column, TableBuilder, TableRow};
use pbrdf::measurement::{Quantity, Row};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::{Facet, shortest};
use pbrdf::rounding;
use std::ops::Range;
use tr::tr;

/// What the model gives in one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Predicted {
    pub dolp: f64,
    pub brdf: f64,
}

/// What the model in the seen rows depends on: the sliders, the document's generation, the rows.
type PredictedKey = (Parameters, Model, u64, Range<usize>);

pub static SPEC: PaneSpec = PaneSpec {
    title: "Data table",
    tooltip: "The measurement row by row with the model's values; masks by row and by series; metadata",
    shortcut: Some(Key::Num9),
    has_options: false,
    has_figure: false,
    new: || Box::new(DataView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct DataView {
    /// The rows that the last frame drew.
    visible: Range<usize>,
    /// The model in those rows.
    pub predicted: Memo<PredictedKey, Vec<Predicted>>,
    /// Decimals of DoLP, by the measurement's generation.
    decimals: Memo<u64, usize>,
}

/// Rows that say how many decimals all have.
const LOOKED_AT: usize = 1000;
/// Decimals at most.
const MOST_DECIMALS: usize = 6;

/// Decimals of the measured DoLP: with the same in every row, points stand below each other.
fn decimals(rows: &[Row]) -> usize {
    let values = rows.iter().take(LOOKED_AT).filter_map(|row| row.dolp);
    let of = |value: f64| significant(value).split_once('.').map_or(0, |(_, decimals)| decimals.len());
    values.map(|dolp| of(dolp.value)).max().unwrap_or(0).clamp(2, MOST_DECIMALS)
}

impl View for DataView {
    /// Evaluates the rows that are seen, and no others: there may be a million.
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let surface = cx.work.surface();
        let rows = &cx.work.active().measurement.rows;
        let visible = self.visible.start.min(rows.len())..self.visible.end.min(rows.len());
        let key = (surface.parameters, surface.model, cx.work.active().generation, visible);
        self.predicted.refresh(key, |(parameters, model, _, visible)| {
            let Ok(surface) = Pbrdf::new(*model, *parameters) else { return Vec::new() };
            let predict = |row: &Row| {
                let reflection = surface.reflection(&Facet::new(row.geometry));
                Predicted { dolp: reflection.dolp, brdf: reflection.brdf }
            };
            rows[visible.clone()].iter().map(predict).collect()
        });
        self.decimals.refresh(cx.work.active().generation, |_| decimals(rows));
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        metadata_ui(cx.work.active(), ui);
        series_ui(cx.work.active(), cx.edits, ui);
        let visible = rows_ui(cx.work.active(), self, cx.edits, ui);
        if visible != self.visible {
            self.visible = visible;
            // The model in the new rows is evaluated before the next frame.
            ui.ctx().request_repaint();
        }
    }
}

/// All rows as the pane shows them, with all digits, and with tabs between cells.
pub fn table_text(work: &Workspace) -> String {
    let (surface, measurement) = (work.surface(), &work.active().measurement);
    let surface = Pbrdf::new(surface.model, surface.parameters).ok();
    let shown = [("DoLP", measurement.has_dolp()), ("BRDF", measurement.has_brdf())];
    let mut headings: Vec<String> = ["row", "mask"].map(translated).into();
    headings.extend(ANGLES.map(|(heading, ..)| heading.to_owned()));
    for (name, _) in shown.iter().filter(|(_, is_there)| *is_there) {
        let others = ["± s.d.", "model", "residual"].map(|heading| format!("{name} {}", translated(heading)));
        headings.extend(std::iter::once((*name).to_owned()).chain(others));
    }
    let mut lines = vec![headings.join("\t")];
    for (index, row) in measurement.rows.iter().enumerate() {
        let geometry = row.geometry;
        let mut cells = vec![(index + 1).to_string(), u8::from(row.masked).to_string()];
        cells.extend([geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0].map(shortest));
        let reflection = surface.as_ref().map(|surface| surface.reflection(&Facet::new(geometry)));
        let dolp = (row.dolp, reflection.map(|reflection| reflection.dolp));
        let brdf = (row.brdf, reflection.map(|reflection| reflection.brdf));
        for (measured, model) in [dolp, brdf].into_iter().zip(shown).filter(|(_, (_, is_there))| *is_there).map(|(values, _)| values) {
            let value = measured.map(|measured| measured.value);
            let residual = value.zip(model).map(|(value, model)| model - value);
            let numbers = [value, measured.and_then(|measured| measured.sigma), model, residual];
            cells.extend(numbers.map(|number| number.map_or_else(String::new, shortest)));
        }
        lines.push(cells.join("\t"));
    }
    lines.join("\n") + "\n"
}

/// Height that metadata and series have at most.
const LIST_HEIGHT: f32 = 120.0;

fn metadata_ui(document: &OpenMeasurement, ui: &mut Ui) {
    let metadata = &document.measurement.metadata;
    let title = tr!("Metadata ({})", metadata.len());
    CollapsingHeader::new(title).id_salt("metadata").show(ui, |ui| {
        if metadata.is_empty() {
            ui.label(tr!("The file says nothing about itself: there are no lines of the form # key: value."));
        }
        ScrollArea::vertical().id_salt("metadata").max_height(LIST_HEIGHT).auto_shrink([false, true]).show(ui, |ui| {
            egui::Grid::new("metadata").num_columns(2).striped(true).show(ui, |ui| {
                for (key, value) in metadata {
                    ui.label(key);
                    ui.add(egui::Label::new(value).truncate());
                    ui.end_row();
                }
            });
        });
    });
}

fn series_ui(document: &OpenMeasurement, edits: &mut Vec<Edit>, ui: &mut Ui) {
    let title = tr!("Series ({})", document.series.len());
    CollapsingHeader::new(title).id_salt("series").show(ui, |ui| {
        let height = ui.spacing().interact_size.y;
        let area = ScrollArea::vertical().id_salt("series").max_height(LIST_HEIGHT).auto_shrink([false, true]);
        area.show_rows(ui, height, document.series.len(), |ui, range| {
            for series in &document.series[range] {
                one_series_ui(document, series, edits, ui);
            }
        });
    });
}

fn one_series_ui(document: &OpenMeasurement, series: &IncidenceSeries, edits: &mut Vec<Edit>, ui: &mut Ui) {
    let rows = &document.measurement.rows;
    let masked = series.rows.iter().filter(|&&row| rows[row].masked).count();
    let all = masked == series.rows.len();
    let mut wanted = all;
    let text = tr!("mask {0}: {1} of {2} rows masked", series.name(), masked, series.rows.len());
    let response = ui.add(Checkbox::new(&mut wanted, text).indeterminate(masked > 0 && !all));
    if response.on_hover_text(tr!("Leave this whole series out of every statistic, without deleting it")).changed() {
        edits.push(Edit::Mask { rows: series.rows.clone(), masked: !all });
    }
}

/// A column of numbers: heading, explanation, width.
type Heading = (&'static str, &'static str, f32);

const ANGLES: [Heading; 3] = [
    ("θi / °", "Angle of incidence", 44.0),
    ("θr / °", "Angle of view; the backscatter side has Δφ = 0 here and a negative θr in plots", 44.0),
    ("Δφ / °", "Relative azimuth φr − φi: 180 is the forward side, 0 the backscatter side", 44.0),
];
const DOLP: [Heading; 4] = [
    ("DoLP", "Measured degree of linear polarisation", 66.0),
    ("± s.d.", "Its stated standard deviation", 60.0),
    ("model", "DoLP of the model at the sliders", 66.0),
    ("residual", "Model less measurement", 68.0),
];
const BRDF: [Heading; 4] = [
    ("BRDF", "Measured BRDF in sr⁻¹", 80.0),
    ("± s.d.", "Its stated standard deviation", 80.0),
    ("model", "BRDF of the model at the sliders", 80.0),
    ("residual", "Model less measurement", 80.0),
];

/// The rows; returns those that are seen.
fn rows_ui(document: &OpenMeasurement, view: &DataView, edits: &mut Vec<Edit>, ui: &mut Ui) -> Range<usize> {
    let measurement = &document.measurement;
    let (has_dolp, has_brdf) = (measurement.has_dolp(), measurement.has_brdf());
    let headings = ANGLES.iter().chain(DOLP.iter().filter(|_| has_dolp)).chain(BRDF.iter().filter(|_| has_brdf));
    let height = ui.spacing().interact_size.y;
    let mut visible: Option<Range<usize>> = None;
    ScrollArea::horizontal().id_salt("table").auto_shrink([false; 2]).show(ui, |ui| {
        // A million rows of whole points stay apart in f32; with a gap between them they would not.
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut builder = TableBuilder::new(ui).id_salt(document.number).striped(true).auto_shrink([false; 2]);
        builder = builder.cell_layout(Layout::right_to_left(Align::Center)).column(Column::exact(38.0)).column(Column::exact(50.0));
        for (_, _, width) in headings.clone() {
            builder = builder.column(Column::exact(*width));
        }
        let table = builder.header(height, |mut header| {
            header.col(|ui| {
                ui.strong(tr!("mask")).explained(mask_help());
            });
            for (heading, help, _) in [("row", "Place in the file, from 1", 0.0)].iter().chain(headings) {
                header.col(|ui| {
                    ui.strong(translated(heading)).explained(translated(help));
                });
            }
        });
        table.body(|body| {
            body.rows(height, measurement.rows.len(), |mut line| {
                let index = line.index();
                let seen = visible.get_or_insert(index..index);
                *seen = seen.start.min(index)..seen.end.max(index + 1);
                let predicted = view.predicted.key().filter(|key| key.3.contains(&index)).and_then(|key| {
                    let values = view.predicted.get()?;
                    values.get(index - key.3.start).copied()
                });
                let decimals = view.decimals.get().copied().unwrap_or(MOST_DECIMALS);
                line_ui(&mut line, index, &measurement.rows[index], predicted, (has_dolp.then_some(decimals), has_brdf), edits);
            });
        });
    });
    visible.unwrap_or_default()
}

fn line_ui(
    line: &mut TableRow<'_, '_>,
    index: usize,
    row: &Row,
    predicted: Option<Predicted>,
    (decimals, has_brdf): (Option<usize>, bool),
    edits: &mut Vec<Edit>,
) {
    line.col(|ui| {
        let mut masked = row.masked;
        let response = ui.add(Checkbox::without_text(&mut masked));
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, masked, tr!("Mask row {}", index + 1)));
        if response.changed() {
            edits.push(Edit::Mask { rows: vec![index], masked });
        }
    });
    let mut cell = |text: String| {
        line.col(|ui| {
            if row.masked {
                ui.weak(text);
            } else {
                ui.label(text);
            }
        });
    };
    cell((index + 1).to_string());
    let geometry = row.geometry;
    for angle in [geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0] {
        cell(significant(angle));
    }
    let mut quantity = |measured: Option<Quantity>, model: Option<f64>, value: &dyn Fn(f64) -> String, rest: &dyn Fn(f64) -> String| {
        cell(measured.map_or_else(String::new, |measured| value(measured.value)));
        cell(measured.and_then(|measured| measured.sigma).map_or_else(String::new, short));
        cell(model.map_or_else(|| "…".to_owned(), value));
        cell(measured.zip(model).map_or_else(String::new, |(measured, model)| rest(model - measured.value)));
    };
    if let Some(decimals) = decimals {
        let aligned = |value: f64| format!("{value:.decimals$}");
        quantity(row.dolp, predicted.map(|predicted| predicted.dolp), &aligned, &aligned);
    }
    if has_brdf {
        // Over decades there are no common decimals.
        quantity(row.brdf, predicted.map(|predicted| predicted.brdf), &|value| rounding::significant(value, 5), &short);
    }
}
