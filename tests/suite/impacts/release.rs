//! Releases of a mass at rest on a stop: their instants, and the motion just after them.

use std::f64::consts::TAU;

use interwell::dynamics::{EventKind, Model, Outcome, Request, Run, Sample};
use interwell::numeric::bisect;
use interwell::scene::{Excitation, Scene};
use proptest::prelude::*;

use super::scenes::*;
use crate::properties::mirror::{assert_mirrored, image};

fn releases(run: &Run) -> Vec<f64> {
    run.events.iter().filter(|e| e.kind == EventKind::Release).map(|e| e.t).collect()
}

/// A mass of 1 kg pressed with `press` m/s^2 on the right stop at 1 m; it rests there at first.
fn pressed(press: f64, drive: Excitation, duration: f64) -> Scene {
    let mut s = scene(polynomial(&[-press]), at(1000.0, 0.0), duration);
    s.stops = right_stop(1000.0, 0.36);
    s.excitation = drive;
    s
}

/// The first time at which base motion takes the press off a mass on the right stop, by a dense scan and
/// halving.
fn first_fall(m: &Model, press: f64, n: usize) -> Option<f64> {
    let net = |t: f64| press - m.base_acceleration(t);
    let times = dense(m.duration(), n);
    // samples of the base are those of the formula, bit for bit, and come faster
    let samples = m.run(&Request { sample_times: &times, ..Request::default() }).samples;
    assert_eq!(samples.len(), n + 1);
    let falls = |pair: &&[Sample]| pair[0].base_accel < press && pair[1].base_accel >= press;
    let [before, after] = samples.windows(2).find(falls)? else { unreachable!() };
    Some(bisect(before.t, after.t, 100, |t| net(t) > 0.0).1)
}

/// |F(D)|/m of the nominal cubic.
fn threshold(limit_mm: f64) -> f64 {
    let d = limit_mm * 1e-3;
    (40.0 * d - 40.0 / 49e-6 * d * d * d) / 0.0152
}

#[test]
fn a_sine_releases_where_the_closed_form_says_however_near_the_threshold() {
    for limit in [0.5, 2.0, 4.0, 6.5] {
        for over in [0.5, 1e-2, 1e-6, 1e-10] {
            let amplitude = threshold(limit) * (1.0 + over);
            let r = run(&nominal_scene(limit, 0.36, sine(3.0, amplitude, 0.0), 1.0));
            let angle = (1.0 / (1.0 + over)).asin();
            // conditioning: the angle moves by eps tan(angle) for a press that is off by eps
            let allowed = 1e-15 + 1e-15 * angle.tan();
            let t = releases(&r)[0];
            assert!(
                (t - angle / (3.0 * TAU)).abs() < allowed,
                "{limit} {over:e}: {t} {}",
                angle / (3.0 * TAU)
            );
            let r = run(&nominal_scene(limit, 0.36, sine(3.0, -amplitude, 0.0), 1.0));
            let late = (angle / TAU + 0.5) / 3.0;
            assert!((releases(&r)[0] - late).abs() < allowed);
        }
        for under in [1e-2, 1e-6, 1e-10] {
            let amplitude = threshold(limit) * (1.0 - under);
            let r = run(&nominal_scene(limit, 0.36, sine(3.0, amplitude, 0.0), 1.0));
            assert_eq!((releases(&r).len(), r.summary.rests), (0, 1));
            assert_eq!(r.summary.final_x, limit / 1e3);
        }
    }
}

#[test]
fn an_amplitude_exactly_at_the_threshold_stays_at_rest() {
    let s = pressed(1.0, sine(1.0, 1.0, 0.0), 20.0);
    let m = model(&s);
    assert_eq!(m.base_acceleration(0.25), 1.0); // the press touches 0 exactly
    let r = m.run(&full(&[]));
    assert_eq!((r.events.len(), r.summary.final_x), (1, 1.0), "{:?}", r.events);
    // an ulp above it is let go for some 1e-8 s a period and gets nowhere
    let Excitation::Sine { amplitude_g, .. } = s.excitation else { unreachable!() };
    let mut above = s.clone();
    above.excitation =
        Excitation::Sine { frequency_hz: 1.0, amplitude_g: amplitude_g * (1.0 + 1e-15), phase_deg: 0.0 };
    let m = model(&above);
    let r = m.run(&full(&dense(20.0, 2000)));
    assert_eq!(r.summary.outcome, Outcome::Done);
    assert!(r.samples.iter().all(|p| p.x <= 1.0 && p.x > 1.0 - 1e-15));
    assert!(r.summary.steps < 4000, "{}", r.summary.steps);
}

