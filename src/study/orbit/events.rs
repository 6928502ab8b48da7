//! Events on a branch between two of its points: where they are, to some 1e-9 of the range.

use nalgebra::Vector3;

use super::corrector::{Corrector, Point, Units};

/// What happens to a periodic motion at a value of the field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BranchEvent {
    /// The branch turns back: a multiplier passes through 1.
    Fold,
    /// A multiplier passes through -1: a motion of twice the period begins.
    Flip,
    /// A multiplier passes through 1 where the branch goes on: a pair of motions that are not their own
    /// mirror images begins.
    Symmetry,
    /// The motion begins or ceases to touch a stop.
    Grazing,
}

impl BranchEvent {
    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::Flip => "flip",
            Self::Symmetry => "symmetry",
            Self::Grazing => "grazing",
        }
    }
}

/// How close in the units of the branch an event is located.
const LOCATED: f64 = 1e-10;

/// The distance from a stop and the speed of an impact, as shares of the units, below which a motion grazes
/// the stop: the speed is as the root of the distance.
const NEAR: f64 = 1e-5;
const SLOW: f64 = 1e-2;

/// How far from a touch in the units of the branch a motion is sought that misses: farther than the map is
/// differenced by the field; and how far it is sought at most.
const TRIAL: f64 = 3e-7;
const FARTHEST: f64 = 1e-3;

/// The most points for it.
const MOST_POINTS: usize = 80;

/// Whether two motions touch the stops in another order or number.
pub(super) fn differ(a: &Point, b: &Point) -> bool {
    let contacts = |point: &Point| {
        let all = point.orbit.contacts().into_iter();
        all.map(|event| (event.kind, event.side)).collect::<Vec<_>>()
    };
    let (a, b) = (contacts(a), contacts(b));
    // they begin anywhere on the motion
    a.len() != b.len() || !a.is_empty() && !(0..a.len()).any(|from| a[from..].iter().chain(&a[..from]).eq(&b))
}

/// Whether a motion all but touches a stop, or touches one with hardly any speed.
pub(super) fn grazes(point: &Point, units: &Units) -> bool {
    point.orbit.passage.nearest_miss.is_some_and(|miss| miss < NEAR * units.length)
        || point.orbit.gentlest_impact().is_some_and(|speed| speed < SLOW * units.speed)
}

/// What changes sign at a fold: the direction of the field; at a flip, and where a multiplier is 1, the
/// characteristic polynomial.
fn at_minus_one(point: &Point) -> f64 {
    1.0 + point.orbit.jacobian.trace() + point.orbit.determinant()
}

fn at_one(point: &Point) -> f64 {
    1.0 - point.orbit.jacobian.trace() + point.orbit.determinant()
}

