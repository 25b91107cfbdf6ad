//! What lies on the landscape: the ways of the last fits, the minima of the shown one, tabulated metals, the sliders.

use crate::app::plots::line;
use crate::app::text::i18n;
use crate::app::text::i18n::{Language, translated};
use crate::app::views::landscape::axes::coordinate;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::settings::LandscapeAxes;
use crate::app::work::workspace::Workspace;
use egui::{Align2, Color32, Rect, RichText};
use egui_plot::{MarkerShape, PlotPoint, PlotPoints, PlotUi, Points, Text};
use pbrdf::model::{Parameter, Parameters};
use pbrdf::optics;
use tr::tr;

/// Ways that are drawn, of the newest fits.
const WAYS: usize = 3;
/// Minima that are drawn, the lowest ones.
const MOST_MINIMA: usize = 24;

/// What the marks depend on: the axes, how many fits there were, the one shown, the measurement, the wavelength in nm, the language of
/// what a pointer reads.
#[derive(Debug, Clone, PartialEq)]
pub struct MarksKey {
    axes: (Parameter, Parameter),
    fits: usize,
    shown: Option<usize>,
    number: u64,
    wavelength_nm: f64,
    language: Language,
}

impl MarksKey {
    pub fn new(work: &Workspace) -> Self {
        let settings = work.settings();
        let LandscapeAxes { across, up, .. } = settings.landscape;
        let wavelength_nm = settings.tabulated.wavelength_nm;
        let (axes, shown) = ((across, up), work.shown_fit().map(|fit| fit.id));
        Self { axes, fits: work.fit_history().made(), shown, number: work.active().number, wavelength_nm, language: i18n::current() }
    }
}

/// Marks with what a pointer reads at each.
#[derive(Default)]
pub struct Noted {
    pub points: Vec<PlotPoint>,
    texts: Vec<String>,
}

/// What lies on the landscape.
pub struct Marks {
    /// The newest first.
    pub ways: Vec<Noted>,
    pub minima: Noted,
    pub metals: Noted,
    /// Where each metal is named.
    pub names: Vec<(PlotPoint, &'static str)>,
}

impl Noted {
    fn push(&mut self, point: Option<PlotPoint>, text: impl FnOnce() -> String) {
        if let Some(point) = point {
            self.points.push(point);
            self.texts.push(text());
        }
    }

    /// How many there are.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.points.len()
    }
}

impl Marks {
    pub fn new(key: &MarksKey, work: &Workspace) -> Self {
        let (across, up) = key.axes;
        let place = |parameters: &Parameters| {
            let point = PlotPoint::new(coordinate(across, parameters[across]), coordinate(up, parameters[up]));
            (point.x.is_finite() && point.y.is_finite()).then_some(point)
        };
        let way = |fit: &FitEntry| {
            let mut way = Noted::default();
            for (step, parameters) in fit.report.course.trace.iter().zip(&fit.report.course.path) {
                way.push(place(parameters), || {
                    let objective = format!("{:.4e}", step.objective);
                    tr!("fit {0}, evaluation {1}\nΔE = {2}", fit.id, step.evaluations, objective)
                });
            }
            way.push(place(&fit.report.parameters), || tr!("end of fit {}", fit.id));
            way
        };
        let own = work.fit_history().iter().filter(|fit| fit.number == key.number);
        let ways = own.take(WAYS).map(|fit| way(fit)).collect();
        let mut minima = Noted::default();
        for (i, minimum) in work.shown_fit().iter().flat_map(|fit| &fit.report.course.minima).take(MOST_MINIMA).enumerate() {
            minima.push(place(&minimum.parameters), || {
                let objective = format!("{:.4e}", minimum.objective);
                tr!("minimum {0}: ΔE = {1}, starts that ended there: {2}", i + 1, objective, minimum.hits)
            });
        }
        let (metals, names) = metals(key);
        Self { ways, minima, metals, names }
    }

    /// What is known of a mark, by the name of its group and its number.
    pub fn text(&self, group: &str, index: usize) -> Option<String> {
        let groups = self.ways.iter().enumerate().map(|(i, way)| (way_name(i), way));
        let mut groups = groups.chain([(tr!("minima"), &self.minima), (tr!("metals"), &self.metals)]);
        let (_, noted) = groups.find(|(name, _)| name == group)?;
        noted.texts.get(index).cloned()
    }
}

