//! Execution of the commands.

use eframe::egui::{self, gui_zoom};

use crate::app::export;
use crate::app::panels::hint;
use crate::app::panels::transport::EVENT_AHEAD;
use crate::app::session::lesson::answers_text;
use crate::app::session::measured::MeasuredData;
use crate::app::session::player::{Goal, SPEEDS};
use crate::app::views::{Memory, View};
use crate::dynamics::EventKind;
use crate::scene::Layout;
use crate::system::page_address;

use super::Window;
use super::command::{Command, UNDO};
use super::keys;
use super::layouts::Arrangement;
use super::leave::Next;

/// Number of characteristic times of the motion within which an event is searched.
const TIMES_AHEAD: f64 = 300.0;

const ABOUT: &str = concat!(
    "Version ",
    env!("CARGO_PKG_VERSION"),
    ". Bistable mechanisms with travel limits: what they do when they are shaken.\n\n\
     Every number comes from a run of the integrator; the motion on the screen is such a run, continued.\n\n\
     By the interwell developers, under the licence MIT or Apache-2.0. To cite it: CITATION.cff of its \
     source."
);

impl Window {
    /// Carries out the commands of the pressed keys. While the motion goes to a goal, a key only stops that.
    pub(super) fn keys(&mut self, ctx: &egui::Context) {
        let is_pressed = |event: &egui::Event| matches!(event, egui::Event::Key { pressed: true, .. });
        if self.session.player.goal().is_some() {
            if ctx.input(|input| input.events.iter().any(is_pressed)) {
                ctx.input_mut(|input| input.events.retain(|event| !is_pressed(event)));
                self.session.player.set_playing(false);
            }
            return;
        }
        self.lesson_keys(ctx);
        for command in keys::pressed(ctx, self.filled.is_some()) {
            self.carry_out(ctx, command);
        }
    }

