//! Access to the files that a scene names.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::error::clip;
use super::presets;
use crate::system::files;

/// Largest size of a table in bytes, 64 MB: about two million rows.
pub const MAX_TABLE_BYTES: usize = 64 << 20;

/// Source of the files that a scene names: the folder of the scene file or, for a preset or a pasted scene,
/// the embedded tables (and absolute paths).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Files {
    /// Folder of relative paths; `None` for a preset or a pasted scene.
    pub folder: Option<PathBuf>,
    /// Texts of files that are already in memory, by the path in the scene.
    pub cached: BTreeMap<String, String>,
    /// Whether no file of the machine is read, but those in memory and the embedded tables alone: a link may
    /// come from anywhere.
    pub sealed: bool,
}

/// Reason why a file that a scene names cannot be read. The messages give the path that was tried.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// The file does not exist.
    #[error(
        "no such file: {path}; {}",
        if *.embedded { "a scene file takes its tables from its own folder: `presets --write` puts this one \
                         there" } else { "give the path of one, absolute or from the folder of the scene" }
    )]
    Missing {
        /// The path that was tried.
        path: String,
        /// Whether there is an embedded table of this name.
        embedded: bool,
    },
    /// The file cannot be used, or a relative path is not the name of an embedded table and has no folder.
    #[error("{0}")]
    Unusable(String),
}

impl Files {
    /// The files of a scene file; relative paths start at its folder.
    pub fn beside(scene_file: &Path) -> Self {
        let folder = scene_file.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        Self { folder: Some(folder), ..Self::default() }
    }

    /// The location of a file that a scene names; `None` for an embedded one.
    pub fn place(&self, path: &str) -> Option<PathBuf> {
        match &self.folder {
            _ if Path::new(path).is_absolute() && !self.sealed => Some(PathBuf::from(path)),
            Some(folder) => Some(folder.join(path)),
            None => files::is_in_page(path).then(|| PathBuf::from(path)),
        }
    }

    /// The text of a file that a scene names, from the cache if it is there.
    ///
    /// An absolute path is read as it is. A relative path starts at the folder of the scene; without a folder
    /// it is the name of an embedded table.
    ///
    /// # Errors
    ///
    /// [`FileError::Missing`] for a file that does not exist; [`FileError::Unusable`] for one that is too
    /// large or no text, and for a name that no built-in table has where there is no folder.
    pub fn read(&self, path: &str) -> Result<String, FileError> {
        if let Some(text) = self.cached.get(path) {
            return Ok(text.clone());
        }
        let embedded = presets::TABLES.iter().find(|table| table.name == path);
        let Some(tried) = self.place(path) else {
            return embedded.map(|table| table.text.to_owned()).ok_or_else(|| {
                let names = presets::TABLES.iter().map(|table| table.name).collect::<Vec<_>>().join(", ");
                let remedy = match self.sealed {
                    true => {
                        "a link reads no file but those that it brings: save the scene as a file beside it"
                    }
                    false => "a built-in or pasted scene has no folder: give an absolute path",
                };
                FileError::Unusable(format!(
                    "no embedded table is called {} (there are: {names}), and {remedy}",
                    clip(path)
                ))
            });
        };
        let shown = clip(&tried.display().to_string());
        // a scene from elsewhere may name any descriptor, where an argument names one of its own shell
        if let Some(problem) = files::special(&tried) {
            return Err(FileError::Unusable(format!("{shown}: {problem}")));
        }
        match read_text(&tried, MAX_TABLE_BYTES) {
            Ok(text) => Ok(text),
            Err(ReadError::Missing) => Err(FileError::Missing { path: shown, embedded: embedded.is_some() }),
            Err(ReadError::Unusable(problem)) => Err(FileError::Unusable(format!("{shown}: {problem}"))),
        }
    }
}

/// Reason why a file cannot be read as text.
pub(super) enum ReadError {
    Missing,
    Unusable(String),
}

/// Reads a file of at most `largest` bytes of UTF-8.
pub(super) fn read_text(path: &Path, largest: usize) -> Result<String, ReadError> {
    if let Some(problem) = files::refused(path) {
        return Err(ReadError::Unusable(problem));
    }
    match files::open(path) {
        Ok(file) => read_from(file, largest).map_err(ReadError::Unusable),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(ReadError::Missing),
        Err(error) => Err(ReadError::Unusable(format!("cannot be read: {error}"))),
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
