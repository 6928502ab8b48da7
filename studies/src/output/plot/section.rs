//! Picture of a section: points of the phase plane, and over a field the bifurcation diagram.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel};
use super::drawn::Drawn;
use super::figure::Point;
use super::quantity::suited_unit;
use super::role::Role;
use super::swept::label;
use crate::numeric::short;
use crate::study::{DIRECTION, Direction, IMPACTS, Table, Values};

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

/// The picture of a section.
pub fn section_chart(picture: &SectionPicture) -> Chart {
    let SectionPicture { rows, over, phase_deg, ranges, .. } = *picture;
    let states = phase_deg.is_some();
    let kinds = if states { ["without impacts", "with impacts"] } else { ["left stop", "right stop"] };
    let kind = kind_of(rows, states);
    let (across, up) = columns_of(rows, over, states);
    let x = match over.is_none() && !states {
        true => turn(&across.label),
        false => PlotAxis::around(across.values.iter().copied(), 0.02, &across.label),
    };
    let x = x.or_given(ranges.x);
    let y = PlotAxis::around(up.values.iter().copied(), 0.06, &up.label).or_given(ranges.y);
    let ways = rows.words(DIRECTION);
    let both = [Direction::Up, Direction::Down].iter().all(|way| ways.contains(&way.name()));
    let shown: &[Option<Direction>] =
        if both { &[Some(Direction::Up), Some(Direction::Down)] } else { &[None] };
    let panel_of = |way: &Option<Direction>| {
        let mut panel = Panel::new(x.clone(), y.clone());
        panel.heading = way.map_or_else(String::new, |way| way.name().to_owned());
        if over.is_none() && states {
            let mm = |stop: Option<f64>| stop.map_or(f64::NAN, |x| x * 1e3);
            panel.upright_stops((mm(picture.stops.0), mm(picture.stops.1)));
        }
        for (place, name) in kinds.into_iter().enumerate() {
            let is_shown = |row: usize| way.is_none_or(|way| ways[row] == way.name()) && kind(row) == place;
            let of_kind = (0..rows.rows()).filter(|row| is_shown(*row));
            let points: Vec<Point> = of_kind.map(|row| (across.values[row], up.values[row])).collect();
            if !points.is_empty() {
                panel.layer([Role::Regime(1), Role::Impacts][place], name, Marks::Cloud(points));
            }
        }
        panel
    };
    let panels = shown.iter().map(panel_of).collect();
    let data = drawn(rows, over, states, |at| x.contains(at));
    Chart::stack(panels, about(rows, picture), data)
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
    PlotAxis::given(0.0, 360.0, ticks, label)
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
        let (scale, unit) = suited_unit("m/s", rows.numbers(name).unwrap_or_default().iter().copied());
        scaled(name, scale, format!("{words} ({unit})"))
    };
    let displacement = || scaled("x_m", 1e3, "displacement (mm)".to_owned());
    match (over, states) {
        (Some(field), true) => (scaled(field, 1.0, label(rows, field)), displacement()),
        (Some(field), false) => {
            (scaled(field, 1.0, label(rows, field)), speed("v_in_m_per_s", "velocity of the impact"))
        }
        (None, true) => (displacement(), speed("v_m_per_s", "velocity")),
        (None, false) => (
            scaled("phase_deg", 1.0, "phase of the drive (\u{b0})".to_owned()),
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
