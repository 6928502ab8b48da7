//! Scenes of the prototype.

use interwell::dynamics::{EventKind, Regime, Side};
use interwell::mechanics::Mechanism;
use interwell::scene::TABLES;
use interwell_studies::study::Onset;

use super::super::support::*;
use super::*;

const TOLERANCES: [&str; 3] = ["run.tolerance=1e-6", "run.tolerance=1e-9", "run.tolerance=1e-12"];

fn shaken(amplitude: f64) -> String {
    format!("excitation.amplitude_g={amplitude}")
}

fn stopped(limit: f64) -> String {
    format!("stops=Rigid(travel_limit_mm: {limit}, restitution: 0.36)")
}

fn barrier(mechanism: &Mechanism) -> f64 {
    1e3 * mechanism.landscape.barrier.unwrap().from_right_j
}

pub fn first_look(text: &mut Text) {
    for change in [TOLERANCES[0], TOLERANCES[1], "start=At(x_mm: 6, v_m_per_s: 0)"] {
        let summary = settled("first-look", &[change]);
        assert_eq!((summary.regime, summary.period, summary.total_crossings), (Regime::Intrawell, None, 0));
        let (low, high) = summary.range.unwrap();
        near(low, 5.65e-3, 5e-5);
        near(high, 7.28e-3, 3e-5);
        within(rms(&summary), 16.2..18.5);
    }
    text.says("between 5.6 and 7.3 mm");
    text.says("of 16 to 18 mm/s");
    // what the questions ask about is there to be found
    for tolerance in TOLERANCES {
        let summary = settled("first-look", &["excitation.amplitude_g=1.3", tolerance]);
        crosses(&summary);
        within(summary.settles_at.unwrap(), 3.0..600.0);
    }
    text.says("Does it find a rhythm");
    let at = |limit: f64| settled("first-look", &[&stopped(limit)]);
    crosses(&at(1.5));
    let speeds = [1.5, 1.6, 1.7, 1.8, 1.9].map(|limit| rms(&at(limit)));
    assert!(speeds[..4].is_sorted() && speeds[4] < speeds[3], "{speeds:?}");
    assert!(at(1.95).regime == Regime::Intrawell && at(1.95).releases > 0);
    assert_eq!(at(2.1).regime, Regime::Rest);
    text.says("where is the mass fastest, and what comes after that");
    let from = |changes: &[&str]| least(Onset::Crossing, "first-look", changes, 1.0..1.4);
    assert!(from(&[]) + 0.1 < from(&[&stopped(7.0)]));
    text.says("Try stops just inside the wells, at 7 mm");
}

pub fn paper(text: &mut Text) {
    let frees = least(Onset::Release, "paper", &[], 0.0..2.0);
    let from = |changes: &[&str], range| least(Onset::Crossing, "paper", changes, range);
    let stops = from(&[], 0.5..1.0);
    text.says(&format!("It takes {frees:.2} g to pull it off, and from {stops:.2} g on it crosses"));
    crosses(&settled("paper", &[]));
    // Without stops
    assert_eq!(settled("paper", &["stops=None"]).regime, Regime::Intrawell);
    let open = from(&["stops=None"], 1.0..1.3);
    within(open, 1.15..1.16);
    text.says("from rest it takes between 1.15 and 1.16 g to cross");
    let at = |limit: f64| from(&[&stopped(limit)], 1.0..1.6);
    text.says(&format!(
        "at 2.6 mm it is {:.2} g, but from 2.7 mm, with {:.2} g, out to 7 mm",
        at(2.6),
        at(2.7)
    ));
    assert!(at(2.6) < open - 0.005);
    let further = [2.7, 3.0, 4.0, 4.4, 4.6, 4.8, 5.0, 6.0, 6.5, 7.0].map(at);
    assert!(further.iter().all(|amplitude| *amplitude > open + 0.01), "{further:?}");
    assert!(
        further[..5].is_sorted() && further[5..].iter().all(|amplitude| *amplitude < further[4]),
        "{further:?}"
    );
    text.says(&format!("it is higher than without stops, at most {:.2} g at 4.6 mm", further[4]));
    // The other reading of the damping ratio
    let mechanism = preset("paper", &[]).mechanism().clone();
    let outer = mechanism.landscape.kink_at_right_well().unwrap().outer;
    let damping = 2.0 * 0.023 * (outer * 15.2e-3).sqrt();
    text.says(&format!("By the slope outside it would be {damping:.3} N s/m"));
    let damping = format!("damping=Coefficient(c_n_s_per_m: {damping:?})");
    let [open, below, above] =
        ["stops=None", &stopped(3.4), &stopped(3.6)].map(|stops| from(&[&damping, stops], 1.2..1.6));
    within(open, 1.395..1.425);
    assert!(below < 1.395 && above > below + 0.02 && above > open - 0.01, "{below} {open} {above}");
    text.says("then it takes about 1.4 g without stops, and stops up to 3.4 mm lower that");
    // A softer preload
    let softer = ["mechanism.preload_mm=2.5"];
    let [stiff, soft] = [&[][..], &softer[..]].map(|changes| barrier(preset("paper", changes).mechanism()));
    let crosses_from = from(&softer, 0.5..1.0);
    text.says(&format!("lowers the barrier from {stiff:.3} to {soft:.3} mJ"));
    text.says(&format!("with the same stops the mass then crosses from {crosses_from:.2} g on"));
    text.says("A preload of 2.5 mm in place of 2.7");
}

