//! Read access to files; in a web page, to those that it keeps.
//!
//! A function that reads returns the error of the system, without the path, which the caller adds. One that
//! asks returns false, or `None`, also where the system refuses the answer. What is no regular file is
//! refused before it is opened, since opening a pipe waits for the process at its other end.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

#[cfg(target_arch = "wasm32")]
use super::page;
use super::sink::is_descriptor;

/// Opens the regular file at `path`, or what a shell has opened already under the name of a descriptor.
pub fn open(path: &Path) -> io::Result<impl Read + use<>> {
    #[cfg(target_arch = "wasm32")]
    return page::bytes(path).map(io::Cursor::new);
    #[cfg(not(target_arch = "wasm32"))]
    open_on_disk(path)
}

fn open_on_disk(path: &Path) -> io::Result<File> {
    refused(path).map_or_else(|| File::open(path), |problem| Err(io::Error::other(problem)))
}

/// Why [`open`] refuses `path`, as [`special`] says it.
pub fn refused(path: &Path) -> Option<String> {
    special(path).filter(|_| !is_descriptor(path))
}

/// What is at `path` if it is no regular file, as a clause with its remedy; `None` also if nothing is there.
pub fn special(path: &Path) -> Option<String> {
    let kind = std::fs::metadata(path).ok()?.file_type();
    if kind.is_file() {
        return None;
    }
    let name = if kind.is_dir() { "directory" } else { special_name(kind) };
    Some(format!("is a {name}; a file is needed"))
}

#[cfg(unix)]
fn special_name(kind: std::fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "pipe"
    } else if kind.is_socket() {
        "socket"
    } else {
        "device"
    }
}

#[cfg(not(unix))]
fn special_name(_: std::fs::FileType) -> &'static str {
    "device"
}

/// Opens the file at `path` for reading from byte `offset`.
pub fn open_at(path: &Path, offset: u64) -> io::Result<impl Read> {
    let mut file = open_on_disk(path)?;
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
