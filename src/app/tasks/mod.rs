//! The jobs of the program: one slot for each kind, and the functions that start them.
//!
//! A new background task touches three places: its slot and the function that starts it, both in
//! [`files`], [`fits`], [`posteriors`] or [`benchmarks`], and the line of `shell/job_results.rs` that says where
//! its result goes.

#[cfg(any(test, target_arch = "wasm32"))]
pub mod answer;
pub mod benchmarks;
#[cfg(any(test, target_arch = "wasm32"))]
mod bits;
pub mod file_request;
pub mod files;
pub mod fit_work;
pub mod fits;
#[cfg(any(test, target_arch = "wasm32"))]
mod inquiry_message;
pub mod inquiry_work;
pub mod jobs;
#[cfg(any(test, target_arch = "wasm32"))]
pub mod landscape_message;
#[cfg(any(test, target_arch = "wasm32"))]
pub mod messages;
pub mod plans;
mod portable;
#[cfg(any(test, target_arch = "wasm32"))]
mod posterior_message;
pub mod posterior_work;
pub mod posteriors;
mod start_error;
#[cfg(any(test, target_arch = "wasm32"))]
pub mod view_message;
#[cfg(any(test, target_arch = "wasm32"))]
pub mod wire;
