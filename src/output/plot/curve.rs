//! Picture of a mechanism: force and potential over displacement, with equilibria, kinks and stops.

use super::axis::{PlotAxis, Ranges};
use super::drawn::Drawn;
use super::figure::{Area, Figure, Point};
use super::frame::{Frame, stretched};
use super::mark::{Caption, Marker, Sample, legend, marker};
use super::style::{self, Theme};
use crate::mechanics::{Landscape, Mechanism};
use crate::numeric::{extent, short};
use crate::study::Table;

const LEFT: f64 = 160.0;
const GUTTER: f64 = 110.0;
/// Upper and lower edges of the frames on the canvas for a screen.
const FRAMES: [(f64, f64); 2] = [(175.0, 520.0), (550.0, 860.0)];
/// What the frames need between the captions.
const LEAST: f64 = 560.0;
const TICKS: usize = 5;

/// The picture of the curve in `table` (as [`curve`](crate::study::curve) gives it), with stops at these
/// positions in m, NaN where there is none. `ranges` are those of displacement and force.
pub fn curve_figure(
    table: &Table,
    mechanism: &Mechanism,
    stops: (f64, f64),
    ranges: Ranges,
    caption: &Caption,
    theme: &Theme,
) -> Figure {
    let mut figure = Figure::new(theme, caption, LEAST);
    let column = |name: &str| table.numbers(name).unwrap_or_default();
    let x: Vec<f64> = column("x_m").iter().map(|x| x * 1e3).collect();
    let pairs =
        |y: &[f64], scale: f64| -> Vec<Point> { x.iter().zip(y).map(|(x, y)| (*x, y * scale)).collect() };
    let landscape = &mechanism.landscape;
    let force_range = telling(&x, column("force_n"), landscape);
    let potential_range = telling(&x, column("potential_j"), landscape);
    let (force, force_unit) = scaled(force_range, &[(1.0, "N"), (1e-3, "mN")]);
    let (potential, potential_unit) = scaled(potential_range, &[(1.0, "J"), (1e-3, "mJ"), (1e-6, "\u{b5}J")]);
    let label = "displacement, mm";
    let across = PlotAxis::around(x.iter().copied(), 0.0, 9, label).or_given(ranges.x, 9, label);
    let inside = |at: f64| at * 1e3 >= across.low && at * 1e3 <= across.high;

    let height = |(low, high): (f64, f64), scale: f64, least: f64, label: &str| {
        PlotAxis::around([low * scale, high * scale, least], 0.08, TICKS, label)
    };
    let force_label = format!("force to hold, {force_unit}");
    let force_axis = height(force_range, force, 0.0, &force_label).or_given(ranges.y, TICKS, &force_label);
    let potential_axis =
        height(potential_range, potential, f64::NAN, &format!("potential, {potential_unit}"));
    let kinks: Vec<f64> = landscape.kinks.iter().map(|kink| kink.x).filter(|x| inside(*x)).collect();
    let mut entries = Vec::new();
    let any = |stable: bool| {
        landscape.equilibria.iter().any(|equilibrium| equilibrium.stable == stable && inside(equilibrium.x))
    };
    for (stable, words) in [(true, "stable equilibrium"), (false, "unstable equilibrium")] {
        if any(stable) {
            let (shape, ink) = kind(stable, theme);
            entries.push((Sample::Marker(shape, ink), words));
        }
    }
    if !kinks.is_empty() {
        entries.push((Sample::Line(theme.soft, style::LINE, Some(style::DOT)), "kink of the force"));
    }
    if inside(stops.0) || inside(stops.1) {
        entries.push((Sample::Patch(theme.wall_fill(), Some(theme.wall_hatch())), "stop"));
    }
    let ends = (LEFT, figure.right());
    let more = (legend(&mut figure, theme, &entries, ends, 142.0) - 161.0).max(0.0);
    let left = if figure.is_narrow() { GUTTER + style::AXIS } else { LEFT };
    let bottom = figure.bottom() - 8.0;
    let [upper, lower] = stretched(FRAMES, 175.0 + more, bottom)
        .map(|(top, bottom)| Area::new(left, top, figure.right(), bottom));
    let framed = |area, x, y| Frame { gutter: Some(GUTTER), ..Frame::new(area, x, y) };
    let frames = [
        (framed(upper, across.clone().silent(), force_axis), pairs(column("force_n"), force), theme.ink),
        (
            framed(lower, across.clone(), potential_axis),
            pairs(column("potential_j"), potential),
            theme.second,
        ),
    ];
    for (frame, line, ink) in &frames {
        frame.grid(&mut figure, theme);
        for (at, left) in [(stops.0, true), (stops.1, false)] {
            if at.is_finite() {
                frame.wall_across(&mut figure, at * 1e3, left, theme);
            }
        }
        kinks
            .iter()
            .for_each(|x| frame.vertical(&mut figure, x * 1e3, style::THIN, theme.soft, Some(style::DOT)));
        frame.path(&mut figure, line.iter().copied(), style::LINE + 0.8, *ink);
    }
    frames[0].0.horizontal(&mut figure, 0.0, style::THIN, theme.soft, None);
    for equilibrium in landscape.equilibria.iter().filter(|equilibrium| inside(equilibrium.x)) {
        let (shape, ink) = kind(equilibrium.stable, theme);
        let x = equilibrium.x;
        for (frame, y) in [(&frames[0].0, 0.0), (&frames[1].0, mechanism.curve.potential(x) * potential)] {
            marker(&mut figure, shape, frame.place((x * 1e3, y)), style::MARKER + 2.0, ink, theme.ink);
        }
    }
    frames.iter().for_each(|(frame, ..)| frame.axes(&mut figure, theme));

    figure.data = drawn(table, mechanism, stops, inside);
    let mut words = subtitle(landscape);
    if let Some(wall) = wall(column("x_m"), column("force_n"), &frames[0].0.y, force) {
        words += &wall;
    }
    caption.draw(&mut figure, theme, &words, LEFT);
    figure
}

