//! Potential landscape: equilibria, barrier, force extrema and kinks of a force curve.
//!
//! Everything follows from the real roots of each piece's force and of its derivative
//! ([`real_roots`](crate::numeric::real_roots)). A root is classified (stable or unstable, extremum or mere
//! touching) by the signs half-way to its neighbours and not by a derivative at the root. This also works at
//! a break, where there are two derivatives, and at a double root, where the derivative is 0.

use super::curve::{ForceCurve, Piece};
use crate::numeric::real_roots::{derivative, real_roots, sign, value_and_magnitude};
use crate::numeric::{Turn, turns};

/// Smallest jump of the slope at a kink, relative to the terms of the slope. Pieces that meet smoothly agree
/// to about 1e-12.
const KINK_JUMP: f64 = 1e-6;

/// Roots closer to a break than this share of the piece's length are merged with the break, if the force is 0
/// there to rounding or if extrema are searched. Two adjacent pieces locate such a root only to rounding, so
/// that it may fall inside either interval, both or neither.
const AT_BREAK: f64 = 1e-10;

/// Largest distance of a kink from a well that it belongs to, relative to the well's distance from the
/// barrier (from x = 0 without a barrier): even a motion much smaller than the well swings over both sides of
/// the kink.
const KINK_NEAR_WELL: f64 = 0.01;

/// A position where the restoring force is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Position in m.
    pub x: f64,
    /// Whether the force is restoring on both sides; false if one side is outside the domain.
    pub stable: bool,
    /// Stiffness just left of it in N/m; NaN at the left end of the domain.
    pub stiffness_left: f64,
    /// Stiffness just right of it in N/m; NaN at the right end of the domain.
    pub stiffness_right: f64,
}

/// The potential maximum between two wells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Barrier {
    /// Position in m.
    pub x: f64,
    /// The stable equilibrium left of it in m.
    pub left_well: f64,
    /// The stable equilibrium right of it in m.
    pub right_well: f64,
    /// Height above the left well in J.
    pub from_left_j: f64,
    /// Height above the right well in J.
    pub from_right_j: f64,
}

/// A well of the potential: a stable equilibrium and the barriers on both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Well {
    /// Position of the equilibrium in m.
    pub x: f64,
    /// Position in m of the barrier towards the well on its left; `None` if there is no such well.
    pub left_top: Option<f64>,
    /// Position in m of the barrier towards the well on its right; `None` if there is no such well.
    pub right_top: Option<f64>,
}

/// A local extremum of the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceExtremum {
    /// Position in m.
    pub x: f64,
    /// Force dV/dx there in N.
    pub force: f64,
}

/// A corner of the force curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kink {
    /// Position in m.
    pub x: f64,
    /// Stiffness just left of it in N/m.
    pub stiffness_left: f64,
    /// Stiffness just right of it in N/m.
    pub stiffness_right: f64,
}

/// A kink so close to a well that even a small motion swings over both sides of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KinkAtWell {
    /// Position of the kink in m.
    pub x: f64,
    /// Stiffness in N/m on the side towards the barrier, above 0; for a kink in the middle of a single well,
    /// the smaller of the two.
    pub inner: f64,
    /// Stiffness in N/m on the other side, above 0.
    pub outer: f64,
}

/// Equilibria, barrier, force extrema and kinks of one force curve, each from left to right.
///
/// They are roots of the polynomials of the curve, to rounding. Positions are in m, forces in N, heights in
/// J. For a curve that was fitted to data, what is smaller than the error of the fit is left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Landscape {
    /// Every isolated position where the force is 0; intervals of zero force are left out, with their ends.
    pub equilibria: Vec<Equilibrium>,
    /// The barrier between the wells; with more than two wells the one nearest to x = 0, and of two equally
    /// near ones the right one.
    pub barrier: Option<Barrier>,
    /// Position in m of the left one of two barriers that are equally near to x = 0.
    pub left_barrier: Option<f64>,
    /// Local extrema of the force inside the domain, smooth or corners; for a fitted curve only those that
    /// exceed the error of the fit.
    pub extrema: Vec<ForceExtremum>,
    /// Corners of the force: breaks at which the slope jumps by more than a millionth.
    pub kinks: Vec<Kink>,
}

impl Landscape {
    /// The landscape of a curve; exactly symmetric if the curve is odd.
    ///
    /// Guarantee: complete (the root finder misses no root); positions are accurate to rounding times their
    /// condition number; a pair of roots that rounding cannot separate counts as one.
    pub fn of(curve: &ForceCurve) -> Self {
        Self::with_error(curve, curve.fit().map_or(0.0, |fit| fit.worst_n))
    }

