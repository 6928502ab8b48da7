//! Sentences of a lesson: what was expected, how a task is judged, what a bold word points at.

use crate::scene::Start;
use crate::scene::lesson::Lesson;

/// The title of the row of a lesson: its number, where it has one.
pub fn numbered(name: &str) -> String {
    let number = name.split('-').next().and_then(|own| own.parse::<u32>().ok());
    number.map_or_else(|| "Lesson".to_owned(), |number| format!("Lesson {number}"))
}

/// What was expected and what came of it, where that is known.
pub fn expected(choice: Option<&str>, outcome: Option<&str>) -> String {
    let whole = |text: &'_ str| plain(text.trim_end_matches('.'));
    match (choice.map(whole), outcome.map(whole)) {
        (Some(choice), Some(outcome)) if choice == outcome => {
            format!("You expected: “{choice}”. So it did.")
        }
        (Some(choice), Some(outcome)) => format!("You expected: “{choice}”. It did: “{outcome}”."),
        (Some(choice), None) => format!("You expected: “{choice}”. Watch what it does."),
        (None, Some(outcome)) => format!("It did: “{outcome}”."),
        (None, None) => "Watch what it does.".to_owned(),
    }
}

/// By what a task is judged.
pub fn judged_by(lesson: &Lesson, start: Start) -> String {
    let from = if start == Start::Rest { "from rest" } else { "from the scene's start" };
    match (&lesson.walk, lesson.seeds) {
        (Some(_), _) => "Judged on runs up and down, each going on from the one before.".to_owned(),
        (None, Some(seeds)) => format!("Judged on {seeds} full runs {from}, each with noise of its own."),
        (None, None) => format!("Judged on a full run {from}, not on the motion shown."),
    }
}

/// A part of a text, and whether it is bold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Piece<'a> {
    /// The text without its marks.
    pub text: &'a str,
    /// Whether it stands between two `**`.
    pub bold: bool,
}

/// The parts of a text with **bold** words. A mark without its partner begins nothing.
pub fn pieces(text: &str) -> Vec<Piece<'_>> {
    let parts: Vec<&str> = text.split("**").collect();
    let last = parts.len() - 1;
    let bold = |index: usize| index % 2 == 1 && index < last;
    let all = parts.iter().enumerate().map(|(index, text)| Piece { text, bold: bold(index) });
    all.filter(|own| !own.text.is_empty()).collect()
}

/// A text without its marks.
pub fn plain(text: &str) -> String {
    text.replace("**", "")
}

/// The bold words of a text in small letters. Those that name something on the screen point at it.
pub fn pointed(text: &str) -> impl Iterator<Item = String> {
    pieces(text).into_iter().filter(|own| own.bold).map(|own| own.text.trim().to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bold_words_are_told_from_the_others() {
        let own = |text, bold| Piece { text, bold };
        assert_eq!(pieces("a **b** c"), [own("a ", false), own("b", true), own(" c", false)]);
        assert_eq!(pieces("**b**"), [own("b", true)]);
        assert_eq!(pieces("a **b"), [own("a ", false), own("b", false)]);
        assert_eq!(pieces(""), []);
        assert_eq!(pointed("The **Force curve** at **stops**").collect::<Vec<_>>(), ["force curve", "stops"]);
        assert_eq!(numbered("03-a-stop"), "Lesson 3");
    }

    #[test]
    fn a_prediction_is_set_against_what_came_of_it() {
        assert_eq!(expected(Some("a"), Some("a")), "You expected: “a”. So it did.");
        assert_eq!(expected(Some("a"), Some("b")), "You expected: “a”. It did: “b”.");
        assert_eq!(expected(None, Some("b")), "It did: “b”.");
    }
}
