//! The layout Explore: the scene turned up and down, asked for while it is looked at.

use eframe::egui::{Key, Modifiers, accesskit::Role};
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::session::explore::WalkQuantity;
use interwell::app::ui::settings::Settings;
use interwell::app::window::{Command, Window};
use interwell::scene::Layout;
use interwell::study::Direction;

use crate::shared::axis;
use crate::support::{PROJECTED, WIDE, command, wait_until, window};

const AMPLITUDE: &str = "excitation.amplitude_g";

fn open(size: [f32; 2]) -> Harness<'static, Window> {
    let mut harness = window("first-look", size, Settings::default());
    harness.state_mut().session.explore.walks.chosen = Some(axis(AMPLITUDE, (0.8, 1.3, 0.1)));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Num5);
    harness.run_steps(3);
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
    let own = parts.iter().filter(|own| own.0 == 1 && own.1.direction == direction);
    own.map(|own| own.1.value).collect()
}

#[test]
fn both_directions_come_and_a_drag_takes_the_scene_there() {
    let mut harness = open(WIDE);
    fill(&mut harness);
    let up = fine(harness.state(), Direction::Up);
    assert_eq!(up, [0.8, 0.9, 1.0, 1.1, 1.2, 1.3]);
    let down = fine(harness.state(), Direction::Down);
    assert!(down.iter().rev().eq(up.iter()));
    let before = harness.state().session.scene().clone();
    let name = "displacement once a period (mm) over amplitude, turned up and down";
    let place = harness.get_by_role_and_label(Role::Canvas, name).rect();
    harness.drag_at(place.center());
    harness.run_steps(2);
    harness.drop_at(place.center());
    harness.run_steps(2);
    let session = &mut harness.state_mut().session;
    assert!(session.amplitude_g().is_some_and(|own| own == 1.0 || own == 1.1), "{:?}", session.amplitude_g());
    // the field that is walked has no part in the question: what is known stays
    assert!(session.explore.walks.found.is_whole());
    assert!(session.undo() && *session.scene() == before && !session.undo());
    session.explore.walks.quantity = WalkQuantity::RmsVelocity;
    harness.run_steps(3);
    harness.get_by_label("RMS velocity (mm/s) over amplitude, turned up and down");
}

#[test]
fn another_scene_is_walked_anew_and_a_closed_view_asks_for_nothing() {
    let mut harness = open(WIDE);
    fill(&mut harness);
    harness.state_mut().session.edit_once(|scene| scene.mass_g *= 1.1);
    harness.run_steps(2);
    let walks = &harness.state().session.explore.walks;
    assert!(walks.found.is_running() && !walks.found.is_whole());
    command(&mut harness, Command::Arrange(Layout::Look));
    assert!(!harness.state().session.explore.walks.found.is_running());
    command(&mut harness, Command::Arrange(Layout::Explore));
    fill(&mut harness);
    assert_eq!(fine(harness.state(), Direction::Up).len(), 6);
}

#[test]
fn a_scene_that_cannot_be_walked_says_why() {
    let mut harness = window("random-shaking", PROJECTED, Settings::default());
    command(&mut harness, Command::Arrange(Layout::Explore));
    harness.get_by_label_contains("that needs shaking that repeats");
}
