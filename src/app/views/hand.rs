//! Input on the axes of a view: wheel, drag, box and keys.

use eframe::egui::{PointerButton, Pos2, Rect, Response, Shape, Stroke, StrokeKind, Ui};

use super::memory::Memory;
use super::view::{Axis, View};
use super::zoom::{Ends, LONGEST, SHORTEST};

/// Zoom factor of a key press.
const KEY: f64 = 1.25;
/// Wheel travel in points that zooms by a factor of e.
const WHEEL: f64 = 200.0;
/// Smallest side in points of a zoom box.
const BOX: f32 = 6.0;

impl Memory {
    /// Multiplies the length of an axis by `by`, with the point at the share `about` fixed. The time axis
    /// ends at the present unless its ends were chosen by hand.
    fn zoom(&mut self, axis: Axis, by: f64, about: f64) {
        if axis != Axis::Time || self.axes.chosen(axis).is_some() {
            return self.axes.zoom(axis, by, about);
        }
        let default = self.timeline.default_window;
        if by > 0.0 && by.is_finite() && default > 0.0 {
            let window = self.timeline.window.unwrap_or(default) * by;
            self.timeline.window = Some(window.clamp(SHORTEST * default, LONGEST * default));
        }
    }

    /// Zooms the horizontal axis of a view by a key press, or the vertical one if `upwards`.
    pub fn zoom_by_key(&mut self, view: View, upwards: bool, closer: bool) {
        let Some(axes) = view.axes() else { return };
        self.zoom(axes[usize::from(upwards)], if closer { 1.0 / KEY } else { KEY }, 0.5);
    }

    /// Returns the axes of a view to their automatic ends.
    pub fn free_axes(&mut self, view: View) {
        if view.axes().is_some_and(|axes| axes.contains(&Axis::Time)) {
            self.timeline.window = None;
        }
        self.axes.free(view);
    }

    /// Holds the axes of a view at their present ends, or frees held ones. Returns whether they are held now.
    pub fn hold_axes(&mut self, view: View) -> bool {
        self.axes.hold(view);
        self.axes.is_held(view)
    }

    /// The ends chosen by hand for the horizontal and the vertical axis of a view.
    pub fn chosen_axes(&self, view: View) -> [Option<Ends>; 2] {
        view.axes().map_or([None; 2], |axes| axes.map(|axis| self.axes.chosen(axis)))
    }

    /// Whether the axes of a view are held. `None` if it has no axes.
    pub fn are_axes_held(&self, view: View) -> Option<bool> {
        view.axes().map(|_| self.axes.is_held(view))
    }
}

/// Zooms and pans the axes of a view, which span `frame`, anywhere in `area`. The wheel zooms the horizontal
/// axis, with Shift or left of the frame the vertical one, with Ctrl both. A drag with Shift pans, one with
/// the secondary button draws a box to zoom to. A double click restores the automatic ends.
pub(super) fn axes_input(
    ui: &Ui,
    memory: &mut Memory,
    view: View,
    response: &Response,
    (area, frame): (Rect, Rect),
) {
    let Some([across, up]) = view.axes() else { return };
    let double_clicked = ui.input(|input| input.pointer.button_double_clicked(PointerButton::Primary));
    let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|at| area.contains(*at));
    let Some(at) = pointer.filter(|_| ui.rect_contains_pointer(area)) else { return };
    if double_clicked && response.contains_pointer() {
        return memory.free_axes(view);
    }
    let share = |at: Pos2| {
        let across = f64::from((at.x - frame.left()) / frame.width());
        (across.clamp(0.0, 1.0), f64::from((frame.bottom() - at.y) / frame.height()).clamp(0.0, 1.0))
    };
    let (turned, pinched, shift) =
        ui.input(|input| (input.smooth_scroll_delta(), f64::from(input.zoom_delta()), input.modifiers.shift));
    let ((x, y), upwards) = (share(at), shift || at.x < frame.left());
    // with Shift the wheel scrolls sideways
    let turned = if upwards { turned.x + turned.y } else { turned.y };
    let by = (-f64::from(turned) / WHEEL).exp();
    if pinched != 1.0 {
        memory.zoom(across, 1.0 / pinched, x);
        memory.zoom(up, 1.0 / pinched, y);
    } else if by != 1.0 {
        let (axis, about) = if upwards { (up, y) } else { (across, x) };
        memory.zoom(axis, by, about);
    }
    if shift && response.dragged_by(PointerButton::Primary) {
        let moved = response.drag_delta();
        memory.axes.pan(across, -f64::from(moved.x / frame.width()));
        memory.axes.pan(up, f64::from(moved.y / frame.height()));
    }
    let origin = ui.input(|input| input.pointer.press_origin());
    if let Some(corner) = origin.filter(|_| response.dragged_by(PointerButton::Secondary)) {
        let drawn = Rect::from_two_pos(corner, at).intersect(frame);
        let stroke = Stroke::new(1.0, ui.visuals().text_color());
        ui.painter().add(Shape::rect_stroke(drawn, 0.0, stroke, StrokeKind::Inside));
        memory.corner = Some((corner, at));
        return;
    }
    let ended = response.drag_stopped_by(PointerButton::Secondary);
    let Some((corner, at)) = memory.corner.take_if(|_| ended) else { return };
    let drawn = Rect::from_two_pos(corner, at);
    if drawn.width() < BOX || drawn.height() < BOX {
        return;
    }
    let ((left, top), (right, bottom)) = (share(drawn.min), share(drawn.max));
    for (axis, from, to) in [(across, left, right), (up, bottom, top)] {
        if let Some((low, high)) = memory.axes.shown(axis) {
            memory.axes.choose(axis, (low + from * (high - low), low + to * (high - low)));
        }
    }
}
