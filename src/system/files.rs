//! Files to be read.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// The file, device or pipe at `path`, opened.
pub fn open(path: &Path) -> io::Result<impl Read + use<>> {
    File::open(path)
}

/// The file at `path`, opened at this byte.
pub fn open_at(path: &Path, offset: u64) -> io::Result<impl Read> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(offset))?;
    Ok(file)
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
