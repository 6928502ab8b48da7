//! Flat tops of a record: swings that a converter cut off at the end of its range.

use std::ops::Range;

use super::{median, noise};
use crate::numeric::extent;
use crate::numeric::orthogonal::Orthogonal;

/// Share of the least difference within which differences are its whole multiples. Those of a converter are;
/// of numbers that are written in full few are.
const WHOLE: f64 = 0.01;

/// Times the noise within which a sample may lie at the limit.
const NEAR: f64 = 8.0;

/// Samples after a flat top are looked at up to this many times the noise below it, and at least to this
/// part of the range of the record.
const FAR: f64 = 32.0;
const FAR_OF_RANGE: f64 = 0.02;

/// A flat top is cut off where the record leaves it with more than this part of its mean speed thereafter.
const SPEED: f64 = 0.25;

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

/// The flat tops on one side of a record.
struct FlatTops {
    /// The largest value if 1, the least one if -1.
    side: f64,
    limit: f64,
    /// Successive samples at the limit.
    runs: Vec<Range<usize>>,
}

/// Swings that are cut off on one side of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutOff {
    pub limit: f64,
    pub swings: usize,
}

/// The flat tops at the largest and at the least of `values`, where there are any.
///
/// The top of a swing that is not cut off, in values with a step, is a run of equal samples too, but a
/// rounded one: within four steps of it there are twice as many samples (the width of a parabola grows like
/// the root of the depth). It is cut off where there are fewer than 3/2 as many. In values without a step no
/// two tops are equal unless they are cut off.
pub fn clipped(values: &[f64]) -> Option<Clipped> {
    let step = step(values);
    let on_side = |side: f64| {
        let FlatTops { limit, runs, .. } = FlatTops::of(values, side, step)?;
        Some(Clipped { last: runs.last()?.end - 1, tops: runs.len(), limit })
    };
    match (on_side(1.0), on_side(-1.0)) {
        (Some(upper), Some(lower)) => {
            let last = if upper.last > lower.last { upper } else { lower };
            Some(Clipped { tops: upper.tops + lower.tops, ..last })
        }
        (upper, lower) => upper.or(lower),
    }
}

/// Where the displacements `x` over `times` of a mass that may rest on stops are cut off: at their least
/// value (first), and at their largest.
///
/// A rest is flat too. The mass leaves it from standstill, since the force on it changes sign there, but a
/// top that is cut off with a speed. Where it does not leave again, ever smaller bounces came before a rest.
/// In noise a rest is not flat: where it is cut off within the noise, samples below the limit lie between
/// others at it.
pub fn cut_off(times: &[f64], x: &[f64]) -> [Option<CutOff>; 2] {
    let step = step(x);
    [-1.0, 1.0].map(|side| FlatTops::of(x, side, step)?.cut_off(times, x, step))
}

/// The least difference of successive values of a converter; 0 for values that have no such step.
fn step(values: &[f64]) -> f64 {
    let steps = || values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0);
    let least = steps().fold(f64::INFINITY, f64::min);
    let whole = steps().filter(|step| (step / least - (step / least).round()).abs() < WHOLE).count();
    if 2 * whole < steps().count() { 0.0 } else { least }
}

impl FlatTops {
    fn of(values: &[f64], side: f64, step: f64) -> Option<Self> {
        let fine = step == 0.0;
        let (low, high) = extent(values.iter().copied());
        let limit = if side > 0.0 { high } else { low };
        let within = |i: usize, steps: f64| side * (limit - values[i]) <= steps * step;
        let mut runs: Vec<Range<usize>> = Vec::new();
        for i in (1..values.len().saturating_sub(1)).filter(|i| values[*i] == limit) {
            match runs.last_mut() {
                Some(run) if run.end == i => run.end = i + 1,
                _ if values[i - 1] != limit => runs.push(i..i + 1),
                // a flat stretch at the start of the record is no top
                _ => {}
            }
        }
        // nor is one up to its end, where a mass may have come to rest
        if values.last() == Some(&limit) {
            runs.pop_if(|run| run.end + 1 == values.len());
        }
        let flat = |run: &Range<usize>| {
            let before = (0..run.start).rev().take_while(|i| within(*i, 3.0)).count();
            let after = (run.end..values.len()).take_while(|i| within(*i, 3.0)).count();
            run.len() >= if fine { 3 } else { 4 } && 2 * (before + after) < run.len()
        };
        let cut = runs.iter().any(flat) || fine && runs.len() > 1;
        cut.then_some(Self { side, limit, runs })
    }

    /// The swings, if they are cut off.
    fn cut_off(&self, times: &[f64], x: &[f64], step: f64) -> Option<CutOff> {
        let (low, high) = extent(x.iter().copied());
        let below: Vec<f64> = x.iter().copied().filter(|x| *x != self.limit).collect();
        let noise = noise(&below).max(step);
        let depth = |i: usize| self.side * (self.limit - x[i]);
        let broken = |pair: &&[Range<usize>]| (pair[0].end..pair[1].start).all(|i| depth(i) < NEAR * noise);
        let broken = self.runs.windows(2).filter(broken).count();
        let far = (FAR * noise).max(FAR_OF_RANGE * (high - low));
        // the speed next to the limit as a part of the mean speed between there and `far`
        let speed = |first: usize, last: usize, length: usize| {
            let depths: Vec<f64> = (first..=last).map(depth).collect();
            let mean = (depths[last - first] - depths[0]) / (times[last] - times[first]);
            let at_limit = if mean > 0.0 { times[first] } else { times[last] };
            let slope = Orthogonal::fit(&times[first..=last], &depths).at(at_limit, 3).slope;
            (last - first <= 2 * length + 1).then_some(slope / mean)
        };
        let leaves = |(k, run): (usize, &Range<usize>)| {
            let next = self.runs.get(k + 1).map_or(x.len(), |next| next.start);
            // the sample at the limit is before the record leaves it
            let last = (run.end + 3..next).find(|i| depth(*i) >= far)?;
            speed(run.end, last, run.len())
        };
        let arrives = |(k, run): (usize, &Range<usize>)| {
            let before = k.checked_sub(1).map_or(0, |k| self.runs[k].end);
            let first = (before..run.start.saturating_sub(3)).rev().find(|i| depth(*i) >= far)?;
            speed(first, run.start - 1, run.len())
        };
        let runs = || self.runs.iter().enumerate();
        let speed = median(runs().filter_map(leaves).collect())
            .or_else(|| median(runs().filter_map(arrives).collect()));
        let is_cut_off = 4 * broken > self.runs.len() || speed.is_some_and(|speed| speed > SPEED);
        is_cut_off.then_some(CutOff { limit: self.limit, swings: self.runs.len() - broken })
    }
}
