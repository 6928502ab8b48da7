//! Output of the rows of a sweep: to a stream, to a file in blocks, or compared with a file.

use std::io::{BufReader, Read};
use std::path::Path;

use interwell::output::{Sink, csv_table, manifest_path, plan_differences, shown_columns};
use interwell::questions::Table;
use interwell::system::checksum::file_checksum;
use interwell::system::clock::WallClock;
use interwell::system::{Opened, Part, PartError, files};
use interwell_studies::study::{SweepEnd, Tally};
use serde_json::{Value, json};

use super::super::{Failure, Output, Outputs, refuse};
use super::prepared::{Arguments, Prepared};

/// Rows after which a block ends; a walk that is longer stays in one block.
const MAX_BLOCK_ROWS: u64 = 4096;
const MAX_BLOCK_S: f64 = 5.0;

/// The destination of the rows.
pub enum Rows {
    /// To a pipe, a device or standard output.
    Stream,
    /// To a file that is written in blocks.
    Blocks(Box<Blocks>),
    /// To no output: they are compared with those of a file.
    Compared(Compared),
}

impl Rows {
    /// Writes or compares rows with their tally. Returns whether more rows are needed.
    pub fn put(&mut self, outputs: &mut Outputs, text: String, tally: &Tally) -> Result<bool, Failure> {
        match self {
            Self::Stream => outputs.stream(Output::DATA, &text),
            Self::Blocks(blocks) => blocks.put(text, tally).map(|()| true),
            Self::Compared(compared) => compared.put(&text).map(|()| true),
        }
    }

    /// The failure to report after the rows have ended early; blocks that are whole are kept.
    pub fn ended(self, end: SweepEnd<Failure>) -> Failure {
        match (end, self) {
            (SweepEnd::Cancelled, Self::Blocks(blocks)) => blocks.interrupted(),
            (SweepEnd::Write(failure), Self::Blocks(blocks)) => {
                blocks.part.discard();
                failure
            }
            (end, _) => end.into(),
        }
    }

    /// Waits until all blocks are on the disk. Returns the checksum of their file.
    pub fn close(&mut self) -> Result<String, Failure> {
        if let Self::Blocks(blocks) = self { blocks.close() } else { Ok(String::new()) }
    }

    /// Gives the file of the blocks its name.
    pub fn finish(self) -> Result<(), Failure> {
        let Self::Blocks(blocks) = self else { return Ok(()) };
        let part = blocks.part;
        let name = part.path().display().to_string();
        part.finish().map_err(|error| Failure::writing(name, error))
    }
}

/// An unfinished file, and its unfinished block.
pub struct Blocks {
    part: Part,
    rows: u64,
    unit: u64,
    block: Tally,
    clock: WallClock,
}

