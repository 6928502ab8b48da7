//! The window of a lesson: its strip, controls, views, notes, glossary and files.

use eframe::egui::{self, Key, Modifiers, accesskit::Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use interwell::app::ui::settings::Settings;
use interwell::app::ui::style::Style;
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::lesson::{LESSONS, LessonDocument, Step};
use interwell::scene::{Document, Stops};
use interwell_studies::study::result_fields;

use crate::lessons::{
    OWN, Shown, go_on, go_to, is_anywhere, number, opened, opened_own, step, until, written,
};
use crate::support::{
    PROJECTED, WIDE, command, is_painted, out_of_reach, press, press_with_ctrl, sliced, window,
};

#[test]
fn a_built_in_lesson_opens_by_its_name_number_or_words() {
    let open = |spec| Window::open(Some(spec), Settings::default(), std::sync::Arc::new(|| ()));
    for spec in ["02-shake-it-over", "2", "02", "shake-it-over"] {
        let window = open(spec).unwrap();
        assert_eq!(window.lesson().unwrap().key(), LESSONS[1].name, "{spec}");
    }
    assert!(open("paper").unwrap().lesson().is_none());
    assert!(open("02-shake-it").is_err());
}

#[test]
fn a_file_with_faults_shows_them_all() {
    let folder = tempfile::tempdir().unwrap();
    let faulty = OWN.replace("minutes: 5", "minutes: 0").replace("\"stops.travel", "\"stops.trawel");
    let path = written(folder.path(), &faulty);
    let mut harness = window("first-look", WIDE);
    harness.state_mut().open_another(&path);
    harness.run_steps(3);
    let text = harness.state().message().unwrap().to_owned();
    for part in ["own.ron", "minutes", "stops.trawel_limit_mm", "did you mean"] {
        assert!(text.contains(part), "{text}");
    }
    harness.get_by_label("This lesson cannot be opened");
    assert!(harness.state().lesson().is_none());
    // as the argument of the program, too
    let window = Window::start(Some(&path), Settings::default(), std::sync::Arc::new(|| ())).unwrap();
    assert_eq!(window.message(), Some(text.as_str()));
    // and mended it opens, whatever is unsaved
    let path = written(folder.path(), OWN);
    press(&mut harness, Key::Escape);
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    harness.state_mut().open_another(&path);
    harness.run_steps(3);
    assert!(harness.state().lesson().is_some() && harness.state().recent[0].ends_with("own.ron"));
    let window = Window::open(Some(&path), Settings::default(), std::sync::Arc::new(|| ())).unwrap();
    assert!(window.lesson().is_some() && window.session.editor.path().is_none());
    // another scene asks about what the lesson has put aside
    command(&mut harness, Command::OpenPreset("duffing"));
    harness.get_by_label("Save the changes?");
    assert!(harness.state().lesson().is_none() && harness.state().session.scene().mass_g == 16.0);
}

#[test]
fn a_built_in_lesson_is_opened_by_name_number_or_words() {
    let open = |spec: &str| Window::open(Some(spec), Settings::default(), std::sync::Arc::new(|| ()));
    for spec in ["02-shake-it-over", "2", "02", "shake-it-over"] {
        assert_eq!(open(spec).unwrap().lesson().unwrap().key(), LESSONS[1].name, "{spec}");
    }
    assert!(open("paper").unwrap().lesson().is_none());
    assert!(open("02-shake-it").is_err());
}

#[test]
fn the_longest_texts_fit() {
    let long = |begin: &str, count: usize| {
        let words = begin.chars().chain("the mass hops from stop to stop ".chars().cycle());
        format!("{}.", words.take(count - 1).collect::<String>())
    };
    let (text, option) = (long("Every ", 240), |begin: &str| long(begin, 80));
    let longest = OWN
        .replace("Shaken at 1 g it rattles in one well.", &text)
        .replace("We put stops at ±4 mm and shake as before. The mass ...", &text)
        .replace("crosses every period\"", &format!("{}\"", option("a ")))
        .replace("rattles between home and stop", &option("b "))
        .replace("does not move at all", &option("c "))
        .replace("Where does the force curve lie below 0.149 N, the push of 1 g?", &text)
        .replace("A stop inside the home holds the mass up on the hillside.", &text);
    assert!(LessonDocument::from_text("own", &longest, None, &result_fields()).is_ok());
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), &longest);
    for size in [PROJECTED, WIDE] {
        let mut harness = opened(&path, size);
        let whole = |harness: &mut Shown, number: usize| {
            // by a projector the column scrolls
            assert_eq!(out_of_reach(harness), [""; 0], "{size:?} {number}");
            assert!(size != WIDE || sliced(harness).is_empty(), "{number}");
            for name in ["Well", "Displacement", "pause", "play", "Next", "Finish"] {
                let inside = harness.query_by_label(name).is_none_or(|node| node.rect().bottom() <= size[1]);
                assert!(inside, "{name}");
            }
            // a view has room to show something
            let bar = harness.get_by_label("Well").rect().bottom();
            let foot =
                harness.query_by_label("play").or(harness.query_by_label("pause")).unwrap().rect().top();
            assert!(foot - bar > 100.0, "{size:?} {number}: {}", foot - bar);
        };
        while harness.state().lesson().is_some() {
            let number = number(&harness);
            whole(&mut harness, number);
            match step(&harness) {
                Step::Predict { .. } => {
                    for letter in ["A", "B", "C"] {
                        harness.get_by_label_contains(&format!("{letter}   "));
                    }
                    press(&mut harness, Key::C);
                    until(&mut harness, "what it did", |shown| {
                        shown.state().lesson().unwrap().answer().outcome.is_some()
                    });
                    harness.run_steps(2);
                    whole(&mut harness, number);
                }
                Step::Do { .. } => {
                    press(&mut harness, Key::H);
                    assert!(is_anywhere(&harness, "Hint: "));
                    whole(&mut harness, number);
                }
                _ => {}
            }
            go_on(&mut harness);
        }
    }
}