pub fn paper_table(text: &mut Text) {
    let (beams, solid) =
        (preset("paper", &[]).mechanism().clone(), preset("paper-table", &[]).mechanism().clone());
    let header = TABLES.iter().find(|table| table.name == "force_dl2.7.csv").unwrap().text;
    assert!(header.contains("good to 0.003 N for |x| < 7.1 mm"));
    text.says("good to 3 mN between -7.1 and 7.1 mm");
    let (landscape, curve) = (&solid.landscape, &solid.curve);
    let hardest = landscape.extrema.iter().fold(0.0_f64, |most, extremum| most.max(extremum.force));
    let (well, kink) = (landscape.right_stable().unwrap().x, landscape.kinks.last().unwrap().x);
    let barrier = barrier(&solid);
    text.says(&format!("the largest force between the wells is {hardest:.3} N, the barrier {barrier:.2} mJ"));
    let (well_mm, kink_mm) = (1e3 * well, 1e3 * kink);
    text.says(&format!("the wells lie at {well_mm:.2} mm, inside the kink at {kink_mm:.2} mm"));
    for side in [-1e-6, 1e-6] {
        text.says(&format!("rises at {:.0} N/m on both sides", curve.force(well + side) / side));
    }
    // Against the beams
    let apart = |reach: i32| {
        let at = (0..=reach).map(|i| f64::from(i) * 1e-5);
        1e3 * at.fold(0.0_f64, |most, x| most.max((beams.curve.force(x) - curve.force(x)).abs()))
    };
    text.says(&format!("at most {:.0} mN up to 5.5 mm, and by more further out", apart(550)));
    assert!(apart(700) > 1.5 * apart(550));
    let [well, kink] = [beams.landscape.right_stable().unwrap().x, beams.landscape.kinks.last().unwrap().x];
    assert!(well > kink && well < kink + 1e-5);
    text.says(&format!("their wells lie at {:.2} mm, just beyond the kink", 1e3 * well));
    let takes = |name| {
        let crosses = least(Onset::Crossing, name, &[], 0.5..1.0);
        (least(Onset::Release, name, &[], 0.0..2.0), crosses)
    };
    let (solid, beams) = (takes("paper-table"), takes("paper"));
    text.says(&format!("At 1.5 mm it takes {:.2} g to free the mass here", solid.0));
    text.says(&format!("and {:.2} g to carry it across", solid.1));
    text.says(&format!("with the beams {:.2} and {:.2} g, a tenth less", beams.0, beams.1));
    for share in [beams.0 / solid.0, beams.1 / solid.1] {
        near(share, 0.9, 0.01);
    }
    crosses(&settled("paper-table", &[]));
}

