//! Lessons: whether a task is done, which options hold, and whether a lesson is consistent.

mod judge;
mod subject;

use std::rc::Rc;
use std::sync::Arc;

use crate::mechanics::Mechanism;
use crate::numeric::short;
use crate::questions::{Error, Progress};
use crate::scene::lesson::{Condition, Lesson, LessonDocument, Step};
use crate::scene::{Files, Scene};
use crate::study::{Said, Task};
use crate::system::threads::Pool;
pub use judge::{Lack, Value, goal_lack, result_fields};
use judge::{Unjudged, holds, options_that_hold};
pub use subject::Subject;

/// Runs lessons, and reports whether their tasks and predictions hold.
#[doc(hidden)]
pub fn check_lessons(lessons: &[LessonDocument], progress: &Progress) -> Result<Vec<LessonReport>, Error> {
    let task = progress.silent();
    let reports = progress
        .pool(|pool| pool.map(lessons.len(), |number| check_lesson(&lessons[number], Some(pool), &task)))?;
    Ok(reports?)
}

impl From<Unjudged> for Error {
    fn from(error: Unjudged) -> Self {
        match error {
            Unjudged::Cancelled => Self::Cancelled,
            Unjudged::Scene { .. } => {
                Self::Failed { scene: "a scene of the lesson".to_owned(), problem: Said::new(error) }
            }
        }
    }
}

/// A step of a lesson, and the scene that is judged in it.
#[doc(hidden)]
#[derive(Debug, Clone)]
pub struct JudgedStep<'a> {
    /// The lesson.
    pub lesson: &'a Lesson,
    /// Number of the step, from 0.
    pub number: usize,
    /// The scenes with which the step begins and that is judged, each with its files.
    pub scenes: [(&'a Scene, &'a Files); 2],
    /// The mechanism of the second one, where it has been built.
    pub mechanism: Option<&'a Arc<Mechanism>>,
}

impl JudgedStep<'_> {
    /// Which options of its prediction hold.
    pub fn options(&self, progress: &Progress) -> Result<Vec<bool>, Error> {
        self.judged(progress, options_that_hold)
    }

    /// What the scene lacks for the goal of its task.
    pub fn lack(&self, progress: &Progress) -> Result<Option<Lack>, Error> {
        self.judged(progress, goal_lack)
    }

    fn judged<T>(
        &self,
        progress: &Progress,
        verdict: impl FnOnce(&Step, &Subject<'_>, &Subject<'_>) -> Result<T, Unjudged>,
    ) -> Result<T, Error> {
        let (lesson, task) = (self.lesson, progress.silent());
        let [before, mut subject] =
            self.scenes.map(|(scene, files)| Subject::new(scene, files, lesson, &task));
        if let Some(mechanism) = self.mechanism {
            subject = subject.with_mechanism(Arc::clone(mechanism));
        }
        Ok(verdict(&lesson.steps[self.number], &subject, &before)?)
    }
}

/// Relative change of a bound that shows whether a verdict is close to it.
const MOVED: f64 = 0.01;

/// A fault of a lesson, or a bound that is close to one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LessonFinding {
    /// Number of the step, from 0.
    pub step: usize,
    /// Path of the field in the lesson: `steps.2.goal`.
    pub field: String,
    /// The problem.
    pub problem: String,
}

/// Result of the check of a lesson.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LessonReport {
    /// Number of predictions.
    pub predictions: usize,
    /// Number of tasks.
    pub tasks: usize,
    /// Faults: a start that meets its goal, a solution that does not, or not exactly one right option.
    pub wrong: Vec<LessonFinding>,
    /// Bounds for which a change by 1 % changes a verdict.
    pub warnings: Vec<LessonFinding>,
}

