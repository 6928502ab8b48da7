//! The past, shown with the model of its time.

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use interwell::app::views::View;
use interwell::scene::{Excitation, Stops};

use crate::support::{session, window};

const G: f64 = 9.80665;

fn shake(scene: &mut interwell::scene::Scene, g: f64) {
    let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation else { panic!("no sine") };
    *amplitude_g = g;
}

#[test]
fn the_model_of_then_is_shown() {
    let mut harness = window("paper", [1280.0, 720.0]);
    harness.state_mut().session.player.speed = 1.0;
    harness.run_steps(40);
    let early = 0.5 * harness.state().session.player.time();
    let session = &mut harness.state_mut().session;
    assert!(session.edit_once(|scene| shake(scene, 0.5)));
    assert!(
        session.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: 3.0, restitution: 0.36 })
    );
    harness.run_steps(40);
    assert!(harness.query_by_label_contains("go to now").is_none());
    let player = &mut harness.state_mut().session.player;
    player.set_playing(false);
    player.seek(early);
    harness.run_steps(3);
    let session = &harness.state().session;
    assert!(session.player.is_past() && early > 0.0);
    let (shown, present) = (session.shown(), session.model());
    assert_eq!((shown.stop_positions().1, present.stop_positions().1), (Some(1.5e-3), Some(3e-3)));
    assert!(
        (shown.largest_base_acceleration() - G).abs() < 1e-9
            && (present.largest_base_acceleration() - 0.5 * G).abs() < 1e-9
    );
    // the stops of then are no handles for those of now
    assert!(harness.query_all_by_role_and_label(Role::Slider, "right stop").next().is_none());
    harness.get_by_label_contains("go to now").click();
    harness.run_steps(3);
    let session = &harness.state().session;
    assert!(!session.player.is_past());
    assert_eq!(session.shown().stop_positions().1, Some(3e-3));
    assert!(harness.query_all_by_role_and_label(Role::Slider, "right stop").next().is_some());
    // from the start again there is no past
    harness.state_mut().session.restart();
    harness.state_mut().session.player.seek(early);
    assert_eq!(harness.state().session.shown().stop_positions().1, Some(3e-3));
}

#[test]
fn a_dragged_slider_does_not_fill_the_memory() {
    let mut session = session("nominal-cubic", &["excitation.amplitude_g=1"]);
    session.player.speed = 1.0;
    for i in 0..2000_u32 {
        session.edit(|scene| shake(scene, 1.0 + 1e-4 * f64::from(i + 1)));
        session.poll();
        session.player.tick(0.02);
    }
    session.end_gesture();
    let watch = session.player.watch();
    let held: Vec<_> = watch.models_between(0.0, f64::INFINITY).collect();
    assert!(held.len() > 100 && held.len() <= 201, "{}", held.len());
    // what is left is in order, and the newest is the present
    assert!(held.windows(2).all(|pair| pair[0].1 == pair[1].0));
    assert!((session.shown().largest_base_acceleration() - 1.2 * G).abs() < 1e-9);
    assert!(watch.model_at(0.5 * watch.time()).largest_base_acceleration() < 1.15 * G);
}

#[test]
fn a_stop_of_the_well_stands_at_its_travel_limit() {
    let mut harness = window("paper", [1280.0, 720.0]);
    let ctx = harness.ctx.clone();
    harness.state_mut().session.player.set_playing(false);
    for view in View::ALL {
        let show = interwell::app::window::Command::Show(view, view == View::Well);
        harness.state_mut().carry_out(&ctx, show);
    }
    harness.state_mut().session.player.hold(1.5e-3);
    harness.run_steps(3);
    assert_eq!(harness.state().session.player.state().x, 1.5e-3);
    let wall = harness.get_by_role_and_label(Role::Slider, "right stop").rect();
    let mass = harness.get_by_role_and_label(Role::Slider, "proof mass").rect();
    let face = wall.center().x - 5.0;
    assert!((mass.center().x - face).abs() < 1.0, "{face} {mass:?}");
}
