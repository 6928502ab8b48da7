//! Best designs: closed-form optima, the prototype's limits, cliffs, constraints, borders, environments.

use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Outcome, Request};
use interwell::scene::{Document, Files};
use interwell::system::threads::Pool;
use interwell_studies::study::{
    BestDesign, BestQuestion, Constraint, DesignRange, Environment, NoBest, SummaryField, Task, Tolerance,
    best,
};

use crate::cli::{headless, refused, stdout};
use crate::support::*;

fn environment(document: &Document) -> Environment {
    Environment {
        name: document.name.clone(),
        weight: 1.0,
        scene: document.scene.clone(),
        files: document.files.clone(),
    }
}

pub fn question(document: &Document, over: (&str, f64, f64), intervals: usize) -> BestQuestion {
    let (field, low, high) = over;
    BestQuestion {
        over: vec![DesignRange::new(field, (low, high), intervals)],
        maximise: SummaryField::find("rms_velocity_m_per_s").unwrap(),
        subject_to: Vec::new(),
        environments: vec![environment(document)],
        vary: Vec::new(),
        seed: 1,
        until_settled: None,
    }
}

pub fn found_by(question: &BestQuestion, threads: usize) -> Result<BestDesign, NoBest> {
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    best(question, &Pool::new(threads).unwrap(), &task, None, &|_| (), &mut |_| ())
}

/// A field that comes out at most so large a share of its value smaller or larger.
fn within(field: &str, share: f64) -> Tolerance {
    Tolerance { field: field.into(), low: -share, high: share, relative: true }
}

/// A linear oscillator of 2 Hz with a quality of 5, shaken with 1 m/s^2; long enough to be steady.
pub fn linear() -> Document {
    let text = "(mass_g: 1000, mechanism: Linear(n_per_m: 157.91367041742973), damping: Ratio(0.1),
        excitation: Sine(frequency_hz: 2, amplitude_g: 0.10197162129779283),
        run: (duration_s: 60, settle_s: 40, tolerance: 1e-10))";
    Document::from_text("linear", text, Files::default()).unwrap()
}

pub fn at_most(name: &str, limit: f64) -> Constraint {
    Constraint { of: SummaryField::find(name).unwrap(), at_most: true, limit }
}

/// The velocity of a linear oscillator is largest at its natural frequency: A/(2 zeta w0). It falls as
/// 1/sqrt(1 + Q^2 (r - 1/r)^2).
#[test]
fn a_linear_oscillator_is_fastest_at_its_own_frequency() {
    let best = found_by(&question(&linear(), ("excitation.frequency_hz", 1.0, 4.0), 64), 2).unwrap();
    assert_eq!(best.optimum.at, [2.0]);
    let w0 = 4.0 * std::f64::consts::PI;
    near_relative(best.optimum.value, 1.0 / (2.0 * 0.1 * w0) / 2.0_f64.sqrt(), 1e-8);
    let half = 0.5 * (1.0 / 0.81 - 1.0_f64).sqrt() / 5.0;
    let [low, high] = best.margins[0].map(Option::unwrap);
    let resolution = best.resolution[0];
    assert_eq!(resolution, 5e-4);
    near(high, 2.0 * (half + (1.0 + half * half).sqrt()) - 2.0, 2.0 * resolution);
    near(low, 2.0 - 2.0 * ((1.0 + half * half).sqrt() - half), 2.0 * resolution);
    assert!(!best.at_border[0] && !best.flat);
    assert_eq!((best.spread.worst, best.stepped_back.is_none()), (best.optimum.value, true));
}

/// Less damping is faster, down to the end of the range, or to where the displacement A m/(c w0) has its
/// limit.
#[test]
fn a_border_and_a_constraint_end_the_search_where_they_are() {
    let mut document = linear();
    document.set("damping=Coefficient(c_n_s_per_m: 1)").unwrap();
    let mut asked = question(&document, ("damping.c_n_s_per_m", 2.0, 12.0), 50);
    let best = found_by(&asked, 2).unwrap();
    assert_eq!((&best.optimum.at[..], best.at_border[0], best.margins[0][0]), (&[2.0][..], true, None));
    // a tenth is lost where c is a ninth larger
    near(best.margins[0][1].unwrap(), 2.0 / 9.0, 2.0 * best.resolution[0]);
    let limit = 0.02;
    asked.subject_to = vec![at_most("max_abs_x_m", limit)];
    let best = found_by(&asked, 2).unwrap();
    let exact = 1.0 / (limit * 4.0 * std::f64::consts::PI);
    assert!(best.optimum.at[0] >= exact && best.optimum.at[0] - exact <= best.resolution[0], "{best:?}");
    assert!(!best.at_border[0]);
    assert!(best.margins[0][0].unwrap() <= 2.0 * best.resolution[0], "{best:?}");
    asked.subject_to = vec![at_most("max_abs_x_m", 1e-3)];
    let Err(NoBest::NoneMeets { nearest, results }) = found_by(&asked, 2) else { panic!() };
    assert_eq!(nearest, [12.0]);
    near_relative(results[0], 1.0 / (12.0 * 4.0 * std::f64::consts::PI), 1e-3);
}

