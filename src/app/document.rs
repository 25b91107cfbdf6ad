//! The measurement that is open, in the groups that it is plotted in.

use pbrdf::measurement::{Measurement, Quantity, Row};
use pbrdf::optics::Geometry;
use std::sync::Arc;

/// A bundled example.
pub struct Example {
    pub name: &'static str,
    pub text: &'static str,
}

/// The bundled examples; the first is open at the start.
pub const EXAMPLES: [Example; 3] = [
    Example { name: "45# steel (simulated)", text: include_str!("../../assets/examples/steel45_simulated.csv") },
    Example { name: "Copper 650 nm (simulated)", text: include_str!("../../assets/examples/copper_650nm_simulated.csv") },
    Example { name: "Aluminium 650 nm (simulated)", text: include_str!("../../assets/examples/aluminium_650nm_simulated.csv") },
];

/// One measured value in a plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// θr in degrees, negative on the backscatter side.
    pub theta_r: f64,
    pub quantity: Quantity,
    pub masked: bool,
    /// Its row in the measurement.
    pub row: usize,
}

/// Rows of one θi in one plane through the surface normal.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Degrees.
    pub theta_i: f64,
    /// Δφ of its forward side in degrees, 90 < Δφ ≤ 270; 180 is the plane of incidence.
    pub plane: f64,
    pub dolp: Vec<Mark>,
    pub brdf: Vec<Mark>,
    /// Its rows in the measurement.
    pub rows: Vec<usize>,
}

impl Series {
    /// Geometry at a signed θr in this plane.
    pub fn geometry(&self, signed_theta_r: f64) -> Option<Geometry> {
        let dphi = if signed_theta_r < 0.0 { self.plane - 180.0 } else { self.plane };
        Geometry::new(self.theta_i, signed_theta_r.abs(), dphi).ok()
    }

    /// Name in a legend.
    pub fn name(&self) -> String {
        if self.plane == 180.0 { format!("θi = {}°", self.theta_i) } else { format!("θi = {}°, Δφ = {}°", self.theta_i, self.plane) }
    }
}

/// A measurement with its name and its groups.
#[derive(Debug, Clone)]
pub struct Document {
    pub name: String,
    /// Shared with jobs that read it.
    pub measurement: Arc<Measurement>,
    pub series: Vec<Series>,
    /// Which measurement of this session it is.
    pub number: u64,
    /// Grows with every document and every change of one, so that what is derived knows.
    pub generation: u64,
    mask: Mask,
}

/// The rows that are masked, in ascending order.
pub type Mask = Arc<[usize]>;

/// Bits of the generation that count the changes of one document.
const CHANGES: u32 = 32;

impl Document {
    pub fn new(name: String, measurement: Measurement, number: u64) -> Self {
        let series = series(&measurement.rows);
        let mask = masked_rows(&measurement.rows);
        Self { name, measurement: Arc::new(measurement), series, number, generation: number << CHANGES, mask }
    }

    /// The rows that are masked.
    pub fn mask(&self) -> &Mask {
        &self.mask
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
        self.generation += 1;
        let rows = &self.measurement.rows;
        for mark in self.series.iter_mut().flat_map(|series| series.dolp.iter_mut().chain(&mut series.brdf)) {
            mark.masked = rows[mark.row].masked;
        }
    }

    /// Whether anything was measured on the backscatter side.
    pub fn has_backscatter(&self) -> bool {
        self.series.iter().flat_map(|series| series.dolp.iter().chain(&series.brdf)).any(|mark| mark.theta_r < 0.0)
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

    /// What its metadata say about it, for a line under the plots.
    pub fn description(&self) -> String {
        let simulated = self.measurement.metadata("simulated") == Some("true");
        let mut parts = vec![self.name.clone()];
        parts.extend(self.measurement.metadata("material").map(str::to_owned));
        parts.extend(self.measurement.metadata("wavelength_nm").map(|wavelength| format!("{wavelength} nm")));
        if simulated && !self.name.contains("simulated") {
            parts.push("simulated".to_owned());
        }
        let rows = self.measurement.rows.len();
        parts.push(if self.mask.is_empty() { format!("{rows} rows") } else { format!("{rows} rows, {} masked", self.mask.len()) });
        parts.join(" · ")
    }
}

/// Plane and signed θr of a geometry.
fn plane_of(geometry: Geometry) -> (f64, f64) {
    let dphi = geometry.dphi().0.rem_euclid(360.0);
    let theta_r = geometry.theta_r().0;
    if dphi > 90.0 && dphi <= 270.0 { (dphi, theta_r) } else { ((dphi + 180.0).rem_euclid(360.0), -theta_r) }
}

fn masked_rows(rows: &[Row]) -> Mask {
    rows.iter().enumerate().filter(|(_, row)| row.masked).map(|(index, _)| index).collect()
}

fn series(rows: &[Row]) -> Vec<Series> {
    let mut order: Vec<(f64, f64, f64, usize)> = rows
        .iter()
        .enumerate()
        .map(|(index, row)| {
            let (plane, theta_r) = plane_of(row.geometry);
            (row.geometry.theta_i().0, plane, theta_r, index)
        })
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.total_cmp(&b.2)));
    let mut groups: Vec<Series> = Vec::new();
    for (theta_i, plane, theta_r, index) in order {
        if groups.last().is_none_or(|last| last.theta_i != theta_i || last.plane != plane) {
            groups.push(Series { theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() });
        }
        if let Some(last) = groups.last_mut() {
            let row = &rows[index];
            let mark = |quantity| Mark { theta_r, quantity, masked: row.masked, row: index };
            last.dolp.extend(row.dolp.map(mark));
            last.brdf.extend(row.brdf.map(mark));
            last.rows.push(index);
        }
    }
    groups
}
