//! Impacts that accumulate: the sum, the rest, the chatter that does not finish.

use interwell::dynamics::{EventKind, Outcome, Run};
use interwell::scene::{Damping, Excitation};

use super::scenes::*;
use crate::properties::sound::assert_sound;
use crate::support::of_kind;

fn times(run: &Run, kind: EventKind) -> Vec<f64> {
    run.events.iter().filter(|e| e.kind == kind).map(|e| e.t).collect()
}

#[test]
fn the_bouncing_ball_rests_at_the_sum_of_its_flights() {
    let fall = (2.0_f64 / 9.81).sqrt();
    for restitution in [0.0, 0.36, 0.5, 0.8, 0.9, 0.99, 0.999] {
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-14] {
            let rest = fall * (1.0 + restitution) / (1.0 - restitution);
            let mut s = scene(polynomial(&[9.81]), at(0.0, 0.0), rest * 1.1);
            s.stops = left_stop(1000.0, restitution);
            s.run.tolerance = tolerance;
            let r = run(&s);
            let rests = times(&r, EventKind::Rest);
            assert_eq!(rests.len(), 1);
            // each flight adds a rounding of the clock
            let n = times(&r, EventKind::Impact).len() as f64;
            assert!((rests[0] / rest - 1.0).abs() < 2e-15 + 2e-16 * n, "{restitution} {}", rests[0] / rest);
            assert_eq!(r.summary.final_x, -1.0);
        }
    }
}

#[test]
fn a_chatter_on_a_curve_rests_when_the_reference_does() {
    // thrown from the stop at 4 mm inward: the force changes along each flight, damping acts
    for restitution in [0.36, 0.9, 0.99] {
        let mut s = nominal_scene(4.0, restitution, sine(3.0, 1.0, 30.0), 1.5);
        s.start = at(4.0, -0.1);
        s.damping = Damping::Ratio(0.05);
        s.run.tolerance = 1e-12;
        let truth = model(&s).run_reference(&full(&[]), 1e-27);
        let rest = times(&truth, EventKind::Rest)[0];
        let speed = model(&s).scales().speed;
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-14] {
            s.run.tolerance = tolerance;
            let r = run(&s);
            let error = (times(&r, EventKind::Rest)[0] - rest).abs();
            // an error of speed v in the first flights is one of 2 v/(a (1 - e)) in the end
            let allowed = 1e-15 / (1.0 - restitution) + tolerance * speed / (12.0 * (1.0 - restitution));
            assert!(error <= allowed, "{restitution} {tolerance:e}: {error:e} of {allowed:e}");
            let listed = [&r, &truth].map(|run| times(run, EventKind::Impact).len());
            assert!(r.summary.chatter_sums == 1 && listed[0] < listed[1]);
            // what is counted does not depend on where the sum begins
            assert_eq!(r.summary.total_impacts, truth.summary.total_impacts);
        }
    }
}

#[test]
fn elastic_impacts_keep_the_energy() {
    let mut s = scene(polynomial(&[0.0, -1.0, 0.0, 1.0]), at(0.0, 1.0), 2000.0);
    s.stops = rigid(700.0, 1.0);
    s.run.tolerance = 1e-14;
    let m = model(&s);
    let r = m.run(&full(&[]));
    assert!(r.summary.total_impacts > 1500 && r.summary.chatter_sums == 0, "{:?}", r.summary);
    let x = r.summary.final_x;
    let energy = 0.5 * r.summary.final_v.powi(2) + x.powi(4) / 4.0 - x * x / 2.0;
    // a tenth of the tolerance a step, at the very most
    let allowed = r.summary.steps as f64 * 1e-15;
    assert!((energy - 0.5).abs() < allowed, "{:e} of {allowed:e}", energy - 0.5);
    assert_eq!(r.summary.ledger.unwrap().impact_j, 0.0);
}

