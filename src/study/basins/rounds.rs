//! Rounds of a map of basins: starts are followed in rounds, and what is known grows between them.

use super::Basins;
use super::orbit::{Found, find};
use super::region::absorbing;
use super::starts::Starts;
use super::stroboscopic::Stroboscope;
use super::verdict::{Verdict, verdict};
use crate::dynamics::{Arrival, Capture, Outcome, Pursuit, Region, ReleaseIdentity, Side, Summary};
use crate::study::Task;
use crate::study::settled::PATIENCE;
use crate::system::threads::Pool;

/// Starts of the first round of a map, and the most of any: while little is known, rounds are short.
const FIRST_ROUND: usize = 64;
const LONGEST_ROUND: usize = 8192;

/// Regions that are looked for around motions of one kind.
const MOST_SEARCHES: usize = 4;

/// Motions of one verdict whose exponents are asked for in vain.
const MOST_DOUBTS: usize = 4;

/// States closer than this share of the scales count as one, of a proposal and of an unstable orbit.
const SAME_PROPOSAL: f64 = 1e-3;
const ON_ORBIT: f64 = 1e-6;

/// What is known of a start. Indices are those of the lists of [`Rounds`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fate {
    NotRun,
    Outside,
    Lost,
    Undecided,
    /// Goes to this kind of motion, after so many periods.
    Kind(u32, u32),
    /// Comes to this release, after so many periods.
    Release(u32, u32),
}

/// A kind of motion that a start goes to, other than by a release.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    /// A stable orbit, by its number.
    Orbit(u32),
    /// Rest on a stop.
    Rest(Side),
    /// What [`verdict`] says, and the summary of the first one.
    Judged(Verdict, Box<Summary>),
}

/// A release, what follows it, and after how many periods more.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Release {
    identity: ReleaseIdentity,
    pub next: Fate,
}

/// Something to follow: a start, or what comes after a release, as the continuation of a start with some
/// releases passed over.
#[derive(Debug, Clone, Copy)]
struct Item {
    row: usize,
    releases: u32,
    /// The release that it continues, and its number of periods up to there.
    after: Option<(u32, u64)>,
    repeats_from: u64,
}

/// What is known of a map.
#[derive(Debug)]
pub(super) struct Rounds {
    pub fates: Vec<Fate>,
    pub kinds: Vec<Kind>,
    pub releases: Vec<Release>,
    /// States of stable orbits with their ellipses, and which orbit each is of.
    pub captures: Vec<Capture>,
    pub of: Vec<u32>,
    /// States that proposed no stable orbit, and those of unstable ones.
    rejected: Vec<(f64, f64)>,
    unstable: Vec<(f64, f64)>,
    /// Regions around irregular motions, which kind each is of, and the kind of each that was looked for.
    regions: Vec<Region>,
    region_of: Vec<u32>,
    searches: Vec<u32>,
    /// Verdicts on motions without a period whose exponent does not bear them out.
    doubted: Vec<Verdict>,
    next_round: usize,
}

impl Rounds {
    pub fn new(starts: usize) -> Self {
        Self {
            fates: vec![Fate::NotRun; starts],
            kinds: Vec::new(),
            releases: Vec::new(),
            captures: Vec::new(),
            of: Vec::new(),
            rejected: Vec::new(),
            unstable: Vec::new(),
            regions: Vec::new(),
            region_of: Vec::new(),
            searches: Vec::new(),
            doubted: Vec::new(),
            next_round: FIRST_ROUND,
        }
    }

    fn kind(&mut self, same: impl Fn(&Kind) -> bool, new: impl FnOnce() -> Kind) -> u32 {
        let place = self.kinds.iter().position(same);
        place.unwrap_or_else(|| {
            self.kinds.push(new());
            self.kinds.len() - 1
        }) as u32
    }

    /// The place of a release, and whether it is new.
    fn release(&mut self, identity: ReleaseIdentity) -> (u32, bool) {
        let place = self.releases.iter().position(|own| own.identity == identity);
        let new = place.is_none();
        if new {
            self.releases.push(Release { identity, next: Fate::NotRun });
        }
        (place.unwrap_or(self.releases.len() - 1) as u32, new)
    }

