//! The program pbrdf-explorer: a command line and a window on the core, the crate `pbrdf`.
//!
//! Floors, each importing only those before it: [`figure`] (the plotter), [`report`] (documents, JSON, tables), `cli`, `app` (the
//! window).

#[cfg(feature = "gui")]
mod app;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "cli")]
mod export;
pub mod figure;
#[cfg(feature = "cli")]
mod open_file;
pub mod report;
#[cfg(feature = "cli")]
mod write_file;
