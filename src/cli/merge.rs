//! `merge`: joins the shards of a sweep into one file, with the bytes that a single process would write.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use clap::Args;
use interwell::output::{manifest_path, merged_manifest, plan_differences};
use interwell::scene::PROGRAM;
use interwell::system::checksum::Checksum;
use interwell::system::files;
use interwell_studies::study::{Shard, Slice};
use serde_json::Value;

use super::shard::{PLACE, command, other_name, value};
use super::support::arguments;
use super::{Common, Failure, Output, Outputs, interrupt, refuse};

#[derive(Debug, Args)]
pub struct Arguments {
    /// The files that `sweep --shard` wrote, in any order; the manifest of each stands beside it
    #[arg(value_name = "PART")]
    pub parts: Vec<PathBuf>,
}

/// A shard: its file, its manifest, and how far it has been read.
struct Part {
    path: PathBuf,
    manifest: Value,
    shard: Shard,
    offset: u64,
    read: Checksum,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let mut parts = open_all(&options.parts)?;
    let read = parts.iter().flat_map(|part| [part.path.clone(), manifest_path(&part.path)]);
    let inputs: Vec<PathBuf> = read.collect();
    let mut outputs = Outputs::new(&inputs).with_rows(Some(common.out()))?;
    let watch = outputs.watch;
    let plan = &parts[0].manifest["plan"];
    let (rows, unit) = (plan["rows"].as_u64().unwrap_or(0), plan["unit"].as_u64().unwrap_or(0).max(1));
    let slice = Slice::new(rows, unit, parts[0].shard);

    let mut whole = Checksum::default();
    let mut put = |text: &[u8]| {
        whole.add(text);
        outputs.write(Output::DATA, text)
    };
    let headers: Vec<Vec<u8>> = parts.iter_mut().map(|part| part.lines(1)).collect::<Result<_, _>>()?;
    put(&headers[0])?;
    for (number, rows) in slice.dealt() {
        interrupt::check()?;
        put(&parts[number as usize - 1].lines(rows)?)?;
    }
    for part in &parts {
        part.check()?;
    }
    let sum = whole.text();
    let manifests: Vec<Value> = parts.into_iter().map(|part| part.manifest).collect();
    let text = merged_manifest(&manifests, common.out(), &sum, &arguments());
    outputs.write(Output::MANIFEST, &text)?;
    outputs.finish()?;
    common.say(&format!("{rows} rows of {} shards in {:.2} s", manifests.len(), watch.wall_s()));
    Ok(())
}

/// Opens all shards of one sweep and orders them. An error names the files that do not belong together, or
/// the missing shards with the commands that compute them.
fn open_all(paths: &[PathBuf]) -> Result<Vec<Part>, Failure> {
    let (mut parts, mut unfinished): (Vec<Part>, Vec<String>) = (Vec::new(), Vec::new());
    for path in paths {
        match Part::open(path)? {
            Some(part) => parts.push(part),
            None => unfinished.push(why_not(path)),
        }
    }
    let Some(first) = parts.first() else {
        if paths.is_empty() {
            let example = "such as merge map-*-of-5.csv --out map.csv";
            refuse!("merge: name the files of all shards, {example}");
        }
        refuse!(
            "{}; name the file of every shard; a finished shard has a manifest beside it",
            unfinished.join(", ")
        );
    };
    for part in &parts[1..] {
        let (path, other) = (part.path.display(), first.path.display());
        let differences = plan_differences(&part.manifest["plan"], &first.manifest["plan"]);
        let wrong = |how: String| Failure::argument(format!("{path} does not belong to {other}: {how}"));
        if !differences.is_empty() {
            // in the differences, "there" is `path` and "here" is `other`
            return Err(wrong(differences));
        }
        if part.shard.count() != first.shard.count() {
            return Err(wrong(format!("it is the shard {}, that one {}", part.shard, first.shard)));
        }
    }
    parts.sort_by_key(|part| part.shard.number());
    if let Some(same) = parts.windows(2).find(|pair| pair[0].shard == pair[1].shard) {
        let (a, b) = (same[0].path.display(), same[1].path.display());
        refuse!("{a} and {b} are both the shard {}; name each shard once", same[0].shard);
    }
    let count = parts[0].shard.count();
    let has = |number: u64| parts.iter().any(|part| part.shard.number() == number);
    let missing = (1..=count).filter(|number| !has(*number));
    let missing = missing.filter_map(|number| Shard::new(number, count).ok());
    let missing: Vec<String> = missing.map(|shard| parts[0].command_of(shard)).collect();
    if missing.is_empty() {
        return Ok(parts);
    }
    let others = if unfinished.is_empty() { String::new() } else { format!("{}; ", unfinished.join(", ")) };
    let (number, commands) = (missing.len(), missing.join("\n"));
    refuse!("{others}{number} of {count} shards are missing; these commands compute them:\n{commands}")
}

