//! Typed numbers: unchanged where they are passed through, kept to the last digit, refused in words.

use eframe::egui::{Event, Key, Modifiers, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use interwell::app::window::Window;
use interwell::scene::{Excitation, FieldPath, Stops};

use crate::support::{LONG, click_on, command, press, wait_until, window};

const TALL: [f32; 2] = [1280.0, 1600.0];

fn opened(preset: &str) -> Harness<'static, Window> {
    let mut harness = window(preset, TALL);
    harness.get_by_label("More").click();
    harness.run_steps(3);
    harness.get_by_label("Advanced").click();
    harness.run_steps(15);
    harness
}

/// Types into the field beside the slider called `name`, and leaves it by Enter.
pub fn type_into(harness: &mut Harness<'static, Window>, name: &str, text: &str) {
    harness.get_by_role_and_label(Role::SpinButton, name).click();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.run_steps(1);
    harness.event(Event::Text(text.to_owned()));
    harness.run_steps(2);
    press(harness, Key::Enter);
}

fn number(harness: &Harness<'static, Window>, path: &str) -> f64 {
    FieldPath::new(path).get(harness.state().session.scene()).unwrap()
}

#[test]
fn a_field_that_is_passed_through_writes_nothing() {
    for preset in ["duffing", "first-look", "paper", "elastic-box", "random-shaking"] {
        let mut harness = opened(preset);
        let before = harness.state().session.scene().clone();
        let fields = harness.get_all_by_role(Role::SpinButton).count();
        assert!(fields >= 3, "{preset}: {fields}");
        for i in 0..fields {
            harness.get_all_by_role(Role::SpinButton).nth(i).unwrap().click();
            harness.run_steps(2);
            // the field is a text while it is edited
            press(&mut harness, Key::Enter);
            assert_eq!(*harness.state().session.scene(), before, "{preset}: field {i} by a click and Enter");
        }
        for i in 0..80 {
            harness.key_press(Key::Tab);
            harness.run_steps(1);
            assert_eq!(*harness.state().session.scene(), before, "{preset}: after {i} times Tab");
        }
        assert!(!harness.state().session.editor.can_undo() && !harness.state().session.editor.is_dirty());
    }
}

#[test]
fn what_is_typed_is_what_is_stored_and_shown() {
    let mut harness = opened("first-look");
    for (name, path, text, value) in [
        ("amplitude", "excitation.amplitude_g", "1.137", 1.137),
        ("mass", "mass_g", "15.2345", 15.2345),
        ("preload", "mechanism.preload_mm", "2.7125", 2.7125),
        ("frequency", "excitation.frequency_hz", "3.12345 Hz", 3.12345),
    ] {
        type_into(&mut harness, name, text);
        assert_eq!(number(&harness, path), value);
        let field = harness.get_by_role_and_label(Role::SpinButton, name);
        let shown = field.accesskit_node().value().unwrap();
        assert!(shown.starts_with(&value.to_string()), "{shown}");
    }
    // a number of many digits keeps them, and its field shows more than a step has
    let harness = opened("duffing");
    let shown = harness.get_by_role_and_label(Role::SpinButton, "amplitude").accesskit_node().value();
    assert_eq!(shown.as_deref(), Some("0.0377295 g"));
}

#[test]
fn what_is_no_number_is_refused_in_words() {
    let mut harness = opened("paper");
    let before = harness.state().session.scene().clone();
    for (name, text, words) in [
        ("amplitude", "abc", "“abc” is no number: amplitude stays 1 g"),
        ("amplitude", "1e9", "amplitude may be 0 to 10000 g"),
        ("amplitude", "-3", "\u{2212}3 g was not taken: amplitude may be 0 to 10000 g"),
        ("travel limit ±", "0", "travel limit ± may be 0.001 to 1000000 mm"),
        ("travel limit ±", "-2", "travel limit ± may be 0.001 to 1000000 mm"),
        ("frequency", "0", "frequency may be 0.01 to 100000 Hz"),
        ("restitution", "1.5", "restitution may be 0 to 1"),
        ("run length", "1e9", "run length may be 0.01 to 1000000 s"),
        ("mass", "1,500", "Write it with a point"),
    ] {
        type_into(&mut harness, name, text);
        assert_eq!(*harness.state().session.scene(), before, "{name}: {text}");
        harness.get_by_label_contains(words);
    }
    // what can be taken ends the words
    type_into(&mut harness, "amplitude", "0.8");
    assert!(harness.query_by_label_contains("Write it with a point").is_none());
    assert_eq!(harness.state().session.amplitude_g(), Some(0.8));
    // a comma stands for a point where it can stand for nothing else
    type_into(&mut harness, "amplitude", "1,2");
    assert_eq!(harness.state().session.amplitude_g(), Some(1.2));
}

