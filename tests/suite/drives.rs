//! Chirps, noise and records: the acceleration of the base, and the motion of the mass.

mod harmonic;

use std::f64::consts::TAU;

use interwell::dynamics::{EventKind, Request, STANDARD_GRAVITY};
use interwell::scene::{Document, DriveError, Excitation, Files};
use interwell::{Orbit, Progress, Simulation};
use proptest::prelude::*;

use crate::support::*;

/// A free mass of 1 kg: it moves by the double integral of the drive.
fn free_mass(excitation: &str, run: &str) -> interwell::dynamics::Model {
    model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0]), start: At(x_mm: 0, v_m_per_s: 0),
         excitation: {excitation}, run: ({run})"
    ))
}

/// A file in a fresh folder, which lives as long as the first value.
fn record(text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.csv");
    std::fs::write(&path, text).unwrap();
    (folder, path.display().to_string())
}

#[test]
fn a_chirp_is_its_formula_and_holds_its_last_frequency() {
    // phase 2 pi (f0 t + (f1 - f0) t^2/(2 over)), then f1 without a jump; to 1e-13 of the amplitude, late too
    let (f0, f1, over, g) = (1.0, 8.0, 4.0, 0.7);
    let m = free_mass(
        &format!("Chirp(from_hz: {f0}, to_hz: {f1}, over_s: {over}, amplitude_g: {g})"),
        "duration_s: 9, tolerance: 1e-12",
    );
    let turns = |t: f64| {
        if t < over {
            f0 * t + (f1 - f0) * t * t / (2.0 * over)
        } else {
            (f0 + f1) * over / 2.0 + f1 * (t - over)
        }
    };
    for s in run_at(&m, &every(0.0371, 240)).samples {
        near(s.base_accel, g * STANDARD_GRAVITY * (TAU * turns(s.t)).sin(), 2e-13 * g * STANDARD_GRAVITY);
    }
    assert_eq!(m.forcing_period(), None);
}

#[test]
fn a_smooth_record_takes_the_steps_of_its_curve_and_moves_the_mass_as_its_lines_do() {
    // against the same run in 31 digits, which goes from sample to sample
    let sine = |i: u32| 1.5 * STANDARD_GRAVITY * (TAU * 3.0 * f64::from(i) / 5e3).sin();
    let rows = (0..=5000).map(|i| format!("{},{}\n", f64::from(i) / 5e3, sine(i)));
    let (_folder, path) = record(&format!("t_s,accel_m_per_s2\n{}", rows.collect::<String>()));
    let excitation = format!("excitation=Recorded(path: {path:?})");
    for (stops, tolerance) in [("None", 1e-6), ("None", 1e-8), ("Rigid", 1e-6), ("Rigid", 1e-8)] {
        let stops = if stops == "None" { "stops=None" } else { "stops.restitution=0.36" };
        let tolerance_set = format!("run.tolerance={tolerance}");
        let changes = [&excitation, stops, &tolerance_set, "run.duration_s=1", "run.settle_s=0.5"];
        let m = preset("nominal-cubic", &changes);
        let times = every(0.0437, 22);
        let request = Request { sample_times: &times, events: true, ..Request::default() };
        let (a, b) = (m.run(&request), m.run_reference(&request, 1e-24));
        // with rigid stops a run goes from sample to sample
        if stops == "stops=None" {
            assert!(a.summary.steps * 20 < b.summary.steps, "{} steps", a.summary.steps);
        }
        for (sample, exact) in a.samples.iter().zip(&b.samples) {
            near(sample.x, exact.x, 7e-3 * tolerance);
            near(sample.v, exact.v, m.scales().speed * 1.5 * tolerance);
            near(sample.base_accel, exact.base_accel, 1e-12); // what is told is the record
        }
        let told = |run: &interwell::dynamics::Run| -> Vec<interwell::dynamics::Event> {
            let fast = |event: &&interwell::dynamics::Event| match event.kind {
                EventKind::Impact => event.v_out.abs() > 1e-3,
                kind => kind == EventKind::Release,
            };
            run.events.iter().filter(fast).copied().collect()
        };
        let (a, b) = (told(&a), told(&b));
        assert_eq!(a.iter().any(|event| event.kind == EventKind::Release), stops != "stops=None");
        assert_eq!(a.len(), b.len());
        for (event, exact) in a.iter().zip(&b) {
            assert_eq!(event.kind, exact.kind);
            near(event.t, exact.t, tolerance / 3.0);
        }
    }
}

