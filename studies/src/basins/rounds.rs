//! Rounds of a map of basins: starts are followed in rounds, between which the known attractors are updated.

use super::map::is_inside;
use super::orbit::{Rejected, find, is_near};
use super::region::{Irregular, irregular};
use super::stroboscopic::{START_WORK, Stroboscope, final_state};
use super::sure::{are_sure, sure_releases};
use super::{BasinMap, Starts};
use crate::dynamics::{
    Arrival, Capture, MapState, Outcome, Place, Pursued, Pursuit, Regime, Region, ReleaseIdentity, Side,
    Summary,
};
use crate::study::{Result, Task, settled};
use crate::system::threads::Pool;

/// Number of forcing periods after which a motion that has reached no known attractor is classified.
pub(super) const PATIENCE: u64 = settled::PATIENCE as u64;

/// A motion to follow: that of a start, or its continuation after a number of releases.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item {
    pub row: usize,
    pub releases: u32,
    /// The release that it continues, and the number of forcing periods up to there.
    pub after: Option<(u32, u32)>,
    pub repeats_from: u64,
}

impl Item {
    pub fn of_start(row: usize) -> Self {
        Self { row, releases: 0, after: None, repeats_from: 0 }
    }

    /// The number of forcing periods of a pursuit since the release that it continues.
    fn periods(&self, pursued: &Pursued) -> u32 {
        let whole = u32::try_from(pursued.periods.unwrap_or(PATIENCE)).unwrap_or(u32::MAX);
        whole.saturating_sub(self.after.map_or(0, |(_, before)| before))
    }

    /// The pursuit of the motion from this state of the circuit.
    pub fn pursuit<'a>(
        &self,
        starts: &Starts,
        electrical: f64,
        known: &'a [Capture],
        regions: &'a [Region],
    ) -> Pursuit<'a> {
        let (x_mm, v) = starts.at(self.row);
        Pursuit {
            start: MapState { x: x_mm / 1e3, v, electrical },
            known,
            regions,
            repeats_from: self.repeats_from,
            max_periods: PATIENCE,
            releases: self.releases,
            max_work: START_WORK,
            beside: None,
        }
    }
}

/// Number of starts in the first round of a map: rounds are short while few attractors are known.
const FIRST_ROUND: usize = 64;
pub(super) const MAX_ROUND: usize = 8192;

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

impl Verdict {
    /// The verdict on a motion that has reached its last period and repeats, or is steady without repeating.
    fn of(&Summary { outcome, steady, regime, side, period, .. }: &Summary) -> Option<Self> {
        (outcome == Outcome::Done && steady == Some(true)).then_some(Self { regime, side, period })
    }

    /// The same for one that does not repeat.
    pub fn of_irregular(summary: &Summary) -> Option<Self> {
        Self::of(summary).filter(|verdict| verdict.period.is_none())
    }
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
    /// It reaches this kind of motion, after this number of forcing periods.
    Kind(u32, u32),
    /// It reaches this release, likewise.
    Release(u32, u32),
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
    /// Whether the motion after it is sure up to its attractor or the next release.
    pub sure: bool,
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
    /// Orbits that no motion can be told by.
    rejected: Rejected,
    /// The irregular motions of the scene, once one was met: each verdict, and whether it was confirmed.
    irregular: Option<Vec<(Verdict, bool)>>,
    /// Regions around irregular motions.
    pub regions: Vec<Region>,
    /// The kind of each region.
    region_of: Vec<u32>,
    /// Whether the motion of each start is sure up to its attractor or its first release.
    pub sure: Vec<bool>,
    next_round: usize,
}

