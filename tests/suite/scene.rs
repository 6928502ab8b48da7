//! Scenes: every variant reads and writes, every fault is found and placed, every field can be set.

use interwell::scene::*;
use proptest::prelude::*;

/// A small valid scene with some fields given another text.
fn text(changes: &[(&str, &str)]) -> String {
    let mut fields = vec![
        ("title", "\"t\""),
        ("mass_g", "15.2"),
        ("mechanism", "Cubic(linear_n_per_m: -40, cubic_n_per_m3: 8.2e5)"),
        ("run", "(duration_s: 10)"),
    ];
    for (name, value) in changes {
        fields.retain(|(own, _)| own != name);
        fields.push((name, value));
    }
    let lines: Vec<String> = fields.iter().map(|(name, value)| format!("    {name}: {value},\n")).collect();
    format!("(\n{})\n", lines.concat())
}

fn document(changes: &[(&str, &str)]) -> Document {
    Document::from_text("s.ron", &text(changes), Files::default()).unwrap()
}

fn refused(text: &str) -> String {
    Document::from_text("s.ron", text, Files::default()).unwrap_err().to_string()
}

fn faults(changes: &[(&str, &str)]) -> String {
    document(changes).check().unwrap_err().to_string()
}

fn reads_back(scene: &Scene) {
    let written = write(scene);
    let again = Document::from_text("again", &written, Files::default());
    assert_eq!(&again.unwrap_or_else(|error| panic!("{error}\n{written}")).scene, scene, "{written}");
}

// One golden scene a variant.

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
        excitation: Excitation::None,
        start: Start::Rest,
        run: Run { duration_s: 10.0, settle_s: None, tolerance: 1e-9, recurrence: true },
        sweep: vec![],
        transducer: Transducer::None,
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
    ] {
        let document = document(&[("stops", text)]);
        assert_eq!(document.scene.stops, stops);
        document.check().unwrap();
        reads_back(&document.scene);
    }
    for (text, start) in
        [("Rest", Start::Rest), ("At(x_mm: -3, v_m_per_s: 0.1)", Start::At { x_mm: -3.0, v_m_per_s: 0.1 })]
    {
        let document = document(&[("start", text)]);
        assert_eq!(document.scene.start, start);
        document.check().unwrap();
        reads_back(&document.scene);
    }
}

