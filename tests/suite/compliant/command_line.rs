//! Compliant stops on the command line: fields, checks, warnings, sweeps, pictures.

use crate::cli::{headless, stdout};

const ALUMINIUM: &str = "stops=Hertz(travel_limit_mm:1.5,radius_mm:5,young_gpa:69,loss_s_per_m:4.854)";

#[test]
fn check_says_what_an_impact_does_and_what_resting_costs() {
    let text = stdout(&format!("check paper --set {ALUMINIUM}"));
    for words in [
        "k = 3.678e9 N/m^1.5",
        "at 0.1 m/s",
        "at 0.5 m/s",
        "restitution 0.36",
        "1.469 GPa",
        "0.44",
        "rests on one",
        "Hz",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let bare = stdout(
        "check paper --set stops=Hertz(travel_limit_mm:1.5,stiffness_n_per_m1_5:3.68e9,loss_s_per_m:0)",
    );
    assert!(bare.contains("restitution 1,") && !bare.contains("the contact yields"), "{bare}");
}

#[test]
fn check_says_the_loss_at_the_speed_that_occurs() {
    let line = |arguments: &str| -> Option<String> {
        let text = stdout(&format!("check {arguments}"));
        text.lines().find(|line| line.contains("struck at")).map(|line| line.trim().to_owned())
    };
    // `check` runs the scene for no more than a second, in which a busy machine may not get there.
    let said = |arguments: &str| (0..1000).find_map(|_| line(arguments)).unwrap();
    let number = |text: &str, before: &str| -> f64 {
        let after = text.split_once(before).unwrap_or_else(|| panic!("`{before}` is not in: {text}")).1;
        let end = after.find(|c: char| !(c.is_ascii_digit() || ".e-".contains(c))).unwrap_or(after.len());
        after[..end].trim_end_matches(['.', ',']).parse().unwrap()
    };
    // A rigid stop's restitution at the speed of its impacts: a v = 2.427.
    let rigid = said("paper");
    let (speed, loss) = (number(&rigid, "struck at "), number(&rigid, "0.36 there takes loss_s_per_m: "));
    assert!((speed - 0.233).abs() < 1e-3 && (loss * speed - 2.427).abs() < 2e-3, "{rigid}");
    // The documented stop is that one: struck as fast, with that restitution.
    let page = include_str!("../../../docs/scene.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let stops = page.split_once("`stops: Hertz(").unwrap().1.split_once(")`").unwrap().0.replace(' ', "");
    let text = said(&format!("paper --set stops=Hertz({stops})"));
    assert!((number(&text, "restitution ") - 0.36).abs() < 2e-3, "{text}");
    assert!((number(&text, "struck at ") / speed - 1.0).abs() < 0.01, "{text}");
    for (wanted, product) in [("0.8 takes ", 0.3734), ("0.5 takes ", 1.4334), ("0.36 takes ", 2.427)] {
        let found = number(&text, wanted) * number(&text, "struck at ");
        assert!((found / product - 1.0).abs() < 2e-3, "{wanted}: {found}, {text}");
    }
    // Nothing strikes, nothing is said; no loss takes all speed.
    assert_eq!(line("paper --set excitation=None"), None);
    assert_eq!(line("paper-unconstrained"), None);
    assert!(said("paper --set stops.restitution=0").contains("no loss gives a restitution of 0"));
    assert!(said("paper --set stops.restitution=1").contains("1 there takes loss_s_per_m: 0"));
    let uneven = "uneven-stops \
        --set stops=Uneven(left_mm:1.5,right_mm:1.7,restitution_left:0.3,restitution_right:0.5)";
    let uneven = said(uneven);
    assert!(uneven.contains("of 0.3 there takes") && uneven.contains("of 0.5 there takes"), "{uneven}");
}

#[test]
fn a_run_warns_where_aluminium_would_yield() {
    let run = |extra: &str| {
        let out = headless(&format!(
            "simulate paper --set {ALUMINIUM} --set run.duration_s=1 --set run.settle_s=0.5 \
             --out /dev/null --summary - {extra}"
        ))
        .assert()
        .success();
        let out = out.get_output().clone();
        (String::from_utf8(out.stdout).unwrap(), String::from_utf8(out.stderr).unwrap())
    };
    let (summary, warned) = run("");
    assert!(
        warned.contains("warning") && warned.contains("GPa") && warned.contains("stops.yield_gpa"),
        "{warned}"
    );
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert!(summary["peak_contact_force_n"].as_f64().unwrap() > 50.0);
    assert!(summary["peak_contact_pressure_pa"].as_f64().unwrap() > 5e8);
    assert_eq!(run("--set stops.yield_gpa=2").1, "");
    assert_eq!(run("--quiet").1, "");
    let rigid =
        stdout("simulate paper --set run.duration_s=1 --set run.settle_s=0.5 --out /dev/null --summary -");
    let rigid: serde_json::Value = serde_json::from_str(&rigid).unwrap();
    assert!(rigid["peak_contact_force_n"].is_null());
}

#[test]
fn its_fields_are_swept() {
    let csv = stdout(&format!(
        "sweep paper --set {ALUMINIUM} --set run.duration_s=1 --set run.settle_s=0.5 --quiet \
         --over stops.loss_s_per_m=0,5 --over stops.radius_mm=5,10"
    ));
    let rows: Vec<&str> = csv.lines().collect();
    assert!(rows[0].starts_with("loss_s_per_m,radius_mm,rms_velocity_m_per_s"), "{csv}");
    assert_eq!(rows.len(), 5);
    assert!(rows[1..].iter().all(|row| row.ends_with("done")), "{csv}");
    let speed = |row: &str| row.split(',').nth(2).unwrap().parse::<f64>().unwrap();
    assert!(speed(rows[1]) > speed(rows[3]), "without loss it moves faster: {csv}");
}

#[test]
fn restitution_over_impact_speed_as_rows_and_as_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("contact.svg");
    let csv = stdout(&format!(
        "curve paper --set {ALUMINIUM} --out /dev/null --contact - --contact-plot {}",
        picture.display()
    ));
    let rows: Vec<Vec<&str>> = csv.lines().map(|row| row.split(',').collect()).collect();
    assert_eq!(
        rows[0].join(","),
        "speed_m_per_s,restitution,rigid_restitution,contact_time_s,depth_m,peak_force_n,peak_pressure_pa"
    );
    assert_eq!((rows[1][0], rows[1][1], rows[1][2], rows[1][3]), ("0", "1", "0.36", ""));
    let at = rows.iter().find(|row| row[0] == "0.5").unwrap();
    let number = |i: usize| at[i].parse::<f64>().unwrap();
    assert!((number(1) - 0.36).abs() < 1e-4 && (number(6) / 1.469e9 - 1.0).abs() < 1e-3, "{at:?}");
    assert!(
        rows[2..]
            .iter()
            .zip(&rows[1..])
            .all(|(next, row)| { next[1].parse::<f64>().unwrap() < row[1].parse::<f64>().unwrap() })
    );
    let drawn = std::fs::read_to_string(picture).unwrap();
    for words in ["impact speed (m/s)", "restitution", "rigid stop, 0.36", "yields from"] {
        assert!(drawn.contains(words), "{words}");
    }
}

#[test]
fn a_run_on_compliant_stops_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("run.svg");
    headless(&format!(
        "simulate paper --set {ALUMINIUM} --quiet --out /dev/null --plot {}",
        picture.display()
    ))
    .assert()
    .success();
    let drawn = std::fs::read_to_string(picture).unwrap();
    for words in ["450 impacts", "in contact", "contact force up to"] {
        assert!(drawn.contains(words), "{words}");
    }
}
