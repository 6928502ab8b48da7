//! A scene with where it came from, so that everything said about it can name file and line.

use std::path::{Path, PathBuf};

use super::axis::{Axis, LARGEST_AXIS, MOST_AXES, repeated, unknown};
use super::check::{check, corners};
use super::data::{Mechanism, Scene};
use super::error::{ArgumentError, Fault, Origin, PlacedFault, SceneError};
use super::fields::{Field, FieldPath, Slot, all_fields};
use super::files::{Files, ReadError, read_text};
use super::locate::Places;
use super::presets::{self, PRESETS};
use super::record;
use super::text::{self, LARGEST_SCENE, clip, explain};

/// How many faults an error names; the rest it counts. A list may hold a million NaN.
const MOST_FAULTS: usize = 50;

/// The most values that the axes of a sweep may have together. Three axes that pass it, of which none alone is too long,
/// make more cells than any sweep may have; they are refused before they are all written out.
const MOST_VALUES: usize = 2 * LARGEST_AXIS;

/// Where a scene came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// The built-in scene of this name.
    BuiltIn(&'static str),
    /// A scene file.
    File(PathBuf),
    /// Text that has no name of its own.
    Text,
}

/// A scene, its text, and the arguments that changed it since.
#[derive(Debug, Clone)]
pub struct Document {
    /// The scene, with every argument applied.
    pub scene: Scene,
    /// Where it came from.
    pub source: Source,
    /// How messages call it: the path as given, or `built-in NAME`.
    pub name: String,
    /// The text that it was read from.
    pub text: String,
    /// Where the files that it names are.
    pub files: Files,
    /// Fields that an argument changed, with that argument; the last one counts.
    assigned: Vec<(String, String)>,
    /// What is wrong with the records that the excitation names.
    unread: Vec<Fault>,
}

impl Document {
    /// Reads a scene file, or the built-in scene of that name. A file that is called like a built-in
    /// scene is reached by `./paper`.
    pub fn load(spec: &str) -> Result<Self, SceneError> {
        if let Some(document) = Self::preset(spec) {
            return document;
        }
        let text = match read_text(Path::new(spec), LARGEST_SCENE) {
            Ok(text) => text,
            Err(ReadError::Missing) => {
                let spec = if spec.is_empty() { "\"\"".to_owned() } else { clip(spec) };
                return Err(SceneError::NoSuchScene { spec, presets: presets::names() });
            }
            Err(ReadError::Unusable(problem)) => {
                return Err(SceneError::Unreadable { name: clip(spec), problem });
            }
        };
        let read = Self::from_text(&clip(spec), &text, Files::beside(Path::new(spec)))?;
        Ok(Self { source: Source::File(PathBuf::from(spec)), ..read })
    }

    /// The built-in scene of that name. The inner result is an error only if the program was built
    /// with a wrong preset, which its tests exclude.
    fn preset(name: &str) -> Option<Result<Self, SceneError>> {
        let preset = PRESETS.iter().find(|preset| preset.name == name)?;
        let read = Self::from_text(&format!("built-in {name}"), preset.text, Files::default());
        Some(read.map(|read| Self { source: Source::BuiltIn(preset.name), ..read }))
    }

    /// Parses a scene; `name` is how messages call it. Ranges are left to [`check`](Self::check), so
    /// that an argument may still mend them.
    pub fn from_text(name: &str, text: &str, files: Files) -> Result<Self, SceneError> {
        let mut scene = text::parse(text).map_err(|refusal| SceneError::Structure {
            name: name.to_owned(),
            place: refusal.place,
            problem: refusal.problem,
        })?;
        let unread = record::attach(&mut scene.excitation, "excitation", &files);
        let (name, text) = (name.to_owned(), text.to_owned());
        Ok(Self { scene, source: Source::Text, name, text, files, assigned: Vec::new(), unread })
    }

