//! Picture of a section: points of the phase plane, and over a field the bifurcation diagram.

use std::collections::HashSet;

use super::axis::{PlotAxis, Ranges};
use super::drawn::Drawn;
use super::figure::{Align, Area, Figure, Text};
use super::frame::Frame;
use super::mark::{Caption, Marker, Sample, dot};
use super::run::speed_unit;
use super::style::{self, Ink, Theme};
use super::swept::{LEAST, LEFT, below_legend, label};
use crate::numeric::short;
use crate::study::{DIRECTION, Direction, IMPACTS, Table, Values};

/// Half the size of a point: one of few, and one of many; as many or more of them.
const LARGE: f64 = 6.0;
const SMALL: f64 = 2.2;
const FEW: f64 = 100.0;
const MANY: f64 = 2000.0;

/// Room between two panels.
const BETWEEN: f64 = 46.0;

/// What the picture of a section is drawn from.
#[derive(Debug, Clone)]
pub struct SectionPicture<'a> {
    /// All rows.
    pub rows: &'a Table,
    /// The column of the field that it is taken over; none for a single section.
    pub over: Option<&'a str>,
    /// The phase of the drive in degrees at which the states are; none for impacts.
    pub phase_deg: Option<f64>,
    /// Positions of the stops in m, where they are the same for all rows.
    pub stops: (Option<f64>, Option<f64>),
    /// The axes to the right and upward.
    pub ranges: Ranges,
}

/// How points of one kind are drawn.
struct Kind {
    name: &'static str,
    shape: Marker,
    ink: Ink,
}

/// The picture of a section.
pub fn section_figure(picture: &SectionPicture, caption: &Caption, theme: &Theme) -> Figure {
    let mut figure = Figure::new(theme, caption, LEAST);
    let SectionPicture { rows, over, phase_deg, ranges, .. } = *picture;
    let kinds = match phase_deg {
        Some(_) => [("without impacts", Marker::Disc, 1), ("with impacts", Marker::Triangle, 3)],
        None => [("left stop", Marker::Disc, 1), ("right stop", Marker::Triangle, 3)],
    };
    let kinds = kinds.map(|(name, shape, ink)| Kind { name, shape, ink: theme.regimes[ink] });
    let kind = kind_of(rows, phase_deg.is_some());
    let present = |place: usize| (0..rows.rows()).any(|row| kind(row) == place);
    let mut entries: Vec<(Sample, &str)> = Vec::new();
    for (_, kind) in kinds.iter().enumerate().filter(|(place, _)| present(*place)) {
        entries.push((Sample::Marker(kind.shape, kind.ink), kind.name));
    }
    let wall = over.is_none() && phase_deg.is_some();
    if wall && (picture.stops.0.is_some() || picture.stops.1.is_some()) {
        entries.push((Sample::Patch(theme.wall_fill(), None), "stop"));
    }
    let (across, up) = columns_of(rows, over, phase_deg.is_some());
    let ways = rows.words(DIRECTION);
    let both = [Direction::Up, Direction::Down].iter().all(|way| ways.contains(&way.name()));
    let panels: &[Option<Direction>] =
        if both { &[Some(Direction::Up), Some(Direction::Down)] } else { &[None] };
    let top = below_legend(&mut figure, theme, &entries);
    let x = PlotAxis::around(across.values.iter().copied(), 0.02, 8, &across.label);
    let x = if over.is_none() && phase_deg.is_none() { turn(&across.label) } else { x };
    let x = x.or_given(ranges.x, 8, &across.label);
    let y = PlotAxis::around(up.values.iter().copied(), 0.06, 6, &up.label);
    let y = y.or_given(ranges.y, 6, &up.label);
    let (left, right) =
        (Frame::left(&figure, &y, LEFT, (figure.bottom() - top) / panels.len() as f64), figure.right());
    let height = (figure.bottom() - top - BETWEEN * (panels.len() - 1) as f64) / panels.len() as f64;
    for (number, way) in panels.iter().enumerate() {
        let begin = top + number as f64 * (height + BETWEEN);
        let last = number + 1 == panels.len();
        let axis = if last { x.clone() } else { x.clone().silent() };
        let frame = Frame::new(Area::new(left, begin, right, begin + height), axis, y.clone());
        frame.grid(&mut figure, theme);
        for (stop, left) in [(picture.stops.0, true), (picture.stops.1, false)] {
            if let Some(at) = stop.map(|x| x * 1e3).filter(|at| wall && (x.low..=x.high).contains(at)) {
                frame.wall_across(&mut figure, at, left, theme);
            }
        }
        let shown = |row: usize| way.is_none_or(|way| ways[row] == way.name());
        // Points on the same half pixel are one.
        let mut taken = HashSet::new();
        let mut points = Vec::new();
        for row in (0..rows.rows()).filter(|row| shown(*row)) {
            let at = frame.place((across.values[row], up.values[row]));
            let kind = kind(row);
            let pixel = ((2.0 * at.0) as i64, (2.0 * at.1) as i64, kind);
            if at.0.is_finite() && at.1.is_finite() && frame.area.contains(at) && taken.insert(pixel) {
                points.push((at, kind));
            }
        }
        let many = ((points.len() as f64 / FEW).ln() / (MANY / FEW).ln()).clamp(0.0, 1.0);
        let size = LARGE + many * (SMALL - LARGE);
        for (at, kind) in points {
            dot(&mut figure, kinds[kind].shape, at, size, kinds[kind].ink);
        }
        frame.axes(&mut figure, theme);
        if let Some(way) = way {
            let text = Text::new(way.name(), (right, begin - 12.0), style::AXIS, theme.ink);
            figure.text(Text { align: Align::Right, ..text });
        }
    }
    figure.data = drawn(rows, over, phase_deg.is_some(), |at| (x.low..=x.high).contains(&at));
    caption.draw(&mut figure, theme, &about(rows, picture), LEFT);
    figure
}

