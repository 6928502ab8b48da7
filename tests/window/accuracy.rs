//! The view Accuracy, and the error of the motion in the status line.

use eframe::egui::{Key, Modifiers, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::views::View;
use interwell::app::window::Command;
use interwell::app::window::Window;
use interwell_studies::study::accuracy::methods::Scheme;

use crate::support::{LONG, PROJECTED, WIDE, command, press, session, window};

/// The view over the whole window, with everything worked out.
fn filled(preset: &str, size: [f32; 2]) -> Harness<'static, Window> {
    let mut harness = window(preset, size);
    harness.key_press(Key::Space);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, view == View::Accuracy));
    }
    come(&mut harness);
    harness
}

fn come(harness: &mut Harness<'_, Window>) {
    harness.run_steps(2);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(2);
}

fn is_there(harness: &Harness<'_, Window>, words: &str) -> bool {
    harness.query_all_by_label_contains(words).next().is_some()
}

#[test]
fn the_table_fills_and_the_step_changes_the_numbers() {
    let mut harness = filled("nominal-cubic", WIDE);
    for words in
        ["What a digit costs", "1e-3", "1e-6", "1e-9", "1e-12", "Impacts arrive 14 ms late", "38 % too high"]
    {
        assert!(is_there(&harness, words), "{words}");
    }
    harness.get_by_label("1 ms").click();
    come(&mut harness);
    assert_eq!(harness.state().session.accuracy.step, 1e-3);
    assert!(is_there(&harness, "0.55 ms late") && !is_there(&harness, "14 ms late"));
    assert!(is_there(&harness, "4240 impacts counted"));
    // another method, by its list
    harness.get_by_role_and_label(Role::ComboBox, "method").click();
    harness.run_steps(3);
    harness.get_by_label("semi-implicit Euler").click();
    come(&mut harness);
    assert_eq!(harness.state().session.accuracy.scheme, Scheme::SemiImplicitEuler);
    assert!(is_there(&harness, "5400 impacts counted"));
    // another scene by hand
    harness.state_mut().session.switch_stops(false);
    come(&mut harness);
    assert!(!is_there(&harness, "impacts counted"));
}

#[test]
fn a_projector_shows_one_part_at_a_time() {
    let mut harness = window("paper", PROJECTED);
    harness.key_press(Key::Space);
    command(&mut harness, Command::Show(View::Accuracy, true));
    come(&mut harness);
    assert!(is_there(&harness, "of processor time") && !is_there(&harness, "1e-12"));
    let within = |harness: &Harness<'_, Window>, words: &str| {
        let rect = harness.query_all_by_label_contains(words).next().unwrap().rect();
        assert!(rect.right() <= PROJECTED[0] && rect.bottom() <= PROJECTED[1] - 40.0, "{words}: {rect:?}");
    };
    within(&harness, "of processor time");
    harness.get_by_label("What a digit costs").click();
    come(&mut harness);
    within(&harness, "1e-12");
}

#[test]
fn closed_it_works_nothing_out() {
    let mut harness = window("paper", WIDE);
    harness.run_steps(5);
    let nothing = |harness: &Harness<'_, Window>| {
        let session = &harness.state().session;
        (
            session.accuracy.tolerances(session.model()).is_none(),
            session.accuracy.stepped(session.model()).is_none(),
        )
    };
    harness.state_mut().session.wait(LONG);
    harness.run_steps(2);
    assert_eq!(nothing(&harness), (true, true));
    command(&mut harness, Command::Show(View::Accuracy, true));
    come(&mut harness);
    assert_eq!(nothing(&harness), (false, false));
    // what is shown of a scene that has changed is marked as old until the new one is there
    command(&mut harness, Command::Show(View::Accuracy, false));
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 15.0);
    come(&mut harness);
    let session = &harness.state().session;
    assert!(session.accuracy.tolerances(session.model()).is_some_and(|(_, current)| !current));
    assert!(session.accuracy.working().is_none());
}

