//! Questions of the open scene about its measured data, and the drive that they may be.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::app::session::Session;
use crate::scene::{Excitation, Quantity, Record, read_record};
use crate::study::{MeasuredMotion, NoComparison, compare, compare_force};

use super::{Differences, MeasuredQuestion, MeasuredRecord, sentence};

impl Session {
    /// Asks by how much the record differs from the scene as it stands, in a frame that shows it.
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

    /// Has the shift looked for with which the record fits the run of the scene best.
    pub fn fit_shift(&mut self) {
        let Some(over) = self.measured.over.clone() else { return };
        let (model, scene) = (Arc::clone(&self.model), Arc::new(self.built.clone()));
        let question = MeasuredQuestion { model, scene, over };
        self.measured.no_fit = None;
        self.measured.fit.ask(&self.wake, move |cancel| {
            let shift = |found| match found {
                Differences::Motion(own) => own.shift,
                Differences::Force(_) => 0.0,
            };
            differences(&question, None, cancel).map(|found| found.map(shift))
        });
    }

    /// Has the acceleration in the file at `path` shake the base; one step of undo. Returns what to know of
    /// the record, each a clause that continues its name. An error is a sentence, and changes nothing.
    pub fn shake_with(&mut self, path: &Path, laid: &MeasuredRecord) -> Result<Vec<String>, String> {
        let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let named = whole.to_str().ok_or("The name of the file is not valid UTF-8: rename it.")?;
        let record = read_record(&whole).map_err(|problem| {
            format!(
                "A scene knows its record by the file alone, and has to find the columns of time and \
                 acceleration by the units at the ends of their names, such as `t_s` and `a_g`. The file \
                 {problem}"
            )
        })?;
        let other = "A scene knows its record by the file alone, and reads other columns than those that \
                     are chosen here, or in other units: name the two columns `t_s` and `accel_m_per_s2`, \
                     or end their names with their units, and no other ones with such units.";
        if (&record.times, &record.accelerations) != (&laid.across.values, &laid.values.values) {
            return Err(other.to_owned());
        }
        let warnings = record.warnings(self.scene().run.duration_s);
        let excitation = recorded(named, record);
        self.edit_once(|scene| scene.excitation = excitation);
        self.apply();
        self.restart();
        Ok(warnings)
    }
}

fn recorded(path: &str, record: Record) -> Excitation {
    Excitation::Recorded { path: path.to_owned(), record: Some(Arc::new(record)) }
}

/// By how much the record differs with this shift, or with the best one; none where it was cancelled.
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
    let own = MeasuredMotion { times: across, channel, offset, time_scale, shift };
    match compare(scene, model, &own, cancel) {
        Ok(found) => Some(Ok(Differences::Motion(Box::new(found)))),
        Err(NoComparison::Cancelled) => None,
        Err(problem) => Some(Err(sentence(&problem.to_string()))),
    }
}
