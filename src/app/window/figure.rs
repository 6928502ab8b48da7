//! Request for a figure of a view: its content, layout and file.

use std::path::{Path, PathBuf};

use crate::app::export::figure::{FigureOrder, Place, Subject, round_times};
use crate::app::session::Session;
use crate::app::task::Background;
use crate::app::views::{Memory, View, stretch};
use crate::output::{Format, RunPanel, Sheet, SheetText};
use crate::system::files;

use super::messages::WriteResult;

/// Share of the traces' time window below which the whole run is offered instead.
const LEAST_SHARE: f64 = 0.05;

/// The requested figure. Its layout is kept for the next one.
#[derive(Debug)]
pub struct Figures {
    /// The view; `None` while no figure is requested.
    pub(super) view: Option<View>,
    pub path: String,
    /// Width on paper in mm.
    pub width: String,
    /// Size of the text in points.
    pub font: String,
    pub titled: bool,
    /// Whether the numbers that are drawn are saved beside the figure.
    pub data: bool,
    /// The times in s of a run; empty for all of it.
    pub times: [String; 2],
    /// The panels of a run, in the order of [`RunPanel::ALL`].
    pub panels: [bool; RunPanel::ALL.len()],
    /// Why the last figure was not saved.
    pub(super) problem: Option<String>,
    /// Whether the path has had the keyboard focus.
    pub(super) had_focus: bool,
    pub(super) job: Background<(), WriteResult>,
}

impl Default for Figures {
    fn default() -> Self {
        let text = String::new;
        Self {
            view: None,
            path: text(),
            width: "85".to_owned(),
            font: "8".to_owned(),
            titled: true,
            data: false,
            times: [text(), text()],
            panels: [false; RunPanel::ALL.len()],
            problem: None,
            had_focus: false,
            job: Background::default(),
        }
    }
}

impl Figures {
    pub(super) fn is_open(&self) -> bool {
        self.view.is_some()
    }

    pub(super) fn choose(&mut self, path: &Path) {
        self.path = path.to_string_lossy().into_owned();
    }

    /// Reports that the desktop has no file dialog, so that the path has to be typed.
    pub(super) fn report_no_dialog(&mut self) {
        let text = "This desktop has no file dialog to offer (xdg-desktop-portal or zenity would be one): \
                    type the path.";
        self.problem = Some(text.to_owned());
    }

    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Opens the dialog for a figure of `view`, with a suggested file.
    pub(super) fn open(&mut self, view: View, session: &Session, memory: &Memory) {
        let ending = Path::new(&self.path).extension().filter(|_| Format::of(Path::new(&self.path)).is_ok());
        let ending = ending.map_or("pdf".to_owned(), |ending| ending.to_string_lossy().into_owned());
        let origin = session.editor.origin().unwrap_or_else(|| "scene".to_owned());
        let stem = Path::new(&origin).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = session.editor.path().and_then(Path::parent).map(Path::to_path_buf);
        let folder = folder.filter(|path| !path.as_os_str().is_empty()).unwrap_or_else(files::working_folder);
        let name = view.name().to_lowercase().replace(" / ", "-").replace(' ', "-");
        self.choose(&folder.join(format!("{stem}-{name}.{ending}")));
        self.times = times(session, memory)
            .map_or([String::new(), String::new()], |(from, to)| [from, to].map(|t| t.to_string()));
        self.panels = RunPanel::ALL.map(|shown| panel(view) == Some(shown));
        (self.view, self.problem, self.had_focus) = (Some(view), None, false);
    }

    /// The order for the requested figure, or what is wrong with the request.
    pub(super) fn order(
        &self,
        view: View,
        session: &Session,
        memory: &Memory,
    ) -> Result<FigureOrder, String> {
        let path = PathBuf::from(self.path.trim());
        let subject = self.subject(view, session, memory)?;
        let format = Format::of(&path).map_err(|_| {
            "The name ends in .pdf, .svg or .png, which says what kind of file it is.".to_owned()
        })?;
        let Self { width, font, titled, .. } = self;
        let text = SheetText { width_mm: width, height_mm: None, font_pt: font, dpi: None, titled: *titled };
        let sheet = Sheet::read(&text, format == Format::Png).map_err(|error| {
            let name = if error.option == "font-pt" { "Text" } else { "Width" };
            format!("{name} {}: {}", error.value, error.problem)
        })?;
        let data = self.data.then(|| path.with_extension("csv"));
        FigureOrder::new(session, subject, Place { path, format, sheet, data })
    }

