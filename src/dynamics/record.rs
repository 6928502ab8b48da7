//! What of a run is kept: samples, events, statistics, ledger. Nothing here acts on the motion.

use super::clock::{Clock, Instant};
use super::model::{Model, Request};
use super::regime::{CrossingLog, Strobe};
use super::result::{Event, EventKind, Ledger, Outcome, Phase, Regime, Run, Sample, Side, Summary};
use super::series::Series;
use crate::numeric::{CompensatedSum, PolynomialRoots, Scalar};

/// Most crossings and stroboscopic states that are kept to tell the regime; a window of more is judged by
/// its first ones.
const KEPT: usize = 1 << 16;

/// Below this share of the length scale a motion is rounding: the mass has not moved.
const STILL: f64 = 1e-12;

/// One accepted step, as the recorder sees it.
pub(crate) struct StepView<'a, T> {
    pub series: &'a Series<T>,
    /// Origin that the series is about.
    pub origin: T,
    /// When the step starts.
    pub at: Instant<T>,
    /// Length that `series.scaled` is for.
    pub scaled_for: T,
    /// Length that is kept, up to `scaled_for`.
    pub length: T,
    /// Bound of |x - x(start)| over the step.
    pub bound: T,
    /// State at the end of what is kept.
    pub x: T,
    pub v: T,
}

/// Sums over an interval of time.
#[derive(Clone)]
struct Sums<T> {
    /// Integral of v^2, kernel units.
    squared_velocity: CompensatedSum<T>,
    /// - integral of a v.
    work: CompensatedSum<T>,
    /// Kinetic energy over mass taken by impacts.
    impact: CompensatedSum<T>,
    /// Time at rest on a stop.
    rested: CompensatedSum<T>,
}

impl<T: Scalar> Sums<T> {
    fn new() -> Self {
        let sum = CompensatedSum::new();
        Self { squared_velocity: sum, work: sum, impact: sum, rested: sum }
    }
}

pub(crate) struct Recorder<'a, T, const LEDGER: bool> {
    model: &'a Model,
    clock: Clock<T>,
    unit: f64,
    times: &'a [f64],
    next_time: usize,
    samples: Vec<Sample>,
    events: Option<Vec<Event>>,
    window: (Instant<T>, Instant<T>),
    /// Forcing period in kernel units; 0 without one.
    period: T,
    whole: Sums<T>,
    settled: Sums<T>,
    low: T,
    high: T,
    covered: CompensatedSum<T>,
    work_moved: f64,
    peak_kinetic: f64,
    barrier: Option<T>,
    /// -1, 0 (on it since the start) or 1.
    barrier_side: i8,
    log: CrossingLog,
    next_strobe: Option<Instant<T>>,
    strobe_cycles: i64,
    counts: Counts,
}

#[derive(Default, Clone, Copy)]
struct Counts {
    crossings: u64,
    impacts: u64,
    releases: u64,
    total_crossings: u64,
    total_impacts: u64,
    sums: u64,
    rests: u64,
}