    pub fn carry_out(&mut self, ctx: &egui::Context, command: Command) {
        if let Some(why) = self.impossible(&command) {
            return self.messages.notify(why);
        }
        // the notice of the command before
        self.messages.notice = None;
        match command {
            Command::OpenPreset(name) => self.leave_for(ctx, Next::Open(name.to_owned())),
            Command::OpenRecent(path) => self.leave_for(ctx, Next::Open(path)),
            Command::Open => self.leave_for(ctx, Next::Choose),
            Command::RemoveMeasured => self.session.measured = MeasuredData::default(),
            Command::Save => self.save(ctx),
            Command::Choose(wanted) => self.choose(wanted),
            Command::Figure(view) => {
                let view = view.or(self.filled).unwrap_or_else(|| self.pointed_view());
                self.figures.open(view, &self.session, &self.memory);
            }
            Command::CopyScene => self.copy_scene(ctx),
            Command::CopyLink => self.copy_link(ctx),
            Command::PasteScene => ctx.send_viewport_cmd(egui::ViewportCommand::RequestPaste),
            Command::CopyCommand => self.copy_command(ctx),
            Command::CopyMapCommand => self.copy_map_command(ctx),
            Command::Quit => self.leave_for(ctx, Next::Quit),
            Command::Undo => _ = self.session.undo(),
            Command::Redo => _ = self.session.redo(),
            Command::BackToStart => self.back_to_start(ctx),
            Command::PlayPause => self.session.play_or_pause(),
            Command::Step => self.session.player.step(),
            Command::SeekEvent(later) => self.seek_event(later),
            Command::GoTo(kind) => self.go_to_first(kind),
            Command::RunToEnd => match self.session.end_of_run() {
                end if end > self.session.player.time() => self.session.player.go_to(Goal::Time(end)),
                end => self.messages.notify(format!("The run ended at {end:.2} s, before the time shown")),
            },
            Command::Speed(index) => {
                if let Some((speed, _)) = SPEEDS.get(index) {
                    self.session.player.speed = *speed;
                }
            }
            Command::Arrange(layout) => {
                self.show_arrangement(Arrangement::Layout(layout));
                if layout == Layout::Map {
                    self.tiling.show_in_front(View::Map);
                }
                // the other studies need shaking that repeats
                if layout == Layout::Explore && !self.session.model().repeats() {
                    self.tiling.show_beside(View::Spectrum, View::UpAndDown);
                }
            }
            Command::ArrangeOwn => self.show_own_arrangement(),
            Command::KeepOwn => {
                self.custom = self.tiling.tree_to_save().cloned().or(self.custom.take());
                self.arrangement = Arrangement::Custom;
            }
            Command::Show(view, shown) => self.tiling.show(view, shown),
            Command::NextTab => self.tiling.next_tab(self.memory.hovered),
            Command::Cursors => self.switch_cursors(),
            Command::HoldAxes => self.hold_axes(),
            Command::FreeAxes => self.memory.free_axes(self.active_view()),
            Command::Zoom { upwards, closer } => self.memory.zoom_by_key(self.active_view(), upwards, closer),
            Command::Fill => {
                self.filled = self.filled.is_none().then_some(self.pointed_view());
            }
            Command::Cover => self.covered = !self.covered,
            Command::Magnify(1) => gui_zoom::zoom_in(ctx),
            Command::Magnify(-1) => gui_zoom::zoom_out(ctx),
            Command::Magnify(_) => ctx.set_zoom_factor(self.zoom.unwrap_or(1.0)),
            Command::FullScreen => {
                let full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(!full));
            }
            Command::Toggle(setting) => *self.settings.of(setting) ^= true,
            Command::Grab => self.memory.grab = true,
            Command::Pin => self.pin(),
            Command::Ways => self.ways = !self.ways,
            Command::BestStops => self.find_best_stops(),
            Command::OpenLesson(name) => self.open_lesson(name),
            Command::LeaveLesson => self.leave_lesson(),
            Command::LessonAnew => self.begin_lesson_anew(),
            Command::CopyAnswers => self.copy_answers(ctx),
            Command::LecturerNotes => self.lessons.notes.is_open = !self.lessons.notes.is_open,
            Command::Glossary => self.glossary = true,
            Command::Notes => self.show_notes(),
            Command::Shortcuts => self.shortcuts = Some(ctx.input(|input| input.time)),
            Command::About => self.messages.alert("interwell", ABOUT),
        }
    }

    fn copy_answers(&mut self, ctx: &egui::Context) {
        match answers_text(&self.records()) {
            Some(text) => self.messages.copy(ctx, text, "your answers as text"),
            None => self.messages.notify("There are no answers yet"),
        }
    }

    fn copy_link(&mut self, ctx: &egui::Context) {
        let link = self.session.editor.document().link().map_err(|error| error.to_string());
        match link.and_then(|link| Ok(page_address()? + &link)) {
            Ok(link) => self.messages.copy(ctx, link, "a link that opens this scene"),
            Err(error) => self.messages.alert("This scene has no link", error),
        }
    }

    fn copy_command(&mut self, ctx: &egui::Context) {
        match export::command_line(&self.session) {
            Some((line, runs)) => self.messages.copy(ctx, line, &format!("the command line of {runs}")),
            None => self.alert_unnamed(),
        }
    }

    fn copy_map_command(&mut self, ctx: &egui::Context) {
        match export::map_command_line(&self.session) {
            Some(line) => self.messages.copy(ctx, line, "the command line of the map"),
            None if self.session.map.map().is_some() => self.alert_unnamed(),
            None => {}
        }
    }

    fn back_to_start(&mut self, ctx: &egui::Context) {
        let changed = self.session.editor.is_dirty();
        self.session.back_to_start();
        self.filled = None;
        self.memory = Memory::default();
        self.hint = hint::Hint::for_scene(&self.session);
        self.ways = false;
        if let Some(speed) = self.lesson().and_then(|open| open.lesson().speed) {
            self.session.player.speed = speed;
        }
        if changed {
            let undo = ctx.format_shortcut(&UNDO);
            self.messages.notify(format!("Your changes are discarded; {undo} brings them back"));
        }
        self.arrange(self.tiling.room());
    }

    fn show_arrangement(&mut self, arrangement: Arrangement) {
        (self.arrangement, self.filled) = (arrangement, None);
        self.arrange(self.tiling.room());
    }

    /// Shows the arrangement that the user has made, which begins as a copy of the present tiles.
    fn show_own_arrangement(&mut self) {
        if self.custom.is_none() {
            self.custom = self.tiling.tree_to_save().cloned();
            let text = "Your own arrangement begins as these views: drag their titles to change it";
            self.messages.notify(text);
        }
        self.show_arrangement(Arrangement::Custom);
    }

    /// Shows or hides the cursors over time, with a view over time if none is shown.
    fn switch_cursors(&mut self) {
        self.memory.switch_cursors(&self.session);
        let over_time = |view: &View| view.is_over_time() && self.tiling.place_of(*view).is_some();
        if self.memory.cursors.on && self.filled.is_none() && !View::ALL.iter().any(over_time) {
            self.tiling.show(View::Displacement, true);
        }
    }

    fn hold_axes(&mut self) {
        let view = self.active_view();
        let is_held = self.memory.hold_axes(view);
        let what = if is_held { "held: L again lets go of them" } else { "by themselves again" };
        self.messages.notify(format!("{}: its axes are {what}", view.name()));
    }

    /// The view under the pointer, or else the largest one.
    fn pointed_view(&self) -> View {
        let shown = |view: &View| self.tiling.place_of(*view).is_some();
        self.memory.hovered.filter(shown).unwrap_or_else(|| self.tiling.largest())
    }

    /// The view that keys act on: it fills the window, is under the pointer or has the focus.
    pub(super) fn active_view(&self) -> View {
        self.filled.or(self.memory.hovered).unwrap_or(View::Displacement)
    }

    fn find_best_stops(&mut self) {
        self.ways = false;
        self.session.find_best_stops();
        if self.filled.is_some() && self.session.best.is_shown() {
            self.messages.notify("Searching for the best stops. Z shows the answer");
        }
    }

    fn pin(&mut self) {
        let done = "Pinned: later changes are compared with this motion";
        self.messages.notify(self.session.pin().map_or_else(|why| why, |()| done.to_owned()));
    }

    /// Goes to the next event of a kind, as far ahead as the run length or, if that is more, `TIMES_AHEAD`.
    fn go_to_first(&mut self, kind: EventKind) {
        let model = self.session.model();
        let ahead = model.duration().max(TIMES_AHEAD * model.characteristic_time());
        let player = &mut self.session.player;
        player.go_to(Goal::First(kind, player.watch().time() + ahead));
    }

    fn show_notes(&mut self) {
        if let Some(lesson) = self.lesson().map(|open| open.lesson()) {
            let (title, goal) = (lesson.title.clone(), lesson.goal.clone());
            return self.messages.alert(title, goal);
        }
        let scene = self.session.scene();
        let changed = if self.session.editor.is_dirty() { " (before changes)" } else { "" };
        self.messages.alert(format!("{}{changed}", scene.title), scene.notes.trim());
    }

    /// Goes to the next (`later`) or the previous event, or says that there is none.
    fn seek_event(&mut self, later: bool) {
        self.session.player.seek_event(later, EVENT_AHEAD);
        if self.session.player.event().is_none() {
            self.messages.notify(match later {
                true => format!("No event in the next {EVENT_AHEAD} s"),
                false => "No event before".to_owned(),
            });
        }
    }

    fn alert_unnamed(&mut self) {
        self.messages.alert(
            "There is no command line yet",
            "This scene has no name that the command line could open: save it first.",
        );
    }
}
