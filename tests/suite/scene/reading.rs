//! Reading and writing of every variant, and the place of an error.

use interwell::scene::*;

use super::*;

#[test]
fn the_smallest_scene_has_the_documented_defaults() {
    let scene = document(&[]).scene;
    let expected = Scene {
        title: "t".into(),
        notes: String::new(),
        mass_g: 15.2,
        mechanism: Mechanism::Cubic { linear_n_per_m: -40.0, cubic_n_per_m3: 8.2e5 },
        damping: Damping::None,
        stops: Stops::None,
        transducer: Default::default(),
        excitation: Excitation::None,
        start: Start::Rest,
        run: RunSettings { duration_s: 10.0, settle_s: None, tolerance: 1e-9, recurrence: true },
        sweep: vec![],
        app: None,
    };
    assert_eq!(scene, expected);
    assert_eq!(document(&[]).check(), Ok(vec![]));
    reads_back(&scene);
}

#[test]
fn every_mechanism_reads_and_writes() {
    let table = |tolerance| Mechanism::Table { path: "a b.csv".into(), tolerance };
    for (text, mechanism) in [
        (
            "DoubleWell(equilibrium_mm: 7, barrier_mj: 0.5)",
            Mechanism::DoubleWell { equilibrium_mm: 7.0, barrier_mj: 0.5 },
        ),
        (
            "Polynomial(coefficients_si: [0, -1.5, 0, 1e6])",
            Mechanism::Polynomial { coefficients_si: vec![0.0, -1.5, 0.0, 1e6] },
        ),
        ("Polynomial(coefficients_si: [0])", Mechanism::Polynomial { coefficients_si: vec![0.0] }),
        ("Table(path: \"a b.csv\")", table(1e-4)),
        (
            "Pieces(ends_m: [-inf, 0, inf], pieces: [(coefficients_si: [1, 2]), (origin_m: 1, \
             coefficients_si: [3, 2])])",
            Mechanism::Pieces {
                ends_m: vec![f64::NEG_INFINITY, 0.0, f64::INFINITY],
                pieces: vec![
                    ForcePiece { origin_m: 0.0, coefficients_si: vec![1.0, 2.0] },
                    ForcePiece { origin_m: 1.0, coefficients_si: vec![3.0, 2.0] },
                ],
                error_n: 0.0,
            },
        ),
        ("Linear(n_per_m: 30)", Mechanism::Linear { n_per_m: 30.0 }),
        (
            "Sum([Linear(n_per_m: -3), Magnet(strength_n_mm4: 20, gap_mm: 5), Table(path: \"a b.csv\")])",
            Mechanism::Sum(vec![
                Mechanism::Linear { n_per_m: -3.0 },
                Mechanism::Magnet { strength_n_mm4: 20.0, gap_mm: 5.0, moments: Moments::Facing },
                table(1e-4),
            ]),
        ),
        (
            "Magnet(strength_n_mm4: -20, gap_mm: 5, moments: Transverse)",
            Mechanism::Magnet { strength_n_mm4: -20.0, gap_mm: 5.0, moments: Moments::Transverse },
        ),
        ("Table(path: \"a b.csv\", tolerance: 1e-6)", table(1e-6)),
    ] {
        let document = document(&[("mechanism", text)]);
        assert_eq!(document.scene.mechanism, mechanism);
        document.check().unwrap();
        reads_back(&document.scene);
    }
}

