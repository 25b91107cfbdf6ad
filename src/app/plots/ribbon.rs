//! A band between two curves.

use egui::Color32;
use egui_plot::{FilledArea, PlotUi};
use tr::tr;

/// A band without gaps.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ribbon {
    pub x: Vec<f64>,
    pub low: Vec<f64>,
    pub high: Vec<f64>,
}

impl Ribbon {
    pub fn push(&mut self, x: f64, low: f64, high: f64) {
        self.x.push(x);
        self.low.push(low);
        self.high.push(high);
    }

    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }
}

/// Opacity of a band: curves and points stay readable through several.
const OPACITY: f32 = 0.2;

/// A curve's band in its pieces, under one name for all bands.
pub fn ribbons_in(plot: &mut PlotUi<'_>, ribbons: &[Ribbon], color: Color32) {
    for ribbon in ribbons {
        let area = FilledArea::new(tr!("± 1 standard error"), &ribbon.x, &ribbon.low, &ribbon.high);
        plot.add(area.fill_color(color.gamma_multiply(OPACITY)).allow_hover(false));
    }
}
