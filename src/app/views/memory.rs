//! What views keep between frames.

use eframe::egui::Pos2;

use crate::app::session::Session;
use crate::app::session::pins::PinKind;
use crate::mechanics::flexure::State;

use super::cursor_times::Cursors;
use super::ranges::Ranges;
use super::span::Span;
use super::view::{Axis, View};
use super::zoom::Axes;

/// What views keep between frames.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    /// Axes that stand still during a gesture.
    pub(super) held: HeldAxes,
    pub(super) drawing: Drawing,
    /// The mass is to be taken hold of by the first view that has it.
    pub grab: bool,
    /// What is to be pinned.
    pub pin: Option<PinKind>,
    /// The view of which a figure is to be saved.
    pub figure: Option<View>,
    /// Measured data are to be opened.
    pub open_measured: bool,
    pub hovered: Option<View>,
    pub timeline: Timeline,
    /// Two cursors over time.
    pub cursors: Cursors,
    /// Ends of axes that a hand has chosen.
    pub(super) axes: Axes,
    /// Where a box begins and ends that is drawn, to be shown.
    pub(super) corner: Option<(Pos2, Pos2)>,
    /// The same of the pinned motion that is drawn beside the present one, and which of the pins it is.
    pub(super) beside: Drawing,
    pub(super) beside_place: usize,
    /// The row of the list of events that was marked last.
    pub(super) marked: Option<usize>,
    /// How far axes of velocity and power reach.
    pub(super) ranges: Ranges,
    /// The phase portrait shows a point a period and no path.
    pub points_only: bool,
    pub map_look: MapLook,
    pub(super) map_pointer: PointerState,
    /// What the view Accuracy shows where there is no room for all of it.
    pub(super) accuracy_page: Page,
}

impl Memory {
    /// The x axis that views share, with room for what has been seen.
    pub fn span(&mut self, session: &Session) -> Span {
        let seen = self.ranges.follow(session).reach(session);
        let own = Span::of(session, seen);
        let x = session.player.state().x;
        let is_seen = self.held.span.0.is_none_or(|(low, high)| low < x && x < high);
        let held = session.editor.in_gesture() && is_seen;
        let own = self.held.span.keep((own.low, own.high), held);
        let (low, high) = self.axes.ends(Axis::Place, own);
        Span { low, high }
    }

    /// What stays of it when another scene is opened.
    pub fn for_another_scene(&self) -> Self {
        Self { axes: self.axes.held(), ..Self::default() }
    }
}

/// An axis that stands still while a hand changes the scene, so that what the hand does to it is seen.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Held(Option<(f64, f64)>);

/// The room in an axis, as a share of it, that may be used up before an axis that is held gives way.
const SPARE: f64 = 0.08;

impl Held {
    /// The ends of the axis: those that it should have, or in the midst of a gesture those that it had, as
    /// long as what it has to show is inside.
    pub(super) fn keep(&mut self, own: (f64, f64), in_gesture: bool) -> (f64, f64) {
        let spare = SPARE * (own.1 - own.0);
        let holds = |had: &(f64, f64)| had.0 <= own.0 + spare && had.1 >= own.1 - spare;
        let ends = self.0.filter(|had| in_gesture && holds(had)).unwrap_or(own);
        self.0 = Some(ends);
        ends
    }
}

/// The axes that stand still during a gesture.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct HeldAxes {
    pub span: Held,
    /// Potential energy.
    pub heights: Held,
    pub force: Held,
}

/// A ring that grows and fades.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ring {
    /// Screen time in s at which it began.
    pub began: f64,
    /// Share of the energy scale.
    pub size: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapLook {
    pub surface: bool,
    /// Lines through it where the scene is stand beside it.
    pub cuts: bool,
    /// Where the scene has been is drawn.
    pub trail: bool,
}

impl Default for MapLook {
    fn default() -> Self {
        Self { surface: false, cuts: false, trail: true }
    }
}

/// What the drawing of a mechanism keeps.
#[derive(Debug, Clone, Default)]
pub(super) struct Drawing {
    /// The last impact on the left and the right that is drawn as a ring.
    pub rings: [Option<Ring>; 2],
    /// The flexures as they were drawn last.
    pub bent: Option<State>,
    /// The time up to which impacts have been looked at.
    pub seen_to: f64,
}

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PointerState {
    pub corner: Option<Pos2>,
    /// A click that waits whether it is the first of two, and since when.
    pub clicked: Option<((usize, usize), f64)>,
}

/// What the view Accuracy shows where there is no room for all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Page {
    /// What each digit costs.
    Digits,
    #[default]
    Steps,
}

impl Page {
    pub fn name(self) -> &'static str {
        match self {
            Self::Digits => "What a digit costs",
            Self::Steps => "What the step size does",
        }
    }
}

/// What traces share.
#[derive(Debug, Clone, Copy, Default)]
pub struct Timeline {
    /// The stretch of time in s that a person has chosen.
    pub window: Option<f64>,
    /// The stretch of time in s that is shown otherwise.
    pub(super) own: f64,
    /// The time in s under the pointer, and the pass in which it was there.
    pub(super) cursor: Option<(f64, u64)>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_stands_still_while_a_hand_moves_what_it_shows() {
        let mut held = Held::default();
        assert_eq!(held.keep((-8.0, 8.0), false), (-8.0, 8.0));
        // smaller or a little larger it stays, and what leaves it takes it along
        assert_eq!(held.keep((-4.0, 4.0), true), (-8.0, 8.0));
        assert_eq!(held.keep((-9.0, 9.0), true), (-8.0, 8.0));
        assert_eq!(held.keep((-12.0, 12.0), true), (-12.0, 12.0));
        assert_eq!(held.keep((-9.0, 9.0), true), (-12.0, 12.0));
        assert_eq!(held.keep((-9.0, 9.0), false), (-9.0, 9.0));
    }
}
