//! Basins of attraction: borders, attractors and mirror images that are known, the same answer for any batch.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Arrival, EventKind, MapState, Model, Outcome, Pursued, Pursuit, Request};
use interwell::scene::{Document, Files};
use interwell::system::threads::Pool;
use interwell_studies::study::*;

use super::support::*;

mod sure;

fn range((from, to, count): (f64, f64, u64)) -> EvenRange {
    EvenRange { from, to, count }
}

fn refused(document: &Document, x_mm: (f64, f64, u64), v: (f64, f64, u64)) -> Result<BasinMap, NoBasins> {
    let starts = Starts::grid(&range(x_mm), &range(v)).unwrap();
    BasinMap::new(&document.scene, mechanism(document), starts)
}

/// The whole map of a document, checked.
fn map(document: &Document, x_mm: (f64, f64, u64), v: (f64, f64, u64)) -> (BasinMap, Answer) {
    let mut basins = refused(document, x_mm, v).unwrap().checked();
    let answer = whole(&mut basins);
    (basins, answer)
}

fn whole(basins: &mut BasinMap) -> Answer {
    whole_on(basins, 2)
}

/// The whole map by so many threads.
fn whole_on(basins: &mut BasinMap, threads: usize) -> Answer {
    let cancel = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &cancel };
    let pool = Pool::new(threads).unwrap();
    while !basins.is_whole() {
        assert!(basins.run_level(&pool, &task));
    }
    basins.answer(&task).unwrap()
}

/// The unit double well, m = 1, F = x^3 - x, with the other fields in `rest`.
fn well(rest: &str) -> Document {
    let text = format!(
        "(title: \"test\", mass_g: 1000, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), {rest})"
    );
    Document::from_text("test", &text, Files::default()).unwrap()
}

/// The states of the attractor of a row.
fn attractor(answer: &Answer, row: usize) -> &Attractor {
    &answer.attractors[answer.rows[row].unwrap().0 as usize - 1]
}

/// Starts beside the stable manifold of the saddle, faster or slower by a share, go to different wells.
#[test]
fn the_border_without_a_drive_is_the_stable_manifold_of_the_saddle() {
    let c = 0.1_f64;
    let document = well("damping: Coefficient(c_n_s_per_m: 0.1), run: (duration_s: 10, tolerance: 1e-13)");
    // v = l x + b x^3 + O(x^5): l the rate of decay, b from the equation of motion along the manifold
    let decay = -0.5 * c - (0.25 * c * c + 1.0).sqrt();
    let border = |x: f64| decay * x - x * x * x / (4.0 * decay + c);
    for x_mm in [1.0, -1.0] {
        for share in [1e-6, 1e-10] {
            let v = border(x_mm / 1e3).abs();
            let sign = -f64::signum(x_mm);
            let ends = [sign * v * (1.0 - share), sign * v * (1.0 + share)];
            let [under, over] = ends.map(|v| map(&document, (x_mm, x_mm, 1), (v, v, 1)).1);
            // too slow to pass the top, and fast enough
            near(attractor(&under, 0).states[0].0, f64::signum(x_mm), 1e-9);
            near(attractor(&over, 0).states[0].0, -f64::signum(x_mm), 1e-9);
        }
    }
}

#[test]
fn below_the_barrier_no_start_leaves_its_well_and_the_saddle_attracts_none() {
    let document = well("damping: Coefficient(c_n_s_per_m: 0.02), run: (duration_s: 10)");
    let (basins, answer) = map(&document, (-1500.0, 1500.0, 21), (-0.8, 0.8, 17));
    assert_eq!((answer.attractors.len(), answer.outside, answer.lost), (2, 0, 0));
    for attractor in &answer.attractors {
        assert_eq!((attractor.regime.name(), attractor.period), ("rest", None));
        near(attractor.states[0].0.abs(), 1.0, 1e-9);
        near(attractor.states[0].1, 0.0, 1e-9);
    }
    let mut below = 0;
    for row in 0..basins.starts().count() {
        let (x_mm, v) = basins.starts().at(row);
        let x = x_mm / 1e3;
        let energy = 0.5 * v * v + 0.25 * x.powi(4) - 0.5 * x * x;
        if energy < 0.0 {
            below += 1;
            near(attractor(&answer, row).states[0].0, x.signum(), 1e-9);
        }
    }
    assert!(below > 80, "{below}");
    // the start at rest on the top
    let top = (0..basins.starts().count()).find(|row| basins.starts().at(*row) == (0.0, 0.0)).unwrap();
    assert_eq!((answer.rows[top], answer.undecided), (None, 1));
}