#[test]
fn covered_it_says_nothing() {
    let mut harness = filled("paper", WIDE);
    press(&mut harness, Key::C);
    assert!(!is_there(&harness, "of processor time") && !is_there(&harness, "Path error"));
}

#[test]
fn the_bar_of_time_says_the_error_or_how_long_to_trust() {
    for (preset, words) in [
        ("paper", "Path error below 1 nm"),
        ("random-shaking", "Path error "),
        ("duffing-chaos", "Path reliable up to "),
        // the mass rattles at the wall of taut flexures without a rhythm
        ("first-look", "Path reliable up to "),
    ] {
        for size in [WIDE, PROJECTED] {
            let mut harness = window(preset, size);
            harness.state_mut().session.wait(LONG);
            harness.run_steps(2);
            let rect = harness.get_by_label_contains(words).rect();
            let bar = harness.get_by_label("time").rect();
            assert!(rect.left() >= bar.left() && rect.right() <= size[0], "{preset}: {rect:?}");
            assert!(rect.top() >= bar.bottom() - 1.0, "{preset}: {rect:?}");
        }
    }
}

#[test]
fn nothing_is_said_of_what_is_not_known() {
    let mut session = session("paper", &[]);
    let (short, long) = session.trust().unwrap();
    assert!(
        short == "Path error below 1 nm" && long.contains("1e-11") && long.contains("10 s"),
        "{short} {long}"
    );
    // in the midst of a gesture
    session.edit(|scene| scene.mass_g = 14.0);
    session.poll();
    assert_eq!(session.trust(), None);
    session.wait(LONG);
    assert_eq!(session.trust(), None);
    session.end_gesture();
    session.wait(LONG);
    assert!(session.trust().is_some());
    // held by hand, and with a scene that cannot run
    session.player.hold(1e-3);
    assert_eq!(session.trust(), None);
    session.player.let_go();
    session.moved_by_hand();
    assert_eq!(session.trust(), None);
    session.wait(LONG);
    assert!(session.trust().is_some());
    session.edit_once(|scene| scene.mass_g = -1.0);
    session.poll();
    assert!(session.fault().is_some() && session.trust().is_none());
    // a run that leaves its table has an end, not an error
    let mut ends = self::session("paper-table", &["stops=None", "excitation.amplitude_g=6"]);
    ends.wait(LONG);
    assert_eq!(ends.trust(), None, "{}", ends.sentence().text);
}

#[test]
fn the_error_follows_a_motion_that_goes_on_and_on() {
    let mut session = session("paper", &[]);
    session.player.speed = 1.0;
    assert!(session.trust().unwrap().1.contains("over 10 s"));
    while session.player.time() < 12.0 {
        session.player.tick(0.1);
    }
    session.poll();
    session.wait(LONG);
    let (_, long) = session.trust().unwrap();
    assert!(long.contains("over 24"), "{long}");
    // after a change it is counted from there
    session.edit_once(|scene| scene.mass_g = 15.0);
    session.wait(LONG);
    let (_, long) = session.trust().unwrap();
    assert!(long.contains("10 s after 12"), "{long}");
}

#[test]
fn a_ramp_that_was_changed_on_its_way_has_no_known_error() {
    let mut session =
        session("paper-ramp", &["run.duration_s=20", "run.settle_s=10", "excitation.over_s=10"]);
    assert!(session.trust().is_some());
    session.player.tick(0.1);
    session.edit_once(|scene| scene.mass_g = 15.0);
    session.wait(LONG);
    assert_eq!(session.trust(), None);
    session.restart();
    session.wait(LONG);
    assert!(session.trust().is_some());
}

#[test]
fn undo_is_not_for_the_method() {
    let mut harness = filled("paper", WIDE);
    harness.get_by_label("0.1 ms").click();
    come(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    come(&mut harness);
    assert_eq!(harness.state().session.accuracy.step, 1e-4);
    assert!(!harness.state().session.editor.can_undo());
}
