//! Journal of a file that is written in blocks: what it was begun with, and the checksum of each block.
//!
//! A line is a checksum of the rest of the line, a space, and JSON. The first one is what the file was begun
//! with, each further one a block. A line that was being written when the power went does not have its
//! checksum; where it is the last one, it is dropped.

use serde::{Deserialize, Serialize};

use super::checksum::checksum;

/// A block that was written and synced.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Block {
    /// Its rows and bytes.
    pub rows: u64,
    /// Its bytes.
    pub bytes: u64,
    /// Their checksum.
    pub sha256: String,
    /// What the writer of the rows has to say of them.
    pub note: String,
}

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Journal {
    /// What the file was begun with; none where not even that was written.
    pub head: Option<String>,
    /// The blocks, and how long the journal is up to the end of each.
    pub blocks: Vec<(Block, u64)>,
    /// The length up to the end of the head.
    pub head_length: u64,
    /// Whether something is wrong that is no torn last line.
    pub damaged: bool,
}

/// Digits of a line's checksum.
const DIGITS: usize = 16;

/// A line that holds this JSON.
pub(super) fn line(json: &str) -> String {
    format!("{} {json}\n", &checksum(json.as_bytes())[..DIGITS])
}

/// The JSON of a line.
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
        line("{\"head\":\"own\"}") + &blocks.concat()
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
            for (own, end) in &journal.blocks {
                assert_eq!((own, text.as_bytes()[*end as usize - 1]), (&block(own.rows), b'\n'));
            }
        }
    }

    #[test]
    fn a_byte_that_was_changed_is_found() {
        let text = text();
        let last = text.trim_end().rfind('\n').unwrap() + 1;
        // without the end of the last line but one, the last one looks torn
        for at in 0..last - 1 {
            let mut bytes = text.clone().into_bytes();
            bytes[at] ^= 1;
            let journal = read(&bytes);
            assert!(journal.damaged || journal.head.is_none(), "byte {at}: {journal:?}");
        }
    }
}
