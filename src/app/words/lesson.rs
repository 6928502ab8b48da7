//! Sentences of a lesson: predictions and their outcomes, the verdict on a task, bold words.

use super::fields::name_and_unit;
use super::numbers::{three, with_minus};
use crate::app::words::capital;
use crate::scene::Start;
use crate::scene::lesson::{Condition, Lesson};
use interwell_studies::study::{Lack, Value, label_and_unit};

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
            format!("You expected: “{choice}”. That holds.")
        }
        (Some(choice), Some(outcome)) => format!("You expected: “{choice}”. What holds: “{outcome}”."),
        (Some(choice), None) => format!("You expected: “{choice}”. Watch what it does."),
        (None, Some(outcome)) => format!("What holds: “{outcome}”."),
        (None, None) => "Watch what it does.".to_owned(),
    }
}

/// The first question in a text.
pub fn question(text: &str) -> Option<String> {
    let text = plain(text);
    let end = text.find('?')? + 1;
    let begin = text[..end - 1].rfind(['.', ':', '!']).map_or(0, |at| at + 1);
    Some(capital(text[begin..end].trim()))
}

pub fn letter(option: usize) -> char {
    ('A'..='Z').nth(option).unwrap_or('?')
}

/// The votes of a class for the options of a prediction.
pub fn tally(votes: &[u32]) -> String {
    let each = votes.iter().enumerate().map(|(option, votes)| format!("{} {votes}", letter(option)));
    format!("Votes: {}", each.collect::<Vec<_>>().join(", "))
}

/// What a lecturer is to do: from which time in s on, that time as written, and the text. A text before the
/// first time has none.
pub fn script(notes: &str) -> Vec<(f64, &str, &str)> {
    let time = |word: &str| {
        let (minutes, seconds) = word.split_once(':')?;
        let are_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
        let is_time = are_digits(minutes) && are_digits(seconds) && seconds.len() == 2;
        is_time.then_some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
    };
    let mut lines = Vec::new();
    let (mut begin, mut from, mut written) = (0, 0.0, "");
    let mut at = 0;
    for word in notes.split_inclusive(' ') {
        if let Some(seconds) = time(word.trim_end()) {
            lines.push((from, written, notes[begin..at].trim()));
            (begin, from, written) = (at + word.len(), seconds, word.trim_end());
        }
        at += word.len();
    }
    lines.push((from, written, notes[begin..].trim()));
    lines.retain(|line| !line.2.is_empty());
    lines
}

/// The numbers of a solution, after a colon; nothing if a field has no number.
pub fn solved(solution: &[(String, String)]) -> String {
    let one = |(path, value): &(String, String)| {
        let (name, unit) = name_and_unit(path);
        value
            .parse::<f64>()
            .ok()
            .map(|_| format!("{name} {} {unit}", with_minus(value)).trim_end().to_owned())
    };
    let all: Option<Vec<String>> = solution.iter().map(one).collect();
    all.map_or_else(String::new, |all| format!(": {}", all.join(", ")))
}

/// On what a task is judged, in a scene with this start, by a goal that names so many starts. The motion that
/// is shown is another one if the scene was changed while it went on.
pub fn judged_by(lesson: &Lesson, start: Start, starts: usize, is_continued: bool) -> String {
    if starts > 1 {
        return format!("Judged on runs from {starts} starts.");
    }
    let from = if start == Start::Rest { "from rest" } else { "from the scene's start" };
    match (&lesson.walk, lesson.seeds) {
        (Some(_), _) => "Judged on runs up and down, each from the end of the one before.".to_owned(),
        (None, Some(seeds)) => format!("Judged on {seeds} full runs {from}, each with another noise."),
        (None, None) if is_continued => format!("Judged on a full run {from}, not on the motion shown."),
        (None, None) => format!("Judged on a full run {from}."),
    }
}

/// The sentence that a task is not done, and why, by the first condition that does not hold. `on_stops` says
/// whether stops hold the mass away from the bottoms of the wells, so that it can hop.
pub fn not_yet(lack: &Lack, on_stops: bool) -> String {
    format!("Not yet: {}.", lacking(&lack.asked, &lack.found, on_stops))
}

fn lacking(asked: &Condition, found: &Value, on_stops: bool) -> String {
    let claim = |part: &Condition| match part {
        Condition::Is(field, word) if field.ends_with(REGIME) => motion(word, on_stops),
        _ => "the condition holds",
    };
    match asked {
        Condition::Any(_) => "none of the conditions holds".to_owned(),
        Condition::Not(part) => match part.as_ref() {
            Condition::Is(field, word) if field.ends_with(REGIME) => still(field, word, on_stops),
            part => match part.field().and_then(name_and_unit_of) {
                Some((name, _)) => format!("the {name} must not be what it is"),
                None => "a condition that must not hold holds".to_owned(),
            },
        },
        Condition::Every(starts, part) => {
            format!("{} from fewer than all {} starts", claim(part), starts.len())
        }
        Condition::ForSome(starts, part) => format!("{} from none of {} starts", claim(part), starts.len()),
        Condition::Same(_, _, starts) => format!("the {} starts lead to different motions", starts.len()),
        _ => lacking_field(asked, found, on_stops),
    }
}

