//! Sure answers of a map of basins: those that the error of the integration cannot change.
//!
//! Each start is followed once more at a much finer tolerance. The difference of the two runs is the error of
//! the first one, grown as the motion makes it grow. Near the stable manifold of a saddle, which is an edge
//! between basins, the motion leaves the saddle with a speed proportional to its distance from that edge, and
//! so does the error: where the motion has left, their ratio is that of the difference to the scales. If it
//! stays small up to the arrival, the start is farther from the edge than the error, on whichever side. Two
//! runs that go astray alike would have to make equal errors at tolerances that differ a thousandfold.

use std::collections::BTreeMap;

use super::rounds::{Fate, Item, MAX_ROUND, Rounds};
use super::stroboscopic::Stroboscope;
use super::{BasinMap, Starts};
use crate::dynamics::{Beside, MapState, Model, Pursuit, Trail};
use crate::study::Result;

/// Factor on the tolerance for the second run of a start, or its inverse if that is below the finest.
const FACTOR: f64 = 1e-3;

/// The finest tolerance at which the error is that of the method and not of rounding.
const FINEST: f64 = 1e-14;

/// Difference of the two runs of a start up to which they go together, as a share of the scales.
const TOGETHER: f64 = 0.1;

/// The model at the tolerance of the second runs.
pub(super) fn other(model: &Model) -> Model {
    let finer = FACTOR * model.tolerance();
    model.with_tolerance(if finer < FINEST { model.tolerance() / FACTOR } else { finer })
}

/// Whether motions, each with its states, go together with their runs in `scope` up to the same end.
pub(super) fn are_sure(
    rounds: &Rounds,
    scope: &Stroboscope,
    starts: &Starts,
    motions: &[(Item, Trail)],
) -> Result<Vec<bool>> {
    let [x, v, electrical] = scope.units().of_state().map(|unit| TOGETHER * unit);
    let within = MapState { x, v, electrical };
    let pursuits: Vec<Pursuit> = motions
        .iter()
        .map(|(item, trail)| Pursuit {
            repeats_from: Pursuit::NEVER,
            beside: Some(Beside { trail, within }),
            ..item.pursuit(starts, scope.electrical(), &rounds.captures, &rounds.regions)
        })
        .collect();
    let again = scope.pursue(&pursuits, &|_| ())?;
    let is_same = |(item, again): (&Item, _)| match (rounds.fate(item), rounds.known_fate(item, again, scope))
    {
        (Fate::Kind(kind, _), Some(Fate::Kind(other, _))) => kind == other,
        (Fate::Release(place, _), Some(Fate::Release(other, _))) => place == other,
        _ => false,
    };
    Ok(motions.iter().map(|(item, _)| item).zip(&again).map(is_same).collect())
}

/// Whether the motion after each release is sure, as the continuation of a sure start.
pub(super) fn sure_releases(
    rounds: &Rounds,
    (scope, other): (&Stroboscope, &Stroboscope),
    starts: &Starts,
) -> Result<Vec<bool>> {
    let mut sure = vec![false; rounds.releases.len()];
    let mut tried = sure.clone();
    // for each release, the continuation of a start that reaches it
    let mut next: BTreeMap<u32, Item> = BTreeMap::new();
    for (row, fate) in rounds.fates.iter().enumerate().filter(|(row, _)| rounds.sure[*row]) {
        if let Fate::Release(place, periods) = *fate {
            let after = Some((place, periods));
            next.entry(place).or_insert_with(|| Item { releases: 1, after, ..Item::of_start(row) });
        }
    }
    while !next.is_empty() {
        let items: Vec<Item> = std::mem::take(&mut next).into_values().collect();
        for part in items.chunks(MAX_ROUND) {
            let pursuit = |item: &Item| Pursuit {
                repeats_from: Pursuit::NEVER,
                ..item.pursuit(starts, scope.electrical(), &rounds.captures, &rounds.regions)
            };
            let pursuits: Vec<Pursuit> = part.iter().map(pursuit).collect();
            let trails = scope.pursue(&pursuits, &|_| ())?.into_iter().map(|pursued| pursued.trail);
            let motions: Vec<(Item, Trail)> = part.iter().copied().zip(trails).collect();
            for (item, is_sure) in part.iter().zip(are_sure(rounds, other, starts, &motions)?) {
                let Some((place, before)) = item.after else { continue };
                tried[place as usize] = true;
                sure[place as usize] = is_sure;
                if let Fate::Release(following, periods) = rounds.releases[place as usize].next
                    && is_sure
                    && !tried[following as usize]
                {
                    let after = Some((following, before.saturating_add(periods)));
                    next.insert(following, Item { releases: item.releases + 1, after, ..*item });
                }
            }
        }
        next.retain(|place, _| !tried[*place as usize]);
    }
    Ok(sure)
}

impl BasinMap {
    /// Whether the answer of each row is sure, with everything after the releases that it reaches; empty
    /// unless the map is checked and whole.
    pub(super) fn sure(&self) -> Vec<bool> {
        if self.finer.is_none() || !self.is_whole() {
            return Vec::new();
        }
        let releases = &self.rounds.releases;
        let chains: Vec<bool> = (0..releases.len())
            .map(|place| self.chain(place as u32).0.iter().all(|(passed, _)| releases[*passed as usize].sure))
            .collect();
        let after = |row: usize| match self.rounds.fates[row] {
            Fate::Release(place, _) => chains[place as usize],
            _ => true,
        };
        (0..self.rounds.fates.len()).map(|row| self.rounds.sure[row] && after(row)).collect()
    }
}
