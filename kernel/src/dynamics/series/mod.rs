//! Taylor series of the motion in time.
//!
//! Taylor coefficients of x'' = -g x' - f(x) - a(t) follow by recurrence, one order at a time and only as
//! many as are needed: a flight of a microsecond between two small impacts needs four, a motion across the
//! barrier sixteen. f is the polynomial of the current piece. (Moore 1966, "Interval Analysis", ch. 11; Jorba
//! and Zou 2005, "A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods".)

mod force;
mod order;
pub(crate) mod polynomial;

use std::cell::Cell;

use crate::dynamics::equation::force::PieceForce;
use crate::numeric::{Number, Scalar, fast_exp2, fast_log2};
use force::ForceSeries;

pub(crate) use force::{convolve, square};
pub(crate) use order::{MAX_ORDER, ROOM, SEEDED, Tail};

/// The Taylor coefficients of one step and the workspace to extend them.
#[derive(Debug, Clone)]
pub(crate) struct Series<T: Copy> {
    /// Displacement from the piece's origin: y\[k\] is the coefficient of (time since the step's start)^k.
    pub y: [T; ROOM],
    pub a: [T; ROOM],
    pub known: usize,
    pub measured: Cell<Option<Integrals<T>>>,
    forces: ForceSeries<T>,
    inverse: [T; ROOM],
}

/// Integrals over a step from its start on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Integrals<T> {
    /// Time since the step's start up to which they are taken.
    pub until: T,
    pub squared: T,
    /// Integral of base acceleration times velocity; 0 in a run without a ledger.
    pub work: T,
}

/// The state at the end of a step's polynomial.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Endpoint<T> {
    pub y: T,
    pub v: T,
    pub acceleration: T,
    /// Sum of the magnitudes of the terms above the constant: a bound of the distance from the start.
    pub bound: T,
}

impl<T: Number> Series<T> {
    /// With room for forces of up to this degree.
    pub fn new(degree: usize) -> Self {
        let mut inverse = [T::zero(); ROOM];
        for (k, slot) in inverse.iter_mut().enumerate().skip(2) {
            *slot = T::ratio(1.0, (k * (k - 1)) as f64);
        }
        let zeros = [T::zero(); ROOM];
        Self {
            y: zeros,
            a: zeros,
            known: 0,
            measured: Cell::new(None),
            forces: ForceSeries::new(degree),
            inverse,
        }
    }

    /// Starts from displacement `y` (from the piece's origin) and velocity `v`; the first [`SEEDED`]
    /// coefficients of the drive are already in `a`.
    #[inline(always)]
    pub fn begin(&mut self, y: T, v: T) {
        self.y[0] = y;
        self.y[1] = v;
        self.known = 2;
        self.measured.set(None);
    }

    #[inline(always)]
    pub fn extend_to<D: Tail<T>>(
        &mut self,
        order: usize,
        force: &PieceForce<T>,
        damping: T,
        drive: &D,
        cursor: &mut D::Cursor,
    ) {
        self.extend_while(
            order,
            (force, &[]),
            damping,
            drive,
            cursor,
            #[inline(always)]
            |_, _| true,
        );
    }

    /// Adds coefficients up to `order`, as long as `more`, called with the order and value of the last one,
    /// returns true. `about` are the coefficients of the force about the start of the series, or empty.
    #[inline(always)]
    pub fn extend_while<D: Tail<T>>(
        &mut self,
        order: usize,
        (force, about): (&PieceForce<T>, &[T]),
        damping: T,
        drive: &D,
        cursor: &mut D::Cursor,
        mut more: impl FnMut(usize, T) -> bool,
    ) {
        let mut last = self.known - 1;
        let Self { y, a, forces, inverse, .. } = self;
        let known = self.known - 2..order.min(MAX_ORDER) - 1; // the bound removes the check of each index
        // The degree of the force is matched once.
        macro_rules! recur {
            ($unrolled:expr, $force:expr) => {
                recur::<T, D, { $unrolled }>(
                    known,
                    (y, a, inverse),
                    damping,
                    drive,
                    cursor,
                    #[inline(always)]
                    $force,
                    #[inline(always)]
                    |k, c| {
                        last = k;
                        more(k, c)
                    },
                )
            };
        }
        match force.coefficients.as_slice() {
            [c0] => recur!(true, |k, _, more| force::constant(*c0, k, more)),
            [c0, c1] => recur!(true, |k, y, more| force::linear(*c0, *c1, y, k, more)),
            [c0, c1, c2] => {
                let mut cubic = forces.cubic([*c0, *c1, *c2, T::zero()], y[0]);
                recur!(true, |k, y, more| cubic.coefficient(y, k, more));
            }
            [c0, c1, c2, c3] => {
                let mut cubic = forces.cubic([*c0, *c1, *c2, *c3], y[0]);
                recur!(true, |k, y, more| cubic.coefficient(y, k, more));
            }
            _ => {
                forces.prepare((force, about), y, known.clone());
                recur!(false, |k, y, more| forces.nested(y, k, more));
            }
        }
        self.known = last + 1;
    }

