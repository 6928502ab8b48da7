//! Figures of views: the dialog for content, layout and file, and what is done with its answer.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Button, ComboBox, Grid, Key, RichText, TextEdit, Ui};

use crate::app::export::WriteResult;
use crate::app::export::figure::{FigureOrder, Place, Subject, round_times};
use crate::app::session::Session;
use crate::app::task::Background;
use crate::app::ui::widgets::{dialog_ui, primary};
use crate::app::views::{Memory, View, stretch};
use crate::output::{BASE_ACCELERATION, Format, RunPanel, Sheet, SheetText};
use crate::system::files;

use super::Window;
use super::wanted::{Wanted, path_fault};

/// Share of the traces' time window below which the whole run is offered instead.
const LEAST_SHARE: f64 = 0.05;

/// The requested figure. Its layout is kept for the next one.
#[derive(Debug, Default)]
pub struct Figures {
    /// The view; `None` while no figure is requested.
    view: Option<View>,
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
    /// Width and text size when the dialog was opened.
    before: [String; 2],
    /// Why the last figure was not saved.
    pub problem: Option<String>,
    /// Where the mass was when the dialog was opened, in m.
    x: f64,
    /// The base's acceleration then, in m/s^2.
    base_accel: f64,
    had_focus: bool,
    job: Background<FigureOrder, WriteResult>,
}

/// Sizes to choose: width in mm and text in points.
const SIZES: [(&str, [&str; 2]); 2] = [("for a column", ["85", "8"]), ("for a slide", ["240", "18"])];
/// Panels of a run that are chosen side by side.
const PANELS_IN_ROW: usize = 4;

impl Figures {
    /// No figure, and the layout with which the first one begins.
    pub(super) fn new() -> Self {
        Self { width: "85".to_owned(), font: "8".to_owned(), titled: true, ..Self::default() }
    }

    pub(super) fn is_open(&self) -> bool {
        self.view.is_some()
    }

    pub(super) fn choose(&mut self, path: &Path) {
        self.path = path.to_string_lossy().into_owned();
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
            .map_or_else(Default::default, |(from, to)| [from, to].map(|t| t.to_string()));
        self.panels = RunPanel::ALL.map(|shown| panels(view).contains(&shown));
        if !self.is_open() {
            self.before = [self.width.clone(), self.font.clone()];
        }
        let state = session.player.state();
        (self.x, self.base_accel) = (state.x, state.base_accel);
        (self.view, self.problem, self.had_focus) = (Some(view), None, false);
    }

    /// The order for the requested figure, or what is wrong with the request.
    fn order(&self, view: View, session: &Session, memory: &Memory) -> Result<FigureOrder, String> {
        let path = PathBuf::from(self.path.trim());
        let subject = self.subject(view, session, memory)?;
        let endings = "The name ends in .pdf, .svg or .png, which says what kind of file it is.";
        let format = Format::of(&path).map_err(|_| endings.to_owned())?;
        let Self { width, font, titled, .. } = self;
        let text = SheetText { width_mm: width, height_mm: None, font_pt: font, dpi: None, titled: *titled };
        let sheet = Sheet::read(&text, format == Format::Png).map_err(|error| {
            let name = if error.argument == "font_pt" { "Text" } else { "Width" };
            format!("{name} {}: {}", error.value, error.problem)
        })?;
        let data = self.data.then(|| path.with_extension("csv"));
        FigureOrder::new(session, subject, Place { path, format, sheet, data })
    }

