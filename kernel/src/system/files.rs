//! Read access to files; in a web page, to those that it keeps.
//!
//! A function that reads returns the error of the system, without the path, which the caller adds. One that
//! asks returns false, or `None`, also where the system refuses the answer.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

#[cfg(target_arch = "wasm32")]
use super::page;

/// Opens the file, device or pipe at `path`.
pub fn open(path: &Path) -> io::Result<impl Read + use<>> {
    #[cfg(target_arch = "wasm32")]
    return page::bytes(path).map(io::Cursor::new);
    #[cfg(not(target_arch = "wasm32"))]
    File::open(path)
}

/// Opens the file at `path` for reading from byte `offset`.
pub fn open_at(path: &Path, offset: u64) -> io::Result<impl Read> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(offset))?;
    Ok(file)
}

/// All bytes of a file.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Whether anything exists at `path`.
pub fn exists(path: &Path) -> bool {
    #[cfg(target_arch = "wasm32")]
    return page::is_kept(path);
    #[cfg(not(target_arch = "wasm32"))]
    path.exists()
}

/// Keeps a file that was written, so that a web page can read it again; elsewhere it is on the disk.
pub fn keep_written(path: &Path, bytes: &[u8]) {
    #[cfg(target_arch = "wasm32")]
    page::keep(&path.to_string_lossy(), bytes.to_vec());
    #[cfg(not(target_arch = "wasm32"))]
    let _ = (path, bytes);
}

/// Whether a web page keeps a file of this name, which is found without a folder; there is none elsewhere.
pub fn is_in_page(name: &str) -> bool {
    cfg!(target_arch = "wasm32") && exists(Path::new(name))
}

/// Whether there is a regular file at `path`.
pub fn is_file(path: &Path) -> bool {
    #[cfg(target_arch = "wasm32")]
    return page::is_kept(path);
    #[cfg(not(target_arch = "wasm32"))]
    path.is_file()
}

/// Whether there is a folder at `path`.
pub fn is_folder(path: &Path) -> bool {
    path.is_dir()
}

/// The working folder of the program; an empty path if there is none.
pub fn working_folder() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}

/// The absolute path without links; `None` if nothing exists at `path`.
pub fn canonical(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}
