//! Lessons in a classroom: a strip that stays as high, what is lacking, hints, the end, notes, votes.

use eframe::egui::accesskit::Role;
use eframe::egui::{Color32, Key, Modifiers, Shape};
use egui_kittest::kittest::Queryable as _;
use interwell::app::ui::settings::Settings;
use interwell::app::views::View;
use interwell::app::window::Command;
use interwell::app::words::lesson::bold_words;
use interwell::app::words::meanings::{GLOSSARY, UNDERLINED, meaning};
use interwell::scene::lesson::{LESSONS, Step};

use crate::lessons::{OWN, Shown, go_on, go_to, is_anywhere, number, opened, opened_own, until, written};
use crate::pictures::axes;
use crate::support::{
    LONG, PROJECTED, WIDE, click_on, command, is_painted, painted, press, press_with_ctrl, window_with,
};

/// The upper edge of the views, below the strip and the controls.
fn edge(harness: &Shown) -> f32 {
    let places = View::ALL.into_iter().filter_map(|view| harness.state().tiling.place_of(view));
    places.map(|place| place.top()).fold(f32::MAX, f32::min)
}

#[test]
fn dots_and_the_scale_of_the_well_stay_from_step_to_step() {
    for entry in LESSONS {
        let mut harness = opened(entry.name, PROJECTED);
        let mut seen: Option<(f32, f64)> = None;
        while let Some(lesson) = harness.state().lesson() {
            let (number, count) = (lesson.number() + 1, lesson.lesson().steps.len());
            let dots = harness.get_by_label(&format!("step {number} of {count}")).rect();
            let now = (dots.left(), harness.state().memory.push_of_lesson);
            let before = *seen.get_or_insert(now);
            assert!((now.0 - before.0).abs() < 2.0 && now.1 == before.1, "{} {number}", entry.name);
            go_on(&mut harness);
        }
    }
}

#[test]
fn the_energy_of_a_flick_is_seen_but_not_that_of_the_flick_before_a_question() {
    let mut harness = opened("01-two-wells-and-a-hill", WIDE);
    assert!(is_painted(&harness, "energy of the mass"));
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    assert!(!is_painted(&harness, "energy of the mass"));
    press(&mut harness, Key::B);
    harness.state_mut().session.player.set_playing(false);
    harness.run_steps(40);
    // at the start it has the most, 1.47 mJ, within the axis
    assert!(harness.state().session.player.watch().time() < 0.05);
    let place = harness.state().tiling.place_of(View::Well).unwrap();
    let texts = painted(&harness).into_iter().filter(|text| place.contains(text.1.center()));
    let highest = texts.filter_map(|text| text.0.parse::<f64>().ok()).fold(0.0, f64::max);
    assert!(is_painted(&harness, "energy of the mass") && highest >= 1.47, "{highest}");
}

#[test]
fn twice_the_push_is_drawn_twice_as_steep() {
    let mut harness = opened("02-shake-it-over", WIDE);
    let ticks = |harness: &Shown| {
        let place = harness.state().tiling.place_of(View::Well).unwrap();
        let texts = painted(harness).into_iter().filter(|text| place.contains(text.1.center()));
        let ticks: Vec<String> = texts.map(|text| text.0).filter(|text| text.ends_with(".5")).collect();
        assert!(!ticks.is_empty());
        ticks
    };
    let before = ticks(&harness);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    press(&mut harness, Key::A);
    harness.run_steps(40);
    assert!(harness.state().session.amplitude_g().unwrap() >= 1.3);
    assert_eq!(ticks(&harness), before);
}

#[test]
fn the_first_view_that_a_step_names_is_in_front() {
    let named = |harness: &Shown| {
        let lesson = harness.state().lesson().filter(|lesson| !lesson.is_covering())?;
        let words = bold_words(lesson.step().text()).collect::<Vec<_>>();
        let views = words
            .iter()
            .filter_map(|word| View::ALL.into_iter().find(|view| view.name().to_lowercase() == *word));
        views.into_iter().find(|view| harness.state().tiling.shows(*view))
    };
    let mut count = 0;
    for entry in LESSONS {
        let mut harness = opened(entry.name, PROJECTED);
        while let Some(number) = harness.state().lesson().map(|lesson| lesson.number()) {
            harness.run_steps(2);
            if let Some(view) = named(&harness) {
                count += 1;
                let place = harness.state().tiling.place_of(view);
                assert!(place.is_some(), "{} {number}: {}", entry.name, view.name());
            }
            go_on(&mut harness);
        }
    }
    assert!(count > 15, "{count}");
}

