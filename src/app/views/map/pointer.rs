//! Pointer and keyboard input on the map: choosing a cell, dragging the cross-hair, enlarging a box.

use eframe::egui::{self, CursorIcon, Key, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, Vec2};

use crate::app::session::map::{Map, part};
use crate::app::ui::style::{GRAB, Style};
use crate::app::ui::widgets::{keep_arrows, tell};
use crate::scene::SweepAxis;

use super::super::ViewContext;
use super::super::memory::PointerState;
use super::super::pane::Pane;
use super::MAP;

/// Smallest side in points of a box that enlarges the map; a smaller one is an unsteady click.
const MIN_BOX: f32 = 10.0;

/// An action of pointer or keyboard on the map.
#[derive(Debug, Clone, PartialEq)]
pub enum MapAction {
    /// Take the scene to a cell.
    Cell(usize, usize),
    /// Take the scene to a cell during a drag, and whether the drag has ended.
    Drag(Option<(usize, usize)>, bool),
    /// Enlarge a part of the map.
    Part([SweepAxis; 2]),
    /// Enlarge the half of each axis around a cell.
    Closer(usize, usize),
    /// Return to the map before the last enlargement.
    Larger,
    Whole,
}

/// What pointer and keyboard act on.
pub struct Targets<'a> {
    pub map: &'a Map,
    pub is_enlarged: bool,
    pub style: Style,
    /// The cell at a screen position.
    pub cell_at: &'a dyn Fn(Pos2) -> Option<(usize, usize)>,
    pub pane: &'a Pane,
    /// Bounds of a drag of the cross-hair.
    pub rect: Rect,
    /// Position of the scene, and its cell or the nearest one.
    pub scene: (Pos2, (usize, usize)),
}

/// Handles pointer and keyboard. Returns the action, if any.
pub fn action_ui(ui: &Ui, state: &mut PointerState, targets: &Targets<'_>) -> Option<MapAction> {
    // a double click has a meaning only on an enlarged map
    let second = ui.options(|options| options.input_options.max_double_click_delay);
    let wait = if targets.is_enlarged { second } else { 0.0 };
    if let Some(action) = cross_hair_ui(ui, targets) {
        return Some(action);
    }
    let (time, style) = (ui.input(|input| input.time), targets.style);
    let response = &targets.pane.response;
    // no box is drawn over a surface
    if let Some(frame) = targets.pane.frame(MAP) {
        let pointer = response.interact_pointer_pos().map(|at| frame.clamp(at));
        if response.drag_started() {
            let origin = ui.input(|input| input.pointer.press_origin());
            state.corner = origin.filter(|at| frame.contains(*at));
        }
        if let (Some(corner), Some(pointer)) = (state.corner, pointer) {
            let dragged = Rect::from_two_pos(corner, pointer);
            let painter = ui.painter();
            painter.rect_filled(dragged, 0.0, style.veil());
            painter.rect_stroke(dragged, 0.0, Stroke::new(1.5, style.ink()), StrokeKind::Inside);
            if response.drag_stopped() {
                state.corner = None;
                let large = dragged.width() >= MIN_BOX && dragged.height() >= MIN_BOX;
                let (left, low) = targets.pane.values_at(MAP, dragged.left_bottom())?;
                let (right, high) = targets.pane.values_at(MAP, dragged.right_top())?;
                let [across, up] = &targets.map.question.axes;
                let axes = [part(across, left, right), part(up, low, high)];
                return large.then_some(MapAction::Part(axes));
            }
        }
    } else {
        state.corner = None;
    }
    if response.double_clicked() {
        state.clicked = None;
        return Some(MapAction::Whole);
    }
    if response.clicked() {
        let cell = response.interact_pointer_pos().and_then(targets.cell_at)?;
        state.clicked = Some((cell, time));
    }
    let ((column, row), since) = state.clicked?;
    if time - since < wait {
        ui.ctx().request_repaint_after_secs((wait - (time - since)) as f32);
        return None;
    }
    state.clicked = None;
    Some(MapAction::Cell(column, row))
}

/// Handles the cross-hair: dragging, moving by the arrow keys, and enlarging around it.
fn cross_hair_ui(ui: &Ui, targets: &Targets<'_>) -> Option<MapAction> {
    let (at, (column, row)) = targets.scene;
    let grab = Rect::from_center_size(at, Vec2::splat(2.0 * GRAB));
    let id = ui.scope_id().with("cross-hair");
    let response = ui.interact(grab, id, Sense::drag()).on_hover_and_drag_cursor(CursorIcon::Move);
    tell(&response, egui::Role::Slider, "cross-hair");
    if response.dragged() || response.drag_stopped() {
        let inside = |at: Pos2| targets.rect.shrink(0.5).clamp(at);
        let cell = response.interact_pointer_pos().and_then(|at| (targets.cell_at)(inside(at)));
        return Some(MapAction::Drag(cell, response.drag_stopped()));
    }
    if !response.has_focus() {
        return None;
    }
    ui.painter().circle_stroke(at, GRAB, targets.style.focus_stroke());
    keep_arrows(ui, id, true);
    let presses = |key| ui.input(|input| i64::try_from(input.num_presses(key)).unwrap_or(0));
    if presses(Key::Plus) + presses(Key::Equals) > 0 {
        return Some(MapAction::Closer(column, row));
    }
    if presses(Key::Minus) > 0 {
        return Some(MapAction::Larger);
    }
    let across = presses(Key::ArrowRight) - presses(Key::ArrowLeft);
    let up = presses(Key::ArrowUp) - presses(Key::ArrowDown);
    if (across, up) == (0, 0) {
        return None;
    }
    let [columns, rows] = targets.map.size();
    let moved = |i: usize, by: i64, count: usize| i.saturating_add_signed(by as isize).min(count - 1);
    Some(MapAction::Cell(moved(column, across, columns), moved(row, up, rows)))
}

pub fn perform(context: &mut ViewContext<'_>, action: Option<MapAction>) {
    let session = &mut *context.session;
    match action {
        Some(MapAction::Cell(column, row)) => session.go_to_cell(column, row),
        Some(MapAction::Drag(cell, ended)) => {
            session.end_presses();
            if let Some((column, row)) = cell {
                session.drag_to_cell(column, row);
            }
            if ended {
                session.end_gesture();
            }
        }
        Some(MapAction::Part(axes)) if session.map_problem(&axes).is_none() => {
            session.map.enlarged.push(axes)
        }
        Some(MapAction::Closer(column, row)) => {
            let (Some(axes), Some((map, _))) = (session.map_axes(), session.map.shown()) else { return };
            // the axes chosen last, even if their map is not computed yet
            let around = |i: usize, place: usize| {
                let (axis, value) = (&axes[i], map.edges[i].values[place]);
                let quarter = 0.25 * (axis.to - axis.from);
                let middle = value.max(axis.from + quarter).min(axis.to - quarter);
                part(axis, middle - quarter, middle + quarter)
            };
            let axes = [around(0, column), around(1, row)];
            if session.map_problem(&axes).is_none() {
                session.map.enlarged.push(axes);
            }
        }
        Some(MapAction::Larger) => _ = session.map.enlarged.pop(),
        Some(MapAction::Whole) => session.map.enlarged.clear(),
        Some(MapAction::Part(_)) | None => {}
    }
}