    /// Coefficient `k` of the force, from y\[0..=k\]; the lower ones must have been computed before.
    #[inline(always)]
    pub(crate) fn force_coefficient(&mut self, force: &PieceForce<T>, k: usize) -> T {
        self.forces.coefficient(force, &self.y, k)
    }

    /// Adds coefficient `k` of the drive, at or above [`SEEDED`]; once for each `k`, in ascending order.
    pub(crate) fn extend_drive<D: Tail<T>>(&mut self, k: usize, drive: &D, cursor: &mut D::Cursor) {
        drive.extend(k, &mut self.a, &self.inverse, cursor);
    }

    /// The state at time `t` into the step, and a bound of the distance moved up to then.
    #[inline(always)]
    pub fn state(&self, t: T) -> Endpoint<T> {
        let zero = T::zero();
        let (mut y, mut v, mut acceleration, mut bound) = (zero, self.y[1], zero, zero);
        // Powers are accumulated and terms are summed: each order waits for one product or one sum of the
        // previous order, where Horner's rule waits for both.
        let (mut before, mut power) = (T::of(1.0), t);
        each_order::<T, true, 2>(
            2..self.known,
            #[inline(always)]
            |k| {
                let c = self.y[k];
                acceleration += T::whole(k * (k - 1)) * c * before;
                v += T::whole(k) * c * power;
                (before, power) = (power, power * t);
                let term = c * power;
                y += term;
                bound += term.abs();
            },
        );
        let term = self.y[1] * t;
        Endpoint { y: self.y[0] + (term + y), v, acceleration, bound: term.abs() + bound }
    }

    #[inline(always)]
    pub fn coefficients(&self) -> &[T] {
        &self.y[..self.known]
    }

    /// The coefficients of the base's acceleration that belong to those of the motion.
    #[inline]
    pub fn base_coefficients(&self) -> &[T] {
        &self.a[..(self.known - 2).max(SEEDED)]
    }
}

impl<T: Scalar> Series<T> {
    /// As [`Self::extend_to`], but not inlined, since it is large.
    #[inline(never)]
    pub fn extend<D: Tail<T>>(
        &mut self,
        order: usize,
        force: &PieceForce<T>,
        damping: T,
        drive: &D,
        cursor: &mut D::Cursor,
    ) {
        self.extend_to(order, force, damping, drive, cursor);
    }

    /// The longest step, at most `cap`, whose first neglected term in the velocity is below `tolerance` times
    /// `speed`.
    #[inline]
    pub fn natural_step(&self, speed_log2: f64, tolerance_log2: f64, cap: f64) -> f64 {
        let [step] =
            natural_steps(self.known - 1, |k| [self.y[k].magnitude()], &[speed_log2], tolerance_log2, &[cap]);
        step
    }

    /// Acceleration of the base at time `t` into the step, by its series.
    pub fn base(&self, t: T) -> T {
        self.base_coefficients().iter().rev().fold(T::zero(), |sum, c| sum * t + *c)
    }
}

/// As [`Series::natural_step`], from coefficients up to `order`, for several series at once. It uses several
/// of the last coefficients, since single ones vanish at symmetry points. NaN if one of them is NaN.
#[inline(always)]
pub(crate) fn natural_steps<const W: usize>(
    order: usize,
    coefficients: impl Fn(usize) -> [f64; W],
    speed_log2: &[f64; W],
    tolerance_log2: f64,
    cap: &[f64; W],
) -> [f64; W] {
    let (mut radius, mut sum) = ([f64::INFINITY; W], [0.0; W]);
    let last = order.clamp(5, MAX_ORDER);
    for k in [last - 3, last - 2, last - 1, last] {
        let coefficients = coefficients(k);
        let inverse = 1.0 / (k as f64 - 1.0);
        for lane in 0..W {
            let size = coefficients[lane].abs() * k as f64;
            let estimate = (speed_log2[lane] - fast_log2(size)) * inverse;
            radius[lane] = if (size > 1e-300) & (estimate < radius[lane]) { estimate } else { radius[lane] };
            sum[lane] += size;
        }
    }
    let mut steps = [0.0; W];
    for lane in 0..W {
        let log2 = radius[lane] + tolerance_log2 / order as f64;
        let step = fast_exp2(if log2 < 1000.0 { log2 } else { 1000.0 });
        let step = if (log2 < 1000.0) & (step < cap[lane]) { step } else { cap[lane] };
        steps[lane] = if sum[lane].is_nan() { f64::NAN } else { step };
    }
    steps
}

