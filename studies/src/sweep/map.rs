//! Maps of a sweep over two fields: cells with lines over them, cuts through them, surfaces.

use super::chart::{are_few, distinct};
use super::picture::{
    Cut, NOT_SETTLED, OF_DOTS, Overlay, SweepPicture, View, ascending, cells, drawn, is_transient, label,
    marks,
};
use super::walked::OF_WALK;
use super::{first_crossing_edge, line_meets};
use crate::numeric::short;
use crate::output::{
    Chart, Colours, Drawn, Marks, Panel, PanelColumn, PlotAxis, Point, Quantity, Role, Shades,
};
use crate::study::{Grid, Table, label_and_unit};

/// Largest number of columns or rows of a map in which cells are marked by dots.
const MAX_DOTS: usize = 110;

/// The columns besides those of the fields that the picture of a sweep of this grid takes from its rows, the
/// quantity first. Without the others it marks neither transients nor hysteresis.
#[doc(hidden)]
pub fn shown_columns<'a>(quantity: &'a str, view: &View, grid: &Grid) -> Vec<&'a str> {
    let lengths: Vec<usize> = grid.axes().iter().map(|axis| axis.values.len()).collect();
    let (has_dots, has_walk) = match lengths[..] {
        [_] => (true, true),
        [a, b] => (*view != View::Surface && (are_few(a, b) || are_few(b, a) || a.max(b) <= MAX_DOTS), false),
        _ => (false, false),
    };
    let of_dots = OF_DOTS.into_iter().filter(|_| has_dots);
    let more = of_dots.chain(OF_WALK.into_iter().filter(|_| has_walk)).filter(|name| *name != quantity);
    [quantity].into_iter().chain(more).collect()
}

/// Height of a horizontal cut, and width of a vertical one, relative to the map.
const CUT: f64 = 0.5;

/// The lines over a map, in its fields.
struct Lines {
    release: Vec<Point>,
    /// The edges of the first crossing cells.
    crossing: Vec<Vec<Point>>,
}

impl Lines {
    fn new(picture: &SweepPicture, (x, y): (&str, &str), cells: &Shades) -> Self {
        let pairs = |table: &Table| -> Option<Vec<Point>> {
            Some(table.numbers(x)?.iter().copied().zip(table.numbers(y)?.iter().copied()).collect())
        };
        let Overlay { release, first_crossing } = &picture.overlay;
        let edge = |table| first_crossing_edge(table, (x, y), &cells.across, &cells.up);
        let release = release.as_ref().and_then(pairs).unwrap_or_default();
        Self { release, crossing: first_crossing.as_ref().map(edge).unwrap_or_default() }
    }

    fn draw(&self, panel: &mut Panel) {
        for part in &self.crossing {
            panel.layer(Role::FirstCrossing, "first crossing", Marks::Path(part.clone()));
        }
        let name = "release: leaves the stop (closed form)";
        panel.layer_if_any(Role::Release, name, Marks::Path(self.release.clone()));
    }

    fn record(&self, drawn: &mut Drawn) {
        let release = self.release.iter().map(|point| ("release", point));
        let crossing = self.crossing.iter().flatten().map(|point| ("first_crossing", point));
        for (series, (a, b)) in release.chain(crossing) {
            drawn.put(series, &[*a, *b], &[]);
        }
    }
}

/// A panel of cells, with a colour bar if they have a scale.
pub(super) fn cells_panel(
    picture: &SweepPicture,
    (x, y): (&str, &str),
    cells: Shades,
    bar: PlotAxis,
) -> Panel {
    let SweepPicture { rows, ranges, .. } = *picture;
    let axis = |ends: (f64, f64), given, name: &str| {
        PlotAxis::between(ends.0, ends.1, &label(rows, name)).or_given(given)
    };
    let mut panel = Panel::new(axis(cells.across.ends(), ranges.x, x), axis(cells.up.ends(), ranges.y, y));
    panel.bar = Some(bar).filter(|_| !matches!(cells.colours, Colours::Categories(_)));
    panel.draw(Role::Motion, Marks::Cells(cells));
    panel
}

/// The cells whose motion may be a transient, from the columns `settled` and `steady`; empty if the rows lack
/// these columns, or if there are too many cells for dots.
fn transients(rows: &Table, (x, y): (&str, &str), cells: &Shades) -> Vec<Point> {
    let names = [x, y].map(|name| rows.numbers(name).unwrap_or_default());
    let lengths = [cells.across.values.len(), cells.up.values.len()];
    let shown = 0..if lengths.iter().any(|length| *length > MAX_DOTS) { 0 } else { rows.rows() };
    shown.filter(|row| is_transient(rows, *row)).map(|row| (names[0][row], names[1][row])).collect()
}

