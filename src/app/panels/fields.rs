//! Controls of the numeric fields of a scene, by path.

use eframe::egui::{Label, Ui};

use crate::app::session::Session;
use crate::app::ui::knob::{How, Knob, refuse};
use crate::app::words::fields::{self, Reach};
use crate::app::words::numbers::{below, decimals, round_up, shown};
use crate::scene::FieldPath;

/// The control of a field of the scene, or of the stops that it gets when they are switched on. Draws nothing
/// if there is no such field. A change of the start restarts the motion.
pub(super) fn field_ui(ui: &mut Ui, session: &mut Session, path: &str, width: f32) {
    let Some(value) = session.number(path) else { return };
    let (name, unit) = fields::name_and_unit(path);
    let (reach, typed, hover) = match fields::info(path) {
        Some(field) => (field.reach(session), field.typed, field.hover),
        None => (around(session, path, value), (f64::MIN, f64::MAX), ""),
    };
    let turn = Knob { name: &name, unit, reach, typed, hover, width }.ui(ui, value);
    if let Some(value) = turn.value {
        match turn.how {
            How::Pressed => session.press(path, ui.input(|input| input.time)),
            How::Once | How::Dragged => session.end_presses(),
        }
        if let Err(why) = session.set_number(path, value) {
            let value = shown(value, decimals(reach.step));
            let space = if unit.is_empty() { "" } else { " " };
            refuse(ui, &name, format!("{value}{space}{unit} was not taken: {why}"));
        }
    }
    let is_start = path.starts_with("start.");
    if turn.ended || turn.value.is_some() && (turn.how == How::Once || is_start && turn.how == How::Pressed) {
        session.end_gesture();
        if is_start {
            session.restart();
            session.player.set_playing(true);
        }
    }
}

/// Slider range of a field that is not in the table: around the value that the scene was opened with.
fn around(session: &Session, path: &str, value: f64) -> Reach {
    let opened = FieldPath::new(path).get(session.editor.saved()).unwrap_or(value);
    let size = if opened == 0.0 { 1.0 } else { opened.abs() };
    let high = round_up(2.0 * size);
    Reach::even(if opened < 0.0 { -high } else { 0.0 }, high, below(high / 200.0))
}

/// The controls of several fields, one below another.
pub(super) fn fields_ui(ui: &mut Ui, session: &mut Session, paths: &[&str], width: f32) {
    paths.iter().for_each(|path| field_ui(ui, session, path, width));
}

/// The name of a control that does not apply to the scene, greyed out, with the reason.
pub(super) fn absent_ui(ui: &mut Ui, name: &str, why: &str) {
    ui.add_enabled(false, Label::new(name)).on_disabled_hover_text(why);
}
