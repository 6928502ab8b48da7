//! Figures of the views, each with the command line that draws the same figure without a window.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use anyhow::{Result, anyhow};
use serde::{Deserialize, Serialize};

use crate::app::session::Session;
use crate::app::session::editor::keep_start_inside;
use crate::app::session::explore::{STARTS, WalkQuantity};
use crate::app::session::map::{LOAD_POWER, NO_FIELDS, ground, over};
use crate::app::session::measured::{Overlay, file_name};
use crate::app::task::{Each, Question, as_text};
use crate::dynamics::STANDARD_GRAVITY;
use crate::numeric::{elementary, short};
use crate::output::{
    Argument, Cut, Figure, Format, RMS, RunPanel, Sheet, Sink, View, csv, picture_arguments, words_of,
};
use crate::questions::{Scheme, Signal, longest_wait};
use crate::scene::{FieldPath, Scene, Start, SweepAxis, arguments};
use crate::system::files;

use super::drawing::draw;
use super::{WriteResult, line};

/// What a figure shows, with the options of its command.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Subject {
    /// Panels of a run, over a range of times in s or over all times.
    Run(Option<(f64, f64)>, Vec<RunPanel>),
    /// Force and potential of the mechanism.
    Curve,
    /// The mechanism with the mass at a displacement in mm.
    Mechanism(f64),
    /// The potential with the mass at a displacement in mm, tipped by the push of the base at an acceleration
    /// in g.
    Well(f64, f64),
    /// Error over processor time, and the run by a method of fixed step in s, if one suits the scene.
    Accuracy(Option<(Scheme, f64)>),
    /// A record over the run or over the force curve.
    Measured(Overlay),
    /// A quantity over two fields, or over one that is walked up and down.
    Sweep(Vec<SweepAxis>, String, View),
    /// Stroboscopic displacements over a field that is walked up and down.
    Diagram(SweepAxis),
    /// Stroboscopic states of one run.
    Section,
    /// The attractor of each start, for ranges of displacements in mm and of velocities in m/s.
    Basins((f64, f64), (f64, f64)),
    /// This scene and another, given as a link, under its sine.
    Compare(String),
    /// Amplitude spectrum of a signal, and how long in s to wait for the motion to repeat.
    Spectrum(Signal, Option<f64>),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FigureOrder {
    /// The scene's name on the command line.
    pub(super) origin: String,
    /// Changes of that scene, as values of `--set`.
    pub(super) settings: Vec<String>,
    /// The changed scene, with the first value of each swept field.
    #[serde(with = "as_text")]
    pub(super) scene: Scene,
    #[serde(with = "as_text")]
    pub(super) subject: Subject,
    pub(super) place: Place,
    read: ReadFiles,
}

/// Files that are read for a figure. In a message they have their bytes, and a worker of a page, which has no
/// files, keeps them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<(PathBuf, Vec<u8>)>", into = "Vec<(PathBuf, Vec<u8>)>")]
struct ReadFiles(Vec<PathBuf>);

impl From<ReadFiles> for Vec<(PathBuf, Vec<u8>)> {
    fn from(ReadFiles(paths): ReadFiles) -> Self {
        paths.into_iter().filter_map(|path| Some((path.clone(), files::bytes(&path).ok()?))).collect()
    }
}

impl From<Vec<(PathBuf, Vec<u8>)>> for ReadFiles {
    fn from(read: Vec<(PathBuf, Vec<u8>)>) -> Self {
        read.iter().for_each(|(path, bytes)| files::keep_written(path, bytes));
        Self(read.into_iter().map(|file| file.0).collect())
    }
}

impl Question for FigureOrder {
    const NAME: &'static str = "figure";
    type Part = WriteResult;

    fn answer(&self, cancel: &AtomicBool, _: Each<WriteResult>) -> Option<WriteResult> {
        self.save(cancel).map_err(|error| error.to_string()).transpose()
    }
}

/// Output files and layout of a figure, already checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Place {
    pub path: PathBuf,
    pub format: Format,
    pub sheet: Sheet,
    /// The file for the plotted numbers, if wanted.
    pub data: Option<PathBuf>,
}

