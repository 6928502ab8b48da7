//! Handler of Ctrl-C, which ends a command without leaving a partly written file.

use std::sync::atomic::{AtomicBool, Ordering};

use interwell::study::Task;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Makes Ctrl-C (or a request to terminate) set the returned flag, which runs and writers check. A second
/// Ctrl-C ends the program at once, because after the first a write may still wait for the reader of a pipe.
pub fn listen() -> &'static AtomicBool {
    // A second call fails and changes nothing.
    let _ = ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(1);
        }
    });
    &INTERRUPTED
}

/// A task without progress that Ctrl-C ends.
pub fn silent_task() -> Task<'static> {
    Task { tick: &|| (), cancel: listen() }
}

/// Whether Ctrl-C was pressed.
pub fn came() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}
