//! Outputs of a command, opened before any work is done, and finished together; the manifest beside its rows.

use std::path::{Path, PathBuf};

use interwell::output::{Manifest, Sink, header, is_regular, manifest_path, repeated, rows};
use interwell::questions::Table;
use interwell::scene::{Document, is_manifest, is_scene_file};
use interwell::system::checksum::{Checksum, file_checksum};
use interwell::system::files::{canonical, is_file};

use super::support::Watch;
use super::{Failure, given, interrupt, refuse};

/// Rows that are formatted at a time.
const ROWS: usize = 1 << 15;

/// Endings of tables that are not text.
const BINARY_TABLES: [&str; 18] = [
    "arrow", "feather", "h5", "hdf5", "mat", "nc", "nc4", "netcdf", "npy", "npz", "ods", "parquet", "pickle",
    "pkl", "pq", "xls", "xlsx", "zarr",
];

/// An output of a command, called as the option that names its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Output(&'static str);

impl Output {
    /// The rows, or the text of a command without rows.
    pub const DATA: Self = Self("--out");
    pub const MANIFEST: Self = Self("the manifest of --out");
    pub const PLOT: Self = Self("--plot");
    pub const PLOT_DATA: Self = Self("--plot-data");
    pub const EVENTS: Self = Self("--events");
    pub const SUMMARY: Self = Self("--summary");
    pub const COMPARISON: Self = Self("--comparison");
    pub const LANDSCAPE: Self = Self("--landscape");
    pub const SHAPES: Self = Self("--shapes");
    pub const SHAPES_PLOT: Self = Self("--shapes-plot");
    pub const MECHANISM_PLOT: Self = Self("--mechanism-plot");
    pub const WELL_PLOT: Self = Self("--well-plot");
    pub const CONTACT: Self = Self("--contact");
    pub const CONTACT_PLOT: Self = Self("--contact-plot");
    pub const LESSON: Self = Self("--new");

    /// A further table of a study, called as its option.
    pub const fn further(option: &'static str) -> Self {
        Self(option)
    }

    /// The option, as messages name it.
    pub fn option(self) -> &'static str {
        self.0
    }
}

/// The open outputs of a command. What is written to an output that was not requested is dropped.
pub struct Outputs {
    /// Time since the work began.
    pub watch: Watch,
    inputs: Vec<PathBuf>,
    sinks: Vec<(Output, Sink)>,
    /// The path of the rows, if a manifest stands beside them.
    out: Option<PathBuf>,
    /// The checksum of the rows so far.
    sum: Checksum,
    /// Files that were read besides the scene, with their checksums.
    read: Vec<(String, String)>,
}

impl Outputs {
    /// No outputs yet, of a command that reads these files. Listens for Ctrl-C, which would otherwise leave
    /// unfinished files behind.
    pub fn new(inputs: &[PathBuf]) -> Self {
        interrupt::listen();
        let inputs = inputs.iter().filter_map(|input| canonical(input)).collect();
        let (watch, sum) = (Watch::start(), Checksum::default());
        Self { watch, inputs, sinks: Vec::new(), out: None, sum, read: Vec::new() }
    }

    /// Opens an output where a `path` is given.
    pub fn with(mut self, output: Output, path: Option<&Path>) -> Result<Self, Failure> {
        path.map_or(Ok(()), |path| self.open(output, path))?;
        Ok(self)
    }

    /// Opens the rows where they are wanted, and the manifest beside them if `out` is a regular file.
    pub fn with_rows(mut self, out: Option<&Path>) -> Result<Self, Failure> {
        self.out = out.filter(|out| is_regular(out)).map(Path::to_owned);
        let beside = self.out.as_deref().map(manifest_path);
        self.with(Output::DATA, out)?.with(Output::MANIFEST, beside.as_deref())
    }

    /// Notes for the manifest the checksums of `files` that are read besides the scene, where they are files.
    pub fn reading(mut self, files: &[PathBuf]) -> Result<Self, Failure> {
        for file in files.iter().filter(|file| self.out.is_some() && is_file(file)) {
            let name = file.display().to_string();
            let sum = file_checksum(file)
                .map_err(|error| Failure::argument(format!("cannot read {name}: {error}")))?;
            self.read.push((name, sum));
        }
        Ok(self)
    }

    /// Opens an output. It is an error if it is one of the inputs or any other scene, if a manifest would
    /// replace a file that is no manifest, or if an earlier output is the same.
    fn open(&mut self, output: Output, path: &Path) -> Result<(), Failure> {
        let option = output.option();
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        if BINARY_TABLES.contains(&&*ending) {
            refuse!(
                "{option} {}: tables are written as CSV: name a .csv, or take the Python package, whose \
                 tables become data frames (to_pandas)",
                path.display()
            );
        }
        if ending == "json" && ![Output::MANIFEST, Output::SUMMARY, Output::LANDSCAPE].contains(&output) {
            refuse!("{option} {}: this is written as CSV or text: name a .csv or .txt", path.display());
        }
        if ending == "gz" {
            let plain = path.with_extension("");
            let plain = plain.display();
            refuse!("{option} {plain}.gz: files are not compressed: name {plain}, and take gzip {plain}");
        }
        let would_overwrite = |what: &str| {
            let path = path.display();
            refuse!("{option} {path} would overwrite {what}: name another file")
        };
        if canonical(path).is_some_and(|path| is_file(&path) && self.inputs.contains(&path)) {
            return would_overwrite("the scene or a file that it reads");
        } else if is_scene_file(path) {
            return would_overwrite("a scene");
        } else if output == Output::MANIFEST && is_file(path) && !is_manifest(path) {
            return would_overwrite("a file that is no manifest");
        }
        if let Some((first, earlier)) = self.sinks.iter().find(|(_, earlier)| earlier.is_at(path)) {
            let (first, name) = (first.option(), earlier.name());
            refuse!("{first} and {option} both go to {name}: give each a place of its own");
        }
        self.sinks.push((output, Sink::open(path)?));
        Ok(())
    }