    /// Notes what an item has come to; what is to be followed for that.
    fn note(&mut self, item: Item, arrival: Arrival, scope: &Stroboscope) -> Option<Item> {
        let (fate, periods) = match arrival {
            Arrival::Captured { which, periods } => {
                let orbit = self.of[which];
                (Fate::Kind(self.kind(|own| *own == Kind::Orbit(orbit), || Kind::Orbit(orbit)), 0), periods)
            }
            Arrival::Entered { which, periods } => (Fate::Kind(self.region_of[which], 0), periods),
            Arrival::Rests { side, periods } => {
                (Fate::Kind(self.kind(|own| *own == Kind::Rest(side), || Kind::Rest(side)), 0), periods)
            }
            Arrival::Released { identity, periods } => {
                let (place, new) = self.release(identity);
                self.put(item, Fate::Release(place, 0), periods);
                let after = Some((place, periods));
                return new.then_some(Item { releases: item.releases + 1, after, repeats_from: 0, ..item });
            }
            Arrival::Repeats { periods, .. } => {
                return Some(Item { repeats_from: 2 * periods, ..item });
            }
            Arrival::Unsettled(summary) => {
                let end = (summary.final_x, summary.final_v);
                let on_unstable = self.unstable.iter().any(|own| is_near(scope, *own, end, ON_ORBIT));
                let fate = match verdict(&summary, on_unstable) {
                    Verdict::Lost => Fate::Lost,
                    Verdict::Undecided => Fate::Undecided,
                    own @ Verdict::Settled { .. } => self.judged(own, summary, scope),
                };
                (fate, PATIENCE.into())
            }
        };
        self.put(item, fate, periods);
        None
    }

    /// The kind of a motion that was judged. Of those without a period the first one must be irregular by its
    /// exponent, else one of the next few: it may be a motion that is slow to settle.
    fn judged(&mut self, own: Verdict, summary: Box<Summary>, scope: &Stroboscope) -> Fate {
        let same = |kind: &Kind| matches!(kind, Kind::Judged(other, _) if *other == own);
        let repeats = matches!(own, Verdict::Settled { period: Some(_), .. });
        if !repeats && !self.kinds.iter().any(same) {
            let doubts = self.doubted.iter().filter(|other| **other == own).count();
            if doubts >= MOST_DOUBTS || !scope.is_irregular((summary.final_x, summary.final_v)) {
                self.doubted.push(own);
                return Fate::Undecided;
            }
        }
        Fate::Kind(self.kind(same, || Kind::Judged(own, summary)), 0)
    }

    fn put(&mut self, item: Item, fate: Fate, periods: u64) {
        let count = |before: u64| (periods - before.min(periods)) as u32;
        let with = |count: u32| match fate {
            Fate::Kind(place, _) => Fate::Kind(place, count),
            Fate::Release(place, _) => Fate::Release(place, count),
            other => other,
        };
        match item.after {
            Some((release, before)) => self.releases[release as usize].next = with(count(before)),
            None => self.fates[item.row] = with(count(0)),
        }
    }

    /// Looks for an orbit near a state that proposed one. None where it was cancelled.
    fn propose(&mut self, scope: &Stroboscope, period: u32, state: (f64, f64)) -> Option<()> {
        let known = self.captures.iter().any(|own| own.holds(state));
        let tried = self.rejected.iter().any(|own| is_near(scope, *own, state, SAME_PROPOSAL));
        if known || tried {
            return Some(());
        }
        match find(scope, period, state)? {
            Found::Stable(captures) if self.captures.iter().any(|own| own.holds(captures[0].state)) => {
                self.rejected.push(state);
            }
            Found::Stable(captures) => {
                let orbit = self.of.last().map_or(0, |last| last + 1);
                self.of.extend(captures.iter().map(|_| orbit));
                self.captures.extend(captures);
            }
            Found::Unstable(own) => {
                self.unstable.push(own);
                self.rejected.push(state);
            }
            Found::Nothing => self.rejected.push(state),
        }
        Some(())
    }

