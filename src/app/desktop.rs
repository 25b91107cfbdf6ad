//! The window on a desktop: opening it, and what the user is told where it cannot open.

use crate::app::platform;
use crate::app::shell::app::App;
use crate::app::shell::app::autosave::keep_work;
use crate::app::shell::app::open::begin;
use crate::app::storage::kept_work::WorkFolder;
use crate::app::storage::settings_file;
use crate::app::storage::share_link::is_link;
use crate::app::tasks::file_request::ask_user;
use crate::app::text::help::TITLE;
use crate::app::views::action::Action;
use crate::figure::{self, Image};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use tr::tr;

/// Opens the window with these files and links, or without any with the work of the last time, and returns when
/// the user closes it.
///
/// # Errors
/// The window cannot open; a sentence.
pub fn run(files: Vec<PathBuf>) -> Result<(), String> {
    if !display_is_named() {
        return Err("No display is available: neither DISPLAY nor WAYLAND_DISPLAY is set.".to_owned());
    }
    platform::raise_trim_threshold();
    let (stored, notice) = settings_file::load();
    let mut viewport =
        egui::ViewportBuilder::default().with_title(TITLE).with_app_id(settings_file::APP).with_min_inner_size([1024.0, 640.0]);
    if let Some(icon) = icon() {
        viewport = viewport.with_icon(icon);
    }
    viewport = viewport.with_inner_size(stored.window.size).with_maximized(stored.window.maximized);
    let options = eframe::NativeOptions { viewport, renderer: eframe::Renderer::Glow, ..eframe::NativeOptions::default() };
    let create: eframe::AppCreator<'_> = Box::new(|context| {
        STARTED.store(true, Ordering::Relaxed);
        let mut app = App::new(&context.egui_ctx, stored);
        app.persistence.settings_path = settings_file::path();
        app.jobs.files.ask = ask_user;
        if let Some(notice) = notice {
            app.toasts.error(notice);
        }
        begin(&mut app);
        app.dialogs.tour = (!app.window.knows_tour).then_some(0);
        if let Some(folder) = WorkFolder::of_user() {
            keep_work(&mut app, folder, !files.is_empty());
        }
        let (links, files): (Vec<PathBuf>, Vec<PathBuf>) = files.into_iter().partition(|path| is_link(&path.to_string_lossy()));
        if !files.is_empty() {
            app.actions.push(Action::OpenMeasurements(files));
        }
        app.actions.extend(links.into_iter().map(|link| Action::OpenLink(link.to_string_lossy().into_owned())));
        Ok(Box::new(app))
    });
    quiet_until_started();
    match std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| eframe::run_native(TITLE, options, create))) {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(tr!("The window cannot be opened: {}.", reason(&error))),
        // winit panics where a library of X11 is missing; any later panic is a fault of the
        // program.
        Err(panic) if STARTED.load(Ordering::Relaxed) => std::panic::resume_unwind(panic),
        Err(_) => Err("The window cannot be opened: a library of the window system is missing (on Debian: libxkbcommon-x11-0).".to_owned()),
    }
}

/// What title bars and task bars show.
fn icon() -> Option<egui::IconData> {
    const EDGE: u32 = 128;
    let Image { width, height, rgba } = figure::icon(include_str!("../../assets/icon.svg"), EDGE).ok()?;
    Some(egui::IconData { rgba, width, height })
}

/// Whether the window has opened.
static STARTED: AtomicBool = AtomicBool::new(false);

/// Prints no panic of the window system: it becomes a sentence.
fn quiet_until_started() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if STARTED.load(Ordering::Relaxed) {
            print(info);
        }
    }));
}

/// Whether the environment names a display; systems without X11 and Wayland always have one.
fn display_is_named() -> bool {
    let named = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos"))) || named("DISPLAY") || named("WAYLAND_DISPLAY") || named("WAYLAND_SOCKET")
}

/// The first line of an error of the window system, without paths of source files.
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

#[cfg(test)]
mod tests {
    use super::icon;

    #[test]
    fn the_icon_is_drawn() {
        let icon = icon().unwrap();
        let opacity = |x: u32, y: u32| icon.rgba[4 * (y * icon.width + x) as usize + 3];
        // Round corners, and a ground that covers the middle.
        assert_eq!((opacity(0, 0), opacity(64, 64)), (0, 255));
    }
}
