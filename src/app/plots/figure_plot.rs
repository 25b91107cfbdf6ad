//! A figure on the screen: the pane paints the same description that the exporter writes.

use crate::app::jobs::memo::Memo;
use crate::app::plots::axes::{Axes, plot};
use crate::app::plots::axis::axis;
use crate::app::plots::color_scale::BAR_ROOM;
use crate::app::plots::key_line::{KeyEntry, key_line_ui};
use crate::app::plots::map_image::MapImage;
use crate::app::plots::plot_axis::PlotAxis;
use crate::app::plots::plot_item::{PlotItem, coordinates};
use crate::app::plots::range::Range;
use crate::app::plots::theme;
use crate::figure::{Figure, Panel};
use egui::{Align2, FontId, Rect, Role, TextureHandle, Ui, Vec2, WidgetInfo, vec2};
use egui_plot::{AxisHints, GridInput, GridMark, HoverPosition, PlotResponse};
use tr::tr;

/// A figure with its panels ready to be painted, made anew when its inputs `K` are others.
pub struct FigurePlot<K> {
    figure: Memo<K, Option<Figure>>,
    panels: Vec<PanelPlot>,
}

impl<K> Default for FigurePlot<K> {
    fn default() -> Self {
        Self { figure: Memo::default(), panels: Vec::new() }
    }
}

impl<K: PartialEq> FigurePlot<K> {
    /// Sees to it that the figure is of these inputs.
    pub fn refresh(&mut self, key: K, describe: impl FnOnce(&K) -> Option<Figure>) {
        if self.figure.refresh(key, describe) {
            let panels = self.figure.get().and_then(Option::as_ref).map_or(&[][..], |figure| &figure.panels);
            self.panels.resize_with(panels.len(), PanelPlot::default);
            self.panels.iter_mut().zip(panels).for_each(|(plot, panel)| plot.set(panel));
        }
    }

    /// The figure, as it is exported.
    pub fn figure(&self) -> Option<&Figure> {
        self.figure.get()?.as_ref()
    }

    /// Whether a texture does not show its map yet.
    #[cfg(test)]
    pub fn is_fresh(&self) -> bool {
        self.panels.iter().any(PanelPlot::is_fresh)
    }

    /// The part of the horizontal axis of its first panel that is on screen, in coordinates of the plot.
    pub fn seen_x(&self) -> Option<Range> {
        self.panels.first()?.axes.seen_x()
    }

    /// The same where the user has moved it there.
    pub fn moved_x(&self) -> Option<Range> {
        self.seen_x().filter(|_| self.panels.first().is_some_and(PanelPlot::is_moved))
    }

    /// A panel of it.
    pub fn panel(&mut self, index: usize) -> Option<&mut PanelPlot> {
        self.panels.get_mut(index)
    }

    /// All its panels.
    pub fn panels(&mut self) -> &mut [PanelPlot] {
        &mut self.panels
    }
}

/// A panel of a figure, and how the user looks at it.
#[derive(Default)]
pub struct PanelPlot {
    content: Option<Content>,
    axes: Axes,
    /// Of its map.
    texture: Option<TextureHandle>,
    /// From a finger that rests on it to the nearest point that can be read, in points of the screen.
    reach: Option<f32>,
}

/// A finger covers what it points at: it reads points that far away, in points of the screen.
const FINGER: f32 = 44.0;

/// A panel in the coordinates of the plot.
struct Content {
    title: String,
    x: PlotAxis,
    y: PlotAxis,
    map: Option<MapImage>,
    items: Vec<PlotItem>,
    equal_aspect: bool,
}

/// How a panel stands in its pane.
pub struct PanelStyle<'a> {
    /// Tells plots apart.
    pub id: &'a str,
    pub height: f32,
    /// What a screen reader says of it; without, which axes it has.
    pub name: Option<String>,
    /// What the pointer reads at a point of that name, at x and y.
    pub hover: &'a dyn Fn(&str, f64, f64) -> String,
    /// Least room of the vertical axis, in points.
    pub left: f32,
    /// Between marks of the vertical axis, in units of egui's smallest spacing.
    pub spread: f64,
    pub place: PanelPlace,
}

