//! A picture of one surface or two, and what is shown of it.

use crate::app::work::picture_options::{PictureCompanion, PictureOptions};
use crate::app::work::workspace::Workspace;
use crate::figure::ColorMap;
use crate::report::PictureQuantity;
use pbrdf::model::{Lamp, Lighting, Model, Parameters, Pbrdf, Picture, Quality, Shape, SkyTable, StokesImage};
use pbrdf::optics::Stokes;
use std::sync::Arc;

/// A model with its values.
type Values = (Model, Parameters);

/// All that a picture depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneKey {
    pub shape: Shape,
    pub lamp: Option<Lamp>,
    /// Radiance of the sky.
    pub sky: Option<f64>,
    pub surface: Values,
    pub companion: Option<Values>,
}

/// A picture as numbers.
#[derive(Debug, Clone)]
pub struct Scene {
    pub key: SceneKey,
    pub picture: Arc<Picture>,
    pub image: StokesImage,
    /// The same of the companion.
    pub other: Option<StokesImage>,
    /// Light of the sky on surfaces, for the next picture.
    tables: Vec<(Values, Arc<SkyTable>)>,
}

/// What is shown: a number in each pixel, row by row from the top, with the ends of its colours.
#[derive(Debug, Clone)]
pub struct ShownValues {
    pub values: Vec<f64>,
    pub range: (f64, f64),
    pub colors: ColorMap,
}

impl SceneKey {
    /// Of the work as it is.
    pub fn of(work: &Workspace) -> Self {
        let (options, surface) = (work.settings().panes.picture, work.surface());
        let companion = match options.companion {
            PictureCompanion::Nothing => None,
            PictureCompanion::OtherDistribution => surface.of_equal_median(),
            PictureCompanion::Pinned(place) => work.pinned().get(place).map(|pin| (pin.model, pin.parameters)),
        };
        Self {
            shape: options.shape,
            lamp: options.lamp.then(|| Lamp::new(options.polar, options.azimuth).ok()).flatten(),
            sky: options.sky.then_some(options.sky_radiance),
            surface: (surface.model, surface.parameters),
            // A slope without bounds is no surface to stand beside it.
            companion: companion.filter(|(model, parameters)| Pbrdf::new(*model, *parameters).is_ok()),
        }
    }
}

impl Scene {
    /// A picture of `size`² pixels; what is the same as in the picture before is taken from it. None where values are no surface,
    /// or if it is stopped.
    pub fn new(key: SceneKey, size: usize, quality: Quality, before: Option<&Self>, stopped: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let picture = picture(key.shape, size, before, stopped)?;
        let mut tables = Vec::new();
        let mut painted = |values: Values| {
            let surface = Pbrdf::new(values.0, values.1).ok()?;
            let sky = key.sky.map(|radiance| {
                let known = before.and_then(|before| before.tables.iter().find(|(of, _)| *of == values)).map(|(_, table)| table.clone());
                let table = known.unwrap_or_else(|| Arc::new(SkyTable::new(&surface, quality)));
                tables.push((values, table.clone()));
                (radiance, table)
            });
            let lighting = Lighting { lamp: key.lamp, sky: sky.as_ref().map(|(radiance, table)| (*radiance, &**table)) };
            picture.stokes(&surface, &lighting, stopped)
        };
        let image = painted(key.surface)?;
        let other = match key.companion {
            Some(values) => Some(painted(values)?),
            None => None,
        };
        Some(Self { key, picture, image, other, tables })
    }

    /// Of images that were made elsewhere; none where these are not of one size.
    #[cfg(any(test, target_arch = "wasm32"))]
    pub fn of_images(key: SceneKey, image: StokesImage, other: Option<StokesImage>, before: Option<&Self>) -> Option<Self> {
        let picture = picture(key.shape, image.size, before, &|| false)?;
        other.as_ref().is_none_or(|other| other.size == image.size).then_some(Self { key, picture, image, other, tables: Vec::new() })
    }

    /// The surface of the sliders on the left and the companion on the right, or the surface of the sliders alone.
    pub fn joined(&self) -> StokesImage {
        let mut joined = self.image.clone();
        let Some(other) = &self.other else { return joined };
        let right = joined.size / 2..joined.size;
        for row in 0..joined.size {
            let pixels = row * joined.size + right.start..row * joined.size + right.end;
            joined.s0[pixels.clone()].copy_from_slice(&other.s0[pixels.clone()]);
            joined.s1[pixels.clone()].copy_from_slice(&other.s1[pixels.clone()]);
            joined.s2[pixels.clone()].copy_from_slice(&other.s2[pixels]);
        }
        joined
    }

    /// What is written into files of numbers: as [`Self::joined`], or the companion less the surface of the sliders where the
    /// difference is shown.
    pub fn exported(&self, options: &PictureOptions) -> StokesImage {
        let Some(other) = self.other.as_ref().filter(|_| options.difference) else { return self.joined() };
        let less = |one: &[f64], own: &[f64]| one.iter().zip(own).map(|(one, own)| one - own).collect();
        let mut apart = self.image.clone();
        (apart.s0, apart.s1, apart.s2) =
            (less(&other.s0, &self.image.s0), less(&other.s1, &self.image.s1), less(&other.s2, &self.image.s2));
        apart
    }

