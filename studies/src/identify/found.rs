//! What a record shows, or why it shows nothing, and the noise in it.

use super::force;
use super::peaks::MIN_SAMPLES;
use super::restitution::ENOUGH;
use crate::numeric::{MIN_TURNS, elementary, extent, short};
use crate::scene::unit_ending;
use crate::study::{Table, label_and_unit, named};

/// A number with its interval.
///
/// The interval holds if the errors of the samples are independent of each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Identity {
    /// Its name, with the unit in it.
    pub name: &'static str,
    /// The estimate.
    pub value: f64,
    /// The 95 % interval; NaN for a count.
    pub interval: (f64, f64),
}

impl Identity {
    pub(super) fn new(name: &'static str, value: f64, half: f64) -> Self {
        Self { name, value, interval: (value - half, value + half) }
    }

    /// The number in words.
    pub fn describe(&self) -> String {
        let (name, unit) = label_and_unit(self.name);
        let [value, low, high] = [self.value, self.interval.0, self.interval.1].map(short);
        let text = format!("{name} {value} {unit}");
        match self.interval.0.is_nan() {
            true => text.trim_end().to_owned(),
            false => format!("{} (95 % interval {low} to {high})", text.trim_end()),
        }
    }
}

/// The table with three more columns: a number for each row and the ends of its interval, whose names have
/// `_low` and `_high` before the unit.
pub(super) fn with_interval<R>(table: Table, name: &str, rows: &[R], of: impl Fn(&R) -> Identity) -> Table {
    let (unit, _) = unit_ending(name).unwrap_or_default();
    let end = |end: &str| format!("{}_{end}{unit}", name.strip_suffix(unit).unwrap_or(name));
    let table = table.each(name, rows, |row| of(row).value).each(&end("low"), rows, |row| of(row).interval.0);
    table.each(&end("high"), rows, |row| of(row).interval.1)
}

/// The quantities identified from a record.
///
/// [`summary`](Self::summary) has the numbers that a scene takes, such as `damping_ratio`, each with its
/// interval, and [`remarks`](Self::remarks) what speaks against them.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// The rows: over amplitude, impact or position.
    pub rows: Table,
    /// The numbers for the whole record.
    pub summary: Vec<Identity>,
    /// Fitted data for a picture: of a decay `t_s,upper,lower`, its envelope; of bounces
    /// `t_s,x_m,rebound_t_s,rebound_x_m`, the impacts and how far each goes back; of a pull `x_m,residual_n`,
    /// the samples less the curve.
    pub fitted: Table,
    /// Remarks, each a sentence.
    pub remarks: Vec<String>,
    /// Of a force, the tolerance of a curve through the rows: how closely they are known, 1e-4 to 0.1.
    pub tolerance: Option<f64>,
}

