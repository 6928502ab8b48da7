//! Which command line makes the map that is shown?

use crate::app::export::quoted;
use crate::app::session::editor::Editor;
use crate::scene::arguments;

use super::{Question, over};

/// The command, quoted for a shell; none for a scene that neither has a file nor is built in, until it is
/// saved. What has been changed since it was opened or saved, or is the map's own, is said by `--set`.
pub fn command(question: &Question, editor: &Editor) -> Option<String> {
    let spec = editor.origin()?;
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
    Some(words.join(" "))
}
