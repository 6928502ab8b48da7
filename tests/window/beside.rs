//! What the drawn mechanism has beside its flexures: a spring, magnets, a transducer; and their sliders.

use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::{FieldPath, PRESETS, Transducer};

use crate::support::{PROJECTED, WIDE, command, is_painted, painted, sliced, window};

/// What nothing but a spring, magnets or a transducer is called.
const NAMES: [&str; 4] = ["spring 50", "magnets attract", "magnets repel", "load 60 ohm"];

/// A window with the mechanism alone; the motion stands at its start.
fn alone(preset: &str, size: [f32; 2]) -> Harness<'static, Window> {
    let mut harness = window(preset, size);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, view == View::Mechanism));
    }
    harness.state_mut().session.restart();
    harness.state_mut().session.player.set_playing(false);
    harness.run_steps(3);
    harness
}

fn set(harness: &mut Harness<'static, Window>, path: &str, value: f64) {
    harness.state_mut().session.set_number(path, value).unwrap();
    harness.state_mut().session.end_gesture();
    harness.run_steps(3);
}

/// The poles from above to below, with their heights.
fn poles(harness: &Harness<'static, Window>) -> Vec<(String, f32)> {
    let all = painted(harness).into_iter().filter(|text| ["N", "S"].contains(&text.0.as_str()));
    let mut poles: Vec<(String, f32)> = all.map(|text| (text.0, text.1.center().y)).collect();
    poles.sort_by(|a, b| a.1.total_cmp(&b.1));
    poles
}

#[test]
fn a_scene_is_drawn_with_what_it_has_and_with_nothing_else() {
    for preset in PRESETS {
        let shown: &[&str] = match preset.name {
            "balanced" => &["spring 50"],
            "magnet" => &["magnets attract"],
            "harvester" => &["load 60 ohm"],
            _ => &[],
        };
        for size in [WIDE, PROJECTED] {
            let harness = alone(preset.name, size);
            for name in NAMES {
                assert_eq!(is_painted(&harness, name), shown.contains(&name), "{}: {name}", preset.name);
            }
            let count = match preset.name {
                "magnet" => 4,
                "harvester" => 2, // over the coil
                _ => 0,
            };
            assert_eq!(poles(&harness).len(), count);
            assert_eq!(sliced(&harness), [""; 0], "{}", preset.name);
        }
    }
}

#[test]
fn facing_poles_attract_or_repel_as_the_force_does() {
    let mut harness = alone("magnet", WIDE);
    let letters = |harness: &Harness<'static, Window>| -> String {
        poles(harness).into_iter().map(|pole| pole.0).collect()
    };
    assert_eq!(letters(&harness), "NSNS");
    let apart = |harness: &Harness<'static, Window>| {
        let all = poles(harness);
        (all[2].1 + all[3].1 - all[0].1 - all[1].1) * 0.5
    };
    // the gap has a scale
    let before = apart(&harness);
    set(&mut harness, "mechanism.1.gap_mm", 9.0);
    assert!((apart(&harness) / before - 0.75).abs() < 0.02, "{} {before}", apart(&harness));
    set(&mut harness, "mechanism.1.strength_n_mm4", -300.0);
    assert_eq!(letters(&harness), "NSSN");
    assert!(is_painted(&harness, "magnets repel") && !is_painted(&harness, "magnets attract"));
    set(&mut harness, "mechanism.1.strength_n_mm4", 0.0);
    assert!(letters(&harness).is_empty() && !is_painted(&harness, "magnets repel"));
}

#[test]
fn springs_and_magnets_need_no_flexures_beside_them() {
    let mut harness = alone("magnet", WIDE);
    let text = "(title: \"a\", mass_g: 15, \
                mechanism: Sum([Linear(n_per_m: 40), Magnet(strength_n_mm4: -1500, gap_mm: 12)]), \
                damping: Coefficient(c_n_s_per_m: 0.05), \
                start: At(x_mm: 1, v_m_per_s: 0), run: (duration_s: 4))";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("own.ron");
    std::fs::write(&path, text).unwrap();
    harness.state_mut().open_another(path.to_str().unwrap());
    harness.run_steps(5);
    assert!(is_painted(&harness, "spring 40 N/m") && is_painted(&harness, "magnets repel"));
    assert!(is_painted(&harness, "not to scale") && !is_painted(&harness, "a spring of this force"));
    assert!(!is_painted(&harness, "flexure") && poles(&harness).len() == 4);
    // with both gone the mass is free
    set(&mut harness, "mechanism.1.strength_n_mm4", 0.0);
    set(&mut harness, "mechanism.0.n_per_m", -40.0);
    assert!(is_painted(&harness, "spring -40 N/m") && is_painted(&harness, "not to scale"));
    set(&mut harness, "mechanism.0.n_per_m", 0.0);
    assert!(
        is_painted(&harness, "a free mass")
            && painted(&harness)
                .iter()
                .all(|label| !label.0.ends_with("N/m") || !label.0.starts_with("spring"))
    );
}

#[test]
fn a_load_is_drawn_from_a_short_circuit_to_an_open_one() {
    let mut harness = alone("harvester", WIDE);
    assert!(is_painted(&harness, "coil, load 60 ohm"));
    for (load, words) in [(0.0, "short circuit"), (f64::INFINITY, "open circuit"), (1e-3, "load 0.001 ohm")] {
        set(&mut harness, "transducer.load_ohm", load);
        assert!(is_painted(&harness, words), "{words}");
    }
    set(&mut harness, "transducer.coupling_v_s_per_m", 0.0);
    assert!(is_painted(&harness, "coil, load 0.001 ohm"));
    harness.state_mut().session.edit_once(|scene| {
        scene.transducer =
            Transducer::Piezoelectric { coupling_n_per_v: 1e-3, capacitance_nf: 40.0, load_kohm: 100.0 };
    });
    harness.run_steps(3);
    assert!(is_painted(&harness, "piezo, load 100 kohm") && !is_painted(&harness, "coil, "));
}

#[test]
fn a_load_has_its_name_where_the_mechanism_shares_a_projected_window() {
    let mut harness = window("harvester", PROJECTED);
    harness.run_steps(3);
    let all = painted(&harness);
    let load = all.iter().find(|text| text.0.contains("load 60 ohm"));
    assert!(load.is_some_and(|text| text.2.contains_rect(text.1)), "{load:?} {all:?}");
}

#[test]
fn springs_and_magnets_have_sliders_under_more() {
    for (preset, name, path, value) in [
        ("balanced", "spring of part 2", "mechanism.1.n_per_m", 40.0),
        ("magnet", "strength of the magnets of part 2", "mechanism.1.strength_n_mm4", 900.0),
        ("magnet", "gap of the magnets of part 2", "mechanism.1.gap_mm", 13.0),
    ] {
        let mut harness = window(preset, WIDE);
        harness.get_by_label("More").click();
        harness.run_steps(15);
        harness.get_by_role_and_label(Role::Slider, name).set_value_accesskit(value);
        harness.run_steps(3);
        let scene = harness.state().session.scene();
        assert_eq!(FieldPath::new(path).get(scene), Some(value), "{name}");
    }
}
