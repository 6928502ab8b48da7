//! Live run that keeps its recent path.
//!
//! The path is sampled for display: 80 times per period, and at every event, so that impacts are drawn as
//! corners and rests as straight lines. The oldest data are dropped. The models of the motion are stored as
//! well ([`models`](super::models)).

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::models::Models;
use super::{ModelUse, Table, events_table};
use crate::dynamics::{Event, EventKind, Live, LiveLedger, LiveOutput, Model, Outcome, Phase, Sample, Side};
use crate::scene::{Excitation, Scene, Start};

/// Samples per period of the drive or of small oscillations, whichever is shorter.
const PER_PERIOD: f64 = 80.0;

/// Largest number of samples that are kept: some minutes of the prototype.
const MAX_KEPT_SAMPLES: usize = 200_000;
const MAX_KEPT_EVENTS: usize = 50_000;

const MAX_KEPT_LEDGERS: usize = 10_000;
/// Largest number of ledgers that one call of `advance` stores; over a longer time, only the last ones.
const MAX_LEDGERS_PER_CALL: f64 = 64.0;

/// Largest number of samples that one call of `advance` stores; over a longer time they are further apart.
const MAX_SAMPLES_PER_CALL: f64 = 20_000.0;

/// A live run and its recent past.
#[derive(Debug, Clone)]
pub struct Watch {
    live: Live,
    models: Models,
    samples: VecDeque<Sample>,
    events: VecDeque<Event>,
    dropped_events: usize,
    /// Ledgers at the start and at multiples of the forcing period.
    ledgers: VecDeque<(f64, LiveLedger)>,
    keeps_ledgers: bool,
    now: Sample,
    /// Time between samples in s.
    step: f64,
}

impl Watch {
    /// A run from the start of the model.
    pub fn new(model: &Model) -> Self {
        let live = Live::new(model);
        let now = live.state();
        let mut watch = Self {
            live,
            models: Models::new(Arc::new(model.clone())),
            samples: VecDeque::new(),
            events: VecDeque::new(),
            dropped_events: 0,
            ledgers: VecDeque::from([(0.0, LiveLedger::default())]),
            keeps_ledgers: false,
            now,
            step: sampling_step(model),
        };
        watch.take(LiveOutput { samples: vec![now], events: Vec::new() }, &[], None);
        watch.advance(0.0);
        watch
    }

    /// Sets whether a ledger is stored at the end of every forcing period from now on, which costs a second
    /// computation of the last step.
    pub fn keep_ledgers(&mut self, keep: bool) {
        self.keeps_ledgers = keep;
    }

    /// Whether ledgers are stored at the ends of forcing periods.
    pub fn keeps_ledgers(&self) -> bool {
        self.keeps_ledgers
    }

    /// Number of ledgers, including that of the start.
    pub fn ledger_count(&self) -> usize {
        self.ledgers.len()
    }

    /// Continues to the time `to` in s. False if the run ended before, or many impacts need further calls.
    pub fn advance(&mut self, to: f64) -> bool {
        let from = self.live.time();
        let step = self.step.max((to - from) / MAX_SAMPLES_PER_CALL);
        let first = (from / step).floor() + 1.0;
        let count = ((to / step).floor() - first + 1.0).max(0.0) as u32;
        let times = (0..count).map(|i| (first + f64::from(i)) * step);
        let times: Vec<f64> = times.filter(|t| *t > from && *t <= to).collect();
        let before = self.live.model().has_electrical_state().then(|| self.live.clone());
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
        let charged = before.map_or_else(Vec::new, |live| at_events(live, self.live.time(), &passage.events));
        self.take(passage, &charged, None);
        self.now = self.live.state();
        arrived
    }

    /// The ends of forcing periods after `from` and up to `to` in s.
    fn marks(&self, from: f64, to: f64) -> Vec<f64> {
        let period = self.live.model().forcing_period().filter(|_| self.keeps_ledgers);
        let Some(period) = period else { return Vec::new() };
        let last = (to / period).floor();
        let first = ((from / period).floor() + 1.0).max(last + 1.0 - MAX_LEDGERS_PER_CALL);
        let count = (last - first + 1.0).max(0.0) as u32;
        let marks = (0..count).map(|i| (first + f64::from(i)) * period);
        marks.filter(|mark| *mark > from && *mark <= to).collect()
    }

    /// Replaces the model from now on; see [`Live::change`].
    pub fn change(&mut self, model: &Model) {
        self.step = sampling_step(model);
        self.models.change(self.now.t, Arc::new(model.clone()), self.step);
        self.jump(|live, passage| live.change(model, passage));
    }

