//! Picture of a section: points of the phase plane, and over a field the bifurcation diagram.

use crate::numeric::short;
use crate::output::{
    Chart, DISPLACEMENT, Drawn, Marks, Panel, PlotAxis, Ranges, Role, VELOCITY, axis_name, label, suited_unit,
};
use crate::study::{DIRECTION, Direction, Grid, IMPACTS, Table, Values};

/// A single section, or those `over` the field of a grid. The states are at the phase `phase_deg` of the
/// drive in degrees; without it the rows are impacts. `stops` are positions in m, where they are the same for
/// all rows.
pub(super) fn chart(
    rows: &Table,
    over: Option<&Grid>,
    phase_deg: Option<f64>,
    stops: (Option<f64>, Option<f64>),
    ranges: Ranges,
) -> Chart {
    let states = phase_deg.is_some();
    let (kinds, series, pair) = match states {
        true => (
            ["without impacts", "with impacts"],
            ["state_without_impacts", "state_with_impacts"],
            ["x_m", "v_m_per_s"],
        ),
        false => (["left stop", "right stop"], ["left_stop", "right_stop"], ["phase_deg", "v_in_m_per_s"]),
    };
    let kind = kind_of(rows, states);
    let numbers = |name: &str| rows.numbers(name).unwrap_or_default();
    let field = over.and_then(|grid| grid.columns().first()).map(String::as_str);
    let across = match field {
        Some(field) => Along { values: numbers(field).to_vec(), label: label(rows, field) },
        None => Along::of(numbers(pair[0]), pair[0]),
    };
    let upward = if over.is_some() && states { "x_m" } else { pair[1] };
    let up = Along::of(numbers(upward), upward);
    let x = match over.is_none() && !states {
        true => {
            let ticks = (0..=6).map(|i| (60.0 * f64::from(i), (60 * i).to_string())).collect();
            PlotAxis::given(0.0, 360.0, ticks, &across.label)
        }
        // a value without an impact has no row
        false => {
            let swept = over.iter().flat_map(|grid| &grid.axes()[0].values);
            PlotAxis::around(across.values.iter().chain(swept).copied(), 0.02, &across.label)
        }
    };
    let x = x.or_given(ranges.x);
    let y = PlotAxis::around(up.values.iter().copied(), 0.06, &up.label).or_given(ranges.y);
    let ways = rows.words(DIRECTION);
    let panel_of = |way: Option<Direction>| {
        let mut panel = Panel::new(x.clone(), y.clone());
        panel.heading = way.map_or("", Direction::name).to_owned();
        if over.is_none() && states {
            let mm = |stop: Option<f64>| stop.map_or(f64::NAN, |x| x * 1e3);
            panel.upright_stops((mm(stops.0), mm(stops.1)));
        }
        for (place, name) in kinds.into_iter().enumerate() {
            let is_shown = |row: usize| way.is_none_or(|way| ways[row] == way.name()) && kind(row) == place;
            let of_kind = (0..rows.rows()).filter(|row| is_shown(*row));
            let points = of_kind.map(|row| (across.values[row], up.values[row])).collect();
            panel.layer_if_any([Role::Regime(1), Role::Impacts][place], name, Marks::Cloud(points));
        }
        panel
    };
    let panels = match Direction::ALL.iter().all(|way| ways.contains(&way.name())) {
        true => Vec::from(Direction::ALL.map(|way| panel_of(Some(way)))),
        false => vec![panel_of(None)],
    };
    let names: Vec<&str> = field.into_iter().chain(pair).collect();
    let columns: Vec<&[f64]> = names.iter().map(|name| numbers(name)).collect();
    let mut drawn = Drawn::new(names, if ways.is_empty() { &[] } else { &[DIRECTION] });
    for row in (0..rows.rows()).filter(|row| x.contains(across.values[*row])) {
        let numbers: Vec<f64> =
            columns.iter().map(|column| column.get(row).copied().unwrap_or(f64::NAN)).collect();
        drawn.put(series[kind(row)], &numbers, ways.get(row..=row).unwrap_or_default());
    }
    Chart::stack(panels, about(rows, phase_deg), drawn.table())
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

impl Along {
    /// The numbers of a column of a section, in the unit of its axis.
    fn of(numbers: &[f64], name: &str) -> Self {
        let speed = |words: &str| {
            let (scale, unit) = suited_unit("m/s", numbers.iter().copied());
            (scale, axis_name(words, unit))
        };
        let (scale, label) = match name {
            "x_m" => (1e3, DISPLACEMENT.to_owned()),
            "v_m_per_s" => speed(VELOCITY),
            "v_in_m_per_s" => speed("velocity of the impact"),
            _ => (1.0, "phase of the drive (\u{b0})".to_owned()),
        };
        Self { values: numbers.iter().map(|value| value * scale).collect(), label }
    }
}

/// The subtitle.
fn about(rows: &Table, phase_deg: Option<f64>) -> String {
    let count = rows.rows();
    let points = match phase_deg {
        Some(phase) => format!("{count} states, one a forcing period at phase {}\u{b0}", short(phase)),
        None => format!("{count} impacts"),
    };
    let walked = rows.column(DIRECTION).is_some();
    if walked { points + ", each run from the end of the one before" } else { points }
}
