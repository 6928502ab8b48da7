//! A measured motion over a computed one: the shift that is found, the numbers, and the command.

use std::sync::atomic::AtomicBool;

use interwell::dynamics::{EventKind, Model};
use interwell::scene::{Channel, Document, Files, Quantity};
use interwell_studies::study::{Comparison, Keep, MeasuredMotion, NoComparison, compare, simulate};
use proptest::prelude::*;

use super::Noise;
use crate::cli::{headless, refused};
use crate::properties::harness::hold_for;
use crate::support::{build, of_kind, run_at};

fn model(changes: &[&str]) -> (Document, Model) {
    let mut document = Document::load("paper").unwrap();
    for change in [&["run.duration_s=3", "run.settle_s=1"], changes].concat() {
        document.set(change).unwrap();
    }
    let mechanism =
        interwell::mechanics::Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    let model = Model::build(&document.scene, mechanism.into()).unwrap();
    (document, model)
}

/// Displacement of a run with these changes from `from` s on, every 0.5 ms, with noise in m.
fn record(changes: &[&str], from: f64, noise: f64) -> (Vec<f64>, Channel) {
    let times: Vec<f64> = (0..3000).map(|i| from + f64::from(i) * 5e-4).collect();
    let keep = Keep { times: times.clone(), events: false, until_settled: None };
    let run = simulate(&model(changes).1, &keep, None);
    let mut random = Noise::new(5);
    let values = run.samples.numbers("x_m").unwrap().iter().map(|x| x + noise * random.next()).collect();
    (times, Channel { quantity: Quantity::Displacement, column: "x_m".into(), values })
}

fn over_paper(times: &[f64], channel: &Channel, scale: f64, shift: Option<f64>) -> Comparison {
    let (document, model) = model(&[]);
    let motion = MeasuredMotion { times, channel, offset: 0.0, time_scale: scale, shift };
    compare(&document.scene, &model, &motion, &AtomicBool::new(false)).unwrap()
}

/// Compares displacements in m with a run.
fn with_displacements(
    (document, model): &(Document, Model),
    times: &[f64],
    values: Vec<f64>,
    shift: f64,
) -> Comparison {
    let channel = Channel { quantity: Quantity::Displacement, column: "x_m".into(), values };
    let motion =
        MeasuredMotion { times, channel: &channel, offset: 0.0, time_scale: 1.0, shift: Some(shift) };
    compare(&document.scene, model, &motion, &AtomicBool::new(false)).unwrap()
}

fn row(found: &Comparison, quantity: &str) -> [f64; 4] {
    let words = match &found.table.column("quantity").unwrap().values {
        interwell_studies::study::Values::Words(words) => words.clone(),
        _ => Vec::new(),
    };
    let at = words.iter().position(|word| *word == quantity).unwrap();
    ["measured", "computed", "difference", "difference_percent"]
        .map(|name| found.table.numbers(name).unwrap()[at])
}

#[test]
fn a_record_of_the_run_itself_lies_on_it_and_its_shift_is_found() {
    let (times, channel) = record(&[], 0.4, 0.0);
    let same = over_paper(&times, &channel, 1.0, Some(0.0));
    assert_eq!((same.rms.0, same.times.len()), (0.0, 3000));
    // a clock in other units that began elsewhere
    let clock: Vec<f64> = times.iter().map(|t| 1e3 * (t - 0.37)).collect();
    let found = over_paper(&clock, &channel, 1e-3, None);
    let periods = (found.shift - 0.37) * 3.0;
    assert!((periods - periods.round()).abs() < 1e-6, "{}", found.shift);
    assert!(found.rms.1 < 0.05, "{:?}", found.rms);
}

#[test]
fn the_numbers_are_those_of_the_difference() {
    let (times, mut channel) = record(&[], 0.0, 0.0);
    channel.values.iter_mut().for_each(|x| *x += 1e-5);
    let found = over_paper(&times, &channel, 1.0, Some(0.0));
    assert!((found.rms.0 - 1e-5).abs() < 1e-15, "{:?}", found.rms);
    assert!((row(&found, "mean")[2] + 1e-5).abs() < 1e-15);
    assert!((row(&found, "maximum")[2] + 1e-5).abs() < 1e-15);
    // a restitution of 0.42 goes back some (0.42/0.36)^2 times as far as one of 0.36
    let (times, channel) = record(&["stops.restitution=0.42"], 0.0, 1e-6);
    let found = over_paper(&times, &channel, 1.0, Some(0.0));
    for side in ["left", "right"] {
        let [measured, computed, ..] = row(&found, &format!("rebounds_{side}"));
        assert!(measured == computed && measured >= 4.0, "{side}: {measured} {computed}");
        let percent = row(&found, &format!("rebound_height_{side}"))[3];
        assert!((-36.0..-22.0).contains(&percent), "{side}: {percent}");
    }
    let [measured, computed, ..] = row(&found, "first_crossing");
    assert!(measured > 0.0 && (measured - computed).abs() < 1e-3, "{measured} {computed}");
}