/// From the prototype's maps: at 0.8 g 1.56 mm with 46 mm/s, at 1 g 2.02 mm with 58 mm/s, and at 1.2 g 2.55
/// mm with 72 mm/s, which motions without stops exceed by far, at 266 mm/s.
#[test]
fn the_best_limits_of_the_prototype_are_those_of_its_maps() {
    for (amplitude, limit, speed, to_cliff) in
        [(0.8, 1.56, 46.0, 0.112), (1.0, 2.02, 58.0, 0.152), (1.2, 2.55, 72.0, 0.21)]
    {
        let document = changed("paper", &[&format!("excitation.amplitude_g={amplitude}")]);
        let best = found_by(&question(&document, ("stops.travel_limit_mm", 0.5, 4.0), 128), 2).unwrap();
        near(best.optimum.at[0], limit, 0.01);
        near(1e3 * best.optimum.value, speed, 0.6);
        near(best.margins[0][1].unwrap(), to_cliff, 2e-3);
    }
    let request = Request { until_settled: Some(600.0), ..Request::default() };
    let open = preset("paper-unconstrained", &["excitation.amplitude_g=1.3"]).run(&request).summary;
    near(1e3 * open.rms_velocity.unwrap(), 266.0, 1.0);
}

/// The same distance by a sweep of every place that can be said.
#[test]
fn the_distance_to_the_cliff_is_that_of_a_fine_sweep() {
    let document = changed("paper", &[]);
    let best = found_by(&question(&document, ("stops.travel_limit_mm", 0.5, 3.0), 100), 2).unwrap();
    let unit = best.resolution[0];
    let speed = |limit: f64| {
        let change = format!("stops.travel_limit_mm={limit}");
        preset("paper", &[&change]).run(&Request::default()).summary.rms_velocity.unwrap()
    };
    let place = |i: i32| ((best.optimum.at[0] / unit).round() + f64::from(i)) / (1.0 / unit).round();
    assert_eq!(speed(place(0)), best.optimum.value);
    let falls = (1..500).find(|i| speed(place(*i)) < 0.9 * best.optimum.value).unwrap();
    near(best.margins[0][1].unwrap(), unit * f64::from(falls), 1e-9);
    assert!((-20..falls).all(|i| speed(place(i)) <= best.optimum.value));
}

#[test]
fn the_mean_over_environments_is_largest_and_each_ones_value_is_there() {
    let document = changed("paper", &["run.duration_s=6"]);
    let mut asked = question(&document, ("stops.travel_limit_mm", 0.5, 2.5), 40);
    let shaken = |amplitude: f64, weight: f64| Environment {
        weight,
        ..environment(&changed(
            "paper",
            &["run.duration_s=6", &format!("excitation.amplitude_g={amplitude}")],
        ))
    };
    asked.environments = vec![shaken(0.8, 1.0), shaken(1.0, 3.0)];
    let best = found_by(&asked, 2).unwrap();
    let [weak, strong] = best.optimum.of_each[..] else { panic!("{best:?}") };
    near_relative(best.optimum.value, (weak + 3.0 * strong) / 4.0, 1e-15);
    let speed = |limit: f64, amplitude: f64| {
        let changes = [
            "run.duration_s=6".to_owned(),
            format!("stops.travel_limit_mm={limit}"),
            format!("excitation.amplitude_g={amplitude}"),
        ];
        let model = preset("paper", &changes.each_ref().map(String::as_str));
        model.run(&Request::default()).summary.rms_velocity.unwrap()
    };
    let mean = |limit: f64| (speed(limit, 0.8) + 3.0 * speed(limit, 1.0)) / 4.0;
    near_relative(mean(best.optimum.at[0]), best.optimum.value, 1e-15);
    for i in 0..=40 {
        assert!(mean(0.5 + 0.05 * f64::from(i)) <= best.optimum.value, "{i}: {best:?}");
    }
    // where both cross
    assert!(weak > 0.04 && strong > 0.04, "{best:?}");
    // the weak one alone has no say beside a hundred times the strong one
    asked.environments = vec![shaken(0.8, 1.0), shaken(1.0, 100.0)];
    near(found_by(&asked, 2).unwrap().optimum.at[0], 2.02, 0.03);
}

