//! Measured points in a plot.

use crate::app::plots::ErrorBars;
use crate::app::shell::theme;
use crate::app::views::curves::Marks;
use egui::Color32;
use egui_plot::{MarkerShape, PlotPoints, PlotUi, Points};
use tr::tr;

/// Points with their error bars, masked ones hollow and grey.
pub fn marks_in<'a>(plot: &mut PlotUi<'a>, marks: &'a Marks, name: &str, color: Color32, dark: bool) {
    if !marks.bars.is_empty() {
        plot.add(ErrorBars::new(name.to_owned(), &marks.bars, color));
    }
    if !marks.used.is_empty() {
        plot.points(Points::new(name.to_owned(), PlotPoints::Borrowed(&marks.used)).color(color).radius(3.0));
    }
    if !marks.masked.is_empty() {
        let points = Points::new(tr!("masked"), PlotPoints::Borrowed(&marks.masked)).color(theme::muted(dark)).radius(3.0);
        plot.points(points.shape(MarkerShape::Circle).filled(false));
    }
}
