//! Tabulated metals: n and k of every source side by side at one wavelength and along all, a button
//! that sets them, and surface finishes.

use crate::app::jobs::memo::Memo;
use crate::app::panels::{SliderStep, step_with_arrows};
use crate::app::plots::theme::{FOREGROUND, MUTED};
use crate::app::plots::{AutoRange, FigurePlot, PanelStyle, Polyline, Range, nice_ceiling, theme};
use crate::app::text::explained::Explained as _;
use crate::app::text::i18n;
use crate::app::text::i18n::{Language, translated};
use crate::app::views::action::Action;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::edit::Edit;
use crate::app::work::settings::MetalSelection;
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Dash, Figure, Panel, SERIES, Series};
use egui::{Align, ComboBox, DragValue, Layout, RichText, ScrollArea, Slider, SliderClamping, Ui, WidgetInfo};
use egui_extras::{Column, TableBuilder, TableRow};
use pbrdf::model::{FINISHES, Finish, Parameter, Parameters};
use pbrdf::optics;
use pbrdf::optics::{Metal, MetalSource, RefractiveIndex, Sample};
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Metals",
    tooltip: "Tabulated n and k of metals against wavelength, all sources side by side, and surface finishes",
    shortcut: None,
    has_options: false,
    has_figure: true,
    new: || Box::new(MetalsView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct MetalsView {
    /// The index of every source of the metal, by metal and wavelength.
    found: Memo<(String, f64), Vec<Option<RefractiveIndex>>>,
    /// n and k of every source against the wavelength.
    lines: Memo<String, Vec<[Polyline; 2]>>,
    wavelengths: AutoRange,
    ranges: [AutoRange; 2],
    plot: FigurePlot<FigureKey>,
}

/// What the figure depends on: both of the above by their stamps, the sliders n and k, the followed
/// source, the axes, the language.
type FigureKey = ([u64; 2], [f64; 2], Option<String>, [Option<Range>; 3], Language);

/// n or k of an index.
type Part = fn(RefractiveIndex) -> f64;

/// Both, in the order of the plots.
const PARTS: [(Parameter, Part); 2] = [(Parameter::N, RefractiveIndex::n), (Parameter::K, RefractiveIndex::k_m)];
/// Wavelengths in nm up to which the plots go while the chosen one is not beyond: the visible and
/// what silicon sees.
const SHORT: f64 = 1000.0;

/// The metal that is looked at; none where the bundled table is damaged, which a test of the core
/// rules out.
fn chosen(tabulated: &MetalSelection) -> Option<&'static Metal> {
    let metals = optics::metals().ok()?;
    metals.iter().find(|metal| metal.key == tabulated.metal).or(metals.first())
}

impl MetalsView {
    /// The axes, over all that is tabulated up to the wavelength that is looked at.
    fn follow(&mut self, metal: &Metal, wavelength_nm: f64, parameters: &Parameters, interacting: bool) {
        let (low, high) = metal.range_nm();
        let high = if wavelength_nm > SHORT { high.max(wavelength_nm) } else { SHORT };
        let low = low.min(MetalSelection::SHORTEST_NM);
        // Marks at the ends have room for their numbers.
        let air = 0.04 * (high - low);
        self.wavelengths.follow(Range { low: low - air, high: high + air }, interacting);
        let seen = || metal.sources.iter().flat_map(MetalSource::samples).filter(|sample: &&Sample| sample.wavelength_nm <= high);
        for ((parameter, part), range) in PARTS.into_iter().zip(&mut self.ranges) {
            let top = seen().map(|sample| part(sample.index)).fold(parameters[parameter].min(20.0), f64::max);
            let high = nice_ceiling(top);
            // The mark at 0 keeps off that of the first wavelength.
            range.follow(Range { low: -0.06 * high, high }, interacting);
        }
    }

