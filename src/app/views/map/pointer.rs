//! The cross-hair of the map: dragged, or moved by the arrow keys.

use eframe::egui::{self, CursorIcon, Key, Pos2, Rect, Sense, Ui, Vec2};

use crate::app::ui::style::{GRAB, Style};
use crate::app::ui::widgets::{keep_arrows, tell};

use super::super::ViewContext;
use super::super::view::View;

/// Column and row.
type Cell = (usize, usize);

/// What the cross-hair did.
pub enum Moved {
    /// Dragged to a cell, or beyond all, and whether the drag has ended.
    Drag(Option<Cell>, bool),
    /// A step to a cell.
    Step(Cell),
    /// Both axes around the cross-hair, closer or not.
    Zoom(bool),
}

/// The cross-hair at a place and a cell, over a map of so many columns and rows in `frame`.
pub fn cross_hair_ui(
    ui: &Ui,
    style: &Style,
    (at, (column, row)): (Pos2, Cell),
    frame: Rect,
    [columns, rows]: [usize; 2],
    cell_at: &dyn Fn(Pos2) -> Option<Cell>,
) -> Option<Moved> {
    let grab = Rect::from_center_size(at, Vec2::splat(2.0 * GRAB));
    let id = ui.scope_id().with("cross-hair");
    let response = ui.interact(grab, id, Sense::drag()).on_hover_and_drag_cursor(CursorIcon::Move);
    tell(&response, egui::Role::Slider, "cross-hair");
    if response.dragged() || response.drag_stopped() {
        let inside = |at: Pos2| frame.shrink(0.5).clamp(at);
        let cell = response.interact_pointer_pos().and_then(|at| cell_at(inside(at)));
        return Some(Moved::Drag(cell, response.drag_stopped()));
    }
    if !response.has_focus() {
        return None;
    }
    ui.painter().circle_stroke(at, GRAB, style.focus_stroke());
    keep_arrows(ui, id, true);
    let presses = |key| ui.input(|input| i64::try_from(input.num_presses(key)).unwrap_or(0));
    let closer = presses(Key::Plus) + presses(Key::Equals) > 0;
    if closer || presses(Key::Minus) > 0 {
        return Some(Moved::Zoom(closer));
    }
    let across = presses(Key::ArrowRight) - presses(Key::ArrowLeft);
    let up = presses(Key::ArrowUp) - presses(Key::ArrowDown);
    let moved = |i: usize, by: i64, count: usize| i.saturating_add_signed(by as isize).min(count - 1);
    ((across, up) != (0, 0)).then(|| Moved::Step((moved(column, across, columns), moved(row, up, rows))))
}

/// Takes the scene to a cell that was chosen, or where the cross-hair was moved.
pub fn perform(context: &mut ViewContext<'_>, chosen: Option<Cell>, moved: Option<Moved>) {
    let session = &mut *context.session;
    match moved {
        Some(Moved::Drag(cell, ended)) => {
            session.end_presses();
            if let Some((column, row)) = cell {
                session.drag_to_cell(column, row);
            }
            if ended {
                session.end_gesture();
            }
        }
        Some(Moved::Step((column, row))) => session.go_to_cell(column, row),
        Some(Moved::Zoom(closer)) => {
            context.memory.zoom_by_key(View::Map, false, closer);
            context.memory.zoom_by_key(View::Map, true, closer);
        }
        None => {
            if let Some((column, row)) = chosen {
                session.go_to_cell(column, row);
            }
        }
    }
}
