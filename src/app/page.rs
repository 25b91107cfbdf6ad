//! The window in a page of a browser.

use crate::app::platform;
use crate::app::platform::probe::tell_widgets;
use crate::app::platform::worker::{Answer, do_aside, serve};
use crate::app::rehearsal::rehearse;
use crate::app::shell::app::App;
use crate::app::shell::app::autosave::{keep_work, save_on_exit};
use crate::app::shell::app::open::begin;
use crate::app::shell::room::Query;
use crate::app::storage::kept_work::WorkFolder;
use crate::app::storage::settings_file;
use crate::app::tasks::answer::answer;
use crate::app::tasks::file_request::ask_user;
use crate::app::tasks::wire::Wire;
use crate::app::views::action::Action;
use crate::files::disk;
use tr::tr;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use web_sys::{HtmlCanvasElement, KeyboardEvent};

/// What a worker is asked that plays the first minutes with a window.
const REHEARSE: &str = "rehearse";

/// In a worker of the page, takes the page's requests. In the page, draws the window into the page's canvas `window`, and takes the page's element `loading` away. Where
/// that cannot be, the element says why.
pub fn run() {
    let take: Answer = |request, is_cancelled, tell| {
        if request == REHEARSE {
            rehearse();
            return None;
        }
        answer(request, &Wire { is_cancelled, tell })
    };
    if serve(take) {
        return;
    }
    wasm_bindgen_futures::spawn_local(async {
        let result = start().await;
        let loading = web_sys::window().and_then(|window| window.document()?.get_element_by_id("loading"));
        match (result, loading) {
            (Ok(()), Some(loading)) => {
                loading.remove();
                do_aside(REHEARSE);
            }
            (Err(error), Some(loading)) => loading.set_text_content(Some(&sentence(&error))),
            (_, None) => {}
        }
    });
}

fn sentence(error: &JsValue) -> String {
    let reason = error.as_string().unwrap_or_else(|| format!("{error:?}"));
    tr!("The window cannot be opened: {}.", reason.trim_end_matches('.'))
}

async fn start() -> Result<(), JsValue> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or("the page has no document")?;
    let canvas = document.get_element_by_id("window").ok_or("the page has no canvas")?;
    let canvas: HtmlCanvasElement = canvas.dyn_into().map_err(|_| "the page has no canvas")?;
    let create: eframe::AppCreator<'static> = Box::new(|context| Ok(Box::new(app(&context.egui_ctx))));
    let runner = eframe::WebRunner::new();
    // No gradient needs it, and where no graphics card draws it is work for every pixel.
    let options = eframe::WebOptions { dithering: false, ..Default::default() };
    runner.start(canvas, options, create).await?;
    claim_keys()?;
    keep_on_leaving(runner)
}

/// Keeps browsers from using keys of the window for themselves, so that F5 fits and does not load the page again. Those that close or
/// change tabs, browsers do not give away.
fn claim_keys() -> Result<(), JsValue> {
    let pressed = Closure::<dyn FnMut(KeyboardEvent)>::new(|event: KeyboardEvent| {
        let (key, has_ctrl) = (event.key(), event.ctrl_key() || event.meta_key());
        let is_ours = match key.as_str() {
            "F1" | "F2" | "F5" => !has_ctrl,
            _ => has_ctrl && matches!(key.to_lowercase().as_str(), "b" | "l" | "o" | "p" | "r" | "s" | "y" | "z"),
        };
        if is_ours && !event.alt_key() {
            event.prevent_default();
        }
    });
    let window = web_sys::window().ok_or("the page has no window")?;
    window.add_event_listener_with_callback_and_bool("keydown", pressed.into_js_value().unchecked_ref(), true)
}

/// Keeps what has not rested yet when the page is left or hidden: it may not come back.
fn keep_on_leaving(runner: eframe::WebRunner) -> Result<(), JsValue> {
    let left = Closure::<dyn FnMut()>::new(move || {
        if let Some(mut app) = runner.app_mut::<App>() {
            save_on_exit(&mut app);
        }
    });
    let window = web_sys::window().ok_or("the page has no window")?;
    let left = left.into_js_value();
    window.add_event_listener_with_callback("pagehide", left.unchecked_ref())?;
    window.document().ok_or("the page has no document")?.add_event_listener_with_callback("visibilitychange", left.unchecked_ref())
}

fn app(ctx: &egui::Context) -> App {
    let query = Query::new(&platform::query());
    if query.is_probed {
        tell_widgets(ctx);
    }
    let (stored, notice) = if query.embedded.is_some() { (settings_file::fresh(), None) } else { settings_file::load() };
    let mut app = App::new(ctx, stored);
    app.jobs.files.ask = ask_user;
    if let Some(notice) = notice {
        app.toasts.error(notice);
    }
    let repaint = ctx.clone();
    let link = platform::on_arrival(move || repaint.request_repaint());
    begin(&mut app);
    if query.embedded.is_none() && !disk::keeps() {
        app.toasts.error(tr!("The browser keeps nothing for this page: what you do is lost when it closes. Save a session as a file."));
    } else if query.embedded.is_none() {
        app.persistence.settings_path = settings_file::path();
        if let Some(folder) = WorkFolder::of_user() {
            keep_work(&mut app, folder, link.is_some() || query.lesson.is_some());
        }
    }
    app.actions.extend(query.lesson.map(|lesson| Action::ShowStep(lesson, 0)));
    app.actions.extend(link.map(Action::OpenLink));
    app.dialogs.room.embedded = query.embedded;
    app
}