/// All that is drawn at the positions in m that lie `inside`.
fn drawn(table: &Table, mechanism: &Mechanism, stops: (f64, f64), inside: impl Fn(f64) -> bool) -> Table {
    let names = ["x_m", "force_n", "potential_j"];
    let [x, force, potential] = names.map(|name| table.numbers(name).unwrap_or_default());
    let mut drawn = Drawn::new(names, &[]);
    for i in (0..x.len()).filter(|i| inside(x[*i])) {
        drawn.put("curve", &[x[i], force[i], potential[i]], &[]);
    }
    for equilibrium in mechanism.landscape.equilibria.iter().filter(|equilibrium| inside(equilibrium.x)) {
        let name = if equilibrium.stable { "stable_equilibrium" } else { "unstable_equilibrium" };
        drawn.put(name, &[equilibrium.x, 0.0, mechanism.curve.potential(equilibrium.x)], &[]);
    }
    let kinks = mechanism.landscape.kinks.iter().map(|kink| ("kink", kink.x));
    for (name, at) in kinks.chain([("stop", stops.0), ("stop", stops.1)]).filter(|mark| inside(mark.1)) {
        drawn.put(name, &[at], &[]);
    }
    drawn.table()
}

fn kind(stable: bool, theme: &Theme) -> (Marker, style::Ink) {
    if stable { (Marker::Disc, theme.stable) } else { (Marker::Triangle, theme.unstable) }
}

fn subtitle(landscape: &Landscape) -> String {
    let mut parts = Vec::new();
    if let Some(barrier) = landscape.barrier {
        let wells = (short(barrier.left_well * 1e3), short(barrier.right_well * 1e3));
        parts.push(format!("wells at {} and {} mm", wells.0.replace('-', "\u{2212}"), wells.1));
        let (left, right) = (short(barrier.from_left_j * 1e3), short(barrier.from_right_j * 1e3));
        parts.push(if left == right {
            format!("barrier of {left} mJ")
        } else {
            format!("barrier of {left} mJ from the left, {right} mJ from the right")
        });
    } else if landscape.equilibria.is_empty() {
        parts.push("no equilibrium".to_owned());
    } else {
        parts.push("one well".to_owned());
    }
    parts.join(", ")
}

/// What the picture does not show, where the force leaves it: how large it becomes, and where. `scale` is
/// that of the axis `up`.
fn wall(x: &[f64], force: &[f64], up: &PlotAxis, scale: f64) -> Option<String> {
    let beyond = |force: f64| force * scale < up.low || force * scale > up.high;
    let outside = x.iter().zip(force).filter(|(_, force)| force.is_finite() && beyond(**force));
    let (x, force) = outside.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let (force, x) = (short(*force), short(x * 1e3));
    Some(format!(", force leaves the picture ({force} N at {x} mm)").replace('-', "\u{2212}"))
}

/// The factor from SI and the name of the largest of `units` (each its size in SI, falling) in which the
/// greatest value of a range is 0.1 or more.
fn scaled((low, high): (f64, f64), units: &[(f64, &'static str)]) -> (f64, &'static str) {
    let greatest = [low, high].iter().filter(|value| value.is_finite()).fold(0.0_f64, |a, b| a.max(b.abs()));
    let fits =
        units.iter().find(|(size, _)| greatest >= 0.1 * size).or(units.last().filter(|_| greatest > 0.0));
    fits.or(units.first()).map_or((1.0, ""), |(size, unit)| (1.0 / size, *unit))
}

/// The range of values that tells something. Beyond the outermost equilibrium a force may rise like a wall
/// and press everything else flat: what lies there counts up to half the range between more on each side.
fn telling(x: &[f64], values: &[f64], landscape: &Landscape) -> (f64, f64) {
    let range = |from: f64, to: f64| {
        let inside = x.iter().zip(values).filter(|(x, v)| **x >= from && **x <= to && v.is_finite());
        extent(inside.map(|(_, v)| *v))
    };
    let (low, high) = range(f64::NEG_INFINITY, f64::INFINITY);
    let ends = landscape.equilibria.first().zip(landscape.equilibria.last());
    let Some((left, right)) = ends.filter(|(left, right)| left.x < right.x) else { return (low, high) };
    let (inner_low, inner_high) = range(left.x * 1e3, right.x * 1e3);
    let more = 0.5 * (inner_high - inner_low);
    if more > 0.0 { (low.max(inner_low - more), high.min(inner_high + more)) } else { (low, high) }
}
