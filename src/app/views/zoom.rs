//! Ends of axes: as the scene and the motion give them, or as a hand has chosen them.
//!
//! An axis that a hand has chosen stands still until a double click. One that is held stays even when another
//! scene is opened, so that two scenes can be compared. The views over time share their time axis and those
//! along the displacement share that.

use std::collections::HashMap;

use eframe::egui::{PointerButton, Pos2, Rect, Response, Shape, Stroke, StrokeKind, Ui};

use super::memory::Memory;
use super::view::View;

/// How much longer than its own an axis may be chosen, how much shorter, and by which factor a key takes it.
const LONGEST: f64 = 10.0;
const SHORTEST: f64 = 1e-3;
const KEY: f64 = 1.25;

/// Points that the wheel turns for a factor of e.
const WHEEL: f64 = 200.0;

/// The least sides in points of a box that is drawn.
const BOX: f32 = 6.0;

/// The ends of an axis in its unit; of the displacement in m, of time in s.
pub type Ends = (f64, f64);

/// An axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Axis {
    /// The time of the traces.
    Time,
    /// The displacement, in m.
    Place,
    /// That of one view, to the right.
    Across(View),
    /// That of one view, upwards.
    Up(View),
}

impl View {
    /// Its axes to the right and upwards, where a hand can choose their ends.
    pub(super) fn axes(self) -> Option<[Axis; 2]> {
        let across = match self {
            Self::Displacement | Self::Velocity | Self::BaseAcceleration | Self::Power => Axis::Time,
            Self::Well | Self::PhasePortrait | Self::Section | Self::ForceCurve | Self::Basins => Axis::Place,
            Self::Distance | Self::UpAndDown | Self::Spectrum => Axis::Across(self),
            Self::SideBySide => return Self::Well.axes(),
            _ => return None,
        };
        Some([across, Axis::Up(self)])
    }
}

#[derive(Debug, Clone, Copy)]
struct Chosen {
    ends: Ends,
    held: bool,
}

/// The ends of all axes.
#[derive(Debug, Clone, Default)]
pub struct Axes {
    chosen: HashMap<Axis, Chosen>,
    /// As they would be by themselves and as they are, when they were shown last.
    shown: HashMap<Axis, (Ends, Ends)>,
}

impl Axes {
    /// The ends of an axis that would by itself have its `own`.
    pub(super) fn ends(&mut self, axis: Axis, own: Ends) -> Ends {
        let ends = self.chosen(axis).unwrap_or(own);
        self.shown.insert(axis, (own, ends));
        ends
    }

    /// The ends that a hand has chosen.
    pub(super) fn chosen(&self, axis: Axis) -> Option<Ends> {
        self.chosen.get(&axis).map(|own| own.ends)
    }

    /// As it was shown last.
    pub(super) fn shown(&self, axis: Axis) -> Option<Ends> {
        self.shown.get(&axis).map(|own| own.1)
    }

    /// Whether a view keeps its axes whatever the motion and the scene do.
    pub(super) fn is_held(&self, view: View) -> bool {
        let held = |axis: &Axis| self.chosen.get(axis).is_some_and(|own| own.held);
        view.axes().is_some_and(|axes| axes.iter().all(held))
    }

    /// Holds the axes of a view as they are, or lets go of them.
    pub(super) fn hold(&mut self, view: View) {
        if self.is_held(view) {
            return self.free(view);
        }
        for axis in view.axes().into_iter().flatten() {
            if let Some(ends) = self.shown(axis) {
                self.chosen.insert(axis, Chosen { ends, held: true });
            }
        }
    }

    /// Leaves the axes of a view to the scene and the motion.
    pub(super) fn free(&mut self, view: View) {
        view.axes().into_iter().flatten().for_each(|axis| _ = self.chosen.remove(&axis));
    }

    /// What stays when another scene is opened.
    pub(super) fn held(&self) -> Self {
        let held = self.chosen.iter().filter(|own| own.1.held).map(|own| (*own.0, *own.1));
        Self { chosen: held.collect(), shown: HashMap::new() }
    }

