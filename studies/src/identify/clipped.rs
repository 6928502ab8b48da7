//! Flat tops of a record: oscillations that a converter clipped at the end of its range.

use std::ops::Range;

use super::{median, noise};
use crate::numeric::extent;
use crate::numeric::orthogonal::Orthogonal;

/// Tolerance, as a share of the smallest difference of values, for differences that are integer multiples of
/// it. Values of a converter have such differences; numbers with all their digits have few.
const WHOLE: f64 = 0.01;

/// Distance from the limit, in multiples of the noise, below which a sample lies at the limit.
const NEAR: f64 = 8.0;

/// Samples after a flat top are examined up to this many times the noise below it, and at least to this part
/// of the range of the record.
const FAR: f64 = 32.0;
const FAR_OF_RANGE: f64 = 0.02;

/// A flat top is clipped if the record leaves it at more than this share of its mean speed thereafter.
const SPEED: f64 = 0.25;

/// The flat tops of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clipped {
    /// The last sample of the last flat top.
    pub last: usize,
    /// Number of flat tops.
    pub tops: usize,
    /// The value at which the last flat top is clipped.
    pub limit: f64,
}

/// The flat tops on one side of a record.
struct FlatTops {
    /// 1 for the largest value, -1 for the smallest.
    side: f64,
    limit: f64,
    /// Successive samples at the limit.
    runs: Vec<Range<usize>>,
}

/// Oscillations that are clipped on one side of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutOff {
    pub limit: f64,
    pub swings: usize,
}

/// The flat tops at the largest and the smallest of `values`, if there are any.
///
/// In quantised values the top of an oscillation that is not clipped also is a sequence of equal samples, but
/// there are twice as many samples within four steps of it, since the width of a parabola grows like the
/// square root of its depth. A top with fewer than 3/2 as many is clipped. In values without quantisation no
/// two tops are equal unless they are clipped.
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

/// Whether the displacements `x` over `times` of a mass that may rest on stops are clipped at their smallest
/// (first) and largest value.
///
/// A rest is flat as well. The mass leaves a rest at zero speed, since the force on it changes sign there,
/// but it leaves a clipped top at some speed. If it does not leave, a rest follows ever smaller bounces. With
/// noise a rest is not flat: if the noise is clipped, samples below the limit lie between samples at the
/// limit.
pub fn cut_off(times: &[f64], x: &[f64]) -> [Option<CutOff>; 2] {
    let step = step(x);
    [-1.0, 1.0].map(|side| FlatTops::of(x, side, step)?.cut_off(times, x, step))
}

/// The quantisation step of the values; 0 if they are not quantised.
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
                // a flat stretch at the start of the record is not a top
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

    /// The oscillations, if they are clipped.
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
