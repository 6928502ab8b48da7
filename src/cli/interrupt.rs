//! Handler of Ctrl-C, which ends a command without leaving a partly written file.

use std::sync::atomic::{AtomicBool, Ordering};

use interwell::questions::Progress;

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

/// A question's progress without reports, that Ctrl-C cancels.
pub fn progress() -> Progress<'static> {
    Progress::none().stopped_by(listen())
}

/// The failure of an interrupted command if Ctrl-C was pressed.
pub fn check() -> Result<(), Failure> {
    if INTERRUPTED.load(Ordering::Relaxed) { Err(Failure::interrupted()) } else { Ok(()) }
}
