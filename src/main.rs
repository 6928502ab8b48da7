//! The binary: reads the arguments, hands them to the command line or the window, prints an error once.

mod cli;

use std::cell::Cell;
use std::process::ExitCode;

fn main() -> ExitCode {
    let options = match cli::parse() {
        Ok(options) => options,
        Err(exit) => return exit,
    };
    let refused = Cell::new(None);
    match cli::run(options, |scene| window(scene, &refused)) {
        Ok(()) => refused.take().unwrap_or(ExitCode::SUCCESS),
        Err(failure) => {
            cli::say(&format!("error: {failure}"));
            failure.exit_code()
        }
    }
}

/// Opens the window; a scene that cannot be opened is said here and there, and leaves its exit status in
/// `refused`.
#[cfg(feature = "app")]
fn window(scene: Option<&str>, refused: &Cell<Option<ExitCode>>) -> Result<(), cli::Failure> {
    use interwell::app::{AppError, CannotRun, run};
    let failure = |error: CannotRun| match error {
        CannotRun::Wrong(error) => cli::Failure::from(error),
        CannotRun::Unsolved(_) => cli::Failure::Failed(error.into()),
    };
    let say = |error| {
        let failure = failure(error);
        cli::say(&format!("error: {failure}"));
        refused.set(Some(failure.exit_code()));
    };
    run(scene, say).map_err(|error| match error {
        AppError::Scene(error) => failure(error),
        AppError::NoWindow(_) => cli::Failure::Failed(error.into()),
    })
}

#[cfg(not(feature = "app"))]
fn window(_: Option<&str>, _: &Cell<Option<ExitCode>>) -> Result<(), cli::Failure> {
    Err(cli::Failure::argument(format!(
        "this build has no window: use interwell --headless with {}; see interwell --help",
        cli::command_names()
    )))
}
