//! Live runs: the same run in any pieces, changes on the way, and the memory of what was seen.

use interwell::dynamics::{EventKind, Live, LiveOutput, Model, Phase, Request, Sample, Side};
use interwell::scene::{PRESETS, Preset};
use interwell_studies::study::Watch;
use proptest::prelude::*;

use crate::properties::harness::hold_for;
use crate::support::*;

const SCENES: [&str; 7] = [
    "paper",
    "paper-unconstrained",
    "nominal-cubic",
    "walking",
    "random-shaking",
    "paper-ramp",
    "bouncing-ball",
];

/// Advances to the end of the model's run in pieces of `piece` s with a sample every `dt` s.
pub fn in_pieces(model: &Model, duration: f64, piece: f64, times: &[f64]) -> (Live, LiveOutput) {
    let mut live = Live::new(model);
    let mut passage = LiveOutput::default();
    let mut next = 0;
    while live.time() < duration {
        let to = (live.time() + piece).min(duration);
        let upto = next + times[next..].partition_point(|t| *t <= to);
        let before = live.time();
        live.advance(to, &times[next..upto], &mut passage);
        if live.time() < to {
            assert!(live.time() > before, "stuck at {before}");
        }
        next += times[next..upto].partition_point(|t| *t <= live.time());
    }
    (live, passage)
}

#[test]
fn in_any_pieces_it_is_one_run() {
    for name in SCENES {
        // A half cycle that is mirrored is the same to rounding only.
        let model = preset(name, &["run.recurrence=false"]);
        let duration = model.duration().min(12.0);
        // the last step of a run is cut short, so both are compared before it
        let times: Vec<f64> = every(0.003_7, (duration * 0.9 / 0.003_7) as usize);
        let run = run_at(&model, &times);
        let last = *times.last().unwrap();
        for piece in [0.001_3, 0.016_7, 0.25, 5.0] {
            let (_, passage) = in_pieces(&model, last, piece, &times);
            assert_eq!(passage.samples.len(), times.len(), "{name} {piece}");
            for (sample, one) in passage.samples.iter().zip(&run.samples) {
                assert_eq!(sample, one, "{name} {piece}");
            }
            let events: Vec<_> = run.events.iter().filter(|event| event.t <= last).collect();
            assert_eq!(passage.events.iter().collect::<Vec<_>>(), events, "{name} {piece}");
        }
    }
}

#[test]
fn the_present_lies_on_the_run_and_the_ledger_closes() {
    for name in SCENES {
        let model = preset(name, &[]);
        let mut live = Live::new(&model);
        let mut passage = LiveOutput::default();
        let mut arrived = 0;
        for k in 1..400 {
            let to = 0.011 * f64::from(k);
            if !live.advance(to, &[to], &mut passage) {
                continue;
            }
            arrived += 1;
            let (state, sample) = (live.state(), passage.samples.last().unwrap());
            near(state.x, sample.x, 1e-12 * model.scales().length);
            near(state.v, sample.v, 1e-9 * model.scales().speed);
            let ledger = live.ledger();
            let left =
                ledger.work_j + ledger.by_hand_j - ledger.damping_j - ledger.impact_j - ledger.stored_j;
            let size = model.mass() * model.scales().speed.powi(2);
            near(left, 0.0, 1e-8 * size.max(ledger.impact_j + ledger.damping_j));
            assert_eq!(ledger.by_hand_j, 0.0);
        }
        assert!(arrived > 350, "{name}: {arrived}");
    }
}

/// A live run at `t` s and what it has passed.
fn at(model: &Model, t: f64) -> (Live, LiveOutput) {
    let (mut live, mut passage) = (Live::new(model), LiveOutput::default());
    assert!(live.advance(t, &[], &mut passage));
    (live, passage)
}

fn close(a: &Sample, b: &Sample, model: &Model) {
    near(a.x, b.x, 1e-12 * model.scales().length);
    near(a.v, b.v, 1e-9 * model.scales().speed);
    near(a.base_accel, b.base_accel, 1e-9);
}

