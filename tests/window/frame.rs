//! The frame of the window: covers, keys, tabs, notes, ways through time, the size on the screen.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use eframe::egui::{self, Key, Rect, ViewportCommand, accesskit::Role, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use interwell::app::ui::settings::Settings;
use interwell::app::views::View;
use interwell::app::window::Command;
use interwell::app::window::{Place, Window};
use interwell::dynamics::EventKind;
use interwell::scene::{PRESETS, Stops};

use crate::support::{LONG, PROJECTED, WIDE, click_on, command, press, press_with_ctrl, window};

/// Lets frames pass until the motion has come to where it was sent.
fn arrive(harness: &mut Harness<'_, Window>) {
    for _ in 0..100_000 {
        if harness.state().session.player.goal().is_none() {
            break;
        }
        harness.run_steps(1);
    }
    harness.run_steps(2);
    assert!(harness.state().session.player.goal().is_none());
}

#[test]
fn covered_nothing_of_the_motion_is_seen() {
    let mut harness = window("paper", WIDE);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, true));
    }
    harness.state_mut().session.player.set_playing(false);
    press(&mut harness, Key::PageDown);
    let seen = |harness: &Harness<'static, Window>| {
        ["proof mass", "right stop", "crosses from", "Interwell: ", "impact, ", "Recompute"]
            .map(|name| harness.query_all_by_label_contains(name).count())
    };
    assert!(seen(&harness)[..4].iter().all(|count| *count > 0), "{:?}", seen(&harness));
    press(&mut harness, Key::C);
    assert_eq!(seen(&harness), [0; 6]);
    // neither by going back to the start nor by another scene
    press(&mut harness, Key::Home);
    assert_eq!(seen(&harness), [0; 6]);
    command(&mut harness, Command::OpenPreset("uneven-stops"));
    assert_eq!(seen(&harness), [0; 6]);
    press(&mut harness, Key::C);
    assert!(seen(&harness)[0] > 0);
}

#[test]
fn the_next_release_and_crossing_are_found() {
    let mut harness = window("paper", WIDE);
    for (key, kind, words) in
        [(Key::R, EventKind::Release, "release, "), (Key::X, EventKind::Crossing, "crossing to the ")]
    {
        let before = harness.state().session.player.time();
        press(&mut harness, key);
        arrive(&mut harness);
        let player = &harness.state().session.player;
        assert!(!player.is_playing() && player.time() > before);
        let event = *player.event().unwrap();
        assert_eq!(event.kind, kind);
        // a change acts from the present on, which is hardly later
        let later = player.watch().time() - event.t;
        assert!((0.0..0.05 * harness.state().session.model().characteristic_time()).contains(&later));
        // it is the first one
        let between = |other: &&interwell::dynamics::Event| other.t > before && other.t < event.t;
        assert!(player.watch().events().iter().filter(between).all(|other| other.kind != kind));
        harness.get_by_label_contains(words);
    }
    // where none can come that is said
    harness.state_mut().session.switch_stops(false);
    harness.run_steps(2);
    press(&mut harness, Key::R);
    assert_eq!(harness.state().notice(), Some("No release can come: there are no stops"));
    // and where none comes
    let mut harness = window("first-look", WIDE);
    press(&mut harness, Key::X);
    arrive(&mut harness);
    assert!(harness.state().notice().is_some_and(|text| text.starts_with("No crossing up to 100.")));
}

#[test]
fn the_end_of_the_run_is_reached_or_given_up() {
    let mut harness = window("paper", WIDE);
    let end = harness.state().session.model().duration();
    press(&mut harness, Key::End);
    arrive(&mut harness);
    assert_eq!(harness.state().session.player.time(), end);
    press(&mut harness, Key::End);
    assert!(harness.state().notice().is_some_and(|text| text.ends_with("before the time shown")));
    // after a change it lasts as long again, and any key gives it up
    harness.state_mut().session.edit_once(|scene| scene.run.duration_s = 1e6);
    harness.run_steps(2);
    assert_eq!(harness.state().session.end_of_run(), end + 1e6);
    press(&mut harness, Key::End);
    assert!(harness.state().session.player.goal().is_some() && harness.state().session.player.is_playing());
    let projector = harness.state().settings.projector;
    press(&mut harness, Key::P);
    let window = harness.state();
    assert!(window.session.player.goal().is_none() && !window.session.player.is_playing());
    assert_eq!(window.settings.projector, projector);
}

