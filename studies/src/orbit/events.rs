//! Events of a branch, located between two points of it to about 1e-9 of the range.

use nalgebra::Vector4;

use super::corrector::{Corrector, Point};
use super::{OrbitAnswer, SAME};
use crate::dynamics::{EventKind, Multiplier};
use crate::numeric::elementary;

words! {
    /// A bifurcation or grazing of a periodic orbit at a value of the field.
    BranchEvent {
        /// The branch turns back: a multiplier passes through 1.
        Fold = "fold",
        /// A multiplier passes through -1: an orbit of twice the period branches off.
        Flip = "flip",
        /// A multiplier of a symmetric orbit passes through 1: a pair of asymmetric orbits branches off. A
        /// branch of asymmetric orbits turns there and returns as that of their mirror images.
        Symmetry = "symmetry",
        /// The orbit begins or ceases to touch a stop.
        Grazing = "grazing",
    }
}

/// Accuracy of an event in the units of the branch, if rounding allows it.
const LOCATED: f64 = 1e-12;
/// Distance on both sides of an event at which the test function must have different signs.
const CHECKED: f64 = 1e-9;

/// Largest distance of a multiplier from 1 or -1 at an event, where the multiplier may change fast.
const AT_UNIT: f64 = 1e-6;

/// Two differences from the mirror image are opposite if the cosine of their angle is below minus this value.
const OPPOSITE: f64 = 0.5;

/// Number of halvings of the step between two points in the search for a breaking of the symmetry.
const HALVINGS: i32 = 20;

const MAX_EVALUATIONS: usize = 80;

/// Whether two motions touch the stops in a different order or number.
pub(super) fn differ(a: &OrbitAnswer, b: &OrbitAnswer) -> bool {
    differ_above(a, b, 0.0)
}

/// The same without impacts that are slower than this speed in m/s.
pub(super) fn differ_above(a: &OrbitAnswer, b: &OrbitAnswer, speed: f64) -> bool {
    let contacts = |orbit: &OrbitAnswer| {
        let all = orbit.contacts().into_iter();
        let all = all.filter(|event| event.kind != EventKind::Impact || event.v_in.abs() >= speed);
        all.map(|event| (event.kind, event.side)).collect::<Vec<_>>()
    };
    let (a, b) = (contacts(a), contacts(b));
    // the two lists may begin at different contacts
    a.len() != b.len() || !a.is_empty() && !(0..a.len()).any(|from| a[from..].iter().chain(&a[..from]).eq(&b))
}

/// The characteristic polynomial of the corrector's map at 1 or -1: 0 where that is a multiplier.
pub(super) fn characteristic(point: &Point, at: f64) -> f64 {
    point.by_state.characteristic(at, point.determinant)
}

