//! Exactness of late events.

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{EventKind, Model, Request, STANDARD_GRAVITY, Side};
use interwell::numeric::bisect;

use crate::support::*;

/// P2's mechanism under a drive so slow that 1e9 s are a thousand periods.
fn slow_drive(frequency: f64, duration: f64) -> Model {
    preset(
        "nominal-cubic",
        &[
            &format!("excitation.frequency_hz={frequency:?}"),
            &format!("run.duration_s={duration:?}"),
            "run.settle_s=0",
            "run.tolerance=1e-12",
        ],
    )
}

#[test]
fn every_cycle_of_a_billion_seconds_is_the_first_one() {
    // A mass that rests in every half period starts each release from the same state at the same phase. So
    // each cycle's impacts have the speeds of the first one's, bit for bit, and come 1/f later to the last
    // digit of t: at 1e9 s as at 1e6 s.
    let frequency = 1e-6;
    let run = run(&slow_drive(frequency, 1e9));
    let releases: Vec<usize> =
        (0..run.events.len()).filter(|i| run.events[*i].kind == EventKind::Release).collect();
    assert_eq!(releases.len(), 2000);
    let cycle = releases[2] - releases[0];
    let first = &run.events[releases[0]..releases[2]];
    assert!(first.len() > 20);
    for n in 0..999 {
        let events = &run.events[releases[2 * n]..releases[2 * n + 2]];
        assert_eq!(events.len(), cycle);
        for (a, b) in first.iter().zip(events) {
            assert_eq!((a.kind, a.side, a.v_in, a.v_out), (b.kind, b.side, b.v_in, b.v_out), "cycle {n}");
            // n/f is exact here up to the rounding of 1e-6 itself, 2^-54 of it
            near_relative(b.t, a.t + n as f64 / frequency, 4.0 * f64::EPSILON);
        }
    }
    // Release from the right where m a_b = |F(D)|: 1.5 g sin(2 pi f t) = (40 D - k3 D^3)/m.
    let press = (40.0 * 4e-3 - 816326.530612245 * 4e-3f64.powi(3)) / 0.0152;
    let turns = (press / (1.5 * STANDARD_GRAVITY)).asin() / TAU;
    assert_eq!(run.events[releases[0]].side, Side::Right);
    near_relative(run.events[releases[0]].t, turns / frequency, 1e-15);
    near_relative(run.events[releases[1]].t, (0.5 + turns) / frequency, 1e-15);
    near_relative(run.events[releases[1998]].t, (999.0 + turns) / frequency, 4e-16);
}

#[test]
fn a_slow_ramp_releases_after_a_million_seconds() {
    // From rest on the stop under (r t) sin(2 pi f t) the release is the first root of r t sin(2 pi f t) =
    // |F(D)|/m: here in cycle 120482 of 0.125 Hz, after 963 858 s, known to the last digit of t.
    let (frequency, over, to): (f64, f64, f64) = (0.125, 2e6, 1.5);
    let scene = |duration: f64| {
        preset(
            "nominal-cubic",
            &[
                &format!(
                    "excitation=AmplitudeRamp(frequency_hz: {frequency:?}, from_g: 0, to_g: {to:?}, \
                     over_s: {over:?})"
                ),
                &format!("run.duration_s={duration:?}"),
                "run.settle_s=0",
                "run.tolerance=1e-12",
            ],
        )
    };
    let press = (40.0 * 4e-3 - 816326.530612245 * 4e-3f64.powi(3)) / 0.0152;
    let rate = to * STANDARD_GRAVITY / over;
    // excess of the drive over the press at phase `turns` of a cycle
    let excess = |cycle: f64, turns: f64| rate * ((cycle + turns) / frequency) * (TAU * turns).sin() - press;
    let cycle = (0..).map(f64::from).find(|n| excess(*n, 0.25 + 1e-7) > 0.0).unwrap();
    let release = (cycle + bisect(0.0, 0.25, 60, |turns| excess(cycle, turns) < 0.0).1) / frequency;
    let run = run(&scene(release + 2.0));
    let releases = of_kind(&run, EventKind::Release);
    assert_eq!((cycle, release.round()), (120482.0, 963858.0));
    near_relative(releases[0].t, release, 2.0 * f64::EPSILON);
    assert_eq!(run.events[0].t, 0.0);
    assert_eq!(run.events[1], releases[0]);
}

