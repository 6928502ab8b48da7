//! Live run with a memory of its path.
//!
//! The path is sampled for the eye: some eighty times a period, and at every event, so that rebounds are
//! corners and rests are flat. The energy ledger is kept at the end of every forcing period while somebody
//! looks at it. The oldest part is forgotten. The models are kept with it ([`models`](super::models)).

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;

use super::models::Models;
use super::{Held, Table, events_table};
use crate::dynamics::{Event, EventKind, Live, LiveLedger, LiveOutput, Model, Outcome, Phase, Sample, Side};
use crate::scene::{Excitation, Scene, Start};

/// Samples in a period of the drive or of small oscillations, whichever is shorter.
const PER_PERIOD: f64 = 80.0;

/// How many samples are remembered: some minutes of the prototype.
const MOST_SAMPLES: usize = 200_000;
/// How many events are remembered.
const MOST_EVENTS: usize = 50_000;

/// How many ledgers are remembered.
const MOST_LEDGERS: usize = 10_000;
/// The most ledgers that one call makes: over a longer time the last ones.
const LEDGERS_AT_ONCE: f64 = 64.0;

/// The most samples that one call makes: over a longer time they are further apart.
const MOST_AT_ONCE: f64 = 20_000.0;

/// A live run and its past.
#[derive(Debug, Clone)]
pub struct Watch {
    live: Live,
    models: Models,
    samples: VecDeque<Sample>,
    events: VecDeque<Event>,
    /// How many events are no longer remembered.
    forgotten: usize,
    /// Ledgers at the start and at multiples of the forcing period.
    ledgers: VecDeque<(f64, LiveLedger)>,
    keeps_ledgers: bool,
    /// The state at the present time.
    now: Sample,
    /// Time between samples in s.
    step: f64,
}

impl Watch {
    /// Begins at the model's own start.
    pub fn new(model: &Model) -> Self {
        let live = Live::new(model);
        let now = live.state();
        let mut watch = Self {
            live,
            models: Models::new(Arc::new(model.clone())),
            samples: VecDeque::new(),
            events: VecDeque::new(),
            forgotten: 0,
            ledgers: VecDeque::from([(0.0, LiveLedger::default())]),
            keeps_ledgers: false,
            now,
            step: sampling_step(model),
        };
        watch.take(LiveOutput { samples: vec![now], events: Vec::new() });
        watch.advance(0.0);
        watch
    }

    /// Whether from now on a ledger is kept at the end of every forcing period, which repeats the last step.
    pub fn keep_ledgers(&mut self, keep: bool) {
        self.keeps_ledgers = keep;
    }

    /// Whether ledgers are kept at the ends of forcing periods.
    pub fn keeps_ledgers(&self) -> bool {
        self.keeps_ledgers
    }

    /// How many ledgers there are, that of the start included.
    pub fn ledger_count(&self) -> usize {
        self.ledgers.len()
    }

    /// Goes on to the time `to` in s. False if the run ended before, or if crowded impacts need more calls.
    pub fn advance(&mut self, to: f64) -> bool {
        let from = self.live.time();
        let step = self.step.max((to - from) / MOST_AT_ONCE);
        let first = (from / step).floor() + 1.0;
        let count = ((to / step).floor() - first + 1.0).max(0.0) as u32;
        let times = (0..count).map(|i| (first + f64::from(i)) * step);
        let times: Vec<f64> = times.filter(|t| *t > from && *t <= to).collect();
        let mut passage = LiveOutput::default();
        let (mut done, mut arrived) = (0, true);
        for mark in self.marks(from, to) {
            let upto = times.partition_point(|t| *t <= mark);
            arrived = self.live.advance(mark, &times[done..upto], &mut passage);
            done = upto;
            if !arrived {
                break;
            }
            self.ledgers.push_back((mark, self.live.ledger()));
        }
        arrived = arrived && self.live.advance(to, &times[done..], &mut passage);
        self.take(passage);
        self.now = self.live.state();
        arrived
    }

    /// The ends of forcing periods after `from` and up to `to` in s.
    fn marks(&self, from: f64, to: f64) -> Vec<f64> {
        let period = self.live.model().forcing_period().filter(|_| self.keeps_ledgers);
        let Some(period) = period else { return Vec::new() };
        let last = (to / period).floor();
        let first = ((from / period).floor() + 1.0).max(last + 1.0 - LEDGERS_AT_ONCE);
        let count = (last - first + 1.0).max(0.0) as u32;
        let marks = (0..count).map(|i| (first + f64::from(i)) * period);
        marks.filter(|mark| *mark > from && *mark <= to).collect()
    }

