//! The picture that a polarisation camera sees of the surface: a shape under a lamp and a sky, beside another surface if wanted.
//!
//! A job makes the picture and its colours; the pane puts them on the screen. Dragging on the picture moves the highlight, and the
//! lamp with it.

mod canvas;
mod controls;
mod painted;

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::jobs::memo::Memo;
use crate::app::plots::BAR_ROOM;
use crate::app::text::explained::Explained as _;
use crate::app::text::numbers::significant;
use crate::app::views::action::Action;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::MOST_POINTS;
use crate::app::views::pointing::PickedDirection;
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::picture_options::PictureOptions;
use crate::app::work::picture_scene::SceneKey;
use crate::figure::Figure;
use crate::report::PictureQuantity;
use canvas::{MeasuredMark, PictureCanvas};
use egui::text::CCursor;
use egui::{Align, Layout, Role, Ui, WidgetInfo, vec2};
use painted::{PaintedKey, PaintedScene};
use pbrdf::model::{Lamp, Pbrdf, Shape};
use pbrdf::optics::{Geometry, Stokes};
use std::time::Duration;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Picture",
    tooltip: "What a polarisation camera sees of a sphere, a cylinder, a plate or a relief under a lamp and a sky",
    shortcut: None,
    has_options: true,
    has_figure: true,
    new: || Box::new(PictureView::default()),
};

/// How long a frame waits for the picture of the frame before: a quarter of the 16 ms that a frame has.
const PATIENCE: Duration = Duration::from_millis(4);

/// What the pane keeps.
#[derive(Default)]
pub struct PictureView {
    job: AsyncMemo<PaintedKey, Option<PaintedScene>>,
    canvas: PictureCanvas,
    /// The analyser turns by itself: how far it has turned from its setting, degrees.
    turned: Option<f64>,
    /// Measured directions by the measurement, where the lamp is and the shape.
    measured: Memo<(u64, Option<Lamp>, Shape), Vec<MeasuredMark>>,
    /// What was clicked: x and y.
    chosen: Option<[f64; 2]>,
}

/// How fast the analyser turns by itself, degrees per second.
const TURN: f64 = 30.0;
/// A measured direction is seen under the lamp where twice its β is the lamp's angle from the camera to this, in degrees.
const SEEN: f64 = 1.0;

/// Measured directions on the sphere, each under a lamp at the azimuth of the present one.
fn measured(document: &OpenMeasurement, lamp: Option<Lamp>, shape: Shape) -> Vec<MeasuredMark> {
    let Some(lamp) = lamp.filter(|_| shape == Shape::Sphere) else { return Vec::new() };
    let geometries = document.measurement.rows.iter().map(|row| row.geometry);
    let mark = |geometry: Geometry| {
        let (own, [x, y, _]) = Lamp::facing(geometry, lamp.azimuth().0)?;
        Some(MeasuredMark { at: [x, y], seen: (own.polar().0 - lamp.polar().0).abs() < SEEN })
    };
    geometries.filter_map(mark).take(MOST_POINTS).collect()
}

impl PictureView {
    /// The newest picture.
    fn made(&self) -> Option<&PaintedScene> {
        self.job.get()?.as_ref()
    }

    /// The options with the analyser where it has turned to.
    fn options(&self, cx: &Cx<'_>) -> PictureOptions {
        let set = cx.work.settings().panes.picture;
        PictureOptions { analyser: (set.analyser + self.turned.unwrap_or(0.0)).rem_euclid(180.0), ..set }
    }

    /// What is known at a place of the picture; none beside the shape.
    fn reading(&self, [x, y]: [f64; 2], options: &PictureOptions) -> Option<String> {
        let scene = &self.made()?.scene;
        let (row, column) = canvas::pixel([x, y], scene.image.size)?;
        let normal = scene.picture.normal(row, column)?;
        let geometry = scene.key.lamp.and_then(|lamp| lamp.geometry(normal));
        let angles = match geometry {
            Some(at) => {
                let [theta_i, theta_r, dphi] = [at.theta_i(), at.theta_r(), at.dphi()].map(|angle| format!("{:.1}", angle.0));
                tr!("θi = {0}°, θr = {1}°, Δφ = {2}°", theta_i, theta_r, dphi)
            }
            None if scene.key.lamp.is_some() => tr!("in its own shadow"),
            None => tr!("θr = {}°", format!("{:.1}", libm::acos(normal[2].min(1.0)).to_degrees())),
        };
        if options.difference && scene.other.is_some() {
            let value = self.made()?.values[row * scene.image.size + column];
            return Some(tr!("{0}: difference {1}", angles, significant(value)));
        }
        let stokes = scene.joined_at(row, column)?;
        Some(format!("{angles}: {}", stokes_text(stokes, options)))
    }

    /// The angles of a place that was clicked, for all other plots.
    fn direction(&self, [x, y]: [f64; 2]) -> Option<PickedDirection> {
        let scene = &self.made()?.scene;
        let (row, column) = canvas::pixel([x, y], scene.image.size)?;
        let geometry = scene.key.lamp?.geometry(scene.picture.normal(row, column)?)?;
        let round = |degrees: f64| (degrees * 100.0).round() / 100.0;
        let theta_i = round(geometry.theta_i().0).min(89.99);
        let theta_r = round(geometry.theta_r().0);
        Some(PickedDirection { theta_i, theta_r, dphi: round(geometry.dphi().0.rem_euclid(360.0)) })
    }