    /// Like [`of`](Self::of), for a curve with an error of up to `error` in N.
    pub(super) fn with_error(curve: &ForceCurve, error: f64) -> Self {
        let mut landscape = Self {
            equilibria: equilibria(curve),
            barrier: None,
            left_barrier: None,
            extrema: prominent(curve, extrema(curve), 2.0 * error),
            kinks: kinks(curve),
        };
        if curve.is_odd() {
            landscape.mirror();
        }
        let tops = barriers(curve, &landscape.equilibria);
        let nearest = tops.iter().rev().min_by(|a, b| a.x.abs().total_cmp(&b.x.abs())).copied();
        let mirrored = |top: &&Barrier| nearest.is_some_and(|barrier| top.x != 0.0 && top.x == -barrier.x);
        landscape.left_barrier = tops.iter().find(mirrored).map(|top| top.x);
        landscape.barrier = nearest;
        landscape
    }

    /// The wells from left to right.
    pub fn wells(&self) -> Vec<Well> {
        let mut wells: Vec<Well> = Vec::new();
        let mut top = None;
        for equilibrium in &self.equilibria {
            if !equilibrium.stable {
                top = Some(equilibrium.x);
                continue;
            }
            let between = top.take().filter(|_| !wells.is_empty());
            if let Some(before) = wells.last_mut() {
                before.right_top = between;
            }
            wells.push(Well { x: equilibrium.x, left_top: between, right_top: None });
        }
        wells
    }

    /// The right-most stable equilibrium.
    pub fn right_stable(&self) -> Option<&Equilibrium> {
        self.equilibria.iter().rev().find(|e| e.stable)
    }

    /// Position in m that the mass passes when it crosses: the top of the barrier, or the equilibrium of a
    /// single well.
    pub fn crossing_position(&self) -> Option<f64> {
        match &self.barrier {
            Some(barrier) => Some(barrier.x),
            None => self.right_stable().map(|e| e.x),
        }
    }

    /// The stiffness in N/m that a damping ratio refers to: the [`inner_stiffness`](Self::inner_stiffness) of
    /// the right-most stable equilibrium.
    ///
    /// Returns `None` if no equilibrium is stable or this stiffness is not above 0.
    pub fn damping_stiffness(&self) -> Option<f64> {
        let stiffness = self.inner_stiffness(self.right_stable()?);
        (stiffness > 0.0).then_some(stiffness)
    }

    /// The stiffness in N/m of a stable equilibrium on its inner side (towards the barrier, or towards x = 0
    /// without a barrier).
    ///
    /// If the equilibrium lies at a kink or on its outer side, this is the slope just inside that kink, so
    /// that it does not jump when the equilibrium moves across the kink. Of several kinks the nearest one
    /// with a slope above 0 counts (one on the slope down from the barrier does not characterise the
    /// well). At a kink without an inner side (a single well with its corner at x = 0) it is the smaller
    /// of both slopes.
    pub fn inner_stiffness(&self, well: &Equilibrium) -> f64 {
        let middle = self.middle();
        match self.kink_inside(well) {
            Some(kink) if well.x >= middle => kink.stiffness_left,
            Some(kink) => kink.stiffness_right,
            None if well.x > middle => well.stiffness_left,
            None if well.x < middle => well.stiffness_right,
            None => well.stiffness_left.min(well.stiffness_right),
        }
    }

    /// The kink whose inner slope is the [`damping_stiffness`](Self::damping_stiffness); `None` if that is
    /// the slope at the equilibrium itself.
    pub fn damping_kink(&self) -> Option<&Kink> {
        self.kink_inside(self.right_stable()?)
    }

    /// The kink whose inner slope is the [`inner_stiffness`](Self::inner_stiffness), if any.
    fn kink_inside(&self, well: &Equilibrium) -> Option<&Kink> {
        let middle = self.middle();
        let beyond = |kink: &&Kink| {
            (middle < kink.x && kink.x <= well.x && kink.stiffness_left > 0.0)
                || (middle > kink.x && kink.x >= well.x && kink.stiffness_right > 0.0)
        };
        nearest(self.kinks.iter().filter(beyond), well.x)
    }

