//! Lessons as files: what is refused and where, which scene a step has, when a condition holds, and what the
//! check of a lesson finds.

use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Model, Request, Summary};
use interwell::scene::Document;
use interwell::scene::lesson::{LessonDocument, LessonError};
use interwell_studies::study::{
    LessonReport, Subject, SummaryField, Task, Values, check_lesson, goal_lack, result_fields,
};
use predicates::str::contains;

use super::cli::{column, headless, refused, stdout};
use super::support::*;

/// A lesson on a free mass between perfect stops, with these steps and other fields.
fn text(steps: &str, more: &str) -> String {
    format!(
        "(\n    format: 1,\n    title: \"A box\",\n    goal: \"Nothing is lost.\",\n    minutes: 5,\n    \
         scene: \"elastic-box\",\n    views: [Displacement],\n    {more}\n    steps: [\n        {steps}\n    \
         ],\n    misconception: \"It stops.\",\n    lecturer: \"Wait.\",\n)\n"
    )
}

fn read(text: &str) -> Result<LessonDocument, LessonError> {
    LessonDocument::from_text("box.ron", text, None, &result_fields())
}

/// Whether the goal of the first step is met by its own start.
fn met(text: &str) -> bool {
    let document = read(text).unwrap_or_else(|error| panic!("{error}"));
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let scene = document.begin(0);
    let subject = Subject::new(&scene.scene, &scene.files, &document.lesson, &task);
    goal_lack(&document.lesson.steps[0], &subject, &subject).unwrap().is_none()
}

fn holds(condition: &str, more: &str) -> bool {
    met(&text(&format!("Do(ask: \"Do it.\", goal: {condition}, solution: []),"), more))
}

fn checked(text: &str) -> LessonReport {
    let document = read(text).unwrap_or_else(|error| panic!("{error}"));
    check_lesson(&document, None, &Task { tick: &|| (), cancel: &AtomicBool::new(false) }).unwrap()
}

#[test]
fn a_fault_is_named_with_its_line_and_remedy() {
    let say = "Say(\"Look.\"),";
    let goal = |goal: &str| format!("Do(ask: \"Do it.\", goal: {goal}, solution: []),");
    let long = format!("Say(\"{}\"),", "x".repeat(241));
    for (text, fault) in [
        (String::new(), "box.ron:1:1: the file is empty"),
        (text(say, "title_: 1,"), "unknown field `title_`"),
        (
            text(say, "set: [(\"mass\", \"1\")],"),
            "box.ron:8:11: set.0 = mass=1: the scene has no field `mass`",
        ),
        (text(say, "set: [(\"mass_g\", \"-1\")],"), "mass_g = -1: must be 1e-15 to 1e15"),
        (text(say, "controls: [\"stops.travel_limit\"],"), "did you mean stops.travel_limit_mm?"),
        (text(say, "speed: 0,"), "box.ron:8:5: speed = 0: must be 1e-15 to 1000"),
        (text(say, "seeds: 20,"), "seeds = 20: its scenes have no seed"),
        (text(say, "walk: (field: \"mass_g\", from: 2, to: 1, step: 0.1),"), "box.ron:8:"),
        (text("", ""), "box.ron:9:5: steps: must have a step"),
        (text(&long, ""), "box.ron:10:9: steps.0: is 241 characters long; at most 240"),
        (text("Say(\"\"),", ""), "steps.0: must have a text"),
        (text("Predict(ask: \"So?\", options: []),", ""), "options = a list of 0: give at least two"),
        (text(&goal("Is(\"result.regime\", \"interwel\")"), ""), "it is one of rest, intrawell, interwell"),
        (text(&goal("Is(\"result.impacts\", \"many\")"), ""), "the field is a number"),
        (text(&goal("AtLeast(\"result.impact\", 3)"), ""), "did you mean result.impacts?"),
        (text(&goal("AtLeast(\"result.outcome\", 3)"), ""), "result.outcome: is no number"),
        (text(&goal("AtLeast(\"up.impacts\", 3)"), ""), "it needs `walk`"),
        (text(&goal("AtLeast(\"mean.impacts\", 3)"), ""), "it needs `seeds`"),
        (text(&goal("Between(\"result.impacts\", 3, 1)"), ""), "give the lower bound first"),
        (text(&goal("AtMost(\"result.impacts\", inf)"), ""), "its bound must be a number"),
        (text(&goal("All([])"), ""), "All and Any need a condition"),
        (text(&goal("Some([], Present(\"result.impacts\"))"), ""), "give 1 to 1000 starts"),
        (text(&goal("Same(\"result.impacts\", 0, [At(x_mm: 1e99, v_m_per_s: 0)])"), ""), "start.x_mm"),
        (
            text(&goal("Every([Rest], Every([Rest], Present(\"result.impacts\")))"), ""),
            "starts within starts",
        ),
    ] {
        let error = read(&text).map(|document| document.lesson).unwrap_err().to_string();
        assert!(error.contains(fault), "`{fault}` is not in: {error}");
        assert!(error.lines().all(|line| line.starts_with("box.ron:")), "{error}");
    }
}

