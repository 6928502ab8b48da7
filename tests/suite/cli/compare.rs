//! `compare`: each column against the study that it is made of, its picture, and what it says of its scenes.

use std::fs;
use std::path::{Path, PathBuf};

use super::{column, headless, stdout};
use crate::plots::texts;

/// The shaking and the run of all scenes here: 0.6 g at 3 Hz.
const RUN: &str = "excitation: Sine(frequency_hz: 3.0, amplitude_g: 0.6), \
                   run: (duration_s: 4.0, settle_s: 2.0), damping: Coefficient(c_n_s_per_m: 0.066)";

const CUBIC: &str = "mechanism: Cubic(linear_n_per_m: -40.0, cubic_n_per_m3: 8.2e5)";
const STOPS: &str = "stops: Rigid(travel_limit_mm: 2.0, restitution: 0.36)";
const COIL: &str = "transducer: Electromagnetic(coupling_v_s_per_m: 3.0, coil_ohm: 40.0, load_ohm: 60.0)";
const DEEP: &str = "mechanism: DoubleWell(equilibrium_mm: 7.0, barrier_mj: 50.0)";

/// Scenes in a folder, each of a name and of what it has besides [`RUN`].
fn scenes(folder: &Path, all: &[(&str, &str)]) -> Vec<PathBuf> {
    let one = |(name, fields): &(&str, &str)| {
        let path = folder.join(name);
        fs::write(&path, format!("(title: \"t\", mass_g: 15.2, {fields}, {RUN})")).unwrap();
        path
    };
    all.iter().map(one).collect()
}

/// What `compare` writes of scenes in a folder, with these options.
fn compared(paths: &[PathBuf], options: &str) -> String {
    let output = headless("compare").args(paths).args(options.split_whitespace()).assert().success();
    String::from_utf8(output.get_output().stdout.clone()).unwrap()
}

/// Crossings and other numbers of the settled motion of a scene with something set, followed for at most so
/// many forcing periods of a frequency in Hz beyond its own run.
fn settled(path: &Path, set: &str, (periods, frequency): (f64, f64)) -> serde_json::Value {
    let until = 4.0 + periods / frequency;
    let mut command =
        headless(&format!("simulate --out /dev/null --summary - --until-settled {until:?} --quiet"));
    command.arg(path);
    if !set.is_empty() {
        command.args(["--set", set]);
    }
    serde_json::from_slice(&command.assert().success().get_output().stdout).unwrap()
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("`{cell}` is no number"))
}

#[track_caller]
fn near(value: f64, known: f64, share: f64) {
    assert!((value - known).abs() <= share * known.abs(), "{value:e} is not {known:e}");
}