#[test]
fn a_linear_oscillator_has_one_basin_and_its_response_is_the_attractor() {
    let text = "(title: \"test\", mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 4]),
        damping: Coefficient(c_n_s_per_m: 0.4),
        excitation: Sine(frequency_hz: 0.25, amplitude_g: 0.1, phase_deg: 30),
        run: (duration_s: 10, tolerance: 1e-12))";
    let document = Document::from_text("test", text, Files::default()).unwrap();
    let (_, answer) = map(&document, (-500.0, 500.0, 6), (-2.0, 2.0, 6));
    let [only] = answer.attractors.as_slice() else { panic!("{:?}", answer.attractors) };
    assert_eq!((only.starts, only.period, only.regime.name()), (36, Some(1), ""));
    assert_eq!((only.share.share, only.share.high), (1.0, 1.0));
    // x'' + 0.4 x' + 4 x = -a sin(w t + 30 degrees)
    let (a, w, phase) = (0.980665, std::f64::consts::FRAC_PI_2, 30_f64.to_radians());
    let (real, imaginary) = (4.0 - w * w, 0.4 * w);
    let (size, lag) = (a / real.hypot(imaginary), imaginary.atan2(real));
    near(only.states[0].0, -size * (phase - lag).sin(), 1e-10);
    near(only.states[0].1, -size * w * (phase - lag).cos(), 1e-10);
    near(only.rms_velocity.unwrap(), size * w / 2_f64.sqrt(), 1e-10);
}

#[test]
fn the_basins_half_a_period_later_are_the_mirror_image() {
    let drive = "damping: Coefficient(c_n_s_per_m: 0.3), run: (duration_s: 10), \
        excitation: Sine(frequency_hz: 0.19, amplitude_g: 0.0255, phase_deg:";
    let [now, later] = ["40)", "220)"]
        .map(|end| map(&well(&format!("{drive} {end}")), (-1500.0, 1500.0, 16), (-1.0, 1.0, 16)));
    assert!(now.1.attractors.len() >= 2, "{:?}", now.1.attractors);
    assert_eq!(now.1.attractors.len(), later.1.attractors.len());
    let count = now.0.starts().count();
    for row in 0..count {
        let mirrored = count - 1 - row;
        assert_eq!(now.0.starts().at(row).0, -later.0.starts().at(mirrored).0);
        let (here, there) = (attractor(&now.1, row), attractor(&later.1, mirrored));
        assert_eq!((here.period, here.states.len()), (there.period, there.states.len()));
        let same = |a: &(f64, f64), b: &(f64, f64)| (a.0 + b.0).abs().max((a.1 + b.1).abs()) < 1e-7;
        assert!(here.states.iter().all(|state| there.states.iter().any(|other| same(state, other))));
        assert_eq!(now.1.rows[row].unwrap().1, later.1.rows[mirrored].unwrap().1);
    }
}

#[test]
fn each_start_goes_where_a_run_of_its_own_goes() {
    for amplitude in ["0.0255", "0.0377"] {
        let document = well(&format!(
            "damping: Coefficient(c_n_s_per_m: 0.3), run: (duration_s: 10), \
             excitation: Sine(frequency_hz: 0.19, amplitude_g: {amplitude})"
        ));
        let (basins, answer) = map(&document, (-1600.0, 1600.0, 12), (-1.2, 1.2, 12));
        assert_eq!(answer.undecided, 0);
        let period = basins.model().forcing_period().unwrap();
        for row in (0..144).step_by(3) {
            let (x_mm, v) = basins.starts().at(row);
            let model = basins.model().with_start((x_mm / 1e3, v));
            let end = model.with_duration(300.0 * period, 0.0).run(&Request::default()).summary;
            let reached = attractor(&answer, row);
            let distance = |state: &(f64, f64)| (state.0 - end.final_x).hypot(state.1 - end.final_v);
            let least = reached.states.iter().map(distance).fold(f64::INFINITY, f64::min);
            assert!(least < 1e-6, "{amplitude} {row}: {least:e}");
        }
    }
}