/// Why nothing could be identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Unidentified {
    /// Too few oscillations stand out from the noise.
    #[error(
        "{found} turning points stand out from the noise (of standard deviation {noise}); the damping ratio \
         needs {MIN_TURNS} of a free decay: record longer, pluck harder, or widen {from} and {to}",
        from = named!("from"),
        to = named!("to")
    )]
    FewSwings {
        /// How many were found.
        found: usize,
        /// Noise of the values, in SI.
        noise: String,
    },
    /// The swing at this time in s has too few samples.
    #[error(
        "the swing at {0} s has {1} samples near its turning point; {MIN_SAMPLES} are needed: \
         sample faster"
    )]
    Sparse(String, usize),
    /// The swing at this time in s has another length in s than the median of those around it.
    #[error(
        "the swing at {0} s takes {1} s where those around it take {2} s: the record has a gap \
         there or is no free decay in one well; cut it by {from} and {to}",
        from = named!("from"),
        to = named!("to")
    )]
    Uneven(String, String, String),
    /// Swings about places that differ, from this time in s on.
    #[error(
        "the middle of the swings moves at {0} s by more than a quarter of a swing: the motion changes \
         wells there, or the sensor moved; cut the record by {from} and {to}",
        from = named!("from"),
        to = named!("to")
    )]
    Moved(String),
    /// Too few swings are left beside those with flat tops.
    #[error(
        "{tops} swings have flat tops, at the limit {limit} of the sensor or its converter, and after them \
         {found} turning points stand out from the noise; the damping ratio needs {MIN_TURNS}: pluck \
         less, widen the range, or record longer"
    )]
    Clipped {
        /// Number of swings that are cut off.
        tops: usize,
        /// Where they are cut off, in SI.
        limit: String,
        /// Number of turning points that are left.
        found: usize,
    },
    /// Swings that are cut off hide the impacts: their number, and the displacements in mm.
    #[error(
        "no impact is left: {0} swings have flat tops at {1} mm, at the limit of the sensor or its \
         converter: widen its range so that it covers the stops"
    )]
    CutOff(usize, String),
    /// The turning points follow no decay.
    #[error(
        "the turning points follow no decaying oscillation: cut the record by {from} and {to}",
        from = named!("from"),
        to = named!("to")
    )]
    NoDecay,
    /// No impact was found in values with this noise, in SI.
    #[error(
        "no turning point is an impact: at none does the velocity jump by more than noise (of standard \
         deviation {0}) and a smooth turn explain. Impacts show where the flights after them hold \
         {ENOUGH} samples: sample faster, or cut the record by {from} and {to}",
        from = named!("from"),
        to = named!("to")
    )]
    NoImpact(String),
    /// Contacts, and those of them at which samples are missing.
    #[error(
        "{0} contacts with a stop, but at {1} of them samples are missing: record without gaps, or cut the \
         record by {from} and {to}",
        from = named!("from"),
        to = named!("to")
    )]
    Missing(usize, usize),
    /// The rebounds are too short.
    #[error(
        "the rebounds hold at most {longest} samples at {rate} a second, and {ENOUGH} are needed: take \
         {needed} samples a second or more"
    )]
    Slow {
        /// Samples of the longest rebound.
        longest: usize,
        /// Samples a second.
        rate: String,
        /// The rate at which the longest rebound has enough.
        needed: String,
    },
    /// The rebounds of these contacts are lost in noise of this standard deviation, in SI.
    #[error(
        "{0} contacts with a stop, but noise (of standard deviation {1}) hides the velocities about \
         them: record more impacts, harder ones, or with less noise"
    )]
    Noisy(usize, String),
    /// Times of impacts that follow no bounces.
    #[error("{0} impact times follow no bounces of one restitution; at least 4 are needed: {1}")]
    NoBounces(usize, &'static str),
    /// Positions that do not move.
    #[error("the position does not change")]
    Still,
    /// Too few samples for the points of a curve.
    #[error(
        "{0} samples are too few for {1} points of a curve: {remedy}",
        remedy = match *.1 > force::LEAST_POINTS {
            true => concat!("take fewer by ", named!("points")),
            false => "it has at least that many, each with samples of every direction beside it: record more",
        }
    )]
    FewSamples(usize, usize),
}

/// Standard deviation of the noise of values that otherwise vary slowly from sample to sample.
///
/// Third differences of a smooth record vanish; those of independent errors of standard deviation s have the
/// standard deviation s sqrt(20). Their median magnitude is insensitive to the few at impacts. For values
/// that stay constant over many samples, such as those of a converter with few bits, the smallest change is
/// used.
pub(crate) fn noise(values: &[f64]) -> f64 {
    /// Median magnitude over standard deviation of normal numbers.
    const NORMAL: f64 = 0.674_489_750_196_081_7;
    noise_by(values, 0.5, NORMAL)
}

/// The same for a record with so many impacts that they are in more than half of the third differences, whose
/// lower quartile they leave as it is.
pub(super) fn noise_between_impacts(values: &[f64]) -> f64 {
    /// Lower quartile of the magnitude over standard deviation of normal numbers.
    const NORMAL: f64 = 0.318_639_363_964_375_1;
    noise_by(values, 0.25, NORMAL)
}

/// The noise whose third differences have the observed quantile of this share.
fn noise_by(values: &[f64], share: f64, normal: f64) -> f64 {
    let third = |window: &[f64]| (window[3] - 3.0 * window[2] + 3.0 * window[1] - window[0]).abs();
    let mut thirds: Vec<f64> = values.windows(4).map(third).collect();
    if thirds.is_empty() {
        return 0.0;
    }
    let place = (share * thirds.len() as f64) as usize;
    let size = *thirds.select_nth_unstable_by(place, f64::total_cmp).1;
    let random = size / (normal * 20_f64.sqrt());
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let still = steps.clone().filter(|step| *step == 0.0).count();
    let least = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    if 10 * still > values.len() && least.is_finite() { random.max(least) } else { random }
}

/// Largest reversal of the values that noise of this standard deviation can cause: the range of as many
/// independent errors (twice their expected maximum, s sqrt(2 ln n)) and two standard deviations.
pub(crate) fn reach(values: &[f64], noise: f64) -> f64 {
    let count = values.len().max(2) as f64;
    let (low, high) = extent(values.iter().copied());
    (2.0 * noise * ((2.0 * elementary::ln(count)).sqrt() + 1.0)).max(1e-9 * (high - low))
}

/// The median; for an even number of values, the larger of the two middle ones.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
