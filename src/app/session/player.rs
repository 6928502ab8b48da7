//! Player of the live motion: its time, speed and remembered past.
//!
//! The motion is live: playing advances it, and a change acts from its present state. Its past is remembered
//! and can be shown; playing from a time in the past repeats it up to the present, and then goes on.

use std::time::Duration;

use crate::dynamics::{Event, EventKind, Model, Outcome, Sample};
use crate::numeric::elementary;
use crate::scene::{Excitation, Scene};
use crate::system::clock::WallClock;
use interwell_studies::study::Watch;

/// Speeds relative to real time, with their names; for the keys 1 to 7.
pub const SPEEDS: [(f64, &str); 7] = [
    (1e-3, "1/1000"),
    (1e-2, "1/100"),
    (0.1, "1/10"),
    (0.5, "1/2"),
    (1.0, "real time"),
    (10.0, "10 times"),
    (100.0, "100 times"),
];

/// Preferred duration on the screen, in s, of the characteristic time of the motion.
const PERIOD_ON_SCREEN: f64 = 3.0;

/// Distance from an end of the force curve that a hand keeps, as a share of the curve's width: the energy of
/// the prototype's flexures grows sixfold over it.
const HAND_MARGIN: f64 = 0.02;

/// The speed, at most real time, that suits a motion with this characteristic time in s.
pub fn fitting_speed(characteristic_time: f64) -> f64 {
    let off = |speed: f64| elementary::ln(characteristic_time / speed / PERIOD_ON_SCREEN).abs();
    let speeds = SPEEDS.iter().map(|(speed, _)| *speed).filter(|speed| *speed <= 1.0);
    speeds.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(1.0)
}

/// Least duration on the screen, in s, of a drive that changes slowly.
const CHANGE_ON_SCREEN: f64 = 30.0;

/// The speed at which a scene is opened: that of its hints, or one that suits its motion and, where the drive
/// changes slowly, its change.
pub(super) fn opening_speed(scene: &Scene, model: &Model) -> f64 {
    let hinted = scene.app.as_ref().and_then(|hints| hints.speed);
    let over_s = match scene.excitation {
        Excitation::AmplitudeRamp { over_s, .. } | Excitation::Chirp { over_s, .. } => over_s,
        _ => 0.0,
    };
    let changes = SPEEDS.iter().map(|(speed, _)| *speed).filter(|speed| speed * CHANGE_ON_SCREEN <= over_s);
    hinted.unwrap_or_else(|| changes.fold(fitting_speed(model.characteristic_time()), f64::max))
}

/// Longest real time in s that one frame plays, so that the motion does not jump after a pause of the window.
const LONGEST_FRAME: f64 = 0.1;

/// Time on the screen in s that a single step takes.
const STEP: f64 = 1.0 / 30.0;

/// Computing time that one frame spends on the way to a goal.
const FRAME_SHARE: Duration = Duration::from_millis(12);
/// Motion between two checks of that time, in multiples of the characteristic time; and where an event is
/// looked for, after which a change must not come much later.
const CHECK_INTERVAL: (f64, f64) = (2.0, 0.02);

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// To this time in s.
    Time(f64),
    /// To this time in s, from which on the motion has settled; it then plays on at the chosen speed.
    Settled(f64),
    /// To the first event of this kind, if it comes before this time in s.
    First(EventKind, f64),
}

impl Goal {
    fn until(self) -> f64 {
        let (Self::Time(until) | Self::Settled(until) | Self::First(_, until)) = self;
        until
    }
}

/// How the way to a goal ended, if not at the event that was looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reached {
    Time,
    /// No event of this kind came up to the time of the goal.
    Nothing(EventKind),
    Ended,
}

#[derive(Debug, Clone)]
pub struct Player {
    watch: Watch,
    /// Speed relative to real time.
    pub speed: f64,
    playing: bool,
    /// The time in s that is shown; `None` for the present.
    past: Option<f64>,
    /// Whether the mass is held by hand, which stops the clock.
    held: bool,
    goal: Option<Goal>,
    /// Whether a view of this frame shows the energy ledger.
    wants_ledgers: bool,
}

impl Player {
    pub fn new(model: &Model, speed: f64) -> Self {
        Self {
            watch: Watch::new(model),
            speed,
            playing: true,
            past: None,
            held: false,
            goal: None,
            wants_ledgers: false,
        }
    }

    /// Whether the time that is shown advances.
    pub fn is_playing(&self) -> bool {
        let plays = self.playing && (self.past.is_some() || self.watch.ended().is_none());
        !self.held && (plays || self.goal.is_some())
    }

    /// Plays or pauses; a goal is given up.
    pub fn set_playing(&mut self, playing: bool) {
        (self.playing, self.goal) = (playing, None);
    }

    /// Plays for `seconds` of real time. Returns how the way to a goal has ended, if it has.
    pub fn tick(&mut self, seconds: f64) -> Option<Reached> {
        if let Some(goal) = self.goal {
            return self.follow(goal);
        }
        if self.is_playing() {
            self.go(seconds.clamp(0.0, LONGEST_FRAME) * self.speed);
        }
        None
    }

