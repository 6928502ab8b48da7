//! Sliders of the flexures: the curve, the motion, and undo.

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use interwell::scene::Mechanism;

use crate::support::{WIDE, session, window};

fn preload(mechanism: &Mechanism) -> f64 {
    match mechanism {
        Mechanism::Flexures { preload_mm, .. } => *preload_mm,
        _ => f64::NAN,
    }
}

fn set(mechanism: &mut Mechanism, mm: f64) {
    if let Mechanism::Flexures { preload_mm, .. } = mechanism {
        *preload_mm = mm;
    }
}

#[test]
fn preload_reshapes_the_well_under_the_moving_mass() {
    let mut session = session("first-look", &[]);
    session.player.tick(0.1);
    let (before, barrier) = (session.player.state(), session.model().mechanism().landscape.barrier.unwrap());
    for mm in [2.75, 2.9, 3.1] {
        assert!(session.edit_mechanism(|mechanism| set(mechanism, mm)).unwrap());
        session.poll();
    }
    assert!(session.model().mechanism().landscape.barrier.unwrap().right_well > barrier.right_well);
    session.end_gesture();
    let after = session.player.state();
    assert_eq!((before.t, before.x), (after.t, after.x));
    assert!(session.player.watch().ledger().by_hand_j.abs() > 1e-6);
    // solved in earnest at the end of the gesture, bit for bit as a study does
    let files = &session.editor.document().files;
    let earnest = interwell::mechanics::Mechanism::build(&session.scene().mechanism, files);
    assert_eq!(session.model().mechanism().curve, earnest.unwrap().curve);
    assert!(session.undo() && preload(&session.scene().mechanism) == 2.7 && !session.undo());
    assert_eq!(session.model().mechanism().landscape.barrier.unwrap(), barrier);
}

#[test]
fn a_mass_beyond_the_new_curve_is_carried_along() {
    let mut session = session("first-look", &["start=At(x_mm: 7.5, v_m_per_s: 0)", "excitation=None"]);
    session.edit_once(|scene| scene.start = interwell::scene::Start::Rest);
    assert!(session.edit_mechanism(|mechanism| set(mechanism, 0.4)).unwrap());
    session.end_gesture();
    let end = session.model().mechanism().curve.domain().1;
    assert!(end < 7.5e-3 && session.player.state().x <= end);
    assert!(session.player.watch().ledger().by_hand_j.abs() > 1e-6);
}

#[test]
fn what_cannot_be_solved_is_refused_in_words() {
    let mut session = session("first-look", &[]);
    let curve = session.model().mechanism().curve.clone();
    for mm in [-1.0, 14.0, f64::NAN, f64::INFINITY, 1e300] {
        let why = session.edit_mechanism(|mechanism| set(mechanism, mm)).unwrap_err();
        assert!(why.len() > 20, "{mm}: {why}");
        session.end_gesture();
        assert!(session.fault().is_none() && preload(&session.scene().mechanism) == 2.7);
        assert_eq!(session.model().mechanism().curve, curve);
    }
    assert!(!session.editor.can_undo());
    assert!(session.edit_mechanism(|mechanism| set(mechanism, 0.0)).unwrap());
    session.end_gesture();
    assert!(session.model().mechanism().landscape.barrier.is_none());
}

#[test]
fn the_slider_of_the_preload() {
    let mut harness = window("first-look", WIDE);
    harness.get_by_label("More").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Slider, "preload").set_value_accesskit(2.2);
    harness.run_steps(3);
    assert_eq!(preload(&harness.state().session.scene().mechanism), 2.2);
    harness.get_by_role_and_label(Role::Slider, "preload").set_value_accesskit(14.0);
    harness.run_steps(3);
    harness.get_by_label_contains("14.00 mm was not taken");
    assert_eq!(preload(&harness.state().session.scene().mechanism), 2.2);
    harness.get_by_label("Advanced").click();
    harness.run_steps(12);
    harness.get_by_role_and_label(Role::Slider, "thickness").set_value_accesskit(0.12);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("was not taken").is_none());

    let harness = window("paper-table", WIDE);
    assert!(harness.query_by_role_and_label(Role::Slider, "preload").is_none());
}
