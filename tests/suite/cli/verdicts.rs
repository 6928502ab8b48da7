//! Columns, waiting for motions to settle, and thresholds, as the command line gives them.

use predicates::str::contains;

use super::{column, headless, stdout};

#[test]
fn twenty_amplitudes_settle() {
    let line = "sweep paper-unconstrained --over excitation.amplitude_g=1.16:1.35:0.01 --until-settled 300 \
        --columns regime,period,settled,settles_at_s --quiet";
    let csv = stdout(line);
    assert_eq!(csv.lines().next().unwrap(), "amplitude_g,regime,period,settled,settles_at_s");
    // (at 1.24 g it may cross in every period and yet never repeat)
    assert!(column(&csv, "settled").iter().filter(|settled| *settled == "true").count() >= 19, "{csv}");
    // Nearly all cross, most of them once over and back in every period. Beside that motion there are others,
    // and the wild beginning chooses among them.
    let crossing = column(&csv, "regime").iter().filter(|regime| *regime == "interwell").count();
    assert!(crossing >= 18, "{csv}");
    let once = column(&csv, "period").iter().filter(|period| *period == "1").count();
    assert!(once >= 14, "{csv}");
    // the same bytes for any number of threads
    assert_eq!(stdout(&format!("{line} --jobs 1")), stdout(&format!("{line} --jobs 3")));
}

#[test]
fn columns_are_chosen_by_name() {
    let sweep = "sweep paper --over excitation.amplitude_g=0.5,1 --quiet --columns ";
    let csv = stdout(&format!("{sweep}side,mean_x_m,outcome,min_x_m"));
    assert_eq!(csv.lines().next().unwrap(), "amplitude_g,side,mean_x_m,outcome,min_x_m");
    assert_eq!(column(&csv, "side"), ["right", "both"]);
    assert_eq!(column(&csv, "min_x_m"), ["0.0015", "-0.0015"]);
    assert_eq!(column(&csv, "mean_x_m")[0], "0.0015");
    // all of them begin with those that there always are
    let all = stdout(&format!("{sweep}all"));
    let header = all.lines().next().unwrap();
    let standard = stdout("sweep paper --over excitation.amplitude_g=0.5,1 --quiet");
    assert!(
        header.starts_with(standard.lines().next().unwrap()) && header.contains(",settles_at_s"),
        "{header}"
    );
}

#[test]
fn samples_reach_to_the_end_of_a_run_that_waits() {
    let csv =
        stdout("simulate first-look --set excitation.amplitude_g=1.3 --until-settled 300 --dt 1 --quiet");
    let last: f64 = column(&csv, "t_s").last().unwrap().parse().unwrap();
    assert!((11.0..=300.0).contains(&last), "{last}");
}

#[test]
fn thresholds_are_tables() {
    // in closed form: mass times amplitude is the force at the stop
    let csv = stdout("threshold paper --of release --over stops.travel_limit_mm=1,1.5,4");
    assert_eq!(
        csv.lines().next().unwrap(),
        "travel_limit_mm,of,value,low,high,undecided,windows,step,resolution"
    );
    let curve = column(&stdout("curve paper --at-mm 1,1.5,4"), "force_n");
    assert_eq!((column(&csv, "value").len(), curve.len()), (3, 3));
    for (value, force) in column(&csv, "value").iter().zip(curve) {
        let (value, force): (f64, f64) = (value.parse().unwrap(), force.parse().unwrap());
        assert!((value + force / 15.2e-3 / 9.80665).abs() < 1e-12, "{value} {force}");
    }
    // crossing takes more, and the run just below it does not cross
    let csv = stdout("threshold paper --over stops.travel_limit_mm=1,1.5,4 --resolution 0.001");
    assert_eq!(column(&csv, "of"), ["crossing"; 3]);
    let least: Vec<f64> = column(&csv, "value").iter().map(|value| value.parse().unwrap()).collect();
    for (mm, g) in [1.0, 1.5, 4.0].into_iter().zip(&least) {
        let runs = format!(
            "sweep paper --set stops.travel_limit_mm={mm} --over excitation.amplitude_g={},{} \
             --until-settled 100 --quiet",
            g - 0.001,
            g
        );
        let crossings = column(&stdout(&runs), "crossings");
        assert!(crossings[0] == "0" && crossings[1] != "0", "{mm} mm, {g} g: {crossings:?}");
    }
    // whatever the scene's own amplitude is
    assert_eq!(stdout("threshold paper --set excitation.amplitude_g=0.1"), stdout("threshold paper"));
    // none in the range, and another field
    assert_eq!(
        stdout("threshold paper --field excitation.amplitude_g=0:0.5"),
        "of,value,low,high,undecided,windows,step,resolution\ncrossing,,0.5,,false,,,\n"
    );
    // that is said
    let told = |line: &str| {
        let assert = headless(line).assert().success();
        String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
    };
    let line = "threshold paper --field excitation.amplitude_g=0:0.5:0.1";
    let words = "the row has no value: no excitation.amplitude_g that was tried from 0 to 0.5 makes";
    assert!(told(line).contains(words), "{}", told(line));
    assert_eq!(told(&format!("{line} --quiet")), "");
    // at the first value of the range it may not begin
    let line = "threshold paper --field stops.travel_limit_mm=2:3:0.1";
    let words = "the row has its value at 2, the first that was tried: where the field can have a lower";
    assert!(told(line).contains(words), "{}", told(line));
    let some = "threshold paper --of release --field excitation.amplitude_g=0:0.7:0.1 \
                --over stops.travel_limit_mm=1.5,4";
    assert!(told(some).contains("1 of 2 rows have no value"), "{}", told(some));
    // a negative amplitude pushes as hard, half a period later: all from -1 g on is a range with a gap
    assert_eq!(
        stdout("threshold paper --of release --field excitation.amplitude_g=-1:1:0.1 --quiet"),
        "of,value,low,high,undecided,windows,step,resolution\nrelease,-1,,-1,false,2,,\n"
    );
    let csv = stdout("threshold paper --field stops.travel_limit_mm=1:3:0.1 --of interwell");
    assert_eq!(column(&csv, "windows"), ["1"], "it ends where the stops hold the mass too hard: {csv}");
}

