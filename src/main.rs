//! Entry point of the binary: parses the arguments, runs a command or the window, and prints an error once.

mod cli;

use std::cell::Cell;
use std::process::ExitCode;

fn main() -> ExitCode {
    let options = match cli::parse() {
        Ok(options) => options,
        Err(exit) => return exit,
    };
    let scene_failure = Cell::new(None);
    match cli::run(options, |scene| window(scene, &scene_failure)) {
        Ok(()) => scene_failure.take().unwrap_or(ExitCode::SUCCESS),
        Err(failure) => {
            cli::say(&format!("error: {failure}"));
            failure.exit_code()
        }
    }
}

/// Opens the window. If the scene cannot be opened, the error is shown in the window and printed, and its
/// exit code is stored in `scene_failure`.
#[cfg(feature = "app")]
fn window(scene: Option<&str>, scene_failure: &Cell<Option<ExitCode>>) -> Result<(), cli::Failure> {
    use interwell::app::{AppError, run};
    let say = |error| {
        let failure = cli::Failure::from(error);
        cli::say(&format!("error: {failure}"));
        scene_failure.set(Some(failure.exit_code()));
    };
    run(scene, say).map_err(|error| match error {
        AppError::Scene(error) => error.into(),
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