/// Whether a panel stands alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PanelPlace {
    #[default]
    Alone,
    /// Over a strip that has the numbers along the horizontal axis.
    OverStrip,
    /// The strip: what is along its vertical axis stands above it, and it is moved by the panel above.
    Strip,
}

impl<'a> PanelStyle<'a> {
    /// With the usual axes.
    pub fn new(id: &'a str, height: f32, hover: &'a dyn Fn(&str, f64, f64) -> String) -> Self {
        Self { id, height, name: None, hover, left: 72.0, spread: 5.0, place: PanelPlace::Alone }
    }

    /// With what a screen reader says of it.
    pub fn named(self, name: String) -> Self {
        Self { name: Some(name), ..self }
    }
}

impl PanelPlot {
    /// Takes up another panel; how the axes are looked at stays.
    pub fn set(&mut self, panel: &Panel) {
        let scales = [panel.x.scale, panel.y.scale];
        // Ends of their own need no look at the points.
        let is_free = panel.x.range.is_none() || panel.y.range.is_none();
        let seen: Vec<(f64, f64)> = panel.series.iter().filter(|_| is_free).flat_map(|series| coordinates(series, scales)).collect();
        let x = PlotAxis::new(&panel.x, seen.iter().map(|at| at.0));
        let y = PlotAxis::new(&panel.y, seen.iter().map(|at| at.1));
        let series = panel.series.iter().zip(panel.colors());
        let items = series.filter_map(|(series, color)| PlotItem::new(series, color, &x, &y)).collect();
        let map = panel.heat_map().and_then(|map| MapImage::new(map, &x, &y));
        self.content = Some(Content { title: panel.title.clone(), x, y, map, items, equal_aspect: panel.equal_aspect });
    }

    /// Looks at the axes as the panel has them, however the user has moved them.
    pub fn look_at_all(&mut self) {
        self.axes = Axes::default();
    }

    /// Whether the user looks elsewhere than the panel has it.
    pub fn is_moved(&self) -> bool {
        self.axes.is_moved()
    }

    #[cfg(test)]
    fn is_fresh(&self) -> bool {
        self.content.as_ref().and_then(|content| content.map.as_ref()).is_some_and(MapImage::is_fresh)
    }

    /// The names of what is drawn, in lines above it, where they hide nothing.
    pub fn key_line_ui(&self, ui: &mut Ui) {
        let Some(Content { items, map, .. }) = &self.content else { return };
        let on_map = map.is_some();
        let dark = ui.visuals().dark_mode;
        let is_first = |(i, item): &(usize, &PlotItem)| !items[..*i].iter().any(|before| before.name == item.name);
        let named = items.iter().enumerate().filter(|(_, item)| !item.name.is_empty()).filter(is_first);
        let entries: Vec<KeyEntry> = named
            .map(|(_, item)| {
                let (style, width) = item.sample();
                KeyEntry { name: item.name.clone(), color: item.color(dark), style, width, symbol: item.symbol(), on_map }
            })
            .collect();
        key_line_ui(&entries, ui);
    }