    /// What the picture teaches under this light.
    fn lesson(&self) -> Option<String> {
        let made = self.made()?;
        let key = &made.scene.key;
        match (key.lamp, key.sky) {
            (Some(_), None) => {
                let limit = made.fresnel_limit?;
                Some(tr!(
                    "One half vector in every pixel: the angle of polarisation and {0} are uniform; what varies is the depolarised share.",
                    format!("{LIMIT} = {limit:.3}")
                ))
            }
            (None, Some(_)) => {
                Some(tr!("A sky alone: only θr counts, and light swings along circles around the middle. DoLP is greatest in a ring."))
            }
            _ => None,
        }
    }

    /// What is seen, under which light, through which analyser and beside what.
    fn controls_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let mut set = cx.work.settings().panes.picture;
        controls::content_ui(&mut set, ui);
        controls::light_ui(&mut set, ui);
        controls::analyser_ui(&mut set, &mut self.turned, ui);
        controls::companion_ui(&mut set, cx.work.surface().model.distribution, cx.work.pinned(), ui);
        if set != cx.work.settings().panes.picture {
            cx.edits.push(Edit::SetPictureOptions(set));
        }
    }

    /// Whether a picture is being made.
    #[cfg(test)]
    pub fn is_running(&self) -> bool {
        self.job.is_running()
    }

    /// The newest picture's numbers.
    #[cfg(test)]
    pub fn scene(&self) -> Option<&crate::app::work::picture_scene::Scene> {
        self.made().map(|made| &*made.scene)
    }
}

/// Between the picture and words beside it, and their width at least and at most.
const GAP: f32 = 12.0;
const WORDS: [f32; 2] = [150.0, 320.0];

/// Side of the picture from which the words of the lesson stand under it.
const SMALL: f32 = 200.0;
const SMALL_PRESENTED: f32 = 400.0;

/// What a text takes of the height of the pane, on as many lines as it needs.
fn wrapped_height(text: &str, width: f32, ui: &Ui) -> f32 {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let galley = ui.painter().layout(text.to_owned(), font, egui::Color32::PLACEHOLDER, width);
    galley.size().y + ui.spacing().item_spacing.y
}

/// What the picture teaches, with its one word of jargon explained where it stands.
fn lesson_ui(text: &str, ui: &mut Ui) {
    let (at, galley, response) = egui::Label::new(egui::RichText::new(text).weak()).wrap().layout_in_ui(ui);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
    ui.painter().galley(at, galley.clone(), ui.visuals().weak_text_color());
    let Some((before, _)) = text.split_once(LIMIT) else { return };
    let first = before.chars().count();
    let place =
        |index: usize, prefer_next_row| galley.pos_from_cursor(CCursor { index: index.into(), prefer_next_row }).translate(at.to_vec2());
    let word = place(first, true).union(place(first + LIMIT.len(), false));
    ui.interact(word, response.id.with(LIMIT), egui::Sense::CLICK)
        .explained(tr!("DoLP of the facets alone: what polarises, without the diffuse and the volume term"));
}

/// DoLP of the specular term.
const LIMIT: &str = "DoLP_s";

/// A Stokes vector in words.
fn stokes_text(stokes: Stokes, options: &PictureOptions) -> String {
    let [s0, s1, s2, _] = stokes.0.into();
    let angle = stokes.angle().map_or_else(|| "–".to_owned(), |angle| format!("{angle:.1}°"));
    let text = tr!("S0 = {0}, DoLP = {1}, angle of polarisation {2}", significant(s0), format!("{:.4}", stokes.dolp()), angle);
    match options.quantity {
        PictureQuantity::S1 => format!("{text}, S1 = {}", significant(s1)),
        PictureQuantity::S2 => format!("{text}, S2 = {}", significant(s2)),
        _ => text,
    }
}

