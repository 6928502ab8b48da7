//! A press is answered: keys without an effect and grey buttons say why, and dialogs keep to themselves.

use eframe::egui::{Event, Key, Modifiers, Order, PointerButton, Rect, accesskit::Role, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use interwell::app::ui::settings::{Setting, Settings};
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::dynamics::EventKind;
use interwell::scene::{Layout, PRESETS, Stops};

use crate::screen::Screen;
use crate::support::{
    LONG, PROJECTED, WIDE, click_on, command, is_painted, press, press_with_ctrl, window, window_with,
};

/// Has the notice gone, so that the next one is that of the next press.
fn forget_notice(harness: &mut Harness<'static, Window>) {
    while harness.state().notice().is_some() {
        harness.run_steps(30);
    }
}

fn notice<'a>(harness: &'a Harness<'static, Window>) -> &'a str {
    harness.state().notice().unwrap_or_default()
}

#[test]
fn a_key_that_does_nothing_says_why() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.player.set_playing(false);
    press_with_ctrl(&mut harness, Key::Num4);
    assert!(notice(&harness).starts_with("Your own arrangement begins as these views"));
    for (key, why) in [
        (Key::Z, "There is nothing to undo"),
        (Key::Y, "There is nothing to redo"),
        (Key::L, "No lesson is open"),
    ] {
        forget_notice(&mut harness);
        press_with_ctrl(&mut harness, key);
        assert_eq!(notice(&harness), why, "{key:?}");
    }
    command(&mut harness, Command::Arrange(Layout::Map));
    forget_notice(&mut harness);
    press_with_ctrl(&mut harness, Key::Tab);
    assert_eq!(notice(&harness), "No two views share a place");
    command(&mut harness, Command::Arrange(Layout::Look));
    let bar = harness.get_by_role_and_label(Role::Button, "Mechanism").rect();
    harness.hover_at(bar.left_bottom() + vec2(150.0, 60.0));
    harness.run_steps(2);
    for (key, why) in [
        (Key::R, "No release can come: there are no stops"),
        (Key::PageUp, "No event before"),
        (Key::I, "This view has no axes to hold or to zoom"),
        (Key::L, "This view has no axes to hold or to zoom"),
    ] {
        forget_notice(&mut harness);
        press(&mut harness, key);
        assert_eq!(notice(&harness), why, "{key:?}");
    }
    // in a lesson
    harness.state_mut().open_lesson("2");
    harness.run_steps(3);
    for key in [Key::Num2, Key::Num4] {
        forget_notice(&mut harness);
        press_with_ctrl(&mut harness, key);
        assert_eq!(notice(&harness), "A lesson has its own views: leave the lesson first");
    }
    for (key, why) in [
        (Key::K, "In a lesson no motion is pinned: leave the lesson first"),
        (Key::H, "There is no hint here: a task has one, until it is done"),
    ] {
        forget_notice(&mut harness);
        press(&mut harness, key);
        assert_eq!(notice(&harness), why, "{key:?}");
    }
    // where room is short, and in the projector
    let settings = Settings { projector: true, ..Settings::default() };
    let mut harness = window_with("bouncing-ball", PROJECTED, settings);
    press_with_ctrl(&mut harness, Key::Num4);
    assert!(notice(&harness).starts_with("You have no arrangement yet"));
    for (key, why) in [
        (Key::D, "The projector is light: P leaves it"),
        (Key::X, "No crossing can come: there is no barrier"),
    ] {
        forget_notice(&mut harness);
        press(&mut harness, key);
        assert_eq!(notice(&harness), why, "{key:?}");
    }
    forget_notice(&mut harness);
    press(&mut harness, Key::B);
    assert_eq!(notice(&harness), "Nothing shakes the mass: shake it first.");
}

/// Whether a hover text is on the screen.
fn has_hover_text(harness: &Harness<'static, Window>) -> bool {
    harness.ctx.memory(|memory| {
        let mut layers = memory.areas().visible_layer_ids().into_iter();
        let has_size = |id| memory.area_rect(id).is_some_and(|rect| rect.width() > 1.0);
        layers.any(|layer| layer.order == Order::Tooltip && has_size(layer.id))
    })
}

/// The grey buttons, check boxes and sliders that are shown, with their places and names.
fn grey(harness: &Harness<'static, Window>) -> Vec<(Rect, String)> {
    let mut grey = Vec::new();
    for role in [Role::Button, Role::CheckBox, Role::Slider, Role::ComboBox] {
        let all = harness.query_all_by_role(role).filter(|node| node.accesskit_node().is_disabled());
        grey.extend(all.map(|node| (node.rect(), node.accesskit_node().label().unwrap_or_default())));
    }
    grey
}

