//! Start state of a run.

use super::stops::StopPair;
use crate::mechanics::{Hertz, Mechanism};
use crate::numeric::bisect;
use crate::scene::{Fault, Scene, Start};

pub(crate) fn fault(field: &str, value: impl ToString, problem: impl Into<String>) -> Fault {
    Fault { field: field.into(), value: value.to_string(), problem: problem.into() }
}

/// Displacement in m and velocity in m/s of the start of a scene.
pub(crate) fn start_state(
    scene: &Scene,
    mechanism: &Mechanism,
    stops: Option<StopPair>,
    compliant: Option<Hertz>,
) -> Result<(f64, f64), Fault> {
    let (left, right) = stops.map_or((None, None), |pair| (pair.left, pair.right));
    let domain = mechanism.curve.domain();
    match scene.start {
        Start::Rest => {
            let Some(equilibrium) = mechanism.landscape.right_stable() else {
                let problem =
                    "this mechanism has no stable equilibrium to rest at; use At(x_mm: .., v_m_per_s: ..)";
                return Err(fault("start", "Rest", problem));
            };
            let mut x = right.map_or(equilibrium.x, |stop| equilibrium.x.min(stop.x));
            x = left.map_or(x, |stop| x.max(stop.x));
            if let Some(hertz) = compliant.filter(|_| x != equilibrium.x) {
                x = pressed_in(mechanism, &hertz, x, equilibrium.x);
            }
            Ok((x, 0.0))
        }
        Start::At { x_mm, v_m_per_s, .. } => {
            let x = x_mm / 1e3;
            if let Some(stop) = right.filter(|s| x > s.x).or(left.filter(|s| x < s.x)) {
                let problem = format!("lies beyond the stop at {} mm; start between the stops", stop.x * 1e3);
                return Err(fault("start.x_mm", x_mm, problem));
            }
            if x < domain.0 || x > domain.1 {
                let (from, to) = (domain.0 * 1e3, domain.1 * 1e3);
                let problem = format!("lies outside the force curve, which is known from {from} to {to} mm");
                return Err(fault("start.x_mm", x_mm, problem));
            }
            Ok((x, v_m_per_s))
        }
    }
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
