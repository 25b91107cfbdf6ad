//! One side of a profile: an unknown is moved away from the minimum, the others are fitted again, until the objective has risen.
//!
//! Steps are chosen by the rise of the objective, not by the unknown: the root of the rise grows linearly along a quadratic valley, and
//! each step aims at a part of a standard error of it. Where a limit is crossed, the crossing is refined by false position. There the
//! fit is challenged from other starts: where one of them stays below the limit, the profile has another branch, and the walk goes on
//! along that one.

use crate::fit::intervals::held::Held;
use crate::fit::least_squares::LeastSquares;
use crate::fit::local::bounded_lm::{BoundedLm, Limits};
use crate::fit::local::recorder::Recorder;
use crate::fit::local::solver::LIMITS;
use crate::fit::observer::Observer;
use nalgebra::DVector;

/// Rise of the root of the objective that a step aims at, in units of that of the first limit.
const STEP: f64 = 0.5;
/// Factor by which a step may grow or shrink from one to the next.
const GROWTH: f64 = 3.0;
/// Part of the way to the bound of the first step, where no standard error tells a better one.
const FIRST_STEP: f64 = 0.03;
/// The least step, as a fraction of the coordinate: some units in its last place.
const LEAST_STEP: f64 = 16.0 * f64::EPSILON;
/// Steps of a walk, at most.
const MOST_STEPS: usize = 80;
/// Steps that refine a crossing, at most: false position halves the bracket every third step.
const REFINEMENTS: usize = 24;
/// A crossing is refined until the rise is right to this fraction.
const CROSSING: f64 = 1e-3;
/// An end that lies this near to a bound of 0, in parts of the value at the minimum, is 0: the profile of a weight jumps there, where its
/// lobe goes, and a jump is only bracketed.
const NO_WEIGHT: f64 = 1e-8;
/// A fit with the unknown held is accurate to this fraction of the rise of the first limit.
const ACCURACY: f64 = 1e-4;
/// Evaluations of a held fit per unknown and one: it starts beside its minimum.
const PATIENCE: usize = 40;
/// A valley is quadratic where a crossing lies within this fraction of the distance that the linear error tells.
const QUADRATIC: f64 = 0.25;
/// Part of the way to the other bound by which an unknown is moved off a bound.
const INSIDE: f64 = 0.05;
/// A challenger must stay below the limit by this fraction of the rise.
const MARGIN: f64 = 0.01;
/// A point that lies below the minimum by this fraction of the first limit's rise ends the walk.
const LOWER: f64 = 0.05;
/// Branches that a walk changes to at a limit, at most.
const MOST_BRANCHES: usize = 40;

/// A point of a profile: the unknowns, one of them held, and the sum of squares.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ProfileFit {
    pub x: DVector<f64>,
    pub sum_of_squares: f64,
}

/// What all walks from one minimum have in common.
pub(crate) struct Landmarks<'a, P> {
    pub problem: &'a P,
    pub minimum: &'a ProfileFit,
    /// Other points that fits are started from, the best first.
    pub others: &'a [DVector<f64>],
    /// Starts far from all of these, given an unknown and where it is held.
    pub elsewhere: &'a (dyn Fn(usize, f64) -> Vec<DVector<f64>> + Sync),
    pub observer: Observer<'a>,
}

/// A walk from the minimum to the limits on one side of one unknown.
pub(crate) struct Walk<'a, P> {
    at: &'a Landmarks<'a, P>,
    pub unknown: usize,
    /// The bound on this side.
    bound: f64,
    /// The rises of the sum of squares at 68.3 and at 95 %.
    pub rises: [f64; 2],
    /// The linear standard error in the unknown's own unit, if there is one.
    error: Option<f64>,
    /// Outwards from the minimum.
    pub points: Vec<ProfileFit>,
    /// Where the limits are crossed; none where the bound comes first.
    pub ends: [Option<f64>; 2],
    /// Whether the walk was cancelled or gave up.
    pub is_incomplete: bool,
}