const NOT_SEEN: &str = "Show this view first: the figure takes its ranges.";

impl Subject {
    pub fn walks(session: &Session) -> Result<Self, String> {
        let axis = session.walk_question()?.axis;
        let quantity = match session.explore.walks.quantity {
            WalkQuantity::Strobes => return Ok(Self::Diagram(axis)),
            WalkQuantity::LoadPower if session.model().has_transducer() => LOAD_POWER,
            WalkQuantity::RmsVelocity | WalkQuantity::LoadPower => RMS,
        };
        Ok(Self::Sweep(vec![axis], quantity.to_owned(), View::Top))
    }

    /// The map as a surface, or with cuts through the scene's place.
    pub fn map(session: &Session, surface: bool, cuts: bool) -> Result<Self, String> {
        let axes = session.map_axes().ok_or(NO_FIELDS)?.to_vec();
        let quantity = session.map.quantity().name;
        let view = match surface && words_of(quantity).is_none() {
            true => View::Surface,
            false if cuts => {
                let map = session.map.map().filter(|map| map.question.axes == axes[..]);
                let map = map.ok_or("The cuts are known as soon as the map is begun: show it first.")?;
                View::Cuts(map.cuts(session.scene()))
            }
            false => View::Top,
        };
        Ok(Self::Sweep(axes, quantity.to_owned(), view))
    }

    /// The mechanism with the mass at `x` in m.
    pub fn mechanism(x: f64) -> Self {
        Self::Mechanism(tenths_of_um(x))
    }

    /// The potential with the mass at `x` in m and the base's acceleration in m/s^2.
    pub fn well(x: f64, base_accel: f64) -> Self {
        Self::Well(tenths_of_um(x), (base_accel / STANDARD_GRAVITY * 1e4).round() / 1e4)
    }

    pub fn accuracy(session: &Session) -> Self {
        let (model, accuracy) = (session.model(), &session.accuracy);
        let is_stepped = model.compliant().is_none() && !model.has_electrical_state();
        Self::Accuracy(is_stepped.then_some((accuracy.scheme, accuracy.step)))
    }

    /// The record with its shift, scale and offset in the view.
    pub fn measured(session: &Session) -> Result<Self, String> {
        let none = "There is no measured record: open one first (Ctrl+M).";
        Ok(Self::Measured(session.measured.over.clone().ok_or(none)?))
    }

    /// The scene beside the reference.
    pub fn compare(session: &Session) -> Result<Self, String> {
        let reference = &session.reference.scene;
        if **reference == *session.scene() {
            return Err("There is no other scene yet: change something.".to_owned());
        }
        Ok(Self::Compare(link(session, reference)?))
    }

    pub fn basins(session: &Session) -> Result<Self, String> {
        let question = session.explore.basins.question().ok_or(NOT_SEEN)?;
        Ok(Self::Basins(question.x_mm, question.v))
    }

    pub fn spectrum(session: &Session) -> Self {
        Self::Spectrum(session.explore.spectra.signal, longest_wait(session.model()))
    }

    pub(super) fn axes(&self) -> &[SweepAxis] {
        match self {
            Self::Sweep(axes, ..) => axes,
            Self::Diagram(axis) => std::slice::from_ref(axis),
            _ => &[],
        }
    }

    /// Whether each run continues from the end of the one before.
    pub(super) fn is_walked(&self) -> bool {
        self.axes().len() == 1
    }