/// After the first rest all motions are one: their states once a period have the same bits.
#[test]
fn with_stops_every_start_gives_the_same_states_to_the_last_bit() {
    let document = changed("paper", &["stops.travel_limit_mm=1.5", "excitation.amplitude_g=1"]);
    let (basins, answer) = map(&document, (-1.5, 1.5, 13), (-0.5, 0.5, 11));
    let [only] = answer.attractors.as_slice() else { panic!("{:?}", answer.attractors) };
    assert_eq!((only.starts, only.period, only.regime.name()), (143, Some(1), "interwell"));
    let period = basins.model().forcing_period().unwrap();
    let times: Vec<f64> = (4..24).map(|cycle| f64::from(cycle) * period).collect();
    let states = |row: usize| {
        let (x_mm, v) = basins.starts().at(row);
        let model = basins.model().with_start((x_mm / 1e3, v)).with_recurrence(false);
        let run = model
            .with_duration(25.0 * period, 0.0)
            .run(&Request { sample_times: &times, ..Request::default() });
        run.samples.iter().map(|sample| (sample.x.to_bits(), sample.v.to_bits())).collect::<Vec<_>>()
    };
    let first = states(0);
    assert_eq!(first.len(), times.len());
    for row in (0..143).step_by(7) {
        assert!(answer.rows[row].unwrap().1 <= 4);
        assert_eq!(states(row), first, "{row}");
    }
}

#[test]
fn a_mass_that_nothing_frees_rests_on_the_stop_that_it_falls_to() {
    for drive in ["excitation=None", "excitation.amplitude_g=0", "excitation.amplitude_g=0.2"] {
        let document = changed("paper", &[drive]);
        let (basins, answer) = map(&document, (-1.5, 1.5, 8), (0.0, 0.0, 1));
        assert_eq!(answer.attractors.len(), 2, "{drive}");
        for row in 0..8 {
            let x = basins.starts().at(row).0;
            let reached = attractor(&answer, row);
            assert_eq!(
                (reached.regime.name(), reached.states.as_slice()),
                ("rest", &[(1.5e-3 * x.signum(), 0.0)][..])
            );
        }
    }
}

/// At 1 g without stops the strobes of both intrawell motions lie near a kink of the force.
#[test]
fn a_motion_that_passes_a_kink_is_known_by_an_ellipse() {
    let document = Document::load("paper-unconstrained").unwrap();
    let (_, answer) = map(&document, (-8.0, 8.0, 9), (-0.6, 0.6, 7));
    let longest = answer.rows.iter().flatten().map(|start| start.1).max();
    assert!(answer.undecided == 0 && longest < Some(300), "{longest:?} {}", answer.undecided);
    assert!(answer.attractors.iter().all(|attractor| attractor.period == Some(1)), "{:?}", answer.attractors);
    let sides = answer.attractors.iter().filter(|attractor| attractor.regime.name() == "intrawell").count();
    assert_eq!(sides, 2);
}

/// Chaos in the double well (Holmes 1979): one irregular attractor, into whose region every start comes.
#[test]
fn an_irregular_attractor_is_one() {
    let document = changed("duffing-chaos", &[]);
    let (_, answer) = map(&document, (-1500.0, 1500.0, 13), (-1.0, 1.0, 13));
    let [only] = answer.attractors.as_slice() else { panic!("{:?}", answer.attractors) };
    assert_eq!((only.regime.name(), only.period, only.starts), ("irregular", None, 169));
    // it is entered, and nobody waits for a verdict
    assert!(answer.rows.iter().flatten().all(|start| start.1 < 60), "{:?}", answer.rows);
}

