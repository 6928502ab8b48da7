//! The gestures of the pictures, which mean the same in every view.

use eframe::egui::{Event, Key, Modifiers, OutputCommand, PointerButton, Pos2, Vec2, vec2};
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::Layout;

use crate::cursors::{click, drag, place, wheel};
use crate::support::{LONG, WIDE, command, painted, wait_until, window};

/// The views whose picture is a plot of egui_plot, each over the whole window.
fn shown(view: View) -> Harness<'static, Window> {
    let mut harness = window("paper", WIDE);
    command(&mut harness, Command::Arrange(Layout::Explore));
    for other in View::ALL {
        command(&mut harness, Command::Show(other, other == view));
    }
    wait_until("the answers", || {
        harness.run_steps(1);
        harness.state_mut().session.wait(LONG);
        let explore = &harness.state().session.explore;
        match view {
            View::Spectrum => explore.spectra.found.is_whole(),
            View::UpAndDown => explore.walks.found.is_whole(),
            View::Basins => explore.basins.is_whole(),
            View::Map => harness.state_mut().session.wait_for_map(LONG),
            _ => true,
        }
    });
    let player = &mut harness.state_mut().session.player;
    player.set_playing(true);
    player.speed = 10.0;
    (0..4).for_each(|_| _ = player.tick(0.1));
    player.set_playing(false);
    harness.run_steps(3);
    harness
}

const OVER_TIME: [View; 4] = [View::Displacement, View::Velocity, View::BaseAcceleration, View::Power];

const PLOTS: [View; 13] = [
    View::Well,
    View::PhasePortrait,
    View::Section,
    View::ForceCurve,
    View::Spectrum,
    View::Accuracy,
    View::UpAndDown,
    View::Basins,
    View::Map,
    View::Displacement,
    View::Velocity,
    View::BaseAcceleration,
    View::Power,
];

#[test]
fn every_picture_has_the_same_gestures() {
    for view in PLOTS {
        let mut harness = shown(view);
        harness.ctx.options_mut(|options| options.input_options.max_double_click_delay = 5.0);
        let ends = |harness: &Harness<'static, Window>| harness.state().memory.chosen_axes(view);
        let follows = |harness: &Harness<'static, Window>| harness.state().memory.timeline.window.is_some();
        let length = |ends: Option<(f64, f64)>| ends.map(|ends| ends.1 - ends.0);
        // in the picture of fixed steps, which is to the right
        let at = place(&harness, view).lerp_inside(vec2(0.8, 0.5));
        let state = |harness: &Harness<'static, Window>| harness.state().session.player.state();
        let before = state(&harness);
        let twice = |harness: &mut Harness<'static, Window>| {
            for _ in 0..2 {
                harness.drag_at(at);
                harness.run_steps(1);
                harness.drop_at(at);
                harness.run_steps(1);
            }
            harness.run_steps(2);
        };
        assert_eq!(ends(&harness), [None; 2], "{view:?}");
        // the wheel zooms both axes, in a view over time the time, with Shift the vertical one
        wheel(&mut harness, at, Modifiers::NONE, 60.0);
        let over_time = OVER_TIME.contains(&view);
        assert_eq!(follows(&harness), over_time, "{view:?}");
        assert!(ends(&harness).iter().all(|ends| ends.is_none() == over_time), "{view:?}");
        wheel(&mut harness, at, Modifiers::SHIFT, 60.0);
        // time follows the present until it is panned
        drag(&mut harness, at, at - vec2(20.0, 0.0), (PointerButton::Primary, Modifiers::NONE));
        let zoomed = ends(&harness);
        assert!(zoomed[0].is_some() && zoomed[1].is_some(), "{view:?}");
        harness.get_by_label(&format!("axes of {} as they were", view.name()));
        // a drag pans
        let by: Vec2 = vec2(40.0, 30.0);
        drag(&mut harness, at, at + by, (PointerButton::Primary, Modifiers::NONE));
        let panned = ends(&harness);
        assert!(panned[0].unwrap().0 < zoomed[0].unwrap().0, "{view:?} {zoomed:?} {panned:?}");
        assert!(panned[1].unwrap().0 > zoomed[1].unwrap().0, "{view:?} {zoomed:?} {panned:?}");
        for (panned, zoomed) in panned.into_iter().zip(zoomed) {
            let ratio = length(panned).unwrap() / length(zoomed).unwrap();
            assert!((ratio - 1.0).abs() < 1e-6, "{view:?} {ratio}");
        }
        // a drag with the right button is a box
        drag(&mut harness, at, at + by, (PointerButton::Secondary, Modifiers::NONE));
        for (boxed, panned) in ends(&harness).into_iter().zip(panned) {
            assert!(length(boxed) < length(panned), "{view:?}");
        }
        // a double click: axes as they were, and nothing else
        twice(&mut harness);
        assert!(ends(&harness) == [None; 2] && !follows(&harness), "{view:?}");
        // so does the tool, which is there while they are changed
        let tool = format!("axes of {} as they were", view.name());
        assert!(harness.query_by_label(&tool).is_none(), "{view:?}");
        drag(&mut harness, at, at + by, (PointerButton::Secondary, Modifiers::NONE));
        harness.get_by_label(&tool).click();
        harness.run_steps(3);
        assert_eq!(ends(&harness), [None; 2], "{view:?}");
        // the menu copies what is drawn, and saves a figure of it
        let copied = from_menu(&mut harness, at, "Copy values").unwrap();
        assert!(copied.starts_with("curve,") && copied.lines().count() > 3, "{view:?}: {copied}");
        let columns = |line: &str| line.split(',').count();
        let count = copied.lines().next().map(columns);
        assert!(copied.lines().all(|line| Some(columns(line)) == count), "{view:?}: {copied}");
        from_menu(&mut harness, at, "Save figure..");
        harness.get_by_label("Save");
        harness.key_press(Key::Escape);
        harness.run_steps(3);
        assert_eq!(state(&harness), before, "{view:?}");
        assert!(!harness.state().session.editor.can_undo(), "{view:?}");
    }
}