#[test]
fn of_two_barriers_the_first_crossing_is_at_that_of_the_run() {
    // wells at -1.7, 0 and 1.7 mm, barriers at -1.05 and 1.05 mm
    let times: Vec<f64> = (0..2000).map(|i| f64::from(i) * 1e-4).collect();
    let crossed = [1.0, -1.0].map(|sign| {
        let text = format!(
            "(title: \"three wells\", mass_g: 15.2, \
             mechanism: Polynomial(coefficients_si: [0, 320, 0, -4e8, 0, 1e14]), \
             start: At(x_mm: {}, v_m_per_s: {}), run: (duration_s: 0.2))",
            1.75 * sign,
            -0.15 * sign
        );
        let document = Document::from_text("three wells", &text, Files::default()).unwrap();
        let model = build(&document);
        let run = run_at(&model, &times);
        let values = run.samples.iter().map(|sample| sample.x).collect();
        let found = with_displacements(&(document, model), &times, values, 0.0);
        let [measured, computed, ..] = row(&found, "first_crossing");
        let event = of_kind(&run, EventKind::Crossing)[0].t;
        assert!((measured - event).abs() <= 1e-4 && measured == computed, "{measured} {computed} {event}");
        measured
    });
    assert_eq!(crossed[0], crossed[1]);
}

#[test]
fn the_zero_of_the_sensor_can_be_another() {
    let (times, mut channel) = record(&[], 0.4, 0.0);
    channel.values.iter_mut().for_each(|x| *x += 0.0352);
    let (document, model) = model(&[]);
    let motion =
        MeasuredMotion { times: &times, channel: &channel, offset: -0.0352, time_scale: 1.0, shift: None };
    let found = compare(&document.scene, &model, &motion, &AtomicBool::new(false)).unwrap();
    // the digits of 0.0352 m; the motion repeats, so that whole periods fit as well
    let periods = 3.0 * found.shift;
    assert!(found.rms.0 < 1e-12, "{:?}", found.rms);
    assert!((periods - periods.round()).abs() < 1e-9, "{periods}");
}

#[test]
fn a_record_apart_from_the_run_is_refused() {
    let (times, channel) = record(&[], 0.0, 0.0);
    let (document, model) = model(&[]);
    let motion =
        MeasuredMotion { times: &times, channel: &channel, offset: 0.0, time_scale: 1.0, shift: Some(10.0) };
    let found = compare(&document.scene, &model, &motion, &AtomicBool::new(false));
    assert!(matches!(found, Err(NoComparison::Apart { samples: 0, .. })));
}

#[test]
fn the_commands_say_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("r.csv");
    std::fs::write(&file, "t_s,x_mm\n0,1.5\n0.5,nan\n1,1.5\n").unwrap();
    let line = |line: &str| {
        let mut command = headless(line);
        command.arg(&file);
        command
    };
    refused(line("simulate paper --out /dev/null --measured"), &["r.csv: line 3", "x_mm", "`nan`"]);
    refused(line("identify --of damping"), &["r.csv: line 3", "x_mm", "`nan`"]);
}

#[test]
fn a_last_sample_at_the_end_of_the_run_is_within_it() {
    // a tenth seven times over is a rounding more than 0.7
    let mut times = vec![0.0];
    (0..7).for_each(|k| times.push(times[k] + 0.1));
    let counted: Vec<f64> = (0..8).map(|k| f64::from(k) * 0.1).collect();
    for (times, shift) in
        [(times, 0.0), (counted.clone(), 0.0), (counted.iter().map(|t| t + 0.3).collect(), -0.3)]
    {
        let scene = model(&["run.duration_s=0.7", "run.settle_s=0"]);
        let found = with_displacements(&scene, &times, vec![0.0; times.len()], shift);
        assert_eq!(found.times.len(), 8, "{:?}", found.remarks);
        assert!(!found.remarks.iter().any(|remark| remark.contains("outside")), "{:?}", found.remarks);
    }
}

/// A difference in percent of 0 is not known: of records of zeros, constants and single values, at any size.
#[test]
fn no_percent_is_infinite() {
    let value = prop_oneof![Just(0.0), Just(-0.0), Just(5e-324), Just(1e-300), -1e-3..1e-3_f64];
    let drawn = (value.clone(), value, 2..40_usize, 0..4_usize);
    let (document, model) = model(&[]);
    let check = |(value, other, length, quantity): &(f64, f64, usize, usize)| {
        let times: Vec<f64> = (0..*length).map(|i| 0.05 * i as f64).collect();
        let values =
            times.iter().enumerate().map(|(i, _)| if i == length / 2 { *other } else { *value }).collect();
        let quantities = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];
        let quantity = quantities[quantity % quantities.len()];
        let channel = Channel { quantity, column: "x".into(), values };
        let shift = Some(0.0);
        let motion = MeasuredMotion { times: &times, channel: &channel, offset: 0.0, time_scale: 1.0, shift };
        let found = compare(&document.scene, &model, &motion, &AtomicBool::new(false)).unwrap();
        let table = &found.table;
        let percents = table.numbers("difference_percent").unwrap();
        prop_assert!(percents.iter().all(|percent| !percent.is_infinite()), "{percents:?}");
        prop_assert!(!found.rms.1.is_infinite());
        for (measured, percent) in table.numbers("measured").unwrap().iter().zip(percents) {
            prop_assert!(*measured != 0.0 || percent.is_nan(), "{percent} of 0");
        }
        prop_assert!(!interwell_studies::output::csv(table).contains("inf"));
        Ok((*value, *other) == (0.0, 0.0))
    };
    hold_for("percents", 200, 0.05, drawn, |drawn| format!("{drawn:?}"), check);
}
