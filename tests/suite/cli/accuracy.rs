//! `accuracy`: its options, tables and errors.

use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, starts_with};

use super::{column, headless, stdout};

#[test]
fn one_case_is_shown_as_a_table() {
    let text = stdout("accuracy --quiet --case grazing --case plastic-sine");
    let mut lines = text.lines();
    let heading: Vec<&str> =
        lines.next().unwrap().split("  ").map(str::trim).filter(|w| !w.is_empty()).collect();
    let names =
        ["case", "variant", "quantity", "digits allowed", "digits reached", "steps", "cpu (s)", "verdict"];
    assert_eq!(heading, names);
    let cases: Vec<&str> = lines.filter_map(|line| line.split_whitespace().next()).collect();
    // in the study's own order
    assert_eq!(cases, ["plastic-sine", "grazing", "grazing", "grazing"]);
}

#[test]
fn every_quantity_is_a_row_of_the_csv() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("accuracy.csv");
    let line = format!("accuracy --case grazing --out {}", file.display());
    headless(&line).assert().success().stdout(starts_with("case"));
    let csv = std::fs::read_to_string(&file).unwrap();
    assert_eq!(
        csv.lines().next().unwrap(),
        "part,case,method,variant,quantity,tolerance,step_s,error,allowed,digits_allowed,digits_reached,\
         steps,evaluations,cpu_s,verdict"
    );
    assert!(column(&csv, "case").iter().all(|case| case == "grazing"));
    assert!(column(&csv, "verdict").iter().all(|verdict| verdict == "pass"));
    assert_eq!(
        column(&csv, "quantity").iter().filter(|quantity| *quantity == "displacement at 3 s").count(),
        3
    );
    let numbers = |name: &str| -> Vec<Option<f64>> {
        column(&csv, name).iter().map(|text| text.parse().ok()).collect()
    };
    let errors: Vec<(f64, f64)> =
        numbers("error").into_iter().zip(numbers("allowed")).filter_map(|(a, b)| a.zip(b)).collect();
    assert!(errors.len() >= 3 && errors.iter().all(|(error, allowed)| error <= allowed), "{errors:?}");
    // with the data on standard output the table goes to standard error
    let output =
        headless("accuracy --case grazing --out -").assert().success().stdout(starts_with("part,case"));
    output.stderr(contains("digits allowed"));
}

#[test]
fn speed_against_error_comes_with_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let (picture, data) = (folder.path().join("a.svg"), folder.path().join("a.csv"));
    let line = format!("accuracy --case p1 --plot {} --out {}", picture.display(), data.display());
    headless(&line).assert().success().stdout(contains("Dormand-Prince 5(4)").and(contains("least error")));
    let picture = std::fs::read_to_string(picture).unwrap();
    for word in ["cubic well, no stops (p1)", "Taylor series", "RK4", "velocity Verlet", "processor time (s)"]
    {
        assert!(picture.contains(word), "{word}");
    }
    let csv = std::fs::read_to_string(data).unwrap();
    let methods = column(&csv, "method");
    let rows = |name: &str| methods.iter().filter(|method| *method == name).count();
    assert_eq!((rows("Taylor series"), rows("Dormand-Prince 5(4)"), rows("RK4")), (12, 12, 8));
    assert_eq!(column(&csv, "tolerance")[0], "1e-3");
}

#[test]
fn with_stops_no_fixed_step_comes_below_what_is_said_of_them() {
    let page = include_str!("../../../docs/accuracy.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let said = page.split_once("none of the three comes below ").unwrap().1;
    let least: f64 = said.split_once(". ").unwrap().0.parse().unwrap();
    let csv = stdout("accuracy --case p2 --out - --quiet");
    let (methods, errors) = (column(&csv, "method"), column(&csv, "error"));
    let of = |name: &str| -> Vec<f64> {
        let rows = methods.iter().zip(&errors).filter(|(method, error)| *method == name && !error.is_empty());
        rows.map(|(_, error)| error.parse().unwrap()).collect()
    };
    for scheme in ["semi-implicit Euler", "velocity Verlet", "RK4"] {
        assert!(
            of(scheme).len() > 4 && of(scheme).iter().all(|error| *error > least),
            "{scheme}: {:?}",
            of(scheme)
        );
    }
    assert!(of("Taylor series").iter().any(|error| *error < 1e-12));
}

#[test]
fn the_page_counts_the_hard_cases() {
    let page = include_str!("../../../docs/accuracy.md");
    let count = interwell_studies::study::accuracy::HARD_CASES.len();
    assert!(page.contains(&format!("has {count} hard cases")), "{count}");
}

#[test]
fn the_cases_are_listed_with_their_reasons() {
    let all = stdout("accuracy --list");
    for word in ["p1", "flexures", "separatrix", "chatter-at-release", "Digits allowed:", "Answer:"] {
        assert!(all.contains(word), "{word}");
    }
    let one = stdout("accuracy --list --case kink");
    assert!(one.starts_with("kink\n") && !one.contains("separatrix"), "{one}");
}

#[test]
fn a_scene_is_looked_at_in_words_and_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.csv");
    let line = format!("accuracy nominal-cubic --method rk4 --step-s 1/60,0.001 --out {}", file.display());
    let output = headless(&line).assert().success();
    let words = contains("Error about")
        .and(contains("RK4 in steps of 1/60 s: Impacts arrive 14 ms late"))
        .and(contains("RMS velocity 38 % too high"))
        .and(contains("RK4 in steps of 1.0 ms"));
    output.stdout(words);
    let csv = std::fs::read_to_string(&file).unwrap();
    assert_eq!(
        csv.lines().next().unwrap(),
        "method,tolerance,step_s,error_m,trusted_s,compared_s,steps,evaluations,cpu_s,rms_velocity_m_per_s,\
         impacts,late_s,latest_s,arrivals,outcome"
    );
    assert_eq!(column(&csv, "tolerance"), ["1e-3", "1e-6", "1e-9", "1e-12", "", ""].map(spelt));
    assert_eq!(column(&csv, "outcome"), ["done"; 6]);
    // all methods where none is named, and none where no step is
    let all = stdout("accuracy bouncing-ball --step-s 0.01 --quiet");
    assert!(["semi-implicit Euler", "velocity Verlet", "RK4"].iter().all(|name| all.contains(name)), "{all}");
    let none =
        stdout("accuracy duffing-chaos --set run.duration_s=300 --set run.settle_s=100 --tolerance 1e-6");
    assert!(none.starts_with("Chaotic: trust it up to about") && !none.contains("RK4"), "{none}");
}

/// A number as the CSV spells it.
fn spelt(text: &str) -> String {
    text.parse::<f64>().map_or_else(|_| text.to_owned(), |number| format!("{number:e}"))
}