    /// Sets the state of the mass to `x` in m and `v` in m/s.
    pub fn place(&mut self, x: f64, v: f64) {
        self.jump(|live, passage| live.place(x, v, passage));
    }

    /// Changes the state or the model now, and keeps the state before, so that the path shows the jump.
    fn jump(&mut self, change: impl FnOnce(&mut Live, &mut LiveOutput)) {
        if self.samples.back().is_none_or(|last| last.t < self.now.t) {
            self.samples.push_back(self.now);
        }
        let mut passage = LiveOutput::default();
        change(&mut self.live, &mut passage);
        self.now = self.live.state();
        // a mass that a stop was moved away from is not on it any more
        self.take(passage, &[self.now], Some(self.now.x));
    }

    /// The present time in s.
    pub fn time(&self) -> f64 {
        self.live.time()
    }

    /// The present state.
    pub fn now(&self) -> Sample {
        self.now
    }

    /// How the run ended; `None` while it continues.
    pub fn ended(&self) -> Option<Outcome> {
        self.live.ended()
    }

    /// The energy ledger since the start.
    pub fn ledger(&self) -> LiveLedger {
        self.live.ledger()
    }

    /// The energy ledger up to about a time in s, with the time to which it belongs: the present, or in the
    /// past the last end of a forcing period. `None` for a past time without a period or without ledgers.
    pub fn ledger_at(&self, t: f64) -> Option<(f64, LiveLedger)> {
        if t >= self.now.t {
            return Some((self.now.t, self.ledger()));
        }
        let period = self.models.at(t).forcing_period()?;
        let after = self.ledgers.partition_point(|mark| mark.0 <= t);
        let mark = self.ledgers.get(after.checked_sub(1)?)?;
        (t - mark.0 < period * (1.0 + 1e-9)).then_some(*mark)
    }

    /// The energy ledger of the last whole forcing period before a time in s. `None` without a period, and
    /// during the first period after the period was changed or ledgers were switched on.
    pub fn last_period(&self, t: f64) -> Option<LiveLedger> {
        let period = self.models.at(t).forcing_period()?;
        let after = self.ledgers.partition_point(|mark| mark.0 <= t);
        let (begin, end) = (self.ledgers.get(after.checked_sub(2)?)?, self.ledgers.get(after - 1)?);
        let whole = ((end.0 - begin.0) / period - 1.0).abs() < 1e-6;
        let last = t - end.0 < period * (1.0 + 1e-9);
        (whole && last).then(|| end.1.since(&begin.1))
    }

    /// A model that continues the motion from its present state; see [`Live::from_here`].
    pub fn from_here(&self) -> Option<Model> {
        self.live.from_here()
    }

    /// The samples that are kept, in order of time; an impact has two, before and after it.
    pub fn samples(&self) -> &VecDeque<Sample> {
        &self.samples
    }

    /// The events that are kept, in order of time.
    pub fn events(&self) -> &VecDeque<Event> {
        &self.events
    }

    /// Number of earlier events that have been dropped.
    pub fn forgotten_events(&self) -> usize {
        self.dropped_events
    }

    /// The model that was in use at a time in s, as far back as there are samples.
    pub fn model_at(&self, t: f64) -> &Arc<Model> {
        self.models.at(t)
    }

    /// The time in s from which that model was in use.
    pub fn model_since(&self, t: f64) -> f64 {
        self.models.since(t)
    }

