//! Scenes that come and go: unsaved changes, files and the folders that they name, dialogs.

use eframe::egui::{self, Event, Key};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::window::Command;
use interwell::app::window::leave::Next;
use interwell::app::window::{Wanted, Window};

use crate::support::{WIDE, command, press, window};

pub fn opened() -> Harness<'static, Window> {
    window("first-look", WIDE)
}

pub fn title(harness: &Harness<'static, Window>) -> String {
    harness.state().session.scene().title.clone()
}

#[test]
fn unsaved_changes_are_asked_about() {
    let mut harness = opened();
    command(&mut harness, Command::OpenPreset("duffing"));
    let other = title(&harness);
    assert_ne!(other, "First look");
    harness.state_mut().session.edit_once(|scene| scene.mass_g *= 2.0);
    command(&mut harness, Command::OpenPreset("first-look"));
    harness.get_by_label("Save the changes?");
    harness.get_by_label("Cancel").click();
    harness.run_steps(3);
    assert_eq!(title(&harness), other);
    assert!(harness.query_by_label("Save the changes?").is_none());
    command(&mut harness, Command::OpenPreset("first-look"));
    harness.get_by_label("Don't save").click();
    harness.run_steps(3);
    assert_eq!(title(&harness), "First look");
    // Escape stays
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    command(&mut harness, Command::Quit);
    press(&mut harness, Key::Escape);
    assert!(harness.query_by_label("Save the changes?").is_none());
    assert_eq!(harness.state().session.scene().mass_g, 16.0);
}

#[test]
fn saved_first_and_then_gone_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("own.ron");
    let mut harness = opened();
    let ctx = harness.ctx.clone();
    harness.state_mut().save_to(&ctx, &path);
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    command(&mut harness, Command::OpenPreset("duffing"));
    harness.get_by_label("Save").click();
    harness.run_steps(3);
    assert_ne!(title(&harness), "First look");
    assert!(std::fs::read_to_string(&path).unwrap().contains("16.0"));
    assert!(harness.state().recent[0].ends_with("own.ron"));
    let recent = harness.state().recent[0].clone();
    command(&mut harness, Command::OpenRecent(recent));
    assert_eq!(harness.state().session.scene().mass_g, 16.0);
    // where it cannot be saved the changes stay, and so does the scene
    std::fs::remove_dir_all(folder.path()).unwrap();
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 17.0);
    command(&mut harness, Command::OpenPreset("duffing"));
    harness.get_by_label("Save").click();
    harness.run_steps(3);
    assert!(harness.state().message().is_some_and(|text| text.contains("there is no folder")));
    assert_eq!(harness.state().session.scene().mass_g, 17.0);
}

#[test]
fn comments_go_only_when_it_has_been_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hand.ron");
    let text = harness_text().replacen('(', "( // by hand\n", 1);
    std::fs::write(&path, &text).unwrap();
    let mut harness = opened();
    harness.state_mut().open_another(path.to_str().unwrap());
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    command(&mut harness, Command::Save);
    harness.get_by_label_contains("has comments");
    harness.get_by_label("Cancel").click();
    harness.run_steps(3);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    command(&mut harness, Command::Save);
    harness.get_by_label("Save").click();
    harness.run_steps(3);
    assert!(!std::fs::read_to_string(&path).unwrap().contains("//"));
    assert!(!harness.state().session.editor.is_dirty());
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 17.0);
    command(&mut harness, Command::Save);
    assert!(!harness.state().session.editor.is_dirty());
}

pub fn harness_text() -> String {
    interwell::app::session::editor::Editor::open("first-look").unwrap().text().unwrap()
}

#[test]
fn a_wrong_scene_leaves_the_old_one() {
    let mut harness = opened();
    let ctx = harness.ctx.clone();
    harness.state_mut().leave_for(&ctx, Next::Open("/nowhere/at/all.ron".into()));
    harness.run_steps(3);
    assert!(harness.state().message().is_some_and(|text| text.contains("no such file")));
    assert_eq!(title(&harness), "First look");
    // the window has the scene's name and says when it is not saved
    let titled = |harness: &Harness<'static, Window>| {
        let commands = &harness.output().viewport_output[&egui::ViewportId::ROOT].commands;
        commands.iter().find_map(|command| match command {
            egui::ViewportCommand::Title(title) => Some(title.clone()),
            _ => None,
        })
    };
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    harness.step();
    assert_eq!(titled(&harness).as_deref(), Some("* First look - interwell"));
}

