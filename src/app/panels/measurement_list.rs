//! The open measurements: which are drawn, which one the sliders belong to, and how far each surface
//! is from its data.

use crate::app::panels::list_row::{HEIGHT, Renaming, before_ui, button_width, colors_ui, item_ui, row};
use crate::app::panels::tooltip_right::TooltipRight as _;
use crate::app::plots::{symbol_shapes, theme};
use crate::app::text::i18n::translated;
use crate::app::text::numbers::short;
use crate::app::views::Cx;
use crate::app::views::action::{Action, ListAction};
use crate::app::work::edit::Edit;
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::open_measurement::{MeasurementStyle, OpenMeasurement};
use crate::figure::Symbol;
use egui::{Align, Button, CollapsingHeader, Layout, Response, RichText, Role, ScrollArea, Sense, Ui, WidgetInfo, vec2};
use tr::tr;

/// What the panel keeps.
#[derive(Debug, Default)]
pub struct MeasurementPanel {
    /// By the number of the measurement.
    renaming: Option<Renaming<u64>>,
}

/// Widths of columns in points: names have what is left.
const SHOWN: f32 = 20.0;
const SYMBOL: f32 = 18.0;
const WAVELENGTH: f32 = 36.0;
const ROWS: f32 = 34.0;
const DELTA_E: f32 = 52.0;
const MENU: f32 = 22.0;
/// Rows that are seen at once.
const MOST_ROWS: f32 = 6.5;
/// Letters of numbers.
const LETTERS: f32 = 11.5;

impl MeasurementPanel {
    /// Lets the user type another name.
    pub fn rename(&mut self, open: &OpenMeasurement) {
        self.renaming = Some(Renaming::new(open.number, open.title()));
    }

    /// The list, where anything is open that was measured.
    pub fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let list = cx.work.measurements();
        if !list.has_rows() {
            return;
        }
        let title = tr!("Measurements ({})", list.iter().count());
        let header = CollapsingHeader::new(title).id_salt("measurements").default_open(true);
        header.show_unindented(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(4.0, 2.0);
            let columns = Columns::of(list, ui.available_width());
            headings_ui(columns, ui);
            let scroll = ScrollArea::vertical().id_salt("measurements").max_height(MOST_ROWS * (HEIGHT + 2.0));
            scroll.auto_shrink([false, true]).show(ui, |ui| list.iter().for_each(|open| self.row_ui(open, columns, cx, ui)));
        });
    }

    fn row_ui(&mut self, open: &OpenMeasurement, columns: Columns, cx: &mut Cx<'_>, ui: &mut Ui) {
        let is_active = open.number == cx.work.active().number;
        let name = open.title();
        row(ui, |ui| {
            shown_ui(open, is_active, cx, ui);
            let (symbol, _) = ui.allocate_exact_size(vec2(SYMBOL, HEIGHT), Sense::hover());
            let ink = theme::series(open.style.color, ui.visuals().dark_mode);
            ui.painter().extend(symbol_shapes(open.style.marker, symbol.center(), ink));
            before_ui(columns.width(ui.spacing().item_spacing.x) + MENU, ui, |ui| {
                ui.spacing_mut().button_padding.x = 4.0;
                self.name_ui(open, is_active, cx, ui);
            });
            ui.spacing_mut().button_padding.x = 4.0;
            if columns.wavelength {
                number_ui(open.wavelength_nm().map_or_else(String::new, short), WAVELENGTH, ui);
            }
            if columns.rows {
                number_ui(open.measurement.rows.len().to_string(), ROWS, ui);
            }
            let delta_e = cx.derived.delta_e_of(open.number);
            let delta_e = number_ui(delta_e.map_or_else(|| "–".to_owned(), |value| format!("{value:.2e}")), DELTA_E, ui);
            delta_e.on_hover_right(ui, tr!("ΔE of the surface of {}", name));
            let menu = ui.menu_button("…", |ui| self.menu_ui(open, cx, ui)).response;
            menu.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Actions for {}", name)));
        });
    }

    /// The name, or the field that it is typed into.
    fn name_ui(&mut self, open: &OpenMeasurement, is_active: bool, cx: &mut Cx<'_>, ui: &mut Ui) {
        if let Some(renaming) = self.renaming.as_mut().filter(|renaming| renaming.key == open.number) {
            if let Some(name) = renaming.ui(&open.title(), &tr!("Name of the measurement"), ui) {
                cx.edits.extend(name.map(|name| Edit::RenameMeasurement { number: open.number, name }));
                self.renaming = None;
            }
            return;
        }
        let name = open.title();
        let button = ui.add(Button::selectable(is_active, fitting(&name, ui)).truncate());
        if button.clicked() {
            cx.edits.push(Edit::Activate(open.number));
        }
        if button.double_clicked() {
            self.rename(open);
        }
        button.context_menu(|ui| self.menu_ui(open, cx, ui));
        button.on_hover_right(ui, format!("{}\n{}", open.description(), tr!("A click shows it, a double click renames it.")));
    }

    /// What can be done with a measurement.
    fn menu_ui(&mut self, open: &OpenMeasurement, cx: &mut Cx<'_>, ui: &mut Ui) {
        let number = open.number;
        if item_ui(ui, tr!("Rename"), true) {
            self.rename(open);
        }
        let color = colors_ui(open.style.color, ui);
        let style = color.map(|color| MeasurementStyle { color, ..open.style });
        cx.edits.extend(style.map(|style| Edit::SetMeasurementStyle { number, style }));
        ui.menu_button(tr!("Marker"), |ui| markers_ui(open, cx, ui));
        ui.separator();
        let list = cx.work.measurements();
        let (first, last) = (list.iter().next(), list.iter().last());
        let is = |other: Option<&OpenMeasurement>| other.is_some_and(|other| other.number == number);
        for (text, by, is_possible) in [(tr!("Move up"), -1, !is(first)), (tr!("Move down"), 1, !is(last))] {
            if item_ui(ui, text, is_possible) {
                cx.edits.push(Edit::MoveMeasurement { number, by });
            }
        }
        let others = || list.iter().filter(|other| other.number != number);
        for (text, shown) in [(tr!("Hide all others"), false), (tr!("Show all others"), true)] {
            if item_ui(ui, text, others().any(|other| other.style.shown != shown)) {
                let style = |other: &OpenMeasurement| MeasurementStyle { shown, ..other.style };
                cx.edits.extend(others().map(|other| Edit::SetMeasurementStyle { number: other.number, style: style(other) }));
            }
        }
        ui.separator();
        if item_ui(ui, tr!("Close"), true) {
            cx.actions.push(Action::List(ListAction::Close(Some(number))));
        }
    }
}