    /// The Stokes vector of a pixel of [`Self::joined`]; none beside the shape.
    pub fn joined_at(&self, row: usize, column: usize) -> Option<Stokes> {
        let is_right = column >= self.image.size / 2;
        self.other.as_ref().filter(|_| is_right).unwrap_or(&self.image).at(row, column)
    }

    /// A quantity of the picture, through an analyser at that angle; of the companion less the surface of the sliders, where the
    /// difference is wanted.
    pub fn shown(&self, options: &PictureOptions) -> ShownValues {
        let (quantity, analyser) = (options.quantity, options.analyser);
        match &self.other {
            Some(other) if options.difference => {
                let pairs = quantity.values(other, analyser).into_iter().zip(quantity.values(&self.image, analyser));
                let values: Vec<f64> = pairs.map(|(other, own)| apart(quantity, other - own)).collect();
                let end = values.iter().filter(|value| value.is_finite()).fold(0.0_f64, |end, value| end.max(value.abs()));
                let end = if end > 0.0 { end } else { 1.0 };
                ShownValues { values, range: (-end, end), colors: ColorMap::Diverging }
            }
            other => {
                let joined = other.as_ref().map(|_| self.joined());
                let image = joined.as_ref().unwrap_or(&self.image);
                ShownValues { values: quantity.values(image, analyser), range: quantity.range(image), colors: quantity.colors() }
            }
        }
    }
}

/// The shape before the camera, that of the picture before where it is the same.
fn picture(shape: Shape, size: usize, before: Option<&Scene>, stopped: &(dyn Fn() -> bool + Sync)) -> Option<Arc<Picture>> {
    let kept = before.map(|before| &before.picture).filter(|picture| picture.shape() == shape && picture.size() == size);
    kept.cloned().or_else(|| Some(Arc::new(Picture::new(shape, size, stopped)?)))
}

/// A difference; of angles of polarisation, which are the same after half a turn, the smaller one.
fn apart(quantity: PictureQuantity, difference: f64) -> f64 {
    if quantity == PictureQuantity::Aop { (difference + 90.0).rem_euclid(180.0) - 90.0 } else { difference }
}

#[cfg(test)]
mod tests {
    use super::{Scene, SceneKey};
    use crate::app::work::picture_options::{PictureCompanion, PictureOptions};
    use crate::app::work::workspace::Workspace;
    use crate::report::PictureQuantity;
    use pbrdf::model::Quality;
    use std::sync::Arc;

    fn scene(options: PictureOptions, before: Option<&Scene>) -> Scene {
        let mut work = Workspace::default();
        work.apply(crate::app::work::edit::Edit::SetPictureOptions(options));
        Scene::new(SceneKey::of(&work), 32, Quality::Fast, before, &|| false).expect("a surface")
    }

    #[test]
    fn the_companion_is_the_right_half_or_is_subtracted() {
        let beside = PictureOptions { companion: PictureCompanion::OtherDistribution, sky: true, ..PictureOptions::default() };
        let made = scene(beside, None);
        let (own, other, joined) = (&made.image, made.other.as_ref().expect("two surfaces"), made.joined());
        for (row, column) in [(16, 10), (20, 20), (8, 15), (12, 16)] {
            let wanted = if column < 16 { own } else { other };
            assert_eq!(joined.at(row, column), wanted.at(row, column));
            assert_ne!(own.at(row, column), other.at(row, column));
        }
        let shown = made.shown(&PictureOptions { quantity: PictureQuantity::Dolp, difference: true, ..beside });
        let pixel = 16 * 32 + 10;
        assert!((shown.values[pixel] - (other.dolp()[pixel] - own.dolp()[pixel])).abs() < 1e-15);
        assert!(shown.range.0 == -shown.range.1);
        let exported = made.exported(&PictureOptions { difference: true, ..beside });
        assert_eq!((exported.s0[pixel], exported.s2[pixel]), (other.s0[pixel] - own.s0[pixel], other.s2[pixel] - own.s2[pixel]));
        assert_eq!(made.exported(&beside).s1[pixel], made.joined().s1[pixel]);
        // Under the lamp alone both polarise in one direction: no difference of angles, also across 0° and 180°.
        let lamp = PictureOptions { quantity: PictureQuantity::Aop, difference: true, sky: false, azimuth: 90.0, ..beside };
        let shown = scene(lamp, Some(&made)).shown(&lamp);
        assert!(shown.values.iter().filter(|angle| angle.is_finite()).all(|angle| angle.abs() < 1e-9));
    }

    #[test]
    fn what_stays_the_same_is_kept() {
        let first = scene(PictureOptions { sky: true, ..PictureOptions::default() }, None);
        let second = scene(PictureOptions { sky: true, polar: 50.0, ..PictureOptions::default() }, Some(&first));
        assert!(Arc::ptr_eq(&first.picture, &second.picture) && Arc::ptr_eq(&first.tables[0].1, &second.tables[0].1));
        assert_ne!(first.image.s0, second.image.s0);
    }
}
