//! Scenes with one well, in numbers of 1, or with exact answers.

use interwell::dynamics::{EventKind, Regime, STANDARD_GRAVITY};

use super::super::support::*;
use super::*;

/// Drive of the unit well as base motion in g, and as the notes have it.
fn drive(amplitude: f64) -> (String, String) {
    let in_g = amplitude / STANDARD_GRAVITY;
    (format!("excitation.amplitude_g={in_g:?}"), format!("{in_g:.6} g"))
}

pub fn nominal_cubic(text: &mut Text) {
    let model = preset("nominal-cubic", &[]);
    let well = model.mechanism().landscape.right_stable().unwrap().x;
    text.says(&format!("Its wells lie at {:.0} mm", 1e3 * well));
    let run = run(&model);
    crosses(&run.summary);
    assert_eq!(run.summary.releases, 2 * run.summary.periods);
    let faster = of_kind(&run, EventKind::Impact).iter().filter(|event| event.v_in.abs() > 1e-6).count();
    text.says(&format!("some {faster} of them above 1 um/s in ten seconds"));
    let axes = changed("nominal-cubic", &[]).scene.sweep;
    let counts: Vec<String> =
        axes.iter().map(|axis| (((axis.to - axis.from) / axis.step).round() + 1.0).to_string()).collect();
    text.says(&format!("{} travel limits by {} amplitudes", counts[0], counts[1]));
    text.says(&format!("{} x {} cells", counts[0], counts[1]));
}

pub fn monostable(text: &mut Text) {
    let summary = settled("monostable", &[]);
    text.says(&format!("At 1 g and 3 Hz it swings to {:.1} mm on both sides", reach(&summary)));
    text.says(&format!("of {:.0} mm/s", rms(&summary)));
    let stops = "stops=Rigid(travel_limit_mm: 1.5, restitution: 0.36)";
    let summary = settled("monostable", &[stops]);
    let share = 100.0 * summary.impact_share.unwrap();
    text.says(&format!(
        "a restitution of 0.36 it is {:.0} mm/s, and impacts take {share:.0} % of the work",
        rms(&summary)
    ));
    text.says("With stops at 1.5 mm");
    let swing =
        |frequency: f64| reach(&settled("monostable", &[&format!("excitation.frequency_hz={frequency}")]));
    let swings: Vec<f64> = (8..=56).map(|quarters| swing(0.25 * f64::from(quarters))).collect();
    let (most, less) = (swing(12.75), swing(13.0));
    assert!(swings.iter().all(|swing| *swing <= most));
    text.says(&format!("the swing is largest, {most:.1} mm, at 12.75 Hz and {less:.1} mm at 13 Hz"));
}

pub fn bouncing_ball(text: &mut Text) {
    let times = |changes: &[&str]| {
        let run = run(&preset("bouncing-ball", changes));
        let first = |kind| of_kind(&run, kind).first().unwrap().t;
        (first(EventKind::Impact), first(EventKind::Rest))
    };
    let (lands, rests) = times(&[]);
    text.says("keeps 80 % of the speed, so every flight takes 80 % of the time");
    let run = run(&preset("bouncing-ball", &[]));
    let impacts = of_kind(&run, EventKind::Impact);
    near_relative(impacts[0].v_out / impacts[0].v_in, -0.8, 1e-12);
    near_relative((impacts[2].t - impacts[1].t) / (impacts[1].t - impacts[0].t), 0.8, 1e-12);
    text.says(&format!(
        "first lands after {lands:.4} s and lies still after {rests:.4} s, nine times as long"
    ));
    near_relative(rests / lands, 9.0, 1e-9);
    let (lands, rests) = times(&["stops.restitution_left=0.5"]);
    near_relative(rests / lands, 3.0, 1e-9);
    text.says(&format!("With a restitution of 0.5 it rests after three times the fall, {rests:.4} s"));
}

pub fn elastic_box(text: &mut Text) {
    let elastic = run(&preset("elastic-box", &[]));
    let impacts = of_kind(&elastic, EventKind::Impact);
    let lap = impacts[1].t - impacts[0].t;
    text.says(&format!(
        "crosses the {:.0} mm between them in {lap:.1} s",
        1e3 * elastic.summary.travel().unwrap()
    ));
    text.says(&format!(
        "the first wall after {:.1} s, {} impacts in ten seconds",
        impacts[0].t,
        impacts.len()
    ));
    near(elastic.summary.ledger.unwrap().stored_j, 0.0, 1e-15);
    let lossy = run(&preset("elastic-box", &["stops.restitution=0.9"])).events[0];
    let share = 100.0 * (1.0 - lossy.v_out.powi(2) / lossy.v_in.powi(2));
    text.says(&format!("of 0.9 each impact takes {share:.0} % of the energy"));
}