#[test]
fn all_faults_are_said_at_once_in_the_order_of_the_file() {
    let wrong = text(
        "Predict(ask: \"So?\", options: [\n            \
         (text: \"a\", holds: AtMost(\"result.rms\", 0)),\n            \
         (text: \"b\", holds: Is(\"result.side\", \"up\")),\n        ]),",
        "minutes_: 3, set: [(\"mass_g\", \"heavy\")],",
    );
    let error = read(&wrong).map(|document| document.lesson).unwrap_err().to_string();
    let lines: Vec<usize> = error
        .lines()
        .map(|line| line.trim_start_matches("box.ron:").split(':').next().unwrap().parse().unwrap())
        .collect();
    assert_eq!(lines, [8, 8, 11, 12], "{error}");
}

#[test]
fn a_step_begins_with_the_changes_before_it_and_without_the_solutions() {
    let lesson = read(&text(
        "Say(\"Look.\"),
        Predict(ask: \"So?\", set: [(\"mass_g\", \"2\")], options: [
            (text: \"a\", holds: Present(\"result.impacts\")),
            (text: \"b\", holds: Absent(\"result.impacts\")),
        ]),
        Do(ask: \"Do.\", goal: AtMost(\"scene.mass_g\", 3.5), set: [(\"run.duration_s\", \"4\")],
            solution: [(\"mass_g\", \"3\")]),
        Explain(\"So it is.\"),",
        "set: [(\"mass_g\", \"1\")],",
    ))
    .unwrap();
    let scenes = |of: &dyn Fn(usize) -> (f64, f64)| (0..4).map(of).collect::<Vec<_>>();
    let numbers = |document: &Document| (document.scene.mass_g, document.scene.run.duration_s);
    assert_eq!(scenes(&|i| numbers(lesson.begin(i))), [(1.0, 10.0), (1.0, 10.0), (2.0, 4.0), (2.0, 4.0)]);
    assert_eq!(scenes(&|i| numbers(lesson.end(i))), [(1.0, 10.0), (2.0, 10.0), (3.0, 4.0), (2.0, 4.0)]);
    assert_eq!(lesson.begin(9).scene, lesson.begin(3).scene);
}

#[test]
fn a_lesson_takes_arithmetic() {
    let steps =
        |bound: &str| format!("Do(ask: \"Do.\", goal: Between(\"scene.mass_g\", 1, {bound}), solution: []),");
    let more = "speed: 1/(2*5), set: [(\"mass_g\", \"9/4\")],";
    let lesson = read(&text(&steps("sqrt(2)*3"), more)).unwrap();
    assert_eq!((lesson.lesson.speed, lesson.begin(0).scene.mass_g), (Some(0.1), 2.25));
    assert!(met(&text(&steps("sqrt(2)*3"), more)) && !met(&text(&steps("1 + 1"), more)));
    let error = read(&text(&steps("2*mass"), more)).unwrap_err().to_string();
    assert!(error.starts_with("box.ron:10:59: ") && error.contains("`2*mass`: `mass` is unknown"), "{error}");
}

#[test]
fn each_condition_holds_where_it_should() {
    // between its walls the mass has 25 impacts in 10 s and ends where it began: 0.5 m of way from x = 0
    for (condition, expected) in [
        ("Is(\"result.impacts\", \"25\")", true),
        ("Is(\"result.impacts\", \"24\")", false),
        ("Is(\"result.outcome\", \"done\")", true),
        ("Is(\"scene.stops\", \"Rigid\")", true),
        ("Is(\"scene.title\", \"Elastic box\")", true),
        ("Is(\"scene.mechanism\", \"Cubic\")", false),
        ("AtLeast(\"result.impacts\", 25)", true),
        ("AtLeast(\"result.impacts\", 25.5)", false),
        ("AtMost(\"result.impacts\", 25)", true),
        ("AtMost(\"result.impacts\", 24.5)", false),
        ("Above(\"result.impacts\", 25)", false),
        ("Below(\"result.impacts\", 25)", false),
        ("Below(\"result.impacts\", 25.5)", true),
        ("Between(\"result.rms_velocity_m_per_s\", 0.0499, 0.0501)", true),
        ("Between(\"scene.stops.travel_limit_mm\", 10, 11)", true),
        ("Present(\"result.max_abs_x_m\")", true),
        ("Present(\"scene.excitation\")", false),
        ("Absent(\"scene.excitation\")", true),
        ("Absent(\"scene.run.settle_s\")", false),
        // what is missing is neither small nor large
        ("Absent(\"result.period\")", true),
        ("AtMost(\"result.period\", 1e9)", false),
        ("AtLeast(\"result.period\", -1e9)", false),
        ("Is(\"result.period_multiple\", \"0\")", true),
        ("Not(AtMost(\"result.period\", 1e9))", true),
        ("All([Present(\"result.impacts\"), Absent(\"result.impacts\")])", false),
        ("Any([Present(\"result.impacts\"), Absent(\"result.impacts\")])", true),
        ("Is(\"before.impacts\", \"25\")", true),
        // at 0.05 m/s there are 25 impacts, at 0.1 m/s 50, and none of a mass at rest
        ("Every([SLOW, FAST], Above(\"result.impacts\", 24))", true),
        ("Every([SLOW, STILL], Above(\"result.impacts\", 24))", false),
        ("Some([SLOW, STILL], Above(\"result.impacts\", 24))", true),
        ("Some([STILL], Above(\"result.impacts\", 24))", false),
        ("Same(\"result.impacts\", 0, [SLOW, BACK])", true),
        ("Same(\"result.impacts\", 0.49, [SLOW, FAST])", false),
        ("Same(\"result.impacts\", 0.51, [SLOW, FAST])", true),
    ] {
        let speeds = [("SLOW", 0.05), ("FAST", 0.1), ("BACK", -0.05), ("STILL", 0.0)];
        let written = speeds.iter().fold(condition.to_owned(), |text, (word, v)| {
            text.replace(word, &format!("At(x_mm: 0, v_m_per_s: {v})"))
        });
        assert_eq!(holds(&written, ""), expected, "{condition}");
    }
}

/// A field of a summary.
fn number(summary: &Summary, name: &str) -> f64 {
    match SummaryField::find(name).unwrap().column([Some(summary)].into_iter()) {
        Values::Numbers(values) => values[0],
        Values::Counts(values) => values[0].unwrap() as f64,
        Values::Words(_) | Values::Names(_) => panic!("{name} is a word"),
    }
}

#[test]
fn means_over_seeds_and_their_errors_are_those_of_the_runs() {
    let changes = ["run.duration_s=5", "excitation.rms_g=0.6"];
    let of_seed = |seed: u32| {
        let seed = format!("excitation.seed={seed}");
        let model: Model = preset("random-shaking", &[changes[0], changes[1], &seed]);
        number(&model.run(&Request::default()).summary, "rms_velocity_m_per_s")
    };
    let values: Vec<f64> = (1..=4).map(of_seed).collect();
    let mean = values.iter().sum::<f64>() / 4.0;
    let error = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 3.0 / 4.0).sqrt();
    assert!(error > 0.0);
    let more = "seeds: 4, set: [(\"run.duration_s\", \"5\"), (\"excitation.rms_g\", \"0.6\")],";
    for (of, value) in [("mean", mean), ("error", error)] {
        let (low, high) = (value * (1.0 - 1e-12), value * (1.0 + 1e-12));
        let goal = format!("Between(\"{of}.rms_velocity_m_per_s\", {low:e}, {high:e})");
        let text = text(&format!("Do(ask: \"Do.\", goal: {goal}, solution: []),"), more);
        assert!(met(&text.replace("elastic-box", "random-shaking")), "{of}: {value}");
    }
}

#[test]
fn a_walk_is_that_of_the_sweep_that_carries_its_state() {
    let csv = stdout(
        "sweep duffing --over excitation.amplitude_g=0.1:0.2:0.01 --set stops=None --carry both --columns \
         rms_velocity_m_per_s,crossings --quiet",
    );
    let row = |direction: &str, amplitude: &str| {
        let fields = [column(&csv, "direction"), column(&csv, "amplitude_g")];
        let place = (0..fields[0].len()).find(|i| fields[0][*i] == direction && fields[1][*i] == amplitude);
        column(&csv, "rms_velocity_m_per_s")[place.unwrap()].clone()
    };
    let more = "walk: (field: \"excitation.amplitude_g\", from: 0.1, to: 0.2, step: 0.01), \
                set: [(\"excitation.amplitude_g\", \"0.15\")],";
    let goal = format!(
        "All([Is(\"up.rms_velocity_m_per_s\", \"{}\"), Is(\"down.rms_velocity_m_per_s\", \"{}\")])",
        row("up", "0.15"),
        row("down", "0.15")
    );
    let text = text(&format!("Do(ask: \"Do.\", goal: {goal}, solution: []),"), more);
    assert!(met(&text.replace("elastic-box", "duffing")), "{goal}\n{csv}");
}

#[test]
fn the_turns_of_a_walk_are_where_it_begins_and_ends_to_cross() {
    // a mass pressed on a stop forgets: up and down cross at the same amplitudes
    let more = "walk: (field: \"excitation.amplitude_g\", from: 0.1, to: 1.1, step: 0.1),";
    let csv = stdout(
        "sweep nominal-cubic --set stops.travel_limit_mm=1.5 --over \
                      excitation.amplitude_g=0.1:1.1:0.1 --columns crossings --quiet",
    );
    let crossing: Vec<usize> = (0..11).filter(|i| column(&csv, "crossings")[*i] != "0").collect();
    let least = column(&csv, "amplitude_g")[crossing[0]].clone();
    assert!(crossing[0] > 0 && crossing.len() + crossing[0] == 11, "{csv}");
    for (goal, expected) in [
        (format!("Is(\"walk.up_crosses_from\", \"{least}\")"), true),
        (format!("Is(\"walk.down_crosses_to\", \"{least}\")"), true),
        ("Is(\"walk.gap\", \"0\")".to_owned(), true),
        ("Above(\"walk.gap\", 0)".to_owned(), false),
    ] {
        let text = text(
            &format!("Do(ask: \"Do.\", goal: {goal}, solution: []),"),
            &format!("{more} set: [(\"stops.travel_limit_mm\", \"1.5\")],"),
        );
        assert_eq!(met(&text.replace("elastic-box", "nominal-cubic")), expected, "{goal}");
    }
}

#[test]
fn the_check_finds_what_a_lesson_must_not_have() {
    let find = |steps: &str, more: &str| {
        let report = checked(&text(steps, more));
        let said = |findings: &[interwell_studies::study::LessonFinding]| {
            findings
                .iter()
                .map(|finding| format!("{}: {}", finding.field, finding.problem))
                .collect::<Vec<_>>()
        };
        (said(&report.wrong), said(&report.warnings))
    };
    let goal = |bound: f64, solution: &str| {
        format!("Do(ask: \"Do.\", goal: AtLeast(\"result.impacts\", {bound}), solution: [{solution}]),")
    };
    let faster = "(\"start.v_m_per_s\", \"0.1\")";
    assert_eq!(find(&goal(40.0, faster), ""), (vec![], vec![]));
    let (wrong, _) = find(&goal(20.0, faster), "");
    assert_eq!(wrong, ["steps.0.goal: is met before anything is done"]);
    let (wrong, _) = find(&goal(60.0, faster), "");
    assert_eq!(wrong, ["steps.0.solution: does not meet the goal"]);
    let (wrong, warnings) = find(&goal(50.0, faster), "");
    assert!(wrong.is_empty());
    assert_eq!(
        warnings,
        ["steps.0.goal: a bound of 50.5 on result.impacts in place of 50 turns the verdict"]
    );
    let options = |a: &str, b: &str| {
        format!("Predict(ask: \"So?\", options: [(text: \"a\", holds: {a}), (text: \"b\", holds: {b})]),")
    };
    let (many, few) = ("Above(\"result.impacts\", 20)", "Below(\"result.impacts\", 20)");
    assert_eq!(find(&options(many, few), ""), (vec![], vec![]));
    assert_eq!(
        find(&options(few, few), "").0,
        ["steps.0.options: none of the options holds; exactly one must"]
    );
    let both = "steps.0.options: these options hold, and only one may: a; b";
    assert_eq!(find(&options(many, many), "").0, [both]);
    // a setting that no control changes is exact; one that a control changes may sit on an edge
    let limited = format!(
        "Do(ask: \"Do.\", goal: All([AtLeast(\"result.impacts\", 40), \
         AtMost(\"scene.stops.travel_limit_mm\", 10)]), solution: [{faster}]),"
    );
    assert_eq!(find(&limited, ""), (vec![], vec![]));
    let (_, warnings) = find(&limited, "controls: [\"stops.travel_limit_mm\"],");
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].contains("a bound of 9.9 on scene.stops.travel_limit_mm"), "{warnings:?}");
}

#[test]
fn a_check_can_be_cancelled() {
    let document =
        read(&text("Do(ask: \"Do.\", goal: Present(\"result.impacts\"), solution: []),", "")).unwrap();
    let cancel = AtomicBool::new(true);
    let error = check_lesson(&document, None, &Task { tick: &|| (), cancel: &cancel }).unwrap_err();
    assert_eq!(error.to_string(), "cancelled");
}

#[test]
fn the_command_lists_prints_checks_and_begins_lessons() {
    let list = stdout("lesson");
    assert!(list.lines().all(|line| line.contains(" min  ")), "{list}");
    for name in ["3", "03-a-stop-that-helps", "a-stop-that-helps"] {
        assert!(stdout(&format!("lesson {name}")).starts_with("A stop that helps (5 min)\nGoal: "));
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("own.ron");
    let path = file.display();
    headless(&format!("lesson --new {path}")).assert().success().stdout("");
    let held = format!("{path}: holds (");
    headless(&format!("lesson {path} --check")).assert().success().stdout(contains(held)).stderr("");
    refused(headless(&format!("lesson --new {path}")), &["is there already", "name another"]);
    let spoiled = text("Do(ask: \"Do.\", goal: Above(\"result.impacts\", 20), solution: []),", "");
    let file = folder.path().join("spoiled.ron");
    std::fs::write(&file, spoiled).unwrap();
    let fault = format!("{}:10:24: steps.0.goal: is met before anything is done", file.display());
    let verdict = format!("{}: is wrong (0 predictions, 1 task)\n", file.display());
    headless(&format!("lesson {} --check", file.display()))
        .assert()
        .code(1)
        .stdout(verdict)
        .stderr(format!("error: {fault}\n"));
}