/// Checks a lesson: the start of every task must fail, its solution must pass, and exactly one option of
/// every prediction must hold. This is repeated with each bound changed by 1 % up and down, except bounds on
/// fields of the scene that no control of the lesson changes, which are exact settings.
pub fn check_lesson(
    document: &LessonDocument,
    pool: Option<&Pool>,
    task: &Task,
) -> Result<LessonReport, Unjudged> {
    let mut report = LessonReport::default();
    let mut last: Option<Rc<Subject>> = None;
    for number in 0..document.lesson.steps.len() {
        // a step begins with the final scene of the step before, unless it sets another one
        let [begin, end] = [document.begin(number), document.end(number)].map(|stage| {
            let same = last.take().filter(|last| last.is_of(&stage.scene, &stage.files));
            let new = || Rc::new(Subject::new(&stage.scene, &stage.files, &document.lesson, task).on(pool));
            Rc::clone(last.insert(same.unwrap_or_else(new)))
        });
        check_step(&mut report, document, number, (&begin, &end))?;
    }
    Ok(report)
}

fn check_step(
    report: &mut LessonReport,
    document: &LessonDocument,
    number: usize,
    (begin, end): (&Subject, &Subject),
) -> Result<(), Unjudged> {
    let lesson = &document.lesson;
    let finding = |part: &str, problem: String| {
        let field = format!("steps.{number}.{part}");
        LessonFinding { step: number, field, problem }
    };
    let mut near = |part: &str, condition: &Condition, subject: &Subject| {
        let turned = turned_by(condition, &lesson.controls, subject, begin)?;
        report.warnings.extend(turned.into_iter().map(|problem| finding(part, problem)));
        Ok(())
    };
    let step = &lesson.steps[number];
    match step {
        Step::Say(_) | Step::Explain(_) => {}
        Step::Predict { options, .. } => {
            report.predictions += 1;
            let hold = options_that_hold(step, end, begin)?;
            let right: Vec<&str> =
                options.iter().zip(&hold).filter(|pair| *pair.1).map(|pair| pair.0.text.as_str()).collect();
            if right.len() != 1 {
                let problem = match right.len() {
                    0 => "none of the options holds; exactly one must".to_owned(),
                    _ => format!("these options hold, and only one may: {}", right.join("; ")),
                };
                report.wrong.push(finding("options", problem));
            }
            for (index, option) in options.iter().enumerate() {
                near(&format!("options.{index}.holds"), &option.holds, end)?;
            }
        }
        Step::Do { goal, .. } => {
            report.tasks += 1;
            if goal_lack(step, begin, begin)?.is_none() {
                report.wrong.push(finding("goal", "is met before anything is done".to_owned()));
            }
            if goal_lack(step, end, begin)?.is_some() {
                report.wrong.push(finding("solution", "does not meet the goal".to_owned()));
            }
            near("goal", goal, begin)?;
            near("goal", goal, end)?;
        }
    }
    Ok(())
}

/// The bounds of a condition whose change changes its verdict, one sentence each.
fn turned_by(
    condition: &Condition,
    controls: &[String],
    subject: &Subject,
    before: &Subject,
) -> Result<Vec<String>, Unjudged> {
    let mut bounds = Vec::new();
    condition.clone().for_each_bound(&mut |field, bound| bounds.push((field.to_owned(), *bound)));
    let verdict = holds(condition, subject, before)?;
    let mut turned = Vec::new();
    for (index, (field, bound)) in bounds.iter().enumerate() {
        let of_scene = field.strip_prefix("scene.");
        if of_scene.is_some_and(|path| !controls.iter().any(|control| control == path)) {
            continue;
        }
        for factor in [1.0 - MOVED, 1.0 + MOVED] {
            let (mut moved, mut place) = (condition.clone(), 0);
            moved.for_each_bound(&mut |_, bound| {
                if place == index {
                    *bound *= factor;
                }
                place += 1;
            });
            if holds(&moved, subject, before)? != verdict {
                let to = short(bound * factor);
                turned.push(format!("a bound of {to} on {field} in place of {bound} turns the verdict"));
            }
        }
    }
    Ok(turned)
}
