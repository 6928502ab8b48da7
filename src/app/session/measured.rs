//! Measured data over the computed: the record, how it is laid over, and by how much the two differ.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::app::task::Latest;
use crate::dynamics::Model;
use crate::numeric::short;
use crate::scene::{
    Channel, Excitation, Measured, MeasuredText, Quantity, Record, Scene, Timing, Unit, read_record,
};
use crate::study::{Comparison, ForceComparison, MeasuredMotion, NoComparison, compare, compare_force};

use super::Session;
use super::explore::Explored;

/// A measured record whose columns are chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredRecord {
    /// The name of its file.
    pub name: String,
    /// Times in s, or positions in m.
    pub across: Channel,
    /// What was measured, SI.
    pub values: Channel,
    /// Whether the numbers had a decimal comma.
    pub decimal_commas: bool,
    /// How it was sampled, where it is one over time.
    pub timing: Option<Timing>,
    /// Least and greatest value, SI.
    pub range: (f64, f64),
}

impl MeasuredRecord {
    /// The record of two columns of a text, or what is wrong with it as a sentence.
    pub fn of(name: &str, text: &MeasuredText, chosen: [(usize, Unit); 2]) -> Result<Self, String> {
        let kinds = chosen.map(|own| own.1.quantity);
        match kinds {
            [Quantity::Time, Quantity::Displacement | Quantity::Velocity | Quantity::Acceleration]
            | [Quantity::Displacement, Quantity::Force] => {}
            [Quantity::Time, _] => {
                return Err("A force over time has no curve to lie over: choose its position as the column \
                            across, or displacement, velocity or acceleration as the values."
                    .to_owned());
            }
            _ => {
                return Err("Over a position a force is compared with the force curve: choose the force as \
                            the values, or a time as the column across."
                    .to_owned());
            }
        }
        let read = text.channels(chosen).map_err(|problem| {
            let text = problem.to_string();
            format!("The file {text}{}", if text.ends_with('.') { "" } else { "." })
                .replacen("The file line", "Line", 1)
                .replacen("The file column", "Column", 1)
        })?;
        let Measured { channels: [across, values], decimal_commas } = read;
        let least = values.values.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = values.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let timing = (across.quantity == Quantity::Time).then(|| Timing::of(&across.values));
        let (name, range) = (name.to_owned(), (least, greatest));
        Ok(Self { name, across, values, decimal_commas, timing, range })
    }

    /// How it was sampled, as a sentence.
    pub fn describe(&self) -> String {
        let commas = if self.decimal_commas { ", with decimal commas" } else { "" };
        match &self.timing {
            Some(timing) => format!("{}{commas}.", timing.describe()),
            None => {
                let low = self.across.values.iter().copied().fold(f64::INFINITY, f64::min);
                let high = self.across.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let [low, high] = [low, high].map(|own| short(own * 1e3));
                format!("{} samples from {low} to {high} mm{commas}.", self.across.values.len())
            }
        }
    }
}

/// A record over the computed, and how it is moved and stretched in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// The record.
    pub record: Arc<MeasuredRecord>,
    /// What is added to displacements or positions, in m.
    pub offset: f64,
    /// What the times are multiplied by.
    pub time_scale: f64,
    /// What is added to them then, in s.
    pub shift: f64,
    /// The shift around which the slider goes.
    pub centre: f64,
}

impl Overlay {
    /// The time in s at which a measured time lies.
    pub fn time(&self, t: f64) -> f64 {
        t * self.time_scale + self.shift
    }

    /// What is added to the values, SI.
    pub fn added(&self) -> f64 {
        if self.record.values.quantity == Quantity::Displacement { self.offset } else { 0.0 }
    }
}

/// What a record is compared with.
#[derive(Clone)]
pub struct MeasuredQuestion {
    model: Arc<Model>,
    scene: Arc<Scene>,
    over: Overlay,
}

impl PartialEq for MeasuredQuestion {
    fn eq(&self, other: &Self) -> bool {
        let laid = |own: &Overlay| (own.shift, own.time_scale, own.offset);
        Arc::ptr_eq(&self.model, &other.model)
            && Arc::ptr_eq(&self.over.record, &other.over.record)
            && laid(&self.over) == laid(&other.over)
    }
}

/// The numbers in which a record and the computed differ.
#[derive(Debug, Clone, PartialEq)]
pub enum Differences {
    /// Of a motion.
    Motion(Box<Comparison>),
    /// Of a force curve.
    Force(Box<ForceComparison>),
}

/// The measured data of a session.
#[derive(Default)]
pub struct MeasuredData {
    /// The record that lies over the computed.
    pub over: Option<Overlay>,
    /// By how much the two differ, or why that is not known.
    pub found: Explored<MeasuredQuestion, Result<Differences, String>>,
    /// The shift in s that fits best, or why there is none.
    fit: Latest<Result<f64, String>>,
    /// Why no shift was found.
    pub no_fit: Option<String>,
}

impl MeasuredData {
    /// Lays a record over the computed; the one before goes.
    pub fn lay(&mut self, record: MeasuredRecord) {
        let record = Arc::new(record);
        let over = Overlay { record, offset: 0.0, time_scale: 1.0, shift: 0.0, centre: 0.0 };
        *self = Self { over: Some(over), ..Self::default() };
    }

    /// Moves the record in time; the slider goes on around the new place where it was `typed`.
    pub fn shift_to(&mut self, shift: f64, typed: bool) {
        if let Some(over) = &mut self.over {
            over.shift = shift;
            over.centre = if typed { shift } else { over.centre };
            self.fit.clear();
            self.no_fit = None;
        }
    }

    /// Whether the shift that fits best is being looked for.
    pub fn is_fitting(&self) -> bool {
        self.fit.is_running()
    }

    pub(super) fn poll(&mut self) {
        self.found.poll();
        match self.fit.take() {
            Some(Ok(shift)) => self.shift_to(shift, true),
            Some(Err(why)) => self.no_fit = Some(why),
            None => {}
        }
    }
}

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

/// A clause as a sentence.
pub fn sentence(clause: &str) -> String {
    let mut letters = clause.chars();
    let first = letters.next().map(|own| own.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}{}", letters.as_str(), if clause.ends_with('.') { "" } else { "." })
}
