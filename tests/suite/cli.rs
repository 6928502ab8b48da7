//! The command line: every command, option, column and exit status that its page names.

mod accuracy;
mod at_once;
mod bad_input;
mod basins;
mod blocks;
mod compare;
mod curve;
mod flexure_numbers;
mod flexures;
mod names;
mod options;
mod outputs;
mod pages;
mod refused;
mod repeated;
mod section;
mod shards;
mod simulate;
mod sweep;
mod verdicts;

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;

/// The words of all commands, in the order of `--help`.
const COMMANDS: [&str; 18] = [
    "presets",
    "check",
    "curve",
    "simulate",
    "sweep",
    "merge",
    "section",
    "threshold",
    "compare",
    "best",
    "spectrum",
    "basins",
    "orbit",
    "exponents",
    "escape",
    "identify",
    "lesson",
    "accuracy",
];

/// The program with these arguments, given in one line.
pub fn plain(line: &str) -> Command {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("interwell");
    command.args(line.split_whitespace());
    command
}

/// The same without a window.
pub fn headless(line: &str) -> Command {
    let mut command = plain("--headless");
    command.args(line.split_whitespace());
    command
}

/// What a command that succeeds writes to standard output.
pub fn stdout(line: &str) -> String {
    let output = headless(line).assert().success().get_output().stdout.clone();
    String::from_utf8(output).unwrap()
}

/// Asserts exit status 2, nothing on standard output and a message of few lines holding all of `words`.
pub fn refused(mut command: Command, words: &[&str]) {
    let assert = command.assert().code(2).stdout("");
    let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(text.starts_with("error: ") && text.lines().count() <= 4, "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
}

pub fn column(csv: &str, name: &str) -> Vec<String> {
    let mut lines = csv.lines();
    let place = lines.next().unwrap().split(',').position(|cell| cell == name).unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().to_owned()).collect()
}

#[test]
fn without_headless_it_says_what_to_write() {
    for line in ["", "paper"] {
        // as on a machine without a display
        let mut command = plain(line);
        ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].iter().for_each(|name| {
            command.env_remove(name);
        });
        let status = if cfg!(feature = "app") { 1 } else { 2 };
        let assert = command.assert().code(status).stdout("");
        let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(text.contains("--headless") && text.lines().count() == 1, "{text}");
    }
    for command in COMMANDS {
        refused(plain(command), &["--headless", command]);
    }
    let (last, others) = COMMANDS.split_last().unwrap();
    refused(plain("--headless"), &[&format!("{} or {last}", others.join(", "))]);
}

#[test]
fn help_names_commands_and_options() {
    for word in COMMANDS.into_iter().chain(["Examples", "Exit status"]) {
        plain("--help").assert().success().stdout(contains(word));
    }
    for word in ["--out", "--set", "--tolerance", "--jobs", "--quiet", "--over", "--plot", "--dark"] {
        headless("sweep --help").assert().success().stdout(contains(word));
    }
}

#[test]
fn presets_are_listed_a_line_each() {
    let text = stdout("presets");
    for name in ["paper", "paper-ramp", "nominal-cubic", "bouncing-ball", "elastic-box", "duffing"] {
        let lines = text.lines().filter(|line| line.split_whitespace().next() == Some(name));
        assert_eq!(lines.count(), 1, "{name}");
    }
}

#[test]
fn presets_are_copied_out_and_work_there() {
    let folder = tempfile::tempdir().unwrap();
    let write = |more: &str| headless(&format!("presets --write {} {more}", folder.path().display()));
    write("").assert().success();
    assert!(folder.path().join("force_dl2.7.csv").is_file());
    // Again: the same files are no reason to refuse.
    write("").assert().success();
    let paper = folder.path().join("paper.ron");
    let line = format!("curve {} --at-mm 3", paper.display());
    assert_eq!(stdout(&line), stdout("curve --at-mm 3"));

    std::fs::write(&paper, "mine").unwrap();
    refused(write(""), &["paper.ron", "--force"]);
    assert_eq!(std::fs::read_to_string(&paper).unwrap(), "mine");
    write("--force").assert().success();
    assert_ne!(std::fs::read_to_string(&paper).unwrap(), "mine");
}