#[test]
fn a_record_with_noise_releases_the_mass_at_any_tolerance() {
    // A sine and a little noise from sample to sample: a release must lead away from the stop.
    let mut state = 1_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut rows = "t_s,accel_m_per_s2\n".to_owned();
    for i in 0..=20_000 {
        let t = f64::from(i) * 1e-4;
        let sine = STANDARD_GRAVITY * (TAU * 3.0 * t).sin();
        rows += &format!("{t},{}\n", sine + 0.035 * noise());
    }
    let (_folder, path) = record(&rows);
    let run = |tolerance: f64| {
        let changes = [format!("excitation=Recorded(path: {path:?})"), format!("run.tolerance={tolerance}")];
        let changes = [changes[0].as_str(), &changes[1], "run.duration_s=2", "run.settle_s=1"];
        preset("paper", &changes).run(&Request::default()).summary
    };
    let fine = run(1e-9);
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let summary = run(tolerance);
        assert_eq!(summary.outcome, interwell::dynamics::Outcome::Done, "{tolerance}");
        let (rms, exact) = (summary.rms_velocity.unwrap(), fine.rms_velocity.unwrap());
        assert!((rms / exact - 1.0).abs() < 10.0 * tolerance, "{tolerance}: {rms} {exact}");
    }
}

#[test]
fn a_mass_follows_chirp_noise_and_record_as_twice_the_digits_do() {
    // The same run in 31 digits: position and velocity to what a disturbance of a step grows to in 2 s
    let (_folder, path) = record("t_s,accel_m_per_s2\n0,0\n0.3,4\n0.35,-3\n1.1,2\n2.5,0.5\n3,-6\n4,0\n");
    for excitation in [
        "Chirp(from_hz: 0, to_hz: 12, over_s: 3, amplitude_g: 0.8)".to_owned(),
        "Noise(rms_g: 0.5, low_hz: 1, high_hz: 9, seed: 5, lines: 40)".to_owned(),
        format!("Recorded(path: {path:?})"),
        format!(
            "Sum([Recorded(path: {path:?}), Constant(accel_g: 0.1), Sine(frequency_hz: 3, amplitude_g: 0.9),
             AmplitudeRamp(frequency_hz: 5, from_g: 0, to_g: 0.4, over_s: 2),
             Chirp(from_hz: 2, to_hz: 1, over_s: 3.3, amplitude_g: 0.3)])"
        ),
    ] {
        for stops in ["None", "Rigid(travel_limit_mm: 4, restitution: 0.36)"] {
            let m = preset(
                "nominal-cubic",
                &[
                    &format!("excitation={excitation}"),
                    &format!("stops={stops}"),
                    "run.duration_s=2",
                    "run.settle_s=None",
                    "run.tolerance=1e-12",
                ],
            );
            let times = every(0.055, 36);
            let request = Request { sample_times: &times, events: true, ledger: true, ..Request::default() };
            let (a, b) = (m.run(&request), m.run_reference(&request, 1e-26));
            assert_eq!(a.samples.len(), 36);
            for (s, r) in a.samples.iter().zip(&b.samples) {
                near(s.x, r.x, 1e-8 * m.scales().length);
                near(s.v, r.v, 1e-8 * m.scales().speed);
                near(s.base_accel, r.base_accel, 1e-12 * STANDARD_GRAVITY);
            }
            let releases = |run: &interwell::dynamics::Run| of_kind(run, EventKind::Release).len();
            assert_eq!(releases(&a), releases(&b), "{excitation} {stops}");
            assert!(a.summary.ledger.unwrap().energy_residual < 1e-11);
        }
    }
}