#[test]
fn a_word_of_the_glossary_says_what_it_means() {
    let mut harness = opened_own(WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Do { .. })));
    let labels = harness.query_all_by_label_contains("Your task: ");
    let text =
        labels.filter(|node| node.accesskit_node().role() == Role::Label).map(|node| node.rect()).next();
    let text = text.unwrap();
    // somewhere in it the word, and elsewhere others
    let meaning = "The time that the shaking takes to repeat";
    let mut said = Vec::new();
    for row in 0..(text.height() / 17.0) as usize {
        for column in 0..(text.width() / 24.0) as usize {
            harness.hover_at(text.min + egui::vec2(24.0 * column as f32 + 12.0, 17.0 * row as f32 + 8.0));
            harness.run_steps(90);
            said.push(is_anywhere(&harness, meaning));
        }
    }
    let count = said.iter().filter(|is_said| **is_said).count();
    assert!((1..4).contains(&count), "{count} of {}", said.len());
}

#[test]
fn a_map_waits_for_the_first_prediction() {
    let mut harness = opened_own(WIDE);
    for view in [View::Map, View::UpAndDown] {
        command(&mut harness, Command::Show(view, true));
    }
    assert_eq!(harness.query_all_by_label("Covered").count(), 2);
    assert!(!harness.state().lesson().unwrap().is_covering());
    assert!(go_to(&mut harness, |step| matches!(step, Step::Do { .. })));
    assert_eq!(harness.query_all_by_label("Covered").count(), 0);
    assert!(is_anywhere(&harness, "Options"));
}

#[test]
fn bold_words_point_at_what_is_on_the_screen() {
    let color = Style { dark: false, projector: false }.pointing_stroke().color;
    let outlines = |harness: &Shown| -> Vec<egui::Rect> {
        let outline = |clipped: &egui::epaint::ClippedShape| match &clipped.shape {
            egui::Shape::Rect(rect) if rect.stroke.color == color => Some(rect.rect),
            _ => None,
        };
        harness.output().shapes.iter().filter_map(outline).collect()
    };
    let folder = tempfile::tempdir().unwrap();
    let text = OWN.replace("Shaken at 1 g it", "With **Stops** and in the **Well** it **surely** and");
    let mut harness = opened(&written(folder.path(), &text), WIDE);
    let found = outlines(&harness);
    let switch = harness.get_by_role_and_label(Role::CheckBox, "Stops").rect().center();
    let well = harness.get_by_label("Well").rect().left_bottom() + egui::vec2(40.0, 40.0);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found.iter().any(|rect| rect.contains(switch)) && found.iter().any(|rect| rect.contains(well)));
    press(&mut harness, Key::PageDown);
    assert_eq!(outlines(&harness), []);
}

#[test]
fn only_what_the_lesson_names_can_be_set() {
    let mut harness = opened_own(WIDE);
    assert!(harness.query_by_label("More").is_none());
    let sliders = harness.query_all_by_role(Role::Slider);
    let names: Vec<String> = sliders.filter_map(|node| node.accesskit_node().label()).collect();
    assert!(!names.iter().any(|name| name == "amplitude"), "{names:?}");
    assert!(names.iter().any(|name| name == "travel limit ±"), "{names:?}");
    for (view, shown) in [(View::Well, true), (View::Displacement, true), (View::Compare, false)] {
        assert_eq!(harness.state().tiling.shows(view), shown);
    }
    command(&mut harness, Command::LeaveLesson);
    harness.get_by_label("More");
    assert!(harness.state().tiling.shows(View::Compare));
    assert_eq!(harness.state().session.scene().stops, Stops::None);
}

#[test]
fn the_first_line_leads_to_the_first_lesson() {
    let mut harness = window("first-look", WIDE);
    harness.get_by_label_contains("Make it cross");
    let name = LESSONS[0].name.split('-').next().unwrap().trim_start_matches('0');
    harness.get_by_label(&format!("Lesson {name}")).click();
    harness.run_steps(3);
    let lesson = harness.state().lesson().unwrap().lesson().title.clone();
    let title = LessonDocument::load(LESSONS[0].name, &result_fields()).unwrap().lesson.title;
    assert_eq!(lesson, title);
}

