//! Workers of a page: each is the same program in a thread of its own, without a window and without
//! the page's memory. A worker is sent a text and answers with texts.
//!
//! A worker that computes takes no messages. It learns that it is cancelled when an address of the
//! page's own (a blob) is gone, which it asks for from time to time.

use crate::app::platform::web::spawn;
use std::cell::{Cell, RefCell};
use std::io;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use web_sys::{Blob, DedicatedWorkerGlobalScope, MessageEvent, Url, Worker, WorkerOptions, WorkerType, XmlHttpRequest};
use web_time::Instant;

/// Script that loads the program in a worker, beside the page.
const SCRIPT: &str = "./worker.js";
/// What a worker says once it takes requests.
const READY: &str = "ready";
/// What it says where a request means nothing to it.
const FAILED: &str = "failed";
/// Between two looks whether a request is cancelled.
const LOOK_AFTER: Duration = Duration::from_millis(100);

/// What comes back from a worker.
pub enum Reply {
    Progress(String),
    /// The answer, which is the last reply.
    Answer(String),
    /// The worker ended without an answer.
    Failed,
}

type Receive = Box<dyn FnMut(Reply)>;

/// A worker of the page.
struct Hand {
    worker: Worker,
    is_ready: Cell<bool>,
    /// What is sent once the worker is ready.
    waiting: RefCell<Option<String>>,
    receive: RefCell<Option<Receive>>,
}

thread_local! {
    /// Whether the browser has ended a worker before it was ready: no other one will be.
    static ARE_REFUSED: Cell<bool> = const { Cell::new(false) };
    /// Workers without a request.
    static IDLE: RefCell<Vec<Rc<Hand>>> = const { RefCell::new(Vec::new()) };
}

/// A request that a worker works on. Dropped before its answer, it ends with its worker.
pub struct Beside {
    hand: Rc<Hand>,
    errand: Rc<Errand>,
}

/// How far a request is.
#[derive(Default)]
struct Errand {
    /// Gone when the request is cancelled or answered. Browsers ask another process for it and wait: never in a frame.
    address: Cell<Option<String>>,
    is_cancelled: Cell<bool>,
    is_done: Cell<bool>,
}

impl Errand {
    /// Takes the address away.
    fn revoke(&self) {
        if let Some(address) = self.address.take() {
            let _ = Url::revoke_object_url(&address);
        }
    }
}

impl Hand {
    fn new() -> Result<Rc<Self>, JsValue> {
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let worker = Worker::new_with_options(SCRIPT, &options)?;
        let hand = Rc::new(Self { worker, is_ready: Cell::new(false), waiting: RefCell::default(), receive: RefCell::default() });
        let of = Rc::downgrade(&hand);
        let told = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            if let Some((hand, text)) = of.upgrade().zip(event.data().as_string()) {
                hand.told(&text);
            }
        });
        hand.worker.set_onmessage(Some(told.into_js_value().unchecked_ref()));
        let of = Rc::downgrade(&hand);
        let failed = Closure::<dyn FnMut()>::new(move || {
            if let Some(hand) = of.upgrade() {
                if !hand.is_ready.get() {
                    ARE_REFUSED.set(true);
                }
                hand.reply(Reply::Failed);
            }
        });
        hand.worker.set_onerror(Some(failed.into_js_value().unchecked_ref()));
        hand.worker.post_message(&wasm_bindgen::module())?;
        Ok(hand)
    }

    fn told(&self, text: &str) {
        if text == READY {
            self.is_ready.set(true);
            if let Some(request) = self.waiting.take() {
                self.send(request);
            }
        } else if text == FAILED {
            self.reply(Reply::Failed);
        } else if let Some(progress) = text.strip_prefix('p') {
            self.reply(Reply::Progress(progress.to_owned()));
        } else if let Some(answer) = text.strip_prefix('a') {
            self.reply(Reply::Answer(answer.to_owned()));
        }
    }

    fn reply(&self, reply: Reply) {
        // The receiver may give the worker back.
        let receive = self.receive.take();
        if let Some(mut receive) = receive {
            let is_last = !matches!(reply, Reply::Progress(_));
            receive(reply);
            if !is_last {
                self.receive.replace(Some(receive));
            }
        }
    }

    fn send(&self, request: String) {
        if !self.is_ready.get() {
            self.waiting.replace(Some(request));
        } else if self.worker.post_message(&JsValue::from_str(&request)).is_err() {
            self.reply(Reply::Failed);
        }
    }
}

/// Starts a worker before it is needed: loading takes a moment.
fn warm_up() {
    if let Ok(hand) = Hand::new() {
        IDLE.with_borrow_mut(|idle| idle.push(hand));
    }
}

/// Whether the browser has workers for this page.
pub fn are_there() -> bool {
    !ARE_REFUSED.get()
}

