//! Constant force: bouncing balls to rest, and free fall.

use interwell::dynamics::{EventKind, Phase, STANDARD_GRAVITY, Side};

use interwell::numeric::Scalar;
use interwell_studies::study::accuracy::exact::{first_hit, impact_time, rest_time};

use crate::support::*;

#[test]
fn a_dropped_ball_bounces_by_a_geometric_series_and_rests_at_its_sum() {
    // Drop from 1 m, g = 9.81: first hit at sqrt(2/g), n-th impact by the geometric series, rest at
    // t1 (1 + e)/(1 - e); speed of the n-th impact e^(n-1) sqrt(2 g).
    let first = (2.0 / 9.81f64).sqrt();
    near(first, 0.451523641, 5e-10);
    for (restitution, duration) in
        [(0.0, 5.0), (0.36, 5.0), (0.5, 5.0), (0.8, 5.0), (0.9, 10.0), (0.99, 100.0), (0.999, 1000.0)]
    {
        let e: f64 = restitution;
        let model = preset(
            "bouncing-ball",
            &[
                &format!("stops.restitution_left={e:?}"),
                &format!("run.duration_s={duration:?}"),
                "run.tolerance=1e-12",
            ],
        );
        let run = run_at(&model, &[duration]);
        let impacts = of_kind(&run, EventKind::Impact);
        let speed = (2.0 * 9.81f64).sqrt();
        // every impact above 1e-6 of the speed scale is listed
        let located =
            if e == 0.0 { 1 } else { ((1e-6 * model.scales().speed / speed).ln() / e.ln()) as usize };
        assert!(impacts.len() >= located, "{} of {located} at e = {e}", impacts.len());
        let mut sum = 0.0;
        let mut power = 1.0;
        for impact in &impacts {
            near_relative(impact.t, first * (1.0 + 2.0 * sum), 1e-13);
            near_relative(impact.v_in, -speed * power, 1e-12);
            power *= e;
            sum += power;
            assert_eq!(impact.side, Side::Left);
        }
        let rests = of_kind(&run, EventKind::Rest);
        assert_eq!(rests.len(), 1, "at e = {e}");
        near_relative(rests[0].t, first * (1.0 + e) / (1.0 - e), 1e-13);
        assert_eq!((run.summary.final_x, run.summary.final_v), (-1.0, 0.0));
        assert_eq!(run.samples[0].phase, Phase::LeftStop);
        assert!(of_kind(&run, EventKind::Release).is_empty());
        // all of the drop's energy, m g h, goes into impacts
        near_relative(run.summary.ledger.unwrap().impact_j, 9.81, 1e-13);
    }
}

#[test]
fn the_ball_of_ballode() {
    // MATLAB's ballode: thrown up from the floor with 20 m/s, g = 9.8, e = 0.9: hits at (2 v0/g)(1 - e^n)/(1
    // - e), rest at (2 v0/g)/(1 - e) = 40.816327 s. The throw itself is no event.
    let model = model(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [9.8]),
         stops: Uneven(left_mm: 1, restitution_left: 0.9), start: At(x_mm: -1, v_m_per_s: 20),
         run: (duration_s: 50, tolerance: 1e-12)",
    );
    let run = run(&model);
    let flight = 2.0 * 20.0 / 9.8;
    let impacts = of_kind(&run, EventKind::Impact);
    assert!(impacts.len() > 100, "{}", impacts.len());
    for (n, impact) in impacts.iter().enumerate() {
        let power = 0.9f64.powi(n as i32 + 1);
        near_relative(impact.t, flight * (1.0 - power) / 0.1, 2e-14);
        near_relative(impact.v_in, -20.0 * power / 0.9, 1e-12);
    }
    assert_eq!(run.summary.total_impacts, impacts.len() as u64);
    let rest = of_kind(&run, EventKind::Rest)[0].t;
    near(rest, 40.816327, 5e-7);
    near_relative(rest, flight / 0.1, 1e-14);
}

#[test]
fn a_ball_on_a_base_that_accelerates_is_the_same_ball() {
    // A force of m g and a base acceleration of g are one and the same in x'' = -F/m - a_b: impact times of
    // the series, to rounding.
    let model = model(
        "mass_g: 250, mechanism: Polynomial(coefficients_si: [0]),
         stops: Uneven(left_mm: 1000, restitution_left: 0.8), excitation: Constant(accel_g: 1),
         start: At(x_mm: 0, v_m_per_s: 0), run: (duration_s: 5, tolerance: 1e-12)",
    );
    let run = run(&model);
    let first = first_hit(1.0, STANDARD_GRAVITY);
    let impacts = of_kind(&run, EventKind::Impact);
    assert!(impacts.len() > 50, "{}", impacts.len());
    for (n, impact) in impacts.iter().enumerate() {
        near_relative(impact.t, impact_time(first, 0.8, n as u32 + 1).to_f64(), 1e-13);
    }
    near_relative(of_kind(&run, EventKind::Rest)[0].t, rest_time(first, 0.8).to_f64(), 1e-13);
    // here the base does the work, m g h, and the impacts take it
    let ledger = run.summary.ledger.unwrap();
    near_relative(ledger.work_j, 0.25 * STANDARD_GRAVITY, 1e-13);
    near_relative(ledger.impact_j, 0.25 * STANDARD_GRAVITY, 1e-13);
    assert_eq!(ledger.stored_j, 0.0);
}

#[test]
fn constant_base_acceleration_in_closed_form() {
    // Free mass: x = x0 + v0 t - a t^2/2; several constants add. With damping: v relaxes to -a/g, g = c/m.
    let free = model(
        "mass_g: 20, mechanism: Polynomial(coefficients_si: [0]),
         excitation: Sum([Constant(accel_g: 0.25), Constant(accel_g: -0.125)]),
         start: At(x_mm: 3, v_m_per_s: 0.5), run: (duration_s: 8, tolerance: 1e-12)",
    );
    let a = 0.125 * STANDARD_GRAVITY;
    for s in run_at(&free, &every(0.7, 11)).samples {
        near(s.x, 0.003 + 0.5 * s.t - 0.5 * a * s.t * s.t, 1e-15 * a * s.t * s.t);
        near(s.v, 0.5 - a * s.t, 1e-15 * a * s.t);
        assert_eq!(s.base_accel, a);
    }
    let drag = model(
        "mass_g: 20, mechanism: Polynomial(coefficients_si: [0]), damping: Coefficient(c_n_s_per_m: 0.03),
         excitation: Constant(accel_g: 0.125), start: At(x_mm: 3, v_m_per_s: 0.5),
         run: (duration_s: 8, tolerance: 1e-12)",
    );
    let g = 0.03 / 0.02;
    for s in run_at(&drag, &every(0.7, 11)).samples {
        let decay = -(-g * s.t).exp_m1() / g;
        near(s.v, -a / g + (0.5 + a / g) * (-g * s.t).exp(), 2e-13);
        near(s.x, 0.003 - a / g * s.t + (0.5 + a / g) * decay, 1e-12);
    }
}