#[test]
fn each_column_is_that_of_the_study_it_is_made_of() {
    let folder = tempfile::tempdir().unwrap();
    let free = format!("{CUBIC}, {COIL}");
    let stopped = format!("{CUBIC}, {STOPS}");
    let paths = scenes(folder.path(), &[("free.ron", &free), ("stopped.ron", &stopped)]);
    let csv = compared(&paths, "--quiet");
    let mut ends = 0;
    for (row, path) in paths.iter().enumerate() {
        let cell = |name: &str| column(&csv, name)[row].clone();
        let motion = settled(path, "", (1000.0, 3.0));
        for (name, share) in [("rms_velocity_m_per_s", 1e-12), ("max_abs_x_m", 1e-12)] {
            near(number(&cell(name)), motion[name].as_f64().unwrap(), share);
        }
        for name in ["mean_load_power_w", "impact_speed_max_m_per_s"] {
            match motion.get(name).and_then(serde_json::Value::as_f64) {
                Some(known) => near(number(&cell(name)), known, 1e-12),
                None => assert_eq!(cell(name), "", "{name} of row {row}"),
            }
        }
        // the threshold crosses, and a resolution less does not
        let crosses =
            |set: String, hz: f64| settled(path, &set, (1000.0, hz))["crossings"].as_u64().unwrap() > 0;
        let least = number(&cell("crossing_g"));
        let digit = number(&cell("crossing_resolution_g"));
        assert!(digit < 2e-3 * number(&cell("crossing_step_g")));
        assert!(crosses(format!("excitation.amplitude_g={least}"), 3.0));
        assert!(!crosses(format!("excitation.amplitude_g={}", least - digit), 3.0), "{least}");
        // it is decided where both of them are known
        let low: f64 = cell("crossing_low_g").parse().unwrap_or(0.0);
        let decided = cell("crossing_high_g") == cell("crossing_g") && low > least - 1.5 * digit;
        assert_eq!(cell("crossing_undecided"), (!decided).to_string(), "{csv}");
        // so do the ends of the band that are not those of the search, and a little beyond them does not;
        // without stops the motions at the ends are irregular, and what is beyond is up to rounding
        for (name, beyond) in [("crosses_from_hz", 0.998), ("crosses_to_hz", 1.002)] {
            let end = number(&cell(name));
            // a slower shaking has no two periods in the settled window
            if (1.0..29.99).contains(&end) {
                assert!(crosses(format!("excitation.frequency_hz={end}"), end), "{name} {end}");
                if row == 1 {
                    let beyond = end * beyond;
                    assert!(!crosses(format!("excitation.frequency_hz={beyond}"), beyond), "{name} {end}");
                    ends += 1;
                }
            }
        }
    }
    assert!(ends > 0);
    assert_eq!(column(&csv, "crossing_undecided")[1], "false");
    // the coil's scene has power, the stopped one a release, in closed form
    assert!(number(&column(&csv, "mean_load_power_w")[0]) > 0.0);
    assert_eq!(column(&csv, "release_g")[0], "");
    let line = format!("threshold {} --of release --quiet", paths[1].display());
    assert_eq!(column(&csv, "release_g")[1], column(&stdout(&line), "value")[0]);
    // neither has a size that could be 1 % larger
    assert_eq!(column(&csv, "threshold_sensitivity"), ["", ""]);
}

/// A threshold is one, whichever command is asked: between the last value that is known not to cross and the
/// first that is known to.
#[test]
fn the_harvester_has_one_threshold() {
    let ends = |line: &str, names: [&str; 2]| {
        let csv = stdout(line);
        let [low, high] = names.map(|name| column(&csv, name)[0].parse::<f64>().ok());
        (low.unwrap_or(0.0), high.unwrap_or(f64::INFINITY))
    };
    let compared = ends("compare harvester --quiet", ["crossing_low_g", "crossing_high_g"]);
    // without a range it is the same search
    assert_eq!(ends("threshold harvester --quiet", ["low", "high"]), compared);
    let line = "threshold harvester --of crossing --field excitation.amplitude_g=0.6:0.8:0.02 --quiet";
    let searched = ends(line, ["low", "high"]);
    assert!(compared.0 > 0.7 && compared.1 < 0.75, "{compared:?}");
    assert!(compared.0 <= searched.1 && searched.0 <= compared.1, "{compared:?} {searched:?}");
}

#[test]
fn the_sensitivity_is_that_of_scenes_with_a_size_changed() {
    let folder = tempfile::tempdir().unwrap();
    let magnet = |gap: f64| {
        format!(
            "mechanism: Sum([Cubic(linear_n_per_m: -40.0, cubic_n_per_m3: 8.2e5), \
             Magnet(strength_n_mm4: 300.0, gap_mm: {gap})])"
        )
    };
    let [unchanged, less, more] = [10.0, 9.9, 10.1].map(magnet);
    let paths = scenes(folder.path(), &[("own.ron", &unchanged), ("less.ron", &less), ("more.ron", &more)]);
    let csv = compared(&paths, "--quiet");
    let least: Vec<f64> = column(&csv, "crossing_g").iter().map(|cell| number(cell)).collect();
    let change = least[1..].iter().map(|crossing| (crossing / least[0] - 1.0).abs()).fold(0.0, f64::max);
    assert!(change > 0.01, "{least:?}");
    near(number(&column(&csv, "threshold_sensitivity")[0]), change, 1e-12);
    assert_eq!(column(&csv, "most_sensitive_to")[0], "mechanism.1.gap_mm");
}