/// Why a condition on one field does not hold.
fn lacking_field(asked: &Condition, found: &Value, on_stops: bool) -> String {
    let field = asked.field().unwrap_or_default();
    if field == "walk.gap" {
        let words = if *found == Value::Missing {
            "it does not cross both ways"
        } else {
            "the two ways still differ"
        };
        return words.to_owned();
    }
    let Some((name, unit)) = name_and_unit_of(field) else {
        return "it differs from what is asked".to_owned();
    };
    match (found, asked) {
        (Value::Word(word), Condition::Is(..)) if field.ends_with(REGIME) => still(field, word, on_stops),
        (Value::Word(word), Condition::Is(_, wanted)) => format!("the {name} is {word}, not {wanted}"),
        (Value::Number(x), Condition::Below(..) | Condition::Above(..)) if field == "result.final_x_m" => {
            format!("it ends on the {}-hand side", if *x > 0.0 { "right" } else { "left" })
        }
        (Value::Number(count), _) if field == "result.crossings" => crossings(*count, asked),
        (Value::Number(number), condition) => {
            let (scaled, unit) = match unit {
                "m" | "m/s" => (1e3 * number, format!("m{unit}")),
                _ if field.ends_with("_share") => (100.0 * number, "%".to_owned()),
                _ => (*number, unit.to_owned()),
            };
            // a share in whole per cent, as in the sentence and the table, unless that equals a bound
            let is_bound = |whole: f64| match condition {
                Condition::AtLeast(_, bound)
                | Condition::AtMost(_, bound)
                | Condition::Above(_, bound)
                | Condition::Below(_, bound) => whole == 100.0 * bound,
                Condition::Between(_, low, high) => whole == 100.0 * low || whole == 100.0 * high,
                _ => false,
            };
            let value = match scaled.round() {
                whole if scaled == whole || unit == "%" && !is_bound(whole) => whole.to_string(),
                _ => three(scaled),
            };
            let value = format!("{value} {unit}");
            let too = match condition {
                Condition::AtLeast(..) | Condition::Above(..) => "too small".to_owned(),
                Condition::AtMost(..) | Condition::Below(..) => "too large".to_owned(),
                Condition::Between(_, low, _) if number < low => "too small".to_owned(),
                Condition::Between(..) => "too large".to_owned(),
                Condition::Is(_, wanted) => format!("and not {wanted}"),
                _ => return format!("there is a {name}, and there must be none"),
            };
            format!("the {name} is {}, {too}", value.trim_end())
        }
        (_, Condition::Absent(_)) => format!("the {name} must be off"),
        (_, Condition::Present(_)) if name.ends_with('s') => format!("there are no {name}"),
        (Value::Missing | Value::Word(_), _) => format!("there is no {name} yet"),
    }
}

const REGIME: &str = ".regime";

fn motion(regime: &str, on_stops: bool) -> &'static str {
    match regime {
        "rest" if on_stops => "it rests on its stop",
        "rest" => "it rests",
        "intrawell" if on_stops => "it hops: it leaves its stop but does not cross",
        "intrawell" => "it moves in one well and does not cross",
        "interwell" => "it crosses in a lasting rhythm",
        "crossing" => "it crosses",
        _ => "it crosses, but in no lasting rhythm",
    }
}

/// The motion that the task does not allow, with the direction of the walk that the field belongs to.
fn still(field: &str, regime: &str, on_stops: bool) -> String {
    let coming = match field.split('.').next() {
        Some("up") => "coming from below, ",
        Some("down") => "coming from above, ",
        _ => "",
    };
    format!("{coming}{}", motion(regime, on_stops).replacen("it ", "it still ", 1))
}

