//! What the job of the picture makes: numbers, and their colours.

use crate::app::jobs::async_memo::Stopped;
use crate::app::platform;
use crate::app::plots::{ColorScale, Range};
use crate::app::work::picture_options::PictureOptions;
use crate::app::work::picture_scene::{Scene, SceneKey};
use crate::figure::{Axis, ColorMap, Figure};
use crate::report::{PictureQuantity, picture_figure, picture_map};
use egui::ColorImage;
use pbrdf::model::{Diffuse, Model, Pbrdf, Quality};
use pbrdf::optics::{Facet, Geometry};
use std::sync::Arc;
use tr::tr;

/// Pixels along an edge; in a page, whose thread reads and colours what a worker made, a quarter of them.
const SIZE: usize = if platform::IS_PAGE { 256 } else { 512 };
/// The same of Hyde's model, which takes an integral for every angle of incidence.
const SLOW_SIZE: usize = if platform::IS_PAGE { 64 } else { 128 };

/// All that the job depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct PaintedKey {
    pub scene: SceneKey,
    pub options: PictureOptions,
    /// Whether a button of the mouse is down: the ends of the colours then grow and do not shrink.
    pub held: bool,
}

/// A picture with its colours.
pub struct PaintedScene {
    pub key: PaintedKey,
    pub scene: Arc<Scene>,
    pub values: Vec<f64>,
    pub scale: ColorScale,
    pub pixels: Arc<ColorImage>,
    /// DoLP_s of the surface of the sliders under the lamp, the same in every pixel.
    pub fresnel_limit: Option<f64>,
}

impl PaintedScene {
    /// After the picture before and the ends of its colours, as far as they are still of use.
    pub fn new(key: PaintedKey, before: Option<(Arc<Scene>, Option<Range>)>, stopped: Stopped<'_>) -> Option<Self> {
        let (before, held) = before.map_or((None, None), |(scene, range)| (Some(scene), range));
        let scene = match before {
            Some(scene) if scene.key == key.scene => scene,
            before => Arc::new(Scene::new(key.scene.clone(), size(&key.scene), Quality::Fast, before.as_deref(), stopped)?),
        };
        Some(Self::of(key, scene, held))
    }

    /// A picture in its colours, whose ends were those before.
    pub fn of(key: PaintedKey, scene: Arc<Scene>, held: Option<Range>) -> Self {
        let shown = scene.shown(&key.options);
        let (low, high) = shown.range;
        let range = held.map_or(Range { low, high }, |held| Range { low: held.low.min(low), high: held.high.max(high) });
        let scale = ColorScale { map: shown.colors, range };
        let table = scale.table();
        let size = scene.image.size;
        let pixels = Arc::new(ColorImage::new([size, size], shown.values.iter().map(|value| table.color(*value)).collect()));
        let fresnel_limit = fresnel_limit(&key.scene);
        Self { key, scene, values: shown.values, scale, pixels, fresnel_limit }
    }

    /// The ends of the colours, where they are to be kept for that picture.
    pub fn held_range(&self, next: &PaintedKey) -> Option<Range> {
        let same = next.options.quantity == self.key.options.quantity && self.is_difference() == is_difference(next);
        (next.held && same).then_some(self.scale.range)
    }

    fn is_difference(&self) -> bool {
        is_difference(&self.key)
    }

    /// The axis of the colours.
    pub fn axis(&self) -> Axis {
        let Range { low, high } = self.scale.range;
        let axis = axis(self.key.options.quantity);
        let axis = if self.is_difference() { Axis { label: tr!("Δ {}", axis.label), ticks: None, ..axis } } else { axis };
        axis.between(low, high)
    }

    /// The picture as a figure.
    pub fn figure(&self, title: String) -> Figure {
        let map: ColorMap = self.scale.map;
        picture_figure(title, picture_map(&self.values, self.scene.image.size, self.axis(), map))
    }
}

/// Pixels along an edge.
pub fn size(key: &SceneKey) -> usize {
    let is_slow = |model: Model| model.specular && model.diffuse == Diffuse::Hyde;
    let companion = key.companion.is_some_and(|(model, _)| is_slow(model));
    if is_slow(key.surface.0) || companion { SLOW_SIZE } else { SIZE }
}

/// DoLP_s under a lamp: β is half its angle from the camera.
fn fresnel_limit(key: &SceneKey) -> Option<f64> {
    let half = 0.5 * key.lamp?.polar().0;
    let facet = Facet::new(Geometry::new(half, half, 180.0).ok()?);
    Some(Pbrdf::new(key.surface.0, key.surface.1).ok()?.fresnel_limit(&facet))
}

fn is_difference(key: &PaintedKey) -> bool {
    key.options.difference && key.scene.companion.is_some()
}

/// The name of a quantity and what the pointer finds out about it.
pub fn texts(quantity: PictureQuantity) -> [String; 2] {
    match quantity {
        PictureQuantity::S0 => [tr!("Radiance"), tr!("S0, for a lamp of irradiance 1 across its beam")],
        PictureQuantity::Dolp => [tr!("DoLP"), tr!("Degree of linear polarisation, √(S1² + S2²)/S0")],
        PictureQuantity::Aop => [tr!("Angle"), tr!("Angle of polarisation, ½ atan2(S2, S1), from right to up; the colours are cyclic")],
        PictureQuantity::Analyser => [tr!("Analyser"), tr!("Radiance through a polariser at an angle: Malus's law in every pixel")],
        PictureQuantity::S1 => ["S1".to_owned(), tr!("Radiance polarised along x less that along y, with its sign")],
        PictureQuantity::S2 => ["S2".to_owned(), tr!("Radiance polarised along the diagonal less that across it, with its sign")],
    }
}

/// The axis of its colours, without ends.
fn axis(quantity: PictureQuantity) -> Axis {
    let label = match quantity {
        PictureQuantity::S0 => tr!("radiance S0"),
        PictureQuantity::Aop => tr!("Angle"),
        PictureQuantity::Analyser => tr!("radiance"),
        PictureQuantity::Dolp | PictureQuantity::S1 | PictureQuantity::S2 => return quantity.axis(),
    };
    Axis { label, ..quantity.axis() }
}
