//! How does the motion continue from here, as a power series in time?
//!
//! Taylor coefficients of x'' = -g x' - f(x) - a(t) by recurrence, one order at a time and only as many as
//! are asked for: a flight of a microsecond between two small impacts needs four where a swing across
//! the barrier needs sixteen. f is a polynomial of the current piece about its origin; an odd one goes by the
//! square of the displacement, which halves its products. (Moore 1966, "Interval Analysis", ch. 11; Jorba
//! and Zou 2005, "A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods".)

use super::drive::Tail;
use super::equation::PieceForce;
use crate::numeric::{Number, Scalar};

/// The highest order of a step.
pub(crate) const MAX_ORDER: usize = 32;
/// Room for coefficients 0..=MAX_ORDER.
pub(crate) const ROOM: usize = MAX_ORDER + 2;
/// Coefficients of the drive that are there from the start.
pub(crate) const SEEDED: usize = 4;

/// The Taylor coefficients of one step and the workspace to extend them.
#[derive(Debug, Clone)]
pub(crate) struct Series<T> {
    /// Displacement from the piece's origin: y\[k\] is the coefficient of (time since the step's start)^k.
    pub y: [T; ROOM],
    /// Acceleration of the base.
    pub a: [T; ROOM],
    /// Number of coefficients of y that are known.
    pub known: usize,
    /// The length of a step over which the integral of the squared velocity is known, and that.
    pub measured: Option<(T, T)>,
    square: [T; ROOM],
    /// Products kept for the nested form of the force: one row a degree above the first.
    nested: Vec<[T; ROOM]>,
    inverse: [T; ROOM],
}

/// Where a step's polynomial leads.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State<T> {
    /// Displacement from the piece's origin.
    pub y: T,
    pub v: T,
    pub acceleration: T,
    /// Sum of the magnitudes of the terms above the constant: the mass is never further from the start.
    pub bound: T,
}

impl<T: Number> Series<T> {
    /// With room for forces that take up to `products` products beyond the first.
    pub fn new(products: usize) -> Self {
        let mut inverse = [T::zero(); ROOM];
        for (k, slot) in inverse.iter_mut().enumerate().skip(2) {
            *slot = T::ratio(1.0, (k * (k - 1)) as f64);
        }
        let zeros = [T::zero(); ROOM];
        Self {
            y: zeros,
            a: zeros,
            known: 0,
            measured: None,
            square: zeros,
            nested: vec![zeros; products],
            inverse,
        }
    }

    /// Starts from displacement `y` (from the piece's origin) and velocity `v`; the first
    /// [`SEEDED`] coefficients of the drive are already in `a`.
    #[inline(always)]
    pub fn begin(&mut self, y: T, v: T) {
        self.y[0] = y;
        self.y[1] = v;
        self.known = 2;
        self.measured = None;
    }

    /// Adds the next coefficient.
    #[inline(always)]
    pub fn push<D: Tail<T>>(&mut self, force: &PieceForce<T>, damping: T, drive: &D, roll: &mut D::Rolling) {
        let k = self.known - 2;
        if k >= SEEDED {
            drive.extend(k, &mut self.a, &self.inverse, roll);
        }
        let f = self.force_coefficient(force, k);
        let drag = damping * T::of((k + 1) as f64) * self.y[k + 1];
        self.y[k + 2] = -with_base::<T, D>(drag + f, &self.a, k) * self.inverse[k + 2];
        self.known += 1;
    }

    /// Adds coefficients up to `order`: what [`Self::push`] does, with the shape of the force decided once.
    #[inline(always)]
    pub fn extend_to<D: Tail<T>>(
        &mut self,
        order: usize,
        force: &PieceForce<T>,
        damping: T,
        drive: &D,
        roll: &mut D::Rolling,
    ) {
        let c = force.coefficients();
        let Self { y, a, nested, inverse, .. } = self;
        let known = self.known - 2..order.min(MAX_ORDER) - 1; // the bound spares a look at each index
        match c {
            [c0] => recur(
                known,
                y,
                a,
                inverse,
                damping,
                drive,
                roll,
                #[inline(always)]
                |k, _| at_zero(k, *c0, T::zero()),
            ),
            [c0, c1] => {
                recur(
                    known,
                    y,
                    a,
                    inverse,
                    damping,
                    drive,
                    roll,
                    #[inline(always)]
                    |k, y| at_zero(k, *c0, *c1 * y[k]),
                );
            }
            [_, c1, _, c3] if force.is_odd() => {
                let row = &mut nested[0];
                recur(
                    known,
                    y,
                    a,
                    inverse,
                    damping,
                    drive,
                    roll,
                    #[inline(always)]
                    |k, y| {
                        row[k] = at_zero(k, *c1, *c3 * square(y, k));
                        convolve(row, y, k)
                    },
                );
            }
            _ => {
                while self.known <= order {
                    self.push(force, damping, drive, roll);
                }
                return;
            }
        }
        self.known = order + 1;
    }

