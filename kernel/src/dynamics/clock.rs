//! Clock: time as a whole number of cycles and a phase, exact after any number of cycles.
//!
//! The cycle is the forcing period (of the fastest tone if there are several); without a drive it is a power
//! of two near the scene's time scale. The phase has the same resolution at t = 1e9 s as at t = 1 s, and
//! equal phases are equal numbers.
//!
//! Inside the integrator time is counted in a unit that is a power of two of a second, near the scene's
//! time scale: the conversion is exact and Taylor coefficients stay near 1.

use crate::numeric::{DoubleDouble, Number, Scalar};

/// A point in time: whole cycles, and a phase in kernel time units, 0 <= phase < period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Instant<T> {
    pub cycle: i64,
    pub phase: T,
}

#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Clock<T> {
    /// Cycles per second.
    frequency: f64,
    /// Seconds per kernel time unit, a power of two.
    pub unit: f64,
    /// Length of a cycle in kernel time units.
    pub period: T,
}

impl<T: Scalar> Clock<T> {
    /// Preconditions: `frequency` in Hz above 0, `unit` in s a power of two.
    pub fn new(frequency: f64, unit: f64) -> Self {
        Self { frequency, unit, period: T::of(1.0) / T::of(frequency * unit) }
    }

    /// The instant of `seconds` >= 0: the phase is that of the exact product of the two doubles.
    pub fn at(&self, seconds: f64) -> Instant<T> {
        let turns = DoubleDouble::product(seconds, self.frequency);
        let whole = turns.floor();
        let rest = turns - whole;
        let fraction = T::of(rest.high()) + T::of(rest.low());
        let phase = fraction * self.period;
        let cycle = whole.to_f64() as i64;
        if phase < self.period {
            Instant { cycle, phase }
        } else {
            Instant { cycle: cycle + 1, phase: T::zero() }
        }
    }

    /// Seconds of an instant, rounded once or twice.
    pub fn seconds(&self, at: &Instant<T>) -> f64 {
        let phase = at.phase.to_f64() * self.unit;
        if at.cycle == 0 {
            return phase;
        }
        let cycles = at.cycle as f64;
        let quotient = cycles / self.frequency;
        let product = DoubleDouble::product(quotient, self.frequency);
        let rest = (cycles - product.high()) - product.low();
        quotient + (phase + rest / self.frequency)
    }

    /// Seconds of an instant, in double-double arithmetic.
    pub fn exact_seconds(&self, at: &Instant<T>) -> DoubleDouble {
        let cycles = DoubleDouble::of(at.cycle as f64) / DoubleDouble::of(self.frequency);
        cycles + at.phase.to_pair() * DoubleDouble::of(self.unit)
    }

    /// The instant `dt` >= 0 kernel time units later.
    #[inline(always)]
    pub fn advance(&self, at: &Instant<T>, dt: T) -> Instant<T> {
        let mut phase = at.phase + dt;
        let mut cycle = at.cycle;
        if phase >= self.period {
            let whole = (phase / self.period).floor();
            phase -= whole * self.period;
            cycle = cycle.saturating_add(whole.to_f64() as i64);
            if phase >= self.period {
                phase -= self.period;
                cycle += 1;
            }
            if phase < T::zero() {
                phase = T::zero();
            }
        }
        Instant { cycle, phase }
    }

    /// Kernel time units from one instant to another.
    #[inline(always)]
    pub fn between(&self, from: &Instant<T>, to: &Instant<T>) -> T {
        T::of((to.cycle - from.cycle) as f64) * self.period + (to.phase - from.phase)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_instant_is_as_fine_as_an_early_one() {
        let clock = Clock::<f64>::new(3.0, 1.0 / 64.0);
        for t in [0.0, 0.1, 1.0, 1e3 + 0.125, 1e9] {
            let at = clock.at(t);
            assert!(at.phase >= 0.0 && at.phase < clock.period);
            assert!((clock.seconds(&at) - t).abs() <= t * f64::EPSILON, "{t}");
        }
        let late = clock.at(1e9); // 3e9 cycles exactly
        assert_eq!((late.cycle, late.phase), (3_000_000_000, 0.0));
        let later = clock.advance(&late, 1e-12);
        assert_eq!(later.phase, 1e-12);
        assert!((clock.between(&late, &later) - 1e-12).abs() < 1e-28);
        let next = clock.advance(&late, clock.period * 2.5);
        assert_eq!(next.cycle, 3_000_000_002);
    }
}
