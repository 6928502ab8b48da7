//! Validation of a lesson.

use super::condition::Condition;
use super::document::Stage;
use super::{LESSON_FORMAT, Lesson, MAX_OPTION_LENGTH, MAX_REPLY_LENGTH, MAX_STEP_LENGTH, Step};
use crate::numeric::number_text;
use crate::scene::axis::Axis;
use crate::scene::check::check;
use crate::scene::data::{Excitation, Scene};
use crate::scene::error::Fault;
use crate::scene::field_table::row;
use crate::scene::fields::{all_fields, numeric_fields};
use crate::scene::names::nearest;

/// A field of a summary that a lesson may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResultField {
    /// Its name, which includes the unit.
    pub name: &'static str,
    /// The possible values of a word; empty for a number.
    pub words: &'static [&'static str],
}

/// Largest number of starts of a condition.
const MAX_STARTS: usize = 1000;
/// Largest number of seeds.
const MAX_SEEDS: u32 = 1000;
/// Largest number of characters of a title.
const MAX_TITLE_LENGTH: usize = 60;
/// Largest number of minutes of a lesson.
const MAX_MINUTES: u32 = 90;

pub(super) const WALK_FIELDS: [&str; 3] = ["walk.up_crosses_from", "walk.down_crosses_to", "walk.gap"];

struct Known {
    name: String,
    kind: Kind,
}

enum Kind {
    Number,
    Text,
    OneOf(&'static [&'static str]),
}

/// All faults of a lesson except those of its scenes.
pub(super) fn faults(lesson: &Lesson, stages: &[Stage], results: &[ResultField]) -> Vec<Fault> {
    let mut found = Found(Vec::new());
    if lesson.format != LESSON_FORMAT {
        found.add("format", lesson.format.to_string(), format!("this program reads format {LESSON_FORMAT}"));
    }
    found.check_length("title", &lesson.title, MAX_TITLE_LENGTH);
    found.check_length("goal", &lesson.goal, MAX_STEP_LENGTH);
    if !(1..=MAX_MINUTES).contains(&lesson.minutes) {
        found.add("minutes", lesson.minutes.to_string(), format!("must be 1 to {MAX_MINUTES}"));
    }
    if let Some(speed) = lesson.speed
        && let range = row("app.speed").range
        && !range.contains(speed)
    {
        found.add("speed", number_text(speed), format!("must be {range}; 0.1 is a tenth of real time"));
    }
    if lesson.views.is_empty() {
        found.add("views", "", "must name a view, such as Well");
    }
    if lesson.steps.is_empty() {
        found.add("steps", "", "must have a step, such as Say(\"..\")");
    }
    let scenes: Vec<&Scene> =
        stages.iter().flat_map(|stage| [&stage.begin, &stage.end]).map(|document| &document.scene).collect();
    if scenes.is_empty() {
        return found.0;
    }
    settings(lesson, &scenes, &mut found);
    let known = known(lesson, &scenes, results);
    for (index, (step, stage)) in lesson.steps.iter().zip(stages).enumerate() {
        let at = |part: &str| format!("steps.{index}{part}");
        found.check_length(&at(""), step.text(), MAX_STEP_LENGTH);
        match step {
            Step::Say(_) | Step::Explain(_) => {}
            Step::Predict { options, .. } => {
                if options.len() < 2 {
                    found.add(&at(".options"), format!("a list of {}", options.len()), "give at least two");
                }
                for (number, option) in options.iter().enumerate() {
                    let at = |part: &str| format!("steps.{index}.options.{number}.{part}");
                    found.check_length(&at("text"), &option.text, MAX_OPTION_LENGTH);
                    if let Some(reply) = &option.reply {
                        found.check_length(&at("reply"), reply, MAX_REPLY_LENGTH);
                    }
                    condition(&option.holds, &at("holds"), &known, &stage.end.scene, false, &mut found);
                }
            }
            Step::Do { goal, hint, .. } => {
                if let Some(hint) = hint {
                    found.check_length(&at(".hint"), hint, MAX_STEP_LENGTH);
                }
                condition(goal, &at(".goal"), &known, &stage.end.scene, false, &mut found);
            }
        }
    }
    found.0
}

/// Checks controls, seeds and walk.
fn settings(lesson: &Lesson, scenes: &[&Scene], found: &mut Found) {
    let numbers = union(scenes, numeric_fields);
    for (index, control) in lesson.controls.iter().enumerate() {
        if control != "stops" && !numbers.contains(control) {
            let problem = format!("no number of its scenes{}", suggested(control, numbers.iter()));
            found.add(&format!("controls.{index}"), control, problem);
        }
    }
    if let Some(seeds) = lesson.seeds {
        if !(2..=MAX_SEEDS).contains(&seeds) {
            found.add("seeds", seeds.to_string(), format!("must be 2 to {MAX_SEEDS}"));
        } else if !scenes.iter().all(|scene| matches!(scene.excitation, Excitation::Noise { .. })) {
            found.add("seeds", seeds.to_string(), "its scenes have no seed; take a Noise, or leave it out");
        }
    }
    if let Some(axis) = &lesson.walk {
        for scene in scenes {
            if let Err((part, problem)) = Axis::from_scene(axis, scene) {
                found.add(&format!("walk.{part}"), "", problem);
                break;
            }
        }
    }
}

