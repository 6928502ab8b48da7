//! An open lesson: its step, what was chosen and done, and what the runs say about it.
//!
//! It contains no scene: it says which one is to be shown, and looks at the one that a person has changed. The
//! motion is covered until an option of a prediction is chosen; which option is right is worked out meanwhile.
//! A task is judged on a full run of the scene once that has stood still.

mod progress;
mod verdict;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Wake};
use crate::scene::lesson::{Choice, LESSONS, Lesson, LessonDocument, Step};
use crate::scene::{Document, Scene, Source, arguments};
use crate::study::{Lack, Subject, goal_lack, options_that_hold};

use super::Session;

pub use progress::{Answer, Progress, Records, answers_text};
pub use verdict::{Outcome, TaskState};
use verdict::{Verdict, judge, only};

/// Time in s for which a scene has to stand still before it can meet a task.
const STILL: f64 = 0.5;

/// Time in s after which a hint comes by itself.
const HINT_AFTER: f64 = 45.0;

/// What is to be shown after a choice.
#[derive(Debug)]
pub enum Turn {
    /// The same scene in the same step.
    Stay,
    /// The same scene in another step.
    Same,
    /// This scene from its start, and whether it plays.
    Show(Box<Document>, bool),
    Leave,
}

pub struct OpenLesson {
    document: Arc<LessonDocument>,
    progress: Progress,
    /// When the step began, in s of the window.
    begun: Option<f64>,
    hinted: bool,
    /// Which options of the prediction in a step are right.
    options: Background<usize, Verdict<Vec<bool>>>,
    /// What a scene lacks to meet the task; nothing where it meets it.
    goal: Background<Scene, Verdict<Option<Lack>>>,
    /// Time in s of the window since which the scene that is judged stands still.
    still_since: f64,
    wake: Wake,
}

impl OpenLesson {
    /// Opens a lesson where it was left; returns it with the scene to begin with.
    pub fn open(document: LessonDocument, kept: Option<&Progress>, wake: Wake) -> (Self, Box<Document>) {
        let progress = Progress::of(&document.lesson, kept);
        let mut open = Self {
            document: Arc::new(document),
            progress,
            begun: None,
            hinted: false,
            options: Background::default(),
            goal: Background::default(),
            still_since: 0.0,
            wake,
        };
        let scene = match open.enter(open.progress.step) {
            Turn::Show(scene, _) => scene,
            _ => Box::new(open.behind()),
        };
        (open, scene)
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

    /// The name or the path under which its progress is kept.
    pub fn key(&self) -> String {
        Self::key_of(&self.document)
    }

    /// What was done in it so far.
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

    /// The reason that the student gives for a prediction.
    pub fn why_mut(&mut self) -> &mut String {
        &mut self.answer_mut().why
    }

    /// The options of the step; none where it asks for no prediction.
    pub fn options(&self) -> &[Choice] {
        match self.step() {
            Step::Predict { options, .. } => options,
            _ => &[],
        }
    }

    /// Whether the motion and all results are covered: a prediction without a choice.
    pub fn is_covering(&self) -> bool {
        matches!(self.step(), Step::Predict { .. }) && !self.answer().shown
    }

    /// Whether the results of other settings are covered: until the first prediction is shown.
    pub fn hides_surveys(&self) -> bool {
        let is_prediction = |step: &Step| matches!(step, Step::Predict { .. });
        let first = self.lesson().steps.iter().position(is_prediction);
        first.is_some_and(|number| !self.is_settled(number))
    }

    /// Whether a step has been answered or done; one without a question or task always has.
    pub fn is_settled(&self, number: usize) -> bool {
        match (&self.lesson().steps[number], &self.progress.answers[number]) {
            (Step::Say(_) | Step::Explain(_), _) => true,
            (Step::Predict { .. }, answer) => answer.shown,
            (Step::Do { .. }, answer) => answer.met,
        }
    }

    /// Whether the step is done, so that the next one may follow.
    pub fn may_go_on(&self) -> bool {
        self.is_settled(self.progress.step)
    }

    /// Whether it may be said what it would take to cross: once all steps are done.
    pub fn tells_remedy(&self) -> bool {
        (0..self.lesson().steps.len()).all(|number| self.is_settled(number))
    }

    pub fn is_last(&self) -> bool {
        self.progress.step + 1 == self.lesson().steps.len()
    }

    /// The name of the built-in lesson that comes after this one.
    pub fn following(&self) -> Option<&'static str> {
        let Source::BuiltIn(name) = self.document.source else { return None };
        let number = LESSONS.iter().position(|lesson| lesson.name == name)?;
        LESSONS.get(number + 1).map(|lesson| lesson.name)
    }

