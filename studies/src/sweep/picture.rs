//! Rows of a sweep in the form that its pictures need.

use serde::{Deserialize, Serialize};

use super::{Edges, first_crossing, release_line};
use crate::mechanics::Mechanism;
use crate::numeric::short;
use crate::output::{Colours, Drawn, Marks, PlotAxis, Point, Quantity, Ranges, Shade, Shades, as_numbers};
use crate::questions::Simulation;
use crate::scene::Scene;
use crate::study::{Column, DIRECTION, Grid, Table, label_and_unit};

/// The lines over a map, as far as they apply.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// The release in closed form, with the swept columns of the map.
    pub release: Option<Table>,
    /// The first crossing cell along the amplitude.
    pub first_crossing: Option<Table>,
}

impl Overlay {
    /// The lines over the rows of a sweep of this scene, if runs begin at rest and all cells have the same
    /// mechanism; none over those of a walk.
    pub fn of(scene: &Scene, mechanism: Option<&Mechanism>, grid: &Grid, rows: &Table) -> Self {
        if rows.column(DIRECTION).is_some() {
            return Self::default();
        }
        Self {
            release: mechanism.and_then(|mechanism| release_line(scene, mechanism, grid)),
            first_crossing: first_crossing(grid, rows),
        }
    }
}

/// How a sweep over two fields is shown.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum View {
    /// As a map with the quantity as colour, or as one line per value of a field with few values.
    #[default]
    Top,
    /// As a surface whose height is the quantity.
    Surface,
    /// As a map with cuts beside it.
    Cuts(Vec<Cut>),
}

/// A cut through a map at a value of one of its fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cut {
    /// Column of that field.
    pub column: String,
    /// The value, which is one of those of the map.
    pub value: f64,
}

/// The data of the picture of a sweep, which [`sweep_chart`](crate::output::sweep_chart) draws.
#[derive(Debug, Clone)]
pub struct SweepPicture<'a> {
    /// All rows.
    pub rows: &'a Table,
    /// The grid.
    pub grid: &'a Grid,
    /// The scene.
    pub scene: &'a Scene,
    /// Time in s up to which runs continued until they repeat, if they did.
    pub until_settled: Option<f64>,
    /// The column that is shown.
    pub quantity: &'a str,
    /// The lines over a map.
    pub overlay: Overlay,
    /// How a sweep over two fields is shown.
    pub view: View,
    /// Ranges of the axes of the fields and, over one field, of the vertical axis.
    pub ranges: Ranges,
    /// What the bands are, in one sentence; empty if there are none.
    pub draws: &'a str,
}

impl<'a> SweepPicture<'a> {
    /// The picture of a column of the rows of a sweep of this grid: a line, or a map with the lines over it
    /// that apply.
    pub fn of(simulation: &'a Simulation, grid: &'a Grid, rows: &'a Table, quantity: &'a str) -> Self {
        let scene = simulation.scene();
        let mechanism = (!grid.changes_mechanism()).then(|| &**simulation.mechanism());
        let overlay = Overlay::of(scene, mechanism, grid, rows);
        Self { overlay, ..Self::of_rows(rows, grid, scene, quantity) }
    }

    /// The quantity of these rows from above, without lines over a map, over all values of the fields.
    #[doc(hidden)]
    pub fn of_rows(rows: &'a Table, grid: &'a Grid, scene: &'a Scene, quantity: &'a str) -> Self {
        let (overlay, view, ranges) = Default::default();
        Self { rows, grid, scene, until_settled: None, quantity, overlay, view, ranges, draws: "" }
    }
}

/// The cells with the quantity and their words, if their fields lie in `ranges`.
pub(super) fn drawn(picture: &SweepPicture, ranges: &[(&str, Option<(f64, f64)>)]) -> Drawn {
    let SweepPicture { rows, grid, quantity, .. } = picture;
    let fields = grid.columns();
    let shown = ["", "_low", "_high"].map(|ending| format!("{quantity}{ending}"));
    let shown = shown.iter().filter_map(|name| Some((name, as_numbers(rows.column(name)?)?)));
    let shown: Vec<(&String, Vec<f64>)> = shown.collect();
    let names = fields.iter().chain(shown.iter().map(|(name, _)| *name)).map(String::as_str);
    let ways = rows.words(DIRECTION);
    let regimes = rows.words("regime");
    let mut drawn = Drawn::new(names, if ways.is_empty() { &["regime"] } else { &["regime", DIRECTION] });
    let columns: Vec<&[f64]> = fields.iter().filter_map(|name| rows.numbers(name)).collect();
    for row in 0..rows.rows() {
        let within = |(name, range): &(&str, Option<(f64, f64)>)| {
            let number = rows.numbers(name).map_or(f64::NAN, |column| column[row]);
            range.is_none_or(|(low, high)| (low..=high).contains(&number))
        };
        if ranges.iter().all(within) {
            let places = columns.iter().map(|column| column[row]);
            let numbers: Vec<f64> = places.chain(shown.iter().map(|(_, values)| values[row])).collect();
            let said: Vec<&str> =
                [regimes, ways].iter().filter_map(|column| column.get(row).copied()).collect();
            drawn.put("cell", &numbers, &said);
        }
    }
    drawn
}

