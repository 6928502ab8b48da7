//! Manifest of a sweep as a scene: what ran, with its grid as `sweep`, and the files that it read.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use super::clip::clip;
use super::document::Document;
use super::error::SceneError;
use super::files::{Files, LARGEST_TABLE, read_text};

/// What the manifests of this program say in their key `program`.
pub const PROGRAM: &str = "interwell";

/// The largest manifest that is read: it holds tables, and its grid.
pub(super) const LARGEST: usize = 2 * LARGEST_TABLE;

/// The keys that make a sweep run again; a manifest has more of them.
#[derive(Deserialize)]
struct Manifest {
    program: String,
    scene_ron: String,
    #[serde(default)]
    files: BTreeMap<String, String>,
    #[serde(default)]
    plan: Swept,
    #[serde(default)]
    shard: Option<String>,
    #[serde(default)]
    data: String,
    #[serde(default)]
    version: String,
}

/// How a sweep was asked for, besides its scene; empty where nothing is known.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Swept {
    /// The names of its columns, after those of its fields.
    pub columns: Vec<String>,
    /// Time in s up to which runs went on to settle.
    pub until_settled: Option<f64>,
    /// In which directions the last field was walked.
    pub carry: Option<String>,
    /// Which shard it was, where it was one of several.
    #[serde(skip)]
    pub shard: Option<String>,
    /// The name of the file with its rows.
    #[serde(skip)]
    pub data: String,
    /// The version of the program that made them.
    #[serde(skip)]
    pub version: String,
}

fn parse(text: &str) -> Result<Manifest, String> {
    let manifest: Manifest = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if manifest.program == PROGRAM { Ok(manifest) } else { Err("another program wrote it".to_owned()) }
}

/// Whether the file at `path` is a manifest of this program.
pub fn is_manifest(path: &Path) -> bool {
    read_text(path, LARGEST).is_ok_and(|text| parse(&text).is_ok())
}

/// The scene of a manifest's text, which messages call `name`. The files that it names come from the
/// manifest, others from where `files` says.
pub(super) fn read(name: &str, text: &str, files: Files) -> Result<Document, SceneError> {
    let manifest = parse(text).map_err(|problem| {
        let problem = clip(&problem);
        let problem =
            format!("is JSON, but no manifest of a sweep: {problem}; give a scene (.ron) or a manifest");
        SceneError::Unreadable { name: name.to_owned(), problem }
    })?;
    let files = Files { held: manifest.files, ..files };
    let Manifest { shard, data, version, .. } = manifest;
    let swept = Swept { shard: shard.filter(|own| own != "1/1"), data, version, ..manifest.plan };
    let mut document = Document::from_text(&format!("{name} (scene_ron)"), &manifest.scene_ron, files)?;
    document.swept = Some(swept);
    Ok(document)
}
