//! Controls of the numbers of a scene, by their paths.

use eframe::egui::{Label, Ui};

use crate::app::session::Session;
use crate::app::ui::knob::{How, Knob, refuse};
use crate::app::words::fields::{self, FieldInfo};
use crate::app::words::numbers::{decimals, shown};

/// The control of a number of the scene, or of the stops that come when they are switched on; none where
/// there is no such number.
pub(super) fn field_ui(ui: &mut Ui, session: &mut Session, path: &'static str, width: f32) {
    let (Some(field), Some(value)) = (fields::info(path), session.number(path)) else { return };
    let FieldInfo { name, unit, typed, hover, .. } = *field;
    let reach = field.reach(session);
    let turn = Knob { name, unit, reach, typed, hover, width }.ui(ui, value);
    if let Some(value) = turn.value {
        match turn.how {
            How::Pressed => session.press(path, ui.input(|input| input.time)),
            How::Once | How::Dragged => session.end_presses(),
        }
        if let Err(why) = session.set_number(path, value) {
            let value = shown(value, decimals(reach.step));
            let space = if unit.is_empty() { "" } else { " " };
            refuse(ui, name, format!("{value}{space}{unit} was not taken: {why}"));
        }
    }
    if turn.ended || (turn.value.is_some() && turn.how == How::Once) {
        session.end_gesture();
    }
}

/// The same for several numbers below each other.
pub(super) fn fields_ui(ui: &mut Ui, session: &mut Session, paths: &[&'static str], width: f32) {
    paths.iter().for_each(|path| field_ui(ui, session, path, width));
}

/// The name of a control that the scene has no use for, greyed, with the reason.
pub(super) fn absent_ui(ui: &mut Ui, name: &str, why: &str) {
    ui.add_enabled(false, Label::new(name)).on_disabled_hover_text(why);
}
