//! The step size of a sampler, adapted to an acceptance rate by dual averaging (Hoffman and Gelman, JMLR 15, 1593 (2014), section 3.2).

/// γ, t₀ and κ of the paper.
const GAIN: f64 = 0.05;
const DELAY: f64 = 10.0;
const FORGETTING: f64 = 0.75;

/// Dual averaging of the logarithm of a step size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DualAveraging {
    /// Acceptance rate that is aimed at, 0 to 1.
    target: f64,
    center: f64,
    count: f64,
    error: f64,
    log_step: f64,
    log_average: f64,
}

impl DualAveraging {
    /// Begins at a step size, > 0.
    pub(crate) fn new(step_size: f64, target: f64) -> Self {
        let log_step = libm::log(step_size);
        Self { target, center: libm::log(10.0) + log_step, count: 0.0, error: 0.0, log_step, log_average: 0.0 }
    }

    /// Learns of the acceptance rate, 0 to 1, of a transition with [`Self::step_size`].
    pub(crate) fn update(&mut self, acceptance: f64) {
        self.count += 1.0;
        let weight = 1.0 / (self.count + DELAY);
        self.error += weight * (self.target - acceptance - self.error);
        self.log_step = self.center - self.error * self.count.sqrt() / GAIN;
        let share = libm::pow(self.count, -FORGETTING);
        self.log_average += share * (self.log_step - self.log_average);
    }

    /// The step size to try next.
    pub(crate) fn step_size(&self) -> f64 {
        libm::exp(self.log_step)
    }

    /// The step size to keep.
    pub(crate) fn average(&self) -> f64 {
        libm::exp(if self.count > 0.0 { self.log_average } else { self.log_step })
    }
}

#[cfg(test)]
mod tests {
    use super::DualAveraging;

    #[test]
    fn the_step_size_settles_where_the_acceptance_is_as_wanted() {
        // An acceptance of exp(−ε²) is 0.8 at ε = √(−ln 0.8).
        let mut adapted = DualAveraging::new(1e-3, 0.8);
        for _ in 0..2000 {
            let step = adapted.step_size();
            adapted.update(libm::exp(-step * step));
        }
        let expected = (-libm::log(0.8_f64)).sqrt();
        assert!((adapted.average() / expected - 1.0).abs() < 0.02, "{} instead of {expected}", adapted.average());
    }
}