/// The quantity as height and colour over two fields.
pub(super) fn surface(picture: &SweepPicture, (x, y): (&str, &str)) -> Chart {
    let SweepPicture { rows, ranges, .. } = *picture;
    let quantity = Quantity::of(rows, picture.quantity);
    let within = |name: &str, range: Option<(f64, f64)>| {
        let values = rows.numbers(name).unwrap_or_default();
        move |row: usize| range.is_none_or(|(low, high)| (low..=high).contains(&values[row]))
    };
    let (in_x, in_y) = (within(x, ranges.x), within(y, ranges.y));
    let cells = cells(rows, (x, y), &quantity, |row| in_x(row) && in_y(row));
    let axis = |values: &[f64], range, name: &str| {
        PlotAxis::around(values.iter().copied(), 0.0, &label(rows, name)).or_given(range)
    };
    let across = axis(&cells.across.values, ranges.x, x);
    let mut panel = Panel::new(across, axis(&cells.up.values, ranges.y, y));
    panel.draw(Role::Motion, Marks::Surface(cells, quantity.bar()));
    Chart::stack(vec![panel], "", drawn(picture, &[(x, ranges.x), (y, ranges.y)]).table())
}

/// The quantity as colour over the fields `x` and `y`, beside it the quantity along cuts through the map.
pub(crate) fn map(picture: &SweepPicture, (x, y): (&str, &str), cuts: &[Cut]) -> Chart {
    let SweepPicture { rows, ranges, .. } = *picture;
    let quantity = Quantity::of(rows, picture.quantity);
    let cells = cells(rows, (x, y), &quantity, |_| true);
    let lines = Lines::new(picture, (x, y), &cells);
    let transients = transients(rows, (x, y), &cells);
    let mut panel = cells_panel(picture, (x, y), cells, quantity.bar());
    let mut drawn = drawn(picture, &[(x, ranges.x), (y, ranges.y)]);
    for (a, b) in transients.iter().filter(|at| panel.contains(**at)) {
        drawn.put("transient", &[*a, *b], &[]);
    }
    panel.layer_if_any(Role::Transient, NOT_SETTLED, Marks::Cloud(transients));
    lines.draw(&mut panel);
    lines.record(&mut drawn);
    let (mut below, mut beside) = (Vec::new(), Vec::new());
    for Cut { column, value } in cuts {
        let is_upright = column == x;
        let along = if is_upright { y } else { x };
        let ends = match is_upright {
            true => [(*value, panel.y.low), (*value, panel.y.high)],
            false => [(panel.x.low, *value), (panel.x.high, *value)],
        };
        panel.draw(Role::Cut, Marks::Path(ends.into()));
        let (at, places) =
            (rows.numbers(column).unwrap_or_default(), rows.numbers(along).unwrap_or_default());
        let order = ascending(places, |row| at[row] == *value);
        // in line with the map
        let turned = |(a, b): Point| if is_upright { (b, a) } else { (a, b) };
        let axis = quantity.axis(0.06);
        let mut cut = match is_upright {
            true => Panel::new(axis, panel.y.clone()),
            false => Panel { height: CUT, ..Panel::new(panel.x.clone(), axis) },
        };
        let (name, unit) = label_and_unit(column);
        cut.heading = format!("at {name} {} {unit}", short(*value)).trim_end().to_owned();
        let meets = |lines: &[Vec<Point>]| {
            let all = lines.iter().flat_map(|line| line_meets(line, *value, is_upright));
            distinct(&all.collect::<Vec<f64>>())
        };
        let thresholds = [
            (Role::Release, "cut_release", meets(std::slice::from_ref(&lines.release))),
            (Role::FirstCrossing, "cut_first_crossing", meets(&lines.crossing)),
        ];
        for (role, series, at) in thresholds {
            for at in &at {
                let (a, b) = if is_upright { (*value, *at) } else { (*at, *value) };
                drawn.put(series, &[a, b], &[]);
            }
            cut.draw(role, if is_upright { Marks::Horizontals(at) } else { Marks::Verticals(at) });
        }
        if quantity.kinds.is_none() {
            let points = order.iter().map(|&row| turned((places[row], quantity.values[row]))).collect();
            cut.draw(Role::Joined, Marks::Path(points));
        }
        let low = if is_upright { cut.x.low } else { cut.y.low };
        let regimes = marks(&order, places, &quantity, low, rows);
        let regimes = regimes.into_iter().map(|(point, word)| (turned(point), word)).collect();
        cut.draw(Role::Motion, Marks::Regimes(regimes, quantity.kinds.is_none()));
        if is_upright { beside.push(cut) } else { below.push(cut) }
    }
    let mut chart = Chart::stack([vec![panel], below].concat(), "", drawn.table());
    chart.columns.extend(beside.into_iter().map(|cut| PanelColumn { width: CUT, panels: vec![cut] }));
    chart
}