impl Prepared<'_> {
    /// Begins the file of the rows, on which `sink` is open and whose first line is `header`, or continues
    /// it. Returns it with the tally of its rows, or `None` if it is complete.
    pub fn open_blocks(&self, header: &str, sink: Sink) -> Result<Option<(Blocks, Tally)>, Failure> {
        let Self { out, slice, .. } = self;
        let &Arguments { resume, force, .. } = self.options;
        let opened = Opened::new(out, sink).map_err(refused)?;
        let part = opened.part().display().to_string();
        let head = json!({ "plan": self.plan, "shard": slice.shard().to_string() });
        let is_of_another = |file: String, existing: &Value, made: &str| {
            format!(
                "--resume: {file} is of another sweep: {}; give the arguments that it was {made} with, name \
                 another --out, or start anew with --force",
                plan_differences(&plan_with_shard(existing), &plan_with_shard(&head))
            )
        };
        if resume
            && !opened.has_rows()
            && let Some((existing, sha256)) = self.existing()
        {
            if existing == head && sha256 == file_checksum(out).ok() {
                opened.leave();
                return Ok(None);
            }
            if existing != head && !force {
                opened.leave();
                refuse!("{}", is_of_another(out.display().to_string(), &existing, "made"));
            }
        }
        if !opened.has_rows() || (force && !resume) {
            let part = opened.begin(&head.to_string(), header).map_err(refused)?;
            return Ok(Some((self.blocks(part), Tally::default())));
        }
        let existing: Option<Value> = opened.head().and_then(|text| serde_json::from_str(text).ok());
        let problem = match existing {
            None => {
                let journal = format!("{part} exists, and its journal is gone or cannot be read");
                format!("{journal}: --force starts anew, or name another --out")
            }
            Some(_) if !resume => {
                let (rows, all) = (opened.rows(), slice.rows());
                let left = format!("{part} has {rows} of {all} rows of a sweep that did not come to its end");
                format!("{left}: go on with --resume, or start anew with --force")
            }
            Some(existing) if existing != head => is_of_another(part, &existing, "begun"),
            Some(_) if self.lacking_columns().contains(&self.quantity) => format!(
                "--resume: the rows in {part} have no column {}, which --plot needs: leave --plot out, \
                 or start anew with --force and --columns all",
                self.quantity
            ),
            Some(_) => {
                let (part, blocks) = opened.resume(force).map_err(refused)?;
                let mut tally = Tally::default();
                let notes = blocks.iter().filter_map(|block| serde_json::from_str(&block.note).ok());
                notes.for_each(|note| tally.add(&note));
                return Ok(Some((self.blocks(part), tally)));
            }
        };
        opened.leave();
        Err(Failure::argument(problem))
    }

    fn blocks(&self, part: Part) -> Blocks {
        let (rows, unit) = (self.slice.rows(), self.slice.unit());
        Blocks { part, rows, unit, block: Tally::default(), clock: WallClock::start() }
    }

    /// The columns that a picture shows and the rows do not have.
    pub fn lacking_columns(&self) -> Vec<&str> {
        let shown = |_| shown_columns(self.quantity, &self.view, self.sweep.grid());
        let shown = self.picture.map_or_else(Vec::new, shown);
        shown.into_iter().filter(|name| !self.columns.iter().any(|column| column == name)).collect()
    }

    /// The plan and the shard of the sweep in the file, and the checksum that its manifest has.
    fn existing(&self) -> Option<(Value, Option<String>)> {
        let text = files::bytes(&manifest_path(&self.out)).ok().filter(|_| files::exists(&self.out))?;
        let manifest: Value =
            serde_json::from_slice(&text).ok().filter(|all: &Value| all["plan"].is_object())?;
        let sha256 = manifest["sha256"].as_str().map(str::to_owned);
        Some((json!({ "plan": manifest["plan"], "shard": manifest["shard"] }), sha256))
    }
}

/// The plan of a head, with the shard as a further key.
fn plan_with_shard(head: &Value) -> Value {
    let mut plan = head["plan"].clone();
    plan["shard"] = head["shard"].clone();
    plan
}

fn refused(error: PartError) -> Failure {
    let remedy = match &error {
        PartError::Refused { .. } => return Failure::Failed(error.into()),
        PartError::Damaged { rows: 0, .. } => "--force starts anew".to_owned(),
        PartError::Damaged { rows, .. } => format!(
            "--resume --force keeps the {rows} rows before and computes the others again; --force alone \
             starts anew"
        ),
    };
    Failure::failed(format!("{error}; nothing was changed: {remedy}"))
}

impl Blocks {
    fn put(&mut self, text: String, tally: &Tally) -> Result<(), Failure> {
        self.part.put(text).map_err(|error| self.failed(&error))?;
        self.block.add(tally);
        let whole = self.block.cells.is_multiple_of(self.unit);
        if whole && (self.block.cells >= MAX_BLOCK_ROWS || self.clock.seconds() >= MAX_BLOCK_S) {
            self.end_block().map_err(|error| self.failed(&error))?;
        }
        Ok(())
    }

