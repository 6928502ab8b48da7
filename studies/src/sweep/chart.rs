//! Picture of a sweep: lines over one field, maps over two, both directions of a walk, surfaces and cuts.

use super::map::{cells_panel, map, surface};
use super::picture::{
    NOT_SETTLED, SweepPicture, View, ascending, cells, drawn, is_transient, marks, of_each, spans, swept_axis,
};
use super::walked::{Walk, WalkedRun};
use crate::numeric::short;
use crate::output::{
    Chart, Colours, Layer, MAX_SURFACE_CELLS, Marks, Panel, PanelColumn, PlotAxis, Quantity, Role, Shade,
    Shades, as_numbers, quantities, words_of,
};
use crate::scene::{Scene, Start, find_name};
use crate::study::{DIRECTION, Direction, Grid, SUMMARY_FIELDS, Table};

/// Largest number of cells in a picture: more than its pixels can distinguish.
pub const MAX_PICTURE_CELLS: u64 = 500_000;

/// Why a table has no picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoPicture {
    /// Neither a line nor a map.
    #[error(
        "a picture shows a sweep over one field (a line) or two (a map), not over {0}: take the others out"
    )]
    Fields(usize),
    /// One threshold.
    #[error(
        "a picture shows thresholds over another field (a line) or two (a map), and there is one threshold: \
         give `over` a field"
    )]
    SingleThreshold,
    /// One periodic motion.
    #[error("a picture shows a branch of motions, and there is one motion: give `branch` a field")]
    SingleMotion,
    /// Exponents or escapes of a single motion, or over several fields.
    #[error("a picture shows {0} over one field, not over {1}: give `over` one field")]
    OneField(&'static str, usize),
    /// Finer than a picture.
    #[error("a picture shows at most {MAX_PICTURE_CELLS} cells, not {0}: take longer steps")]
    Cells(u64),
    /// More starts than a picture can distinguish.
    #[error("a picture shows at most {MAX_PICTURE_CELLS} starts, not {0}: take fewer")]
    Starts(u64),
    /// A surface or a cut needs a map.
    #[error(
        "a surface and cuts show a sweep over two fields, each of two values or more, without `carry`: give \
         `over` two fields"
    )]
    NoMap,
    /// A cut along a column that the map does not have.
    #[error("a cut at a value of {0}: the map is over {1}; cut it at a value of one of them")]
    NoSuchCut(String, String),
    /// Rows of another sweep.
    #[error("the rows have no column {0}, which is swept: draw them with the grid of their own sweep")]
    NoSuchColumn(String),
    /// Words instead of heights.
    #[error("a surface shows heights, and the quantity {0} has words: name a column of numbers")]
    FlatWords(String),
    /// More faces than can be distinguished.
    #[error("a surface shows at most {MAX_SURFACE_CELLS} cells, not {0}: take longer steps, or `View::Top`")]
    SurfaceCells(u64),
    /// No column that can be shown.
    #[error("quantity {name}: {problem}")]
    Quantity {
        /// The column as given.
        name: String,
        /// What may have been meant, and the columns that exist.
        problem: String,
    },
}

