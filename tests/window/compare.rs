//! Pinned motions beside the present one.

use eframe::egui::{Key, Shape};
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::session::Session;
use interwell::app::session::pins::{Pin, PinKind};
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::dynamics::EventKind;
use interwell::scene::{Layout, Stops};
use interwell_studies::study::distances;

use crate::support::{
    LONG, PROJECTED, WIDE, command, painted, press, press_with_ctrl, session, wait_until, window,
};

/// Has the motion go on for some seconds, with its pins.
fn play(session: &mut Session, seconds: f64) {
    session.player.speed = 10.0;
    let until = session.player.watch().time() + seconds;
    while session.player.watch().time() < until {
        session.player.tick(0.05);
        session.follow_pins();
        assert!(session.player.ended().is_none());
    }
    // a pin has a share of each frame alone
    while session.pins.are_behind(session.player.watch().time()) {
        session.follow_pins();
    }
}

fn pinned(session: &Session, letter: char) -> &Pin {
    session.pins.get(letter).unwrap()
}

fn frames_until(harness: &mut Harness<'static, Window>, what: &str, is_so: impl Fn(&Session) -> bool) {
    wait_until(what, || {
        harness.run_steps(1);
        is_so(&harness.state().session)
    });
}

#[test]
fn a_pin_of_the_scene_lies_on_the_motion_to_the_bit() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.switch_stops(true);
    harness.state_mut().session.player.speed = 1.0;
    frames_until(&mut harness, "an impact", |session| session.player.watch().events().len() > 3);
    harness.key_press(Key::K);
    harness.run_steps(30);
    // in steps of any length
    command(&mut harness, Command::SeekEvent(true));
    command(&mut harness, Command::Step);
    command(&mut harness, Command::Speed(6));
    command(&mut harness, Command::PlayPause);
    let since = pinned(&harness.state().session, 'A').since;
    frames_until(&mut harness, "ten periods", |session| session.player.time() > since + 3.4);
    command(&mut harness, Command::PlayPause);
    frames_until(&mut harness, "the pin", |session| !session.pins.are_behind(session.player.time()));
    let session = &harness.state().session;
    let (watch, pin) = (session.player.watch(), &pinned(session, 'A').watch);
    assert_eq!(watch.now(), pin.now());
    // sums that were taken in other pieces
    let (own_j, pin_j) = (watch.ledger().work_j, pin.ledger().work_j);
    assert!(own_j > 0.01 && (own_j / pin_j - 1.0).abs() < 1e-13, "{own_j} {pin_j}");
    assert_eq!(watch.events(), pin.events());
    assert!(watch.events().iter().any(|event| event.kind == EventKind::Impact && event.t > since));
    let apart = distances(watch, pin, (0.0, watch.time()), 500);
    assert!(apart.len() > 250 && apart.iter().all(|point| point.1 == 0.0));
    // in the past it is at the same instant
    let then = 0.5 * (since + watch.time());
    harness.state_mut().session.player.seek(then);
    harness.run_steps(2);
    let session = &harness.state().session;
    assert!(session.player.is_past() && session.player.time() == then);
    assert_eq!(pinned(session, 'A').watch.state_at(then), session.player.state());
}

#[test]
fn a_pin_keeps_its_scene_and_comes_back_in_one_step() {
    let mut harness = window("first-look", WIDE);
    command(&mut harness, Command::Pin(PinKind::Motion));
    let before = harness.state().session.scene().clone();
    let session = &mut harness.state_mut().session;
    assert!(session.set_number("excitation.amplitude_g", 1.4).unwrap());
    session.end_gesture();
    session.switch_stops(true);
    let changed = session.scene().clone();
    session.player.speed = 1.0;
    harness.run_steps(60);
    let session = &harness.state().session;
    let pin = pinned(session, 'A');
    assert_eq!((&pin.scene, pin.watch.time()), (&before, session.player.watch().time()));
    assert!((pin.watch.now().x - session.player.watch().now().x).abs() > 1e-4);
    assert_eq!(pin.watch.model_at(pin.watch.time()).stop_positions(), (None, None));
    frames_until(&mut harness, "what both settle to", |session| {
        session.now_card().settled.is_some() && pinned(session, 'A').settled().is_some()
    });
    harness.run_steps(2);
    harness.get_by_label("±1.50");
    harness.get_by_label("Take A back").click();
    harness.run_steps(3);
    let session = &mut harness.state_mut().session;
    assert_eq!(*session.scene(), before);
    assert!(session.undo() && *session.scene() == changed);
}

