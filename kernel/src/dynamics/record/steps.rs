//! Recording of steps: integrals, extremes, samples, and the state of a circuit.

use std::sync::atomic::Ordering;

use super::barrier::side_of;
use super::recorder::Recorder;
use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Circuit;
use crate::dynamics::result::Sample;
use crate::dynamics::series::polynomial;
use crate::dynamics::step::chord::Chord;
use crate::dynamics::step::path::{InStop, Path, StepData};
use crate::numeric::{GaussLegendre, PolynomialRoots, Scalar, decay, single_root};

impl<T: Scalar> Recorder<'_, T> {
    /// The rule for integrals over a step: half as many points as a full series has coefficients, and no more
    /// than a shorter series needs.
    #[inline]
    fn rule_of<P: Path<T>>(&self, path: &P) -> &'static GaussLegendre<T> {
        let points = self.order / 2 + 1;
        T::gauss_legendre(if P::IN_CONTACT { points } else { points.min(path.known() - 1) })
    }

    /// Records a step of free flight, or of contact with a compliant stop, in this segment of the drive.
    /// `circuit` are the coefficients of a circuit's state in free flight.
    #[inline]
    pub fn step<P: Path<T>>(&mut self, path: &P, circuit: Option<&[T]>, step: &StepData<T>, segment: usize) {
        let overlap = self.overlap(&step.at, step.duration);
        let rule = self.rule_of(path);
        let full = overlap.is_some_and(|(from, to)| from == T::zero() && to == step.duration);
        if self.ledger {
            let (squared, av) = path.integrals::<true>(rule, T::zero(), step.length);
            self.whole.squared_velocity.add(squared);
            self.whole.work.add(-av);
            self.work_moved += av.to_f64().abs();
            self.peak_kinetic = self.peak_kinetic.max(0.5 * (step.v * step.v).to_f64());
            let x = step.x.to_f64();
            self.step_range = (self.step_range.0.min(x), self.step_range.1.max(x));
            if full {
                self.settled.squared_velocity.add(squared);
                self.settled.work.add(-av);
            }
        }
        if let Some(state) = circuit {
            self.circuit(state, step.length, rule, overlap);
        }
        if let Some((begin, end)) = overlap {
            // A time in contact can be inverted only to half its digits, so a whole step is not inverted.
            let (from, to) = match full {
                true => (T::zero(), step.length),
                false => (path.parameter(begin, step.length), path.parameter(end, step.length)),
            };
            if !self.ledger || !full {
                let (squared, av) = match self.ledger {
                    true => path.integrals::<true>(rule, from, to),
                    false => path.integrals::<false>(rule, from, to),
                };
                self.settled.squared_velocity.add(squared);
                self.settled.work.add(-av);
            }
            self.covered.add(end - begin);
            if P::IN_CONTACT {
                self.settled.rested.add(end - begin);
            }
            if self.ledger {
                let moment = path.moment(rule, from, to) + step.origin * (end - begin);
                self.settled.displacement.add(moment);
            }
            self.extremes(path, step, from, to, full);
        }
        if let Some(barrier) = self.barrier {
            let end_side = side_of(step.x, barrier);
            let gap = (path.start() + step.origin) - barrier;
            if end_side != self.barrier_side || !(gap.abs() > step.bound) {
                self.crossings(path, step, gap, end_side);
            }
        }
        let into = |strobe: &Instant<T>| self.clock.between(&step.at, strobe);
        if self.next_strobe.as_ref().is_some_and(|strobe| into(strobe) < step.duration) {
            self.strobes(path, circuit, step);
        }
        if !self.listings.is_empty() {
            self.list_states(path, circuit, step);
        }
        if self.next_time < self.times.len() {
            let end = self.clock.seconds(&self.clock.advance(&step.at, step.duration));
            while let Some(t) = self.next_sample(end) {
                let instant = self.clock.at(t);
                let into = self.clock.between(&step.at, &instant).larger(T::zero()).smaller(step.duration);
                let into = path.parameter(into, step.length);
                self.samples.push(Sample {
                    t,
                    x: step.x_at(path, into).to_f64(),
                    v: path.velocity(into).to_f64() / self.unit,
                    base_accel: self.base(&instant, segment),
                    phase: path.phase(),
                    electrical: circuit.map_or(0.0, |w| self.electrical(polynomial::value(w, into))),
                });
                self.next_time += 1;
            }
        }
    }

    /// The time in s of the next sample, if it comes before `end`. One step or rest may contain all samples,
    /// and each sample sums the tones of the drive, so the cancel flag is checked here too; a cancelled run
    /// takes no further samples.
    pub fn next_sample(&mut self, end: f64) -> Option<f64> {
        let next = self.times.get(self.next_time).copied().filter(|t| *t < end)?;
        self.samples_since_check += 1;
        if self.samples_since_check >= self.samples_per_check {
            self.samples_since_check = 0;
            if self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                self.times = &self.times[..self.next_time];
                self.cut_short = true;
                return None;
            }
        }
        Some(next)
    }

    fn extremes<P: Path<T>>(&mut self, path: &P, step: &StepData<T>, from: T, to: T, full: bool) {
        let (first, last) = match full {
            true => (path.start() + step.origin, step.x),
            false => (step.x_at(path, from), step.x_at(path, to)),
        };
        let endless = T::of(f64::INFINITY);
        let (zero, limits) = ((T::zero(), T::zero()), step.limits);
        let deviations = (endless, endless, endless);
        let bound = if full { step.bound } else { step.bound + step.bound };
        let chord =
            Chord { start: first, end: last, bound, deviations, slopes: zero, curvatures: zero, limits };
        let (low, high, mut turns) = chord.extremes((self.low, self.high));
        (self.low, self.high) = (low, high);
        if turns
            && full
            && let Some(y) = path.in_time()
        {
            let chord = Chord::new(y, (first, last), (step.length, step.v), bound, limits);
            (_, _, turns) = chord.extremes((low, high));
            if turns
                && chord.turns_once()
                && let Some(t) = turning_point(y, step.length, &chord)
            {
                let x = step.x_at(path, t);
                (self.low, self.high) = (self.low.smaller(x), self.high.larger(x));
                turns = false;
            }
        }
        if turns {
            let n = path.known();
            let slope = polynomial::derivative(&path.scaled(step.whole)[..n]);
            PolynomialRoots::new(&slope[..n - 1]).each_sign_change(&mut |s| {
                let t = s * step.whole;
                if t >= from && t <= to {
                    let x = step.x_at(path, t);
                    self.low = self.low.smaller(x);
                    self.high = self.high.larger(x);
                }
                true
            });
        }
    }

    /// Records the energy dissipated in a compliant stop, and its largest force, over a recorded step of
    /// contact.
    pub fn contact<P: InStop<T>>(&mut self, path: &P, step: &StepData<T>) {
        if self.ledger {
            let rule = self.rule_of(path);
            let whole = path.loss(rule, T::zero(), step.length);
            self.whole.impact.add(whole);
            match self.overlap(&step.at, step.duration) {
                Some((from, to)) if from == T::zero() && to == step.duration => {
                    self.settled.impact.add(whole)
                }
                Some((from, to)) => {
                    let parameter = |time: T| path.parameter(time, step.length);
                    self.settled.impact.add(path.loss(rule, parameter(from), parameter(to)));
                }
                None => {}
            }
        }
        let until = if step.whole > T::zero() { step.length / step.whole } else { T::zero() };
        self.peak_contact = path.peak(step.whole, until, self.peak_contact);
    }

    /// The electrical state of a sample in A or V.
    pub(crate) fn electrical(&self, state: T) -> f64 {
        self.model.circuit().map_or(0.0, |circuit| circuit.amount * state.to_f64() / self.unit)
    }

    /// Records the state of the circuit, a polynomial in time, over a step of this length.
    #[inline(always)]
    fn circuit(&mut self, state: &[T], length: T, rule: &GaussLegendre<T>, overlap: Option<(T, T)>) {
        if self.ledger {
            self.whole.circuit.add(polynomial::squared(state, rule, T::zero(), length));
        }
        if let Some((from, to)) = overlap {
            self.settled.circuit.add(polynomial::squared(state, rule, from, to));
        }
    }

    /// Records the circuit's state, which begins at `state`, while the mass stands still. The samples from
    /// index `first` on belong to that time.
    pub(crate) fn circuit_decays(
        &mut self,
        circuit: &Circuit<T>,
        (at, until): (&Instant<T>, &Instant<T>),
        state: T,
        first: usize,
    ) {
        let length = self.clock.between(at, until);
        let rate = circuit.decay + circuit.decay;
        let squared = |from: T, to: T| {
            let begin = state * decay(circuit.decay * from).0;
            begin * begin * (to - from) * decay(rate * (to - from)).1
        };
        if self.ledger {
            self.whole.circuit.add(squared(T::zero(), length));
        }
        if let Some((from, to)) = self.overlap(at, length) {
            self.settled.circuit.add(squared(from, to));
        }
        for i in first..self.samples.len() {
            let into = self.clock.between(at, &self.clock.at(self.samples[i].t)).larger(T::zero());
            self.samples[i].electrical = self.electrical(state * decay(circuit.decay * into).0);
        }
        let amount = self.electrical(T::of(1.0));
        for listing in self.listings.each() {
            listing.charge(&self.clock, at, |instant| {
                let into = self.clock.between(at, instant).larger(T::zero());
                amount * (state * decay(circuit.decay * into).0).to_f64()
            });
        }
    }
}

/// The time at which the mass turns, in a step of length `h` in which it turns once. A batch does the same
/// arithmetic (`lanes/columns/landing.rs`).
fn turning_point<T: Scalar>(y: &[T], h: T, chord: &Chord<T>) -> Option<T> {
    let velocity = polynomial::scaled_slope(y, h);
    let pair = |value: T, slope: T| (value.to_f64(), slope.to_f64());
    let (slopes, curvatures) = (chord.slopes, chord.curvatures);
    let guess = single_root::guess(pair(slopes.0, curvatures.0), pair(slopes.1, curvatures.1));
    Some(single_root::single_root(&velocity[..y.len() - 1], T::of(guess))? * h)
}