    /// Applies `FIELD=VALUE` as given to `--set`: a number, or any value in RON
    /// (`stops=Rigid(travel_limit_mm: 4, restitution: 0.36)`, `run.settle_s=None`). A text may stand
    /// without its quotes.
    pub fn set(&mut self, argument: &str) -> Result<(), ArgumentError> {
        let shown = format!("--set {argument}");
        match argument.split_once('=') {
            Some((field, value)) => self.assign(field.trim(), value.trim(), &shown),
            None => {
                let problem = "write FIELD=VALUE, such as stops.travel_limit_mm=1.5".to_owned();
                Err(ArgumentError { argument: clip(&shown), problem })
            }
        }
    }

    /// Puts a value into a field; `argument` is what errors about it name, such as `--tolerance 1e-6`.
    /// On an error the scene is as it was. Ranges are left to [`check`](Self::check).
    pub fn assign(&mut self, field: &str, value: &str, argument: &str) -> Result<(), ArgumentError> {
        let error = |problem| Err(ArgumentError { argument: clip(argument), problem });
        if value.len() > LARGEST_SCENE {
            return error("the value is longer than a scene may be".to_owned());
        }
        match FieldPath::new(field).follow(&mut self.scene, |found| replace(found, value)) {
            Some(Ok(())) => {
                self.assigned.push((field.to_owned(), clip(argument)));
                if field.starts_with("excitation") {
                    self.unread = record::attach(&mut self.scene.excitation, "excitation", &self.files);
                }
                Ok(())
            }
            Some(Err(problem)) => error(problem),
            None => error(unknown("field", field, &all_fields(&self.scene))),
        }
    }

    /// Where the files lie that the scene names: its table and its records.
    pub fn named_files(&self) -> Vec<PathBuf> {
        let table = match &self.scene.mechanism {
            Mechanism::Table { path, .. } => Some(path.as_str()),
            _ => None,
        };
        let named = table.into_iter().chain(record::paths(&self.scene.excitation));
        named.filter_map(|path| self.files.place(path)).collect()
    }

    /// Checks the scene: all faults at once as an error, or the warnings, each with the file's name.
    pub fn check(&self) -> Result<Vec<String>, SceneError> {
        let mut checked = check(&self.scene);
        if !self.assigned.is_empty() && self.argument_for("sweep").is_none() {
            // `--set stops=None` leaves the scene's own sweep over the stops without a field. That is
            // no concern of a single run; `axes` says it to whoever asks for the map.
            let stranded = |field: &str| field.starts_with("sweep.") && field.ends_with(".field");
            checked.faults.retain(|fault| !stranded(&fault.field));
        }
        checked.faults.extend(self.unread.iter().cloned());
        if checked.faults.is_empty() {
            let duration = self.scene.run.duration_s;
            checked.warnings.extend(record::warnings(&self.scene.excitation, duration));
            Ok(checked.warnings.iter().map(|warning| format!("{}: {warning}", self.name)).collect())
        } else {
            Err(self.error_from(checked.faults))
        }
    }

    /// The axes of a sweep of this scene: the given `--over` arguments, or, where there are none, the
    /// scene's own `sweep`; empty where that is empty too. Every value is within its field's range, no
    /// field is swept twice, and the relations between fields hold all over the grid.
    pub fn axes<S: AsRef<str>>(&self, over: &[S]) -> Result<Vec<Axis>, SceneError> {
        // Before anything is written out: a hundred long axes would fill the memory.
        if over.len() > MOST_AXES {
            let problem = format!("{} axes are more than a sweep may have ({MOST_AXES})", over.len());
            return Err(ArgumentError { argument: "--over".to_owned(), problem }.into());
        }
        let mut values = 0;
        let mut room = |axis: &Axis| {
            values += axis.values.len();
            if values <= MOST_VALUES {
                Ok(())
            } else {
                Err(format!(
                    "{values} values, with the axes before it, are more than a sweep may have ({MOST_VALUES}); give larger steps"
                ))
            }
        };
        let axes: Vec<Axis> = if over.is_empty() {
            // The check says more about what is wrong.
            let refused = || self.error_from(check(&self.scene).faults);
            if self.scene.sweep.len() > MOST_AXES {
                return Err(refused());
            }
            let own = self.scene.sweep.iter().map(|axis| {
                let axis = Axis::from_scene(axis, &self.scene).map_err(|_| refused())?;
                room(&axis).map_err(|problem| ArgumentError { argument: "sweep".to_owned(), problem })?;
                Ok(axis)
            });
            own.collect::<Result<_, SceneError>>()?
        } else {
            let parse = |over: &S| {
                let argument = over.as_ref();
                let parsed = Axis::parse(argument, &self.scene).and_then(|axis| room(&axis).map(|()| axis));
                parsed.map_err(|problem| ArgumentError {
                    argument: clip(&format!("--over {argument}")),
                    problem,
                })
            };
            over.iter().map(parse).collect::<Result<_, _>>()?
        };
        if let Some(field) = repeated(axes.iter().map(|axis| axis.field.as_str())) {
            let argument = if over.is_empty() { "sweep" } else { "--over" };
            let problem = format!("{field} is swept twice; give each field one axis");
            return Err(ArgumentError { argument: argument.to_owned(), problem }.into());
        }
        let faults = corners(&self.scene, &axes);
        if faults.is_empty() { Ok(axes) } else { Err(self.error_from(faults)) }
    }

