//! Power of a transducer in the window, and the search for the best stops.

use eframe::egui::{Key, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::session::Session;
use interwell::app::session::explore::WalkQuantity;
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::dynamics::{Event, EventKind};
use interwell::scene::{Excitation, FieldPath, Layout, Stops, Transducer};
use interwell_studies::study::SummaryField;

use crate::shared::axis;
use crate::support::{
    LONG, PROJECTED, WIDE, click_on, command, is_painted, painted, press, press_with_ctrl, settled, sliced,
    wait_until, window,
};
use crate::typing::type_into;

const LIMIT: &str = "stops.travel_limit_mm";
const LOAD: &str = "transducer.load_ohm";

#[track_caller]
fn near(value: f64, known: f64, tolerance: f64) {
    assert!((value - known).abs() <= tolerance, "{value:e} is not {known:e}");
}

fn number(session: &Session, path: &str) -> Option<f64> {
    FieldPath::new(path).get(session.scene())
}

/// A window with the view of the power alone.
fn alone(preset: &str, size: [f32; 2]) -> Harness<'static, Window> {
    let mut harness = window(preset, size);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, view == View::Power));
    }
    harness.state_mut().session.restart();
    harness.state_mut().session.player.set_playing(false);
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(3);
    harness
}

#[test]
fn the_view_says_what_the_load_takes() {
    for size in [WIDE, PROJECTED] {
        let harness = alone("harvester", size);
        let summary = *harness.state().session.settled_now().unwrap();
        let harvest = summary.harvest.unwrap();
        near(harvest.mean_load_power.unwrap(), 3.261_236_594e-4, 1e-12);
        near(harvest.mean_coil_power.unwrap() / harvest.mean_load_power.unwrap(), 40.0 / 60.0, 1e-12);
        near(harvest.load_share.unwrap(), 0.124_12, 1e-5);
        assert!(is_painted(&harness, "Into the load: mean 0.326 mW, 12.4 % of the work of the base."));
        assert!(is_painted(&harness, "Coil: mean 0.217 mW. Voltage: 0.140 V RMS."));
        assert!(is_painted(&harness, "of settled motion."));
        assert!(is_painted(&harness, "power into the load (mW)"));
        assert_eq!(sliced(&harness), [""; 0]);
    }
}

#[test]
fn a_tile_among_others_has_the_mean_and_its_axis_fits() {
    let mut harness = window("harvester", WIDE);
    command(&mut harness, Command::Show(View::Power, true));
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(3);
    assert!(harness.state().tiling.place_of(View::Power).unwrap().height() < 250.0);
    assert!(is_painted(&harness, "Into the load: mean 0.326 mW"));
    assert_eq!(sliced(&harness), [""; 0]);
    // the name of the axis would reach into the legend
    assert!(!is_painted(&harness, "power into the load (mW)") && is_painted(&harness, "mW"));
}

#[test]
fn the_scene_about_power_speaks_of_power() {
    let mut harness = window("harvester", WIDE);
    harness.run_steps(3);
    let session = &harness.state().session;
    assert!(session.sentence().text.contains("; 0.326 mW into the load, RMS velocity "));
    assert!(is_painted(&harness, "0.326 mW into the load"));
    // the load is among the first controls, and the power in the card
    harness.get_by_role_and_label(Role::Slider, "load");
    assert!(harness.query_by_role_and_label(Role::Slider, "coupling").is_none());
    assert_eq!(session.map.quantity().name, "mean_load_power_w");
    click_on(&mut harness, "Compare");
    harness.get_by_label("load power");
    harness.get_by_label("0.326");
    // nothing of this where there is no transducer
    let harness = window("paper", WIDE);
    assert!(harness.query_by_role_and_label(Role::Slider, "load").is_none());
    assert!(harness.query_by_label("load power").is_none());
    let session = &harness.state().session;
    assert_eq!(session.map.quantity().name, "rms_velocity_m_per_s");
    assert!(!session.sentence().text.contains("into the load"));
}

