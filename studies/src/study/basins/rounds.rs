//! Rounds of a map of basins: starts are followed in rounds, between which the known attractors are updated.

use super::orbit::{Found, find};
use super::region::absorbing;
use super::stroboscopic::{Stroboscope, final_state};
use super::{Basins, Starts, is_inside};
use crate::dynamics::{
    Arrival, Capture, MapState, Outcome, Place, Pursued, Pursuit, Regime, Region, ReleaseIdentity, Side,
    Summary,
};
use crate::study::{Result, Task, settled};
use crate::system::threads::Pool;

/// Number of forcing periods after which a motion that has reached no known attractor is classified.
pub(super) const PATIENCE: u64 = settled::PATIENCE as u64;

/// Length of a motion up to its attractor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Way {
    pub periods: u32,
    pub crossings: u32,
}

impl Way {
    /// These counts less those of `before`.
    pub fn since(self, before: Self) -> Self {
        Self {
            periods: self.periods.saturating_sub(before.periods),
            crossings: self.crossings.saturating_sub(before.crossings),
        }
    }

    pub fn and(self, next: Self) -> Self {
        Self {
            periods: self.periods.saturating_add(next.periods),
            crossings: self.crossings.saturating_add(next.crossings),
        }
    }
}

/// A motion to follow: that of a start, or its continuation after a number of releases.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item {
    pub row: usize,
    pub releases: u32,
    /// The release that it continues, and the length of the motion up to there.
    pub after: Option<(u32, Way)>,
    pub repeats_from: u64,
}

impl Item {
    pub fn of_start(row: usize) -> Self {
        Self { row, releases: 0, after: None, repeats_from: 0 }
    }

    /// The length of a pursuit, counted from the release that it continues.
    pub fn way(&self, periods: u64, crossings: u64) -> Way {
        let count = |number: u64| u32::try_from(number).unwrap_or(u32::MAX);
        let whole = Way { periods: count(periods), crossings: count(crossings) };
        whole.since(self.after.map_or(Way::default(), |(_, before)| before))
    }

    /// The pursuit of the motion from this state of the circuit, with at most `max_work` units of work.
    pub fn pursuit<'a>(
        &self,
        starts: &Starts,
        electrical: f64,
        known: &'a [Capture],
        regions: &'a [Region],
        max_work: u64,
    ) -> Pursuit<'a> {
        let (x_mm, v) = starts.at(self.row);
        Pursuit {
            start: MapState { x: x_mm / 1e3, v, electrical },
            known,
            regions,
            repeats_from: self.repeats_from,
            max_periods: PATIENCE,
            releases: self.releases,
            max_work,
        }
    }
}

/// Number of starts in the first round of a map: rounds are short while few attractors are known.
const FIRST_ROUND: usize = 64;
pub(super) const MAX_ROUND: usize = 8192;

/// Largest number of searches for regions around motions of one kind.
const MAX_SEARCHES: usize = 4;

/// Motions of one verdict that their exponents may fail to confirm before others are no longer tested.
const MAX_UNCONFIRMED: usize = 4;

/// Distance below which two proposals count as one, as a share of the scales.
const SAME_PROPOSAL: f64 = 1e-3;
/// Distance below which a state lies on an unstable orbit, as a share of the scales.
const ON_ORBIT: f64 = 1e-6;

/// The verdict on a settled motion: all with the same one are one attractor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Verdict {
    regime: Regime,
    side: Option<Place>,
    /// Its period, if no ellipse could be found around it.
    period: Option<u32>,
}

/// What is known of the motion of a start. Indices are those of the lists of [`Rounds`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fate {
    NotRun,
    Outside,
    /// Its run ended early; `spent` if it used up its budget of work.
    Lost {
        spent: bool,
    },
    Undecided,
    /// It reaches this kind of motion.
    Kind(u32, Way),
    /// It reaches this release.
    Release(u32, Way),
}

