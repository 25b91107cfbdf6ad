//! One descent from one start: MINPACK until its progress stalls, then the bounded Levenberg–Marquardt.

pub(crate) mod bounded_lm;
pub(crate) mod minpack;
pub(crate) mod qr;
pub(crate) mod reparametrisation;
pub(crate) mod solver;
