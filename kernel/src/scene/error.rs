//! Error types of scenes.

use serde::{Deserialize, Serialize};

use super::scanner::Place;
use crate::numeric::one_line;

/// One thing that is wrong with a scene.
///
/// [`Document::error_from`](super::Document::error_from) adds file and line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// Dotted path of the field, without variant names: `stops.travel_limit_mm`.
    pub field: String,
    /// The value as written.
    pub value: String,
    /// The problem and its remedy.
    pub problem: String,
}

impl Fault {
    /// A fault of a field.
    pub fn new(field: impl Into<String>, value: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { field: field.into(), value: value.into(), problem: problem.into() }
    }
}

/// Where the value at fault was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// In the scene's text.
    Text(Place),
    /// In an argument such as `--set stops.travel_limit_mm=0`.
    Argument(String),
    /// Nowhere: a default, or a field that was left out.
    Unwritten,
}

/// A fault and the origin of its value.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedFault {
    /// The fault.
    pub fault: Fault,
    /// Where its value was written.
    pub origin: Origin,
}

/// Reason why a scene cannot be used. The message has one line per fault, each with file, line, field, value
/// and remedy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// Neither a file nor a preset.
    #[error("{spec}: no such file, and no built-in scene of that name; built in: {presets}")]
    NoSuchScene {
        /// The name or path as given.
        spec: String,
        /// The names of the presets, separated by commas.
        presets: String,
    },
    /// The file cannot be read as text.
    #[error("{name}: {problem}")]
    Unreadable {
        /// The file.
        name: String,
        /// The reason and its remedy.
        problem: String,
    },
    /// The text is not a scene.
    #[error("{name}:{}:{}: {problem}{}", place.line, place.column, further(more))]
    Structure {
        /// The file.
        name: String,
        /// Where the parser stopped.
        place: Place,
        /// The reason, with the names that are known there.
        problem: String,
        /// Further errors, a line each, found by parsing the text without the unknown name.
        more: Vec<String>,
    },
    /// All invalid values.
    #[error("{}", lines(name, faults, *more))]
    Faults {
        /// The file.
        name: String,
        /// The faults in the order of the scene's fields.
        faults: Vec<PlacedFault>,
        /// Number of further faults that are not listed.
        more: usize,
    },
    /// An argument that names a field is wrong.
    #[error(transparent)]
    Argument(#[from] ArgumentError),
}

/// Error in a `--set` or `--over` argument.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{argument}: {problem}")]
pub struct ArgumentError {
    /// The argument as it was given, with its option.
    pub argument: String,
    /// The problem and its remedy.
    pub problem: String,
}

fn further(lines: &[String]) -> String {
    lines.iter().map(|line| format!("\n{line}")).collect()
}

/// The faults of the scene called `name`, one per line, and the number of those that are not listed.
fn lines(name: &str, faults: &[PlacedFault], more: usize) -> String {
    let line = |PlacedFault { fault, origin }: &PlacedFault| {
        let origin = match origin {
            Origin::Text(place) => format!("{name}:{}:{}", place.line, place.column),
            Origin::Argument(argument) => format!("{name}: {}", clip(argument)),
            Origin::Unwritten => name.to_owned(),
        };
        let Fault { field, value, problem } = fault;
        let value = if value.is_empty() { String::new() } else { format!(" = {}", clip(value)) };
        format!("{origin}: {field}{value}: {problem}")
    };
    let more = (more > 0).then(|| format!("{name}: and {more} more"));
    faults.iter().map(line).chain(more).collect::<Vec<_>>().join("\n")
}

/// The text shortened to one line without characters that a terminal would obey.
pub(super) fn clip(text: &str) -> String {
    const MAX_LENGTH: usize = 200;
    let begin: String = text.chars().take(MAX_LENGTH + 1).collect();
    let shown = one_line(&begin);
    match shown.char_indices().nth(MAX_LENGTH) {
        Some((end, _)) => format!("{}..", &shown[..end]),
        None => shown,
    }
}
