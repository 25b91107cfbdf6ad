//! The angle of view that the pointer is at, in whichever plot against θr it is.

use crate::app::plots::theme::MUTED;
use crate::app::work::settings::Settings;
use crate::figure::{Dash, Series};
use egui::{Context, Id, Ui};
use egui_plot::PlotResponse;
use tr::tr;

fn place() -> Id {
    Id::unique("pointed θr")
}

/// Notes where the pointer is in a plot against θr.
pub fn note_theta_r<R>(response: &PlotResponse<R>, ui: &Ui) {
    if let Some(at) = response.response.hover_pos() {
        // As many digits as the pointer has.
        let theta_r = (10.0 * response.transform.value_from_position(at).x).round() / 10.0;
        let before = ui.data_mut(|data| {
            let noted = data.get_temp_mut_or_default::<Pointed>(place());
            std::mem::replace(noted, Pointed { fresh: Some(theta_r), ..*noted })
        });
        if before.is_read && before.shown != Some(theta_r) {
            ui.ctx().request_repaint();
        }
    }
}

/// What the frame before noted, and what the read-out shows.
#[derive(Clone, Copy, Default)]
struct Pointed {
    fresh: Option<f64>,
    shown: Option<f64>,
    is_read: bool,
}

/// The angle of view in degrees that the pointer was at in the last frame, if anybody reads it.
pub fn pointed_theta_r(ctx: &Context, is_read: bool) -> Option<f64> {
    ctx.data_mut(|data| {
        let noted = data.get_temp_mut_or_default::<Pointed>(place());
        noted.is_read = is_read;
        noted.shown = noted.fresh.take().filter(|_| is_read);
        noted.shown
    })
}

/// A direction of a pixel of the picture, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PickedDirection {
    pub theta_i: f64,
    pub theta_r: f64,
    pub dphi: f64,
}

impl PickedDirection {
    /// Its angle of view, while lobes are looked at under its angles.
    pub fn theta_r_at(self, settings: &Settings) -> Option<f64> {
        (settings.theta_i == self.theta_i && settings.dphi == self.dphi).then_some(self.theta_r)
    }
}

/// A line at the angle of view of the picked pixel, between those ends of the vertical axis.
pub fn mark(theta_r: f64, low: f64, high: f64) -> Series {
    mark_along(vec![[theta_r, low], [theta_r, high]])
}

/// The same along that way.
pub fn mark_along(way: Vec<[f64; 2]>) -> Series {
    Series::dashed(picked_name(), way, Dash::Sparse).colored(MUTED)
}

/// What the picked pixel is called in plots.
pub fn picked_name() -> String {
    tr!("pixel of the picture")
}
