//! Stable periodic orbits of the stroboscopic map, with ellipses around their states from which all motions
//! go to the orbit. Beside a circuit points have its state as a third coordinate, and the ellipses are
//! ellipsoids; without one that coordinate is 0.
//!
//! A motion whose states repeat proposes an orbit. Newton's method on the map over `period` forcing periods
//! finds the orbit nearby, and the Lyapunov equation M = J^T M J + I gives a norm in which the linearised map
//! is a contraction; without a solution the orbit is unstable. The contraction of the full map in that norm
//! is then measured on circles of growing radius. The largest circle up to which all of them contract is the
//! ellipse: every motion that enters it goes to the orbit. If there is none, the map over multiples of the
//! period is tried.

use nalgebra::{Matrix3, Vector3};

use super::stroboscopic::{Point, Stroboscope};
use crate::dynamics::{Capture, Jacobian, MapState, Outcome};
use crate::numeric::elementary;
use crate::study::Result;
use crate::study::orbit::newton_step;

const MAX_STEPS: usize = 12;
/// Longest step of Newton's method, in units of the scales.
const LONGEST_STEP: f64 = 0.1;
/// Length of a step at which Newton's method has converged, in units of the scales.
const LAST_STEP: f64 = 1e-8;

/// States of an orbit closer than this share of the scales are the same.
const SAME: f64 = 1e-6;

/// Smallest radius of a circle in the norm, in which lengths are never below those in units of the scales.
const MIN_RADIUS: f64 = 2e-5;
const RADII: usize = 34;
/// Ratio of consecutive radii.
const GROWTH: f64 = std::f64::consts::SQRT_2;
/// Number of starts on a circle.
const AROUND: usize = 16;
/// Number of starts on the sphere that takes the place of a circle beside a circuit.
const ON_SPHERE: usize = 96;

/// Distance to an orbit below which a state has arrived, as a share of the scales.
const NEAR: f64 = 1e-3;

/// Multiples of the period that are tried for the map around an orbit.
const TIMES: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// Number of doublings of the series of the norm; a contraction by only 1e-9 per period needs half of them.
const DOUBLINGS: usize = 60;

/// Orbits that no motion can be told by, each by a state.
#[derive(Debug, Default)]
pub(super) struct Rejected {
    pub unstable: Vec<MapState>,
    /// Those without an ellipse from which all motions go to them.
    bare: Vec<MapState>,
}

#[derive(Debug, Clone, PartialEq)]
enum Found {
    /// A stable orbit: its states, each with its ellipse.
    Stable(Vec<Capture>),
    /// An unstable orbit.
    Unstable,
    /// No orbit, or none with an ellipse from which all motions go to it.
    Nothing,
}

/// The states of the stable orbit of the proposed or twice the proposed period near a state, each with its
/// ellipse. What is found depends on the orbit alone, not on the state that proposes it.
pub(super) fn find(
    scope: &Stroboscope,
    period: u32,
    state: MapState,
    rejected: &mut Rejected,
) -> Result<Option<Vec<Capture>>> {
    // shortly after a period doubling the two halves of the doubled orbit are nearly equal
    for period in [period, 2 * period] {
        match of_period(scope, period, state, rejected)? {
            Found::Stable(captures) => return Ok(Some(captures)),
            Found::Unstable => {}
            Found::Nothing => break,
        }
    }
    Ok(None)
}

fn of_period(scope: &Stroboscope, period: u32, state: MapState, rejected: &mut Rejected) -> Result<Found> {
    let Some(root) = newton(scope, period, scope.point(state)) else { return Ok(Found::Nothing) };
    let is_among = |all: &[MapState]| all.iter().any(|other| is_near(scope, *other, scope.state(root), SAME));
    if is_among(&rejected.unstable) {
        return Ok(Found::Unstable);
    }
    if is_among(&rejected.bare) {
        return Ok(Found::Nothing);
    }
    let found = around(scope, period, root)?;
    match found {
        Found::Stable(_) => {}
        Found::Unstable => rejected.unstable.push(scope.state(root)),
        Found::Nothing => rejected.bare.push(scope.state(root)),
    }
    Ok(found)
}

