//! Files of a web page: those that were dropped or chosen, held in memory, and downloads for those written.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Hands the user a file with this name and these bytes.
pub type Download = fn(&str, &[u8]) -> Result<(), String>;

static FILES: Mutex<BTreeMap<PathBuf, Vec<u8>>> = Mutex::new(BTreeMap::new());

static DOWNLOAD: OnceLock<Download> = OnceLock::new();

static ADDRESS: OnceLock<String> = OnceLock::new();

/// Sets the address of the page without a link; to be called once.
pub fn set_address(address: String) {
    let _ = ADDRESS.set(address);
}

/// The address of the page without a link.
pub fn address() -> &'static str {
    ADDRESS.get().map_or("", String::as_str)
}

/// Sets how a file that is written reaches the user; to be called once, before anything is written.
pub fn set_download(download: Download) {
    let _ = DOWNLOAD.set(download);
}

/// Keeps a file that the user has dropped or chosen. Returns the path by which it is read.
pub fn keep(name: &str, bytes: Vec<u8>) -> PathBuf {
    let path = PathBuf::from(name);
    FILES.lock().unwrap_or_else(PoisonError::into_inner).insert(path.clone(), bytes);
    path
}

/// The bytes of a file that is kept.
pub(super) fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let files = FILES.lock().unwrap_or_else(PoisonError::into_inner);
    files.get(path).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
}

/// Whether a file is kept.
pub(super) fn is_kept(path: &Path) -> bool {
    FILES.lock().unwrap_or_else(PoisonError::into_inner).contains_key(path)
}

/// Hands a file to the user.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let name = path.file_name().map_or_else(|| "file".into(), |name| name.to_string_lossy());
    DOWNLOAD.get().map_or(Ok(()), |download| download(&name, bytes))
}