    /// Looks for a region around the irregular motion that an item was found to go to, which has this state.
    /// None where it was cancelled.
    fn surround(&mut self, scope: &Stroboscope, item: Item, state: (f64, f64)) -> Option<()> {
        let fate = item.after.map_or(self.fates[item.row], |own| self.releases[own.0 as usize].next);
        let Fate::Kind(kind, _) = fate else { return Some(()) };
        let irregular = match &self.kinds[kind as usize] {
            Kind::Judged(Verdict::Settled { period, .. }, _) => period.is_none(),
            _ => false,
        };
        let searches = self.searches.iter().filter(|own| **own == kind).count();
        if !irregular || searches >= MOST_SEARCHES || self.is_surrounded(state) {
            return Some(());
        }
        self.searches.push(kind);
        if let Some(region) = absorbing(scope, state, &self.captures)? {
            self.regions.push(region);
            self.region_of.push(kind);
        }
        Some(())
    }

    /// Whether a state lies in a region.
    fn is_surrounded(&self, state: (f64, f64)) -> bool {
        self.regions.iter().any(|own| own.holds(state))
    }
}

fn is_near(scope: &Stroboscope, a: (f64, f64), b: (f64, f64), share: f64) -> bool {
    let (length, speed) = scope.units();
    (a.0 - b.0).abs() <= share * length && (a.1 - b.1).abs() <= share * speed
}

/// Follows items with what is known now, then adds to that; what is to be followed next. None where it was
/// cancelled.
fn round(
    rounds: &mut Rounds,
    scope: &Stroboscope,
    starts: &Starts,
    items: Vec<Item>,
    task: &Task,
) -> Option<Vec<Item>> {
    let (known, regions) = (rounds.captures.clone(), rounds.regions.clone());
    let pursuit = |item: &Item| {
        let (x_mm, v) = starts.at(item.row);
        Pursuit {
            start: (x_mm / 1e3, v),
            known: &known,
            regions: &regions,
            repeats_from: item.repeats_from,
            most_periods: PATIENCE.into(),
            releases: item.releases,
        }
    };
    let pursuits: Vec<Pursuit> = items.iter().map(pursuit).collect();
    let tick = |own: &Pursuit| {
        if own.repeats_from == 0 && own.releases == 0 {
            (task.tick)();
        }
    };
    let arrivals = scope.pursue(&pursuits, &tick)?;
    let (mut next, mut proposals, mut unsettled) = (Vec::new(), Vec::new(), Vec::new());
    for (item, arrival) in items.into_iter().zip(arrivals) {
        if let Arrival::Repeats { period, state, .. } = arrival {
            proposals.push((period, state));
        }
        if let Arrival::Unsettled(end) = &arrival
            && end.outcome == Outcome::Done
        {
            unsettled.push((item, (end.final_x, end.final_v)));
        }
        next.extend(rounds.note(item, arrival, scope));
    }
    for (period, state) in proposals {
        rounds.propose(scope, period, state)?;
    }
    for (item, state) in &unsettled {
        rounds.surround(scope, *item, *state)?;
    }
    // Followed again, they enter the region at their own time.
    next.extend(unsettled.into_iter().filter(|own| rounds.is_surrounded(own.1)).map(|own| own.0));
    (!task.is_cancelled()).then_some(next)
}

impl Basins {
    /// Runs the starts of the next level; whether it was not cancelled, after which the map is of no use. The
    /// task's tick is called for each start.
    pub fn run_level(&mut self, pool: &Pool, task: &Task) -> bool {
        let Self { model, starts, levels, done, room, rounds } = self;
        let scope = Stroboscope { model, room: *room, pool, cancel: task.cancel };
        let mut begin = done.checked_sub(1).map_or(0, |before| levels.ends[before]);
        let Some(end) = levels.ends.get(*done).copied() else { return true };
        while begin < end {
            let last = (begin + rounds.next_round).min(end);
            rounds.next_round = (2 * rounds.next_round).min(LONGEST_ROUND);
            let mut items = Vec::with_capacity(last - begin);
            for row in levels.order[begin..last].iter().map(|row| *row as usize) {
                let x = starts.at(row).0 / 1e3;
                if x >= room.0 && x <= room.1 {
                    items.push(Item { row, releases: 0, after: None, repeats_from: 0 });
                } else {
                    rounds.fates[row] = Fate::Outside;
                    (task.tick)();
                }
            }
            while !items.is_empty() {
                let Some(next) = round(rounds, &scope, starts, items, task) else { return false };
                items = next;
            }
            begin = last;
        }
        *done += 1;
        true
    }
}
