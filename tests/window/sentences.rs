//! The sentence of the status line against the run.

use interwell::app::session::Session;
use interwell::app::words::kind::Kind;
use interwell::scene::{Excitation, Stops};

use crate::support::{LONG, session, settled};

fn says(session: &Session) -> (Kind, String) {
    let sentence = session.sentence();
    (sentence.kind, sentence.whole())
}

fn of(preset: &str, changes: &[&str]) -> (Kind, String) {
    says(&session(preset, changes))
}

fn stops(mm: f64) -> String {
    format!("stops=Rigid(travel_limit_mm: {mm}, restitution: 0.36)")
}

#[test]
fn shaken() {
    let (kind, text) = of("first-look", &[]);
    assert_eq!(kind, Kind::Intrawell);
    // It rattles without a rhythm: the turning point is 5.65 mm, give or take some micrometres, and the RMS
    // velocity 17.1 to
    // 17.9 mm/s at tolerances from 1e-3 to 1e-12.
    let likely = ["5.6", "5.7"].into_iter().flat_map(|low| ["17", "18"].map(|speed| (low, speed)));
    let mut likely = likely.map(|(low, speed)| {
        let between = format!("between {low} and 7.3 mm");
        format!(
            "Intrawell: will swing in the right-hand well, {between}; RMS velocity about {speed} mm/s. It \
             does not repeat within "
        )
    });
    assert!(likely.any(|beginning| text.starts_with(&beginning)), "{text}");
    assert!(text.contains("g short of crossing at 1.1"), "{text}");

    let (kind, text) = of("first-look", &[&stops(1.5)]);
    let expected = "Interwell: will cross twice a period, from stop to stop at ±1.5 mm; \
        RMS velocity 48 mm/s, impacts take 9";
    assert!(kind == Kind::Interwell && text.starts_with(expected), "{text}");
    assert!(text.ends_with(" 0.18 g to spare: crosses from 0.718 g."), "{text}");

    // at rest from the first instant on, which needs no future
    let (kind, text) = of("first-look", &[&stops(2.5)]);
    let expected = "Resting: stays pressed on the right-hand stop; 0.90 g never frees it. Frees at 1.06 g, \
        crosses from 1.1";
    assert!(kind == Kind::Resting && text.starts_with(expected), "{text}");

    let (kind, text) = of("first-look", &[&stops(1.95)]);
    assert!(
        kind == Kind::Intrawell && text.starts_with("Hopping: will leave the right-hand stop every period"),
        "{text}"
    );
    assert!(text.contains("g short of crossing at 0.9"), "{text}");
    // an impact for every bounce, which a chatter has many of
    let (_, impacts) = text.split_once(" and fall back in ").unwrap();
    let impacts: f64 = impacts.split_once(" impacts, never crossing;").unwrap().0.parse().unwrap();
    let hop = session("first-look", &[&stops(1.95)]).settled_now().copied().unwrap();
    assert_eq!(impacts, (hop.impacts as f64 / hop.releases as f64).round());

    let (kind, text) = of("duffing", &[]);
    assert!(
        kind == Kind::Interwell
            && text.contains("will cross 2 times in 5 periods from ")
            && text.contains(" s on and then repeat, "),
        "{text}"
    );
    let (_, text) = of("monostable", &[]);
    assert!(
        text.starts_with(
            "No barrier: one well, so nothing to cross; will swing ±3.6 mm, RMS velocity 66 mm/s."
        )
    );
    // nobody has seen it yet
    let (kind, text) = of("random-shaking", &[]);
    assert!(
        kind == Kind::Crossing
            && text.starts_with("Crossing: will pass the barrier 85 times from 0 s to 60 s; RMS"),
        "{text}"
    );

    let (_, text) = of("first-look", &[&stops(9.0)]);
    assert!(text.contains("Stops at ±9.0 mm are not touched."), "{text}");
}

#[test]
fn a_transient_is_told_as_one() {
    // irregular in the scene's own window, then in step with the drive
    for amplitude in ["1.16", "1.2", "1.25", "1.3", "1.33"] {
        let mut session = settled("first-look", &[&format!("excitation.amplitude_g={amplitude}")]);
        let (kind, text) = says(&session);
        // the path cannot be trusted up to then
        let (how, rest) = text.split_once(" in the end").unwrap();
        let since = session.settled_now().unwrap().settles_at.unwrap();
        assert!(kind == Kind::Interwell && how.starts_with("Interwell: will cross "), "{text}");
        assert!(rest.starts_with([',', ' ']), "{text}");
        // once it has been seen to repeat it is told as it is
        session.player.speed = 1.0;
        while session.player.watch().time() < since + 5.0 {
            session.player.tick(0.1);
        }
        assert!(says(&session).1.starts_with("Interwell: crosses "), "{:?}", says(&session));
    }
    // irregular for as long as it was followed
    let (kind, text) = says(&settled("first-look", &["excitation.amplitude_g=1.5"]));
    assert!(kind == Kind::Irregular && text.starts_with("Irregular: will cross in "), "{text}");
    assert!(text.contains(" Its averages are steady.") || text.contains(" Its averages drift."), "{text}");
}

