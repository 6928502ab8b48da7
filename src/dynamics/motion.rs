//! How does the mass move from one event to the next?
//!
//! The run is a chain of free flights in one arena each and of rests on a stop. A step of a flight is a
//! Taylor series (`series`); its polynomial is also the dense output, and contacts, breaks and crossings are
//! roots of it, found with none missed. Why so, measured against the alternatives in one run on one core:
//! see the table of costs in the README.
//!
//! Three habits keep events sound:
//!
//! - After a located event the state is put exactly on the surface, and the next step knows it ([`Touch`]):
//!   its gap polynomial starts with coefficients that are 0 by definition (one after a rebound or a break, two
//!   after a plastic impact, three after a release), so it is divided by that power of time and the same
//!   contact cannot be found again, however short the flight. Since x = D exactly, the gap needs no difference
//!   of large numbers: a flight of 1e-6 m/s is as exact, relatively, as one of 1 m/s.
//! - A pressed rebound announces its own length, 2 v / a; the series is then extended only until its terms are
//!   negligible over that length: four or five coefficients where a full step has sixteen.
//! - What remains of a chatter once it is short is summed in closed form (Nordmark and Piiroinen 2009).

use super::clock::{Clock, Instant};
use super::drive::{Drive, Ramp, Sine, Still, Tone, Tones, TurnsPerCycle};
use super::equation::{End, EndKind, Equation};
use super::model::{BaseMotion, Model, Request};
use super::record::{Recorder, StepView};
use super::result::{Outcome, Phase, Run, Side};
use super::series::{MAX_ORDER, ROOM, Series, fast_log2};
use crate::numeric::{PolynomialRoots, Ratio, Scalar};

/// Budgets of one run: generous for any sensible scene, and an end within about 20 s of one core for the
/// others (an elastic rebound pressed on a stop with damping dies so slowly that it never ends by itself).
const STEP_BUDGET: u64 = 30_000_000;
const IMPACT_BUDGET: u64 = 5_000_000;

/// A rebound slower than this share of the speed scale may be part of a closed-form sum.
const CHATTER_SPEED: f64 = 1e-6;

/// The longest step, in units of the scene's time scale.
const LONGEST_STEP: f64 = 8.0;

/// Steps between two looks at the cancel flag.
const CANCEL_STRIDE: u64 = 256;

/// A surface that the mass touches at the start of a step, and how many of the leading coefficients of the
/// gap are 0 by definition.
#[derive(Debug, Clone, Copy)]
struct Touch {
    end: End,
    order: usize,
}

/// Orders of a touch: the gap opens with the speed, the acceleration, or what follows them.
const BY_SPEED: usize = 1;
const BY_ACCELERATION: usize = 2;
const BY_JERK: usize = 3;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Contact {
    Free,
    /// At rest on the stop of this end.
    Resting(End),
    /// At rest in an equilibrium that nothing disturbs.
    Motionless,
}

/// Settings of the stepper that follow from the tolerance.
struct Settings<T> {
    order: usize,
    tolerance: f64,
    tolerance_log2: f64,
    speed: T,
    speed_log2: f64,
    longest: f64,
}

impl<T: Scalar> Settings<T> {
    /// The order is the cheapest one by measurement on the nominal cubic: about 4/3 coefficients a digit. The
    /// local tolerance is a tenth of the one asked for, so that the error of a run of some hundred steps
    /// stays near it.
    fn new(model: &Model, unit: f64, tolerance: f64) -> Self {
        let local = tolerance * 0.1;
        let digits = -tolerance.log10();
        let order = (5.0 + 1.25 * digits).round().clamp(8.0, MAX_ORDER as f64) as usize;
        let speed = model.scales.speed * unit;
        Self {
            order,
            tolerance: local,
            tolerance_log2: local.log2(),
            speed: T::of(speed),
            speed_log2: fast_log2(speed),
            longest: LONGEST_STEP * model.scales.time / unit,
        }
    }
}

struct Motion<'a, T: Scalar, D: Drive<T>, const LEDGER: bool> {
    equation: &'a Equation<T>,
    drive: &'a D,
    clock: Clock<T>,
    settings: Settings<T>,
    record: Recorder<'a, T, LEDGER>,
    series: Series<T>,
    roll: D::Rolling,
    segment: usize,
    at: Instant<T>,
    end: Instant<T>,
    x: T,
    v: T,
    arena: usize,
    touch: Option<Touch>,
    contact: Contact,
    steps: u64,
    evaluations: u64,
}

