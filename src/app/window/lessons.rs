//! Lessons in the window: opened beside the scene that was there, gone through, and left.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{self, Id, Key, LayerId, Modifiers, Order, Rect, StrokeKind, Ui};

use crate::app::panels::controls;
use crate::app::panels::hint::Hint;
use crate::app::panels::lecturer::lecturer_ui;
use crate::app::panels::lesson::{LessonAct, lesson_ui, letter};
use crate::app::session::editor::Editor;
use crate::app::session::lesson::{OpenLesson, Records, Turn, answers_text};
use crate::app::session::{CannotRun, Session};
use crate::app::ui::style::Style;
use crate::app::views::{Cover, Memory, View};
use crate::app::words::fields::name_and_unit;
use crate::app::words::lesson::pointed;
use crate::scene::lesson::{BuiltInLesson, LessonDocument, LessonError, Step};
use crate::scene::{Document, PRESETS, SceneError};
use crate::study::result_fields;
use crate::system::files;

use super::Window;
use super::layouts::{Arrangement, Tiling};

/// What is said of a lesson that cannot be opened.
pub(super) const CANNOT_OPEN_LESSON: &str = "This lesson cannot be opened";

/// Distance in points of the outline around what a lesson points at.
const AROUND: f32 = 2.0;

#[derive(Default)]
pub(super) struct Lessons {
    pub open: Option<OpenLesson>,
    /// What was there before.
    aside: Option<Aside>,
    /// What was done in all of them.
    pub records: Records,
    /// The lecturer's notes are shown.
    pub notes: bool,
    /// Places of the controls in this frame.
    controls: Vec<(String, Rect)>,
}

impl Lessons {
    /// The session that waits for the lesson to be left.
    pub fn aside(&self) -> Option<&Session> {
        self.aside.as_ref().map(|own| &own.session)
    }
}

/// What a lesson leaves as it was.
struct Aside {
    session: Session,
    tiling: Tiling,
    arrangement: Arrangement,
    memory: Memory,
    more: bool,
    filled: Option<View>,
    hint: Hint,
    hint_row: bool,
    ways: bool,
}

/// Reads a lesson; a file of that name that is none is an error about it.
pub(super) fn read(spec: &str) -> Result<LessonDocument, CannotRun> {
    LessonDocument::load(spec, &result_fields()).map_err(|error| match error {
        LessonError::Wrong(error) => error.into(),
        LessonError::NoSuchLesson { spec, .. } => {
            SceneError::Unreadable { name: spec, problem: "no such file".to_owned() }.into()
        }
    })
}

/// Whether what is to be opened is a lesson: the file of one, or the name, number or words of a built-in one
/// where no preset and no file is called so.
pub(super) fn is_lesson(spec: &str) -> bool {
    let path = Path::new(spec);
    let is_built_in = || !files::exists(path) && BuiltInLesson::find(spec).is_some();
    PRESETS.iter().all(|preset| preset.name != spec) && (LessonDocument::is_lesson(path) || is_built_in())
}

impl Window {
    /// Opens a lesson: a built-in one by its name or number, or a file. One that cannot be opened leaves what
    /// is there and says why.
    pub fn open_lesson(&mut self, spec: &str) {
        match read(spec).and_then(|document| self.begin_lesson(document)) {
            Ok(()) => {}
            Err(error) => self.messages.say(CANNOT_OPEN_LESSON, error.to_string()),
        }
    }

    /// Goes on with a lesson where it was left, and puts what is there aside.
    pub(super) fn begin_lesson(&mut self, document: LessonDocument) -> Result<(), CannotRun> {
        self.session.end_gesture();
        self.keep_progress();
        let wake = Arc::clone(&self.wake);
        let path = match &document.source {
            crate::scene::Source::File(path) => Some(path.clone()),
            _ => None,
        };
        let key = OpenLesson::key_of(&document);
        let (lesson, scene) = OpenLesson::open(document, self.lessons.records.get(&key), wake);
        let session = self.lesson_session(&lesson, *scene, !lesson.is_covering())?;
        let before = std::mem::replace(&mut self.session, session);
        if self.lessons.aside.is_none() {
            self.lessons.aside = Some(Aside {
                session: before,
                tiling: self.tiling.clone(),
                arrangement: self.arrangement,
                memory: std::mem::take(&mut self.memory),
                more: std::mem::take(&mut self.more),
                filled: self.filled.take(),
                hint: self.hint,
                hint_row: self.hint_row,
                ways: std::mem::take(&mut self.ways),
            });
        }
        self.lessons.open = Some(lesson);
        self.memory = Memory::default();
        self.arrange(self.tiling.room());
        if let Some(path) = path {
            self.remember(&path);
        }
        Ok(())
    }