    /// The models that were in use from `from` to `to` in s, in order of time.
    pub fn models_between(&self, from: f64, to: f64) -> impl Iterator<Item = ModelUse<'_>> {
        self.models.between(from, to)
    }

    /// The time of the first sample in s.
    pub fn begin(&self) -> f64 {
        self.samples.front().map_or(0.0, |sample| sample.t)
    }

    /// The state at a time in s, by cubic Hermite interpolation between two samples.
    pub fn state_at(&self, t: f64) -> Sample {
        self.state_before(self.samples.partition_point(|sample| sample.t <= t), t)
    }

    /// The state at a time in s, of which the sample `after` is the first later one.
    fn state_before(&self, after: usize, t: f64) -> Sample {
        if t >= self.now.t {
            return self.now;
        }
        let Some(a) = after.checked_sub(1).and_then(|i| self.samples.get(i)) else {
            return self.samples.front().copied().unwrap_or(self.now);
        };
        let b = self.samples.get(after).unwrap_or(&self.now);
        let h = b.t - a.t;
        if !(h > 0.0) || a.phase != Phase::Free {
            return Sample { t, ..*a };
        }
        let s = (t - a.t) / h;
        let (rise, bend) = (b.x - a.x, (a.v + b.v) * h - 2.0 * (b.x - a.x));
        let c = rise - a.v * h - bend;
        Sample {
            t,
            x: a.x + s * (a.v * h + s * (c + s * bend)),
            v: a.v + s * (2.0 * c + s * 3.0 * bend) / h,
            base_accel: a.base_accel + s * (b.base_accel - a.base_accel),
            phase: Phase::Free,
            electrical: a.electrical + s * (b.electrical - a.electrical),
        }
    }

    /// The next event after a time in s, or the last one before it; of a chatter the first impact alone.
    pub fn neighbour(&self, t: f64, later: bool) -> Option<Event> {
        // a chattering sequence counts as one event, at its first impact
        let begins_sequence = |i: &usize| {
            let event = &self.events[*i];
            let before = i.checked_sub(1).map(|j| &self.events[j]);
            let struck = |kind| matches!(kind, EventKind::Impact | EventKind::Contact | EventKind::Separate);
            !(struck(event.kind) || event.kind == EventKind::Rest)
                || before.is_none_or(|before| !struck(before.kind) || before.side != event.side)
        };
        let found = if later {
            let after = self.events.partition_point(|event| event.t <= t);
            (after..self.events.len()).find(begins_sequence)
        } else {
            let before = self.events.partition_point(|event| event.t < t);
            (0..before).rev().find(begins_sequence)
        };
        found.map(|i| self.events[i])
    }

    /// Stores the samples and events of a passage, with samples at its events where the path has corners: at
    /// the stop that was touched, or if the present state or model was changed at `changed` in m. The
    /// electrical state at an event is that of the sample in `charged` at its time. Without a barrier there
    /// is nothing to cross: a passage through the equilibrium of the only well is no event.
    fn take(&mut self, passage: LiveOutput, charged: &[Sample], changed: Option<f64>) {
        let mut events = passage.events.iter().peekable();
        for sample in &passage.samples {
            while let Some(event) = events.next_if(|event| event.t <= sample.t) {
                self.corner(event, charged, changed);
            }
            self.samples.push_back(*sample);
        }
        events.for_each(|event| self.corner(event, charged, changed));
        let has_barrier = self.live.model().mechanism().landscape.barrier.is_some();
        let is_kept = |event: &Event| has_barrier || event.kind != EventKind::Crossing;
        self.events.extend(passage.events.into_iter().filter(is_kept));
        keep_last(&mut self.samples, MAX_KEPT_SAMPLES);
        self.dropped_events += keep_last(&mut self.events, MAX_KEPT_EVENTS);
        keep_last(&mut self.ledgers, MAX_KEPT_LEDGERS);
        self.models.forget(self.begin());
    }

    fn corner(&mut self, event: &Event, charged: &[Sample], changed: Option<f64>) {
        let stop = self.live.model().stop(event.side);
        let Some(x) = changed.or(stop.map(|stop| stop.x)) else { return };
        let base_accel = self.live.base_acceleration(event.t);
        let place = charged.partition_point(|sample| sample.t < event.t);
        let mut here = charged.get(place).into_iter().chain(self.samples.back());
        let unknown = if self.live.model().has_electrical_state() { f64::NAN } else { 0.0 };
        let electrical = here.find(|sample| sample.t == event.t).map_or(unknown, |sample| sample.electrical);
        let sample = |v: f64, phase: Phase| Sample { t: event.t, x, v, base_accel, phase, electrical };
        let on_stop = if event.side == Side::Left { Phase::LeftStop } else { Phase::RightStop };
        match event.kind {
            EventKind::Impact => {
                self.samples.extend([event.v_in, event.v_out].map(|v| sample(v, Phase::Free)));
            }
            EventKind::Rest => self.samples.push_back(sample(0.0, on_stop)),
            EventKind::Release => self.samples.push_back(sample(0.0, Phase::Free)),
            EventKind::Crossing => {}
            // The path is smooth here; the sample only marks an end of the contact.
            EventKind::Contact => self.samples.push_back(sample(event.v_in, on_stop)),
            EventKind::Separate => self.samples.push_back(sample(event.v_out, Phase::Free)),
        }
    }
}