#[test]
fn rows_picture_and_data_do_not_depend_on_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    let stopped = format!("{CUBIC}, {STOPS}");
    let still = format!("{DEEP}, {STOPS}");
    let paths =
        scenes(folder.path(), &[("free.ron", CUBIC), ("stopped.ron", &stopped), ("still.ron", &still)]);
    let of = |jobs: usize| {
        let at = |name: &str| folder.path().join(format!("{jobs}-{name}"));
        let mut command = headless("compare --quiet --no-title --plot-width-mm 170");
        command.args(&paths).args(["--jobs", &jobs.to_string(), "--out"]).arg(at("rows.csv"));
        command.arg("--plot").arg(at("a.svg")).arg("--plot-data").arg(at("data.csv"));
        command.assert().success().stdout("").stderr("");
        ["rows.csv", "a.svg", "data.csv"].map(at)
    };
    let (one, three) = (of(1), of(3));
    for name in [0, 2] {
        assert_eq!(fs::read(&one[name]).unwrap(), fs::read(&three[name]).unwrap());
    }
    let words = texts(&one[1]);
    assert_eq!(words, texts(&three[1]));
    for word in ["free.ron", "still.ron", "crosses from", "reach", "fastest impact", "leaves its stop from"] {
        assert!(words.iter().any(|text| text == word), "`{word}` is not in {words:?}");
    }
    // what is not there is not drawn
    for word in ["power", "sensitivity"] {
        assert!(words.iter().all(|text| text != word), "`{word}` is in {words:?}");
    }
    // the data are the cells that have a value, in the same digits
    let (rows, data) = (fs::read_to_string(&one[0]).unwrap(), fs::read_to_string(&one[2]).unwrap());
    assert_eq!(data.lines().next(), Some("series,scene,value"));
    let names =
        rows.lines().next().unwrap().split(',').filter(|name| !["scene", "most_sensitive_to"].contains(name));
    let mut count = 0;
    for name in names {
        for (scene, value) in
            column(&rows, "scene").iter().zip(column(&rows, name)).filter(|pair| !pair.1.is_empty())
        {
            let value = match value.as_str() {
                "true" => "1",
                "false" => "0",
                number => number,
            };
            assert!(data.lines().any(|line| line == format!("{name},{scene},{value}")), "{name} of {scene}");
            count += 1;
        }
    }
    assert!(count >= 15 && data.lines().count() == count + 1, "{count}");
}

/// Whatever a scene is, each cell that is empty is named on standard error with its scene.
#[test]
fn every_empty_cell_is_explained() {
    let folder = tempfile::tempdir().unwrap();
    let table = format!("{}, start: Rest", "mechanism: Linear(n_per_m: 40.0)");
    let thrown = "mechanism: Cubic(linear_n_per_m: -40.0, cubic_n_per_m3: 8.2e5), \
                  stops: Uneven(right_mm: 6.0, restitution_right: 0.5)";
    let weak = "mechanism: DoubleWell(equilibrium_mm: 7.0, barrier_mj: 1e-6), stops: Rigid(travel_limit_mm: \
                1.0, restitution: 0.0)";
    let inside = format!("{DEEP}, stops: Rigid(travel_limit_mm: 9.0, restitution: 0.2), {COIL}");
    let paths = scenes(
        folder.path(),
        &[("one.ron", &table), ("thrown.ron", thrown), ("weak.ron", weak), ("inside.ron", &inside)],
    );
    for more in ["", "--set excitation.amplitude_g=0", "--set excitation.amplitude_g=8"] {
        let mut command = headless("compare --jobs 2");
        let output = command.args(&paths).args(more.split_whitespace()).assert().success();
        let [csv, said] = [&output.get_output().stdout, &output.get_output().stderr]
            .map(|text| String::from_utf8(text.clone()).unwrap());
        let header: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
        for row in csv.lines().skip(1).map(|row| row.split(',').collect::<Vec<_>>()) {
            for (name, _) in header.iter().zip(&row).filter(|(_, cell)| cell.is_empty()) {
                let explains = |line: &str| {
                    let columns = line.split_once(": no ").and_then(|(_, rest)| rest.split_once(": "));
                    line.contains(row[0])
                        && columns.is_some_and(|(names, _)| names.split(", ").any(|heading| heading == *name))
                };
                assert!(said.lines().any(explains), "{name} of {} {more}:\n{csv}{said}", row[0]);
            }
        }
    }
}

