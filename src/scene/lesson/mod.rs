//! Lessons: what a student is told, asks the motion, and does.
//!
//! A lesson names a scene and changes it by the same dotted paths as `--set`. Its steps tell something, ask
//! for a prediction, set a task, or explain; what a prediction and a task come to is said by conditions on
//! the summary of a run, so that the simulation is the answer key. [`LessonDocument::load`] reads one and
//! says all that is wrong with it at once; `study::check_lesson` runs it.

mod check;
mod condition;
mod document;
mod library;
mod stage;

use serde::Deserialize;

use super::data::SweepAxis;

pub use check::ResultField;
pub use condition::Condition;
pub use document::{LessonDocument, LessonError};
pub use library::{BuiltInLesson, LESSONS, TEMPLATE};

/// The version of the format.
pub const LESSON_FORMAT: u32 = 1;

/// The most characters of a step's text: as many as two lines of the window hold.
pub const LONGEST_STEP: usize = 240;
/// The most characters of an option.
pub const LONGEST_OPTION: usize = 80;

/// A lesson as its file has it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lesson {
    /// Version of the format: [`LESSON_FORMAT`].
    pub format: u32,
    /// One line that names the lesson.
    pub title: String,
    /// What a student can say afterwards.
    pub goal: String,
    /// How long it takes, in minutes.
    pub minutes: u32,
    /// Name of a preset, or path of a scene beside the lesson's file.
    pub scene: String,
    /// Changes to the scene: field and value, as `--set` takes them.
    #[serde(default)]
    pub set: Vec<(String, String)>,
    /// Paths of the fields whose controls are shown; all others are hidden. `stops` is the switch.
    #[serde(default)]
    pub controls: Vec<String>,
    /// The views that are shown.
    pub views: Vec<LessonView>,
    /// Playing speed relative to real time; left out, that of the scene.
    #[serde(default)]
    pub speed: Option<f64>,
    /// For fields `mean.` and `error.`: seeds 1 to this one of the noise are run.
    #[serde(default)]
    pub seeds: Option<u32>,
    /// For fields `up.`, `down.` and `walk.`: the field that is walked up and down, each run going on from
    /// where the one before was.
    #[serde(default)]
    pub walk: Option<SweepAxis>,
    /// What happens, in this order.
    pub steps: Vec<Step>,
    /// What students think before.
    pub misconception: String,
    /// Notes for the lecturer; never on the projector by themselves.
    pub lecturer: String,
}

impl Lesson {
    /// The conditions of its steps.
    pub fn conditions(&self) -> impl Iterator<Item = &Condition> {
        self.steps.iter().flat_map(|step| match step {
            Step::Say(_) | Step::Explain(_) => Vec::new(),
            Step::Predict { options, .. } => options.iter().map(|option| &option.holds).collect(),
            Step::Do { goal, .. } => vec![goal],
        })
    }
}

/// A view that a lesson shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum LessonView {
    /// The mechanism as a drawing.
    Mechanism,
    /// The potential with the mass on it.
    Well,
    /// Displacement over time.
    Displacement,
    /// The state before the last gesture against the present one.
    BeforeNow,
    /// Velocity over displacement.
    PhasePortrait,
    /// The force that holds the mass, over displacement.
    ForceCurve,
    /// Where the energy went.
    Energy,
    /// Velocity over time.
    Velocity,
    /// Acceleration of the base over time.
    BaseAcceleration,
    /// What every combination of two fields comes to.
    Map,
    /// One field turned up and down.
    UpAndDown,
    /// Where the motion goes from every start.
    Basins,
    /// What oscillations the motion is made of.
    Spectrum,
}

/// One step of a lesson.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Step {
    /// Tells something.
    Say(String),
    /// Asks what will happen. Until an option is chosen nothing of the answer is shown.
    Predict {
        /// The question.
        ask: String,
        /// Changes to the scene that the answer comes from; made when it is revealed.
        #[serde(default)]
        set: Vec<(String, String)>,
        /// What may be chosen; exactly one holds.
        options: Vec<Choice>,
    },
    /// Sets a task.
    Do {
        /// The task.
        ask: String,
        /// When it is done, judged on a full run from the scene's start.
        goal: Condition,
        /// Shown on request, or when it takes long.
        #[serde(default)]
        hint: Option<String>,
        /// Changes to the scene with which the goal is met.
        solution: Vec<(String, String)>,
        /// Changes to the scene with which the step begins.
        #[serde(default)]
        set: Vec<(String, String)>,
    },
    /// Explains what was seen.
    Explain(String),
}

/// An option of a prediction.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// What it says; the question goes on with it.
    pub text: String,
    /// What holds where it is right.
    pub holds: Condition,
}

impl Step {
    /// What it says first: its text, question or task.
    pub fn text(&self) -> &str {
        match self {
            Self::Say(text) | Self::Explain(text) => text,
            Self::Predict { ask, .. } | Self::Do { ask, .. } => ask,
        }
    }

    /// All texts of it that a person reads.
    fn texts_mut(&mut self) -> Vec<&mut String> {
        match self {
            Self::Say(text) | Self::Explain(text) => vec![text],
            Self::Predict { ask, options, .. } => {
                [ask].into_iter().chain(options.iter_mut().map(|own| &mut own.text)).collect()
            }
            Self::Do { ask, hint, .. } => [ask].into_iter().chain(hint).collect(),
        }
    }
}
