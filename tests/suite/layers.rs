//! Order of the layers, and of the folders inside two of them: each uses only those before it. The physics
//! builds without a window.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The order of the folders and files in a folder of `src`, the lowest first: each may name those before it.
struct Order {
    root: &'static [&'static str],
    names: &'static [&'static str],
    /// Whether it holds for unit tests too.
    with_tests: bool,
}

/// The sources of the three crates.
const CRATES: [&str; 3] = ["kernel/src", "studies/src", "src"];

/// The folders of the studies, which stand side by side: a room a study, and what all share.
const STUDIES: &str = "study questions output accuracy basins best compare curve distance escape exponents \
                       identify lesson orbit section simulate spectrum sweep threshold";

/// The orders that hold. The binary may name all. That of the crates is held by the compiler.
const ORDERS: [Order; 3] = [
    // `cli` and `app` stand side by side
    Order {
        root: &[],
        names: &["system", "numeric", "scene", "mechanics", "dynamics", STUDIES, "cli", "app"],
        with_tests: true,
    },
    Order {
        root: &["app"],
        names: &["task", "words", "session", "export", "ui", "panels", "views", "window", "desktop"],
        with_tests: true,
    },
    Order {
        root: &["dynamics"],
        names: &[
            "clock", "result", "model", "equation", "series", "drive", "state", "step", "record", "motion",
            "contact", "advance", "map", "run", "lanes", "live",
        ],
        with_tests: false,
    },
];

/// Adds the source files of a folder and of those in it.
pub fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
}

/// Reads a path at the start of the text, with a group at its end where there is one; what follows it.
fn read_path<'a>(text: &'a str, before: &[String], found: &mut Vec<Vec<String>>) -> &'a str {
    let mut path = before.to_vec();
    let mut rest = text;
    let is_letter = |c: char| c.is_alphabetic() || c == '_';
    loop {
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        path.push(rest[..end].to_string());
        rest = &rest[end..];
        match rest.strip_prefix("::") {
            Some(more) if more.starts_with(is_letter) => rest = more,
            Some(group) if group.starts_with('{') => {
                let mut inside = &group[1..];
                loop {
                    inside = inside.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
                    if !inside.starts_with(is_letter) {
                        return inside.strip_prefix('}').unwrap_or(inside);
                    }
                    inside = read_path(inside, &path, found);
                }
            }
            _ => break,
        }
    }
    found.push(path);
    rest
}

/// The paths from the root of the crate that the code of a module names by `crate`, `super` or, in the
/// binary, `interwell`. Comments do not count: documentation may point anywhere.
fn uses(module: &[String], text: &str) -> Vec<Vec<String>> {
    let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let code = code.join("\n");
    let (mut found, mut rest) = (Vec::new(), code.as_str());
    while let Some(start) = rest.find(|c: char| c.is_alphabetic() || c == '_') {
        rest = read_path(&rest[start..], &[], &mut found);
    }
    let from_root = |path: Vec<String>| {
        let steps_out = path.iter().take_while(|part| *part == "super").count();
        match path[0].as_str() {
            "crate" | "interwell" => Some(path[1..].to_vec()),
            "super" => Some([&module[..module.len().checked_sub(steps_out)?], &path[steps_out..]].concat()),
            _ => None,
        }
    };
    found.into_iter().filter_map(from_root).collect()
}

/// What a module uses against an order. Another folder is named in full, not by what its parent hands on.
fn wrong_uses(module: &[String], text: &str, order: &Order) -> Vec<String> {
    let Order { root, names, with_tests } = *order;
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    let text = if with_tests { text } else { code };
    let inside = |path: &[String]| path.get(root.len()).cloned().filter(|_| path.starts_with(&owned(root)));
    let place = |name: &str| names.iter().position(|other| other.split(' ').any(|one| one == name));
    let Some(folder) = inside(module) else { return Vec::new() };
    let Some(this_place) = place(&folder) else {
        return vec![format!("{folder} has no place in the order")];
    };
    let side_by_side = |used: &str| folder != used && ["cli", "app"].contains(&used) && folder == "app";
    let paths = uses(module, text).into_iter().filter(|path| path.len() > root.len());
    let used = paths.filter_map(|path| Some((inside(&path)?, path.join("::"))));
    let is_wrong = |used: &str| place(used).map_or(!root.is_empty(), |place| place > this_place);
    used.filter(|(used, _)| is_wrong(used) || side_by_side(used))
        .map(|(_, path)| format!("{} uses {path}", module.join("/")))
        .collect()
}