    /// The kink on either side of the right-most stable equilibrium within 1 % of its distance from the
    /// barrier, if the force rises on both sides of that kink. The stiffness of such a well differs between
    /// its two sides.
    pub fn kink_at_right_well(&self) -> Option<KinkAtWell> {
        let well = self.right_stable()?;
        let middle = self.middle();
        let near = KINK_NEAR_WELL * (well.x - middle).abs();
        let beside = |kink: &&Kink| {
            (kink.x - well.x).abs() <= near && kink.stiffness_left > 0.0 && kink.stiffness_right > 0.0
        };
        let kink = nearest(self.kinks.iter().filter(beside), well.x)?;
        let (left, right) = (kink.stiffness_left, kink.stiffness_right);
        let (inner, outer) = match well.x {
            x if x > middle => (left, right),
            x if x < middle => (right, left),
            _ => (left.min(right), left.max(right)),
        };
        Some(KinkAtWell { x: kink.x, inner, outer })
    }

    /// Position in m of the barrier, or 0 without one: the side of a well towards it is the inner side.
    fn middle(&self) -> f64 {
        self.barrier.map_or(0.0, |barrier| barrier.x)
    }

    /// Makes the landscape of an odd curve exactly symmetric: the left half becomes the mirror image of the
    /// right half.
    fn mirror(&mut self) {
        mirror_right_half(
            &mut self.equilibria,
            |e| e.x,
            |e| Equilibrium {
                x: -e.x,
                stiffness_left: e.stiffness_right,
                stiffness_right: e.stiffness_left,
                ..*e
            },
        );
        mirror_right_half(&mut self.extrema, |e| e.x, |e| ForceExtremum { x: -e.x, force: -e.force });
        mirror_right_half(
            &mut self.kinks,
            |k| k.x,
            |k| Kink { x: -k.x, stiffness_left: k.stiffness_right, stiffness_right: k.stiffness_left },
        );
    }
}

fn nearest<'a>(kinks: impl Iterator<Item = &'a Kink>, x: f64) -> Option<&'a Kink> {
    kinks.min_by(|a, b| (a.x - x).abs().total_cmp(&(b.x - x).abs()))
}

/// Replaces the elements at x < 0 with mirror images of those at x > 0.
fn mirror_right_half<T: Clone>(all: &mut Vec<T>, x: impl Fn(&T) -> f64, mirrored: impl Fn(&T) -> T) {
    let right: Vec<T> = all.iter().filter(|t| x(t) >= 0.0).cloned().collect();
    *all = right.iter().rev().filter(|t| x(t) > 0.0).map(mirrored).chain(right.iter().cloned()).collect();
}

/// Positions at which a polynomial of each piece (its force or its stiffness) may change sign, ascending: its
/// roots inside the piece, and every break. A break for which `is_root` holds replaces the roots close to it.
fn candidates(
    curve: &ForceCurve,
    polynomial: impl Fn(&Piece) -> Vec<f64>,
    is_root: impl Fn(f64) -> bool,
) -> Vec<f64> {
    let mut found: Vec<f64> = curve.breaks().to_vec();
    for (i, piece) in curve.pieces().iter().enumerate() {
        let (left, right) = curve.piece_interval(i);
        let length = right - left;
        let near = if length.is_finite() { AT_BREAK * length } else { 0.0 };
        let roots = real_roots(&polynomial(piece), left - piece.origin, right - piece.origin);
        found.extend(roots.into_iter().map(|y| y + piece.origin).filter(|x| {
            let beside = |end: f64, is_break: bool| is_break && (x - end).abs() <= near && is_root(end);
            *x >= left && *x <= right && !beside(left, i > 0) && !beside(right, i + 1 < curve.pieces().len())
        }));
    }
    found.sort_by(f64::total_cmp);
    found.dedup();
    found
}

/// The signs on the left and on the right of each candidate, evaluated half-way to its neighbour or to the
/// end of the domain; 0 outside the domain.
fn signs_beside(candidates: &[f64], domain: (f64, f64), sign: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let far = candidates.iter().fold(0.0_f64, |largest, c| largest.max(c.abs()));
    let ends = (domain.0.max(-2.0 * far - 1.0), domain.1.min(2.0 * far + 1.0));
    let inside = |a: f64, b: f64| {
        let middle = 0.5 * a + 0.5 * b;
        if middle > a && middle < b { sign(middle) } else { 0.0 }
    };
    let all = [&[ends.0], candidates, &[ends.1]].concat();
    all.windows(3).map(|near| (inside(near[0], near[1]), inside(near[1], near[2]))).collect()
}

fn sign_of(value: f64) -> f64 {
    if value == 0.0 || value.is_nan() { 0.0 } else { value.signum() }
}