    fn describe(&self, metal: &Metal, work: &Workspace) -> Option<Figure> {
        let (settings, surface) = (work.settings(), work.surface());
        let (lines, found) = (self.lines.get()?, self.found.get()?);
        let wavelength_nm = settings.metal_selection.wavelength_nm;
        let panels = PARTS.into_iter().enumerate().map(|(i, (parameter, part))| {
            let mut series = Vec::new();
            let sources = metal.sources.iter().zip(lines).zip(found).zip(SERIES.into_iter().cycle());
            for (((source, line), index), color) in sources {
                let is_followed = settings.metal_selection.source.as_deref() == Some(&source.key);
                let width = if is_followed { FOLLOWED } else { SOURCE };
                series.push(Series::stroke(&source.name, line[i].clone(), width, Dash::Solid).colored(color));
                if let Some(index) = index {
                    series.push(Series::points(&source.name, [[wavelength_nm, part(*index)]]).colored(color));
                }
            }
            series.push(Series::level(tr!("slider"), surface.parameters[parameter]).colored(FOREGROUND));
            series.push(Series::upright(format!("{wavelength_nm} nm"), wavelength_nm).colored(MUTED));
            let x = self.wavelengths.on(Axis::linear(tr!("wavelength"), "nm"));
            let y = self.ranges[i].on(Axis::linear(parameter.symbol(), ""));
            // The sources have the same colours in both.
            Panel { x, y, series, legend: i == 0, ..Panel::default() }
        });
        let title = name_and_symbol(metal);
        Some(Figure { title, panels: panels.collect(), width_mm: 160.0, height_mm: 170.0, ..Figure::default() })
    }

    /// n and k against the wavelength, side by side.
    fn lines_ui(&mut self, ui: &mut Ui) {
        let bottom = ui.available_height().min(ui.clip_rect().bottom() - ui.cursor().top());
        let height = (bottom - ui.spacing().item_spacing.y).max(HEIGHT);
        ui.columns(PARTS.len(), |columns| {
            for ((panel, ui), (parameter, _)) in self.plot.panels().iter_mut().zip(columns).zip(PARTS) {
                let symbol = parameter.symbol();
                let hover = |name: &str, x: f64, y: f64| format!("{name}\n{x:.1} nm\n{symbol} = {y:.4}");
                // Narrower than where plots stand one above the other.
                let style = PanelStyle { left: 44.0, ..PanelStyle::new(parameter.key(), height, &hover) };
                panel.ui(&style.named(tr!("Plot: {} against wavelength", symbol)), ui);
            }
        });
    }
}

/// Widths of the curve of a source and of that which is followed, in points of paper.
const SOURCE: f64 = 1.2;
const FOLLOWED: f64 = 2.0;

impl View for MetalsView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (settings, surface, work) = (cx.work.settings(), cx.work.surface(), cx.work);
        let Some(metal) = chosen(&settings.metal_selection) else { return };
        let wavelength_nm = settings.metal_selection.wavelength_nm;
        self.found.refresh((metal.key.clone(), wavelength_nm), |_| {
            metal.sources.iter().map(|source| source.index_at(wavelength_nm).ok()).collect()
        });
        self.lines.refresh(metal.key.clone(), |_| {
            let line = |source: &MetalSource, part: Part| -> Polyline {
                source.samples().iter().map(|sample| [sample.wavelength_nm, part(sample.index)]).collect()
            };
            metal.sources.iter().map(|source| PARTS.map(|(_, part)| line(source, part))).collect()
        });
        self.follow(metal, wavelength_nm, &surface.parameters, cx.interacting);
        let stamps = [self.found.stamp(), self.lines.stamp()];
        let sliders = PARTS.map(|(parameter, _)| surface.parameters[parameter]);
        let axes = [self.wavelengths.get(), self.ranges[0].get(), self.ranges[1].get()];
        let mut plot = std::mem::take(&mut self.plot);
        plot.refresh((stamps, sliders, settings.metal_selection.source.clone(), axes, i18n::current()), |_| self.describe(metal, work));
        self.plot = plot;
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let before = &cx.work.settings().metal_selection;
        let Some(metal) = chosen(before) else { return };
        let (mut tabulated, sliders) = (before.clone(), cx.work.surface().parameters);
        let size = ui.available_size();
        if size.y < LOW && size.x > WIDE {
            ui.horizontal_top(|ui| {
                ui.allocate_ui_with_layout(egui::vec2(TABLE * size.x, size.y), Layout::top_down(Align::Min), |ui| {
                    ScrollArea::vertical().id_salt("metals").auto_shrink([false; 2]).show(ui, |ui| {
                        self.choices_ui(&mut tabulated, metal, sliders, cx, ui);
                    });
                });
                ui.vertical(|ui| self.lines_ui(ui));
            });
        } else {
            ScrollArea::vertical().id_salt("metals").auto_shrink([false; 2]).show(ui, |ui| {
                self.choices_ui(&mut tabulated, metal, sliders, cx, ui);
                ui.add_space(4.0);
                self.lines_ui(ui);
            });
        }
        if tabulated != *before {
            cx.edits.push(Edit::SetMetalSelection(tabulated));
        }
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}

