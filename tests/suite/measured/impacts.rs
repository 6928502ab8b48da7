//! Restitution of shaken records: simulated ones with noise, at several rates, with samples missing.

use std::ops::Range;

use interwell::dynamics::Model;
use interwell::mechanics::Mechanism;
use interwell::scene::Document;
use interwell_studies::study::{Identified, Keep, Unidentified, restitution, simulate};

use super::{Noise, holds, number};
use crate::cli::{headless, refused};

/// Times, displacement and acceleration of the base.
type Recorded = [Vec<f64>; 3];

/// A run of a preset with these changes, a sample every `step` s, with noise in m.
fn recorded(preset: &str, changes: &[String], step: f64, noise: f64, seed: u64) -> Recorded {
    let mut document = Document::load(preset).unwrap();
    changes.iter().for_each(|change| document.set(change).unwrap());
    let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    let model = Model::build(&document.scene, mechanism.into()).unwrap();
    let count = (document.scene.run.duration_s / step) as usize;
    let times: Vec<f64> = (0..count).map(|i| i as f64 * step).collect();
    let run = simulate(&model, &Keep { times: times.clone(), events: false, until_settled: None }, None);
    let column = |name: &str| run.samples.numbers(name).unwrap().to_vec();
    let mut random = Noise::new(seed);
    let x = column("x_m").iter().map(|x| x + noise * random.next()).collect();
    [times, x, column("base_accel_m_per_s2")]
}

fn changes(changes: &[&str]) -> Vec<String> {
    changes.iter().map(|change| (*change).to_owned()).collect()
}

fn identified(record: &Recorded) -> Result<Identified, Unidentified> {
    restitution(&record[0], &record[1], None)
}

/// Numbers drawn at random.
struct Draw(Noise);

impl Draw {
    fn even(&mut self, range: Range<f64>) -> f64 {
        range.start + (range.end - range.start) * self.0.even()
    }

    fn one_in(&mut self, count: f64) -> bool {
        self.even(0.0..count) < 1.0
    }

    fn even_ratio(&mut self, range: Range<f64>) -> f64 {
        self.even(range.start.ln()..range.end.ln()).exp()
    }
}

/// A record that is drawn: its restitutions, and what it is called in the report.
struct Drawn {
    record: Recorded,
    left: Option<f64>,
    right: Option<f64>,
    about: String,
}

/// Rates are those of the prototype, 0.5 to 20 kHz; slower scenes have as many samples a flight. Noise is up
/// to a hundredth of the way to the nearer stop, and none in one record of six.
fn drawn(seed: u64) -> Drawn {
    let mut draw = Draw(Noise::new(seed));
    let left = draw.even(0.2..0.95);
    let right = if draw.one_in(2.5) { draw.even(0.2..0.95) } else { left };
    let rate = draw.even_ratio(500.0..20_000.0);
    let stops = |draw: &mut Draw, range: Range<f64>| {
        let near = draw.even(range.clone());
        [near, if draw.one_in(2.5) { draw.even(range) } else { near }]
    };
    let kind = draw.even(0.0..8.0) as usize;
    let (preset, slower, travel, drive, duration) = match kind {
        0..=2 => {
            let drive = format!(
                "Sine(frequency_hz: {:?}, amplitude_g: {:?})",
                draw.even(2.0..5.0),
                draw.even(0.9..2.0)
            );
            let preset = if kind == 2 { "paper-table" } else { "paper" };
            (preset, 1.0, stops(&mut draw, 0.8..3.0).map(Some), drive, draw.even(3.0..6.0))
        }
        3 => {
            let duration = draw.even(4.0..8.0);
            let [hz, from, to] = [draw.even(2.0..5.0), draw.even(0.0..0.8), draw.even(1.2..2.0)];
            let drive = format!(
                "AmplitudeRamp(frequency_hz: {hz:?}, from_g: {from:?}, to_g: {to:?}, over_s: {duration:?})"
            );
            ("paper", 1.0, stops(&mut draw, 0.8..2.5).map(Some), drive, duration)
        }
        4 => {
            let drive = format!(
                "Sine(frequency_hz: {:?}, amplitude_g: {:?})",
                draw.even(2.0..5.0),
                draw.even(1.2..2.5)
            );
            ("nominal-cubic", 1.0, stops(&mut draw, 2.0..6.0).map(Some), drive, draw.even(3.0..6.0))
        }
        5 => {
            let [hz, g] = [draw.even(0.09..0.18), draw.even(0.056..0.12)];
            let drive = format!("Sine(frequency_hz: {hz:?}, amplitude_g: {g:?})");
            let [near, far] = stops(&mut draw, 300.0..1000.0);
            let travel = [draw.one_in(2.0).then_some(near), Some(far)];
            ("impact-oscillator", 25.0, travel, drive, 8.976 * draw.even(10.0..30.0))
        }
        6 => (
            "bouncing-ball",
            10.0,
            [Some(draw.even(300.0..1500.0)), None],
            "None".to_owned(),
            draw.even(2.0..6.0),
        ),
        _ => ("elastic-box", 10.0, [Some(10.0); 2], "None".to_owned(), draw.even(4.0..10.0)),
    };
    let of_side = |side: &str, mm: Option<f64>, e: f64| {
        mm.map_or(String::new(), |mm| format!("{side}_mm: {mm:?}, restitution_{side}: {e:?}, "))
    };
    let [left_mm, right_mm] = travel;
    let mut scene = vec![
        format!("stops=Uneven({}{})", of_side("left", left_mm, left), of_side("right", right_mm, right)),
        format!("excitation={drive}"),
        format!("run.duration_s={duration:?}"),
        "run.settle_s=0".to_owned(),
    ];
    if preset == "elastic-box" {
        scene.push(format!("start=At(x_mm: 0, v_m_per_s: {:?})", draw.even(0.03..0.1)));
    }
    let nearer = left_mm.into_iter().chain(right_mm).fold(f64::INFINITY, f64::min) * 1e-3;
    let noise = if draw.one_in(6.0) { 0.0 } else { nearer * draw.even_ratio(5e-5..1e-2) };
    let mut record = recorded(preset, &scene, slower / rate, noise, seed + 1_000_000);
    if draw.one_in(4.0) {
        missing(&mut draw, &mut record);
    }
    let clipped = if draw.one_in(4.0) { clip(&mut draw, &mut record[1]) } else { String::new() };
    let noise = noise / nearer;
    let about = format!("{preset} at {rate:.0} Hz, noise {noise:.1e} of the way, seed {seed}{clipped}");
    Drawn { record, left: left_mm.map(|_| left), right: right_mm.map(|_| right), about }
}

