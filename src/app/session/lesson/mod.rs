//! An open lesson: its current step, the student's choices, and the verdicts of runs on them.
//!
//! It does not hold the scene that is edited: it says which scene to show, and judges the session's. The
//! results of a prediction are covered until an option is chosen; meanwhile runs find the option that holds.
//! A task is judged by a full run of the scene once the scene has stood still.

mod judged;
mod progress;

use std::sync::Arc;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::app::task::{Background, Uncompared, Wake};
use crate::app::words::lesson::bold_words;
use crate::dynamics::STANDARD_GRAVITY;
use crate::scene::lesson::{Choice, Condition, LESSONS, Lesson, LessonDocument, Step};
use crate::scene::{Document, Scene, Source, Start, arguments};
use interwell_studies::study::Lack;

use super::Session;
use judged::Judged;
pub(super) use judged::{GoalQuestion, OptionsQuestion};

pub use progress::{Answer, Progress, Records, answers_text};

/// Greatest number of votes for an option.
pub const MOST_VOTES: u32 = 999;

/// Time in s for which a scene has to stay unchanged before it can complete a task.
const STILL: f64 = 0.5;

/// Number of scenes that do not do a task after which its hint is offered.
const TRIES: usize = 3;

/// What the screen is to show after an action in the lesson.
#[derive(Debug)]
pub enum Turn {
    /// The same scene and step.
    Stay,
    /// The same scene, in another step.
    Same,
    /// This scene from its start, and whether it plays.
    Show(Box<Document>, bool),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TaskState {
    /// The user is changing the scene, or has just changed it.
    Moving,
    Judging,
    /// The present scene does not do the task; the first thing that it lacks.
    NotYet(Lack),
    Met,
    /// Why the scene cannot be judged.
    Unjudged(String),
}

/// Which option of a prediction holds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Outcome {
    Unknown,
    Holds(usize),
    /// No option or several, which is a fault of the lesson.
    Unclear,
    /// Why the scene cannot be judged.
    Unjudged(String),
}

pub struct OpenLesson {
    document: Arc<LessonDocument>,
    progress: Progress,
    /// Time of the window in s at which the lesson was opened.
    opened: Option<f64>,
    /// Whether the hint of a task is to be shown.
    pub hinted: bool,
    /// Number of scenes that were judged and did not do the task; whether the present one is among them.
    tries: (usize, bool),
    /// Whether it continues at a later step, perhaps that of another class, and this is not confirmed yet.
    pub begun_before: bool,
    pub(super) options: Background<OptionsQuestion, Outcome>,
    pub(super) goal: Background<GoalQuestion, TaskState>,
    /// The time in s since which the scene of the goal has stood still.
    still_since: f64,
    wake: Wake,
}

impl OpenLesson {
    /// Opens a lesson where it was left. Returns it with the scene to begin with.
    pub fn open(document: LessonDocument, kept: Option<&Progress>, wake: Wake) -> (Self, Box<Document>) {
        let progress = Progress::of(&document.lesson, kept);
        let mut opened = Self {
            document: Arc::new(document),
            begun_before: progress.step > 0,
            progress,
            opened: None,
            hinted: false,
            tries: (0, false),
            options: Background::default(),
            goal: Background::default(),
            still_since: 0.0,
            wake,
        };
        let scene = match opened.enter(opened.progress.step) {
            Turn::Show(scene, _) => scene,
            _ => Box::new(opened.preceding_scene()),
        };
        (opened, scene)
    }

    pub fn lesson(&self) -> &Lesson {
        &self.document.lesson
    }

    /// The name or the path under which the progress of a lesson is kept.
    pub fn key_of(document: &LessonDocument) -> String {
        match &document.source {
            Source::BuiltIn(name) => (*name).to_owned(),
            Source::File(path) => path.to_string_lossy().into_owned(),
            Source::Text => document.name.clone(),
        }
    }

    pub fn key(&self) -> String {
        Self::key_of(&self.document)
    }

    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Number of the step, from 0.
    pub fn number(&self) -> usize {
        self.progress.step
    }

    pub fn step(&self) -> &Step {
        &self.lesson().steps[self.progress.step]
    }

    pub fn answer(&self) -> &Answer {
        &self.progress.answers[self.progress.step]
    }

    fn answer_mut(&mut self) -> &mut Answer {
        &mut self.progress.answers[self.progress.step]
    }

