//! Faults and warnings of a scene, all at once and each with its line.

use super::*;

#[test]
fn all_faults_come_at_once_each_with_its_line() {
    let error = faults(&[
        ("mass_g", "-1"),
        ("stops", "Rigid(\n      travel_limit_mm: 0, // at distance 0\n      restitution: 1.2)"),
        ("excitation", "Sine(frequency_hz: 0, amplitude_g: NaN)"),
        ("run", "(duration_s: 0, tolerance: 1e-20)"),
    ]);
    let lines: Vec<&str> = error.lines().collect();
    let expected = [
        "s.ron:4:5: mass_g = -1: must be 1e-15 to 1e15; give the proof mass in grams",
        "s.ron:6:7: stops.travel_limit_mm = 0: must be 1e-15 to 1e15; stops need room between them",
        "s.ron:7:7: stops.restitution = 1.2: must be 0 to 1; 0 keeps no speed",
        "s.ron:8:22: excitation.frequency_hz = 0: must be 1e-15 to 1e15; give a frequency in Hz",
        "s.ron:8:39: excitation.amplitude_g = NaN: must be -1e30 to 1e30; ",
        "s.ron:9:11: run.duration_s = 0: must be 1e-15 to 1e9; ",
        "s.ron:9:26: run.tolerance = 1e-20: must be 1e-14 to 0.001; ",
    ];
    assert_eq!(lines.len(), expected.len(), "{error}");
    for (line, expected) in lines.iter().zip(expected) {
        assert!(line.starts_with(expected), "{line}\n  wants {expected}");
    }
}

