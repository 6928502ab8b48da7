//! Order of the layers: each uses only those before it, and the physics builds without a window.

mod inside;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder may name those before it, nothing after it. `cli` and `app` stand side by side.
const ORDER: [&str; 9] =
    ["system", "numeric", "scene", "mechanics", "dynamics", "study", "output", "cli", "app"];

fn allowed(layer: &str, used: &str) -> bool {
    let place = |name: &str| ORDER.iter().position(|own| *own == name);
    match (place(layer), place(used)) {
        _ if layer == used => true,
        _ if ["cli", "app"].contains(&layer) && ["cli", "app"].contains(&used) => false,
        (Some(layer), Some(used)) => used < layer,
        _ => false,
    }
}

/// The layers that a source text names by `crate::` or, in the binary, by `interwell::`, with lines.
/// Comments do not count: documentation may point anywhere.
fn uses(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let code = line.split("//").next().unwrap_or_default();
        for root in ["crate::", "interwell::"] {
            for (at, _) in code.match_indices(root) {
                let before = code[..at].chars().next_back();
                if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '$') {
                    continue;
                }
                let rest = &code[at + root.len()..];
                let names = rest.strip_prefix('{').map_or_else(
                    || vec![rest],
                    |group| group.split('}').next().unwrap_or_default().split(',').collect(),
                );
                for name in names {
                    let word: String = name
                        .trim_start()
                        .chars()
                        .take_while(|c| c.is_ascii_alphanumeric() || *c == '_')
                        .collect();
                    found.push((i + 1, word));
                }
            }
        }
    }
    found
}

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

#[test]
fn each_layer_uses_only_what_stands_to_its_left() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut checked = 0;
    let mut wrong = Vec::new();
    for layer in ORDER {
        let mut files = Vec::new();
        let single = src.join(format!("{layer}.rs"));
        if single.is_file() {
            files.push(single);
        }
        if src.join(layer).is_dir() {
            sources(&src.join(layer), &mut files);
        }
        for file in files {
            checked += 1;
            let text = fs::read_to_string(&file).unwrap();
            for (line, used) in uses(&text) {
                if ORDER.contains(&used.as_str()) && !allowed(layer, &used) {
                    wrong.push(format!("{}:{line}: {layer} uses {used}", file.display()));
                }
            }
        }
    }
    assert!(checked > 20, "only {checked} files found in {}", src.display());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_folder_is_a_known_layer() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for entry in fs::read_dir(src).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        assert!(
            ORDER.contains(&name.as_str()) || ["lib", "main"].contains(&name.as_str()),
            "{} is in no layer: give it a place in the order",
            path.display()
        );
    }
}

#[test]
fn the_reader_of_uses_sees_them() {
    let text = "use crate::{scene::Scene, output};\n// crate::app\nlet x = crate::numeric::f(); $crate::cli";
    let found = uses(text);
    let names: Vec<&str> = found.iter().map(|(_, name)| name.as_str()).collect();
    assert_eq!(names, ["scene", "output", "numeric"]);
    assert!(allowed("study", "dynamics") && !allowed("dynamics", "study") && !allowed("cli", "app"));
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

/// The folders and files of `src/app`, the lowest first: each may name those before it.
const WINDOW_ORDER: [&str; 8] = ["task", "words", "session", "export", "ui", "panels", "views", "window"];

/// The folders of `src/app` that a file uses, by `crate::app::`, with lines. A `super` that leads out of the
/// folder is an empty name: another folder is named in full.
fn folders_used(path: &Path, text: &str) -> Vec<(usize, String)> {
    let depth = path.components().count() - usize::from(path.ends_with("mod.rs"));
    let leaving = "super::".repeat(depth);
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    let outward = code.lines().zip(1..).filter(|(line, _)| line.contains(&leaving));
    let mut found: Vec<_> = outward.map(|(_, number)| (number, String::new())).collect();
    for (line, number) in text.lines().zip(1..) {
        for (at, root) in line.split("//").next().unwrap_or_default().match_indices("crate::app::") {
            let name = line[at + root.len()..].split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            found.push((number, name.into_iter().next().unwrap_or_default().to_owned()));
        }
    }
    found
}

#[test]
fn folders_of_the_window_use_only_those_below_them() {
    let window = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/app");
    let place = |name: &str| WINDOW_ORDER.iter().position(|own| *own == name);
    let mut files = Vec::new();
    sources(&window, &mut files);
    let mut wrong = Vec::new();
    for file in files.iter().filter(|file| **file != window.join("mod.rs")) {
        let path = file.strip_prefix(&window).unwrap();
        let folder = path.components().next().unwrap().as_os_str().to_string_lossy().into_owned();
        let folder = folder.trim_end_matches(".rs");
        let own = place(folder).unwrap_or_else(|| panic!("{folder} has no place in the order"));
        for (line, used) in folders_used(path, &fs::read_to_string(file).unwrap()) {
            if place(&used).is_none_or(|used| used > own) {
                wrong.push(format!("{}:{line}: {folder} uses `{used}`", path.display()));
            }
        }
    }
    assert!(files.len() > 50, "only {} files found in {}", files.len(), window.display());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
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
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    let system = src.join("system");
    let mut wrong = Vec::new();
    for file in files.iter().filter(|file| !file.starts_with(&system)) {
        let text = fs::read_to_string(file).unwrap();
        // tests within a file stand at its end
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        for (i, line) in code.lines().enumerate() {
            wrong.extend(of_the_machine(line).map(|name| format!("{}:{}: {name}", file.display(), i + 1)));
        }
    }
    assert!(wrong.is_empty(), "reach these through src/system:\n{}", wrong.join("\n"));
    assert_eq!(of_the_machine("let t = std::time::Instant::now(); // std::fs"), Some("time::Instant"));
    assert_eq!(of_the_machine("at: Instant<T>, // std::fs"), None);
}
