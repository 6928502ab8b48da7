//! Picture of a map with cuts through it beside it: the quantity over one field at a value of the other.

use super::axis::PlotAxis;
use super::figure::{Area, Figure, Point, Text};
use super::frame::Frame;
use super::map::{Lines, Map};
use super::mark::{REGIMES, Sample, regime};
use super::quantity::Quantity;
use super::style::{self, Theme};
use super::swept::{Cut, LEFT, MARKER_ROOM, SweepPicture, below_legend, label, mark_regimes};
use crate::numeric::short;
use crate::study::{label_and_unit, line_meets};

/// Share of a wide canvas at which the map ends, its colour bar beside it, and where the cuts begin.
const MAP: f64 = 0.46;
const BAR: (f64, f64) = (24.0, 52.0);
const CUTS: f64 = 0.68;
/// On a narrow canvas, where the cuts are under the map: room right of it.
const BESIDE: f64 = 175.0;
/// Between the frames of two cuts, and above the first for its heading.
const BETWEEN: f64 = 150.0;
const HEADING: f64 = 40.0;

/// What the map and `count` cuts need between the captions.
pub(super) fn least(count: usize, theme: &Theme) -> f64 {
    if theme.is_narrow() { 480.0 + 440.0 * count as f64 } else { 420.0 + 300.0 * (count as f64 - 1.0) }
}

/// The map over the fields `x` and `y` and its cuts.
pub(super) fn map_with_cuts(
    figure: &mut Figure,
    picture: &SweepPicture,
    (x, y): (&str, &str),
    cuts: &[Cut],
    theme: &Theme,
) {
    let map = Map::new(picture, (x, y));
    let panels: Vec<Panel> = cuts.iter().map(|cut| Panel::new(picture, (x, y), cut, &map.lines)).collect();
    let mut entries = map.entries(picture, theme);
    for (name, shape) in REGIMES {
        if panels.iter().any(|panel| panel.marks.iter().any(|mark| mark.1 == name)) {
            let ink = regime(name, theme).1;
            entries.retain(|entry| entry.1 != name);
            entries.push((Sample::Marker(shape, ink), name));
        }
    }
    let top = below_legend(figure, theme, &entries);
    let (width, bottom, count) = (figure.canvas.right, figure.bottom(), panels.len() as f64);
    let narrow = figure.is_narrow();
    // narrow: the map has as much height as a cut
    let share = (bottom - top - BETWEEN * count) / (count + 1.0);
    let (right, low) = if narrow { (width - BESIDE, top + share) } else { (MAP * width, bottom) };
    let frame = map.draw(figure, picture, (x, y), (top, right, low), BAR, theme);
    let first = if narrow { low + BETWEEN } else { top + HEADING };
    let height = (bottom - first - BETWEEN * (count - 1.0)) / count;
    let mut drawn = map.drawn(picture, (x, y));
    for (place, panel) in panels.iter().enumerate() {
        let begin = first + place as f64 * (height + BETWEEN);
        let [from, to] = if panel.upright {
            [(panel.value, frame.y.low), (panel.value, frame.y.high)]
        } else {
            [(frame.x.low, panel.value), (frame.x.high, panel.value)]
        };
        frame.line(figure, &[from, to], style::LINE + 3.0, style::BLACK);
        frame.dashed(figure, &[from, to], style::LINE, style::WHITE, style::DOT);
        let up = panel.quantity.axis(0.06, 5);
        let left = if narrow { Frame::left(figure, &up, LEFT, height) } else { CUTS * width };
        let area = Area::new(left, begin, figure.right(), begin + height);
        panel.draw(figure, area, up, theme);
        for (series, at) in panel.thresholds() {
            let (a, b) = if panel.upright { (panel.value, at) } else { (at, panel.value) };
            drawn.put(series, &[a, b], &[]);
        }
    }
    figure.data = drawn.table();
}

struct Panel {
    /// Whether it is along the map's axis upward.
    upright: bool,
    value: f64,
    heading: String,
    label: String,
    quantity: Quantity,
    range: Option<(f64, f64)>,
    /// Places in the data with their regimes, ascending.
    marks: Vec<(Point, &'static str)>,
    release: Vec<f64>,
    crossing: Vec<f64>,
}

impl Panel {
    fn new(picture: &SweepPicture, (x, y): (&str, &str), cut: &Cut, lines: &Lines) -> Self {
        let rows = picture.rows;
        let upright = cut.column == x;
        let (along, range) = if upright { (y, picture.ranges.y) } else { (x, picture.ranges.x) };
        let quantity = Quantity::of(rows, picture.quantity);
        let numbers = |name: &str| rows.numbers(name).unwrap_or_default();
        let (at, places, regimes) = (numbers(&cut.column), numbers(along), rows.words("regime"));
        let mut marks: Vec<(Point, &str)> = (0..rows.rows())
            .filter(|row| at[*row] == cut.value)
            .map(|row| ((places[row], quantity.values[row]), regimes.get(row).copied().unwrap_or("")))
            .collect();
        marks.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
        let cuts = |lines: &[Vec<Point>]| {
            let mut all: Vec<f64> =
                lines.iter().flat_map(|line| line_meets(line, cut.value, upright)).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        };
        let (name, unit) = label_and_unit(&cut.column);
        Self {
            upright,
            value: cut.value,
            heading: format!("at {name} {} {unit}", short(cut.value)).trim_end().to_owned(),
            label: label(rows, along),
            range,
            release: cuts(lines.release.as_slice()),
            crossing: cuts(&lines.crossing),
            quantity,
            marks,
        }
    }

    /// The places of both thresholds along it, with their names in the data.
    fn thresholds(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let release = self.release.iter().map(|at| ("cut_release", *at));
        release.chain(self.crossing.iter().map(|at| ("cut_first_crossing", *at)))
    }

    fn draw(&self, figure: &mut Figure, area: Area, up: PlotAxis, theme: &Theme) {
        let places = self.marks.iter().map(|mark| mark.0.0);
        let across = PlotAxis::around(places, 0.02, 5, &self.label).or_given(self.range, 5, &self.label);
        let frame = Frame::new(area, across, up);
        frame.grid(figure, theme);
        for (series, at) in self.thresholds() {
            if series == "cut_release" {
                frame.vertical(figure, at, style::GUIDE, theme.ink, None);
                frame.vertical(figure, at, style::LINE, theme.paper, Some(style::DASH));
            } else {
                frame.vertical(figure, at, style::LINE, style::OVER_MAP, None);
            }
        }
        for part in self.marks.split(|mark| !mark.0.1.is_finite()) {
            let points: Vec<Point> = part.iter().map(|mark| mark.0).collect();
            if self.quantity.words.is_none() {
                frame.line(figure, &points, style::FINE_LINE, theme.soft);
            }
            let size = 0.7 * style::MARKER;
            mark_regimes(figure, &frame, part.iter().copied(), size, MARKER_ROOM * size, theme.ink, theme);
        }
        frame.axes(figure, theme);
        let heading = Text::new(&self.heading, (area.left, area.top - 14.0), style::TICK, theme.ink);
        figure.text(Text { bold: true, ..heading });
    }
}
