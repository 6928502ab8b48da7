//! The window: panels around the tiles, commands carried out, time passed on.
//!
//! [`Window::ui`] needs no graphics and no display: tests drive it as it is.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use eframe::egui::{self, CentralPanel, Frame, Margin, Panel, RichText, Sense, Ui, Vec2};
use egui_tiles::Tree;

use crate::scene::{Layout, PRESETS};

use super::document::Editor;
use super::layouts::{Arrangement, Room, Tiling};
use super::leave::{self, Answer, Next};
use super::menu::{self, Command};
use super::player::SPEEDS;
use super::session::{CannotRun, Session};
use super::settings::Settings;
use super::style::{self, BODY, PROJECTOR_ZOOM, STATUS, STATUS_COMPACT, Style};
use super::task::{Latest, Wake};
use super::transport::{self, EVENT_AHEAD};
use super::views::{self, Memory, Span, View, ViewContext};
use super::widgets::{Icon, icon_button_ui, kind_shapes};
use super::{controls, export, hint, shortcuts};

/// Where the scenes opened last are kept between two starts of the program.
pub const RECENT: &str = "recent";

/// How many of them.
const MOST_RECENT: usize = 8;

/// Where a person's own arrangement is kept.
pub const OWN_KEY: &str = "arrangement";

/// A file that was chosen, and what for.
#[derive(Debug, Clone, PartialEq)]
enum Chosen {
    Open(PathBuf),
    Save(PathBuf),
    Csv(PathBuf),
    Picture(PathBuf),
    /// The desktop has no dialog to offer.
    NoDialog,
}

/// A dialog that is gone sooner than this in ms was never seen by anyone.
const UNSEEN: u128 = 300;

/// What a file is wanted for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Open,
    Save,
    Csv,
    Picture,
}

/// Everything that the window shows.
pub struct Window {
    /// The open scene.
    pub session: Session,
    /// What a person wants whatever the scene.
    pub settings: Settings,
    tiling: Tiling,
    arrangement: Arrangement,
    /// A person's own arrangement, kept between two starts.
    own: Option<Tree<View>>,
    memory: Memory,
    more: bool,
    filled: Option<View>,
    covered: bool,
    /// A message that waits to be read: an error of a file, or what this program is.
    message: Option<(String, String)>,
    /// Scene files that were opened or saved, the latest first.
    pub recent: Vec<String>,
    /// What waits for an answer about unsaved changes.
    asked: Option<Next>,
    /// What comes once the scene is saved.
    after_save: Option<Next>,
    /// A file with comments that is about to be written over.
    over_comments: Option<PathBuf>,
    /// The list of keys is shown.
    shortcuts: bool,
    /// The changes may go: the window closes without another question.
    leaving: bool,
    /// Errors of what is written elsewhere than in this thread.
    errors: (Sender<String>, Receiver<String>),
    /// The title that the window has.
    titled: String,
    dialog: Latest<Chosen>,
    hint: hint::Hint,
    wake: Wake,
    /// What was applied last, to be applied again only where it changes.
    applied: Option<Settings>,
}

impl Window {
    /// A window on a scene file or a built-in scene; the first preset where none is given.
    pub fn open(spec: Option<&str>, settings: Settings, wake: Wake) -> Result<Self, CannotRun> {
        let first = PRESETS.first().map_or("paper", |preset| preset.name);
        Self::on(Editor::open(spec.unwrap_or(first))?, settings, wake)
    }

    fn on(editor: Editor, settings: Settings, wake: Wake) -> Result<Self, CannotRun> {
        let session = Session::new(editor, Arc::clone(&wake))?;
        let layout = session.scene().app.as_ref().and_then(|app| app.layout).unwrap_or(Layout::Look);
        Ok(Self {
            hint: hint::Hint::for_scene(&session),
            session,
            settings,
            tiling: Tiling::new(layout, Room::Wide),
            arrangement: Arrangement::Layout(layout),
            own: None,
            memory: Memory::default(),
            more: false,
            filled: None,
            covered: false,
            message: None,
            recent: Vec::new(),
            asked: None,
            after_save: None,
            over_comments: None,
            leaving: false,
            shortcuts: false,
            errors: channel(),
            titled: String::new(),
            dialog: Latest::default(),
            wake,
            applied: None,
        })
    }

