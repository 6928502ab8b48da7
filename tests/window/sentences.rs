//! Does the status line say what the run says?

use interwell::app::session::Session;
use interwell::app::status::Kind;
use interwell::scene::{Excitation, Stops};

use crate::support::{LONG, session};

fn says(session: &Session) -> (Kind, String) {
    let sentence = session.sentence();
    (sentence.kind, sentence.whole())
}

fn of(preset: &str, changes: &[&str]) -> (Kind, String) {
    says(&session(preset, changes))
}

#[test]
fn shaken() {
    let stops = |mm: f64| format!("stops=Rigid(travel_limit_mm: {mm}, restitution: 0.36)");
    let (kind, text) = of("first-look", &[]);
    assert_eq!(kind, Kind::Intrawell);
    // It rattles without a rhythm: the turning point is 5.65 mm, give or take some micrometres, and the RMS velocity 17.1 to
    // 17.9 mm/s at tolerances from 1e-3 to 1e-12.
    let likely = ["5.6", "5.7"].into_iter().flat_map(|low| ["17", "18"].map(|speed| (low, speed)));
    let mut likely = likely.map(|(low, speed)| {
        let between = format!("between {low} and 7.3 mm");
        format!("Intrawell: stays in the right-hand well, {between}; RMS velocity {speed} mm/s.")
    });
    assert!(likely.any(|own| text.starts_with(&own)), "{text}");
    assert!(text.ends_with("About 0.3 g short of crossing."), "{text}");

    let (kind, text) = of("first-look", &[&stops(1.5)]);
    let expected = "Interwell: crosses twice a period, from stop to stop at ±1.5 mm; RMS velocity 48 mm/s, impacts take 9";
    assert!(kind == Kind::Interwell && text.starts_with(expected), "{text}");
    assert!(text.ends_with(" g to spare."), "{text}");

    let (kind, text) = of("first-look", &[&stops(2.5)]);
    let expected = "Resting: pressed on the right-hand stop all the time; 0.90 g never frees it. Frees at 1.";
    assert!(kind == Kind::Resting && text.starts_with(expected) && text.contains("crosses at 1."), "{text}");

    let (kind, text) = of("first-look", &[&stops(1.95)]);
    assert!(
        kind == Kind::Intrawell && text.starts_with("Hopping: leaves the right-hand stop every period"),
        "{text}"
    );
    assert!(text.ends_with("g short of crossing."), "{text}");

    let (kind, text) = of("first-look", &["excitation.amplitude_g=1.3"]);
    assert!(kind == Kind::Irregular && text.starts_with("Irregular: crosses in "), "{text}");
    assert!(text.contains("reach 7.9 mm") || text.contains("never twice alike"), "{text}");

    let (kind, text) = of("duffing", &[]);
    assert!(
        kind == Kind::Interwell && text.contains("crosses 2 times in 5 periods and then repeats"),
        "{text}"
    );

    let (_, text) = of("paper-unconstrained", &["excitation.amplitude_g=1.35", "run.duration_s=60"]);
    assert!(text.contains("reaching 7.9 mm") || text.contains("Irregular"), "{text}");

    let (_, text) = of("monostable", &[]);
    assert!(text.starts_with(
        "One well: there is no barrier, so nothing to cross; swings ±3.6 mm, RMS velocity 66 mm/s."
    ));

    // nobody has seen it yet
    let (_, text) = of("random-shaking", &[]);
    assert!(text.starts_with("Will cross 85 times in "), "{text}");

    let (_, text) = of("paper-ramp", &[]);
    assert!(text.starts_with("Interwell from 120 s on: will cross twice a period"), "{text}");

    let (_, text) = of("first-look", &[&stops(9.0)]);
    assert!(text.contains("Stops at ±9.0 mm are not touched."), "{text}");
}

#[test]
fn not_shaken() {
    let (kind, text) = of("first-look", &["excitation=None"]);
    assert_eq!(kind, Kind::Resting);
    assert_eq!(
        text,
        "At rest in the right-hand well; nothing shakes it. 0.92 mJ would lift it over the barrier."
    );
    let (_, text) = of("paper", &["excitation=None"]);
    assert!(text.starts_with("Pressed on the right-hand stop with 0.10 N; nothing shakes it. 0."), "{text}");
    let (_, text) = of("first-look", &["excitation=None", "start=At(x_mm: 5, v_m_per_s: 0)"]);
    assert!(text.starts_with("Ringing down in the right-hand well: 0."), "{text}");
    assert!(text.ends_with("mJ of energy left, 0.92 mJ needed to cross."), "{text}");
}

#[test]
fn held_ended_and_wrong() {
    let mut own = session("first-look", &[]);
    own.player.hold(3.2e-3);
    assert!(says(&own).1.starts_with("Held at 3.2 mm: it pulls back outwards with 0.1"), "{:?}", says(&own));
    own.player.hold(7.4e-3);
    assert!(says(&own).1.contains("inwards"), "{:?}", says(&own));

    let own = session("first-look", &["start=At(x_mm: 7.9, v_m_per_s: 2)"]);
    let (kind, text) = says(&own);
    assert!(kind == Kind::Fault && text.starts_with("The run ended at 0.0"), "{text}");
    assert!(text.contains("beyond what was solved of the flexures, which ends at 8.3 mm"), "{text}");
    let own = session("paper-table", &["stops=None", "start=At(x_mm: 7.9, v_m_per_s: 2)"]);
    assert!(says(&own).1.contains("left the force table"), "{:?}", says(&own));

    let mut own = session("first-look", &[]);
    own.edit_once(|scene| scene.mass_g = f64::NAN);
    assert_eq!(says(&own).0, Kind::Fault);
    own.undo();
    own.wait(LONG);
    assert_eq!(says(&own).0, Kind::Intrawell);
}

#[test]
fn the_future_until_it_has_been_seen() {
    let mut own = session("first-look", &[]);
    own.player.tick(0.05);
    own.switch_stops(true);
    own.wait(LONG);
    assert!(says(&own).1.starts_with("Interwell: will cross twice a period"), "{:?}", says(&own));
    assert_eq!(own.settling(), Some((0, 5)));
    own.player.speed = 1.0;
    for _ in 0..12 {
        own.player.tick(0.1);
    }
    assert!(says(&own).1.starts_with("Interwell: crosses twice a period"), "{:?}", says(&own));
    assert_eq!(own.settling(), Some((3, 5)));
}

#[test]
fn no_number_that_can_be_set_ends_the_program() {
    let mut own = session("first-look", &[]);
    for value in [0.0, -1.0, 1e-300, 1e300, f64::INFINITY, f64::NAN] {
        own.edit_once(|scene| {
            if let Excitation::Sine { amplitude_g, frequency_hz, .. } = &mut scene.excitation {
                (*amplitude_g, *frequency_hz) = (value, value);
            }
        });
        own.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: value, restitution: value });
        own.edit_once(|scene| scene.mass_g = value);
        own.player.tick(0.1);
        own.wait(LONG);
        assert!(!says(&own).1.is_empty());
    }
    while own.undo() {}
    own.wait(LONG);
    assert_eq!(says(&own).0, Kind::Intrawell);
}
