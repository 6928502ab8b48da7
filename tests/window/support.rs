//! A window that tests drive, and sessions without one.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{Key, Modifiers, Rect, Role, Shape, UiBuilder};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use interwell::app::session::Session;
use interwell::app::session::editor::Editor;
use interwell::app::ui::settings::Settings;
use interwell::app::window::Command;
use interwell::app::window::{Window, prepare};

use crate::shared::changed;

/// Sizes of a window: of a small screen, and of one that is shown by a projector.
pub const WIDE: [f32; 2] = [1280.0, 720.0];
pub const PROJECTED: [f32; 2] = [853.0, 480.0];

/// Longer than any answer takes on any machine: a test waits for what must come, and not for a time.
pub const LONG: Duration = Duration::from_secs(3600);

/// Waits for a condition, which must come.
pub fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !condition() {
        assert!(begin.elapsed() < LONG, "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Waits until no thread works for a window: each holds its wake to the end, as the window and its session
/// do.
pub fn wait_for_threads(window: &Window) {
    wait_until("threads end", || Arc::strong_count(&window.session.wake) == 2);
}

/// A window on a built-in scene, with its first answers there.
pub fn window(preset: &str, size: [f32; 2]) -> Harness<'static, Window> {
    window_with(preset, size, Settings::default())
}

/// The same with these settings.
pub fn window_with(preset: &str, size: [f32; 2], settings: Settings) -> Harness<'static, Window> {
    let mut window = Window::open(Some(preset), settings, Arc::new(|| ())).unwrap();
    window.session.wait_settled(LONG);
    // over the whole screen, as eframe draws it, and not within the margin of a harness
    let draw = |ui: &mut eframe::egui::Ui, window: &mut Window| {
        window.logic(&ui.ctx().clone());
        let screen = ui.ctx().content_rect();
        let mut whole = ui.new_child(UiBuilder::new().max_rect(screen));
        whole.set_clip_rect(screen);
        window.ui(&mut whole);
    };
    let mut harness =
        Harness::builder().with_size(size).with_context_setup(prepare).build_ui_state(draw, window);
    harness.run_steps(3);
    harness
}

/// Has the window do what a menu or a key would ask for.
pub fn command(harness: &mut Harness<'_, Window>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().carry_out(&ctx, command);
    harness.run_steps(3);
}

/// Clicks on what is called so, and lets some frames pass.
pub fn click_on(harness: &mut Harness<'_, Window>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// Clicks on a choice of the map in its menu.
pub fn choose_in_map(harness: &mut Harness<'_, Window>, label: &str) {
    click_on(harness, "Options");
    click_on(harness, label);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
}

/// Presses a key, and lets some frames pass.
pub fn press(harness: &mut Harness<'_, Window>, key: Key) {
    harness.key_press(key);
    harness.run_steps(3);
}

/// Presses a key with Ctrl, and lets some frames pass.
pub fn press_with_ctrl(harness: &mut Harness<'_, Window>, key: Key) {
    harness.key_press_modifiers(Modifiers::COMMAND, key);
    harness.run_steps(3);
}

/// A session on a built-in scene with fields changed, with what its motion settles to.
pub fn settled(preset: &str, changes: &[&str]) -> Session {
    let mut session = Session::new(Editor::new(changed(preset, changes)), Arc::new(|| ())).unwrap();
    session.wait_settled(LONG);
    session
}

/// A session on a built-in scene with fields changed, with all its answers.
pub fn session(preset: &str, changes: &[&str]) -> Session {
    let mut session = Session::new(Editor::new(changed(preset, changes)), Arc::new(|| ())).unwrap();
    session.wait(LONG);
    session
}

/// Whether the sentence that can be read on the window holds `words`; it is spoken as well.
pub fn says(harness: &Harness<'static, Window>, words: &str) {
    let read =
        harness.query_all_by_label_contains(words).filter(|node| node.accesskit_node().role() == Role::Label);
    assert_eq!(read.count(), 1, "{words}");
}

/// The texts that are painted, with plain spaces, where, and the part of the window in which they are seen.
pub fn painted(harness: &Harness<'static, Window>) -> Vec<(String, Rect, Rect)> {
    let plain = |text: String| text.replace('\u{a0}', " ");
    painted_as_is(harness).into_iter().map(|(text, at, clip)| (plain(text), at, clip)).collect()
}

/// The same with the spaces at which no line is broken.
pub fn painted_as_is(harness: &Harness<'static, Window>) -> Vec<(String, Rect, Rect)> {
    fn texts(shape: &Shape, clip: Rect, into: &mut Vec<(String, Rect, Rect)>) {
        match shape {
            Shape::Text(text) => {
                into.push((text.galley.text().to_owned(), text.visual_bounding_rect(), clip));
            }
            Shape::Vec(all) => all.iter().for_each(|shape| texts(shape, clip, into)),
            _ => {}
        }
    }
    let mut all = Vec::new();
    let screen = harness.ctx.content_rect();
    for clipped in &harness.output().shapes {
        texts(&clipped.shape, clipped.clip_rect.intersect(screen), &mut all);
    }
    all
}

/// Whether words are painted where they are seen.
pub fn is_painted(harness: &Harness<'static, Window>, words: &str) -> bool {
    painted(harness).iter().any(|text| text.0.contains(words) && text.2.intersects(text.1))
}

/// The texts of which a part is seen and a part is not.
pub fn sliced(harness: &Harness<'static, Window>) -> Vec<String> {
    described(&cut(harness))
}

fn described(texts: &[(String, Rect, Rect)]) -> Vec<String> {
    texts.iter().map(|text| format!("{} {:?} in {:?}", text.0, text.1, text.2)).collect()
}

fn cut(harness: &Harness<'static, Window>) -> Vec<(String, Rect, Rect)> {
    let is_cut = |label: &(String, Rect, Rect)| {
        let (text, clip) = (label.1.shrink(1.0), label.2);
        text.is_positive() && text.intersects(clip) && !clip.expand(0.5).contains_rect(text)
    };
    painted(harness).into_iter().filter(is_cut).collect()
}

/// The texts that are cut where they are and after the column that holds them was scrolled down.
pub fn out_of_reach(harness: &mut Harness<'static, Window>) -> Vec<String> {
    let mut lost = cut(harness);
    for (text, _, clip) in lost.clone() {
        crate::cursors::wheel(harness, clip.center(), Modifiers::NONE, -2000.0);
        let still = cut(harness);
        let is_there = painted(harness).iter().any(|shown| shown.0 == text);
        lost.retain(|(other, ..)| *other != text || !is_there || still.iter().any(|cut| cut.0 == text));
        crate::cursors::wheel(harness, clip.center(), Modifiers::NONE, 2000.0);
    }
    described(&lost)
}
