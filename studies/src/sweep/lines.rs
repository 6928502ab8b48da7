//! Cells of a map, and the lines at which motions begin to cross.

use serde::{Deserialize, Serialize};

use crate::dynamics::Regime;
use crate::mechanics::Mechanism;
use crate::numeric::extent;
use crate::scene::{Axis, Scene, Start};
use crate::study::grid::name_of;
use crate::study::{Grid, Table, Values};

/// The travel limit, over which the release is known in closed form.
const LIMIT: &str = "stops.travel_limit_mm";

const CROSS: [&str; 3] = [Regime::Interwell.name(), Regime::Irregular.name(), Regime::Crossing.name()];

/// Points of the line of releases.
const POINTS: usize = 400;

/// `travel_limit_mm` and the amplitude of the drive, such as `amplitude_g`: the smallest that releases a mass
/// from the stop on which it rests. Mass times base acceleration reaches the force that presses it there,
/// acceleration = |F(D)|/m.
///
/// Only for a grid over these two fields, from rest, and for travel limits inside the right-hand well:
/// further out the mass does not rest on the stop.
pub fn release_line(scene: &Scene, mechanism: &Mechanism, grid: &Grid) -> Option<Table> {
    let drive = scene.harmonic()?;
    let applies = scene.stops.travel_limit_mm().is_some()
        && axis(grid, drive.amplitude_path()).is_some()
        && scene.start == Start::Rest;
    let limits = axis(grid, LIMIT).filter(|_| applies)?;
    let well = mechanism.landscape.right_stable()?.x;
    let (from, last) = extent(limits.values.iter().copied());
    let to = last.min(well * 1e3);
    if from >= to {
        return None;
    }
    let place = |i: usize| from + (to - from) * i as f64 / (POINTS - 1) as f64;
    // only outward forces count; an inward force releases the mass at once
    let pressed = |mm: f64| (-mechanism.curve.force(mm / 1e3)).max(0.0);
    let mass = scene.mass_g / 1e3;
    let limits: Vec<f64> = (0..POINTS).map(place).collect();
    let amplitudes = limits.iter().map(|mm| drive.amplitude_of(pressed(*mm) / mass)).collect();
    let table = Table::new().with("travel_limit_mm", Values::Numbers(limits));
    Some(table.with(name_of(drive.amplitude_path()), Values::Numbers(amplitudes)))
}

/// For each value of the other field the smallest amplitude, 0 or above, whose cell crosses, or NaN. The two
/// columns have the names of the sweep, the other field first.
///
/// Only for a grid over two fields of which one is an amplitude. `rows` are all rows of the sweep.
pub fn first_crossing(grid: &Grid, rows: &Table) -> Option<Table> {
    let [a, b] = grid.axes() else { return None };
    let amplitude = |axis: &Axis| name_of(&axis.field).starts_with("amplitude_");
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
        let counts = regimes.get(i).is_some_and(|regime| CROSS.contains(regime)) && amplitudes[i] >= 0.0;
        if let Ok(place) = values.binary_search_by(|value| value.total_cmp(other))
            && counts
        {
            // f64::min ignores the NaN of a place without a value
            least[place] = least[place].min(amplitudes[i]);
        }
    }
    let table = Table::new().with(&grid.columns()[other], Values::Numbers(values));
    Some(table.with(&grid.columns()[amplitude_axis], Values::Numbers(least)))
}

fn axis<'a>(grid: &'a Grid, field: &str) -> Option<&'a Axis> {
    grid.axes().iter().find(|axis| axis.field == field && grid.axes().len() == 2)
}

/// The values of one axis of a map in ascending order, each once, with the edges of their cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Edges {
    /// The values.
    pub values: Vec<f64>,
    /// One more edge than there are values: half way between neighbours.
    pub edges: Vec<f64>,
}

impl Edges {
    /// The cells of these values; those that are not finite do not count.
    pub fn new(all: &[f64]) -> Self {
        let mut values: Vec<f64> = all.iter().copied().filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let middle = |pair: &[f64]| 0.5 * pair[0] + 0.5 * pair[1];
        let mut edges: Vec<f64> = values.windows(2).map(middle).collect();
        match (values.first(), values.last()) {
            // the outermost cells are symmetric about their values
            (Some(first), Some(last)) if edges.len() + 1 == values.len() && !edges.is_empty() => {
                let (low, high) = (2.0 * first - edges[0], 2.0 * last - edges[edges.len() - 1]);
                edges.insert(0, low);
                edges.push(high);
            }
            (Some(only), _) => {
                let half = if *only == 0.0 { 0.5 } else { 0.05 * only.abs() };
                edges = vec![only - half, only + half];
            }
            _ => edges = vec![0.0, 1.0],
        }
        Self { values, edges }
    }

