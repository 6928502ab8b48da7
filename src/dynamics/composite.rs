//! What do several tones, chirps and records do together?

use super::clock::{Clock, Instant};
use super::drive::{Drive, Fall, Press, Span, Tail};
use super::series::{ROOM, SEEDED};
use super::tone::Tone;
use crate::numeric::{DoubleDouble, Number, PolynomialRoots, Scalar};

/// How long a search for a release looks ahead at a time, in radians of the fastest tone, and the order of
/// its series: the first neglected term, 2^27/27!, is below rounding.
const SEARCH_RADIANS: f64 = 2.0;
const SEARCH_ORDER: usize = 26;

/// Work of a search before it reports where it stands: some milliseconds, and for two or three tones of everyday
/// frequencies longer than their common period.
const SEARCH_WORK: u64 = 500_000;

/// What a stride of a search costs beside its parts, and what they do, in units of [`work`](super::work).
const STRIDE_WORK: u64 = 80;
const STRIDE_WORK_OF_A_PART: u64 = 8;

/// Two searches that differ by no more than this share of a quarter cycle have found the same root.
const SAME_ROOT: f64 = 1e-12;

/// Up to so many tones the check of a step evaluates each anew; more of them cannot cancel in the series by
/// chance.
const FEW_TONES: usize = 8;

/// A sine whose frequency grows evenly up to an instant and then holds.
#[derive(Debug, Clone)]
pub(crate) struct Chirp<T> {
    pub amplitude: T,
    /// Frequencies at time 0 and from the end on in Hz, and the length in s.
    pub from: f64,
    pub to: f64,
    pub over: f64,
    /// The segment of the drive that begins where the chirp ends.
    pub holds_from_segment: usize,
}

impl<T: Scalar> Chirp<T> {
    /// (sin, cos) at an instant, angular frequency there and its growth, in kernel units. The phase is formed
    /// in twice the digits and only its fraction of a turn rounded.
    fn state(&self, clock: &Clock<T>, at: &Instant<T>, segment: usize) -> (T, T, T, T) {
        let dd = DoubleDouble::of;
        let time = clock.exact_seconds(at);
        let growth = (dd(self.to) - dd(self.from)) / dd(self.over);
        let holding = segment >= self.holds_from_segment;
        let (turns, frequency, growth) = if holding {
            let before = (dd(self.from) + dd(self.to)) * dd(self.over) * dd(0.5);
            (before + (time - dd(self.over)) * dd(self.to), dd(self.to), dd(0.0))
        } else {
            let frequency = dd(self.from) + growth * time;
            (time * (dd(self.from) + growth * time * dd(0.5)), frequency, growth)
        };
        let (s, c) = T::sin_cos_turns(T::of_pair(turns - turns.floor()));
        let unit = clock.unit();
        let omega = T::tau() * T::of_pair(frequency * dd(unit));
        (s, c, omega, T::tau() * T::of_pair(growth * dd(unit * unit)))
    }
}

/// The next coefficients of sine and cosine of a phase with rate w and growth b, from the last two of each:
/// (k + 1) s\[k+1\] = w c\[k\] + b c\[k-1\], and the cosine likewise with the sign turned.
fn next_chirp<T: Scalar>(last: &mut ChirpState<T>, share: T) {
    let ChirpState { sine, cosine, rate, growth, .. } = *last;
    let s = (rate * cosine[1] + growth * cosine[0]) * share;
    let c = -((rate * sine[1] + growth * sine[0]) * share);
    last.sine = [sine[1], s];
    last.cosine = [cosine[1], c];
}

/// The last two coefficients of a chirp's sine and cosine, and what continues them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChirpState<T> {
    sine: [T; 2],
    cosine: [T; 2],
    rate: T,
    growth: T,
    amplitude: T,
}

/// Straight lines between samples; zero before the first and after the last.
#[derive(Debug, Clone)]
pub(crate) struct Line<T> {
    /// The segment of the drive in which this line begins, ascending.
    pub first_segment: usize,
    /// When it begins.
    pub at: Instant<T>,
    /// Its value there and its slope, kernel units.
    pub value: T,
    pub slope: T,
}

