//! Detection of comments in the text of a scene.

/// Whether a scene's text has comments: `//` or `/*` outside of its strings, raw ones included.
pub fn has_comments(text: &str) -> bool {
    let mut rest = text;
    while let Some(at) = rest.find(['"', '/']) {
        let (before, found) = rest.split_at(at);
        if found.starts_with("//") || found.starts_with("/*") {
            return true;
        }
        rest = &found[1..];
        if found.starts_with('/') {
            continue;
        }
        let hashes = before.len() - before.trim_end_matches('#').len();
        let opening = before[..before.len() - hashes].strip_suffix('r');
        let is_raw = opening.is_some_and(|own| !own.ends_with(|c: char| c.is_alphanumeric() || c == '_'));
        let end = if is_raw {
            let close = format!("\"{}", "#".repeat(hashes));
            rest.find(&close).map(|at| at + close.len())
        } else {
            end_of_string(rest)
        };
        let Some(end) = end else { return false };
        rest = &rest[end..];
    }
    false
}

/// Behind the quote that ends a string, whose text follows.
fn end_of_string(text: &str) -> Option<usize> {
    let mut chars = text.char_indices();
    while let Some((at, c)) = chars.next() {
        match c {
            '\\' => drop(chars.next()),
            '"' => return Some(at + 1),
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_told_from_text() {
        assert!(has_comments("( // what\n)") && has_comments("(/* what */)"));
        assert!(!has_comments("(notes: \"http://a \\\" // b\", mass_g: 1)"));
        assert!(has_comments("(notes: \"a\\\\\") // b"));
    }

    #[test]
    fn raw_strings_end_where_they_say() {
        assert!(!has_comments(r#"(notes: r"C:\" , title: "http://a")"#));
        assert!(!has_comments("(notes: r#\"she said \"no\" // not a comment\"#, mass_g: 1)"));
        assert!(has_comments(r#"(notes: r"C:\" /* here */)"#));
        assert!(has_comments("(notes: r##\"a \"# b\"## // here\n)"));
        // a name that ends in r is no raw string
        assert!(has_comments("(r: \"a\\\"b\", // here\n)"));
    }
}
