//! Manifests of the rows that a command writes, and the provenance of a result.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::arguments::REPEATED_SCENE;
use super::json::{extend, pretty};
use crate::scene::{Document, Excitation, PROGRAM, Scene, numeric_fields};
use crate::study::{Answer, BasinMap, Grid, Shard, Tally};
use crate::system::checksum::checksum;

/// Provenance of a result, apart from its scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Provenance {
    /// Version of the program.
    pub version: String,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// Wall-clock time in s.
    pub wall_s: f64,
    /// CPU time of all threads in s.
    pub cpu_s: f64,
    /// Number of threads.
    pub jobs: usize,
}

/// The file of the rows of a sweep, or of those of a shard.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub struct Made<'a> {
    /// Its [plan](super::plan()).
    pub plan: &'a Value,
    /// The shard whose rows it has.
    pub shard: Shard,
    /// The checksum of the file.
    pub sha256: &'a str,
    /// Number of different mechanisms in the whole sweep.
    pub mechanisms: u64,
}

/// Data that all manifests contain.
///
/// The scene is its text `scene_ron`, with all arguments applied, beside `files`, the texts of the tables and
/// records that it reads, by their paths in it. With the arguments of `repeat` the manifest, read as a scene,
/// gives the same rows.
#[derive(Debug, Clone, Copy)]
pub struct Manifest<'a> {
    /// The document that was run, which holds its files; `None` of a command that reads no scene.
    pub document: Option<&'a Document>,
    /// The command.
    pub command: &'a str,
    /// The provenance of the rows.
    pub origin: &'a Provenance,
    /// The arguments that write the same rows to standard output, with the manifest as the scene.
    pub repeat: &'a [String],
    /// The file with the rows.
    pub data: &'a Path,
    /// The checksum of that file.
    pub sha256: &'a str,
    /// Paths and checksums of the files that were read besides the scene and its files.
    pub inputs: &'a [(String, String)],
}

impl Manifest<'_> {
    /// The manifest of rows that have no further entries, as text.
    pub fn of_table(&self) -> String {
        self.written(None, json!({}))
    }

    /// The manifest of a comparison of these scenes, by their names in the table, as text. Each has its
    /// files; the document is the first of them.
    pub fn of_scenes(&self, scenes: &[(String, Document)]) -> String {
        let scenes = scenes.iter().map(|(name, document)| {
            let scene = document.write(&document.scene).ok();
            json!({ "name": name, "scene_ron": scene, "files": document.files.cached })
        });
        self.written(None, json!({ "scenes": scenes.collect::<Vec<_>>() }))
    }

    /// The manifest of the grid that the command ran, as text. A sweep of the manifest, or of a scene file
    /// with the text `scene_ron` beside the `files`, gives the same rows. In `scene_ron` swept fields have
    /// their values from the scene, and `sweep` is the grid that was run.
    ///
    /// `made` describes the file with the rows, if it may be a shard.
    pub fn of_rows(&self, grid: &Grid, tally: &Tally, made: Option<Made>) -> String {
        let mut more = json!({
            "cells": tally.cells,
            "mechanisms": made.map_or(tally.mechanisms, |made| made.mechanisms),
            "outcomes": tally.outcomes,
            "regimes": tally.regimes,
        });
        if let Some(Made { plan, shard, sha256, .. }) = made {
            more["shard"] = json!(shard.to_string());
            more["sha256"] = json!(sha256);
            more["plan_sha256"] = json!(checksum(plan.to_string().as_bytes()));
            more["plan"] = plan.clone();
        }
        self.swept(grid, more)
    }

    /// The manifest of exponents over a grid as text. It is that of a sweep with the numbers of cells that
    /// rest on a stop and of cells without exponents, in place of outcomes and regimes.
    pub fn of_exponents(&self, grid: &Grid, tally: &Tally) -> String {
        let more = json!({
            "cells": tally.cells,
            "resting": tally.resting,
            "without_exponents": tally.without_exponents,
        });
        self.swept(grid, more)
    }

    /// The manifest of rows over a grid, with `more` entries of the command.
    fn swept(&self, grid: &Grid, more: Value) -> String {
        let axes = grid.axes().iter().zip(grid.columns());
        let axes = axes.map(|(axis, column)| {
            let mut values = json!(axis.values);
            name_infinity(&mut values);
            json!({ "field": axis.field, "column": column, "values": values })
        });
        let mut all = json!({ "grid": axes.collect::<Vec<_>>() });
        extend(&mut all, more);
        let scene = self.document.map(|document| {
            let sweep = grid.axes().iter().map(|axis| axis.to_scene(&document.scene)).collect();
            Scene { sweep, ..document.scene.clone() }
        });
        self.written(scene, all)
    }

    /// The manifest of a map of basins as text. It is that of a sweep with the starts in place of the grid.
    pub fn of_basins(&self, basins: &BasinMap, answer: &Answer) -> String {
        let scales = basins.model().scales();
        let more = json!({
            "starts": answer.rows.len(),
            "attractors": answer.attractors.len(),
            "outside": answer.outside,
            "not_sure": answer.unsure(),
            "ended_early": answer.lost,
            "out_of_work": answer.spent,
            "undecided": answer.undecided,
            "length_scale_m": scales.length,
            "speed_scale_m_per_s": scales.speed,
        });
        self.written(None, more)
    }

    /// A manifest with `more` entries of the command, of a scene that was made from that of the document, or
    /// of the latter.
    fn written(&self, made: Option<Scene>, more: Value) -> String {
        let Self { document, command, origin, repeat, data, sha256, inputs } = self;
        let mut scene = made.or(document.map(|document| document.scene.clone()));
        if let Some(scene) = &mut scene {
            // a change of the scene may have removed a field that its sweep is over
            let known = numeric_fields(scene);
            scene.sweep.retain(|axis| known.contains(&axis.field));
        }
        let scene = scene.as_ref();
        let inputs = inputs.iter().map(|(path, sum)| (path.clone(), json!(sum)));
        let mut all = json!({
            "program": PROGRAM,
            "version": origin.version,
            "command": command,
            "arguments": origin.arguments,
            "repeat": repeat,
            "data": file_name(data),
            "sha256": sha256,
            "inputs": inputs.collect::<Map<_, _>>(),
            "scene_name": document.map(|document| &document.name),
            "title": scene.map(|scene| &scene.title),
            "tolerance": scene.map(|scene| scene.run.tolerance),
            "seed": scene.map(seed),
        });
        extend(&mut all, more);
        let end = json!({
            "jobs": origin.jobs,
            "wall_s": origin.wall_s,
            "cpu_s": origin.cpu_s,
            "scene": scene.map(scene_value),
            "scene_ron": document.zip(scene).and_then(|(document, scene)| document.write(scene).ok()),
            "files": document.map_or_else(|| json!({}), |document| json!(document.files.cached)),
        });
        extend(&mut all, end);
        pretty(&all)
    }
}