/// A constant and any number of tones, chirps and records.
#[derive(Debug, Clone)]
pub(crate) struct Composite<T> {
    pub constant: T,
    pub tones: Vec<Tone<T>>,
    pub chirps: Vec<Chirp<T>>,
    /// For each record its lines; the last one is zero.
    pub records: Vec<Vec<Line<T>>>,
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
pub(crate) struct Rolling<T> {
    /// For each tone the last two coefficients of its sine, its amplitude and growth.
    tones: Vec<[T; 4]>,
    chirps: Vec<ChirpState<T>>,
}

impl<T> Default for Rolling<T> {
    fn default() -> Self {
        Self { tones: Vec::new(), chirps: Vec::new() }
    }
}

/// The search order's coefficients of a press, and where they are about.
struct Look<T> {
    g: [T; SEARCH_ORDER + 1],
    order: usize,
}

/// What a search carries along.
struct Search<T> {
    a: [T; ROOM],
    inverse: [T; ROOM],
    segment: usize,
    press: Press<T>,
}

impl<T: Scalar> Composite<T> {
    /// The press over a stride of length `h` from `at`, as a polynomial in the share of it.
    fn look(
        &self,
        clock: &Clock<T>,
        at: &Instant<T>,
        h: T,
        search: &mut Search<T>,
        roll: &mut Rolling<T>,
    ) -> Look<T> {
        let Search { a, inverse, segment, press: Press { threshold, sign } } = search;
        self.seed(clock, at, *segment, a, roll);
        let order = if self.fastest > T::zero() { SEARCH_ORDER } else { 1 };
        for k in SEEDED..=order {
            self.extend(k, a, inverse, roll);
        }
        let mut g = [T::zero(); SEARCH_ORDER + 1];
        let mut power = T::of(1.0);
        for (k, slot) in g[..=order].iter_mut().enumerate() {
            *slot = -(*sign * a[k]) * power;
            power = power * h;
        }
        g[0] += *threshold;
        Look { g, order }
    }

    /// The root near `fall`, computed from the drive alone, and the clock's cycle within the common period: whenever the
    /// search that found it began, it is the same number. None where the drive does not repeat, or by more than rounding.
    fn own_root(
        &self,
        clock: &Clock<T>,
        fall: &Instant<T>,
        search: &mut Search<T>,
        roll: &mut Rolling<T>,
    ) -> Option<(Instant<T>, i64)> {
        let cycles = self.common_cycles.filter(|_| search.segment >= self.segment_ends.len())?;
        if !(self.fastest > T::zero()) {
            return None;
        }
        // Strides that do not depend on the search: quarters of the cycle, in each cycle alike.
        let stride = clock.period() * T::of(0.25);
        let quarter = (fall.phase / stride).floor().smaller(T::of(3.0));
        let start = Instant { cycle: fall.cycle, phase: quarter * stride };
        let look = self.look(clock, &start, stride, search, roll);
        let near = clock.between(&start, fall) / stride;
        let mut found = None;
        PolynomialRoots::new(&look.g[..=look.order]).each_sign_change(|s| {
            if (s - near).abs() <= T::of(SAME_ROOT) {
                found = Some(s);
            }
            found.is_none()
        });
        let own = clock.advance(&start, found? * stride);
        Some((own, own.cycle.rem_euclid(cycles)))
    }

    /// The sum of the records and its slope.
    fn record(&self, clock: &Clock<T>, at: &Instant<T>, segment: usize) -> (T, T) {
        let mut sum = (T::zero(), T::zero());
        for record in &self.records {
            let line = record.partition_point(|line| line.first_segment <= segment);
            if let Some(line) = line.checked_sub(1).map(|i| &record[i]) {
                sum.0 += line.value + line.slope * clock.between(&line.at, at);
                sum.1 += line.slope;
            }
        }
        sum
    }
}

impl<T: Scalar> Tail<T> for Composite<T> {
    type Rolling = Rolling<T>;

