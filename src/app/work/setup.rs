//! What a step of undo restores.

use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::open_measurement::{Mask, MeasurementStyle, OpenMeasurement};
use crate::app::work::settings::Settings;
use crate::app::work::surface::{PinnedSurface, Surface};
use pbrdf::model::ParameterSet;

/// What a step of undo restores: all that the user sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    settings: Settings,
    measurements: Vec<MeasurementSetup>,
    shared: ParameterSet,
    pinned: Vec<PinnedSurface>,
}

/// What a step of undo restores of the measurement at a place of the list.
#[derive(Debug, Clone, PartialEq)]
struct MeasurementSetup {
    surface: Surface,
    style: MeasurementStyle,
    mask: Mask,
    /// Whose mask and style those are.
    number: u64,
}

impl Setup {
    /// What is set now.
    pub fn of(settings: &Settings, measurements: &MeasurementList, pinned: &[PinnedSurface]) -> Self {
        let of = |open: &OpenMeasurement| MeasurementSetup {
            surface: open.surface.clone(),
            style: open.style,
            mask: open.mask().clone(),
            number: open.number,
        };
        Self {
            settings: settings.clone(),
            measurements: measurements.iter().map(of).collect(),
            shared: measurements.shared(),
            pinned: pinned.to_vec(),
        }
    }

    /// Sets surfaces, masks and styles as they were; settings and pinned surfaces are the answer.
    pub fn restore(self, measurements: &mut MeasurementList) -> (Settings, Vec<PinnedSurface>) {
        measurements.share(self.shared);
        for (open, setup) in measurements.iter_mut().zip(self.measurements) {
            open.surface = setup.surface;
            // The rows of another measurement are other rows.
            if open.number == setup.number {
                open.style = setup.style;
                open.restore_mask(&setup.mask);
            }
        }
        (self.settings, self.pinned)
    }
}
