//! Which command line makes the map that is shown?

use crate::app::document::Editor;
use crate::scene::arguments;

use super::{Question, over};

/// The command, quoted for a shell. The scene is the file or the built-in scene that was opened; what has been changed
/// since, or is the map's own, is said by `--set`.
pub fn command(question: &Question, editor: &Editor) -> String {
    let name = &editor.document().name;
    let spec = match editor.path() {
        Some(path) => path.to_string_lossy().into_owned(),
        None => name.strip_prefix("built-in ").unwrap_or(name).to_owned(),
    };
    let mut from = editor.saved().clone();
    // what the axes say need not be set
    for axis in &question.axes {
        let known = crate::scene::FieldPath::new(&axis.field).set(&mut from, axis.from);
        debug_assert!(known || editor.saved().stops != question.scene.stops);
    }
    let mut words = vec!["interwell".to_owned(), "--headless".to_owned(), "sweep".to_owned(), quoted(&spec)];
    for argument in arguments(&from, &question.scene) {
        words.extend(["--set".to_owned(), quoted(&argument)]);
    }
    for axis in &question.axes {
        words.extend(["--over".to_owned(), quoted(&over(axis))]);
    }
    words.join(" ")
}

/// A word that a shell leaves as it is.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_they_must_be() {
        assert_eq!(quoted("excitation.amplitude_g=0:2:0.02"), "excitation.amplitude_g=0:2:0.02");
        assert_eq!(quoted("stops=Rigid(a: 1)"), "'stops=Rigid(a: 1)'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}