    fn extend(&self, k: usize, a: &mut [T; ROOM], inverse: &[T; ROOM], roll: &mut Self::Rolling) {
        let mut sum = T::zero();
        for (tone, [before, last, amplitude, growth]) in self.tones.iter().zip(&mut roll.tones) {
            let next = tone.curvature() * *before * inverse[k];
            sum += *amplitude * next + *growth * *last;
            (*before, *last) = (*last, next);
        }
        if !roll.chirps.is_empty() {
            let share = inverse[k] * T::of((k - 1) as f64); // 1/k
            for state in &mut roll.chirps {
                next_chirp(state, share);
                sum += state.amplitude * state.sine[1];
            }
        }
        a[k] = sum;
    }
}

impl<T: Scalar> Drive<T> for Composite<T> {
    fn seed(
        &self,
        clock: &Clock<T>,
        at: &Instant<T>,
        segment: usize,
        a: &mut [T; ROOM],
        roll: &mut Self::Rolling,
    ) {
        // Clearing keeps the room: nothing is allocated after the first call.
        roll.tones.clear();
        roll.chirps.clear();
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
            roll.tones.push([unit[2], unit[3], amplitude, growth]);
        }
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
            roll.chirps.push(state);
        }
        let (value, slope) = self.record(clock, at, segment);
        sums[0] += value;
        sums[1] += slope;
        a[..SEEDED].copy_from_slice(&sums);
    }

    fn common_cycles(&self) -> i64 {
        self.common_cycles.unwrap_or(1)
    }

    /// As the first coefficient, in the same order of sums.
    fn acceleration(&self, clock: &Clock<T>, at: &Instant<T>, segment: usize) -> T {
        let tones = self.tones.iter().map(|tone| tone.amplitude_at(clock, at, segment).0 * tone.unit(at).0);
        let chirps = self.chirps.iter().map(|chirp| chirp.amplitude * chirp.state(clock, at, segment).0);
        tones.chain(chirps).fold(self.constant, |sum, a| sum + a) + self.record(clock, at, segment).0
    }

    fn cost(&self, order: usize) -> u64 {
        let (tones, chirps) = (self.tones.len() as u64, self.chirps.len() as u64);
        let order = order as u64;
        tones * (15 + order) / 5 + chirps * (120 + order) / 4 + 20 * self.records.len() as u64
    }

    fn value(
        &self,
        clock: &Clock<T>,
        at: &Instant<T>,
        segment: usize,
        by_series: impl Fn() -> T,
        _: &mut Self::Rolling,
    ) -> T {
        if self.tones.len() > FEW_TONES || !self.chirps.is_empty() {
            return by_series();
        }
        let tones = self.tones.iter().map(|tone| tone.amplitude_at(clock, at, segment).0 * tone.unit(at).0);
        tones.fold(self.constant + self.record(clock, at, segment).0, |sum, a| sum + a)
    }

    fn segment_end(&self, segment: usize) -> Option<Instant<T>> {
        self.segment_ends.get(segment).copied()
    }

    fn next_fall(
        &self,
        clock: &Clock<T>,
        &Span { from, until, segment, since }: &Span<T>,
        Press { threshold, sign }: Press<T>,
        roll: &mut Self::Rolling,
    ) -> (Fall<T>, u64) {
        if threshold - sign * self.constant > self.reach {
            return (Fall::Never, 0);
        }
        let parts = self.tones.len() + 4 * self.chirps.len() + self.records.len();
        let stride_work = STRIDE_WORK + STRIDE_WORK_OF_A_PART * parts as u64;
        let mut work = 0;
        let turning = self.fastest > T::zero();
        let stride = T::of(SEARCH_RADIANS) / self.fastest;
        let last_segment = segment >= self.segment_ends.len();
        let mut at = from;
        let zeros = [T::zero(); ROOM];
        let mut search = Search { a: zeros, inverse: zeros, segment, press: Press { threshold, sign } };
        for (k, slot) in search.inverse.iter_mut().enumerate().skip(2) {
            *slot = T::of(1.0) / T::of((k * (k - 1)) as f64);
        }
        while work < SEARCH_WORK {
            work += stride_work;
            let left = clock.between(&at, &until);
            if left <= T::zero() {
                return (Fall::Never, work);
            }
            let h = if turning { stride.smaller(left) } else { left };
            let Look { g, order } = self.look(clock, &at, h, &mut search, roll);
            // Below 0 by no more than rounding it only touches: the way to the bottom of a parabola.
            let rounding = (threshold.abs() + self.reach) * T::of(8.0 * T::EPSILON);
            let touches = |slope: T, curvature: T| {
                curvature > T::zero() && slope * slope <= T::of(2.0) * curvature * rounding
            };
            let across = |curvature: T| T::of(4.0) * (rounding / curvature).sqrt();
            let press = PolynomialRoots::new(&g[..=order]);
            let (s, slope, curvature) = if g[0] > T::zero() {
                let Some(s) = press.first() else {
                    at = clock.advance(&at, h);
                    if let (true, Some(cycles)) = (last_segment, self.common_cycles)
                        && at.cycle > since.cycle + cycles
                    {
                        return (Fall::Never, work); // one common period without a fall: there is none
                    }
                    continue;
                };
                let (_, slope, curvature) = press.value_and_slopes(s);
                (s, slope, curvature)
            } else {
                (T::zero(), g[1], T::of(2.0) * g[2.min(order)])
            };
            if touches(slope, curvature) {
                at = clock.advance(&at, (s + across(curvature)) * h);
            } else if s == T::zero() && slope > T::zero() {
                // rounding: it rises, the fall comes later
                at = clock.advance(&at, T::of(2.0) * rounding / slope * h);
            } else {
                let fall = clock.advance(&at, s * h);
                let own = self.own_root(clock, &fall, &mut search, roll);
                let own = own.filter(|(own, _)| clock.between(&from, own) > T::zero());
                let (fall, turn) = own.map_or((fall, None), |(own, turn)| (own, Some(turn)));
                return (Fall::within(clock, fall, turn, &until), work);
            }
        }
        (Fall::NotBefore(at), work)
    }
}
