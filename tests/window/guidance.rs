//! Hints, ways to cross, and the words for a screen reader.

use eframe::egui::{Key, Role, Shape};
use egui_kittest::kittest::{NodeT, Queryable};
use interwell::app::ui::settings::Settings;
use interwell::app::ui::style::{BODY, STATUS};
use interwell::app::views::View;
use interwell::dynamics::Regime;
use interwell::scene::{Excitation, PRESETS, Stops};

use crate::support::{
    LONG, PROJECTED, WIDE, is_painted, painted, press, session, sliced, window, window_with,
};

/// What is said of the ways to cross, once it is found.
fn ways(preset: &str, changes: &[&str]) -> String {
    let mut session = session(preset, changes);
    assert!(session.ways().starts_with("Looking") || session.amplitude_g().is_none());
    session.wait(LONG);
    session.ways()
}

#[test]
fn the_ways_to_cross_hold() {
    let text = ways("first-look", &[]);
    let limit = text.split('±').nth(1).and_then(|rest| rest.split(' ').next()).unwrap().to_owned();
    assert!(
        text.starts_with("Crosses with about 0.2") && text.contains(" g more, or with stops at ±"),
        "{text}"
    );
    // that is what it does there, and not a step further out
    let regime = |mm: f64| {
        let stops = format!("stops=Rigid(travel_limit_mm: {mm}, restitution: 0.36)");
        session("first-look", &[&stops]).settled().unwrap().regime
    };
    let limit: f64 = limit.parse().unwrap();
    assert_eq!(regime(limit), Regime::Interwell);
    assert_ne!(regime(limit + 0.1), Regime::Interwell);

    let stops = "stops=Rigid(travel_limit_mm: 2.5, restitution: 0.36)";
    let text = ways("first-look", &[stops]);
    assert!(text.contains(&format!("or with stops at ±{limit:.1} mm.")), "{text}");
    let text = ways("first-look", &["excitation.amplitude_g=0.1"]);
    assert!(text.ends_with("no stops alone would do it.") || text.contains("with stops at ±0."), "{text}");
    let text = ways("paper", &[]);
    assert!(text.starts_with("It crosses already"), "{text}");
    let text = ways("walking", &[]);
    assert!(text.starts_with("What it would take is searched for where a sine"), "{text}");
}

#[test]
fn the_hint_leads_on_and_ends() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.player.speed = 1.0;
    harness.get_by_label("Make it cross to the other side.");
    harness.state_mut().session.edit_once(|scene| {
        if let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation {
            *amplitude_g = 1.4;
        }
    });
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(200);
    harness.get_by_label("Harder shaking made it cross.");
    harness.get_by_label_contains("Now go back to 0.90 g and switch the stops on");
    harness.state_mut().session.switch_stops(true);
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(120);
    // with stops, but not yet with less shaking
    harness.get_by_label("Now with less shaking.");
    harness.state_mut().session.edit_once(|scene| {
        if let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation {
            *amplitude_g = 0.9;
        }
    });
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(120);
    harness.get_by_label("Between these stops it crossed, without more shaking.");
    harness.state_mut().session.switch_stops(false);
    harness.run_steps(3);
    harness.get_by_label("Now with stops.");
    harness.state_mut().session.switch_stops(true);
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(120);
    harness
        .state_mut()
        .session
        .edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: 1.8, restitution: 0.36 });
    harness.run_steps(3);
    harness.get_by_label("What stops do:");
    harness.get_by_label("Dismiss").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Dismiss").is_none());
    // the start again, the hint with it
    press(&mut harness, Key::Home);
    harness.get_by_label("Make it cross to the other side.");
    // what is below it stays where it is
    let place = harness.get_by_label("Well").rect();
    harness.get_by_label("Dismiss").click();
    harness.run_steps(3);
    assert_eq!(harness.get_by_label("Well").rect(), place);
    assert!(harness.query_by_label("Dismiss").is_none());
}