    /// From now on the mass moves as `model` says; see [`Live::change`].
    pub fn change(&mut self, model: &Model) {
        self.step = sampling_step(model);
        self.models.change(self.now.t, Arc::new(model.clone()), self.step);
        self.jump(|live, passage| live.change(model, passage));
    }

    /// Puts the mass to `x` in m with velocity `v` in m/s.
    pub fn place(&mut self, x: f64, v: f64) {
        self.jump(|live, passage| live.place(x, v, passage));
    }

    /// Changes the motion at the present instant, before which the state is remembered: the path jumps there.
    fn jump(&mut self, change: impl FnOnce(&mut Live, &mut LiveOutput)) {
        if self.samples.back().is_none_or(|last| last.t < self.now.t) {
            self.samples.push_back(self.now);
        }
        let mut passage = LiveOutput::default();
        change(&mut self.live, &mut passage);
        self.take(passage);
        self.now = self.live.state();
    }

    /// The present time in s.
    pub fn time(&self) -> f64 {
        self.live.time()
    }

    /// The present state.
    pub fn now(&self) -> Sample {
        self.now
    }

    /// How the run ended, where it did.
    pub fn ended(&self) -> Option<Outcome> {
        self.live.ended()
    }

    /// Where the energy went since the start.
    pub fn ledger(&self) -> LiveLedger {
        self.live.ledger()
    }

    /// Where the energy went up to a time in s: at the present, and in the past up to the last period's end.
    /// `None` in a past without a period or without ledgers.
    pub fn ledger_at(&self, t: f64) -> Option<(f64, LiveLedger)> {
        if t >= self.now.t {
            return Some((self.now.t, self.ledger()));
        }
        let period = self.models.at(t).forcing_period()?;
        let after = self.ledgers.partition_point(|mark| mark.0 <= t);
        let mark = self.ledgers.get(after.checked_sub(1)?)?;
        (t - mark.0 < period * (1.0 + 1e-9)).then_some(*mark)
    }

    /// Where the energy went in the last whole forcing period that had ended at a time in s. `None` without a
    /// period, and while the first one since the period was changed, or since ledgers are kept, still lasts.
    pub fn last_period(&self, t: f64) -> Option<LiveLedger> {
        let period = self.models.at(t).forcing_period()?;
        let after = self.ledgers.partition_point(|mark| mark.0 <= t);
        let (begin, end) = (self.ledgers.get(after.checked_sub(2)?)?, self.ledgers.get(after - 1)?);
        let whole = ((end.0 - begin.0) / period - 1.0).abs() < 1e-6;
        let last = t - end.0 < period * (1.0 + 1e-9);
        (whole && last).then(|| end.1.since(&begin.1))
    }

    /// The model of the motion from here on: see [`Live::from_here`].
    pub fn from_here(&self) -> Option<Model> {
        self.live.from_here()
    }

    /// The path that is remembered, ascending in time; at an impact two samples, before and after it.
    pub fn samples(&self) -> &VecDeque<Sample> {
        &self.samples
    }

    /// The events that are remembered, ascending in time.
    pub fn events(&self) -> &VecDeque<Event> {
        &self.events
    }

    /// How many events came before these and are no longer remembered.
    pub fn forgotten_events(&self) -> usize {
        self.forgotten
    }

    /// The model that held at a time in s, as far back as there are samples.
    pub fn model_at(&self, t: f64) -> &Arc<Model> {
        self.models.at(t)
    }

    /// The time in s from which it held.
    pub fn model_since(&self, t: f64) -> f64 {
        self.models.since(t)
    }

