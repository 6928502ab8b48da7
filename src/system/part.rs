//! File that is written in blocks, with a journal beside it, so that what was written is never lost.
//!
//! `map.csv` is written as `map.csv.part`, its journal is `map.csv.part.journal`. A block counts once its
//! bytes are on the disk and its line in the journal is too: a thread of its own writes and syncs, so that
//! nobody waits for the disk. The file gets its name when it is whole. Who has the journal locked has the
//! file.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use super::checksum::Checksum;
use super::journal::{self, Block, Journal};
use super::sink::{follow_links, inode};

/// What the thread is told: bytes to be written, or the end of a block of so many rows, with a note on it.
enum Message {
    Bytes(String),
    Block(u64, String),
}

/// Messages that may wait for the disk.
const WAITING: usize = 256;

/// A file of which no one else writes, and what was found of it.
#[derive(Debug)]
pub struct Opened {
    places: Places,
    lock: File,
    journal: Journal,
    exists: bool,
}

#[derive(Debug, Clone)]
struct Places {
    target: PathBuf,
    part: PathBuf,
    journal: PathBuf,
}

/// Why a file cannot be begun or gone on with.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// Another process writes it.
    #[error("another process is writing {}: wait for it, or name another file", .0.display())]
    Busy(PathBuf),
    /// A block is not as it was written.
    #[error("{part}: {what}")]
    Damaged {
        /// The file.
        part: String,
        /// What is wrong, as a clause.
        what: String,
        /// The rows before the damage.
        rows: u64,
    },
    /// The operating system refuses.
    #[error("cannot write {}: {problem}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What it says.
        problem: io::Error,
    },
}

/// A file in work.
#[derive(Debug)]
pub struct Part {
    places: Places,
    kept: Arc<AtomicU64>,
    sender: Option<SyncSender<Message>>,
    thread: Option<JoinHandle<io::Result<Checksum>>>,
    /// Held for its lock.
    _lock: File,
}

/// `path` with more behind its name.
fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

impl Opened {
    /// Locks the file that is to become `target`, and reads what there is of it. Changes nothing but that
    /// there is a journal.
    pub fn new(target: &Path) -> Result<Self, PartError> {
        let target = follow_links(target);
        let part = beside(&target, ".part");
        let places = Places { journal: beside(&part, ".journal"), part, target };
        let refused = |problem| PartError::Refused { path: places.journal.clone(), problem };
        let mut lock = loop {
            let mut open = OpenOptions::new();
            let lock = open.read(true).append(true).create(true).open(&places.journal).map_err(refused)?;
            match lock.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(PartError::Busy(places.target)),
                // A file system that knows no locks.
                Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
                Err(TryLockError::Error(error)) => return Err(refused(error)),
            }
            // Whoever had it may have removed it since.
            let there = fs::metadata(&places.journal);
            if there.is_ok_and(|there| lock.metadata().is_ok_and(|own| inode(&own) == inode(&there))) {
                break lock;
            }
        };
        let mut bytes = Vec::new();
        lock.read_to_end(&mut bytes).map_err(refused)?;
        let exists = fs::metadata(&places.part).is_ok_and(|there| there.len() > 0);
        Ok(Self { journal: journal::read(&bytes), places, lock, exists })
    }

    /// The file of the rows so far.
    pub fn part(&self) -> &Path {
        &self.places.part
    }

    /// Whether there are rows of an earlier process.
    pub fn has_rows(&self) -> bool {
        self.exists
    }

    /// What an earlier process began it with; none where its journal is gone or cannot be read.
    pub fn head(&self) -> Option<&str> {
        self.journal.head.as_deref()
    }

    /// The rows that the journal has.
    pub fn rows(&self) -> u64 {
        self.journal.blocks.iter().map(|(block, _)| block.rows).sum()
    }

    /// Leaves all as it was: removes a journal that belongs to nothing.
    pub fn leave(self) {
        let empty = self.lock.metadata().is_ok_and(|own| own.len() == 0);
        if !self.exists || empty {
            let _ = fs::remove_file(&self.places.journal);
        }
    }

    /// Begins anew, with the line `first` in the file and `head` in the journal.
    pub fn begin(self, head: &str, first: &str) -> Result<Part, PartError> {
        let Self { places, mut lock, .. } = self;
        let path = places.part.clone();
        let mut begin = || -> io::Result<File> {
            let part = OpenOptions::new().write(true).create(true).truncate(true).open(&places.part)?;
            if let Ok(there) = fs::metadata(&places.target) {
                part.set_permissions(there.permissions())?;
            }
            lock.set_len(0)?;
            lock.write_all(journal::line(head).as_bytes())?;
            lock.sync_data()?;
            Ok(part)
        };
        let part = begin().map_err(|problem| {
            let _ = (fs::remove_file(&places.part), fs::remove_file(&places.journal));
            PartError::Refused { path, problem }
        })?;
        let mut own = Part::new(places, lock, part, Checksum::default(), 0)?;
        own.put(first.to_owned())
            .and_then(|()| own.end_block(0, String::new()))
            .map_err(|problem| PartError::Refused { path: own.places.part.clone(), problem })?;
        Ok(own)
    }

    /// Goes on where the last whole block ends; whatever stands behind it is dropped. The blocks that are
    /// kept. Where a block is not as it was written: an error that changes nothing, or, if `mend`, only the
    /// blocks before it are kept.
    pub fn go_on(self, mend: bool) -> Result<(Part, Vec<Block>), PartError> {
        let Self { places, lock, mut journal, .. } = self;
        let path = places.part.clone();
        let refused = |problem| PartError::Refused { path: path.clone(), problem };
        let mut part = OpenOptions::new().read(true).write(true).open(&path).map_err(refused)?;
        let (mut whole, mut rows, mut length) = (Checksum::default(), 0, 0);
        let mut kept = Vec::new();
        let mut wrong = None;
        for (block, end) in std::mem::take(&mut journal.blocks) {
            let mut bytes = Vec::new();
            (&mut part).take(block.bytes).read_to_end(&mut bytes).map_err(refused)?;
            let mut own = Checksum::default();
            own.add(&bytes);
            if own.text() != block.sha256 {
                let what = if bytes.len() as u64 == block.bytes { "changed" } else { "missing" };
                let last = rows + block.rows;
                wrong = Some(match block.rows {
                    0 => format!("its header is {what} since it was written"),
                    _ => format!("rows {} to {last} are {what} since they were written", rows + 1),
                });
                break;
            }
            whole.add(&bytes);
            (rows, length, journal.head_length) = (rows + block.rows, length + block.bytes, end);
            kept.push(block);
        }
        let after = || format!("what its journal says after row {rows} is changed since it was written");
        if let Some(what) = wrong.or(journal.damaged.then(after)).filter(|_| !mend || kept.is_empty()) {
            return Err(PartError::Damaged { part: path.display().to_string(), what, rows });
        }
        let cut = part.set_len(length).and_then(|()| part.seek(SeekFrom::Start(length)));
        cut.and_then(|_| lock.set_len(journal.head_length)).map_err(refused)?;
        Ok((Part::new(places, lock, part, whole, rows)?, kept))
    }
}

