//! The reference beside the present motion.

use eframe::egui::Key;
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::session::Session;
use interwell::app::session::reference::Apart;
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::dynamics::EventKind;
use interwell::scene::Layout;

use crate::support::{LONG, PROJECTED, WIDE, click_on, command, painted, press, session, wait_until, window};

/// Has the motion go on for some seconds, with the reference.
fn play(session: &mut Session, seconds: f64) {
    session.player.speed = 10.0;
    let until = session.player.watch().time() + seconds;
    while session.player.watch().time() < until {
        session.player.tick(0.05);
        session.follow_reference();
        assert!(session.player.ended().is_none());
    }
    // the reference has a share of each frame alone
    while session.reference.is_behind(session.player.watch().time()) {
        session.follow_reference();
    }
}

fn apart(session: &Session) -> &Apart {
    session.reference.apart().unwrap()
}

fn frames_until(harness: &mut Harness<'static, Window>, what: &str, is_so: impl Fn(&Session) -> bool) {
    wait_until(what, || {
        harness.run_steps(1);
        is_so(&harness.state().session)
    });
}

#[test]
fn a_reference_of_the_same_motion_lies_on_it_to_the_bit() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.switch_stops(true);
    harness.state_mut().session.player.speed = 1.0;
    frames_until(&mut harness, "an impact", |session| session.player.watch().events().len() > 3);
    harness.key_press(Key::K);
    harness.run_steps(30);
    assert!(harness.state().session.reference.apart().is_none());
    // another scene with the same motion
    harness.state_mut().session.edit_once(|scene| scene.run.duration_s += 1.0);
    harness.run_steps(30);
    // in steps of any length
    command(&mut harness, Command::SeekEvent(true));
    command(&mut harness, Command::Step);
    command(&mut harness, Command::Speed(6));
    command(&mut harness, Command::PlayPause);
    let since = apart(&harness.state().session).since;
    frames_until(&mut harness, "ten periods", |session| session.player.time() > since + 3.4);
    command(&mut harness, Command::PlayPause);
    frames_until(&mut harness, "the reference", |session| {
        !session.reference.is_behind(session.player.time())
    });
    let session = &harness.state().session;
    let (watch, other) = (session.player.watch(), &apart(session).watch);
    assert_eq!(watch.now(), other.now());
    // sums that were taken in other pieces
    let (own_j, other_j) = (watch.ledger().work_j, other.ledger().work_j);
    assert!(own_j > 0.01 && (own_j / other_j - 1.0).abs() < 1e-13, "{own_j} {other_j}");
    assert_eq!(watch.events(), other.events());
    assert!(watch.events().iter().any(|event| event.kind == EventKind::Impact && event.t > since));
    let times = || (0..1000).map(|i| 1e-3 * f64::from(i) * watch.time());
    assert!(times().all(|t| (watch.state_at(t).x - other.state_at(t).x).abs() < 1e-12));
    // in the past it is at the same instant
    let then = 0.5 * (since + watch.time());
    harness.state_mut().session.player.seek(then);
    harness.run_steps(2);
    let session = &harness.state().session;
    assert!(session.player.is_past() && session.player.time() == then);
    assert_eq!(apart(session).watch.state_at(then), session.player.state());
}

#[test]
fn a_reference_keeps_its_scene_and_comes_back_in_one_step() {
    let mut harness = window("first-look", WIDE);
    let before = harness.state().session.scene().clone();
    let session = &mut harness.state_mut().session;
    assert!(session.set_number("excitation.amplitude_g", 1.4).unwrap());
    session.end_gesture();
    session.switch_stops(true);
    let changed = session.scene().clone();
    session.player.speed = 1.0;
    harness.run_steps(60);
    let session = &harness.state().session;
    let watch = &apart(session).watch;
    assert_eq!((&*session.reference.scene, watch.time()), (&before, session.player.watch().time()));
    assert!((watch.now().x - session.player.watch().now().x).abs() > 1e-4);
    assert_eq!(watch.model_at(watch.time()).stop_positions(), (None, None));
    frames_until(&mut harness, "what both settle to", |session| {
        session.now_card().settled.is_some() && session.reference_card().unwrap().settled.is_some()
    });
    harness.run_steps(2);
    click_on(&mut harness, "Compare");
    harness.get_by_label("start");
    harness.get_by_label("±1.50");
    harness.get_by_label("Back").click();
    harness.run_steps(3);
    let session = &mut harness.state_mut().session;
    assert_eq!(*session.scene(), before);
    assert!(session.undo() && *session.scene() == changed);
    // a pinned one takes the place of the start
    press(&mut harness, Key::K);
    let session = &mut harness.state_mut().session;
    assert!(*session.reference.scene == changed && session.reference.apart().is_none());
    session.edit_once(|scene| scene.mass_g = 16.0);
    harness.run_steps(3);
    harness.get_by_label("pinned");
    // another scene begins with its own start
    harness.state_mut().open_another("duffing");
    let session = &harness.state().session;
    assert!(*session.reference.scene == *session.scene() && !session.reference.is_pinned);
}

