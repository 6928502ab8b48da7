//! Stable periodic orbits of the stroboscopic map, with ellipses around their states from which all motions
//! go to the orbit.
//!
//! A motion whose states repeat proposes an orbit. Newton's method on the map over `period` forcing periods
//! finds the orbit nearby, and the Lyapunov equation M = J^T M J + I gives a norm in which the linearised map
//! is a contraction; without a solution the orbit is unstable. The contraction of the full map in that norm
//! is then measured on circles of growing radius. The largest circle up to which all of them contract is the
//! ellipse: every motion that enters it goes to the orbit. If there is none, the map over multiples of the
//! period is tried.

use super::stroboscopic::{Point, Stroboscope};
use crate::dynamics::{Capture, Jacobian, Outcome};
use crate::study::{Cancelled, State};

type Matrix = [[f64; 2]; 2];

/// Largest number of steps of Newton's method.
const MAX_STEPS: usize = 12;
/// Longest step of Newton's method, in units of the scales.
const LONGEST_STEP: f64 = 0.1;
/// Length of a step at which Newton's method has converged, in units of the scales.
const LAST_STEP: f64 = 1e-8;

/// States of an orbit closer than this share of the scales are the same.
const SAME: f64 = 1e-6;

/// Smallest radius of a circle in the norm, in which lengths are never below those in units of the scales.
const MIN_RADIUS: f64 = 2e-5;
/// Number of circles.
const RADII: usize = 34;
/// Ratio of consecutive radii.
const GROWTH: f64 = std::f64::consts::SQRT_2;
/// Number of starts on a circle.
const AROUND: usize = 16;

/// Distance to an orbit below which a state has arrived there, as a share of the scales: the same as for a
/// repetition of states.
const NEAR: f64 = 1e-3;

/// Multiples of the period that are tried for the map around an orbit.
const TIMES: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// Number of doublings of the series of the norm; a contraction by only 1e-9 per period needs half of them.
const DOUBLINGS: usize = 60;

/// Result of the search for an orbit near a proposal.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Found {
    /// A stable orbit: its states, each with its ellipse.
    Stable(Vec<Capture>),
    /// An unstable orbit through this state in m and m/s.
    Unstable(State),
    /// No orbit, or none with an ellipse from which all motions go to it.
    Nothing,
}

/// The orbit of the proposed or twice the proposed period near a state in m and m/s.
pub(super) fn find(scope: &Stroboscope, period: u32, state: State) -> Result<Found, Cancelled> {
    let first = of_period(scope, period, state)?;
    // shortly after a period doubling the two halves of the doubled orbit are nearly equal
    if let Found::Unstable(_) = first
        && let doubled @ Found::Stable(_) = of_period(scope, 2 * period, state)?
    {
        return Ok(doubled);
    }
    Ok(first)
}

fn of_period(scope: &Stroboscope, period: u32, state: State) -> Result<Found, Cancelled> {
    let Some(root) = newton(scope, period, scope.point(state)) else { return Ok(Found::Nothing) };
    let after: Vec<(Point, u32)> = (1..=period).map(|periods| (root, periods)).collect();
    let Some(states) = scope.map(&after)?.into_iter().collect::<Option<Vec<Point>>>() else {
        return Ok(Found::Nothing);
    };
    let same = |other: &Point| distance(other, &root) < SAME;
    let period = states.iter().position(same).map_or(period, |place| place as u32 + 1);
    let mut captures = Vec::new();
    let mut orbit = vec![root];
    orbit.extend_from_slice(&states[..period as usize - 1]);
    for point in orbit {
        let Some((_, jacobian)) = jacobian(scope, period, point) else { return Ok(Found::Nothing) };
        if lyapunov(&jacobian).is_none() {
            return Ok(Found::Unstable(scope.state(root)));
        }
        let Some(capture) = ellipse(scope, period, point, jacobian)? else { return Ok(Found::Nothing) };
        captures.push(capture);
    }
    Ok(Found::Stable(captures))
}

/// The ellipse around a fixed point of the map over `period` forcing periods, for the smallest multiple of
/// the period that has one.
///
/// If a motion passes a kink of the force, the derivative of the map changes rapidly, and near an orbit the
/// map need not contract at once in the norm of its derivative; over several periods it does.
fn ellipse(
    scope: &Stroboscope,
    period: u32,
    at: Point,
    mut jacobian: Matrix,
) -> Result<Option<Capture>, Cancelled> {
    for times in TIMES {
        let Some(norm) = lyapunov(&jacobian) else { break };
        if let Some(radius) = radius(scope, times * period, at, &norm)? {
            return Ok(Some(capture(scope, at, &norm, radius)));
        }
        jacobian = squared(&jacobian);
    }
    Ok(None)
}

fn squared([[p, q], [r, s]]: &Matrix) -> Matrix {
    [[p * p + q * r, p * q + q * s], [r * p + s * r, r * q + s * s]]
}

