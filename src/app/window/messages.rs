//! Messages over the window: some wait for an answer, short ones go by themselves.

use eframe::egui::{self, Align2, Area, Id, Order, Ui, accesskit::Live, vec2};

use crate::app::session::player::Reached;
use crate::app::ui::widgets::{close_ui, dialog, dialog_width};

use super::Window;

/// Seconds for which a short message stands, and its distance in points from the lower edge.
const STANDS: f64 = 4.0;
const ABOVE: f32 = 72.0;

/// A short message, and since when it stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Notice {
    text: String,
    since: Option<f64>,
}

impl Window {
    /// Says something for some seconds.
    pub(super) fn tell(&mut self, text: impl Into<String>) {
        self.told = Some(Notice { text: text.into(), since: None });
    }

    /// What was said last, while it stands.
    pub fn told(&self) -> Option<&str> {
        self.told.as_ref().map(|told| told.text.as_str())
    }

    /// Says where the motion has come to, where it was sent.
    pub(super) fn tell_reached(&mut self) {
        let Some(reached) = self.session.player.take_reached().filter(|_| !self.covered) else { return };
        let time = self.session.player.time();
        match reached {
            // the transport names it
            Reached::Event(_) => {}
            Reached::Time => self.tell(format!("The end of the run, {time:.2} s")),
            Reached::Nothing(kind) => self.tell(format!("No {} up to {time:.2} s", kind.name())),
            Reached::Ended => self.tell(format!("The run ended at {time:.3} s")),
        }
    }

    pub(super) fn told_ui(&mut self, ui: &Ui) {
        let Some(told) = &mut self.told else { return };
        let now = ui.input(|input| input.time);
        let left = *told.since.get_or_insert(now) + STANDS - now;
        let area = Area::new(Id::unique("told")).anchor(Align2::CENTER_BOTTOM, vec2(0.0, -ABOVE));
        area.order(Order::Foreground).interactable(false).show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(dialog_width(ui, 900.0));
                let label = ui.label(&told.text);
                ui.ctx().accesskit_node_builder(label.id, |node| node.set_live(Live::Polite));
            });
        });
        if left > 0.0 {
            ui.ctx().request_repaint_after_secs(left as f32);
        } else {
            self.told = None;
        }
    }

    pub(super) fn message_ui(&mut self, ui: &Ui) {
        let Some((title, text)) = &self.message else { return };
        let answer = dialog(ui.ctx(), "message").show(ui.ctx(), |ui| {
            ui.set_max_width(dialog_width(ui, 560.0));
            ui.heading(title);
            ui.add_space(6.0);
            let room = (ui.ctx().content_rect().height() - 160.0).clamp(80.0, 420.0);
            egui::ScrollArea::vertical().max_height(room).show(ui, |ui| ui.label(text));
            ui.add_space(8.0);
            close_ui(ui)
        });
        if answer.inner || answer.should_close() {
            self.message = None;
        }
    }
}