/// The columns by which a transient is told.
pub(super) const OF_DOTS: [&str; 2] = ["settled", "steady"];

/// The legend entry of transients.
#[doc(hidden)]
pub const NOT_SETTLED: &str = "not settled yet";

/// Whether the motion of a row may be a transient; false if the rows lack the columns that tell it.
pub(super) fn is_transient(rows: &Table, row: usize) -> bool {
    let word = |name: &str| rows.words(name).get(row).copied();
    let ([settled, steady], regime) = (OF_DOTS.map(word), word("regime"));
    // the regime of a motion with one well has no word
    let is_irregular = regime.is_none_or(|regime| ["irregular", ""].contains(&regime));
    settled == Some("false") && steady.is_some() && !(is_irregular && steady == Some("true"))
}

pub(crate) fn label(rows: &Table, name: &str) -> String {
    rows.column(name).map_or_else(|| name.to_owned(), Column::label)
}

/// The horizontal axis of the swept field `x`.
pub(crate) fn swept_axis(rows: &Table, x: &str, range: Option<(f64, f64)>) -> PlotAxis {
    let values = rows.numbers(x).unwrap_or_default();
    PlotAxis::around(values.iter().copied(), 0.02, &label(rows, x)).or_given(range)
}

/// The rows that are `shown`, in ascending order of these values.
pub(crate) fn ascending(values: &[f64], shown: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).filter(|row| shown(*row)).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    order
}

/// Points of these rows of `rows`, with their regimes: those that have values, and at the height `low` those
/// at rest that have none.
pub(super) fn marks(
    order: &[usize],
    places: &[f64],
    quantity: &Quantity,
    low: f64,
    rows: &Table,
) -> Vec<(Point, &'static str)> {
    let regimes = rows.words("regime");
    let height = |row: usize| match (quantity.values[row], quantity.cells[row]) {
        (value, Shade::Rest) if !value.is_finite() => low,
        (value, _) => value,
    };
    let marks =
        order.iter().map(|&row| ((places[row], height(row)), regimes.get(row).copied().unwrap_or("")));
    marks.filter(|mark| mark.0.1.is_finite()).collect()
}

/// The cells about some of the `places`, those of these rows.
pub(crate) fn spans(places: &[f64], rows: impl Iterator<Item = usize>) -> Marks {
    let Edges { edges, .. } = &Edges::new(places);
    let around = |row: usize| {
        let above = edges.partition_point(|edge| *edge <= places[row]).clamp(1, edges.len() - 1);
        (edges[above - 1], edges[above])
    };
    let mut spans: Vec<Point> = rows.map(around).collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    Marks::Spans(spans)
}

/// The cells over the fields `x` and `y` of the rows that are `shown`.
pub(super) fn cells(
    rows: &Table,
    (x, y): (&str, &str),
    quantity: &Quantity,
    shown: impl Fn(usize) -> bool,
) -> Shades {
    let (xs, ys) = (rows.numbers(x).unwrap_or_default(), rows.numbers(y).unwrap_or_default());
    let of = |all: &[f64]| {
        let values: Vec<f64> = (0..all.len()).filter(|row| shown(*row)).map(|row| all[row]).collect();
        Edges::new(&values)
    };
    let (across, up) = (of(xs), of(ys));
    let mut cells = vec![Shade::Missing; across.values.len() * up.values.len()];
    for row in (0..rows.rows()).filter(|row| shown(*row)) {
        if let (Some(column), Some(level)) = (across.place(xs[row]), up.place(ys[row])) {
            cells[column * up.values.len() + level] = quantity.cells[row];
        }
    }
    let bar = quantity.bar();
    let colours = match &quantity.kinds {
        Some(kinds) => Colours::Categories(kinds.clone()),
        None => Colours::Scale(bar),
    };
    Shades { across, up, cells, colours, missing: quantity.missing(rows) }
}

/// The names in the legend of the lines for the values of the field `name`.
pub(super) fn of_each(name: &str, each: &[f64]) -> Vec<String> {
    let (words, unit) = label_and_unit(name);
    let named = |(i, value): (usize, &f64)| {
        let value = short(*value);
        let words = if i == 0 { format!("{words} {value}") } else { value };
        format!("{words} {unit}").trim_end().to_owned()
    };
    each.iter().enumerate().map(named).collect()
}
