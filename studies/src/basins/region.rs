//! Irregular attractors, and absorbing regions: cells of the phase plane around one that no motion leaves.
//!
//! They are looked for from a few starts of their own, so that no answer depends on the starts of a map. The
//! region begins with the cells that long motions visit at the strobes, and their neighbours. Each cell
//! into which the stroboscopic map takes a corner or the centre of a known cell is added, until no further
//! cell is found. If this terminates, all motions in the cells stay there. If it does not, the motion can
//! escape, as a long irregular transient does, and there is no region. Beside a circuit there is none either:
//! every irregular motion is then followed to the end.

use std::collections::BTreeSet;

use super::orbit::is_near;
use super::rounds::{PATIENCE, Verdict};
use super::stroboscopic::{START_WORK, Stroboscope, final_state};
use crate::dynamics::{Arrival, MapState, Pursuit, Region, Summary};
use crate::numeric::extent;
use crate::study::Result;

/// Displacements and velocities, in units of the scales, of the starts from which irregular motions are
/// looked for. The barrier is at 0 or near it; no two starts mirror each other.
const SEEDS: [f64; 4] = [-0.9, -0.35, 0.3, 0.8];

/// Number of regions that are looked for.
const MAX_SEARCHES: usize = 4;

/// A kind of irregular motion that the starts of this search reach.
pub(super) struct Irregular {
    pub verdict: Verdict,
    pub summary: Box<Summary>,
    /// Whether the exponent of one of the motions is above 0: otherwise they may only settle slowly.
    pub is_confirmed: bool,
    pub regions: Vec<Region>,
}

/// The kinds of irregular motion of a scene, with the regions around them.
pub(super) fn irregular(scope: &Stroboscope) -> Result<Vec<Irregular>> {
    let [x, _, w] = scope.point(MapState { electrical: scope.electrical(), ..scope.model.start().into() });
    let point = |right: f64, up: f64| [x + right, up, w];
    let seeds = SEEDS.iter().flat_map(|right| SEEDS.map(|up| point(*right, up)));
    let pursuits: Vec<Pursuit> = seeds
        .filter(|point| scope.has(*point))
        .map(|point| Pursuit {
            start: scope.state(point),
            known: &[],
            regions: &[],
            repeats_from: 0,
            max_periods: PATIENCE,
            releases: u32::MAX,
            max_work: START_WORK,
            beside: None,
        })
        .collect();
    let mut kinds: Vec<Irregular> = Vec::new();
    let mut searches = 0;
    for pursued in scope.pursue(&pursuits, &|_| ())? {
        let Arrival::Unsettled(summary) = pursued.arrival else { continue };
        let Some(verdict) = Verdict::of_irregular(&summary) else { continue };
        let end = final_state(&summary);
        let place = kinds.iter().position(|kind| kind.verdict == verdict).unwrap_or_else(|| {
            kinds.push(Irregular { verdict, summary, is_confirmed: false, regions: Vec::new() });
            kinds.len() - 1
        });
        kinds[place].is_confirmed = kinds[place].is_confirmed || scope.is_irregular(end);
        let is_inside = |kind: &Irregular| kind.regions.iter().any(|region| region.holds((end.x, end.v)));
        if kinds[place].is_confirmed && searches < MAX_SEARCHES && !kinds.iter().any(is_inside) {
            searches += 1;
            kinds[place].regions.extend(absorbing(scope, end)?);
        }
    }
    Ok(kinds)
}

/// Number of motions that are followed to find an attractor.
const MOTIONS: usize = 16;
/// Number of forcing periods of each motion.
const PERIODS: u32 = 500;
/// Number of first periods that are left out.
const SKIPPED: usize = 50;

/// Number of motions that are followed from cells that no long motion visits.
const ADDED: usize = 64;
/// Longest period of an orbit that is looked for in a region.
const LONGEST: usize = 12;
/// Distance below which two states are the same, as a share of the scales: far below that of an irregular
/// motion to itself some periods earlier, far above that of a motion to its orbit after many periods.
const SAME: f64 = 1e-6;

/// Distance of their starts, as a share of the scales; irregular motions diverge from it.
const APART: f64 = 1e-6;

/// Numbers of cells along each side of the extent of an attractor that are tried.
const ALONG: [f64; 3] = [48.0, 96.0, 192.0];
const MAX_CELLS: usize = 20_000;