/// Samples of a motion at events that lie between its present and a later time in s: events have no
/// electrical state of their own.
fn at_events(mut live: Live, to: f64, events: &[Event]) -> Vec<Sample> {
    let mut times: Vec<f64> = events.iter().map(|event| event.t).collect();
    times.dedup();
    let mut passage = LiveOutput::default();
    // one call stops where impacts follow each other closely
    while !times.is_empty() && !live.advance(to, &times, &mut passage) && live.ended().is_none() {
        let reached = live.time();
        times.retain(|t| *t > reached);
    }
    passage.samples
}

/// Drops all but the last `limit` entries; returns how many were dropped.
fn keep_last<T>(entries: &mut VecDeque<T>, limit: usize) -> usize {
    let spare = entries.len().saturating_sub(limit);
    entries.drain(..spare);
    spare
}

fn sampling_step(model: &Model) -> f64 {
    let swing = model.natural_time();
    model.forcing_period().map_or(swing, |period| period.min(swing)) / PER_PERIOD
}

/// Parts in which a motion is advanced, between which it may be cancelled.
const PARTS: u32 = 100;

/// The energy ledger of a model from one time in s to another; that so far if the run ends or is cancelled.
pub fn ledger_over(model: &Model, (from, to): (f64, f64), cancel: Option<&AtomicBool>) -> LiveLedger {
    let mut watch = Watch::new(model);
    let is_cancelled = || cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed));
    let mut reach = |end: f64| {
        let begin = watch.time();
        for part in 1..=PARTS {
            let at =
                if part == PARTS { end } else { begin + (end - begin) * f64::from(part) / f64::from(PARTS) };
            // one call stops where impacts follow each other closely
            while !watch.advance(at) && watch.ended().is_none() && !is_cancelled() {}
        }
        watch.ledger()
    };
    let before = reach(from);
    reach(to).since(&before)
}

/// The kept events with these indices, in the columns of [`events_table`](super::events_table) and two more:
/// `phase_deg`, the phase of the drive, missing if the drive does not repeat; and `lost_j`, the loss of
/// kinetic energy, m (v_in^2 - v_out^2) / 2 with the mass at that time. The loss is missing for contacts with
/// a compliant stop, which lose energy throughout the contact.
pub fn watched_events(watch: &Watch, which: Range<usize>) -> Table {
    let count = watch.events().len();
    let which = which.start.min(count)..which.end.min(count);
    let events: Vec<Event> = watch.events().range(which).copied().collect();
    let phase = |event: &Event| watch.model_at(event.t).drive_phase(event.t).map(|turns| 360.0 * turns);
    let lost = |event: &Event| {
        let mass = watch.model_at(event.t).mass();
        let is_spread = matches!(event.kind, EventKind::Contact | EventKind::Separate);
        // the product of sum and difference is accurate for nearly equal speeds
        (!is_spread).then_some(0.5 * mass * (event.v_in + event.v_out) * (event.v_in - event.v_out))
    };
    events_table(&events).each("phase_deg", &events, phase).each("lost_j", &events, lost)
}

/// `scene` with the start and the phases of `here`, the model that continues a motion from its present state
/// ([`Watch::from_here`]). `None` for noise, which always begins at its seed, and during contact with a
/// compliant stop.
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

/// Sets the phases of all sines and cosines of an excitation. `turns` gives for each its phase and its offset
/// for a negative amplitude, in turns. False if another kind of excitation has a phase.
fn put_phases(excitation: &mut Excitation, turns: &mut impl Iterator<Item = (f64, f64)>) -> bool {
    let quarters = excitation.harmonic(1.0).map_or(0, |drive| drive.quarters) as f64;
    match excitation {
        Excitation::None | Excitation::Constant { .. } => true,
        Excitation::Sine { amplitude_g: amplitude, phase_deg, .. }
        | Excitation::Cosine { amplitude_m_per_s2: amplitude, phase_deg, .. }
        | Excitation::Force { amplitude_n: amplitude, phase_deg, .. } => {
            let Some((turn, half)) = turns.next() else { return false };
            let half = if *amplitude < 0.0 { 0.5 - half } else { half };
            *phase_deg = 360.0 * (turn + half - 0.25 * quarters);
            true
        }
        Excitation::Sum(terms) => terms.iter_mut().all(|term| put_phases(term, turns)),
        Excitation::AmplitudeRamp { .. }
        | Excitation::Chirp { .. }
        | Excitation::Noise { .. }
        | Excitation::Recorded { .. } => false,
    }
}

/// The number of millimetres that converts back to exactly `x` in m, if there is one.
fn millimetres(x: f64) -> f64 {
    let mm = x * 1e3;
    [mm, mm.next_up(), mm.next_down()].into_iter().find(|mm| mm / 1e3 == x).unwrap_or(mm)
}
