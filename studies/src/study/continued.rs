//! Scene that begins in the present state of a motion.

use crate::dynamics::Model;
use crate::scene::{Excitation, Scene, Start};

/// `scene` with the start and the phases of `here`, the model of a motion that goes on from its present state
/// ([`Watch::from_here`](super::Watch::from_here)). `None` if no scene can express it: noise begins at its
/// seed, and no scene starts with a compliant stop pressed in.
pub fn continued_scene(scene: &Scene, here: &Model) -> Option<Scene> {
    let (x, v) = here.start();
    if !here.excitation().noises.is_empty() || here.compliant().is_some() && here.pressed_depth(x).is_some() {
        return None;
    }
    let mut scene = scene.clone();
    scene.start = Start::At { x_mm: millimetres(x), v_m_per_s: v, electrical: here.start_electrical() };
    let mut turns = here.excitation().tones.iter().map(|tone| {
        let half = if tone.amplitude < 0.0 { 0.5 } else { 0.0 };
        (tone.phase + if tone.quarter { 0.25 } else { 0.0 }, half)
    });
    put_phases(&mut scene.excitation, &mut turns).then_some(scene)
}

/// Gives every sine of an excitation its phase, from turns and the half turn of a negative amplitude; false
/// if another part has a phase.
fn put_phases(excitation: &mut Excitation, turns: &mut impl Iterator<Item = (f64, f64)>) -> bool {
    match excitation {
        Excitation::None | Excitation::Constant { .. } => true,
        Excitation::Sine { amplitude_g, phase_deg, .. } => {
            let Some((turn, half)) = turns.next() else { return false };
            let half = if *amplitude_g < 0.0 { 0.5 - half } else { half };
            *phase_deg = 360.0 * (turn + half);
            true
        }
        Excitation::Sum(terms) => terms.iter_mut().all(|term| put_phases(term, turns)),
        Excitation::AmplitudeRamp { .. }
        | Excitation::Chirp { .. }
        | Excitation::Noise { .. }
        | Excitation::Recorded { .. } => false,
    }
}

/// The number of millimetres that is read back as `x` in m, where there is one.
fn millimetres(x: f64) -> f64 {
    let mm = x * 1e3;
    [mm, mm.next_up(), mm.next_down()].into_iter().find(|mm| mm / 1e3 == x).unwrap_or(mm)
}
