//! Messages over the window: alerts, which the user closes, and notices, which disappear by themselves.

use eframe::egui::{self, Align2, Area, Id, Order, Ui, accesskit::Live, vec2};

use crate::app::export::WriteResult;
use crate::app::session::player::Reached;
use crate::app::ui::style::GAP;
use crate::app::ui::widgets::{close_ui, dialog_ui, prose_ui};

pub(super) const CANNOT_OPEN: &str = "This scene cannot be opened";

/// Time in s for which a notice is shown.
const SHOWN_FOR: f64 = 4.0;
/// Width in points of the menus, beside which a notice stands.
const MENUS: f32 = 400.0;

/// A notice, and the time in s since which it has been shown.
#[derive(Debug)]
pub(super) struct Notice {
    pub text: String,
    since: Option<f64>,
}

#[derive(Debug, Default)]
pub(super) struct Messages {
    pub alert: Option<(String, String)>,
    pub notice: Option<Notice>,
}

impl Messages {
    pub fn alert(&mut self, title: impl Into<String>, text: impl Into<String>) {
        self.alert = Some((title.into(), text.into()));
    }

    /// Copies a text to the clipboard and says `what` it is.
    pub fn copy(&mut self, ctx: &egui::Context, text: String, what: &str) {
        ctx.copy_text(text);
        self.notify(format!("Copied: {what}"));
    }

    pub fn notify(&mut self, text: impl Into<String>) {
        self.notice = Some(Notice { text: text.into(), since: None });
    }

    pub fn report_written(&mut self, result: WriteResult) {
        match result {
            Ok(text) => self.notify(text),
            Err(error) => self.alert("Not written", error),
        }
    }

    /// Reports that the motion has reached its goal, or why it stopped, at `time` in s. An event that was
    /// looked for is named in the transport bar.
    pub fn report_reached(&mut self, reached: Reached, time: f64) {
        match reached {
            Reached::Time => self.notify(format!("The end of the run, {time:.2} s")),
            Reached::Nothing(kind) => self.notify(format!("No {} up to {time:.2} s", kind.name())),
            Reached::Ended => self.notify(format!("The run ended at {time:.3} s")),
        }
    }

    pub fn notice_ui(&mut self, ui: &Ui) {
        let Some(notice) = &mut self.notice else { return };
        let now = ui.input(|input| input.time);
        let left = *notice.since.get_or_insert(now) + SHOWN_FOR - now;
        let area = Area::new(Id::unique("told")).anchor(Align2::RIGHT_TOP, vec2(-GAP, 0.0));
        let shown = area.order(Order::Tooltip).interactable(false).show(ui.ctx(), |ui| {
            let frame = egui::Frame::popup(ui.style()).inner_margin(egui::Margin::symmetric(8, 4));
            frame.show(ui, |ui| {
                ui.set_max_width((ui.ctx().content_rect().width() - MENUS).max(0.6 * MENUS));
                let label = ui.label(&notice.text);
                ui.ctx().accesskit_node_builder(label.id, |node| node.set_live(Live::Polite));
            });
        });
        // over a hover text that opened later
        ui.ctx().move_to_top(shown.response.layer_id);
        if left > 0.0 {
            ui.ctx().request_repaint_after_secs(left as f32);
        } else {
            self.notice = None;
        }
    }

    pub fn alert_ui(&mut self, ui: &Ui) {
        let Some((title, text)) = &self.alert else { return };
        let (is_read, is_closed) = dialog_ui(ui, ("message", 560.0), (title, 6.0), |ui| {
            let room = (ui.ctx().content_rect().height() - 160.0).clamp(80.0, 420.0);
            egui::ScrollArea::vertical().max_height(room).show(ui, |ui| prose_ui(ui, text));
            ui.add_space(8.0);
            close_ui(ui)
        });
        if is_read || is_closed {
            self.alert = None;
        }
    }
}