    /// The command, its options before those of the plot, and those after, in the order of `--help`.
    fn command(&self) -> (&'static str, Vec<Argument>, Vec<Argument>) {
        let mut options: Vec<Argument> =
            self.axes().iter().map(|axis| Argument::of("over", over(axis))).collect();
        if self.is_walked() {
            options.push(Argument::of("carry", "both"));
        }
        let mut ranges = Vec::new();
        let name = match self {
            Self::Run(times, panels) => {
                if *panels != RunPanel::USUAL {
                    options.extend(panels.iter().map(|panel| Argument::of("panels", panel.name())));
                }
                ranges.extend(times.map(|(from, to)| Argument::of("plot-x", format!("{from}:{to}"))));
                "simulate"
            }
            Self::Curve => "curve",
            Self::Well(mm, accel_g) => {
                options.push(Argument::of("at-mm", mm.to_string()));
                options.push(Argument::of("base-accel-g", accel_g.to_string()));
                "curve"
            }
            Self::Mechanism(mm) => {
                options.push(Argument::of("at-mm", mm.to_string()));
                "curve"
            }
            Self::Accuracy(stepped) => {
                options.extend(stepped.map(|(_, step)| Argument::of("step-s", step.to_string())));
                options.extend(stepped.map(|(scheme, _)| Argument::of("method", scheme.word())));
                "accuracy"
            }
            Self::Measured(over) => {
                options.extend(over.arguments());
                if over.is_force() { "curve" } else { "simulate" }
            }
            Self::Sweep(_, quantity, view) => {
                options.push(Argument::of("quantity", quantity));
                let of = |cut: &Cut| Argument::of("cut", format!("{}={}", cut.column, cut.value));
                match view {
                    View::Top => {}
                    View::Surface => options.push(Argument::switch("surface")),
                    View::Cuts(cuts) => options.extend(cuts.iter().map(of)),
                }
                "sweep"
            }
            Self::Diagram(_) | Self::Section => "section",
            Self::Compare(other) => {
                options.push(Argument { option: None, value: Some(other.clone()) });
                "compare"
            }
            Self::Basins(x_mm, v) => {
                let even = |(from, to): (f64, f64)| format!("{from}:{to}:{STARTS}");
                options.extend([Argument::of("x-mm", even(*x_mm)), Argument::of("v", even(*v))]);
                "basins"
            }
            Self::Spectrum(signal, until) => {
                options.push(Argument::of("of", signal.name()));
                options.extend(until.map(|until| Argument::of("until-settled", until.to_string())));
                "spectrum"
            }
        };
        (name, options, ranges)
    }

    /// The scene that the command begins with, and the scene that the figure shows, both with the first value
    /// of each swept field.
    fn scenes(&self, session: &Session) -> (Scene, Scene) {
        let editor = &session.editor;
        let (mut from, mut scene) = (editor.named().clone(), editor.scene().clone());
        keep_start_inside(&mut scene);
        match self {
            Self::Run(Some((_, to)), _) => {
                scene.run.duration_s = scene.run.duration_s.max(*to);
            }
            // the figure sets the starts
            Self::Basins(..) => (scene.start, from.start) = (Start::Rest, Start::Rest),
            _ if !self.axes().is_empty() => {
                scene = ground(&scene, session.remembered_stops, self.axes());
            }
            _ => {}
        }
        for axis in self.axes() {
            for target in [&mut from, &mut scene] {
                // a field that the named scene lacks is added by the settings
                let _ = FieldPath::new(&axis.field).set(target, axis.from);
            }
        }
        (from, scene)
    }
}

impl FigureOrder {
    /// The figure of `subject` in a session; the error is a sentence.
    pub fn new(session: &Session, subject: Subject, place: Place) -> Result<Self, String> {
        let no_name = "This scene has no name that a command could open: save it first (Ctrl+S).";
        let mut origin = session.editor.origin().ok_or(no_name)?;
        if let Some(fault) = session.fault() {
            return Err(fault.to_owned());
        }
        let mut read = session.editor.document().named_files();
        read.extend(session.editor.path().map(Path::to_owned));
        if let Subject::Measured(over) = &subject {
            read.push(over.record.path.clone());
        }
        let inputs: Vec<PathBuf> = read.iter().filter_map(|path| files::canonical(path)).collect();
        let is_read = |path: &&PathBuf| files::canonical(path).is_some_and(|path| inputs.contains(&path));
        if let Some(path) = place.data.iter().chain([&place.path]).find(is_read) {
            return Err(format!("{} is read by this scene: give the figure another name.", path.display()));
        }
        let (from, scene) = subject.scenes(session);
        let (mut settings, read) = (arguments(&from, &scene), ReadFiles(read));
        if let Subject::Compare(_) = subject
            && !settings.is_empty()
        {
            // --set would change all scenes of a comparison
            origin = link(session, &scene)?;
            settings.clear();
        }
        Ok(Self { origin, settings, scene, subject, place, read })
    }

