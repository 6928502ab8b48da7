//! Repetition of a motion, by its stroboscopic states and by its crossings, updated as they arrive.
//!
//! Only the last twelve forcing periods and some states at the start and the middle of the window are kept,
//! so a window may have any length.

use std::collections::VecDeque;

use super::decay::{DECAYED, Decay};
use crate::dynamics::result::Side;

/// Maximum number of forcing periods after which a motion may repeat and still count as periodic.
pub(crate) const LONGEST: usize = 12;

/// Two crossings repeat if their times within the period agree to this share of a forcing period: well above
/// the rest of a transient after half a run, well below the scatter of irregular motion.
const CROSSING_MATCH: f64 = 1e-2;

/// Two stroboscopic states repeat if they agree to this share of the scene's scales: fine enough to see a
/// period doubling soon after its onset, coarse enough for a transient that has decayed to a thousandth.
pub(crate) const STATE_MATCH: f64 = 1e-3;

/// Largest change over half a window, as a share of the scales, of a motion that stands still: well above
/// rounding and the errors of the usual tolerances, and a hundredth of [`STATE_MATCH`].
const MAX_STILL_CHANGE: f64 = 1e-5;

/// The state at a whole number of forcing periods after the window's start. SI.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Strobe {
    pub x: f64,
    pub v: f64,
}

impl Strobe {
    fn is_near(&self, other: &Self, (length, speed): (f64, f64)) -> bool {
        (self.x - other.x).abs() <= STATE_MATCH * length && (self.v - other.v).abs() <= STATE_MATCH * speed
    }

    /// The largest change to `later`, as a share of the scales.
    fn size_of_change(&self, later: &Self, scales: (f64, f64)) -> f64 {
        let (length, speed) = self.change(later, scales);
        length.abs().max(speed.abs())
    }

    /// The change to `later`, as shares of the scales.
    fn change(&self, later: &Self, (length, speed): (f64, f64)) -> (f64, f64) {
        ((later.x - self.x) / length, (later.v - self.v) / speed)
    }
}

/// The stroboscopic states of a run, numbered from 0.
#[derive(Debug, Clone)]
pub(crate) struct Strobes {
    /// Length and speed to which differences of states are relative.
    scales: (f64, f64),
    pub longest: usize,
    /// The number of states so far.
    pub seen: u64,
    /// The last states, each at its number modulo [`LONGEST`].
    recent: [Strobe; LONGEST],
    /// For each period up to [`LONGEST`], the number of the state from which on all states repeat with it.
    since: [u64; LONGEST],
    decays: [Decay; LONGEST],
    /// Forcing periods in the settled window.
    periods: u64,
    /// Number of the first state of the window.
    from: u64,
    opening: [Strobe; 2 * LONGEST],
    middle: [Strobe; 2 * LONGEST],
}

impl Strobes {
    /// For a settled window of `periods` that begins with the state number `from`. A period is only accepted
    /// if the window holds it twice.
    pub fn new(scales: (f64, f64), periods: u64, from: u64) -> Self {
        Self {
            scales,
            longest: LONGEST.min((periods / 2) as usize),
            seen: 0,
            recent: Default::default(),
            since: [0; LONGEST],
            decays: Default::default(),
            periods,
            from,
            opening: Default::default(),
            middle: Default::default(),
        }
    }

    /// The smallest period, in states, with which the last two periods and `more` states before them repeat.
    pub fn repeats_for(&self, more: u64) -> Option<u32> {
        (1..=self.longest as u64).find_map(|q| {
            let back = self.since[q as usize - 1] + q + 2 * q + more < self.seen;
            back.then_some(q as u32)
        })
    }