#[test]
fn just_after_a_release_the_gap_is_a_cube_of_time() {
    // x - D = y3 t^3 + y4 t^4 + .., y3 = -j/6, y4 = -(3 g y3 + a2)/12: the drive's rate first, then its
    // curvature and the damping
    let amplitude = 1.5 * 9.80665;
    let s = nominal_scene(4.0, 0.36, sine(3.0, amplitude, 0.0), 0.1);
    let m = model(&s);
    let released = releases(&m.run(&full(&[])))[0];
    let w = 3.0 * TAU;
    let (jerk, half_snap) =
        (w * amplitude * (w * released).cos(), -w * w * amplitude * (w * released).sin() / 2.0);
    let g = m.damping() / m.mass();
    let y3 = -jerk / 6.0;
    let y4 = -(3.0 * g * y3 + half_snap) / 12.0;
    for after in [3e-5, 1e-4, 3e-4] {
        let t = released + after;
        let r = m.run(&full(&[t]));
        let d = t - released;
        let expected = y3 * d.powi(3) + y4 * d.powi(4);
        let gap = r.samples[0].x - 4e-3;
        // what is left out, and the rounding of 4 mm
        let allowed = 1e3 * d * d * expected.abs() + 1e-18;
        assert!((gap - expected).abs() < allowed, "{after}: {gap:e} {expected:e}");
        let speed = 3.0 * y3 * d.powi(2) + 4.0 * y4 * d.powi(3);
        assert!((r.samples[0].v / speed - 1.0).abs() < 2e3 * d * d + 1e-9, "{after}");
    }
}

#[test]
fn the_release_is_the_next_one_whatever_the_phase() {
    let mut held = 0;
    for i in 0..180 {
        let phase = f64::from(i) * 2.0;
        for press in [0.1, 0.7, 0.999] {
            let s = pressed(press, sine(1.0, 1.0, phase), 3.0);
            let m = model(&s);
            if m.base_acceleration(0.0) >= press {
                continue; // is let go at once
            }
            let r = m.run(&full(&[]));
            let t = releases(&r)[0];
            held += 1;
            let scanned = first_fall(&m, press, 30_000).unwrap();
            assert!((t - scanned).abs() < 1e-14, "{phase} {press}: {t} {scanned}");
            assert_mirrored(&r, &run(&image(&s).unwrap()));
        }
    }
    assert!(held > 350, "{held} of 540");
}

#[test]
fn sums_release_where_a_scan_finds_the_first_fall() {
    let mut found = 0;
    for i in 0..40 {
        let f = f64::from(i) + 0.37; // never a sum whose crest only touches the press
        let parts = [
            vec![constant(-0.3 + 0.01 * f), sine(1.0, 1.0, 9.0 * f)],
            vec![sine(1.0, 0.6, 9.0 * f), sine(3.0, 0.55, 31.0 * f)],
            vec![sine(0.7, 0.6, 9.0 * f), sine(2f64.sqrt(), 0.55, 31.0 * f), constant(0.05)],
        ];
        for sum in parts {
            let press = 0.9;
            let s = pressed(press, Excitation::Sum(sum), 12.0);
            let m = model(&s);
            if m.base_acceleration(0.0) >= press {
                continue;
            }
            let r = m.run(&full(&[]));
            let (t, scanned) = (releases(&r).first().copied(), first_fall(&m, press, 60_000));
            assert_eq!(t.is_some(), scanned.is_some(), "{i}: {t:?} {scanned:?}");
            if let (Some(t), Some(scanned)) = (t, scanned) {
                let h = 1e-7;
                let slope = (m.base_acceleration(t + h) - m.base_acceleration(t - h)).abs() / (2.0 * h);
                assert!((t - scanned).abs() < 4e-15 / slope.min(1.0) + 4e-15, "{i}: {t} {scanned}");
                found += 1;
            }
        }
    }
    assert!(found > 60, "{found}");
}

