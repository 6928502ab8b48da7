//! Input on the axes of a view: wheel, drag, box and keys.

use eframe::egui::{PointerButton, Pos2, Rect, Response, Ui};

use super::memory::Memory;
use super::view::{Axis, View};
use super::zoom::{Ends, LONGEST, SHORTEST};

/// Zoom factor of a key press.
const KEY: f64 = 1.25;
/// Wheel travel in points that zooms by a factor of e.
const WHEEL: f64 = 200.0;
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

/// Zooms the axes of a view, which span `frame`, anywhere in `area`: the wheel both, over an axis that one,
/// with Shift the vertical one, and in a view over time the time. A double click restores the automatic ends.
pub(super) fn zoom_input(
    ui: &Ui,
    memory: &mut Memory,
    (view, [across, up]): (View, [Option<Axis>; 2]),
    response: &Response,
    (area, frame): (Rect, Rect),
) {
    let double_clicked = ui.input(|input| input.pointer.button_double_clicked(PointerButton::Primary));
    let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|at| area.contains(*at));
    let Some(at) = pointer.filter(|_| ui.rect_contains_pointer(area)) else { return };
    if double_clicked && response.contains_pointer() {
        return memory.free_axes(view);
    }
    let (turned, pinched, shift) =
        ui.input(|input| (input.smooth_scroll_delta(), f64::from(input.zoom_delta()), input.modifiers.shift));
    let (x, y) = share(frame, at);
    // with Shift the wheel scrolls sideways
    let turned = f64::from(if shift { turned.x + turned.y } else { turned.y });
    let by = if pinched == 1.0 { (-turned / WHEEL).exp() } else { 1.0 / pinched };
    let (besides, below) = (at.x < frame.left(), at.y > frame.bottom());
    let is_both = pinched != 1.0 || !shift && !besides && !below && across != Some(Axis::Time);
    let upwards = shift || besides;
    if let Some(across) = across.filter(|_| by != 1.0 && (is_both || !upwards)) {
        memory.zoom(across, by, x);
    }
    if let Some(up) = up.filter(|_| by != 1.0 && (is_both || upwards)) {
        memory.zoom(up, by, y);
    }
}

/// The shares of the axes at a place, those at the edges for places outside.
fn share(frame: Rect, at: Pos2) -> (f64, f64) {
    let across = f64::from((at.x - frame.left()) / frame.width());
    (across.clamp(0.0, 1.0), f64::from((frame.bottom() - at.y) / frame.height()).clamp(0.0, 1.0))
}
