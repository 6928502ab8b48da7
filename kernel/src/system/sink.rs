//! Outputs: atomically replaced files, devices, pipes and standard output.
//!
//! A regular file is written under a temporary name, so that neither an error nor Ctrl-C leaves an incomplete
//! file or damages an existing one. Anything else is written directly. Output to a pipe that its reader has
//! closed is dropped without an error, as after `| head -1`.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::lock::Lock;

/// Reason why an output cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The folder of the file does not exist.
    #[error("cannot write {}: there is no folder {}; make it first", path.display(), folder.display())]
    MissingFolder {
        /// The requested file.
        path: PathBuf,
        /// The folder that is missing.
        folder: PathBuf,
    },
    /// The path is a folder.
    #[error("cannot write {}: it is a folder; name a file in it", .0.display())]
    IsFolder(PathBuf),
    /// Another process is writing it.
    #[error("another process is writing {}: wait for it, or name another file", .0.display())]
    Busy(PathBuf),
    /// The operating system reports an error.
    #[error("cannot write {}: {problem}", path.display())]
    Refused {
        /// The requested file.
        path: PathBuf,
        /// The error. It is a part of the message and not a `source`, which would be printed again.
        problem: io::Error,
    },
}

/// An open output, to which text and bytes are appended. A regular file gets its name, or replaces the file
/// of that name, when it is [finished](Self::finish), so that no part of a file is ever left.
#[derive(Debug)]
pub struct Sink {
    name: String,
    kind: Kind,
    /// Device and inode of the existing file; `None` for a device, which several outputs may share.
    inode: Option<(u64, u64)>,
    buffer: Vec<u8>,
    closed: bool,
}

#[derive(Debug)]
enum Kind {
    Stdout,
    Direct(File),
    Replace {
        part: NamedTempFile,
        target: PathBuf,
        /// Held until the file has its name.
        lock: Lock,
    },
    /// A file that a web page hands to its user.
    #[cfg(target_arch = "wasm32")]
    Download(PathBuf),
}

/// Number of bytes collected before they are written.
const BUFFER: usize = 1 << 16;

