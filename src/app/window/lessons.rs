//! Lessons in the window: opening, navigation, and the return to the scene that was open before.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{self, Key, Modifiers, Rect, Ui};

use crate::app::panels::hint::Hint;
use crate::app::panels::lesson::LessonAction;
use crate::app::session::Session;
use crate::app::session::editor::Editor;
use crate::app::session::lesson::{OpenLesson, Records, Turn};
use crate::app::ui::widgets::{close_ui, dialog_ui, focus_first, primary};
use crate::app::views::{Cover, Memory, View};
use crate::app::words::lesson::{bold_words, letter, numbered, question, solved};
use crate::questions::Error;
use crate::scene::lesson::{BuiltInLesson, LessonDocument, LessonError, Step};
use crate::scene::{Document, PRESETS, is_link, linked_lesson};
use crate::system::files;
use interwell_studies::study::{Said, result_fields};

use super::Window;
use super::layouts::{Arrangement, Tiling};
use super::lecturer::Notes;

pub(super) const CANNOT_OPEN_LESSON: &str = "This lesson cannot be opened";

/// Number of the letters that count votes at a prediction with as many options.
const MOST_LETTERS: usize = 3;

#[derive(Default)]
pub(super) struct Lessons {
    pub open: Option<OpenLesson>,
    suspended: Option<Suspended>,
    pub records: Records,
    pub notes: Notes,
    /// The lesson that was finished, until its closing dialog is closed.
    finished: Option<Finished>,
    /// Whether the button that goes on is to have the keyboard focus.
    pub urged: bool,
    /// The step that a key that goes on shall pass at its second press, while the notice about it is shown.
    asked: Option<usize>,
    /// Rectangles of the controls in this frame.
    pub controls: Vec<(String, Rect)>,
}

/// The content of a lesson's closing dialog, and the lesson that comes next.
struct Finished {
    title: String,
    goal: String,
    next: Option<&'static str>,
}

impl Lessons {
    /// Whether a dialog about a lesson is open.
    pub fn ask(&self) -> bool {
        self.finished.is_some() || self.open.as_ref().is_some_and(|lesson| lesson.begun_before)
    }

    /// The session that comes back when the lesson is left.
    pub fn suspended(&self) -> Option<&Session> {
        self.suspended.as_ref().map(|state| &state.session)
    }
}

/// The state of the window that comes back when the lesson is left.
struct Suspended {
    session: Session,
    tiling: Tiling,
    arrangement: Arrangement,
    memory: Memory,
    more: bool,
    filled: Option<View>,
    hint: Hint,
    ways: bool,
}

pub(super) fn read(spec: &str) -> Result<LessonDocument, Error> {
    let unfit =
        |scene: &str, problem: &str| Error::Unfit { scene: scene.into(), problem: Said::new(problem) };
    let spec = match linked_lesson(spec) {
        Some(name) if BuiltInLesson::find(name).is_none() => {
            let problem = format!("there is no built-in lesson {name:.40}; `lessons` lists them");
            return Err(unfit("the link", &problem));
        }
        linked => linked.unwrap_or(spec),
    };
    LessonDocument::load(spec, &result_fields()).map_err(|error| match error {
        LessonError::Wrong(error) => error.into(),
        LessonError::NoSuchLesson { spec, .. } => unfit(&spec, "no such file"),
    })
}

/// Whether `spec` is a lesson: a link to one, a file or, if there is none, the name, number or words of a
/// built-in one.
pub(super) fn is_lesson(spec: &str) -> bool {
    if is_link(spec) {
        return linked_lesson(spec).is_some();
    }
    let path = Path::new(spec);
    let built_in = || !files::exists(path) && BuiltInLesson::find(spec).is_some();
    PRESETS.iter().all(|preset| preset.name != spec) && (LessonDocument::is_lesson(path) || built_in())
}

impl Window {
    /// Opens a built-in lesson by its name or number, or a file. If that fails, an alert says why.
    pub fn open_lesson(&mut self, spec: &str) {
        if let Err(error) = read(spec).and_then(|document| self.begin_lesson(document)) {
            self.messages.alert(CANNOT_OPEN_LESSON, error.to_string());
        }
    }

