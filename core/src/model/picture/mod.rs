//! The picture that a polarisation camera sees of a surface: a sphere, a cylinder, a tilted plate or a rough relief under a lamp and a sky.
//!
//! The camera is orthographic and looks along −z: x runs to the right, y upwards, z towards it. Pixel (row, column) of `size`² has its centre at
//! `x = (2 column + 1)/size − 1`, `y = 1 − (2 row + 1)/size`. There are no cast shadows and no light from one part of the shape to another.
//!
//! - The **lamp** is distant and unpolarised, its irradiance across the beam is 1: a pixel shows the first column of the Mueller matrix
//!   at its (θi, θr, Δφ) times cos θi, turned from the meridian plane into the camera's frame. The half vector is the same in every pixel, and so
//!   are β, DoLP_s and the angle of polarisation, which lies across the plane of lamp and camera; what varies is the share of depolarised light.
//! - The **sky** is uniform and unpolarised: [`SkyTable`].
//!
//! In the meridian plane of a normal whose azimuth is φ, s lies at φ + 90° and p at φ + 180°: with M10 and M20 in that basis
//! `S1 = −(M10 cos 2φ − M20 sin 2φ)`, `S2 = −(M10 sin 2φ + M20 cos 2φ)`.

mod height_field;
mod lamp;
mod shape;
mod sky;
mod stokes_image;

use crate::model::batch::prepared::{BlockPoint, blocks, over};
use crate::model::batch::runner::radiances_of_blocks;
use crate::model::map_parallel::map_parallel;
use crate::model::pbrdf::mul_zero_absorbing;
use crate::model::{DolpFormula, Pbrdf, Reflection};
use crate::optics::{Degrees, Facet, Geometry};
pub use height_field::{HeightField, HeightFieldError};
pub use lamp::{Lamp, LampError};
use lamp::{cross, dot, theta_r};
pub use shape::Shape;
pub use sky::{Quality, SkyTable};
pub use stokes_image::StokesImage;

/// What lights the shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lighting<'a> {
    /// A lamp of irradiance 1 across its beam.
    pub lamp: Option<Lamp>,
    /// A sky of that radiance, and its light on the surface.
    pub sky: Option<(f64, &'a SkyTable)>,
}

/// A shape before the camera, prepared for many surfaces and lights.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    shape: Shape,
    size: usize,
    rows: Vec<Vec<Pixel>>,
}

/// A pixel with the surface that it shows.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pixel {
    column: usize,
    normal: [f64; 3],
    /// Degrees.
    theta_r: f64,
}

/// A pixel nearer than this to the limb or to the edge of its own shadow, by the cosine, is prepared from its angles.
const GRAZING: f64 = 0.02;
/// And so is one whose facets must stand steeper than that, by the cosine, to mirror the lamp.
const STEEP: f64 = 0.2;

impl Picture {
    /// Of `size`² pixels; none if it is cancelled.
    #[must_use]
    pub fn new(shape: Shape, size: usize, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let row = |row: usize| if cancelled() { None } else { Some(pixels(shape, size, row)) };
        let rows = map_parallel(size, &row).into_iter().collect::<Option<Vec<_>>>()?;
        Some(Self { shape, size, rows })
    }

    /// What the camera sees.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Pixels along an edge.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// x and y of the centre of a pixel.
    #[must_use]
    pub fn center(&self, row: usize, column: usize) -> (f64, f64) {
        center(self.size, row, column)
    }

    /// The unit normal in the centre of a pixel; none where there is no surface.
    #[must_use]
    pub fn normal(&self, row: usize, column: usize) -> Option<[f64; 3]> {
        let (x, y) = self.center(row, column);
        self.shape.normal(x, y)
    }

    /// What a surface shows; none if it is cancelled. The rows are shared among threads.
    ///
    /// The polarised part is that of the Mueller matrix, also for a surface whose DoLP is formed as printed.
    #[must_use]
    pub fn stokes(&self, surface: &Pbrdf, lighting: &Lighting<'_>, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<StokesImage> {
        let surface = surface.with_dolp_formula(DolpFormula::Consistent);
        let row = |row: usize| if cancelled() { None } else { Some(stokes_of(&self.rows[row], &surface, lighting)) };
        let rows = map_parallel(self.size, &row).into_iter().collect::<Option<Vec<_>>>()?;
        let mut image = StokesImage::blank(self.size);
        for (row, (pixels, stokes)) in self.rows.iter().zip(&rows).enumerate() {
            for (pixel, [s0, s1, s2]) in pixels.iter().zip(stokes) {
                let at = row * self.size + pixel.column;
                (image.s0[at], image.s1[at], image.s2[at]) = (*s0, *s1, *s2);
            }
        }
        Some(image)
    }
}

/// Where the centre of a pixel lies between −1 and 1.
#[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
fn center(size: usize, row: usize, column: usize) -> (f64, f64) {
    let along = |index: usize| (2.0 * index as f64 + 1.0) / size as f64 - 1.0;
    (along(column), -along(row))
}

/// The pixels of a row that show a surface.
fn pixels(shape: Shape, size: usize, row: usize) -> Vec<Pixel> {
    let pixel = |column: usize| {
        let (x, y) = center(size, row, column);
        shape.normal(x, y).map(|normal| Pixel { column, normal, theta_r: theta_r(normal) })
    };
    (0..size).filter_map(pixel).collect()
}