    /// Opens another scene; one that cannot be opened leaves the present one and says why.
    pub fn open_another(&mut self, spec: &str) {
        self.open_editor(Editor::open(spec).map_err(CannotRun::from));
    }

    fn open_editor(&mut self, editor: Result<Editor, CannotRun>) {
        let wake = Arc::clone(&self.wake);
        match editor.and_then(|editor| Self::on(editor, self.settings, wake)) {
            Ok(window) => {
                *self = Self {
                    dialog: std::mem::take(&mut self.dialog),
                    recent: std::mem::take(&mut self.recent),
                    own: self.own.take(),
                    titled: std::mem::take(&mut self.titled),
                    applied: self.applied,
                    ..window
                };
                self.remember_file();
            }
            Err(error) => self.say("This scene cannot be opened", error.to_string()),
        }
    }

    fn say(&mut self, title: &str, text: String) {
        self.message = Some((title.to_owned(), text));
    }

    /// Puts the scene's file first among the recent ones.
    pub fn remember_file(&mut self) {
        let Some(path) = self.session.editor.path() else { return };
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_owned()).to_string_lossy().into_owned();
        self.recent.retain(|own| *own != whole);
        self.recent.insert(0, whole);
        self.recent.truncate(MOST_RECENT);
    }

    /// Goes on to what is next, once the changes of the present scene are saved or given up.
    pub fn leave_for(&mut self, ctx: &egui::Context, next: Next) {
        self.session.end_gesture();
        if self.session.editor.is_dirty() {
            self.asked = Some(next);
        } else {
            self.go_on(ctx, next);
        }
    }

    fn go_on(&mut self, ctx: &egui::Context, next: Next) {
        match next {
            Next::Open(spec) => self.open_another(&spec),
            Next::Text(text) => self.open_editor(Editor::from_text(&text).map_err(CannotRun::from)),
            Next::Choose => self.choose(Wanted::Open),
            Next::Quit => {
                self.leaving = true;
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }
    }

    /// What came from outside: a closed window, dropped files, the clipboard.
    fn take_in(&mut self, ctx: &egui::Context) {
        if ctx.input(|input| input.viewport().close_requested())
            && !self.leaving
            && self.session.editor.is_dirty()
        {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.leave_for(ctx, Next::Quit);
        }
        let dropped: Vec<PathBuf> =
            ctx.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        match dropped.as_slice() {
            [] => {}
            [one] => self.leave_for(ctx, Next::Open(one.to_string_lossy().into_owned())),
            _ => self.say("One scene at a time", "Drop a single scene file (.ron) on the window.".to_owned()),
        }
        if self.asked.is_none() && !ctx.text_edit_focused() {
            let (mut copied, mut pasted) = (false, None);
            ctx.input(|input| {
                for event in &input.events {
                    match event {
                        egui::Event::Copy => copied = true,
                        egui::Event::Paste(text) => pasted = Some(text.clone()),
                        _ => {}
                    }
                }
            });
            if copied {
                ctx.copy_text(self.session.editor.text());
            }
            if let Some(text) = pasted {
                self.leave_for(ctx, Next::Text(text));
            }
        }
        while let Ok(error) = self.errors.1.try_recv() {
            self.say("Not written", error);
        }
        let dirty = if self.session.editor.is_dirty() { "* " } else { "" };
        let title = format!("{dirty}{} - interwell", self.session.scene().title);
        if title != self.titled {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.titled = title;
        }
    }

    /// The message that waits to be read.
    pub fn message(&self) -> Option<&str> {
        self.message.as_ref().map(|message| message.1.as_str())
    }

    /// What was done since the last frame, before it is drawn.
    pub fn logic(&mut self, ctx: &egui::Context) {
        if self.applied != Some(self.settings) {
            let dark = self.settings.dark && !self.settings.projector;
            ctx.set_theme(if dark { egui::Theme::Dark } else { egui::Theme::Light });
            let zoom = if self.settings.projector { PROJECTOR_ZOOM } else { 1.0 };
            if self.applied.is_some_and(|applied| applied.projector != self.settings.projector)
                || self.settings.projector
            {
                ctx.set_zoom_factor(zoom);
            }
            self.applied = Some(self.settings);
        }
        if self.dialog.poll()
            && let Some(chosen) = self.dialog.current().cloned()
        {
            self.dialog.clear();
            match chosen {
                Chosen::Open(path) => self.open_another(&path.to_string_lossy()),
                Chosen::Save(path) => self.save_to(ctx, &path),
                Chosen::Csv(path) => self.write_motion(&path),
                Chosen::Picture(path) => self.write_picture(ctx, path),
                Chosen::NoDialog => self.say(
                    "No file can be chosen here",
                    "This desktop offers no file dialog (xdg-desktop-portal or zenity would). A scene can be \
                     dropped on the window or opened as `interwell SCENE.ron`; Edit has Copy the scene as text."
                        .to_owned(),
                ),
            }
        } else if !self.dialog.is_running() && self.over_comments.is_none() {
            // a dialog without a choice: nothing follows
            self.after_save = None;
        }
        self.take_in(ctx);
        // a view that is gone cannot let go of the mass itself
        let free =
            ctx.memory(|memory| memory.focused().is_none()) && !ctx.input(|input| input.pointer.any_down());
        if free && self.session.player.is_held() {
            self.session.player.let_go();
            self.session.moved_by_hand();
        }
        self.session.poll();
        let seconds = ctx.input(|input| f64::from(input.stable_dt));
        self.session.player.tick(seconds);
        if self.session.player.is_playing() {
            ctx.request_repaint();
        }
    }

    /// Draws it all.
    pub fn ui(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        for command in menu::keys(&ctx) {
            self.carry_out(&ctx, command);
        }
        let style = Style::of(&ctx, self.settings.projector);
        let room = Room::of(ctx.content_rect().size());
        let compact = room == Room::Compact;
        if room != self.tiling.room() {
            self.arrange(room);
        }
        let fill = ui.visuals().panel_fill;
        let frame = |x: i8, y: i8| Frame::new().fill(fill).inner_margin(Margin::symmetric(x, y));
        let (bar, line, feet) = (frame(8, 2), frame(12, 4), frame(12, 4));
        let mut asked = Vec::new();
        Panel::top("menu").frame(bar).exact_size(32.0).show(ui, |ui| {
            asked = menu::menu_ui(ui, &self.session, &self.tiling, self.settings, &self.recent);
        });
        if !self.covered {
            let height = if compact { 40.0 } else { 44.0 };
            Panel::top("status").frame(line).exact_size(height).show(ui, |ui| {
                status_ui(ui, &self.session, &style, compact);
            });
        }
        Panel::bottom("transport").frame(feet).exact_size(if compact { 46.0 } else { 60.0 }).show(ui, |ui| {
            transport::transport_ui(ui, &mut self.session, &style);
        });
        if compact {
            Panel::top("controls row").frame(line).show(ui, |ui| {
                controls::row_ui(ui, &mut self.session, &style, &mut self.more);
            });
        } else {
            let width = if ctx.content_rect().width() > 1600.0 { 300.0 } else { 250.0 };
            let column = frame(12, 10);
            Panel::left("controls").frame(column).resizable(false).exact_size(width).show(ui, |ui| {
                egui::ScrollArea::vertical().show(ui, |ui| {
                    controls::column_ui(ui, &mut self.session, &style, &mut self.more);
                });
            });
        }
        if self.hint.is_shown(&self.session) {
            Panel::top("hint").frame(line).show(ui, |ui| self.hint.ui(ui));
        }
        CentralPanel::no_frame().show(ui, |ui| self.views_ui(ui, style));
        self.memory.grab = false;
        for command in asked {
            self.carry_out(&ctx, command);
        }
        self.questions_ui(ui, &ctx);
        if self.shortcuts {
            self.shortcuts = shortcuts::shortcuts_ui(ui);
        }
        self.message_ui(ui);
    }

    fn questions_ui(&mut self, ui: &Ui, ctx: &egui::Context) {
        if self.asked.is_some()
            && let Some(answer) = leave::question_ui(ui, &self.session.scene().title)
            && let Some(next) = self.asked.take()
        {
            match answer {
                Answer::Save => {
                    self.after_save = Some(next);
                    self.carry_out(ctx, Command::Save);
                }
                Answer::DontSave => self.go_on(ctx, next),
                Answer::Cancel => {}
            }
        }
        let shown = self.over_comments.as_ref().map(|path| path.display().to_string());
        if let Some(shown) = shown
            && let Some(answer) = leave::comments_ui(ui, &shown)
            && let Some(path) = self.over_comments.take()
        {
            match answer {
                Answer::Save => self.write_scene(ctx, &path),
                Answer::DontSave => self.choose(Wanted::Save),
                Answer::Cancel => self.after_save = None,
            }
        }
        if ui.input(|input| !input.raw.hovered_files.is_empty()) {
            let painter =
                ctx.layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop")));
            let rect = ctx.content_rect();
            painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color.gamma_multiply(0.8));
            let font = egui::FontId::proportional(STATUS);
            let (at, ink) = (rect.center(), ui.visuals().text_color());
            painter.text(at, egui::Align2::CENTER_CENTER, "Drop the scene to open it", font, ink);
        }
    }

    fn views_ui(&mut self, ui: &mut Ui, style: Style) {
        let span = Span::of(&self.session);
        let mut context = ViewContext {
            session: &mut self.session,
            style,
            span,
            memory: &mut self.memory,
            reduce_motion: self.settings.reduce_motion,
            covered: self.covered,
            filled: self.filled.is_some(),
        };
        ui.painter().rect_filled(ui.max_rect(), 0.0, ui.visuals().panel_fill);
        let Some(view) = self.filled else {
            self.tiling.ui(ui, &mut context, &mut self.filled);
            // what a person does to an arrangement of their own stays
            if self.arrangement == Arrangement::Own
                && let Some(kept) = self.tiling.kept()
                && self.own.as_ref() != Some(kept)
            {
                self.own = Some(kept.clone());
            }
            return;
        };
        let mut close = false;
        ui.horizontal(|ui| {
            ui.add_space(8.0);
            ui.heading(view.name());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                close = icon_button_ui(ui, Icon::Fill, 24.0, "all views", "All views again (Z)").clicked();
            });
        });
        views::view_ui(ui, view, &mut context);
        if close {
            self.filled = None;
        }
    }

    fn message_ui(&mut self, ui: &Ui) {
        let Some((title, text)) = &self.message else { return };
        let answer = egui::Modal::new(egui::Id::unique("message")).show(ui.ctx(), |ui| {
            ui.set_max_width(560.0);
            ui.heading(title);
            ui.add_space(6.0);
            egui::ScrollArea::vertical().max_height(320.0).show(ui, |ui| ui.label(text));
            ui.add_space(8.0);
            ui.button("Close").clicked()
        });
        if answer.inner || answer.should_close() {
            self.message = None;
        }
    }

    /// Does what was asked for.
    pub fn carry_out(&mut self, ctx: &egui::Context, command: Command) {
        match command {
            Command::OpenPreset(name) => self.leave_for(ctx, Next::Open(name.to_owned())),
            Command::OpenRecent(path) => self.leave_for(ctx, Next::Open(path)),
            Command::Open => self.leave_for(ctx, Next::Choose),
            Command::Save => match self.session.editor.path().map(PathBuf::from) {
                Some(path) => self.save_to(ctx, &path),
                None => self.choose(Wanted::Save),
            },
            Command::SaveAs => self.choose(Wanted::Save),
            Command::SaveMotion => self.choose(Wanted::Csv),
            Command::SavePicture => self.choose(Wanted::Picture),
            Command::CopyScene => ctx.copy_text(self.session.editor.text()),
            Command::PasteScene => ctx.send_viewport_cmd(egui::ViewportCommand::RequestPaste),
            Command::CopyCommand => match export::command_line(&self.session.editor) {
                Some(line) => ctx.copy_text(line),
                None => self.say(
                    "There is no command line yet",
                    "A pasted scene has no name that the command line could open: save it first.".to_owned(),
                ),
            },
            Command::Quit => self.leave_for(ctx, Next::Quit),
            Command::Undo => {
                self.session.undo();
            }
            Command::Redo => {
                self.session.redo();
            }
            Command::BackToStart => {
                self.session.back_to_start();
                (self.filled, self.covered) = (None, false);
                self.memory = Memory::default();
                self.arrange(self.tiling.room());
            }
            Command::PlayPause => {
                let playing = self.session.player.is_playing();
                self.session.player.set_playing(!playing);
            }
            Command::Step => self.session.player.step(),
            Command::PreviousEvent => {
                self.session.player.seek_event(false, EVENT_AHEAD);
            }
            Command::NextEvent => {
                self.session.player.seek_event(true, EVENT_AHEAD);
            }
            Command::Speed(index) => {
                if let Some(speed) = SPEEDS.get(index) {
                    self.session.player.speed = speed.0;
                }
            }
            Command::Arrange(layout) => {
                self.arrangement = Arrangement::Layout(layout);
                self.arrange(self.tiling.room());
            }
            Command::ArrangeOwn => {
                // the first time it is what is there
                if self.own.is_none() {
                    self.own = self.tiling.kept().cloned();
                }
                self.arrangement = Arrangement::Own;
                self.arrange(self.tiling.room());
            }
            Command::KeepOwn => {
                self.own = self.tiling.kept().cloned().or(self.own.take());
                self.arrangement = Arrangement::Own;
            }
            Command::Show(view, shown) => self.tiling.show(view, shown),
            // the view under the pointer
            Command::Fill => {
                let wanted = self.memory.hovered.unwrap_or(View::Well);
                self.filled = if self.filled.is_some() { None } else { Some(wanted) };
            }
            Command::Cover => self.covered = !self.covered,
            Command::FullScreen => {
                let full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(!full));
            }
            Command::Set(settings) => self.settings = settings,
            Command::Grab => self.memory.grab = true,
            Command::Shortcuts => self.shortcuts = !self.shortcuts,
            Command::About => self.message = Some(about()),
        }
    }

    /// Puts the views where the arrangement has them.
    fn arrange(&mut self, room: Room) {
        self.filled = None;
        self.tiling = match (self.arrangement, &self.own) {
            (Arrangement::Own, Some(own)) => Tiling::own(own, room),
            (Arrangement::Own, None) => Tiling::new(Layout::Look, room),
            (Arrangement::Layout(layout), _) => Tiling::new(layout, room),
        };
    }

    /// A person's own arrangement of the views, where there is one.
    pub fn own_arrangement(&self) -> Option<&Tree<View>> {
        self.own.as_ref()
    }

    /// Takes over an arrangement that was kept.
    pub fn set_own_arrangement(&mut self, own: Option<Tree<View>>) {
        self.own = own;
    }

    /// What the traces share.
    pub fn timeline(&self) -> &views::Timeline {
        &self.memory.timeline
    }

    /// The views and where they stand.
    pub fn tiling(&self) -> &Tiling {
        &self.tiling
    }

    /// Saves to a file; one that was written by hand with comments only once it is said that they go.
    pub fn save_to(&mut self, ctx: &egui::Context, path: &Path) {
        let own = self.session.editor.path() == Some(path);
        if own && self.session.editor.has_comments() {
            self.over_comments = Some(path.to_owned());
        } else {
            self.write_scene(ctx, path);
        }
    }

    fn write_scene(&mut self, ctx: &egui::Context, path: &Path) {
        let next = self.after_save.take();
        match self.session.editor.save_to(path) {
            Ok(()) => {
                self.remember_file();
                if let Some(next) = next {
                    self.go_on(ctx, next);
                }
            }
            Err(error) => self.say("The scene was not saved", error),
        }
    }

    /// Writes the motion that is remembered as CSV.
    pub fn write_motion(&mut self, path: &Path) {
        if let Err(error) = export::write(path, export::motion_csv(&self.session.player).as_bytes()) {
            self.say("The motion was not written", error);
        }
    }

    /// Has the window's picture written once it has been drawn.
    fn write_picture(&mut self, ctx: &egui::Context, path: PathBuf) {
        let (errors, wake) = (self.errors.0.clone(), Arc::clone(&self.wake));
        ctx.request_screenshot(move |image| {
            if let Err(error) = export::png(&image).and_then(|bytes| export::write(&path, &bytes)) {
                errors.send(error).ok();
                wake();
            }
        });
    }

    /// Asks for a file, without the window waiting for the answer.
    fn choose(&mut self, wanted: Wanted) {
        let (kind, ending) = match wanted {
            Wanted::Open | Wanted::Save => ("scene", "ron"),
            Wanted::Csv => ("motion", "csv"),
            Wanted::Picture => ("picture", "png"),
        };
        let path = self.session.editor.path().map(Path::to_path_buf);
        let stem = path.as_ref().and_then(|path| path.file_stem());
        let stem = stem.map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = path.as_ref().and_then(|path| path.parent()).map(Path::to_path_buf);
        self.dialog.ask(&self.wake, move |_| {
            let mut dialog = rfd::FileDialog::new().add_filter(kind, &[ending]);
            if let Some(folder) = folder.filter(|folder| folder.is_dir()) {
                dialog = dialog.set_directory(folder);
            }
            let since = std::time::Instant::now();
            let chosen = if wanted == Wanted::Open {
                dialog.pick_file()
            } else {
                dialog.set_file_name(format!("{stem}.{ending}")).save_file()
            };
            let Some(mut path) = chosen else {
                return (since.elapsed().as_millis() < UNSEEN).then_some(Chosen::NoDialog);
            };
            if wanted == Wanted::Open {
                return Some(Chosen::Open(path));
            }
            if path.extension().is_none() {
                path.set_extension(ending);
            }
            Some(match wanted {
                Wanted::Csv => Chosen::Csv(path),
                Wanted::Picture => Chosen::Picture(path),
                _ => Chosen::Save(path),
            })
        });
    }
}

