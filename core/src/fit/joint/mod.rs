//! Fits of several measurements: parameters that all share, and parameters that each measurement has for itself.
//!
//! The unknowns are the own parameters, measurement after measurement, and then the shared ones. The objective is Eq. (18) over the union of
//! all rows. Columns of the Jacobian that belong to one measurement are 0 in the rows of the others.

pub(crate) mod builder;
pub(crate) mod coordinates;
pub(crate) mod problem;
pub(crate) mod result;
pub(crate) mod starts;
pub(crate) mod unknown;