#[test]
fn what_it_would_take_is_there_on_request() {
    let mut harness = window("first-look", WIDE);
    press(&mut harness, Key::H);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(2);
    harness.get_by_label_contains("or with stops at ±");
    // it gives the answer away
    press(&mut harness, Key::C);
    assert!(harness.query_by_label_contains("or with stops at ±").is_none());
    assert!(harness.query_by_label_contains("Intrawell: will swing").is_none());
    harness.get_by_label("Covered: what do you expect? C shows it again.");
    harness.key_press(Key::C);
    press(&mut harness, Key::H);
    assert!(harness.query_by_label_contains("or with stops at ±").is_none());
}

/// The name of the motion and its sentence have one size each, whatever they say.
#[test]
fn no_sentence_has_smaller_letters() {
    for preset in PRESETS {
        let harness = window(preset.name, [1024.0, 700.0]);
        let mut sizes = Vec::new();
        for clipped in &harness.output().shapes {
            if let Shape::Text(text) = &clipped.shape
                && (30.0..72.0).contains(&text.pos.y)
                && (40.0..700.0).contains(&text.pos.x)
            {
                sizes.extend(text.galley.job.sections.iter().map(|part| part.format.font_id.size));
            }
        }
        assert!(!sizes.is_empty(), "{}", preset.name);
        assert!(sizes.iter().all(|size| [BODY, STATUS].contains(size)), "{}: {sizes:?}", preset.name);
    }
}

#[test]
fn by_a_projector_what_it_would_take_stands_below_the_sentence() {
    let settings = Settings { projector: true, ..Settings::default() };
    let mut harness = window_with("paper", PROJECTED, settings);
    let place = harness.state().tiling.place_of(View::Well).unwrap();
    assert!(is_painted(&harness, "will cross twice a period"));
    press(&mut harness, Key::H);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(2);
    let text = harness.get_by_label_contains("It crosses already").rect();
    assert!(text.bottom() < place.top() && harness.state().tiling.place_of(View::Well) == Some(place));
    let sentence = painted(&harness).into_iter().find(|text| text.0.contains("will cross twice a period"));
    assert!(sentence.unwrap().1.bottom() <= text.top() + 1.0);
    assert_eq!(sliced(&harness), [""; 0]);
    press(&mut harness, Key::H);
    assert!(is_painted(&harness, "will cross twice a period"));
}

#[test]
fn a_screen_reader_is_told_by_a_new_node() {
    let mut harness = window("first-look", WIDE);
    let spoken = |harness: &egui_kittest::Harness<'static, interwell::app::window::Window>| {
        let node = harness.get_by_role(Role::Status);
        (node.accesskit_node().id(), node.accesskit_node().label().unwrap_or_default())
    };
    let (first, text) = spoken(&harness);
    assert!(text.starts_with("Intrawell: will swing"), "{text}");
    harness.run_steps(3);
    assert_eq!(spoken(&harness).0, first);
    harness.state_mut().session.switch_stops(true);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(40);
    let (second, text) = spoken(&harness);
    assert!(second != first && text.starts_with("Interwell: "), "{text}");
}

#[test]
fn the_projector_can_be_left_again() {
    let mut harness =
        window_with("first-look", [853.0, 480.0], Settings { projector: true, ..Settings::default() });
    harness.get_by_label("View").click();
    harness.run_steps(3);
    let row = harness.get_by_label("Projector").rect();
    assert!(row.bottom() < 480.0, "{row:?}");
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::P);
    assert!(!harness.state().settings.projector);
}

#[test]
fn what_it_would_take_is_offered_where_the_mass_does_not_cross() {
    let mut harness = window("paper", WIDE);
    for (amplitude, ways) in [(1.0, false), (0.5, true)] {
        harness.state_mut().session.set_number("excitation.amplitude_g", amplitude).unwrap();
        harness.state_mut().session.end_gesture();
        harness.state_mut().session.wait(LONG);
        harness.run_steps(3);
        assert!(is_painted(&harness, "F1 lists all keys."));
        assert_eq!(is_painted(&harness, "H says what it would take to cross, "), ways, "{amplitude}");
    }
}