/// What an entry of the menu at a place copies, if it does.
fn from_menu(harness: &mut Harness<'static, Window>, at: Pos2, entry: &str) -> Option<String> {
    harness.event(Event::PointerMoved(at));
    for pressed in [true, false] {
        let (button, modifiers) = (PointerButton::Secondary, Modifiers::NONE);
        harness.event(Event::PointerButton { pos: at, button, pressed, modifiers });
        harness.run_steps(2);
    }
    harness.get_by_label(entry).click();
    (0..4).find_map(|_| {
        harness.run_steps(1);
        harness.output().platform_output.commands.iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
    })
}

/// Time is panned alone, and a click goes to a time, as the menu does.
#[test]
fn views_over_time_go_to_a_time() {
    for view in OVER_TIME {
        let mut harness = shown(view);
        let rect = place(&harness, view);
        let at = rect.lerp_inside(vec2(0.5, 0.7));
        let time = |harness: &Harness<'static, Window>| harness.state().session.player.time();
        let now = time(&harness);
        let player = &mut harness.state_mut().session.player;
        player.speed = 0.01;
        player.set_playing(true);
        click(&mut harness, at, Modifiers::NONE);
        harness.run_steps(60);
        let clicked = time(&harness);
        assert!(!harness.state().session.player.is_playing(), "{view:?}");
        assert!(clicked > now - 1.6 && clicked < now - 0.4, "{view:?}: {clicked} of {now}");
        // the picture has followed
        from_menu(&mut harness, at, "Go to this time");
        assert!((time(&harness) - (2.0 * clicked - now)).abs() < 0.1, "{view:?}: {}", time(&harness));
        assert!(!harness.state().session.editor.can_undo(), "{view:?}");
        drag(&mut harness, at, at + vec2(40.0, 30.0), (PointerButton::Primary, Modifiers::NONE));
        let [along, up] = harness.state().memory.chosen_axes(view);
        assert!(along.is_some() && up.is_none(), "{view:?}");
    }
}

/// The values of the curve under the pointer stand in one line in the corner of the frame.
#[test]
fn what_is_under_the_pointer_is_read() {
    // in Up and down the runs of both directions are read, in the basins where a start goes to, and the state
    let others = [View::UpAndDown, View::Basins, View::Map, View::PhasePortrait, View::Section];
    for view in PLOTS.into_iter().filter(|view| !others.contains(view)) {
        let mut harness = shown(view);
        let rect = place(&harness, view);
        let across = (0..40).map(|i| 0.6 + 0.009 * i as f32);
        let places = across.flat_map(|x| (0..40).map(move |i| vec2(x, 0.1 + 0.02 * i as f32)));
        let read = places.filter(|at| {
            harness.hover_at(rect.lerp_inside(*at));
            harness.run_steps(1);
            painted(&harness).iter().any(|text| text.0.contains(" at ") && text.0.len() < 60)
        });
        assert!(read.take(1).count() == 1, "{view:?}");
    }
}