#[test]
fn the_trace_keeps_its_mean_in_the_smallest_tile() {
    let mut harness = window("harvester", [1024.0, 700.0]);
    command(&mut harness, Command::Arrange(Layout::Study));
    command(&mut harness, Command::Show(View::Power, true));
    command(&mut harness, Command::Show(View::Velocity, true));
    command(&mut harness, Command::Show(View::BaseAcceleration, true));
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(3);
    assert!(harness.state().tiling.place_of(View::Power).unwrap().height() < 110.0);
    assert!(is_painted(&harness, "Into the load: mean 0.326 mW"));
}

#[test]
fn without_power_the_axis_goes_to_a_milliwatt() {
    let mut harness = alone("harvester", WIDE);
    harness.state_mut().session.set_number(LOAD, f64::INFINITY).unwrap();
    harness.state_mut().session.end_gesture();
    harness.state_mut().session.restart();
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(3);
    assert!(is_painted(&harness, "power into the load (mW)"));
}

#[test]
fn its_sentences_hold_for_every_transducer() {
    let coil = |coupling_v_s_per_m, load_ohm| Transducer::Electromagnetic {
        coupling_v_s_per_m,
        coil_ohm: 40.0,
        load_ohm,
        inductance_mh: 0.0,
    };
    let layer =
        |load_kohm| Transducer::Piezoelectric { coupling_n_per_v: 1e-3, capacitance_nf: 40.0, load_kohm };
    let mut harness = alone("harvester", WIDE);
    let mut shown = |transducer: Transducer, shaken: bool| {
        let session = &mut harness.state_mut().session;
        session.edit_once(|scene| {
            scene.transducer = transducer;
            let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation else { panic!("a sine") };
            *amplitude_g = if shaken { 1.0 } else { 0.0 };
        });
        session.wait_settled(LONG);
        harness.run_steps(3);
        let words: Vec<String> = painted(&harness).into_iter().map(|text| text.0).collect();
        let line = |begin: &str| words.iter().find(|text| text.starts_with(begin)).cloned();
        // an open circuit is typed and shown as inf
        let sentences = || words.iter().filter(|word| *word != "inf");
        assert!(sentences().all(|text| !text.contains("NaN") && !text.contains("inf")), "{words:?}");
        (line("Into the load: mean ").unwrap(), line("Coil: "), line("Voltage: "))
    };
    // nothing is taken by an open circuit, a short one, without coupling, and without motion
    for (transducer, shaken) in [
        (coil(5.0, f64::INFINITY), true),
        (coil(5.0, 0.0), true),
        (coil(0.0, 60.0), true),
        (coil(5.0, 60.0), false),
        (layer(0.0), true),
    ] {
        let (load, ..) = shown(transducer, shaken);
        assert!(load.starts_with("Into the load: mean 0 mW"), "{transducer:?}: {load}");
    }
    assert!(shown(coil(5.0, 0.0), true).1.is_some_and(|text| !text.starts_with("Coil: mean 0 mW")));
    // what has no coil does not speak of one
    let (load, coil, voltage) = shown(layer(100.0), true);
    assert!(load.ends_with("% of the work of the base.") && coil.is_none() && voltage.is_some());
}

#[test]
fn a_current_that_goes_on_by_itself_is_drawn_through_impacts() {
    let mut harness = alone("harvester", WIDE);
    harness.state_mut().session.set_number("transducer.inductance_mh", 200.0).unwrap();
    harness.state_mut().session.end_gesture();
    harness.state_mut().session.wait_settled(LONG);
    harness.state_mut().session.player.set_playing(true);
    wait_until("an impact", || {
        harness.run_steps(1);
        let is_impact = |event: &Event| event.kind == EventKind::Impact;
        harness.state().session.player.watch().events().iter().any(is_impact)
    });
    let samples = harness.state().session.player.watch().samples();
    assert!(samples.iter().all(|sample| sample.electrical.is_finite()));
    assert!(is_painted(&harness, "Into the load: mean ") && is_painted(&harness, "power into the load (mW)"));
    assert!(painted(&harness).iter().all(|text| !text.0.contains("NaN")));
}

