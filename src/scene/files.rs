//! Files that a scene names.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::clip::clip;
use super::presets;
use crate::system::files;

/// The largest table that is read, 64 MB: some two million rows.
pub const LARGEST_TABLE: usize = 64 << 20;

/// Where the files that a scene names are read from: the folder of the scene file, or, for a preset
/// or a pasted scene, the embedded names (and absolute paths).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Files {
    /// Folder that relative paths start from; none for a preset or a pasted scene.
    pub folder: Option<PathBuf>,
    /// Texts that are at hand already, by the path that the scene names them by.
    pub held: BTreeMap<String, String>,
}

/// Why a file that a scene names cannot be read. The messages name the file as it was looked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// No file there.
    #[error(
        "no such file: {path}; {}",
        if *.embedded { "a scene file takes its tables from its own folder: `presets --write` puts this one \
                         there" } else { "give the path of one, absolute or from the folder of the scene" }
    )]
    Missing {
        /// The path that was tried.
        path: String,
        /// Whether an embedded table has the name that was asked for.
        embedded: bool,
    },
    /// A relative path, but no folder to start from.
    #[error(
        "no embedded table is called {path} (there are: {embedded}), and a built-in or pasted scene has no \
         folder: give an absolute path"
    )]
    NoFolder {
        /// The path as written.
        path: String,
        /// The names of the embedded tables.
        embedded: String,
    },
    /// The file is there and cannot be used.
    #[error("{path}: {problem}")]
    Unreadable {
        /// The path that was tried.
        path: String,
        /// Why, and what would be right.
        problem: String,
    },
}

impl Files {
    /// The files of a scene file: relative paths start at its folder.
    pub fn beside(scene_file: &Path) -> Self {
        let folder = scene_file.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        Self { folder: Some(folder), ..Self::default() }
    }

    /// Where a file that a scene names lies; none for an embedded one.
    pub fn place(&self, path: &str) -> Option<PathBuf> {
        match &self.folder {
            _ if Path::new(path).is_absolute() => Some(PathBuf::from(path)),
            Some(folder) => Some(folder.join(path)),
            None => None,
        }
    }

    /// The text of a file that a scene names, held or read.
    ///
    /// An absolute path is read as it is. A relative one starts at the folder of the scene; where there is no
    /// folder, it is the name of an embedded table.
    pub fn read(&self, path: &str) -> Result<String, FileError> {
        if let Some(text) = self.held.get(path) {
            return Ok(text.clone());
        }
        let embedded = || presets::TABLES.iter().find(|table| table.name == path);
        let names = || presets::TABLES.iter().map(|table| table.name).collect::<Vec<_>>().join(", ");
        let Some(tried) = self.place(path) else {
            let missing = || FileError::NoFolder { path: clip(path), embedded: names() };
            return embedded().map(|table| table.text.to_owned()).ok_or_else(missing);
        };
        let shown = clip(&tried.display().to_string());
        match read_text(&tried, LARGEST_TABLE) {
            Ok(text) => Ok(text),
            Err(ReadError::Missing) => {
                Err(FileError::Missing { path: shown, embedded: embedded().is_some() })
            }
            Err(ReadError::Unusable(problem)) => Err(FileError::Unreadable { path: shown, problem }),
        }
    }
}

/// Why a file is no text.
pub(super) enum ReadError {
    Missing,
    Unusable(String),
}

/// Reads at most `largest` bytes of UTF-8. Pipes and devices are read as files are, but never further
/// than that.
pub(super) fn read_text(path: &Path, largest: usize) -> Result<String, ReadError> {
    let unusable = |problem: String| Err(ReadError::Unusable(problem));
    if files::is_folder(path) {
        return unusable("is a directory; a file is needed".to_owned());
    }
    match files::open(path) {
        Ok(file) => read_from(file, largest).map_err(ReadError::Unusable),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(ReadError::Missing),
        Err(error) => unusable(format!("cannot be read: {error}")),
    }
}

/// Reads at most `largest` bytes of UTF-8; the error is a clause.
pub(super) fn read_from(from: impl Read, largest: usize) -> Result<String, String> {
    let mut bytes = Vec::new();
    from.take(largest as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| format!("cannot be read: {error}"))?;
    if bytes.len() > largest {
        return Err(format!("is larger than {} MB, the most that is read", largest >> 20));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..valid].iter().filter(|byte| **byte == b'\n').count();
        format!("is not text: byte {} (line {line}) is not valid UTF-8; save it as UTF-8", valid + 1)
    })
}