    /// Gives faults, whoever found them, the place where their value was written.
    pub fn error_from(&self, faults: Vec<Fault>) -> SceneError {
        let places = Places::of(self.text.strip_prefix('\u{feff}').unwrap_or(&self.text));
        let place = |fault: Fault| {
            let origin = match self.argument_for(&fault.field) {
                Some(argument) => Origin::Argument(argument.to_owned()),
                None => places.find(&fault.field).map_or(Origin::Unwritten, Origin::Text),
            };
            PlacedFault { fault, origin }
        };
        let more = faults.len().saturating_sub(MOST_FAULTS);
        let faults = faults.into_iter().take(MOST_FAULTS).map(place).collect();
        SceneError::Faults { name: self.name.clone(), faults, more }
    }

    /// The last argument that wrote this field, or something around it or inside it.
    fn argument_for(&self, field: &str) -> Option<&str> {
        let covers = |outer: &str, inner: &str| {
            inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let written = self.assigned.iter().rev();
        written
            .clone()
            .find(|(own, _)| covers(own, field))
            .or_else(|| written.clone().find(|(own, _)| covers(field, own)))
            .map(|(_, argument)| argument.as_str())
    }
}

/// The paths of the files that a scene names, as written: its table and its records.
pub fn named_paths(scene: &mut Scene) -> Vec<&mut String> {
    let table = match &mut scene.mechanism {
        Mechanism::Table { path, .. } => Some(path),
        _ => None,
    };
    table.into_iter().chain(record::paths_mut(&mut scene.excitation)).collect()
}

/// Replaces a field from its text; the error is a sentence.
fn replace(found: Field<'_>, value: &str) -> Result<(), String> {
    let refused = |error: ron::error::SpannedError| format!("`{}`: {}", clip(value), explain(&error));
    match found {
        Field::Number(_, Slot::Required(number)) => {
            *number = parse_number(value).ok_or_else(|| format!("`{}` is not a number", clip(value)))?;
            Ok(())
        }
        Field::Number(_, Slot::Optional(number)) => {
            let written = parse_number(value).map(Some).or_else(|| text::options().from_str(value).ok());
            *number = written.ok_or_else(|| format!("`{}` is neither a number nor None", clip(value)))?;
            Ok(())
        }
        Field::Number(_, Slot::Whole(number)) => {
            let whole = value.trim().parse().ok();
            *number = whole.ok_or_else(|| format!("`{}` is not a whole number from 0 up", clip(value)))?;
            Ok(())
        }
        Field::Text(text) => {
            let quoted = ["\"", "r\"", "r#"].iter().any(|first| value.starts_with(first));
            *text = if quoted { text::options().from_str(value).map_err(refused)? } else { value.to_owned() };
            Ok(())
        }
        Field::Value(whole) => whole.assign(value).map_err(refused),
    }
}

/// A number as RON writes it or as Rust does: `4`, `.5`, `1e-9`, `-inf`.
fn parse_number(text: &str) -> Option<f64> {
    text.parse().ok().or_else(|| text::options().from_str(text).ok())
}
