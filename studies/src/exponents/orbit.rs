//! Lyapunov of a periodic orbit, from its multipliers.

use super::tangent::{Passed, Tangent};
use super::{Estimate, Found, Lyapunov, NoExponents};
use crate::dynamics::MapState;
use crate::numeric::elementary;
use crate::study::orbit::newton_step;

/// Largest distance of a state of a repeating motion from the state one period later, in units of the scales.
const NEAR: f64 = 1e-2;

/// Such a distance that is caused by rounding only.
const ROUNDING: f64 = 1e-13;
/// Smallest and largest bound on that distance for an orbit found by Newton's method.
const CLOSE: (f64, f64) = (1e-10, 1e-4);

/// Largest number of steps of Newton's method, each of which doubles the number of digits.
const STEPS: usize = 12;

/// Growth over a period that may be lost in rounding.
const NEUTRAL: f64 = 1e-6;

/// The exponents of the periodic orbit of `periods` forcing periods to which the motion through `start` has
/// settled. `None` if there is no orbit near it, or if it is unstable and the motion is not exactly on it.
pub(super) fn of_orbit(tangent: &Tangent, start: MapState, periods: u32) -> Result<Found, NoExponents> {
    let Some((orbit, distance, moved)) = find(tangent, start, periods)? else { return Ok(None) };
    let time = tangent.map.period() * f64::from(periods);
    if orbit.jacobian.is_zero() {
        return Ok(Some(Lyapunov::of_rest(Some(periods), (periods, time), tangent)));
    }
    let growths = growths(&orbit);
    let first = growths[0];
    let stays = first <= NEUTRAL || (distance <= ROUNDING && !moved);
    Ok(stays.then(|| Lyapunov {
        first: Estimate::exact(first / time),
        second: Estimate::exact(growths[1] / time),
        third: growths.get(2).map(|growth| Estimate::exact(growth / time)),
        sum: orbit.measured / time,
        exact_sum: orbit.exact.map(|sum| sum / time + 0.0),
        period: Some(periods),
        span: (periods, time),
    }))
}

/// Logarithms of the magnitudes of the multipliers of an orbit, by falling size.
fn growths(orbit: &Passed) -> Vec<f64> {
    if orbit.rested {
        return vec![elementary::ln(orbit.jacobian.trace().abs()), f64::NEG_INFINITY, f64::NEG_INFINITY];
    }
    let all = orbit.log_determinant();
    let multipliers = orbit.jacobian.multipliers(elementary::exp(all));
    let mut growths: Vec<f64> =
        multipliers.iter().map(|multiplier| elementary::ln(multiplier.magnitude())).collect();
    // the smallest, or a pair of that size, follows from the others, however small it is
    let size = growths.len();
    let smallest = if multipliers[size - 1].im == 0.0 { 1 } else { 2 };
    let others: f64 = growths[..size - smallest].iter().sum();
    if smallest == 1 || all.is_finite() {
        // if the others are minus infinity, their sum does not determine the smallest
        let left = if others == f64::NEG_INFINITY { others } else { (all - others) / smallest as f64 };
        growths[size - smallest..].fill(left);
    }
    growths
}

/// A periodic orbit, the distance of its state from that one period later, and whether the state at which it
/// was looked for had to be changed.
type Near = (Passed, f64, bool);

/// The periodic orbit near a state; `None` if Newton's method finds none.
fn find(tangent: &Tangent, mut state: MapState, periods: u32) -> Result<Option<Near>, NoExponents> {
    let mut best: Option<Near> = None;
    for step in 0..STEPS {
        let orbit = match tangent.pass_many(state, periods) {
            Ok(orbit) => orbit,
            Err(_) if step > 0 => break, // a step led to a state whose motion ends early
            Err(error) => return Err(error),
        };
        let off = tangent.units.apart(state, orbit.state);
        let distance = elementary::hypot(elementary::hypot(off[0], off[1]), off[2]);
        if step == 0 && !(distance <= NEAR) || best.is_some_and(|best| !(distance < best.1)) {
            break;
        }
        best = Some((orbit, distance, step > 0));
        let Some(by) = newton_step(&orbit.jacobian, off) else { break };
        let next = tangent.units.moved(state, by);
        if distance <= ROUNDING || !has_room(tangent, next) {
            break;
        }
        state = next;
    }
    let close = (10.0 * tangent.map.model().tolerance()).clamp(CLOSE.0, CLOSE.1);
    Ok(best.filter(|best| best.1 <= close))
}

/// Whether the mass can have this state.
fn has_room(tangent: &Tangent, MapState { x, v, electrical }: MapState) -> bool {
    let model = tangent.map.model();
    let (low, high) = model.mechanism().curve.domain();
    let (left, right) = model.stop_positions();
    let rigid = model.compliant().is_none();
    let inside = left.is_none_or(|stop| x >= stop) && right.is_none_or(|stop| x <= stop);
    v.is_finite() && electrical.is_finite() && x >= low && x <= high && (inside || !rigid)
}
