//! The column of a lesson in the window, and the outlines around what a step names.

use eframe::egui::{self, Id, LayerId, Order, Panel, StrokeKind, Ui};

use crate::app::panels::controls;
use crate::app::panels::lesson::{lesson_column_ui, lesson_words_ui};
use crate::app::session::lesson::OpenLesson;
use crate::app::ui::style::Style;
use crate::app::ui::widgets::{bare, panel_frame};
use crate::app::views::View;
use crate::app::words::lesson::bold_words;

use super::Window;

/// Width of the column of a lesson: its share of the width of the window, and its least and greatest width in
/// points.
const COLUMN: (f32, f32, f32) = (0.26, 340.0, 380.0);
/// Distance in points between a control and the outline around it.
const OUTLINE_DISTANCE: f32 = 2.0;

impl Window {
    /// The column of the open lesson, beside the views.
    pub(super) fn lesson_column_ui(&mut self, ui: &mut Ui, style: &Style) {
        let urged = std::mem::take(&mut self.lessons.urged);
        let Some(lesson) = &mut self.lessons.open else { return };
        let width = (ui.ctx().content_rect().width() * COLUMN.0).clamp(COLUMN.1, COLUMN.2);
        let column = bare(Panel::left("column of the lesson"), 12, 4).resizable(false).exact_size(width);
        let column = column.show(ui, |ui| lesson_column_ui(ui, lesson, &mut self.session, style, urged));
        let (action, places) = column.inner;
        self.lessons.controls = places;
        if let Some(action) = action {
            self.act_in_lesson(action);
        }
    }

    /// The step of the open lesson in words, above a view that has the whole window.
    pub(super) fn lesson_words_ui(&mut self, ui: &mut Ui, style: &Style) {
        let Some(lesson) = &self.lessons.open else { return };
        let spacing = std::mem::take(&mut ui.spacing_mut().item_spacing.y);
        panel_frame(12, 6).show(ui, |ui| {
            ui.set_min_width(ui.available_width());
            lesson_words_ui(ui, lesson, &self.session, style);
        });
        ui.spacing_mut().item_spacing.y = spacing;
    }

    /// Outlines around the controls and views on the screen that bold words in the text of the step name.
    pub(super) fn pointing_ui(&self, ctx: &egui::Context, style: &Style) {
        let shown = |open: &&OpenLesson| self.filled.is_none() && !open.is_covering();
        let Some(lesson) = self.lessons.open.as_ref().filter(shown) else { return };
        let layer = LayerId::new(Order::Middle, Id::unique("pointing"));
        let painter = ctx.layer_painter(layer);
        for word in bold_words(lesson.step().text()) {
            let stroke = style.pointing_stroke();
            if let Some(control) =
                self.lessons.controls.iter().find(|shown| controls::is_named(&word, &shown.0))
            {
                painter.rect_stroke(control.1.expand(OUTLINE_DISTANCE), 4.0, stroke, StrokeKind::Outside);
            } else if let Some(rect) = View::named(&word).and_then(|view| self.tiling.place_of(view)) {
                painter.rect_stroke(rect, 4.0, stroke, StrokeKind::Inside);
            }
        }
    }
}
