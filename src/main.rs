//! The binary: reads the arguments, hands them to the command line or the window, prints an error once.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    let options = match cli::parse() {
        Ok(options) => options,
        Err(exit) => return exit,
    };
    match cli::run(options, window) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            cli::say(&format!("error: {failure}"));
            failure.exit_code()
        }
    }
}

#[cfg(feature = "app")]
fn window(scene: Option<&str>) -> Result<(), cli::Failure> {
    use interwell::app::{AppError, CannotRun, run};
    run(scene).map_err(|error| match error {
        AppError::Scene(CannotRun::Wrong(error)) => error.into(),
        AppError::Scene(CannotRun::Unsolved(_)) | AppError::NoWindow(_) => cli::Failure::Failed(error.into()),
    })
}

#[cfg(not(feature = "app"))]
fn window(_: Option<&str>) -> Result<(), cli::Failure> {
    Err(cli::Failure::argument(
        "this build has no window: use interwell --headless with presets, check, curve, simulate, sweep, threshold or accuracy; \
         see interwell --help",
    ))
}
