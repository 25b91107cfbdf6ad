//! A figure of the core in the window: the same curves, points and names, made ready once and drawn each frame.

use crate::app::plots::axis;
use crate::app::plots::axis::{axis, decimal, logarithmic};
use crate::app::plots::{Axes, Range, curve, plot};
use crate::app::shell::theme;
use crate::app::views::curves::{Polyline, pieces};
use crate::figure;
use crate::figure::{Dash, Drawn, Figure, Panel, Scale};
use egui::text::{LayoutJob, TextFormat};
use egui::{TextStyle, Ui};
use egui_plot::{AxisHints, HLine, HoverPosition, LineStyle, PlotPoint, PlotPoints, PlotResponse, PlotUi, Points, VLine};
use tr::tr;

/// A figure, its panels side by side.
pub struct Drawing {
    pub title: String,
    pub panels: Vec<DrawnPanel>,
}

/// A panel with how it is looked at.
pub struct DrawnPanel {
    x: DrawnAxis,
    y: DrawnAxis,
    items: Vec<Item>,
    legend: bool,
    axes: Axes,
}

struct DrawnAxis {
    title: String,
    unit: String,
    log: bool,
    range: Range,
}

struct Item {
    name: String,
    /// Place of its colour.
    color: usize,
    kind: Kind,
}

enum Kind {
    Line(Polyline, Option<LineStyle>),
    Points(Polyline),
    Level(f64),
    Upright(f64),
}

/// Room around what is drawn, as a fraction of it.
const AIR: f64 = 0.04;

impl DrawnAxis {
    /// The coordinate of a value; none where a logarithm has no place for it.
    fn place(log: bool, value: f64) -> Option<f64> {
        if !log {
            return Some(value).filter(|value| value.is_finite());
        }
        (value > 0.0 && value.is_finite()).then(|| libm::log10(value))
    }

    fn new(axis: &figure::Axis, places: impl Iterator<Item = f64>) -> Self {
        let log = axis.scale == Scale::Log;
        let own = axis.range.and_then(|(low, high)| Some(Range { low: Self::place(log, low)?, high: Self::place(log, high)? }));
        let range = own.filter(|range| range.low < range.high).unwrap_or_else(|| {
            let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
            // Nothing, or a single place, has no extent of its own.
            let (low, high) = if low < high {
                (low, high)
            } else if low.is_finite() {
                (low - 0.5, low + 0.5)
            } else {
                (0.0, 1.0)
            };
            let air = AIR * (high - low);
            Range { low: low - air, high: high + air }
        });
        Self { title: axis.label.clone(), unit: axis.unit.clone(), log, range }
    }

    fn label(&self) -> String {
        self.title.clone()
    }

    fn title(&self) -> String {
        let label = self.label();
        if self.unit.is_empty() { label } else { format!("{label} / {}", self.unit) }
    }

    /// A place in words.
    fn value(&self, place: f64) -> String {
        let value = if self.log { libm::exp10(place) } else { place };
        format!("{}: {} {}", self.label(), crate::app::text::glossary::short(value), self.unit)
    }

    fn format(&self) -> fn(f64, f64) -> String {
        if self.log { logarithmic } else { decimal }
    }
}

impl Drawing {
    pub fn new(figure: &Figure) -> Self {
        Self { title: figure.title.clone(), panels: figure.panels.iter().map(DrawnPanel::new).collect() }
    }
}

impl DrawnPanel {
    fn new(panel: &Panel) -> Self {
        let (x_log, y_log) = (panel.x.scale == Scale::Log, panel.y.scale == Scale::Log);
        let place = |[x, y]: [f64; 2]| Some((DrawnAxis::place(x_log, x)?, DrawnAxis::place(y_log, y)?));
        let mut names: Vec<&str> = Vec::new();
        let items: Vec<Item> = panel
            .series
            .iter()
            .filter_map(|series| {
                let color = names.iter().position(|name| *name == series.name).unwrap_or_else(|| {
                    names.push(&series.name);
                    names.len() - 1
                });
                let placed = |points: &[[f64; 2]]| -> Vec<Option<(f64, f64)>> { points.iter().map(|point| place(*point)).collect() };
                let kind = match &series.drawn {
                    Drawn::Line { points, dash, .. } => Kind::Line(edges(&placed(points), false), style(*dash)),
                    Drawn::Steps { points } => Kind::Line(edges(&placed(points), true), None),
                    Drawn::Points { points, .. } => {
                        let points: Vec<[f64; 2]> = points.iter().map(|point| [point.x, point.y]).collect();
                        Kind::Points(pieces(
                            placed(&points).into_iter().map(|point| (point.map_or(0.0, |(x, _)| x), point.map(|(_, y)| y))),
                        ))
                    }
                    Drawn::Rule { upright: false, at } => Kind::Level(DrawnAxis::place(y_log, *at)?),
                    Drawn::Rule { upright: true, at } => Kind::Upright(DrawnAxis::place(x_log, *at)?),
                    // Not in the figures that the window shows this way.
                    Drawn::Band { .. } | Drawn::Bars { .. } | Drawn::HeatMap(_) | Drawn::Labels(_) => return None,
                };
                Some(Item { name: series.name.clone(), color, kind })
            })
            .collect();
        let places = || {
            items.iter().flat_map(|item| match &item.kind {
                Kind::Line(pieces, _) | Kind::Points(pieces) => pieces.iter().flatten().collect::<Vec<&PlotPoint>>(),
                Kind::Level(_) | Kind::Upright(_) => Vec::new(),
            })
        };
        let x = DrawnAxis::new(&panel.x, places().map(|point| point.x));
        let y = DrawnAxis::new(&panel.y, places().map(|point| point.y));
        Self { x, y, items, legend: panel.legend, axes: Axes::default() }
    }

