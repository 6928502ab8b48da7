//! Times of samples: even, exact in the decimals that a person wrote, or listed.
//!
//! `--dt 0.1` means 0.1, 0.2, 0.3, not 0.30000000000000004: a time is the double nearest to k times
//! the *decimal* step, and a 60th of a forcing period of 1/3 s is the double nearest to k/180.

use crate::numeric::{Decimal, greatest_common_divisor};

/// The largest number of samples of one run: they take 1 GB of memory.
pub const MAX_SAMPLES: u64 = 10_000_000;

/// Why a run cannot be sampled as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TimesError {
    /// The step is not a number above 0.
    #[error("the sampling step is {0} s: it must be a finite number above 0")]
    SamplingStep(f64),
    /// More samples than [`MAX_SAMPLES`].
    #[error(
        "a step of {step} s over {duration} s makes {count} samples; at most {MAX_SAMPLES} fit: \
         take a longer step (--dt) or name the times (--at)"
    )]
    TooMany {
        /// The step in s.
        step: f64,
        /// The duration in s.
        duration: f64,
        /// The samples it would make, rounded where it is above 2^53.
        count: String,
    },
    /// A time that the run does not have.
    #[error("--at {time} is not within the run, which lasts from 0 to {duration} s")]
    Outside {
        /// The time asked for in s.
        time: f64,
        /// The duration in s.
        duration: f64,
    },
}

/// A positive rational number: exactly what decimal text says, or a fraction of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Fraction {
    numerator: u128,
    denominator: u128,
}

impl Fraction {
    /// The decimal number that the shortest text of `value` spells; `None` if it is not above 0 or needs more
    /// than 38 digits.
    fn decimal(value: f64) -> Option<Self> {
        let Decimal { digits, exponent } = Decimal::shortest(value).filter(|decimal| decimal.digits > 0)?;
        let digits = digits.unsigned_abs();
        let power = 10_u128.checked_pow(exponent.unsigned_abs())?;
        Some(if exponent >= 0 {
            Self { numerator: digits.checked_mul(power)?, denominator: 1 }
        } else {
            Self { numerator: digits, denominator: power }
        })
    }

    /// This divided by `n`.
    fn over(self, n: u128) -> Option<Self> {
        Some(Self { numerator: self.numerator, denominator: self.denominator.checked_mul(n)? })
    }

    /// 1 over this.
    fn inverse(self) -> Self {
        Self { numerator: self.denominator, denominator: self.numerator }
    }

    /// The double nearest to `k` times this.
    fn times(self, k: u64) -> f64 {
        const EXACT: u128 = 1 << 53;
        let Some(mut numerator) = self.numerator.checked_mul(u128::from(k)) else {
            return self.times(1) * k as f64;
        };
        let mut denominator = self.denominator;
        if numerator >= EXACT || denominator >= EXACT {
            let divisor = greatest_common_divisor(numerator, denominator);
            (numerator, denominator) = (numerator / divisor, denominator / divisor);
        }
        // Both exact: one correctly rounded division. Beyond that the parser's rounding where the
        // denominator is a power of ten, else an error of at most two units in the last place.
        if (numerator >= EXACT || denominator >= EXACT) && denominator.is_multiple_of(10) {
            let zeros = denominator.ilog10();
            if 10_u128.checked_pow(zeros) == Some(denominator) {
                return format!("{numerator}e-{zeros}").parse().unwrap_or(f64::NAN);
            }
        }
        numerator as f64 / denominator as f64
    }

    /// How many times this fits into `whole`.
    fn fits_into(self, whole: Self) -> Option<u64> {
        let above = whole.numerator.checked_mul(self.denominator)?;
        let below = whole.denominator.checked_mul(self.numerator)?;
        u64::try_from(above / below).ok()
    }
}

/// The step between even samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SamplingStep {
    /// A number of seconds.
    Seconds(f64),
    /// A 60th of the period of this frequency in Hz.
    PeriodOf(f64),
    /// A 60th of this period in s.
    Period(f64),
    /// A thousandth of the duration.
    Thousandth,
}

impl SamplingStep {
    fn seconds(self, duration: f64) -> f64 {
        match self {
            Self::Seconds(dt) => dt,
            Self::PeriodOf(frequency) => 1.0 / (60.0 * frequency),
            Self::Period(period) => period / 60.0,
            Self::Thousandth => duration / 1000.0,
        }
    }