#[test]
fn no_key_acts_behind_a_dialog_or_in_a_field() {
    let mut harness = opened();
    let seen = |harness: &Harness<'static, Window>| {
        let window = harness.state();
        (window.settings, window.session.player.speed, window.session.player.is_playing())
    };
    let before = seen(&harness);
    let type_all = |harness: &mut Harness<'static, Window>| {
        for key in [Key::P, Key::D, Key::C, Key::Num1, Key::Space, Key::Period, Key::Home, Key::PageUp] {
            press(harness, key);
        }
    };
    // unsaved changes: the focus is on a button, which Space would press
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    command(&mut harness, Command::Quit);
    harness.get_by_label("Cancel").focus();
    harness.run_steps(2);
    for key in [Key::P, Key::D, Key::C, Key::Num1, Key::Period, Key::Home, Key::PageUp] {
        press(&mut harness, key);
    }
    harness.event(Event::Paste(harness_text()));
    harness.run_steps(2);
    assert_eq!(seen(&harness), before);
    assert_eq!(harness.state().session.scene().mass_g, 16.0);
    press(&mut harness, Key::Escape);
    // a path that cannot be, entered, and typed on
    harness.state_mut().type_path(Wanted::Open);
    harness.run_steps(3);
    harness.event(Event::Text("/nowhere/at/all".into()));
    press(&mut harness, Key::Enter);
    harness.get_by_label("There is no such file.");
    type_all(&mut harness);
    assert_eq!(seen(&harness), before);
    // and the field has the keyboard still
    harness.key_press(Key::End);
    harness.event(Event::Text("xyz".into()));
    harness.run_steps(2);
    assert!(harness.query_all_by_value("/nowhere/at/allxyz").next().is_some());
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::Num1);
    assert_eq!(harness.state().session.player.speed, 1e-3);
}

#[test]
fn home_goes_back_to_what_was_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("own.ron");
    let mut harness = opened();
    let ctx = harness.ctx.clone();
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    harness.state_mut().save_to(&ctx, &path);
    harness.run_steps(2);
    assert_eq!(harness.state().notice(), Some("Saved own.ron"));
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 17.0);
    press(&mut harness, Key::Home);
    assert_eq!(harness.state().session.scene().mass_g, 16.0);
    assert!(!harness.state().session.editor.is_dirty());
}

#[test]
fn a_scene_takes_its_files_along() {
    ["paper-table", "walking"].into_iter().for_each(takes_its_files_along);
}

fn takes_its_files_along(preset: &str) {
    let folder = tempfile::tempdir().unwrap();
    let (one, two) = (folder.path().join("one"), folder.path().join("two"));
    for place in [one.join("data"), two.clone()] {
        std::fs::create_dir_all(place).unwrap();
    }
    // a table beside the scene, and another file of that name where it is saved to
    let mut harness = window(preset, WIDE);
    let ctx = harness.ctx.clone();
    harness.state_mut().save_to(&ctx, &one.join("own.ron"));
    let named = |harness: &Harness<'static, Window>| {
        harness.state().session.editor.document().named_files()[0].clone()
    };
    let table = named(&harness);
    let text = std::fs::read_to_string(&table).unwrap();
    std::fs::write(two.join(table.file_name().unwrap()), "another\n").unwrap();
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    harness.state_mut().save_to(&ctx, &two.join("own.ron"));
    harness.run_steps(2);
    assert!(harness.state().message().is_none());
    let moved = named(&harness);
    assert_eq!((moved.parent(), std::fs::read_to_string(&moved).unwrap()), (Some(two.as_path()), text));
    let name = moved.file_name().unwrap().to_str().unwrap().to_owned();
    assert!(harness.state().notice().is_some_and(|told| told.contains(&name)), "{name}");
    // it opens there, also where the first folder is gone, and so does what undo brings back
    std::fs::remove_dir_all(&one).unwrap();
    harness.state_mut().session.undo();
    harness.run_steps(2);
    assert_eq!(harness.state().session.fault(), None);
    harness.state_mut().open_another(two.join("own.ron").to_str().unwrap());
    assert!(harness.state().message().is_none());
    assert_eq!(harness.state().session.scene().mass_g, 16.0);
}

#[test]
fn a_file_may_be_called_like_a_built_in_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("built-in paper.ron");
    std::fs::write(&path, harness_text()).unwrap();
    let editor = interwell::app::session::editor::Editor::open(path.to_str().unwrap()).unwrap();
    assert_eq!((editor.path(), editor.origin().as_deref()), (Some(path.as_path()), path.to_str()));
    // also by a path that begins so
    let document =
        interwell::scene::Document::from_text("built-in paper", &harness_text(), Default::default());
    let editor = interwell::app::session::editor::Editor::new(document.unwrap());
    assert_eq!((editor.path(), editor.origin()), (None, None));
}

#[test]
fn enter_closes_a_message() {
    let mut harness = opened();
    harness.get_by_role_and_label(egui::accesskit::Role::Slider, "amplitude").focus();
    harness.run_steps(2);
    command(&mut harness, Command::About);
    assert!(harness.state().message().is_some());
    press(&mut harness, Key::Enter);
    assert!(harness.state().message().is_none());
}
