//! The command `basins`: rows, attractors, random starts, manifest and picture.

use std::fs;

use super::{column, headless, stdout};

const PAPER: &str = "basins paper --set excitation.amplitude_g=0 --quiet";

#[test]
fn rows_number_the_attractors_by_the_first_start_and_are_the_same_for_any_number_of_jobs() {
    let line = "basins duffing --set excitation.amplitude_g=0.02 --x-mm -1500:1500:9 --v -1:1:5 --quiet";
    let text = stdout(line);
    assert_eq!(text.lines().next().unwrap(), "x_mm,v_m_per_s,attractor,periods,sure");
    assert_eq!(column(&text, "x_mm")[..6], ["-1500", "-1500", "-1500", "-1500", "-1500", "-1125"]);
    assert_eq!(column(&text, "v_m_per_s")[..5], ["-1", "-0.5", "0", "0.5", "1"]);
    let mut seen = 0;
    for number in column(&text, "attractor").iter().map(|cell| cell.parse::<u64>().unwrap()) {
        assert!(number >= 1 && number <= seen + 1);
        seen = seen.max(number);
    }
    assert!(seen >= 2);
    for jobs in ["1", "2", "3"] {
        assert_eq!(stdout(&format!("{line} --jobs {jobs}")), text, "--jobs {jobs}");
    }
    let attractors = stdout(&format!("{line} --out /dev/null --attractors -"));
    assert_eq!(
        attractors.lines().next().unwrap(),
        "attractor,regime,period,side,rms_velocity_m_per_s,x_m,v_m_per_s,starts,share,share_low,share_high"
    );
    let counts =
        column(&attractors, "starts").iter().map(|cell| cell.parse::<usize>().unwrap()).sum::<usize>();
    assert_eq!(counts, 45);
    assert_eq!(column(&attractors, "attractor").len() as u64, seen);
}

#[test]
fn starts_beyond_the_stops_have_no_attractor_and_no_part_in_the_shares() {
    let line = format!("{PAPER} --x-mm -2:2:5 --v 0:0:1");
    let text = stdout(&line);
    assert_eq!(column(&text, "attractor")[..2], ["", "1"]);
    assert_eq!(column(&text, "attractor")[3..], ["2", ""]);
    assert_eq!(column(&text, "periods")[4], "");
    let shares = column(&stdout(&format!("{line} --out /dev/null --attractors -")), "share");
    // of three starts inside; the one on the top of the barrier goes nowhere
    assert!(shares.iter().all(|share| share.starts_with("0.3333")), "{shares:?}");
    let loud = line.replace("--quiet", "--out /dev/null");
    let told = headless(&loud).assert().success().get_output().stderr.clone();
    let told = String::from_utf8(told).unwrap();
    assert!(told.contains("2 outside the room of the mass, 1 not settled"), "{told}");
}

#[test]
fn a_start_that_leaves_the_table_has_no_attractor() {
    let line = "basins paper-unconstrained --x-mm 0:0:1 --v -9:9:2 --out /dev/null";
    let told = headless(line).assert().success().get_output().stderr.clone();
    assert!(String::from_utf8(told).unwrap().contains("2 starts, 0 attractors, 2 ended early"));
    let text = stdout("basins paper-unconstrained --x-mm 0:0:1 --v -9:9:2 --quiet");
    assert_eq!(column(&text, "attractor"), ["", ""]);
}

#[test]
fn random_starts_come_from_their_seed() {
    let line = |seed: &str| stdout(&format!("{PAPER} --x-mm -1.5:1.5 --v -0.2:0.2 --random 40 {seed}"));
    let rows = line("--seed 3");
    assert_eq!(rows.lines().count(), 41);
    assert!(column(&rows, "x_mm").iter().all(|x| x.parse::<f64>().unwrap().abs() <= 1.5));
    assert_eq!(rows, line("--seed 3 --jobs 3"));
    assert_ne!(rows, line("--seed 4"));
    assert_eq!(line(""), line("--seed 0"));
}