/// Followed for 10 000 s at each quarter of a thousandth, it crosses from 1.15075 g on and not at 1.1505 g.
/// Just above, it may take 1500 s to: nothing found in the default time may claim more than it has seen.
#[test]
fn a_threshold_that_is_reached_ever_later_is_bracketed() {
    for (range, more) in [("1:1.3", ""), ("1.05:1.25:0.01", ""), ("1:1.3:0.02", " --until-settled 100")] {
        let line = format!("threshold paper-unconstrained --field excitation.amplitude_g={range}{more}");
        let csv = stdout(&format!("{line} --jobs 1"));
        let number = |name: &str| column(&csv, name)[0].parse::<f64>().unwrap();
        assert!(number("low") <= 1.1505 && number("high") >= 1.15075, "{range}{more}: {csv}");
        assert!(number("value") >= 1.15 && number("value") <= number("high"), "{range}{more}: {csv}");
        assert_eq!(column(&csv, "undecided"), ["true"]);
        let output = headless(&format!("{line} --jobs 3")).assert().success().get_output().clone();
        assert_eq!(String::from_utf8_lossy(&output.stdout), csv);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(said.contains("the row is undecided") && said.contains("--until-settled"), "{said}");
    }
}

/// Under a drive that never repeats the run is all that is asked about.
#[test]
fn under_noise_the_run_decides() {
    let line =
        "threshold random-shaking --set run.duration_s=20 --field excitation.rms_g=0.1:0.6:0.02 --quiet";
    let csv = stdout(line);
    let number = |name: &str| column(&csv, name)[0].parse::<f64>().unwrap();
    assert_eq!((column(&csv, "undecided")[0].as_str(), number("value")), ("false", number("high")));
    assert!((number("value") - number("low") - 2e-5).abs() < 1e-9, "{csv}");
    let runs = format!(
        "sweep random-shaking --set run.duration_s=20 --over excitation.rms_g={},{} --quiet",
        number("low"),
        number("high")
    );
    let crossings = column(&stdout(&runs), "crossings");
    assert!(crossings[0] == "0" && crossings[1] != "0", "{crossings:?}");
}

#[test]
fn a_threshold_of_whole_numbers_is_a_whole_number() {
    let weak = "random-shaking --set run.duration_s=10 --set excitation.rms_g=0.15 --quiet";
    let csv = stdout(&format!("threshold {weak} --field excitation.lines=2:402"));
    let number = |name: &str| column(&csv, name)[0].parse::<f64>().unwrap();
    let crossings = |lines: f64| {
        column(&stdout(&format!("sweep {weak} --over excitation.lines={lines}")), "crossings")[0]
            .parse::<u64>()
            .unwrap()
    };
    assert!(number("value").fract() == 0.0 && crossings(number("value")) > 0, "{csv}");
    assert!(number("low") == number("value") - 1.0 && crossings(number("low")) == 0, "{csv}");
    // the end of the range is tried where no step meets it
    let still = "random-shaking --set run.duration_s=2 --set excitation.rms_g=0.01 --quiet";
    let csv = stdout(&format!("threshold {still} --field excitation.seed=1:402"));
    assert_eq!(csv, "of,value,low,high,undecided,windows,step,resolution\ncrossing,,402,,false,,,\n");
}

