//! Cosines and forces in SI beside sines of the base.

use std::f64::consts::TAU;

use interwell::dynamics::{Request, STANDARD_GRAVITY};
use interwell::questions::{Compare, Onset, Progress, Simulation, Sweep, Threshold};
use interwell::scene::{Document, Excitation, Files, Scene, check};
use interwell_studies::study::{Watch, continued_scene};
use proptest::prelude::*;

use crate::cli::stdout;
use crate::properties::harness::{hold_for, text};
use crate::properties::scenes;
use crate::support::{Draw, build, changed, every, model, near, near_relative, preset, run_at, same_bits};

/// A drive in SI and the sine of the base with the same motion, for a mass of a power of two in kg:
/// amplitude, frequency and phase of both are then the same to the last bit.
fn twins(acceleration_g: f64, rate: f64, turns: i32, mass: f64, force: bool) -> [Excitation; 2] {
    // whole parts of a degree, so that a quarter turn more is exact
    let phase_deg = f64::from(turns) / 1024.0;
    let acceleration = acceleration_g * STANDARD_GRAVITY;
    let (frequency_rad_per_s, frequency_hz, amplitude_g) = (rate, rate / TAU, acceleration_g);
    let (si, ahead) = match force {
        true => {
            (Excitation::Force { amplitude_n: acceleration * mass, frequency_rad_per_s, phase_deg }, 270.0)
        }
        false => {
            let amplitude_m_per_s2 = acceleration;
            (Excitation::Cosine { amplitude_m_per_s2, frequency_rad_per_s, phase_deg }, 90.0)
        }
    };
    [si, Excitation::Sine { frequency_hz, amplitude_g, phase_deg: phase_deg + ahead }]
}

#[test]
fn where_no_number_is_rounded_a_force_and_a_sine_run_alike_bit_for_bit() {
    let drawn =
        (scenes::scene(), (-1.0..1.0_f64, 0.0..1.0_f64, -400_000..400_000, any::<bool>()), any::<bool>());
    let property = "where_no_number_is_rounded_a_force_and_a_sine_run_alike_bit_for_bit";
    hold_for(
        property,
        400,
        0.7,
        drawn,
        |(scene, ..)| text(scene),
        |(scene, (size, share, turns, force), in_a_sum)| {
            let mass = (scene.mass_g / 1e3).log2().round().exp2();
            let scene = Scene { mass_g: 1e3 * mass, ..scene.clone() };
            let still = Scene { excitation: Excitation::None, ..scene.clone() };
            let Some(scales) = scenes::model(&still).map(|model| model.scales()) else { return Ok(false) };
            let acceleration_g = 4.0 * size * scales.length / (scales.time * scales.time) / STANDARD_GRAVITY;
            let rate = (0.3 + 6.0 * share) / scales.time;
            let models = twins(acceleration_g, rate, *turns, mass, *force).map(|drive| {
                let constant = Excitation::Constant { accel_g: 0.3 * acceleration_g };
                let excitation = if *in_a_sum { Excitation::Sum(vec![drive, constant]) } else { drive };
                scenes::model(&Scene { excitation, ..scene.clone() })
            });
            let [Some(si), Some(sine)] = &models else { return Ok(false) };
            let times = every(scene.run.duration_s / 50.0, 49);
            let request = Request { sample_times: &times, events: true, ledger: true, ..Request::default() };
            same_bits(&si.run(&request), &sine.run(&request));
            Ok(true)
        },
    );
}

/// Of any mass and phase: -F/m and the sine's amplitude in g times g are rounded apart by two units in the
/// last place at most, the phases by that of some hundred degrees, 3e-14, which is 5e-16 rad; with the sine
/// itself 4e-15 of the amplitude in all.
const ROUNDING: f64 = 4e-15;

#[test]
fn a_force_moves_a_mass_as_the_sine_of_its_amplitude_over_the_mass_to_rounding() {
    let mut draw = Draw(21);
    let mut worst = [0.0_f64; 2];
    for _ in 0..60 {
        let (mass, rate) = (10_f64.powf(draw.between(-4.0, 2.0)), draw.between(0.2, 3.0));
        let (force, phase) = (draw.between(-2.0, 2.0), draw.between(-400.0, 400.0));
        let with = |excitation: &str| {
            model(&format!(
                "mass_g: {:?}, mechanism: Linear(n_per_m: 1), damping: Coefficient(c_n_s_per_m: 0.3), \
                 excitation: {excitation}, start: At(x_mm: 300, v_m_per_s: 0), \
                 run: (duration_s: 30, tolerance: 1e-12)",
                1e3 * mass
            ))
        };
        let si = with(&format!(
            "Force(amplitude_n: {force:?}, frequency_rad_per_s: {rate:?}, phase_deg: {phase:?})"
        ));
        let sine = with(&format!(
            "Sine(frequency_hz: {:?}, amplitude_g: {:?}, phase_deg: {:?})",
            rate / TAU,
            -force / mass / STANDARD_GRAVITY,
            phase + 90.0
        ));
        let (acceleration, times) = (force.abs() / mass, every(0.37, 80));
        let [a, b] = [&si, &sine].map(|model| run_at(model, &times).samples);
        let size = a.iter().map(|sample| sample.x.abs()).fold(0.0, f64::max);
        for (one, other) in a.iter().zip(&b) {
            let exact = -force / mass * (rate * one.t + phase.to_radians()).cos();
            near(si.base_acceleration(one.t), exact, 1e-13 * acceleration);
            let apart = si.base_acceleration(one.t) - sine.base_acceleration(one.t);
            near(apart, 0.0, ROUNDING * acceleration);
            // a linear oscillator passes on what the drive has, and each step rounds once more
            near(one.x, other.x, 1e-13 * size);
            worst[0] = worst[0].max(apart.abs() / acceleration);
            worst[1] = worst[1].max((one.x - other.x).abs() / size);
        }
    }
    println!("apart by {:.1e} of the amplitude, {:.1e} of the motion", worst[0], worst[1]);
}

