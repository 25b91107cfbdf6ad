//! A series of a figure on the screen, made ready once in the coordinates of the plot.

use crate::app::plots::markers::{ErrorBar, Markers, RADIUS};
use crate::app::plots::plot_axis::{PlotAxis, coordinate};
use crate::app::plots::polyline::{curve, split_at_gaps};
use crate::app::plots::theme;
use crate::figure::{Dash, Mark, Point, Rgb, Scale, Series, Symbol};
use egui::{Align2, Color32, Pos2, Rect, RichText, vec2};
use egui_plot::{FilledArea, HLine, LineStyle, MarkerShape, PlotPoint, PlotPoints, PlotUi, Points, Polygon, Text, VLine};

/// A series with its name and colour.
pub struct PlotItem {
    pub name: String,
    color: Rgb,
    opacity: f32,
    shape: PlotShape,
}

enum PlotShape {
    Line {
        pieces: Vec<Vec<PlotPoint>>,
        style: LineStyle,
        width: f32,
    },
    Points {
        points: Vec<PlotPoint>,
        bars: Vec<ErrorBar>,
        symbol: Symbol,
    },
    /// x, low and high of each piece.
    Band(Vec<[Vec<f64>; 3]>),
    Area(Vec<Vec<PlotPoint>>),
    Level(f64),
    Upright(f64),
    Labels(Vec<(PlotPoint, String)>),
}

/// Points of the screen for a point of paper.
const ZOOM: f64 = 1.6;
/// Width of the rim of points on a map.
const RIM: f32 = 1.0;
/// Opacity of a band and of an area: curves and points stay readable through several.
const FILLED: f32 = 0.2;
/// Size of letters.
const LETTERS: f32 = 12.0;
/// Width of the sample of a band in a line of names.
const BAND_SAMPLE: f32 = 8.0;
/// Pieces of a whole line up to this many points are drawn edge by edge: the sharp corners of one
/// long line would be filled wedges.
const FEW: usize = 40;

impl PlotItem {
    /// The item of a series; none of what the window does not paint this way. Ends of axes are not
    /// needed yet.
    pub fn new(series: &Series, color: Rgb, x: &PlotAxis, y: &PlotAxis) -> Option<Self> {
        let point = |[a, b]: [f64; 2]| Some(PlotPoint::new(x.coordinate(a)?, y.coordinate(b)?));
        let pieces = |points: &[[f64; 2]]| split_at_gaps(points.iter().map(|at| point(*at)));
        let shape = match &series.mark {
            Mark::Line { points, width, dash } => {
                let pieces = pieces(points);
                let pieces = if *dash == Dash::Solid { pieces.into_iter().flat_map(into_edges).collect() } else { pieces };
                PlotShape::Line { pieces, style: style(*dash), width: on_screen(*width) }
            }
            Mark::Steps { points } => {
                let pieces = pieces(points).iter().flat_map(|piece| steps(piece)).collect();
                PlotShape::Line { pieces, style: LineStyle::Solid, width: on_screen(1.2) }
            }
            Mark::Points { points, symbol } => {
                let bar = |at: &Point| {
                    let (low, high) = at.bar?;
                    Some(ErrorBar { x: x.coordinate(at.x)?, low: y.end_coordinate(low)?, high: y.end_coordinate(high)? })
                };
                PlotShape::Points {
                    points: points.iter().filter_map(|at| point([at.x, at.y])).collect(),
                    bars: points.iter().filter_map(bar).collect(),
                    symbol: *symbol,
                }
            }
            Mark::Band { points } => PlotShape::Band(bands(points, x, y)),
            Mark::Area { points } => PlotShape::Area(pieces(points)),
            Mark::Rule { upright: false, at } => PlotShape::Level(y.coordinate(*at)?),
            Mark::Rule { upright: true, at } => PlotShape::Upright(x.coordinate(*at)?),
            Mark::Labels(labels) => PlotShape::Labels(labels.iter().filter_map(|(at, text)| Some((point(*at)?, text.clone()))).collect()),
            // A map is an image behind all items, and bars stand in files alone.
            Mark::Bars { .. } | Mark::HeatMap(_) => return None,
        };
        #[expect(clippy::cast_possible_truncation, reason = "a fraction")]
        let opacity = series.opacity as f32;
        Some(Self { name: series.name.clone(), color, opacity, shape })
    }