impl<'a, P: LeastSquares> Walk<'a, P> {
    pub(crate) fn new(at: &'a Landmarks<'a, P>, unknown: usize, upwards: bool, rises: [f64; 2], error: Option<f64>) -> Self {
        let (low, high) = at.problem.bounds_of(unknown);
        let bound = if upwards { high } else { low };
        Self { at, unknown, bound, rises, error, points: vec![at.minimum.clone()], ends: [None; 2], is_incomplete: false }
    }

    /// Walks outwards from a point, the minimum or one farther out that is known to lie below a limit.
    pub(crate) fn run(&mut self, first_level: usize, from: Option<ProfileFit>) {
        self.points.extend(from);
        for level in first_level..self.ends.len() {
            self.ends[level] = None;
            for branches in 0..=MOST_BRANCHES {
                let Some(crossing) = self.advance(level) else { return };
                let end = self.refine(crossing, level);
                self.ends[level] = Some(self.end(&end));
                if branches == MOST_BRANCHES {
                    break;
                }
                let Some(challenger) = self.challenge(&end, level) else { break };
                self.ends[level] = None;
                self.points.truncate(crossing);
                self.points.push(challenger);
            }
            if self.is_incomplete {
                return;
            }
        }
    }

    /// Of those points, the outermost that lies outside the interval of a level, below its limit; and the lowest such level.
    pub(crate) fn widest(&mut self, points: &[ProfileFit], outside: f64) -> Option<(usize, ProfileFit)> {
        let start = self.value(self.at.minimum);
        let out = |value: f64| (value - start) * (self.bound - start).signum();
        for level in 0..self.ends.len() {
            let Some(end) = self.ends[level] else { continue };
            let is_wider = |fit: &&ProfileFit| {
                out(self.value(fit)) > (1.0 + outside) * out(end) && self.rise(fit) < (1.0 - MARGIN) * self.rises[level]
            };
            let widest = points.iter().filter(is_wider).max_by(|a, b| out(self.value(a)).total_cmp(&out(self.value(b))));
            if let Some(widest) = widest.cloned() {
                let kept =
                    |fit: &ProfileFit| level > 0 && out(self.value(fit)) < out(self.value(&widest)) && self.rise(fit) < self.rises[level];
                let points: Vec<ProfileFit> = self.points.iter().skip(1).filter(|fit| kept(fit)).cloned().collect();
                self.points.truncate(1);
                self.points.extend(points);
                return Some((level, widest));
            }
        }
        None
    }

    /// The end of an interval at a crossing.
    fn end(&self, crossing: &ProfileFit) -> f64 {
        let value = self.value(crossing);
        let is_no_weight = self.bound == 0.0 && value.abs() <= NO_WEIGHT * self.value(self.at.minimum).abs();
        if is_no_weight { 0.0 } else { value }
    }

    fn value(&self, fit: &ProfileFit) -> f64 {
        fit.x[self.unknown]
    }

    fn coordinate(&self, fit: &ProfileFit) -> f64 {
        self.at.problem.straight(self.unknown, self.value(fit))
    }

    fn rise(&self, fit: &ProfileFit) -> f64 {
        fit.sum_of_squares - self.at.minimum.sum_of_squares
    }

    /// The root of the rise, in units of that of the first limit.
    fn deviance(&self, fit: &ProfileFit) -> f64 {
        (self.rise(fit).max(0.0) / self.rises[0]).sqrt()
    }

