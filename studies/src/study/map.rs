//! Lines of a map at which motions begin to cross.

use super::amplitudes::AMPLITUDE;
use super::grid::{Grid, name_of};
use super::table::{Table, Values};
use crate::dynamics::{Regime, STANDARD_GRAVITY};
use crate::mechanics::Mechanism;
use crate::numeric::extent;
use crate::scene::{Axis, Excitation, Scene, Start};

/// The travel limit, over which the release is known in closed form.
const LIMIT: &str = "stops.travel_limit_mm";

/// Points of the line of releases.
const POINTS: usize = 400;

/// `travel_limit_mm,amplitude_g`: the least amplitude of a sine that frees a mass from the stop that it
/// rests on, in closed form: mass times base acceleration reaches the force that presses it there,
/// amplitude = |F(D)|/m.
///
/// Only for a grid over these two fields, from rest; only for travel limits inside the right-hand
/// well, because further out the mass rests in the well and not on the stop.
pub fn release_line(scene: &Scene, mechanism: &Mechanism, grid: &Grid) -> Option<Table> {
    let applies = scene.stops.travel_limit_mm().is_some()
        && matches!(scene.excitation, Excitation::Sine { .. })
        && scene.start == Start::Rest;
    let limits = axis(grid, LIMIT).filter(|_| applies && axis(grid, AMPLITUDE).is_some())?;
    let well = mechanism.landscape.right_stable()?.x;
    let (from, last) = extent(limits.values.iter().copied());
    let to = last.min(well * 1e3);
    if from >= to {
        return None;
    }
    let place = |i: usize| from + (to - from) * i as f64 / (POINTS - 1) as f64;
    // Pressed outward only: a force that pulls inward lets the mass go at once.
    let pressed = |mm: f64| (-mechanism.curve.force(mm / 1e3)).max(0.0);
    let mass = scene.mass_g / 1e3;
    let limits: Vec<f64> = (0..POINTS).map(place).collect();
    let amplitudes = limits.iter().map(|mm| pressed(*mm) / mass / STANDARD_GRAVITY).collect();
    let table = Table::new().with("travel_limit_mm", Values::Numbers(limits));
    Some(table.with("amplitude_g", Values::Numbers(amplitudes)))
}

/// For each value of the other field the least amplitude, 0 or above, whose cell crosses; NaN
/// where there is none. The two columns are called as in the sweep, the other field first.
///
/// Only for a grid over two fields of which one is an amplitude. `rows` are all rows of the sweep.
pub fn first_crossing(grid: &Grid, rows: &Table) -> Option<Table> {
    let [a, b] = grid.axes() else { return None };
    let amplitude = |axis: &Axis| name_of(&axis.field) == "amplitude_g";
    let (other, amplitude_axis) = match (amplitude(a), amplitude(b)) {
        (false, true) => (0, 1),
        (true, false) => (1, 0),
        _ => return None,
    };
    let swept = rows.numbers(&grid.columns()[other])?;
    let amplitudes = rows.numbers(&grid.columns()[amplitude_axis])?;
    let Values::Words(regimes) = &rows.column("regime")?.values else { return None };
    let mut values = grid.axes()[other].values.clone();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let mut least = vec![f64::NAN; values.len()];
    for (i, other) in swept.iter().enumerate() {
        let counts = regimes.get(i).is_some_and(|regime| crosses(regime)) && amplitudes[i] >= 0.0;
        if let Ok(place) = values.binary_search_by(|value| value.total_cmp(other))
            && counts
        {
            // f64::min ignores the NaN of a place that has none yet.
            least[place] = least[place].min(amplitudes[i]);
        }
    }
    let table = Table::new().with(&grid.columns()[other], Values::Numbers(values));
    Some(table.with(&grid.columns()[amplitude_axis], Values::Numbers(least)))
}

/// Whether a regime is one of motions that cross at all.
fn crosses(regime: &str) -> bool {
    [Regime::Interwell, Regime::Irregular, Regime::Crossing].iter().any(|known| known.name() == regime)
}

fn axis<'a>(grid: &'a Grid, field: &str) -> Option<&'a Axis> {
    grid.axes().iter().find(|axis| axis.field == field && grid.axes().len() == 2)
}
