//! What panes derive, as texts: pictures and the audit of a surface, to the bit.

use crate::app::storage::session::Session;
use crate::app::tasks::bits::{AuditBits, FindingBits, SceneOrder};
use crate::app::tasks::messages::{Answer, WorkOrder, request};
use crate::app::tasks::wire::Wire;
use crate::app::work::picture_scene::{Scene, SceneKey};
use crate::files::packed::{numbers_of, text_of};
use pbrdf::model::{Audit, Check, Finding, Lamp, Model, Parameters, Pbrdf, Quality, Reflectance, StokesImage};
use pbrdf::optics::Geometry;
use std::cell::RefCell;

impl SceneOrder {
    fn key(&self) -> Option<SceneKey> {
        let lamp = match self.lamp {
            Some([polar, azimuth]) => Some(Lamp::new(polar, azimuth).ok()?),
            None => None,
        };
        let Self { shape, sky, surface, companion, .. } = *self;
        Some(SceneKey { shape, lamp, sky, surface, companion })
    }
}

/// The request for a picture of `size`² pixels; none where it cannot be written.
pub fn ask_scene(key: &SceneKey, size: usize) -> Option<String> {
    let SceneKey { shape, lamp, sky, surface, companion } = key.clone();
    let lamp = lamp.map(|lamp| [lamp.polar().0, lamp.azimuth().0]);
    alone(WorkOrder::Picture(SceneOrder { shape, lamp, sky, surface, companion, size }))
}

/// The picture out of the answer; none where it was stopped, and none of what is no answer.
pub fn told_scene(answer: &str, key: SceneKey, size: usize, before: Option<&Scene>) -> Option<Option<Scene>> {
    let Answer::Picture(images) = serde_json::from_str(answer).ok()? else { return None };
    let Some(images) = images else { return Some(None) };
    let image = |text: &String| {
        let numbers = numbers_of(text)?;
        let pixels = size * size;
        (numbers.len() == 3 * pixels).then(|| [0, 1, 2].map(|part| numbers[part * pixels..][..pixels].to_vec()))
    };
    let mut images = images.iter().map(|text| StokesImage::of_parts(size, image(text)?));
    let own = images.next()??;
    let other = match images.next() {
        Some(other) => Some(other?),
        None => None,
    };
    Some(Scene::of_images(key, own, other, before))
}

thread_local! {
    /// The picture that was made last, of which the next one takes what stays the same.
    static LAST: RefCell<Option<Scene>> = const { RefCell::new(None) };
}

/// Makes a picture.
pub fn scene(order: &SceneOrder, wire: &Wire<'_>) -> Option<Answer> {
    let before = LAST.take();
    let made = Scene::new(order.key()?, order.size, Quality::Fast, before.as_ref(), wire.is_cancelled);
    let text = |image: &StokesImage| text_of(&[&image.s0[..], &image.s1, &image.s2].concat());
    let images = made.as_ref().map(|scene| std::iter::once(&scene.image).chain(&scene.other).map(text).collect());
    LAST.set(made.or(before));
    Some(Answer::Picture(images))
}

/// The checks by their places in an answer.
const CHECKS: [Check; 7] = [
    Check::SpecularReciprocity,
    Check::DiffuseReciprocity,
    Check::VolumeReciprocity,
    Check::Reflectance,
    Check::FresnelLimit,
    Check::Admissibility,
    Check::Normalisation,
];

/// The request for the audit of a surface.
pub fn ask_audit(surface: &Pbrdf) -> Option<String> {
    alone(WorkOrder::Audit { model: surface.model(), parameters: *surface.parameters() })
}

/// The audit out of the answer.
pub fn told_audit(answer: &str) -> Option<Audit> {
    let Answer::Audit(AuditBits { findings, reflectance }) = serde_json::from_str(answer).ok()? else { return None };
    let finding = |FindingBits { check, value, bar, pass, at }: FindingBits| {
        let at = match at.map(|bits| bits.map(f64::from_bits)) {
            Some([theta_i, theta_r, dphi]) => Some(Geometry::new(theta_i, theta_r, dphi).ok()?),
            None => None,
        };
        Some(Finding { check: *CHECKS.get(check)?, value: f64::from_bits(value), bar: f64::from_bits(bar), pass, at })
    };
    let numbers = numbers_of(&reflectance)?;
    let (reflectance, rest) = numbers.as_chunks::<5>();
    let reflectance = reflectance
        .iter()
        .map(|&[theta_i, specular, diffuse, volume, error]| Reflectance::of_terms(theta_i, [specular, diffuse, volume], error));
    let findings = findings.into_iter().map(finding).collect::<Option<_>>()?;
    rest.is_empty().then(|| Audit { findings, reflectance: reflectance.collect() })
}

/// Looks at a surface.
pub fn audit(model: Model, parameters: Parameters) -> Option<Answer> {
    let Audit { findings, reflectance } = Audit::new(&Pbrdf::new(model, parameters).ok()?);
    let bits = |Finding { check, value, bar, pass, at }: &Finding| {
        let at = at.map(|at| [at.theta_i().0, at.theta_r().0, at.dphi().0].map(f64::to_bits));
        let check = CHECKS.iter().position(|other| other == check)?;
        Some(FindingBits { check, value: value.to_bits(), bar: bar.to_bits(), pass: *pass, at })
    };
    let numbers: Vec<f64> = reflectance.iter().flat_map(|at| [at.theta_i, at.specular, at.diffuse, at.volume, at.error]).collect();
    let findings = findings.iter().map(bits).collect::<Option<_>>()?;
    Some(Answer::Audit(AuditBits { findings, reflectance: text_of(&numbers) }))
}

/// A request that needs no data.
fn alone(order: WorkOrder) -> Option<String> {
    request(order, &Session::of_fits(Vec::new(), Vec::new()))
}
