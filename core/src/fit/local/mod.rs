//! From one start to a minimum: two solvers, the coordinates that straighten valleys, and small dense linear algebra.

pub(crate) mod bounded_lm;
pub(crate) mod minpack;
pub(crate) mod qr;
pub(crate) mod recorder;
pub(crate) mod reparametrisation;
pub(crate) mod sin_squared;
pub(crate) mod solution;
pub(crate) mod solver;
pub(crate) mod tall_qr;