/// The events between two points that follow each other, in order, each with its point; of the points are
/// given the directions of the branch.
pub(super) fn between(
    corrector: &Corrector,
    (from, along): (&Point, f64),
    (to, onward): (&Point, f64),
) -> Vec<(BranchEvent, Point)> {
    let chord = to.at - from.at;
    let length = chord.norm();
    if !(length > 0.0) {
        return Vec::new();
    }
    let direction = chord / length;
    let at = |share: f64| corrector.correct(from.at + chord * share, &direction);
    let mut found: Vec<(f64, BranchEvent, Point)> = Vec::new();
    // What a mass does between two rests changes without a bifurcation.
    let touches = differ(from, to) && !(from.forgets() && to.forgets());
    if touches {
        // From the side that misses the stop: on the other the map changes as the root of the distance.
        let misses = from.orbit.contacts().len() <= to.orbit.contacts().len();
        let free = if misses { from } else { to };
        let share = |own: f64| if misses { own } else { 1.0 - own };
        let (mut low, mut high) = (0.0, 1.0);
        let (mut before, mut after) = (None, None);
        for _ in 0..MOST_POINTS {
            if (high - low) * length <= LOCATED {
                break;
            }
            let middle = 0.5 * (low + high);
            match at(share(middle)) {
                Some(point) if !differ(free, &point) => (low, before) = (middle, Some(point)),
                Some(point) => (high, after) = (middle, Some(point)),
                None => high = middle,
            }
        }
        let before = before.unwrap_or_else(|| free.clone());
        let grazes = |point: &Point| grazes(point, &corrector.units);
        if grazes(&before) || after.as_ref().is_some_and(grazes) {
            let own = touching(corrector, &before).unwrap_or(before);
            found.push((share(low), BranchEvent::Grazing, own));
        }
    }
    // Across a grazing the multipliers jump: none passes through the unit circle there.
    let mut add = |event: BranchEvent, ends: (f64, f64), of: &dyn Fn(&Point) -> Option<f64>| {
        if touches || !(ends.0 * ends.1 < 0.0) {
            return false;
        }
        if let Some((share, point)) = root(ends, &at, length, of) {
            found.push((share, event, point));
        }
        true
    };
    let folds = add(BranchEvent::Fold, (along, onward), &|point| {
        corrector.tangent(point, &direction).map(|tangent| tangent.z)
    });
    add(BranchEvent::Flip, (at_minus_one(from), at_minus_one(to)), &|point| Some(at_minus_one(point)));
    if !folds {
        add(BranchEvent::Symmetry, (at_one(from), at_one(to)), &|point| Some(at_one(point)));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, event, point)| (event, point)).collect()
}

/// The motion that touches a stop without speed, on the branch through one that misses it narrowly: there the
/// distance changes in proportion, and it is followed down to where a difference by the field would touch.
fn touching(corrector: &Corrector, narrow: &Point) -> Option<Point> {
    let miss = |point: &Point| point.orbit.passage.nearest_miss.map(|miss| miss / corrector.units.length);
    let mut near = narrow.clone();
    let mut along = corrector.tangent(narrow, &Vector3::z())?;
    let mut step = -TRIAL;
    for _ in 0..MOST_POINTS {
        let Some(next) = corrector.correct(near.at + along * step, &along).filter(|own| !differ(narrow, own))
        else {
            step *= -0.5; // the other way, or not as far
            continue;
        };
        along = corrector.tangent(&next, &along)?;
        let slope = (miss(&next)? - miss(&near)?) / (next.at - near.at).dot(&along);
        near = next;
        let left = -miss(&near)? / slope;
        if left.abs() <= 2.0 * TRIAL {
            let at = near.at + along * left;
            return Some(corrector.moved(near, at));
        }
        step = left - 0.5 * TRIAL.copysign(left);
        if !(step.abs() < FARTHEST) {
            return None;
        }
    }
    None
}

/// Where a quantity with these values at the ends of a chord is 0, by the secant method kept in its bracket
/// (Illinois).
fn root(
    ends: (f64, f64),
    at: &impl Fn(f64) -> Option<Point>,
    length: f64,
    of: &dyn Fn(&Point) -> Option<f64>,
) -> Option<(f64, Point)> {
    let ((mut low, mut below), (mut high, mut above)) = ((0.0, ends.0), (1.0, ends.1));
    let mut kept = 0_i8;
    let mut last = None;
    for _ in 0..MOST_POINTS {
        let middle = low + (high - low) * (below / (below - above)).clamp(1e-9, 1.0 - 1e-9);
        // where the method does not converge right there, it may do so beside it
        let beside = [middle, 0.5 * (low + high), low + 0.3 * (high - low), low + 0.7 * (high - low)];
        let found = beside.into_iter().find_map(|share| at(share).map(|point| (share, point)));
        let Some((middle, point)) = found else { break };
        let Some(value) = of(&point) else { break };
        let moved = last.as_ref().map_or(f64::INFINITY, |(before, _): &(f64, Point)| (middle - before).abs());
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
    last
}
