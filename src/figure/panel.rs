//! A figure and its panels.

use crate::figure::axis::Axis;
use crate::figure::heat_map::HeatMap;
use crate::figure::palette::{Rgb, SERIES};
use crate::figure::series::{Mark, Series};

/// Panels under a title, or figures side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Above everything; may be empty.
    pub title: String,
    /// In reading order.
    pub panels: Vec<Panel>,
    /// Figures in the place of panels, each with a layout of its own, in reading order; see
    /// [`Figure::sheet`].
    pub figures: Vec<Self>,
    /// Panels or figures side by side.
    pub columns: usize,
    /// Millimetres, 20 to 2000.
    pub width_mm: f64,
    /// Millimetres, 20 to 2000.
    pub height_mm: f64,
}

impl Default for Figure {
    fn default() -> Self {
        Self { title: String::new(), panels: Vec::new(), figures: Vec::new(), columns: 1, width_mm: 160.0, height_mm: 105.0 }
    }
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
    /// Whether there is a legend: names, and the bar of colours of a map.
    pub legend: bool,
    /// Height of the panel's row relative to the others'.
    pub height_share: f64,
    /// Whether one unit is as long on both axes.
    pub equal_aspect: bool,
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

/// Width of a figure beside others, in millimetres: two fit on a page of A4.
const CELL_WIDTH_MM: f64 = 95.0;
/// Height of a figure beside others, relative to its height alone.
const CELL_HEIGHT: f64 = 0.85;

impl Figure {
    /// Several figures as one, so many side by side; one alone stays as it is.
    #[must_use]
    pub fn sheet(title: &str, mut figures: Vec<Self>, columns: usize) -> Self {
        if figures.len() == 1 {
            let alone = figures.remove(0);
            return if title.is_empty() { alone } else { Self { title: title.to_owned(), ..alone } };
        }
        let columns = columns.clamp(1, figures.len().max(1));
        let (width, height) = if columns == 1 { (Self::default().width_mm, 1.0) } else { (CELL_WIDTH_MM, CELL_HEIGHT) };
        for figure in &mut figures {
            // A figure as high as wide stays so.
            figure.height_mm = (height * figure.height_mm).min(figure.height_mm / figure.width_mm * width * 1.25);
            figure.width_mm = width;
        }
        for row in figures.chunks_mut(columns) {
            let highest = row.iter().map(|figure| figure.height_mm).fold(0.0, f64::max);
            row.iter_mut().for_each(|figure| figure.height_mm = highest);
        }
        let height_mm = figures.chunks(columns).map(|row| row[0].height_mm).sum::<f64>();
        #[expect(clippy::cast_precision_loss, reason = "a handful of figures")]
        let width_mm = columns as f64 * width;
        Self { title: title.to_owned(), figures, columns, width_mm, height_mm, ..Self::default() }
    }

    /// With every text replaced by what `translate` makes of it; series of one name keep one name.
    #[must_use]
    pub fn translate(&self, translate: &dyn Fn(&str) -> String) -> Self {
        let panels = self.panels.iter().map(|panel| panel.translated(translate)).collect();
        let figures = self.figures.iter().map(|figure| figure.translate(translate)).collect();
        Self { title: translate(&self.title), panels, figures, ..self.clone() }
    }
}

impl Panel {
    /// Whether its place stays empty: nothing is drawn, and neither axis says what it is.
    #[must_use]
    pub fn is_blank(&self) -> bool {
        self.series.is_empty() && self.title.is_empty() && self.x == Axis::default() && self.y == Axis::default()
    }

    fn translated(&self, translate: &dyn Fn(&str) -> String) -> Self {
        Self {
            title: translate(&self.title),
            x: self.x.translated(translate),
            y: self.y.translated(translate),
            series: self.series.iter().map(|series| series.translated(translate)).collect(),
            ..self.clone()
        }
    }

    /// The map whose colours the panel explains.
    #[must_use]
    pub fn heat_map(&self) -> Option<&HeatMap> {
        self.series.iter().find_map(|series| if let Mark::HeatMap(map) = &series.mark { Some(map) } else { None })
    }

    /// The colour of each series: its own, else that of an earlier series of the same name, else the
    /// next of [`SERIES`].
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
