//! A sum of any number of tones, chirps and records.

use super::chirp::{Chirp, ChirpState, next_chirp};
use super::lines::{Lines, LinesCursor};
use super::record::{Record, RecordSeries};
use super::release::Search;
use super::tone::Tone;
use super::{ContactAcceleration, Drive, ReleaseRoot, Span};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::series::{ROOM, SEEDED, Tail};
use crate::numeric::Scalar;

/// Up to so many tones the check of a step evaluates each anew; more of them cannot cancel in the series by
/// chance. More steady ones than that are advanced side by side.
pub(super) const FEW_TONES: usize = 8;

/// A constant and any number of tones, chirps and records.
#[derive(Debug, Clone)]
pub(crate) struct Composite<T> {
    pub constant: T,
    pub tones: Vec<Tone<T>>,
    /// Further tones, many.
    pub lines: Lines<T>,
    pub chirps: Vec<Chirp<T>>,
    pub records: Vec<Record<T>>,
    /// Ends of ramps and chirps and the samples of records, ascending.
    pub segment_ends: Vec<Instant<T>>,
    /// Cycles of the clock after which, from the last segment's start on, all parts are where they were; none
    /// where they never are within the run, or it is not known.
    pub common_cycles: Option<i64>,
    /// No acceleration but the constant passes this.
    pub reach: T,
    /// Angular frequency of the fastest part that moves, kernel units; 0 without one.
    pub fastest: T,
}

/// What continues the series of a composite drive.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<T> {
    /// For each tone the last two coefficients of its sine, its amplitude and growth.
    tones: Vec<[T; 4]>,
    lines: LinesCursor<T>,
    chirps: Vec<ChirpState<T>>,
    records: RecordSeries<T>,
}

impl<T: Scalar> Default for Cursor<T> {
    fn default() -> Self {
        let (tones, chirps) = (Vec::new(), Vec::new());
        Self { tones, lines: LinesCursor::default(), chirps, records: RecordSeries::default() }
    }
}

impl<T: Scalar> Tail<T> for Composite<T> {
    type Cursor = Cursor<T>;

    fn extend(&self, k: usize, a: &mut [T; ROOM], inverse: &[T; ROOM], cursor: &mut Self::Cursor) {
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

impl<T: Scalar> Drive<T> for Composite<T> {
    fn seed(
        &self,
        clock: &Clock<T>,
        at: &Instant<T>,
        segment: usize,
        a: &mut [T; ROOM],
        cursor: &mut Self::Cursor,
    ) {
        // Clearing keeps the room: nothing is allocated after the first call.
        cursor.tones.clear();
        cursor.chirps.clear();
        let mut sums = [self.constant, T::zero(), T::zero(), T::zero()];
        for tone in &self.tones {
            let (s, d) = tone.unit(at);
            let w = tone.curvature();
            let unit = [s, d, w * s * T::of(0.5), w * d / T::of(6.0)];
            let (amplitude, growth) = tone.amplitude_at(clock, at, segment);
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
            let (s, c, rate, growth) = chirp.state(clock, at, segment);
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
            self.records.iter().for_each(|own| own.seed(at, segment, &mut cursor.records));
            sums.iter_mut().zip(&cursor.records.a).for_each(|(sum, own)| *sum += *own);
        }
        a[..SEEDED].copy_from_slice(&sums);
    }

    fn common_cycles(&self) -> i64 {
        self.common_cycles.unwrap_or(1)
    }

    /// As the first coefficient, in the same order of sums, but for records, which are told as they are.
    fn acceleration(&self, clock: &Clock<T>, at: &Instant<T>, segment: usize) -> T {
        let tones = self.tones.iter().map(|tone| tone.amplitude_at(clock, at, segment).0 * tone.unit(at).0);
        let chirps = self.chirps.iter().map(|chirp| chirp.amplitude * chirp.state(clock, at, segment).0);
        let tones = tones.fold(self.constant, |sum, a| sum + a) + self.lines.value(at);
        let records = self.records.iter().map(|own| own.exact(at, segment));
        chirps.fold(tones, |sum, a| sum + a) + records.fold(T::zero(), |sum, a| sum + a)
    }

    fn cost(&self, order: usize) -> u64 {
        let (tones, chirps) = (self.tones.len() as u64, self.chirps.len() as u64);
        let order = order as u64;
        let lines = self.lines.count() as u64;
        tones * (15 + order) / 5
            + lines * (15 + order) / 20
            + chirps * (120 + order) / 4
            + 20 * self.records.len() as u64
    }

    fn value(
        &self,
        clock: &Clock<T>,
        at: &Instant<T>,
        segment: usize,
        by_series: impl Fn() -> T,
        _: &mut Self::Cursor,
    ) -> T {
        if self.lines.count() > 0 || self.tones.len() > FEW_TONES || !self.chirps.is_empty() {
            return by_series();
        }
        let tones = self.tones.iter().map(|tone| tone.amplitude_at(clock, at, segment).0 * tone.unit(at).0);
        let records = self.records.iter().map(|own| own.value(at, segment));
        tones.fold(self.constant + records.fold(T::zero(), |sum, a| sum + a), |sum, a| sum + a)
    }

    fn segment_end(&self, segment: usize) -> Option<Instant<T>> {
        self.segment_ends.get(segment).copied()
    }

    fn next_release(
        &self,
        clock: &Clock<T>,
        span: &Span<T>,
        acceleration: ContactAcceleration<T>,
        cursor: &mut Self::Cursor,
    ) -> (ReleaseRoot<T>, u64) {
        if acceleration.threshold - acceleration.sign * self.constant > self.reach {
            return (ReleaseRoot::Never, 0);
        }
        self.search(clock, acceleration, span.segment).first(span, cursor)
    }
}

impl<T: Scalar> Composite<T> {
    /// A search for a release in one of its segments.
    pub(super) fn search<'a>(
        &'a self,
        clock: &'a Clock<T>,
        acceleration: ContactAcceleration<T>,
        segment: usize,
    ) -> Search<'a, T, Self> {
        let mut search = Search::new(self, clock, acceleration, segment);
        (search.fastest, search.reach) = (self.fastest, self.reach);
        search.common_cycles = self.common_cycles.filter(|_| segment >= self.segment_ends.len());
        search.parts = self.tones.len() + self.lines.count() / 8 + 4 * self.chirps.len() + self.records.len();
        search
    }
}
