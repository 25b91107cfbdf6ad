//! Floor 6: the window.
//!
//! In each frame `App::logic` takes the results of jobs, executes commands and refreshes what is derived; `App::ui` draws and queues
//! commands. No paint closure evaluates a model, and no fit runs on this thread.

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
