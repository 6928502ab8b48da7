//! A lesson with the scenes of its steps.

use std::path::{Path, PathBuf};

use super::check::{ResultField, faults};
use super::library::{BuiltInLesson, names};
use super::stage::{Stage, stages};
use super::{Lesson, Step};
use crate::scene::clip::clip;
use crate::scene::data::joined;
use crate::scene::document::{Document, Source, unreadable};
use crate::scene::error::{Fault, Origin, PlacedFault, SceneError};
use crate::scene::files::{ReadError, read_text};
use crate::scene::locate::{Place, Places};
use crate::scene::text::{LARGEST_SCENE, Refusal, read};

/// A lesson, and its scenes step by step.
#[derive(Debug, Clone)]
pub struct LessonDocument {
    /// The lesson.
    pub lesson: Lesson,
    /// Where it came from.
    pub source: Source,
    /// How messages call it: the path as given, or `lesson NAME`.
    pub name: String,
    /// The text that it was read from.
    pub text: String,
    stages: Vec<Stage>,
}

/// Why a lesson cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LessonError {
    /// Neither a file nor a built-in lesson.
    #[error("{spec}: no such file, and no built-in lesson of that name; built in: {lessons}")]
    NoSuchLesson {
        /// What was asked for.
        spec: String,
        /// The names of the lessons, with commas.
        lessons: String,
    },
    /// What is wrong with it: all that could be found, a line each with its place.
    #[error(transparent)]
    Wrong(#[from] SceneError),
}

impl LessonDocument {
    /// Whether a file is meant as a lesson and not as a scene: whether it has steps.
    pub fn is_lesson(path: &Path) -> bool {
        read_text(path, LARGEST_SCENE).is_ok_and(|text| {
            let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
            Places::of(text).find("steps").is_some()
        })
    }

    /// Reads a built-in lesson, by its name, number or words, or the file of a lesson, and checks it.
    /// `results` are the fields that a summary has.
    pub fn load(spec: &str, results: &[ResultField]) -> Result<Self, LessonError> {
        if let Some(lesson) = BuiltInLesson::find(spec) {
            let read = Self::from_text(&format!("lesson {}", lesson.name), lesson.text, None, results)?;
            return Ok(Self { source: Source::BuiltIn(lesson.name), ..read });
        }
        let text = read_text(Path::new(spec), LARGEST_SCENE).map_err(|error| match error {
            ReadError::Missing => LessonError::NoSuchLesson { spec: clip(spec), lessons: names() },
            ReadError::Unusable(problem) => SceneError::Unreadable { name: clip(spec), problem }.into(),
        })?;
        let folder = Path::new(spec).parent().unwrap_or(Path::new(""));
        let read = Self::from_text(&clip(spec), &text, Some(folder), results)?;
        Ok(Self { source: Source::File(PathBuf::from(spec)), ..read })
    }

    /// Parses and checks a lesson; `name` is how messages call it. A scene that is no preset lies in
    /// `folder`, where there is one.
    pub fn from_text(
        name: &str,
        text: &str,
        folder: Option<&Path>,
        results: &[ResultField],
    ) -> Result<Self, LessonError> {
        let parse = |text: &str| read::<Lesson>(text);
        let mut lesson = match begun(text).and_then(|()| parse(text)) {
            Ok(lesson) => lesson,
            Err(refusal) => {
                let rest = |text: &str| {
                    let checked = Self::from_text(name, text, folder, results);
                    checked.err().map(|error| error.to_string()).unwrap_or_default()
                };
                return Err(unreadable(name, text, refusal, |text| parse(text).err(), rest).into());
            }
        };
        for text in lesson.steps.iter_mut().flat_map(Step::texts_mut) {
            *text = joined(text);
        }
        for text in [&mut lesson.goal, &mut lesson.misconception, &mut lesson.lecturer] {
            *text = joined(text);
        }
        let mut wrong = Vec::new();
        let stages = stages(&lesson, folder, &mut wrong);
        wrong.extend(faults(&lesson, &stages, results));
        let own = Self { lesson, source: Source::Text, name: name.to_owned(), text: text.to_owned(), stages };
        if wrong.is_empty() { Ok(own) } else { Err(own.error_from(wrong).into()) }
    }

    /// The scene with which a step begins: that of the lesson with the changes of all steps before, but
    /// without their solutions. Out of range, of the last step.
    pub fn begin(&self, step: usize) -> &Document {
        &self.stages[step.min(self.stages.len() - 1)].begin
    }

    /// The scene of the answer of a prediction, or of the solution of a task; of other steps the one with
    /// which they begin. Out of range, of the last step.
    pub fn end(&self, step: usize) -> &Document {
        &self.stages[step.min(self.stages.len() - 1)].end
    }

    /// Gives faults, whoever found them, the line where their value is written.
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

/// Whether a text may be a lesson at all.
fn begun(text: &str) -> Result<(), Refusal> {
    let refusal = |problem: &str| {
        let place = Place { line: 1, column: 1 };
        Err(Refusal { place, problem: problem.to_owned(), unknown: None })
    };
    match text.trim_start_matches('\u{feff}').trim() {
        "" => refusal("the file is empty; a lesson begins with `(format: 1, title: \"..\", ..`"),
        _ => Ok(()),
    }
}