#[test]
fn every_excitation_reads_and_writes() {
    let sine = |phase_deg| Excitation::Sine { frequency_hz: 3.0, amplitude_g: -1.0, phase_deg };
    let constant = Excitation::Constant { accel_g: 0.1 };
    let ramp = Excitation::AmplitudeRamp { frequency_hz: 3.0, from_g: 0.0, to_g: 2.0, over_s: 10.0 };
    for (text, excitation) in [
        ("None", Excitation::None),
        ("Constant(accel_g: 0.1)", constant.clone()),
        ("Sine(frequency_hz: 3, amplitude_g: -1)", sine(0.0)),
        ("Sine(frequency_hz: 3, amplitude_g: -1, phase_deg: 90)", sine(90.0)),
        ("AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 10)", ramp.clone()),
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
        ("transducer", "None"),
        ("app", "(layout: Look, speed: 0.1, stops_when_on: Rigid(travel_limit_mm: 1.5, restitution: 0.36))"),
    ]);
    document.check().unwrap();
    let scene = &document.scene;
    assert_eq!(scene.notes, "One line.\n\nA \"second\" one.");
    assert_eq!(
        scene.run,
        Run { duration_s: 10.0, settle_s: Some(10.0), tolerance: 1e-14, recurrence: false }
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

// What is refused while reading.

#[test]
fn structural_errors_have_a_place_and_the_known_names() {
    for (changes, expected) in [
        (
            ("mechanism", "Flexures(preload_mm: 2.7)"),
            "s.ron:4:16: mechanism: unknown choice `Flexures` in Mechanism; known: Cubic, DoubleWell, Polynomial, Table",
        ),
        (
            ("stops", "Hertz(travel_limit_mm: 1)"),
            "s.ron:6:12: stops: unknown choice `Hertz` in Stops; known: None, Rigid, Uneven",
        ),
        (
            ("excitation", "Sum([\n  Chirp(from_hz: 1)])"),
            "s.ron:7:3: excitation.0: unknown choice `Chirp` in Excitation; known: None, Constant, Sine, AmplitudeRamp, Sum",
        ),
        (("excitation", "Noise(seed: 1)"), "unknown choice `Noise` in Excitation; known: None, "),
        (("excitation", "Recorded(path: \"a\")"), "unknown choice `Recorded` in Excitation; known: None, "),
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
        (("transducer", "Coil(theta: 1)"), "unknown choice `Coil` in Transducer; known: None"),
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
fn hostile_text_is_refused_quickly_and_without_overflow() {
    let start = std::time::Instant::now();
    for empty in ["", " \n\t ", "\u{feff}"] {
        assert!(refused(empty).contains("is empty"));
    }
    for open in ["(", "[", "{", "\"", "/*", "r#", "Some(", "Sum(["] {
        let deep = open.repeat(2 << 20 >> open.len().ilog2());
        for text in [deep.clone(), text(&[("excitation", &deep)]), text(&[("unknown", &deep)])] {
            assert!(refused(&text).len() < 700);
        }
    }
    assert!(refused(&"[".repeat(10_000_000)).contains("10000000 bytes are more than"));
    let sums = |n: usize| text(&[("excitation", &format!("{}{}", "Sum([".repeat(n), "])".repeat(n)))]);
    assert!(refused(&sums(1000)).contains("nested deeper"));
    reads_back(&Document::from_text("s", &sums(20), Files::default()).unwrap().scene);
    assert!(start.elapsed().as_secs() < 20, "took {:?}", start.elapsed());
}

// Files.

#[test]
fn a_scene_is_found_or_the_message_says_what_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let error = |spec: &str| Document::load(spec).unwrap_err().to_string();
    assert!(
        error(&at("none.ron"))
            .contains("none.ron: no such file, and no built-in scene of that name; built in: paper,")
    );
    assert!(error(&at("")).contains("is a directory"));
    std::fs::write(at("noise.ron"), b"(title: \"\n\xff\xfe\0").unwrap();
    assert!(error(&at("noise.ron")).contains("is not text: byte 11 (line 2)"), "{}", error(&at("noise.ron")));
    std::fs::write(at("empty.ron"), "").unwrap();
    assert!(error(&at("empty.ron")).contains("empty.ron:1:1: the file is empty"));
    std::fs::write(at("large.ron"), "(".repeat(LARGEST_SCENE + 1)).unwrap();
    assert!(error(&at("large.ron")).contains("larger than 4 MB"));
    std::fs::write(at("good.ron"), format!("\u{feff}{}", text(&[]).replace('\n', "\r\n"))).unwrap();
    let good = Document::load(&at("good.ron")).unwrap();
    assert_eq!(good.files.folder.as_deref(), Some(folder.path()));
    reads_back(&good.scene);
}

#[test]
fn tables_are_found_beside_the_scene_then_among_the_embedded_ones() {
    let folder = tempfile::tempdir().unwrap();
    let beside = Files::beside(&folder.path().join("scene.ron"));
    let error = |files: &Files, path: &str| files.read(path).unwrap_err().to_string();
    std::fs::write(folder.path().join("own.csv"), "x_m,force_n\n").unwrap();
    assert_eq!(beside.read("own.csv").unwrap(), "x_m,force_n\n");
    assert_eq!(beside.read("force_dl2.7.csv").unwrap(), TABLES[0].text);
    std::fs::write(folder.path().join("force_dl2.7.csv"), "mine").unwrap();
    assert_eq!(beside.read("force_dl2.7.csv").unwrap(), "mine");
    assert!(error(&beside, "gone.csv").contains("gone.csv; embedded tables: force_dl2.7.csv"));
    assert!(error(&beside, ".").contains("is a directory"));
    std::fs::write(folder.path().join("bin.csv"), b"\xff").unwrap();
    assert!(error(&beside, "bin.csv").contains("bin.csv: is not text"));

    let embedded = Files::default();
    assert_eq!(embedded.read("force_dl2.7.csv").unwrap(), TABLES[0].text);
    assert!(error(&embedded, "own.csv").contains("give an absolute path"));
    let absolute = folder.path().join("own.csv").display().to_string();
    assert_eq!(embedded.read(&absolute).unwrap(), "x_m,force_n\n");
}

#[test]
fn presets_check_out_read_back_and_run_from_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    for (name, contents) in export() {
        std::fs::write(folder.path().join(name), contents).unwrap();
    }
    for preset in PRESETS {
        let document = Document::load(preset.name).unwrap();
        assert_eq!(document.check(), Ok(vec![]), "{}", preset.name);
        assert!(!document.scene.notes.is_empty() && !document.scene.notes.contains("  "));
        reads_back(&document.scene);
        document.axes::<&str>(&[]).unwrap();
        let path = folder.path().join(format!("{}.ron", preset.name)).display().to_string();
        let written = Document::load(&path).unwrap();
        assert_eq!(written.scene, document.scene);
        for files in [document.files, written.files] {
            if let Mechanism::Table { path, .. } = &document.scene.mechanism {
                files.read(path).unwrap();
            }
        }
    }
    let map = Document::load("nominal-cubic").unwrap().axes::<&str>(&[]).unwrap();
    assert_eq!((map[0].values.len(), map[1].values.len()), (41, 101));
    assert_eq!(*map[0].values.last().unwrap(), 8.0);
}

// What is out of range, and how the parts fit together.

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
            "s.ron:4:22: mechanism.coefficients_si = a list of 17: must have 1 to 16",
        ),
        (&[("mechanism", "Polynomial(coefficients_si: [])")], "a list of 0: must have 1 to 16"),
        (&[("mechanism", "Table(path: \"\")")], "mechanism.path = \"\": name a CSV file"),
        (
            &[("mechanism", "Table(path: \"a\", tolerance: 1)")],
            "mechanism.tolerance = 1: must be 1e-10 to 0.1",
        ),
        (&[("stops", "Uneven()")], "stops = Uneven(): give left_mm, right_mm or both"),
        (&[("stops", "Uneven(left_mm: 1)")], "give restitution_left or restitution_right"),
        (
            &[("stops", "Uneven(left_mm: -1, restitution_left: 1)")],
            "stops.left_mm = -1: must be 1e-15 to 1e15",
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
            "sweep.0.field = \"stops.left_mm\": the scene has no numeric field `stops.left_mm`; it has: mass_g, mechanism.linear_n_per_m,",
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
                "[(field: \"mass_g\", from: 1, to: 2, step: 1), (field: \"mass_g\", from: 1, to: 2, step: 1)]",
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

/// A scene that has every numeric field but those of the other variants.
fn broad(variant: usize) -> Document {
    let pick = |all: &[&'static str]| all[variant % all.len()];
    document(&[
        (
            "mechanism",
            pick(&[
                "Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1)",
                "DoubleWell(equilibrium_mm: 7, barrier_mj: 0.5)",
                "Polynomial(coefficients_si: [1, 2, 3])",
                "Table(path: \"a.csv\")",
            ]),
        ),
        ("damping", pick(&["Ratio(0.1)", "Coefficient(c_n_s_per_m: 1)"])),
        (
            "stops",
            pick(&[
                "Rigid(travel_limit_mm: 1, restitution: 0.5)",
                "Uneven(left_mm: 1, restitution_left: 0.5)",
            ]),
        ),
        (
            "excitation",
            pick(&[
                "Sine(frequency_hz: 3, amplitude_g: 1)",
                "Sum([Constant(accel_g: 1), AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 10), Sum([Sine(frequency_hz: 3, amplitude_g: 1)])])",
            ]),
        ),
        ("start", "At(x_mm: 0.5, v_m_per_s: 0)"),
        ("sweep", "[(field: \"mass_g\", from: 1, to: 2, step: 1)]"),
        ("app", "(stops_when_on: Rigid(travel_limit_mm: 1, restitution: 0.5))"),
    ])
}

#[test]
fn every_number_can_be_read_set_and_checked() {
    for variant in 0..4 {
        let original = broad(variant);
        original.check().unwrap();
        let fields = numeric_fields(&original.scene);
        assert!(fields.len() > 15 && fields.iter().any(|field| field == "run.settle_s"));
        for field in &fields {
            let mut document = original.clone();
            document.set(&format!("{field}=0.125")).unwrap();
            assert_eq!(FieldPath::new(field).get(&document.scene), Some(0.125), "{field}");
            reads_back(&document.scene);
            let mut swept = original.scene.clone();
            assert!(FieldPath::new(field).set(&mut swept, 0.125));
            assert_eq!(swept, document.scene, "{field}");
            for bad in ["NaN", "inf", "-inf", "-NaN"] {
                document.set(&format!("{field}={bad}")).unwrap();
                let error = document.check().unwrap_err().to_string();
                let place = format!("s.ron: --set {field}={bad}: {field} = ");
                assert!(error.starts_with(&place) && error.lines().count() == 1, "{error}");
            }
        }
    }
}

#[test]
fn every_listed_field_takes_its_own_value_again() {
    for variant in 0..4 {
        for field in all_fields(&broad(variant).scene) {
            let mut document = broad(variant);
            let error = document.set(&format!("{field}=(no: such value")).map_err(|error| error.to_string());
            match error {
                Err(error) => {
                    assert!(error.starts_with(&format!("--set {field}=(no: such value: ")), "{error}")
                }
                Ok(()) => {
                    assert!(["title", "notes", "path", "field"].iter().any(|name| field.ends_with(name)))
                }
            }
        }
    }
}

#[test]
fn whole_values_are_set_as_ron() {
    let mut document = broad(1);
    for (argument, path) in [
        ("stops=None", "stops"),
        ("stops=Rigid(travel_limit_mm: 4, restitution: 0.36)", "stops.travel_limit_mm"),
        ("excitation.0=Sine(frequency_hz: 5, amplitude_g: 2)", "excitation.0.frequency_hz"),
        ("excitation.2.0=None", "excitation.2.0"),
        ("excitation=None", "excitation"),
        ("start=Rest", "start"),
        ("damping=Ratio(0.1)", "damping.xi"),
        ("mechanism=Table(path: \"b.csv\")", "mechanism.path"),
        ("mechanism=Polynomial(coefficients_si: [0])", "mechanism.coefficients_si.0"),
        ("mechanism.coefficients_si=[1, 2]", "mechanism.coefficients_si.1"),
        ("run=(duration_s: 20)", "run.tolerance"),
        ("run.recurrence=false", "run.recurrence"),
        ("run.settle_s=Some(3)", "run.settle_s"),
        ("run.settle_s=None", "run.settle_s"),
        ("sweep=[]", "sweep"),
        ("app.layout=Map", "app.layout"),
        ("app.stops_when_on=None", "app.stops_when_on"),
        ("app=None", "app"),
        ("transducer=None", "transducer"),
    ] {
        document.set(argument).unwrap_or_else(|error| panic!("{error}"));
        assert!(all_fields(&document.scene).iter().any(|field| field == path), "{argument}");
        reads_back(&document.scene);
    }
    document.set(" mass_g = 1e1 ").unwrap();
    document.set("title=\"a \\\"b\\\"\"").unwrap();
    document.set("notes=without quotes = fine").unwrap();
    assert_eq!((document.scene.mass_g, document.scene.title.as_str()), (10.0, "a \"b\""));
    assert_eq!(document.scene.notes, "without quotes = fine");
    document.check().unwrap();
}

#[test]
fn a_wrong_set_names_the_argument_and_changes_nothing() {
    let mut document = broad(0);
    document.set("stops=None").unwrap();
    let before = document.scene.clone();
    for (argument, expected) in [
        (
            "stops.travel_limit_mm=3",
            "--set stops.travel_limit_mm=3: the scene has no field `stops.travel_limit_mm`; it has: title, notes, mass_g, mechanism, mechanism.linear_n_per_m,",
        ),
        (
            "stops=Soft(k: 1)",
            "--set stops=Soft(k: 1): `Soft(k: 1)`: unknown choice `Soft` in Stops; known: None, Rigid, Uneven",
        ),
        ("stops=Rigid(travel_limit_mm: 1)", "`restitution` is missing in Rigid"),
        ("mass_g", "--set mass_g: write FIELD=VALUE"),
        ("mass_g=", "`` is not a number"),
        ("mass_g=None", "`None` is not a number"),
        ("run.settle_s=soon", "`soon` is neither a number nor None"),
        ("=3", "the scene has no field ``"),
        ("run.recurrence=maybe", "expected boolean"),
        ("mechanism.coefficients_si.0=1", "no field `mechanism.coefficients_si.0`"),
    ] {
        let error = document.set(argument).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}\n  wants {expected}");
        assert_eq!((document.scene == before, error.lines().count()), (true, 1));
    }
}

#[test]
fn a_fault_found_later_gets_its_place_too() {
    let document = document(&[("damping", "Ratio(0.1)")]);
    let fault = |field: &str| Fault { field: field.into(), value: "v".into(), problem: "p".into() };
    let error = document.error_from(vec![fault("damping"), fault("damping.xi"), fault("start")]).to_string();
    assert_eq!(error, "s.ron:6:5: damping = v: p\ns.ron:6:20: damping.xi = v: p\ns.ron: start = v: p");
}

// Sweeps.

#[test]
fn over_makes_decimal_grids_and_lists() {
    let document = broad(0);
    let axes = document.axes(&["excitation.amplitude_g=0:2:0.02", "mass_g=3, 1,2.5"]).unwrap();
    assert_eq!((axes[0].values.len(), axes[0].values[29], axes[0].values[100]), (101, 0.58, 2.0));
    assert_eq!((axes[1].field.as_str(), &axes[1].values[..]), ("mass_g", &[3.0, 1.0, 2.5][..]));
    let mut cell = document.scene.clone();
    axes[0].apply(&mut cell, 29);
    axes[1].apply(&mut cell, 2);
    assert_eq!(FieldPath::new("excitation.amplitude_g").get(&cell), Some(0.58));
    assert_eq!(cell.mass_g, 2.5);
    assert_eq!(document.axes::<&str>(&[]).unwrap()[0].values, [1.0, 2.0]);
}

#[test]
fn a_wrong_over_names_the_argument() {
    let document = broad(0);
    for (over, expected) in [
        (&["mass_g=2:1:1"][..], "--over mass_g=2:1:1: the end lies below the beginning"),
        (&["mass_g=1:2:0"], "a step of 0 never arrives"),
        (&["mass_g=2:1:-1"], "the step is negative"),
        (&["mass_g=1:2:NaN"], "`NaN` is not a finite decimal number"),
        (&["mass_g=1:2"], "is not FROM:TO:STEP"),
        (&["mass_g=1:2:3:4"], "is not FROM:TO:STEP"),
        (&["mass_g="], "`` is not a finite decimal number"),
        (&["mass_g"], "write FIELD=FROM:TO:STEP"),
        (&["mass_g=1:1e15:1e-15"], "999999999999999999999999999999 values are more"),
        (&["stops.restitution=0:2:1"], "stops.restitution takes 0 to 1, not 2"),
        (&["stops.left_mm=1,2"], "no numeric field `stops.left_mm`; it has: mass_g, "),
        (&["stops=1,2"], "no numeric field `stops`"),
        (&["mass_g=1,2", "mass_g=3"], "--over: mass_g is swept twice"),
        (
            &["stops.travel_limit_mm=0.25,1"],
            "s.ron:9:16: start.x_mm = 0.5: lies outside the right stop at 0.25 mm",
        ),
        (
            &["run.settle_s=1,20"],
            "run.settle_s = 20: must not exceed run.duration_s = 10; left out, it is half of it (in the sweep, at run.settle_s = 20)",
        ),
    ] {
        let error = document.axes(over).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}\n  wants {expected}");
    }
}

