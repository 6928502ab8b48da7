//! The column and the strip of a lesson in the window, and the outlines around what a step names.

use eframe::egui::{self, Id, LayerId, Order, Panel, StrokeKind, Ui};

use crate::app::panels::controls;
use crate::app::panels::lesson::{lesson_column_ui, lesson_strip_ui, lesson_words_ui, navigation_ui};
use crate::app::session::lesson::OpenLesson;
use crate::app::ui::style::{CONTROL, Style};
use crate::app::ui::widgets::{bare, panel_frame};
use crate::app::views::View;
use crate::app::words::lesson::bold_words;

use super::Window;

/// Width of the column of a lesson: its greatest share of the width of the window, and its greatest width in
/// points.
const COLUMN: (f32, f32) = (0.26, 380.0);
/// Distance in points between a control and the outline around it.
const OUTLINE_DISTANCE: f32 = 2.0;

impl Window {
    /// The dots of the steps and the buttons of the open lesson.
    pub(super) fn lesson_navigation_ui(&mut self, ui: &mut Ui, style: &Style) {
        let urged = std::mem::take(&mut self.lessons.urged);
        self.lessons.chosen =
            self.lessons.open.as_ref().and_then(|open| navigation_ui(ui, open, style, urged));
    }

    /// The column of the open lesson, beside the views.
    pub(super) fn lesson_column_ui(&mut self, ui: &mut Ui, style: &Style) {
        let urged = std::mem::take(&mut self.lessons.urged);
        let Some(lesson) = &mut self.lessons.open else { return };
        let width = COLUMN.1.min(ui.ctx().content_rect().width() * COLUMN.0);
        let column = bare(Panel::left("column of the lesson"), 12, 4).resizable(false).exact_size(width);
        let column = column.show(ui, |ui| lesson_column_ui(ui, lesson, &mut self.session, style, urged));
        let (action, places) = column.inner;
        self.lessons.controls = places;
        if let Some(action) = action {
            self.act_in_lesson(action);
        }
    }

    /// The strip of the open lesson in a compact window, below its buttons where there `are_buttons`, and its
    /// controls; they are disabled while the motion is covered.
    pub(super) fn lesson_strip_ui(&mut self, ui: &mut Ui, style: &Style, are_buttons: bool) {
        if are_buttons {
            let row = bare(Panel::top("buttons of the lesson"), 12, 0);
            row.exact_size(CONTROL).show(ui, |ui| {
                let layout = egui::Layout::right_to_left(egui::Align::Center);
                ui.with_layout(layout, |ui| self.lesson_navigation_ui(ui, style));
            });
        }
        let Some(lesson) = &self.lessons.open else { return };
        // not a panel, whose height would follow its contents one frame late
        let spacing = std::mem::take(&mut ui.spacing_mut().item_spacing.y);
        let strip = panel_frame(12, 4).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = spacing;
            ui.set_min_width(ui.available_width());
            lesson_strip_ui(ui, lesson, &self.session, style)
        });
        ui.spacing_mut().item_spacing.y = spacing;
        if let Some(action) = strip.inner.or(self.lessons.chosen.take()) {
            self.act_in_lesson(action);
        }
        let Some(lesson) = self.lessons.open.as_ref().filter(|open| !open.lesson().controls.is_empty())
        else {
            return;
        };
        // so that an outline around a control keeps clear of the views
        bare(Panel::top("controls of the lesson"), 12, 2).show(ui, |ui| {
            // the question is about what they change
            if lesson.is_covering() {
                ui.set_invisible();
            }
            self.lessons.controls = controls::named_ui(ui, &mut self.session, &lesson.lesson().controls);
        });
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
