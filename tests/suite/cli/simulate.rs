//! The command `simulate`: samples, events, summaries, early ends and scenes from standard input.

use std::path::Path;

use predicates::str::{contains, starts_with};

use super::{column, headless, refused, stdout};

#[test]
fn simulate_samples() {
    let text = stdout("simulate elastic-box --dt 0.1 --set run.duration_s=1");
    assert_eq!(text.lines().next().unwrap(), "t_s,x_m,v_m_per_s,base_accel_m_per_s2,phase");
    let t = ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1"];
    assert_eq!(column(&text, "t_s"), t);
    // 0.05 m/s from the middle: at the wall, and already on the way back, after 0.2 s.
    assert_eq!(column(&text, "v_m_per_s")[1..3], ["0.05", "-0.05"]);
    let text = stdout("simulate elastic-box --at 0.3,0,0.1");
    assert_eq!(column(&text, "t_s"), ["0.3", "0", "0.1"]);
    let text = stdout("simulate --set run.duration_s=1 --set run.settle_s=0");
    assert_eq!(column(&text, "t_s").len(), 181);
    assert_eq!(column(&text, "phase")[0], "right_stop");
    assert_eq!(column(&stdout("simulate bouncing-ball"), "t_s").len(), 1001);
}

#[test]
fn the_distance_of_two_runs_is_drawn_and_the_rows_stay_those_of_the_first() {
    let folder = tempfile::tempdir().unwrap();
    let [plot, data] = ["d.svg", "d.csv"].map(|name| folder.path().join(name));
    let line = "simulate elastic-box --set run.duration_s=1";
    let drawn = |beside: &str| {
        let mut command =
            headless(&format!("{line} --plot {} --plot-data {}", plot.display(), data.display()));
        let rows = command.args(["--beside", beside]).assert().success().get_output().stdout.clone();
        assert_eq!(String::from_utf8(rows).unwrap(), stdout(line));
        std::fs::read_to_string(&data).unwrap()
    };
    // a link: from the middle twice as fast, 0.05 m apart after 0.1 s for each m/s; --set leaves it as it is
    let link = "check elastic-box --set start.v_m_per_s=0.06 --link --out -";
    let link = stdout(link).lines().find(|line| line.starts_with("?scene=")).unwrap().to_owned();
    let text = drawn(&link);
    assert_eq!(text.lines().next().unwrap(), "series,t_s,distance_m,motion");
    let (times, apart) = (column(&text, "t_s"), column(&text, "distance_m"));
    let at = times.iter().position(|t| t == "0.1").unwrap();
    assert!((apart[at].parse::<f64>().unwrap() - 0.001).abs() < 1e-12, "{}", apart[at]);
    assert!(text.lines().skip(1).all(|line| line.starts_with("distance,") && line.ends_with(",A")));
    assert!(
        std::fs::read_to_string(&plot).unwrap().contains("A: built-in elastic-box, start.v_m_per_s=0.06")
    );
    let wrong = folder.path().join("wrong.ron");
    std::fs::write(&wrong, "(mass_g: 0, mechanism: Linear(n_per_m: 4), run: (duration_s: 1))").unwrap();
    let name = format!("--beside {}:1:2: mass_g = 0", wrong.display());
    refused(
        headless(&format!("curve paper --beside {} --mechanism-plot {}", wrong.display(), plot.display())),
        &[&name],
    );
}

