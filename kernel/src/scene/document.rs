//! Scene with its source text, so that every message about it names file and line.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::axis::{Axis, MAX_AXES, MAX_AXIS_VALUES, repeated, unknown};
use super::check::{check, corners};
use super::data::Scene;
use super::error::{ArgumentError, Fault, Origin, PlacedFault, SceneError, clip};
use super::fields::{FieldPath, all_fields, replace};
use super::files::{Files, ReadError, read_from, read_text};
use super::link::is_link;
use super::manifest::{self, SweepRequest};
use super::presets::{self, PRESETS};
use super::record;
use super::scanner::{Place, Places};
use super::text::{self, MAX_SCENE_BYTES};
use super::written::{Written, covers};
use crate::numeric::number_text;
use crate::system::files;

/// Largest number of faults that an error lists; further ones are counted. A list may contain a million NaN.
const MAX_FAULTS: usize = 50;

/// Largest number of values of all axes of a sweep together. Three axes with more values make more cells than
/// a sweep may have, even if no axis is too long, and are rejected before all are expanded.
const MAX_VALUES: usize = 2 * MAX_AXIS_VALUES;

/// Name in messages of a scene from standard input.
const STANDARD_INPUT: &str = "standard input";

/// Where a scene came from. [`Document::link`] writes a built-in scene by its name and changes, any other one
/// with its text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// The built-in scene of this name.
    BuiltIn(&'static str),
    /// A scene file.
    File(PathBuf),
    /// A text that is no file, as one from standard input.
    Text,
}

/// A scene with its text and the arguments that have changed it.
///
/// It is what is read from a file, a preset or a text, and what a simulation is made of. The text is kept so
/// that a fault is reported with its line, and arithmetic as it was written; comments are lost when the scene
/// is written.
///
/// [`set`](Self::set) changes a field, [`check`](Self::check) finds all faults, and
/// `questions::Simulation::new` makes the model.
///
/// ```
/// # use interwell_kernel as interwell;
/// use interwell::scene::{Document, Stops};
///
/// let mut document = Document::preset("paper")?;
/// document.set("stops=None")?;
/// document.set("excitation.amplitude_g=1.3")?;
/// assert_eq!(document.scene.stops, Stops::None);
/// assert_eq!(document.changes().count(), 2);
/// // as a file that can be read again
/// assert!(document.write(&document.scene)?.contains("amplitude_g: 1.3"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Document {
    /// The scene, with every argument applied.
    pub scene: Scene,
    /// Where it came from.
    pub source: Source,
    /// Name in messages: the path as given, or `built-in NAME`.
    pub name: String,
    /// The text that it was read from.
    pub text: String,
    /// Where the files that it names are.
    pub files: Files,
    /// Options of its sweep, if it came from the manifest of one.
    pub swept: Option<SweepRequest>,
    /// All scenes of a comparison with their names, if it came from the manifest of one.
    pub compared: Vec<(String, Self)>,
    /// Changes by arguments; the last one of each field counts.
    assigned: Vec<Assignment>,
    /// Faults of recorded accelerations that could not be read.
    record_faults: Vec<Fault>,
    /// Numbers that were written as arithmetic.
    written: Written,
}

#[derive(Debug, Clone)]
struct Assignment {
    field: String,
    /// The argument as messages show it, such as `--tolerance 1e-6`.
    argument: String,
    /// `FIELD=VALUE`, if the argument is that of `--set`.
    change: Option<String>,
}

impl Document {
    /// The scene in an argument of a command: anything that [`load`](Self::load) takes, the manifest of
    /// rows, or `-` for a scene on standard input.
    ///
    /// # Errors
    ///
    /// Those of [`load`](Self::load); [`SceneError::Unreadable`] also for a manifest that cannot be read.
    pub fn of_argument(spec: &str) -> Result<Self, SceneError> {
        if let Some(document) = Self::without_file(spec) {
            return document;
        }
        let (name, text, files) = if spec == "-" {
            let unreadable = |problem| SceneError::Unreadable { name: STANDARD_INPUT.to_owned(), problem };
            let text = read_from(std::io::stdin(), manifest::MAX_BYTES).map_err(unreadable)?;
            (STANDARD_INPUT.to_owned(), text, Files::beside(Path::new("")))
        } else {
            (clip(spec), read_scene(spec, manifest::MAX_BYTES)?, Files::beside(Path::new(spec)))
        };
        if text::is_json(&text) {
            manifest::read(&name, &text, files)
        } else {
            Self::from_text(&name, &text, files)
        }
    }