#[test]
fn check_says_what_is_modelled() {
    let text = stdout("check");
    for word in ["paper", "left out", "force curve", "k = ", "c = ", "equilibrium", "barrier"] {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
    // of two barriers as near to x = 0 the right one is listed
    let text = stdout("check --set mechanism=Polynomial(coefficients_si:[0,4,0,-5,0,1]) --set stops=None");
    for words in ["barrier at 1000 mm, ", "2250 mJ above that right of it", "3 wells: of the barriers"] {
        assert!(text.contains(words), "`{words}` is not in: {text}");
    }
    // the release that `threshold` says, and the command that finds where it crosses
    let released: f64 = column(&stdout("threshold paper --of release"), "value")[0].parse().unwrap();
    let text = stdout("check paper --set excitation.amplitude_g=0.5");
    assert!(text.contains(&format!("is released from {released:.4} g on\n")), "{text}");
    let search = "interwell --headless threshold paper --of crossing --set excitation.amplitude_g=0.5";
    assert!(text.contains(&format!("least amplitude that crosses: {search}\n")), "{text}");
    assert!(column(&stdout(search.strip_prefix("interwell --headless ").unwrap()), "of")[0] == "crossing");
    for (scene, released, searched) in
        [("paper-unconstrained", false, true), ("walking", false, false), ("monostable", false, false)]
    {
        let text = stdout(&format!("check {scene}"));
        assert_eq!(text.contains("is released from"), released, "{text}");
        assert_eq!(text.contains("least amplitude that crosses"), searched, "{text}");
    }
    // All are reported, and one that is wrong makes it fail.
    let check = headless("check elastic-box no-such-scene duffing also-none").assert().code(2);
    let check = check.stdout(contains("elastic-box").and(contains("duffing")));
    check.stderr(contains("no-such-scene").and(contains("also-none")));
}

#[test]
fn check_advises_compliant_stops_only_where_the_scene_takes_them() {
    let line = "check paper --set run.duration_s=2 --set run.settle_s=1";
    let coil = "coupling_v_s_per_m:5,coil_ohm:40,load_ohm:60";
    let said = |more: &str| {
        // `check` runs the scene for no more than a second, in which a busy machine may not get there
        let once = |_| {
            let text = stdout(&format!("{line} {more}"));
            text.lines().find(|line| line.contains("stops are struck at")).map(str::to_owned)
        };
        (0..1000).find_map(once).unwrap()
    };
    let advice = "compliant in their place (`Hertz`), a restitution of 0.36 there takes loss_s_per_m: ";
    assert!(said("").contains(advice), "{}", said(""));
    assert!(said(&format!("--set transducer=Electromagnetic({coil})")).contains(advice));
    let with_state = said(&format!("--set transducer=Electromagnetic({coil},inductance_mh:10)"));
    assert!(
        with_state.ends_with(
            "compliant ones (`Hertz`) are not followed beside a current or voltage with a state of its own"
        ),
        "{with_state}"
    );
    let uneven = said("--set stops=Uneven(left_mm:1.5,right_mm:1.4,restitution_left:0.36)");
    assert!(
        uneven.contains("compliant ones (`Hertz`), which stand equally far out on both sides, a"),
        "{uneven}"
    );
    let even = said("--set stops=Uneven(left_mm:1.5,right_mm:1.5,restitution_left:0.36)");
    assert!(even.contains(advice), "{even}");
}

#[test]
fn a_link_begins_with_the_address_of_a_page() {
    for (set, begin) in [
        (None, "?scene=paper#"),
        (Some("https://example.org/class/"), "https://example.org/class/?scene=paper#"),
        (Some("https://example.org/class/?scene=first-look#x"), "https://example.org/class/?scene=paper#"),
    ] {
        let mut command = headless("check paper --link --set mass_g=16");
        command.env_remove("INTERWELL_PAGE").envs(set.map(|address| ("INTERWELL_PAGE", address)));
        let output = command.output().unwrap();
        let link = String::from_utf8(output.stdout).unwrap();
        assert!(link.starts_with(begin), "{link}");
        let again = headless("check --link").arg(link.trim()).env_remove("INTERWELL_PAGE").output().unwrap();
        assert!(link.ends_with(&*String::from_utf8(again.stdout).unwrap()), "{link}");
    }
    for nonsense in ["nonsense", "http://a b", "javascript:alert(1)", "?scene=paper"] {
        let output = headless("check paper --link").env("INTERWELL_PAGE", nonsense).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && output.stdout.is_empty(), "{nonsense}");
        assert!(error.contains(&format!("INTERWELL_PAGE = {nonsense:?}")), "{error}");
    }
}

#[test]
fn a_link_keeps_its_scene_where_others_append_to_it() {
    let of = |spec: &str| headless("check --link").arg(spec).output().unwrap().stdout;
    let plain = of("?scene=paper");
    assert!(!plain.is_empty());
    assert_eq!(of("https://example.org/?scene=paper&from=mail"), plain);
    assert_eq!(of("?from=mail&scene=paper"), plain);
}