/// The path of the manifest beside the rows at `out`.
pub fn manifest_path(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// The manifest of a whole sweep, from the manifests of its shards. `out` is the path of the merged file,
/// `sha256` its checksum, and `arguments` those of the call that merged it. Counts and CPU times are added;
/// of the wall-clock times the longest is kept.
#[doc(hidden)]
pub fn merged_manifest(shards: &[Value], out: &Path, sha256: &str, arguments: &[String]) -> String {
    let Some(mut merged) = shards.first().cloned() else { return String::new() };
    for other in &shards[1..] {
        for key in ["cells", "outcomes", "regimes", "cpu_s"] {
            add(&mut merged[key], &other[key]);
        }
        if other["wall_s"].as_f64() > merged["wall_s"].as_f64() {
            merged["wall_s"] = other["wall_s"].clone();
        }
    }
    if let Some(scene) = merged.get_mut("repeat").and_then(|words| words.get_mut(REPEATED_SCENE)) {
        *scene = json!(manifest_path(out).to_string_lossy());
    }
    merged["data"] = json!(file_name(out));
    merged["sha256"] = json!(sha256);
    merged["arguments"] = json!(arguments);
    merged["shard"] = json!(Shard::WHOLE.to_string());
    pretty(&merged)
}

/// Adds numbers, or the numbers of objects key by key.
fn add(sum: &mut Value, other: &Value) {
    match (sum, other) {
        (Value::Object(sum), Value::Object(other)) => {
            other.iter().for_each(|(key, n)| add(sum.entry(key).or_insert(json!(0)), n));
        }
        (sum, other) => {
            let whole = sum.as_u64().zip(other.as_u64()).map(|(a, b)| json!(a + b));
            let real = sum.as_f64().zip(other.as_f64()).map(|(a, b)| json!(a + b));
            *sum = whole.or(real).unwrap_or(Value::Null);
        }
    }
}

/// The origin of a picture of `document`, without the arguments: names and values as in a manifest, and the
/// text of the scene with all arguments applied. `version` is that of the program.
pub fn origin(document: &Document, version: &str) -> Map<String, Value> {
    let scene = &document.scene;
    let all = json!({
        "program": PROGRAM,
        "version": version,
        "scene_name": document.name,
        "changes": document.changes().collect::<Vec<_>>(),
        "title": scene.title,
        "tolerance": scene.run.tolerance,
        "seed": seed(scene),
        "scene_ron": document.write(scene).ok(),
    });
    if let Value::Object(all) = all { all } else { Map::new() }
}

/// A scene as JSON. JSON has no infinity: the load of an open circuit is the text `inf`, both in the
/// transducer and in the values of a sweep, where `null` can mean nothing else.
pub(super) fn scene_value(scene: &Scene) -> Value {
    let mut value = serde_json::to_value(scene).unwrap_or(Value::Null);
    for part in ["transducer", "sweep"] {
        value.get_mut(part).into_iter().for_each(name_infinity);
    }
    value
}

fn name_infinity(value: &mut Value) {
    match value {
        Value::Null => *value = json!("inf"),
        Value::Array(inner) => inner.iter_mut().for_each(name_infinity),
        Value::Object(inner) => inner.values_mut().for_each(name_infinity),
        _ => {}
    }
}

/// The seed of the scene's random numbers: null if it has none, a list if it has several.
pub fn seed(scene: &Scene) -> Value {
    match seeds(&scene.excitation)[..] {
        [] => Value::Null,
        [seed] => json!(seed),
        ref seeds => json!(seeds),
    }
}

fn seeds(excitation: &Excitation) -> Vec<u64> {
    match excitation {
        Excitation::Noise { seed, .. } => vec![*seed],
        Excitation::Sum(terms) => terms.iter().flat_map(seeds).collect(),
        _ => Vec::new(),
    }
}
