//! Outputs: whole or not at all, and refused before any work where they have no place.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command as Process, Stdio};

use predicates::str::contains;

use super::{headless, refused, stdout};

const QUICK: &str = "simulate elastic-box --set run.duration_s=1";

#[test]
fn a_file_is_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    fs::write(&path, "old").unwrap();
    headless(QUICK).arg("--out").arg(&path).assert().success().stdout("");
    assert_eq!(fs::read_to_string(&path).unwrap(), stdout(QUICK));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "only its manifest is beside it");
}

#[test]
fn two_outputs_need_two_places() {
    let folder = tempfile::tempdir().unwrap();
    headless(&format!("{QUICK} --out /dev/null --events /dev/null")).assert().success();
    // Nor may an output take the scene's own place.
    headless("presets --write").arg(folder.path()).assert().success();
    let scene = folder.path().join("duffing.ron");
    let mut command = headless("simulate");
    command.arg(&scene).arg("--out").arg(&scene);
    refused(command, &["overwrite"]);
}

#[test]
fn no_output_replaces_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    headless("presets --write").arg(folder.path()).assert().success();
    let (named, hidden) = (folder.path().join("duffing.ron"), folder.path().join("duffing.csv"));
    fs::copy(&named, &hidden).unwrap();
    let broken = folder.path().join("broken.RON");
    fs::write(&broken, "(title: ").unwrap();
    for scene in [&named, &hidden, &broken] {
        let before = fs::read(scene).unwrap();
        for line in [QUICK, "curve", "check", "sweep --over mass_g=15,16", "presets"] {
            let mut command = headless(line);
            command.arg("--out").arg(scene);
            refused(command, &["--out", "overwrite a scene"]);
        }
        let mut command = headless(QUICK);
        command.arg("--summary").arg(scene);
        refused(command, &["--summary", "overwrite a scene"]);
        assert_eq!(fs::read(scene).unwrap(), before);
    }
    // A file that is not there yet may be called so, and one that holds no scene is written as ever.
    headless(QUICK).arg("--out").arg(folder.path().join("new.ron")).assert().success();
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_and_a_read_only_place_fail() {
    for command in [QUICK, "curve", "check", "presets", "sweep --over mass_g=15,16"] {
        let full = headless(&format!("{command} --out /dev/full"));
        let mut full = full;
        full.assert().code(1).stderr(contains("/dev/full"));
    }
    headless(&format!("{QUICK} --out /dev/null --summary /dev/full")).assert().code(1);
    // No one, not even root, makes a file in /proc; the system's words come once, and no name but the one
    // asked for.
    let assert = headless(&format!("{QUICK} --out /proc/run.csv")).assert().code(1);
    let said = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(said.starts_with("error: cannot write /proc/run.csv: ") && !said.contains(".part"), "{said}");
    assert_eq!((said.lines().count(), said.matches("os error").count()), (1, 1), "{said}");
}

#[cfg(unix)]
#[test]
fn a_write_protected_file_or_folder_fails() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    fs::write(&path, "old").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
    if fs::OpenOptions::new().write(true).open(&path).is_ok() {
        eprintln!("skipped: this user writes to protected files (root); /proc stands in for them above");
        return;
    }
    headless(QUICK).arg("--out").arg(&path).assert().code(1).stderr(contains("run.csv"));
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
    headless(QUICK).arg("--out").arg(folder.path().join("new.csv")).assert().code(1);
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_quietly() {
    for line in ["simulate --dt 1e-5", "sweep --jobs 2", "curve --points 100000", "presets", "check"] {
        let mut child = Process::new(assert_cmd::cargo::cargo_bin!("interwell"))
            .arg("--headless")
            .args(line.split_whitespace())
            .arg("--quiet")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut first = String::new();
        // Dropping the reader after one line closes the pipe.
        BufReader::with_capacity(1, child.stdout.take().unwrap()).read_line(&mut first).unwrap();
        let end = child.wait_with_output().unwrap();
        assert!(!first.is_empty(), "{line}");
        assert_eq!((end.status.code(), end.stderr.as_slice()), (Some(0), &b""[..]), "{line}");
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_half_file() {
    // More work than can be done before the signal.
    for line in [
        "section --over stops.travel_limit_mm=1:7:0.001 --over excitation.amplitude_g=0:2:0.001",
        "simulate random-shaking --set excitation.lines=4096 --set run.duration_s=1e6 --at 0",
        "threshold paper-unconstrained --over excitation.frequency_hz=1:12:0.01",
        "accuracy",
        "accuracy duffing-chaos",
    ] {
        let folder = tempfile::tempdir().unwrap();
        let mut child = Process::new(assert_cmd::cargo::cargo_bin!("interwell"))
            .arg("--headless")
            .args(line.split_whitespace())
            .args(["--quiet", "--out"])
            .arg(folder.path().join("table.csv"))
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // The program listens before it makes a file.
        while fs::read_dir(folder.path()).unwrap().count() == 0 {
            assert_eq!(child.try_wait().unwrap(), None, "{line}: it ended before it wrote");
            std::thread::yield_now();
        }
        let killed = Process::new("kill").arg("-INT").arg(child.id().to_string()).status().unwrap();
        assert!(killed.success());
        let end = child.wait_with_output().unwrap();
        assert_eq!(end.status.code(), Some(1), "{line}");
        assert!(String::from_utf8_lossy(&end.stderr).contains("interrupted"), "{line}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{line}");
    }
}
