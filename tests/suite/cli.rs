//! Does the command line do what its page says: every command, option, column and exit status?

mod accuracy;
mod bad_input;
mod flexure_numbers;
mod flexures;
mod outputs;
mod verdicts;

use std::path::Path;

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::{contains, starts_with};

/// The program with these arguments, given in one line.
pub fn plain(line: &str) -> Command {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("interwell");
    command.args(line.split_whitespace());
    command
}

/// The same without a window.
pub fn headless(line: &str) -> Command {
    let mut command = plain("--headless");
    command.args(line.split_whitespace());
    command
}

/// What a command that succeeds writes to standard output.
pub fn stdout(line: &str) -> String {
    let output = headless(line).assert().success().get_output().stdout.clone();
    String::from_utf8(output).unwrap()
}

/// Asserts exit status 2, nothing on standard output and a message of few lines holding all of `words`.
pub fn refused(mut command: Command, words: &[&str]) {
    let assert = command.assert().code(2).stdout("");
    let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(text.starts_with("error: ") && text.lines().count() <= 4, "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
}

fn column(csv: &str, name: &str) -> Vec<String> {
    let mut lines = csv.lines();
    let place = lines.next().unwrap().split(',').position(|own| own == name).unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().to_owned()).collect()
}

#[test]
fn without_headless_it_says_what_to_write() {
    for line in ["", "paper"] {
        // as on a machine without a display
        let mut command = plain(line);
        ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].iter().for_each(|name| {
            command.env_remove(name);
        });
        let status = if cfg!(feature = "app") { 1 } else { 2 };
        let assert = command.assert().code(status).stdout("");
        let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(text.contains("--headless") && text.lines().count() == 1, "{text}");
    }
    for command in ["presets", "check", "curve", "simulate", "sweep", "accuracy"] {
        refused(plain(command), &["--headless", command]);
    }
    refused(plain("--headless"), &["presets, check, curve, simulate, sweep, threshold or accuracy"]);
    refused(headless("swep"), &["`swep`", "sweep"]);
    refused(headless("sweep --bogus"), &["--bogus"]);
    refused(headless("check --plot a.png"), &["--plot"]);
    refused(plain("paper --headless sweep"), &["after"]);
}

#[test]
fn help_and_version() {
    plain("--version").assert().success().stdout(format!("interwell {}\n", env!("CARGO_PKG_VERSION")));
    let all = ["presets", "check", "curve", "simulate", "sweep", "accuracy", "Examples", "Exit status"];
    for word in all {
        plain("--help").assert().success().stdout(contains(word));
    }
    for word in ["--out", "--set", "--tolerance", "--jobs", "--quiet", "--over", "--plot", "--dark"] {
        headless("sweep --help").assert().success().stdout(contains(word));
    }
}

#[test]
fn presets_are_listed_a_line_each() {
    let text = stdout("presets");
    for name in ["paper", "paper-ramp", "nominal-cubic", "bouncing-ball", "elastic-box", "duffing"] {
        let own = text.lines().filter(|line| line.split_whitespace().next() == Some(name));
        assert_eq!(own.count(), 1, "{name}");
    }
}

#[test]
fn presets_are_copied_out_and_work_there() {
    let folder = tempfile::tempdir().unwrap();
    let write = |more: &str| headless(&format!("presets --write {} {more}", folder.path().display()));
    write("").assert().success();
    assert!(folder.path().join("force_dl2.7.csv").is_file());
    // Again: the same files are no reason to refuse.
    write("").assert().success();
    let paper = folder.path().join("paper.ron");
    let line = format!("curve {} --at-mm 3", paper.display());
    assert_eq!(stdout(&line), stdout("curve --at-mm 3"));

    std::fs::write(&paper, "mine").unwrap();
    refused(write(""), &["paper.ron", "--force"]);
    assert_eq!(std::fs::read_to_string(&paper).unwrap(), "mine");
    write("--force").assert().success();
    assert_ne!(std::fs::read_to_string(&paper).unwrap(), "mine");
    refused(headless("presets --write /no/such/folder"), &["/no/such/folder"]);
}

