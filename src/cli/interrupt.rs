//! Handler of Ctrl-C, which ends a command without leaving a partly written file.

use std::sync::atomic::{AtomicBool, Ordering};

use interwell::study::Task;

use super::Failure;

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

/// The failure of an interrupted command if Ctrl-C was pressed.
pub fn check() -> Result<(), Failure> {
    if INTERRUPTED.load(Ordering::Relaxed) { Err(Failure::interrupted()) } else { Ok(()) }
}
