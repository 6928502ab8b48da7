//! Picture of bent flexures: their centre lines in the frame, at one displacement or at several.

use crate::mechanics::Mechanism;
use crate::mechanics::flexure::State;
use crate::numeric::short;
use crate::output::{Chart, DISPLACEMENT, Drawn, Marks, Panel, PlotAxis, Point, Role};
use crate::study::Table;

/// Number of states up to which each has a name in the legend; of more the first and the last have one.
const NAMED: usize = 6;

/// The picture of these states of the flexures of a mechanism, as in a
/// [`FlexuresAnswer`](crate::questions::FlexuresAnswer), with stops at these positions in m, NaN where there
/// is none.
pub fn shapes_chart(states: &[State], mechanism: &Mechanism, stops: (f64, f64)) -> Chart {
    let point = |[_, along, across]: &[f64; 3]| (across * 1e3, along * 1e3);
    let lines = |state: &State| -> Vec<Vec<Point>> {
        state.lines.iter().map(|line| line.points.iter().map(point).collect()).collect()
    };
    let all: Vec<Vec<Vec<Point>>> = states.iter().map(lines).collect();
    let places = || all.iter().flatten().flatten();
    let ends = [stops.0, stops.1].map(|stop| stop * 1e3);
    let across = PlotAxis::around(places().map(|at| at.0).chain(ends), 0.08, DISPLACEMENT);
    let along = PlotAxis::around(places().map(|at| at.1), 0.04, "along the flexures (mm)");
    let mut panel = Panel::new(across, along);
    panel.upright_stops((ends[0], ends[1]));
    let clamps = |pick: fn(f64, f64) -> f64| places().map(|at| at.1).fold(f64::NAN, pick);
    panel.layer(Role::Reference, "clamps", Marks::Horizontals(vec![clamps(f64::min), clamps(f64::max)]));
    let last = states.len().saturating_sub(1);
    for (i, (state, lines)) in states.iter().zip(&all).enumerate() {
        let is_named = states.len() <= NAMED || i == 0 || i == last;
        let name = if is_named { words(state.x, mechanism) } else { String::new() };
        let role = if last == 0 { Role::Curve } else { Role::Step(i as f64 / last as f64) };
        for line in lines {
            panel.layer(role, &name, Marks::Path(line.clone()));
        }
    }
    // both kinds of flexures end at the proof mass
    let mass = all.iter().filter_map(|lines| lines.first()?.last().copied()).collect();
    panel.layer(Role::Several, "proof mass", Marks::Points(mass));
    let kinds = states.first().map_or(0, |state| state.lines.len());
    let about = match kinds {
        1 => "centre line of the flexures",
        _ => "centre lines: above the mass the buckling flexures, below it the parallel ones",
    };
    Chart::stack(vec![panel], format!("{about}; sideways stretched"), drawn_shapes(states, stops, &[]))
}

/// The flexures in these states, stops and masses in m.
pub(crate) fn drawn_shapes(states: &[State], stops: (f64, f64), masses: &[f64]) -> Table {
    let mut drawn = Drawn::new(["x_m", "s_m", "px_m", "py_m"], &["flexure"]);
    for state in states {
        for line in &state.lines {
            for [s, px, py] in &line.points {
                drawn.put("flexure", &[state.x, *s, *px, *py].map(|value| value + 0.0), &[line.flexure]);
            }
        }
    }
    for at in [stops.0, stops.1].into_iter().filter(|at| at.is_finite()) {
        drawn.put("stop", &[at], &[]);
    }
    masses.iter().for_each(|x| drawn.put("mass", &[*x], &[]));
    drawn.table()
}

/// A state in words: `stable at 7.2 mm`.
fn words(x: f64, mechanism: &Mechanism) -> String {
    let is_here = |other: f64| (other - x).abs() <= 1e-9 * other.abs().max(1e-6);
    let equilibrium = mechanism.landscape.equilibria.iter().find(|equilibrium| is_here(equilibrium.x));
    let kind = equilibrium.map_or("", |found| if found.stable { "stable " } else { "unstable " });
    format!("{kind}at {} mm", short(x * 1e3)).replace('-', "\u{2212}")
}
