//! Outputs of a command, opened before any work is done, and finished together.

use std::path::{Path, PathBuf};

use interwell::output::{Sink, header, rows, same_target};
use interwell::scene::{is_manifest, is_scene_file};
use interwell::study::Table;
use interwell::system::files::{canonical, is_file};

use super::{Failure, interrupt, refuse};

/// Rows that are formatted at a time.
const ROWS: usize = 1 << 15;

/// Endings of tables that are not text.
const BINARY_TABLES: [&str; 9] = ["arrow", "feather", "h5", "hdf5", "mat", "nc", "npy", "parquet", "xlsx"];

/// What a command writes, by the option that says where it goes.
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
    pub const ATTRACTORS: Self = Self("--attractors");
    pub const LANDSCAPE: Self = Self("--landscape");
    pub const SHAPES: Self = Self("--shapes");
    pub const SHAPES_PLOT: Self = Self("--shapes-plot");
    pub const CONTACT: Self = Self("--contact");
    pub const CONTACT_PLOT: Self = Self("--contact-plot");
    pub const LESSON: Self = Self("--new");

    /// The option, as messages name it.
    pub fn option(self) -> &'static str {
        self.0
    }
}

/// The open outputs of a command. What is written to an output that was not requested is dropped.
pub struct Outputs {
    inputs: Vec<PathBuf>,
    sinks: Vec<(Output, Sink)>,
}

impl Outputs {
    /// No outputs yet, of a command that reads these files. Listens for Ctrl-C, which would otherwise leave
    /// unfinished files behind.
    pub fn new(inputs: &[PathBuf]) -> Self {
        interrupt::listen();
        let inputs = inputs.iter().filter_map(|input| canonical(input)).collect();
        Self { inputs, sinks: Vec::new() }
    }

    /// Opens an output where a `path` is given. It is an error if it is one of the inputs or any other scene,
    /// if a manifest would replace a file that is no manifest, or if an earlier output is the same.
    pub fn with(mut self, output: Output, path: Option<&Path>) -> Result<Self, Failure> {
        let (Some(path), option) = (path, output.option()) else { return Ok(self) };
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        if BINARY_TABLES.contains(&&*ending) {
            refuse!(
                "{option} {}: tables are written as CSV: name a .csv, or take the Python package, whose \
                 tables become data frames (to_pandas)",
                path.display()
            );
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
            return would_overwrite("a file that is no manifest of a sweep");
        }
        let sink = Sink::open(path)?;
        if let Some((first, _)) = self.sinks.iter().find(|(_, earlier)| same_target(earlier, &sink)) {
            let (first, name) = (first.option(), sink.name());
            refuse!("{first} and {option} both go to {name}: give each a place of its own");
        }
        self.sinks.push((output, sink));
        Ok(self)
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
        let Some(sink) = self.sink(output) else { return Ok(()) };
        sink.put_bytes(text.as_ref()).map_err(|error| Failure::writing(sink.name(), error))
    }

    /// Writes text and flushes it. Returns whether more is wanted: not if the reader of a pipe has gone.
    pub fn stream(&mut self, output: Output, text: &str) -> Result<bool, Failure> {
        self.write(output, text)?;
        let Some(sink) = self.sink(output) else { return Ok(false) };
        sink.flush().map_err(|error| Failure::writing(sink.name(), error))?;
        Ok(!sink.is_closed())
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
