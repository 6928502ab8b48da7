//! Two cursors over time, and axes that a hand zooms, moves and holds.

use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, Rect, TouchPhase,
    accesskit::Role, pos2, vec2,
};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::Layout;

use crate::support::{PROJECTED, WIDE, command, is_painted, press, window};

const TRACES: [View; 4] = [View::Displacement, View::Velocity, View::BaseAcceleration, View::Power];

/// The preset `paper` after ten periods, standing.
fn played(size: [f32; 2]) -> Harness<'static, Window> {
    let mut harness = window("paper", size);
    let player = &mut harness.state_mut().session.player;
    player.speed = 10.0;
    (0..4).for_each(|_| _ = player.tick(0.1));
    player.set_playing(false);
    harness.run_steps(3);
    harness
}

pub fn place(harness: &Harness<'static, Window>, view: View) -> Rect {
    harness.state().tiling.place_of(view).unwrap()
}

pub fn wheel(harness: &mut Harness<'static, Window>, at: Pos2, modifiers: Modifiers, up: f32) {
    harness.hover_at(at);
    harness.run_steps(2);
    harness.event(Event::ModifiersChanged(modifiers));
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, up),
        phase: TouchPhase::Move,
        source: MouseWheelSource::Wheel,
        modifiers,
    });
    harness.run_steps(8);
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    harness.run_steps(1);
}

pub fn drag(harness: &mut Harness<'static, Window>, from: Pos2, to: Pos2, how: (PointerButton, Modifiers)) {
    let (button, modifiers) = how;
    harness.event(Event::ModifiersChanged(modifiers));
    harness.hover_at(from);
    harness.run_steps(1);
    for (pos, pressed) in [(from, true), (to, false)] {
        harness.hover_at(0.5 * (from + to.to_vec2()));
        harness.hover_at(pos);
        harness.run_steps(1);
        harness.event(Event::PointerButton { pos, button, pressed, modifiers });
        harness.run_steps(2);
    }
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    harness.run_steps(2);
}

pub fn click(harness: &mut Harness<'static, Window>, pos: Pos2, modifiers: Modifiers) {
    harness.event(Event::ModifiersChanged(modifiers));
    harness.hover_at(pos);
    harness.run_steps(1);
    for pressed in [true, false] {
        harness.event(Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers });
        harness.run_steps(1);
    }
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    harness.run_steps(2);
}

#[test]
fn cursors_are_off_at_first_and_on_in_all_views_over_time() {
    let mut harness = played(WIDE);
    assert!(!harness.state().memory.cursors.on);
    assert!(harness.query_by_label("cursor 1, displacement").is_none());
    for view in TRACES {
        command(&mut harness, Command::Show(view, true));
    }
    press(&mut harness, Key::T);
    for name in ["displacement", "velocity", "base", "power"] {
        for which in [1, 2] {
            harness.get_by_role_and_label(Role::Slider, &format!("cursor {which}, {name}"));
        }
    }
    // within what is shown, in their order
    let [a, b] = harness.state().memory.cursors.at;
    let now = harness.state().session.player.time();
    assert!(now - 2.2 < a && a < b && b < now, "{a} {b} {now}");
    press(&mut harness, Key::T);
    assert!(harness.query_by_label("cursor 1, displacement").is_none());
    // where no view over time is seen, one comes
    for view in TRACES {
        command(&mut harness, Command::Show(view, false));
    }
    press(&mut harness, Key::T);
    harness.get_by_label("cursor 2, displacement");
}

