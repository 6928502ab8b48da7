//! What leaves the window: copied scenes and command lines, written motions, events, curves and runs.

use eframe::egui::{Event, OutputCommand};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::window::Command;
use interwell::app::window::Window;
use interwell::scene::Layout;

use crate::documents::{harness_text, opened, title};
use crate::support::{LONG, WIDE, command, window};

pub fn copied(harness: &Harness<'static, Window>) -> Option<String> {
    harness.output().platform_output.commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    })
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
    command(&mut harness, Command::CopyCommand);
    assert!(harness.state().message().is_some_and(|text| text.contains("save it first")));
}

#[test]
fn a_link_opens_the_scene_with_its_changes() {
    let mut harness = opened();
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    harness.step();
    let ctx = harness.ctx.clone();
    harness.state_mut().carry_out(&ctx, Command::CopyLink);
    harness.step();
    let link = copied(&harness).unwrap();
    assert!(link.starts_with("?scene=first-look#"), "{link}");
    // in another window: by argument, and pasted
    let linked = window(&link, WIDE);
    let mut pasted = window("paper", WIDE);
    pasted.event(Event::Paste(link.clone()));
    pasted.run_steps(3);
    for other in [&linked, &pasted] {
        let (here, there) = (&harness.state().session, &other.state().session);
        assert_eq!(there.scene(), here.scene());
        let line = interwell::app::export::command_line(there).unwrap().0;
        assert_eq!(line, "interwell --headless simulate first-look --set mass_g=16");
    }
    linked.get_by_label("The scene before changes");
    let mut lesson = window("?lesson=03-a-stop-that-helps", WIDE);
    lesson.run_steps(2);
    assert!(lesson.state().lesson().is_some());
    pasted.event(Event::Paste(link[..link.len() - 3].to_owned()));
    pasted.run_steps(3);
    assert!(pasted.state().message().is_some_and(|text| text.contains("copy the whole link")));
    assert_eq!(pasted.state().session.scene(), harness.state().session.scene());
}

#[test]
fn the_command_line_says_what_is_shown() {
    let mut harness = opened();
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    harness.step();
    harness.state_mut().session.restart();
    let ctx = harness.ctx.clone();
    harness.state_mut().carry_out(&ctx, Command::CopyCommand);
    harness.step();
    assert_eq!(copied(&harness).unwrap(), "interwell --headless simulate first-look --set mass_g=16");
    assert!(harness.state().notice().is_some_and(|text| text.starts_with("Copied: ")));
}

/// The words of a copied command as its arguments.
pub fn arguments(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut is_quoted = false;
    for c in line.strip_prefix("interwell ").unwrap().chars() {
        match c {
            '\'' => is_quoted = !is_quoted,
            ' ' if !is_quoted => words.push(String::new()),
            c => words.last_mut().unwrap().push(c),
        }
    }
    words
}

#[test]
fn a_motion_that_was_changed_on_its_way_is_reproduced() {
    for preset in ["first-look", "uneven-stops", "bouncing-ball"] {
        let mut harness = window(preset, WIDE);
        harness.state_mut().session.player.speed = 1.0;
        harness.run_steps(50);
        harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
        harness.run_steps(30);
        let ctx = harness.ctx.clone();
        harness.state_mut().carry_out(&ctx, Command::CopyCommand);
        harness.step();
        let line = copied(&harness).unwrap();
        assert!(line.contains("start"), "{line}");
        assert!(harness.state().notice().is_some_and(|text| text.ends_with("present state on")));
        // the frame after the copy has gone on already
        let session = &mut harness.state_mut().session;
        let here = interwell::app::export::command_line(session).unwrap().0;
        let output =
            assert_cmd::Command::cargo_bin("interwell").unwrap().args(arguments(&here)).output().unwrap();
        assert!(output.status.success(), "{here}: {}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).unwrap();
        let mut lines = text.lines();
        let x = lines.next().unwrap().split(',').position(|name| name == "x_m").unwrap();
        let rows: Vec<Vec<&str>> = lines.take(120).map(|line| line.split(',').collect()).collect();
        let begin = session.player.watch().time();
        let number = |text: &str| text.parse::<f64>().unwrap();
        for row in &rows {
            session.player.seek(f64::INFINITY);
            session.player.go_to(interwell::app::session::player::Goal::Time(begin + number(row[0])));
            while session.player.goal().is_some() {
                session.player.tick(0.0);
            }
            let (ours, theirs) = (session.player.state().x, number(row[x]));
            assert!((ours - theirs).abs() < 1e-7, "{here}: {ours} {theirs} at {}", row[0]);
        }
    }
}

#[test]
fn a_motion_that_no_scene_continues_is_said_to_be_another() {
    let mut harness = window("paper-ramp", WIDE);
    harness.run_steps(5);
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    harness.run_steps(5);
    command(&mut harness, Command::CopyCommand);
    assert!(harness.state().notice().is_some_and(|text| text.ends_with("and is another")));
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
fn a_pasted_scene_has_no_command_for_its_map() {
    let mut harness = opened();
    harness.event(Event::Paste(harness_text().replace("First look", "Pasted")));
    harness.run_steps(3);
    command(&mut harness, Command::Arrange(Layout::Map));
    command(&mut harness, Command::CopyMapCommand);
    assert!(harness.state().message().is_some_and(|text| text.contains("save it first")));
    assert_eq!(copied(&harness), None);
}

#[test]
fn the_whole_run_is_written_as_the_command_line_writes_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    let mut harness = opened();
    harness.state_mut().write_run(path.clone());
    harness.state_mut().wait_for_run(LONG);
    assert_eq!(harness.state().notice(), Some("Saved run.csv"));
    let command = ["--headless", "simulate", "first-look"];
    let output = assert_cmd::Command::cargo_bin("interwell").unwrap().args(command).output().unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), String::from_utf8(output.stdout).unwrap());
}
