//! The binary: reads the arguments, hands them to the command line or the window, prints an error once.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    let options = match cli::parse() {
        Ok(options) => options,
        Err(exit) => return exit,
    };
    match cli::run(options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            cli::say(&format!("error: {failure}"));
            failure.exit_code()
        }
    }
}
