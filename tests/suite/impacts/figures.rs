//! Statistics and scales of scenes at the edge of what the rules foresee.

use interwell::scene::{Damping, Mechanism};

use super::scenes::*;

#[test]
fn a_stiffness_that_is_nearly_0_does_not_loosen_the_tolerance() {
    // Cubic(0, 1) from 0.1 mm: stiffness 3e-8 at the start makes the length scale 3e7 m
    for (x, linear) in [(0.1, 0.0), (0.0, 1e-6)] {
        let mut s = scene(Mechanism::Cubic { linear_n_per_m: linear, cubic_n_per_m3: 1.0 }, at(x, 0.0), 20.0);
        s.excitation = sine(0.2, 1.0, 0.0);
        s.run.tolerance = 1e-6;
        let m = model(&s);
        let truth = m.run_reference(&full(&[]), 1e-26).summary.final_x;
        let error = (m.run(&full(&[])).summary.final_x - truth).abs();
        assert!(error < 1e-5, "{error:e}, {:?}", m.scales());
    }
}

#[test]
fn the_ledger_and_the_rms_close_to_the_tolerance_where_the_force_is_linear_or_flat() {
    // integrals of v^2 and a v are truncated at the order of the step, and a[known - 2] is not there
    for tolerance in [1e-6, 1e-9, 1e-12] {
        for c in [vec![0.0], vec![0.0, 1.0]] {
            let mut s = scene(polynomial(&c), at(0.0, 0.5), 20.0);
            s.excitation = sine(0.31, 1.0, 20.0);
            s.run.tolerance = tolerance;
            let m = model(&s);
            let (r, truth) = (m.run(&full(&[])), m.run_reference(&full(&[]), 1e-27));
            let rms = r.summary.rms_velocity.unwrap() / truth.summary.rms_velocity.unwrap() - 1.0;
            let l = r.summary.ledger.unwrap();
            assert!(
                rms.abs() < 2.0 * tolerance && l.energy_residual < 2.0 * tolerance,
                "{tolerance:e} {rms:e} {l:?}"
            );
        }
    }
}

#[test]
fn the_integral_of_a_square_is_not_negative() {
    let mut s =
        scene(polynomial(&[0.0, 1.1126877824111103]), at(-1.051729950634941, -1.6165654554981226), 10.0);
    s.damping = Damping::Coefficient { c_n_s_per_m: 0.27184597834070096 };
    s.stops = rigid(1.051729950634941, 0.0);
    s.excitation = sine(0.05, 0.0, 0.0);
    s.run.settle_s = Some(2.5);
    s.run.tolerance = 1e-3;
    let u = run(&s).summary;
    assert!(u.ledger.unwrap().damping_j >= 0.0 && u.rms_velocity.unwrap() > 0.0, "{u:?}");
}
