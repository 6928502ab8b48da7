//! The views: drawing of every scene, and the hand on each of them.

use std::collections::HashMap;

use eframe::egui::{Key, Modifiers, Pos2, accesskit::Role, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::views::{Memory, Span, View, energy};
use interwell::app::window::Command;
use interwell::app::window::Window;
use interwell::app::window::layouts::Room;
use interwell::output::{ledger_decimals, ledger_number};
use interwell::scene::{Layout, PRESETS, Stops};

use crate::cursors::wheel;
use crate::support::{PROJECTED, WIDE, command, press, press_with_ctrl, session, window};

fn study(preset: &str, size: [f32; 2]) -> Harness<'static, Window> {
    let mut harness = window(preset, size);
    press_with_ctrl(&mut harness, Key::Num2);
    harness
}

fn click(harness: &mut Harness<'_, Window>, at: Pos2) {
    harness.drag_at(at);
    harness.run_steps(1);
    harness.drop_at(at);
    harness.run_steps(2);
}

#[test]
fn every_view_draws_every_scene() {
    let mut harness = study("first-look", WIDE);
    for preset in PRESETS {
        harness.state_mut().open_another(preset.name);
        harness.key_press(Key::Num5);
        for view in View::ALL {
            command(&mut harness, Command::Show(view, true));
        }
        harness.run_steps(20);
        assert!(harness.state().message().is_none(), "{}", preset.name);
        for view in View::ALL {
            assert!(harness.state().tiling.shows(view), "{}: {}", preset.name, view.name());
        }
        // looked at under the pointer, in the past and held by hand
        for x in [300.0, 500.0, 700.0, 900.0, 1100.0] {
            harness.hover_at(pos2(x, 400.0));
            harness.run_steps(1);
        }
        press(&mut harness, Key::PageUp);
        harness.state_mut().session.player.hold(1e-3);
        harness.run_steps(2);
    }
}

#[test]
fn layouts_switch() {
    let mut harness = study("first-look", WIDE);
    for view in [View::PhasePortrait, View::ForceCurve, View::Energy, View::Well] {
        assert!(harness.state().tiling.shows(view), "{}", view.name());
        harness.get_by_label(view.name());
    }
    press_with_ctrl(&mut harness, Key::Num1);
    assert!(!harness.state().tiling.shows(View::ForceCurve));
    assert!(harness.query_by_label("Force curve").is_none());
    assert!(harness.state().tiling.shows(View::PhasePortrait));
    // the own arrangement is what was there first, and then what becomes of it
    press_with_ctrl(&mut harness, Key::Num4);
    command(&mut harness, Command::Show(View::Velocity, true));
    command(&mut harness, Command::Show(View::Compare, false));
    command(&mut harness, Command::Arrange(Layout::Study));
    assert!(!harness.state().tiling.shows(View::Velocity));
    press_with_ctrl(&mut harness, Key::Num4);
    let window = harness.state();
    assert!(window.tiling.shows(View::Velocity) && !window.tiling.shows(View::Compare));
    let kept = window.custom.clone();
    assert!(kept.is_some());
    // it outlives the scene and the program
    harness.state_mut().open_another("paper");
    assert_eq!(harness.state().custom, kept);
    let mut again = self::window("paper", WIDE);
    again.state_mut().custom = kept;
    command(&mut again, Command::ArrangeOwn);
    assert!(again.state().tiling.shows(View::Velocity) && !again.state().tiling.shows(View::Compare));
}

/// What the program keeps, as text under a key.
#[derive(Default)]
struct Kept(HashMap<String, String>);

impl eframe::Storage for Kept {
    fn get_string(&self, key: &str) -> Option<String> {
        self.0.get(key).cloned()
    }

    fn set_string(&mut self, key: &str, value: String) {
        self.0.insert(key.to_owned(), value);
    }

    fn remove_string(&mut self, key: &str) {
        self.0.remove(key);
    }

    fn flush(&mut self) {}
}

#[test]
fn an_arrangement_with_views_that_are_gone_keeps_the_others() {
    let mut harness = window("paper", WIDE);
    for view in [View::Velocity, View::Events, View::Energy] {
        command(&mut harness, Command::Show(view, true));
    }
    command(&mut harness, Command::KeepOwn);
    let mut kept = Kept::default();
    eframe::App::save(harness.state_mut(), &mut kept);
    let text = kept.0.get_mut("arrangement").unwrap();
    let gone = [("Events", "SideBySide"), ("Energy", "Distance"), ("Compare", "BeforeNow")];
    for (view, gone) in gone {
        *text = text.replace(view, gone);
        assert_eq!(text.matches(gone).count(), 1, "{text}");
    }
    let mut again = window("paper", WIDE);
    again.state_mut().restore(&kept);
    command(&mut again, Command::ArrangeOwn);
    assert!([View::Velocity, View::Compare].iter().all(|view| again.state().tiling.shows(*view)));
    let text = format!("{:?}", again.state().custom);
    assert!(text.contains("Velocity") && text.matches("Compare").count() == 1, "{text}");
}

