//! Picture of the distance of motions over time, on a logarithmic scale.

use super::axis::PlotAxis;
use super::chart::{Chart, Marks, Panel};
use super::drawn::Drawn;
use super::figure::Point;
use super::names::TIME;
use super::role::Role;
use crate::numeric::elementary;
use crate::questions::DistanceAnswer;

/// Decimal logarithm of the smallest distance shown, in mm; below it lies rounding error.
const MIN_LOG: f64 = -14.0;

/// Logarithm of a distance in m, in mm.
fn log_mm(metres: f64) -> f64 {
    elementary::log10(metres * 1e3)
}

/// The ends of the axis of the distance, logarithms of values in mm, for these distances in m.
pub fn distance_ends(distances: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let logs = distances.map(log_mm).filter(|log| log.is_finite());
    // if all motions are equal to the last digit, the axis starts at its lowest end
    let bottom = if logs.clone().next().is_some() { 0.0 } else { MIN_LOG };
    let low = logs.clone().fold(bottom, f64::min).floor().max(MIN_LOG);
    (low, logs.fold(low + 1.0, f64::max).ceil().max(1.0))
}

/// The panel of distances in m over time in s, between these ends of the axes. A solid line each, since so
/// steep a line has thousands of dashes.
pub fn distance_panel(lines: &[Vec<Point>], (from, to): (f64, f64), (low, high): (f64, f64)) -> Panel {
    let mut panel =
        Panel::new(PlotAxis::between(from, to, TIME), PlotAxis::powers(low, high, "distance (mm)"));
    for (place, line) in lines.iter().enumerate() {
        let points = line.iter().map(|(t, metres)| (*t, log_mm(*metres).max(low)));
        let role = if lines.len() == 1 { Role::Motion } else { Role::Step(0.5 * place as f64) };
        panel.draw(role, Marks::Trace(points.filter(|point| point.1.is_finite()).collect()));
    }
    panel
}

/// The picture of distances.
pub fn distance_chart(answer: &DistanceAnswer) -> Chart {
    let ends = distance_ends(answer.lines.iter().flatten().map(|point| point.1));
    let mut panel = distance_panel(&answer.lines, answer.times, ends);
    let mut drawn = Drawn::new(["t_s", "distance_m"], &["motion"]);
    for (layer, (letter, line)) in panel.layers.iter_mut().zip(answer.lines()) {
        layer.name = format!("distance of {letter}");
        let known = line.iter().filter(|point| point.1.is_finite());
        known.for_each(|(t, distance)| drawn.put("distance", &[*t, *distance], &[letter]));
    }
    Chart::stack(vec![panel], "distance from this motion, each from its start", drawn.table())
}
