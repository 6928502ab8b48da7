//! Does a manifest say enough to run a sweep again, and does a summary say where it came from?

use std::path::Path;

use serde_json::Value;

use super::super::cli::{headless, refused};

const SWEEP: &str = "sweep nominal-cubic --set run.settle_s=None --set run.duration_s=2 --set mass_g=12.5 --tolerance 1e-7 --jobs 2 \
                     --over stops.travel_limit_mm=2,4 --over excitation.amplitude_g=0:1:0.5";

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn a_manifest_stands_beside_the_rows() {
    let folder = tempfile::tempdir().unwrap();
    let rows = folder.path().join("map.csv");
    headless(SWEEP).arg("--out").arg(&rows).assert().success();
    let value = json(&folder.path().join("map.csv.json"));
    assert_eq!(value["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!((&value["data"], &value["command"]), (&"map.csv".into(), &"sweep".into()));
    assert_eq!((&value["cells"], &value["outcomes"]["done"]), (&6.into(), &6.into()));
    assert!(value["regimes"].as_object().unwrap().values().filter_map(Value::as_u64).sum::<u64>() == 6);
    assert_eq!((&value["seed"], &value["jobs"]), (&Value::Null, &2.into()));
    assert_eq!((&value["tolerance"], &value["scene"]["mass_g"]), (&1e-7.into(), &12.5.into()));
    assert_eq!(value["grid"][0]["field"], "stops.travel_limit_mm");
    assert_eq!(value["grid"][1]["values"], serde_json::json!([0.0, 0.5, 1.0]));
    assert!(value["wall_s"].as_f64().unwrap() > 0.0 && value["cpu_s"].as_f64().unwrap() >= 0.0);
    assert!(value["arguments"].as_array().unwrap().contains(&"--tolerance".into()));

    // From the manifest alone the same rows.
    let scene = folder.path().join("again.ron");
    std::fs::write(&scene, value["scene_ron"].as_str().unwrap()).unwrap();
    let mut again = headless("sweep --quiet");
    again.arg(&scene);
    for axis in value["grid"].as_array().unwrap() {
        let values: Vec<String> = axis["values"].as_array().unwrap().iter().map(Value::to_string).collect();
        again.arg("--over").arg(format!("{}={}", axis["field"].as_str().unwrap(), values.join(",")));
    }
    again.assert().success().stdout(std::fs::read_to_string(&rows).unwrap());
}

#[test]
fn only_a_regular_file_has_one() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = headless(SWEEP);
    command.current_dir(folder.path()).assert().success();
    headless(SWEEP).current_dir(folder.path()).args(["--out", "/dev/null"]).assert().success();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    assert!(!Path::new("/dev/null.json").exists());

    // It is checked like any output, and may not take the scene's place.
    std::fs::create_dir(folder.path().join("a.csv.json")).unwrap();
    let mut command = headless(SWEEP);
    command.arg("--out").arg(folder.path().join("a.csv"));
    refused(command, &["a.csv.json", "is a folder"]);
    headless("presets --write").arg(folder.path()).assert().success();
    let scene = folder.path().join("b.json");
    std::fs::copy(folder.path().join("nominal-cubic.ron"), &scene).unwrap();
    let mut command = headless("sweep");
    command.arg(&scene).arg("--out").arg(folder.path().join("b"));
    refused(command, &["overwrite"]);
}

#[cfg(unix)]
#[test]
fn a_named_pipe_is_written_once() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe");
    if !std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|made| made.success()) {
        eprintln!("skipped: there is no mkfifo here");
        return;
    }
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::read_to_string(pipe).unwrap()
    });
    headless(SWEEP).arg("--out").arg(&pipe).assert().success();
    assert_eq!(reader.join().unwrap().lines().count(), 7);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_summary_says_where_it_came_from() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.json");
    headless("simulate elastic-box --out /dev/null --summary").arg(&path).assert().success();
    let value = json(&path);
    assert_eq!((&value["seed"], &value["version"]), (&Value::Null, &env!("CARGO_PKG_VERSION").into()));
    assert!(value["wall_s"].as_f64().unwrap() > 0.0);
    assert_eq!(value["arguments"][1], "simulate");
}