#[test]
fn a_period_is_read_off_between_them() {
    let mut harness = played(WIDE);
    press(&mut harness, Key::T);
    let watch = harness.state().session.player.watch().clone();
    // a third of a second apart, by the keyboard: the grid of the keys is 5 ms or less
    let slider = |which: u32| format!("cursor {which}, displacement");
    harness.get_by_label(&slider(1)).focus();
    harness.run_steps(2);
    let before = harness.state().memory.cursors.at;
    press(&mut harness, Key::ArrowRight);
    let step = harness.state().memory.cursors.at[0] - before[0];
    assert!(step > 0.0 && step <= 0.01, "{step}");
    let first = harness.state().memory.cursors.at[0];
    harness.key_press_modifiers(Modifiers::SHIFT, Key::ArrowLeft);
    harness.run_steps(2);
    let moved = first - harness.state().memory.cursors.at[0];
    // ten steps of the grid, which is 2 ms in a stretch of 2 s
    assert!((moved - 0.02).abs() < 1e-9, "{moved}");
    // from event to event
    let [a, _] = harness.state().memory.cursors.at;
    let next = watch.events().iter().find(|event| event.t > a).unwrap().t;
    press(&mut harness, Key::ArrowUp);
    assert_eq!(harness.state().memory.cursors.at[0], next);
    // the same event a period later: interwell motion of period 1
    let period = watch.model_at(next).forcing_period().unwrap();
    let later = watch
        .events()
        .iter()
        .min_by(|a, b| (a.t - next - period).abs().total_cmp(&(b.t - next - period).abs()))
        .unwrap()
        .t;
    assert!((later - next - period).abs() < 1e-6, "{}", later - next - period);
    harness.get_by_label(&slider(2)).focus();
    harness.run_steps(2);
    for _ in 0..500 {
        match harness.state().memory.cursors.at[1] {
            now if now == later => break,
            now => harness.key_press(if now < later { Key::ArrowUp } else { Key::ArrowDown }),
        }
        harness.run_steps(2);
    }
    assert_eq!(harness.state().memory.cursors.at, [next, later]);
    harness.run_steps(2);
    let text = "2 \u{2212} 1: 0.3333 s = 1 / 3.00 Hz = 1.00 periods";
    harness.get_by_label_contains(text);
    let phase = 360.0 * watch.model_at(next).drive_phase(next).unwrap();
    let x = watch.state_at(next).x * 1e3;
    let first = harness.query_all_by_label_contains("1: ").next().unwrap();
    let first = first.accesskit_node().value().unwrap();
    let shown = format!("{next:.4} s, {phase:.1}°, {x:.2}").replace('-', "\u{2212}");
    assert!(first.contains(&shown), "{first}");
}

#[test]
fn a_cursor_is_dragged_and_ctrl_goes_to_an_event() {
    let mut harness = played(WIDE);
    press(&mut harness, Key::T);
    let before = harness.state().memory.cursors.at;
    let grip = |harness: &Harness<'static, Window>, which: u32| {
        harness.get_by_label(&format!("cursor {which}, displacement")).rect().center()
    };
    let at = grip(&harness, 2);
    drag(&mut harness, at, at + vec2(20.0, 0.0), (PointerButton::Primary, Modifiers::NONE));
    let dragged = harness.state().memory.cursors.at;
    assert!(dragged[0] == before[0] && dragged[1] > before[1] + 0.03, "{before:?} {dragged:?}");
    let at = grip(&harness, 1);
    drag(&mut harness, at, at - vec2(40.0, 0.0), (PointerButton::Primary, Modifiers::COMMAND));
    let snapped = harness.state().memory.cursors.at[0];
    assert!(harness.state().session.player.watch().events().iter().any(|event| event.t == snapped));
    assert_ne!(snapped, dragged[0]);
    // and nothing of it moves the scene, the motion or the axes
    let window = harness.state();
    assert!(!window.session.editor.can_undo() && !window.session.player.is_past());
    assert_eq!(window.memory.chosen_axes(View::Displacement), [None; 2]);
}

#[test]
fn held_axes_stay_through_motion_and_scenes() {
    let mut harness = played(WIDE);
    command(&mut harness, Command::Arrange(Layout::Study));
    let views = [View::Displacement, View::PhasePortrait, View::ForceCurve, View::Well];
    assert!(views.iter().all(|view| harness.state().memory.chosen_axes(*view) == [None; 2]));
    for view in views {
        harness.get_by_label(&format!("hold the axes of {}", view.name())).click();
        harness.run_steps(2);
    }
    let held = views.map(|view| harness.state().memory.chosen_axes(view));
    assert!(held.iter().flatten().all(Option::is_some), "{held:?}");
    // the views that keep the wells in sight share an axis; that of the motion ends at the stops
    assert!(held[1][0] != held[2][0] && held[2][0] == held[3][0]);
    harness.state_mut().session.play_or_pause();
    harness.run_steps(60);
    harness.state_mut().open_another("first-look");
    harness.run_steps(60);
    assert_eq!(views.map(|view| harness.state().memory.chosen_axes(view)), held);
    // what is not held goes with its scene
    command(&mut harness, Command::Show(View::Velocity, true));
    let at = place(&harness, View::Velocity).center();
    wheel(&mut harness, at, Modifiers::SHIFT, 100.0);
    assert!(harness.state().memory.chosen_axes(View::Velocity)[1].is_some());
    harness.state_mut().open_another("paper");
    harness.run_steps(3);
    assert_eq!(harness.state().memory.chosen_axes(View::Velocity)[1], None);
    // and what is let go of is by itself again
    harness.hover_at(place(&harness, View::Well).center());
    harness.run_steps(2);
    press(&mut harness, Key::L);
    assert_eq!(harness.state().memory.chosen_axes(View::Well), [None; 2]);
    assert_eq!(harness.state().memory.chosen_axes(View::Displacement), held[0]);
}

