//! What a person meets who sees the window for the first time: runs that end, a lesson, words, and room for
//! them.

use eframe::egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::session::sliders::reach;
use interwell::app::window::Command;
use interwell::app::window::Window;
use interwell::app::words::fields::info;
use interwell::scene::{FieldPath, PRESETS, Stops};

use crate::support::{
    LONG, click_on, command, is_painted, painted, press, press_with_ctrl, session, sliced, window,
};

const WIDE: [f32; 2] = [1280.0, 720.0];
/// In points: 1280x720 and 900x600 pixels, as they are and projected.
const SIZES: [[f32; 2]; 4] = [WIDE, [900.0, 600.0], [853.0, 480.0], [600.0, 400.0]];

fn opened(preset: &str, size: [f32; 2]) -> Harness<'static, Window> {
    window(preset, size)
}

/// Changes a number of the scene by a gesture of its own, and waits for what it comes to.
fn set(harness: &mut Harness<'static, Window>, path: &str, value: f64) {
    let session = &mut harness.state_mut().session;
    session.edit_once(|scene| assert!(FieldPath::new(path).set(scene, value)));
    session.wait(LONG);
    harness.run_steps(3);
}

fn stops_on(harness: &mut Harness<'static, Window>) {
    let session = &mut harness.state_mut().session;
    session.switch_stops(true);
    session.wait(LONG);
    harness.run_steps(3);
}

/// Shakes until the run ends.
fn shaken_out() -> Harness<'static, Window> {
    let mut harness = opened("first-look", WIDE);
    harness.key_press(Key::Num5);
    set(&mut harness, "excitation.amplitude_g", 50.0);
    harness.run_steps(60);
    assert!(harness.state().session.player.ended().is_some());
    let text = harness.state().session.sentence().text;
    assert!(text.contains("the mass went further than the flexures were computed"), "{text}");
    assert!(harness.query_by_label_contains("settling").is_none());
    harness
}

#[test]
fn a_run_that_ended_begins_again() {
    // by less shaking
    let mut harness = shaken_out();
    assert!(harness.state_mut().session.undo());
    assert_eq!(harness.state().session.player.time(), 0.0);
    harness.run_steps(60);
    let session = &harness.state().session;
    assert!(session.player.ended().is_none() && session.player.is_playing() && !session.is_continued);
    // by playing
    let mut harness = shaken_out();
    let ended_at = harness.state().session.player.time();
    harness.key_press(Key::Num3);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    let session = &harness.state().session;
    assert!(session.player.is_playing() && session.player.time() < 0.5 * ended_at);
    // stops free it where it is
    let mut harness = shaken_out();
    let ended_at = harness.state().session.player.time();
    stops_on(&mut harness);
    let session = &harness.state().session;
    assert!(session.player.ended().is_none() && session.changed_at == ended_at);
}

#[test]
fn the_lesson_says_what_the_scene_does() {
    let mut harness = opened("first-look", WIDE);
    harness.key_press(Key::Num5);
    stops_on(&mut harness);
    harness.run_steps(60);
    harness.get_by_label("Between these stops it crossed, without more shaking.");
    set(&mut harness, "mechanism.preload_mm", 3.75);
    assert_eq!(harness.state().session.crosses(), Some(false));
    assert!(harness.query_by_label_contains("it crossed").is_none());
    harness.get_by_label("Now it does not cross.");
    press_with_ctrl(&mut harness, Key::Z);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(3);
    harness.get_by_label("Between these stops it crossed, without more shaking.");
    // other shaking of another mass is another thing
    set(&mut harness, "mass_g", 15.5);
    harness.get_by_label("Between these stops it crosses.");
    // wherever the stops stand now, it is told what holds for all of them
    for limit in [1.9, 4.0, 6.875, 12.0] {
        set(&mut harness, "stops.travel_limit_mm", limit);
        harness.get_by_label("What stops do:");
        let landscape = &harness.state().session.model().mechanism().landscape;
        let well = landscape.right_stable().unwrap().x;
        let hardest =
            landscape.extrema.iter().find(|extremum| extremum.x > 1e-4 && extremum.x < well).unwrap();
        let words = format!("At ±{:.1} mm it presses hardest.", hardest.x * 1e3);
        harness.get_by_label_contains(&words);
        let session = &harness.state().session;
        let weak = harness.query_by_label_contains("Here this push does not carry it over.").is_some();
        assert_eq!(weak, session.crosses() == Some(false), "{limit}");
    }
}

