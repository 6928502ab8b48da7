//! Recorded base acceleration.
//!
//! A record is read once, when a document is read or changed, and then travels with its scene, so that the
//! cells of a sweep share it.

use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::columns::{ColumnsError, MOST_ROWS, read_columns};
use super::data::Excitation;
use super::error::Fault;
use super::files::Files;
use super::measured::{Ask, Measured, MeasuredError};
use super::timing::Timing;
use super::unit::Quantity;
use crate::numeric::pieces::{Piece, pieces};

const TIME: &str = "t_s";
const ACCELERATION: &str = "accel_m_per_s2";

/// Samples of base acceleration, linear between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Times in s, strictly increasing; at least two.
    pub times: Vec<f64>,
    /// Accelerations in m/s^2, one for each time.
    pub accelerations: Vec<f64>,
    made: Made,
}

/// What has been made of a record, for all runs that share it.
#[derive(Debug, Default)]
struct Made {
    peak: OnceLock<f64>,
    pieces: Mutex<Vec<(Limits, Arc<Vec<Piece>>)>>,
}

/// Exponents of the powers of two that limits were rounded down to.
type Limits = (i32, i32);

/// Pieces for other limits than these first ones are not kept: a sweep needs a few.
const MOST_KEPT: usize = 16;

impl Clone for Made {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Made {
    /// It follows from the samples.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// What is wrong with the text of a record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecordError {
    /// The columns cannot be read.
    #[error(transparent)]
    Columns(#[from] ColumnsError),
    /// The columns are chosen by their units, and cannot be read.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// Fewer than two samples.
    #[error("has {0} rows of numbers; a record needs at least 2")]
    TooFew(usize),
    /// A time that is not after the one before it.
    #[error(
        "line {line}: {TIME} = {time:e} does not come after {before:e}; times must increase from row to row"
    )]
    NotAfter {
        /// Line of the later row.
        line: usize,
        /// Its time.
        time: f64,
        /// The time before it.
        before: f64,
    },
}

/// Reads the record in the file at `path`, as a scene that names it does; the error is a clause.
pub fn read_record(path: &Path) -> Result<Record, String> {
    let files = Files::default();
    let text = files.read(&path.to_string_lossy()).map_err(|error| error.to_string())?;
    Record::parse(&text).map_err(|error| error.to_string())
}

impl Record {
    /// Of samples at times in s, strictly increasing and at least two, with accelerations in m/s^2.
    pub fn new(times: Vec<f64>, accelerations: Vec<f64>) -> Self {
        Self { times, accelerations, made: Made::default() }
    }

    /// Polynomials in place of its lines whose integrals, in m/s and m, differ by no more than these limits
    /// (rounded down to powers of two); made once and shared.
    pub(crate) fn pieces(&self, limits: (f64, f64)) -> Arc<Vec<Piece>> {
        let exponent = |limit: f64| limit.log2().floor().max(-1000.0) as i32;
        let key = (exponent(limits.0), exponent(limits.1));
        let mut made = self.made.pieces.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = made.iter().find(|own| own.0 == key) {
            return Arc::clone(found);
        }
        let limits = (f64::from(key.0).exp2(), f64::from(key.1).exp2());
        let new = Arc::new(pieces(&self.times, &self.accelerations, limits));
        if made.len() < MOST_KEPT {
            made.push((key, Arc::clone(&new)));
        }
        new
    }

    /// Reads the text of a record: CSV with the columns `t_s,accel_m_per_s2` among others, or with one column
    /// of time and one of acceleration by the units at the ends of their names, as a measured record has it.
    pub fn parse(text: &str) -> Result<Self, RecordError> {
        let columns = match read_columns(text, [TIME, ACCELERATION], MOST_ROWS, false) {
            Err(problem @ ColumnsError::MissingColumn { .. }) => {
                return match Self::by_units(text) {
                    // no unit tells anything
                    Err(RecordError::Measured(MeasuredError::NoColumn {
                        quantity: Quantity::Time, ..
                    })) => Err(problem.into()),
                    read => read,
                };
            }
            columns => columns?,
        };
        if columns.rows.len() < 2 {
            return Err(RecordError::TooFew(columns.rows.len()));
        }
        for (i, pair) in columns.rows.windows(2).enumerate() {
            let (before, time) = (pair[0][0], pair[1][0]);
            if time <= before {
                return Err(RecordError::NotAfter { line: columns.lines[i + 1], time, before });
            }
        }
        let (times, accelerations) = columns.rows.iter().map(|row| (row[0], row[1])).unzip();
        Ok(Self::new(times, accelerations))
    }

