//! Figures that the window saves: asked for, worked out, written.

use eframe::egui::Ui;

use crate::app::views::View;

use super::Window;
use super::figure_dialog::Asked;
use super::wanted::Wanted;

impl Window {
    /// Asks for a figure of a view, or of the one under the pointer.
    pub(super) fn ask_figure(&mut self, view: Option<View>) {
        let view = view.or(self.filled).or(self.memory.hovered).unwrap_or(View::Displacement);
        self.figures.open(view, &self.session, &self.memory);
    }

    pub(super) fn figure_ui(&mut self, ui: &Ui) {
        let Some(view) = self.figures.view else { return };
        let Some(asked) = self.figures.ui(ui, view, &self.session, &self.memory) else { return };
        match asked {
            Asked::Browse => return self.choose(Wanted::Figure),
            Asked::Close => {
                self.figures.job.clear();
                self.figures.view = None;
                return;
            }
            Asked::Save | Asked::Copy => {}
        }
        let Some(view) = self.figures.view else { return };
        let order = match self.figures.order(view, &self.session, &self.memory) {
            Ok(order) => order,
            Err(problem) => return self.figures.problem = Some(problem),
        };
        if matches!(asked, Asked::Copy) {
            ui.ctx().copy_text(order.command_line());
            return self.messages.tell("Copied: the command line of this figure");
        }
        self.figures.problem = None;
        self.figures.job.ask((), &self.wake, move |(), cancel, _| order.save(cancel));
    }

    /// Takes in a figure that was saved, or why it was not: the question then stands as it was.
    pub(super) fn take_figure(&mut self) {
        match self.figures.job.take() {
            Some(Ok(text)) => {
                self.figures.view = None;
                self.messages.tell(text);
            }
            Some(Err(problem)) => self.figures.problem = Some(problem),
            None => {}
        }
    }
}
