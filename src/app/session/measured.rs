//! Measured data over computed results: the record, its placement, and the differences between the two.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use crate::app::task::{Background, Each, Identity, Question, progress, told};
use crate::app::words::capital;
use crate::numeric::{extent, short};
use crate::output::Argument;
use crate::questions::Curve;
use crate::scene::{Channel, Excitation, Measured, MeasuredText, Quantity, Timing, Unit, read_record};
use interwell_studies::study::{Comparison, ForceComparison, MeasuredMotion};

use super::Session;
use super::prepared::SharedModel;

/// A measured record with its two chosen columns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRecord {
    /// The path of its file.
    pub path: PathBuf,
    /// The units of its two columns as their files have them; not a part of a question.
    #[serde(skip)]
    pub units: [&'static str; 2],
    /// Times in s, or positions in m.
    pub across: Channel,
    /// Measured values, SI.
    pub values: Channel,
    /// Whether the numbers had a decimal comma.
    pub decimal_commas: bool,
    /// How it was sampled, if it is over time.
    pub timing: Option<Timing>,
    /// Least and greatest value, SI.
    pub range: (f64, f64),
}

impl MeasuredRecord {
    /// The record of two columns of a text; the error is a sentence.
    pub fn of(path: &Path, text: &MeasuredText, chosen: [(usize, Unit); 2]) -> Result<Self, String> {
        let kinds = chosen.map(|(_, unit)| unit.quantity);
        match kinds {
            [Quantity::Time, Quantity::Displacement | Quantity::Velocity | Quantity::Acceleration]
            | [Quantity::Displacement, Quantity::Force] => {}
            [Quantity::Time, _] => {
                return Err("A force over time has nothing to be compared with: choose its position as the \
                            column across, or displacement, velocity or acceleration as the values."
                    .to_owned());
            }
            _ => {
                return Err("Over a position a force is compared with the force curve: choose the force as \
                            the values, or a time as the column across."
                    .to_owned());
            }
        }
        let read = text.channels(chosen).map_err(|problem| {
            let text = sentence(&format!("the file {problem}"));
            text.replacen("The file line", "Line", 1).replacen("The file column", "Column", 1)
        })?;
        let Measured { channels: [across, values], decimal_commas } = read;
        let timing = (across.quantity == Quantity::Time).then(|| Timing::of(&across.values));
        let range = extent(values.values.iter().copied());
        let (path, units) = (path.to_owned(), chosen.map(|(_, unit)| unit.word()));
        Ok(Self { path, units, across, values, decimal_commas, timing, range })
    }

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

/// The name of a file without its folder.
pub fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// A record over computed results, and how it is shifted and stretched in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Overlay {
    pub record: Identity<MeasuredRecord>,
    /// Offset in m that is added to displacements or positions.
    pub offset: f64,
    pub time_scale: f64,
    /// Shift in s that is added to the scaled times.
    pub shift: f64,
    /// The shift in the middle of the slider's range.
    pub centre: f64,
}

impl Overlay {
    /// Whether it is a force over position.
    pub fn is_force(&self) -> bool {
        self.record.values.quantity == Quantity::Force
    }

    /// The options of the command that lays it over a run or a curve in the same way, in the order of
    /// `--help`.
    pub fn arguments(&self) -> Vec<Argument> {
        let MeasuredRecord { path, units, across, values, .. } = &*self.record;
        let changed =
            |name: &str, value: f64, usual: f64| (value != usual).then(|| Argument::of(name, short(value)));
        let mut all = vec![Argument::of("measured", path.to_string_lossy())];
        let offset = changed("offset-mm", self.offset * 1e3, 0.0);
        let columns = if self.is_force() { ["position", "position-unit"] } else { ["time", "time-unit"] };
        if self.is_force() {
            all.extend(offset);
        } else {
            all.extend(changed("shift-s", self.shift, 0.0));
            all.extend(offset.filter(|_| values.quantity == Quantity::Displacement));
            all.extend(changed("time-scale", self.time_scale, 1.0));
        }
        let columns = columns.into_iter().chain(["column", "unit"]);
        let words = [across.column.as_str(), units[0], values.column.as_str(), units[1]];
        all.extend(columns.zip(words).map(|(name, word)| Argument::of(name, word)));
        all
    }

    /// The time in s at which a measured time is shown.
    pub fn time(&self, t: f64) -> f64 {
        t * self.time_scale + self.shift
    }

    /// The motion with a given shift, or with the one that fits best.
    pub fn motion(&self, shift: Option<f64>) -> MeasuredMotion<'_> {
        let (times, channel) = (&*self.record.across.values, &self.record.values);
        MeasuredMotion { times, channel, offset: self.added(), time_scale: self.time_scale, shift }
    }

    /// The positions of a force in m.
    pub fn positions(&self) -> Vec<f64> {
        self.record.across.values.iter().map(|x| x + self.offset).collect()
    }

    /// Offset that is added to the values, SI.
    pub fn added(&self) -> f64 {
        if self.record.values.quantity == Quantity::Displacement { self.offset } else { 0.0 }
    }
}

/// A record, and the model that it is compared with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredQuestion {
    model: SharedModel,
    over: Overlay,
}

