//! Context passed to every view, and the placeholder of a view that is too small.

use eframe::egui::{
    Align, Align2, FontId, Frame, Label, Layout, Rect, RichText, Role, ScrollArea, Sense, Shape, Ui,
    UiBuilder, Vec2, pos2, vec2,
};

use crate::app::session::Session;
use crate::app::ui::style::{CONTROL, CORNER, Style, strong_family};
use crate::app::ui::widgets::tell;

use super::memory::Memory;
use super::span::Span;

/// What a lesson covers until the learner has made a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cover {
    None,
    /// Results of other settings or starts than the present ones.
    Surveys,
    /// Everything that follows from the motion, which stands at its start; nothing can be moved.
    Future,
    /// The motion and all results.
    All,
}

pub struct ViewContext<'a> {
    /// The open scene: document, model, motion, results.
    pub session: &'a mut Session,
    /// Colours and line widths.
    pub style: Style,
    /// The x axis that views share.
    pub span: Span,
    /// State that views keep between frames.
    pub memory: &'a mut Memory,
    /// Whether rings at impacts are left out.
    pub reduce_motion: bool,
    pub cover: Cover,
    /// Whether the view fills the window, so that it shares its axes with no other.
    pub filled: bool,
}

/// Greatest width in points of a sentence in place of a view.
const SENTENCE: f32 = 380.0;

/// Distance in points between the lines of a hatching, and radius of the mark in the middle of it.
const HATCHING: f32 = 12.0;
const MARK: f32 = 20.0;

/// Writes one sentence in the middle of `area`, in which a view has nothing to show.
pub fn empty_ui(ui: &mut Ui, style: &Style, area: Rect, text: &str) {
    offer_ui(ui, style, area, text, "");
}

/// Like [`empty_ui`], with a button below the sentence if it has a name. Returns whether it was clicked.
pub fn offer_ui(ui: &mut Ui, style: &Style, area: Rect, text: &str, button: &str) -> bool {
    let width = (area.width() - 2.0 * MARK).clamp(1.0, SENTENCE);
    let words = ui.painter().layout(text.to_owned(), style.body(), style.faint(), width).size();
    let height = words.y + if button.is_empty() { 0.0 } else { ui.spacing().item_spacing.y + CONTROL };
    let middle = Rect::from_center_size(area.center(), vec2(width, height.min(area.height())));
    let layout = Layout::top_down(Align::Center);
    ui.scope_builder(UiBuilder::new().max_rect(middle).layout(layout), |ui| {
        ui.set_clip_rect(area.intersect(ui.clip_rect()));
        ui.add(Label::new(RichText::new(text).color(style.faint())).wrap());
        !button.is_empty() && ui.button(button).clicked()
    })
    .inner
}

/// Draws the cover of a view: a hatching, a question mark and the question.
pub fn covered_ui(ui: &mut Ui, style: &Style, question: &str) {
    let area = ui.max_rect();
    let painter = ui.painter().with_clip_rect(area.intersect(ui.clip_rect()));
    painter.rect_filled(area, 0.0, style.ground());
    let lines = ((area.width() + area.height()) / HATCHING) as usize;
    painter.extend((0..lines).map(|i| {
        let foot = pos2(area.left() + HATCHING * (i as f32 + 0.5), area.top());
        Shape::line_segment([foot, foot + vec2(-area.height(), area.height())], style.hatching_stroke())
    }));
    let mark = area.center() - vec2(0.0, MARK);
    painter.circle(mark, MARK, style.ground(), style.card_stroke());
    let font = FontId::new(1.2 * MARK, strong_family());
    painter.text(mark, Align2::CENTER_CENTER, "?", font, style.faint());
    let place = Rect::from_center_size(mark, Vec2::splat(2.0 * MARK));
    let response = ui.interact(place, ui.scope_id().with("covered"), Sense::hover());
    tell(&response, Role::Label, "Covered");
    let width = (area.width() - 2.0 * MARK).clamp(1.0, SENTENCE);
    let galley = painter.layout(question.to_owned(), style.body(), style.ink(), width);
    let place = Align2::CENTER_TOP.anchor_size(mark + vec2(0.0, 1.5 * MARK), galley.size());
    if place.bottom() < area.bottom() {
        painter.rect_filled(place.expand(4.0), CORNER, style.ground());
        painter.galley(place.min, galley, style.ink());
    }
}

/// Draws a view on the ground of a card in all of `ui`, or a hint where that is smaller than `least`.
pub fn sized_ui(
    ui: &mut Ui,
    context: &mut ViewContext<'_>,
    least: Vec2,
    draw: impl FnOnce(&mut Ui, &mut ViewContext<'_>),
) {
    let area = ui.max_rect();
    if area.width() < least.x || area.height() < least.y {
        return too_small_ui(ui, &context.style, area);
    }
    ui.painter().rect_filled(area, 0.0, context.style.ground());
    draw(ui, context);
}

/// Draws a view of texts and tables, with a margin; it scrolls where not all of it fits.
pub fn page_ui(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    Frame::new().inner_margin(10.0).show(ui, |ui| {
        ui.set_min_size(ui.available_size());
        ScrollArea::vertical().auto_shrink(false).show(ui, contents);
    });
}

pub fn too_small_ui(ui: &mut Ui, style: &Style, area: Rect) {
    ui.painter().rect_filled(area, 0.0, style.ground());
    empty_ui(ui, style, area, "Too small to show: drag an edge of it, or press Z over it.");
}