/// Cuts the record off at a limit on one side: within the outermost places, about there, or beyond.
fn clip(draw: &mut Draw, x: &mut [f64]) -> String {
    let low = x.iter().copied().fold(f64::INFINITY, f64::min);
    let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let part = if draw.one_in(3.0) { draw.even(0.97..1.01) } else { draw.even(0.6..1.0) };
    let limit = if draw.one_in(2.0) {
        let limit = low + part * (high - low);
        x.iter_mut().for_each(|x| *x = x.min(limit));
        limit
    } else {
        let limit = high - part * (high - low);
        x.iter_mut().for_each(|x| *x = x.max(limit));
        limit
    };
    format!(", clipped at {:.3} mm, {part:.3} of the range", 1e3 * limit)
}

/// Loses some samples here and there, and some in a row.
fn missing(draw: &mut Draw, record: &mut Recorded) {
    let samples = record[0].len();
    let lost = draw.even(0.0..0.05);
    let mut kept: Vec<bool> = (0..samples).map(|_| draw.even(0.0..1.0) > lost).collect();
    for _ in 0..draw.even(1.0..8.0) as usize {
        let from = draw.even(0.0..samples as f64) as usize;
        let length = draw.even_ratio(3.0..0.01 * samples as f64 + 4.0) as usize;
        kept[from..(from + length).min(samples)].fill(false);
    }
    for column in record {
        let mut kept = kept.iter();
        column.retain(|_| *kept.next().unwrap());
    }
}

