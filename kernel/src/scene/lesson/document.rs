//! Lesson document: a lesson with the scenes of its steps.

use std::path::{Path, PathBuf};

use super::check::{ResultField, faults};
use super::library::{BuiltInLesson, names};
use super::stage::{Stage, stages};
use super::{Lesson, Step};
use crate::scene::data::joined;
use crate::scene::document::{Document, Source, structure_error};
use crate::scene::error::{Fault, Origin, PlacedFault, SceneError, clip};
use crate::scene::files::{ReadError, read_text};
use crate::scene::locate::Places;
use crate::scene::text::{MAX_SCENE_BYTES, ParseError, read};

/// A lesson with the scenes of its steps.
#[derive(Debug, Clone)]
pub struct LessonDocument {
    /// The lesson.
    pub lesson: Lesson,
    /// Where it came from.
    pub source: Source,
    /// Name in messages: the path as given, or `lesson NAME`.
    pub name: String,
    /// The text that it was read from.
    pub text: String,
    stages: Vec<Stage>,
}

/// Reason why a lesson cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LessonError {
    /// Neither a file nor a built-in lesson.
    #[error("{spec}: no such file, and no built-in lesson of that name; built in: {lessons}")]
    NoSuchLesson {
        /// The name or path as given.
        spec: String,
        /// The names of the lessons, separated by commas.
        lessons: String,
    },
    /// Its faults, a line each with its place.
    #[error(transparent)]
    Wrong(#[from] SceneError),
}

impl LessonDocument {
    /// Whether a file is a lesson rather than a scene, because it has steps.
    pub fn is_lesson(path: &Path) -> bool {
        read_text(path, MAX_SCENE_BYTES).is_ok_and(|text| {
            let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
            Places::of(text).find("steps").is_some()
        })
    }

    /// Reads and checks a built-in lesson, given by its name, its number or its words, or the file of a
    /// lesson. `results` are the fields of a summary.
    pub fn load(spec: &str, results: &[ResultField]) -> Result<Self, LessonError> {
        if let Some(lesson) = BuiltInLesson::find(spec) {
            let read = Self::from_text(&format!("lesson {}", lesson.name), lesson.text, None, results)?;
            return Ok(Self { source: Source::BuiltIn(lesson.name), ..read });
        }
        let text = read_text(Path::new(spec), MAX_SCENE_BYTES).map_err(|error| match error {
            ReadError::Missing => LessonError::NoSuchLesson { spec: clip(spec), lessons: names() },
            ReadError::Unusable(problem) => SceneError::Unreadable { name: clip(spec), problem }.into(),
        })?;
        let folder = Path::new(spec).parent().unwrap_or(Path::new(""));
        let read = Self::from_text(&clip(spec), &text, Some(folder), results)?;
        Ok(Self { source: Source::File(PathBuf::from(spec)), ..read })
    }

    /// Parses and checks a lesson; `name` is its name in messages. A scene that is not a preset is read from
    /// `folder`, if given.
    pub fn from_text(
        name: &str,
        text: &str,
        folder: Option<&Path>,
        results: &[ResultField],
    ) -> Result<Self, LessonError> {
        let parse = |text: &str| read::<Lesson>(text);
        let is_empty = text.trim_start_matches('\u{feff}').trim().is_empty();
        let problem = "the file is empty; a lesson begins with `(format: 1, title: \"..\", ..`";
        let mut lesson = match if is_empty { Err(ParseError::at_start(problem)) } else { parse(text) } {
            Ok(lesson) => lesson,
            Err(parse_error) => {
                let rest = |text: &str| Self::from_text(name, text, folder, results).err();
                return Err(structure_error(name, text, parse_error, |text| parse(text).err(), rest).into());
            }
        };
        for text in lesson.steps.iter_mut().flat_map(Step::texts_mut) {
            *text = joined(text);
        }
        for text in [&mut lesson.goal, &mut lesson.misconception, &mut lesson.lecturer] {
            *text = joined(text);
        }
        let mut found = Vec::new();
        let stages = stages(&lesson, folder, &mut found);
        found.extend(faults(&lesson, &stages, results));
        let (name, text) = (name.to_owned(), text.to_owned());
        let document = Self { lesson, source: Source::Text, name, text, stages };
        if found.is_empty() { Ok(document) } else { Err(document.error_from(found).into()) }
    }

    /// The scene at the beginning of a step: the lesson's scene with the changes of all earlier steps, but
    /// not their solutions. Beyond the last step, that of the last step.
    pub fn begin(&self, step: usize) -> &Document {
        &self.stages[step.min(self.stages.len() - 1)].begin
    }

    /// The scene of the answer of a prediction or of the solution of a task; for other steps the scene at
    /// their beginning. Beyond the last step, that of the last step.
    pub fn end(&self, step: usize) -> &Document {
        &self.stages[step.min(self.stages.len() - 1)].end
    }

    /// Adds to faults from any check the place where their value is written.
    pub fn error_from(&self, faults: Vec<Fault>) -> SceneError {
        let places = Places::of(self.text.strip_prefix('\u{feff}').unwrap_or(&self.text));
        let place = |fault: Fault| PlacedFault {
            origin: places.find(&fault.field).map_or(Origin::Unwritten, Origin::Text),
            fault,
        };
        SceneError::Faults {
            name: self.name.clone(),
            faults: faults.into_iter().map(place).collect(),
            more: 0,
        }
    }
}