#[test]
fn without_stops_it_is_another_motion_from_here_on() {
    let mut session = session("paper", &[]);
    play(&mut session, 1.0);
    assert_eq!(session.pin(PinKind::OtherStops), Ok('A'));
    let fork = session.player.watch().now();
    let now = pinned(&session, 'A').watch.now();
    assert_eq!((now.t, now.x, now.v), (fork.t, fork.x, fork.v));
    play(&mut session, 3.0);
    let (watch, pin) = (session.player.watch(), pinned(&session, 'A'));
    assert_eq!((pin.scene.stops, pin.since), (Stops::None, fork.t));
    assert_ne!(session.scene().stops, Stops::None);
    let reach = |samples: &std::collections::VecDeque<interwell::dynamics::Sample>| {
        samples.iter().map(|sample| sample.x.abs()).fold(0.0, f64::max)
    };
    assert!(reach(watch.samples()) <= 1.5e-3 && reach(pin.watch.samples()) > 3e-3);
    // the same drive at the same time, and the same way before
    assert_eq!((watch.time(), watch.now().base_accel), (pin.watch.time(), pin.watch.now().base_accel));
    assert!(distances(watch, &pin.watch, (0.0, fork.t), 100).iter().all(|point| point.1 == 0.0));
    // and back: with the stops that were there
    session.take_back('A');
    session.poll();
    assert_eq!(session.scene().stops, Stops::None);
    assert_eq!(session.pin(PinKind::OtherStops), Ok('B'));
    assert_eq!(pinned(&session, 'B').scene.stops.travel_limit_mm(), Some(1.5));
}

#[test]
fn there_is_room_for_three() {
    let mut harness = window("paper", WIDE);
    for _ in 0..3 {
        press(&mut harness, Key::K);
    }
    let letters = |harness: &Harness<'static, Window>| -> String {
        harness.state().session.pins.all().iter().map(|pin| pin.letter).collect()
    };
    assert_eq!(letters(&harness), "ABC");
    press(&mut harness, Key::K);
    assert_eq!(letters(&harness), "ABC");
    let told = harness.state().notice().unwrap_or_default();
    assert!(told.contains("unpin one first, in the view Compare or by Motion, Unpin"), "{told}");
    harness.get_by_label("Unpin A").click();
    harness.run_steps(2);
    assert_eq!(letters(&harness), "BC");
    harness.get_by_label("Pin").click();
    harness.run_steps(2);
    assert_eq!(letters(&harness), "BCA");
    // another scene has none
    harness.state_mut().open_another("duffing");
    assert_eq!(letters(&harness), "");
}

#[test]
fn pins_begin_again_with_the_motion() {
    let mut session = session("paper", &[]);
    play(&mut session, 1.0);
    session.pin(PinKind::OtherStops).unwrap();
    play(&mut session, 1.0);
    session.restart();
    let pin = pinned(&session, 'A');
    assert_eq!((pin.watch.time(), pin.since), (0.0, 0.0));
    assert!(pin.settled().is_none());
    play(&mut session, 0.5);
    assert_eq!(pinned(&session, 'A').watch.time(), session.player.watch().time());
}

/// Distance in m of a twin from the mass after some seconds, and at the start.
fn twins(changes: &[&str], seconds: f64) -> (f64, f64) {
    let mut session = session("first-look", changes);
    play(&mut session, 0.5);
    assert_eq!(session.pin(PinKind::Twin), Ok('A'));
    assert_eq!(session.player.watch().time(), 0.0);
    let first = session.player.watch().now().x - pinned(&session, 'A').watch.now().x;
    play(&mut session, seconds);
    let last = session.player.watch().now().x - pinned(&session, 'A').watch.now().x;
    (first.abs(), last.abs())
}

#[test]
fn chaos_drives_twins_apart_and_stops_bring_them_together() {
    let (first, last) = twins(&["excitation.amplitude_g=1.5"], 40.0);
    assert!((first - 1e-6).abs() < 1e-15, "{first:e}");
    assert!(last > 1e-4, "{last:e}");
    let stops = "stops=Rigid(travel_limit_mm: 1.5, restitution: 0.36)";
    let (first, last) = twins(&["excitation.amplitude_g=1.5", stops], 40.0);
    assert!((first - 1e-6).abs() < 1e-15, "{first:e}");
    assert!(last < 1e-12, "{last:e}");
}