    fn choose(&mut self, axis: Axis, ends: Ends) {
        let Some((own, _)) = self.shown.get(&axis) else { return };
        let held = self.chosen.get(&axis).is_some_and(|chosen| chosen.held);
        let whole = ends.0 <= own.0 && ends.1 >= own.1;
        let (length, least) = (ends.1 - ends.0, SHORTEST * (own.1 - own.0));
        if whole && !held && axis != Axis::Time {
            // all that there is, is as good as nothing chosen
            self.chosen.remove(&axis);
        } else if length >= least && length <= LONGEST * (own.1 - own.0) {
            self.chosen.insert(axis, Chosen { ends, held });
        }
    }

    /// Makes an axis longer by a factor about a share of it from its lower end.
    fn zoom(&mut self, axis: Axis, by: f64, about: f64) {
        let Some((low, high)) = self.shown(axis).filter(|_| by > 0.0 && by.is_finite()) else { return };
        let middle = low + about * (high - low);
        self.choose(axis, (middle - (middle - low) * by, middle + (high - middle) * by));
    }

    /// Moves what is shown by a share of the axis.
    fn pan(&mut self, axis: Axis, share: f64) {
        let Some((low, high)) = self.shown(axis) else { return };
        let by = share * (high - low);
        let held = self.chosen.get(&axis).is_some_and(|chosen| chosen.held);
        self.chosen.insert(axis, Chosen { ends: (low + by, high + by), held });
    }
}

impl Memory {
    /// Makes an axis longer by a factor about a share of it. The stretch of time ends at the present, unless
    /// a hand has chosen when it begins.
    fn zoom(&mut self, axis: Axis, by: f64, about: f64) {
        if axis != Axis::Time || self.axes.chosen(axis).is_some() {
            return self.axes.zoom(axis, by, about);
        }
        let own = self.timeline.own;
        if by > 0.0 && by.is_finite() && own > 0.0 {
            let window = self.timeline.window.unwrap_or(own) * by;
            self.timeline.window = Some(window.clamp(SHORTEST * own, LONGEST * own));
        }
    }

    /// Zooms the axis of a view to the right, or upwards, by a key.
    pub fn zoom_by_key(&mut self, view: View, upwards: bool, closer: bool) {
        let Some(axes) = view.axes() else { return };
        self.zoom(axes[usize::from(upwards)], if closer { 1.0 / KEY } else { KEY }, 0.5);
    }

    /// Leaves the axes of a view to the scene and the motion.
    pub fn free_axes(&mut self, view: View) {
        if view.axes().is_some_and(|axes| axes.contains(&Axis::Time)) {
            self.timeline.window = None;
        }
        self.axes.free(view);
    }

    /// Holds the axes of a view as they are, or lets go of them. Whether they are held now.
    pub fn hold_axes(&mut self, view: View) -> bool {
        self.axes.hold(view);
        self.axes.is_held(view)
    }

    /// The ends that a hand has chosen for the axes of a view, to the right and upwards.
    pub fn chosen_axes(&self, view: View) -> [Option<Ends>; 2] {
        view.axes().map_or([None; 2], |axes| axes.map(|axis| self.axes.chosen(axis)))
    }

    /// Whether the axes of a view are held; none where it has no axes.
    pub fn are_axes_held(&self, view: View) -> Option<bool> {
        view.axes().map(|_| self.axes.is_held(view))
    }
}

