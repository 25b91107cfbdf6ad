//! Hemisphere map: DoLP, angle of polarisation, BRDF or specular share over all directions of view
//! at the sliders' θi, or how they differ from those of a pinned surface or the last fit.
//!
//! The disc is that of [`pbrdf::model::Hemisphere`]: light from the left, forward side to the
//! right, θr = 90° at the rim.

mod map;

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::{DARK, FOREGROUND, MARK, WHITE};
use crate::app::plots::{AutoRange, FigurePlot, PanelStyle, Range};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::MOST_POINTS;
use crate::app::views::pointing::picked_name;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::settings::{Compared, HemisphereQuantity};
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Dash, Figure, Panel, Point, Series, Symbol};
use egui::{ComboBox, Key, Role, Ui, WidgetInfo};
use map::{Made, MapKey, SIZE, index, place, values, wanted, wanted_of_difference};
use pbrdf::model::{Model, Parameters, Pbrdf};
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
    ranges_of_differences: [AutoRange; HemisphereQuantity::ALL.len()],
    /// Directions measured at the sliders' θi, as places on the disc.
    measured: Memo<(u64, f64), Vec<[f64; 2]>>,
    plot: FigurePlot<FigureKey>,
}

/// The map by its inputs, what it shows, the name of what is taken off, the range of its colours, the
/// measured directions by their stamp, the picked direction, the language.
type FigureKey = (MapKey, HemisphereQuantity, Option<String>, Option<Range>, u64, Option<[f64; 2]>, Language);

/// The surface of a reference and its name.
fn surface_of(reference: Compared, work: &Workspace) -> Option<(String, (Parameters, Model))> {
    match reference {
        Compared::LastFit => work.shown_fit().map(|fit| (tr!("last fit"), (fit.report.parameters, fit.report.model))),
        Compared::Pin(place) => work.pinned().get(place).map(|pin| (pin.name.clone(), (pin.parameters, pin.model))),
    }
}

/// What a map can be compared to.
fn references(work: &Workspace) -> Vec<(Option<Compared>, String)> {
    let all = [Compared::LastFit].into_iter().chain((0..work.pinned().len()).map(Compared::Pin));
    let named = all.filter_map(|reference| {
        let (name, _) = surface_of(reference, work)?;
        Some((Some(reference), tr!("less {}", name)))
    });
    [(None, tr!("of the sliders"))].into_iter().chain(named).collect()
}

impl HemisphereQuantity {
    /// Its name and what the pointer finds out about it.
    fn texts(self) -> [String; 2] {
        match self {
            Self::Dolp => [tr!("DoLP"), tr!("Degree of linear polarisation for unpolarised light in, Eq. (17)")],
            Self::Angle => [
                tr!("Angle of polarisation"),
                tr!("½ atan2(F20, F10): how far the electric vector is turned from s, which is parallel to the surface, towards p"),
            ],
            Self::Brdf => [tr!("BRDF"), tr!("F00, Eq. (14), on a logarithmic scale")],
            Self::SpecularShare => [tr!("Specular share"), tr!("The specular lobe's part of the radiance")],
        }
    }

    /// The axis of its colours in a figure.
    fn axis(self) -> Axis {
        match self {
            Self::Dolp => Axis::linear("DoLP", ""),
            Self::Angle => Axis { ticks: Some(ticks(&[-90, -45, 0, 45, 90])), ..Axis::linear(tr!("angle of polarisation"), "°") },
            Self::Brdf => Axis::log("BRDF", "sr⁻¹"),
            Self::SpecularShare => Axis::linear(tr!("specular share"), ""),
        }
    }

    /// The axis of the colours of a difference.
    fn axis_of_difference(self) -> Axis {
        match self {
            Self::Dolp => Axis::linear("Δ DoLP", ""),
            Self::Angle => Axis::linear(tr!("turn"), "°"),
            Self::Brdf => Axis::log(tr!("BRDF ratio"), ""),
            Self::SpecularShare => Axis::linear(tr!("Δ share"), ""),
        }
    }

    /// A value of a difference in words.
    fn reading_of_difference(self, value: f64) -> String {
        match self {
            _ if value.is_nan() => tr!("nothing to tell"),
            Self::Dolp => tr!("difference in DoLP = {}", format!("{value:+.5}")),
            Self::Angle => tr!("turned by {}°", format!("{:+.2}", value + 0.0)),
            Self::Brdf => tr!("BRDF = {} times the other", format!("{value:.4}")),
            Self::SpecularShare => tr!("difference in specular share = {}", format!("{value:+.5}")),
        }
    }

    /// A value in words.
    fn reading(self, value: f64) -> String {
        match self {
            _ if value.is_nan() => tr!("nothing to tell"),
            Self::Dolp => tr!("DoLP = {}", format!("{value:.5}")),
            Self::Angle => tr!("angle of polarisation = {}°", format!("{:.2}", value + 0.0)),
            Self::Brdf => tr!("BRDF = {} sr⁻¹", format!("{value:.4e}")),
            Self::SpecularShare => tr!("specular share = {}", format!("{value:.5}")),
        }
    }
}

