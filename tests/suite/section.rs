//! Sections and walks: against closed forms, against the run's own samples, mirrored, and in batches.

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{MapState, Model, Request, STANDARD_GRAVITY, SectionPoint};
use interwell::scene::{Document, Files};
use interwell::system::threads::Pool;
use interwell_studies::study::*;

use crate::support::{model, near, near_relative, preset, same_bits};

/// A mass of 1 kg on a spring of 40 N/m with a cubic part in N/m^3, shaken by 0.5 g at 1.25 Hz.
fn spring(cubic: f64, rest: &str) -> String {
    format!(
        "title: \"t\", mass_g: 1000, mechanism: Cubic(linear_n_per_m: 40, cubic_n_per_m3: {cubic:?}), \
         damping: Coefficient(c_n_s_per_m: 1.5), {rest}"
    )
}

fn document(text: &str) -> Document {
    Document::from_text("test", &format!("({text})"), Files::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn states(model: &Model, turns: f64) -> Vec<SectionPoint> {
    model.run(&Request { section: Some(turns), ..Request::default() }).section
}

/// All rows of a walk or of none.
fn rows(document: &Document, over: &[&str], options: SweepOptions) -> Table {
    let grid = Grid::new(document.axes(over).unwrap()).unwrap();
    let sweep = Sweep::new(&document.scene, &document.files, grid).with(options);
    let cancel = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &cancel };
    let pool = Pool::new(2).unwrap();
    sweep.validate(&pool, &task).unwrap();
    let mut rows = Table::new();
    let write = |table: &Table| {
        rows.append(table);
        Ok::<_, ()>(true)
    };
    let tally = sweep.run(&pool, &task, write).unwrap();
    assert_eq!(tally.cells, sweep.rows());
    rows
}

fn both() -> SweepOptions {
    let columns = ["final_x_m", "final_v_m_per_s"].map(|name| SummaryField::find(name).unwrap()).to_vec();
    SweepOptions { columns, carry: Some(Carry::Both), ..SweepOptions::default() }
}

#[test]
fn the_section_of_a_linear_oscillator_is_its_steady_response_at_that_phase() {
    let (m, k, c, f, amplitude) = (1.0, 40.0, 1.5, 1.25, 0.5 * STANDARD_GRAVITY);
    let w = TAU * f;
    // m x'' + c x' + k x = -m A sin(theta): x = |X| sin(theta + arg X), X = -m A/(k - m w^2 + i c w)
    let (re, im) = (k - m * w * w, c * w);
    let size = m * amplitude / re.hypot(im);
    let turn = std::f64::consts::PI - im.atan2(re);
    for (start, degrees) in
        [(0.0, 0.0), (0.0, 37.5), (25.0, 25.0), (25.0, 300.0), (200.0, 180.0), (90.0, 0.0)]
    {
        let model = model(
            &spring(
                0.0,
                &format!(
                    "excitation: Sine(frequency_hz: 1.25, amplitude_g: 0.5, phase_deg: {start:?}), \
             run: (duration_s: 60, settle_s: 40.1, tolerance: 1e-12)"
                ),
            )
            .replace("title: \"t\", ", ""),
        );
        let points = states(&model, degrees / 360.0);
        assert_eq!(points.len(), 24, "19.9 s hold 24 periods of 0.8 s");
        let theta: f64 = degrees / 360.0 * TAU;
        for (i, point) in points.iter().enumerate() {
            near(point.x, size * (theta + turn).sin(), 1e-11 * size);
            near(point.v, w * size * (theta + turn).cos(), 1e-11 * w * size);
            // 2 pi f t + start = the phase asked for
            let turns = point.t * f + start / 360.0 - degrees / 360.0;
            near(turns, turns.round(), 1e-12);
            assert!(point.t >= 40.1 && point.t < 60.0);
            near(point.t - points[0].t, 0.8 * i as f64, 1e-12);
        }
    }
}

#[test]
fn a_section_is_the_runs_own_samples() {
    for (name, changes) in [
        ("paper", &["run.recurrence=true"][..]),
        ("paper", &["run.recurrence=false"]),
        ("paper", &["excitation.amplitude_g=0.58", "run.settle_s=3.1"]),
        ("elastic-box", &["run.duration_s=6", "excitation=Sine(frequency_hz:3,amplitude_g:1)"]),
        ("paper", &["stops=Hertz(travel_limit_mm:1.5,stiffness_n_per_m1_5:3.7e9,loss_s_per_m:10)"]),
        ("paper-unconstrained", &[]),
    ] {
        let model = preset(name, changes);
        let points = states(&model, 0.3);
        let periods = (model.duration() - model.settle()) * 3.0;
        assert_eq!(points.len(), (periods + 1e-9) as usize, "{name} {changes:?}");
        let times: Vec<f64> = points.iter().map(|point| point.t).collect();
        let run = model.run(&Request { sample_times: &times, ..Request::default() });
        let scales = model.scales();
        for (point, sample) in points.iter().zip(&run.samples) {
            near(point.x, sample.x, 1e-12 * scales.length);
            near(point.v, sample.v, 1e-11 * scales.speed);
        }
        assert_eq!(run.samples.len(), points.len());
    }
}

#[test]
fn a_motion_that_rests_has_the_same_state_once_a_period_to_the_last_bit() {
    // pressed on the stop at phase 0, and in flight at 60 degrees
    for turns in [0.0, 60.0 / 360.0, 0.75] {
        let points = states(&preset("paper", &["run.duration_s=1000", "run.settle_s=10"]), turns);
        assert_eq!(points.len(), 2970);
        assert!(points.iter().all(|point| (point.x, point.v) == (points[0].x, points[0].v)), "{turns}");
    }
}

#[test]
fn sections_half_a_period_apart_mirror_each_other() {
    for (stops, frequency, x) in [("None", 6.0, 2.0), ("Rigid(travel_limit_mm:2,restitution:0.6)", 3.0, 1.0)]
    {
        let at = |phase: f64, x: f64| {
            let set = [
                format!("stops={stops}"),
                format!("excitation=Sine(frequency_hz:{frequency},amplitude_g:1.9,phase_deg:{phase})"),
                format!("start=At(x_mm:{x},v_m_per_s:0)"),
                "run.duration_s=20".to_owned(),
                "run.settle_s=0".to_owned(),
            ];
            preset("nominal-cubic", &set.each_ref().map(String::as_str))
        };
        let (plain, mirrored) = (states(&at(0.0, x), 0.0), states(&at(180.0, -x), 0.5));
        assert_eq!(plain.len() as f64, 20.0 * frequency);
        assert!(at(0.0, x).run(&Request::default()).summary.total_crossings > 4, "{stops}");
        for (a, b) in plain.iter().zip(&mirrored) {
            assert_eq!((a.t, a.x, a.v), (b.t, -b.x, -b.v), "{stops}");
        }
    }
}

#[test]
fn a_batch_has_the_sections_and_carried_states_of_its_runs() {
    let mut models = Vec::new();
    for amplitude in ["0", "0.4", "0.7", "1", "1.3", "1.9"] {
        let set = format!("excitation.amplitude_g={amplitude}");
        for stops in ["stops=None", "stops.travel_limit_mm=1.5", "stops.travel_limit_mm=4"] {
            models.push(preset("paper", &[stops, &set, "run.duration_s=9.9", "run.settle_s=3.1"]));
        }
    }
    let request = Request { section: Some(0.4), carry: true, ..Request::default() };
    for until_settled in [None, Some(40.0)] {
        let request = Request { until_settled, ..request };
        for (model, together) in models.iter().zip(Model::run_together(&models, &request)) {
            let alone = model.run(&request);
            same_bits(&together, &alone);
            assert_eq!(alone.section.len(), 20, "6.8 s hold 20 periods");
            let (from, to) = alone.summary.window;
            assert!(alone.section.iter().all(|point| point.t >= from && point.t < to));
            // What is listed changes nothing.
            let plain = model.run(&Request { until_settled, ..Request::default() });
            assert_eq!(
                (plain.summary.steps, plain.summary.final_x),
                (alone.summary.steps, alone.summary.final_x)
            );
            let t = (alone.summary.window.1.max(model.duration()) * 3.0 + 1e-9).floor() / 3.0;
            let until = Request { sample_times: &[t], until_settled, ..Request::default() };
            if let Some(sample) = model.run(&until).samples.first() {
                let MapState { x, v, .. } = alone.carried.unwrap();
                near(x, sample.x, 1e-11 * model.scales().length);
                near(v, sample.v, 1e-10 * model.scales().speed);
            }
        }
    }
}

#[test]
fn a_walk_is_one_motion() {
    // 9.9 s hold 29 periods; the next cell goes on from there.
    let set = ["run.duration_s=9.9", "run.settle_s=3"];
    for (limit, amplitude) in [("1.5", "1"), ("1.5", "0.6"), ("4", "0.9")] {
        let changes = [&format!("stops.travel_limit_mm={limit}")[..], set[0], set[1]];
        let over = format!("excitation.amplitude_g={amplitude},{amplitude}");
        let options = SweepOptions { carry: Some(Carry::Up), ..both() };
        let walked = rows(&crate::support::changed("paper", &changes), &[&over], options);
        let amplitude = format!("excitation.amplitude_g={amplitude}");
        let long = preset("paper", &[changes[0], &amplitude, "run.duration_s=60"]);
        let run = long.run(&Request { sample_times: &[9.9, 29.0 / 3.0 + 9.9], ..Request::default() });
        for (i, sample) in run.samples.iter().enumerate() {
            let scales = long.scales();
            near(walked.numbers("final_x_m").unwrap()[i], sample.x, 1e-9 * scales.length);
            near(walked.numbers("final_v_m_per_s").unwrap()[i], sample.v, 1e-8 * scales.speed);
        }
    }
}

#[test]
fn where_the_motion_is_unique_both_ways_are_that_from_rest() {
    let scene = document(&spring(
        0.0,
        "excitation: Sine(frequency_hz: 1.25, amplitude_g: 0.5), run: (duration_s: 60, settle_s: 40, \
         tolerance: 1e-11)",
    ));
    let over = ["mass_g=500,1000", "excitation.frequency_hz=0.6:1.4:0.1"];
    let walked = rows(&scene, &over, both());
    let rest = rows(&scene, &over, SweepOptions::default());
    let Values::Words(ways) = &walked.column(DIRECTION).unwrap().values else { panic!() };
    assert_eq!(ways[..9], ["up"; 9]);
    assert_eq!(ways[9..18], ["down"; 9]);
    for name in ["rms_velocity_m_per_s", "max_abs_x_m"] {
        let (walked, rest) = (walked.numbers(name).unwrap(), rest.numbers(name).unwrap());
        for row in 0..9 {
            for mass in 0..2 {
                near_relative(walked[18 * mass + row], rest[9 * mass + row], 1e-10);
                near_relative(walked[18 * mass + 17 - row], rest[9 * mass + row], 1e-10);
            }
        }
    }
}

#[test]
fn between_its_folds_a_hardening_resonance_keeps_to_the_branch_that_it_came_on() {
    let (m, k, b, c, amplitude) = (1.0, TAU * TAU, 4e4, 0.02 * TAU, 0.001 * STANDARD_GRAVITY);
    let scene = document(&format!(
        "title: \"t\", mass_g: 1000, mechanism: Cubic(linear_n_per_m: {k:?}, cubic_n_per_m3: {b:?}), \
         damping: Coefficient(c_n_s_per_m: {c:?}), excitation: Sine(frequency_hz: 1, amplitude_g: 0.001), \
         run: (duration_s: 400, settle_s: 380)"
    ));
    let walked = rows(&scene, &["excitation.frequency_hz=1:1.08:0.005"], both());
    let f = walked.numbers("frequency_hz").unwrap();
    let reach = walked.numbers("max_abs_x_m").unwrap();
    let mut folded = 0;
    for row in 0..17 {
        let (up, down) = (reach[row], reach[33 - row]);
        assert_eq!(f[row], f[33 - row]);
        // Harmonic balance in one term: ((k - m w^2 + 3/4 b X^2)^2 + (c w)^2) X^2 = (m A)^2.
        let w = TAU * f[row];
        let excess = |x: f64| {
            let stiffness = k - m * w * w + 0.75 * b * x * x;
            (stiffness * stiffness + c * c * w * w) * x * x - m * m * amplitude * amplitude
        };
        let places: Vec<f64> = (0..4000).map(|i| 1e-4 * 300_f64.powf(f64::from(i) / 4000.0)).collect();
        let roots: Vec<f64> = places
            .windows(2)
            .filter(|pair| excess(pair[0]) * excess(pair[1]) <= 0.0)
            .map(|pair| pair[0])
            .collect();
        // The third harmonic is some b X^2/(32 k) = 0.4 % of the first.
        near_relative(up, *roots.last().unwrap(), 0.01);
        near_relative(down, roots[0], 0.01);
        if roots.len() == 3 {
            folded += 1;
            assert!(up > 3.0 * down * 0.8, "{up} {down}");
        } else {
            near_relative(up, down, 1e-7);
        }
    }
    assert_eq!(folded, 4);
}

#[test]
fn a_stop_that_is_moved_over_the_mass_takes_it_along() {
    let at = |limit: &str| preset("paper", &[limit, "excitation.amplitude_g=0.2"]);
    let (wide, narrow) = (at("stops.travel_limit_mm=5"), at("stops.travel_limit_mm=2"));
    assert_eq!(narrow.clone().carried_on(&wide, (4e-3, 0.3)).start(), (2e-3, 0.0));
    assert_eq!(narrow.clone().carried_on(&wide, (-4e-3, 0.3)).start(), (-2e-3, 0.0));
    assert_eq!(narrow.clone().carried_on(&wide, (1e-3, 0.3)).start(), (1e-3, 0.3));
    // beyond the known curve
    let open = at("stops=None");
    let end = open.mechanism().curve.domain().1;
    assert_eq!(open.clone().carried_on(&wide, (1.0, 0.3)).start(), (end, 0.0));
}

#[test]
fn impacts_come_with_the_phase_of_the_drive() {
    let document = crate::support::changed("paper", &["excitation.phase_deg=40", "run.duration_s=12"]);
    let built = crate::shared::build(&document);
    let options = SectionOptions { at: SectionAt::Impacts, periods: None, until_settled: None, carry: None };
    let (table, summary) = section(&built, &document.scene, &options, &AtomicBool::new(false)).unwrap();
    assert_eq!(table.rows() as u64, summary.impacts);
    assert!(summary.impacts > 100);
    let (t, phase) = (table.numbers("t_s").unwrap(), table.numbers("phase_deg").unwrap());
    for (t, phase) in t.iter().zip(phase) {
        assert!((0.0..360.0).contains(phase) && *t >= summary.window.0);
        let turns = (t * 3.0 + 40.0 / 360.0) - phase / 360.0;
        near(turns, turns.round(), 1e-12);
    }
    // The motion repeats once a period, and so do the phases.
    let each = (summary.impacts / summary.periods) as usize;
    for (i, phase_deg) in phase.iter().enumerate().skip(each) {
        near(*phase_deg, phase[i - each], 1e-9);
    }
}
