//! The layout Explore: the scene turned up and down, asked for while it is looked at.

use eframe::egui::{Key, Modifiers, PointerButton, accesskit::Role, vec2};
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::session::Session;
use interwell::app::session::explore::WalkQuantity;
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::{Layout, Start, Stops};
use interwell_studies::study::{Direction, Signal};

use crate::cursors::drag;
use crate::shared::axis;
use crate::support::{LONG, PROJECTED, WIDE, command, painted, press_with_ctrl, session, wait_until, window};

const AMPLITUDE: &str = "excitation.amplitude_g";

fn open(size: [f32; 2]) -> Harness<'static, Window> {
    let mut harness = window("first-look", size);
    harness.state_mut().session.explore.walks.chosen = Some(axis(AMPLITUDE, (0.8, 1.3, 0.1)));
    press_with_ctrl(&mut harness, Key::Num5);
    harness
}

fn fill(harness: &mut Harness<'static, Window>) {
    wait_until("the walks", || {
        harness.run_steps(1);
        harness.state().session.explore.walks.found.is_whole()
    });
}

/// Values and directions of the fine runs, in the order in which they came.
fn fine(window: &Window, direction: Direction) -> Vec<f64> {
    let (parts, current) = window.session.explore.walks.found.parts();
    assert!(current);
    let chosen = parts.iter().filter(|part| part.0 == 1 && part.1.direction == direction);
    chosen.map(|part| part.1.value).collect()
}

#[test]
fn a_lesson_shows_no_coarse_steps() {
    for is_lesson in [false, true] {
        let mut harness = window("first-look", WIDE);
        let session = &mut harness.state_mut().session;
        session.is_lesson = is_lesson;
        session.explore.walks.chosen = Some(axis(AMPLITUDE, (0.8, 1.3, 0.1)));
        press_with_ctrl(&mut harness, Key::Num5);
        fill(&mut harness);
        let (parts, _) = harness.state().session.explore.walks.found.parts();
        assert_eq!(parts.iter().any(|part| part.0 > 1), !is_lesson);
        assert_eq!(fine(harness.state(), Direction::Down).len(), 6);
    }
}

#[test]
fn both_directions_come_and_a_click_or_its_line_takes_the_scene_there() {
    let mut harness = open(WIDE);
    fill(&mut harness);
    let up = fine(harness.state(), Direction::Up);
    assert_eq!(up, [0.8, 0.9, 1.0, 1.1, 1.2, 1.3]);
    let down = fine(harness.state(), Direction::Down);
    assert!(down.iter().rev().eq(up.iter()));
    let before = harness.state().session.scene().clone();
    let name = "RMS velocity (mm/s) over amplitude, turned up and down";
    let place = harness.get_by_role_and_label(Role::Canvas, name).rect();
    harness.drag_at(place.center());
    harness.run_steps(1);
    harness.drop_at(place.center());
    // until it can be no double click
    harness.run_steps(6);
    let amplitude = |harness: &Harness<'_, Window>| harness.state().session.amplitude_g().unwrap();
    let clicked = amplitude(&harness);
    assert!(clicked == 1.0 || clicked == 1.1, "{clicked}");
    // the field that is walked has no part in the question: what is known stays
    assert!(harness.state().session.explore.walks.found.is_whole());
    // the line at the scene goes with the hand; elsewhere a drag pans
    let share = ((clicked - 0.8) / 0.5) as f32;
    let [line, right] = [share, 0.9].map(|x| place.lerp_inside(vec2(x, 0.5)));
    drag(&mut harness, line, right, (PointerButton::Primary, Modifiers::NONE));
    let dragged = amplitude(&harness);
    assert!(dragged > clicked, "{clicked} {dragged}");
    assert_eq!(harness.state().memory.chosen_axes(View::UpAndDown), [None; 2]);
    let session = &mut harness.state_mut().session;
    assert!(session.undo() && session.undo() && *session.scene() == before && !session.undo());
    session.explore.walks.quantity = WalkQuantity::Strobes;
    harness.run_steps(3);
    harness.get_by_label("displacement once a period (mm) over amplitude, turned up and down");
}