impl View for PictureView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let options = self.options(cx);
        let key = PaintedKey { scene: SceneKey::of(cx.work), options, held: cx.interacting };
        // Values that are not numbers differ from themselves: a job would follow a job for ever.
        let (model, parameters) = key.scene.surface;
        if Pbrdf::new(model, parameters).is_err() {
            self.job = AsyncMemo::default();
            return;
        }
        let lamp = key.scene.lamp;
        self.measured.refresh((cx.work.active().generation, lamp, options.shape), |_| measured(cx.work.active(), lamp, options.shape));
        let before = self.made().map(|made| (made.scene.clone(), made.held_range(&key)));
        #[cfg(target_arch = "wasm32")]
        if self.refresh_beside(cx, &key, before.as_ref()) {
            return;
        }
        let own = key.clone();
        self.job.set_patience(PATIENCE);
        self.job.refresh(&cx.jobs.spawner, &key, move |stopped| PaintedScene::new(own, before, stopped));
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        if !cx.is_presented {
            self.controls_ui(cx, ui);
        }
        let own = cx.work.surface().model.distribution;
        let mut set = cx.work.settings().panes.picture;
        self.turned = self.turned.filter(|_| set.quantity == PictureQuantity::Analyser);
        if let Some(turned) = &mut self.turned {
            *turned = (*turned + TURN * f64::from(ui.input(|input| input.stable_dt.min(0.1)))).rem_euclid(180.0);
            ui.ctx().request_repaint();
        }
        let options = self.options(cx);
        let hint = tr!("The pointer reads a pixel; a click takes its θi, θr and Δφ to the other plots; dragging moves the lamp.");
        let lesson = self.lesson();
        // The room of the hint, whatever is read: the picture does not jump.
        let size = ui.available_size();
        // Where there is room beside the picture, words stand there.
        let beside = (size.x - size.y - BAR_ROOM - GAP).min(WORDS[1]);
        let is_beside = beside > WORDS[0];
        let room = wrapped_height(&hint, if is_beside { beside } else { size.x }, ui);
        let of_lesson = |lesson: &String| wrapped_height(lesson, if is_beside { beside } else { size.x }, ui);
        // In a small pane the picture comes first.
        let small = if cx.is_presented { SMALL_PRESENTED } else { SMALL };
        let has_room = |lesson: &String| is_beside && room + of_lesson(lesson) <= size.y || size.y - room - of_lesson(lesson) > small;
        let lesson = lesson.filter(has_room);
        let below = room + lesson.as_ref().map_or(0.0, of_lesson);
        let side = (size.y - if is_beside { 0.0 } else { below }).max(60.0);
        let layout = if is_beside { Layout::left_to_right(Align::Min) } else { Layout::top_down(Align::Min) };
        ui.with_layout(layout, |ui| {
            let mut pointer = None;
            if let Some(Some(made)) = self.job.get() {
                let marks = self.measured.get().map_or(&[][..], Vec::as_slice);
                let width = if is_beside { size.x - beside - GAP } else { size.x };
                let shown = &made.key.options;
                let halves = controls::half_names(shown.companion, own, cx.work.pinned()).filter(|_| !shown.difference);
                let touched = self.canvas.ui(made, (marks, self.chosen, halves), vec2(width, side), ui);
                pointer = touched.hovered;
                if let Some((polar, azimuth)) = touched.lamp.filter(|_| set.lamp) {
                    (set.polar, set.azimuth) = (polar, azimuth);
                }
                if let Some(at) = touched.clicked {
                    // Beside the shape, and in its shadow, there is nothing to choose.
                    if let Some(picked) = self.direction(at) {
                        self.chosen = Some(at);
                        cx.edits.push(Edit::SetDirection { theta_i: picked.theta_i, dphi: picked.dphi });
                        cx.actions.push(Action::MarkDirection(picked));
                    }
                }
            }
            ui.vertical(|ui| {
                let reading = pointer.and_then(|at| self.reading(at, &options));
                ui.scope(|ui| {
                    ui.set_min_height(room - ui.spacing().item_spacing.y);
                    ui.add(egui::Label::new(reading.unwrap_or(hint)).wrap());
                });
                lesson.iter().for_each(|lesson| lesson_ui(lesson, ui));
            });
        });
        if set != cx.work.settings().panes.picture {
            cx.edits.push(Edit::SetPictureOptions(set));
        }
    }

    fn has_options_beside(&self, cx: &Cx<'_>) -> bool {
        !cx.is_presented
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        self.controls_ui(cx, ui);
    }

    fn figure(&self, cx: &Cx<'_>) -> Option<Figure> {
        Some(self.made()?.figure(cx.work.active().title()))
    }

    fn suspend(&mut self) {
        self.job.stop_if(|_| true);
        self.turned = None;
    }

    fn lag(&self) -> u64 {
        self.job.frames_behind()
    }
}

/// The picture before, and the ends of its colours where they are kept.
#[cfg(target_arch = "wasm32")]
type Before = (std::sync::Arc<crate::app::work::picture_scene::Scene>, Option<crate::app::plots::Range>);

#[cfg(target_arch = "wasm32")]
impl PictureView {
    /// Has a worker of the page make the picture; whether one does. Where only its colours are others, there is nothing to make.
    fn refresh_beside(&mut self, cx: &Cx<'_>, key: &PaintedKey, before: Option<&Before>) -> bool {
        use crate::app::tasks::view_message::{ask_scene, told_scene};
        let (before, held) = before.map_or((None, None), |(scene, range)| (Some(scene.clone()), *range));
        self.job.refresh_beside(&cx.jobs.spawner, key, || {
            if before.as_ref().is_some_and(|scene| scene.key == key.scene) {
                return None;
            }
            let (own, size) = (key.clone(), painted::size(&key.scene));
            let request = ask_scene(&key.scene, size)?;
            Some((request, move |answer: &str| {
                let scene = told_scene(answer, own.scene.clone(), size, before.as_deref())?;
                Some(scene.map(|scene| PaintedScene::of(own, std::sync::Arc::new(scene), held)))
            }))
        })
    }
}
