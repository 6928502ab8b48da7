//! The forced double well: published periods, Melnikov's amplitude, contraction of the period map.

use std::f64::consts::{PI, SQRT_2, TAU};

use interwell::dynamics::{EventKind, Model, Regime, STANDARD_GRAVITY};

use crate::support::*;

/// The unit well at damping 0.3 and w = 1.2 under the force A cos w t, from (1, 0), for 600 + 200 periods.
fn forced(amplitude: f64) -> Model {
    let period = TAU / 1.2;
    preset(
        "duffing",
        &[
            &format!("excitation.amplitude_g={:?}", amplitude / STANDARD_GRAVITY),
            &format!("run.duration_s={:?}", 800.0 * period),
            &format!("run.settle_s={:?}", 600.0 * period),
        ],
    )
}

/// Largest change of the state between strobes `shift` periods apart, over the last `count` periods.
fn change(samples: &[interwell::dynamics::Sample], shift: usize, count: usize) -> f64 {
    let last = &samples[samples.len() - count..];
    let pairs = last.iter().zip(&last[shift..]);
    pairs.map(|(a, b)| (a.x - b.x).abs().max((a.v - b.v).abs())).fold(0.0, f64::max)
}

#[test]
fn published_periods_of_the_forced_double_well() {
    // A = 0.20 period 1, 0.28 period 2, 0.29 period 4, 0.37 period 5, 0.50 chaos, 0.65 period 2, from (1, 0).
    // A period n is shown by strobes that repeat to 1e-7 after n periods and move by more than 1e-2 after any
    // fewer.
    let cases = [
        (0.20, Some(1), Regime::Intrawell),
        (0.28, Some(2), Regime::Intrawell),
        (0.29, Some(4), Regime::Intrawell),
        (0.37, Some(5), Regime::Interwell),
        (0.50, None, Regime::Irregular),
        (0.65, Some(2), Regime::Interwell),
    ];
    for (amplitude, period, regime) in cases {
        let model = forced(amplitude);
        let strobes = every(TAU / 1.2, 799);
        let run = run_at(&model, &strobes);
        assert_eq!(run.summary.period, period, "A = {amplitude}");
        assert_eq!(run.summary.regime, regime, "A = {amplitude}");
        for shift in 1..=12 {
            let change = change(&run.samples, shift, 100);
            match period {
                Some(n) if shift % n as usize == 0 => {
                    assert!(change < 1e-7, "{amplitude} {shift} {change:e}")
                }
                _ => assert!(change > 1e-2, "{amplitude} {shift} {change:e}"),
            }
        }
    }
}

#[test]
fn melnikovs_amplitude_is_no_threshold_of_steady_chaos() {
    // A = 4 c cosh(pi w/2)/(3 sqrt 2 pi w) = 0.25276 at c = 0.3, w = 1.2. There and just above it the
    // manifolds touch, yet the motion from (1, 0) settles within the well with the drive's own period.
    let w = 1.2;
    let amplitude = 4.0 * 0.3 * (0.5 * PI * w).cosh() / (3.0 * SQRT_2 * PI * w);
    near(amplitude, 0.25276, 5e-6);
    for a in [0.999 * amplitude, 1.01 * amplitude] {
        let summary = run(&forced(a)).summary;
        assert_eq!((summary.period, summary.regime), (Some(1), Regime::Intrawell));
    }
}

#[test]
fn along_the_separatrix_melnikovs_drive_feeds_what_damping_takes() {
    // To first order in a small e, along x = sqrt 2 / cosh t the damping 0.3 e takes 0.3 e 4/3, and the best
    // phased force of Melnikov's amplitude 0.25276 e gives just that. Any other phase gives cos of its
    // distance less.
    let (w, half, e) = (1.2, 12.0f64, 1e-9);
    let amplitude = e * 4.0 * 0.3 * (0.5 * PI * w).cosh() / (3.0 * SQRT_2 * PI * w);
    let (x0, v0) = (SQRT_2 / half.cosh(), SQRT_2 / half.cosh() * half.tanh());
    for degrees in [0.0f64, 60.0, 90.0, 180.0] {
        let model = unit_well(&format!(
            "damping: Coefficient(c_n_s_per_m: {:?}),
             excitation: Sine(frequency_hz: {:?}, amplitude_g: {:?}, phase_deg: {:?}),
             start: At(x_mm: {:?}, v_m_per_s: {v0:?}), run: (duration_s: {:?}, tolerance: 1e-14)",
            0.3 * e,
            w / TAU,
            amplitude / STANDARD_GRAVITY,
            (-w * half).to_degrees() + degrees,
            x0 * 1e3,
            2.0 * half
        ));
        let ledger = run(&model).summary.ledger.unwrap();
        near_relative(ledger.damping_j, 0.4 * e, 1e-5);
        near(ledger.work_j / ledger.damping_j, degrees.to_radians().cos(), 1e-4);
    }
}