#[test]
fn no_lesson_asks_for_what_is_about_to_happen() {
    let mut harness = opened("first-look", WIDE);
    harness.key_press(Key::Num5);
    set(&mut harness, "excitation.amplitude_g", 1.43);
    harness.get_by_label("Now it will cross.");
    harness.run_steps(200);
    set(&mut harness, "excitation.amplitude_g", 0.9);
    press(&mut harness, Key::Space);
    harness.get_by_label("Now with stops.");
    stops_on(&mut harness);
    assert_eq!(harness.state().session.crosses(), Some(true));
    harness.get_by_label("Between these stops it will cross.");
    // the mass was beyond them
    harness.get_by_label("The mass was set on the stop");
    harness.key_press(Key::Space);
    harness.run_steps(120);
    assert!(harness.query_by_label("The mass was set on the stop").is_none());
}

#[test]
fn the_lesson_comes_back() {
    let mut harness = opened("first-look", WIDE);
    let lesson = "Make it cross to the other side.";
    for (key, there) in [(Key::H, false), (Key::H, true), (Key::H, false), (Key::Home, true)] {
        press(&mut harness, key);
        assert_eq!(harness.query_by_label(lesson).is_some(), there, "{key:?}");
    }
    press(&mut harness, Key::H);
    command(&mut harness, Command::OpenPreset("first-look"));
    harness.get_by_label(lesson);
}

#[test]
fn changes_are_discarded_by_name_and_come_back() {
    let mut harness = opened("first-look", WIDE);
    set(&mut harness, "mass_g", 20.0);
    harness.get_by_label("Discard changes").click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.scene().mass_g, 15.2);
    assert!(harness.state().notice().is_some_and(|text| text.contains("brings them back")));
    press_with_ctrl(&mut harness, Key::Z);
    assert_eq!(harness.state().session.scene().mass_g, 20.0);
}

#[test]
fn no_slider_jumps_while_another_one_is_moved() {
    let mut harness = opened("first-look", WIDE);
    let paths = ["excitation.amplitude_g", "stops.travel_limit_mm", "excitation.frequency_hz", "mass_g"];
    let reach = |harness: &Harness<'static, Window>| {
        paths.map(|path| reach(info(path).unwrap(), &harness.state().session))
    };
    let before = reach(&harness);
    set(&mut harness, "mechanism.preload_mm", 0.1);
    assert_eq!(reach(&harness), before);
}

#[test]
fn names_stand_where_the_thing_is_drawn() {
    let mut harness = opened("bouncing-ball", WIDE);
    harness.run_steps(3);
    assert!(!is_painted(&harness, "flexure") && !is_painted(&harness, "spring"));
    assert!(is_painted(&harness, "mass") && is_painted(&harness, "a steady force of 9.81 N to the left"));
    let harness = opened("nominal-cubic", WIDE);
    assert!(is_painted(&harness, "spring") && !is_painted(&harness, "flexure"));
    assert!(is_painted(&opened("first-look", WIDE), "flexure"));
}

#[test]
fn the_force_is_that_which_holds_the_mass() {
    let mut harness = opened("paper", WIDE);
    press_with_ctrl(&mut harness, Key::Num2);
    assert!(is_painted(&harness, "holds the mass there") && is_painted(&harness, "holding force (N)"));
    assert!(!is_painted(&harness, "force of the mechanism"));
}

#[test]
fn a_reach_is_not_beyond_its_stop() {
    let mut harness = opened("first-look", WIDE);
    let stops = Stops::Rigid { travel_limit_mm: 2.25, restitution: 0.36 };
    harness.state_mut().session.edit_once(|scene| scene.stops = stops);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(3);
    click_on(&mut harness, "Compare");
    harness.get_by_label("2.25");
    assert!(harness.query_by_label("2.3").is_none());
}

