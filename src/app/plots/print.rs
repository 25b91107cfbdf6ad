//! What figures for print have in common: inks, and curves as the core's figures have them.

use crate::app::plots::Range;
use crate::app::views::curves::Polyline;
use crate::figure::{Axis, Rgb};

/// Ink of what is no series: totals, rays, marks.
pub const FOREGROUND: Rgb = Rgb(20, 20, 20);
/// Ink of what stands behind.
pub const MUTED: Rgb = Rgb(150, 150, 150);
/// Ink on dark maps.
pub const WHITE: Rgb = Rgb(255, 255, 255);
/// Ink of marks, which are told apart on a map of whichever colour and on the page.
pub const MARK: Rgb = Rgb(235, 50, 60);

/// Coordinates of a curve; a gap between pieces stays one.
pub fn points(pieces: &Polyline, y: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    placed(pieces, |[x, value]| [x, y(value)])
}

/// The same, where both coordinates are others than on the screen.
pub fn placed(pieces: &Polyline, place: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
    let gap = [[f64::NAN; 2]];
    pieces.iter().flat_map(|piece| piece.iter().map(|point| place([point.x, point.y])).chain(gap)).collect()
}

/// An axis with the ends of the plot on the screen, once it has some.
pub fn over(axis: Axis, range: Option<Range>) -> Axis {
    match range {
        Some(Range { low, high }) => axis.between(low, high),
        None => axis,
    }
}

/// Borders of cells of equal width.
#[expect(clippy::cast_precision_loss, reason = "a number of cells")]
pub fn edges(low: f64, high: f64, cells: usize) -> Vec<f64> {
    (0..=cells).map(|i| low + (high - low) * i as f64 / cells as f64).collect()
}