#[test]
fn noise_has_its_root_mean_square_and_its_band() {
    // rms over 400 s to 3 %; a projection on sines outside the band finds next to nothing
    let m =
        free_mass("Noise(rms_g: 0.5, low_hz: 2, high_hz: 6, seed: 11)", "duration_s: 400, tolerance: 1e-6");
    let dt = 0.01;
    let times: Vec<f64> = (0..40_000).map(|i| dt * f64::from(i)).collect();
    let a: Vec<f64> =
        run_at(&m, &times).samples.iter().map(|sample| sample.base_accel / STANDARD_GRAVITY).collect();
    let n = a.len() as f64;
    let rms = (a.iter().map(|a| a * a).sum::<f64>() / n).sqrt();
    near(rms, 0.5, 0.015);
    // power per Hz by averaged periodograms with a Hann window of 10 s
    let density = |f: f64| {
        let length = 1000;
        let mut sum = 0.0;
        for part in a.chunks_exact(length) {
            let (mut c, mut s) = (0.0, 0.0);
            for (i, a) in part.iter().enumerate() {
                let window = (std::f64::consts::PI * i as f64 / length as f64).sin().powi(2);
                let phase = TAU * f * dt * i as f64;
                c += a * window * phase.cos();
                s += a * window * phase.sin();
            }
            sum += (c * c + s * s) * 2.0 * dt / (0.375 * length as f64);
        }
        sum / (n / length as f64)
    };
    let flat = 0.25 / 4.0; // rms^2 over the band's width
    let inside: f64 = (0..40).map(|i| density(2.05 + 0.0975 * f64::from(i))).sum::<f64>() / 40.0;
    near(inside, flat, 0.1 * flat);
    for outside in [0.5, 1.5, 6.5, 9.0, 20.0] {
        assert!(density(outside) < 1e-3 * flat, "{outside} Hz: {}", density(outside));
    }
}

#[test]
fn noise_is_the_same_for_any_duration_and_pinned_to_its_seed() {
    let noise = |seed: u64, duration: f64| {
        free_mass(
            &format!("Noise(rms_g: 1, low_hz: 1, high_hz: 5, seed: {seed})"),
            &format!("duration_s: {duration}, tolerance: 1e-6"),
        )
    };
    let (short, long) = (noise(3, 5.0), noise(3, 5000.0));
    for i in 0..50 {
        let t = 0.1 * f64::from(i);
        assert_eq!(short.base_acceleration(t).to_bits(), long.base_acceleration(t).to_bits());
    }
    assert!((noise(4, 5.0).base_acceleration(1.0) - short.base_acceleration(1.0)).abs() > 1e-3);
    // recorded: a change of generator or of the order of its numbers would move this
    near(short.base_acceleration(1.0), PINNED, 1e-9);
}

/// Base acceleration in m/s^2 of the noise with seed 3 after 1 s.
const PINNED: f64 = 10.462_674_754_873_87;

#[test]
fn a_record_is_linear_between_samples_and_zero_after_its_end() {
    let (_folder, path) = record("t_s,extra,accel_m_per_s2\n-1,9,2\n1,9,4\n2,9,-4\n");
    let m = free_mass(&format!("Recorded(path: {path:?})"), "duration_s: 5, tolerance: 1e-12");
    for (t, a) in
        [(0.0, 3.0), (0.5, 3.5), (1.0, 4.0), (1.25, 2.0), (1.75, -2.0), (2.0, -4.0), (2.1, 0.0), (3.0, 0.0)]
    {
        near(m.base_acceleration(t), a, 1e-14);
    }
    // x'' = -a: v(2) = -(7/2) - 0, x by integrating the two parabolas; then it coasts
    let run = run_at(&m, &[1.0, 2.0, 4.0]);
    near(run.samples[0].v, -3.5, 1e-13);
    near(run.samples[0].x, -(1.5 + 1.0 / 6.0), 1e-13);
    near(run.samples[1].v, -3.5, 1e-13);
    near(run.samples[2].v, -3.5, 1e-13);
    near(run.samples[2].x - run.samples[1].x, -7.0, 1e-12);
}