    /// Coefficient `k` of the force, from y\[0..=k\]; the lower ones have been asked for before.
    #[inline(always)]
    pub(super) fn force_coefficient(&mut self, force: &PieceForce<T>, k: usize) -> T {
        let c = force.coefficients();
        let constant = if k == 0 { c[0] } else { T::zero() };
        if c.len() <= 2 {
            return match c.get(1) {
                Some(c1) => constant + *c1 * self.y[k],
                None => constant,
            };
        }
        if force.is_odd() {
            self.square[k] = square(&self.y, k);
            // nested[j] is the series of c[2j+1] + c[2j+3] w + c[2j+5] w^2 + ..., w = y^2
            let top = c.len() / 2 - 1;
            for j in (0..top).rev() {
                let product = if j + 1 == top {
                    c[2 * j + 3] * self.square[k]
                } else {
                    convolve(&self.nested[j + 1], &self.square, k)
                };
                self.nested[j][k] = if k == 0 { product + c[2 * j + 1] } else { product };
            }
            return convolve(&self.nested[0], &self.y, k);
        }
        let top = c.len() - 1;
        for j in (0..top).rev() {
            let product =
                if j + 1 == top { c[top] * self.y[k] } else { convolve(&self.nested[j + 1], &self.y, k) };
            self.nested[j][k] = if k == 0 { product + c[j] } else { product };
        }
        self.nested[0][k]
    }

    /// Adds coefficient `k` of the drive, at or above [`SEEDED`]; once each and in ascending order.
    pub(super) fn extend_drive<D: Tail<T>>(&mut self, k: usize, drive: &D, roll: &mut D::Rolling) {
        drive.extend(k, &mut self.a, &self.inverse, roll);
    }

    /// The state at time `t` into the step, and a bound of the way up to there.
    #[inline(always)]
    pub fn state(&self, t: T) -> State<T> {
        let zero = T::zero();
        let (mut y, mut v, mut half, mut bound) = (zero, zero, zero, zero);
        for c in self.y[1..self.known].iter().rev() {
            half = half * t + v;
            v = v * t + y;
            y = y * t + *c;
            bound = bound * t + c.abs();
        }
        half = half * t + v;
        v = v * t + y;
        y = y * t + self.y[0];
        State { y, v, acceleration: half + half, bound: bound * t }
    }

    /// The coefficients of the base's acceleration that go with those of the motion.
    #[inline]
    pub fn base_coefficients(&self) -> &[T] {
        &self.a[..(self.known - 2).max(SEEDED)]
    }
}

impl<T: Scalar> Series<T> {
    /// The longest step whose first neglected term in the velocity stays below `tolerance` times `speed`, at most `cap`.
    #[inline]
    pub fn natural_step(&self, speed_log2: f64, tolerance_log2: f64, cap: f64) -> f64 {
        let [step] =
            natural_steps(self.known - 1, |k| [self.y[k].to_f64()], &[speed_log2], tolerance_log2, &[cap]);
        step
    }

    /// Acceleration of the base at time `t` into the step, by its series.
    pub fn base(&self, t: T) -> T {
        self.base_coefficients().iter().rev().fold(T::zero(), |sum, c| sum * t + *c)
    }
}