/// Runs the model in numbers of type `T`.
pub(crate) fn run<T: Scalar>(model: &Model, request: &Request, tolerance: f64) -> Run {
    let watch = cpu_time::ThreadTime::now();
    let unit = model.scales.unit();
    let equation = Equation::<T>::new(model, unit);
    let clock = clock(model, unit);
    let mut run = match drive_kind(&model.drive) {
        Kind::Still => with_drive(model, request, tolerance, &equation, clock, &still(model, unit)),
        Kind::Sine => with_drive(model, request, tolerance, &equation, clock, &sine(model, unit)),
        Kind::Tones => with_drive(model, request, tolerance, &equation, clock, &tones(model, unit, &clock)),
    };
    run.summary.cpu_s = watch.elapsed().as_secs_f64();
    run
}

/// Acceleration of the base in m/s^2 at `t` in s.
pub(crate) fn base_acceleration(model: &Model, t: f64) -> f64 {
    let unit = model.scales.unit();
    let clock = clock::<f64>(model, unit);
    let drive = tones(model, unit, &clock);
    let at = clock.at(t);
    let segment = drive.segment_ends.iter().filter(|end| clock.between(end, &at) >= 0.0).count();
    base_at(&drive, &clock, segment, &at, unit)
}

fn base_at<T: Scalar, D: Drive<T>>(
    drive: &D,
    clock: &Clock<T>,
    segment: usize,
    at: &Instant<T>,
    unit: f64,
) -> f64 {
    let mut a = [T::zero(); ROOM];
    drive.seed(clock, at, segment, &mut a, &mut D::Rolling::default());
    a[0].to_f64() / (unit * unit)
}

enum Kind {
    Still,
    Sine,
    Tones,
}

fn drive_kind(drive: &BaseMotion) -> Kind {
    match drive.tones.as_slice() {
        [] => Kind::Still,
        [tone] if drive.constant == 0.0 && tone.ramp.is_none() => Kind::Sine,
        _ => Kind::Tones,
    }
}

fn clock<T: Scalar>(model: &Model, unit: f64) -> Clock<T> {
    // without a drive: a cycle of 16 time units
    Clock::new(model.drive.fastest().unwrap_or(1.0 / (16.0 * unit)), unit)
}

fn still<T: Scalar>(model: &Model, unit: f64) -> Still<T> {
    Still { acceleration: T::of(model.drive.constant * (unit * unit)) }
}

fn sine<T: Scalar>(model: &Model, unit: f64) -> Sine<T> {
    Sine { tone: tone(&model.drive, 0, unit, usize::MAX) }
}

fn tone<T: Scalar>(drive: &BaseMotion, index: usize, unit: f64, holds_from_segment: usize) -> Tone<T> {
    let tone = &drive.tones[index];
    let fastest = drive.fastest().unwrap_or(tone.frequency);
    let square = unit * unit;
    Tone {
        amplitude: T::of(tone.amplitude * square),
        frequency: T::of(tone.frequency * unit),
        ratio: Ratio::of_decimals(tone.frequency, fastest)
            .map_or(TurnsPerCycle::Rounded(tone.frequency / fastest), TurnsPerCycle::Exact),
        phase: T::of(tone.phase),
        quarter: tone.quarter,
        ramp: tone.ramp.map(|(from, over)| Ramp {
            from: T::of(from * square),
            rate: T::of(tone.amplitude * square - from * square) / T::of(over / unit),
            holds_from_segment,
        }),
    }
}

fn tones<T: Scalar>(model: &Model, unit: f64, clock: &Clock<T>) -> Tones<T> {
    let drive = &model.drive;
    let mut ends: Vec<f64> = drive.tones.iter().filter_map(|t| t.ramp.map(|r| r.1)).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let after = |over: f64| ends.iter().take_while(|e| **e <= over).count();
    Tones {
        constant: T::of(drive.constant * (unit * unit)),
        tones: (0..drive.tones.len())
            .map(|i| tone(drive, i, unit, drive.tones[i].ramp.map_or(0, |r| after(r.1))))
            .collect(),
        segment_ends: ends.iter().map(|e| clock.at(*e)).collect(),
        common_cycles: drive.common_cycles().map(|c| c as i64),
    }
}

