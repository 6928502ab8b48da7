//! Built-in lessons: each passes its own check without a warning, every number in their texts is measured
//! anew, and a spoiled lesson is caught.

mod numbers;

use std::sync::atomic::AtomicBool;

use interwell::scene::lesson::{LESSONS, LessonDocument, LessonError, Step, TEMPLATE};
use interwell_studies::study::{LessonReport, Task, check_lesson, result_fields};

fn read(text: &str) -> Result<LessonDocument, LessonError> {
    LessonDocument::from_text("own.ron", text, None, &result_fields())
}

fn built_in(number: usize) -> &'static str {
    LESSONS[number - 1].text
}

fn checked(text: &str) -> LessonReport {
    let document = read(text).unwrap_or_else(|error| panic!("{error}"));
    check_lesson(&document, None, &Task { tick: &|| (), cancel: &AtomicBool::new(false) }).unwrap()
}

/// Asserts that a lesson has predictions and tasks, and neither a fault nor a warning.
#[track_caller]
fn passes(name: &str, text: &str) {
    let report = checked(text);
    assert!(report.predictions >= 1 && report.tasks >= 1, "{name}");
    assert!(report.wrong.is_empty() && report.warnings.is_empty(), "{name}: {report:?}");
}

#[test]
fn lessons_1_to_6_and_the_template_pass_their_check_without_a_warning() {
    passes("template", TEMPLATE);
    LESSONS.iter().take(6).for_each(|lesson| passes(lesson.name, lesson.text));
}

#[test]
fn lessons_7_to_10_pass_their_check_without_a_warning() {
    assert_eq!(LESSONS.len(), 10);
    LESSONS.iter().skip(6).for_each(|lesson| passes(lesson.name, lesson.text));
}

#[test]
fn lessons_are_numbered_in_their_order_and_each_has_all_that_a_class_needs() {
    for (number, entry) in (1..).zip(LESSONS) {
        assert!(entry.name.starts_with(&format!("{number:02}-")), "{}", entry.name);
        let lesson = read(entry.text).unwrap().lesson;
        assert!((1..=3).contains(&lesson.controls.len()), "{}", entry.name);
        assert!((2..=4).contains(&lesson.views.len()), "{}", entry.name);
        assert!(matches!(lesson.steps[0], Step::Say(_)), "{}", entry.name);
        assert!(matches!(lesson.steps.last(), Some(Step::Explain(_))), "{}", entry.name);
        let hints = lesson.steps.iter().all(|step| !matches!(step, Step::Do { hint: None, .. }));
        assert!(hints && lesson.lecturer.starts_with("0:00 "), "{}", entry.name);
        let before_each_prediction = lesson.steps.windows(2).all(|pair| match pair {
            [Step::Predict { .. }, next] => matches!(next, Step::Explain(_)),
            _ => true,
        });
        assert!(before_each_prediction, "{}", entry.name);
    }
}

/// The text with one passage changed.
#[track_caller]
fn spoiled(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

/// The places of what is wrong with a lesson that can be read.
fn wrong(text: &str) -> Vec<String> {
    checked(text).wrong.into_iter().map(|finding| format!("{}: {}", finding.field, finding.problem)).collect()
}

#[test]
fn a_spoiled_lesson_is_caught_with_its_place() {
    // a bound turned round: the task of lesson 5 is then done before it is begun
    let bound = spoiled(
        built_in(5),
        "AtLeast(\"result.rms_velocity_m_per_s\", 0.057)",
        "AtMost(\"result.rms_velocity_m_per_s\", 0.057)",
    );
    assert_eq!(
        wrong(&bound),
        ["steps.3.goal: is met before anything is done", "steps.3.solution: does not meet the goal"]
    );
    // a regime exchanged: two options of lesson 3 are then true
    let regime =
        built_in(3).replacen("Is(\"result.regime\", \"interwell\")", "Is(\"result.regime\", \"rest\")", 1);
    let both = "crosses the hill in every period; does not move at all";
    assert_eq!(wrong(&regime), [format!("steps.1.options: these options hold, and only one may: {both}")]);
    // other stops in the prediction of lesson 3: the task is then done before it is begun
    let option = spoiled(built_in(3), "Rigid(travel_limit_mm: 4.0", "Rigid(travel_limit_mm: 2.1");
    let found = wrong(&option);
    assert_eq!(found, ["steps.3.goal: is met before anything is done"]);
    // an option that no longer holds
    let none = spoiled(built_in(2), "Above(\"result.travel_m\", 0.015)", "Above(\"result.travel_m\", 0.025)");
    assert_eq!(wrong(&none), ["steps.2.options: none of the options holds; exactly one must"]);
    // a solution that fails
    let solution = spoiled(
        built_in(4),
        "solution: [(\"excitation.amplitude_g\", \"0.93\")]",
        "solution: [(\"excitation.amplitude_g\", \"0.92\")]",
    );
    assert_eq!(wrong(&solution), ["steps.4.solution: does not meet the goal"]);
    // a field misspelt
    let misspelt = spoiled(built_in(6), "result.impact_share", "result.impacts_share");
    let error = read(&misspelt).map(|document| document.lesson).unwrap_err().to_string();
    let line = 1 + misspelt.lines().position(|line| line.contains("goal: All")).unwrap();
    assert!(error.starts_with(&format!("own.ron:{line}:")), "{error}");
    assert!(error.contains("steps.5.goal = result.impacts_share: no such field"), "{error}");
    assert!(error.contains("did you mean result.impact_share?"), "{error}");
    // a bound on the edge of what the motion does
    let near = spoiled(
        built_in(8),
        "AtLeast(\"result.rms_velocity_m_per_s\", 0.056)",
        "AtLeast(\"result.rms_velocity_m_per_s\", 0.0588)",
    );
    let report = checked(&near);
    assert!(report.wrong.is_empty());
    let warned: Vec<_> = report.warnings.iter().map(|finding| finding.field.as_str()).collect();
    assert_eq!(warned, ["steps.4.goal"]);
}
