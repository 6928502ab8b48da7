//! Dialog of a figure, and what is done with its answer.

use eframe::egui::{self, Button, ComboBox, Grid, Key, RichText, TextEdit, Ui};

use crate::app::session::Session;
use crate::app::ui::widgets::{dialog, dialog_width};
use crate::app::views::{Memory, View};

use super::Window;
use super::figure::{Figures, panel};
use super::wanted::Wanted;

/// What the user chooses in the dialog.
enum Action {
    Save,
    /// Copy the command that makes the figure.
    Copy,
    /// Choose the file in the desktop's dialog.
    Browse,
    Close,
}

impl Figures {
    fn ui(&mut self, ui: &Ui, view: View, session: &Session, memory: &Memory) -> Option<Action> {
        let answer = dialog(ui.ctx(), "figure").show(ui.ctx(), |ui| {
            ui.set_width(dialog_width(ui, 560.0));
            ui.heading("Save a figure");
            ui.add_space(4.0);
            self.contents_ui(ui, view, session, memory)
        });
        let closed = answer.should_close().then_some(Action::Close);
        answer.inner.or(closed)
    }

    /// The fields, the remark and the buttons.
    fn contents_ui(&mut self, ui: &mut Ui, view: View, session: &Session, memory: &Memory) -> Option<Action> {
        let mut action = None;
        let entered = Grid::new("figure").num_columns(2).spacing([12.0, 6.0]).show(ui, |ui| {
            self.view_choice_ui(ui, view, session, memory);
            self.fields_ui(ui, view, &mut action)
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

    fn view_choice_ui(&mut self, ui: &mut Ui, view: View, session: &Session, memory: &Memory) {
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
    }

    /// File, layout and contents. Returns whether Enter was pressed in a text field.
    fn fields_ui(&mut self, ui: &mut Ui, view: View, action: &mut Option<Action>) -> bool {
        let field = |ui: &mut Ui, name: &str, text: &mut String, width: f32, unit: &str| {
            let name = ui.label(name);
            let field = ui.add(TextEdit::singleline(text).desired_width(width)).labelled_by(name.id);
            ui.label(unit);
            field
        };
        let name = ui.label("File");
        let path = ui.horizontal(|ui| {
            let path = TextEdit::singleline(&mut self.path);
            let room = ui.available_width() - 84.0;
            let path = ui.add(path.desired_width(room)).labelled_by(name.id);
            if ui.button("Browse...").clicked() {
                *action = Some(Action::Browse);
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
                let names = ["displacement", "velocity", "base acceleration", "energy", "phase portrait"];
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
    }
}

impl Window {
    /// Opens the dialog for a figure of a view, or of the view under the pointer.
    pub(super) fn open_figure_dialog(&mut self, view: Option<View>) {
        let view = view.or(self.filled).or(self.memory.hovered).unwrap_or(View::Displacement);
        self.figures.open(view, &self.session, &self.memory);
    }

    pub(super) fn figure_ui(&mut self, ui: &Ui) {
        let Some(view) = self.figures.view else { return };
        let Some(action) = self.figures.ui(ui, view, &self.session, &self.memory) else { return };
        match action {
            Action::Browse => return self.choose(Wanted::Figure),
            Action::Close => {
                self.figures.job.clear();
                self.figures.view = None;
                return;
            }
            Action::Save | Action::Copy => {}
        }
        let Some(view) = self.figures.view else { return };
        let order = match self.figures.order(view, &self.session, &self.memory) {
            Ok(order) => order,
            Err(problem) => return self.figures.problem = Some(problem),
        };
        if matches!(action, Action::Copy) {
            ui.ctx().copy_text(order.command_line());
            return self.messages.notify("Copied: the command line of this figure");
        }
        self.figures.problem = None;
        self.figures.job.ask((), &self.wake, move |(), cancel, _| {
            order.save(cancel).map_err(|error| error.to_string()).transpose()
        });
    }

    /// Receives the result of saving a figure; after an error the dialog stays open.
    pub(super) fn take_figure(&mut self) {
        match self.figures.job.take() {
            Some(Ok(text)) => {
                self.figures.view = None;
                self.messages.notify(text);
            }
            Some(Err(problem)) => self.figures.problem = Some(problem),
            None => {}
        }
    }
}