#[test]
fn the_lecturer_s_notes_come_only_when_asked_for() {
    let mut harness = opened_own(WIDE);
    let notes = harness.state().lesson().unwrap().lesson().lecturer.clone();
    let begin: String = notes.chars().take(20).collect();
    assert!(!is_anywhere(&harness, &begin));
    press_with_ctrl(&mut harness, Key::L);
    assert!(is_anywhere(&harness, &begin));
    press_with_ctrl(&mut harness, Key::L);
    assert!(!is_anywhere(&harness, &begin));
    press(&mut harness, Key::F2);
    assert!(is_anywhere(&harness, "Glossary") && is_anywhere(&harness, "rebounds from a stop"));
    press(&mut harness, Key::F2);
    assert!(!is_anywhere(&harness, "rebounds from a stop"));
}

#[test]
fn the_command_line_of_a_lesson_says_all_that_was_changed() {
    let mut harness = opened_own(WIDE);
    let line = interwell::app::export::command_line(&harness.state().session).unwrap().0;
    let mut document = Document::load("first-look").unwrap();
    for set in line.split(" --set ").skip(1) {
        document.set(set.trim_matches('\'')).unwrap();
    }
    assert_eq!(document.scene, *harness.state().session.scene(), "{line}");
    assert_ne!(document.scene, Document::load("first-look").unwrap().scene);
    harness.run_steps(1);
}

#[test]
fn what_does_not_hold_gets_a_reply_by_choice_or_by_most_votes() {
    let asked = || {
        let mut harness = opened(LESSONS[0].name, WIDE);
        assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
        harness
    };
    let replies = ["It did get there.", "The hilltop is a place of balance"];
    for (key, reply) in [(Key::A, Some(0)), (Key::B, None), (Key::C, Some(1))] {
        let mut harness = asked();
        press(&mut harness, key);
        until(&mut harness, "the result", |shown| shown.state().lesson().unwrap().answer().outcome.is_some());
        harness.run_steps(2);
        for (number, text) in replies.iter().enumerate() {
            assert_eq!(is_painted(&harness, text), reply == Some(number), "{key:?}");
        }
    }
    // most of those that do not hold, whatever holds has
    let mut harness = asked();
    for key in [Key::A, Key::B, Key::B, Key::B, Key::C, Key::C] {
        harness.key_press_modifiers(Modifiers::SHIFT, key);
        harness.run_steps(2);
    }
    press(&mut harness, Key::Enter);
    until(&mut harness, "the reply", |shown| is_painted(shown, replies[1]));
    assert!(!is_painted(&harness, replies[0]));
}

#[test]
fn sliders_keep_their_ranges_from_step_to_step() {
    let mut harness = opened("design-it", WIDE);
    let ranges = |harness: &Shown| {
        let sliders = harness.query_all_by_role(Role::Slider).map(|node| node.accesskit_node());
        let of_controls = sliders.filter(|node| {
            node.label().is_some_and(|name| ["preload", "travel limit ±", "amplitude"].contains(&&*name))
        });
        of_controls.map(|node| (node.label(), node.max_numeric_value())).collect::<Vec<_>>()
    };
    let before = ranges(&harness);
    assert_eq!(before.len(), 3);
    // the preload goes from 2.7 to 1.0 mm
    assert!(go_to(&mut harness, |step| matches!(step, Step::Do { .. })));
    assert_eq!(harness.state().session.number("mechanism.preload_mm"), Some(1.0));
    assert_eq!(ranges(&harness), before);
}

#[test]
fn a_survey_takes_no_room_until_the_first_prediction_is_shown() {
    let mut harness = opened("the-price-of-a-stop", WIDE);
    let place = |harness: &Shown| harness.state().tiling.place_of(View::Map);
    assert_eq!(place(&harness), None);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    assert_eq!(place(&harness), None);
    go_on(&mut harness);
    harness.run_steps(2);
    assert!(place(&harness).is_some_and(|map| map.width() > 400.0));
}

#[test]
fn a_cover_by_a_key_ends_with_the_step() {
    let mut harness = opened("shake-it-over", WIDE);
    press(&mut harness, Key::C);
    assert!(is_painted(&harness, "C shows it again"));
    press(&mut harness, Key::PageDown);
    assert!(!is_painted(&harness, "C shows it again"));
}

#[test]
fn a_task_that_was_done_says_so_when_the_scene_is_changed_after_it() {
    let mut harness = opened("a-stop-that-helps", WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Do { .. })));
    let limit = |harness: &mut Shown, mm: f64| {
        harness.state_mut().session.set_number("stops.travel_limit_mm", mm).unwrap();
        harness.state_mut().session.end_gesture();
        harness.run_steps(2);
    };
    limit(&mut harness, 1.5);
    until(&mut harness, "the task is done", |shown| is_painted(shown, "Done."));
    limit(&mut harness, 3.0);
    assert!(is_painted(&harness, "Done, before your last changes."));
    limit(&mut harness, 1.5);
    assert!(is_painted(&harness, "Done.") && !is_painted(&harness, "last changes"));
}
