//! Figures of what the views show, each by the command that makes it without a window.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use crate::app::session::Session;
use crate::app::session::editor::keep_start_inside;
use crate::app::session::explore::{STARTS, WalkQuantity, longest_wait};
use crate::app::session::map::{ground, over};
use crate::numeric::short;
use crate::output::{
    Argument, Figure, Format, Panel, RMS, Sheet, Sink, header, picture_arguments, rows, words_of,
};
use crate::scene::{FieldPath, Scene, Start, SweepAxis, arguments};
use crate::study::Signal;
use crate::system::files::canonical;

use super::drawing::draw;
use super::quoted;

/// What a figure shows, with everything that its command is told of it.
#[derive(Debug, Clone, PartialEq)]
pub enum Subject {
    /// Panels of a run, over these times in s or all of them.
    Run(Option<(f64, f64)>, Vec<Panel>),
    /// Force and potential of the mechanism.
    Curve,
    /// A quantity over two fields, or over one that is walked up and down; over two also as a surface.
    Sweep(Vec<SweepAxis>, &'static str, bool),
    /// Stroboscopic displacements over a field that is walked up and down.
    Diagram(SweepAxis),
    /// Stroboscopic states of one run.
    Section,
    /// The attractor of each start; ends of displacements in mm and of velocities in m/s.
    Basins((f64, f64), (f64, f64)),
    /// Amplitudes of a signal, and for how long in s the motion is waited for to repeat.
    Spectrum(Signal, Option<f64>),
}

#[derive(Debug, Clone)]
pub struct FigureOrder {
    /// What the command line calls the scene.
    pub(super) origin: String,
    /// What is changed in that scene.
    pub(super) settings: Vec<String>,
    /// What it then is, with the first values of what is swept.
    pub(super) scene: Scene,
    pub(super) subject: Subject,
    pub(super) sheet: Sheet,
    format: Format,
    /// The sheet as options.
    layout: Vec<Argument>,
    path: PathBuf,
    data: Option<PathBuf>,
}

/// Where a figure goes and how it is laid out; checked.
#[derive(Debug, Clone)]
pub struct Place {
    pub path: PathBuf,
    pub format: Format,
    pub sheet: Sheet,
    /// The file of the numbers that are drawn, where one is asked for.
    pub data: Option<PathBuf>,
}

/// Why a view that is not looked at has no figure.
const NOT_SEEN: &str = "Show this view first: the figure has its ranges.";

impl Subject {
    /// The walks over a field as the view shows them.
    pub fn walks(session: &Session) -> Result<Self, String> {
        let walks = &session.explore.walks;
        let problem = || walks.problem.clone().unwrap_or_else(|| NOT_SEEN.to_owned());
        let axis = session.walk_axis().filter(|_| walks.problem.is_none()).ok_or_else(problem)?;
        Ok(match walks.quantity {
            WalkQuantity::Strobes => Self::Diagram(axis),
            WalkQuantity::LoadPower if session.model().has_transducer() => {
                Self::Sweep(vec![axis], "mean_load_power_w", false)
            }
            WalkQuantity::RmsVelocity | WalkQuantity::LoadPower => Self::Sweep(vec![axis], RMS, false),
        })
    }

    pub fn map(session: &Session, surface: bool) -> Result<Self, String> {
        let none = || "This scene has no two fields to make a map over.".to_owned();
        let quantity = session.map.quantity().column;
        let surface = surface && words_of(quantity).is_none();
        Ok(Self::Sweep(session.map_axes().ok_or_else(none)?.to_vec(), quantity, surface))
    }

    /// The basins as the view shows them.
    pub fn basins(session: &Session) -> Result<Self, String> {
        let question = session.explore.basins.question().ok_or_else(|| NOT_SEEN.to_owned())?;
        Ok(Self::Basins(question.x_mm, question.v))
    }

    /// The spectrum of the signal that the view shows.
    pub fn spectrum(session: &Session) -> Self {
        Self::Spectrum(session.explore.spectra.signal, longest_wait(session.model()))
    }