impl Sink {
    /// Opens `path` for writing; `-` and the system's names of standard output are standard output. A regular
    /// file is not changed until [`finish`](Self::finish).
    ///
    /// # Errors
    ///
    /// [`OpenError`] for a folder that is missing, a path that is a folder, and what the system refuses.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        #[cfg(target_arch = "wasm32")]
        return Ok(Self::new(path.display().to_string(), Kind::Download(path.to_owned()), None));
        #[cfg(not(target_arch = "wasm32"))]
        Self::open_on_disk(path)
    }

    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "a page has no disk"))]
    fn open_on_disk(path: &Path) -> Result<Self, OpenError> {
        if is_stdout(path) {
            return Ok(Self::new("standard output".into(), Kind::Stdout, stdout_inode()));
        }
        let refused = |problem| OpenError::Refused { path: path.to_owned(), problem };
        let name = path.display().to_string();
        let target = follow_links(path);
        let existing = match fs::metadata(&target) {
            Ok(existing) => Some(existing),
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => None,
            Err(error) => return Err(refused(error)),
        };
        if existing.as_ref().is_some_and(fs::Metadata::is_dir)
            || path.as_os_str().to_string_lossy().ends_with('/')
        {
            return Err(OpenError::IsFolder(path.to_owned()));
        }
        let descriptor = is_descriptor(path);
        if let Some(existing) = existing.as_ref().filter(|existing| descriptor || !existing.is_file()) {
            // The shell has truncated the file after `3>file` and not after `3>>file`; append in both cases.
            let mut open = fs::OpenOptions::new();
            let file = open.write(true).append(descriptor).open(path).map_err(refused)?;
            // Several outputs may go to one device such as /dev/null, but not to one pipe or file.
            let inode = inode(existing).filter(|_| !is_device(existing));
            return Ok(Self::new(name, Kind::Direct(file), inode));
        }
        if path.as_os_str().is_empty() || target.file_name().is_none() {
            return Err(OpenError::IsFolder(path.to_owned()));
        }
        let Some((whole_folder, target)) = whole(&target) else {
            return Err(OpenError::MissingFolder { path: path.to_owned(), folder: folder(&target) });
        };
        if existing.is_some() {
            // A rename would replace even a write-protected file, so check that it can be written.
            fs::OpenOptions::new().write(true).open(&target).map_err(refused)?;
        }
        let locked = Lock::of(&target).map_err(refused)?;
        let Some(lock) = locked else { return Err(OpenError::Busy(path.to_owned())) };
        let part = create_part(&whole_folder, existing.as_ref()).map_err(refused)?;
        let inode = existing.as_ref().and_then(inode);
        Ok(Self::new(name, Kind::Replace { part, target, lock }, inode))
    }

    fn new(name: String, kind: Kind, inode: Option<(u64, u64)>) -> Self {
        Self { name, kind, inode, buffer: Vec::with_capacity(BUFFER), closed: false }
    }

    /// The path as requested, or "standard output".
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether it is standard output.
    pub fn is_stdout(&self) -> bool {
        matches!(self.kind, Kind::Stdout)
    }

    /// Closes it unchanged and keeps the lock of its file, if it is a regular one.
    pub(super) fn into_lock(self) -> Option<Lock> {
        match self.kind {
            Kind::Replace { lock, .. } => Some(lock),
            _ => None,
        }
    }

    /// Whether an output at `path` would overwrite this one: both are standard output, or two names of one
    /// file.
    #[doc(hidden)]
    pub fn is_at(&self, path: &Path) -> bool {
        let other = match is_stdout(path) {
            true if self.is_stdout() => return true,
            true => stdout_inode(),
            false => fs::metadata(path).ok().filter(|other| !is_device(other)).as_ref().and_then(inode),
        };
        let is_same_name = match &self.kind {
            Kind::Replace { target, .. } => {
                whole(&follow_links(path)).is_some_and(|(_, other)| other == *target)
            }
            _ => false,
        };
        is_same_name || (self.inode.is_some() && self.inode == other)
    }

    /// Whether the reader has closed this pipe, so that further output is dropped.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Appends `text`, which may stay in memory until [`flush`](Self::flush).
    pub fn put(&mut self, text: &str) -> io::Result<()> {
        self.put_bytes(text.as_bytes())
    }

    /// Appends `bytes`, which may stay in memory until [`flush`](Self::flush).
    pub fn put_bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= BUFFER { self.flush() } else { Ok(()) }
    }

    /// Writes all collected bytes.
    pub fn flush(&mut self) -> io::Result<()> {
        #[cfg(target_arch = "wasm32")]
        if matches!(self.kind, Kind::Download(_)) {
            return Ok(());
        }
        if self.closed {
            self.buffer.clear();
            return Ok(());
        }
        let bytes = &self.buffer;
        let result = match &mut self.kind {
            Kind::Stdout => {
                let mut stdout = io::stdout().lock();
                stdout.write_all(bytes).and_then(|()| stdout.flush())
            }
            Kind::Direct(file) => file.write_all(bytes),
            // Write to the inner file: errors of the temporary file contain its name.
            Kind::Replace { part, .. } => part.as_file_mut().write_all(bytes),
            #[cfg(target_arch = "wasm32")]
            Kind::Download(_) => Ok(()),
        };
        self.buffer.clear();
        match result {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => {
                self.closed = true;
                Ok(())
            }
            other => other,
        }
    }

    /// Writes all collected bytes and gives a regular file its name. If a sink is dropped without this, a
    /// regular file is not created or changed.
    ///
    /// # Errors
    ///
    /// Those of the system; a regular file is then as it was before.
    pub fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        match self.kind {
            Kind::Replace { part, target, .. } => {
                part.persist(target).map(|_| ()).map_err(|error| error.error)
            }
            #[cfg(target_arch = "wasm32")]
            Kind::Download(path) => super::page::write(&path, &self.buffer).map_err(io::Error::other),
            _ => Ok(()),
        }
    }
}

/// Writes a whole file; an existing one is replaced only after all bytes are written.
///
/// # Errors
///
/// A sentence with the path and what the system reports.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let mut sink = Sink::open(path).map_err(|error| error.to_string())?;
    let refused = |error: io::Error| format!("cannot write {}: {error}", path.display());
    sink.put_bytes(bytes).map_err(refused)?;
    sink.finish().map_err(refused)
}

/// Whether an output at `path` would be a regular file, and not standard output, a device or a pipe. This
/// does not open `path`, since opening and closing a pipe ends it for its reader.
#[doc(hidden)]
pub fn is_regular(path: &Path) -> bool {
    let existing = fs::metadata(follow_links(path));
    !is_stdout(path) && existing.map_or(true, |existing| existing.is_file() && !is_descriptor(path))
}

fn is_stdout(path: &Path) -> bool {
    ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].iter().any(|name| path == Path::new(name))
}

