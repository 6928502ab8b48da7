//! Flexures in a scene: reading, setting, sweeps, and shapes that are refused.

use interwell::scene::*;

use super::*;

fn prototype() -> Document {
    document(&[("mechanism", FLEXURES)])
}

fn with(changes: &[&str]) -> Document {
    let mut document = prototype();
    changes.iter().for_each(|change| document.set(change).unwrap());
    document
}

#[test]
fn they_have_the_documented_defaults_and_read_back() {
    let short = prototype();
    let parallel = FlexureGroup { count: 2, length_mm: 26.0, width_mm: 20.0 };
    let buckling = FlexureGroup { count: 1, length_mm: 27.7, width_mm: 6.8 };
    let expected = Mechanism::Flexures {
        preload_mm: 2.7,
        thickness_mm: 0.1,
        young_gpa: 190.0,
        parallel,
        buckling,
        poisson: 0.34,
        plane_strain: false,
        initial_bow_mm: 0.0,
        yield_gpa: 2.0,
    };
    assert_eq!(short.scene.mechanism, expected);
    assert_eq!(short.check(), Ok(vec![]));
    reads_back(&short.scene);
    let long = FLEXURES.strip_suffix(')').unwrap().to_owned()
        + ", poisson: 0.3, plane_strain: true, initial_bow_mm: 0.05, yield_gpa: 1.5)";
    let long = document(&[("mechanism", &long)]);
    assert_eq!(long.check(), Ok(vec![]));
    reads_back(&long.scene);
    let Mechanism::Flexures { poisson, plane_strain, initial_bow_mm, yield_gpa, .. } = long.scene.mechanism
    else {
        panic!()
    };
    assert_eq!((poisson, plane_strain, initial_bow_mm, yield_gpa), (0.3, true, 0.05, 1.5));
}

#[test]
fn every_path_is_there() {
    let scene = prototype().scene;
    let all = all_fields(&scene);
    let numeric = numeric_fields(&scene);
    for path in [
        "preload_mm",
        "thickness_mm",
        "young_gpa",
        "parallel.count",
        "parallel.length_mm",
        "parallel.width_mm",
        "buckling.count",
        "buckling.length_mm",
        "buckling.width_mm",
        "poisson",
        "initial_bow_mm",
        "yield_gpa",
    ] {
        let path = format!("mechanism.{path}");
        assert!(numeric.contains(&path), "{path}");
        let document = with(&[&format!("{path}=1")]);
        assert_eq!(FieldPath::new(&path).get(&document.scene), Some(1.0));
        let value = FieldPath::new(&path).get(&scene).unwrap();
        assert_eq!(prototype().axes(&[format!("{path}={value}")]).unwrap()[0].values, [value]);
    }
    for path in ["mechanism.parallel", "mechanism.buckling", "mechanism.plane_strain"] {
        assert!(
            all.iter().any(|field| field == path) && !numeric.iter().any(|field| field == path),
            "{path}"
        );
    }
    let changed = with(&[
        "mechanism.plane_strain=true",
        "mechanism.buckling=(count: 3, length_mm: 30, width_mm: 5)",
        "mechanism.parallel.count=4",
    ]);
    let Mechanism::Flexures { plane_strain, parallel, buckling, .. } = changed.scene.mechanism else {
        panic!()
    };
    assert!(plane_strain);
    assert_eq!((parallel.count, buckling.count, buckling.length_mm), (4, 3, 30.0));
    // From another mechanism, all at once.
    let mut cubic = document(&[]);
    cubic.set(&format!("mechanism={FLEXURES}")).unwrap();
    assert_eq!(cubic.scene.mechanism, prototype().scene.mechanism);
}

#[test]
fn paths_that_are_not_there_list_those_that_are() {
    for (argument, expected) in [
        (
            "mechanism.parallel.lenght_mm=26",
            "no field `mechanism.parallel.lenght_mm`; did you mean `mechanism.parallel.length_mm`? It has: \
             title, notes, mass_g, mechanism, mechanism.preload_mm,",
        ),
        ("mechanism.linear_n_per_m=1", "mechanism.parallel.length_mm, "),
        ("mechanism.plane_strain=1", "expected boolean"),
        ("mechanism.parallel=(count: 2)", "`length_mm` is missing in FlexureGroup"),
        ("mechanism.parallel.count=2.5", "is not a whole number"),
    ] {
        let error = prototype().set(argument).unwrap_err().to_string();
        assert!(error.contains(expected) && error.lines().count() == 1, "{error}\n  wants {expected}");
    }
    let error = prototype().axes(&["mechanism.plane_strain=0,1"]).unwrap_err().to_string();
    assert!(error.contains("no numeric field `mechanism.plane_strain`"), "{error}");
    let error = prototype().axes(&["mechanism.parallel.count=1:2:0.5"]).unwrap_err().to_string();
    assert!(error.contains("takes whole, 1 to 64, not 1.5"), "{error}");
}

