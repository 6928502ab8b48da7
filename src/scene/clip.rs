//! Text from a file as part of a message.

/// The text on one line, not too long, with nothing that moves a cursor.
pub(super) fn clip(text: &str) -> String {
    const LONGEST: usize = 200;
    let clean = |c: char| if c.is_control() { ' ' } else { c };
    let mut clipped: String = text.chars().take(LONGEST).map(clean).collect();
    if text.chars().nth(LONGEST).is_some() {
        clipped.push_str("..");
    }
    clipped
}
