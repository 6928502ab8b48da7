//! The player: time, speed and remembered past of the live motion.
//!
//! The motion is live: playing advances it, and a change acts from its present state. Its past is remembered
//! and can be shown; playing from there repeats it up to the present and goes on.

mod goal;

use std::sync::Arc;

use crate::dynamics::{Event, EventKind, Model, Outcome, Sample};
use crate::study::Watch;

pub use goal::{Goal, Reached};

/// Speeds relative to real time with their names; the keys 1 to 7.
pub const SPEEDS: [(f64, &str); 7] = [
    (1e-3, "1/1000"),
    (1e-2, "1/100"),
    (0.1, "1/10"),
    (0.5, "1/2"),
    (1.0, "real time"),
    (10.0, "10 times"),
    (100.0, "100 times"),
];

/// Time on the screen in s that a period of the motion should take.
const PERIOD_ON_SCREEN: f64 = 3.0;

/// The speed up to real time that suits a motion with this characteristic time in s.
pub fn fitting_speed(characteristic_time: f64) -> f64 {
    let off = |speed: f64| (characteristic_time / speed / PERIOD_ON_SCREEN).ln().abs();
    let speeds = SPEEDS.iter().map(|(speed, _)| *speed).filter(|speed| *speed <= 1.0);
    speeds.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(1.0)
}

/// Longest stretch of real time in s that one frame plays: after a pause of the window the motion goes on
/// where it was.
const LONGEST_FRAME: f64 = 0.1;

/// Time on the screen in s that a single step takes.
const STEP: f64 = 1.0 / 30.0;

#[derive(Debug, Clone)]
pub struct Player {
    watch: Watch,
    /// Speed relative to real time.
    pub speed: f64,
    playing: bool,
    /// The time in s that is shown, where it is not the present.
    past: Option<f64>,
    /// Whether a hand holds the mass, which stops the clock.
    is_held: bool,
    /// Where it goes as fast as it can.
    goal: Option<Goal>,
    /// How the way to the last goal ended.
    reached: Option<Reached>,
    /// Whether a view of this frame shows where the energy went.
    wants_ledgers: bool,
}

impl Player {
    /// Begins at the start of the model, playing.
    pub fn new(model: &Model, speed: f64) -> Self {
        Self {
            watch: Watch::new(model),
            speed,
            playing: true,
            past: None,
            is_held: false,
            goal: None,
            reached: None,
            wants_ledgers: false,
        }
    }

    /// Whether time goes on.
    pub fn is_playing(&self) -> bool {
        let plays = self.playing && (self.past.is_some() || self.watch.ended().is_none());
        !self.is_held && (plays || self.goal.is_some())
    }

    /// Plays or pauses; the way to a goal ends.
    pub fn set_playing(&mut self, playing: bool) {
        (self.playing, self.goal) = (playing, None);
    }

    /// Plays on by `seconds` of real time.
    pub fn tick(&mut self, seconds: f64) {
        if let Some(goal) = self.goal {
            self.follow(goal);
        } else if self.is_playing() {
            self.go(seconds.clamp(0.0, LONGEST_FRAME) * self.speed);
        }
    }

    /// Plays a single step and pauses.
    pub fn step(&mut self) {
        self.set_playing(false);
        self.go(STEP * self.speed);
    }

    fn go(&mut self, seconds: f64) {
        match self.past {
            Some(t) if t + seconds < self.watch.time() => self.past = Some(t + seconds),
            Some(_) => self.past = None,
            None => {
                self.watch.advance(self.watch.time() + seconds);
            }
        }
    }

    pub fn restart(&mut self, model: &Model) {
        let keeps_ledgers = self.watch.keeps_ledgers();
        self.watch = Watch::new(model);
        self.watch.keep_ledgers(keeps_ledgers);
        (self.past, self.is_held, self.goal) = (None, false, None);
    }

    /// Has ledgers kept at the ends of forcing periods; to be called in every frame that shows them.
    pub fn want_ledgers(&mut self) {
        self.wants_ledgers = true;
    }

    /// To be called once a frame: ledgers that no view has wanted are not kept.
    pub fn end_frame(&mut self) {
        self.watch.keep_ledgers(std::mem::take(&mut self.wants_ledgers));
    }

    /// From now on the mass moves by `model`.
    pub fn change(&mut self, model: &Model) {
        (self.past, self.goal) = (None, None);
        self.watch.change(model);
    }

    /// Holds the mass at `x` in m; the clock stops.
    pub fn hold(&mut self, x: f64) {
        (self.past, self.is_held, self.goal) = (None, true, None);
        self.watch.place(x, 0.0);
    }

    /// Puts the mass to `x` in m with velocity `v` in m/s, from where the motion goes on.
    pub fn place(&mut self, x: f64, v: f64) {
        (self.past, self.is_held, self.goal) = (None, false, None);
        self.watch.place(x, v);
    }

    pub fn let_go(&mut self) {
        self.is_held = false;
    }

    /// Whether a hand holds the mass.
    pub fn is_held(&self) -> bool {
        self.is_held
    }

    /// Shows the time `t` in s, as far as it is remembered.
    pub fn seek(&mut self, t: f64) {
        self.goal = None;
        let t = t.max(self.watch.begin());
        self.past = (t < self.watch.time()).then_some(t);
    }

    /// Goes to the next or the previous event and pauses there; an event to come is computed, for `limit`
    /// seconds ahead at the most.
    pub fn seek_event(&mut self, later: bool, limit: f64) {
        self.set_playing(false);
        let t = self.time();
        if let Some(event) = self.watch.neighbour(t, later) {
            return self.seek(event.t);
        }
        if !later {
            return;
        }
        self.past = None;
        let until = self.watch.time() + limit;
        while self.watch.time() < until {
            let before = self.watch.time();
            let arrived = self.watch.advance((before + limit / 50.0).min(until));
            if let Some(event) = self.watch.neighbour(t, true) {
                return self.seek(event.t);
            }
            // what one call does not reach would take too long for the window to wait
            if !arrived || self.watch.time() <= before {
                break;
            }
        }
    }

    /// The event at which a motion that was stepped from event to event stands.
    pub fn event(&self) -> Option<&Event> {
        let t = self.time();
        if self.is_playing() || self.is_held {
            return None;
        }
        let events = self.watch.events();
        let first = events.partition_point(|event| event.t < t);
        let here = events.range(first..).take_while(|event| event.t == t);
        // a rebound that comes to rest at once is shown as an impact
        here.min_by_key(|event| event.kind == EventKind::Rest)
    }

    /// The time that is shown in s.
    pub fn time(&self) -> f64 {
        self.past.unwrap_or(self.watch.time())
    }

    /// Back from the past to the present.
    pub fn to_present(&mut self) {
        self.past = None;
    }

    /// The model by which the mass moved at the time that is shown.
    pub fn shown_model(&self) -> &Arc<Model> {
        self.watch.model_at(self.time())
    }

    pub fn is_past(&self) -> bool {
        self.past.is_some()
    }

    pub fn state(&self) -> Sample {
        self.past.map_or_else(|| self.watch.now(), |t| self.watch.state_at(t))
    }

    pub fn watch(&self) -> &Watch {
        &self.watch
    }

    /// How the run ended, where it did.
    pub fn ended(&self) -> Option<Outcome> {
        self.watch.ended()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_motion_is_played_fast() {
        // 3 Hz, 0.2 Hz, 40 Hz, 1 kHz
        assert_eq!([0.333, 5.2, 0.025, 1e-3, 1e9].map(fitting_speed), [0.1, 1.0, 0.01, 1e-3, 1.0]);
    }
}