    fn by_units(text: &str) -> Result<Self, RecordError> {
        let ask = |quantity| Ask { quantities: vec![quantity], column: None, unit: None, options: ("", "") };
        let asks = [ask(Quantity::Time), ask(Quantity::Acceleration)];
        let [times, accelerations] = Measured::parse(text, &asks)?.channels.map(|own| own.values);
        if times.len() > MOST_ROWS {
            return Err(ColumnsError::TooMany(MOST_ROWS).into());
        }
        Ok(Self::new(times, accelerations))
    }

    /// Remarks for a run of `duration` s, each a clause that continues the file's name.
    pub fn warnings(&self, duration: f64) -> Vec<String> {
        let mut warnings = Vec::new();
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        if first > 0.0 {
            warnings.push(format!("begins at {first} s; the base stands still until then"));
        }
        // a time that was counted up in steps is some roundings short
        if last < duration * (1.0 - 4.0 * f64::EPSILON) {
            warnings.push(format!(
                "ends at {last} s, before the run does at {duration} s; the base stands still from there"
            ));
        }
        let timing = Timing::of(&self.times);
        if let Some((at, longest)) = timing.longest_gap() {
            warnings.push(format!(
                "has a gap of {longest} s after {at} s, where its usual step is {} s; it is bridged by a \
                 straight line",
                timing.step
            ));
        }
        warnings
    }

    /// The largest magnitude in m/s^2.
    pub fn peak(&self) -> f64 {
        *self.made.peak.get_or_init(|| self.accelerations.iter().fold(0.0, |peak, a| a.abs().max(peak)))
    }
}

/// Reads the records that an excitation names and attaches them to it; what cannot be read is a fault and
/// stays without a record. `path` is the excitation's own.
pub(super) fn attach(excitation: &mut Excitation, path: &str, files: &Files) -> Vec<Fault> {
    match excitation {
        Excitation::Recorded { path: file, record } => {
            let read = files.read(file).map_err(|e| e.to_string());
            match read.and_then(|text| Record::parse(&text).map_err(|e| e.to_string())) {
                Ok(found) => {
                    *record = Some(Arc::new(found));
                    Vec::new()
                }
                Err(problem) => {
                    *record = None;
                    vec![Fault { field: format!("{path}.path"), value: file.clone(), problem }]
                }
            }
        }
        Excitation::Sum(terms) => terms
            .iter_mut()
            .enumerate()
            .flat_map(|(i, term)| attach(term, &format!("{path}.{i}"), files))
            .collect(),
        _ => Vec::new(),
    }
}

/// Remarks on the records of an excitation in a run of `duration` s.
pub(super) fn warnings(excitation: &Excitation, duration: f64) -> Vec<String> {
    match excitation {
        Excitation::Recorded { path, record: Some(record) } => record
            .warnings(duration)
            .into_iter()
            .map(|warning| format!("the record {path} {warning}"))
            .collect(),
        Excitation::Sum(terms) => terms.iter().flat_map(|term| warnings(term, duration)).collect(),
        _ => Vec::new(),
    }
}

/// The paths of the records of an excitation, as written.
pub(super) fn paths_mut(excitation: &mut Excitation) -> Vec<&mut String> {
    match excitation {
        Excitation::Recorded { path, .. } => vec![path],
        Excitation::Sum(terms) => terms.iter_mut().flat_map(paths_mut).collect(),
        _ => Vec::new(),
    }
}
