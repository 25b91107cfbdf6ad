//! Floor 6: the window.
//!
//! In each frame `logic` takes the results of jobs, executes actions and refreshes what is derived;
//! `ui` draws, and gathers edits of the work, which are carried out after it, and actions. No paint
//! closure evaluates a model, and no fit runs on this thread.

#[cfg(not(target_arch = "wasm32"))]
mod desktop;
mod jobs;
#[cfg(target_arch = "wasm32")]
mod page;
mod panels;
mod platform;
mod plots;
#[cfg(any(test, target_arch = "wasm32"))]
mod rehearsal;
mod shell;
mod storage;
mod tasks;
#[cfg(test)]
mod tests;
mod text;
mod views;
mod work;

#[cfg(not(target_arch = "wasm32"))]
pub use desktop::run;
#[cfg(target_arch = "wasm32")]
pub use page::run;
