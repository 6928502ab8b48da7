//! Verdicts of lessons: whether a task is done, which option holds, and whether a whole lesson is right.

mod check;
mod judge;
mod subject;

pub use check::{LessonFinding, LessonReport, check_lesson};
pub use judge::{Lack, Unjudged, Value, goal_lack, options_that_hold, result_fields};
pub use subject::Subject;