#[test]
fn what_two_fields_say_together_is_said_with_their_names() {
    let mut harness = opened("random-shaking");
    type_into(&mut harness, "lowest", "7");
    harness.get_by_label_contains("7.0 Hz was not taken: highest must be above lowest = 7");
    assert_eq!(number(&harness, "excitation.low_hz"), 1.0);
    // a scene that cannot run says so with the names of its controls
    harness.state_mut().session.edit_once(|scene| {
        scene.stops = Stops::Rigid { travel_limit_mm: 0.0, restitution: 0.5 };
    });
    let fault = harness.state().session.sentence().text;
    assert!(fault.starts_with("This scene cannot run: travel limit ± = 0 mm: must be"), "{fault}");
}

#[test]
fn the_stops_that_are_off_come_where_they_were() {
    let mut harness = window("first-look", [1280.0, 720.0]);
    harness.get_by_role_and_label(Role::CheckBox, "Stops").click();
    harness.run_steps(3);
    let slider = harness.get_by_role_and_label(Role::Slider, "travel limit ±");
    slider.set_value_accesskit(2.25);
    harness.run_steps(3);
    let stops = |harness: &Harness<'static, Window>| harness.state().session.scene().stops;
    assert_eq!(stops(&harness), Stops::Rigid { travel_limit_mm: 2.25, restitution: 0.36 });
    harness.get_by_role_and_label(Role::CheckBox, "Stops").click();
    harness.run_steps(3);
    assert_eq!(stops(&harness), Stops::None);
    let shown = |harness: &Harness<'static, Window>| {
        harness.get_by_role_and_label(Role::Slider, "travel limit ±").accesskit_node().numeric_value()
    };
    assert_eq!(shown(&harness), Some(2.25));
    // the start again, the stops that would come with it
    press(&mut harness, Key::Home);
    assert_eq!((stops(&harness), shown(&harness)), (Stops::None, Some(1.5)));
}

#[test]
fn a_scene_of_other_size_gets_stops_and_shaking_of_its_own() {
    let mut harness = window("duffing", [1280.0, 720.0]);
    harness.get_by_role_and_label(Role::CheckBox, "Stops").click();
    harness.run_steps(3);
    let Stops::Rigid { travel_limit_mm, .. } = harness.state().session.scene().stops else { panic!() };
    assert!((100.0..500.0).contains(&travel_limit_mm), "{travel_limit_mm}");
    harness.get_by_role_and_label(Role::Slider, "amplitude").focus();
    harness.run_steps(2);
    press(&mut harness, Key::ArrowRight);
    let Excitation::Sine { amplitude_g, .. } = harness.state().session.scene().excitation else { panic!() };
    assert!(amplitude_g > 0.0377 && amplitude_g < 0.0385, "{amplitude_g}");
}

#[test]
fn presses_of_a_key_are_one_step() {
    let mut harness = window("first-look", [1280.0, 720.0]);
    harness.get_by_role_and_label(Role::Slider, "amplitude").focus();
    harness.run_steps(2);
    for _ in 0..5 {
        harness.key_press(Key::ArrowRight);
        harness.run_steps(2);
    }
    assert_eq!(harness.state().session.amplitude_g(), Some(0.95));
    // the hand rests: what comes then is another gesture
    harness.run_steps(80);
    assert!(!harness.state().session.editor.in_gesture());
    press(&mut harness, Key::ArrowRight);
    // another field is another gesture at once
    harness.get_by_role_and_label(Role::Slider, "frequency").focus();
    harness.run_steps(2);
    press(&mut harness, Key::ArrowRight);
    assert!(number(&harness, "excitation.frequency_hz") > 3.0);
    let session = &mut harness.state_mut().session;
    assert!(session.undo() && session.number("excitation.frequency_hz") == Some(3.0));
    assert_eq!(session.amplitude_g(), Some(0.96));
    assert!(session.undo() && session.amplitude_g() == Some(0.95));
    assert!(session.undo() && session.amplitude_g() == Some(0.9) && !session.undo());
}

