//! Picture of the potential well: the potential, tipped by the push of the base, with the mass on it.
//!
//! In the frame of the base, the force of the mechanism and the push -m a_b act on the mass. The potential of
//! the push is m a_b x, and the mass moves like a ball on the sum of both potentials.

use super::axis::PlotAxis;
use super::chart::{Chart, Layer, Marks, Panel};
use super::drawn::Drawn;
use super::figure::Point;
use super::names::{DISPLACEMENT, axis_name};
use super::quantity::suited_unit;
use super::role::Role;
use crate::curve::{subtitle, telling, zero_of_energy};
use crate::dynamics::{Model, STANDARD_GRAVITY};
use crate::numeric::{extent, short};

/// Number of points of a curve.
const POINTS: usize = 400;

/// The potential of a model over displacement, tipped by a push. It is counted from the bottom of the deepest
/// well, without a well from the lower stop.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub struct TippedPotential<'a> {
    model: &'a Model,
    /// The base's acceleration times the mass, in N.
    tilt: f64,
    /// Units of its axis per J.
    pub per_joule: f64,
    zero: f64,
}

impl<'a> TippedPotential<'a> {
    /// The potential at an acceleration of the base in m/s^2, on an axis of `per_joule` units per J.
    pub fn new(model: &'a Model, base_accel: f64, per_joule: f64) -> Self {
        let (zero, _) = zero_of_energy(model.mechanism(), stops(model, 1.0));
        Self { model, tilt: model.mass() * base_accel, per_joule, zero }
    }

    /// The same at another acceleration of the base in m/s^2.
    #[must_use]
    pub fn at_acceleration(self, base_accel: f64) -> Self {
        Self { tilt: self.model.mass() * base_accel, ..self }
    }

    /// Its value on its axis at a displacement in mm.
    pub fn at(&self, mm: f64) -> f64 {
        let curve = &self.model.mechanism().curve;
        let (low, high) = curve.domain();
        let x = mm * 1e-3;
        (curve.potential(x.clamp(low, high)) - self.zero + self.tilt * x) * self.per_joule
    }

    /// Its points between these displacements in m, where the force is known.
    pub fn points(&self, (low, high): (f64, f64)) -> Vec<Point> {
        let domain = self.model.mechanism().curve.domain();
        let (low, high) = (low.max(domain.0) * 1e3, high.min(domain.1) * 1e3);
        let place = |i: usize| low + (high - low) * i as f64 / POINTS as f64;
        (0..=POINTS).map(place).map(|mm| (mm, self.at(mm))).collect()
    }

    /// A line through its points, dashed beyond the stops.
    pub fn line(&self, points: Vec<Point>) -> Vec<Layer> {
        Layer::curve("", points, stops(self.model, 1e3), |mm| self.at(mm))
    }
}

/// The positions of the stops, with so many units per m; NaN where there is none.
fn stops(model: &Model, scale: f64) -> (f64, f64) {
    <[_; 2]>::from(model.stop_positions()).map(|stop| stop.map_or(f64::NAN, |x| x * scale)).into()
}

/// The panel over displacement in mm and energy, without what moves: the `level` potential between these
/// displacements in m where a push may tip it, and the names of the lines.
#[doc(hidden)]
pub fn well_panel(
    level: &TippedPotential,
    range: (f64, f64),
    (across, up): (PlotAxis, PlotAxis),
    is_pushed: bool,
) -> Panel {
    let mut panel = Panel::new(across, up);
    let named = |panel: &mut Panel, role, name| panel.layer(role, name, Marks::Path(Vec::new()));
    if is_pushed {
        named(&mut panel, Role::Curve, "with the push");
        panel.layer(Role::Reference, "without the push", Marks::Path(level.points(range)));
    } else {
        named(&mut panel, Role::Curve, "potential");
    }
    if level.model.stop_positions() != (None, None) {
        named(&mut panel, Role::Beyond, "beyond the stops");
    }
    panel
}

/// The picture of the potential of a model between these displacements in m, with the mass at `x` in m while
/// the base has this acceleration in m/s^2.
pub fn well_chart(model: &Model, x: f64, base_accel: f64, range: (f64, f64)) -> Chart {
    let joule = TippedPotential::new(model, base_accel, 1.0);
    let landscape = &model.mechanism().landscape;
    let ends = landscape.equilibria.first().zip(landscape.equilibria.last());
    let ends = ends.map(|(left, right)| (left.x * 1e3, right.x * 1e3));
    let of_both = [0.0, base_accel].map(|accel| telling(&joule.at_acceleration(accel).points(range), ends));
    let values = || of_both.into_iter().flat_map(<[f64; 2]>::from).chain([joule.at(x * 1e3)]);
    let (low, high) = extent(values());
    let (per_joule, unit) = suited_unit("J", std::iter::once(high - low));
    let (_, name) = zero_of_energy(model.mechanism(), stops(model, 1.0));
    let across = PlotAxis::around([range.0, range.1, x].map(|x| x * 1e3), 0.0, DISPLACEMENT);
    let up = PlotAxis::around(values().map(|joule| joule * per_joule), 0.08, &axis_name(name, unit));
    let tipped = TippedPotential { per_joule, ..joule };
    let level = tipped.at_acceleration(0.0);
    let mut panel = well_panel(&level, range, (across, up), base_accel != 0.0);
    let (points, mass) = (tipped.points(range), (x * 1e3, tipped.at(x * 1e3)));
    // the lines lie over the stops
    let lines = std::mem::take(&mut panel.layers);
    panel.upright_stops(stops(model, 1e3));
    panel.layers.extend(lines);
    panel.layers.extend(tipped.line(points.clone()));
    panel.layer(Role::Mass, "mass", Marks::Points(vec![mass]));
    let mut drawn = Drawn::new(["x_m", "potential_j"], &[]);
    let mut put = |series, points: &[Point]| {
        points.iter().for_each(|(mm, energy)| drawn.put(series, &[mm / 1e3, energy / per_joule], &[]));
    };
    put("potential", &level.points(range));
    if base_accel != 0.0 {
        put("with_push", &points);
    }
    put("mass", &[mass]);
    for stop in <[_; 2]>::from(model.stop_positions()).into_iter().flatten() {
        drawn.put("stop", &[stop], &[]);
    }
    let about =
        format!("{}; mass at {} mm, {}", subtitle(landscape), short(x * 1e3), push(model, base_accel));
    Chart::stack(vec![panel], about.replace('-', "\u{2212}"), drawn.table())
}

/// The push in words.
fn push(model: &Model, base_accel: f64) -> String {
    let newton = -model.mass() * base_accel;
    let direction = if newton < 0.0 { "left" } else { "right" };
    match newton {
        0.0 => "no push".to_owned(),
        _ => {
            let [newton, accel] = [newton.abs(), base_accel / STANDARD_GRAVITY].map(short);
            format!("pushed by {newton} N to the {direction} (as at a base acceleration of {accel} g)")
        }
    }
}