#[test]
fn a_sweep_over_stops_that_were_taken_away_is_the_sweeps_concern_alone() {
    let mut document = Document::load("paper").unwrap();
    document.set("stops=None").unwrap();
    document.check().unwrap();
    let error = document.axes::<&str>(&[]).unwrap_err().to_string();
    assert!(
        error.contains("sweep.0.field = \"stops.travel_limit_mm\": the scene has no numeric field"),
        "{error}"
    );
}

#[test]
fn setting_a_cell_costs_less_than_a_microsecond_or_so() {
    let mut scene = Document::load("paper").unwrap().scene;
    let path = FieldPath::new("excitation.amplitude_g");
    let start = std::time::Instant::now();
    for i in 0..1_000_000 {
        assert!(path.set(&mut scene, f64::from(i)));
    }
    assert!(start.elapsed().as_secs_f64() < 5.0, "{:?} for a million", start.elapsed());
}

// Properties.

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>().prop_filter("finite", |x| x.is_finite()), -10.0..10.0, Just(0.0)]
}

fn stops() -> impl Strategy<Value = Stops> {
    let side = || proptest::option::of(number());
    prop_oneof![
        Just(Stops::None),
        (number(), number())
            .prop_map(|(travel_limit_mm, restitution)| Stops::Rigid { travel_limit_mm, restitution }),
        (side(), side(), side(), side()).prop_map(
            |(left_mm, right_mm, restitution_left, restitution_right)| {
                Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right }
            }
        ),
    ]
}