    /// Paints it; the answer has the place of a click.
    pub fn ui(&mut self, style: &PanelStyle<'_>, ui: &mut Ui) -> Option<PlotResponse<()>> {
        let Self { content: Some(Content { title, x, y, map, items, equal_aspect }), axes, texture, reach } = self else { return None };
        map.iter_mut().for_each(|map| map.upload(texture, ui));
        let (x, y, map) = (&*x, &*y, map.as_ref());
        // Something above that was too wide does not make a plot run out of its pane.
        let width = ui.available_width().min(ui.clip_rect().right() - ui.cursor().left()) - if map.is_some() { BAR_ROOM } else { 0.0 };
        let dark = ui.visuals().dark_mode;
        let x_title = fitting_title(&x.title, title, width - style.left, ui);
        let x_axis = axis(AxisHints::new_x(), ui, &x_title, |at, step| x.label(at, step)).min_thickness(BELOW);
        let is_strip = style.place == PanelPlace::Strip;
        let below = if style.place == PanelPlace::OverStrip { 0.0 } else { BELOW };
        let is_above = is_strip || !fits_along(&y.title, style.height - below, ui);
        let height = if is_above && !is_strip {
            ui.add_space(ABOVE);
            style.height - ABOVE - ui.spacing().item_spacing.y
        } else {
            style.height
        };
        let y_axis =
            axis(AxisHints::new_y(), ui, if is_above { "" } else { &y.title }, |at, step| y.label(at, step)).min_thickness(style.left);
        let ranges =
            if *equal_aspect { of_equal_units([x.range, y.range], width - style.left, height - BELOW) } else { [x.range, y.range] };
        let figure = plot(style.id, ui, height, x_axis, y_axis)
            .width(width.max(80.0))
            .show_grid(map.is_none())
            .x_grid_spacer(|input| x.marks(&input, 7.0))
            .y_grid_spacer(|input| y.marks(&input, style.spread))
            .label_formatter(|hover: &HoverPosition<'_>| match hover {
                HoverPosition::NearDataPoint { plot_name, position, .. } if !plot_name.is_empty() => {
                    Some((style.hover)(plot_name, x.value(position.x), y.value(position.y)))
                }
                _ => None,
            });
        let figure = if *equal_aspect { figure.data_aspect(1.0) } else { figure };
        let figure = if is_strip { figure.allow_drag(false).allow_zoom(false).allow_boxed_zoom(false) } else { figure };
        let figure = figure.show_axes([style.place != PanelPlace::OverStrip, true]);
        let finger = ui.input(|input| input.any_touches().then(|| input.pointer.latest_pos()).flatten());
        let radius = ui.style().interaction.interact_radius;
        if let Some(reach) = reach.filter(|_| finger.is_some()) {
            // The nearest point, and no other one that is drawn above it.
            ui.style_mut().interaction.interact_radius = radius.max(reach + 0.5);
        }
        let before = reach.take();
        let response = figure.show(ui, |plot| {
            axes.apply(plot, Some(ranges[0]), Some(ranges[1]));
            map.zip(texture.as_ref()).into_iter().for_each(|(map, texture)| map.draw(plot, texture));
            items.iter().for_each(|item| item.draw(plot, dark, map.is_some()));
            let near = |finger| items.iter().map(|item| item.distance(finger, plot)).min_by(f32::total_cmp);
            *reach = finger.and_then(near).filter(|distance| *distance <= FINGER);
        });
        ui.style_mut().interaction.interact_radius = radius;
        if *reach != before {
            ui.ctx().request_repaint();
        }
        let name = style.name.clone().unwrap_or_else(|| tr!("Plot: {0} against {1}", y.title, x.title));
        if is_above {
            title_above(&y.title, response.response.rect, ui);
        }
        axes.track_interaction(&response, &name, ui);
        map.into_iter().for_each(|map| map.bar_ui(response.response.rect, ui));
        Some(response)
    }
}

