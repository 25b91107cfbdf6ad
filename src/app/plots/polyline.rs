//! Curves with gaps, in a figure and in a plot.

use crate::app::plots::curve_line::CurveLine;
use egui_plot::{Line, LineStyle, PlotPoint, PlotPoints, PlotUi};

/// A curve as figures have it: x and y; a point that is not finite is a gap.
pub type Polyline = Vec<[f64; 2]>;

/// The pieces of a curve between its gaps, in the coordinates of a plot.
pub fn split_at_gaps(points: impl Iterator<Item = Option<PlotPoint>>) -> Vec<Vec<PlotPoint>> {
    let mut pieces = vec![Vec::new()];
    for point in points {
        match (point, pieces.last_mut()) {
            (Some(point), Some(piece)) => piece.push(point),
            (None, Some(piece)) if !piece.is_empty() => pieces.push(Vec::new()),
            _ => {}
        }
    }
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// The points of a curve without its gaps.
pub fn finite(points: &Polyline) -> impl Iterator<Item = [f64; 2]> {
    points.iter().copied().filter(|point| point.iter().all(|coordinate| coordinate.is_finite()))
}

/// A line that is as wide where it is steep: `egui_plot` draws points that are less than a pixel
/// apart as a band, which is as high everywhere as the line is wide.
pub fn line<'a>(name: &str, points: &'a [PlotPoint]) -> Line<'a> {
    Line::new(name, PlotPoints::Borrowed(points)).allow_band(false)
}

/// A curve in its pieces, under one name.
pub fn curve<'a>(plot: &mut PlotUi<'a>, pieces: &'a [Vec<PlotPoint>], name: &str, color: egui::Color32, style: LineStyle, width: f32) {
    for piece in pieces {
        match style {
            LineStyle::Solid => plot.add(CurveLine::new(name, piece, width, color)),
            style => plot.line(line(name, piece).color(color).width(width).style(style)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LineStyle, curve};
    use egui::{Color32, Shape};
    use egui_kittest::Harness;
    use egui_plot::{Plot, PlotPoint};

    #[test]
    fn a_steep_curve_is_as_wide_as_a_flat_one() {
        // Some points to the pixel, and steeper and steeper to the right.
        let point = |i: i32| PlotPoint::new(f64::from(i), 1.0 / f64::from(2001 - i));
        let pieces = vec![(0..=2000).map(point).collect::<Vec<_>>()];
        let harness = Harness::new_ui(|ui| {
            Plot::new("plot").show(ui, |plot| curve(plot, &pieces, "curve", Color32::RED, LineStyle::Solid, 1.5));
        });
        // One path, of no more points than its bend needs.
        let path = |shape: &Shape| matches!(shape, Shape::Path(path) if (10..500).contains(&path.points.len()) && path.stroke.width == 1.5);
        assert!(harness.output().shapes.iter().any(|clipped| path(&clipped.shape)));
    }
}