impl Part {
    fn new(places: Places, lock: File, part: File, whole: Checksum, rows: u64) -> Result<Self, PartError> {
        let kept = Arc::new(AtomicU64::new(rows));
        let (sender, receiver) = sync_channel(WAITING);
        let start = || {
            let (journal, kept) = (lock.try_clone()?, Arc::clone(&kept));
            let work = move || write(receiver, (part, journal), whole, &kept);
            std::thread::Builder::new().name("blocks".into()).spawn(work)
        };
        let refused = |problem| PartError::Refused { path: places.part.clone(), problem };
        let thread = start().map_err(refused)?;
        Ok(Self { places, kept, sender: Some(sender), thread: Some(thread), _lock: lock })
    }

    /// The file of the rows so far.
    pub fn path(&self) -> &Path {
        &self.places.part
    }

    /// Rows on the disk.
    pub fn kept(&self) -> u64 {
        self.kept.load(Ordering::Relaxed)
    }

    /// Appends text.
    pub fn put(&mut self, text: String) -> io::Result<()> {
        self.send(Message::Bytes(text))
    }

    /// Ends a block of so many rows.
    pub fn end_block(&mut self, rows: u64, note: String) -> io::Result<()> {
        self.send(Message::Block(rows, note))
    }

    fn send(&mut self, message: Message) -> io::Result<()> {
        let sent = self.sender.as_ref().is_some_and(|sender| sender.send(message).is_ok());
        // Its thread has ended, which it does alone only by an error.
        if sent { Ok(()) } else { self.close().map(|_| ()) }
    }

    /// Waits until all blocks are on the disk; the checksum of all bytes.
    pub fn close(&mut self) -> io::Result<String> {
        self.sender = None;
        let ended = || Err(io::Error::other("its writer has ended"));
        let joined = self.thread.take().map(JoinHandle::join);
        joined.and_then(Result::ok).unwrap_or_else(ended).map(|whole| whole.text())
    }

    /// Gives the file its name. Precondition: it is [closed](Self::close) without an error.
    pub fn finish(self) -> io::Result<()> {
        fs::rename(&self.places.part, &self.places.target)?;
        // The new name is on the disk before the journal is gone from it; not every system can say so.
        let folder = self.places.target.parent().filter(|own| !own.as_os_str().is_empty());
        let _ = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
        fs::remove_file(&self.places.journal)
    }

    /// Removes a file of which no row is kept.
    pub fn discard(mut self) {
        let _ = self.close();
        if self.kept() == 0 {
            let _ = (fs::remove_file(&self.places.part), fs::remove_file(&self.places.journal));
        }
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        let _ = self.close();
    }
}

/// Writes what comes and syncs at the end of each block, or of those that came meanwhile; the checksum of
/// all.
fn write(
    receiver: Receiver<Message>,
    (mut part, mut journal): (File, File),
    mut whole: Checksum,
    kept: &AtomicU64,
) -> io::Result<Checksum> {
    let (mut own, mut bytes) = (Checksum::default(), 0);
    while let Ok(first) = receiver.recv() {
        let (mut lines, mut rows, mut written) = (String::new(), 0, Ok(()));
        for message in std::iter::once(first).chain(receiver.try_iter().take(WAITING)) {
            match message {
                Message::Bytes(text) => {
                    written = part.write_all(text.as_bytes());
                    if written.is_err() {
                        break; // the blocks before it count
                    }
                    own.add(text.as_bytes());
                    whole.add(text.as_bytes());
                    bytes += text.len() as u64;
                }
                Message::Block(more, note) => {
                    let sha256 = std::mem::take(&mut own).text();
                    let block = Block { rows: more, bytes: std::mem::take(&mut bytes), sha256, note };
                    lines += &journal::line(&serde_json::to_string(&block)?);
                    rows += more;
                }
            }
        }
        if !lines.is_empty() {
            part.sync_data()?;
            journal.write_all(lines.as_bytes())?;
            journal.sync_data()?;
            kept.fetch_add(rows, Ordering::Relaxed);
        }
        written?;
    }
    Ok(whole)
}
