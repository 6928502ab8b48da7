//! Picture of escapes over a field: the rate with its interval on a logarithmic axis, beside Kramers' rate.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel, Side};
use super::drawn::of_rows;
use super::figure::Point;
use super::role::Role;
use super::sweep::{NoPicture, can_show_over_field};
use super::swept::{ascending, swept_axis};
use crate::numeric::{elementary, short};
use crate::study::{EscapeOptions, Grid, Table, Until};

/// The rate of escape over the field of the grid, from all rows. The vertical axis is in 1/s.
pub fn escape_chart(
    rows: &Table,
    grid: &Grid,
    options: &EscapeOptions,
    ranges: Ranges,
) -> Result<Chart, NoPicture> {
    can_show_over_field(grid, "escapes")?;
    let x = grid.columns()[0].as_str();
    let names =
        ["escape_rate_per_s", "escape_rate_low_per_s", "escape_rate_high_per_s", "kramers_rate_per_s"];
    let [rate, low, high, kramers] = names.map(|name| rows.numbers(name).unwrap_or_default());
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
    let line = theory.into_iter().map(|row| log(kramers, row)).collect();
    panel.layer_if_any(Role::Envelope, "Kramers' rate", Marks::Path(line));
    let points: Vec<Point> = order.iter().map(|&row| log(rate, row)).collect();
    panel.draw(Role::Motion, Marks::Path(points.clone()));
    panel.layer(Role::Motion, "of the runs", Marks::Points(points));
    let none = ascending(places, |row| rate[row] == 0.0);
    let bounds = none.into_iter().map(|row| log(high, row)).collect();
    panel.layer_if_any(Role::Missing, "no escape: rate below", Marks::Points(bounds));
    let missing = ascending(places, |row| rate[row].is_nan()).into_iter().map(|row| places[row]);
    panel.layer_if_any(Role::Missing, "no value", Marks::Ticks(missing.collect(), Side::Bottom));
    let data = of_rows("escape", rows, &[&[x][..], &names].concat(), |row| panel.x.contains(places[row]));
    let what = match options.until {
        Until::Crossing => "first crossings of the barrier",
        Until::Well => "first arrivals in the well behind the barrier",
    };
    let (runs, within) = (options.runs, short(options.within));
    Ok(Chart::stack(vec![panel], format!("{what}, {runs} runs of {within} s at most each"), data))
}
