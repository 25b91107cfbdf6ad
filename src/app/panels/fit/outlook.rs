//! What a fit from the sliders would determine, before it is made.

use crate::app::text::explained::Explained as _;
use crate::app::text::glossary::open_help;
use crate::app::views::derived::Identifiability;
use egui::{Grid, Ui};
use pbrdf::rounding::significant;
use tr::tr;

/// Standard errors that a fit from the sliders would have, before it is made.
pub fn outlook_ui(outlook: Option<&Identifiability>, ui: &mut Ui) {
    let Some(outlook) = outlook else {
        ui.label("…");
        return;
    };
    let basis = if outlook.from_stated {
        tr!("from the stated standard deviations")
    } else {
        tr!("if the noise is as large as the present misfit")
    };
    if outlook.measurements > 1 {
        ui.weak(tr!("Standard errors at the sliders by {0} measurements together, {1}:", outlook.measurements, basis));
    } else {
        ui.weak(tr!("Standard errors at the sliders, {}:", basis));
    }
    Grid::new("outlook").num_columns(2).show(ui, |ui| {
        for (parameter, error) in &outlook.errors {
            ui.label(parameter.symbol());
            match error {
                Some(error) => ui.label(format!("± {} {}", significant(*error, 2), parameter.unit())),
                None => ui.label(tr!("not determined")).explained(open_help()),
            };
            ui.end_row();
        }
    });
    for direction in &outlook.open {
        ui.add(egui::Label::new(format!("• {direction}")).wrap());
    }
}