    /// Which models held from `from` to `to` in s, in order of time.
    pub fn models_between(&self, from: f64, to: f64) -> impl Iterator<Item = Held<'_>> {
        self.models.between(from, to)
    }

    /// The first time in s that is remembered.
    pub fn begin(&self) -> f64 {
        self.samples.front().map_or(0.0, |sample| sample.t)
    }

    /// The remembered state at a time in s: between two samples by the cubic through places and velocities.
    pub fn state_at(&self, t: f64) -> Sample {
        if t >= self.now.t {
            return self.now;
        }
        let after = self.samples.partition_point(|sample| sample.t <= t);
        let Some(a) = after.checked_sub(1).and_then(|i| self.samples.get(i)) else {
            return self.samples.front().copied().unwrap_or(self.now);
        };
        let b = self.samples.get(after).unwrap_or(&self.now);
        let h = b.t - a.t;
        if !(h > 0.0) || a.phase != Phase::Free {
            return Sample { t, ..*a };
        }
        let s = (t - a.t) / h;
        // Hermite's cubic and its derivative
        let (rise, bend) = (b.x - a.x, (a.v + b.v) * h - 2.0 * (b.x - a.x));
        let c = rise - a.v * h - bend;
        Sample {
            t,
            x: a.x + s * (a.v * h + s * (c + s * bend)),
            v: a.v + s * (2.0 * c + s * 3.0 * bend) / h,
            base_accel: a.base_accel + s * (b.base_accel - a.base_accel),
            phase: Phase::Free,
            electrical: match b.electrical - a.electrical {
                // (corners have no electrical state)
                change if change.is_nan() && a.electrical.is_nan() => b.electrical,
                change if change.is_nan() => a.electrical,
                change => a.electrical + s * change,
            },
        }
    }

    /// The event before or after a time in s: a release, a crossing, or the first impact after a flight.
    pub fn neighbour(&self, t: f64, later: bool) -> Option<Event> {
        // a chatter is one event, at its first impact
        let lone = |i: &usize| {
            let event = &self.events[*i];
            let before = i.checked_sub(1).map(|j| &self.events[j]);
            let struck = |kind| matches!(kind, EventKind::Impact | EventKind::Contact | EventKind::Separate);
            !(struck(event.kind) || event.kind == EventKind::Rest)
                || before.is_none_or(|before| !struck(before.kind) || before.side != event.side)
        };
        let split = |time: f64| self.events.partition_point(|event| event.t <= time);
        let found = if later {
            (split(t)..self.events.len()).find(lone)
        } else {
            let before = self.events.partition_point(|event| event.t < t);
            (0..before).rev().find(lone)
        };
        found.map(|i| self.events[i])
    }

    /// Records a passage, with the corners of the path at its events.
    fn take(&mut self, passage: LiveOutput) {
        let mut events = passage.events.iter().peekable();
        for sample in &passage.samples {
            while let Some(event) = events.next_if(|event| event.t <= sample.t) {
                self.corner(event);
            }
            self.samples.push_back(*sample);
        }
        events.for_each(|event| self.corner(event));
        self.events.extend(passage.events);
        keep_last(&mut self.samples, MOST_SAMPLES);
        self.forgotten += keep_last(&mut self.events, MOST_EVENTS);
        keep_last(&mut self.ledgers, MOST_LEDGERS);
        self.models.forget(self.begin());
    }

    fn corner(&mut self, event: &Event) {
        let (left, right) = self.live.model().stop_positions();
        let Some(x) = (if event.side == Side::Left { left } else { right }) else { return };
        let base_accel = self.live.base_acceleration(event.t);
        // Events do not carry it: a missing number in a table.
        let electrical = if self.live.model().has_electrical_state() { f64::NAN } else { 0.0 };
        let sample = |v: f64, phase: Phase| Sample { t: event.t, x, v, base_accel, phase, electrical };
        let on_stop = if event.side == Side::Left { Phase::LeftStop } else { Phase::RightStop };
        match event.kind {
            EventKind::Impact => {
                self.samples.extend([event.v_in, event.v_out].map(|v| sample(v, Phase::Free)));
            }
            EventKind::Rest => self.samples.push_back(sample(0.0, on_stop)),
            EventKind::Release => self.samples.push_back(sample(0.0, Phase::Free)),
            EventKind::Crossing => {}
            // The path has no corner there, only an end of the stretch in contact.
            EventKind::Contact => self.samples.push_back(sample(event.v_in, on_stop)),
            EventKind::Separate => self.samples.push_back(sample(event.v_out, Phase::Free)),
        }
    }
}

/// Forgets all but the last `most` entries; returns how many it forgot.
fn keep_last<T>(entries: &mut VecDeque<T>, most: usize) -> usize {
    let spare = entries.len().saturating_sub(most);
    entries.drain(..spare);
    spare
}

fn sampling_step(model: &Model) -> f64 {
    let swing = model.natural_time();
    model.forcing_period().map_or(swing, |period| period.min(swing)) / PER_PERIOD
}

/// Least share of samples at common times for which these alone are compared.
const ENOUGH: f64 = 0.25;

