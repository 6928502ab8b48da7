//! Cost of a window in which nothing happens, or of which a part is looked at: in frames, ledgers and
//! unfinished work.

use std::time::Duration;

use eframe::egui::{Event, Modifiers, PointerButton, Pos2, accesskit::Role, pos2};
use interwell::app::views::View;
use interwell::app::window::Command;
use interwell::dynamics::{Model, STANDARD_GRAVITY};
use interwell::scene::{Layout, PRESETS, SweepAxis};
use interwell_studies::study::Watch;

use crate::screen::Screen;
use crate::shared::axis;
use crate::support::{LONG, PROJECTED, WIDE, wait_for_threads};

/// Frames in which what moves by itself comes to its end: tooltips, rings, axes that glide.
const GLIDING: usize = 60;

/// A map for which the shaking is no axis.
fn axes(step: f64) -> [SweepAxis; 2] {
    [axis("stops.travel_limit_mm", (1.0, 3.0, step)), axis("excitation.frequency_hz", (2.0, 4.0, step))]
}

/// Waits for what runs in the background, and for what glides; then no frame is asked for.
fn comes_to_rest(screen: &mut Screen, what: &str) {
    screen.steps(2);
    screen.window.session.wait(LONG);
    if screen.window.session.map.is_running() {
        assert!(screen.window.session.wait_for_map(LONG), "{what}");
    }
    let busy = (0..GLIDING).take_while(|_| {
        screen.step(Vec::new());
        screen.stands < Duration::MAX
    });
    let frames = busy.count();
    assert!(frames < GLIDING, "{what}: still asks for frames");
    // an answer is there before its thread has called
    wait_for_threads(&screen.window);
    let (time, woken) = (screen.window.session.player.time(), screen.woken());
    for _ in 0..5 {
        screen.step(Vec::new());
        assert_eq!(screen.stands, Duration::MAX, "{what}");
    }
    assert_eq!((screen.window.session.player.time(), screen.woken()), (time, woken), "{what}");
}

fn pause(screen: &mut Screen) {
    screen.steps(5);
    assert!(screen.window.session.player.is_playing() && screen.stands == Duration::ZERO);
    screen.ask(Command::PlayPause);
}

#[test]
fn paused_no_layout_asks_for_a_frame() {
    for size in [WIDE, PROJECTED] {
        for layout in [Some(Layout::Look), Some(Layout::Study), Some(Layout::Map), None] {
            let mut screen = Screen::new("paper", size);
            screen.window.session.map.choose(Some(axes(0.5)));
            screen.ask(layout.map_or(Command::ArrangeOwn, Command::Arrange));
            pause(&mut screen);
            // what is told of a new arrangement goes by itself
            while screen.window.notice().is_some() {
                screen.steps(30);
            }
            let what = format!("{layout:?} at {size:?}");
            comes_to_rest(&mut screen, &what);
            // the hand rests somewhere, and something is read there
            for at in [pos2(0.25, 0.4), pos2(0.5, 0.5), pos2(0.8, 0.3), pos2(0.8, 0.8)] {
                let at = at.to_vec2() * screen.size;
                screen.step(vec![Event::PointerMoved(at.to_pos2())]);
                comes_to_rest(&mut screen, &format!("{what}, the hand at {at:?}"));
            }
        }
    }
}

#[test]
fn paused_no_scene_asks_for_a_frame() {
    for preset in PRESETS {
        let mut screen = Screen::new(preset.name, WIDE);
        screen.window.session.player.speed = 1.0;
        for view in View::ALL {
            screen.ask(Command::Show(view, view != View::Map));
        }
        pause(&mut screen);
        comes_to_rest(&mut screen, preset.name);
    }
}

#[test]
fn a_closed_energy_view_takes_no_ledger() {
    let mut screen = Screen::new("first-look", WIDE);
    screen.window.session.player.speed = 1.0;
    let ledgers = |screen: &Screen| screen.window.session.player.watch().ledger_count();
    screen.steps(100);
    assert!(screen.window.session.player.time() > 4.0 / 3.0);
    assert_eq!(ledgers(&screen), 1);
    // open, it has one for every period, and the last whole one after two
    screen.ask(Command::Show(View::Energy, true));
    screen.steps(90);
    let (watch, now) = (screen.window.session.player.watch(), screen.window.session.player.time());
    let period = watch.last_period(now).unwrap();
    assert!(period.work_j > 0.0 && period.energy_residual() < 1e-6, "{period:?}");
    assert!((4..=6).contains(&ledgers(&screen)), "{}", ledgers(&screen));
    // nothing is said of a past in which none was taken
    assert!(watch.ledger_at(1.0).is_none() && watch.last_period(1.0).is_none());
    assert!(watch.ledger_at(now - 0.5).is_some_and(|(t, _)| t > now - 1.0));
    let kept = ledgers(&screen);
    screen.ask(Command::Show(View::Energy, false));
    screen.steps(100);
    assert_eq!(ledgers(&screen), kept);
    let now = screen.window.session.player.time();
    assert!(screen.window.session.player.watch().last_period(now).is_none());
    // nor behind a view that fills the window
    screen.ask(Command::Show(View::Energy, true));
    screen.ask(Command::Fill);
    screen.steps(100);
    assert_eq!(ledgers(&screen), kept);
}