#[test]
fn another_scene_is_walked_anew_and_a_closed_view_asks_for_nothing() {
    let mut harness = open(WIDE);
    fill(&mut harness);
    harness.state_mut().session.edit_once(|scene| scene.mass_g *= 1.1);
    let mass = harness.state().session.scene().mass_g;
    wait_until("the question of the heavier mass", || {
        harness.run_steps(1);
        let question = harness.state().session.explore.walks.found.question();
        question.is_some_and(|asked| asked.scene.mass_g == mass)
    });
    command(&mut harness, Command::Arrange(Layout::Look));
    assert!(!harness.state().session.explore.walks.found.is_running());
    command(&mut harness, Command::Arrange(Layout::Explore));
    fill(&mut harness);
    assert_eq!(fine(harness.state(), Direction::Up).len(), 6);
}

#[test]
fn a_scene_that_cannot_be_walked_says_why() {
    let mut harness = window("random-shaking", PROJECTED);
    command(&mut harness, Command::Arrange(Layout::Explore));
    harness.get_by_label("Up and down").click();
    harness.run_steps(3);
    harness.get_by_label_contains("which needs a drive that repeats");
}

#[test]
fn basins_come_coarse_first_and_a_click_begins_there() {
    let mut harness = window("paper", WIDE);
    command(&mut harness, Command::Arrange(Layout::Explore));
    harness.get_by_label("Basins").click();
    wait_until("the basins", || {
        harness.run_steps(1);
        harness.state().session.explore.basins.is_whole()
    });
    let (parts, current) = harness.state().session.explore.basins.parts();
    assert!(current && parts.len() > 1);
    let last = parts.last().unwrap().as_ref().unwrap();
    // each start is followed once more, by which those that are not sure are paler
    assert_eq!(last.answer.sure.len(), last.answer.rows.len());
    // a motion that rests on a stop forgets its start: one attractor, and all starts go to it
    assert_eq!((last.answer.attractors.len(), last.answer.lost + last.answer.undecided), (1, 0));
    assert_eq!(last.answer.attractors[0].starts, last.answer.rows.iter().flatten().count() as u64);
    let before = harness.state().session.scene().clone();
    let place = harness.get_by_role_and_label(Role::Canvas, "basins of attraction").rect();
    harness.drag_at(place.center());
    harness.run_steps(1);
    harness.drop_at(place.center());
    // it is known after a while that it was no double click
    harness.run_steps(30);
    let session = &mut harness.state_mut().session;
    let Start::At { x_mm, .. } = session.scene().start else { panic!("{:?}", session.scene().start) };
    assert!(x_mm.abs() < 1.0, "{x_mm}");
    assert!(session.player.watch().time() < 0.5);
    // the start has no part in the question
    assert!(session.explore.basins.is_whole());
    assert!(session.undo() && *session.scene() == before);
}

#[test]
fn basins_that_come_between_two_frames_are_drawn() {
    let mut harness = window("paper", WIDE);
    command(&mut harness, Command::Arrange(Layout::Explore));
    harness.get_by_label("Basins").click();
    harness.run_steps(3);
    assert!(harness.state_mut().session.explore.basins.wait(LONG));
    harness.run_steps(3);
    for (mm, share) in [(4.0, "rest left"), (1.5, "interwell"), (4.0, "rest left")] {
        harness.state_mut().session.set_number("stops.travel_limit_mm", mm).unwrap();
        harness.state_mut().session.end_gesture();
        harness.run_steps(1);
        // all levels of the answer come before the next frame
        assert!(harness.state_mut().session.explore.basins.wait(LONG));
        harness.run_steps(3);
        let legend: Vec<String> = painted(&harness).into_iter().map(|text| text.0).collect();
        assert!(legend.iter().any(|text| text.contains(share) && text.contains('%')), "{mm} {legend:?}");
    }
}