impl PanelPlot {
    /// Paints it as one of many, of that size: what is along its vertical axis stands in its
    /// corner, numbers stand at the axes that lie at the rim and take so much room. There is no
    /// room for words at points. It cannot be moved; the answer is the place of the pointer along
    /// the horizontal axis.
    pub fn cell_ui(&self, size: Vec2, [below, left]: [bool; 2], room: Vec2, ui: &mut Ui) -> Option<f64> {
        let Content { x, y, items, .. } = self.content.as_ref()?;
        let dark = ui.visuals().dark_mode;
        let x_axis = axis(AxisHints::new_x(), ui, "", |at, step| x.label(at, step)).min_thickness(room.y);
        let y_axis = axis(AxisHints::new_y(), ui, "", |at, step| y.label(at, step)).min_thickness(room.x);
        let figure = plot("cell", ui, size.y, x_axis, y_axis).width(size.x).show_axes([below, left]).show_x(false).show_y(false);
        let figure = figure.x_grid_spacer(|input| x.marks(&input, 7.0)).y_grid_spacer(|input| y.marks(&input, 5.0));
        let figure = figure.allow_drag(false).allow_zoom(false).allow_boxed_zoom(false).label_formatter(|_| None);
        let response = figure.show(ui, |plot| {
            plot.set_plot_bounds_x(x.range.low..=x.range.high);
            plot.set_plot_bounds_y(y.range.low..=y.range.high);
            items.iter().filter(|item| !item.is_words()).for_each(|item| item.draw(plot, dark, false));
        });
        response.response.widget_info(|| WidgetInfo::labeled(Role::Image, true, tr!("Plot: {0} against {1}", y.title, x.title)));
        // Away from where the curve begins.
        let high = 0.25 * y.range.low + 0.75 * y.range.high;
        let is_below = items.iter().find_map(PlotItem::first_height).is_some_and(|height| height > high);
        let anchor = if is_below { Align2::LEFT_BOTTOM } else { Align2::LEFT_TOP };
        corner_title(&y.title, response.response.rect, anchor, ui);
        let at = response.response.hover_pos()?;
        Some(x.value(response.transform.value_from_position(at).x))
    }
}

/// Room of the horizontal axis: numbers and title.
const BELOW: f32 = 40.0;

/// Whether the title of an axis of that length is no longer than the axis itself.
fn fits_along(title: &str, length: f32, ui: &Ui) -> bool {
    title_length(title, ui) <= length
}

/// Length of the title of an axis, in points.
fn title_length(title: &str, ui: &Ui) -> f32 {
    let font = egui::TextStyle::Body.resolve(ui.style());
    ui.painter().layout_no_wrap(title.to_owned(), font, ui.visuals().text_color()).size().x
}

/// What stands along a horizontal axis: with as much of the title of its panel as there is room for, which is told in parts
/// after semicolons.
fn fitting_title(axis: &str, title: &str, room: f32, ui: &Ui) -> String {
    let ends = title.match_indices([';', '；']).map(|(end, _)| end).chain([title.len()]);
    let texts = ends.filter(|end| *end > 0).map(|end| tr!("{0}  at {1}", axis, &title[..end]));
    let mut fitting = texts.filter(|text| fits_along(text, room, ui));
    fitting.next_back().unwrap_or_else(|| axis.to_owned())
}

/// Letters of a title above a plot or in a corner, in points.
const SMALL: f32 = 11.0;

/// What a title above a plot takes, in points.
const ABOVE: f32 = 10.0;

/// What is along the vertical axis of a strip or a low plot, in the gap above it, where it covers no points.
fn title_above(title: &str, plot: Rect, ui: &Ui) {
    let at = plot.left_top() + vec2(0.0, -1.0);
    ui.painter().text(at, Align2::LEFT_BOTTOM, title, FontId::proportional(SMALL), ui.visuals().text_color());
}

/// What is along the vertical axis, in a corner of the plot.
fn corner_title(title: &str, plot: Rect, anchor: Align2, ui: &Ui) {
    let title = ui.painter().layout_no_wrap(title.to_owned(), FontId::proportional(SMALL), ui.visuals().text_color());
    let corner = anchor.anchor_size(anchor.pos_in_rect(&plot.shrink2(vec2(4.0, 2.0))), title.size());
    ui.painter().rect_filled(corner.expand(1.0), 2.0, theme::plate(ui.visuals().dark_mode));
    ui.painter().galley(corner.min, title, ui.visuals().text_color());
}

impl PanelPlot {
    /// Length of what stands along the vertical axis, in points.
    pub fn y_title_length(&self, ui: &Ui) -> f32 {
        self.content.as_ref().map_or(0.0, |content| title_length(&content.y.title, ui))
    }