/// The reason why the file at `path` is not a shard.
fn why_not(path: &Path) -> String {
    let name = path.display();
    let begun = files::exists(Path::new(&format!("{name}.part")));
    match (files::exists(path), begun) {
        (true, _) => format!("{name}: no manifest stands beside it"),
        (false, true) => format!("{name}: not whole yet"),
        (false, false) => format!("{name}: no such file"),
    }
}

impl Part {
    /// Opens the shard whose rows or manifest are at `path`. Returns `None` if it has no manifest yet.
    fn open(path: &Path) -> Result<Option<Self>, Failure> {
        let ends = |ending: &str| path.to_string_lossy().strip_suffix(ending).map(PathBuf::from);
        let path = ends(".json").or_else(|| ends(".part")).unwrap_or_else(|| path.to_owned());
        let name = path.display();
        let beside = manifest_path(&path);
        if !files::exists(&path) || !files::exists(&beside) {
            return Ok(None);
        }
        let beside_name = beside.display();
        let text = files::bytes(&beside)
            .map_err(|error| Failure::argument(format!("cannot read {beside_name}: {error}")))?;
        let manifest: Value = serde_json::from_slice(&text).unwrap_or(Value::Null);
        let shard = manifest["shard"].as_str().and_then(|text| Shard::parse(text).ok());
        let Some(shard) = shard.filter(|_| manifest["program"] == PROGRAM && manifest["plan"].is_object())
        else {
            refuse!("{name}: {beside_name} is no manifest of a sweep or of a shard of one")
        };
        Ok(Some(Self { path, manifest, shard, offset: 0, read: Checksum::default() }))
    }

    fn lines(&mut self, count: u64) -> Result<Vec<u8>, Failure> {
        let failed = |error| Failure::failed(format!("cannot read {}: {error}", self.path.display()));
        let mut file = BufReader::new(files::open_at(&self.path, self.offset).map_err(failed)?);
        let mut bytes = Vec::new();
        for _ in 0..count {
            if file.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes).map_err(failed)? == 0 {
                return Err(self.changed("it ends too early"));
            }
        }
        self.offset += bytes.len() as u64;
        self.read.add(&bytes);
        Ok(bytes)
    }

    /// Checks that the file was read to its end and has the checksum of its manifest.
    fn check(&self) -> Result<(), Failure> {
        let mut more = [0];
        let read = files::open_at(&self.path, self.offset).and_then(|mut file| file.read(&mut more));
        match read {
            Ok(0) if self.manifest["sha256"].as_str() == Some(&self.read.text()) => Ok(()),
            Ok(0) => Err(self.changed("its checksum is not that in its manifest")),
            _ => Err(self.changed("it has more rows than its shard")),
        }
    }

    fn changed(&self, how: &str) -> Failure {
        Failure::argument(format!(
            "{} is changed since it was written: {how}; nothing was merged. This computes it again:\n{}",
            self.path.display(),
            self.command_of(self.shard)
        ))
    }

    /// The command that computes another shard of the same sweep.
    fn command_of(&self, shard: Shard) -> String {
        let arguments = self.manifest["arguments"].as_array().into_iter().flatten();
        let arguments: Vec<String> = arguments.filter_map(Value::as_str).map(str::to_owned).collect();
        let name = self.path.to_string_lossy();
        let out = match value(&arguments, "--out") {
            Some(out) if out.contains(PLACE) => out.to_owned(),
            _ => other_name(&name, self.shard, shard),
        };
        command(&arguments, &["--shard", &shard.to_string(), "--out", &out, "--resume"])
    }
}

const LONGEST_LINE: u64 = 1 << 20;