impl MetalsView {
    /// Metal, wavelength, finish, and the table of sources.
    fn choices_ui(&self, tabulated: &mut MetalSelection, metal: &Metal, sliders: Parameters, cx: &mut Cx<'_>, ui: &mut Ui) {
        let before = tabulated.clone();
        choice_ui(tabulated, metal, ui);
        wavelength_ui(&mut tabulated.wavelength_nm, cx.work.active().wavelength_nm(), ui);
        finishes_ui(cx, ui);
        // The followed source takes the sliders along the wavelength.
        if tabulated.metal == before.metal && tabulated.wavelength_nm != before.wavelength_nm && tabulated.follow {
            let followed = metal.sources.iter().find(|source| Some(&source.key) == tabulated.source.as_ref());
            let index = followed.and_then(|source| source.index_at(tabulated.wavelength_nm).ok());
            cx.edits.extend(index.map(|index| set(sliders, index)));
        }
        self.sources_ui(tabulated, metal, cx, ui);
    }
}

/// The edit that sets n and k.
fn set(mut parameters: Parameters, index: RefractiveIndex) -> Edit {
    PARTS.iter().for_each(|(parameter, part)| parameters[*parameter] = part(index));
    Edit::SetParameters(parameters)
}

/// Its name, with its symbol where it has one of its own.
fn name_and_symbol(metal: &Metal) -> String {
    let name = translated(&metal.name);
    let has_symbol = metal.key.replace('-', " ") != metal.name.to_lowercase();
    if has_symbol { format!("{name} ({})", metal.key) } else { name }
}

fn choice_ui(tabulated: &mut MetalSelection, metal: &Metal, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let label = ui.label(tr!("Metal"));
        let text = name_and_symbol;
        let combo = ComboBox::from_id_salt("metal").width(130.0).height(400.0).selected_text(text(metal)).show_ui(ui, |ui| {
            for other in optics::metals().into_iter().flatten() {
                if ui.selectable_label(other.key == metal.key, text(other)).clicked() {
                    tabulated.look_at(Some(other));
                }
            }
        });
        combo.response.labelled_by(label.id);
        ui.checkbox(&mut tabulated.follow, tr!("n and k follow the wavelength"))
            .on_hover_text(tr!("The sliders n and k go along with the source that was set last"));
    });
}

fn wavelength_ui(wavelength_nm: &mut f64, measured: Option<f64>, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let help = tr!("Vacuum wavelength in nm");
        let label = ui.label(tr!("Wavelength")).on_hover_text(help.as_str());
        // The value stands beside it.
        ui.spacing_mut().slider_width = (ui.available_width() - 90.0).clamp(80.0, 260.0);
        let range = MetalSelection::SHORTEST_NM..=MetalSelection::LONGEST_NM;
        let before = *wavelength_nm;
        let slider = Slider::new(wavelength_nm, range.clone()).show_value(false).step_by(1.0).clamping(SliderClamping::Never);
        let slider = ui.add(slider).labelled_by(label.id).on_hover_text(help.as_str());
        step_with_arrows(ui, &slider, before, wavelength_nm, &range, SliderStep::Fixed(1.0));
        let value = DragValue::new(wavelength_nm).range(range).clamp_existing_to_range(false).speed(1.0).max_decimals(3);
        ui.add(value.suffix(" nm")).labelled_by(label.id);
        if let Some(measured) = measured.filter(|measured| measured != wavelength_nm)
            && ui.button(tr!("as measured")).on_hover_text(tr!("The wavelength of the open measurement: {} nm", measured)).clicked()
        {
            *wavelength_nm = measured;
        }
    });
}

/// Height of a row of the table.
const ROW: f32 = 21.0;