#[test]
fn the_last_sample_of_a_record_is_within_it_where_the_run_ends_with_it_and_where_it_goes_on() {
    let rows: String =
        (0..=40).map(|i| format!("{},{}\n", f64::from(i) / 40.0, 3.0 - f64::from(i) / 80.0)).collect();
    let (_folder, path) = record(&format!("t_s,accel_m_per_s2\n{rows}"));
    let recorded = format!("Recorded(path: {path:?})");
    for excitation in [recorded.clone(), format!("Sum([Constant(accel_g: 0), {recorded}])")] {
        // flying over polynomials, over lines, and resting on a stop
        for (stops, start) in [
            ("None", 0.0),
            ("Rigid(travel_limit_mm: 1e6, restitution: 0.3)", 0.0),
            ("Rigid(travel_limit_mm: 5, restitution: 0.3)", -5.0),
        ] {
            for duration in [1.0, 1.2] {
                let m = model(&format!(
                    "mass_g: 1000, mechanism: Linear(n_per_m: 2), stops: {stops},
                     start: At(x_mm: {start}, v_m_per_s: 0), excitation: {excitation},
                     run: (duration_s: {duration}, settle_s: 0, tolerance: 1e-6)"
                ));
                let run = run_at(&m, &[0.5, 1.0, duration]);
                let told: Vec<f64> = run.samples.iter().map(|sample| sample.base_accel).collect();
                let last = if duration > 1.0 { 0.0 } else { 2.5 };
                for (told, known) in told.iter().zip([2.75, 2.5, last]) {
                    near(*told, known, 1e-14);
                }
                near(m.base_acceleration(1.0), 2.5, 1e-14);
            }
        }
    }
}

#[test]
fn a_jump_at_the_end_of_a_record_releases_at_once() {
    // Held on the right stop by a base that accelerates to the left; the record ends, the hold with it.
    let (_folder, path) = record("t_s,accel_m_per_s2\n0,-5\n1,-5\n");
    let m = model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [2]),
         stops: Rigid(travel_limit_mm: 100, restitution: 0.3), start: At(x_mm: 100, v_m_per_s: 0),
         excitation: Recorded(path: {path:?}), run: (duration_s: 1.2, tolerance: 1e-12)"
    ));
    let run = run(&m);
    let releases: Vec<f64> = of_kind(&run, EventKind::Release).iter().map(|e| e.t).collect();
    assert_eq!(releases, vec![1.0]);
    near(run.summary.final_x, 0.1 - 0.5 * 2.0 * 0.04, 1e-14);
}

#[test]
fn a_record_that_cannot_be_meant_is_refused_and_one_that_may_surprise_is_remarked() {
    let check = |text: &str| {
        let (_folder, path) = record(text);
        let scene = format!(
            "(title: \"t\", mass_g: 1, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), \
             excitation: Sum([Recorded(path: {path:?})]), run: (duration_s: 2))"
        );
        match Document::from_text("s.ron", &scene, Files::default()).unwrap().check() {
            Ok(warnings) => warnings.join("\n"),
            Err(error) => format!("error: {error}"),
        }
    };
    for (text, said) in [
        ("t_s,accel_m_per_s2\n0,1\n1,NaN\n", "line 3: accel_m_per_s2 is `NaN`"),
        ("t_s,accel_m_per_s2\n0,1\n1,2\n1,3\n", "line 4: t_s = 1e0 does not come after 1e0"),
        ("t_s,accel_m_per_s2\n0,1\n1,2\n0.5,3\n", "line 4: t_s = 5e-1 does not come after 1e0"),
        ("t_s,accel_m_per_s2\n0,1\n", "has one row"),
        ("t,a\n0,1\n", "no column t_s"),
    ] {
        let found = check(text);
        assert!(found.starts_with("error: s.ron:1:") && found.contains("excitation.0.path"), "{found}");
        assert!(found.contains(said), "{found}");
    }
    assert_eq!(check("t_s,accel_m_per_s2\n0,1\n1,2\n2,3\n"), "");
    assert!(check("t_s,accel_m_per_s2\n0,1\n1,2\n").contains("ends at 1 s, before the run does at 2 s"));
    assert!(check("t_s,accel_m_per_s2\n0.5,1\n1,2\n3,2\n").contains("begins at 0.5 s"));
    let gap = "t_s,accel_m_per_s2\n0,1\n0.1,2\n0.2,1\n1.9,3\n2,2\n";
    assert!(check(gap).contains("has a gap of 1.7 s after 0.2 s"), "{}", check(gap));
}