#[test]
fn a_forced_oscillator_has_its_phase_after_a_hundred_million_seconds() {
    // x'' + g x' + k x = -A sin w t, long settled: at 1e8 s, 3e5 periods on, the state is that of the steady
    // orbit at the exact product of the doubles f and t, to 1e-13 of its size.
    let (frequency, duration) = (0.003, 1e8);
    let model = model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1e-3]),
         damping: Coefficient(c_n_s_per_m: 0.01), excitation: Sine(frequency_hz: {frequency:?}, \
         amplitude_g: 0.001),
         start: At(x_mm: 0, v_m_per_s: 0), run: (duration_s: {duration:?}, settle_s: 9.9e7, tolerance: 1e-12)"
    ));
    let times = [1e8 - 123.456789, 1e8 - 0.1, 1e8];
    let run = run_at(&model, &times);
    assert_eq!(run.samples.len(), 3);
    let w = TAU * frequency;
    let (re, im) = (1e-3 - w * w, 0.01 * w);
    let amplitude = 0.001 * STANDARD_GRAVITY / re.hypot(im);
    for s in &run.samples {
        // frequency * t less whole turns: the product's rounding error by fused multiply-add
        let turns = frequency * s.t;
        let fraction = (turns - turns.round()) + frequency.mul_add(s.t, -turns);
        let angle = TAU * fraction - im.atan2(re);
        near(s.x, -amplitude * angle.sin(), 1e-13 * amplitude);
        near(s.v, -amplitude * w * angle.cos(), 1e-13 * amplitude * w);
        near(s.base_accel, 0.001 * STANDARD_GRAVITY * (TAU * fraction).sin(), 1e-17);
    }
    near_relative(run.summary.rms_velocity.unwrap(), amplitude * w * 0.5f64.sqrt(), 1e-10);
}

#[test]
fn a_rest_of_a_billion_seconds_is_one_step() {
    // Pressed below the release amplitude, 1e9 s at 3 Hz are a rest of three billion periods and no work.
    let model =
        preset("nominal-cubic", &["excitation.amplitude_g=0.5", "run.duration_s=1e9", "run.settle_s=None"]);
    let run = run_at(&model, &[1.0, 5e8 + 0.25, 1e9]);
    assert!(run.summary.steps < 5);
    assert_eq!(run.events.len(), 1);
    assert_eq!(run.summary.rested_share, Some(1.0));
    let base = |turns: f64| 0.5 * STANDARD_GRAVITY * (TAU * turns).sin();
    for (s, turns) in run.samples.iter().zip([0.0, 0.75, 0.0]) {
        assert_eq!((s.x, s.v), (4e-3, 0.0));
        near(s.base_accel, base(turns), 1e-15);
    }
}

#[test]
fn a_search_for_a_late_release_can_be_cancelled() {
    // At rest under a ramp that needs 5e8 s of 3 Hz, the search for the release is work in steps: they are
    // counted, grow with the time that is searched, and between them the run can be told to end.
    let model = |duration: &str| {
        preset(
            "nominal-cubic",
            &[
                "excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 1.5, over_s: 1e9)",
                &format!("run.duration_s={duration}"),
                "run.settle_s=None",
            ],
        )
    };
    let cancel = AtomicBool::new(true);
    let cancelled = model("1e8").run(&Request { cancel: Some(&cancel), ..Request::default() }).summary;
    assert_eq!(cancelled.outcome.name(), "cancelled");
    let [short, long] = ["1e3", "1e5"].map(|d| run(&model(d)).summary.steps);
    assert!(long > 50 * short, "{short} {long}");
}