    /// Chooses an option of a prediction that is covered.
    pub fn choose(&mut self, option: usize) -> Turn {
        let Some(text) = self.options().get(option).map(|choice| choice.text.clone()) else {
            return Turn::Stay;
        };
        if !self.is_covering() {
            return Turn::Stay;
        }
        self.answer_mut().choice = Some(text);
        self.reveal()
    }

    fn reveal(&mut self) -> Turn {
        self.answer_mut().shown = true;
        self.begun = None;
        Turn::Show(Box::new(self.document.end(self.progress.step).clone()), true)
    }

    /// Goes on to the next step, also from one that is not done; the answer of a prediction is shown first.
    pub fn go_on(&mut self) -> Turn {
        if self.is_covering() {
            return self.reveal();
        }
        if self.is_last() {
            return Turn::Leave;
        }
        self.enter(self.progress.step + 1)
    }

    pub fn go_back(&mut self) -> Turn {
        let Some(number) = self.progress.step.checked_sub(1) else { return Turn::Stay };
        match self.enter(number) {
            // the scene that is shown belongs to a later step
            Turn::Same => Turn::Show(Box::new(self.behind()), true),
            turn => turn,
        }
    }

    /// From the first step again, without answers.
    pub fn begin_anew(&mut self) -> Turn {
        let done = self.progress.done;
        self.progress = Progress { done, ..Progress::of(self.lesson(), None) };
        self.enter(0)
    }

    fn enter(&mut self, number: usize) -> Turn {
        self.progress.step = number;
        (self.begun, self.hinted) = (None, false);
        self.options.clear();
        self.goal.clear();
        let document = Arc::clone(&self.document);
        let (begin, end) = (document.begin(number), document.end(number));
        match self.step() {
            Step::Predict { .. } => {
                let document = Arc::clone(&document);
                self.options.ask(number, &self.wake, move |number, cancel, _| {
                    let verdict = |step: &Step, subject: Subject<'_>, before: &Subject<'_>| {
                        options_that_hold(step, &subject, before)
                    };
                    judge(&document, *number, document.end(*number), cancel, verdict)
                });
                match self.answer().shown {
                    true => Turn::Show(Box::new(end.clone()), true),
                    false => Turn::Show(Box::new(begin.clone()), false),
                }
            }
            Step::Do { .. } => Turn::Show(Box::new(begin.clone()), true),
            Step::Say(_) | Step::Explain(_) if number == 0 => Turn::Show(Box::new(begin.clone()), true),
            Step::Say(_) | Step::Explain(_) => Turn::Same,
        }
    }

    /// The scene that is shown in a step without a question or task: that of the last prediction or task before
    /// it, with its answer where it is a prediction or is done.
    fn behind(&self) -> Document {
        let step = self.progress.step;
        for number in (0..step).rev() {
            match &self.lesson().steps[number] {
                Step::Say(_) | Step::Explain(_) => {}
                Step::Do { .. } if !self.is_settled(number) => return self.document.begin(number).clone(),
                Step::Predict { .. } | Step::Do { .. } => return self.document.end(number).clone(),
            }
        }
        self.document.begin(step).clone()
    }