/// As [`Series::natural_step`], of coefficients up to `order`, for several series at once; from several of the last ones,
/// since single ones vanish at symmetry points. NaN where one is.
#[inline(always)]
pub(super) fn natural_steps<const W: usize>(
    order: usize,
    coefficients: impl Fn(usize) -> [f64; W],
    speed_log2: &[f64; W],
    tolerance_log2: f64,
    cap: &[f64; W],
) -> [f64; W] {
    let (mut radius, mut sum) = ([f64::INFINITY; W], [0.0; W]);
    for k in order.saturating_sub(3).max(2)..=order {
        let coefficients = coefficients(k);
        let inverse = 1.0 / (k as f64 - 1.0);
        for lane in 0..W {
            let size = coefficients[lane].abs() * k as f64;
            let own = (speed_log2[lane] - fast_log2(size)) * inverse;
            radius[lane] = if (size > 1e-300) & (own < radius[lane]) { own } else { radius[lane] };
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

/// `rest`, and `value` in the constant term: elsewhere nothing is added, not a 0, on which the next would wait.
#[inline(always)]
fn at_zero<T: Number>(k: usize, value: T, rest: T) -> T {
    if k == 0 { rest + value } else { rest }
}

/// `sum` and coefficient `k` of the base's acceleration, where it may be other than 0.
#[inline(always)]
fn with_base<T: Number, D: Tail<T>>(sum: T, a: &[T; ROOM], k: usize) -> T {
    if k < D::ZERO_FROM { sum + a[k] } else { sum }
}

/// The recurrence of the equation of motion over the orders `known`, the force's coefficients by `force`.
#[allow(clippy::too_many_arguments)] // fields borrowed apart, so that `force` may hold the others
#[inline(always)]
fn recur<T: Number, D: Tail<T>>(
    known: std::ops::Range<usize>,
    y: &mut [T; ROOM],
    a: &mut [T; ROOM],
    inverse: &[T; ROOM],
    damping: T,
    drive: &D,
    roll: &mut D::Rolling,
    mut force: impl FnMut(usize, &[T; ROOM]) -> T,
) {
    for k in known {
        if k >= SEEDED {
            drive.extend(k, a, inverse, roll);
        }
        let f = force(k, y);
        let drag = damping * T::of((k + 1) as f64) * y[k + 1];
        y[k + 2] = -with_base::<T, D>(drag + f, a, k) * inverse[k + 2];
    }
}

/// Sum of a\[i\] b\[k-i\] over i = 0..=k; two running sums, since one addition waits for the last.
#[inline(always)]
pub(crate) fn convolve<T: Number>(a: &[T; ROOM], b: &[T; ROOM], k: usize) -> T {
    let mut even = T::zero();
    let mut odd = T::zero();
    let mut pairs = a[..=k].iter().zip(b[..=k].iter().rev());
    while let Some((p, q)) = pairs.next() {
        even += *p * *q;
        if let Some((p, q)) = pairs.next() {
            odd += *p * *q;
        }
    }
    even + odd
}

/// Sum of a\[i\] a\[k-i\] over i = 0..=k by symmetry.
#[inline(always)]
fn square<T: Number>(a: &[T; ROOM], k: usize) -> T {
    let half = k.div_ceil(2);
    let mut even = T::zero();
    let mut odd = T::zero();
    let mut pairs = a[..half].iter().zip(a[k + 1 - half..=k].iter().rev());
    while let Some((p, q)) = pairs.next() {
        even += *p * *q;
        if let Some((p, q)) = pairs.next() {
            odd += *p * *q;
        }
    }
    let twice = (even + odd) + (even + odd);
    if k.is_multiple_of(2) { twice + a[k / 2] * a[k / 2] } else { twice }
}

/// log2 to 0.01, for step sizes only: the same bits on every processor, unlike a library's.
#[inline(always)]
pub(crate) fn fast_log2(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = (bits >> 52) as i64 - 1023;
    let m = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000) - 1.0;
    exponent as f64 + m * (1.3465 - 0.3465 * m)
}

/// 2^x to 0.3 %, for |x| up to 1000, for step sizes only.
#[inline(always)]
pub(crate) fn fast_exp2(x: f64) -> f64 {
    const NO_FRACTION: f64 = 6_755_399_441_055_744.0; // 1.5 2^52
    let nearest = (x + NO_FRACTION) - NO_FRACTION;
    let whole = if nearest > x { nearest - 1.0 } else { nearest };
    let f = x - whole;
    let mantissa = 1.0 + f * (0.6565 + 0.3435 * f);
    f64::from_bits(((whole as i64 + 1023).clamp(1, 2046) as u64) << 52) * mantissa
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quick_logarithms_are_good_enough_for_a_step() {
        for i in 1..2000 {
            let x = f64::from(i) * 0.37;
            assert!((fast_log2(x) - x.log2()).abs() < 0.01);
            let y = f64::from(i - 1000) * 0.1;
            assert!((fast_exp2(y) / y.exp2() - 1.0).abs() < 4e-3);
        }
    }
}
