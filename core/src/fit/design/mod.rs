//! What a choice of angles would determine, and which angles to choose.
//!
//! [`Design::predict`] says what a measurement would determine before it is made. [`choose()`] picks angles from a [`CandidateGrid`]:
//! D-optimal or for chosen parameters (Fedorov's exchange), or so that a rival model fits worst (T-optimal).

mod candidates;
mod choice;
mod choose;
mod discrimination;
mod exchange;
mod gain;
mod information;
mod prediction;

pub use candidates::{CandidateError, CandidateGrid};
pub use choice::{AngleChoice, AngleChoiceError, ChosenAngles, DesignCriterion};
pub use choose::choose;
pub use gain::next_gains;
pub use prediction::{Design, DesignError, DesignPrediction, NoiseModel};
