//! Ctrl-C, which ends a command and leaves no half file.

use std::sync::atomic::{AtomicBool, Ordering};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From here on Ctrl-C (and a request to terminate) sets the flag that this returns, which runs and
/// writers look at. A second one ends the program at once: the first may have met a reader of a pipe
/// that does not read.
pub fn listen() -> &'static AtomicBool {
    // A second call fails and changes nothing.
    let _ = ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(1);
        }
    });
    &INTERRUPTED
}

/// Whether Ctrl-C came.
pub fn came() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}
