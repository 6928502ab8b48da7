//! Keys of the commands, and the list of keys that F1 shows.

use eframe::egui::{
    self, Align, Context, Key, KeyboardShortcut, Label, Layout, Modifiers, Popup, RichText, Ui, vec2,
};

use crate::app::session::player::SPEEDS;
use crate::app::ui::settings::Setting;
use crate::app::ui::widgets::{close_ui, dialog_ui};

use super::command::{Command, Listed, Part, parts};

/// The keys of the speeds, slowest first.
pub(super) const SPEED_KEYS: [Key; SPEEDS.len()] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7];

/// Headings of the list of keys, in two columns; in a lesson its keys are the first.
const GROUPS: [&[&str]; 2] = [&["Time", "Hands", "Lesson"], &["Views", "Scene"]];
const IN_LESSON: [&[&str]; 2] = [&["Lesson", "Time", "Hands"], &["Views", "Scene"]];
/// Width in points from which the two columns are side by side.
const SIDE_BY_SIDE: f32 = 880.0;
/// Width in points of the list, of its column of keys, and between two columns of commands.
const LIST: f32 = 1220.0;
const KEYS: f32 = 150.0;
const BETWEEN: f32 = 24.0;
/// Width in points that what a key does has at least.
const LEAST_TEXT: f32 = 60.0;

/// The commands of the pressed keys; none while text is edited. To be called only while no dialog is open.
pub fn pressed(ctx: &Context, filled: bool) -> Vec<Command> {
    let mut commands = Vec::new();
    if ctx.text_edit_focused() {
        return commands;
    }
    let speeds = SPEED_KEYS.into_iter().enumerate();
    let speeds = speeds.map(|(i, key)| (KeyboardShortcut::new(Modifiers::NONE, key), Command::Speed(i)));
    let keys = parts().filter_map(|part| match part {
        Part::Item(_, Some(key), command, _) | Part::Hidden(Some(key), command, _) => {
            Some((*key, command.clone()))
        }
        _ => None,
    });
    let (shifted, others): (Vec<_>, Vec<_>) = keys.chain(speeds).partition(|(key, _)| key.modifiers.shift);
    // keys with Shift first: those without would consume them
    for (key, command) in shifted.into_iter().chain(others) {
        if is_free(ctx, &key, &command, filled) && ctx.input_mut(|input| input.consume_shortcut(&key)) {
            commands.push(command);
        }
    }
    commands
}

/// Whether a key now triggers its command.
fn is_free(ctx: &Context, key: &KeyboardShortcut, command: &Command, filled: bool) -> bool {
    match (command, key.logical_key) {
        // copy and paste arrive as separate events
        (Command::CopyScene | Command::PasteScene, _) => false,
        // the space bar presses the button that has the focus
        (_, Key::Space) => {
            let focused = ctx.memory(egui::Memory::focused).and_then(|id| ctx.read_response(id));
            !focused.is_some_and(|response| response.sense.senses_click())
        }
        (_, Key::Escape) => filled && !Popup::is_any_open(ctx),
        _ => true,
    }
}

/// The rows of the list under a heading: keys, and what they do.
fn rows(ctx: &Context, heading: &str, projector: bool) -> Vec<(String, &'static str)> {
    let mut rows: Vec<(&str, String, &str)> = Vec::new();
    for part in parts() {
        match (part, rows.last_mut()) {
            // the projector is light
            (Part::Hidden(_, Command::Toggle(Setting::Dark), _), _) if projector => {}
            (Part::Row(group, keys, text), _) => rows.push((group, (*keys).to_owned(), text)),
            (Part::Item(_, Some(key), _, listed) | Part::Hidden(Some(key), _, listed), last) => {
                let key = ctx.format_shortcut(key);
                match (listed, last) {
                    (Listed::As(group, text), _) => rows.push((group, key, text)),
                    (Listed::Joined, Some(row)) => row.1 += &format!(", {key}"),
                    _ => {}
                }
            }
            _ => {}
        }
    }
    rows.into_iter().filter(|row| row.0 == heading).map(|(_, keys, text)| (keys, text)).collect()
}

/// Height in points of a row of the list.
const ROW: f32 = 20.0;

/// Rows of `width` points under a heading; a long text is wrapped.
fn group_ui(ui: &mut Ui, group: &str, projector: bool, width: f32) {
    ui.label(RichText::new(group).heading());
    (ui.spacing_mut().interact_size.y, ui.spacing_mut().item_spacing.y) = (ROW, 2.0);
    let left = Layout::left_to_right(Align::Min);
    for (keys, does) in rows(ui.ctx(), group, projector) {
        ui.horizontal_top(|ui| {
            ui.allocate_ui_with_layout(vec2(KEYS, ROW), left, |ui| {
                ui.set_min_width(KEYS);
                ui.label(keys)
            });
            let text = ui.available_width().min(width - KEYS).max(LEAST_TEXT);
            ui.allocate_ui(vec2(text, ROW), |ui| ui.add(Label::new(does).wrap()));
        });
    }
    ui.add_space(8.0);
}

/// Shows the list of keys, opened at time `opened` in s. Returns `false` once it is to be closed.
pub fn list_ui(ui: &Ui, opened: f64, projector: bool, in_lesson: bool) -> bool {
    let columns = if in_lesson { IN_LESSON } else { GROUPS };
    let (is_read, is_closed) = dialog_ui(ui, ("shortcuts", LIST), ("Keys", 4.0), |ui| {
        let room = (ui.ctx().content_rect().height() - 130.0).max(120.0);
        // the list is scrolled to its top whenever it is opened
        let list = egui::ScrollArea::vertical().id_salt(opened.to_bits());
        list.max_height(room).min_scrolled_height(room).show(ui, |ui| {
            let width = ui.available_width();
            if width < SIDE_BY_SIDE {
                return columns.concat().iter().for_each(|group| group_ui(ui, group, projector, width));
            }
            let width = 0.5 * (width - BETWEEN);
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = BETWEEN;
                for groups in columns {
                    ui.vertical(|ui| {
                        ui.set_width(width);
                        ui.spacing_mut().item_spacing.x = 8.0;
                        groups.iter().for_each(|group| group_ui(ui, group, projector, width));
                    });
                }
            });
        });
        ui.add_space(8.0);
        close_ui(ui)
    });
    let toggled = ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F1));
    !(is_read || is_closed || toggled)
}