/// Holds the intervals of all numbers and rows against the truth. Of n intervals that hold with probability
/// 0.95 fewer than 0.95 n - 4 sqrt(0.0475 n) hold once in 30 000 times; the numbers of one record hang
/// together, so that n is that of the records. `INTERWELL_PROPERTY_CASES=15` draws 600.
#[test]
fn the_intervals_of_shaken_records_hold_the_restitution() {
    let times: f64 = std::env::var("INTERWELL_PROPERTY_CASES").map_or(1.0, |times| times.parse().unwrap());
    let (mut records, mut numbers, mut covered, mut rows, mut rows_covered) = (0, 0, 0, 0, 0);
    for seed in 0..(40.0 * times) as u64 {
        let drawn = drawn(seed);
        let Ok(found) = identified(&drawn.record) else { continue };
        records += 1;
        let truth = |side: &str| match side {
            "left" => drawn.left.unwrap_or_else(|| panic!("no left stop: {}", drawn.about)),
            _ => drawn.right.unwrap_or_else(|| panic!("no right stop: {}", drawn.about)),
        };
        let interwell_studies::study::Values::Words(sides) = &found.rows.column("side").unwrap().values
        else {
            panic!()
        };
        let [low, high] =
            ["restitution_low", "restitution_high"].map(|name| found.rows.numbers(name).unwrap());
        for (k, side) in sides.iter().enumerate() {
            rows += 1;
            rows_covered += usize::from((low[k]..=high[k]).contains(&truth(side)));
        }
        for found in &found.summary {
            let exact = match found.name {
                "restitution_left" => truth("left"),
                "restitution_right" => truth("right"),
                "restitution" if drawn.left == drawn.right || sides.iter().all(|side| *side == sides[0]) => {
                    truth(sides[0])
                }
                _ => continue,
            };
            numbers += 1;
            covered += usize::from(holds(*found, exact));
            if !holds(*found, exact) {
                println!("{} {exact}: {}; {}", found.name, found.describe(), drawn.about);
            }
        }
    }
    println!("{records} records, {covered} of {numbers} numbers and {rows_covered} of {rows} rows hold");
    let least = 0.95 - 4.0 * (0.0475 / records as f64).sqrt();
    assert!(records as f64 > 0.85 * 40.0 * times, "{records} records have an answer");
    let share = covered as f64 / numbers as f64;
    assert!(share > least, "{share} of {numbers} intervals hold");
    // an impact alone has an interval that is a little wide
    let share = rows_covered as f64 / rows as f64;
    assert!(share > 0.93, "{share} of {rows} rows hold");
}