    /// Adds a state; those after the window are ignored.
    pub fn add(&mut self, state: Strobe) {
        if self.is_complete() {
            return;
        }
        let number = self.seen;
        let changes = self.since.iter_mut().zip(&mut self.decays);
        for (index, (since, decay)) in changes.enumerate().take(self.longest) {
            let Some(number_before) = number.checked_sub(index as u64 + 1) else { break };
            let before = &self.recent[number_before as usize % LONGEST];
            if !state.is_near(before, self.scales) {
                *since = number_before + 1;
                *decay = Decay::default();
                continue;
            }
            let size = before.size_of_change(&state, self.scales);
            decay.add(number, size);
        }
        self.recent[number as usize % LONGEST] = state;
        self.keep(number, state);
        self.seen += 1;
    }

    fn is_complete(&self) -> bool {
        self.seen > self.from + self.periods
    }

    /// Keeps the state of this number if it is near the start or the middle of the window.
    fn keep(&mut self, number: u64, state: Strobe) {
        let Some(inside) = number.checked_sub(self.from) else { return };
        if let Some(kept) = self.opening.get_mut(inside as usize) {
            *kept = state;
        }
        let around = inside.checked_sub(self.before_middle());
        if let Some(kept) = around.and_then(|place| self.middle.get_mut(place as usize)) {
            *kept = state;
        }
    }

    /// Forcing periods from the start of the window to the first state kept around its middle.
    fn before_middle(&self) -> u64 {
        self.periods.div_ceil(2).saturating_sub(LONGEST as u64 - 1)
    }

    /// Adds `more` states, a multiple of `lap`, of a motion that repeats exactly every `lap` states and has
    /// done so for four laps and for twice the number of states that are compared. `state` gives the states
    /// of a lap.
    pub fn skip(&mut self, more: u64, lap: u64, state: impl Fn(u64) -> Strobe) {
        if self.is_complete() {
            return;
        }
        let kept = |first: u64| first..first + 2 * LONGEST as u64;
        for number in kept(self.from).chain(kept(self.from + self.before_middle())) {
            if let Some(place) = number.checked_sub(self.seen).filter(|place| *place < more) {
                self.keep(number, state(place % lap));
            }
        }
        for since in &mut self.since {
            // a period that has not repeated recently will not start to repeat
            if *since + self.longest as u64 + lap >= self.seen {
                *since += more;
            }
        }
        self.recent.rotate_right((more % LONGEST as u64) as usize);
        self.seen += more;
    }

    /// The smallest period, in states, with which the whole window repeats without a drift, and the number of
    /// the state from which on the states repeat.
    pub fn period(&self) -> Option<(u32, u64)> {
        let back = |q: &u64| self.since[*q as usize - 1] <= self.from;
        let q =
            (1..=self.longest as u64).find(back).filter(|q| self.is_complete() && self.stands_still(*q))?;
        Some((q as u32, self.since[q as usize - 1]))
    }

    /// The period of a motion whose changes after `q` states have decayed so fast that its orbit attracts in
    /// every direction: `q` or a divisor. `volume` is the factor, as a logarithm to base 2, by which areas of
    /// states shrink in `q` periods at least.
    pub fn decayed_to(&self, q: u32, volume: f64) -> Option<u32> {
        let decay = &self.decays[q as usize - 1];
        decay.is_clear(q, self.seen, volume).then(|| self.shortest(q))
    }

    /// The shortest period after which the last state of a motion without a transient, which repeats after
    /// `q` states, comes back.
    pub fn shortest(&self, q: u32) -> u32 {
        let ends = |period: &u32| {
            let before = &self.recent[(self.seen - 1 - u64::from(*period)) as usize % LONGEST];
            q.is_multiple_of(*period) && before.size_of_change(&self.last(), self.scales) <= DECAYED
        };
        (1..q).find(ends).unwrap_or(q)
    }

    /// The last state.
    pub fn last(&self) -> Strobe {
        self.recent[(self.seen.max(1) - 1) as usize % LONGEST]
    }