#[test]
fn every_command_says_of_a_force_what_it_says_of_its_sine() {
    const TONES: [(&str, &str); 2] = [
        ("Force(amplitude_n:A*9.80665,frequency_rad_per_s:0.9,phase_deg:90)", "--phase-deg 90"),
        ("Sine(frequency_hz:0.9/(2*pi),amplitude_g:A,phase_deg:360)", "--phase-deg 0"),
    ];
    let coil =
        "--set transducer=Electromagnetic(coupling_v_s_per_m:0.1,coil_ohm:1,load_ohm:1,inductance_mh:100)";
    // each with a mass of 1 kg; PHASE is that at which both drives have the same acceleration
    for line in [
        "simulate duffing",
        "simulate duffing COIL",
        "sweep duffing --over damping.c_n_s_per_m=0.1:0.5:0.1 --carry both",
        "section duffing PHASE",
        "exponents duffing --periods 100 COIL",
        "spectrum duffing",
        "best duffing --over damping.c_n_s_per_m=0.1:0.5:0.1",
        "orbit duffing PHASE COIL",
        "orbit duffing PHASE --branch damping.c_n_s_per_m=0.3:0.4",
        "basins duffing --x-mm -1500:1500:5 --v -1:1:5",
        "threshold duffing --field damping.c_n_s_per_m=0.01:0.5:0.05 --of interwell",
    ] {
        let [force, sine] = TONES.map(|(tone, phase)| {
            let line = line.replace("PHASE", phase).replace("COIL", coil);
            stdout(&format!("{line} --set excitation={} --quiet", tone.replace('A', "0.05")))
        });
        assert!(force.lines().count() > 1 && force == sine, "{line}\n{force}\n{sine}");
    }
    let [force, sine] = TONES.map(|(tone, _)| {
        let noise = "Noise(rms_g:0.1,low_hz:0,high_hz:1,seed:3)";
        let drive = format!("Sum([{},{noise}])", tone.replace('A', "0.01"));
        stdout(&format!("escape duffing --runs 5 --set excitation={drive} --quiet"))
    });
    assert_eq!(force, sine);
}

/// A linear oscillator under a force: the speed of its steady motion is F w/|k - m w^2 + i c w|/sqrt(2), rms.
#[test]
fn cells_of_a_sweep_over_the_mass_have_the_acceleration_of_their_own_mass() {
    let mut draw = Draw(22);
    for _ in 0..6 {
        let (force, rate, c) = (draw.between(0.1, 2.0), draw.between(0.4, 2.0), draw.between(0.3, 0.6));
        let scene = format!(
            "(title: \"\", mass_g: 1000, mechanism: Linear(n_per_m: 1), \
             damping: Coefficient(c_n_s_per_m: {c:?}), start: At(x_mm: 0, v_m_per_s: 0), \
             excitation: Force(amplitude_n: {force:?}, frequency_rad_per_s: {rate:?}), \
             run: (duration_s: 400, settle_s: 300, tolerance: 1e-11))"
        );
        let masses: Vec<f64> = (0..8).map(|_| 1e3 * draw.between(0.1, 1.5)).collect();
        let sweep = Sweep::over_values("mass_g", masses.clone());
        let table = sweep.run(&Simulation::from_text("s", &scene).unwrap(), &Progress::none()).unwrap();
        for (mass_g, rms) in masses.iter().zip(table.numbers("rms_velocity_m_per_s").unwrap()) {
            let impedance = (1.0 - mass_g / 1e3 * rate * rate).hypot(c * rate);
            near_relative(*rms, force * rate / impedance / 2_f64.sqrt(), 1e-9);
        }
    }
}

