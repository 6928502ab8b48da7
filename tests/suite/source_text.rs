//! Width of lines and length of files, comments and strings included.

use std::fs;
use std::path::Path;

use crate::layers::sources;

/// Folders whose files keep to both limits.
const FOLDERS: [&str; 9] = [
    "benches",
    "examples",
    "fuzz/fuzz_targets",
    "fuzz/src",
    "kernel/src",
    "src",
    "studies/src",
    "tests",
    "web/src",
];

const WIDEST_LINE: usize = 110;
const LONGEST_FILE: usize = 800;

#[test]
fn lines_and_files_are_short() {
    let mut wrong = Vec::new();
    for folder in FOLDERS {
        let mut files = Vec::new();
        sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut files);
        assert!(!files.is_empty(), "no file in {folder}");
        for file in files {
            let (text, name) = (fs::read_to_string(&file).unwrap(), file.display());
            let wide = |line: &str| line.chars().count() > WIDEST_LINE;
            let lines = text.lines().enumerate().filter(|(_, line)| wide(line));
            wrong.extend(lines.map(|(i, _)| format!("{name}:{}: wider than {WIDEST_LINE}", i + 1)));
            if text.lines().count() > LONGEST_FILE {
                wrong.push(format!("{name}: longer than {LONGEST_FILE} lines"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
