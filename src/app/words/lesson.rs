//! Sentences of a lesson: predictions and their outcomes, the verdict on a task, bold words.

use super::fields::name_and_unit;
use super::numbers::three;
use crate::scene::Start;
use crate::scene::lesson::{Condition, Lesson};
use crate::study::{Lack, Value, label_and_unit};

/// The short title of a lesson: "Lesson" with its number, if its name begins with one.
pub fn numbered(name: &str) -> String {
    let number = name.split('-').next().and_then(|number| number.parse::<u32>().ok());
    number.map_or_else(|| "Lesson".to_owned(), |number| format!("Lesson {number}"))
}

/// A sentence about a prediction and its outcome, as far as they are known.
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

/// The sentence that a task is not done, with the first unmet condition if a few words can say it.
pub fn not_yet(lack: &Lack) -> String {
    let why = lack.asked.field().and_then(name_and_unit_of).and_then(|(name, unit)| {
        let (found, fault) = match (&lack.found, &lack.asked) {
            (Value::Word(word), Condition::Is(_, wanted)) => (word.clone(), format!("not {wanted}")),
            (Value::Number(number), condition) => {
                let (scaled, unit) = match unit {
                    "m" | "m/s" => (1e3 * number, format!("m{unit}")),
                    _ => (*number, unit.to_owned()),
                };
                let fault = match condition {
                    Condition::AtLeast(..) | Condition::Above(..) => "too small".to_owned(),
                    Condition::AtMost(..) | Condition::Below(..) => "too large".to_owned(),
                    Condition::Between(_, low, _) if number < low => "too small".to_owned(),
                    Condition::Between(..) => "too large".to_owned(),
                    Condition::Is(_, wanted) => format!("not {wanted}"),
                    _ => return None,
                };
                let text = if scaled.fract() == 0.0 { scaled.to_string() } else { three(scaled) };
                (format!("{text} {unit}").trim_end().to_owned(), fault)
            }
            (Value::Missing, Condition::Present(_)) => return Some(format!("Not yet ({name}: none).")),
            _ => return None,
        };
        Some(format!("Not yet ({name}: {found}, {fault})."))
    });
    why.unwrap_or_else(|| "Not yet.".to_owned())
}

fn name_and_unit_of(field: &str) -> Option<(String, &'static str)> {
    let (subject, name) = field.split_once('.')?;
    let (before, after) = match subject {
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
    let (words, unit) = label_and_unit(name);
    Some((format!("{before}{}{after}", words.replace("rms", "RMS")), unit))
}

/// A part of a text, and whether it is bold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Piece<'a> {
    pub text: &'a str,
    pub bold: bool,
}

/// The pieces of a text with **bold** words. A mark without a partner is dropped.
pub fn pieces(text: &str) -> Vec<Piece<'_>> {
    let parts: Vec<&str> = text.split("**").collect();
    let last = parts.len() - 1;
    let bold = |index: usize| index % 2 == 1 && index < last;
    let all = parts.iter().enumerate().map(|(index, text)| Piece { text, bold: bold(index) });
    all.filter(|piece| !piece.text.is_empty()).collect()
}

pub fn plain(text: &str) -> String {
    text.replace("**", "")
}

/// The bold words of a text, in lower case. Those that name something on the screen are outlined there.
pub fn bold_words(text: &str) -> impl Iterator<Item = String> {
    pieces(text).into_iter().filter(|piece| piece.bold).map(|piece| piece.text.trim().to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bold_words_are_separated_from_the_others() {
        let piece = |text, bold| Piece { text, bold };
        assert_eq!(pieces("a **b** c"), [piece("a ", false), piece("b", true), piece(" c", false)]);
        assert_eq!(pieces("**b**"), [piece("b", true)]);
        assert_eq!(pieces("a **b"), [piece("a ", false), piece("b", false)]);
        assert_eq!(pieces(""), []);
        let words: Vec<String> = bold_words("The **Force curve** at **stops**").collect();
        assert_eq!(words, ["force curve", "stops"]);
        assert_eq!(numbered("03-a-stop"), "Lesson 3");
    }

    #[test]
    fn a_prediction_is_compared_with_its_outcome() {
        assert_eq!(expected(Some("a"), Some("a")), "You expected: “a”. So it did.");
        assert_eq!(expected(Some("a"), Some("b")), "You expected: “a”. It did: “b”.");
        assert_eq!(expected(None, Some("b")), "It did: “b”.");
    }

    #[test]
    fn a_task_that_is_not_done_says_what_it_lacks() {
        let field = |name: &str| name.to_owned();
        let text = |asked: Condition, found: Value| not_yet(&Lack { asked, found });
        let word = Value::Word("rest".to_owned());
        let regime = Condition::Is(field("result.regime"), "interwell".to_owned());
        assert_eq!(text(regime, word), "Not yet (regime: rest, not interwell).");
        let shaking = Condition::AtMost(field("scene.excitation.amplitude_g"), 1.25);
        assert_eq!(text(shaking, Value::Number(1.3)), "Not yet (amplitude: 1.30 g, too large).");
        let speed = Condition::AtLeast(field("result.rms_velocity_m_per_s"), 0.05);
        assert_eq!(text(speed, Value::Number(0.0421)), "Not yet (RMS velocity: 42.1 mm/s, too small).");
        let count = Condition::Is(field("result.crossings"), "3".to_owned());
        assert_eq!(text(count, Value::Number(1.0)), "Not yet (crossings: 1, not 3).");
        assert_eq!(text(Condition::Present(field("scene.stops")), Value::Missing), "Not yet (stops: none).");
        let gap = Condition::Above(field("walk.gap"), 0.1);
        assert_eq!(text(gap, Value::Missing), "Not yet.");
        assert_eq!(text(Condition::Any(Vec::new()), Value::Missing), "Not yet.");
    }
}
