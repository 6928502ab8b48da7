//! Errors of the command line, with their exit statuses and messages.

use std::fmt;
use std::process::ExitCode;

use interwell::output::OpenError;
use interwell::questions::Error;
use interwell::scene::lesson::LessonError;
use interwell::scene::{ArgumentError, SceneError};
use interwell_studies::study::{GridError, Spelling, SweepEnd};

/// Returns the error of a wrong argument from the function; the message is formatted as by `format!`.
macro_rules! refuse {
    ($($message:tt)*) => {
        return Err($crate::cli::Failure::argument(format_args!($($message)*)))
    };
}
pub(super) use refuse;

/// An error of a command, by its exit status.
#[derive(Debug)]
pub enum Failure {
    /// The arguments or the scene are wrong, or a folder is missing: status 2.
    Wrong(anyhow::Error),
    /// The run or the writing failed: status 1.
    Failed(anyhow::Error),
}

impl Failure {
    /// A wrong argument; the message says what would be right.
    pub fn argument(message: impl fmt::Display) -> Self {
        Self::Wrong(anyhow::anyhow!("{message}"))
    }

    /// A failed run; the message says why.
    pub fn failed(message: impl fmt::Display) -> Self {
        Self::Failed(anyhow::anyhow!("{message}"))
    }

    /// The command was ended by Ctrl-C or another request to end.
    pub fn interrupted() -> Self {
        Self::failed("interrupted: no output file was made or changed")
    }

    /// `name` could not be written.
    pub fn writing(name: impl fmt::Display, error: std::io::Error) -> Self {
        Self::failed(format!("cannot write {name}: {error}"))
    }

    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Wrong(_) => ExitCode::from(2),
            Self::Failed(_) => ExitCode::from(1),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Wrong(error) | Self::Failed(error)) = self;
        write!(f, "{error:#}")
    }
}

macro_rules! arguments_are_wrong {
    ($($error:ty),*) => {$(
        impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::Wrong(error.into())
            }
        }
    )*};
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Scene(error) => error.into(),
            Error::Argument { name, value, problem } => {
                let option = if name == "threads" { "jobs".to_owned() } else { name.replace('_', "-") };
                let option = format!("--{option} {value}");
                Self::argument(format!("{}: {}", option.trim_end(), problem.spelled(Spelling::CommandLine)))
            }
            Error::Cancelled => Self::interrupted(),
            error @ Error::Failed { .. } => Self::failed(error.message()),
            error => Self::argument(error.message()),
        }
    }
}

arguments_are_wrong! {
    SceneError, LessonError, ArgumentError
}

impl From<GridError> for Failure {
    fn from(error: GridError) -> Self {
        match error {
            GridError::NoAxes => Self::argument(format!("--over: {error}")),
            error => Self::argument(error),
        }
    }
}

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::Refused { .. } => Self::Failed(error.into()),
            error => Self::Wrong(error.into()),
        }
    }
}

impl From<SweepEnd<Self>> for Failure {
    fn from(end: SweepEnd<Self>) -> Self {
        match end {
            SweepEnd::Cancelled => Self::interrupted(),
            SweepEnd::Write(failure) => failure,
        }
    }
}