pub fn paper_unconstrained(text: &mut Text) {
    const NAME: &str = "paper-unconstrained";
    let summary = settled(NAME, &[]);
    assert_eq!((summary.regime, summary.period), (Regime::Intrawell, Some(1)));
    let (low, high) = summary.range.unwrap();
    let kink = preset(NAME, &[]).mechanism().landscape.kinks.last().unwrap().x;
    near(high, kink, 1e-4);
    text.says(&format!("between {:.1} and {:.1} mm, where the flexures are taut", 1e3 * low, 1e3 * high));
    text.says(&format!("of {:.0} mm/s", rms(&summary)));
    for hundredths in [3, 20, 40, 60, 80, 90, 100, 105, 110, 113, 115] {
        let change = shaken(f64::from(hundredths) / 100.0);
        assert_eq!(settled(NAME, &[&change]).total_crossings, 0, "{change}");
    }
    text.says("nothing crosses up to 1.15 g");
    text.says("stays in its well at 1 g, crosses above 1.15 g");
    let mut others = 0;
    for hundredths in 116..=136 {
        let change = shaken(f64::from(hundredths) / 100.0);
        for tolerance in TOLERANCES {
            let summary = settled(NAME, &[&change, tolerance]);
            // at 1.24 g it may cross in every period and yet never repeat
            let settled = summary.settled == Some(true) || hundredths == 124;
            assert!(summary.total_crossings > 0 && settled, "{change} {tolerance}");
            match summary.regime {
                Regime::Interwell => within(reach(&summary), 7.83..7.9),
                _ => others += 1,
            }
        }
    }
    assert!(others <= 3, "{others} of 63");
    text.says("From 1.16 to 1.36 g the mass crosses irregularly at first");
    text.says("regular, between -7.9 and 7.9 mm");
    for tolerance in TOLERANCES {
        let speed = |amplitude: f64| {
            let summary = settled(NAME, &[&shaken(amplitude), tolerance]);
            crosses(&summary);
            rms(&summary)
        };
        text.says(&format!(
            "at 1.18 g with {:.0} mm/s, at 1.3 g with {:.0} mm/s, at 1.35 g with {:.0} mm/s",
            speed(1.18),
            speed(1.3),
            speed(1.35)
        ));
        speed(1.8);
    }
    let stops = settled(NAME, &[&stopped(1.5)]);
    crosses(&stops);
    text.says(&format!("With stops at 1.5 mm, 1 g gives {:.0} mm/s", rms(&stops)));
    for hundredths in 137..=150 {
        let summary = settled(NAME, &[&shaken(f64::from(hundredths) / 100.0)]);
        assert_eq!((summary.regime, summary.period), (Regime::Irregular, None), "{hundredths}");
    }
    text.says("From 1.37 to 1.5 g no period was found within 600 s; at 1.8 g there is one again");
}

pub fn paper_ramp(text: &mut Text) {
    let ramp = run(&preset("paper-ramp", &[]));
    let firsts = ramp.summary.firsts.unwrap();
    let (frees, crosses) = (firsts.release.unwrap(), firsts.crossing.unwrap());
    let in_g = |first: interwell::dynamics::First| first.amplitude.unwrap() / 9.80665;
    let holds = least(Onset::Release, "paper", &[], 0.0..2.0);
    text.says(&format!("The stop at 1.5 mm holds the mass up to {holds:.3} g"));
    text.says(&format!(
        "After {:.1} s, at {:.3} g, the mass lets go for the first time",
        frees.t,
        in_g(frees)
    ));
    // the last of these releases is the one that it crosses after
    let hops = of_kind(&ramp, EventKind::Release).iter().filter(|event| event.t < crosses.t).count() - 1;
    text.says(&format!(
        "It hops {hops} times; then, after {:.1} s, at {:.3} g, it reaches",
        crosses.t,
        in_g(crosses)
    ));
    assert_eq!(firsts.crossing_in_every_period, firsts.crossing);
    assert_eq!(ramp.summary.crossings, 2 * ramp.summary.periods);
    text.says("it crosses twice in every period up to the end");
    text.says("from 0 to 2 g in five minutes: when it frees, when it crosses");
    for tolerance in TOLERANCES {
        let firsts = run(&preset("paper-ramp", &["stops=None", tolerance])).summary.firsts.unwrap();
        within(in_g(firsts.crossing.unwrap()), 1.15..1.25);
        within(in_g(firsts.crossing_in_every_period.unwrap()), 1.2..1.6);
    }
    text.says("crosses first somewhere between 1.15 and 1.25 g");
    text.says("in every period only from somewhere between 1.2 and 1.6 g on");
}

pub fn uneven_stops(text: &mut Text) {
    let summary = settled("uneven-stops", &[]);
    crosses(&summary);
    let (left, right) = summary.range.unwrap();
    text.says(&format!("The right stop is {:.1} mm further out", 1e3 * (right + left)));
    let uneven = run(&preset("uneven-stops", &[]));
    // the first impact after each crossing, once settled
    let late = uneven.events.windows(2).filter(|pair| pair[0].t > 5.0 && pair[0].kind == EventKind::Crossing);
    let mut landings = 0;
    for landing in late.map(|pair| pair[1]) {
        let (v_in, v_out) = (1e3 * landing.v_in.abs(), 1e3 * landing.v_out.abs());
        text.says(&match landing.side {
            Side::Left => format!("it meets the left stop with {v_in:.0} mm/s and leaves it with {v_out:.0}"),
            Side::Right => format!("the right one with {v_in:.0} and {v_out:.0}"),
        });
        landings += 1;
    }
    assert!(landings >= 29);
    let at = |right: f64| settled("uneven-stops", &[&format!("stops.right_mm={right}")]);
    crosses(&at(2.15));
    text.says("At 2.15 mm the mass still crosses twice in every period");
    assert!(at(2.2).regime == Regime::Intrawell && at(2.2).releases > 0);
    assert!(at(2.3).releases > 0 && [2.35, 2.4, 2.5].iter().all(|right| at(*right).regime == Regime::Rest));
    text.says("At 2.2 mm it lets go of this stop but does not cross, and from 2.35 mm on it never lets go");
}