#[test]
fn every_damping_and_stop_and_start_reads_and_writes() {
    for (text, damping) in [
        ("None", Damping::None),
        ("Ratio(0.023)", Damping::Ratio(0.023)),
        ("Coefficient(c_n_s_per_m: 0.05)", Damping::Coefficient { c_n_s_per_m: 0.05 }),
    ] {
        let document = document(&[("damping", text)]);
        assert_eq!(document.scene.damping, damping);
        document.check().unwrap();
        reads_back(&document.scene);
    }
    let uneven = |left_mm, right_mm, restitution_left, restitution_right| Stops::Uneven {
        left_mm,
        right_mm,
        restitution_left,
        restitution_right,
    };
    for (text, stops) in [
        ("None", Stops::None),
        (
            "Rigid(travel_limit_mm: 1.5, restitution: 0.36)",
            Stops::Rigid { travel_limit_mm: 1.5, restitution: 0.36 },
        ),
        ("Uneven(left_mm: 1, restitution_left: 1)", uneven(Some(1.0), None, Some(1.0), None)),
        (
            "Uneven(left_mm: 1, right_mm: Some(2), restitution_right: 0)",
            uneven(Some(1.0), Some(2.0), None, Some(0.0)),
        ),
        (
            "Uneven(left_mm: -1, right_mm: 3, restitution_left: 0.5)",
            uneven(Some(-1.0), Some(3.0), Some(0.5), None),
        ),
        ("Uneven(right_mm: 0, restitution_right: 1)", uneven(None, Some(0.0), None, Some(1.0))),
    ] {
        let document = document(&[("stops", text)]);
        assert_eq!(document.scene.stops, stops);
        document.check().unwrap();
        reads_back(&document.scene);
    }
    for (text, start) in [
        ("Rest", Start::Rest),
        ("At(x_mm: -3, v_m_per_s: 0.1)", Start::At { x_mm: -3.0, v_m_per_s: 0.1, electrical: 0.0 }),
    ] {
        let document = document(&[("start", text)]);
        assert_eq!(document.scene.start, start);
        document.check().unwrap();
        reads_back(&document.scene);
    }
}

#[test]
fn every_excitation_reads_and_writes() {
    let sine = |phase_deg| Excitation::Sine { frequency_hz: 3.0, amplitude_g: -1.0, phase_deg };
    let (frequency_rad_per_s, phase_deg) = (3.0, 90.0);
    let cosine = Excitation::Cosine { amplitude_m_per_s2: -2.0, frequency_rad_per_s, phase_deg };
    let force = Excitation::Force { amplitude_n: 0.4, frequency_rad_per_s, phase_deg: 0.0 };
    let constant = Excitation::Constant { accel_g: 0.1 };
    let ramp = Excitation::AmplitudeRamp { frequency_hz: 3.0, from_g: 0.0, to_g: 2.0, over_s: 10.0 };
    for (text, excitation) in [
        ("None", Excitation::None),
        ("Constant(accel_g: 0.1)", constant.clone()),
        ("Sine(frequency_hz: 3, amplitude_g: -1)", sine(0.0)),
        ("Sine(frequency_hz: 3, amplitude_g: -1, phase_deg: 90)", sine(90.0)),
        ("Cosine(amplitude_m_per_s2: -2, frequency_rad_per_s: 3, phase_deg: 90)", cosine),
        ("Force(amplitude_n: 0.4, frequency_rad_per_s: 3)", force),
        ("AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 10)", ramp.clone()),
        (
            "Chirp(from_hz: 1, to_hz: 9, over_s: 5, amplitude_g: 0.5)",
            Excitation::Chirp { from_hz: 1.0, to_hz: 9.0, over_s: 5.0, amplitude_g: 0.5 },
        ),
        (
            "Noise(rms_g: 0.5, low_hz: 1, high_hz: 9, seed: 7)",
            Excitation::Noise { rms_g: 0.5, low_hz: 1.0, high_hz: 9.0, seed: 7, lines: 256 },
        ),
        ("Sum([])", Excitation::Sum(vec![])),
        (
            "Sum([Constant(accel_g: 0.1), Sum([Sine(frequency_hz: 3, amplitude_g: -1)]), None])",
            Excitation::Sum(vec![constant, Excitation::Sum(vec![sine(0.0)]), Excitation::None]),
        ),
    ] {
        let document = document(&[("excitation", text)]);
        assert_eq!(document.scene.excitation, excitation);
        document.check().unwrap();
        reads_back(&document.scene);
    }
}

#[test]
fn run_sweep_and_window_hints_read_and_write() {
    let document = document(&[
        ("notes", "\"One\n        line.\n\n\n   A \\\"second\\\" one.\n\""),
        ("stops", "Rigid(travel_limit_mm: 2, restitution: 0.5)"),
        ("run", "(duration_s: 10, settle_s: 10, tolerance: 1e-14, recurrence: false)"),
        ("sweep", "[(field: \"stops.travel_limit_mm\", from: 0.5, to: 7, step: 0.25)]"),
        ("app", "(layout: Look, speed: 0.1, stops_when_on: Rigid(travel_limit_mm: 1.5, restitution: 0.36))"),
    ]);
    document.check().unwrap();
    let scene = &document.scene;
    assert_eq!(scene.notes, "One line.\n\nA \"second\" one.");
    assert_eq!(
        scene.run,
        RunSettings { duration_s: 10.0, settle_s: Some(10.0), tolerance: 1e-14, recurrence: false }
    );
    assert_eq!(scene.sweep[0].to, 7.0);
    let app = scene.app.as_ref().unwrap();
    assert_eq!((app.layout, app.speed), (Some(Layout::Look), Some(0.1)));
    assert_eq!(app.stops_when_on, Some(Stops::Rigid { travel_limit_mm: 1.5, restitution: 0.36 }));
    reads_back(scene);
}