/// The recurrence of the equation of motion over the orders `known`. `force` gives the coefficients of the
/// force plus its third argument. Ends early once `more` returns false.
#[inline(always)]
fn recur<T: Number, D: Tail<T>, const SIMPLE: bool>(
    known: std::ops::Range<usize>,
    (y, a, inverse): (&mut [T; ROOM], &mut [T; ROOM], &[T; ROOM]),
    damping: T,
    drive: &D,
    cursor: &mut D::Cursor,
    mut force: impl FnMut(usize, &[T; ROOM], Option<T>) -> T,
    mut more: impl FnMut(usize, T) -> bool,
) {
    each_order_while::<T, SIMPLE, 0>(
        known,
        #[inline(always)]
        |k| {
            if k >= SEEDED {
                drive.extend(k, a, inverse, cursor);
            }
            let base = if drive.zero_from().is_none_or(|zero| k < zero) { Some(a[k]) } else { None };
            let drag = damping * T::whole(k + 1) * y[k + 1];
            let drag = match drive.couple(k, y, cursor) {
                Some(push) => drag + push,
                None => drag,
            };
            let next = -(force(k, y, base) + drag) * inverse[k + 2];
            y[k + 2] = next;
            more(k + 2, next)
        },
    );
}

/// Calls `next` for each of the orders. If `UNROLLED`, the first order is `USUAL` and the arithmetic of `T`
/// is quick, the loop is unrolled with constant orders: its bookkeeping may cost as much as its body.
#[inline(always)]
pub(crate) fn each_order<T: Number, const UNROLLED: bool, const USUAL: usize>(
    orders: std::ops::Range<usize>,
    mut next: impl FnMut(usize),
) {
    each_order_while::<T, UNROLLED, USUAL>(
        orders,
        #[inline(always)]
        |k| {
            next(k);
            true
        },
    );
}

/// The same until `next` returns false.
#[inline(always)]
fn each_order_while<T: Number, const UNROLLED: bool, const USUAL: usize>(
    orders: std::ops::Range<usize>,
    mut next: impl FnMut(usize) -> bool,
) {
    let mut rest = orders.start;
    // Each condition is constant, so that a branch that is never taken is not compiled: twenty copies of a
    // body in double-double arithmetic take long to compile.
    if UNROLLED && T::QUICK && orders.start == USUAL {
        macro_rules! each {
            ($($k:literal)*) => {
                $(
                    if $k >= USUAL {
                        if orders.end <= $k || !next($k) {
                            return;
                        }
                    }
                )*
            };
        }
        each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19);
        rest = 20;
    }
    for k in rest..orders.end {
        if !next(k) {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_that_stops_early_and_goes_on_has_the_same_bits() {
        for degree in [0, 1, 2, 3, 9] {
            let coefficients = (0..=degree).map(|k| 0.7 - 0.3 * f64::from(k)).collect();
            let force = PieceForce { coefficients };
            let drive = crate::dynamics::drive::tone::Harmonic { curvature: -1.3 };
            let begun = || {
                let mut series = Series::<f64>::new(force.degree());
                drive.seed(0.4, -0.2, &mut series.a);
                series.begin(0.3, 0.5);
                series
            };
            let mut whole = begun();
            whole.extend(18, &force, 0.1, &drive, &mut ());
            for stop in [3, 4, 7, 17, 18] {
                let mut parts = begun();
                parts.extend_while(18, (&force, &[]), 0.1, &drive, &mut (), |k, _| k < stop);
                assert_eq!(parts.known, stop + 1);
                parts.extend(18, &force, 0.1, &drive, &mut ());
                assert_eq!((parts.y, parts.known), (whole.y, whole.known), "{degree} {stop}");
            }
        }
    }
}
