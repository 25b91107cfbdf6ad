//! The no-U-turn sampler with multinomial weights: Hoffman and Gelman, JMLR 15, 1593 (2014); Betancourt, arXiv:1701.02434.
//!
//! A trajectory doubles, forwards or backwards, until it turns back on itself. Its points are weighted by `exp(−H)`; the next draw is
//! taken within a new half by weight, between the halves in favour of the new one. The metric is the unit matrix: the coordinates
//! are whitened ([`crate::fit::posterior::metric`]). A step is divided where the density is narrow, which multiplies the weights of all
//! points beyond by a ratio of probabilities ([`crate::fit::posterior::macro_step`]). A half is built leaf by leaf, without recursion: of
//! the subtrees that a leaf completes, the momenta of the first leaves wait on a stack.

use crate::fit::posterior::log_density::LogDensity;
use crate::fit::posterior::macro_step::{MacroStep, MacroStepOutcome};
use crate::fit::posterior::phase::{Phase, add_scaled, dot};
use crate::measurement::Deviates;

/// Doublings of a trajectory, at most: 1,023 steps.
const MAX_DEPTH: usize = 10;
fn log_add(a: f64, b: f64) -> f64 {
    let larger = a.max(b);
    if larger == f64::NEG_INFINITY { larger } else { larger + libm::log1p(libm::exp(a.min(b) - larger)) }
}

/// Whether a stretch turns back: its sum of momenta, the ends counted half, against the momentum at either end.
fn turns(sum: &[f64], begin: &[f64], end: &[f64]) -> bool {
    let along = |momentum: &[f64]| dot(sum, momentum) - 0.5 * (dot(begin, momentum) + dot(end, momentum));
    along(begin) <= 0.0 || along(end) <= 0.0
}

/// What a transition did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Transition {
    /// Mean over the trajectory of exp(−|ΔE|), ΔE the change of the energy in an undivided step: 0 to 1.
    pub acceptance: f64,
    /// Whether the energy ran away even in the shortest steps.
    pub diverged: bool,
    /// Whether the trajectory was cut at its greatest length.
    pub cut: bool,
}

/// A chain's place and the buffers of its trajectories.
#[derive(Debug, Clone)]
pub(crate) struct Nuts {
    here: Phase,
    backward: Phase,
    forward: Phase,
    proposal: Phase,
    sum: Vec<f64>,
    half: Half,
}

/// A new half of a trajectory.
#[derive(Debug, Clone)]
struct Half {
    walker: Phase,
    macro_step: MacroStep,
    proposal: Phase,
    sum: Vec<f64>,
    first_momentum: Vec<f64>,
    log_weight: f64,
    /// Of the subtrees under way, by depth: the momentum of the first leaf, and the sum before it.
    stack: Vec<(Vec<f64>, Vec<f64>)>,
}

/// Why a half is of no use, or that it is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum HalfOutcome {
    Whole,
    /// It turns back, or a step in it can't be taken back.
    Turned,
    Diverged,
}

/// exp(−|ΔE|) summed over the points of a trajectory.
#[derive(Debug, Clone, Copy, Default)]
struct AcceptanceSum {
    sum: f64,
    points: f64,
}

impl Nuts {
    /// At a place.
    pub(crate) fn new(density: &mut impl LogDensity, position: &[f64]) -> Self {
        let phase = || Phase::new(position.len());
        let zeros = || vec![0.0; position.len()];
        let mut here = phase();
        here.position.copy_from_slice(position);
        here.log_density = density.value_and_gradient(position, &mut here.gradient);
        let half = Half {
            walker: phase(),
            macro_step: MacroStep::new(position.len()),
            proposal: phase(),
            sum: zeros(),
            first_momentum: zeros(),
            log_weight: 0.0,
            stack: (0..=MAX_DEPTH).map(|_| (zeros(), zeros())).collect(),
        };
        Self { here, backward: phase(), forward: phase(), proposal: phase(), sum: zeros(), half }
    }

    /// Where the chain is.
    pub(crate) fn position(&self) -> &[f64] {
        &self.here.position
    }

    /// Logarithm of the density there.
    pub(crate) fn log_density(&self) -> f64 {
        self.here.log_density
    }

    fn draw_momentum(&mut self, deviates: &mut Deviates) {
        for pair in self.here.momentum.chunks_mut(2) {
            let (one, other) = deviates.pair();
            pair.iter_mut().zip([one, other]).for_each(|(slot, deviate)| *slot = deviate);
        }
    }

    /// A step size that changes the energy by about 0.2 in one step, so that the adaptation begins near its end.
    pub(crate) fn reasonable_step_size(&mut self, density: &mut impl LogDensity, deviates: &mut Deviates) -> f64 {
        const ACCEPTED: f64 = 0.8;
        // 2^±50 holds every scale that a whitened density may have.
        const DOUBLINGS: i32 = 50;
        self.draw_momentum(deviates);
        let before = self.here.energy();
        let mut accepts = |step_size: f64| {
            self.forward.copy_from(&self.here);
            self.forward.step(density, step_size);
            before - self.forward.energy() > libm::log(ACCEPTED)
        };
        let mut step_size = 1.0;
        let factor = if accepts(step_size) { 2.0 } else { 0.5 };
        for _ in 0..DOUBLINGS {
            if accepts(step_size * factor) != (factor > 1.0) {
                return if factor > 1.0 { step_size } else { step_size * factor };
            }
            step_size *= factor;
        }
        step_size
    }