/// All sources of all metals that have the wavelength, where the axes are n and k.
fn metals(key: &MarksKey) -> (Noted, Vec<(PlotPoint, &'static str)>) {
    let (mut noted, mut names) = (Noted::default(), Vec::new());
    let is_map = matches!(key.axes, (Parameter::N, Parameter::K) | (Parameter::K, Parameter::N));
    for metal in optics::metals().into_iter().flatten().filter(|_| is_map) {
        let mut is_named = false;
        for source in &metal.sources {
            let Ok(index) = source.index_at(key.wavelength_nm) else { continue };
            let of = |parameter| coordinate(parameter, if parameter == Parameter::N { index.n() } else { index.k_m() });
            let point = PlotPoint::new(of(key.axes.0), of(key.axes.1));
            if !(point.x.is_finite() && point.y.is_finite()) {
                continue;
            }
            noted.push(Some(point), || {
                let name = metal.name.as_str();
                format!("{}, {}\nn = {:.4}, k = {:.4}", translated(name), source.name, index.n(), index.k_m())
            });
            if !is_named {
                names.push((point, metal.key.as_str()));
                is_named = true;
            }
        }
    }
    (noted, names)
}

pub fn way_name(age: usize) -> String {
    if age == 0 { tr!("way of the last fit") } else { tr!("way {} fits before", age) }
}

/// Colours that stand out from viridis.
const WAY: Color32 = Color32::from_rgb(255, 96, 64);
pub const MINIMA: Color32 = Color32::from_rgb(255, 214, 90);
pub const METALS: Color32 = Color32::from_rgb(150, 220, 255);
/// Of ways of earlier fits, as a share.
const FADED: f32 = 0.55;
const WHITE: Color32 = Color32::WHITE;
const BLACK: Color32 = Color32::BLACK;

/// Colour of the way of a fit.
pub fn way_color(age: usize) -> Color32 {
    if age == 0 { WAY } else { WAY.gamma_multiply(FADED) }
}

/// Marks with a dark rim, readable on every colour of the map.
fn rimmed<'a>(plot: &mut PlotUi<'a>, points: &'a [PlotPoint], name: String, shape: MarkerShape, radius: f32, color: Color32) {
    let of = |name: String| Points::new(name, PlotPoints::Borrowed(points)).shape(shape);
    plot.points(of(String::new()).color(BLACK).radius(radius + 1.5).allow_hover(false));
    plot.points(of(name).color(color).radius(radius));
}

pub fn marks_in<'a>(plot: &mut PlotUi<'a>, marks: &'a Marks, shown: LandscapeAxes) {
    if shown.metals && !marks.metals.points.is_empty() {
        rimmed(plot, &marks.metals.points, tr!("metals"), MarkerShape::Circle, 2.0, METALS);
        names_in(plot, &marks.names);
    }
    if shown.paths {
        for (age, way) in marks.ways.iter().enumerate().rev() {
            way_in(plot, way, age);
        }
    }
    if shown.minima && !marks.minima.points.is_empty() {
        rimmed(plot, &marks.minima.points, tr!("minima"), MarkerShape::Diamond, 4.0, MINIMA);
    }
}

/// Behind words on the map.
pub const PLATE: Color32 = Color32::from_black_alpha(190);

/// Letters of the names of metals, and the room of one.
const LETTERS: f32 = 12.0;
const LETTER: egui::Vec2 = egui::vec2(7.2, 16.0);

/// Names beside their points, on a side where no other one stands; without room a name is left to the pointer.
fn names_in(plot: &mut PlotUi<'_>, names: &[(PlotPoint, &'static str)]) {
    let mut taken: Vec<Rect> = Vec::new();
    for (point, name) in names {
        let name = metal_name(name);
        #[expect(clippy::cast_precision_loss, reason = "a few letters")]
        let size = egui::vec2((name.len() + 2) as f32 * LETTER.x, LETTER.y);
        let at = plot.screen_from_plot(*point);
        let sides = [Align2::LEFT_BOTTOM, Align2::LEFT_TOP, Align2::RIGHT_BOTTOM, Align2::RIGHT_TOP];
        let free = sides.into_iter().find(|side| taken.iter().all(|other| !other.intersects(side.anchor_size(at, size))));
        if let Some(side) = free {
            taken.push(side.anchor_size(at, size));
            let text = RichText::new(format!(" {name} ")).size(LETTERS).color(WHITE).background_color(PLATE);
            plot.text(Text::new("", *point, text).anchor(side).allow_hover(false));
        }
    }
}

/// The name of a metal on the map: chemical symbols are the same in all languages, names of alloys are not.
pub fn metal_name(name: &str) -> String {
    if name.len() > 2 { translated(name) } else { name.to_owned() }
}

/// Edge by edge: the corners of one long line are drawn as filled wedges.
fn way_in<'a>(plot: &mut PlotUi<'a>, way: &'a Noted, age: usize) {
    let color = way_color(age);
    for (width, color) in [(3.0, Color32::from_black_alpha(150)), (1.5, color)] {
        for edge in way.points.windows(2) {
            plot.line(line("", edge).color(color).width(width).allow_hover(false));
        }
    }
    plot.points(Points::new(way_name(age), PlotPoints::Borrowed(&way.points)).color(color).radius(2.0));
}

/// Where the sliders stand: a cross in a ring, white on black.
pub fn sliders_in(plot: &mut PlotUi<'_>, [x, y]: [f64; 2]) {
    let at = |shape, radius| Points::new("", vec![[x, y]]).shape(shape).radius(radius).filled(false).allow_hover(false);
    for (color, wider) in [(BLACK, 1.5), (WHITE, 0.0)] {
        plot.points(at(MarkerShape::Circle, RING + wider).color(color));
        plot.points(at(MarkerShape::Plus, RING + wider).color(color));
    }
}

/// Radius of the ring around the sliders' place.
pub const RING: f32 = 6.0;
