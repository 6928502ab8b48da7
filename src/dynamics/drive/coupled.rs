//! Drive beside a circuit whose state goes on with the motion.

use super::circuit::Circuit;
use super::composite::{Composite, Cursor};
use super::release::Decaying;
use super::{ContactAcceleration, Drive, ReleaseRoot, Span};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::series::{ROOM, Tail};
use crate::numeric::Scalar;

/// A drive with a circuit beside it.
#[derive(Debug, Clone)]
pub(crate) struct Coupled<T> {
    pub drive: Composite<T>,
    pub circuit: Circuit<T>,
}

/// What continues the series of both.
#[derive(Debug, Clone)]
pub(crate) struct CoupledCursor<T> {
    drive: Cursor<T>,
    /// Coefficients of the circuit's state: one less than the displacement has.
    state: [T; ROOM],
}

impl<T: Scalar> Default for CoupledCursor<T> {
    fn default() -> Self {
        Self { drive: Cursor::default(), state: [T::zero(); ROOM] }
    }
}

impl<T: Scalar> Tail<T> for Coupled<T> {
    type Cursor = CoupledCursor<T>;

    fn extend(&self, k: usize, a: &mut [T; ROOM], inverse: &[T; ROOM], cursor: &mut Self::Cursor) {
        self.drive.extend(k, a, inverse, &mut cursor.drive);
    }

    #[inline(always)]
    fn couple(&self, k: usize, y: &[T; ROOM], cursor: &mut Self::Cursor) -> Option<T> {
        let Circuit { coupling, rates, .. } = &self.circuit;
        let w = &mut cursor.state;
        w[k + 1] = *coupling * y[k + 1] - rates[k + 1] * w[k];
        Some(*coupling * w[k])
    }
}

impl<T: Scalar> Drive<T> for Coupled<T> {
    fn circuit(&self) -> Option<&Circuit<T>> {
        Some(&self.circuit)
    }

    fn circuit_state(cursor: &Self::Cursor) -> Option<&[T; ROOM]> {
        Some(&cursor.state)
    }

    fn begin_circuit(cursor: &mut Self::Cursor, state: T) {
        cursor.state[0] = state;
    }

    fn cost(&self, order: usize) -> u64 {
        self.drive.cost(order) + order as u64
    }

    fn common_cycles(&self) -> i64 {
        self.drive.common_cycles()
    }

    fn seed(
        &self,
        clock: &Clock<T>,
        at: &Instant<T>,
        segment: usize,
        a: &mut [T; ROOM],
        cursor: &mut Self::Cursor,
    ) {
        self.drive.seed(clock, at, segment, a, &mut cursor.drive);
    }

    fn acceleration(&self, clock: &Clock<T>, at: &Instant<T>, segment: usize) -> T {
        self.drive.acceleration(clock, at, segment)
    }

    fn value(
        &self,
        clock: &Clock<T>,
        at: &Instant<T>,
        segment: usize,
        by_series: impl Fn() -> T,
        cursor: &mut Self::Cursor,
    ) -> T {
        self.drive.value(clock, at, segment, by_series, &mut cursor.drive)
    }

    fn segment_end(&self, segment: usize) -> Option<Instant<T>> {
        self.drive.segment_end(segment)
    }

    /// The push of the circuit on a mass at rest decays. As long as it is there, the contact acceleration is
    /// a polynomial over strides that suit the decay too, and no root of it is missed; then the drive's own
    /// search goes on. A push that stays is part of the threshold.
    fn next_release(
        &self,
        clock: &Clock<T>,
        span: &Span<T>,
        acceleration: ContactAcceleration<T>,
        cursor: &mut Self::Cursor,
    ) -> (ReleaseRoot<T>, u64) {
        let ContactAcceleration { threshold, sign, circuit } = acceleration;
        let (push, rate) = (self.circuit.coupling * circuit, self.circuit.decay);
        // What was passed while there was a push says nothing of the time without it.
        let span = Span { since: span.from, ..*span };
        let without = |threshold: T| ContactAcceleration { threshold, sign, circuit: T::zero() };
        if rate == T::zero() {
            let pressed = without(threshold - sign * push);
            return self.drive.next_release(clock, &span, pressed, &mut cursor.drive);
        }
        let level = threshold.abs() + self.drive.reach + self.drive.constant.abs();
        let negligible = level * T::of(T::EPSILON / 16.0);
        if !(push.abs() > negligible) {
            return self.drive.next_release(clock, &span, without(threshold), &mut cursor.drive);
        }
        if level == T::zero() {
            return (ReleaseRoot::Never, 0); // it keeps its sign
        }
        // (a little longer, so that it is negligible then)
        let lasts = T::of((push.abs() / negligible).to_f64().ln() + 1.0) / rate;
        let fades = lasts < clock.between(&span.from, &span.until);
        let until = if fades { clock.advance(&span.from, lasts) } else { span.until };
        let mut search = self.drive.search(clock, without(threshold), span.segment);
        search.decaying = Some(Decaying { push, rate, since: span.from });
        search.fastest = search.fastest.larger(rate);
        search.reach += push.abs();
        search.common_cycles = None;
        match search.first(&Span { until, ..span }, &mut cursor.drive) {
            (ReleaseRoot::Never, work) if fades => (ReleaseRoot::NotBefore(until), work),
            found => found,
        }
    }
}
