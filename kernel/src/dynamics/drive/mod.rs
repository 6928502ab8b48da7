//! Drive: acceleration of the base in kernel units, as a series about any instant.
//!
//! There are three types: a constant, a single sine, and a general sum with or without a circuit. One is
//! chosen for each run, so that a scene pays only for what it uses. A tone is evaluated from the clock's
//! exact phase at the start of a step and continued by its series, d\[k+2\] = -w^2 d\[k\] / ((k+1)(k+2)), so
//! nothing drifts and no library function is called.

pub(crate) mod form;
pub(crate) mod general;
mod lines;
mod record;
mod release;
pub(crate) mod tone;

use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::series::{ROOM, Tail};
use crate::numeric::Scalar;

/// Acceleration of the base at any instant, in kernel units: all that a recorder needs of a drive.
pub(crate) trait Base<T: Scalar> {
    /// a(t) at `at`.
    fn acceleration(&self, at: &Instant<T>, segment: usize) -> T;

    /// The same in m/s^2; `unit` is the length of the kernel's time unit in s.
    fn in_si(&self, at: &Instant<T>, segment: usize, unit: f64) -> f64 {
        self.acceleration(at, segment).to_f64() / (unit * unit)
    }
}

/// Acceleration of the base, in kernel units.
pub(crate) trait Drive<T: Scalar>: Tail<T> + Base<T> {
    /// Whether the drive changes its sign after half a cycle of the clock.
    fn is_odd(&self) -> bool {
        false
    }

    /// Cost of the drive in a step with a series of this order, in units of
    /// [`work`](crate::dynamics::step::work).
    fn cost(&self, _order: usize) -> u64 {
        0
    }

    #[inline(always)]
    fn circuit(&self) -> Option<&Circuit<T>> {
        None
    }

    #[inline(always)]
    fn circuit_state<'a>(&self, _: &'a Self::Cursor) -> Option<&'a [T; ROOM]> {
        None
    }

    #[inline(always)]
    fn begin_circuit(_: &mut Self::Cursor, _state: T) {}

    /// Cycles of the clock after which the drive repeats, if it does.
    fn common_cycles(&self) -> i64 {
        1
    }

    /// Bound of the second derivative at any time, if a simple one is known.
    fn second_derivative_bound(&self) -> Option<T> {
        None
    }

    /// Fills the first `SEEDED` coefficients of `a`, at `at`.
    fn seed(&self, at: &Instant<T>, segment: usize, a: &mut [T; ROOM], cursor: &mut Self::Cursor);

    /// a(t) at `at`, computed directly and not by the series: a step is checked against it. A drive of many
    /// tones may return `by_series`, the value of its series.
    fn value(
        &self,
        at: &Instant<T>,
        segment: usize,
        by_series: impl Fn() -> T,
        cursor: &mut Self::Cursor,
    ) -> T;

    /// The instant at which segment `segment` ends, if another one follows.
    #[inline]
    fn segment_end(&self, _segment: usize) -> Option<Instant<T>> {
        None
    }

    /// The next instant in the span at which the contact acceleration, positive now, changes sign, and the
    /// work of finding it. The span lies within one segment.
    fn next_release(
        &self,
        span: &Span<T>,
        acceleration: ContactAcceleration<T>,
        cursor: &mut Self::Cursor,
    ) -> (ReleaseRoot<T>, u64);
}

/// Release root: the instant at which the contact acceleration on a stop changes sign.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ReleaseRoot<T> {
    /// At this instant. If the drive repeats and the root was computed from the drive alone, the clock's
    /// cycle within the common period comes with it: roots of equal cycle and phase are the same.
    At(Instant<T>, Option<i64>),
    Never,
    /// Not before this instant, from which the search must continue: it was interrupted so that its work is
    /// counted.
    NotBefore(Instant<T>),
}

impl<T: Scalar> ReleaseRoot<T> {
    /// At `root` if that lies before the end of the span.
    pub fn within(clock: &Clock<T>, root: Instant<T>, turn: Option<i64>, until: &Instant<T>) -> Self {
        if clock.between(&root, until) > T::zero() { Self::At(root, turn) } else { Self::Never }
    }
}

/// A time interval within one segment of the drive; the end is not included.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span<T> {
    pub from: Instant<T>,
    pub until: Instant<T>,
    pub segment: usize,
    /// The instant since which no root was found within this segment; `from` if none was searched for.
    pub since: Instant<T>,
}

/// Contact acceleration: threshold - sign a(t), the outward acceleration that a mass at rest on a stop would
/// have without the stop. While it is positive, the mass stays at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactAcceleration<T> {
    /// The part of the mechanism.
    pub threshold: T,
    /// -1 on the left stop, 1 on the right one.
    pub sign: T,
    /// State of the circuit where the span begins; 0 without one.
    pub circuit: T,
}

/// Circuit of a transducer with an electrical state, in kernel units.
///
/// The state w of the circuit (a current or a voltage) is scaled so that w^2/2 is its energy over the mass.
/// It then has the unit of a velocity, and the coupling is the same in both directions:
///
/// ```text
/// x'' = .. - g w,    w' = g x' - d w.
/// ```
///
/// Its Taylor coefficients follow from those of the motion by one product and one sum each.
#[derive(Debug, Clone)]
pub(crate) struct Circuit<T> {
    /// g.
    pub coupling: T,
    /// d.
    pub decay: T,
    /// d/k, the factor of coefficient k-1 in coefficient k.
    pub rates: [T; ROOM],
    /// Magnitude of the state to which the tolerance is relative.
    pub scale: T,
}

impl<T: Scalar> Circuit<T> {
    pub fn new(coupling: T, decay: T, scale: T) -> Self {
        let mut rates = [T::zero(); ROOM];
        for (k, rate) in rates.iter_mut().enumerate().skip(1) {
            *rate = decay / T::whole(k);
        }
        Self { coupling, decay, rates, scale }
    }

    /// The acceleration that the state `w` takes from a mass held in place, and its first two derivatives.
    pub fn push(&self, w: T) -> [T; 3] {
        let push = self.coupling * w;
        let falling = -(self.decay * push);
        [push, falling, -(self.decay * falling)]
    }
}

/// A constant acceleration, 0 included.
#[derive(Debug, Clone)]
pub(crate) struct Constant<T> {
    pub acceleration: T,
}

impl<T: Scalar> Tail<T> for Constant<T> {
    type Cursor = ();

    #[inline(always)]
    fn zero_from(&self) -> Option<usize> {
        Some(1)
    }

    #[inline]
    fn extend(&self, _: usize, _: &mut [T; ROOM], _: &[T; ROOM], (): &mut ()) {}
}

impl<T: Scalar> Base<T> for Constant<T> {
    fn acceleration(&self, _: &Instant<T>, _: usize) -> T {
        self.acceleration
    }
}

impl<T: Scalar> Drive<T> for Constant<T> {
    #[inline]
    fn seed(&self, _: &Instant<T>, _: usize, a: &mut [T; ROOM], (): &mut ()) {
        a[0] = self.acceleration; // the others stay 0
    }
    #[inline]
    fn value(&self, _: &Instant<T>, _: usize, _: impl Fn() -> T, (): &mut ()) -> T {
        self.acceleration
    }
    fn next_release(&self, _: &Span<T>, _: ContactAcceleration<T>, (): &mut ()) -> (ReleaseRoot<T>, u64) {
        (ReleaseRoot::Never, 0)
    }
}