    /// What a figure of a view shows, or why there is none.
    fn subject(&self, view: View, session: &Session, memory: &Memory) -> Result<Subject, String> {
        match view {
            _ if !panels(view).is_empty() => {
                let panels = RunPanel::ALL.into_iter().zip(self.panels);
                let shown: Vec<RunPanel> = panels.filter_map(|(panel, on)| on.then_some(panel)).collect();
                if shown.is_empty() {
                    return Err("Panels: at least one is needed.".to_owned());
                }
                Ok(Subject::Run(self.typed_times()?, shown))
            }
            View::Section => Ok(Subject::Section),
            View::Mechanism => Ok(Subject::mechanism(self.x)),
            View::Measured => Subject::measured(session),
            View::Well => Ok(Subject::well(self.x, self.base_accel)),
            View::ForceCurve => Ok(Subject::Curve),
            View::Map => Subject::map(session, memory.map_look.surface, memory.map_look.cuts),
            View::UpAndDown => Subject::walks(session),
            View::Basins => Subject::basins(session),
            View::Spectrum => Ok(Subject::spectrum(session)),
            View::Accuracy => Ok(Subject::accuracy(session)),
            View::Compare => Subject::compare(session),
            _ => {
                Err("There is no figure of a table: the button Copy as CSV in the view has its rows."
                    .to_owned())
            }
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
    fn remark(&self, order: Result<&FigureOrder, &String>, view: View, session: &Session) -> (bool, String) {
        let path = Path::new(self.path.trim());
        if let Err(problem) = order {
            return (false, problem.clone());
        }
        if let Some(fault) = path_fault(path) {
            return (false, fault.to_owned());
        }
        let mut words = match view {
            _ if !panels(view).is_empty() && session.is_continued => {
                "The run of the present scene from its start: no command repeats the changes that were made \
                 during this motion."
            }
            _ if !panels(view).is_empty() => "The run of the scene from its start.",
            View::Section => "The states of the run of the scene from its start.",
            View::Well => "The potential with the mass and the push as they were when this dialog opened.",
            View::ForceCurve => "Force and potential over displacement.",
            View::Mechanism => "The mechanism with the mass where it was when this dialog opened.",
            View::Accuracy => "All runs are computed again; times of the processor differ from run to run.",
            View::Measured => "The record over the run of the scene from its start, or over its force.",
            View::Compare => {
                "The scenes from rest, all under the shaking of the present one. This takes a while."
            }
            View::Map | View::UpAndDown | View::Basins => "All runs are computed again. This takes a while.",
            _ => "",
        }
        .to_owned();
        if !panels(view).is_empty() && session.reference.apart().is_some() {
            words += " The reference is not drawn.";
        }
        let data = path.with_extension("csv");
        if files::exists(path) || self.data && files::exists(&data) {
            words += " A file of that name exists and will be replaced.";
        }
        (true, words.trim_start().to_owned())
    }
}

/// The panels of a run with which the figure of a view begins.
fn panels(view: View) -> &'static [RunPanel] {
    match view {
        View::Displacement => &[RunPanel::Displacement],
        View::Velocity => &[RunPanel::Velocity],
        View::BaseAcceleration => &[RunPanel::Acceleration],
        View::Power => &[RunPanel::Power],
        View::Energy => &[RunPanel::Energy, RunPanel::Ledger],
        View::PhasePortrait => &[RunPanel::Portrait],
        _ => &[],
    }
}

/// The times in s that the traces show; `None` if that is too little, or not the run from its start.
fn times(session: &Session, memory: &Memory) -> Option<(f64, f64)> {
    let now = session.player.time();
    let window = memory.timeline.window.unwrap_or_else(|| stretch(session.model()));
    let from = (now - window).max(0.0);
    (!session.is_continued && now - from > LEAST_SHARE * window).then(|| round_times((from, now))).flatten()
}

enum Action {
    Save,
    Copy,
    /// Choose the file in the desktop's dialog.
    Browse,
    Close,
}

impl Figures {
    fn contents_ui(&mut self, ui: &mut Ui, view: View, session: &Session, memory: &Memory) -> Option<Action> {
        let mut action = None;
        ui.set_min_width(ui.available_width());
        let entered = Grid::new("figure").num_columns(2).spacing([12.0, 6.0]).show(ui, |ui| {
            self.view_choice_ui(ui, view, session, memory);
            self.fields_ui(ui, view, &mut action)
        });
        let order = self.order(view, session, memory);
        let (can_save, remark) = self.remark(order.as_ref(), view, session);
        let remark = self.problem.clone().unwrap_or(remark);
        let running = self.job.is_running();
        let words = if running { "Computing the figure." } else { remark.as_str() };
        ui.add_space(4.0);
        let room = egui::Vec2::new(ui.available_width(), 2.0 * ui.text_style_height(&egui::TextStyle::Body));
        ui.allocate_ui(room, |ui| {
            ui.set_min_height(room.y);
            let label = ui.add(egui::Label::new(RichText::new(words)).wrap());
            ui.ctx().accesskit_node_builder(label.id, |node| node.set_live(egui::accesskit::Live::Polite));
        });
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            if running {
                if ui.button("Stop").clicked() {
                    self.job.clear();
                }
                return;
            }
            let save = ui.add_enabled(can_save, primary(ui, "Save")).on_disabled_hover_text(&remark);
            if save.clicked() || entered.inner && can_save {
                action = Some(Action::Save);
            }
            let hover = "The command that makes the same file without a window.";
            let copy = ui.add_enabled(order.is_ok(), Button::new("Copy as command")).on_hover_text(hover);
            if copy.on_disabled_hover_text(&remark).clicked() {
                action = Some(Action::Copy);
            }
            if ui.button("Cancel").clicked() {
                action = Some(Action::Close);
            }
        });
        action
    }

    fn view_choice_ui(&mut self, ui: &mut Ui, view: View, session: &Session, memory: &Memory) {
        let name = ui.label("Of");
        let mut chosen = view;
        ui.horizontal(|ui| {
            let combo = ComboBox::from_id_salt("figure of").width(180.0).selected_text(view.name());
            let combo = combo.show_ui(ui, |ui| {
                for choice in View::ALL {
                    ui.selectable_value(&mut chosen, choice, choice.name());
                }
            });
            combo.response.labelled_by(name.id);
            ui.weak("as PDF, SVG or PNG, by the end of the name");
        });
        if chosen != view {
            self.open(chosen, session, memory);
        }
        ui.end_row();
    }

    /// File, layout and contents. Returns whether Enter was pressed in a text field.
    fn fields_ui(&mut self, ui: &mut Ui, view: View, action: &mut Option<Action>) -> bool {
        let field = |ui: &mut Ui, name: &str, text: &mut String, width: f32, unit: &str| {
            let name = ui.label(name);
            let field = ui.add(TextEdit::singleline(text).desired_width(width)).labelled_by(name.id);
            ui.label(unit);
            field
        };
        let name = ui.label("File");
        let path = ui.horizontal(|ui| {
            let path = TextEdit::singleline(&mut self.path);
            let room = ui.available_width() - 84.0;
            let path = ui.add(path.desired_width(room)).labelled_by(name.id);
            if ui.button("Browse...").clicked() {
                *action = Some(Action::Browse);
            }
            path
        });
        ui.end_row();
        ui.label("On paper");
        let (width, font) = ui
            .horizontal(|ui| {
                let width = field(ui, "width", &mut self.width, 44.0, "mm,");
                let font = field(ui, "text", &mut self.font, 36.0, "points");
                for (name, size) in SIZES {
                    if ui.link(name).clicked() {
                        [self.width, self.font] = size.map(str::to_owned);
                    }
                }
                (width, font)
            })
            .inner;
        ui.end_row();
        let mut fields = vec![path.inner, width, font];
        if !panels(view).is_empty() {
            ui.label("Panels");
            // not wrapped: a grid gives a wrapped row the height of one
            let mut all = RunPanel::ALL.into_iter().zip(&mut self.panels);
            ui.vertical(|ui| {
                while all.len() > 0 {
                    ui.horizontal(|ui| {
                        for (panel, is_shown) in all.by_ref().take(PANELS_IN_ROW) {
                            let name = match panel {
                                RunPanel::Acceleration => BASE_ACCELERATION,
                                RunPanel::Portrait => "phase portrait",
                                panel => panel.name(),
                            };
                            ui.checkbox(is_shown, name);
                        }
                    });
                }
            });
            ui.end_row();
            ui.label("Times");
            ui.horizontal(|ui| {
                let [from, to] = &mut self.times;
                fields.push(field(ui, "from", from, 64.0, ""));
                fields.push(field(ui, "to", to, 64.0, "s; empty for the whole run"));
            });
            ui.end_row();
        }
        ui.label("");
        ui.checkbox(&mut self.titled, "With title and footer");
        ui.end_row();
        ui.label("");
        ui.checkbox(&mut self.data, "Also the numbers that are drawn, as CSV beside it");
        ui.end_row();
        if !std::mem::replace(&mut self.had_focus, true) {
            fields[0].request_focus();
        }
        if fields.iter().any(|field| field.changed()) {
            self.problem = None;
        }
        fields.iter().any(|field| field.lost_focus()) && ui.input(|input| input.key_pressed(Key::Enter))
    }
}

