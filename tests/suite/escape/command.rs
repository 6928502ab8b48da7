//! The commands `escape` and `threshold --probability`: columns, ends, the same bytes for any number of
//! threads, and what a row means.

use std::path::Path;

use crate::cli::{column, headless, stdout};

const COLUMNS: &str = "runs,escaped,ended_early,observed_s,escape_rate_per_s,escape_rate_low_per_s,\
                       escape_rate_high_per_s,mean_first_passage_s,mean_first_passage_low_s,\
                       mean_first_passage_high_s,median_first_passage_s,kramers_rate_per_s,kramers_fails";

/// `nominal-cubic` under a noise of this root mean square in g.
fn scene(rms: f64) -> String {
    format!("nominal-cubic --set excitation=Noise(rms_g:{rms},low_hz:0.5,high_hz:10,seed:5,lines:32)")
}

fn number(csv: &str, name: &str) -> f64 {
    column(csv, name)[0].parse().unwrap()
}

#[test]
fn cells_have_the_same_bytes_for_any_threads_and_are_those_of_their_scene() {
    let line = format!("escape {} --within 4 --runs 12 --quiet", scene(1.0));
    let over = "--over excitation.rms_g=0.001,1,60 --over mass_g=15.2,20";
    let text = stdout(&format!("{line} {over} --jobs 1"));
    assert_eq!(stdout(&format!("{line} {over} --jobs 2")), text);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines[0], lines.len()), (format!("rms_g,mass_g,{COLUMNS}").as_str(), 7));
    // no run escapes: a rate of 0 with an upper end, and no mean time but its lower end
    let quiet: Vec<&str> = lines[1].split(',').collect();
    let high = 40_f64.ln() / 48.0;
    assert_eq!(quiet[..8], ["1e-3", "15.2", "12", "0", "0", "48", "0", "0"]);
    assert!((quiet[8].parse::<f64>().unwrap() / high - 1.0).abs() < 1e-6);
    assert_eq!((quiet[9], quiet[11], quiet[12]), ("", "", ""));
    assert!((quiet[10].parse::<f64>().unwrap() * high - 1.0).abs() < 1e-6);
    // all runs escape: nothing is missing but Kramers' rate
    let loud: Vec<&str> = lines[5].split(',').collect();
    assert_eq!(loud[..5], ["60", "15.2", "12", "12", "0"]);
    assert!(loud[5].parse::<f64>().unwrap() < 48.0 && !loud[11].is_empty() && !loud[12].is_empty());
    assert_eq!(loud[13..], ["", "height"]);
    let alone = stdout(&line);
    assert!(lines[3].ends_with(alone.lines().nth(1).unwrap()), "{alone}");
}

#[test]
fn a_run_is_the_simulation_with_its_seed() {
    let (runs, within) = (6, 0.13);
    let line = format!("--within {within} --quiet --until crossing");
    let text = stdout(&format!("escape {} --runs {runs} {line}", scene(1.0)));
    let (mut observed, mut escaped) = (0.0, 0);
    for run in 0..runs {
        let seed = 5 + run;
        let scene = format!("{} --set excitation.seed={seed} --set run.duration_s={within}", scene(1.0));
        let events = stdout(&format!(
            "simulate {scene} --set run.settle_s=0 --at 0 --out /dev/null --events - --quiet"
        ));
        let first = events.lines().find(|line| line.contains(",crossing,"));
        let first: Option<f64> = first.map(|line| line.split(',').next().unwrap().parse().unwrap());
        observed += first.unwrap_or(within);
        escaped += u32::from(first.is_some());
    }
    assert_eq!(number(&text, "escaped"), f64::from(escaped));
    assert!((1..runs).contains(&escaped), "{escaped} of {runs} escaped");
    assert!((number(&text, "observed_s") / observed - 1.0).abs() < 1e-12, "{observed}: {text}");
    // the well lies behind the barrier
    let well = stdout(&format!("escape {} --runs {runs} --within {within} --quiet", scene(1.0)));
    assert!(number(&well, "escaped") <= f64::from(escaped));
    assert!(number(&well, "observed_s") > observed, "{well}");
}

