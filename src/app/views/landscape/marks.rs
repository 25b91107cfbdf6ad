//! What lies on the landscape: the ways of the last fits, the minima of the shown one, tabulated
//! metals, the sliders.

use crate::app::text::i18n;
use crate::app::text::i18n::{Language, translated};
use crate::app::views::landscape::axes::coordinate;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::settings::LandscapeAxes;
use crate::app::work::workspace::Workspace;
use pbrdf::model::{Parameter, Parameters};
use pbrdf::optics;
use tr::tr;

/// Ways that are drawn, of the newest fits.
const WAYS: usize = 3;
/// Minima that are drawn, the lowest ones.
const MOST_MINIMA: usize = 24;

/// Draws that are drawn.
const MOST_DRAWS: usize = 400;

/// What the marks depend on: the axes, how many fits there were, the one shown, the measurement,
/// its draws, the wavelength in nm, the language of what a pointer reads.
#[derive(Debug, Clone, PartialEq)]
pub struct MarksKey {
    axes: (Parameter, Parameter),
    fits: usize,
    shown: Option<usize>,
    number: u64,
    draws: Option<u64>,
    wavelength_nm: f64,
    language: Language,
}

impl MarksKey {
    pub fn new(work: &Workspace) -> Self {
        let settings = work.settings();
        let LandscapeAxes { across, up, .. } = settings.panes.landscape;
        let wavelength_nm = settings.metal_selection.wavelength_nm;
        let (axes, shown) = ((across, up), work.shown_fit().map(|fit| fit.id));
        let draws = work.posterior().map(|drawn| drawn.stamp);
        let (fits, number) = (work.fit_history().count(), work.active().number);
        Self { axes, fits, shown, number, draws, wavelength_nm, language: i18n::current() }
    }
}

/// Marks with what a pointer reads at each.
#[derive(Default)]
pub struct Noted {
    pub points: Vec<[f64; 2]>,
    texts: Vec<String>,
}

/// What lies on the landscape.
pub struct Marks {
    /// The newest first.
    pub ways: Vec<Noted>,
    pub minima: Noted,
    pub metals: Noted,
    /// Draws from the posterior, evenly picked.
    pub cloud: Vec<[f64; 2]>,
    /// Where each metal is named.
    pub names: Vec<([f64; 2], &'static str)>,
}

impl Noted {
    fn push(&mut self, point: Option<[f64; 2]>, text: impl FnOnce() -> String) {
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
            let point = [coordinate(across, parameters[across]), coordinate(up, parameters[up])];
            point.iter().all(|at| at.is_finite()).then_some(point)
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
        let drawn = work.posterior().and_then(|drawn| Some((drawn, drawn.place_of(key.number)?)));
        let cloud = drawn.map_or_else(Vec::new, |(drawn, set)| {
            let step = drawn.draws.len().div_ceil(MOST_DRAWS).max(1);
            drawn.draws.draws().step_by(step).filter_map(|draw| place(&draw.parameters[set])).collect()
        });
        Self { ways, minima, metals, cloud, names }
    }

    /// What is known of the mark of a group that lies nearest to a place.
    pub fn text(&self, group: &str, [x, y]: [f64; 2]) -> Option<&str> {
        let groups = self.ways.iter().enumerate().map(|(i, way)| (way_name(i), way));
        let mut groups = groups.chain([(tr!("minima"), &self.minima), (tr!("metals"), &self.metals)]);
        let (_, noted) = groups.find(|(name, _)| name == group)?;
        let distance = |[a, b]: &[f64; 2]| libm::hypot(a - x, b - y);
        let near = noted.points.iter().zip(&noted.texts).min_by(|(a, _), (b, _)| distance(a).total_cmp(&distance(b)));
        near.map(|(_, text)| text.as_str())
    }
}

/// All sources of all metals that have the wavelength, where the axes are n and k.
fn metals(key: &MarksKey) -> (Noted, Vec<([f64; 2], &'static str)>) {
    let (mut noted, mut names) = (Noted::default(), Vec::new());
    let is_map = matches!(key.axes, (Parameter::N, Parameter::K) | (Parameter::K, Parameter::N));
    for metal in optics::metals().into_iter().flatten().filter(|_| is_map) {
        let mut is_named = false;
        for source in &metal.sources {
            let Ok(index) = source.index_at(key.wavelength_nm) else { continue };
            let of = |parameter| coordinate(parameter, if parameter == Parameter::N { index.n() } else { index.k_m() });
            let point = [of(key.axes.0), of(key.axes.1)];
            if !point.iter().all(|at| at.is_finite()) {
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
    match age {
        0 => tr!("way of the last fit"),
        1 => tr!("way of the fit before"),
        _ => tr!("way {} fits back", age),
    }
}

/// The name of a metal on the map: chemical symbols are the same in all languages, names of alloys
/// are not.
pub fn metal_name(name: &str) -> String {
    if name.len() > 2 { translated(name) } else { name.to_owned() }
}
