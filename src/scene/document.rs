//! Scene together with its source, so that every message about it names file and line.

use std::path::{Path, PathBuf};

use super::assign::replace;
use super::axis::{Axis, LARGEST_AXIS, MOST_AXES, repeated, unknown};
use super::check::{check, corners};
use super::clip::clip;
use super::data::Scene;
use super::error::{ArgumentError, Fault, Origin, PlacedFault, SceneError};
use super::fields::{FieldPath, all_fields};
use super::files::{Files, ReadError, read_from, read_text};
use super::locate::Places;
use super::manifest::{self, Swept};
use super::presets::{self, PRESETS};
use super::ranges::number_text;
use super::record;
use super::text::{self, LARGEST_SCENE};
use crate::system::files;

/// How many faults an error names; the rest it counts. A list may hold a million NaN.
const MOST_FAULTS: usize = 50;

/// The most values that the axes of a sweep may have together. Three axes that pass it, of which none alone
/// is too long, make more cells than any sweep may have; they are refused before they are all written out.
const MOST_VALUES: usize = 2 * LARGEST_AXIS;

/// How messages call a scene that came through a pipe.
const STANDARD_INPUT: &str = "standard input";

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
    /// How its sweep was asked for, where it came from a manifest.
    pub swept: Option<Swept>,
    /// Fields that an argument changed, with that argument; the last one counts.
    assigned: Vec<(String, String)>,
    /// What is wrong with the records that the excitation names.
    unread: Vec<Fault>,
}

impl Document {
    /// What a command is given as its scene: what [`load`](Self::load) takes, the manifest of a sweep, or `-`
    /// for the text of a scene on standard input.
    pub fn of_argument(spec: &str) -> Result<Self, SceneError> {
        if let Some(document) = Self::preset(spec) {
            return document;
        }
        let (name, text, files) = if spec == "-" {
            let unreadable = |problem| SceneError::Unreadable { name: STANDARD_INPUT.to_owned(), problem };
            let text = read_from(std::io::stdin(), manifest::LARGEST).map_err(unreadable)?;
            (STANDARD_INPUT.to_owned(), text, Files::beside(Path::new("")))
        } else {
            (clip(spec), read_scene(spec, manifest::LARGEST)?, Files::beside(Path::new(spec)))
        };
        if text::is_json(&text) {
            manifest::read(&name, &text, files)
        } else {
            Self::from_text(&name, &text, files)
        }
    }

