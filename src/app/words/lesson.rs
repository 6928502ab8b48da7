//! Sentences of a lesson: what was expected, how a task is judged, what a bold word points at.

use super::fields::name_and_unit;
use super::numbers::three;
use crate::scene::Start;
use crate::scene::lesson::{Condition, Lesson};
use crate::study::{Column, Lack, Value, Values};

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

pub fn judged_by(lesson: &Lesson, start: Start) -> String {
    let from = if start == Start::Rest { "from rest" } else { "from the scene's start" };
    match (&lesson.walk, lesson.seeds) {
        (Some(_), _) => "Judged on runs up and down, each going on from the one before.".to_owned(),
        (None, Some(seeds)) => format!("Judged on {seeds} full runs {from}, each with noise of its own."),
        (None, None) => format!("Judged on a full run {from}, not on the motion shown."),
    }
}

/// That a task is not done, and the first thing that it lacks where a few words say it.
pub fn not_yet(lack: &Lack) -> String {
    let why = lack.asked.field().and_then(named).and_then(|(name, unit)| {
        let (found, asked) = match (&lack.found, &lack.asked) {
            (Value::Word(own), Condition::Is(_, asked)) => (own.clone(), format!("not {asked}")),
            (Value::Number(own), asked) => {
                let (scaled, unit) = match unit {
                    "m" | "m/s" => (1e3 * own, format!("m{unit}")),
                    _ => (*own, unit.to_owned()),
                };
                let wrong = match asked {
                    Condition::AtLeast(..) | Condition::Above(..) => "too small".to_owned(),
                    Condition::AtMost(..) | Condition::Below(..) => "too large".to_owned(),
                    Condition::Between(_, low, _) if own < low => "too small".to_owned(),
                    Condition::Between(..) => "too large".to_owned(),
                    Condition::Is(_, asked) => format!("not {asked}"),
                    _ => return None,
                };
                let text = if scaled.fract() == 0.0 { scaled.to_string() } else { three(scaled) };
                (format!("{text} {unit}").trim_end().to_owned(), wrong)
            }
            (Value::Missing, Condition::Present(_)) => return Some(format!("Not yet ({name}: none).")),
            _ => return None,
        };
        Some(format!("Not yet ({name}: {found}, {asked})."))
    });
    why.unwrap_or_else(|| "Not yet.".to_owned())
}

/// What a field of a condition is called, and its unit.
fn named(field: &str) -> Option<(String, &'static str)> {
    let (of, name) = field.split_once('.')?;
    let (before, after) = match of {
        "scene" => {
            let (name, unit) = name_and_unit(name);
            return Some((name.to_lowercase(), unit));
        }
        "result" => ("", ""),
        "up" => ("", " on the way up"),
        "down" => ("", " on the way down"),
        "mean" => ("mean of ", ""),
        _ => return None,
    };
    let column = Column { name: name.to_owned(), values: Values::Counts(Vec::new()) };
    let label = column.label();
    let words = label.split(", ").next().unwrap_or_default().replace("rms", "RMS");
    Some((format!("{before}{words}{after}"), column.unit()))
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

    #[test]
    fn a_task_that_is_not_done_says_what_it_lacks() {
        let field = |name: &str| name.to_owned();
        let say = |asked: Condition, found: Value| not_yet(&Lack { asked, found });
        let word = Value::Word("rest".to_owned());
        let regime = Condition::Is(field("result.regime"), "interwell".to_owned());
        assert_eq!(say(regime, word), "Not yet (regime: rest, not interwell).");
        let shaking = Condition::AtMost(field("scene.excitation.amplitude_g"), 1.25);
        assert_eq!(say(shaking, Value::Number(1.3)), "Not yet (amplitude: 1.30 g, too large).");
        let speed = Condition::AtLeast(field("result.rms_velocity_m_per_s"), 0.05);
        assert_eq!(say(speed, Value::Number(0.0421)), "Not yet (RMS velocity: 42.1 mm/s, too small).");
        let count = Condition::Is(field("result.crossings"), "3".to_owned());
        assert_eq!(say(count, Value::Number(1.0)), "Not yet (crossings: 1, not 3).");
        assert_eq!(say(Condition::Present(field("scene.stops")), Value::Missing), "Not yet (stops: none).");
        let gap = Condition::Above(field("walk.gap"), 0.1);
        assert_eq!(say(gap, Value::Missing), "Not yet.");
        assert_eq!(say(Condition::Any(Vec::new()), Value::Missing), "Not yet.");
    }
}
