//! MetalSelection metals: n and k of every source side by side at one wavelength and along all, a button that sets them, and surface finishes.

mod figure;

pub use figure::metals_figure;

use crate::app::jobs::memo::Memo;
use crate::app::panels::{Step, step_with_arrows};
use crate::app::plots::axis;
use crate::app::plots::axis::{axis, decimal};
use crate::app::plots::{Axes, Following, Range, curve, plot, round_up};
use crate::app::shell::app::App;
use crate::app::shell::commands::Command;
use crate::app::shell::theme;
use crate::app::text::i18n::translated;
use crate::app::views::curves::{Polyline, pieces};
use crate::app::work::settings::{MetalSelection, Settings};
use crate::app::work::workspace::Workspace;
use egui::{Align, ComboBox, DragValue, Layout, RichText, ScrollArea, Slider, SliderClamping, Ui, WidgetInfo};
use egui_extras::{Column, TableBuilder, TableRow};
use egui_plot::{AxisHints, HLine, HoverPosition, LineStyle, PlotPoint, PlotPoints, Points, VLine};
use pbrdf::model::{FINISHES, Finish, Parameter};
use pbrdf::optics;
use pbrdf::optics::{Metal, RefractiveIndex, Sample, Source};
use tr::tr;

/// What the pane keeps.
#[derive(Default)]
pub struct MetalsView {
    /// The index of every source of the metal, by metal and wavelength.
    found: Memo<(String, f64), Vec<Option<RefractiveIndex>>>,
    /// n and k of every source against the wavelength.
    lines: Memo<String, Vec<[Polyline; 2]>>,
    axes: [Axes; 2],
    wavelengths: Following,
    ranges: [Following; 2],
}

/// n or k of an index.
type Part = fn(RefractiveIndex) -> f64;

/// Both, in the order of the plots.
const PARTS: [(Parameter, Part); 2] = [(Parameter::N, RefractiveIndex::n), (Parameter::K, RefractiveIndex::k_m)];
/// Wavelengths in nm up to which the plots go while the chosen one is not beyond: the visible and what silicon sees.
const SHORT: f64 = 1000.0;

/// The metal that is looked at; none where the bundled table is damaged, which a test of the core rules out.
fn chosen(tabulated: &MetalSelection) -> Option<&'static Metal> {
    let metals = optics::metals().ok()?;
    metals.iter().find(|metal| metal.key == tabulated.metal).or(metals.first())
}

pub fn metals_refresh(explorer: &mut App) {
    let App { work: Workspace { settings, .. }, views, dragging, .. } = explorer;
    let view = &mut views.metals;
    let Some(metal) = chosen(&settings.tabulated) else { return };
    let wavelength_nm = settings.tabulated.wavelength_nm;
    view.found
        .refresh((metal.key.clone(), wavelength_nm), |_| metal.sources.iter().map(|source| source.index_at(wavelength_nm).ok()).collect());
    view.lines.refresh(metal.key.clone(), |_| {
        let line =
            |source: &Source, part: Part| pieces(source.samples().iter().map(|sample| (sample.wavelength_nm, Some(part(sample.index)))));
        metal.sources.iter().map(|source| PARTS.map(|(_, part)| line(source, part))).collect()
    });
    let (low, high) = metal.range_nm();
    let high = if wavelength_nm > SHORT { high.max(wavelength_nm) } else { SHORT };
    let low = low.min(MetalSelection::SHORTEST_NM);
    // Marks at the ends have room for their numbers.
    let air = 0.04 * (high - low);
    view.wavelengths.follow(Range { low: low - air, high: high + air }, *dragging);
    let seen = || metal.sources.iter().flat_map(Source::samples).filter(|sample: &&Sample| sample.wavelength_nm <= high);
    for ((parameter, part), range) in PARTS.into_iter().zip(&mut view.ranges) {
        let top = seen().map(|sample| part(sample.index)).fold(settings.parameters[parameter].min(20.0), f64::max);
        let high = round_up(top);
        // The mark at 0 keeps off that of the first wavelength.
        range.follow(Range { low: -0.06 * high, high }, *dragging);
    }
}