#[test]
fn a_change_keeps_the_state_and_the_drives_phase() {
    let model = preset("paper-unconstrained", &[]);
    for t in [0.5, 1.234, 3.0] {
        for change in [
            "excitation.frequency_hz=5.5",
            "damping.xi=0.1",
            "stops=Rigid(travel_limit_mm: 9, restitution: 0.5)",
            "run.tolerance=1e-7",
        ] {
            let (mut live, mut passage) = at(&model, t);
            let before = live.state();
            live.change(&preset("paper-unconstrained", &[change]), &mut passage);
            close(&live.state(), &before, &model);
            assert_eq!(live.ledger().by_hand_j, 0.0);
            assert_eq!(passage.samples.last(), Some(&live.state()));
        }
    }
    // another amplitude: the base's acceleration jumps in proportion, the state does not
    let (mut live, mut passage) = at(&model, 1.234);
    let before = live.state();
    live.change(&preset("paper-unconstrained", &["excitation.amplitude_g=0.5"]), &mut passage);
    near(live.state().base_accel, 0.5 * before.base_accel, 1e-12);
    assert_eq!((live.state().x, live.state().v), (before.x, before.v));
    // and back at once: the run goes on as if nothing had been done, to the tolerance
    live.change(&model, &mut passage);
    live.advance(1.5, &[], &mut passage);
    let (undisturbed, _) = at(&model, 1.5);
    near(live.state().x, undisturbed.state().x, 1e-10);
}

#[test]
fn frequency_there_and_back_keeps_every_phase() {
    let model = preset("paper-unconstrained", &["excitation.phase_deg=30"]);
    let (mut live, mut passage) = at(&model, 0.7);
    live.change(
        &preset("paper-unconstrained", &["excitation.phase_deg=30", "excitation.frequency_hz=4"]),
        &mut passage,
    );
    live.advance(1.2, &[], &mut passage);
    // 0.7 s of 3 Hz and 0.5 s of 4 Hz are 4.1 turns
    let expected = 9.80665 * (std::f64::consts::TAU * (4.1 + 30.0 / 360.0)).sin();
    near(live.state().base_accel, expected, 1e-9);
    live.change(&model, &mut passage);
    near(live.state().base_accel, expected, 1e-9);
    live.advance(1.3, &[], &mut passage);
    let expected = 9.80665 * (std::f64::consts::TAU * (4.4 + 30.0 / 360.0)).sin();
    near(live.state().base_accel, expected, 1e-9);
}

#[test]
fn a_stop_dragged_over_the_mass_carries_it_along() {
    let model = preset("paper-unconstrained", &["excitation.amplitude_g=0.5"]);
    let (mut live, mut passage) = at(&model, 2.0);
    let before = live.state();
    assert!(before.x > 6e-3);
    let stopped = preset("paper", &["excitation.amplitude_g=0.5", "stops.travel_limit_mm=2"]);
    live.change(&stopped, &mut passage);
    let state = live.state();
    assert_eq!((state.x, state.phase), (2e-3, Phase::RightStop));
    assert_eq!(passage.events.last().map(|event| event.kind), Some(EventKind::Rest));
    let potential = |x: f64| model.mechanism().curve.potential(x);
    let kinetic = |v: f64| 0.5 * model.mass() * v * v;
    let given = potential(state.x) + kinetic(state.v) - potential(before.x) - kinetic(before.v);
    near(live.ledger().by_hand_j, given, 1e-12);
    assert!(given > 0.0);
    // shaken harder it is let go, and the change itself is no event while it rests on
    let events = passage.events.len();
    live.change(&stopped, &mut passage);
    assert_eq!(passage.events.len(), events);
    live.change(&preset("paper", &["excitation.amplitude_g=1.2", "stops.travel_limit_mm=2"]), &mut passage);
    live.advance(3.0, &[], &mut passage);
    let later: Vec<_> = passage.events[events..].iter().map(|event| (event.kind, event.side)).collect();
    assert_eq!(later[0], (EventKind::Release, Side::Right));
    assert!(later.contains(&(EventKind::Crossing, Side::Left)));
    // the stops taken away: it leaves where it rested
    let ledger = live.ledger();
    let left = ledger.work_j + ledger.by_hand_j - ledger.damping_j - ledger.impact_j - ledger.stored_j;
    near(left, 0.0, 1e-11);
}

