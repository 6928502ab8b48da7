//! The window: panels around the tiles, commands carried out, time passed on.
//!
//! [`Window::ui`] needs no graphics and no display: tests drive it as it is.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use eframe::egui::{self, CentralPanel, Frame, Margin, Panel, RichText, Ui};
use egui_tiles::Tree;

use crate::scene::{Layout, PRESETS};

use super::announce::Announcer;
use super::document::Editor;
use super::layouts::{Arrangement, Room, Tiling};
use super::leave::Next;
use super::menu::{self, Command};
use super::player::SPEEDS;
use super::session::{CannotRun, Session};
use super::settings::Settings;
use super::style::{self, PROJECTOR_ZOOM, Style};
use super::task::{Latest, Wake};
use super::transport::{self, EVENT_AHEAD};
use super::views::{self, Memory, View, ViewContext};
use super::widgets::{Icon, dialog, icon_button_ui};
use super::{controls, export, hint, shortcuts};

/// Where the scenes opened last are kept between two starts of the program.
pub const RECENT: &str = "recent";

/// Height in points of the line of the first minute.
const HINT_ROW: f32 = 32.0;

/// Where a person's own arrangement is kept.
pub const OWN_KEY: &str = "arrangement";

mod files;
mod release;
mod status_line;
mod typed;

use files::{Chosen, Wanted};
use release::Later;
use status_line::{covered_ui, status_ui};
use typed::Typed;

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
    /// What it would take to cross is shown.
    ways: bool,
    announcer: Announcer,
    /// The changes may go: the window closes without another question.
    leaving: bool,
    /// Errors of what is written elsewhere than in this thread.
    errors: (Sender<String>, Receiver<String>),
    /// The title that the window has.
    titled: String,
    dialog: Latest<Chosen>,
    /// Whether files are asked for.
    dialogs: bool,
    /// A path that is typed where there is no dialog.
    typed: Option<Typed>,
    /// Input that waits for the next frame.
    later: Later,
    hint: hint::Hint,
    /// The line of the first minute has been there.
    hint_row: bool,
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
            ways: false,
            announcer: Announcer::default(),
            errors: channel(),
            titled: String::new(),
            dialog: Latest::default(),
            dialogs: true,
            typed: None,
            later: Later::default(),
            hint_row: false,
            wake,
            applied: None,
        })
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
        self.take_choice(ctx);
        self.take_in(ctx);
        // a view that is gone cannot let go of the mass itself
        let free =
            ctx.memory(|memory| memory.focused().is_none()) && !ctx.input(|input| input.pointer.any_down());
        if free && self.session.player.is_held() {
            self.session.player.let_go();
            self.session.moved_by_hand();
        }
        self.session.poll();
        if let Some(left) = self.session.follow_presses(ctx.input(|input| input.time)) {
            ctx.request_repaint_after_secs(left as f32);
        }
        let seconds = ctx.input(|input| f64::from(input.stable_dt));
        self.session.player.tick(seconds);
        if self.session.player.is_playing() {
            ctx.request_repaint();
        }
    }

    /// Draws it all.
    pub fn ui(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        for command in menu::keys(&ctx, self.settings) {
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
        let height = if compact { 40.0 } else { 44.0 };
        Panel::top("status").frame(line).exact_size(height).show(ui, |ui| {
            if self.covered {
                covered_ui(ui);
            } else {
                status_ui(ui, &mut self.session, &mut self.announcer, &style, compact);
            }
        });
        Panel::bottom("transport").frame(feet).exact_size(if compact { 46.0 } else { 60.0 }).show(ui, |ui| {
            transport::transport_ui(ui, &mut self.session, &style);
        });
        if compact {
            Panel::top("controls row").frame(line).show(ui, |ui| {
                controls::row_ui(ui, &mut self.session, &mut self.more);
            });
        } else {
            let width = if ctx.content_rect().width() > 1600.0 { 300.0 } else { 250.0 };
            let column = frame(12, 10);
            Panel::left("controls").frame(column).resizable(false).exact_size(width).show(ui, |ui| {
                egui::ScrollArea::vertical().show(ui, |ui| {
                    controls::column_ui(ui, &mut self.session, &mut self.more);
                });
            });
        }
        let hinted = self.hint.is_shown(&self.session);
        self.hint_row |= hinted;
        if self.ways && !self.covered {
            let ways = self.session.ways();
            Panel::top("ways").frame(line).show(ui, |ui| ui.label(ways));
        } else if self.hint_row {
            // its room stays when it goes: the views below do not jump
            Panel::top("hint").frame(line).exact_size(HINT_ROW).show(ui, |ui| match hinted {
                true => self.hint.ui(ui),
                false => {
                    ui.label(
                        RichText::new("H says what it would take to cross, F1 lists all keys.")
                            .color(style.faint()),
                    );
                }
            });
        }
        CentralPanel::no_frame().show(ui, |ui| self.views_ui(ui, style));
        self.memory.grab = false;
        self.session.map.end_frame();
        self.session.accuracy.end_frame();
        self.session.player.end_frame();
        for command in asked {
            self.carry_out(&ctx, command);
        }
        self.questions_ui(ui, &ctx);
        if self.shortcuts {
            self.shortcuts = shortcuts::shortcuts_ui(ui);
        }
        self.message_ui(ui);
    }

    fn views_ui(&mut self, ui: &mut Ui, style: Style) {
        let span = self.memory.span(&self.session);
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
            ui.heading(view.name()).on_hover_text(view.about());
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
        let answer = dialog(ui.ctx(), "message").show(ui.ctx(), |ui| {
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
            Command::SaveEvents => self.choose(Wanted::Events),
            Command::SaveCurve => self.choose(Wanted::Curve),
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
            Command::SaveMap => self.choose(Wanted::Map),
            Command::CopyMapCommand => {
                if let Some(command) = self.session.map_command() {
                    ctx.copy_text(command);
                }
            }
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
                self.hint = hint::Hint::for_scene(&self.session);
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
            Command::Ways => self.ways = !self.ways,
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

    /// Whether the phase portrait shows a point a period and no path.
    pub fn points_only(&self) -> bool {
        self.memory.points_only
    }

    /// The views and where they stand.
    pub fn tiling(&self) -> &Tiling {
        &self.tiling
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

impl eframe::App for Window {
    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        Self::logic(self, ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        Self::ui(self, ui);
    }

    fn raw_input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        if self.later.hold_back(input) {
            ctx.request_repaint();
        }
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