/// Hovers what is grey, but for what was so before, which a menu may cover; returns how many.
fn hover_what_is_grey(
    harness: &mut Harness<'static, Window>,
    before: &[(Rect, String)],
    what: &str,
) -> usize {
    let mut grey = grey(harness);
    grey.retain(|widget| !before.contains(widget));
    for (rect, name) in &grey {
        harness.hover_at(rect.center());
        harness.run_steps(60);
        assert!(has_hover_text(harness), "{what}: {name} at {rect:?}");
    }
    grey.len()
}

#[test]
fn what_is_grey_says_why() {
    let mut count = 0;
    for menu in ["File", "Edit", "View", "Motion", "Lessons", "Help"] {
        let mut harness = window("bouncing-ball", WIDE);
        harness.state_mut().session.player.set_playing(false);
        let before = grey(&harness);
        click_on(&mut harness, menu);
        count += hover_what_is_grey(&mut harness, &before, menu);
    }
    assert!(count >= 8, "{count}");
    for size in [WIDE, PROJECTED] {
        let mut harness = window("first-look", size);
        harness.state_mut().session.player.set_playing(false);
        if size == PROJECTED {
            click_on(&mut harness, "Controls");
        }
        harness.run_steps(3);
        assert!(hover_what_is_grey(&mut harness, &[], "first-look") >= 2, "{size:?}");
    }
    // the transport bar while a prediction covers the motion
    let mut harness = window("first-look", WIDE);
    harness.state_mut().open_lesson("2");
    while !harness.state().lesson().unwrap().is_covering() {
        press(&mut harness, Key::PageDown);
    }
    let play = harness.get_by_label("play").rect();
    harness.hover_at(play.center());
    harness.run_steps(60);
    assert!(is_painted(&harness, "First choose what you expect"));
}

#[test]
fn a_click_on_the_bar_of_time_works_while_it_plays() {
    let mut screen = Screen::new("first-look", WIDE);
    screen.ctx.enable_accesskit();
    screen.window.session.player.speed = 1.0;
    screen.steps(200);
    let bar = screen.nodes.iter().find(|node| node.label() == Some("time")).unwrap().bounds().unwrap();
    let now = screen.window.session.player.time();
    let seen = now / screen.window.session.end_of_run();
    let at = pos2((bar.x0 + 0.3 * seen * (bar.x1 - bar.x0)) as f32, bar.y0 as f32 + 20.0);
    screen.step(vec![Event::PointerMoved(at)]);
    // pressed and released between two frames
    let button = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    screen.step(vec![button(true), button(false)]);
    let player = &screen.window.session.player;
    let share = player.time() / now;
    assert!(player.is_past() && (0.2..0.4).contains(&share), "{share}");
    let then = player.time();
    screen.steps(5);
    // from there it goes on
    let player = &screen.window.session.player;
    assert!(player.is_playing() && player.time() > then && player.is_past());
}

#[test]
fn changes_are_discarded_only_where_there_are_some() {
    let mut harness = window("first-look", WIDE);
    assert!(harness.query_by_label("Discard changes").is_none());
    click_on(&mut harness, "Edit");
    harness.get_by_label_contains("From the start again");
    press(&mut harness, Key::Escape);
    harness.state_mut().session.switch_stops(true);
    harness.run_steps(3);
    click_on(&mut harness, "Discard changes");
    assert_eq!(harness.state().session.scene().stops, Stops::None);
    assert!(harness.query_by_label("Discard changes").is_none());
}

#[test]
fn play_is_not_asked_about() {
    let asked = |harness: &mut Harness<'static, Window>| {
        command(harness, Command::OpenPreset("duffing"));
        harness.query_by_label("Save the changes?").is_some()
    };
    for preset in PRESETS {
        let mut harness = window(preset.name, WIDE);
        harness.run_steps(30);
        press(&mut harness, Key::Space);
        press(&mut harness, Key::PageDown);
        assert!(!harness.state().session.editor.is_dirty() && !asked(&mut harness), "{}", preset.name);
    }
    // shaking, stops and start of a built-in scene are play, and what was made of it is not
    let mut harness = window("first-look", WIDE);
    let session = &mut harness.state_mut().session;
    session.set_number("excitation.amplitude_g", 1.3).unwrap();
    session.switch_stops(true);
    session.start_at(1e-3, 0.1);
    assert!(!asked(&mut harness));
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.set_number("excitation.phase_deg", 90.0).unwrap();
    assert!(asked(&mut harness));
}

#[test]
fn the_travel_limit_is_grey_while_the_stops_are_off() {
    let mut harness = window("first-look", WIDE);
    let limit = |harness: &Harness<'static, Window>| {
        let slider = harness.get_by_role_and_label(Role::Slider, "travel limit ±");
        (slider.accesskit_node().is_disabled(), slider.rect())
    };
    let (grey, at) = limit(&harness);
    assert!(grey);
    harness.hover_at(at.center());
    harness.run_steps(60);
    assert!(is_painted(&harness, "The stops are off."));
    harness.get_by_role_and_label(Role::CheckBox, "Stops").click();
    harness.run_steps(3);
    assert_eq!(limit(&harness), (false, at));
    // the frequency is among the first controls
    let frequency = harness.get_by_role_and_label(Role::Slider, "frequency").rect();
    assert!(frequency.bottom() < at.top());
}

