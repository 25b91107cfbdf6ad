//! The window as a whole: app, commands, docking, dialogs, toasts, theme, lessons.

pub mod app;
pub mod autosave;
pub mod command_palette;
pub mod commands;
pub mod docking;
pub mod file_dialogs;
pub mod frame_times;
pub mod help_ui;
pub mod import_dialog;
pub mod import_ui;
pub mod job_results;
pub mod lesson_session;
pub mod lesson_step;
pub mod lesson_ui;
pub mod lessons;
pub mod menu_bar;
pub mod overwrite_ui;
pub mod path_entry;
pub mod status_bar;
pub mod theme;
pub mod toasts;
