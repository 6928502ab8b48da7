//! Lessons in the window: gone through, covered, judged, kept, left.

use std::path::Path;

use eframe::egui::{Key, OutputCommand};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use interwell::app::session::lesson::{Records, answers_text};
use interwell::app::ui::settings::Settings;
use interwell::app::views::View;
use interwell::app::window::{Command, Wanted, Window};
use interwell::scene::lesson::{LESSONS, Step};

use crate::support::{
    LONG, PROJECTED, WIDE, click_on, command, is_painted, out_of_reach, painted, press, wait_until, window,
};

pub type Shown = Harness<'static, Window>;

pub fn opened(lesson: &str, size: [f32; 2]) -> Shown {
    let mut harness = window("first-look", size);
    harness.state_mut().open_lesson(lesson);
    harness.run_steps(3);
    assert_eq!(harness.state().message(), None);
    harness
}

/// A lesson of which the tests know what it says.
pub const OWN: &str = r#"(
    format: 1,
    title: "A stop that helps",
    goal: "A limit on travel can start travel, in the right place.",
    minutes: 5,
    scene: "first-look",
    set: [("excitation.amplitude_g", "1.0")],
    controls: ["stops", "stops.travel_limit_mm"],
    views: [Well, Mechanism, Displacement],
    speed: 0.1,
    steps: [
        Say("Shaken at 1 g it rattles in one well."),
        Predict(
            ask: "We put stops at ±4 mm and shake as before. The mass ...",
            set: [("stops", "Rigid(travel_limit_mm: 4.0, restitution: 0.36)")],
            options: [
                (text: "crosses every period", holds: Is("result.regime", "interwell")),
                (
                    text: "rattles between home and stop",
                    holds: All([Above("result.rms_velocity_m_per_s", 0.0), AtMost("result.crossings", 0)]),
                ),
                (text: "does not move at all", holds: AtMost("result.rms_velocity_m_per_s", 0.0)),
            ],
        ),
        Do(
            ask: "Now find stops with which it crosses every period.",
            goal: All([
                Is("result.regime", "interwell"),
                Present("scene.stops"),
                AtMost("scene.excitation.amplitude_g", 1.0),
            ]),
            hint: "Where does the force curve lie below 0.149 N, the push of 1 g?",
            solution: [("stops.travel_limit_mm", "1.5")],
        ),
        Explain("A stop inside the home holds the mass up on the hillside."),
    ],
    misconception: "Stops only take motion away; any stop helps.",
    lecturer: "Vote, reveal the dead picture, let a student drag the stop.",
)"#;

/// A window in that lesson, which has no file any more.
pub fn opened_own(size: [f32; 2]) -> Shown {
    let folder = tempfile::tempdir().unwrap();
    opened(&written(folder.path(), OWN), size)
}

pub fn number(harness: &Shown) -> usize {
    harness.state().lesson().unwrap().number()
}

pub fn step(harness: &Shown) -> Step {
    harness.state().lesson().unwrap().step().clone()
}

/// Lets verdicts come and frames pass until a condition holds, which must come.
pub fn until(harness: &mut Shown, what: &str, mut condition: impl FnMut(&Shown) -> bool) {
    wait_until(what, || {
        if let Some(lesson) = harness.state_mut().lesson_mut() {
            lesson.wait(LONG);
        }
        harness.run_steps(1);
        condition(harness)
    });
}

/// Goes on as a lecturer does: reveals what is covered, and leaves the lesson after its last step.
pub fn go_on(harness: &mut Shown) {
    let lesson = harness.state().lesson().unwrap();
    match (lesson.is_covering(), lesson.is_last()) {
        (true, _) => click_on(harness, "Reveal"),
        (false, true) => command(harness, Command::LeaveLesson),
        (false, false) => {
            let presses = if lesson.may_go_on() { 1 } else { 2 };
            (0..presses).for_each(|_| press(harness, Key::PageDown));
        }
    }
}

/// Goes on as a lecturer does until a step is of a kind; false where none is.
pub fn go_to(harness: &mut Shown, is_wanted: fn(&Step) -> bool) -> bool {
    while harness.state().lesson().is_some() {
        if is_wanted(&step(harness)) {
            return true;
        }
        go_on(harness);
    }
    false
}

