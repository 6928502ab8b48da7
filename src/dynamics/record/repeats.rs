//! Repetition of a motion: of its stroboscopic states and of its crossings, judged as they come.
//!
//! Nothing of the past is kept beyond the last twelve forcing periods, so a window may be as long as it
//! likes.

use std::collections::VecDeque;

use crate::dynamics::result::Side;

/// Most forcing periods after which a motion may repeat and still count as periodic.
pub(crate) const LONGEST: usize = 12;

/// Two crossings repeat where their times within the period agree to this share of a forcing period: well
/// above what is left of a transient after half a run, well below the scatter of irregular motion.
const CROSSING_MATCH: f64 = 1e-2;

/// Two stroboscopic states repeat where they agree to this share of the scene's scales: fine enough to see
/// a period doubling soon after its onset, coarse enough for a transient that has died to a thousandth.
const STATE_MATCH: f64 = 1e-3;

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
}

/// The stroboscopic states of a run, numbered from 0.
#[derive(Debug, Clone)]
pub(crate) struct Strobes {
    /// Length and speed that states are compared by.
    scales: (f64, f64),
    /// The longest period that is looked for.
    longest: usize,
    seen: u64,
    /// The last of them, each at its number modulo [`LONGEST`].
    recent: [Strobe; LONGEST],
    /// For each number of periods up to [`LONGEST`] the state from which on each has come back after so many.
    since: [u64; LONGEST],
    /// The first states of the settled window, at most [`LONGEST`], and the number of the very first.
    opening: Vec<Strobe>,
    from: u64,
}

impl Strobes {
    /// Of a settled window of so many `periods` that begins with the state number `from`. A period is only
    /// accepted if the window holds it twice.
    pub fn new(scales: (f64, f64), periods: u64, from: u64) -> Self {
        let (recent, longest) = ([Strobe::default(); LONGEST], LONGEST.min((periods / 2) as usize));
        Self { scales, longest, seen: 0, recent, since: [0; LONGEST], opening: Vec::new(), from }
    }

    /// Of another window, before the first state. All periods are looked for, however short it is.
    pub fn begin_window(&mut self, periods: u64, from: u64) {
        *self = Self { longest: LONGEST, ..Self::new(self.scales, periods, from) };
    }

    /// The smallest number of states after which those of the last two periods, and so many `more`, have come
    /// back.
    pub fn repeats_for(&self, more: u64) -> Option<u32> {
        (1..=self.longest as u64).find_map(|q| {
            let back = self.since[q as usize - 1] + q + 2 * q + more < self.seen;
            back.then_some(q as u32)
        })
    }

    /// The number of states so far.
    pub fn seen(&self) -> u64 {
        self.seen
    }

    pub fn tell(&mut self, state: Strobe) {
        let number = self.seen;
        for (own, since) in self.since.iter_mut().enumerate().take(self.longest) {
            let Some(before) = number.checked_sub(own as u64 + 1) else { break };
            if !state.is_near(&self.recent[before as usize % LONGEST], self.scales) {
                *since = before + 1;
            }
        }
        self.recent[number as usize % LONGEST] = state;
        if number >= self.from && self.opening.len() < LONGEST {
            self.opening.reserve(LONGEST - self.opening.len());
            self.opening.push(state);
        }
        self.seen += 1;
    }

    /// Adds `more` states of a motion that repeats exactly after every `lap` states, which divides `more`,
    /// and has done so for twice as many states as are looked back at and four laps.
    pub fn skip(&mut self, more: u64, lap: u64) {
        for since in &mut self.since {
            // one that has not come back lately will not either
            if *since + self.longest as u64 + lap >= self.seen {
                *since += more;
            }
        }
        self.recent.rotate_right((more % LONGEST as u64) as usize);
        self.seen += more;
    }

    /// The longest period that is looked for.
    pub fn longest(&self) -> usize {
        self.longest
    }

    /// The smallest number of states after which all states of the window have come back, and the number of
    /// the state since which they have.
    pub fn period(&self) -> Option<(u32, u64)> {
        (1..=self.longest as u64).find_map(|q| {
            let since = self.since[q as usize - 1];
            (since <= self.from && self.seen > self.from + q).then_some((q as u32, since))
        })
    }