impl Rounds {
    pub fn new(starts: usize) -> Self {
        let fates = vec![Fate::NotRun; starts];
        Self { fates, next_round: FIRST_ROUND, sure: vec![false; starts], ..Self::default() }
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
            self.releases.push(Release { identity, next: Fate::NotRun, sure: false });
        }
        (place.unwrap_or(self.releases.len() as u32 - 1), place.is_none())
    }

    fn known_release(&self, identity: ReleaseIdentity) -> Option<u32> {
        self.releases.iter().position(|release| release.identity == identity).map(|place| place as u32)
    }

    /// The fate of an item.
    pub fn fate(&self, item: &Item) -> Fate {
        item.after.map_or(self.fates[item.row], |(place, _)| self.releases[place as usize].next)
    }

    /// Records the result of an item; returns the item that continues it, if its fate depends on one.
    fn note(&mut self, item: Item, pursued: &Pursued, scope: &Stroboscope) -> Option<Item> {
        let periods = item.periods(pursued);
        let fate = match &pursued.arrival {
            Arrival::Captured(which) => {
                Fate::Kind(self.kind(Kind::Orbit(self.orbit_of[*which]), None), periods)
            }
            Arrival::Entered(which) => Fate::Kind(self.region_of[*which], periods),
            Arrival::Rests(side) => Fate::Kind(self.kind(Kind::Rest(*side), None), periods),
            Arrival::Released(identity) => {
                let (place, new) = self.release(*identity);
                self.put(item, Fate::Release(place, periods));
                let after = Some((place, item.after.map_or(0, |(_, before)| before).saturating_add(periods)));
                return new.then_some(Item { releases: item.releases + 1, after, repeats_from: 0, ..item });
            }
            Arrival::Repeats { .. } => {
                return Some(Item { repeats_from: 2 * pursued.periods?, ..item });
            }
            Arrival::Parted => Fate::Undecided,
            Arrival::Unsettled(summary) => match self.verdict(summary, scope) {
                Ok(verdict) => self.judged(verdict, summary, scope, periods),
                Err(fate) => fate,
            },
        };
        self.put(item, fate);
        None
    }

    /// The fate of an item that was followed once more; `None` if its attractor is not among the known ones.
    pub fn known_fate(&self, item: &Item, pursued: &Pursued, scope: &Stroboscope) -> Option<Fate> {
        let kind = match &pursued.arrival {
            Arrival::Captured(which) => self.known_kind(Kind::Orbit(self.orbit_of[*which])),
            Arrival::Entered(which) => Some(self.region_of[*which]),
            Arrival::Rests(side) => self.known_kind(Kind::Rest(*side)),
            Arrival::Unsettled(summary) => {
                let verdict = self.verdict(summary, scope).ok();
                verdict.and_then(|verdict| self.known_kind(Kind::Judged(verdict)))
            }
            Arrival::Released(identity) => {
                let place = self.known_release(*identity);
                return place.map(|place| Fate::Release(place, item.periods(pursued)));
            }
            Arrival::Repeats { .. } | Arrival::Parted => None,
        };
        kind.map(|kind| Fate::Kind(kind, item.periods(pursued)))
    }

    /// The verdict on a motion that has reached no known attractor, from the summary of its pursuit, whose
    /// window is its last hundred forcing periods; its fate if it ended early or its attractor is not known.
    fn verdict(&self, summary: &Summary, scope: &Stroboscope) -> Result<Verdict, Fate> {
        let end = final_state(summary);
        let on_unstable = || self.rejected.unstable.iter().any(|state| is_near(scope, *state, end, ON_ORBIT));
        match summary.outcome {
            Outcome::Done => Verdict::of(summary).filter(|_| !on_unstable()).ok_or(Fate::Undecided),
            outcome => Err(Fate::Lost { spent: matches!(outcome, Outcome::StepBudget { .. }) }),
        }
    }

    /// The fate of a motion that was classified. Its exponent, or that of a motion with the same verdict
    /// among the irregular ones of the scene, must confirm that it is irregular, since it may only settle
    /// slowly. An exponent does not distinguish it from a long irregular transient, whose length in a double
    /// well is random: so a motion is called irregular only after a thousand periods without another
    /// attractor.
    fn judged(&mut self, verdict: Verdict, summary: &Summary, scope: &Stroboscope, periods: u32) -> Fate {
        if verdict.period.is_none() {
            let known = self.irregular.iter().flatten().find(|(known, _)| *known == verdict);
            let confirmed = known.map(|(_, is_confirmed)| *is_confirmed);
            if !confirmed.unwrap_or_else(|| scope.is_irregular(final_state(summary))) {
                return Fate::Undecided;
            }
        }
        Fate::Kind(self.kind(Kind::Judged(verdict), Some(Box::new(*summary))), periods)
    }

    fn put(&mut self, item: Item, fate: Fate) {
        match item.after {
            Some((release, _)) => self.releases[release as usize].next = fate,
            None => self.fates[item.row] = fate,
        }
    }

    fn propose(&mut self, scope: &Stroboscope, period: u32, state: MapState) -> Result<()> {
        let holds = |all: &[Capture], state| all.iter().any(|capture| capture.holds(state));
        if holds(&self.captures, state) {
            return Ok(());
        }
        let found = find(scope, period, state, &mut self.rejected)?;
        if let Some(captures) = found.filter(|found| !holds(&self.captures, found[0].state)) {
            let orbit = self.orbit_of.last().map_or(0, |last| last + 1);
            self.orbit_of.extend(captures.iter().map(|_| orbit));
            self.captures.extend(captures);
        }
        Ok(())
    }

    /// Looks for the irregular motions of the scene when the first start has reached one.
    fn look_for_irregular(&mut self, scope: &Stroboscope, pursued: &[Pursued]) -> Result<()> {
        let is_irregular = |pursued: &Pursued| match &pursued.arrival {
            Arrival::Unsettled(summary) => Verdict::of_irregular(summary).is_some(),
            _ => false,
        };
        if self.irregular.is_some() || !pursued.iter().any(is_irregular) {
            return Ok(());
        }
        let mut found = Vec::new();
        for Irregular { verdict, summary, is_confirmed, regions } in irregular(scope)? {
            found.push((verdict, is_confirmed));
            if is_confirmed {
                let kind = self.kind(Kind::Judged(verdict), Some(summary));
                self.region_of.extend(regions.iter().map(|_| kind));
                self.regions.extend(regions);
            }
        }
        self.irregular = Some(found);
        Ok(())
    }

    fn is_surrounded(&self, state: MapState) -> bool {
        self.regions.iter().any(|region| region.holds((state.x, state.v)))
    }
}