    /// The colour on the screen.
    pub fn color(&self, dark: bool) -> Color32 {
        theme::on_screen(self.color, dark).gamma_multiply(self.opacity)
    }

    /// How a sample of it looks beside its name: style and width of a line.
    pub fn sample(&self) -> (LineStyle, f32) {
        match &self.shape {
            PlotShape::Line { style, width, .. } => (*style, *width),
            PlotShape::Level(_) | PlotShape::Upright(_) => (LineStyle::dashed_dense(), 1.0),
            PlotShape::Points { .. } | PlotShape::Labels(_) => (LineStyle::Solid, 2.0),
            PlotShape::Band(_) | PlotShape::Area(_) => (LineStyle::Solid, BAND_SAMPLE),
        }
    }

    /// The height at which a curve begins.
    pub fn first_height(&self) -> Option<f64> {
        if let PlotShape::Line { pieces, .. } = &self.shape { Some(pieces.first()?.first()?.y) } else { None }
    }

    /// The symbol of points.
    pub fn symbol(&self) -> Option<Symbol> {
        if let PlotShape::Points { symbol, .. } = self.shape { Some(symbol) } else { None }
    }

    /// How far the nearest of its points that have a name is from a place on the screen.
    pub fn distance(&self, place: Pos2, plot: &PlotUi<'_>) -> f32 {
        let points: &[&[PlotPoint]] = match &self.shape {
            _ if self.name.is_empty() => &[],
            PlotShape::Line { pieces, .. } => &pieces.iter().map(Vec::as_slice).collect::<Vec<_>>(),
            PlotShape::Points { points, .. } => &[points],
            _ => &[],
        };
        let away = |point: &PlotPoint| plot.screen_from_plot(*point).distance(place);
        points.iter().copied().flatten().map(away).fold(f32::INFINITY, f32::min)
    }

    /// Whether it is words alone.
    pub fn is_words(&self) -> bool {
        matches!(self.shape, PlotShape::Labels(_))
    }

    /// Puts it into the plot; words on a map have a plate behind them, points a rim.
    pub fn draw<'a>(&'a self, plot: &mut PlotUi<'a>, dark: bool, on_map: bool) {
        let (name, color) = (self.name.as_str(), self.color(dark));
        match &self.shape {
            PlotShape::Line { pieces, style, width } => curve(plot, pieces, name, color, *style, *width),
            PlotShape::Points { points, bars, symbol } => {
                if on_map {
                    // A rim, so that points are seen on every colour.
                    let (shape, filled) = marker(*symbol);
                    let rim = Points::new("", PlotPoints::Borrowed(points)).color(Color32::BLACK).radius(RADIUS + RIM);
                    plot.points(rim.shape(shape).filled(filled).allow_hover(false));
                }
                plot.add(Markers::new(name.to_owned(), points, bars, *symbol, color));
            }
            PlotShape::Band(pieces) => {
                for [x, low, high] in pieces {
                    plot.add(FilledArea::new(name, x, low, high).fill_color(color.gamma_multiply(FILLED)).allow_hover(false));
                }
            }
            PlotShape::Area(pieces) => {
                for piece in pieces {
                    let polygon = Polygon::new(name, PlotPoints::Borrowed(piece)).fill_color(color.gamma_multiply(FILLED));
                    plot.polygon(polygon.stroke(egui::Stroke::NONE).allow_hover(false));
                }
            }
            PlotShape::Level(at) => {
                plot.hline(HLine::new(name, *at).color(color).style(LineStyle::dashed_dense()).allow_hover(!name.is_empty()));
            }
            PlotShape::Upright(at) => {
                plot.vline(VLine::new(name, *at).color(color).style(LineStyle::dashed_dense()).allow_hover(!name.is_empty()));
            }
            PlotShape::Labels(labels) => {
                let mut taken: Vec<Rect> = Vec::new();
                for (at, text) in labels {
                    let place = plate(plot.screen_from_plot(*at), text);
                    if taken.iter().any(|other| other.intersects(place)) {
                        continue;
                    }
                    taken.push(place);
                    let text = RichText::new(format!(" {text} ")).size(LETTERS).color(theme::foreground(dark));
                    let text = if on_map { text.background_color(theme::plate(dark)) } else { text };
                    plot.text(Text::new("", *at, text).anchor(Align2::LEFT_CENTER).allow_hover(false));
                }
            }
        }
    }
}

