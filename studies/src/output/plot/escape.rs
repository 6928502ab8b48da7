//! Picture of escapes over a field: the rate with its interval on a logarithmic axis, beside Kramers' rate.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel, Side};
use super::drawn::Drawn;
use super::figure::Point;
use super::role::Role;
use super::sweep::{MAX_PICTURE_CELLS, NoPicture};
use super::swept::{ascending, swept_axis};
use crate::numeric::{elementary, short};
use crate::study::{EscapeOptions, Grid, Table, Until};

/// What the picture is drawn from.
#[derive(Debug, Clone, Copy)]
pub struct EscapePicture<'a> {
    /// All rows.
    pub rows: &'a Table,
    /// Of which grid, of one field.
    pub grid: &'a Grid,
    /// The runs of each cell.
    pub options: &'a EscapeOptions,
    /// The axes; the vertical one in 1/s.
    pub ranges: Ranges,
}

/// Whether escapes over this grid can be shown.
pub fn can_show_escapes(grid: &Grid) -> Result<(), NoPicture> {
    match grid.axes().len() {
        1 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 => Ok(()),
        n => Err(NoPicture::Escapes(n)),
    }
}

/// The rate of escape over the field of the grid.
pub fn escape_chart(picture: &EscapePicture) -> Result<Chart, NoPicture> {
    can_show_escapes(picture.grid)?;
    let EscapePicture { rows, grid, options, ranges } = *picture;
    let x = &grid.columns()[0];
    let names =
        ["escape_rate_per_s", "escape_rate_low_per_s", "escape_rate_high_per_s", "kramers_rate_per_s"];
    let columns = names.map(|name| rows.numbers(name).unwrap_or_default());
    let [rate, low, high, kramers] = columns;
    let places = rows.numbers(x).unwrap_or_default();
    // of a rate without an escape only the upper end is above 0
    let drawn = rate.iter().chain(low).chain(high).copied();
    let label = "escape rate (1/s)";
    let up = match ranges.y.filter(|range| range.0 > 0.0) {
        Some((low, high)) => PlotAxis::powers(elementary::log10(low), elementary::log10(high), label),
        None => PlotAxis::decades(drawn, label),
    };
    let mut panel = Panel::new(swept_axis(rows, x, ranges.x), up);
    let order = ascending(places, |row| rate[row] > 0.0);
    let log = |values: &[f64], row: usize| (places[row], elementary::log10(values[row]));
    let bars = order
        .iter()
        .map(|&row| [places[row], elementary::log10(low[row]), elementary::log10(high[row])])
        .collect();
    panel.layer(Role::Interval, "95 % interval", Marks::Intervals(bars));
    let theory = ascending(places, |row| kramers[row] > 0.0);
    if !theory.is_empty() {
        let line: Vec<Point> = theory.iter().map(|&row| log(kramers, row)).collect();
        panel.layer(Role::Envelope, "Kramers' rate", Marks::Path(line));
    }
    let points: Vec<Point> = order.iter().map(|&row| log(rate, row)).collect();
    panel.draw(Role::Motion, Marks::Path(points.clone()));
    panel.layer(Role::Motion, "of the runs", Marks::Points(points));
    let none = ascending(places, |row| rate[row] == 0.0);
    if !none.is_empty() {
        let bounds: Vec<Point> = none.iter().map(|&row| log(high, row)).collect();
        panel.layer(Role::Missing, "no escape: rate below", Marks::Points(bounds));
    }
    let missing = ascending(places, |row| rate[row].is_nan());
    if !missing.is_empty() {
        let at = missing.iter().map(|&row| places[row]).collect();
        panel.layer(Role::Missing, "no value", Marks::Ticks(at, Side::Bottom));
    }
    let mut data = Drawn::new([x.as_str()].into_iter().chain(names), &[]);
    for (row, at) in places.iter().enumerate().filter(|place| panel.x.contains(*place.1)) {
        let [a, b, c, d] = columns.map(|column| column[row]);
        data.put("escape", &[*at, a, b, c, d], &[]);
    }
    let what = match options.until {
        Until::Crossing => "first crossings of the barrier",
        Until::Well => "first arrivals in the well behind the barrier",
    };
    let (runs, within) = (options.runs, short(options.within));
    Ok(Chart::stack(vec![panel], format!("{what}, {runs} runs of {within} s at most each"), data.table()))
}
