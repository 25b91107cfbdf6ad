//! Hemisphere map: DoLP, angle of polarisation, BRDF or specular share over all directions of view at the sliders' θi.
//!
//! The disc is that of [`pbrdf::model::Hemisphere`]: light from the left, forward side to the right, θr = 90° at the rim.

mod disc;
mod map;

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::{FOREGROUND, MARK, WHITE};
use crate::app::plots::{AutoRange, BAR_ROOM, BarLabels, BarMarks, ColorScale, color_bar};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::MOST_POINTS;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::settings::HemisphereQuantity;
use crate::figure::{Axis, Dash, Figure, Panel, Point, Series, Symbol};
use disc::{Disc, MARGIN, incident_mark, legend_ui, measured_mark, mirror_mark};
use egui::{Color32, ColorImage, Key, Pos2, Rect, Sense, TextureHandle, TextureOptions, Ui, Vec2, vec2};
use map::{Made, MapKey, SIZE, index, place, values, wanted};
use pbrdf::model::Pbrdf;
use pbrdf::optics::{Degrees, Geometry};
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Hemisphere",
    tooltip: "DoLP, angle of polarisation, BRDF or specular share over all directions of view, also outside the plane of incidence",
    shortcut: Some(Key::Num5),
    has_options: false,
    has_figure: true,
    new: || Box::new(HemisphereView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct HemisphereView {
    job: AsyncMemo<MapKey, Option<Made>>,
    ranges: [AutoRange; HemisphereQuantity::ALL.len()],
    colored: Memo<(MapKey, HemisphereQuantity, ColorScale), ()>,
    /// An image that the texture does not show yet.
    fresh: Option<ColorImage>,
    texture: Option<TextureHandle>,
    /// Directions measured at the sliders' θi, as places on the disc of radius 1.
    measured: Memo<(u64, f64), Vec<Vec2>>,
}

impl HemisphereQuantity {
    /// Its name and what the pointer finds out about it.
    fn texts(self) -> [String; 2] {
        match self {
            Self::Dolp => [tr!("DoLP"), tr!("Degree of linear polarisation for unpolarised light in, Eq. (17)")],
            Self::Angle => [
                tr!("Angle of polarisation"),
                tr!("½ atan2(F20, F10): how far the electric vector is turned from s, which is horizontal, towards p"),
            ],
            Self::Brdf => [tr!("BRDF"), tr!("F00, Eq. (14), on a logarithmic scale")],
            Self::SpecularShare => [tr!("Specular share"), tr!("The specular lobe's part of the radiance")],
        }
    }

    /// The axis of its colours in a figure.
    fn axis(self) -> Axis {
        match self {
            Self::Dolp => Axis::linear("DoLP", ""),
            Self::Angle => Axis::linear(tr!("angle of polarisation"), "°"),
            Self::Brdf => Axis::log("BRDF", "sr⁻¹"),
            Self::SpecularShare => Axis::linear(tr!("specular share"), ""),
        }
    }

    /// A value in words.
    fn reading(self, value: f64) -> String {
        match self {
            _ if value.is_nan() => tr!("nothing to tell"),
            Self::Dolp => tr!("DoLP = {}", format!("{value:.5}")),
            Self::Angle => tr!("angle of polarisation = {}°", format!("{:.2}", value + 0.0)),
            Self::Brdf => tr!("BRDF = {} 1/sr", format!("{:.4e}", libm::exp10(value))),
            Self::SpecularShare => tr!("specular share = {}", format!("{value:.5}")),
        }
    }
}

impl HemisphereView {
    /// What is known at a place of the disc, x to the right and y upwards; none outside it.
    fn reading(&self, x: f64, y: f64, quantity: HemisphereQuantity) -> Option<String> {
        let map = &self.job.get()?.as_ref()?.map;
        let (row, column) = (index(y)?, index(x)?);
        let (theta_r, dphi) = map.direction(row, column)?;
        let value = values(map, quantity)[row * SIZE + column];
        let at = tr!("θr = {}°, Δφ = {}°", format!("{theta_r:.2}"), format!("{dphi:.2}"));
        Some(format!("{at}: {}", quantity.reading(value)))
    }

    /// Whether a map is being made.
    #[cfg(test)]
    pub fn is_running(&self) -> bool {
        self.job.is_running()
    }

    /// Whether the next frame changes the texture.
    #[cfg(test)]
    pub fn is_fresh(&self) -> bool {
        self.fresh.is_some()
    }

    /// The inputs of the newest map.
    #[cfg(test)]
    pub fn key(&self) -> Option<&MapKey> {
        self.job.key()
    }

    /// The disc with its colours, and what lies on it.
    fn disc_ui(&mut self, theta_i: f64, quantity: HemisphereQuantity, room: Vec2, ui: &mut Ui) -> Option<String> {
        let (rect, response) = ui.allocate_exact_size(room, Sense::hover());
        let radius = 0.5 * (room.x - 2.0 * MARGIN.x - BAR_ROOM).min(room.y - 2.0 * MARGIN.y).max(20.0);
        let disc = Disc { center: rect.center() - vec2(0.5 * BAR_ROOM, 0.0), radius };
        let painter = ui.painter_at(rect);
        let (ink, dark) = (ui.visuals().text_color(), ui.visuals().dark_mode);
        let is_there = matches!(self.job.get(), Some(Some(_)));
        if let (Some(texture), true) = (&self.texture, is_there) {
            let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
            painter.image(texture.id(), disc.square(), whole, Color32::WHITE);
        }
        disc.draw_directions(&painter, ink);
        for at in self.measured.get().into_iter().flatten() {
            measured_mark(&painter, disc.at(*at));
        }
        incident_mark(&painter, disc.at(place(theta_i, 0.0)));
        mirror_mark(&painter, disc.at(place(theta_i, 180.0)));
        if let Some(range) = self.ranges[quantity as usize].get() {
            let at = Pos2::new(disc.center.x + radius + MARGIN.x + 6.0, disc.center.y - radius);
            color_bar(ui, at, 2.0 * radius, ColorScale { map: quantity.colors(), range }, &labels(quantity), ink, dark);
        }
        let name = quantity.texts()[0].clone();
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, tr!("Map of all directions of view: {}", name)));
        let at = (response.hover_pos()? - disc.center) / radius;
        self.reading(f64::from(at.x), f64::from(-at.y), quantity)
    }
}

