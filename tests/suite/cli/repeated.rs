//! The manifest beside every table that a command writes, and the table that its arguments make again.

use std::fs;
use std::path::Path;

use interwell::system::checksum::checksum;
use serde_json::Value;

use super::{COMMANDS, column, headless, refused};

/// A unit double well from a table, between stops.
const WELL: &str = "(mass_g: 1000, mechanism: Table(path: \"t.csv\"), damping: Coefficient(c_n_s_per_m: 0.3),
    stops: Rigid(travel_limit_mm: 1300, restitution: 0.4), excitation: Sine(frequency_hz: 0.2,
    amplitude_g: 0.005), start: At(x_mm: 1000, v_m_per_s: 0), run: (duration_s: 40, settle_s: 20))";

/// A linear oscillator, whose comparison needs no search.
const LINEAR: &str = "(mass_g: 1000, mechanism: Linear(n_per_m: 4), damping: Ratio(0.1),
    excitation: Sine(frequency_hz: 0.3, amplitude_g: 0.01), run: (duration_s: 20, settle_s: 10))";

/// Calls of a command that write a table, `SCENE` being one that reads a table; none of a command that writes
/// text. Those of `merge` are made of the parts of a sweep.
fn calls(command: &str) -> Vec<&'static str> {
    match command {
        "presets" | "check" | "lesson" => vec![],
        "curve" => {
            vec!["SCENE --range-mm -1:1 --points 5", "SCENE --at-mm 0.5,-1 --plot p.svg --plot-x -2:2"]
        }
        "simulate" => vec![
            "SCENE --dt 0.5 --set mass_g=900 --tolerance 1e-7 --events e.csv --summary s.json",
            "SCENE --at 1,0.25 --measured r.csv --column x --unit mm --shift-s 1 --comparison c.csv",
            "SCENE --until-settled 80 --plot p.svg --panels velocity --jobs 1",
            // the scene's own sweep goes over a field that is gone
            "paper --set stops=None --set run.duration_s=2 --set excitation.amplitude_g=1.3",
        ],
        "sweep" => vec![
            "SCENE --over mass_g=900:1000:50 --columns rms_velocity,period --plot p.svg --quantity max_abs_x",
            "SCENE --over excitation.amplitude_g=0.004,0.005 --carry both --until-settled 80 --shard 1/2",
        ],
        "merge" => vec!["m1.csv m2.csv"],
        "section" => vec![
            "SCENE --skip 2 --keep 3 --phase-deg 90",
            "SCENE --at impacts --over stops.travel_limit_mm=1010,1100 --carry up",
        ],
        "threshold" => vec![
            "SCENE --of crossing --field excitation.amplitude_g=0:0.3:0.1 --until-settled 50 \
             --resolution 0.05",
            "SCENE --of release --over mass_g=900,1000 --plot p.svg",
        ],
        "compare" => vec!["linear.ron l2.ron --environment SCENE --set run.tolerance=1e-7"],
        "best" => vec![
            "SCENE --over mass_g=900:1000:50 --environment linear.ron*2 --environment mass_g=1000 --seed 3 \
             --vary damping.c_n_s_per_m=-1%:1% --maximise rms_velocity --subject-to max_abs_x<=9 \
             --plot p.svg",
        ],
        "spectrum" => vec!["SCENE --of v --taper hann --rate-hz 20 --plot p.svg --quantity psd"],
        "basins" => vec![
            "SCENE --x-mm -1000:1000:2 --v 0.1:0.2:2 --attractors a.csv",
            "SCENE --x-mm 900:1000 --v 0:0.1 --random 3 --seed 5",
        ],
        "orbit" => vec![
            "SCENE --phase-deg 30",
            "SCENE --branch excitation.amplitude_g=0.005:0.0052 --switch 2 --step 0.02 --count 40 \
             --plot p.svg",
            "impact-oscillator --branch excitation.amplitude_g=0.05:0.07 --locus grazing \
             --and excitation.frequency_hz=0.1:0.116 --step 0.03 --plot p.svg",
        ],
        "exponents" => vec!["SCENE --periods 20", "SCENE --over mass_g=900,1000 --until-settled 60"],
        "escape" => vec![
            "SCENE --set excitation=Noise(rms_g:0.5,low_hz:0.1,high_hz:2,seed:3,lines:8) --runs 3 --within 5 \
             --until crossing --over mass_g=900,1000 --plot p.svg",
        ],
        "identify" => {
            vec!["r.csv --of damping --column x --unit mm --from 0.1 --plot p.svg --summary s.json"]
        }
        "accuracy" => vec!["SCENE --step-s 1/60 --method rk4", "--case grazing"],
        _ => panic!("say which calls of `{command}` write a table"),
    }
}

fn write(folder: &Path, name: &str, text: impl AsRef<[u8]>) {
    fs::write(folder.join(name), text).unwrap();
}

/// The files that the calls read, of which `folder/scenes` is needed for the first call alone.
fn prepare(folder: &Path) {
    fs::create_dir(folder.join("scenes")).unwrap();
    write(folder, "scenes/t.csv", "x_m,force_n\n-2,-6\n-1,0\n0,0\n1,0\n2,6\n");
    write(folder, "scenes/well.ron", WELL);
    write(folder, "linear.ron", LINEAR);
    write(folder, "l2.ron", LINEAR.replace("n_per_m: 4", "n_per_m: 5"));
    let row = |i: i32| {
        let t = f64::from(i) * 2e-3;
        format!("{t},{}\n", (-1.2 * t).exp() * (60.0 * t).cos())
    };
    write(folder, "r.csv", format!("t_s,x_mm\n{}", (0..1000).map(row).collect::<String>()));
}