    /// Reads a scene file, the built-in scene of that name, or the scene of a link. A path such as `./paper`
    /// is always a file.
    ///
    /// # Errors
    ///
    /// [`SceneError::NoSuchScene`] if there is neither a file nor a built-in scene of that name,
    /// [`SceneError::Unreadable`] for a file that is no text or too large, [`SceneError::Structure`] for a
    /// text that is no scene. Values out of their range are found by [`check`](Self::check).
    pub fn load(spec: &str) -> Result<Self, SceneError> {
        Self::without_file(spec).unwrap_or_else(|| Self::from_file(Path::new(spec)))
    }

    /// The scene of a link, or the built-in scene of that name; `None` if it can only be a file.
    fn without_file(spec: &str) -> Option<Result<Self, SceneError>> {
        if is_link(spec) { Some(Self::from_link(spec)) } else { Self::built_in(spec) }
    }

    /// Reads a scene file. Errors: those of [`load`](Self::load).
    pub fn from_file(path: &Path) -> Result<Self, SceneError> {
        let spec = path.display().to_string();
        let text = read_scene(&spec, MAX_SCENE_BYTES)?;
        let read = Self::from_text(&clip(&spec), &text, Files::beside(path))?;
        Ok(Self { source: Source::File(path.to_owned()), ..read })
    }

    /// Reads the built-in scene of that name. Error: [`SceneError::NoSuchScene`], with the names that there
    /// are.
    pub fn preset(name: &str) -> Result<Self, SceneError> {
        Self::built_in(name).unwrap_or_else(|| Err(no_such_scene(name)))
    }

    /// The built-in scene of that name. The inner result is an error only if the program was built with an
    /// invalid preset, which tests exclude.
    fn built_in(name: &str) -> Option<Result<Self, SceneError>> {
        let preset = PRESETS.iter().find(|preset| preset.name == name)?;
        let read = Self::from_text(&format!("built-in {name}"), preset.text, Files::default());
        Some(read.map(|read| Self { source: Source::BuiltIn(preset.name), ..read }))
    }

    /// Parses a scene; `name` is its name in messages. Ranges are not checked until [`check`](Self::check),
    /// so that an argument can still correct a value.
    ///
    /// # Errors
    ///
    /// [`SceneError::Structure`] with line and column, and further errors of the text as far as they are
    /// found.
    pub fn from_text(name: &str, text: &str, files: Files) -> Result<Self, SceneError> {
        let mut scene = match text::parse(text) {
            Ok(scene) => scene,
            Err(parse_error) => {
                let rest =
                    |text: &str| Self::from_text(name, text, files.clone()).and_then(|d| d.check()).err();
                return Err(structure_error(name, text, parse_error, |text| text::parse(text).err(), rest));
            }
        };
        if scene.title.is_empty() && Places::of(text).find("title").is_none() {
            let stem = Path::new(name).file_stem().unwrap_or_default();
            scene.title = stem.to_string_lossy().into_owned();
        }
        let record_faults = record::attach(&mut scene.excitation, "excitation", &files);
        let mut written = Written::default();
        written.update("", text.trim_start_matches('\u{feff}'));
        let (name, text) = (name.to_owned(), text.to_owned());
        Ok(Self { name, text, record_faults, written, ..Self::of_scene(scene, files) })
    }

    /// The document of a scene without a text, such as one that a window changes. Messages call it `the
    /// scene`.
    pub fn of_scene(scene: Scene, files: Files) -> Self {
        let (source, name, text) = (Source::Text, "the scene".to_owned(), String::new());
        let (swept, compared, assigned) = (None, Vec::new(), Vec::new());
        let (record_faults, written) = (Vec::new(), Written::default());
        Self { scene, source, name, text, files, swept, compared, assigned, record_faults, written }
    }

    /// The text of `scene`, this one or one made from it. A number that this scene has as arithmetic is
    /// written as it was, unless `scene` has another value in its place.
    pub fn write(&self, scene: &Scene) -> Result<String, ron::Error> {
        Ok(self.written.restored("", text::write(scene)?))
    }

    /// `FIELD=VALUE` with the arithmetic that the field was written as, if it has this value still.
    pub(super) fn written(&self, change: String) -> String {
        match change.split_once('=') {
            Some((field, value)) => format!("{field}={}", self.written.restored(field, value.to_owned())),
            None => change,
        }
    }

