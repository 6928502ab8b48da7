//! Scenes come and go: unsaved changes, files, the clipboard, what is written.

use eframe::egui::{self, Event, Key, OutputCommand};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::leave::Next;
use interwell::app::menu::Command;
use interwell::app::settings::Settings;
use interwell::app::window::Window;

use crate::support::window;

const WIDE: [f32; 2] = [1280.0, 720.0];

fn opened() -> Harness<'static, Window> {
    window("first-look", WIDE, Settings::default())
}

fn title(harness: &Harness<'static, Window>) -> String {
    harness.state().session.scene().title.clone()
}

fn ask(harness: &mut Harness<'static, Window>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().carry_out(&ctx, command);
    harness.run_steps(3);
}

fn copied(harness: &Harness<'static, Window>) -> Option<String> {
    harness.output().platform_output.commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    })
}

#[test]
fn unsaved_changes_are_asked_about() {
    let mut harness = opened();
    ask(&mut harness, Command::OpenPreset("duffing"));
    let other = title(&harness);
    assert_ne!(other, "First look");
    harness.state_mut().session.edit_once(|scene| scene.mass_g *= 2.0);
    ask(&mut harness, Command::OpenPreset("first-look"));
    harness.get_by_label("Save the changes?");
    harness.get_by_label("Cancel").click();
    harness.run_steps(3);
    assert_eq!(title(&harness), other);
    assert!(harness.query_by_label("Save the changes?").is_none());
    ask(&mut harness, Command::OpenPreset("first-look"));
    harness.get_by_label("Don't save").click();
    harness.run_steps(3);
    assert_eq!(title(&harness), "First look");
    // Escape stays
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    ask(&mut harness, Command::Quit);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
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
    ask(&mut harness, Command::OpenPreset("duffing"));
    harness.get_by_label("Save").click();
    harness.run_steps(3);
    assert_ne!(title(&harness), "First look");
    assert!(std::fs::read_to_string(&path).unwrap().contains("16.0"));
    assert!(harness.state().recent[0].ends_with("own.ron"));
    let recent = harness.state().recent[0].clone();
    ask(&mut harness, Command::OpenRecent(recent));
    assert_eq!(harness.state().session.scene().mass_g, 16.0);
    // where it cannot be saved the changes stay, and so does the scene
    std::fs::remove_dir_all(folder.path()).unwrap();
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 17.0);
    ask(&mut harness, Command::OpenPreset("duffing"));
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
    ask(&mut harness, Command::Save);
    harness.get_by_label_contains("has comments");
    harness.get_by_label("Cancel").click();
    harness.run_steps(3);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    ask(&mut harness, Command::Save);
    harness.get_by_label("Save").click();
    harness.run_steps(3);
    assert!(!std::fs::read_to_string(&path).unwrap().contains("//"));
    assert!(!harness.state().session.editor.is_dirty());
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 17.0);
    ask(&mut harness, Command::Save);
    assert!(!harness.state().session.editor.is_dirty());
}

fn harness_text() -> String {
    interwell::app::document::Editor::open("first-look").unwrap().text()
}

#[test]
fn scenes_go_through_the_clipboard() {
    let mut harness = opened();
    harness.event(Event::Copy);
    harness.step();
    let text = copied(&harness).unwrap();
    assert_eq!(text, harness_text());
    harness.event(Event::Paste(text.replace("First look", "Pasted")));
    harness.run_steps(3);
    assert_eq!(title(&harness), "Pasted");
    harness.event(Event::Paste("(title: \"wrong\")".into()));
    harness.run_steps(3);
    assert!(harness.state().message().is_some_and(|text| text.contains("`mass_g` is missing")));
    assert_eq!(title(&harness), "Pasted");
    ask(&mut harness, Command::CopyCommand);
    assert!(harness.state().message().is_some_and(|text| text.contains("save it first")));
}

#[test]
fn the_command_line_says_what_is_shown() {
    let mut harness = opened();
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    let ctx = harness.ctx.clone();
    harness.state_mut().carry_out(&ctx, Command::CopyCommand);
    harness.step();
    assert_eq!(copied(&harness).unwrap(), "interwell --headless simulate first-look --set mass_g=16");
}

#[test]
fn the_motion_is_written_with_the_columns_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("motion.csv");
    let mut harness = opened();
    harness.state_mut().write_motion(&path);
    let text = std::fs::read_to_string(&path).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t_s,x_m,v_m_per_s,base_accel_m_per_s2,phase"));
    assert!(lines.next().is_some_and(|first| first.contains(",0.00718") && first.ends_with(",free")));
    harness.state_mut().write_motion(&folder.path().join("no/folder.csv"));
    assert!(harness.state().message().is_some_and(|text| text.contains("there is no folder")));
}

#[test]
fn events_and_force_curve_are_those_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.csv");
    let mut harness = opened();
    harness.state_mut().session.switch_stops(true);
    harness.run_steps(30);
    harness.state_mut().write_events(&path);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("t_s,kind,side,v_in_m_per_s,v_out_m_per_s\n"), "{text}");
    assert_eq!(text.lines().count(), 1 + harness.state().session.player.watch().events().len());
    assert!(text.lines().count() > 1);
    harness.state_mut().write_curve(&path);
    let command =
        ["--headless", "curve", "first-look", "--set", "stops=Rigid(travel_limit_mm:1.5,restitution:0.36)"];
    let output = assert_cmd::Command::cargo_bin("interwell").unwrap().args(command).output().unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), String::from_utf8(output.stdout).unwrap());
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