#[test]
fn the_threshold_in_probability_is_where_that_share_escapes() {
    let options = "--field excitation.rms_g=0:4:0.02 --within 3 --runs 15 --quiet";
    let scene = format!("{} --set stops.restitution=0.3", scene(1.0));
    let line = format!("threshold {scene} {options}");
    for probability in [0.3_f64, 0.8] {
        let text = stdout(&format!("{line} --probability {probability} --jobs 2"));
        assert_eq!(stdout(&format!("{line} --probability {probability} --jobs 1")), text);
        assert_eq!(text.lines().next(), Some("of,probability,value,low,high,runs,crossed"));
        let value = number(&text, "value");
        let escaped = |rms: f64| {
            let escape = format!("escape {scene} --set excitation.rms_g={rms} --within 3 --runs 15");
            number(&stdout(&format!("{escape} --until crossing --quiet")), "escaped")
        };
        let needed = (15.0 * probability).ceil();
        assert!(escaped(value) >= needed && escaped(value - 0.02) < needed, "{value} of {probability}");
    }
    // of 15 runs, the interval of the share 0.5 lies between the 4th and the 12th
    let text = stdout(&format!("{line} --probability 0.5 --over mass_g=15.2,25"));
    let numbers =
        |name: &str| column(&text, name).iter().map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>();
    let (value, low, high) = (numbers("value"), numbers("low"), numbers("high"));
    assert!((0..2).all(|row| low[row] < value[row] && value[row] < high[row]), "{text}");
    // none crosses in the range, and few runs have no interval
    let none = format!("threshold {scene} --probability 0.5 --within 1 --runs 3 --quiet");
    let none = stdout(&format!("{none} --field excitation.rms_g=0:0.01"));
    assert!(none.ends_with("crossing,0.5,,,,3,0\n"), "{none}");
}

#[test]
fn melnikovs_threshold_stands_beside_the_one_of_the_runs() {
    let line = "threshold duffing --field excitation.amplitude_g=0:0.1:0.05 --melnikov --quiet \
                --set run.duration_s=60 --set run.settle_s=30 --until-settled 60";
    let text = stdout(&format!("{line} --over excitation.frequency_hz=0.1,0.2"));
    let found = column(&text, "melnikov_g");
    for (cell, frequency) in found.iter().zip([0.1, 0.2]) {
        let w = std::f64::consts::TAU * frequency;
        let exact = 4.0 * 0.3 * (0.5 * std::f64::consts::PI * w).cosh()
            / (3.0 * 2_f64.sqrt() * std::f64::consts::PI * w);
        assert!((cell.parse::<f64>().unwrap() * 9.806_65 / exact - 1.0).abs() < 1e-8, "{cell}");
    }
}

#[test]
fn pictures_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |line: &str, name: &str| {
        let path = folder.path().join(name);
        headless(line).arg("--plot").arg(&path).assert().success();
        std::fs::read_to_string(Path::new(&path)).unwrap()
    };
    let escape = format!("escape {} --within 2 --runs 4 --quiet", scene(1.0));
    let rates = drawn(&format!("{escape} --over excitation.rms_g=0.01,0.5,1,2"), "rates.svg");
    assert!(rates.contains("escape rate (1/s)") && rates.contains("no escape: rate below"), "{rates}");
    let chance = format!("threshold {} --field excitation.rms_g=0:4:0.1 --within 2", scene(1.0));
    let chance = format!("{chance} --runs 9 --probability 0.5 --over mass_g=15,20 --quiet");
    let chance = drawn(&chance, "chance.svg");
    assert!(chance.contains("50 % of the runs") && chance.contains("95 % interval"), "{chance}");
}
