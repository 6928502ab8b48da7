//! The map: filled, stopped and made again; a click on a cell; agreement with the command line's sweep.

use eframe::egui::{Key, Modifiers, PointerButton, accesskit::Role};
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::session::map::Map;
use interwell::app::window::Window;
use interwell::scene::{Layout, Start, Stops, SweepAxis};

use crate::cursors::{drag, wheel};
use crate::shared::axis;
use crate::support::{
    LONG, WIDE, choose_in_map, click_on, painted, press, press_with_ctrl, session, wait_for_threads,
    wait_until, window,
};
use crate::written::arguments;

/// A small map, so that a test takes no longer than it must.
fn axes(steps: (f64, f64)) -> [SweepAxis; 2] {
    [axis("stops.travel_limit_mm", (1.0, 3.0, steps.0)), axis("excitation.amplitude_g", (0.5, 1.5, steps.1))]
}

fn open(preset: &str, size: [f32; 2], steps: (f64, f64)) -> Harness<'static, Window> {
    let mut harness = window(preset, size);
    harness.state_mut().session.map.choose(Some(axes(steps)));
    press_with_ctrl(&mut harness, Key::Num3);
    harness
}

fn fill(harness: &mut Harness<'static, Window>) {
    assert!(harness.state_mut().session.wait_for_map(LONG));
    harness.run_steps(3);
}

fn map(window: &Window) -> &Map {
    window.session.map.map().unwrap()
}

#[test]
fn it_fills_and_a_click_is_one_step() {
    let mut harness = open("paper", WIDE, (0.25, 0.25));
    assert_eq!(map(harness.state()).count(), 9 * 5);
    fill(&mut harness);
    assert!(map(harness.state()).is_whole() && !harness.state().session.map.is_running());
    let overlay = &map(harness.state()).overlay;
    assert!(overlay.release.as_ref().is_some_and(|line| line.rows() > 0));
    assert!(overlay.first_crossing.as_ref().is_some_and(|line| line.rows() > 0));
    let place = harness.get_by_role_and_label(Role::Image, "map").rect();
    let (before, state) = (harness.state().session.scene().clone(), harness.state().session.player.state());
    // the cell at the middle is 2 mm and 1 g, and is read in one line
    let rms = 1e3 * map(harness.state()).cell(4, 2).unwrap().0.summary().unwrap().rms_velocity.unwrap();
    harness.hover_at(place.center());
    harness.run_steps(2);
    let texts = painted(&harness).into_iter().map(|text| text.0);
    let reading =
        texts.filter(|text| text.starts_with("2 mm, 1 g: interwell; RMS velocity ")).collect::<Vec<_>>();
    let read = reading[0].trim_end_matches(" mm/s").rsplit(' ').next().unwrap().parse::<f64>().unwrap();
    assert!(reading.len() == 1 && (read / rms - 1.0).abs() < 5e-3, "{reading:?} {rms}");
    harness.drag_at(place.center());
    harness.run_steps(1);
    harness.drop_at(place.center());
    harness.run_steps(8);
    let session = &mut harness.state_mut().session;
    assert_eq!(session.scene().stops, Stops::Rigid { travel_limit_mm: 2.0, restitution: 0.36 });
    assert_eq!(session.amplitude_g(), Some(1.0));
    // the motion goes on
    assert!(session.player.state().t >= state.t && session.player.watch().time() >= state.t);
    // only the marker moves
    assert!(session.map.map().is_some_and(Map::is_whole));
    assert!(session.undo() && *session.scene() == before && !session.undo());
}

/// A window on a map of 80 000 cells, most of which take ten thousand steps: more than come within a test.
fn large() -> Harness<'static, Window> {
    let mut harness = window("paper", WIDE);
    let session = &mut harness.state_mut().session;
    session.edit_once(|scene| (scene.run.duration_s, scene.run.recurrence) = (100.0, false));
    session.map.choose(Some(axes((0.005, 0.005))));
    harness
}

/// Shows the map, and waits for its first cells.
fn begin(harness: &mut Harness<'static, Window>) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
    wait_until("the first cells", || {
        harness.run_steps(1);
        harness.state().session.map.map().is_some_and(|map| map.known > 0)
    });
}

#[test]
fn it_stops_and_goes_on() {
    let mut harness = large();
    begin(&mut harness);
    harness.get_by_label("Stop").click();
    harness.run_steps(3);
    let known = map(harness.state()).known;
    assert!(!harness.state().session.map.is_running() && known < map(harness.state()).count());
    harness.state_mut().session.stop_working();
    wait_for_threads(harness.state());
    harness.run_steps(3);
    assert_eq!(map(harness.state()).known, known);
    harness.get_by_label("Continue").click();
    harness.run_steps(3);
    assert!(harness.state().session.map.is_running());
}