    /// The command and all its arguments, in the order of `--help`.
    fn command_with_arguments(&self) -> (&'static str, Vec<Argument>) {
        let (command, options, ranges) = self.subject.command();
        let mut all = vec![Argument { option: None, value: Some(self.origin.clone()) }];
        all.extend(options);
        let Place { path, sheet, data, .. } = &self.place;
        let plot = match self.subject {
            Subject::Mechanism(..) => "mechanism-plot",
            Subject::Well(..) => "well-plot",
            _ => "plot",
        };
        all.push(Argument::of(plot, path.to_string_lossy()));
        all.push(Argument::of("plot-width-mm", sheet.width_mm.to_string()));
        all.push(Argument::of("font-pt", sheet.font_pt.to_string()));
        all.extend(data.as_ref().map(|data| Argument::of("plot-data", data.to_string_lossy())));
        all.extend((!sheet.titled).then(|| Argument::switch("no-title")));
        all.extend(ranges);
        all.push(Argument::of("out", if cfg!(windows) { "NUL" } else { "/dev/null" }));
        all.extend(self.settings.iter().map(|setting| Argument::of("set", setting)));
        (command, all)
    }

    /// The command line that makes the same file without a window.
    pub fn command_line(&self) -> String {
        let (command, all) = self.command_with_arguments();
        line(command, &all)
    }

    /// Draws the figure and writes its files. Returns a message with their names, or `None` if cancelled.
    pub fn save(&self, cancel: &AtomicBool) -> Result<Option<String>> {
        // open the files first: a path that cannot be written to is reported before the work
        let plot = Sink::open(&self.place.path)?;
        let data = self.place.data.as_deref().map(Sink::open).transpose()?;
        draw(self, cancel)?.map(|figure| self.write(figure, plot, data)).transpose()
    }

    fn write(&self, mut figure: Figure, plot: Sink, data: Option<Sink>) -> Result<String> {
        if !self.place.sheet.titled {
            figure = figure.without_title();
        }
        let (command, all) = self.command_with_arguments();
        figure.origin.insert("arguments".into(), picture_arguments(command, all).into());
        let bytes = self.place.format.bytes(&figure)?;
        let failure = |name: &str, error: std::io::Error| anyhow!("cannot write {name}: {error}");
        let mut sinks = vec![plot];
        sinks[0].put_bytes(&bytes).map_err(|error| failure(sinks[0].name(), error))?;
        if let Some(mut data) = data {
            data.put(&csv(&figure.data)).map_err(|error| failure(data.name(), error))?;
            sinks.push(data);
        }
        // flush all of them first: a full disk is noticed before any file has its final name
        for sink in &mut sinks {
            sink.flush().map_err(|error| failure(sink.name(), error))?;
        }
        let mut names = Vec::new();
        for sink in sinks {
            let name = sink.name().to_owned();
            sink.finish().map_err(|error| failure(&name, error))?;
            names.push(file_name(Path::new(&name)));
        }
        Ok(format!("Saved {}", names.join(" and ")))
    }
}

/// A displacement in m in mm, rounded to a tenth of a micrometre.
fn tenths_of_um(x: f64) -> f64 {
    (x * 1e7).round() / 1e4
}

/// A link to a scene beside the open one.
fn link(session: &Session, scene: &Scene) -> Result<String, String> {
    let mut document = session.editor.document().clone();
    document.scene = scene.clone();
    document.link().map_err(|error| error.to_string())
}

/// A suggested range of times, rounded to a thousandth of its length or finer; `None` if it is empty.
pub fn round_times((from, to): (f64, f64)) -> Option<(f64, f64)> {
    let digit = elementary::powf(10.0, elementary::log10(to - from).floor() - 3.0);
    let round = |t: f64| short((t / digit).round() * digit).parse::<f64>().unwrap_or(t);
    (from < to && digit.is_finite() && digit > 0.0).then(|| (round(from.max(0.0)), round(to)))
}
