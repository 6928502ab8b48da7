//! Manifests as output and as input, and the origin in a summary.

use std::path::Path;

use serde_json::Value;

use super::super::cli::{headless, refused};

const SWEEP: &str = "sweep nominal-cubic --set run.settle_s=None --set run.duration_s=2 --set mass_g=12.5 \
    --tolerance 1e-7 --jobs 2 \
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

    // An axis is written as it was given.
    let text = value["scene_ron"].as_str().unwrap();
    assert!(text.contains("step: 0.5") && text.contains("values: ["), "{text}");
    assert!(!text.contains("run.tolerance") && text.matches("field: ").count() == 2, "{text}");
}

/// Rows and manifest of a sweep into `folder`; then the manifest and its scene alone give the same rows.
fn swept_again(line: &str, folder: &Path) {
    let rows = folder.join("rows.csv");
    let mut first = headless(line);
    first.arg("--quiet").arg("--out").arg(&rows).assert().success().stderr("");
    let rows = std::fs::read_to_string(&rows).unwrap();
    let manifest = folder.join("rows.csv.json");
    headless("sweep --quiet").arg(&manifest).assert().success().stdout(rows.clone()).stderr("");
    let scene = folder.join("scene.again");
    let value = json(&manifest);
    std::fs::write(&scene, value["scene_ron"].as_str().unwrap()).unwrap();
    for (name, text) in value["files"].as_object().unwrap() {
        std::fs::write(folder.join(name), text.as_str().unwrap()).unwrap();
    }
    headless("sweep --quiet").arg(&scene).assert().success().stdout(rows);
}

#[test]
fn a_manifest_is_swept_to_the_same_rows() {
    let folder = tempfile::tempdir().unwrap();
    swept_again(SWEEP, folder.path());
    // The scene's own sweep is over stops that --set took away.
    let without = "sweep paper --set stops=None --set run.settle_s=None --set run.duration_s=1";
    swept_again(
        &format!("{without} --over excitation.amplitude_g=0.58,0,-1 --over mass_g=10:20:5"),
        folder.path(),
    );
    // Stops that the scene's own value does not fit, an optional field, more digits than a number has.
    let start = "sweep nominal-cubic --set start=At(x_mm:5,v_m_per_s:0) --set run.duration_s=1 \
        --set run.settle_s=None";
    swept_again(&format!("{start} --over stops.travel_limit_mm=6:8:1"), folder.path());
    swept_again(&format!("{start} --set stops=None --over run.settle_s=0:1:0.5"), folder.path());
    let digits = "--over mass_g=10:11:0.3333333333333333333333333";
    swept_again(&format!("{start} --set stops=None {digits}"), folder.path());
    // A text as the path of an excitation, quotes and lines in the notes, and the scene's own sweep.
    swept_again(
        "sweep duffing-chaos --set run.duration_s=20 --set run.settle_s=None \
         --over excitation.amplitude_g=0.03",
        folder.path(),
    );
}

#[test]
fn a_manifest_brings_the_files_that_its_scene_reads() {
    let folder = tempfile::tempdir().unwrap();
    let (scenes, results) = (folder.path().join("scenes"), folder.path().join("results"));
    [&scenes, &results].into_iter().for_each(|path| std::fs::create_dir(path).unwrap());
    let table = "# \"measured\"\r\nx_m,force_n\n-2,-6\n-1,0\n0,0\n1,0\n2,6\n";
    let record = "t_s,accel_m_per_s2\n0,0\n1,3\n2,-3\n";
    std::fs::write(scenes.join("t.csv"), table).unwrap();
    std::fs::write(scenes.join("r.csv"), record).unwrap();
    let text = "(mass_g: 1000, mechanism: Table(path: \"t.csv\"), run: (duration_s: 3),
        excitation: Sum([Recorded(path: \"r.csv\"), Sine(frequency_hz: 1, amplitude_g: 0.1)]),
        start: At(x_mm: 1, v_m_per_s: 0), sweep: [(field: \"mass_g\", values: [1000, 900])])";
    std::fs::write(scenes.join("s.ron"), text).unwrap();
    let rows = results.join("rows.csv");
    headless("sweep --quiet").arg(scenes.join("s.ron")).arg("--out").arg(&rows).assert().success();
    let manifest = results.join("rows.csv.json");
    let value = json(&manifest);
    assert_eq!((&value["files"]["t.csv"], &value["files"]["r.csv"]), (&table.into(), &record.into()));
    assert_eq!(value["files"].as_object().unwrap().len(), 2);
    std::fs::remove_dir_all(&scenes).unwrap();
    let rows = std::fs::read_to_string(&rows).unwrap();
    headless("sweep --quiet").arg(&manifest).assert().success().stdout(rows);
    for command in ["check", "simulate", "curve"] {
        headless(command).arg(&manifest).assert().success();
    }
    let text = std::fs::read_to_string(&manifest).unwrap();
    headless("check -").write_stdin(text).assert().success();
    // A preset's table is there too.
    swept_again(
        "sweep paper-table --set run.duration_s=1 --set run.settle_s=None --over mass_g=10,15",
        &results,
    );
    assert!(
        json(&results.join("rows.csv.json"))["files"]["force_dl2.7.csv"].as_str().unwrap().contains("x_m")
    );
}

#[test]
fn a_manifest_takes_arguments_and_what_is_none_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let rows = folder.path().join("rows.csv");
    headless(SWEEP).arg("--out").arg(&rows).assert().success();
    let manifest = folder.path().join("rows.csv.json");
    let changed = "sweep --quiet --set mass_g=13 --over excitation.amplitude_g=0.5";
    let output = headless(changed).arg(&manifest).output().unwrap();
    let line = "sweep nominal-cubic --quiet --set run.settle_s=None --set run.duration_s=2 --set mass_g=13 \
                --tolerance 1e-7 --over excitation.amplitude_g=0.5";
    assert_eq!(output.stdout, headless(line).output().unwrap().stdout);
    let mut wrong = headless("check --set mass_g=-1");
    wrong.arg(&manifest);
    refused(wrong, &["rows.csv.json", "--set mass_g=-1"]);
    for (text, word) in
        [("{}", "program"), ("{\"a\": 1", "JSON"), ("{\"program\": \"x\", \"scene_ron\": \"\"}", "another")]
    {
        let path = folder.path().join("other.json");
        std::fs::write(&path, text).unwrap();
        let mut command = headless("sweep");
        command.arg(&path);
        refused(command, &["other.json", word]);
    }
}

#[test]
fn a_manifest_replaces_nothing_but_a_manifest() {
    let folder = tempfile::tempdir().unwrap();
    let (rows, beside) = (folder.path().join("map.csv"), folder.path().join("map.csv.json"));
    for foreign in ["{\"mine\": 1}", "notes", ""] {
        std::fs::write(&beside, foreign).unwrap();
        let mut command = headless(SWEEP);
        command.arg("--out").arg(&rows);
        refused(command, &["map.csv.json", "no manifest"]);
        assert_eq!(std::fs::read_to_string(&beside).unwrap(), foreign);
        assert!(!rows.exists());
    }
    std::fs::remove_file(&beside).unwrap();
    for _ in 0..2 {
        headless(SWEEP).arg("--out").arg(&rows).assert().success();
    }
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