impl HemisphereView {
    /// What is known at a place of the disc; none outside it.
    fn reading(&self, [x, y]: [f64; 2], quantity: HemisphereQuantity) -> Option<String> {
        let made = self.job.get()?.as_ref()?;
        let map = &made.map;
        let (row, column) = (index(y / 90.0)?, index(x / 90.0)?);
        let (theta_r, dphi) = map.direction(row, column)?;
        let value = values(map, quantity)[row * SIZE + column];
        let at = tr!("θr = {}°, Δφ = {}°", format!("{theta_r:.2}"), format!("{dphi:.2}"));
        let words = if made.is_difference() { quantity.reading_of_difference(value) } else { quantity.reading(value) };
        Some(format!("{at}: {words}"))
    }

    /// Whether a map is being made.
    #[cfg(test)]
    pub fn is_running(&self) -> bool {
        self.job.is_running()
    }

    /// Whether the next frame changes the texture.
    #[cfg(test)]
    pub fn is_fresh(&self) -> bool {
        self.plot.is_fresh()
    }

    /// The inputs of the newest map.
    #[cfg(test)]
    pub fn key(&self) -> Option<&MapKey> {
        self.job.key()
    }

    /// The map with what lies on it, over degrees of θr from the middle outwards, so that axes can
    /// tell them.
    fn describe(
        &self,
        made: &Made,
        (quantity, range): (HemisphereQuantity, Range),
        less: Option<&str>,
        picked: Option<[f64; 2]>,
        title: String,
    ) -> Figure {
        let theta_i = made.theta_i;
        let axis = if made.is_difference() { quantity.axis_of_difference() } else { quantity.axis() };
        let mut series = vec![Series::heat_map(made.heat_map(quantity, range, axis))];
        let ring = |theta_r: f64| (0..=120).map(|i| place(theta_r, 3.0 * f64::from(i))).collect();
        // White lines vanish in the white of what is the same.
        let line = if made.is_difference() { DARK } else { WHITE };
        series.extend([30.0, 60.0].map(|theta_r| Series::stroke("", ring(theta_r), 0.5, Dash::Solid).colored(line)));
        let across = |dphi: f64| vec![place(90.0, dphi), place(90.0, dphi + 180.0)];
        series.extend([0.0, 90.0].map(|dphi| Series::stroke("", across(dphi), 0.4, Dash::Solid).colored(line)));
        series.push(Series::dashed("", ring(90.0), Dash::Solid).colored(FOREGROUND));
        series.push(Series::labels([30.0, 60.0].map(|theta_r| (place(theta_r, 90.0), format!("θr = {theta_r}°"))).to_vec()));
        let mark = |name: String, places: Vec<[f64; 2]>, symbol| {
            let points = places.into_iter().map(|[x, y]| Point { x, y, bar: None }).collect();
            Series::measured(name, points, symbol).colored(if made.is_difference() { DARK } else { MARK })
        };
        if let Some(measured) = self.measured.get().filter(|measured| !measured.is_empty()) {
            series.push(mark(tr!("measured"), measured.clone(), Symbol::Circle));
        }
        series.push(mark(tr!("incident ray"), vec![place(theta_i, 0.0)], Symbol::Disc));
        series.push(mark(tr!("mirror direction"), vec![place(theta_i, 180.0)], Symbol::Cross));
        series.extend(picked.map(|at| mark(picked_name(), vec![at], Symbol::Square)));
        let axis = |label| Axis { ticks: Some(ticks(&[-90, -60, -30, 0, 30, 60, 90])), ..Axis::linear(label, "°").between(-EDGE, EDGE) };
        let panel = Panel {
            title: match less.filter(|_| made.is_difference()) {
                Some(name) => tr!("θi = {0}°, less {1}; radius θr, Δφ = 180° to the right, 270° upwards", theta_i, name),
                None => tr!("θi = {}°; radius θr, Δφ = 180° to the right, 270° upwards", theta_i),
            },
            x: axis("−θr cos Δφ"),
            y: axis("−θr sin Δφ"),
            series,
            equal_aspect: true,
            ..Panel::default()
        };
        Figure { title, panels: vec![panel], width_mm: 130.0, height_mm: 125.0, ..Figure::default() }
    }
}

/// The choice of what the map is compared to.
fn reference_ui(chosen: &mut Option<Compared>, references: &[(Option<Compared>, String)], ui: &mut Ui) {
    let current = references.iter().find(|(reference, _)| reference == chosen).or(references.first());
    let text = current.map_or_else(String::new, |(_, text)| text.clone());
    let combo = ComboBox::from_id_salt("hemisphere less").selected_text(text.clone()).truncate().show_ui(ui, |ui| {
        for (reference, text) in references {
            ui.selectable_value(chosen, *reference, text);
        }
    });
    combo.response.widget_info(|| WidgetInfo {
        current_text_value: Some(text.clone()),
        ..WidgetInfo::labeled(Role::ComboBox, true, tr!("What the map is compared to"))
    });
    combo.response.on_hover_text(tr!("The map of the sliders, or how it differs from that of a pinned surface or of the last fit"));
}

