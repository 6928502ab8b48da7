//! Commands that write the same files at once: one after the other, or refused, and never mixed.

use std::fs;
use std::path::Path;
use std::process::{Child, Command as Process, Stdio};

use interwell::system::checksum::file_checksum;
use proptest::prelude::*;
use serde_json::Value;

use super::{headless, refused};
use crate::properties::harness::hold_for;

/// Short calls that write rows, some with files beside them.
const CALLS: [&str; 9] = [
    "simulate elastic-box --set run.duration_s=0.5 --events e.csv --summary s.json",
    "simulate bouncing-ball --set run.duration_s=1 --plot p.svg",
    "sweep nominal-cubic --over mass_g=15,16 --set run.duration_s=2 --set run.settle_s=1 --plot p.svg",
    "curve nominal-cubic --range-mm -1:1 --points 5 --landscape s.json",
    "section duffing --set run.duration_s=200 --set run.settle_s=100",
    "spectrum duffing --set run.duration_s=200 --set run.settle_s=100 --plot p.svg",
    "exponents duffing --periods 5 --over excitation.amplitude_g=0.02",
    "basins duffing --x-mm 0:1:2 --v 0:0.1:2 --attractors e.csv",
    "orbit duffing",
];

fn start(folder: &Path, line: &str) -> Child {
    let mut command = Process::new(assert_cmd::cargo::cargo_bin!("interwell"));
    command
        .arg("--headless")
        .args(line.split_whitespace())
        .args(["--quiet", "--jobs", "1", "--out", "a.csv"]);
    command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.collect()
}

#[test]
fn rows_and_manifest_are_of_one_command_however_many_write_them() {
    let drawn = proptest::collection::vec((0..CALLS.len(), 1..9_u32), 2..4);
    let check = |calls: &Vec<(usize, u32)>| {
        let folder = tempfile::tempdir().unwrap();
        let line = |(call, tolerance): &(usize, u32)| format!("{} --tolerance {tolerance}e-7", CALLS[*call]);
        let started: Vec<Child> = calls.iter().map(|call| start(folder.path(), &line(call))).collect();
        let mut refusals = 0;
        for child in started {
            let end = child.wait_with_output().unwrap();
            let said = String::from_utf8_lossy(&end.stderr).into_owned();
            let is_refused = end.status.code() == Some(2) && said.contains("another process is writing");
            prop_assert!(end.status.success() || is_refused, "{said}");
            refusals += usize::from(is_refused);
        }
        prop_assert!(refusals < calls.len());
        let rows = folder.path().join("a.csv");
        let manifest: Value =
            serde_json::from_slice(&fs::read(folder.path().join("a.csv.json")).unwrap()).unwrap();
        prop_assert_eq!(manifest["sha256"].as_str(), Some(&*file_checksum(&rows).unwrap()));
        for name in names(folder.path()) {
            prop_assert!(!name.contains("part"), "{name} is left");
        }
        Ok(refusals > 0)
    };
    hold_for("at once", 40, 0.02, drawn, |calls| format!("{calls:?}"), check);
}

#[test]
fn each_file_that_is_being_written_refuses_every_command() {
    for line in CALLS {
        let folder = tempfile::tempdir().unwrap();
        let words: Vec<&str> = line.split_whitespace().collect();
        let others = words.iter().filter(|word| ["e.csv", "s.json", "p.svg"].contains(word));
        for name in others.chain(&["a.csv", "a.csv.json"]) {
            let path = folder.path().join(format!("{name}.part.journal"));
            let lock = fs::File::create(&path).unwrap();
            lock.lock().unwrap();
            let command = || {
                let mut command = headless(line);
                command.current_dir(folder.path()).args(["--out", "a.csv", "--quiet"]);
                command
            };
            refused(command(), &["another process is writing", name, "wait for it, or name another file"]);
            assert_eq!(names(folder.path()), [format!("{name}.part.journal")], "{line}");
            // what a killed process leaves locks nothing, and the next one takes it away
            drop(lock);
            command().assert().success();
            assert!(!path.exists(), "{line} leaves {}", path.display());
            names(folder.path()).iter().for_each(|name| fs::remove_file(folder.path().join(name)).unwrap());
        }
    }
}

#[cfg(unix)]
#[test]
fn a_killed_command_leaves_no_lock() {
    let folder = tempfile::tempdir().unwrap();
    let mut long = start(folder.path(), "simulate elastic-box --set run.duration_s=1e6 --dt 1");
    while !folder.path().join("a.csv.json.part.journal").exists() {
        assert_eq!(long.try_wait().unwrap(), None, "it ended before it was killed");
        std::thread::yield_now();
    }
    let second = start(folder.path(), CALLS[0]).wait().unwrap();
    assert_eq!(second.code(), Some(2));
    long.kill().unwrap();
    long.wait().unwrap();
    assert!(start(folder.path(), CALLS[0]).wait().unwrap().success());
    let left = |name: &&String| name.ends_with(".journal");
    assert_eq!(names(folder.path()).iter().find(left), None);
}
