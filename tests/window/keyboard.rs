//! Hold, move and change by the keyboard alone.

use eframe::egui::{Key, Modifiers, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use interwell::app::ui::settings::Settings;
use interwell::app::window::{Command, Window};
use interwell::scene::{Layout, Stops};

use crate::support::{WIDE, command, press, says, window, window_with};

#[test]
fn the_mass_is_held_moved_and_let_go() {
    let mut harness = window("first-look", WIDE);
    press(&mut harness, Key::G);
    assert!(harness.state().session.player.is_held());
    says(&harness, "Held at ");
    let (time, x) = (harness.state().session.player.time(), harness.state().session.player.state().x);
    for _ in 0..3 {
        press(&mut harness, Key::ArrowLeft);
    }
    let moved = harness.state().session.player.state().x;
    assert!((x - moved - 0.3e-3).abs() < 0.06e-3, "{x} {moved}");
    harness.key_press_modifiers(Modifiers::SHIFT, Key::ArrowLeft);
    harness.run_steps(2);
    let further = harness.state().session.player.state().x;
    assert!((moved - further - 1e-3).abs() < 1e-9);
    assert_eq!(harness.state().session.player.time(), time);
    press(&mut harness, Key::Enter);
    assert!(!harness.state().session.player.is_held());
    assert!(harness.state().session.player.time() > time);
    // a view that goes while it has the mass lets go of it
    press(&mut harness, Key::G);
    assert!(harness.state().session.player.is_held());
    harness.get_by_label("fill the window with Displacement").click();
    harness.run_steps(4);
    assert!(!harness.state().session.player.is_held());
}

#[test]
fn sliders_and_stops_go_by_named_steps() {
    let mut harness = window("first-look", WIDE);
    harness.get_by_role_and_label(Role::Slider, "amplitude").focus();
    harness.run_steps(2);
    press(&mut harness, Key::ArrowRight);
    assert_eq!(harness.state().session.amplitude_g(), Some(0.91));
    harness.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
    harness.run_steps(2);
    assert_eq!(harness.state().session.amplitude_g(), Some(1.01));
    harness.get_by_role_and_label(Role::CheckBox, "Stops").click();
    harness.run_steps(3);
    let stop = |harness: &egui_kittest::Harness<'static, interwell::app::window::Window>| {
        harness.query_all_by_label("right stop").next().map(|node| node.accesskit_node().numeric_value())
    };
    assert_eq!(stop(&harness), Some(Some(1.5)));
    harness.query_all_by_label("right stop").next().unwrap().focus();
    harness.run_steps(2);
    press(&mut harness, Key::ArrowRight);
    let Stops::Rigid { travel_limit_mm, .. } = harness.state().session.scene().stops else { panic!() };
    assert!((travel_limit_mm - 1.55).abs() < 1e-9);
}

#[test]
fn the_keys_are_listed() {
    let mut harness = window("first-look", WIDE);
    press(&mut harness, Key::F1);
    harness.get_by_label("let go of the mass");
    press(&mut harness, Key::F1);
    assert!(harness.query_by_label("let go of the mass").is_none());
}

#[test]
fn the_projector_keeps_the_view_over_the_window_and_is_light() {
    let mut harness = window_with("first-look", WIDE, Settings { dark: true, ..Settings::default() });
    command(&mut harness, Command::Fill);
    harness.get_by_label("all views");
    // to the projector and back, each another room for the views
    for _ in 0..2 {
        harness.key_press(Key::P);
        harness.run_steps(4);
        harness.get_by_label("all views");
    }
    let listed = |harness: &mut Harness<'static, Window>| {
        command(harness, Command::Shortcuts);
        let listed = harness.query_by_label("light letters on a dark ground").is_some();
        press(harness, Key::F1);
        listed
    };
    assert!(listed(&mut harness));
    harness.key_press(Key::P);
    harness.run_steps(4);
    assert!(!listed(&mut harness));
    press(&mut harness, Key::D);
    assert!(harness.state().settings.dark && harness.state().settings.projector);
    assert!(harness.state().notice().is_some_and(|text| text.contains("The projector is light")));
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::Z);
    assert!(harness.query_by_label("all views").is_some());
    // an arrangement that is asked for has all views
    command(&mut harness, Command::Arrange(Layout::Study));
    assert!(harness.query_by_label("all views").is_none());
}
