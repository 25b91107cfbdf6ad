//! A browser: tasks of the page, its clock, its storage, its dialogs.

use crate::app::platform::file_dialog::{Arrival, DialogUnavailable, FileDialog, PathPurpose};
use crate::files::disk;
use std::cell::RefCell;
use std::io;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{File, HtmlInputElement};

/// The clock of the window and of its jobs.
pub use web_time::Instant;

/// Whether the window is in a page: there files are gone at the next start, and nothing is measured.
pub const IS_PAGE: bool = true;

/// Runs work as a task of its own, after the frame that is being drawn.
///
/// # Errors
/// There is no window.
pub fn spawn(_name: &str, body: impl FnOnce() + 'static) -> io::Result<()> {
    let task = Closure::once_into_js(body);
    let started = web_sys::window().map(|window| window.set_timeout_with_callback(task.unchecked_ref()));
    started.and_then(Result::ok).map(drop).ok_or_else(|| io::Error::other("the page takes no tasks"))
}

/// What the browser says about the language, such as `zh-CN`.
pub fn language() -> Option<String> {
    web_sys::window().and_then(|window| window.navigator().language())
}

/// The address of the page without what a link adds.
pub fn page() -> Option<String> {
    let location = web_sys::window()?.location();
    Some(format!("{}{}", location.origin().ok()?, location.pathname().ok()?))
}

/// The folder for settings in the browser's storage.
#[expect(clippy::unnecessary_wraps, reason = "a user may have no home")]
pub fn config_folder(_app: &str) -> Option<PathBuf> {
    Some(PathBuf::from(disk::KEPT))
}

/// There are no data from elsewhere.
pub fn data_folder(_app: &str) -> Option<PathBuf> {
    None
}

/// The folder for work in the browser's storage.
#[expect(clippy::unnecessary_wraps, reason = "a user may have no home")]
pub fn local_data_folder(_app: &str) -> Option<PathBuf> {
    Some(PathBuf::from(disk::KEPT))
}

/// Date and time to the minute in the time zone of the browser.
pub fn local_time(at: SystemTime) -> String {
    let since = at.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64() * 1e3;
    let date = js_sys::Date::new(&JsValue::from_f64(since));
    let (month, day) = (date.get_month() + 1, date.get_date());
    format!("{:04}-{month:02}-{day:02} {:02}:{:02}", date.get_full_year(), date.get_hours(), date.get_minutes())
}

thread_local! {
    static ARRIVALS: RefCell<Vec<Arrival>> = const { RefCell::new(Vec::new()) };
    static WAKE: RefCell<Option<Rc<dyn Fn()>>> = const { RefCell::new(None) };
}

/// How the window is woken when something arrives: a file, or a link by another address of the page. The answer is the link that the page was
/// opened with.
pub fn on_arrival(wake: impl Fn() + 'static) -> Option<String> {
    WAKE.with_borrow_mut(|place| *place = Some(Rc::new(wake)));
    let changed = Closure::<dyn FnMut()>::new(|| take_link().into_iter().for_each(|link| arrive(Arrival::Link(link))));
    let window = web_sys::window()?;
    let _ = window.add_event_listener_with_callback("hashchange", changed.into_js_value().unchecked_ref());
    take_link()
}

/// The link in the address of the page, which is taken out: loading the page again shows the newest work.
fn take_link() -> Option<String> {
    let window = web_sys::window()?;
    let link = window.location().hash().ok().filter(|hash| hash.len() > 1)?;
    let rest = format!("{}{}", window.location().pathname().ok()?, window.location().search().ok()?);
    let _ = window.history().ok()?.replace_state_with_url(&JsValue::NULL, "", Some(&rest));
    Some(link)
}

/// Whether what points at the page is a finger: on tablets and phones.
pub fn has_fingers() -> bool {
    thread_local! {
        static HAS_FINGERS: bool = web_sys::window()
            .and_then(|window| window.match_media("(pointer: coarse)").ok().flatten())
            .is_some_and(|query| query.matches());
    }
    HAS_FINGERS.with(|has_fingers| *has_fingers)
}

/// What follows the address of the page after `?`, with the `?`.
pub fn query() -> String {
    web_sys::window().and_then(|window| window.location().search().ok()).unwrap_or_default()
}

/// Something that the next frame finds.
pub fn arrive(arrival: Arrival) {
    ARRIVALS.with_borrow_mut(|arrivals| arrivals.push(arrival));
    if let Some(wake) = WAKE.with_borrow(Clone::clone) {
        wake();
    }
}

/// What came apart from the window's own events.
pub fn arrivals() -> Vec<Arrival> {
    ARRIVALS.take()
}

/// Where a file that the user gave the page is held. Two of the same name are one.
fn place_of(name: &str) -> PathBuf {
    Path::new("/").join(name)
}

/// A dropped file arrives when it is read.
pub fn receive(file: &Arc<dyn egui::DroppedFile + Send + Sync>) -> Option<PathBuf> {
    let file = Arc::clone(file);
    spawn_local(async move {
        // A folder cannot be read: nothing comes of it.
        if let Ok(bytes) = file.bytes_async().await {
            let path = place_of(&file.path().to_string_lossy());
            disk::hold(&path, bytes);
            arrive(Arrival::File(path));
        }
    });
    None
}

/// Asks for files, which arrive when they are read; a file that is written gets the suggested name,
/// and the browser asks where it likes to.
///
/// # Errors
/// The page has no document.
pub fn show_file_dialog(dialog: FileDialog) -> Result<Vec<PathBuf>, DialogUnavailable> {
    let FileDialog { title: _, purpose, filters } = dialog;
    if let PathPurpose::Save { suggested_name } = purpose {
        return Ok(vec![PathBuf::from(suggested_name)]);
    }
    let extensions = filters.iter().flat_map(|filter| &filter.extensions).filter(|extension| **extension != "*");
    let accept: Vec<String> = extensions.map(|extension| format!(".{extension}")).collect();
    pick(matches!(purpose, PathPurpose::OpenSeveral), &accept.join(",")).map_err(|_| DialogUnavailable)?;
    Ok(Vec::new())
}

fn pick(several: bool, accept: &str) -> Result<(), JsValue> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or(JsValue::NULL)?;
    let input: HtmlInputElement = document.create_element("input")?.unchecked_into();
    input.set_type("file");
    input.set_multiple(several);
    input.set_accept(accept);
    input.set_hidden(true);
    input.set_id("files");
    let picked = input.clone();
    let chosen = Closure::once_into_js(move || {
        if let Some(files) = picked.files() {
            for file in (0..files.length()).filter_map(|index| files.get(index)) {
                spawn_local(hold(file));
            }
        }
        picked.remove();
    });
    input.add_event_listener_with_callback("change", chosen.unchecked_ref())?;
    // One that was left without a choice.
    if let Some(before) = document.get_element_by_id("files") {
        before.remove();
    }
    document.body().ok_or(JsValue::NULL)?.append_child(&input)?;
    input.click();
    Ok(())
}

async fn hold(file: File) {
    let buffer: JsFuture = file.array_buffer().into();
    if let Ok(buffer) = buffer.await {
        let path = place_of(&file.name());
        disk::hold(&path, js_sys::Uint8Array::new(&buffer).to_vec());
        arrive(Arrival::File(path));
    }
}