fn with_drive<T: Scalar, D: Drive<T>>(
    model: &Model,
    request: &Request,
    tolerance: f64,
    equation: &Equation<T>,
    clock: Clock<T>,
    drive: &D,
) -> Run {
    if request.ledger {
        Motion::<T, D, true>::new(model, request, tolerance, equation, clock, drive).run(model, request)
    } else {
        Motion::<T, D, false>::new(model, request, tolerance, equation, clock, drive).run(model, request)
    }
}

/// Whether a step went on or the run ended.
type Flow = Option<Outcome>;

impl<'a, T: Scalar, D: Drive<T>, const LEDGER: bool> Motion<'a, T, D, LEDGER> {
    fn new(
        model: &'a Model,
        request: &Request<'a>,
        tolerance: f64,
        equation: &'a Equation<T>,
        clock: Clock<T>,
        drive: &'a D,
    ) -> Self {
        let unit = equation.unit;
        let x = T::of(model.start.0);
        let v = T::of(model.start.1 * unit);
        Self {
            equation,
            drive,
            clock,
            settings: Settings::new(model, unit, tolerance),
            record: Recorder::new(model, clock, unit, request, (x, v)),
            series: Series::new(),
            roll: D::Rolling::default(),
            segment: 0,
            at: Instant { cycle: 0, phase: T::zero() },
            end: clock.at(model.duration),
            x,
            v,
            arena: model.mechanism.curve.piece_index(model.start.0),
            touch: None,
            contact: if model.motionless { Contact::Motionless } else { Contact::Free },
            steps: 0,
            evaluations: 0,
        }
    }

    fn run(mut self, model: &Model, request: &Request) -> Run {
        let start_v = self.v;
        let potential = |arena: usize, x: T| model.mechanism.curve.pieces()[arena].potential(x.to_f64());
        let start_potential = potential(self.arena, self.x);
        if self.contact == Contact::Free {
            self.place_at_start();
        }
        let outcome = loop {
            let left = self.clock.between(&self.at, &self.end);
            if !(left > T::zero()) {
                break Outcome::Done;
            }
            let ended = match self.contact {
                Contact::Motionless => {
                    self.stand(self.end, Phase::Free);
                    None
                }
                Contact::Resting(end) => {
                    self.rest(end);
                    None
                }
                Contact::Free => self.fly(left),
            };
            if let Some(outcome) = ended {
                break outcome;
            }
            if self.steps.is_multiple_of(CANCEL_STRIDE)
                && request.cancel.is_some_and(|c| c.load(std::sync::atomic::Ordering::Relaxed))
            {
                break Outcome::Cancelled { at: self.clock.seconds(&self.at) };
            }
            if self.record.total_impacts() >= IMPACT_BUDGET {
                let count = self.record.total_impacts();
                break Outcome::ImpactBudget { at: self.clock.seconds(&self.at), count };
            }
            if self.steps >= STEP_BUDGET {
                break Outcome::StepBudget { at: self.clock.seconds(&self.at), count: self.steps };
            }
        };
        let phase = match self.contact {
            Contact::Resting(End::Low) => Phase::LeftStop,
            Contact::Resting(End::High) => Phase::RightStop,
            _ => Phase::Free,
        };
        let potentials = (start_potential, potential(self.arena, self.x));
        let (drive, clock, segment, unit) = (self.drive, self.clock, self.segment, self.equation.unit);
        let mut run =
            self.record.finish(&self.at, (self.x, self.v), start_v, phase, potentials, outcome, |at| {
                base_at(drive, &clock, segment, at, unit)
            });
        run.summary.steps = self.steps;
        run.summary.evaluations = self.evaluations;
        run
    }

    /// Decides what a start on a surface is.
    fn place_at_start(&mut self) {
        let arena = &self.equation.arenas[self.arena];
        for end in [End::Low, End::High] {
            let (level, kind) = arena.end(end);
            if self.x != level || kind == EndKind::Unknown {
                continue;
            }
            let outward = end.sign::<T>() * self.v;
            if kind == EndKind::Stop {
                if outward > T::zero() {
                    self.strike(end, outward);
                } else if outward < T::zero() {
                    self.touch = Some(Touch { end, order: BY_SPEED });
                } else {
                    self.settle(end);
                }
            } else if outward > T::zero() {
                self.enter_neighbour(end);
            } else if outward < T::zero() {
                self.touch = Some(Touch { end, order: BY_SPEED });
            } else {
                self.touch = Some(Touch { end, order: BY_ACCELERATION });
            }
            return;
        }
    }

