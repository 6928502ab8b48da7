//! The file system as the window uses it, apart from scenes and results, which their own layers read and
//! write.

use std::path::{Path, PathBuf};

/// Whether there is something at a path.
pub fn exists(path: &Path) -> bool {
    path.exists()
}

/// Whether there is a file at a path.
pub fn is_file(path: &Path) -> bool {
    path.is_file()
}

/// Whether there is a folder at a path.
pub fn is_folder(path: &Path) -> bool {
    path.is_dir()
}

/// Whether a file holds just these bytes.
pub fn holds(path: &Path, bytes: &[u8]) -> bool {
    std::fs::read(path).is_ok_and(|own| own == bytes)
}

/// The one whole path of something that exists, without links.
pub fn whole(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}

/// The folder that the program was started in; nothing where there is none.
pub fn working_folder() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}