/// The events between two consecutive points in order, each with its point; `along` and `onward` are the
/// tangents of the branch there. `None` if a change could not be located.
pub(super) fn between(
    corrector: &Corrector,
    from: &Point,
    along: &Vector4<f64>,
    to: &Point,
    onward: &Vector4<f64>,
) -> Option<Vec<(BranchEvent, Point)>> {
    let passes = |at: f64| characteristic(from, at) * characteristic(to, at) < 0.0;
    let mut found = Vec::new();
    // a multiplier of the map passes through 1 only where the branch turns back
    let turns = along.w * onward.w < 0.0;
    if let Some(joint) = joint(corrector, from, to) {
        found.push(joint);
    } else if turns != passes(1.0) {
        return None;
    }
    let at_minus_one = if corrector.mirrored { BranchEvent::Symmetry } else { BranchEvent::Flip };
    for (at, event) in [(1.0, BranchEvent::Fold), (-1.0, at_minus_one)] {
        let is_found = at == 1.0 && !found.is_empty();
        if passes(at) && !is_found {
            let (share, point) = root(corrector, (from, to), |point| characteristic(point, at))?;
            if !is_at(&point, at) {
                return None;
            }
            found.push((share, event, point));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(found.into_iter().map(|(_, event, point)| (event, point)).collect())
}

/// The orbit at which a branch turns back and repeats its orbits in another form, if it does: a symmetric
/// orbit, from orbits to their mirror images, or one of half the period, from orbits to themselves half their
/// period later. The map over the period is singular there, so the orbit is computed with the map over the
/// half.
fn joint(corrector: &Corrector, from: &Point, to: &Point) -> Option<(f64, BranchEvent, Point)> {
    if corrector.mirrored {
        return None;
    }
    let difference = |is_mirrored: bool, point: &Point| {
        let map = corrector.map(point.value)?;
        let off = match is_mirrored {
            true => Corrector::asymmetry(&map, &point.orbit),
            false => corrector.halfway(&map, &point.orbit),
        };
        off.filter(|off| off.amax() > SAME)
    };
    let turned = |is_mirrored: bool| {
        let (before, after) = (difference(is_mirrored, from)?, difference(is_mirrored, to)?);
        let (near, far) = (before.norm(), after.norm());
        (before.dot(&after) <= -OPPOSITE * near * far).then_some((is_mirrored, near / (near + far)))
    };
    let (is_mirrored, share) = turned(true).or_else(|| turned(false))?;
    let middle = from.at + (to.at - from.at) * share;
    let periods = if is_mirrored { corrector.periods } else { corrector.periods / 2 };
    let half = Corrector { mirrored: is_mirrored, periods, ..*corrector };
    let at = |field: f64| half.correct(Vector4::new(middle.x, middle.y, middle.z, field), &Vector4::w());
    let breaks = |point: &Point| characteristic(point, -1.0);
    let length = (to.at - from.at).norm();
    (0..HALVINGS).rev().find_map(|halving| {
        let width = length * elementary::powi(0.5, halving);
        let (low, high) = (at(middle.w - width)?, at(middle.w + width)?);
        (breaks(&low) * breaks(&high) < 0.0).then_some(())?;
        let (_, point) = root(&half, (&low, &high), breaks)?;
        let event = if is_mirrored { BranchEvent::Symmetry } else { BranchEvent::Flip };
        (is_at(&point, -1.0) && (point.at - middle).norm() <= length).then_some((share, event, point))
    })
}

/// Whether a multiplier of the corrector's map is 1 or -1.
pub(super) fn is_at(point: &Point, unit: f64) -> bool {
    has(&point.by_state.multipliers(point.determinant), unit)
}

/// Whether one of the multipliers is 1 or -1.
pub(super) fn has(multipliers: &[Multiplier], unit: f64) -> bool {
    multipliers.iter().any(|multiplier| elementary::hypot(multiplier.re - unit, multiplier.im) <= AT_UNIT)
}

/// The zero, if found, of a quantity with different signs at two points, as a share of their distance.
fn root(
    corrector: &Corrector,
    (from, to): (&Point, &Point),
    of: impl Fn(&Point) -> f64,
) -> Option<(f64, Point)> {
    let chord = to.at - from.at;
    let length = chord.norm();
    let at = |share: f64| corrector.correct(from.at + chord * share, &(chord / length));
    root_between(length, (of(from), of(to)), at, of)
}

/// The zero of a quantity on a curve between two points, where it has the values `ends` of different signs,
/// by the Illinois method; `None` if the signs just beside it are equal. `at` is the point of the curve
/// beside a share of the chord of this length.
pub(super) fn root_between<P>(
    length: f64,
    ends: (f64, f64),
    at: impl Fn(f64) -> Option<P>,
    of: impl Fn(&P) -> f64,
) -> Option<(f64, P)> {
    let ((mut low, mut below), (mut high, mut above)) = ((0.0, ends.0), (1.0, ends.1));
    let mut kept = 0_i8;
    let mut last: Option<(f64, P)> = None;
    for _ in 0..MAX_EVALUATIONS {
        let middle = low + (high - low) * (below / (below - above)).clamp(1e-9, 1.0 - 1e-9);
        // if the corrector does not converge right there, it may converge beside it
        let beside = [middle, 0.5 * (low + high), low + 0.3 * (high - low), low + 0.7 * (high - low)];
        let (middle, point) = beside.into_iter().find_map(|share| at(share).map(|point| (share, point)))?;
        let value = of(&point);
        let moved = last.as_ref().map_or(f64::INFINITY, |(before, _)| (middle - before).abs());
        last = Some((middle, point));
        if value == 0.0 || moved * length <= LOCATED || (high - low) * length <= LOCATED {
            break;
        }
        if (value < 0.0) == (below < 0.0) {
            (low, below) = (middle, value);
            above *= if kept < 0 { 0.5 } else { 1.0 };
            kept = -1;
        } else {
            (high, above) = (middle, value);
            below *= if kept > 0 { 0.5 } else { 1.0 };
            kept = 1;
        }
    }
    let (share, point) = last?;
    let has_sign = |offset: f64, sign: f64| {
        let beside = share + offset / length;
        let value = if (0.0..=1.0).contains(&beside) { of(&at(beside)?) } else { sign };
        Some(value * sign > 0.0)
    };
    (has_sign(-CHECKED, ends.0)? && has_sign(CHECKED, ends.1)?).then_some((share, point))
}
