//! Scenes, links, lessons and manifests from elsewhere: what they name is no way to other files, to a wait
//! without end, or to the terminal.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use interwell::numeric::is_obeyed;
use interwell::scene::Document;
use proptest::prelude::*;

use crate::cli::headless;
use crate::properties::harness::hold_for;

/// No line of a file that is no table may hold this word, and no message says it.
const SECRET: &str = "hunter2";

/// Time in which a command that waits for nothing has ended.
const PATIENCE: Duration = Duration::from_secs(60);

/// What a command says, which must fail.
fn failing(folder: &Path, arguments: &[&str], status: i32) -> String {
    let mut command = headless(arguments[0]);
    command.args(&arguments[1..]).current_dir(folder).timeout(PATIENCE);
    let assert = command.assert().code(status);
    let output = assert.get_output();
    let said = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    said.concat()
}

fn harmless(said: &str) -> bool {
    !said.contains(|c: char| is_obeyed(c) && c != '\n' && c != '\t')
}

/// A text as RON writes it.
fn quoted(text: &str) -> String {
    ron::to_string(text).unwrap()
}

/// A link with this payload, which is deflated without compression.
fn link(name: &str, payload: &str) -> String {
    let length = u16::try_from(payload.len()).unwrap();
    let mut bytes = vec![1];
    bytes.extend(length.to_le_bytes());
    bytes.extend((!length).to_le_bytes());
    bytes.extend(payload.as_bytes());
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
    let packed = bytes.chunks(3).flat_map(|chunk| {
        let bits = (0..3).fold(0_u32, |bits, i| bits << 8 | u32::from(chunk.get(i).copied().unwrap_or(0)));
        let letter = move |i: usize| char::from(letters[(bits >> (18 - 6 * i)) as usize & 63]);
        (0..=chunk.len()).map(letter)
    });
    format!("?scene={name}#{}", packed.collect::<String>())
}

/// Parts of a scene that name a file.
fn naming(path: &str, is_table: bool) -> [String; 2] {
    let path = quoted(path);
    match is_table {
        true => ["mechanism".into(), format!("Table(path: {path})")],
        false => ["excitation".into(), format!("Recorded(path: {path})")],
    }
}

/// A scene with this part and title.
fn scene([field, value]: &[String; 2], title: &str) -> String {
    let other = if field == "mechanism" { "" } else { "mechanism: Linear(n_per_m: 4), " };
    format!(
        "(title: {}, mass_g: 15, {other}{field}: {value}, damping: Ratio(0.1), run: (duration_s: 1))",
        quoted(title)
    )
}

/// A lesson on a scene, whose texts are all the same.
fn lesson(scene: &str, text: &str) -> String {
    let (scene, text) = (quoted(scene), quoted(text));
    format!(
        "(format: 1, title: {text}, scene: {scene}, goal: {text}, minutes: 1, views: [], steps: [Say({text})],
            misconception: {text}, lecturer: {text})"
    )
}

/// A line of a file that is no table: as of accounts, keys, settings and prose.
fn line() -> impl Strategy<Value = String> {
    let around = "[ -~]{0,30}";
    (around, 0..6_usize, around).prop_map(|(before, kind, after)| match kind {
        0 => format!("root:{SECRET}:{before}:0:99999:7:::"),
        1 => format!("{before} = {SECRET}{after}"),
        2 => format!("{before},{SECRET},{after}"),
        3 => format!("\"{SECRET}\": {{{before}"),
        4 => format!("{SECRET}\t{before}\t{after}"),
        _ => format!("-----BEGIN {SECRET} {after}-----"),
    })
}

