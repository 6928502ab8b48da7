//! One impact without any other force: contact time, rebound, depth, force and loss against closed forms.

use interwell::dynamics::Request;
use interwell::numeric::bisect;

use super::*;

/// (4/5) B(2/5, 1/2), the contact time over depth/speed without loss, by quadrature-free gamma functions.
const HERTZ_TIME: f64 = 2.943_275_184_324_704_7;

/// ln((1 + p)/(1 - p e)) - p (1 + e), whose root e in (0, 1) is the restitution at p = loss times speed; by
/// halving.
fn restitution(p: f64) -> f64 {
    // atanh forms keep digits where p is small: ln((1 + p)/(1 - p e)) = ln1p(p) - ln1p(-p e)
    let excess = |e: f64| p.ln_1p() - (-p * e).ln_1p() - p * (1.0 + e);
    let (low, high) = bisect(1e-12, (1.0 / p).min(1.0), 200, |e| excess(e) <= 0.0);
    0.5 * (low + high)
}

#[test]
fn an_elastic_contact_has_the_time_depth_and_force_of_hertz() {
    for speed in [1e-4, 0.01, 0.5, 30.0] {
        let model = flight(speed, 0.0, 1e-12);
        let run = run(&model);
        let (touch, leave, v_in, v_out) = contact(&run);
        let mass = model.mass();
        let depth = (1.25 * mass * speed * speed / STIFFNESS).powf(0.4);
        near_relative(leave - touch, HERTZ_TIME * depth / speed, 1e-9);
        near_relative(touch, 1e-3 / speed, 1e-14);
        assert_eq!(v_in, speed);
        near_relative(-v_out, speed, 1e-9);
        near_relative(run.summary.max_abs_x.unwrap() - 1e-3, depth, 1e-9);
        near_relative(run.summary.peak_contact_force.unwrap(), STIFFNESS * depth.powf(1.5), 1e-9);
        assert_eq!(run.summary.total_impacts, 1);
        near(run.summary.ledger.unwrap().energy_residual, 0.0, 1e-12);
        // the share of the run in contact
        let share = (leave - touch) / model.duration();
        near_relative(run.summary.rested_share.unwrap(), share, 1e-9);
    }
}

#[test]
fn rebound_and_time_with_loss_are_those_of_hunt_and_crossley() {
    let speed = 0.5;
    for p in [0.02, 0.5, 2.427, 12.0, 200.0] {
        let model = flight(speed, p / speed, 1e-12);
        let run = run(&model);
        let (touch, leave, _, v_out) = contact(&run);
        let e = restitution(p);
        near_relative(-v_out / speed, e, 1e-9 * (1.0 + 1e-2 / p));
        let stop = model.compliant().unwrap();
        near_relative(stop.restitution(speed), e, 1e-11 / p.min(1.0));
        near_relative(leave - touch, stop.contact_time(model.mass(), speed), 1e-9);
        near_relative(run.summary.max_abs_x.unwrap() - 1e-3, stop.depth(model.mass(), speed), 1e-9);
        near_relative(run.summary.peak_contact_force.unwrap(), stop.peak_force(model.mass(), speed), 1e-9);
        // the ledger holds what the stop took
        let ledger = run.summary.ledger.unwrap();
        let taken = 0.5 * model.mass() * speed * speed * (1.0 - (v_out / speed).powi(2));
        near_relative(ledger.impact_j, taken, 1e-11);
        near(ledger.energy_residual, 0.0, 1e-12);
    }
    near(restitution(2.427), 0.36, 1e-4);
}

#[test]
fn the_order_holds_at_touch_down_and_every_tolerance_is_kept() {
    // d^1.5 has no series in time at either end of the contact: a method that ignores that loses its order,
    // and six more digits would cost it a hundred times the steps.
    let exact =
        flight(0.5, 4.854, 1e-12).run_reference(&Request { events: true, ..Request::default() }, 1e-28);
    let (touch, leave, _, v_out) = contact(&exact);
    let mut steps = Vec::new();
    for (tolerance, allowed) in [(1e-3, 1e-3), (1e-6, 1e-6), (1e-9, 1e-9), (1e-12, 1e-12), (1e-14, 4e-14)] {
        let run = run(&flight(0.5, 4.854, tolerance));
        let (begin, end, _, rebound) = contact(&run);
        near_relative(rebound, v_out, allowed);
        near_relative(end - begin, leave - touch, 10.0 * allowed);
        steps.push(run.summary.steps);
    }
    assert!(steps.windows(2).all(|pair| pair[0] <= pair[1]), "{steps:?}");
    assert!(steps[3] <= 2 * steps[1] && steps[4] < 40, "{steps:?}");
}

#[test]
fn free_flight_is_not_slowed_by_a_contact_a_thousand_times_shorter() {
    let swing =
        ["run.duration_s=0.3", "run.settle_s=0", "start=At(x_mm: 9, v_m_per_s: 0)", "excitation=None"];
    let open = run(&preset("nominal-cubic", &[&["stops=None"][..], &swing].concat()));
    let far = "stops=Hertz(travel_limit_mm: 12, stiffness_n_per_m1_5: 3.7e9, loss_s_per_m: 0)";
    let never = run(&preset("nominal-cubic", &[&[far][..], &swing].concat()));
    assert_eq!(open.summary.steps, never.summary.steps);
    let state = |run: &Run| (run.summary.final_x, run.summary.final_v);
    assert_eq!(state(&open), state(&never));
    assert_eq!(never.summary.peak_contact_force, Some(0.0));
    // and where it strikes: two flights and a contact
    let one = run(&flight(0.5, 4.854, 1e-9)).summary.steps;
    assert!(one < 25, "one contact and two flights in {one} steps");
}