#[test]
fn what_takes_long_can_be_stopped_and_a_newer_change_takes_its_place() {
    let mut harness = window("first-look", [1280.0, 720.0]);
    harness.state_mut().session.edit_once(|scene| scene.run.duration_s = 1e9);
    harness.run_steps(2);
    assert!(harness.state().session.sentence().text.starts_with("Working out"));
    // the motion goes on meanwhile
    let time = harness.state().session.player.time();
    harness.run_steps(5);
    assert!(harness.state().session.player.time() > time);
    wait_until("it is offered to stop", || {
        harness.run_steps(1);
        harness.query_by_label_contains("Stop computing (").is_some()
    });
    harness.get_by_label_contains("Stop computing (").click();
    harness.run_steps(2);
    assert!(harness.state().session.working().is_none());
    assert!(harness.query_by_label_contains("Stop computing (").is_none());
    let text = harness.state().session.sentence().text;
    assert!(text.starts_with("Stopped before it was known"), "{text}");
    harness.state_mut().session.edit_once(|scene| scene.run.duration_s = 1e9);
    command(&mut harness, interwell::app::window::Command::Undo);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(2);
    let text = harness.state().session.sentence().text;
    assert!(
        text.contains("swing in the right-hand well") || text.contains("swings in the right-hand well"),
        "{text}"
    );
}

#[test]
fn the_card_shows_whatever_was_changed() {
    let mut harness = opened("paper");
    click_on(&mut harness, "Compare");
    for (name, text, words) in [
        ("restitution", "0.45", "0.45"),
        ("mass", "18.25", "18.25"),
        ("damping ratio", "0.0312", "0.0312"),
        ("frequency", "3.05", "1.00\u{a0}g, 3.05\u{a0}Hz"),
        ("preload", "2.65", "2.65"),
        ("run length", "12", "12"),
    ] {
        let labels = |harness: &Harness<'static, Window>, text: &str| {
            let all = harness.query_all_by_label(text);
            all.filter(|node| node.accesskit_node().role() == Role::Label).count()
        };
        let before = (labels(&harness, name), labels(&harness, words));
        type_into(&mut harness, name, text);
        harness.run_steps(2);
        // the row is there, and of a frequency it is that of the shaking
        assert_eq!(labels(&harness, words), before.1 + 1, "{name}");
        assert_eq!(labels(&harness, name), before.0 + usize::from(name != "frequency"), "{name}");
    }
}

#[test]
fn a_hover_text_stays_away_from_what_was_just_changed() {
    let mut harness = window("first-look", [1280.0, 720.0]);
    let rail = harness.get_by_role_and_label(Role::Slider, "amplitude").rect();
    let at = |share: f32| eframe::egui::pos2(rail.left() + share * rail.width(), rail.center().y);
    let explained = |harness: &Harness<'static, Window>| {
        harness.query_all_by_label_contains("Increase: the base pushes").next().is_some()
    };
    harness.hover_at(at(0.45));
    harness.run_steps(8);
    assert!(explained(&harness));
    harness.drag_at(at(0.45));
    harness.run_steps(1);
    harness.hover_at(at(0.6));
    harness.run_steps(1);
    harness.drop_at(at(0.6));
    harness.run_steps(1);
    harness.hover_at(at(0.61));
    harness.run_steps(8);
    assert!(!explained(&harness));
    // away and back it explains again
    harness.hover_at(eframe::egui::pos2(900.0, 300.0));
    harness.run_steps(3);
    harness.hover_at(at(0.5));
    harness.run_steps(8);
    assert!(explained(&harness));
}