#[test]
fn no_message_has_a_line_of_a_file_that_is_no_table() {
    let drawn = (proptest::collection::vec(line(), 1..6), any::<bool>(), 0..5_usize);
    let check = |(lines, is_table, way): &(Vec<String>, bool, usize)| {
        let folder = tempfile::tempdir().unwrap();
        let secret = folder.path().join("secret");
        fs::write(&secret, lines.join("\n")).unwrap();
        let path = secret.to_str().unwrap();
        let part = naming(path, *is_table);
        let scene_file = folder.path().join("a.ron");
        fs::write(&scene_file, scene(&part, "from elsewhere")).unwrap();
        let set = serde_json::json!({ "set": [part.join("=")] }).to_string();
        let text = serde_json::json!({ "text": scene(&part, "from elsewhere") }).to_string();
        fs::write(folder.path().join("lesson.ron"), lesson(path, "t")).unwrap();
        let (preset, other) = (link("nominal-cubic", &set), link("", &text));
        let said = match way {
            0 => failing(folder.path(), &["check", "a.ron"], 2),
            1 => failing(folder.path(), &["check", &preset], 2),
            2 => failing(folder.path(), &["simulate", &other], 2),
            3 => failing(folder.path(), &["check", "--link", "a.ron"], 2),
            _ => failing(folder.path(), &["lesson", "lesson.ron"], 2),
        };
        prop_assert!(!said.contains(SECRET) && harmless(&said), "{said}");
        prop_assert!(said.contains("secret"), "{said}");
        Ok(true)
    };
    hold_for("no line of another file", 60, 1.0, drawn, |drawn| format!("{drawn:?}"), check);
}

/// A manifest names the file of its rows, which `--check` reads.
#[test]
fn a_manifest_names_no_file_in_another_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).unwrap();
    let sweep =
        "sweep nominal-cubic --over mass_g=15,16 --set run.duration_s=2 --set run.settle_s=1 --out a.csv";
    headless(sweep).current_dir(&inner).assert().success();
    fs::write(folder.path().join("secret"), format!("root:{SECRET}")).unwrap();
    fs::write(inner.join("beside"), format!("root:{SECRET}")).unwrap();
    let text = fs::read_to_string(inner.join("a.csv.json")).unwrap();
    let absolute = folder.path().join("secret").to_str().unwrap().to_owned();
    for (data, status) in [(&*absolute, 2), ("../secret", 2), ("beside", 1)] {
        let manifest = text.replace("\"data\": \"a.csv\"", &format!("\"data\": {data:?}"));
        assert_ne!(manifest, text);
        fs::write(inner.join("b.json"), manifest).unwrap();
        let said = failing(&inner, &["sweep", "--check", "b.json"], status);
        assert!(!said.contains(SECRET), "{said}");
    }
}

/// Files that are none, by their words in a message.
#[cfg(unix)]
fn special(folder: &Path) -> Vec<(&'static str, PathBuf)> {
    let pipe = folder.join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    // the socket stays after its listener has gone
    drop(std::os::unix::net::UnixListener::bind(folder.join("socket")).unwrap());
    let link = folder.join("link");
    std::os::unix::fs::symlink(&pipe, &link).unwrap();
    vec![
        ("is a pipe", pipe),
        ("is a pipe", link),
        ("is a socket", folder.join("socket")),
        ("is a directory", folder.to_owned()),
        ("is a device", "/dev/zero".into()),
        ("is a device", "/dev/tty".into()),
    ]
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_and_never_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let all = special(folder.path());
    let drawn = (0..all.len(), 0..8_usize);
    let check = |(kind, way): &(usize, usize)| {
        let (words, path) = &all[*kind];
        let path = path.to_str().unwrap();
        for (name, is_table) in [("table.ron", true), ("record.ron", false)] {
            fs::write(folder.path().join(name), scene(&naming(path, is_table), "t")).unwrap();
        }
        let said = match way {
            0 => failing(folder.path(), &["check", "table.ron"], 2),
            1 => failing(folder.path(), &["simulate", "record.ron"], 2),
            2 => failing(folder.path(), &["sweep", "table.ron", "--over", "mass_g=15,16"], 2),
            3 => failing(folder.path(), &["check", path], 2),
            4 => failing(folder.path(), &["lesson", path], 2),
            5 => failing(folder.path(), &["identify", path, "--of", "damping"], 2),
            6 => failing(folder.path(), &["simulate", "elastic-box", "--measured", path], 2),
            _ => failing(folder.path(), &["curve", "nominal-cubic", "--measured", path], 2),
        };
        prop_assert!(said.contains(words) && said.contains("; a file is needed"), "{said}");
        prop_assert_eq!(said.lines().count(), 1, "{}", said);
        Ok(true)
    };
    hold_for("no file", 60, 1.0, drawn, |drawn| format!("{drawn:?}"), check);
}

