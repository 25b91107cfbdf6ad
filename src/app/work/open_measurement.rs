//! A measurement that is open, in the groups that it is plotted in.

use crate::app::text::i18n::translated;
use crate::app::work::surface::Surface;
use crate::figure::Symbol;
use pbrdf::measurement::{Measurement, Row};
use pbrdf::optics;
use pbrdf::optics::Metal;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use tr::tr;

pub use pbrdf::measurement::{DataPoint, IncidenceSeries};

/// A bundled example.
pub struct Example {
    pub name: &'static str,
    pub text: &'static str,
}

/// The bundled examples; the first is open at the start.
pub const EXAMPLES: [Example; 3] = [
    Example { name: "45# steel (simulated)", text: include_str!("../../../assets/examples/steel45_simulated.csv") },
    Example { name: "Copper 650 nm (simulated)", text: include_str!("../../../assets/examples/copper_650nm_simulated.csv") },
    Example { name: "Aluminium 650 nm (simulated)", text: include_str!("../../../assets/examples/aluminium_650nm_simulated.csv") },
];

/// How a measurement is drawn beside others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MeasurementStyle {
    /// Number of its colour among those of series.
    pub color: usize,
    pub marker: Symbol,
    /// Whether it is drawn.
    pub shown: bool,
}

impl Default for MeasurementStyle {
    fn default() -> Self {
        Self { color: 0, marker: Symbol::Disc, shown: true }
    }
}

/// Colours, by their number among those of series, and markers of measurements in the order in which
/// they are opened: those that the few series of the active one do not have come first.
pub const STYLES: [(usize, Symbol); 8] = [
    (10, Symbol::Disc),
    (8, Symbol::Square),
    (9, Symbol::Cross),
    (5, Symbol::Circle),
    (7, Symbol::Disc),
    (11, Symbol::Square),
    (4, Symbol::Cross),
    (6, Symbol::Circle),
];

/// A measurement with its name, its groups and its surface.
#[derive(Debug, Clone)]
pub struct OpenMeasurement {
    pub name: String,
    /// SHA-256 of the bytes of its file, where there is one.
    pub sha256: Option<String>,
    /// Shared with jobs that read it.
    pub measurement: Arc<Measurement>,
    pub series: Vec<IncidenceSeries>,
    /// Which measurement of this session it is.
    pub number: u64,
    /// Another one for every measurement and after every change of one, so that what is derived
    /// knows.
    pub generation: u64,
    /// The same after every change of what plots show of it.
    pub plotted: u64,
    pub surface: Surface,
    pub style: MeasurementStyle,
    /// How often its squared residuals count in joint fits.
    pub weight: f64,
    /// Whether the program opened it by itself and nothing was done with it yet.
    pub is_placeholder: bool,
    mask: Mask,
    drawn: DrawnSeries,
}

/// The series that plots show, by their places, in ascending order.
pub type DrawnSeries = Arc<[usize]>;

/// Series that are drawn at first at most: more can hardly be told apart.
const DRAWN_AT_FIRST: usize = 12;

/// The series that are drawn of so many before anybody chooses: from the first to the last, evenly
/// apart.
pub fn drawn_at_first(count: usize) -> DrawnSeries {
    if count <= DRAWN_AT_FIRST {
        return (0..count).collect();
    }
    let steps = DRAWN_AT_FIRST - 1;
    (0..DRAWN_AT_FIRST).map(|i| (i * (count - 1) + steps / 2) / steps).collect()
}

/// The rows that are masked, in ascending order.
pub type Mask = Arc<[usize]>;

/// The generation that came last: none comes twice, though a lesson gives back a measurement of
/// before.
static LAST: AtomicU64 = AtomicU64::new(0);

fn next_generation() -> u64 {
    LAST.fetch_add(1, Ordering::Relaxed) + 1
}

impl OpenMeasurement {
    pub fn new(name: String, measurement: Measurement) -> Self {
        let number = next_generation();
        let series = IncidenceSeries::of(&measurement.rows);
        let mask = masked_rows(&measurement.rows);
        let surface = Surface::for_measurement(&measurement);
        let (style, measurement) = (MeasurementStyle::default(), Arc::new(measurement));
        let (is_placeholder, drawn) = (false, drawn_at_first(series.len()));
        let (generation, plotted) = (number, number);
        Self {
            name,
            sha256: None,
            measurement,
            series,
            number,
            generation,
            plotted,
            surface,
            style,
            weight: 1.0,
            is_placeholder,
            mask,
            drawn,
        }
    }

    /// No measurement: what the sliders move where nothing is open.
    pub fn nothing() -> Self {
        Self { is_placeholder: true, ..Self::new(String::new(), Measurement::default()) }
    }

    /// The same, read from a file with that SHA-256.
    #[must_use]
    pub fn of_file(self, sha256: Option<String>) -> Self {
        Self { sha256, ..self }
    }