    fn ratio(self, duration: f64) -> Option<Fraction> {
        match self {
            Self::Seconds(dt) => Fraction::decimal(dt),
            Self::PeriodOf(frequency) => Fraction::decimal(frequency)?.inverse().over(60),
            Self::Period(period) => Fraction::decimal(period)?.over(60),
            Self::Thousandth => Fraction::decimal(duration)?.over(1000),
        }
    }
}

/// The times 0, dt, 2 dt, .. up to `duration` in s, which is among them where the step reaches it.
///
/// Each is the double nearest to its exact value, so they ascend and none exceeds `duration`.
pub fn even_times(step: SamplingStep, duration: f64) -> Result<Vec<f64>, TimesError> {
    let dt = step.seconds(duration);
    if !(dt.is_finite() && dt > 0.0) {
        return Err(TimesError::SamplingStep(dt));
    }
    let exact = step.ratio(duration);
    let count = exact
        .and_then(|ratio| ratio.fits_into(Fraction::decimal(duration)?))
        .map_or_else(|| (duration / dt * (1.0 + 4.0 * f64::EPSILON)).floor(), |fits| fits as f64)
        + 1.0;
    if count > MAX_SAMPLES as f64 {
        let count = if count < 9e15 { format!("{count}") } else { format!("{count:.3e}") };
        return Err(TimesError::TooMany { step: dt, duration, count });
    }
    let time = |k: u64| exact.map_or(k as f64 * dt, |ratio| ratio.times(k)).min(duration);
    Ok((0..count as u64).map(time).collect())
}

/// The given times, checked to lie within 0..=`duration`; -0 becomes 0.
pub fn listed_times(times: &[f64], duration: f64) -> Result<Vec<f64>, TimesError> {
    match times.iter().find(|t| !(**t >= 0.0 && **t <= duration)) {
        Some(&time) => Err(TimesError::Outside { time, duration }),
        None => Ok(times.iter().map(|t| t + 0.0).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_exact_in_decimals() {
        let times = even_times(SamplingStep::Seconds(0.1), 1.0).unwrap();
        assert_eq!(times, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
        let times = even_times(SamplingStep::PeriodOf(3.0), 10.0).unwrap();
        assert_eq!(times.len(), 1801);
        assert!(times.iter().enumerate().all(|(k, t)| *t == k as f64 / 180.0));
        assert_eq!(times[1800], 10.0);
        let times = even_times(SamplingStep::PeriodOf(2.7), 10.0).unwrap();
        assert!(times.iter().enumerate().all(|(k, t)| *t == (k * 10) as f64 / 1620.0));
        assert_eq!(even_times(SamplingStep::Thousandth, 0.3).unwrap()[999], 0.2997);
        assert_eq!(even_times(SamplingStep::Seconds(1e-9), 1e-9).unwrap(), [0.0, 1e-9]);
        assert_eq!(even_times(SamplingStep::Seconds(2.0), 1.0).unwrap(), [0.0]);
        let times = even_times(SamplingStep::Seconds(0.3), 1.0).unwrap();
        assert_eq!(times, [0.0, 0.3, 0.6, 0.9]);
    }

    #[test]
    fn times_ascend_and_stay_within_the_run() {
        for (dt, duration) in [(1.0 / 3.0, 1.0), (1e-300, 5e-299), (0.123456789012345, 1e3), (7e290, 1e300)] {
            let times = even_times(SamplingStep::Seconds(dt), duration);
            let Ok(times) = times else { continue };
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{dt} {duration}");
            assert!(times.last().is_some_and(|t| *t <= duration));
        }
    }

    #[test]
    fn too_many_samples_are_counted_not_made() {
        let error = even_times(SamplingStep::PeriodOf(3.0), 1e9).unwrap_err();
        assert!(error.to_string().contains("180000000001"), "{error}");
        let error = even_times(SamplingStep::Seconds(1e-300), 1e9).unwrap_err();
        assert!(matches!(error, TimesError::TooMany { .. }), "{error}");
        for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(even_times(SamplingStep::Seconds(dt), 1.0), Err(TimesError::SamplingStep(_))));
        }
    }

    #[test]
    fn listed_times_lie_within_the_run() {
        assert_eq!(listed_times(&[1.0, 0.0, -0.0], 1.0).unwrap(), [1.0, 0.0, 0.0]);
        for time in [-1e-9, 1.000001, f64::NAN, f64::INFINITY] {
            assert!(listed_times(&[0.5, time], 1.0).is_err());
        }
    }
}