/// Times in s from `from` to `to` and the distance in m of two motions at each: at most some `limit` of them.
///
/// Motions that are sampled in the same steps are compared at their common samples, which are exact; others
/// between samples, where the distance is good to a millionth of the way between two of these.
pub fn distances(a: &Watch, b: &Watch, (from, to): (f64, f64), limit: usize) -> Vec<(f64, f64)> {
    let (samples, other) = (a.samples(), b.samples());
    let to = to.min(a.time()).min(b.time());
    let from = from.max(a.begin()).max(b.begin());
    let first = samples.partition_point(|sample| sample.t < from);
    let last = samples.partition_point(|sample| sample.t <= to);
    // a power of two, so that the samples taken stay the same while others are added
    let stride = (last.saturating_sub(first) / limit.max(1)).max(1).next_power_of_two();
    let first = first.next_multiple_of(stride);
    let taken = || (first..last).step_by(stride).map(|i| &samples[i]);
    let mut found: Vec<(f64, f64)> = taken()
        .filter_map(|sample| {
            let at = other.partition_point(|twin| twin.t < sample.t);
            let twin = other.get(at).filter(|twin| twin.t == sample.t)?;
            Some((sample.t, (sample.x - twin.x).abs()))
        })
        .collect();
    if (found.len() as f64) < ENOUGH * taken().count() as f64 {
        found = taken().map(|sample| (sample.t, (sample.x - b.state_at(sample.t).x).abs())).collect();
    }
    if to > from {
        found.push((to, (a.state_at(to).x - b.state_at(to).x).abs()));
    }
    found
}

/// Some of the events that are remembered, by their places, in the columns of
/// [`events_table`](super::events_table) and two more: `phase_deg`, the phase of the drive, missing where it
/// does not repeat; and `lost_j`, the kinetic energy that an event takes, m (v_in^2 - v_out^2) / 2 with the
/// mass at that time. That is missing for a touch of a compliant stop, whose loss is spread over the contact.
pub fn watched_events(watch: &Watch, which: Range<usize>) -> Table {
    let count = watch.events().len();
    let which = which.start.min(count)..which.end.min(count);
    let events: Vec<Event> = watch.events().range(which).copied().collect();
    let phase = |event: &Event| watch.model_at(event.t).drive_phase(event.t).map(|turns| 360.0 * turns);
    let lost = |event: &Event| {
        let mass = watch.model_at(event.t).mass();
        let is_spread = matches!(event.kind, EventKind::Contact | EventKind::Separate);
        // the sum of the speeds times their difference: exact where they are nearly equal
        (!is_spread).then_some(0.5 * mass * (event.v_in + event.v_out) * (event.v_in - event.v_out))
    };
    events_table(&events).each("phase_deg", &events, phase).each("lost_j", &events, lost)
}

/// `scene` with the start and the phases of `here`, the model of a motion that goes on from its present state
/// ([`Watch::from_here`]). `None` for noise, which begins at its seed, and where a compliant stop is pressed
/// in.
pub fn continued_scene(scene: &Scene, here: &Model) -> Option<Scene> {
    let (x, v) = here.start();
    if !here.excitation().noises.is_empty() || here.compliant().is_some() && here.pressed_depth(x).is_some() {
        return None;
    }
    let mut scene = scene.clone();
    scene.start = Start::At { x_mm: millimetres(x), v_m_per_s: v, electrical: here.start_electrical() };
    let mut turns = here.excitation().tones.iter().map(|tone| {
        let half = if tone.amplitude < 0.0 { 0.5 } else { 0.0 };
        (tone.phase + if tone.quarter { 0.25 } else { 0.0 }, half)
    });
    put_phases(&mut scene.excitation, &mut turns).then_some(scene)
}

/// Gives every sine of an excitation its phase, from turns and half turns; false if another part has one.
fn put_phases(excitation: &mut Excitation, turns: &mut impl Iterator<Item = (f64, f64)>) -> bool {
    match excitation {
        Excitation::None | Excitation::Constant { .. } => true,
        Excitation::Sine { amplitude_g, phase_deg, .. } => {
            let Some((turn, half)) = turns.next() else { return false };
            let half = if *amplitude_g < 0.0 { 0.5 - half } else { half };
            *phase_deg = 360.0 * (turn + half);
            true
        }
        Excitation::Sum(terms) => terms.iter_mut().all(|term| put_phases(term, turns)),
        Excitation::AmplitudeRamp { .. }
        | Excitation::Chirp { .. }
        | Excitation::Noise { .. }
        | Excitation::Recorded { .. } => false,
    }
}

/// The number of millimetres that is read back as `x` in m, where there is one.
fn millimetres(x: f64) -> f64 {
    let mm = x * 1e3;
    [mm, mm.next_up(), mm.next_down()].into_iter().find(|mm| mm / 1e3 == x).unwrap_or(mm)
}
