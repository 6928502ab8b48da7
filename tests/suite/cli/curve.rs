//! The command `curve`: rows, columns, ranges and the landscape.

use super::{column, headless, refused, stdout};

#[test]
fn curve_rows_and_columns() {
    let text = stdout("curve --at-mm -3,0,3");
    assert_eq!(text.lines().next().unwrap(), "x_m,force_n,potential_j,stiffness_n_per_m");
    assert_eq!(column(&text, "x_m"), ["-0.003", "0", "0.003"].map(short_form));
    let force = column(&text, "force_n");
    assert_eq!(format!("-{}", force[0]), force[2]);
    assert_eq!(column(&text, "potential_j")[1], "0");

    let text = stdout("curve --range-mm -8:8 --points 401");
    let x = column(&text, "x_m");
    assert_eq!((x.len(), &x[0][..], &x[200][..], &x[201][..]), (401, "-8e-3", "0", "4e-5"));
    assert_eq!(column(&stdout("curve duffing"), "x_m").len(), 401);
    assert_eq!(column(&stdout("curve paper --points 5"), "x_m").len(), 5);
    refused(headless("curve --at-mm 9"), &["--at-mm 9: 9 mm", "-8.2559", " to 8.2559"]);
    refused(headless("curve --range-mm 0:9"), &["--range-mm 0:9: ", " mm is not on the force curve"]);
    refused(headless("curve --at-mm nan"), &["--at-mm nan"]);
}

fn short_form(text: &str) -> String {
    let mut short = String::new();
    interwell::output::push_number(&mut short, text.parse().unwrap());
    short
}

#[test]
fn landscape_of_a_double_well() {
    let text = stdout("curve nominal-cubic --landscape - --out /dev/null");
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    let equilibria = value["equilibria"].as_array().unwrap();
    assert_eq!(equilibria.len(), 3);
    let right = &equilibria[2];
    assert!((right["x_m"].as_f64().unwrap() - 0.007).abs() < 1e-12);
    assert!((right["frequency_hz"].as_f64().unwrap() - 11.546).abs() < 1e-3);
    assert!(equilibria[1]["frequency_hz"].is_null() && equilibria[1]["stable"] == false);
    assert!((value["barrier"]["height_j"].as_f64().unwrap() - 4.9e-4).abs() < 1e-9);
    assert_eq!(value["force_extrema"].as_array().unwrap().len(), 2);
    assert!(value["kinks"].as_array().unwrap().is_empty());
}