#[test]
fn a_force_releases_the_mass_at_the_force_on_its_stop_whatever_the_mass() {
    let drive = "excitation=Force(amplitude_n: 0, frequency_rad_per_s: 18)";
    let document = changed("nominal-cubic", &[drive, "run.duration_s=2"]);
    let masses = vec![1.0, 15.2, 400.0];
    let question = Threshold {
        over: vec![("mass_g".to_owned(), masses.clone())],
        field: Some("excitation.amplitude_n=0:1:0.01".to_owned()),
        of: Onset::Release,
        ..Threshold::default()
    };
    let simulation = Simulation::new(&document).unwrap();
    let press = -simulation.mechanism().curve.force(document.scene.stops.travel_limit_mm().unwrap() / 1e3);
    let table = question.run(&simulation, &Progress::none()).unwrap();
    assert_eq!(table.rows(), masses.len());
    table.numbers("value").unwrap().iter().for_each(|value| near_relative(*value, press, 1e-14));
}

#[test]
fn the_phase_is_the_argument_of_the_cosine_and_a_motion_goes_on_in_a_scene_of_its_own() {
    for (drive, amplitude) in [
        ("Force(amplitude_n: 0.3, frequency_rad_per_s: 1.3, phase_deg: 40)", -0.3 / 2.0),
        ("Force(amplitude_n: -0.3, frequency_rad_per_s: 1.3, phase_deg: -200)", 0.3 / 2.0),
        ("Cosine(amplitude_m_per_s2: 0.2, frequency_rad_per_s: 0.7, phase_deg: 300)", 0.2),
    ] {
        let text = format!(
            "(title: \"\", mass_g: 2000, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), \
             excitation: {drive}, run: (duration_s: 20, tolerance: 1e-12))"
        );
        let document = Document::from_text("s.ron", &text, Files::default()).unwrap();
        let model = build(&document);
        for t in every(0.71, 20) {
            let argument = TAU * model.drive_phase(t).unwrap();
            near(model.base_acceleration(t), amplitude * argument.cos(), 1e-14);
        }
        let mut watch = Watch::new(&model);
        assert!(watch.advance(7.3));
        let here = watch.from_here().unwrap();
        let mut other = document.clone();
        other.scene = continued_scene(&document.scene, &here).unwrap();
        let continued = build(&other);
        for t in every(0.31, 20) {
            near(continued.base_acceleration(t), model.base_acceleration(watch.time() + t), 1e-13);
        }
        near(continued.start().0, watch.now().x, 1e-15);
    }
}

#[test]
fn a_sum_repeats_where_all_frequencies_are_of_one_unit() {
    let period =
        |parts: &str| preset("nominal-cubic", &[&format!("excitation=Sum([{parts}])")]).forcing_period();
    let cosine = |rate: &str| format!("Cosine(amplitude_m_per_s2: 1, frequency_rad_per_s: {rate})");
    let force = |rate: &str| format!("Force(amplitude_n: 0.1, frequency_rad_per_s: {rate})");
    let both = period(&format!("{}, {}", cosine("3"), force("2"))).unwrap();
    near_relative(both, TAU, 1e-15);
    near_relative(period(&force("0.5")).unwrap(), 2.0 * TAU, 1e-15);
    let mixed = format!("{}, Sine(frequency_hz: 1, amplitude_g: 1)", cosine("6.283"));
    assert_eq!(period(&mixed), None);
}

#[test]
fn a_comparison_takes_a_cosine_as_its_sine_and_refuses_a_force() {
    let environment = |drive: &str| changed("paper", &[&format!("excitation={drive}")]);
    let cosine = environment("Cosine(amplitude_m_per_s2: 3, frequency_rad_per_s: 20, phase_deg: 30)");
    let balanced = Simulation::preset("balanced").unwrap();
    let compared = |environment: &Document| {
        let environment = Some(Simulation::new(environment).unwrap());
        Compare { environment, ..Compare::default() }.scenes(&balanced, &Progress::none())
    };
    let (_, scene) = compared(&cosine).unwrap().remove(0);
    let sine = scene.scene().harmonic().unwrap();
    assert!(matches!(scene.scene().excitation, Excitation::Sine { .. }));
    assert_eq!((sine.frequency_hz, sine.amplitude()), (20.0 / TAU, 3.0 / STANDARD_GRAVITY));
    near(sine.phase_deg, 120.0, 1e-13);
    let refused = compared(&environment("Force(amplitude_n: 1, frequency_rad_per_s: 20)"));
    let said = refused.unwrap_err().to_string();
    assert!(said.contains("is a Force") && said.contains("`environment`"), "{said}");
}

#[test]
fn a_force_too_large_for_its_mass_is_a_fault_of_its_field() {
    let fault = |excitation: &str, path: &str| {
        let text = format!(
            "(title: \"\", mass_g: 1e-12, mechanism: Linear(n_per_m: 1), excitation: {excitation}, \
             run: (duration_s: 1))"
        );
        let scene = Document::from_text("s.ron", &text, Files::default()).unwrap().scene;
        let faults = check(&scene).faults;
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!(faults[0].field, path);
        assert!(faults[0].problem.contains("mass_g = 1e-12"), "{}", faults[0].problem);
    };
    let force = "Force(amplitude_n: 1e29, frequency_rad_per_s: 1)";
    fault(force, "excitation.amplitude_n");
    fault(&format!("Sum([Constant(accel_g: 1), {force}])"), "excitation.1.amplitude_n");
}