#[test]
fn a_pin_that_ends_early_stays_there() {
    let mut session = session("paper-table", &["excitation.amplitude_g=5"]);
    session.pin(PinKind::OtherStops).unwrap();
    play(&mut session, 2.0);
    let pin = pinned(&session, 'A');
    let at = pin.watch.ended().and_then(|outcome| outcome.ended_at()).unwrap();
    assert!(at < 2.0 && pin.watch.time() == at);
    assert_eq!(pin.watch.state_at(session.player.time()), pin.watch.now());
}

#[test]
fn every_view_draws_pins() {
    for size in [WIDE, PROJECTED] {
        let mut harness = window("first-look", size);
        command(&mut harness, Command::Arrange(Layout::Study));
        harness.state_mut().session.player.speed = 1.0;
        for kind in [PinKind::Twin, PinKind::OtherStops, PinKind::Motion] {
            command(&mut harness, Command::Pin(kind));
            harness.run_steps(20);
        }
        for view in View::ALL {
            command(&mut harness, Command::Show(view, true));
            harness.run_steps(2);
        }
        for view in [View::Distance, View::Compare] {
            command(&mut harness, Command::Fill);
            command(&mut harness, Command::Show(view, true));
            harness.run_steps(2);
        }
        assert_eq!(harness.state().session.pins.all().len(), 3);
        harness.state_mut().session.wait_settled(LONG);
        command(&mut harness, Command::SeekEvent(false));
    }
}

#[test]
fn the_distance_is_shown_beside_the_card() {
    let mut harness = window("first-look", WIDE);
    command(&mut harness, Command::Pin(PinKind::Twin));
    harness.get_by_label("distance of the pinned motions");
    harness.get_by_label("Before / now").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("distance of the pinned motions").is_none());
    assert!(harness.state().tiling.shows(View::BeforeNow));
}

#[test]
fn the_table_of_three_pins_needs_no_scrolling_sideways() {
    for size in [WIDE, PROJECTED] {
        let mut harness = window("paper", size);
        command(&mut harness, Command::Arrange(Layout::Look));
        for kind in [PinKind::Motion, PinKind::OtherStops, PinKind::Twin] {
            command(&mut harness, Command::Pin(kind));
        }
        let session = &mut harness.state_mut().session;
        assert!(session.set_number("excitation.amplitude_g", 1.4).unwrap());
        session.end_gesture();
        wait_until("what all settle to", || {
            harness.run_steps(1);
            let session = &harness.state().session;
            session.now_card().settled.is_some()
                && session.pins.all().iter().all(|pin| pin.settled().is_some())
        });
        command(&mut harness, Command::Show(View::Compare, true));
        harness.get_by_label("Compare").click();
        harness.run_steps(3);
        let place = harness.state().tiling.place_of(View::Compare).unwrap();
        for name in ["Take A back", "Unpin A", "Unpin B", "Unpin C"] {
            let rect = harness.get_by_label(name).rect();
            assert!(
                rect.left() >= place.left() && rect.right() <= place.right(),
                "{name} {rect:?} {place:?}"
            );
        }
        // no text is cut at a side
        for (text, rect, clip) in painted(&harness) {
            let seen = rect.intersects(clip) && place.contains(rect.center());
            let whole = rect.left() >= clip.left() - 0.5 && rect.right() <= clip.right() + 0.5;
            assert!(!seen || whole, "{text} {rect:?} in {clip:?}");
        }
    }
}