#[test]
fn check_says_what_is_modelled() {
    let text = stdout("check");
    for word in ["paper", "left out", "force curve", "k = ", "c = ", "equilibrium", "barrier"] {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
    // All are reported, and one that is wrong makes it fail.
    let check = headless("check elastic-box no-such-scene duffing also-none").assert().code(2);
    let check = check.stdout(contains("elastic-box").and(contains("duffing")));
    check.stderr(contains("no-such-scene").and(contains("also-none")));
    refused(headless("check --set stops.restitution=1.2"), &["stops.restitution", "1.2"]);
}

#[test]
fn curve_rows_and_columns() {
    let text = stdout("curve --at-mm -3,0,3");
    assert_eq!(text.lines().next().unwrap(), "x_m,force_n,potential_j,stiffness_n_per_m");
    assert_eq!(column(&text, "x_m"), ["-0.003", "0", "0.003"].map(short_form));
    let force = column(&text, "force_n");
    assert_eq!(format!("-{}", force[0]), force[2]);
    assert_eq!(column(&text, "potential_j")[1], "0");

    let text = stdout("curve --range-mm -8:8 --points 401");
    let x = column(&text, "x_m");
    assert_eq!((x.len(), &x[0][..], &x[200][..], &x[201][..]), (401, "-8e-3", "0", "4e-5"));
    assert_eq!(column(&stdout("curve duffing"), "x_m").len(), 401);
    assert_eq!(column(&stdout("curve paper --points 5"), "x_m").len(), 5);
    refused(headless("curve --at-mm 9"), &["9 mm", "-8.2559", " to 8.2559"]);
    for bad in ["--at-mm nan", "--at-mm x", "--at-mm ,", "--range-mm 3:-3", "--range-mm 3", "--points 1"] {
        refused(headless(&format!("curve {bad}")), &[]);
    }
    refused(headless("curve --at-mm 3 --points 4"), &["--points"]);
}

fn short_form(text: &str) -> String {
    let mut short = String::new();
    interwell::output::push_number(&mut short, text.parse().unwrap());
    short
}

#[test]
fn landscape_of_a_double_well() {
    let text = stdout("curve nominal-cubic --landscape - --out /dev/null");
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    let equilibria = value["equilibria"].as_array().unwrap();
    assert_eq!(equilibria.len(), 3);
    let right = &equilibria[2];
    assert!((right["x_m"].as_f64().unwrap() - 0.007).abs() < 1e-12);
    assert!((right["frequency_hz"].as_f64().unwrap() - 11.546).abs() < 1e-3);
    assert!(equilibria[1]["frequency_hz"].is_null() && equilibria[1]["stable"] == false);
    assert!((value["barrier"]["height_j"].as_f64().unwrap() - 4.9e-4).abs() < 1e-9);
    assert_eq!(value["force_extrema"].as_array().unwrap().len(), 2);
    assert!(value["kinks"].as_array().unwrap().is_empty());
}

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
    for bad in ["--at 10.1", "--at -1", "--at nan", "--at 1,,2", "--dt 0", "--dt -1", "--dt x", "--dt nan"] {
        refused(headless(&format!("simulate {bad}")), &[]);
    }
    refused(headless("simulate --dt 1e-9"), &["10000000001", "--dt"]);
    refused(headless("simulate --at 1 --dt 1"), &["--dt"]);
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
        impact_speed_max_m_per_s max_abs_x_m min_x_m max_x_m travel_m mean_x_m side impact_share rested_share settled \
        settles_at_s window_from_s window_to_s periods crossing_periods release_periods total_crossings total_impacts \
        chatter_sums rests period outcome steps evaluations energy_residual cpu_s ledger scene version arguments seed \
        wall_s";
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
    refused(headless("sweep --strict"), &["--strict"]);
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

#[test]
fn sweep_rows_and_columns() {
    let line = "sweep --over stops.travel_limit_mm=1:2:0.5 --over excitation.amplitude_g=0.58,0 --quiet";
    let text = stdout(line);
    let header = "travel_limit_mm,amplitude_g,rms_velocity_m_per_s,regime,crossings,impacts,max_abs_x_m,period,outcome";
    assert_eq!(text.lines().next().unwrap(), header);
    assert_eq!(column(&text, "travel_limit_mm"), ["1", "1", "1.5", "1.5", "2", "2"]);
    assert_eq!(column(&text, "amplitude_g"), ["0.58", "0", "0.58", "0", "0.58", "0"]);
    assert_eq!(column(&text, "regime"), ["interwell", "rest", "rest", "rest", "rest", "rest"]);
    assert!(column(&text, "outcome").iter().all(|outcome| outcome == "done"));
    headless(line).assert().stderr("");

    for jobs in ["1", "2", "3"] {
        assert_eq!(stdout(&format!("{line} --jobs {jobs}")), text, "--jobs {jobs}");
    }
    // A swept mechanism: each row is what the scene alone gives.
    let two = stdout("sweep nominal-cubic --over mechanism.linear_n_per_m=-40,-30 --over mass_g=15,16");
    let alone = stdout("sweep nominal-cubic --set mechanism.linear_n_per_m=-30 --over mass_g=16");
    assert_eq!(column(&two, "rms_velocity_m_per_s")[3..], column(&alone, "rms_velocity_m_per_s"));
}

#[test]
fn the_scenes_own_sweep_is_the_map() {
    let line = "sweep paper --set run.duration_s=0.5 --set run.settle_s=0 --tolerance 1e-3 --quiet";
    let text = stdout(line);
    assert!(text.starts_with("travel_limit_mm,amplitude_g,"));
    assert!(text.lines().count() > 1000);
}

#[test]
fn sweeps_that_cannot_be_are_refused() {
    refused(headless("sweep elastic-box"), &["--over"]);
    let many = "sweep --over mass_g=1:1000000:1 --over stops.travel_limit_mm=1:1000000:1";
    refused(headless(many), &["1000000000000", "cells"]);
    refused(headless("sweep --over mass_g=1:1e12:1"), &["1000000000000"]);
    refused(headless("sweep --over stops.restitution=0:1.2:0.4"), &["stops.restitution", "1.2"]);
    refused(headless("sweep --over stops.travel_limit_mm=2:1:0.5"), &["stops.travel_limit_mm"]);
    refused(headless("sweep --over stops.travel_limit_mm=1:2:0"), &["stops.travel_limit_mm"]);
    refused(headless("sweep --over stops.none=1:2:1"), &["stops.none", "stops.travel_limit_mm"]);
    refused(headless("sweep --over mass_g=1,2 --over mass_g=1,2"), &["mass_g"]);
    refused(headless("sweep --over mass_g=1,2 --jobs 0"), &["--jobs"]);
    // A cell that has no place to rest, in the middle of a grid that is valid at its corners.
    let start = "sweep nominal-cubic --over mechanism.linear_n_per_m=-40,40 --over mechanism.cubic_n_per_m3=1e5,-1e5,1e6";
    refused(headless(start), &["linear_n_per_m = -40", "cubic_n_per_m3 = -100000"]);
}

#[test]
fn options_stand_anywhere_and_values_may_be_negative() {
    let right = stdout("curve paper --at-mm -1 --quiet");
    for line in
        ["--quiet curve --at-mm -1", "curve --at-mm=-1 paper --quiet", "curve --quiet --at-mm -1 paper"]
    {
        assert_eq!(stdout(line), right, "{line}");
    }
    let mut after = plain("curve --at-mm -1 --headless");
    after.assert().success().stdout(right);
    let shifted = "simulate elastic-box --set start.x_mm=-3 --at 0";
    headless(shifted).assert().success().stdout(contains("\n0,-0.003,").or(contains("\n0,-3e-3,")));
    headless("presets --out -").assert().success().stdout(starts_with("first-look"));
}

#[test]
fn common_options_may_stand_before_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |line: &str| {
        let path = folder.path().join("rows.csv");
        let (before, after) = line.split_once(" | ").unwrap();
        let mut command = headless(before);
        command.arg("--out").arg(&path).args(after.split_whitespace());
        command.assert().success().stdout("").stderr("");
        std::fs::read_to_string(&path).unwrap()
    };
    let over =
        "sweep nominal-cubic --over excitation.amplitude_g=0.5,1 --set run.duration_s=2 --set run.settle_s=1";
    let right = rows(&format!("--quiet | {over} --set mass_g=12 --tolerance 1e-6 --jobs 2"));
    // What stands before the command counts first: a later --set of the same field wins, and none is forgotten.
    let line = format!("--set mass_g=12 --tolerance 1e-6 --quiet --jobs 2 --set run.settle_s=0.5 | {over}");
    assert_eq!(rows(&line), right);
    refused(headless("--jobs 2 curve --jobs 1"), &["--jobs", "before and after"]);
    refused(headless("--out a curve --out b"), &["--out", "before and after"]);
    refused(plain("--quiet"), &["--quiet", "command"]);
    refused(plain("paper --set mass_g=1"), &["--set", "command"]);
}