impl<'a, T: Scalar, const LEDGER: bool> Recorder<'a, T, LEDGER> {
    pub fn new(model: &'a Model, clock: Clock<T>, unit: f64, request: &Request<'a>, start: (T, T)) -> Self {
        let from = clock.at(model.settle);
        let (periods, cycles) = model.window_periods();
        let to = if periods > 0 {
            Instant { cycle: from.cycle + periods as i64 * cycles, phase: from.phase }
        } else {
            clock.at(model.duration)
        };
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
            samples,
            events: request.events.then(Vec::new),
            window: (from, to),
            period: if periods > 0 { clock.period() * T::of(cycles as f64) } else { T::zero() },
            whole: Sums::new(),
            settled: Sums::new(),
            low: T::of(f64::INFINITY),
            high: T::of(f64::NEG_INFINITY),
            covered: CompensatedSum::new(),
            work_moved: 0.0,
            peak_kinetic: 0.5 * (start.1 * start.1).to_f64(),
            barrier,
            barrier_side: side,
            log: CrossingLog::new(periods),
            next_strobe: (periods > 0).then_some(from),
            strobe_cycles: cycles,
            counts: Counts::default(),
        }
    }

    /// The part of [at, at + length) inside the settled window, from the start of the step.
    #[inline]
    fn overlap(&self, at: &Instant<T>, length: T) -> Option<(T, T)> {
        let from = self.clock.between(at, &self.window.0).larger(T::zero());
        let to = self.clock.between(at, &self.window.1).smaller(length);
        (to > from).then_some((from, to))
    }

    fn in_window(&self, at: &Instant<T>) -> bool {
        self.clock.between(&self.window.0, at) >= T::zero()
            && self.clock.between(at, &self.window.1) > T::zero()
    }

    /// Takes in a step of free flight.
    #[inline]
    pub fn step(&mut self, step: &StepView<T>, mut base: impl FnMut(&Instant<T>) -> f64) {
        let overlap = self.overlap(&step.at, step.length);
        let full = overlap.is_some_and(|(from, to)| from == T::zero() && to == step.length);
        if LEDGER {
            let (squared, av) = step.series.integrals::<true>(T::zero(), step.length);
            self.whole.squared_velocity.add(squared);
            self.whole.work.add(-av);
            self.work_moved += av.to_f64().abs();
            self.peak_kinetic = self.peak_kinetic.max(0.5 * (step.v * step.v).to_f64());
            if full {
                self.settled.squared_velocity.add(squared);
                self.settled.work.add(-av);
            }
        }
        if let Some((from, to)) = overlap {
            if !LEDGER || !full {
                let (squared, av) = step.series.integrals::<LEDGER>(from, to);
                self.settled.squared_velocity.add(squared);
                self.settled.work.add(-av);
            }
            self.covered.add(to - from);
            self.extremes(step, from, to, full);
        }
        if let Some(barrier) = self.barrier {
            self.crossings(step, barrier);
        }
        if self.next_strobe.is_some() {
            self.strobes(step);
        }
        if self.next_time < self.times.len() {
            let end = self.clock.seconds(&self.clock.advance(&step.at, step.length));
            while let Some(t) = self.times.get(self.next_time).copied().filter(|t| *t < end) {
                let instant = self.clock.at(t);
                let into = self.clock.between(&step.at, &instant).larger(T::zero()).smaller(step.length);
                self.samples.push(Sample {
                    t,
                    x: (step.series.position(into) + step.origin).to_f64(),
                    v: step.series.velocity(into).to_f64() / self.unit,
                    base_accel: base(&instant),
                    phase: Phase::Free,
                });
                self.next_time += 1;
            }
        }
    }

    fn extremes(&mut self, step: &StepView<T>, from: T, to: T, full: bool) {
        let mut widen = |x: T| {
            self.low = self.low.smaller(x);
            self.high = self.high.larger(x);
        };
        let start = step.series.y[0] + step.origin;
        if full {
            widen(start);
            widen(step.x);
        } else {
            widen(step.series.position(from) + step.origin);
            widen(step.series.position(to) + step.origin);
        }
        if start + step.bound > self.high || start - step.bound < self.low {
            // A turning point inside may lie beyond both ends.
            let n = step.series.known;
            let mut slope = [T::zero(); super::series::ROOM];
            for k in 1..n {
                slope[k - 1] = step.series.scaled[k] * T::of(k as f64);
            }
            PolynomialRoots::new(&slope[..n - 1]).each_sign_change(|s| {
                let t = s * step.scaled_for;
                if t >= from && t <= to {
                    let x = step.series.position(t) + step.origin;
                    self.low = self.low.smaller(x);
                    self.high = self.high.larger(x);
                }
                true
            });
        }
    }

    fn crossings(&mut self, step: &StepView<T>, barrier: T) {
        let end_side = side_of(step.x, barrier);
        let gap = (step.series.y[0] + step.origin) - barrier;
        if end_side == self.barrier_side && gap.abs() > step.bound {
            return;
        }
        if self.barrier_side == 0 {
            self.barrier_side = end_side; // leaves the top on which it started
            return;
        }
        let n = step.series.known;
        let mut g = step.series.scaled;
        let sign = T::of(f64::from(self.barrier_side));
        g[0] = gap * sign;
        for c in &mut g[1..n] {
            *c = *c * sign;
        }
        let mut found = [T::zero(); super::series::ROOM];
        let mut count = 0;
        if gap == T::zero() {
            // The step starts on the top, reached at the end of the last one.
            if end_side == -self.barrier_side {
                count = 1;
            }
        } else {
            PolynomialRoots::new(&g[..n]).each_sign_change(|s| {
                let t = s * step.scaled_for;
                if t > step.length {
                    return false;
                }
                found[count] = t;
                count += 1;
                count < found.len()
            });
            // The end decides the parity: rounding may put a root just beyond it.
            if end_side != 0 && (count % 2 == 1) != (end_side != self.barrier_side) {
                if count > 0 {
                    count -= 1;
                } else {
                    found[0] = step.length;
                    count = 1;
                }
            } else if end_side == 0 && count % 2 == 1 {
                count -= 1; // on the top: the next step tells
            }
        }
        for t in &found[..count] {
            self.barrier_side = -self.barrier_side;
            let at = self.clock.advance(&step.at, *t);
            let v = step.series.velocity(*t).to_f64() / self.unit;
            let side = if self.barrier_side > 0 { Side::Right } else { Side::Left };
            self.counts.total_crossings += 1;
            if self.in_window(&at) {
                self.counts.crossings += 1;
                if self.log.crossings.len() < KEPT && self.period > T::zero() {
                    let time = (self.clock.between(&self.window.0, &at) / self.period).to_f64();
                    self.log.crossings.push((time, side));
                }
            }
            self.event(&at, EventKind::Crossing, side, v, v);
        }
    }

    fn strobes(&mut self, step: &StepView<T>) {
        while let Some(strobe) = self.next_strobe {
            let into = self.clock.between(&step.at, &strobe);
            if into >= step.length {
                return;
            }
            let x = step.series.position(into) + step.origin;
            let v = step.series.velocity(into);
            self.strobe(x, v);
        }
    }

    fn strobe(&mut self, x: T, v: T) {
        let Some(strobe) = &mut self.next_strobe else { return };
        strobe.cycle += self.strobe_cycles;
        self.log.strobes.push(Strobe { x: x.to_f64(), v: v.to_f64() / self.unit });
        if self.log.strobes.len() >= KEPT || self.clock.between(strobe, &self.window.1) < T::zero() {
            self.next_strobe = None;
        }
    }

    /// Takes in a span in which the mass stands still at `x` (at rest on a stop, in an equilibrium, or in
    /// the last, unresolved bounces of a chatter: `phase` free).
    pub fn stand(
        &mut self,
        at: &Instant<T>,
        until: &Instant<T>,
        x: T,
        phase: Phase,
        mut base: impl FnMut(&Instant<T>) -> f64,
    ) {
        let length = self.clock.between(at, until);
        if let Some((from, to)) = self.overlap(at, length) {
            self.covered.add(to - from);
            if phase != Phase::Free {
                self.settled.rested.add(to - from);
            }
            self.low = self.low.smaller(x);
            self.high = self.high.larger(x);
        }
        while let Some(strobe) = self.next_strobe {
            if self.clock.between(&strobe, until) <= T::zero() {
                break;
            }
            self.strobe(x, T::zero());
        }
        if self.next_time < self.times.len() {
            let end = self.clock.seconds(until);
            while let Some(t) = self.times.get(self.next_time).copied().filter(|t| *t < end) {
                let base_accel = base(&self.clock.at(t));
                self.samples.push(Sample { t, x: x.to_f64(), v: 0.0, base_accel, phase });
                self.next_time += 1;
            }
        }
    }

    fn event(&mut self, at: &Instant<T>, kind: EventKind, side: Side, v_in: f64, v_out: f64) {
        if let Some(events) = &mut self.events {
            events.push(Event { t: self.clock.seconds(at), kind, side, v_in, v_out });
        }
    }

    /// An impact with signed velocities in kernel units.
    pub fn impact(&mut self, at: &Instant<T>, side: Side, v_in: T, v_out: T) {
        let taken = (v_in * v_in - v_out * v_out) * T::of(0.5);
        self.whole.impact.add(taken);
        self.counts.total_impacts += 1;
        if LEDGER {
            self.peak_kinetic = self.peak_kinetic.max(0.5 * (v_in * v_in).to_f64());
        }
        if self.in_window(at) {
            self.settled.impact.add(taken);
            self.counts.impacts += 1;
        }
        self.event(at, EventKind::Impact, side, v_in.to_f64() / self.unit, v_out.to_f64() / self.unit);
    }

    /// A chatter summed in closed form from speed `v`: what is left of the kinetic energy goes.
    pub fn chatter_sum(&mut self, at: &Instant<T>, v: T) {
        let taken = v * v * T::of(0.5);
        self.counts.sums += 1;
        self.whole.impact.add(taken);
        if self.in_window(at) {
            self.settled.impact.add(taken);
        }
    }

    pub fn rest(&mut self, at: &Instant<T>, side: Side) {
        self.counts.rests += 1;
        self.event(at, EventKind::Rest, side, 0.0, 0.0);
    }

    pub fn release(&mut self, at: &Instant<T>, side: Side) {
        if self.in_window(at) {
            self.counts.releases += 1;
        }
        self.event(at, EventKind::Release, side, 0.0, 0.0);
    }

    pub fn total_impacts(&self) -> u64 {
        self.counts.total_impacts
    }

    /// Closes the record: `x`, `v` (kernel units) and `phase` at the end, `potentials` at start and end.
    #[allow(clippy::too_many_arguments)]
    pub fn finish(
        mut self,
        end: &Instant<T>,
        (x, v): (T, T),
        start_v: T,
        phase: Phase,
        potentials: (f64, f64),
        outcome: Outcome,
        base: impl Fn(&Instant<T>) -> f64,
    ) -> Run {
        let final_x = x.to_f64();
        let final_v = v.to_f64() / self.unit;
        // What was asked for at the very end (to rounding) is the final state.
        let last = self.clock.seconds(end);
        while let Some(t) = self.times.get(self.next_time).copied() {
            if t > last * (1.0 + 4.0 * f64::EPSILON) {
                break;
            }
            self.samples.push(Sample {
                t,
                x: final_x,
                v: final_v,
                base_accel: base(&self.clock.at(t)),
                phase,
            });
            self.next_time += 1;
        }
        if let Some(strobe) = self.next_strobe {
            // the strobe at the end of the window, which is the end of the run
            if self.clock.between(&strobe, end).abs() <= self.period * T::of(1e-9) {
                self.strobe(x, v);
            }
        }
        let m = self.model.mass;
        let energy = m / (self.unit * self.unit);
        let value = |sum: &CompensatedSum<T>| sum.value().to_f64();
        let covered = value(&self.covered);
        let seen = covered > 0.0;
        let ledger = LEDGER.then(|| {
            let kinetic = |v: T| (v * v).to_f64() * 0.5;
            let work_j = value(&self.whole.work) * energy;
            let damping_j = self.model.damping * value(&self.whole.squared_velocity) / self.unit;
            let impact_j = value(&self.whole.impact) * energy;
            let stored_j = (kinetic(v) - kinetic(start_v)) * energy + (potentials.1 - potentials.0);
            let residual_j = ((work_j - damping_j) - impact_j) - stored_j;
            let moved =
                (self.work_moved + self.peak_kinetic) * energy + damping_j + impact_j.abs() + stored_j.abs();
            let energy_residual = if moved > 0.0 { residual_j.abs() / moved } else { 0.0 };
            Ledger { work_j, damping_j, impact_j, stored_j, residual_j, energy_residual }
        });
        let rms = (value(&self.settled.squared_velocity).max(0.0) / covered).sqrt() / self.unit;
        let travel = (self.high - self.low).to_f64();
        let scales = &self.model.scales;
        let moved = seen && travel > STILL * scales.length;
        let work = value(&self.settled.work);
        let impact_share = (LEDGER && seen && work.abs() > 0.0).then(|| value(&self.settled.impact) / work);
        let regime = if self.model.one_well {
            Regime::OneWell
        } else if !moved {
            Regime::Rest
        } else if self.counts.crossings == 0 {
            Regime::Intrawell
        } else if self.log.crossings_repeat() {
            Regime::Interwell
        } else {
            Regime::Irregular
        };
        let done = outcome == Outcome::Done;
        let period = if done && moved { self.log.period(scales.length, scales.speed) } else { None };
        Run {
            samples: self.samples,
            events: self.events.unwrap_or_default(),
            summary: Summary {
                final_x,
                final_v,
                rms_velocity: seen.then_some(rms),
                regime,
                crossings: self.counts.crossings,
                impacts: self.counts.impacts,
                releases: self.counts.releases,
                max_abs_x: seen.then(|| self.high.to_f64().abs().max(self.low.to_f64().abs())),
                travel: seen.then_some(travel),
                impact_share,
                rested_share: seen.then(|| value(&self.settled.rested) / covered),
                total_crossings: self.counts.total_crossings,
                total_impacts: self.counts.total_impacts,
                chatter_sums: self.counts.sums,
                rests: self.counts.rests,
                period,
                outcome,
                steps: 0,
                evaluations: 0,
                cpu_s: 0.0,
                ledger,
            },
        }
    }
}

fn side_of<T: Scalar>(x: T, barrier: T) -> i8 {
    if x > barrier {
        1
    } else if x < barrier {
        -1
    } else {
        0
    }
}