fn known(lesson: &Lesson, scenes: &[&Scene], results: &[ResultField]) -> Vec<Known> {
    let numbers = union(scenes, numeric_fields);
    let mut known: Vec<Known> = union(scenes, all_fields)
        .into_iter()
        .map(|path| Known {
            kind: if numbers.contains(&path) { Kind::Number } else { Kind::Text },
            name: format!("scene.{path}"),
        })
        .collect();
    let mut add = |prefix: &str, numbers_only: bool| {
        let wanted = results.iter().filter(|field| !numbers_only || field.words.is_empty());
        known.extend(wanted.map(|field| Known {
            name: format!("{prefix}.{}", field.name),
            kind: if field.words.is_empty() { Kind::Number } else { Kind::OneOf(field.words) },
        }));
    };
    add("result", false);
    add("before", false);
    if lesson.seeds.is_some() {
        add("mean", true);
        add("error", true);
    }
    if lesson.walk.is_some() {
        add("up", false);
        add("down", false);
        known.extend(WALK_FIELDS.map(|name| Known { name: name.to_owned(), kind: Kind::Number }));
    }
    known
}

/// Checks a condition. `inside`: whether it is inside a condition over several starts.
fn condition(checked: &Condition, at: &str, known: &[Known], scene: &Scene, inside: bool, found: &mut Found) {
    let inner = inside || !checked.starts().is_empty();
    checked.parts().iter().for_each(|part| condition(part, at, known, scene, inner, found));
    match checked {
        Condition::All(parts) | Condition::Any(parts) if parts.is_empty() => {
            found.add(at, "", "All and Any need a condition");
        }
        Condition::Every(starts, _) | Condition::ForSome(starts, _) | Condition::Same(_, _, starts) => {
            if !(1..=MAX_STARTS).contains(&starts.len()) {
                let problem = format!("give 1 to {MAX_STARTS} starts");
                found.add(at, format!("a list of {}", starts.len()), problem);
            }
            if inside {
                found.add(at, "", "starts within starts have no meaning");
            }
            for start in starts {
                let scene = Scene { start: *start, ..scene.clone() };
                let fault = check(&scene).faults.into_iter().find(|fault| fault.field.starts_with("start"));
                if let Some(fault) = fault {
                    found.add(at, fault.value, format!("{}: {}", fault.field, fault.problem));
                }
            }
        }
        _ => {}
    }
    let Some(field) = checked.field() else { return };
    let Some(Known { kind, .. }) = known.iter().find(|known| known.name == field) else {
        let needs = match field.split('.').next() {
            Some("mean" | "error") => "; it needs `seeds`",
            Some("up" | "down" | "walk") => "; it needs `walk`",
            _ => "",
        };
        let names = known.iter().map(|known| &known.name);
        found.add(at, field, format!("no such field{}{needs}", suggested(field, names)));
        return;
    };
    let mut bounds = Vec::new();
    checked.clone().for_each_bound(&mut |_, bound| bounds.push(*bound));
    let of_parts = !checked.parts().is_empty();
    match (checked, kind) {
        (Condition::Is(_, text), Kind::Number) if text.trim().parse::<f64>().is_err() => {
            found.add(at, format!("{field} is {text}"), "the field is a number");
        }
        (Condition::Is(_, text), Kind::OneOf(words)) if !words.contains(&text.as_str()) => {
            found.add(at, format!("{field} is {text}"), format!("it is one of {}", words.join(", ")));
        }
        (_, Kind::Text | Kind::OneOf(_)) if !bounds.is_empty() && !of_parts => {
            found.add(at, field, "is no number; compare it by Is, Present or Absent");
        }
        _ => {}
    }
    if bounds.iter().any(|bound| !bound.is_finite()) {
        found.add(at, field, "its bound must be a number");
    }
    match checked {
        Condition::Between(_, low, high) if low > high => {
            found.add(at, format!("{field} from {low} to {high}"), "give the lower bound first");
        }
        Condition::Same(_, within, _) if *within < 0.0 => {
            found.add(at, number_text(*within), "a share that values differ by is 0 or more");
        }
        _ => {}
    }
}

/// The fields of all scenes, each once.
fn union(scenes: &[&Scene], fields: fn(&Scene) -> Vec<String>) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for field in scenes.iter().flat_map(|scene| fields(scene)) {
        if !all.contains(&field) {
            all.push(field);
        }
    }
    all
}

/// The known name that an unknown one may mean, as the end of a sentence.
fn suggested<'a>(unknown: &str, known: impl Iterator<Item = &'a String>) -> String {
    nearest(unknown, known.map(String::as_str))
        .map_or(String::new(), |best| format!("; did you mean {best}?"))
}

struct Found(Vec<Fault>);

impl Found {
    fn add(&mut self, field: &str, value: impl Into<String>, problem: impl Into<String>) {
        self.0.push(Fault::new(field, value, problem));
    }

    /// Adds a fault if a text is missing or too long.
    fn check_length(&mut self, field: &str, text: &str, longest: usize) {
        let length = text.replace("**", "").chars().count();
        if length == 0 {
            self.add(field, "", "must have a text");
        } else if length > longest {
            let problem = format!("is {length} characters long; at most {longest} fit on the screen");
            self.add(field, "", problem);
        }
    }
}