    /// Paints it as one of many with a map or without: titles and numbers stand at the axes that lie at the rim and take
    /// `room`. A screen reader says its name. It cannot be moved; the answer has the place of a click.
    pub fn tile_ui(&mut self, name: &str, size: Vec2, [below, left]: [bool; 2], room: Vec2, ui: &mut Ui) -> Option<PlotResponse<()>> {
        let Self { content: Some(Content { x, y, map, items, .. }), texture, .. } = self else { return None };
        map.iter_mut().for_each(|map| map.upload(texture, ui));
        let (x, y, map) = (&*x, &*y, map.as_ref());
        let dark = ui.visuals().dark_mode;
        let x_axis = axis(AxisHints::new_x(), ui, &x.title, |at, step| x.label(at, step)).min_thickness(room.y);
        let y_axis = axis(AxisHints::new_y(), ui, &y.title, |at, step| y.label(at, step)).min_thickness(room.x);
        let figure = plot("tile", ui, size.y, x_axis, y_axis).width(size.x).show_axes([below, left]).show_x(false).show_y(false);
        let figure = figure.x_grid_spacer(|input| tile_marks(x, &input, TILE_SPREAD[0]));
        let figure = figure.y_grid_spacer(|input| tile_marks(y, &input, TILE_SPREAD[1]));
        let figure = figure.allow_drag(false).allow_zoom(false).allow_boxed_zoom(false).show_grid(false).label_formatter(|_| None);
        let response = figure.show(ui, |plot| {
            plot.set_plot_bounds_x(x.range.low..=x.range.high);
            plot.set_plot_bounds_y(y.range.low..=y.range.high);
            map.zip(texture.as_ref()).into_iter().for_each(|(map, texture)| map.draw(plot, texture));
            items.iter().for_each(|item| item.draw(plot, dark, map.is_some()));
        });
        response.response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
        Some(response)
    }
}

/// Between marks of a tile along either axis, in units of egui's smallest spacing.
const TILE_SPREAD: [f64; 2] = [4.0, 2.2];

/// Share of an axis from which on a number would run into the first one of the tile beside it.
const TILE_NUMBERS: f64 = 0.88;

/// The marks of an axis of a tile.
fn tile_marks(axis: &PlotAxis, input: &GridInput, spread: f64) -> Vec<GridMark> {
    let Range { low, high } = axis.range;
    let mut marks = axis.marks(input, spread);
    marks.retain(|mark| mark.value <= low + TILE_NUMBERS * (high - low));
    marks
}

/// Both ranges, the shorter one widened around its middle until one unit is as long on both axes of
/// a plot of that size.
fn of_equal_units([x, y]: [Range; 2], width: f32, height: f32) -> [Range; 2] {
    let ratio = f64::from(width.max(1.0) / height.max(1.0));
    let wide = f64::max(x.high - x.low, ratio * (y.high - y.low));
    let high = wide / ratio;
    let middle = f64::midpoint(x.low, x.high);
    [Range { low: middle - 0.5 * wide, high: middle + 0.5 * wide }, Range { low: y.low, high: y.low + high }]
}

#[cfg(test)]
mod tests {
    use super::{FINGER, FigurePlot, PanelStyle, Range, of_equal_units, tile_marks};
    use crate::app::plots::plot_axis::PlotAxis;
    use crate::figure::{Axis, Figure, Panel, Series};
    use egui::{Event, Modifiers, PointerButton, Pos2, Shape, TouchDeviceId, TouchId, TouchPhase, vec2};
    use egui_kittest::Harness;
    use egui_plot::GridInput;

    #[test]
    fn no_number_stands_at_the_end_of_a_tile_where_the_next_one_begins() {
        let axis = PlotAxis::new(&Axis::linear("q", "").between(0.0, 20.0), std::iter::empty());
        let marks = tile_marks(&axis, &GridInput { bounds: (0.0, 20.0), base_step_size: 2.5 }, 2.0);
        assert_eq!(marks.iter().map(|mark| mark.value).collect::<Vec<f64>>(), [0.0, 5.0, 10.0, 15.0]);
    }