#[test]
fn it_can_be_faster_than_real_time() {
    let mut harness = window("duffing", WIDE);
    for (key, speed) in [(Key::Num6, 10.0), (Key::Num7, 100.0)] {
        press(&mut harness, key);
        let before = harness.state().session.player.time();
        harness.run_steps(10);
        let player = &harness.state().session.player;
        assert_eq!(player.speed, speed);
        assert!(player.time() - before > 0.1 * speed);
    }
}

#[test]
fn the_notes_are_read_in_the_column_and_in_full() {
    let mut harness = window("first-look", WIDE);
    let notes = harness.state().session.scene().notes.trim().to_owned();
    harness.get_by_label("About this scene");
    harness.get_by_label("Read on").click();
    harness.run_steps(3);
    assert_eq!(harness.state().message(), Some(notes.as_str()));
    press(&mut harness, Key::Enter);
    assert!(harness.state().message().is_none());
    harness.get_by_label("First look").click();
    harness.run_steps(3);
    assert_eq!(harness.state().message(), Some(notes.as_str()));
    press(&mut harness, Key::Escape);
    // what they tell is no longer so once something was changed
    harness.state_mut().session.switch_stops(true);
    harness.run_steps(3);
    harness.get_by_label("The scene before changes");
    assert!(harness.query_by_label("About this scene").is_none());
    // a projected window has no room for them
    let mut harness = window("first-look", PROJECTED);
    assert!(harness.query_by_label("About this scene").is_none());
    harness.get_by_label("First look").click();
    harness.run_steps(3);
    assert_eq!(harness.state().message(), Some(notes.as_str()));
}

#[test]
fn where_room_is_short_well_and_mechanism_are_seen() {
    let harness = window("uneven-stops", PROJECTED);
    assert_eq!(harness.query_all_by_label("proof mass").count(), 2);
    let tab = |name| harness.get_by_label(name).rect();
    assert!(tab("Displacement").left() > tab("Mechanism").left());
}

#[test]
fn the_controls_of_a_narrow_window_open_beside_the_views() {
    let mut harness = window("paper", PROJECTED);
    assert!(harness.query_by_role_and_label(Role::Slider, "preload").is_none());
    click_on(&mut harness, "Controls");
    let column = harness.get_by_role_and_label(Role::Slider, "preload").rect();
    let masses: Vec<Rect> = harness.query_all_by_label("proof mass").map(|mass| mass.rect()).collect();
    assert!(masses.len() == 2 && masses.iter().all(|rect| rect.left() > column.right()), "{masses:?}");
    click_on(&mut harness, "Controls");
    assert!(harness.query_by_role_and_label(Role::Slider, "preload").is_none());
}

#[test]
fn words_say_what_they_mean() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.player.set_playing(false);
    click_on(&mut harness, "Compare");
    let labels = [
        ("reach", "largest distance from the middle"),
        ("crosses from", "least shaking at this frequency"),
        ("RMS velocity", "root of the mean square"),
        ("interwell", "It crosses from well to well"),
    ];
    let mut places: Vec<(egui::Pos2, &str)> =
        labels.map(|(label, words)| (harness.get_by_label(label).rect().center(), words)).to_vec();
    // the drawing says its scale, the bulge and the motion of the base
    let drawing = harness.get_by_role_and_label(Role::Button, "Mechanism").rect().left_bottom();
    let foot = harness.get_by_label("Well").rect().top();
    for words in ["across the flexures.", "Bulge ", "The base moves by ±"] {
        places.push((pos2(drawing.x + 40.0, foot - 36.0), words));
    }
    for (at, words) in places {
        harness.hover_at(at);
        harness.run_steps(90);
        assert!(harness.query_by_label_contains(words).is_some(), "{words}");
        harness.hover_at(pos2(5.0, 5.0));
        harness.run_steps(30);
    }
}

#[test]
fn the_mechanism_has_its_share_of_the_height() {
    for key in [Key::Num1, Key::Num2] {
        let mut harness = window("paper", WIDE);
        press_with_ctrl(&mut harness, key);
        let top = |name| harness.get_by_role_and_label(Role::Button, name).rect().top();
        // the bar below the views is 60 points high
        let share = (top("Well") - top("Mechanism")) / (WIDE[1] - 60.0 - top("Mechanism"));
        assert!((0.39..0.42).contains(&share), "{share}");
    }
}

#[test]
fn tabs_go_round_by_key() {
    let mut harness = window("paper", PROJECTED);
    harness.hover_at(pos2(700.0, 300.0));
    harness.run_steps(2);
    assert_eq!(harness.query_all_by_label("proof mass").count(), 2);
    for (count, is_card) in [(1, false), (1, true), (2, false)] {
        press_with_ctrl(&mut harness, Key::Tab);
        assert_eq!(harness.query_all_by_label("proof mass").count(), count);
        assert_eq!(harness.query_by_label("crosses from").is_some(), is_card);
    }
}

