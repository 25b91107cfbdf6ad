//! Many starts: first guesses by variable projection on a grid, a low-discrepancy sequence, and the search that ends early.

pub(crate) mod basin;
pub(crate) mod box_least_squares;
pub(crate) mod dolp_rows;
pub(crate) mod initial_guess;
pub(crate) mod search;
pub(crate) mod sequence;
pub(crate) mod stopping_rule;
