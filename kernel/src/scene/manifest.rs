//! Manifest of rows, read as the scene that they were computed from, with the files that it used.
//!
//! That of a sweep has its grid as `sweep`, that of a comparison all its scenes.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::document::Document;
use super::error::{SceneError, clip};
use super::files::{Files, MAX_TABLE_BYTES, read_text};

/// Value of the key `program` in manifests of this program.
#[doc(hidden)]
pub const PROGRAM: &str = "interwell";

/// Largest size of a manifest in bytes: it contains tables and its grid.
pub(super) const MAX_BYTES: usize = 2 * MAX_TABLE_BYTES;

/// The keys of a manifest that are needed to compute its rows again; a manifest has further keys.
#[derive(Deserialize)]
struct Manifest {
    program: String,
    #[serde(default)]
    command: String,
    scene_ron: Option<String>,
    #[serde(default)]
    files: BTreeMap<String, String>,
    #[serde(default)]
    scenes: Vec<Compared>,
    #[serde(default)]
    plan: SweepRequest,
    #[serde(default)]
    shard: Option<String>,
    #[serde(default)]
    data: String,
    #[serde(default)]
    version: String,
}

/// A scene of a comparison.
#[derive(Deserialize)]
struct Compared {
    name: String,
    scene_ron: String,
    files: BTreeMap<String, String>,
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
///
/// It is a part of a sweep, whose columns then have bands.
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
#[doc(hidden)]
pub fn is_manifest(path: &Path) -> bool {
    read_text(path, MAX_BYTES).is_ok_and(|text| parse(&text).is_ok())
}

/// The scene in the text of a manifest, which messages call `name`. Files come from the manifest, or from
/// `files` if they are not in it.
pub(super) fn read(name: &str, text: &str, files: Files) -> Result<Document, SceneError> {
    let manifest = parse(text).map_err(|problem| {
        let problem = clip(&problem);
        let problem =
            format!("is JSON, but no manifest of rows: {problem}; give a scene (.ron) or a manifest");
        SceneError::Unreadable { name: name.to_owned(), problem }
    })?;
    let Some(scene) = manifest.scene_ron else {
        let command = clip(&manifest.command);
        let problem = format!(
            "is a manifest of `{command}` without a scene: its `repeat` is the call that makes the rows again"
        );
        return Err(SceneError::Unreadable { name: name.to_owned(), problem });
    };
    let with = |cached| Files { cached, ..files.clone() };
    let mut document = Document::from_text(&format!("{name} (scene_ron)"), &scene, with(manifest.files))?;
    for Compared { name: scene, scene_ron, files } in manifest.scenes {
        let shown = format!("{name} (scenes: {})", clip(&scene));
        document.compared.push((scene, Document::from_text(&shown, &scene_ron, with(files))?));
    }
    if manifest.command == "sweep" {
        let Manifest { shard, data, version, plan, .. } = manifest;
        let shard = shard.filter(|shard| shard != "1/1");
        document.swept = Some(SweepRequest { shard, data, version, ..plan });
    }
    Ok(document)
}
