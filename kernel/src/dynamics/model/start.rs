//! Start state of a run.

use super::stops::StopPair;
use crate::mechanics::{Hertz, Mechanism};
use crate::numeric::bisect;
use crate::scene::{Fault, Scene, Start};

/// Displacement in m and velocity in m/s of the start of a scene.
pub(crate) fn start_state(
    scene: &Scene,
    mechanism: &Mechanism,
    stops: Option<StopPair>,
    compliant: Option<Hertz>,
) -> Result<(f64, f64), Fault> {
    let StopPair { left, right } = stops.unwrap_or_default();
    let domain = mechanism.curve.domain();
    match scene.start {
        Start::Rest => {
            let at = [left, right].map(|stop| stop.map(|stop| stop.x));
            let x = rest(mechanism, at, compliant).map_err(|problem| Fault::new("start", "Rest", problem))?;
            Ok((x, 0.0))
        }
        Start::At { x_mm, v_m_per_s, .. } => {
            // the sum with 0 makes a 0 of -0
            let (x, v_m_per_s) = (x_mm / 1e3 + 0.0, v_m_per_s + 0.0);
            if let Some(stop) = right.filter(|s| x > s.x).or(left.filter(|s| x < s.x)) {
                let problem = format!("lies beyond the stop at {} mm; start between the stops", stop.x * 1e3);
                return Err(Fault::new("start.x_mm", x_mm.to_string(), problem));
            }
            if x < domain.0 || x > domain.1 {
                let (from, to) = (domain.0 * 1e3, domain.1 * 1e3);
                let problem = format!("lies outside the force curve, which is known from {from} to {to} mm");
                return Err(Fault::new("start.x_mm", x_mm.to_string(), problem));
            }
            Ok((x, v_m_per_s))
        }
    }
}

/// Displacement in m at which a mass rests between these stops: the right-hand stable equilibrium of the
/// mechanism; where that lies beyond the right stop, the stop if the mechanism presses the mass onto it, else
/// the nearest stable equilibrium to the left of it, else the left stop; the mirror image of that where it
/// lies beyond the left stop. The error says that there is no such place.
fn rest(
    mechanism: &Mechanism,
    [left, right]: [Option<f64>; 2],
    compliant: Option<Hertz>,
) -> Result<f64, &'static str> {
    let Some(equilibrium) = mechanism.landscape.right_stable() else {
        return Err("this mechanism has no stable equilibrium to rest at; use At(x_mm: .., v_m_per_s: ..)");
    };
    let stable = || mechanism.landscape.equilibria.iter().filter(|at| at.stable).map(|at| at.x);
    let before = |x: f64| right.is_none_or(|stop| x <= stop);
    let inside = stable().rfind(|x| before(*x) && left.is_none_or(|stop| *x >= stop));
    // the stop of a side, if the mechanism presses the mass onto it
    let pressed = |stop: Option<f64>, sign: f64| {
        let stop = stop.filter(|x| sign * mechanism.curve.force(*x) < 0.0)?;
        let beyond = |x: &f64| sign * (x - stop) > 0.0;
        let Some(hertz) = compliant else { return Some(stop) };
        let nearest = |a: f64, b: f64| if (a - stop).abs() < (b - stop).abs() { a } else { b };
        Some(pressed_in(mechanism, &hertz, stop, stable().filter(beyond).reduce(nearest)?))
    };
    let at = if before(equilibrium.x) {
        inside.or_else(|| pressed(left, -1.0)).or_else(|| pressed(right, 1.0))
    } else {
        pressed(right, 1.0).or(inside).or_else(|| pressed(left, -1.0))
    };
    at.ok_or(
        "the mass rests nowhere between the stops: no stable equilibrium lies between them, and the \
         mechanism presses it onto neither; use At(x_mm: .., v_m_per_s: ..)",
    )
}

/// Displacement in m of a mass at rest that the mechanism presses onto the compliant stop at `surface`,
/// towards the equilibrium at `equilibrium` beyond it: where the forces of stop and mechanism are equal. It
/// lies between the surface, where only the mechanism acts, and the equilibrium, where its force is 0.
fn pressed_in(mechanism: &Mechanism, hertz: &Hertz, surface: f64, equilibrium: f64) -> f64 {
    let sign = (equilibrium - surface).signum();
    let pressed = |depth: f64| -sign * mechanism.curve.force(surface + sign * depth);
    let excess = |depth: f64| hertz.stiffness * depth * depth.sqrt() - pressed(depth);
    let (mut low, mut high) = (0.0, (equilibrium - surface).abs());
    // The depth is far less than the distance to the equilibrium: first bracket it near the static depth.
    let near = hertz.static_depth(pressed(0.0).max(0.0));
    for guess in [0.5 * near, 2.0 * near] {
        if guess > low && guess < high {
            *(if excess(guess) > 0.0 { &mut high } else { &mut low }) = guess;
        }
    }
    let pressed_too_little = |depth: f64| !(excess(depth) > 0.0);
    surface + sign * bisect(low, high, 200, pressed_too_little).1
}
