//! What is refused of a transducer, with the field, its value and a remedy.

use interwell::scene::Document;

use crate::shared::changed;

fn refused(changes: &[&str]) -> String {
    let mut document = Document::load("paper").unwrap();
    for change in changes {
        if let Err(error) = document.set(change) {
            return error.to_string();
        }
    }
    document.check().unwrap_err().to_string()
}

const COIL: &str =
    "transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 60, inductance_mh: 3)";

#[test]
fn every_fault_names_field_value_and_remedy() {
    for (changes, words) in [
        (
            &[COIL, "transducer.inductance_mh=-1"][..],
            "transducer.inductance_mh = -1: must be 0 to 1e30; give the",
        ),
        (
            &[COIL, "transducer.load_ohm=-1"],
            "transducer.load_ohm = -1: must be 0 to inf; give the resistance",
        ),
        (&[COIL, "transducer.load_ohm=NaN"], "transducer.load_ohm = NaN: must be 0 to inf"),
        (
            &["transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 0, load_ohm: 0)"],
            "transducer.load_ohm = 0: without coil_ohm or inductance_mh above 0 nothing limits the current",
        ),
        (
            &[COIL, "stops=Hertz(travel_limit_mm: 1.5, stiffness_n_per_m1_5: 1e9, loss_s_per_m: 1)"],
            "transducer.inductance_mh = 3: makes a state of its own, which is not followed through contact",
        ),
        (
            &["start=At(x_mm: 0, v_m_per_s: 0, electrical: 1)"],
            "start.electrical = 1: needs a transducer with a current or voltage of its own",
        ),
        (&["transducer=Coil()"], "unknown choice `Coil` in Transducer; known: None, Electromagnetic, Piezo"),
    ] {
        let error = refused(changes);
        assert!(error.contains(words), "{changes:?}\n  gives {error}\n  wants {words}");
    }
}

#[test]
fn infinity_is_a_load_of_scene_argument_and_axis() {
    let mut document = changed("paper", &[COIL, "transducer.load_ohm=inf"]);
    document.check().unwrap();
    let text = interwell::scene::write(&document.scene).unwrap();
    let again = Document::from_text("again", &text, document.files.clone()).unwrap();
    assert_eq!(again.scene, document.scene);
    let axes = document.axes(&["transducer.load_ohm=0,40,inf"]).unwrap();
    assert_eq!(axes[0].values, [0.0, 40.0, f64::INFINITY]);
    document.scene.sweep = vec![axes[0].to_scene(&document.scene)];
    document.check().unwrap();
    let none: [&str; 0] = [];
    assert_eq!(document.axes(&none).unwrap()[0].values, axes[0].values);
    for (axis, said) in [
        (
            "transducer.coil_ohm=1,inf",
            "`inf` is not a finite decimal number; give the resistance of the coil",
        ),
        ("transducer.load_ohm=60ohm", "`60ohm` is not a finite decimal number; give the resistance"),
        ("transducer.load_ohm=1:inf:2", "`inf` is not a finite decimal number; give the resistance"),
        ("transducer.load_ohm=1:inf:2", "inf stands in a list alone"),
    ] {
        let error = document.axes(&[axis]).unwrap_err().to_string();
        assert!(error.contains(said), "{axis}\n  gives {error}\n  wants {said}");
    }
}

#[test]
fn a_load_beyond_the_largest_number_is_no_open_circuit() {
    let mut document = changed("paper", &[COIL]);
    let before = document.scene.clone();
    let whole = "transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 1e400)";
    for (argument, said) in [
        (
            "transducer.load_ohm=1e400",
            "load_ohm=1e400: `1e400` is beyond the largest number, 1.8e308; give the",
        ),
        (whole, ": load_ohm: 1e400 is beyond the largest number"),
    ] {
        let error = document.set(argument).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
        assert!(document.scene == before);
    }
    let text = interwell::scene::write(&before).unwrap();
    let open = text.replacen("load_ohm:", "load_ohm: 1e400, //", 1);
    assert!(open != text);
    let error = Document::from_text("s.ron", &open, document.files.clone()).unwrap_err().to_string();
    assert!(error.starts_with("s.ron:") && error.contains("transducer.load_ohm: 1e400 is beyond"), "{error}");
    let with_unit = text.replacen("load_ohm:", "load_ohm: 60ohm, //", 1);
    let error = Document::from_text("s.ron", &with_unit, document.files.clone()).unwrap_err().to_string();
    assert!(error.contains("transducer.load_ohm: expected a comma before this; a unit stands in"), "{error}");
}