#[test]
fn what_stands_beside_the_rows() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let mut command = headless(&format!("{PAPER} --x-mm -2:2:9 --v -0.1:0.1:3"));
    command.arg("--out").arg(place("rows.csv")).arg("--plot").arg(place("map.svg"));
    command.assert().success();
    let manifest: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(place("rows.csv.json")).unwrap()).unwrap();
    assert_eq!((&manifest["command"], &manifest["starts"]), (&"basins".into(), &27.into()));
    assert_eq!((&manifest["attractors"], &manifest["outside"]), (&2.into(), &6.into()));
    assert_eq!((&manifest["not_sure"], &manifest["out_of_work"]), (&0.into(), &0.into()));
    let svg = fs::read_to_string(place("map.svg")).unwrap();
    for words in
        ["rest left", "rest right", "displacement at the start (mm)", "none found", "9 \u{d7} 3 starts"]
    {
        assert!(svg.contains(words), "{words}");
    }
    // the manifest is a scene
    let again = headless("basins")
        .arg(place("rows.csv.json"))
        .args(["--quiet", "--v", "-0.1:0.1:3"])
        .args(["--x-mm", "-2:2:9"])
        .assert()
        .success()
        .get_output()
        .stdout
        .clone();
    assert_eq!(again, fs::read(place("rows.csv")).unwrap());
}

#[test]
fn one_start_is_a_map() {
    let text = stdout(&format!("{PAPER} --x-mm 1:1:1 --v 0:0:1"));
    assert_eq!(text.lines().nth(1).unwrap(), "1,0,1,1,true");
    let folder = tempfile::tempdir().unwrap();
    let plot = folder.path().join("one.png");
    headless(&format!("{PAPER} --x-mm 1:1:1 --v 0:0:1 --out /dev/null --plot")).arg(&plot).assert().success();
    assert!(fs::metadata(plot).unwrap().len() > 1000);
}

#[test]
fn what_is_not_sure_is_marked_and_counted() {
    let line = "basins duffing --set mass_g=1000 --set damping=Coefficient(c_n_s_per_m:0.15) \
                --set mechanism=Cubic(linear_n_per_m:-1,cubic_n_per_m3:1) \
                --set excitation=Force(amplitude_n:0.2,frequency_rad_per_s:1) \
                --x-mm -2000:2000:15 --v -1.5:1.5:11";
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("map.svg");
    let assert = headless(line).arg("--plot").arg(&picture).assert().success();
    let output = assert.get_output();
    let rows = String::from_utf8(output.stdout.clone()).unwrap();
    let sure = column(&rows, "sure");
    let unsure = sure.iter().filter(|word| **word == "false").count();
    assert!(unsure > 0 && sure.iter().filter(|word| **word == "true").count() > 40, "{unsure}");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains(&format!(", {unsure} not sure")), "{said}");
    assert!(fs::read_to_string(picture).unwrap().contains("paler: not sure"));
    assert!(stdout("basins --help").contains("A row is `sure` where"));
    // the same for any number of threads
    assert_eq!(stdout(&format!("{line} --jobs 1")), stdout(&format!("{line} --jobs 3")));
}

/// A well of 700 Hz under a drive of 1.4 Hz.
#[test]
fn a_map_that_may_take_long_says_so_first() {
    let well = "mass_g: 1, mechanism: DoubleWell(equilibrium_mm: 1, barrier_mj: 2.4), damping: Ratio(1e-6)";
    let drive = "excitation: Sine(frequency_hz: 1.4, amplitude_g: 1), run: (duration_s: 10)";
    let scene = format!("(title: \"fast\", {well}, {drive})");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fast.ron");
    fs::write(&path, scene).unwrap();
    let mut command = headless("basins --x-mm 1:1:1 --v 0.1:0.1:1");
    let output = command.arg(&path).assert().success().get_output().clone();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.starts_with("a forcing period takes some "), "{said}");
    assert!(said.contains("1000") && said.lines().count() == 2, "{said}");
}
