//! What of a run is kept: samples, events, statistics, ledger. Nothing here acts on the motion.

use std::sync::atomic::{AtomicBool, Ordering};

use super::clock::{Clock, Instant};
use super::glide::Glide;
use super::model::{Model, Request};
use super::passages::{Passages, side_of};
use super::path::{Path, StepView};
use super::penetration::Penetration;
use super::recurrence::{Entry, Log};
use super::regime::Judge;
use super::result::{Event, EventKind, Phase, Sample, Side};
use super::taylor;
use super::totals::{Counts, Sums};
use crate::numeric::{CompensatedSum, GaussLegendre, PolynomialRoots, Scalar};

pub(crate) struct Recorder<'a, T: Copy, const LEDGER: bool> {
    pub(super) model: &'a Model,
    pub(super) clock: Clock<T>,
    pub(super) unit: f64,
    pub(super) times: &'a [f64],
    pub(super) next_time: usize,
    pub(super) cancel: Option<&'a AtomicBool>,
    /// Samples between two looks at that, and since the last.
    pub(super) samples_per_look: u64,
    samples_since_look: u64,
    /// Samples were left out since the run is told to stop.
    pub(super) cut_short: bool,
    pub(super) samples: Vec<Sample>,
    pub(super) events: Option<Vec<Event>>,
    pub(super) window: (Instant<T>, Instant<T>),
    /// Forcing period in kernel units; 0 where the drive has none.
    pub(super) period: T,
    pub(super) whole: Sums<T>,
    pub(super) settled: Sums<T>,
    pub(super) low: T,
    pub(super) high: T,
    pub(super) covered: CompensatedSum<T>,
    pub(super) work_moved: f64,
    pub(super) peak_kinetic: f64,
    /// Lowest and highest displacement at the ends of steps over the whole run, where there is a ledger.
    pub(super) places: (f64, f64),
    pub(super) barrier: Option<T>,
    /// -1, 0 (on it since the start) or 1.
    pub(super) barrier_side: i8,
    pub(super) judge: Judge,
    /// The first instant of the run at the window's phase.
    pub(super) origin: Instant<T>,
    pub(super) next_strobe: Option<Instant<T>>,
    /// Cycles of the clock in a forcing period.
    pub(super) period_cycles: i64,
    /// How many stroboscopic states may still be told one by one.
    pub(super) strobes_left: u32,
    /// Forcing periods in the window.
    pub(super) periods: u64,
    /// Speed of the fastest impact in the window.
    pub(super) impact_speed: T,
    pub(super) counts: Counts,
    /// Largest force of a compliant stop over mass, kernel units.
    pub(super) peak_contact: T,
    /// Order of the series.
    pub(super) order: usize,
    /// All that is told, where a cycle is waited for.
    pub(super) log: Option<Box<Log<T>>>,
}

impl<'a, T: Scalar, const LEDGER: bool> Recorder<'a, T, LEDGER> {
    pub fn new(
        model: &'a Model,
        clock: Clock<T>,
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
        let origin = match cycles {
            0 => from,
            _ => Instant { cycle: from.cycle.rem_euclid(cycles), phase: from.phase },
        };
        let first = if cycles == 0 { 0 } else { from.cycle.div_euclid(cycles) as u64 };
        let scales = (model.scales.length, model.scales.speed);
        let barrier = model.crossing_level.map(T::of);
        let side = barrier.map_or(0, |b| side_of(start.0, b));
        let mut samples = Vec::new();
        samples.reserve_exact(request.sample_times.len());
        Self {
            model,
            clock,
            unit,
            times: request.sample_times,
            next_time: 0,
            cancel: request.cancel,
            samples_per_look: 1,
            samples_since_look: 0,
            cut_short: false,
            samples,
            events: request.events.then(Vec::new),
            window: (from, to),
            period: clock.period() * T::of(cycles as f64),
            whole: Sums::new(),
            settled: Sums::new(),
            low: T::of(f64::INFINITY),
            high: T::of(f64::NEG_INFINITY),
            covered: CompensatedSum::new(),
            work_moved: 0.0,
            peak_kinetic: 0.5 * (start.1 * start.1).to_f64(),
            places: (start.0.to_f64(), start.0.to_f64()),
            barrier,
            barrier_side: side,
            judge: Judge::new(model.rhythm, scales, periods, first),
            origin,
            next_strobe: (periods > 0).then_some(origin),
            period_cycles: cycles,
            strobes_left: super::window::MOST_STROBES,
            periods,
            impact_speed: T::zero(),
            counts: Counts::default(),
            peak_contact: T::zero(),
            order,
            log: None,
        }
    }

