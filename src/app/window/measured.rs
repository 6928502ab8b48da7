//! Measured data in the window: opening, display over a view, use as excitation.

use std::path::Path;

use eframe::egui::Ui;

use crate::app::session::measured::MeasuredRecord;
use crate::app::views::View;
use crate::scene::Quantity;

use super::Window;
use super::measured_dialog::{MeasuredAnswer, MeasuredDialog};

impl Window {
    /// Opens the dialog for the columns of a file of measured data.
    pub fn open_measured(&mut self, path: &Path) {
        self.columns = Some(MeasuredDialog::new(path, &self.wake));
    }

    /// Draws a record over the view of its quantity, with a card beside Before / now.
    pub fn overlay(&mut self, record: MeasuredRecord) {
        let view = match record.values.quantity {
            Quantity::Velocity => View::Velocity,
            Quantity::Acceleration => View::BaseAcceleration,
            Quantity::Force => View::ForceCurve,
            _ => View::Displacement,
        };
        self.session.measured.lay(record);
        self.filled = None;
        self.tiling.show_beside(View::Measured, View::BeforeNow);
        // the view is in front if it shares tabs with the card
        self.tiling.show(view, true);
    }

    /// Draws the dialog for the columns, and carries out its answer.
    pub(super) fn measured_ui(&mut self, ui: &Ui) {
        let Some(answer) = self.columns.as_mut().and_then(|dialog| dialog.ui(ui, &self.wake)) else { return };
        match answer {
            MeasuredAnswer::Overlay(record) => self.overlay(*record),
            MeasuredAnswer::Shake(path, record) => match self.session.shake_with(&path, &record) {
                Ok(warnings) => {
                    let done = format!("The base is shaken with {}, from its start", record.name);
                    match warnings.is_empty() {
                        true => self.messages.notify(done),
                        false => self.messages.alert(done, format!("The record {}.", warnings.join("; it "))),
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
            MeasuredAnswer::Cancelled => {}
        }
        self.columns = None;
    }
}
