//! Messages over the window: some wait for an answer, short ones go by themselves.

use eframe::egui::{self, Align2, Area, Id, Order, Ui, accesskit::Live, vec2};

use crate::app::session::player::Reached;
use crate::app::ui::widgets::{close_ui, dialog, dialog_width};

/// What is said of a scene that cannot be opened.
pub(super) const CANNOT_OPEN: &str = "This scene cannot be opened";

/// Seconds for which a short message stands, and its distance in points from the lower edge.
const STANDS: f64 = 4.0;
const ABOVE: f32 = 72.0;

/// What was written, in words, or why it was not.
pub(super) type Written = Result<String, String>;

/// A short message, and since when it stands.
#[derive(Debug)]
struct Notice {
    text: String,
    since: Option<f64>,
}

#[derive(Debug, Default)]
pub(super) struct Messages {
    /// The title and text of one that waits to be read.
    waiting: Option<(String, String)>,
    /// A short one that goes by itself.
    told: Option<Notice>,
}

impl Messages {
    /// Shows a message until it is closed.
    pub fn say(&mut self, title: impl Into<String>, text: impl Into<String>) {
        self.waiting = Some((title.into(), text.into()));
    }

    /// Shows a message for some seconds.
    pub fn tell(&mut self, text: impl Into<String>) {
        self.told = Some(Notice { text: text.into(), since: None });
    }

    /// Says what was written, or why it was not.
    pub fn tell_written(&mut self, written: Written) {
        match written {
            Ok(text) => self.tell(text),
            Err(error) => self.say("Not written", error),
        }
    }

    /// Says where the motion has come to, where it was sent; the time in s.
    pub fn tell_reached(&mut self, reached: Reached, time: f64) {
        match reached {
            // the transport names it
            Reached::Event(_) => {}
            Reached::Time => self.tell(format!("The end of the run, {time:.2} s")),
            Reached::Nothing(kind) => self.tell(format!("No {} up to {time:.2} s", kind.name())),
            Reached::Ended => self.tell(format!("The run ended at {time:.3} s")),
        }
    }

    /// The text of the message that waits to be read.
    pub fn waiting(&self) -> Option<&str> {
        self.waiting.as_ref().map(|message| message.1.as_str())
    }

    /// The short message, while it stands.
    pub fn told(&self) -> Option<&str> {
        self.told.as_ref().map(|told| told.text.as_str())
    }

    pub fn drop_told(&mut self) {
        self.told = None;
    }

    /// Takes the short message along to another scene; the other one goes.
    pub fn short_only(&mut self) -> Self {
        Self { waiting: None, told: self.told.take() }
    }

    pub fn ui(&mut self, ui: &Ui) {
        self.waiting_ui(ui);
        self.told_ui(ui);
    }

    fn told_ui(&mut self, ui: &Ui) {
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

    fn waiting_ui(&mut self, ui: &Ui) {
        let Some((title, text)) = &self.waiting else { return };
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
            self.waiting = None;
        }
    }
}