    /// Reads a scene file, or the built-in scene of that name. A file that is called like a built-in
    /// scene is reached by `./paper`.
    pub fn load(spec: &str) -> Result<Self, SceneError> {
        if let Some(document) = Self::preset(spec) {
            return document;
        }
        let read =
            Self::from_text(&clip(spec), &read_scene(spec, LARGEST_SCENE)?, Files::beside(Path::new(spec)))?;
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
        let mut scene = match text::parse(text) {
            Ok(scene) => scene,
            Err(refusal) => return Err(refused(name, text, refusal, files)),
        };
        if scene.title.is_empty() && Places::of(text).find("title").is_none() {
            let stem = Path::new(name).file_stem().unwrap_or_default();
            scene.title = stem.to_string_lossy().into_owned();
        }
        let unread = record::attach(&mut scene.excitation, "excitation", &files);
        let (name, text) = (name.to_owned(), text.to_owned());
        Ok(Self { scene, source: Source::Text, name, text, files, swept: None, assigned: Vec::new(), unread })
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

    /// The files that the scene names, as it names them: its table and its records.
    fn paths(&self) -> Vec<String> {
        named_paths(&mut self.scene.clone()).into_iter().map(|path| path.clone()).collect()
    }

    /// What `--set` arguments changed, `FIELD=VALUE` each; of several for one field the last one.
    pub fn changes(&self) -> impl Iterator<Item = &str> {
        let later = |i: usize, field: &str| self.assigned[i + 1..].iter().any(|(own, _)| own == field);
        let last = self.assigned.iter().enumerate().filter(move |(i, (field, _))| !later(*i, field));
        last.filter_map(|(_, (_, argument))| argument.strip_prefix("--set "))
    }

    /// Leaves out a settle time of the scene's text that lies beyond a duration which an argument set: it is
    /// then half of that duration. What is to be said of it.
    pub fn settle_within(&mut self) -> Option<String> {
        let run = &mut self.scene.run;
        let (settle, duration) = (run.settle_s?, run.duration_s);
        let given = |field: &str| self.assigned.iter().find(|(own, _)| own == field);
        let (_, argument) =
            given("run.duration_s").filter(|_| given("run.settle_s").or(given("run")).is_none())?;
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

    /// Where the files lie that the scene names.
    pub fn named_files(&self) -> Vec<PathBuf> {
        self.paths().iter().filter_map(|path| self.files.place(path)).collect()
    }

    /// Reads the files that the scene names, so that they are at hand whatever becomes of them; none but
    /// those are held. One that cannot be read is left to whoever needs it, and has a better place to say so.
    pub fn hold_files(&mut self) {
        let read = |path: String| self.files.read(&path).ok().map(|text| (path, text));
        self.files.held = self.paths().into_iter().filter_map(read).collect();
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
                    "{values} values, with the axes before it, are more than a sweep may have \
                     ({MOST_VALUES}); give larger steps"
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

/// The text of the file at `spec`, of at most `largest` bytes.
fn read_scene(spec: &str, largest: usize) -> Result<String, SceneError> {
    read_text(Path::new(spec), largest).map_err(|error| match error {
        ReadError::Missing => {
            let spec = if spec.is_empty() { "\"\"".to_owned() } else { clip(spec) };
            SceneError::NoSuchScene { spec, presets: presets::names() }
        }
        ReadError::Unusable(problem) => SceneError::Unreadable { name: clip(spec), problem },
    })
}

/// The error of a text that is no scene.
fn refused(name: &str, text: &str, refusal: text::Refusal, files: Files) -> SceneError {
    let rest = |text: &str| {
        let checked = Document::from_text(name, text, files.clone()).and_then(|document| document.check());
        checked.err().map(|error| error.to_string()).unwrap_or_default()
    };
    unreadable(name, text, refusal, |text| text::parse(text).err(), rest)
}

/// The error of a text that a parser refuses. A name that nothing knows is taken out, so that others, and
/// what `rest` has to say of the text without them, are said with it.
pub(super) fn unreadable(
    name: &str,
    text: &str,
    mut refusal: text::Refusal,
    parse: impl Fn(&str) -> Option<text::Refusal>,
    rest: impl Fn(&str) -> String,
) -> SceneError {
    /// How many names are taken out.
    const MOST_UNKNOWN: usize = 20;
    let said = |refusal: &text::Refusal| {
        let text::Refusal { place, problem, .. } = refusal;
        format!("{name}:{}:{}: {problem}", place.line, place.column)
    };
    let (place, problem) = (refusal.place, refusal.problem.clone());
    let (mut more, mut text) = (Vec::new(), text.strip_prefix('\u{feff}').unwrap_or(text).to_owned());
    while let Some(without) = refusal.without_unknown(&text).filter(|_| more.len() < MOST_UNKNOWN) {
        text = without;
        match parse(&text) {
            // What is missing now may be what the unknown name was meant to be.
            Some(next) if next.unknown.is_none() => break,
            Some(next) => {
                more.push(said(&next));
                refusal = next;
            }
            None => {
                more.extend(rest(&text).lines().map(str::to_owned));
                break;
            }
        }
    }
    more.truncate(MOST_FAULTS);
    SceneError::Structure { name: name.to_owned(), place, problem, more }
}

/// The paths of the files that a scene names, as written: its table and its records.
pub fn named_paths(scene: &mut Scene) -> Vec<&mut String> {
    scene.mechanism.paths_mut().into_iter().chain(record::paths_mut(&mut scene.excitation)).collect()
}

/// Whether there is a scene at `path`: a file whose name ends in `.ron`, mistaken or not, or whose text is
/// one.
pub fn is_scene_file(path: &Path) -> bool {
    let named = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ron"));
    files::is_file(path)
        && (named || read_text(path, LARGEST_SCENE).is_ok_and(|text| text::parse(&text).is_ok()))
}