#[test]
fn a_ramp_releases_during_it_only_after_it_or_never() {
    let ramp = |from: f64, to: f64, over_s: f64| Excitation::AmplitudeRamp {
        frequency_hz: 1.0,
        from_g: from / 9.80665,
        to_g: to / 9.80665,
        over_s,
    };
    // during: passes the press of 1 about half way
    let m = model(&pressed(1.0, ramp(0.0, 2.0, 10.0), 15.0));
    let t = releases(&m.run(&full(&[])))[0];
    assert!(t > 4.0 && t < 6.5 && (t - first_fall(&m, 1.0, 60_000).unwrap()).abs() < 1e-14, "{t}");
    // after: it ends at a quarter past a crest, the crest after it is the first to pass the press
    let m = model(&pressed(1.0, ramp(0.0, 1.01, 10.5), 15.0));
    let t = releases(&m.run(&full(&[])))[0];
    assert!(t > 11.0 && t < 11.25, "{t}");
    assert!((t - (11.0 + (1.0_f64 / 1.01).asin() / TAU)).abs() < 1e-14, "{t}");
    assert!((t - first_fall(&m, 1.0, 60_000).unwrap()).abs() < 1e-14, "{t}");
    // never: down from 1.1, the first crest of which is already below the press
    let m = model(&pressed(1.0, ramp(1.1, 0.0, 1.0), 30.0));
    assert!(first_fall(&m, 1.0, 60_000).is_none());
    let r = m.run(&full(&[]));
    assert_eq!((r.events.len(), r.summary.final_x, r.summary.outcome), (1, 1.0, Outcome::Done));
    // a second ramp that ends while the mass flies, and one longer than the run
    let both = Excitation::Sum(vec![ramp(0.0, 1.5, 3.1), ramp(0.0, 0.7, 100.0)]);
    let m = model(&pressed(1.0, both, 12.0));
    let r = m.run(&full(&[]));
    assert!((releases(&r)[0] - first_fall(&m, 1.0, 60_000).unwrap()).abs() < 1e-14);
    assert!(r.summary.ledger.unwrap().energy_residual < 1e-8);
}

#[test]
fn a_ramp_that_ends_in_flight_changes_nothing_but_the_slope() {
    // free mass: v and x follow from integrals of the ramped sine, exactly
    let (over, to, w) = (2.3, 1.0, TAU * 0.7);
    let mut s = scene(polynomial(&[0.0]), at(0.0, 0.0), 6.0);
    s.excitation =
        Excitation::AmplitudeRamp { frequency_hz: 0.7, from_g: 0.0, to_g: to / 9.80665, over_s: over };
    let m = model(&s);
    let r = m.run(&full(&[over, 6.0]));
    // integral of (s/over) sin(w s) and its integral
    let v_ramp = |t: f64| (to / over) * ((w * t).sin() / (w * w) - t * (w * t).cos() / w);
    let x_ramp =
        |t: f64| (to / over) * ((2.0 - 2.0 * (w * t).cos()) / w.powi(3) - t * (w * t).sin() / (w * w));
    assert!((r.samples[0].v + v_ramp(over)).abs() < 1e-12 && (r.samples[0].x + x_ramp(over)).abs() < 1e-12);
    let d = 6.0 - over;
    let v = -v_ramp(over) + to * ((w * 6.0).cos() - (w * over).cos()) / w;
    let x = -x_ramp(over) - v_ramp(over) * d + to * ((w * 6.0).sin() - (w * over).sin()) / (w * w)
        - to * (w * over).cos() * d / w;
    assert!(
        (r.summary.final_v - v).abs() < 1e-12 && (r.summary.final_x - x).abs() < 1e-12,
        "{:?}",
        r.summary
    );
}

#[test]
fn a_release_far_out_in_time_is_as_exact_as_the_first() {
    // an amplitude that creeps over the threshold of an everyday scene after 1e6 s
    let drive =
        Excitation::AmplitudeRamp { frequency_hz: 1.0, from_g: 0.0, to_g: 2.0 / 9.80665, over_s: 2e5 };
    let m = model(&pressed(1.0, drive, 1.1e5));
    let t = releases(&m.run(&full(&[])))[0];
    // amplitude 1e-5 t reaches 1 in the crest at 100 000.25 s: falls just before that crest
    assert!(t > 100_000.2 && t < 100_000.25, "{t}");
    assert!((m.base_acceleration(t) - 1.0).abs() < 1e-12, "{:e}", m.base_acceleration(t) - 1.0);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(60) })]

    #[test]
    fn three_tones_release_where_a_scan_finds_it(
        tones in prop::collection::vec((1..30u32, 0.1..0.6f64, 0..8u32), 3),
        press in 0.3..1.2f64,
    ) {
        let tone = |(f, a, p): &(u32, f64, u32)| sine(f64::from(*f) * 0.1, *a, f64::from(*p) * 45.0);
        let parts = tones.iter().map(tone).collect();
        let m = model(&pressed(press, Excitation::Sum(parts), 12.0));
        prop_assume!(m.base_acceleration(0.0) < press - 1e-3);
        let t = releases(&m.run(&full(&[]))).first().copied();
        let scanned = first_fall(&m, press, 60_000);
        // a scan may miss two falls within 0.2 ms
        prop_assert!(t.is_some() || scanned.is_none());
        if let Some(t) = t {
            prop_assert!((m.base_acceleration(t) - press).abs() < 1e-13);
            prop_assert!(scanned.is_none_or(|s| t < s + 1e-9), "{} {:?}", t, scanned);
        }
    }
}