#[test]
fn a_forecast_that_the_motion_refutes_is_made_anew() {
    let mut live = settled("first-look", &[]);
    let play = |live: &mut Session, seconds: f64| {
        live.player.speed = 1.0;
        let until = live.player.watch().time() + seconds;
        while live.player.watch().time() < until {
            live.player.tick(0.1);
            live.poll();
            live.wait_settled(LONG);
        }
    };
    play(&mut live, 25.0);
    assert!(says(&live).1.starts_with("Intrawell: swings in the right-hand well"), "{:?}", says(&live));
    // to the other side, as a path may go that has lost its accuracy
    live.player.place(2e-3, -0.2);
    live.player.tick(0.5);
    assert!(live.player.state().x < 0.0);
    assert!(says(&live).1.starts_with("Intrawell: will swing in the right-hand well"), "{:?}", says(&live));
    play(&mut live, 15.0);
    assert!(live.player.state().x < 0.0);
    assert!(says(&live).1.starts_with("Intrawell: swings in the left-hand well"), "{:?}", says(&live));
}

#[test]
fn a_forecast_that_the_path_does_not_reach_says_about() {
    let mut live = session("first-look", &["excitation.amplitude_g=1.5"]);
    let text = says(&live).1;
    assert!(text.contains(" will cross in about ") || text.contains("will cross in every period"), "{text}");
    live = session("paper-ramp", &[]);
    // five minutes take half a minute
    assert_eq!(live.player.speed, 10.0);
    live.player.speed = 1.0;
    live.player.set_playing(true);
    assert!(says(&live).1.contains("will cross at "), "{:?}", says(&live));
    // what has happened is past
    live.player.speed = 100.0;
    while live.player.watch().time() < 110.0 {
        live.player.tick(0.05);
    }
    let text = says(&live).1;
    assert!(
        text.contains("was first released at 0.689 g") && text.contains("; crossed at 0.719 g"),
        "{text}"
    );
}

#[test]
fn what_comes_to_repeat_is_not_called_chaotic() {
    // how the path is lost on the way to a rhythm depends on rounding
    let (mut lost, mut grows) = (0, 0);
    for hundredths in 118..=130 {
        let session =
            session("first-look", &[&format!("excitation.amplitude_g={}", f64::from(hundredths) / 100.0)]);
        let (short, long) = session.trust().unwrap();
        if session.settled_now().unwrap().period.is_none() {
            continue;
        }
        assert!(short.starts_with("Path error ") || short.starts_with("Path reliable up to "), "{short}");
        lost += u32::from(short.starts_with("Path reliable up to "));
        grows += u32::from(long.contains("grows tenfold every"));
    }
    assert!(lost >= 3 && grows >= 1, "{lost} {grows}");
}

#[test]
fn each_of_three_wells_has_its_name() {
    // wells at -1.7, 0 and 1.7 mm
    let curve = "mechanism=Polynomial(coefficients_si: [0, 320, 0, -4e8, 0, 1e14])";
    let mut named = Vec::new();
    for x in [-1.75, 0.05, 1.75] {
        let start = format!("start=At(x_mm: {x}, v_m_per_s: 0)");
        for shaking in ["excitation=None", "excitation=Sine(frequency_hz: 3, amplitude_g: 0.01)"] {
            let (_, text) =
                of("nominal-cubic", &[curve, "stops=None", "damping=Ratio(0.05)", &start, shaking]);
            let names = ["left-hand well", "middle well", "right-hand well"];
            let said: Vec<&str> = names.into_iter().filter(|name| text.contains(name)).collect();
            assert_eq!(said.len(), 1, "{text}");
            named.push(said[0]);
        }
    }
    let all = ["left-hand well", "middle well", "right-hand well"];
    assert_eq!(named, all.map(|name| [name; 2]).concat());
}

#[test]
fn one_threshold_for_every_present_amplitude() {
    for (preset, change, least) in [
        ("paper", "stops.restitution=0.5", "0.718"),
        ("paper", "stops.restitution=0.8", "0.718"),
        ("first-look", "stops=Rigid(travel_limit_mm: 5, restitution: 0.36)", ""),
    ] {
        let mut known: Option<String> = None;
        for amplitude in ["0.3", "1", "1.3", "5"] {
            let (_, text) = of(preset, &[change, &format!("excitation.amplitude_g={amplitude}")]);
            let told = ["crosses from ", "short of crossing at ", "takes "];
            let place =
                told.into_iter().find_map(|words| text.split_once(words)).unwrap_or_else(|| panic!("{text}"));
            let number = place.1.split(" g").next().unwrap().to_owned();
            assert!(least.is_empty() || number == least, "{text}");
            assert_eq!(*known.get_or_insert(number.clone()), number, "{text}");
        }
    }
}