#[test]
fn where_nothing_shakes_the_mass_a_step_plays_its_motion_from_the_start() {
    let mut harness = opened("two-wells-and-a-hill", WIDE);
    let time = |harness: &Shown| harness.state().session.player.time();
    harness.state_mut().session.player.speed = 1.0;
    harness.run_steps(60);
    let before = time(&harness);
    go_on(&mut harness);
    assert!(before > 3.0 && time(&harness) < 0.5, "{before} {}", time(&harness));
    // a motion that is shaken goes on
    let mut harness = opened("letting-go-is-not-crossing", WIDE);
    harness.state_mut().session.player.speed = 1.0;
    harness.run_steps(60);
    let before = time(&harness);
    go_on(&mut harness);
    assert!(before > 0.3 && time(&harness) >= before, "{before} {}", time(&harness));
}

/// Lesson 8 takes the preload from 2.7 to 1.0 mm, and the hill is drawn as much lower.
#[test]
fn the_axis_of_energy_holds_from_step_to_step_of_a_lesson() {
    let mut harness = opened("design-it", WIDE);
    let up = |harness: &Shown| axes(harness, "energy (mJ)")[0].clone();
    let numbers = |harness: &Shown| up(harness).iter().map(|tick| tick.0).collect::<Vec<_>>();
    let millijoule = |harness: &Shown| {
        let up = up(harness);
        (up[0].1 - up[1].1) / (up[0].0 - up[1].0) as f32
    };
    harness.run_steps(40);
    let before = numbers(&harness);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    go_on(&mut harness);
    harness.run_steps(40);
    let session = &harness.state().session;
    assert!(session.number("mechanism.preload_mm") == Some(1.0));
    let (low, after) = (millijoule(&harness), numbers(&harness));
    assert!(before.len() > 2 && before == after, "{before:?} {after:?}");
    // what the question covered takes its room back, so the scale of the high hill is that in this room
    assert!(harness.state_mut().session.set_number("mechanism.preload_mm", 2.7).unwrap());
    harness.run_steps(40);
    let high = millijoule(&harness);
    assert!((low / high - 1.0).abs() < 0.02, "{low} {high}");
}

#[test]
fn a_hint_comes_when_asked_is_offered_after_three_tries_and_leaves_when_the_task_is_done() {
    let mut harness = opened_own(WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Do { .. })));
    let limit = |harness: &mut Shown, mm: f64| {
        harness.state_mut().session.set_number("stops.travel_limit_mm", mm).unwrap();
        harness.state_mut().session.end_gesture();
        harness.run_steps(1);
    };
    // time alone brings none
    harness.run_steps(240);
    assert!(!is_painted(&harness, "Hint: ") && is_painted(&harness, "Hint (H)"));
    for (mm, is_offered) in [(3.9, false), (3.8, false), (3.7, true)] {
        limit(&mut harness, mm);
        until(&mut harness, "a verdict", |shown| is_painted(shown, "Not yet: it still rests on its stop."));
        harness.run_steps(2);
        assert_eq!(is_painted(&harness, "Would a hint help? (H)"), is_offered, "{mm}");
    }
    press(&mut harness, Key::H);
    assert!(is_painted(&harness, "Hint: "));
    limit(&mut harness, 1.5);
    until(&mut harness, "the goal is met", |shown| shown.state().lesson().unwrap().answer().met);
    harness.run_steps(2);
    assert!(is_painted(&harness, "Done.") && !is_painted(&harness, "Hint"));
}

