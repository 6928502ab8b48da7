//! Samples at events, and counts of the settled window.

use interwell::dynamics::{Event, EventKind, Phase, Run};

use super::scenes::*;

fn p2() -> interwell::scene::Scene {
    nominal_scene(4.0, 0.36, sine(3.0, 1.5 * 9.80665, 0.0), 10.0)
}

#[test]
fn a_sample_at_an_events_instant_is_the_state_after_it() {
    let s = p2();
    let m = model(&s);
    let events = m.run(&full(&[])).events;
    // the last impact before a closed-form sum: its rebound is not resolved any more
    let unresolved = 1e-6 * m.scales().speed;
    let times: Vec<f64> = events.iter().map(|e| e.t).collect();
    let r = m.run(&full(&times));
    assert_eq!(r.samples.len(), times.len());
    let mut seen = [0; 4];
    for (e, p) in events.iter().zip(&r.samples) {
        assert_eq!(e.t, p.t);
        let sign = if e.side == interwell::dynamics::Side::Left { -1.0 } else { 1.0 };
        match e.kind {
            EventKind::Impact => {
                // the time in s is rounded to an ulp: so far the mass may have gone, at some 10 m/s^2
                let late = 2.0 * f64::EPSILON * e.t;
                let gone = e.v_out.abs() * late + 1e-18;
                assert!(
                    sign * p.x <= 4e-3 && sign * p.x >= 4e-3 - gone && p.phase == Phase::Free,
                    "{e:?} {p:?}"
                );
                let summed = e.v_out.abs() < unresolved && p.v == 0.0;
                assert!(summed || (p.v - e.v_out).abs() <= 30.0 * late, "{e:?} {p:?}");
            }
            EventKind::Rest => {
                assert!(p.x == sign * 4e-3 && p.v == 0.0 && p.phase != Phase::Free, "{e:?} {p:?}");
            }
            EventKind::Release => {
                assert!(p.x == sign * 4e-3 && p.v.abs() < 1e-25 && p.phase == Phase::Free, "{e:?} {p:?}");
            }
            EventKind::Contact | EventKind::Separate => panic!("these stops are rigid: {e:?}"),
            EventKind::Crossing => {
                let late = 4.0 * f64::EPSILON * e.t;
                assert!(p.x.abs() <= e.v_out.abs() * late + 1e-17, "{e:?} {p:?}");
                assert!((p.v - e.v_out).abs() <= 30.0 * late, "{e:?} {p:?}");
            }
        }
        seen[e.kind as usize] += 1;
    }
    assert!(seen.iter().all(|n| *n >= 50), "{seen:?}");
}

#[test]
fn samples_at_0_during_rests_and_at_the_end() {
    let s = p2();
    let m = model(&s);
    let times = dense(10.0, 5000);
    let r = m.run(&full(&times));
    assert_eq!(r.samples.len(), times.len());
    let (first, last) = (r.samples[0], r.samples.last().unwrap());
    assert_eq!((first.t, first.x, first.v, first.phase), (0.0, 4e-3, 0.0, Phase::RightStop));
    assert_eq!((last.t, last.x, last.v), (10.0, r.summary.final_x, r.summary.final_v));
    for p in &r.samples {
        assert_eq!(p.base_accel, m.base_acceleration(p.t));
        let last = r.events.iter().rfind(|e| e.t <= p.t).unwrap();
        assert_eq!(p.phase != Phase::Free, last.kind == EventKind::Rest, "{p:?} {last:?}");
        assert!(p.x.abs() <= 4e-3);
    }
}

/// Counts over [settle, settle + n T) from the list of events, with the share of the time at rest. Impacts
/// count from a speed on.
fn counted(r: &Run, least: f64, from: f64, to: f64) -> (u64, u64, u64, f64) {
    let counts = |e: &&Event| e.kind != EventKind::Impact || e.v_in.abs() > least;
    let inside = |e: &&Event| e.t >= from && e.t < to;
    let within =
        |kind| r.events.iter().filter(|e| e.kind == kind).filter(counts).filter(inside).count() as u64;
    let mut rested = 0.0;
    let mut since: Option<f64> = None;
    for e in &r.events {
        match e.kind {
            EventKind::Rest => since = Some(e.t),
            EventKind::Release => rested += (e.t.min(to) - since.take().unwrap().max(from)).max(0.0),
            _ => {}
        }
    }
    rested += since.map_or(0.0, |t| (to - t.max(from)).max(0.0));
    (within(EventKind::Impact), within(EventKind::Crossing), within(EventKind::Release), rested / (to - from))
}

#[test]
fn the_windows_counts_are_those_of_the_events() {
    for (settle, n) in [(0.0, 30.0), (5.0, 15.0), (4.321, 17.0), (9.9, 0.0)] {
        let mut s = p2();
        s.run.settle_s = Some(settle);
        let r = run(&s);
        let to = if n > 0.0 { settle + n / 3.0 } else { 10.0 };
        let least = 1e-6 * model(&s).scales().speed;
        let (impacts, crossings, releases, rested) = counted(&r, least, settle, to);
        let u = &r.summary;
        assert_eq!((u.impacts, u.crossings, u.releases), (impacts, crossings, releases), "{settle}");
        assert!((u.rested_share.unwrap() - rested).abs() < 1e-12, "{settle}: {:?} {rested}", u.rested_share);
    }
}

#[test]
fn the_rms_of_the_window_is_that_of_the_samples() {
    let mut s = p2();
    s.run.settle_s = Some(4.321);
    let m = model(&s);
    // midpoints of 2e5 intervals over 17 periods
    let (from, n) = (4.321, 200_000);
    let step = 17.0 / 3.0 / f64::from(n);
    let times: Vec<f64> = (0..n).map(|i| from + (f64::from(i) + 0.5) * step).collect();
    let r = m.run(&full(&times));
    let mean = r.samples.iter().map(|p| p.v * p.v).sum::<f64>() / f64::from(n);
    let highest = r.samples.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
    // each impact leaves an error of a step
    assert!((r.summary.rms_velocity.unwrap() / mean.sqrt() - 1.0).abs() < 2e-4);
    assert!(r.summary.max_abs_x.unwrap() >= highest && highest <= 4e-3);
}