    /// Takes in verdicts, and has the scene judged; to be called once a frame, at `now` in s of the window. The
    /// time in s after which it should be called again.
    pub fn follow(&mut self, session: &Session, now: f64) -> Option<f64> {
        self.options.poll();
        self.goal.poll();
        let begun = *self.begun.get_or_insert(now);
        let mut next = None;
        match self.step() {
            Step::Predict { .. } => {
                if let (true, Outcome::Holds(option)) = (self.answer().shown, self.outcome()) {
                    let text = self.options()[option].text.clone();
                    self.answer_mut().outcome = Some(text);
                }
            }
            Step::Do { hint, .. } => {
                let left = begun + HINT_AFTER - now;
                if hint.is_some() && !self.hinted && !self.answer().met {
                    self.hinted = left <= 0.0;
                    next = Some(left.max(0.0));
                }
                let wait = self.judge_task(session, now);
                next = [next, wait].into_iter().flatten().reduce(f64::min);
            }
            Step::Say(_) | Step::Explain(_) => {}
        }
        self.progress.done |= self.is_last() && self.may_go_on();
        next
    }

    /// Has the scene of a task judged. The time in s until it has stood still for long enough.
    fn judge_task(&mut self, session: &Session, now: f64) -> Option<f64> {
        if self.answer().met {
            return None;
        }
        if session.editor.in_gesture() || session.fault().is_some() {
            self.goal.clear();
            return None;
        }
        let scene = session.scene();
        if self.goal.question() != Some(scene) {
            self.still_since = now;
            let (document, number) = (Arc::clone(&self.document), self.progress.step);
            let (tried, mechanism) = (session.editor.runnable(), Arc::clone(session.model().mechanism()));
            let is_built = session.mechanism_of == tried.scene.mechanism;
            self.goal.ask(scene.clone(), &self.wake, move |_, cancel, _| {
                let verdict = |step: &Step, subject: Subject<'_>, before: &Subject<'_>| match is_built {
                    true => goal_lack(step, &subject.with_mechanism(mechanism), before),
                    false => goal_lack(step, &subject, before),
                };
                judge(&document, number, &tried, cancel, verdict)
            });
            return Some(STILL);
        }
        if self.goal.answer() != Some(&Ok(None)) {
            return None;
        }
        let still_for = now - self.still_since;
        if still_for < STILL {
            return Some(STILL - still_for);
        }
        let with = arguments(&self.document.begin(self.progress.step).scene, scene).join(", ");
        let answer = self.answer_mut();
        (answer.met, answer.with) = (true, with);
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
            (_, None) | (_, Some(Ok(None))) => TaskState::Judging,
            (_, Some(Ok(Some(lack)))) => TaskState::NotYet(lack.clone()),
            (_, Some(Err(why))) => TaskState::Unjudged(why.clone()),
        }
    }

    /// Which option of the prediction is right.
    pub fn outcome(&self) -> Outcome {
        only(self.options.answer())
    }

    /// The hint of a task, once it was wanted or the task has taken long.
    pub fn hint(&self) -> Option<&str> {
        self.offered_hint().filter(|_| self.hinted)
    }

    /// The hint of a task, whether it is shown or not.
    pub fn offered_hint(&self) -> Option<&str> {
        match self.step() {
            Step::Do { hint, .. } => hint.as_deref(),
            _ => None,
        }
    }

    pub fn turn_hint(&mut self) {
        self.hinted = !self.hinted;
    }

    /// The solution of a task: field and value.
    pub fn solution(&self) -> &[(String, String)] {
        match self.step() {
            Step::Do { solution, .. } => solution,
            _ => &[],
        }
    }

    /// Waits for the verdict that is being worked out, for `limit` at the longest.
    pub fn wait(&mut self, limit: Duration) {
        self.options.wait(limit);
        self.goal.wait(limit);
    }
}