/// Whether two states differ by at most this share of the scales.
pub(super) fn is_near(scope: &Stroboscope, a: MapState, b: MapState, share: f64) -> bool {
    scope.units().apart(a, b).iter().all(|off| off.abs() <= share)
}

/// The orbit through a fixed point of the map over `period` forcing periods.
fn around(scope: &Stroboscope, period: u32, root: Point) -> Result<Found> {
    let after: Vec<(Point, u32)> = (1..=period).map(|periods| (root, periods)).collect();
    let Some(states) = scope.map(&after)?.into_iter().collect::<Option<Vec<Point>>>() else {
        return Ok(Found::Nothing);
    };
    let same = |other: &Point| (Vector3::from(*other) - Vector3::from(root)).norm() < SAME;
    let period = states.iter().position(same).map_or(period, |place| place as u32 + 1);
    let mut captures = Vec::new();
    let mut orbit = vec![root];
    orbit.extend_from_slice(&states[..period as usize - 1]);
    for point in orbit {
        let Some((_, jacobian)) = derivative(scope, period, point) else { return Ok(Found::Nothing) };
        let jacobian = Matrix3::from_fn(|i, j| jacobian.rows()[i][j]);
        if lyapunov(&jacobian).is_none() {
            return Ok(Found::Unstable);
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
    mut jacobian: Matrix3<f64>,
) -> Result<Option<Capture>> {
    for times in TIMES {
        let Some(norm) = lyapunov(&jacobian) else { break };
        if let Some(radius) = radius(scope, times * period, at, &norm)? {
            return Ok(Some(capture(scope, at, &norm, radius)));
        }
        jacobian *= jacobian;
    }
    Ok(None)
}

/// A fixed point of the map of `period` forcing periods near `from`.
fn newton(scope: &Stroboscope, period: u32, from: Point) -> Option<Point> {
    let mut point = from;
    for _ in 0..MAX_STEPS {
        let (image, jacobian) = derivative(scope, period, point)?;
        let step = newton_step(&jacobian, [0, 1, 2].map(|i| image[i] - point[i]))?;
        let length = Vector3::from(step).norm();
        if !(length < LONGEST_STEP) {
            break;
        }
        point = [0, 1, 2].map(|i| point[i] + step[i]);
        if length < LAST_STEP {
            return Some(point);
        }
    }
    None
}

/// The image of a point and the derivative of the map there, in the units; `None` if the motion ends early.
fn derivative(scope: &Stroboscope, period: u32, at: Point) -> Option<(Point, Jacobian)> {
    let map = scope.model.stroboscopic_map(scope.model.drive_phase(0.0)?)?;
    let (passage, jacobian) = map.pass_with_jacobian(scope.state(at), period);
    let whole = scope.has(at) && passage.outcome == Outcome::Done;
    whole.then(|| (scope.point((&passage).into()), jacobian.in_units(scope.units().of_state())))
}

/// M = sum of (J^k)^T J^k over k >= 0, if the sum is finite. Summed by doubling (Smith 1968).
fn lyapunov(jacobian: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let mut power = *jacobian;
    let mut sum = Matrix3::identity();
    for _ in 0..DOUBLINGS {
        let more = power.transpose() * sum * power;
        sum += more;
        if !sum.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        if more.trace() <= f64::EPSILON * sum.trace() {
            return Some(sum);
        }
        power *= power;
    }
    None
}

fn square(norm: &Matrix3<f64>, vector: &Vector3<f64>) -> f64 {
    vector.dot(&(norm * vector))
}

/// Vectors of length 1, evenly around a circle or over a sphere (Vogel 1979).
fn directions(size: usize) -> Vec<Vector3<f64>> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let on_circle = |part: usize| {
        let (sine, cosine) = elementary::sin_cos(std::f64::consts::TAU * part as f64 / AROUND as f64);
        Vector3::new(cosine, sine, 0.0)
    };
    let on_sphere = |part: usize| {
        let height = 1.0 - (2 * part + 1) as f64 / ON_SPHERE as f64;
        let (sine, cosine) = elementary::sin_cos(golden * part as f64);
        let across = (1.0 - height * height).sqrt();
        Vector3::new(across * cosine, across * sine, height)
    };
    if size == 3 { (0..ON_SPHERE).map(on_sphere).collect() } else { (0..AROUND).map(on_circle).collect() }
}

/// The largest radius around a fixed point up to which the map contracts every circle in the norm, at least
/// half as strongly as its derivative does; `None` if it does not contract even the smallest one.
fn radius(scope: &Stroboscope, period: u32, at: Point, norm: &Matrix3<f64>) -> Result<Option<f64>> {
    // with M = L L^T, the points of length 1 in the norm are those that L^T takes to length 1
    let Some(factor) = norm.cholesky().map(|factor| factor.l().transpose()) else { return Ok(None) };
    let around: Option<Vec<Vector3<f64>>> =
        directions(scope.size()).iter().map(|unit| factor.solve_upper_triangular(unit)).collect();
    let Some(around) = around else { return Ok(None) };
    let radii = || (0..RADII).map(|step| MIN_RADIUS * elementary::powi(GROWTH, step as i32));
    let circles: Vec<Vector3<f64>> =
        radii().flat_map(|radius| around.iter().map(move |unit| unit * radius)).collect();
    let starts: Vec<(Point, u32)> =
        circles.iter().map(|from| ((Vector3::from(at) + from).into(), period)).collect();
    let images = scope.map(&starts)?;
    let shrinks = |(from, image): (&Vector3<f64>, &Option<Point>)| {
        image.is_some_and(|image| {
            let to = Vector3::from(image) - Vector3::from(at);
            square(norm, &to) <= square(norm, from) - 0.5 * from.norm_squared()
        })
    };
    let whole = circles.chunks(around.len()).zip(images.chunks(around.len()));
    let good = whole.take_while(|(from, to)| from.iter().zip(*to).all(shrinks)).count();
    Ok(good.checked_sub(1).and_then(|last| radii().nth(last)))
}

/// The ellipse of this radius in a norm, in SI.
fn capture(scope: &Stroboscope, at: Point, norm: &Matrix3<f64>, radius: f64) -> Capture {
    let units = scope.units().of_state();
    let per = 1.0 / (radius * radius);
    let form = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)];
    let form = form.map(|(i, j)| norm[(i, j)] * per / (units[i] * units[j]));
    let [x, v, electrical] = units.map(|unit| NEAR * unit);
    Capture { state: scope.state(at), form, near: MapState { x, v, electrical } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_norm_solves_its_equation_and_no_unstable_map_has_one() {
        let plane = |a, b, c, d| Matrix3::new(a, b, 0.0, c, d, 0.0, 0.0, 0.0, 0.0);
        let space = Matrix3::new(0.6, -0.7, 0.3, 0.7, 0.6, -0.2, 0.1, 2.0, 0.1);
        for jacobian in [plane(0.5, 3.0, 0.0, -0.9), plane(0.6, -0.7, 0.7, 0.6), Matrix3::zeros(), space] {
            let norm = lyapunov(&jacobian).unwrap();
            for from in
                [Vector3::new(1.0, 0.0, 0.2), Vector3::new(0.3, -1.0, 0.0), Vector3::new(-2.0, 0.1, -1.0)]
            {
                let shrunk = square(&norm, &from) - from.norm_squared();
                let to = jacobian * from;
                assert!((square(&norm, &to) - shrunk).abs() < 1e-13 * square(&norm, &from), "{jacobian:?}");
            }
        }
        let grows = Matrix3::new(0.1, 0.0, 0.0, 5.0, 0.2, 0.0, 0.0, 3.0, -1.01);
        for jacobian in [plane(1.001, 0.0, 0.0, 0.1), plane(0.0, -1.0, 1.0, 0.0), grows] {
            assert_eq!(lyapunov(&jacobian), None);
        }
    }
}
