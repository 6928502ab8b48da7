//! Lyapunov exponents of any motion, as averages over forcing periods.

use std::sync::atomic::{AtomicBool, Ordering};

use super::tangent::Tangent;
use super::{Estimate, Exponents, NoExponents};
use crate::dynamics::Model;
use crate::numeric::CompensatedSum;
use crate::study::State;

/// Number of forcing periods before the average, in which a perturbation turns into the direction of fastest
/// growth.
const ALIGNMENT: u32 = 20;

/// The exponents of the motion through `state`, in m and m/s at a [`phase`](Model::drive_phase) of the drive
/// from 0 to 1, averaged over `periods` forcing periods, at least 1, from this state on: transients are
/// included, and periodic orbits get no special treatment. Without a drive, a period is the natural time of
/// the mechanism.
///
/// Standard errors are those of batch means, with the square root of the number of periods as the number of
/// batches (Flegal and Jones 2010). They are valid if correlations decay within a batch.
pub fn average_exponents(
    model: &Model,
    state: State,
    phase: f64,
    periods: u32,
    cancel: &AtomicBool,
) -> Result<Exponents, NoExponents> {
    average(&Tangent::of(model, phase)?, state, periods, cancel)
}

/// Like [`average_exponents`], for a map.
pub(super) fn average(
    tangent: &Tangent,
    mut state: State,
    periods: u32,
    cancel: &AtomicBool,
) -> Result<Exponents, NoExponents> {
    let periods = periods.max(1);
    let time = tangent.period() * f64::from(periods);
    let mut change = [std::f64::consts::FRAC_1_SQRT_2; 2];
    let (mut first, mut second) = (Batches::new(periods), Batches::new(periods));
    let mut measured = CompensatedSum::<f64>::new();
    let mut exact = Some(CompensatedSum::<f64>::new());
    for number in 0..ALIGNMENT + periods {
        if cancel.load(Ordering::Relaxed) {
            return Err(NoExponents::Cancelled);
        }
        let passed = tangent.pass(state)?;
        let [[a, b], [c, d]] = passed.jacobian.rows;
        let [x, v] = [a * change[0] + b * change[1], c * change[0] + d * change[1]];
        let growth = x.hypot(v);
        if growth == 0.0 {
            return Ok(Exponents::of_rest(None, (periods, time), passed.exact.is_some()));
        }
        change = [x / growth, v / growth];
        state = passed.state;
        if number >= ALIGNMENT {
            first.add(growth.ln());
            second.add(passed.log_determinant() - growth.ln());
            measured.add(passed.measured);
            exact = exact.zip(passed.exact).map(|(mut sum, term)| {
                sum.add(term);
                sum
            });
        }
    }
    let exact_sum = exact.map(|sum| sum.value() / time + 0.0);
    let (first, second) = (first.estimate(tangent.period()), second.estimate(tangent.period()));
    // the difference of the exact sum and the first exponent has no further rounding error
    let second = Estimate { per_s: exact_sum.map_or(second.per_s, |sum| sum - first.per_s), ..second };
    // if the two differ by less than their scatter, the second one may be larger
    let (first, second) = if second.per_s > first.per_s { (second, first) } else { (first, second) };
    Ok(Exponents {
        first,
        second,
        sum: measured.value() / time,
        exact_sum,
        period: None,
        span: (periods, time),
    })
}

/// Sums over consecutive batches of a series of known length.
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
        let error = match count {
            1 => f64::NAN,
            n => (squares / (n - 1) as f64 / n as f64).sqrt(),
        };
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
