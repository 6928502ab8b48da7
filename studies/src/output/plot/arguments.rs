//! Arguments recorded in a picture's file: those of its command that affect the picture.

use std::path::Path;

/// An argument of a command.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Argument {
    /// The option without its dashes; `None` for the scene.
    pub option: Option<String>,
    /// The value of the option; `None` for a switch.
    pub value: Option<String>,
}

impl Argument {
    /// An option with its value.
    pub fn of(option: &str, value: impl Into<String>) -> Self {
        Self { option: Some(option.to_owned()), value: Some(value.into()) }
    }

    /// A switch.
    pub fn switch(option: &str) -> Self {
        Self { option: Some(option.to_owned()), value: None }
    }

    /// Its words on the command line.
    pub fn words(&self) -> impl Iterator<Item = String> {
        let option = self.option.as_ref().map(|option| format!("--{option}"));
        option.into_iter().chain(self.value.clone())
    }
}

/// Options that do not affect a picture, such as the number of threads and the paths of other files.
const IGNORED: [&str; 14] = [
    "out",
    "jobs",
    "quiet",
    "plot-data",
    "events",
    "summary",
    "landscape",
    "shapes",
    "contact",
    "attractors",
    "comparison",
    "strict",
    "resume",
    "force",
];

/// The command line that makes the same picture again, from the arguments `given` to `command` in the order
/// of `--help`. Options that do not affect the picture are left out, so that equal pictures have equal bytes.
/// For the same reason the path of the picture is reduced to its file format.
pub fn picture_arguments(command: &str, given: impl IntoIterator<Item = Argument>) -> Vec<String> {
    let kept = given
        .into_iter()
        .filter(|argument| !argument.option.as_deref().is_some_and(|option| IGNORED.contains(&option)));
    let words = kept.flat_map(|mut argument| {
        let ending = argument.value.as_deref().and_then(|value| Path::new(value).extension());
        let ending = ending.map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        if let (Some(name @ ("plot" | "contact-plot" | "shapes-plot")), Some(ending)) =
            (argument.option.as_deref(), ending)
        {
            argument.value = Some(format!("{}.{ending}", name.replace('-', "_")));
        }
        argument.words().collect::<Vec<_>>()
    });
    ["--headless".to_owned(), command.to_owned()].into_iter().chain(words).collect()
}
