//! Nothing moves but what the person moves: places of the views under gestures, hints, toasts and verdicts.

use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, accesskit::Role, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use interwell::app::views::View;
use interwell::app::window::Command;
use interwell::dynamics::EventKind;
use interwell::scene::{Layout, PRESETS};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

use crate::screen::Screen;
use crate::support::{LONG, PROJECTED, WIDE, command, painted, painted_as_is, press, window};

const GESTURES: usize = 200;

fn places(screen: &Screen) -> Vec<(View, Rect)> {
    let place = |view: View| Some((view, screen.window.tiling.place_of(view)?));
    View::ALL.into_iter().filter_map(place).collect()
}

/// A gesture that is none on the arrangement: its name, and the events of each of its frames.
fn gesture(random: &mut ChaCha8Rng, screen: &mut Screen) -> (String, Vec<Vec<Event>>) {
    let mut below = |count: usize| random.next_u32() as usize % count;
    let wanted = match below(10) {
        0..=3 => Role::Slider,
        4..=5 => Role::CheckBox,
        6 => Role::Label,
        _ => Role::Unknown,
    };
    if wanted == Role::Unknown {
        let (keys, commands) = (
            [Key::Space, Key::PageDown, Key::PageUp, Key::H, Key::Home, Key::K, Key::B, Key::C, Key::Num5],
            [
                Command::Undo,
                Command::Redo,
                Command::BestStops,
                Command::Step,
                Command::GoTo(EventKind::Crossing),
            ],
        );
        let at = below(keys.len() + commands.len());
        let Some(key) = keys.get(at) else {
            let command = commands[at - keys.len()].clone();
            screen.ask(command.clone());
            return (format!("{command:?}"), vec![Vec::new()]);
        };
        let event = |pressed| Event::Key {
            key: *key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        return (format!("{key:?}"), vec![vec![event(true), event(false)]]);
    }
    let bounds = |node: &eframe::egui::accesskit::Node| {
        let area = node.bounds().filter(|_| node.role() == wanted)?;
        Some(Rect::from_min_max(pos2(area.x0 as f32, area.y0 as f32), pos2(area.x1 as f32, area.y1 as f32)))
    };
    let all: Vec<Rect> = screen.nodes.iter().filter_map(bounds).collect();
    let (rect, share) = (all[below(all.len())], below(100) as f32 / 100.0);
    let at = rect.min + vec2(share, 0.5) * rect.size();
    // within its view: the space between two views is dragged to make one wider
    let home = places(screen).into_iter().find(|place| place.1.contains(rect.center()));
    let at = home.map_or(at, |place| place.1.shrink(6.0).clamp(at));
    let button = |pos: Pos2, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let mut frames = vec![vec![Event::PointerMoved(at)]];
    if wanted != Role::Label {
        let to = at + vec2(below(60) as f32 - 30.0, 0.0);
        let to = if wanted == Role::Slider { to } else { at };
        frames.extend([vec![button(at, true)], vec![Event::PointerMoved(to)], vec![button(to, false)]]);
    }
    (format!("{wanted:?} at {at:?}"), frames)
}

/// Opens the controls of a narrow window, which has a button for them.
fn open_controls(screen: &mut Screen) {
    let is_button = |node: &&eframe::egui::accesskit::Node| node.label() == Some("Controls");
    let Some(area) = screen.nodes.iter().find(is_button).and_then(|node| node.bounds()) else { return };
    let pos = pos2(0.5 * (area.x0 + area.x1) as f32, 0.5 * (area.y0 + area.y1) as f32);
    for pressed in [true, false] {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        screen.step(vec![Event::PointerMoved(pos), Event::PointerButton { pos, button, pressed, modifiers }]);
    }
    screen.steps(3);
}

#[test]
fn no_gesture_moves_a_view() {
    for (preset, layout, size) in [
        ("first-look", Layout::Look, WIDE),
        ("first-look", Layout::Look, PROJECTED),
        ("paper", Layout::Study, WIDE),
        ("bouncing-ball", Layout::Look, [600.0, 400.0]),
    ] {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut screen = Screen::new(preset, size);
        screen.ctx.enable_accesskit();
        screen.ask(Command::Arrange(layout));
        screen.steps(3);
        open_controls(&mut screen);
        let mut before = places(&screen);
        assert!(!before.is_empty());
        for _ in 0..GESTURES {
            let (what, frames) = gesture(&mut random, &mut screen);
            for events in frames {
                screen.step(events);
            }
            screen.window.session.wait_settled(LONG);
            screen.steps(2);
            if what == "Home" {
                // the start has the arrangement as it was opened
                before = places(&screen);
            }
            assert_eq!(places(&screen), before, "{preset} {size:?} after {what}");
        }
    }
}

#[test]
fn the_lines_above_the_views_are_low_and_keep_their_height() {
    for preset in PRESETS {
        let mut harness = window(preset.name, WIDE);
        let top = |harness: &egui_kittest::Harness<'static, interwell::app::window::Window>| {
            let tiling = &harness.state().tiling;
            let tops = View::ALL.into_iter().filter_map(|view| Some(tiling.place_of(view)?.top()));
            tops.reduce(f32::min).unwrap()
        };
        let before = top(&harness);
        assert!(before <= 96.0, "{}: {before}", preset.name);
        press(&mut harness, Key::H);
        harness.state_mut().session.wait(LONG);
        harness.run_steps(2);
        assert_eq!(top(&harness), before, "{}", preset.name);
        press(&mut harness, Key::H);
        press(&mut harness, Key::B);
        assert_eq!(top(&harness), before, "{}", preset.name);
    }
}

