//! What happens before each frame: results of jobs, dropped files, actions, what is derived, what
//! is kept.

use crate::app::platform::{self, Arrival};
use crate::app::shell::app::App;
use crate::app::shell::app::autosave::{autosave_when_rested, save_when_rested};
use crate::app::shell::app::execute::execute;
use crate::app::shell::app::fits::{follow_active, refit_if_moved};
use crate::app::shell::app::job_results::poll_jobs;
use crate::app::shell::app::open::{open_waiting, reopen_if_asked};
use crate::app::shell::app::title::show_title;
use crate::app::shell::app::walk::walk_on;
use crate::app::shell::shortcuts;
use crate::app::text::i18n;
use crate::app::views::action::{Action, InquiryAction};
use crate::app::views::pointed_theta_r;
use crate::app::work::lesson_stage::ReadoutPlace;
use egui::{Key, Modifiers};
use std::path::PathBuf;

/// Before each frame.
pub fn logic(app: &mut App, ctx: &egui::Context) {
    let mut files: Vec<PathBuf> = ctx.input(|input| input.raw.dropped_files.iter().filter_map(platform::receive).collect());
    for arrival in platform::arrivals() {
        match arrival {
            Arrival::File(path) => files.push(path),
            Arrival::Link(text) => app.actions.push(Action::OpenLink(text)),
        }
    }
    if !files.is_empty() {
        app.actions.push(Action::OpenMeasurements(files));
    }
    i18n::set(app.window.language);
    listen_to_keys(app, ctx);
    app.jobs.spawner.begin_frame();
    poll_jobs(app);
    open_waiting(app);
    for action in std::mem::take(&mut app.actions) {
        if let Err(sentence) = execute(app, ctx, action) {
            app.toasts.error(sentence);
        }
    }
    app.interacting = ctx.input(|input| input.pointer.any_down());
    // Sliders that move by themselves are held as if by hand: one step of undo.
    app.interacting |= walk_on(app, ctx);
    follow_active(app);
    refit_if_moved(app);
    if !app.interacting && !app.jobs.fits.refit.is_running() {
        app.work.record_step();
    }
    reopen_if_asked(app);
    refresh(app, ctx);
    show_title(app, ctx);
    remember_window(app, ctx);
    save_when_rested(app, ctx);
    autosave_when_rested(app, ctx);
}

/// Makes anew what is on screen and has other inputs than before.
fn refresh(app: &mut App, ctx: &egui::Context) {
    app.derived.refresh_status(&app.work);
    let free = app.free();
    app.derived.refresh_outlook(&app.work, free);
    let readings = readings(app);
    let pointer = pointed_theta_r(ctx, !readings.is_empty());
    app.derived.refresh_readout(&app.work, readings, pointer);
    if let Some(import) = &mut app.dialogs.import {
        import.refresh();
    }
    app.dock.activate_tabs();
    let on_screen = app.dock.on_screen();
    if app.views.need_curves(&on_screen) {
        app.derived.refresh_curves(&app.work);
    }
    let (mut cx, views, _) = app.split();
    views.refresh(&on_screen, &mut cx);
    app.apply_edits();
}

/// Where the read-out reads: where the step of the lesson says; in a presentation in the mirror direction
/// at least.
fn readings(app: &App) -> Vec<ReadoutPlace> {
    let of_lesson = app.lessons.current().map_or_else(Vec::new, |(_, step)| step.staging.readings.clone());
    if of_lesson.is_empty() && app.dock.is_presented() { vec![ReadoutPlace::Mirror] } else { of_lesson }
}

fn listen_to_keys(app: &mut App, ctx: &egui::Context) {
    app.actions.extend(app.dialogs.after_typing.take());
    // Keys belong to the question that is asked, or to the field that is being typed into as far as it has a use for them.
    if app.dialogs.import.is_some() || app.dialogs.overwrite.is_some() {
        return;
    }
    if ctx.text_edit_focused() {
        if let Some(action) = shortcuts::pressed_while_typing(app, ctx) {
            app.dialogs.after_typing = Some(action);
            ctx.memory_mut(egui::Memory::stop_text_input);
            ctx.request_repaint();
        }
        return;
    }
    if app.jobs.fits.walking_since.is_some() && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
        app.actions.push(Action::Inquire(InquiryAction::CancelWalk));
    }
    app.actions.extend(shortcuts::pressed(app, ctx));
    let text = |event: &egui::Event| if let egui::Event::Paste(text) = event { Some(text.clone()) } else { None };
    let pasted = ctx.input(|input| input.events.iter().find_map(text));
    app.actions.extend(pasted.map(Action::PasteParameters));
}

fn remember_window(app: &mut App, ctx: &egui::Context) {
    let zoom = ctx.zoom_factor();
    if app.dock.is_presented() {
        // The size is the screen's, and the zoom the talk's.
        app.window.talk.zoom = zoom;
        return;
    }
    app.window.zoom = zoom;
    let (size, maximized) = ctx.input(|input| (input.viewport().inner_rect.map(|rect| rect.size()), input.viewport().maximized));
    app.window.maximized = maximized.unwrap_or(false);
    if let Some(size) = size.filter(|_| !app.window.maximized) {
        // Windows begin at zoom 1.
        app.window.size = [(zoom * size.x).round(), (zoom * size.y).round()];
    }
}