#[test]
fn a_spectrum_has_lines_where_the_motion_repeats() {
    let mut harness = window("paper", WIDE);
    command(&mut harness, Command::Arrange(Layout::Explore));
    harness.get_by_label("Spectrum").click();
    wait_until("the spectrum", || {
        harness.run_steps(1);
        harness.state().session.explore.spectra.found.is_whole()
    });
    harness.run_steps(2);
    harness.get_by_label("spectrum of displacement");
    let (parts, _) = harness.state().session.explore.spectra.found.parts();
    let spectrum = parts[0].as_ref().unwrap();
    assert_eq!(spectrum.period, Some(1));
    harness.state_mut().session.explore.spectra.signal = Signal::BaseAcceleration;
    wait_until("the spectrum of the base", || {
        harness.run_steps(1);
        let (parts, current) = harness.state().session.explore.spectra.found.parts();
        current && parts.iter().flatten().any(|other| other.signal == Signal::BaseAcceleration)
    });
}

#[test]
fn under_noise_the_tab_that_has_something_is_open() {
    let mut harness = window("random-shaking", WIDE);
    press_with_ctrl(&mut harness, Key::Num5);
    let tiling = &harness.state().tiling;
    assert!(tiling.place_of(View::Spectrum).is_some() && tiling.place_of(View::UpAndDown).is_none());
    // the other one says in its middle what it needs
    harness.get_by_label("Up and down").click();
    harness.run_steps(3);
    let place = harness.state().tiling.place_of(View::UpAndDown).unwrap();
    let text = harness.get_by_label_contains("needs a drive that repeats, such as a sine").rect();
    assert!((text.center().x - place.center().x).abs() < 10.0, "{text:?} {place:?}");
    assert!((text.center().y - place.center().y).abs() < 0.2 * place.height(), "{text:?} {place:?}");
}

/// A start that was chosen is undone with the motion from it.
#[test]
fn undo_begins_again_at_the_start_before() {
    let mut session = session("paper", &["start=At(x_mm: 0.5, v_m_per_s: 0)"]);
    session.player.set_playing(true);
    (0..8).for_each(|_| _ = session.player.tick(0.1));
    session.start_at(1e-3, 0.02);
    assert_eq!((session.player.time(), session.player.state().x), (0.0, 1e-3));
    (0..8).for_each(|_| _ = session.player.tick(0.1));
    assert!(session.undo());
    assert_eq!((session.player.time(), session.player.state().x), (0.0, 0.5e-3));
    assert!(session.redo());
    assert_eq!((session.player.time(), session.player.state().x), (0.0, 1e-3));
}

/// A stop that has pushed the mass of a paused motion leaves it where it was when it is undone.
#[test]
fn undo_brings_a_pushed_mass_back() {
    let mut session = session("paper", &[]);
    while session.player.time() < 0.02 || session.player.state().x.abs() < 1.2e-3 {
        _ = session.player.tick(0.01);
    }
    session.player.set_playing(false);
    let state = |session: &Session| (session.player.state().t, session.player.state().x);
    let before = state(&session);
    session.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: 0.2, restitution: 0.36 });
    let pushed = state(&session);
    assert!(before.1.abs() > 1e-3 && pushed.1.abs() <= 0.2e-3 + 1e-12, "{before:?} {pushed:?}");
    assert!(session.undo());
    assert_eq!(state(&session), before);
    assert!(session.redo());
    assert_eq!(state(&session), pushed);
    // a motion that has gone on since goes on
    session.player.set_playing(true);
    (0..8).for_each(|_| _ = session.player.tick(0.1));
    let on = state(&session);
    assert!(session.undo());
    assert_eq!(state(&session).0, on.0);
    assert!((state(&session).1 - on.1).abs() < 1e-12);
}