#[test]
fn without_a_transducer_it_says_how_to_add_one() {
    for size in [WIDE, PROJECTED] {
        let harness = alone("paper", size);
        assert!(is_painted(&harness, "This scene has no transducer: add one to its file"));
        assert!(is_painted(&harness, "power of the base (mW)") && !is_painted(&harness, "Into the load"));
        assert_eq!(sliced(&harness), [""; 0]);
    }
}

#[test]
fn means_of_a_motion_that_has_not_settled_are_called_so() {
    // 31 forcing periods of an irregular motion are no verdict
    let mut harness = alone("harvester", WIDE);
    let session = &mut harness.state_mut().session;
    session.edit_once(|scene| {
        (scene.stops, scene.run.duration_s) = (Stops::None, 10.0);
        let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation else { panic!("a sine") };
        *amplitude_g = 1.4;
    });
    session.wait_settled(LONG);
    let summary = session.settled_now().unwrap();
    let says = match (summary.settled, summary.steady) {
        (Some(false), Some(true)) => "which are steady, of a motion without a period.",
        (Some(false), Some(false)) => "Not settled: means over the last",
        other => panic!("irregular, under a sine: {other:?}"),
    };
    harness.run_steps(3);
    assert!(is_painted(&harness, says));
    // shaking without a period
    harness.state_mut().session.edit_once(|scene| {
        scene.excitation = Excitation::Noise { rms_g: 0.4, low_hz: 1.0, high_hz: 6.0, seed: 1, lines: 16 };
    });
    harness.state_mut().session.wait_settled(LONG);
    harness.run_steps(3);
    assert!(is_painted(&harness, "The shaking changes: means over 5.00 s of it."));
}

#[test]
fn the_load_is_a_slider_and_takes_both_its_ends_typed() {
    let mut harness = window("harvester", WIDE);
    harness.get_by_label("More").click();
    harness.run_steps(15);
    harness.get_by_role_and_label(Role::Slider, "coupling");
    let mut typed = |text: &str| {
        type_into(&mut harness, "load", text);
        number(&harness.state().session, LOAD).unwrap()
    };
    assert_eq!(typed("inf"), f64::INFINITY);
    assert_eq!(typed("0"), 0.0);
    assert_eq!(typed("46.5"), 46.5);
    assert_eq!(typed("-1"), 46.5);
    let session = &mut harness.state_mut().session;
    assert!(session.fault().is_none());
    // three values are three steps back
    assert!(session.undo() && session.undo() && session.undo() && !session.undo());
    assert_eq!(number(session, LOAD), Some(60.0));
    // a press of an arrow key on the slider is a step by ratio
    harness.get_by_role_and_label(Role::Slider, "load").focus();
    harness.run_steps(2);
    press(&mut harness, Key::ArrowRight);
    let load = number(&harness.state().session, LOAD).unwrap();
    assert!((61.0..72.0).contains(&load), "{load}");
}

#[test]
fn the_map_and_the_walks_go_over_the_load() {
    let mut session = settled("harvester", &["run.duration_s=6", "run.settle_s=4"]);
    assert!(session.map_axes().unwrap().iter().any(|axis| axis.field == LOAD));
    assert!(session.map_fields().iter().any(|field| field == LOAD));
    session
        .map
        .choose(Some([axis(LOAD, (20.0, 80.0, 20.0)), axis("excitation.amplitude_g", (0.9, 1.0, 0.1))]));
    session.map.show(SummaryField::find("mean_load_power_w").unwrap());
    session.want_map(0.0);
    assert!(session.wait_for_map(LONG));
    let map = session.map.map().unwrap();
    let power = |column: usize| {
        map.cell(column, 1).unwrap().0.summary().unwrap().harvest.unwrap().mean_load_power.unwrap()
    };
    assert!(power(1) > power(0) && power(2) > power(3), "{:?}", [0, 1, 2, 3].map(power));
    let mut harness = window("harvester", WIDE);
    harness.state_mut().session.explore.walks.chosen = Some(axis(LOAD, (20.0, 80.0, 20.0)));
    command(&mut harness, Command::Arrange(Layout::Explore));
    harness.get_by_label("Power").click();
    wait_until("the walks", || {
        harness.run_steps(1);
        harness.state().session.explore.walks.found.is_whole()
    });
    assert_eq!(harness.state().session.explore.walks.quantity, WalkQuantity::LoadPower);
    assert!(is_painted(&harness, "mean power into the load (mW)"));
}

