//! Arguments of a command that make the same picture or the same rows again, as they are recorded.

use std::path::Path;

/// An argument of a command.
#[doc(hidden)]
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

/// Where an option is recorded.
#[derive(PartialEq)]
enum Recorded {
    /// Nowhere: neither a picture nor the rows depend on it.
    Nowhere,
    /// With a picture: the rows do not depend on it, or its change is in the scene of the manifest.
    WithPicture,
    /// With the rows as well.
    WithRows,
}

fn recorded(option: &str) -> Recorded {
    match option {
        "out" | "jobs" | "quiet" | "plot-data" | "events" | "summary" | "landscape" | "shapes"
        | "contact" | "attractors" | "comparison" | "strict" | "resume" | "force" | "runs-to" => {
            Recorded::Nowhere
        }
        "set" | "tolerance" | "shard" | "check" | "measured" | "shift-s" | "offset-mm" | "time-scale"
        | "inset" | "plot" | "shapes-plot" | "mechanism-plot" | "well-plot" | "base-accel-g"
        | "contact-plot" | "plot-size" | "plot-width-mm" | "plot-height-mm" | "font-pt" | "dpi"
        | "plot-x" | "plot-y" | "dark" | "no-title" | "beside" | "panels" | "quantity" | "surface"
        | "cut" => Recorded::WithPicture,
        _ => Recorded::WithRows,
    }
}

/// The command line that makes the same picture again, from the arguments `given` to `command` in the order
/// of `--help`. Options that do not affect the picture are left out, so that equal pictures have equal bytes.
/// For the same reason the path of the picture is reduced to its file format.
#[doc(hidden)]
pub fn picture_arguments(command: &str, given: impl IntoIterator<Item = Argument>) -> Vec<String> {
    let is_nowhere = |option: &String| recorded(option) == Recorded::Nowhere;
    let kept = given.into_iter().filter(|argument| !argument.option.as_ref().is_some_and(is_nowhere));
    let words = kept.flat_map(|mut argument| {
        let ending = argument.value.as_deref().and_then(|value| Path::new(value).extension());
        let ending = ending.map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let name = argument.option.as_deref().filter(|name| *name == "plot" || name.ends_with("-plot"));
        if let (Some(name), Some(ending)) = (name, ending) {
            argument.value = Some(format!("{}.{ending}", name.replace('-', "_")));
        }
        argument.words().collect::<Vec<_>>()
    });
    ["--headless".to_owned(), command.to_owned()].into_iter().chain(words).collect()
}

/// Place of the scene in the arguments of [`repeated`].
pub(super) const REPEATED_SCENE: usize = 2;

/// The arguments that write the same rows to standard output, from the arguments `given` to `command` in the
/// order of `--help`, with the `manifest` in place of the scenes, or with the file that was given where the
/// command reads no scene.
#[doc(hidden)]
pub fn repeated(
    command: &str,
    manifest: Option<&Path>,
    given: impl IntoIterator<Item = Argument>,
) -> Vec<String> {
    let is_repeated = |argument: &Argument| match argument.option.as_deref() {
        None => manifest.is_none(),
        // columns of a record
        Some("time" | "time-unit" | "column" | "unit" | "position" | "position-unit") => {
            command == "identify"
        }
        // the scenes of a comparison have its excitation
        Some("environment") => command != "compare",
        Some(option) => recorded(option) == Recorded::WithRows,
    };
    let scene = manifest.map(|path| path.to_string_lossy().into_owned());
    let first = ["--headless".to_owned(), command.to_owned()].into_iter().chain(scene);
    let options =
        given.into_iter().filter(is_repeated).flat_map(|argument| argument.words().collect::<Vec<_>>());
    first.chain(options).chain(["--out".to_owned(), "-".to_owned()]).collect()
}