/// The first lesson at its first question, and the number of that step.
fn asked() -> (Shown, usize) {
    let mut harness = opened(LESSONS[0].name, WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    let at = number(&harness);
    (harness, at)
}

#[test]
fn page_down_stops_at_a_covered_prediction_and_at_the_last_step() {
    let (mut harness, at) = asked();
    press(&mut harness, Key::PageDown);
    assert!(number(&harness) == at && harness.state().lesson().unwrap().is_covering());
    assert!(harness.state().notice().is_some_and(|text| text.contains("PageDown once more")));
    // the button has the keyboard
    press(&mut harness, Key::Enter);
    assert!(!harness.state().lesson().unwrap().is_covering());
    assert_eq!(harness.state().lesson().unwrap().answer().choice, None);
    // and no other has it after that
    press(&mut harness, Key::Enter);
    assert_eq!(number(&harness), at);
    while !harness.state().lesson().unwrap().is_last() {
        go_on(&mut harness);
    }
    press(&mut harness, Key::PageDown);
    assert!(harness.state().lesson().unwrap().is_last());
    assert!(harness.state().notice().is_some_and(|text| text.contains("Lesson 2")));
    // the second press holds for as long as nothing else is done
    harness.run_steps(600);
    press(&mut harness, Key::PageDown);
    assert_eq!(harness.state().lesson().unwrap().key(), LESSONS[1].name);
}

/// A choice takes Reveal away; what then stands in its place must not be pressed by Enter.
#[test]
fn a_choice_by_its_key_leaves_no_button_with_the_keyboard() {
    let (mut harness, at) = asked();
    press(&mut harness, Key::PageDown);
    assert!(harness.state().lesson().unwrap().is_covering());
    press(&mut harness, Key::B);
    assert!(harness.state().lesson().unwrap().answer().choice.is_some());
    press(&mut harness, Key::Enter);
    assert_eq!(number(&harness), at);
}

/// A clicker has no Enter.
#[test]
fn page_down_twice_reveals_also_with_a_late_vote_between() {
    let (mut harness, at) = asked();
    press(&mut harness, Key::PageDown);
    harness.run_steps(600);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::A);
    harness.run_steps(3);
    assert!(harness.state().lesson().unwrap().is_covering());
    press(&mut harness, Key::PageDown);
    assert!(!harness.state().lesson().unwrap().is_covering());
    assert_eq!((number(&harness), &harness.state().lesson().unwrap().answer().choice), (at, &None));
}

#[test]
fn the_end_says_what_was_learnt_and_leads_to_the_next_lesson() {
    let mut harness = opened(LESSONS[0].name, WIDE);
    let goal = harness.state().lesson().unwrap().lesson().goal.clone();
    while !harness.state().lesson().unwrap().is_last() {
        go_on(&mut harness);
    }
    click_on(&mut harness, "Finish");
    assert!(harness.state().lesson().is_none() && is_painted(&harness, &goal));
    click_on(&mut harness, "Go on to Lesson 2");
    assert_eq!(harness.state().lesson().unwrap().key(), LESSONS[1].name);
    assert!(!is_painted(&harness, &goal));
}

#[test]
fn a_lesson_that_was_begun_before_asks_where_to_begin() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), OWN);
    let mut harness = opened(&path, WIDE);
    press(&mut harness, Key::PageDown);
    assert!(!is_anywhere(&harness, "begun before"));
    for (answer, step) in [("Go on", 1), ("Begin anew", 0)] {
        command(&mut harness, Command::LeaveLesson);
        harness.state_mut().open_lesson(&path);
        harness.run_steps(3);
        assert!(is_anywhere(&harness, "left at step 2 of 4"));
        // keys wait for the answer
        press(&mut harness, Key::PageUp);
        click_on(&mut harness, answer);
        assert!(number(&harness) == step && !is_anywhere(&harness, "begun before"), "{answer}");
    }
}

/// Height in pixels of what is above and below the views, and of their places, in a window of 1280x720.
fn heights(harness: &Shown) -> (f32, f32) {
    let pixels = 1280.0 / PROJECTED[0];
    let places: Vec<_> =
        View::ALL.into_iter().filter_map(|view| harness.state().tiling.place_of(view)).collect();
    let bottom = places.iter().map(|place| place.bottom()).fold(0.0, f32::max);
    let whole = harness.ctx.content_rect().height();
    (pixels * (edge(harness) + whole - bottom), pixels * (bottom - edge(harness)))
}

#[test]
fn a_projector_leaves_the_height_to_the_views() {
    let mut harness = window_with("paper", PROJECTED, Settings::default());
    assert!(heights(&harness).0 <= 200.0, "{:?}", heights(&harness));
    press_with_ctrl(&mut harness, Key::Num3);
    harness.state_mut().session.wait_for_map(LONG);
    harness.run_steps(3);
    let map = harness.get_by_role_and_label(Role::Image, "map").rect();
    let height = map.height() * 1280.0 / PROJECTED[0];
    assert!(height >= 350.0 && heights(&harness).0 <= 200.0, "{height} {:?}", heights(&harness));
    // beside a lesson too, and its buttons are seen
    for entry in LESSONS {
        let harness = opened(entry.name, PROJECTED);
        assert!(heights(&harness).1 >= 350.0, "{}: {:?}", entry.name, heights(&harness));
        let next = harness.get_by_label("Next").rect();
        assert!(next.bottom() < PROJECTED[1] && next.right() <= PROJECTED[0], "{next:?}");
    }
}

