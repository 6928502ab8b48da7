//! Pictures of a mechanism: force and potential over displacement, with equilibria, kinks and stops; and the
//! restitution of a compliant stop.

use crate::mechanics::{Hertz, Landscape, Mechanism};
use crate::numeric::round::decade;
use crate::numeric::{elementary, extent, short};
use crate::output::{
    Chart, DISPLACEMENT, Drawn, HOLDING_FORCE, Layer, Marks, Panel, PlotAxis, Point, Ranges, Role, axis_name,
    of_rows, superscript,
};
use crate::study::{Table, yield_speed};

/// The picture of the force curve of a mechanism with its potential, from the `table` of
/// [`Curve`](crate::questions::Curve), with stops at these positions in m, NaN where there is none. `ranges`
/// are those of displacement and force.
pub fn curve_chart(table: &Table, mechanism: &Mechanism, stops: (f64, f64), ranges: Ranges) -> Chart {
    let column = |name: &str| table.numbers(name).unwrap_or_default();
    let x: Vec<f64> = column("x_m").iter().map(|x| x * 1e3).collect();
    let pairs =
        |y: &[f64], scale: f64| -> Vec<Point> { x.iter().zip(y).map(|(x, y)| (*x, y * scale)).collect() };
    let landscape = &mechanism.landscape;
    let ends = landscape.equilibria.first().zip(landscape.equilibria.last());
    let ends = ends.map(|(left, right)| (left.x * 1e3, right.x * 1e3));
    let force_range = telling(&pairs(column("force_n"), 1.0), ends);
    let (zero, from) = zero_of_energy(mechanism, stops);
    let energies: Vec<f64> = column("potential_j").iter().map(|joule| joule - zero).collect();
    let potential_range = telling(&pairs(&energies, 1.0), ends);
    let (force, force_unit) = scaled(force_range, &[(1.0, "N"), (1e-3, "mN")]);
    let (potential, potential_unit) = scaled(potential_range, &[(1.0, "J"), (1e-3, "mJ"), (1e-6, "\u{b5}J")]);
    let across = PlotAxis::around(x.iter().copied(), 0.0, DISPLACEMENT).or_given(ranges.x);
    let height = |(low, high): (f64, f64), scale: f64, least: f64, label: &str| {
        PlotAxis::around([low * scale, high * scale, least], 0.08, label)
    };
    let up = height(force_range, force, 0.0, &axis_name(HOLDING_FORCE, force_unit)).or_given(ranges.y);
    let below = height(potential_range, potential, f64::NAN, &axis_name(from, potential_unit));
    let inside = |at: f64| across.contains(at * 1e3);
    let of_force = pairs(column("force_n"), force);
    let of_potential = pairs(&energies, potential);
    let (stops_mm, curve) = ((stops.0 * 1e3, stops.1 * 1e3), &mechanism.curve);
    let axes = (across.clone(), up);
    let upper = force_panel(mechanism, axes, force, stops_mm, ("", of_force.clone()));
    let energy = |mm: f64| (curve.potential(mm * 1e-3) - zero) * potential;
    let mut lower = curve_panel((across.clone(), below), landscape, stops_mm, ("", of_potential), energy);
    lower.equilibria(landscape, |equilibrium| energy(equilibrium.x * 1e3));
    let mut words = subtitle(landscape);
    words.extend(wall(&of_force, &upper, force));
    Chart::stack(vec![upper, lower], words, drawn(table, mechanism, stops, inside))
}

/// The potential in J from which the energy of the mass is counted: of the deepest well, or else of the lower
/// of the stops at these positions in m, NaN where there is none, or else 0. Beside it the name of an axis.
#[doc(hidden)]
pub fn zero_of_energy(mechanism: &Mechanism, stops: (f64, f64)) -> (f64, &'static str) {
    let lowest = |places: &mut dyn Iterator<Item = f64>| {
        places.map(|x| mechanism.curve.potential(x)).filter(|joule| joule.is_finite()).reduce(f64::min)
    };
    let wells = mechanism.landscape.equilibria.iter().filter(|equilibrium| equilibrium.stable);
    if let Some(well) = lowest(&mut wells.map(|well| well.x)) {
        return (well, "potential above the well");
    }
    let stop = lowest(&mut [stops.0, stops.1].into_iter().filter(|stop| stop.is_finite()));
    stop.map_or((0.0, "potential"), |stop| (stop, "potential above the stop"))
}

/// Panel of the holding force over displacement in mm, with `per_newton` units of the axis per N: stops in
/// mm, kinks, equilibria, and the curve with its name and points.
#[doc(hidden)]
pub fn force_panel(
    mechanism: &Mechanism,
    axes: (PlotAxis, PlotAxis),
    per_newton: f64,
    stops: (f64, f64),
    line: (&str, Vec<Point>),
) -> Panel {
    let force = |mm: f64| mechanism.curve.force(mm * 1e-3) * per_newton;
    let mut panel = curve_panel(axes, &mechanism.landscape, stops, line, force);
    let zero = Marks::Horizontals(vec![0.0]);
    panel.layers.insert(0, Layer::new(Role::Reference, "", zero));
    panel.equilibria(&mechanism.landscape, |_| 0.0);
    panel
}