    /// Continues a lesson where it was left, and suspends the scene that is open.
    pub(super) fn begin_lesson(&mut self, document: LessonDocument) -> Result<(), Error> {
        self.session.end_gesture();
        self.keep_progress();
        let wake = Arc::clone(&self.wake);
        let path = match &document.source {
            crate::scene::Source::File(path) => Some(path.clone()),
            _ => None,
        };
        let key = OpenLesson::key_of(&document);
        let (lesson, scene) = OpenLesson::open(document, self.lessons.records.get(&key), wake);
        let session = self.session_on(&lesson, *scene, !lesson.is_covering())?;
        let before = std::mem::replace(&mut self.session, session);
        if self.lessons.suspended.is_none() {
            self.lessons.suspended = Some(Suspended {
                session: before,
                tiling: self.tiling.clone(),
                arrangement: self.arrangement,
                memory: std::mem::take(&mut self.memory),
                more: std::mem::take(&mut self.more),
                filled: self.filled.take(),
                hint: self.hint,
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
    fn session_on(&self, lesson: &OpenLesson, scene: Document, plays: bool) -> Result<Session, Error> {
        let mut session = Session::new(Editor::changed(scene), Arc::clone(&self.wake))?;
        session.player.speed = lesson.lesson().speed.unwrap_or(session.player.speed);
        session.player.set_playing(plays);
        session.explore.walks.chosen.clone_from(&lesson.lesson().walk);
        session.keeps_remedy = !lesson.tells_remedy();
        session.is_lesson = true;
        Ok(session)
    }

    /// Leaves the lesson: the scene, its motion and undo, and the views are as they were before.
    pub fn leave_lesson(&mut self) {
        self.keep_progress();
        let (lesson, suspended) = (self.lessons.open.take(), self.lessons.suspended.take());
        self.lessons.notes.is_open = false;
        if let (Some(_), Some(before)) = (lesson, suspended) {
            let room = self.tiling.room();
            self.session = before.session;
            (self.tiling, self.arrangement) = (before.tiling, before.arrangement);
            (self.memory, self.more, self.filled) = (before.memory, before.more, before.filled);
            (self.hint, self.ways) = (before.hint, before.ways);
            if self.tiling.room() != room {
                self.arrange(room);
            }
        }
    }

    pub fn lesson(&self) -> Option<&OpenLesson> {
        self.lessons.open.as_ref()
    }

    pub fn lesson_mut(&mut self) -> Option<&mut OpenLesson> {
        self.lessons.open.as_mut()
    }

    pub fn records(&self) -> Records {
        let mut records = self.lessons.records.clone();
        if let Some(lesson) = &self.lessons.open {
            records.insert(lesson.key(), lesson.progress().clone());
        }
        records
    }

    /// Takes over the records of lessons. A lesson that is open continues from its record.
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

    /// Sets what the views show of the question of a lesson, and what they hide for it.
    pub(super) fn pose_question(&mut self) {
        let lesson = self.lessons.open.as_ref();
        let curve = View::ForceCurve;
        let name = curve.name().to_lowercase();
        self.memory.covered = lesson.filter(|open| open.keeps_back(&name)).map(|_| curve);
        let covering = lesson.filter(|open| open.is_covering());
        self.memory.question = covering.and_then(|open| question(open.step().text()));
        let present = self.session.scene().stops.positions_mm();
        let answer = lesson.and_then(OpenLesson::covered_answer).map(|scene| scene.stops.positions_mm());
        self.memory.asked_stops = answer.filter(|answer| *answer != present).unwrap_or_default();
        self.memory.starts = lesson.map(OpenLesson::starts).unwrap_or_default();
        self.memory.push_of_lesson = lesson.map_or(0.0, OpenLesson::largest_push);
    }

    pub(super) fn act_in_lesson(&mut self, act: LessonAction) {
        let Some(lesson) = &mut self.lessons.open else { return };
        let is_vote = matches!(act, LessonAction::Vote(..));
        self.lessons.asked = self.lessons.asked.filter(|_| is_vote || act == LessonAction::Next);
        let mut skipped = None;
        let turn = match act {
            LessonAction::Choose(option) => lesson.choose(option),
            LessonAction::Back => lesson.go_back(),
            // a second press, of a clicker that has no Enter
            LessonAction::Next if lesson.is_covering() && self.lessons.asked == Some(lesson.number()) => {
                self.lessons.asked = None;
                lesson.reveal()
            }
            LessonAction::Next
                if lesson.is_last() && lesson.may_go_on() && self.lessons.asked == Some(lesson.number()) =>
            {
                return match lesson.following() {
                    Some(name) => self.act_in_lesson(LessonAction::NextLesson(name)),
                    None => self.finish_lesson(),
                };
            }
            LessonAction::Next if lesson.is_covering() || lesson.is_last() => {
                self.lessons.urged = true;
                // the buttons of a last step stand beside the views
                self.filled = self.filled.filter(|_| lesson.is_covering());
                self.lessons.asked =
                    Some(lesson.number()).filter(|_| lesson.is_covering() || lesson.may_go_on());
                let votes: u32 = lesson.answer().votes.iter().sum();
                let counted = if votes == 0 { "Nobody has chosen yet" } else { "The votes are counted" };
                return self.messages.notify(match (lesson.is_covering(), lesson.following()) {
                    (false, _) if !lesson.may_go_on() => "The last step: first the task".to_owned(),
                    (true, _) => format!("{counted}: PageDown once more shows what it does"),
                    (false, Some(name)) => {
                        format!("The last step: PageDown once more, or Enter, goes on to {}", numbered(name))
                    }
                    (false, None) => {
                        "The last step: PageDown once more, or Enter, finishes the lesson".to_owned()
                    }
                });
            }
            LessonAction::Next if !lesson.may_go_on() && self.lessons.asked != Some(lesson.number()) => {
                self.lessons.asked = Some(lesson.number());
                return self.messages.notify("The task is not done: PageDown once more passes it");
            }
            LessonAction::Next | LessonAction::Skip => {
                self.lessons.asked = None;
                skipped = (!lesson.may_go_on()).then(|| solved(lesson.solution()));
                let turn = lesson.go_on();
                // where nothing shakes the mass, a step speaks of the motion from its start
                if matches!(turn, Turn::Same) && !self.session.model().is_shaken() {
                    self.session.restart();
                    self.session.player.set_playing(true);
                }
                turn
            }
            LessonAction::Reveal => lesson.reveal(),
            LessonAction::Finish => return self.finish_lesson(),
            LessonAction::Vote(..) if !lesson.is_covering() => {
                return self.messages.notify(match lesson.options().is_empty() {
                    true => "This step has nothing to vote on",
                    false => "The answer is shown: votes are no longer counted",
                });
            }
            LessonAction::Vote(option, more) => {
                lesson.vote(option, more);
                Turn::Stay
            }
            LessonAction::NextLesson(name) => {
                self.filled = None;
                return self.open_lesson(name);
            }
            LessonAction::Hint => {
                lesson.hinted = !lesson.hinted;
                Turn::Stay
            }
        };
        self.take_turn(turn);
        let tells = |open: &OpenLesson| matches!(open.step(), Step::Say(_) | Step::Explain(_));
        if let Some(solution) = skipped.filter(|_| self.lesson().is_some_and(tells)) {
            self.messages.notify(format!("The task is shown solved{solution}"));
        }
    }

    /// Leaves the lesson with one sentence of what was learnt.
    fn finish_lesson(&mut self) {
        let Some(open) = &self.lessons.open else { return };
        let (title, goal) = (open.lesson().title.clone(), open.lesson().goal.clone());
        self.lessons.finished = Some(Finished { title, goal, next: open.following() });
        self.leave_lesson();
    }

    /// The closing dialog of a lesson, and the question whether a lesson that was begun before begins anew.
    pub(super) fn lesson_dialogs_ui(&mut self, ui: &Ui) {
        if let Some(Finished { title, goal, next: following }) = &self.lessons.finished {
            let (mut next, heading) = (None, format!("{title}: done"));
            let (is_read, is_closed) = dialog_ui(ui, ("finished", 480.0), (heading, 6.0), |ui| {
                ui.label(goal);
                ui.add_space(8.0);
                ui.horizontal(|ui| {
                    let name = |name: &&str| format!("Go on to {}", numbered(name));
                    next = following.filter(|next| {
                        let button = ui.add(primary(ui, &name(next)));
                        focus_first(ui, &button);
                        button.clicked()
                    });
                    close_ui(ui)
                })
                .inner
            });
            if next.is_some() || is_read || is_closed {
                self.lessons.finished = None;
                next.into_iter().for_each(|name| self.open_lesson(name));
            }
        }
        let Some(lesson) = self.lessons.open.as_mut().filter(|open| open.begun_before) else { return };
        let (mut anew, title) = (false, &lesson.lesson().title);
        let (goes_on, is_closed) = dialog_ui(ui, ("begun before", 480.0), (title, 6.0), |ui| {
            let (step, count) = (lesson.number() + 1, lesson.lesson().steps.len());
            ui.label(format!("This lesson was begun before, and left at step {step} of {count}."));
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                anew = ui.button("Begin anew").clicked();
                ui.add(primary(ui, "Go on")).clicked()
            })
            .inner
        });
        if anew {
            self.begin_lesson_anew();
        } else if goes_on || is_closed {
            lesson.begun_before = false;
        }
    }

    pub(super) fn begin_lesson_anew(&mut self) {
        let turn = self.lessons.open.as_mut().map(OpenLesson::begin_anew);
        turn.into_iter().for_each(|turn| self.take_turn(turn));
    }

    /// Brings the views to the front that bold words in the text of the step name, the first of them last,
    /// and returns that one.
    pub(super) fn show_named_views(&mut self) -> Option<View> {
        let named = bold_words(self.lessons.open.as_ref()?.step().text());
        let named: Vec<View> = named.filter_map(|word| View::named(&word)).collect();
        named.iter().rev().for_each(|view| self.tiling.show_in_front(*view));
        named.into_iter().find(|view| self.tiling.shows(*view))
    }

    fn take_turn(&mut self, turn: Turn) {
        if let Some(lesson) = &self.lessons.open {
            self.tiling.cover_surveys(lesson.hides_surveys());
        }
        if !matches!(turn, Turn::Stay) {
            // what was said of the step before, and its cover
            (self.messages.notice, self.covered) = (None, false);
            let named = self.show_named_views();
            // it takes the place of a view that has the whole window
            self.filled = self.filled.map(|filled| named.unwrap_or(filled));
        }
        let (Some(lesson), Turn::Show(scene, plays)) = (&self.lessons.open, turn) else { return };
        match self.session_on(lesson, *scene, plays) {
            Ok(mut session) => {
                // what was computed of the same question is not computed again
                session.keep_ranges_of(&self.session);
                session.keep_studies_of(&mut self.session);
                (self.session, self.memory) = (session, self.memory.for_another_step());
            }
            Err(error) => {
                self.messages.alert("This step of the lesson cannot be shown", error.to_string());
                self.leave_lesson();
            }
        }
    }

    pub(super) fn lesson_keys(&mut self, ctx: &egui::Context) {
        let Some(lesson) = self.lessons.open.as_ref().filter(|_| !ctx.text_edit_focused()) else { return };
        let plain = |key, act| (Modifiers::NONE, key, act);
        let mut keys = vec![plain(Key::PageDown, LessonAction::Next), plain(Key::PageUp, LessonAction::Back)];
        if matches!(lesson.step(), Step::Do { .. }) {
            keys.extend(lesson.offered_hint().map(|_| plain(Key::H, LessonAction::Hint)));
        }
        let covers = lesson.is_covering();
        let has_votes = lesson.answer().votes.iter().any(|votes| *votes > 0);
        if covers && ctx.memory(|memory| memory.focused().is_none()) {
            keys.push(plain(Key::Enter, if has_votes { LessonAction::Reveal } else { LessonAction::Next }));
        }
        // also at a step without options, where no other command is meant by a letter with Shift
        for option in 0..lesson.options().len().max(MOST_LETTERS) {
            let names = [letter(option).to_string(), (option + 1).to_string()];
            let pair = names.iter().filter_map(|name| Key::from_name(name));
            let chosen = pair.clone().filter(|_| covers && option < lesson.options().len());
            let vote = LessonAction::Vote(option, 1);
            // a letter without Shift reveals nothing while votes are counted
            let choice = if has_votes { vote } else { LessonAction::Choose(option) };
            keys.extend(chosen.map(|key| plain(key, choice)));
            keys.extend(pair.take(1).map(|key| (Modifiers::SHIFT, key, vote)));
        }
        // keys with Shift first: the same key without it would consume them
        keys.sort_by_key(|key| !key.0.shift);
        // all votes that were pressed since the last frame, but one of the other actions
        let mut has_acted = false;
        for (modifiers, key, act) in keys {
            let presses = ctx.input_mut(|input| input.count_and_consume_key(modifiers, key));
            let is_vote = matches!(act, LessonAction::Vote(..));
            let count = if is_vote { presses } else { presses.min(usize::from(!has_acted)) };
            has_acted |= !is_vote && count > 0;
            (0..count).for_each(|_| self.act_in_lesson(act));
        }
    }

    /// Receives the verdicts of runs on the lesson; to be called once a frame.
    pub(super) fn follow_lesson(&mut self, ctx: &egui::Context) {
        let Some(lesson) = &mut self.lessons.open else { return };
        if let Some(left) = lesson.follow(&self.session, ctx.input(|input| input.time)) {
            ctx.request_repaint_after_secs(left as f32);
        }
        self.session.keeps_remedy = !lesson.tells_remedy();
    }
}
