//! Comparison of a measured motion with the computed one, and of a measured force with the force curve.

mod numbers;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use super::{Table, finished};
use crate::dynamics::{Model, Request, Sample};
use crate::mechanics::Mechanism;
use crate::numeric::{alignment, short};
use crate::scene::{Channel, Quantity, Scene, Timing};
use numbers::{assembled, percent, rms, statistics};

/// A measured motion, and how it is aligned with a run.
#[derive(Debug, Clone, Copy)]
pub struct MeasuredMotion<'a> {
    /// Times in s, increasing.
    pub times: &'a [f64],
    /// Displacement, velocity, or acceleration of the base.
    pub channel: &'a Channel,
    /// Offset added to its values, SI, for a sensor with a different zero.
    pub offset: f64,
    /// Factor on its times.
    pub time_scale: f64,
    /// Shift of the scaled times in s; if `None`, it is found by least squares.
    pub shift: Option<f64>,
}

impl<'a> MeasuredMotion<'a> {
    /// A motion whose times are those of the run.
    pub fn of(times: &'a [f64], channel: &'a Channel) -> Self {
        Self { times, channel, offset: 0.0, time_scale: 1.0, shift: Some(0.0) }
    }
}

/// Comparison of a measured motion with the computed one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// `quantity,unit,measured,computed,difference,difference_percent`.
    pub table: Table,
    /// The quantity that was measured.
    pub quantity: Quantity,
    /// Times of the measured samples within the run, scaled and shifted.
    pub times: Vec<f64>,
    /// The measured values there, SI.
    pub measured: Vec<f64>,
    /// The computed ones.
    pub computed: Vec<f64>,
    /// The shift in s.
    pub shift: f64,
    /// RMS of the difference in SI, and in percent of the measured RMS; NaN if that is 0.
    pub rms: (f64, f64),
    /// Remarks, each a sentence.
    pub remarks: Vec<String>,
}

/// Why there is nothing to compare.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoComparison {
    /// It was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// The record and the run have no time in common.
    #[error(
        "{samples} samples of the record, which goes from {from} to {to} s once it is scaled and shifted, \
         lie within the run from 0 to {end} s; at least 2 are needed: give another shift, or lengthen the run"
    )]
    Apart {
        /// Number of samples within the run.
        samples: usize,
        /// Begin in s.
        from: String,
        /// End in s.
        to: String,
        /// End of the run in s.
        end: String,
    },
}

/// Largest number of values that are compared to find the shift.
const MAX_COMPARED: f64 = (1_u64 << 18) as f64;

/// Number of Gauss-Newton steps that refine a shift.
const STEPS: usize = 8;

/// Rounding error of a scaled and shifted time, in units of the last place.
const ROUNDINGS: f64 = 4.0;

/// Range of the measured samples within the run, their times in it, and the computed samples then.
type Aligned = (Range<usize>, Vec<f64>, Vec<Sample>);

/// Compares a measured motion with the run of `model`, the model of `scene`.
///
/// If no shift is given, it is the one with the smallest mean square difference for which at least half of
/// the shorter of record and run overlaps. It is searched on an even grid first; for a displacement it is
/// then refined by Gauss-Newton steps on the run itself, whose velocity is the derivative.
pub fn compare(
    scene: &Scene,
    model: &Model,
    motion: &MeasuredMotion,
    cancel: &AtomicBool,
) -> Result<Comparison, NoComparison> {
    let scaled: Vec<f64> = motion.times.iter().map(|t| t * motion.time_scale).collect();
    let values: Vec<f64> = motion.channel.values.iter().map(|value| value + motion.offset).collect();
    let timing = Timing::of(&scaled);
    let run = |times: &[f64]| {
        let run = model.run(&Request { sample_times: times, cancel: Some(cancel), ..Request::default() });
        finished(run).map(|run| run.samples).ok_or(NoComparison::Cancelled)
    };
    let of = |sample: &Sample| match motion.channel.quantity {
        Quantity::Velocity => sample.v,
        Quantity::Acceleration => sample.base_accel,
        _ => sample.x,
    };
    let mut remarks = vec![timing.describe()];
    let mut shift = motion.shift.unwrap_or(0.0);
    if motion.shift.is_none() {
        let length = timing.span.1 - timing.span.0;
        let step = timing.step.max(model.duration().max(length) / MAX_COMPARED);
        let even = |length: f64| (0..=(length / step) as u32).map(move |k| f64::from(k) * step);
        let computed: Vec<f64> = run(&even(model.duration()).collect::<Vec<_>>())?.iter().map(of).collect();
        let measured: Vec<f64> = even(length).map(|t| between(&scaled, &values, timing.span.0 + t)).collect();
        let least = computed.len().min(measured.len()) / 2;
        if let Some(found) = alignment(&computed, &measured, least) {
            shift = found.lag * step - timing.span.0;
            if found.ambiguous {
                remarks.push("other shifts fit as well; the one nearest to 0 was taken".to_owned());
            }
        }
    }
    let at = |shift: f64| -> Result<Aligned, NoComparison> {
        // a sample at the start or the end of the run counts as within it despite rounding of its time
        let (first, last) = timing.span;
        let end = model.duration();
        let rounding = ROUNDINGS * f64::EPSILON * end.max(first.abs()).max(last.abs()).max(shift.abs());
        let from = scaled.partition_point(|t| t + shift < -rounding);
        let to = scaled.partition_point(|t| t + shift <= end + rounding);
        let times: Vec<f64> =
            scaled[from..to.max(from)].iter().map(|t| (t + shift).clamp(0.0, end)).collect();
        let samples = run(&times)?;
        Ok((from..from + samples.len(), times, samples))
    };
    let square = |range: &Range<usize>, samples: &[Sample]| {
        let measured = &values[range.clone()];
        measured.iter().zip(samples).map(|(m, c)| (m - of(c)).powi(2)).sum::<f64>() / samples.len() as f64
    };
    let mut laid = at(shift)?;
    for _ in 0..STEPS {
        if motion.shift.is_some() || motion.channel.quantity != Quantity::Displacement || laid.2.is_empty() {
            break;
        }
        let pairs = || values[laid.0.clone()].iter().zip(&laid.2);
        let rise: f64 = pairs().map(|(m, c)| (m - c.x) * c.v).sum();
        let step = rise / pairs().map(|(_, c)| c.v * c.v).sum::<f64>();
        if !(step.abs() > 1e-15 * model.duration() && step.abs() < model.duration()) {
            break;
        }
        let next = at(shift + step)?;
        if !(square(&next.0, &next.2) < square(&laid.0, &laid.2)) {
            break;
        }
        (shift, laid) = (shift + step, next);
    }
    let (range, mut times, samples) = laid;
    times.truncate(samples.len());
    if samples.len() < 2 {
        let [from, to] = [timing.span.0, timing.span.1].map(|t| short(t + shift));
        let end = short(model.duration());
        return Err(NoComparison::Apart { samples: samples.len(), from, to, end });
    }
    let measured = values[range.clone()].to_vec();
    let rms_apart = square(&range, &samples).sqrt();
    if samples.len() < motion.times.len() {
        let outside = motion.times.len() - samples.len();
        remarks.push(format!("{outside} of {} samples lie outside the run", motion.times.len()));
    }
    let computed: Vec<f64> = samples.iter().map(of).collect();
    let table = numbers::table(scene, model, motion.channel.quantity, &times, &measured, &computed);
    let rms = (rms_apart, percent(rms_apart, rms(&measured)));
    let quantity = motion.channel.quantity;
    Ok(Comparison { table, quantity, times, measured, computed, shift, rms, remarks })
}

