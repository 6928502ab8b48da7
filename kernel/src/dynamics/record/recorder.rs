//! Recorder of the samples, events, sums and counts of a run.

use std::sync::atomic::AtomicBool;

use super::barrier::side_of;
use super::goal::Goal;
use super::listing::{Listings, MAX_STROBES};
use super::regime::Classifier;
use super::sums::{Counts, Sums};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::drive::Base;
use crate::dynamics::model::Model;
use crate::dynamics::result::{Event, EventKind, Request, Sample, Side};
use crate::numeric::{CompensatedSum, Scalar};

pub(crate) struct Recorder<'a, T: Copy> {
    pub model: &'a Model,
    pub clock: Clock<T>,
    pub base: &'a dyn Base<T>,
    /// Whether work, damping, impacts and stored energy are summed over the whole run.
    pub ledger: bool,
    /// Whether the run ends with the step of the first crossing.
    pub until_crossing: bool,
    pub unit: f64,
    pub times: &'a [f64],
    pub next_time: usize,
    pub cancel: Option<&'a AtomicBool>,
    /// Samples between two checks of the cancel flag.
    pub samples_per_check: u64,
    /// Samples since the last check.
    pub samples_since_check: u64,
    /// Whether samples were left out because the run was cancelled.
    pub cut_short: bool,
    pub samples: Vec<Sample>,
    pub events: Option<Vec<Event>>,
    pub window: (Instant<T>, Instant<T>),
    /// Forcing period in kernel units; 0 if the drive has none.
    pub period: T,
    pub whole: Sums<T>,
    pub settled: Sums<T>,
    pub low: T,
    pub high: T,
    pub covered: CompensatedSum<T>,
    pub work_moved: f64,
    pub peak_kinetic: f64,
    /// Lowest and highest displacement at the ends of steps over the whole run, if there is a ledger.
    pub step_range: (f64, f64),
    pub barrier: Option<T>,
    /// -1, 1, or 0 if the mass has been on the barrier since the start.
    pub barrier_side: i8,
    pub classifier: Classifier,
    pub goal: Option<Goal<'a>>,
    /// Of a mass that begins to stand still: the instant, the state of the circuit and its rate of decay.
    pub standing_circuit: Option<(Instant<T>, T, T)>,
    /// The first instant of the run at the window's phase.
    pub origin: Instant<T>,
    pub next_strobe: Option<Instant<T>>,
    /// The instant since which the mass rests on a rigid stop.
    pub rests_since: Option<Instant<T>>,
    /// The middle of the last rest that ended with a release, and the side of its stop.
    pub rested: Option<(Instant<T>, Side)>,
    /// Time in kernel units of the shortest rest that ended with a release; infinity without one.
    pub shortest_rest: f64,
    /// State of the circuit at the last stroboscopic state.
    pub strobed_circuit: T,
    pub listings: Listings<T>,
    /// Cycles of the clock in a forcing period.
    pub period_cycles: i64,
    /// Number of stroboscopic states that may still be recorded one by one.
    pub strobes_left: u32,
    /// Whole forcing periods in the settled window; 0 if it holds none.
    pub periods: u64,
    /// Speed of the fastest impact in the window.
    pub impact_speed: T,
    pub counts: Counts,
    /// Largest force of a compliant stop over mass, kernel units.
    pub peak_contact: T,
    pub order: usize,
}

impl<'a, T: Scalar> Recorder<'a, T> {
    pub fn new(
        model: &'a Model,
        (clock, base): (Clock<T>, &'a dyn Base<T>),
        unit: f64,
        order: usize,
        request: &Request<'a>,
        start: (T, T),
    ) -> Self {
        let from = clock.at(model.settle);
        let (periods, cycles) = model.window_periods();
        let to = if periods > 0 {
            Instant { cycle: from.cycle + periods as i64 * cycles, phase: from.phase }
        } else {
            clock.at(model.duration)
        };
        let (origin, first) = match cycles {
            0 => (from, 0),
            _ => (
                Instant { cycle: from.cycle.rem_euclid(cycles), ..from },
                from.cycle.div_euclid(cycles) as u64,
            ),
        };
        let scales = (model.scales.length, model.scales.speed);
        let barrier = model.crossing_level().map(T::of);
        let side = barrier.map_or(0, |b| side_of(start.0, b));
        let mut samples = Vec::new();
        samples.reserve_exact(request.sample_times.len());
        Self {
            model,
            clock,
            base,
            ledger: request.ledger,
            until_crossing: request.until_crossing,
            unit,
            times: request.sample_times,
            next_time: 0,
            cancel: request.cancel,
            samples_per_check: 1,
            samples_since_check: 0,
            cut_short: false,
            samples,
            events: request.events.then(Vec::new),
            window: (from, to),
            period: clock.period * T::of(cycles as f64),
            whole: Sums::new(),
            settled: Sums::new(),
            low: T::of(f64::INFINITY),
            high: T::of(f64::NEG_INFINITY),
            covered: CompensatedSum::new(),
            work_moved: 0.0,
            peak_kinetic: 0.5 * (start.1 * start.1).to_f64(),
            step_range: (start.0.to_f64(), start.0.to_f64()),
            barrier,
            barrier_side: side,
            classifier: Classifier::new(model.rhythm, scales, periods, first),
            goal: None,
            standing_circuit: None,
            origin,
            next_strobe: (periods > 0).then_some(origin),
            rests_since: None,
            rested: None,
            shortest_rest: f64::INFINITY,
            strobed_circuit: T::zero(),
            listings: Listings::new(request, &clock, from, (periods, cycles), model.start_phase),
            period_cycles: cycles,
            strobes_left: MAX_STROBES,
            periods,
            impact_speed: T::zero(),
            counts: Counts::default(),
            peak_contact: T::zero(),
            order,
        }
    }

    /// Acceleration of the base in m/s^2 at an instant in this segment of the drive.
    pub(crate) fn base(&self, at: &Instant<T>, segment: usize) -> f64 {
        self.base.in_si(at, segment, self.unit)
    }

    /// The part of \[at, at + length) inside the settled window, relative to `at`.
    #[inline]
    pub(crate) fn overlap(&self, at: &Instant<T>, length: T) -> Option<(T, T)> {
        let from = self.clock.between(at, &self.window.0).larger(T::zero());
        let to = self.clock.between(at, &self.window.1).smaller(length);
        (to > from).then_some((from, to))
    }

    #[inline]
    pub fn in_window(&self, at: &Instant<T>) -> bool {
        self.clock.between(&self.window.0, at) >= T::zero()
            && self.clock.between(at, &self.window.1) > T::zero()
    }

    /// Forcing periods since the first stroboscopic state; NaN if the drive has no period.
    pub(crate) fn in_periods(&self, at: &Instant<T>) -> f64 {
        (self.clock.between(&self.origin, at) / self.period).to_f64()
    }

    pub(crate) fn lists_crossings(&self) -> bool {
        self.events.is_some() || self.until_crossing || self.classifier.times_all_crossings()
    }

    #[inline]
    pub fn event(&mut self, at: &Instant<T>, kind: EventKind, side: Side, v_in: f64, v_out: f64) {
        if let Some(events) = &mut self.events {
            events.push(Event { t: self.clock.seconds(at), kind, side, v_in, v_out });
        }
    }
}
