//! Picture of a field that was walked both ways: two lines and the hysteresis between them, or two maps and
//! their difference.

use super::axis::PlotAxis;
use super::figure::{Align, Area, Figure, Point, Text};
use super::frame::Frame;
use super::map::{Cell, Mosaic, colour_bar, meanings};
use super::mark::{REGIMES, Sample, legend, regime};
use super::quantity::Quantity;
use super::style::{self, Ink, Theme, viridis};
use super::swept::{
    LEFT, MARKER_ROOM, SweepPicture, TOP, below_legend, drawn, label, mark_regimes, swept_axis,
};
use crate::study::{DIRECTION, Direction, Table};

/// Whether the rows are those of a walk both ways.
pub(super) fn walked_both(rows: &Table) -> bool {
    let ways = rows.words(DIRECTION);
    [Direction::Up, Direction::Down].iter().all(|way| ways.contains(&way.name()))
}

/// The rows that were walked in a direction, in ascending order of the field `x`.
fn walked(rows: &Table, x: &[f64], direction: Direction) -> Vec<usize> {
    let ways = rows.words(DIRECTION);
    let mut order: Vec<usize> = (0..rows.rows()).filter(|i| ways[*i] == direction.name()).collect();
    order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
    order
}

/// How a direction is drawn: its colour, and its dash.
type Stroke = (Direction, Ink, Option<(f64, f64)>);

fn strokes(theme: &Theme) -> [Stroke; 2] {
    [(Direction::Up, theme.ink, None), (Direction::Down, theme.second, Some(style::DASH))]
}

/// The distance between two lines as a share of the axis upward from which on they are seen apart.
const VISIBLE: f64 = 2e-3;

/// The quantity over the field `x` on the way up and on the way down, each value marked with its regime.
pub(super) fn walked_lines(figure: &mut Figure, picture: &SweepPicture, x: &str, theme: &Theme) {
    let SweepPicture { rows, ranges, .. } = *picture;
    let values = rows.numbers(x).unwrap_or_default();
    let quantity = Quantity::of(rows, picture.quantity);
    let regimes = rows.words("regime");
    let shade = theme.shaking.over(theme.paper, 0.3);
    let up = quantity.axis(0.05, 6).or_given(ranges.y, 6, &quantity.label);
    let [ups, downs] = [Direction::Up, Direction::Down].map(|way| walked(rows, values, way));
    let apart = |(a, b): (&usize, &usize)| {
        let [a, b] = [a, b].map(|row| up.share(quantity.values[*row]));
        (a - b).abs() > VISIBLE
    };
    let mut entries = vec![];
    for (direction, ink, dash) in strokes(theme) {
        entries.push((Sample::Line(ink, style::LINE, dash), direction.name()));
    }
    if quantity.words.is_none() && ups.iter().zip(&downs).any(apart) {
        entries.push((Sample::Patch(shade, None), "hysteresis"));
    }
    for (name, shape) in REGIMES {
        if regimes.contains(&name) {
            entries.push((Sample::Marker(shape, regime(name, theme).1), name));
        }
    }
    let top = below_legend(figure, theme, &entries);
    let across = swept_axis(rows, x, ranges.x);
    let frame = Frame::whole(figure, (LEFT, top), across, up);
    let point = |row: &usize| (values[*row], quantity.values[*row]);
    let place = |row: &usize| frame.place(point(row));
    let pairs: Vec<(Point, Point)> = ups.iter().map(place).zip(downs.iter().map(place)).collect();
    if quantity.words.is_none() {
        pairs.windows(2).for_each(|two| between(figure, two[0], two[1], shade, frame.area));
    }
    frame.grid(figure, theme);
    for ((_, ink, dash), order) in strokes(theme).into_iter().zip([&ups, &downs]) {
        for part in order.split(|row| !quantity.values[*row].is_finite()) {
            let points: Vec<Point> = part.iter().map(place).collect();
            match dash {
                _ if quantity.words.is_some() => {}
                None => figure.line(&points, style::LINE, ink, frame.area),
                Some(dash) => figure.dashed(&points, style::LINE, ink, dash, frame.area),
            }
            let marks = part.iter().map(|row| (point(row), regimes.get(*row).copied().unwrap_or("")));
            let size = 0.8 * style::MARKER;
            mark_regimes(figure, &frame, marks, size, MARKER_ROOM * size, ink, theme);
        }
    }
    figure.data = drawn(picture, &[(x, ranges.x)]).table();
    frame.axes(figure, theme);
}

/// Shades what lies between two lines from one value to the next, where both have values.
fn between(figure: &mut Figure, a: (Point, Point), b: (Point, Point), ink: Ink, within: Area) {
    let ends = [a.0, a.1, b.0, b.1];
    if !ends.iter().all(|(x, y)| x.is_finite() && y.is_finite()) {
        return;
    }
    let clamped = |(x, y): Point| (x.clamp(within.left, within.right), y.clamp(within.top, within.bottom));
    let (before, after) = (a.0.1 - a.1.1, b.0.1 - b.1.1);
    if before * after < 0.0 {
        let share = before / (before - after);
        let mix = |p: f64, q: f64| p + share * (q - p);
        let meet = clamped((mix(a.0.0, b.0.0), mix(a.0.1, b.0.1)));
        figure.polygon(vec![clamped(a.0), meet, clamped(a.1)], ink);
        figure.polygon(vec![clamped(b.0), meet, clamped(b.1)], ink);
    } else {
        figure.polygon(vec![clamped(a.0), clamped(b.0), clamped(b.1), clamped(a.1)], ink);
    }
}