#[test]
fn what_a_row_cannot_say_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let still = format!("{DEEP}, {STOPS}");
    let single = "mechanism: Linear(n_per_m: 40.0)";
    let paths = scenes(folder.path(), &[("still.ron", &still), ("single.ron", single)]);
    let said = |paths: &[PathBuf], more: &str| {
        let mut command = headless("compare --out /dev/null");
        let output = command.args(paths).args(more.split_whitespace()).assert().success();
        String::from_utf8(output.get_output().stderr.clone()).unwrap()
    };
    let both = said(&paths, "");
    assert!(both.contains("still.ron: 0.6 g does not move it"), "{both}");
    assert!(!both.contains("only scene") && !both.contains("rated with"), "{both}");
    // every empty cell of a row has a reason, one line for all that it is the same of
    let [first, second] = [&paths[0], &paths[1]].map(|path| path.display().to_string());
    for line in [
        format!("{first}, {second}: no mean_load_power_w: it has no transducer\n"),
        format!("{first}: no impact_speed_max_m_per_s: it strikes no stop\n"),
        format!(
            "{first}: no crosses_from_hz, crosses_to_hz: no frequency that was tried makes its settled \
             motion cross at 0.6 g\n"
        ),
        format!(
            "{first}: no threshold_sensitivity, most_sensitive_to: its mechanism has no length, thickness or \
             gap to change\n"
        ),
        format!("{second}: no release_g: it rests on no stop\n"),
        format!("{second}: no impact_speed_max_m_per_s: it has no stops\n"),
        format!(
            "{second}: no crossing_g, crossing_low_g, crossing_high_g, crossing_undecided, crossing_step_g, \
             crossing_resolution_g, crosses_from_hz, crosses_to_hz, threshold_sensitivity, \
             most_sensitive_to: no barrier between two wells, so nothing to cross\n"
        ),
    ] {
        assert!(both.contains(&line), "{line}{both}");
    }
    let alone = said(&paths[1..], "");
    assert!(alone.contains("single.ron: the only scene; name others to set beside it"), "{alone}");
    let lent = said(&paths[1..], "--environment duffing");
    assert!(
        lent.contains("single.ron: rated with the excitation and run of built-in duffing, not with its own"),
        "{lent}"
    );
    let text = |name: &str, run: &str| {
        let path = folder.path().join(name);
        let shaken = "excitation: Sine(frequency_hz: 3.0, amplitude_g: 0.5)";
        fs::write(&path, format!("(title: \"t\", mass_g: 15.2, {single}, {shaken}, {run})")).unwrap();
        path
    };
    // a settled window that is left out begins in the middle: the runs are the same
    let weak = text("weak.ron", "run: (duration_s: 4.0)");
    let lent = said(&[paths[1].clone(), weak], "");
    let lender = paths[1].display();
    assert!(
        lent.contains(&format!("weak.ron: rated with the excitation of {lender}, not with its own\n")),
        "{lent}"
    );
    assert_eq!(said(&paths, "--quiet"), "");
}