#[test]
fn presets_take_no_option_of_a_run() {
    for line in ["presets --set a=b", "--tolerance 1e-6 presets", "presets --jobs 2"] {
        refused(headless(line), &["presets"]);
    }
    headless("--quiet presets").assert().success();
}

#[test]
fn a_table_that_a_scene_reads_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.csv"), "x_m,force_n\n-2,-6\n-1,0\n0,0\n1,0\n2,6\n").unwrap();
    let scene = "(title: \"t\", mass_g: 1, mechanism: Table(path: \"t.csv\"), run: (duration_s: 1))";
    std::fs::write(folder.path().join("s.ron"), scene).unwrap();
    let out = assert_cmd::Command::new(env!("CARGO_BIN_EXE_interwell"))
        .current_dir(folder.path())
        .args(["--headless", "curve", "s.ron", "--points", "3", "--out", "t.csv"])
        .output()
        .unwrap();
    assert_eq!(out.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&out.stderr).contains("would overwrite"));
    assert!(std::fs::read_to_string(folder.path().join("t.csv")).unwrap().ends_with("2,6\n"));
}

#[test]
fn a_sweep_judges_its_cells_and_not_the_scene_that_it_starts_from() {
    let run = |arguments: &[&str]| {
        assert_cmd::Command::new(env!("CARGO_BIN_EXE_interwell"))
            .args(["--headless", "sweep", "nominal-cubic", "--quiet"])
            .args(arguments)
            .output()
            .unwrap()
    };
    let outside = "start=At(x_mm:5,v_m_per_s:0)";
    let good = run(&["--set", outside, "--over", "stops.travel_limit_mm=6:8:1"]);
    assert_eq!(good.status.code(), Some(0), "{}", String::from_utf8_lossy(&good.stderr));
    assert_eq!(String::from_utf8_lossy(&good.stdout).lines().count(), 4);
    let bad = run(&["--set", outside, "--over", "stops.travel_limit_mm=4:8:1"]);
    assert_eq!(bad.status.code(), Some(2));
}