    /// Whether the last states of the window are still where its first ones were, which a slow drift leaves
    /// although neighbours agree.
    pub fn is_steady(&self, period: u32) -> bool {
        let q = u64::from(period);
        (self.seen.saturating_sub(q)..self.seen).all(|number| {
            let first = self.opening.get(((number - self.from) % q) as usize);
            first.is_some_and(|first| first.is_near(&self.recent[number as usize % LONGEST], self.scales))
        })
    }

    /// The settled window begins anew with the last state.
    pub fn open_window(&mut self) {
        self.from = self.seen.saturating_sub(1);
        self.opening.clear();
        self.opening.push(self.recent[self.from as usize % LONGEST]);
    }
}

/// The crossings of the settled window.
#[derive(Debug, Clone)]
pub(crate) struct Crossings {
    /// Forcing periods in the window.
    periods: f64,
    /// Those that may still wait for a partner: time in forcing periods since the window's start, and the
    /// well entered.
    recent: VecDeque<(f64, Side)>,
    /// Crossings before the first of `recent`.
    gone: u64,
    /// For each number of periods the first crossing without a partner so many periods later; none where one
    /// was missed.
    waiting: [Option<u64>; LONGEST],
    paired: [bool; LONGEST],
}

impl Crossings {
    /// A window of so many forcing periods. A period is only accepted if the window holds it twice, so that
    /// every crossing has a partner to be compared with.
    pub fn new(periods: u64) -> Self {
        let waiting = std::array::from_fn(|own| (2 * (own as u64 + 1) <= periods).then_some(0));
        let paired = [false; LONGEST];
        Self { periods: periods as f64, recent: VecDeque::new(), gone: 0, waiting, paired }
    }

    pub fn tell(&mut self, time: f64, side: Side) {
        let number = self.gone + self.recent.len() as u64;
        for (own, waiting) in self.waiting.iter_mut().enumerate() {
            let (q, Some(first)) = (own as f64 + 1.0, *waiting) else { continue };
            if time < q - CROSSING_MATCH {
                continue;
            }
            let partner = self.recent.get((first - self.gone) as usize).filter(|_| first < number);
            let meets = partner
                .is_some_and(|partner| partner.1 == side && (time - partner.0 - q).abs() <= CROSSING_MATCH);
            if meets {
                *waiting = Some(first + 1);
                self.paired[own] = true;
            } else if !(time <= q + CROSSING_MATCH && first == 0) {
                // (one near the edge may have its partner before the window)
                *waiting = None;
            }
        }
        if self.recent.is_empty() {
            self.recent.reserve(2 * LONGEST);
        }
        self.recent.push_back((time, side));
        let needed = self.waiting.iter().flatten().min().copied().unwrap_or(number + 1);
        while self.gone < needed && self.recent.pop_front().is_some() {
            self.gone += 1;
        }
    }

    /// Adds whole repetitions that last `periods` in all, of a motion that has repeated exactly for as long
    /// as a period is looked for, and once more.
    pub fn skip(&mut self, periods: f64) {
        for crossing in &mut self.recent {
            crossing.0 += periods;
        }
    }

