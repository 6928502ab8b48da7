//! Stroboscopic states that a run lists: those of its settled window at a phase of the drive, and the last
//! one at the phase of its start.

use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::result::{MapState, Request, SectionPoint};
use crate::numeric::Scalar;

/// Instants closer than this share of a forcing period are the same: more than the rounding of an instant.
pub(super) const SAME: f64 = 1e-9;

/// Maximum number of stroboscopic states that are recorded one by one: some tenths of a second of one core,
/// and more than a run with steps shorter than a forcing period has. Later states are ignored.
pub(crate) const MAX_STROBES: u32 = 1 << 22;

/// States listed once per forcing period.
#[derive(Debug, Clone)]
pub(crate) struct Listing<T> {
    next: Instant<T>,
    /// Number of states still to be listed; `None` if only the last state is kept.
    left: Option<u64>,
    /// Cycles of the clock between two states.
    cycles: i64,
    /// The states since `first`.
    states: Vec<MapState>,
    first: Instant<T>,
}

/// The listings of a run.
#[derive(Debug, Clone)]
pub(crate) struct Listings<T> {
    section: Option<Listing<T>>,
    carried: Option<Listing<T>>,
}

/// Progress of the listings at an instant: the number of states of the section, and the next instants.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Listed<T> {
    states: usize,
    next: [Option<Instant<T>>; 2],
}

impl<T: Scalar> Listing<T> {
    pub fn add(&mut self, state: MapState) {
        match &mut self.left {
            Some(left) => *left -= 1,
            None => self.states.clear(),
        }
        self.states.push(state);
        self.next.cycle += self.cycles;
    }

    /// Skips states of a mass that stands still up to `until`, if only the last is kept.
    pub fn skip_still(&mut self, clock: &Clock<T>, period: T, until: &Instant<T>) {
        if self.left.is_none() {
            let periods = (clock.between(&self.next, until) / period).floor().to_f64();
            self.next.cycle += (periods as i64 - 1).max(0) * self.cycles;
        }
    }

    /// Sets the electrical state of those since `at`, while the mass stands still.
    pub fn charge(&mut self, clock: &Clock<T>, at: &Instant<T>, electrical: impl Fn(&Instant<T>) -> f64) {
        let mut instant = self.next;
        for state in self.states.iter_mut().rev() {
            instant.cycle -= self.cycles;
            if clock.between(at, &instant) < T::zero() {
                break;
            }
            state.electrical = electrical(&instant);
        }
    }

    /// The next instant, if there is a state still to be listed.
    pub fn due(&self) -> Option<Instant<T>> {
        (self.left != Some(0)).then_some(self.next)
    }
}

impl<T> Default for Listings<T> {
    fn default() -> Self {
        Self { section: None, carried: None }
    }
}

impl<T: Scalar> Listings<T> {
    /// The listings that `request` asks for, in a run whose settled window begins at `from` and holds
    /// `periods` forcing periods of `cycles` cycles of the clock; `start` is the drive's phase at the start
    /// in turns.
    pub fn new(
        request: &Request,
        clock: &Clock<T>,
        from: Instant<T>,
        (periods, cycles): (u64, i64),
        start: f64,
    ) -> Self {
        if cycles == 0 {
            return Self::default();
        }
        let listing = |first, left| Listing { next: first, left, cycles, states: Vec::new(), first };
        let section = request.section.map(|phase| {
            let turns = (phase - start).rem_euclid(1.0) * cycles as f64;
            let whole = turns.floor();
            let mut first = Instant { cycle: whole as i64, phase: T::of(turns - whole) * clock.period };
            let same = T::of(SAME * cycles as f64) * clock.period;
            first.cycle += (from.cycle - first.cycle).div_euclid(cycles) * cycles;
            while clock.between(&from, &first) < -same {
                first.cycle += cycles;
            }
            if clock.between(&from, &first).abs() <= same {
                first = from;
            }
            listing(first, Some(periods.min(MAX_STROBES.into())))
        });
        let start = Instant { cycle: 0, phase: T::zero() };
        Self { section, carried: request.carry.then(|| listing(start, None)) }
    }

    #[inline]
    pub fn is_empty(&self) -> bool {
        self.section.is_none() && self.carried.is_none()
    }

    pub fn each(&mut self) -> impl Iterator<Item = &mut Listing<T>> {
        self.section.iter_mut().chain(&mut self.carried)
    }

    #[inline]
    pub fn due(&self) -> impl Iterator<Item = Instant<T>> {
        self.section.iter().chain(&self.carried).filter_map(Listing::due)
    }

    pub fn listed(&self) -> Listed<T> {
        let next = [&self.section, &self.carried].map(|listing| listing.as_ref().map(|listing| listing.next));
        Listed { states: self.section.as_ref().map_or(0, |section| section.states.len()), next }
    }

    /// Adds `laps` more laps of `cycles` cycles of the clock, each like the one from `before` to `after`.
    pub fn repeat(&mut self, before: &Listed<T>, after: &Listed<T>, laps: i64, cycles: i64) {
        for (listing, next) in [&mut self.section, &mut self.carried].into_iter().zip([0, 1]) {
            let Some(listing) = listing else { continue };
            if before.next[next] == after.next[next] {
                continue; // the lap precedes all listed states
            }
            listing.next.cycle += laps * cycles;
            if let Some(left) = &mut listing.left {
                let lap = listing.states.get(before.states..after.states).unwrap_or_default().to_vec();
                let more = ((lap.len() as u64).saturating_mul(laps as u64)).min(*left);
                listing.states.extend(lap.iter().cycle().take(more as usize));
                *left -= more;
            }
        }
    }

    /// Begins the section again for a settled window of `periods` that follows the last one.
    pub fn next_window(&mut self, periods: u64) {
        if let Some(section) = &mut self.section {
            section.states.clear();
            section.first = section.next;
            section.left = Some(periods.min(MAX_STROBES.into()));
        }
    }

    /// The section, and the last state of `carried`.
    pub fn finish(self, clock: &Clock<T>) -> (Vec<SectionPoint>, Option<MapState>) {
        let points = self.section.into_iter().flat_map(|Listing { first, cycles, states, .. }| {
            states.into_iter().zip(0..).map(move |(MapState { x, v, .. }, number)| {
                let at = Instant { cycle: first.cycle + number * cycles, phase: first.phase };
                SectionPoint { t: clock.seconds(&at), x, v }
            })
        });
        (points.collect(), self.carried.and_then(|listing| listing.states.last().copied()))
    }
}