#[test]
fn the_guide_line_holds_its_longest_text_and_its_buttons_stand_at_the_right() {
    for size in [WIDE, PROJECTED] {
        let mut harness = window("first-look", size);
        let right = harness.get_by_label("Dismiss").rect();
        let session = &mut harness.state_mut().session;
        session.player.speed = 1.0;
        session.switch_stops(true);
        session.wait_settled(LONG);
        harness.run_steps(60);
        let session = &mut harness.state_mut().session;
        session.edit_once(|scene| scene.stops.set_limit(true, 3.5));
        session.wait_settled(LONG);
        harness.run_steps(3);
        harness.get_by_label("What stops do:");
        assert_eq!(harness.get_by_label("Dismiss").rect(), right, "{size:?}");
        let all = painted(&harness);
        let (_, text, clip) =
            all.iter().find(|label| label.0.starts_with("near the middle they hold")).unwrap();
        assert!(clip.expand(1.0).contains_rect(*text) && text.right() < right.left(), "{text:?} {clip:?}");
        // it leaves with the stops
        harness.state_mut().session.switch_stops(false);
        harness.run_steps(3);
        assert!(harness.query_by_label("What stops do:").is_none());
        assert!(harness.query_by_label("Dismiss").is_none());
    }
}

#[test]
fn a_number_keeps_its_unit_and_code_has_no_backticks() {
    use interwell::app::words::numbers::unbroken;
    let nbsp = "0.718\u{a0}g at 3\u{a0}Hz, 49\u{a0}mm/s. 2 stops, 94\u{a0}% (5\u{a0}N s/m)";
    assert_eq!(unbroken("0.718 g at 3 Hz, 49 mm/s. 2 stops, 94 % (5 N s/m)"), nbsp);
    for preset in PRESETS {
        let mut harness = window(preset.name, WIDE);
        command(&mut harness, Command::Notes);
        let notes = harness.state().message().unwrap().replace('`', "");
        let all = painted_as_is(&harness);
        let plain = |text: &str| text.replace('\u{a0}', " ");
        let shown = all.iter().find(|text| plain(&text.0) == notes);
        let (text, ..) = shown.unwrap_or_else(|| panic!("{}: {notes}", preset.name));
        assert_eq!(*text, unbroken(&notes), "{}", preset.name);
    }
}

#[test]
fn notes_begin_with_two_sentences() {
    for preset in PRESETS {
        let mut harness = window(preset.name, [1280.0, 900.0]);
        let notes = harness.state().session.scene().notes.trim().to_owned();
        let begin = notes.chars().take_while(|letter| *letter != '`').take(30).collect::<String>();
        let all = painted(&harness);
        let shown = all.iter().map(|text| &text.0).find(|text| text.starts_with(&begin)).unwrap();
        let ends = shown.match_indices(". ").count();
        assert!(shown.ends_with('.') && ends <= 1, "{}: {shown}", preset.name);
        harness.get_by_label("Read on").click();
        harness.run_steps(3);
        assert_eq!(harness.state().message(), Some(notes.as_str()));
    }
}
