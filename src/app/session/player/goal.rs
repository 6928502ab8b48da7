//! Fast forward to the end of the run or to the next release or crossing.
//!
//! It may take many frames. In each, the motion is advanced in short stretches until the frame's share of
//! computing time is used up, so that the window stays responsive.

use std::time::Duration;

use crate::dynamics::{Event, EventKind};
use crate::system::clock::WallClock;

use super::Player;

/// Computing time that one frame spends on the way to a goal.
const FRAME_SHARE: Duration = Duration::from_millis(12);
/// Motion between two checks of that time, in multiples of the characteristic time.
const CHECK_INTERVAL: f64 = 2.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// To this time in s.
    Time(f64),
    /// To the first event of this kind, if it comes before this time in s.
    First(EventKind, f64),
}

impl Goal {
    fn until(self) -> f64 {
        let (Self::Time(until) | Self::First(_, until)) = self;
        until
    }
}

/// How the way to a goal ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reached {
    Time,
    Event(Event),
    /// No event of this kind came up to the time of the goal.
    Nothing(EventKind),
    /// The run ended before the goal.
    Ended,
}

impl Player {
    /// Starts towards a goal from the time that is shown; an event in the remembered past is reached at once.
    pub fn go_to(&mut self, goal: Goal) {
        self.playing = false;
        if let (Goal::First(kind, _), Some(past)) = (goal, self.past)
            && let Some(event) = self.first(kind, past)
        {
            self.seek(event.t);
            self.reached = Some(Reached::Event(event));
            return;
        }
        (self.past, self.held, self.reached) = (None, false, None);
        self.goal = Some(goal);
    }

    /// The goal of the current fast forward.
    pub fn goal(&self) -> Option<Goal> {
        self.goal
    }

    /// Gives up the goal, and stays at the time reached.
    pub fn give_up(&mut self) {
        self.goal = None;
    }

    /// How the way to the last goal ended; reported once.
    pub fn take_reached(&mut self) -> Option<Reached> {
        self.reached.take()
    }

    /// The first remembered event of a kind after a time in s.
    fn first(&self, kind: EventKind, after: f64) -> Option<Event> {
        let events = self.watch.events();
        let begin = events.partition_point(|event| event.t <= after);
        events.range(begin..).find(|event| is_kind(event, kind)).copied()
    }

    /// Advances the motion towards a goal for one frame.
    pub(super) fn follow(&mut self, goal: Goal) {
        let (begun, until) = (WallClock::start(), goal.until());
        let stretch = CHECK_INTERVAL * self.watch.model_at(self.watch.time()).characteristic_time();
        loop {
            let before = self.watch.time();
            let arrived = self.watch.advance((before + stretch).min(until));
            if let Goal::First(kind, _) = goal
                && let Some(event) = self.first(kind, before)
            {
                self.seek(event.t);
                return self.arrive(Reached::Event(event));
            }
            if self.watch.ended().is_some() {
                return self.arrive(Reached::Ended);
            }
            // also if the stretch is too short to change the time in floating point
            if self.watch.time() >= until || arrived && self.watch.time() <= before {
                let reached = match goal {
                    Goal::Time(_) => Reached::Time,
                    Goal::First(kind, _) => Reached::Nothing(kind),
                };
                return self.arrive(reached);
            }
            if begun.elapsed() >= FRAME_SHARE {
                return;
            }
        }
    }

    fn arrive(&mut self, reached: Reached) {
        (self.goal, self.reached) = (None, Some(reached));
    }
}

/// Whether an event is of a kind; leaving a compliant stop counts as a release.
fn is_kind(event: &Event, kind: EventKind) -> bool {
    event.kind == kind || (kind == EventKind::Release && event.kind == EventKind::Separate)
}
