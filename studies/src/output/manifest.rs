//! Manifests of a sweep, of exponents over a grid and of a map of basins, and the provenance of a result.

use serde_json::{Map, Value, json};

use super::json::pretty;
use super::plan::plan_checksum;
use crate::scene::{Document, Excitation, PROGRAM, Scene};
use crate::study::{Answer, Basins, Grid, Shard, Tally};

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
#[derive(Debug, Clone, Copy)]
pub struct Manifest<'a> {
    /// The document that was run, which holds its files.
    pub document: &'a Document,
    /// The provenance of the rows.
    pub origin: &'a Provenance,
    /// The name of the file with the rows.
    pub data: &'a str,
}

impl Manifest<'_> {
    /// The manifest of the grid that `command` swept, as text. A sweep of the manifest, or of a scene file
    /// with the text `scene_ron` beside the `files`, gives the same rows. In `scene_ron` all arguments are
    /// applied, swept fields have their values from the scene, and `sweep` is the grid that was run. `files`
    /// are the texts of the tables and records that the scene reads, by their paths in it.
    ///
    /// `made` describes the file with the rows, if it may be a shard.
    pub fn of_rows(&self, command: &str, grid: &Grid, tally: &Tally, made: Option<Made>) -> String {
        let mut more = json!({
            "cells": tally.cells,
            "mechanisms": made.map_or(tally.mechanisms, |made| made.mechanisms),
            "outcomes": tally.outcomes,
            "regimes": tally.regimes,
        });
        if let Some(Made { plan, shard, sha256, .. }) = made {
            more["shard"] = json!(shard.to_string());
            more["sha256"] = json!(sha256);
            more["plan_sha256"] = json!(plan_checksum(plan));
            more["plan"] = plan.clone();
        }
        self.swept(command, grid, more)
    }

    /// The manifest of exponents over a grid as text. It is that of a sweep with the numbers of cells that
    /// rest on a stop and of cells without exponents, in place of outcomes and regimes.
    pub fn of_exponents(&self, grid: &Grid, tally: &Tally) -> String {
        let more = json!({
            "cells": tally.cells,
            "resting": tally.resting,
            "without_exponents": tally.without_exponents,
        });
        self.swept("exponents", grid, more)
    }

    /// The manifest of rows over a grid, with `more` entries of the command.
    fn swept(&self, command: &str, grid: &Grid, more: Value) -> String {
        let axes = grid.axes().iter().zip(grid.columns());
        let axes = axes.map(|(axis, column)| {
            json!({ "field": axis.field, "column": column, "values": numbers(&axis.values) })
        });
        let mut all = json!({ "grid": axes.collect::<Vec<_>>() });
        extend(&mut all, more);
        let sweep = grid.axes().iter().map(|axis| axis.to_scene(&self.document.scene)).collect();
        self.written(&Scene { sweep, ..self.document.scene.clone() }, command, all)
    }

    /// The manifest of a map of basins as text. It is that of a sweep with the starts in place of the grid.
    pub fn of_basins(&self, basins: &Basins, answer: &Answer) -> String {
        let (length, speed) = (basins.model().scales().length, basins.model().scales().speed);
        let more = json!({
            "starts": answer.rows.len(),
            "attractors": answer.attractors.len(),
            "outside": answer.outside,
            "not_sure": answer.unsure(),
            "ended_early": answer.lost,
            "out_of_work": answer.spent,
            "undecided": answer.undecided,
            "length_scale_m": length,
            "speed_scale_m_per_s": speed,
        });
        self.written(&self.document.scene, "basins", more)
    }

    /// A manifest with `more` entries of the command; `scene` is the scene that ran.
    fn written(&self, scene: &Scene, command: &str, more: Value) -> String {
        let Self { document, origin, data } = self;
        let mut all = json!({
            "program": PROGRAM,
            "version": origin.version,
            "command": command,
            "arguments": origin.arguments,
            "data": data,
            "scene_name": document.name,
            "title": scene.title,
            "tolerance": scene.run.tolerance,
            "seed": seed(scene),
        });
        extend(&mut all, more);
        let end = json!({
            "jobs": origin.jobs,
            "wall_s": origin.wall_s,
            "cpu_s": origin.cpu_s,
            "scene": scene_value(scene),
            // null if it cannot be written, rather than an empty scene
            "scene_ron": crate::scene::write(scene).ok(),
            "files": document.files.cached,
        });
        extend(&mut all, end);
        pretty(&all)
    }
}

/// Adds the entries of another object.
fn extend(all: &mut Value, more: Value) {
    if let (Value::Object(all), Value::Object(more)) = (all, more) {
        all.extend(more);
    }
}

/// The manifest of a whole sweep, from the manifests of its shards. `data` is the name of the merged file,
/// `sha256` its checksum, and `arguments` those of the call that merged it. Counts and CPU times are added;
/// of the wall-clock times the longest is kept.
pub fn merged_manifest(shards: &[Value], data: &str, sha256: &str, arguments: &[String]) -> String {
    let Some(mut merged) = shards.first().cloned() else { return String::new() };
    for other in &shards[1..] {
        for key in ["cells", "outcomes", "regimes", "cpu_s"] {
            add(&mut merged[key], &other[key]);
        }
        if other["wall_s"].as_f64() > merged["wall_s"].as_f64() {
            merged["wall_s"] = other["wall_s"].clone();
        }
    }
    merged["data"] = json!(data);
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
        "scene_ron": crate::scene::write(scene).ok(),
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

/// The numbers of an axis, infinity as `inf`.
fn numbers(values: &[f64]) -> Value {
    let mut value = json!(values);
    name_infinity(&mut value);
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