    /// Steps outwards until a limit is crossed; the number of the first point above it, or none where the bound comes first.
    fn advance(&mut self, level: usize) -> Option<usize> {
        // A limit may be crossed by the steps that were taken for the one before.
        if let Some(crossing) = self.points.iter().position(|fit| self.rise(fit) >= self.rises[level]) {
            return Some(crossing);
        }
        let end = self.at.problem.straight(self.unknown, self.bound);
        for _ in 0..MOST_STEPS {
            if (self.at.observer.cancelled)() {
                self.is_incomplete = true;
                return None;
            }
            let last = self.points.last()?;
            let here = self.coordinate(last);
            if self.value(last) == self.bound || !(end - here).is_finite() {
                return None;
            }
            let step = self.step(here, end);
            let reaches = step.abs() >= 0.999 * (end - here).abs();
            let value = if reaches { self.bound } else { self.at.problem.at_straight(self.unknown, here + step) };
            let fit = self.held_fit(value, &self.predicted(value));
            let rise = self.rise(&fit);
            self.points.push(fit);
            if rise < -LOWER * self.rises[0] {
                // The minimum is none: the walk is over.
                self.is_incomplete = true;
                return None;
            }
            if rise >= self.rises[level] {
                return Some(self.points.len() - 1);
            }
        }
        self.is_incomplete = true;
        None
    }

    /// The next step of the straight coordinate.
    fn step(&self, here: f64, end: f64) -> f64 {
        let away = end - here;
        let least = LEAST_STEP * here.abs();
        let [.., before, last] = &self.points[..] else {
            let unit = self.at.problem.at_straight(self.unknown, here);
            let by_error = self.error.filter(|error| error.is_finite() && *error > 0.0).map(|error| {
                let there = unit + STEP * error.copysign(away);
                let inside = if away > 0.0 { there < self.bound } else { there > self.bound };
                if inside { (self.at.problem.straight(self.unknown, there) - here).abs() } else { f64::INFINITY }
            });
            return by_error.unwrap_or(f64::INFINITY).min(FIRST_STEP * away.abs()).max(least).copysign(away);
        };
        let taken = (here - self.coordinate(before)).abs();
        let risen = self.deviance(last) - self.deviance(before);
        let factor = if risen > 0.0 { (STEP / risen).clamp(1.0 / GROWTH, GROWTH) } else { GROWTH };
        (factor * taken).max(least).min(away.abs()).copysign(away)
    }

    /// The other unknowns on the line through the last two points.
    fn predicted(&self, value: f64) -> Vec<DVector<f64>> {
        let Some(last) = self.points.last() else { return Vec::new() };
        let mut starts = vec![last.x.clone()];
        if let [.., before, last] = &self.points[..] {
            let there = self.at.problem.straight(self.unknown, value);
            let ratio = (there - self.coordinate(last)) / (self.coordinate(last) - self.coordinate(before));
            if ratio.is_finite() {
                starts.push(&last.x + (&last.x - &before.x) * ratio);
            }
        }
        starts
    }

    /// Refines the crossing between a point below the limit and the one after it, which is above.
    fn refine(&mut self, crossing: usize, level: usize) -> ProfileFit {
        let limit = self.rises[level];
        let (mut below, mut above) = (self.points[crossing - 1].clone(), self.points[crossing].clone());
        for round in 1..=REFINEMENTS {
            if (self.rise(&above) / limit - 1.0).abs() <= CROSSING {
                break;
            }
            let (low, high) = (self.coordinate(&below), self.coordinate(&above));
            let (from, to, aim) = (self.deviance(&below), self.deviance(&above), (limit / self.rises[0]).sqrt());
            // A bisection now and then: false position alone keeps one end.
            let fraction = if round % 3 == 0 { 0.5 } else { ((aim - from) / (to - from)).clamp(0.02, 0.98) };
            let value = self.at.problem.at_straight(self.unknown, low + fraction * (high - low));
            if !(fraction.is_finite()) || value == self.value(&below) || value == self.value(&above) {
                break;
            }
            let between = &below.x + (&above.x - &below.x) * fraction;
            let fit = self.held_fit(value, &[below.x.clone(), between]);
            if (self.rise(&fit) / limit - 1.0).abs() <= CROSSING {
                return fit;
            }
            if self.rise(&fit) >= limit { above = fit } else { below = fit }
        }
        above
    }

