//! Manifest of a sweep, read as a scene with its grid as `sweep` and the files that it used.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::document::Document;
use super::error::{SceneError, clip};
use super::files::{Files, MAX_TABLE_BYTES, read_text};

/// Value of the key `program` in manifests of this program.
pub const PROGRAM: &str = "interwell";

/// Largest size of a manifest in bytes: it contains tables and its grid.
pub(super) const MAX_BYTES: usize = 2 * MAX_TABLE_BYTES;

/// The keys of a manifest that are needed to repeat a sweep; a manifest has further keys.
#[derive(Deserialize)]
struct Manifest {
    program: String,
    scene_ron: String,
    #[serde(default)]
    files: BTreeMap<String, String>,
    #[serde(default)]
    plan: SweepRequest,
    #[serde(default)]
    shard: Option<String>,
    #[serde(default)]
    data: String,
    #[serde(default)]
    version: String,
}

/// Options of a sweep besides its scene; empty if not known.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct SweepRequest {
    /// The names of its columns after those of the swept fields.
    pub columns: Vec<String>,
    /// Time in s up to which runs were extended until they settled.
    pub until_settled: Option<f64>,
    /// Directions in which the last field was walked.
    pub carry: Option<String>,
    /// Its uncertain inputs.
    pub uncertain: Uncertain,
    /// The shard, if the sweep was divided into several.
    #[serde(skip)]
    pub shard: Option<String>,
    /// The name of the file with its rows.
    #[serde(skip)]
    pub data: String,
    /// The version of the program that computed the rows.
    #[serde(skip)]
    pub version: String,
}

/// Uncertain inputs of a sweep: normally distributed fields, and how many draws of them each cell has.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Uncertain {
    /// The fields with their standard deviations, `FIELD=VALUE+-SIGMA`: in the unit of the field, or as a
    /// percentage of its value (`5%`). Without VALUE it is that of the scene, of a swept field that of each
    /// cell.
    pub fields: Vec<String>,
    /// Number of draws; 100 if it is not given.
    pub draws: Option<u64>,
    /// Seed of the random numbers; 1 if it is not given.
    pub seed: Option<u64>,
}

fn parse(text: &str) -> Result<Manifest, String> {
    let manifest: Manifest = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if manifest.program == PROGRAM { Ok(manifest) } else { Err("another program wrote it".to_owned()) }
}

/// Whether the file at `path` is a manifest of this program.
pub fn is_manifest(path: &Path) -> bool {
    read_text(path, MAX_BYTES).is_ok_and(|text| parse(&text).is_ok())
}

/// The scene in the text of a manifest, which messages call `name`. Files come from the manifest, or from
/// `files` if they are not in it.
pub(super) fn read(name: &str, text: &str, files: Files) -> Result<Document, SceneError> {
    let manifest = parse(text).map_err(|problem| {
        let problem = clip(&problem);
        let problem =
            format!("is JSON, but no manifest of a sweep: {problem}; give a scene (.ron) or a manifest");
        SceneError::Unreadable { name: name.to_owned(), problem }
    })?;
    let files = Files { cached: manifest.files, ..files };
    let Manifest { shard, data, version, .. } = manifest;
    let swept = SweepRequest { shard: shard.filter(|shard| shard != "1/1"), data, version, ..manifest.plan };
    let mut document = Document::from_text(&format!("{name} (scene_ron)"), &manifest.scene_ron, files)?;
    document.swept = Some(swept);
    Ok(document)
}
