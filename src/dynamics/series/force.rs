//! Power series in time of the force, from that of the displacement.
//!
//! The force is a polynomial of the displacement, so its coefficients are sums of products of those of the
//! displacement. The newest of these, y\[k\], enters coefficient k of the force by one product only, with the
//! stiffness where the step begins:
//!
//! ```text
//! f[k] = f'(y[0]) y[k] + terms of y[0..k].
//! ```
//!
//! All other terms are there before it is, so that the processor has summed them by the time; the recurrence
//! waits for two operations an order instead of two sums.

use super::order::ROOM;
use crate::dynamics::equation::force::PieceForce;
use crate::numeric::Number;

/// The nested form of a force, each level a series.
#[derive(Debug, Clone)]
pub(crate) struct ForceSeries<T> {
    /// The square of the displacement, where the force is odd.
    square: [T; ROOM],
    /// The levels, the outermost first: row j is that of c\[j\] + c\[j+1\] y + c\[j+2\] y^2 + ..., of an odd
    /// force that of c\[2j+1\] + c\[2j+3\] w + ..., w = y^2.
    rows: Vec<[T; ROOM]>,
    /// What a row changes by with the newest coefficient of the displacement.
    slopes: [T; ROOM],
    /// The same of the force: the stiffness where the step begins.
    slope: T,
}

impl<T: Number> ForceSeries<T> {
    /// With room for forces that take up to `products` products beyond the first.
    pub fn new(products: usize) -> Self {
        let zeros = [T::zero(); ROOM];
        Self { square: zeros, rows: vec![zeros; products], slopes: zeros, slope: T::zero() }
    }

    /// Coefficient `k` of the force and of what is added to it, from y\[0..=k\]; the lower ones have been
    /// asked for before.
    #[inline(always)]
    pub fn coefficient(&mut self, force: &PieceForce<T>, y: &[T; ROOM], k: usize, more: Option<T>) -> T {
        match force.coefficients() {
            [c0] => constant(*c0, k, more),
            [c0, c1] => linear(*c0, *c1, y, k, more),
            c if force.is_odd() => self.odd(c, y, k, more),
            c => self.dense(c, y, k, more),
        }
    }

    /// What gives the coefficients of the force c1 y + c3 y^3 from the displacement `start` on.
    #[inline(always)]
    pub fn cubic(&mut self, c1: T, c3: T, start: T) -> Cubic<'_, T> {
        let row = &mut self.rows[0];
        let change = c3 * (start + start);
        row[0] = c3 * (start * start) + c1;
        Cubic { c3, start, change, slope: row[0] + change * start, row }
    }

    /// Coefficient `k`, and what is added to it, of a force all of whose even coefficients are 0, of degree 3
    /// or more.
    #[inline(always)]
    pub fn odd(&mut self, c: &[T], y: &[T; ROOM], k: usize, more: Option<T>) -> T {
        let (top, twice) = (c.len() / 2 - 1, y[0] + y[0]);
        let Self { square, rows, slopes, slope } = self;
        let rows = &mut rows[..top];
        if k == 0 {
            let (mut value, mut change) = (c[2 * top + 1], T::zero());
            square[0] = y[0] * y[0];
            for j in (0..top).rev() {
                change = value * twice + square[0] * change;
                value = value * square[0] + c[2 * j + 1];
                (rows[j][0], slopes[j]) = (value, change);
            }
            *slope = value + change * y[0];
            return plus(value * y[0], more);
        }
        let others = inner_square(y, k);
        square[k] = others + twice * y[k];
        let mut rest = c[2 * top + 1] * others;
        rows[top - 1][k] = rest + slopes[top - 1] * y[k];
        for j in (0..top - 1).rev() {
            let above = &rows[j + 1];
            rest = inner_convolve(above, square, k) + (above[0] * others + square[0] * rest);
            rows[j][k] = rest + slopes[j] * y[k];
        }
        plus(inner_convolve(&rows[0], y, k) + rest * y[0], more) + *slope * y[k]
    }

    /// The same of any force of degree 2 or more.
    #[inline(always)]
    pub fn dense(&mut self, c: &[T], y: &[T; ROOM], k: usize, more: Option<T>) -> T {
        let top = c.len() - 1;
        let Self { rows, slopes, .. } = self;
        let rows = &mut rows[..top];
        if k == 0 {
            let (mut value, mut change) = (c[top], T::zero());
            for j in (0..top).rev() {
                change = value + y[0] * change;
                value = value * y[0] + c[j];
                (rows[j][0], slopes[j]) = (value, change);
            }
            return plus(value, more);
        }
        let mut rest = T::zero();
        rows[top - 1][k] = slopes[top - 1] * y[k];
        for j in (1..top - 1).rev() {
            rest = inner_convolve(&rows[j + 1], y, k) + rest * y[0];
            rows[j][k] = rest + slopes[j] * y[k];
        }
        plus(inner_convolve(&rows[1], y, k) + rest * y[0], more) + slopes[0] * y[k]
    }
}