/// Makes the changes of a solution by what the controls do.
fn solve(harness: &mut Shown) {
    let solution = harness.state().lesson().unwrap().solution().to_vec();
    let controls = harness.state().lesson().unwrap().lesson().controls.clone();
    for (field, value) in solution {
        let part = field.split('.').next().unwrap().to_owned();
        let is_reached =
            controls.iter().any(|control| *control == field || part == "stops" && *control == part);
        assert!(is_reached, "no control of {controls:?} changes {field}");
        let session = &mut harness.state_mut().session;
        match value.parse() {
            Ok(number) => drop(session.set_number(&field, number).unwrap()),
            Err(_) => {
                let mut document = session.editor.runnable().into_owned();
                document.assign(&field, &value, &field).unwrap();
                session.edit(|scene| *scene = document.scene);
            }
        }
        session.end_gesture();
    }
    harness.run_steps(2);
}

/// Whether a text is anywhere: read by a screen reader, or painted.
pub fn is_anywhere(harness: &Shown, text: &str) -> bool {
    harness.query_all_by_label_contains(text).next().is_some() || is_painted(harness, text)
}

pub fn written(folder: &Path, text: &str) -> String {
    let path = folder.join("own.ron");
    std::fs::write(&path, text).unwrap();
    path.to_string_lossy().into_owned()
}

#[test]
fn every_lesson_is_gone_through_from_its_first_step_to_its_last() {
    for entry in LESSONS {
        let mut harness = window("first-look", WIDE);
        harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
        harness.run_steps(2);
        let before = (harness.state().session.scene().clone(), harness.state().tiling.clone());
        harness.state_mut().open_lesson(entry.name);
        harness.run_steps(3);
        let count = harness.state().lesson().unwrap().lesson().steps.len();
        for number in 0..count {
            assert_eq!(self::number(&harness), number);
            harness.get_by_label(&format!("step {} of {count}", number + 1));
            match step(&harness) {
                Step::Say(_) | Step::Explain(_) => {}
                Step::Predict { options, .. } => {
                    assert!(harness.get_by_label("Next").accesskit_node().is_disabled());
                    let first = format!("A   {}", options[0].text.replace("**", ""));
                    harness.get_by_label(&first).click();
                    until(&mut harness, "what it did", |harness| {
                        harness.state().lesson().unwrap().answer().outcome.is_some()
                    });
                    let answer = harness.state().lesson().unwrap().answer().clone();
                    assert_eq!(answer.choice.as_deref(), Some(options[0].text.as_str()));
                    let words =
                        if answer.choice == answer.outcome { "That holds." } else { "What holds: “" };
                    assert!(is_anywhere(&harness, words), "{}", entry.name);
                    assert!(harness.state().session.player.is_playing());
                }
                Step::Do { .. } => {
                    assert!(!harness.state().lesson().unwrap().answer().met);
                    solve(&mut harness);
                    until(&mut harness, entry.name, |harness| harness.state().lesson().unwrap().answer().met);
                    harness.get_by_label("Done.");
                }
            }
            let next = if number + 1 == count { "Finish" } else { "Next" };
            harness.get_by_label(next).click();
            harness.run_steps(3);
        }
        let window = harness.state();
        assert!(window.lesson().is_none() && window.records()[entry.name].done);
        // what was there is there again, with the way back
        assert_eq!((window.session.scene().clone(), window.tiling.clone()), before);
        assert!(harness.state_mut().session.undo());
        assert_eq!(harness.state().session.scene().mass_g, 15.2);
    }
}

#[test]
fn the_last_step_leads_to_the_next_lesson_too() {
    let mut harness = opened(LESSONS[0].name, WIDE);
    while !harness.state().lesson().unwrap().is_last() {
        go_on(&mut harness);
    }
    harness.get_by_label("Lesson 2").click();
    harness.run_steps(3);
    let key = |harness: &Shown| harness.state().lesson().map(|lesson| lesson.key());
    assert_eq!(key(&harness).as_deref(), Some(LESSONS[1].name));
    // the last one leads to none
    let last = LESSONS.len() - 1;
    harness.state_mut().open_lesson(LESSONS[last].name);
    harness.run_steps(3);
    while !harness.state().lesson().unwrap().is_last() {
        go_on(&mut harness);
    }
    assert!(harness.query_by_label("Lesson 11").is_none());
    harness.get_by_label("Finish").click();
    harness.run_steps(3);
    assert!(harness.state().lesson().is_none());
}