/// Sends a request to a worker: what `ask` gives, in a task of its own after the frame that is being drawn. Where it gives none, nothing
/// is sent.
///
/// # Errors
/// The browser starts no worker, or the page takes no tasks.
pub fn beside(ask: impl FnOnce() -> Option<String> + 'static, mut receive: impl FnMut(Reply) + 'static) -> io::Result<Beside> {
    let refused = |_| io::Error::other("the browser starts no worker");
    let hand = IDLE.with_borrow_mut(Vec::pop).map_or_else(Hand::new, Ok).map_err(refused)?;
    let errand = Rc::new(Errand::default());
    let (told, of) = (errand.clone(), Rc::downgrade(&hand));
    let received = move |reply: Reply| {
        let is_answer = matches!(reply, Reply::Answer(_));
        if !matches!(reply, Reply::Progress(_)) {
            told.revoke();
        }
        told.is_done.set(is_answer);
        if let Some(hand) = of.upgrade().filter(|_| is_answer) {
            IDLE.with_borrow_mut(|idle| idle.push(hand));
        }
        receive(reply);
    };
    hand.receive.replace(Some(Box::new(received)));
    let (asked, of) = (errand.clone(), Rc::downgrade(&hand));
    spawn("ask a worker", move || {
        // Dropped meanwhile, it has no receiver any more.
        let Some(hand) = of.upgrade().filter(|hand| hand.receive.borrow().is_some()) else { return };
        let Some(request) = ask() else {
            asked.is_done.set(true);
            hand.receive.take();
            IDLE.with_borrow_mut(|idle| idle.push(hand));
            return;
        };
        let Ok(address) = Blob::new().and_then(|blob| Url::create_object_url_with_blob(&blob)) else {
            hand.reply(Reply::Failed);
            return;
        };
        asked.address.set(Some(address.clone()));
        hand.send(format!("{address}\n{request}"));
        // Cancelled before it was sent, it gives what it has at once.
        if asked.is_cancelled.get() {
            asked.revoke();
        }
    })?;
    Ok(Beside { hand, errand })
}

/// Lets a worker do something whose result nobody needs. It ends with what it has in memory, and another one is started before it is needed.
pub fn do_aside(request: &'static str) {
    let kept: Rc<RefCell<Option<Beside>>> = Rc::default();
    let done = kept.clone();
    let received = move |_| {
        drop(done.take());
        warm_up();
    };
    kept.replace(beside(move || Some(request.to_owned()), received).ok());
}

impl Beside {
    /// Asks the worker to stop soon; its answer still comes.
    pub fn cancel(&self) {
        self.errand.is_cancelled.set(true);
        self.errand.revoke();
    }
}

impl Drop for Beside {
    fn drop(&mut self) {
        self.cancel();
        if !self.errand.is_done.get() {
            self.hand.receive.take();
            self.hand.worker.terminate();
        }
    }
}

/// The scope of this program, if it runs in a worker.
fn scope() -> Option<DedicatedWorkerGlobalScope> {
    js_sys::global().dyn_into().ok()
}

/// What a worker does with a request. It is given the request, whether to stop, and whom to tell progress.
pub type Answer = fn(&str, &(dyn Fn() -> bool + Sync), &(dyn Fn(&str) + Sync)) -> Option<String>;

/// Takes requests, if this is a worker: answers each with a text.
pub fn serve(answer: Answer) -> bool {
    let Some(scope) = scope() else { return false };
    // A worker asks no other.
    ARE_REFUSED.set(true);
    let take = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
        let text = event.data().as_string().unwrap_or_default();
        let (address, request) = text.split_once('\n').unwrap_or(("", ""));
        let look =
            Look { address: address.to_owned(), is_cancelled: AtomicBool::new(false), looked_at: std::sync::Mutex::new(Instant::now()) };
        let result = answer(request, &|| look.is_cancelled(), &|progress| tell(&format!("p{progress}")));
        match result {
            Some(result) => tell(&format!("a{result}")),
            None => tell(FAILED),
        }
    });
    scope.set_onmessage(Some(take.into_js_value().unchecked_ref()));
    tell(READY);
    true
}

/// A message to the page.
fn tell(text: &str) {
    if let Some(scope) = scope() {
        let _ = scope.post_message(&JsValue::from_str(text));
    }
}

/// Looks from time to time whether the address of a request is still there.
struct Look {
    address: String,
    is_cancelled: AtomicBool,
    looked_at: std::sync::Mutex<Instant>,
}

impl Look {
    fn is_cancelled(&self) -> bool {
        if let Ok(mut looked_at) = self.looked_at.lock()
            && looked_at.elapsed() >= LOOK_AFTER
        {
            *looked_at = Instant::now();
            let is_there = XmlHttpRequest::new().and_then(|request| {
                request.open_with_async("GET", &self.address, false)?;
                request.send()
            });
            self.is_cancelled.store(is_there.is_err(), Ordering::Relaxed);
        }
        self.is_cancelled.load(Ordering::Relaxed)
    }
}
