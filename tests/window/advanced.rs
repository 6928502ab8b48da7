//! Controls under More and Advanced.

use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::window::Window;
use interwell::scene::{Excitation, Stops};

use crate::support::{session, window};

fn opened(preset: &str) -> Harness<'static, Window> {
    let mut harness = window(preset, [1280.0, 1600.0]);
    harness.get_by_label("More").click();
    harness.run_steps(3);
    harness.get_by_label("Advanced").click();
    harness.run_steps(15);
    harness
}

#[test]
fn the_kind_of_shaking_is_chosen() {
    let mut harness = opened("first-look");
    for (kind, slider) in [
        ("noise", "highest"),
        ("chirp", "over"),
        ("constant", "acceleration"),
        ("cosine", "amplitude"),
        ("force on the mass", "force"),
        ("sine", "phase"),
    ] {
        harness.get_by_role_and_label(Role::ComboBox, "kind of shaking").click();
        harness.run_steps(3);
        harness.get_by_role_and_label(Role::Button, kind).click();
        harness.run_steps(4);
        harness.get_by_role_and_label(Role::Slider, slider);
        assert!(harness.state().session.fault().is_none(), "{kind}");
    }
    let shaking = &harness.state().session.scene().excitation;
    assert!(matches!(shaking, Excitation::Sine { frequency_hz, .. } if *frequency_hz > 0.0), "{shaking:?}");
    // a frequency at the far end of the band is held off its other end
    harness.state_mut().session.edit_once(|scene| {
        scene.excitation = Excitation::Noise { rms_g: 0.3, low_hz: 2.0, high_hz: 8.0, seed: 1, lines: 64 };
    });
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Slider, "lowest").set_value_accesskit(30.0);
    harness.run_steps(3);
    assert!(harness.state().session.fault().is_none());
}

#[test]
fn stops_may_differ_and_one_stays() {
    let mut harness = opened("paper");
    harness.get_by_label("different stops left and right").click();
    harness.run_steps(3);
    harness.get_by_label("left stop is there").click();
    harness.run_steps(3);
    let stops = harness.state().session.scene().stops;
    assert!(matches!(stops, Stops::Uneven { left_mm: None, right_mm: Some(_), .. }), "{stops:?}");
    harness.get_by_label("right stop is there").click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.scene().stops, stops);
    harness.get_by_role_and_label(Role::Slider, "right restitution").set_value_accesskit(0.5);
    harness.run_steps(3);
    assert!(harness.state().session.fault().is_none());
}

#[test]
fn a_sweep_over_what_is_switched_off_waits() {
    let mut session = session("paper", &[]);
    let axes = session.scene().sweep.clone();
    session.switch_stops(false);
    assert!(session.fault().is_none(), "{:?}", session.fault());
    // what is written can be opened
    let text = session.editor.text().unwrap();
    assert!(interwell::app::session::editor::Editor::from_text(&text).unwrap().document().check().is_ok());
    session.switch_stops(true);
    assert!(session.fault().is_none() && session.scene().sweep == axes);
}

#[test]
fn run_length_and_tolerance() {
    let mut harness = opened("first-look");
    harness.get_by_role_and_label(Role::Slider, "run length").set_value_accesskit(5.0);
    harness.run_steps(3);
    let run = harness.state().session.scene().run;
    assert_eq!((run.duration_s, run.settle_s), (5.0, None));
    harness.get_by_role_and_label(Role::ComboBox, "tolerance").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, "1e-12").click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.scene().run.tolerance, 1e-12);
    assert!(harness.state().session.fault().is_none());
}
