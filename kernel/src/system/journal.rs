//! Journal of a file that is written in blocks: its head and the checksum of each block.
//!
//! A line is a checksum of the rest of the line, a space, and JSON. The first line is the head that the file
//! was begun with, and each further line is a block. A line that was not completely written, as after a power
//! failure, does not match its checksum; it is dropped if it is the last one.

use serde::{Deserialize, Serialize};

use super::checksum::checksum;

/// A block that was written and synced.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Block {
    /// Number of rows.
    pub rows: u64,
    /// Number of bytes.
    pub bytes: u64,
    /// Checksum of the bytes.
    pub sha256: String,
    /// Note by the writer of the rows.
    pub note: String,
}

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Journal {
    /// The head that the file was begun with; `None` if it was not completely written.
    pub head: Option<String>,
    /// The blocks, each with the length of the journal up to its end.
    pub blocks: Vec<(Block, u64)>,
    /// The length of the journal up to the end of the head.
    pub head_length: u64,
    /// Whether there is an error other than an incomplete last line.
    pub damaged: bool,
}

const DIGITS: usize = 16;

/// The line for this JSON.
pub(super) fn line(json: &str) -> String {
    format!("{} {json}\n", &checksum(json.as_bytes())[..DIGITS])
}

/// The JSON of a line; `None` if its checksum is wrong.
fn json(line: &[u8]) -> Option<&str> {
    let text = str::from_utf8(line).ok()?;
    let (sum, json) = text.strip_suffix('\n')?.split_once(' ')?;
    (checksum(json.as_bytes()).get(..DIGITS)? == sum).then_some(json)
}

pub(super) fn read(bytes: &[u8]) -> Journal {
    let mut journal = Journal::default();
    let mut lines = bytes.split_inclusive(|byte| *byte == b'\n').peekable();
    let Some(head) = lines.next() else { return journal };
    let Some(text) = json(head) else {
        journal.damaged = lines.peek().is_some();
        return journal;
    };
    journal.head = Some(text.to_owned());
    journal.head_length = head.len() as u64;
    let mut length = journal.head_length;
    while let Some(line) = lines.next() {
        let Some(block) = json(line).and_then(|text| serde_json::from_str(text).ok()) else {
            journal.damaged = lines.peek().is_some();
            break;
        };
        length += line.len() as u64;
        journal.blocks.push((block, length));
    }
    journal
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(rows: u64) -> Block {
        Block { rows, bytes: 10 * rows, sha256: "00".into(), note: "{\"a\":1}".into() }
    }

    fn text() -> String {
        let blocks = [1, 2, 3].map(|rows| line(&serde_json::to_string(&block(rows)).unwrap()));
        line("{\"head\":\"plan\"}") + &blocks.concat()
    }

    #[test]
    fn a_journal_is_read_as_it_was_written_and_a_torn_last_line_is_dropped() {
        let text = text();
        for length in 0..=text.len() {
            let whole = text[..length].matches('\n').count();
            let journal = read(&text.as_bytes()[..length]);
            assert_eq!(journal.head.is_some(), whole > 0);
            assert!(!journal.damaged, "{length}");
            let rows: Vec<u64> = journal.blocks.iter().map(|(block, _)| block.rows).collect();
            assert_eq!(rows, [1, 2, 3][..whole.saturating_sub(1)]);
            for (read, end) in &journal.blocks {
                assert_eq!((read, text.as_bytes()[*end as usize - 1]), (&block(read.rows), b'\n'));
            }
        }
    }

    #[test]
    fn a_byte_that_was_changed_is_found() {
        let text = text();
        let last = text.trim_end().rfind('\n').unwrap() + 1;
        // the last two lines are left out: without the line end between them they look like
        // one incomplete line
        for at in 0..last - 1 {
            let mut bytes = text.clone().into_bytes();
            bytes[at] ^= 1;
            let journal = read(&bytes);
            assert!(journal.damaged || journal.head.is_none(), "byte {at}: {journal:?}");
        }
    }
}
