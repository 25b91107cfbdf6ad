//! The window as a whole: app, commands, docking, dialogs, toasts, theme, lessons.

pub mod app;
mod command_palette;
pub mod commands;
mod dialogs;
pub mod docking;
pub mod file_dialogs;
mod frame_times;
mod help_ui;
mod import_dialog;
mod import_picture_ui;
mod import_table_ui;
mod import_ui;
mod lesson_ui;
pub mod lessons;
mod menu_bar;
mod overwrite_ui;
mod path_entry;
mod persistence;
mod presentation;
mod readout_ui;
pub mod room;
mod stage;
mod status_bar;
mod theme;
mod tiles;
mod toasts;
mod tour;
