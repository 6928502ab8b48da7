//! Saving of figures: dialog, computation, file.

use eframe::egui::Ui;

use crate::app::views::View;

use super::Window;
use super::figure_dialog::Action;
use super::wanted::Wanted;

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
        self.figures.job.ask((), &self.wake, move |(), cancel, _| order.save(cancel));
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