pub fn duffing(text: &mut Text) {
    for (amplitude, period) in [(0.2, 1), (0.28, 2), (0.29, 4), (0.37, 5), (0.65, 2)] {
        let (change, in_g) = drive(amplitude);
        let summary = settled("duffing", &[&change]);
        assert_eq!((summary.period, summary.settled), (Some(period), Some(true)), "{amplitude}");
        assert_eq!(summary.crossings > 0, amplitude > 0.3, "{amplitude}");
        let set = if amplitude == 0.37 { ", as set here" } else { "" };
        text.says(&format!("{amplitude:.2} ({in_g}{set}): after {period}"));
    }
    let summary = settled("duffing", &[]);
    assert_eq!(5 * summary.crossings, 2 * summary.periods);
    text.says("over and back once in 5 periods");
    let (change, in_g) = drive(0.5);
    let summary = settled("duffing", &[&change]);
    assert_eq!((summary.regime, summary.period), (Regime::Irregular, None));
    text.says(&format!("0.50 ({in_g}): no period is found"));
    text.says("1, 2, 4, 5, chaos, 2");
    text.says("Started from x = 1 m");
}

pub fn duffing_chaos(text: &mut Text) {
    // Over a hundred runs the RMS velocity was 0.507 to 0.529 m/s, the crossings were 620 to 666, in 585 to
    // 624 of 900 periods, the reach 1.535 to 1.536 m.
    let mut finals = Vec::new();
    for change in ["start.x_mm=1000", "start.x_mm=1000.000001", "start.x_mm=900", "start.x_mm=1100"] {
        let summary = settled("duffing-chaos", &[change]);
        assert_eq!((summary.regime, summary.period, summary.impacts), (Regime::Irregular, None, 0));
        near_relative(summary.rms_velocity.unwrap(), 0.52, 0.03);
        near(summary.crossings as f64 / summary.periods as f64, 0.71, 0.05);
        near(summary.crossing_periods as f64 / summary.periods as f64, 2.0 / 3.0, 0.03);
        near(summary.max_abs_x.unwrap(), 1.54, 0.01);
        text.says("the reach 1.54 m");
        finals.push((summary.final_x, summary.final_v));
    }
    assert_ne!(finals[0], finals[1]);
    text.says("driven with A = 0.50");
    near_relative(0.5 / STANDARD_GRAVITY, 0.050985810648896415, 1e-12);
    text.says("in about two thirds of the periods, about 7 times in 10");
    text.says("from starts between 0.9 and 1.1 m the RMS velocity");
    text.says("is 0.52 m/s within 3 %");
    let period = std::f64::consts::TAU / 1.2;
    text.says(&format!("at t = 0, {period:.3}, {:.3} s", 2.0 * period));
    // A millionth of a millimetre
    let path = |start: &str| {
        let model = preset("duffing-chaos", &[start, "run.duration_s=600"]);
        run_at(&model, &every(period, 60)).samples
    };
    let (a, b) = (path("start.x_mm=1000"), path("start.x_mm=1000.000001"));
    let apart: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (a.x - b.x).abs()).collect();
    assert!(apart[..13].iter().all(|apart| *apart < 0.01), "{apart:?}");
    assert!(apart[13..30].iter().any(|apart| *apart > 0.1), "{apart:?}");
    text.says("both runs go together for some 15 periods");
}

