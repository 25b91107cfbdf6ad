//! Whole lines of curves: of the points only those that a look at the screen needs. Ten measurements
//! have tens of thousands, and each would be some triangles in every frame.

use egui::{Color32, Pos2, Shape, Stroke, Ui};
use egui_plot::{PlotBounds, PlotGeometry, PlotItem, PlotItemBase, PlotPoint, PlotTransform};
use std::ops::RangeInclusive;

/// A piece of a curve.
pub struct CurveLine<'a> {
    base: PlotItemBase,
    points: &'a [PlotPoint],
    stroke: Stroke,
}

/// How far a line may pass by a point that is left out, in points of the screen.
const TOLERANCE: f32 = 0.2;

impl<'a> CurveLine<'a> {
    pub fn new(name: &str, points: &'a [PlotPoint], width: f32, color: Color32) -> Self {
        Self { base: PlotItemBase::new(name.to_owned()), points, stroke: Stroke::new(width, color) }
    }
}

/// The points that a line must turn at to pass by no other one further than the tolerance: from each
/// that is kept the line goes on as long as one direction meets all that follow.
fn simplified(points: impl Iterator<Item = Pos2>) -> Vec<Pos2> {
    let mut kept: Vec<Pos2> = Vec::new();
    // The last point that was met, and between which turns off the direction to the first one the line
    // may go, as sines.
    let mut last: Option<(Pos2, f32, f32)> = None;
    let mut first = egui::Vec2::ZERO;
    for point in points {
        let Some(&anchor) = kept.last() else {
            kept.push(point);
            continue;
        };
        let way = point - anchor;
        let length = way.length();
        let meets = match last {
            None => {
                first = way.normalized();
                (length > TOLERANCE).then(|| (-TOLERANCE / length, TOLERANCE / length))
            }
            Some((before, low, high)) => {
                let (along, off) = (first.dot(way) / length, (first.x * way.y - first.y * way.x) / length);
                let goes_on = length > (before - anchor).length() && along > 0.7 && (low..=high).contains(&off);
                goes_on.then(|| (low.max(off - TOLERANCE / length), high.min(off + TOLERANCE / length)))
            }
        };
        match (meets, last) {
            (Some((low, high)), _) => last = Some((point, low, high)),
            // So near that it is no step of its own.
            (None, None) => {}
            (None, Some((before, ..))) => {
                kept.push(before);
                let way = point - before;
                first = way.normalized();
                let room = TOLERANCE / way.length().max(TOLERANCE);
                last = Some((point, -room, room));
            }
        }
    }
    kept.extend(last.map(|(point, ..)| point));
    kept
}

impl PlotItem for CurveLine<'_> {
    fn shapes(&self, _ui: &Ui, transform: &PlotTransform, shapes: &mut Vec<Shape>) {
        let points = simplified(self.points.iter().map(|point| transform.position_from_point(point)));
        if points.len() > 1 {
            shapes.push(Shape::line(points, self.stroke));
        }
    }

    fn initialize(&mut self, _x_range: RangeInclusive<f64>) {}

    fn color(&self) -> Color32 {
        self.stroke.color
    }

    fn geometry(&self) -> PlotGeometry<'_> {
        PlotGeometry::Points(self.points)
    }

    fn bounds(&self) -> PlotBounds {
        let mut bounds = PlotBounds::NOTHING;
        self.points.iter().for_each(|point| bounds.extend_with(point));
        bounds
    }

    fn base(&self) -> &PlotItemBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut PlotItemBase {
        &mut self.base
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::{TOLERANCE, simplified};
    use egui::{Pos2, pos2};

    /// How far a point is from the nearest piece of a line.
    fn distance(point: Pos2, line: &[Pos2]) -> f32 {
        let to = |pair: &[Pos2]| {
            let along = (pair[1] - pair[0]).normalized();
            let at = (point - pair[0]).dot(along).clamp(0.0, (pair[1] - pair[0]).length());
            (point - (pair[0] + along * at)).length()
        };
        line.windows(2).map(to).fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn a_line_passes_by_no_point_further_than_nobody_sees() {
        let smooth = |i: i32| pos2(3.0 * i as f32, 100.0 + 80.0 * (0.05 * i as f32).sin());
        let peak = |i: i32| pos2(3.0 * i as f32, 2e4 / (4.0 + (i - 90).pow(2) as f32));
        let corner = |i: i32| pos2(if i < 90 { i as f32 } else { 90.0 }, if i < 90 { 0.0 } else { (i - 90) as f32 });
        let back = |i: i32| pos2(if i < 90 { i as f32 } else { 180.0 - i as f32 }, 0.0);
        for (curve, most) in [(smooth as fn(i32) -> Pos2, 90), (peak, 90), (corner, 4), (back, 4)] {
            let points: Vec<Pos2> = (0..180).map(curve).collect();
            let line = simplified(points.iter().copied());
            assert!(line.len() <= most, "{} of {}", line.len(), points.len());
            assert_eq!((line.first(), line.last()), (points.first(), points.last()));
            // The direction is compared by its sine, which is off by less than a tenth within the cone.
            assert!(points.iter().all(|point| distance(*point, &line) <= 2.0 * TOLERANCE), "{line:?}");
        }
        assert_eq!(simplified(std::iter::empty()), []);
        assert_eq!(simplified([pos2(1.0, 1.0)].into_iter()), [pos2(1.0, 1.0)]);
    }
}
