//! Before / now and Compare: one table.

use std::f64::consts::TAU;

use egui_kittest::Harness;
use interwell::app::session::pins::PinKind;
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::Excitation;

use crate::support::{LONG, WIDE, command, painted, window};

/// Shows one view alone.
fn alone(harness: &mut Harness<'static, Window>, view: View) {
    for other in View::ALL {
        command(harness, Command::Show(other, other == view));
    }
    harness.run_steps(3);
}

/// The rows of the table in a view: name, unit where there is one, and the texts of the columns.
fn rows(harness: &Harness<'static, Window>, view: View) -> Vec<Vec<String>> {
    let place = harness.state().tiling.place_of(view).unwrap();
    let mut texts: Vec<_> =
        painted(harness).into_iter().filter(|text| place.contains(text.1.center())).collect();
    texts.sort_by(|a, b| a.1.left().total_cmp(&b.1.left()));
    let is_name = |text: &&(String, eframe::egui::Rect, eframe::egui::Rect)| {
        text.1.left() < place.left() + 16.0 && text.1.top() > place.top() + 30.0
    };
    let mut names: Vec<_> = texts.iter().filter(is_name).collect();
    names.sort_by(|a, b| a.1.top().total_cmp(&b.1.top()));
    let row = |name: &eframe::egui::Rect| {
        let beside = texts.iter().filter(|text| (text.1.center().y - name.center().y).abs() < 7.0);
        beside.map(|text| text.0.clone()).collect::<Vec<_>>()
    };
    names.iter().map(|name| row(&name.1)).filter(|row| row[0] != "Pin" && row[0] != "With stops").collect()
}

fn named<'a>(rows: &'a [Vec<String>], name: &str) -> &'a Vec<String> {
    rows.iter().find(|row| row[0] == name).unwrap_or_else(|| panic!("{name}: {rows:?}"))
}

#[test]
fn before_now_and_compare_are_one_table() {
    let mut harness = window("paper", WIDE);
    command(&mut harness, Command::Pin(PinKind::Motion));
    let session = &mut harness.state_mut().session;
    session.edit_once(|scene| {
        assert!(interwell::scene::FieldPath::new("stops.restitution").set(scene, 0.5));
        assert!(interwell::scene::FieldPath::new("mechanism.preload_mm").set(scene, 2.5));
    });
    session.wait(LONG);
    harness.run_steps(5);
    alone(&mut harness, View::BeforeNow);
    let card = rows(&harness, View::BeforeNow);
    alone(&mut harness, View::Compare);
    let compare = rows(&harness, View::Compare);
    let names = |rows: &[Vec<String>]| rows.iter().map(|row| row[0].clone()).collect::<Vec<_>>();
    // the same rows in the same order; what differs has the name of its slider
    assert_eq!(names(&card), names(&compare));
    for name in ["shaking", "stops", "restitution", "preload", "motion", "RMS velocity", "reach"] {
        named(&card, name);
    }
    // what is equal in both has no row
    assert!(!names(&card).iter().any(|name| name == "mass" || name == "damping"));
    let order = |name: &str| names(&card).iter().position(|other| other == name).unwrap();
    assert!(order("preload") < order("motion") && order("motion") < order("RMS velocity"));
    assert_eq!(named(&card, "motion")[1], "once settled");
    // the same units, and the same digits of the present motion
    for (name, unit) in [("RMS velocity", "mm/s"), ("reach", "mm"), ("stops", "mm"), ("preload", "mm")] {
        let (row, beside) = (named(&card, name), named(&compare, name));
        assert!(row[1] == unit && beside[1] == unit, "{row:?} {beside:?}");
        assert_eq!(row[3], beside[2], "{row:?} {beside:?}");
        assert_eq!(row[2], beside[3], "{row:?} {beside:?}");
    }
    assert_eq!(named(&card, "restitution")[1..], ["0.36", "0.5"]);
    assert_eq!(named(&card, "preload")[2..], ["2.7", "2.5"]);
}

#[test]
fn one_threshold_on_all_surfaces() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.wait(LONG);
    command(&mut harness, Command::Pin(PinKind::Motion));
    harness.run_steps(3);
    // the amplitude has no part in the threshold: with it alone changed both are equal
    let session = &mut harness.state_mut().session;
    session.set_number("excitation.amplitude_g", 0.6).unwrap();
    session.end_gesture();
    session.wait(LONG);
    harness.run_steps(3);
    alone(&mut harness, View::Compare);
    assert_eq!(named(&rows(&harness, View::Compare), "crosses from")[2..], ["0.718", "0.718", "(same)"]);
    let session = &mut harness.state_mut().session;
    session.set_number("stops.travel_limit_mm", 1.0).unwrap();
    session.end_gesture();
    session.wait(LONG);
    harness.run_steps(3);
    let row = named(&rows(&harness, View::Compare), "crosses from").clone();
    let (now, pinned) = (row[2].clone(), row[3].clone());
    assert_eq!(pinned, "0.718");
    alone(&mut harness, View::BeforeNow);
    let card = rows(&harness, View::BeforeNow);
    assert_eq!(named(&card, "crosses from")[2..], [pinned, now.clone()]);
    let text = harness.state().session.sentence().whole();
    assert!(text.contains(&format!("{now} g")), "{now}: {text}");
    let ways = harness.state_mut().session.ways();
    assert!(!ways.is_empty());
}

#[test]
fn an_undecided_threshold_is_one_number() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(3);
    alone(&mut harness, View::BeforeNow);
    let shown = named(&rows(&harness, View::BeforeNow), "crosses from").last().unwrap().clone();
    assert!(shown.starts_with("about 1.1"), "{shown}");
    let text = harness.state().session.sentence().whole();
    let number = shown.trim_start_matches("about ");
    assert!(text.contains("About") && text.ends_with(&format!("short of crossing at {number} g.")), "{text}");
}

#[test]
fn the_state_before_a_change_has_the_threshold_that_is_found_after_it() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.set_number("excitation.amplitude_g", 1.1).unwrap();
    harness.state_mut().session.end_gesture();
    harness.state_mut().session.wait(LONG);
    harness.run_steps(3);
    alone(&mut harness, View::BeforeNow);
    let row = named(&rows(&harness, View::BeforeNow), "crosses from").clone();
    assert_eq!(row[2..], ["0.718", "0.718"]);
}

#[test]
fn a_threshold_is_in_the_unit_of_the_drive() {
    let mut harness = window("paper", WIDE);
    let session = &mut harness.state_mut().session;
    session.edit_once(|scene| {
        let push_n = 0.6 * 9.80665 * scene.mass_g / 1e3;
        scene.excitation =
            Excitation::Force { amplitude_n: push_n, frequency_rad_per_s: TAU * 3.0, phase_deg: 0.0 };
    });
    session.wait(LONG);
    harness.run_steps(3);
    alone(&mut harness, View::BeforeNow);
    let row = named(&rows(&harness, View::BeforeNow), "crosses from").clone();
    // two drives of two units, each with its own
    assert_eq!(row[1..], ["g", "0.718", "0.107 N"]);
    let text = harness.state().session.sentence().whole();
    assert!(text.contains("0.107 N"), "{text}");
}
