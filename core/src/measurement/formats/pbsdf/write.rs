//! Writes a surface as a tensor file that Mitsuba 3 renders.
//!
//! φ_d spans all of −180° to 180°, since the volume lobe depends on θr alone and so distinguishes
//! light and eye. θ_h is dense around 0, where the specular lobe is: the plugin takes nodes at any
//! distance. Nodes with a ray below the horizon continue the values of the rim; the data base has
//! NaN there, which would darken every cell that the horizon cuts. One band: the plugin takes it
//! for every wavelength. In the plugin S3 has the opposite sign.

use super::error::TensorType;
use super::read::MAGIC;
use crate::measurement::Progress;
use crate::measurement::rusinkiewicz::geometry_of;
use crate::model::Pbrdf;
use crate::optics::{Facet, Mueller};
use std::f64::consts::{FRAC_PI_2, PI};
use std::io::{self, Write};

/// How many nodes each angle has; at least 2 of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TensorResolution {
    /// Over −180° to 180°.
    pub phi_d: usize,
    /// Over 0° to 90°.
    pub theta_d: usize,
    /// Over 0° to 90°.
    pub theta_h: usize,
}

impl Default for TensorResolution {
    /// 5° by 1.5° by a grid that follows the lobe: 18 MB.
    fn default() -> Self {
        Self { phi_d: 73, theta_d: 61, theta_h: 64 }
    }
}

/// The nodes, in radians.
#[derive(Debug, Clone, PartialEq)]
pub struct TensorGrid {
    phi_d: Vec<f32>,
    theta_d: Vec<f32>,
    theta_h: Vec<f32>,
}

/// Nodes within the median slope of the lobe, near its top.
const NODES_PER_LOBE: f64 = 12.0;
/// Rays below the horizon are lifted to this zenith angle in degrees.
const RIM: f64 = 89.5;
/// The plugin reads five wavelengths whatever their number.
const WAVELENGTHS_READ: usize = 5;
/// Offsets of fields are multiples of this many bytes.
const ALIGNMENT: usize = 8;

impl TensorGrid {
    /// Nodes for a surface.
    #[must_use]
    pub fn new(surface: &Pbrdf, resolution: TensorResolution) -> Self {
        let TensorResolution { phi_d, theta_d, theta_h } = resolution;
        let parameters = surface.parameters();
        let lobe = libm::atan(surface.model().distribution.median_slope(parameters.sigma, parameters.q));
        let stretch = if surface.model().specular { stretch_for(lobe / NODES_PER_LOBE, theta_h) } else { 0.0 };
        Self {
            phi_d: nodes(phi_d, |share| PI * (2.0 * share - 1.0)),
            theta_d: nodes(theta_d, |share| FRAC_PI_2 * share),
            theta_h: nodes(theta_h, |share| FRAC_PI_2 * stretched(share, stretch)),
        }
    }

    fn lengths(&self) -> [usize; 6] {
        [self.phi_d.len(), self.theta_d.len(), self.theta_h.len(), 1, 4, 4]
    }
}

/// `sinh(κ u)/sinh κ`, which for κ = 0 is u.
fn stretched(share: f64, stretch: f64) -> f64 {
    if stretch > 0.0 { libm::sinh(stretch * share) / libm::sinh(stretch) } else { share }
}

/// The κ that makes the first step that wide, in radians; 0 where even steps are narrower. At most
/// 20, so that all nodes differ in f32.
fn stretch_for(first: f64, count: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "grids have few angles")]
    let share = 1.0 / (count.max(2) - 1) as f64;
    let (mut low, mut high) = (0.0, 20.0);
    if FRAC_PI_2 * share <= first {
        return 0.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if FRAC_PI_2 * stretched(share, middle) > first {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn nodes(count: usize, at: impl Fn(f64) -> f64) -> Vec<f32> {
    let last = count.max(2) - 1;
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "few angles, and the format has f32")]
    (0..=last).map(|i| at(i as f64 / last as f64) as f32).collect()
}

