//! Measured data in the window: opened, dropped, laid over a view, taken as the drive.

use std::path::Path;

use eframe::egui::Ui;

use crate::app::session::measured::MeasuredRecord;
use crate::app::views::View;
use crate::scene::Quantity;

use super::Window;
use super::measured_dialog::{Ended, MeasuredDialog};

impl Window {
    /// Asks for the columns of a file of measured data.
    pub fn open_measured(&mut self, path: &Path) {
        self.columns = Some(MeasuredDialog::new(path, &self.wake));
    }

    /// Lays a record over the computed, in the view of its quantity, with a card beside Before / now.
    pub fn lay(&mut self, record: MeasuredRecord) {
        let view = match record.values.quantity {
            Quantity::Velocity => View::Velocity,
            Quantity::Acceleration => View::BaseAcceleration,
            Quantity::Force => View::ForceCurve,
            _ => View::Displacement,
        };
        self.session.measured.lay(record);
        self.filled = None;
        self.tiling.show_beside(View::Measured, View::BeforeNow);
        // where there is little room, in front of the card
        self.tiling.show(view, true);
    }

    /// Draws the question for the columns, and does what was answered.
    pub(super) fn measured_ui(&mut self, ui: &Ui) {
        let Some(ended) = self.columns.as_mut().and_then(|dialog| dialog.ui(ui, &self.wake)) else { return };
        match ended {
            Ended::Laid(record) => self.lay(*record),
            Ended::Shaken(path, record) => match self.session.shake_with(&path, &record) {
                Ok(warnings) => {
                    let done = format!("The base is shaken with {}, from its start", record.name);
                    match warnings.is_empty() {
                        true => self.messages.tell(done),
                        false => self.messages.say(done, format!("The record {}.", warnings.join("; it "))),
                    }
                    self.tiling.show(View::BaseAcceleration, true);
                }
                Err(why) => {
                    if let Some(dialog) = &mut self.columns {
                        dialog.refuse(why);
                    }
                    return;
                }
            },
            Ended::Cancelled => {}
        }
        self.columns = None;
    }
}
