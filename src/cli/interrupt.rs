//! Ctrl-C, SIGTERM and SIGHUP: the first one asks for the best result so far, the second one ends the program.

use crate::cli::failure::INTERRUPTED;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Installs the handler.
pub fn watch() {
    // Without the handler a signal ends the program, which is acceptable.
    let _ = ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
    });
}

/// Whether the user asked to stop.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
