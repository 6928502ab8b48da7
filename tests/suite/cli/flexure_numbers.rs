//! The prototype's numbers as a person reads them: from `curve`, `check`, `simulate` and `sweep`.

use std::fs;

use predicates::str::contains;

use super::flexures::{numbers, scene, stdout};
use super::{column, headless};
use crate::support::{near, near_relative};

#[test]
fn the_curve_in_csv() {
    let (_folder, path) = scene();
    let text = stdout("curve", &path, "--quiet --full --at-mm -4,0,4,4.15,7.1,7.3");
    let all = ["force_n", "potential_j", "stiffness_n_per_m", "axial_n", "bump_m", "max_stress_pa"];
    let [force, potential, stiffness, axial, bump, stress] = all.map(|name| numbers(&text, name));
    assert_eq!((force[0], force[1], potential[1]), (-force[2], 0.0, 0.0));
    near(force[2], -0.1965, 5e-4);
    near(force[3], -0.197, 5e-4);
    near(stiffness[1], -71.6, 0.05);
    near(axial[1], 5.82, 5e-3);
    assert!(potential[4] > -0.925e-3 && potential[4] < -0.92e-3);
    // The parallel flexures give way a little, so that the bump is just below that of the whole preload.
    near_relative(bump[1], 0.192607640414 * 27.7e-3, 1e-3);
    assert!(bump[1] > bump[2] && bump[2] > bump[4] && bump[4] > 0.0 && bump[5] == 0.0);
    // Each state is solved and its line summed for itself.
    for both in [&bump, &stress, &axial] {
        near_relative(both[0], both[2], 1e-12);
    }
    // E t/2 times the curvature at the middle of the elastica.
    assert!(stress[1] > 1.2e9 && stress[1] < 1.5e9, "{stress:?}");
    assert!(force[5] > 0.0 && stiffness[5] > 4000.0);
}

#[test]
fn the_landscape_in_json() {
    let (folder, path) = scene();
    let file = folder.path().join("landscape.json");
    let mut command = headless("curve --quiet --points 3 --out /dev/null --landscape");
    command.arg(&file).arg(&path).assert().success();
    let text = fs::read_to_string(&file).unwrap();
    let landscape: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(landscape["kinks"].as_array().unwrap().len(), 2, "{text}");
    assert_eq!(landscape["equilibria"].as_array().unwrap().len(), 3, "{text}");
    near(landscape["kinks"][1]["x_m"].as_f64().unwrap(), 7.18e-3, 5e-6);
    near(landscape["equilibria"][2]["x_m"].as_f64().unwrap(), 7.1807e-3, 5e-7);
}

#[test]
fn the_readings_of_a_damping_ratio() {
    let (_folder, path) = scene();
    let text = stdout("check", &path, "");
    for number in
        ["c = 0.06631", "would be c = 0.3579", "25.47 Hz", "c = 0.1119", "barrier at 0 mm, 0.9246 mJ"]
    {
        assert!(text.contains(number), "`{number}` is not in: {text}");
    }
    // Of one well there is no barrier to be off by a part of.
    let one = stdout("check", &path, "--set mechanism.preload_mm=0");
    assert!(!one.contains("of the barrier") && !one.contains("inf") && !one.contains("NaN"), "{one}");
    let stiff = "--set mechanism.parallel.length_mm=8 --set mechanism.preload_mm=1";
    let one = stdout("check", &path, stiff);
    assert!(one.contains("kinks") && !one.contains("of the barrier") && !one.contains("inf"), "{one}");
}

#[test]
fn a_mass_that_is_too_fast_leaves_the_range() {
    let (folder, path) = scene();
    let summary = folder.path().join("summary.json");
    let mut command = headless("simulate --set stops=None --out /dev/null --summary");
    command.arg(&summary).arg(&path).args(["--set", "start=At(x_mm: 7.2, v_m_per_s: 8)"]);
    command.assert().success().stderr(contains("left_table"));
    let json: serde_json::Value = serde_json::from_str(&fs::read_to_string(&summary).unwrap()).unwrap();
    assert_eq!(json["outcome"], "left_table");
    near(json["final_x_m"].as_f64().unwrap(), 1.15 * 7.179e-3, 1e-6);
}

#[test]
fn a_geometry_of_a_sweep_is_solved_once() {
    let (folder, path) = scene();
    let rows = folder.path().join("map.csv");
    let mut command = headless("sweep --quiet --over mechanism.preload_mm=0,0.00135,1.5,2.7");
    let thickness = ["--over", "mechanism.thickness_mm=0.08,0.1"];
    command
        .arg(&path)
        .args(thickness)
        .args(["--over", "stops.travel_limit_mm=0.5,1.0,1.5", "--out"])
        .arg(&rows);
    // A damping ratio needs a stiffness, which the sway threshold has none of to speak of.
    command.args([
        "--set",
        "damping=Coefficient(c_n_s_per_m: 0.05)",
        "--set",
        "start=At(x_mm: 0.1, v_m_per_s: 0)",
    ]);
    command.assert().success().stderr("");
    let text = fs::read_to_string(&rows).unwrap();
    assert!(column(&text, "outcome").iter().all(|outcome| outcome == "done"), "{text}");
    let manifest = fs::read_to_string(folder.path().join("map.csv.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!((&manifest["cells"], &manifest["mechanisms"]), (&24.into(), &8.into()));
}