    /// Whether a motion whose states repeat after `q` states does not drift. In a slow drift neighbouring
    /// states are equal too, so the last states of the window are compared with those about half a window and
    /// a whole window earlier.
    fn stands_still(&self, q: u64) -> bool {
        let apart = self.periods / (2 * q) * q;
        let whole = 2 * apart;
        apart > 0
            && (0..q.min(self.periods - whole + 1)).all(|back| {
                let end = self.periods - back;
                let first = &self.opening[(end - whole) as usize];
                let middle = &self.middle[(end - apart - self.before_middle()) as usize];
                let last = &self.recent[(self.from + end) as usize % LONGEST];
                self.has_converged([first, middle, last])
            })
    }

    /// Whether three states, equally spaced in time, agree with each other and with their limit. If the
    /// second change is `r` times the first one (projected on its direction), the later changes add up to r /
    /// (1 - r) times the second.
    fn has_converged(&self, [first, middle, last]: [&Strobe; 3]) -> bool {
        let near = |a: &Strobe, b: &Strobe| a.is_near(b, self.scales);
        if !(near(first, middle) && near(middle, last) && near(first, last)) {
            return false;
        }
        let product = |a: (f64, f64), b: (f64, f64)| a.0 * b.0 + a.1 * b.1;
        let (before, after) = (first.change(middle, self.scales), middle.change(last, self.scales));
        let [moved_before, moved] = [before, after].map(|change| product(change, change).sqrt());
        let ratio = product(before, after) / product(before, before);
        // growing changes lead away, even if they alternate in sign or follow a spiral
        let shrinks = moved <= moved_before + MAX_STILL_CHANGE;
        moved <= MAX_STILL_CHANGE || (shrinks && ratio < 1.0 && moved * ratio / (1.0 - ratio) <= STATE_MATCH)
    }

