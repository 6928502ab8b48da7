//! The table of Compare.

use std::f64::consts::TAU;

use egui_kittest::Harness;
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::Excitation;

use crate::support::{LONG, WIDE, command, painted, wait_until, window};

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
    names.iter().map(|name| row(&name.1)).filter(|row| row[0] != "Pin").collect()
}

fn named<'a>(rows: &'a [Vec<String>], name: &str) -> &'a Vec<String> {
    rows.iter().find(|row| row[0] == name).unwrap_or_else(|| panic!("{name}: {rows:?}"))
}

#[test]
fn the_reference_stands_beside_the_present_motion() {
    let mut harness = window("paper", WIDE);
    let session = &mut harness.state_mut().session;
    session.edit_once(|scene| {
        assert!(interwell::scene::FieldPath::new("stops.restitution").set(scene, 0.5));
        assert!(interwell::scene::FieldPath::new("mechanism.preload_mm").set(scene, 2.5));
    });
    session.wait(LONG);
    wait_until("what the start settles to", || {
        harness.run_steps(1);
        harness.state().session.reference_card().unwrap().settled.is_some()
    });
    harness.run_steps(3);
    alone(&mut harness, View::Compare);
    let card = rows(&harness, View::Compare);
    let names: Vec<&String> = card.iter().map(|row| &row[0]).collect();
    // what differs has the name of its slider
    for name in ["shaking", "stops", "restitution", "preload", "motion", "RMS velocity", "reach"] {
        named(&card, name);
    }
    // what is equal in both has no row
    assert!(!names.iter().any(|name| *name == "mass" || *name == "damping"));
    let order = |name: &str| names.iter().position(|other| *other == name).unwrap();
    assert!(order("preload") < order("motion") && order("motion") < order("RMS velocity"));
    assert_eq!(named(&card, "motion")[1], "once settled");
    for (name, unit) in [("RMS velocity", "mm/s"), ("reach", "mm")] {
        let row = named(&card, name);
        let number = |text: &str| text.trim_matches(['(', ')']).replace('\u{2212}', "-").parse::<f64>();
        let (before, now) = (number(&row[2]).unwrap(), number(&row[3]).unwrap());
        let apart = number(&row[4]).unwrap_or(0.0);
        assert!(row[1] == unit && (now - before - apart).abs() < 1e-9, "{row:?}");
    }
    assert_eq!(named(&card, "restitution")[1..], ["0.36", "0.5"]);
    assert_eq!(named(&card, "preload")[2..], ["2.7", "2.5"]);
}

#[test]
fn one_threshold_on_all_surfaces() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.wait(LONG);
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
    assert_eq!(row[2], "0.718");
    let now = &row[3];
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
    alone(&mut harness, View::Compare);
    let shown = named(&rows(&harness, View::Compare), "crosses from").last().unwrap().clone();
    assert!(shown.starts_with("about 1.1"), "{shown}");
    let text = harness.state().session.sentence().whole();
    let number = shown.trim_start_matches("about ");
    assert!(text.contains("About") && text.ends_with(&format!("short of crossing at {number} g.")), "{text}");
}

#[test]
fn the_reference_has_the_threshold_that_is_found_after_it() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.set_number("excitation.amplitude_g", 1.1).unwrap();
    harness.state_mut().session.end_gesture();
    harness.state_mut().session.wait(LONG);
    harness.run_steps(3);
    alone(&mut harness, View::Compare);
    let row = named(&rows(&harness, View::Compare), "crosses from").clone();
    assert_eq!(row[2..], ["0.718", "0.718", "(same)"]);
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
    alone(&mut harness, View::Compare);
    let row = named(&rows(&harness, View::Compare), "crosses from").clone();
    // two drives of two units, each with its own
    assert_eq!(row[1..], ["g", "0.718", "0.107 N"]);
    let text = harness.state().session.sentence().whole();
    assert!(text.contains("0.107 N"), "{text}");
}

#[test]
fn numbers_of_a_motion_that_does_not_settle_are_those_of_a_time() {
    let cases = [
        ("bouncing-ball", "from 2.5 s to 5.0 s"),
        ("paper-ramp", "from "),
        ("random-shaking", "from "),
        ("paper", "once settled"),
        ("duffing-chaos", "once settled"),
    ];
    for (preset, words) in cases {
        let mut harness = window(preset, WIDE);
        harness.run_steps(3);
        alone(&mut harness, View::Compare);
        // the note stands beside the word for the motion or below it
        let all = rows(&harness, View::Compare).concat();
        assert!(all.iter().any(|text| text.starts_with(words)), "{preset}: {all:?}");
        let summary = *harness.state().session.settled_now().unwrap();
        let settles = summary.settled.is_some() && !summary.is_transient();
        assert_eq!(all.iter().any(|text| text == "once settled"), settles, "{preset}: {all:?}");
    }
}