#[test]
fn escape_leaves_a_view_over_the_window() {
    let mut harness = window("paper", WIDE);
    click_on(&mut harness, "Compare");
    harness.get_by_label("fill the window with Displacement").click();
    harness.run_steps(3);
    harness.get_by_label("all views");
    assert!(harness.query_by_label("crosses from").is_none());
    press(&mut harness, Key::Escape);
    harness.get_by_label("crosses from");
}

#[test]
fn space_presses_what_has_the_focus() {
    let mut harness = window("paper", WIDE);
    assert!(harness.state().session.player.is_playing());
    harness.get_by_role_and_label(Role::CheckBox, "Stops").focus();
    harness.run_steps(2);
    press(&mut harness, Key::Space);
    assert_eq!(harness.state().session.scene().stops, Stops::None);
    assert!(harness.state().session.player.is_playing());
    // a slider is not pressed
    harness.get_by_role_and_label(Role::Slider, "amplitude").focus();
    harness.run_steps(2);
    press(&mut harness, Key::Space);
    assert!(!harness.state().session.player.is_playing());
}

/// The outlines that are painted in the colour of the focus.
fn rings(harness: &Harness<'static, Window>) -> Vec<Rect> {
    let color = interwell::app::ui::style::Style { dark: false, projector: false }.focus_stroke().color;
    let outline = |shape: &egui::epaint::ClippedShape| match &shape.shape {
        egui::Shape::Rect(rect) if rect.stroke.color == color && rect.stroke.width > 1.5 => {
            Some(rect.rect.intersect(shape.clip_rect))
        }
        _ => None,
    };
    harness.output().shapes.iter().filter_map(outline).collect()
}

#[test]
fn nothing_has_the_focus_unseen() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.player.set_playing(false);
    press_with_ctrl(&mut harness, Key::Num2);
    let mut stops = 0;
    for _ in 0..60 {
        press(&mut harness, Key::Tab);
        let Some(id) = harness.ctx.memory(egui::Memory::focused) else { continue };
        if harness.ctx.text_edit_focused() {
            continue;
        }
        let rect = harness.ctx.read_response(id).unwrap().rect;
        let around = |ring: &Rect| ring.contains_rect(rect) && ring.width() < rect.width() + 8.0;
        let seen = rings(&harness).iter().any(around);
        assert!(seen, "{rect:?}");
        stops += 1;
    }
    assert!(stops > 20, "{stops}");
}

#[test]
fn a_box_has_an_edge_that_is_seen() {
    // relative luminance of a grey, and the contrast of two
    let luminance = |color: egui::Color32| f64::from(egui::Rgba::from(color).intensity());
    for theme in [egui::Theme::Light, egui::Theme::Dark] {
        let ctx = egui::Context::default();
        interwell::app::window::prepare(&ctx);
        let visuals = ctx.style_of(theme).visuals.clone();
        let (edge, ground) = (visuals.widgets.inactive.bg_stroke.color, visuals.panel_fill);
        let (a, b) = (luminance(edge) + 0.05, luminance(ground) + 0.05);
        assert!(a.max(b) / a.min(b) >= 3.0, "{theme:?}: {edge:?} on {ground:?}");
    }
}

#[test]
fn what_is_on_the_list_of_keys_does_not_overlap() {
    for size in [WIDE, PROJECTED] {
        let mut harness = window("paper", size);
        press(&mut harness, Key::F1);
        let (heading, first) = (harness.get_by_label("Keys").rect(), harness.get_by_label("Time").rect());
        assert!(first.top() >= heading.bottom(), "{heading:?} {first:?}");
        assert!(harness.get_by_label("Close").rect().bottom() < size[1]);
    }
}

#[test]
fn a_scene_that_cannot_be_opened_is_said_in_the_window() {
    let spec = Some("/nowhere/at/all.ron");
    let window = Window::start(spec, Settings::default(), std::sync::Arc::new(|| ())).unwrap();
    assert!(window.message().is_some_and(|text| text.contains("/nowhere/at/all.ron: no such file")));
    assert_eq!(window.session.editor.origin().as_deref(), Some(PRESETS[0].name));
}

