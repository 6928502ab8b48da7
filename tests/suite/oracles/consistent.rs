//! Consistency of the events, samples, sums and ledger of runs, over scenes drawn at random.

use interwell::dynamics::{Event, EventKind, Outcome, Phase, Run, Side};

use crate::support::*;

struct Limits {
    left: f64,
    right: f64,
    restitution_left: f64,
    restitution_right: f64,
}

/// Goes through the events in order and holds each against what came before it.
fn check_events(run: &Run, limits: &Limits, start: f64, duration: f64) {
    let mut time = 0.0;
    let mut resting = None;
    let mut rested = 0.0;
    let mut since = 0.0;
    let mut well = if start > 0.0 { Side::Right } else { Side::Left };
    for event in &run.events {
        assert!(time <= event.t && event.t <= duration, "{event:?} after {time}");
        time = event.t;
        let outward = if event.side == Side::Right { 1.0 } else { -1.0 };
        match event.kind {
            EventKind::Impact => {
                assert_eq!((resting, well), (None, event.side), "{event:?}");
                let e = if event.side == Side::Right {
                    limits.restitution_right
                } else {
                    limits.restitution_left
                };
                assert!(event.v_in * outward > 0.0, "{event:?}");
                near(event.v_out, -e * event.v_in, 4e-16 * event.v_in.abs());
            }
            EventKind::Rest => {
                assert_eq!((resting, well), (None, event.side), "{event:?}");
                resting = Some(event.side);
                since = event.t;
            }
            EventKind::Release => {
                assert_eq!(resting, Some(event.side), "{event:?}");
                resting = None;
                rested += event.t - since;
            }
            EventKind::Contact | EventKind::Separate => panic!("these stops are rigid: {event:?}"),
            EventKind::Crossing => {
                assert_eq!(resting, None, "{event:?}");
                assert_ne!(well, event.side, "{event:?}");
                assert!(event.v_in * outward > 0.0, "{event:?}");
                assert_eq!(event.v_in, event.v_out);
                well = event.side;
            }
        }
    }
    if resting.is_some() {
        rested += duration - since;
    }
    near(rested / duration, run.summary.rested_share.unwrap(), 1e-12);
    assert!(well == if run.summary.final_x > 0.0 { Side::Right } else { Side::Left });
}

/// Holds samples against the stops and against the events.
fn check_samples(run: &Run, limits: &Limits) {
    let mut events = run.events.iter().peekable();
    let mut phase = Phase::Free;
    for s in &run.samples {
        while let Some(event) = events.next_if(|e| e.t <= s.t) {
            phase = match (event.kind, event.side) {
                (EventKind::Rest, Side::Left) => Phase::LeftStop,
                (EventKind::Rest, Side::Right) => Phase::RightStop,
                (EventKind::Release, _) => Phase::Free,
                _ => phase,
            };
        }
        assert_eq!(s.phase, phase, "{s:?}");
        match phase {
            Phase::LeftStop => assert_eq!((s.x, s.v), (-limits.left, 0.0)),
            Phase::RightStop => assert_eq!((s.x, s.v), (limits.right, 0.0)),
            Phase::Free => assert!(-limits.left - 1e-15 <= s.x && s.x <= limits.right + 1e-15, "{s:?}"),
        }
    }
}

/// Curves of several pieces, with a kink beyond which the force is a wall: the prototype's table and its
/// flexures.
const PIECES: [&str; 2] = [
    "mechanism=Table(path: \"force_dl2.7.csv\")",
    "mechanism=Flexures(preload_mm: 2.7, thickness_mm: 0.1, young_gpa: 190, \
     parallel: (count: 2, length_mm: 26, width_mm: 20), buckling: (count: 1, length_mm: 27.7, \
     width_mm: 6.8))",
];