#[test]
fn only_another_motion_is_followed() {
    let mut session = session("paper", &[]);
    play(&mut session, 1.0);
    assert!(session.reference.apart().is_none() && session.reference_card().is_none());
    // a mass moved by hand
    session.hold(0.0);
    session.player.let_go();
    session.moved_by_hand();
    session.follow_reference();
    let reference = apart(&session).watch.now();
    assert!((reference.x - session.player.watch().now().x).abs() > 1e-4);
    // which comes back to the same motion
    play(&mut session, 20.0);
    assert!(session.reference.apart().is_none());
    // and a scene that is changed and taken back
    session.edit_once(|scene| scene.mass_g = 18.0);
    play(&mut session, 1.0);
    assert!(session.reference.apart().is_some());
    assert!(session.take_back() && !session.take_back());
    play(&mut session, 20.0);
    assert!(session.reference.apart().is_none());
}

#[test]
fn a_reference_begins_again_with_the_motion() {
    let mut session = session("paper", &[]);
    play(&mut session, 1.0);
    session.pin().unwrap();
    session.switch_stops(false);
    play(&mut session, 1.0);
    session.restart();
    assert_eq!((apart(&session).watch.time(), apart(&session).since), (0.0, 0.0));
    assert!(session.reference_card().unwrap().settled.is_none());
    play(&mut session, 0.5);
    assert_eq!(apart(&session).watch.time(), session.player.watch().time());
    session.undo();
    session.restart();
    assert!(session.reference.apart().is_none());
}

#[test]
fn a_reference_that_ends_early_stays_there() {
    let mut session = session("paper-table", &["excitation.amplitude_g=5"]);
    session.switch_stops(false);
    session.pin().unwrap();
    session.switch_stops(true);
    play(&mut session, 2.0);
    let at = session.reference_card().unwrap().ended.unwrap();
    let watch = &apart(&session).watch;
    assert!(at < 2.0 && watch.time() == at);
    assert_eq!(watch.state_at(session.player.time()), watch.now());
}

#[test]
fn every_view_draws_the_reference() {
    for size in [WIDE, PROJECTED] {
        let mut harness = window("first-look", size);
        command(&mut harness, Command::Arrange(Layout::Study));
        harness.state_mut().session.player.speed = 1.0;
        harness.state_mut().session.switch_stops(true);
        harness.run_steps(20);
        for view in View::ALL {
            command(&mut harness, Command::Show(view, true));
            harness.run_steps(2);
        }
        assert!(harness.state().session.reference.apart().is_some());
        harness.state_mut().session.wait_settled(LONG);
        command(&mut harness, Command::SeekEvent(false));
    }
}

#[test]
fn the_table_needs_no_scrolling_sideways() {
    for size in [WIDE, PROJECTED] {
        let mut harness = window("paper", size);
        command(&mut harness, Command::Arrange(Layout::Look));
        let session = &mut harness.state_mut().session;
        assert!(session.set_number("excitation.amplitude_g", 1.4).unwrap());
        session.end_gesture();
        wait_until("what both settle to", || {
            harness.run_steps(1);
            let session = &harness.state().session;
            session.now_card().settled.is_some() && session.reference_card().unwrap().settled.is_some()
        });
        command(&mut harness, Command::Show(View::Compare, true));
        harness.get_by_label("Compare").click();
        harness.run_steps(3);
        let place = harness.state().tiling.place_of(View::Compare).unwrap();
        for name in ["Pin", "Back"] {
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
fn the_well_has_room_for_a_reference_that_is_pushed_harder() {
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
    harness.run_steps(20);
    let before = ticks(&harness);
    let session = &mut harness.state_mut().session;
    session.set_number("excitation.amplitude_g", 0.3).unwrap();
    session.end_gesture();
    harness.run_steps(40);
    assert_eq!(ticks(&harness), before);
}
