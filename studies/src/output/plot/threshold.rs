//! Picture of thresholds: over one field lines, over two a map or lines.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel, Side};
use super::drawn::{Drawn, as_numbers};
use super::figure::Point;
use super::map::map;
use super::role::Role;
use super::sweep::{NoPicture, each_line, few_lines};
use super::swept::{Overlay, SweepPicture, View, ascending, swept_axis};
use crate::numeric::short;
use crate::scene::{Scene, column_names};
use crate::study::{Column, Grid, Onset, Table, Values};

/// The data of the picture of thresholds.
#[derive(Debug, Clone, Copy)]
pub struct ThresholdPicture<'a> {
    /// The rows of [`threshold_table`](crate::study::threshold_table).
    pub rows: &'a Table,
    /// The grid of the thresholds.
    pub grid: &'a Grid,
    /// The scene.
    pub scene: &'a Scene,
    /// Dotted path of the field whose threshold is shown.
    pub field: &'a str,
    /// What begins at it.
    pub onset: Onset,
    /// Ranges of the axes; over one field, the vertical axis is that of the threshold.
    pub ranges: Ranges,
}

/// The column of Melnikov's threshold, in the unit of the amplitude.
const MELNIKOV: [&str; 3] = ["melnikov_g", "melnikov_m_per_s2", "melnikov_n"];

/// Whether thresholds over this grid can be shown.
pub fn can_show_thresholds(grid: &Grid) -> Result<(), NoPicture> {
    match grid.axes().len() {
        0 => Err(NoPicture::SingleThreshold),
        1 | 2 => Ok(()),
        n => Err(NoPicture::Fields(n)),
    }
}

/// The picture of thresholds: a line over one field; over two fields one line per value of a field with few
/// values, otherwise a map.
pub fn threshold_chart(picture: &ThresholdPicture) -> Result<Chart, NoPicture> {
    can_show_thresholds(picture.grid)?;
    let ThresholdPicture { rows, grid, scene, onset, ranges, .. } = *picture;
    let least = format!("least_{}", column_names(&[picture.field]).concat());
    let values = rows.numbers("value").unwrap_or_default();
    let quantity = Column { name: least.clone(), values: Values::Numbers(values.to_vec()) };
    let mut chart = match (grid.columns(), few_lines(rows, grid)) {
        ([x], _) => lines(picture, x, None, &quantity.label()),
        ([_, _], Some((x, each))) => lines(picture, x, Some(each), &quantity.label()),
        (columns, _) => {
            let named = rows.clone().with(&least, quantity.values);
            let (quantity, overlay, view) = (least.as_str(), Overlay::default(), View::Top);
            let rows = &named;
            let shown = SweepPicture {
                rows,
                grid,
                scene,
                until_settled: None,
                quantity,
                overlay,
                view,
                ranges,
                draws: "",
            };
            map(&shown, (&columns[0], &columns[1]))
        }
    };
    let names = grid.columns().iter().map(String::as_str);
    let more: Vec<&str> =
        ["windows"].into_iter().chain(MELNIKOV).filter(|name| rows.column(name).is_some()).collect();
    let all = names.chain([&*least, "low", "high"]).chain(more.iter().copied());
    let mut drawn = Drawn::new(all, &[]);
    let fields = grid.columns().iter().map(String::as_str);
    let columns = fields.chain(["value", "low", "high"]).chain(more.iter().copied());
    let columns: Vec<_> = columns.filter_map(|name| rows.column(name).and_then(as_numbers)).collect();
    for row in 0..rows.rows() {
        let numbers: Vec<f64> = columns.iter().map(|column| column[row]).collect();
        drawn.put("threshold", &numbers, &[]);
    }
    chart.data = drawn.table();
    chart.subtitle = match rows.numbers("probability").and_then(|shares| shares.first()) {
        Some(share) => format!("the value at which {} % of the runs under noise cross", short(100.0 * share)),
        None => about(onset).to_owned(),
    };
    Ok(chart)
}

/// What begins at the threshold.
fn about(onset: Onset) -> &'static str {
    match onset {
        Onset::Release => "the least value at which the mass is released from the stop that it rests on",
        Onset::Crossing => "the least value at which the motion from rest, once it has settled, crosses",
        Onset::Interwell => {
            "the least value at which the motion from rest, once it has settled, is interwell"
        }
    }
}

/// The threshold over the field `x`; a line for each value of `series`.
fn lines(picture: &ThresholdPicture, x: &str, series: Option<&str>, up: &str) -> Chart {
    let ThresholdPicture { rows, ranges, .. } = *picture;
    let numbers = |name: &str| rows.numbers(name).unwrap_or_default();
    let (places, values, low, high) = (numbers(x), numbers("value"), numbers("low"), numbers("high"));
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
    let from_zero = values.iter().copied().chain(ends).chain(melnikov.iter().copied()).chain([0.0]);
    let upward = PlotAxis::around(from_zero, 0.05, up).or_given(ranges.y);
    let mut panel = Panel::new(swept_axis(rows, x, ranges.x), upward);
    if !bars.is_empty() {
        let (role, name) = match estimated {
            true => (Role::Interval, "95 % interval"),
            false => (Role::Joined, "undecided between"),
        };
        panel.layer(role, name, Marks::Intervals(bars));
    }
    let missing = ascending(places, |row| !values[row].is_finite());
    if !missing.is_empty() {
        let at = missing.iter().map(|row| places[*row]).collect();
        panel.layer(Role::Missing, "none in the range", Marks::Ticks(at, Side::Bottom));
    }
    let any_gap = (0..rows.rows()).any(has_gaps);
    if any_gap {
        panel.layer(Role::Curve, "no gap found above", Marks::Points(Vec::new()));
    }
    for line in each_line(rows, series) {
        let order = ascending(places, |row| line.has(row));
        let point = |row: &usize| (places[*row], values[*row]);
        panel.layer(line.role, &line.name, Marks::Path(order.iter().map(point).collect()));
        let of = |gaps: bool| -> Vec<Point> {
            order.iter().filter(|row| has_gaps(**row) == gaps).map(point).collect()
        };
        panel.draw(line.role, Marks::Points(of(false)));
        panel.layer(Role::Gaps, if any_gap { "gaps above" } else { "" }, Marks::Points(of(true)));
    }
    if !melnikov.is_empty() {
        for line in each_line(rows, series) {
            let order = ascending(places, |row| line.has(row) && melnikov[row].is_finite());
            let points = order.iter().map(|&row| (places[row], melnikov[row])).collect();
            panel.layer(Role::Envelope, "Melnikov's threshold", Marks::Path(points));
        }
    }
    Chart::stack(vec![panel], "", Table::new())
}