#[test]
fn a_record_that_is_missing_is_named_with_its_field_and_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let beside = Files::beside(&folder.path().join("s.ron"));
    for (files, remedy) in [(beside, "give the path of one"), (Files::default(), "give an absolute path")] {
        let scene = "(title: \"t\", mass_g: 1, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), \
                     excitation: Recorded(path: \"gone.csv\"), run: (duration_s: 2))";
        let error = Document::from_text("s.ron", scene, files).unwrap().check().unwrap_err().to_string();
        assert!(error.contains("excitation.path = ") && error.contains("gone.csv"), "{error}");
        assert!(error.contains(remedy), "{error}");
    }
}

#[test]
fn a_seed_and_a_number_of_lines_are_whole_and_can_be_swept() {
    let mut document = Document::load("nominal-cubic").unwrap();
    document.set("excitation=Noise(rms_g: 1, low_hz: 1, high_hz: 5, seed: 1)").unwrap();
    document.set("excitation.seed=7").unwrap();
    assert!(document.set("excitation.lines=2.5").is_err());
    assert_eq!(document.axes(&["excitation.seed=1:4:1"]).unwrap()[0].values, vec![1.0, 2.0, 3.0, 4.0]);
    let fraction = document.axes(&["excitation.seed=1:2:0.5"]).unwrap_err().to_string();
    assert!(fraction.contains("whole"), "{fraction}");
    document.set("excitation.high_hz=0.5").unwrap();
    assert!(document.check().unwrap_err().to_string().contains("must be above excitation.low_hz = 1"));
}

/// A free mass under a drive, for its acceleration.
fn driven(drive: &Excitation) -> Simulation {
    let scene = "(title: \"\", mass_g: 1000, mechanism: Polynomial(coefficients_si: [0]),
        start: At(x_mm: 0, v_m_per_s: 0), run: (duration_s: 1, tolerance: 1e-12))";
    Simulation::from_text("free.ron", scene).unwrap().with_drive(drive).unwrap()
}

/// The acceleration of a drive at these times.
fn accelerations(drive: &Excitation, times: &[f64]) -> Vec<f64> {
    run_at(driven(drive).model(), times).samples.iter().map(|sample| sample.base_accel).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(40) })]

    /// A smooth periodic function is followed as closely as was asked for, at times that were not compared,
    /// and the drive repeats.
    #[test]
    fn a_drive_of_a_function_is_the_function(
        digits in 1.0..11.0_f64,
        decimals in 1_u64..99_999,
        (mean, sharp) in (-5.0..5.0_f64, 0.0..12.0_f64),
        terms in proptest::collection::vec((1_u32..30, -9.0..9.0_f64, 0.0..1.0_f64), 0..5),
        shares in proptest::collection::vec(0.0..1.0_f64, 30),
    ) {
        let frequency = decimals as f64 / 1e3;
        let function = |t: f64| {
            let pulse = 3.0 * (sharp * ((TAU * frequency * t).cos() - 1.0)).exp();
            let wave = |term: &(u32, f64, f64)| {
                let (k, a, phase) = *term;
                a * (TAU * (f64::from(k) * frequency * t + phase)).sin()
            };
            mean + pulse + terms.iter().map(wave).sum::<f64>()
        };
        let tolerance = 10.0_f64.powf(-digits);
        let drive = Excitation::from_fn(function, frequency, tolerance).unwrap();
        let largest = mean.abs() + 3.0 + terms.iter().map(|term| term.1.abs()).sum::<f64>();
        prop_assert!(drive.error <= tolerance * largest);
        let mut times: Vec<f64> = shares.iter().map(|share| share / frequency).collect();
        times.retain(|t| *t <= 1.0);
        times.sort_by(f64::total_cmp);
        for (t, found) in times.iter().zip(accelerations(&drive.excitation, &times)) {
            // the largest error may lie between the places that were compared
            let bound = 1.5 * drive.error + 0.1 * tolerance * largest + 1e-12 * largest;
            let error = (found - function(*t)).abs();
            prop_assert!(error <= bound, "{} at {} s, bound {}", error, t, bound);
        }
        prop_assert!(driven(&drive.excitation).model().repeats());
    }

    /// A drive of samples has the samples, and goes through its text in a scene.
    #[test]
    fn a_drive_of_samples_has_the_samples(
        values in proptest::collection::vec(-20.0..20.0_f64, 1..80),
        hz in 1_u32..9,
    ) {
        let frequency = f64::from(hz);
        let drive = Excitation::from_samples(&values, frequency).unwrap();
        let times: Vec<f64> = (0..values.len()).map(|i| i as f64 / values.len() as f64 / frequency).collect();
        let bound = 1e-12 * 20.0 * values.len() as f64;
        for (value, found) in values.iter().zip(accelerations(&drive.excitation, &times)) {
            prop_assert!((value - found).abs() < bound, "{} is not {}", found, value);
        }
        let scene = driven(&drive.excitation).document().scene.clone();
        let text = interwell::scene::write(&scene).unwrap();
        let read = Document::from_text("s.ron", &text, Files::default()).unwrap();
        prop_assert_eq!(read.scene.excitation, drive.excitation);
    }
}

