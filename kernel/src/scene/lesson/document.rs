//! Lesson document: a lesson with the scenes of its steps.

use std::path::{Path, PathBuf};

use super::check::{ResultField, faults};
use super::{BuiltInLesson, Lesson, Step, names};
use crate::scene::data::joined;
use crate::scene::document::{Document, Source, structure_error};
use crate::scene::error::{Fault, Origin, PlacedFault, SceneError, clip};
use crate::scene::files::{ReadError, read_text};
use crate::scene::presets::PRESETS;
use crate::scene::scanner::Places;
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

#[derive(Debug, Clone)]
pub(super) struct Stage {
    /// At the beginning of the step.
    pub begin: Document,
    /// For the answer or the solution; at the beginning for a step without them.
    pub end: Document,
}

/// The scenes of all steps; their faults are added to `found`.
pub(super) fn stages(lesson: &Lesson, folder: Option<&Path>, found: &mut Vec<Fault>) -> Vec<Stage> {
    let preset = PRESETS.iter().any(|preset| preset.name == lesson.scene);
    let spec = match folder.filter(|_| !preset) {
        Some(folder) => folder.join(&lesson.scene).to_string_lossy().into_owned(),
        None => lesson.scene.clone(),
    };
    let first_line = |error: &SceneError| error.to_string().lines().next().unwrap_or_default().to_owned();
    let mut current = match Document::load(&spec) {
        Ok(document) => document,
        Err(error) => {
            // a lesson from elsewhere may name any file: its own words are not quoted
            let problem = match error {
                SceneError::Structure { name, .. } => {
                    format!("{name} is no scene: `interwell --headless check` of it says why")
                }
                other => first_line(&other),
            };
            found.push(Fault::new("scene", &lesson.scene, problem));
            return Vec::new();
        }
    };
    let mut change = |document: &mut Document, changes: &[(String, String)], at: &str| {
        for (index, (field, value)) in changes.iter().enumerate() {
            if let Err(error) = document.assign(field, value, &format!("{field}={value}")) {
                found.push(Fault::new(format!("{at}.{index}"), format!("{field}={value}"), error.problem));
            }
        }
        if let Err(error) = document.check() {
            found.push(Fault::new(at, "", first_line(&error)));
        }
    };
    change(&mut current, &lesson.set, "set");
    let mut stages = Vec::with_capacity(lesson.steps.len());
    for (index, step) in lesson.steps.iter().enumerate() {
        let at = |part: &str| format!("steps.{index}.{part}");
        let stage = match step {
            Step::Say(_) | Step::Explain(_) => Stage { begin: current.clone(), end: current.clone() },
            Step::Predict { set, .. } => {
                let begin = current.clone();
                change(&mut current, set, &at("set"));
                Stage { begin, end: current.clone() }
            }
            Step::Do { set, solution, .. } => {
                change(&mut current, set, &at("set"));
                let mut end = current.clone();
                change(&mut end, solution, &at("solution"));
                Stage { begin: current.clone(), end }
            }
        };
        stages.push(stage);
    }
    stages
}
