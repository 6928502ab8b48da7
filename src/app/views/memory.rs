//! State that the views keep between frames.

use crate::app::session::Session;
use crate::mechanics::flexure::State;
use crate::scene::SweepAxis;

use super::cursors::Cursors;
use super::ranges::Ranges;
use super::span::Span;
use super::view::{Axis, View};
use super::zoom::Axes;

#[derive(Debug, Clone, Default)]
pub struct Memory {
    pub(super) frozen: FrozenAxes,
    pub(super) drawing: Drawing,
    /// Whether the first view that shows the mass is to grab it.
    pub grab: bool,
    /// Whether the motion is to be pinned.
    pub pin: bool,
    /// The view of which a figure is to be saved.
    pub figure: Option<View>,
    /// Whether measured data are to be opened.
    pub open_measured: bool,
    pub hovered: Option<View>,
    /// Whether hover texts are closed, since a key was pressed after the pointer moved last.
    pub hushed: bool,
    /// A view that a lesson covers until its first prediction has been shown.
    pub covered: Option<View>,
    /// The question over what a lesson covers.
    pub question: Option<String>,
    /// Displacements in mm of the stops about which a lesson asks, left and right.
    pub asked_stops: [Option<f64>; 2],
    /// Starts of which a lesson speaks: displacement in m and velocity in m/s.
    pub starts: Vec<(f64, f64)>,
    /// The largest acceleration of the base in m/s^2 in the open lesson, for which the Well has room.
    pub push_of_lesson: f64,
    pub timeline: Timeline,
    pub cursors: Cursors,
    /// Ends of axes chosen by hand.
    pub(super) axes: Axes,
    /// The row of the list of events that was marked last.
    pub(super) marked: Option<usize>,
    /// Ranges of the axes of velocity and power.
    pub(super) ranges: Ranges,
    pub map_look: MapLook,
    /// The axes of the whole map that was shown last.
    pub(super) map_axes: Option<[SweepAxis; 2]>,
    /// Whether the view Accuracy shows what a digit costs, where not both of its parts fit.
    pub(super) shows_digits: bool,
}

impl Memory {
    /// The x axis that views share, with room for all displacements seen.
    pub fn span(&mut self, session: &Session) -> Span {
        let Span { low, high } = self.place(session);
        let (low, high) = self.axes.ends(Axis::Place, (low, high));
        Span { low, high }
    }

    /// The same without what was chosen by hand.
    pub(super) fn place(&mut self, session: &Session) -> Span {
        let seen = self.ranges.follow(session).reach(session);
        let (low, high) = self.frozen.span.keep_mass(Span::of(session, seen), session);
        Span { low, high }
    }

    /// The axis of displacements of the views that show where the mass goes.
    pub(super) fn reach(&mut self, session: &Session) -> Span {
        let seen = self.ranges.follow(session).reach(session);
        let wanted = Span::of(session, seen).within_stops(session, seen);
        let (low, high) = self.frozen.reach.keep_mass(wanted, session);
        Span { low, high }
    }

    /// The state that remains from one step of a lesson to the next: axes that hold while they suit.
    pub fn for_another_step(&self) -> Self {
        Self { frozen: self.frozen, hushed: self.hushed, ..Self::default() }
    }

    /// The state that remains when another scene is opened.
    pub fn for_another_scene(&self) -> Self {
        Self { axes: self.axes.held(), ..Self::default() }
    }
}

/// An axis that is frozen while a gesture changes the scene, so that the effect of the gesture is seen.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct FrozenAxis(Option<(f64, f64)>);

/// Share of the axis by which the wanted ends may exceed a frozen axis before it moves.
const SPARE: f64 = 0.08;

/// Greatest length of a scale that is kept, as a multiple of the range that it has to show.
const LONGEST_KEPT: f64 = 8.0;