pub fn walking(text: &mut Text) {
    // the count of steps as the record's header has it
    let step = |t: f64| {
        let wander = 0.04 * 11.0 / std::f64::consts::TAU * (1.0 - (std::f64::consts::TAU * t / 11.0).cos());
        (2.0 * t + wander).floor() as usize
    };
    // full pace from 4 to 56 s
    assert_eq!((step(4.0), step(56.0)), (8, 112));
    let record = TABLES.iter().find(|table| table.name == "walking.csv").unwrap().text;
    let rows = record.lines().filter(|line| !line.starts_with('#')).skip(1);
    let most = rows
        .fold(0.0_f64, |most, row| most.max(row.split_once(',').unwrap().1.parse::<f64>().unwrap().abs()));
    text.says(&format!("by {:.1} g at most", most / 9.80665));
    let at = |limit: f64, a_step: u32| {
        let walk = run(&preset("walking", &[&stopped(limit)]));
        let mut steps = [0; 120];
        for event in of_kind(&walk, EventKind::Crossing) {
            steps[step(event.t)] += 1;
        }
        let walked = if limit < 0.7 { &steps[8..112] } else { &steps[10..112] };
        assert!(walked.iter().all(|count| *count == a_step), "{limit}: {steps:?}");
        rms(&walk.summary)
    };
    assert_eq!(settled("walking", &[&stopped(1.5)]).regime, Regime::Rest);
    text.says("too little for stops at 1.5 mm");
    text.says("crosses in every step with stops at 0.6 mm");
    let [first, best, less] = [(0.6, 2), (0.75, 2), (0.8, 1)].map(|(limit, a_step)| at(limit, a_step));
    text.says("With stops at 0.6 mm it crosses over and back in every step at full pace");
    text.says(&format!("of {first:.0} mm/s"));
    text.says(&format!("rises, to {best:.1} mm/s at 0.75 mm, and then falls"));
    text.says(&format!(
        "At 0.8 mm one step carries the mass across and only the next one back, at {less:.0} mm/s"
    ));
    assert_eq!(settled("walking", &[&stopped(0.85)]).total_crossings, 1);
    text.says("At 0.85 mm it crosses once in the whole walk");
    for tolerance in TOLERANCES {
        let open = settled("walking", &["stops=None", tolerance]);
        assert_eq!(open.total_crossings, 0);
        near(rms(&open), 7.4, 0.2);
    }
    text.says("at about 7.4 mm/s");
}

pub fn random_shaking(text: &mut Text) {
    text.says(&format!("{} times in this minute", settled("random-shaking", &[]).crossings));
    let all = |changes: &[&str]| {
        let seeds = (1..=8).map(|seed| format!("excitation.seed={seed}"));
        let runs = seeds.map(|seed| settled("random-shaking", &[&[seed.as_str()], changes].concat()));
        let runs: Vec<(u64, f64)> = runs.map(|summary| (summary.total_crossings, rms(&summary))).collect();
        let counts = runs.iter().map(|run| run.0);
        let speeds = |most: fn(f64, f64) -> f64| runs.iter().map(|run| run.1).reduce(most).unwrap();
        ((counts.clone().min().unwrap(), counts.max().unwrap()), (speeds(f64::min), speeds(f64::max)))
    };
    let ((few, many), slow) = all(&[]);
    text.says(&format!(
        "with seeds 1 to 8 the mass crosses {few} to {many} times with the stops, and never without"
    ));
    let (none, free) = all(&["stops=None"]);
    assert_eq!(none, (0, 0));
    for (low, high) in [slow, free] {
        assert!(low > 13.0 && high < 17.5, "{low} {high}");
    }
    text.says("13 to 17 mm/s with stops or without");
    text.says("with stops at 1 mm, and not without");
    let ((few, many), (low, high)) = all(&["excitation.rms_g=0.5"]);
    let (counts, speeds) = all(&["excitation.rms_g=0.5", "stops=None"]);
    assert!(counts.0 >= 1 && counts.1 <= 70 && speeds.0 > 48.0 && speeds.1 < 102.0, "{counts:?} {speeds:?}");
    text.says("At 0.5 g the mass crosses without stops too, some 5 to 60 times a minute");
    text.says(&format!("against {few} to {many} with them"));
    text.says(&format!("at some 50 to 100 mm/s against {low:.0} to {high:.0}"));
}