#[test]
fn the_coefficient_limit_is_that_of_the_force_curve() {
    assert_eq!(MAX_COEFFICIENTS, interwell::mechanics::ForceCurve::MAX_COEFFICIENTS);
}

#[test]
fn structural_errors_have_a_place_and_the_known_names() {
    for (changes, expected) in [
        (
            ("mechanism", "Springs(k: 2.7)"),
            "s.ron:5:16: mechanism: unknown choice `Springs` in Mechanism; known: Flexures, Cubic, \
             DoubleWell, Polynomial, Pieces, Table",
        ),
        (("mechanism", "Flexures(preload_mm: 2.7)"), "`thickness_mm` is missing in Flexures"),
        (
            ("mechanism", "Flexures(parallel: (count: 2, length: 26))"),
            "unknown field `length` in FlexureGroup; known: count, length_mm, width_mm",
        ),
        (
            ("stops", "Soft(travel_limit_mm: 1)"),
            "s.ron:6:12: stops: unknown choice `Soft` in Stops; known: None, Rigid, Uneven, Hertz",
        ),
        (("stops", "Hertz(travel_limit_mm: 1)"), "`loss_s_per_m` is missing in Hertz"),
        (
            ("excitation", "Sum([\n  Shock(peak_g: 1)])"),
            "s.ron:7:3: excitation.0: unknown choice `Shock` in Excitation; known: None, Constant, Sine, \
             Cosine, Force, AmplitudeRamp, Chirp, Noise, Recorded, Sum",
        ),
        (("excitation", "Noise(seed: 1)"), "`rms_g` is missing in Noise"),
        (
            ("excitation", "Recorded(path: \"walking.csv\", record: None)"),
            "unknown field `record` in Recorded; known: path",
        ),
        (
            ("stops", "Rigid(\n  travel_mm: 1)"),
            "s.ron:7:3: unknown field `travel_mm` in Rigid; known: travel_limit_mm, restitution",
        ),
        (("stops", "Rigid(travel_limit_mm: 1)"), "s.ron:6:36: `restitution` is missing in Rigid"),
        (
            ("colour", "3"),
            "s.ron:6:5: unknown field `colour` in Scene; known: title, notes, mass_g, mechanism,",
        ),
        (("mass_g", "\"heavy\""), "s.ron:5:13: mass_g: expected a number"),
        (("title", "5"), "title: expected "),
        (("mass_g", "1, mass_g: 2"), "`mass_g` is given twice in Scene"),
        (("damping", "Ratio()"), "s.ron:6:20: damping: expected a number"),
        (("damping", "0.023"), "s.ron:6:14: damping: expected one of None, Ratio, Coefficient"),
        (("transducer", "8"), "transducer: expected one of None, Electromagnetic, Piezoelectric"),
        (("excitation", "[Sine()]"), "excitation: expected one of None, Constant, Sine"),
        (
            ("mass_g", "15,2"),
            "s.ron:5:16: mass_g: expected a name, found `2` (a decimal is written with a point)",
        ),
        (("mass_g", "15 title: \"t\""), "expected a comma before this"),
        (
            ("tolerance", "None"),
            "unknown field `tolerance` in Scene; known: title, notes, mass_g, mechanism,",
        ),
        (("app", "(layout: Big)"), "app.layout: unknown choice `Big` in Layout; known: Look, Study, Map"),
    ] {
        let error = refused(&text(&[changes]));
        assert!(error.contains(expected), "{changes:?}\n  gives {error}\n  wants {expected}");
        assert_eq!(error.lines().count(), 1);
    }
    assert!(refused("(title: \"t\")").contains("`mass_g` is missing in Scene"));
    assert!(refused(&(text(&[]) + "x")).contains("s.ron:7:1: "), "{}", refused(&(text(&[]) + "x")));
}

