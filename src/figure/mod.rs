//! A figure as a plain value, drawn as SVG and, with the feature `figures`, as PNG.
//!
//! A figure has panels, a panel two axes and series. Coordinates are those of the axes; sizes on paper are millimetres, and points
//! (1/72 inch) for text and lines. Text is outlined, so that a figure looks the same everywhere, and the same figure gives the same bytes
//! everywhere. Values that are not finite, and those not above 0 on a logarithmic axis, split a curve and are otherwise left out.

mod canvas;
mod layout;
mod palette;
#[cfg(feature = "figures")]
mod png;
mod range;
mod shapes;
mod svg;
mod text;
mod ticks;
mod translate;

#[cfg(feature = "figures")]
pub use png::{Image, PngError};

pub(crate) use canvas::escape;
pub use text::CJK;

pub use palette::{ColorMap, Rgb, SERIES};

/// Panels under a title.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Above everything; may be empty.
    pub title: String,
    /// In reading order.
    pub panels: Vec<Panel>,
    /// Panels side by side.
    pub columns: usize,
    /// Millimetres, 20 to 2000.
    pub width_mm: f64,
    /// Millimetres, 20 to 2000.
    pub height_mm: f64,
}

/// One pair of axes with what is drawn between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Above the panel; may be empty.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Drawn in their order; those with one name share a colour and an entry in the legend.
    pub series: Vec<Series>,
    /// Whether there is a legend.
    pub legend: bool,
    /// Height of the panel's row relative to the others'.
    pub height_share: f64,
    /// Whether one unit is as long on both axes.
    pub equal_aspect: bool,
}

/// An axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Axis {
    /// What is along it.
    pub label: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// How it is divided.
    pub scale: Scale,
    /// Its ends; what is drawn decides without, and where they are of no use.
    pub range: Option<(f64, f64)>,
    /// Its own marks, such as names of categories, instead of round numbers.
    pub ticks: Option<Vec<(f64, String)>>,
}

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly in the logarithm; marks at powers of ten.
    Log,
}

/// Something drawn, with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; without one it has no entry.
    pub name: String,
    /// Its colour; the next of [`SERIES`] without.
    pub color: Option<Rgb>,
    /// From 0, which is not seen, to 1.
    pub opacity: f64,
    /// What it is.
    pub drawn: Drawn,
}

/// What a series is.
#[derive(Debug, Clone, PartialEq)]
pub enum Drawn {
    /// A curve through points.
    Line {
        /// x and y.
        points: Vec<[f64; 2]>,
        /// Width in points.
        width: f64,
        /// Whether and how it is broken.
        dash: Dash,
    },
    /// A curve that holds each value up to the next x.
    Steps {
        /// x and y.
        points: Vec<[f64; 2]>,
    },
    /// Single values.
    Points {
        /// Where, with error bars.
        points: Vec<Point>,
        /// How each looks.
        symbol: Symbol,
    },
    /// An area between two curves.
    Band {
        /// x, low and high.
        points: Vec<[f64; 3]>,
    },
    /// The inside of a closed curve.
    Area {
        /// x and y of its corners; values that are not finite separate areas.
        points: Vec<[f64; 2]>,
    },
    /// Bars that stand on an axis: x and height.
    Bars {
        /// x and y of the top.
        points: Vec<[f64; 2]>,
        /// Width of a bar in units of x.
        width: f64,
    },
    /// Values on a grid as colours.
    HeatMap(HeatMap),
    /// A straight line across the panel.
    Rule {
        /// Whether it stands upright, at an x, or lies, at a y.
        upright: bool,
        /// Where.
        at: f64,
    },
    /// Words beside places.
    Labels(Vec<([f64; 2], String)>),
}

/// A point with the ends of its error bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Along the horizontal axis.
    pub x: f64,
    /// Along the vertical axis.
    pub y: f64,
    /// Lower and upper end of the error bar.
    pub bar: Option<(f64, f64)>,
}

/// Whether and how a line is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Dash {
    /// In one piece.
    #[default]
    Solid,
    /// In dashes.
    Dashed,
    /// In dots.
    Dotted,
    /// In dots far apart.
    Sparse,
}

/// How a point looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Symbol {
    /// A disc.
    #[default]
    Disc,
    /// A circle.
    Circle,
    /// A square.
    Square,
    /// A diagonal cross.
    Cross,
}

/// Values on a grid of cells.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// Borders of the cells along x, ascending: one more than there are columns.
    pub x_edges: Vec<f64>,
    /// Borders of the cells along y, ascending: one more than there are rows.
    pub y_edges: Vec<f64>,
    /// Row by row from the lowest y; what is missing or not finite stays blank.
    pub values: Vec<f64>,
    /// What the colours mean; its range without an own one is that of the values.
    pub color_axis: Axis,
    /// Which colours.
    pub colors: ColorMap,
}

