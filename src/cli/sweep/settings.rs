//! Settings of a sweep, from its arguments or from the manifest that is given as its scene.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use interwell::mechanics::{BuildError, Mechanism};
use interwell::output::{Cut, View};
use interwell::scene::{Document, is_manifest};
use interwell::study::{
    Carry, DIRECTION, Grid, STANDARD_COLUMNS, SUMMARY_FIELDS, Shard, SummaryField, Sweep,
};

use super::super::failure::Failure;
use super::super::shard::shard;
use super::super::support::unbuilt;
use super::Arguments;

/// The settings of a sweep.
pub struct Settings {
    columns: Vec<String>,
    pub until_settled: Option<String>,
    pub carry: Option<Carry>,
    pub shard: Shard,
    /// The file with the rows of the manifest.
    pub data: PathBuf,
}

/// Checks that with `--check` the scene is a manifest.
pub fn has_manifest(options: &Arguments) -> Result<(), Failure> {
    if !options.check || is_manifest(options.scene.as_ref()) {
        return Ok(());
    }
    let scene = &options.scene;
    Err(Failure::argument(format!(
        "--check {scene}: give the manifest of a sweep, such as map.csv.json, as the scene"
    )))
}

impl Settings {
    /// The settings; an argument overrides the manifest.
    pub fn new(options: &Arguments, document: &Document) -> Result<Self, Failure> {
        let swept = document.swept.clone().unwrap_or_default();
        let words = options.columns.is_empty().then_some(swept.columns);
        let carry = options.carry.as_ref().or(swept.carry.as_ref());
        let variable = |name: &str| std::env::var(name).ok();
        let number = options.shard.as_ref().or(swept.shard.as_ref());
        Ok(Self {
            columns: words.unwrap_or_else(|| options.columns.clone()),
            until_settled: options
                .until_settled
                .clone()
                .or(swept.until_settled.map(|limit| limit.to_string())),
            carry: carry.and_then(|word| Carry::named(word)),
            shard: number.map_or(Ok(Shard::WHOLE), |text| shard(text, variable))?,
            data: Path::new(&options.scene).with_file_name(swept.data),
        })
    }

    /// The columns chosen by `--columns`, and all columns: those of the swept fields, the direction of a walk
    /// and the chosen ones.
    pub fn columns(&self, grid: &Grid) -> Result<(Vec<String>, Vec<String>), Failure> {
        let mut names = grid.columns().to_vec();
        names.extend(self.carry.map(|_| DIRECTION.to_owned()));
        let fixed = names.len();
        match &self.columns[..] {
            [] => names.extend(STANDARD_COLUMNS.map(str::to_owned)),
            [all] if all == "all" => {
                let more = SUMMARY_FIELDS.iter().map(|field| field.name);
                let more = more.filter(|name| !STANDARD_COLUMNS.contains(name));
                names.extend(STANDARD_COLUMNS.into_iter().chain(more).map(str::to_owned));
            }
            list => {
                for name in list.iter().map(|name| name.trim()) {
                    let Some(field) = SummaryField::find(name) else {
                        let known: Vec<&str> = SUMMARY_FIELDS.iter().map(|field| field.name).collect();
                        return Err(Failure::argument(format!(
                            "--columns {name}: no such column; there are all, {}",
                            known.join(", ")
                        )));
                    };
                    if names.iter().any(|known| known == field.name) {
                        return Err(Failure::argument(format!(
                            "--columns {name}: named twice; name it once"
                        )));
                    }
                    names.push(field.name.to_owned());
                }
            }
        }
        Ok((names[fixed..].to_vec(), names))
    }
}

/// Largest number of cuts beside a map.
const MAX_CUTS: usize = 2;

/// How the picture shows a sweep of this grid.
pub fn view(options: &Arguments, grid: &Grid) -> Result<View, Failure> {
    if options.surface {
        return Ok(View::Surface);
    }
    let mut cuts: Vec<Cut> = Vec::new();
    for text in &options.cut {
        let wrong = |problem: String| Failure::argument(format!("--cut {text}: {problem}"));
        let known = || grid.columns().join(", ");
        let form = || wrong(format!("write FIELD=VALUE with a field of the sweep: {}", known()));
        let (field, value) = text.split_once('=').ok_or_else(form)?;
        let field = field.trim();
        let place = grid
            .axes()
            .iter()
            .zip(grid.columns())
            .position(|(axis, column)| axis.field == field || column == field);
        let place = place.ok_or_else(|| wrong(format!("no field of the sweep; these are: {}", known())))?;
        let value: f64 = value.trim().parse().map_err(|_| form())?;
        let column = grid.columns()[place].clone();
        let values = &grid.axes()[place].values;
        if !values.contains(&value) {
            let mut near: Vec<f64> = values.clone();
            near.sort_by(|a, b| (a - value).abs().total_cmp(&(b - value).abs()));
            near.truncate(2);
            let near: Vec<String> = near.iter().map(f64::to_string).collect();
            return Err(wrong(format!(
                "the sweep has no such value; the nearest are {}",
                near.join(" and ")
            )));
        }
        if cuts.len() == MAX_CUTS {
            return Err(wrong(format!("at most {MAX_CUTS} cuts stand beside a map")));
        }
        cuts.push(Cut { column, value });
    }
    Ok(if cuts.is_empty() { View::Top } else { View::Cuts(cuts) })
}

/// The mechanism of the sweep's first cell. If its flexures have no solution, this is `None` if the mechanism
/// is swept, because it is then an outcome of the cell, and an error if all cells have this mechanism.
pub fn first_mechanism(document: &Document, sweep: &Sweep) -> Result<Option<Arc<Mechanism>>, Failure> {
    match sweep.first_mechanism() {
        Ok(mechanism) => Ok(Some(mechanism)),
        Err(BuildError::Unsolved(_)) if sweep.grid().changes_mechanism() => Ok(None),
        Err(error) => Err(unbuilt(document, error)),
    }
}