/// Which numbers stand beside the names.
#[derive(Clone, Copy)]
struct Columns {
    wavelength: bool,
    rows: bool,
}

/// Width of the panel from which numbers of rows, which the status line has too, leave names their room.
const WITH_ROWS: f32 = 340.0;

impl Columns {
    fn of(list: &MeasurementList, width: f32) -> Self {
        let is_wide = width >= WITH_ROWS;
        let known = list.iter().filter(|open| open.wavelength_nm().is_some()).count();
        // A column that no file fills, or that tells nothing apart, would be room that names lack.
        Self { wavelength: known > usize::from(!is_wide), rows: is_wide }
    }

    /// In points, with the gap before each, that of ΔE included.
    fn width(self, gap: f32) -> f32 {
        let shown = [(self.wavelength, WAVELENGTH), (self.rows, ROWS), (true, DELTA_E)];
        shown.into_iter().filter(|(is_shown, _)| *is_shown).map(|(_, width)| width + gap).sum()
    }
}

/// A name in letters of its size, or in those of numbers where it has no room otherwise.
fn fitting(name: &str, ui: &Ui) -> RichText {
    let is_long = button_width(name, ui) > ui.available_width();
    let text = RichText::new(name);
    if is_long { text.size(LETTERS) } else { text }
}

fn headings_ui(columns: Columns, ui: &mut Ui) {
    row(ui, |ui| {
        ui.add_space(SHOWN + SYMBOL + 2.0 * ui.spacing().item_spacing.x);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(MENU + ui.spacing().item_spacing.x);
            for (heading, width, help, _) in [
                ("ΔE", DELTA_E, "How far the surface of each measurement is from its data", true),
                ("rows", ROWS, "Rows of the table, masked ones included", columns.rows),
                ("λ / nm", WAVELENGTH, "Vacuum wavelength, where the file states one", columns.wavelength),
            ]
            .into_iter()
            .filter(|(.., is_shown)| *is_shown)
            {
                number_ui(RichText::new(translated(heading)).weak(), width, ui).on_hover_right(ui, translated(help));
            }
        });
    });
}

/// A number at the right end of its column.
fn number_ui(text: impl Into<RichText>, width: f32, ui: &mut Ui) -> Response {
    let layout = Layout::right_to_left(Align::Center);
    ui.allocate_ui_with_layout(vec2(width, HEIGHT), layout, |ui| {
        ui.set_min_width(width);
        ui.add(egui::Label::new(text.into().size(LETTERS)).extend())
    })
    .inner
}

/// Whether it is drawn; the active one always is.
fn shown_ui(open: &OpenMeasurement, is_active: bool, cx: &mut Cx<'_>, ui: &mut Ui) {
    let mut shown = open.style.shown || is_active;
    let checkbox = ui.add_enabled(!is_active, egui::Checkbox::without_text(&mut shown));
    checkbox.widget_info(|| WidgetInfo::selected(Role::CheckBox, !is_active, shown, tr!("Show {}", open.title())));
    if checkbox.changed() {
        let style = MeasurementStyle { shown, ..open.style };
        cx.edits.push(Edit::SetMeasurementStyle { number: open.number, style });
    }
    let help = if is_active { tr!("The active measurement is always drawn") } else { tr!("Whether it is drawn beside the active one") };
    checkbox.on_hover_right(ui, help);
}

fn markers_ui(open: &OpenMeasurement, cx: &mut Cx<'_>, ui: &mut Ui) {
    for (marker, name) in
        [(Symbol::Disc, tr!("disc")), (Symbol::Circle, tr!("circle")), (Symbol::Square, tr!("square")), (Symbol::Cross, tr!("cross"))]
    {
        if ui.selectable_label(marker == open.style.marker, name).clicked() {
            let style = MeasurementStyle { marker, ..open.style };
            cx.edits.push(Edit::SetMeasurementStyle { number: open.number, style });
            ui.close();
        }
    }
}