    /// Applies `FIELD=VALUE` as given to `--set`: a number, arithmetic, or any value in RON
    /// (`stops=Rigid(travel_limit_mm: 4, restitution: 0.36)`, `run.settle_s=None`). The quotes of a text may
    /// be left out.
    ///
    /// # Errors
    ///
    /// For a field that the scene does not have, with the names that there are, and for a value that does not
    /// parse; the scene is then unchanged. The range is checked by [`check`](Self::check).
    pub fn set(&mut self, argument: &str) -> Result<(), ArgumentError> {
        let shown = format!("--set {argument}");
        let Some((field, value)) = argument.split_once('=') else {
            let problem = "write FIELD=VALUE, such as stops.travel_limit_mm=1.5".to_owned();
            return Err(ArgumentError { argument: clip(&shown), problem });
        };
        self.assign(field.trim(), value.trim(), &shown)?;
        if let Some(assigned) = self.assigned.last_mut() {
            assigned.change = Some(argument.to_owned());
        }
        Ok(())
    }

    /// Assigns a value to a field; errors about it name `argument`, such as `--tolerance 1e-6`. The scene is
    /// unchanged after an error. Ranges are not checked until [`check`](Self::check).
    pub fn assign(&mut self, field: &str, value: &str, argument: &str) -> Result<(), ArgumentError> {
        let error = |problem| Err(ArgumentError { argument: clip(argument), problem });
        if value.len() > MAX_SCENE_BYTES {
            return error("the value is longer than a scene may be".to_owned());
        }
        let is_excitation = field.starts_with("excitation");
        match FieldPath::new(field).at(&mut self.scene).map(|found| replace(found, value)) {
            Some(Ok(())) => {
                let (field, argument) = (field.to_owned(), clip(argument));
                self.written.update(&field, value);
                self.assigned.push(Assignment { field, argument, change: None });
                if is_excitation {
                    self.record_faults =
                        record::attach(&mut self.scene.excitation, "excitation", &self.files);
                }
                Ok(())
            }
            Some(Err(problem)) => error(problem),
            None => error(unknown("field", field, &all_fields(&self.scene))),
        }
    }

    /// The files that the scene names (its table and its records), as written.
    pub(super) fn paths(&self) -> Vec<String> {
        paths(&self.scene)
    }

    /// The changes by `--set` arguments, as `FIELD=VALUE`; only the last one of each field.
    pub fn changes(&self) -> impl Iterator<Item = &str> {
        let is_last =
            |i: usize| self.assigned[i + 1..].iter().all(|later| later.field != self.assigned[i].field);
        let last = self.assigned.iter().enumerate().filter(move |(i, _)| is_last(*i));
        last.filter_map(|(_, assigned)| assigned.change.as_deref())
    }

    /// Removes a settle time in the scene's text that exceeds a duration set by an argument, so that it
    /// becomes half of that duration. Returns a message about this, or `None` if nothing changed.
    pub fn settle_within(&mut self) -> Option<String> {
        let run = &mut self.scene.run;
        let (settle, duration) = (run.settle_s?, run.duration_s);
        let given = |field: &str| self.assigned.iter().find(|assigned| assigned.field == field);
        let duration_given = given("run.duration_s");
        let argument = &duration_given.filter(|_| given("run.settle_s").or(given("run")).is_none())?.argument;
        if !(settle > duration && duration > 0.0) {
            return None;
        }
        run.settle_s = None;
        Some(format!(
            "{}: run.settle_s = {} lies beyond {argument}: the settled window begins at {} s, half of that",
            self.name,
            number_text(settle),
            number_text(0.5 * duration)
        ))
    }

    /// The paths of the files that the scene names.
    pub fn named_files(&self) -> Vec<PathBuf> {
        self.paths().iter().filter_map(|path| self.files.place(path)).collect()
    }

    /// Reads the files that the scene names into memory, so that later changes of the files have no effect;
    /// this replaces all texts read before. A file that cannot be read is skipped: the code that needs it
    /// reports the error.
    pub fn cache_files(&mut self) {
        let read = |path: String| self.files.read(&path).ok().map(|text| (path, text));
        self.files.cached = self.paths().into_iter().filter_map(read).collect();
    }

