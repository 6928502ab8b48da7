//! Arguments that stand in a picture's file: those of its command that change something on it.

use std::path::Path;

/// An argument of a command.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Argument {
    /// The option without its dashes; none for the scene.
    pub option: Option<String>,
    /// What it is given; none for a switch.
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

    /// The words of it.
    pub fn words(&self) -> impl Iterator<Item = String> {
        let option = self.option.as_ref().map(|option| format!("--{option}"));
        option.into_iter().chain(self.value.clone())
    }
}

/// Options that change nothing on a picture, such as the number of threads and the places of files.
const IDLE: [&str; 14] = [
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

/// The words with which the program makes the same picture again, of those that `command` was given in the
/// order of `--help`. Options that change nothing on it are left out, so that the same picture is the same
/// bytes; the place of the picture is no part of it, its kind is.
pub fn picture_arguments(command: &str, given: impl IntoIterator<Item = Argument>) -> Vec<String> {
    let kept = given
        .into_iter()
        .filter(|argument| !argument.option.as_deref().is_some_and(|option| IDLE.contains(&option)));
    let words = kept.flat_map(|mut argument| {
        let ending = argument.value.as_deref().and_then(|value| Path::new(value).extension());
        let ending = ending.map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        if let (Some(name @ ("plot" | "contact-plot")), Some(ending)) = (argument.option.as_deref(), ending) {
            argument.value = Some(format!("{}.{ending}", name.replace('-', "_")));
        }
        argument.words().collect::<Vec<_>>()
    });
    ["--headless".to_owned(), command.to_owned()].into_iter().chain(words).collect()
}