/// Determinant of the map from a start to the state after the run, by central differences of steps d and 2 d
/// combined (error of fourth order in d). `start` in m and m/s, `scene` takes the state.
fn determinant(scene: impl Fn(f64, f64) -> Model, (x, v): (f64, f64), (dx, dv): (f64, f64)) -> f64 {
    let end = |x: f64, v: f64| {
        let summary = run(&scene(x, v)).summary;
        (summary.final_x, summary.final_v)
    };
    let difference = |dx: f64, dv: f64| {
        let (a, b) = (end(x + dx, v + dv), end(x - dx, v - dv));
        (0.5 * (a.0 - b.0), 0.5 * (a.1 - b.1))
    };
    let derivative = |dx: f64, dv: f64| {
        let (near, far) = (difference(dx, dv), difference(2.0 * dx, 2.0 * dv));
        ((8.0 * near.0 - far.0) / 6.0, (8.0 * near.1 - far.1) / 6.0)
    };
    let (a, b) = (derivative(dx, 0.0), derivative(0.0, dv));
    (a.0 * b.1 - a.1 * b.0) / (dx * dv)
}

#[test]
fn the_period_map_contracts_areas_by_the_damping() {
    // det of the period map = exp(-c T/m): on the period-1 orbit of A = 0.20, on the period-5 one, and along
    // chaos.
    let period = TAU / 1.2;
    for amplitude in [0.20, 0.37, 0.50] {
        // along chaos any start will do; a fixed one, since the end of a chaotic run is luck
        let settled = run(&forced(amplitude)).summary;
        let start = if amplitude == 0.50 { (1.0, 0.0) } else { (settled.final_x, settled.final_v) };
        let scene = |x: f64, v: f64| {
            preset(
                "duffing",
                &[
                    &format!("excitation.amplitude_g={:?}", amplitude / STANDARD_GRAVITY),
                    &format!("start=At(x_mm: {:?}, v_m_per_s: {v:?})", x * 1e3),
                    &format!("run.duration_s={period:?}"),
                    "run.settle_s=0",
                    "run.tolerance=1e-13",
                ],
            )
        };
        let d = determinant(scene, start, (2e-4, 2e-4));
        near_relative(d, (-0.3 * period).exp(), 1e-9);
    }
}

#[test]
fn an_impact_contracts_areas_by_the_square_of_its_restitution() {
    // The jump at an impact has the determinant e^2 (saltation), whatever the drive: after n impacts the
    // map's is e^(2n) exp(-c t/m).
    let (e, c, duration): (f64, f64, f64) = (0.8, 0.1, 7.0);
    let scene = |x: f64, v: f64| {
        unit_well(&format!(
            "damping: Coefficient(c_n_s_per_m: {c}), stops: Rigid(travel_limit_mm: 1100, restitution: {e}),
             excitation: Sine(frequency_hz: 0.2, amplitude_g: 0.05),
             start: At(x_mm: {:?}, v_m_per_s: {v:?}), run: (duration_s: {duration}, tolerance: 1e-13)",
            x * 1e3
        ))
    };
    let base = run(&scene(0.1, 1.2));
    let impacts = of_kind(&base, EventKind::Impact);
    assert!((3..=6).contains(&impacts.len()), "{impacts:?}");
    let d = determinant(scene, (0.1, 1.2), (2e-4, 2e-4));
    near_relative(d, e.powi(2 * impacts.len() as i32) * (-c * duration).exp(), 1e-8);
}
