//! Gauss–Legendre quadrature, and the map that takes the edge off roots at both ends of an interval.
//!
//! Nodes are the roots of the Legendre polynomial P_N by Newton's method from `cos π(i − 1/4)/(N + 1/2)`, weights
//! `2/((1 − x²) P_N'²)` (Abramowitz and Stegun, 25.4.29).

use crate::optics::Degrees;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Nodes of a rule: with `x = (1 − cos πz)/2` in place of z, functions that begin and end like half-integer powers become smooth,
/// and 32 nodes leave no error that f64 shows.
const NODES: usize = 32;

/// A node in 0…1 and its weight.
type Node = (f64, f64);

static FINE: LazyLock<[Node; NODES]> = LazyLock::new(rule);
static COARSE: LazyLock<[Node; NODES / 2]> = LazyLock::new(rule);
static ROUGH: LazyLock<[Node; NODES / 4]> = LazyLock::new(rule);
/// The same, for x as above.
static FINE_ROUNDED: LazyLock<[Node; NODES]> = LazyLock::new(|| rounded(&FINE));
static COARSE_ROUNDED: LazyLock<[Node; NODES / 2]> = LazyLock::new(|| rounded(&COARSE));
static ROUGH_ROUNDED: LazyLock<[Node; NODES / 4]> = LazyLock::new(|| rounded(&ROUGH));

/// How many nodes an interval has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    /// 32.
    Fine,
    /// 16.
    Coarse,
    /// 8.
    Rough,
}

impl Order {
    /// Half the nodes; 8 at least.
    pub(crate) fn halved(self) -> Self {
        match self {
            Self::Fine => Self::Coarse,
            Self::Coarse | Self::Rough => Self::Rough,
        }
    }

    /// Nodes and weights between two ends where the integrand is smooth.
    pub(crate) fn between(self, low: f64, high: f64) -> impl Iterator<Item = Node> {
        let rule: &'static [Node] = match self {
            Self::Fine => &*FINE,
            Self::Coarse => &*COARSE,
            Self::Rough => &*ROUGH,
        };
        scaled(rule, low, high)
    }

    /// The same where it may begin and end like a half-integer power.
    pub(crate) fn between_roots(self, low: f64, high: f64) -> impl Iterator<Item = Node> {
        let rule: &'static [Node] = match self {
            Self::Fine => &*FINE_ROUNDED,
            Self::Coarse => &*COARSE_ROUNDED,
            Self::Rough => &*ROUGH_ROUNDED,
        };
        scaled(rule, low, high)
    }
}

/// Longest piece that one rule is used for, of an integrand that changes by factors of e per unit.
const LONGEST: f64 = 4.0;

/// An interval in equal pieces short enough for one rule.
pub(crate) fn pieces(low: f64, high: f64) -> impl Iterator<Item = [f64; 2]> {
    let count = ((high - low) / LONGEST).ceil().clamp(0.0, 200.0);
    let width = (high - low) / count;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of 200 at most")]
    let count = count as u32;
    (0..count).map(move |i| [low + f64::from(i) * width, low + f64::from(i + 1) * width])
}

fn scaled(rule: &'static [Node], low: f64, high: f64) -> impl Iterator<Item = Node> {
    rule.iter().map(move |(x, weight)| (low + (high - low) * x, (high - low) * weight))
}

/// The rule of N nodes on 0…1.
#[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
fn rule<const N: usize>() -> [Node; N] {
    std::array::from_fn(|i| {
        let mut x = libm::cos(PI * (i as f64 + 0.75) / (N as f64 + 0.5));
        let mut slope = 1.0;
        // Newton's method doubles the digits: from two of them, six rounds are one or two too many.
        for _ in 0..6 {
            let (mut before, mut value) = (1.0, x);
            for j in 2..=N {
                let j = j as f64;
                (before, value) = (value, ((2.0 * j - 1.0) * x * value - (j - 1.0) * before) / j);
            }
            slope = N as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

fn rounded<const N: usize>(rule: &[Node; N]) -> [Node; N] {
    rule.map(|(z, weight)| {
        let (sin, cos) = Degrees(180.0 * z).sin_cos();
        (0.5 * (1.0 - cos), 0.5 * PI * sin * weight)
    })
}

#[cfg(test)]
mod tests {
    use super::Order;

    /// A few dozen roundings.
    const ROUNDING: f64 = 64.0 * f64::EPSILON;

    #[test]
    fn polynomials_up_to_twice_the_order_are_exact() {
        for (order, power) in [(Order::Fine, 63), (Order::Coarse, 31), (Order::Rough, 15)] {
            let integral: f64 = order.between(0.0, 1.0).map(|(x, weight)| weight * x.powi(power)).sum();
            assert!((integral * f64::from(power + 1) - 1.0).abs() < ROUNDING, "{order:?}: {integral}");
        }
    }

    #[test]
    fn roots_at_the_ends_are_no_trouble() {
        let integral: f64 = Order::Fine.between_roots(1.0, 3.0).map(|(x, weight)| weight * ((x - 1.0) * (3.0 - x)).sqrt()).sum();
        // Half a circle of radius 1.
        assert!((integral / (0.5 * std::f64::consts::PI) - 1.0).abs() < ROUNDING, "{integral}");
    }
}
