//! Fast forward to the end of the run or to the next release or crossing.
//!
//! It takes any number of frames. In each the motion is advanced in short stretches until the frame's share of
//! time is used up, so that the window responds meanwhile.

use std::time::Duration;

use crate::dynamics::{Event, EventKind};
use crate::system::clock::WallClock;

use super::Player;

/// Time on the screen for which one frame computes.
const SHARE: Duration = Duration::from_millis(12);

/// Stretch of the motion between two looks at the clock, in multiples of its characteristic time.
const STRETCH: f64 = 2.0;

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
    /// There was no event of that kind up to the time that was set.
    Nothing(EventKind),
    /// The run ended on the way.
    Ended,
}

impl Player {
    /// Goes on to a goal from the time that is shown; what is remembered is not computed again.
    pub fn go_to(&mut self, goal: Goal) {
        self.playing = false;
        if let (Goal::First(kind, _), Some(past)) = (goal, self.past)
            && let Some(event) = self.first(kind, past)
        {
            self.seek(event.t);
            self.reached = Some(Reached::Event(event));
            return;
        }
        (self.past, self.is_held, self.reached) = (None, false, None);
        self.goal = Some(goal);
    }

    /// The goal to which the motion goes as fast as it can.
    pub fn goal(&self) -> Option<Goal> {
        self.goal
    }

    /// Ends the way to a goal.
    pub fn give_up(&mut self) {
        self.goal = None;
    }

    /// How the way to the last goal ended, once.
    pub fn take_reached(&mut self) -> Option<Reached> {
        self.reached.take()
    }

    /// The first event of a kind after a time in s that is remembered.
    fn first(&self, kind: EventKind, after: f64) -> Option<Event> {
        let events = self.watch.events();
        let begin = events.partition_point(|event| event.t <= after);
        events.range(begin..).find(|event| is_kind(event, kind)).copied()
    }

    /// Goes one frame's share of the way.
    pub(super) fn follow(&mut self, goal: Goal) {
        let (begun, until) = (WallClock::start(), goal.until());
        let stretch = STRETCH * self.watch.model_at(self.watch.time()).characteristic_time();
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
            // the stretch may be too short to change the time
            if self.watch.time() >= until || arrived && self.watch.time() <= before {
                let reached = match goal {
                    Goal::Time(_) => Reached::Time,
                    Goal::First(kind, _) => Reached::Nothing(kind),
                };
                return self.arrive(reached);
            }
            if begun.elapsed() >= SHARE {
                return;
            }
        }
    }

    fn arrive(&mut self, reached: Reached) {
        (self.goal, self.reached) = (None, Some(reached));
    }
}

/// Whether an event is of a kind; a mass that leaves a compliant stop is released by it.
fn is_kind(event: &Event, kind: EventKind) -> bool {
    event.kind == kind || (kind == EventKind::Release && event.kind == EventKind::Separate)
}
