//! Options that several commands share: their places, and files that they never overwrite.

use predicates::prelude::*;
use predicates::str::{contains, starts_with};

use super::{headless, plain, stdout};

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
    headless("--quiet presets").assert().success();
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
    // What stands before the command counts first: a later --set of the same field wins, and none is
    // forgotten.
    let line = format!("--set mass_g=12 --tolerance 1e-6 --quiet --jobs 2 --set run.settle_s=0.5 | {over}");
    assert_eq!(rows(&line), right);
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
fn help_lists_no_option_that_a_command_does_not_use() {
    for (command, unused) in [
        ("presets", &["--set", "--tolerance", "--jobs"][..]),
        ("merge", &["--set", "--tolerance", "--jobs"]),
        ("identify", &["--set", "--tolerance", "--jobs"]),
        ("lesson", &["--set", "--tolerance"]),
        ("simulate", &["--jobs"]),
        ("check", &["--jobs"]),
        ("sweep", &[]),
        ("basins", &[]),
    ] {
        let text = stdout(&format!("{command} --help"));
        for option in ["--set", "--tolerance", "--jobs"] {
            let line = text.lines().any(|line| line.trim_start().starts_with(&format!("{option} ")));
            assert_eq!(line, !unused.contains(&option), "{command} {option}");
        }
    }
}

#[test]
fn zero_has_no_sign_in_any_output() {
    let folder = tempfile::tempdir().unwrap();
    let summary = folder.path().join("summary.json");
    let mut command =
        headless("simulate elastic-box --set start.v_m_per_s=-0 --set start.x_mm=-0 --at 0,0.1");
    let output = command.arg("--summary").arg(&summary).assert().success().get_output().stdout.clone();
    let samples = String::from_utf8(output).unwrap();
    assert!(samples.contains("\n0,0,0,"), "{samples}");
    let summary = std::fs::read_to_string(&summary).unwrap();
    // the scene that ran is told as it was written
    let (results, _) = summary.split_once("\"scene\":").unwrap();
    let no_sign = !samples.contains("-0,") && !results.contains("-0.0");
    assert!(no_sign, "{samples}{summary}");
}