/// The commands to the window of a frame in which it has these sizes in points at zoom 1.
fn asked_of_the_screen(
    window: &mut Window,
    ctx: &egui::Context,
    inner: [f32; 2],
    outer: [f32; 2],
) -> Vec<ViewportCommand> {
    let mut input = egui::RawInput::default();
    let [inner, outer] = [inner, outer].map(|size| egui::Vec2::from(size) / ctx.zoom_factor());
    let view = input.viewports.entry(egui::ViewportId::ROOT).or_default();
    view.inner_rect = Some(Rect::from_min_size(pos2(0.0, 30.0), inner));
    view.outer_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), outer));
    view.monitor_size = Some(vec2(1280.0, 720.0) / ctx.zoom_factor());
    input.screen_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), inner));
    let mut output = ctx.run_ui(input, |ui| {
        window.logic(&ui.ctx().clone());
        window.ui(ui);
    });
    // no graphics want them
    output.textures_delta.clear();
    let commands = output.viewport_output[&egui::ViewportId::ROOT].commands.iter();
    let sizes = |command: &&ViewportCommand| {
        matches!(command, ViewportCommand::InnerSize(_) | ViewportCommand::Maximized(_))
    };
    commands.filter(sizes).cloned().collect()
}

#[test]
fn the_window_fits_the_screen_and_keeps_its_size() {
    let open = |settings| Window::open(Some("paper"), settings, std::sync::Arc::new(|| ())).unwrap();
    let ctx = egui::Context::default();
    interwell::app::window::prepare(&ctx);
    let frames = |window: &mut Window, inner, outer| -> Vec<ViewportCommand> {
        (0..6).flat_map(|_| asked_of_the_screen(window, &ctx, inner, outer)).collect()
    };
    // with its frame it is larger than the screen
    let mut window = open(Settings::default());
    assert_eq!(frames(&mut window, WIDE, [1280.0, 750.0]), [ViewportCommand::Maximized(true)]);
    assert_eq!(window.size(), Some(WIDE));
    assert!(frames(&mut window, WIDE, [1280.0, 750.0]).is_empty());
    // a projected one comes back at the size that it had in pixels
    let mut window = open(Settings { projector: true, ..Settings::default() });
    window.restore_size(Some([1200.0, 660.0]));
    let small = [800.0, 440.0];
    assert_eq!(frames(&mut window, small, small), [ViewportCommand::InnerSize(vec2(800.0, 440.0))]);
    let whole = [1200.0, 660.0];
    frames(&mut window, whole, whole);
    assert_eq!(window.size(), Some(whole));
    // its letters follow the height of the window, and are larger in a view over the whole of it
    assert_eq!(ctx.zoom_factor(), 1.375);
    for (size, zoom) in [([1920.0, 1080.0], 2.25), ([1024.0, 768.0], 1024.0 / 740.0), ([1280.0, 720.0], 1.5)]
    {
        frames(&mut window, size, size);
        frames(&mut window, size, size);
        assert_eq!(ctx.zoom_factor(), zoom, "{size:?}");
    }
    // Ctrl+0 comes back to that
    ctx.set_zoom_factor(1.0);
    frames(&mut window, WIDE, WIDE);
    assert_eq!(ctx.zoom_factor(), 1.0);
    window.carry_out(&ctx, Command::Magnify(0));
    frames(&mut window, WIDE, WIDE);
    assert_eq!(ctx.zoom_factor(), 1.5);
    window.carry_out(&ctx, Command::Fill);
    frames(&mut window, WIDE, WIDE);
    assert_eq!(ctx.zoom_factor(), 1.875);
}

