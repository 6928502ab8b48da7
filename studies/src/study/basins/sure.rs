//! Sure answers of a map of basins: those that do not change at ten times the error of the integration.
//!
//! The attractor of a start near a basin boundary, or with a long irregular transient, depends on the
//! integration error. Such a start is followed once more at another tolerance. It may reach the same
//! attractor by chance, but hardly after the same number of crossings and periods.

use std::collections::BTreeMap;

use super::rounds::{Fate, Item, Kind, MAX_ROUND, PATIENCE, Way};
use super::stroboscopic::Stroboscope;
use super::{Answer, Basins};
use crate::dynamics::{Place, Pursuit};
use crate::scene::TOLERANCES;
use crate::study::{Result, Task};
use crate::system::threads::Pool;

/// Factor on the tolerance for the second run of a start, or its inverse if that is beyond the largest one.
const FACTOR: f64 = 10.0;

impl Basins {
    /// The rows that [`check`](Self::check) follows once more: in a grid those whose neighbours (up to eight)
    /// do not all reach the same attractor after the same number of periods, otherwise all. Precondition: the
    /// map is complete.
    pub fn rows_to_check(&self, answer: &Answer) -> Vec<usize> {
        let rows = &answer.rows;
        let settled = (0..rows.len()).filter(|row| rows[*row].is_some());
        let Some((x_mm, v)) = self.starts.axes() else { return settled.collect() };
        let around = |place: usize, count: usize| place.saturating_sub(1)..(place + 2).min(count);
        let alike = |row: &usize| {
            let (across, up) = (row / v.len(), row % v.len());
            let mut near = around(across, x_mm.len())
                .flat_map(|column| around(up, v.len()).map(move |place| column * v.len() + place));
            near.all(|neighbour| rows[neighbour] == rows[*row])
        };
        let is_line = x_mm.len() == 1 || v.len() == 1;
        settled.filter(|row| is_line || !alike(row)).collect()
    }

    /// Marks the answers that are sure, with a tick for each start that is followed once more; false if
    /// cancelled.
    ///
    /// A start is sure if at ten times the tolerance it reaches the same attractor after the same number of
    /// crossings and, unless that is the only attractor in one of two wells, the same number of periods; or
    /// if it is not among [`rows_to_check`](Self::rows_to_check). If it reaches a release, everything after
    /// the release must be sure as well.
    pub fn check(&self, answer: &mut Answer, pool: &Pool, task: &Task) -> bool {
        let finer = FACTOR * self.model.tolerance() > TOLERANCES.1;
        let factor = if finer { 1.0 / FACTOR } else { FACTOR };
        let model = self.model.with_tolerance(factor * self.model.tolerance());
        let Self { room, effort, .. } = self;
        let scope = Stroboscope { model: &model, room: *room, pool, cancel: task.cancel, effort };
        let mut sure = vec![true; answer.rows.len()];
        let items: Vec<Item> = self.rows_to_check(answer).into_iter().map(Item::of_start).collect();
        for part in items.chunks(MAX_ROUND) {
            let Ok(fates) = self.follow_again(&scope, part, &|| (task.tick)()) else { return false };
            for (item, again) in part.iter().zip(fates) {
                let first = self.rounds.fates[item.row];
                let alone = self.is_alone(answer, item.row);
                sure[item.row] = self.is_same(first, Way::default(), again, alone);
            }
        }
        let Ok(releases) = self.sure_releases(&scope, answer, &sure) else { return false };
        let chains: Vec<bool> = (0..releases.len())
            .map(|place| self.chain(place as u32).0.iter().all(|(passed, _)| releases[*passed as usize]))
            .collect();
        for (row, sure) in sure.iter_mut().enumerate() {
            if let Fate::Release(place, _) = self.rounds.fates[row] {
                *sure &= chains[place as usize];
            }
        }
        answer.sure = sure;
        true
    }

