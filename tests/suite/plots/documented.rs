//! The commands of the pictures of the study, as they stand in the documents, over coarser grids.

use std::fs;

use super::*;

const OUTPUT: &str = include_str!("../../../docs/output.md");

/// The commands that make the pictures, and what can be read on each.
const PICTURES: [(&str, &[&str]); 7] = [
    (
        "force.pdf",
        &[
            "displacement (mm)",
            "holding force (N)",
            "potential above the well (mJ)",
            "stable equilibrium",
            "stop",
        ],
    ),
    ("ramp.pdf", &["displacement (mm)", "velocity (mm/s)", "base acceleration (g)", "time (s)", "impact"]),
    ("ramp-section.pdf", &["displacement (mm)", "106", "109", "phase portrait, 106 to 109 s"]),
    ("map.pdf", &["travel limit (mm)", "amplitude (g)", "RMS velocity (mm/s)", "first crossing"]),
    ("surface.pdf", &["travel limit (mm)", "amplitude (g)", "RMS velocity (mm/s)"]),
    ("comparison.pdf", &["travel limit 1.5 mm", "3 mm", "6 mm", "amplitude (g)", "RMS velocity (mm/s)"]),
    ("cuts.pdf", &["at travel limit 1.5 mm", "at amplitude 1.2 g", "RMS velocity (mm/s)", "first crossing"]),
];

/// A command of the documents on a grid of few cells and short runs.
fn coarse(line: &str) -> String {
    let line = line.replace("=0:2:0.02", "=0:2:0.2");
    let short = "--set run.settle_s=None --set run.duration_s=2";
    let grid = "--over stops.travel_limit_mm=0.5:7:0.5 --over excitation.amplitude_g=0:2:0.2";
    match (line.starts_with("sweep"), line.contains("--over")) {
        (false, _) => line,
        (true, true) => format!("{line} {short}"),
        (true, false) => format!("{line} {short} {grid}"),
    }
}

#[test]
fn each_picture_of_the_study_comes_of_its_documented_command() {
    let folder = tempfile::tempdir().unwrap();
    for (name, words) in PICTURES {
        let option = format!(" --plot {name}");
        let line = OUTPUT.lines().find(|line| line.contains(&option)).unwrap();
        let line = coarse(line.strip_prefix("interwell --headless ").unwrap());
        let svg = name.replace(".pdf", ".svg");
        for line in [line.clone(), line.replace(name, &svg) + " --plot-data data.csv"] {
            let mut command = headless(&line);
            command.args(["--quiet", "--out", "/dev/null"]).current_dir(folder.path());
            command.assert().success().stdout("");
        }
        let pdf = fs::read(folder.path().join(name)).unwrap();
        let page = String::from_utf8_lossy(&pdf).into_owned();
        let page = page.split("/MediaBox [").nth(1).unwrap().split(']').next().unwrap().to_owned();
        let width: f64 = page.split(' ').nth(2).unwrap().parse().unwrap();
        assert!(pdf.starts_with(b"%PDF-") && (width - 85.0 / 25.4 * 72.0).abs() < 1e-3, "{name}: {page}");
        let texts = texts(&folder.path().join(svg));
        let joined = texts.join(" ");
        for word in words {
            assert!(joined.contains(word), "{name}: `{word}` is not in {texts:?}");
        }
        // without title and footer
        assert!(!texts.iter().any(|text| text.contains("Prototype") || text.contains("tolerance")), "{name}");
        let data = fs::read_to_string(folder.path().join("data.csv")).unwrap();
        let count = |series: &str| data.lines().filter(|row| row.split(',').next() == Some(series)).count();
        match name {
            "force.pdf" => assert!(count("curve") > 2000 && count("stable_equilibrium") == 2, "{name}"),
            "comparison.pdf" => assert_eq!(count("cell"), 3 * 11),
            "ramp.pdf" => assert!(count("run") > 2000 && count("portrait") > 100, "{name}"),
            "ramp-section.pdf" => {
                let times = data.lines().filter(|row| row.starts_with("run,"));
                let times: Vec<f64> =
                    times.map(|row| row.split(',').nth(1).unwrap().parse().unwrap()).collect();
                assert!(times.len() > 100 && times.iter().all(|t| (106.0..=109.0).contains(t)), "{name}");
            }
            _ => assert_eq!(count("cell"), 14 * 11, "{name}"),
        }
    }
}