pub fn metals_ui(explorer: &mut App, ui: &mut Ui) {
    let Some(metal) = chosen(&explorer.work.settings.tabulated) else { return };
    ScrollArea::vertical().id_salt("metals").auto_shrink([false; 2]).show(ui, |ui| {
        let before = explorer.work.settings.tabulated.clone();
        choice_ui(&mut explorer.work.settings.tabulated, metal, ui);
        wavelength_ui(explorer, ui);
        finishes_ui(explorer, ui);
        let tabulated = &explorer.work.settings.tabulated;
        // The followed source takes the sliders along the wavelength.
        if tabulated.metal == before.metal && tabulated.wavelength_nm != before.wavelength_nm && tabulated.follow {
            let followed = metal.sources.iter().find(|source| Some(&source.key) == tabulated.source.as_ref());
            let index = followed.and_then(|source| source.index_at(tabulated.wavelength_nm).ok());
            explorer.commands.extend(index.map(set));
        }
        sources_ui(explorer, metal, ui);
        ui.add_space(4.0);
        lines_ui(explorer, metal, ui);
    });
}

/// The command that sets n and k.
fn set(index: RefractiveIndex) -> Command {
    Command::SetParameters(PARTS.iter().map(|(parameter, part)| (*parameter, part(index))).collect())
}

/// Its name, with its symbol where it has one of its own.
fn name_and_symbol(metal: &Metal) -> String {
    let name = translated(&metal.name);
    let has_symbol = metal.key.replace('-', " ") != metal.name.to_lowercase();
    if has_symbol { format!("{name} ({})", metal.key) } else { name }
}

