//! Which keys do what? The list that F1 shows.

use eframe::egui::{self, Grid, Key, Modifiers, RichText, Ui};

use crate::app::ui::widgets::{close_ui, dialog, dialog_width};

/// Width in points from which on the groups stand in two columns.
const SIDE_BY_SIDE: f32 = 800.0;

/// Keys and what they do, under a heading.
type Group = (&'static str, &'static [(&'static str, &'static str)]);

/// All of them.
const GROUPS: [Group; 4] = [
    (
        "Time",
        &[
            ("Space", "play, pause"),
            (".", "a single step"),
            ("PageUp, PageDown", "to the event before, after"),
            ("1 to 7", "speed, from 1/1000 of real time to 100 times"),
            ("R, X", "to the next release, the next crossing"),
            ("End", "to the end of the run"),
            ("Home", "discard your changes: scene, view and time as opened"),
        ],
    ),
    (
        "Hands",
        &[
            ("G", "take hold of the mass"),
            ("Left, Right", "move what has the focus by a step, the held mass by 0.1 mm"),
            ("Shift", "with these, ten steps"),
            ("Enter", "let go of the mass"),
            ("Tab, Space", "to the next control, press it"),
        ],
    ),
    (
        "Views",
        &[
            ("Z", "the view under the pointer over the whole window"),
            ("Esc", "all views again"),
            ("Ctrl+Tab", "the next of the views that share a place"),
            ("C", "cover the motion and all results, until C again: predict first"),
            ("H", "what it would take to cross"),
            ("P", "projector: light, larger, thicker lines"),
            ("D", "light letters on a dark ground"),
            ("F11", "full screen"),
            ("Ctrl+1, 2, 3, 4", "arrange as Look, Study, Map, your own"),
        ],
    ),
    (
        "Scene",
        &[
            ("Ctrl+Z, Ctrl+Y", "undo, redo"),
            ("Ctrl+O, Ctrl+S", "open, save"),
            ("Ctrl+C, Ctrl+V", "copy, paste the scene as text"),
            ("Ctrl+Shift+C", "copy the command line that runs it"),
            ("Ctrl+Q", "quit"),
        ],
    ),
];

/// A group with its heading.
fn group_ui(ui: &mut Ui, (group, keys): &Group) {
    ui.label(RichText::new(*group).heading());
    Grid::new(group).num_columns(2).spacing([16.0, 2.0]).show(ui, |ui| {
        for (key, does) in *keys {
            ui.label(*key);
            ui.label(*does);
            ui.end_row();
        }
    });
    ui.add_space(8.0);
}

/// Shows the list, which was opened at the time `opened` in s; false once it is to be closed.
pub fn shortcuts_ui(ui: &Ui, opened: f64) -> bool {
    let answer = dialog(ui.ctx(), "shortcuts").show(ui.ctx(), |ui| {
        ui.set_max_width(dialog_width(ui, 960.0));
        ui.heading("Keys");
        ui.add_space(4.0);
        let room = (ui.ctx().content_rect().height() - 130.0).max(120.0);
        // every opening begins at the top
        let list =
            egui::ScrollArea::vertical().id_salt(opened.to_bits()).max_height(room).min_scrolled_height(room);
        list.show(ui, |ui| {
            if ui.available_width() < SIDE_BY_SIDE {
                return GROUPS.iter().for_each(|group| group_ui(ui, group));
            }
            ui.horizontal_top(|ui| {
                for groups in GROUPS.chunks(2) {
                    ui.vertical(|ui| groups.iter().for_each(|group| group_ui(ui, group)));
                    ui.add_space(24.0);
                }
            });
        });
        ui.add_space(8.0);
        close_ui(ui)
    });
    let again = ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F1));
    !(answer.inner || answer.should_close() || again)
}