    /// Begins another settled window with the last state.
    pub fn open_window(&mut self) {
        self.from = self.seen.saturating_sub(1);
        self.keep(self.from, self.recent[self.from as usize % LONGEST]);
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Crossings {
    periods: f64,
    /// Crossings that may still get a partner: time in forcing periods since the window's start, and well
    /// entered.
    recent: VecDeque<(f64, Side)>,
    /// Number of crossings before the first of `recent`.
    dropped: u64,
    /// For each period, the number of the first crossing without a partner one period later yet; `None` if a
    /// partner was missing.
    waiting: [Option<u64>; LONGEST],
    paired: [bool; LONGEST],
}

impl Crossings {
    /// For a window of `periods` forcing periods. A period is only accepted if the window holds it twice, so
    /// that every crossing has a partner to be compared with.
    pub fn new(periods: u64) -> Self {
        let waiting = std::array::from_fn(|index| (2 * (index as u64 + 1) <= periods).then_some(0));
        let paired = [false; LONGEST];
        Self { periods: periods as f64, recent: VecDeque::new(), dropped: 0, waiting, paired }
    }

    pub fn add(&mut self, time: f64, side: Side) {
        let number = self.dropped + self.recent.len() as u64;
        for (index, waiting) in self.waiting.iter_mut().enumerate() {
            let (q, Some(first)) = (index as f64 + 1.0, *waiting) else { continue };
            if time < q - CROSSING_MATCH {
                continue;
            }
            let partner = self.recent.get((first - self.dropped) as usize).filter(|_| first < number);
            let meets = partner
                .is_some_and(|partner| partner.1 == side && (time - partner.0 - q).abs() <= CROSSING_MATCH);
            if meets {
                *waiting = Some(first + 1);
                self.paired[index] = true;
            } else if !(time <= q + CROSSING_MATCH && first == 0) {
                // a crossing near the edge may have its partner before the window
                *waiting = None;
            }
        }
        if self.recent.is_empty() {
            self.recent.reserve(2 * LONGEST);
        }
        self.recent.push_back((time, side));
        let needed = self.waiting.iter().flatten().min().copied().unwrap_or(number + 1);
        while self.dropped < needed && self.recent.pop_front().is_some() {
            self.dropped += 1;
        }
    }

    /// Adds whole repetitions, `periods` long in total, of a motion that has repeated exactly for more than
    /// the longest period searched for.
    pub fn skip(&mut self, periods: f64) {
        for crossing in &mut self.recent {
            crossing.0 += periods;
        }
    }

    /// Whether the crossings repeat with a period of at most [`LONGEST`] forcing periods.
    pub fn repeat(&self) -> bool {
        self.waiting.iter().zip(self.paired).enumerate().any(|(index, (waiting, paired))| {
            let q = index as f64 + 1.0;
            paired
                && waiting.is_some_and(|first| {
                    let alone = self.recent.get((first - self.dropped) as usize);
                    alone.is_none_or(|alone| alone.0 + q >= self.periods - CROSSING_MATCH)
                })
        })
    }
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use super::*;

    /// Adds crossings at `time(i)`, alternately to the right and to the left.
    fn add(crossings: &mut Crossings, numbers: Range<i32>, time: impl Fn(i32) -> f64) {
        let sides = [Side::Right, Side::Left].into_iter().cycle();
        numbers.map(time).zip(sides).for_each(|(t, side)| crossings.add(t, side));
    }

    fn repeat(periods: u64, numbers: Range<i32>, time: impl Fn(i32) -> f64) -> bool {
        let mut crossings = Crossings::new(periods);
        add(&mut crossings, numbers, time);
        assert!(crossings.recent.len() <= 2 * LONGEST + 2);
        crossings.repeat()
    }

    fn twice_a_period(i: i32) -> f64 {
        0.25 + 0.5 * f64::from(i)
    }

    #[test]
    fn two_crossings_per_period_repeat() {
        assert!(repeat(15, 0..30, twice_a_period));
        let off_the_edge = |i: i32| if i % 4 == 0 { 1e-4 } else { 0.0 };
        assert!(repeat(15, 0..30, |i| 0.5 * f64::from(i) + off_the_edge(i)));
        assert!(repeat(15, 1..31, |i| 0.5 * f64::from(i) - off_the_edge(i)));
    }

    #[test]
    fn a_lone_crossing_and_scattered_ones_do_not_repeat() {
        for few in [&[][..], &[6.1], &[6.1, 7.3]] {
            assert!(!repeat(15, 0..few.len() as i32, |i| few[i as usize]));
        }
        assert!(!repeat(15, 0..28, |i| twice_a_period(i) + 0.1 * f64::from(i * i % 7)));
        // stops crossing half way, or begins there
        assert!(!repeat(15, 0..14, twice_a_period));
        assert!(!repeat(15, 14..30, twice_a_period));
    }

    #[test]
    fn skipped_crossings_count_as_if_they_were_added() {
        let mut crossings = Crossings::new(1_000_000);
        add(&mut crossings, 0..60, twice_a_period);
        crossings.skip(1_000_000.0 - 30.0);
        assert!(crossings.repeat());
        // the last period differs
        crossings.add(1e6 - 0.1, Side::Right);
        assert!(!crossings.repeat());
    }

    fn strobes(periods: u64, x: impl Fn(u64) -> f64) -> Strobes {
        let mut strobes = Strobes::new((1.0, 1.0), periods, 0);
        (0..=periods).for_each(|i| strobes.add(Strobe { x: x(i), v: 0.0 }));
        strobes
    }

    #[test]
    fn the_period_of_stroboscopic_states() {
        let five = strobes(40, |i| (i % 5) as f64);
        assert_eq!(five.period(), Some((5, 0)));
        assert_eq!(strobes(9, |i| (i % 5) as f64).period(), None); // the window holds it once
        assert_eq!(strobes(10, |i| (i % 5) as f64).period(), Some((5, 0)));
        assert_eq!(strobes(40, |i| (i * i % 37) as f64).period(), None);
        // three different states, then two alternating ones
        assert_eq!(strobes(40, |i| if i < 3 { 7 + i } else { i % 2 } as f64).since[1], 3);
    }

    #[test]
    fn an_approach_repeats_once_its_remainder_is_small() {
        // Towards 0 at this rate per period, from one side or alternating, or away from it: neighbours may
        // have agreed for a long time.
        for rate in [0.5, 0.9, 0.99, 0.999, 0.9999, 1.0001, 1.01, -0.5, -0.9, -0.99, -0.9999, -1.01_f64] {
            for window in [2, 3, 7, 30, 101] {
                for remains in [2e-2, 2e-3, 5e-4, 1e-6, 1e-12] {
                    let x = |i: u64| remains * rate.powi(i as i32 - window as i32);
                    let found = strobes(window, x).period();
                    let (first, last) = (x(0).abs(), x(window).abs());
                    let case = format!("{rate} {window} {remains}: {found:?}");
                    if let Some((period, _)) = found {
                        assert!(period == 1 || (period == 2 && rate < 0.0), "{case}");
                        // it does not drift, or by less than can be detected
                        let moves = (first - last).abs() > 2.5 * MAX_STILL_CHANGE;
                        assert!(!moves || (last <= 2.0 * STATE_MATCH && rate.abs() < 1.0), "{case}");
                    } else if first.max(last) <= 0.5 * STATE_MATCH && window >= 4 {
                        assert!(rate.abs() > 1.0, "{case}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_spiral_repeats_if_it_goes_inward() {
        for turn in [0.1, 1.0, 2.0, 3.1_f64] {
            for growth in [0.9, 0.99, 1.01, 1.02, 1.05_f64] {
                for window in [7, 30, 101] {
                    let mut strobes = Strobes::new((1.0, 1.0), window, 0);
                    for i in 0..=window {
                        let size = 4e-4 * growth.powi(i as i32 - window as i32);
                        let (v, x) = (turn * i as f64).sin_cos();
                        strobes.add(Strobe { x: size * x, v: size * v });
                    }
                    let first = 4e-4 * growth.powi(-(window as i32));
                    let case = format!("{turn} {growth} {window}: {:?}", strobes.period());
                    if growth > 1.0 && first < 3e-4 {
                        assert_eq!(strobes.period(), None, "{case}");
                    } else if growth < 1.0 && first < 6e-4 && window >= 30 {
                        assert!(strobes.period().is_some(), "{case}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_slow_drift_does_not_repeat() {
        for step in [5e-4, 1e-4, 3e-5, 1e-5, 2e-6] {
            assert_eq!(strobes(40, |i| step * i as f64).period(), None, "{step}");
        }
    }

    #[test]
    fn skipped_states_count_as_if_they_were_added() {
        for lap in [1, 2, 5, 12, 13, 30] {
            for (from, periods) in [(0, 1200), (7, 41), (100, 23), (3, 1090), (600, 500)] {
                let state = |i: u64| Strobe { x: (i % lap) as f64, v: 0.0 };
                let mut skipped = Strobes::new((1.0, 1.0), periods, from);
                let mut full = skipped.clone();
                let enough = 2 * LONGEST as u64 + 4 * lap;
                let more = (from + periods + 1).saturating_sub(enough) / lap * lap;
                (0..enough).for_each(|i| skipped.add(state(i)));
                skipped.skip(more, lap, |place| state(enough + place));
                (enough + more..=from + periods).for_each(|i| skipped.add(state(i)));
                (0..=from + periods).for_each(|i| full.add(state(i)));
                assert_eq!(skipped.seen, full.seen);
                assert_eq!(skipped.period(), full.period(), "{lap} {from} {periods}");
                let expected = (lap <= 12 && 2 * lap <= periods).then_some(lap as u32);
                assert_eq!(full.period().map(|period| period.0), expected, "{lap} {from} {periods}");
            }
        }
    }
}
