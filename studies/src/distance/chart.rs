//! Picture of the distance of motions over time, on a logarithmic scale.

use super::DistanceAnswer;
use crate::numeric::elementary;
use crate::output::{Chart, Drawn, Marks, Panel, PlotAxis, Role, TIME};

/// Decimal logarithm of the smallest distance shown, in mm; below it lies rounding error.
const MIN_LOG: f64 = -14.0;

/// Logarithm of a distance in m, in mm.
fn log_mm(metres: f64) -> f64 {
    elementary::log10(metres * 1e3)
}

/// The picture of distances. A solid line each, since so steep a line has thousands of dashes.
pub fn distance_chart(answer: &DistanceAnswer) -> Chart {
    let logs = answer.lines.iter().flatten().map(|point| log_mm(point.1)).filter(|log| log.is_finite());
    // if all motions are equal to the last digit, the axis starts at its lowest end
    let bottom = if logs.clone().next().is_some() { 0.0 } else { MIN_LOG };
    let low = logs.clone().fold(bottom, f64::min).floor().max(MIN_LOG);
    let high = logs.fold(low + 1.0, f64::max).ceil().max(1.0);
    let (from, to) = answer.times;
    let mut panel =
        Panel::new(PlotAxis::between(from, to, TIME), PlotAxis::powers(low, high, "distance (mm)"));
    let mut drawn = Drawn::new(["t_s", "distance_m"], &["motion"]);
    for (place, (letter, line)) in answer.lines().enumerate() {
        // of two numbers `max` takes the one that is known
        let height = |log: f64| if log.is_nan() { log } else { log.max(low) };
        let points = line.iter().map(|(t, metres)| (*t, height(log_mm(*metres)))).collect();
        let role = if answer.lines.len() == 1 { Role::Motion } else { Role::Step(0.5 * place as f64) };
        panel.layer(role, format!("distance of {letter}"), Marks::Trace(points));
        let known = line.iter().filter(|point| point.1.is_finite());
        known.for_each(|(t, distance)| drawn.put("distance", &[*t, *distance], &[letter]));
    }
    Chart::stack(vec![panel], "distance from this motion, each from its start", drawn.table())
}
