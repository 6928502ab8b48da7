//! Lessons: sequences of texts, predictions and tasks for a student.
//!
//! A lesson names a scene and changes it by the same dotted paths as `--set`. Its steps show a text, ask for
//! a prediction, set a task, or explain. Predictions and tasks are judged by conditions on the summary of a
//! run, so that the simulation decides which answer is right. [`LessonDocument::load`] reads a lesson and
//! reports all faults at once; `study::check_lesson` runs it.

mod check;
mod condition;
mod document;

use serde::{Deserialize, Serialize};

use super::data::SweepAxis;

pub use check::ResultField;
pub use condition::Condition;
pub use document::{LessonDocument, LessonError};

/// Version of the format.
pub const LESSON_FORMAT: u32 = 1;

/// Largest number of characters of a step's text, which fit on two lines of the window.
pub const MAX_STEP_LENGTH: usize = 240;
/// Largest number of characters of an option.
pub const MAX_OPTION_LENGTH: usize = 80;
/// Largest number of characters of a reply to a choice.
pub const MAX_REPLY_LENGTH: usize = 160;

/// A lesson in the form of its file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lesson {
    /// Version of the format: [`LESSON_FORMAT`].
    pub format: u32,
    /// One line that names the lesson.
    pub title: String,
    /// What a student can explain afterwards.
    pub goal: String,
    /// Duration in minutes.
    pub minutes: u32,
    /// Name of a preset, or path of a scene in the folder of the lesson's file.
    pub scene: String,
    /// Changes to the scene: field and value, as `--set` takes them.
    #[serde(default)]
    pub set: Vec<(String, String)>,
    /// Paths of the fields whose controls are shown; all others are hidden. `stops` is the switch.
    #[serde(default)]
    pub controls: Vec<String>,
    /// The views that are shown.
    pub views: Vec<LessonView>,
    /// Playing speed relative to real time; the default is that of the scene.
    #[serde(default)]
    pub speed: Option<f64>,
    /// For fields `mean.` and `error.`: the noise is run with seeds 1 to this one.
    #[serde(default)]
    pub seeds: Option<u32>,
    /// For fields `up.`, `down.` and `walk.`: the field that is walked up and down, where each run starts
    /// from the final state of the previous one.
    #[serde(default)]
    pub walk: Option<SweepAxis>,
    /// The steps in order.
    pub steps: Vec<Step>,
    /// The misconception that the lesson corrects.
    pub misconception: String,
    /// Notes for the lecturer, shown only on request.
    pub lecturer: String,
}

impl Lesson {
    /// The conditions of its steps.
    pub fn conditions(&self) -> impl Iterator<Item = &Condition> {
        self.steps.iter().flat_map(Step::conditions)
    }
}

/// A view that a lesson shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LessonView {
    /// The mechanism as a drawing.
    Mechanism,
    /// The potential with the mass on it.
    Well,
    /// Displacement over time.
    Displacement,
    /// The scene as it was opened, compared with the present one.
    #[serde(alias = "BeforeNow")]
    Compare,
    /// Velocity over displacement.
    PhasePortrait,
    /// The force that holds the mass, over displacement.
    ForceCurve,
    /// The energy balance.
    Energy,
    /// Velocity over time.
    Velocity,
    /// Acceleration of the base over time.
    BaseAcceleration,
    /// A result over a grid of two fields.
    Map,
    /// One field walked up and down.
    UpAndDown,
    /// Basins of attraction.
    Basins,
    /// Spectrum of the motion.
    Spectrum,
}

/// One step of a lesson.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Step {
    /// Shows a text.
    Say(String),
    /// Asks for a prediction. The answer is hidden until an option is chosen.
    Predict {
        /// The question.
        ask: String,
        /// Changes to the scene for the answer, applied when it is revealed.
        #[serde(default)]
        set: Vec<(String, String)>,
        /// The options; exactly one of them holds.
        options: Vec<Choice>,
    },
    /// Sets a task.
    Do {
        /// The task.
        ask: String,
        /// Condition for success, judged by a full run from the scene's start.
        goal: Condition,
        /// A hint, shown on request or after a while.
        #[serde(default)]
        hint: Option<String>,
        /// Changes to the scene that meet the goal.
        solution: Vec<(String, String)>,
        /// Changes to the scene when the step begins.
        #[serde(default)]
        set: Vec<(String, String)>,
    },
    /// Explains the result.
    Explain(String),
}

/// An option of a prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// The text, which continues the question.
    pub text: String,
    /// Condition under which the option is correct.
    pub holds: Condition,
    /// A reply to whoever has chosen the option where it does not hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reply: Option<String>,
}

impl Step {
    /// Its text, question or task.
    pub fn text(&self) -> &str {
        match self {
            Self::Say(text) | Self::Explain(text) => text,
            Self::Predict { ask, .. } | Self::Do { ask, .. } => ask,
        }
    }

    /// The conditions of its options, or its goal.
    pub fn conditions(&self) -> Vec<&Condition> {
        match self {
            Self::Say(_) | Self::Explain(_) => Vec::new(),
            Self::Predict { options, .. } => options.iter().map(|option| &option.holds).collect(),
            Self::Do { goal, .. } => vec![goal],
        }
    }

    /// All texts that it shows.
    fn texts_mut(&mut self) -> Vec<&mut String> {
        match self {
            Self::Say(text) | Self::Explain(text) => vec![text],
            Self::Predict { ask, options, .. } => {
                let of_options = options
                    .iter_mut()
                    .flat_map(|option| [&mut option.text].into_iter().chain(&mut option.reply));
                [ask].into_iter().chain(of_options).collect()
            }
            Self::Do { ask, hint, .. } => [ask].into_iter().chain(hint).collect(),
        }
    }
}

/// A built-in lesson.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltInLesson {
    /// Name of its file without extension: a number and a few words.
    pub name: &'static str,
    /// The lesson's text.
    pub text: &'static str,
}

macro_rules! lessons {
    ($($name:literal)*) => {
        /// The built-in lessons, in the order of a course.
        pub static LESSONS: &[BuiltInLesson] = &[$(BuiltInLesson {
            name: $name,
            text: include_str!(concat!("../../../lessons/", $name, ".ron")),
        }),*];
    };
}

lessons! {
    "01-two-wells-and-a-hill"
    "02-shake-it-over"
    "03-a-stop-that-helps"
    "04-letting-go-is-not-crossing"
    "05-the-price-of-a-stop"
    "06-bouncy-or-dead"
    "07-a-coin-toss"
    "08-design-it"
    "09-up-is-not-down"
    "10-noise-has-no-rhythm"
}

/// Template for a new lesson.
pub static TEMPLATE: &str = include_str!("../../../lessons/template.ron");

impl BuiltInLesson {
    /// The lesson of that name, which may also be its number or its words alone.
    pub fn find(name: &str) -> Option<&'static Self> {
        LESSONS.iter().find(|lesson| {
            let (number, words) = lesson.name.split_once('-').unwrap_or(("", lesson.name));
            lesson.name == name
                || words == name
                || number.trim_start_matches('0') == name.trim_start_matches('0')
        })
    }
}

fn names() -> String {
    LESSONS.iter().map(|lesson| lesson.name).collect::<Vec<_>>().join(", ")
}