fn excitation() -> impl Strategy<Value = Excitation> {
    let leaf = prop_oneof![
        Just(Excitation::None),
        number().prop_map(|accel_g| Excitation::Constant { accel_g }),
        (number(), number(), number()).prop_map(|(frequency_hz, amplitude_g, phase_deg)| {
            Excitation::Sine { frequency_hz, amplitude_g, phase_deg }
        }),
        (number(), number(), number(), number()).prop_map(|(frequency_hz, from_g, to_g, over_s)| {
            Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s }
        }),
    ];
    leaf.prop_recursive(4, 16, 4, |inner| proptest::collection::vec(inner, 0..4).prop_map(Excitation::Sum))
}

fn scene() -> impl Strategy<Value = Scene> {
    let mechanism = prop_oneof![
        (number(), number())
            .prop_map(|(linear_n_per_m, cubic_n_per_m3)| Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 }),
        proptest::collection::vec(number(), 0..20)
            .prop_map(|coefficients_si| Mechanism::Polynomial { coefficients_si }),
        (any::<String>(), number()).prop_map(|(path, tolerance)| Mechanism::Table { path, tolerance }),
    ];
    let app =
        (proptest::option::of(number()), proptest::option::of(stops())).prop_map(|(speed, stops)| AppHints {
            layout: Some(Layout::Study),
            speed,
            stops_when_on: stops.filter(|stops| *stops != Stops::None),
        });
    let axis = (any::<String>(), number(), number(), number())
        .prop_map(|(field, from, to, step)| SweepAxis { field, from, to, step });
    let rest = (
        (number(), proptest::option::of(number()), number(), any::<bool>()),
        proptest::option::of(app),
        proptest::collection::vec(axis, 0..3),
    );
    let title = prop_oneof![any::<String>(), "[\"#r\\\\( \n]*"];
    ((title, number(), mechanism, stops(), excitation()), rest).prop_map(
        |(
            (title, mass_g, mechanism, stops, excitation),
            ((duration_s, settle_s, tolerance, recurrence), app, sweep),
        )| {
            Scene {
                title,
                notes: "Some \"notes\".\n\nMore.".into(),
                mass_g,
                mechanism,
                damping: Damping::Ratio(mass_g),
                stops,
                excitation,
                start: Start::At { x_mm: mass_g, v_m_per_s: tolerance },
                run: Run { duration_s, settle_s, tolerance, recurrence },
                sweep,
                transducer: Transducer::None,
                app,
            }
        },
    )
}

