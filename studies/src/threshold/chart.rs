//! Picture of thresholds: over one field lines, over two a map or lines.

use super::Onset;
use crate::numeric::short;
use crate::output::{
    Chart, Marks, Panel, PlotAxis, Point, Ranges, Role, Side, SweepPicture, as_numbers, ascending, each_line,
    few_lines, label, map, of_rows, swept_axis,
};
use crate::scene::{Scene, column_names};
use crate::study::{Grid, Table, Values};

/// The column of Melnikov's threshold, in the unit of the amplitude.
pub(super) const MELNIKOV: [&str; 3] = ["melnikov_g", "melnikov_m_per_s2", "melnikov_n"];

/// The thresholds of a `field`, given by its dotted path: a line over one field; over two fields one line per
/// value of a field with few values, otherwise a map. Over one field the vertical axis is that of the
/// threshold.
pub(super) fn chart(
    rows: &Table,
    (grid, scene): (&Grid, &Scene),
    field: &str,
    onset: Onset,
    ranges: Ranges,
) -> Chart {
    let least = format!("least_{}", column_names(&[field]).concat());
    let values = rows.numbers("value").unwrap_or_default();
    let rows = &rows.clone().with(&least, Values::Numbers(values.to_vec()));
    let mut chart = match (grid.columns(), few_lines(rows, grid)) {
        ([x], _) => lines(rows, x, None, &least, ranges),
        ([_, _], Some((x, each))) => lines(rows, x, Some(each), &least, ranges),
        (columns, _) => {
            let shown = SweepPicture { ranges, ..SweepPicture::of_rows(rows, grid, scene, &least) };
            map(&shown, (&columns[0], &columns[1]), &[])
        }
    };
    let fields = grid.columns().iter().map(String::as_str);
    let more = ["windows"].into_iter().chain(MELNIKOV).filter(|name| rows.column(name).is_some());
    let names: Vec<&str> = fields.chain([&*least, "low", "high"]).chain(more).collect();
    chart.data = of_rows("threshold", rows, &names, |_| true);
    chart.subtitle = match rows.numbers("probability").and_then(|shares| shares.first()) {
        Some(share) => format!("the value at which {} % of the runs under noise cross", short(100.0 * share)),
        None => {
            let what = match onset {
                Onset::Release => "the mass is released from the stop that it rests on",
                Onset::Crossing => "the motion from rest, once it has settled, crosses",
                Onset::Interwell => "the motion from rest, once it has settled, is interwell",
            };
            format!("the least value at which {what}")
        }
    };
    chart
}

/// The threshold, which is the column `least`, over the field `x`; a line for each value of `series`.
fn lines(rows: &Table, x: &str, series: Option<&str>, least: &str, ranges: Ranges) -> Chart {
    let [places, values, low, high] =
        [x, least, "low", "high"].map(|name| rows.numbers(name).unwrap_or_default());
    let windows = rows.column("windows").and_then(as_numbers).unwrap_or_default();
    let has_gaps = |row: usize| windows.get(row).is_some_and(|count| *count > 0.0);
    let (undecided, estimated) = (rows.words("undecided"), rows.column("probability").is_some());
    let bars: Vec<[f64; 3]> = (0..rows.rows())
        .filter(|row| estimated || undecided.get(*row) == Some(&"true"))
        .map(|row| [places[row], low[row], high[row]])
        .filter(|bar| !estimated || bar.iter().all(|end| end.is_finite()))
        .collect();
    let melnikov = MELNIKOV.iter().find_map(|name| rows.numbers(name)).unwrap_or_default();
    let ends = bars.iter().flat_map(|bar| [bar[1], bar[2]]);
    let shown = values.iter().copied().chain(ends).chain(melnikov.iter().copied());
    let upward = PlotAxis::from_zero(shown, 0.05, &label(rows, least)).or_given(ranges.y);
    let mut panel = Panel::new(swept_axis(rows, x, ranges.x), upward);
    let (role, name) = match estimated {
        true => (Role::Interval, "95 % interval"),
        false => (Role::Joined, "undecided between"),
    };
    panel.layer_if_any(role, name, Marks::Intervals(bars));
    let missing = ascending(places, |row| !values[row].is_finite()).into_iter().map(|row| places[row]);
    panel.layer_if_any(Role::Missing, "none in the range", Marks::Ticks(missing.collect(), Side::Bottom));
    let any_gap = (0..rows.rows()).any(has_gaps);
    if any_gap {
        panel.layer(Role::Curve, "no gap found above", Marks::Points(Vec::new()));
    }
    let each = each_line(rows, x, series);
    for line in &each {
        let order = &line.order;
        let point = |row: &usize| (places[*row], values[*row]);
        let named = !line.name.is_empty() || melnikov.is_empty();
        let name = if named { &line.name } else { "threshold" };
        panel.layer(line.role, name, Marks::Path(order.iter().map(point).collect()));
        let of = |gaps: bool| -> Vec<Point> {
            order.iter().filter(|row| has_gaps(**row) == gaps).map(point).collect()
        };
        panel.draw(line.role, Marks::Points(of(false)));
        panel.layer(Role::Gaps, if any_gap { "gaps above" } else { "" }, Marks::Points(of(true)));
    }
    if !melnikov.is_empty() {
        for line in &each {
            let points = line.order.iter().map(|&row| (places[row], melnikov[row]));
            let points = points.filter(|point| point.1.is_finite()).collect();
            panel.layer(Role::Envelope, "Melnikov's threshold", Marks::Path(points));
        }
    }
    Chart::stack(vec![panel], "", Table::new())
}