/// Writes a surface as a tensor file, with `wavelength_nm` as its one band.
///
/// # Errors
/// An error of `out`; of the kind `Interrupted` if `progress` stops the writing.
pub fn write_tensor(surface: &Pbrdf, grid: &TensorGrid, wavelength_nm: u16, progress: Progress<'_>, mut out: impl Write) -> io::Result<()> {
    write_head(grid, wavelength_nm, &mut out)?;
    let mut row = Vec::new();
    for (i, &phi_d) in grid.phi_d.iter().enumerate() {
        row.clear();
        for &theta_d in &grid.theta_d {
            for &theta_h in &grid.theta_h {
                let mueller = matrix(surface, [phi_d, theta_d, theta_h].map(f64::from));
                for element in 0..16 {
                    row.extend(f32_of(mueller.element(element / 4, element % 4), element).to_le_bytes());
                }
            }
        }
        out.write_all(&row)?;
        #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress bar")]
        if progress((i + 1) as f64 / grid.phi_d.len() as f64).is_break() {
            return Err(io::ErrorKind::Interrupted.into());
        }
    }
    out.flush()
}

/// The matrix at a node, in the facet's plane of incidence.
fn matrix(surface: &Pbrdf, angles: [f64; 3]) -> Mueller {
    match geometry_of(angles, RIM) {
        Some(geometry) => surface.mueller_in_facet_plane(&Facet::new(geometry)),
        // Zenith angles end at the rim: every node of a grid has a geometry.
        None => Mueller::depolarizer(0.0),
    }
}

/// An element as the format holds it: limited to the range of f32; row and column 3 (S3) change
/// sign.
fn f32_of(value: f64, element: usize) -> f32 {
    let flips = (element / 4 == 3) != (element % 4 == 3);
    let largest = f64::from(f32::MAX);
    let value = if flips { -value } else { value };
    #[expect(clippy::cast_possible_truncation, reason = "the format has f32; limited to its range")]
    let single = value.clamp(-largest, largest) as f32;
    // Adding 0 turns -0 into 0.
    single + 0.0
}

/// Everything before M.
fn write_head(grid: &TensorGrid, wavelength_nm: u16, out: &mut impl Write) -> io::Result<()> {
    let angles = |angles: &[f32]| angles.iter().flat_map(|angle| angle.to_le_bytes()).collect::<Vec<u8>>();
    let wavelengths = [wavelength_nm; WAVELENGTHS_READ].iter().flat_map(|nm| nm.to_le_bytes()).collect::<Vec<u8>>();
    let [phi_d, theta_d, theta_h, ..] = grid.lengths();
    let fields: [(&str, TensorType, Vec<usize>, Vec<u8>); 5] = [
        ("phi_d", TensorType::F32, vec![1, phi_d], angles(&grid.phi_d)),
        ("theta_d", TensorType::F32, vec![1, theta_d], angles(&grid.theta_d)),
        ("theta_h", TensorType::F32, vec![1, theta_h], angles(&grid.theta_h)),
        ("wvls", TensorType::U16, vec![1], wavelengths),
        ("M", TensorType::F32, grid.lengths().to_vec(), Vec::new()),
    ];
    let entry_length = |(name, _, shape, _): &(&str, TensorType, Vec<usize>, Vec<u8>)| 2 + name.len() + 2 + 1 + 8 + 8 * shape.len();
    let mut offset = MAGIC.len() + 2 + 4 + fields.iter().map(entry_length).sum::<usize>();
    let mut head = MAGIC.to_vec();
    head.extend([1, 0]);
    head.extend(5_u32.to_le_bytes());
    let mut body = Vec::new();
    for (name, kind, shape, data) in fields {
        // Names and shapes of this file are short.
        let short = |length: usize| u16::try_from(length).unwrap_or(u16::MAX).to_le_bytes();
        let padding = offset.next_multiple_of(ALIGNMENT) - offset;
        body.resize(body.len() + padding, 0);
        offset += padding;
        head.extend(short(name.len()));
        head.extend(name.as_bytes());
        head.extend(short(shape.len()));
        head.push(kind.code());
        head.extend((offset as u64).to_le_bytes());
        shape.iter().for_each(|&length| head.extend((length as u64).to_le_bytes()));
        offset += data.len();
        body.extend(data);
    }
    out.write_all(&head)?;
    out.write_all(&body)
}
