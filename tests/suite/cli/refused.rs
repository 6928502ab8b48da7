//! Commands that are refused, and the whole of what each of them says: the commands stand in `refused.txt`,
//! what they say in the snapshot, which `INSTA_UPDATE=always` writes anew.

use std::fs;
use std::thread;

use super::plain;

/// A command a line, as it is typed after `interwell `; `#` begins the heading of those below it.
const REFUSED: &str = include_str!("refused.txt");

/// A command and what it writes to standard error: it ends with status 2, writes no more than a message of
/// few lines, and leaves nothing in the folder that it runs in.
fn said(line: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let words = shlex::split(line).unwrap();
    let output = plain("").args(words).current_dir(folder.path()).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.as_slice()), (Some(2), &b""[..]), "{line}: {text}");
    assert!(text.starts_with("error: ") && text.lines().count() <= 4, "{line}: {text}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{line}: it wrote a file");
    format!("$ interwell {line}\n{text}")
}

#[test]
fn what_is_refused_says_why() {
    let lines: Vec<&str> = REFUSED.lines().filter(|line| !line.starts_with('#')).collect();
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let transcript: String = thread::scope(|scope| {
        let parts: Vec<_> = lines
            .chunks(lines.len().div_ceil(threads))
            .map(|part| scope.spawn(move || part.iter().map(|line| said(line)).collect::<String>()))
            .collect();
        parts.into_iter().map(|part| part.join().unwrap()).collect()
    });
    insta::assert_snapshot!(transcript);
}