/// A kind of motion that a start reaches without a release.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// A stable orbit, by its index.
    Orbit(u32),
    Rest(Side),
    Judged(Verdict),
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Release {
    identity: ReleaseIdentity,
    pub next: Fate,
}

#[derive(Debug, Default)]
pub(super) struct Rounds {
    pub fates: Vec<Fate>,
    /// The kinds, each that was judged with the summary of the first such motion.
    pub kinds: Vec<(Kind, Option<Box<Summary>>)>,
    pub releases: Vec<Release>,
    /// States of stable orbits with their ellipses.
    pub captures: Vec<Capture>,
    /// The orbit of each capture.
    pub orbit_of: Vec<u32>,
    /// States from which no stable orbit was found.
    rejected: Vec<MapState>,
    unstable: Vec<MapState>,
    /// Regions around irregular motions.
    pub regions: Vec<Region>,
    /// The kind of each region.
    region_of: Vec<u32>,
    /// The kind of each search for a region.
    searches: Vec<u32>,
    /// Verdicts on motions without a period that the exponent did not confirm.
    doubted: Vec<Verdict>,
    next_round: usize,
    /// Number of starts that have not been followed.
    remaining: usize,
}

impl Rounds {
    pub fn new(starts: usize) -> Self {
        let fates = vec![Fate::NotRun; starts];
        Self { fates, next_round: FIRST_ROUND, remaining: starts, ..Self::default() }
    }

    fn known_kind(&self, kind: Kind) -> Option<u32> {
        self.kinds.iter().position(|(known, _)| *known == kind).map(|place| place as u32)
    }

    fn kind(&mut self, kind: Kind, summary: Option<Box<Summary>>) -> u32 {
        self.known_kind(kind).unwrap_or_else(|| {
            self.kinds.push((kind, summary));
            self.kinds.len() as u32 - 1
        })
    }

    /// The index of a release, and whether it is new.
    fn release(&mut self, identity: ReleaseIdentity) -> (u32, bool) {
        let place = self.known_release(identity);
        if place.is_none() {
            self.releases.push(Release { identity, next: Fate::NotRun });
        }
        (place.unwrap_or(self.releases.len() as u32 - 1), place.is_none())
    }

    fn known_release(&self, identity: ReleaseIdentity) -> Option<u32> {
        self.releases.iter().position(|release| release.identity == identity).map(|place| place as u32)
    }

    /// Records the result of an item; returns the item that continues it, if its fate depends on one.
    fn note(&mut self, item: Item, pursued: Pursued, scope: &Stroboscope) -> Option<Item> {
        let way = item.way(pursued.periods.unwrap_or(PATIENCE), pursued.crossings);
        let fate = match pursued.arrival {
            Arrival::Captured(which) => Fate::Kind(self.kind(Kind::Orbit(self.orbit_of[which]), None), way),
            Arrival::Entered(which) => Fate::Kind(self.region_of[which], way),
            Arrival::Rests(side) => Fate::Kind(self.kind(Kind::Rest(side), None), way),
            Arrival::Released(identity) => {
                let (place, new) = self.release(identity);
                self.put(item, Fate::Release(place, way));
                let after = Some((place, item.after.map_or(way, |(_, before)| before.and(way))));
                return new.then_some(Item { releases: item.releases + 1, after, repeats_from: 0, ..item });
            }
            Arrival::Repeats { .. } => {
                return Some(Item { repeats_from: 2 * pursued.periods?, ..item });
            }
            Arrival::Unsettled(summary) => match self.verdict(&summary, scope) {
                Ok(verdict) => self.judged(verdict, summary, scope, way),
                Err(fate) => fate,
            },
        };
        self.put(item, fate);
        None
    }