    /// For each release, whether the motion after it is sure, as the continuation of a sure start.
    fn sure_releases(&self, scope: &Stroboscope, answer: &Answer, sure: &[bool]) -> Result<Vec<bool>> {
        let mut known = vec![false; self.rounds.releases.len()];
        // for each release, the continuation of a start that reaches it
        let mut next: BTreeMap<u32, Item> = BTreeMap::new();
        for (row, fate) in self.rounds.fates.iter().enumerate().filter(|(row, _)| sure[*row]) {
            if let Fate::Release(place, way) = *fate {
                let item = || Item { releases: 1, after: Some((place, way)), ..Item::of_start(row) };
                next.entry(place).or_insert_with(item);
            }
        }
        let mut tried = vec![false; known.len()];
        while !next.is_empty() {
            let items: Vec<Item> = std::mem::take(&mut next).into_values().collect();
            for part in items.chunks(MAX_ROUND) {
                for (item, again) in part.iter().zip(self.follow_again(scope, part, &|| ())?) {
                    let Some((place, before)) = item.after else { continue };
                    tried[place as usize] = true;
                    let first = self.rounds.releases[place as usize].next;
                    let same = self.is_same(first, before, again, self.is_alone(answer, item.row));
                    known[place as usize] = same;
                    if let Fate::Release(following, way) = first
                        && same
                        && !tried[following as usize]
                    {
                        let after = Some((following, before.and(way)));
                        next.insert(following, Item { releases: item.releases + 1, after, ..*item });
                    }
                }
            }
            next.retain(|place, _| !tried[*place as usize]);
        }
        Ok(known)
    }

    /// The fates of items that are followed again in `scope`; `None` if not known.
    fn follow_again(
        &self,
        scope: &Stroboscope,
        items: &[Item],
        tick: &(dyn Fn() + Sync),
    ) -> Result<Vec<Option<Fate>>> {
        let (known, regions) = (&self.rounds.captures, &self.rounds.regions);
        let max_work = scope.effort.of_one(items.len());
        let endless = |item: &Item| Item { repeats_from: Pursuit::NEVER, ..*item };
        let pursuits: Vec<Pursuit> = items
            .iter()
            .map(|item| {
                endless(item).pursuit(&self.starts, scope.model.start_electrical(), known, regions, max_work)
            })
            .collect();
        let all = scope.pursue(&pursuits, &|_| tick())?;
        Ok(items.iter().zip(&all).map(|(item, end)| self.rounds.known_fate(item, end, scope)).collect())
    }

    /// Whether the second run of a motion agrees with the first one after `before`; if its attractor is
    /// `alone` in its well, equal numbers of crossings suffice.
    fn is_same(&self, first: Fate, before: Way, again: Option<Fate>, alone: bool) -> bool {
        match (first, again) {
            (Fate::Kind(kind, way), Some(Fate::Kind(other, now))) if kind == other => {
                let judged = matches!(self.rounds.kinds[kind as usize].0, Kind::Judged(_));
                let longest = way.periods.max(now.periods).saturating_add(before.periods);
                // the counts of an irregular motion that was followed to the end have no meaning
                let ended = judged && u64::from(longest) >= PATIENCE;
                ended || way.crossings == now.crossings && (alone || way.periods == now.periods)
            }
            (Fate::Release(place, way), Some(Fate::Release(other, now))) => place == other && way == now,
            _ => false,
        }
    }

    /// Whether the attractor of a row is the only one on its side of the barrier between two wells.
    fn is_alone(&self, answer: &Answer, row: usize) -> bool {
        let wells = self.model.mechanism().landscape.equilibria.iter().filter(|place| place.stable).count();
        let side = answer.rows[row].and_then(|(number, _)| answer.attractors[number as usize - 1].side);
        let beside = || answer.attractors.iter().filter(|other| other.side == side).count();
        wells == 2 && matches!(side, Some(Place::Left | Place::Right)) && beside() == 1
    }
}