#[test]
fn hidden_it_computes_nothing() {
    let mut harness = large();
    harness.run_steps(5);
    assert!(harness.state().session.map.map().is_none());
    begin(&mut harness);
    assert!(harness.state().session.map.is_running());
    press_with_ctrl(&mut harness, Key::Num1);
    assert!(!harness.state().session.map.is_running());
    let known = map(harness.state()).known;
    harness.state_mut().session.stop_working();
    wait_for_threads(harness.state());
    harness.run_steps(3);
    assert_eq!(map(harness.state()).known, known);
    // what is known is kept
    press_with_ctrl(&mut harness, Key::Num3);
    assert!(harness.state().session.map.is_running() && map(harness.state()).known >= known);
}

#[test]
fn what_it_depends_on_makes_another() {
    let mut harness = open("paper", WIDE, (0.25, 0.25));
    fill(&mut harness);
    let session = &mut harness.state_mut().session;
    session.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: 1.2, restitution: 0.36 });
    session.edit_once(|scene| scene.start = Start::At { x_mm: 0.5, v_m_per_s: 0.0, electrical: 0.0 });
    harness.run_steps(2);
    assert!(map(harness.state()).is_whole());
    // while a hand moves it waits, and the one before stays to be seen
    let session = &mut harness.state_mut().session;
    session.edit(|scene| scene.mass_g = 16.0);
    let asked = session.want_map(1000.0);
    assert!(asked && !session.map.is_running());
    assert!(session.map.shown().is_some_and(|(map, current)| map.question.scene.mass_g == 15.2 && !current));
    session.end_gesture();
    assert!(!session.want_map(1000.0));
    assert!(session.map.is_running());
    fill(&mut harness);
    assert_eq!(map(harness.state()).question.scene.mass_g, 16.0);
    assert!(harness.state().session.map.shown().is_some_and(|(_, current)| current));
    choose_in_map(&mut harness, "Recompute");
    fill(&mut harness);
}

/// The final level, byte for byte, with the command that the menu copies.
#[test]
fn it_is_the_sweep_of_the_command_line() {
    let changes: [&[&str]; 3] = [
        &[],
        &["damping.xi=0.05", "start=At(x_mm: 0.5, v_m_per_s: 0)", "excitation.frequency_hz=2.5"],
        &["stops=None"],
    ];
    for changes in changes {
        let mut session = session("paper", &[]);
        let mut document = session.editor.document().clone();
        changes.iter().for_each(|change| document.set(change).unwrap());
        session.edit_once(|scene| *scene = document.scene);
        session.map.choose(Some(axes((0.25, 0.125))));
        session.want_map(0.0);
        assert!(session.wait_for_map(LONG));
        let command = interwell::app::export::map_command_line(&session).unwrap();
        let output =
            assert_cmd::Command::cargo_bin("interwell").unwrap().args(arguments(&command)).output().unwrap();
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        let csv = session.map.csv().unwrap();
        assert_eq!(csv, String::from_utf8(output.stdout).unwrap(), "{command}");
    }
}

#[test]
fn it_fits() {
    for size in [WIDE, [1920.0, 1080.0], [853.0, 480.0]] {
        let mut harness = open("paper", size, (0.25, 0.25));
        fill(&mut harness);
        let place = harness.get_by_role_and_label(Role::Image, "map").rect();
        assert!(place.right() <= size[0] && place.bottom() <= size[1], "{place}");
        assert!(place.width() > 0.3 * size[0] && place.height() > 0.35 * size[1], "{size:?}: {place}");
        click_on(&mut harness, "Options");
        for label in ["Flat", "Recompute"] {
            let rect = harness.get_by_label(label).rect();
            assert!(rect.right() <= size[0] && rect.left() >= 0.0, "{label}: {rect}");
        }
    }
}

#[test]
fn every_preset_has_a_map_or_says_why_not() {
    for preset in interwell::scene::PRESETS {
        let mut harness = window(preset.name, WIDE);
        harness.state_mut().carry_out(
            &eframe::egui::Context::default(),
            interwell::app::window::Command::Arrange(Layout::Map),
        );
        harness.run_steps(4);
        let mapping = &harness.state().session.map;
        assert!(
            mapping.map().is_some() && mapping.problem.is_none(),
            "{}: {:?}",
            preset.name,
            mapping.problem
        );
    }
}

#[test]
fn a_map_that_cannot_be_made_says_of_which_scene() {
    let mut session = session("paper", &[]);
    let [_, amplitude] = axes((0.25, 0.25));
    // settled beyond the end of the run
    session.map.choose(Some([axis("run.settle_s", (1.0, 20.0, 1.0)), amplitude]));
    session.want_map(0.0);
    let problem = session.map.problem.clone().unwrap();
    assert!(problem.starts_with("built-in paper: "), "{problem}");
}

/// Ends and steps of both axes.
fn ranges(harness: &Harness<'static, Window>) -> [(f64, f64, f64); 2] {
    map(harness.state()).question.axes.clone().map(|axis| (axis.from, axis.to, axis.step))
}