impl Window {
    pub(super) fn figure_ui(&mut self, ui: &Ui) {
        let Some(view) = self.figures.view else { return };
        let (action, is_closed) = dialog_ui(ui, ("figure", 560.0), ("Save a figure", 4.0), |ui| {
            self.figures.contents_ui(ui, view, &self.session, &self.memory)
        });
        let Some(action) = action.or(is_closed.then_some(Action::Close)) else { return };
        // the dialog may have chosen another view
        let view = self.figures.view.unwrap_or(view);
        let order = self.figures.order(view, &self.session, &self.memory);
        match (action, order) {
            (Action::Browse, _) => self.choose(Wanted::Figure),
            (Action::Close, _) => {
                let Figures { view, width, font, before, job, .. } = &mut self.figures;
                [*width, *font] = std::mem::take(before);
                job.clear();
                *view = None;
            }
            (_, Err(problem)) => self.figures.problem = Some(problem),
            (Action::Copy, Ok(order)) => {
                self.messages.copy(ui.ctx(), order.command_line(), "the command line of this figure");
            }
            (Action::Save, Ok(order)) => {
                self.figures.problem = None;
                self.figures.job.ask(order, &self.wake);
            }
        }
    }

    /// Receives the result of saving a figure; after an error the dialog stays open.
    pub(super) fn take_figure(&mut self) {
        match self.figures.job.take() {
            Some(Ok(text)) => {
                self.figures.view = None;
                self.messages.notify(text);
            }
            Some(Err(problem)) => self.figures.problem = Some(problem),
            None => {}
        }
    }
}