#[test]
fn the_starts_of_a_question_are_seen_in_the_phase_portrait() {
    let mut harness = opened("07-a-coin-toss", WIDE);
    // a line, or rings
    let marks = |harness: &Shown| {
        let place = harness.state().tiling.place_of(View::PhasePortrait).unwrap();
        let is_mark = |clipped: &&eframe::egui::epaint::ClippedShape| match &clipped.shape {
            Shape::LineSegment { points, stroke } => {
                stroke.color == Color32::BLACK && stroke.width == 2.0 && place.contains(points[0])
            }
            // those of a legend are larger
            Shape::Circle(circle) => {
                circle.fill == Color32::WHITE && circle.radius == 3.0 && place.contains(circle.center)
            }
            _ => false,
        };
        harness.output().shapes.iter().filter(is_mark).count()
    };
    assert_eq!(marks(&harness), 0);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    press(&mut harness, Key::A);
    harness.run_steps(2);
    assert_eq!(marks(&harness), 1);
    assert!(harness.state().lesson().unwrap().starts().contains(&(0.0, -0.3)));
    // those of a task take their place
    assert!(go_to(&mut harness, |step| matches!(step, Step::Do { .. })));
    // two, far enough apart for dots
    assert_eq!(marks(&harness), 2);
}

#[test]
fn a_view_over_the_window_has_the_whole_window() {
    let settings = Settings { projector: true, ..Settings::default() };
    let mut harness = window_with("paper", PROJECTED, settings);
    command(&mut harness, Command::Show(View::Map, true));
    let map = harness.state().tiling.place_of(View::Map).unwrap();
    harness.hover_at(map.center());
    harness.run_steps(2);
    press(&mut harness, Key::Z);
    // beside the view only its title and the bar of time are left
    assert!(harness.query_by_label("File").is_none() && harness.query_by_label("More").is_none());
    let foot = harness.query_by_label("play").or(harness.query_by_label("pause")).unwrap().rect().top();
    let head = harness.get_by_label("all views").rect().bottom();
    let whole = harness.ctx.content_rect().height();
    assert!(whole - (foot - head) < 90.0, "{head} {foot} of {whole}");
    press(&mut harness, Key::Z);
    harness.get_by_label("File");
    // in a lesson the step stands above it in words, and its options with their votes
    let mut harness = opened_own(PROJECTED);
    press(&mut harness, Key::Z);
    assert!(is_painted(&harness, "Shaken at 1 g"));
    let top = harness.get_by_label("all views").rect().top();
    press(&mut harness, Key::PageDown);
    assert!(is_painted(&harness, "We put stops at") && harness.query_by_label("File").is_none());
    harness.key_press_modifiers(Modifiers::SHIFT, Key::B);
    harness.run_steps(2);
    assert!(is_painted(&harness, "B rattles between home and stop") && !is_painted(&harness, "(1 vote)"));
    press(&mut harness, Key::Enter);
    until(&mut harness, "the answer", |shown| is_painted(shown, "Answer: "));
    assert!(is_painted(&harness, "B rattles between home and stop (1 vote)"));
    assert_eq!(harness.get_by_label("all views").rect().top(), top);
    assert!(harness.query_by_label("File").is_none());
}

#[test]
fn the_notes_mark_the_line_of_now() {
    let mut harness = opened(LESSONS[2].name, WIDE);
    press_with_ctrl(&mut harness, Key::L);
    let height = |harness: &Shown, text: &str| {
        let all = painted(harness);
        all.iter().find(|label| label.0 == text).map(|label| label.1.center().y).unwrap()
    };
    for time in ["0:00", "0:30", "1:30", "4:30"] {
        assert!(is_painted(&harness, time), "{time}");
    }
    // a long line goes on below, beside its time
    let all = painted(&harness);
    let long = all.iter().find(|text| text.0.starts_with("Ask why it was stuck")).unwrap();
    assert!(long.1.right() <= long.2.right() && long.1.height() > 20.0, "{long:?}");
    let above = |harness: &Shown, time: &str| height(harness, "now") - height(harness, time);
    assert!((1.0..30.0).contains(&above(&harness, "0:00")));
    // 31 s later, at four frames a second
    harness.run_steps(4 * 31);
    assert!((1.0..30.0).contains(&above(&harness, "0:30")));
}