    /// A session on a scene of a lesson, at the lesson's speed.
    fn lesson_session(
        &self,
        lesson: &OpenLesson,
        scene: Document,
        plays: bool,
    ) -> Result<Session, CannotRun> {
        let mut session = Session::new(Editor::in_lesson(scene), Arc::clone(&self.wake))?;
        session.player.speed = lesson.lesson().speed.unwrap_or(session.player.speed);
        session.player.set_playing(plays);
        session.explore.walks.chosen.clone_from(&lesson.lesson().walk);
        session.keeps_remedy = !lesson.tells_remedy();
        // it may be the answer to a lesson's question
        session.best.is_off = true;
        Ok(session)
    }

    /// Leaves the lesson: scene, motion, undo and views are what they were.
    pub fn leave_lesson(&mut self) {
        self.keep_progress();
        let (lesson, aside) = (self.lessons.open.take(), self.lessons.aside.take());
        self.lessons.notes = false;
        if let (Some(_), Some(aside)) = (lesson, aside) {
            let room = self.tiling.room();
            self.session = aside.session;
            (self.tiling, self.arrangement) = (aside.tiling, aside.arrangement);
            (self.memory, self.more, self.filled) = (aside.memory, aside.more, aside.filled);
            (self.hint, self.hint_row, self.ways) = (aside.hint, aside.hint_row, aside.ways);
            if self.tiling.room() != room {
                self.arrange(room);
            }
        }
    }

    pub fn lesson(&self) -> Option<&OpenLesson> {
        self.lessons.open.as_ref()
    }

    /// The lesson that is open, to choose in it.
    pub fn lesson_mut(&mut self) -> Option<&mut OpenLesson> {
        self.lessons.open.as_mut()
    }

    /// What was done in all lessons.
    pub fn records(&self) -> Records {
        let mut records = self.lessons.records.clone();
        if let Some(lesson) = &self.lessons.open {
            records.insert(lesson.key(), lesson.progress().clone());
        }
        records
    }

    /// Takes over what was done in lessons. One that is open already goes on where it was left.
    pub fn set_records(&mut self, records: Records) {
        self.lessons.records = records;
        if let Some(lesson) = &mut self.lessons.open
            && let Some(kept) = self.lessons.records.get(&lesson.key())
        {
            let turn = lesson.go_on_from(kept);
            self.take_turn(turn);
        }
    }

    pub(super) fn keep_progress(&mut self) {
        self.lessons.records = self.records();
    }

    /// Whether the motion is covered, by a key or by a prediction.
    pub(super) fn motion_is_covered(&self) -> bool {
        matches!(self.cover(), Cover::Future | Cover::All)
    }

    /// Whether a prediction covers the motion.
    pub(super) fn lesson_covers(&self) -> bool {
        self.lessons.open.as_ref().is_some_and(OpenLesson::is_covering)
    }

    pub(super) fn cover(&self) -> Cover {
        match &self.lessons.open {
            _ if self.covered => Cover::All,
            Some(lesson) if lesson.is_covering() => Cover::Future,
            Some(lesson) if lesson.hides_surveys() => Cover::Surveys,
            _ => Cover::None,
        }
    }

    pub(super) fn act_in_lesson(&mut self, act: LessonAct) {
        let Some(lesson) = &mut self.lessons.open else { return };
        let turn = match act {
            LessonAct::Choose(option) => lesson.choose(option),
            LessonAct::Back => lesson.go_back(),
            LessonAct::Next => lesson.go_on(),
            LessonAct::NextLesson(name) => return self.open_lesson(name),
            LessonAct::Hint => {
                lesson.turn_hint();
                Turn::Stay
            }
        };
        self.take_turn(turn);
    }

    /// The lesson that is open from its first step, without answers.
    pub(super) fn begin_lesson_anew(&mut self) {
        let turn = self.lessons.open.as_mut().map(OpenLesson::begin_anew);
        turn.into_iter().for_each(|turn| self.take_turn(turn));
    }

    fn take_turn(&mut self, turn: Turn) {
        let Some(lesson) = &self.lessons.open else { return };
        match turn {
            Turn::Stay | Turn::Same => {}
            Turn::Show(scene, plays) => match self.lesson_session(lesson, *scene, plays) {
                Ok(session) => {
                    self.session = session;
                    self.memory = Memory::default();
                }
                Err(error) => {
                    self.messages.say("This step of the lesson cannot be shown", error.to_string());
                    self.leave_lesson();
                }
            },
            Turn::Leave => self.leave_lesson(),
        }
    }