/// Whether the force at `x` is 0 to rounding in one of the pieces that meet there.
fn vanishes(curve: &ForceCurve, x: f64) -> bool {
    let i = curve.piece_index(x);
    [i.checked_sub(1), Some(i), Some(i + 1)].into_iter().flatten().any(|i| {
        let (left, right) = if i < curve.pieces().len() { curve.piece_interval(i) } else { return false };
        let piece = &curve.pieces()[i];
        (left..=right).contains(&x) && sign(&piece.coefficients, x - piece.origin) == 0.0
    })
}

fn equilibria(curve: &ForceCurve) -> Vec<Equilibrium> {
    let zeros = candidates(curve, |piece| piece.coefficients.clone(), |x| vanishes(curve, x));
    let signs = signs_beside(&zeros, curve.domain(), |x| sign_of(curve.force(x)));
    let (low, high) = curve.domain();
    let mut found = Vec::new();
    for (x, (before, after)) in zeros.into_iter().zip(signs) {
        // Every break is a candidate, so check that the force is 0 there. Next to an interval of zero force
        // the sign is 0.
        let is_break = curve.breaks().contains(&x);
        if is_break && before * after >= 0.0 && !vanishes(curve, x) {
            continue;
        }
        if (before == 0.0 && x > low) || (after == 0.0 && x < high) {
            continue;
        }
        let (stiffness_left, stiffness_right) = curve.stiffness_on_both_sides(x);
        let stable = before < 0.0 && after > 0.0;
        found.push(Equilibrium { x, stable, stiffness_left, stiffness_right });
    }
    found
}

/// The barriers between neighbouring wells, from left to right.
fn barriers(curve: &ForceCurve, equilibria: &[Equilibrium]) -> Vec<Barrier> {
    let stable: Vec<usize> = (0..equilibria.len()).filter(|i| equilibria[*i].stable).collect();
    let tops = stable.windows(2).filter_map(|pair| {
        let (left_well, right_well) = (equilibria[pair[0]].x, equilibria[pair[1]].x);
        let height = |x: f64, well: f64| curve.potential(x) - curve.potential(well);
        let top = equilibria[pair[0] + 1..pair[1]]
            .iter()
            .max_by(|a, b| height(a.x, left_well).total_cmp(&height(b.x, left_well)))?;
        Some(Barrier {
            x: top.x,
            left_well,
            right_well,
            from_left_j: height(top.x, left_well),
            from_right_j: height(top.x, right_well),
        })
    });
    tops.collect()
}

fn extrema(curve: &ForceCurve) -> Vec<ForceExtremum> {
    let level = candidates(curve, |piece| derivative(&piece.coefficients), |_| true);
    let signs = signs_beside(&level, curve.domain(), |x| sign_of(curve.stiffness(x)));
    level
        .into_iter()
        .zip(signs)
        .filter(|(_, (before, after))| before * after < 0.0)
        .map(|(x, _)| ForceExtremum { x, force: curve.force(x) })
        .collect()
}

/// The extrema from which the force retreats by more than `prominence` in N before the next one or the end of
/// the domain. An error of half that size could produce the other extrema.
fn prominent(curve: &ForceCurve, extrema: Vec<ForceExtremum>, prominence: f64) -> Vec<ForceExtremum> {
    if prominence == 0.0 {
        return extrema;
    }
    let (low, high) = curve.domain();
    let between = extrema.iter().map(|extremum| extremum.force);
    let forces: Vec<f64> = [curve.force(low)].into_iter().chain(between).chain([curve.force(high)]).collect();
    // the first turning point may be the end of the domain, or too close to the force there
    let clear = |turn: &&Turn| (forces[turn.at] - forces[0]).abs() > prominence;
    let all = turns(&forces, prominence);
    let first = all.first().filter(clear);
    first.into_iter().chain(all.iter().skip(1)).map(|turn| extrema[turn.at - 1]).collect()
}

fn kinks(curve: &ForceCurve) -> Vec<Kink> {
    let mut found = Vec::new();
    for (i, x) in curve.breaks().iter().copied().enumerate() {
        let slope = |piece: &Piece| value_and_magnitude(&derivative(&piece.coefficients), x - piece.origin);
        let (stiffness_left, terms_left) = slope(&curve.pieces()[i]);
        let (stiffness_right, terms_right) = slope(&curve.pieces()[i + 1]);
        if (stiffness_right - stiffness_left).abs() > KINK_JUMP * terms_left.max(terms_right) {
            found.push(Kink { x, stiffness_left, stiffness_right });
        }
    }
    found
}
