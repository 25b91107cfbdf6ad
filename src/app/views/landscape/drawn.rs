//! A landscape as it is drawn: colours of heights, and lines of equal height.

use crate::app::jobs::async_memo::Stopped;
use crate::app::plots::{Polyline, Range};
use crate::app::views::landscape::axes::coordinate;
use crate::app::views::landscape::key::LandscapeKey;
use crate::app::work::fit_setup::fit_problem;
use crate::app::work::surface::Surface;
use crate::figure::{ColorMap, Heights, Rgb};
use pbrdf::fit::{Landscape, LandscapeAxis, Loss, Problem, Weights};
use pbrdf::measurement::Measurement;
use pbrdf::model::ParameterSet;

/// A landscape as it is drawn.
pub struct LandscapeImage {
    pub landscape: Landscape,
    /// Of the colours, in decimal logarithms.
    pub range: Range,
    /// Ink and pieces of each line, in the coordinates of the plot.
    pub contours: Vec<Contour>,
    pub title: &'static str,
}

/// A line of equal height: its ink and its pieces.
type Contour = (Rgb, Vec<Polyline>);

/// The colours of heights.
pub const COLORS: ColorMap = ColorMap::Sequential;
/// Decades that colours tell apart, from the lowest node upwards.
const DECADES: f64 = 6.0;
/// Lines of equal height at most; from 5 to 1 there are so many more.
const LINES: usize = 12;

impl LandscapeImage {
    /// Of the measurement with the model and the choices of the key, in the bounds of the surface;
    /// none where there is no problem or no node has a value.
    pub fn new(surface: Surface, measurement: &Measurement, key: &LandscapeKey, stopped: Stopped<'_>) -> Option<Self> {
        let problem = problem(surface, measurement, key)?;
        let scaled = key.scale_at.map_or_else(|| problem.clone(), |at| problem.with_loss_scale_of(&at));
        Self::of(Landscape::minimised(&scaled, key.across, key.up, stopped)?, &problem, key)
    }

    /// Of the heights of that problem; none where no node has a value.
    pub fn of(landscape: Landscape, problem: &Problem, key: &LandscapeKey) -> Option<Self> {
        let heights: Vec<f64> = landscape.objective.iter().map(|objective| libm::log10(*objective)).collect();
        let finite = || heights.iter().copied().filter(|height| height.is_finite());
        let highest = finite().fold(f64::NEG_INFINITY, f64::max);
        let lowest = finite().fold(f64::INFINITY, f64::min);
        if lowest > highest {
            return None;
        }
        // By quarters of a decade, so that colours do not flicker while a slider moves.
        let high = 0.25 * (4.0 * highest).ceil();
        let low = (0.25 * (4.0 * lowest).floor()).clamp(high - DECADES, high - 0.25);
        let range = Range { low, high };
        Some(Self { landscape, range, contours: contours(&heights, key, range), title: title(problem) })
    }

    /// The number at the node nearest to a point of the plot.
    pub fn at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let index = |axis: LandscapeAxis, place: f64| {
            let [low, high] = [axis.low, axis.high].map(|value| coordinate(axis.parameter, value));
            #[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
            let place = ((place - low) / (high - low) * (axis.count - 1) as f64).round();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be 0 or more")]
            (place >= 0.0).then_some(place as usize).filter(|index| *index < axis.count)
        };
        let (column, row) = (index(self.landscape.across, x)?, index(self.landscape.up, y)?);
        self.landscape.objective.get(row * self.landscape.across.count + column).copied().filter(|objective| objective.is_finite())
    }
}

/// What is minimised of the measurement with the model and the choices of the key, in the bounds of the surface.
pub fn problem(mut surface: Surface, measurement: &Measurement, key: &LandscapeKey) -> Option<Problem> {
    let free = ParameterSet::EMPTY.with(key.across.parameter).with(key.up.parameter);
    // Where its own two sliders stand is no matter, not even if that is nowhere.
    for axis in [key.across, key.up] {
        surface.parameters[axis.parameter] = axis.low;
    }
    fit_problem(&surface, measurement, key.model, free, key.fit_options).ok()
}

/// What is minimised.
fn title(problem: &Problem) -> &'static str {
    match problem.options().weights {
        _ if problem.minimises_delta_e() => "ΔE",
        Weights::Sigma if problem.options().loss == Loss::Squared => "χ²",
        _ => "Σ r²",
    }
}

/// Lines at 1, 2 and 5 times powers of ten, or at powers of ten alone, in the coordinates of the
/// plot.
fn contours(heights: &[f64], key: &LandscapeKey, Range { low, high }: Range) -> Vec<Contour> {
    let levels = |factors: &[f64]| -> Vec<f64> {
        #[expect(clippy::cast_possible_truncation, reason = "a few decades")]
        let decades = low.floor() as i32..=high.ceil() as i32;
        let all = decades.flat_map(|decade| factors.iter().map(move |factor| f64::from(decade) + libm::log10(*factor)));
        all.filter(|level| *level > low && *level < high).collect()
    };
    let levels = [levels(&[1.0, 2.0, 5.0]), levels(&[1.0, 3.0])].into_iter().find(|levels| levels.len() <= LINES);
    let levels = levels.unwrap_or_else(|| (1..LINES).map(|i| low + (high - low) * f64_of(i) / f64_of(LINES)).collect());
    let place = |axis: LandscapeAxis, index: f64| {
        let [low, high] = [axis.low, axis.high].map(|value| coordinate(axis.parameter, value));
        low + (high - low) * index / f64_of(axis.count - 1)
    };
    let grid = Heights { values: heights, columns: key.across.count };
    let pieces = |level: f64| -> Vec<Polyline> {
        let points = |line: Vec<(f64, f64)>| line.into_iter().map(|(x, y)| [place(key.across, x), place(key.up, y)]).collect();
        grid.lines(level).into_iter().map(points).collect()
    };
    levels.into_iter().map(|level| (COLORS.ink_on((level - low) / (high - low)), pieces(level))).collect()
}

#[expect(clippy::cast_precision_loss, reason = "a small number")]
fn f64_of(count: usize) -> f64 {
    count as f64
}