#[test]
fn notes_speak_of_what_the_window_has() {
    for preset in PRESETS {
        let session = session(preset.name, &[]);
        let notes = &session.scene().notes;
        let assigned = |(at, _): (usize, &str)| notes[..at].ends_with(|c: char| c.is_ascii_lowercase());
        assert!(!notes.match_indices('=').any(assigned), "{}: {notes}", preset.name);
        assert!(!notes.contains("excitation.") && !notes.contains("run.t"), "{}: {notes}", preset.name);
        let sweeps = notes.matches("sweep").count();
        let told = ["The sweep of the command line", "The sweep, or the map of the window,"];
        assert_eq!(
            sweeps,
            told.map(|words| notes.matches(words).count()).iter().sum::<usize>(),
            "{}",
            preset.name
        );
    }
}

#[test]
fn the_walk_is_seen_within_seconds() {
    let mut harness = opened("walking", WIDE);
    // a tenth of a second each
    harness.run_steps(40);
    assert!(harness.state().session.player.watch().now().base_accel.abs() > 0.0);
}

#[test]
fn no_text_is_sliced() {
    for size in SIZES {
        for key in [Key::Num1, Key::Num2, Key::Num3] {
            let mut harness = opened("first-look", size);
            harness.key_press_modifiers(Modifiers::COMMAND, key);
            harness.key_press(Key::Num5);
            stops_on(&mut harness);
            harness.run_steps(60);
            harness.state_mut().session.wait(LONG);
            harness.run_steps(3);
            assert_eq!(sliced(&harness), [""; 0], "{size:?} {key:?}");
        }
    }
}

#[test]
fn what_stands_in_rows_is_whole() {
    for size in SIZES {
        let mut harness = opened("first-look", size);
        harness.get_by_label("View").click();
        harness.run_steps(3);
        let last = harness.get_by_label_contains("Full screen").rect();
        assert!(last.bottom() < size[1], "{size:?} {last:?}");
        press(&mut harness, Key::Escape);
    }
    // the card has all of its rows
    let mut harness = opened("first-look", WIDE);
    harness.key_press(Key::Num5);
    stops_on(&mut harness);
    harness.run_steps(60);
    set(&mut harness, "stops.travel_limit_mm", 2.25);
    click_on(&mut harness, "Compare");
    harness.get_by_label("What stops do:");
    harness.get_by_label("shaking");
    let last = harness.get_by_label("crosses from").rect();
    assert!(last.bottom() < WIDE[1] - 60.0, "{last:?}");
}

#[test]
fn notes_in_the_column_end_with_a_sentence() {
    for more in [false, true] {
        let mut harness = opened("first-look", WIDE);
        if more {
            harness.get_by_label("More").click();
            harness.run_steps(3);
        }
        harness.get_by_label("About this scene");
        let notes = harness.state().session.scene().notes.clone();
        let begin = &notes[..30];
        let found = painted(&harness).into_iter().find(|text| text.0.starts_with(begin));
        assert!(found.is_none_or(|text| text.0.ends_with('.')));
    }
}

#[test]
fn the_keys_are_all_there() {
    for size in SIZES {
        let mut harness = opened("first-look", size);
        press(&mut harness, Key::F1);
        harness.get_by_label("Time");
        if size == WIDE {
            // whole, without scrolling
            for last in ["glossary", "copy the command line that runs it"] {
                let last = harness.get_by_label(last).rect();
                assert!(last.bottom() < harness.get_by_label("Close").rect().top(), "{last:?}");
            }
            assert_eq!(sliced(&harness), [""; 0]);
        }
    }
}

#[test]
fn the_bar_of_the_present_fits_the_scene() {
    let mut harness = opened("bouncing-ball", WIDE);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Num2);
    harness.run_steps(20);
    // 1 kg that falls 1 m
    let end = painted(&harness).into_iter().map(|text| text.0).find(|text| text.ends_with("0 J"));
    assert_eq!(end.as_deref(), Some("10 J"));
}