#[test]
fn one_impact_a_period_of_an_oscillator_gives_its_restitution() {
    for step in [0.01, 0.001] {
        let changes = changes(&["run.duration_s=400", "run.settle_s=0"]);
        let found = identified(&recorded("impact-oscillator", &changes, step, 0.0, 1)).unwrap();
        let e = number(&found, "restitution");
        assert!(holds(e, 0.8) && (e.value - 0.8).abs() < 1e-4, "{step}: {}", e.describe());
        assert!(number(&found, "impacts_used").value > 20.0, "{:?}", found.remarks);
        assert!((number(&found, "right_stop_m").value - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_stop_that_is_not_reached_has_no_impacts() {
    let ramp = "excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0.66, to_g: 0.8, over_s: 21)";
    let changes = changes(&[ramp, "stops.restitution=0.33", "run.duration_s=21", "run.settle_s=0"]);
    let found = identified(&recorded("paper", &changes, 1e-3, 5e-6, 2)).unwrap();
    let e = number(&found, "restitution");
    assert!(holds(e, 0.33) && (e.value - 0.33).abs() < 0.02, "{}", e.describe());
}

#[test]
fn clean_records_of_the_prototype_give_its_restitution_at_all_rates() {
    for rate in [500.0, 1e3, 2e3, 5e3, 1e4, 2e4] {
        let changes = changes(&["run.duration_s=5", "run.settle_s=0"]);
        let found = identified(&recorded("paper", &changes, 1.0 / rate, 0.0, 1)).unwrap();
        for name in ["restitution", "restitution_left", "restitution_right"] {
            let e = number(&found, name);
            assert!(holds(e, 0.36) && (e.value - 0.36).abs() < 0.01, "{rate}: {}", e.describe());
        }
        let remarks = found.remarks.clone();
        // the fastest impacts are those that cross: one at the end of each half period
        let fastest = found.rows.numbers("v_in_m_per_s").unwrap().iter().filter(|v| v.abs() > 0.2).count();
        assert!(fastest >= 28, "{rate}: {fastest}");
        let [found, used, left] =
            ["found", "used", "left_out"].map(|of| number(&found, ["impacts", of].join("_").as_str()).value);
        assert!(used >= 28.0 && found == used + left, "{found} {used} {left}");
        // the mass rests on the stops, without noise at one value
        assert!(!said(&remarks, "clipped"), "{rate}: {remarks:?}");
    }
}

#[test]
fn a_ball_that_comes_to_rest_is_not_cut_off() {
    for rate in [500.0, 1e3, 2e3, 1e4] {
        let found = identified(&recorded("bouncing-ball", &[], 1.0 / rate, 0.0, 1)).unwrap();
        assert!(holds(number(&found, "restitution"), 0.8), "{rate}: {:?}", found.summary);
        assert!(!said(&found.remarks, "clipped"), "{rate}: {:?}", found.remarks);
    }
}

fn said(remarks: &[String], begin: &str) -> bool {
    remarks.iter().any(|text| text.starts_with(begin))
}

#[test]
fn impacts_within_flat_tops_are_left_out_and_said() {
    for (rate, noise, digits) in [(1e3, 0.0, 0.0), (5e3, 0.0, 1e6), (5e3, 4e-6, 0.0), (2e4, 1e-5, 1e6)] {
        let changes = changes(&["run.duration_s=5", "run.settle_s=0"]);
        let mut record = recorded("paper", &changes, 1.0 / rate, noise, 3);
        if digits > 0.0 {
            record[1].iter_mut().for_each(|x| *x = (*x * digits).round() / digits);
        }
        let about = format!("{rate} Hz, noise {noise}, digits {digits}");
        assert!(!said(&identified(&record).unwrap().remarks, "clipped"), "{about}");
        record[1].iter_mut().for_each(|x| *x = x.min(1.2e-3));
        let found = identified(&record).unwrap();
        assert!(holds(number(&found, "restitution"), 0.36), "{about}: {:?}", found.summary);
        let remarks = &found.remarks;
        assert!(
            said(remarks, "clipped: ") && remarks.iter().any(|text| text.contains("at 1.2 mm")),
            "{remarks:?}"
        );
        let names: Vec<&str> = found.summary.iter().map(|number| number.name).collect();
        assert!(names.contains(&"left_stop_m") && !names.contains(&"right_stop_m"), "{about}: {names:?}");
        record[1].iter_mut().for_each(|x| *x = x.max(-1.2e-3));
        let none = identified(&record).unwrap_err();
        assert!(matches!(none, Unidentified::CutOff { .. }), "{about}: {none}");
        assert!(none.to_string().contains("-1.2 and 1.2 mm"), "{none}");
    }
}

#[test]
fn a_cut_is_seen_wherever_the_samples_next_to_it_lie() {
    let changes = changes(&["run.duration_s=0.7", "run.settle_s=0"]);
    let record = recorded("paper", &changes, 3e-4, 2e-7, 5);
    for k in 0..40 {
        // few swings, each with its own part of a step between the limit and the next sample
        let limit = 2e-4 + 2.7e-5 * f64::from(k);
        let mut record = record.clone();
        record[1].iter_mut().for_each(|x| *x = x.min(limit));
        let found = identified(&record).unwrap();
        assert!(said(&found.remarks, "clipped: "), "{limit}: {:?}", found.remarks);
        assert!(holds(number(&found, "restitution"), 0.36), "{limit}: {:?}", found.summary);
    }
}

#[test]
fn the_acceleration_of_the_base_makes_flights_smoother() {
    let shaking =
        "Sum([Sine(frequency_hz: 3, amplitude_g: 1.2), Noise(rms_g: 2, low_hz: 20, high_hz: 200, seed: 3)])";
    let stops = "stops=Rigid(travel_limit_mm: 3, restitution: 0.6)";
    let changes = changes(&[stops, &format!("excitation={shaking}"), "run.duration_s=20", "run.settle_s=0"]);
    let record = recorded("random-shaking", &changes, 5e-4, 2e-6, 1);
    let half = |base: Option<&[f64]>| {
        let found = restitution(&record[0], &record[1], base).unwrap();
        let e = number(&found, "restitution");
        assert!((e.value - 0.6).abs() < 0.02, "{}", e.describe());
        0.5 * (e.interval.1 - e.interval.0)
    };
    assert!(half(Some(&record[2])) < 0.3 * half(None));
}

#[test]
fn what_cannot_be_identified_says_why_and_at_which_rate_it_could() {
    let all = changes(&["run.duration_s=5", "run.settle_s=0"]);
    let slow = identified(&recorded("paper", &all, 5e-3, 0.0, 1)).unwrap_err();
    let Unidentified::Slow { longest, .. } = &slow else { panic!("{slow}") };
    assert!(*longest < 8, "{slow}");
    assert!(slow.to_string().contains("samples a second or more"), "{slow}");
    let still = identified(&[vec![0.0, 0.1, 0.2], vec![0.0; 3], Vec::new()]).unwrap_err();
    assert!(matches!(still, Unidentified::NoImpact { .. }), "{still}");
    // impacts that are no passive ones: each rebound is faster
    let grows = |t: f64| (t - t.floor()) * (1.0 - t + t.floor()) * (1.0 + t.floor());
    let times: Vec<f64> = (0..6000).map(|i| 0.5 + f64::from(i) * 1e-3).collect();
    let x = times.iter().map(|t| grows(*t)).collect();
    let found = identified(&[times, x, Vec::new()]).unwrap();
    assert!(number(&found, "restitution").value > 1.0);
    assert!(found.remarks.iter().any(|text| text.contains("above 1")), "{:?}", found.remarks);
}

#[test]
fn the_base_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("r.csv");
    std::fs::write(&file, "t_s,x_mm\n0,1.5\n0.5,1.2\n1,1.5\n").unwrap();
    let mut command = headless("identify --of restitution --base accel_g");
    command.arg(&file);
    refused(command, &["accel_g", "t_s, x_mm"]);
}
