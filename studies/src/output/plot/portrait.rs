//! Phase portrait: velocity over displacement, with the separatrix, the states with the energy of the top of
//! the barrier.

use super::axis::PlotAxis;
use super::chart::{Layer, Marks, Panel};
use super::figure::Point;
use super::role::Role;
use crate::dynamics::Model;
use crate::mechanics::Mechanism;
use crate::numeric::bisect;

/// Points of each branch.
const POINTS: usize = 400;

/// A phase portrait of a model over these axes, of displacement in mm and of velocity, of which `per_speed`
/// units are a m/s: its stops in mm, the separatrix, the layers of a motion, and the equilibria.
#[doc(hidden)]
pub fn portrait_panel(
    model: &Model,
    (x, y): (PlotAxis, PlotAxis),
    per_speed: f64,
    stops: (f64, f64),
    motion: Vec<Layer>,
) -> Panel {
    let mut panel = Panel::new(x, y);
    panel.upright_stops(stops);
    for part in separatrix(model.mechanism(), model.mass(), (panel.x.low * 1e-3, panel.x.high * 1e-3)) {
        let part = part.into_iter().map(|(x, v)| (x * 1e3, v * per_speed));
        let part: Vec<_> = part.filter(|point| panel.x.contains(point.0)).collect();
        panel.layer(Role::Separatrix, "separatrix", Marks::Path(part));
    }
    panel.layers.extend(motion);
    panel.equilibria(&model.mechanism().landscape, |_| 0.0);
    panel
}

/// The separatrix of a mass in kg between these displacements in m: its branches, displacement in m over
/// velocity in m/s, each from the barrier outwards to where the potential is as high again. Without shaking
/// and dissipation a state inside one of its loops never leaves that well. Empty without a barrier.
fn separatrix(mechanism: &Mechanism, mass: f64, (low, high): (f64, f64)) -> Vec<Vec<Point>> {
    let Some(barrier) = mechanism.landscape.barrier else { return Vec::new() };
    let curve = &mechanism.curve;
    let top = curve.potential(barrier.x);
    let domain = curve.domain();
    let mut branches = Vec::new();
    // to the ends on their own side of the barrier alone
    let ends = [(low < barrier.x).then(|| low.max(domain.0)), (high > barrier.x).then(|| high.min(domain.1))];
    for end in ends.into_iter().flatten() {
        let place = |i: usize| barrier.x + (end - barrier.x) * i as f64 / POINTS as f64;
        let square = |x: f64| 2.0 * (top - curve.potential(x)) / mass;
        let mut path: Vec<Point> = vec![(barrier.x, 0.0)];
        for i in 1..=POINTS {
            let squared = square(place(i));
            if !(squared > 0.0) {
                path.push((turning_point(square, place(i - 1), place(i)), 0.0));
                break;
            }
            path.push((place(i), squared.sqrt()));
        }
        branches.push(path.iter().map(|(x, v)| (*x, -v)).collect());
        branches.push(path);
    }
    branches
}

/// The zero of `height` between a point where it is positive and one where it is not, to the accuracy of a
/// screen.
fn turning_point(height: impl Fn(f64) -> f64, above: f64, below: f64) -> f64 {
    let (above, below) = bisect(above, below, 20, |x| height(x) > 0.0);
    0.5 * (above + below)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_point_is_found() {
        assert!((turning_point(|x| 1.0 - x, 0.0, 4.0) - 1.0).abs() < 1e-5);
    }
}
