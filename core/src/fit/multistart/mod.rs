//! Many starts: a first guess by variable projection on a grid, a low-discrepancy sequence of starts, and the search that ends early.

pub(crate) mod initial_guess;
pub(crate) mod search;