#[test]
fn no_text_of_a_lesson_is_cut_and_a_lecturer_goes_through_by_two_keys() {
    for entry in LESSONS {
        let mut harness = opened(entry.name, PROJECTED);
        let mut last = 0;
        while harness.state().lesson().is_some() {
            last = number(&harness);
            assert_eq!(out_of_reach(&mut harness), [""; 0], "{} {last}", entry.name);
            go_on(&mut harness);
        }
        harness.state_mut().open_lesson(entry.name);
        harness.run_steps(3);
        while number(&harness) < last {
            go_on(&mut harness);
        }
        for number in (0..last).rev() {
            press(&mut harness, Key::PageUp);
            assert_eq!(self::number(&harness), number);
        }
    }
}

#[test]
fn a_prediction_covers_every_result() {
    for entry in LESSONS {
        let mut harness = opened(entry.name, WIDE);
        if !go_to(&mut harness, |step| matches!(step, Step::Predict { .. })) {
            continue;
        }
        for view in View::ALL {
            command(&mut harness, Command::Show(view, true));
        }
        harness.state_mut().session.wait_settled(LONG);
        let scene = harness.state().session.scene().clone();
        let keys =
            [Key::Space, Key::Period, Key::R, Key::X, Key::End, Key::G, Key::Home, Key::H, Key::PageDown];
        for key in &keys[..8] {
            press(&mut harness, *key);
            let player = &harness.state().session.player;
            assert!(!player.is_playing() && player.time() == 0.0 && !player.is_held(), "{key:?}");
        }
        let sentence = harness.state().session.sentence();
        assert!(!is_anywhere(&harness, &sentence.text) && !is_anywhere(&harness, &sentence.whole()));
        let kind = sentence.text.split([':', ';']).next().unwrap().to_owned();
        let results = [kind.as_str(), "RMS velocity", "crosses from", "Recompute", "impact", "Path error"];
        // what the question itself says is no result
        let said = format!("{:?}", harness.state().lesson().unwrap().step());
        for text in results.into_iter().filter(|text| !said.contains(text)) {
            let seen: Vec<_> = painted(&harness).into_iter().filter(|label| label.0.contains(text)).collect();
            assert!(!is_anywhere(&harness, text), "{}: {text} {seen:?}", entry.name);
        }
        for asked in [Command::CopyCommand, Command::Choose(Wanted::Run), Command::Choose(Wanted::Events)] {
            command(&mut harness, asked);
            assert_eq!(harness.state().notice(), Some("First choose what you expect"));
            let copied = |command: &OutputCommand| matches!(command, OutputCommand::CopyText(_));
            assert!(!harness.output().platform_output.commands.iter().any(copied));
        }
        assert_eq!(*harness.state().session.scene(), scene);
        // the sentence comes with the choice
        press(&mut harness, Key::B);
        harness.state_mut().session.wait_settled(LONG);
        harness.run_steps(2);
        let text = harness.state().session.sentence().text;
        assert!(is_anywhere(&harness, &text), "{text}");
    }
}

#[test]
fn sweeping_past_the_goal_does_not_meet_it() {
    let mut harness = opened_own(WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Do { .. })));
    let met = |harness: &Shown| harness.state().lesson().unwrap().answer().met;
    let limit = |harness: &mut Shown, mm: f64| {
        harness.state_mut().session.set_number("stops.travel_limit_mm", mm).unwrap();
        harness.run_steps(1);
    };
    // a hand that holds the slider there
    for mm in [3.0, 2.0, 1.5] {
        limit(&mut harness, mm);
    }
    harness.run_steps(200);
    assert!(!met(&harness));
    harness.get_by_label_contains("Will be judged once you let go.");
    limit(&mut harness, 3.5);
    harness.state_mut().session.end_gesture();
    until(&mut harness, "a verdict", |harness| harness.query_by_label_contains("Not yet").is_some());
    // and one that was there for a moment
    limit(&mut harness, 1.5);
    harness.state_mut().session.end_gesture();
    harness.run_steps(1);
    harness.state_mut().lesson_mut().unwrap().wait(LONG);
    limit(&mut harness, 3.5);
    harness.state_mut().session.end_gesture();
    until(&mut harness, "a verdict", |harness| harness.query_by_label_contains("Not yet").is_some());
    assert!(!met(&harness));
    // what it would take is the answer
    assert_eq!(harness.state().session.sentence().remedy, "");
    limit(&mut harness, 1.5);
    harness.state_mut().session.end_gesture();
    until(&mut harness, "the goal is met", met);
    harness.state_mut().session.wait(LONG);
    harness.run_steps(2);
    assert_eq!(
        harness.state().session.sentence().remedy.is_empty(),
        !harness.state().lesson().unwrap().tells_remedy()
    );
}

