//! Absorbing regions: cells of the phase plane around an irregular attractor that no motion leaves.
//!
//! The region begins with the cells that long motions visit at the strobes, and their neighbours. Each cell
//! into which the stroboscopic map takes a corner or the centre of a known cell is added, until no further
//! cell is found. If this terminates, all motions in the cells stay there. If it does not, the motion can
//! escape, as a long irregular transient does, and there is no region. Beside a circuit there is none either:
//! every irregular motion is then followed to the end.

use std::collections::BTreeSet;

use super::stroboscopic::Stroboscope;
use crate::dynamics::{Capture, MapState, Region};
use crate::numeric::extent;
use crate::study::Result;

/// Number of motions that are followed to find an attractor.
const MOTIONS: usize = 16;
/// Number of forcing periods of each motion.
const PERIODS: u32 = 500;
/// Number of first periods that are left out.
const SKIPPED: usize = 50;

/// Distance of their starts, as a share of the scales; irregular motions diverge from it.
const APART: f64 = 1e-6;

/// Numbers of cells along each side of the extent of an attractor that are tried.
const ALONG: [f64; 3] = [48.0, 96.0, 192.0];
const MAX_CELLS: usize = 20_000;

/// Largest number of rounds in which cells are added.
const ROUNDS: usize = 40;

/// A region around the irregular motion through `state`; `None` if there is none, or near a known orbit.
pub(super) fn absorbing(scope: &Stroboscope, state: MapState, known: &[Capture]) -> Result<Option<Region>> {
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
    let Some(states) = scope.paths(&starts, PERIODS, SKIPPED)? else { return Ok(None) };
    if states.iter().any(|state| known.iter().any(|other| other.holds(*state))) {
        return Ok(None);
    }
    let (left, right) = extent(states.iter().map(|state| state.x));
    let (low, high) = extent(states.iter().map(|state| state.v));
    if !(right > left && high > low) {
        return Ok(None);
    }
    for along in ALONG {
        let size = ((right - left) / along, (high - low) / along);
        let region = Region { corner: (left, low), size, cells: Vec::new() };
        if let Some(whole) = closed(scope, region, &states, known)? {
            return Ok(Some(whole));
        }
    }
    Ok(None)
}

/// The region of the cells of these states and all cells that motions from there reach.
fn closed(
    scope: &Stroboscope,
    region: Region,
    states: &[MapState],
    known: &[Capture],
) -> Result<Option<Region>> {
    let mut cells: BTreeSet<(i32, i32)> = BTreeSet::new();
    for (i, j) in states.iter().map(|state| region.cell((state.x, state.v))) {
        cells.extend((-1..=1).flat_map(|right| (-1..=1).map(move |up| (i + right, j + up))));
    }
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
            if known.iter().any(|capture| capture.holds(image)) {
                return Ok(None);
            }
            let cell = region.cell((image.x, image.v));
            if cells.insert(cell) {
                new.push(cell);
            }
        }
        if new.is_empty() {
            return Ok(Some(Region { cells: cells.into_iter().collect(), ..region }));
        }
        if cells.len() > MAX_CELLS {
            break;
        }
    }
    Ok(None)
}