    /// Pauses, and advances by a single step.
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
        (self.past, self.held, self.goal) = (None, false, None);
    }

    /// Asks for ledgers at the ends of forcing periods; to be called by a view in every frame.
    pub fn want_ledgers(&mut self) {
        self.wants_ledgers = true;
    }

    /// Stops keeping ledgers if no view has asked for them in this frame; to be called once a frame.
    pub fn end_frame(&mut self) {
        self.watch.keep_ledgers(std::mem::take(&mut self.wants_ledgers));
    }

    pub fn change(&mut self, model: &Model) {
        (self.past, self.goal) = (None, None);
        self.watch.change(model);
    }

    /// Holds the mass at `x` in m, with the clock stopped.
    ///
    /// Where no stop keeps it, it stays so far from an end of the force curve that its energy there does not
    /// carry it beyond the other end of a symmetric curve; strong shaking still may.
    pub fn hold(&mut self, x: f64) {
        (self.past, self.held, self.goal) = (None, true, None);
        let model = self.watch.model_at(self.watch.time());
        let ((low, high), (left, right)) = (model.mechanism().curve.domain(), model.stop_positions());
        let margin = |stop: Option<f64>| if stop.is_some() { 0.0 } else { HAND_MARGIN * (high - low) };
        let (low, high) = (low + margin(left), high - margin(right));
        self.watch.place(if low < high { x.clamp(low, high) } else { x }, 0.0);
    }

    /// Places the mass at `x` in m with velocity `v` in m/s; the motion goes on from there.
    pub fn place(&mut self, x: f64, v: f64) {
        (self.past, self.held, self.goal) = (None, false, None);
        self.watch.place(x, v);
    }

    pub fn let_go(&mut self) {
        self.held = false;
    }

    pub fn is_held(&self) -> bool {
        self.held
    }

    /// Shows the time `t` in s, or the earliest time that is remembered.
    pub fn seek(&mut self, t: f64) {
        self.goal = None;
        let t = t.max(self.watch.begin());
        self.past = (t < self.watch.time()).then_some(t);
    }

    /// Goes to the next (`later`) or the previous event and pauses there. If the next event is in the future,
    /// the motion is advanced to it, by at most `longest` seconds.
    pub fn seek_event(&mut self, later: bool, longest: f64) {
        self.set_playing(false);
        let t = self.time();
        if let Some(event) = self.watch.neighbour(t, later) {
            return self.seek(event.t);
        }
        if !later {
            return;
        }
        self.past = None;
        let until = self.watch.time() + longest;
        while self.watch.time() < until {
            let before = self.watch.time();
            let arrived = self.watch.advance((before + longest / 50.0).min(until));
            if let Some(event) = self.watch.neighbour(t, true) {
                return self.seek(event.t);
            }
            // one call was not enough to get there: more of them would block the window
            if !arrived || self.watch.time() <= before {
                break;
            }
        }
    }

    /// The event at the time that is shown, while the motion is paused, as after a step between events.
    pub fn event(&self) -> Option<&Event> {
        let t = self.time();
        if self.is_playing() || self.held {
            return None;
        }
        let events = self.watch.events();
        let first = events.partition_point(|event| event.t < t);
        let here = events.range(first..).take_while(|event| event.t == t);
        // of an impact and a rest at the same instant the impact is reported
        here.min_by_key(|event| event.kind == EventKind::Rest)
    }

    /// The time that is shown in s.
    pub fn time(&self) -> f64 {
        self.past.unwrap_or(self.watch.time())
    }

    pub fn to_present(&mut self) {
        self.past = None;
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

    /// How the run ended; `None` if it goes on.
    pub fn ended(&self) -> Option<Outcome> {
        self.watch.ended()
    }
}

/// Fast forward to the end of the run or to the next release or crossing. It may take many frames: each one
/// advances the motion in short stretches until its share of computing time is used up.
impl Player {
    /// Starts towards a goal from the time that is shown; an event in the remembered past is reached at once.
    pub fn go_to(&mut self, goal: Goal) {
        self.playing = false;
        if let (Goal::First(kind, _), Some(past)) = (goal, self.past)
            && let Some(event) = self.first(kind, past)
        {
            return self.seek(event.t);
        }
        (self.past, self.held, self.goal) = (None, false, Some(goal));
    }

    pub fn goal(&self) -> Option<Goal> {
        self.goal
    }

    /// The first remembered event of a kind after a time in s.
    fn first(&self, kind: EventKind, after: f64) -> Option<Event> {
        let events = self.watch.events();
        let begin = events.partition_point(|event| event.t <= after);
        // leaving a compliant stop counts as a release
        let also = if kind == EventKind::Release { EventKind::Separate } else { kind };
        events.range(begin..).find(|event| event.kind == kind || event.kind == also).copied()
    }

    fn follow(&mut self, goal: Goal) -> Option<Reached> {
        let (begun, until) = (WallClock::start(), goal.until());
        let interval = if matches!(goal, Goal::First(..)) { CHECK_INTERVAL.1 } else { CHECK_INTERVAL.0 };
        let stretch = interval * self.watch.model_at(self.watch.time()).characteristic_time();
        loop {
            let before = self.watch.time();
            let arrived = self.watch.advance((before + stretch).min(until));
            if let Goal::First(kind, _) = goal
                && let Some(event) = self.first(kind, before)
            {
                self.seek(event.t);
                return None;
            }
            if self.watch.ended().is_some() {
                self.goal = None;
                return Some(Reached::Ended);
            }
            // also if the stretch is too short to change the time in floating point
            if self.watch.time() >= until || arrived && self.watch.time() <= before {
                self.set_playing(matches!(goal, Goal::Settled(_)));
                return match goal {
                    Goal::Time(_) => Some(Reached::Time),
                    Goal::Settled(_) => None,
                    Goal::First(kind, _) => Some(Reached::Nothing(kind)),
                };
            }
            if begun.elapsed() >= FRAME_SHARE {
                return None;
            }
        }
    }
}