/// The wheel zooms to the right, with Shift or over the numbers of the vertical axis upwards, with Ctrl both;
/// a drag with Shift moves what is shown, one with the other button draws a box to be shown; a double click
/// is back. `area` is the view and `frame` what its axes span.
pub(super) fn hand(
    ui: &Ui,
    memory: &mut Memory,
    view: View,
    response: &Response,
    (area, frame): (Rect, Rect),
) {
    let Some([across, up]) = view.axes() else { return };
    let twice = ui.input(|input| input.pointer.button_double_clicked(PointerButton::Primary));
    let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|at| area.contains(*at));
    let Some(at) = pointer.filter(|_| ui.rect_contains_pointer(area)) else { return };
    if twice && response.contains_pointer() {
        return memory.free_axes(view);
    }
    let share = |at: Pos2| {
        let across = f64::from((at.x - frame.left()) / frame.width());
        (across.clamp(0.0, 1.0), f64::from((frame.bottom() - at.y) / frame.height()).clamp(0.0, 1.0))
    };
    let (turned, pinched, shift) = ui.input(|input| {
        let turned = input.smooth_scroll_delta();
        // with Shift a wheel goes sideways
        (f64::from(turned.x + turned.y), f64::from(input.zoom_delta()), input.modifiers.shift)
    });
    let (x, y) = share(at);
    let by = (-turned / WHEEL).exp();
    if pinched != 1.0 {
        memory.zoom(across, 1.0 / pinched, x);
        memory.zoom(up, 1.0 / pinched, y);
    } else if by != 1.0 {
        let (axis, about) = if shift || at.x < frame.left() { (up, y) } else { (across, x) };
        memory.zoom(axis, by, about);
    }
    if shift && response.dragged_by(PointerButton::Primary) {
        let moved = response.drag_delta();
        memory.axes.pan(across, -f64::from(moved.x / frame.width()));
        memory.axes.pan(up, f64::from(moved.y / frame.height()));
    }
    let begun = ui.input(|input| input.pointer.press_origin());
    let Some(corner) = begun.filter(|_| response.dragged_by(PointerButton::Secondary)) else {
        return box_ended(memory, (across, up), response, share);
    };
    let drawn = Rect::from_two_pos(corner, at).intersect(frame);
    let stroke = Stroke::new(1.0, ui.visuals().text_color());
    ui.painter().add(Shape::rect_stroke(drawn, 0.0, stroke, StrokeKind::Inside));
    memory.corner = Some((corner, at));
}

/// Shows the box that was drawn, once the hand lets go of it.
fn box_ended(
    memory: &mut Memory,
    (across, up): (Axis, Axis),
    response: &Response,
    share: impl Fn(Pos2) -> (f64, f64),
) {
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

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Axis = Axis::Up(View::Velocity);

    #[test]
    fn a_zoom_keeps_what_is_under_the_pointer_and_ends_at_the_whole() {
        let mut axes = Axes::default();
        assert_eq!(axes.ends(UP, (-4.0, 4.0)), (-4.0, 4.0));
        axes.zoom(UP, 0.5, 0.25);
        assert_eq!(axes.ends(UP, (-4.0, 4.0)), (-3.0, 1.0));
        // it stands still while the motion takes more room
        assert_eq!(axes.ends(UP, (-8.0, 8.0)), (-3.0, 1.0));
        axes.zoom(UP, 1e-9, 0.5);
        assert_eq!(axes.chosen(UP), Some((-3.0, 1.0)));
        axes.zoom(UP, 6.0, 0.5);
        assert_eq!(axes.chosen(UP), None);
    }

    #[test]
    fn what_is_held_stays_and_what_is_chosen_does_not() {
        let mut axes = Axes::default();
        axes.ends(Axis::Time, (0.0, 2.0));
        axes.ends(UP, (-1.0, 1.0));
        axes.hold(View::Velocity);
        assert!(axes.is_held(View::Velocity) && !axes.is_held(View::Power));
        axes.ends(Axis::Up(View::Power), (0.0, 1.0));
        axes.pan(Axis::Up(View::Power), 0.5);
        let mut other = axes.held();
        assert_eq!(other.ends(UP, (-9.0, 9.0)), (-1.0, 1.0));
        assert_eq!(other.ends(Axis::Time, (5.0, 6.0)), (0.0, 2.0));
        assert_eq!(other.ends(Axis::Up(View::Power), (0.0, 1.0)), (0.0, 1.0));
        other.hold(View::Velocity);
        assert_eq!(other.ends(UP, (-9.0, 9.0)), (-9.0, 9.0));
    }
}
