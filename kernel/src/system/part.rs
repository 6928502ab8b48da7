//! File that is written in blocks, with a journal, so that an interruption loses no complete block.
//!
//! `map.csv` is written as `map.csv.part` with the journal `map.csv.part.journal`. A block is complete when
//! its bytes and its line in the journal are on the disk. A separate thread writes and syncs, so that the
//! caller does not wait for the disk. The file gets its name when it is complete. Its lock is on the
//! journal.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use super::checksum::Checksum;
use super::journal::{self, Block, Journal};
use super::lock::{Lock, lock_path, with_ending};
use super::sink::{Sink, follow_links};

/// A message to the writing thread: bytes to write, or the end of a block with its number of rows and a note.
enum Message {
    Bytes(String),
    Block(u64, String),
}

/// Largest number of messages that wait for the disk.
const MAX_WAITING: usize = 256;

/// A locked file with the rows and the journal found in it.
#[doc(hidden)]
#[derive(Debug)]
pub struct Opened {
    paths: Paths,
    lock: Lock,
    journal: Journal,
    exists: bool,
}

#[derive(Debug, Clone)]
struct Paths {
    target: PathBuf,
    part: PathBuf,
    journal: PathBuf,
}

/// Reason why a file cannot be begun or continued.
#[doc(hidden)]
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// A block has been changed since it was written.
    #[error("{part}: {what}")]
    Damaged {
        /// The file.
        part: String,
        /// The damage, as a clause.
        what: String,
        /// Number of rows before the damage.
        rows: u64,
    },
    /// The operating system reports an error.
    #[error("cannot write {}: {problem}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// The error.
        problem: io::Error,
    },
}

/// A file that is being written.
#[doc(hidden)]
#[derive(Debug)]
pub struct Part {
    paths: Paths,
    kept: Arc<AtomicU64>,
    sender: Option<SyncSender<Message>>,
    thread: Option<JoinHandle<io::Result<Checksum>>>,
    lock: Lock,
}

impl Opened {
    /// Reads the journal of the file that will become `target`, with the lock of `sink`, which is open on
    /// `target` and is closed. This changes nothing.
    pub fn new(target: &Path, sink: Sink) -> Result<Self, PartError> {
        let target = follow_links(target);
        let (part, journal) = (with_ending(&target, ".part"), lock_path(&target));
        let paths = Paths { part, journal, target };
        let refused = |problem| PartError::Refused { path: paths.journal.clone(), problem };
        let Some(mut lock) = sink.into_lock() else {
            return Err(refused(io::Error::other("it is no regular file")));
        };
        let mut bytes = Vec::new();
        lock.read_to_end(&mut bytes).map_err(refused)?;
        let exists = fs::metadata(&paths.part).is_ok_and(|existing| existing.len() > 0);
        Ok(Self { journal: journal::read(&bytes), paths, lock, exists })
    }

    /// The path of the file with the rows so far.
    pub fn part(&self) -> &Path {
        &self.paths.part
    }

    /// Whether an earlier process left rows, or bytes that the journal does not mention. A process that ended
    /// before it wrote the first line of its journal left no rows.
    pub fn has_rows(&self) -> bool {
        let is_begun = self.journal.head.is_some() && !self.journal.damaged;
        self.exists && !(is_begun && self.journal.blocks.is_empty())
    }

    /// The head that an earlier process began it with; `None` if its journal is missing or cannot be read.
    pub fn head(&self) -> Option<&str> {
        self.journal.head.as_deref()
    }

    /// The number of rows in the journal.
    pub fn rows(&self) -> u64 {
        self.journal.blocks.iter().map(|(block, _)| block.rows).sum()
    }

    /// Closes the file unchanged; a journal that is empty or has no file is removed.
    pub fn leave(self) {
        if !self.exists {
            let _ = self.lock.set_len(0);
        }
    }

    /// Starts the file again, with the line `first` in the file and `head` in the journal.
    pub fn begin(self, head: &str, first: &str) -> Result<Part, PartError> {
        let Self { paths, mut lock, .. } = self;
        let path = paths.part.clone();
        let mut begin = || -> io::Result<File> {
            let part = OpenOptions::new().write(true).create(true).truncate(true).open(&paths.part)?;
            if let Ok(existing) = fs::metadata(&paths.target) {
                part.set_permissions(existing.permissions())?;
            }
            lock.set_len(0)?;
            lock.rewind()?;
            lock.write_all(journal::line(head).as_bytes())?;
            lock.sync_data()?;
            Ok(part)
        };
        let part = begin().map_err(|problem| {
            let _ = (fs::remove_file(&paths.part), lock.set_len(0));
            PartError::Refused { path, problem }
        })?;
        let mut part = Part::new(paths, lock, part, Checksum::default(), 0)?;
        part.put(first.to_owned())
            .and_then(|()| part.end_block(0, String::new()))
            .map_err(|problem| PartError::Refused { path: part.paths.part.clone(), problem })?;
        Ok(part)
    }