fn choice_ui(tabulated: &mut MetalSelection, metal: &Metal, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let label = ui.label(tr!("Metal"));
        let text = name_and_symbol;
        let combo = ComboBox::from_id_salt("metal").width(170.0).height(400.0).selected_text(text(metal)).show_ui(ui, |ui| {
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

fn wavelength_ui(explorer: &mut App, ui: &mut Ui) {
    let measured = explorer.work.document.wavelength_nm();
    let wavelength_nm = &mut explorer.work.settings.tabulated.wavelength_nm;
    ui.horizontal(|ui| {
        let help = tr!("Vacuum wavelength in nm");
        let label = ui.label(tr!("Wavelength")).on_hover_text(help.as_str());
        ui.spacing_mut().slider_width = 260.0;
        let range = MetalSelection::SHORTEST_NM..=MetalSelection::LONGEST_NM;
        let before = *wavelength_nm;
        let slider = Slider::new(wavelength_nm, range.clone()).show_value(false).step_by(1.0).clamping(SliderClamping::Never);
        let slider = ui.add(slider).labelled_by(label.id).on_hover_text(help.as_str());
        step_with_arrows(ui, &slider, before, wavelength_nm, &range, Step::Fixed(1.0));
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

/// Every source with n, k and where it was published.
fn sources_ui(explorer: &mut App, metal: &Metal, ui: &mut Ui) {
    let App { work: Workspace { settings, .. }, views, commands, .. } = explorer;
    let Some(found) = views.metals.found.get() else { return };
    if found.iter().all(Option::is_none) {
        let (low, high) = metal.range_nm();
        let text = tr!("No source has this wavelength: they span {0} to {1} nm.", low.ceil(), high.floor());
        ui.colored_label(theme::warning(ui.visuals().dark_mode), text);
    }
    ui.push_id("sources", |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let table = TableBuilder::new(ui).striped(true).vscroll(false).cell_layout(Layout::left_to_right(Align::Center));
        let table = table.column(Column::auto().at_least(190.0).clip(true)).columns(Column::exact(56.0), 2);
        let table = table.column(Column::auto().at_least(90.0)).column(Column::remainder().clip(true));
        let table = table.header(ROW, |mut header| {
            for heading in [tr!("Source"), "n".to_owned(), "k".to_owned(), String::new(), tr!("Published in")] {
                header.col(|ui| {
                    ui.strong(heading);
                });
            }
        });
        table.body(|mut body| {
            for (i, (source, index)) in metal.sources.iter().zip(found).enumerate() {
                body.row(ROW, |mut row| {
                    if source_ui(&mut row, i, source, *index, &settings.tabulated) {
                        settings.tabulated.source = Some(source.key.clone());
                        commands.extend(index.map(set));
                    }
                });
            }
        });
    });
}

/// One source; whether its button was pressed.
fn source_ui(row: &mut TableRow<'_, '_>, i: usize, source: &Source, index: Option<RefractiveIndex>, tabulated: &MetalSelection) -> bool {
    let (low, high) = source.range_nm();
    let about = if source.comment.is_empty() { source.citation.clone() } else { format!("{}\n{}", source.citation, source.comment) };
    row.col(|ui| {
        let dark = ui.visuals().dark_mode;
        ui.label(RichText::new("■").color(theme::series(i, dark)));
        ui.add(egui::Label::new(source.name.as_str()).truncate()).on_hover_text(about.as_str());
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
    row.col(|ui| {
        ui.add(egui::Label::new(RichText::new(source.citation.as_str()).weak()).truncate()).on_hover_text(about.as_str());
    });
    pressed
}

/// Least height of the plots: where there is less room, the pane scrolls.
const HEIGHT: f32 = 130.0;

/// n and k against the wavelength, side by side.
fn lines_ui(explorer: &mut App, metal: &Metal, ui: &mut Ui) {
    let App { work: Workspace { settings, .. }, views, .. } = explorer;
    let view = &mut views.metals;
    let Some(lines) = view.lines.get() else { return };
    let height = (ui.available_height() - ui.spacing().item_spacing.y).max(HEIGHT);
    ui.columns(PARTS.len(), |columns| {
        for (part, (ui, axes)) in columns.iter_mut().zip(&mut view.axes).enumerate() {
            let found = view.found.get().map(Vec::as_slice).unwrap_or_default();
            part_ui(part, settings, metal, lines, found, axes, (view.wavelengths.get(), view.ranges[part].get()), height, ui);
        }
    });
}

#[expect(clippy::too_many_arguments, reason = "what the view keeps is borrowed in parts")]
fn part_ui(
    part: usize,
    settings: &Settings,
    metal: &Metal,
    lines: &[[Polyline; 2]],
    found: &[Option<RefractiveIndex>],
    axes: &mut Axes,
    ranges: (Option<Range>, Option<Range>),
    height: f32,
    ui: &mut Ui,
) {
    let (parameter, of) = PARTS[part];
    let dark = ui.visuals().dark_mode;
    let wavelength_nm = settings.tabulated.wavelength_nm;
    let marks: Vec<Option<[PlotPoint; 1]>> =
        found.iter().map(|index| index.map(|index| [PlotPoint::new(wavelength_nm, of(index))])).collect();
    let x = axis(AxisHints::new_x(), ui, &tr!("wavelength / nm"), decimal).min_thickness(36.0);
    let y = axis(AxisHints::new_y(), ui, parameter.symbol(), decimal);
    // Narrower than where plots stand one above the other.
    let narrow = y.clone().min_thickness(44.0);
    let response = plot(parameter.key(), ui, height, x, y)
        .custom_y_axes(vec![narrow])
        .x_grid_spacer(|input| axis::marks(&input, 5.0, 0.0))
        .y_grid_spacer(|input| axis::marks(&input, 5.0, 0.0))
        .label_formatter(move |hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                Some(format!("{plot_name}\n{:.1} nm\n{} = {:.4}", position.x, parameter.symbol(), position.y))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            axes.apply(plot, ranges.0, ranges.1);
            plot.vline(VLine::new("", wavelength_nm).color(theme::muted(dark)).width(1.0).allow_hover(false));
            let slider = HLine::new(tr!("slider"), settings.parameters[parameter]).color(theme::foreground(dark)).width(1.0);
            plot.hline(slider.style(LineStyle::dashed_dense()));
            for (i, (source, line)) in metal.sources.iter().zip(lines).enumerate() {
                let is_followed = settings.tabulated.source.as_deref() == Some(&source.key);
                curve(plot, &line[part], &source.name, theme::series(i, dark), None, if is_followed { 3.0 } else { 1.5 });
            }
            for (i, (source, mark)) in metal.sources.iter().zip(&marks).enumerate() {
                if let Some(mark) = mark {
                    plot.points(Points::new(source.name.as_str(), PlotPoints::Borrowed(mark)).color(theme::series(i, dark)).radius(3.0));
                }
            }
        });
    axes.listen(&response, &tr!("Plot: {} against wavelength", parameter.symbol()), ui);
}

/// Surface finishes, which are not measured.
fn finishes_ui(explorer: &mut App, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.label(tr!("Surface finish")).on_hover_text(tr!("Sizes that go together, for a lesson or a first guess; nobody measured them"));
        for (i, finish) in FINISHES.iter().enumerate() {
            let name = finish.name;
            if ui.button(translated(name)).on_hover_text(values(finish)).clicked() {
                explorer.commands.push(Command::UseFinish(i));
            }
        }
    });
}

/// What a finish sets, in symbols.
pub fn values(finish: &Finish) -> String {
    let Finish { sigma, q, kd, kv, .. } = *finish;
    format!("σ = {sigma}, q = {q}, k_s = 1, k_d = {kd}, k_v = {kv}")
}