fn distance(a: &Point, b: &Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A fixed point of the map of `period` forcing periods near `from`.
fn newton(scope: &Stroboscope, period: u32, from: Point) -> Option<Point> {
    let mut point = from;
    for _ in 0..MAX_STEPS {
        let (image, [[a, b], [c, d]]) = jacobian(scope, period, point)?;
        let (a, d, rest) = (a - 1.0, d - 1.0, [point[0] - image[0], point[1] - image[1]]);
        let determinant = a * d - b * c;
        let step = [(d * rest[0] - b * rest[1]) / determinant, (a * rest[1] - c * rest[0]) / determinant];
        let length = step[0].hypot(step[1]);
        if !(length < LONGEST_STEP) {
            break;
        }
        point = [point[0] + step[0], point[1] + step[1]];
        if length < LAST_STEP {
            return Some(point);
        }
    }
    None
}

/// The image of a point and the derivative of the map there, in units of the scales; `None` if the motion
/// ends early.
fn jacobian(scope: &Stroboscope, period: u32, at: Point) -> Option<(Point, Matrix)> {
    let ((length, speed), map) =
        (scope.units(), scope.model.stroboscopic_map(scope.model.drive_phase(0.0)?)?);
    let (passage, Jacobian { rows: [[a, b], [c, d]] }) = map.pass_with_jacobian(scope.state(at), period);
    let whole = scope.has(at) && passage.outcome == Outcome::Done;
    whole.then(|| (scope.point(passage.state), [[a, b * speed / length], [c * length / speed, d]]))
}

/// M = sum of (J^k)^T J^k over k >= 0, if the sum is finite, as a, b and c of the rows (a, b) and (b, c).
/// Summed by doubling (Smith 1968).
fn lyapunov(jacobian: &Matrix) -> Option<[f64; 3]> {
    let mut power = *jacobian;
    let mut sum = [1.0, 0.0, 1.0];
    for _ in 0..DOUBLINGS {
        let [[p, q], [r, s]] = power;
        let [a, b, c] = sum;
        let more = [
            a * p * p + 2.0 * b * p * r + c * r * r,
            a * p * q + b * (p * s + q * r) + c * r * s,
            a * q * q + 2.0 * b * q * s + c * s * s,
        ];
        sum = [a + more[0], b + more[1], c + more[2]];
        if !sum.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        if more[0] + more[2] <= f64::EPSILON * (sum[0] + sum[2]) {
            return Some(sum);
        }
        power = squared(&power);
    }
    None
}

/// The squared length of a vector in a norm.
fn square([a, b, c]: &[f64; 3], [x, v]: Point) -> f64 {
    a * x * x + 2.0 * b * x * v + c * v * v
}

/// The largest radius around a fixed point up to which the map contracts every circle in the norm, at least
/// half as strongly as its derivative does; `None` if it does not contract even the smallest one.
fn radius(scope: &Stroboscope, period: u32, at: Point, norm: &[f64; 3]) -> Result<Option<f64>, Cancelled> {
    let [a, b, c] = *norm;
    // the unit circle of the norm is (u, w) by M = L L^T
    let (l, m) = (a.sqrt(), b / a.sqrt());
    let n = (c - m * m).sqrt();
    let radii = || (0..RADII).map(|step| MIN_RADIUS * GROWTH.powi(step as i32));
    let away = |radius: f64, part: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * part as f64 / AROUND as f64).sin_cos();
        let v = radius * sine / n;
        [(radius * cosine - m * v) / l, v]
    };
    let circles: Vec<Point> =
        radii().flat_map(|radius| (0..AROUND).map(move |part| away(radius, part))).collect();
    let starts: Vec<(Point, u32)> = circles.iter().map(|[x, v]| ([at[0] + x, at[1] + v], period)).collect();
    let images = scope.map(&starts)?;
    let shrinks = |(from, image): (&Point, &Option<Point>)| {
        image.is_some_and(|image| {
            let to = [image[0] - at[0], image[1] - at[1]];
            square(norm, to) <= square(norm, *from) - 0.5 * (from[0] * from[0] + from[1] * from[1])
        })
    };
    let whole = circles.chunks(AROUND).zip(images.chunks(AROUND));
    let good = whole.take_while(|(from, to)| from.iter().zip(*to).all(shrinks)).count();
    Ok(good.checked_sub(1).and_then(|last| radii().nth(last)))
}

/// The ellipse of this radius in a norm, in SI.
fn capture(scope: &Stroboscope, at: Point, norm: &[f64; 3], radius: f64) -> Capture {
    let (length, speed) = scope.units();
    let per = 1.0 / (radius * radius);
    let form = [
        norm[0] * per / (length * length),
        norm[1] * per / (length * speed),
        norm[2] * per / (speed * speed),
    ];
    Capture { state: scope.state(at), form, near: (NEAR * length, NEAR * speed) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_norm_solves_its_equation_and_no_unstable_map_has_one() {
        for jacobian in [[[0.5, 3.0], [0.0, -0.9]], [[0.6, -0.7], [0.7, 0.6]], [[0.0, 0.0], [0.0, 0.0]]] {
            let norm = lyapunov(&jacobian).unwrap();
            for from in [[1.0, 0.0], [0.3, -1.0], [-2.0, 0.1]] {
                let to = jacobian.map(|[a, b]: [f64; 2]| a * from[0] + b * from[1]);
                let shrunk = square(&norm, from) - (from[0] * from[0] + from[1] * from[1]);
                assert!((square(&norm, to) - shrunk).abs() < 1e-13 * square(&norm, from), "{jacobian:?}");
            }
        }
        for jacobian in [[[1.001, 0.0], [0.0, 0.1]], [[0.0, -1.0], [1.0, 0.0]], [[0.1, 0.0], [5.0, -1.01]]] {
            assert_eq!(lyapunov(&jacobian), None);
        }
    }
}
