//! Runs in which contact, flight and drive act together.

use interwell::dynamics::{Live, LiveOutput, Phase, Request};

use super::*;
use crate::live::in_pieces;

#[test]
fn the_prototype_crosses_and_its_ledger_closes_at_every_tolerance() {
    for (tolerance, bound) in [(1e-3, 1e-3), (1e-6, 1e-6), (1e-9, 1e-9), (1e-12, 1e-11)] {
        let run = run(&prototype(&[&format!("run.tolerance={tolerance}")]));
        let ledger = run.summary.ledger.unwrap();
        near(ledger.energy_residual, 0.0, bound);
        assert_eq!((run.summary.crossings, run.summary.period), (30, Some(1)), "{tolerance}");
        assert!(ledger.impact_j > 0.8 * ledger.work_j);
        assert_eq!((run.summary.rests, run.summary.releases, run.summary.chatter_sums), (0, 0, 0));
    }
}

#[test]
fn contact_and_separate_alternate_and_no_speed_is_gained() {
    let run = run(&prototype(&[]));
    let mut inside: Option<interwell::dynamics::Event> = None;
    for event in run.events.iter().filter(|event| event.kind != EventKind::Crossing) {
        assert_eq!(event.v_in, event.v_out);
        match event.kind {
            EventKind::Contact => {
                assert!(inside.is_none(), "{event:?}");
                inside = Some(*event);
            }
            EventKind::Separate => {
                let touch = inside.take().unwrap();
                assert_eq!(touch.side, event.side);
                assert!(touch.v_in * event.v_out <= 0.0 && event.t > touch.t);
                // the mechanism gives next to nothing over a fast contact
                assert!(
                    event.v_out.abs() < touch.v_in.abs() || touch.v_in.abs() < 1e-3,
                    "{touch:?} {event:?}"
                );
            }
            kind => panic!("{kind:?}"),
        }
    }
    let struck = of_kind(&run, EventKind::Contact).len() as u64;
    assert_eq!(run.summary.total_impacts, struck - 1, "the start on the stop is no impact");
}

#[test]
fn fast_rebounds_are_those_of_one_contact_alone() {
    // Other forces are a thousandth of the contact's.
    let model = prototype(&[]);
    let run = run(&model);
    let stop = model.compliant().unwrap();
    let mut seen = 0;
    for pair in
        run.events.windows(2).filter(|pair| pair[0].kind == EventKind::Contact && pair[0].v_in.abs() > 0.1)
    {
        near_relative(pair[1].v_out.abs(), stop.restitution(pair[0].v_in.abs()) * pair[0].v_in.abs(), 2e-2);
        near_relative(pair[1].t - pair[0].t, stop.contact_time(model.mass(), pair[0].v_in.abs()), 2e-2);
        seen += 1;
    }
    assert!(seen > 30, "{seen}");
    let fastest =
        of_kind(&run, EventKind::Contact).iter().map(|contact| contact.v_in.abs()).fold(0.0, f64::max);
    near_relative(run.summary.peak_contact_force.unwrap(), stop.peak_force(model.mass(), fastest), 1e-2);
}

#[test]
fn a_drive_as_fast_as_the_contact_acts_in_it() {
    // 5 kHz: half a period within the contact. All terms of the drive are composed then.
    let drive = "excitation=Sine(frequency_hz: 5000, amplitude_g: 2000, phase_deg: 30)";
    let changes = [
        drive,
        "start=At(x_mm: 1.49, v_m_per_s: 1)",
        "run.duration_s=0.003",
        "run.settle_s=0",
        "run.tolerance=1e-11",
    ];
    let model = prototype(&changes);
    let run = run(&model);
    assert!(!of_kind(&run, EventKind::Separate).is_empty());
    let exact = model.run_reference(&Request { events: true, ..Request::default() }, 1e-22);
    assert_eq!(run.events.len(), exact.events.len());
    for (event, exact) in run.events.iter().zip(&exact.events) {
        near(event.t, exact.t, 1e-9 * model.scales().time);
        near(event.v_in, exact.v_in, 1e-8 * model.scales().speed);
    }
    near(run.summary.ledger.unwrap().energy_residual, 0.0, 1e-9);
}

#[test]
fn ramps_records_and_noise_act_in_contact_too() {
    for drive in [
        "excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 1.5)",
        "excitation=Sum([Sine(frequency_hz: 3, amplitude_g: 1), Constant(accel_g: 0.1)])",
        "excitation=Noise(rms_g: 1, low_hz: 1, high_hz: 300, seed: 4, lines: 16)",
        "excitation=Chirp(from_hz: 1, to_hz: 400, over_s: 1.5, amplitude_g: 2)",
    ] {
        let run = run(&prototype(&[drive, "run.duration_s=2", "run.settle_s=1"]));
        assert!(run.summary.total_impacts > 3, "{drive}");
        near(run.summary.ledger.unwrap().energy_residual, 0.0, 1e-8);
    }
}