#[test]
fn a_projector_has_room_for_the_study() {
    let mut harness = study("paper", PROJECTED);
    assert_eq!(harness.state().tiling.room(), Room::Narrow);
    for name in ["Well", "Mechanism", "Phase portrait", "Force curve", "Displacement", "Energy"] {
        let rect = harness.get_by_label(name).rect();
        assert!(
            rect.left() >= 0.0 && rect.right() <= PROJECTED[0] && rect.bottom() <= PROJECTED[1],
            "{name}"
        );
    }
    harness.get_by_label("Energy").click();
    harness.run_steps(3);
    let rect = harness.get_by_label_contains("accounted for").rect();
    assert!(rect.right() <= PROJECTED[0] && rect.bottom() <= PROJECTED[1]);
}

#[test]
fn a_click_in_the_phase_portrait_places_the_mass() {
    let mut harness = study("first-look", WIDE);
    press(&mut harness, Key::Space);
    let before = harness.state().session.player.state();
    let rect = harness.get_by_label("states of the mass").rect();
    let at = pos2(rect.left() + 0.3 * rect.width(), rect.top() + 0.35 * rect.height());
    click(&mut harness, at);
    let session = &harness.state().session;
    let state = session.player.state();
    assert_eq!(state.t, before.t);
    assert!(state.x < -1e-3 && state.v > 0.01, "{state:?}");
    assert!(session.player.watch().ledger().by_hand_j != 0.0);
    // one step brings the mass back, and again to where it was placed
    let of_mass = |harness: &Harness<'static, Window>| {
        let state = harness.state().session.player.state();
        (state.x, state.v)
    };
    let placed = of_mass(&harness);
    command(&mut harness, Command::Undo);
    assert_eq!(of_mass(&harness), (before.x, before.v));
    assert!(!harness.state().session.editor.can_undo());
    command(&mut harness, Command::Redo);
    assert_eq!(of_mass(&harness), placed);
}

#[test]
fn a_stop_dragged_in_the_force_curve_is_one_step() {
    let mut harness = window("paper", WIDE);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, view == View::ForceCurve));
    }
    let before = harness.state().session.scene().stops;
    let wall = harness.get_by_role_and_label(Role::Slider, "right stop").rect();
    harness.drag_at(wall.center());
    harness.run_steps(2);
    for step in 1..=5 {
        harness.hover_at(wall.center() + eframe::egui::vec2(8.0 * step as f32, 0.0));
        harness.run_steps(1);
    }
    harness.drop_at(wall.center() + eframe::egui::vec2(40.0, 0.0));
    harness.run_steps(2);
    let session = &mut harness.state_mut().session;
    let (Stops::Rigid { travel_limit_mm: old, .. }, Stops::Rigid { travel_limit_mm: new, .. }) =
        (before, session.scene().stops)
    else {
        panic!("{:?}", session.scene().stops)
    };
    assert!(new > old + 0.2, "{old} {new}");
    assert!(session.undo());
    assert_eq!(session.scene().stops, before);
    assert!(!session.editor.can_undo());
}

#[test]
fn a_stop_that_is_taken_by_its_side_moves_as_far_as_the_hand() {
    let limit =
        |harness: &Harness<'static, Window>| harness.state().session.scene().stops.travel_limit_mm().unwrap();
    let moved = [-6.0, 0.0, 6.0].map(|aside| {
        let mut harness = window("paper", WIDE);
        for view in View::ALL {
            command(&mut harness, Command::Show(view, view == View::Well));
        }
        let before = limit(&harness);
        let wall = harness.get_by_role_and_label(Role::Slider, "right stop").rect();
        let at = wall.center() + eframe::egui::vec2(aside, 0.0);
        harness.drag_at(at);
        harness.run_steps(2);
        for step in 1..=5 {
            harness.hover_at(at + eframe::egui::vec2(4.0 * step as f32, 0.0));
            harness.run_steps(1);
        }
        harness.drop_at(at + eframe::egui::vec2(20.0, 0.0));
        harness.run_steps(2);
        limit(&harness) - before
    });
    // to the resolution of a drag
    assert!(moved[1] > 0.2 && moved.iter().all(|by| (by - moved[1]).abs() < 0.011), "{moved:?}");
}

