//! The edited scene with its undo and its files, the ranges of its sliders, the speed of its motion.

use std::sync::Arc;
use std::time::Duration;

use interwell::app::session::Session;
use interwell::app::session::editor::Editor;
use interwell::app::session::player::fitting_speed;
use interwell::app::session::sliders::reach;
use interwell::app::words::fields::{Reach, info};
use interwell::scene::{Document, FIELDS, FieldPath, Scene, Start, Stops};

fn editor() -> Editor {
    Editor::open("first-look").unwrap()
}

fn mass(editor: &Editor) -> f64 {
    editor.scene().mass_g
}

#[test]
fn one_gesture_is_one_step() {
    let mut editor = editor();
    for step in 1..=20 {
        assert!(editor.edit(|scene| scene.mass_g = 15.2 + f64::from(step)));
    }
    assert!(editor.in_gesture() && editor.is_dirty());
    editor.end_gesture();
    assert!(editor.edit_once(|scene| scene.mass_g = 50.0));
    assert!(editor.undo());
    assert_eq!(mass(&editor), 35.2);
    assert!(editor.undo());
    assert_eq!(mass(&editor), 15.2);
    assert!(!editor.undo() && !editor.is_dirty());
    assert!(editor.redo() && editor.redo() && !editor.redo());
    assert_eq!(mass(&editor), 50.0);
    // a new edit clears the redo stack
    editor.undo();
    editor.edit_once(|scene| scene.mass_g = 1.0);
    assert!(!editor.can_redo());
}

/// A scene whose notes are so long that each copy of it is seen in what is allocated.
#[test]
fn a_step_of_a_slider_keeps_one_copy_of_the_scene() {
    const NOTES: usize = 8 << 20;
    let mut document = Document::preset("nominal-cubic").unwrap();
    document.scene.notes = "n".repeat(NOTES);
    let mut session = Session::new(Editor::new(document), Arc::new(|| ())).unwrap();
    session.wait(Duration::from_secs(60));
    let mut step = |limit_mm: f64| {
        let allocated = allocation_counter::measure(|| {
            let set = |scene: &mut Scene| {
                assert!(FieldPath::new("stops.travel_limit_mm").set(scene, limit_mm));
            };
            assert!(session.edit(set));
            session.poll();
        });
        allocated.bytes_total as f64 / NOTES as f64
    };
    let copies = [3.5, 3.4, 3.3, 3.2].map(&mut step);
    assert!(copies[1..].iter().all(|copies| *copies < 1.5), "{copies:?} copies");
    // the first step drops the answers about the scene before
    assert!(copies[0] < 3.5, "{copies:?} copies");
}

#[test]
fn a_gesture_without_a_net_change_is_no_step() {
    let mut editor = editor();
    editor.edit(|scene| scene.mass_g = 16.0);
    editor.edit(|scene| scene.mass_g = 15.2);
    editor.end_gesture();
    assert!(!editor.can_undo());
    assert!(!editor.edit(|_| ()));
}

#[test]
fn back_to_start_can_be_undone() {
    let mut editor = editor();
    editor.edit_once(|scene| scene.mass_g = 16.0);
    assert!(editor.back_to_start());
    assert_eq!(mass(&editor), 15.2);
    editor.undo();
    assert_eq!(mass(&editor), 16.0);
}

#[test]
fn a_stop_takes_the_start_along() {
    let mut editor = editor();
    editor.edit_once(|scene| scene.start = Start::At { x_mm: 5.0, v_m_per_s: 0.1, electrical: 0.0 });
    editor.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: 2.0, restitution: 0.3 });
    assert_eq!(editor.scene().start, Start::At { x_mm: 2.0, v_m_per_s: 0.1, electrical: 0.0 });
}

#[test]
fn saved_and_opened_it_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.ron");
    let mut editor = editor();
    editor.edit_once(|scene| scene.mass_g = 16.5);
    editor.save_to(&path).unwrap();
    assert!(!editor.is_dirty());
    let again = Editor::open(path.to_str().unwrap()).unwrap();
    assert_eq!(again.scene(), editor.scene());
    assert_eq!(again.path(), Some(path.as_path()));
    assert!(editor.save_to(&folder.path().join("no/such/folder.ron")).is_err());
}

#[test]
fn tables_go_where_the_scene_goes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.ron");
    Editor::open("paper-table").unwrap().save_to(&path).unwrap();
    let again = Editor::open(path.to_str().unwrap()).unwrap();
    assert!(
        interwell::mechanics::Mechanism::build(&again.scene().mechanism, &again.document().files).is_ok()
    );
    assert_eq!(again.origin().as_deref(), path.to_str());
}

#[test]
fn as_text_and_back_it_is_the_same() {
    let editor = editor();
    let again = Editor::from_text(&editor.text().unwrap()).unwrap();
    assert_eq!((again.scene(), again.origin()), (editor.scene(), None));
    assert!(!again.has_comments() && Editor::from_text("no scene").is_err());
}

fn session(preset: &str) -> Session {
    Session::new(Editor::open(preset).unwrap(), Arc::new(|| ())).unwrap()
}

#[test]
fn sliders_follow_the_scales_of_the_scene() {
    let of_preset = |preset: &str, path: &str| reach(info(path).unwrap(), &session(preset));
    assert_eq!(of_preset("first-look", "excitation.amplitude_g"), Reach::even(0.0, 2.0, 0.01));
    assert_eq!(of_preset("paper", "stops.travel_limit_mm"), Reach::even(0.1, 8.6, 0.05));
    assert_eq!(of_preset("first-look", "excitation.frequency_hz"), Reach::even(0.5, 20.0, 0.1));
    assert_eq!(of_preset("duffing", "excitation.amplitude_g"), Reach::even(0.0, 0.07, 2e-4));
    assert_eq!(of_preset("duffing", "stops.travel_limit_mm"), Reach::even(10.0, 1200.0, 5.0));
    assert_eq!(of_preset("duffing", "mass_g").high, 3000.0);
    assert_eq!(of_preset("duffing", "run.duration_s").high, 4000.0);
    // every number is at a position that its slider can reach
    for preset in interwell::scene::PRESETS {
        let session = session(preset.name);
        for field in FIELDS.iter().filter_map(|field| field.control.as_ref()) {
            let (reach, value) = (reach(field, &session), FieldPath::new(field.path).get(session.scene()));
            assert!(reach.low < reach.high && reach.step > 0.0, "{}: {reach:?}", field.path);
            let Some(value) = value else { continue };
            if reach.ratios {
                assert!((reach.low..=reach.high).contains(&value), "{} {}", preset.name, field.path);
                continue;
            }
            assert!(
                value <= 1.3 * reach.high && (value == 0.0 || value.abs() > reach.high / 250.0),
                "{} {}: {value} {reach:?}",
                preset.name,
                field.path
            );
        }
    }
}

#[test]
fn the_speed_suits_the_characteristic_time() {
    // 3 Hz, 0.2 Hz, 40 Hz, 1 kHz
    assert_eq!([0.333, 5.2, 0.025, 1e-3, 1e9].map(fitting_speed), [0.1, 1.0, 0.01, 1e-3, 1.0]);
}
