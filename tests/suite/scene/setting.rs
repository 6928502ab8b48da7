//! Arguments that set a field or sweep one.

use interwell::scene::*;

use super::*;

#[test]
fn every_number_can_be_read_set_and_checked() {
    for variant in 0..5 {
        let original = broad(variant);
        original.check().unwrap();
        let fields = numeric_fields(&original.scene);
        assert!(fields.len() > 15 && fields.iter().any(|field| field == "run.settle_s"));
        for field in &fields {
            let mut document = original.clone();
            let whole = field.ends_with("seed") || field.ends_with("lines") || field.ends_with("count");
            let value = if whole { 9.0 } else { 0.125 };
            document.set(&format!("{field}={value}")).unwrap();
            assert_eq!(FieldPath::new(field).get(&document.scene), Some(value), "{field}");
            reads_back(&document.scene);
            let mut swept = original.scene.clone();
            assert!(FieldPath::new(field).set(&mut swept, value));
            assert_eq!(swept, document.scene, "{field}");
            if whole {
                for bad in ["NaN", "inf", "0.125", "-1"] {
                    let error = document.set(&format!("{field}={bad}")).unwrap_err().to_string();
                    assert!(error.contains("is not a whole number"), "{error}");
                }
                continue;
            }
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
    for variant in 0..5 {
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
    ] {
        document.set(argument).unwrap_or_else(|error| panic!("{error}"));
        assert!(all_fields(&document.scene).iter().any(|field| field == path), "{argument}");
        reads_back(&document.scene);
    }
    document.set(" mass_g = 1e1 ").unwrap();
    document.set("title=\"a \\\"b\\\"\"").unwrap();
    document.set("notes=read \"this\"").unwrap();
    assert_eq!(document.scene.notes, "read \"this\"");
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
            "--set stops.travel_limit_mm=3: the scene has no field `stops.travel_limit_mm`; it has: title, \
             notes, mass_g, mechanism, mechanism.linear_n_per_m,",
        ),
        (
            "stops=Soft(k: 1)",
            "--set stops=Soft(k: 1): `Soft(k: 1)`: unknown choice `Soft` in Stops; known: None, Rigid, \
             Uneven",
        ),
        ("stops=Rigid(travel_limit_mm: 1)", "`restitution` is missing in Rigid"),
        ("mass_g", "--set mass_g: write FIELD=VALUE"),
        ("mass_g=", "`` is not a number"),
        ("mass_g=None", "`None` is not a number; give the proof mass in grams"),
        (
            "mass_g=15g",
            "`15g` is not a number: its unit stands in the name of the field; give the proof mass",
        ),
        ("run.settle_s=2s", "neither a number nor None: its unit stands in the name of the field; give when"),
        ("mass_g=1e400", "`1e400` is beyond the largest number, 1.8e308; give the proof mass in grams"),
        ("run.settle_s=-1e309", "`-1e309` is beyond the largest number"),
        (
            "stops=Rigid(travel_limit_mm: 1 mm, restitution: 0)",
            "travel_limit_mm: expected a comma before this; a unit",
        ),
        (
            "stops=Rigid(travel_limit_mm: 1e400, restitution: 0)",
            "travel_limit_mm: 1e400 is beyond the largest",
        ),
        ("damping=Ratio(xi: 0.1)", "xi: expected a number; this one has no name, write Ratio(0.1)"),
        ("damping=Ratio( xi=1e-3 )", "write Ratio(1e-3)"),
        ("damping=Ratio(xi: some)", "xi: expected a number"),
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
        (&["mass_g=1:1e15:1e-15"], "999999999999999000000000000001 values are more"),
        (&["stops.restitution=0:2:1"], "stops.restitution takes 0 to 1, not 2"),
        (
            &["amplitude_g=1,2"],
            "no numeric field `amplitude_g`; did you mean `excitation.amplitude_g`? It has: mass_g, ",
        ),
        (&["stops=1,2"], "no numeric field `stops`"),
        (&["mass_g=1,2", "mass_g=3"], "--over: mass_g is swept twice"),
        (
            &["stops.travel_limit_mm=0.25,1"],
            "s.ron:9:15: start.x_mm = 0.5: lies outside the right stop at 0.25 mm",
        ),
        (
            &["run.settle_s=1,20"],
            "run.settle_s = 20: must not exceed run.duration_s = 10; left out, it is half of it (in the \
             sweep, at run.settle_s = 20)",
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
fn setting_a_cell_allocates_nothing() {
    let mut scene = Document::load("paper").unwrap().scene;
    let path = FieldPath::new("excitation.amplitude_g");
    let allocated = allocation_counter::measure(|| {
        for i in 0..1000 {
            assert!(path.set(&mut scene, f64::from(i)));
        }
    });
    assert_eq!(allocated.count_total, 0, "{allocated:?}");
}

#[test]
fn long_axes_are_refused_before_they_fill_the_memory() {
    let document = document(&[]);
    let long = "mechanism.linear_n_per_m=1:1e7:1".to_owned();
    let error = document.axes(&vec![long.clone(); 100]).unwrap_err().to_string();
    assert_eq!(error, "--over: 100 axes are more than a sweep may have (10)");
    let error = document.axes(&vec![long; 10]).unwrap_err().to_string();
    assert!(
        error.contains("30000000 values, with the axes before it, are more than a sweep may have"),
        "{error}"
    );
}