/// A session on the prototype in short runs.
fn short(changes: &[&str]) -> Session {
    settled("paper", &[&["run.duration_s=4", "run.settle_s=2"], changes].concat())
}

/// Between stops that lose little the fastest motion is irregular: its average is that of a window.
#[test]
fn the_best_stops_of_a_motion_that_does_not_repeat_have_no_margins() {
    let mut session = short(&["stops.restitution=0.95"]);
    session.find_best_stops();
    assert!(session.wait_for_best_stops(LONG));
    let text = session.best.guide().text;
    let later = "of a motion that has not repeated; followed for twice as long it has ";
    assert!(text.contains(later) && text.ends_with(" mm/s.") && !text.contains("nine tenths"), "{text}");
}

#[test]
fn the_best_stops_are_found_and_taken() {
    let mut session = short(&["stops=None"]);
    let before = session.scene().clone();
    session.find_best_stops();
    assert!(session.wait_for_best_stops(LONG));
    let limit = session.best.limit_mm().unwrap();
    // outward of 2 mm the mass rests
    assert!((1.9..2.2).contains(&limit), "{limit}");
    let guide = session.best.guide();
    assert!(guide.heading.starts_with("Best stops: ±2."), "{guide:?}");
    for part in ["RMS velocity 5", "; at least nine tenths of it from ±1.6", " to ±2.17 mm."] {
        assert!(guide.text.contains(part), "{part}: {guide:?}");
    }
    assert!(guide.more.contains("until its motion repeats"), "{guide:?}");
    assert!(!session.is_at_best_stops());
    session.go_to_best_stops();
    assert!(session.is_at_best_stops() && number(&session, LIMIT) == Some(limit));
    // the answer is about every place of the stops
    session.poll();
    session.follow_best();
    assert!(session.best.is_shown());
    assert!(session.undo() && *session.scene() == before && !session.undo());
    session.poll();
    session.follow_best();
    assert!(session.best.is_shown());
    // of another shaking nothing is known
    session.edit_once(|scene| scene.mass_g = 16.0);
    session.poll();
    session.follow_best();
    assert!(!session.best.is_shown() && session.best.limit_mm().is_none());
}

#[test]
fn a_search_is_ended_by_a_change_and_by_a_hand() {
    let mut session = settled("paper", &["run.duration_s=2000", "run.settle_s=1000", "run.recurrence=false"]);
    session.find_best_stops();
    assert!(session.best.is_running() && session.best.guide().text.starts_with("Looking for the best stops"));
    session.edit_once(|scene| scene.mass_g = 16.0);
    session.poll();
    session.follow_best();
    assert!(!session.best.is_running() && !session.best.is_shown());
    session.find_best_stops();
    session.best.close();
    assert!(!session.best.is_running() && !session.best.is_shown());
}

#[test]
fn with_a_load_the_power_is_made_large() {
    let mut session = settled("harvester", &["run.duration_s=4", "run.settle_s=2"]);
    session.find_best_stops();
    assert!(session.wait_for_best_stops(LONG));
    let words = session.best.guide().text;
    assert!(words.starts_with("Mean power into the load 0.4"), "{words}");
    assert!((1.85..2.1).contains(&session.best.limit_mm().unwrap()), "{words}");
}

