//! Pairs of parameters of which the data determine one combination well, and another badly.
//!
//! - n and k: DoLP is nearly proportional to n/(n² + k²) = 1/D; the other one is S = (k/n)². `n = D/(1 + S)`, `k = n √S`.
//! - σ and q of the Cauchy distribution, which near its peak depends on ρ = σ/√q; the other one is q itself.
//!
//! The well determined combination comes first and has walls that do not move; the walls of the other one are where the box of both
//! parameters ends at a value of the first. So a valley along the second stays straight up to its ends.

use crate::fit::posterior::walls::Walls;
use crate::model::{Parameter, Parameters};

/// A pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Valley {
    /// n and k.
    Index,
    /// σ and q.
    Slope,
}

/// Where the second combination may be at a value of the first.
pub(crate) struct MovingWalls {
    /// Its range, without a gap that there may be.
    pub walls: Walls,
    /// Derivatives by the first combination: of the lower end, of one over the upper one.
    pub slopes: [f64; 2],
    /// Where a gap begins, its width, and the derivative of the width.
    gap: Option<[f64; 3]>,
}

impl MovingWalls {
    /// The combination, given its value without the gap, and how much its derivative by the first combination is changed by the gap.
    pub(crate) fn with_gap(&self, value: f64) -> [f64; 2] {
        match self.gap {
            Some([begin, width, slope]) if value > begin => [value + width, slope],
            _ => [value, 0.0],
        }
    }

    /// The value without the gap.
    pub(crate) fn without_gap(&self, combination: f64) -> f64 {
        match self.gap {
            Some([begin, width, _]) if combination > begin => (combination - width).max(begin),
            _ => combination,
        }
    }
}

impl Valley {
    /// The parameters whose places the combinations take: the first, the second.
    pub(crate) fn parameters(self) -> [Parameter; 2] {
        match self {
            Self::Index => [Parameter::N, Parameter::K],
            Self::Slope => [Parameter::Sigma, Parameter::Q],
        }
    }

    /// Walls of the first combination.
    pub(crate) fn first_walls(self, low: &Parameters, high: &Parameters) -> Walls {
        match self {
            Self::Index => {
                let size = |n: f64, k: f64| if k == 0.0 { n } else { n + k * k / n };
                let least = low.k.clamp(low.n, high.n);
                Walls::between(size(least, low.k), size(low.n, high.k).max(size(high.n, high.k)))
            }
            Self::Slope => Walls::between(low.sigma / high.q.sqrt(), high.sigma / low.q.sqrt()),
        }
    }

    /// Walls of the second combination at a value of the first.
    pub(crate) fn second_walls(self, first: f64, low: &Parameters, high: &Parameters) -> MovingWalls {
        // Each end with its derivative; the innermost ones count.
        let mut lower = (0.0, 0.0);
        let mut upper = (f64::INFINITY, 0.0);
        let mut gap = None;
        let mut raise = |end: (f64, f64)| {
            if end.0 > lower.0 {
                lower = end;
            }
        };
        let mut limit = |end: (f64, f64)| {
            if end.0 < upper.0 {
                upper = end;
            }
        };
        match self {
            Self::Index => {
                raise((first / high.n - 1.0, 1.0 / high.n));
                limit((first / low.n - 1.0, 1.0 / low.n));
                // S at k = D √S/(1 + S), of the two the one beyond S = 1, and its derivative.
                let beyond = |k: f64| {
                    let root = (first * first - 4.0 * k * k).max(0.0).sqrt();
                    let t = (first + root) / (2.0 * k);
                    (t * t, 2.0 * t * t / root)
                };
                let before = |(s, slope): (f64, f64)| (1.0 / s, -slope / (s * s));
                if low.k > 0.0 {
                    limit(beyond(low.k));
                    raise(before(beyond(low.k)));
                }
                // A circle of constant D that is higher than the box leaves it at the top and comes back.
                if first > 2.0 * high.k {
                    let (left, back) = (before(beyond(high.k)), beyond(high.k));
                    if left.0 > lower.0 {
                        let width = back.0 - left.0;
                        gap = Some([left.0, width, back.1 - left.1]);
                        upper = (upper.0 - width, upper.1 - (back.1 - left.1));
                    } else if back.0 > lower.0 {
                        lower = back;
                    }
                }
            }
            Self::Slope => {
                let at = |sigma: f64| ((sigma / first) * (sigma / first), -2.0 * sigma * sigma / (first * first * first));
                raise((low.q, 0.0));
                raise(at(low.sigma));
                limit((high.q, 0.0));
                limit(at(high.sigma));
            }
        }
        let walls = Walls::between(lower.0, upper.0);
        MovingWalls { walls, slopes: [lower.1, -upper.1 * walls.one_over_high * walls.one_over_high], gap }
    }

    /// The combinations.
    pub(crate) fn combinations(self, p: &Parameters) -> [f64; 2] {
        match self {
            Self::Index => [p.n + p.k * p.k / p.n, (p.k / p.n) * (p.k / p.n)],
            Self::Slope => [p.sigma / p.q.sqrt(), p.q],
        }
    }

    /// The parameters of the combinations, and the logarithm of their volume per volume of the combinations.
    pub(crate) fn values(self, [first, second]: [f64; 2]) -> ([f64; 2], f64) {
        match self {
            Self::Index => {
                let n = first / (1.0 + second);
                let volume = 0.5 * first / (second.sqrt() * (1.0 + second) * (1.0 + second));
                ([n, n * second.sqrt()], libm::log(volume))
            }
            Self::Slope => ([first * second.sqrt(), second], 0.5 * libm::log(second)),
        }
    }

    /// Derivatives by the combinations of a function and `count` times the logarithm of that volume, from those of the function by the
    /// parameters.
    pub(crate) fn pull_back(self, [first, second]: [f64; 2], [a, b]: [f64; 2], count: f64) -> [f64; 2] {
        let root = second.sqrt();
        match self {
            Self::Index => {
                let one_over = 1.0 / (1.0 + second);
                let k_by_s = first * one_over * (0.5 / root - root * one_over);
                let by_second = -a * first * one_over * one_over + b * k_by_s - count * (0.5 / second + 2.0 * one_over);
                [(a + b * root) * one_over + count / first, by_second]
            }
            Self::Slope => [a * root, 0.5 * a * first / root + b + count * 0.5 / second],
        }
    }
}
