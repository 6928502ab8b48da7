//! The session's comparisons with measured data, and the use of a measured acceleration as the drive.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::app::session::Session;
use crate::scene::{Excitation, Quantity, Record, read_record};
use crate::study::{MeasuredMotion, NoComparison, compare, compare_force};

use super::{Differences, MeasuredQuestion, MeasuredRecord, sentence};

impl Session {
    /// Asks for the differences of the record from the present scene; called in every frame that shows them.
    pub fn want_differences(&mut self) {
        let Some(over) = self.measured.over.clone() else { return };
        let still = self.stands_still();
        let (model, scene) = (Arc::clone(&self.model), Arc::new(self.built.clone()));
        let wake = Arc::clone(&self.wake);
        let question = MeasuredQuestion { model, scene, over };
        self.measured.found.want(&question, still, &wake, |question, cancel, each| {
            if let Some(found) = differences(question, Some(question.over.shift), cancel) {
                each(found);
            }
        });
    }

    /// Starts the search for the shift with which the record fits the run of the scene best.
    pub fn fit_shift(&mut self) {
        let Some(over) = self.measured.over.clone() else { return };
        let (model, scene) = (Arc::clone(&self.model), Arc::new(self.built.clone()));
        let question = MeasuredQuestion { model, scene, over };
        self.measured.no_fit = None;
        self.measured.fit.ask(&self.wake, move |cancel| {
            let shift = |found| match found {
                Differences::Motion(comparison) => comparison.shift,
                Differences::Force(_) => 0.0,
            };
            differences(&question, None, cancel).map(|found| found.map(shift))
        });
    }

    /// Shakes the base with the acceleration in the file at `path`, as one undo step. Returns warnings about
    /// the record, each a clause that continues its name. On an error, which is a sentence, nothing changes.
    pub fn shake_with(&mut self, path: &Path, shown: &MeasuredRecord) -> Result<Vec<String>, String> {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let name = absolute.to_str().ok_or("The name of the file is not valid UTF-8: rename it.")?;
        let record = read_record(&absolute).map_err(|problem| {
            format!(
                "A scene knows its record by the file alone, and has to find the columns of time and \
                 acceleration by the units at the ends of their names, such as `t_s` and `a_g`. The file \
                 {problem}"
            )
        })?;
        let mismatch = "A scene knows its record by the file alone, and reads other columns than those that \
                     are chosen here, or in other units: name the two columns `t_s` and `accel_m_per_s2`, \
                     or end their names with their units, and no other ones with such units.";
        if (&record.times, &record.accelerations) != (&shown.across.values, &shown.values.values) {
            return Err(mismatch.to_owned());
        }
        let warnings = record.warnings(self.scene().run.duration_s);
        let excitation = recorded(name, record);
        self.edit_once(|scene| scene.excitation = excitation);
        self.apply();
        self.restart();
        Ok(warnings)
    }
}

fn recorded(path: &str, record: Record) -> Excitation {
    Excitation::Recorded { path: path.to_owned(), record: Some(Arc::new(record)) }
}

/// The differences with a given shift, or with the best one; `None` if cancelled.
fn differences(
    question: &MeasuredQuestion,
    shift: Option<f64>,
    cancel: &AtomicBool,
) -> Option<Result<Differences, String>> {
    let MeasuredQuestion { model, scene, over } = question;
    let (across, channel) = (&over.record.across.values, &over.record.values);
    if channel.quantity == Quantity::Force {
        let positions: Vec<f64> = across.iter().map(|x| x + over.offset).collect();
        let found = compare_force(model.mechanism(), &positions, &channel.values);
        return Some(match found {
            Ok(found) => Ok(Differences::Force(Box::new(found))),
            Err(problem) => Err(sentence(&problem.to_string())),
        });
    }
    let (offset, time_scale) = (over.added(), over.time_scale);
    let motion = MeasuredMotion { times: across, channel, offset, time_scale, shift };
    match compare(scene, model, &motion, cancel) {
        Ok(found) => Some(Ok(Differences::Motion(Box::new(found)))),
        Err(NoComparison::Cancelled) => None,
        Err(problem) => Some(Err(sentence(&problem.to_string()))),
    }
}
