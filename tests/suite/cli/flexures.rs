//! Flexures on the command line: columns, shapes, warnings, sweeps.

use std::fs;
use std::path::PathBuf;

use predicates::prelude::*;
use predicates::str::contains;

use super::{column, headless, refused};

const SCENE: &str = "(title: \"Flexures\", mass_g: 15.2, damping: Ratio(0.023),
    mechanism: Flexures(preload_mm: 2.7, thickness_mm: 0.1, young_gpa: 190,
        parallel: (count: 2, length_mm: 26, width_mm: 20), buckling: (count: 1, length_mm: 27.7, \
        width_mm: 6.8)),
    stops: Rigid(travel_limit_mm: 1.5, restitution: 0.36),
    excitation: Sine(frequency_hz: 3, amplitude_g: 1), run: (duration_s: 0.5, settle_s: 0))";

/// A folder with the scene in it.
pub(super) fn scene() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flexures.ron");
    fs::write(&path, SCENE).unwrap();
    (folder, path)
}

/// What `COMMAND scene OPTIONS` writes to standard output.
pub(super) fn stdout(command: &str, path: &std::path::Path, options: &str) -> String {
    let mut program = headless(command);
    program.arg(path).args(options.split_whitespace());
    String::from_utf8(program.assert().success().get_output().stdout.clone()).unwrap()
}

pub(super) fn numbers(csv: &str, name: &str) -> Vec<f64> {
    column(csv, name).iter().map(|text| text.parse().unwrap()).collect()
}

#[test]
fn full_adds_columns_to_the_curve() {
    let (_folder, path) = scene();
    let plain = stdout("curve", &path, "--at-mm -3,0,3 --quiet");
    let full = stdout("curve", &path, "--at-mm -3,0,3 --quiet --full");
    let header = "x_m,force_n,potential_j,stiffness_n_per_m,axial_n,bump_m,max_stress_pa";
    assert_eq!(full.lines().next().unwrap(), header);
    for (plain, full) in plain.lines().zip(full.lines()) {
        assert!(full.starts_with(&format!("{plain},")), "{full}");
    }
    assert_eq!(numbers(&full, "x_m"), [-0.003, 0.0, 0.003]);
    assert!(numbers(&full, "max_stress_pa").iter().all(|stress| *stress >= 0.0));
    assert_eq!(stdout("curve", &path, "--points 5 --full --quiet").lines().count(), 6);
}

#[test]
fn shapes_are_centre_lines_from_the_frame_to_the_shuttle() {
    let (folder, path) = scene();
    let shapes = folder.path().join("shapes.csv");
    let write = |options: &str| {
        let mut command = headless("curve --quiet --out /dev/null");
        command.arg(&path).args(options.split_whitespace()).arg("--shapes").arg(&shapes).assert().success();
        fs::read_to_string(&shapes).unwrap()
    };
    let text = write("--at-mm 3,-1");
    assert_eq!(text.lines().next().unwrap(), "x_m,flexure,s_m,px_m,py_m");
    let (x, kind) = (numbers(&text, "x_m"), column(&text, "flexure"));
    let (px, py) = (numbers(&text, "px_m"), numbers(&text, "py_m"));
    let mut blocks = Vec::new();
    let mut begin = 0;
    for i in 1..=x.len() {
        if i == x.len() || (x[i], &kind[i]) != (x[begin], &kind[begin]) {
            blocks.push((x[begin], kind[begin].clone(), begin, i - 1));
            begin = i;
        }
    }
    let order: Vec<(f64, &str)> = blocks.iter().map(|block| (block.0, block.1.as_str())).collect();
    let expected = [(0.003, "parallel"), (0.003, "buckling"), (-0.001, "parallel"), (-0.001, "buckling")];
    assert_eq!(order, expected);
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} {b}");
    for (x, kind, first, last) in blocks {
        let clamp = if kind == "parallel" { 0.0 } else { (26.0 + 27.7 - 2.7) * 1e-3 };
        near(px[first], clamp);
        near(py[first], 0.0);
        near(py[last], x);
    }
    // Not as many as the curve has rows, unless so many are asked for.
    let count = |options: &str| {
        let mut x = numbers(&write(options), "x_m");
        x.dedup();
        x
    };
    let x = count("");
    assert_eq!((x.len(), x[10], x[0]), (21, 0.0, -x[20]));
    assert_eq!(count("--range-mm -2:2").first(), Some(&-0.002));
    assert_eq!(count("--range-mm -2:2 --points 5"), [-0.002, -0.001, 0.0, 0.001, 0.002]);
}

#[test]
fn positions_beyond_the_curve_and_a_place_of_two_tables_are_refused() {
    let (_folder, path) = scene();
    for options in ["--full --at-mm 1000", "--shapes - --out /dev/null --at-mm 1000", "--shapes -"] {
        let mut command = headless("curve");
        command.arg(&path).args(options.split_whitespace());
        let word = if options.ends_with('-') { "--out" } else { "1000 mm" };
        refused(command, &[word]);
    }
}

#[test]
fn too_much_stress_is_a_warning() {
    let (_folder, path) = scene();
    let curve = |options: &str| {
        let mut command = headless("curve --at-mm 0,1,3 --out /dev/null");
        command.arg(&path).args(options.split_whitespace());
        command.assert().success()
    };
    let soft = "--set mechanism.yield_gpa=1e-30";
    let text = contains("warning: ")
        .and(contains("|x|"))
        .and(contains("exceeds mechanism.yield_gpa = 1e-30"))
        .and(contains("GPa at x = "));
    curve(&format!("--full {soft}")).stderr(text);
    // Only where it was looked for, and not where it is allowed.
    curve(soft).stderr("");
    curve(&format!("--full --quiet {soft}")).stderr("");
    curve("--full --set mechanism.yield_gpa=1e30").stderr("");
}

#[test]
fn shapes_that_are_none_are_refused_by_every_command() {
    let (_folder, path) = scene();
    for command in ["check", "curve", "simulate", "sweep"] {
        let mut command = headless(command);
        command.arg(&path).args(["--set", "mechanism.preload_mm=14"]);
        if command.get_args().any(|word| word == "sweep") {
            command.args(["--over", "mass_g=15,16"]);
        }
        refused(command, &["mechanism.preload_mm = 14", "0 to 13 mm", "half of the shorter flexure"]);
    }
}

#[test]
fn geometries_are_swept_and_their_solutions_counted() {
    let (folder, path) = scene();
    let rows = folder.path().join("map.csv");
    let mut command = headless("sweep --quiet --over mechanism.parallel.length_mm=26,26.2,26.4");
    command.arg(&path).args(["--over", "excitation.amplitude_g=0,1", "--out"]).arg(&rows);
    command.assert().success().stderr("");
    let text = fs::read_to_string(&rows).unwrap();
    assert_eq!(column(&text, "length_mm"), ["26", "26", "26.2", "26.2", "26.4", "26.4"]);
    assert!(column(&text, "outcome").iter().all(|outcome| outcome == "done"), "{text}");
    let manifest = fs::read_to_string(folder.path().join("map.csv.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!((&manifest["cells"], &manifest["mechanisms"]), (&6.into(), &3.into()));
}

#[test]
fn check_says_what_the_flexures_are() {
    let (_folder, path) = scene();
    let text = stdout("check", &path, "");
    for word in ["2 parallel", "1 buckling", "Reissner", "fresh solutions", "damping ratio 0.023", "c = "] {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
    let strain = stdout("check", &path, "--set mechanism.plane_strain=true");
    assert!(strain.contains("plane strain"), "{strain}");
}
