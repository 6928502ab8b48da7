//! Files to be read.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// The file, device or pipe at `path`, opened.
pub fn open(path: &Path) -> io::Result<impl Read> {
    File::open(path)
}

/// All bytes of a file.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    fs::read(path)
}

/// Whether anything is there.
pub fn exists(path: &Path) -> bool {
    path.exists()
}

/// Whether a regular file is there.
pub fn is_file(path: &Path) -> bool {
    path.is_file()
}

/// Whether a folder is there.
pub fn is_folder(path: &Path) -> bool {
    path.is_dir()
}

/// The folder that the program was started in; an empty path where there is none.
pub fn working_folder() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}

/// The absolute path of what is there, without links.
pub fn canonical(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}