    /// A fit at the end from another start that stays below the limit.
    fn challenge(&mut self, end: &ProfileFit, level: usize) -> Option<ProfileFit> {
        let target = self.at.minimum.sum_of_squares + (1.0 - MARGIN) * self.rises[level];
        let value = self.value(end);
        // Those that cost nothing first.
        let (at, unknown) = (self.at, self.unknown);
        let is_expected = self.is_where_linear_error_expects(value, level);
        let elsewhere = std::iter::once(()).filter(|()| !is_expected).flat_map(|()| (at.elsewhere)(unknown, value));
        for other in self.off_bounds(end).into_iter().chain(at.others.iter().cloned()).chain(elsewhere) {
            if (self.at.observer.cancelled)() {
                self.is_incomplete = true;
                return None;
            }
            let fit = self.descend(value, other, target);
            if fit.sum_of_squares <= target {
                return Some(fit);
            }
        }
        None
    }

    /// The point with each unknown that rests on a bound moved inside, one at a time: where the slope vanishes on the bound, as that of k at
    /// k = 0, no descent leaves it.
    fn off_bounds(&self, end: &ProfileFit) -> Vec<DVector<f64>> {
        let problem = self.at.problem;
        let moved = |j: usize| {
            let (low, high) = problem.bounds_of(j);
            let (from, to) = if end.x[j] <= low { (low, high) } else { (high, low) };
            let (start, stop) = (problem.straight(j, from), problem.straight(j, to));
            let mut x = end.x.clone();
            x[j] = problem.at_straight(j, start + INSIDE * (stop - start));
            x
        };
        let rests = |&j: &usize| {
            let (low, high) = problem.bounds_of(j);
            j != self.unknown && low < high && (end.x[j] <= low || end.x[j] >= high)
        };
        (0..end.x.len()).filter(rests).map(moved).collect()
    }

    /// Whether a crossing lies where a quadratic valley has it: there is no reason to look for another branch then.
    fn is_where_linear_error_expects(&self, value: f64, level: usize) -> bool {
        let distance = (value - self.value(self.at.minimum)).abs();
        let expected = self.error.map(|error| error * (self.rises[level] / self.rises[0]).sqrt());
        expected.is_some_and(|expected| (distance - expected).abs() <= QUADRATIC * expected)
    }

    /// The best fit with the unknown held at a value, from the best of some starts.
    fn held_fit(&self, value: f64, starts: &[DVector<f64>]) -> ProfileFit {
        let held = self.held(value);
        let mut residuals = DVector::zeros(held.residual_count());
        let mut best: Option<(f64, DVector<f64>)> = None;
        for start in starts {
            let mut x = start.clone();
            for (j, slot) in x.iter_mut().enumerate() {
                let (low, high) = held.bounds_of(j);
                *slot = slot.clamp(low, high);
            }
            let sum = if held.residuals_at(&x, &mut residuals) { residuals.norm_squared() } else { f64::INFINITY };
            if best.as_ref().is_none_or(|best| sum < best.0) {
                best = Some((sum, x));
            }
        }
        let start = best.map_or_else(|| self.at.minimum.x.clone(), |best| best.1);
        self.descend(value, start, f64::NEG_INFINITY)
    }

    /// The problem with the unknown held at a value.
    fn held(&self, value: f64) -> Held<'_, P> {
        // Where the data are exact, the limits lie below what a fit takes for rounding.
        let negligible = self.at.problem.negligible().min(ACCURACY * self.rises[0]);
        Held { problem: self.at.problem, unknown: self.unknown, value, negligible }
    }

    fn descend(&self, value: f64, mut start: DVector<f64>, target: f64) -> ProfileFit {
        start[self.unknown] = value;
        let held = self.held(value);
        let tolerance = ACCURACY * self.rises[0] / self.at.minimum.sum_of_squares.max(self.rises[0]);
        let limits = Limits { evaluations: PATIENCE * (start.len() + 1), tolerance, target, ..LIMITS };
        let mut recorder = Recorder::new(&start, Observer { progress: &|_| {}, ..self.at.observer });
        BoundedLm::new(&held, &start).run(limits, &mut recorder);
        ProfileFit { x: recorder.best().clone(), sum_of_squares: recorder.sum_of_squares() }
    }
}
