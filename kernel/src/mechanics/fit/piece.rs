//! Piece of the chain: the polynomial of lowest degree between two samples.

use std::ops::Range;

use super::Samples;
use super::chain::Left;
use crate::mechanics::curve::{ForceCurve, Piece};
use crate::numeric::fit::lowest_degree;

/// Largest number of samples in the least-squares fit of a piece, picked evenly; all samples are checked.
/// More would average noise better, at a cost that grows with the table.
const MAX_SAMPLES_PER_FIT: usize = 256;

impl Samples<'_> {
    /// The piece of lowest degree that interpolates samples `span.start` and `span.end` and is within the
    /// allowed error of all samples between (and ends with the slope `right`, if given). Returns `None` if
    /// that takes a degree above `degree` or if a number overflows.
    pub(super) fn piece(
        &self,
        span: Range<usize>,
        left: Left,
        right: Option<f64>,
        degree: usize,
    ) -> Option<Piece> {
        let odd = matches!(left, Left::Mirror);
        let Frame { origin, half, base, shape } = self.frame(&span, left, right);
        let intervals = span.len() * if odd { 2 } else { 1 };
        let inner = span.start + 1..span.end;
        let room = degree.min(1 + (3.0 * (intervals as f64).sqrt()) as usize);
        let room = (room + 1).saturating_sub(base.len()).min(ForceCurve::MAX_COEFFICIENTS - base.len());
        let terms = (room / if odd { 2 } else { 1 }).min(inner.len());
        let stride = inner.len().div_ceil(MAX_SAMPLES_PER_FIT).max(1);
        let (mut points, mut weights, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for i in inner.clone().step_by(stride) {
            let t = (self.x[i] - origin) / half;
            points.push(if odd { 2.0 * t * t - 1.0 } else { t });
            weights.push(value(&shape, t));
            values.push(self.force[i] - value(&base, t));
        }
        let meets =
            |piece: &Piece, i: usize| (piece.force(self.x[i]) - self.force[i]).abs() <= self.allowed[i];
        let follows = |piece: &Piece, i: usize| {
            let (force, allowed) = self.between[i];
            (piece.force(0.5 * (self.x[i] + self.x[i + 1])) - force).abs() <= allowed
        };
        let mut accepted = None;
        lowest_degree(&points, &weights, &values, terms, |q| {
            let local = combine(&base, &shape, q, odd);
            let piece = self.in_metres(&local, origin, half, &span, left);
            // The picked samples are checked first, since most trials fail there. A single interval is
            // accepted without a check between its ends, so that there is always a chain. Its ends are still
            // checked: on an interval a million times longer than the previous one a prescribed slope can
            // make the rounding error at the ends too large.
            let good = inner.clone().step_by(stride).all(|i| meets(&piece, i))
                && [span.start, span.end].iter().all(|i| meets(&piece, *i))
                && (stride == 1 || inner.clone().all(|i| meets(&piece, i)))
                && (span.len() == 1 || span.clone().all(|i| follows(&piece, i)))
                && piece.coefficients.iter().all(|c| c.is_finite());
            if good {
                accepted = Some(piece);
            }
            good
        });
        accepted
    }

    fn frame(&self, span: &Range<usize>, left: Left, right: Option<f64>) -> Frame {
        let (a, b) = (self.x[span.start], self.x[span.end]);
        let (force_a, force_b) = (self.force[span.start], self.force[span.end]);
        let (origin, half) = match left {
            Left::Mirror => (0.0, b),
            _ => (0.5 * a + 0.5 * b, 0.5 * (b - a)),
        };
        let (mean, difference) = (0.5 * (force_a + force_b), 0.5 * (force_b - force_a));
        let (mut base, mut shape) = match left {
            Left::Free => (vec![mean, difference], vec![1.0, 0.0, -1.0]),
            Left::Slope(slope) => {
                let bend = 0.5 * (difference - slope * half);
                (vec![mean - bend, difference, bend], vec![1.0, 1.0, -1.0, -1.0])
            }
            Left::Mirror => (vec![0.0, force_b], vec![0.0, 1.0, 0.0, -1.0]),
        };
        if let Some(slope) = right {
            let at_end = |c: &[f64]| c.iter().enumerate().map(|(i, c)| i as f64 * c).sum::<f64>();
            let share = (slope * half - at_end(&base)) / at_end(&shape);
            let odd = matches!(left, Left::Mirror);
            base = combine(&base, &shape, &[share], odd);
            shape = product(&shape, if odd { &[1.0, 0.0, -1.0] } else { &[1.0, -1.0] });
        }
        Frame { origin, half, base, shape }
    }

    /// Converts a polynomial of the local variable to metres and corrects its values at both
    /// ends to rounding.
    fn in_metres(&self, local: &[f64], origin: f64, half: f64, span: &Range<usize>, left: Left) -> Piece {
        let mut coefficients = Vec::with_capacity(local.len());
        let mut unit = 1.0;
        for c in local {
            coefficients.push(c / unit);
            unit *= half;
        }
        let mut piece = Piece::new(origin, coefficients);
        let (a, b) = (self.x[span.start], self.x[span.end]);
        for _ in 0..2 {
            let at_b = self.force[span.end] - piece.force(b);
            match left {
                Left::Mirror => piece.coefficients[1] += at_b / b,
                _ => {
                    let at_a = self.force[span.start] - piece.force(a);
                    piece.coefficients[0] += 0.5 * (at_a + at_b);
                    piece.coefficients[1] += (at_b - at_a) / (b - a);
                }
            }
        }
        piece
    }
}

/// A piece as base + shape q in t = (x - origin)/half. The base interpolates the samples at the ends (and the
/// slope), and the shape is 0 there. For odd data q is a polynomial in 2 t^2 - 1.
struct Frame {
    origin: f64,
    half: f64,
    base: Vec<f64>,
    shape: Vec<f64>,
}

fn value(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// base + shape q in monomials of t; q is a polynomial in t, or for odd data in 2 t^2 - 1.
fn combine(base: &[f64], shape: &[f64], q: &[f64], in_squares: bool) -> Vec<f64> {
    // Horner's scheme with polynomials
    let mut in_t: Vec<f64> = Vec::new();
    for c in q.iter().rev() {
        let factor: &[f64] = if in_squares { &[-1.0, 0.0, 2.0] } else { &[0.0, 1.0] };
        in_t = product(&in_t, factor);
        if in_t.is_empty() {
            in_t.push(0.0);
        }
        in_t[0] += c;
    }
    let mut sum = product(&in_t, shape);
    sum.resize(sum.len().max(base.len()), 0.0);
    for (s, b) in sum.iter_mut().zip(base) {
        *s += b;
    }
    if in_squares {
        sum.iter_mut().step_by(2).for_each(|even| *even = 0.0);
    }
    sum
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let mut out = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] += x * y;
        }
    }
    out
}
