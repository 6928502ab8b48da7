//! The picture of escapes: their rate over a field.

use super::{Escape, Until};
use crate::numeric::{elementary, short};
use crate::output::{
    Chart, Marks, Panel, PlotAxis, Point, Ranges, Role, Side, ascending, of_rows, swept_axis,
};
use crate::study::Table;

impl Escape {
    /// The rate over the field of the grid with its interval, on a logarithmic axis in 1/s, beside Kramers'
    /// rate; from all rows.
    pub(super) fn drawn(&self, x: &str, within: f64, rows: &Table, ranges: Ranges) -> Chart {
        let names =
            ["escape_rate_per_s", "escape_rate_low_per_s", "escape_rate_high_per_s", "kramers_rate_per_s"];
        let [rate, low, high, kramers] = names.map(|name| rows.numbers(name).unwrap_or_default());
        let places = rows.numbers(x).unwrap_or_default();
        // of a rate without an escape only the upper end is above 0
        let drawn = rate.iter().chain(low).chain(high).copied();
        let up =
            PlotAxis::decades(drawn, "escape rate (1/s)").or_given(ranges.y.filter(|range| range.0 > 0.0));
        let mut panel = Panel::new(swept_axis(rows, x, ranges.x), up);
        let order = ascending(places, |row| rate[row] > 0.0);
        let log = |values: &[f64], row: usize| (places[row], elementary::log10(values[row]));
        let bars = order.iter().map(|&row| [places[row], log(low, row).1, log(high, row).1]).collect();
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
        let what = match self.until {
            Until::Crossing => "first crossings of the barrier",
            Until::Well => "first arrivals in the well behind the barrier",
        };
        let (runs, within) = (self.runs, short(within));
        Chart::stack(vec![panel], format!("{what}, {runs} runs of {within} s at most each"), data)
    }
}
