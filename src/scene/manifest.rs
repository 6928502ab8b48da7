//! The manifest of a sweep as input: the scene that ran, with its grid as `sweep`, and the files that it read.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde::Deserialize;

use super::document::Document;
use super::error::SceneError;
use super::files::{Files, LARGEST_TABLE, ReadError, read_text};
use super::text::clip;

/// What the manifests of this program say in their key `program`.
pub const PROGRAM: &str = "interwell";

/// The largest manifest that is read: two of the largest tables, escaped, and a grid.
const LARGEST: usize = 4 * LARGEST_TABLE;

/// The keys that make a sweep run again; a manifest has more of them.
#[derive(Deserialize)]
struct Manifest {
    program: String,
    scene_ron: String,
    #[serde(default)]
    files: BTreeMap<String, String>,
}

fn parse(text: &str) -> Result<Manifest, String> {
    let manifest: Manifest = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if manifest.program == PROGRAM { Ok(manifest) } else { Err("another program wrote it".to_owned()) }
}

/// Whether the file at `path` begins as JSON does and no scene. A pipe is not looked into: it is read once.
pub(super) fn is_json(path: &Path) -> bool {
    const LOOKED_AT: u64 = 256;
    let mut begin = Vec::new();
    let read = path
        .is_file()
        .then(|| File::open(path).and_then(|file| file.take(LOOKED_AT).read_to_end(&mut begin)));
    matches!(read, Some(Ok(_))) && begin.trim_ascii_start().starts_with(b"{")
}

/// Whether the file at `path` is a manifest of this program.
pub fn is_manifest(path: &Path) -> bool {
    read_text(path, LARGEST).is_ok_and(|text| parse(&text).is_ok())
}

/// The scene of the manifest at `path`, which messages call `name`; the files that it names come from the manifest.
pub(super) fn load(path: &Path, name: &str) -> Result<Document, SceneError> {
    let unreadable = |problem| SceneError::Unreadable { name: clip(name), problem };
    let text = read_text(path, LARGEST).map_err(|error| match error {
        ReadError::Missing => unreadable("no such file".to_owned()),
        ReadError::Unusable(problem) => unreadable(problem),
    })?;
    let manifest = parse(&text).map_err(|problem| {
        unreadable(format!(
            "is JSON, but no manifest of a sweep: {}; give a scene (.ron) or a manifest",
            clip(&problem)
        ))
    })?;
    let files = Files { held: manifest.files, ..Files::beside(path) };
    Document::from_text(&format!("{} (scene_ron)", clip(name)), &manifest.scene_ron, files)
}