    /// The options of a prediction; empty in any other step.
    pub fn options(&self) -> &[Choice] {
        if let Step::Predict { options, .. } = self.step() { options } else { &[] }
    }

    /// The number of votes for all options.
    pub fn votes(&self) -> u32 {
        self.answer().votes.iter().sum()
    }

    /// The reply to an option that does not hold, once that is known, with the option: to the one that was
    /// chosen or, without a choice, to the one of those with most votes.
    pub fn reply(&self) -> Option<(usize, &str)> {
        let Outcome::Holds(holding) = self.outcome() else { return None };
        let (answer, options) = (self.answer(), self.options());
        let chosen = match &answer.choice {
            _ if !answer.shown => None,
            Some(choice) => options.iter().position(|option| option.text == *choice),
            None => {
                let wrong = answer.votes.iter().enumerate().filter(|vote| vote.0 != holding && *vote.1 > 0);
                wrong.rev().max_by_key(|vote| *vote.1).map(|vote| vote.0)
            }
        };
        let chosen = chosen.filter(|option| *option != holding)?;
        Some((chosen, options[chosen].reply.as_deref()?))
    }

    /// Whether the motion and all results are covered: in a prediction that has not been shown.
    pub fn is_covering(&self) -> bool {
        matches!(self.step(), Step::Predict { .. }) && !self.answer().shown
    }

    /// The scene of the answer to a prediction, while it is covered.
    pub fn covered_answer(&self) -> Option<&Scene> {
        self.is_covering().then(|| &self.document.end(self.progress.step).scene)
    }

    /// The starts that the conditions of the present step name, or else those of the last step before it that
    /// names some: displacement in m and velocity in m/s, each once.
    pub fn starts(&self) -> Vec<(f64, f64)> {
        let steps = self.lesson().steps[..=self.progress.step].iter().rev();
        let of_step = |step: &Step| {
            let mut starts = Vec::new();
            for start in step.conditions().into_iter().flat_map(Condition::all_starts) {
                let Start::At { x_mm, v_m_per_s, .. } = start else { continue };
                let start = (x_mm * 1e-3, *v_m_per_s);
                if !starts.contains(&start) {
                    starts.push(start);
                }
            }
            starts
        };
        steps.map(of_step).find(|starts| !starts.is_empty()).unwrap_or_default()
    }

    /// Whether a view that would show the answer is covered: until the first prediction has been shown,
    /// unless a step before it has the name of the view, in lower case, as a bold word.
    pub fn keeps_back(&self, view: &str) -> bool {
        let steps = self.lesson().steps.iter();
        let mut before = steps.take_while(|step| !matches!(step, Step::Predict { .. }));
        self.hides_surveys() && !before.any(|step| bold_words(step.text()).any(|word| word == view))
    }

    /// Whether results for other settings are covered: until the first prediction has been shown.
    pub fn hides_surveys(&self) -> bool {
        let is_prediction = |step: &Step| matches!(step, Step::Predict { .. });
        let first = self.lesson().steps.iter().position(is_prediction);
        first.is_some_and(|number| !self.is_settled(number))
    }

    /// Whether a step has been answered or done. A step that only tells or explains something always is.
    pub fn is_settled(&self, number: usize) -> bool {
        match (&self.lesson().steps[number], &self.progress.answers[number]) {
            (Step::Say(_) | Step::Explain(_), _) => true,
            (Step::Predict { .. }, answer) => answer.shown,
            (Step::Do { .. }, answer) => answer.met,
        }
    }

    pub fn may_go_on(&self) -> bool {
        self.is_settled(self.progress.step)
    }

    /// Whether the window may say what it would take to cross the barrier: after all steps are settled.
    pub fn tells_remedy(&self) -> bool {
        (0..self.lesson().steps.len()).all(|number| self.is_settled(number))
    }

    pub fn is_last(&self) -> bool {
        self.progress.step + 1 == self.lesson().steps.len()
    }