#[test]
fn simulate_events_and_summary() {
    let folder = tempfile::tempdir().unwrap();
    let (events, summary) = (folder.path().join("e.csv"), folder.path().join("s.json"));
    let line = "simulate bouncing-ball --out /dev/null --set mass_g=500 --tolerance 1e-10";
    headless(line).arg("--events").arg(&events).arg("--summary").arg(&summary).assert().success();
    let events = std::fs::read_to_string(events).unwrap();
    assert_eq!(events.lines().next().unwrap(), "t_s,kind,side,v_in_m_per_s,v_out_m_per_s");
    assert_eq!(column(&events, "kind")[0], "impact");
    let rest = events.lines().find(|line| line.contains(",rest,")).unwrap();
    assert!(rest.ends_with(",rest,left,0,0"), "{rest}");

    let value = json(&summary);
    let keys: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
    let expected = "final_x_m final_v_m_per_s rms_velocity_m_per_s regime crossings impacts releases \
        impact_speed_max_m_per_s max_abs_x_m min_x_m max_x_m travel_m mean_x_m side impact_share \
        rested_share settled steady settles_at_s window_from_s window_to_s periods crossing_periods \
        release_periods total_crossings total_impacts chatter_sums rests period outcome steps \
        evaluations energy_residual cpu_s ledger scene version arguments seed wall_s";
    assert_eq!(keys.join(" "), expected);
    assert_eq!(value["outcome"], "done");
    assert_eq!(value["scene"]["mass_g"], 500.0);
    assert_eq!(value["scene"]["run"]["tolerance"], 1e-10);
    let ledger = value["ledger"].as_object().unwrap().keys().map(String::as_str).collect::<Vec<_>>();
    assert_eq!(ledger.join(" "), "work_j damping_j impact_j stored_j residual_j");
    assert!(value["energy_residual"].as_f64().unwrap() < 1e-9);
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn a_run_that_ends_early_writes_what_it_has() {
    // Without stops and shaken hard, the mass leaves the table.
    let line =
        "simulate --set stops=None --set excitation.amplitude_g=40 --summary - --out /dev/null --quiet";
    let assert = headless(line).assert().success().stderr(contains("left_table"));
    let value: serde_json::Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    assert_eq!(value["outcome"], "left_table");
    let end = value["ended_at_s"].as_f64().unwrap();
    let samples = stdout("simulate --set stops=None --set excitation.amplitude_g=40 --dt 1e-3");
    let last: f64 = column(&samples, "t_s").last().unwrap().parse().unwrap();
    assert!(last <= end && end < last + 2e-3, "{last} {end}");
    let row = "sweep --set stops=None --over excitation.amplitude_g=0,40";
    let rows = stdout(row);
    assert_eq!(column(&rows, "outcome"), ["done", "left_table"]);
}

#[test]
fn the_last_line_says_that_a_run_ended_early_and_strict_fails() {
    let folder = tempfile::tempdir().unwrap();
    let line = "simulate --set stops=None --set excitation.amplitude_g=40 --out";
    for (strict, code) in [("", 0), ("--strict", 1)] {
        let path = folder.path().join(format!("run{strict}.csv"));
        let mut command = headless(line);
        let output = command.arg(&path).args(strict.split_whitespace()).output().unwrap();
        assert_eq!(output.status.code(), Some(code));
        let said = String::from_utf8(output.stderr).unwrap();
        let last = said.lines().last().unwrap();
        for word in
            ["built-in paper", "ended early at t = 0.", "left_table", "left the range of the force curve"]
        {
            assert!(last.contains(word), "`{word}` is not in: {said}");
        }
        assert!(std::fs::read_to_string(&path).unwrap().lines().count() > 1);
    }
    headless("simulate --strict --out /dev/null --set run.duration_s=1 --set run.settle_s=0")
        .assert()
        .success();
}

#[test]
fn a_duration_that_is_set_takes_the_settle_time_along() {
    for line in ["simulate", "check", "sweep --over mass_g=15"] {
        let assert = headless(&format!("{line} --set run.duration_s=4")).assert().success();
        let output = assert.get_output();
        let said = [&output.stdout[..], &output.stderr[..]].concat();
        let said = String::from_utf8_lossy(&said).into_owned();
        assert!(said.contains("run.settle_s = 5 lies beyond --set run.duration_s=4"), "{line}: {said}");
    }
    let value: serde_json::Value =
        serde_json::from_str(&stdout("simulate --set run.duration_s=4 --out /dev/null --summary - --quiet"))
            .unwrap();
    assert!(value["rms_velocity_m_per_s"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_scene_comes_through_a_pipe() {
    let text =
        "(mass_g: 1000, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), run: (duration_s: 1))";
    for command in ["check -", "simulate - --at 0", "curve - --at-mm 0", "sweep - --over mass_g=1"] {
        headless(command).write_stdin(text).assert().success();
    }
    headless("check -").write_stdin(text).assert().stdout(starts_with("standard input: standard input\n"));
    let mut wrong = headless("check -");
    wrong.write_stdin(text.replace("1000", "0"));
    refused(wrong, &["standard input:1:2: mass_g = 0"]);
}