#[test]
fn it_keeps_its_own_axes_when_it_is_clicked() {
    let mut harness = window("first-look", WIDE);
    press_with_ctrl(&mut harness, Key::Num3);
    let before = ranges(&harness);
    assert_eq!(before[1], (0.0, 2.0, 0.02));
    let place = harness.get_by_role_and_label(Role::Image, "map").rect();
    let at = place.left_bottom() + eframe::egui::vec2(0.3 * place.width(), -0.1 * place.height());
    harness.drag_at(at);
    harness.run_steps(1);
    harness.drop_at(at);
    harness.run_steps(8);
    let g = harness.state().session.amplitude_g().unwrap();
    assert!((0.1..0.3).contains(&g), "{g}");
    assert_eq!(ranges(&harness), before);
    // nor do other hands on the scene move them
    harness.state_mut().session.set_number("excitation.amplitude_g", 0.05).unwrap();
    harness.state_mut().session.end_gesture();
    harness.run_steps(3);
    assert_eq!(ranges(&harness), before);
}

#[test]
fn a_box_enlarges_and_a_double_click_is_back() {
    let mut harness = open("paper", WIDE, (0.25, 0.25));
    fill(&mut harness);
    let (before, scene) = (ranges(&harness), harness.state().session.scene().clone());
    let place = harness.get_by_role_and_label(Role::Image, "map").rect();
    let at = |x: f32, y: f32| place.min + eframe::egui::vec2(x, y) * place.size();
    drag(&mut harness, at(0.5, 0.6), at(0.8, 0.45), (PointerButton::Secondary, Modifiers::NONE));
    let [across, up] = ranges(&harness);
    assert!(across.0 > 1.8 && across.1 < 2.8 && across.2 < 0.25, "{across:?}");
    assert!(up.0 > 0.8 && up.1 < 1.2 && up.2 < 0.25, "{up:?}");
    assert_eq!(*harness.state().session.scene(), scene);
    harness.get_by_label("axes of Map as they were");
    // a drag pans, the wheel enlarges and goes back
    drag(&mut harness, at(0.5, 0.5), at(0.3, 0.7), (PointerButton::Primary, Modifiers::NONE));
    let panned = ranges(&harness);
    for (now, then) in [(panned[0], across), (panned[1], up)] {
        // in whole cells
        assert!(now.0 > then.0 && (now.1 - now.0 - then.1 + then.0).abs() < 2.1 * now.2, "{panned:?}");
    }
    wheel(&mut harness, at(0.5, 0.5), Modifiers::NONE, 120.0);
    let closer = ranges(&harness);
    assert!(closer[0].1 - closer[0].0 < 0.6 * (panned[0].1 - panned[0].0), "{closer:?} {panned:?}");
    wheel(&mut harness, at(0.5, 0.5), Modifiers::NONE, -120.0);
    assert_eq!(*harness.state().session.scene(), scene);
    // a test's frames are long
    harness.ctx.options_mut(|options| options.input_options.max_double_click_delay = 5.0);
    for _ in 0..2 {
        harness.drag_at(at(0.5, 0.5));
        harness.drop_at(at(0.5, 0.5));
    }
    harness.run_steps(40);
    assert_eq!(ranges(&harness), before);
    // the whole map was kept
    assert!(map(harness.state()).is_whole() && !harness.state().session.map.is_running());
    assert_eq!(*harness.state().session.scene(), scene);
}

#[test]
fn the_cross_hair_is_dragged_and_stepped() {
    let mut harness = open("paper", WIDE, (0.25, 0.25));
    fill(&mut harness);
    let before = harness.state().session.scene().clone();
    let place = harness.get_by_role_and_label(Role::Image, "map").rect();
    let cross = harness.get_by_role_and_label(Role::Slider, "cross-hair").rect().center();
    harness.drag_at(cross);
    harness.run_steps(2);
    for step in 1..=4 {
        harness.hover_at(cross + (place.center() - cross) * (step as f32 / 4.0));
        harness.run_steps(1);
    }
    harness.drop_at(place.center());
    harness.run_steps(2);
    let stops = |harness: &Harness<'static, Window>| harness.state().session.scene().stops;
    assert_eq!(stops(&harness), Stops::Rigid { travel_limit_mm: 2.0, restitution: 0.36 });
    harness.get_by_role_and_label(Role::Slider, "cross-hair").focus();
    harness.run_steps(2);
    press(&mut harness, Key::ArrowRight);
    assert_eq!(stops(&harness), Stops::Rigid { travel_limit_mm: 2.25, restitution: 0.36 });
    let session = &mut harness.state_mut().session;
    assert!(session.undo() && session.undo() && *session.scene() == before && !session.undo());
}

#[test]
fn ends_and_steps_are_typed() {
    let mut harness = open("paper", WIDE, (0.25, 0.25));
    harness.get_by_label("Options").click();
    harness.run_steps(4);
    let mut enter = |name: &str, text: &str| {
        harness.get_by_role_and_label(Role::SpinButton, name).click();
        harness.run_steps(2);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.event(eframe::egui::Event::Text(text.to_owned()));
        harness.run_steps(2);
        press(&mut harness, Key::Enter);
    };
    enter("across, from", "0.5");
    enter("across, step", "0.5");
    enter("up, to", "1.25");
    // a step that is none is refused
    enter("up, step", "0");
    enter("up, step", "one");
    assert_eq!(ranges(&harness), [(0.5, 3.0, 0.5), (0.5, 1.25, 0.25)]);
    harness.get_by_label_contains("“one” is no number");
}
