//! Button and answer of the search for the best stops.

use eframe::egui::{self, RichText, Ui};

use crate::app::session::Session;

/// Hover text of the button.
const HOVER: &str = "Looks for the distance of the stops with which the scene as it stands, from rest, moves \
                     fastest, or where there is a transducer gives most power, and how far that is from \
                     where it is lost (B).";

/// A button labelled `name` that starts the search; there is none in a lesson.
pub fn button_ui(ui: &mut Ui, session: &mut Session, name: &str) {
    if session.best.is_off {
        return;
    }
    let button = egui::Button::new(name);
    let response = ui.add_enabled(!session.best.is_running(), button);
    if response.on_hover_text(HOVER).on_disabled_hover_text("It is being looked for.").clicked() {
        session.find_best_stops();
    }
}

/// The answer of the search so far, and a button that moves the stops there.
pub fn answer_ui(ui: &mut Ui, session: &mut Session) {
    ui.horizontal_wrapped(|ui| {
        ui.label(session.best.words());
        if session.best.is_running() {
            ui.add(egui::Spinner::new().size(14.0));
            if ui.small_button("Stop looking").clicked() {
                session.best.close();
            }
            return;
        }
        match session.is_at_best_stops() {
            true => _ = ui.label(RichText::new("The stops stand there.").weak()),
            false if session.best.limit_mm().is_some() => {
                let hover = "Moves the stops there, as one step that can be undone. The motion goes on.";
                if ui.small_button("Take the stops there").on_hover_text(hover).clicked() {
                    session.go_to_best_stops();
                }
            }
            false => {}
        }
        if ui.small_button("Close").on_hover_text("Forgets the best stops.").clicked() {
            session.best.close();
        }
    });
}