#[test]
fn a_placed_mass_goes_on_from_there() {
    let model = preset("paper", &[]);
    let (mut live, mut passage) = at(&model, 0.4);
    live.place(0.5e-3, 0.0, &mut passage);
    assert_eq!((live.state().x, live.state().v, live.time()), (0.5e-3, 0.0, 0.4));
    live.place(9.0, 1.0, &mut passage);
    assert_eq!((live.state().x, live.state().v), (1.5e-3, 0.0));
    live.place(f64::NAN, 0.0, &mut passage);
    assert_eq!(live.state().x, 1.5e-3);
}

#[test]
fn a_state_without_a_finite_energy_is_no_place() {
    let (mut live, mut passage) = at(&preset("monostable", &["stops=None"]), 0.4);
    let before = live.state();
    for (x, v) in [(1e296, 0.0), (0.0, -1e200), (-1e100, 1.0)] {
        live.place(x, v, &mut passage);
        assert_eq!(live.state(), before);
    }
    live.place(1e3, 0.0, &mut passage);
    assert_eq!(live.state().x, 1e3);
    assert!(live.ledger().by_hand_j.is_finite());
}

#[test]
fn from_here_the_future_is_the_same() {
    for name in ["paper", "paper-unconstrained", "nominal-cubic"] {
        let model = preset(name, &[]);
        let (live, _) = at(&model, 1.2345);
        let future = live.from_here().unwrap();
        let run = future.run(&Request { sample_times: &[0.4], ..Request::default() });
        let (later, _) = at(&model, 1.6345);
        near(run.samples[0].x, later.state().x, 1e-9);
        near(run.samples[0].base_accel, later.state().base_accel, 1e-9);
    }
    assert!(Live::new(&preset("walking", &[])).from_here().is_none());
}

#[test]
fn it_ends_where_the_curve_does() {
    let model = preset("paper-unconstrained", &["start=At(x_mm: 8.2, v_m_per_s: 3)"]);
    let (mut live, mut passage) = (Live::new(&model), LiveOutput::default());
    assert!(!live.advance(1.0, &[0.0001, 0.5], &mut passage));
    let end = live.ended().and_then(|outcome| outcome.ended_at()).unwrap();
    assert_eq!(live.time(), end);
    assert!(live.state().x.is_finite());
    assert!(!live.advance(2.0, &[], &mut passage));
    // a stop inside brings it back
    live.change(&preset("paper", &[]), &mut passage);
    assert!(live.ended().is_none() && live.advance(2.0, &[], &mut passage));
}

#[test]
fn what_was_seen_is_the_path_with_its_corners() {
    let model = preset("paper", &[]);
    let mut watch = Watch::new(&model);
    let mut frames = 0;
    while watch.time() < 2.0 {
        assert!(watch.advance(watch.time() + 0.001_67));
        frames += 1;
    }
    assert!(frames > 1000);
    assert!(watch.samples().iter().zip(watch.samples().iter().skip(1)).all(|(a, b)| a.t <= b.t));
    let times = every(0.000_371, 5000);
    let run = run_at(&model, &times);
    for sample in &run.samples {
        let seen = watch.state_at(sample.t);
        near(seen.x, sample.x, 2e-9);
        near(seen.v, sample.v, 2e-5);
        assert_eq!(seen.phase, sample.phase);
    }
    // from event to event, a chatter being one
    let (mut t, mut count) = (0.0, 0);
    while let Some(event) = watch.neighbour(t, true) {
        assert!(event.t > t);
        (t, count) = (event.t, count + 1);
    }
    assert!((30..=40).contains(&count), "{count}");
    assert!(watch.neighbour(t, false).unwrap().t < t);
}

/// A mass that rests on a stop which is moved outward leaves it from where it rested.
#[test]
fn a_stop_that_is_moved_away_leaves_the_mass_where_it_was() {
    let model = |mm: f64| preset("paper", &[&format!("stops.travel_limit_mm={mm}"), "excitation=None"]);
    let mut watch = Watch::new(&model(2.0));
    watch.advance(0.1);
    assert_eq!(watch.now().x, 2e-3);
    watch.change(&model(6.0));
    watch.advance(0.1001);
    assert!(watch.events().iter().any(|event| event.kind == EventKind::Release));
    assert!(watch.samples().iter().all(|sample| sample.x < 2.1e-3));
    // one that is moved inward takes it along
    watch.change(&model(1.0));
    assert_eq!((watch.now().x, watch.samples().back().unwrap().x), (1e-3, 1e-3));
}