impl Question for MeasuredQuestion {
    const NAME: &'static str = "differences";
    type Part = Result<Differences, String>;

    fn answer(&self, cancel: &AtomicBool, _: Each<Self::Part>) -> Option<Self::Part> {
        self.differences(Some(self.over.shift), cancel)
    }
}

/// The shift with which a record fits the run best.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FitQuestion(MeasuredQuestion);

impl Question for FitQuestion {
    const NAME: &'static str = "fit";
    type Part = Result<f64, String>;

    fn answer(&self, cancel: &AtomicBool, _: Each<Self::Part>) -> Option<Self::Part> {
        let shift = |found| match found {
            Differences::Motion(comparison) => comparison.shift,
            Differences::Force(_) => 0.0,
        };
        self.0.differences(None, cancel).map(|found| found.map(shift))
    }
}

impl MeasuredQuestion {
    /// The differences with a given shift, or with the best one; `None` if cancelled.
    fn differences(&self, shift: Option<f64>, cancel: &AtomicBool) -> Option<Result<Differences, String>> {
        let (over, simulation) = (&self.over, self.model.simulation());
        let found = if over.is_force() {
            let (document, mechanism) = (simulation.document(), simulation.mechanism());
            let found = Curve::compared(document, mechanism, &over.positions(), &over.record.values.values);
            found.map(|found| Differences::Force(Box::new(found)))
        } else {
            let found = simulation.compared(&over.motion(shift), &progress(cancel));
            found.map(|found| Differences::Motion(Box::new(found)))
        };
        Some(told(found)?.map_err(|problem| sentence(&problem)))
    }
}

/// The differences between a record and the computed results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Differences {
    Motion(Box<Comparison>),
    Force(Box<ForceComparison>),
}

#[derive(Default)]
pub struct MeasuredData {
    /// The record that is shown over the computed results.
    pub over: Option<Overlay>,
    /// The differences, or why they are not known.
    pub found: Background<MeasuredQuestion, Result<Differences, String>>,
    /// The shift in s that fits best, or why there is none.
    pub fit: Background<FitQuestion, Result<f64, String>>,
}

impl MeasuredData {
    /// Shows a record over the computed results, in place of the previous one.
    pub fn lay(&mut self, record: MeasuredRecord) {
        let record = Identity(Arc::new(record));
        let over = Overlay { record, offset: 0.0, time_scale: 1.0, shift: 0.0, centre: 0.0 };
        *self = Self { over: Some(over), ..Self::default() };
    }

    /// Shifts the record in time; if the shift was `typed`, the slider's range is centred on it.
    pub fn shift_to(&mut self, shift: f64, typed: bool) {
        if let Some(over) = &mut self.over {
            over.shift = shift;
            over.centre = if typed { shift } else { over.centre };
            self.fit.clear();
        }
    }

    pub(super) fn poll(&mut self) {
        self.found.poll();
        self.fit.poll();
        if let Some(Ok(shift)) = self.fit.answer().cloned() {
            self.shift_to(shift, true);
        }
    }
}

pub fn sentence(clause: &str) -> String {
    format!("{}{}", capital(clause), if clause.ends_with('.') { "" } else { "." })
}

impl Session {
    /// Asks for the differences of the record from the present scene; called in every frame that shows them.
    pub fn want_differences(&mut self) {
        let (still, Some(question)) = (self.stands_still(), self.measured_question()) else { return };
        self.measured.found.want(question, still, &self.wake);
    }

    /// Starts the search for the shift with which the record fits the run of the scene best.
    pub fn fit_shift(&mut self) {
        let Some(question) = self.measured_question() else { return };
        self.measured.fit.clear();
        self.measured.fit.ask(FitQuestion(question), &self.wake);
    }

    fn measured_question(&self) -> Option<MeasuredQuestion> {
        Some(MeasuredQuestion { model: self.model.clone(), over: self.measured.over.clone()? })
    }

    /// Shakes the base with the acceleration in the file at `path`, as one undo step. Returns warnings about
    /// the record, each a clause that continues its name. On an error, which is a sentence, nothing changes.
    pub fn shake_with(&mut self, path: &Path, shown: &MeasuredRecord) -> Result<Vec<String>, String> {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let name = absolute.to_str().ok_or("The name of the file is not valid UTF-8: rename it.")?;
        let record = read_record(&absolute).map_err(|problem| {
            format!(
                "A scene names only the file of its record, and has to find the columns of time and \
                 acceleration by the units at the ends of their names, such as `t_s` and `a_g`. The file \
                 {problem}"
            )
        })?;
        let mismatch = "A scene names only the file of its record, and reads other columns than those that \
                        are chosen here, or in other units: name the two columns `t_s` and `accel_m_per_s2`, \
                        or end their names with their units, and no other ones with such units.";
        if (&record.times, &record.accelerations) != (&shown.across.values, &shown.values.values) {
            return Err(mismatch.to_owned());
        }
        let warnings = record.warnings(self.scene().run.duration_s);
        let excitation = Excitation::Recorded { path: name.to_owned(), record: Some(Arc::new(record)) };
        self.edit_once(|scene| scene.excitation = excitation);
        self.apply();
        self.restart();
        Ok(warnings)
    }
}