#[test]
fn stepping_back_from_a_cliff_costs_less_than_falling() {
    let document = changed("paper", &["run.duration_s=6"]);
    let mut asked = question(&document, ("stops.travel_limit_mm", 1.5, 2.5), 25);
    asked.vary = vec![within("excitation.amplitude_g", 0.1)];
    let one = found_by(&asked, 1).unwrap();
    assert_eq!(one, found_by(&asked, 3).unwrap());
    let (back, spread) = one.stepped_back.clone().unwrap();
    assert!(one.spread.worst < 0.5 * one.optimum.value, "{one:?}");
    // further in even 0.9 g makes it cross
    assert!(back.at[0] < one.optimum.at[0] - 0.05, "{one:?}");
    assert!(spread.worst > 0.8 * one.optimum.value && spread.worst <= spread.quantile_5, "{one:?}");
    asked.seed = 2;
    assert_ne!(found_by(&asked, 2).unwrap().stepped_back.unwrap().1, spread);
}

/// The place with the best worst case, by all samples of all places: what is tried no further is behind.
#[test]
fn the_best_worst_case_is_that_of_all_samples_at_every_place() {
    let document = changed("paper", &["run.duration_s=6"]);
    for (by, inward) in [(0.02, 1.6), (0.1, 1.5), (0.3, 1.0)] {
        let mut asked = question(&document, ("stops.travel_limit_mm", inward, 2.5), 25);
        asked.vary = vec![within("excitation.amplitude_g", by)];
        let best = found_by(&asked, 2).unwrap();
        let (back, spread) = best.stepped_back.clone().unwrap();
        // of a range that ends at it the optimum is a place of its own, with the same samples
        let spread_at = |limit: f64| {
            let mut fixed = question(&document, ("stops.restitution", 0.35, 0.36), 1);
            fixed.over[0].low = 0.36 - 1e-9;
            let mut document = document.clone();
            document.set(&format!("stops.travel_limit_mm={limit}")).unwrap();
            fixed.environments = vec![environment(&document)];
            fixed.vary = asked.vary.clone();
            found_by(&fixed, 2).unwrap().spread
        };
        near_relative(spread_at(back.at[0]).worst, spread.worst, 1e-6);
        near_relative(spread_at(back.at[0]).quantile_5, spread.quantile_5, 1e-6);
        for share in [0.05, 0.2, 0.4, 0.7, 1.0] {
            let other = best.optimum.at[0] - share * (best.optimum.at[0] - inward);
            let worst = spread_at(other).worst;
            assert!(!(worst > 1.02 * spread.worst), "{by}: {other} {worst} {spread:?}");
        }
    }
}

#[test]
fn two_fields_are_searched_together() {
    // the velocity at resonance A/(2 zeta w0) is largest for the least stiffness and the frequency of it
    let mut document = linear();
    document.set("damping=Coefficient(c_n_s_per_m: 2.5)").unwrap();
    let mut asked = question(&document, ("excitation.frequency_hz", 1.0, 4.0), 24);
    asked.over.push(DesignRange::new("mechanism.n_per_m", (100.0, 200.0), 8));
    let best = found_by(&asked, 2).unwrap();
    let natural = best.optimum.at[1].sqrt() / std::f64::consts::TAU;
    near(best.optimum.at[0], natural, 2e-3);
    near_relative(best.optimum.value, 1.0 / 2.5 / 2.0_f64.sqrt(), 1e-5);
    assert_eq!(best.margins.len(), 2);
    let table = best.table(&asked);
    let columns: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
    let all = "frequency_hz n_per_m maximised value margin_low margin_high worst quantile_5 \
               margin_low.n_per_m margin_high.n_per_m back_to back_value back_worst back_quantile_5 \
               margin_low_step margin_high_step margin_low_step.n_per_m margin_high_step.n_per_m";
    assert_eq!(columns, all.split(' ').collect::<Vec<_>>());
}