/// Whether a path is a name of a file descriptor that a shell has opened.
pub(super) fn is_descriptor(path: &Path) -> bool {
    let names = ["/dev/stdin", "/dev/stderr"].map(Path::new);
    path.starts_with("/dev/fd") || path.starts_with("/proc/self/fd") || names.contains(&path)
}

/// The folder of a file as its path has it.
fn folder(file: &Path) -> PathBuf {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.unwrap_or(Path::new(".")).to_owned()
}

/// The absolute paths of the folder of a file and of the file in it; `None` without a folder or a name.
fn whole(file: &Path) -> Option<(PathBuf, PathBuf)> {
    let folder = folder(file).canonicalize().ok().filter(|folder| folder.is_dir())?;
    let file = folder.join(file.file_name()?);
    Some((folder, file))
}

/// The end of a chain of symbolic links, whether it exists or not.
pub(super) fn follow_links(path: &Path) -> PathBuf {
    let mut place = path.to_owned();
    // Linux also stops after 40 links; a cycle then fails when the file is opened.
    for _ in 0..40 {
        match fs::read_link(&place) {
            Ok(to) => place = place.parent().map_or_else(|| to.clone(), |folder| folder.join(&to)),
            Err(_) => break,
        }
    }
    place
}

/// Creates a temporary file in `folder` with the mode of a new file, or of the file that it will replace.
fn create_part(folder: &Path, replaces: Option<&fs::Metadata>) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".interwell-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let part = builder.tempfile_in(folder).map_err(without_path)?;
    if let Some(existing) = replaces {
        part.as_file().set_permissions(existing.permissions())?;
    }
    Ok(part)
}

/// Removes the name of the temporary file from an error of tempfile; it would only confuse the user.
fn without_path(error: io::Error) -> io::Error {
    let text = error.to_string();
    io::Error::new(error.kind(), text.split(" at path \"").next().unwrap_or_default().to_owned())
}

#[cfg(unix)]
pub(super) fn inode(metadata: &fs::Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(unix)]
fn is_device(metadata: &fs::Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    metadata.file_type().is_char_device()
}

/// The file that standard output is redirected to; `None` if it is a device.
#[cfg(unix)]
fn stdout_inode() -> Option<(u64, u64)> {
    use std::os::fd::AsFd;
    let file = File::from(io::stdout().as_fd().try_clone_to_owned().ok()?);
    let metadata = file.metadata().ok()?;
    inode(&metadata).filter(|_| !is_device(&metadata))
}

#[cfg(not(unix))]
pub(super) fn inode(_: &fs::Metadata) -> Option<(u64, u64)> {
    None
}

#[cfg(not(unix))]
fn is_device(_: &fs::Metadata) -> bool {
    true
}

#[cfg(not(unix))]
fn stdout_inode() -> Option<(u64, u64)> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn modes_and_links_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new.csv");
        let plain = folder.path().join("plain");
        fs::write(&plain, "").unwrap();
        Sink::open(&path).unwrap().finish().unwrap();
        let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&path), mode(&plain));

        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        let link = folder.path().join("link.csv");
        symlink("new.csv", &link).unwrap();
        write_file(&link, b"through").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&path).unwrap(), "through");
        assert_eq!(mode(&path) & 0o777, 0o640);

        let dangling = folder.path().join("dangling.csv");
        symlink("later.csv", &dangling).unwrap();
        Sink::open(&dangling).unwrap().finish().unwrap();
        assert!(folder.path().join("later.csv").is_file());
    }

    #[test]
    fn two_names_of_one_file_are_recognised() {
        let folder = tempfile::tempdir().unwrap();
        let a = Sink::open(&folder.path().join("a.csv")).unwrap();
        let same = folder.path().join(".").join("a.csv");
        assert!(a.is_at(&same) && !a.is_at(&folder.path().join("c.csv")));
        assert!(matches!(Sink::open(&same).unwrap_err(), OpenError::Busy(_)));
        a.finish().unwrap();
        Sink::open(&same).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn bad_paths_are_reported() {
        let folder = tempfile::tempdir().unwrap();
        let missing = Sink::open(&folder.path().join("none").join("a.csv")).unwrap_err();
        assert!(matches!(missing, OpenError::MissingFolder { .. }), "{missing}");
        assert!(matches!(Sink::open(folder.path()).unwrap_err(), OpenError::IsFolder(_)));
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        let under = Sink::open(&file.join("a.csv")).unwrap_err();
        assert!(matches!(under, OpenError::MissingFolder { .. }), "{under}");
    }
}
