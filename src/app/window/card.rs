//! Card of a view: its title in a row with its legend, and tools at the right of that row. The tools are
//! drawn while the pointer is over the card. The keyboard and screen readers can use them at any time.

use eframe::egui::{self, Align2, FontId, Rect, Response, Sense, Ui, UiBuilder, pos2, vec2};

use crate::app::ui::style::{BODY, CONTROL, CORNER, LEAST, SMALL, strong_family};
use crate::app::ui::widgets::{Icon, tool_ui};
use crate::app::views::{LegendRow, View, ViewContext, view_ui};

/// Height in points of the row with the titles.
const ROW: f32 = CONTROL;
/// Distance in points of the titles from the edge of the card, and half of that between two titles.
const MARGIN: f32 = 8.0;
/// Width in points of a tool, and the greatest number of tools.
const TOOL: f32 = 24.0;
const MOST_TOOLS: u8 = 3;
/// Width in points that the caption of the mechanism needs beside the titles; with less room it is in a row
/// below.
const CAPTION_ROOM: f32 = 220.0;
/// Distance in points of a view from the edge of its card, so that the corners of the card stay round.
const INSET: f32 = 2.0;

/// A view whose title stands in a card.
#[derive(Debug, Clone, Copy)]
pub struct Title {
    pub view: View,
    pub id: egui::Id,
}

/// Input in the row of a card.
pub struct Answer {
    /// The title that was clicked.
    pub chosen: Option<View>,
    /// Whether the view is to fill the window or, if it does, all views are to be shown again.
    pub fills: bool,
}

/// Draws a view in a card, with the titles of all views that share it. A view that fills the window has a
/// tool that shows all views again.
pub fn card_ui(ui: &mut Ui, titles: &[Title], view: View, context: &mut ViewContext<'_>) -> Answer {
    let (rect, style) = (ui.max_rect(), context.style);
    ui.painter().rect_filled(rect, CORNER, style.ground());
    let row = rect.with_max_y(rect.top() + ROW);
    let has_axes = context.memory.are_axes_held(view).is_some();
    let count = 1 + u8::from(!context.filled) + u8::from(has_axes);
    let tools = f32::from(count) * TOOL + 4.0;
    // the letters stay whichever of the views is in front
    let font = title_font(ui, titles, row.width() - f32::from(MOST_TOOLS) * TOOL - 4.0 - MARGIN);
    let width: f32 = titles.iter().map(|title| width_of(ui, title, &font)).sum();
    let free = LegendRow { left: row.left() + MARGIN + width, right: row.right() - tools };
    let shares = view == View::Mechanism && free.right - free.left >= CAPTION_ROOM;
    let top = if shares { rect.top() + 0.5 * (ROW - LegendRow::HEIGHT) } else { row.bottom() };
    let inner = Rect::from_min_max(pos2(rect.left() + INSET, top), rect.max - vec2(INSET, INSET + 2.0));
    let mut info = egui::UiStackInfo::default();
    if shares {
        info = info.with_tag_value(LegendRow::TAG, free);
    }
    ui.scope_builder(UiBuilder::new().max_rect(inner).ui_stack_info(info), |ui| {
        ui.set_clip_rect(inner.intersect(ui.clip_rect()));
        view_ui(ui, view, context);
    });
    let (mut chosen, mut left) = (None, row.left() + MARGIN);
    // a title can be dragged with its view; the one in front is underlined if there are several
    let sense = if context.filled { Sense::hover() } else { Sense::click_and_drag() };
    for title in titles {
        let (in_front, name) = (title.view == view, title.view.name());
        let right = left + width_of(ui, title, &font);
        let place = row.with_min_x(left - 0.5 * MARGIN).with_max_x(right - 0.5 * MARGIN);
        let response = ui.interact(place, title.id, sense);
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, in_front, name));
        let colour = if in_front || response.hovered() { style.ink() } else { style.faint() };
        let at = pos2(place.left() + 0.5 * MARGIN, place.center().y);
        let written = ui.painter().text(at, Align2::LEFT_CENTER, name, font.clone(), colour);
        if in_front && titles.len() > 1 {
            let stroke = egui::Stroke::new(2.0, style.accent());
            ui.painter().hline(written.x_range(), place.bottom() - 3.0, stroke);
        }
        if response.on_hover_text(title.view.about()).clicked() {
            chosen = Some(title.view);
        }
        left = right;
    }
    // tools that would lie over the titles are left to menus and keys
    let fills = free.left <= free.right && tools_ui(ui, rect, row, view, context);
    ui.painter().rect_stroke(rect, CORNER, style.card_stroke(), egui::StrokeKind::Inside);
    Answer { chosen, fills }
}

/// The largest text size at which the titles fit side by side into `room`.
fn title_font(ui: &Ui, titles: &[Title], room: f32) -> FontId {
    let font = |size: f32| FontId::new(size, strong_family());
    let width = |size: f32| titles.iter().map(|title| width_of(ui, title, &font(size))).sum::<f32>();
    font([BODY, SMALL].into_iter().find(|size| width(*size) <= room).unwrap_or(LEAST))
}

fn width_of(ui: &Ui, title: &Title, font: &FontId) -> f32 {
    let name = title.view.name().to_owned();
    ui.painter().layout_no_wrap(name, font.clone(), egui::Color32::PLACEHOLDER).size().x + 1.5 * MARGIN
}

/// The tools at the right of the row. Returns whether the tool that fills the window, or shows all views, was
/// clicked.
fn tools_ui(ui: &mut Ui, card: Rect, row: Rect, view: View, context: &mut ViewContext<'_>) -> bool {
    let is_over = ui.rect_contains_pointer(card);
    let shown = is_over || context.style.projector || context.filled;
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    let builder = UiBuilder::new().max_rect(row.with_max_x(row.right() - 4.0)).layout(layout);
    let (fill, held) = ui
        .scope_builder(builder, |ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            let fill = match context.filled {
                true => tool_ui(ui, Icon::Restore, TOOL, "all views", "All views again (Z or Esc)", true),
                false => {
                    let name = format!("fill the window with {}", view.name());
                    tool_ui(ui, Icon::Fill, TOOL, &name, "This view over the whole window (Z)", shown)
                }
            };
            if !context.filled {
                let name = format!("figure of {}", view.name());
                let hover = "Save a figure of this view (Ctrl+E)";
                if tool_ui(ui, Icon::Figure, TOOL, &name, hover, shown).clicked() {
                    context.memory.figure = Some(view);
                }
            }
            (fill, hold_ui(ui, view, context, shown))
        })
        .inner;
    // keys act on the view under the pointer, or whose tools have the focus
    if is_over || fill.has_focus() || held.is_some_and(|tool| tool.has_focus()) {
        context.memory.hovered = Some(view);
    }
    fill.clicked()
}

/// The tool that holds the axes of a view, which stays visible while they are held; `None` if it has no axes.
fn hold_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>, shown: bool) -> Option<Response> {
    let held = context.memory.are_axes_held(view)?;
    let (icon, name, hover) = match held {
        true => (Icon::Held, "let go of the axes of", "The axes are held. A click lets go of them (L)."),
        false => (Icon::Free, "hold the axes of", "Hold the axes at their present ranges (L)."),
    };
    let response = tool_ui(ui, icon, TOOL, &format!("{name} {}", view.name()), hover, shown || held);
    if response.clicked() {
        context.memory.hold_axes(view);
    }
    Some(response)
}