    /// Moves to the next draw.
    pub(crate) fn advance(&mut self, density: &mut impl LogDensity, step_size: f64, deviates: &mut Deviates) -> Transition {
        self.draw_momentum(deviates);
        self.here.log_ratio = 0.0;
        let energy = self.here.energy();
        self.backward.copy_from(&self.here);
        self.forward.copy_from(&self.here);
        self.proposal.copy_from(&self.here);
        self.sum.copy_from_slice(&self.here.momentum);
        let mut log_weight = 0.0;
        let mut accepted = AcceptanceSum::default();
        let mut outcome = HalfOutcome::Whole;
        let mut depth = 0;
        while depth < MAX_DEPTH {
            let is_forward = deviates.uniform() < 0.5;
            let (edge, signed) = if is_forward { (&mut self.forward, step_size) } else { (&mut self.backward, -step_size) };
            outcome = self.half.build(edge, density, signed, depth, energy, deviates, &mut accepted);
            if outcome != HalfOutcome::Whole {
                break;
            }
            if deviates.uniform() < libm::exp(self.half.log_weight - log_weight) {
                self.proposal.copy_from(&self.half.proposal);
            }
            log_weight = log_add(log_weight, self.half.log_weight);
            // The joint of the halves, from both sides, and the whole.
            let joint = self.joint_turns(is_forward);
            let edge = if is_forward { &mut self.forward } else { &mut self.backward };
            edge.copy_from(&self.half.walker);
            add_scaled(&mut self.sum, 1.0, &self.half.sum);
            depth += 1;
            if joint || turns(&self.sum, &self.backward.momentum, &self.forward.momentum) {
                break;
            }
        }
        self.here.copy_from(&self.proposal);
        Transition {
            acceptance: if accepted.points > 0.0 { accepted.sum / accepted.points } else { 0.0 },
            diverged: outcome == HalfOutcome::Diverged,
            cut: depth == MAX_DEPTH,
        }
    }

    /// Whether the old half with the first point of the new one, or the new one with the last point of the old one, turns back.
    fn joint_turns(&self, is_forward: bool) -> bool {
        let (inner, outer) = if is_forward { (&self.forward, &self.backward) } else { (&self.backward, &self.forward) };
        let half = &self.half;
        let with = |sum: &[f64], momentum: &[f64]| -> Vec<f64> { sum.iter().zip(momentum).map(|(a, b)| a + b).collect() };
        turns(&with(&self.sum, &half.first_momentum), &outer.momentum, &half.first_momentum)
            || turns(&with(&half.sum, &inner.momentum), &inner.momentum, &half.walker.momentum)
    }
}

impl Half {
    /// Builds 2^depth points onwards from an edge.
    #[expect(clippy::too_many_arguments, reason = "what a trajectory is made of, on its way once a doubling")]
    fn build(
        &mut self,
        edge: &Phase,
        density: &mut impl LogDensity,
        step_size: f64,
        depth: usize,
        energy: f64,
        deviates: &mut Deviates,
        accepted: &mut AcceptanceSum,
    ) -> HalfOutcome {
        self.walker.copy_from(edge);
        self.sum.fill(0.0);
        self.log_weight = f64::NEG_INFINITY;
        for leaf in 0..1_usize << depth {
            let (outcome, change) = self.macro_step.take(&mut self.walker, density, step_size, deviates);
            accepted.points += 1.0;
            accepted.sum += libm::exp(-change.abs());
            match outcome {
                MacroStepOutcome::Taken => {}
                MacroStepOutcome::OneWay => return HalfOutcome::Turned,
                MacroStepOutcome::Diverged => return HalfOutcome::Diverged,
            }
            let log_weight = energy - self.walker.energy() + self.walker.log_ratio;
            self.log_weight = log_add(self.log_weight, log_weight);
            if leaf == 0 {
                self.first_momentum.copy_from_slice(&self.walker.momentum);
            }
            if deviates.uniform() <= libm::exp(log_weight - self.log_weight) {
                self.proposal.copy_from(&self.walker);
            }
            if self.turned_at(leaf) {
                return HalfOutcome::Turned;
            }
        }
        HalfOutcome::Whole
    }

    /// Adds the walker's momentum to the sum as that leaf, and says whether a subtree that the leaf completes turns back.
    fn turned_at(&mut self, leaf: usize) -> bool {
        let open = (leaf >> 1).count_ones() as usize;
        if leaf.is_multiple_of(2) {
            let (first, before) = &mut self.stack[open];
            first.copy_from_slice(&self.walker.momentum);
            before.copy_from_slice(&self.sum);
            add_scaled(&mut self.sum, 1.0, &self.walker.momentum);
            return false;
        }
        add_scaled(&mut self.sum, 1.0, &self.walker.momentum);
        let completed = leaf.trailing_ones() as usize;
        (open + 1 - completed..=open).rev().any(|level| {
            let (first, before) = &self.stack[level];
            let last = &self.walker.momentum;
            let along = |momentum: &[f64]| {
                let stretch = self.sum.iter().zip(before).zip(first.iter().zip(last));
                stretch.zip(momentum).map(|(((sum, before), (first, last)), p)| (sum - before - 0.5 * (first + last)) * p).sum::<f64>()
            };
            along(first) <= 0.0 || along(last) <= 0.0
        })
    }
}