#[test]
fn what_has_no_best_stops_says_so() {
    // too weak to move anything, with stops wherever
    let mut session = short(&["excitation=None"]);
    session.find_best_stops();
    assert!(session.wait_for_best_stops(LONG));
    let guide = session.best.guide();
    assert_eq!(guide.heading, "No stops are best:");
    assert!(guide.text.starts_with("the RMS velocity is 0.0 mm/s wherever they stand"), "{guide:?}");
    assert!(session.best.limit_mm().is_none() && !session.is_at_best_stops());
    session.switch_stops(false);
    assert!(!session.is_at_best_stops());
    let mut session = settled("uneven-stops", &[]);
    session.find_best_stops();
    assert!(!session.best.is_running() && session.best.guide().text.contains("both stand equally far out"));
    session.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: 1.5, restitution: 0.36 });
    session.poll();
    session.follow_best();
    assert!(!session.best.is_shown());
}

#[test]
fn the_window_offers_the_search_and_marks_its_answer_on_the_map() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.edit_once(|scene| {
        (scene.run.duration_s, scene.run.settle_s) = (4.0, Some(2.0));
    });
    let axes = [axis(LIMIT, (1.0, 3.0, 0.5)), axis("excitation.amplitude_g", (0.5, 1.5, 0.5))];
    harness.state_mut().session.map.choose(Some(axes));
    press_with_ctrl(&mut harness, Key::Num3);
    harness.get_by_label("Find the best stops").click();
    harness.run_steps(3);
    assert!(harness.state_mut().session.wait_for_best_stops(LONG));
    assert!(harness.state_mut().session.wait_for_map(LONG));
    harness.run_steps(3);
    let limit = harness.state().session.best.limit_mm();
    // the button for the search contains these words
    let are_drawn =
        |harness: &Harness<'static, Window>| painted(harness).iter().any(|text| text.0 == "best stops");
    assert!(is_painted(&harness, "Best stops: ±2.") && are_drawn(&harness));
    for view in [View::Mechanism, View::Well] {
        for other in View::ALL {
            command(&mut harness, Command::Show(other, other == view));
        }
        harness.run_steps(3);
        assert!(are_drawn(&harness), "{}", view.name());
    }
    harness.get_by_label("Take the stops there").click();
    harness.run_steps(3);
    assert_eq!(number(&harness.state().session, LIMIT), limit);
    assert!(is_painted(&harness, "The stops stand there.") && !are_drawn(&harness));
    harness.get_by_label("Close").click();
    harness.run_steps(3);
    assert!(!is_painted(&harness, "est stops: ±"));
}

#[test]
fn a_projector_has_the_search_on_its_key() {
    let mut harness = window("paper", PROJECTED);
    click_on(&mut harness, "Controls");
    let inside = harness.ctx.content_rect();
    for (role, name) in
        [(Role::Slider, "amplitude"), (Role::CheckBox, "Stops"), (Role::Slider, "travel limit ±")]
    {
        let place = harness.get_by_role_and_label(role, name).rect();
        assert!(inside.contains_rect(place) && place.width() > 16.0, "{name} {place:?}");
    }
    press(&mut harness, Key::B);
    assert!(harness.state().session.best.is_shown());
}

#[test]
fn a_lesson_does_not_give_the_best_stops_away() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().open_lesson("08-design-it");
    harness.run_steps(3);
    assert!(harness.state().lesson().is_some());
    command(&mut harness, Command::BestStops);
    harness.state_mut().session.find_best_stops();
    harness.run_steps(3);
    assert!(!harness.state().session.best.is_shown());
    assert_eq!(harness.query_all_by_label("Find the best stops").count(), 0);
}

#[test]
fn a_scene_without_a_load_has_none_to_turn() {
    let session = settled("paper", &[]);
    assert_eq!(session.scene().transducer, Transducer::None);
    assert!(session.number(LOAD).is_none() && !session.map_fields().iter().any(|field| field == LOAD));
}
