//! The mirror image of a scene, and of a run.

use std::sync::Arc;

use interwell::dynamics::{Event, Phase, Place, Run};
use interwell::scene::{Damping, Excitation, Mechanism, Record, Scene, Start, Stops};
use proptest::prelude::*;

use super::harness::Verdict;
use super::sound::sign;

/// The excitation with the opposite sign at every time; of noise, which has no negative, none.
fn opposite(excitation: &Excitation) -> Option<Excitation> {
    Some(match excitation {
        Excitation::None => Excitation::None,
        Excitation::Constant { accel_g } => Excitation::Constant { accel_g: -accel_g },
        Excitation::Sine { .. } | Excitation::Cosine { .. } | Excitation::Force { .. } => {
            let mut other = excitation.clone();
            other.amplitude_mut().into_iter().for_each(|amplitude| *amplitude = -*amplitude);
            other
        }
        Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s } => Excitation::AmplitudeRamp {
            frequency_hz: *frequency_hz,
            from_g: -from_g,
            to_g: -to_g,
            over_s: *over_s,
        },
        Excitation::Chirp { from_hz, to_hz, over_s, amplitude_g } => {
            Excitation::Chirp { from_hz: *from_hz, to_hz: *to_hz, over_s: *over_s, amplitude_g: -amplitude_g }
        }
        Excitation::Recorded { path, record } => Excitation::Recorded {
            path: path.clone(),
            record: record.as_ref().map(|original| {
                let accelerations = original.accelerations.iter().map(|a| -a).collect();
                Arc::new(Record::new(original.times.clone(), accelerations))
            }),
        },
        Excitation::Sum(parts) => Excitation::Sum(parts.iter().map(opposite).collect::<Option<_>>()?),
        Excitation::Noise { .. } => return None,
    })
}

/// The scene in a mirror; none where it cannot be written (noise; rest, or a damping ratio, of the left one
/// of two wells; a table, which is fitted from left to right, unless it is odd and fitted as such).
pub fn image(scene: &Scene) -> Option<Scene> {
    let mut image = scene.clone();
    let odd = match &scene.mechanism {
        Mechanism::Polynomial { coefficients_si } => coefficients_si.iter().step_by(2).all(|c| *c == 0.0),
        Mechanism::Pieces { .. } => false,
        _ => true,
    };
    if !odd && matches!(scene.damping, Damping::Ratio(_)) {
        return None;
    }
    match &mut image.mechanism {
        Mechanism::Polynomial { coefficients_si } => {
            coefficients_si.iter_mut().step_by(2).for_each(|c| *c = -*c);
        }
        Mechanism::Pieces { ends_m, pieces, .. } => {
            ends_m.reverse();
            ends_m.iter_mut().for_each(|x| *x = -*x);
            pieces.reverse();
            for piece in pieces {
                piece.origin_m = -piece.origin_m;
                piece.coefficients_si.iter_mut().step_by(2).for_each(|c| *c = -*c);
            }
        }
        Mechanism::Table { path, .. } if path != "force_dl2.7.csv" => return None,
        _ => {}
    }
    if let Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right } = &mut image.stops {
        std::mem::swap(left_mm, right_mm);
        std::mem::swap(restitution_left, restitution_right);
    }
    match &mut image.start {
        Start::At { x_mm, v_m_per_s, .. } => {
            *x_mm = -*x_mm;
            *v_m_per_s = -*v_m_per_s;
        }
        Start::Rest => return None,
    }
    image.excitation = opposite(&scene.excitation)?;
    Some(image)
}

/// Asserts [`same_in_a_mirror`].
#[track_caller]
pub fn assert_mirrored(a: &Run, b: &Run) {
    if let Err(broken) = same_in_a_mirror(a, b) {
        panic!("{broken}");
    }
}

/// `b` is `a` seen in a mirror, bit for bit.
pub fn same_in_a_mirror(a: &Run, b: &Run) -> Verdict {
    prop_assert_eq!(a.samples.len(), b.samples.len());
    for (p, q) in a.samples.iter().zip(&b.samples) {
        prop_assert!(p.x == -q.x && p.v == -q.v && p.base_accel == -q.base_accel, "{:?} {:?}", p, q);
        prop_assert!((p.phase == Phase::Free) == (q.phase == Phase::Free), "{:?} {:?}", p, q);
    }
    let flat = |e: &Event| (e.t, e.kind, sign(e.side), e.v_in, e.v_out);
    prop_assert_eq!(a.events.len(), b.events.len());
    for (p, q) in a.events.iter().zip(&b.events) {
        let (t, kind, side, v_in, v_out) = flat(q);
        prop_assert_eq!(flat(p), (t, kind, -side, -v_in, -v_out));
    }
    let mut mirrored = b.summary;
    mirrored.final_x = -mirrored.final_x;
    mirrored.final_v = -mirrored.final_v;
    mirrored.range = mirrored.range.map(|(low, high)| (-high, -low));
    mirrored.mean_x = mirrored.mean_x.map(|mean| -mean);
    mirrored.side = mirrored.side.map(|side| match side {
        Place::Left => Place::Right,
        Place::Right => Place::Left,
        Place::Both => Place::Both,
    });
    mirrored.cpu_s = a.summary.cpu_s;
    prop_assert_eq!(a.summary, mirrored);
    Ok(())
}
