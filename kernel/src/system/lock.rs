//! Lock of a file that is being written, so that two processes never write one name at a time.
//!
//! `map.csv` is locked by the file `map.csv.part.journal`, which is also the journal of a file written
//! in blocks. The operating system releases the lock when its process ends, however it ends: what a killed
//! process leaves is an empty file that locks nothing. A lock that is released removes its file if that is
//! empty.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};

use super::sink::inode;

/// A lock that this process holds, and the open file that it is on.
#[derive(Debug)]
pub(super) struct Lock {
    file: File,
    path: PathBuf,
}

/// `path` with `ending` appended to its name.
pub(super) fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// The path of the file that is locked while `target` is written.
pub(super) fn lock_path(target: &Path) -> PathBuf {
    with_ending(target, ".part.journal")
}

impl Lock {
    /// Locks `target`, the end of a chain of links; `None` if it is locked already.
    pub fn of(target: &Path) -> io::Result<Option<Self>> {
        let path = lock_path(target);
        loop {
            let mut open = OpenOptions::new();
            // not for appending, which on Windows does not allow to shorten the file
            let file = open.read(true).write(true).create(true).truncate(false).open(&path)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                // a file system without locks
                Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
                Err(TryLockError::Error(error)) => return Err(error),
            }
            // The previous owner of the lock may have removed the file meanwhile.
            let current = fs::metadata(&path);
            if current.is_ok_and(|current| file.metadata().is_ok_and(|ours| inode(&ours) == inode(&current)))
            {
                return Ok(Some(Self { file, path }));
            }
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // While the lock is held: afterwards the file could be that of the next process.
        if self.file.metadata().is_ok_and(|file| file.len() == 0) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

impl Deref for Lock {
    type Target = File;

    fn deref(&self) -> &File {
        &self.file
    }
}

impl DerefMut for Lock {
    fn deref_mut(&mut self) -> &mut File {
        &mut self.file
    }
}