#[test]
fn the_lecturers_notes_open_beside_the_window_and_where_they_were_left() {
    let ctx = egui::Context::default();
    interwell::app::window::prepare(&ctx);
    ctx.set_embed_viewports(false);
    // the screen: what the notes were asked to be, and where they are
    let asked: Rc<RefCell<Option<egui::ViewportBuilder>>> = Rc::default();
    let shown = Rc::new(Cell::new(Rect::NOTHING));
    let (told, place) = (Rc::clone(&asked), Rc::clone(&shown));
    egui::Context::set_immediate_viewport_renderer(move |ctx, mut notes| {
        told.replace(Some(notes.builder.clone()));
        let mut input = egui::RawInput { viewport_id: notes.ids.this, ..egui::RawInput::default() };
        let view = input.viewports.entry(notes.ids.this).or_default();
        if place.get().is_positive() {
            (view.outer_rect, view.inner_rect) = (Some(place.get()), Some(place.get()));
        }
        ctx.run_ui(input, |ui| (notes.viewport_ui_cb)(ui)).textures_delta.clear();
    });
    let frames = |window: &mut Window| -> Option<(Option<egui::Pos2>, [f32; 2])> {
        (0..3).for_each(|_| _ = asked_of_the_screen(window, &ctx, [800.0, 600.0], [800.0, 600.0]));
        asked.borrow().as_ref().map(|viewport| (viewport.position, viewport.inner_size.unwrap().into()))
    };
    let open = || {
        let lesson = interwell::scene::lesson::LESSONS[0].name;
        Window::open(Some(lesson), Settings::default(), std::sync::Arc::new(|| ())).unwrap()
    };
    let mut window = open();
    assert_eq!(frames(&mut window), None);
    window.carry_out(&ctx, Command::LecturerNotes);
    // at the right of the window, as wide as the screen of 1280 points leaves room
    let beside = Some((Some(pos2(808.0, 0.0)), [472.0, 420.0]));
    assert_eq!(frames(&mut window), beside);
    // moved by hand, they are left alone
    shown.set(Rect::from_min_size(pos2(100.0, 50.0), vec2(400.0, 300.0)));
    assert_eq!(frames(&mut window), beside);
    window.carry_out(&ctx, Command::LecturerNotes);
    frames(&mut window);
    window.carry_out(&ctx, Command::LecturerNotes);
    assert_eq!(frames(&mut window), Some((Some(pos2(100.0, 50.0)), [400.0, 300.0])));
    // at another start as well, unless that is on a screen that is gone
    let kept = window.notes_place();
    for (at, expected) in [([100.0, 50.0], pos2(100.0, 50.0)), ([2000.0, 50.0], pos2(808.0, 0.0))] {
        let mut window = open();
        window.restore_notes_place(kept.map(|place| Place { at, ..place }));
        window.carry_out(&ctx, Command::LecturerNotes);
        assert_eq!(frames(&mut window), Some((Some(expected), [400.0, 300.0])));
    }
}

#[test]
fn the_time_until_the_motion_has_settled_can_be_skipped() {
    for size in [WIDE, PROJECTED] {
        let mut harness = window("first-look", size);
        harness.run_steps(10);
        harness.state_mut().session.switch_stops(true);
        harness.state_mut().session.wait_settled(LONG);
        harness.run_steps(3);
        assert!(harness.state().session.sentence().text.contains("will cross twice a period"));
        harness.get_by_label_contains("skip settling").click();
        harness.run_steps(1);
        arrive(&mut harness);
        let session = &harness.state().session;
        assert!(session.settling().is_none() && session.player.is_playing() && session.player.time() < 3.0);
        assert!(session.sentence().text.contains("crosses twice a period"), "{}", session.sentence().text);
        assert!(harness.query_by_label_contains("skip settling").is_none());
        assert_eq!(harness.state().notice(), None);
    }
}

#[test]
fn an_event_is_named_by_what_happened() {
    let mut harness = window("paper", WIDE);
    let mut kinds = Vec::new();
    for _ in 0..8 {
        press(&mut harness, Key::PageDown);
        let event = *harness.state().session.player.event().unwrap();
        let words = match event.kind {
            EventKind::Impact => {
                let speed = |v: f64| interwell::app::words::status::speed(v.abs());
                format!("impact, {}, {} to {} mm/s", event.side.name(), speed(event.v_in), speed(event.v_out))
            }
            EventKind::Crossing => "crossing to the ".to_owned(),
            kind => kind.name().to_owned(),
        };
        harness.get_by_label_contains(&words);
        kinds.push(event.kind);
    }
    assert!(kinds.contains(&EventKind::Impact) && kinds.contains(&EventKind::Crossing), "{kinds:?}");
    press(&mut harness, Key::Space);
    assert!(harness.state().session.player.event().is_none());
}

/// Each stop has its restitution among the first sliders, and no control is called by its path.
#[test]
fn the_first_sliders_have_names_in_every_scene() {
    for (preset, count) in [("paper", 1), ("uneven-stops", 2), ("bouncing-ball", 1)] {
        let harness = window(preset, WIDE);
        let sliders =
            harness.query_all_by_role(Role::Slider).filter_map(|slider| slider.accesskit_node().label());
        let named: Vec<String> = sliders.filter(|label| label.contains("restitution")).collect();
        assert_eq!(named.len(), count, "{preset}: {named:?}");
    }
    for entry in PRESETS {
        let harness = window(entry.name, WIDE);
        let sliders = harness.query_all_by_role(Role::Slider);
        let named: Vec<String> = sliders.filter_map(|slider| slider.accesskit_node().label()).collect();
        assert!(
            !named.is_empty() && !named.iter().any(|name| name.contains('.')),
            "{}: {named:?}",
            entry.name
        );
    }
}
