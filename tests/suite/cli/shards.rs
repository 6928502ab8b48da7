//! Shards of a sweep, `merge`, and `--dry-run`: put together they are the bytes of one process.

use std::fs;
use std::path::Path;

use predicates::str::contains;

use super::{headless, refused, stdout};

const MAP: &str = "sweep nominal-cubic --quiet --set run.duration_s=0.2 --set run.settle_s=0 \
    --tolerance 1e-3 --over excitation.amplitude_g=0:2:0.01 --over stops.travel_limit_mm=1:3.5:0.5";

/// Computes these shards of so many into `p1.csv`, `p2.csv`, ..
fn shards(folder: &Path, line: &str, numbers: &[u32], count: u32) {
    for number in numbers {
        let line = format!("{line} --shard {number}/{count} --jobs 1 --out");
        headless(&line).arg(folder.join(format!("p{number}.csv"))).assert().success().stdout("");
    }
}

/// The command that merges these parts.
fn merge(folder: &Path, parts: &[&str], out: &str) -> assert_cmd::Command {
    let mut command = headless("merge --quiet");
    command.current_dir(folder).args(parts).args(["--out", out]);
    command
}

const FIVE: [&str; 5] = ["p4.csv", "p1.csv", "p5.csv", "p2.csv.json", "p3.csv"];

#[test]
fn five_shards_are_the_bytes_of_one_process() {
    let walks = MAP.replace("0:2:0.01", "0:0.9:0.1") + " --carry both";
    let few = MAP.replace("0:2:0.01", "1").replace("1:3.5:0.5", "1,2");
    for line in [MAP, &walks, &few] {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        shards(folder, line, &[1, 2, 3, 4, 5], 5);
        merge(folder, &FIVE, "map.csv").assert().success().stderr("");
        let one = folder.join("one.csv");
        headless(line).arg("--out").arg(&one).assert().success();
        assert!(fs::read(folder.join("map.csv")).unwrap() == fs::read(&one).unwrap(), "{line}");
        let json = |name: &str| -> serde_json::Value {
            serde_json::from_str(&fs::read_to_string(folder.join(name)).unwrap()).unwrap()
        };
        let (merged, one) = (json("map.csv.json"), json("one.csv.json"));
        for key in
            ["cells", "outcomes", "regimes", "mechanisms", "sha256", "plan", "shard", "scene_ron", "grid"]
        {
            assert_eq!(merged[key], one[key], "{key}");
        }
        assert_eq!(merged["data"], "map.csv");
        let check = |name: &str| headless("sweep --check --quiet").arg(folder.join(name)).assert().success();
        check("map.csv.json");
        check("p2.csv.json");
    }
}