/// Checks that the column that a person calls `quantity`, of a sweep of this grid, can be shown in this way,
/// and returns its full name; `table` is that of its rows, which may still be empty.
#[doc(hidden)]
pub fn can_show<'a>(
    grid: &'a Grid,
    quantity: &str,
    view: &View,
    table: &'a Table,
) -> Result<&'a str, NoPicture> {
    let shown: Vec<&str> = quantities(table, grid).collect();
    let quantity = find_name("column to show", quantity, &shown).map_err(|problem| {
        let known = shown.iter().copied();
        let more = SUMMARY_FIELDS.iter().map(|field| field.name).filter(|name| !shown.contains(name));
        let known: Vec<&str> = known.chain(more).collect();
        // a name that the rows lack may be that of a column that was not computed
        let problem = find_name("column to show", quantity, &known).err().unwrap_or(problem);
        NoPicture::Quantity { name: quantity.to_owned(), problem }
    })?;
    if *view != View::Top {
        let lengths = || grid.axes().iter().map(|axis| axis.values.len());
        match (view, grid.cells()) {
            _ if lengths().count() != 2 || lengths().min() < Some(2) => return Err(NoPicture::NoMap),
            _ if table.column(DIRECTION).is_some() => return Err(NoPicture::NoMap),
            (View::Surface, _) if words_of(quantity).is_some() => {
                return Err(NoPicture::FlatWords(quantity.to_owned()));
            }
            (View::Surface, n) if n > MAX_SURFACE_CELLS => return Err(NoPicture::SurfaceCells(n)),
            (View::Cuts(cuts), _) => {
                if let Some(cut) = cuts.iter().find(|cut| !grid.columns().contains(&cut.column)) {
                    return Err(NoPicture::NoSuchCut(cut.column.clone(), grid.columns().join(" and ")));
                }
            }
            _ => {}
        }
    }
    if let Some(name) = grid.columns().iter().find(|name| table.numbers(name).is_none()) {
        return Err(NoPicture::NoSuchColumn(name.clone()));
    }
    match grid.axes().len() {
        1 | 2 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 | 2 => Ok(quantity),
        n => Err(NoPicture::Fields(n)),
    }
}

/// Checks that `what` can be shown over the field of this grid.
pub(crate) fn can_show_over_field(grid: &Grid, what: &'static str) -> Result<(), NoPicture> {
    match grid.axes().len() {
        1 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 => Ok(()),
        n => Err(NoPicture::OneField(what, n)),
    }
}

/// Largest number of values of a field that are shown as lines, one per value, instead of a map.
const FEW: usize = 6;
/// Smallest ratio of the number of values of the other field to these.
const MANY: usize = 3;

/// The picture of a sweep: a line over one field; over two fields a map, or one line per value of a field
/// with few values.
///
/// # Errors
///
/// [`NoPicture::Fields`] over more than two fields, [`NoPicture::Cells`] for more cells than a picture can
/// show, [`NoPicture::Quantity`] for a column that is not there or has no picture, and the others for rows
/// of another sweep and for a surface or cuts that the map does not allow.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::output::{Caption, Format, SweepPicture, Theme, sweep_chart};
/// use interwell::questions::{Progress, Simulation, Sweep};
///
/// let simulation = Simulation::preset("nominal-cubic")?.with("run.tolerance", 1e-6)?;
/// let sweep = Sweep::over("stops.travel_limit_mm", 2.0..=6.0, 8);
/// let sweep = sweep.and("excitation.amplitude_g", 0.5..=1.5, 8);
/// let rows = sweep.run(&simulation, &Progress::none())?;
/// let grid = simulation.grid(&sweep.over)?;
/// let chart = sweep_chart(&SweepPicture::of(&simulation, &grid, &rows, "rms_velocity")).unwrap();
/// let figure = chart.figure(&Caption::new(simulation.document(), "1.0"), &Theme::LIGHT);
/// assert!(Format::Svg.bytes(&figure).unwrap().starts_with(b"<svg"));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
pub fn sweep_chart(picture: &SweepPicture) -> Result<Chart, NoPicture> {
    let SweepPicture { rows, grid, scene, until_settled, .. } = *picture;
    let quantity = can_show(grid, picture.quantity, &picture.view, rows)?;
    let picture = &SweepPicture { quantity, ..picture.clone() };
    let ways = rows.words(DIRECTION);
    let walked = Direction::ALL.into_iter().filter(|way| ways.contains(&way.name()));
    let walked: Vec<Direction> = walked.collect();
    let mut chart = match (grid.columns(), few_lines(rows, grid)) {
        ([x, y], _) if picture.view == View::Surface => surface(picture, (x, y)),
        ([x, y], _) if let View::Cuts(cuts) = &picture.view => map(picture, (x, y), cuts),
        ([x], _) if walked.len() == 2 => lines(picture, x, &both_ways(rows, x)),
        ([x, y], _) if walked.len() == 2 => walked_maps(picture, (x, y)),
        ([x], _) => lines(picture, x, &each_line(rows, x, None)),
        (_, Some((x, series))) => lines(picture, x, &each_line(rows, x, Some(series))),
        ([x, y], None) => map(picture, (x, y), &[]),
        (other, None) => return Err(NoPicture::Fields(other.len())),
    };
    chart.subtitle = sweep_about(grid, scene, &walked, until_settled);
    if !picture.draws.is_empty() {
        let is_band = |layer: &Layer| matches!(layer.marks, Marks::Band(_));
        let (before, after) = match chart.panels().any(|panel| panel.layers.iter().any(is_band)) {
            true => ("", ""),
            false => ("the band of ", " is in the table"),
        };
        chart.subtitle = format!("{}, {before}{}{after}", chart.subtitle, picture.draws);
    }
    let quantity = Quantity::of(rows, picture.quantity);
    if grid.axes().len() > 1 && quantity.kinds.is_some() {
        // the colours of kinds have no axis that names the quantity
        chart.subtitle = format!("{}: {}", quantity.label, chart.subtitle);
    }
    Ok(chart)
}