    /// What the keyboard asks of the lesson.
    pub(super) fn lesson_keys(&mut self, ctx: &egui::Context) {
        let Some(lesson) = self.lessons.open.as_ref().filter(|_| !ctx.text_edit_focused()) else { return };
        let mut keys = vec![(Key::PageDown, LessonAct::Next), (Key::PageUp, LessonAct::Back)];
        if matches!(lesson.step(), Step::Do { .. }) {
            keys.extend(lesson.offered_hint().map(|_| (Key::H, LessonAct::Hint)));
        }
        if lesson.is_covering() {
            for option in 0..lesson.options().len() {
                let names = [letter(option).to_string(), (option + 1).to_string()];
                let own = names.iter().filter_map(|name| Key::from_name(name));
                keys.extend(own.map(|key| (key, LessonAct::Choose(option))));
            }
        }
        let pressed =
            keys.into_iter().find(|(key, _)| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, *key)));
        if let Some((_, act)) = pressed {
            self.act_in_lesson(act);
        }
    }

    /// Takes in what the runs say of the lesson; to be called once a frame.
    pub(super) fn follow_lesson(&mut self, ctx: &egui::Context) {
        let Some(lesson) = &mut self.lessons.open else { return };
        if let Some(left) = lesson.follow(&self.session, ctx.input(|input| input.time)) {
            ctx.request_repaint_after_secs(left as f32);
        }
        self.session.keeps_remedy = !lesson.tells_remedy();
    }

    pub(super) fn lesson_strip_ui(&mut self, ui: &mut Ui, style: &Style, compact: bool) {
        let Some(lesson) = &mut self.lessons.open else { return };
        if let Some(act) = lesson_ui(ui, lesson, &self.session, style, compact) {
            self.act_in_lesson(act);
        }
    }

    /// The controls that the lesson names; while a prediction covers the motion nothing moves.
    pub(super) fn lesson_controls_ui(&mut self, ui: &mut Ui) {
        let Some(lesson) = &self.lessons.open else { return };
        if lesson.is_covering() {
            ui.disable();
        }
        self.lessons.controls = controls::named_ui(ui, &mut self.session, &lesson.lesson().controls);
    }

    pub(super) fn lesson_has_controls(&self) -> bool {
        self.lessons.open.as_ref().is_some_and(|own| !own.lesson().controls.is_empty())
    }

    /// Outlines around what the bold words of the step name: controls and views that are on the screen.
    pub(super) fn pointing_ui(&self, ctx: &egui::Context, style: &Style) {
        let shown = |own: &&OpenLesson| self.filled.is_none() && !own.is_covering();
        let Some(lesson) = self.lessons.open.as_ref().filter(shown) else { return };
        let layer = LayerId::new(Order::Middle, Id::unique("pointing"));
        let painter = ctx.layer_painter(layer);
        for word in pointed(lesson.step().text()) {
            let stroke = style.pointing_stroke();
            if let Some(own) = self.lessons.controls.iter().find(|own| names_control(&word, &own.0)) {
                painter.rect_stroke(own.1.expand(AROUND), 4.0, stroke, StrokeKind::Outside);
            } else if let Some(rect) = view_named(&word).and_then(|view| self.tiling.place_of(view)) {
                painter.rect_stroke(rect, 4.0, stroke, StrokeKind::Inside);
            }
        }
    }

    /// The lecturer's notes, where they were asked for.
    pub(super) fn lecturer_ui(&mut self, ctx: &egui::Context) {
        let Some(lesson) = self.lessons.open.as_ref().filter(|_| self.lessons.notes) else { return };
        let (asked, closed) = lecturer_ui(ctx, lesson);
        self.lessons.notes &= !closed;
        asked.into_iter().for_each(|act| self.act_in_lesson(act));
    }

    /// Copies the answers to all lessons as text.
    pub(super) fn copy_answers(&mut self, ctx: &egui::Context) {
        match answers_text(&self.records()) {
            Some(text) => {
                ctx.copy_text(text);
                self.messages.tell("Copied: your answers as text");
            }
            None => self.messages.tell("There are no answers yet"),
        }
    }
}

/// Whether a word in small letters names the control of a field: by the name that stands beside it, or by
/// what it is called everywhere.
fn names_control(word: &str, path: &str) -> bool {
    let name = name_and_unit(path).0;
    let own = name.trim_end_matches(" ±").to_lowercase();
    match path {
        "stops" => ["stops", "stop"].contains(&word),
        "excitation.amplitude_g" | "excitation.rms_g" => word == "shaking" || word == own,
        "stops.travel_limit_mm" => ["travel limit", "position"].contains(&word),
        "start.v_m_per_s" => ["flick", "start", "velocity", own.as_str()].contains(&word),
        _ => word == own,
    }
}

/// The view that a word in small letters names; the barrier is seen in the well, and so are stops.
fn view_named(word: &str) -> Option<View> {
    match word {
        "barrier" | "stops" | "stop" => Some(View::Well),
        _ => View::ALL.into_iter().find(|view| view.name().to_lowercase() == word),
    }
}