/// What a shell has opened is a pipe too, and may be read.
#[cfg(unix)]
#[test]
fn a_pipe_of_the_shell_is_read() {
    let part = ["mechanism".to_owned(), "Linear(n_per_m: 4)".to_owned()];
    let mut command = headless("check /dev/stdin");
    command.write_stdin(scene(&part, "Piped")).assert().success();
}

/// Characters that a terminal obeys.
fn obeyed() -> impl Strategy<Value = char> {
    let all = (0..=0x9f_u32).chain([0x61c, 0x200e, 0x200f, 0x2028, 0x2029]).chain(0x202a..=0x202e);
    let all: Vec<char> = all.chain(0x2066..=0x2069).filter_map(char::from_u32).collect();
    proptest::sample::select(all.into_iter().filter(|c| is_obeyed(*c)).collect::<Vec<_>>())
}

#[test]
fn no_text_of_a_file_moves_about_the_terminal() {
    let word = proptest::collection::vec(prop_oneof![obeyed(), proptest::char::range('a', 'z')], 1..12);
    let drawn = (word.prop_map(String::from_iter), 0..9_usize);
    let check = |(word, way): &(String, usize)| {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
        let part = ["mechanism".to_owned(), "Linear(n_per_m: 4)".to_owned()];
        put("title.ron", scene(&part, word));
        put("table.ron", scene(&naming(word, true), word));
        put("record.ron", scene(&naming(word, false), word));
        put("field.ron", scene(&part, "t").replace("mass_g", word));
        put("header.csv", format!("t_s,{word}\n0,1\n1,2\n"));
        put("header.ron", scene(&naming("header.csv", false), "t"));
        put("lesson.ron", lesson("paper", word));
        let linked = link("", &serde_json::json!({ "text": scene(&part, word) }).to_string());
        let arguments = match way {
            0 => vec!["check", "title.ron"],
            1 => vec!["check", "table.ron"],
            2 => vec!["simulate", "record.ron"],
            3 => vec!["check", "field.ron"],
            4 => vec!["check", "header.ron"],
            5 => vec!["lesson", "lesson.ron"],
            6 => vec!["check", &*linked],
            7 => vec!["compare", &*linked, "elastic-box"],
            _ => vec!["simulate", "title.ron", "--out", "/dev/null", "--summary", "-"],
        };
        let mut command = headless(arguments[0]);
        let output =
            command.args(&arguments[1..]).current_dir(folder.path()).timeout(PATIENCE).output().unwrap();
        let said = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        prop_assert!(harmless(&said.concat()), "{said:?}");
        if *way == 8 {
            let summary: serde_json::Value = serde_json::from_str(&said[0]).unwrap();
            prop_assert_eq!(&summary["scene"]["title"], word);
        }
        Ok(word.contains(is_obeyed))
    };
    hold_for("no control characters", 90, 0.5, drawn, |drawn| format!("{drawn:?}"), check);
}

/// A table that has its own folder goes with the link, since the link reads none.
#[test]
fn a_link_brings_a_table_of_any_folder() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("pull.csv");
    fs::write(&table, "x_m,force_n\n-2,-6\n-1,0\n0,0\n1,0\n2,6\n").unwrap();
    let text = scene(&naming(table.to_str().unwrap(), true), "t");
    let document = Document::from_text("a.ron", &text, Default::default()).unwrap();
    let link = document.link().unwrap();
    drop(folder);
    let opened = Document::load(&link).unwrap();
    interwell::mechanics::Mechanism::build(&opened.scene.mechanism, &opened.files).unwrap();
}