/// The rows whose place to the right is `inside`.
fn drawn(rows: &Table, over: Option<&str>, states: bool, inside: impl Fn(f64) -> bool) -> Table {
    let series =
        if states { ["state_without_impacts", "state_with_impacts"] } else { ["left_stop", "right_stop"] };
    let pair: &[&str] = if states { &["x_m", "v_m_per_s"] } else { &["phase_deg", "v_in_m_per_s"] };
    let names: Vec<&str> = over.into_iter().chain(pair.iter().copied()).collect();
    let columns: Vec<&[f64]> = names.iter().map(|name| rows.numbers(name).unwrap_or_default()).collect();
    let (kind, ways) = (kind_of(rows, states), rows.words(DIRECTION));
    let (across, _) = columns_of(rows, over, states);
    let mut drawn = Drawn::new(names, if ways.is_empty() { &[] } else { &[DIRECTION] });
    for row in (0..rows.rows()).filter(|row| inside(across.values[*row])) {
        let numbers: Vec<f64> =
            columns.iter().map(|column| column.get(row).copied().unwrap_or(f64::NAN)).collect();
        drawn.put(series[kind(row)], &numbers, ways.get(row..=row).unwrap_or_default());
    }
    drawn.table()
}

/// The axis of a phase in degrees.
fn turn(label: &str) -> PlotAxis {
    let ticks = (0..=6).map(|i| (60.0 * f64::from(i), (60 * i).to_string())).collect();
    PlotAxis { low: 0.0, high: 360.0, ticks, label: label.to_owned() }
}

/// Which of the two kinds a row is.
fn kind_of(rows: &Table, states: bool) -> impl Fn(usize) -> usize {
    let impacts = match rows.column(IMPACTS).map(|column| &column.values) {
        Some(Values::Counts(counts)) => counts.as_slice(),
        _ => &[],
    };
    let sides = rows.words("side");
    move |row| match states {
        true => usize::from(impacts.get(row).copied().flatten().is_some_and(|count| count > 0)),
        false => usize::from(sides.get(row) == Some(&"right")),
    }
}

/// Values along an axis, and its label.
struct Along {
    values: Vec<f64>,
    label: String,
}

/// What stands to the right and what upward.
fn columns_of(rows: &Table, over: Option<&str>, states: bool) -> (Along, Along) {
    let scaled = |name: &str, scale: f64, label: String| Along {
        values: rows.numbers(name).unwrap_or_default().iter().map(|value| value * scale).collect(),
        label,
    };
    let speed = |name: &str, words: &str| {
        let (scale, unit) = speed_unit(rows.numbers(name).unwrap_or_default().iter().copied());
        scaled(name, scale, format!("{words}, {unit}"))
    };
    let displacement = || scaled("x_m", 1e3, "displacement, mm".to_owned());
    match (over, states) {
        (Some(field), true) => (scaled(field, 1.0, label(rows, field)), displacement()),
        (Some(field), false) => {
            (scaled(field, 1.0, label(rows, field)), speed("v_in_m_per_s", "velocity of the impact"))
        }
        (None, true) => (displacement(), speed("v_m_per_s", "velocity")),
        (None, false) => (
            scaled("phase_deg", 1.0, "phase of the drive, \u{b0}".to_owned()),
            speed("v_in_m_per_s", "velocity of the impact"),
        ),
    }
}

/// What is shown, in one line.
fn about(rows: &Table, picture: &SectionPicture) -> String {
    let count = rows.rows();
    let points = match picture.phase_deg {
        Some(phase) => format!("{count} states, one a forcing period at phase {}\u{b0}", short(phase)),
        None => format!("{count} impacts"),
    };
    let walked = rows.column(DIRECTION).is_some();
    if walked { points + ", each run from where the one before was" } else { points }
}
