//! Clipping of text from a file for a message.

/// The text shortened to one line without control characters.
pub(super) fn clip(text: &str) -> String {
    const MAX_LENGTH: usize = 200;
    let clean = |c: char| if c.is_control() { ' ' } else { c };
    let mut clipped: String = text.chars().take(MAX_LENGTH).map(clean).collect();
    if text.chars().nth(MAX_LENGTH).is_some() {
        clipped.push_str("..");
    }
    clipped
}
