//! Local properties of sampled forces: corners, slopes, interpolation and roughness.

use std::ops::Range;

use super::table::ForceTable;

/// Smallest jump of the slope at a corner, relative to the uncertainty of the two one-sided slopes. Smooth
/// data stay below 1 (the jump is of second order in the spacing, the uncertainty of first order); with 4, a
/// corner within a quarter of an interval from a sample is still recognised.
const CORNER_OVER_UNCERTAINTY: f64 = 4.0;

/// Allowed distance, in tolerances, of a piece from the local interpolant half-way between two
/// samples. The interpolant amplifies the errors of its samples about 1.5 times, and the piece may be
/// off by one tolerance.
const BETWEEN_SAMPLES: f64 = 3.0;

/// Median distance in N of a sample from the cubic through its four neighbours.
pub(super) fn roughness(table: &ForceTable) -> f64 {
    let mut misses: Vec<f64> = (2..table.x.len().saturating_sub(2))
        .map(|i| {
            let near = [i - 2, i - 1, i + 1, i + 2].into_iter();
            (interpolated(&table.x, &table.force, near, table.x[i]) - table.force[i]).abs()
        })
        .collect();
    misses.sort_by(f64::total_cmp);
    misses.get(misses.len() / 2).copied().unwrap_or(0.0)
}

/// The force at `x = at` on the polynomial through the samples `near`, in Lagrange's form.
fn interpolated(x: &[f64], force: &[f64], near: impl Iterator<Item = usize> + Clone, at: f64) -> f64 {
    let mut sum = 0.0;
    for a in near.clone() {
        let mut weight = 1.0;
        for b in near.clone().filter(|b| *b != a) {
            weight *= (at - x[b]) / (x[a] - x[b]);
        }
        sum += weight * force[a];
    }
    sum
}

/// Whether the slope jumps at each sample.
///
/// A one-sided slope is that of the parabola through a sample and its two neighbours on that side; its
/// uncertainty is its difference from the slope of the chord. A corner exceeds the uncertainty
/// ([`CORNER_OVER_UNCERTAINTY`]) and is large enough to matter: over half the nearest interval it changes the
/// force by more than twice the `allowed` error. A corner between two samples is not located here; the chain
/// then breaks on both sides of it.
pub(super) fn corners(x: &[f64], force: &[f64], allowed: &[f64]) -> Vec<bool> {
    let chord = |i: usize, j: usize| (force[j] - force[i]) / (x[j] - x[i]);
    let one_sided = |at: usize, near: usize, far: usize| {
        let first = chord(at, near);
        let slope = first - (chord(near, far) - first) / (x[far] - x[at]) * (x[near] - x[at]);
        (slope, (slope - first).abs())
    };
    let mut corner = vec![false; x.len()];
    for i in 2..x.len().saturating_sub(2) {
        let (left, uncertainty_left) = one_sided(i, i - 1, i - 2);
        let (right, uncertainty_right) = one_sided(i, i + 1, i + 2);
        let jump = (right - left).abs();
        let nearest = (x[i + 1] - x[i]).min(x[i] - x[i - 1]);
        corner[i] = jump > CORNER_OVER_UNCERTAINTY * (uncertainty_left + uncertainty_right)
            && 0.5 * jump * nearest > 2.0 * allowed[i];
    }
    corner
}

/// Samples `first..=last` and up to `each` more on either side, not beyond a corner (around a single sample
/// that is itself a corner, both sides are included).
fn neighbours(first: usize, last: usize, each: usize, corner: &[bool]) -> Range<usize> {
    let (mut low, mut high) = (first, last);
    for _ in 0..each {
        low -= usize::from(low > 0 && (low == first && first == last || !corner[low]));
        high += usize::from(high + 1 < corner.len() && (high == last && first == last || !corner[high]));
    }
    low..high + 1
}

/// Slope at each sample of the polynomial through it and up to two neighbours on each side, not beyond a
/// corner. The slope at a corner itself is meaningless.
pub(super) fn slopes(x: &[f64], force: &[f64], corner: &[bool]) -> Vec<f64> {
    let slope_at = |i: usize| {
        // derivative of Lagrange's form at one of its nodes
        let near = neighbours(i, i, 2, corner);
        let mut slope = 0.0;
        for a in near.clone().filter(|a| *a != i) {
            let mut weight = 1.0 / (x[a] - x[i]);
            for b in near.clone().filter(|b| *b != a && *b != i) {
                weight *= (x[i] - x[b]) / (x[a] - x[b]);
            }
            slope += weight * (force[a] - force[i]);
        }
        slope
    };
    (0..x.len()).map(slope_at).collect()
}

/// The force half-way between each sample and the next, and the allowed distance of a curve from it: a few
/// tolerances plus the difference between the interpolants through six and through four neighbours.
pub(super) fn between(x: &[f64], force: &[f64], corner: &[bool], allowed: &[f64]) -> Vec<(f64, f64)> {
    (0..x.len() - 1)
        .map(|i| {
            let at = 0.5 * (x[i] + x[i + 1]);
            let six = interpolated(x, force, neighbours(i, i + 1, 2, corner), at);
            let four = interpolated(x, force, neighbours(i, i + 1, 1, corner), at);
            (six, BETWEEN_SAMPLES * allowed[i].min(allowed[i + 1]) + (six - four).abs())
        })
        .collect()
}