proptest! {
    #[test]
    fn arbitrary_text_never_panics(text in any::<String>(), argument in any::<String>()) {
        let _ = Document::from_text("s.ron", &text, Files::default());
        let mut document = broad(1);
        let _ = document.set(&argument);
        let _ = document.axes(&[argument]);
        let _ = Places::of(&text);
    }

    #[test]
    fn almost_scenes_never_panic(at in 0_usize..400, cut in 0_usize..6, insert in "[-()\\[\\]{}:,\"'/*# \nre0-9é]{0,6}") {
        let mut chars: Vec<char> = broad(1).text.chars().collect();
        let at = at.min(chars.len());
        let end = (at + cut).min(chars.len());
        chars.splice(at..end, insert.chars());
        let text: String = chars.into_iter().collect();
        if let Ok(document) = Document::from_text("s.ron", &text, Files::default()) {
            let _ = document.check().map_err(|error| error.to_string());
            let _ = document.axes::<&str>(&[]);
            reads_back(&document.scene);
        }
    }

    #[test]
    fn fields_take_arbitrary_values_without_panic(field in 0_usize..60, value in "\\PC{0,12}|[A-Z][a-z]+\\([a-z_: 0-9]*\\)") {
        let mut document = broad(1);
        let fields = all_fields(&document.scene);
        let _ = document.set(&format!("{}={value}", fields[field % fields.len()]));
        let _ = document.check().map_err(|error| error.to_string());
        let _ = document.axes::<&str>(&[]);
    }

    #[test]
    fn any_scene_reads_back_as_written(scene in scene()) {
        reads_back(&scene);
        let document = Document::from_text("s.ron", &write(&scene), Files::default()).unwrap();
        let places = Places::of(&document.text);
        for field in all_fields(&scene) {
            if FieldPath::new(&field).get(&scene).is_some() {
                prop_assert!(places.find(&field) > places.find("title"), "{} in\n{}", field, document.text);
            }
        }
    }

    #[test]
    fn grids_are_decimal(from in -10_000_i32..10_000, steps in 1_u32..300, step in 1_i32..5000, digits in 0_u32..6) {
        let decimal = |n: i64| format!("{n}e-{digits}");
        let to = i64::from(from) + i64::from(step) * i64::from(steps);
        let over = format!(
            "mechanism.linear_n_per_m={}:{}:{}", decimal(from.into()), decimal(to), decimal(step.into())
        );
        let axis = broad(0).axes(&[over]).unwrap().remove(0);
        prop_assert_eq!(axis.values.len() as u32, steps + 1);
        for (i, value) in axis.values.iter().enumerate() {
            let exact: f64 = decimal(i64::from(from) + i64::from(step) * i as i64).parse().unwrap();
            prop_assert_eq!(*value, exact);
        }
    }
}