#[test]
fn every_record_tells_one_story() {
    // Over 400 scenes: events in order, impacts outward and reflected by e, rest and release by turns,
    // crossings by turns and never while resting, samples within the stops and in the phase that the events
    // tell, counts those of the list, the impacts' energy that of the listed speeds and what the sums took,
    // the ledger closed.
    let mut draw = Draw(1);
    let (mut impacts, mut rests, mut crossings) = (0, 0, 0);
    for i in 0..400 {
        let (left, right) = (draw.between(0.3, 9.0), draw.between(0.3, 9.0));
        let equal = draw.unit() < 0.5;
        let right = if equal { left } else { right };
        let restitution = |draw: &mut Draw| match draw.unit() {
            u if u < 0.1 => 0.0,
            u if u < 0.2 => 1.0,
            u => u,
        };
        let (e_left, e_right) = (restitution(&mut draw), restitution(&mut draw));
        let (a, f, phase) = (draw.between(-2.5, 2.5), draw.between(0.5, 30.0), draw.between(0.0, 360.0));
        let f = 0.25 * (4.0 * f).round(); // whole periods: the window is the whole run
        let x = draw.between(-left, right);
        let v = draw.between(-0.5, 0.5);
        let c = if draw.unit() < 0.2 { 0.0 } else { draw.between(0.0, 0.2) };
        let tolerance = 10f64.powf(-draw.between(4.0, 13.0));
        let mut changes = vec![
            format!("damping=Coefficient(c_n_s_per_m: {c:?})"),
            format!(
                "stops=Uneven(left_mm: {left:?}, right_mm: {right:?}, restitution_left: {e_left:?}, \
                 restitution_right: {e_right:?})"
            ),
            format!("excitation=Sine(frequency_hz: {f:?}, amplitude_g: {a:?}, phase_deg: {phase:?})"),
            format!("start=At(x_mm: {x:?}, v_m_per_s: {v:?})"),
            "run.settle_s=0".to_owned(),
            "run.duration_s=4".to_owned(),
            format!("run.tolerance={tolerance:?}"),
        ];
        if draw.unit() < 0.3 && left < 7.9 && right < 7.9 {
            changes.push(PIECES[i % 2].to_owned());
        }
        let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
        let model = preset("nominal-cubic", &changes);
        let run = run_at(&model, &every(0.00731, 547));
        let summary = &run.summary;
        assert_eq!(summary.outcome, Outcome::Done, "scene {i}");
        let limits = Limits {
            left: left / 1e3,
            right: right / 1e3,
            restitution_left: e_left,
            restitution_right: e_right,
        };
        check_events(&run, &limits, x, 4.0);
        check_samples(&run, &limits);
        assert_eq!(run.samples.len(), 547);
        let count = |kind| of_kind(&run, kind).len() as u64;
        let fast = |event: &Event| event.v_in.abs() > model.min_impact_speed();
        let impacts_that_count = of_kind(&run, EventKind::Impact).into_iter().filter(fast).count();
        assert_eq!(impacts_that_count as u64, summary.total_impacts);
        assert_eq!(count(EventKind::Crossing), summary.total_crossings);
        assert_eq!(count(EventKind::Rest), summary.rests);
        assert_eq!((summary.impacts, summary.crossings), (summary.total_impacts, summary.total_crossings));
        assert_eq!(count(EventKind::Release), summary.releases);
        let taken: f64 =
            of_kind(&run, EventKind::Impact).iter().map(|e| e.v_in * e.v_in - e.v_out * e.v_out).sum();
        let ledger = summary.ledger.unwrap();
        let slowest = 1e-6 * model.scales().speed;
        let sums = summary.chatter_sums as f64 * slowest * slowest;
        near(ledger.impact_j, 0.5 * 0.0152 * taken, 0.5 * 0.0152 * (sums + 1e-13 * taken));
        // the largest as measured is 23 tolerances, where the drive is the fastest rate
        let residual = ledger.energy_residual;
        assert!(residual <= 2.0 * tolerance + 1e-13, "scene {i}: {residual:e} at {tolerance:e}");
        impacts += summary.total_impacts;
        rests += summary.rests;
        crossings += summary.total_crossings;
    }
    assert!(impacts > 10_000 && rests > 500 && crossings > 5_000, "{impacts} {rests} {crossings}");
}