#[test]
fn a_task_is_passed_by_page_down_twice_or_by_skip_and_is_then_shown_solved() {
    for by_key in [true, false] {
        let mut harness = opened(LESSONS[0].name, WIDE);
        assert!(go_to(&mut harness, |step| matches!(step, Step::Do { .. })));
        let at = number(&harness);
        assert!(harness.query_by_label("Next").is_none());
        if by_key {
            press(&mut harness, Key::PageDown);
            assert!(number(&harness) == at && is_painted(&harness, "PageDown once more passes it"));
            press(&mut harness, Key::PageDown);
        } else {
            click_on(&mut harness, "Skip");
        }
        assert_eq!(number(&harness), at + 1);
        assert!(is_painted(&harness, "The task is shown solved: starting velocity \u{2212}0.5 m/s"));
        assert_eq!(harness.state().session.number("start.v_m_per_s"), Some(-0.5));
        assert!(!harness.state().lesson().unwrap().is_settled(at));
    }
}

#[test]
fn votes_are_counted_beside_a_prediction() {
    let mut harness = opened_own(WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    let shift = |harness: &mut Shown, key: Key| {
        harness.key_press_modifiers(Modifiers::SHIFT, key);
        harness.run_steps(3);
    };
    for key in [Key::A, Key::C] {
        shift(&mut harness, key);
    }
    // from the first vote on the letter alone is one too, and reveals nothing
    press(&mut harness, Key::C);
    assert!(harness.state().lesson().unwrap().is_covering());
    for text in ["A   crosses every period, 1\u{a0}vote", "C   does not move at all, 2\u{a0}votes"] {
        harness.get_by_label(text);
    }
    // in secret until the answer is shown
    let is_beside = |harness: &Shown, words: &str, number: &str| {
        let option = harness.get_by_label(words).rect();
        painted(harness).iter().any(|text| text.0 == number && option.contains_rect(text.1))
    };
    let two = |harness: &Shown| is_beside(harness, "C   does not move at all, 2\u{a0}votes", "2");
    assert!(is_painted(&harness, "3 votes are counted.") && !two(&harness));
    // in the notes by buttons
    press_with_ctrl(&mut harness, Key::L);
    harness.query_all_by_label("B 0").next().unwrap().click();
    harness.run_steps(3);
    assert_eq!(harness.state().lesson().unwrap().answer().votes, [1, 1, 2]);
    press_with_ctrl(&mut harness, Key::L);
    click_on(&mut harness, "Reveal");
    // the options stay, with their votes
    for text in ["A   crosses every period, 1\u{a0}vote", "C   does not move at all, 2\u{a0}votes"] {
        harness.get_by_label(text);
    }
    assert!(two(&harness) && is_beside(&harness, "A   crosses every period, 1\u{a0}vote", "1"));
    assert_eq!(harness.state().lesson().unwrap().answer().choice, None);
    // too late: no vote, and nothing is covered
    shift(&mut harness, Key::C);
    assert!(is_painted(&harness, "votes are no longer counted"));
    assert!(!is_painted(&harness, "C shows it again"));
    assert_eq!(harness.state().lesson().unwrap().answer().votes, [1, 1, 2]);
}

#[test]
fn enter_at_a_prediction_says_what_to_do() {
    let mut harness = opened_own(WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    press(&mut harness, Key::Enter);
    assert!(is_painted(&harness, "Nobody has chosen yet"));
    assert!(harness.state().lesson().unwrap().is_covering());
    press(&mut harness, Key::Enter);
    assert!(!harness.state().lesson().unwrap().is_covering());
}

#[test]
fn the_glossary_has_every_underlined_word_and_those_of_the_window() {
    let named = [
        "hopping",
        "irregular",
        "chaotic",
        "separatrix",
        "push",
        "potential",
        "bulge",
        "reach",
        "preload",
        "phase portrait",
        "path error",
        "once a period",
    ];
    for word in named.into_iter().chain(UNDERLINED) {
        assert!(GLOSSARY.contains(&word) && meaning(word).is_some(), "{word}");
    }
    assert!(GLOSSARY.iter().map(|word| word.to_lowercase()).is_sorted());
    let mut harness = opened_own(WIDE);
    press(&mut harness, Key::F2);
    assert!(is_anywhere(&harness, "separatrix") && is_anywhere(&harness, "preload"));
}