#[test]
fn no_harmonic_passes_for_another_one() {
    for k in (1..=1000).chain([1024, 1536, 2000]) {
        let wave = |t: f64| 7.0 * (TAU * (f64::from(k) * 2.0 * t).fract()).cos();
        let drive = Excitation::from_fn(wave, 2.0, 1e-3).unwrap();
        let Excitation::Sine { frequency_hz, amplitude_g, .. } = drive.excitation else {
            panic!("{k}: {:?}", drive.excitation)
        };
        near(frequency_hz, 2.0 * f64::from(k), 1e-9 * frequency_hz);
        near(amplitude_g, 7.0 / STANDARD_GRAVITY, 1e-3 * amplitude_g);
    }
}

#[test]
fn a_drive_of_a_function_works_in_the_studies() {
    // sin^3 is two sines, which a scene can also write; the orbit has the period of the drive
    let simulation = Simulation::preset("nominal-cubic").unwrap();
    let cubed = |t: f64| 20.0 * (TAU * 3.0 * t).sin().powi(3);
    let drive = Excitation::from_fn(cubed, 3.0, 1e-10).unwrap();
    let ours = simulation.with_drive(&drive.excitation).unwrap();
    let sine = |hz: f64, m_per_s2: f64| Excitation::Sine {
        frequency_hz: hz,
        amplitude_g: m_per_s2 / STANDARD_GRAVITY,
        phase_deg: 0.0,
    };
    let written = simulation.with_drive(&Excitation::Sum(vec![sine(3.0, 15.0), sine(9.0, -5.0)])).unwrap();
    let run = |simulation: &Simulation| simulation.run(&Request::default()).summary.rms_velocity.unwrap();
    near(run(&ours), run(&written), 1e-6 * run(&written));
    let orbit = Orbit::default().run(&ours, &Progress::none()).unwrap();
    near(ours.model().forcing_period().unwrap(), 1.0 / 3.0, 1e-15);
    assert!(orbit.period >= 1);
}

#[test]
fn what_is_no_drive_is_refused_with_a_remedy() {
    let from_fn = |f: fn(f64) -> f64, hz, tolerance| Excitation::from_fn(f, hz, tolerance).unwrap_err();
    let square = from_fn(|t| if t < 0.5 { 1.0 } else { -1.0 }, 1.0, 1e-3);
    assert!(matches!(square, DriveError::Unresolved(..)), "{square}");
    assert!(square.to_string().contains("Recorded"), "{square}");
    assert!(matches!(from_fn(|t| 1.0 / (t - 0.5), 1.0, 1e-3), DriveError::NotFinite(..)));
    assert_eq!(from_fn(|_| 2e30, 1.0, 1e-3), DriveError::TooLarge(0.0, 2e30));
    assert_eq!(from_fn(f64::sin, 0.0, 1e-3), DriveError::Frequency(0.0));
    assert_eq!(from_fn(f64::sin, 1.0, 0.5), DriveError::Tolerance(0.5));
    let third = from_fn(f64::sin, 1.0 / 3.0, 1e-3);
    assert!(third.to_string().ends_with("give 0.33333333333 Hz"), "{third}");
    assert_eq!(Excitation::from_samples(&[], 1.0).unwrap_err(), DriveError::Samples(0));
    assert_eq!(Excitation::from_samples(&[0.0; 4], 1.0).unwrap().excitation, Excitation::None);
}