#[test]
fn panels_of_a_run_are_drawn_alone_or_one_under_the_other() {
    let folder = tempfile::tempdir().unwrap();
    let run = "simulate paper --set run.settle_s=1 --set run.duration_s=3";
    let data = folder.path().join("data.csv");
    // what is seen, and which columns of the run are drawn
    let all = [
        ("displacement", "displacement (mm)", [true, false, false]),
        ("velocity", "velocity (mm/s)", [false, true, false]),
        ("acceleration", "base acceleration (g)", [false, false, true]),
    ];
    for (name, words, drawn) in all {
        let line = format!("{run} --panels {name} --plot-data {}", data.display());
        let texts = texts(&plot(&line, folder.path(), "a.svg"));
        for (_, other, _) in all {
            assert_eq!(texts.iter().any(|text| text == other), other == words, "{name}: {texts:?}");
        }
        assert!(texts.iter().any(|text| text == "time (s)"));
        assert!(!texts.iter().any(|text| text.starts_with("phase portrait") || text.contains("crossings")));
        let rows = fs::read_to_string(&data).unwrap();
        let row: Vec<&str> = rows.lines().find(|row| row.starts_with("run,")).unwrap().split(',').collect();
        assert_eq!([2, 3, 4].map(|place| !row[place].is_empty()), drawn, "{name}: {row:?}");
        assert!(!rows.contains("portrait,"));
    }
    let portrait = texts(&plot(&format!("{run} --panels portrait"), folder.path(), "b.svg"));
    assert!(
        !portrait.iter().any(|text| text == "time (s)")
            && portrait.iter().any(|text| text == "velocity (mm/s)")
    );
    let two = says(&format!("{run} --panels portrait,displacement"), &["displacement (mm)", "time (s)"]);
    assert_eq!(two.iter().filter(|text| *text == "displacement (mm)").count(), 2, "{two:?}");
    // in the order in which they are named
    let order = |panels: &str| {
        let texts = says(&format!("{run} --panels {panels}"), &["time (s)"]);
        let place = |label: &str| texts.iter().position(|text| text == label).unwrap();
        place("velocity (mm/s)") < place("base acceleration (g)")
    };
    assert!(order("velocity,acceleration") && !order("acceleration,velocity"));
    // all of them is the picture with its numbers
    let whole = says(&format!("{run} --panels portrait,velocity,acceleration,displacement"), &["crossings"]);
    assert_eq!(whole, says(run, &["crossings"]));
}

#[test]
fn the_numbers_of_a_contact_picture_are_those_of_its_table() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let stops = "stops=Hertz(travel_limit_mm:1.5,radius_mm:5,young_gpa:69,loss_s_per_m:10.4)";
    let mut command = headless("curve paper --quiet --out /dev/null --set");
    command.arg(stops).arg("--contact").arg(place("c.csv")).arg("--contact-plot").arg(place("c.svg"));
    command.arg("--plot-data").arg(place("d.csv")).assert().success();
    let [table, drawn] = ["c.csv", "d.csv"].map(|name| fs::read_to_string(place(name)).unwrap());
    let first = |text: &str| -> Vec<String> {
        text.lines().skip(1).map(|row| row.split(',').take(3).collect::<Vec<_>>().join(",")).collect()
    };
    assert_eq!(drawn.lines().next(), Some("series,speed_m_per_s,restitution,rigid_restitution"));
    let rows: Vec<&str> = drawn.lines().skip(1).map(|row| row.strip_prefix("contact,").unwrap()).collect();
    assert_eq!(rows, first(&table));
    // beside --plot they are its own
    let mut both = headless("curve paper --quiet --out /dev/null --set");
    both.arg(stops).arg("--plot").arg(place("p.svg")).arg("--contact-plot").arg(place("c.svg"));
    both.arg("--plot-data").arg(place("d.csv")).assert().success();
    assert!(fs::read_to_string(place("d.csv")).unwrap().contains("\ncurve,"));
}
