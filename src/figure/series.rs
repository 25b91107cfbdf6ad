//! A series of a panel: marks of one kind under one name.

use crate::figure::heat_map::HeatMap;
use crate::figure::palette::Rgb;

/// Marks of one kind under a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; without one it has no entry.
    pub name: String,
    /// Its colour; the next of [`crate::figure::SERIES`] without.
    pub color: Option<Rgb>,
    /// From 0, which is not seen, to 1.
    pub opacity: f64,
    /// Its marks.
    pub mark: Mark,
}

impl Series {
    fn new(name: impl Into<String>, mark: Mark) -> Self {
        Self { name: name.into(), color: None, opacity: 1.0, mark }
    }

    /// A curve.
    pub fn line(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(name, Mark::Line { points, width: 1.2, dash: Dash::Solid })
    }

    /// A broken curve, thinner.
    pub fn dashed(name: impl Into<String>, points: Vec<[f64; 2]>, dash: Dash) -> Self {
        Self::new(name, Mark::Line { points, width: 0.9, dash })
    }

    /// A curve in steps.
    pub fn steps(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(name, Mark::Steps { points })
    }

    /// Discs without error bars.
    pub fn points(name: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let points = points.into_iter().map(|[x, y]| Point { x, y, bar: None }).collect();
        Self::new(name, Mark::Points { points, symbol: Symbol::Disc })
    }

    /// Points with error bars.
    pub fn measured(name: impl Into<String>, points: Vec<Point>, symbol: Symbol) -> Self {
        Self::new(name, Mark::Points { points, symbol })
    }

    /// An area between two curves: x, low, high.
    pub fn band(name: impl Into<String>, points: Vec<[f64; 3]>) -> Self {
        Self::new(name, Mark::Band { points })
    }

    /// The inside of a closed curve.
    pub fn area(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(name, Mark::Area { points })
    }

    /// A curve of that width in points of paper.
    pub fn stroke(name: impl Into<String>, points: Vec<[f64; 2]>, width: f64, dash: Dash) -> Self {
        Self::new(name, Mark::Line { points, width, dash })
    }

    /// Bars of that width on the horizontal axis.
    pub fn bars(name: impl Into<String>, points: Vec<[f64; 2]>, width: f64) -> Self {
        Self::new(name, Mark::Bars { points, width })
    }

    /// Colours.
    #[must_use]
    pub fn heat_map(map: HeatMap) -> Self {
        Self::new("", Mark::HeatMap(map))
    }

    /// A line across the panel at that y.
    pub fn level(name: impl Into<String>, y: f64) -> Self {
        Self::new(name, Mark::Rule { upright: false, at: y })
    }

    /// A line across the panel at that x.
    pub fn upright(name: impl Into<String>, x: f64) -> Self {
        Self::new(name, Mark::Rule { upright: true, at: x })
    }

    /// Words beside places.
    #[must_use]
    pub fn labels(labels: Vec<([f64; 2], String)>) -> Self {
        Self::new("", Mark::Labels(labels))
    }

    /// With every text replaced by what `translate` makes of it.
    pub(crate) fn translated(&self, translate: &dyn Fn(&str) -> String) -> Self {
        let mut series = Self { name: translate(&self.name), ..self.clone() };
        match &mut series.mark {
            Mark::Labels(labels) => labels.iter_mut().for_each(|(_, text)| *text = translate(text)),
            Mark::HeatMap(map) => map.color_axis = map.color_axis.translated(translate),
            _ => {}
        }
        series
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

/// How a series is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
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