fn about() -> (String, String) {
    let text = format!(
        "Version {}. Bistable mechanisms with travel limits: what they do when they are shaken.\n\n\
         Every number comes from a run of the integrator; the motion on the screen is such a run, continued.",
        env!("CARGO_PKG_VERSION")
    );
    ("interwell".to_owned(), text)
}

/// The line that says what the mass does.
fn status_ui(ui: &mut Ui, session: &Session, style: &Style, compact: bool) {
    let sentence = session.sentence();
    let size = if compact { STATUS_COMPACT } else { STATUS };
    ui.horizontal_centered(|ui| {
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(size + 6.0), Sense::hover());
        ui.painter().extend(kind_shapes(
            sentence.kind,
            rect.center(),
            size * 0.42,
            style.kind(sentence.kind),
        ));
        let settling = session.settling().map(|(gone, of)| format!("settling: {gone} of {of} periods"));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if let Some(settling) = settling {
                let hover = "How far the motion has settled since your last change";
                ui.label(RichText::new(settling).color(style.faint())).on_hover_text(hover);
            }
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let text = sentence.whole();
                let size = fitted(ui, &text, size);
                ui.add(egui::Label::new(RichText::new(text).size(size)).wrap());
            });
        });
    });
}

/// The size at which a text stands in one line, or the smallest one, at which it takes two.
fn fitted(ui: &Ui, text: &str, size: f32) -> f32 {
    let font = egui::FontId::proportional(size);
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, egui::Color32::PLACEHOLDER);
    let share = ui.available_width() / galley.size().x.max(1.0);
    (size * share.min(1.0) - 0.05).clamp(BODY.min(size), size)
}

impl eframe::App for Window {
    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        Self::logic(self, ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        Self::ui(self, ui);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, eframe::APP_KEY, &self.settings);
        eframe::set_value(storage, RECENT, &self.recent);
        if let Some(own) = &self.own {
            eframe::set_value(storage, OWN_KEY, own);
        }
    }

    fn persist_egui_memory(&self) -> bool {
        // what is open comes from the scene, not from the last time
        false
    }
}

/// Fonts and spacing; to be called once for a context.
pub fn prepare(ctx: &egui::Context) {
    style::install(ctx);
}