/// Ends of both axes, degrees: a little beyond the horizon, so that their first numbers keep off each other.
const EDGE: f64 = 95.0;

/// Marks of an axis at these values.
fn ticks(values: &[i8]) -> Vec<(f64, String)> {
    values.iter().map(|value| (f64::from(*value), value.to_string().replace('-', "−"))).collect()
}

/// Directions measured at that θi.
fn measured(document: &OpenMeasurement, theta_i: f64) -> Vec<[f64; 2]> {
    let geometries = document.measurement.rows.iter().map(|row| row.geometry);
    let at = geometries.filter(|geometry| geometry.theta_i() == Degrees(theta_i));
    at.map(|geometry: Geometry| place(geometry.theta_r().0, geometry.dphi().0)).take(MOST_POINTS).collect()
}

impl View for HemisphereView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (settings, surface) = (cx.work.settings(), cx.work.surface());
        let (parameters, model, theta_i) = (surface.parameters, surface.model, settings.theta_i);
        let Ok(surface) = Pbrdf::new(model, parameters) else {
            // Values that are not numbers differ from themselves: a job would follow a job for
            // ever.
            self.job = AsyncMemo::default();
            return;
        };
        let before = self.job.get().and_then(Option::as_ref).filter(|made| made.theta_i == theta_i);
        let before = before.map(|made| (made.hemisphere.clone(), made.reference.clone()));
        let reference = settings.view_options.hemisphere_less.and_then(|reference| surface_of(reference, cx.work));
        let (name, less) = reference.unzip();
        let key = (parameters, model, theta_i, less);
        self.job.refresh(&cx.jobs.spawner, &key, move |stopped| Made::new(&surface, theta_i, less, before, stopped));
        self.measured.refresh((cx.work.active().generation, theta_i), |_| measured(cx.work.active(), theta_i));
        let (Some(key), Some(Some(made))) = (self.job.key(), self.job.get()) else { return };
        let quantity = settings.view_options.hemisphere;
        let extremes = made.extremes[quantity as usize];
        let (ranges, wanted) = match made.is_difference() {
            true => (&mut self.ranges_of_differences, wanted_of_difference(extremes)),
            false => (&mut self.ranges, wanted(quantity, extremes)),
        };
        let range = &mut ranges[quantity as usize];
        range.follow(wanted, cx.interacting);
        let range = range.get();
        let mut plot = std::mem::take(&mut self.plot);
        let picked = cx.derived.picked_theta_r(cx.work).map(|theta_r| place(theta_r, settings.dphi));
        plot.refresh((*key, quantity, name, range, self.measured.stamp(), picked, i18n::current()), |(_, _, name, ..)| {
            Some(self.describe(made, (quantity, range?), name.as_deref(), picked, cx.work.active().title()))
        });
        self.plot = plot;
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let references = references(cx.work);
        ui.horizontal_wrapped(|ui| {
            cx.view_options_ui(|shown| {
                for quantity in HemisphereQuantity::ALL {
                    let [name, help] = quantity.texts();
                    ui.selectable_value(&mut shown.hemisphere, quantity, name).on_hover_text(help);
                }
                if references.len() > 1 {
                    reference_ui(&mut shown.hemisphere_less, &references, ui);
                }
            });
        });
        let quantity = cx.work.settings().view_options.hemisphere;
        if let Some(panel) = self.plot.panel(0) {
            panel.key_line_ui(ui);
        }
        // One line whatever it says: the map does not jump.
        let below = ui.spacing().interact_size.y + ui.spacing().item_spacing.y;
        let height = (ui.available_height() - below).max(60.0);
        let style = PanelStyle { left: 60.0, ..PanelStyle::new("hemisphere", height, &|name, _, _| name.to_owned()) };
        let style = style.named(tr!("Map of all directions of view: {}", quantity.texts()[0]));
        let response = self.plot.panel(0).and_then(|panel| panel.ui(&style, ui));
        let at = response.and_then(|response| Some(response.transform.value_from_position(response.response.hover_pos()?)));
        let reading = at.and_then(|at| self.reading([at.x, at.y], quantity));
        let count = self.measured.get().map_or(0, Vec::len);
        let measured = if count == 0 { tr!("not measured at this θi") } else { tr!("measured: {}", count) };
        ui.horizontal(|ui| {
            ui.label(measured);
            ui.separator();
            ui.add(egui::Label::new(reading.unwrap_or_else(|| tr!("The pointer over the map reads a value."))).truncate());
        });
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }

    fn suspend(&mut self) {
        self.job.stop_if(|_| true);
    }

    fn lag(&self) -> u64 {
        self.job.frames_behind()
    }
}