#[test]
fn a_pursuit_has_the_same_bits_in_any_number_of_lanes() {
    for model in [preset("paper", &[]), preset("paper-unconstrained", &[]), preset("duffing", &[])] {
        let (x, v) = (model.scales().length, model.scales().speed);
        let limit = model.stop_positions().1.unwrap_or(x);
        let pursuits: Vec<Pursuit> = (0..40)
            .map(|number| Pursuit {
                start: (limit * (f64::from(number) / 20.0 - 1.0), v * f64::from(number % 7 - 3) / 7.0).into(),
                known: &[],
                regions: &[],
                repeats_from: 0,
                max_periods: 60,
                releases: number as u32 % 3,
                max_work: u64::MAX,
                beside: None,
            })
            .collect();
        let texts = |all: Vec<Pursued>| {
            let bare = |mut pursued: Pursued| {
                if let Arrival::Unsettled(end) = &mut pursued.arrival {
                    end.cpu_s = 0.0;
                }
                format!("{pursued:?}")
            };
            all.into_iter().map(bare).collect::<Vec<_>>()
        };
        let alone = texts(model.pursue_in_lanes(&pursuits, 1).unwrap());
        for width in [4, 8, 16] {
            if let Some(found) = model.pursue_in_lanes(&pursuits, width) {
                assert_eq!(texts(found), alone, "{width}");
            }
        }
        let released = alone.iter().any(|text| text.contains("Released"));
        assert_eq!(released, model.stop_positions().1.is_some());
    }
}

/// Rebounds that are passed over do not change where a mass is released, nor when.
#[test]
fn a_pursuit_comes_to_the_first_release_of_the_run() {
    for (amplitude, restitution) in [(1.14, 0.36), (1.5, 0.7)] {
        let amplitude = format!("excitation.amplitude_g={amplitude}");
        let restitution = format!("stops.restitution={restitution}");
        let model = preset("paper", &[&amplitude, &restitution]).with_recurrence(false);
        let period = model.forcing_period().unwrap();
        let mut released = 0;
        for number in 0..60_u32 {
            let start = (1.5e-3 * (f64::from(number) / 30.0 - 1.0), f64::from(number % 11) / 10.0 - 0.5);
            let (known, regions, repeats_from, releases) = (&[], &[], u64::MAX, number % 2);
            let (start, max_work, beside) = (MapState::from(start), u64::MAX, None);
            let max_periods = 60;
            let pursuit =
                Pursuit { start, known, regions, repeats_from, max_periods, releases, max_work, beside };
            let run = model.with_start(start).with_duration(10.0 * period, 0.0);
            let events = run.run(&Request { events: true, ..Request::default() }).events;
            let release =
                events.iter().filter(|event| event.kind == EventKind::Release).nth(releases as usize);
            let Pursued { arrival, periods, .. } = &model.pursue_in_lanes(&[pursuit], 1).unwrap()[0];
            if let (Some(release), Arrival::Released(identity)) = (release, arrival) {
                assert_eq!(identity.side, release.side, "{number}");
                assert_eq!(*periods, Some((release.t / period).ceil() as u64), "{number}");
                released += 1;
            }
        }
        assert!(released > 50, "{released}");
    }
}

#[test]
fn a_pursuit_ends_where_its_work_is_done() {
    let model = preset("paper-unconstrained", &[]);
    let pursuit = Pursuit {
        start: (1e-3, 0.1).into(),
        known: &[],
        regions: &[],
        repeats_from: u64::MAX,
        max_periods: 1000,
        releases: 0,
        max_work: 1_000_000,
        beside: None,
    };
    for width in [1, 4, 8, 16] {
        for pursued in model.pursue_in_lanes(&[pursuit; 20], width).unwrap_or_default() {
            let Arrival::Unsettled(end) = &pursued.arrival else { panic!("{:?}", pursued.arrival) };
            assert!(matches!(end.outcome, Outcome::StepBudget { .. }), "{:?}", end.outcome);
            // between two looks at the budget lie some 10 000 units
            assert!((1_000_000..1_030_000).contains(&pursued.work), "{}", pursued.work);
        }
    }
}

#[test]
fn levels_come_coarse_first_and_end_in_the_same_map() {
    let document = changed("duffing", &[]);
    let (_, answer) = map(&document, (-1500.0, 1500.0, 17), (-1.0, 1.0, 9));
    let mut basins = refused(&document, (-1500.0, 1500.0, 17), (-1.0, 1.0, 9)).unwrap();
    let cancel = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &cancel };
    let pool = Pool::new(3).unwrap();
    let mut known = Vec::new();
    while !basins.is_whole() {
        assert!(basins.run_level(&pool, &task));
        let partial = basins.answer(&task).unwrap();
        known.push(partial.rows.iter().flatten().count());
    }
    assert_eq!(known, [3 * 2, 5 * 3, 9 * 5, 17 * 9]);
    assert_eq!(basins.answer(&task).unwrap(), Answer { sure: Vec::new(), ..answer });
    cancel.store(true, std::sync::atomic::Ordering::Relaxed);
    let mut told = refused(&document, (-1500.0, 1500.0, 17), (-1.0, 1.0, 9)).unwrap();
    assert!(!told.run_level(&pool, &task));
}