/// Width of a colour bar.
const BAR: f64 = 24.0;
/// On a wide canvas: where the first panel begins, the gaps before the others, and the room after the last.
const FIRST: f64 = 150.0;
const GAPS: [f64; 2] = [36.0, 170.0];
const AFTER: f64 = 179.0;
/// On a narrow canvas, where they are stacked: between two of them, right of them, and what three need.
const BETWEEN: f64 = 76.0;
const BESIDE: f64 = 185.0;
pub(super) const STACKED: f64 = 1100.0;

/// Where the panels are: side by side, or one under the other with the first axis alone to the left.
fn panels(figure: &Figure, y: &PlotAxis, top: f64) -> [Area; 3] {
    let (width, bottom) = (figure.canvas.right, figure.bottom());
    if figure.is_narrow() {
        let (left, right) = (Frame::left(figure, y, FIRST, (bottom - top) / 3.0), width - BESIDE);
        let height = (bottom - top - 2.0 * BETWEEN) / 3.0;
        return [0.0, 1.0, 2.0].map(|place| {
            let top = top + place * (height + BETWEEN);
            Area::new(left, top, right, top + height)
        });
    }
    let each = (width - FIRST - GAPS[0] - GAPS[1] - AFTER) / 3.0;
    let second = FIRST + each + GAPS[0];
    [FIRST, second, second + each + GAPS[1]].map(|left| Area::new(left, top, left + each, bottom))
}

/// The quantity over two fields on the way up and on the way down, and what the way down has more.
pub(super) fn walked_maps(figure: &mut Figure, picture: &SweepPicture, (x, y): (&str, &str), theme: &Theme) {
    let SweepPicture { rows, ranges, .. } = *picture;
    let quantity = Quantity::of(rows, picture.quantity);
    let ways = rows.words(DIRECTION);
    let [up, down] = [Direction::Up, Direction::Down]
        .map(|way| Mosaic::new(rows, (x, y), &quantity, |row| ways[row] == way.name()));
    let bar = quantity.axis(0.0, 6);
    let difference: Vec<Cell> = up
        .cells
        .iter()
        .zip(&down.cells)
        .map(|(up, down)| less(*down, *up, quantity.words.is_some()))
        .collect();
    let values = difference.iter().filter_map(Cell::value).map(f64::abs);
    let largest = values.fold(0.0, f64::max);
    let reach = if largest > 0.0 { largest } else { 1.0 };
    let unit = if quantity.unit.is_empty() { &quantity.label } else { &quantity.unit };
    let signed = PlotAxis::between(-reach, reach, 6, &format!("down \u{2212} up, {unit}"));
    let tint = |value: f64| {
        let share = (value / reach).clamp(-1.0, 1.0);
        let ink = if share < 0.0 { theme.regimes[1] } else { theme.regimes[3] };
        ink.over(theme.rest, share.abs())
    };
    figure.data = drawn(picture, &[(x, ranges.x), (y, ranges.y)]).table();
    let both: Vec<Cell> = up.cells.iter().chain(&down.cells).copied().collect();
    let mut entries = meanings(rows, &quantity, &both, theme);
    if quantity.words.is_some() {
        entries.push((Sample::Patch(theme.ink, None), "differs"));
    }
    let ends = (FIRST + 10.0, figure.right());
    let top = (58.0 + TOP).max(legend(figure, theme, &entries, ends, 146.0) + 62.0);
    let last = Mosaic { cells: difference, ..up.clone() };
    let labels = (label(rows, x), label(rows, y));
    let whole = Area::new(0.0, 0.0, 1.0, 1.0);
    let areas = panels(figure, &up.frame(whole, (&labels.0, &labels.1), ranges).y, top);
    let stacked = figure.is_narrow();
    for (i, (mosaic, name)) in
        [(&up, "up"), (&down, "down"), (&last, "down \u{2212} up")].into_iter().enumerate()
    {
        let Area { left, right, top, .. } = areas[i];
        let mut frame = mosaic.frame(areas[i], (&labels.0, &labels.1), ranges);
        if stacked && i < 2 {
            frame.x = frame.x.silent();
        } else if !stacked && i > 0 {
            frame.y = frame.y.silent();
        }
        mosaic.paint(figure, &frame, theme, |value| match (i, quantity.words.is_some()) {
            (2, true) if value == 0.0 => theme.rest,
            (2, true) => theme.ink,
            (2, false) => tint(value),
            (_, true) => quantity.ink(value, theme),
            (_, false) => viridis(bar.share(value)),
        });
        frame.axes(figure, theme);
        let name = if quantity.words.is_some() && i == 2 { "where they differ" } else { name };
        let text = Text::new(name, (0.5 * (left + right), top - 16.0), style::AXIS, theme.ink);
        figure.text(Text { align: Align::Centre, ..text });
    }
    if quantity.words.is_none() {
        let beside = |panel: usize| {
            let Area { right, top, bottom, .. } = areas[panel];
            Area::new(right + 16.0, top, right + 16.0 + BAR, bottom)
        };
        colour_bar(figure, beside(1), &bar, theme, viridis);
        colour_bar(figure, beside(2), &signed, theme, |share| tint((2.0 * share - 1.0) * reach));
    }
}

/// What the one cell has more than the other; of regimes, whether they differ.
fn less(down: Cell, up: Cell, regimes: bool) -> Cell {
    match (down, up) {
        (Cell::Missing, _) | (_, Cell::Missing) => Cell::Missing,
        (down, up) if regimes => Cell::Value(f64::from(u8::from(down != up))),
        (down, up) => Cell::Value(down.value().unwrap_or(0.0) - up.value().unwrap_or(0.0)),
    }
}

impl Cell {
    fn value(&self) -> Option<f64> {
        if let Self::Value(value) = self { Some(*value) } else { None }
    }
}