    /// Outward acceleration of a mass held at the stop of `end`, and its first two time derivatives.
    fn press(&mut self, end: End) -> [T; 3] {
        self.drive.seed(&self.clock, &self.at, self.segment, &mut self.series.a, &mut self.roll);
        let sign = end.sign::<T>();
        let stop = self.equation.stop(end).map_or(T::zero(), |s| s.press);
        let a = &self.series.a;
        [stop - sign * a[0], -(sign * a[1]), -(sign * a[2] * T::of(2.0))]
    }

    /// The mass stands at the stop of `end` with no speed: does it rest or leave? The first derivative of the
    /// pressing acceleration that is not 0 (to the rounding of its terms) decides; if none is, it rests.
    fn settle(&mut self, end: End) {
        let rates = self.press(end);
        let stop_rounding = self.equation.stop(end).map_or(T::zero(), |s| s.press_rounding);
        let rounding = stop_rounding + self.series.a[0].abs() * T::of(4.0 * T::EPSILON);
        self.v = T::zero();
        let mut order = BY_ACCELERATION;
        for (i, rate) in rates.into_iter().enumerate() {
            let size = if i == 0 { rounding } else { T::zero() };
            if rate > size {
                break;
            }
            if rate < -size {
                self.touch = Some(Touch { end, order });
                self.contact = Contact::Free;
                return;
            }
            order += 1;
        }
        self.contact = Contact::Resting(end);
        self.touch = None;
        self.record.rest(&self.at, side(end));
    }

    /// The mass stands still until `until`.
    fn stand(&mut self, until: Instant<T>, phase: Phase) {
        let (drive, clock, segment, unit) = (self.drive, self.clock, self.segment, self.equation.unit);
        self.record.stand(&self.at, &until, self.x, phase, |at| base_at(drive, &clock, segment, at, unit));
        self.at = until;
    }

    /// A rest on the stop of `end`, up to its release, the end of the drive's segment, or the run's end.
    fn rest(&mut self, end: End) {
        let sign = end.sign::<T>();
        let phase = match end {
            End::Low => Phase::LeftStop,
            End::High => Phase::RightStop,
        };
        let mut until = self.end;
        let mut next_segment = false;
        if let Some(border) = self.drive.segment_end(self.segment)
            && self.clock.between(&border, &self.end) > T::zero()
        {
            until = border;
            next_segment = true;
        }
        self.steps += 1;
        let press = self.equation.stop(end).map_or(T::zero(), |s| s.press);
        let fall = self.drive.next_fall(&self.clock, &self.at, &until, self.segment, press, sign);
        match fall {
            Some(fall) => {
                self.stand(fall, phase);
                self.record.release(&self.at, side(end));
                self.contact = Contact::Free;
                self.touch = Some(Touch { end, order: BY_JERK });
            }
            None => {
                self.stand(until, phase);
                if next_segment {
                    self.segment += 1;
                    let rounding = self.equation.stop(end).map_or(T::zero(), |s| s.press_rounding);
                    let press = self.press(end)[0];
                    if press < -(rounding + self.series.a[0].abs() * T::of(4.0 * T::EPSILON)) {
                        self.record.release(&self.at, side(end));
                        self.contact = Contact::Free;
                        self.touch = Some(Touch { end, order: BY_ACCELERATION });
                    }
                }
            }
        }
    }

    /// The mass reaches the stop of `end` with outward speed `speed` > 0.
    fn strike(&mut self, end: End, speed: T) {
        let sign = end.sign::<T>();
        let restitution = self.equation.stop(end).map_or(T::of(1.0), |s| s.restitution);
        let rebound = restitution * speed;
        self.record.impact(&self.at, side(end), sign * speed, -(sign * rebound));
        if rebound > T::zero() {
            self.v = -(sign * rebound);
            self.touch = Some(Touch { end, order: BY_SPEED });
        } else {
            self.settle(end);
        }
    }

    /// The mass passes the break at `end` of its arena.
    fn enter_neighbour(&mut self, end: End) {
        match end {
            End::Low => self.arena -= 1,
            End::High => self.arena += 1,
        }
        self.touch = Some(Touch { end: end.other(), order: BY_SPEED });
    }