/// The time of `--until-settled` is checked by the drive and the window alone: the mechanism may be one that
/// only the grid or the design makes possible.
#[test]
fn waiting_needs_no_mechanism_that_is_never_run() {
    let too_much = "threshold paper --set mechanism.preload_mm=30 --over mechanism.preload_mm=2.7 \
                    --field excitation.amplitude_g=0.6:0.8:0.1 --quiet";
    let no_well = "best nominal-cubic --set mechanism.cubic_n_per_m3=-1e5 \
                   --over mechanism.cubic_n_per_m3=8e5:9e5:1e5 --set run.duration_s=4 --set run.settle_s=2 \
                   --quiet";
    for line in [too_much, no_well] {
        let rows = stdout(&format!("{line} --until-settled 300"));
        assert_eq!(rows.lines().count(), 2, "{rows}");
    }
}

#[test]
fn where_melnikov_does_not_apply_a_remark_says_what_it_needs() {
    let line = "threshold paper --field excitation.amplitude_g=0:1.5:0.5 --melnikov";
    let words = contains("the row has no melnikov_g: it needs linear damping");
    headless(line).assert().success().stderr(words);
}

#[test]
fn all_wrong_cells_of_thresholds_are_named() {
    let line = "threshold nominal-cubic --over mechanism.cubic_n_per_m3=1e6,-1e5,8e5,-2e5 --quiet";
    for jobs in [1, 3] {
        let assert = headless(&format!("{line} --jobs {jobs}")).assert().code(2).stdout("");
        let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        let cells: Vec<&str> = text.lines().filter(|line| line.contains("in the cell")).collect();
        assert_eq!(
            cells,
            ["error: in the cell cubic_n_per_m3 = -100000:", "in the cell cubic_n_per_m3 = -200000:"]
        );
        assert!(text.contains("damping.xi = 0.023"), "{text}");
    }
    // of many the first ones, and how many more
    let many = "threshold nominal-cubic --over mechanism.cubic_n_per_m3=-30:-1:1 --quiet";
    headless(many).assert().code(2).stderr(predicates::str::contains("and 22 more cells are wrong"));
    // the same bytes for any number of threads, and a map of them
    let line = "threshold nominal-cubic --over stops.travel_limit_mm=1:5:2 --over mass_g=14,16 --quiet";
    assert_eq!(stdout(&format!("{line} --jobs 1")), stdout(&format!("{line} --jobs 3")));
}

#[test]
fn a_barrier_that_is_not_between_the_stops_is_the_reason() {
    let beyond = "--set stops=Uneven(left_mm:-1,right_mm:3,restitution_left:0.4)";
    let checked = stdout(&format!("check nominal-cubic {beyond}"));
    assert!(checked.contains("rigid stops: left at 1 mm with restitution 0.4; right at 3 mm"), "{checked}");
    assert!(checked.contains("the barrier does not lie between the stops"), "{checked}");
    assert!(!checked.contains("least amplitude that crosses"), "{checked}");
    let scan = "--field excitation.amplitude_g=0.5:1:0.25 --set run.duration_s=2";
    for (scene, why) in [
        (format!("nominal-cubic {beyond}"), "no barrier lies between the stops, so nothing to cross"),
        ("monostable".to_owned(), "there is no barrier between two wells, so nothing to cross"),
    ] {
        let output = headless(&format!("threshold {scene} {scan} --out /dev/null")).assert().success();
        let said = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
        assert!(said.contains(&format!("the row has no value: {why}")), "{said}");
    }
    // a stop at 0 is written without a sign
    let swept = "sweep nominal-cubic --set stops=Uneven(left_mm:0,right_mm:9,restitution_left:0.4) \
                 --set run.duration_s=2 --over stops.left_mm=-1:1:0.5 --columns min_x_m --quiet";
    let csv = stdout(swept);
    assert_eq!(column(&csv, "left_mm"), ["-1", "-0.5", "0", "0.5", "1"]);
    assert!(!csv.contains("-0,") && !csv.contains("-0\n"), "{csv}");
}