    /// The fate of an item that was followed once more; `None` if its attractor is not among the known ones.
    pub fn known_fate(&self, item: &Item, pursued: &Pursued, scope: &Stroboscope) -> Option<Fate> {
        let way = item.way(pursued.periods.unwrap_or(PATIENCE), pursued.crossings);
        let kind = match &pursued.arrival {
            Arrival::Captured(which) => self.known_kind(Kind::Orbit(self.orbit_of[*which])),
            Arrival::Entered(which) => Some(self.region_of[*which]),
            Arrival::Rests(side) => self.known_kind(Kind::Rest(*side)),
            Arrival::Unsettled(summary) => {
                let verdict = self.verdict(summary, scope).ok();
                verdict.and_then(|verdict| self.known_kind(Kind::Judged(verdict)))
            }
            Arrival::Released(identity) => {
                return self.known_release(*identity).map(|place| Fate::Release(place, way));
            }
            Arrival::Repeats { .. } => None,
        };
        kind.map(|kind| Fate::Kind(kind, way))
    }

    /// The verdict on a motion that has reached no known attractor, from the summary of its pursuit, whose
    /// window is its last hundred forcing periods; its fate if it ended early or its attractor is not known.
    fn verdict(&self, summary: &Summary, scope: &Stroboscope) -> Result<Verdict, Fate> {
        let Summary { outcome, steady, regime, side, period, .. } = *summary;
        let end = final_state(summary);
        let on_unstable = self.unstable.iter().any(|state| is_near(scope, *state, end, ON_ORBIT));
        match outcome {
            Outcome::Done if on_unstable || steady != Some(true) => Err(Fate::Undecided),
            Outcome::Done => Ok(Verdict { regime, side, period }),
            _ => Err(Fate::Lost { spent: matches!(outcome, Outcome::StepBudget { .. }) }),
        }
    }

    /// The fate of a motion that was classified. The exponent of the first motion without a period, or of one
    /// of the next few, must confirm that it is irregular, since it may only settle slowly. An exponent does
    /// not distinguish it from a long irregular transient, whose length in a double well is random: so a
    /// motion is called irregular only after a thousand periods without another attractor.
    fn judged(&mut self, verdict: Verdict, summary: Box<Summary>, scope: &Stroboscope, way: Way) -> Fate {
        let kind = Kind::Judged(verdict);
        if verdict.period.is_none() && self.known_kind(kind).is_none() {
            let doubts = self.doubted.iter().filter(|other| **other == verdict).count();
            if doubts >= MAX_UNCONFIRMED || !scope.is_irregular(final_state(&summary)) {
                self.doubted.push(verdict);
                return Fate::Undecided;
            }
        }
        Fate::Kind(self.kind(kind, Some(summary)), way)
    }

    fn put(&mut self, item: Item, fate: Fate) {
        match item.after {
            Some((release, _)) => self.releases[release as usize].next = fate,
            None => self.fates[item.row] = fate,
        }
    }

    fn propose(&mut self, scope: &Stroboscope, period: u32, state: MapState) -> Result<()> {
        let known = self.captures.iter().any(|capture| capture.holds(state));
        let tried = self.rejected.iter().any(|rejected| is_near(scope, *rejected, state, SAME_PROPOSAL));
        if known || tried {
            return Ok(());
        }
        match find(scope, period, state)? {
            Found::Stable(captures)
                if self.captures.iter().any(|capture| capture.holds(captures[0].state)) =>
            {
                self.rejected.push(state);
            }
            Found::Stable(captures) => {
                let orbit = self.orbit_of.last().map_or(0, |last| last + 1);
                self.orbit_of.extend(captures.iter().map(|_| orbit));
                self.captures.extend(captures);
            }
            Found::Unstable(unstable) => {
                self.unstable.push(unstable);
                self.rejected.push(state);
            }
            Found::Nothing => self.rejected.push(state),
        }
        Ok(())
    }