    fn end_block(&mut self) -> std::io::Result<()> {
        let block = std::mem::take(&mut self.block);
        self.clock = WallClock::start();
        self.part.end_block(block.cells, serde_json::to_string(&block)?)
    }

    fn failed(&self, error: &std::io::Error) -> Failure {
        let (part, kept) = (self.part.path().display(), self.part.kept());
        let remedy = match kept {
            0 => "no rows are kept: once there is room, give the same command again".to_owned(),
            _ => format!(
                "{kept} of {} rows are kept there: once there is room, the same command with --resume \
                 continues",
                self.rows
            ),
        };
        Failure::failed(format!("cannot write {part}: {error}; {remedy}"))
    }

    /// Ends the file after an interruption. Returns the failure to report.
    pub fn interrupted(mut self) -> Failure {
        if self.block.cells.is_multiple_of(self.unit) && self.block.cells > 0 {
            let _ = self.end_block();
        }
        let closed = self.part.close();
        let kept = self.part.kept();
        let part = self.part.path().display().to_string();
        let failure = match closed {
            Err(error) => self.failed(&error),
            Ok(_) if kept == 0 => Failure::interrupted(),
            Ok(_) => Failure::failed(format!(
                "interrupted: {part} has {kept} of {} rows; the same command with --resume continues",
                self.rows
            )),
        };
        self.part.discard();
        failure
    }

    fn close(&mut self) -> Result<String, Failure> {
        let ended = if self.block.cells > 0 { self.end_block() } else { Ok(()) };
        ended.and_then(|()| self.part.close()).map_err(|error| self.failed(&error))
    }

    /// The rows that were written, with the columns of `empty`.
    pub fn table(&self, empty: &Table) -> Result<Table, Failure> {
        let path = self.part.path();
        let text =
            files::bytes(path).and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other));
        let failed = |error| Failure::failed(format!("cannot read {}: {error}", path.display()));
        csv_table(&text.map_err(failed)?, empty)
            .map_err(|problem| Failure::failed(format!("the rows that are there: {problem}")))
    }
}

pub struct Compared {
    name: String,
    file: Box<dyn Read>,
    line: u64,
}

impl Compared {
    pub fn new(path: &Path) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let file = files::open(path);
        let file =
            file.map_err(|error| Failure::argument(format!("--check: cannot read {name}: {error}")))?;
        Ok(Self { name, file: Box::new(BufReader::new(file)), line: 1 })
    }

    pub fn put(&mut self, text: &str) -> Result<(), Failure> {
        let mut expected = Vec::new();
        let read = (&mut self.file).take(text.len() as u64).read_to_end(&mut expected);
        read.map_err(|error| Failure::failed(format!("cannot read {}: {error}", self.name)))?;
        if expected == text.as_bytes() {
            self.line += text.matches('\n').count() as u64;
            return Ok(());
        }
        let expected = String::from_utf8_lossy(&expected).into_owned();
        let pairs = || text.lines().zip(expected.lines().chain(std::iter::repeat("")));
        let same = pairs().take_while(|(found, expected)| found == expected).count();
        let (found, expected) = pairs().nth(same).unwrap_or_default();
        let line = self.line + same as u64;
        if line == 1 {
            // a manifest from elsewhere may name a file that is no table: it is not quoted
            return Err(self.differs("its first line is not the header of these rows".to_owned()));
        }
        Err(self.differs(format!("line {line} is `{expected}` there and `{found}` now")))
    }

    fn differs(&self, how: String) -> Failure {
        Failure::failed(format!("{} differs: {how}", self.name))
    }

    pub fn end(&mut self) -> Result<(), Failure> {
        let mut more = [0];
        match self.file.read(&mut more) {
            Ok(0) => Ok(()),
            _ => {
                Err(self.differs(format!("it has rows after line {}, where the rows end now", self.line - 1)))
            }
        }
    }
}