/// Largest number of rounds in which cells are added.
const ROUNDS: usize = 40;

/// A region around the irregular motion through `state`; `None` if there is none, or a motion in it repeats.
fn absorbing(scope: &Stroboscope, state: MapState) -> Result<Option<Region>> {
    // the cells are those of a plane
    if scope.size() == 3 {
        return Ok(None);
    }
    let [x, v, w] = scope.point(state);
    let starts: Vec<MapState> = (0..MOTIONS)
        .map(|number| [x, v + APART * number as f64, w])
        .filter(|point| scope.has(*point))
        .map(|point| scope.state(point))
        .collect();
    let Some(states) = unrepeated(scope, &starts)? else { return Ok(None) };
    let (left, right) = extent(states.iter().map(|state| state.x));
    let (low, high) = extent(states.iter().map(|state| state.v));
    if !(right > left && high > low) {
        return Ok(None);
    }
    for along in ALONG {
        let size = ((right - left) / along, (high - low) / along);
        let region = Region { corner: (left, low), size, cells: Vec::new() };
        if let Some(whole) = closed(scope, region, &states)? {
            return Ok(Some(whole));
        }
    }
    Ok(None)
}

/// The states of motions over many periods; `None` if one ends early or repeats.
fn unrepeated(scope: &Stroboscope, starts: &[MapState]) -> Result<Option<Vec<MapState>>> {
    let states = scope.paths(starts, PERIODS, SKIPPED)?;
    let repeats = |path: &[MapState]| {
        path.split_last().is_some_and(|(last, before)| {
            before.iter().rev().take(LONGEST).any(|state| is_near(scope, *state, *last, SAME))
        })
    };
    Ok(states.filter(|states| !states.chunks(PERIODS as usize - SKIPPED).any(repeats)))
}

/// The region of the cells of these states and all cells that motions from there reach.
fn closed(scope: &Stroboscope, region: Region, states: &[MapState]) -> Result<Option<Region>> {
    let mut cells: BTreeSet<(i32, i32)> = BTreeSet::new();
    for (i, j) in states.iter().map(|state| region.cell((state.x, state.v))) {
        cells.extend((-1..=1).flat_map(|right| (-1..=1).map(move |up| (i + right, j + up))));
    }
    let visited = cells.clone();
    let (mut new, mut seen): (Vec<_>, BTreeSet<(i32, i32)>) =
        (cells.iter().copied().collect(), BTreeSet::new());
    for _ in 0..ROUNDS {
        // corners and middles, in half cells
        let halves = new.iter().flat_map(|(i, j)| {
            [(0, 0), (2, 0), (0, 2), (2, 2), (1, 1)].map(|(right, up)| (2 * i + right, 2 * j + up))
        });
        let unseen: BTreeSet<(i32, i32)> = halves.filter(|half| !seen.contains(half)).collect();
        let place = |(i, j): &(i32, i32)| {
            let (x, v) = (f64::from(*i) * 0.5 * region.size.0, f64::from(*j) * 0.5 * region.size.1);
            scope.point((region.corner.0 + x, region.corner.1 + v).into())
        };
        let starts: Vec<_> =
            unseen.iter().map(place).filter(|point| scope.has(*point)).map(|point| (point, 1)).collect();
        seen.extend(unseen);
        let Some(images) = scope.map(&starts)?.into_iter().collect::<Option<Vec<_>>>() else {
            return Ok(None);
        };
        new.clear();
        for image in images.into_iter().map(|point| scope.state(point)) {
            let cell = region.cell((image.x, image.v));
            if cells.insert(cell) {
                new.push(cell);
            }
        }
        if new.is_empty() {
            // cells beyond those of the long motions may belong to the basin of an orbit
            let added: Vec<(i32, i32)> = cells.difference(&visited).copied().collect();
            let some = added.iter().step_by(added.len().div_ceil(ADDED).max(1));
            let middle = |(i, j): &(i32, i32)| scope.state(place(&(2 * i + 1, 2 * j + 1)));
            let starts: Vec<MapState> =
                some.map(middle).filter(|state| scope.has(scope.point(*state))).collect();
            let holds_orbit = unrepeated(scope, &starts)?.is_none();
            return Ok((!holds_orbit).then(|| Region { cells: cells.into_iter().collect(), ..region }));
        }
        if cells.len() > MAX_CELLS {
            break;
        }
    }
    Ok(None)
}