#[test]
fn without_a_barrier_nothing_is_crossed() {
    let (mut with, mut without) = (0, 0);
    for Preset { name, .. } in PRESETS {
        let model = preset(name, &["run.recurrence=false"]);
        let to = model.duration().min(4.0);
        let mut watch = Watch::new(&model);
        while watch.time() < to && watch.ended().is_none() && watch.forgotten_events() == 0 {
            watch.advance((watch.time() + 0.05).min(to));
        }
        let run = model.run(&Request { events: true, ..Request::default() });
        let has_barrier = model.mechanism().landscape.barrier.is_some();
        let crosses = |kind: EventKind| kind == EventKind::Crossing;
        let kept = run.events.iter().filter(|event| has_barrier || !crosses(event.kind));
        let kept: Vec<_> = kept.take_while(|event| event.t < 0.9 * watch.time()).collect();
        let seen: Vec<_> = watch.events().iter().take(kept.len()).collect();
        // steps that end at each frame round otherwise
        let are_alike = seen.len() == kept.len()
            && seen
                .iter()
                .zip(&kept)
                .all(|(a, b)| (a.kind, a.side) == (b.kind, b.side) && (a.t - b.t).abs() < 1e-9 * to);
        assert!(watch.forgotten_events() > 0 || are_alike, "{name}");
        assert!(has_barrier || !watch.events().iter().any(|event| crosses(event.kind)), "{name}");
        *(if has_barrier { &mut with } else { &mut without }) += 1;
    }
    assert!(with > 5 && without > 3, "{with} {without}");
}

/// A circuit whose state is continuous at impacts, where its current or voltage is often largest.
#[test]
fn a_circuit_has_its_state_at_impacts() {
    let drawn = (any::<bool>(), 0.8..2.5f64, 0.1..0.8f64, 1e-3..0.05f64);
    let show = |drawn: &(bool, f64, f64, f64)| format!("{drawn:?}");
    hold_for(
        "a_circuit_has_its_state_at_impacts",
        12,
        0.5,
        drawn,
        show,
        |(coil, amplitude, restitution, piece)| {
            let transducer = match coil {
                true => {
                    "Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 60, inductance_mh: 800)"
                }
                false => "Piezoelectric(coupling_n_per_v: 1e-3, capacitance_nf: 50, load_kohm: 200)",
            };
            let changes = [
                format!("transducer={transducer}"),
                format!("excitation.amplitude_g={amplitude}"),
                format!("stops.restitution={restitution}"),
            ];
            let model = preset("harvester", &changes.each_ref().map(String::as_str));
            let mut watch = Watch::new(&model);
            while watch.time() < 2.0 {
                watch.advance(watch.time() + piece);
            }
            let run = model.run(&Request { events: true, ..Request::default() });
            let impacts = run.events.iter().filter(|event| event.kind == EventKind::Impact && event.t < 1.9);
            let times: Vec<f64> = impacts.map(|event| event.t).collect();
            // a nanosecond before and after each
            let near: Vec<f64> = times.iter().flat_map(|t| [t - 1e-9, t + 1e-9]).collect();
            let mut sorted = near.clone();
            sorted.sort_by(f64::total_cmp);
            sorted.dedup();
            let beside = run_at(&model, &sorted).samples;
            let largest = beside.iter().map(|sample| sample.electrical.abs()).fold(0.0, f64::max);
            let at = |t: f64| beside[beside.partition_point(|sample| sample.t < t)].electrical;
            for (t, pair) in times.iter().zip(near.chunks(2)) {
                let seen = watch.samples().iter().filter(|sample| sample.t == *t);
                for sample in seen {
                    let apart =
                        (sample.electrical - at(pair[0])).abs().max((sample.electrical - at(pair[1])).abs());
                    prop_assert!(apart < 1e-5 * largest, "{} at {t} s: {apart:e}", sample.electrical);
                }
                prop_assert!(watch.samples().iter().any(|sample| sample.t == *t), "no sample at {t} s");
            }
            prop_assert!(watch.samples().iter().all(|sample| sample.electrical.is_finite()));
            Ok(!times.is_empty())
        },
    );
}
