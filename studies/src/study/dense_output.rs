//! Path of the mass between two known samples, by the equation of motion.
//!
//! For pictures: samples that are dense enough for an oscillation are too few where taut flexures turn the
//! mass round in a hundredth of it. The classical Runge-Kutta method goes from one sample towards the
//! next, the base's acceleration taken as linear between them, and its error at the next one is spread
//! over the way.

use crate::dynamics::{Model, Phase, Sample};

/// Displacements in m and velocities in m/s at `count` - 1 times, even between two samples of a flight,
/// neither of them included. Empty between samples at the same time or at rest.
pub fn between(model: &Model, from: &Sample, to: &Sample, count: usize) -> Vec<(f64, f64)> {
    let whole = to.t - from.t;
    if !(whole > 0.0) || from.phase != Phase::Free || count < 2 {
        return Vec::new();
    }
    let h = whole / count as f64;
    let rate = |share: f64, (x, v): (f64, f64)| {
        let base = from.base_accel + share * (to.base_accel - from.base_accel);
        (v, model.acceleration(x, v, base))
    };
    let mut at = (from.x, from.v);
    let mut way = Vec::with_capacity(count);
    for i in 0..count {
        let share = |part: f64| (i as f64 + part) / count as f64;
        let ahead = |k: (f64, f64), part: f64| (at.0 + part * h * k.0, at.1 + part * h * k.1);
        let k1 = rate(share(0.0), at);
        let k2 = rate(share(0.5), ahead(k1, 0.5));
        let k3 = rate(share(0.5), ahead(k2, 0.5));
        let k4 = rate(share(1.0), ahead(k3, 1.0));
        let mean = |a: f64, b: f64, c: f64, d: f64| (a + 2.0 * (b + c) + d) / 6.0;
        at = (at.0 + h * mean(k1.0, k2.0, k3.0, k4.0), at.1 + h * mean(k1.1, k2.1, k3.1, k4.1));
        way.push(at);
    }
    let missed = (to.x - at.0, to.v - at.1);
    if !(missed.0.is_finite() && missed.1.is_finite()) {
        // it left the known curve on the way: no points in between
        return Vec::new();
    }
    way.pop();
    for (i, point) in (1..).zip(way.iter_mut()) {
        let share = f64::from(i) / count as f64;
        *point = (point.0 + share * missed.0, point.1 + share * missed.1);
    }
    way
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::sync::Arc;

    use super::*;
    use crate::mechanics::Mechanism;
    use crate::scene::Document;

    #[test]
    fn a_quarter_of_a_swing_is_round() {
        let mut document = Document::load("monostable").unwrap();
        for change in ["mechanism.cubic_n_per_m3=0", "damping=None", "excitation=None"] {
            document.set(change).unwrap();
        }
        let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
        let model = Model::build(&document.scene, Arc::new(mechanism)).unwrap();
        let w = (40.0_f64 / 15.2e-3).sqrt();
        let quarter = 0.25 * TAU / w;
        let sample =
            |t: f64, x: f64, v: f64| Sample { t, x, v, base_accel: 0.0, phase: Phase::Free, electrical: 0.0 };
        let way = between(&model, &sample(0.0, 0.0, w * 1e-3), &sample(quarter, 1e-3, 0.0), 9);
        assert_eq!(way.len(), 8);
        for (i, (x, v)) in (1..).zip(&way) {
            let (sine, cosine) = (0.25 * TAU * f64::from(i) / 9.0).sin_cos();
            assert!((x - 1e-3 * sine).abs() < 1e-7 && (v - w * 1e-3 * cosine).abs() < 1e-5, "{i} {x} {v}");
        }
        assert!(between(&model, &sample(1.0, 0.0, 1.0), &sample(1.0, 0.0, -1.0), 9).is_empty());
        let rests = Sample { phase: Phase::LeftStop, ..sample(0.0, 0.0, 0.0) };
        assert!(between(&model, &rests, &sample(1.0, 0.0, 0.0), 9).is_empty());
    }
}
