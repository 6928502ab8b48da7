//! Lyapunov exponents of any motion, as averages over forcing periods.

use std::cmp::Ordering;
use std::sync::atomic::{self, AtomicBool};

use super::tangent::Tangent;
use super::{Estimate, Lyapunov, NoExponents};
use crate::dynamics::{Jacobian, MapState, Model};
use crate::numeric::{CompensatedSum, elementary};

/// Forcing periods before the average, in which a perturbation turns into the direction of fastest growth.
const ALIGNMENT: u32 = 20;

/// The exponents of the motion through `state`, such as `(x, v)` without a circuit, at a
/// [`phase`](Model::drive_phase) of the drive from 0 to 1, averaged over `periods` forcing periods, at least
/// 1, from this state on. Without a drive, a period is the natural time of the mechanism.
///
/// Standard errors are those of batch means, with the square root of the number of periods as the number of
/// batches (Flegal and Jones 2010). They are valid if correlations decay within a batch.
pub fn average_exponents(
    model: &Model,
    state: impl Into<MapState>,
    phase: f64,
    periods: u32,
    cancel: &AtomicBool,
) -> Result<Lyapunov, NoExponents> {
    average(&Tangent::of(model, phase)?, state.into(), periods, cancel)
}

pub(super) fn average(
    tangent: &Tangent,
    mut state: MapState,
    periods: u32,
    cancel: &AtomicBool,
) -> Result<Lyapunov, NoExponents> {
    let periods = periods.max(1);
    let time = tangent.map.period() * f64::from(periods);
    let has_circuit = tangent.map.model().has_electrical_state();
    let part = std::f64::consts::FRAC_1_SQRT_2;
    let mut changes = [[part, part, 0.0], [0.0, 0.0, 1.0]];
    let mut all = vec![Batches::new(periods); if has_circuit { 3 } else { 2 }];
    let mut measured = LogSum::default();
    let mut exact = Some(LogSum::default());
    for number in 0..ALIGNMENT + periods {
        if cancel.load(atomic::Ordering::Relaxed) {
            return Err(NoExponents::Cancelled);
        }
        let passed = tangent.pass(state)?;
        let growth = stretched(&passed.jacobian, &mut changes[0], None);
        if growth == 0.0 {
            return Ok(Lyapunov::of_rest(None, (periods, time), tangent));
        }
        let mut growths = vec![elementary::ln(growth)];
        if has_circuit {
            let [first, second] = &mut changes;
            let growth = stretched(&passed.jacobian, second, Some(first));
            // after a rest all perturbations have one direction
            growths.push(if passed.rested { f64::NEG_INFINITY } else { elementary::ln(growth) });
        }
        growths.push(match passed.rested {
            true => f64::NEG_INFINITY,
            false => passed.log_determinant() - growths.iter().sum::<f64>(),
        });
        state = passed.state;
        if number >= ALIGNMENT {
            all.iter_mut().zip(growths).for_each(|(batches, growth)| batches.add(growth));
            measured.add(passed.measured);
            exact = exact.zip(passed.exact).map(|(mut sum, term)| {
                sum.add(term);
                sum
            });
        }
    }
    let exact_sum = exact.map(|sum| sum.value() / time + 0.0);
    let period = tangent.map.period();
    let mut estimates: Vec<Estimate> = all.iter().map(|batches| batches.estimate(period)).collect();
    // the difference of the exact sum and the other exponents has no further rounding error
    if let Some(sum) = exact_sum
        && let [others @ .., last] = estimates.as_mut_slice()
    {
        last.per_s = others.iter().fold(sum, |left, estimate| left - estimate.per_s);
    }
    // those that differ by less than their scatter may be in another order
    estimates.sort_by(|a, b| b.per_s.partial_cmp(&a.per_s).unwrap_or(Ordering::Equal));
    Ok(Lyapunov {
        first: estimates[0],
        second: estimates[1],
        third: estimates.get(2).copied(),
        sum: measured.value() / time,
        exact_sum,
        period: None,
        span: (periods, time),
    })
}