fn crossings(count: f64, asked: &Condition) -> String {
    let times = |count: f64| match count {
        0.0 => "not at all".to_owned(),
        1.0 => "once".to_owned(),
        2.0 => "twice".to_owned(),
        count => format!("{count} times"),
    };
    let wanted = match asked {
        Condition::Is(_, wanted) => wanted.trim().parse().map(times).unwrap_or_default(),
        Condition::AtLeast(_, least) => format!("{} or more", times(*least)),
        Condition::AtMost(_, most) => format!("{} at most", times(*most)),
        _ => return format!("it crosses {}", times(count)),
    };
    match (count, asked) {
        (0.0, Condition::AtLeast(..)) => "it does not cross".to_owned(),
        _ => format!("it crosses {}, not {wanted}", times(count)),
    }
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
    fn notes_are_a_script_with_times() {
        let lines = script("0:00 Ask. Wait 2:3 s. 0:30 Vote, at 10:1. 12:05 End.");
        let expected =
            [(0.0, "0:00", "Ask. Wait 2:3 s."), (30.0, "0:30", "Vote, at 10:1."), (725.0, "12:05", "End.")];
        assert_eq!(lines, expected);
        assert_eq!(script("No times."), [(0.0, "", "No times.")]);
        assert_eq!(tally(&[12, 0, 3]), "Votes: A 12, B 0, C 3");
    }

    #[test]
    fn a_prediction_is_compared_with_its_outcome() {
        assert_eq!(expected(Some("a"), Some("a")), "You expected: “a”. That holds.");
        assert_eq!(expected(Some("a"), Some("b")), "You expected: “a”. What holds: “b”.");
        assert_eq!(expected(None, Some("b")), "What holds: “b”.");
    }

    #[test]
    fn a_task_that_is_not_done_says_what_it_lacks_in_plain_words() {
        let name = |name: &str| name.to_owned();
        let text = |asked: Condition, found: Value| not_yet(&Lack { asked, found }, true);
        let word = |word: &str| Value::Word(word.to_owned());
        let regime = |of: &str, word: &str| Condition::Is(format!("{of}.regime"), word.to_owned());
        let hops = "Not yet: it still hops: it leaves its stop but does not cross.";
        assert_eq!(text(regime("result", "interwell"), word("intrawell")), hops);
        let lack = Lack { asked: regime("result", "interwell"), found: word("intrawell") };
        assert_eq!(not_yet(&lack, false), "Not yet: it still moves in one well and does not cross.");
        let rests = "Not yet: it still rests on its stop.";
        assert_eq!(text(regime("result", "interwell"), word("rest")), rests);
        let crosses = "Not yet: coming from below, it still crosses in a lasting rhythm.";
        assert_eq!(text(regime("up", "intrawell"), word("interwell")), crosses);
        let wild = "Not yet: it still crosses, but in no lasting rhythm.";
        assert_eq!(text(regime("result", "interwell"), word("irregular")), wild);
        let not = Condition::Not(Box::new(regime("result", "intrawell")));
        assert_eq!(text(not, Value::Missing), hops);
        let shaking = Condition::AtMost(name("scene.excitation.amplitude_g"), 1.25);
        assert_eq!(text(shaking, Value::Number(1.3)), "Not yet: the amplitude is 1.30 g, too large.");
        let speed = Condition::AtLeast(name("result.rms_velocity_m_per_s"), 0.05);
        assert_eq!(text(speed, Value::Number(0.0421)), "Not yet: the RMS velocity is 42.1 mm/s, too small.");
        let share = Condition::Below(name("result.impact_share"), 0.8);
        for (found, words) in [(0.93, "93"), (0.928, "93"), (0.803, "80.3")] {
            let text = text(share.clone(), Value::Number(found));
            assert!(text.ends_with(&format!(" is {words} %, too large.")), "{text}");
        }
        let count = |wanted: &str| Condition::Is(name("result.crossings"), wanted.to_owned());
        assert_eq!(text(count("3"), Value::Number(1.0)), "Not yet: it crosses once, not 3 times.");
        let least = Condition::AtLeast(name("result.crossings"), 1.0);
        assert_eq!(text(least, Value::Number(0.0)), "Not yet: it does not cross.");
        let left = Condition::Below(name("result.final_x_m"), -0.001);
        assert_eq!(text(left, Value::Number(0.0072)), "Not yet: it ends on the right-hand side.");
        let stops = Condition::Present(name("scene.stops"));
        assert_eq!(text(stops, Value::Missing), "Not yet: there are no stops.");
        let same = Condition::Same(name("result.rms_velocity_m_per_s"), 1e-6, vec![Start::Rest; 3]);
        assert_eq!(text(same, Value::Missing), "Not yet: the 3 starts lead to different motions.");
        let every = Condition::Every(vec![Start::Rest; 3], Box::new(regime("result", "interwell")));
        let each = "Not yet: it crosses in a lasting rhythm from fewer than all 3 starts.";
        assert_eq!(text(every, Value::Missing), each);
    }

    #[test]
    fn each_condition_of_a_built_in_task_has_such_words() {
        fn parts(condition: &Condition) -> Vec<Condition> {
            match condition {
                Condition::All(all) => all.iter().flat_map(parts).collect(),
                other => vec![other.clone()],
            }
        }
        for lesson in crate::scene::lesson::LESSONS {
            let results = interwell_studies::study::result_fields();
            let read = crate::scene::lesson::LessonDocument::load(lesson.name, &results).unwrap();
            let goals = read.lesson.steps.iter().filter_map(|step| match step {
                crate::scene::lesson::Step::Do { goal, .. } => Some(goal),
                _ => None,
            });
            for asked in goals.flat_map(parts) {
                let is_regime = asked.field().is_some_and(|field| field.ends_with(REGIME));
                let found = if is_regime { Value::Word("rest".to_owned()) } else { Value::Number(0.5) };
                for found in [found, Value::Missing] {
                    let text = not_yet(&Lack { asked: asked.clone(), found }, true);
                    let spare = ["(", "_", "intrawell", "interwell", "differs"];
                    assert!(spare.iter().all(|word| !text.contains(word)), "{}: {text}", lesson.name);
                }
            }
        }
    }
}
