//! Linear oscillators against their closed forms.

use std::f64::consts::{PI, TAU};

use interwell::dynamics::{EventKind, Model, STANDARD_GRAVITY, Sample, Side};
use interwell::numeric::{DoubleDouble, Number};
use interwell_studies::study::accuracy::exact::{Forcing, Oscillator};

use crate::support::*;

/// A tone with the amplitude `a` + `growth` t in m/s^2, of a frequency in Hz and a phase in degrees.
fn tone((a, growth): (f64, f64), frequency: f64, degrees: f64) -> Forcing {
    Forcing::Tone { amplitude: a, growth: DoubleDouble::of(growth), frequency, phase: degrees / 360.0 }
}

#[track_caller]
fn compare(model: &Model, sample: &Sample, exact: (f64, f64), bound: f64) {
    near(sample.x, exact.0, bound * model.scales().length);
    near(sample.v, exact.1, bound * model.scales().speed);
}

/// 20 g on a spring of 50 N/m (7.96 Hz), damping c.
fn sprung(c: f64, rest: &str) -> (Oscillator, Model) {
    let model = model(&format!(
        "mass_g: 20, mechanism: Polynomial(coefficients_si: [0, 50]),
         damping: Coefficient(c_n_s_per_m: {c:?}), start: At(x_mm: 2, v_m_per_s: -0.1), {rest}"
    ));
    (Oscillator::new(0.02, c, 50.0), model)
}

#[test]
fn free_oscillations_in_closed_form() {
    // Undamped, under-, critically (c = 2 sqrt(k m) = 2) and overdamped: to 1e-12 of the scales a second.
    for c in [0.0, 0.05, 2.0, 3.0, 40.0] {
        let (oscillator, model) = sprung(c, "run: (duration_s: 3, tolerance: 1e-12)");
        let run = run_at(&model, &every(0.037, 80));
        for s in &run.samples {
            compare(&model, s, oscillator.nearest((0.002, -0.1), 0.0, s.t, &[]), 2e-12);
        }
        assert_eq!(run.samples.len(), 80);
    }
}

#[test]
fn a_sine_on_a_damped_oscillator_in_closed_form() {
    // Below, at and above resonance, any phase: transient and steady motion, to 1e-12 of the scales.
    for (frequency, phase_deg) in [(3.0, 0.0), (7.957747154594767, 0.0), (31.0, -90.0), (11.3, 137.25)] {
        let (oscillator, model) = sprung(
            0.05,
            &format!(
                "excitation: Sine(frequency_hz: {frequency:?}, amplitude_g: 0.7, phase_deg: {phase_deg:?}),
                 run: (duration_s: 12, tolerance: 1e-12)"
            ),
        );
        let amplitude = 0.7 * STANDARD_GRAVITY;
        let drive = tone((amplitude, 0.0), frequency, phase_deg);
        let run = run_at(&model, &every(0.0911, 131));
        for s in &run.samples {
            let w = TAU * frequency;
            let angle = w * s.t + f64::to_radians(phase_deg);
            near(s.base_accel, amplitude * angle.sin(), 1e-13 * w * s.t.max(1.0));
            let exact = oscillator.nearest((0.002, -0.1), 0.0, s.t, &[drive]);
            compare(&model, s, exact, 3e-12);
        }
        assert_eq!(run.samples.len(), 131);
    }
}

#[test]
fn a_steady_orbit_has_the_textbook_rms() {
    // Long settled, RMS velocity = w X/sqrt 2 and peak to peak 2 X, X = A/sqrt((k - w^2)^2 + (g w)^2); a
    // run's period is one forcing period; the base's work is damping's.
    let (_, model) = sprung(
        0.6,
        "excitation: Sine(frequency_hz: 5, amplitude_g: 0.7), run: (duration_s: 6, settle_s: 3, \
         tolerance: 1e-12)",
    );
    let w = TAU * 5.0;
    let l = (50.0 / 0.02 - w * w).hypot(0.6 / 0.02 * w);
    let amplitude = 0.7 * STANDARD_GRAVITY / l;
    let summary = run(&model).summary;
    near_relative(summary.rms_velocity.unwrap(), w * amplitude * 0.5f64.sqrt(), 1e-13);
    near_relative(summary.travel().unwrap(), 2.0 * amplitude, 2e-13);
    near_relative(summary.max_abs_x.unwrap(), amplitude, 2e-13);
    assert_eq!(summary.period, Some(1));
}

#[test]
fn a_ramped_amplitude_in_closed_form_through_its_end() {
    // (from + (to - from) t/over) sin w t, then `to`: the closed form of each part, joined at the end of the
    // ramp, which is no step of its own choosing. The last ramp outlasts the run.
    for (from, to, over) in [(0.0, 1.0, 1.2345), (0.9, -0.4, 2.5), (-0.3, 0.0, 1e-3), (0.1, 0.2, 50.0)] {
        let (oscillator, model) = sprung(
            0.05,
            &format!(
                "excitation: AmplitudeRamp(frequency_hz: 6.5, from_g: {from:?}, to_g: {to:?}, \
                 over_s: {over:?}),
                 run: (duration_s: 6, tolerance: 1e-12)"
            ),
        );
        let g = STANDARD_GRAVITY;
        let w = TAU * 6.5;
        let ramp = [tone((from * g, (to - from) * g / over), 6.5, 0.0)];
        let flat = [tone((to * g, 0.0), 6.5, 0.0)];
        let start = (0.002, -0.1);
        let at_end = oscillator.nearest(start, 0.0, over, &ramp);
        let run = run_at(&model, &every(0.0311, 192));
        for s in &run.samples {
            let exact = if s.t < over {
                oscillator.nearest(start, 0.0, s.t, &ramp)
            } else {
                oscillator.nearest(at_end, over, s.t, &flat)
            };
            compare(&model, s, exact, 3e-12);
            let amplitude = if s.t < over { from + (to - from) * s.t / over } else { to };
            near(s.base_accel, amplitude * g * (w * s.t).sin(), 1e-11);
        }
        assert_eq!(run.samples.len(), 192);
    }
}