/// Directions measured at that θi.
fn measured(document: &OpenMeasurement, theta_i: f64) -> Vec<Vec2> {
    let geometries = document.measurement.rows.iter().map(|row| row.geometry);
    let at = geometries.filter(|geometry| geometry.theta_i() == Degrees(theta_i));
    at.map(|geometry: Geometry| place(geometry.theta_r().0, geometry.dphi().0)).take(MOST_POINTS).collect()
}

impl View for HemisphereView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (settings, surface) = (cx.work.settings(), cx.work.surface());
        let (parameters, model, theta_i) = (surface.parameters, surface.model, settings.theta_i);
        let Ok(surface) = Pbrdf::new(model, parameters) else {
            // Values that are not numbers differ from themselves: a job would follow a job for ever.
            self.job = AsyncMemo::default();
            return;
        };
        let before = self.job.get().and_then(Option::as_ref).filter(|made| made.theta_i == theta_i).map(|made| made.hemisphere.clone());
        let key = (parameters, model, theta_i);
        self.job.refresh(&cx.jobs.spawner, &key, move |stopped| Made::new(&surface, theta_i, before, stopped));
        self.measured.refresh((cx.work.active().generation, theta_i), |_| measured(cx.work.active(), theta_i));
        let (Some(key), Some(Some(made))) = (self.job.key(), self.job.get()) else { return };
        let quantity = settings.shown.hemisphere;
        let range = &mut self.ranges[quantity as usize];
        range.follow(wanted(quantity, made.extremes[quantity as usize]), cx.interacting);
        let Some(scale) = range.get().map(|range| ColorScale { map: quantity.colors(), range }) else { return };
        let fresh = &mut self.fresh;
        self.colored.refresh((*key, quantity, scale), |_| *fresh = Some(made.image(quantity, scale)));
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            cx.view_options_ui(|shown| {
                for quantity in HemisphereQuantity::ALL {
                    let [name, help] = quantity.texts();
                    ui.selectable_value(&mut shown.hemisphere, quantity, name).on_hover_text(help);
                }
            });
        });
        let (quantity, theta_i) = (cx.work.settings().shown.hemisphere, cx.work.settings().theta_i);
        if let Some(image) = self.fresh.take() {
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => self.texture = Some(ui.ctx().load_texture("hemisphere", image, TextureOptions::LINEAR)),
            }
        }
        // So high whatever the lines say: the map does not jump.
        let lines = if ui.available_width() < 430.0 { 4.0 } else { 2.0 };
        let below = lines * (ui.text_style_height(&egui::TextStyle::Body) + ui.spacing().item_spacing.y);
        let room = vec2(ui.available_width(), (ui.available_height() - below).max(60.0));
        let reading = self.disc_ui(theta_i, quantity, room, ui);
        ui.label(reading.unwrap_or_else(|| tr!("The pointer over the map reads a value.")));
        legend_ui(theta_i, self.measured.get().map_or(0, Vec::len), ui);
    }

    /// θr from the middle outwards in degrees, so that axes can tell it.
    fn figure(&self, cx: &Cx<'_>) -> Option<Figure> {
        let (theta_i, made) = (self.job.key()?.2, self.job.get()?.as_ref()?);
        let quantity = cx.work.settings().shown.hemisphere;
        let range = self.ranges[quantity as usize].get()?;
        let mut series = vec![Series::heat_map(made.heat_map(quantity, range, quantity.axis()))];
        let ring = |theta_r: f64| (0..=120).map(|i| in_degrees(place(theta_r, 3.0 * f64::from(i)))).collect();
        series.extend([30.0, 60.0].map(|theta_r| Series::dashed("", ring(theta_r), Dash::Solid).colored(WHITE)));
        series.push(Series::dashed("", ring(90.0), Dash::Solid).colored(FOREGROUND));
        series.push(Series::labels([30.0, 60.0].map(|theta_r| (in_degrees(place(theta_r, 90.0)), format!("θr = {theta_r}°"))).to_vec()));
        let mark = |name: String, places: Vec<Vec2>, symbol| {
            let points = places.into_iter().map(in_degrees).map(|[x, y]| Point { x, y, bar: None }).collect();
            Series::measured(name, points, symbol).colored(MARK)
        };
        if let Some(measured) = self.measured.get().filter(|measured| !measured.is_empty()) {
            series.push(mark(tr!("measured"), measured.clone(), Symbol::Circle));
        }
        series.push(mark(tr!("incident ray"), vec![place(theta_i, 0.0)], Symbol::Disc));
        series.push(mark(tr!("mirror direction"), vec![place(theta_i, 180.0)], Symbol::Cross));
        let axis = |label| Axis::linear(label, "°").between(-90.0, 90.0);
        let panel = Panel {
            title: tr!("θi = {}°; radius θr, Δφ = 180° to the right, 270° upwards", theta_i),
            x: axis("−θr cos Δφ"),
            y: axis("−θr sin Δφ"),
            series,
            equal_aspect: true,
            ..Panel::default()
        };
        let title = cx.work.active().title();
        Some(Figure { title, panels: vec![panel], width_mm: 130.0, height_mm: 125.0, ..Figure::default() })
    }

    fn suspend(&mut self) {
        self.job.stop_if(|_| true);
    }

    fn lag(&self) -> u64 {
        self.job.frames_behind()
    }
}

/// A place on the disc of radius 1, in degrees of θr from the middle.
fn in_degrees(place: Vec2) -> [f64; 2] {
    [90.0 * f64::from(place.x), 90.0 * f64::from(place.y)]
}

/// What stands at the colour bar.
fn labels(quantity: HemisphereQuantity) -> BarLabels<'static> {
    match quantity {
        HemisphereQuantity::Dolp => BarLabels { title: "DoLP", marks: BarMarks::Linear },
        HemisphereQuantity::Angle => BarLabels { title: "°", marks: BarMarks::At(&[-90.0, -45.0, 0.0, 45.0, 90.0]) },
        HemisphereQuantity::Brdf => BarLabels { title: "1/sr", marks: BarMarks::Log },
        HemisphereQuantity::SpecularShare => BarLabels { title: "", marks: BarMarks::Linear },
    }
}
