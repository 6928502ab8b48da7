//! Sweeps that are written in blocks: ended by a full disk, a signal or a kill, they go on where they were;
//! what was changed meanwhile is refused with what differs.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command as Process, Stdio};

use interwell::system::checksum::checksum;
use predicates::prelude::*;
use predicates::str::contains;

use super::{headless, refused, stdout};

/// Cheap cells, more than two blocks of them.
const MAP: &str = "sweep nominal-cubic --quiet --set run.duration_s=0.2 --set run.settle_s=0 \
    --tolerance 1e-3 --over excitation.amplitude_g=0:2:0.001 --over stops.travel_limit_mm=1:3.5:0.5";

/// An unfinished sweep in a folder of its own: one that was not let write more than so many kB to a file.
struct Unfinished {
    folder: tempfile::TempDir,
    line: String,
}

impl Unfinished {
    #[track_caller]
    fn new(line: &str, kb: u32) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let sweep = Self { folder, line: format!("{line} --out") };
        let program = assert_cmd::cargo::cargo_bin!("interwell");
        let mut limited = Process::new("bash");
        limited.args(["-c", &format!("trap '' XFSZ; ulimit -f {kb}; exec \"$0\" \"$@\"")]);
        limited.arg(program).arg("--headless").args(sweep.line.split_whitespace()).arg(sweep.path("map.csv"));
        let end = limited.output().unwrap();
        let said = String::from_utf8_lossy(&end.stderr).into_owned();
        assert_eq!(end.status.code(), Some(1), "{said}");
        assert!(said.contains("map.csv.part") && said.contains("rows are kept"), "{said}");
        assert!(said.contains("--resume") && said.lines().count() == 1, "{said}");
        assert!(sweep.path("map.csv.part").exists() && !sweep.path("map.csv").exists());
        sweep
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The same sweep with more options.
    fn again(&self, options: &str) -> assert_cmd::Command {
        let mut command = headless(&self.line);
        command.arg(self.path("map.csv")).args(options.split_whitespace());
        command
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// Part and journal.
    fn bytes(&self) -> [Vec<u8>; 2] {
        ["map.csv.part", "map.csv.part.journal"].map(|name| fs::read(self.path(name)).unwrap())
    }

    /// The blocks that the journal has, that of the header among them.
    fn blocks(&self) -> usize {
        self.read("map.csv.part.journal").lines().count() - 1
    }

    /// Asserts that these options end it with the rows of a sweep that nobody disturbed and nothing beside
    /// them.
    #[track_caller]
    fn ends(&self, options: &str) {
        self.again(options).assert().success().stderr("");
        let undisturbed = tempfile::tempdir().unwrap();
        let other = undisturbed.path().join("map.csv");
        headless(&self.line).arg(&other).assert().success();
        assert!(self.read("map.csv") == fs::read_to_string(&other).unwrap(), "other rows after {options}");
        assert_eq!(names(self.folder.path()), ["map.csv", "map.csv.json"]);
        let counts = |folder: &Path| {
            let text = fs::read_to_string(folder.join("map.csv.json")).unwrap();
            let all: serde_json::Value = serde_json::from_str(&text).unwrap();
            let keys =
                ["cells", "mechanisms", "outcomes", "regimes", "sha256", "plan", "plan_sha256", "shard"];
            keys.map(|key| all[key].clone())
        };
        assert_eq!(counts(self.folder.path()), counts(undisturbed.path()));
        assert_eq!(counts(self.folder.path())[4], checksum(self.read("map.csv").as_bytes()));
    }

    /// Asserts that it is refused and changes nothing.
    #[track_caller]
    fn refuses(&self, options: &str, status: i32, words: &[&str]) {
        let before = self.bytes();
        let assert = self.again(options).assert().code(status).stdout("");
        let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        for word in words {
            assert!(text.contains(word), "`{word}` is not in: {text}");
        }
        assert_eq!(text.lines().count(), 1, "{text}");
        assert_eq!(before, self.bytes());
        assert!(!self.path("map.csv").exists());
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    // what a kill leaves of an output that appears whole
    let mut names: Vec<String> = entries.filter(|name| !name.starts_with(".interwell-")).collect();
    names.sort();
    names
}

#[test]
fn a_file_that_cannot_grow_is_gone_on_with() {
    let sweep = Unfinished::new(MAP, 400);
    assert!(sweep.blocks() >= 2, "a block and the header");
    sweep.refuses("", 2, &["map.csv.part", "of 12006 rows", "--resume", "--force"]);
    // what was not whole is dropped, and so is a line that was being written
    for name in ["map.csv.part", "map.csv.part.journal"] {
        fs::write(sweep.path(name), sweep.read(name) + "0.5,1,torn").unwrap();
    }
    sweep.ends("--resume --jobs 3");
    sweep.again("--resume").assert().success();
    let said = String::from_utf8(sweep.again("--resume").output().unwrap().stderr).unwrap();
    assert_eq!(said, "", "all rows are there");
    fs::remove_file(sweep.path("map.csv.json")).unwrap();
    sweep.ends("--resume");
    // A walk is gone on with at its beginning.
    let walks = "sweep nominal-cubic --quiet --set run.duration_s=0.4 --set run.settle_s=0 --tolerance 1e-3 \
        --over stops.travel_limit_mm=1:6:0.04 --over excitation.amplitude_g=0:2:0.05 --carry both --jobs 1";
    let sweep = Unfinished::new(walks, 300);
    assert!(sweep.blocks() >= 2);
    sweep.ends("--resume");
    // One of more cells than leave at once too.
    let long = walks.replace("1:6:0.04", "1:6:0.1").replace("0:2:0.05", "0:2.99:0.01");
    let sweep = Unfinished::new(&long, 600);
    assert!(sweep.blocks() >= 2);
    sweep.ends("--resume");
}

#[test]
fn force_begins_anew() {
    let sweep = Unfinished::new(MAP, 400);
    sweep.ends("--force");
}

#[test]
fn a_changed_byte_is_found_and_nothing_is_lost() {
    let sweep = Unfinished::new(MAP, 500);
    assert!(sweep.blocks() >= 3, "two blocks and the header");
    let flip = |name: &str, share: f64| {
        let mut bytes = fs::read(sweep.path(name)).unwrap();
        let at = (bytes.len() as f64 * share) as usize;
        bytes[at] ^= 1;
        fs::write(sweep.path(name), bytes).unwrap();
    };
    flip("map.csv.part", 0.1);
    sweep.refuses("--resume", 1, &["rows 1 to ", "changed", "nothing was changed", "--force"]);
    flip("map.csv.part", 0.1);
    flip("map.csv.part", 0.5);
    sweep.refuses("--resume", 1, &["changed", "--resume --force keeps the "]);
    // a line of the journal that is not the last one: that one might be torn
    let journal = sweep.read("map.csv.part.journal");
    let third = journal.match_indices('\n').nth(1).unwrap().0 + 40;
    flip("map.csv.part.journal", third as f64 / journal.len() as f64);
    sweep.refuses("--resume", 1, &["what its journal says after row 0 is changed"]);
    sweep.ends("--resume --force");

    let sweep = Unfinished::new(MAP, 400);
    fs::write(sweep.path("map.csv.part"), &sweep.bytes()[0][..1000]).unwrap();
    sweep.refuses("--resume", 1, &["rows 1 to ", "missing"]);
    fs::write(sweep.path("map.csv.part.journal"), "no journal").unwrap();
    sweep.refuses("--resume", 2, &["journal", "--force"]);
    sweep.ends("--force");
}

#[test]
fn rows_of_another_sweep_are_refused_with_what_differs() {
    let sweep = Unfinished::new(MAP, 400);
    for (options, words) in [
        ("--set mass_g=16", &["scene.mass_g is 15.2 there and 16"][..]),
        ("--set damping=None", &["scene.damping", "none here"]),
        ("--columns regime", &["columns"]),
        ("--shard 1/2", &["shard is 1/1 there and 1/2 here"]),
        ("--set run.duration_s=0.1", &["scene.run.duration_s is 0.2 there and 0.1 here"]),
        ("--over mass_g=1,2", &["grid"]),
    ] {
        let mut all = vec!["--resume"];
        all.extend(words);
        sweep.refuses(&format!("{options} --resume"), 2, &all);
    }
    // other values of the same number on an axis
    let other = Unfinished { folder: sweep.folder, line: sweep.line.replace("1:3.5:0.5", "1.5:4:0.5") };
    other.refuses("--resume", 2, &["grid.1", "6 values from 1 to 3.5", "6 values from 1.5 to 4"]);
    let sweep = Unfinished { line: other.line.replace("1.5:4:0.5", "1:3.5:0.5"), ..other };
    // another version of the program
    let journal = sweep.read("map.csv.part.journal");
    let (head, blocks) = journal.split_once('\n').unwrap();
    let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    let json = head.split_once(' ').unwrap().1.replace(&version, "\"version\":\"0.0.9\"");
    let head = format!("{} {json}", &checksum(json.as_bytes())[..16]);
    fs::write(sweep.path("map.csv.part.journal"), format!("{head}\n{blocks}")).unwrap();
    sweep.refuses("--resume", 2, &["version is 0.0.9 there and", env!("CARGO_PKG_VERSION")]);
}

#[test]
fn a_table_that_changed_meanwhile_is_another_sweep() {
    let folder = tempfile::tempdir().unwrap();
    headless("presets --write").arg(folder.path()).assert().success();
    let scene = folder.path().join("paper-table.ron");
    let over =
        "--over excitation.amplitude_g=0:2:0.0002 --set run.duration_s=0.2 --set run.settle_s=0 --quiet";
    let line = format!("sweep {} --tolerance 1e-3 {over}", scene.display());
    let sweep = Unfinished::new(&line, 300);
    let text = fs::read_to_string(&scene).unwrap();
    let table = text.split("path: \"").nth(1).unwrap().split('"').next().unwrap();
    let table = folder.path().join(table);
    fs::write(&table, fs::read_to_string(&table).unwrap() + "# a comment\n").unwrap();
    sweep.refuses("--resume", 2, &["files.", " there and "]);
}

#[test]
fn one_process_alone_writes_a_file() {
    let sweep = Unfinished::new(MAP, 400);
    let lock = fs::File::open(sweep.path("map.csv.part.journal")).unwrap();
    lock.lock().unwrap();
    for options in ["--resume", "--force", ""] {
        sweep.refuses(options, 2, &["another process is writing", "map.csv"]);
    }
    drop(lock);
    sweep.ends("--resume");
}

#[test]
fn killed_before_its_header_is_in_the_journal_it_begins_anew() {
    let sweep = Unfinished::new(MAP, 400);
    let journal = sweep.read("map.csv.part.journal");
    let (head, _) = journal.split_once('\n').unwrap();
    fs::write(sweep.path("map.csv.part.journal"), format!("{head}\n")).unwrap();
    sweep.ends("--resume");
}

/// Starts the sweep with these options and waits until its journal has so many lines, or it has ended.
#[cfg(unix)]
fn started(sweep: &Unfinished, options: &str, lines: usize) -> std::process::Child {
    let mut child = Process::new(assert_cmd::cargo::cargo_bin!("interwell"))
        .arg("--headless")
        .args(sweep.line.split_whitespace())
        .arg(sweep.path("map.csv"))
        .args(options.split_whitespace())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let journal = || fs::read_to_string(sweep.path("map.csv.part.journal")).unwrap_or_default();
    while journal().matches('\n').count() < lines && child.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    child
}

#[cfg(unix)]
#[test]
fn killed_again_and_again_it_ends_with_the_same_bytes() {
    let sweep = Unfinished {
        folder: tempfile::tempdir().unwrap(),
        line: format!("{} --out", MAP.replace("0.001", "0.0002")),
    };
    let (mut kills, mut lines) = (0, 0);
    while kills < 10 {
        let mut child = started(&sweep, "--resume --jobs 2", lines + 1);
        let _ = child.kill();
        let end = child.wait().unwrap();
        if end.success() {
            break;
        }
        kills += 1;
        let journal = fs::read_to_string(sweep.path("map.csv.part.journal")).unwrap_or_default();
        lines = journal.matches('\n').count().max(lines);
    }
    assert!(kills >= 2, "it ended before it was killed");
    sweep.ends("--resume");
}

#[cfg(unix)]
#[test]
fn a_request_to_end_keeps_the_rows() {
    // more cells than can be run before the signal
    let over = "--over stops.travel_limit_mm=1:7:0.01 --over excitation.amplitude_g=0:2:0.01";
    let line = format!("sweep paper --quiet {over} --out");
    let sweep = Unfinished { folder: tempfile::tempdir().unwrap(), line };
    let child = started(&sweep, "", 2);
    assert!(Process::new("kill").arg("-INT").arg(child.id().to_string()).status().unwrap().success());
    let end = child.wait_with_output().unwrap();
    assert_eq!(end.status.code(), Some(1));
    let said = String::from_utf8_lossy(&end.stderr).into_owned();
    assert!(said.contains("interrupted"), "{said}");
    match names(sweep.folder.path())[..] {
        // before the first row
        [] => assert!(said.contains("no output file was made"), "{said}"),
        _ => {
            assert_eq!(names(sweep.folder.path()), ["map.csv.part", "map.csv.part.journal"]);
            assert!(said.contains("of 120801 rows") && said.contains("--resume"), "{said}");
            sweep.refuses("", 2, &["of 120801 rows"]);
        }
    }
}

#[test]
fn a_picture_of_rows_that_were_there_is_the_same() {
    // what marks transients on its lines
    let line = format!("{MAP} --columns rms_velocity_m_per_s,regime,outcome,settled,steady");
    let sweep = Unfinished::new(&line, 200);
    let [a, b] = ["a.png", "b.png"].map(|name| sweep.path(name));
    sweep.refuses(
        &format!("--resume --quantity travel_m --plot {}", a.display()),
        2,
        &["travel_m", "--plot"],
    );
    sweep.again("--resume --plot").arg(&a).assert().success();
    headless(&line).args(["--out", "/dev/null", "--plot"]).arg(&b).assert().success();
    assert_eq!(fs::read(a).unwrap(), fs::read(b).unwrap());
}

/// Dots on a map need columns that are not written by default; rows that were there are drawn without them.
#[test]
fn a_map_of_rows_that_were_there_says_that_it_has_no_dots() {
    let line = "sweep paper --set run.duration_s=2 --set run.settle_s=1 \
        --over stops.travel_limit_mm=1:7:0.0625 --over excitation.amplitude_g=0.5:1.5:0.01";
    let sweep = Unfinished::new(line, 400);
    let data = sweep.path("d.csv");
    let drawn = |mut command: assert_cmd::Command| {
        let said = command.arg("--plot-data").arg(&data).assert().success().get_output().stderr.clone();
        let rows = fs::read_to_string(&data).unwrap();
        (String::from_utf8(said).unwrap(), rows.lines().filter(|row| row.starts_with("transient,")).count())
    };
    let mut resumed = sweep.again("--resume --plot");
    resumed.arg(sweep.path("a.svg"));
    let (said, dots) = drawn(resumed);
    assert!(
        said.contains("marks neither transients nor hysteresis") && said.contains("no settled and steady"),
        "{said}"
    );
    assert_eq!(dots, 0);
    let mut whole = headless(line);
    whole.args(["--out", "/dev/null", "--plot"]).arg(sweep.path("b.svg"));
    let (said, dots) = drawn(whole);
    assert!(!said.contains("transients") && dots > 0, "{said} {dots}");
}

#[test]
fn a_manifest_is_run_again_and_compared() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.csv");
    let line = "sweep nominal-cubic --set run.duration_s=4 --over stops.travel_limit_mm=2,3 \
        --over excitation.amplitude_g=0:1:0.25 --carry both --columns regime,travel_m --until-settled 40";
    headless(line).arg("--out").arg(&path).assert().success();
    let rows = fs::read_to_string(&path).unwrap();
    let manifest = folder.path().join("map.csv.json");
    let run =
        || headless("sweep").arg(&manifest).arg("--quiet").assert().success().get_output().stdout.clone();
    assert_eq!(String::from_utf8(run()).unwrap(), rows, "with its columns, its walks and until it settles");
    let check = || headless("sweep --check").arg(&manifest).assert();
    check().success().stdout("").stderr(contains("all 20 rows are the same"));
    fs::write(&path, rows.replacen("2,0.5,up,", "2,0.5,Up,", 1)).unwrap();
    check().code(1).stderr(contains("line 4").and(contains("`2,0.5,Up,")).and(contains("`2,0.5,up,")));
    fs::write(&path, &rows[..rows.len() - 20]).unwrap();
    check().code(1).stderr(contains("differs"));
    fs::write(&path, rows.clone() + "more\n").unwrap();
    check().code(1).stderr(contains("it has rows after line 21"));
    assert_eq!(names(folder.path()), ["map.csv", "map.csv.json"]);
    fs::remove_file(&path).unwrap();
    check().code(2).stderr(contains("map.csv"));
    refused(headless("sweep Cargo.toml --check"), &["--check Cargo.toml: give the manifest of a sweep"]);
}

#[test]
fn strict_says_by_the_status_that_cells_ended_early() {
    let line = "sweep paper --set run.duration_s=2 --set stops=None --quiet --over excitation.amplitude_g=";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.csv");
    headless(&format!("{line}1,100 --strict --out"))
        .arg(&path)
        .assert()
        .code(1)
        .stderr(contains("1 of 2 cells did not come to their end"));
    assert_eq!(fs::read_to_string(&path).unwrap(), stdout(&format!("{line}1,100")));
    headless(&format!("{line}1 --strict --out")).arg(&path).assert().success();
}

#[test]
fn a_folder_that_takes_no_files_is_refused() {
    let mut command = headless("sweep paper --over mass_g=15,16 --out /proc/map.csv");
    command.assert().code(1).stderr(contains("cannot write /proc/map.csv"));
}