/// Follows items with the attractors known so far, then adds the results; returns the items to follow next.
fn round(
    rounds: &mut Rounds,
    (scope, finer): (&Stroboscope, Option<&Stroboscope>),
    starts: &Starts,
    items: Vec<Item>,
    task: &Task,
) -> Result<Vec<Item>> {
    let pursuit = |item: &Item| item.pursuit(starts, scope.electrical(), &rounds.captures, &rounds.regions);
    let pursuits: Vec<Pursuit> = items.iter().map(pursuit).collect();
    let tick = |pursuit: &Pursuit| {
        if pursuit.repeats_from == 0 && pursuit.releases == 0 {
            (task.tick)();
        }
    };
    let pursued = scope.pursue(&pursuits, &tick)?;
    let known_regions = rounds.regions.len();
    rounds.look_for_irregular(scope, &pursued)?;
    let (mut next, mut proposals, mut arrived) = (Vec::new(), Vec::new(), Vec::new());
    for (item, pursued) in items.into_iter().zip(pursued) {
        match &pursued.arrival {
            Arrival::Repeats { period, state } => proposals.push((*period, *state)),
            Arrival::Unsettled(end)
                if rounds.regions.len() > known_regions && rounds.is_surrounded(final_state(end)) =>
            {
                // it is followed again, to learn when it enters the region
                next.push(Item { repeats_from: Pursuit::NEVER, ..item });
                continue;
            }
            _ => {}
        }
        next.extend(rounds.note(item, &pursued, scope));
        if item.after.is_none() {
            arrived.push((item, pursued.trail));
        }
    }
    for (period, state) in proposals {
        rounds.propose(scope, period, state)?;
    }
    if let Some(finer) = finer {
        arrived.retain(|(item, _)| matches!(rounds.fate(item), Fate::Kind(..) | Fate::Release(..)));
        for ((item, _), is_sure) in arrived.iter().zip(are_sure(rounds, finer, starts, &arrived)?) {
            rounds.sure[item.row] = is_sure;
        }
    }
    task.check_cancelled().map(|()| next)
}

impl BasinMap {
    /// Runs the starts of the next level, with a tick for each. False if cancelled; the map is then unusable.
    pub fn run_level(&mut self, pool: &Pool, task: &Task) -> bool {
        self.level(pool, task).is_ok()
    }

    fn level(&mut self, pool: &Pool, task: &Task) -> Result<()> {
        let Self { model, finer, starts, levels, done, room, rounds, work_of_a_period, .. } = self;
        let of = |model| {
            let (room, work_of_a_period) = (*room, *work_of_a_period);
            Stroboscope { model, room, pool, cancel: task.cancel, work_of_a_period }
        };
        let (scope, finer) = (of(&*model), finer.as_ref().map(of));
        let mut begin = done.checked_sub(1).map_or(0, |before| levels.ends[before]);
        let Some(end) = levels.ends.get(*done).copied() else { return Ok(()) };
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
                items = round(rounds, (&scope, finer.as_ref()), starts, items, task)?;
            }
            begin = last;
        }
        *done += 1;
        if let Some(finer) = finer.filter(|_| *done == levels.ends.len()) {
            let sure = sure_releases(rounds, (&scope, &finer), starts)?;
            rounds.releases.iter_mut().zip(sure).for_each(|(release, sure)| release.sure = sure);
        }
        Ok(())
    }
}
