//! Power series in time of the force, computed from that of the displacement.
//!
//! The force is a polynomial of the displacement. About the displacement at the start of the step it is
//!
//! ```text
//! a[0] + w (a[1] + w (a[2] + ...)),  w = y - y[0],
//! ```
//!
//! and w has no constant term, so the bracket at depth l, b(l), is needed only up to an order l below that of
//! the force:
//!
//! ```text
//! b(l)[n] = sum of y[i] b(l+1)[n-i] over i = 1..=n,  b(l)[0] = a[l],  f = b(0).
//! ```
//!
//! If the degree is near the order, this takes a third of the products of the powers of y. Coefficients of
//! one order do not depend on each other, so four depths are summed side by side. The newest coefficient,
//! y\[k\], enters coefficient k of the force by a single product, with the stiffness a\[1\] at the start of
//! the step; all other terms are known earlier, so that the processor can sum them in advance.

use super::order::ROOM;
use crate::dynamics::equation::force::PieceForce;
use crate::numeric::{Number, shift};

/// Number of depths that are summed side by side.
const BLOCK: usize = 4;

/// The force about the displacement at the start of a step, in nested form.
#[derive(Debug, Clone)]
pub(crate) struct ForceSeries<T> {
    /// Row n holds coefficient n of the brackets, the outermost first, and zeros beyond the degree.
    rows: Vec<T>,
    stride: usize,
    /// The degree beyond which they are zeros.
    degree: usize,
    /// The bracket of a cubic.
    row: [T; ROOM],
    /// The highest order of the force for which the rows are computed.
    last: usize,
}

impl<T: Number> ForceSeries<T> {
    /// With room for forces of up to this degree.
    pub fn new(degree: usize) -> Self {
        let zero = T::zero();
        let stride = degree + 1 + BLOCK;
        let rows = if degree > 3 { vec![zero; ROOM * stride] } else { Vec::new() };
        Self { rows, stride, degree, row: [zero; ROOM], last: 0 }
    }

    /// Coefficient `k` of the force, from y\[0..=k\]; the lower ones must have been computed before.
    #[inline(always)]
    pub fn coefficient(&mut self, force: &PieceForce<T>, y: &[T; ROOM], k: usize) -> T {
        match force.coefficients.as_slice() {
            [c0] => constant(*c0, k, None),
            [c0, c1] => linear(*c0, *c1, y, k, None),
            [c0, c1, c2] => self.cubic([*c0, *c1, *c2, T::zero()], y[0]).coefficient(y, k, None),
            [c0, c1, c2, c3] => self.cubic([*c0, *c1, *c2, *c3], y[0]).coefficient(y, k, None),
            _ => {
                self.prepare((force, &[]), y, k..k + 1);
                self.nested(y, k, None)
            }
        }
    }

    /// A cubic force about the displacement `start`.
    #[inline(always)]
    pub fn cubic(&mut self, mut about: [T; 4], start: T) -> Cubic<'_, T> {
        shift(&mut about, start);
        Cubic { about, row: &mut self.row }
    }

    /// Prepares coefficients of these orders, for a force of degree 4 or more. `about` are its coefficients
    /// about y\[0], if they are known, and otherwise empty. The lower orders must have been computed.
    #[inline(always)]
    pub fn prepare(
        &mut self,
        (force, about): (&PieceForce<T>, &[T]),
        y: &[T; ROOM],
        orders: std::ops::Range<usize>,
    ) {
        let Some(last) = orders.end.checked_sub(1) else { return };
        if orders.start == 0 {
            if self.degree != force.degree() {
                self.degree = force.degree();
                self.rows.fill(T::zero());
            }
            let row = &mut self.rows[..=self.degree];
            if about.is_empty() {
                row.copy_from_slice(&force.coefficients);
                shift(row, y[0]);
            } else {
                row.copy_from_slice(about);
            }
        } else if last > self.last {
            for n in 1..orders.start {
                self.sum(y, n, self.last - n + 1..self.degree.min(last - n + 1));
            }
        }
        self.last = last;
    }

    /// Coefficient `k` of the force, plus `more`.
    #[inline(always)]
    pub fn nested(&mut self, y: &[T; ROOM], k: usize, more: Option<T>) -> T {
        if k > 0 {
            self.sum(y, k, 0..self.degree.min(self.last - k + 1));
        }
        plus(self.rows[k * self.stride], more)
    }

    /// Sums coefficient `n` of the brackets of these depths, four side by side.
    #[inline(always)]
    fn sum(&mut self, y: &[T; ROOM], n: usize, mut depths: std::ops::Range<usize>) {
        // Named variables: from an array the compiler would gather the same lane of each sum.
        macro_rules! side_by_side {
            ($first:expr, $($at:literal $sum:ident)*) => {{
                let (above, current) = self.rows.split_at_mut(n * self.stride);
                let first = $first;
                let mut rows = above.chunks_exact(self.stride).rev().zip(&y[1..=n]);
                if let Some((row, y)) = rows.next() {
                    let row = &row[first + 1..first + 1 + BLOCK];
                    // no sum begins with 0: the next addition would wait for it
                    $(let mut $sum = *y * row[$at];)*
                    for (row, y) in rows {
                        let row = &row[first + 1..first + 1 + BLOCK];
                        $($sum += *y * row[$at];)*
                    }
                    let current = &mut current[first..first + BLOCK];
                    $(current[$at] = $sum;)*
                }
            }};
        }
        while !depths.is_empty() {
            match depths.len() {
                1 => side_by_side!(depths.start, 0 a),
                2 => side_by_side!(depths.start, 0 a 1 b),
                3 => side_by_side!(depths.start, 0 a 1 b 2 c),
                _ => side_by_side!(depths.start, 0 a 1 b 2 c 3 d),
            }
            depths.start += BLOCK;
        }
    }
}