#[test]
fn shapes_that_are_no_flexures_name_the_limit() {
    for (changes, expected) in [
        (&["preload_mm=-0.1"][..], "mechanism.preload_mm = -0.1: must be 0 to 1e15; "),
        (
            &["preload_mm=13.01"],
            "mechanism.preload_mm = 13.01: must be 0 to 13 mm, half of the shorter flexure \
             (mechanism.parallel.length_mm = 26); ",
        ),
        (
            &["preload_mm=6", "buckling.length_mm=10"],
            "must be 0 to 5 mm, half of the shorter flexure (mechanism.buckling.length_mm = 10); ",
        ),
        (&["thickness_mm=0"], "mechanism.thickness_mm = 0: must be 1e-15 to 1e15; "),
        (
            &["thickness_mm=2.7"],
            "mechanism.thickness_mm = 2.7: must be at most 2.6 mm, a tenth of the shorter",
        ),
        (&["initial_bow_mm=1.4"], "must be 0 to 1.385, a twentieth of mechanism.buckling.length_mm = 27.7"),
        (&["initial_bow_mm=-1"], "mechanism.initial_bow_mm = -1: must be 0 to 1e15"),
        (&["parallel.length_mm=0"], "mechanism.parallel.length_mm = 0: must be 1e-15 to 1e15; "),
        (&["buckling.width_mm=-6.8"], "mechanism.buckling.width_mm = -6.8: must be 1e-15"),
        (&["buckling.count=0"], "mechanism.buckling.count = 0: must be whole, 1 to 64; "),
        (&["parallel.count=65"], "mechanism.parallel.count = 65: must be whole, 1 to 64; "),
        (&["poisson=0.5"], "mechanism.poisson = 0.5: must be 0 to 0.49; "),
        (&["young_gpa=0"], "mechanism.young_gpa = 0: must be 1e-60 to 1e60; "),
        (&["yield_gpa=0"], "mechanism.yield_gpa = 0: must be 1e-60 to 1e60; "),
    ] {
        let mut document = prototype();
        changes.iter().for_each(|change| document.set(&format!("mechanism.{change}")).unwrap());
        let error = document.check().unwrap_err().to_string();
        assert!(error.contains(expected), "{changes:?}\n  gives {error}\n  wants {expected}");
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(error.starts_with(&format!("s.ron: --set mechanism.{}", changes[0])), "{error}");
    }
    // All at once, each at its place in the text.
    let thick = FLEXURES.replace("preload_mm: 2.7", "preload_mm: 20").replace("0.1", "3");
    let error = faults(&[("mechanism", &thick)]);
    assert_eq!(error.lines().count(), 2, "{error}");
    assert!(error.lines().all(|line| line.starts_with("s.ron:5:")), "{error}");
}

#[test]
fn limits_are_valid_themselves_at_any_scale() {
    for factor in [1e-9, 1e-3, 1.0, 7.3, 1e9] {
        let length = |mm: f64| format!("{:?}", mm * factor);
        let text = format!(
            "Flexures(preload_mm: {}, thickness_mm: {}, young_gpa: 190, initial_bow_mm: {}, \
             parallel: (count: 64, length_mm: {}, width_mm: {}), buckling: (count: 1, length_mm: {}, \
             width_mm: {}))",
            length(13.0),
            length(2.6),
            length(1.385),
            length(26.0),
            length(20.0),
            length(27.7),
            length(6.8)
        );
        let warnings = document(&[("mechanism", &text)]).check().unwrap();
        assert!(warnings.iter().all(|warning| warning.contains("may not be solved")), "{warnings:?}");
    }
}

#[test]
fn what_is_hardly_meant_is_a_warning() {
    for (change, expected) in [
        ("mechanism.preload_mm=6.6", "mechanism.preload_mm = 6.6: beyond 6.5 mm, a quarter of the shorter"),
        ("mechanism.buckling.width_mm=0.05", "mechanism.buckling.width_mm = 0.05: less than the thickness"),
    ] {
        let warnings = with(&[change]).check().unwrap();
        assert!(warnings.len() == 1 && warnings[0].contains(expected), "{warnings:?}");
    }
    assert_eq!(with(&["mechanism.preload_mm=6.5"]).check(), Ok(vec![]));
    assert_eq!(with(&["mechanism.preload_mm=0"]).check(), Ok(vec![]));
}

#[test]
fn a_sweep_judges_shapes_at_its_corners() {
    let over = ["mechanism.preload_mm=1:12:1", "mechanism.buckling.length_mm=20,30"];
    let error = prototype().axes(&over).unwrap_err().to_string();
    assert!(error.contains("must be 0 to 10 mm") && error.contains("(in the sweep, at "), "{error}");
    prototype().axes(&["mechanism.preload_mm=1:10:1", over[1]]).unwrap();
}