    /// The same with another surface.
    #[must_use]
    pub fn with_surface(self, surface: Surface) -> Self {
        Self { surface, ..self }
    }

    /// The rows that are masked.
    pub fn mask(&self) -> &Mask {
        &self.mask
    }

    /// The series that plots show.
    pub fn drawn(&self) -> &DrawnSeries {
        &self.drawn
    }

    /// Shows other series in plots; places that no series has are left out.
    pub fn set_drawn(&mut self, drawn: &DrawnSeries) {
        if *drawn != self.drawn {
            self.drawn = drawn.iter().copied().filter(|place| *place < self.series.len()).collect();
            self.plotted = next_generation();
        }
    }

    /// Takes rows out of every statistic, or back in; they stay where they are.
    pub fn set_masked(&mut self, rows: &[usize], masked: bool) {
        let all = &mut Arc::make_mut(&mut self.measurement).rows;
        for &row in rows {
            if let Some(row) = all.get_mut(row) {
                row.masked = masked;
            }
        }
        self.mask = masked_rows(all);
        self.mask_changed();
    }

    /// Masks exactly those rows.
    pub fn restore_mask(&mut self, mask: &Mask) {
        if *mask == self.mask {
            return;
        }
        let all = &mut Arc::make_mut(&mut self.measurement).rows;
        all.iter_mut().for_each(|row| row.masked = false);
        for &row in mask.iter() {
            if let Some(row) = all.get_mut(row) {
                row.masked = true;
            }
        }
        self.mask = mask.clone();
        self.mask_changed();
    }

    fn mask_changed(&mut self) {
        self.generation = next_generation();
        self.plotted = self.generation;
        let rows = &self.measurement.rows;
        for mark in self.series.iter_mut().flat_map(|series| series.dolp.iter_mut().chain(&mut series.brdf)) {
            mark.masked = rows[mark.row].masked;
        }
    }

    /// The vacuum wavelength in nm that its metadata state, if they state one.
    pub fn wavelength_nm(&self) -> Option<f64> {
        let stated: f64 = self.measurement.metadata("wavelength_nm")?.parse().ok()?;
        (stated.is_finite() && stated > 0.0).then_some(stated)
    }

    /// The tabulated metal that its metadata name as its material, if they name one.
    pub fn metal(&self) -> Option<&'static Metal> {
        optics::metal_named_in(self.measurement.metadata("material")?).ok()?
    }

    /// Whether anything was measured on the backscatter side.
    pub fn has_backscatter(&self) -> bool {
        self.series.iter().any(IncidenceSeries::has_backscatter)
    }

    /// Whether the measured BRDF spans so much that a linear axis would show its peak alone.
    pub fn brdf_spans_decades(&self) -> bool {
        let values = || self.series.iter().flat_map(|series| &series.brdf).map(|mark| mark.quantity.value).filter(|&value| value > 0.0);
        values().fold(0.0, f64::max) > 1e3 * values().fold(f64::INFINITY, f64::min)
    }

    /// A name for its file.
    pub fn file_name(&self) -> String {
        let stem: String = self.name.chars().map(|c| if c.is_alphanumeric() || "._-".contains(c) { c } else { '_' }).collect();
        if stem.to_lowercase().ends_with(".csv") { stem } else { format!("{}.csv", stem.trim_matches('_')) }
    }

    /// Its name as the window shows it: that of an example in the language of the window.
    pub fn title(&self) -> String {
        title_of(&self.name)
    }

    /// What its metadata say about it, for a line under the plots.
    pub fn description(&self) -> String {
        if self.name.is_empty() && self.measurement.rows.is_empty() {
            return tr!("No measurement: curves alone");
        }
        let simulated = self.measurement.metadata("simulated") == Some("true");
        let mut parts = vec![self.title()];
        parts.extend(self.measurement.metadata("material").map(str::to_owned));
        let wavelength = self.measurement.metadata("wavelength_nm").map(|wavelength| format!("{wavelength} nm"));
        // One of several of a file has it in its name.
        parts.extend(wavelength.filter(|wavelength| !parts[0].ends_with(wavelength)));
        if simulated && !self.name.contains("simulated") {
            parts.push(tr!("simulated"));
        }
        let rows = self.measurement.rows.len();
        parts.push(match self.mask.len() {
            0 => tr!("one row" | "{n} rows" % rows),
            masked => tr!("one row, masked" | "{n} rows, {0} masked" % rows, masked),
        });
        parts.join(" · ")
    }
}

/// The name of a measurement as the window shows it: that of an example in the language of the window.
pub fn title_of(name: &str) -> String {
    let is_example = EXAMPLES.iter().any(|example| example.name == name);
    if is_example { translated(name) } else { name.to_owned() }
}

/// The rows that are masked, in ascending order.
pub fn masked_rows(rows: &[Row]) -> Mask {
    rows.iter().enumerate().filter(|(_, row)| row.masked).map(|(index, _)| index).collect()
}