    /// The part of [at, at + length) inside the settled window, from the start of the step.
    #[inline]
    pub(super) fn overlap(&self, at: &Instant<T>, length: T) -> Option<(T, T)> {
        let from = self.clock.between(at, &self.window.0).larger(T::zero());
        let to = self.clock.between(at, &self.window.1).smaller(length);
        (to > from).then_some((from, to))
    }

    fn in_window(&self, at: &Instant<T>) -> bool {
        self.clock.between(&self.window.0, at) >= T::zero()
            && self.clock.between(at, &self.window.1) > T::zero()
    }

    /// What integrals over a step are taken with: half as many points as a full series has coefficients, and no more than
    /// a shorter one needs.
    #[inline]
    fn rule_of<P: Path<T>>(&self, path: &P) -> &'static GaussLegendre<T> {
        let points = self.order / 2 + 1;
        T::gauss_legendre(if P::IN_CONTACT { points } else { points.min(path.known() - 1) })
    }

    /// Takes in a step of free flight, or of contact with a compliant stop.
    #[inline]
    pub fn step<P: Path<T>>(&mut self, step: &StepView<T, P>, mut base: impl FnMut(&Instant<T>) -> f64) {
        if let Some(log) = &mut self.log {
            log.add_step(step);
        }
        let overlap = self.overlap(&step.at, step.duration);
        let rule = self.rule_of(step.path);
        let full = overlap.is_some_and(|(from, to)| from == T::zero() && to == step.duration);
        if LEDGER {
            let (squared, av) = step.path.integrals::<true>(rule, T::zero(), step.length);
            self.whole.squared_velocity.add(squared);
            self.whole.work.add(-av);
            self.work_moved += av.to_f64().abs();
            self.peak_kinetic = self.peak_kinetic.max(0.5 * (step.v * step.v).to_f64());
            let x = step.x.to_f64();
            self.places = (self.places.0.min(x), self.places.1.max(x));
            if full {
                self.settled.squared_velocity.add(squared);
                self.settled.work.add(-av);
            }
        }
        if let Some((begin, end)) = overlap {
            // (a time of contact is inverted to half its digits, which the ends of a whole step need not suffer)
            let (from, to) = match full {
                true => (T::zero(), step.length),
                false => (step.path.parameter(begin, step.length), step.path.parameter(end, step.length)),
            };
            if !LEDGER || !full {
                let (squared, av) = step.path.integrals::<LEDGER>(rule, from, to);
                self.settled.squared_velocity.add(squared);
                self.settled.work.add(-av);
            }
            self.covered.add(end - begin);
            if P::IN_CONTACT {
                self.settled.rested.add(end - begin);
            }
            if LEDGER {
                let moment = step.path.moment(rule, from, to) + step.origin * (end - begin);
                self.settled.displacement.add(moment);
            }
            self.extremes(step, from, to, full);
        }
        if let Some(barrier) = self.barrier {
            let end_side = side_of(step.x, barrier);
            let gap = (step.path.start() + step.origin) - barrier;
            if end_side != self.barrier_side || !(gap.abs() > step.bound) {
                self.crossings(step, gap, end_side);
            }
        }
        if self.next_strobe.is_some() {
            self.strobes(step);
        }
        if self.next_time < self.times.len() {
            let end = self.clock.seconds(&self.clock.advance(&step.at, step.duration));
            while let Some(t) = self.next_sample(end) {
                let instant = self.clock.at(t);
                let into = self.clock.between(&step.at, &instant).larger(T::zero()).smaller(step.duration);
                let into = step.path.parameter(into, step.length);
                self.samples.push(Sample {
                    t,
                    x: step.x_at(into).to_f64(),
                    v: step.path.velocity(into).to_f64() / self.unit,
                    base_accel: base(&instant),
                    phase: step.path.phase(),
                });
                self.next_time += 1;
            }
        }
    }

    /// The time in s of the next sample, where it comes before `end`. A single step, or a rest, may hold all that there are,
    /// each with the sum of a drive's tones: once the run is told to stop there are no more.
    fn next_sample(&mut self, end: f64) -> Option<f64> {
        let next = self.times.get(self.next_time).copied().filter(|t| *t < end)?;
        self.samples_since_look += 1;
        if self.samples_since_look >= self.samples_per_look {
            self.samples_since_look = 0;
            if self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                self.times = &self.times[..self.next_time];
                self.cut_short = true;
                return None;
            }
        }
        Some(next)
    }

    fn extremes<P: Path<T>>(&mut self, step: &StepView<T, P>, from: T, to: T, full: bool) {
        let (first, last) = match full {
            true => (step.path.start() + step.origin, step.x),
            false => (step.x_at(from), step.x_at(to)),
        };
        let endless = T::of(f64::INFINITY);
        let mut glide = Glide { start: first, end: last, bound: endless, bend: endless, limits: step.limits };
        glide.bound = if full { step.bound } else { step.bound + step.bound };
        let (low, high, mut turns) = glide.extremes((self.low, self.high));
        if turns
            && full
            && step.length == step.whole
            && let Some((y, _)) = step.path.in_time()
        {
            glide.bend = taylor::bend(y, step.length);
            (_, _, turns) = glide.extremes((low, high));
        }
        (self.low, self.high) = (low, high);
        if turns {
            let n = step.path.known();
            let mut slope = [T::zero(); super::series::ROOM];
            let scaled = step.path.scaled(step.whole);
            for (k, slot) in (1..n).zip(slope.iter_mut()) {
                *slot = scaled[k] * T::whole(k);
            }
            if slope[0] < T::zero() {
                // a value of 0 counts as negative: the mirrored motion must be told the same
                slope[..n - 1].iter_mut().for_each(|c| *c = -*c);
            }
            PolynomialRoots::new(&slope[..n - 1]).each_sign_change(|s| {
                let t = s * step.whole;
                if t >= from && t <= to {
                    let x = step.x_at(t);
                    self.low = self.low.smaller(x);
                    self.high = self.high.larger(x);
                }
                true
            });
        }
    }

    /// Takes in the passages of the top within a step that starts `gap` to the right of it and ends on `end_side`.
    fn crossings<P: Path<T>>(&mut self, step: &StepView<T, P>, gap: T, end_side: i8) {
        let mut g = step.path.scaled(step.whole);
        g[0] = gap;
        let Some(passages) = Passages::new(&mut g[..step.path.known()], self.barrier_side, end_side) else {
            return;
        };
        self.barrier_side = passages.from;
        if !self.instants_matter(step) {
            let count = passages.count();
            self.barrier_side = passages.side_after(count);
            self.counts.total_crossings += count as u64;
            if self.in_window(&step.at) {
                self.counts.crossings += count as u64;
            }
            return;
        }
        let mut found = [T::zero(); super::series::ROOM];
        let mut count = passages.at_once;
        passages.roots.each_sign_change(|s| {
            let t = s * step.whole;
            if t > step.length || count == found.len() {
                return false;
            }
            found[count] = t;
            count += 1;
            true
        });
        if count == 0 {
            found[0] = step.length;
        }
        for t in &found[..passages.settle(count)] {
            self.crossing(step, *t);
        }
    }

    /// Whether it must be known when within the step a crossing happens, not only that it does: events list it, and
    /// so does what tells the regime; a step cut short or near an end of the window may hold a crossing beyond it.
    fn instants_matter<P: Path<T>>(&self, step: &StepView<T, P>) -> bool {
        // By two lengths: more than rounding can hide.
        let clear = |border: &Instant<T>| {
            let left = self.clock.between(&step.at, border);
            left <= T::zero() || left > step.duration + step.duration
        };
        self.lists_crossings()
            || step.length != step.whole
            || !(clear(&self.window.0) && clear(&self.window.1))
            || (self.period > T::zero() && self.in_window(&step.at))
    }

    /// Whether the instant of every crossing matters.
    pub(super) fn lists_crossings(&self) -> bool {
        self.events.is_some() || self.judge.times_all_crossings()
    }

    fn crossing<P: Path<T>>(&mut self, step: &StepView<T, P>, into: T) {
        self.barrier_side = -self.barrier_side;
        let at = self.clock.advance(&step.at, step.path.time(into));
        let v = step.path.velocity(into).to_f64() / self.unit;
        let side = if self.barrier_side > 0 { Side::Right } else { Side::Left };
        self.counts.total_crossings += 1;
        if self.in_window(&at) {
            self.counts.crossings += 1;
        }
        self.judge.crossing(self.in_periods(&at), side, self.clock.seconds(&at));
        self.event(&at, EventKind::Crossing, side, v, v);
    }

    /// Takes in a span in which the mass stands still at `x` (at rest on a stop, in an equilibrium, or in
    /// the last, unresolved bounces of a chatter: `phase` free, and `v` the speed at its first instant).
    pub fn stand(
        &mut self,
        at: &Instant<T>,
        until: &Instant<T>,
        (x, v): (T, T),
        phase: Phase,
        mut base: impl FnMut(&Instant<T>) -> f64,
    ) {
        self.keep(|| Entry::Stand { at: *at, until: *until, state: (x, v), phase });
        let length = self.clock.between(at, until);
        if let Some((from, to)) = self.overlap(at, length) {
            self.covered.add(to - from);
            if phase != Phase::Free {
                self.settled.rested.add(to - from);
            }
            if LEDGER {
                self.settled.displacement.add(x * (to - from));
            }
            self.low = self.low.smaller(x);
            self.high = self.high.larger(x);
        }
        let mut told = 0;
        while let Some(strobe) = self.next_strobe {
            if self.clock.between(&strobe, until) <= T::zero() {
                break;
            }
            self.strobe(x, T::zero());
            told += 1;
            if told == super::window::STILL {
                told = 0;
                self.skip_strobes(until);
            }
        }
        if self.next_time < self.times.len() {
            let (begin, end) = (self.clock.seconds(at), self.clock.seconds(until));
            while let Some(t) = self.next_sample(end) {
                let base_accel = base(&self.clock.at(t));
                let v = if t <= begin { v.to_f64() / self.unit } else { 0.0 };
                self.samples.push(Sample { t, x: x.to_f64(), v, base_accel, phase });
                self.next_time += 1;
            }
        }
    }

    #[inline]
    fn keep(&mut self, entry: impl FnOnce() -> Entry<T>) {
        if let Some(log) = &mut self.log {
            log.add(entry());
        }
    }

    fn event(&mut self, at: &Instant<T>, kind: EventKind, side: Side, v_in: f64, v_out: f64) {
        if let Some(events) = &mut self.events {
            events.push(Event { t: self.clock.seconds(at), kind, side, v_in, v_out });
        }
    }

    /// An impact with signed velocities in kernel units.
    pub fn impact(&mut self, at: &Instant<T>, side: Side, v_in: T, v_out: T) {
        self.keep(|| Entry::Impact { at: *at, side, v_in, v_out });
        let taken = (v_in * v_in - v_out * v_out) * T::of(0.5);
        self.whole.impact.add(taken);
        self.counts.total_impacts += 1;
        if LEDGER {
            self.peak_kinetic = self.peak_kinetic.max(0.5 * (v_in * v_in).to_f64());
        }
        if self.in_window(at) {
            self.settled.impact.add(taken);
            self.counts.impacts += 1;
            self.impact_speed = self.impact_speed.larger(v_in.abs());
        }
        self.event(at, EventKind::Impact, side, v_in.to_f64() / self.unit, v_out.to_f64() / self.unit);
    }

    /// What a compliant stop took and how hard it was pressed, over a step in contact that has been taken in.
    pub fn contact(&mut self, step: &StepView<T, Penetration<T>>) {
        if LEDGER {
            let rule = self.rule_of(step.path);
            let whole = step.path.loss(rule, T::zero(), step.length);
            self.whole.impact.add(whole);
            match self.overlap(&step.at, step.duration) {
                Some((from, to)) if from == T::zero() && to == step.duration => {
                    self.settled.impact.add(whole)
                }
                Some((from, to)) => {
                    let parameter = |time: T| step.path.parameter(time, step.length);
                    self.settled.impact.add(step.path.loss(rule, parameter(from), parameter(to)));
                }
                None => {}
            }
        }
        let until = if step.whole > T::zero() { step.length / step.whole } else { T::zero() };
        self.peak_contact = step.path.peak(step.whole, until, self.peak_contact);
    }

    /// The mass touches a compliant stop with this signed velocity in kernel units. `strikes`: it came from outside, and
    /// does not stand there from the start.
    pub fn touch(&mut self, at: &Instant<T>, side: Side, v: T, strikes: bool) {
        if strikes {
            self.counts.total_impacts += 1;
            if self.in_window(at) {
                self.counts.impacts += 1;
                self.impact_speed = self.impact_speed.larger(v.abs());
            }
        }
        if LEDGER {
            self.peak_kinetic = self.peak_kinetic.max(0.5 * (v * v).to_f64());
        }
        let v = v.to_f64() / self.unit;
        self.event(at, EventKind::Contact, side, v, v);
    }

    /// The mass leaves a compliant stop with this signed velocity in kernel units.
    pub fn separate(&mut self, at: &Instant<T>, side: Side, v: T) {
        let v = v.to_f64() / self.unit;
        self.event(at, EventKind::Separate, side, v, v);
    }

    /// A chatter summed in closed form from speed `v`: what is left of the kinetic energy goes.
    pub fn chatter_sum(&mut self, at: &Instant<T>, v: T) {
        self.keep(|| Entry::Chatter { at: *at, v });
        let taken = v * v * T::of(0.5);
        self.counts.sums += 1;
        self.whole.impact.add(taken);
        if self.in_window(at) {
            self.settled.impact.add(taken);
        }
    }

    pub fn rest(&mut self, at: &Instant<T>, side: Side) {
        self.keep(|| Entry::Rest { at: *at, side });
        self.counts.rests += 1;
        self.event(at, EventKind::Rest, side, 0.0, 0.0);
    }

    pub fn release(&mut self, at: &Instant<T>, side: Side) {
        self.keep(|| Entry::Release { at: *at, side });
        if self.in_window(at) {
            self.counts.releases += 1;
        }
        self.judge.release(self.in_periods(at), self.clock.seconds(at));
        self.event(at, EventKind::Release, side, 0.0, 0.0);
    }

    pub fn total_impacts(&self) -> u64 {
        self.counts.total_impacts
    }
}