pub fn period_adding(text: &mut Text) {
    let at = |amplitude: f64, more: &[&str]| {
        let change = drive(amplitude).0;
        settled("period-adding", &[&[change.as_str()], more].concat())
    };
    // the smooth orbit reaches the stop between these
    assert_eq!(at(0.12356, &[]).impacts, 0);
    assert!(at(0.12356, &["stops=None"]).max_abs_x < Some(1.2));
    assert!(at(0.12358, &["stops=None"]).max_abs_x > Some(1.2));
    text.says("touches the stop at 1.2 m. Below A = 0.12357 it does not");
    // one impact in every k periods, ever lighter towards grazing
    for (words, amplitude, period) in [
        ("1 in 6 at 0.1236", 0.1236, 6),
        ("1 in 5 at 0.124", 0.124, 5),
        ("", 0.125, 4),
        ("1 in 3 at 0.130", 0.13, 3),
        ("1 in 2 at 0.160", 0.16, 2),
        ("1 in each at 0.190", 0.19, 1),
    ] {
        let summary = at(amplitude, &[]);
        assert_eq!((summary.period, summary.settled), (Some(period), Some(true)), "{amplitude}");
        near(summary.impacts as f64, summary.periods as f64 / f64::from(period), 1.0);
        let speed = 1e3 * summary.impact_speed_max.unwrap();
        let in_g = drive(amplitude).1;
        text.says(&match period {
            4 => format!(
                "At A = 0.125 ({in_g}, as set here) there is 1 impact in 4 periods, with {speed:.0} mm/s"
            ),
            6 => format!("{words} ({in_g}), with less than 7 mm/s"),
            _ => format!("{words} ({in_g})"),
        });
        assert!(period != 6 || speed < 6.9);
    }
    text.says("one impact in 6, 5, 4, 3, 2, 1 periods");
    let run = run_at(&preset("period-adding", &[]), &every(0.1, 15_000));
    let late = run.samples.iter().filter(|sample| sample.t > run.summary.window.0);
    let fastest = late.fold(0.0_f64, |most, sample| most.max(sample.v.abs()));
    near(run.summary.impact_speed_max.unwrap() / fastest, 1.0 / 8.0, 0.01);
    text.says("an eighth of the greatest speed");
    let summary = settled("period-adding", &["excitation.amplitude_g=0.0142"]);
    assert_eq!((summary.period, summary.regime), (None, Regime::Intrawell));
    text.says("no period is found, at 0.0142 g for one");
}

pub fn duffing_cascade(text: &mut Text) {
    let name = "duffing-cascade";
    for (words, amplitude, period) in
        [("0.340", 0.34, 1), ("0.350", 0.35, 2), ("0.356", 0.356, 4), ("0.3582", 0.3582, 8)]
    {
        let (change, in_g) = drive(amplitude);
        let summary = settled(name, &[&change]);
        assert_eq!((summary.period, summary.settled), (Some(period), Some(true)), "{amplitude}");
        assert_eq!(summary.regime, Regime::Intrawell, "{amplitude}");
        let set = if period == 4 { ", as set here" } else { "" };
        let unit = if period == 1 { " period" } else { "" };
        text.says(&format!("{words} ({in_g}{set}): after {period}{unit}"));
    }
    text.says("periods 1, 2, 4, 8 and chaos, all in one well");
    // below and above each doubling, after thousands of periods
    let long = ["run.duration_s=32000", "run.settle_s=31000"];
    let period = |amplitude: f64| {
        let change = format!("excitation.amplitude_g={amplitude}");
        settled(name, &[long[0], long[1], change.as_str()]).period
    };
    let mut found = Vec::new();
    for (below, above, periods) in [(0.03502, 0.03505, 1), (0.03619, 0.03622, 2), (0.036488, 0.0365, 4)] {
        assert_eq!((period(below), period(above)), (Some(periods), Some(2 * periods)), "{below}");
        found.push(0.5 * (below + above));
    }
    let shorter = (found[2] - found[1]) / (found[1] - found[0]);
    near(shorter, 0.25, 0.02);
    text.says(&format!("at {:.4}, {:.4} and {:.4} g", found[0], found[1], found[2]));
    text.says("about a quarter of the first");
    let (change, in_g) = drive(0.36);
    let summary = settled(name, &[&change]);
    assert_eq!((summary.period, summary.regime), (None, Regime::Intrawell));
    text.says(&format!("At 0.360 ({in_g}) no period is found, and the mass still stays in its well"));
    let document = changed(name, &[]);
    let values = (0..=40).map(|i| 0.036 + 5e-5 * f64::from(i)).collect();
    let scan =
        Scan { field: "excitation.amplitude_g".to_owned(), values, resolution: 1e-6, until_settled: None };
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let found =
        threshold(&document.scene, &mechanism(&document), &document.files, &scan, Onset::Crossing, &task)
            .unwrap();
    text.says(&format!("From {:.4} g on it crosses", found.value.unwrap()));
}
