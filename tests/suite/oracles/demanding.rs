//! Hard exact answers: long steps, a drive far faster than the mass, a clock without a drive.

use std::f64::consts::TAU;

use interwell::dynamics::{EventKind, STANDARD_GRAVITY};

use crate::support::*;

#[test]
fn the_ledger_closes_on_long_steps_too() {
    // Residual within the tolerance at every tolerance: the products of the step's polynomials are integrated
    // whole.
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-14] {
        let spring = model(&format!(
            "mass_g: 20, mechanism: Polynomial(coefficients_si: [0, 50]), \
             damping: Coefficient(c_n_s_per_m: 0.6),
             excitation: Sine(frequency_hz: 5, amplitude_g: 0.7), start: At(x_mm: 2, v_m_per_s: -0.1),
             run: (duration_s: 6, settle_s: 3, tolerance: {tolerance:?})"
        ));
        let sum = preset(
            "nominal-cubic",
            &[
                "excitation=Sum([Constant(accel_g: 0.3), Sine(frequency_hz: 3, amplitude_g: 1.5), \
                 Sine(frequency_hz: 40, amplitude_g: 1)])",
                &format!("run.tolerance={tolerance:?}"),
            ],
        );
        for (name, model) in [("spring", spring), ("sum", sum)] {
            let residual = run(&model).summary.ledger.unwrap().energy_residual;
            assert!(residual <= tolerance + 1e-14, "{name} at {tolerance:e}: {residual:e}");
        }
    }
}

#[test]
fn the_ledger_closes_under_a_fast_drive() {
    // A drive 1e4 times faster than the spring.
    let w: f64 = 1e4;
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
        let model = model(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]),
             excitation: Sine(frequency_hz: {:?}, amplitude_g: {:?}), start: At(x_mm: 0, v_m_per_s: 0),
             run: (duration_s: 10, tolerance: {tolerance:?})",
            w / TAU,
            w / STANDARD_GRAVITY
        ));
        let residual = run(&model).summary.ledger.unwrap().energy_residual;
        assert!(residual <= tolerance, "at {tolerance:e}: {residual:e}");
    }
}

#[test]
fn the_length_scale_under_a_fast_drive_is_that_of_the_motion() {
    // The same scene moves by some 1 m; its error is the tolerance of that, some hundredfold for 16 000
    // cycles: the length scale is that of the motion, not the drive over the spring, 1e4 m.
    let w: f64 = 1e4;
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let model = model(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]),
             excitation: Sine(frequency_hz: {:?}, amplitude_g: {:?}), start: At(x_mm: 0, v_m_per_s: 0),
             run: (duration_s: 10, tolerance: {tolerance:?})",
            w / TAU,
            w / STANDARD_GRAVITY
        ));
        let exact = w / (w * w - 1.0) * ((w * 10.0).sin() - w * 10f64.sin());
        near(run(&model).summary.final_x, exact, 100.0 * tolerance + 1e-10);
    }
}

#[test]
fn a_million_flights_take_exactly_their_time() {
    // The elastic box: n-th impact at 0.2 + 0.4 n s to 1e-14 of it: the clock without a drive is as fine.
    let run = run(&preset("elastic-box", &["run.duration_s=400000.1"]));
    let impacts = of_kind(&run, EventKind::Impact);
    assert_eq!(impacts.len(), 1_000_000);
    for (n, impact) in impacts.iter().enumerate() {
        near_relative(impact.t, 0.2 + 0.4 * n as f64, 1e-14);
    }
}