/// The value of a record at a time, by linear interpolation, and constant beyond its ends.
fn between(times: &[f64], values: &[f64], t: f64) -> f64 {
    let after = times.partition_point(|time| *time <= t).clamp(1, times.len() - 1);
    let share = ((t - times[after - 1]) / (times[after] - times[after - 1])).clamp(0.0, 1.0);
    values[after - 1] + share * (values[after] - values[after - 1])
}

/// Comparison of a measured force with the computed one at the measured positions on the force curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForceComparison {
    /// `quantity,unit,measured,computed,difference,difference_percent`.
    pub table: Table,
    /// Positions in m, in the order in which they were measured.
    pub positions: Vec<f64>,
    /// The measured force there, N.
    pub measured: Vec<f64>,
    /// The computed one.
    pub computed: Vec<f64>,
    /// RMS of the difference in N, and in percent of the measured RMS; NaN if that is 0.
    pub rms: (f64, f64),
    /// Position in m of the largest difference, and the difference (computed minus measured) in N.
    pub largest: (f64, f64),
    /// Remarks, each a sentence.
    pub remarks: Vec<String>,
}

/// Too few positions lie on the force curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{on} of {samples} positions lie on the force curve, which reaches from {} to {} mm; at least 2 are \
     needed: check the unit and the zero of the positions",
    domain.0, domain.1
)]
pub struct OffTheCurve {
    on: usize,
    samples: usize,
    /// Its ends in mm.
    domain: (String, String),
}

/// Compares the force `force` in N measured at `x` in m with the computed holding force.
pub fn compare_force(
    mechanism: &Mechanism,
    x: &[f64],
    force: &[f64],
) -> Result<ForceComparison, OffTheCurve> {
    let curve = &mechanism.curve;
    let domain = curve.domain();
    let on = |sample: &(&f64, &f64)| (domain.0..=domain.1).contains(sample.0);
    let (positions, measured): (Vec<f64>, Vec<f64>) = x.iter().zip(force).filter(on).unzip();
    if positions.len() < 2 {
        let domain = (short(domain.0 * 1e3), short(domain.1 * 1e3));
        return Err(OffTheCurve { on: positions.len(), samples: x.len(), domain });
    }
    let computed: Vec<f64> = positions.iter().map(|x| curve.force(*x)).collect();
    let apart: Vec<f64> = measured.iter().zip(&computed).map(|(m, c)| c - m).collect();
    let by_size = |a: &usize, b: &usize| apart[*a].abs().total_cmp(&apart[*b].abs());
    let worst = (0..apart.len()).max_by(by_size).unwrap_or(0);
    let (of_measured, rms_apart) = (rms(&measured), rms(&apart));
    let mut rows = vec![
        ("rms_difference", "N", f64::NAN, f64::NAN),
        ("largest_difference", "N", measured[worst], computed[worst]),
        ("largest_difference_at", "m", positions[worst], positions[worst]),
    ];
    rows.extend(statistics("N", &measured, &computed));
    let mut remarks = Vec::new();
    if positions.len() < x.len() {
        let outside = x.len() - positions.len();
        let [low, high] = [domain.0, domain.1].map(|end| short(end * 1e3));
        remarks.push(format!(
            "{outside} of {} samples lie beyond the force curve, which reaches from {low} to {high} mm",
            x.len()
        ));
    }
    Ok(ForceComparison {
        table: assembled(&rows, rms_apart, of_measured),
        rms: (rms_apart, percent(rms_apart, of_measured)),
        largest: (positions[worst], apart[worst]),
        positions,
        measured,
        computed,
        remarks,
    })
}