#[test]
fn a_missing_shard_is_named_with_the_command_that_computes_it() {
    let folder = tempfile::tempdir().unwrap();
    shards(folder.path(), MAP, &[1, 2, 4], 5);
    let assert = merge(folder.path(), &["p1.csv", "p2.csv", "p4.csv", "p5.csv"], "map.csv").assert().code(2);
    let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(text.contains("p5.csv: no such file; 2 of 5 shards are missing"), "{text}");
    let commands: Vec<&str> = text.lines().skip(1).collect();
    assert_eq!(commands.len(), 2, "{text}");
    for command in commands {
        let words = shlex::split(command).unwrap();
        assert_eq!(words[0], "interwell");
        super::plain("").args(&words[1..]).current_dir(folder.path()).assert().success();
    }
    assert!(!folder.path().join("map.csv").exists());
    merge(folder.path(), &FIVE, "map.csv").assert().success();
    assert_eq!(fs::read_to_string(folder.path().join("map.csv")).unwrap(), stdout(MAP));
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let (folder, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let folder = folder.path();
    shards(folder, MAP, &[1, 2], 2);
    shards(other.path(), &format!("{MAP} --set mass_g=16"), &[2], 2);
    let path = |name: &str| folder.join(name).display().to_string();
    let foreign = other.path().join("p2.csv").display().to_string();
    let refuse = |parts: &[&str], words: &[&str]| refused(merge(folder, parts, "map.csv"), words);
    refuse(&["p1.csv", &foreign], &[&foreign, "p1.csv", "scene.mass_g is 16.0 there and 15.2 here"]);
    refuse(&["p1.csv", "p1.csv"], &["both the shard 1/2"]);
    refuse(&["none.csv"], &["none.csv: no such file", "manifest"]);
    let foreign = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml").display().to_string();
    refuse(&[&foreign], &["Cargo.toml: no manifest stands beside it"]);
    shards(other.path(), MAP, &[3], 3);
    let third = other.path().join("p3.csv").display().to_string();
    refuse(&["p1.csv", &third], &["shard 3/3", "1/2"]);
    let manifest = fs::read_to_string(path("p2.csv.json")).unwrap();
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    fs::write(path("p2.csv.json"), manifest.replace(&version, "\"version\": \"0.0.9\"")).unwrap();
    refuse(&["p1.csv", "p2.csv"], &["version is 0.0.9 there and"]);
    fs::write(path("p2.csv.json"), "{}").unwrap();
    refuse(&["p1.csv", "p2.csv"], &["p2.csv.json", "no manifest"]);
    fs::write(path("p2.csv.json"), &manifest).unwrap();

    let rows = fs::read(path("p2.csv")).unwrap();
    let mut flipped = rows.clone();
    flipped[rows.len() / 2] ^= 1;
    for wrong in [&flipped[..], &rows[..rows.len() / 2], &[&rows[..], b"1,2\n"].concat()] {
        fs::write(path("p2.csv"), wrong).unwrap();
        let words = contains("p2.csv is changed");
        merge(folder, &["p1.csv", "p2.csv"], "map.csv").assert().code(2).stderr(words);
        assert!(!folder.join("map.csv").exists() && !folder.join("map.csv.json").exists());
    }
    fs::write(path("p2.csv"), &rows).unwrap();
    refused(merge(folder, &["p1.csv", "p2.csv"], "p1.csv"), &["overwrite"]);
    merge(folder, &["p1.csv", "p2.csv"], "map.csv").assert().success();
}

#[test]
fn shards_are_numbered_by_an_array_job() {
    let folder = tempfile::tempdir().unwrap();
    let job = |options: &str| {
        let mut command = headless(&format!("{MAP} {options}"));
        let variables =
            ["SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN", "HQ_TASK_ID"];
        for name in variables {
            command.env_remove(name);
        }
        command.current_dir(folder.path());
        command
    };
    refused(job("--shard auto"), &["SLURM_ARRAY_TASK_ID", "HQ_TASK_ID"]);
    let mut same = job("--shard auto/2 --out map.csv");
    same.env("HQ_TASK_ID", "1");
    refused(same, &["{shard}", "map-{shard}.csv"]);
    for task in ["7", "8"] {
        let mut command = job("--shard auto --out map-{shard}.csv");
        command.env("SLURM_ARRAY_TASK_ID", task).env("SLURM_ARRAY_TASK_COUNT", "2");
        command.env("SLURM_ARRAY_TASK_MIN", "7").assert().success();
    }
    merge(folder.path(), &["map-1-of-2.csv", "map-2-of-2.csv"], "map.csv").assert().success();
    assert_eq!(fs::read_to_string(folder.path().join("map.csv")).unwrap(), stdout(MAP));
}

#[test]
fn a_dry_run_has_commands_that_work() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = headless(&format!("{MAP} --out a.csv --dry-run"));
    let output = command.current_dir(folder.path()).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(output).unwrap();
    assert!(text.starts_with("1206 rows: 201 amplitude_g x 6 travel_limit_mm; 9 columns\nabout "), "{text}");
    assert!(text.contains(" MB of memory"), "{text}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is written");
    let mut commands = Vec::new();
    for line in text.lines().filter_map(|line| line.strip_prefix("  interwell ")) {
        let all = "a-1-of-4.csv a-2-of-4.csv a-3-of-4.csv a-4-of-4.csv";
        commands.push(shlex::split(&line.replace("a-*-of-4.csv", all)).unwrap());
    }
    assert_eq!(commands.len(), 6, "{text}");
    for words in &commands {
        super::plain("").args(words).arg("--quiet").current_dir(folder.path()).assert().success();
    }
    assert_eq!(fs::read_to_string(folder.path().join("a.csv")).unwrap(), stdout(MAP));
}