#[test]
fn scenes_without_basins_say_why() {
    let wrong = |name: &str, changes: &[&str], x_mm: (f64, f64, u64)| {
        refused(&changed(name, changes), x_mm, (0.0, 0.0, 1)).unwrap_err()
    };
    let small = (-1.0, 1.0, 3);
    assert_eq!(wrong("paper-ramp", &[], small), NoBasins::NoPeriod);
    assert_eq!(wrong("random-shaking", &[], small), NoBasins::NoPeriod);
    assert_eq!(wrong("paper", &["damping=None", "stops.restitution=1"], small), NoBasins::NoLoss);
    let beyond = wrong("paper", &[], (2.0, 3.0, 3));
    assert!(matches!(beyond, NoBasins::Beyond { what: "the right stop", at_mm, .. } if at_mm == 1.5));
    let beyond = wrong("paper-unconstrained", &[], (-500.0, -400.0, 3));
    assert!(matches!(beyond, NoBasins::Beyond { what: "the end of the force curve", .. }));
}

/// The shared mechanism is not copied for each start.
#[test]
fn a_model_with_another_start_is_the_same_otherwise() {
    let model: Model = preset("paper", &[]);
    let other = model.with_start((1e-3, 0.1));
    assert_eq!((other.start(), other.scales()), ((1e-3, 0.1), model.scales()));
    assert!(Arc::ptr_eq(other.mechanism(), model.mechanism()));
}

/// The piezoelectric double well of Erturk, Hoffmann and Inman (2009): every start goes to the attractor to
/// which its own run comes, and a state of the circuit at the start decides too.
#[test]
fn basins_beside_a_circuit_are_those_of_single_runs() {
    let period = TAU / 0.8;
    let scene = |electrical: f64| {
        let text = format!(
            "(title: \"test\", mass_g: 1000, mechanism: Cubic(linear_n_per_m: -0.5, cubic_n_per_m3: 0.5), \
             damping: Coefficient(c_n_s_per_m: 0.02), \
             transducer: Piezoelectric(coupling_n_per_v: 0.05, capacitance_nf: 1e8, load_kohm: 0.2), \
             excitation: Sine(frequency_hz: {}, amplitude_g: {}, phase_deg: -90), \
             start: At(x_mm: 0, v_m_per_s: 0, electrical: {electrical}), run: (duration_s: 100))",
            0.8 / TAU,
            0.05 / 9.80665,
        );
        Document::from_text("test", &text, Files::default()).unwrap()
    };
    let mut rows = Vec::new();
    for electrical in [0.0, 3.0] {
        let document = scene(electrical);
        let starts = Starts::random((-1500.0, 1500.0), (-1.0, 1.0), 30, 5).unwrap();
        let mut basins = BasinMap::new(&document.scene, mechanism(&document), starts).unwrap();
        let answer = whole(&mut basins);
        assert!(answer.attractors.len() >= 2, "{:?}", answer.words());
        for (row, found) in answer.rows.iter().enumerate() {
            let (x_mm, v) = basins.starts().at(row);
            let start = MapState { x: x_mm / 1e3, v, electrical };
            let model = basins.model().with_start(start).with_duration(700.0 * period, 600.0 * period);
            let summary = model.run(&Request::default()).summary;
            let Some((number, _)) = found else { continue };
            let attractor = &answer.attractors[*number as usize - 1];
            if summary.period.is_none() || attractor.period.is_none() {
                continue;
            }
            assert_eq!(
                (attractor.regime, attractor.period, attractor.side),
                (summary.regime, summary.period, summary.side),
                "{row}"
            );
            near_relative(attractor.rms_velocity.unwrap(), summary.rms_velocity.unwrap(), 5e-3);
        }
        assert!(answer.rows.iter().flatten().count() >= 25, "{:?}", answer.rows);
        rows.push(answer.rows);
    }
    assert_ne!(rows[0], rows[1], "a charged layer changes where some starts go");
}