#[test]
fn wheel_keys_box_and_drag_choose_both_axes() {
    let mut harness = played(WIDE);
    for view in TRACES {
        command(&mut harness, Command::Show(view, false));
    }
    command(&mut harness, Command::Show(View::ForceCurve, true));
    command(&mut harness, Command::HoldAxes);
    command(&mut harness, Command::FreeAxes);
    let ends = |harness: &Harness<'static, Window>| harness.state().memory.chosen_axes(View::ForceCurve);
    let rect = place(&harness, View::ForceCurve);
    let at = pos2(rect.left() + 0.3 * rect.width(), rect.center().y);
    let length = |limits: Option<(f64, f64)>| limits.map(|range| range.1 - range.0).unwrap();
    wheel(&mut harness, at, Modifiers::NONE, 60.0);
    let [across, up] = ends(&harness);
    assert!(across.is_some() && up.is_some());
    wheel(&mut harness, at, Modifiers::SHIFT, 60.0);
    assert!(ends(&harness)[0] == across && length(ends(&harness)[1]) < length(up));
    // keys, at the pointer's view
    let before = ends(&harness);
    for (modifiers, place) in [(Modifiers::NONE, 0), (Modifiers::SHIFT, 1)] {
        harness.key_press_modifiers(modifiers, Key::I);
        harness.run_steps(2);
        let ratio = length(ends(&harness)[place]) / length(before[place]);
        assert!((ratio - 0.8).abs() < 1e-9, "{place} {ratio}");
    }
    // what is shown goes with the hand
    let before = ends(&harness);
    let to = at + vec2(40.0, 30.0);
    drag(&mut harness, at, to, (PointerButton::Primary, Modifiers::SHIFT));
    let after = ends(&harness);
    assert!(after[0].unwrap().0 < before[0].unwrap().0 && after[1].unwrap().0 > before[1].unwrap().0);
    assert!((length(after[0]) / length(before[0]) - 1.0).abs() < 1e-9);
    // a box
    drag(&mut harness, at, at + vec2(60.0, 30.0), (PointerButton::Secondary, Modifiers::NONE));
    let boxed = ends(&harness);
    let share = length(boxed[0]) / length(after[0]);
    // of the picture without its margins and its vertical axis; it begins where the drag is known, half way
    assert!((share - 30.0 / f64::from(rect.width() - 74.0)).abs() < 0.005, "{share} {rect:?}");
    assert!(length(boxed[1]) < 0.5 * length(after[1]));
    press(&mut harness, Key::Num0);
    assert_eq!(ends(&harness), [None; 2]);
    // the scene and the motion are as they were
    assert!(!harness.state().session.editor.can_undo());
}

#[test]
fn time_that_is_held_lets_the_motion_leave() {
    let mut harness = played(WIDE);
    harness.hover_at(place(&harness, View::Displacement).center());
    harness.run_steps(2);
    press(&mut harness, Key::L);
    let [time, _] = harness.state().memory.chosen_axes(View::Displacement);
    let end = time.unwrap().1;
    let player = &mut harness.state_mut().session.player;
    (0..5).for_each(|_| {
        player.set_playing(true);
        player.tick(0.1);
    });
    player.set_playing(false);
    harness.run_steps(3);
    assert!(harness.state().session.player.time() > end);
    assert_eq!(harness.state().memory.chosen_axes(View::Velocity)[0], time);
    // cursors that are switched on stand where they are seen
    command(&mut harness, Command::Cursors);
    assert!(harness.state().memory.cursors.at.iter().all(|t| (time.unwrap().0..=end).contains(t)));
}

#[test]
fn cursors_have_room_where_it_is_short() {
    let mut harness = played(PROJECTED);
    command(&mut harness, Command::Cursors);
    command(&mut harness, Command::Show(View::Displacement, true));
    assert!(is_painted(&harness, "2 \u{2212} 1: "));
    let part = harness.get_by_label_contains("2 \u{2212} 1: ").rect();
    assert!(place(&harness, View::Displacement).contains_rect(part), "{part:?}");
}
