//! Error bars, which `egui_plot` lacks: one item with a cap at either end of each bar.

use egui::{Color32, Shape, Stroke, Ui, pos2};
use egui_plot::{PlotBounds, PlotGeometry, PlotItem, PlotItemBase, PlotPoint, PlotTransform};
use std::ops::RangeInclusive;

/// The ends of an error bar, in plot coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorBar {
    pub x: f64,
    pub low: f64,
    pub high: f64,
}

/// Bars of one colour.
pub struct ErrorBars<'a> {
    base: PlotItemBase,
    bars: &'a [ErrorBar],
    color: Color32,
}

/// Half the width of a cap in points.
const CAP: f32 = 2.5;

impl<'a> ErrorBars<'a> {
    /// Of that name: the one of the points they belong to, so that the legend has one entry for
    /// both.
    pub fn new(name: String, bars: &'a [ErrorBar], color: Color32) -> Self {
        Self { base: PlotItemBase::new(name), bars, color }
    }
}

impl PlotItem for ErrorBars<'_> {
    fn shapes(&self, _ui: &Ui, transform: &PlotTransform, shapes: &mut Vec<Shape>) {
        let stroke = Stroke::new(1.0, self.color);
        for bar in self.bars {
            let low = transform.position_from_point(&PlotPoint::new(bar.x, bar.low));
            let high = transform.position_from_point(&PlotPoint::new(bar.x, bar.high));
            shapes.push(Shape::line_segment([low, high], stroke));
            for end in [low, high] {
                shapes.push(Shape::line_segment([pos2(end.x - CAP, end.y), pos2(end.x + CAP, end.y)], stroke));
            }
        }
    }

    fn initialize(&mut self, _x_range: RangeInclusive<f64>) {}

    fn color(&self) -> Color32 {
        self.color
    }

    fn allow_hover(&self) -> bool {
        false
    }

    fn geometry(&self) -> PlotGeometry<'_> {
        PlotGeometry::None
    }

    fn bounds(&self) -> PlotBounds {
        let mut bounds = PlotBounds::NOTHING;
        for bar in self.bars {
            bounds.extend_with(&PlotPoint::new(bar.x, bar.low));
            bounds.extend_with(&PlotPoint::new(bar.x, bar.high));
        }
        bounds
    }

    fn base(&self) -> &PlotItemBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut PlotItemBase {
        &mut self.base
    }
}