/// A cubic about the displacement at the start of a step, with the terms that are reused from order to order.
pub(crate) struct Cubic<'a, T> {
    about: [T; 4],
    /// a\[1\] + a\[2\] w + a\[3\] w^2.
    row: &'a mut [T; ROOM],
}

impl<T: Number> Cubic<'_, T> {
    /// Coefficient `k` of the force, plus `more`.
    #[inline(always)]
    pub fn coefficient(&mut self, y: &[T; ROOM], k: usize, more: Option<T>) -> T {
        let [a0, a1, a2, a3] = self.about;
        if k == 0 {
            return plus(a0, more);
        }
        let linear_term = a1 * y[k];
        match k {
            1 => {}
            2 => self.row[1] = a2 * y[1],
            _ => self.row[k - 1] = a2 * y[k - 1] + a3 * inner_square(y, k - 1),
        }
        plus(inner_convolve(y, self.row, k), more) + linear_term
    }
}

/// Coefficient `k` of a constant force, plus `more`.
#[inline(always)]
pub(crate) fn constant<T: Number>(c0: T, k: usize, more: Option<T>) -> T {
    match more {
        _ if k == 0 => plus(c0, more),
        Some(more) => more,
        None => T::zero(),
    }
}

/// Coefficient `k` of a linear force, plus `more`.
#[inline(always)]
pub(crate) fn linear<T: Number>(c0: T, c1: T, y: &[T; ROOM], k: usize, more: Option<T>) -> T {
    let linear_term = c1 * y[k];
    if k == 0 { plus(linear_term + c0, more) } else { plus(linear_term, more) }
}

/// `sum` plus `more`; without `more` no addition is executed.
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

/// Sum of a\[i\] b\[k-i\] over i = 1..k, from the middle outwards: the terms of the highest orders, which are
/// known last, come last. There are two running sums, since an addition waits for the one before.
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
    // no sum begins with 0: the next addition would wait for it
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

/// Sum of a\[i\] a\[k-i\] over i = 1..k by symmetry, in the same order.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::{DoubleDouble, Scalar};

    /// Coefficients of a force of this degree, and those of a motion.
    fn some<T: Number>(degree: usize) -> (PieceForce<T>, [T; ROOM]) {
        let coefficients = (0..=degree).map(|k| T::of(0.7 - 0.37 * (k % 5) as f64)).collect();
        let mut y = [T::zero(); ROOM];
        for (k, slot) in y.iter_mut().enumerate().take(20) {
            *slot = T::of(0.8 / (1.0 + k as f64) * if k % 3 == 1 { -1.0 } else { 1.0 });
        }
        (PieceForce { coefficients }, y)
    }

    /// The series of the force by Horner's rule on whole series, in double-double arithmetic.
    fn by_horner(degree: usize) -> Vec<f64> {
        let (force, y) = some::<DoubleDouble>(degree);
        let mut sum = [DoubleDouble::zero(); ROOM];
        for c in force.coefficients.iter().rev() {
            let last = sum;
            for (k, sum) in sum.iter_mut().enumerate() {
                *sum = convolve(&last, &y, k);
            }
            sum[0] += *c;
        }
        sum.iter().map(|c| c.to_f64()).collect()
    }

    #[test]
    fn forces_of_every_degree_have_the_series_of_the_polynomial() {
        for degree in 0..=13 {
            let exact = by_horner(degree);
            let largest = exact[..18].iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
            let (force, y) = some::<f64>(degree);
            let mut series = ForceSeries::new(degree);
            for (k, exact) in exact.iter().enumerate().take(18) {
                let value = series.coefficient(&force, &y, k);
                assert!((value - exact).abs() < 1e-13 * largest, "{degree} {k}: {value:e} {exact:e}");
            }
        }
    }

    #[test]
    fn after_a_force_of_another_degree_the_bits_are_the_same() {
        let (low, y) = some::<f64>(5);
        let (high, other) = some::<f64>(11);
        let series = |force_series: &mut ForceSeries<f64>, force, y| -> Vec<f64> {
            (0..18).map(|k| force_series.coefficient(force, y, k)).collect()
        };
        let alone = series(&mut ForceSeries::new(11), &low, &y);
        let mut used = ForceSeries::new(11);
        series(&mut used, &high, &other);
        assert_eq!(series(&mut used, &low, &y), alone);
    }

    #[test]
    fn however_it_is_extended_the_bits_are_the_same() {
        let (force, y) = some::<f64>(9);
        let mut series = ForceSeries::new(9);
        let one_by_one: Vec<f64> = (0..18).map(|k| series.coefficient(&force, &y, k)).collect();
        for ends in [&[18][..], &[4, 5, 18], &[1, 12, 14, 18]] {
            let mut found = Vec::new();
            for end in ends {
                let part = found.len()..*end;
                series.prepare((&force, &[]), &y, part.clone());
                found.extend(part.map(|k| series.nested(&y, k, None)));
            }
            assert_eq!(found, one_by_one, "{ends:?}");
        }
    }
}