#[test]
fn sums_of_sines_superpose() {
    // 3 and 4.5 Hz have the common period 2/3 s; 3 and 3 sqrt 2 Hz have none: both in closed form, with a
    // constant and a ramp beside them.
    let root = 3.0 * std::f64::consts::SQRT_2;
    for (second, common) in [(4.5, Some(2.0 / 3.0)), (root, None)] {
        let (oscillator, model) = sprung(
            0.08,
            &format!(
                "excitation: Sum([
                    Sine(frequency_hz: 3, amplitude_g: 0.5), Constant(accel_g: 0.2),
                    Sum([Sine(frequency_hz: {second:?}, amplitude_g: -0.3, phase_deg: 200)]),
                 ]), run: (duration_s: 9, tolerance: 1e-12)"
            ),
        );
        match (model.forcing_period(), common) {
            (Some(period), Some(exact)) => near_relative(period, exact, 4e-16),
            (a, b) => assert_eq!(a, b),
        }
        let g = STANDARD_GRAVITY;
        let drives = [tone((0.5 * g, 0.0), 3.0, 0.0), tone((-0.3 * g, 0.0), second, 200.0)];
        let shift = -0.2 * g / (50.0 / 0.02);
        let run = run_at(&model, &every(0.0777, 115));
        for s in &run.samples {
            let (x, v) = oscillator.nearest((0.002 - shift, -0.1), 0.0, s.t, &drives);
            compare(&model, s, (x + shift, v), 3e-12);
        }
        assert_eq!(run.samples.len(), 115);
    }
}

#[test]
fn a_ripple_on_a_slow_drive_superposes() {
    // 1 g at 0.5 Hz with a thousandth of it at 500 Hz, on a spring of 7.96 Hz: in closed form, to 3e-12 of
    // the scales.
    let (oscillator, model) = sprung(
        0.08,
        "excitation: Sum([Sine(frequency_hz: 0.5, amplitude_g: 1), Sine(frequency_hz: 500, \
         amplitude_g: 0.001)]),
         run: (duration_s: 5, tolerance: 1e-12)",
    );
    let g = STANDARD_GRAVITY;
    let drives = [tone((g, 0.0), 0.5, 0.0), tone((0.001 * g, 0.0), 500.0, 0.0)];
    let run = run_at(&model, &every(0.0777, 64));
    for s in &run.samples {
        compare(&model, s, oscillator.nearest((0.002, -0.1), 0.0, s.t, &drives), 3e-12);
    }
    assert_eq!(run.samples.len(), 64);
}

#[test]
fn a_stop_is_met_just_above_the_grazing_amplitude() {
    // On the steady orbit of x'' + 2 z x' + x = A sin w t a stop at g is not met until A = g sqrt((1 - w^2)^2
    // + (2 z w)^2). A share d below it: no impact in 20 periods; d above: the first impact at (asin(g/X) +
    // phi)/w or half a period before, with speed w sqrt(X^2 - g^2), whose relative error is that of the orbit
    // over 2 d.
    let zeta = 0.05;
    for w in [0.7, 1.6] {
        let phi = f64::atan2(2.0 * zeta * w, 1.0 - w * w);
        let gain = (1.0 - w * w).hypot(2.0 * zeta * w);
        for share in [1e-2, 1e-5, 1e-8, 1e-10] {
            for above in [false, true] {
                let orbit = 1.0 + if above { share } else { -share };
                let (x0, v0) = (-orbit * phi.sin(), orbit * w * phi.cos());
                let model = model(&format!(
                    "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]),
                     damping: Coefficient(c_n_s_per_m: 0.1),
                     stops: Rigid(travel_limit_mm: 1000, restitution: 0.5),
                     excitation: Sine(frequency_hz: {:?}, amplitude_g: {:?}),
                     start: At(x_mm: {:?}, v_m_per_s: {v0:?}), run: (duration_s: {:?}, tolerance: 1e-12)",
                    w / TAU,
                    -orbit * gain / STANDARD_GRAVITY,
                    x0 * 1e3,
                    20.0 * TAU / w
                ));
                let impacts = of_kind(&run(&model), EventKind::Impact);
                if !above {
                    assert!(impacts.is_empty(), "w = {w}, {share:e} below");
                    continue;
                }
                let hit = ((1.0 / orbit).asin() + phi) / w;
                let speed = w * (share * (2.0 + share)).sqrt();
                let error = 1e-13 / share + 1e-12;
                assert!(!impacts.is_empty(), "w = {w}, {share:e} above");
                let (hit, sign) = if hit < PI / w { (hit, 1.0) } else { (hit - PI / w, -1.0) };
                assert_eq!(impacts[0].side, if sign > 0.0 { Side::Right } else { Side::Left });
                near_relative(impacts[0].v_in, sign * speed, error);
                near(impacts[0].t, hit, error * speed);
            }
        }
    }
}
