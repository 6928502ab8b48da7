//! Phase of a drive that is changed while it runs: the phase is continuous.
//!
//! Every tone is amplitude sin(2 pi f t + phase) of one running time, so a change of amplitude needs no
//! correction. If the frequency changes at time t, the phase has to grow by (f - f') t turns.

use crate::dynamics::model::Model;
use crate::dynamics::model::excitation::{ExcitationParts, TonePart};
use crate::numeric::{DoubleDouble, Scalar};

/// The turns by which each tone of `new` has to be ahead of its scene from `now` in s on, if the tones of
/// `old` were ahead by `shifts`. Tones correspond by their order; a drive with another number of tones begins
/// as its scene says.
pub(crate) fn shifts(old: &Model, new: &Model, shifts: &[f64], now: f64) -> Vec<f64> {
    let (from, to) = (&old.excitation.tones, &new.excitation.tones);
    if from.len() != to.len() {
        return vec![0.0; to.len()];
    }
    from.iter().zip(to).zip(shifts).map(|((from, to), shift)| shifted(from, to, *shift, now)).collect()
}

fn shifted(from: &TonePart, to: &TonePart, shift: f64, now: f64) -> f64 {
    if from.frequency == to.frequency {
        return shift;
    }
    let turns = DoubleDouble::product(from.frequency, now) - DoubleDouble::product(to.frequency, now);
    fraction(shift + (turns - turns.floor()).to_f64())
}

/// Advances every tone by its shift.
pub(crate) fn shift(drive: &mut ExcitationParts, shifts: &[f64]) {
    for (tone, shift) in drive.tones.iter_mut().zip(shifts).filter(|(_, shift)| **shift != 0.0) {
        tone.phase = fraction(tone.phase + shift);
    }
}

/// Makes `now` in s the time 0 of every tone.
pub(crate) fn advance(drive: &mut ExcitationParts, now: f64) {
    for tone in &mut drive.tones {
        let turns = DoubleDouble::product(tone.frequency, now);
        tone.phase = fraction(tone.phase + (turns - turns.floor()).to_f64());
    }
}

/// Fraction of a turn, 0 <= fraction < 1.
fn fraction(turns: f64) -> f64 {
    let fraction = turns - turns.floor();
    if fraction < 1.0 { fraction } else { 0.0 }
}
