//! The small corpus of the fuzz targets, as plain tests: seeds, and every input that ever broke a promise.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use interwell::dynamics::Model;
use interwell::mechanics::Mechanism;
use interwell::scene::{Document, Fault, FieldPath, numeric_fields};

mod elsewhere;
mod promises;

/// Runs each file of one target's corpus; a panic names the file.
fn corpus(target: &str, promise: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(target);
    let mut files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 5, "only {} files in {}", files.len(), folder.display());
    for file in files {
        let bytes = fs::read(&file).unwrap();
        let kept = std::panic::catch_unwind(|| promise(&bytes));
        assert!(kept.is_ok(), "{} breaks a promise", file.display());
    }
}

#[test]
fn scenes() {
    corpus("scene", promises::scene);
}

#[test]
fn tables() {
    corpus("table", promises::table);
}

#[test]
fn records() {
    corpus("recorded", promises::recorded);
}

#[test]
fn set_arguments() {
    corpus("set", promises::set);
}

#[test]
fn links() {
    corpus("link", promises::link);
}

#[test]
fn over_arguments() {
    corpus("over", promises::over);
}

/// Each built-in scene and its table keep the promises too.
#[test]
fn what_comes_with_the_program() {
    for preset in interwell::scene::PRESETS {
        promises::scene(preset.text.as_bytes());
    }
    for table in interwell::scene::TABLES {
        promises::table(table.text.as_bytes());
    }
}

/// At the boundary of the library, which a scene may reach that no check has seen.
#[test]
fn a_number_that_no_scene_may_have_makes_no_model() {
    let transducer = "transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 4, load_ohm: 6)";
    let noise = "excitation=Noise(rms_g: 0.3, low_hz: 1, high_hz: 20, seed: 7)";
    let compliant = "stops=Hertz(travel_limit_mm: 1, stiffness_n_per_m1_5: 1e8, loss_s_per_m: 1)";
    let cylinders =
        "stops=Hertz(travel_limit_mm: 1, radius_mm: 5, young_gpa: 69, loss_s_per_m: 1, yield_gpa: 0.3)";
    let start = "start=At(x_mm: 0.1, v_m_per_s: 0.1)";
    let mut refused = 0;
    for (name, changes) in [
        ("nominal-cubic", vec![start]),
        ("nominal-cubic", vec![transducer, "run.settle_s=1", noise]),
        ("paper-ramp", vec![compliant]),
        ("nominal-cubic", vec![cylinders]),
        ("random-shaking", vec![start]),
        ("uneven-stops", vec![]),
        ("duffing", vec!["excitation=Chirp(from_hz: 1, to_hz: 2, over_s: 3, amplitude_g: 1)"]),
    ] {
        let mut document = Document::load(name).unwrap();
        changes.iter().for_each(|change| document.set(change).unwrap());
        let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
        Model::build(&document.scene, Arc::clone(&mechanism)).unwrap();
        for field in numeric_fields(&document.scene) {
            let of_the_run = ["mass_g", "damping.", "stops.", "transducer.", "excitation.", "start.", "run."];
            if !of_the_run.iter().any(|part| field.starts_with(part)) {
                continue;
            }
            let path = FieldPath::new(&field);
            for value in [f64::NAN, f64::NEG_INFINITY, -1.0] {
                let mut scene = document.scene.clone();
                let _ = path.set(&mut scene, value);
                if path.get(&scene).is_some_and(|set| set.to_bits() == value.to_bits()) {
                    match Model::build(&scene, Arc::clone(&mechanism)) {
                        Ok(_) => {
                            let mut changed = document.clone();
                            changed.scene = scene;
                            assert!(changed.check().is_ok(), "{name} {field} = {value}");
                        }
                        Err(faults) => {
                            // of a mass that is none a damping ratio says so first
                            let named = |fault: &Fault| field.starts_with(&fault.field) || field == "mass_g";
                            assert!(faults.iter().any(named), "{field} {faults:?}");
                            refused += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(refused > 40, "{refused}");
    // what is within no range though nothing of it is negative
    let mut document = Document::load("nominal-cubic").unwrap();
    document.set("stops=Rigid(travel_limit_mm: 1, restitution: 1.2)").unwrap();
    let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
    let faults = Model::build(&document.scene, mechanism).unwrap_err();
    assert!(faults.len() == 1 && faults[0].field == "stops.restitution", "{faults:?}");
}
