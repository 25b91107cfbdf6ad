//! The files of a page.
//!
//! What is under [`KEPT`] lies in the browser's storage, packed. What is written elsewhere is handed
//! to the user as a download. Files that the user picks live as long as the page.

use crate::files::packed;
use std::collections::BTreeMap;
use std::io::{self, Cursor, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use wasm_bindgen::{JsCast as _, JsValue};
use web_sys::{Blob, BlobPropertyBag, HtmlAnchorElement, Storage, Url};

/// The folder in the browser's storage.
pub const KEPT: &str = "/kept";

/// What keys in the browser's storage begin with: other pages of the server have theirs.
const PREFIX: &str = "pbrdf-explorer:";
/// Largest file that is unpacked out of the storage.
const MOST_BYTES: usize = 64 << 20;

/// A file that is open for reading.
pub type OpenedFile = Cursor<Arc<[u8]>>;

static FILES: Mutex<BTreeMap<PathBuf, Arc<[u8]>>> = Mutex::new(BTreeMap::new());

fn files() -> MutexGuard<'static, BTreeMap<PathBuf, Arc<[u8]>>> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

fn not_found() -> io::Error {
    io::Error::from(ErrorKind::NotFound)
}

/// The browser's storage, which the user may forbid.
fn storage() -> io::Result<Storage> {
    let storage = web_sys::window().and_then(|window| window.local_storage().ok().flatten());
    storage.ok_or_else(|| io::Error::new(ErrorKind::PermissionDenied, "the browser keeps nothing for this page"))
}

/// Whether the browser keeps files for this page.
pub fn keeps() -> bool {
    storage().is_ok()
}

/// The key of a kept file; none of a file that is not kept.
fn key(path: &Path) -> Option<String> {
    path.starts_with(KEPT).then(|| format!("{PREFIX}{}", path.display()))
}

/// Milliseconds since 1970 and the packed contents of a kept file.
fn stored(key: &str) -> io::Result<(f64, String)> {
    let text = storage()?.get_item(key).ok().flatten().ok_or_else(not_found)?;
    let (changed, packed) = text.split_once(' ').ok_or_else(|| io::Error::from(ErrorKind::InvalidData))?;
    Ok((changed.parse().unwrap_or(0.0), packed.to_owned()))
}

/// The contents of a file.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    match key(path) {
        Some(key) => packed::unpack(&stored(&key)?.1, MOST_BYTES).ok_or_else(|| io::Error::from(ErrorKind::InvalidData)),
        None => files().get(path).map(|bytes| bytes.to_vec()).ok_or_else(not_found),
    }
}

/// Writes a file: into the storage, or to the user.
pub fn write(path: &Path, bytes: Vec<u8>) -> io::Result<()> {
    if let Some(key) = key(path) {
        let text = format!("{} {}", js_sys::Date::now(), packed::pack(&bytes));
        let full = |_| io::Error::new(ErrorKind::StorageFull, "the storage of the browser is full");
        return storage()?.set_item(&key, &text).map_err(full);
    }
    download(path, &bytes).map_err(|_| io::Error::other("the browser takes no download"))
}

/// Holds a file that the user picked, until the page closes.
pub fn hold(path: &Path, bytes: Vec<u8>) {
    files().insert(path.to_owned(), bytes.into());
}

/// Hands a file to the user.
fn download(path: &Path, bytes: &[u8]) -> Result<(), JsValue> {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let parts = js_sys::Array::of1(&js_sys::Uint8Array::from(bytes));
    let kind = BlobPropertyBag::new();
    kind.set_type("application/octet-stream");
    let url = Url::create_object_url_with_blob(&Blob::new_with_u8_array_sequence_and_options(&parts, &kind)?)?;
    let document = web_sys::window().and_then(|window| window.document()).ok_or(JsValue::NULL)?;
    let anchor: HtmlAnchorElement = document.create_element("a")?.unchecked_into();
    anchor.set_href(&url);
    anchor.set_download(&name);
    anchor.click();
    // The browser has taken the file over by the time the next task runs.
    let release = wasm_bindgen::closure::Closure::once_into_js(move || Url::revoke_object_url(&url));
    let window = web_sys::window().ok_or(JsValue::NULL)?;
    window.set_timeout_with_callback_and_timeout_and_arguments_0(release.unchecked_ref(), 10_000).map(drop)
}

/// Opens a file for reading.
pub fn open(path: &Path) -> io::Result<OpenedFile> {
    if key(path).is_some() {
        return read(path).map(|bytes| Cursor::new(bytes.into()));
    }
    files().get(path).cloned().map(Cursor::new).ok_or_else(not_found)
}

/// Bytes of an opened file.
#[expect(clippy::unnecessary_wraps, reason = "a file of a system may not tell")]
pub fn length(file: &OpenedFile) -> Option<u64> {
    Some(file.get_ref().len() as u64)
}

/// Bytes of a file; none where there is no such file.
pub fn length_at(path: &Path) -> Option<u64> {
    open(path).ok().and_then(|file| length(&file))
}

/// Another name for a file.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    write(to, read(from)?)?;
    remove_file(from)
}

/// Takes a file away.
pub fn remove_file(path: &Path) -> io::Result<()> {
    match key(path) {
        Some(key) => storage()?.remove_item(&key).map_err(|_| not_found()),
        None => files().remove(path).map(drop).ok_or_else(not_found),
    }
}

/// Folders need not be made.
#[expect(clippy::unnecessary_wraps, reason = "a system may refuse a folder")]
pub fn create_dir_all(_folder: &Path) -> io::Result<()> {
    Ok(())
}

/// What a kept folder holds, with the time of the last change.
pub fn entries(folder: &Path) -> Vec<(PathBuf, SystemTime)> {
    let Ok(storage) = storage() else { return Vec::new() };
    let count = storage.length().unwrap_or(0);
    let keys = (0..count).filter_map(|index| storage.key(index).ok().flatten());
    let kept = keys.filter_map(|key| {
        let path = PathBuf::from(key.strip_prefix(PREFIX)?);
        let changed = stored(&key).ok()?.0;
        (path.parent() == Some(folder)).then(|| (path, UNIX_EPOCH + milliseconds(changed)))
    });
    kept.collect()
}

/// Pages lock nothing: every page writes a file of its own and goes on with the newest one.
#[derive(Debug)]
pub struct PageLock;

/// Locks nothing.
#[expect(clippy::unnecessary_wraps, reason = "a system may refuse a lock")]
pub fn lock(_path: &Path) -> io::Result<PageLock> {
    Ok(PageLock)
}

/// Locks nothing.
#[expect(clippy::unnecessary_wraps, reason = "somebody else may have a lock of a system")]
pub fn try_lock(_path: &Path) -> Option<PageLock> {
    Some(PageLock)
}

/// Nobody locks.
pub fn is_locked(_path: &Path) -> bool {
    false
}

fn milliseconds(count: f64) -> Duration {
    Duration::try_from_secs_f64(count / 1e3).unwrap_or_default()
}

/// The clock of the wall; that of the standard library panics in a page.
pub fn now() -> SystemTime {
    UNIX_EPOCH + milliseconds(js_sys::Date::now())
}