    /// A pressed rebound, slow enough: sums what remains of the chatter in closed form. Expects the
    /// drive to be seeded.
    ///
    /// The sum of the flights is S (1 - (2 j/a + g) S/6) + O(S^3), S = 2 v/(a (1 - e)), a the pressing
    /// acceleration, j its rate, g = c/m. It is used where its own error is below the tolerance and the pressing
    /// cannot end before it does.
    fn sum_chatter(&mut self, end: End, rates: [T; 3]) -> bool {
        let Some(stop) = self.equation.stop(end) else { return false };
        let one = T::of(1.0);
        let speed = self.v.abs();
        let [press, jerk, snap] = rates;
        if !(press > T::zero()
            && stop.restitution < one
            && speed < self.settings.speed * T::of(CHATTER_SPEED))
        {
            return false;
        }
        let damping = self.equation.damping;
        let whole = T::of(2.0) * speed / (press * (one - stop.restitution));
        let squares = (jerk.abs() / press) * (jerk.abs() / press)
            + damping * damping
            + stop.stiffness.abs()
            + snap.abs() / press;
        let change = whole * whole * squares;
        if change > T::of(2.5e-3) || whole * change > T::of(0.1 * self.settings.tolerance) {
            return false;
        }
        let sum = whole * (one - (T::of(2.0) * jerk / press + damping) * whole / T::of(6.0));
        let until = self.clock.advance(&self.at, sum);
        let limit = self.segment_limit();
        if self.clock.between(&until, &limit) <= T::zero() {
            return false;
        }
        self.record.chatter_sum(&self.at, speed);
        self.v = T::zero();
        self.stand(until, Phase::Free);
        self.steps += 1;
        self.contact = Contact::Resting(end);
        self.touch = None;
        self.record.rest(&self.at, side(end));
        true
    }

    /// The end of the drive's segment or of the run, whichever comes first.
    fn segment_limit(&self) -> Instant<T> {
        match self.drive.segment_end(self.segment) {
            Some(border) if self.clock.between(&border, &self.end) > T::zero() => border,
            _ => self.end,
        }
    }

    /// One step of free flight; `left` is the time to the end of the run.
    fn fly(&mut self, left: T) -> Flow {
        let zero = T::zero();
        let arena = &self.equation.arenas[self.arena];
        self.drive.seed(&self.clock, &self.at, self.segment, &mut self.series.a, &mut self.roll);
        self.evaluations += 1;

        // A rebound that is pressed back announces the length of its flight.
        let mut flight = None;
        if let Some(Touch { end, order: BY_SPEED }) = self.touch
            && arena.end(end).1 == EndKind::Stop
        {
            let sign = end.sign::<T>();
            let a = &self.series.a;
            let press = self.equation.stop(end).map_or(zero, |s| s.press) - sign * a[0];
            if press > zero {
                let rates = [press, -(sign * a[1]), -(sign * a[2] * T::of(2.0))];
                if self.sum_chatter(end, rates) {
                    return None;
                }
                flight = Some(T::of(3.0) * self.v.abs() / press);
            }
        }

        self.series.start(self.x - arena.origin, self.v);
        let natural = self.expand(flight);
        if !(natural > 0.0) {
            return Some(Outcome::NotFinite { at: self.clock.seconds(&self.at) });
        }
        let mut h = T::of(natural);
        if let Some(flight) = flight {
            h = h.smaller(flight);
        }
        let mut arrives = None;
        if left <= h {
            h = left;
            arrives = Some(self.end);
        }
        let mut segment_ends = false;
        if let Some(border) = self.drive.segment_end(self.segment) {
            let to_border = self.clock.between(&self.at, &border);
            if to_border <= h {
                h = to_border;
                arrives = Some(border);
                segment_ends = true;
            }
        }

        let bound = self.series.scale(h);
        let exit = self.find_exit(bound);
        let (length, touched) = match exit {
            Some((s, end)) => (s * h, Some(end)),
            None => (h, None),
        };
        let v = self.series.velocity(length);
        let x = match touched {
            Some(end) => arena.end(end).0,
            None => self.series.position(length) + arena.origin,
        };
        if !(x.is_finite() && v.is_finite()) {
            return Some(Outcome::NotFinite { at: self.clock.seconds(&self.at) });
        }
        self.steps += 1;
        let view = StepView {
            series: &self.series,
            origin: arena.origin,
            at: self.at,
            scaled_for: h,
            length,
            bound,
            x,
            v,
        };
        let (drive, clock, segment, unit) = (self.drive, self.clock, self.segment, self.equation.unit);
        self.record.step(&view, |at| base_at(drive, &clock, segment, at, unit));
        self.at = match arrives {
            Some(instant) if touched.is_none() => instant,
            _ => self.clock.advance(&self.at, length),
        };
        self.x = x;
        self.v = v;
        self.touch = None;
        if segment_ends && touched.is_none() {
            self.segment += 1;
        }
        touched.and_then(|end| self.reach(end, length == zero))
    }

