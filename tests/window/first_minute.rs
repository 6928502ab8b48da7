//! The first minute of a new user, and changes by hand.

use eframe::egui::{Event, Key, Modifiers, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::window::Window;
use interwell::dynamics::{EventKind, Sample};
use interwell::scene::Stops;

use crate::support::{LONG, WIDE, press, press_with_ctrl, says, window};

#[test]
fn it_opens_and_plays() {
    let mut harness = window("first-look", WIDE);
    harness.get_by_label("Well");
    says(&harness, "Intrawell: will swing in the right-hand well");
    harness.get_by_label_contains("Make it cross");
    let before = harness.state().session.player.time();
    harness.run_steps(10);
    let after = harness.state().session.player.time();
    assert!(after > before);
    press(&mut harness, Key::Space);
    let paused = harness.state().session.player.time();
    harness.run_steps(5);
    assert_eq!(harness.state().session.player.time(), paused);
    press(&mut harness, Key::Num5);
    assert_eq!(harness.state().session.player.speed, 1.0);
}

#[test]
fn shaking_harder_and_stops_both_make_it_cross() {
    for harder in [true, false] {
        let mut harness = window("first-look", WIDE);
        harness.run_steps(20);
        let seen = |harness: &Harness<'static, Window>| -> Vec<Sample> {
            harness.state().session.player.watch().samples().iter().copied().collect()
        };
        let before = seen(&harness);
        if harder {
            let slider = harness.get_by_role_and_label(Role::Slider, "amplitude");
            slider.set_value_accesskit(1.4);
        } else {
            harness.get_by_role_and_label(Role::CheckBox, "Stops").click();
        }
        harness.run_steps(2);
        // it goes on from where it was: what was seen stays, and nothing jumps but by a stop that carries the
        // mass
        let (after, changed) = (seen(&harness), harness.state().session.changed_at);
        assert!(before.len() > 5 && after.starts_with(&before) && changed >= before[before.len() - 1].t);
        let then = after.iter().position(|sample| sample.t == changed).unwrap();
        let (sample, next) = (after[then], after[then + 1]);
        let straight = sample.x + sample.v * (next.t - sample.t);
        assert!(
            if harder { (next.x - straight).abs() < 1e-4 } else { next.x == 1.5e-3 },
            "{sample:?} {next:?}"
        );
        assert!(harness.state().session.editor.can_undo());
        harness.state_mut().session.wait_settled(LONG);
        harness.key_press(Key::Num5);
        harness.run_steps(240);
        let watch = harness.state().session.player.watch();
        assert!(watch.events().iter().any(|event| event.kind == EventKind::Crossing), "{harder}");
        assert!(harness.query_by_label_contains("Make it cross").is_none());
        // one gesture, one step back
        press_with_ctrl(&mut harness, Key::Z);
        let session = &harness.state().session;
        assert_eq!((session.amplitude_g(), session.scene().stops), (Some(0.9), Stops::None));
        press_with_ctrl(&mut harness, Key::Y);
        assert!(harness.state().session.editor.is_dirty());
    }
}

#[test]
fn a_dragged_slider_is_one_step() {
    let mut harness = window("first-look", WIDE);
    let rail = harness.get_by_role_and_label(Role::Slider, "amplitude").rect();
    let at = |share: f32| eframe::egui::pos2(rail.left() + share * rail.width(), rail.center().y);
    harness.drag_at(at(0.3));
    harness.run_steps(2);
    for share in [0.35, 0.4, 0.45, 0.5] {
        harness.hover_at(at(share));
        harness.run_steps(1);
    }
    harness.drop_at(at(0.5));
    harness.run_steps(2);
    let session = &mut harness.state_mut().session;
    assert_ne!(session.amplitude_g(), Some(0.9));
    assert!(!session.editor.in_gesture());
    assert!(session.undo() && session.amplitude_g() == Some(0.9));
    assert!(!session.undo());
}

#[test]
fn a_typed_number_is_one_step() {
    let mut harness = window("first-look", WIDE);
    harness.get_all_by_role(Role::SpinButton).next().unwrap().click();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.run_steps(1);
    for text in ["1", ".", "3"] {
        harness.event(Event::Text(text.to_owned()));
        harness.run_steps(2);
        // half of a number is not meant
        assert_eq!(harness.state().session.amplitude_g(), Some(0.9));
    }
    press(&mut harness, Key::Enter);
    assert_eq!(harness.state().session.amplitude_g(), Some(1.3));
    assert!(harness.state_mut().session.undo());
    assert_eq!(harness.state().session.amplitude_g(), Some(0.9));
    assert!(!harness.state_mut().session.undo());
}

#[test]
fn a_change_keeps_the_motion_continuous() {
    let mut harness = window("first-look", WIDE);
    harness.key_press(Key::Num5);
    harness.run_steps(60);
    let session = &mut harness.state_mut().session;
    let before = session.player.state();
    session.edit_once(|scene| scene.mass_g = 18.0);
    let after = session.player.state();
    assert_eq!((before.t, before.x), (after.t, after.x));
    assert!((before.v - after.v).abs() < 1e-9);
    // a stop in the way carries it along, and nothing ever jumps but at an impact
    session.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: 4.0, restitution: 0.3 });
    assert!(session.player.state().x <= 4e-3);
    assert!(session.player.watch().ledger().by_hand_j > 0.0);
}

#[test]
fn events_time_and_the_start_are_reached() {
    let mut harness = window("paper", WIDE);
    press(&mut harness, Key::PageDown);
    let first = harness.state().session.player.time();
    assert!(first > 0.0 && !harness.state().session.player.is_playing());
    press(&mut harness, Key::PageDown);
    let second = harness.state().session.player.time();
    assert!(second > first);
    press(&mut harness, Key::PageUp);
    assert_eq!(harness.state().session.player.time(), first);
    harness.get_by_label("restart").click();
    harness.run_steps(2);
    assert!(harness.state().session.player.time() < first);
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 20.0);
    press(&mut harness, Key::Home);
    assert_eq!(harness.state().session.scene().mass_g, 15.2);
}

#[test]
fn a_small_window_shows_it_without_scrolling() {
    let mut harness = window("first-look", [853.0, 480.0]);
    harness.run_steps(3);
    let inside =
        |rect: eframe::egui::Rect| rect.right() <= 853.0 && rect.bottom() <= 480.0 && rect.left() >= 0.0;
    for label in ["Well", "Mechanism", "Displacement", "pause", "Controls"] {
        assert!(inside(harness.get_by_label(label).rect()), "{label}");
    }
    harness.get_by_label("Controls").click();
    harness.run_steps(3);
    for name in ["amplitude", "travel limit ±"] {
        assert!(inside(harness.get_by_role_and_label(Role::Slider, name).rect()), "{name}");
    }
    // below the others, where one scrolls to
    harness.get_by_label("More").click_accesskit();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Slider, "mass");
}

#[test]
fn a_scene_that_does_not_open_says_why() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().open_another("nowhere.ron");
    harness.run_steps(2);
    assert!(harness.state().message().is_some_and(|text| text.contains("no such file")));
    harness.get_by_label("Close").click();
    harness.run_steps(2);
    assert!(harness.state().message().is_none());
    for preset in interwell::scene::PRESETS {
        harness.state_mut().open_another(preset.name);
        harness.run_steps(4);
        assert!(harness.state().message().is_none(), "{}", preset.name);
    }
}
