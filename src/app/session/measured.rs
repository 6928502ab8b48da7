//! Measured data over the computed motion: the record, how it is laid over it, and by how much the two
//! differ.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::app::task::{Background, Identity};
use crate::dynamics::Model;
use crate::numeric::{extent, short};
use crate::scene::{
    Channel, Excitation, Measured, MeasuredText, Quantity, Record, Scene, Timing, Unit, read_record,
};
use crate::study::{Comparison, ForceComparison, MeasuredMotion, NoComparison, compare, compare_force};

use super::Session;

/// A measured record whose columns are chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredRecord {
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
        let kinds = chosen.map(|(_, unit)| unit.quantity);
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
        let timing = (across.quantity == Quantity::Time).then(|| Timing::of(&across.values));
        let (name, range) = (name.to_owned(), extent(values.values.iter().copied()));
        Ok(Self { name, across, values, decimal_commas, timing, range })
    }

    /// How it was sampled, as a sentence.
    pub fn describe(&self) -> String {
        let commas = if self.decimal_commas { ", with decimal commas" } else { "" };
        match &self.timing {
            Some(timing) => format!("{}{commas}.", timing.describe()),
            None => {
                let (low, high) = extent(self.across.values.iter().map(|x| x * 1e3));
                let (low, high) = (short(low), short(high));
                format!("{} samples from {low} to {high} mm{commas}.", self.across.values.len())
            }
        }
    }
}

/// A record over the computed motion, and how it is moved and stretched in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    pub record: Arc<MeasuredRecord>,
    /// What is added to displacements or positions, in m.
    pub offset: f64,
    /// What the times are multiplied by.
    pub time_scale: f64,
    /// What is added to them then, in s.
    pub shift: f64,
    /// The shift in s at the middle of its slider.
    pub centre: f64,
}

impl Overlay {
    /// The time in s at which a measured time lies.
    pub fn time(&self, t: f64) -> f64 {
        t * self.time_scale + self.shift
    }

    /// What is added to the values, SI.
    pub fn added(&self) -> f64 {
        added(&self.record.values, self.offset)
    }
}

/// An offset in m is one of displacements alone.
fn added(channel: &Channel, offset: f64) -> f64 {
    if channel.quantity == Quantity::Displacement { offset } else { 0.0 }
}

/// What a record is compared with, and how it is laid over it.
#[derive(Clone, PartialEq)]
pub struct MeasuredQuestion {
    model: Identity<Model>,
    record: Identity<MeasuredRecord>,
    offset: f64,
    time_scale: f64,
    shift: f64,
}

/// The numbers in which a record and the computed motion differ.
#[derive(Debug, Clone, PartialEq)]
pub enum Differences {
    Motion(Box<Comparison>),
    Force(Box<ForceComparison>),
}

#[derive(Default)]
pub struct MeasuredData {
    /// The record that lies over the computed motion.
    pub over: Option<Overlay>,
    /// By how much the two differ, or why that is not known.
    pub found: Background<MeasuredQuestion, Result<Differences, String>>,
    /// The shift in s that fits best, or why there is none.
    fit: Background<MeasuredQuestion, Result<f64, String>>,
    /// Why no shift was found.
    pub no_fit: Option<String>,
}

impl MeasuredData {
    /// Lays a record over the computed motion, in place of the one before.
    pub fn lay(&mut self, record: MeasuredRecord) {
        let record = Arc::new(record);
        let over = Overlay { record, offset: 0.0, time_scale: 1.0, shift: 0.0, centre: 0.0 };
        *self = Self { over: Some(over), ..Self::default() };
    }

    /// Moves the record in time; where the shift was `typed`, it becomes the middle of the slider.
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

/// A clause with its first letter in upper case and a full stop.
pub fn sentence(clause: &str) -> String {
    let mut letters = clause.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}{}", letters.as_str(), if clause.ends_with('.') { "" } else { "." })
}

impl Session {
    /// Asks by how much the record differs from the scene as it stands, in a frame that shows it.
    pub fn want_differences(&mut self) {
        let Some(question) = self.measured_question() else { return };
        let (still, scene) = (self.stands_still(), self.built.clone());
        self.measured.found.want(question, still, &self.wake, move |question, cancel, _| {
            differences(question, &scene, Some(question.shift), cancel)
        });
    }

    /// Looks for the shift with which the record fits the run of the scene best.
    pub fn fit_shift(&mut self) {
        let Some(question) = self.measured_question() else { return };
        let scene = self.built.clone();
        self.measured.no_fit = None;
        self.measured.fit.ask(question, &self.wake, move |question, cancel, _| {
            let shift = |found| match found {
                Differences::Motion(comparison) => comparison.shift,
                Differences::Force(_) => 0.0,
            };
            differences(question, &scene, None, cancel).map(|found| found.map(shift))
        });
    }

    fn measured_question(&self) -> Option<MeasuredQuestion> {
        let Overlay { record, offset, time_scale, shift, .. } = self.measured.over.clone()?;
        let model = Identity(Arc::clone(&self.model));
        Some(MeasuredQuestion { model, record: Identity(record), offset, time_scale, shift })
    }

    /// Shakes the base with the acceleration in the file at `path`; one step of undo. Returns what to know of
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

/// By how much the record differs from the run of `scene` with this shift, or with the best one; none where
/// it was cancelled.
fn differences(
    question: &MeasuredQuestion,
    scene: &Scene,
    shift: Option<f64>,
    cancel: &AtomicBool,
) -> Option<Result<Differences, String>> {
    let MeasuredQuestion { model: Identity(model), record: Identity(record), offset, time_scale, .. } =
        question;
    let (across, channel) = (&record.across.values, &record.values);
    if channel.quantity == Quantity::Force {
        let positions: Vec<f64> = across.iter().map(|x| x + offset).collect();
        let found = compare_force(model.mechanism(), &positions, &channel.values);
        return Some(match found {
            Ok(found) => Ok(Differences::Force(Box::new(found))),
            Err(problem) => Err(sentence(&problem.to_string())),
        });
    }
    let (offset, time_scale) = (added(channel, *offset), *time_scale);
    let measured = MeasuredMotion { times: across, channel, offset, time_scale, shift };
    match compare(scene, model, &measured, cancel) {
        Ok(found) => Some(Ok(Differences::Motion(Box::new(found)))),
        Err(NoComparison::Cancelled) => None,
        Err(problem) => Some(Err(sentence(&problem.to_string()))),
    }
}