    /// Continues after the last complete block and drops everything after it. Returns the blocks that are
    /// kept. If a block has been changed, this fails without changing anything, or, if `repair`, keeps only
    /// the blocks before it.
    pub fn resume(self, repair: bool) -> Result<(Part, Vec<Block>), PartError> {
        let Self { paths, mut lock, mut journal, .. } = self;
        let path = paths.part.clone();
        let refused = |problem| PartError::Refused { path: path.clone(), problem };
        let mut part = OpenOptions::new().read(true).write(true).open(&path).map_err(refused)?;
        let (mut whole, mut rows, mut length) = (Checksum::default(), 0, 0);
        let mut kept = Vec::new();
        let mut damage = None;
        for (block, end) in std::mem::take(&mut journal.blocks) {
            let mut bytes = Vec::new();
            (&mut part).take(block.bytes).read_to_end(&mut bytes).map_err(refused)?;
            let mut checksum = Checksum::default();
            checksum.add(&bytes);
            if checksum.text() != block.sha256 {
                let what = if bytes.len() as u64 == block.bytes { "changed" } else { "missing" };
                let last = rows + block.rows;
                damage = Some(match block.rows {
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
        if let Some(what) = damage.or(journal.damaged.then(after)).filter(|_| !repair || kept.is_empty()) {
            return Err(PartError::Damaged { part: path.display().to_string(), what, rows });
        }
        let cut = part.set_len(length).and_then(|()| part.seek(SeekFrom::Start(length)));
        let cut = cut.and_then(|_| lock.set_len(journal.head_length));
        cut.and_then(|()| lock.seek(SeekFrom::End(0))).map_err(refused)?;
        Ok((Part::new(paths, lock, part, whole, rows)?, kept))
    }
}

impl Part {
    fn new(paths: Paths, lock: Lock, part: File, whole: Checksum, rows: u64) -> Result<Self, PartError> {
        let kept = Arc::new(AtomicU64::new(rows));
        let (sender, receiver) = sync_channel(MAX_WAITING);
        let start = || {
            let (journal, kept) = (lock.try_clone()?, Arc::clone(&kept));
            let work = move || write(receiver, part, journal, whole, &kept);
            std::thread::Builder::new().name("blocks".into()).spawn(work)
        };
        let refused = |problem| PartError::Refused { path: paths.part.clone(), problem };
        let thread = start().map_err(refused)?;
        Ok(Self { paths, kept, sender: Some(sender), thread: Some(thread), lock })
    }

    /// The path of the file with the rows so far.
    pub fn path(&self) -> &Path {
        &self.paths.part
    }

    /// Number of rows on the disk.
    pub fn kept(&self) -> u64 {
        self.kept.load(Ordering::Relaxed)
    }

    /// Appends text.
    pub fn put(&mut self, text: String) -> io::Result<()> {
        self.send(Message::Bytes(text))
    }

    /// Ends a block of `rows` rows.
    pub fn end_block(&mut self, rows: u64, note: String) -> io::Result<()> {
        self.send(Message::Block(rows, note))
    }

    fn send(&mut self, message: Message) -> io::Result<()> {
        let sent = self.sender.as_ref().is_some_and(|sender| sender.send(message).is_ok());
        // Sending fails only if the thread has ended by an error, which `close` returns.
        if sent { Ok(()) } else { self.close().map(|_| ()) }
    }

    /// Waits until all blocks are on the disk and returns the checksum of all bytes.
    pub fn close(&mut self) -> io::Result<String> {
        self.sender = None;
        let ended = || Err(io::Error::other("its writer has ended"));
        let joined = self.thread.take().map(JoinHandle::join);
        joined.and_then(Result::ok).unwrap_or_else(ended).map(|whole| whole.text())
    }

    /// Gives the file its name. Precondition: [`close`](Self::close) has succeeded.
    pub fn finish(self) -> io::Result<()> {
        fs::rename(&self.paths.part, &self.paths.target)?;
        // Sync the new name before the journal is removed; not every system can do this.
        let folder = self.paths.target.parent().filter(|folder| !folder.as_os_str().is_empty());
        let _ = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
        self.lock.set_len(0)
    }

    /// Closes the file and removes it if it has no rows.
    pub fn discard(mut self) {
        let _ = self.close();
        if self.kept() == 0 {
            let _ = (fs::remove_file(&self.paths.part), self.lock.set_len(0));
        }
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        let _ = self.close();
    }
}

/// Writes the received messages and syncs after each block, or once after all blocks that are waiting.
/// Returns the checksum of all bytes.
fn write(
    receiver: Receiver<Message>,
    mut part: File,
    mut journal: File,
    mut whole: Checksum,
    kept: &AtomicU64,
) -> io::Result<Checksum> {
    let (mut block_sum, mut bytes) = (Checksum::default(), 0);
    while let Ok(first) = receiver.recv() {
        let (mut lines, mut rows, mut written) = (String::new(), 0, Ok(()));
        for message in std::iter::once(first).chain(receiver.try_iter().take(MAX_WAITING)) {
            match message {
                Message::Bytes(text) => {
                    written = part.write_all(text.as_bytes());
                    if written.is_err() {
                        break; // the blocks before it count
                    }
                    block_sum.add(text.as_bytes());
                    whole.add(text.as_bytes());
                    bytes += text.len() as u64;
                }
                Message::Block(more, note) => {
                    let sha256 = std::mem::take(&mut block_sum).text();
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