    /// The fields that are swept.
    pub(super) fn axes(&self) -> &[SweepAxis] {
        match self {
            Self::Sweep(axes, ..) => axes,
            Self::Diagram(axis) => std::slice::from_ref(axis),
            _ => &[],
        }
    }

    /// Whether each run goes on from the one before.
    pub(super) fn is_walked(&self) -> bool {
        self.axes().len() == 1
    }

    /// The command, and its own options in the order of `--help`: those before and after the picture's.
    fn command(&self) -> (&'static str, Vec<Argument>, Vec<Argument>) {
        let mut own: Vec<Argument> =
            self.axes().iter().map(|axis| Argument::of("over", over(axis))).collect();
        if self.is_walked() {
            own.push(Argument::of("carry", "both"));
        }
        let mut ranges = Vec::new();
        let name = match self {
            Self::Run(times, panels) => {
                if panels.len() < Panel::ALL.len() {
                    own.extend(panels.iter().map(|panel| Argument::of("panels", panel.name())));
                }
                ranges.extend(times.map(|(from, to)| Argument::of("plot-x", format!("{from}:{to}"))));
                "simulate"
            }
            Self::Curve => "curve",
            Self::Sweep(_, quantity, surface) => {
                own.push(Argument::of("quantity", *quantity));
                own.extend(surface.then(|| Argument::switch("surface")));
                "sweep"
            }
            Self::Diagram(_) | Self::Section => "section",
            Self::Basins(x_mm, v) => {
                let even = |(from, to): (f64, f64)| format!("{from}:{to}:{STARTS}");
                own.extend([Argument::of("x-mm", even(*x_mm)), Argument::of("v", even(*v))]);
                "basins"
            }
            Self::Spectrum(signal, until) => {
                own.push(Argument::of("of", signal.name()));
                own.extend(until.map(|until| Argument::of("until-settled", until.to_string())));
                "spectrum"
            }
        };
        (name, own, ranges)
    }

    /// The scene of a session as the figure shows it, and the scene that the command begins with, both with
    /// the first values of what is swept.
    fn scenes(&self, session: &Session) -> (Scene, Scene) {
        let editor = &session.editor;
        let (mut from, mut scene) = (editor.named().clone(), editor.scene().clone());
        keep_start_inside(&mut scene);
        match self {
            Self::Run(Some((_, to)), _) => scene.run.duration_s = scene.run.duration_s.max(*to),
            // every start is one of the figure's
            Self::Basins(..) => (scene.start, from.start) = (Start::Rest, Start::Rest),
            _ if !self.axes().is_empty() => {
                scene = ground(&scene, session.remembered_stops(), self.axes());
            }
            _ => {}
        }
        for axis in self.axes() {
            for own in [&mut from, &mut scene] {
                // a field that the scene does not have comes with the settings
                let _ = FieldPath::new(&axis.field).set(own, axis.from);
            }
        }
        (from, scene)
    }
}

impl FigureOrder {
    /// The figure of `subject` in a session; a sentence where there can be none.
    pub fn new(session: &Session, subject: Subject, place: Place) -> Result<Self, String> {
        let nameless =
            || "This scene has no name that a command could open: save it first (Ctrl+S).".to_owned();
        let origin = session.editor.origin().ok_or_else(nameless)?;
        if let Some(fault) = session.fault() {
            return Err(fault.to_owned());
        }
        let read = session.editor.document().named_files();
        let is_read = |own: &Path| {
            canonical(own).is_some_and(|own| read.iter().any(|read| canonical(read).as_ref() == Some(&own)))
        };
        if let Some(own) = place.data.iter().chain([&place.path]).find(|own| is_read(own)) {
            return Err(format!("{} is read by this scene: give the figure another name.", own.display()));
        }
        let (from, scene) = subject.scenes(session);
        let Place { path, format, sheet, data } = place;
        let mut layout = vec![Argument::of("plot-width-mm", sheet.width_mm.to_string())];
        layout.push(Argument::of("font-pt", sheet.font_pt.to_string()));
        layout.extend(data.as_ref().map(|data| Argument::of("plot-data", data.to_string_lossy())));
        layout.extend((!sheet.titled).then(|| Argument { option: Some("no-title".to_owned()), value: None }));
        let settings = arguments(&from, &scene);
        Ok(Self { origin, settings, scene, subject, sheet, format, layout, path, data })
    }

