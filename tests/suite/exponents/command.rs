//! The command `exponents`: columns, cells, the same bytes for any number of threads.

use crate::cli::{headless, stdout};

const COLUMNS: &str =
    "exponent_1_per_s,exponent_1_se,exponent_2_per_s,exponent_2_se,sum_per_s,exact_sum_per_s,dimension";

#[test]
fn one_motion_is_one_row() {
    let text = stdout("exponents duffing --quiet");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines[0], lines.len()), (COLUMNS, 2));
    let row: Vec<f64> = lines[1].split(',').map(|cell| cell.parse().unwrap()).collect();
    assert!(row[0] < 0.0 && row[2] < row[0] && row[6] == 0.0, "{row:?}");
    assert_eq!((row[1], row[3], row[5]), (0.0, 0.0, -0.3));
    headless("exponents duffing --quiet").assert().success().stderr("");
    let told = headless("exponents duffing").assert().success();
    let told = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
    assert!(told.contains("after 5 forcing periods") && told.lines().count() == 1, "{told}");
    // too few periods have no standard error, which is an empty cell
    let few = stdout("exponents duffing-chaos --periods 3 --quiet");
    let cells: Vec<&str> = few.lines().nth(1).unwrap().split(',').collect();
    assert!(cells[1].is_empty() && cells[3].is_empty() && !cells[0].is_empty(), "{few}");
}

#[test]
fn a_rest_is_written_as_minus_infinity_and_told() {
    let text = stdout("exponents paper --quiet");
    assert_eq!(text, format!("{COLUMNS}\n-inf,0,-inf,0,-inf,-inf,0\n"));
    let cell = text.lines().nth(1).unwrap().split(',').next().unwrap();
    assert_eq!(cell.parse(), Ok(f64::NEG_INFINITY));
    let told = headless("exponents paper").assert().success();
    let told = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
    assert!(told.contains("rests on a stop") && told.contains("-inf"), "{told}");
    let cells = headless("exponents paper --over excitation.amplitude_g=0.5,1").assert().success();
    let cells = String::from_utf8_lossy(&cells.get_output().stderr).into_owned();
    assert!(cells.contains("2 cells") && cells.contains("2 with a rest on a stop"), "{cells}");
}

#[test]
fn cells_have_their_fields_first_and_the_same_bytes_for_any_threads() {
    let line = "exponents duffing --over excitation.amplitude_g=0.02:0.05:0.01 --over mass_g=1100,1000.5 \
        --periods 100 --quiet";
    let text = stdout(line);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines[0], lines.len()), (format!("amplitude_g,mass_g,{COLUMNS}").as_str(), 9));
    assert!(lines[1].starts_with("0.02,1100,") && lines[8].starts_with("0.05,1000.5,"), "{text}");
    for jobs in ["1", "3"] {
        assert_eq!(stdout(&format!("{line} --jobs {jobs}")), text, "--jobs {jobs}");
    }
    // a cell is what its scene alone gives
    let alone = stdout(
        "exponents duffing --set excitation.amplitude_g=0.05 --set mass_g=1100 \
        --periods 100 --quiet",
    );
    let alone = alone.lines().nth(1).unwrap();
    assert!(lines[7].ends_with(alone), "{} {alone}", lines[7]);
    // a cell whose motion leaves the curve has no exponents, and the others stay
    let far = "exponents paper --set stops=None --over excitation.amplitude_g=0.1,40";
    let far = headless(far).assert().success();
    let rows = String::from_utf8_lossy(&far.get_output().stdout).into_owned();
    assert!(rows.ends_with("\n40,,,,,,,\n"), "{rows}");
    assert!(String::from_utf8_lossy(&far.get_output().stderr).contains("1 without exponents"));
}

#[test]
fn cells_have_a_manifest_beside_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let line = "exponents paper --over excitation.amplitude_g=0.5,1 --quiet --out e.csv";
    headless(line).current_dir(folder.path()).assert().success();
    let text = std::fs::read_to_string(folder.path().join("e.csv.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
    let counts = ["cells", "resting", "without_exponents"].map(|key| manifest[key].as_u64());
    assert_eq!((counts, &manifest["command"]), ([Some(2), Some(2), Some(0)], &"exponents".into()));
    assert_eq!(manifest["grid"][0]["values"], serde_json::json!([0.5, 1.0]));
}

#[test]
fn a_motion_that_ends_is_a_failed_run_and_no_wrong_argument() {
    let mut far = headless("exponents paper --quiet --set stops=None --set excitation.amplitude_g=40");
    let told = far.assert().code(1).stdout("");
    assert!(String::from_utf8_lossy(&told.get_output().stderr).contains("ended early (left_table)"));
}

#[test]
fn nothing_to_shake_it_is_a_motion_too() {
    for change in ["excitation.amplitude_g=0", "excitation=None", "excitation=Constant(accel_g:0.001)"] {
        let text = stdout(&format!("exponents duffing --quiet --set {change}"));
        let row: Vec<f64> =
            text.lines().nth(1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!((row[0] + 0.15).abs() < 1e-9 && (row[2] + 0.15).abs() < 1e-9, "{change}: {row:?}");
    }
}