impl MetalsView {
    /// Every source with n and k.
    fn sources_ui(&self, tabulated: &mut MetalSelection, metal: &Metal, cx: &mut Cx<'_>, ui: &mut Ui) {
        let Some(found) = self.found.get() else { return };
        if found.iter().all(Option::is_none) {
            let (low, high) = metal.range_nm();
            let text = tr!("No source has this wavelength: they span {0} to {1} nm.", low.ceil(), high.floor());
            ui.colored_label(theme::warning(ui.visuals().dark_mode), text);
        }
        ui.push_id("sources", |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let table = TableBuilder::new(ui).striped(true).vscroll(false).cell_layout(Layout::left_to_right(Align::Center));
            let table = table.column(Column::auto()).columns(Column::exact(56.0), 2).column(Column::remainder());
            let table = table.header(ROW, |mut header| {
                for heading in [tr!("Source"), "n".to_owned(), "k".to_owned(), String::new()] {
                    header.col(|ui| {
                        ui.strong(heading);
                    });
                }
            });
            table.body(|mut body| {
                for (i, (source, index)) in metal.sources.iter().zip(found).enumerate() {
                    body.row(ROW, |mut row| {
                        if source_ui(&mut row, i, source, *index, tabulated) {
                            tabulated.source = Some(source.key.clone());
                            cx.edits.extend(index.map(|index| set(cx.work.surface().parameters, index)));
                        }
                    });
                }
            });
        });
    }
}

/// One source, which says where it was published; whether its button was pressed.
fn source_ui(
    row: &mut TableRow<'_, '_>,
    i: usize,
    source: &MetalSource,
    index: Option<RefractiveIndex>,
    tabulated: &MetalSelection,
) -> bool {
    let (low, high) = source.range_nm();
    let about = if source.comment.is_empty() { source.citation.clone() } else { format!("{}\n{}", source.citation, source.comment) };
    row.col(|ui| {
        let dark = ui.visuals().dark_mode;
        ui.label(RichText::new("■").color(theme::series(i, dark)));
        ui.label(source.name.as_str()).explained(about);
        ui.add_space(6.0);
    });
    match index {
        Some(index) => {
            for (_, part) in PARTS {
                row.col(|ui| {
                    ui.monospace(format!("{:.4}", part(index)));
                });
            }
        }
        None => {
            row.col(|ui| {
                let dark = ui.visuals().dark_mode;
                ui.label(RichText::new(tr!("outside")).color(theme::warning(dark))).on_hover_text(tr!(
                    "This wavelength is outside the tabulated range, {0} to {1} nm",
                    low,
                    high
                ));
            });
            row.col(|_| {});
        }
    }
    let mut pressed = false;
    row.col(|ui| {
        if index.is_some() {
            let is_followed = tabulated.source.as_deref() == Some(&source.key);
            let button = ui.add(egui::Button::new(tr!("Set n and k")).small().selected(is_followed));
            let name = tr!("Set n and k of {}", source.name);
            button.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &name));
            pressed = button.on_hover_text(tr!("These n and k to the sliders")).clicked();
        } else {
            ui.weak(format!("{low:.0}–{high:.0} nm"));
        }
    });
    pressed
}

/// Least height of the plots: where there is less room, the pane scrolls.
const HEIGHT: f32 = 130.0;
/// Below this height, and over this width, the plots stand beside the table, which has that share
/// of the width.
const LOW: f32 = 330.0;
const WIDE: f32 = 700.0;
const TABLE: f32 = 0.54;

/// Surface finishes, which are not measured.
fn finishes_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.label(tr!("Surface finish")).on_hover_text(tr!("Sizes that go together, for a lesson or a first guess; nobody measured them"));
        for (i, finish) in FINISHES.iter().enumerate() {
            let name = finish.name;
            if ui.button(translated(name)).on_hover_text(values(finish)).clicked() {
                cx.actions.push(Action::UseFinish(i));
            }
        }
    });
}

/// What a finish sets, in symbols.
pub fn values(finish: &Finish) -> String {
    let Finish { sigma, q, kd, kv, .. } = *finish;
    format!("σ = {sigma}, q = {q}, k_s = 1, k_d = {kd}, k_v = {kv}")
}