/// Of two swept fields, the one on the horizontal axis and the one with a line per value, if one has few
/// values.
pub(crate) fn few_lines<'a>(rows: &Table, grid: &'a Grid) -> Option<(&'a str, &'a str)> {
    let [a, b] = grid.columns() else { return None };
    let count = |name: &str| distinct(rows.numbers(name).unwrap_or_default()).len();
    let few = |of: &str, beside: &str| are_few(count(of), count(beside));
    match (few(b, a), few(a, b)) {
        (true, _) => Some((a, b)),
        (false, true) => Some((b, a)),
        _ => None,
    }
}

/// Whether a field of `few` values is shown as lines over another one of `many` values.
pub(super) fn are_few(few: usize, many: usize) -> bool {
    few <= FEW && many >= MANY * few
}

/// The values in ascending order, each once.
pub(crate) fn distinct(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// A description of the runs in one line, with the directions in which they were `walked`, if each continued
/// from the one before, and the time in s up to which runs continued until they repeat, if they did.
fn sweep_about(grid: &Grid, scene: &Scene, walked: &[Direction], until_settled: Option<f64>) -> String {
    let lengths = grid.axes().iter().map(|axis| axis.values.len());
    let counts = Some(walked.len()).filter(|ways| *ways > 1).into_iter().chain(lengths);
    let counts: Vec<String> = counts.map(|n| n.to_string()).collect();
    let swept = |field: &str| grid.axes().iter().any(|axis| axis.field == field);
    let mut parts = vec![format!("{} runs", counts.join(" \u{d7} "))];
    if !swept("run.duration_s") {
        let longest = until_settled.map_or_else(String::new, |until| format!(" to {}", short(until)));
        parts[0] += &format!(" of {}{longest} s", short(scene.run.duration_s));
    }
    if !walked.is_empty() {
        let ways: Vec<&str> = walked.iter().map(|way| way.name()).collect();
        parts.push(format!("{}, each from the end of the one before", ways.join(" and ")));
    } else if scene.start == Start::Rest {
        parts.push("each from rest".to_owned());
    }
    if let Some(drive) = scene.harmonic().filter(|drive| !swept(drive.frequency_path())) {
        parts.push(format!("shaken at {}", drive.frequency_in_words()));
    }
    parts.join(", ")
}

/// The quantity over the field `x`, each value marked with its regime; values between which no line has a
/// meaning stand in a panel for each line.
fn lines(picture: &SweepPicture, x: &str, each: &[SeriesLine]) -> Chart {
    let SweepPicture { rows, ranges, .. } = *picture;
    let places = rows.numbers(x).unwrap_or_default();
    let quantity = Quantity::of(rows, picture.quantity);
    // most quantities are never negative; the room below 0 is for the markers
    let up = quantity.axis_of_band(0.05).or_given(ranges.y);
    let empty = Panel::new(swept_axis(rows, x, ranges.x), up);
    // values between two seeds or two regimes have no meaning
    let joined = !(x == "seed" || x.ends_with(".seed") || quantity.kinds.is_some());
    let panel_of = |lines: &[SeriesLine]| {
        let mut panel = empty.clone();
        let all: Vec<usize> = lines.iter().flat_map(|line| line.order.iter().copied()).collect();
        let missing = all.iter().copied().filter(|row| quantity.cells[*row] == Shade::Missing);
        panel.layer_if_any(Role::Missing, quantity.missing(rows), spans(places, missing));
        let way = |place: usize| {
            let order = lines.get(place).map_or(&[][..], |line| line.order.as_slice());
            WalkedRun::of_rows(rows, x, &quantity, order)
        };
        let both = joined && matches!(lines, [_, SeriesLine { role: Role::Down, .. }]);
        let walk = if both { Walk::new([way(0), way(1)]) } else { Walk::default() };
        panel.layer_if_any(Role::Hysteresis, "hysteresis", Marks::Spans(walk.differing.clone()));
        for (place, SeriesLine { order, name, role }) in lines.iter().enumerate() {
            if !joined {
                panel.heading.clone_from(name);
                continue;
            }
            if let Some([low, high]) = &quantity.band {
                let band = order.iter().map(|&row| [places[row], low[row], high[row]]).collect();
                panel.layer(Role::Around, "95 % of the draws", Marks::Band(band));
            }
            let points = match (rows.column(DIRECTION), both) {
                (Some(_), true) => walk.line(place),
                (Some(_), false) => Walk::new([way(place), Vec::new()]).line(0),
                (None, _) => order.iter().map(|&row| (places[row], quantity.values[row])).collect(),
            };
            panel.layer(if name.is_empty() { Role::Joined } else { *role }, name, Marks::Path(points));
        }
        let marks = marks(&all, places, &quantity, panel.y.low, rows);
        panel.draw(Role::Motion, Marks::Regimes(marks, joined));
        let transients = all.iter().filter(|row| is_transient(rows, **row));
        let transients = transients.map(|&row| (places[row], quantity.values[row])).collect();
        panel.layer_if_any(Role::Transient, NOT_SETTLED, Marks::Cloud(transients));
        panel
    };
    let panels = each.chunks(if joined { each.len() } else { 1 }).map(panel_of).collect();
    let mut drawn = drawn(picture, &[(x, ranges.x)]);
    let values = rows.column(picture.quantity).and_then(as_numbers).unwrap_or_default();
    let is_seen = |row: &usize| ranges.x.is_none_or(|(a, b)| (a..=b).contains(&places[*row]));
    for row in (0..rows.rows()).filter(is_seen).filter(|row| is_transient(rows, *row)) {
        drawn.put("transient", &[places[row], values.get(row).copied().unwrap_or(f64::NAN)], &[]);
    }
    Chart::stack(panels, "", drawn.table())
}

/// One of several lines over a field: its rows in ascending order, its name and its role.
pub(crate) struct SeriesLine {
    pub order: Vec<usize>,
    pub name: String,
    pub role: Role,
}

/// A line over the field `x` for each value of `series`, or one of all rows.
pub(crate) fn each_line(rows: &Table, x: &str, series: Option<&str>) -> Vec<SeriesLine> {
    let places = rows.numbers(x).unwrap_or_default();
    let Some(name) = series.filter(|_| rows.rows() > 0) else {
        return vec![SeriesLine {
            order: ascending(places, |_| true),
            name: String::new(),
            role: Role::Curve,
        }];
    };
    let values = rows.numbers(name).unwrap_or_default();
    let each = distinct(values);
    let last = each.len().saturating_sub(1).max(1) as f64;
    let line = |(i, (value, name))| {
        let (order, role) = (ascending(places, |row| values[row] == value), Role::Step(i as f64 / last));
        SeriesLine { order, name, role }
    };
    each.iter().copied().zip(of_each(name, &each)).enumerate().map(line).collect()
}

/// The line on the way up, and that on the way down.
fn both_ways(rows: &Table, x: &str) -> [SeriesLine; 2] {
    let (places, ways) = (rows.numbers(x).unwrap_or_default(), rows.words(DIRECTION));
    [(Direction::Up, Role::Curve), (Direction::Down, Role::Down)].map(|(way, role)| {
        let name = way.name();
        SeriesLine { order: ascending(places, |row| ways[row] == name), name: name.to_owned(), role }
    })
}

/// The quantity over two fields on the way up and on the way down, and the difference of the second from the
/// first.
fn walked_maps(picture: &SweepPicture, (x, y): (&str, &str)) -> Chart {
    let SweepPicture { rows, ranges, .. } = *picture;
    let quantity = Quantity::of(rows, picture.quantity);
    let ways = rows.words(DIRECTION);
    let [up, down] = Direction::ALL.map(|way| cells(rows, (x, y), &quantity, |row| ways[row] == way.name()));
    let has_kinds = quantity.kinds.is_some();
    let more: Vec<Shade> =
        up.cells.iter().zip(&down.cells).map(|(up, down)| difference(*down, *up, has_kinds)).collect();
    let largest = more.iter().filter_map(|cell| cell.value()).map(f64::abs).fold(0.0, f64::max);
    let reach = if largest > 0.0 { largest } else { 1.0 };
    let unit = if quantity.unit.is_empty() { &quantity.label } else { &quantity.unit };
    let signed = PlotAxis::between(-reach, reach, &format!("down \u{2212} up ({unit})"));
    let colours = match has_kinds {
        true => Colours::Categories(
            [(Role::Several, "the same"), (Role::Curve, "differs")]
                .map(|(role, name)| (role, name.into()))
                .into(),
        ),
        false => Colours::Signed(reach),
    };
    let difference = Shades { cells: more, colours, ..up.clone() };
    let last = if has_kinds { "where they differ" } else { "down \u{2212} up" };
    let bar = quantity.bar();
    let columns = [(up, "up", &bar), (down, "down", &bar), (difference, last, &signed)];
    let columns = columns.into_iter().enumerate().map(|(i, (cells, heading, axis))| {
        let mut panel = cells_panel(picture, (x, y), cells, axis.clone());
        heading.clone_into(&mut panel.heading);
        // the first two share a scale
        panel.bar = panel.bar.filter(|_| i > 0);
        PanelColumn { width: 1.0, panels: vec![panel] }
    });
    let data = drawn(picture, &[(x, ranges.x), (y, ranges.y)]).table();
    Chart { columns: columns.collect(), subtitle: String::new(), data }
}

/// The difference of two cells; for kinds, whether they differ.
fn difference(down: Shade, up: Shade, has_kinds: bool) -> Shade {
    match (down, up) {
        (Shade::Missing | Shade::Blank, _) | (_, Shade::Missing | Shade::Blank) => Shade::Missing,
        (down, up) if has_kinds => Shade::Value(f64::from(u8::from(down != up))),
        (down, up) => Shade::Value(down.value().unwrap_or(0.0) - up.value().unwrap_or(0.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_no_option_of_the_command_line() {
        let [name, problem] = ["rms", "there are others"].map(str::to_owned);
        for error in [
            NoPicture::Fields(3),
            NoPicture::SingleThreshold,
            NoPicture::SingleMotion,
            NoPicture::OneField("escapes", 2),
            NoPicture::Cells(1_000_000),
            NoPicture::Starts(1_000_000),
            NoPicture::NoMap,
            NoPicture::NoSuchCut(name.clone(), problem.clone()),
            NoPicture::NoSuchColumn(name.clone()),
            NoPicture::FlatWords(name.clone()),
            NoPicture::SurfaceCells(100_000),
            NoPicture::Quantity { name, problem },
        ] {
            assert!(!error.to_string().contains("--"), "{error}");
        }
    }
}
