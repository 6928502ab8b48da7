//! Files of scenes and of their tables, and messages about those that are missing.

use interwell::scene::*;

use super::*;

#[test]
fn a_scene_is_found_or_the_message_says_what_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let error = |spec: &str| Document::load(spec).unwrap_err().to_string();
    assert!(error(&at("none.ron")).contains(
        "none.ron: no such file, and no built-in scene of that name; built in: first-look, paper,"
    ));
    assert!(error(&at("")).contains("is a directory"));
    std::fs::write(at("noise.ron"), b"(title: \"\n\xff\xfe\0").unwrap();
    assert!(error(&at("noise.ron")).contains("is not text: byte 11 (line 2)"), "{}", error(&at("noise.ron")));
    std::fs::write(at("empty.ron"), "").unwrap();
    assert!(error(&at("empty.ron")).contains("empty.ron:1:1: the file is empty"));
    std::fs::write(at("large.ron"), "(".repeat(MAX_SCENE_BYTES + 1)).unwrap();
    assert!(error(&at("large.ron")).contains("larger than 4 MB"));
    std::fs::write(at("good.ron"), format!("\u{feff}{}", text(&[]).replace('\n', "\r\n"))).unwrap();
    let good = Document::load(&at("good.ron")).unwrap();
    assert_eq!(good.files.folder.as_deref(), Some(folder.path()));
    reads_back(&good.scene);
}

#[test]
fn tables_are_found_beside_the_scene_or_for_a_preset_among_the_embedded_ones() {
    let folder = tempfile::tempdir().unwrap();
    let beside = Files::beside(&folder.path().join("scene.ron"));
    let error = |files: &Files, path: &str| files.read(path).unwrap_err().to_string();
    std::fs::write(folder.path().join("own.csv"), "x_m,force_n\n").unwrap();
    assert_eq!(beside.read("own.csv").unwrap(), "x_m,force_n\n");
    assert!(error(&beside, "force_dl2.7.csv").contains("takes its tables from its own folder"));
    std::fs::write(folder.path().join("force_dl2.7.csv"), "mine").unwrap();
    assert_eq!(beside.read("force_dl2.7.csv").unwrap(), "mine");
    assert!(
        error(&beside, "gone.csv")
            .ends_with("gone.csv; give the path of one, absolute or from the folder of the scene")
    );
    assert!(error(&beside, ".").contains("is a directory"));
    std::fs::write(folder.path().join("bin.csv"), b"\xff").unwrap();
    assert!(error(&beside, "bin.csv").contains("bin.csv: is not text"));

    let embedded = Files::default();
    assert_eq!(embedded.read("force_dl2.7.csv").unwrap(), TABLES[0].text);
    assert!(error(&embedded, "own.csv").contains("give an absolute path"));
    let absolute = folder.path().join("own.csv").display().to_string();
    assert_eq!(embedded.read(&absolute).unwrap(), "x_m,force_n\n");
}

#[test]
fn presets_check_out_read_back_and_run_from_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    for (name, contents) in export() {
        std::fs::write(folder.path().join(name), contents).unwrap();
    }
    for preset in PRESETS {
        let document = Document::load(preset.name).unwrap();
        assert_eq!(document.check(), Ok(vec![]), "{}", preset.name);
        assert!(!document.scene.notes.is_empty() && !document.scene.notes.contains("  "));
        reads_back(&document.scene);
        document.axes::<&str>(&[]).unwrap();
        let path = folder.path().join(format!("{}.ron", preset.name)).display().to_string();
        let written = Document::load(&path).unwrap();
        assert_eq!(written.scene, document.scene);
        for files in [document.files, written.files] {
            if let Mechanism::Table { path, .. } = &document.scene.mechanism {
                files.read(path).unwrap();
            }
        }
    }
    let map = Document::load("nominal-cubic").unwrap().axes::<&str>(&[]).unwrap();
    assert_eq!((map[0].values.len(), map[1].values.len()), (41, 101));
    assert_eq!(*map[0].values.last().unwrap(), 8.0);
}