#[test]
fn an_elastic_chatter_under_damping_ends_by_the_impact_budget() {
    for restitution in [1.0, 0.999_999_999] {
        let mut s = nominal_scene(4.0, restitution, Excitation::None, 1e6);
        s.start = at(0.0, 0.3);
        s.run.tolerance = 1e-9;
        let m = model(&s);
        let r = m.run(&interwell::dynamics::Request { ledger: true, ..Default::default() });
        let Outcome::ImpactBudget { at, count } = r.summary.outcome else { panic!("{:?}", r.summary) };
        assert!(
            count >= 2_000_000 && count >= r.summary.total_impacts && at > 1.0 && at < 100.0,
            "{at} {count}"
        );
        assert!(r.summary.final_x.abs() <= 4e-3 && r.summary.final_v.abs() < 1e-3, "{:?}", r.summary);
        assert!(r.summary.ledger.unwrap().energy_residual < 1e-8);
    }
}

#[test]
fn restitution_nearly_1_is_summed_once_the_sum_is_short() {
    // 1 - e = 1e-4: about 1.4e5 impacts before the rest of 2 v/(a (1 - e)) is short enough
    let mut s = scene(polynomial(&[1.0]), at(-1000.0, 0.01), 1e3);
    s.stops = left_stop(1000.0, 0.9999);
    let r = run(&s);
    let rest = times(&r, EventKind::Rest);
    assert!((rest[0] / 200.0 - 1.0).abs() < 1e-9, "{:?}", rest);
    assert!(r.summary.total_impacts < 200_000 && r.summary.chatter_sums == 1);
}

#[test]
fn plastic_impacts_under_a_sine_rest_and_release_every_half_period() {
    let s = nominal_scene(2.0, 0.0, sine(3.0, 1.2 * 9.80665, 0.0), 10.0);
    let m = model(&s);
    let r = m.run(&full(&dense(10.0, 5000)));
    assert_sound(&s, &m, &r, 1e3);
    let impacts = times(&r, EventKind::Impact);
    let rests = times(&r, EventKind::Rest);
    assert!(impacts.len() >= 58 && r.summary.chatter_sums == 0);
    assert!(of_kind(&r, EventKind::Impact).iter().all(|e| e.v_out == 0.0));
    // pressed, all but those beside a change of the press rest where they struck
    let at_once = impacts.iter().filter(|t| rests.contains(t)).count();
    assert!(at_once >= 58, "{at_once} of {}", impacts.len());
    // periodic from the first period on: a release repeats after 1/3 s
    let releases = times(&r, EventKind::Release);
    assert!(releases.len() >= 58, "{}", releases.len());
    for pair in releases.windows(3) {
        assert!((pair[2] - pair[0] - 1.0 / 3.0).abs() < 1e-14, "{pair:?}");
    }
}

#[test]
fn an_incomplete_chatter_leaves_where_the_press_changes_sign() {
    // constant press 1 m/s^2 under a sine of 1.2 m/s^2: the press vanishes for part of each period; at
    // e = 0.9 bounces from just before do not come to rest
    let mut s = scene(polynomial(&[-1.0]), at(1000.0, -0.02), 3.0);
    s.stops = right_stop(1000.0, 0.9);
    s.excitation = sine(1.0, 1.2, 0.0);
    s.run.tolerance = 1e-12;
    let truth = model(&s).run_reference(&full(&[]), 1e-27);
    let first_fall = (1.0_f64 / 1.2).asin() / std::f64::consts::TAU;
    let rest = times(&truth, EventKind::Rest);
    assert!(rest.first().is_none_or(|t| *t > 0.5), "{rest:?}");
    let before = times(&truth, EventKind::Impact).iter().filter(|t| **t < first_fall).count();
    assert!(before >= 1, "{:?}", truth.events);
    let early = |r: &Run| -> Vec<_> { r.events.iter().filter(|e| e.t < 1.0).copied().collect() };
    for (tolerance, allowed) in [(1e-6, 1e-6), (1e-9, 1e-9), (1e-12, 1e-12)] {
        s.run.tolerance = tolerance;
        let r = run(&s);
        let (a, b) = (early(&r), early(&truth));
        assert_eq!(a.len(), b.len(), "{a:?} {b:?}");
        for (p, q) in a.iter().zip(&b) {
            assert_eq!((p.kind, p.side), (q.kind, q.side));
            assert!((p.t - q.t).abs() < 10.0 * allowed, "{tolerance:e} {p:?} {q:?}");
            assert!((p.v_in - q.v_in).abs() < 100.0 * allowed, "{tolerance:e} {p:?} {q:?}");
        }
    }
}
