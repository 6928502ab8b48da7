//! General drive: a constant and any number of tones, chirps and records, and the circuit of a transducer
//! with an electrical state. In double-double arithmetic every drive is of this type, so that only one is
//! compiled.

use super::lines::{Lines, LinesCursor};
use super::record::{Record, RecordSeries};
use super::release::{Decaying, Search};
use super::tone::{Chirp, ChirpState, LastValue, Sine, Tone, next_chirp};
use super::{Base, Circuit, ContactAcceleration, Drive, ReleaseRoot, Span};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::series::{ROOM, SEEDED, Series, Tail};
use crate::numeric::{Scalar, elementary};

/// Maximum number of tones that the check of a step evaluates one by one. The series of more tones cannot
/// cancel by chance. More steady tones than this are advanced side by side.
pub(super) const FEW_TONES: usize = 8;

#[derive(Debug, Clone, Default)]
pub(crate) struct General<T> {
    pub clock: Clock<T>,
    /// The sine, if the drive is a sine alone; the other parts are then not evaluated.
    pub sine: Option<Sine<T>>,
    pub constant: T,
    pub tones: Vec<Tone<T>>,
    /// Steady tones, if there are many.
    pub lines: Lines<T>,
    pub chirps: Vec<Chirp<T>>,
    pub records: Vec<Record<T>>,
    pub circuit: Option<Circuit<T>>,
    /// Whether the drive is the constant alone.
    pub only_constant: bool,
    /// Ends of ramps and chirps and the samples of records, ascending.
    pub segment_ends: Vec<Instant<T>>,
    /// Cycles of the clock after which all parts repeat, from the start of the last segment on. `None` if
    /// they do not repeat within the run, or if it is not known whether they do.
    pub common_cycles: Option<i64>,
    /// Bound of the magnitude of the acceleration, without the constant.
    pub reach: T,
    /// Angular frequency of the fastest part that moves, kernel units; 0 without one.
    pub fastest: T,
}

/// The state by which the series of a drive and of a circuit are continued.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<T> {
    sine: LastValue<T>,
    /// For each tone the last two coefficients of its sine, its amplitude and growth.
    tones: Vec<[T; 4]>,
    lines: LinesCursor<T>,
    chirps: Vec<ChirpState<T>>,
    records: RecordSeries<T>,
    /// Coefficients of the circuit's state: one less than the displacement has.
    state: [T; ROOM],
}

impl<T: Scalar> Default for Cursor<T> {
    fn default() -> Self {
        Self {
            sine: None,
            tones: Vec::new(),
            lines: LinesCursor::default(),
            chirps: Vec::new(),
            records: RecordSeries::default(),
            state: [T::zero(); ROOM],
        }
    }
}

impl<T: Scalar> Tail<T> for General<T> {
    type Cursor = Cursor<T>;

    #[inline(always)]
    fn zero_from(&self) -> Option<usize> {
        self.only_constant.then_some(1)
    }

    #[inline(always)]
    fn couple(&self, k: usize, y: &[T; ROOM], cursor: &mut Self::Cursor) -> Option<T> {
        let Circuit { coupling, rates, .. } = self.circuit.as_ref()?;
        let w = &mut cursor.state;
        w[k + 1] = *coupling * y[k + 1] - rates[k + 1] * w[k];
        Some(*coupling * w[k])
    }

    fn extend(&self, k: usize, a: &mut [T; ROOM], inverse: &[T; ROOM], cursor: &mut Self::Cursor) {
        if let Some(sine) = &self.sine {
            return sine.extend(k, a, inverse, &mut cursor.sine);
        }
        let mut sum = self.lines.next(k, inverse, &mut cursor.lines);
        for (tone, [before, last, amplitude, growth]) in self.tones.iter().zip(&mut cursor.tones) {
            let next = tone.curvature() * *before * inverse[k];
            sum += *amplitude * next + *growth * *last;
            (*before, *last) = (*last, next);
        }
        if !cursor.chirps.is_empty() {
            let share = inverse[k] * T::of((k - 1) as f64); // 1/k
            for state in &mut cursor.chirps {
                next_chirp(state, share);
                sum += state.amplitude * state.sine[1];
            }
        }
        a[k] = if k < cursor.records.known { sum + cursor.records.a[k] } else { sum };
    }
}