    /// Whether they repeat with a period of at most [`LONGEST`] forcing periods.
    pub fn repeat(&self) -> bool {
        self.waiting.iter().zip(self.paired).enumerate().any(|(own, (waiting, paired))| {
            let q = own as f64 + 1.0;
            paired
                && waiting.is_some_and(|first| {
                    let alone = self.recent.get((first - self.gone) as usize);
                    alone.is_none_or(|alone| alone.0 + q >= self.periods - CROSSING_MATCH)
                })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repeat(periods: u64, times: &[f64]) -> bool {
        let side = |i: usize| if i.is_multiple_of(2) { Side::Right } else { Side::Left };
        let mut crossings = Crossings::new(periods);
        times.iter().enumerate().for_each(|(i, t)| crossings.tell(*t, side(i)));
        assert!(crossings.recent.len() <= 2 * LONGEST + 2);
        crossings.repeat()
    }

    #[test]
    fn twice_a_period_repeats() {
        let times: Vec<f64> = (0..30).map(|i| 0.25 + 0.5 * f64::from(i)).collect();
        assert!(repeat(15, &times));
        let edge: Vec<f64> =
            (0..30).map(|i| 0.5 * f64::from(i) + if i % 4 == 0 { 1e-4 } else { 0.0 }).collect();
        assert!(repeat(15, &edge));
        let before_the_edge: Vec<f64> =
            (1..31).map(|i| 0.5 * f64::from(i) - if i % 4 == 0 { 1e-4 } else { 0.0 }).collect();
        assert!(repeat(15, &before_the_edge));
    }

    #[test]
    fn a_lone_crossing_or_scatter_does_not() {
        assert!(!repeat(15, &[]));
        assert!(!repeat(15, &[6.1]));
        assert!(!repeat(15, &[6.1, 7.3]));
        let scattered: Vec<f64> =
            (0..28).map(|i| 0.25 + 0.5 * f64::from(i) + 0.1 * f64::from(i * i % 7)).collect();
        assert!(!repeat(15, &scattered));
        // stops crossing half way, or begins there
        let dying: Vec<f64> = (0..14).map(|i| 0.25 + 0.5 * f64::from(i)).collect();
        assert!(!repeat(15, &dying));
        let rising: Vec<f64> = (14..30).map(|i| 0.25 + 0.5 * f64::from(i)).collect();
        assert!(!repeat(15, &rising));
    }

    #[test]
    fn crossings_that_are_skipped_are_as_if_told() {
        let times = |from: i32, to: i32| (from..to).map(|i| 0.25 + 0.5 * f64::from(i));
        let told = |crossings: &mut Crossings, from: i32, to: i32| {
            times(from, to)
                .zip([Side::Right, Side::Left].into_iter().cycle())
                .for_each(|(t, side)| crossings.tell(t, side));
        };
        let mut crossings = Crossings::new(1_000_000);
        told(&mut crossings, 0, 60);
        crossings.skip(1_000_000.0 - 30.0);
        assert!(crossings.repeat());
        // the last period is another
        crossings.tell(1e6 - 0.1, Side::Right);
        assert!(!crossings.repeat());
    }

    fn strobes(periods: u64, states: impl Iterator<Item = i32>) -> Strobes {
        let mut strobes = Strobes::new((1.0, 1.0), periods, 0);
        states.for_each(|x| strobes.tell(Strobe { x: f64::from(x), v: 0.0 }));
        strobes
    }

    #[test]
    fn the_period_of_stroboscopic_states() {
        let five = strobes(40, (0..41).map(|i| i % 5));
        assert_eq!(five.period(), Some((5, 0)));
        assert!(five.is_steady(5));
        assert_eq!(strobes(9, (0..10).map(|i| i % 5)).period(), None); // the window holds it once
        assert_eq!(strobes(40, (0..41).map(|i| i * i % 37)).period(), None);
        // three states of their own, then two in turn
        assert_eq!(strobes(40, (0..41).map(|i| if i < 3 { 7 + i } else { i % 2 })).since[1], 3);
    }

    #[test]
    fn a_slow_drift_repeats_and_is_not_steady() {
        let mut drifting = Strobes::new((1.0, 1.0), 40, 0);
        (0..41).for_each(|i| drifting.tell(Strobe { x: 5e-4 * f64::from(i), v: 0.0 }));
        assert_eq!(drifting.period(), Some((1, 0)));
        assert!(!drifting.is_steady(1));
    }

    #[test]
    fn states_that_are_skipped_are_as_if_told() {
        let mut own = strobes(1000, (0..40).map(|i| i % 5));
        own.skip(1000, 5);
        assert_eq!((own.seen(), own.period()), (1040, Some((5, 0))));
        (1040..1050).for_each(|i| own.tell(Strobe { x: f64::from(i % 5), v: 0.0 }));
        assert_eq!(own.period(), Some((5, 0)));
        assert!(own.is_steady(5));
        own.tell(Strobe { x: 9.0, v: 0.0 });
        assert_eq!(own.period(), None);
    }
}