#[test]
fn ledgers_change_no_bit_of_the_path() {
    for (preset, ledgers) in [("paper", 91), ("duffing", 6), ("uneven-stops", 91)] {
        let screen = Screen::new(preset, WIDE);
        let model: &Model = screen.window.session.model();
        let [plain, kept] = [false, true].map(|keep| {
            let mut watch = Watch::new(model);
            watch.keep_ledgers(keep);
            while watch.time() < 30.0 {
                watch.advance(watch.time() + 0.0419);
            }
            watch
        });
        assert_eq!(plain.samples(), kept.samples(), "{preset}");
        assert_eq!(plain.events(), kept.events(), "{preset}");
        assert_eq!(plain.ledger(), kept.ledger(), "{preset}");
        assert_eq!((plain.ledger_count(), kept.ledger_count()), (1, ledgers), "{preset}");
    }
}

/// Runs that never end are all around a hand that drags: the sentence, the thresholds and the map wait, the
/// hand does not.
#[test]
fn a_drag_waits_for_nothing() {
    let mut screen = Screen::new("paper", WIDE);
    screen.ctx.enable_accesskit();
    screen.window.session.player.speed = 1.0;
    // integrated to their end: what comes back is known at once
    screen.window.session.edit_once(|scene| (scene.run.duration_s, scene.run.recurrence) = (1e6, false));
    screen.window.session.map.choose(Some(axes(0.01)));
    screen.ask(Command::Arrange(Layout::Map));
    screen.steps(5);
    let session = &screen.window.session;
    assert!(session.fault().is_none() && session.map.is_running());
    let slider = |screen: &Screen| {
        // the uppermost of those that have their name beside them
        let knobs = screen.nodes.iter().filter(|node| node.role() == Role::Slider && node.label().is_none());
        let bounds = knobs.filter_map(|node| node.bounds()).min_by(|a, b| a.y0.total_cmp(&b.y0)).unwrap();
        (bounds.x0 as f32, bounds.x1 as f32, (0.5 * (bounds.y0 + bounds.y1)) as f32)
    };
    // the scene has 1 g, half of the slider: above it no map of what is asked for is there
    let (left, right, y) = slider(&screen);
    let at = |share: f32| pos2(left + share * (right - left), y);
    let press = |pos: Pos2, pressed: bool| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    screen.step(vec![Event::PointerMoved(at(0.55))]);
    screen.step(vec![press(at(0.55), true)]);
    for frame in 1..=40 {
        let before = screen.window.session.amplitude_g();
        screen.step(vec![Event::PointerMoved(at(0.55 + 0.01 * frame as f32))]);
        let session = &screen.window.session;
        let (asked, now) = (session.amplitude_g().unwrap(), session.player.time());
        assert!(before.is_some_and(|before| before < asked), "frame {frame}");
        screen.step(Vec::new());
        // the next frame plays what was asked for, from where the mass was
        let session = &screen.window.session;
        assert_eq!(session.changed_at, now, "frame {frame}");
        assert!(session.player.time() > now && session.player.is_playing());
        let state = session.player.state();
        let push = asked * STANDARD_GRAVITY * (std::f64::consts::TAU * 3.0 * state.t).sin();
        assert!((state.base_accel - push).abs() < 1e-9, "frame {frame}: {state:?} {push}");
        assert!(session.editor.in_gesture(), "frame {frame}");
        // what it would make is thrown away by the next move
        assert!(!session.map.is_running(), "frame {frame}");
    }
    screen.step(vec![press(at(0.95), false)]);
    screen.steps(3);
    let session = &screen.window.session;
    assert!(!session.editor.in_gesture() && session.map.is_running());
    // none of it has come, and none of it was waited for
    assert!(session.now_card().settled.is_none());
    assert!(session.map.map().is_some_and(|map| !map.is_covered()));
}
