//! Floor 6: the window.
//!
//! In each frame `logic` takes the results of jobs, executes actions and refreshes what is derived;
//! `ui` draws, and gathers edits of the work, which are carried out after it, and actions. No paint
//! closure evaluates a model, and no fit runs on this thread.

mod desktop;
mod jobs;
mod panels;
mod platform;
mod plots;
mod shell;
mod storage;
mod tasks;
#[cfg(test)]
mod tests;
mod text;
mod views;
mod work;

pub use desktop::run;
