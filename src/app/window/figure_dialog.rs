//! Dialog of a figure: its fields and buttons.

use eframe::egui::{self, Button, ComboBox, Grid, Key, RichText, TextEdit, Ui};

use crate::app::session::Session;
use crate::app::ui::widgets::{dialog, dialog_width};
use crate::app::views::{Memory, View};

use super::figure::{Figures, panel};

/// What the user chooses in the dialog.
pub(super) enum Action {
    Save,
    /// Copy the command that makes the figure.
    Copy,
    /// Choose the file in the desktop's dialog.
    Browse,
    Close,
}

impl Figures {
    pub(super) fn ui(&mut self, ui: &Ui, view: View, session: &Session, memory: &Memory) -> Option<Action> {
        let answer = dialog(ui.ctx(), "figure").show(ui.ctx(), |ui| {
            ui.set_width(dialog_width(ui, 560.0));
            ui.heading("Save a figure");
            ui.add_space(4.0);
            self.fields_ui(ui, view, session, memory)
        });
        let closed = answer.should_close().then_some(Action::Close);
        answer.inner.or(closed)
    }

    fn fields_ui(&mut self, ui: &mut Ui, view: View, session: &Session, memory: &Memory) -> Option<Action> {
        let mut action = None;
        let field = |ui: &mut Ui, name: &str, text: &mut String, width: f32, unit: &str| {
            let name = ui.label(name);
            let field = ui.add(TextEdit::singleline(text).desired_width(width)).labelled_by(name.id);
            ui.label(unit);
            field
        };
        let entered = Grid::new("figure").num_columns(2).spacing([12.0, 6.0]).show(ui, |ui| {
            let name = ui.label("Of");
            let mut chosen = view;
            let combo = ComboBox::from_id_salt("figure of").width(180.0).selected_text(view.name());
            let combo = combo.show_ui(ui, |ui| {
                for choice in View::ALL {
                    ui.selectable_value(&mut chosen, choice, choice.name());
                }
            });
            combo.response.labelled_by(name.id);
            if chosen != view {
                self.open(chosen, session, memory);
            }
            ui.end_row();
            let name = ui.label("File");
            let path = ui.horizontal(|ui| {
                let path = TextEdit::singleline(&mut self.path);
                let room = ui.available_width() - 84.0;
                let path = ui.add(path.desired_width(room)).labelled_by(name.id);
                if ui.button("Browse...").clicked() {
                    action = Some(Action::Browse);
                }
                path
            });
            ui.end_row();
            ui.label("On paper");
            let (width, font) = ui
                .horizontal(|ui| {
                    let width = field(ui, "width", &mut self.width, 44.0, "mm,");
                    (width, field(ui, "text", &mut self.font, 36.0, "points"))
                })
                .inner;
            ui.end_row();
            let mut fields = vec![path.inner, width, font];
            if panel(view).is_some() {
                ui.label("Panels");
                ui.horizontal(|ui| {
                    let names = ["displacement", "velocity", "base acceleration", "phase portrait"];
                    for (name, panel) in names.into_iter().zip(&mut self.panels) {
                        ui.checkbox(panel, name);
                    }
                });
                ui.end_row();
                ui.label("Times");
                ui.horizontal(|ui| {
                    let [from, to] = &mut self.times;
                    fields.push(field(ui, "from", from, 64.0, ""));
                    fields.push(field(ui, "to", to, 64.0, "s; empty for the whole run"));
                });
                ui.end_row();
            }
            ui.label("");
            ui.checkbox(&mut self.titled, "With title and footer");
            ui.end_row();
            ui.label("");
            ui.checkbox(&mut self.data, "Also the numbers that are drawn, as CSV beside it");
            ui.end_row();
            if !std::mem::replace(&mut self.had_focus, true) {
                fields[0].request_focus();
            }
            if fields.iter().any(|field| field.changed()) {
                self.problem = None;
            }
            fields.iter().any(|field| field.lost_focus()) && ui.input(|input| input.key_pressed(Key::Enter))
        });
        let order = self.order(view, session, memory);
        let (can_save, remark) = self.remark(order.as_ref(), view, session);
        let remark = self.problem.clone().unwrap_or(remark);
        let running = self.job.is_running();
        let words = if running { "Working it out." } else { remark.as_str() };
        ui.add_space(4.0);
        let room = egui::Vec2::new(ui.available_width(), 2.0 * ui.text_style_height(&egui::TextStyle::Body));
        ui.allocate_ui(room, |ui| {
            ui.set_min_height(room.y);
            let label = ui.add(egui::Label::new(RichText::new(words)).wrap());
            ui.ctx().accesskit_node_builder(label.id, |node| node.set_live(egui::accesskit::Live::Polite));
        });
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            if running {
                if ui.button("Stop").clicked() {
                    self.job.clear();
                }
                return;
            }
            if ui.add_enabled(can_save, Button::new("Save")).clicked() || entered.inner && can_save {
                action = Some(Action::Save);
            }
            let hover = "The command that makes the same file without a window.";
            let copy = ui.add_enabled(order.is_ok(), Button::new("Copy as command")).on_hover_text(hover);
            if copy.clicked() {
                action = Some(Action::Copy);
            }
            if ui.button("Cancel").clicked() {
                action = Some(Action::Close);
            }
        });
        action
    }
}