    /// Extends the series as far as the step needs and returns the step's natural length (NaN where the
    /// coefficients are not finite).
    fn expand(&mut self, flight: Option<T>) -> f64 {
        let arena = &self.equation.arenas[self.arena];
        let damping = self.equation.damping;
        let order = self.settings.order;
        self.series.push(&arena.force, damping, self.drive, &mut self.roll);
        if let Some(Touch { order: BY_JERK.., .. }) = self.touch {
            self.series.y[2] = T::zero(); // a release: the net force is 0 by definition
        }
        if let Some(flight) = flight {
            // Stop once two terms in a row are negligible against the rebound's own speed.
            let negligible = self.v.abs() * T::of(self.settings.tolerance * 0.1);
            let mut power = flight;
            let mut small = 0;
            while self.series.known <= order {
                self.series.push(&arena.force, damping, self.drive, &mut self.roll);
                let k = self.series.known - 1;
                power = power * flight;
                let term = (self.series.y[k] * power).abs() * T::of(k as f64);
                small = if term <= negligible { small + 1 } else { 0 };
                if small == 2 {
                    return flight.to_f64();
                }
            }
        }
        while self.series.known <= order {
            self.series.push(&arena.force, damping, self.drive, &mut self.roll);
        }
        let s = &self.settings;
        self.series.natural_step(s.speed_log2, s.tolerance_log2, s.longest)
    }

    /// The first contact with an end of the arena within the step, as a share of it.
    fn find_exit(&mut self, bound: T) -> Option<(T, End)> {
        let zero = T::zero();
        let arena = &self.equation.arenas[self.arena];
        let n = self.series.known;
        let mut first: Option<(T, End)> = None;
        for end in [End::Low, End::High] {
            let sign = end.sign::<T>();
            let gap = sign * (arena.end(end).0 - self.x);
            let touch = self.touch.filter(|t| t.end == end);
            if touch.is_none() && gap > bound {
                continue;
            }
            let mut g = [zero; ROOM];
            for (slot, c) in g[1..n].iter_mut().zip(&self.series.scaled[1..n]) {
                *slot = -(sign * *c);
            }
            g[0] = gap;
            let mut from = touch.map_or(0, |t| t.order.min(n - 1));
            // A coefficient that is exactly 0 decides nothing.
            while from + 1 < n && g[from] == zero {
                from += 1;
            }
            let g = &g[from..n];
            let s = if g[0] > zero {
                PolynomialRoots::new(g).first()
            } else if g[0] < zero {
                Some(zero) // outward at once
            } else {
                None // it stays where it is
            };
            if let Some(s) = s
                && first.is_none_or(|f| s < f.0)
            {
                first = Some((s, end));
            }
        }
        first
    }

    /// The mass has reached an end of its arena; `at_once` where the step began there and led outward.
    fn reach(&mut self, end: End, at_once: bool) -> Flow {
        let outward = end.sign::<T>() * self.v;
        match self.equation.arenas[self.arena].end(end).1 {
            EndKind::Stop => {
                if outward > T::zero() {
                    self.strike(end, outward);
                } else {
                    self.settle(end); // a touch without speed is no impact
                }
                None
            }
            EndKind::Break => {
                if outward > T::zero() {
                    self.enter_neighbour(end);
                } else {
                    // A touch of the break: back inside, unless the acceleration leads out.
                    self.v = T::zero();
                    if at_once {
                        self.enter_neighbour(end);
                        self.touch = Some(Touch { end: end.other(), order: BY_ACCELERATION });
                    } else {
                        self.touch = Some(Touch { end, order: BY_ACCELERATION });
                    }
                }
                None
            }
            EndKind::Unknown => Some(Outcome::LeftTable { at: self.clock.seconds(&self.at) }),
        }
    }
}

fn side(end: End) -> Side {
    match end {
        End::Low => Side::Left,
        End::High => Side::Right,
    }
}