#[test]
fn the_energy_view_says_what_the_ledger_says() {
    let mut harness = study("paper", [1920.0, 1080.0]);
    harness.state_mut().session.player.speed = 1.0;
    harness.run_steps(80);
    harness.state_mut().session.player.hold(0.5e-3);
    harness.state_mut().session.player.let_go();
    press(&mut harness, Key::Space);
    let session = &harness.state().session;
    let (watch, now) = (session.player.watch(), session.player.time());
    let model = session.model();
    let (unit, _) = energy::unit_of(model.mass() * model.scales().speed.powi(2));
    let (at, whole) = watch.ledger_at(now).unwrap();
    assert_eq!((at, whole), (now, watch.ledger()));
    let period = watch.last_period(now).unwrap();
    for ledger in [whole, period] {
        assert!(ledger.energy_residual() < 1e-6, "{ledger:?}");
        for joule in [ledger.work_j, ledger.by_hand_j, -ledger.damping_j, -ledger.impact_j, ledger.stored_j] {
            let text = ledger_number(joule, unit, ledger_decimals(&ledger, unit));
            assert!(harness.query_all_by_label(&text).next().is_some(), "{text}");
        }
    }
    harness.get_by_label_contains("100 % of the energy accounted for");
}

#[test]
fn a_stop_that_cannot_be_moves_no_axis() {
    let mut session = session("monostable", &["stops=Rigid(travel_limit_mm: 2, restitution: 0.5)"]);
    let before = Span::of(&session, (0.0, 0.0));
    session.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: 3.5e299, restitution: 0.5 });
    assert!(session.fault().is_some());
    assert_eq!(Span::of(&session, (0.0, 0.0)), before);
}

#[test]
fn the_wheel_zooms_all_traces() {
    let mut harness = window("first-look", WIDE);
    command(&mut harness, Command::Show(View::Velocity, true));
    let rect = harness.get_by_label("Velocity").rect();
    wheel(&mut harness, rect.left_bottom() + eframe::egui::vec2(150.0, 60.0), Modifiers::NONE, 100.0);
    assert!(harness.state().memory.timeline.window.is_some());
}

#[test]
fn axes_stand_still_while_the_wells_move_apart() {
    let (mut session, mut memory) = (session("first-look", &[]), Memory::default());
    let (before, well) =
        (memory.span(&session), session.model().mechanism().landscape.barrier.unwrap().right_well);
    for mm in [2.75, 2.9, 3.1] {
        assert!(session.set_number("mechanism.preload_mm", mm).unwrap());
        session.poll();
        assert_eq!(memory.span(&session), before, "{mm}");
    }
    let moved = session.model().mechanism().landscape.barrier.unwrap().right_well;
    assert!(moved > 1.04 * well && moved < before.high, "{well} {moved} {before:?}");
    session.end_gesture();
    assert!(memory.span(&session).high > before.high);
}

#[test]
fn a_displacement_is_zoomed_with_shift_and_back() {
    let mut harness = window("first-look", WIDE);
    let rect = harness.get_by_label("Displacement").rect();
    let at = rect.left_bottom() + eframe::egui::vec2(200.0, 120.0);
    wheel(&mut harness, at, Modifiers::SHIFT, 100.0);
    let [time, ends] = harness.state().memory.chosen_axes(View::Displacement);
    let ((low, high), window) = (ends.unwrap(), harness.state().memory.timeline.window);
    assert!(time.is_none() && window.is_none() && high - low < 17.5 && high > low, "{low} {high}");
    harness.ctx.options_mut(|options| options.input_options.max_double_click_delay = 5.0);
    for _ in 0..2 {
        harness.drag_at(at);
        harness.drop_at(at);
    }
    harness.run_steps(4);
    assert_eq!(harness.state().memory.chosen_axes(View::Displacement), [None; 2]);
}

#[test]
fn a_view_without_room_says_so() {
    let mut harness = window("first-look", WIDE);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, true));
    }
    harness.run_steps(4);
    harness.get_by_label("Energy");
    // at least a digit of the ledger, or the word that there is no room for it
    let drawn = harness.query_by_label_contains("accounted for").is_some();
    let said = harness.query_all_by_label_contains("Too small to show").next().is_some();
    assert!(drawn || said);
}