/// A sum of logarithms of factors; a factor of 0 makes the product 0.
#[derive(Clone, Copy, Default)]
struct LogSum {
    sum: CompensatedSum<f64>,
    has_zero: bool,
}

impl LogSum {
    fn add(&mut self, logarithm: f64) {
        if logarithm == f64::NEG_INFINITY { self.has_zero = true } else { self.sum.add(logarithm) }
    }

    fn value(&self) -> f64 {
        if self.has_zero { f64::NEG_INFINITY } else { self.sum.value() }
    }
}

/// Maps a perturbation of length 1 by a derivative, removes its part along `other`, which is of length 1 too,
/// and makes its length 1 again. Returns the length before that; if it is 0 the perturbation stays.
fn stretched(derivative: &Jacobian, change: &mut [f64; 3], other: Option<&[f64; 3]>) -> f64 {
    let rows = derivative.rows();
    let [x, v, w] = *change;
    let mut next: [f64; 3] = std::array::from_fn(|i| rows[i][0] * x + rows[i][1] * v + rows[i][2] * w);
    if let Some(other) = other {
        let along: f64 = next.iter().zip(other).map(|(a, b)| a * b).sum();
        next.iter_mut().zip(other).for_each(|(part, other)| *part -= along * other);
    }
    let growth = elementary::hypot(elementary::hypot(next[0], next[1]), next[2]);
    if growth > 0.0 {
        *change = next.map(|part| part / growth);
    }
    growth
}

/// Sums over consecutive batches of a series of known length.
#[derive(Clone)]
struct Batches {
    sums: Vec<f64>,
    added: u64,
    length: u64,
}

impl Batches {
    fn new(length: u32) -> Self {
        Self { sums: vec![0.0; length.isqrt() as usize], added: 0, length: length.into() }
    }

    fn add(&mut self, value: f64) {
        let batch = self.added * self.sums.len() as u64 / self.length;
        self.sums[batch as usize] += value;
        self.added += 1;
    }

    /// Mean and standard error of the series over `period`. Batches differ by at most one value in length.
    fn estimate(&self, period: f64) -> Estimate {
        let mean = self.sums.iter().sum::<f64>() / self.length as f64;
        if !mean.is_finite() {
            let error = if mean == f64::NEG_INFINITY { 0.0 } else { f64::NAN };
            return Estimate { per_s: mean, error };
        }
        let count = self.sums.len() as u64;
        let length = |batch: u64| {
            let begin = |batch: u64| (batch * self.length).div_ceil(count);
            (begin(batch + 1) - begin(batch)) as f64
        };
        let means = self.sums.iter().zip(0..).map(|(sum, batch)| sum / length(batch));
        let squares: f64 = means.map(|value| (value - mean) * (value - mean)).sum();
        let error = if count == 1 { f64::NAN } else { (squares / (count - 1) as f64 / count as f64).sqrt() };
        Estimate { per_s: mean / period + 0.0, error: error / period }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batch_means_of_a_known_series() {
        let mut batches = Batches::new(9);
        (1..=9).for_each(|value| batches.add(f64::from(value)));
        // means 2, 5 and 8 of three batches: their standard deviation is 3
        let estimate = batches.estimate(2.0);
        assert_eq!((estimate.per_s, estimate.error), (2.5, 3.0_f64.sqrt() / 2.0));
        // 10 values in 3 batches of 4, 3 and 3
        let mut uneven = Batches::new(10);
        (0..10).for_each(|_| uneven.add(0.5));
        assert_eq!(uneven.estimate(1.0), Estimate { per_s: 0.5, error: 0.0 });
        assert_eq!(uneven.sums, [2.0, 1.5, 1.5]);
        let mut single = Batches::new(3);
        (0..3).for_each(|_| single.add(1.0));
        assert!(single.estimate(1.0).error.is_nan());
    }
}