#[test]
fn two_motions_stand_side_by_side_and_a_hand_moves_the_present_one_alone() {
    let mut harness = window("first-look", WIDE);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, view == View::SideBySide));
    }
    harness.get_by_label("Beside it with stops").click();
    harness.run_steps(3);
    command(&mut harness, Command::Show(View::Compare, false));
    harness.get_by_label("0.90 g, 3.0 Hz, no stops");
    harness.get_by_label("0.90 g, 3.0 Hz, ±1.50 mm");
    harness.state_mut().session.player.speed = 1.0;
    harness.run_steps(60);
    let session = &harness.state().session;
    let (state, pin) = (session.player.state(), pinned(session, 'A').watch.state_at(session.player.time()));
    assert!(state.t == pin.t && state.base_accel == pin.base_accel && (state.x - pin.x).abs() > 1e-3);
    // two drawings and two wells, and one motion that can be taken hold of in each of them
    assert_eq!(harness.query_all_by_label("proof mass").count(), 2);
    press(&mut harness, Key::Space);
    let place = harness.state().tiling.place_of(View::SideBySide).unwrap();
    let masses: Vec<f32> =
        harness.query_all_by_label("proof mass").map(|node| node.rect().center().x).collect();
    assert!(masses.iter().all(|x| *x < place.center().x), "{masses:?}");
    // the stops of the pinned one are no sliders
    assert_eq!(harness.query_all_by_label("right stop").count(), 0);
    command(&mut harness, Command::Pin(PinKind::Motion));
    command(&mut harness, Command::Show(View::Compare, false));
    harness.get_by_label("B").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("0.90 g, 3.0 Hz, ±1.50 mm").is_none());
    assert!(!harness.state().session.editor.can_undo());
}

#[test]
fn pins_stay_through_ctrl_1_and_leave_by_the_menu() {
    let mut harness = window("paper", WIDE);
    press(&mut harness, Key::K);
    assert!(harness.state().tiling.place_of(View::Compare).is_some());
    press_with_ctrl(&mut harness, Key::Num1);
    assert_eq!(harness.state().session.pins.all().len(), 1);
    assert!(harness.state().tiling.place_of(View::Compare).is_some());
    harness.get_by_label("Motion").click();
    harness.run_steps(3);
    // that of the menu, beside the button in the table
    assert_eq!(harness.query_all_by_label_contains("Unpin").count(), 2);
    press(&mut harness, Key::Escape);
    command(&mut harness, Command::Unpin('B'));
    assert_eq!(harness.state().session.pins.all().len(), 1);
    command(&mut harness, Command::Unpin('A'));
    assert!(harness.state().session.pins.all().is_empty());
    press_with_ctrl(&mut harness, Key::Num1);
    assert!(harness.state().tiling.place_of(View::Compare).is_none());
}

#[test]
fn a_pin_has_its_letter_at_its_end_and_lies_under_the_motion() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.player.speed = 1.0;
    press(&mut harness, Key::K);
    harness.state_mut().session.switch_stops(true);
    harness.run_steps(60);
    let place = harness.state().tiling.place_of(View::Displacement).unwrap();
    let at_end = |text: &&(String, eframe::egui::Rect, eframe::egui::Rect)| {
        text.0 == "A" && place.contains(text.1.center()) && text.1.top() > place.top() + 50.0
    };
    let all = painted(&harness);
    let ends: Vec<_> = all.iter().filter(at_end).collect();
    assert_eq!(ends.len(), 1, "{ends:?}");
    // in the drawing the box of the mass is painted after the outline and letter of the pinned one
    let place = harness.state().tiling.place_of(View::Mechanism).unwrap();
    let shapes = &harness.output().shapes;
    let is_letter = |shape: &Shape| {
        matches!(shape, Shape::Text(text)
            if text.galley.text() == "A" && place.contains(text.visual_bounding_rect().center()))
    };
    let is_box = |shape: &Shape| match shape {
        Shape::Rect(rect) => place.contains_rect(rect.rect) && rect.stroke.width == 1.5,
        _ => false,
    };
    let letter = shapes.iter().position(|clipped| is_letter(&clipped.shape)).unwrap();
    let mass = shapes.iter().rposition(|clipped| is_box(&clipped.shape)).unwrap();
    assert!(letter < mass, "{letter} {mass}");
}

#[test]
fn the_well_has_room_for_a_pinned_motion_that_is_pushed_harder() {
    let mut harness = window("paper", WIDE);
    let ticks = |harness: &Harness<'static, Window>| {
        let place = harness.state().tiling.place_of(View::Well).unwrap();
        let texts = painted(harness).into_iter().filter(|text| place.contains(text.1.center()));
        let mut ticks: Vec<String> = texts
            .map(|text| text.0.replace('\u{2212}', "-"))
            .filter(|text| text.parse::<f64>().is_ok())
            .collect();
        ticks.sort();
        ticks
    };
    press(&mut harness, Key::K);
    harness.run_steps(20);
    let before = ticks(&harness);
    let session = &mut harness.state_mut().session;
    session.set_number("excitation.amplitude_g", 0.3).unwrap();
    session.end_gesture();
    harness.run_steps(40);
    assert_eq!(ticks(&harness), before);
}