    /// The names of what is drawn, in a line above it, where they hide nothing.
    pub fn legend_ui(&self, ui: &mut Ui) {
        let dark = ui.visuals().dark_mode;
        if !self.legend {
            return;
        }
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for (i, Item { name, color, .. }) in self.items.iter().enumerate() {
                if name.is_empty() || self.items[..i].iter().any(|before| before.name == *name) {
                    continue;
                }
                let mut text = LayoutJob::default();
                let font = TextStyle::Small.resolve(ui.style());
                text.append("● ", 0.0, TextFormat::simple(font.clone(), theme::series(*color, dark)));
                text.append(name, 0.0, TextFormat::simple(font, ui.visuals().text_color()));
                // A name is not torn at the end of a line.
                ui.add(egui::Label::new(text).extend());
            }
        });
    }

    /// Draws it; the answer has the place of a click.
    pub fn ui(&mut self, name: &str, height: f32, ui: &mut Ui) -> PlotResponse<()> {
        let dark = ui.visuals().dark_mode;
        let Self { x, y, items, axes, .. } = self;
        let x_axis = axis(AxisHints::new_x(), ui, &x.title(), x.format()).min_thickness(40.0);
        let y_axis = axis(AxisHints::new_y(), ui, &y.title(), y.format());
        let spacer =
            |log: bool, spread: f64| move |input| if log { axis::decades(&input, spread) } else { axis::marks(&input, spread, 0.0) };
        let figure = plot(name, ui, height, x_axis, y_axis).x_grid_spacer(spacer(x.log, 5.0)).y_grid_spacer(spacer(y.log, 4.0));
        let figure = figure.label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                Some(format!("{plot_name}\n{}\n{}", x.value(position.x), y.value(position.y)))
            }
            HoverPosition::Elsewhere { .. } => None,
        });
        let response = figure.show(ui, |plot| {
            axes.apply(plot, Some(x.range), Some(y.range));
            items.iter().for_each(|item| item.draw(plot, dark));
        });
        axes.listen(&response, &tr!("Plot: {0} against {1}", y.title(), x.title()), ui);
        response
    }
}

impl Item {
    fn draw<'a>(&'a self, plot: &mut PlotUi<'a>, dark: bool) {
        let color = theme::series(self.color, dark);
        let name = &self.name;
        match &self.kind {
            Kind::Line(pieces, style) => curve(plot, pieces, name, color, *style, 1.5),
            Kind::Points(pieces) => {
                for piece in pieces {
                    plot.points(Points::new(name.clone(), PlotPoints::Borrowed(piece)).color(color).radius(3.0));
                }
            }
            Kind::Level(at) => plot.hline(HLine::new(name.clone(), *at).color(color).style(LineStyle::dashed_dense())),
            Kind::Upright(at) => plot.vline(VLine::new(name.clone(), *at).color(color).style(LineStyle::dashed_dense())),
        }
    }
}

fn style(dash: Dash) -> Option<LineStyle> {
    match dash {
        Dash::Solid => None,
        Dash::Dashed => Some(LineStyle::dashed_dense()),
        Dash::Dotted => Some(LineStyle::dotted_dense()),
    }
}

/// A line as its edges, each a piece of its own, since the sharp corners of one long line are drawn as filled wedges; with steps, one edge
/// along and one up or down.
fn edges(points: &[Option<(f64, f64)>], steps: bool) -> Polyline {
    let edge = |pair: &[Option<(f64, f64)>]| {
        let (Some((x0, y0)), Some((x1, y1))) = (pair[0], pair[1]) else { return Vec::new() };
        let piece = |ends: [(f64, f64); 2]| ends.map(|(x, y)| PlotPoint::new(x, y)).to_vec();
        if steps { vec![piece([(x0, y0), (x1, y0)]), piece([(x1, y0), (x1, y1)])] } else { vec![piece([(x0, y0), (x1, y1)])] }
    };
    points.windows(2).flat_map(edge).collect()
}

#[cfg(test)]
mod tests {
    use super::{Drawing, Kind};
    use crate::figure::{Axis, Figure, Panel, Series};

    #[test]
    fn what_a_logarithm_has_no_place_for_is_a_gap() {
        let points = vec![[1.0, 10.0], [2.0, 0.0], [10.0, 100.0], [100.0, 1000.0]];
        let panel =
            Panel { x: Axis::log("time", "ms"), y: Axis::log("error", ""), series: vec![Series::line("a", points)], ..Panel::default() };
        let drawing = Drawing::new(&Figure { panels: vec![panel], ..Figure::default() });
        let panel = &drawing.panels[0];
        let Kind::Line(pieces, _) = &panel.items[0].kind else { panic!("a line") };
        assert_eq!(pieces.iter().map(|piece| [piece[0].x, piece[1].y]).collect::<Vec<_>>(), [[1.0, 3.0]]);
        assert!(panel.x.range.low < 1.0 && panel.x.range.high > 2.0);
        assert_eq!((panel.x.title().as_str(), panel.x.value(1.0).as_str()), ("time / ms", "time: 10.0 ms"));
    }
}