    /// What a figure of a view shows, or why there is none.
    fn subject(&self, view: View, session: &Session, memory: &Memory) -> Result<Subject, String> {
        match view {
            _ if panel(view).is_some() => {
                let shown =
                    RunPanel::ALL.into_iter().zip(self.panels).filter(|pair| pair.1).map(|pair| pair.0);
                let shown: Vec<RunPanel> = shown.collect();
                let none = "Panels: at least one is needed.";
                if shown.is_empty() {
                    Err(none.to_owned())
                } else {
                    Ok(Subject::Run(self.typed_times()?, shown))
                }
            }
            View::Section => Ok(Subject::Section),
            View::Mechanism => Subject::shapes(session),
            View::Measured => Subject::measured(session),
            View::Well | View::ForceCurve => Ok(Subject::Curve),
            View::Map => Subject::map(session, memory.map_look.surface, memory.map_look.cuts),
            View::UpAndDown => Subject::walks(session),
            View::Basins => Subject::basins(session),
            View::Spectrum => Ok(Subject::spectrum(session)),
            View::Compare | View::Distance | View::BeforeNow => {
                Err("There is no figure of this view: it shows several scenes, and a figure one.".to_owned())
            }
            _ => Err(format!(
                "There is no figure of {}: File, Save a picture of the window has it as it stands.",
                view.name()
            )),
        }
    }

    fn typed_times(&self) -> Result<Option<(f64, f64)>, String> {
        let [from, to] = self.times.each_ref().map(|text| text.trim());
        if from.is_empty() && to.is_empty() {
            return Ok(None);
        }
        let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
        let times = number(from).zip(number(to)).filter(|(from, to)| 0.0 <= *from && from < to);
        times.map(Some).ok_or_else(|| {
            "Times: give two in s, the first one below the second, or none for the whole run.".to_owned()
        })
    }

    /// Whether the figure can be saved as requested, and the remark under the fields.
    pub(super) fn remark(
        &self,
        order: Result<&FigureOrder, &String>,
        view: View,
        session: &Session,
    ) -> (bool, String) {
        let path = Path::new(self.path.trim());
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Err(problem) = order {
            return (false, problem.clone());
        }
        if files::is_folder(path) {
            return (false, "This is a folder: add the name of a file.".to_owned());
        }
        if folder.is_some_and(|folder| !files::is_folder(folder)) {
            return (false, "There is no such folder.".to_owned());
        }
        let mut words = match view {
            _ if panel(view).is_some() && session.is_continued() => {
                "The run of the scene as it now stands, from its start: what was changed on the way of this \
                 motion has no command."
            }
            _ if panel(view).is_some() => "The run of the scene from its start.",
            View::Section => "The states of the scene's own run, from its start.",
            View::Well | View::ForceCurve => "Force and potential over displacement.",
            View::Mechanism => "The centre lines of the flexures where the mass is now.",
            View::Measured => "The record over the run of the scene from its start, or over its force.",
            View::Map | View::UpAndDown | View::Basins => "Every run is made anew, which may take a while.",
            _ => "",
        }
        .to_owned();
        let data = path.with_extension("csv");
        if files::exists(path) || self.data && files::exists(&data) {
            words += " A file of that name exists and will be replaced.";
        }
        (true, words.trim_start().to_owned())
    }
}

pub(super) fn panel(view: View) -> Option<RunPanel> {
    match view {
        View::Displacement => Some(RunPanel::Displacement),
        View::Velocity => Some(RunPanel::Velocity),
        View::BaseAcceleration => Some(RunPanel::Acceleration),
        View::Energy => Some(RunPanel::Energy),
        View::PhasePortrait => Some(RunPanel::Portrait),
        _ => None,
    }
}

/// The times in s that the traces show; `None` if that is too little, or not the run from its start.
fn times(session: &Session, memory: &Memory) -> Option<(f64, f64)> {
    let now = session.player.time();
    let window = memory.timeline.window.unwrap_or_else(|| stretch(session.model()));
    let from = (now - window).max(0.0);
    (!session.is_continued() && now - from > LEAST_SHARE * window).then(|| round_times((from, now))).flatten()
}