#[test]
fn unknown_names_come_with_whatever_else_is_wrong() {
    let text = "(\n  colour: (red: [1, 2], \"é\": 3), mass_g: -1,\n  mechanism: Cubic(linear: 1, \
        linear_n_per_m: -40, \
        cubic_n_per_m3: 8e5),\n  run: (duration_s: 1, speed: 3),\n  stops: Rigid(travel_limit_mm: 0, \
        restitution: 2),\n)";
    let error = refused(text);
    let lines: Vec<&str> = error.lines().collect();
    for (line, wanted) in lines.iter().zip([
        "s.ron:2:3: unknown field `colour` in Scene",
        "s.ron:3:20: unknown field `linear` in Cubic",
        "s.ron:4:24: unknown field `speed` in Run",
        "s.ron:2:34: mass_g = -1: must be",
        "s.ron:5:16: stops.travel_limit_mm = 0",
        "s.ron:5:36: stops.restitution = 2",
    ]) {
        assert!(line.starts_with(wanted), "{line}\n  wants {wanted}");
    }
    assert_eq!(lines.len(), 6, "{error}");
    // What cannot be read at all ends it.
    let error = refused(&text.replace("speed: 3", "speed: 3))"));
    assert_eq!(error.lines().count(), 3, "{error}");
    let many: String = (0..1000).map(|i| format!("a{i}: {i},")).collect();
    assert!(refused(&format!("({many})")).lines().count() <= 51);
}

#[test]
fn a_title_left_out_is_the_name_of_the_file() {
    let untitled = |name: &str, more: &str| {
        let text = format!(
            "({more} mass_g: 1, mechanism: Cubic(linear_n_per_m: 1, cubic_n_per_m3: 0), run: (duration_s: 1))"
        );
        Document::from_text(name, &text, Files::default()).unwrap().scene
    };
    for (name, title) in [("a/two stops.ron", "two stops"), ("plain", "plain"), ("a.b.ron", "a.b")] {
        let scene = untitled(name, "");
        assert_eq!(scene.title, title);
        reads_back(&scene);
    }
    assert_eq!(untitled("a.ron", "title: \"\",").title, "");
}

#[test]
fn an_axis_has_steps_or_values() {
    let sweep = |axis: &str| text(&[("sweep", &format!("[(field: \"mass_g\", {axis})]"))]);
    let read = |axis: &str| Document::from_text("s.ron", &sweep(axis), Files::default()).unwrap();
    let document = read("values: [3, 0.5, 3]");
    document.check().unwrap();
    reads_back(&document.scene);
    assert_eq!(document.axes::<&str>(&[]).unwrap()[0].values, [3.0, 0.5, 3.0]);
    for axis in [
        "from: 1",
        "from: 1, to: 2",
        "values: []",
        "from: 1, to: 2, step: 1, values: [1]",
        "values: [1], step: 1",
    ] {
        let error = refused(&sweep(axis));
        assert!(error.contains("`values`") && error.lines().count() == 1, "{axis}: {error}");
    }
    let error = read("values: [1, -3]").check().unwrap_err().to_string();
    assert!(error.contains("sweep.0.values") && error.contains("-3"), "{error}");
    let mut document = read("values: [1, 2]");
    document.set("sweep.0.values.1=5").unwrap();
    assert_eq!(document.scene.sweep[0].values, [1.0, 5.0]);
}

#[test]
fn hostile_text_is_refused_without_overflow() {
    for empty in ["", " \n\t ", "\u{feff}"] {
        assert!(refused(empty).contains("is empty"));
    }
    for open in ["(", "[", "{", "\"", "/*", "r#", "Some(", "Sum(["] {
        let deep = open.repeat(2 << 20 >> open.len().ilog2());
        for text in [deep.clone(), text(&[("excitation", &deep)]), text(&[("unknown", &deep)])] {
            assert!(refused(&text).len() < 700);
        }
    }
    let (name, many) = ("n".repeat(1 << 20), "b:1,".repeat(1 << 19));
    assert!(refused(&format!("({name}:({name}:({many})")).len() < 700);
    assert!(refused(&"[".repeat(10_000_000)).contains("10000000 bytes are more than"));
    let sums = |n: usize| text(&[("excitation", &format!("{}{}", "Sum([".repeat(n), "])".repeat(n)))]);
    assert!(refused(&sums(1000)).contains("nested deeper"));
    reads_back(&Document::from_text("s", &sums(20), Files::default()).unwrap().scene);
}