    /// Checks the scene. Returns the warnings, each with the file's name, or one error with all faults.
    pub fn check(&self) -> Result<Vec<String>, SceneError> {
        let mut checked = check(&self.scene);
        if !self.assigned.is_empty() && self.argument_for("sweep").is_none() {
            // `--set stops=None` removes the field that the scene's sweep runs over. This does not matter to
            // a single run; `axes` reports it if the sweep is used.
            let sweep_field = |field: &str| field.starts_with("sweep.") && field.ends_with(".field");
            checked.faults.retain(|fault| !sweep_field(&fault.field));
        }
        checked.faults.extend(self.record_faults.iter().cloned());
        if checked.faults.is_empty() {
            let duration = self.scene.run.duration_s;
            checked.warnings.extend(record::warnings(&self.scene.excitation, duration));
            Ok(checked.warnings.iter().map(|warning| format!("{}: {warning}", self.name)).collect())
        } else {
            Err(self.error_from(checked.faults))
        }
    }

    /// The axes of a sweep of this scene: the given `--over` arguments or, without any, the `sweep` of the
    /// scene, which may be empty. Every value is within its field's range, no field is swept twice, and the
    /// relations between fields hold on the whole grid.
    ///
    /// # Errors
    ///
    /// [`SceneError::Argument`] for a field or values that are wrong, [`SceneError::Faults`] for cells that
    /// are no valid scene.
    pub fn axes<S: AsRef<str>>(&self, over: &[S]) -> Result<Vec<Axis>, SceneError> {
        // Checked before any axis is expanded: a hundred long axes would fill the memory.
        if over.len() > MAX_AXES {
            let problem = format!("{} axes are more than a sweep may have ({MAX_AXES})", over.len());
            return Err(ArgumentError { argument: "--over".to_owned(), problem }.into());
        }
        let mut values = 0;
        let mut counted = |axis: Axis, argument: String| -> Result<Axis, SceneError> {
            values += axis.values.len();
            if values <= MAX_VALUES {
                return Ok(axis);
            }
            let problem = format!(
                "{values} values, with the axes before it, are more than a sweep may have ({MAX_VALUES}); \
                 give larger steps"
            );
            Err(ArgumentError { argument, problem }.into())
        };
        let axes: Vec<Axis> = if over.is_empty() {
            // The check gives more detail than `from_scene`.
            let check_error = || self.error_from(check(&self.scene).faults);
            if self.scene.sweep.len() > MAX_AXES {
                return Err(check_error());
            }
            let axes = self.scene.sweep.iter().map(|axis| {
                let axis = Axis::from_scene(axis, &self.scene).map_err(|_| check_error())?;
                counted(axis, "sweep".to_owned())
            });
            axes.collect::<Result<_, SceneError>>()?
        } else {
            let axes = over.iter().map(|over| {
                let argument = clip(&format!("--over {}", over.as_ref()));
                match Axis::parse(over.as_ref(), &self.scene) {
                    Ok(axis) => counted(axis, argument),
                    Err(problem) => Err(ArgumentError { argument, problem }.into()),
                }
            });
            axes.collect::<Result<_, SceneError>>()?
        };
        self.check_axes(axes, if over.is_empty() { "sweep" } else { "--over" })
    }

    /// These axes, if no field is swept twice and the relations between fields hold on the whole grid; errors
    /// name `argument`.
    pub fn check_axes(&self, axes: Vec<Axis>, argument: &str) -> Result<Vec<Axis>, SceneError> {
        if let Some(field) = repeated(axes.iter().map(|axis| axis.field.as_str())) {
            let problem = format!("{field} is swept twice; give each field one axis");
            return Err(ArgumentError { argument: argument.to_owned(), problem }.into());
        }
        let faults = corners(&self.scene, &axes);
        if faults.is_empty() { Ok(axes) } else { Err(self.error_from(faults)) }
    }

    /// Adds to faults from any check the place where their value was written.
    pub fn error_from(&self, faults: Vec<Fault>) -> SceneError {
        let places = Places::of(self.text.strip_prefix('\u{feff}').unwrap_or(&self.text));
        let place = |mut fault: Fault| {
            if let Some(shown) = self.written.shown(&fault.field, &fault.value) {
                fault.value = shown;
            }
            let origin = match self.argument_for(&fault.field) {
                Some(argument) => Origin::Argument(argument.to_owned()),
                None => places.find(&fault.field).map_or(Origin::Unwritten, Origin::Text),
            };
            PlacedFault { fault, origin }
        };
        let more = faults.len().saturating_sub(MAX_FAULTS);
        let faults = faults.into_iter().take(MAX_FAULTS).map(place).collect();
        SceneError::Faults { name: self.name.clone(), faults, more }
    }