impl Default for Figure {
    fn default() -> Self {
        Self { title: String::new(), panels: Vec::new(), columns: 1, width_mm: 160.0, height_mm: 105.0 }
    }
}

impl Default for Panel {
    fn default() -> Self {
        Self {
            title: String::new(),
            x: Axis::default(),
            y: Axis::default(),
            series: Vec::new(),
            legend: true,
            height_share: 1.0,
            equal_aspect: false,
        }
    }
}

impl Panel {
    /// The colour of each series: its own, that of an earlier one of its name, or the next of [`SERIES`].
    #[must_use]
    pub fn colors(&self) -> Vec<Rgb> {
        let mut names: Vec<(&str, Rgb)> = Vec::new();
        let mut next = SERIES.into_iter().cycle();
        let mut colors = Vec::new();
        for series in &self.series {
            let known = names.iter().find(|(name, _)| !name.is_empty() && *name == series.name).map(|(_, color)| *color);
            let color = series.color.or(known).or_else(|| next.next()).unwrap_or(SERIES[0]);
            if known.is_none() {
                names.push((&series.name, color));
            }
            colors.push(color);
        }
        colors
    }
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), ..Self::default() }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label, unit) }
    }

    /// With those ends.
    #[must_use]
    pub fn between(self, low: f64, high: f64) -> Self {
        Self { range: Some((low, high)), ..self }
    }

    /// With names at 0, 1, 2 …, half a step free at either end.
    pub fn categories(label: impl Into<String>, names: impl IntoIterator<Item = String>) -> Self {
        let ticks: Vec<(f64, String)> = (0_u32..).map(f64::from).zip(names).collect();
        let last = ticks.last().map_or(0.0, |(at, _)| *at);
        Self { range: Some((-0.5, last + 0.5)), ticks: Some(ticks), ..Self::linear(label, "") }
    }

    /// Label and unit as they stand beside the axis.
    #[must_use]
    pub fn title(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{} / {}", self.label, self.unit) }
    }
}

impl Series {
    fn new(name: impl Into<String>, drawn: Drawn) -> Self {
        Self { name: name.into(), color: None, opacity: 1.0, drawn }
    }

    /// A curve.
    pub fn line(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(name, Drawn::Line { points, width: 1.2, dash: Dash::Solid })
    }

    /// A broken curve, thinner.
    pub fn dashed(name: impl Into<String>, points: Vec<[f64; 2]>, dash: Dash) -> Self {
        Self::new(name, Drawn::Line { points, width: 0.9, dash })
    }

    /// A curve in steps.
    pub fn steps(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(name, Drawn::Steps { points })
    }

    /// Discs without error bars.
    pub fn points(name: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let points = points.into_iter().map(|[x, y]| Point { x, y, bar: None }).collect();
        Self::new(name, Drawn::Points { points, symbol: Symbol::Disc })
    }

    /// Points with error bars.
    pub fn measured(name: impl Into<String>, points: Vec<Point>, symbol: Symbol) -> Self {
        Self::new(name, Drawn::Points { points, symbol })
    }

    /// An area between two curves: x, low, high.
    pub fn band(name: impl Into<String>, points: Vec<[f64; 3]>) -> Self {
        Self::new(name, Drawn::Band { points })
    }

    /// The inside of a closed curve.
    pub fn area(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(name, Drawn::Area { points })
    }

    /// A curve of that width in points of paper.
    pub fn stroke(name: impl Into<String>, points: Vec<[f64; 2]>, width: f64, dash: Dash) -> Self {
        Self::new(name, Drawn::Line { points, width, dash })
    }

    /// Bars of that width on the horizontal axis.
    pub fn bars(name: impl Into<String>, points: Vec<[f64; 2]>, width: f64) -> Self {
        Self::new(name, Drawn::Bars { points, width })
    }

    /// Colours.
    #[must_use]
    pub fn heat_map(map: HeatMap) -> Self {
        Self::new("", Drawn::HeatMap(map))
    }

    /// A line across the panel at that y.
    pub fn level(name: impl Into<String>, y: f64) -> Self {
        Self::new(name, Drawn::Rule { upright: false, at: y })
    }

    /// A line across the panel at that x.
    pub fn upright(name: impl Into<String>, x: f64) -> Self {
        Self::new(name, Drawn::Rule { upright: true, at: x })
    }

    /// Words beside places.
    #[must_use]
    pub fn labels(labels: Vec<([f64; 2], String)>) -> Self {
        Self::new("", Drawn::Labels(labels))
    }

    /// Fainter: an opacity from 0 to 1.
    #[must_use]
    pub fn faded(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// In that colour.
    #[must_use]
    pub fn colored(self, color: Rgb) -> Self {
        Self { color: Some(color), ..self }
    }
}
