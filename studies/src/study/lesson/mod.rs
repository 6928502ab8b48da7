//! Verdicts of lessons: whether a task is done, which option of a prediction holds, and whether a lesson is
//! right from its first step to its last.

mod check;
mod fields;
mod judge;
mod subject;

pub use check::{LessonFinding, LessonReport, check_lesson};
pub use fields::Value;
pub use fields::result_fields;
pub use judge::{Lack, Unjudged, goal_lack, options_that_hold};
pub use subject::Subject;