#[test]
fn progress_is_kept_and_answers_are_text() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), OWN);
    let mut harness = opened(&path, WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    press(&mut harness, Key::Num2);
    until(&mut harness, "what it did", |shown| shown.state().lesson().unwrap().answer().outcome.is_some());
    let (step, answer) = (number(&harness), harness.state().lesson().unwrap().answer().clone());
    let kept = ron::to_string(&harness.state().records()).unwrap();
    let records: Records = ron::from_str(&kept).unwrap();
    assert_eq!(records, harness.state().records());
    let text = answers_text(&records).unwrap();
    for part in ["A stop that helps", "I expected: rattles", "What holds: does not move"] {
        assert!(text.contains(part), "{text}");
    }
    let mut again = window("first-look", WIDE);
    again.state_mut().set_records(records.clone());
    again.state_mut().open_lesson(&path);
    again.run_steps(3);
    assert_eq!((number(&again), again.state().lesson().unwrap().answer()), (step, &answer));
    // an argument of the program opens it before what was kept is there
    let mut window = Window::open(Some(&path), Settings::default(), std::sync::Arc::new(|| ())).unwrap();
    assert_eq!(window.lesson().unwrap().number(), 0);
    window.set_records(records.clone());
    let lesson = window.lesson().unwrap();
    assert_eq!((lesson.number(), lesson.answer()), (step, &answer));
    assert_eq!(window.session.scene(), harness.state().session.scene());
    assert_eq!(window.records(), records);
    let ctx = again.ctx.clone();
    again.state_mut().carry_out(&ctx, Command::CopyAnswers);
    again.run_steps(1);
    assert_eq!(again.state().notice(), Some("Copied: your answers as text"));
    // anew, nothing of it is left
    command(&mut again, Command::LessonAnew);
    assert_eq!(number(&again), 0);
    assert_eq!(answers_text(&again.state().records()), None);
}

/// A lesson with a task that changes the stops, beside the basins.
const BASINS: &str = r#"(
    format: 1,
    title: "Basins of two stops",
    goal: "Going back shows the scene of the step before.",
    minutes: 5,
    scene: "paper",
    set: [("stops.travel_limit_mm", "4.0")],
    controls: ["stops.travel_limit_mm"],
    views: [Basins, Displacement],
    steps: [
        Say("Look at the **Basins** of stops at 4 mm."),
        Do(
            ask: "Find stops with which it crosses.",
            goal: Is("result.regime", "interwell"),
            hint: "Look further in.",
            solution: [("stops.travel_limit_mm", "1.5")],
        ),
        Explain("Every start crosses."),
    ],
    misconception: "None.",
    lecturer: "Nothing.",
)"#;

#[test]
fn going_back_shows_no_basins_of_the_stops_of_the_task() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = opened(&written(folder.path(), BASINS), WIDE);
    // the stops of the basins that are drawn, and those of the scene
    let drawn = |harness: &Shown| {
        let session = &harness.state().session;
        let (parts, current) = session.explore.basins.parts();
        let question = session.explore.basins.question().filter(|_| !parts.is_empty());
        (question.map(|asked| (asked.of.of.stops, current)), session.scene().stops)
    };
    let wait_for_basins = |harness: &mut Shown| {
        wait_until("the basins", || {
            harness.run_steps(1);
            let (basins, stops) = drawn(harness);
            basins == Some((stops, true)) && harness.state().session.explore.basins.is_whole()
        });
    };
    wait_for_basins(&mut harness);
    press(&mut harness, Key::PageDown);
    for mm in [1.5, 6.0] {
        harness.state_mut().session.set_number("stops.travel_limit_mm", mm).unwrap();
        harness.state_mut().session.end_gesture();
        wait_for_basins(&mut harness);
        harness.key_press(Key::PageUp);
        for _ in 0..40 {
            harness.run_steps(1);
            let (basins, stops) = drawn(&harness);
            assert!(basins.is_none_or(|basins| basins == (stops, true)), "{basins:?} for {stops:?}");
        }
        let (_, stops) = drawn(&harness);
        assert_eq!(stops.travel_limit_mm(), Some(4.0));
        wait_for_basins(&mut harness);
        press(&mut harness, Key::PageDown);
    }
}