    /// Searches for a region around the irregular motion through `state` that an item reaches.
    fn surround(&mut self, scope: &Stroboscope, item: Item, state: MapState) -> Result<()> {
        let fate = item.after.map_or(self.fates[item.row], |after| self.releases[after.0 as usize].next);
        let Fate::Kind(kind, _) = fate else { return Ok(()) };
        let irregular = matches!(self.kinds[kind as usize].0, Kind::Judged(Verdict { period: None, .. }));
        let searches = self.searches.iter().filter(|searched| **searched == kind).count();
        if !irregular || searches >= MAX_SEARCHES || self.is_surrounded(state) {
            return Ok(());
        }
        self.searches.push(kind);
        if let Some(region) = absorbing(scope, state, &self.captures)? {
            self.regions.push(region);
            self.region_of.push(kind);
        }
        Ok(())
    }

    fn is_surrounded(&self, state: MapState) -> bool {
        self.regions.iter().any(|region| region.holds((state.x, state.v)))
    }
}

fn is_near(scope: &Stroboscope, a: MapState, b: MapState, share: f64) -> bool {
    let units = scope.units().of_state();
    let off = [a.x - b.x, a.v - b.v, a.electrical - b.electrical];
    off.iter().zip(units).all(|(off, unit)| off.abs() <= share * unit)
}

/// Follows items with the attractors known so far, then adds the results; returns the items to follow next.
fn round(
    rounds: &mut Rounds,
    scope: &Stroboscope,
    starts: &Starts,
    items: Vec<Item>,
    task: &Task,
) -> Result<Vec<Item>> {
    let (known, regions) = (rounds.captures.clone(), rounds.regions.clone());
    let max_work = scope.effort.of_one(rounds.remaining);
    let pursuit =
        |item: &Item| item.pursuit(starts, scope.model.start_electrical(), &known, &regions, max_work);
    let pursuits: Vec<Pursuit> = items.iter().map(pursuit).collect();
    let tick = |pursuit: &Pursuit| {
        if pursuit.repeats_from == 0 && pursuit.releases == 0 {
            (task.tick)();
        }
    };
    let pursued = scope.pursue(&pursuits, &tick)?;
    let (mut next, mut proposals, mut unsettled) = (Vec::new(), Vec::new(), Vec::new());
    for (item, pursued) in items.into_iter().zip(pursued) {
        if let Arrival::Repeats { period, state } = pursued.arrival {
            proposals.push((period, state));
        }
        if let Arrival::Unsettled(end) = &pursued.arrival
            && end.outcome == Outcome::Done
        {
            unsettled.push((item, final_state(end)));
        }
        next.extend(rounds.note(item, pursued, scope));
    }
    for (period, state) in proposals {
        rounds.propose(scope, period, state)?;
    }
    for (item, state) in &unsettled {
        rounds.surround(scope, *item, *state)?;
    }
    // each is followed again, since it enters the region at a different time
    next.extend(
        unsettled.into_iter().filter(|(_, state)| rounds.is_surrounded(*state)).map(|(item, _)| item),
    );
    task.check_cancelled().map(|()| next)
}

impl Basins {
    /// Runs the starts of the next level, with a tick for each. False if cancelled; the map is then unusable.
    pub fn run_level(&mut self, pool: &Pool, task: &Task) -> bool {
        let Self { model, starts, levels, done, room, rounds, effort } = self;
        let scope = Stroboscope { model, room: *room, pool, cancel: task.cancel, effort };
        let mut begin = done.checked_sub(1).map_or(0, |before| levels.ends[before]);
        let Some(end) = levels.ends.get(*done).copied() else { return true };
        while begin < end {
            let last = (begin + rounds.next_round).min(end);
            rounds.next_round = (2 * rounds.next_round).min(MAX_ROUND);
            let mut items = Vec::with_capacity(last - begin);
            for row in levels.order[begin..last].iter().map(|row| *row as usize) {
                if is_inside(*room, starts.at(row).0) {
                    items.push(Item::of_start(row));
                } else {
                    rounds.fates[row] = Fate::Outside;
                    (task.tick)();
                }
            }
            while !items.is_empty() {
                let Ok(next) = round(rounds, &scope, starts, items, task) else { return false };
                items = next;
            }
            rounds.remaining -= last - begin;
            begin = last;
        }
        *done += 1;
        true
    }
}
