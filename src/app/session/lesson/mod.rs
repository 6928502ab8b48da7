//! An open lesson: its step, what was chosen and done, and what the runs say of it.
//!
//! It holds no scene of its own: it says which one is to be shown, and looks at the one that a hand has
//! changed. A prediction is covered until an option is chosen; which one holds is worked out meanwhile. A
//! task is judged on a full run of the scene once that has stood still.

mod progress;
mod verdict;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Latest, Wake};
use crate::scene::lesson::{Choice, LESSONS, Lesson, LessonDocument, Step};
use crate::scene::{Document, Scene, Source, arguments};
use crate::study::{Lack, Subject, goal_lack, options_that_hold};

use super::Session;

pub use progress::{Answer, Progress, Records, answers_text};
pub use verdict::{Outcome, TaskState};
use verdict::{Verdict, judge, only};

/// For how long in s a scene stands still before a task is done by it.
const STILL: f64 = 0.5;

/// After how long in s a hint comes by itself.
const HINT_AFTER: f64 = 45.0;

/// What is to be on the screen now.
#[derive(Debug)]
pub enum Turn {
    /// What is there; nothing has changed.
    Stay,
    /// What is there, in another step.
    Same,
    /// This scene from its start, playing or standing.
    Show(Box<Document>, bool),
    Leave,
}

pub struct OpenLesson {
    document: Arc<LessonDocument>,
    progress: Progress,
    /// When the step began, in s of the window.
    begun: Option<f64>,
    hinted: bool,
    options: Latest<Verdict<Vec<bool>>>,
    goal: Latest<Verdict<Option<Lack>>>,
    /// The scene that is judged, and since when in s it stands still.
    judged: Option<(Scene, f64)>,
    wake: Wake,
}

impl OpenLesson {
    /// Opens a lesson where it was left; the scene to begin with.
    pub fn open(document: LessonDocument, kept: Option<&Progress>, wake: Wake) -> (Self, Box<Document>) {
        let progress = Progress::of(&document.lesson, kept);
        let mut own = Self {
            document: Arc::new(document),
            progress,
            begun: None,
            hinted: false,
            options: Latest::default(),
            goal: Latest::default(),
            judged: None,
            wake,
        };
        let scene = match own.enter(own.progress.step) {
            Turn::Show(scene, _) => scene,
            _ => Box::new(own.behind()),
        };
        (own, scene)
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

    /// The word of the student's own in a prediction.
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

    /// Whether what other settings would come to is covered: until the first prediction is shown.
    pub fn hides_surveys(&self) -> bool {
        let is_prediction = |step: &Step| matches!(step, Step::Predict { .. });
        let first = self.lesson().steps.iter().position(is_prediction);
        first.is_some_and(|number| !self.is_settled(number))
    }

    /// Whether a step has been answered or done; one that only tells something has.
    pub fn is_settled(&self, number: usize) -> bool {
        match (&self.lesson().steps[number], &self.progress.answers[number]) {
            (Step::Say(_) | Step::Explain(_), _) => true,
            (Step::Predict { .. }, answer) => answer.shown,
            (Step::Do { .. }, answer) => answer.met,
        }
    }

    /// Whether a student goes on from here.
    pub fn may_go_on(&self) -> bool {
        self.is_settled(self.progress.step)
    }

    /// Whether what it would take to cross may be said: once nothing is left to be found out.
    pub fn tells_remedy(&self) -> bool {
        (0..self.lesson().steps.len()).all(|number| self.is_settled(number))
    }

    pub fn is_last(&self) -> bool {
        self.progress.step + 1 == self.lesson().steps.len()
    }

    /// The name of the built-in lesson that comes after this one.
    pub fn following(&self) -> Option<&'static str> {
        let Source::BuiltIn(own) = self.document.source else { return None };
        let number = LESSONS.iter().position(|lesson| lesson.name == own)?;
        LESSONS.get(number + 1).map(|lesson| lesson.name)
    }

    /// Chooses an option of a prediction that is covered.
    pub fn choose(&mut self, option: usize) -> Turn {
        let Some(text) = self.options().get(option).map(|own| own.text.clone()) else { return Turn::Stay };
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

    /// Goes on, whatever is still open in the step: a prediction is shown first, without a choice.
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
            // what is there belongs to a later step
            Turn::Same => Turn::Show(Box::new(self.behind()), true),
            turn => turn,
        }
    }

    /// Where it was left, by what was kept of it.
    pub fn go_on_from(&mut self, kept: &Progress) -> Turn {
        self.progress = Progress::of(self.lesson(), Some(kept));
        match self.enter(self.progress.step) {
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
        (self.begun, self.hinted, self.judged) = (None, false, None);
        self.options.clear();
        self.goal.clear();
        let document = Arc::clone(&self.document);
        let (begin, end) = (document.begin(number), document.end(number));
        match self.step() {
            Step::Predict { .. } => {
                let own = Arc::clone(&document);
                self.options.ask(&self.wake, move |cancel| {
                    let verdict = |step: &Step, subject: Subject<'_>, before: &Subject<'_>| {
                        options_that_hold(step, &subject, before)
                    };
                    judge(&own, number, own.end(number), cancel, verdict)
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

    /// The scene that a step which only tells something comes after: the answer of the prediction before, or
    /// the task, solved where it was done.
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

    /// Takes in verdicts, and has the scene judged once it stands still; to be called once a frame, at `now`
    /// in s. Seconds until it should be called again.
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

    /// Has the scene of a task judged. Seconds until it has stood still for long enough.
    fn judge_task(&mut self, session: &Session, now: f64) -> Option<f64> {
        if self.answer().met {
            return None;
        }
        if session.editor.in_gesture() || session.fault().is_some() {
            self.judged = None;
            self.goal.clear();
            return None;
        }
        let scene = session.scene();
        let since = self.judged.as_ref().filter(|own| own.0 == *scene).map(|own| own.1);
        let Some(since) = since else {
            self.judged = Some((scene.clone(), now));
            let (document, number) = (Arc::clone(&self.document), self.progress.step);
            let (own, mechanism) = (session.editor.runnable(), Arc::clone(session.model().mechanism()));
            let built = session.mechanism_of == own.scene.mechanism;
            self.goal.ask(&self.wake, move |cancel| {
                let verdict = |step: &Step, subject: Subject<'_>, before: &Subject<'_>| match built {
                    true => goal_lack(step, &subject.with_mechanism(mechanism), before),
                    false => goal_lack(step, &subject, before),
                };
                judge(&document, number, &own, cancel, verdict)
            });
            return Some(STILL);
        };
        let stands = now - since;
        if self.goal.current() != Some(&Ok(None)) {
            return None;
        }
        if stands < STILL {
            return Some(STILL - stands);
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
        match (&self.judged, self.goal.current()) {
            (None, _) => TaskState::Moving,
            (_, None) | (_, Some(Ok(None))) => TaskState::Judging,
            (_, Some(Ok(Some(lack)))) => TaskState::NotYet(lack.clone()),
            (_, Some(Err(why))) => TaskState::Unjudged(why.clone()),
        }
    }

    /// Which option of the prediction holds.
    pub fn outcome(&self) -> Outcome {
        only(self.options.current())
    }

    /// The hint of a task, once it was asked for or the task has taken long.
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

    /// Waits for the verdict that is being worked out, at most so long.
    pub fn wait(&mut self, most: Duration) {
        self.options.wait(most);
        self.goal.wait(most);
    }
}
