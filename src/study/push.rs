//! Amplitudes of a sine at which the base's push reaches a force of the mechanism, in closed form.

use crate::dynamics::STANDARD_GRAVITY;
use crate::mechanics::{Landscape, Mechanism};
use crate::scene::{Excitation, Scene};

/// The field of the amplitude of a sine.
pub(super) const AMPLITUDE: &str = "excitation.amplitude_g";

/// The amplitude in g whose push equals the largest force against which the mechanism must be moved from
/// where the mass rests to the barrier.
pub(super) fn holding_push(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
    let Landscape { barrier, extrema, .. } = &mechanism.landscape;
    let barrier = barrier.as_ref()?;
    let rests = match right_stop(scene) {
        Some(stop) => stop.min(barrier.right_well),
        None => barrier.right_well,
    };
    let between = |x: f64| x >= barrier.x && x <= rests;
    let inside = extrema.iter().filter(|extremum| between(extremum.x)).map(|extremum| extremum.force.abs());
    let force = inside.fold(mechanism.curve.force(rests).abs(), f64::max);
    Some(force / (scene.mass_g / 1e3) / STANDARD_GRAVITY).filter(|push| *push > 0.0 && push.is_finite())
}

fn right_stop(scene: &Scene) -> Option<f64> {
    scene.stops.limits_mm()[1].map(|mm| mm / 1e3)
}

/// The amplitude in g at which the base's push reaches the force that presses the mass on the stop that it
/// rests on.
pub(super) fn frees_at(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
    let Excitation::Sine { .. } = scene.excitation else { return None };
    let right = right_stop(scene)?;
    let well = mechanism.landscape.right_stable()?.x;
    let press = -mechanism.curve.force(right);
    (right < well && press > 0.0).then(|| press / (scene.mass_g / 1e3) / STANDARD_GRAVITY)
}