/// About where words stand that begin there: of words that would cover each other the first is
/// drawn.
fn plate(at: Pos2, text: &str) -> Rect {
    let letter = |letter: char| if letter.is_ascii() { 0.55 * LETTERS } else { LETTERS };
    let width = text.chars().map(letter).sum::<f32>() + letter(' ');
    Rect::from_min_size(at - vec2(0.0, 0.6 * LETTERS), vec2(width, 1.2 * LETTERS))
}

/// Coordinates of a series that decide about an axis without ends, by the logarithms that its axes
/// have.
pub fn coordinates(series: &Series, [x, y]: [Scale; 2]) -> Vec<(f64, f64)> {
    let place = |a: f64, b: f64| Some((coordinate(x == Scale::Log, a)?, coordinate(y == Scale::Log, b)?));
    match &series.mark {
        Mark::Line { points, .. } | Mark::Steps { points } | Mark::Area { points } => {
            points.iter().filter_map(|[a, b]| place(*a, *b)).collect()
        }
        Mark::Points { points, .. } => points.iter().filter_map(|at| place(at.x, at.y)).collect(),
        _ => Vec::new(),
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a width in points")]
fn on_screen(width: f64) -> f32 {
    (ZOOM * width) as f32
}

fn style(dash: Dash) -> LineStyle {
    match dash {
        Dash::Solid => LineStyle::Solid,
        Dash::Dashed => LineStyle::dashed_dense(),
        Dash::Dotted => LineStyle::dotted_dense(),
        Dash::Sparse => LineStyle::dotted_loose(),
    }
}

/// Shape of a symbol, and whether it is filled.
fn marker(symbol: Symbol) -> (MarkerShape, bool) {
    match symbol {
        Symbol::Disc => (MarkerShape::Circle, true),
        Symbol::Circle => (MarkerShape::Circle, false),
        Symbol::Square => (MarkerShape::Square, true),
        Symbol::Cross => (MarkerShape::Cross, true),
    }
}

/// A short piece as its edges, a long one as it is.
fn into_edges(piece: Vec<PlotPoint>) -> Vec<Vec<PlotPoint>> {
    if piece.len() > FEW { vec![piece] } else { piece.windows(2).map(<[PlotPoint]>::to_vec).collect() }
}

/// Edges of steps that hold each value up to the next x.
fn steps(piece: &[PlotPoint]) -> Vec<Vec<PlotPoint>> {
    let edges = |pair: &[PlotPoint]| {
        let corner = PlotPoint::new(pair[1].x, pair[0].y);
        [vec![pair[0], corner], vec![corner, pair[1]]]
    };
    piece.windows(2).flat_map(edges).collect()
}

fn bands(points: &[[f64; 3]], x: &PlotAxis, y: &PlotAxis) -> Vec<[Vec<f64>; 3]> {
    let place = |[at, low, high]: [f64; 3]| Some([x.coordinate(at)?, y.end_coordinate(low)?, y.end_coordinate(high)?]);
    let mut pieces: Vec<[Vec<f64>; 3]> = vec![Default::default()];
    for point in points {
        match (place(*point), pieces.last_mut()) {
            (Some(ends), Some(piece)) => piece.iter_mut().zip(ends).for_each(|(column, value)| column.push(value)),
            (None, Some([at, ..])) if !at.is_empty() => pieces.push(Default::default()),
            _ => {}
        }
    }
    pieces.retain(|[at, ..]| !at.is_empty());
    pieces
}