    #[test]
    fn what_a_logarithm_has_no_place_for_is_a_gap() {
        let points = vec![[1.0, 10.0], [2.0, 0.0], [10.0, 100.0], [100.0, 1000.0]];
        let panel =
            Panel { x: Axis::log("time", "ms"), y: Axis::log("error", ""), series: vec![Series::line("a", points)], ..Panel::default() };
        let mut plot: FigurePlot<u8> = FigurePlot::default();
        plot.refresh(1, |_| Some(Figure { panels: vec![panel], ..Figure::default() }));
        assert_eq!(plot.figure().map(|figure| figure.panels.len()), Some(1));
        let content = plot.panels[0].content.as_ref().expect("a panel");
        assert!(content.x.range.low < 0.0 && content.x.range.high > 2.0);
        assert_eq!((content.x.title.as_str(), content.x.value(1.0)), ("time / ms", 10.0));
        assert_eq!(content.items.len(), 1);
        // Another figure without panels leaves none on the screen.
        plot.refresh(2, |_| None);
        assert!(plot.figure().is_none() && plot.panels().is_empty());
    }

    #[test]
    fn the_whole_drawing_is_seen_in_plots_of_every_shape() {
        for (width, height) in [(575.0, 285.0), (300.0, 400.0), (1200.0, 300.0)] {
            let [x, y] = of_equal_units([Range { low: -1.3, high: 1.3 }, Range { low: -0.2, high: 1.3 }], width, height);
            assert!(x.low <= -1.3 && x.high >= 1.3 && y.low <= -0.2 && y.high >= 1.3 - 1e-9);
            let lengths = [f64::from(width) / (x.high - x.low), f64::from(height) / (y.high - y.low)];
            assert!((lengths[0] / lengths[1] - 1.0).abs() < 1e-6, "{lengths:?}");
        }
    }

    /// What is read at a place that is so far below a level line, by a finger that rests there or by the mouse.
    fn read(below: f32, is_finger: bool) -> Option<String> {
        let mut plot: FigurePlot<()> = FigurePlot::default();
        let points = (0..=400).map(|x| [0.25 * f64::from(x), 0.5]).collect();
        let axis = |end| Axis::linear("axis", "").between(0.0, end);
        let panel = Panel { x: axis(100.0), y: axis(1.0), series: vec![Series::line("curve", points)], ..Panel::default() };
        plot.refresh((), |()| Some(Figure { panels: vec![panel], ..Figure::default() }));
        let mut harness = Harness::builder().with_size(vec2(600.0, 400.0)).build_ui_state(
            |ui, (plot, frame): &mut (FigurePlot<()>, egui::Rect)| {
                let hover = |name: &str, _, y: f64| format!("{name} at {y}");
                let response = plot.panel(0).and_then(|panel| panel.ui(&PanelStyle::new("plot", 380.0, &hover), ui));
                *frame = response.expect("a plot").response.rect;
            },
            (plot, egui::Rect::ZERO),
        );
        harness.run();
        let at: Pos2 = harness.state().1.center() + vec2(0.0, below);
        if is_finger {
            let (device_id, id, phase) = (TouchDeviceId(0), TouchId(1), TouchPhase::Start);
            harness.event(Event::Touch { device_id, id, phase, pos: at, force: None });
        }
        harness.event(Event::PointerMoved(at));
        if is_finger {
            let button = PointerButton::Primary;
            harness.event(Event::PointerButton { pos: at, button, pressed: true, modifiers: Modifiers::NONE });
        }
        harness.run();
        let text = |shape: &Shape| match shape {
            Shape::Text(text) if text.galley.text().starts_with("curve at") => Some(text.galley.text().to_owned()),
            _ => None,
        };
        harness.output().shapes.iter().find_map(|clipped| text(&clipped.shape))
    }

    #[test]
    fn a_finger_that_rests_reads_what_it_covers_and_the_mouse_what_it_points_at() {
        assert_eq!(read(2.0, false).as_deref(), Some("curve at 0.5"));
        assert_eq!(read(30.0, false), None);
        assert_eq!(read(30.0, true).as_deref(), Some("curve at 0.5"));
        assert_eq!(read(FINGER + 5.0, true), None);
    }
}