    /// The index of this value.
    pub fn place(&self, value: f64) -> Option<usize> {
        self.values.binary_search_by(|known| known.total_cmp(&value)).ok()
    }

    /// The cell in which a number lies; `None` outside all of them.
    pub fn cell(&self, value: f64) -> Option<usize> {
        let above = self.edges.partition_point(|edge| *edge <= value);
        (1..=self.values.len()).contains(&above).then(|| above - 1)
    }

    /// The outermost edges.
    pub fn ends(&self) -> (f64, f64) {
        (self.edges[0], self.edges[self.edges.len() - 1])
    }
}

/// The line of [`first_crossing`] over a map of `x` and `y`: along the edges of its cells, towards smaller
/// amplitudes, in one part for each stretch without a gap. A place where the cell of the smallest amplitude
/// crosses has no edge: the first crossing is at or below that amplitude.
pub fn first_crossing_edge(
    table: &Table,
    (x, y): (&str, &str),
    across: &Edges,
    up: &Edges,
) -> Vec<Vec<(f64, f64)>> {
    let (Some(xs), Some(ys)) = (table.numbers(x), table.numbers(y)) else { return Vec::new() };
    // the line spans the width of the other field's cells
    let amplitude_up = table.columns().first().is_some_and(|column| column.name == x);
    let mut parts: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for (px, py) in xs.iter().zip(ys) {
        let place = across.place(*px).zip(up.place(*py));
        let edge = place.filter(|(i, j)| if amplitude_up { *j > 0 } else { *i > 0 });
        match (edge, parts.last_mut()) {
            (Some((i, j)), Some(part)) => part.extend(if amplitude_up {
                [(across.edges[i], up.edges[j]), (across.edges[i + 1], up.edges[j])]
            } else {
                [(across.edges[i], up.edges[j]), (across.edges[i], up.edges[j + 1])]
            }),
            _ => parts.push(Vec::new()),
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

/// The other coordinate of the points of a line over a map whose first (`upright`) or second one is `value`.
pub fn line_meets(line: &[(f64, f64)], value: f64, upright: bool) -> Vec<f64> {
    let turned = |(a, b): (f64, f64)| if upright { (a, b) } else { (b, a) };
    let meets = |pair: &[(f64, f64)]| {
        let (from, to) = (turned(pair[0]), turned(pair[1]));
        let (low, high) = (from.0.min(to.0), from.0.max(to.0));
        let inside = low < high && (low..=high).contains(&value);
        inside.then(|| from.1 + (value - from.0) / (to.0 - from.0) * (to.1 - from.1))
    };
    line.windows(2).filter_map(meets).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_lies_in_the_cell_of_the_nearest_value() {
        let edges = Edges::new(&[3.0, 1.0, 2.0, f64::NAN]);
        assert_eq!(edges.edges, [0.5, 1.5, 2.5, 3.5]);
        assert_eq!(
            [0.4, 0.5, 1.4, 2.6, 3.4, 3.6].map(|x| edges.cell(x)),
            [None, Some(0), Some(0), Some(2), Some(2), None]
        );
        assert_eq!(Edges::new(&[0.0]).ends(), (-0.5, 0.5));
        assert_eq!((edges.place(2.0), edges.cell(f64::NAN)), (Some(1), None));
    }
    #[test]
    fn the_edge_of_the_first_crossing_is_between_cells_of_which_one_crosses() {
        let table = Table::new()
            .with("travel_limit_mm", Values::Numbers(vec![1.0, 2.0, 3.0, 4.0]))
            .with("amplitude_g", Values::Numbers(vec![0.0, 1.0, f64::NAN, 0.5]));
        let (limits, amplitudes) = (Edges::new(&[1.0, 2.0, 3.0, 4.0]), Edges::new(&[0.0, 0.5, 1.0]));
        let names = ("travel_limit_mm", "amplitude_g");
        let parts = first_crossing_edge(&table, names, &limits, &amplitudes);
        assert_eq!(parts, [[(1.5, 0.75), (2.5, 0.75)], [(3.5, 0.25), (4.5, 0.25)]]);
        let turned = first_crossing_edge(&table, (names.1, names.0), &amplitudes, &limits);
        assert_eq!(turned, [[(0.75, 1.5), (0.75, 2.5)], [(0.25, 3.5), (0.25, 4.5)]]);
    }

    #[test]
    fn a_line_is_met_where_it_passes() {
        let line = [(0.0, 0.0), (1.0, 2.0), (1.0, 3.0), (2.0, 1.0)];
        assert_eq!(line_meets(&line, 0.25, true), [0.5]);
        assert_eq!(line_meets(&line, 1.5, true), [2.0]);
        assert_eq!(line_meets(&line, 1.5, false), [0.75, 1.75]);
        assert_eq!(line_meets(&line, 1.0, true), [2.0, 3.0], "both ends of a step");
        assert!(line_meets(&line, 2.5, true).is_empty());
    }
}