    /// The last argument that set this field or a field around it; if there is none, the last argument that
    /// set a field inside it.
    fn argument_for(&self, field: &str) -> Option<&str> {
        let written = self.assigned.iter().rev();
        written
            .clone()
            .find(|assigned| covers(&assigned.field, field))
            .or_else(|| written.clone().find(|assigned| covers(field, &assigned.field)))
            .map(|assigned| assigned.argument.as_str())
    }
}

/// The text of the file at `spec`, of at most `largest` bytes.
fn read_scene(spec: &str, largest: usize) -> Result<String, SceneError> {
    read_text(Path::new(spec), largest).map_err(|error| match error {
        ReadError::Missing => no_such_scene(spec),
        ReadError::Unusable(problem) => SceneError::Unreadable { name: clip(spec), problem },
    })
}

fn no_such_scene(spec: &str) -> SceneError {
    let spec = if spec.is_empty() { "\"\"".to_owned() } else { clip(spec) };
    SceneError::NoSuchScene { spec, presets: presets::names() }
}

/// The error for a text that does not parse. Unknown field names are removed one by one and the text
/// is parsed again, so that the error also has further unknown names and the error of `rest` about the
/// remaining text.
pub(super) fn structure_error<E: ToString>(
    name: &str,
    text: &str,
    mut parse_error: text::ParseError,
    parse: impl Fn(&str) -> Option<text::ParseError>,
    rest: impl Fn(&str) -> Option<E>,
) -> SceneError {
    /// Largest number of unknown names that are removed.
    const MAX_UNKNOWN: usize = 20;
    let message = |place: Place, problem: &str| format!("{name}:{}:{}: {problem}", place.line, place.column);
    let lines = |error: &E| error.to_string().lines().map(str::to_owned).collect::<Vec<_>>();
    let (place, problem) = (parse_error.place, parse_error.problem.clone());
    let arithmetic = |parse_error: &text::ParseError| -> Vec<String> {
        parse_error.wrong.iter().map(|(place, problem)| message(*place, problem)).collect()
    };
    let mut more: Vec<String> = arithmetic(&parse_error).into_iter().skip(1).collect();
    let mut text = text.strip_prefix('\u{feff}').unwrap_or(text).to_owned();
    while let Some(without) = parse_error.without_unknown(&text).filter(|_| more.len() < MAX_UNKNOWN) {
        text = without;
        match parse(&text) {
            // The missing field may be the one that the unknown name stands for.
            Some(next) if next.unknown.is_none() => {
                more.extend(arithmetic(&next));
                break;
            }
            Some(next) => {
                more.push(message(next.place, &next.problem));
                parse_error = next;
            }
            None => {
                more.extend(rest(&text).iter().flat_map(lines));
                break;
            }
        }
    }
    more.truncate(MAX_FAULTS);
    SceneError::Structure { name: name.to_owned(), place, problem, more }
}

/// The paths of the files that a scene names, as written: its table and its records.
#[doc(hidden)]
pub fn named_paths(scene: &mut Scene) -> Vec<&mut String> {
    scene.mechanism.paths_mut().into_iter().chain(record::paths_mut(&mut scene.excitation)).collect()
}

/// The same, to be read.
fn paths(scene: &Scene) -> Vec<String> {
    let (mut mechanism, mut excitation) = (scene.mechanism.clone(), scene.excitation.clone());
    let paths = mechanism.paths_mut().into_iter().chain(record::paths_mut(&mut excitation));
    paths.map(|path| path.clone()).collect()
}

/// Whether the file at `path` is a scene: its name ends in `.ron`, or its text parses as a scene.
#[doc(hidden)]
pub fn is_scene_file(path: &Path) -> bool {
    let named = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ron"));
    files::is_file(path)
        && (named || read_text(path, MAX_SCENE_BYTES).is_ok_and(|text| text::parse(&text).is_ok()))
}

/// The texts of the files that a scene names, by their paths in it, as far as they can be read.
#[doc(hidden)]
pub fn named_texts(scene: &Scene, files: &Files) -> BTreeMap<String, String> {
    paths(scene).into_iter().filter_map(|path| files.read(&path).ok().map(|text| (path, text))).collect()
}

/// Reads the records that a scene names. One that cannot be read is missing.
#[doc(hidden)]
pub fn read_records(scene: &mut Scene, files: &Files) {
    record::attach(&mut scene.excitation, "excitation", files);
}