    /// Takes an open output out.
    pub fn take(&mut self, output: Output) -> Option<Sink> {
        let place = self.sinks.iter().position(|(open, _)| *open == output)?;
        Some(self.sinks.remove(place).1)
    }

    /// Closes an output without a change of its file.
    pub fn leave(&mut self, output: Output) {
        self.sinks.retain(|(open, _)| *open != output);
    }

    fn sink(&mut self, output: Output) -> Option<&mut Sink> {
        self.sinks.iter_mut().find(|(open, _)| *open == output).map(|(_, sink)| sink)
    }

    /// Whether an output is open.
    pub fn has(&mut self, output: Output) -> bool {
        self.sink(output).is_some()
    }

    /// Whether an output is standard output.
    pub fn is_stdout(&mut self, output: Output) -> bool {
        self.sink(output).is_some_and(|sink| sink.is_stdout())
    }

    /// Writes header and rows of a table.
    pub fn table(&mut self, output: Output, table: &Table) -> Result<(), Failure> {
        if !self.has(output) {
            return Ok(());
        }
        self.write(output, header(table))?;
        for begin in (0..table.rows()).step_by(ROWS) {
            interrupt::check()?;
            self.write(output, rows(table, begin..begin + ROWS))?;
        }
        Ok(())
    }

    pub fn write(&mut self, output: Output, text: impl AsRef<[u8]>) -> Result<(), Failure> {
        if output == Output::DATA && self.out.is_some() {
            self.sum.add(text.as_ref());
        }
        let Some(sink) = self.sink(output) else { return Ok(()) };
        sink.put_bytes(text.as_ref()).map_err(|error| Failure::writing(sink.name(), error))
    }

    /// Writes text and flushes it. Returns `false` without this output or once the reader of a pipe has gone.
    pub fn stream(&mut self, output: Output, text: &str) -> Result<bool, Failure> {
        self.write(output, text)?;
        let Some(sink) = self.sink(output) else { return Ok(false) };
        sink.flush().map_err(|error| Failure::writing(sink.name(), error))?;
        Ok(!sink.is_closed())
    }

    /// Writes the manifest of the rows, if they have one, as `text` makes it. `document` is the scene, if the
    /// command reads one, and `jobs` the number of threads. A manifest that was closed is opened again.
    pub fn manifest(
        &mut self,
        document: Option<&Document>,
        jobs: usize,
        text: impl FnOnce(&Manifest) -> Result<String, Failure>,
    ) -> Result<(), Failure> {
        let Some(data) = self.out.clone() else { return Ok(()) };
        let beside = manifest_path(&data);
        if !self.has(Output::MANIFEST) {
            self.open(Output::MANIFEST, &beside)?;
        }
        let (command, given) = given::arguments();
        let repeat = repeated(&command, document.map(|_| &*beside), given);
        let (origin, sha256) = (self.watch.origin(jobs), self.sum.text());
        let (origin, repeat, data, sha256) = (&origin, &repeat, &data, &sha256);
        let made = Manifest { document, command: &command, origin, repeat, data, sha256, inputs: &self.read };
        let text = text(&made)?;
        self.write(Output::MANIFEST, text)
    }

    /// Writes the manifest of rows that were computed on `jobs` threads from `document`, if the command reads
    /// a scene, and gives the outputs their names.
    pub fn finish_rows<'a>(
        mut self,
        document: impl Into<Option<&'a Document>>,
        jobs: usize,
    ) -> Result<(), Failure> {
        self.manifest(document.into(), jobs, |manifest| Ok(manifest.of_table()))?;
        self.finish()
    }

    /// Flushes all outputs, then gives the files their names. If one cannot be written to its end, no new
    /// file appears.
    pub fn finish(mut self) -> Result<(), Failure> {
        for (_, sink) in &mut self.sinks {
            sink.flush().map_err(|error| Failure::writing(sink.name(), error))?;
        }
        for (_, sink) in self.sinks {
            let name = sink.name().to_owned();
            sink.finish().map_err(|error| Failure::writing(name, error))?;
        }
        Ok(())
    }
}

/// Writes a text that is the whole of an output.
pub fn write_alone(output: Output, path: &Path, text: &str) -> Result<(), Failure> {
    let mut outputs = Outputs::new(&[]).with(output, Some(path))?;
    outputs.write(output, text)?;
    outputs.finish()
}
