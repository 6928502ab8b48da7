//! Rates far apart: a drive much faster than the mechanism, a ripple on a slow one, a mechanism much faster
//! than the drive.

use std::f64::consts::TAU;

use interwell::dynamics::{EventKind, Outcome, STANDARD_GRAVITY, Side};
use interwell::numeric::bisect;

use crate::support::*;

#[test]
fn a_drive_ten_thousand_times_faster_than_the_spring() {
    // x'' + x = -A sin(w t), w = 1e4, from rest at 0: x = A (sin(w t) - w sin t)/(w^2 - 1) of some 1 m, to
    // 1e-13 of the length scale, A; in four steps a cycle.
    let (w, a) = (1e4, 1e4);
    let model = model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]),
         excitation: Sine(frequency_hz: {:?}, amplitude_g: {:?}), start: At(x_mm: 0, v_m_per_s: 0),
         run: (duration_s: 10, tolerance: 1e-12)",
        w / TAU,
        a / STANDARD_GRAVITY
    ));
    let run = run_at(&model, &every(0.3737, 26));
    for s in &run.samples {
        let gain = a / (w * w - 1.0);
        near(s.x, gain * ((w * s.t).sin() - w * s.t.sin()), 1e-13 * a);
        near(s.v, gain * w * ((w * s.t).cos() - s.t.cos()), 1e-13 * a);
    }
    assert_eq!(run.samples.len(), 26);
    let cycles = 10.0 * w / TAU;
    assert!((run.summary.steps as f64) < 5.0 * cycles, "{} steps in {cycles} cycles", run.summary.steps);
}

#[test]
fn a_fast_ripple_decides_a_release() {
    // Pressed on the right stop with 2 N by F = -2 N on 1 kg: the release under a_b = A sin(w t) + r sin(1000
    // w t) is the first instant at which the sum reaches 2, which the ripple brings forward. Found here by a
    // fine scan and bisection.
    let (slow, a, ripple) = (0.5, 2.05, 0.02);
    let model = model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [-2]),
         stops: Rigid(travel_limit_mm: 100, restitution: 0.3), start: At(x_mm: 100, v_m_per_s: 0),
         excitation: Sum([Sine(frequency_hz: {slow:?}, amplitude_g: {:?}),
                          Sine(frequency_hz: {:?}, amplitude_g: {:?})]),
         run: (duration_s: 1, tolerance: 1e-12)",
        a / STANDARD_GRAVITY,
        1000.0 * slow,
        ripple / STANDARD_GRAVITY
    ));
    let excess = |t: f64| a * (TAU * slow * t).sin() + ripple * (TAU * 1000.0 * slow * t).sin() - 2.0;
    let step = 1e-6;
    let n = (0..1_000_000).find(|n| excess(f64::from(*n) * step) > 0.0).unwrap();
    let (_, high) = bisect(f64::from(n - 1) * step, f64::from(n) * step, 60, |t| excess(t) <= 0.0);
    let run = run(&model);
    let releases = of_kind(&run, EventKind::Release);
    assert_eq!(run.events[0].kind, EventKind::Rest);
    assert_eq!(releases[0].side, Side::Right);
    // without the ripple 11 ms later
    near((2.0f64 / a).asin() / TAU / slow, 0.4295534, 1e-7);
    near(releases[0].t, high, 1e-14);
    assert_eq!(run.summary.outcome, Outcome::Done);
}

#[test]
fn a_stiff_spring_under_a_slow_drive() {
    // x'' + g x' + k x = -A sin(w t) with sqrt k = 1e4 w and strong damping: quasi-static, and exactly the
    // steady orbit.
    let (k, g, w) = (1e8, 1e4, 1.0);
    let model = model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, {k:?}]), \
         damping: Coefficient(c_n_s_per_m: {g:?}),
         excitation: Sine(frequency_hz: {:?}, amplitude_g: 1), start: At(x_mm: 0, v_m_per_s: 0),
         run: (duration_s: 3, tolerance: 1e-12)",
        w / TAU
    ));
    let run = run_at(&model, &every(0.5, 5));
    for s in &run.samples {
        let (re, im) = (k - w * w, g * w);
        let amplitude = STANDARD_GRAVITY / re.hypot(im);
        let angle = w * s.t - im.atan2(re);
        near(s.x, -amplitude * angle.sin(), 1e-12 * amplitude);
        near(s.v, -amplitude * w * angle.cos(), 1e-12 * model.scales().speed);
    }
    assert_eq!(run.samples.len(), 5);
    // 3755: stability bounds the step, not accuracy
    assert!(run.summary.steps < 5000, "{}", run.summary.steps);
}
