//! What a step of undo restores.

use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::open_measurement::{DrawnSeries, Mask, MeasurementStyle, OpenMeasurement};
use crate::app::work::settings::Settings;
use crate::app::work::surface::{PinnedSurface, Surface};
use pbrdf::model::ParameterSet;

/// What a step of undo restores: all that the user sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    settings: Settings,
    /// The open ones in their order.
    measurements: Vec<MeasurementSetup>,
    /// The number of the active one.
    active: u64,
    shared: ParameterSet,
    pinned: Vec<PinnedSurface>,
}

/// What a step of undo restores of an open measurement.
#[derive(Debug, Clone, PartialEq)]
struct MeasurementSetup {
    number: u64,
    name: String,
    surface: Surface,
    style: MeasurementStyle,
    weight: f64,
    mask: Mask,
    drawn: DrawnSeries,
}

impl Setup {
    /// What is set now.
    pub fn of(settings: &Settings, measurements: &MeasurementList, pinned: &[PinnedSurface]) -> Self {
        let of = |open: &OpenMeasurement| MeasurementSetup {
            number: open.number,
            name: open.name.clone(),
            surface: open.surface.clone(),
            style: open.style,
            weight: open.weight,
            mask: open.mask().clone(),
            drawn: open.drawn().clone(),
        };
        Self {
            settings: settings.clone(),
            measurements: measurements.iter().map(of).collect(),
            active: measurements.active().number,
            shared: measurements.shared(),
            pinned: pinned.to_vec(),
        }
    }

    /// Whether it holds the measurement of that number.
    pub fn holds(&self, number: u64) -> bool {
        self.measurements.iter().any(|setup| setup.number == number)
    }

    /// Opens the measurements that were open, and sets names, surfaces, masks and styles as they were;
    /// settings and pinned surfaces are the answer.
    pub fn restore(self, measurements: &mut MeasurementList) -> (Settings, Vec<PinnedSurface>) {
        let numbers: Vec<u64> = self.measurements.iter().map(|setup| setup.number).collect();
        measurements.arrange(&numbers, self.active);
        measurements.set_shared(self.shared);
        for setup in self.measurements {
            if let Some(open) = measurements.get_mut(setup.number) {
                (open.name, open.surface, open.style) = (setup.name, setup.surface, setup.style);
                open.weight = setup.weight;
                open.restore_mask(&setup.mask);
                open.set_drawn(&setup.drawn);
            }
        }
        (self.settings, self.pinned)
    }
}