impl<T: Scalar> Base<T> for General<T> {
    /// Equal to the first coefficient, summed in the same order, except that records are evaluated by their
    /// lines.
    fn acceleration(&self, at: &Instant<T>, segment: usize) -> T {
        if let Some(sine) = &self.sine {
            return sine.acceleration(at, segment);
        }
        let tones =
            self.tones.iter().map(|tone| tone.amplitude_at(&self.clock, at, segment).0 * tone.unit(at).0);
        let chirps =
            self.chirps.iter().map(|chirp| chirp.amplitude * chirp.state(&self.clock, at, segment).0);
        let tones = tones.fold(self.constant, |sum, a| sum + a) + self.lines.value(at);
        let records = self.records.iter().map(|record| record.exact(at, segment));
        chirps.fold(tones, |sum, a| sum + a) + records.fold(T::zero(), |sum, a| sum + a)
    }
}

impl<T: Scalar> Drive<T> for General<T> {
    fn is_odd(&self) -> bool {
        self.sine.is_some()
    }

    fn circuit(&self) -> Option<&Circuit<T>> {
        self.circuit.as_ref()
    }

    fn circuit_state<'a>(&self, cursor: &'a Self::Cursor) -> Option<&'a [T; ROOM]> {
        self.circuit.as_ref().map(|_| &cursor.state)
    }

    fn begin_circuit(cursor: &mut Self::Cursor, state: T) {
        cursor.state[0] = state;
    }

    fn second_derivative_bound(&self) -> Option<T> {
        self.sine.as_ref().and_then(Sine::second_derivative_bound)
    }

    fn common_cycles(&self) -> i64 {
        self.common_cycles.unwrap_or(1)
    }

    fn seed(&self, at: &Instant<T>, segment: usize, a: &mut [T; ROOM], cursor: &mut Self::Cursor) {
        if let Some(sine) = &self.sine {
            return sine.seed(at, segment, a, &mut cursor.sine);
        }
        // Clearing keeps the capacity: nothing is allocated after the first call.
        cursor.tones.clear();
        cursor.chirps.clear();
        let mut sums = [self.constant, T::zero(), T::zero(), T::zero()];
        for tone in &self.tones {
            let (s, d) = tone.unit(at);
            let w = tone.curvature();
            let unit = [s, d, w * s * T::of(0.5), w * d / T::of(6.0)];
            let (amplitude, growth) = tone.amplitude_at(&self.clock, at, segment);
            for (k, sum) in sums.iter_mut().enumerate() {
                *sum += amplitude * unit[k];
                if k > 0 {
                    *sum += growth * unit[k - 1];
                }
            }
            cursor.tones.push([unit[2], unit[3], amplitude, growth]);
        }
        self.lines.seed(at, &mut sums, &mut cursor.lines);
        for chirp in &self.chirps {
            let (s, c, rate, growth) = chirp.state(&self.clock, at, segment);
            let zero = T::zero();
            let amplitude = chirp.amplitude;
            let mut state = ChirpState { sine: [zero, s], cosine: [zero, c], rate, growth, amplitude };
            sums[0] += amplitude * s;
            for (k, sum) in sums.iter_mut().enumerate().skip(1) {
                next_chirp(&mut state, T::of(1.0) / T::of(k as f64));
                *sum += amplitude * state.sine[1];
            }
            cursor.chirps.push(state);
        }
        if !self.records.is_empty() {
            cursor.records = RecordSeries::default();
            self.records.iter().for_each(|record| record.seed(at, segment, &mut cursor.records));
            sums.iter_mut().zip(&cursor.records.a).for_each(|(sum, a)| *sum += *a);
        }
        a[..SEEDED].copy_from_slice(&sums);
    }

    fn cost(&self, order: usize) -> u64 {
        if self.sine.is_some() {
            return 0;
        }
        let (tones, chirps) = (self.tones.len() as u64, self.chirps.len() as u64);
        let order = order as u64;
        let lines = self.lines.count() as u64;
        let circuit = if self.circuit.is_some() { order } else { 0 };
        tones * (15 + order) / 5
            + lines * (15 + order) / 20
            + chirps * (120 + order) / 4
            + 20 * self.records.len() as u64
            + circuit
    }

    fn value(
        &self,
        at: &Instant<T>,
        segment: usize,
        by_series: impl Fn() -> T,
        cursor: &mut Self::Cursor,
    ) -> T {
        if let Some(sine) = &self.sine {
            return sine.value(at, segment, by_series, &mut cursor.sine);
        }
        if self.lines.count() > 0 || self.tones.len() > FEW_TONES || !self.chirps.is_empty() {
            return by_series();
        }
        let tones =
            self.tones.iter().map(|tone| tone.amplitude_at(&self.clock, at, segment).0 * tone.unit(at).0);
        let records = self.records.iter().map(|record| record.value(at, segment));
        tones.fold(self.constant + records.fold(T::zero(), |sum, a| sum + a), |sum, a| sum + a)
    }

    fn segment_end(&self, segment: usize) -> Option<Instant<T>> {
        self.segment_ends.get(segment).copied()
    }

    /// The push of the circuit on a mass at rest decays. Until it is negligible, the strides are short enough
    /// for its decay too, so no root is missed; after that the search continues without it. A push that does
    /// not decay is part of the threshold.
    fn next_release(
        &self,
        span: &Span<T>,
        acceleration: ContactAcceleration<T>,
        cursor: &mut Self::Cursor,
    ) -> (ReleaseRoot<T>, u64) {
        if let Some(sine) = &self.sine {
            return sine.next_release(span, acceleration, &mut cursor.sine);
        }
        let Some(Circuit { coupling, decay: rate, .. }) = &self.circuit else {
            return self.next_release_without_push(span, acceleration, cursor);
        };
        let ContactAcceleration { threshold, sign, circuit } = acceleration;
        let (push, rate) = (*coupling * circuit, *rate);
        // A search with the push does not count for one without it.
        let span = Span { since: span.from, ..*span };
        let without = |threshold: T| ContactAcceleration { threshold, sign, circuit: T::zero() };
        if rate == T::zero() {
            let pressed = without(threshold - sign * push);
            return self.next_release_without_push(&span, pressed, cursor);
        }
        let level = threshold.abs() + self.reach + self.constant.abs();
        let negligible = level * T::of(T::EPSILON / 16.0);
        if !(push.abs() > negligible) {
            return self.next_release_without_push(&span, without(threshold), cursor);
        }
        if level == T::zero() {
            return (ReleaseRoot::Never, 0); // the push keeps its sign
        }
        // slightly longer, so that the push is negligible at the end
        let lasts = T::of(elementary::ln((push.abs() / negligible).to_f64()) + 1.0) / rate;
        let fades = lasts < self.clock.between(&span.from, &span.until);
        let until = if fades { self.clock.advance(&span.from, lasts) } else { span.until };
        let mut search = self.search(without(threshold), span.segment);
        search.decaying = Some(Decaying { push, rate, since: span.from });
        search.fastest = search.fastest.larger(rate);
        search.reach += push.abs();
        search.common_cycles = None;
        match search.first(&Span { until, ..span }, cursor) {
            (ReleaseRoot::Never, work) if fades => (ReleaseRoot::NotBefore(until), work),
            found => found,
        }
    }
}

impl<T: Scalar> General<T> {
    fn next_release_without_push(
        &self,
        span: &Span<T>,
        acceleration: ContactAcceleration<T>,
        cursor: &mut Cursor<T>,
    ) -> (ReleaseRoot<T>, u64) {
        if self.only_constant || acceleration.threshold - acceleration.sign * self.constant > self.reach {
            return (ReleaseRoot::Never, 0);
        }
        self.search(acceleration, span.segment).first(span, cursor)
    }

    fn search(&self, acceleration: ContactAcceleration<T>, segment: usize) -> Search<'_, T, Self> {
        Search {
            drive: self,
            clock: &self.clock,
            acceleration,
            segment,
            fastest: self.fastest,
            reach: self.reach,
            common_cycles: self.common_cycles.filter(|_| segment >= self.segment_ends.len()),
            parts: self.tones.len() + self.lines.count() / 8 + 4 * self.chirps.len() + self.records.len(),
            decaying: None,
            series: Series::new(0),
        }
    }
}
