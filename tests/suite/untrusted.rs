//! The small corpus of the fuzz targets, as plain tests: seeds, and every input that ever broke a promise.

use std::fs;
use std::path::Path;

mod promises;

/// Runs each file of one target's corpus; a panic names the file.
fn corpus(target: &str, promise: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(target);
    let mut files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 5, "only {} files in {}", files.len(), folder.display());
    for file in files {
        let bytes = fs::read(&file).unwrap();
        let kept = std::panic::catch_unwind(|| promise(&bytes));
        assert!(kept.is_ok(), "{} breaks a promise", file.display());
    }
}

#[test]
fn scenes() {
    corpus("scene", promises::scene);
}

#[test]
fn tables() {
    corpus("table", promises::table);
}

#[test]
fn records() {
    corpus("recorded", promises::recorded);
}

#[test]
fn set_arguments() {
    corpus("set", promises::set);
}

#[test]
fn over_arguments() {
    corpus("over", promises::over);
}

/// Each built-in scene and its table keep the promises too.
#[test]
fn what_comes_with_the_program() {
    for preset in interwell::scene::PRESETS {
        promises::scene(preset.text.as_bytes());
    }
    for table in interwell::scene::TABLES {
        promises::table(table.text.as_bytes());
    }
}
