//! Flat tops of a record: swings that a converter cut off at the end of its range.

use crate::numeric::extent;

/// Share of the least difference within which differences are its whole multiples. Those of a converter are;
/// of numbers that are written in full few are.
const WHOLE: f64 = 0.01;

/// The flat tops of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clipped {
    /// The last sample of the last one.
    pub last: usize,
    /// How many there are.
    pub tops: usize,
    /// The value at which the last one is cut off.
    pub limit: f64,
}

/// The flat tops at the largest and at the least of `values`, where there are any.
///
/// The top of a swing that is not cut off, in values with a step, is a run of equal samples too, but a
/// rounded one: within four steps of it there are twice as many samples (the width of a parabola grows like
/// the root of the depth). It is cut off where there are fewer than 3/2 as many. In values without a step no
/// two tops are equal unless they are cut off.
pub fn clipped(values: &[f64]) -> Option<Clipped> {
    let steps = || values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0);
    let least = steps().fold(f64::INFINITY, f64::min);
    let whole = steps().filter(|step| (step / least - (step / least).round()).abs() < WHOLE).count();
    let fine = 2 * whole < steps().count();
    let step = if fine { 0.0 } else { least };
    let (low, high) = extent(values.iter().copied());
    let at_limit = |side: f64, limit: f64| -> Option<Clipped> {
        let within = |i: usize, steps: f64| side * (limit - values[i]) <= steps * step;
        let mut tops: Vec<(usize, usize)> = Vec::new();
        for i in (1..values.len().saturating_sub(1)).filter(|i| values[*i] == limit) {
            match tops.last_mut() {
                Some(top) if top.1 + 1 == i => top.1 = i,
                _ if values[i - 1] != limit => tops.push((i, i)),
                // a flat stretch at the start of the record is no top
                _ => {}
            }
        }
        let flat = |(first, last): &(usize, usize)| {
            let count = last - first + 1;
            let before = (0..*first).rev().take_while(|i| within(*i, 3.0)).count();
            let after = (last + 1..values.len()).take_while(|i| within(*i, 3.0)).count();
            count >= if fine { 3 } else { 4 } && 2 * (before + after) < count
        };
        let cut = tops.iter().any(flat) || fine && tops.len() > 1;
        let last = tops.last().filter(|_| cut)?.1;
        Some(Clipped { last, tops: tops.len(), limit })
    };
    match (at_limit(1.0, high), at_limit(-1.0, low)) {
        (Some(upper), Some(lower)) => {
            let last = if upper.last > lower.last { upper } else { lower };
            Some(Clipped { tops: upper.tops + lower.tops, ..last })
        }
        (upper, lower) => upper.or(lower),
    }
}