impl FrozenAxis {
    /// The same for an axis of displacements, which has to show the mass.
    fn keep_mass(&mut self, wanted: Span, session: &Session) -> (f64, f64) {
        let x = session.player.state().x;
        let is_seen = self.0.is_none_or(|(low, high)| low < x && x < high);
        self.keep((wanted.low, wanted.high), session.editor.in_gesture() && is_seen)
    }

    /// The `wanted` ends of the axis, or during a gesture the previous ones while they contain these.
    pub(super) fn keep(&mut self, wanted: (f64, f64), in_gesture: bool) -> (f64, f64) {
        let spare = SPARE * (wanted.1 - wanted.0);
        let contains = |old: &(f64, f64)| old.0 <= wanted.0 + spare && old.1 >= wanted.1 - spare;
        let ends = self.0.filter(|old| in_gesture && contains(old)).unwrap_or(wanted);
        *self.0.insert(ends)
    }

    /// The `wanted` ends of the axis, or the previous ones while they contain these and are no longer than
    /// [`LONGEST_KEPT`] times as long: the scale holds from one gesture to the next.
    pub(super) fn hold(&mut self, wanted: (f64, f64), in_gesture: bool) -> (f64, f64) {
        let length = wanted.1 - wanted.0;
        let spare = if in_gesture { SPARE * length } else { 0.0 };
        let holds = |old: &(f64, f64)| {
            let contains = old.0 <= wanted.0 + spare && old.1 >= wanted.1 - spare;
            contains && old.1 - old.0 <= LONGEST_KEPT * length
        };
        let ends = self.0.filter(holds).unwrap_or(wanted);
        *self.0.insert(ends)
    }
}

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct FrozenAxes {
    pub span: FrozenAxis,
    /// Displacements within the stops.
    pub reach: FrozenAxis,
    /// Potential energy.
    pub energy: FrozenAxis,
    /// The push in m/s^2 that the axis of potential energy has room for.
    pub room: f64,
    /// The units of potential energy in a J, and their name.
    pub unit: Option<(f64, &'static str)>,
    pub force: FrozenAxis,
}

/// A ring that grows and fades.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ring {
    /// Screen time in s at which it began.
    pub began: f64,
    /// Share of the energy scale.
    pub size: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MapLook {
    pub surface: bool,
    /// Whether cuts through the map at the scene are drawn beside it.
    pub cuts: bool,
    /// Whether the trail of the scene is drawn.
    pub trail: bool,
}

impl Default for MapLook {
    fn default() -> Self {
        Self { surface: false, cuts: false, trail: true }
    }
}

/// State of a drawing of the mechanism.
#[derive(Debug, Clone, Default)]
pub(super) struct Drawing {
    /// Rings of the last impacts on the left and the right stop.
    pub rings: [Option<Ring>; 2],
    /// Last solved shape of the flexures.
    pub bent: Option<State>,
    /// Time in s up to which impacts have been handled.
    pub seen_to: f64,
    /// Widths in points to the left and to the right of the picture of the well, with which it is in line.
    pub beside: (f32, f32),
}

/// Time range that the traces share.
#[derive(Debug, Clone, Copy, Default)]
pub struct Timeline {
    /// The length of time in s that a person has chosen.
    pub window: Option<f64>,
    /// The length of time in s that is shown otherwise.
    pub(super) default_window: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_stands_still_while_a_hand_moves_what_it_shows() {
        let mut axis = FrozenAxis::default();
        assert_eq!(axis.keep((-8.0, 8.0), false), (-8.0, 8.0));
        // a smaller or slightly larger range keeps the axis, a much larger one moves it
        assert_eq!(axis.keep((-4.0, 4.0), true), (-8.0, 8.0));
        assert_eq!(axis.keep((-9.0, 9.0), true), (-8.0, 8.0));
        assert_eq!(axis.keep((-12.0, 12.0), true), (-12.0, 12.0));
        assert_eq!(axis.keep((-9.0, 9.0), true), (-12.0, 12.0));
        assert_eq!(axis.keep((-9.0, 9.0), false), (-9.0, 9.0));
    }
}