#[test]
fn the_command_writes_one_row_the_same_for_any_jobs_and_says_what_it_found() {
    let command = "best paper --over stops.travel_limit_mm=1.5:2.5:0.05 --set run.duration_s=6 \
                   --environment excitation.amplitude_g=0.8*2,1 --vary mass_g=-1%:1%";
    let row = stdout(&format!("{command} --quiet --jobs 1"));
    assert_eq!(row, stdout(&format!("{command} --quiet --jobs 3")));
    assert_eq!(row.lines().count(), 2);
    assert!(
        row.starts_with("travel_limit_mm,maximised,value,margin_low,margin_high,worst,quantile_5,back_to,")
    );
    let last = ",value_1,value_2,margin_low_step,margin_high_step";
    assert!(row.lines().next().unwrap().ends_with(last), "{row}");
    let said = headless(command).output().unwrap().stderr;
    let said = String::from_utf8(said).unwrap();
    for words in [
        "the mean of rms_velocity_m_per_s is largest at travel_limit_mm = ",
        "a tenth of it is lost",
        "excitation.amplitude_g = 0.8: ",
        "of 200 samples of what varies the worst gives",
        " mm: 0.0",
        "at travel_limit_mm = ",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
}

/// Averages of a motion without a period are those of a window, and a best one among them is said to be so.
#[test]
fn a_best_motion_that_does_not_repeat_is_said_to_be_uncertain() {
    let said = |restitution: f64| {
        let line = format!(
            "best paper --set stops.restitution={restitution} --over stops.travel_limit_mm=2.2:2.35:0.03"
        );
        let output = headless(&line).assert().success().get_output().clone();
        String::from_utf8(output.stderr).unwrap()
    };
    let words = "has not repeated by the end of its run: followed for twice as long it gives 0.";
    assert!(said(0.9964).contains(words), "{}", said(0.9964));
    assert!(!said(0.36).contains("has not repeated"), "{}", said(0.36));
}

/// Every number that is said has its unit, and a constraint is spoken of only where there is one.
#[test]
fn what_is_said_has_units() {
    let line = "best paper --over stops.travel_limit_mm=1.5:2.5:0.25 --over stops.restitution=0.2:0.4:0.1 \
                --set run.duration_s=6 --vary mass_g=-1%:1%";
    let said = |line: &str| {
        let output = headless(line).assert().success().get_output().clone();
        String::from_utf8(output.stderr).unwrap()
    };
    let free = said(line);
    let places = free.lines().flat_map(|line| line.split("travel_limit_mm = ").skip(1));
    let units: Vec<&str> = places.map(|place| place.split([',', ':', ' ']).nth(1).unwrap_or("")).collect();
    assert!(!units.is_empty() && units.iter().all(|unit| *unit == "mm"), "{free}");
    assert!(!free.contains("constraint"), "{free}");
    assert!(said(&format!("{line} --subject-to max_abs_x_m<=1")).contains("a constraint broken"));
}

/// Counts and seeds are whole: so are the best one, the margins and the resolution.
#[test]
fn fields_of_whole_numbers_are_searched_among_whole_numbers() {
    for (line, most) in [
        ("best paper --over mechanism.parallel.count=1:4 --set stops.travel_limit_mm=1", 4.0),
        ("best paper --over mechanism.parallel.count=1:9:4 --set stops.travel_limit_mm=1", 9.0),
        ("best random-shaking --over excitation.lines=10:200 --set run.duration_s=4", 200.0),
        ("best random-shaking --over excitation.seed=1:20000:2000 --set run.duration_s=1", 20000.0),
    ] {
        let row = stdout(&format!("{line} --set run.settle_s=0.5 --quiet"));
        let cells: Vec<&str> = row.lines().nth(1).unwrap().split(',').collect();
        let names: Vec<&str> = row.lines().next().unwrap().split(',').collect();
        let at: f64 = cells[0].parse().unwrap();
        assert!(at.fract() == 0.0 && (1.0..=most).contains(&at), "{row}");
        for (name, cell) in names.iter().zip(&cells).filter(|pair| pair.0.starts_with("margin")) {
            assert!(cell.is_empty() || cell.parse::<f64>().unwrap().fract() == 0.0, "{name}: {row}");
        }
    }
    // whoever asks: the scene says which fields are whole
    let document = changed("paper", &["stops.travel_limit_mm=1", "run.duration_s=4", "run.settle_s=2"]);
    let found = found_by(&question(&document, ("mechanism.parallel.count", 1.0, 4.0), 3), 2).unwrap();
    assert_eq!((found.resolution[0], found.optimum.at[0].fract()), (1.0, 0.0));
    // each of them alone: there is none better
    let value = |count: u32| {
        let set = format!("--set mechanism.parallel.count={count} --set stops.travel_limit_mm=1");
        let csv = stdout(&format!("sweep paper --over run.tolerance=1e-9 {set} --quiet"));
        crate::cli::column(&csv, "rms_velocity_m_per_s")[0].parse::<f64>().unwrap()
    };
    let row = stdout("best paper --over mechanism.parallel.count=1:4 --set stops.travel_limit_mm=1 --quiet");
    let best: f64 = crate::cli::column(&row, "value")[0].parse().unwrap();
    assert_eq!(best, (1..=4).map(value).fold(0.0, f64::max));
}

/// A run goes on until its motion repeats: a transient is no result. Which of these motions are long
/// transients depends on rounding.
#[test]
fn a_transient_is_not_what_is_best() {
    let mut transients = 0;
    for hundredths in (118..=134).step_by(2) {
        let amplitude = format!("excitation.amplitude_g={}", f64::from(hundredths) / 100.0);
        let fields = [amplitude.as_str(), "run.duration_s=12", "run.settle_s=8"];
        let document = changed("paper-unconstrained", &fields);
        let best = found_by(&question(&document, ("mass_g", 15.2, 15.3), 1), 2).unwrap().optimum;
        let mass = format!("mass_g={:?}", best.at[0]);
        let model = preset("paper-unconstrained", &[&fields[..], &[mass.as_str()]].concat());
        // 1000 forcing periods beyond the run
        let until_settled = Some(12.0 + 1000.0 / 3.0);
        let followed = model.run(&Request { until_settled, ..Request::default() }).summary;
        let short = model.run(&Request::default()).summary;
        transients += u32::from((short.settled, followed.settled) == (Some(false), Some(true)));
        assert_eq!(Some(best.value), followed.rms_velocity, "{hundredths}");
    }
    assert!(transients >= 3, "{transients}");
}

/// A run that ends early has no value, however fast it was until then.
#[test]
fn a_run_that_ended_early_is_not_what_is_best() {
    let fields = ["stops=None", "run.duration_s=4", "run.settle_s=0"];
    let document = changed("paper-table", &fields);
    let asked = question(&document, ("excitation.amplitude_g", 1.0, 8.0), 28);
    let best = found_by(&asked, 2).unwrap().optimum;
    let run = |amplitude: f64| {
        let amplitude = format!("excitation.amplitude_g={amplitude:?}");
        let changes = [&fields[..], &[amplitude.as_str()]].concat();
        preset("paper-table", &changes).run(&Request::default()).summary
    };
    let (there, beyond) = (run(best.at[0]), run(8.0));
    assert_eq!(there.outcome, Outcome::Done, "{best:?}");
    assert!(matches!(beyond.outcome, Outcome::LeftTable { .. }), "{beyond:?}");
    assert!(beyond.rms_velocity.unwrap() > best.value, "{beyond:?} {best:?}");
}

#[test]
fn where_nothing_keeps_to_a_constraint_the_nearest_design_is_named() {
    let line = "best paper --over stops.travel_limit_mm=1:2:0.5 --quiet --subject-to max_abs_x_m<=1e-6";
    let words = ["nothing that was tried", "travel_limit_mm = 1 mm,", "is 0.001 m"];
    refused(headless(line), &words);
}

#[test]
fn a_search_that_is_cancelled_makes_none_of_its_places() {
    let mut asked = question(&linear(), ("mass_g", 900.0, 1100.0), 30_000);
    for field in ["excitation.frequency_hz", "excitation.amplitude_g", "run.duration_s"] {
        asked.over.push(DesignRange::new(field, (1.0, 2.0), 30_000));
    }
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(true) };
    let found = best(&asked, &Pool::new(2).unwrap(), &task, None, &|_| (), &mut |_| ());
    assert_eq!(found.unwrap_err(), NoBest::Cancelled);
}