/// S0, S1 and S2 of some pixels.
fn stokes_of(pixels: &[Pixel], surface: &Pbrdf, lighting: &Lighting<'_>) -> Vec<[f64; 3]> {
    let mut stokes = vec![[0.0; 3]; pixels.len()];
    if let Some(lamp) = &lighting.lamp {
        add_lamp(pixels, surface, lamp, &mut stokes);
    }
    if let Some((radiance, table)) = lighting.sky {
        for (pixel, sum) in pixels.iter().zip(&mut stokes) {
            let [s0, s1] = table.at(pixel.theta_r);
            let [x, y, _] = pixel.normal;
            let sin_sq = x * x + y * y;
            let polarised = if sin_sq > 0.0 { radiance * s1 / sin_sq } else { 0.0 };
            sum[0] += radiance * s0;
            sum[1] -= polarised * (x - y) * (x + y);
            sum[2] -= polarised * 2.0 * x * y;
        }
    }
    stokes
}

/// Light of a lamp that facets and depolarising terms send to the camera.
fn add_lamp(pixels: &[Pixel], surface: &Pbrdf, lamp: &Lamp, stokes: &mut [[f64; 3]]) {
    let facets = FacetsOfLamp::new(lamp);
    let lit: Vec<(usize, LitPixel)> =
        pixels.iter().enumerate().filter_map(|(index, pixel)| LitPixel::new(pixel, lamp, &facets).map(|lit| (index, lit))).collect();
    let points: Vec<BlockPoint> = lit.iter().map(|(index, lit)| facets.point(&pixels[*index], lit)).collect();
    let [mut dolp, mut brdf, mut specular] = [(); 3].map(|()| vec![0.0; lit.len()]);
    let reflection = |point: usize| {
        let geometry = lamp.geometry(pixels[lit[point].0].normal);
        geometry.map_or_else(Reflection::default, |geometry| surface.reflection(&Facet::new(geometry)))
    };
    radiances_of_blocks(surface, &blocks(&points), lit.len(), [&mut dolp, &mut brdf, &mut specular], &reflection);
    let (along_x, along_diagonal) = lamp.polarisation();
    for (point, (index, lit)) in lit.iter().enumerate() {
        let polarised = lit.cos_i * mul_zero_absorbing(dolp[point], brdf[point]);
        let sum = &mut stokes[*index];
        sum[0] += lit.cos_i * brdf[point];
        sum[1] += polarised * along_x;
        sum[2] += polarised * along_diagonal;
    }
}

/// What the lamp does to a pixel that it reaches.
struct LitPixel {
    cos_i: f64,
    /// Where angles tell more than vectors.
    geometry: Option<Geometry>,
}

impl LitPixel {
    fn new(pixel: &Pixel, lamp: &Lamp, facets: &FacetsOfLamp) -> Option<Self> {
        let (cos_i, cos_r) = (lamp.cos_incidence(pixel.normal), pixel.normal[2]);
        // N·H = (cos θi + cos θr)/2 cos β.
        if cos_i > GRAZING && cos_r > GRAZING && cos_i + cos_r > 2.0 * STEEP * facets.cos_beta {
            return Some(Self { cos_i, geometry: None });
        }
        let geometry = lamp.geometry(pixel.normal)?;
        Some(Self { cos_i: geometry.theta_i().cos(), geometry: Some(geometry) })
    }
}

/// The facets that mirror a lamp to the camera.
struct FacetsOfLamp {
    half_vector: [f64; 3],
    cos_beta: f64,
    cos_beta_sq: f64,
    sin_beta_sq: f64,
}

impl FacetsOfLamp {
    fn new(lamp: &Lamp) -> Self {
        let (sin_beta, cos_beta) = Degrees(0.5 * lamp.polar().0).sin_cos();
        Self { half_vector: lamp.half_vector(), cos_beta, cos_beta_sq: cos_beta * cos_beta, sin_beta_sq: sin_beta * sin_beta }
    }

    /// A pixel for the kernels, without a trigonometric function.
    fn point(&self, pixel: &Pixel, lit: &LitPixel) -> BlockPoint {
        if let Some(geometry) = &lit.geometry {
            return BlockPoint::from(&Facet::new(*geometry));
        }
        let (cos_i, cos_r) = (lit.cos_i, pixel.normal[2]);
        let across = cross(pixel.normal, self.half_vector);
        let along = dot(pixel.normal, self.half_vector);
        let tan_alpha_sq = dot(across, across) / (along * along);
        let open = 1.0 / (cos_i * cos_r);
        // As in [`Facet`]: cos α cos β is the mean of both cosines.
        let g_over_cosines = open.min((cos_i + cos_r) / (self.cos_beta_sq * cos_i.max(cos_r)));
        let theta_r = Degrees(pixel.theta_r).radians();
        BlockPoint {
            sin_beta_sq: self.sin_beta_sq,
            cos_beta_sq: self.cos_beta_sq,
            tan_alpha_sq,
            over_geometric: over(tan_alpha_sq, g_over_cosines),
            over_open: over(tan_alpha_sq, open),
            log2_cosines: libm::log2(cos_i * cos_r),
            half_theta_r_sq: 0.5 * theta_r * theta_r,
        }
    }
}