/// Both parts of a sweep.
fn sweep_parts(folder: &Path) {
    for part in ["1", "2"] {
        let line = format!("sweep scenes/well.ron --over mass_g=900,1000 --shard {part}/2 --out m{part}.csv");
        headless(&line).arg("--quiet").current_dir(folder).assert().success();
    }
}

/// A table without its times of computation.
fn without_times(csv: &[u8]) -> String {
    let text = String::from_utf8(csv.to_vec()).unwrap();
    let Some(times) = text.lines().next().unwrap().split(',').position(|name| name == "cpu_s") else {
        return text;
    };
    let kept = |line: &str| {
        let cells = line.split(',').enumerate().filter(|(place, _)| *place != times);
        cells.map(|(_, cell)| cell).collect::<Vec<_>>().join(",")
    };
    text.lines().map(kept).collect::<Vec<_>>().join("\n")
}

#[test]
fn every_table_has_a_manifest_that_makes_it_again() {
    for command in COMMANDS {
        for call in calls(command) {
            let folder = tempfile::tempdir().unwrap();
            let (folder, line) = (folder.path(), call.replace("SCENE", "scenes/well.ron"));
            prepare(folder);
            if command == "merge" {
                sweep_parts(folder);
            }
            let mut first = headless(&format!("{command} {line} --quiet --out rows.csv"));
            first.current_dir(folder).assert().success();
            let rows = fs::read(folder.join("rows.csv")).unwrap();
            assert!(rows.iter().filter(|byte| **byte == b'\n').count() > 1, "{command} {call}: no rows");
            let manifest = folder.join("rows.csv.json");
            let made: Value = serde_json::from_slice(&fs::read(&manifest).unwrap()).unwrap();
            assert_eq!(
                (&made["version"], &made["data"]),
                (&env!("CARGO_PKG_VERSION").into(), &"rows.csv".into())
            );
            assert_eq!(made["sha256"], checksum(&rows), "{command} {call}");
            let written = if command == "merge" { "sweep" } else { command };
            assert_eq!(made["command"], written);
            // the scene and its table are in the manifest
            fs::remove_dir_all(folder.join("scenes")).unwrap();
            if command == "compare" {
                ["linear.ron", "l2.ron"].iter().for_each(|name| fs::remove_file(folder.join(name)).unwrap());
            }
            let words = made["repeat"].as_array().unwrap();
            let mut again = headless("--quiet");
            again.args(words.iter().skip(1).map(|word| word.as_str().unwrap())).current_dir(folder);
            let again = again.assert().success().get_output().stdout.clone();
            assert_eq!(without_times(&again), without_times(&rows), "{command} {call}: {words:?}");
            // what decides no byte is left out
            assert_eq!(words[0], "--headless");
            assert!(!words.iter().any(|word| word.as_str().unwrap().starts_with("--plot")), "{words:?}");
        }
    }
}

#[test]
fn files_that_are_read_besides_the_scene_have_their_checksums() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    prepare(folder);
    let sums = |line: &str| -> Value {
        headless(line).args(["--quiet", "--out", "rows.csv"]).current_dir(folder).assert().success();
        let made: Value = serde_json::from_slice(&fs::read(folder.join("rows.csv.json")).unwrap()).unwrap();
        made["inputs"].clone()
    };
    let sum = |name: &str| checksum(&fs::read(folder.join(name)).unwrap());
    let record = sums("identify r.csv --of damping");
    assert_eq!(record, serde_json::json!({ "r.csv": sum("r.csv") }));
    let best = sums(
        "best linear.ron --over mass_g=900:1000:50 --environment scenes/well.ron*2 --environment l2.ron",
    );
    let expected = serde_json::json!({
        "scenes/well.ron": sum("scenes/well.ron"),
        "scenes/t.csv": sum("scenes/t.csv"),
        "l2.ron": sum("l2.ron"),
    });
    assert_eq!(best, expected);
    assert_eq!(sums("orbit scenes/well.ron"), serde_json::json!({}));
}

#[test]
fn what_a_manifest_cannot_do_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    prepare(folder);
    let run = |line: &str| {
        let mut command = headless(line);
        command.current_dir(folder);
        command
    };
    run("identify r.csv --of damping --quiet --out ratio.csv").assert().success();
    // it is replaced as any other manifest
    run("identify r.csv --of damping --quiet --out ratio.csv").assert().success();
    refused(run("simulate ratio.csv.json"), &["ratio.csv.json", "`identify`", "without a scene", "repeat"]);
    let line = "threshold linear.ron --field excitation.amplitude_g=0:0.3:0.1 --quiet --out t.csv";
    run(line).assert().success();
    refused(run("sweep t.csv.json --over mass_g=1,2 --check"), &["--check", "manifest of a sweep"]);
    // a comparison stands for all its scenes, any other command takes the first
    run("compare linear.ron l2.ron --quiet --out c.csv").assert().success();
    let output = run("compare c.csv.json scenes/well.ron --environment linear.ron --quiet").output().unwrap();
    let rows = String::from_utf8(output.stdout).unwrap();
    assert_eq!(column(&rows, "scene"), ["linear.ron", "l2.ron", "scenes/well.ron"]);
    let first = run("curve c.csv.json --at-mm 1000 --quiet").output().unwrap();
    assert_eq!(column(&String::from_utf8(first.stdout).unwrap(), "force_n"), ["4"]);
    // a file that is no manifest is not replaced
    write(folder, "mine.csv.json", "{}");
    refused(run("spectrum linear.ron --out mine.csv"), &["mine.csv.json", "no manifest"]);
    assert!(!folder.join("mine.csv").exists());
}