#[test]
fn the_mirrored_drive_gives_the_mirrored_run() {
    let start = |x: f64, v: f64| format!("start=At(x_mm: {x}, v_m_per_s: {v})");
    let plain = run(&prototype(&["run.duration_s=2", "run.settle_s=1", &start(1.2, 0.3)]));
    let mirrored = run(&prototype(&[
        "run.duration_s=2",
        "run.settle_s=1",
        "excitation.amplitude_g=-1",
        &start(-1.2, -0.3),
    ]));
    assert_eq!(
        (plain.summary.final_x, plain.summary.final_v),
        (-mirrored.summary.final_x, -mirrored.summary.final_v)
    );
    assert_eq!(plain.summary.peak_contact_force, mirrored.summary.peak_contact_force);
    assert_eq!(plain.events.len(), mirrored.events.len());
    for (a, b) in plain.events.iter().zip(&mirrored.events) {
        assert_eq!((a.t, a.kind, a.v_in), (b.t, b.kind, -b.v_in));
        assert_ne!(a.side, b.side);
    }
}

#[test]
fn a_ledger_changes_no_bit_of_the_figures() {
    // A stop so soft that a contact of few steps is a third of the settled window: were the ends of such a
    // step found from its time, the RMS velocity would lose digits.
    let model = model(
        "mass_g: 0.06641919462496394,
         mechanism: DoubleWell(equilibrium_mm: 1381.5120503848032, barrier_mj: 2.729717496550561e-12),
         stops: Hertz(travel_limit_mm: 201.71433695973425, stiffness_n_per_m1_5: 1.9284030356417082e-11,
                      loss_s_per_m: 0),
         start: At(x_mm: -153.8636633087083, v_m_per_s: 2.00680017323481e-5),
         run: (duration_s: 293098.37332753465, tolerance: 1e-4)",
    );
    let (bare, full) = (model.run(&Request::default()).summary, run(&model).summary);
    assert!(full.rested_share.unwrap() > 0.3);
    assert_eq!(bare.rms_velocity, full.rms_velocity);
    assert_eq!((bare.max_abs_x, bare.travel()), (full.max_abs_x, full.travel()));
}

#[test]
fn live_it_is_the_same_run_in_any_pieces() {
    let model = prototype(&[]);
    // samples in flight and within contacts
    let mut times = every(0.003_7, 800);
    let events = run(&model).events;
    times.extend(
        events
            .windows(2)
            .take(200)
            .filter(|pair| pair[0].kind == EventKind::Contact)
            .map(|pair| pair[0].t + 0.3 * (pair[1].t - pair[0].t)),
    );
    times.sort_by(f64::total_cmp);
    let last = *times.last().unwrap();
    let run = run_at(&model, &times);
    assert!(run.samples.iter().filter(|sample| sample.phase != Phase::Free).count() > 50);
    for piece in [0.000_13, 0.016_7, 0.25, 5.0] {
        let (live, passage) = in_pieces(&model, last, piece, &times);
        assert_eq!(passage.samples.len(), times.len());
        for (sample, one) in passage.samples.iter().zip(&run.samples) {
            assert_eq!(sample, one, "{piece}");
        }
        let events: Vec<_> = run.events.iter().filter(|event| event.t <= last).collect();
        assert_eq!(passage.events.iter().collect::<Vec<_>>(), events, "{piece}");
        assert!(live.ledger().energy_residual() < 1e-8, "{:?}", live.ledger());
    }
}

#[test]
fn stops_are_changed_under_a_live_motion() {
    let model = prototype(&[]);
    let mut live = Live::new(&model);
    let mut passage = LiveOutput::default();
    live.advance(0.01, &[], &mut passage);
    assert_eq!(live.state().phase, Phase::RightStop);
    let depth = live.state().x - 1.5e-3;
    assert!(depth > 0.0);
    // the stop moves over the mass and stays pressed in; no event, and the energy is by hand
    live.change(&prototype(&["stops.travel_limit_mm=1.2"]), &mut passage);
    near_relative(live.state().x - 1.2e-3, depth, 1e-9);
    assert_eq!(passage.events.len(), 1, "{:?}", passage.events);
    // a rigid stop in its place: out of contact, and at rest on it
    live.change(&preset("paper", &["stops.travel_limit_mm=1.2"]), &mut passage);
    assert_eq!((live.state().x, live.state().phase), (1.2e-3, Phase::RightStop));
    let kinds: Vec<_> = passage.events[1..].iter().map(|event| event.kind).collect();
    assert_eq!(kinds, [EventKind::Separate, EventKind::Rest]);
    // and back: it touches the compliant one at its surface
    live.change(&prototype(&["stops.travel_limit_mm=1.2"]), &mut passage);
    assert_eq!(live.state().phase, Phase::RightStop);
    live.advance(0.5, &[], &mut passage);
    let ledger = live.ledger();
    assert!(ledger.energy_residual() < 1e-8, "{ledger:?}");
    assert!(passage.events.iter().any(|event| event.kind == EventKind::Crossing));
    // a mass that is put beyond a stop is put at its surface
    live.place(5e-3, 0.0, &mut passage);
    assert_eq!(live.state().x, 1.2e-3);
}
