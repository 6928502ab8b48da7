//! The command `section` and walks of `sweep`: columns, the same bytes on any number of threads, remarks.

use std::fs;

use predicates::str::contains;

use super::{column, headless, stdout};

const SHORT: &str = "--set run.duration_s=4 --set run.settle_s=2 --quiet";

#[test]
fn sections_have_their_columns() {
    let states = stdout(&format!("section paper {SHORT}"));
    assert_eq!(states.lines().next().unwrap(), "index,t_s,x_m,v_m_per_s");
    assert_eq!(column(&states, "index"), ["0", "1", "2", "3", "4", "5"]);
    assert_eq!(column(&states, "t_s")[..2], ["2", "2.3333333333333335"]);
    let impacts = stdout(&format!("section paper --at impacts {SHORT}"));
    assert_eq!(impacts.lines().next().unwrap(), "index,t_s,side,phase_deg,v_in_m_per_s");
    assert!(column(&impacts, "side").iter().all(|side| side == "left" || side == "right"));
    let over = "--over stops.travel_limit_mm=1.5,2 --over excitation.amplitude_g=0.6,1";
    let diagram = stdout(&format!("section paper {over} --phase-deg -90 {SHORT}"));
    assert_eq!(diagram.lines().next().unwrap(), "travel_limit_mm,amplitude_g,index,t_s,x_m,v_m_per_s");
    assert_eq!(diagram.lines().count(), 1 + 4 * 6);
    let strong = over.replace("0.6,1", "1.1,1.2");
    let walked = stdout(&format!("section paper {strong} --at impacts --carry down {SHORT}"));
    let header = "travel_limit_mm,amplitude_g,direction,index,t_s,side,phase_deg,v_in_m_per_s";
    assert_eq!(walked.lines().next().unwrap(), header);
    let amplitudes = column(&walked, "amplitude_g");
    assert_eq!((amplitudes[0].as_str(), amplitudes.last().unwrap().as_str()), ("1.2", "1.1"));
    // A cell that is not carried is the section of its scene.
    let alone = stdout(&format!("section paper --set stops.travel_limit_mm=2 --phase-deg 270 {SHORT}"));
    assert_eq!(column(&diagram, "x_m")[18..], column(&alone, "x_m"));
    // Without motion, and without a period.
    let still = stdout(&format!("section paper --set excitation.amplitude_g=0 {SHORT}"));
    assert_eq!(column(&still, "v_m_per_s"), ["0"; 6]);
    let ball = stdout("section bouncing-ball --at impacts --quiet");
    assert!(ball.lines().count() > 2 && column(&ball, "phase_deg").iter().all(String::is_empty));
}

#[test]
fn walks_are_the_same_on_any_number_of_threads() {
    for line in [
        "section paper --over stops.travel_limit_mm=1.5:3:0.5 --over excitation.amplitude_g=0.4:1.4:0.1 \
         --carry both",
        "section paper-unconstrained --over excitation.amplitude_g=1:1.3:0.02 --skip 20 --keep 5",
        "sweep paper --over stops.travel_limit_mm=1.5:3:0.25 --over excitation.amplitude_g=0.4:1.4:0.1 \
         --carry both --columns rms_velocity_m_per_s,final_x_m,mean_x_m --until-settled 12",
        "sweep paper-unconstrained --over excitation.frequency_hz=2:4:0.2 --carry both",
    ] {
        let text = stdout(&format!("{line} {SHORT} --jobs 1"));
        assert!(text.lines().count() > 20);
        for jobs in ["2", "4"] {
            assert_eq!(stdout(&format!("{line} {SHORT} --jobs {jobs}")), text, "{line} --jobs {jobs}");
        }
    }
}

#[test]
fn skip_and_keep_count_forcing_periods() {
    let text = stdout("section paper --skip 9 --keep 4 --over excitation.frequency_hz=2,4 --quiet");
    assert_eq!(column(&text, "index"), ["0", "1", "2", "3", "0", "1", "2", "3"]);
    assert_eq!(column(&text, "t_s"), ["4.5", "5", "5.5", "6", "2.25", "2.5", "2.75", "3"]);
}

#[test]
fn a_diagram_has_a_manifest_and_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let run = |line: &str| {
        headless(&format!("{line} {SHORT}")).current_dir(folder.path()).assert().success();
    };
    run("section paper --over excitation.amplitude_g=0.5:1:0.05 --carry both --out d.csv --plot d.svg");
    let manifest: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("d.csv.json")).unwrap()).unwrap();
    assert_eq!((&manifest["command"], &manifest["cells"]), (&"section".into(), &22.into()));
    let text = fs::read_to_string(folder.path().join("d.svg")).unwrap();
    for words in ["up", "down", "with impacts", "without impacts", "amplitude (g)", "displacement (mm)"] {
        assert!(text.contains(&format!(">{words}</text>")), "{words}");
    }
    run("section paper --plot s.svg --out s.csv");
    assert!(fs::read_to_string(folder.path().join("s.svg")).unwrap().contains("displacement (mm)"));
    run("section paper --at impacts --plot i.svg --out i.csv");
    assert!(fs::read_to_string(folder.path().join("i.svg")).unwrap().contains("phase of the drive"));
    // of motions that have not settled none is named
    headless("sweep monostable --over excitation.frequency_hz=12:16:1 --carry both --out w.csv --plot w.svg")
        .current_dir(folder.path())
        .assert()
        .success();
    let text = fs::read_to_string(folder.path().join("w.svg")).unwrap();
    assert!(text.contains(">hysteresis</text>"));
    assert!(
        text.contains("2 \u{d7} 5 runs of ") && text.contains(", up and down, each from the end of"),
        "{text}"
    );
    // with stops both ways are the same: no hysteresis is named
    run("sweep paper --over excitation.amplitude_g=0.5:1:0.05 --carry both --out w.csv --plot w.svg");
    assert!(!fs::read_to_string(folder.path().join("w.svg")).unwrap().contains("hysteresis"));
    run("sweep paper --over excitation.amplitude_g=0.5:1:0.05 --carry down --out w.csv --plot w.svg");
    let text = fs::read_to_string(folder.path().join("w.svg")).unwrap();
    assert!(text.contains("11 runs of ") && text.contains(", down, each from the end of"), "{text}");
    run("sweep paper --over stops.travel_limit_mm=1.5:3:0.5 --over excitation.amplitude_g=0.5,1 \
         --carry both --out m.csv --plot m.svg");
    let text = fs::read_to_string(folder.path().join("m.svg")).unwrap();
    assert!(text.contains(">down \u{2212} up</text>"), "the difference of the two maps");
}

#[test]
fn a_section_without_rows_says_why() {
    let mut command = headless("section paper-unconstrained --at impacts");
    command.assert().success().stderr(contains("no impact counts"));
    headless("section paper --at impacts").assert().success().stderr("");
    // that a run ended early is said however quiet the command is
    let left = "section duffing --quiet --set mechanism=Table(path:\"force_dl2.7.csv\") --set mass_g=100 \
                --set start=Rest --set excitation.amplitude_g=30 --set excitation.frequency_hz=3 \
                --set damping=None";
    headless(left).assert().success().stderr(contains("ended early"));
}