    pub fn following(&self) -> Option<&'static str> {
        let Source::BuiltIn(name) = self.document.source else { return None };
        let number = LESSONS.iter().position(|lesson| lesson.name == name)?;
        LESSONS.get(number + 1).map(|lesson| lesson.name)
    }

    pub fn choose(&mut self, option: usize) -> Turn {
        let choice = self.options().get(option).filter(|_| self.is_covering());
        let Some(text) = choice.map(|choice| choice.text.clone()) else { return Turn::Stay };
        self.answer_mut().choice = Some(text);
        self.reveal()
    }

    /// Shows the answer of a covered prediction, with or without a choice.
    pub fn reveal(&mut self) -> Turn {
        if !self.is_covering() {
            return Turn::Stay;
        }
        self.answer_mut().shown = true;
        Turn::Show(Box::new(self.document.end(self.progress.step).clone()), true)
    }

    /// Goes to the next step, but neither past a covered prediction nor past the last step. A task that is
    /// not done is shown solved, since the next step refers to its solution.
    pub fn go_on(&mut self) -> Turn {
        if self.is_covering() || self.is_last() {
            return Turn::Stay;
        }
        let (is_skipped, next) = (!self.may_go_on(), self.progress.step + 1);
        if is_skipped { self.enter_from_elsewhere(next) } else { self.enter(next) }
    }

    pub fn go_back(&mut self) -> Turn {
        self.progress.step.checked_sub(1).map_or(Turn::Stay, |number| self.enter_from_elsewhere(number))
    }

    /// Goes on from the step and with the answers that were kept.
    pub fn go_on_from(&mut self, kept: &Progress) -> Turn {
        self.progress = Progress::of(self.lesson(), Some(kept));
        self.begun_before = self.progress.step > 0;
        self.enter_from_elsewhere(self.progress.step)
    }

    pub fn begin_anew(&mut self) -> Turn {
        self.begun_before = false;
        let done = self.progress.done;
        self.progress = Progress { done, ..Progress::of(self.lesson(), None) };
        self.enter(0)
    }

    /// Enters a step while the scene on the screen is not that of the step before.
    fn enter_from_elsewhere(&mut self, number: usize) -> Turn {
        match self.enter(number) {
            Turn::Same => Turn::Show(Box::new(self.preceding_scene()), true),
            turn => turn,
        }
    }

    fn enter(&mut self, number: usize) -> Turn {
        self.progress.step = number;
        (self.hinted, self.tries) = (false, (0, false));
        self.options.clear();
        self.goal.clear();
        let document = Arc::clone(&self.document);
        let (begin, end) = (document.begin(number), document.end(number));
        match self.step() {
            Step::Predict { .. } => {
                let judged = Uncompared(Judged::new(&document, number, end));
                self.options.ask(OptionsQuestion { number, judged }, &self.wake);
                let shown = self.answer().shown;
                Turn::Show(Box::new(if shown { end } else { begin }.clone()), shown)
            }
            Step::Say(_) | Step::Explain(_) if number > 0 => Turn::Same,
            Step::Do { .. } | Step::Say(_) | Step::Explain(_) => Turn::Show(Box::new(begin.clone()), true),
        }
    }

    /// The scene to show in a step that only tells or explains something: that of the last prediction with
    /// its answer, or of the last task, solved.
    fn preceding_scene(&self) -> Document {
        let step = self.progress.step;
        let only_tells = |step: &Step| matches!(step, Step::Say(_) | Step::Explain(_));
        let before = (0..step).rfind(|number| !only_tells(&self.lesson().steps[*number]));
        before.map_or_else(|| self.document.begin(step), |number| self.document.end(number)).clone()
    }

    /// Receives verdicts, and has the scene judged once it stands still; to be called once a frame, at `now`
    /// in s. Returns the time in s until it should be called again.
    pub fn follow(&mut self, session: &Session, now: f64) -> Option<f64> {
        self.options.poll();
        self.goal.poll();
        self.opened.get_or_insert(now);
        if let (true, Outcome::Holds(option)) = (self.answer().shown, self.outcome()) {
            self.answer_mut().outcome = self.options().get(option).map(|option| option.text.clone());
        }
        let is_task = matches!(self.step(), Step::Do { .. });
        let next = if is_task { self.judge_task(session, now) } else { None };
        self.progress.done |= self.is_last() && self.may_go_on();
        next
    }

    /// Has the scene of a task judged. Returns the time in s until it has stood still for long enough.
    fn judge_task(&mut self, session: &Session, now: f64) -> Option<f64> {
        if self.answer().met {
            return None;
        }
        if session.editor.in_gesture() || session.fault().is_some() {
            self.goal.clear();
            return None;
        }
        let scene = session.scene();
        if self.goal.question().is_none_or(|asked| asked.scene != *scene) {
            (self.still_since, self.tries.1) = (now, false);
            let edited = session.editor.runnable();
            let mut judged = Judged::new(&self.document, self.progress.step, &edited);
            let is_built = session.mechanism_of == edited.scene.mechanism;
            judged.mechanism = is_built.then(|| Arc::clone(session.model().mechanism()));
            let question = GoalQuestion { scene: scene.clone(), judged: Uncompared(judged) };
            self.goal.ask(question, &self.wake);
            return Some(STILL);
        }
        // the scene with which the task begins is no try
        let is_try = matches!(self.goal.answer(), Some(TaskState::NotYet(_))) && !self.tries.1;
        if is_try && *scene != self.document.begin(self.progress.step).scene {
            self.tries = (self.tries.0 + 1, true);
        }
        if self.goal.answer() != Some(&TaskState::Met) {
            return None;
        }
        let left = STILL - (now - self.still_since);
        if left > 0.0 {
            return Some(left);
        }
        let settings = arguments(&self.document.begin(self.progress.step).scene, scene).join(", ");
        let answer = self.answer_mut();
        (answer.met, answer.with) = (true, settings);
        None
    }

    pub fn task(&self, session: &Session) -> TaskState {
        if self.answer().met {
            return TaskState::Met;
        }
        if let Some(fault) = session.fault() {
            return TaskState::Unjudged(fault.to_owned());
        }
        match (self.goal.question(), self.goal.answer()) {
            (None, _) => TaskState::Moving,
            // a scene that does the task has to stand still for a while
            (_, None | Some(TaskState::Met)) => TaskState::Judging,
            (_, Some(state)) => state.clone(),
        }
    }

    /// Whether the scene is no longer the one with which the present task was done.
    pub fn was_changed_since(&self, session: &Session) -> bool {
        let begin = &self.document.begin(self.progress.step).scene;
        let (answer, now) = (self.answer(), arguments(begin, session.scene()).join(", "));
        answer.met && !answer.with.is_empty() && answer.with != now
    }

    pub fn outcome(&self) -> Outcome {
        self.options.answer().cloned().unwrap_or(Outcome::Unknown)
    }

    /// The hint of a task, while it is shown: on request, until the task is done.
    pub fn hint(&self) -> Option<&str> {
        self.offered_hint().filter(|_| self.hinted)
    }

    /// The hint that a task can show; none once it is done.
    pub fn offered_hint(&self) -> Option<&str> {
        match self.step() {
            Step::Do { hint, .. } if !self.answer().met => hint.as_deref(),
            _ => None,
        }
    }

    /// Whether the hint is to be offered, since several tries have failed.
    pub fn offers_hint(&self) -> bool {
        self.offered_hint().is_some() && !self.hinted && self.tries.0 >= TRIES
    }

    /// Time in s since the lesson was opened.
    pub fn open_for(&self, now: f64) -> f64 {
        self.opened.map_or(0.0, |opened| now - opened)
    }

    /// Adds votes for an option of a covered prediction, or takes some away.
    pub fn vote(&mut self, option: usize, more: i32) {
        let count = self.options().len();
        if option < count && self.is_covering() {
            let votes = &mut self.answer_mut().votes;
            votes.resize(count, 0);
            votes[option] = votes[option].saturating_add_signed(more).min(MOST_VOTES);
        }
    }

    /// The largest acceleration of the base in m/s^2 in the scenes of all steps under a harmonic drive.
    pub fn largest_push(&self) -> f64 {
        let scenes = (0..self.lesson().steps.len()).flat_map(|step| {
            let document = &self.document;
            [document.begin(step), document.end(step)].map(|document| document.scene.harmonic())
        });
        scenes.flatten().map(|drive| drive.amplitude_g().abs() * STANDARD_GRAVITY).fold(0.0, f64::max)
    }

    /// The solution of a task, as pairs of field and value.
    pub fn solution(&self) -> &[(String, String)] {
        if let Step::Do { solution, .. } = self.step() { solution } else { &[] }
    }

    /// Waits for the verdicts that are being computed, at most `timeout` for each.
    pub fn wait(&mut self, timeout: Duration) {
        self.options.wait(timeout);
        self.goal.wait(timeout);
    }
}