    /// The command and all of its arguments, in the order of `--help`.
    fn given(&self) -> (&'static str, Vec<Argument>) {
        let (command, own, ranges) = self.subject.command();
        let mut all = vec![Argument { option: None, value: Some(self.origin.clone()) }];
        all.extend(own);
        all.push(Argument::of("plot", self.path.to_string_lossy()));
        all.extend(self.layout.iter().cloned().chain(ranges));
        all.push(Argument::of("out", if cfg!(windows) { "NUL" } else { "/dev/null" }));
        all.extend(self.settings.iter().map(|setting| Argument::of("set", setting)));
        (command, all)
    }

    /// The command line that makes the same file without a window.
    pub fn command_line(&self) -> String {
        let (command, all) = self.given();
        let words: Vec<String> = all.iter().flat_map(Argument::words).map(|word| quoted(&word)).collect();
        format!("interwell --headless {command} {}", words.join(" "))
    }

    /// Makes the figure and writes its files, both or neither; what was written, in words. None where it was
    /// cancelled.
    pub fn save(&self, cancel: &AtomicBool) -> Option<Result<String, String>> {
        // a place that cannot be written to is known before the work
        let open = |path: &PathBuf| Sink::open(path).map_err(|error| error.to_string());
        let sinks = open(&self.path).and_then(|plot| Ok((plot, self.data.as_ref().map(open).transpose()?)));
        let (plot, data) = match sinks {
            Ok(sinks) => sinks,
            Err(problem) => return Some(Err(problem)),
        };
        Some(draw(self, cancel)?.and_then(|figure| self.write(figure, plot, data)))
    }

    fn write(&self, mut figure: Figure, plot: Sink, data: Option<Sink>) -> Result<String, String> {
        if !self.sheet.titled {
            figure = figure.without_title();
        }
        let (command, given) = self.given();
        figure.origin.insert("arguments".into(), picture_arguments(command, given).into());
        let bytes = self.format.bytes(&figure).map_err(|error| error.to_string())?;
        let refused = |name: &str, error: std::io::Error| format!("cannot write {name}: {error}");
        let mut sinks = vec![plot];
        sinks[0].put_bytes(&bytes).map_err(|error| refused(sinks[0].name(), error))?;
        if let Some(mut data) = data {
            let text = header(&figure.data) + &rows(&figure.data, 0..usize::MAX);
            data.put(&text).map_err(|error| refused(data.name(), error))?;
            sinks.push(data);
        }
        // what there is no room for is known before the first file has its name
        for sink in &mut sinks {
            sink.flush().map_err(|error| refused(sink.name(), error))?;
        }
        let mut names = Vec::new();
        for sink in sinks {
            let name = sink.name().to_owned();
            sink.finish().map_err(|error| refused(&name, error))?;
            let own = Path::new(&name).file_name();
            names.push(own.map_or(name.clone(), |own| own.to_string_lossy().into_owned()));
        }
        Ok(format!("Saved {}", names.join(" and ")))
    }
}

/// A stretch of time in round numbers, as it is offered: to a thousandth of it.
pub fn round_times((from, to): (f64, f64)) -> Option<(f64, f64)> {
    let digit = 10_f64.powf((to - from).log10().floor() - 3.0);
    let round = |t: f64| short((t / digit).round() * digit).parse::<f64>().unwrap_or(t);
    (from < to && digit.is_finite() && digit > 0.0).then(|| (round(from.max(0.0)), round(to)))
}
