//! Recorded base acceleration.
//!
//! A record is read when a document is read or changed. It is then a part of the scene, and all cells of a
//! sweep share it.

use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::columns::{ColumnsError, MAX_ROWS, read_columns};
use super::data::Excitation;
use super::error::{Fault, clip};
use super::files::Files;
use super::measured::{ColumnRequest, Measured, MeasuredError, too_few};
use super::timing::Timing;
use super::unit::Quantity;
use crate::numeric::elementary;
use crate::numeric::pieces::{Piece, pieces};

const TIME: &str = "t_s";
const ACCELERATION: &str = "accel_m_per_s2";

/// Samples of base acceleration, linear between them.
///
/// It is the drive [`Excitation::Recorded`](super::Excitation::Recorded), which is zero before the first and
/// after the last sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Times in s, strictly increasing; at least two.
    pub times: Vec<f64>,
    /// Accelerations in m/s^2, one for each time.
    pub accelerations: Vec<f64>,
    derived: Derived,
}

#[derive(Debug, Default)]
struct Derived {
    peak: OnceLock<f64>,
    pieces: Mutex<Vec<(Limits, Arc<Vec<Piece>>)>>,
}

/// Exponents of the powers of two to which limits were rounded down.
type Limits = (i32, i32);

/// Largest number of limits for which pieces are cached; a sweep needs a few.
const MAX_CACHED: usize = 16;

impl Clone for Derived {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Derived {
    /// Always equal, since the samples determine it.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Reads a record of base acceleration as a scene does: CSV with the columns `t_s,accel_m_per_s2`, or others
/// whose names end with a unit of time and one of acceleration. `path` is absolute, or the name of a built-in
/// record.
///
/// # Errors
///
/// A clause that follows the path: the file is missing or too large, a column is missing, or a value is no
/// number or out of order.
pub fn read_record(path: &Path) -> Result<Record, String> {
    read(&Files::default(), &path.to_string_lossy())
}

fn read(files: &Files, path: &str) -> Result<Record, String> {
    let text = files.read(path).map_err(|error| error.to_string())?;
    Record::parse(&text)
}

impl Record {
    /// A record from at least two strictly increasing times in s and accelerations in m/s^2.
    pub fn new(times: Vec<f64>, accelerations: Vec<f64>) -> Self {
        Self { times, accelerations, derived: Derived::default() }
    }

    /// Polynomials that replace the lines between samples. Their integrals, in m/s and m, differ from those
    /// of the lines by at most `limits` (rounded down to powers of two). They are computed once and shared.
    pub(crate) fn pieces(&self, limits: (f64, f64)) -> Arc<Vec<Piece>> {
        let exponent = |limit: f64| elementary::log2(limit).floor().max(-1000.0) as i32;
        let key = (exponent(limits.0), exponent(limits.1));
        let mut cached = self.derived.pieces.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = cached.iter().find(|entry| entry.0 == key) {
            return Arc::clone(found);
        }
        let limits = (elementary::exp2(f64::from(key.0)), elementary::exp2(f64::from(key.1)));
        let new = Arc::new(pieces(&self.times, &self.accelerations, limits));
        if cached.len() < MAX_CACHED {
            cached.push((key, Arc::clone(&new)));
        }
        new
    }

    /// Parses a record: CSV with the columns `t_s` and `accel_m_per_s2`, or with one column of time and one
    /// of acceleration identified by the units in their names, like a measured record. The error is a clause.
    pub fn parse(text: &str) -> Result<Self, String> {
        let columns = match read_columns(text, [TIME, ACCELERATION], MAX_ROWS, false) {
            Err(ColumnsError::MissingColumn(problem)) => {
                return Self::by_units(text).map_err(|error| match error {
                    // no column has a unit of time: report the missing standard column
                    MeasuredError::NoColumn { quantity: Quantity::Time, .. } => problem,
                    other => other.to_string(),
                });
            }
            columns => columns.map_err(|problem| problem.to_string())?,
        };
        if columns.rows.len() < 2 {
            return Err(too_few(columns.rows.len()));
        }
        for (i, pair) in columns.rows.windows(2).enumerate() {
            let (before, time) = (pair[0][0], pair[1][0]);
            if time <= before {
                let line = columns.lines[i + 1];
                return Err(format!(
                    "line {line}: {TIME} = {time:e} does not come after {before:e}; times must increase from \
                     row to row"
                ));
            }
        }
        let (times, accelerations) = columns.rows.iter().map(|row| (row[0], row[1])).unzip();
        Ok(Self::new(times, accelerations))
    }

    fn by_units(text: &str) -> Result<Self, MeasuredError> {
        let requests = [Quantity::Time, Quantity::Acceleration]
            .map(|quantity| ColumnRequest { quantities: vec![quantity], options: None });
        let [times, accelerations] = Measured::parse(text, &requests)?.channels.map(|channel| channel.values);
        if times.len() > MAX_ROWS {
            return Err(ColumnsError::TooMany(MAX_ROWS).into());
        }
        Ok(Self::new(times, accelerations))
    }

    /// Warnings for a run of `duration` s, each a clause that continues the file's name.
    pub fn warnings(&self, duration: f64) -> Vec<String> {
        let mut warnings = Vec::new();
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        if first > 0.0 {
            warnings.push(format!("begins at {first} s; the base stands still until then"));
        }
        // allow for the rounding of a time that was accumulated in steps
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
        *self.derived.peak.get_or_init(|| self.accelerations.iter().fold(0.0, |peak, a| a.abs().max(peak)))
    }
}

/// Reads the records that an excitation names and attaches them to it. A record that cannot be read is
/// returned as a fault and is not attached. `path` is the path of the excitation.
pub(super) fn attach(excitation: &mut Excitation, path: &str, files: &Files) -> Vec<Fault> {
    match excitation {
        Excitation::Recorded { path: file, record } => {
            let read = read(files, file).map(Arc::new);
            let fault =
                read.as_ref().err().map(|problem| Fault::new(format!("{path}.path"), &*file, problem));
            *record = read.ok();
            fault.into_iter().collect()
        }
        Excitation::Sum(terms) => terms
            .iter_mut()
            .enumerate()
            .flat_map(|(i, term)| attach(term, &format!("{path}.{i}"), files))
            .collect(),
        _ => Vec::new(),
    }
}

/// Warnings about the records of an excitation in a run of `duration` s.
pub(super) fn warnings(excitation: &Excitation, duration: f64) -> Vec<String> {
    match excitation {
        Excitation::Recorded { path, record: Some(record) } => record
            .warnings(duration)
            .into_iter()
            .map(|warning| format!("the record {} {warning}", clip(path)))
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