#[test]
fn a_ramp_is_told_by_what_happens_on_it() {
    let (kind, text) = of("paper-ramp", &[]);
    assert_eq!(kind, Kind::Resting);
    assert_eq!(
        text,
        "Growing shaking: will first be released at 0.689 g, after 103 s; will cross at 0.719 g, after \
         108 s, and in every period from then on."
    );
    // also where the run ends before the ramp does
    let ramp = "excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 1, over_s: 60)";
    let (_, text) = of("paper", &[ramp]);
    assert!(
        text.starts_with("Growing shaking: will first be released at about 0.69")
            && text.contains("after about 41 s"),
        "{text}"
    );
    let weak = "excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 0.6, over_s: 60)";
    let (kind, text) = of("paper", &[weak]);
    assert_eq!(
        (kind, text.as_str()),
        (Kind::Resting, "Growing shaking: will never be released; will never cross up to 60 s.")
    );
}

#[test]
fn unequal_stops_keep_their_sides() {
    for duration in ["10", "10.17"] {
        let (_, text) = of("uneven-stops", &[&format!("run.duration_s={duration}")]);
        assert!(text.contains("between \u{2212}1.5 and 1.7 mm"), "{text}");
    }
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
    let mut session = settled("first-look", &[]);
    session.player.hold(3.2e-3);
    assert!(
        says(&session).1.starts_with("Held at 3.2 mm: it pulls outwards with 0.1"),
        "{:?}",
        says(&session)
    );
    session.player.hold(7.4e-3);
    assert!(says(&session).1.contains("inwards"), "{:?}", says(&session));
    session.player.hold(1e-9);
    assert_eq!(says(&session).1, "Held at 0.0 mm: nothing pulls.");

    let session = settled("first-look", &["start=At(x_mm: 7.9, v_m_per_s: 2)"]);
    let (kind, text) = says(&session);
    assert!(kind == Kind::Fault && text.starts_with("The run ended at 0.0"), "{text}");
    assert!(text.contains("went further than the flexures were computed, 8.3 mm"), "{text}");
    let session = settled("paper-table", &["stops=None", "start=At(x_mm: 7.9, v_m_per_s: 2)"]);
    assert!(says(&session).1.contains("left the force table"), "{:?}", says(&session));

    let mut session = settled("first-look", &[]);
    session.edit_once(|scene| scene.mass_g = f64::NAN);
    assert_eq!(says(&session).0, Kind::Fault);
    session.undo();
    session.wait_settled(LONG);
    assert_eq!(says(&session).0, Kind::Intrawell);
}

#[test]
fn the_future_until_it_has_been_seen() {
    let mut session = session("first-look", &[]);
    session.player.tick(0.05);
    session.switch_stops(true);
    session.wait(LONG);
    assert!(says(&session).1.starts_with("Interwell: will cross twice a period"), "{:?}", says(&session));
    let (gone, of) = session.settling().unwrap();
    assert!(gone == 0.0 && of > 0.3 && of < 2.0, "{gone} {of}");
    session.player.speed = 1.0;
    while session.settling().is_some() {
        assert!(says(&session).1.starts_with("Interwell: will cross"), "{:?}", says(&session));
        session.player.tick(0.1);
    }
    assert!(says(&session).1.starts_with("Interwell: crosses twice a period"), "{:?}", says(&session));
    // three periods of it have been drawn
    let since = session.player.watch().time() - session.changed_at;
    assert!(since >= 1.0 - 1e-9, "{since}");
    // paused in mid-air, it is not said to rest on a stop
    while session.player.state().phase != interwell::dynamics::Phase::Free {
        session.player.tick(0.01);
    }
    session.edit_once(|scene| {
        if let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation {
            *amplitude_g = 0.3;
        }
    });
    session.wait(LONG);
    assert!(says(&session).1.contains("will stay pressed on the "), "{:?}", says(&session));
}

#[test]
fn no_number_that_can_be_set_ends_the_program() {
    let mut session = session("first-look", &[]);
    for value in [0.0, -1.0, 1e-300, 1e300, f64::INFINITY, f64::NAN] {
        session.edit_once(|scene| {
            if let Excitation::Sine { amplitude_g, frequency_hz, .. } = &mut scene.excitation {
                (*amplitude_g, *frequency_hz) = (value, value);
            }
        });
        session.edit_once(|scene| scene.stops = Stops::Rigid { travel_limit_mm: value, restitution: value });
        session.edit_once(|scene| scene.mass_g = value);
        session.player.tick(0.1);
        session.wait(LONG);
        assert!(!says(&session).1.is_empty());
    }
    while session.undo() {}
    session.wait(LONG);
    assert_eq!(says(&session).0, Kind::Intrawell);
}