fn owned(parts: &[&str]) -> Vec<String> {
    parts.iter().map(ToString::to_string).collect()
}

#[test]
fn each_folder_uses_only_those_before_it() {
    let (mut count, mut wrong) = (0, Vec::new());
    for src in CRATES.map(|src| Path::new(env!("CARGO_MANIFEST_DIR")).join(src)) {
        let mut files = Vec::new();
        sources(&src, &mut files);
        files.retain(|file| !["lib.rs", "main.rs"].iter().any(|root| *file == src.join(root)));
        count += files.len();
        for file in files {
            let path = file.strip_prefix(&src).unwrap().with_extension("");
            let mut module: Vec<String> =
                path.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            module.pop_if(|last| last == "mod");
            let text = fs::read_to_string(&file).unwrap();
            wrong.extend(ORDERS.iter().flat_map(|order| wrong_uses(&module, &text, order)));
        }
    }
    assert!(count > 300, "only {count} files found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_reader_of_uses_sees_them() {
    let text =
        "use crate::{scene::Scene, output};\n// crate::app\nlet x = crate::numeric::f(); super::super::g";
    let names: Vec<String> =
        uses(&owned(&["study", "a", "b"]), text).into_iter().map(|path| path.join("::")).collect();
    assert_eq!(names, ["scene::Scene", "output", "numeric::f", "study::g"]);
    let wrong = |module: &[&str], text: &str| {
        let module = owned(module);
        ORDERS.iter().map(|order| wrong_uses(&module, text, order).len()).sum::<usize>()
    };
    assert_eq!(wrong(&["study", "a"], "crate::dynamics::Model"), 0);
    assert_eq!(wrong(&["dynamics", "step"], "crate::study::Table"), 1);
    assert_eq!(
        (wrong(&["cli", "a"], "crate::app::run"), wrong(&["app", "ui", "a"], "crate::cli::run")),
        (1, 1)
    );
    assert_eq!(wrong(&["app", "ui", "a"], "super::super::views::f"), 1);
    assert_eq!(wrong(&["dynamics", "step", "a"], "super::super::Model; crate::dynamics::run::f"), 2);
    assert_eq!(wrong(&["dynamics", "run"], "use super::{step::{A, b::C}, state}; self::f()"), 0);
    assert_eq!(wrong(&["other"], ""), 1);
}

#[test]
fn without_the_window_nothing_of_it_is_built() {
    let tree = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--offline",
            "--locked",
            "--no-default-features",
            "-e",
            "normal,build",
            "--prefix",
            "none",
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let tree = String::from_utf8_lossy(&tree.stdout).into_owned();
    assert!(tree.starts_with("interwell"), "{tree}");
    for line in tree.lines() {
        let name = line.split(' ').next().unwrap_or_default();
        let window =
            ["egui", "eframe", "winit", "wgpu", "glow"].iter().any(|crate_| name.starts_with(crate_));
        assert!(!window, "`{line}` is built without the window");
    }
}

/// What a line names of the machine: its threads, clocks or files.
fn of_the_machine(line: &str) -> Option<&'static str> {
    let names = ["std::fs", "fs::", "tempfile", ".is_file()", ".is_dir()", ".exists()", ".canonicalize()"]
        .into_iter()
        .chain(["std::thread", "rayon", "cpu_time::", "SystemTime", "time::Instant", "Duration, Instant"]);
    let code = line.split("//").next().unwrap_or_default();
    names.into_iter().find(|name| code.contains(name))
}

#[test]
fn threads_clocks_and_files_are_named_in_one_folder_alone() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    CRATES.iter().for_each(|src| sources(&root.join(src), &mut files));
    let system = root.join("kernel/src/system");
    let mut wrong = Vec::new();
    for file in files.iter().filter(|file| !file.starts_with(&system)) {
        let text = fs::read_to_string(file).unwrap();
        // tests within a file stand at its end
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        for (i, line) in code.lines().enumerate() {
            wrong.extend(of_the_machine(line).map(|name| format!("{}:{}: {name}", file.display(), i + 1)));
        }
    }
    assert!(wrong.is_empty(), "reach these through kernel/src/system:\n{}", wrong.join("\n"));
    assert_eq!(of_the_machine("let t = std::time::Instant::now(); // std::fs"), Some("time::Instant"));
    assert_eq!(of_the_machine("at: Instant<T>, // std::fs"), None);
}
