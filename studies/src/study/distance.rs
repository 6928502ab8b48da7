//! Distance between two motions that are watched side by side.

use super::watch::Watch;

/// Least share of samples at common times for which these alone are compared.
const ENOUGH: f64 = 0.25;

/// Times in s from `from` to `to` and the distance in m of two motions at each: at most some `limit` of them.
///
/// Motions that are sampled in the same steps are compared at their common samples, which are exact; others
/// between samples, where the distance is good to a millionth of the way between two of these.
pub fn distances(a: &Watch, b: &Watch, (from, to): (f64, f64), limit: usize) -> Vec<(f64, f64)> {
    let (samples, other) = (a.samples(), b.samples());
    let to = to.min(a.time()).min(b.time());
    let from = from.max(a.begin()).max(b.begin());
    let first = samples.partition_point(|sample| sample.t < from);
    let last = samples.partition_point(|sample| sample.t <= to);
    // a power of two, so that the samples taken stay the same while others are added
    let stride = (last.saturating_sub(first) / limit.max(1)).max(1).next_power_of_two();
    let first = first.next_multiple_of(stride);
    let taken = || (first..last).step_by(stride).map(|i| &samples[i]);
    let mut found: Vec<(f64, f64)> = taken()
        .filter_map(|sample| {
            let at = other.partition_point(|twin| twin.t < sample.t);
            let twin = other.get(at).filter(|twin| twin.t == sample.t)?;
            Some((sample.t, (sample.x - twin.x).abs()))
        })
        .collect();
    if (found.len() as f64) < ENOUGH * taken().count() as f64 {
        found = taken().map(|sample| (sample.t, (sample.x - b.state_at(sample.t).x).abs())).collect();
    }
    if to > from {
        found.push((to, (a.state_at(to).x - b.state_at(to).x).abs()));
    }
    found
}
