//! A call of a library that panics on damaged input, turned into a value.

#[cfg(panic = "unwind")]
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
#[cfg(panic = "unwind")]
use std::sync::{Arc, Mutex, PoisonError};
#[cfg(panic = "unwind")]
use std::thread;

/// Where a panic ends the program, as in a browser, there is nothing to contain.
#[cfg(panic = "abort")]
pub(crate) fn contained<T>(call: impl FnOnce() -> T) -> Option<T> {
    Some(call())
}

/// One call at a time: the hook of panics is one for the whole program.
#[cfg(panic = "unwind")]
static CALL: Mutex<()> = Mutex::new(());

/// What the call returns; none where it panics. The panic is not reported, those of other threads are.
#[cfg(panic = "unwind")]
pub(crate) fn contained<T>(call: impl FnOnce() -> T) -> Option<T> {
    let _one = CALL.lock().unwrap_or_else(PoisonError::into_inner);
    let here = thread::current().id();
    let before = Arc::new(take_hook());
    let others = Arc::clone(&before);
    set_hook(Box::new(move |panic| {
        if thread::current().id() != here {
            others(panic);
        }
    }));
    let result = catch_unwind(AssertUnwindSafe(call)).ok();
    drop(take_hook());
    if let Some(before) = Arc::into_inner(before) {
        set_hook(before);
    }
    result
}

#[cfg(test)]
mod tests {
    use super::contained;

    #[test]
    fn a_panic_becomes_nothing_and_a_value_stays() {
        assert_eq!(contained(|| 3), Some(3));
        assert_eq!(contained(|| [1, 2, 3][std::hint::black_box(3)]), None);
    }
}
