//! The command `sweep`: rows, columns and its own axes.

use super::{column, headless, refused, stdout};

#[test]
fn sweep_rows_and_columns() {
    let line = "sweep --over stops.travel_limit_mm=1:2:0.5 --over excitation.amplitude_g=0.58,0 --quiet";
    let text = stdout(line);
    let header = "travel_limit_mm,amplitude_g,rms_velocity_m_per_s,regime,crossings,impacts,max_abs_x_m,\
        period,outcome";
    assert_eq!(text.lines().next().unwrap(), header);
    assert_eq!(column(&text, "travel_limit_mm"), ["1", "1", "1.5", "1.5", "2", "2"]);
    assert_eq!(column(&text, "amplitude_g"), ["0.58", "0", "0.58", "0", "0.58", "0"]);
    assert_eq!(column(&text, "regime"), ["interwell", "rest", "rest", "rest", "rest", "rest"]);
    assert!(column(&text, "outcome").iter().all(|outcome| outcome == "done"));
    headless(line).assert().stderr("");

    for jobs in ["1", "2", "3"] {
        assert_eq!(stdout(&format!("{line} --jobs {jobs}")), text, "--jobs {jobs}");
    }
    // A swept mechanism: each row is what the scene alone gives.
    let two = stdout("sweep nominal-cubic --over mechanism.linear_n_per_m=-40,-30 --over mass_g=15,16");
    let alone = stdout("sweep nominal-cubic --set mechanism.linear_n_per_m=-30 --over mass_g=16");
    assert_eq!(column(&two, "rms_velocity_m_per_s")[3..], column(&alone, "rms_velocity_m_per_s"));
}

#[test]
fn the_scenes_own_sweep_is_the_map() {
    let line = "sweep paper --set run.duration_s=0.5 --set run.settle_s=0 --tolerance 1e-3 --quiet";
    let text = stdout(line);
    assert!(text.starts_with("travel_limit_mm,amplitude_g,"));
    assert!(text.lines().count() > 1000);
}

#[test]
fn a_sweep_over_nothing_is_refused() {
    refused(headless("sweep elastic-box"), &["--over"]);
}

#[test]
fn a_sweep_judges_its_cells_and_not_the_scene_that_it_starts_from() {
    let run = |arguments: &[&str]| {
        assert_cmd::Command::new(env!("CARGO_BIN_EXE_interwell"))
            .args(["--headless", "sweep", "nominal-cubic", "--quiet"])
            .args(arguments)
            .output()
            .unwrap()
    };
    let outside = "start=At(x_mm:5,v_m_per_s:0)";
    let good = run(&["--set", outside, "--over", "stops.travel_limit_mm=6:8:1"]);
    assert_eq!(good.status.code(), Some(0), "{}", String::from_utf8_lossy(&good.stderr));
    assert_eq!(String::from_utf8_lossy(&good.stdout).lines().count(), 4);
    let bad = run(&["--set", outside, "--over", "stops.travel_limit_mm=4:8:1"]);
    assert_eq!(bad.status.code(), Some(2));
}