/// An odd cubic, as most scenes have it: as [`ForceSeries::odd`], with what stays from order to order at
/// hand.
pub(crate) struct Cubic<'a, T> {
    c3: T,
    start: T,
    /// Slopes of the row and of the force.
    change: T,
    slope: T,
    /// c1 + c3 y^2.
    row: &'a mut [T; ROOM],
}

impl<T: Number> Cubic<'_, T> {
    /// Coefficient `k` of the force, and what is added to it.
    #[inline(always)]
    pub fn coefficient(&mut self, y: &[T; ROOM], k: usize, more: Option<T>) -> T {
        if k == 0 {
            return plus(self.row[0] * self.start, more);
        }
        let rest = self.c3 * inner_square(y, k);
        self.row[k] = rest + self.change * y[k];
        plus(inner_convolve(self.row, y, k) + rest * self.start, more) + self.slope * y[k]
    }
}

/// Coefficient `k` of a force that does not change, and `more`.
#[inline(always)]
pub(crate) fn constant<T: Number>(c0: T, k: usize, more: Option<T>) -> T {
    match more {
        _ if k == 0 => plus(c0, more),
        Some(more) => more,
        None => T::zero(),
    }
}

/// Coefficient `k` of a force that is a straight line, and `more`.
#[inline(always)]
pub(crate) fn linear<T: Number>(c0: T, c1: T, y: &[T; ROOM], k: usize, more: Option<T>) -> T {
    let own = c1 * y[k];
    if k == 0 { plus(own + c0, more) } else { plus(own, more) }
}

/// The sum, where there is something to add; otherwise no addition is executed.
#[inline(always)]
fn plus<T: Number>(sum: T, more: Option<T>) -> T {
    match more {
        Some(more) => sum + more,
        None => sum,
    }
}

/// Sum of a\[i\] b\[k-i\] over i = 0..=k.
#[inline(always)]
pub(crate) fn convolve<T: Number>(a: &[T; ROOM], b: &[T; ROOM], k: usize) -> T {
    let ends = a[0] * b[k];
    if k == 0 { ends } else { inner_convolve(a, b, k) + (ends + a[k] * b[0]) }
}

/// Sum of a\[i\] a\[k-i\] over i = 0..=k.
#[inline(always)]
pub(crate) fn square<T: Number>(a: &[T; ROOM], k: usize) -> T {
    let ends = a[0] * a[k];
    if k == 0 { ends } else { inner_square(a, k) + (ends + ends) }
}

/// Sum of a\[i\] b\[k-i\] over i = 1..k, from the middle outwards: the terms of the highest orders, which
/// have only just become known, come last. Two running sums, since one addition waits for the last.
#[inline(always)]
fn inner_convolve<T: Number>(a: &[T; ROOM], b: &[T; ROOM], k: usize) -> T {
    if k < 2 {
        return T::zero();
    }
    let half = k.div_ceil(2);
    let middle = a[k - half] * b[half];
    if k == 2 {
        return middle;
    }
    // (no sum begins with 0: the next would wait for it)
    let (mut low, mut high) = match k.is_multiple_of(2) {
        true => (middle + a[half - 1] * b[half + 1], a[half + 1] * b[half - 1]),
        false => (middle, a[half] * b[k - half]),
    };
    for i in (1..half - 1).rev() {
        low += a[i] * b[k - i];
        high += a[k - i] * b[i];
    }
    low + high
}

/// Sum of a\[i\] a\[k-i\] over i = 1..k by symmetry, in that order.
#[inline(always)]
fn inner_square<T: Number>(a: &[T; ROOM], k: usize) -> T {
    match k {
        0 | 1 => return T::zero(),
        2 => return a[1] * a[1],
        _ => {}
    }
    let last = (k - 1) / 2;
    let mut sum = a[last] * a[k - last];
    for i in (1..last).rev() {
        sum += a[i] * a[k - i];
    }
    let twice = sum + sum;
    if k.is_multiple_of(2) { twice + a[k / 2] * a[k / 2] } else { twice }
}
