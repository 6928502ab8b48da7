//! The table of events.

use eframe::egui::{Key, accesskit::Toggled};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::dynamics::EventKind;
use interwell_studies::study::{Watch, events_table, watched_events};

use crate::support::{PROJECTED, WIDE, command, is_painted, press, session, settled, sliced, window};

/// The preset with the table of events alone, after some seconds, standing.
fn listed(preset: &str, size: [f32; 2], seconds: usize) -> Harness<'static, Window> {
    let mut harness = window(preset, size);
    let player = &mut harness.state_mut().session.player;
    player.speed = 10.0;
    (0..seconds).for_each(|_| _ = player.tick(0.1));
    player.set_playing(false);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, view == View::Events));
    }
    harness
}

/// The rows that are drawn.
fn rows(harness: &Harness<'static, Window>) -> Vec<String> {
    let all = harness.query_all_by_label_contains(", at ");
    all.filter_map(|node| node.accesskit_node().label()).filter(|label| label.contains("phase")).collect()
}

#[test]
fn events_have_the_columns_of_the_command_line_and_two_more() {
    let mut session = session("paper", &[]);
    session.player.speed = 100.0;
    session.player.tick(0.1);
    let watch = session.player.watch();
    let table = watched_events(watch, 0..usize::MAX);
    let events: Vec<_> = watch.events().iter().copied().collect();
    let plain = events_table(&events);
    assert_eq!(table.columns()[..5], *plain.columns());
    let names: Vec<&str> = table.columns()[5..].iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["phase_deg", "lost_j"]);
    // the impacts take what the ledger says, but for the end of each chatter
    let lost: f64 = table.numbers("lost_j").unwrap().iter().sum();
    let ledger = watch.ledger().impact_j;
    assert!(ledger > 1e-4 && (lost / ledger - 1.0).abs() < 1e-9, "{lost:e} {ledger:e}");
    // in a motion of period 1 impacts come back at the same phase
    let (phases, hertz) = (table.numbers("phase_deg").unwrap(), 3.0);
    for (event, phase) in events.iter().zip(phases) {
        let turns = event.t * hertz;
        let expected = 360.0 * (turns - turns.floor());
        assert!((phase - expected).abs() < 1e-9 || (phase - expected).abs() > 360.0 - 1e-9, "{phase}");
    }
    // a part is that part
    let part = watched_events(watch, 3..7);
    assert_eq!((part.rows(), part.numbers("phase_deg")), (4, Some(&phases[3..7])));
    assert_eq!(watched_events(watch, 5..5).rows(), 0);
}

#[test]
fn a_compliant_contact_has_no_loss_of_one_instant() {
    let mut session =
        settled("paper", &["stops=Hertz(travel_limit_mm:1.5,radius_mm:5,young_gpa:69,loss_s_per_m:4.854)"]);
    session.player.speed = 10.0;
    (0..20).for_each(|_| _ = session.player.tick(0.1));
    let watch = session.player.watch();
    let table = watched_events(watch, 0..usize::MAX);
    let touches = watch.events().iter().zip(table.numbers("lost_j").unwrap());
    let touches: Vec<_> = touches.filter(|touch| touch.0.kind == EventKind::Contact).collect();
    assert!(!touches.is_empty() && touches.iter().all(|touch| touch.1.is_nan()));
}

#[test]
fn a_row_takes_the_time_there_and_the_present_is_marked() {
    let mut harness = listed("paper", WIDE, 3);
    let events: Vec<_> = harness.state().session.player.watch().events().iter().copied().collect();
    assert!(events.len() > 60);
    let drawn = rows(&harness);
    // a window of them, with the present in it
    assert!(drawn.len() < 45 && drawn.len() > 10, "{}", drawn.len());
    let last = events.last().unwrap();
    assert!(drawn.iter().any(|row| row.contains(&format!("at {:.5} s", last.t))), "{drawn:?}");
    let early = drawn[2].clone();
    harness.get_by_label(&early).click();
    harness.run_steps(3);
    let player = &harness.state().session.player;
    assert!(player.is_past() && !player.is_playing());
    let at = player.time();
    assert!(early.contains(&format!("at {at:.5} s")) && events.iter().any(|event| event.t == at));
    let marked = |harness: &Harness<'static, Window>| {
        let node = harness.get_by(|node| {
            node.toggled() == Some(Toggled::True) && node.label().is_some_and(|label| label.contains("phase"))
        });
        node.accesskit_node().label().unwrap()
    };
    assert!(marked(&harness).contains(&format!("at {at:.5} s")));
    // the keys between events go through the list, which follows
    for _ in 0..40 {
        press(&mut harness, Key::PageUp);
    }
    let at = harness.state().session.player.time();
    assert!(marked(&harness).contains(&format!("at {at:.5} s")));
}

#[test]
fn older_events_that_are_gone_are_told() {
    let harness = listed("paper", WIDE, 1);
    assert!(harness.query_by_label_contains("no longer remembered").is_none());
    let count = harness.state().session.player.watch().events().len();
    harness.get_by_label(&format!("{count} events"));
    // a mass between two walls that take nothing has more than are kept
    let mut watch = Watch::new(session("elastic-box", &[]).model());
    while watch.forgotten_events() == 0 {
        let to = watch.time() + 500.0;
        watch.advance(to);
    }
    assert_eq!(watch.events().len(), 50_000);
}

#[test]
fn nothing_that_has_happened_is_said() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.restart();
    harness.state_mut().session.player.set_playing(false);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, view == View::Events));
    }
    harness.get_by_label_contains("Nothing has happened yet");
}

#[test]
fn the_table_has_room_on_a_projector() {
    let harness = listed("paper", PROJECTED, 2);
    assert!(rows(&harness).len() > 5);
    // a row at the edge of the list is cut by it, and no text by its neighbour
    let apart = |label: &&String| label.contains('(');
    let heads: Vec<String> = sliced(&harness).iter().filter(apart).cloned().collect();
    assert_eq!(heads, Vec::<String>::new());
    for head in ["time (s)", "phase (°)", "v in (mm/s)", "v out (mm/s)", "lost (µJ)"] {
        assert!(is_painted(&harness, head), "{head}");
    }
}