#[test]
fn the_projector_keeps_a_view_that_fills_the_window() {
    for (preset, view) in [("first-look", View::Displacement), ("paper", View::Mechanism)] {
        let mut harness = window(preset, WIDE);
        click_on(&mut harness, &format!("fill the window with {}", view.name()));
        for _ in 0..3 {
            harness.key_press(Key::P);
            harness.run_steps(4);
            harness.get_by_label("all views");
            assert!(is_painted(&harness, view.name()));
        }
    }
}

#[test]
fn an_invalid_size_of_a_figure_goes_with_cancel() {
    let mut harness = window("first-look", WIDE);
    for key in [None, Some(Key::Escape)] {
        command(&mut harness, Command::Figure(Some(View::Displacement)));
        harness.state_mut().figures.width = "-3".to_owned();
        harness.state_mut().figures.font = "abc".to_owned();
        harness.run_steps(2);
        let save = harness.get_by_role_and_label(Role::Button, "Save");
        assert!(save.accesskit_node().is_disabled());
        match key {
            Some(key) => press(&mut harness, key),
            None => click_on(&mut harness, "Cancel"),
        }
        let figures = &harness.state().figures;
        assert_eq!([figures.width.as_str(), figures.font.as_str()], ["85", "8"]);
    }
}

#[test]
fn no_hover_text_stays_over_a_dialog() {
    for layout in [Layout::Look, Layout::Study] {
        let mut harness = window("paper", WIDE);
        command(&mut harness, Command::Arrange(layout));
        harness.state_mut().session.player.set_playing(false);
        harness.state_mut().session.wait(LONG);
        let mut seen = 0;
        for (i, share) in
            [(0.1, 0.2), (0.1, 0.3), (0.35, 0.4), (0.5, 0.7), (0.8, 0.3), (0.8, 0.8), (0.4, 0.07)]
                .into_iter()
                .enumerate()
        {
            harness.hover_at(pos2(share.0 * WIDE[0] + i as f32, share.1 * WIDE[1]));
            harness.run_steps(90);
            seen += usize::from(has_hover_text(&harness));
            for dialog in [Command::Shortcuts, Command::About, Command::Figure(None), Command::Glossary] {
                command(&mut harness, dialog.clone());
                forget_notice(&mut harness);
                assert!(!has_hover_text(&harness), "{dialog:?} {share:?}");
                press(&mut harness, Key::Escape);
            }
        }
        assert!(seen > 0);
    }
}

#[test]
fn the_window_is_made_larger_by_keys_that_are_listed() {
    let mut harness = window("first-look", WIDE);
    let zoom = |harness: &Harness<'static, Window>| (10.0 * harness.ctx.zoom_factor()).round();
    for (key, wanted) in [(Key::Plus, 11.0), (Key::Plus, 12.0), (Key::Minus, 11.0), (Key::Num0, 10.0)] {
        press_with_ctrl(&mut harness, key);
        assert_eq!(zoom(&harness), wanted, "{key:?}");
    }
    press(&mut harness, Key::P);
    press_with_ctrl(&mut harness, Key::Plus);
    press_with_ctrl(&mut harness, Key::Num0);
    assert_eq!(zoom(&harness), 15.0);
    press(&mut harness, Key::P);
    click_on(&mut harness, "View");
    harness.get_by_label_contains("Zoom of the window").click();
    harness.run_steps(3);
    for name in ["Larger", "Smaller", "Usual size"] {
        harness.get_by_label_contains(name);
    }
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::F1);
    harness.get_by_label("the whole window larger, smaller, at its usual size");
    press(&mut harness, Key::F1);
    // at another size it comes to rest as well
    let mut screen = Screen::new("first-look", WIDE);
    screen.ask(Command::PlayPause);
    screen.ask(Command::Magnify(1));
    screen.steps(3);
    screen.window.session.wait(LONG);
    screen.steps(60);
    assert_eq!(screen.stands, std::time::Duration::MAX);
}

#[test]
fn a_command_that_is_grey_in_the_menu_does_nothing() {
    let harness = window("first-look", WIDE);
    let window = harness.state();
    for (command, is_grey) in [
        (Command::Undo, true),
        (Command::GoTo(EventKind::Release), true),
        (Command::GoTo(EventKind::Crossing), false),
        (Command::LeaveLesson, true),
        (Command::Pin, false),
        (Command::Toggle(Setting::Dark), false),
    ] {
        assert_eq!(window.impossible(&command).is_some(), is_grey, "{command:?}");
    }
}
