//! Floor 6: the window.
//!
//! `logic` takes the results of jobs, applies commands and refreshes what is derived; `ui` draws what is there and pushes commands. No
//! model is evaluated in a paint closure and no fit runs on this thread.

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

use shell::app::App;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use storage::settings_file;
use tr::tr;

const TITLE: &str = "pBRDF explorer";

/// Opens the window, with a measurement in it; returns when it is closed. The error is a sentence.
pub fn run(file: Option<PathBuf>) -> Result<(), String> {
    if !display_is_named() {
        return Err("No display is available: neither DISPLAY nor WAYLAND_DISPLAY is set.".to_owned());
    }
    platform::raise_trim_threshold();
    let (stored, notice) = settings_file::load();
    let mut viewport =
        egui::ViewportBuilder::default().with_title(TITLE).with_app_id(settings_file::APP).with_min_inner_size([1024.0, 640.0]);
    viewport = viewport.with_inner_size(stored.window.size).with_maximized(stored.window.maximized);
    let options = eframe::NativeOptions { viewport, renderer: eframe::Renderer::Glow, ..eframe::NativeOptions::default() };
    let create: eframe::AppCreator<'_> = Box::new(|context| {
        STARTED.store(true, Ordering::Relaxed);
        let mut explorer = App::new(&context.egui_ctx, stored);
        explorer.settings_file = settings_file::path();
        explorer.jobs.files.ask = tasks::file_request::ask_user;
        if let Some(notice) = notice {
            explorer.say(notice);
        }
        explorer.working_file = settings_file::working_path();
        let is_alone = file.is_none();
        explorer.begin(file);
        if is_alone {
            explorer.resume();
        }
        Ok(Box::new(explorer))
    });
    quiet_until_started();
    match std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| eframe::run_native(TITLE, options, create))) {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(tr!("The window cannot be opened: {}.", reason(&error))),
        // winit panics where a library of X11 is missing; a panic of our own goes on.
        Err(panic) if STARTED.load(Ordering::Relaxed) => std::panic::resume_unwind(panic),
        Err(_) => Err("The window cannot be opened: a library of the window system is missing (on Debian: libxkbcommon-x11-0).".to_owned()),
    }
}

/// Whether the window got as far as having contents.
static STARTED: AtomicBool = AtomicBool::new(false);

/// Keeps a panic of the window system, which becomes a sentence, from being printed as well.
fn quiet_until_started() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if STARTED.load(Ordering::Relaxed) {
            print(info);
        }
    }));
}

/// Whether the environment names a display; elsewhere than on Linux and BSD there always is one.
fn display_is_named() -> bool {
    let named = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos"))) || named("DISPLAY") || named("WAYLAND_DISPLAY") || named("WAYLAND_SOCKET")
}

/// The first line of an error of the window system, without paths into its source.
fn reason(error: &eframe::Error) -> String {
    let text = error.to_string();
    let first = text.lines().next().unwrap_or("the window system gives no reason");
    first
        .rsplit(".rs:")
        .next()
        .unwrap_or(first)
        .trim_start_matches(|c: char| c.is_ascii_digit() || ": ".contains(c))
        .trim_end_matches('.')
        .to_owned()
}