/// A curve over displacement in mm, by its name and its points, with its stops and the kinks of the force.
fn curve_panel(
    (across, up): (PlotAxis, PlotAxis),
    landscape: &Landscape,
    stops: (f64, f64),
    (name, points): (&str, Vec<Point>),
    value: impl Fn(f64) -> f64,
) -> Panel {
    let mut panel = Panel::new(across, up);
    panel.upright_stops(stops);
    panel.layers.extend(Layer::curve(name, points, stops, &value));
    let kinks = landscape.kinks.iter().map(|kink| (kink.x * 1e3, value(kink.x * 1e3)));
    let kinks = kinks.filter(|kink| panel.x.contains(kink.0)).collect();
    panel.layer_if_any(Role::Kink, "kink of the force", Marks::Points(kinks));
    panel
}

/// The drawn data at the positions in m that lie `inside`.
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

pub(crate) fn subtitle(landscape: &Landscape) -> String {
    let Some(barrier) = landscape.barrier else {
        return if landscape.equilibria.is_empty() { "no equilibrium" } else { "one well" }.to_owned();
    };
    let left = short(barrier.left_well * 1e3).replace('-', "\u{2212}");
    let wells = format!("wells at {left} and {} mm", short(barrier.right_well * 1e3));
    match [barrier.from_left_j, barrier.from_right_j].map(|height| short(height * 1e3)) {
        [left, right] if left == right => format!("{wells}, barrier of {left} mJ"),
        [left, right] => format!("{wells}, barrier of {left} mJ from the left, {right} mJ from the right"),
    }
}

/// A note on forces beyond the vertical axis at positions in mm in the range: how large they become, and
/// where. `scale` is that of the vertical axis.
pub(crate) fn wall(points: &[Point], panel: &Panel, scale: f64) -> Option<String> {
    let shown = points.iter().filter(|(x, force)| panel.x.contains(*x) && force.is_finite());
    let outside = shown.filter(|(_, force)| !panel.y.contains(*force));
    let (x, force) = outside.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let (force, x) = (short(force / scale), short(*x));
    Some(format!(", force leaves the picture ({force} N at {x} mm)").replace('-', "\u{2212}"))
}

/// The factor from SI and the name of the largest of `units` (in descending order, with their sizes in SI) in
/// which the largest value of a range is at least 0.1.
fn scaled((low, high): (f64, f64), units: &[(f64, &'static str)]) -> (f64, &'static str) {
    let greatest = [low, high].iter().filter(|value| value.is_finite()).fold(0.0_f64, |a, b| a.max(b.abs()));
    let fits =
        units.iter().find(|(size, _)| greatest >= 0.1 * size).or(units.last().filter(|_| greatest > 0.0));
    fits.or(units.first()).map_or((1.0, ""), |(size, unit)| (1.0 / size, *unit))
}

/// The range of values of interest. A steep force beyond `ends`, the outermost equilibria, would flatten the
/// rest of the curve, so it extends the range between the equilibria by at most half of it on each side.
pub(crate) fn telling(points: &[Point], ends: Option<(f64, f64)>) -> (f64, f64) {
    let range = |from: f64, to: f64| {
        let inside = points.iter().filter(|(x, v)| *x >= from && *x <= to && v.is_finite());
        extent(inside.map(|(_, v)| *v))
    };
    let (low, high) = range(f64::NEG_INFINITY, f64::INFINITY);
    let Some((left, right)) = ends.filter(|(left, right)| left < right) else { return (low, high) };
    let (inner_low, inner_high) = range(left, right);
    let more = 0.5 * (inner_high - inner_low);
    if more > 0.0 { (low.max(inner_low - more), high.min(inner_high + more)) } else { (low, high) }
}

/// The picture of restitution over impact speed, beside a rigid stop's constant, from the `table` of
/// [`Simulation::impact`](crate::questions::Simulation::impact), for `stop` and a mass in kg.
pub fn contact_chart(table: &Table, stop: &Hertz, mass: f64) -> Chart {
    let names = ["speed_m_per_s", "restitution", "rigid_restitution"];
    let [speeds, compliant, rigid] = names.map(|name| table.numbers(name).unwrap_or_default());
    let top = speeds.last().copied().unwrap_or(1.0);
    let path = |y: &[f64]| Marks::Path(speeds.iter().copied().zip(y.iter().copied()).collect());
    let across = PlotAxis::between(0.0, top, "impact speed (m/s)");
    let mut panel = Panel::new(across, PlotAxis::between(0.0, 1.05, "restitution"));
    panel.layer(Role::Curve, "compliant stop", path(compliant));
    let name = format!("rigid stop, {}", short(rigid.first().copied().unwrap_or(f64::NAN)));
    panel.layer(Role::Separatrix, name, path(rigid));
    if let Some(speed) = yield_speed(stop, mass).filter(|speed| *speed < top) {
        let name = format!("yields from {} m/s on", short(speed));
        panel.layer(Role::UnstableMotion, name, Marks::Verticals(vec![speed]));
    }
    let contact_ms = stop.contact_time(mass, 0.5 * top) * 1e3;
    let [loss, ms, speed] = [stop.loss, contact_ms, 0.5 * top].map(short);
    let power = decade(stop.stiffness);
    let digits = short(stop.stiffness / elementary::powi(10.0, power));
    let stiffness = format!("{digits} \u{d7} 10{} N/m\u{b9}\u{b7}\u{2075}", superscript(power));
    let about = format!("one contact alone: {stiffness}, loss {loss} s/m; {ms} ms at {speed} m/s");
    Chart::stack(vec![panel], about, of_rows("contact", table, &names, |_| true))
}