#[test]
fn every_relation_between_fields_is_checked() {
    let sixteen = format!("Polynomial(coefficients_si: [{}])", "1,".repeat(16));
    document(&[("mechanism", &sixteen)]).check().unwrap();
    let seventeen = format!("Polynomial(coefficients_si: [{}])", "1,".repeat(17));
    let rigid = ("stops", "Rigid(travel_limit_mm: 2, restitution: 0.5)");
    let axis = |axis: &'static str| [rigid, ("sweep", axis)];
    for (changes, expected) in [
        (
            &[("mechanism", seventeen.as_str())][..],
            "s.ron:5:27: mechanism.coefficients_si = a list of 17: must have 1 to 16",
        ),
        (&[("mechanism", "Polynomial(coefficients_si: [])")], "a list of 0: must have 1 to 16"),
        (
            &[("mechanism", "Pieces(ends_m: [0, 1], pieces: [])")],
            "pieces = a list of 0: must have 1 to 10000",
        ),
        (
            &[("mechanism", "Pieces(ends_m: [0], pieces: [(coefficients_si: [1])])")],
            "mechanism.ends_m = a list of 1: 1 pieces have 2 ends",
        ),
        (
            &[("mechanism", "Pieces(ends_m: [0, 1], pieces: [(coefficients_si: [])])")],
            "mechanism.pieces.0.coefficients_si = a list of 0: must have 1 to 16",
        ),
        (
            &[("mechanism", "Pieces(ends_m: [0, 1], pieces: [(coefficients_si: [NaN])])")],
            "mechanism.pieces.0 = NaN: must be -1e200 to 1e200",
        ),
        (
            &[("mechanism", "Pieces(ends_m: [1, 1], pieces: [(coefficients_si: [1])])")],
            "mechanism.ends_m = 1: must ascend",
        ),
        (
            &[(
                "mechanism",
                "Pieces(ends_m: [-1, 0, 1], pieces: [(coefficients_si: [1]), (coefficients_si: [2])])",
            )],
            "the force steps from 1 to 2 N at x = 0 m; it must be continuous",
        ),
        (
            &[("mechanism", "Pieces(ends_m: [0, 1], pieces: [(coefficients_si: [1])], error_n: -1)")],
            "mechanism.error_n = -1: must be 0 to 1e30",
        ),
        (&[("mechanism", "Table(path: \"\")")], "mechanism.path = \"\": name a CSV file"),
        (
            &[("mechanism", "Table(path: \"a\", tolerance: 1)")],
            "mechanism.tolerance = 1: must be 1e-10 to 0.1",
        ),
        (&[("stops", "Uneven()")], "stops = Uneven(): give left_mm, right_mm or both"),
        (&[("stops", "Uneven(left_mm: 1)")], "give restitution_left or restitution_right"),
        (
            &[("stops", "Uneven(left_mm: -2e15, restitution_left: 1)")],
            "stops.left_mm = -2e15: must be -1e15 to 1e15; give how far left of x = 0",
        ),
        (
            &[("stops", "Uneven(left_mm: -1, right_mm: 0.5, restitution_left: 1)")],
            "stops.right_mm = 0.5: the right stop, at 0.5 mm, must stand right of the left one, at 1 mm \
             (stops.left_mm = -1)",
        ),
        (
            &[("stops", "Uneven(left_mm: 0, right_mm: 0, restitution_left: 1)")],
            "stops.right_mm = 0: the right stop, at 0 mm, must stand right of the left one, at 0 mm",
        ),
        (
            &[("stops", "Uneven(left_mm: 1, right_mm: -0.9999999, restitution_left: 1)")],
            "leave a room of at least 1e-6 of the farther distance",
        ),
        (
            &[
                ("stops", "Uneven(left_mm: -1, right_mm: 3, restitution_left: 1)"),
                ("start", "At(x_mm: 0.5, v_m_per_s: 0)"),
            ],
            "start.x_mm = 0.5: lies outside the left stop at 1 mm (stops.left_mm)",
        ),
        (
            &[
                ("stops", "Uneven(left_mm: 0, restitution_left: 1)"),
                ("start", "At(x_mm: -0.5, v_m_per_s: 0)"),
            ],
            "start.x_mm = -0.5: lies outside the left stop at 0 mm (stops.left_mm)",
        ),
        (
            &[rigid, ("start", "At(x_mm: 3, v_m_per_s: 0)")],
            "start.x_mm = 3: lies outside the right stop at 2 mm (stops.travel_limit_mm)",
        ),
        (
            &[rigid, ("start", "At(x_mm: -3, v_m_per_s: 0)")],
            "start.x_mm = -3: lies outside the left stop at -2 mm",
        ),
        (
            &[("stops", "Uneven(left_mm: 1, restitution_left: 1)"), ("start", "At(x_mm: -3, v_m_per_s: 0)")],
            "(stops.left_mm)",
        ),
        (
            &[("run", "(duration_s: 1, settle_s: 1.5)")],
            "run.settle_s = 1.5: must not exceed run.duration_s = 1",
        ),
        (&[("run", "(duration_s: 1e9, settle_s: -1)")], "run.settle_s = -1: must be 0 to 1e9"),
        (&[("app", "(speed: 0)")], "app.speed = 0: must be 1e-15 to 1000"),
        (&[("app", "(stops_when_on: Uneven())")], "app.stops_when_on = Uneven()"),
        (
            &axis("[(field: \"stops.left_mm\", from: 1, to: 2, step: 1)]"),
            "sweep.0.field = \"stops.left_mm\": the scene has no numeric field `stops.left_mm`; did \
             you mean `stops.travel_limit_mm`? It has: mass_g, mechanism.linear_n_per_m,",
        ),
        (
            &axis("[(field: \"mass_g\", from: 1, to: 2, step: 0)]"),
            "sweep.0.step = 0: must be 1e-200 to 1e200",
        ),
        (&axis("[(field: \"mass_g\", from: 1, to: 2, step: -1)]"), "sweep.0.step = -1: must be 1e-200"),
        (
            &axis("[(field: \"mass_g\", from: 2, to: 1, step: 1)]"),
            "sweep.0.to = 1: the end lies below the beginning",
        ),
        (&axis("[(field: \"mass_g\", from: inf, to: 1, step: 1)]"), "sweep.0.from = inf: must be -1e200"),
        (
            &axis("[(field: \"mass_g\", from: 0, to: 1, step: 1)]"),
            "sweep.0.from = 0: mass_g takes 1e-15 to 1e15, not 0",
        ),
        (
            &axis("[(field: \"stops.restitution\", from: 0, to: 1.5, step: 0.5)]"),
            "sweep.0.to = 1.5: stops.restitution takes 0 to 1, not 1.5",
        ),
        (
            &axis("[(field: \"mass_g\", from: 1, to: 2e7, step: 1)]"),
            "20000000 values are more than an axis may have",
        ),
        (
            &axis(
                "[(field: \"mass_g\", from: 1, to: 2, step: 1), (field: \"mass_g\", from: 1, to: 2, \
                 step: 1)]",
            ),
            "mass_g: is swept twice",
        ),
        (&axis("[(field: \"sweep.0.from\", from: 1, to: 2, step: 1)]"), "no numeric field `sweep.0.from`"),
    ] {
        let error = faults(changes);
        assert!(error.contains(expected), "{changes:?}\n  gives {error}\n  wants {expected}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
    document(&[rigid, ("start", "At(x_mm: 2, v_m_per_s: 0)")]).check().unwrap();
}

#[test]
fn a_settle_time_moves_with_a_duration_that_is_set() {
    let settle = |run: &str, arguments: &[&str]| {
        let mut document = document(&[("run", run)]);
        arguments.iter().for_each(|argument| document.set(argument).unwrap());
        let said = document.settle_within();
        (document.check().is_ok(), document.scene.run.settle_s, said)
    };
    let (valid, moved, said) = settle("(duration_s: 10, settle_s: 5)", &["run.duration_s=4"]);
    assert!(valid && moved.is_none());
    let said = said.unwrap();
    assert!(
        ["settle_s = 5", "--set run.duration_s=4", "2 s"].iter().all(|word| said.contains(word)),
        "{said}"
    );
    // It lies within; it was itself set; nothing was.
    for (run, arguments, valid) in [
        ("(duration_s: 10, settle_s: 5)", &["run.duration_s=6"][..], true),
        ("(duration_s: 10, settle_s: 5)", &["run.duration_s=4", "run.settle_s=5"][..], false),
        ("(duration_s: 10)", &["run=(duration_s: 4, settle_s: 5)"][..], false),
        ("(duration_s: 4, settle_s: 5)", &[][..], false),
        ("(duration_s: 10, settle_s: 5)", &["run.duration_s=-1"][..], false),
    ] {
        let found = settle(run, arguments);
        assert_eq!((found.0, found.2), (valid, None), "{run} {arguments:?}");
    }
}

#[test]
fn what_is_valid_but_hardly_meant_is_a_warning() {
    for (changes, expected) in [
        (("damping", "Ratio(2.3)"), "s.ron: damping.xi = 2.3: above 1"),
        (
            ("excitation", "Sine(frequency_hz: 0.01, amplitude_g: 1)"),
            "shorter than a forcing period of 100 s",
        ),
        (
            ("excitation", "Sum([AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 1, over_s: 300)])"),
            "the ramp takes 300 s and the run ends after 10 s",
        ),
        (
            ("stops", "Uneven(left_mm: 1, restitution_left: 1, restitution_right: 1)"),
            "stops.restitution_right has no effect",
        ),
    ] {
        let warnings = document(&[changes]).check().unwrap();
        assert!(warnings.len() == 1 && warnings[0].contains(expected), "{warnings:?}");
    }
}

#[test]
fn a_million_faults_are_counted() {
    // Work that grows with their square would not end within a day.
    let list = format!("Polynomial(coefficients_si: [{}])", "NaN,".repeat(1_000_000));
    let error = faults(&[("mechanism", &list)]);
    assert_eq!(error.lines().count(), 51);
    assert!(error.ends_with("s.ron: and 999951 more"), "{error}");
    let axes = "(field:\"mass_g\",from:1,to:2,step:1),".repeat(100_000);
    assert!(
        faults(&[("sweep", &format!("[{axes}]"))])
            .contains("sweep = a list of 100000: must have at most 10 axes")
    );
}

#[test]
fn more_sines_than_fit_into_memory_are_refused() {
    let sum = |term: &str| faults(&[("excitation", &format!("Sum([{}])", term.repeat(60_000)))]);
    assert!(sum("Noise(rms_g:1,low_hz:9,high_hz:inf,seed:1),").ends_with("and 59950 more"));
    assert!(
        sum("Chirp(from_hz:1,to_hz:2,over_s:3,amplitude_g:1),").contains("a sum of 60000 sines: must have")
    );
    assert!(sum("Noise(rms_g:1,low_hz:1,high_hz:9,seed:1,lines:4096),").contains(
        "excitation = a sum of 245760000 sines: must have at most 16384, the lines of noises included"
    ));
}
